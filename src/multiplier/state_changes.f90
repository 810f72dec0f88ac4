!> Which rows change their states between two solves with the states held (atrito_contact_fronts): those that the law asks for,
!> without those that wait. What one row changes others feel, so that all that ought to change alone may be wrong together.
!>
!>     states_of_law        the state that the law gives each row, from that which it was solved with
!>     keep_held            the rows that hold a body do not let go all at once
!>     furthest_off_first   rows whose states follow each other in a circle come out of it one by one
module atrito_state_changes
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE, AT_LOWER, AT_UPPER, FROZEN
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_system, only: contact_system_t
   use atrito_kinds, only: ip, wp
   use atrito_multiplier_step, only: largest_of_pairs
   use atrito_multipliers, only: multiplier_t
   implicit none (type, external)
   private
   public :: states_of_law, keep_held, furthest_off_first

   integer(ip), parameter :: TO_AND_FRO = 3_ip
   integer(ip), parameter :: SPACING = 5_ip
   real(wp), parameter :: NO_EXCESS = 1.0e-10_wp  !< of the largest force of the pair
   real(wp), parameter :: ALONG = 1.0e-3_wp        !< part of a row that other rows do not have, when it is along them

contains

   !> The state that the law gives each row, from that which it was solved with.
   !>
   !> A slipping point that ought to slip the other way sticks first: what it does then the next solve tells. A point that has
   !> friction again, since it closes, slips at first, as it does now: stuck amid a zone of slip it would bear the shear of all
   !> of it.
   function states_of_law(system, shape, bounds, multipliers, state, before) result(raw)
      class(contact_system_t), intent(in) :: system
      type(bound_qp_t), intent(in) :: shape
      type(box_bounds_t), intent(in) :: bounds   !< with the friction bound of the next solve
      type(multiplier_t), intent(in) :: multipliers
      type(box_state_t), intent(in) :: state     !< q and r of the solve; states with points FROZEN that have no friction now
      integer(ip), intent(in) :: before(:)       !< (m) states of the solve
      integer(ip) :: raw(size(before)), i
      real(wp) :: force, slip, largest(multipliers%n_pairs)

      largest = largest_of_pairs(multipliers, abs(state%q))
      do i = 1, size(before, kind=ip)
         force = NO_EXCESS*largest(multipliers%pair(i))
         slip = force*(bounds%d(i) + system%flexibility(i))
         raw(i) = before(i)
         if (i > shape%n_normal .and. state%state(i) == FROZEN) then
            raw(i) = FROZEN
         else if (before(i) == FROZEN .and. i > shape%n_normal) then
            raw(i) = merge(AT_UPPER, AT_LOWER, state%r(i) >= 0.0_wp)
         else if (before(i) == FREE) then
            if (state%q(i) < bounds%lower(i) - force) raw(i) = AT_LOWER
            if (state%q(i) > bounds%upper(i) + force) raw(i) = AT_UPPER
         else if (before(i) == AT_LOWER) then
            if (state%r(i) > slip) raw(i) = FREE
         else if (before(i) == AT_UPPER) then
            if (state%r(i) < -slip) raw(i) = FREE
         end if
      end do
   end function states_of_law

   !> What holds a body does not let go all at once: of the rows that would, those stay until the next solve without which a motion
   !> of the body would become free, and of these the ones that are least beyond their bounds.
   !>
   !> Without it the body flies, pushes its neighbours off their places, and sticks at all points in the next solve: in a wall whose
   !> courses are about to slide, stone after stone. It seldom has to move, since the row that stays bears what little the others
   !> would leave. A row stays once; then it lets go.
   !>
   !> A row holds its body against r, its part in the amplitudes of the rigid motions, and rows hold the body against what their r
   !> span, for which an orthonormal basis is made.
   subroutine keep_held(system, before, beyond, kept, state)
      class(contact_system_t), intent(in) :: system
      integer(ip), intent(in) :: before(:)       !< (m) states of the solve
      real(wp), intent(in) :: beyond(:, AT_LOWER:) !< (m, AT_LOWER:AT_UPPER) how far the forces are beyond their bounds [F]
      logical, intent(inout) :: kept(:)          !< (m) rows that have stayed once
      integer(ip), intent(inout) :: state(:)     !< (m) states of the next solve
      real(wp) :: r(3, 2, size(before)), basis(3, 3, system%n_bodies) ! of the two bodies of each row; columns up to `held`
      integer(ip) :: body(2, size(before))       ! 0: none that is free to move
      integer(ip), dimension(system%n_bodies) :: held, least
      integer(ip) :: i, j, turn, side

      r = 0.0_wp
      body = 0
      held = 0
      do i = 1, size(before, kind=ip)
         do j = system%rows%first(i), system%rows%first(i + 1) - 1
            associate (column => system%rows%column(j))
               if (column <= system%n - system%k) cycle
               side = merge(1_ip, 2_ip, body(1, i) == 0 .or. body(1, i) == system%body(column))
               body(side, i) = system%body(column)
               r(1 + modulo(column, 3_ip), side, i) = system%rows%value(j)
            end associate
         end do
         if (state(i) == FREE) call hold(i)
      end do
      do turn = 1, 3
         least = 0
         do i = 1, size(before, kind=ip)
            if (before(i) == FREE .and. state(i) /= FREE .and. .not. kept(i)) call compare(i)
         end do
         do j = 1, system%n_bodies
            if (least(j) == 0) cycle
            state(least(j)) = FREE
            kept(least(j)) = .true.
            call hold(least(j))
         end do
      end do

   contains

      !> Takes a row into the bases of its bodies.
      subroutine hold(i)
         integer(ip), intent(in) :: i
         integer(ip) :: side

         do side = 1, 2
            if (.not. is_new(i, side)) cycle
            associate (b => body(side, i))
               basis(:, held(b) + 1, b) = rest(i, side)/norm2(rest(i, side))
               held(b) = held(b) + 1
            end associate
         end do
      end subroutine hold

      !> A row that lets go, as the one to keep.
      subroutine compare(i)
         integer(ip), intent(in) :: i
         integer(ip) :: side

         do side = 1, 2
            if (.not. is_new(i, side)) cycle
            associate (least => least(body(side, i)))
               if (least == 0) least = i
               if (maxval(beyond(i, :)) < maxval(beyond(least, :))) least = i
            end associate
         end do
      end subroutine compare

      !> Whether no other row holds the body against this motion.
      pure logical function is_new(i, side)
         integer(ip), intent(in) :: i, side

         is_new = body(side, i) > 0
         if (is_new) is_new = held(body(side, i)) < 3
         if (is_new) is_new = norm2(rest(i, side)) > ALONG*norm2(r(:, side, i))
      end function is_new

      !> r without what the rows before it span.
      pure function rest(i, side)
         integer(ip), intent(in) :: i, side
         real(wp) :: rest(3)

         associate (q => basis(:, :held(body(side, i)), body(side, i)))
            rest = r(:, side, i) - matmul(q, matmul(r(:, side, i), q))
         end associate
      end function rest

   end subroutine keep_held

   !> Of rows that change to and fro the one that is furthest off its law changes, and the others wait.
   !>
   !> What one point changes, the points beside it feel most: if all of them change at once, each goes too far, and comes back. A
   !> row waits for its neighbours from its second change on, one that a front takes along from TO_AND_FRO on: fronts go too far and
   !> return. A block that slips at all of its points flies, and sticks at all of them in the next solve: from TO_AND_FRO changes on
   !> a row waits for all the rows of the bodies that it joins. It is off by the way that its excess of force would go, or by the
   !> gap or slip that ought not to be. Where each point is less far off than the one before, every SPACING-th goes: a long run
   !> would else turn point by point.
   subroutine furthest_off_first(system, line, bounds, before, turns, normal, tangential, state)
      class(contact_system_t), intent(in) :: system
      type(contact_line_t), intent(in) :: line
      type(box_bounds_t), intent(in) :: bounds
      integer(ip), intent(in) :: before(:)       !< (m) states of the solve
      integer(ip), intent(in) :: turns(:)        !< (m) changes of each row so far
      integer(ip), intent(in) :: normal(:), tangential(:) !< (points) how far a front went that has passed it, else 0
      type(box_state_t), intent(inout) :: state  !< q and r of the solve; states of the next one
      integer(ip) :: often(size(before)), j
      real(wp) :: off(0:size(before)), of_point(line%n), of_body(system%n_bodies), most
      integer(ip) :: left(line%n), right(line%n) ! steps down from the last point that goes

      often = 1
      often(pack(line%normal, normal > 0)) = TO_AND_FRO
      often(pack(line%tangential, tangential > 0)) = TO_AND_FRO
      off(0) = -1.0_wp                           ! of a point without the unknown
      off(1:) = merge((bounds%d + system%flexibility)*max(bounds%lower - state%q, state%q - bounds%upper, 0.0_wp), abs(state%r), &
                      before == FREE)
      where (state%state == before .or. turns < often) off(1:) = -1.0_wp
      of_body = -1.0_wp
      do j = 1, size(before, kind=ip)
         if (turns(j) >= TO_AND_FRO) call raise_bodies(j)
      end do
      do j = 1, size(before, kind=ip)
         if (turns(j) >= TO_AND_FRO) call wait(j, most_of_bodies(j))
      end do
      of_point = max(off(line%normal), off(line%tangential))
      left = 0
      right = 0
      do j = 2, line%n
         if (is_neighbour(j - 1, j) .and. of_point(j - 1) > of_point(j)) left(j) = modulo(left(j - 1) + 1, SPACING)
      end do
      do j = line%n - 1, 1, -1
         if (is_neighbour(j, j + 1) .and. of_point(j + 1) > of_point(j)) right(j) = modulo(right(j + 1) + 1, SPACING)
      end do
      do j = 1, line%n
         most = merge(of_point(j), huge(most), left(j) == 0 .and. right(j) == 0)
         call wait(line%normal(j), most)
         call wait(line%tangential(j), most)
      end do

   contains

      !> A row that may have to wait, and is less far off than another one.
      subroutine wait(i, most)
         integer(ip), intent(in) :: i
         real(wp), intent(in) :: most

         if (off(i) >= 0.0_wp .and. off(i) < most) state%state(i) = before(i)
      end subroutine wait

      !> What the row i is off counts for the bodies that it joins.
      subroutine raise_bodies(i)
         integer(ip), intent(in) :: i
         integer(ip) :: k

         do k = system%rows%first(i), system%rows%first(i + 1) - 1
            associate (of => of_body(system%body(system%rows%column(k))))
               of = max(of, off(i))
            end associate
         end do
      end subroutine raise_bodies

      pure real(wp) function most_of_bodies(i)
         integer(ip), intent(in) :: i

         most_of_bodies = maxval(of_body(system%body(system%rows%column(system%rows%first(i):system%rows%first(i + 1) - 1))))
      end function most_of_bodies

      pure logical function is_neighbour(left, right)
         integer(ip), intent(in) :: left, right

         is_neighbour = .true.
         if (allocated(line%pair)) is_neighbour = line%pair(left) == line%pair(right)
      end function is_neighbour

   end subroutine furthest_off_first

end module atrito_state_changes
