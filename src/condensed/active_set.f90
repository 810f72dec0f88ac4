!> Solves the bound-constrained QP by full steps on the active set: all points change at once.
!>
!> If it were known which points are open, stick and slip, the QP would be linear: free unknowns have r = 0, the others stand at
!> their bounds (solve_free_set). A full step solves that, and gives every unknown that breaks the condition of its state the other
!> one:
!>
!>     free, q < lower or q > upper          -> at that bound        (a tension opens, too much shear slips)
!>     at the lower bound, r > 0             -> free                 (an overlap closes, slip against the shear sticks)
!>     at the upper bound, r < 0             -> free
!>
!> A tension, an excess or a multiplier that round-off may make changes nothing (`is_in_tension`, `is_released`), or points at the
!> edge of contact would turn to and fro for ever.
!>
!> This is Newton's method for the piecewise linear equations q = clip(q + r/c, lower, upper), the primal-dual active set method of
!> M. Hintermueller, K. Ito and K. Kunisch (SIAM J. Optim. 13 (2002) 865-888). Near the solution it converges at once, since the
!> equations are linear there: where no state changes the solution is exact. A step costs one linear solve.
!>
!> Full steps end in a few solves almost always, but nothing makes them. When a state comes back, after MOST_FULL_STEPS, or when a
!> body is free under the load, the finite Goldfarb-Idnani steps take over (atrito_goldfarb_idnani).
!>
!> What each state means. r is what the law does not account for: the overlap beyond delta p of a normal row, the slip beyond the
!> elastic slip D q of a tangential one.
!>
!>     row          state       the point          it says              it asks for
!>     normal       FREE        is closed          r = 0                q >= 0, pressure
!>     normal       AT_LOWER    is open            q = 0                r <= 0, a gap of -r
!>     tangential   FREE        sticks             r = 0                -w tau <= q <= w tau
!>     tangential   AT_UPPER    slips along T      q = w tau            r >= 0, slip along T
!>     tangential   AT_LOWER    slips against T    q = -w tau           r <= 0, slip against T
!>     tangential   FROZEN      has no bound       q = 0                nothing
!>     bilateral    FREE        is joined          r = 0                nothing
!>
!> What a state says makes the equations of a linear solve; what it asks for is looked at afterwards, and nothing else is. With all
!> of it the conditions of Signorini and of Tresca hold at every point, and the solve is the solution of the QP.
module atrito_active_set
   use atrito_free_set, only: solve_free_set, is_vanishing, put_at_bounds, bound_round_off, force_round_off
   use atrito_kinds, only: ip, lp, wp, HUGE_REAL
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, box_outcome_t, FREE, AT_LOWER, AT_UPPER
   use atrito_goldfarb_idnani, only: take_goldfarb_idnani_steps
   use atrito_free_set_factor, only: free_set_factor_t
   use atrito_solve_history, only: solve_history_t, record_solve
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: solve_box, change_states, is_settled

   !> Full steps, and unknowns for each where they are many: the front of a slip zone may move by a few points a step.
   !>
   !> A front of slip or of contact may have to go through the whole line, by a few points a step: so long lines have more steps.
   integer(ip), parameter :: MOST_FULL_STEPS = 20, UNKNOWNS_A_STEP = 20
   real(wp), parameter :: OPENS = 1.0e-13_wp      !< tension over the largest pressure that opens a point
   real(wp), parameter :: SLIPS = 1.0e-12_wp      !< excess over the friction bound that lets a point slip

