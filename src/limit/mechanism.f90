!> What the motion of a certificate is like: which bodies move how, over which pairs, and by how much friction falls short.
!>
!> The motion v of a certificate lifts a sliding body by nu |T v|, so that friction is overcome by the work of the normal forces.
!> What is told is the sliding v~ without the lift, the projection of v on N v~ = 0 at the points that slide or stay closed. The
!> loads drive it with h'v~, and the excess h'v is what friction falls short by.
module atrito_mechanism
   use atrito_assembly, only: fem_t
   use atrito_body_motions, only: add_rigid_motions, is_turn, motions_of_bodies
   use atrito_certificate, only: certificate_t, friction_work
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t, row_value
   use atrito_dense, only: least_squares
   use atrito_kinds, only: ip, wp
   use atrito_motion_rows, only: motion_rows_t
   use atrito_sparse_rows, only: multiply_rows
   implicit none (type, external)
   private
   public :: mechanism_t, describe_motion

   type :: mechanism_t
      integer(ip), allocatable :: bodies(:)      !< that move, the fastest first
      real(wp), allocatable :: mode(:, :)        !< (3, bodies) their translations along 1 and 2 and rotation, without lift
      logical :: together = .false.              !< they move as one rigid body
      logical :: turns = .false.                 !< which rotates
      logical :: touches = .false.               !< some of them have points of contact
      logical, allocatable :: slides(:)          !< (pairs) points slide
      logical, allocatable :: opens(:)           !< (pairs) points open
      !> Of bodies that move together, a displacement [F] or a rotation [F L] of one; else of any size:
      real(wp) :: load = 0.0_wp                  !< what drives it
      real(wp) :: load_at_end = 0.0_wp           !< what would drive it at the end of the step
      real(wp) :: friction = 0.0_wp              !< the most that friction can hold
      real(wp) :: normal = 0.0_wp                !< the force on the pairs that slide, of bodies that move together without rotation
   end type mechanism_t

   real(wp), parameter :: SMALL = 1.0e-6_wp      !< part of a motion that is none
   real(wp), parameter :: MUCH = 0.1_wp          !< part of a motion that must remain without its lift
   integer(ip), parameter :: FEW = 120_ip        !< motions whose lift is removed

