!> The bound-constrained QP (atrito_bound_qp) where it is known which unknowns are free: one linear system.
!>
!> Let F be the free unknowns (normal forces of closed points, tangential ones of sticking points) and X the others, whose forces
!> q_X are known: 0 at an open point, +-w tau at a slipping one. With M = (C + D)_FF the conditions r_F = 0 and G' q = h are the
!> saddle point system
!>
!>     [  M     -G_F ] [ q_F ]   [  (g0 - C q_X)_F  ]
!>     [ -G_F'    0  ] [  a  ] = [ -(h - G_X' q_X)  ]
!>
!> 1. M is scaled to a unit diagonal and factored by Cholesky: rows of stiff and of soft bodies then count alike. M is positive
!>    definite, as the flexibility C = B F B' of condensed bodies is, unless rows of B depend on each other: a pivot that vanishes
!>    is a row that others make up, as where nodes of two pairs are one.
!> 2. q_F = M^-1 (rhs + G_F a) leaves S a = h - G_X' q_X - G_F' M^-1 rhs with the complement S = G_F' M^-1 G_F, a matrix of the
!>    size of the rigid motions, which is decomposed into its eigenvectors.
!> 3. An eigenvalue that vanishes belongs to a motion that the closed points do not hold. It takes no part in a. Where the load
!>    works on it there is no equilibrium with these states (outcome%moves), else it may be anything (outcome%undetermined).
!> 4. The residual of both equations is solved for once more with the same factors: what is left is round-off of the solution. 5. r
!> = g0 - (C + D) q + G a of all unknowns, the fixed ones too: its sign tells whether their states are right.
!>
!> The factor of an earlier solve whose free set differs by some unknowns serves again as the preconditioner of conjugate gradients
!> (atrito_dual_preconditioner), where that is cheaper than a new one.
!>
!> Cost: |F|^3/3 operations for a factor, 2 m^2 for each product with C and as many for each solve with the factor.
!>
!> Round-off. r_i is the difference of terms, so it is known to CLOSES times their sum (`row_round_off`), and a force to that over
!> C_ii + D_ii (`force_round_off`). The states of unknowns change by more than that alone (atrito_active_set).
module atrito_free_set
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_outcome_t, box_state_t, FREE, AT_LOWER, AT_UPPER, FROZEN, &
                              DEPENDENT_POINTS
   use atrito_kinds, only: ip, wp
   use atrito_dense, only: solve_cholesky
   use atrito_dense_blocks, only: multiply_symmetric
   use atrito_dual_preconditioner, only: complement_t, free_system_t, find_complement, refine_complement, &
                                         solve_with_kept, scaled_product
   use atrito_free_set_factor, only: free_set_factor_t, factor_free_set, is_worth_keeping
   use atrito_status, only: status_t, set_status, STATUS_SINGULAR
   implicit none (type, external)
   private
   public :: solve_free_set, put_at_bounds, set_residual, clear_vanishing, is_vanishing, row_round_off, bound_round_off, &
             force_round_off

   real(wp), parameter :: NULL_MOTION = 1.0e-12_wp  !< eigenvalue of a motion that the free set does not hold
   real(wp), parameter :: NO_LOAD = 1.0e-13_wp      !< part of the load in such a motion that is none
   real(wp), parameter :: LITTLE_LOAD = 1.0e-9_wp   !< that is none where nothing stops the motion
   real(wp), parameter :: CLOSES = 1.0e-14_wp       !< round-off of r, of the terms it is made of
   real(wp), parameter :: VANISHING = 1.0e-25_wp    !< of the force that would undo the displacements: refinement leaves it of 0

