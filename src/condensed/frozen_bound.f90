!> The contact line with a friction bound that stands still: what the Picard loop solves once an iteration.
!>
!> With tau given the shear has the constant bound w tau at each point and the compliance D of the friction law at that tau, and
!> the problem is the bound-constrained QP (atrito_bound_qp), convex, with one solution in the displacements:
!>
!>     1. bounds and compliances of tau (`set_friction_bounds`);
!>     2. full steps of the active set, then steps of Goldfarb and Idnani (atrito_active_set); the proximal method where rows depend
!>        on each other, or where the steps did not come to an end;
!>     3. what is round-off becomes nothing: forces that vanish, tensions that other points bear, pairs that carry noise alone;
!>     4. p = q_n/w, t = q_t/w, and the image nu S_rho(p) of tau.
!>
!> The image is the next bound of Picard's iteration; where it is tau itself the law of friction holds.
module atrito_frozen_bound
   use atrito_active_set, only: solve_box, is_settled
   use atrito_bound_qp, only: bound_qp_t, box_outcome_t, box_state_t, FREE, AT_LOWER
   use atrito_contact_line, only: contact_line_t, last_of_pair, pressure_of, find_shear, set_friction_bounds
   use atrito_contact_solution, only: contact_solution_t, bound_of_state, NOISE
   use atrito_free_set, only: solve_free_set, clear_vanishing, force_round_off
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_proximal, only: solve_box_proximal
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: solve_with_bound

   real(wp), parameter :: ROUND_OFFS = 10.0_wp        !< of a force: nothing else
   integer, parameter :: MOST_ROUNDS = 5

contains

   !> Solves the inner problem for a frozen friction bound, from the present state. Image: nu S_rho of the pressure found.
   !>
   !> The state of the last bound is where the active set begins: near the fixed point no state changes and one linear solve does.
   !> HUGE_REAL as a bound means that the point cannot slip.
   subroutine solve_with_bound(problem, line, tau, solution, image, status)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      real(wp), intent(in) :: tau(:)                  !< (n) [F/L^2]; HUGE_REAL: no bound
      type(contact_solution_t), intent(inout) :: solution !< with a state to start from
      real(wp), intent(out) :: image(:)               !< (n) [F/L^2]
      type(status_t), intent(out) :: status           !< STATUS_SINGULAR with DEPENDENT_POINTS, where no rows say which

      solution%tau = tau
      call set_friction_bounds(line, problem, tau, solution%bounds, solution%state)
      if (allocated(solution%rows)) then
         call solve_box_proximal(problem, solution%bounds, solution%state, solution%history, solution%inner, status, &
                                 solution%factor, solution%rows)
         call move_alloc(solution%inner%is_shared, solution%is_shared)
      else
         call solve_box(problem, solution%bounds, solution%state, solution%history, solution%inner, status, &
                        solution%factor)
         if (is_ok(status) .and. .not. (solution%inner%solved .or. solution%inner%moves)) then
            ! better conditioned, and from another start
            call solve_box_proximal(problem, solution%bounds, solution%state, solution%history, solution%inner, status, &
                                    solution%factor)
         end if
      end if
      if (.not. is_ok(status)) return
      ! what is round-off becomes nothing, so that no state depends on it
      call clear_vanishing(problem, solution%bounds%d, solution%state)
      if (solution%inner%solved) then
         ! with rows the factor is not that of the free set
         if (.not. allocated(solution%rows)) call open_tensions(problem, solution)
         call clear_noise()
      end if
      solution%p = pressure_of(line, solution%state%q)
      call find_shear(line, solution%state%q, tau, solution%p, solution%t)
      image = bound_of_state(line, solution)

   contains

      !> Forces of a pair that are round-off become none: at all its points what round-off of the displacements there may do, and
      !> far below the loads of the bodies that they hold. (A body without load between loaded ones has such forces.)
      !>
      !> Where a body without load lies between loaded ones, rounding of their displacements presses it. Such forces have no
      !> meaning, but they have states and friction, which would turn to and fro. Scenes of one pair have nothing to compare with,
      !> and keep all.
      subroutine clear_noise()
         logical :: beside_loads(problem%m)
         integer(ip), allocatable :: unknowns(:)
         integer(ip) :: first, last, j

         if (line%n == 0 .or. .not. allocated(line%pair) .or. .not. allocated(problem%h_size)) return
         if (size(line%pair) < line%n) return
         if (line%pair(1) == line%pair(line%n)) return
         beside_loads = .true.
         do j = 1, problem%k
            if (problem%h_size(j) > 0.0_wp) beside_loads = beside_loads .and. &
                                                           abs(problem%g(:, j)*solution%state%q) <= NOISE*problem%h_size(j)
         end do
         first = 1
         do while (first <= line%n)
            last = last_of_pair(line, first)
            unknowns = [line%normal(first:last), line%tangential(first:last)]
            unknowns = pack(unknowns, unknowns > 0)
            if (is_noise(problem, solution, beside_loads, unknowns)) solution%state%q(unknowns) = 0.0_wp
            first = last + 1
         end do
      end subroutine clear_noise

   end subroutine solve_with_bound

   !> A closed point may have a tension that is round-off, of the forces on the bodies there: another body may feel it. Such points
   !> open, where the others bear it without changing.
   !>
   !> The active set leaves tensions that are round-off of their row. Beside a soft body such a force is nothing; on a light one
   !> that touches the same point it is not. A point that opens hands its force to its neighbours, whose states must stay as they
   !> are.
   subroutine open_tensions(problem, solution)
      type(bound_qp_t), intent(in) :: problem
      type(contact_solution_t), intent(inout) :: solution
      type(box_state_t) :: state
      type(box_outcome_t) :: found
      type(status_t) :: status
      logical :: pulled(problem%n_normal)
      integer :: round

      associate (n => problem%n_normal)
         state = solution%state
         do round = 1, MOST_ROUNDS
            ! closed points of contact (not bilateral rows) with a tension, however small
            pulled = state%state(:n) == FREE .and. state%q(:n) < 0.0_wp .and. solution%bounds%lower(:n) > -HUGE_REAL
            if (.not. any(pulled)) exit
            where (pulled)
               state%state(:n) = AT_LOWER
               state%q(:n) = 0.0_wp
            end where
            call solve_free_set(problem, solution%bounds%d, state, found, status, solution%factor)
            if (.not. is_ok(status) .or. found%moves) return
         end do
         if (round == 1 .or. round > MOST_ROUNDS) return
         if (is_settled(problem, solution%bounds, state)) solution%state = state
      end associate
   end subroutine open_tensions

   !> The compliance of friction goes with its bound, which may be noise as well.
   !>
   !> Every force of the pair must be small beside the loads of all bodies that have some, and no more than round-off of its row.
   pure logical function is_noise(problem, solution, beside_loads, unknowns)
      type(bound_qp_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      logical, intent(in) :: beside_loads(:)
      integer(ip), intent(in) :: unknowns(:)
      real(wp) :: d(problem%m)
      integer(ip) :: k

      d = 0.0_wp
      d(:problem%n_normal) = solution%bounds%d(:problem%n_normal)
      is_noise = .true.
      do k = 1, size(unknowns, kind=ip)
         associate (q => solution%state%q(unknowns(k)))
            if (abs(q) <= 0.0_wp) cycle
            is_noise = beside_loads(unknowns(k))
            if (is_noise) is_noise = abs(q) <= ROUND_OFFS*force_round_off(problem, d, solution%state, unknowns(k))
         end associate
         if (.not. is_noise) return
      end do
   end function is_noise

end module atrito_frozen_bound
