!> The bound-constrained QP where rows of the contact matrix depend on each other: at a joint of three bodies, at a corner of two
!> pairs.
!>
!> The displacements are unique, the forces are not, and C + D cannot be factored. The proximal method (R. T. Rockafellar, SIAM J.
!> Control Optim. 14 (1976) 877-898) adds to the function that q makes least half of s (q - q')' c (q - q'), q' being the forces of
!> the time before, and solves again and again
!>
!>     r = g0 - (C + D) q - s c (q - q') + G a,      c = diagonal of C,  s = 1e-5 or less,
!>
!> a bound-constrained QP with the condition 1/s at the most: bounds%d + s c takes the place of D, and s c q' is the shift of
!> box_state_t. Where q = q' it is the QP itself. Where forces are unique the difference q - q' falls by s/(lambda + s) each time,
!> lambda being an eigenvalue of the scaled matrix; elsewhere q stays where it is. Where it falls too slowly, s is divided by 100.
!> Then the least of the forces that move the bodies alike is taken (atrito_least_forces), so that the answer does not depend on
!> the way.
module atrito_proximal
   use atrito_active_set, only: solve_box
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE, FROZEN, box_outcome_t
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_free_set, only: set_residual, row_round_off
   use atrito_kinds, only: ip, wp
   use atrito_least_forces, only: find_least_forces
   use atrito_free_set_factor, only: free_set_factor_t
   use atrito_solve_history, only: solve_history_t
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: solve_box_proximal

   real(wp), parameter :: LARGEST_SHARE = 1.0e-5_wp, LEAST_SHARE = 1.0e-9_wp !< s
   real(wp), parameter :: SLOW = 0.1_wp              !< of the change before: s is too large for some eigenvalue
   integer(ip), parameter :: MOST_ROUNDS = 60
   real(wp), parameter :: ROUND_OFF = 1.0e-2_wp      !< of the slack of r: a change of displacements that is none
   real(wp), parameter :: SMALL_CHANGE = 1.0e-10_wp  !< of the forces: a change that is none where it is no longer halved
   real(wp), parameter :: NO_COMPLIANCE = 1.0e-12_wp !< D over C that leaves the force to others
   real(wp), parameter :: AT_REST = 10.0_wp          !< round-offs of r that are none

contains

   !> Solves from the given state. outcome%solved is false where the rounds do not come to an end.
   !>
   !> Ends where the change of the displacements, s c |q - q'|, is round-off of r, or where forces no longer come nearer and change
   !> by SMALL_CHANGE alone: along a null space they may drift by round-off for ever.
   subroutine solve_box_proximal(problem, bounds, state, history, outcome, status, factor, rows)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      type(solve_history_t), intent(inout) :: history !< every linear solve is added
      type(box_outcome_t), intent(out) :: outcome !< solved, moves, or neither
      type(status_t), intent(out) :: status       !< STATUS_SINGULAR with DEPENDENT_POINTS
      type(free_set_factor_t), intent(inout) :: factor !< of the last solve
      type(constraint_rows_t), intent(in), optional :: rows !< of the unknowns; without them there are no least forces
      type(box_bounds_t) :: near
      real(wp) :: c(problem%m), q(problem%m), share, change, last
      integer(ip) :: before(problem%m), i
      logical :: stands

      ! s c is measured by each row's own flexibility, so stiff and soft bodies count alike
      c = [(problem%c(i, i), i=1, problem%m)]
      if (all(c <= 0.0_wp)) c = 1.0_wp
      where (c <= 0.0_wp) c = maxval(c)              ! between a held node and a rigid surface, which moves, nothing gives way
      near = bounds
      share = LARGEST_SHARE
      last = huge(last)
      stands = .false.
      do i = 1, MOST_ROUNDS
         q = state%q
         before = state%state
         near%d = bounds%d + share*c
         state%shift = share*c*q
         ! the QP with D + s c in place of D, and s c q' added to g0: r = g0 + s c q' - (C + D + s c) q + G a
         call solve_box(problem, near, state, history, outcome, status, factor)
         if (.not. is_ok(status) .or. .not. outcome%solved) exit
         change = maxval([c*abs(state%q - q), 0.0_wp])
         stands = share*change <= ROUND_OFF*state%slack .or. &
                  (change > 0.5_wp*last .and. change <= SMALL_CHANGE*maxval([c*abs(state%q), 0.0_wp]))
         if (stands) exit
         ! states stand and q comes slowly: s is large beside the least eigenvalue that counts
         if (change > SLOW*last .and. all(state%state == before)) share = max(share/100, LEAST_SHARE)
         last = change
      end do
      ! r of the QP itself; what the shift made of it was s c (q - q') [L], which is none now
      deallocate (state%shift)
      call set_residual(problem, bounds%d, state)
      if (.not. is_ok(status) .or. .not. outcome%solved) return
      outcome%solved = stands
      if (.not. present(rows)) return
      call take_least_forces(outcome%is_shared)

   contains

      !> Of the forces that move the bodies alike the least: of rows without compliance, closed or sticking or so by their r.
      subroutine take_least_forces(is_shared)
         logical, allocatable, intent(out) :: is_shared(:)
         logical :: may_change(problem%m)
         integer(ip) :: i

         do i = 1, problem%m
            may_change(i) = bounds%d(i) <= NO_COMPLIANCE*problem%c(i, i) .and. state%state(i) /= FROZEN
            if (may_change(i) .and. state%state(i) /= FREE) may_change(i) = abs(state%r(i)) &
                                                                            <= AT_REST*row_round_off(problem, state, i)
         end do
         call find_least_forces(rows, problem%weight, bounds, may_change, state, is_shared)
         if (any(is_shared)) call set_residual(problem, bounds%d, state)
      end subroutine take_least_forces

   end subroutine solve_box_proximal

end module atrito_proximal
