!> What the outer loop works on and what it finds: the contact line's state, its stresses, and the verdict.
!>
!> All loops look for a friction bound tau that is its own image: with tau frozen the problem with bounds gives
!> pressures p(tau), and
!>
!>     tau = Phi(tau) = nu S_rho(p(tau)),     residual = max over pairs of |Phi(tau) - tau|/|tau|, largest norms.
!>
!> A loop stops where the residual is below the tolerance of the deck. Round-off of the matrix can make a relative error
!> of EPS_MACH times its condition in p, and so in the residual; below that bound the loop stops as soon as an iteration
!> no longer halves the residual (has_settled), but never above 1e-7.
module atrito_contact_solution
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_outcome_t, box_state_t, AT_LOWER
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_line, only: contact_line_t, last_of_pair, pressure_of, friction_bound, set_friction_bounds, normal_bounds
   use atrito_kinds, only: ip, wp, EPS_MACH, HUGE_REAL
   use atrito_free_set_factor, only: free_set_factor_t, condition_of
   use atrito_multipliers, only: multiplier_t
   use atrito_solve_history, only: solve_history_t
   implicit none (type, external)
   private
   public :: contact_solution_t, serves_as_start, asks_no_force, let_rest, FREE_MOTION, bound_of_state, &
             judge_condition, has_settled, may_be_round_off, relative_residual, NOISE

   !> Text of the status when no friction bound holds a body; solution%inner%motion is the motion.
   character(len=*), parameter :: FREE_MOTION = 'free motion'

   real(wp), parameter :: MOST_ROUND_OFF = 1.0e-7_wp
   real(wp), parameter :: NOISE = 1.0e-12_wp          !< of the largest friction bound or force: may be round-off elsewhere

   type :: contact_solution_t
      type(box_bounds_t) :: bounds !< of the m forces [F], and their compliance [L/F]
      type(box_state_t) :: state   !< states, q, a and r of the m unknowns
      type(solve_history_t) :: history                !< a record a linear solve
      type(box_outcome_t) :: inner                    !< of the last inner problem; its condition after judge_condition
      type(free_set_factor_t) :: factor                   !< of the last solve, or of one near it
      type(constraint_rows_t), allocatable :: rows    !< of the unknowns, where they may depend on each other
      logical, allocatable :: is_shared(:)            !< (unknowns) with rows: the force is not unique, the least is given
      real(wp), allocatable :: p(:), tau(:), t(:)     !< at the points [F/L^2]; tau is the bound that was used
      type(multiplier_t), allocatable :: multipliers  !< of the sparse form, where a next increment goes on from them
      real(wp), allocatable :: body_motion(:), body_force(:) !< (bodies) largest displacement [L] and force at a node [F]
      real(wp), allocatable :: flexibility(:)         !< (unknowns) of its row by itself, without its law [L/F]
      real(wp), allocatable :: round_off(:)           !< (unknowns) of r, where it is known by its terms [L]
      logical :: has_settled = .false.                !< an idle motion was made least: r is known to rounding of the way
      integer :: form = 0                             !< CONTACT_*, that it was found by
      logical :: converged = .false.                  !< law and equilibrium hold to the tolerance
      character(len=:), allocatable :: verdict        !< why not
      integer(ip) :: factorisations = 0               !< of the sparse form
      real(wp) :: residual = 0.0_wp                   !< |nu S_rho(p) - tau| / |tau|
      real(wp) :: contraction = 0.0_wp                !< largest measured rate of the Picard map; 0: not measured
   end type contact_solution_t

