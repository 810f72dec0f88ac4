!> Numbers to text in fields of a fixed width: what the tables are made of.
!>
!> A table of half a million rows holds millions of numbers, too many for one internal write each. The digits are found by
!> scaling with a power of ten in twice the precision; the rare number that this leaves undecided goes through the run-time
!> library, so that every number is rounded correctly and 17 digits give back the same double.
module atrito_number_text
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use atrito_kinds, only: ip, lp, wp, HUGE_REAL
   implicit none (type, external)
   private
   public :: put_real, put_integer, real_width, integer_width, trimmed_real
   public :: LEAST_DIGITS, MOST_DIGITS, DEFAULT_DIGITS

   integer, parameter :: LEAST_DIGITS = 6, MOST_DIGITS = 17, DEFAULT_DIGITS = 10

   !> Powers of ten that a double holds exactly.
   integer, parameter :: EXACT_POWERS = 22
   real(wp), parameter :: POWER(0:EXACT_POWERS) = [1e0_wp, 1e1_wp, 1e2_wp, 1e3_wp, 1e4_wp, 1e5_wp, 1e6_wp, 1e7_wp, 1e8_wp, &
        1e9_wp, 1e10_wp, 1e11_wp, 1e12_wp, 1e13_wp, 1e14_wp, 1e15_wp, 1e16_wp, 1e17_wp, 1e18_wp, 1e19_wp, 1e20_wp, 1e21_wp, 1e22_wp]
   !> Decimal digits of the largest power of two below a number.
   real(wp), parameter :: LOG10_OF_2 = 0.30102999566398119521_wp
   !> Closer than this to a half, the double-length product does not decide the rounding (its error is below 1e-12).
   real(wp), parameter :: UNDECIDED = 1.0e-9_wp

