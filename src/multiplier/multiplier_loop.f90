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
!>     next_bound           Anderson's mixing once a step has changed no state; Picard's bound before
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
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE, AT_LOWER, AT_UPPER, FROZEN
   use atrito_constraint_rows, only: constraint_rows_t, multiply_rows
   use atrito_contact_line, only: contact_line_t, pressure_of, shear_force_of, normal_bounds, set_friction_bounds, &
                                  last_contact_pair, pairs_of_unknowns, tangential_of
   use atrito_contact_solution, only: contact_solution_t, asks_no_force, let_rest, FREE_MOTION, bound_of_state
   use atrito_contact_system, only: contact_system_t
   use atrito_controls, only: controls_t
   use atrito_multipliers, only: multiplier_t
   use atrito_undetermined_motions, only: settle_undetermined_motions
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_multiplier_distance, only: distance_t, measure_distance, measure_bodies, forces_that_are_none, NO_FORCE_AFTER
   use atrito_multiplier_step, only: begin_multipliers, start_closed, take_multiplier_step, refine_step, accept_step, &
                                     take_least_forces, clear_round_off, largest_of_pairs, rho_of
   use atrito_loop_progress, only: loop_progress_t, note_residual, report_step
   use atrito_reporter, only: reporter_t
   use atrito_solve_history, only: begin_outer, end_outer
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: solve_by_multipliers

   !> What the loop remembers.
   type :: loop_t
      type(loop_progress_t) :: progress
      real(wp) :: drive = 0.0_wp                 !< of the last step: the pull over the largest force of the scene
      integer(ip) :: steady = 0                  !< steps in which the pull on the bodies stayed what it was
      integer(ip) :: moving = 0                  !< of them, those in which it was more than round-off of the largest force
      real(wp), allocatable :: drift(:)          !< (m) change of the forces in the last step, when no state changed [F]
      logical :: asked = .false.                 !< whether forces are unique
      logical :: shares = .false.                !< some are not, and the least are taken
      type(distance_t) :: distance               !< of the last step from a solution
      integer(ip) :: standing = 0                !< steps without a change of states
      integer(ip) :: lagging = 0                 !< of them, those in which the forces changed nearly as much as in the one before
      logical :: can_wait = .true.               !< with the mixing, for forces that come faster
      real(wp) :: change = 0.0_wp                !< of the forces in the last step, relative as in distance
      logical :: is_firm = .false.               !< the pull was made usual again
      logical :: slow = .false.                  !< states went on changing: smaller steps
      real(wp), allocatable :: share(:)          !< (points) of the way to Picard's bound that the next one goes
      real(wp), allocatable :: off(:)            !< (points) Picard's bound less the last one [F/L^2]
   end type loop_t

   integer(ip), parameter :: OUTERS_A_MAXIT = 4_ip    !< steps for each iteration that a user allows
   integer(ip), parameter :: FACTORISATIONS_A_MAXIT = 20_ip !< the same of factorisations
   integer(ip), parameter :: STALE = 12_ip
   real(wp), parameter :: STALE_DISTANCE = 1.0e-8_wp
   real(wp), parameter :: MOST_MIXING = 5.0_wp        !< times Picard's bound
   integer(ip), parameter :: MANY_STEPS = 100_ip      !< after which states that still change ask for smaller steps:
   real(wp), parameter :: SLOW_R = 1.0_wp             !< rho over the flexibility of a row then
   real(wp), parameter :: FAST_R = 1.0e-3_wp          !< without contact points
   real(wp), parameter :: LAGS = 0.5_wp               !< change of the forces over that of the step before that is slow
   integer(ip), parameter :: MOST_LAGGING = 3_ip      !< such steps, before rho falls:
   real(wp), parameter :: LITTLE_LEFT = 1.0e-6_wp     !< change of the forces that is left as it is: it may be a drift without end
   real(wp), parameter :: LESS_PART = 1.0e-2_wp, LEAST_R = 1.0e-7_wp
   real(wp), parameter :: MOST_NOISE = 1.0e-7_wp      !< of the forces of a pair
   integer(ip), parameter :: SLOW_STANDS = 3_ip       !< steps without a change of states before the mixing begins then
   real(wp), parameter :: LESS = 0.7_wp, MORE = 1.2_wp !< of the share of a point whose bound oscillates, and of one whose does not
   real(wp), parameter :: LEAST_SHARE = 0.05_wp
   real(wp), parameter :: STEADY = 0.02_wp             !< change of a drift from one step to the next
   real(wp), parameter :: MOST_DRIFT = 1.0e9_wp        !< steps
   real(wp), parameter :: LEAST_KAPPA = 1.0e-11_wp, LEAST_PULL = 1.0e-8_wp !< when bodies move; of what has no contact points
   real(wp), parameter :: NO_LOAD = 1.0e-9_wp         !< pull over the forces of a body that is none
   real(wp), parameter :: MOVES = 1.0e-6_wp           !< pull over the forces of a body that moves, when it does not fall:
   real(wp), parameter :: MOVES_SLOWLY = 1.0e-7_wp    !< the same where the forces have come to rest
   real(wp), parameter :: STEADY_PULL = 0.8_wp        !< of that of the step before
   real(wp), parameter :: SMALL_PULL = 1.0e-3_wp, USUAL_KAPPA = 2.0e-8_wp !< a pull that may become weaker, and how weak
   integer(ip), parameter :: MOST_MOVING = 5_ip

