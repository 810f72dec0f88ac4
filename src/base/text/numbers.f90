!> Strict reading of numbers: a deck never contains a guess.
!>
!> Accepted: [+-]digits[.digits][e|E|d|D[+-]digits], `1.` and `.5`. Everything that a list-directed read would bend into a
!> number (1,5  3*2  2/3  1+5  nan  inf) is refused, and so is what does not fit into a double (1e999).
module atrito_numbers
   use atrito_kinds, only: ip, lp, wp
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_real, read_integer, exact_text, NUMBER_OK, NUMBER_MALFORMED, NUMBER_TOO_LARGE, NUMBER_NOT_INTEGER
   public :: POWER, POWER_SHIFT, MOST_POWER, POWER_BITS, XP

   integer, parameter :: NUMBER_OK = 0
   integer, parameter :: NUMBER_MALFORMED = 1      !< not of the form above
   integer, parameter :: NUMBER_TOO_LARGE = 2      !< overflows
   integer, parameter :: NUMBER_NOT_INTEGER = 3    !< a real where an integer is wanted

   !> Powers of ten that a double holds exactly.
   integer, parameter :: EXACT_POWERS = 22
   real(wp), parameter :: EXACT_POWER(0:EXACT_POWERS) = [1e0_wp, 1e1_wp, 1e2_wp, 1e3_wp, 1e4_wp, 1e5_wp, 1e6_wp, 1e7_wp, 1e8_wp, &
        1e9_wp, 1e10_wp, 1e11_wp, 1e12_wp, 1e13_wp, 1e14_wp, 1e15_wp, 1e16_wp, 1e17_wp, 1e18_wp, 1e19_wp, 1e20_wp, 1e21_wp, 1e22_wp]
   !> Largest count of digits whose integer a double holds exactly.
   integer, parameter :: EXACT_DIGITS = 15
   !> Largest count of digits that are kept.
   integer, parameter :: KEPT_DIGITS = 18
   !> Bits of a double.
   integer, parameter :: FRACTION_BITS = 53
   !> A number with more digits before its point overflows for certain.
   integer, parameter :: LARGEST_POWER = 309
   !> First 17 digits of the largest double, 1.7976931348623157e308; a number that begins so does not overflow yet.
   integer(lp), parameter :: LARGEST_DIGITS = 17976931348623157_lp

   !> Integers of 128 bits: the product of two of 63. Of a product with a power of ten the upper 63 bits,
   !> int(shiftr(int(a, XP)*int(POWER(k), XP), POWER_BITS), lp), are right but for one and a half of their last: a half from the
   !> rounding of POWER, one from what is cut off.
   integer, parameter :: XP = selected_int_kind(38)
   integer, parameter :: POWER_BITS = 63
   !> 10**k = POWER(k) 2**POWER_SHIFT(k), 2**62 <= POWER(k) < 2**63, rounded; exact for 0 <= k <= 27.
   integer, parameter :: MOST_POWER = 44
   integer(lp), parameter :: POWER(-MOST_POWER:MOST_POWER) = [ &
           8227522786606030211_lp, 5142201741628768882_lp, 6427752177035961102_lp, 8034690221294951378_lp, 5021681388309344611_lp, &
           6277101735386680764_lp, 7846377169233350955_lp, 4903985730770844347_lp, 6129982163463555433_lp, 7662477704329444292_lp, &
           4789048565205902682_lp, 5986310706507378353_lp, 7482888383134222941_lp, 4676805239458889338_lp, 5846006549323611673_lp, &
           7307508186654514591_lp, 9134385233318143239_lp, 5708990770823839524_lp, 7136238463529799405_lp, 8920298079412249257_lp, &
           5575186299632655785_lp, 6968982874540819732_lp, 8711228593176024665_lp, 5444517870735015415_lp, 6805647338418769269_lp, &
           8507059173023461587_lp, 5316911983139663492_lp, 6646139978924579365_lp, 8307674973655724206_lp, 5192296858534827629_lp, &
           6490371073168534536_lp, 8112963841460668170_lp, 5070602400912917606_lp, 6338253001141147007_lp, 7922816251426433759_lp, &
           4951760157141521100_lp, 6189700196426901374_lp, 7737125245533626718_lp, 4835703278458516699_lp, 6044629098073145874_lp, &
           7555786372591432342_lp, 4722366482869645214_lp, 5902958103587056517_lp, 7378697629483820646_lp, 4611686018427387904_lp, &
           5764607523034234880_lp, 7205759403792793600_lp, 9007199254740992000_lp, 5629499534213120000_lp, 7036874417766400000_lp, &
           8796093022208000000_lp, 5497558138880000000_lp, 6871947673600000000_lp, 8589934592000000000_lp, 5368709120000000000_lp, &
           6710886400000000000_lp, 8388608000000000000_lp, 5242880000000000000_lp, 6553600000000000000_lp, 8192000000000000000_lp, &
           5120000000000000000_lp, 6400000000000000000_lp, 8000000000000000000_lp, 5000000000000000000_lp, 6250000000000000000_lp, &
           7812500000000000000_lp, 4882812500000000000_lp, 6103515625000000000_lp, 7629394531250000000_lp, 4768371582031250000_lp, &
           5960464477539062500_lp, 7450580596923828125_lp, 4656612873077392578_lp, 5820766091346740723_lp, 7275957614183425903_lp, &
           9094947017729282379_lp, 5684341886080801487_lp, 7105427357601001859_lp, 8881784197001252323_lp, 5551115123125782702_lp, &
           6938893903907228378_lp, 8673617379884035472_lp, 5421010862427522170_lp, 6776263578034402713_lp, 8470329472543003391_lp, &
                             5293955920339377119_lp, 6617444900424221399_lp, 8271806125530276749_lp, 5169878828456422968_lp]

   !> floor(k log2(10)) - 62.
   integer :: k
   integer, parameter :: POWER_SHIFT(-MOST_POWER:MOST_POWER) = [(shifta(k*217706, 16) - POWER_BITS + 1, k=-MOST_POWER, MOST_POWER)]

