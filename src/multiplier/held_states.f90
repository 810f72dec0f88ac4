!> Forces and friction bound that agree, with the states of all rows held: where the steps of the multipliers come to if no state
!> changes any more.
!>
!> With the states held a step of the multipliers is linear. It takes z = (q_o, tau, a_o) to G(z) = (q, nu S_rho(p), a), and what is
!> wanted is z = G(z): with tau = nu S_rho(p) in the equations of the points that slip the matrix would be unsymmetric in their rows,
!> and this is how they are solved with the symmetric one. What z changes are forces at the contact line alone,
!>
!>     H dx = -B' (q(e, z) - q_b) + kappa H_a da_o,
!>
!> where q_b are the forces for which x is in equilibrium, and what G wants of dx is B dx and da. So an evaluation of G is a solve at the
!> unknowns of the rows (solve_at_rows), which takes the fronts above the points alone. Equilibrium behind it holds for
!> q_b <- q(e, z) + s B dx, s being the stiffness that was factored in the FREE rows: where D has changed since (eps > 0) q_b is not
!> quite the force of the law, and the next solve takes the difference.
!>
!> G contracts by rho/(lambda + rho) and by some nu; Anderson's mixing of q_o and tau makes it a Krylov method of that linear map.
module atrito_held_states
   use atrito_accelerator, only: anderson_t
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE, AT_LOWER, AT_UPPER
   use atrito_contact_line, only: contact_line_t, friction_bound, pressure_of, set_friction_bounds
   use atrito_contact_solution, only: contact_solution_t
   use atrito_contact_system, only: contact_system_t
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_multiplier_step, only: largest_of_pairs, pull_of, rho_of
   use atrito_multipliers, only: multiplier_t
   use atrito_sparse_rows, only: multiply_rows, add_transposed
   implicit none (type, external)
   private
   public :: held_states_t, hold_states, agree, take_agreed

   !> The iteration: z, G(z), and the displacements at the rows that belong to them.
   type :: held_states_t
      type(box_state_t) :: state                 !< the states held; q, r
      type(box_bounds_t) :: bounds
      real(wp), allocatable :: e(:), a(:)        !< (m) B x + g0 and (k) amplitudes [L]
      real(wp), allocatable :: q_o(:), a_o(:), tau(:) !< z
      real(wp), allocatable :: balanced(:)       !< (m) q_b [F]
      real(wp), allocatable :: unit(:)           !< (m + points) of forces and bounds
      real(wp) :: first = -1.0_wp, left = 0.0_wp !< G(z) - z before the first solve, and now; first < 0: none
      type(anderson_t) :: anderson
   end type held_states_t

   real(wp), parameter :: ENOUGH = 1.0e-3_wp         !< of what was left at first
   integer(ip), parameter :: MOST_SOLVES = 30_ip
   integer(ip), parameter :: PATIENCE = 4_ip        !< solves without less than half of what was left

