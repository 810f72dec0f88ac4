!> Where the Picard loop on the weighted normal stress, tau <- nu S_rho(p(tau)), the fixed point of the existence proof, begins,
!> and what is tried where it does not converge.
module atrito_outer_loop
   use atrito_accelerator, only: picard_t, anderson_t
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t
   use atrito_coarse_line, only: interpolation_t, has_coarse_line, coarsen_line, start_from_coarse
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_line, only: contact_line_t, normal_bounds, tangential_of
   use atrito_contact_solution, only: contact_solution_t, FREE_MOTION, judge_condition, relative_residual
   use atrito_controls, only: controls_t, METHOD_ANDERSON, METHOD_PICARD, METHOD_NEWTON
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
   integer(ip), parameter :: LAST_RESORT_FACTOR = 4       !< times MAXIT
   real(wp), parameter :: LAST_RESORT_MIXING = 0.3_wp

   !> What is tried where the loop does not converge, in this order.
   integer, parameter :: PLAIN_PICARD = 1, NEWTON_FROM_LAST = 2, SMALL_STEPS = 3, MORE_FRICTION = 4
   character(len=25), parameter :: ATTEMPTS(4) = [character(len=25) :: 'PICARD', 'NEWTON', 'ANDERSON with small steps', &
                                                                                                               'from more friction']
   real(wp), parameter :: LARGEST_FACTOR = 64.0_wp        !< of the friction that is eased
   real(wp), parameter :: FIRST_EASING = 0.25_wp          !< steps of its exponent
   real(wp), parameter :: LEAST_EASING = 1.0e-3_wp

   !> Where an attempt begins.
   type :: start_t
      real(wp), allocatable :: tau(:)
      type(box_bounds_t) :: bounds
      type(box_state_t) :: state
   end type start_t