contains

   !> What the motion of a certificate is: which bodies move and how, what slides and opens, and what the loads, friction and gaps
   !> do on it. Lifts that the loads do not drive are taken out of it first.
   !>
   !>     1. rates of all points; what a unit of pressure at each can hold by friction (friction_work)
   !>     2. which pairs slide or open, and which points are closed but for the lift (look_at_points)
   !>     3. v~ = v without the lift (remove_lift); v itself where the loads drive the lift, too
   !>     4. bodies by their speed, and whether they move as one (list_bodies, compare_bodies)
   !>     5. what the loads work on v~, over its length or its angle: a force or a moment; friction holds that less the excess
   !>
   !> For a block on a slope 5 gives the driving force W sin(a), the most that friction holds, nu W cos(a), and the rest as what is
   !> too little.
   subroutine describe_motion(fem, rows, line, motions, certificate, mechanism, work_at_end)
      type(fem_t), intent(in) :: fem                   !< bodies with their motions, and the mesh
      type(contact_rows_t), intent(in) :: rows         !< directions and nodes of its rows are read
      type(contact_line_t), intent(in) :: line         !< weights, laws and pairs of the points
      type(motion_rows_t), intent(in) :: motions       !< G, and the work of the loads on each motion
      type(certificate_t), intent(in) :: certificate   !< BALANCE_IMPOSSIBLE, with its motion
      type(mechanism_t), intent(out) :: mechanism      !< what is told of it
      real(wp), intent(in), optional :: work_at_end(:) !< (k) of the loads at the end of the step; left out: they are these
      real(wp) :: v(motions%n_columns), by_friction(line%n), rate(motions%n), known_work
      logical :: closed(line%n)

      v = certificate%motion
      call multiply_rows(motions, v, rate)
      call friction_work(line, rate, by_friction, known_work)
      call look_at_points()
      call remove_lift(line, motions, closed, rate, v)
      ! where the loads drive the lift itself it belongs to the motion
      if (dot_product(motions%work, v) < (1 - SMALL)*certificate%excess) v = certificate%motion
      call list_bodies(fem, v, mechanism)
      call compare_bodies(fem, mechanism)
      call measure_forces()
      mechanism%load_at_end = mechanism%load
      if (present(work_at_end)) mechanism%load_at_end = mechanism%load/dot_product(motions%work, v)*dot_product(work_at_end, v)
      ! without friction the difference is round-off
      if (.not. any(by_friction > 0.0_wp)) mechanism%friction = 0.0_wp

   contains

      !> Which pairs slide or open, and which points stay closed but for the lift.
      subroutine look_at_points()
         real(wp), allocatable :: u(:, :)
         real(wp) :: least, apart, along
         integer(ip) :: j, k

         allocate (u(2, fem%mesh%n_nodes), source=0.0_wp)
         call add_rigid_motions(fem, v, u)
         least = SMALL*maxval(abs(u))
         k = 0
         if (line%n > 0) k = maxval(line%pair)
         allocate (mechanism%slides(k), mechanism%opens(k), source=.false.)
         closed = .false.
         do j = 1, line%n
            if (line%normal(j) == 0) cycle
            if (j > line%n - line%n_bilateral) then
               closed(j) = .true.
               mechanism%touches = .true.
               cycle
            end if
            apart = row_value(rows, j, rows%normal(:, j), u) + by_friction(j)
            along = row_value(rows, j, rows%tangent(:, j), u)
            closed(j) = apart >= -least
            do k = rows%first(j), rows%first(j + 1) - 1
               mechanism%touches = mechanism%touches .or. any(abs(u(:, rows%node(k))) > least)
            end do
            if (.not. closed(j)) mechanism%opens(line%pair(j)) = .true.
            if (closed(j) .and. abs(along) > least) mechanism%slides(line%pair(j)) = .true.
         end do
      end subroutine look_at_points

      !> What drives the motion without its lift, what friction can hold of it, and the force that lifting it takes.
      subroutine measure_forces()
         real(wp) :: scale, lifts(3, fem%bodies%n)

         scale = norm2(mechanism%mode(:2, 1))
         if (mechanism%turns .and. mechanism%together) scale = abs(mechanism%mode(3, 1))/fem%bodies%list(mechanism%bodies(1))%size
         mechanism%load = dot_product(motions%work, v)/scale
         mechanism%friction = max(0.0_wp, mechanism%load - certificate%excess/scale)
         if (mechanism%turns .or. .not. mechanism%together) return
         lifts = motions_of_bodies(fem%bodies, certificate%motion - v)
         associate (lift => norm2(lifts(:2, mechanism%bodies(1))))
            if (lift > 0.0_wp) mechanism%normal = -dot_product(motions%work, certificate%motion - v)/lift
         end associate
      end subroutine measure_forces

   end subroutine describe_motion

   !> v less the least motion that closes what is lifted, where no closed point slides that did not before, and where much remains.
   !>
   !> K are the rows of G at closed points: all normal ones, N_j v being how fast the lift opens them, and those tangential ones
   !> along which nothing slides. The least l with K l = K v (of least squares, where dependent rows contradict each other by
   !> round-off) takes all of that out: K (v - l) = 0, and v - l is the projection of v on the motions with this property. A block
   !> that slides down a slope of friction nu keeps its T v and loses N v = -nu |T v|. Of a wedge nothing remains, since its faces
   !> cannot slide without opening; then v stays.
   subroutine remove_lift(line, motions, closed, rate, v)
      type(contact_line_t), intent(in) :: line
      type(motion_rows_t), intent(in) :: motions
      logical, intent(in) :: closed(:)
      real(wp), intent(in) :: rate(:)            !< (m) of the motion with its lift
      real(wp), intent(inout) :: v(:)
      real(wp), allocatable :: a(:, :), b(:), lift(:)
      integer(ip), allocatable :: moving(:)
      logical :: kept(motions%n)
      integer(ip) :: i, e, n, place(motions%n_columns), rank, info

      moving = pack([(i, i=1, motions%n_columns)], abs(v) > 0.0_wp)
      if (size(moving) > FEW) return
      do i = 1, motions%n
         associate (j => line%point(i))
            kept(i) = closed(j) .and. (line%normal(j) == i .or. abs(rate(i)) <= SMALL*maxval(abs(v)))
         end associate
      end do
      place = 0
      place(moving) = [(i, i=1, size(moving, kind=ip))]
      allocate (a(count(kept), size(moving)), source=0.0_wp)
      b = pack(rate, kept)
      n = 0
      do i = 1, motions%n
         if (.not. kept(i)) cycle
         n = n + 1
         do e = motions%first(i), motions%first(i + 1) - 1
            if (place(motions%column(e)) > 0) a(n, place(motions%column(e))) = motions%value(e)
         end do
      end do
      allocate (lift(size(moving)), source=0.0_wp)
      if (n == 0) return
      call least_squares(a, b, lift, SMALL, rank, info)
      if (info /= 0 .or. maxval(abs(v(moving) - lift)) < MUCH*maxval(abs(v))) return
      v(moving) = v(moving) - lift
      where (abs(v) <= SMALL*SMALL*maxval(abs(v))) v = 0.0_wp
   end subroutine remove_lift

   !> The bodies that move, the fastest first, those alike in their order.
   subroutine list_bodies(fem, v, mechanism)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: v(:)
      type(mechanism_t), intent(inout) :: mechanism
      real(wp) :: mode(3, fem%bodies%n), speed(fem%bodies%n), greatest
      integer(ip) :: b, n, i

      mode = motions_of_bodies(fem%bodies, v)
      speed = norm2(mode, dim=1)
      greatest = maxval(speed)
      n = count(speed > SMALL*greatest, kind=ip)
      allocate (mechanism%bodies(n), mechanism%mode(3, n))
      do i = 1, n
         b = findloc(speed >= (1.0_wp - SMALL)*maxval(speed), .true., dim=1, kind=ip)
         mechanism%bodies(i) = b
         mechanism%mode(:, i) = mode(:, b)
         speed(b) = 0.0_wp
      end do
   end subroutine list_bodies

   !> Whether all move as the first one does, taken as a rigid plane; and whether that turns.
   subroutine compare_bodies(fem, mechanism)
      type(fem_t), intent(in) :: fem
      type(mechanism_t), intent(inout) :: mechanism
      real(wp) :: rotation, arm(2), expected(3), span
      integer(ip) :: i

      associate (one => fem%bodies%list(mechanism%bodies(1)), mode => mechanism%mode)
         mechanism%turns = is_turn(mode(:, 1))
         rotation = mode(3, 1)/one%size
         mechanism%together = .true.
         do i = 2, size(mechanism%bodies, kind=ip)
            associate (other => fem%bodies%list(mechanism%bodies(i)))
               arm = other%centre - one%centre
               expected = [mode(1, 1) - rotation*arm(2), mode(2, 1) + rotation*arm(1), rotation*other%size]
               span = maxval(abs([mode(:, 1), expected]))
               mechanism%together = mechanism%together .and. all(abs(mode(:, i) - expected) <= SMALL*span)
            end associate
         end do
      end associate
   end subroutine compare_bodies

end module atrito_mechanism