contains

   !> Begins behind a whole solve with these states.
   subroutine hold_states(system, multipliers, solution, held)
      class(contact_system_t), intent(in) :: system
      type(multiplier_t), intent(in) :: multipliers !< x, e, q_o, a_o of the solve
      type(contact_solution_t), intent(in) :: solution !< states, forces, bound of it
      type(held_states_t), intent(out) :: held

      held%state = solution%state
      held%bounds = solution%bounds
      held%e = multipliers%e
      held%a = multipliers%x(system%n - system%k + 1:)
      held%q_o = multipliers%q_old
      held%a_o = multipliers%a_old
      held%tau = solution%tau
      held%balanced = solution%state%q
      held%anderson%least = -HUGE_REAL
      ! the largest force of the pair of each row, and the largest bound for all points
      associate (largest => largest_of_pairs(multipliers, abs(solution%state%q)))
         held%unit = [largest(multipliers%pair), spread(maxval([solution%tau, 0.0_wp]), 1, size(solution%tau))]
      end associate
      where (held%unit <= 0.0_wp) held%unit = 1.0_wp
   end subroutine hold_states

   !> Goes on until no more than the tolerance is left of G(z) - z. agrees: it is so, or nearly.
   subroutine agree(system, shape, line, multipliers, tolerance, held, agrees)
      class(contact_system_t), intent(in) :: system
      type(bound_qp_t), intent(in) :: shape
      type(contact_line_t), intent(in) :: line
      type(multiplier_t), intent(in) :: multipliers !< rho, the pull and the stiffness factored
      real(wp), intent(in) :: tolerance          !< of the largest force of the pair, and of the largest bound
      type(held_states_t), intent(inout) :: held
      logical, intent(out) :: agrees
      type(box_state_t) :: scratch               ! states with points that have no friction for a while
      real(wp) :: f(system%n), de(system%rows%n), rho(system%rows%n)
      real(wp), dimension(size(held%unit)) :: z, g, next
      real(wp) :: least
      integer(ip) :: m, solves, since

      agrees = .false.
      if (any(held%tau >= HUGE_REAL)) return
      m = system%rows%n
      rho = rho_of(system, multipliers)
      scratch = held%state
      least = huge(least)
      since = 0
      do solves = 0, MOST_SOLVES
         z = [held%q_o, held%tau]/held%unit
         g = [held%state%q, friction_bound(line, pressure_of(line, held%state%q))]/held%unit
         held%left = maxval([abs(g - z), pull_of(multipliers)*abs(held%a - held%a_o)/maxval([held%unit(:m), 0.0_wp])])
         if (held%first < 0.0_wp) held%first = held%left
         since = merge(0_ip, since + 1_ip, held%left < 0.5_wp*least)
         least = min(held%left, least)
         agrees = held%left <= tolerance
         if (agrees .or. since >= PATIENCE .or. solves == MOST_SOLVES) exit
         call held%anderson%update(z, g, next)
         next = held%unit*next
         held%q_o = merge(next(:m), held%state%q, held%state%state == FREE)
         held%tau = max(next(m + 1:), 0.0_wp)
         call set_friction_bounds(line, shape, held%tau, held%bounds, scratch)
         call set_forces()
         f = 0.0_wp
         call add_transposed(system%rows, -1.0_wp, held%state%q - held%balanced, f)
         f(system%n - system%k + 1:) = f(system%n - system%k + 1:) + pull_of(multipliers)*(held%a - held%a_o)
         held%a_o = held%a
         call system%solve_at_rows(f)
         call multiply_rows(system%rows, f, de)
         held%e = held%e + de
         held%a = held%a + f(system%n - system%k + 1:)
         held%balanced = held%state%q
         where (held%state%state == FREE) held%balanced = held%balanced + multipliers%stiffness*de
         call set_forces()
      end do
      agrees = agrees .or. held%left <= ENOUGH*held%first

   contains

      !> FREE rows obey their law, the others have the force of their bound.
      subroutine set_forces()
         associate (state => held%state, bounds => held%bounds)
            where (state%state == FREE) state%q = (held%e + rho*held%q_o)/(bounds%d + rho)
            where (state%state == AT_LOWER) state%q = bounds%lower
            where (state%state == AT_UPPER) state%q = bounds%upper
            state%r = held%e - bounds%d*state%q
         end associate
      end subroutine set_forces

   end subroutine agree

   !> What the next whole solve starts from. x and e stay: it brings them along.
   subroutine take_agreed(shape, line, held, multipliers, solution)
      type(bound_qp_t), intent(in) :: shape
      type(contact_line_t), intent(in) :: line
      type(held_states_t), intent(in) :: held
      type(multiplier_t), intent(inout) :: multipliers !< q_o and a_o
      type(contact_solution_t), intent(inout) :: solution !< q, r and the bound

      multipliers%q_old = held%state%q
      multipliers%a_old = held%a
      solution%state = held%state
      solution%bounds = held%bounds
      solution%tau = friction_bound(line, pressure_of(line, held%state%q))
      call set_friction_bounds(line, shape, solution%tau, solution%bounds, solution%state)
   end subroutine take_agreed

end module atrito_held_states
