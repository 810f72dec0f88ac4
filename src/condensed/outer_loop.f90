!> Where the Picard loop on the weighted normal stress, tau <- nu S_rho(p(tau)), begins, and by which method it goes.
!>
!> The map tau -> nu S_rho(p(tau)) has a fixed point for every nu, and one alone where it contracts, for small nu (E. B. Pires and
!> P. Providencia e Costa 1991). From where the iteration begins matters for what it costs, and with large nu for what it finds:
!>
!>     plain start      all points closed without friction: p(0), and the first bound is nu S_rho of that. Where that leaves a body
!>                      free, since friction alone holds it: all points closed and stuck without a bound.
!>     coarse start     of lines with more than MOST_PLAIN points, from the solution of a line of every fourth (atrito_coarse_line)
!>     continued        from the solution of a problem that differs by little: the increment before, or a step of a refinement
!>     eased            from the solution with 64 times the friction, which is lowered step by step
!>
!> The methods are PICARD, tau <- tau + relaxation (image - tau); ANDERSON, which mixes the last bounds; NEWTON, which
!> differentiates the bound (atrito_newton); and EASED. Without friction there is no loop: one QP is the solution.
module atrito_outer_loop
   use atrito_accelerator, only: picard_t, anderson_t
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t
   use atrito_coarse_line, only: interpolation_t, has_coarse_line, coarsen_line, start_from_coarse
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_line, only: contact_line_t, normal_bounds, tangential_of
   use atrito_contact_solution, only: contact_solution_t, FREE_MOTION, judge_condition, relative_residual
   use atrito_controls, only: controls_t, METHOD_ANDERSON, METHOD_EASED, METHOD_PICARD, METHOD_NEWTON
   use atrito_frozen_bound, only: solve_with_bound
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_newton, only: iterate_newton
   use atrito_picard_loop, only: line_task_t, iterate, is_too_much
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_solve_history, only: begin_outer, end_outer
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: solve_contact_line, continue_contact_line, FREE_MOTION

   integer(ip), parameter :: MOST_PLAIN = 200             !< points of a line that needs no coarse one to start from
   real(wp), parameter :: LARGEST_FACTOR = 64.0_wp        !< of the friction that is eased
   real(wp), parameter :: FIRST_EASING = 0.25_wp          !< steps of its exponent
   real(wp), parameter :: LEAST_EASING = 1.0e-3_wp

   !> Where a loop begins.
   !>
   !> The first bound, and the states with their bounds and forces from which the first QP starts.
   type :: start_t
      real(wp), allocatable :: tau(:) !< (n) first bound [F/L^2]
      type(box_bounds_t) :: bounds    !< of the m forces with that bound
      type(box_state_t) :: state      !< of the m unknowns
   end type start_t

