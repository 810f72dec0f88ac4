!> One step of the proximal method of multipliers (R. T. Rockafellar, Math. Oper. Res. 1 (1976) 97-116) on the sparse form of the
!> bodies.
!>
!> With the forces q_o and amplitudes a_o of the step before and the friction bound frozen, the step solves
!>
!>     A x + kappa H (a - a_o) + B' q = f,   q_i = clip((B_i x + g0_i + rho_i q_o,i)/(D_i + rho_i)),   rho_i = r c_i.
!>
!> clip puts a force between the bounds of its law, 0 <= q_n, |q_t| <= w tau; what it does is the state of the row:
!>
!>     FREE       inside: closed or sticking, B x + g0 = D q + rho (q - q_o), where q = q_o the law itself
!>     AT_LOWER   q = lower: open, or slipping against T
!>     AT_UPPER   q = upper: slipping along T
!>     FROZEN     lower = upper: no friction
!>
!> In a solution q = q_o and a = a_o, so rho and kappa have no part in it: hard contact and rows that depend on each other need
!> neither a penalty nor pivots, a body that touches nothing yet is held by kappa. c_i is the flexibility of the displacements at
!> the row and H_j what the rows hold motion j with, so nothing depends on units, and every pair is treated by its own stiffness.
!>
!> The equations are the gradient of the convex, piecewise quadratic function
!>
!>     phi(x) = x'A x/2 - f'x + kappa (a - a_o)'H (a - a_o)/2 + sum_i psi_i(B_i x),   psi_i' = the clip above.
!>
!> Newton's method solves [A + sum over FREE rows of B_i'B_i/(D_i + rho_i) + kappa H] dx = -gradient, a positive definite matrix.
!> The full step is taken where it leads to the states that it was made for (`try_full_step`): that is the minimum. Else dx is
!> followed to the least phi on its line (`take_part_of_step`, atrito_line_search), so phi falls in every step, no set of states
!> comes back, and the method ends. A row whose D + rho has changed by less than SAME_STIFFNESS keeps the stiffness that was
!> factored: then the step is a little less than Newton's.
!>
!> Round-off: B x + g0 is added up from step to step, of motions far larger than what is missing only round-off would be left of
!> it; `noise` is what that does to a force, and neither changes a state nor is a distance from the solution.
module atrito_multiplier_step
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE, AT_LOWER, AT_UPPER, FROZEN
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_system, only: contact_system_t
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_least_forces, only: find_least_forces
   use atrito_line_search, only: search_line
   use atrito_multipliers, only: multiplier_t
   use atrito_range, only: unit_of
   use atrito_solve_history, only: solve_history_t, record_solve
   use atrito_sparse_rows, only: multiply_rows, add_transposed
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: residual_of, provide_factor
   public :: begin_multipliers, close_all, start_closed, take_multiplier_step, refine_step, accept_step, set_forces, &
             set_held_forces, pull_of, take_least_forces, largest_of_pairs, rho_of

   integer(ip), parameter :: MOST_NEWTON = 200_ip
   integer(ip), parameter :: PATIENCE = 20_ip         !< Newton steps without a full one
   real(wp), parameter :: SAME_STATE = 1.0e-12_wp    !< excess over a bound, of the largest force of the pair, that changes nothing
   real(wp), parameter :: ROUND_OFFS = 20.0_wp       !< of the terms of a row
   real(wp), parameter :: NO_COMPLIANCE = 1.0e-12_wp !< of the flexibility: a law that does not tell the force of a row
   real(wp), parameter :: MOST_KAPPA = 1.0e-2_wp
   integer(ip), parameter :: MOST_REFINEMENTS = 3_ip
   real(wp), parameter :: BALANCED = 1.0e-11_wp      !< residual of a body over its largest force
   real(wp), parameter :: REFINES = 0.5_wp           !< of it is left, at the most, or the step is taken back
   real(wp), parameter :: SAME_STIFFNESS = 0.1_wp    !< change of D + rho that the factor bears

