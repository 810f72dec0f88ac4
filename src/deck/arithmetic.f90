!> Arithmetic that says when a result does not fit into a double, instead of raising an exception.
module atrito_arithmetic
   use atrito_kinds, only: wp
   implicit none (type, external)
   private
   public :: add_safely, multiply_safely, divide_safely, raise_safely, exponential_safely
   public :: ARITHMETIC_OK, ARITHMETIC_OVERFLOW, ARITHMETIC_ZERO_DIVISION, ARITHMETIC_UNDEFINED

   integer, parameter :: ARITHMETIC_OK = 0
   integer, parameter :: ARITHMETIC_OVERFLOW = 1
   integer, parameter :: ARITHMETIC_ZERO_DIVISION = 2
   integer, parameter :: ARITHMETIC_UNDEFINED = 3      !< e.g. a root of a negative number

   integer, parameter :: LARGEST_EXPONENT = maxexponent(1.0_wp)
   !> exp of more than this overflows; a little less than log(huge), for the rounding of the argument.
   real(wp), parameter :: LARGEST_ARGUMENT = 709.78_wp

contains

   !> a + b. outcome: ARITHMETIC_OK, or ARITHMETIC_OVERFLOW where the sum is beyond all numbers, and then the sum is 0. No exception
   !> is raised.
   pure subroutine add_safely(a, b, sum, outcome)
      real(wp), intent(in) :: a, b    !< any numbers
      real(wp), intent(out) :: sum    !< 0 where the outcome is not OK
      integer, intent(out) :: outcome !< one of ARITHMETIC_*

      sum = 0.0_wp
      outcome = ARITHMETIC_OVERFLOW
      if (abs(0.5_wp*a + 0.5_wp*b) > 0.5_wp*huge(sum)) return
      sum = a + b
      outcome = ARITHMETIC_OK
   end subroutine add_safely

   !> a b. outcome: ARITHMETIC_OK, or ARITHMETIC_OVERFLOW, and then the product is 0. No exception is raised.
   pure subroutine multiply_safely(a, b, product, outcome)
      real(wp), intent(in) :: a, b     !< any numbers
      real(wp), intent(out) :: product !< 0 where the outcome is not OK
      integer, intent(out) :: outcome  !< one of ARITHMETIC_*

      product = 0.0_wp
      outcome = ARITHMETIC_OVERFLOW
      if (.not. fits(fraction(a)*fraction(b), exponent(a) + exponent(b))) return
      product = a*b
      outcome = ARITHMETIC_OK
   end subroutine multiply_safely

   !> a/b. outcome: ARITHMETIC_OK, ARITHMETIC_ZERO_DIVISION or ARITHMETIC_OVERFLOW, and then the quotient is 0.
   pure subroutine divide_safely(a, b, quotient, outcome)
      real(wp), intent(in) :: a, b      !< any numbers
      real(wp), intent(out) :: quotient !< 0 where the outcome is not OK
      integer, intent(out) :: outcome   !< one of ARITHMETIC_*

      quotient = 0.0_wp
      outcome = ARITHMETIC_ZERO_DIVISION
      if (b == 0.0_wp) return
      outcome = ARITHMETIC_OVERFLOW
      if (.not. fits(fraction(a)/fraction(b), exponent(a) - exponent(b))) return
      quotient = a/b
      outcome = ARITHMETIC_OK
   end subroutine divide_safely

   !> Whether x 2**power_of_two is no more than the largest number.
   pure logical function fits(x, power_of_two)
      real(wp), intent(in) :: x
      integer, intent(in) :: power_of_two

      fits = x == 0.0_wp .or. power_of_two + exponent(x) <= LARGEST_EXPONENT
   end function fits

   !> a**b; of a negative number only a whole power exists. outcome: ARITHMETIC_OK, or why there is no power, which is 0 then:
   !> ARITHMETIC_ZERO_DIVISION of 0 to a negative power, ARITHMETIC_UNDEFINED or ARITHMETIC_OVERFLOW.
   pure subroutine raise_safely(a, b, power, outcome)
      real(wp), intent(in) :: a, b    !< any numbers
      real(wp), intent(out) :: power  !< 0 where the outcome is not OK
      integer, intent(out) :: outcome !< one of ARITHMETIC_*
      real(wp) :: argument

      power = 0.0_wp
      if (a == 0.0_wp) then
         outcome = merge(ARITHMETIC_ZERO_DIVISION, ARITHMETIC_OK, b < 0.0_wp)
         if (b == 0.0_wp) power = 1.0_wp
         return
      end if
      outcome = ARITHMETIC_UNDEFINED
      if (a < 0.0_wp .and. aint(b) /= b) return
      call multiply_safely(b, log(abs(a)), argument, outcome)
      if (outcome == ARITHMETIC_OK .and. argument > LARGEST_ARGUMENT) outcome = ARITHMETIC_OVERFLOW
      if (outcome /= ARITHMETIC_OK) return
      power = abs(a)**b
      if (a < 0.0_wp .and. mod(b, 2.0_wp) /= 0.0_wp) power = -power
   end subroutine raise_safely

   !> exp(a). outcome: ARITHMETIC_OK, or ARITHMETIC_OVERFLOW, and then the power is 0.
   pure subroutine exponential_safely(a, power, outcome)
      real(wp), intent(in) :: a       !< any number
      real(wp), intent(out) :: power  !< 0 where the outcome is not OK
      integer, intent(out) :: outcome !< one of ARITHMETIC_*

      power = 0.0_wp
      outcome = ARITHMETIC_OVERFLOW
      if (a > LARGEST_ARGUMENT) return
      power = exp(a)
      outcome = ARITHMETIC_OK
   end subroutine exponential_safely

end module atrito_arithmetic