contains

   !> Solves for the free unknowns, the others fixed at state%q; sets state%q, a, r, slack. outcome%moves: no equilibrium, and a is
   !> the least motion that satisfies the rest. status: STATUS_SINGULAR when rows depend on each other (outcome%dependent).
   subroutine solve_free_set(problem, d, state, outcome, status, factor)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      real(wp), intent(in) :: d(:)               !< (m) [L/F]
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      type(box_outcome_t), intent(out) :: outcome !< solved is left to the caller, condition to condition_of
      type(status_t), intent(out) :: status       !< STATUS_SINGULAR with DEPENDENT_POINTS
      type(free_set_factor_t), intent(inout) :: factor !< of an earlier solve, which serves again where it can, or of this one
      type(free_system_t) :: system
      real(wp), allocatable :: held(:), q(:)
      logical :: solved

      ! the free unknowns as they are now are where an iteration with the factor of an earlier set begins
      call free_system(problem, d, state, held, system)
      q = state%q(system%set)/system%scale
      solved = .false.
      if (is_worth_keeping(size(q, kind=ip))) call solve_with_kept(factor, problem%c, system, q, state%a, solved)
      if (.not. solved) then
         call factor_free_set(problem%c, d, system%set, factor, outcome%dependent)
         if (outcome%dependent > 0) then
            call set_status(status, STATUS_SINGULAR, DEPENDENT_POINTS)
            return
         end if
         call solve_saddle(problem, factor%matrix, system, held, q, state%a, outcome)
      end if
      state%q(system%set) = q*system%scale
      call set_residual(problem, d, state)
   end subroutine solve_free_set

   !> The equations of the free unknowns, scaled to a unit diagonal of C + D.
   !>
   !> Row i of M is multiplied by s_i = 1/sqrt(M_ii), and q_i = s_i q~_i: M~ has the diagonal 1, and its condition is, but for a
   !> factor of its order, the least that any diagonal scaling gives (A. van der Sluis 1969).
   subroutine free_system(problem, d, state, held, system)
      type(bound_qp_t), intent(in) :: problem
      real(wp), intent(in) :: d(:)
      type(box_state_t), intent(in) :: state
      real(wp), allocatable, intent(out) :: held(:) !< (m) forces of the fixed unknowns
      type(free_system_t), intent(out) :: system
      real(wp) :: moved(problem%m)
      integer(ip) :: i

      system%set = pack([(i, i=1, problem%m)], state%state == FREE)
      held = state%q
      held(system%set) = 0.0_wp
      system%d = d(system%set)
      system%scale = [(1.0_wp/sqrt(problem%c(system%set(i), system%set(i)) + system%d(i)), i=1, size(system%set, kind=ip))]
      moved = 0.0_wp
      if (any(held /= 0.0_wp)) call multiply_symmetric(problem%c, held, moved)
      system%rhs = (problem%g0(system%set) - moved(system%set))*system%scale
      if (allocated(state%shift)) system%rhs = system%rhs + state%shift(system%set)*system%scale
      ! what the free forces have to balance: h - G_X' q_X
      system%load = problem%h - matmul(transpose(problem%g), held)
      system%g = problem%g(system%set, :)
      do i = 1, size(system%set, kind=ip)
         system%g(i, :) = system%g(i, :)*system%scale(i)
      end do
   end subroutine free_system

   !> [M -G; -G' 0] [q; a] = [rhs; -load] by the complement of M, with one refinement.
   !>
   !> Elimination of q: y = M^-1 G, S = G' y, x = M^-1 rhs, S a = load - G' x, q = x + y a. The refinement takes the residuals of
   !> both equations with the product M q as it is, not as its factor has it; the factor's own round-off, eps times the condition of
   !> M, is then squared. More would be round-off of q itself.
   subroutine solve_saddle(problem, factor, system, held, q, a, outcome)
      type(bound_qp_t), intent(in) :: problem
      real(wp), intent(in) :: factor(:, :)       !< of M
      type(free_system_t), intent(in) :: system
      real(wp), intent(in) :: held(:)            !< (m) forces of the fixed unknowns
      real(wp), intent(out) :: q(:)              !< scaled
      real(wp), intent(inout) :: a(:)
      type(box_outcome_t), intent(inout) :: outcome
      type(complement_t) :: complement
      real(wp), allocatable :: y(:, :), x(:), correction(:), da(:)

      associate (gs => system%g, rhs => system%rhs, load => system%load)
         ! the complement of the motions
         y = gs
         call solve_cholesky(factor, y)
         call find_complement(gs, y, complement)
         call refine_complement(gs, y, complement)
         ! the forces without motions, then the motions that make them balance
         x = rhs
         call solve_cholesky(factor, x)
         call solve_motions(complement, load - matmul(transpose(gs), x), a)
         q = x + matmul(y, a)
         ! one refinement: the residual of both equations with the same factors
         correction = rhs + matmul(gs, a) - scaled_product(problem%c, system, q)
         call solve_cholesky(factor, correction)
         allocate (da, mold=a)
         call solve_motions(complement, load - matmul(transpose(gs), q) - matmul(transpose(gs), correction), da)
         q = q + correction + matmul(y, da)
         a = a + da
         call judge_motions()
      end associate

   contains

      !> Whether the load works on a motion that the free set does not hold: then outcome%moves. The load is measured by the forces
      !> of the solution on the bodies that move, and by what was cancelled in it; those before the bodies have moved to where they
      !> touch may be larger by any factor, and say nothing.
      !>
      !> v is a null vector of S in the amplitudes of the motions. Its work h'v - q_X'G v is that of the loads and of the fixed
      !> forces; free ones have no part, as G_F v = 0. hardly: it is LITTLE_LOAD of its terms, and a body that nothing stops may as
      !> well rest.
      subroutine judge_motions()
         real(wp) :: all_q(problem%m), none(problem%m), work(problem%k), size_of_work(problem%k), motion(problem%k), way(problem%k)
         real(wp) :: part, size_of_part, round_off
         integer(ip) :: j

         ! the usual case: the closed and sticking points hold all bodies
         if (all(complement%values > NULL_MOTION)) return
         outcome%hardly = .true.
         all_q = held
         all_q(system%set) = q*system%scale
         none = min(abs(all_q), VANISHING*forces_of_places(problem, system, a))
         work = problem%h - matmul(transpose(problem%g), all_q)
         size_of_work = size_of_load(problem) + matmul(transpose(abs(problem%g)), abs(all_q))
         motion = 0.0_wp
         do j = 1, problem%k
            if (complement%values(j) > NULL_MOTION) cycle
            way = complement%vectors(:, j)*complement%scale
            part = dot_product(way, work)
            size_of_part = dot_product(abs(way), size_of_work)
            round_off = dot_product(abs(matmul(problem%g, way)), none)
            ! the work h'v - q'G v of all forces on the motion, beside the sum of its terms without sign
            if (abs(part) > NO_LOAD*size_of_part + round_off) then
               motion = motion + complement%vectors(:, j)*part
               outcome%hardly = outcome%hardly .and. abs(part) <= LITTLE_LOAD*size_of_part + round_off
            else
               outcome%undetermined = way
            end if
         end do
         if (all(motion == 0.0_wp)) return
         outcome%moves = .true.
         outcome%motion = motion*complement%scale
      end subroutine judge_motions

   end subroutine solve_saddle

   !> a from G' M^-1 G a = force; a motion that the free set does not hold takes no part.
   !>
   !> By the eigenvectors V of the scaled S: a = V diag(1/lambda) V' force over the eigenvalues that are not null, the least of all
   !> a that solve it.
   subroutine solve_motions(complement, force, a)
      type(complement_t), intent(in) :: complement
      real(wp), intent(in) :: force(:)
      real(wp), intent(out) :: a(:)
      integer(ip) :: j

      a = 0.0_wp
      do j = 1, size(complement%values, kind=ip)
         if (complement%values(j) <= NULL_MOTION) cycle
         a = a + complement%vectors(:, j)*(dot_product(complement%vectors(:, j), force*complement%scale)/complement%values(j))
      end do
      a = a*complement%scale
   end subroutine solve_motions

   !> The work of all loads on each motion without sign [F]: what round-off of h is measured by.
   pure function size_of_load(problem)
      type(bound_qp_t), intent(in) :: problem
      real(wp) :: size_of_load(problem%k)

      size_of_load = abs(problem%h)
      if (allocated(problem%h_size)) size_of_load = problem%h_size
   end function size_of_load

   !> The force [F] that each unknown alone would need to undo what its displacement is made of.
   !>
   !> |g0_i| + |(G a)_i| over C_ii + D_i: displacements that are large beside the elastic ones leave that round-off in forces.
   pure function forces_of_places(problem, system, a) result(force)
      type(bound_qp_t), intent(in) :: problem
      type(free_system_t), intent(in) :: system
      real(wp), intent(in) :: a(:)
      real(wp) :: force(problem%m)
      integer(ip) :: i

      force = abs(problem%g0) + abs(matmul(problem%g, a))
      do i = 1, problem%m
         force(i) = force(i)/yield_of(problem, 0.0_wp, i)
      end do
      force(system%set) = (abs(problem%g0(system%set)) + abs(matmul(problem%g(system%set, :), a)))*system%scale**2
   end function forces_of_places

   !> Sets r = g0 - (C + D) q + G a and its round-off.
   !>
   !> r is the gap of an open point (with the sign of an overlap), the slip against the friction of a slipping one, and zero but for
   !> round-off where the unknown is free. One product with C.
   subroutine set_residual(problem, d, state)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      real(wp), intent(in) :: d(:)            !< (m) compliance D of the unknowns [L/F]
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      real(wp) :: cq(problem%m), moved(problem%m)

      call multiply_symmetric(problem%c, state%q, cq)
      moved = matmul(problem%g, state%a)
      state%r = problem%g0 - cq - d*state%q + moved
      if (allocated(state%shift)) state%r = state%r + state%shift
      state%slack = CLOSES*(largest(problem%g0) + largest(cq) + largest(moved))
   end subroutine set_residual

   !> Round-off of one r, of the terms that it is made of [L]: a fixed unknown is released when r is wrong by more. Rows of stiff
   !> bodies beside soft ones have far less of it than state%slack.
   pure real(wp) function row_round_off(problem, state, i) result(slack)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(box_state_t), intent(in) :: state !< states of the m unknowns, q, a, r
      integer(ip), intent(in) :: i           !< unknown, 1 to m
      integer(ip) :: j

      if (problem%is_coarse) then
         slack = state%slack
         return
      end if
      slack = abs(problem%g0(i))
      if (allocated(state%shift)) slack = slack + abs(state%shift(i))
      do j = 1, problem%k
         slack = slack + abs(problem%g(i, j)*state%a(j))
      end do
      do j = 1, problem%m
         slack = slack + abs(problem%c(j, i)*state%q(j))
      end do
      slack = CLOSES*slack
   end function row_round_off

   !> How far r of an unknown at its bound may have the wrong sign [L]: by round-off of its row, and where a point rests that has
   !> slid, by slips that are none. There r = 0, and what the last digits of the bound make of it must not turn the shear.
   pure real(wp) function bound_round_off(problem, state, i) result(slack)
      type(bound_qp_t), intent(in) :: problem
      type(box_state_t), intent(in) :: state
      integer(ip), intent(in) :: i

      slack = row_round_off(problem, state, i)
      if (allocated(problem%slip_noise)) slack = max(slack, problem%slip_noise(i))
   end function bound_round_off

   !> Round-off of a row as a force [F].
   pure real(wp) function force_round_off(problem, d, state, i) result(force)
      type(bound_qp_t), intent(in) :: problem
      real(wp), intent(in) :: d(:)               !< (m) [L/F]
      type(box_state_t), intent(in) :: state
      integer(ip), intent(in) :: i

      force = row_round_off(problem, state, i)/yield_of(problem, d(i), i)
   end function force_round_off

   !> What a force moves its row by, with the compliance of its law; where that is nothing, as between rigid surfaces, by as much as
   !> the softest row, so that a force there is no less than others.
   !>
   !> C_ii + D_i, the displacement per force of the point along itself [L/F]: what turns round-off of r into round-off of a force.
   pure real(wp) function yield_of(problem, d, i) result(yields)
      type(bound_qp_t), intent(in) :: problem
      real(wp), intent(in) :: d                  !< of the row [L/F]
      integer(ip), intent(in) :: i
      integer(ip) :: j

      yields = problem%c(i, i) + d
      if (yields > 0.0_wp) return
      yields = maxval([(problem%c(j, j), j=1, problem%m)])
      if (.not. yields > 0.0_wp) yields = 1.0_wp
   end function yield_of

   !> Forces that are what refinement leaves of none become none.
   pure subroutine clear_vanishing(problem, d, state)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      real(wp), intent(in) :: d(:)               !< (m) [L/F]
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      integer(ip) :: i

      do i = 1, problem%m
         if (is_vanishing(problem, d, state, i)) state%q(i) = 0.0_wp
      end do
   end subroutine clear_vanishing

   !> Whether a force is what refinement leaves of none.
   !>
   !> A solve leaves round-off of a force that is none, its refinement the square of that.
   pure logical function is_vanishing(problem, d, state, i)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      real(wp), intent(in) :: d(:)               !< (m) [L/F]
      type(box_state_t), intent(in) :: state !< states of the m unknowns, q, a, r
      integer(ip), intent(in) :: i           !< unknown, 1 to m

      ! a place may be met exactly by a force that is none
      is_vanishing = abs(state%q(i))*yield_of(problem, d(i), i) <= VANISHING*(state%slack/CLOSES)
   end function is_vanishing

   pure real(wp) function largest(x)
      real(wp), intent(in) :: x(:)

      largest = 0.0_wp
      if (size(x) > 0) largest = maxval(abs(x))
   end function largest

   !> Fixed unknowns take the values of their bounds.
   !>
   !> So the forces q_X of a solve are those of the states, whatever they were before.
   pure subroutine put_at_bounds(bounds, state)
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r

      where (state%state == AT_LOWER) state%q = bounds%lower
      where (state%state == AT_UPPER) state%q = bounds%upper
      where (state%state == FROZEN) state%q = 0.0_wp
   end subroutine put_at_bounds

end module atrito_free_set
