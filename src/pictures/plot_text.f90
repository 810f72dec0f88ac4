!> The words of gnuplot scripts: strings that hold what a user wrote, numbers and ranges.
!>
!> Text of the user stands in single quotes, in which gnuplot replaces nothing, and is drawn `noenhanced`; own text stands in
!> double quotes.
module atrito_plot_text
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_kinds, only: ip, wp
   use atrito_numbers, only: read_real
   use atrito_strings, only: string_t, to_text
   use atrito_table, only: origin_t
   use atrito_utf8, only: utf8_length
   implicit none (type, external)
   private
   public :: range_t, cover, padded, range_text, span, range_of
   public :: quoted, cleaned, picture_title, scene_title, engineering_exponent, power_text, colour_styles, evenly, round_step
   public :: log_axis
   public :: LF, COLOUR, N_COLOURS, DASH, MOST_STYLES, GREEK_NU, GREEK_EPSILON, GREEK_RHO, GREEK_DELTA, PLUS_MINUS, TIMES

   character(len=1), parameter :: LF = achar(10)    !< between lines that are put together
   !> The palette of Okabe and Ito, made for colour-blind readers, without its yellow, which is too pale for lines.
   integer(ip), parameter :: N_COLOURS = 7
   character(len=7), parameter :: COLOUR(N_COLOURS) = ['#0072B2', '#D55E00', '#009E73', '#CC79A7', '#56B4E9', '#E69F00', '#000000']
   integer(ip), parameter :: MOST_STYLES = 3*N_COLOURS  !< colours that can be told apart
   !> Kinds of line that can be told apart in grey, as gnuplot's dt has them.
   character(len=13), parameter :: DASH(10) = [character(len=13) :: '1', '(9,3)', '(3,3)', '(9,3,2,3)', '(18,4)', '(9,3,2,3,2,3)', &
                                                                                            '(2,5)', '(18,4,5,4)', '(5,2)', '(1,2)']
   !> Letters in UTF-8.
   character(len=2), parameter :: GREEK_NU = char(206)//char(189), GREEK_EPSILON = char(206)//char(181), &
                                  GREEK_RHO = char(207)//char(129), GREEK_DELTA = char(206)//char(180), &
                                  PLUS_MINUS = char(194)//char(177), TIMES = char(195)//char(151)

   integer, parameter :: LONGEST_TITLE = 100        !< characters that fit on a picture's width
   real(wp), parameter :: PADDING = 0.06_wp         !< share of a range that is left free on each side
   real(wp), parameter :: LEAST_PLAIN = 0.05_wp, MOST_PLAIN = 1.0e5_wp   !< largest values that are written without a power of ten

   !> What an axis shall cover. Empty: low > high.
   type :: range_t
      real(wp) :: low = 1.0_wp, high = -1.0_wp      !< of its numbers
   end type range_t

