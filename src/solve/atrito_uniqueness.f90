!> How far a scene is from having more than one solution: an estimate of the contraction of the Picard map tau -> nu S_rho(p(tau)).
!>
!> Where all points of a set are closed and slip, the normal forces follow the tangential ones linearly, q_n = A q_t with
!> A = -C_nn^-1 C_nt (and what the rigid motions add). In the norm of L2 on the contact line no pattern of directions of slip makes
!> the map grow more than
!>
!>     sigma = | nu w^-1/2 A w^1/2 |_2
!>
!> and two solutions on this set need sigma >= 1. For one point it is nu |C_nt|/C_nn = nu |K_nt|/K_tt. The sets that are
!> looked at are all points, and those that are closed in the solution; others may be worse, hence an estimate. The
!> average S_rho, which does not enlarge this norm much, is left out.
module atrito_uniqueness
   use atrito_box_problem, only: box_problem_t, FREE
   use atrito_contact_line, only: contact_line_t
   use atrito_dense, only: factor_cholesky, solve_cholesky, eigen_symmetric, multiply_vector
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: estimate_contraction

   !> The linear map of a set of closed, slipping points, ready to be applied.
   type :: slip_map_t
      real(wp), allocatable :: factor(:, :)       !< Cholesky factor of C_nn + D, scaled
      real(wp), allocatable :: scale(:)           !< of its rows
      real(wp), allocatable :: coupling(:, :)     !< C_nt
      real(wp), allocatable :: y(:, :)            !< (C_nn + D)^-1 G_n
      real(wp), allocatable :: gt(:, :)           !< G_t
      real(wp), allocatable :: inverse(:, :)      !< of G_n' Y, on the motions that the set holds
      real(wp), allocatable :: left(:), right(:)  !< nu/sqrt(w), sqrt(w)
   end type slip_map_t

   real(wp), parameter :: NULL_MOTION = 1.0e-10_wp  !< part of a motion that the set does not hold
   integer, parameter :: MOST_STEPS = 40
   real(wp), parameter :: ENOUGH = 1.0e-3_wp