contains

   !> Whether a form of the contact system can start from a solution.
   pure logical function serves_as_start(solution, form)
      type(contact_solution_t), allocatable, intent(in) :: solution
      integer, intent(in) :: form                     !< CONTACT_*

      serves_as_start = .false.
      if (allocated(solution)) serves_as_start = solution%form == form
   end function serves_as_start

   !> Whether no contact force is asked for: without any nothing overlaps, g0 <= 0 at the points, what bilateral rows
   !> prescribe is so, g0 = 0, and no known overlap makes a pressure. The solution is q = 0 then, and no problem is
   !> solved for it (let_rest). Not so where friction may hold what the increment before has pressed together, as a taper that
   !> locks itself when its load is taken off.
   pure logical function asks_no_force(line, problem, g0, before)
      type(contact_line_t), intent(in) :: line
      type(bound_qp_t), intent(in) :: problem         !< of which the shape counts
      real(wp), intent(in) :: g0(:)                   !< (m) overlaps and slips without contact forces [L]
      type(contact_solution_t), intent(in) :: before  !< of the increment before; nothing allocated: there is none
      type(box_bounds_t) :: bounds
      type(box_state_t) :: state

      asks_no_force = all(g0(:problem%n_normal) <= 0.0_wp)
      if (line%has_friction .and. allocated(before%p)) then
         asks_no_force = asks_no_force .and. .not. any(before%p(:line%n - line%n_bilateral) > 0.0_wp)
      end if
      if (.not. asks_no_force) return
      call normal_bounds(line, problem, bounds, state)
      associate (n => problem%n_normal)
         asks_no_force = all(g0(:n) >= 0.0_wp .or. bounds%lower(:n) > -HUGE_REAL) .and. &
                         all(pressure_of(line, state%q) == 0.0_wp)
      end associate
   end function asks_no_force

   !> The solution without contact forces: all points open, r = g0, friction frozen at 0.
   pure subroutine let_rest(line, problem, g0, solution)
      type(contact_line_t), intent(in) :: line        !< numbered
      type(bound_qp_t), intent(in) :: problem         !< of which the shape counts
      real(wp), intent(in) :: g0(:)                   !< (m) [L]
      type(contact_solution_t), intent(inout) :: solution !< inner%condition is set
      integer(ip) :: i

      solution%tau = [(0.0_wp, i=1, line%n)]
      call normal_bounds(line, problem, solution%bounds, solution%state)
      call set_friction_bounds(line, problem, solution%tau, solution%bounds, solution%state)
      associate (state => solution%state, n => problem%n_normal)
         where (solution%bounds%lower(:n) > -HUGE_REAL) state%state(:n) = AT_LOWER
         state%r = g0
      end associate
      solution%p = solution%tau
      solution%t = solution%tau
      solution%inner%solved = .true.
      solution%converged = .true.
   end subroutine let_rest

   !> The friction bound that the law has in a state, Phi(tau) = nu S_rho(p): what all loops take next, and stop at.
   pure function bound_of_state(line, solution) result(tau)
      type(contact_line_t), intent(in) :: line !< with the law and S_rho of each point
      type(contact_solution_t), intent(in) :: solution !< whose forces q are read
      real(wp) :: tau(line%n)                         !< [F/L^2]

      tau = friction_bound(line, pressure_of(line, solution%state%q))
   end function bound_of_state

   !> Estimates the condition of the last solve, which takes as long as some solutions with its factor.
   subroutine judge_condition(solution)
      type(contact_solution_t), intent(inout) :: solution !< inner%condition is set

      solution%inner%condition = condition_of(solution%factor)
   end subroutine judge_condition

   !> |image - tau| / |tau|, in the largest norm, of each pair by its own bound; the largest. 0 when both vanish.
   pure real(wp) function relative_residual(line, tau, image, beside_noise) result(residual)
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: tau(:), image(:)        !< (n) [F/L^2]
      logical, intent(in), optional :: beside_noise   !< pairs whose bound is round-off of the strongest do not count
      real(wp) :: none, scale
      integer(ip) :: first, last

      residual = 0.0_wp
      none = 0.0_wp
      if (present(beside_noise)) none = merge(NOISE*largest_of(tau, image), 0.0_wp, beside_noise)
      first = 1
      do while (first <= line%n)
         last = last_of_pair(line, first)
         scale = largest_of(tau(first:last), image(first:last))     ! divides both first, so that no small bound overflows
         if (scale > none) residual = max(residual, maxval(abs(image(first:last)/scale - tau(first:last)/scale)))
         first = last + 1
      end do
      if (.not. all(ieee_is_finite(image))) residual = HUGE_REAL   ! maxval passes over what is not a number
   end function relative_residual

   !> The largest size of a bound and its image; 0 of none.
   pure real(wp) function largest_of(tau, image)
      real(wp), intent(in) :: tau(:), image(:)      !< [F/L^2]

      largest_of = 0.0_wp
      if (size(tau) > 0) largest_of = max(maxval(abs(tau)), maxval(abs(image)))
   end function largest_of

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
