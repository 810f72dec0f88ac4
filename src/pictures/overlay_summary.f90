!> The picture of a sweep of one parameter: quantities of summary.tab against it.
module atrito_overlay_summary
   use atrito_kinds, only: ip, wp
   use atrito_number_text, only: trimmed_real
   use atrito_overlay_data, only: overlay_t, overlay_run_t, is_logarithmic, QUANTITIES
   use atrito_plot_files, only: OVERLAY_SUMMARY
   use atrito_plot_scripts, only: plots_t, put, begin_data, end_data, begin_script, end_script, put_terminal, put_frame, put_panel
   use atrito_plot_text, only: range_t, cover, padded, range_of, span, quoted, colour_styles, LF, N_COLOURS
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: write_summary_plot

   real(wp), parameter :: LEAST_SPAN = 0.02_wp      !< of an axis, as a share of the value: what hardly varies is drawn so

contains

   !> Writes overlay-summary.dat and overlay-summary.gp.
   subroutine write_summary_plot(plots, overlay)
      type(plots_t), intent(inout) :: plots
      type(overlay_t), intent(in) :: overlay
      type(overlay_t) :: sorted
      integer(ip) :: i, n
      logical :: doubt

      sorted = overlay
      sorted%runs = sort_by_value(overlay%runs)
      call write_data(plots, sorted)
      associate (runs => sorted%runs, is_one => size(overlay%pairs) == 1)
         doubt = any(runs%not_converged)
         n = size(QUANTITIES, kind=ip)
         if (.not. any([(any(abs(runs(i)%quantity(n, :)) > 0.0_wp), i=1, size(runs))])) n = n - 1   ! no shear
         call begin_script(plots, OVERLAY_SUMMARY, 'quantities of several runs against the parameter that varies', &
                           'Columns of overlay-summary.dat: 1 parameter, 2 normal resultant [F], 3 effective area [%],'//LF// &
                           '# 4 largest pressure [F/L^2], 5 largest shear [F/L^2], 6 is 1 if not converged; a block a pair')
         call put(plots, 'pairs = '//to_text(size(overlay%pairs, kind=ip))//LF//'heading = '//quoted(overlay%title))
         call put_frame(plots, n, parameter_range(runs%value), quoted(overlay%parameter))
         if (is_logarithmic(runs%value)) call put(plots, 'set logscale x; x_format = "10^{%T}"')
         if (is_one .and. .not. doubt) call put(plots, 'right = 0.95')   ! no legend
         call put_terminal(plots, '1000,height')
         call put(plots, 'set multiplot title heading noenhanced'//LF//colour_styles(' lw 1.8 pt 7 ps 0.9*dot'))
         do i = 1, n
            call put_quantity(plots, i, runs, .not. is_one, doubt)
         end do
      end associate
      call put(plots, 'unset multiplot')
      call end_script(plots)
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

   subroutine write_data(plots, overlay)
      type(plots_t), intent(inout) :: plots
      type(overlay_t), intent(in) :: overlay
      character(len=:), allocatable :: line
      integer(ip) :: pair
      integer :: i, j

      call begin_data(plots, OVERLAY_SUMMARY, 'a block a pair; columns: '//overlay%parameter//'  normal_resultant [F]  '// &
                      'effective_area_percent  max_pressure [F/L^2]  max_abs_shear [F/L^2]  1 if not converged')
      do pair = 1, size(overlay%pairs, kind=ip)
         call put(plots, '# pair '//to_text(pair))
         do i = 1, size(overlay%runs)
            if (pair > size(overlay%runs(i)%quantity, 2)) cycle
            line = trimmed_real(overlay%runs(i)%value, 12)
            do j = 1, size(QUANTITIES)
               line = line//' '//trimmed_real(overlay%runs(i)%quantity(j, pair), 12)
            end do
            call put(plots, line//merge(' 1', ' 0', overlay%runs(i)%not_converged))
         end do
         call put(plots, LF)
      end do
      call end_data(plots)
   end subroutine write_data

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

   subroutine put_quantity(plots, place, runs, has_pairs, has_doubt)
      type(plots_t), intent(inout) :: plots
      integer(ip), intent(in) :: place              !< of the panel, and in QUANTITIES
      type(overlay_run_t), intent(in) :: runs(:)
      logical, intent(in) :: has_pairs, has_doubt   !< several; a run did not converge
      character(len=:), allocatable :: line, column
      type(range_t) :: range
      real(wp) :: room
      integer :: i

      do i = 1, size(runs)
         call cover(range, runs(i)%quantity(place, :))
      end do
      room = LEAST_SPAN*max(abs(range%low), abs(range%high))
      if (range%low <= range%high .and. span(range) < room) range = range_t(range%low - room, range%high + room)
      call put_panel(plots, place, trim(QUANTITIES(place)%label), trim(QUANTITIES(place)%dimension), range)
      column = to_text(place + 1)
      line = 'plot for [i=1:pairs] "overlay-summary.dat" index i-1 using 1:($'//column// &
             '/unit) with linespoints ls (i-1)%'//to_text(N_COLOURS)//'+1'
      if (place == 1 .and. has_pairs) line = line//' title sprintf("pair %d", i)'
      if (has_doubt) line = line//', "overlay-summary.dat" using 1:($6 > 0 ? $'//column//'/unit : NaN) with points pt 6 lw 1.5 '// &
                            'ps 2*dot lc rgb "black"'
      if (place == 1 .and. has_doubt) line = line//' title "not converged"'
      call put(plots, line)
   end subroutine put_quantity

end module atrito_overlay_summary
