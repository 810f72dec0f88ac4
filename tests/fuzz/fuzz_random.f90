!> Random numbers that are the same on every machine: xorshift64, which needs shifts and exclusive or only (no arithmetic that
!> could overflow). Reference: G. Marsaglia, Xorshift RNGs, J. Stat. Softw. 8 (2003) 14.
module fuzz_random
   use atrito_kinds, only: ip, lp
   implicit none (type, external)
   private
   public :: random_t, begin_random, random_integer, random_chance

   type :: random_t
      integer(lp) :: state = 1_lp
   end type random_t

   integer(lp), parameter :: SALT = int(z'1E3779B97F4A7C15', lp)   ! no meaning: bits of both kinds
   integer, parameter :: WARM_UP = 16                              ! until neighbouring seeds have nothing in common

contains

   !> A sequence of its own for each pair of numbers.
   pure subroutine begin_random(random, seed, k)
      type(random_t), intent(out) :: random
      integer(ip), intent(in) :: seed, k
      integer :: i

      random%state = ieor(ieor(shiftl(int(seed, lp), 32), int(k, lp)), SALT)
      if (random%state == 0_lp) random%state = SALT
      do i = 1, WARM_UP
         call step(random)
      end do
   end subroutine begin_random

   pure subroutine step(random)
      type(random_t), intent(inout) :: random

      random%state = ieor(random%state, shiftl(random%state, 13))
      random%state = ieor(random%state, shiftr(random%state, 7))
      random%state = ieor(random%state, shiftl(random%state, 17))
   end subroutine step

   !> An integer of low..high; low when there is none.
   subroutine random_integer(random, low, high, i)
      type(random_t), intent(inout) :: random
      integer(ip), intent(in) :: low, high
      integer(ip), intent(out) :: i

      call step(random)
      i = low
      if (high > low) i = low + int(modulo(shiftr(random%state, 11), int(high - low + 1, lp)), ip)
   end subroutine random_integer

   !> True once in n times.
   subroutine random_chance(random, n, hit)
      type(random_t), intent(inout) :: random
      integer(ip), intent(in) :: n
      logical, intent(out) :: hit
      integer(ip) :: i

      call random_integer(random, 1_ip, n, i)
      hit = i == 1
   end subroutine random_chance

end module fuzz_random
