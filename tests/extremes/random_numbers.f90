!> Random numbers for the generator of scenes: L'Ecuyer's combined generator MRG32k3a (1999), the one of random_decks, as a state
!> that is handed on.
module random_numbers
   use, intrinsic :: iso_fortran_env, only: int64, real64
   implicit none (type, external)
   private
   public :: random_t, start, uniform, log_uniform, whole, chance

   type :: random_t
      private
      integer(int64) :: s1(3) = 12345_int64, s2(3) = 12345_int64
   end type random_t

contains

   !> The stream of deck k of a seed. Neighbouring seeds are alike for the first numbers, which are dropped.
   subroutine start(r, k, seed)
      type(random_t), intent(out) :: r
      integer, intent(in) :: k, seed
      real(real64) :: dropped
      integer :: i

      r%s1 = [12345_int64 + k, 23456_int64 + 7_int64*seed, 34567_int64 + 3_int64*k]
      r%s2 = [45678_int64 + seed, 56789_int64 + 11_int64*k, 67891_int64 + 5_int64*seed]
      do i = 1, 50
         dropped = uniform(r, 0.0_real64, 1.0_real64)
      end do
   end subroutine start

   !> Uniform in (a, b).
   real(real64) function uniform(r, a, b)
      type(random_t), intent(inout) :: r
      real(real64), intent(in) :: a, b
      integer(int64), parameter :: M1 = 4294967087_int64, M2 = 4294944443_int64
      integer(int64) :: p1, p2

      p1 = modulo(1403580_int64*r%s1(2) - 810728_int64*r%s1(1), M1)
      r%s1 = [r%s1(2), r%s1(3), p1]
      p2 = modulo(527612_int64*r%s2(3) - 1370589_int64*r%s2(1), M2)
      r%s2 = [r%s2(2), r%s2(3), p2]
      uniform = a + (b - a)*(real(modulo(p1 - p2, M1), real64) + 0.5_real64)/real(M1, real64)
   end function uniform

   !> 10**uniform.
   real(real64) function log_uniform(r, a, b)
      type(random_t), intent(inout) :: r
      real(real64), intent(in) :: a, b

      log_uniform = 10.0_real64**uniform(r, a, b)
   end function log_uniform

   !> A whole number in a..b.
   integer function whole(r, a, b)
      type(random_t), intent(inout) :: r
      integer, intent(in) :: a, b

      whole = min(a + int(uniform(r, 0.0_real64, real(b - a + 1, real64))), b)
   end function whole

   logical function chance(r, share)
      type(random_t), intent(inout) :: r
      real(real64), intent(in) :: share

      chance = uniform(r, 0.0_real64, 1.0_real64) < share
   end function chance

end module random_numbers
