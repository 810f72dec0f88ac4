!> A Cholesky factor and a norm of a full matrix, for tests.
module dense_measures
   use atrito_kinds, only: ip, wp
   use atrito_lapack, only: dpotrf
   implicit none (type, external)
   private
   public :: factor_cholesky, norm_one

contains

   !> A = L L' in place (dpotrf): reads and writes the lower triangle alone.
   subroutine factor_cholesky(a, pivot_failed)
      real(wp), intent(inout), contiguous :: a(:, :)     !< (n, n)
      integer(ip), intent(out) :: pivot_failed           !< 0, or the first row whose pivot is not positive

      call dpotrf('L', size(a, 2, kind=ip), a, max(size(a, 1, kind=ip), 1_ip), pivot_failed)
   end subroutine factor_cholesky

   !> Largest column sum of absolute values; 0 at order 0.
   pure real(wp) function norm_one(a)
      real(wp), intent(in) :: a(:, :)                    !< any shape
      integer(ip) :: j

      norm_one = 0.0_wp
      do j = 1, size(a, 2, kind=ip)
         norm_one = max(norm_one, sum(abs(a(:, j))))
      end do
   end function norm_one

end module dense_measures
