!> Rigid motions that nothing holds and no load drives: of all displacements that differ by them the least are given, in either form
!> of the contact system and whatever solver the bodies have.
!>
!> A motion v of the bodies is idle where no row that takes a force sees it: N v = 0 at closed points, T v = 0 at those that stick,
!> b v = 0 in bilateral rows. Bodies are joined by such rows into groups, and the idle motions of a group are the null space of its
!> rows. Which of them are added to the displacements is asked in atrito_least_motions.
module atrito_idle_motions
   use atrito_bodies, only: simplest_motion
   use atrito_bound_qp, only: FREE, AT_LOWER, AT_UPPER, FROZEN
   use atrito_certificate, only: certificate_t, BALANCE_IMPOSSIBLE
   use atrito_contact_line, only: friction_bound
   use atrito_contact_scales, only: had_force, NONE_OF_HAD
   use atrito_contact_solution, only: contact_solution_t
   use atrito_digit_turns, only: turn_rows
   use atrito_friction_law, only: FRICTION_NONE
   use atrito_kinds, only: ip, wp
   use atrito_least_motions, only: measure_motions, take_least, take_rounding_off
   use atrito_load_digits, only: is_within_digits, take_out, work_along
   use atrito_motion_rows, only: motion_rows_t, build_motion_rows, note_digits, join_motions, MOST_PART
   use atrito_null_motions, only: find_idle, MOST_MOTIONS
   use atrito_own_axes, only: prove_in_own_axes
   use atrito_range, only: largest_at
   use atrito_scene_data, only: scene_data_t
   use atrito_sparse_rows, only: add_transposed, multiply_rows, transposed_sizes
   implicit none (type, external)
   private
   public :: settle_idle_motions, stop_slow_motion

   real(wp), parameter :: NO_FORCE = 1.0e-13_wp     !< of the largest force on bodies that touch: round-off
   real(wp), parameter :: MOST_BALANCE = 0.1_wp     !< of the largest force, what balances tilts of normals
   real(wp), parameter :: DOUBTS = 5.0_wp           !< of a normal, which a force may be off by, over the largest one
   real(wp), parameter :: MOST_DOUBT = 1.0e-9_wp    !< that balances leave
   real(wp), parameter :: BALANCED = 1.0e-8_wp      !< of the forces on a body, for the final check

