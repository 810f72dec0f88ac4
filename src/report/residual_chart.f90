!> A drawing of the residuals of iterations.tab on a logarithmic axis, a polyline an increment: lines of SVG within the page.
module atrito_residual_chart
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_kinds, only: ip, wp
   use atrito_page, only: page_t, add_line
   use atrito_read_table, only: table_file_t, find_column
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: add_residual_chart

   real(wp), parameter :: LEFT = 70.0_wp, RIGHT = 700.0_wp, TOP = 16.0_wp, BOTTOM = 220.0_wp   !< of the frame, of 720 by 270
   real(wp), parameter :: LEAST = 1.0e-16_wp        !< drawn instead of less: round-off
   integer, parameter :: MOST_POINTS = 600          !< that can be seen one by one
   integer, parameter :: MOST_DOTS = 80
   integer, parameter :: MOST_MARKS = 8             !< of the axis

   !> What is drawn: places of the rows and their residuals as powers of ten.
   type :: chart_t
      integer(ip), allocatable :: row(:)            !< rows of the table
      logical, allocatable :: begins(:)             !< an increment, with its curve
      real(wp), allocatable :: power(:)             !< log10 of the residual
      integer(ip) :: n_rows = 0                     !< of the table, also those without a residual
      integer :: low = 0, high = 1                  !< powers of the frame
   end type chart_t

contains

   !> Adds the drawing; nothing where there are no two residuals.
   subroutine add_residual_chart(page, iterations)
      type(page_t), intent(inout) :: page           !< gets lines of SVG
      type(table_file_t), intent(in) :: iterations  !< iterations.tab
      type(chart_t) :: chart
      integer :: power, stride, i
      character(len=:), allocatable :: path, x, y

      call collect(iterations, chart)
      if (size(chart%row) < 2) return
      call add_line(page, '<div class="scroll" tabindex="0" role="region" aria-label="residual over linear solves">')
      call add_line(page, '<svg class="chart" viewBox="0 0 720 270" role="img" aria-label="residual over '// &
                    to_text(chart%n_rows)//' linear solves, from '//to_text(10.0_wp**chart%power(1), 2)//' to '// &
                    to_text(10.0_wp**chart%power(size(chart%power)), 2)//'">')
      ! A line and a label every few powers of ten, and the ends of the axis below.
      stride = (chart%high - chart%low)/MOST_MARKS + 1
      do power = chart%low, chart%high, stride
         y = place(height(chart, real(power, wp)))
         call add_line(page, '<path class="grid" d="M'//place(LEFT)//' '//y//'H'//place(RIGHT)//'"/>')
         call add_line(page, '<text x="62" y="'//y//'" dy="4" text-anchor="end">1e'//to_text(int(power, ip))//'</text>')
      end do
      call add_line(page, '<text x="'//place(LEFT)//'" y="240" text-anchor="middle">1</text>')
      call add_line(page, '<text x="'//place(RIGHT)//'" y="240" text-anchor="middle">'//to_text(chart%n_rows)//'</text>')
      ! A line an increment, and dots where they are few.
      path = ''
      do i = 1, size(chart%row)
         x = place(LEFT + (RIGHT - LEFT)*real(chart%row(i) - 1, wp)/real(max(1_ip, chart%n_rows - 1), wp))
         y = place(height(chart, chart%power(i)))
         path = path//merge('M', 'L', chart%begins(i))//x//' '//y
         if (size(chart%row) <= MOST_DOTS) call add_line(page, '<circle class="dot" r="3" cx="'//x//'" cy="'//y//'"/>')
      end do
      call add_line(page, '<path class="curve" d="'//path//'"/>')
      call add_line(page, '<text x="385" y="262" text-anchor="middle">linear solve</text>')
      call add_line(page, '<text x="16" y="118" text-anchor="middle" transform="rotate(-90 16 118)">residual</text>')
      call add_line(page, '</svg></div>')
   end subroutine add_residual_chart

   !> The residuals that are numbers. Of many rows the largest of each few.
   subroutine collect(table, chart)
      type(table_file_t), intent(in) :: table
      type(chart_t), intent(out) :: chart
      integer(ip) :: residual, step, increment, stride, first, row, last, i
      logical :: begins

      allocate (chart%row(0), chart%begins(0), chart%power(0))
      residual = find_column(table, 'residual')
      step = find_column(table, 'step')
      increment = find_column(table, 'increment')
      if (min(residual, step, increment) == 0 .or. table%n_rows == 0) return
      chart%n_rows = table%n_rows
      stride = (table%n_rows - 1)/MOST_POINTS + 1
      do first = 1, table%n_rows, stride
         row = 0
         do i = first, min(table%n_rows, first + stride - 1)
            if (.not. ieee_is_finite(table%value(residual, i))) cycle
            if (row == 0) row = i
            if (table%value(residual, i) > table%value(residual, row)) row = i
         end do
         if (row == 0) cycle
         begins = size(chart%row) == 0
         if (.not. begins) begins = any(table%value([step, increment], row) /= table%value([step, increment], last))
         last = row
         chart%row = [chart%row, row]
         chart%begins = [chart%begins, begins]
         chart%power = [chart%power, log10(max(LEAST, table%value(residual, row)))]
      end do
      if (size(chart%row) == 0) return
      chart%low = floor(minval(chart%power))
      chart%high = max(chart%low + 1, ceiling(maxval(chart%power)))
   end subroutine collect

   !> Down from the top.
   pure real(wp) function height(chart, power)
      type(chart_t), intent(in) :: chart
      real(wp), intent(in) :: power

      height = BOTTOM - (BOTTOM - TOP)*(power - real(chart%low, wp))/real(chart%high - chart%low, wp)
   end function height

   !> A place in tenths.
   pure function place(x) result(text)
      real(wp), intent(in) :: x
      character(len=:), allocatable :: text

      text = to_text(0.1_wp*anint(10.0_wp*x), 5)
   end function place

end module atrito_residual_chart
