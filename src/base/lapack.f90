!> Explicit interfaces of the LAPACK and BLAS routines in use (netlib.org/lapack), nothing else.
module atrito_lapack
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: dgemm, dgemv, dgesv, dgesvd, dgelsd, dpbtrf, dpocon, dpotrf, dpotrs, dsyev, dsymv, dsyrk, dtbtrs, dtrsm, dtrsv, ilaver

   interface

      !> c := alpha op(a) op(b) + beta c
      pure subroutine dgemm(transa, transb, m, n, k, alpha, a, lda, b, ldb, beta, c, ldc)
         import :: ip, wp
         character(len=1), intent(in) :: transa, transb            !< 'N': as it is; 'T': transposed
         integer(ip), intent(in) :: m, n, k, lda, ldb, ldc         !< c is (m, n), k the terms of each entry; leading dimensions
         real(wp), intent(in) :: alpha, beta, a(lda, *), b(ldb, *) !< factors; the two matrices
         real(wp), intent(inout) :: c(ldc, *)                      !< (m, n); is not read where beta is 0
      end subroutine dgemm

      !> y := alpha op(a) x + beta y
      pure subroutine dgemv(trans, m, n, alpha, a, lda, x, incx, beta, y, incy)
         import :: ip, wp
         character(len=1), intent(in) :: trans                !< 'N': as it is; 'T': transposed
         integer(ip), intent(in) :: m, n, lda, incx, incy     !< a is (m, n); leading dimension; strides of x and y
         real(wp), intent(in) :: alpha, beta, a(lda, *), x(*) !< factors; the matrix and the vector
         real(wp), intent(inout) :: y(*)                      !< is not read where beta is 0
      end subroutine dgemv

      !> y := alpha a x + beta y, a symmetric, one triangle
      pure subroutine dsymv(uplo, n, alpha, a, lda, x, incx, beta, y, incy)
         import :: ip, wp
         character(len=1), intent(in) :: uplo                 !< 'L' or 'U': the triangle of a that is read
         integer(ip), intent(in) :: n, lda, incx, incy        !< order of a; leading dimension; strides of x and y
         real(wp), intent(in) :: alpha, beta, a(lda, *), x(*) !< factors; the matrix and the vector
         real(wp), intent(inout) :: y(*)                      !< (n); is not read where beta is 0
      end subroutine dsymv

      !> c := alpha op(a) op(a)' + beta c, one triangle
      pure subroutine dsyrk(uplo, trans, n, k, alpha, a, lda, beta, c, ldc)
         import :: ip, wp
         character(len=1), intent(in) :: uplo, trans    !< 'L' or 'U': the triangle of c; 'N': a a', 'T': a' a
         integer(ip), intent(in) :: n, k, lda, ldc      !< order of c; terms of each entry; leading dimensions
         real(wp), intent(in) :: alpha, beta, a(lda, *) !< factors; the matrix
         real(wp), intent(inout) :: c(ldc, *)           !< (n, n); one triangle is read and set
      end subroutine dsyrk

      !> b := alpha op(a)^-1 b or alpha b op(a)^-1, a triangular
      pure subroutine dtrsm(side, uplo, transa, diag, m, n, alpha, a, lda, b, ldb)
         import :: ip, wp
         character(len=1), intent(in) :: side, uplo, transa, diag !< 'L', 'R': a on the left, right; as in dtrsv
         integer(ip), intent(in) :: m, n, lda, ldb                !< b is (m, n); leading dimensions
         real(wp), intent(in) :: alpha, a(lda, *)                 !< factor; the triangle
         real(wp), intent(inout) :: b(ldb, *)                     !< (m, n) right sides, then solutions
      end subroutine dtrsm

      !> x := op(a)^-1 x, a triangular
      pure subroutine dtrsv(uplo, trans, diag, n, a, lda, x, incx)
         import :: ip, wp
         character(len=1), intent(in) :: uplo, trans, diag !< 'L' or 'U'; 'N' or 'T'; 'N', or 'U': 1 on the diagonal
         integer(ip), intent(in) :: n, lda, incx           !< order of a; leading dimension; stride of x
         real(wp), intent(in) :: a(lda, *)                 !< the triangle
         real(wp), intent(inout) :: x(*)                   !< (n) right side, then solution
      end subroutine dtrsv

      !> LU with partial pivoting, and solution
      pure subroutine dgesv(n, nrhs, a, lda, ipiv, b, ldb, info)
         import :: ip, wp
         integer(ip), intent(in) :: n, nrhs, lda, ldb    !< order of a; right sides; leading dimensions
         real(wp), intent(inout) :: a(lda, *), b(ldb, *) !< (n, n), then its factors; (n, nrhs) right sides, then solutions
         integer(ip), intent(out) :: ipiv(*), info       !< (n) row that each one was exchanged with; > 0: pivot that is 0
      end subroutine dgesv

      !> Singular values and vectors
      pure subroutine dgesvd(jobu, jobvt, m, n, a, lda, s, u, ldu, vt, ldvt, work, lwork, info)
         import :: ip, wp
         character(len=1), intent(in) :: jobu, jobvt !< left, right vectors: 'N': none; 'A': all; 'S': the first; 'O': into a
         integer(ip), intent(in) :: m, n, lda, ldu, ldvt, lwork !< a is (m, n); leading dimensions; length of work, -1: to ask
         real(wp), intent(inout) :: a(lda, *)        !< (m, n), is destroyed
         real(wp), intent(out) :: s(*), u(ldu, *), vt(ldvt, *), work(*) !< values, falling; vectors; work(1): its best length
         integer(ip), intent(out) :: info            !< > 0: so many values did not converge
      end subroutine dgesvd

      !> Least squares of least norm by singular values
      pure subroutine dgelsd(m, n, nrhs, a, lda, b, ldb, s, rcond, rank, work, lwork, iwork, info)
         import :: ip, wp
         integer(ip), intent(in) :: m, n, nrhs, lda, ldb, lwork !< a is (m, n); right sides; leading dimensions; length of work
         real(wp), intent(inout) :: a(lda, *), b(ldb, *)  !< (m, n), is destroyed; right sides, then solutions in the first n rows
         real(wp), intent(in) :: rcond                    !< share of the largest singular value below which one is 0
         real(wp), intent(out) :: s(*), work(*)           !< singular values, falling; work(1): its best length
         integer(ip), intent(out) :: rank, iwork(*), info !< values that are not 0; iwork(1): its least length; > 0: not converged
      end subroutine dgelsd

      !> Cholesky of a band matrix
      pure subroutine dpbtrf(uplo, n, kd, ab, ldab, info)
         import :: ip, wp
         character(len=1), intent(in) :: uplo   !< 'L' or 'U': the triangle in the band
         integer(ip), intent(in) :: n, kd, ldab !< order; diagonals beside the main one; leading dimension
         real(wp), intent(inout) :: ab(ldab, *) !< band of the matrix, then of its factor
         integer(ip), intent(out) :: info       !< > 0: the first minor that is not positive
      end subroutine dpbtrf

      !> Triangular band solve
      pure subroutine dtbtrs(uplo, trans, diag, n, kd, nrhs, ab, ldab, b, ldb, info)
         import :: ip, wp
         character(len=1), intent(in) :: uplo, trans, diag !< 'L' or 'U'; 'N' or 'T'; 'N', or 'U': 1 on the diagonal
         integer(ip), intent(in) :: n, kd, nrhs, ldab, ldb !< order; diagonals beside the main one; right sides; leading dimensions
         real(wp), intent(in) :: ab(ldab, *)               !< band of the triangle
         real(wp), intent(inout) :: b(ldb, *)              !< (n, nrhs) right sides, then solutions
         integer(ip), intent(out) :: info                  !< > 0: place on the diagonal that is 0
      end subroutine dtbtrs

      !> Cholesky
      pure subroutine dpotrf(uplo, n, a, lda, info)
         import :: ip, wp
         character(len=1), intent(in) :: uplo !< 'L' or 'U': the triangle that is read and set
         integer(ip), intent(in) :: n, lda    !< order of a; leading dimension
         real(wp), intent(inout) :: a(lda, *) !< (n, n), then its factor in the triangle
         integer(ip), intent(out) :: info     !< > 0: the first minor that is not positive
      end subroutine dpotrf

      !> Solution with the factor of dpotrf
      pure subroutine dpotrs(uplo, n, nrhs, a, lda, b, ldb, info)
         import :: ip, wp
         character(len=1), intent(in) :: uplo         !< 'L' or 'U': the triangle of the factor
         integer(ip), intent(in) :: n, nrhs, lda, ldb !< order of a; right sides; leading dimensions
         real(wp), intent(in) :: a(lda, *)            !< (n, n) factor of dpotrf
         real(wp), intent(inout) :: b(ldb, *)         !< (n, nrhs) right sides, then solutions
         integer(ip), intent(out) :: info             !< 0; < 0: an argument is wrong
      end subroutine dpotrs

      !> Reciprocal condition number with the factor of dpotrf
      pure subroutine dpocon(uplo, n, a, lda, anorm, rcond, work, iwork, info)
         import :: ip, wp
         character(len=1), intent(in) :: uplo       !< 'L' or 'U': the triangle of the factor
         integer(ip), intent(in) :: n, lda          !< order of a; leading dimension
         real(wp), intent(in) :: a(lda, *), anorm   !< factor of dpotrf; 1-norm of the matrix before
         real(wp), intent(out) :: rcond, work(*)    !< 1/(|A| |A^-1|), estimated; (3 n) room
         integer(ip), intent(out) :: iwork(*), info !< (n) room; 0, or < 0: an argument is wrong
      end subroutine dpocon

      !> Eigenvalues and vectors of a symmetric matrix
      pure subroutine dsyev(jobz, uplo, n, a, lda, w, work, lwork, info)
         import :: ip, wp
         character(len=1), intent(in) :: jobz, uplo !< 'N': values alone, 'V': vectors, too; 'L' or 'U': the triangle
         integer(ip), intent(in) :: n, lda, lwork   !< order of a; leading dimension; length of work, -1: to ask for it
         real(wp), intent(inout) :: a(lda, *)       !< (n, n), then the vectors by columns
         real(wp), intent(out) :: w(*), work(*)     !< (n) eigenvalues, rising; work(1): its best length
         integer(ip), intent(out) :: info           !< > 0: so many values did not converge
      end subroutine dsyev

      !> Version of LAPACK
      subroutine ilaver(vers_major, vers_minor, vers_patch)
         import :: ip
         integer(ip), intent(out) :: vers_major, vers_minor, vers_patch !< e.g. 3, 11, 0
      end subroutine ilaver

   end interface

end module atrito_lapack
