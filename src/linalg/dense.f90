!> Dense linear algebra: the one wrapper of LAPACK and BLAS for full matrices.
!>
!> All of it works at order 0. Tolerances are relative to the largest singular value, so that nothing depends on units. `info`
!> is LAPACK's: 0 is success; a factorisation that meets an exactly zero pivot, or an iteration for eigen- or singular values
!> that does not converge, returns something else; so does an infinity or NaN in the data of a decomposition, which LAPACK would
!> answer with a line on standard output, or even with the end of the program (xerbla).
!>
!> What to take for which matrix:
!>
!>     positive definite                      factor_in_blocks (atrito_dense_blocks), solve_cholesky      n^3/3 operations
!>     square and regular                     solve_lu                                                    2 n^3/3
!>     of unknown rank, or not square         orthonormalise, null_space, least_squares                   some 10 to 20 n^3
!>     symmetric, all of its modes            eigen_symmetric                                             about 9 n^3
module atrito_dense
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_halting, only: halting_t, suspend_halting, restore_halting
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_lapack, only: dgemm, dgemv, dgesv, dgesvd, dgelsd, dpocon, dpotrs, dsyev, dsyrk
   implicit none (type, external)
   private
   public :: solve_cholesky, estimate_condition, solve_lu, sign_of_determinant, eigen_symmetric
   public :: orthonormalise, add_product, add_square, transposed_product, multiply_vector, multiply_transposed
   public :: null_space, least_squares

   integer(ip), parameter :: NOT_FINITE = -99             !< an info that is none of LAPACK's
   real(wp), parameter :: ROUNDED_PIVOT = 1.0e-12_wp      !< over the largest: its sign may be rounding

   !> b <- A^-1 b with the lower triangle of A = L L' (dpotrf); b of rank 1 or 2.
   interface solve_cholesky
      module procedure solve_cholesky_one, solve_cholesky_many
   end interface solve_cholesky

   !> b <- A^-1 b by LU; b of rank 1 or 2.
   interface solve_lu
      module procedure solve_lu_one, solve_lu_many
   end interface solve_lu