contains

   !> At rest: no forces, no displacements.
   !>
   !> hold: H_j = sum_i B_ij^2/c_i over the rows, the stiffness by which the rows would hold motion j if all were closed. A spring
   !> in a row adds its compliance to c_i.
   subroutine begin_multipliers(system, pair, multipliers, compliance)
      class(contact_system_t), intent(in) :: system !< A, B, loads, flexibilities
      integer(ip), intent(in) :: pair(:)         !< (m) of each row
      type(multiplier_t), intent(out) :: multipliers
      real(wp), intent(in), optional :: compliance(:) !< (m) of springs: a soft one holds its body no firmer than it is [L/F]
      real(wp) :: yields(system%rows%n)
      integer(ip) :: i, k

      multipliers%pair = pair
      yields = system%flexibility
      if (present(compliance)) yields = yields + compliance
      multipliers%n_pairs = maxval([pair, 0_ip])
      associate (m => system%rows%n)
         allocate (multipliers%x(system%n), multipliers%q_old(m), multipliers%noise(m), multipliers%a_old(system%k), &
                   multipliers%hold(system%k), &
                   multipliers%stiffness(m), multipliers%pull(system%k), source=0.0_wp)
         allocate (multipliers%part(m), source=1.0_wp)
         multipliers%e = system%g0
         do i = 1, m
            do k = system%rows%first(i), system%rows%first(i + 1) - 1
               associate (a => system%rows%column(k) - (system%n - system%k))
                  if (a > 0) multipliers%hold(a) = multipliers%hold(a) + system%rows%value(k)**2/yields(i)
               end associate
            end do
         end do
      end associate
      ! a motion that no row sees is alone in its equation: any pull holds it
      where (multipliers%hold <= 0.0_wp) multipliers%hold = 1.0_wp
   end subroutine begin_multipliers

   !> All points closed, and stuck where there is friction.
   pure subroutine close_all(bounds, state)
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F]
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r

      state%state = merge(FROZEN, FREE, bounds%lower == bounds%upper)
      state%q = 0.0_wp
   end subroutine close_all

   !> All points closed, and stuck where there is friction, whatever their forces.
   !>
   !> One linear solve with all rows FREE, as if glued. Where the bodies come to is a good place to begin: the true motion is near
   !> to it where contact holds them, and where it does not they leave from there.
   subroutine start_closed(system, bounds, multipliers, state, status)
      class(contact_system_t), intent(inout) :: system !< A, B, loads, flexibilities
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      type(multiplier_t), intent(inout) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      type(status_t), intent(out) :: status
      real(wp) :: residual(system%n)

      call close_all(bounds, state)
      where (state%state == FREE) state%q = multipliers%e/(bounds%d + rho_of(system, multipliers))
      call residual_of(system, multipliers, state%q, residual)
      call provide_factor(system, bounds, state, multipliers, status)
      if (.not. is_ok(status)) return
      call system%solve(residual)
      multipliers%x = residual
      multipliers%changed = .true.               ! e is not that of x
      multipliers%solves = 1
      ! where the bodies come to is where they are held at first
      multipliers%a_old = multipliers%x(system%n - system%k + 1:)
   end subroutine start_closed

   !> Forces and states from the displacements.
   !>
   !> z = (e + rho q_o)/(D + rho) is the force without bounds, q = clip(z), r = e - D q the residual of the law. The state says on
   !> which piece of the clip z lies.
   subroutine set_forces(system, bounds, multipliers, state, de)
      class(contact_system_t), intent(in) :: system !< A, B, loads, flexibilities
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      type(multiplier_t), intent(inout) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      !> B dx of the step that has been taken: of motions far larger than it, round-off alone would be left of e, and the forces
      !> would lose the balance that the step has given them.
      real(wp), intent(in), optional :: de(:)
      integer(ip) :: i
      real(wp) :: rho, z, e(system%rows%n)

      call multiply_rows(system%rows, multipliers%x, e, multipliers%noise)
      if (any(multipliers%pair > multipliers%n_contact_pairs)) call raise_noise(system, multipliers)
      if (present(de)) then
         multipliers%e = multipliers%e + de
      else
         multipliers%e = e + system%g0
      end if
      do i = 1, system%rows%n
         rho = multipliers%r*multipliers%part(i)*system%flexibility(i)
         multipliers%noise(i) = ROUND_OFFS*EPS_MACH*(multipliers%noise(i) + abs(system%g0(i)))/(bounds%d(i) + rho)
         z = (multipliers%e(i) + rho*multipliers%q_old(i))/(bounds%d(i) + rho)
         state%q(i) = min(max(z, bounds%lower(i)), bounds%upper(i))
         state%r(i) = multipliers%e(i) - bounds%d(i)*state%q(i)
         if (bounds%lower(i) == bounds%upper(i)) then
            state%state(i) = FROZEN
         else if (z <= bounds%lower(i)) then
            state%state(i) = AT_LOWER
         else if (z >= bounds%upper(i)) then
            state%state(i) = AT_UPPER
         else
            state%state(i) = FREE
         end if
      end do
      state%a = multipliers%x(system%n - system%k + 1:)
   end subroutine set_forces

   !> Forces from the displacements where the states are held: q = (e + rho q_o)/(D + rho) in FREE rows, else that of the bound.
   !> Not clipped: a force beyond a bound says that the state is another one.
   subroutine set_held_forces(system, bounds, multipliers, state)
      class(contact_system_t), intent(in) :: system
      type(box_bounds_t), intent(in) :: bounds
      type(multiplier_t), intent(in) :: multipliers
      type(box_state_t), intent(inout) :: state

      associate (rho => rho_of(system, multipliers))
         where (state%state == FREE) state%q = (multipliers%e + rho*multipliers%q_old)/(bounds%d + rho)
      end associate
      where (state%state == AT_LOWER) state%q = bounds%lower
      where (state%state == AT_UPPER) state%q = bounds%upper
      where (state%state == FROZEN) state%q = 0.0_wp
      state%r = multipliers%e - bounds%d*state%q
      state%a = multipliers%x(system%n - system%k + 1:)
   end subroutine set_held_forces

   !> A bilateral row may hold displacements that are none: their round-off is that of the other displacements of the body.
   !>
   !> An equation u_i = 0 has e = 0 exactly; what round-off does to it is that of solving for the whole body.
   subroutine raise_noise(system, multipliers)
      class(contact_system_t), intent(in) :: system
      type(multiplier_t), intent(inout) :: multipliers
      real(wp) :: of_body(system%n_bodies)
      integer(ip) :: i, k

      of_body = 0.0_wp
      do i = 1, system%n - system%k
         of_body(system%body(i)) = max(of_body(system%body(i)), abs(multipliers%x(i)))
      end do
      do i = 1, system%rows%n
         if (multipliers%pair(i) <= multipliers%n_contact_pairs) cycle
         do k = system%rows%first(i), system%rows%first(i + 1) - 1
            if (system%rows%column(k) > system%n - system%k) cycle
            multipliers%noise(i) = multipliers%noise(i) &
                                   + abs(system%rows%value(k))*of_body(system%body(system%rows%column(k)))
         end do
      end do
   end subroutine raise_noise

   !> f - A x - kappa (a - a_o) - B' q.
   !>
   !> Minus the gradient of phi at x, where q = clip((B x + g0 + rho q_o)/(D + rho)) is that of these displacements.
   subroutine residual_of(system, multipliers, q, residual)
      class(contact_system_t), intent(in) :: system
      type(multiplier_t), intent(in) :: multipliers
      real(wp), intent(in) :: q(:)               !< (m) [F]
      real(wp), intent(out) :: residual(:)       !< (n) [F]

      call system%multiply(multipliers%x, residual)
      residual = system%load - residual
      call add_transposed(system%rows, -1.0_wp, q, residual)
      associate (first => system%n - system%k)
         residual(first + 1:) = residual(first + 1:) - pull_of(multipliers)*(multipliers%x(first + 1:) - multipliers%a_old)
      end associate
   end subroutine residual_of

   !> rho_i = r c_i [L/F] of each row, of r the share that the row takes.
   pure function rho_of(system, multipliers) result(rho)
      class(contact_system_t), intent(in) :: system
      type(multiplier_t), intent(in) :: multipliers
      real(wp) :: rho(system%rows%n)

      rho = multipliers%r*multipliers%part*system%flexibility
   end function rho_of

   !> The largest value at the rows of each pair; 0 where it has none.
   pure function largest_of_pairs(multipliers, values) result(largest)
      type(multiplier_t), intent(in) :: multipliers
      real(wp), intent(in) :: values(:)          !< (m) >= 0
      real(wp) :: largest(multipliers%n_pairs)
      integer(ip) :: i

      largest = 0.0_wp
      do i = 1, size(values, kind=ip)
         largest(multipliers%pair(i)) = max(largest(multipliers%pair(i)), values(i))
      end do
   end function largest_of_pairs

   !> The stiffness [F/L] by which each rigid motion is pulled to where it was before the step.
   !>
   !> kappa H_j: a share kappa of what the rows would hold motion j with. 0 has no place in it: a motion that no row sees is alone
   !> in its equation, and gets H_j = 1.
   pure function pull_of(multipliers) result(pull)
      type(multiplier_t), intent(in) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      real(wp) :: pull(size(multipliers%hold))

      pull = multipliers%kappa*multipliers%hold
   end function pull_of

   !> Solves for one step. status: as system%factor.
   !>
   !>     residual = -gradient of phi;  factor for the states;  dx = H^-1 residual;  full step, or a part of it
   !>
   !> until a full step stays in the states that it was made for. `changed` tells the loop that it did not at first. After PATIENCE
   !> steps a change of forces by round-off is none: points at the edge of contact may change their states for ever.
   subroutine take_multiplier_step(system, shape, bounds, holds, multipliers, state, history, status)
      class(contact_system_t), intent(inout) :: system !< A, B, loads, flexibilities
      type(bound_qp_t), intent(in) :: shape   !< numbers of unknowns and weights, for the history
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      logical, intent(in) :: holds            !< the states of `state` are tried first, not those of x
      type(multiplier_t), intent(inout) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      type(solve_history_t), intent(inout) :: history !< every linear solve is added
      type(status_t), intent(out) :: status
      real(wp) :: residual(system%n), dx(system%n), de(system%rows%n), before(system%rows%n)
      integer(ip) :: newton
      logical :: stays

      ! e goes on from step to step where states stand: of motions far larger than the strains x has lost digits that e has
      de = 0.0_wp
      if (holds) then
         call set_held_forces(system, bounds, multipliers, state)
      else if (multipliers%changed) then
         call set_forces(system, bounds, multipliers, state)
      else
         call set_forces(system, bounds, multipliers, state, de)
      end if
      multipliers%settled = .false.
      multipliers%changed = .false.
      do newton = 1, MOST_NEWTON
         ! minus the gradient, the matrix of the present states, Newton's direction
         call residual_of(system, multipliers, state%q, residual)
         call provide_factor(system, bounds, state, multipliers, status)
         if (.not. is_ok(status)) return
         dx = residual
         call system%solve(dx)
         multipliers%solves = multipliers%solves + 1
         call multiply_rows(system%rows, dx, de)
         before = state%q
         call try_full_step(system, bounds, dx, de, multipliers, state, stays)
         if (.not. stays .and. holds .and. newton == 1) then
            call set_forces(system, bounds, multipliers, state)
         else if (.not. stays) then
            call take_part_of_step()
         end if
         ! points at the edge of contact may change for ever by what is round-off of their forces
         if (newton >= PATIENCE .and. .not. stays) stays = all(abs(state%q - before) <= multipliers%noise)
         call record_solve(history, shape, bounds, state)
         multipliers%settled = stays
         if (stays) return
         multipliers%changed = .true.
      end do

   contains

      !> As far along the step as the convex function falls.
      !>
      !> phi'(x + t dx) = -dx'residual_without_rows + t dx'(A + kappa H) dx + sum_i de_i clip((e_i + t de_i + rho_i q_o,i)/(D_i +
      !> rho_i)): the function of atrito_line_search. Work is told over a unit of length: forces times displacements may leave the
      !> range of numbers.
      subroutine take_part_of_step()
         real(wp) :: adx(system%n), constant, slope, t, unit

         ! slope: dx'(A + kappa H) dx; constant: phi' at x without the rows
         call system%multiply(dx, adx)
         unit = unit_of(reshape(dx, [system%n, 1_ip]))   ! work over it: forces times displacements may be no numbers
         slope = dot_product(dx/unit, adx)
         associate (a => dx(system%n - system%k + 1:))
            slope = slope + dot_product(a/unit, pull_of(multipliers)*a)
         end associate
         constant = -dot_product(dx/unit, residual) - dot_product(de/unit, state%q)
         associate (rho => rho_of(system, multipliers))
            t = search_line(constant, slope, de, multipliers%e, rho*multipliers%q_old, bounds%d + rho, bounds%lower, bounds%upper, &
                            unit)
         end associate
         multipliers%x = multipliers%x + t*dx
         call set_forces(system, bounds, multipliers, state, t*de)
      end subroutine take_part_of_step

   end subroutine take_multiplier_step

   !> Of a long way that a body went, and of the forces that closed gaps far larger than its strains, round-off is left in its
   !> forces: the factor that is there solves for it, as long as no state changes.
   !>
   !> The residual of the equations beside the largest force on each body; what is more than BALANCED is solved for with the factor
   !> that is there, at most MOST_REFINEMENTS times. A step that leaves more than REFINES of it is taken back.
   subroutine refine_step(system, bounds, of_body, multipliers, state)
      class(contact_system_t), intent(inout) :: system !< A, B, loads, flexibilities
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      real(wp), intent(in) :: of_body(:)         !< (bodies) largest force on each [F]
      type(multiplier_t), intent(inout) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      type(multiplier_t) :: kept
      type(box_state_t) :: kept_state
      real(wp) :: residual(system%n), de(system%rows%n), part, least
      integer(ip) :: refinement
      logical :: stays

      least = huge(least)
      do refinement = 0, MOST_REFINEMENTS
         call residual_of(system, multipliers, state%q, residual)
         associate (last => system%n - system%k)
            part = maxval([abs(residual(:last))/max(of_body(system%body(:last)), tiny(1.0_wp)), 0.0_wp])
         end associate
         if (part <= BALANCED) return
         if (.not. part < REFINES*least) then            ! what held before was better
            multipliers = kept
            state = kept_state
            return
         end if
         if (refinement == MOST_REFINEMENTS) return
         least = part
         kept = multipliers
         kept_state = state
         call system%solve(residual)
         multipliers%solves = multipliers%solves + 1
         call multiply_rows(system%rows, residual, de)
         call try_full_step(system, bounds, residual, de, multipliers, state, stays)
         if (.not. stays) return
      end do
   end subroutine refine_step

   !> Factors for the present states, unless the last factor is as good.
   !>
   !> A new factor is needed when a row has another stiffness, the pull has changed, or somebody else has factored the system since
   !> (generation). A pivot of an amplitude that is not positive means that the pull is round-off beside the stiffness of a stiff
   !> body: then it grows by 100.
   subroutine provide_factor(system, bounds, state, multipliers, status)
      class(contact_system_t), intent(inout) :: system
      type(box_bounds_t), intent(in) :: bounds
      type(box_state_t), intent(in) :: state
      type(multiplier_t), intent(inout) :: multipliers
      type(status_t), intent(out) :: status
      real(wp) :: stiffness(system%rows%n), pull(system%k)
      logical :: is_new

      stiffness = 0.0_wp
      where (state%state == FREE) stiffness = 1/(bounds%d + rho_of(system, multipliers))
      ! a row whose compliance has changed little keeps the stiffness that was factored
      where (abs(stiffness - multipliers%stiffness) <= SAME_STIFFNESS*stiffness) stiffness = multipliers%stiffness
      do
         pull = pull_of(multipliers)
         is_new = multipliers%generation /= system%generation
         if (.not. is_new) is_new = any(stiffness /= multipliers%stiffness) .or. any(pull /= multipliers%pull)
         if (.not. is_new) return
         call system%factor(stiffness, pull, status)
         multipliers%factorisations = multipliers%factorisations + 1
         system%generation = system%generation + 1
         multipliers%generation = system%generation
         multipliers%stiffness = stiffness
         multipliers%pull = pull
         ! between a stiff body and soft ones a weak pull may be less than round-off
         if (system%failed <= system%n - system%k .or. multipliers%kappa > MOST_KAPPA) return
         multipliers%kappa = 100*multipliers%kappa
      end do
   end subroutine provide_factor

   !> The full step, where it leads to the states that it was made for.
   !>
   !> The states are those of x + dx where each row stays on its piece of the clip, but for SAME_STATE of the largest force of its
   !> pair and the round-off of the row. Then phi is quadratic between, and x + dx its minimum.
   subroutine try_full_step(system, bounds, dx, de, multipliers, state, stays)
      class(contact_system_t), intent(in) :: system
      type(box_bounds_t), intent(in) :: bounds
      real(wp), intent(in) :: dx(:), de(:)
      type(multiplier_t), intent(inout) :: multipliers
      type(box_state_t), intent(inout) :: state
      logical, intent(out) :: stays
      integer(ip) :: i
      real(wp) :: rho, z, slack, scale(multipliers%n_pairs)

      scale = largest_of_pairs(multipliers, abs(state%q))
      stays = .true.
      do i = 1, system%rows%n
         ! z at x + dx: does the row stay on its piece of the clip?
         rho = multipliers%r*multipliers%part(i)*system%flexibility(i)
         z = (multipliers%e(i) + de(i) + rho*multipliers%q_old(i))/(bounds%d(i) + rho)
         slack = SAME_STATE*scale(multipliers%pair(i)) + multipliers%noise(i)
         select case (state%state(i))
         case (FREE)
            stays = z >= bounds%lower(i) - slack .and. z <= bounds%upper(i) + slack
         case (AT_LOWER)
            stays = z <= bounds%lower(i) + slack
         case (AT_UPPER)
            stays = z >= bounds%upper(i) - slack
         end select
         if (.not. stays) return
      end do
      multipliers%x = multipliers%x + dx
      call set_forces(system, bounds, multipliers, state, de)
   end subroutine try_full_step

   !> Of the forces that move the bodies alike the least.
   !>
   !> Rows that may change: those without compliance that are FREE, or at a bound with r = 0 but for round-off.
   subroutine take_least_forces(system, rows, weight, bounds, multipliers, state, is_shared)
      class(contact_system_t), intent(in) :: system
      type(constraint_rows_t), intent(in) :: rows !< over displacements alone
      real(wp), intent(in) :: weight(:)          !< (m) of the rows' points [L^2]
      type(box_bounds_t), intent(in) :: bounds
      type(multiplier_t), intent(in) :: multipliers
      type(box_state_t), intent(inout) :: state
      logical, allocatable, intent(out) :: is_shared(:) !< (m)
      logical :: may_change(system%rows%n)

      may_change = bounds%d <= NO_COMPLIANCE*system%flexibility .and. state%state /= FROZEN
      where (state%state == AT_LOWER .or. state%state == AT_UPPER)
         may_change = may_change .and. abs(state%r) <= multipliers%noise*(bounds%d + rho_of(system, multipliers))
      end where
      call find_least_forces(rows, weight, bounds, may_change, state, is_shared)
   end subroutine take_least_forces

   !> What the step has found is where the next one starts.
   !>
   !> The forces and the amplitudes of the proximal terms; displacements are not in any.
   subroutine accept_step(system, state, multipliers)
      class(contact_system_t), intent(in) :: system !< A, B, loads, flexibilities
      type(box_state_t), intent(in) :: state !< states of the m unknowns, q, a, r
      type(multiplier_t), intent(inout) :: multipliers !< x, e, q_o, a_o and the sizes of the step

      multipliers%q_old = state%q
      multipliers%a_old = multipliers%x(system%n - system%k + 1:)
   end subroutine accept_step

end module atrito_multiplier_step