contains

   !> Width of the field of a real: sign, digits, point, exponent of three digits.
   elemental integer function real_width(digits)
      integer, intent(in) :: digits                !< LEAST_DIGITS..MOST_DIGITS

      real_width = digits + 7
   end function real_width

   !> Width of the field of an integer.
   elemental integer function integer_width(i)
      integer(ip), intent(in) :: i
      integer(lp) :: rest

      integer_width = merge(2, 1, i < 0)
      rest = abs(int(i, lp))
      do while (rest >= 10_lp)
         rest = rest/10_lp
         integer_width = integer_width + 1
      end do
   end function integer_width

   !> Writes a real to the right end of a field: d.ddde+dd, `0`, `nan` or `inf`.
   pure subroutine put_real(x, digits, field)
      real(wp), intent(in) :: x
      integer, intent(in) :: digits                !< LEAST_DIGITS..MOST_DIGITS
      character(len=*), intent(out) :: field       !< at least real_width(digits) long
      integer(lp) :: mantissa
      integer :: exponent_of_ten
      logical :: decided

      field = ''
      if (ieee_is_nan(x)) then
         field(len(field) - 2:) = 'nan'
      else if (abs(x) > HUGE_REAL) then
         field(len(field) - 3:) = merge('-inf', ' inf', x < 0.0_wp)
      else if (x == 0.0_wp) then
         field(len(field):) = '0'
      else
         call find_digits(abs(x), digits, mantissa, exponent_of_ten, decided)
         if (.not. decided) call find_digits_slowly(abs(x), digits, mantissa, exponent_of_ten)
         call lay_out(x < 0.0_wp, mantissa, digits, exponent_of_ten, field)
      end if
   end subroutine put_real

   !> Writes an integer to the right end of a field.
   pure subroutine put_integer(i, field)
      integer(ip), intent(in) :: i
      character(len=*), intent(out) :: field       !< at least integer_width(i) long
      integer(lp) :: rest
      integer :: place

      field = ''
      rest = abs(int(i, lp))
      place = len(field)
      do
         field(place:place) = achar(iachar('0') + int(mod(rest, 10_lp)))
         rest = rest/10_lp
         place = place - 1
         if (rest == 0_lp) exit
      end do
      if (i < 0) field(place:place) = '-'
   end subroutine put_integer

   !> A real without blanks round it.
   pure function trimmed_real(x, digits) result(text)
      real(wp), intent(in) :: x
      integer, intent(in) :: digits
      character(len=:), allocatable :: text
      character(len=MOST_DIGITS + 7) :: field

      call put_real(x, digits, field)
      text = trim(adjustl(field))
   end function trimmed_real

   !> x = mantissa 10**(exponent_of_ten - digits + 1), rounded; decided is false where that takes more care.
   pure subroutine find_digits(x, digits, mantissa, exponent_of_ten, decided)
      real(wp), intent(in) :: x                    !< > 0
      integer, intent(in) :: digits
      integer(lp), intent(out) :: mantissa
      integer, intent(out) :: exponent_of_ten
      logical, intent(out) :: decided

      mantissa = 0_lp
      exponent_of_ten = floor(LOG10_OF_2*real(exponent(x) - 1, wp))   ! the right one or one too small
      call scale_and_round(x, digits - 1 - exponent_of_ten, mantissa, decided)
      if (.not. decided) return
      if (mantissa >= 10_lp**digits) then
         exponent_of_ten = exponent_of_ten + 1
         call scale_and_round(x, digits - 1 - exponent_of_ten, mantissa, decided)
      end if
   end subroutine find_digits

   !> The integer nearest to x 10**k.
   pure subroutine scale_and_round(x, k, rounded, decided)
      real(wp), intent(in) :: x
      integer, intent(in) :: k
      integer(lp), intent(out) :: rounded
      logical, intent(out) :: decided
      real(wp) :: high, low, rest

      rounded = 0_lp
      decided = abs(k) <= 2*EXACT_POWERS
      if (.not. decided) return
      high = x
      low = 0.0_wp
      if (k >= 0) then
         call multiply(high, low, POWER(min(k, EXACT_POWERS)))
         if (k > EXACT_POWERS) call multiply(high, low, POWER(k - EXACT_POWERS))
      else
         call divide(high, low, POWER(min(-k, EXACT_POWERS)))
         if (-k > EXACT_POWERS) call divide(high, low, POWER(-k - EXACT_POWERS))
      end if
      rounded = int(high, lp)
      rest = (high - real(rounded, wp)) + low
      decided = abs(rest - (real(floor(rest), wp) + 0.5_wp)) > UNDECIDED
      rounded = rounded + int(floor(rest + 0.5_wp), lp)
   end subroutine scale_and_round

   !> Multiplies high + low by p in twice the precision.
   pure subroutine multiply(high, low, p)
      real(wp), intent(inout) :: high, low
      real(wp), intent(in) :: p
      real(wp) :: product_high, product_low

      product_high = high*p
      product_low = rounding_error(high, p, product_high) + low*p
      high = product_high + product_low
      low = product_low - (high - product_high)
   end subroutine multiply

   !> Divides high + low by p in twice the precision.
   pure subroutine divide(high, low, p)
      real(wp), intent(inout) :: high, low
      real(wp), intent(in) :: p
      real(wp) :: quotient, back, correction

      quotient = high/p
      back = quotient*p
      correction = (((high - back) - rounding_error(quotient, p, back)) + low)/p
      high = quotient + correction
      low = correction - (high - quotient)
   end subroutine divide

   !> a b - product exactly (Dekker), where product is a b rounded. The halves are cut by masking bits, which no compiler
   !> option changes.
   pure real(wp) function rounding_error(a, b, product)
      real(wp), intent(in) :: a, b, product
      real(wp) :: a_high, a_low, b_high, b_low

      a_high = upper_half(a)
      a_low = a - a_high
      b_high = upper_half(b)
      b_low = b - b_high
      rounding_error = (((a_high*b_high - product) + a_high*b_low) + a_low*b_high) + a_low*b_low
   end function rounding_error

   pure real(wp) function upper_half(x)
      real(wp), intent(in) :: x
      integer(lp), parameter :: MASK = not(2_lp**27 - 1_lp)

      upper_half = transfer(iand(transfer(x, 0_lp), MASK), 0.0_wp)
   end function upper_half

   !> The same as find_digits by way of the run-time library.
   pure subroutine find_digits_slowly(x, digits, mantissa, exponent_of_ten)
      real(wp), intent(in) :: x
      integer, intent(in) :: digits
      integer(lp), intent(out) :: mantissa
      integer, intent(out) :: exponent_of_ten
      character(len=32) :: buffer
      character(len=12) :: form
      integer :: i

      write (form, '("(es32.",i0,"e4)")') digits - 1
      write (buffer, form) x
      mantissa = 0_lp
      exponent_of_ten = 0
      do i = 1, index(buffer, 'E') - 1
         if (is_digit(buffer(i:i))) mantissa = 10_lp*mantissa + int(iachar(buffer(i:i)) - iachar('0'), lp)
      end do
      do i = index(buffer, 'E') + 2, len(buffer)
         exponent_of_ten = 10*exponent_of_ten + iachar(buffer(i:i)) - iachar('0')
      end do
      if (index(buffer, 'E-') > 0) exponent_of_ten = -exponent_of_ten
   end subroutine find_digits_slowly

   elemental logical function is_digit(c)
      character(len=1), intent(in) :: c

      is_digit = c >= '0' .and. c <= '9'
   end function is_digit

   !> d.ddde+dd from the right end of the field; the field is blank before.
   pure subroutine lay_out(negative, mantissa, digits, exponent_of_ten, field)
      logical, intent(in) :: negative
      integer(lp), intent(in) :: mantissa
      integer, intent(in) :: digits, exponent_of_ten
      character(len=*), intent(inout) :: field
      integer(lp) :: rest
      integer :: place, e, i

      place = len(field)
      e = abs(exponent_of_ten)
      do i = 1, merge(3, 2, e > 99)
         field(place:place) = achar(iachar('0') + mod(e, 10))
         e = e/10
         place = place - 1
      end do
      field(place - 1:place) = merge('e-', 'e+', exponent_of_ten < 0)
      place = place - 2
      rest = mantissa
      do i = 2, digits
         field(place:place) = achar(iachar('0') + int(mod(rest, 10_lp)))
         rest = rest/10_lp
         place = place - 1
      end do
      field(place - 1:place) = achar(iachar('0') + int(rest))//'.'
      if (negative) field(place - 2:place - 2) = '-'
   end subroutine lay_out

end module atrito_number_text
