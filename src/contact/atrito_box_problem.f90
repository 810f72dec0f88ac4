!> The contact problem in the contact forces, friction bounds frozen: a convex quadratic problem with bounds.
!>
!> Unknowns are the forces q_i at the points (normal: q = w p, tangential: q = w t) and the amplitudes a of the rigid motions:
!>
!>     r = g0 - (C + D) q + G a,       G' q = h
!>     free   lower <= q <= upper and r = 0      (closed, sticking)
!>     fixed  q = lower and r <= 0, or q = upper and r >= 0      (open, slipping)
!>
!> C is the flexibility of the bodies seen from the points, D the compliances of the laws (delta/w, eps/(w tau)), G the rigid
!> motions at the points, h the loads' work on them (docs/theory/formulation.md, section 4).
module atrito_box_problem
   use atrito_kinds, only: ip, wp
   use atrito_dense, only: factor_cholesky, solve_cholesky, eigen_symmetric, multiply_vector, norm_one, estimate_condition
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   implicit none (type, external)
   private
   public :: box_problem_t, box_bounds_t, box_state_t, equality_solution_t, solve_free_set, residual, closing_slack
   public :: FREE, AT_LOWER, AT_UPPER, FROZEN, DEPENDENT_POINTS

   !> State of an unknown. FROZEN: q = 0 whatever r is (a point without friction).
   integer(ip), parameter :: FREE = 0, AT_LOWER = 1, AT_UPPER = 2, FROZEN = 3

   type :: box_problem_t
      integer(ip) :: m = 0                       !< unknown forces
      integer(ip) :: k = 0                       !< rigid motions
      integer(ip) :: n_normal = 0                !< the first ones are normal
      real(wp), allocatable :: c(:, :)           !< (m, m) [L/F]
      real(wp), allocatable :: g(:, :)           !< (m, k) dimensionless
      real(wp), allocatable :: g0(:)             !< (m) [L]
      real(wp), allocatable :: h(:)              !< (k) [F]
      real(wp), allocatable :: weight(:)         !< (m) weight of the point [L^2]: stress = q / weight
   end type box_problem_t

   type :: box_bounds_t
      real(wp), allocatable :: lower(:), upper(:) !< (m) [F]; upper may be huge
      real(wp), allocatable :: d(:)              !< (m) [L/F]
   end type box_bounds_t

   type :: box_state_t
      integer(ip), allocatable :: state(:)       !< (m)
      real(wp), allocatable :: q(:)              !< (m) [F]
      real(wp), allocatable :: a(:)              !< (k) [L]
      real(wp), allocatable :: r(:)              !< (m) [L]
   end type box_state_t

   !> What a solve with a given set of free unknowns found besides q, a, r.
   type :: equality_solution_t
      logical :: moves = .false.                 !< the free set does not hold a motion that the load works on
      real(wp), allocatable :: motion(:)         !< (k) that motion, in the direction of the load
      real(wp), allocatable :: idle(:)           !< (k) a motion that neither the free set nor the load touches; else not allocated
      real(wp) :: condition = 1.0_wp             !< of the scaled matrix of the free set
      integer(ip) :: dependent = 0               !< an unknown whose row depends on others; 0: none
   end type equality_solution_t

   real(wp), parameter :: NULL_MOTION = 1.0e-12_wp  !< eigenvalue of a motion that the free set does not hold
   real(wp), parameter :: NO_LOAD = 1.0e-9_wp       !< part of the load in such a motion that is none
   real(wp), parameter :: LEAST_PIVOT = 1.0e-13_wp  !< scaled; below it points depend on each other
   character(len=*), parameter :: DEPENDENT_POINTS = 'dependent contact points'

