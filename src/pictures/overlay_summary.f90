!> The picture of a sweep of one parameter: quantities of summary.tab against it.
module atrito_overlay_summary
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: to_text
   use atrito_status, only: status_t, is_ok
   use atrito_files, only: file_set_t, text_file_t, put_line, close_text
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: open_data, OVERLAY_SUMMARY
   use atrito_plot_text, only: range_t, cover, padded, span, quoted, begin_script, end_script, put_terminal, put_frame, put_panel, &
                               COLOUR, N_COLOURS
   use atrito_overlay_data, only: overlay_t, overlay_run_t, is_logarithmic, N_QUANTITIES
   implicit none (type, external)
   private
   public :: write_summary_plot

   real(wp), parameter :: LEAST_SPAN = 0.02_wp      !< of an axis, as a share of the value: what hardly varies is drawn so

contains

   !> Writes overlay-summary.dat and overlay-summary.gp into the set of the plots' folder.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_summary_plot(set, overlay, status)
      type(file_set_t), intent(inout) :: set
      type(overlay_t), intent(in) :: overlay
      type(status_t), intent(out) :: status
      type(overlay_t) :: sorted

      sorted = overlay
      sorted%runs = sort_by_value(overlay%runs)
      call write_summary_data(set, sorted, status)
      if (is_ok(status)) call write_summary_script(set, sorted, status)
   end subroutine write_summary_plot

   !> The runs with a summary, by growing value, so that lines go from left to right.
   pure function sort_by_value(list) result(sorted)
      type(overlay_run_t), intent(in) :: list(:)
      type(overlay_run_t), allocatable :: sorted(:)
      logical :: is_left(size(list))
      integer :: i, next

      is_left = [(allocated(list(i)%quantity), i=1, size(list))]
      allocate (sorted(count(is_left)))
      do i = 1, size(sorted)
         next = minloc(list%value, dim=1, mask=is_left)
         sorted(i) = list(next)
         is_left(next) = .false.
      end do
   end function sort_by_value

   subroutine write_summary_data(set, overlay, status)
      type(file_set_t), intent(inout) :: set
      type(overlay_t), intent(in) :: overlay
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      character(len=:), allocatable :: line
      integer(ip) :: pair
      integer :: i, j

      call open_data(set, OVERLAY_SUMMARY, file)
      call put_line(file, '# a block a pair; columns: '//overlay%parameter// &
                    '  normal_resultant [F]  effective_area_percent  max_pressure [F/L^2]  max_abs_shear [F/L^2]  '// &
                    '1 if not converged')
      do pair = 1, size(overlay%pairs, kind=ip)
         call put_line(file, '# pair '//to_text(pair))
         do i = 1, size(overlay%runs)
            if (pair > size(overlay%runs(i)%quantity, 2)) cycle
            line = trimmed_real(overlay%runs(i)%value, 12)
            do j = 1, N_QUANTITIES
               line = line//' '//trimmed_real(overlay%runs(i)%quantity(j, pair), 12)
            end do
            call put_line(file, line//merge(' 1', ' 0', overlay%runs(i)%not_converged))
         end do
         call put_line(file, '')
         call put_line(file, '')
      end do
      call close_text(file, status)
   end subroutine write_summary_data

   subroutine write_summary_script(set, overlay, status)
      type(file_set_t), intent(inout) :: set
      type(overlay_t), intent(in) :: overlay        !< of runs with a summary
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      integer, allocatable :: shown(:)
      integer :: i

      shown = shown_quantities(overlay%runs)
      call begin_script(set, OVERLAY_SUMMARY, 'quantities of several runs against the parameter that varies', file)
      call put_line(file, '# Columns of overlay-summary.dat: 1 parameter, 2 normal resultant [F], 3 effective area [%],')
      call put_line(file, '# 4 largest pressure [F/L^2], 5 largest shear [F/L^2], 6 is 1 if not converged; a block a pair')
      call put_line(file, 'pairs = '//to_text(size(overlay%pairs, kind=ip)))
      call put_line(file, 'heading = '//quoted(overlay%title))
      call put_frame(file, size(shown), parameter_range(overlay%runs%value), quoted(overlay%parameter))
      if (is_logarithmic(overlay%runs%value)) call put_line(file, 'set logscale x; x_format = "10^{%T}"')
      if (size(overlay%pairs) == 1 .and. .not. any(overlay%runs%not_converged)) call put_line(file, 'right = 0.95')   ! no legend
      call put_terminal(file, OVERLAY_SUMMARY, '1000,height')
      call put_line(file, 'set multiplot title heading noenhanced')
      do i = 1, N_COLOURS
         call put_line(file, 'set style line '//to_text(int(i, ip))//' lt 1 lw 1.8 pt 7 ps 0.9*dot lc rgb "'//COLOUR(i)//'"')
      end do
      do i = 1, size(shown)
         call put_quantity(file, i, shown(i), overlay)
      end do
      call put_line(file, 'unset multiplot')
      call end_script(file, status)
   end subroutine write_summary_script

   !> All quantities; the shear only where there is some.
   pure function shown_quantities(list) result(shown)
      type(overlay_run_t), intent(in) :: list(:)
      integer, allocatable :: shown(:)
      type(range_t) :: range
      integer :: i

      do i = 1, size(list)
         call cover(range, list(i)%quantity(N_QUANTITIES, :))
      end do
      shown = [(i, i=1, N_QUANTITIES - 1)]
      if (max(abs(range%low), abs(range%high)) > 0.0_wp .and. range%low <= range%high) shown = [shown, N_QUANTITIES]
   end function shown_quantities

   pure type(range_t) function parameter_range(values) result(range)
      real(wp), intent(in) :: values(:)
      real(wp) :: factor

      call cover(range, values)
      if (is_logarithmic(values)) then
         factor = (range%high/range%low)**0.03_wp
         range = range_t(range%low/factor, range%high*factor)
      else
         range = padded(range)
      end if
   end function parameter_range

   subroutine put_quantity(file, place, quantity, overlay)
      type(text_file_t), intent(inout) :: file
      integer, intent(in) :: place, quantity
      type(overlay_t), intent(in) :: overlay
      character(len=16), parameter :: LABEL(N_QUANTITIES) = &
                                      [character(len=16) :: 'normal resultant', 'effective area', 'max. pressure', 'max. |shear|']
      character(len=5), parameter :: DIMENSION(N_QUANTITIES) = ['F    ', '%    ', 'F/L^2', 'F/L^2']
      character(len=:), allocatable :: line, column

      call put_panel(file, place, trim(LABEL(quantity)), trim(DIMENSION(quantity)), quantity_range(overlay%runs, quantity))
      column = to_text(int(quantity, ip) + 1_ip)
      line = 'plot for [i=1:pairs] "overlay-summary.dat" index i-1 using 1:($'//column// &
             '/unit) with linespoints ls (i-1)%'//to_text(int(N_COLOURS, ip))//'+1'
      if (place == 1 .and. size(overlay%pairs) > 1) line = line//' title sprintf("pair %d", i)'
      if (any(overlay%runs%not_converged)) then
         line = line//', "overlay-summary.dat" using 1:($6 > 0 ? $'//column//'/unit : NaN) with points pt 6 lw 1.5 ps 2*dot '// &
                'lc rgb "black"'
         if (place == 1) line = line//' title "not converged"'
      end if
      call put_line(file, line)
   end subroutine put_quantity

   !> The range of a quantity.
   pure type(range_t) function quantity_range(list, quantity) result(range)
      type(overlay_run_t), intent(in) :: list(:)
      integer, intent(in) :: quantity
      real(wp) :: room
      integer :: i

      do i = 1, size(list)
         call cover(range, list(i)%quantity(quantity, :))
      end do
      if (range%low > range%high) return
      room = LEAST_SPAN*max(abs(range%low), abs(range%high))
      if (span(range) < room) range = range_t(range%low - room, range%high + room)
   end function quantity_range

end module atrito_overlay_summary