contains

   !> Solves the contact line: the pressures, shears and states of all points, with the law's own bound. Long lines start from the
   !> solution of a coarser one. Not converged: solution%converged is false and solution%verdict says why.
   !> status: STATUS_SINGULAR with FREE_MOTION, or with dependent contact points, which needs the rows.
   !>
   !> The order: coarse start, where the line is long and the method is the usual one; the plain start, where that was not tried or
   !> led nowhere; in the end the condition of the last matrix, for W-DIGITS.
   subroutine solve_contact_line(problem, line, controls, reporter, solution, status, rows)
      type(bound_qp_t), intent(in), target :: problem !< the QP: C, G, g0, h
      type(contact_line_t), intent(in), target :: line !< points, laws, average S_rho
      type(controls_t), intent(in) :: controls !< method, tolerance, MAXIT
      type(reporter_t), intent(in) :: reporter !< a line an iteration
      type(contact_solution_t), intent(out) :: solution !< states, forces, stresses, verdict
      type(status_t), intent(out) :: status             !< STATUS_SINGULAR with FREE_MOTION or DEPENDENT_POINTS
      type(constraint_rows_t), intent(in), optional :: rows !< of the unknowns: they may depend on each other

      if (has_coarse_start(line) .and. .not. present(rows) .and. &
          ((controls%method == METHOD_ANDERSON .and. .not. controls%is_rung) .or. .not. line%has_friction)) then
         call solve_from_coarse(line_task_t(problem, line, controls, reporter), solution, status)
      end if
      if (.not. solution%converged) then
         call solve_from_plain_start(line_task_t(problem, line, controls, reporter), solution, status, rows)
      end if
      call judge_condition(solution)
   end subroutine solve_contact_line

   !> Solves again, from the solution of a problem that differs by little, such as the increment before: its states, factor and
   !> bound are where the loop begins. status: as of solve_contact_line.
   !>
   !> The rate that was measured before counts as well: a loop that begins at its end has few steps to measure it by.
   subroutine continue_contact_line(problem, line, controls, reporter, solution, status)
      type(bound_qp_t), intent(in), target :: problem !< the QP: C, G, g0, h
      type(contact_line_t), intent(in), target :: line !< points, laws, average S_rho
      type(controls_t), intent(in) :: controls !< method, tolerance, MAXIT
      type(reporter_t), intent(in) :: reporter !< a line an iteration
      type(contact_solution_t), intent(inout) :: solution !< with a state to start from
      type(status_t), intent(out) :: status               !< as of solve_contact_line
      type(anderson_t) :: anderson
      real(wp) :: tau(line%n), contraction

      tau = solution%tau
      contraction = solution%contraction
      call iterate_where_friction(line_task_t(problem, line, controls, reporter), anderson, tau, solution, status)
      solution%contraction = max(contraction, solution%contraction)
      call judge_condition(solution)
   end subroutine continue_contact_line

   pure logical function has_coarse_start(line)
      type(contact_line_t), intent(in) :: line

      has_coarse_start = line%n > MOST_PLAIN
      if (has_coarse_start) has_coarse_start = has_coarse_line(line)
   end function has_coarse_start

   !> Begins where the line's coarse line ends. Whatever does not go well on the way leaves solution%converged false, and the caller
   !> begins anew.
   !>
   !> The coarse QP is made and solved, in the same way; states and bound are carried over, and the loop goes on with all points.
   recursive subroutine solve_from_coarse(task, solution, status)
      type(line_task_t), intent(in) :: task
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(interpolation_t) :: interpolation
      type(bound_qp_t) :: coarse_problem
      type(contact_line_t) :: coarse_line
      type(contact_solution_t) :: coarse
      type(anderson_t) :: anderson
      real(wp) :: tau(task%line%n)

      call coarsen_line(task%problem, task%line, interpolation, coarse_problem, coarse_line)
      call solve_coarse(coarse_problem, coarse_line, coarse, status)
      if (.not. coarse%converged) return
      call report_progress(task%reporter, 'start from '//to_text(coarse_line%n)//' of '//to_text(task%line%n)//' contact points')
      solution%history%tangential_of = tangential_of(task%line, task%problem%n_normal)
      call start_from_coarse(task%problem, task%line, interpolation, coarse_line, coarse%state, solution%bounds, &
                             solution%state, tau)
      call iterate_where_friction(task, anderson, tau, solution, status)
   end subroutine solve_from_coarse

   !> The loop; without friction there is none, and one QP is the solution.
   !>
   !> Without friction the one QP begins from the states that are given.
   subroutine iterate_where_friction(task, anderson, tau, solution, status)
      type(line_task_t), intent(in) :: task
      type(anderson_t), intent(inout) :: anderson
      real(wp), intent(inout) :: tau(:)              !< first bound
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      real(wp) :: image(task%line%n)

      if (task%line%has_friction) then
         call iterate(task, anderson, tau, solution, status)
      else
         call solve_with_bound(task%problem, task%line, tau, solution, image, status)
         solution%converged = is_ok(status) .and. solution%inner%solved
      end if
   end subroutine iterate_where_friction

   !> A coarse line need not be solved to the end, and not at all where that is hard.
   !>
   !> To 1e-3 in 30 iterations: what is wanted are states, and a bound that is right within some percent. Nothing is reported, and
   !> the solves are not in the log of iterations.
   recursive subroutine solve_coarse(problem, line, solution, status)
      type(bound_qp_t), intent(in), target :: problem
      type(contact_line_t), intent(in), target :: line
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(controls_t), parameter :: CONTROLS = controls_t(METHOD_ANDERSON, 1.0e-3_wp, 30_ip, 1.0_wp)
      type(reporter_t), parameter :: NOBODY = reporter_t(quiet=.true.)
      type(anderson_t) :: anderson
      type(contact_solution_t) :: nothing
      real(wp), allocatable :: tau(:)

      if (has_coarse_start(line)) then
         call solve_from_coarse(line_task_t(problem, line, CONTROLS, NOBODY), solution, status)
         if (solution%converged) return
         solution = nothing
      end if
      call start(problem, line, solution, tau, status)
      if (.not. is_ok(status)) return
      if (line%has_friction) then
         call iterate(line_task_t(problem, line, CONTROLS, NOBODY), anderson, tau, solution, status)
      else
         solution%converged = solution%inner%solved
      end if
   end subroutine solve_coarse

   !> From all points closed, by the method that the deck asks for.
   !>
   !> Also by the methods of the ladder (atrito_ladder): EASED, which asks Newton's method at first, and loops with small steps. A
   !> loop that a rung has begun and that does not converge has mostly found the states but for a few, so Newton's method goes on
   !> from there.
   subroutine solve_from_plain_start(task, solution, status, rows)
      type(line_task_t), intent(in) :: task
      type(contact_solution_t), intent(out) :: solution  !< what a start before left is forgotten
      type(status_t), intent(out) :: status
      type(constraint_rows_t), intent(in), optional :: rows
      type(picard_t) :: picard
      type(anderson_t) :: anderson
      type(start_t) :: plain
      real(wp), allocatable :: tau(:)

      if (present(rows)) solution%rows = rows
      call start(task%problem, task%line, solution, tau, status)
      if (.not. is_ok(status)) return
      if (.not. task%line%has_friction) then
         solution%converged = solution%inner%solved
         if (.not. solution%converged) solution%verdict = 'the active set did not settle'
         return
      end if
      select case (task%controls%method)
      case (METHOD_PICARD)
         picard%relaxation = task%controls%relaxation
         call iterate(task, picard, tau, solution, status)
      case (METHOD_EASED)
         plain = start_t(tau, solution%bounds, solution%state)
         if (.not. present(rows)) call newton_from(status)
         if (solution%converged) return
         solution%bounds = plain%bounds
         solution%state = plain%state
         call ease_friction(task, tau, solution, status)
      case default
         if (task%controls%method == METHOD_NEWTON .and. .not. present(rows)) then  ! with rows its matrix cannot be factored
            call newton_from(status)
         else
            anderson%mixing = task%controls%relaxation
            call iterate(task, anderson, tau, solution, status)
         end if
      end select
      ! where the loop has come to may be near enough
      if (task%controls%is_rung .and. any(task%controls%method == [METHOD_ANDERSON, METHOD_PICARD]) .and. is_ok(status) .and. &
          .not. (solution%converged .or. solution%inner%moves .or. present(rows))) then
         call iterate_newton(task%problem, task%line, task%controls, solution)
      end if

   contains

      !> One inner problem, then Newton's method on friction and contact at once.
      !>
      !> The QP brings the states near enough: Newton's method alone, from all closed, often goes astray.
      subroutine newton_from(status)
         type(status_t), intent(out) :: status
         real(wp) :: image(task%line%n)

         call begin_outer(solution%history)
         call solve_with_bound(task%problem, task%line, tau, solution, image, status)
         if (.not. is_ok(status)) return
         call end_outer(solution%history, relative_residual(task%line, tau, image))
         if (solution%inner%moves) then
            call set_status(status, STATUS_SINGULAR, FREE_MOTION)
            return
         end if
         call iterate_newton(task%problem, task%line, task%controls, solution)
      end subroutine newton_from

   end subroutine solve_from_plain_start

   !> All points closed without friction. Where that leaves a body free, all closed and stuck without a bound. tau: the first
   !> friction bound [F/L^2].
   !>
   !> The QP with tau = 0 is the problem without friction, whose pressures are mostly near those with friction: nu S_rho of them is
   !> the first bound. A body that only friction holds has no equilibrium then. With no bound at all on the shear every body that
   !> friction can hold is held; where one moves even so, nothing holds it: FREE_MOTION.
   subroutine start(problem, line, solution, tau, status)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(inout) :: solution
      real(wp), allocatable, intent(out) :: tau(:)
      type(status_t), intent(out) :: status
      real(wp) :: none(line%n)

      allocate (tau(line%n))
      solution%history%tangential_of = tangential_of(line, problem%n_normal)
      call normal_bounds(line, problem, solution%bounds, solution%state)
      none = 0.0_wp
      call solve_with_bound(problem, line, none, solution, tau, status)
      if (.not. is_ok(status)) return
      ! friction alone may hold the body: all points closed, and stuck without a bound
      if (solution%inner%moves .and. line%has_friction) then
         call normal_bounds(line, problem, solution%bounds, solution%state)
         where (line%tangential > 0) none = HUGE_REAL
         call solve_with_bound(problem, line, none, solution, tau, status)
         if (.not. is_ok(status)) return
      end if
      if (solution%inner%moves) call set_status(status, STATUS_SINGULAR, FREE_MOTION)
   end subroutine start

   !> From the solution with much more friction to that of the line: the coefficients take the factors LARGEST_FACTOR**s, s from 1
   !> to 0, each from the solution of the one before. A step that does not converge is halved. (With much friction points that carry
   !> pressure stick, so the states are found as without a bound; how they begin to slip is followed step by step.)
   !>
   !> As long as every step converges the factors are
   !>
   !>     64   22.6   8   2.8   1          s = 1, 3/4, 1/2, 1/4, 0
   !>
   !> 1. With 64 times the friction, from the plain start. Where that fails there is nothing to follow, and it ends. 2. s goes down
   !> by `step`. The bound of the solution before, times the factor of the step, is the first guess; Newton's method takes the
   !> states along, and the loop does where they change too much (solve_near). 3. A step that converges is doubled, up to a
   !> quarter; one that does not is halved, and tried again from the last solution. Below 1e-3, or with too many solves, it is
   !> given up.
   !>
   !> The last problem, at s = 0, is that of the line itself: the factors are a way, and leave nothing in the solution.
   subroutine ease_friction(task, tau, solution, status)
      type(line_task_t), intent(in) :: task
      real(wp), intent(in) :: tau(:)                 !< first bound
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(line_task_t) :: eased
      type(contact_line_t), target :: line
      type(start_t) :: last
      real(wp) :: s, step, bound(task%line%n)

      line = task%line
      eased = task
      eased%line => line
      last = start_t(LARGEST_FACTOR*tau, solution%bounds, solution%state)
      ! s > 1: not yet a solution; the first step is to find one with LARGEST_FACTOR times the friction
      s = 1.0_wp + FIRST_EASING
      step = FIRST_EASING
      do while (s > 0.0_wp)
         bound = last%tau
         ! the bound goes with the coefficient, as a first guess
         if (s <= 1.0_wp) bound = bound*LARGEST_FACTOR**(max(s - step, 0.0_wp) - s)
         line%law%nu = task%line%law%nu*LARGEST_FACTOR**max(s - step, 0.0_wp)
         call solve_near(eased, s <= 1.0_wp, last, bound, solution, status)
         if (solution%converged) then
            last = start_t(solution%tau, solution%bounds, solution%state)
            s = s - step
            step = min(2*step, FIRST_EASING)
         else
            if (s > 1.0_wp) return
            step = 0.5_wp*step
            if (step < LEAST_EASING .or. is_too_much(task%controls, task%problem%m, solution%history%n)) return
         end if
      end do
   end subroutine ease_friction

   !> From a solution that is near, or a start: Newton, then Anderson.
   !>
   !> From a solution Newton's method takes some steps; where states change so that it fails, the loop begins from the same place.
   subroutine solve_near(task, is_solved, near, tau, solution, status)
      type(line_task_t), intent(in) :: task
      logical, intent(in) :: is_solved               !< near is a solution
      type(start_t), intent(in) :: near
      real(wp), intent(in) :: tau(:)                 !< first bound
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(anderson_t) :: anderson
      real(wp) :: bound(task%line%n)

      solution%bounds = near%bounds
      solution%state = near%state
      bound = tau
      solution%tau = tau
      solution%converged = .false.
      if (.not. allocated(solution%rows) .and. is_solved) call iterate_newton(task%problem, task%line, task%controls, solution)
      if (solution%converged) return
      solution%bounds = near%bounds
      solution%state = near%state
      call iterate(task, anderson, bound, solution, status)
   end subroutine solve_near

end module atrito_outer_loop
