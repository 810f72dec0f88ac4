!> What the outer loop works on and what it finds: the contact line's state, its stresses, and the verdict.
module atrito_contact_solution
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_active_set, only: box_outcome_t, solve_box
   use atrito_box_problem, only: box_problem_t, box_bounds_t, box_state_t
   use atrito_contact_line, only: contact_line_t, pressure_of, shear_force_of, friction_bound, set_friction_bounds
   use atrito_kinds, only: ip, wp, EPS_MACH, HUGE_REAL
   use atrito_line_factor, only: line_factor_t, condition_of
   use atrito_solve_history, only: solve_history_t
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: contact_solution_t, outer_controls_t, solve_with_bound, judge_condition, has_settled, may_be_round_off, &
             relative_residual

   real(wp), parameter :: MOST_ROUND_OFF = 1.0e-7_wp

   type :: outer_controls_t
      integer(ip) :: method = 1                       !< METHOD_* of the model
      real(wp) :: tolerance = 1.0e-10_wp
      integer(ip) :: max_iterations = 100
      real(wp) :: relaxation = 1.0_wp
   end type outer_controls_t

   type :: contact_solution_t
      type(box_bounds_t) :: bounds
      type(box_state_t) :: state
      type(solve_history_t) :: history
      type(box_outcome_t) :: inner                    !< of the last inner problem; its condition after judge_condition
      type(line_factor_t) :: factor                   !< of the last solve, or of one near it
      real(wp), allocatable :: p(:), tau(:), t(:)     !< at the points [F/L^2]; tau is the bound that was used
      logical :: converged = .false.
      character(len=:), allocatable :: verdict        !< why not
      real(wp) :: residual = 0.0_wp                   !< |nu S_rho(p) - tau| / |tau|
      real(wp) :: contraction = 0.0_wp                !< largest measured rate of the Picard map; 0: not measured
   end type contact_solution_t

contains

   !> Solves the inner problem for a frozen friction bound, from the present state. Image: nu S_rho of the pressure found.
   subroutine solve_with_bound(problem, line, tau, solution, image, status)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: tau(:)                  !< (n) [F/L^2]; HUGE_REAL: no bound
      type(contact_solution_t), intent(inout) :: solution
      real(wp), intent(out) :: image(:)               !< (n) [F/L^2]
      type(status_t), intent(out) :: status

      solution%tau = tau
      call set_friction_bounds(line, problem, tau, solution%bounds, solution%state)
      call solve_box(problem, solution%bounds, solution%state, solution%history, solution%inner, status, &
                     solution%factor)
      if (.not. is_ok(status)) return
      solution%p = pressure_of(line, solution%state%q)
      solution%t = shear_force_of(line, solution%state%q, tau)
      image = friction_bound(line, solution%p)
   end subroutine solve_with_bound

   !> Estimates the condition of the last solve, which takes as long as some solutions with its factor.
   subroutine judge_condition(solution)
      type(contact_solution_t), intent(inout) :: solution

      solution%inner%condition = condition_of(solution%factor)
   end subroutine judge_condition

   !> |image - tau| / |tau|, in the largest norm; 0 when both vanish.
   pure real(wp) function relative_residual(tau, image) result(residual)
      real(wp), intent(in) :: tau(:), image(:)
      real(wp) :: scale

      residual = 0.0_wp
      if (size(tau) == 0) return
      scale = max(maxval(abs(tau)), maxval(abs(image)))
      if (scale > 0.0_wp) residual = maxval(abs(image/scale - tau/scale))
      if (.not. all(ieee_is_finite(image))) residual = HUGE_REAL   ! maxval passes over what is not a number
   end function relative_residual

   !> Whether the outer loop stops at this residual: below the tolerance; or below what round-off of the matrix can do to it, and no
   !> longer halved by an iteration. (Round-off mostly does far less than its bound, so the bound alone stops too early.) Above
   !> MOST_ROUND_OFF it never does: friction that is less certain is no solution.
   pure logical function has_settled(tolerance, condition, last_residual, residual) result(settled)
      real(wp), intent(in) :: tolerance
      real(wp), intent(in) :: condition               !< of the scaled matrix of the free set
      real(wp), intent(in) :: last_residual           !< of the iteration before; < 0: none
      real(wp), intent(in) :: residual

      settled = residual <= tolerance
      if (settled .or. residual > EPS_MACH*condition) return
      settled = may_be_round_off(last_residual, residual)
   end function has_settled

   !> Whether has_settled depends on the condition where the tolerance is not met.
   pure logical function may_be_round_off(last_residual, residual)
      real(wp), intent(in) :: last_residual, residual !< as above

      may_be_round_off = last_residual >= 0.0_wp .and. residual <= MOST_ROUND_OFF .and. residual > 0.5_wp*last_residual
   end function may_be_round_off

end module atrito_contact_solution
