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
         character(len=1), intent(in) :: transa, transb
         integer(ip), intent(in) :: m, n, k, lda, ldb, ldc
         real(wp), intent(in) :: alpha, beta, a(lda, *), b(ldb, *)
         real(wp), intent(inout) :: c(ldc, *)
      end subroutine dgemm

      !> y := alpha op(a) x + beta y
      pure subroutine dgemv(trans, m, n, alpha, a, lda, x, incx, beta, y, incy)
         import :: ip, wp
         character(len=1), intent(in) :: trans
         integer(ip), intent(in) :: m, n, lda, incx, incy
         real(wp), intent(in) :: alpha, beta, a(lda, *), x(*)
         real(wp), intent(inout) :: y(*)
      end subroutine dgemv

      !> y := alpha a x + beta y, a symmetric, one triangle
      pure subroutine dsymv(uplo, n, alpha, a, lda, x, incx, beta, y, incy)
         import :: ip, wp
         character(len=1), intent(in) :: uplo
         integer(ip), intent(in) :: n, lda, incx, incy
         real(wp), intent(in) :: alpha, beta, a(lda, *), x(*)
         real(wp), intent(inout) :: y(*)
      end subroutine dsymv

      !> c := alpha op(a) op(a)' + beta c, one triangle
      pure subroutine dsyrk(uplo, trans, n, k, alpha, a, lda, beta, c, ldc)
         import :: ip, wp
         character(len=1), intent(in) :: uplo, trans
         integer(ip), intent(in) :: n, k, lda, ldc
         real(wp), intent(in) :: alpha, beta, a(lda, *)
         real(wp), intent(inout) :: c(ldc, *)
      end subroutine dsyrk

      !> b := alpha op(a)^-1 b or alpha b op(a)^-1, a triangular
      pure subroutine dtrsm(side, uplo, transa, diag, m, n, alpha, a, lda, b, ldb)
         import :: ip, wp
         character(len=1), intent(in) :: side, uplo, transa, diag
         integer(ip), intent(in) :: m, n, lda, ldb
         real(wp), intent(in) :: alpha, a(lda, *)
         real(wp), intent(inout) :: b(ldb, *)
      end subroutine dtrsm

      !> x := op(a)^-1 x, a triangular
      pure subroutine dtrsv(uplo, trans, diag, n, a, lda, x, incx)
         import :: ip, wp
         character(len=1), intent(in) :: uplo, trans, diag
         integer(ip), intent(in) :: n, lda, incx
         real(wp), intent(in) :: a(lda, *)
         real(wp), intent(inout) :: x(*)
      end subroutine dtrsv

      !> LU with partial pivoting, and solution
      pure subroutine dgesv(n, nrhs, a, lda, ipiv, b, ldb, info)
         import :: ip, wp
         integer(ip), intent(in) :: n, nrhs, lda, ldb
         real(wp), intent(inout) :: a(lda, *), b(ldb, *)
         integer(ip), intent(out) :: ipiv(*), info
      end subroutine dgesv

      !> Singular values and vectors
      pure subroutine dgesvd(jobu, jobvt, m, n, a, lda, s, u, ldu, vt, ldvt, work, lwork, info)
         import :: ip, wp
         character(len=1), intent(in) :: jobu, jobvt
         integer(ip), intent(in) :: m, n, lda, ldu, ldvt, lwork
         real(wp), intent(inout) :: a(lda, *)
         real(wp), intent(out) :: s(*), u(ldu, *), vt(ldvt, *), work(*)
         integer(ip), intent(out) :: info
      end subroutine dgesvd

      !> Least squares of least norm by singular values
      pure subroutine dgelsd(m, n, nrhs, a, lda, b, ldb, s, rcond, rank, work, lwork, iwork, info)
         import :: ip, wp
         integer(ip), intent(in) :: m, n, nrhs, lda, ldb, lwork
         real(wp), intent(inout) :: a(lda, *), b(ldb, *)
         real(wp), intent(in) :: rcond
         real(wp), intent(out) :: s(*), work(*)
         integer(ip), intent(out) :: rank, iwork(*), info
      end subroutine dgelsd

      !> Cholesky of a band matrix
      pure subroutine dpbtrf(uplo, n, kd, ab, ldab, info)
         import :: ip, wp
         character(len=1), intent(in) :: uplo
         integer(ip), intent(in) :: n, kd, ldab
         real(wp), intent(inout) :: ab(ldab, *)
         integer(ip), intent(out) :: info
      end subroutine dpbtrf

      !> Triangular band solve
      pure subroutine dtbtrs(uplo, trans, diag, n, kd, nrhs, ab, ldab, b, ldb, info)
         import :: ip, wp
         character(len=1), intent(in) :: uplo, trans, diag
         integer(ip), intent(in) :: n, kd, nrhs, ldab, ldb
         real(wp), intent(in) :: ab(ldab, *)
         real(wp), intent(inout) :: b(ldb, *)
         integer(ip), intent(out) :: info
      end subroutine dtbtrs

      !> Cholesky
      pure subroutine dpotrf(uplo, n, a, lda, info)
         import :: ip, wp
         character(len=1), intent(in) :: uplo
         integer(ip), intent(in) :: n, lda
         real(wp), intent(inout) :: a(lda, *)
         integer(ip), intent(out) :: info
      end subroutine dpotrf

      !> Solution with the factor of dpotrf
      pure subroutine dpotrs(uplo, n, nrhs, a, lda, b, ldb, info)
         import :: ip, wp
         character(len=1), intent(in) :: uplo
         integer(ip), intent(in) :: n, nrhs, lda, ldb
         real(wp), intent(in) :: a(lda, *)
         real(wp), intent(inout) :: b(ldb, *)
         integer(ip), intent(out) :: info
      end subroutine dpotrs

      !> Reciprocal condition number with the factor of dpotrf
      pure subroutine dpocon(uplo, n, a, lda, anorm, rcond, work, iwork, info)
         import :: ip, wp
         character(len=1), intent(in) :: uplo
         integer(ip), intent(in) :: n, lda
         real(wp), intent(in) :: a(lda, *), anorm
         real(wp), intent(out) :: rcond, work(*)
         integer(ip), intent(out) :: iwork(*), info
      end subroutine dpocon

      !> Eigenvalues and vectors of a symmetric matrix
      pure subroutine dsyev(jobz, uplo, n, a, lda, w, work, lwork, info)
         import :: ip, wp
         character(len=1), intent(in) :: jobz, uplo
         integer(ip), intent(in) :: n, lda, lwork
         real(wp), intent(inout) :: a(lda, *)
         real(wp), intent(out) :: w(*), work(*)
         integer(ip), intent(out) :: info
      end subroutine dsyev

      !> Version of LAPACK
      subroutine ilaver(vers_major, vers_minor, vers_patch)
         import :: ip
         integer(ip), intent(out) :: vers_major, vers_minor, vers_patch
      end subroutine ilaver

   end interface

end module atrito_lapack