contains

   !> Takes the least of the idle motions; a solution whose idle motions the loads drive is none any more (solution%converged).
   !> solution%inner%undetermined: one of them, the simplest, or not allocated where there
   !> is none; groups of many motions have what their form of the contact system found. Where a motion were idle but for what the
   !> digits of the deck make of the loads, that is taken out of data%f, and the increment is to be solved again.
   !>
   !>     1. rows that hold: closed, sticking or bilateral, with a force or a bound above zero (is_holding)
   !>     2. bodies joined by such rows are a group (join_motions), whose idle motions are the null space of its rows (find_idle);
   !>        a point that sticks with its bound holds nothing that makes it slip on (let_slip_on)
   !>     3. loads, and then forces, that are no more than the digits of the deck make of others are taken out (doubt_loads,
   !>        doubt_small_forces): 2 once more, or the increment once more
   !>     4. closed points without a force count as open, sticking ones without a bound as without friction
   !>     5. of all displacements u + V s the ones nearest to those of the increment before (take_least)
   !>     6. after a long way, what its rounding has put off in the rows that hold (take_rounding_off)
   !>
   !> 4 to 6 leave all forces as they are, since idle motions work with none of them. They choose which of the many displacements
   !> with these forces is told, the same one whatever the form of the contact system and its solver.
   subroutine settle_idle_motions(data, u, before, solution, again)
      type(scene_data_t), intent(inout) :: data           !< of the increment; its loads may change
      real(wp), intent(in) :: u(:, :)                     !< (2, n_nodes) without rigid motions [L]
      real(wp), pointer, intent(in) :: before(:, :)       !< (2, n_nodes) of the increment before [L]; null: there is none
      type(contact_solution_t), intent(inout) :: solution !< motions, states of rows and small forces may change
      logical, intent(inout) :: again                     !< in: whether loads may change; out: they have
      type(motion_rows_t) :: rows
      logical :: holds(size(solution%state%state))  ! rows that hold motions
      real(wp) :: tau(data%line%n)                  ! friction bounds at the points [F/L^2]
      real(wp) :: none(0:data%fem%bodies%n)         ! forces on bodies that are none [F]
      integer(ip), allocatable :: group(:)
      logical :: may_change, is_open(size(solution%state%state)) ! rows of which nothing is known to hold them
      real(wp), allocatable :: idle(:, :), off(:), metric(:, :, :)
      real(wp) :: way(size(solution%state%a))
      integer(ip) :: i

      may_change = again
      again = .false.
      call build_motion_rows(data%fem, data%rows, data%line, data%f, rows)
      if (rows%n_columns == 0) return
      tau = friction_bound(data%line, max(solution%p, 0.0_wp))
      none = left_of_forces(data)
      holds = [(is_holding(data, solution, tau, none, i), i=1, rows%n)]
      call join_motions(rows, holds, group)
      call find_idle(rows, holds, group, idle)
      if (may_change) call clear_idle_loads(data, rows, idle, solution, again)
      if (.not. solution%converged) return
      if (may_change .and. .not. again) call doubt_loads(data, rows, group, idle, holds, tau, solution, again)
      if (again) return
      call doubt_small_forces()
      call let_slip_on(data, rows, group, tau, holds, idle, solution)
      if (allocated(solution%inner%undetermined) .and. all(members_of(group) <= MOST_MOTIONS)) then
         deallocate (solution%inner%undetermined)
      end if
      if (size(idle, 2) == 0) return
      solution%inner%undetermined = simplest_motion(idle)
      ! a closed point without force may open, one without friction slip, and slip without friction may turn back
      is_open = .not. (holds .or. of_large_group(rows, group))
      associate (state => solution%state, n => count(data%line%normal > 0, kind=ip))
         where (state%state(:n) == FREE .and. is_open(:n)) state%state(:n) = AT_LOWER
         where (state%state(n + 1:) == FREE .and. is_open(n + 1:)) state%state(n + 1:) = FROZEN
         where (is_open(n + 1:) .and. abs(state%q(n + 1:)) <= NO_FORCE*maxval(abs(state%q))) state%state(n + 1:) = FROZEN
      end associate
      if (size(idle, 2) > MOST_MOTIONS) return
      call measure_motions(data%fem, u, before, solution%state%a, off, metric)
      call take_least(data%fem, rows, idle, off, metric, maxval(abs(u)), data%line%has_friction .and. .not. data%lets_out, &
                      solution, way)
      if (.not. solution%has_settled) return
      call take_rounding_off(data, rows, group, way, u, holds, solution)

   contains

      !> A force that is less than what the digits of the deck make of the largest one on its body, and without which a motion were
      !> idle, is none: a roller that stands on one node does not turn until the next one touches because its load is off by the
      !> last digit. With friction the bound at its neighbours may hang on it, and only what is round-off is none.
      subroutine doubt_small_forces()
         real(wp) :: largest(rows%n)
         logical :: is_sure(size(holds))
         real(wp), allocatable :: more(:, :)
         integer(ip) :: i

         largest = largest_forces(rows, solution%state%q)
         is_sure = holds
         do i = 1, rows%n
            associate (j => data%line%point(i))
               if (.not. holds(i) .or. rows%first(i + 1) == rows%first(i) .or. data%line%normal(j) /= i) cycle
               if (j > data%line%n - data%line%n_bilateral) cycle
               is_sure(i) = abs(solution%state%q(i)) > largest(i)*merge(dropped_part(data, i), NO_FORCE, &
                                                                        data%line%law(j)%kind == FRICTION_NONE)
            end associate
         end do
         if (all(is_sure .eqv. holds)) return
         call find_idle(rows, is_sure, group, more)
         if (size(more, 2) <= size(idle, 2)) return
         call move_alloc(more, idle)
         do i = 1, rows%n
            if (.not. holds(i) .or. is_sure(i)) cycle
            solution%state%q(i) = 0.0_wp
            solution%p(data%line%point(i)) = 0.0_wp
         end do
         holds = is_sure
      end subroutine doubt_small_forces

   end subroutine settle_idle_motions

   !> Points that stick with a shear that is their bound, but for what balances leave, slip in a motion that takes all of them
   !> onward and on which the loads do no work. Whether they stick or slip there is a matter of round-off.
   subroutine let_slip_on(data, rows, group, tau, holds, idle, solution)
      type(scene_data_t), intent(in) :: data
      type(motion_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: group(:)           !< (k)
      real(wp), intent(in) :: tau(:)                !< friction bounds at the points [F/L^2]
      logical, intent(inout) :: holds(:)            !< (m) without these points
      real(wp), allocatable, intent(inout) :: idle(:, :) !< (k, motions) with those that they held
      type(contact_solution_t), intent(inout) :: solution !< states of these points
      real(wp) :: sense(rows%n), rate(rows%n), onward(rows%n_columns), forces(rows%n_columns)
      real(wp), allocatable :: more(:, :)
      integer(ip) :: i

      associate (line => data%line, q => solution%state%q)
         sense = [(merge(sign(1.0_wp, q(i)), 0.0_wp, holds(i) .and. line%tangential(line%point(i)) == i .and. abs(q(i)) &
                         >= (1 - MOST_DOUBT)*tau(line%point(i))*line%weight(line%point(i))), i=1, rows%n)]
         if (.not. any(abs(sense) > 0.0_wp)) return
         call find_idle(rows, holds .and. abs(sense) <= 0.0_wp, group, more)
         if (size(more, 2) <= size(idle, 2)) return
         onward = 0.0_wp
         call add_transposed(rows, 1.0_wp, sense, onward)
         onward = matmul(more, matmul(onward, more))
         call multiply_rows(rows, onward, rate)
         forces = rows%work_size + transposed_sizes(rows, q)
      end associate
      if (minval(rate*sense) < -NO_FORCE*maxval(abs(rate)) .or. maxval(rate*sense) <= NO_FORCE*maxval(abs(rate))) return
      if (abs(dot_product(onward, rows%work)) > BALANCED*dot_product(abs(onward), forces)) return
      call move_alloc(more, idle)
      holds = holds .and. abs(sense) <= 0.0_wp
      where (sense > 0.0_wp) solution%state%state = AT_UPPER
      where (sense < 0.0_wp) solution%state%state = AT_LOWER
   end subroutine let_slip_on

   !> Whether an unknown holds a motion: it takes a force, or would take one of either sign.
   pure logical function is_holding(data, solution, tau, none, i)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(in) :: solution
      real(wp), intent(in) :: tau(:)                !< friction bounds at the points [F/L^2]
      real(wp), intent(in) :: none(0:)              !< (bodies) forces that are none [F]
      integer(ip), intent(in) :: i                  !< unknown force

      associate (state => solution%state, line => data%line)
         is_holding = state%state(i) == FREE
         if (.not. is_holding .or. line%point(i) > line%n - line%n_bilateral) return
         is_holding = merge(state%q(i), tau(line%point(i))*line%weight(line%point(i)), line%normal(line%point(i)) == i) > &
                      maxval(none(data%fem%bodies%of_node(data%rows%node(data%rows%first(line%point(i)): &
                                                                         data%rows%first(line%point(i) + 1) - 1))))
      end associate
   end function is_holding

   !> (0:bodies) The round-off of what was on a body that has no load any more [F].
   pure function left_of_forces(data) result(none)
      type(scene_data_t), intent(in) :: data
      real(wp) :: none(0:data%fem%bodies%n)
      integer(ip) :: b

      none = 0.0_wp
      do b = 1, data%fem%bodies%n
         if (largest_at(data%f, data%fem%bodies%list(b)%nodes) <= 0.0_wp) none(b) = NONE_OF_HAD*had_force(data%had, b)
      end do
   end function left_of_forces

   !> Where no solution was found since a motion went on that the loads drive: takes its work out of the loads, where it is no more
   !> than what the digits of the deck make of them; with friction of the loads alone, since forces that wedge may be of any size.
   subroutine stop_slow_motion(data, solution, has_changed)
      type(scene_data_t), intent(inout) :: data        !< of the increment; its loads may change
      type(contact_solution_t), intent(in) :: solution !< the iterate that was left, with the motion that went on
      logical, intent(out) :: has_changed              !< the loads are others now: solve again
      type(motion_rows_t) :: rows

      has_changed = .false.
      if (.not. (allocated(solution%inner%motion) .and. allocated(solution%state%q))) return
      call build_motion_rows(data%fem, data%rows, data%line, data%f, rows)
      if (size(solution%inner%motion) /= rows%n_columns .or. size(solution%state%q) /= rows%n) return
      call note_digits(data%fem, data%rows, data%line, rows)
      if (.not. any(rows%doubt > 0.0_wp)) return
      associate (v => solution%inner%motion)
         if (.not. abs(dot_product(v, rows%work)) > 0.0_wp) return   ! loads that do no work lose none
         if (.not. is_within_digits(data, rows, v, merge(0.0_wp, solution%state%q, data%line%has_friction))) return
         call take_out(data, work_along(rows, reshape(v/norm2(v), [size(v), 1])))
      end associate
      has_changed = .true.
   end subroutine stop_slow_motion

   !> Of the largest forces on the bodies of each row, the least [F]: what its own force is measured by.
   pure function largest_forces(rows, q) result(least)
      type(motion_rows_t), intent(in) :: rows
      real(wp), intent(in) :: q(:)                  !< (m) [F]
      real(wp) :: least(rows%n), largest(rows%n_columns)
      integer(ip) :: i, k

      largest = 0.0_wp
      do i = 1, rows%n
         associate (own => rows%column(rows%first(i):rows%first(i + 1) - 1))
            largest(own) = max(largest(own), abs(q(i)))
         end associate
      end do
      do k = 2, rows%n_columns                              ! the motions of a body stand one after the other
         if (rows%body(k) == rows%body(k - 1)) largest(k) = max(largest(k), largest(k - 1))
      end do
      do k = rows%n_columns - 1, 1, -1
         if (rows%body(k) == rows%body(k + 1)) largest(k) = largest(k + 1)
      end do
      do i = 1, rows%n
         least(i) = minval(largest(rows%column(rows%first(i):rows%first(i + 1) - 1)))
      end do
   end function largest_forces

   !> The part of the largest force on its bodies that a force is none at, whatever loads there are.
   pure real(wp) function dropped_part(data, i) result(part)
      type(scene_data_t), intent(in) :: data
      integer(ip), intent(in) :: i                  !< unknown force

      part = max(NO_FORCE, min(DOUBTS*data%rows%doubt(data%line%point(i)), MOST_DOUBT))
   end function dropped_part

   !> Takes the work on idle motions out of the loads, which a solution has counted as none: else its bodies were out of balance by
   !> it, which may be all that there is of other forces. It is the work of all forces: those that hold have none, but they balance
   !> what the rounding of a motion makes of the loads of heavier bodies. Where the certificate proves that nothing balances it, and
   !> it is more than the digits of the deck make, the loads drive the motion: there is no solution (solution%converged).
   subroutine clear_idle_loads(data, rows, idle, solution, has_changed)
      type(scene_data_t), intent(inout) :: data
      type(motion_rows_t), intent(in) :: rows
      real(wp), intent(in) :: idle(:, :)            !< (k, motions)
      type(contact_solution_t), intent(inout) :: solution
      logical, intent(out) :: has_changed
      type(certificate_t) :: certificate
      real(wp) :: most(rows%n_columns), sizes(rows%n_columns)
      type(motion_rows_t) :: rest                   ! with the work of all forces
      integer(ip) :: k

      rest = rows
      call add_transposed(rows, -1.0_wp, solution%state%q, rest%work)
      most = matmul(idle, matmul(rest%work, idle))
      sizes = rows%work_size + transposed_sizes(rows, solution%state%q)
      sizes = [(maxval(sizes, mask=rows%body == rows%body(k)), k=1, rows%n_columns)]
      has_changed = any(abs(most) > NO_FORCE*sizes) .and. all(abs(most) <= BALANCED*sizes)
      if (.not. has_changed) return
      call prove_in_own_axes(data%fem, data%rows, data%line, data%f, certificate)
      if (certificate%verdict == BALANCE_IMPOSSIBLE) has_changed = is_within_digits(data, rows, certificate%motion, certificate%q)
      if (has_changed) call take_out(data, work_along(rest, idle))
      solution%converged = has_changed
   end subroutine clear_idle_loads

   !> Takes the work on motions that were idle but for small forces out of the loads, where it is no more than what the digits of
   !> the deck make of them.
   subroutine doubt_loads(data, rows, group, idle, holds, tau, solution, has_changed)
      type(scene_data_t), intent(inout) :: data
      type(motion_rows_t), intent(inout) :: rows    !< whose doubt is noted
      integer(ip), intent(in) :: group(:)           !< (k)
      real(wp), intent(in) :: idle(:, :)            !< (k, motions)
      logical, intent(in) :: holds(:)               !< (m)
      real(wp), intent(in) :: tau(:)                !< friction bounds at the points [F/L^2]
      type(contact_solution_t), intent(in) :: solution
      logical, intent(out) :: has_changed
      real(wp) :: largest(rows%n), force(rows%n)    ! that each row bears or may bear by friction
      logical :: is_sure(rows%n), is_due            ! larger forces than those that are dropped in any case
      real(wp), allocatable :: more(:, :)
      integer(ip) :: i

      has_changed = .false.
      largest = largest_forces(rows, solution%state%q)
      force = abs(solution%state%q)
      do i = 1, rows%n
         associate (j => data%line%point(i))
            if (data%line%tangential(j) == i) force(i) = tau(j)*data%line%weight(j) ! what friction there may hold
         end associate
      end do
      if (.not. any(holds .and. force > NO_FORCE*largest .and. force <= merge(MOST_BALANCE, MOST_PART, &
                                                              data%line%law(data%line%point)%kind == FRICTION_NONE)*largest)) return
      call note_digits(data%fem, data%rows, data%line, rows)
      if (.not. any(rows%doubt > 0.0_wp)) return
      call free_turned_motions(data, rows, group, holds, largest, force, solution, has_changed)
      if (has_changed) return
      is_sure = holds
      is_due = .false.
      do i = 1, rows%n
         if (.not. (holds(i) .and. rows%doubt(i) > 0.0_wp) .or. rows%first(i + 1) == rows%first(i)) cycle
         associate (j => data%line%point(i), most => largest(i))
            is_sure(i) = force(i) > rows%doubt(i)*most
            ! what is dropped is felt by supports along directions of their own, and by friction
            is_due = is_due .or. (.not. is_sure(i) .and. &
                                  force(i) > merge(NO_FORCE, dropped_part(data, i), data%line%n_bilateral > 0 &
                                                   .or. data%line%law(j)%kind /= FRICTION_NONE)*most)
         end associate
      end do
      if (.not. is_due) return
      call find_idle(rows, is_sure, group, more)
      if (size(more, 2) <= size(idle, 2)) return
      associate (most => matmul(more, matmul(rows%work, more))) ! in which the loads work most
         if (.not. is_within_digits(data, rows, most, merge(solution%state%q, 0.0_wp, is_sure))) return
         call take_out(data, work_along(rows, more))
      end associate
      has_changed = .true.
   end subroutine doubt_loads

   !> Turns rows that hold motions by digits alone (atrito_digit_turns), and takes out what loads work on these then, where that is
   !> no more than the digits make.
   subroutine free_turned_motions(data, rows, group, holds, largest, force, solution, has_changed)
      type(scene_data_t), intent(inout) :: data
      type(motion_rows_t), intent(inout) :: rows    !< whose doubt is noted
      integer(ip), intent(in) :: group(:)           !< (k)
      logical, intent(in) :: holds(:)               !< (m)
      real(wp), intent(in) :: largest(:), force(:)  !< (m) of the bodies of each row, and its own [F]
      type(contact_solution_t), intent(in) :: solution
      logical, intent(out) :: has_changed
      real(wp), allocatable :: free(:, :)
      real(wp) :: arm                               ! size of a body in lengths of the point
      logical :: is_sure(rows%n)
      integer(ip) :: i

      has_changed = .false.
      is_sure = holds
      do i = 1, rows%n
         if (.not. (holds(i) .and. rows%doubt(i) > 0.0_wp) .or. rows%first(i + 1) == rows%first(i)) cycle
         associate (bodies => rows%body(rows%column(rows%first(i):rows%first(i + 1) - 1)))
            arm = max(1.0_wp, maxval(data%fem%bodies%list(bodies)%size)/data%rows%reach(data%line%point(i)))
         end associate
         ! by their arms small forces balance what tilted normals of large ones make
         is_sure(i) = force(i) > min(MOST_BALANCE, rows%doubt(i)*arm)*largest(i)
      end do
      if (all(is_sure .eqv. holds)) return
      call turn_rows(data, rows, group, is_sure, free, has_changed)
      if (.not. has_changed) return
      associate (most => matmul(free, matmul(rows%work, free)))
         if (is_within_digits(data, rows, most, merge(solution%state%q, 0.0_wp, is_sure))) then
            call take_out(data, work_along(rows, free))
         end if
      end associate
   end subroutine free_turned_motions

   !> Of each motion, how many its group has.
   pure function members_of(group) result(n)
      integer(ip), intent(in) :: group(:)
      integer(ip) :: members(size(group)), n(size(group)), i

      members = 0
      do i = 1, size(group, kind=ip)
         members(group(i)) = members(group(i)) + 1
      end do
      n = members(group)
   end function members_of

   !> Of each row, whether all motions that it sees are of groups that are too large.
   pure function of_large_group(rows, group) result(is_large)
      type(motion_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: group(:)
      logical :: is_large(rows%n)
      integer(ip) :: members(size(group)), i

      members = members_of(group)
      do i = 1, rows%n
         associate (own => members(rows%column(rows%first(i):rows%first(i + 1) - 1)))
            is_large(i) = size(own) > 0 .and. all(own > MOST_MOTIONS)
         end associate
      end do
   end function of_large_group

end module atrito_idle_motions