contains

   !> Forward and backward substitution, L y = b and L'x = y, with all columns of b at a time: 2 n^2 operations each.
   subroutine solve_cholesky_many(a, b)
      real(wp), intent(in), contiguous :: a(:, :)        !< (n, n) factor, lower triangle
      real(wp), intent(inout), contiguous :: b(:, :)     !< (n, loads)
      type(halting_t) :: halting
      integer(ip) :: ignored

      call suspend_halting(halting)
      call dpotrs('L', order(a), size(b, 2, kind=ip), a, leading(a), b, leading(b), ignored)
      call restore_halting(halting)
   end subroutine solve_cholesky_many

   !> The same of one column.
   subroutine solve_cholesky_one(a, b)
      real(wp), intent(in), contiguous :: a(:, :)        !< (n, n) factor, lower triangle
      real(wp), intent(inout), contiguous :: b(:)        !< (n)
      type(halting_t) :: halting
      integer(ip) :: ignored

      call suspend_halting(halting)
      call dpotrs('L', order(a), 1_ip, a, leading(a), b, leading(a), ignored)
      call restore_halting(halting)
   end subroutine solve_cholesky_one

   !> Estimate of the condition number |A| |A^-1| in the 1-norm, >= 1 (dpocon); 1 at order 0.
   !>
   !> |A| has to be known from before the factorisation. |A^-1| is estimated by a few solutions with the factor (Hager's method in
   !> Higham's form): they go uphill on the convex function |A^-1 x| over |x| = 1, whose maximum is at a unit vector. The estimate
   !> is a lower bound, seldom off by more than a factor of three.
   real(wp) function estimate_condition(a_factor, norm1) result(condition)
      real(wp), intent(in), contiguous :: a_factor(:, :) !< (n, n) factor, lower triangle
      real(wp), intent(in) :: norm1                      !< largest column sum of the matrix before
      type(halting_t) :: halting
      real(wp) :: reciprocal, work(3*size(a_factor, 2))
      integer(ip) :: ignored, iwork(size(a_factor, 2))

      call suspend_halting(halting)
      call dpocon('L', order(a_factor), a_factor, leading(a_factor), norm1, reciprocal, work, iwork, ignored)
      call restore_halting(halting)
      condition = HUGE_REAL
      if (reciprocal > 1.0_wp/HUGE_REAL) condition = max(1.0_wp/reciprocal, 1.0_wp)
   end function estimate_condition

   !> P A = L U with the largest pivot of each column, then two substitutions: for matrices that are not positive definite.
   subroutine solve_lu_many(a, b, info)
      real(wp), intent(inout), contiguous :: a(:, :)     !< (n, n); destroyed
      real(wp), intent(inout), contiguous :: b(:, :)     !< (n, loads)
      integer(ip), intent(out) :: info                   !< > 0: the pivot of this row is exactly zero
      type(halting_t) :: halting
      integer(ip) :: pivots(size(a, 2))

      call suspend_halting(halting)
      call dgesv(order(a), size(b, 2, kind=ip), a, leading(a), pivots, b, leading(b), info)
      call restore_halting(halting)
   end subroutine solve_lu_many

   !> The same of one column.
   subroutine solve_lu_one(a, b, info)
      real(wp), intent(inout), contiguous :: a(:, :)     !< (n, n); destroyed
      real(wp), intent(inout), contiguous :: b(:)        !< (n)
      integer(ip), intent(out) :: info                   !< > 0: the pivot of this row is exactly zero
      type(halting_t) :: halting
      integer(ip) :: pivots(size(a, 2))

      call suspend_halting(halting)
      call dgesv(order(a), 1_ip, a, leading(a), pivots, b, leading(a), info)
      call restore_halting(halting)
   end subroutine solve_lu_one

   !> The sign of det A: of the pivots of P A = L U and of the exchanges of rows; 0 where a pivot is as small beside the largest as
   !> rounding of the others makes it. 1 at order 0.
   integer(ip) function sign_of_determinant(a) result(sign_of)
      real(wp), intent(inout), contiguous :: a(:, :)     !< (n, n), rows and columns of like size; destroyed
      type(halting_t) :: halting
      real(wp) :: no_load(size(a, 2)), least
      integer(ip) :: pivots(size(a, 2)), info, i

      sign_of = 1
      if (size(a) == 0) return
      no_load = 0.0_wp
      call suspend_halting(halting)
      call dgesv(order(a), 1_ip, a, leading(a), pivots, no_load, leading(a), info)
      call restore_halting(halting)
      least = ROUNDED_PIVOT*maxval([(abs(a(i, i)), i=1, size(a, 2))])
      do i = 1, size(a, 2, kind=ip)
         if (.not. abs(a(i, i)) > least) then
            sign_of = 0
            return
         end if
         if (a(i, i) < 0.0_wp .neqv. pivots(i) /= i) sign_of = -sign_of
      end do
   end function sign_of_determinant

   !> All eigenvalues, ascending, and orthonormal eigenvectors of a symmetric matrix: A = V diag(values) V' (dsyev). Reflections
   !> bring A to three diagonals, rotations (QR) these to one. Each value is found to within rounding of the largest one, so small
   !> ones have few digits of their own. LAPACK is asked first how much memory it wants.
   subroutine eigen_symmetric(a, values, info)
      real(wp), intent(inout), contiguous :: a(:, :)     !< (n, n) lower triangle; the vectors, by columns, on return
      real(wp), intent(out), contiguous :: values(:)     !< (n)
      integer(ip), intent(out) :: info                   !< 0, or LAPACK's: some values did not converge
      real(wp), allocatable :: work(:)
      real(wp) :: wanted(1)
      type(halting_t) :: halting

      call suspend_halting(halting)
      call dsyev('V', 'L', order(a), a, leading(a), values, wanted, -1_ip, info)
      allocate (work(max(int(wanted(1)), 1)))
      call dsyev('V', 'L', order(a), a, leading(a), values, work, size(work, kind=ip), info)
      call restore_halting(halting)
   end subroutine eigen_symmetric

   !> An orthonormal basis of the space of the columns (dgesvd): of A = U S V' the columns of U whose singular values are not zero.
   !> The largest singular value is the measure, so that rounding errors of the columns do not count as directions of their own.
   subroutine orthonormalise(a, rank, tol, info)
      real(wp), intent(inout), contiguous :: a(:, :)     !< (m, n); on return the basis is a(:, :rank)
      integer(ip), intent(out) :: rank                   !< 0..min(m, n)
      real(wp), intent(in) :: tol                        !< singular values below tol times the largest count as zero
      integer(ip), intent(out) :: info                   !< 0, or why there is no basis (head of the module)
      real(wp) :: values(min(size(a, 1), size(a, 2))), vectors(1, 1)

      call decompose('O', 'N', a, values, vectors, info)
      rank = count_rank(values, tol)
   end subroutine orthonormalise

   !> An orthonormal basis of the right null space: A z = 0 (dgesvd). Of A = U S V' it is the rows of V' whose singular values are
   !> zero, those beyond min(m, n) among them; of a matrix without rows all there is.
   subroutine null_space(a, tol, z, info)
      real(wp), intent(in) :: a(:, :)                    !< (m, n)
      real(wp), intent(in) :: tol                        !< singular values below tol times the largest count as zero
      real(wp), allocatable, intent(out) :: z(:, :)      !< (n, n - rank)
      integer(ip), intent(out) :: info                   !< 0, or why there is no basis (head of the module)
      real(wp) :: copy(size(a, 1), size(a, 2)), values(min(size(a, 1), size(a, 2)))
      real(wp) :: vectors(size(a, 2), size(a, 2))
      integer(ip) :: i

      copy = a
      vectors = 0.0_wp
      do i = 1, size(a, 2, kind=ip)
         vectors(i, i) = 1.0_wp     ! all there is without rows: LAPACK returns at once
      end do
      call decompose('N', 'A', copy, values, vectors, info)
      z = transpose(vectors(count_rank(values, tol) + 1:, :))
   end subroutine null_space

   !> Singular values above tol times the largest; a zero matrix has none. A perturbation E changes no singular value by more than
   !> |E| (Weyl), so with tol above the rounding of A what is below it may be zero, and what is above it is not.
   pure integer(ip) function count_rank(values, tol) result(rank)
      real(wp), intent(in) :: values(:), tol !< falling; share of the largest below which one is zero

      rank = 0
      if (size(values) > 0) rank = count(values > tol*values(1), kind=ip)
   end function count_rank

   !> A = U S V' by dgesvd: S has the singular values on its diagonal, falling; U and V are orthonormal. Left vectors, where wanted,
   !> replace a.
   subroutine decompose(jobu, jobvt, a, values, vectors, info)
      character(len=1), intent(in) :: jobu, jobvt
      real(wp), intent(inout), contiguous :: a(:, :)
      real(wp), intent(out), contiguous :: values(:)
      real(wp), intent(inout), contiguous :: vectors(:, :)
      integer(ip), intent(out) :: info
      real(wp), allocatable :: work(:)
      real(wp) :: wanted(1), no_vectors(1, 1)
      type(halting_t) :: halting
      integer(ip) :: m, n

      info = 0
      m = size(a, 1, kind=ip)
      n = size(a, 2, kind=ip)
      if (min(m, n) == 0) return
      if (.not. all(ieee_is_finite(a))) then
         values = 0.0_wp
         info = NOT_FINITE
         return
      end if
      call suspend_halting(halting)
      call dgesvd(jobu, jobvt, m, n, a, m, values, no_vectors, 1_ip, vectors, leading(vectors), wanted, -1_ip, info)
      allocate (work(max(int(wanted(1)), 1)))
      call dgesvd(jobu, jobvt, m, n, a, m, values, no_vectors, 1_ip, vectors, leading(vectors), work, &
                  size(work, kind=ip), info)
      call restore_halting(halting)
   end subroutine decompose

   !> The shortest of all x that minimise |A x - b| (dgelsd): x = V S^+ U'b, where S^+ has 1/s for the singular values s that count
   !> and 0 for the others. So it is the one answer also where A has too few independent rows or columns, and a small change of A
   !> that does not change the rank changes it by little.
   subroutine least_squares(a, b, x, tol, rank, info)
      real(wp), intent(in) :: a(:, :)                    !< (m, n)
      real(wp), intent(in) :: b(:)                       !< (m)
      real(wp), intent(out) :: x(:)                      !< (n)
      real(wp), intent(in) :: tol                        !< singular values below tol times the largest count as zero
      integer(ip), intent(out) :: rank                   !< 0..min(m, n)
      integer(ip), intent(out) :: info                   !< 0, or why there is no answer (head of the module)
      real(wp) :: copy(size(a, 1), size(a, 2)), both(max(size(a, 1), size(a, 2), 1)), values(size(x))
      real(wp), allocatable :: work(:)
      integer(ip), allocatable :: iwork(:)
      real(wp) :: wanted(1)
      integer(ip) :: wanted_integers(1), m, n
      type(halting_t) :: halting

      m = size(a, 1, kind=ip)
      n = size(a, 2, kind=ip)
      copy = a
      both = 0.0_wp
      both(:m) = b
      rank = 0
      info = 0
      if (min(m, n) > 0 .and. .not. (all(ieee_is_finite(a)) .and. all(ieee_is_finite(b)))) info = NOT_FINITE
      if (min(m, n) > 0 .and. info == 0) then
         call suspend_halting(halting)
         call dgelsd(m, n, 1_ip, copy, m, both, size(both, kind=ip), values, tol, rank, wanted, -1_ip, wanted_integers, info)
         allocate (work(max(int(wanted(1)), 1)), iwork(max(wanted_integers(1), 1_ip)))
         call dgelsd(m, n, 1_ip, copy, m, both, size(both, kind=ip), values, tol, rank, work, size(work, kind=ip), iwork, &
                     info)
         call restore_halting(halting)
      else
         both = 0.0_wp
      end if
      x = both(:n)
   end subroutine least_squares

   !> c <- a' b (dgemm).
   subroutine transposed_product(a, b, c)
      real(wp), intent(in), contiguous :: a(:, :)        !< (k, m)
      real(wp), intent(in), contiguous :: b(:, :)        !< (k, n)
      real(wp), intent(out), contiguous :: c(:, :)       !< (m, n)
      type(halting_t) :: halting

      call suspend_halting(halting)
      call dgemm('T', 'N', size(c, 1, kind=ip), size(c, 2, kind=ip), size(a, 1, kind=ip), 1.0_wp, a, leading(a), &
                 b, leading(b), 0.0_wp, c, leading(c))
      call restore_halting(halting)
   end subroutine transposed_product

   !> c <- c + a b' (dgemm): 2 m n k operations, at the full rate of the processor for large blocks.
   subroutine add_product(a, b, c)
      real(wp), intent(in), contiguous :: a(:, :)        !< (m, k)
      real(wp), intent(in), contiguous :: b(:, :)        !< (n, k)
      real(wp), intent(inout), contiguous :: c(:, :)     !< (m, n)
      type(halting_t) :: halting

      call suspend_halting(halting)
      call dgemm('N', 'T', size(c, 1, kind=ip), size(c, 2, kind=ip), size(a, 2, kind=ip), 1.0_wp, a, leading(a), b, leading(b), &
                 1.0_wp, c, leading(c))
      call restore_halting(halting)
   end subroutine add_product

   !> c <- c + factor a a', or a'a, lower triangle (dsyrk): half as many operations as the product of two matrices.
   subroutine add_square(a, is_transposed, factor, c)
      real(wp), intent(in), contiguous :: a(:, :)        !< (n, k), or (k, n)
      logical, intent(in) :: is_transposed               !< a'a
      real(wp), intent(in) :: factor                     !< real number before the square, e.g. -1
      real(wp), intent(inout), contiguous :: c(:, :)     !< (n, n)
      type(halting_t) :: halting

      call suspend_halting(halting)
      call dsyrk('L', merge('T', 'N', is_transposed), order(c), size(a, merge(1, 2, is_transposed), kind=ip), factor, a, &
                 leading(a), 1.0_wp, c, leading(c))
      call restore_halting(halting)
   end subroutine add_square

   !> y <- a x (dgemv): every entry of a is used once, so it takes as long as a takes to come from memory.
   subroutine multiply_vector(a, x, y)
      real(wp), intent(in), contiguous :: a(:, :)        !< (m, n)
      real(wp), intent(in), contiguous :: x(:)           !< (n)
      real(wp), intent(out), contiguous :: y(:)          !< (m)
      type(halting_t) :: halting

      y = 0.0_wp                                         ! dgemv returns at once where n is 0
      if (size(x) == 0) return
      call suspend_halting(halting)
      call dgemv('N', size(a, 1, kind=ip), size(a, 2, kind=ip), 1.0_wp, a, leading(a), x, 1_ip, 0.0_wp, y, 1_ip)
      call restore_halting(halting)
   end subroutine multiply_vector

   !> y <- a' x (dgemv).
   subroutine multiply_transposed(a, x, y)
      real(wp), intent(in), contiguous :: a(:, :)        !< (m, n)
      real(wp), intent(in), contiguous :: x(:)           !< (m)
      real(wp), intent(out), contiguous :: y(:)          !< (n)
      type(halting_t) :: halting

      y = 0.0_wp
      if (size(a) == 0) return
      call suspend_halting(halting)
      call dgemv('T', size(a, 1, kind=ip), size(a, 2, kind=ip), 1.0_wp, a, leading(a), x, 1_ip, 0.0_wp, y, 1_ip)
      call restore_halting(halting)
   end subroutine multiply_transposed

   pure integer(ip) function order(a)
      real(wp), intent(in) :: a(:, :) !< a square matrix

      order = size(a, 2, kind=ip)
   end function order

   !> Leading dimension; LAPACK wants at least 1.
   pure integer(ip) function leading(a)
      real(wp), intent(in) :: a(:, :) !< as LAPACK takes it

      leading = max(size(a, 1, kind=ip), 1_ip)
   end function leading

end module atrito_dense
