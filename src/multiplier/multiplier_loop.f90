!> The outer loop on the sparse form of the bodies: the Picard loop on the weighted normal stress and the steps of the multipliers
!> (atrito_multiplier_step) in one.
!>
!> What is sought are displacements u = u_e + Z a, forces q and a bound tau with
!>
!>     A x + B' q = f,   q = clip(q + (B x + g0 - D q)/rho, bounds of tau)  for any rho > 0,   tau = nu S_rho(p),   p = q_n/w,
!>
!> x = (u_e, a): equilibrium, the laws of contact and friction, and the fixed point of the existence proof. A step of the
!> multipliers solves the first two with a proximal term at the forces q_o and the amplitudes a_o of the step before, and with tau
!> frozen. Then
!>
!>     q_o <- q,   a_o <- a,   tau <- nu S_rho(p),
!>
!> all three after every step: there is no inner loop. With tau fixed the proximal method converges for any rho > 0 and any pull
!> kappa > 0, since the problem is convex; a force whose row has the flexibility lambda comes nearer by rho/(lambda + rho) a step.
!> With kappa = 0 and rho = 0 a step would be the solution itself; both are as large as it takes to factor the matrix. tau goes as
!> in the Picard loop, which contracts for small nu.
!>
!> What makes it fast or ends it, each in the procedure of its name:
!>
!>     find_fronts          with many points, states near a solution before the first step
!>     agree                with many points, forces and bound of the states once a step has changed none (atrito_held_states)
!>     next_start           else Picard's bound while states change, and Anderson's mixing behind
!>     choose_steps         less rho where forces come slowly; where states still change after MANY_STEPS, rho as large as the
!>                          flexibility and a share of the way to Picard's bound, point by point (go_part_of_the_way)
!>     judge                kappa falls where a body goes on moving, so that it gets where something holds it; when the pull on it
!>                          stays what it was, nothing will: FREE_MOTION
!>     follow_drift         forces of dependent rows that change by the same amount in each step go to the end of that at once
!>     look_for_shared      where forces are not unique the loop goes on with the least of them
!>     finish               forces that are round-off are none; motions that nothing holds are least
!>
!> It stops where the states stand, and the change of the forces, that of the bound and the pull on bodies are below the tolerance
!> (atrito_multiplier_distance); or where they are at most STALE_DISTANCE and have not been halved in STALE steps.
!>
!> Cost: a factorisation of the fronts above the points that changed for each Newton step, a solve for each step.
module atrito_multiplier_loop
   use atrito_accelerator, only: anderson_t
   use atrito_bound_qp, only: bound_qp_t, box_state_t, FREE, AT_LOWER, AT_UPPER, FROZEN
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_sparse_rows, only: multiply_rows, add_transposed
   use atrito_contact_fronts, only: find_fronts, has_many_points, move_fronts
   use atrito_contact_line, only: contact_line_t, pressure_of, find_shear, normal_bounds, set_friction_bounds, &
                                  last_contact_pair, pairs_of_unknowns, tangential_of
   use atrito_contact_solution, only: contact_solution_t, asks_no_force, let_rest, FREE_MOTION, bound_of_state
   use atrito_contact_system, only: contact_system_t
   use atrito_controls, only: controls_t
   use atrito_held_states, only: held_states_t, hold_states, agree, take_agreed
   use atrito_multipliers, only: multiplier_t
   use atrito_undetermined_motions, only: settle_undetermined_motions
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_multiplier_distance, only: distance_t, measure_distance, measure_bodies, clear_round_off, NO_FORCE_AFTER
   use atrito_multiplier_pace, only: loop_t, follow_drift, choose_steps, pull_firmly_again, next_start, LEAST_KAPPA, USUAL_KAPPA, &
                                     NO_LOAD, LITTLE_LEFT, STALE_DISTANCE
   use atrito_multiplier_step, only: begin_multipliers, close_all, start_closed, take_multiplier_step, refine_step, accept_step, &
                                     take_least_forces, largest_of_pairs, residual_of, set_forces
   use atrito_loop_progress, only: note_residual, report_step
   use atrito_reporter, only: reporter_t
   use atrito_solve_history, only: begin_outer, end_outer
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: solve_by_multipliers

   integer(ip), parameter :: OUTERS_A_MAXIT = 4_ip    !< steps for each iteration that a user allows
   integer(ip), parameter :: FACTORISATIONS_A_MAXIT = 20_ip !< the same of factorisations
   integer(ip), parameter :: STALE = 12_ip
   real(wp), parameter :: LEAST_PULL = 1.0e-8_wp      !< kappa of what has no contact points, and r of it:
   real(wp), parameter :: FAST_R = 1.0e-3_wp
   real(wp), parameter :: PULL_OF_ROW = 3.0e-4_wp     !< while the states of many points are found
   real(wp), parameter :: MOVES = 1.0e-6_wp           !< pull over the forces of a body that moves, when it does not fall:
   real(wp), parameter :: MOVES_SLOWLY = 1.0e-7_wp    !< the same where the forces have come to rest
   real(wp), parameter :: STEADY_PULL = 0.8_wp        !< of that of the step before
   real(wp), parameter :: SMALL_PULL = 1.0e-3_wp      !< a pull that may become weaker
   integer(ip), parameter :: MOST_MOVING = 5_ip