contains

   !> Solves for the free unknowns, the others fixed at state%q; sets state%q, a, r. solution%moves: no equilibrium, and a is the
   !> least motion that satisfies the rest. status: STATUS_SINGULAR when rows depend on each other (solution%dependent).
   subroutine solve_free_set(problem, d, state, solution, status)
      type(box_problem_t), intent(in) :: problem
      real(wp), intent(in) :: d(:)               !< (m) [L/F]
      type(box_state_t), intent(inout) :: state
      type(equality_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      integer(ip), allocatable :: free_set(:)
      real(wp), allocatable :: m(:, :), scale(:), gs(:, :), rhs(:), held(:), load(:), q(:)
      integer(ip) :: i, n

      free_set = pack([(i, i=1, problem%m)], state%state == FREE)
      n = size(free_set, kind=ip)
      held = state%q
      held(free_set) = 0.0_wp
      rhs = problem%g0(free_set) - matmul(problem%c(free_set, :), held)
      load = problem%h - matmul(transpose(problem%g), held)
      allocate (m(n, n), scale(n), q(n))
      call scaled_matrix(problem%c, d, free_set, m, scale)
      gs = problem%g(free_set, :)
      do i = 1, n
         gs(i, :) = gs(i, :)*scale(i)
      end do
      call factor_scaled(m, free_set, solution, status)
      if (.not. is_ok(status)) return
      call solve_saddle(problem, d, free_set, m, scale, gs, rhs*scale, load, held, q, state%a, solution)
      state%q(free_set) = q*scale
      state%r = residual(problem, d, state)
   end subroutine solve_free_set

   !> The matrix C + D of the free set, scaled to a unit diagonal.
   pure subroutine scaled_matrix(c, d, free_set, m, scale)
      real(wp), intent(in) :: c(:, :), d(:)
      integer(ip), intent(in) :: free_set(:)
      real(wp), intent(out) :: m(:, :), scale(:)
      integer(ip) :: i, j

      do i = 1, size(free_set, kind=ip)
         scale(i) = 1.0_wp/sqrt(c(free_set(i), free_set(i)) + d(free_set(i)))
      end do
      do j = 1, size(free_set, kind=ip)
         do i = 1, size(free_set, kind=ip)
            m(i, j) = c(free_set(i), free_set(j))*scale(i)*scale(j)
         end do
         m(j, j) = 1.0_wp
      end do
   end subroutine scaled_matrix

   subroutine factor_scaled(m, free_set, solution, status)
      real(wp), intent(inout) :: m(:, :)
      integer(ip), intent(in) :: free_set(:)
      type(equality_solution_t), intent(inout) :: solution
      type(status_t), intent(out) :: status
      real(wp) :: norm
      integer(ip) :: failed, i

      norm = norm_one(m)
      call factor_cholesky(m, failed)
      if (failed == 0) then
         do i = 1, size(free_set, kind=ip)
            if (m(i, i)**2 < LEAST_PIVOT) failed = i
         end do
      end if
      if (failed > 0) then
         solution%dependent = free_set(failed)
         call set_status(status, STATUS_SINGULAR, DEPENDENT_POINTS)
         return
      end if
      solution%condition = estimate_condition(m, norm)
   end subroutine factor_scaled

   !> [M -G; -G' 0] [q; a] = [rhs; -load] by the complement of M, with one refinement.
   subroutine solve_saddle(problem, d, free_set, factor, scale, gs, rhs, load, held, q, a, solution)
      type(box_problem_t), intent(in) :: problem
      real(wp), intent(in) :: d(:)
      integer(ip), intent(in) :: free_set(:)
      real(wp), intent(in) :: factor(:, :), scale(:), gs(:, :), rhs(:), load(:), held(:)
      real(wp), intent(out) :: q(:)              !< scaled
      real(wp), intent(inout) :: a(:)
      type(equality_solution_t), intent(inout) :: solution
      real(wp), allocatable :: y(:, :), values(:), vectors(:, :), column_scale(:), x(:), correction(:), da(:)

      y = gs
      call solve_cholesky(factor, y)
      call complement_modes(gs, y, vectors, values, column_scale)
      x = rhs
      call solve_cholesky(factor, x)
      call solve_motions(vectors, values, column_scale, load - matmul(transpose(gs), x), a)
      q = x + matmul(y, a)
      ! one refinement: the residual of both equations with the same factors
      correction = rhs + matmul(gs, a) - scaled_product(problem%c, d, free_set, scale, q)
      call solve_cholesky(factor, correction)
      allocate (da, mold=a)
      call solve_motions(vectors, values, column_scale, load - matmul(transpose(gs), q) - matmul(transpose(gs), correction), da)
      q = q + correction + matmul(y, da)
      a = a + da
      call judge_motions(problem, vectors, values, column_scale, gs, load, held, q, solution)
   end subroutine solve_saddle

   !> (C + D) q of the free set in scaled form.
   function scaled_product(c, d, free_set, scale, q) result(product)
      real(wp), intent(in) :: c(:, :), d(:), scale(:), q(:)
      integer(ip), intent(in) :: free_set(:)
      real(wp) :: product(size(q))
      real(wp), allocatable :: force(:), moved(:)

      allocate (force(size(c, 1)), source=0.0_wp)
      allocate (moved(size(c, 1)))
      force(free_set) = q*scale
      call multiply_vector(c, force, moved)
      product = (moved(free_set) + d(free_set)*force(free_set))*scale
   end function scaled_product

   !> Eigenvectors and eigenvalues of G' M^-1 G, scaled to a unit diagonal: how firmly the free set holds each motion.
   subroutine complement_modes(gs, y, vectors, values, column_scale)
      real(wp), intent(in) :: gs(:, :), y(:, :)
      real(wp), allocatable, intent(out) :: vectors(:, :), values(:), column_scale(:)
      integer(ip) :: i, j, k, info

      k = size(gs, 2, kind=ip)
      vectors = matmul(transpose(gs), y)
      vectors = 0.5_wp*(vectors + transpose(vectors))
      allocate (column_scale(k), values(k))
      do j = 1, k
         column_scale(j) = 1.0_wp
         if (vectors(j, j) > 0.0_wp) column_scale(j) = 1.0_wp/sqrt(vectors(j, j))
      end do
      do j = 1, k
         do i = 1, k
            vectors(i, j) = vectors(i, j)*column_scale(i)*column_scale(j)
         end do
      end do
      call eigen_symmetric(vectors, values, info)
   end subroutine complement_modes

   !> a from G' M^-1 G a = force; a motion that the free set does not hold takes no part.
   subroutine solve_motions(vectors, values, column_scale, force, a)
      real(wp), intent(in) :: vectors(:, :), values(:), column_scale(:), force(:)
      real(wp), intent(out) :: a(:)
      integer(ip) :: j

      a = 0.0_wp
      do j = 1, size(values, kind=ip)
         if (values(j) <= NULL_MOTION) cycle
         a = a + vectors(:, j)*(dot_product(vectors(:, j), force*column_scale)/values(j))
      end do
      a = a*column_scale
   end subroutine solve_motions

   !> Whether the load works on a motion that the free set does not hold: then solution%moves. The load is measured by the forces of
   !> the solution; those before the bodies have moved to where they touch may be larger by any factor, and say nothing.
   subroutine judge_motions(problem, vectors, values, column_scale, gs, load, held, q, solution)
      type(box_problem_t), intent(in) :: problem
      real(wp), intent(in) :: vectors(:, :), values(:), column_scale(:), gs(:, :), load(:), held(:)
      real(wp), intent(in) :: q(:)               !< scaled, of the free set
      type(equality_solution_t), intent(inout) :: solution
      real(wp) :: force(problem%k), size_of_load, part, motion(problem%k)
      integer(ip) :: j

      if (all(values > NULL_MOTION)) return
      force = (load - matmul(transpose(gs), q))*column_scale
      size_of_load = maxval([(sum(abs(problem%g(:, j)*held)) + sum(abs(gs(:, j)*q)) + abs(problem%h(j)), j=1, problem%k)])
      motion = 0.0_wp
      do j = 1, problem%k
         if (values(j) > NULL_MOTION) cycle
         part = dot_product(vectors(:, j), force)
         if (abs(part)/maxval(abs(vectors(:, j)*column_scale)) > NO_LOAD*size_of_load) then
            motion = motion + vectors(:, j)*part
         else
            solution%idle = vectors(:, j)*column_scale
         end if
      end do
      if (all(motion == 0.0_wp)) return
      solution%moves = .true.
      solution%motion = motion*column_scale
   end subroutine judge_motions

   !> r = g0 - (C + D) q + G a.
   function residual(problem, d, state) result(r)
      type(box_problem_t), intent(in) :: problem
      real(wp), intent(in) :: d(:)
      type(box_state_t), intent(in) :: state
      real(wp) :: r(problem%m)

      call multiply_vector(problem%c, state%q, r)
      r = problem%g0 - r - d*state%q + matmul(problem%g, state%a)
   end function residual

   !> Round-off of r: a fixed unknown is released when r breaks its sign by more than this.
   function closing_slack(problem, state) result(slack)
      type(box_problem_t), intent(in) :: problem
      type(box_state_t), intent(in) :: state
      real(wp) :: slack
      real(wp) :: cq(problem%m)

      call multiply_vector(problem%c, state%q, cq)
      slack = 1.0e-14_wp*(largest(problem%g0) + largest(cq) + largest(matmul(problem%g, state%a)))
   end function closing_slack

   pure real(wp) function largest(x)
      real(wp), intent(in) :: x(:)

      largest = 0.0_wp
      if (size(x) > 0) largest = maxval(abs(x))
   end function largest

end module atrito_box_problem
