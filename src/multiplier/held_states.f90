!> Forces and friction bound that agree, with the states of all rows held: where the steps of the multipliers would come to if no
!> state changed any more.
!>
!> With the states held a step of the multipliers is linear. It takes z = (q_o, a_o, tau) to G(z) = (q, a, nu S_rho(p)), and what
!> is wanted is z = G(z). Newton's method on all three would have an unsymmetric matrix: where a point slips, tau depends on p. But
!> z changes forces of rows and amplitudes alone, and of the displacements G takes those of the rows alone,
!>
!>     H dx = -B' (q(e, z) - q_b) + kappa H_a da_o,     e = B x + g0 and a from dx,     q_b <- q(e, z) + s B dx,
!>
!> H being the matrix that was factored last, q_b the forces which x is in equilibrium with, and s the stiffness that was factored,
!> 0 but in FREE rows. So G(z) takes a solve at the rows (solve_at_rows), by the fronts above the points. (Where D has changed
!> since, as it does with tau where eps > 0, q_b is not quite q, and the next solve takes the difference.)
!>
!> G - 1 is near to -1: q_o contracts by rho/(lambda + rho), tau by some nu. So Anderson's mixing, GMRES with few vectors, takes one
!> solve for one digit or two. The next whole solve takes x along, and finds z = G(z) where the states stay.
module atrito_held_states
   use atrito_accelerator, only: anderson_t
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE, AT_LOWER, AT_UPPER
   use atrito_contact_line, only: contact_line_t, friction_bound, last_of_pair, pressure_of, set_friction_bounds
   use atrito_contact_solution, only: contact_solution_t
   use atrito_contact_system, only: contact_system_t
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_multiplier_step, only: largest_of_pairs, pull_of, rho_of
   use atrito_multipliers, only: multiplier_t
   use atrito_state_changes, only: states_of_law
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
      real(wp), allocatable :: unit(:)           !< (m + points) of forces and bounds [F], [F/L^2]
      real(wp) :: first = -1.0_wp                !< the largest part of G(z) - z before the first solve; < 0: there was none
      type(anderson_t) :: anderson
   end type held_states_t

   real(wp), parameter :: ENOUGH = 1.0e-3_wp      !< of what was left at first; round-off may be above the tolerance
   real(wp), parameter :: NEARLY = 0.3_wp         !< what may be left where states change, of the largest
   real(wp), parameter :: DIVERGES = 10.0_wp      !< times the least that was left
   integer(ip), parameter :: MOST_SOLVES = 30_ip
   integer(ip), parameter :: PATIENCE = 4_ip      !< solves without less than half of what was left

contains

   !> Begins behind a whole solve with these states.
   subroutine hold_states(system, line, multipliers, solution, held)
      class(contact_system_t), intent(in) :: system
      type(contact_line_t), intent(in) :: line
      type(multiplier_t), intent(in) :: multipliers !< x, e, q_o, a_o of the solve
      type(contact_solution_t), intent(in) :: solution !< states, forces, bound of it
      type(held_states_t), intent(out) :: held
      integer(ip) :: first, last

      held%state = solution%state
      held%bounds = solution%bounds
      held%e = multipliers%e
      held%a = multipliers%x(system%n - system%k + 1:)
      held%q_o = multipliers%q_old
      held%a_o = multipliers%a_old
      held%tau = solution%tau
      held%balanced = solution%state%q
      held%anderson%least = -HUGE_REAL
      ! each pair is measured by its largest force, and by its largest bound
      associate (m => system%rows%n, largest => largest_of_pairs(multipliers, abs(solution%state%q)))
         allocate (held%unit(m + line%n))
         held%unit(:m) = largest(multipliers%pair)
         last = 0
         do while (last < line%n)
            first = last + 1
            last = last_of_pair(line, first)
            held%unit(m + first:m + last) = maxval(solution%tau(first:last))
         end do
      end associate
      where (held%unit <= 0.0_wp) held%unit = 1.0_wp
   end subroutine hold_states

   !> Goes on until no more than the tolerance is left of G(z) - z, or NEARLY nothing where the law asks for other states. agrees:
   !> it is so, or a thousandth is left of what was at first.
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
      real(wp) :: left, least
      integer(ip) :: m, solves, since
      logical :: stands

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
         left = maxval([abs(g - z), pull_of(multipliers)*abs(held%a - held%a_o)/maxval([held%unit(:m), 0.0_wp])])
         if (held%first < 0.0_wp) held%first = left
         since = merge(0_ip, since + 1_ip, left < 0.5_wp*least)
         least = min(left, least)
         stands = left > NEARLY
         if (.not. stands) stands = is_law()
         agrees = left <= max(tolerance, ENOUGH*held%first) .or. .not. stands
         if (left <= tolerance .or. .not. stands .or. left > DIVERGES*least .or. since >= PATIENCE) return
         if (solves == MOST_SOLVES) return
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

   contains

      !> Whether the law leaves all states as they are, with the bound of these forces.
      logical function is_law()
         type(box_bounds_t) :: bounds
         type(box_state_t) :: state

         bounds = held%bounds
         state = held%state
         call set_friction_bounds(line, shape, friction_bound(line, pressure_of(line, state%q)), bounds, state)
         is_law = all(states_of_law(system, shape, bounds, multipliers, state, held%state%state) == held%state%state)
      end function is_law

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
