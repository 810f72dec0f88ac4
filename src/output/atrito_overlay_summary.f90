!> The picture of a sweep of one parameter: quantities of summary.tab against it.
module atrito_overlay_summary
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: to_text
   use atrito_status, only: status_t, is_ok
   use atrito_files, only: file_set_t, text_file_t, open_text, put_line, close_text
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: OVERLAY_SUMMARY
   use atrito_plot_text, only: range_t, cover, padded, span, quoted, cleaned, put_top, put_terminal, put_frame, put_panel, &
                               COLOUR, N_COLOURS, LOOP_END
   use atrito_overlay_data, only: overlay_run_t, is_logarithmic, N_QUANTITIES, LONGEST_LABEL
   implicit none (type, external)
   private
   public :: write_summary_plot

   integer, parameter :: LONGEST_TITLE = 100        !< characters
   real(wp), parameter :: LEAST_SPAN = 0.02_wp      !< of an axis, as a share of the value: what hardly varies is drawn so

contains

   !> Writes overlay-summary.dat and overlay-summary.gp into the set of the plots' folder.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_summary_plot(set, title, list, n_pairs, parameter_name, status)
      type(file_set_t), intent(inout) :: set
      character(len=*), intent(in) :: title, parameter_name
      type(overlay_run_t), intent(in) :: list(:)
      integer(ip), intent(in) :: n_pairs
      type(status_t), intent(out) :: status
      type(overlay_run_t), allocatable :: sorted(:)

      sorted = sort_by_value(list)
      call write_summary_data(set, sorted, n_pairs, parameter_name, status)
      if (is_ok(status)) call write_summary_script(set, title, sorted, n_pairs, parameter_name, status)
   end subroutine write_summary_plot

   !> The runs with a summary, by growing value, so that lines go from left to right.
   pure function sort_by_value(list) result(sorted)
      type(overlay_run_t), intent(in) :: list(:)
      type(overlay_run_t), allocatable :: sorted(:)
      integer :: order(size(list)), i, j, held, n

      n = 0
      do i = 1, size(list)
         if (.not. allocated(list(i)%quantity)) cycle
         held = i
         n = n + 1
         order(n) = held
         do j = n - 1, 1, -1
            if (list(order(j))%value <= list(held)%value) exit
            order(j + 1) = order(j)
            order(j) = held
         end do
      end do
      allocate (sorted(n))
      do i = 1, n
         sorted(i) = list(order(i))
      end do
   end function sort_by_value

   subroutine write_summary_data(set, list, n_pairs, parameter_name, status)
      type(file_set_t), intent(inout) :: set
      type(overlay_run_t), intent(in) :: list(:)
      integer(ip), intent(in) :: n_pairs
      character(len=*), intent(in) :: parameter_name
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      character(len=:), allocatable :: line
      integer(ip) :: pair
      integer :: i, j

      call open_text(set, OVERLAY_SUMMARY//'.dat', file)
      call put_line(file, '# a block a pair; columns: '//cleaned(parameter_name, LONGEST_LABEL)// &
                    '  normal_resultant [F]  effective_area_percent  max_pressure [F/L^2]  max_abs_shear [F/L^2]  '// &
                    '1 if not converged')
      do pair = 1, n_pairs
         call put_line(file, '# pair '//to_text(pair))
         do i = 1, size(list)
            if (pair > size(list(i)%quantity, 2)) cycle
            line = trimmed_real(list(i)%value, 12)
            do j = 1, N_QUANTITIES
               line = line//' '//trimmed_real(list(i)%quantity(j, pair), 12)
            end do
            call put_line(file, line//merge(' 1', ' 0', list(i)%not_converged))
         end do
         call put_line(file, '')
         call put_line(file, '')
      end do
      call close_text(file, status)
   end subroutine write_summary_data

   subroutine write_summary_script(set, title, list, n_pairs, parameter_name, status)
      type(file_set_t), intent(inout) :: set
      character(len=*), intent(in) :: title, parameter_name
      type(overlay_run_t), intent(in) :: list(:)    !< each with a summary
      integer(ip), intent(in) :: n_pairs
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      integer, allocatable :: shown(:)
      integer :: i

      shown = shown_quantities(list)
      call open_text(set, OVERLAY_SUMMARY//'.gp', file)
      call put_top(file, OVERLAY_SUMMARY, 'quantities of several runs against the parameter that varies')
      call put_line(file, '# Columns of overlay-summary.dat: 1 parameter, 2 normal resultant [F], 3 effective area [%],')
      call put_line(file, '# 4 largest pressure [F/L^2], 5 largest shear [F/L^2], 6 is 1 if not converged; a block a pair')
      call put_line(file, 'pairs = '//to_text(n_pairs))
      call put_line(file, 'heading = '//quoted(cleaned(title, LONGEST_TITLE)))
      call put_frame(file, size(shown), parameter_range(list%value), quoted(cleaned(parameter_name, LONGEST_LABEL)))
      if (is_logarithmic(list%value)) call put_line(file, 'set logscale x; x_format = "10^{%T}"')
      if (n_pairs == 1 .and. .not. any(list%not_converged)) call put_line(file, 'right = 0.95')   ! no legend
      call put_terminal(file, OVERLAY_SUMMARY, '1000,height')
      call put_line(file, 'set multiplot title heading noenhanced')
      do i = 1, N_COLOURS
         call put_line(file, 'set style line '//to_text(int(i, ip))//' lt 1 lw 1.8 pt 7 ps 0.9*dot lc rgb "'//COLOUR(i)//'"')
      end do
      do i = 1, size(shown)
         call put_quantity(file, i, shown(i), list, n_pairs)
      end do
      call put_line(file, 'unset multiplot')
      call put_line(file, LOOP_END)
      call put_line(file, 'set output')
      call close_text(file, status)
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

   subroutine put_quantity(file, place, quantity, list, n_pairs)
      type(text_file_t), intent(inout) :: file
      integer, intent(in) :: place, quantity
      type(overlay_run_t), intent(in) :: list(:)
      integer(ip), intent(in) :: n_pairs
      character(len=16), parameter :: LABEL(N_QUANTITIES) = &
                                      [character(len=16) :: 'normal resultant', 'effective area', 'max. pressure', 'max. |shear|']
      character(len=5), parameter :: DIMENSION(N_QUANTITIES) = ['F    ', '%    ', 'F/L^2', 'F/L^2']
      character(len=:), allocatable :: line, column

      call put_panel(file, place, trim(LABEL(quantity)), trim(DIMENSION(quantity)), quantity_range(list, quantity))
      column = to_text(int(quantity, ip) + 1_ip)
      line = 'plot for [i=1:pairs] "overlay-summary.dat" index i-1 using 1:($'//column// &
             '/unit) with linespoints ls (i-1)%'//to_text(int(N_COLOURS, ip))//'+1'
      if (place == 1 .and. n_pairs > 1) line = line//' title sprintf("pair %d", i)'
      if (any(list%not_converged)) then
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
