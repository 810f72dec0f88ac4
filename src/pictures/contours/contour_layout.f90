!> Where things stand in a contour picture, in pixels: the bodies, a bar of colours beside them or, below wide ones, under them, and
!> two lines about the largest and the least.
module atrito_contour_layout
   use atrito_contour_bar, only: round_step
   use atrito_kinds, only: ip, wp
   use atrito_plot_scripts, only: plots_t, put, put_terminal
   use atrito_plot_text, only: range_t, range_text, span, LF
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: layout_t, make_layout, put_layout, put_bar_place

   type :: layout_t
      type(range_t) :: window(2)                    !< that is shown [L]
      integer(ip) :: n(2) = 1                       !< pixels of the window
      integer(ip) :: left = 0, bottom = 0           !< of the window in the picture
      integer(ip) :: height = 0                     !< of the picture
      logical :: is_wide = .false.                  !< the bar lies under the bodies
   end type layout_t

   integer(ip), parameter :: WIDTH = 1000
   !> Room round the window: with a bar beside it, whose label stands above it, and with one under it.
   integer(ip), parameter :: LEFT = 95, RIGHT(2) = [135_ip, 35_ip], BOTTOM(2) = [128_ip, 238_ip], TOP(2) = [84_ip, 62_ip]
   integer(ip), parameter :: APART(2) = [70_ip, 30_ip] !< the marks of the axes are no nearer
   integer(ip), parameter :: MOST_HEIGHT = 900      !< of the window
   real(wp), parameter :: WIDE = 0.32_wp            !< height over width below which a bar beside the window were too short

contains

   !> Where the parts of a contour picture are, for the window that it shows: the raster as large as there is room, the bar below it
   !> where the window is wide, else beside it.
   pure type(layout_t) function make_layout(window) result(layout)
      type(range_t), intent(in) :: window(2)        !< to be shown, of some length [L]
      real(wp) :: side(2), pixel
      integer :: form
      integer(ip) :: room

      side = [span(window(1)), span(window(2))]
      layout%window = window
      layout%is_wide = side(2) < WIDE*side(1)
      form = merge(2, 1, layout%is_wide)
      room = WIDTH - LEFT - RIGHT(form)
      pixel = max(side(1)/room, side(2)/MOST_HEIGHT)
      layout%n = max(1_ip, nint(side/pixel, ip))
      layout%left = LEFT + (room - layout%n(1))/2
      layout%bottom = BOTTOM(form)
      layout%height = layout%bottom + layout%n(2) + TOP(form)
   end function make_layout

   !> Ranges, terminal, margins and axes. The marks of an axis are so far apart that their numbers do not touch.
   subroutine put_layout(plots, layout)
      type(plots_t), intent(inout) :: plots
      type(layout_t), intent(in) :: layout
      type(string_t) :: tics(2)
      integer :: i

      do i = 1, 2
         tics(i)%s = to_text(round_step(APART(i)*span(layout%window(i))/layout%n(i)), 6)
      end do
      call put(plots, 'set xrange '//range_text(layout%window(1))//LF//'set yrange '//range_text(layout%window(2))//LF// &
               'width = '//to_text(WIDTH)//'.0; height = '//to_text(layout%height)//'.0   # of the picture in pixels'//LF// &
               'across(pixels) = pixels/width'//LF//'up(pixels) = pixels/height')
      call put_terminal(plots, 'int(width),int(height)')
      call put(plots, 'set lmargin at screen across('//to_text(layout%left)//'); set rmargin at screen across('// &
               to_text(layout%left + layout%n(1))//')'//LF//'set bmargin at screen up('//to_text(layout%bottom)// &
               '); set tmargin at screen up('//to_text(layout%bottom + layout%n(2))//')'//LF//'set clip two'//LF// &
               'set border lt 1 lw 1 lc rgb "#A0A0A0"'//LF// &
               'set tics nomirror out scale 0.6 textcolor rgb "black" format "%h"'//LF// &
               'set xtics '//tics(1)%s//'; set ytics '//tics(2)%s//LF//'unset key'//LF// &
               'set xlabel "x [L]"; set ylabel "y [L]"')
   end subroutine put_layout

   !> Place of the bar, and what it is of: above a bar that stands, where long numbers at the bar are not in its way.
   subroutine put_bar_place(plots, layout, what)
      type(plots_t), intent(inout) :: plots
      type(layout_t), intent(in) :: layout
      character(len=*), intent(in) :: what

      if (layout%is_wide) then
         call put(plots, 'set colorbox horizontal user origin screen across('//to_text(layout%left)//'), screen up(138)'// &
                  ' size screen across('//to_text(layout%n(1))//'), screen up(16)'//LF//'set cblabel "'//what//'"')
      else
         call put(plots, 'set colorbox vertical user origin screen across('//to_text(layout%left + layout%n(1) + 22)// &
                  '), screen up('//to_text(layout%bottom)//') size screen across(20), screen up('//to_text(layout%n(2))//')'//LF// &
                  'set label 2 "'//what//'" at screen across('// &
                  to_text(min(WIDTH - 10_ip, layout%left + layout%n(1) + 125))//'), screen up('// &
                  to_text(layout%bottom + layout%n(2) + 14)//') right')
      end if
   end subroutine put_bar_place

end module atrito_contour_layout
