!> The words of gnuplot scripts: strings that hold what a user wrote, numbers, ranges, and the lines that all scripts share.
!>
!> Text of the user stands in single quotes, in which gnuplot replaces nothing, and is drawn `noenhanced`; own text stands in
!> double quotes.
module atrito_plot_text
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_kinds, only: ip, wp
   use atrito_numbers, only: read_real
   use atrito_strings, only: string_t, to_text
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   use atrito_files, only: file_set_t, text_file_t, open_text, put_line, close_text
   use atrito_read_table, only: table_path
   use atrito_plot_files, only: picture_endings
   use atrito_status, only: status_t
   use atrito_table, only: origin_t, CSV_ENDING
   use atrito_utf8, only: utf8_length
   implicit none (type, external)
   private
   public :: range_t, cover, padded, range_text, span
   public :: quoted, cleaned, picture_title, scene_title, put_table, CSV_SEPARATOR, begin_script, end_script, put_terminal, &
             put_plot, put_frame, put_panel, engineering_exponent
   public :: COLOUR, N_COLOURS, GREEK_NU, GREEK_EPSILON, GREEK_RHO, GREEK_DELTA, PLUS_MINUS, TIMES

   !> What a script has to say before it reads comma-separated values.
   character(len=*), parameter :: CSV_SEPARATOR = 'set datafile separator comma'
   !> The palette of Okabe and Ito, made for colour-blind readers, without its yellow, which is too pale for lines.
   integer, parameter :: N_COLOURS = 7
   character(len=7), parameter :: COLOUR(N_COLOURS) = &
                                  ['#0072B2', '#D55E00', '#009E73', '#CC79A7', '#56B4E9', '#E69F00', '#000000']
   !> Letters in UTF-8.
   character(len=2), parameter :: GREEK_NU = char(206)//char(189), GREEK_EPSILON = char(206)//char(181), &
                                  GREEK_RHO = char(207)//char(129), GREEK_DELTA = char(206)//char(180), &
                                  PLUS_MINUS = char(194)//char(177), TIMES = char(195)//char(151)

   integer, parameter :: LONGEST_TITLE = 100        !< characters that fit on a picture's width
   real(wp), parameter :: PADDING = 0.06_wp         !< share of a range that is left free on each side
   real(wp), parameter :: LEAST_PLAIN = 0.05_wp, MOST_PLAIN = 1.0e5_wp   !< largest values told without a power of ten

   !> What an axis shall cover. Empty: low > high.
   type :: range_t
      real(wp) :: low = 1.0_wp, high = -1.0_wp
   end type range_t