contains

   !> Solves. x: the unknowns of the system. status: STATUS_SINGULAR with FREE_MOTION when a body moves under every step; that of
   !> system%factor. A solution whose multipliers are allocated keeps them; where they hold an increment before, of the same system
   !> with other loads and gaps, it is where the loop starts. Motions that nothing determines are least from its amplitudes on.
   subroutine solve_by_multipliers(system, rows, line, controls, reporter, solution, x, status)
      class(contact_system_t), intent(inout) :: system
      type(constraint_rows_t), intent(in) :: rows !< over displacements alone
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      type(contact_solution_t), intent(inout) :: solution
      real(wp), allocatable, intent(out) :: x(:)
      type(status_t), intent(out) :: status
      type(contact_solution_t) :: before
      type(bound_qp_t) :: shape
      type(multiplier_t) :: multipliers
      type(loop_t) :: loop
      type(anderson_t) :: anderson
      real(wp) :: tau(line%n), image(line%n), of_body(system%n_bodies)
      integer(ip) :: outer

      before = solution
      call begin_solution(system, line, shape, multipliers, solution)
      if (all(system%load == 0.0_wp) .and. asks_no_force(line, shape, system%g0)) then
         call let_rest(line, shape, system%g0, solution)
         x = spread(0.0_wp, 1, system%n)
         if (allocated(before%multipliers)) allocate (solution%multipliers)
         return
      end if
      if (has_multipliers(before)) then
         call start_from(before, shape, line, multipliers, solution)
      else
         call start_closed(system, solution%bounds, multipliers, solution%state, status)
      end if
      if (.not. is_ok(status)) return
      tau = solution%tau
      outer = 0
      do
         outer = outer + 1
         call begin_outer(solution%history)
         solution%tau = tau
         call set_friction_bounds(line, shape, solution%tau, solution%bounds, solution%state)
         call take_multiplier_step(system, shape, solution%bounds, multipliers, solution%state, solution%history, status)
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
         if (solution%converged .or. is_used_up(outer, controls%max_iterations, multipliers%factorisations, loop)) exit
         if (loop%moving > MOST_MOVING) then
            solution%inner%moves = .true.
            solution%inner%motion = multipliers%x(system%n - system%k + 1:) - multipliers%a_old
            call set_status(status, STATUS_SINGULAR, FREE_MOTION)
            return
         end if
         call follow_drift(system, solution%bounds, multipliers, loop, solution%state)
         call accept_step(system, solution%state, multipliers)
         call choose_steps(outer, solution%state, multipliers, loop)
         call next_bound(image, loop, anderson, tau)
      end do
      if (solution%converged) then
         call measure_bodies(system, solution%state%q, of_body)
         call refine_step(system, solution%bounds, of_body, multipliers, solution%state)
      end if
      call finish(system, line, shape, loop%distance, before%state, multipliers, solution)
      if (solution%converged) x = multipliers%x
      if (allocated(before%multipliers)) solution%multipliers = multipliers
   end subroutine solve_by_multipliers

   !> Whether the steps are used up that MAXIT allows. A loop whose distance was halved in the last quarter of them is on its way,
   !> and goes on: so often can it be halved and no more.
   pure logical function is_used_up(outer, max_iterations, factorisations, loop)
      integer(ip), intent(in) :: outer, max_iterations, factorisations
      type(loop_t), intent(in) :: loop

      is_used_up = outer >= OUTERS_A_MAXIT*max_iterations .or. factorisations > FACTORISATIONS_A_MAXIT*max_iterations
      if (is_used_up) is_used_up = outer - loop%progress%best_outer > outer/4
   end function is_used_up

   pure logical function has_multipliers(solution)
      type(contact_solution_t), intent(in) :: solution

      has_multipliers = allocated(solution%multipliers)
      if (has_multipliers) has_multipliers = allocated(solution%multipliers%x)
   end function has_multipliers

   !> Forces, displacements, states and friction bound of the increment before; the factor is its, too.
   subroutine start_from(before, shape, line, multipliers, solution)
      type(contact_solution_t), intent(in) :: before
      type(bound_qp_t), intent(in) :: shape
      type(contact_line_t), intent(in) :: line
      type(multiplier_t), intent(inout) :: multipliers
      type(contact_solution_t), intent(inout) :: solution
      type(multiplier_t) :: fresh

      multipliers = before%multipliers
      if (allocated(multipliers%before)) deallocate (multipliers%before)
      multipliers%r = fresh%r
      multipliers%part = spread(1.0_wp, 1, shape%m)
      multipliers%before = largest_of_pairs(multipliers, abs(before%state%q))
      multipliers%factorisations = 0
      multipliers%q_old = before%state%q
      multipliers%a_old = multipliers%x(size(multipliers%x) - shape%k + 1:)
      multipliers%solves = 0
      solution%state = before%state
      solution%tau = before%tau
      call set_friction_bounds(line, shape, solution%tau, solution%bounds, solution%state)
   end subroutine start_from

   !> What a step has found: stresses, Picard's bound, how far it is from a solution.
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
      solution%t = shear_force_of(line, solution%state%q, solution%tau)
      image = bound_of_state(line, solution)
      loop%distance = measure_distance(system, line, multipliers, solution%state%q, solution%tau, image)
      solution%residual = loop%distance%bound
      call end_outer(solution%history, loop%distance%bound)
      call judge(tolerance, outer, multipliers, loop, solution)
   end subroutine judge_step

   !> Forces of rows that depend on each other, and whose gaps contradict each other a little, change by the same amount in every
   !> step until one comes to its bound, or until the compliance of the rows has taken up the contradiction, which a share of
   !> D/(D + rho) does in each step. They go there at once: the bodies do not feel it.
   subroutine follow_drift(system, bounds, multipliers, loop, state)
      class(contact_system_t), intent(in) :: system
      type(box_bounds_t), intent(in) :: bounds
      type(multiplier_t), intent(in) :: multipliers
      type(loop_t), intent(inout) :: loop
      type(box_state_t), intent(inout) :: state
      real(wp) :: change(size(state%q)), steps, bound, yields
      integer(ip) :: i

      change = state%q - multipliers%q_old
      if (allocated(loop%drift) .and. .not. multipliers%changed) then
         if (norm2(change) > 0.0_wp .and. norm2(change - loop%drift) <= STEADY*norm2(change)) then
            steps = HUGE_REAL
            yields = dot_product(change, bounds%d*change)/dot_product(change, (bounds%d + rho_of(system, multipliers))*change)
            ! what yields may be beside what drifts by round-off
            if (loop%distance%forces <= 10*STALE_DISTANCE) then
               yields = min(yields, 1 - dot_product(change, loop%drift)/dot_product(loop%drift, loop%drift))
            end if
            if (yields > 1/MOST_DRIFT) steps = 1/yields
            do i = 1, size(change, kind=ip)
               if (state%state(i) /= FREE .or. change(i) == 0.0_wp) cycle
               bound = merge(bounds%lower(i), bounds%upper(i), change(i) < 0.0_wp)
               if (abs(bound) < HUGE_REAL) steps = min(steps, (bound - state%q(i))/change(i))
            end do
            if (steps < MOST_DRIFT) state%q = state%q + steps*change
         end if
      end if
      loop%drift = change
   end subroutine follow_drift

   !> States that still change after many steps may do so for ever. With rho of the size of the flexibility, a step moves the
   !> forces about half of the way only. Where states stand and the forces come no faster to their end, rho is large beside what
   !> tells them: it falls as far as its round-off may.
   subroutine choose_steps(outer, state, multipliers, loop)
      integer(ip), intent(in) :: outer
      type(box_state_t), intent(in) :: state
      type(multiplier_t), intent(inout) :: multipliers
      type(loop_t), intent(inout) :: loop

      loop%standing = merge(0_ip, loop%standing + 1_ip, multipliers%changed)
      loop%lagging = merge(loop%lagging + 1_ip, 0_ip, loop%standing > 1 .and. .not. loop%slow .and. &
                           loop%distance%forces > max(LAGS*loop%change, LITTLE_LEFT))
      loop%change = loop%distance%forces
      if (loop%lagging >= MOST_LAGGING) then
         loop%lagging = 0
         if (loop%distance%pull > NO_LOAD .and. multipliers%kappa > LEAST_KAPPA) then
            multipliers%kappa = max(0.1_wp*multipliers%kappa, LEAST_KAPPA)
         else
            call take_less_rho(state, multipliers, loop%can_wait)
         end if
      end if
      if (loop%slow .or. outer < MANY_STEPS .or. .not. multipliers%changed) return
      loop%slow = .true.
      multipliers%r = SLOW_R
   end subroutine choose_steps

   !> Less rho at the pairs whose forces stay far above the round-off of their rows with it.
   pure subroutine take_less_rho(state, multipliers, any_less)
      type(box_state_t), intent(in) :: state
      type(multiplier_t), intent(inout) :: multipliers
      logical, intent(out) :: any_less
      real(wp) :: force(multipliers%n_pairs), noise(multipliers%n_pairs)
      logical :: bears(size(state%q))

      force = largest_of_pairs(multipliers, abs(state%q))
      noise = largest_of_pairs(multipliers, multipliers%noise)
      bears = noise(multipliers%pair) <= LESS_PART*MOST_NOISE*force(multipliers%pair) .and. multipliers%r*multipliers%part > LEAST_R
      where (bears) multipliers%part = LESS_PART*multipliers%part
      any_less = any(bears)
   end subroutine take_less_rho

   !> Bodies that have come to where something holds them need a weak pull no more, and with the usual one the last step is better
   !> conditioned.
   pure subroutine pull_firmly_again(multipliers, loop, solution)
      type(multiplier_t), intent(inout) :: multipliers
      type(loop_t), intent(inout) :: loop
      type(contact_solution_t), intent(inout) :: solution

      if (loop%is_firm .or. multipliers%kappa >= 0.1_wp*USUAL_KAPPA) return
      loop%is_firm = .true.
      loop%steady = 0
      multipliers%kappa = USUAL_KAPPA
      solution%converged = .false.
   end subroutine pull_firmly_again

   !> The friction bound of the next step: Picard's as long as states change, then Anderson's mixing within a range of it.
   subroutine next_bound(image, loop, anderson, tau)
      real(wp), intent(in) :: image(:)
      type(loop_t), intent(inout) :: loop
      type(anderson_t), intent(inout) :: anderson
      real(wp), intent(inout) :: tau(:)
      real(wp) :: mixed(size(tau))

      if (loop%standing >= merge(SLOW_STANDS, 1_ip, loop%slow) .and. all(tau < HUGE_REAL) .and. &
          .not. (loop%can_wait .and. loop%lagging > 0)) then
         call anderson%update(tau, image, mixed)
         tau = min(max(mixed, image/MOST_MIXING), MOST_MIXING*image)
         return
      end if
      call anderson%reset()
      if (loop%slow) then
         call go_part_of_the_way(image, loop, tau)
      else
         tau = image
      end if
   end subroutine next_bound

   !> A point whose bound goes up and down goes a part of the way to Picard's: with much friction, more of it may leave less
   !> pressure there, and the point would slip and open in turn for ever.
   subroutine go_part_of_the_way(image, loop, tau)
      real(wp), intent(in) :: image(:)
      type(loop_t), intent(inout) :: loop
      real(wp), intent(inout) :: tau(:)

      if (.not. allocated(loop%share)) then
         allocate (loop%share(size(tau)), source=1.0_wp)
         allocate (loop%off(size(tau)), source=0.0_wp)
      end if
      where ((image - tau)*loop%off < 0.0_wp)
         loop%share = max(LESS*loop%share, LEAST_SHARE)
      else where
         loop%share = min(MORE*loop%share, 1.0_wp)
      end where
      loop%off = image - tau
      tau = tau + loop%share*loop%off
      where (loop%share >= 1.0_wp) tau = image
   end subroutine go_part_of_the_way

   !> Forces that are round-off are none, motions that nothing holds are least, and slipping points have the friction of the
   !> pressure that is there; or why there is no solution.
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
      call clear_unloaded(system, shape, multipliers, solution%state)
      call clear_round_off(shape, forces_that_are_none(system, multipliers, solution%state%q), multipliers, solution%state)
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
      solution%t = shear_force_of(line, solution%state%q, solution%tau)
   end subroutine finish

   !> Where nothing acts, or nothing any more, what is left of forces and deformation is round-off of the way that the bodies went
   !> clear of each other, or of the increment before.
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
   subroutine judge(tolerance, outer, multipliers, loop, solution)
      real(wp), intent(in) :: tolerance
      integer(ip), intent(in) :: outer
      type(multiplier_t), intent(inout) :: multipliers
      type(loop_t), intent(inout) :: loop
      type(contact_solution_t), intent(inout) :: solution
      real(wp) :: whole

      whole = max(loop%distance%forces, loop%distance%bound)
      if (loop%distance%pull > NO_LOAD) whole = max(whole, loop%distance%pull)
      solution%converged = multipliers%settled .and. whole <= tolerance
      call note_residual(loop%progress, outer, whole)
      if (multipliers%settled .and. outer - loop%progress%best_outer >= STALE .and. whole <= STALE_DISTANCE) &
         solution%converged = .true.
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
