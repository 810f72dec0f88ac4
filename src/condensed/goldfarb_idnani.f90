!> The finite dual method of Goldfarb and Idnani (Math. Program. 27 (1983) 1-33) for the bound-constrained QP.
!>
!> The multiplier of a fixed unknown is r: it must be <= 0 at a lower bound (the point is open, the slip goes against the friction)
!> and >= 0 at an upper one. The method goes from one exact solution of a relaxed problem, in which all multipliers are right and
!> some bounds of free unknowns are broken, to the next:
!>
!>   (i)   release every fixed unknown whose multiplier r has the wrong sign, until none has;
!>   (ii)  take the free unknown that breaks its bound most and drive it to the bound, everything else changing linearly,
!>         (q, a, r) <- (q, a, r) + t ((q, a, r)' - (q, a, r)), the prime being the solution with this unknown at its bound;
!>         the first fixed unknown whose multiplier reaches zero on the way is released, and the drive goes on from there;
!>   (iii) when that leaves a body free, move along its motion v, r <- r + t G v, until a multiplier reaches zero and release that
!>         unknown; when none does, there is no equilibrium, and v is the motion of the body.
!>
!> Each relaxed problem has fewer conditions than the QP, so its value is below that of the QP. It rises at every step, so no set
!> of states comes back, and there are finitely many: the method ends. Full steps (atrito_active_set) take fewer solves where they
!> end. A step costs one linear solve; SOLVES_PER_UNKNOWN limits them.
module atrito_goldfarb_idnani
   use atrito_free_set, only: solve_free_set, is_vanishing, put_at_bounds, bound_round_off, force_round_off
   use atrito_kinds, only: ip, wp
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_outcome_t, box_state_t, FREE, AT_LOWER, AT_UPPER
   use atrito_free_set_factor, only: free_set_factor_t
   use atrito_solve_history, only: solve_history_t, record_solve
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: take_goldfarb_idnani_steps, opening_motion

   !> State of the unknown that is being driven to its bound: fixed, its multiplier not yet judged.
   !>
   !> While it is driven an unknown is neither free nor at a bound: its force is given by the drive, and its multiplier, which grows
   !> from zero, is judged once it has arrived.
   integer(ip), parameter :: DRIVEN = 4
   real(wp), parameter :: LEAST_RATE = 1.0e-14_wp    !< of a multiplier along a motion, relative to the largest; along one that
   real(wp), parameter :: HARDLY_SEEN = 1.0e-9_wp    !< hardly anything drives: what the digits of coordinates may make of it
   real(wp), parameter :: BREAKS = 1.0e-13_wp        !< of the largest force: a bound that is broken by less may be round-off
   integer(ip), parameter :: SOLVES_PER_UNKNOWN = 6

contains

   !> Goes on from state%state until all conditions hold (outcome%solved), there is no equilibrium (outcome%moves), or there were
   !> too many solves.
   subroutine take_goldfarb_idnani_steps(problem, bounds, state, history, outcome, status, factor)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      type(solve_history_t), intent(inout) :: history !< every linear solve is added
      type(box_outcome_t), intent(out) :: outcome !< solved, moves, or neither
      type(status_t), intent(out) :: status       !< STATUS_SINGULAR with DEPENDENT_POINTS
      type(free_set_factor_t), intent(inout) :: factor !< of the last solve
      integer(ip) :: left, worst, i

      ! far more than is ever needed: each unknown is driven once or twice
      left = SOLVES_PER_UNKNOWN*problem%m + 50
      call release_until_right(outcome, status)
      do while (is_ok(status) .and. left > 0 .and. .not. outcome%moves)
         call find_worst(problem, bounds, state, worst)
         if (worst == 0) then
            ! an undetermined motion may have turned a multiplier
            outcome%solved = .not. any([(is_wrong(problem, state, i), i=1, problem%m)])
            if (outcome%solved) exit
            call release_until_right(outcome, status)
            cycle
         end if
         state%state(worst) = DRIVEN
         call drive_to_bound(problem, bounds, state, history, outcome, left, status, factor)
      end do
      if (allocated(outcome%motion) .and. .not. outcome%moves) deallocate (outcome%motion)
      if (allocated(outcome%undetermined) .and. .not. outcome%solved) deallocate (outcome%undetermined)

   contains

      !> (i) and, where a body is free, (iii).
      !>
      !> All wrong multipliers are released at once: the relaxed problem gets smaller by each of them, and only its solution counts.
      !> Ends with all multipliers right, with a body that nothing stops (outcome%moves), or with `left` = 0.
      subroutine release_until_right(outcome, status)
         type(box_outcome_t), intent(out) :: outcome
         type(status_t), intent(out) :: status
         real(wp) :: t
         integer(ip) :: i, released, first

         do while (left > 0)
            ! the exact solution for the present set
            call put_at_bounds(bounds, state)
            call solve_free_set(problem, bounds%d, state, outcome, status, factor)
            left = left - 1
            if (.not. is_ok(status)) return
            call record_solve(history, problem, bounds, state)
            released = 0
            do i = 1, problem%m
               if (.not. is_wrong(problem, state, i)) cycle
               state%state(i) = FREE
               released = released + 1
            end do
            if (released > 0) cycle
            if (.not. outcome%moves) return
            ! all multipliers are right, and a body moves: to the first point that stops it
            call find_first_reached(problem, state, outcome%motion, outcome%hardly, first, t)
            if (first == 0) then
               call rest(outcome)
               return
            end if
            state%state(first) = FREE
            outcome%moves = .false.
         end do
      end subroutine release_until_right

   end subroutine take_goldfarb_idnani_steps

   !> (ii) and (iii) for one unknown.
   !>
   !> Ends with the unknown at its bound, or with a body that nothing stops. Each pass of the loop is one solve: the target for the
   !> present states; then either all of the way (first = 0), or up to the first multiplier that vanishes, whose unknown is
   !> released.
   subroutine drive_to_bound(problem, bounds, state, history, outcome, left, status, factor)
      type(bound_qp_t), intent(in) :: problem
      type(box_bounds_t), intent(in) :: bounds
      type(box_state_t), intent(inout) :: state      !< one unknown is DRIVEN, beyond its bound
      type(solve_history_t), intent(inout) :: history
      type(box_outcome_t), intent(out) :: outcome
      integer(ip), intent(inout) :: left
      type(status_t), intent(out) :: status
      type(free_set_factor_t), intent(inout) :: factor
      type(box_state_t) :: target
      real(wp) :: t, motion(problem%k)
      integer(ip) :: i, bound, first

      ! state: the exact solution so far; target: the one with the driven unknown at its bound and all others as they are
      i = findloc(state%state, DRIVEN, dim=1, kind=ip)
      bound = merge(AT_LOWER, AT_UPPER, state%q(i) < bounds%lower(i))
      do while (left > 0)
         target = state
         target%q(i) = merge(bounds%lower(i), bounds%upper(i), bound == AT_LOWER)
         call solve_free_set(problem, bounds%d, target, outcome, status, factor)
         left = left - 1
         if (.not. is_ok(status)) exit
         call record_solve(history, problem, bounds, target)
         ! with i at its bound nothing holds a body: it moves, without any force changing, until a fixed point touches or sticks
         if (outcome%moves) then
            motion = opening_motion(problem, i, bound, outcome%motion)
            call find_first_reached(problem, state, motion, outcome%hardly, first, t)
            if (first == 0) then
               call rest(outcome)
               if (.not. outcome%moves) state = target
               exit
            end if
            state%a = state%a + t*motion
            state%r = state%r + t*matmul(problem%g, motion)
            outcome%moves = .false.
         else
            ! all of q, a and r are linear on the way, so the first multiplier that changes its sign is found by its two ends
            call first_crossing(state, target, first, t)
            if (first == 0) then
               state = target
               exit
            end if
            state%q = state%q + t*(target%q - state%q)
            state%a = state%a + t*(target%a - state%a)
            state%r = state%r + t*(target%r - state%r)
         end if
         state%state(first) = FREE
      end do
      state%state(i) = bound
   end subroutine drive_to_bound

   !> A body that nothing stops and hardly anything drives rests.
   !>
   !> The load on the motion is round-off of what has cancelled in it (LITTLE_LOAD), and no point is in the way: then any position
   !> is as good, and the body stays where it is.
   pure subroutine rest(outcome)
      type(box_outcome_t), intent(inout) :: outcome

      if (.not. outcome%hardly) return
      outcome%moves = .false.
      outcome%undetermined = outcome%motion
   end subroutine rest

   !> Whether r of a fixed unknown has the wrong sign, by more than round-off.
   pure logical function is_wrong(problem, state, i)
      type(bound_qp_t), intent(in) :: problem
      type(box_state_t), intent(in) :: state
      integer(ip), intent(in) :: i
      real(wp) :: wrong

      wrong = -sign_of(state%state(i))*state%r(i)
      is_wrong = wrong > 0.0_wp
      if (is_wrong) is_wrong = wrong > bound_round_off(problem, state, i)
   end function is_wrong

   !> The free unknown that breaks a bound most, as a force; 0 when none does.
   !>
   !> Forces that may be round-off do not count: those that vanish beside the displacements, and excesses that are small beside the
   !> largest force as well as beside the round-off of their own row.
   pure subroutine find_worst(problem, bounds, state, worst)
      type(bound_qp_t), intent(in) :: problem
      type(box_bounds_t), intent(in) :: bounds
      type(box_state_t), intent(in) :: state
      integer(ip), intent(out) :: worst
      real(wp) :: most, excess, little
      integer(ip) :: i

      worst = 0
      most = 0.0_wp
      little = BREAKS*maxval([abs(state%q), 0.0_wp])
      do i = 1, problem%m
         if (state%state(i) /= FREE) cycle
         excess = max(bounds%lower(i) - state%q(i), state%q(i) - bounds%upper(i))
         if (excess <= most) cycle
         if (is_vanishing(problem, bounds%d, state, i)) cycle
         if (excess <= little) then
            if (excess <= force_round_off(problem, bounds%d, state, i)) cycle
         end if
         most = excess
         worst = i
      end do
   end subroutine find_worst

   !> +1 when r must be >= 0, -1 when it must be <= 0, 0 when it does not matter.
   pure elemental real(wp) function sign_of(state)
      integer(ip), intent(in) :: state

      select case (state)
      case (AT_LOWER)
         sign_of = -1.0_wp
      case (AT_UPPER)
         sign_of = 1.0_wp
      case default
         sign_of = 0.0_wp
      end select
   end function sign_of

   !> The first fixed unknown whose multiplier changes sign on the way from state to target, and where (0 <= t <= 1).
   !>
   !> sign r is >= 0 while the state is right. It falls from `before` at t = 0 to `after` < 0 at t = 1, so it is zero at t =
   !> before/(before - after).
   pure subroutine first_crossing(state, target, first, t)
      type(box_state_t), intent(in) :: state, target
      integer(ip), intent(out) :: first
      real(wp), intent(out) :: t
      real(wp) :: before, after, here
      integer(ip) :: i

      first = 0
      t = 1.0_wp
      do i = 1, size(state%state, kind=ip)
         before = sign_of(state%state(i))*state%r(i)
         after = sign_of(state%state(i))*target%r(i)
         if (after >= 0.0_wp) cycle
         before = max(before, 0.0_wp)
         here = before/(before - after)
         if (here < t) then
            t = here
            first = i
         end if
      end do
   end subroutine first_crossing

   !> The motion, in the direction that gives the driven unknown's multiplier its sign.
   !>
   !> The null motion of a set of states has no sign. r_i of the driven unknown, which stands at its bound, must move to the side on
   !> which its state is right.
   pure function opening_motion(problem, i, bound, motion) result(directed)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      integer(ip), intent(in) :: i, bound     !< the driven unknown, and where it stands: AT_LOWER or AT_UPPER
      real(wp), intent(in) :: motion(:)       !< (k) amplitudes, of either sign
      real(wp) :: directed(size(motion))
      real(wp) :: rate

      rate = dot_product(problem%g(i, :), motion)
      directed = motion
      if (sign_of(bound)*rate < 0.0_wp) directed = -motion
   end function opening_motion

   !> The first fixed unknown whose multiplier reaches zero along a motion, and the distance to it; 0 when none does.
   !>
   !> r_i + t (G v)_i = 0: an open point closes, a slipping one would go back. Rates that are round-off of the largest do not count;
   !> where next to nothing drives the motion, those neither that digits make, or bodies went to and fro along sides that are
   !> parallel but for them.
   pure subroutine find_first_reached(problem, state, motion, is_hardly_driven, first, distance)
      type(bound_qp_t), intent(in) :: problem
      type(box_state_t), intent(in) :: state
      real(wp), intent(in) :: motion(:)              !< (k)
      logical, intent(in) :: is_hardly_driven
      integer(ip), intent(out) :: first
      real(wp), intent(out) :: distance
      real(wp) :: rate(problem%m), here
      integer(ip) :: i

      first = 0
      distance = huge(distance)
      rate = matmul(problem%g, motion)
      do i = 1, problem%m
         if (sign_of(state%state(i))*rate(i) >= -merge(HARDLY_SEEN, LEAST_RATE, is_hardly_driven)*maxval(abs(rate))) cycle
         here = max(-state%r(i)/rate(i), 0.0_wp)
         if (here >= distance) cycle
         first = i
         distance = here
      end do
   end subroutine find_first_reached

end module atrito_goldfarb_idnani
