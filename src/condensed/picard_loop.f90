!> The Picard loop on the weighted normal stress, with the accelerator that it is given.
!>
!> The friction law of Oden and Pires bounds the shear at a point by nu S_rho(p): the coefficient times the pressure, weighted over
!> a length rho. The bound depends on the pressure, the pressure on the shear, so what is sought is a fixed point. Let p(tau) be
!> the pressure of the contact problem with the bound frozen at tau: that is a convex problem with one solution (Tresca's), which
!> `solve_with_bound` finds exactly. The loop is
!>
!>     tau_0 given,    tau_(k+1) = nu S_rho(p(tau_k)),                                                  (Picard)
!>
!> the iteration of the existence proof; S_rho makes the map compact, and for small nu it contracts. Its rate is measured on the
!> way (`measure_rate`) and printed. An accelerator takes the bound and its image and says what the next bound is: Picard's own, or
!> Anderson's mixing of the last ones (atrito_accelerator), which takes fewer steps.
!>
!> The loop stops when bound and image agree to the tolerance, pair by pair; when round-off, as the condition of the contact matrix
!> tells it, leaves no more to gain; when bounds come again in a cycle; or when no bound holds the bodies.
!>
!> Why there is a fixed point, and when the loop finds it. Where the line is held without friction, the forces without friction are
!> admissible for every tau. The energy that the QP makes least is there a number that no tau changes, so all q(tau) lie where a
!> convex function is no larger than that, in one bounded set. The q of least energy goes continuously with its bounds. A
!> continuous map of a bounded convex set of bounds into itself has a fixed point (Brouwer). Between two bounds
!>
!>     |p(tau_1) - p(tau_2)| <= L |tau_1 - tau_2|,     so that     |image_1 - image_2| <= nu |S_rho| L |tau_1 - tau_2|,
!>
!> L being the greatest rate at which pressure follows friction in any set of states. Where nu |S_rho| L < 1 the map contracts: one
!> fixed point, and the error falls at least by that factor at each step. L comes from the coupling C_nt of tangential and normal
!> forces (atrito_contraction estimates it); without any the first image is the fixed point. With a larger nu there may be several
!> fixed points, or the loop may go round between sets of states, which it notices (find_cycle).
!>
!> Source: E. B. Pires and P. Providencia e Costa (1991); L. T. Campos, J. T. Oden and N. Kikuchi, Comput. Methods Appl. Mech. Eng.
!> 34 (1982) 821-845, for the problem with the bound frozen.
module atrito_picard_loop
   use atrito_accelerator, only: accelerator_t
   use atrito_bound_qp, only: bound_qp_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_solution, only: contact_solution_t, FREE_MOTION, judge_condition, has_settled, may_be_round_off, &
                                      relative_residual
   use atrito_controls, only: controls_t, METHOD_PICARD
   use atrito_frozen_bound, only: solve_with_bound
   use atrito_kinds, only: ip, wp
   use atrito_loop_progress, only: loop_progress_t, note_residual, report_step
   use atrito_reporter, only: reporter_t
   use atrito_solve_history, only: begin_outer, end_outer
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: line_task_t, iterate, is_too_much

   !> What is to be solved, how, and who is told of it.
   !>
   !> problem: the QP of the line (C, G, g0, h); line: points, laws, the average S_rho; controls: tolerance, MAXIT, method.
   type :: line_task_t
      type(bound_qp_t), pointer :: problem => null() !< C, G, g0, h of the line
      type(contact_line_t), pointer :: line => null() !< points, laws, the average S_rho
      type(controls_t) :: controls                    !< tolerance, MAXIT, method
      type(reporter_t) :: reporter                    !< a line an iteration
   end type line_task_t

   ! Six halvings come within 2 % of a bound that held; six doublings make 64 times the first one.
   integer(ip), parameter :: MOST_STEPS_BACK = 6
   integer(ip), parameter :: LONGEST_CYCLE = 6
   integer(ip), parameter :: STALE = 10                   !< iterations in which the residual is not halved
   real(wp), parameter :: STALE_RESIDUAL = 1.0e-8_wp      !< that is accepted then
   integer(ip), parameter :: LEAST_SOLVES = 200           !< before it is given up
   integer(ip), parameter :: STALLED = 4                  !< iterations in which the residual is not halved, to be given up then

   !> What the loop remembers of its bounds.
   !>
   !> A bound holds all bodies where the QP has a solution with it. Since friction alone may hold a body, too small a bound lets it
   !> go: then there is no pressure to take the next bound from, and the loop goes back towards a bound that did hold.
   type :: loop_t
      real(wp), allocatable :: good(:), good_image(:)      !< (n) the last bound that held all bodies; not allocated: none so far
      real(wp), allocatable :: visited(:, :)               !< (n, LONGEST_CYCLE) newest first; -1: none
      real(wp) :: last_residual = -1.0_wp                  !< < 0: none
      type(loop_progress_t) :: progress                    !< best residual so far, and where
      integer(ip) :: steps_back = 0                        !< halvings since a bound held all bodies
   end type loop_t

contains

   !> The loop: solve with the bound, compare it with its image, take the next one. tau: the first bound in, the last one out.
   !> solution: with the state of a solve before, which is where the first one starts. Not converged: solution%verdict says why.
   !> status: STATUS_SINGULAR with FREE_MOTION where no bound that was tried holds the bodies, or with dependent contact points.
   !>
   !> Each pass is one QP with the bound tau, from the state of the last one, and one of:
   !>
   !>     a body moves        tau goes half way back to the last bound that held all bodies (step_back)
   !>     not solved          the active set has not settled: the loop ends
   !>     converged           tau and its image agree, or differ by round-off (judge_step)
   !>     too much work       and the residual has not been halved in STALLED passes: the loop ends
   !>     otherwise           the accelerator gives the next bound; one that was there before is a cycle (look_for_cycle)
   subroutine iterate(task, accelerator, tau, solution, status)
      type(line_task_t), intent(in) :: task !< what is solved, how, and who is told
      class(accelerator_t), intent(inout) :: accelerator !< which gives the next bound from those that were tried
      real(wp), intent(inout) :: tau(:)             !< (n) [F/L^2]
      type(contact_solution_t), intent(inout) :: solution !< with a state to start from
      type(status_t), intent(out) :: status               !< STATUS_SINGULAR with FREE_MOTION or DEPENDENT_POINTS
      type(loop_t) :: loop
      real(wp) :: image(size(tau))
      integer(ip) :: outer
      logical :: cycles

      solution%converged = .false.
      solution%contraction = 0.0_wp
      allocate (loop%visited(size(tau), LONGEST_CYCLE), source=-1.0_wp)
      call accelerator%reset()
      ! tau: the bound of this iteration; image: nu S_rho of the pressure found with it
      do outer = 1, task%controls%max_iterations
         call begin_outer(solution%history)
         call solve_with_bound(task%problem, task%line, tau, solution, image, status)
         if (.not. is_ok(status)) return
         if (solution%inner%moves) then
            call step_back(loop, accelerator, tau, status)
            if (.not. is_ok(status)) return
            cycle
         end if
         if (.not. solution%inner%solved) exit
         solution%residual = relative_residual(task%line, tau, image)
         call end_outer(solution%history, solution%residual)
         call report_step(task%reporter, 'outer', outer, solution%history, '', '  residual '//to_text(solution%residual, 3))
         call judge_step(task%line, task%controls%tolerance)
         if (solution%converged) return
         ! a loop that converges is not given up, whatever it takes
         if (is_too_much(task%controls, task%problem%m, solution%history%n) .and. outer - loop%progress%best_outer >= STALLED) exit
         ! this bound held all bodies: where the next one does not, the loop comes back to it
         loop%good = tau
         loop%good_image = image
         call accelerator%update(loop%good, image, tau)
         call look_for_cycle(task%line, task%controls%method, tau, loop, solution, cycles)
         if (cycles) return
      end do
      solution%verdict = 'the outer loop did not converge in '//to_text(task%controls%max_iterations)//' iterations (residual ' &
                         //to_text(solution%residual, 3)//')'
      if (is_too_much(task%controls, task%problem%m, solution%history%n)) then
         solution%verdict = 'the loop was given up after '//to_text(solution%history%n)//' linear solves'
      end if
      if (.not. solution%inner%solved) solution%verdict = 'the active set did not settle'

   contains

      !> Whether the loop has converged with this bound and its image; and how fast it goes.
      !>
      !> The residual is |image - tau|/|tau| pair by pair. It is none at the tolerance; at what round-off of the matrix may do to
      !> it, eps times its condition, where an iteration no longer halves it; and at STALE_RESIDUAL where STALE iterations have not,
      !> for round-off of which the matrix knows nothing: displacements far below the initial gaps. The condition is asked for where
      !> it matters alone: it costs as much as some solves.
      subroutine judge_step(line, tolerance)
         type(contact_line_t), intent(in) :: line
         real(wp), intent(in) :: tolerance

         if (allocated(loop%good) .and. maxval(tau) > 0.0_wp) then
            call measure_rate(line%weight/maxval(line%weight), (tau - loop%good)/maxval(tau), &
                              (image - loop%good_image)/maxval(tau), solution%contraction)
         end if
         if (may_be_round_off(loop%last_residual, solution%residual)) call judge_condition(solution)
         solution%converged = has_settled(tolerance, solution%inner%condition, loop%last_residual, solution%residual)
         loop%last_residual = solution%residual
         call note_residual(loop%progress, outer, solution%residual)
         ! round-off that the matrix does not tell: displacements far below the initial gaps
         if (outer - loop%progress%best_outer < STALE .or. solution%converged) return
         solution%converged = relative_residual(line, tau, image, beside_noise=.true.) <= STALE_RESIDUAL
         if (solution%converged) solution%residual = min(solution%residual, STALE_RESIDUAL)
      end subroutine judge_step

   end subroutine iterate

   !> Whether so many linear solves went through so many entries of C that the other form of the contact system is cheaper.
   !>
   !> A solve by Cholesky goes through m^2 entries for its products and m^3/3 operations for its factor, which serves several
   !> solves.
   pure logical function is_too_much(controls, m, solves)
      type(controls_t), intent(in) :: controls !< method, tolerance, MAXIT
      integer(ip), intent(in) :: m                  !< unknown forces
      integer(ip), intent(in) :: solves

      is_too_much = solves > LEAST_SOLVES .and. real(solves, wp)*real(m, wp)**2 > controls%most_entries
   end function is_too_much

   !> The bound does not hold a body: half of the way back to the last one that did, or twice as much where none did so far.
   !> status: STATUS_SINGULAR with FREE_MOTION when that was done often enough.
   !>
   !> The set of bounds that hold all bodies need not be convex, but grows with tau: more friction holds more. So half way back is
   !> nearer to it, and twice as much may be in it where none was found yet. The memory of an accelerator would lead out again.
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

   !> Whether the next bound was there before; the verdict says so.
   !>
   !> After a step back bounds come again without a cycle, so none is looked for.
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

   !> How much more the images of two bounds differ than the bounds do, in the norm of the line's weights, whatever made the step
   !> between them: the largest so far. Below 1 the map contracts there, and the solution is the only one near.
   !>
   !> |g(x) - g(y)|/|x - y| of two iterates is a lower estimate of the Lipschitz constant of the map g = nu S_rho p. The weights
   !> make the norm that of L2 on the line, whatever the spacing of the points.
   pure subroutine measure_rate(weight, step, answer, rate)
      real(wp), intent(in) :: weight(:)             !< relative to the largest
      real(wp), intent(in) :: step(:), answer(:)    !< relative to the largest bound
      real(wp), intent(inout) :: rate
      real(wp), parameter :: LEAST_STEP = 1.0e-6_wp !< below it round-off is measured

      if (maxval(abs(step)) <= LEAST_STEP) return
      rate = max(rate, norm2(sqrt(weight)*answer)/norm2(sqrt(weight)*step))
   end subroutine measure_rate

   !> Compares the next bound with the last ones: the same again after two steps or more, while the residual stays, is a cycle.
   !>
   !> The loop converges from alternating sides, or in circles, where the map turns; then bounds come near to what they were, but
   !> the residual falls as well. A cycle is the same bound to a millionth of a residual that stays.
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

end module atrito_picard_loop
