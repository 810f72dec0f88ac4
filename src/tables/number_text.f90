!> Numbers to text in fields of a fixed width: what the tables are made of.
!>
!> A table of half a million rows holds millions of numbers, too many for one internal write each. The digits are found by
!> multiplication with a power of ten in integers of 128 bits; the rare number that this leaves undecided goes through the
!> run-time library, so that every number is rounded correctly and 17 digits give back the same double.
module atrito_number_text
   use atrito_kinds, only: ip, lp, wp, HUGE_REAL, is_nan
   use atrito_powers_of_ten, only: POWER, POWER_SHIFT, MOST_POWER, POWER_BITS, XP
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: put_real, put_reals, put_integer, put_integers, real_width, integer_width, trimmed_real, short_real
   public :: LEAST_DIGITS, MOST_DIGITS, DEFAULT_DIGITS

   integer, parameter :: LEAST_DIGITS = 6, MOST_DIGITS = 17, DEFAULT_DIGITS = 10

   !> Of a double: bits of the fraction with the leading one, that one, exponent of the least normal number.
   integer, parameter :: FRACTION_BITS = 53, BIAS = 1022
   integer(lp), parameter :: LAST_BIT = 2_lp**(FRACTION_BITS - 1)
   integer(lp), parameter :: MAGNITUDE = huge(0_lp)              !< all bits but the sign
   integer, parameter :: ZERO = iachar('0'), EIGHT = 8
   integer :: i, j
   integer(lp), parameter :: TEN_TO(0:MOST_DIGITS) = [(10_lp**i, i=0, MOST_DIGITS)]
   character(len=2), parameter :: PAIR(0:99) = [((achar(ZERO + i)//achar(ZERO + j), j=0, 9), i=0, 9)]
   character(len=4), parameter :: POWER_TEXT(-MOST_POWER:MOST_POWER) = &
                                  [('e-'//PAIR(-i), i=-MOST_POWER, -1), ('e+'//PAIR(i), i=0, MOST_POWER)]

contains

   !> Width of the field of a real: sign, digits, point, exponent of three digits.
   elemental integer function real_width(digits)
      integer, intent(in) :: digits                !< LEAST_DIGITS..MOST_DIGITS

      real_width = digits + 7
   end function real_width

   !> Width of the field of an integer.
   elemental integer function integer_width(i)
      integer(ip), intent(in) :: i !< any integer
      integer(lp) :: rest

      integer_width = merge(2, 1, i < 0)
      rest = abs(int(i, lp))
      do while (rest >= 10_lp)
         rest = rest/10_lp
         integer_width = integer_width + 1
      end do
   end function integer_width

   !> Writes a real to the right end of a field that is blank: d.ddde+dd, `0`, `nan` or `inf`.
   pure subroutine put_real(x, digits, field)
      real(wp), intent(in) :: x                    !< any double
      integer, intent(in) :: digits                !< LEAST_DIGITS..MOST_DIGITS
      character(len=*), intent(inout) :: field     !< at least real_width(digits) long
      integer(lp) :: mantissa
      integer :: exponent_of_ten
      logical :: decided

      call find_digits(bits_of(x), digits, mantissa, exponent_of_ten, decided)
      if (.not. decided) then
         call put_real_slowly(x, digits, field)
      else if (digits == DEFAULT_DIGITS) then
         call lay_out(x < 0.0_wp, mantissa, DEFAULT_DIGITS, exponent_of_ten, field)   ! lengths that the compiler knows
      else
         call lay_out(x < 0.0_wp, mantissa, digits, exponent_of_ten, field)
      end if
   end subroutine put_real

   !> Writes a column of reals: one to a field, which is blank, of each line.
   pure subroutine put_reals(x, smallest, digits, first, last, lines)
      real(wp), intent(in) :: x(:)                 !< (n) any doubles
      real(wp), intent(in) :: smallest             !< what is smaller is written as 0; >= 0
      integer, intent(in) :: digits                !< LEAST_DIGITS..MOST_DIGITS
      integer, intent(in) :: first, last           !< the field, at least real_width(digits) wide
      character(len=*), intent(inout) :: lines(:)  !< (size(x))
      integer(ip) :: i

      if (size(x) == 0) return
      call fill_real_or_zero(x(1), smallest, digits, lines(1) (first:last))
      do i = 2, size(x, kind=ip)
         if (transfer(x(i), 0_lp) == transfer(x(i - 1), 0_lp)) then
            lines(i) (first:last) = lines(i - 1) (first:last)
         else
            call fill_real_or_zero(x(i), smallest, digits, lines(i) (first:last))
         end if
      end do
   end subroutine put_reals

   pure subroutine fill_real_or_zero(x, smallest, digits, field)
      real(wp), intent(in) :: x, smallest
      integer, intent(in) :: digits
      character(len=*), intent(inout) :: field

      if (bits_of(x) == 0_lp .or. bits_of(x) < bits_of(smallest)) then
         field(len(field):len(field)) = '0'
      else
         call put_real(x, digits, field)
      end if
   end subroutine fill_real_or_zero

   !> Writes a column of integers: one to a field, which is blank, of each line.
   pure subroutine put_integers(list, first, last, lines)
      integer(ip), intent(in) :: list(:)           !< (n) any integers
      integer, intent(in) :: first, last           !< the field, wide enough for each
      character(len=*), intent(inout) :: lines(:)  !< (size(list))
      integer(ip) :: i

      if (size(list) == 0) return
      call put_integer(list(1), lines(1) (first:last))
      do i = 2, size(list, kind=ip)
         if (list(i) == list(i - 1)) then
            lines(i) (first:last) = lines(i - 1) (first:last)
         else
            call put_integer(list(i), lines(i) (first:last))
         end if
      end do
   end subroutine put_integers

   !> The bits of |x|: as integers they are in the order of the numbers, and no comparison of theirs stumbles over a NaN.
   pure integer(lp) function bits_of(x) result(bits)
      real(wp), intent(in) :: x

      bits = iand(transfer(x, 0_lp), MAGNITUDE)
   end function bits_of

   !> Writes an integer to the right end of a field that is blank.
   pure subroutine put_integer(i, field)
      integer(ip), intent(in) :: i                 !< any integer
      character(len=*), intent(inout) :: field     !< at least integer_width(i) long
      integer(lp) :: rest
      integer :: place

      rest = abs(int(i, lp))
      place = len(field)
      do
         field(place:place) = achar(ZERO + int(mod(rest, 10_lp)))
         rest = rest/10_lp
         place = place - 1
         if (rest == 0_lp) exit
      end do
      if (i < 0) field(place:place) = '-'
   end subroutine put_integer

   !> A real without blanks round it.
   pure function trimmed_real(x, digits) result(text)
      real(wp), intent(in) :: x     !< any double
      integer, intent(in) :: digits !< LEAST_DIGITS..MOST_DIGITS
      character(len=:), allocatable :: text
      character(len=MOST_DIGITS + 7) :: field

      field = ''
      call put_real(x, digits, field)
      text = trim(adjustl(field))
   end function trimmed_real

   !> A real for people, letter for letter what to_text makes of it, in a tenth of the time.
   pure function short_real(x, digits) result(text)
      real(wp), intent(in) :: x                    !< finite
      integer, intent(in) :: digits                !< 1..MOST_DIGITS
      character(len=:), allocatable :: text
      integer(lp) :: mantissa
      integer :: e, n
      logical :: decided

      call find_digits(bits_of(x), digits, mantissa, e, decided)
      if (.not. decided) then
         text = to_text(x, digits)
         return
      end if
      do while (mod(mantissa, 10_lp) == 0_lp)
         mantissa = mantissa/10_lp
      end do
      text = to_text(mantissa)
      n = len(text)
      if (abs(x) < 1.0e-3_wp .or. abs(x) >= real(TEN_TO(min(digits, 15)), wp)) then
         if (n > 1) text = text(1:1)//'.'//text(2:)
         text = text//'e'//to_text(int(e, ip))
      else if (e < 0) then
         text = '0.'//repeat('0', -e - 1)//text
      else if (n <= e + 1) then
         text = text//repeat('0', e + 1 - n)
      else
         text = text(:e + 1)//'.'//text(e + 2:)
      end if
      if (x < 0.0_wp) text = '-'//text
   end function short_real

   !> |x| = mantissa 10**(exponent_of_ten - digits + 1), rounded; decided is false where that takes more care.
   !>
   !> |x| is an integer of 63 bits times a power of two, and so is a power of ten but for the rounding of POWER. Of the product of
   !> |x| with 10**k the upper 63 bits are looked at; where the rest of it, or that rounding, could change the outcome, and at a
   !> tie, nothing is decided.
   pure subroutine find_digits(bits, digits, mantissa, exponent_of_ten, decided)
      integer(lp), intent(in) :: bits              !< of |x|
      integer, intent(in) :: digits
      integer(lp), intent(out) :: mantissa
      integer, intent(out) :: exponent_of_ten
      logical, intent(out) :: decided
      integer(lp), parameter :: DOUBT = 2_lp       !< of the upper bits
      integer(lp) :: significand, upper, half
      integer :: binary, k, shift

      binary = int(shiftr(bits, FRACTION_BITS - 1)) - BIAS   ! as exponent(x), of numbers that are not denormal
      exponent_of_ten = shifta((binary - 1)*19728, 16)       ! of 2**(binary - 1) <= |x|: the right one or one too small
      mantissa = 0_lp
      decided = exponent_of_ten + 1 < MOST_POWER .and. digits - 1 - exponent_of_ten <= MOST_POWER
      if (.not. decided) return                              ! zero, denormal, infinite and no numbers are among these
      significand = shiftl(ior(iand(bits, LAST_BIT - 1_lp), LAST_BIT), POWER_BITS - FRACTION_BITS)
      k = exponent_of_ten + 1
      ! where this POWER, which is rounded, cannot tell |x| from 10**k, the digits of both are the same
      if (binary == POWER_SHIFT(k) + POWER_BITS .and. significand >= POWER(k)) exponent_of_ten = k
      k = digits - 1 - exponent_of_ten
      upper = int(shiftr(int(significand, XP)*int(POWER(k), XP), POWER_BITS), lp)
      shift = -binary - POWER_SHIFT(k)
      half = shiftl(1_lp, shift - 1)
      decided = abs(iand(upper, 2_lp*half - 1_lp) - half) > DOUBT
      mantissa = shiftr(shiftr(upper, shift - 1) + 1_lp, 1)
      if (mantissa == TEN_TO(digits)) then
         mantissa = TEN_TO(digits - 1)
         exponent_of_ten = exponent_of_ten + 1
      end if
   end subroutine find_digits

   !> What put_real leaves over: 0, nan and inf, exponents of three digits, and what takes the run-time library to round.
   pure subroutine put_real_slowly(x, digits, field)
      real(wp), intent(in) :: x
      integer, intent(in) :: digits
      character(len=*), intent(out) :: field
      character(len=32) :: buffer
      character(len=12) :: form
      integer :: e

      if (is_nan(x)) then
         field = 'nan'
      else if (abs(x) > HUGE_REAL) then
         field = 'inf'
         if (x < 0.0_wp) field = '-inf'
      else if (x == 0.0_wp) then
         field = '0'
      else
         write (form, '("(es32.",i0,"e3)")') digits - 1
         write (buffer, form) x
         buffer = adjustl(buffer)
         e = index(buffer, 'E')
         field = buffer(:e - 1)//'e'//buffer(e + 1:)
         if (buffer(e + 2:e + 2) == '0') field = buffer(:e - 1)//'e'//buffer(e + 1:e + 1)//buffer(e + 3:)
      end if
      field = adjustr(field)
   end subroutine put_real_slowly

   !> d.ddde+dd at the right end of a field that is blank.
   pure subroutine lay_out(negative, mantissa, digits, exponent_of_ten, field)
      logical, intent(in) :: negative
      integer(lp), intent(in) :: mantissa
      integer, intent(in) :: digits, exponent_of_ten
      character(len=*), intent(inout) :: field     !< at least real_width(digits) long
      character(len=3*EIGHT) :: text
      integer :: last, point

      call put_digits(mantissa, digits, text)
      last = len(field) - len(POWER_TEXT)
      point = last - digits + 1
      field(last + 1:last + len(POWER_TEXT)) = POWER_TEXT(exponent_of_ten)
      field(point + 1:point + digits - 1) = text(len(text) - digits + 2:len(text))
      field(point:point) = '.'
      field(point - 1:point - 1) = text(len(text) - digits + 1:len(text) - digits + 1)
      if (negative) field(point - 2:point - 2) = '-'
   end subroutine lay_out

   !> The digits of a number at the end of a text.
   pure subroutine put_digits(number, digits, text)
      integer(lp), intent(in) :: number            !< 0 .. 10**digits - 1
      integer, intent(in) :: digits
      character(len=3*EIGHT), intent(out) :: text
      integer(lp) :: upper

      upper = number/TEN_TO(EIGHT)
      call put_eight(int(number - upper*TEN_TO(EIGHT)), text(2*EIGHT + 1:))
      if (digits <= EIGHT + 2) then
         text(2*EIGHT - 1:2*EIGHT) = PAIR(upper)
      else
         call put_eight(int(mod(upper, TEN_TO(EIGHT))), text(EIGHT + 1:2*EIGHT))
         call put_eight(int(upper/TEN_TO(EIGHT)), text(:EIGHT))
      end if
   end subroutine put_digits

   pure subroutine put_eight(number, text)
      integer, intent(in) :: number                !< 0 .. 99999999
      character(len=EIGHT), intent(out) :: text
      integer :: upper, lower

      upper = number/10000
      lower = number - 10000*upper
      text(1:2) = PAIR(upper/100)
      text(3:4) = PAIR(mod(upper, 100))
      text(5:6) = PAIR(lower/100)
      text(7:8) = PAIR(mod(lower, 100))
   end subroutine put_eight

end module atrito_number_text
