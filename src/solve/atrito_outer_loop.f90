!> The Picard loop on the weighted normal stress: tau <- nu S_rho(p(tau)), the fixed point of the existence proof.
module atrito_outer_loop
   use atrito_accelerator, only: accelerator_t, picard_t, anderson_t
   use atrito_box_problem, only: box_problem_t, box_bounds_t, box_state_t
   use atrito_coarse_line, only: interpolation_t, has_coarse_line, coarsen_line, start_from_coarse
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_line, only: contact_line_t, normal_bounds
   use atrito_contact_solution, only: contact_solution_t, solve_with_bound, judge_condition, has_settled, may_be_round_off, &
                                      relative_residual
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_model, only: controls_t, METHOD_ANDERSON, METHOD_PICARD, METHOD_NEWTON
   use atrito_newton, only: iterate_newton
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_solve_history, only: solve_history_t, begin_outer, end_outer
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: solve_contact_line, continue_contact_line, FREE_MOTION

   !> Text of the status when no friction bound of the loop holds a body; solution%inner%motion is the motion.
   character(len=*), parameter :: FREE_MOTION = 'free motion'

   integer(ip), parameter :: MOST_PLAIN = 200             !< points of a line that needs no coarse one to start from
   integer(ip), parameter :: MOST_STEPS_BACK = 6
   integer(ip), parameter :: LAST_RESORT_FACTOR = 4       !< times MAXIT
   real(wp), parameter :: LAST_RESORT_MIXING = 0.3_wp
   integer(ip), parameter :: LONGEST_CYCLE = 6
   integer(ip), parameter :: STALE = 10                   !< iterations in which the residual is not halved
   real(wp), parameter :: STALE_RESIDUAL = 1.0e-8_wp      !< that is accepted then
   integer(ip), parameter :: LEAST_SOLVES = 200           !< before it is given up

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

   !> What the loop remembers of its bounds.
   type :: loop_t
      real(wp), allocatable :: good(:), good_image(:)      !< (n) the last bound that held all bodies; not allocated: none so far
      real(wp), allocatable :: visited(:, :)               !< (n, LONGEST_CYCLE) newest first; -1: none
      real(wp) :: last_residual = -1.0_wp                  !< < 0: none
      real(wp) :: best_residual = HUGE_REAL
      integer(ip) :: best_outer = 0
      integer(ip) :: steps_back = 0
   end type loop_t