contains

   !> The estimate sigma; 0 without friction.
   function estimate_contraction(problem, line, compliance, state) result(sigma)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: compliance(:)       !< (m) D of the laws [L/F]
      integer(ip), intent(in) :: state(:)         !< (m) of the solution
      real(wp) :: sigma
      logical :: can_slip(problem%n_normal)
      integer(ip), allocatable :: all_points(:), closed(:)
      integer(ip) :: i

      can_slip = [(line%tangential(line%point(i)) > 0 .and. line%law(line%point(i))%nu > 0.0_wp, i=1, problem%n_normal)]
      sigma = 0.0_wp
      if (.not. any(can_slip)) return
      all_points = [(i, i=1, problem%n_normal)]
      closed = pack(all_points, state(:problem%n_normal) == FREE)
      sigma = contraction_of(problem, line, compliance, all_points, can_slip)
      if (size(closed) < size(all_points)) sigma = max(sigma, contraction_of(problem, line, compliance, closed, can_slip))
   end function estimate_contraction

   !> The estimate of one set of points.
   function contraction_of(problem, line, compliance, set, can_slip) result(sigma)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: compliance(:)
      integer(ip), intent(in) :: set(:)           !< normal unknowns
      logical, intent(in) :: can_slip(:)
      real(wp) :: sigma
      type(slip_map_t) :: map
      integer(ip), allocatable :: slipping(:)
      logical :: possible

      sigma = 0.0_wp
      slipping = pack(set, can_slip(set))
      if (size(slipping) == 0) return
      slipping = line%tangential(line%point(slipping))
      call build_map(problem, line, compliance, set, slipping, map, possible)
      if (possible) sigma = norm_of(map)
   end function contraction_of

   subroutine build_map(problem, line, compliance, set, slipping, map, possible)
      type(box_problem_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: compliance(:)
      integer(ip), intent(in) :: set(:), slipping(:) !< normal and tangential unknowns
      type(slip_map_t), intent(out) :: map
      logical, intent(out) :: possible
      integer(ip) :: i, n, failed

      n = size(set, kind=ip)
      map%factor = problem%c(set, set)
      do i = 1, n
         map%factor(i, i) = map%factor(i, i) + compliance(set(i))
      end do
      map%scale = [(1.0_wp/sqrt(map%factor(i, i)), i=1, n)]
      do i = 1, n
         map%factor(:, i) = map%factor(:, i)*map%scale*map%scale(i)
      end do
      call factor_cholesky(map%factor, failed)
      possible = failed == 0
      if (.not. possible) return
      map%coupling = problem%c(set, slipping)
      map%gt = problem%g(slipping, :)
      map%y = problem%g(set, :)
      do i = 1, problem%k
         map%y(:, i) = solved(map, map%y(:, i))
      end do
      map%left = [(line%law(line%point(set(i)))%nu/sqrt(problem%weight(set(i))), i=1, n)]
      map%right = sqrt(problem%weight(slipping))
      call invert_on_range(matmul(transpose(problem%g(set, :)), map%y), map%inverse)
   end subroutine build_map

   !> (C_nn + D)^-1 x
   function solved(map, x) result(y)
      type(slip_map_t), intent(in) :: map
      real(wp), intent(in) :: x(:)
      real(wp) :: y(size(x))

      y = x*map%scale
      call solve_cholesky(map%factor, y)
      y = y*map%scale
   end function solved

   !> The inverse of a symmetric matrix on its range, the pseudo-inverse.
   subroutine invert_on_range(a, inverse)
      real(wp), intent(in) :: a(:, :)
      real(wp), allocatable, intent(out) :: inverse(:, :)
      real(wp) :: vectors(size(a, 1), size(a, 1)), values(size(a, 1))
      integer(ip) :: info, i, j

      allocate (inverse, mold=a)
      inverse = 0.0_wp
      if (size(a) == 0) return
      vectors = 0.5_wp*(a + transpose(a))
      call eigen_symmetric(vectors, values, info)
      if (info /= 0) return
      do i = 1, size(values, kind=ip)
         if (values(i) <= NULL_MOTION*maxval(values)) cycle
         do j = 1, size(values, kind=ip)
            inverse(:, j) = inverse(:, j) + vectors(:, i)*(vectors(j, i)/values(i))
         end do
      end do
   end subroutine invert_on_range

   !> The largest singular value, by powers of L'L.
   function norm_of(map) result(sigma)
      type(slip_map_t), intent(in) :: map
      real(wp) :: sigma
      real(wp) :: v(size(map%right)), last
      integer :: step, i

      v = [(1.0_wp + 0.5_wp*sin(real(3*i, wp)), i=1, size(v))]   ! a part of every vector, as good as surely
      v = v/norm2(v)
      sigma = 0.0_wp
      do step = 1, MOST_STEPS
         v = backward(map, forward(map, v))
         last = sigma
         sigma = sqrt(norm2(v))
         if (sigma <= 0.0_wp) return
         v = v/norm2(v)
         if (abs(sigma - last) <= ENOUGH*sigma) return
      end do
   end function norm_of

   !> L v: q = -(C_nn + D)^-1 (C_nt t - G_n a), where G_n' q = -G_t' t gives a.
   function forward(map, v) result(z)
      type(slip_map_t), intent(in) :: map
      real(wp), intent(in) :: v(:)
      real(wp) :: z(size(map%left)), t(size(v)), x(size(map%left))

      t = map%right*v
      call multiply_vector(map%coupling, t, x)
      z = -solved(map, x) + matmul(map%y, matmul(map%inverse, matmul(transpose(map%y), x) - matmul(transpose(map%gt), t)))
      z = map%left*z
   end function forward

   !> L' z
   function backward(map, z) result(v)
      type(slip_map_t), intent(in) :: map
      real(wp), intent(in) :: z(:)
      real(wp) :: v(size(map%right)), x(size(z)), a(size(map%inverse, 1)), q(size(z))

      x = map%left*z
      a = matmul(map%inverse, matmul(transpose(map%y), x))
      q = -solved(map, x) + matmul(map%y, a)
      call multiply_vector(map%coupling, q, v, transa=.true.)
      v = map%right*(v - matmul(map%gt, a))
   end function backward

end module atrito_uniqueness
