!> Numbers to text in fields of a fixed width: what the tables are made of.
!>
!> A table of half a million rows holds millions of numbers, too many for one internal write each. The digits are found by
!> multiplication with a power of ten in integers of 128 bits; the rare number that this leaves undecided goes through the
!> run-time library, so that every number is rounded correctly and 17 digits give back the same double.
module atrito_number_text
   use atrito_kinds, only: ip, lp, wp, HUGE_REAL, is_nan
   use atrito_numbers, only: POWER, POWER_SHIFT, MOST_POWER, POWER_BITS, XP
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
   integer, parameter :: ZERO = iachar('0')
   integer :: i, j
   integer(lp), parameter :: TEN_TO(0:MOST_DIGITS) = [(10_lp**i, i=0, MOST_DIGITS)]
   character(len=2), parameter :: PAIR(0:99) = [((achar(ZERO + i)//achar(ZERO + j), j=0, 9), i=0, 9)]
   character(len=4), parameter :: QUAD(0:9999) = [((PAIR(i)//PAIR(j), j=0, 99), i=0, 99)]
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
      integer(lp) :: least, bits, before
      integer :: from, to                          !< first and last, which `lines` might change for all the compiler knows
      integer(ip) :: i, latest                     !< of the rows, that of the number that was written last

      least = max(bits_of(smallest), 1_lp)
      before = 0_lp
      from = first
      to = last
      latest = 1
      do i = 1, size(x, kind=ip)
         bits = transfer(x(i), 0_lp)
         if (iand(bits, MAGNITUDE) < least) then
            lines(i) (to:to) = '0'
         else if (bits == before) then
            lines(i) (from:to) = lines(latest) (from:to)
         else
            latest = i
            call put_real(x(i), digits, lines(i) (from:to))
         end if
         before = bits
      end do
   end subroutine put_reals

   !> Writes a column of integers: one to a field, which is blank, of each line.
   pure subroutine put_integers(list, first, last, lines)
      integer(ip), intent(in) :: list(:)           !< (n) any integers
      integer, intent(in) :: first, last           !< the field, wide enough for each
      character(len=*), intent(inout) :: lines(:)  !< (size(list))
      integer(ip) :: i

      do i = 1, size(list, kind=ip)
         if (list(i) >= 0 .and. list(i) <= 9) then
            lines(i) (last:last) = achar(ZERO + list(i))
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
      do                                                     ! a second time where the exponent was too small
         k = digits - 1 - exponent_of_ten
         upper = int(shiftr(int(significand, XP)*int(POWER(k), XP), POWER_BITS), lp)
         shift = -binary - POWER_SHIFT(k)
         half = shiftl(1_lp, shift - 1)
         decided = iand(upper - half + DOUBT, 2_lp*half - 1_lp) > 2_lp*DOUBT
         mantissa = shiftr(shiftr(upper, shift - 1) + 1_lp, 1)
         if (mantissa <= TEN_TO(digits)) exit
         exponent_of_ten = exponent_of_ten + 1
      end do
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
      character(len=1) :: first
      integer(lp) :: rest, upper
      integer :: lower, middle, last, point, i

      last = len(field) - len(POWER_TEXT)
      point = last - digits + 1
      field(last + 1:last + len(POWER_TEXT)) = POWER_TEXT(exponent_of_ten)
      if (digits == DEFAULT_DIGITS) then
         upper = mantissa/TEN_TO(8)
         lower = int(mantissa - upper*TEN_TO(8))
         middle = lower/size(QUAD)
         field(last - 3:last) = QUAD(lower - middle*size(QUAD))
         field(last - 7:last - 4) = QUAD(middle)
         field(last - 8:last - 8) = PAIR(upper) (2:2)
         first = PAIR(upper) (1:1)
      else
         rest = mantissa
         do i = last, point + 1, -1
            field(i:i) = achar(ZERO + int(mod(rest, 10_lp)))
            rest = rest/10_lp
         end do
         first = achar(ZERO + int(rest))
      end if
      field(point:point) = '.'
      field(point - 1:point - 1) = first
      if (negative) field(point - 2:point - 2) = '-'
   end subroutine lay_out

end module atrito_number_text