contains

   !> Solves from the given state (state%state; fixed unknowns are put at their bounds). Every linear solve is recorded.
   !> status: STATUS_SINGULAR with DEPENDENT_POINTS. outcome%moves: no equilibrium. Neither that nor solved: too many solves.
   !>
   !> The next set depends on the present one alone, so one that comes back would come back for ever: that is what `seen` is for.
   !> The steps at hand are 20, or one for each 20 unknowns where that is more. A step costs a linear solve, which has a factor of
   !> its own only where the set has changed by much (atrito_free_set), and 2 m^2 operations for r of all rows. The finite steps go
   !> on from the last set, whose states are right at most points.
   subroutine solve_box(problem, bounds, state, history, outcome, status, factor)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      type(solve_history_t), intent(inout) :: history !< every linear solve is added
      type(box_outcome_t), intent(out) :: outcome !< solved, moves, or neither
      type(status_t), intent(out) :: status       !< STATUS_SINGULAR with DEPENDENT_POINTS
      type(free_set_factor_t), intent(inout) :: factor !< of the solve before, or of the last one: see solve_free_set
      integer(lp) :: seen(max(MOST_FULL_STEPS, problem%m/UNKNOWNS_A_STEP))
      integer(ip) :: step, changes

      do step = 1, size(seen, kind=ip)
         ! states that were there before would go round for ever: the finite steps take over
         seen(step) = state_code(state)
         if (any(seen(:step - 1) == seen(step))) exit
         call put_at_bounds(bounds, state)
         call solve_free_set(problem, bounds%d, state, outcome, status, factor)
         if (.not. is_ok(status)) return
         call record_solve(history, problem, bounds, state)
         ! a body is free with these states; whether it is with others the finite steps tell
         if (outcome%moves) exit
         call change_states(problem, bounds, state, changes)
         outcome%solved = changes == 0
         if (outcome%solved) return
      end do
      call take_goldfarb_idnani_steps(problem, bounds, state, history, outcome, status, factor)
      outcome%used_goldfarb_idnani = .true.
   end subroutine solve_box

   !> The full step: every unknown that breaks its condition changes.
   !>
   !> Bilateral rows (no lower bound) never leave FREE, points without friction never leave FROZEN.
   subroutine change_states(problem, bounds, state, changes)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      integer(ip), intent(out) :: changes       !< unknowns whose state is another; 0: the states agree with forces and residuals
      real(wp) :: most
      integer(ip) :: i, old

      ! pressures are stresses, so that points of small weight count alike; bilateral rows have no lower bound and never open
      associate (n => problem%n_normal)
         most = OPENS*maxval([maxval(abs(state%q(:n))/problem%weight(:n), mask=bounds%lower(:n) > -HUGE_REAL), 0.0_wp])
      end associate
      changes = 0
      do i = 1, problem%m
         old = state%state(i)
         select case (old)
         case (FREE)
            if (i <= problem%n_normal) then
               if (bounds%lower(i) <= -HUGE_REAL) cycle
               if (is_in_tension(problem, bounds%d, state, i, most)) state%state(i) = AT_LOWER
            else if (abs(state%q(i))/(1 + SLIPS) > bounds%upper(i)) then
               if (.not. is_vanishing(problem, bounds%d, state, i)) state%state(i) = merge(AT_UPPER, AT_LOWER, state%q(i) > 0.0_wp)
            end if
         case (AT_LOWER, AT_UPPER)
            if (is_released(problem, bounds%d, state, i)) state%state(i) = FREE
         end select
         if (state%state(i) /= old) changes = changes + 1
      end do
   end subroutine change_states

   !> Whether no unknown breaks its condition.
   logical function is_settled(problem, bounds, state)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      type(box_state_t), intent(in) :: state !< states of the m unknowns, q, a, r
      type(box_state_t) :: next
      integer(ip) :: changes

      next = state
      call change_states(problem, bounds, next, changes)
      is_settled = changes == 0
   end function is_settled

   !> Whether a closed point has a tension that is more than round-off.
   !>
   !> The least of two measures counts: OPENS of the largest pressure of the scene, and what round-off of the row makes of a force.
   !> The first one alone would keep tensions in weak pairs, the second one alone would open points of stiff bodies by their noise.
   pure logical function is_in_tension(problem, d, state, i, most)
      type(bound_qp_t), intent(in) :: problem
      real(wp), intent(in) :: d(:)
      type(box_state_t), intent(in) :: state
      integer(ip), intent(in) :: i
      real(wp), intent(in) :: most               !< tension that may be round-off anywhere [F/L^2]

      is_in_tension = state%q(i) < 0.0_wp
      if (is_in_tension) is_in_tension = .not. is_vanishing(problem, d, state, i)
      if (is_in_tension) is_in_tension = -state%q(i) > min(force_round_off(problem, d, state, i), most*problem%weight(i))
   end function is_in_tension

   !> Whether an open point is penetrated, or the slip of a slipping one is below that of a sticking one, by more than round-off.
   !>
   !> The slip of a slipping point against its friction, or the overlap of an open one, as far as it is more than round-off of the
   !> terms of r, and of the elastic slip D q.
   pure logical function is_released(problem, d, state, i)
      type(bound_qp_t), intent(in) :: problem
      real(wp), intent(in) :: d(:)
      type(box_state_t), intent(in) :: state
      integer(ip), intent(in) :: i
      real(wp) :: wrong

      wrong = merge(state%r(i), -state%r(i), state%state(i) == AT_LOWER) - SLIPS*abs(d(i)*state%q(i))
      is_released = wrong > 0.0_wp
      if (is_released) is_released = wrong > bound_round_off(problem, state, i)
   end function is_released

   !> A number that tells states apart (FNV-1a, of 38 bits: their product with the prime fits into a long integer).
   !>
   !> Two sets of states may have the same number, with a chance of some 1e-11: then the finite steps begin too early, which costs
   !> time and nothing else.
   pure integer(lp) function state_code(state) result(code)
      type(box_state_t), intent(in) :: state
      integer(ip) :: i

      code = 1469598103_lp
      do i = 1, size(state%state, kind=ip)
         code = iand(ieor(code, int(state%state(i), lp))*16777619_lp, int(z'3fffffffff', lp))
      end do
   end function state_code

end module atrito_active_set