contains

   !> Solves the contact line: the pressures, shears and states of all points, with the law's own bound. Long lines start from the
   !> solution of a coarser one. Not converged: solution%converged is false and solution%verdict says why.
   !> status: STATUS_SINGULAR with FREE_MOTION, or with dependent contact points, which needs the rows.
   subroutine solve_contact_line(problem, line, controls, reporter, solution, status, rows)
      type(bound_qp_t), intent(in), target :: problem
      type(contact_line_t), intent(in), target :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(constraint_rows_t), intent(in), optional :: rows !< of the unknowns: they may depend on each other

      if (has_coarse_start(line) .and. .not. present(rows) .and. &
          (controls%method == METHOD_ANDERSON .or. .not. line%has_friction)) then
         call solve_from_coarse(line_task_t(problem, line, controls, reporter), solution, status)
      end if
      if (.not. solution%converged) then
         call solve_from_plain_start(line_task_t(problem, line, controls, reporter), solution, status, rows)
      end if
      call judge_condition(solution)
   end subroutine solve_contact_line

   !> Solves again, from the solution of a problem that differs by little, such as the increment before: its states, factor and
   !> bound are where the loop begins. status: as of solve_contact_line.
   subroutine continue_contact_line(problem, line, controls, reporter, solution, status)
      type(bound_qp_t), intent(in), target :: problem
      type(contact_line_t), intent(in), target :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(anderson_t) :: anderson
      real(wp) :: tau(line%n), image(line%n), contraction

      tau = solution%tau
      if (line%has_friction) then
         contraction = solution%contraction
         call iterate(line_task_t(problem, line, controls, reporter), anderson, tau, solution, status)
         if (is_ok(status) .and. .not. (solution%converged .or. allocated(solution%rows))) then
            call iterate_newton(problem, line, controls, solution)
         end if
         solution%contraction = max(contraction, solution%contraction)
      else
         call solve_with_bound(problem, line, tau, solution, image, status)
         solution%converged = is_ok(status) .and. solution%inner%solved
      end if
      call judge_condition(solution)
   end subroutine continue_contact_line

   pure logical function has_coarse_start(line)
      type(contact_line_t), intent(in) :: line

      has_coarse_start = line%n > MOST_PLAIN
      if (has_coarse_start) has_coarse_start = has_coarse_line(line)
   end function has_coarse_start

   !> Begins where the line's coarse line ends. Whatever does not go well on the way leaves solution%converged false, and the caller
   !> begins anew.
   recursive subroutine solve_from_coarse(task, solution, status)
      type(line_task_t), intent(in) :: task
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(interpolation_t) :: interpolation
      type(bound_qp_t) :: coarse_problem
      type(contact_line_t) :: coarse_line
      type(contact_solution_t) :: coarse
      type(anderson_t) :: anderson
      real(wp) :: tau(task%line%n), image(task%line%n)

      call coarsen_line(task%problem, task%line, interpolation, coarse_problem, coarse_line)
      call solve_coarse(coarse_problem, coarse_line, coarse, status)
      if (.not. coarse%converged) return
      call report_progress(task%reporter, 'start from '//to_text(coarse_line%n)//' of '//to_text(task%line%n)//' contact points')
      solution%history%tangential_of = tangential_of(task%line, task%problem%n_normal)
      call start_from_coarse(task%problem, task%line, interpolation, coarse_line, coarse%state, solution%bounds, &
                             solution%state, tau)
      if (task%line%has_friction) then
         call iterate(task, anderson, tau, solution, status)
      else
         call solve_with_bound(task%problem, task%line, tau, solution, image, status)
         solution%converged = is_ok(status) .and. solution%inner%solved
      end if
   end subroutine solve_from_coarse

   !> A coarse line need not be solved to the end, and not at all where that is hard.
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
   subroutine solve_from_plain_start(task, solution, status, rows)
      type(line_task_t), intent(in) :: task
      type(contact_solution_t), intent(out) :: solution  !< what a start before left is forgotten
      type(status_t), intent(out) :: status
      type(constraint_rows_t), intent(in), optional :: rows
      type(picard_t) :: picard
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
      case (METHOD_NEWTON)
         if (present(rows)) then                             ! whose matrix cannot be factored
            call iterate_with_fallbacks(task, tau, solution, status)
         else
            call newton_from(task, tau, solution, status)
         end if
      case default
         call iterate_with_fallbacks(task, tau, solution, status)
      end select
   end subroutine solve_from_plain_start

   !> All points closed without friction. Where that leaves a body free, all closed and stuck without a bound. tau: the first
   !> friction bound [F/L^2].
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
      if (solution%inner%moves .and. line%has_friction) then
         call normal_bounds(line, problem, solution%bounds, solution%state)
         where (line%tangential > 0) none = HUGE_REAL
         call solve_with_bound(problem, line, none, solution, tau, status)
         if (.not. is_ok(status)) return
      end if
      if (solution%inner%moves) call set_status(status, STATUS_SINGULAR, FREE_MOTION)
   end subroutine start

   !> One inner problem, then Newton's method on friction and contact at once.
   subroutine newton_from(task, tau, solution, status)
      type(line_task_t), intent(in) :: task
      real(wp), intent(in) :: tau(:)
      type(contact_solution_t), intent(inout) :: solution
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

   !> Anderson; where it does not converge or finds no equilibrium, the others in the order that random scenes taught
   !> (docs/theory/formulation.md, section 5); then the honest end, which is that of Anderson.
   subroutine iterate_with_fallbacks(task, tau, solution, status)
      type(line_task_t), intent(in) :: task
      real(wp), intent(inout) :: tau(:)
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(anderson_t) :: anderson
      type(start_t) :: first
      type(contact_solution_t) :: found
      type(status_t) :: outcome, dependent
      integer :: attempt

      call keep_start(tau, solution, first)
      call iterate(task, anderson, tau, solution, status)
      if (solution%converged .or. task%controls%is_first) return
      if (.not. (is_ok(status) .or. is_free_motion(status))) return
      found = solution
      do attempt = 1, size(ATTEMPTS)
         if (is_too_much(task, found%history) .or. (task%controls%is_brief .and. attempt >= SMALL_STEPS)) exit
         call report_progress(task%reporter, 'not converged; '//trim(ATTEMPTS(attempt)))
         call try_again(task, attempt, first, found, outcome)
         if (.not. (is_ok(outcome) .or. is_free_motion(outcome))) dependent = outcome
         if (.not. found%converged) cycle
         solution = found
         status = outcome
         return
      end do
      solution%history = found%history
      if (.not. is_ok(dependent)) status = dependent         ! the caller has the rows
   end subroutine iterate_with_fallbacks

   pure logical function is_free_motion(status)
      type(status_t), intent(in) :: status

      is_free_motion = status%code == STATUS_SINGULAR
      if (is_free_motion) is_free_motion = status%text == FREE_MOTION
   end function is_free_motion

   pure subroutine keep_start(tau, solution, first)
      real(wp), intent(in) :: tau(:)
      type(contact_solution_t), intent(in) :: solution
      type(start_t), intent(out) :: first

      first%tau = tau
      first%bounds = solution%bounds
      first%state = solution%state
   end subroutine keep_start

   !> One of the ATTEMPTS, from the start that Anderson had; Newton from where the last attempt ended.
   subroutine try_again(task, attempt, first, solution, status)
      type(line_task_t), intent(in) :: task
      integer, intent(in) :: attempt                 !< place in ATTEMPTS
      type(start_t), intent(in) :: first
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(anderson_t) :: anderson
      type(picard_t) :: picard
      type(line_task_t) :: patient
      real(wp) :: tau(task%line%n)

      patient = task
      tau = first%tau
      if (attempt /= NEWTON_FROM_LAST) then
         solution%bounds = first%bounds
         solution%state = first%state
      end if
      select case (attempt)
      case (PLAIN_PICARD)
         call iterate(task, picard, tau, solution, status)
      case (NEWTON_FROM_LAST)
         ! Newton's matrix cannot be factored where rows depend on each other
         if (.not. allocated(solution%rows) .and. .not. solution%inner%moves) call iterate_newton(task%problem, task%line, &
                                                                                                  task%controls, solution)
      case (SMALL_STEPS)
         anderson%mixing = LAST_RESORT_MIXING
         patient%controls%max_iterations = LAST_RESORT_FACTOR*task%controls%max_iterations
         call iterate(patient, anderson, tau, solution, status)
      case (MORE_FRICTION)
         call ease_friction(task, first, solution, status)
      end select
   end subroutine try_again

   !> From a solution with much more friction to that of the line: the coefficients take the factors LARGEST_FACTOR**s, s from 1 to
   !> 0, each from the solution of the one before. A step that does not converge is halved.
   subroutine ease_friction(task, first, solution, status)
      type(line_task_t), intent(in) :: task
      type(start_t), intent(in) :: first
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(line_task_t) :: eased
      type(contact_line_t), target :: line
      type(start_t) :: last
      real(wp) :: s, step, tau(task%line%n)

      line = task%line
      eased = task
      eased%line => line
      last = first
      last%tau = LARGEST_FACTOR*first%tau
      s = 1.0_wp + FIRST_EASING
      step = FIRST_EASING
      do while (s > 0.0_wp)
         tau = last%tau
         if (s <= 1.0_wp) tau = tau*LARGEST_FACTOR**(max(s - step, 0.0_wp) - s)
         line%law%nu = task%line%law%nu*LARGEST_FACTOR**max(s - step, 0.0_wp)
         call solve_near(eased, s <= 1.0_wp, last, tau, solution, status)
         if (solution%converged) then
            call keep_start(solution%tau, solution, last)
            s = s - step
            step = min(2*step, FIRST_EASING)
         else
            if (s > 1.0_wp) return
            step = 0.5_wp*step
            if (step < LEAST_EASING .or. is_too_much(task, solution%history)) return
         end if
      end do
   end subroutine ease_friction

   !> From a solution that is near, or a start: Newton, then Anderson.
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