contains

   !> Widens a range so that it covers the numbers; those that are none are left out.
   pure subroutine cover(range, values)
      type(range_t), intent(inout) :: range
      real(wp), intent(in) :: values(:)
      integer :: i

      do i = 1, size(values)
         if (.not. ieee_is_finite(values(i))) cycle
         if (range%low > range%high) range = range_t(values(i), values(i))
         range%low = min(range%low, values(i))
         range%high = max(range%high, values(i))
      end do
   end subroutine cover

   !> The length of a range; 0 of an empty one.
   pure real(wp) function span(range)
      type(range_t), intent(in) :: range

      span = max(0.0_wp, range%high - range%low)
   end function span

   !> The range with room on both sides. Nothing to show, or one number only, gives a range all the same: gnuplot complains of
   !> empty ones.
   pure type(range_t) function padded(range)
      type(range_t), intent(in) :: range
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
      type(range_t), intent(in) :: range
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
      character(len=*), intent(in) :: text
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
      character(len=*), intent(in) :: text
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
      type(origin_t), intent(in) :: origin
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
      character(len=*), intent(in) :: deck_path
      type(string_t), intent(in) :: heading(:)      !< lines of *HEADING
      character(len=:), allocatable :: title
      type(origin_t) :: origin

      origin%deck = deck_path(index(deck_path, '/', back=.true.) + 1:)
      origin%heading = heading
      title = picture_title(origin)
   end function scene_title

   !> Tells a script which table it draws: that in the folder above, in the form in which it is there.
   subroutine put_table(set, name, file)
      type(file_set_t), intent(in) :: set           !< of the plots' folder, which is there
      character(len=*), intent(in) :: name          !< of the table
      type(text_file_t), intent(inout) :: file
      character(len=:), allocatable :: path

      path = table_path(set%folder//'/..', name)
      if (path(len(path) - len(CSV_ENDING) + 1:) == CSV_ENDING) call put_line(file, CSV_SEPARATOR)
      call put_line(file, 'table = "..'//path(index(path, '/', back=.true.):)//'"')
   end subroutine put_table

   !> Opens a script in a set of files and writes its first lines: what it is and how to use it.
   subroutine begin_script(set, name, what, file)
      type(file_set_t), intent(inout) :: set
      character(len=*), intent(in) :: name          !< of the script, without .gp
      character(len=*), intent(in) :: what
      type(text_file_t), intent(out) :: file
      character(len=4), allocatable :: endings(:)
      character(len=:), allocatable :: pictures
      integer :: i

      endings = picture_endings(name)
      pictures = name//endings(1)
      do i = 2, size(endings)
         pictures = pictures//' and '//name//endings(i)
      end do
      call open_text(set, name//'.gp', file)
      call put_line(file, '# '//PROGRAM_NAME//' '//PROGRAM_VERSION//': '//what)
      call put_line(file, '# In this folder: gnuplot '//name//'.gp draws '//pictures//' again.')
      call put_line(file, '# The next run removes this file: to keep changes, copy it under another name.')
      call put_line(file, 'reset')
      call put_line(file, 'set encoding utf8')
   end subroutine begin_script

   !> Ends the loop over both kinds of picture, and the script. status: STATUS_FILE when it could not be written.
   subroutine end_script(file, status)
      type(text_file_t), intent(inout) :: file
      type(status_t), intent(out) :: status

      call put_line(file, '}')
      call put_line(file, 'set output')
      call close_text(file, status)
   end subroutine end_script

   !> A command of several lines: curves with commas between them.
   subroutine put_plot(file, curves)
      type(text_file_t), intent(inout) :: file
      type(string_t), intent(in) :: curves(:)
      integer :: i

      do i = 1, size(curves) - 1
         call put_line(file, curves(i)%s//', \')
      end do
      call put_line(file, curves(size(curves))%s)
   end subroutine put_plot

   !> The loop over both kinds of picture; what is drawn follows, then end_script.
   subroutine put_terminal(file, name, size_text)
      type(text_file_t), intent(inout) :: file
      character(len=*), intent(in) :: name          !< of the pictures, without ending
      character(len=*), intent(in) :: size_text     !< width,height in pixels

      call put_line(file, 'do for [kind in "png svg"] {')
      call put_line(file, 'if (kind eq "png") { set terminal pngcairo size '//size_text// &
                    ' font "sans-serif,11" background "white" enhanced')
      call put_line(file, '} else { set terminal svg size '//size_text//' font "sans-serif,15" background "white" enhanced }')
      call put_line(file, 'set output "'//name//'.".kind')
      call put_line(file, 'dot = kind eq "png" ? 1.0 : 0.6')
   end subroutine put_terminal

   !> A column of panels over one axis: places and looks.
   subroutine put_frame(file, panels, range, x_label)
      type(text_file_t), intent(inout) :: file
      integer, intent(in) :: panels
      type(range_t), intent(in) :: range            !< of the axis below
      character(len=*), intent(in) :: x_label       !< a string of gnuplot

      call put_line(file, 'panels = '//to_text(int(panels, ip)))
      call put_line(file, 'height = 120 + 230*panels')
      call put_line(file, 'top(i) = 1 - (60.0 + (i - 1)*230)/height')
      call put_line(file, 'bottom(i) = top(i) - 205.0/height')
      call put_line(file, 'middle(i) = 0.5*top(i) + 0.5*bottom(i)')
      call put_line(file, 'set border 3 lt 1 lw 1 lc rgb "#404040"')
      call put_line(file, 'set tics nomirror out scale 0.6 textcolor rgb "black"')
      call put_line(file, 'set grid lt 1 lw 1 lc rgb "#E0E0E0"')
      call put_line(file, 'set xzeroaxis lt 1 lw 1 lc rgb "#808080"')
      call put_line(file, 'set format y "%h"')
      call put_line(file, 'set lmargin at screen 0.13')
      call put_line(file, 'right = 0.78')
      call put_line(file, 'set xrange '//range_text(range))
      call put_line(file, 'axis_label = '//x_label)
      call put_line(file, 'x_format = "%h"')
   end subroutine put_frame

   !> Goes to a panel, whose values are to be divided by `unit`. Its label stands at the same place in all panels, its legend to
   !> the right of it.
   subroutine put_panel(file, place, name, dimension, range)
      type(text_file_t), intent(inout) :: file
      integer, intent(in) :: place                  !< 1 the uppermost
      character(len=*), intent(in) :: name, dimension
      type(range_t), intent(in) :: range            !< of the values
      type(range_t) :: window
      character(len=:), allocatable :: i, power
      integer :: exponent_of_ten

      i = to_text(int(place, ip))
      window = padded(range)
      exponent_of_ten = engineering_exponent(range)
      power = ''
      if (exponent_of_ten /= 0) power = '10^{'//to_text(int(exponent_of_ten, ip))//'} '
      call put_line(file, 'set rmargin at screen right; set tmargin at screen top('//i//'); set bmargin at screen bottom('//i//')')
      call put_line(file, 'set key noautotitle at screen right + 0.015, screen top('//i// &
                    ') left top Left reverse samplen 2.5 spacing 1.15')
      call put_line(file, 'set label 1 "'//name//' ['//power//dimension//']" at screen 0.03, screen middle('//i// &
                    ') center rotate by 90')
      call put_line(file, 'if ('//i//' == panels) { set format x x_format; set xlabel axis_label noenhanced } '// &
                    'else { set format x ""; unset xlabel }')
      call put_line(file, 'unit = 1e'//to_text(int(exponent_of_ten, ip)))
      call put_line(file, 'set yrange ['//to_text(window%low, 8)//'/unit:'//to_text(window%high, 8)//'/unit]')
   end subroutine put_panel

   !> The power of thousand by which numbers of a range are told, so that the marks of an axis are short; 0 for handy numbers.
   pure integer function engineering_exponent(range) result(e)
      type(range_t), intent(in) :: range
      real(wp) :: largest

      e = 0
      largest = max(abs(range%low), abs(range%high))
      if (range%low > range%high .or. largest < sqrt(tiny(largest))) return
      if (largest < LEAST_PLAIN .or. largest >= MOST_PLAIN) e = 3*floor(log10(largest)/3.0_wp)
   end function engineering_exponent

end module atrito_plot_text
