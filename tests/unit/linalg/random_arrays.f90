!> Arrays of random numbers for the tests.
module random_arrays
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: random_numbers

contains

   !> Uniform in (-1, 1), the same in every run (Lehmer's generator, modulus 2^31 - 1). `state` goes on from call to call.
   subroutine random_numbers(state, a)
      integer(lp), intent(inout) :: state
      real(wp), intent(out) :: a(:)
      integer(ip) :: i

      do i = 1, size(a, kind=ip)
         state = modulo(48271_lp*max(state, 1_lp), 2147483647_lp)
         a(i) = 2.0_wp*real(state, wp)/2147483647.0_wp - 1.0_wp
      end do
   end subroutine random_numbers

end module random_arrays