contains

   !> Reads a real; the nearest double, as the compiler would. `outcome` is one of NUMBER_*.
   pure subroutine read_real(text, value, outcome)
      character(len=*), intent(in) :: text !< without blanks round it
      real(wp), intent(out) :: value       !< 0 where the outcome is not NUMBER_OK
      integer, intent(out) :: outcome      !< NUMBER_OK, _MALFORMED or _TOO_LARGE
      integer(lp) :: mantissa
      integer :: digits, exponent, ios
      logical :: negative, whole, decided
      character(len=24) :: form

      value = 0.0_wp
      call scan_number(text, negative, mantissa, digits, exponent, whole, outcome)
      if (outcome /= NUMBER_OK) return
      if (mantissa == 0_lp) return
      if (digits <= EXACT_DIGITS .and. abs(exponent) <= EXACT_POWERS) then
         ! one correctly rounded operation on two exact numbers
         if (exponent >= 0) then
            value = real(mantissa, wp)*EXACT_POWER(exponent)
         else
            value = real(mantissa, wp)/EXACT_POWER(-exponent)
         end if
         if (negative) value = -value
      else if (digits + exponent > LARGEST_POWER) then
         outcome = NUMBER_TOO_LARGE
      else if (digits + exponent == LARGEST_POWER .and. first_digits(text) > LARGEST_DIGITS) then
         outcome = NUMBER_TOO_LARGE      ! known before it is read: reading would raise the exception
      else
         call nearest_real(mantissa, digits, exponent, value, decided)
         if (negative) value = -value
         ! Many digits or a large exponent: the run-time library rounds correctly; the form was checked before.
         if (.not. decided) then
            write (form, '("(f",i0,".0)")') len(text)
            read (text, form, iostat=ios) value
            outcome = NUMBER_OK
            if (ios /= 0) then
               outcome = NUMBER_TOO_LARGE
            else if (abs(value) > huge(value)) then
               outcome = NUMBER_TOO_LARGE
            end if
            if (outcome /= NUMBER_OK) value = 0.0_wp
         end if
      end if
   end subroutine read_real

   !> The double nearest to mantissa 10**exponent: of the product, in integers of 63 bits, the upper bits are rounded to those of a
   !> double. decided is false where the rest of it, with what is wrong with it, could change the outcome.
   pure subroutine nearest_real(mantissa, digits, exponent, value, decided)
      integer(lp), intent(in) :: mantissa                !< > 0
      integer, intent(in) :: digits, exponent
      real(wp), intent(out) :: value
      logical, intent(out) :: decided
      integer(lp), parameter :: DOUBT = 2_lp             !< of the upper bits
      integer(lp) :: upper, half
      integer :: up, down

      value = 0.0_wp
      decided = digits <= KEPT_DIGITS .and. abs(exponent) <= MOST_POWER
      if (.not. decided) return
      up = leadz(mantissa) - 1
      upper = int(shiftr(int(shiftl(mantissa, up), XP)*int(POWER(exponent), XP), POWER_BITS), lp)
      down = POWER_BITS - FRACTION_BITS - (leadz(upper) - 1)
      half = shiftl(1_lp, down - 1)
      decided = abs(iand(upper, 2_lp*half - 1_lp) - half) > DOUBT
      value = scale(real(shiftr(shiftr(upper, down - 1) + 1_lp, 1), wp), down + POWER_BITS + POWER_SHIFT(exponent) - up)
   end subroutine nearest_real

   !> Takes a number apart. `exponent` is that of the mantissa read as an integer; digits counts without leading zeros.
   pure subroutine scan_number(text, negative, mantissa, digits, exponent, whole, outcome)
      character(len=*), intent(in) :: text
      logical, intent(out) :: negative
      integer(lp), intent(out) :: mantissa               !< of more than KEPT_DIGITS their first ones
      integer, intent(out) :: digits, exponent
      logical, intent(out) :: whole                      !< neither point nor exponent
      integer, intent(out) :: outcome
      integer :: i, seen, power_of_ten, d

      mantissa = 0_lp
      digits = 0
      exponent = 0
      seen = 0
      outcome = NUMBER_MALFORMED
      i = 1
      negative = .false.
      whole = .false.
      if (len(text) == 0) return
      if (text(1:1) == '+' .or. text(1:1) == '-') then
         negative = text(1:1) == '-'
         i = 2
      end if
      call take_digits(text, i, mantissa, digits, seen)
      whole = i > len(text)
      if (i <= len(text)) then
         if (text(i:i) == '.') then
            i = i + 1
            d = i
            call take_digits(text, i, mantissa, digits, seen)
            exponent = d - i
         end if
      end if
      if (seen == 0) return
      if (i <= len(text)) then
         if (scan(text(i:i), 'eEdD') == 0) return
         call take_exponent(text(i + 1:), power_of_ten, outcome)
         if (outcome /= NUMBER_OK) return
         exponent = exponent + power_of_ten
      end if
      outcome = NUMBER_OK
   end subroutine scan_number

   pure subroutine take_digits(text, i, mantissa, digits, seen)
      character(len=*), intent(in) :: text
      integer, intent(inout) :: i, digits, seen
      integer(lp), intent(inout) :: mantissa
      integer :: d

      do while (i <= len(text))
         d = iachar(text(i:i)) - iachar('0')
         if (d < 0 .or. d > 9) exit
         if (digits > 0 .or. d > 0) digits = digits + 1
         if (digits <= KEPT_DIGITS) mantissa = 10_lp*mantissa + int(d, lp)
         seen = seen + 1
         i = i + 1
      end do
   end subroutine take_digits

   pure subroutine take_exponent(text, exponent, outcome)
      character(len=*), intent(in) :: text
      integer, intent(out) :: exponent, outcome
      integer :: i, first, d

      outcome = NUMBER_MALFORMED
      exponent = 0
      first = 1
      if (len(text) == 0) return
      if (text(1:1) == '+' .or. text(1:1) == '-') first = 2
      if (first > len(text)) return
      do i = first, len(text)
         d = iachar(text(i:i)) - iachar('0')
         if (d < 0 .or. d > 9) return
         if (exponent < 100000) exponent = 10*exponent + d
      end do
      if (text(1:1) == '-') exponent = -exponent
      outcome = NUMBER_OK
   end subroutine take_exponent

   !> The first 17 digits from the first that is not zero, as an integer.
   pure integer(lp) function first_digits(text) result(value)
      character(len=*), intent(in) :: text
      integer :: i, d, n

      value = 0_lp
      n = 0
      do i = 1, len(text)
         if (scan(text(i:i), 'eEdD') > 0) exit
         d = iachar(text(i:i)) - iachar('0')
         if (d < 0 .or. d > 9 .or. n == 17) cycle
         if (n > 0 .or. d > 0) n = n + 1
         value = 10_lp*value + int(d, lp)
      end do
      value = value*10_lp**(17 - n)
   end function first_digits

   !> The shortest text of a real that gives the same double back: 0.1, not 0.10000000000000001.
   pure function exact_text(x) result(text)
      real(wp), intent(in) :: x                          !< finite
      character(len=:), allocatable :: text
      integer, parameter :: ALL_DIGITS = 17              !< so many always do
      real(wp) :: again
      integer :: n, outcome
      logical :: found

      call find_decimal(x, text, found)
      if (found) return
      do n = EXACT_DIGITS + 1, ALL_DIGITS
         text = to_text(x, n)
         call read_real(text, again, outcome)
         if (outcome == NUMBER_OK .and. abs(again - x) <= 0.0_wp) return
      end do
   end function exact_text

   !> |x| as an integer of few digits over a power of ten, which read_real divides in the same way.
   pure subroutine find_decimal(x, text, found)
      real(wp), intent(in) :: x
      character(len=:), allocatable, intent(out) :: text
      logical, intent(out) :: found
      real(wp), parameter :: LEAST_FIXED = 1.0e-3_wp     !< smaller ones have an exponent
      real(wp) :: mantissa
      integer :: places, n

      found = .false.
      mantissa = 0.0_wp
      do places = 0, EXACT_POWERS
         mantissa = abs(x)*EXACT_POWER(places)
         if (mantissa >= EXACT_POWER(EXACT_DIGITS)) return
         mantissa = anint(mantissa)
         found = abs(mantissa/EXACT_POWER(places) - abs(x)) <= 0.0_wp
         if (found) exit
      end do
      if (.not. found) return
      text = to_text(int(mantissa, lp))
      n = len(text)
      if (places > 0 .and. abs(x) < LEAST_FIXED) then
         if (n > 1) text = text(1:1)//'.'//text(2:)
         text = text//'e-'//to_text(places + 1 - n)
      else if (places > 0) then
         if (n <= places) text = repeat('0', places + 1 - n)//text
         text = text(:len(text) - places)//'.'//text(len(text) - places + 1:)
      end if
      if (x < 0.0_wp) text = '-'//text
   end subroutine find_decimal

   !> Reads an integer; `outcome` is one of NUMBER_*.
   pure subroutine read_integer(text, value, outcome)
      character(len=*), intent(in) :: text !< without blanks round it
      integer(ip), intent(out) :: value    !< 0 where the outcome is not NUMBER_OK
      integer, intent(out) :: outcome      !< any of NUMBER_*
      integer(lp) :: mantissa
      integer :: digits, exponent
      logical :: negative, whole

      value = 0_ip
      call scan_number(text, negative, mantissa, digits, exponent, whole, outcome)
      if (outcome /= NUMBER_OK) return
      if (.not. whole) then
         outcome = NUMBER_NOT_INTEGER
      else if (digits > 10 .or. mantissa > int(huge(value), lp)) then
         outcome = NUMBER_TOO_LARGE
      else
         value = int(mantissa, ip)
         if (negative) value = -value
      end if
   end subroutine read_integer

end module atrito_numbers