contains

   !> Widens a range so that it covers the numbers; those that are none are left out.
   pure subroutine cover(range, values)
      type(range_t), intent(inout) :: range         !< covers the numbers, too
      real(wp), intent(in) :: values(:)             !< finite ones count
      integer :: i

      do i = 1, size(values)
         if (.not. ieee_is_finite(values(i))) cycle
         if (range%low > range%high) range = range_t(values(i), values(i))
         range%low = min(range%low, values(i))
         range%high = max(range%high, values(i))
      end do
   end subroutine cover

   !> The range of some numbers.
   pure type(range_t) function range_of(values)
      real(wp), intent(in) :: values(:)             !< finite ones count

      call cover(range_of, values)
   end function range_of

   !> The length of a range; 0 of an empty one.
   pure real(wp) function span(range)
      type(range_t), intent(in) :: range            !< may be empty

      span = max(0.0_wp, range%high - range%low)
   end function span

   !> The range with room on both sides. Nothing to show, or one number only, gives a range all the same: gnuplot complains of
   !> empty ones.
   pure type(range_t) function padded(range)
      type(range_t), intent(in) :: range            !< may be empty
      real(wp) :: room, largest

      padded = range
      if (range%low > range%high) padded = range_t(0.0_wp, 0.0_wp)
      largest = max(abs(padded%low), abs(padded%high))
      room = PADDING*(padded%high - padded%low)
      if (room <= 1.0e-9_wp*largest) room = 0.5_wp*largest
      if (largest < sqrt(tiny(largest))) room = 1.0_wp
      padded = range_t(padded%low - room, padded%high + room)
   end function padded

   !> [low:high]
   pure function range_text(range) result(text)
      type(range_t), intent(in) :: range            !< not empty
      character(len=:), allocatable :: text

      text = '['//outward(range%low, -1.0_wp)//':'//outward(range%high, 1.0_wp)//']'
   end function range_text

   !> The end of a range in eight digits, none of which is rounded inwards: a point at the end is drawn.
   pure function outward(value, way) result(text)
      real(wp), intent(in) :: value, way            !< -1: the lower end, 1: the upper one
      character(len=:), allocatable :: text
      real(wp) :: shown
      integer :: outcome

      text = to_text(value, 8)
      call read_real(text, shown, outcome)
      if (way*(value - shown) > 0.0_wp) text = to_text(value + way*1.0e-7_wp*abs(value), 8)
   end function outward

   !> What a user wrote as a string of gnuplot, or of the shell.
   pure function quoted(text, quote) result(string)
      character(len=*), intent(in) :: text              !< without its quotes
      character(len=*), intent(in), optional :: quote   !< what stands for a quote within it; default: two of them
      character(len=:), allocatable :: string
      integer :: i

      string = ''''
      do i = 1, len(text)
         if (text(i:i) /= '''') then
            string = string//text(i:i)
         else if (present(quote)) then
            string = string//quote
         else
            string = string//''''''
         end if
      end do
      string = string//''''
   end function quoted

   !> Text that can be drawn: bytes that are no UTF-8 and control characters are replaced, and what is too long is cut.
   pure function cleaned(text, most) result(clean)
      character(len=*), intent(in) :: text          !< as the user wrote it
      integer, intent(in) :: most                   !< characters
      character(len=:), allocatable :: clean
      integer :: i, n, bytes

      clean = ''
      i = 1
      n = 0
      do while (i <= len(text))
         if (n == most) then
            clean = clean//'..'
            return
         end if
         bytes = utf8_length(text(i:))
         if (bytes == 0) then
            clean = clean//'?'
         else if (bytes == 1 .and. (iachar(text(i:i)) < 32 .or. iachar(text(i:i)) == 127)) then
            clean = clean//' '
         else
            clean = clean//text(i:i + bytes - 1)
         end if
         i = i + max(1, bytes)
         n = n + 1
      end do
   end function cleaned

   !> The first line of a picture's title: the deck's, and whether to believe the picture.
   pure function picture_title(origin) result(title)
      type(origin_t), intent(in) :: origin          !< deck, heading and ending of the run
      character(len=:), allocatable :: title

      title = origin%deck
      if (size(origin%heading) > 0) then
         if (len_trim(origin%heading(1)%s) > 0) title = trim(origin%heading(1)%s)
      end if
      if (allocated(origin%ending)) then
         title = 'NOT CONVERGED, ended early: '//title
      else if (origin%not_converged) then
         title = 'NOT CONVERGED, last iterate: '//title
      end if
      title = cleaned(title, LONGEST_TITLE)
   end function picture_title

   !> The first line of the title of a picture of a scene that is not solved.
   pure function scene_title(deck_path, heading) result(title)
      character(len=*), intent(in) :: deck_path     !< as the user wrote it
      type(string_t), intent(in) :: heading(:)      !< lines of *HEADING
      character(len=:), allocatable :: title
      type(origin_t) :: origin

      origin%deck = deck_path(index(deck_path, '/', back=.true.) + 1:)
      origin%heading = heading
      title = picture_title(origin)
   end function scene_title

   !> The power of thousand by which numbers of a range are divided, so that the marks of an axis are short; 0 for handy numbers.
   pure integer(ip) function engineering_exponent(range) result(e)
      type(range_t), intent(in) :: range            !< of the values on the axis; may be empty
      real(wp) :: largest

      e = 0
      largest = max(abs(range%low), abs(range%high))
      if (range%low > range%high .or. largest < sqrt(tiny(largest))) return
      if (largest < LEAST_PLAIN .or. largest >= MOST_PLAIN) e = 3*floor(log10(largest)/3.0_wp)
   end function engineering_exponent

   !> The power of ten in the label of an axis: `10^{3} `; nothing for 0.
   pure function power_text(power) result(text)
      integer(ip), intent(in) :: power              !< a multiple of 3, or 0
      character(len=:), allocatable :: text

      text = ''
      if (power /= 0) text = '10^{'//to_text(power)//'} '
   end function power_text

   !> The line styles from 1 on, one a colour: lines of a script.
   pure function colour_styles(looks, n) result(text)
      character(len=*), intent(in) :: looks         !< what they have beside it, with a blank before it
      integer(ip), intent(in), optional :: n        !< how many, MOST_STYLES at the most; default: N_COLOURS
      character(len=:), allocatable :: text
      integer(ip) :: i, last
      integer :: parts(3)
      character(len=7) :: colour_text

      last = N_COLOURS
      if (present(n)) last = min(n, MOST_STYLES)
      text = ''
      do i = 1, last
         ! The colour of a style: those of the palette, then they with half of their light, then half way to white.
         colour_text = COLOUR(mod(i - 1, N_COLOURS) + 1)
         if (i > N_COLOURS) then
            read (colour_text(2:), '(3z2)') parts
            parts = merge(parts/2, (parts + 255)/2, i <= 2*N_COLOURS)
            if (i == 2*N_COLOURS) parts = 90              ! half of black is black
            write (colour_text(2:), '(3z2.2)') parts
         end if
         text = text//LF//'set style line '//to_text(i)//' lt 1'//looks//' lc rgb "'//colour_text//'"'
      end do
      text = text(2:)
   end function colour_styles

   !> Range and numbers of a logarithmic axis, for values that may lie within a decade: 1, 2, 5, 10, ..., of many the powers of ten.
   pure function log_axis(axis, range, most) result(text)
      character(len=1), intent(in) :: axis          !< x or y
      type(range_t), intent(in) :: range            !< of the values, which are positive
      integer(ip), intent(in) :: most               !< numbers that have room
      character(len=:), allocatable :: text
      integer(ip) :: n, power, i, stride
      integer, parameter :: STEPS(3) = [1, 2, 5]

      text = ''
      n = 0
      do power = floor(log10(range%low) - 0.2_wp, ip), ceiling(log10(range%high) + 0.2_wp, ip)
         do i = 1, 3
            if (STEPS(i)*10.0_wp**power < range%low/1.5_wp .or. STEPS(i)*10.0_wp**power > range%high*1.5_wp) cycle
            n = n + 1
            text = text//', '//to_text(STEPS(i)*10.0_wp**power, 6)
         end do
      end do
      text = 'set '//axis//'range ['//to_text(range%low/1.5_wp, 6)//':'//to_text(range%high*1.5_wp, 6)//']; set '// &
             axis//'tics ('//text(min(3, len(text) + 1):)//')'
      if (n <= most) return
      stride = 1 + int(log10(range%high/range%low)/most, ip)
      text = text(:index(text, '(') - 1)//to_text(10.0_wp**ceiling(log10(range%low/1.5_wp)))//', '//to_text(10.0_wp**stride)
   end function log_axis

   !> The first number of the series 1, 2, 5, 10, ... that is not less.
   pure real(wp) function round_step(least) result(step)
      real(wp), intent(in) :: least                 !< > 0
      real(wp) :: power

      power = 10.0_wp**floor(log10(least))
      step = 10.0_wp*power
      if (least <= 5.0_wp*power) step = 5.0_wp*power
      if (least <= 2.0_wp*power) step = 2.0_wp*power
      if (least <= power) step = power
   end function round_step

   !> 1 to n, or evenly some of them, the first and the last among these.
   pure function evenly(n, most) result(list)
      integer(ip), intent(in) :: n, most            !< most > 1
      integer(ip), allocatable :: list(:)
      integer(ip) :: i, m

      m = min(n, most)
      list = [(i, i=1, m)]
      if (m < n) list = [(1_ip + nint(real(i - 1, wp)*real(n - 1, wp)/real(m - 1, wp), ip), i=1, m)]
   end function evenly

end module atrito_plot_text