contains

   !> Solves. x: the unknowns of the system. status: STATUS_SINGULAR with FREE_MOTION when a body moves under every step; that of
   !> system%factor. A solution whose multipliers are allocated keeps them; where they hold an increment before, of the same system
   !> with other loads and gaps, it is where the loop starts. Motions that nothing determines are least from its amplitudes on.
   !>
   !> Begins with all points closed and stuck without a bound, or with the forces, displacements, states and bound of the increment
   !> before. Each pass of the loop is one step of the multipliers and what follows from it; the order matters: it is judged before
   !> anything is taken over, and the bound of the next step is that of the pressures of this one.
   subroutine solve_by_multipliers(system, rows, line, controls, reporter, solution, x, status)
      class(contact_system_t), intent(inout) :: system !< A, B, loads, flexibilities
      type(constraint_rows_t), intent(in) :: rows !< over displacements alone
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      type(controls_t), intent(in) :: controls !< method, tolerance, MAXIT
      type(reporter_t), intent(in) :: reporter !< a line an iteration
      type(contact_solution_t), intent(inout) :: solution !< with a state to start from
      real(wp), allocatable, intent(out) :: x(:)
      type(status_t), intent(out) :: status
      type(contact_solution_t) :: before
      type(bound_qp_t) :: shape
      type(multiplier_t) :: multipliers
      type(loop_t) :: loop
      type(anderson_t) :: anderson
      real(wp) :: tau(line%n), image(line%n), of_body(system%n_bodies)
      integer(ip) :: outer
      logical :: found, holds
      type(held_states_t) :: held

      before = solution
      call begin_solution(system, line, shape, multipliers, solution)
      if (all(system%load == 0.0_wp) .and. asks_no_force(line, shape, system%g0, before)) then
         call let_rest(line, shape, system%g0, solution)
         x = spread(0.0_wp, 1, system%n)
         if (allocated(before%multipliers)) allocate (solution%multipliers)
         return
      end if
      if (has_multipliers(before)) then
         call start_from(before, system, shape, line, multipliers, solution)
      else
         call close_all(solution%bounds, solution%state)
      end if
      found = .false.
      if (has_many_points(line)) call start_at_fronts(system, shape, line, controls%tolerance, reporter, multipliers, solution, &
                                                      found, status)
      if (.not. (found .or. has_multipliers(before))) then
         call start_closed(system, solution%bounds, multipliers, solution%state, status)
      end if
      if (.not. is_ok(status)) return
      tau = solution%tau
      holds = found .and. .not. multipliers%changed
      outer = 0
      do
         outer = outer + 1
         call begin_outer(solution%history)
         solution%tau = tau
         call set_friction_bounds(line, shape, solution%tau, solution%bounds, solution%state)
         call take_multiplier_step(system, shape, solution%bounds, holds, multipliers, solution%state, &
                                   solution%history, status)
         solution%factorisations = multipliers%factorisations
         if (.not. is_ok(status)) return
         x = multipliers%x
         if (loop%shares) call take_least_forces(system, rows, shape%weight, solution%bounds, multipliers, solution%state, &
                                                 solution%is_shared)
         call judge_step(system, line, controls%tolerance, outer, multipliers, loop, solution, image)
         call report_step(reporter, 'step', outer, solution%history, '  factorisations '//to_text(multipliers%factorisations), &
                          '  forces '//to_text(loop%distance%forces, 2)//'  bound '//to_text(loop%distance%bound, 2)//'  pull ' &
                          //to_text(loop%distance%pull, 2))
         if (solution%converged) call pull_firmly_again(multipliers, loop, solution)
         if (solution%converged) call look_for_shared(system, rows, shape, multipliers, loop, solution)
         if (.not. solution%converged) solution%inner%motion = multipliers%x(system%n - system%k + 1:) - multipliers%a_old
         if (solution%converged .or. is_used_up(outer, controls, multipliers%factorisations, loop)) exit
         if (loop%moving > MOST_MOVING) then
            solution%inner%moves = .true.
            call set_status(status, STATUS_SINGULAR, FREE_MOTION)
            return
         end if
         holds = has_many_points(line) .and. .not. (multipliers%changed .or. loop%shares)
         if (holds) call hold_states(system, line, multipliers, solution, held)
         if (holds) call agree(system, shape, line, multipliers, controls%tolerance, held, holds)
         if (holds) then
            call take_agreed(shape, line, held, multipliers, solution)
            tau = solution%tau
         else
            call follow_drift(system, solution%bounds, multipliers, loop, solution%state)
            ! the step is taken over: q_o, a_o, how far the next one may go, and its friction bound
            call accept_step(system, solution%state, multipliers)
            call choose_steps(outer, solution%state, multipliers, loop)
            call next_start(image, loop, anderson, tau)
         end if
      end do
      if (solution%converged) then
         call measure_bodies(system, solution%state%q, of_body)
         call refine_step(system, solution%bounds, of_body, multipliers, solution%state)
      end if
      call finish(system, line, shape, loop%distance, before%state, multipliers, solution)
      if (solution%converged) x = multipliers%x
      if (allocated(before%multipliers)) call keep_multipliers(before, multipliers, solution)
   end subroutine solve_by_multipliers

   !> Whether the steps are used up that MAXIT allows. A loop whose distance was halved in the last quarter of them is on its way,
   !> and goes on: so often can it be halved and no more.
   !>
   !> A step is cheaper than an iteration of the Picard loop, which solves its QP to the end: OUTERS_A_MAXIT of them count for one.
   !> Below a limit load states change for ever, and each change is a factorisation: these have a limit of their own, and the caller
   !> may set another one.
   pure logical function is_used_up(outer, controls, factorisations, loop)
      integer(ip), intent(in) :: outer, factorisations
      type(controls_t), intent(in) :: controls
      type(loop_t), intent(in) :: loop

      is_used_up = outer >= OUTERS_A_MAXIT*controls%max_iterations .or. &
                   factorisations > min(FACTORISATIONS_A_MAXIT*controls%max_iterations, controls%most_factorisations)
      if (is_used_up) is_used_up = outer - loop%progress%best_outer > outer/4
   end function is_used_up

   !> States of many points at once, as one outer iteration of the history.
   !>
   !> The pull on a body is PULL_OF_ROW of what one of its rows holds, in the mean of all bodies: a block that slips at all of its
   !> points moves about as far as others are strained, not to the next block, and the next solve tells which of them stick. What
   !> many rows hold does not feel it; a pull by all of them would keep fronts from their places. Then it is a tenth of the usual
   !> one: what is left of it adds up along a stack.
   subroutine start_at_fronts(system, shape, line, tolerance, reporter, multipliers, solution, found, status)
      class(contact_system_t), intent(inout) :: system
      type(bound_qp_t), intent(in) :: shape
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: tolerance
      type(reporter_t), intent(in) :: reporter
      type(multiplier_t), intent(inout) :: multipliers
      type(contact_solution_t), intent(inout) :: solution
      logical, intent(out) :: found
      type(status_t), intent(out) :: status
      real(wp) :: kappa

      kappa = multipliers%kappa
      multipliers%kappa = max(USUAL_KAPPA, PULL_OF_ROW*system%n_bodies/system%rows%n)
      call begin_outer(solution%history)
      call find_fronts(system, shape, line, tolerance, multipliers, solution, found, status)
      call end_outer(solution%history, 1.0_wp)
      multipliers%kappa = merge(0.1_wp*USUAL_KAPPA, kappa, found)
      if (is_ok(status)) call report_step(reporter, 'fronts', 0_ip, solution%history, &
                                          '  factorisations '//to_text(multipliers%factorisations), '')
   end subroutine start_at_fronts

   pure logical function has_multipliers(solution)
      type(contact_solution_t), intent(in) :: solution

      has_multipliers = allocated(solution%multipliers)
      if (has_multipliers) has_multipliers = allocated(solution%multipliers%x)
   end function has_multipliers

   !> What the next increment starts from, with what this one has changed.
   subroutine keep_multipliers(before, multipliers, solution)
      type(contact_solution_t), intent(in) :: before
      type(multiplier_t), intent(inout) :: multipliers
      type(contact_solution_t), intent(inout) :: solution

      multipliers%were = solution%state%state
      multipliers%went = multipliers%x
      multipliers%grew = solution%state%q
      multipliers%bound_grew = solution%tau
      if (has_multipliers(before)) then
         multipliers%were = before%state%state
         multipliers%went = multipliers%x - before%multipliers%x
         multipliers%grew = solution%state%q - before%state%q
         multipliers%bound_grew = solution%tau - before%tau
      end if
      solution%multipliers = multipliers
   end subroutine keep_multipliers

   !> Forces, displacements, states and friction bound of the increment before, and what they changed by in it where the load goes
   !> on in that way; the factor is its, too.
   !>
   !> What belongs to the way there begins anew: the sizes of the steps, and the counts. The largest force of each pair stays known,
   !> since of a pair that is unloaded now nothing else may be left to compare round-off with.
   subroutine start_from(before, system, shape, line, multipliers, solution)
      type(contact_solution_t), intent(in) :: before
      class(contact_system_t), intent(in) :: system
      type(bound_qp_t), intent(in) :: shape
      type(contact_line_t), intent(in) :: line
      type(multiplier_t), intent(inout) :: multipliers
      type(contact_solution_t), intent(inout) :: solution
      type(multiplier_t) :: fresh
      real(wp) :: rate

      multipliers = before%multipliers
      if (allocated(multipliers%before)) deallocate (multipliers%before)
      multipliers%r = fresh%r
      multipliers%changed = .true.               ! gaps may be others: e is not that of x
      multipliers%part = spread(1.0_wp, 1, shape%m)
      multipliers%before = largest_of_pairs(multipliers, abs(before%state%q))
      multipliers%factorisations = 0
      multipliers%q_old = before%state%q
      multipliers%a_old = multipliers%x(size(multipliers%x) - shape%k + 1:)
      multipliers%solves = 0
      solution%state = before%state
      solution%tau = before%tau
      rate = rate_of_load(system, multipliers)
      if (rate > 0.0_wp) then
         multipliers%x = multipliers%x + rate*multipliers%went
         multipliers%a_old = multipliers%x(size(multipliers%x) - shape%k + 1:)
         solution%tau = max(solution%tau + rate*multipliers%bound_grew, 0.0_wp)
      end if
      call set_friction_bounds(line, shape, solution%tau, solution%bounds, solution%state)
      if (rate > 0.0_wp) then
         multipliers%q_old = multipliers%q_old + rate*multipliers%grew
         call set_forces(system, solution%bounds, multipliers, solution%state)
         if (rate > 0.5_wp .and. has_many_points(line)) call go_on_with_fronts()
      end if

   contains

      !> Fronts go on by as many points as in the increment before, where they leave contact or stick.
      subroutine go_on_with_fronts()
         integer(ip), allocatable :: normal(:), tangential(:)
         integer(ip) :: moved(shape%m)

         moved = before%state%state
         call move_fronts(line, line%normal, multipliers%were, before%state%state, moved, normal)
         call move_fronts(line, line%tangential, multipliers%were, before%state%state, moved, tangential)
         where (before%state%state == FREE .and. moved /= FREE) solution%state%state = moved
      end subroutine go_on_with_fronts

   end subroutine start_from

   !> How much of the last increment the load grows by once more; 0 where it goes another way, or before the second one.
   !>
   !> What the increment changed, A dx + B'dq, is the load that it added; what its end lacks of the load now is r. The rate is that
   !> of the least |r - rate (A dx + B'dq)|, if next to nothing is left.
   real(wp) function rate_of_load(system, multipliers) result(rate)
      class(contact_system_t), intent(in) :: system
      type(multiplier_t), intent(in) :: multipliers
      real(wp), parameter :: is_left = 0.1_wp
      real(wp) :: residual(system%n), added(system%n), unit

      rate = 0.0_wp
      if (.not. allocated(multipliers%went)) return
      call system%multiply(multipliers%went, added)
      call add_transposed(system%rows, 1.0_wp, multipliers%grew, added)
      call residual_of(system, multipliers, multipliers%q_old, residual)
      associate (r => residual(:system%n - system%k), d => added(:system%n - system%k))
         unit = maxval([abs(d), 0.0_wp])
         if (unit <= 0.0_wp) return
         rate = dot_product(r/unit, d/unit)/norm2(d/unit)**2
         if (.not. (rate > 0.0_wp .and. norm2(r/unit - rate*(d/unit)) <= is_left*norm2(r/unit))) rate = 0.0_wp
      end associate
   end function rate_of_load

   !> What a step has found: stresses, Picard's bound, how far it is from a solution.
   !>
   !> p and t are the forces over the weights, with what is known of points without an unknown; the image is nu S_rho of these
   !> pressures.
   subroutine judge_step(system, line, tolerance, outer, multipliers, loop, solution, image)
      class(contact_system_t), intent(in) :: system
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: tolerance
      integer(ip), intent(in) :: outer
      type(multiplier_t), intent(inout) :: multipliers
      type(loop_t), intent(inout) :: loop
      type(contact_solution_t), intent(inout) :: solution
      real(wp), intent(out) :: image(:)          !< (n) [F/L^2]

      solution%inner%solved = multipliers%settled
      solution%p = pressure_of(line, solution%state%q)
      call find_shear(line, solution%state%q, solution%tau, solution%p, solution%t)
      image = bound_of_state(line, solution)
      loop%distance = measure_distance(system, line, multipliers, solution%state%q, solution%tau, image)
      solution%residual = loop%distance%bound
      call end_outer(solution%history, loop%distance%bound)
      call judge(tolerance, outer, multipliers, loop, solution)
   end subroutine judge_step

   !> Forces that are round-off are none, motions that nothing holds are least, and slipping points have the friction of the
   !> pressure that is there; or why there is no solution.
   !>
   !> The order is that of what depends on what: pressures that are none open their points; the motions are found with these states;
   !> the bound follows from the pressures; and slipping forces are put at it, so that the law holds to the last digit.
   subroutine finish(system, line, shape, distance, before, multipliers, solution)
      class(contact_system_t), intent(in) :: system
      type(contact_line_t), intent(in) :: line
      type(bound_qp_t), intent(in) :: shape
      type(distance_t), intent(in) :: distance
      type(box_state_t), intent(in) :: before    !< of the increment before; its amplitudes are not allocated where there is none
      type(multiplier_t), intent(inout) :: multipliers
      type(contact_solution_t), intent(inout) :: solution

      if (.not. solution%converged) then
         solution%verdict = 'the multipliers did not converge in '//to_text(solution%history%outer)//' steps (bound '// &
                            to_text(distance%bound, 3)//', forces '//to_text(distance%forces, 3)//')'
         return
      end if
      ! states that depend on round-off alone are decided before the motions and the friction are
      call clear_unloaded(system, shape, multipliers, solution%state)
      call clear_round_off(system, line, multipliers, solution%state)
      if (system%k > 0) call settle_undetermined_motions(system, solution%bounds, multipliers, solution%state, &
                                                         solution%inner%undetermined, before%a)
      solution%p = pressure_of(line, solution%state%q)
      solution%tau = bound_of_state(line, solution)
      call set_friction_bounds(line, shape, solution%tau, solution%bounds, solution%state)
      associate (state => solution%state, n => shape%n_normal)
         where (state%state(n + 1:) == FROZEN) state%q(n + 1:) = 0.0_wp
         where (state%state(n + 1:) == AT_LOWER) state%q(n + 1:) = solution%bounds%lower(n + 1:)
         where (state%state(n + 1:) == AT_UPPER) state%q(n + 1:) = solution%bounds%upper(n + 1:)
         state%q(n + 1:) = min(max(state%q(n + 1:), solution%bounds%lower(n + 1:)), solution%bounds%upper(n + 1:))
         where (state%state(n + 1:) /= FREE) state%r(n + 1:) = multipliers%e(n + 1:) - solution%bounds%d(n + 1:)*state%q(n + 1:)
      end associate
      call find_shear(line, solution%state%q, solution%tau, solution%p, solution%t)
   end subroutine finish

   !> Where nothing acts, or nothing any more, what is left of forces and deformation is round-off of the way that the bodies went
   !> clear of each other, or of the increment before.
   !>
   !> Forces below their own noise, or NO_FORCE_AFTER of what the pair bore before, are none; then the strains are none as well, and
   !> e is what gaps and motions make of it. Closed points without pressure are open.
   subroutine clear_unloaded(system, shape, multipliers, state)
      class(contact_system_t), intent(in) :: system
      type(bound_qp_t), intent(in) :: shape
      type(multiplier_t), intent(inout) :: multipliers
      type(box_state_t), intent(inout) :: state
      real(wp) :: none

      none = 0.0_wp
      if (allocated(multipliers%before)) none = NO_FORCE_AFTER*maxval([multipliers%before, 0.0_wp])
      if (any(system%load /= 0.0_wp) .or. any(abs(state%q) > max(none, multipliers%noise))) return
      multipliers%x(:system%n - system%k) = 0.0_wp
      call multiply_rows(system%rows, multipliers%x, multipliers%e)
      multipliers%e = multipliers%e + system%g0
      state%q = 0.0_wp
      state%r = multipliers%e
      associate (n => shape%n_normal)
         where (state%state(:n) == FREE .and. multipliers%pair(:n) <= multipliers%n_contact_pairs) state%state(:n) = AT_LOWER
      end associate
   end subroutine clear_unloaded

   !> Before the first solution is taken: where its forces are not unique, the loop goes on with the least ones.
   !>
   !> The multipliers find some of the forces that balance. Those of least sum q^2/w do not depend on the way (atrito_least_forces),
   !> so forms and solvers agree.
   subroutine look_for_shared(system, rows, shape, multipliers, loop, solution)
      class(contact_system_t), intent(in) :: system
      type(constraint_rows_t), intent(in) :: rows
      type(bound_qp_t), intent(in) :: shape
      type(multiplier_t), intent(in) :: multipliers
      type(loop_t), intent(inout) :: loop
      type(contact_solution_t), intent(inout) :: solution

      if (loop%asked) return
      loop%asked = .true.
      call take_least_forces(system, rows, shape%weight, solution%bounds, multipliers, solution%state, solution%is_shared)
      loop%shares = any(solution%is_shared)
      solution%converged = .not. loop%shares
      if (loop%shares) loop%progress%best = HUGE_REAL
   end subroutine look_for_shared

   !> Bounds, states and history of a solution that has none yet: all stuck.
   !>
   !> The first bound is HUGE_REAL at all points with friction: nothing slips in the first step. Where all rows are bilateral
   !> nothing can be open, and no body waits for a contact: a weak pull and a small rho are right from the beginning.
   subroutine begin_solution(system, line, shape, multipliers, solution)
      class(contact_system_t), intent(in) :: system
      type(contact_line_t), intent(in) :: line
      type(bound_qp_t), intent(out) :: shape
      type(multiplier_t), intent(out) :: multipliers
      type(contact_solution_t), intent(out) :: solution

      shape%m = size(line%point, kind=ip)
      shape%n_normal = count(line%normal > 0, kind=ip)
      shape%k = system%k
      shape%weight = line%weight(line%point)
      solution%history%tangential_of = tangential_of(line, shape%n_normal)
      call normal_bounds(line, shape, solution%bounds, solution%state)
      call begin_multipliers(system, pairs_of_unknowns(line), multipliers, &
                             merge(solution%bounds%d, 0.0_wp, solution%bounds%lower <= -HUGE_REAL))
      if (allocated(line%pair)) multipliers%n_pairs = maxval([line%pair, 0_ip])
      multipliers%n_contact_pairs = last_contact_pair(line)
      ! where nothing can be open no body waits for what will hold it
      if (line%n_bilateral == line%n) then
         multipliers%kappa = LEAST_PULL
         multipliers%r = FAST_R
      end if
      allocate (solution%tau(line%n), source=0.0_wp)
      where (line%tangential > 0) solution%tau = HUGE_REAL
      call set_friction_bounds(line, shape, solution%tau, solution%bounds, solution%state)
   end subroutine begin_solution

   !> Whether the loop has converged, and what the next step takes.
   !>
   !>     steady     steps in which the drive stayed more than STEADY_PULL of itself, and more than round-off (MOVES)
   !>     moving     of them, those in which the pull is strong, or no state changed: MOST_MOVING of them are FREE_MOTION
   !>
   !> The pull falls in both cases in which it is in the way: where a body moves on (so that it gets far enough in a few steps), and
   !> where motions are nearly found (so that it takes no part in the last digits).
   subroutine judge(tolerance, outer, multipliers, loop, solution)
      real(wp), intent(in) :: tolerance
      integer(ip), intent(in) :: outer
      type(multiplier_t), intent(inout) :: multipliers
      type(loop_t), intent(inout) :: loop
      type(contact_solution_t), intent(inout) :: solution
      real(wp) :: whole, least

      ! a pull below NO_LOAD of the forces on its body is none
      least = max(loop%distance%forces, loop%distance%bound)
      whole = max(least, merge(loop%distance%pull, 0.0_wp, loop%distance%pull > NO_LOAD))
      least = max(least, merge(loop%distance%pull_beside, 0.0_wp, loop%distance%pull_beside > NO_LOAD))
      solution%converged = multipliers%settled .and. whole <= tolerance
      call note_residual(loop%progress, outer, whole)
      ! what pulls at an idle body may be the round-off of the forces beside it, which does not fall
      solution%converged = solution%converged .or. (multipliers%settled .and. outer - loop%progress%best_outer >= STALE .and. &
                                                    least <= STALE_DISTANCE)
      ! a weak pull counts where the forces have come to rest
      loop%steady = merge(loop%steady + 1_ip, 0_ip, loop%distance%drive > STEADY_PULL*loop%drive .and. loop%distance%drive > &
                          merge(MOVES_SLOWLY, MOVES, loop%distance%forces <= LITTLE_LEFT))
      ! a weak pull may still change what is in contact
      loop%moving = merge(loop%moving + 1_ip, 0_ip, loop%steady > 0 .and. loop%distance%drive > &
                          merge(SMALL_PULL, MOVES, multipliers%changed))
      loop%drive = loop%distance%drive
      if (loop%steady > 1) then
         multipliers%kappa = max(0.01_wp*multipliers%kappa, LEAST_KAPPA)
      else if (loop%distance%drive < SMALL_PULL .and. multipliers%kappa > USUAL_KAPPA) then
         multipliers%kappa = 0.01_wp*multipliers%kappa
      end if
   end subroutine judge

end module atrito_multiplier_loop