contains

   !> Solves the contact line. Not converged: solution%converged is false and solution%verdict says why.
   !> status: STATUS_SINGULAR with FREE_MOTION, or with dependent contact points, which needs the rows.
   subroutine solve_contact_line(problem, line, controls, reporter, solution, status, rows)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(constraint_rows_t), intent(in), optional :: rows !< of the unknowns: they may depend on each other

      if (has_coarse_start(line) .and. .not. present(rows) .and. &
          (controls%method == METHOD_ANDERSON .or. .not. line%has_friction)) then
         call solve_from_coarse(problem, line, controls, reporter, solution, status)
      end if
      if (.not. solution%converged) call solve_from_plain_start(problem, line, controls, reporter, solution, status, rows)
      call judge_condition(solution)
   end subroutine solve_contact_line

   !> Solves again, from the solution of a problem that differs by little. status: as of solve_contact_line.
   subroutine continue_contact_line(problem, line, controls, reporter, solution, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(anderson_t) :: anderson
      real(wp) :: tau(line%n), image(line%n), contraction

      tau = solution%tau
      if (line%has_friction) then
         contraction = solution%contraction
         call iterate(problem, line, controls, reporter, anderson, tau, solution, status)
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
   recursive subroutine solve_from_coarse(problem, line, controls, reporter, solution, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(interpolation_t) :: interpolation
      type(box_problem_t) :: coarse_problem
      type(contact_line_t) :: coarse_line
      type(contact_solution_t) :: coarse
      type(anderson_t) :: anderson
      real(wp) :: tau(line%n), image(line%n)

      call coarsen_line(problem, line, interpolation, coarse_problem, coarse_line)
      call solve_coarse(coarse_problem, coarse_line, coarse, status)
      if (.not. coarse%converged) return
      call report_progress(reporter, 'start from '//to_text(coarse_line%n)//' of '//to_text(line%n)//' contact points')
      call begin_history(problem, line, solution)
      call start_from_coarse(problem, line, interpolation, coarse_line, coarse%state, coarse%p, solution%bounds, solution%state, &
                             tau)
      if (line%has_friction) then
         call iterate(problem, line, controls, reporter, anderson, tau, solution, status)
      else
         call solve_with_bound(problem, line, tau, solution, image, status)
         solution%converged = is_ok(status) .and. solution%inner%solved
      end if
   end subroutine solve_from_coarse

   !> A coarse line need not be solved to the end, and not at all where that is hard.
   recursive subroutine solve_coarse(problem, line, solution, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(controls_t), parameter :: CONTROLS = controls_t(METHOD_ANDERSON, 1.0e-3_wp, 30_ip, 1.0_wp)
      type(reporter_t), parameter :: NOBODY = reporter_t(quiet=.true.)
      type(anderson_t) :: anderson
      type(contact_solution_t) :: nothing
      real(wp), allocatable :: tau(:)

      if (has_coarse_start(line)) then
         call solve_from_coarse(problem, line, CONTROLS, NOBODY, solution, status)
         if (solution%converged) return
         solution = nothing
      end if
      call start(problem, line, solution, tau, status)
      if (.not. is_ok(status)) return
      if (line%has_friction) then
         call iterate(problem, line, CONTROLS, NOBODY, anderson, tau, solution, status)
      else
         solution%converged = solution%inner%solved
      end if
   end subroutine solve_coarse

   subroutine solve_from_plain_start(problem, line, controls, reporter, solution, status, rows)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      type(contact_solution_t), intent(out) :: solution  !< what a start before left is forgotten
      type(status_t), intent(out) :: status
      type(constraint_rows_t), intent(in), optional :: rows
      real(wp), allocatable :: tau(:)

      if (present(rows)) solution%rows = rows
      call start(problem, line, solution, tau, status)
      if (.not. is_ok(status)) return
      if (.not. line%has_friction) then
         call finish_frictionless(solution)
         return
      end if
      select case (controls%method)
      case (METHOD_PICARD)
         call iterate_picard(problem, line, controls, reporter, tau, solution, status)
      case (METHOD_NEWTON)
         if (present(rows)) then                             ! whose matrix cannot be factored
            call iterate_with_fallbacks(problem, line, controls, reporter, tau, solution, status)
         else
            call newton_from(problem, line, controls, tau, solution, status)
         end if
      case default
         call iterate_with_fallbacks(problem, line, controls, reporter, tau, solution, status)
      end select
   end subroutine solve_from_plain_start

   subroutine begin_history(problem, line, solution)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(inout) :: solution

      solution%history%tangential_of = line%tangential(line%point(:problem%n_normal))
   end subroutine begin_history

   !> All points closed without friction. Where that leaves a body free, all closed and stuck without a bound. tau: the first
   !> friction bound.
   subroutine start(problem, line, solution, tau, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(inout) :: solution
      real(wp), allocatable, intent(out) :: tau(:)
      type(status_t), intent(out) :: status
      real(wp) :: none(line%n)

      allocate (tau(line%n))
      call begin_history(problem, line, solution)
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

   subroutine finish_frictionless(solution)
      type(contact_solution_t), intent(inout) :: solution

      solution%converged = solution%inner%solved
      if (.not. solution%converged) solution%verdict = 'the active set did not settle'
   end subroutine finish_frictionless

   !> The paper's loop; a cycle is told.
   subroutine iterate_picard(problem, line, controls, reporter, tau, solution, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      real(wp), intent(inout) :: tau(:)
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(picard_t) :: picard

      picard%relaxation = controls%relaxation
      call iterate(problem, line, controls, reporter, picard, tau, solution, status)
   end subroutine iterate_picard

   !> One inner problem, then Newton.
   subroutine newton_from(problem, line, controls, tau, solution, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      real(wp), intent(in) :: tau(:)
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      real(wp) :: image(line%n)

      call begin_outer(solution%history)
      call solve_with_bound(problem, line, tau, solution, image, status)
      if (.not. is_ok(status)) return
      call end_outer(solution%history, relative_residual(line, tau, image))
      if (solution%inner%moves) then
         call set_status(status, STATUS_SINGULAR, FREE_MOTION)
         return
      end if
      call iterate_newton(problem, line, controls, solution)
   end subroutine newton_from

   !> Anderson; where it does not converge or finds no equilibrium, the others in the order that random scenes taught
   !> (docs/theory/formulation.md, section 5); then the honest end, which is that of Anderson.
   subroutine iterate_with_fallbacks(problem, line, controls, reporter, tau, solution, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      real(wp), intent(inout) :: tau(:)
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(anderson_t) :: anderson
      type(start_t) :: first
      type(contact_solution_t) :: found
      type(status_t) :: outcome, dependent
      integer :: attempt

      call keep_start(tau, solution, first)
      call iterate(problem, line, controls, reporter, anderson, tau, solution, status)
      if (solution%converged) return
      if (.not. (is_ok(status) .or. is_free_motion(status))) return
      found = solution
      do attempt = 1, size(ATTEMPTS)
         if (is_too_much(problem, controls, found%history)) exit
         call report_progress(reporter, 'not converged; '//trim(ATTEMPTS(attempt)))
         call try_again(problem, line, controls, reporter, attempt, first, found, outcome)
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

   !> One of the ATTEMPTS.
   subroutine try_again(problem, line, controls, reporter, attempt, first, solution, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      integer, intent(in) :: attempt                 !< place in ATTEMPTS
      type(start_t), intent(in) :: first
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(anderson_t) :: anderson
      type(picard_t) :: picard
      type(controls_t) :: patient
      real(wp) :: tau(line%n)

      patient = controls
      tau = first%tau
      if (attempt /= NEWTON_FROM_LAST) then
         solution%bounds = first%bounds
         solution%state = first%state
      end if
      select case (attempt)
      case (PLAIN_PICARD)
         call iterate(problem, line, controls, reporter, picard, tau, solution, status)
      case (NEWTON_FROM_LAST)
         ! Newton's matrix cannot be factored where rows depend on each other
         if (.not. allocated(solution%rows) .and. .not. solution%inner%moves) call iterate_newton(problem, line, controls, solution)
      case (SMALL_STEPS)
         anderson%mixing = LAST_RESORT_MIXING
         patient%max_iterations = LAST_RESORT_FACTOR*controls%max_iterations
         call iterate(problem, line, patient, reporter, anderson, tau, solution, status)
      case (MORE_FRICTION)
         call ease_friction(problem, line, controls, reporter, first, solution, status)
      end select
   end subroutine try_again

   !> From a solution with much more friction to that of the line: the coefficients take the factors LARGEST_FACTOR**s, s from 1 to
   !> 0, each from the solution of the one before. A step that does not converge is halved.
   subroutine ease_friction(problem, line, controls, reporter, first, solution, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      type(start_t), intent(in) :: first
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(contact_line_t) :: eased
      type(start_t) :: last
      real(wp) :: s, step, tau(line%n)

      eased = line
      last = first
      last%tau = LARGEST_FACTOR*first%tau
      s = 1.0_wp + FIRST_EASING
      step = FIRST_EASING
      do while (s > 0.0_wp)
         tau = last%tau
         if (s <= 1.0_wp) tau = tau*LARGEST_FACTOR**(max(s - step, 0.0_wp) - s)
         eased%law%nu = line%law%nu*LARGEST_FACTOR**max(s - step, 0.0_wp)
         call solve_near(problem, eased, controls, reporter, s <= 1.0_wp, last, tau, solution, status)
         if (solution%converged) then
            call keep_start(solution%tau, solution, last)
            s = s - step
            step = min(2*step, FIRST_EASING)
         else
            if (s > 1.0_wp) return
            step = 0.5_wp*step
            if (step < LEAST_EASING .or. is_too_much(problem, controls, solution%history)) return
         end if
      end do
   end subroutine ease_friction

   !> From a solution that is near: Newton, then Anderson.
   subroutine solve_near(problem, line, controls, reporter, is_solved, near, tau, solution, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      logical, intent(in) :: is_solved               !< near is a solution
      type(start_t), intent(in) :: near
      real(wp), intent(in) :: tau(:)                 !< first bound
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(anderson_t) :: anderson
      real(wp) :: bound(line%n)

      solution%bounds = near%bounds
      solution%state = near%state
      bound = tau
      solution%tau = tau
      solution%converged = .false.
      if (.not. allocated(solution%rows) .and. is_solved) call iterate_newton(problem, line, controls, solution)
      if (solution%converged) return
      solution%bounds = near%bounds
      solution%state = near%state
      call iterate(problem, line, controls, reporter, anderson, bound, solution, status)
   end subroutine solve_near

   !> The loop: solve with the bound, compare with its image, next bound.
   subroutine iterate(problem, line, controls, reporter, accelerator, tau, solution, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      class(accelerator_t), intent(inout) :: accelerator
      real(wp), intent(inout) :: tau(:)
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      type(loop_t) :: loop
      real(wp) :: image(size(tau))
      integer(ip) :: outer
      logical :: cycles

      solution%converged = .false.
      solution%contraction = 0.0_wp
      allocate (loop%visited(size(tau), LONGEST_CYCLE), source=-1.0_wp)
      call accelerator%reset()
      do outer = 1, controls%max_iterations
         call begin_outer(solution%history)
         call solve_with_bound(problem, line, tau, solution, image, status)
         if (.not. is_ok(status)) return
         if (solution%inner%moves) then
            call step_back(loop, accelerator, tau, status)
            if (.not. is_ok(status)) return
            cycle
         end if
         if (.not. solution%inner%solved .or. is_too_much(problem, controls, solution%history)) exit
         solution%residual = relative_residual(line, tau, image)
         call end_outer(solution%history, solution%residual)
         call tell(reporter, outer, solution)
         call judge_step(line, controls%tolerance, outer, tau, image, loop, solution)
         if (solution%converged) return
         loop%good = tau
         loop%good_image = image
         call accelerator%update(loop%good, image, tau)
         call look_for_cycle(line, controls%method, tau, loop, solution, cycles)
         if (cycles) return
      end do
      solution%verdict = 'the outer loop did not converge in '//to_text(controls%max_iterations)//' iterations (residual ' &
                         //to_text(solution%residual, 3)//')'
      if (is_too_much(problem, controls, solution%history)) solution%verdict = 'the loop was given up after ' &
                                                                               //to_text(solution%history%n)//' linear solves'
      if (.not. solution%inner%solved) solution%verdict = 'the active set did not settle'
   end subroutine iterate

   !> Whether the attempts so far went through so many entries of C that the other form of the contact system is cheaper.
   pure logical function is_too_much(problem, controls, history)
      type(box_problem_t), intent(in) :: problem
      type(controls_t), intent(in) :: controls
      type(solve_history_t), intent(in) :: history

      is_too_much = history%n > LEAST_SOLVES .and. real(history%n, wp)*real(problem%m, wp)**2 > controls%most_entries
   end function is_too_much

   !> The bound does not hold a body: half way back to the last one that did, or twice as much where none did so far.
   !> status: STATUS_SINGULAR with FREE_MOTION when that was done often enough.
   subroutine step_back(loop, accelerator, tau, status)
      type(loop_t), intent(inout) :: loop
      class(accelerator_t), intent(inout) :: accelerator
      real(wp), intent(inout) :: tau(:)
      type(status_t), intent(out) :: status

      if (loop%steps_back == MOST_STEPS_BACK) then
         call set_status(status, STATUS_SINGULAR, FREE_MOTION)
         return
      end if
      loop%steps_back = loop%steps_back + 1
      call accelerator%reset()
      if (allocated(loop%good)) then
         tau = 0.5_wp*(tau + loop%good)
      else
         tau = 2*tau
      end if
   end subroutine step_back

   !> Whether the loop has converged with this bound and its image; and how fast it goes.
   subroutine judge_step(line, tolerance, outer, tau, image, loop, solution)
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: tolerance
      integer(ip), intent(in) :: outer
      real(wp), intent(in) :: tau(:), image(:)
      type(loop_t), intent(inout) :: loop
      type(contact_solution_t), intent(inout) :: solution

      if (allocated(loop%good) .and. maxval(tau) > 0.0_wp) then
         call measure_rate(line%weight/maxval(line%weight), (tau - loop%good)/maxval(tau), (image - loop%good_image)/maxval(tau), &
                           solution%contraction)
      end if
      if (may_be_round_off(loop%last_residual, solution%residual)) call judge_condition(solution)
      solution%converged = has_settled(tolerance, solution%inner%condition, loop%last_residual, solution%residual)
      loop%last_residual = solution%residual
      if (solution%residual < 0.5_wp*loop%best_residual) then
         loop%best_residual = solution%residual
         loop%best_outer = outer
      end if
      ! round-off that the matrix does not tell: displacements far below the initial gaps
      if (outer - loop%best_outer < STALE .or. solution%converged) return
      solution%converged = relative_residual(line, tau, image, beside_noise=.true.) <= STALE_RESIDUAL
      if (solution%converged) solution%residual = min(solution%residual, STALE_RESIDUAL)
   end subroutine judge_step

   !> Whether the next bound was there before; the verdict says so.
   subroutine look_for_cycle(line, method, tau, loop, solution, cycles)
      type(contact_line_t), intent(in) :: line
      integer, intent(in) :: method
      real(wp), intent(in) :: tau(:)
      type(loop_t), intent(inout) :: loop
      type(contact_solution_t), intent(inout) :: solution
      logical, intent(out) :: cycles
      integer(ip) :: length

      call find_cycle(line, loop%visited, tau, solution%residual, length)
      cycles = length > 1 .and. loop%steps_back == 0
      if (.not. cycles) return
      solution%verdict = 'the loop cycles between '//to_text(length)//' states'
      if (method == METHOD_PICARD) solution%verdict = solution%verdict//'; METHOD=ANDERSON may find the solution'
   end subroutine look_for_cycle

   !> How much larger the images of two bounds differ than the bounds, whatever made the step between them: the largest so far.
   pure subroutine measure_rate(weight, step, answer, rate)
      real(wp), intent(in) :: weight(:)             !< relative to the largest
      real(wp), intent(in) :: step(:), answer(:)    !< relative to the largest bound
      real(wp), intent(inout) :: rate
      real(wp), parameter :: LEAST_STEP = 1.0e-6_wp !< below it round-off is measured

      if (maxval(abs(step)) <= LEAST_STEP) return
      rate = max(rate, norm2(sqrt(weight)*answer)/norm2(sqrt(weight)*step))
   end subroutine measure_rate

   subroutine tell(reporter, outer, solution)
      type(reporter_t), intent(in) :: reporter
      integer(ip), intent(in) :: outer
      type(contact_solution_t), intent(in) :: solution

      associate (record => solution%history%records(solution%history%n))
         call report_progress(reporter, 'outer '//to_text(outer)//'  solves '//to_text(record%inner) &
                              //'  open '//to_text(record%open)//'  stick '//to_text(record%stick) &
                              //'  slip '//to_text(record%slip)//'  residual '//to_text(solution%residual, 3))
      end associate
   end subroutine tell

   !> Compares the next bound with the last ones: the same again after two steps or more, while the residual stays, is a cycle.
   pure subroutine find_cycle(line, visited, tau, residual, length)
      type(contact_line_t), intent(in) :: line
      real(wp), intent(inout) :: visited(:, :)        !< newest first
      real(wp), intent(in) :: tau(:), residual
      integer(ip), intent(out) :: length              !< 0: none
      real(wp), parameter :: SAME = 1.0e-6_wp         !< of the residual
      integer(ip) :: k

      length = 0
      do k = 2, LONGEST_CYCLE
         if (any(visited(:, k) < 0.0_wp)) exit
         if (relative_residual(line, visited(:, k), tau) < SAME*residual) then
            length = k
            exit
         end if
      end do
      visited(:, 2:) = visited(:, :LONGEST_CYCLE - 1)
      visited(:, 1) = tau
   end subroutine find_cycle

end module atrito_outer_loop
