!> Pictures that lay the runs of a sweep one over the other: overlay-<pair> with a curve a run along s, and, where one parameter
!> varies, overlay-summary with quantities of summary.tab against it.
!>
!> As with the pictures of a run, a failure is a warning, W-PLOT.
module atrito_overlay_plots
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_contact_plot, only: put_contact_columns, pair_legend
   use atrito_gnuplot, only: draw_written
   use atrito_kinds, only: ip, wp
   use atrito_number_text, only: trimmed_real
   use atrito_overlay_data, only: overlay_t, overlay_run_t, field_t, read_runs, is_logarithmic, FIELDS, LONGEST_LABEL, &
                                  FIELD_PRESSURE, FIELD_WEIGHTED, FIELD_SHEAR, FIELD_SLIP, FIELD_GAP, QUANTITIES
   use atrito_plot_files, only: plot_folder, OVERLAY_PLOT, OVERLAY_SUMMARY
   use atrito_plot_scripts, only: plots_t, begin_plots, end_plots, put, begin_script, put_terminal, put_frame, put_panel, &
                                  CSV_SEPARATOR, begin_data
   use atrito_plot_text, only: range_t, cover, padded, range_of, range_text, span, quoted, cleaned, LF, COLOUR, DASH, N_COLOURS, &
                               colour_styles
   use atrito_status, only: status_t
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_table, only: TAB_ENDING, CSV_ENDING
   implicit none (type, external)
   private
   public :: write_overlay_plots, write_overlay_scripts, path_from_plots

   integer(ip), parameter :: MOST_IN_LEGEND = 10    !< runs; of more a colour bar shows the parameter
   integer, parameter :: MOST_NAMED = 30            !< runs named beside the colour bar
   integer, parameter :: MOST_MARKED = 40           !< points of a curve that has markers
   integer, parameter :: LONGEST_TITLE = 100        !< characters
   integer, parameter :: MOST_NUMBERS = 8           !< of runs whose values are the numbers at an axis
   real(wp), parameter :: WIDEST = 0.78_wp          !< right end of the panels, as a share of the width

   real(wp), parameter :: LEAST_SPAN = 0.02_wp      !< of an axis, as a share of the value: what hardly varies is drawn so

contains

   !> Draws the overlays of a sweep into <folder>/plots.
   subroutine write_overlay_plots(folder, title, labels, runs, parameter_name, values, drawn)
      character(len=*), intent(in) :: folder        !< of the sweep
      character(len=*), intent(in) :: title         !< where the tables have no heading
      type(string_t), intent(in) :: labels(:)       !< of the runs, such as eps=1e-4
      type(string_t), intent(in) :: runs(:)         !< their folders: absolute, or below `folder`, with or without it in front
      character(len=*), intent(in) :: parameter_name  !< empty where several vary
      real(wp), intent(in) :: values(:)             !< of the parameter, one a run; size 0 where several vary
      type(string_t), allocatable, intent(out) :: drawn(:)   !< names of the pictures, without ending
      type(string_t), allocatable :: names(:)
      type(status_t) :: status

      call write_overlay_scripts(folder, title, labels, runs, parameter_name, values, names, status)
      call draw_written(folder, names, status, drawn)
   end subroutine write_overlay_plots

   !> The scripts and data of write_overlay_plots, which appear together or not at all. names is empty where there is nothing to
   !> draw, and then no file is written.
   !>
   !> status: STATUS_FILE
   subroutine write_overlay_scripts(folder, title, labels, runs, parameter_name, values, names, status)
      character(len=*), intent(in) :: folder, title, parameter_name !< as of write_overlay_plots
      type(string_t), intent(in) :: labels(:), runs(:)       !< of each run: its text, and its folder
      real(wp), intent(in) :: values(:)                      !< of the parameter in each run; empty: several vary
      type(string_t), allocatable, intent(out) :: names(:)   !< without .gp
      type(status_t), intent(out) :: status                  !< STATUS_OK or STATUS_FILE
      type(overlay_t) :: overlay
      type(plots_t) :: plots
      type(range_t) :: summed                       ! of the parameter, in runs with a summary
      integer(ip) :: i

      allocate (names(0), overlay%runs(size(runs)))
      overlay%by_value = size(values) > 0
      overlay%parameter = cleaned(parameter_name, LONGEST_LABEL)
      do i = 1, size(runs, kind=ip)
         associate (run => overlay%runs(i))
            run%label = cleaned(labels(i)%s, LONGEST_LABEL)
            run%from_plots = path_from_plots(folder, runs(i)%s)
            run%path = runs(i)%s
            if (index(run%path, '/') /= 1 .and. index(run%path, folder//'/') /= 1) run%path = folder//'/'//run%path
            run%value = real(i, wp)
            if (overlay%by_value) run%value = values(i)
         end associate
      end do
      call read_runs(overlay)
      if (len(overlay%title) == 0) overlay%title = title
      overlay%title = cleaned(overlay%title, LONGEST_TITLE)
      overlay%runs = pack(overlay%runs, overlay%runs%has_tables)
      if (size(overlay%runs) == 0 .or. size(overlay%pairs) == 0) return
      call begin_plots(plots, plot_folder(folder))
      do i = 1, size(overlay%pairs, kind=ip)
         if (overlay%pairs(i)%most_points == 0) cycle
         call write_overlay(plots, overlay, i)
         call append_string(names, OVERLAY_PLOT//to_text(i))
      end do
      do i = 1, size(overlay%runs, kind=ip)
         if (allocated(overlay%runs(i)%quantity)) call cover(summed, [overlay%runs(i)%value])
      end do
      if (overlay%by_value .and. span(summed) > 0.0_wp) then
         call write_summary_plot(plots, overlay)
         call append_string(names, OVERLAY_SUMMARY)
      end if
      call end_plots(plots, status)
   end subroutine write_overlay_scripts

   !> Path of a run's folder, seen from the folder of the plots.
   pure function path_from_plots(folder, run) result(path)
      character(len=*), intent(in) :: folder, run   !< of the sweep; of the run, from where the sweep's is
      character(len=:), allocatable :: path

      if (index(run, folder//'/') == 1) then
         path = '../'//run(len(folder) + 2:)
      else if (index(run, '/') == 1) then
         path = run
      else
         path = '../'//run
      end if
   end function path_from_plots

   !> The script of a pair: a panel a field, a curve a run. No shear and slip where no run has friction, no weighted pressure where
   !> it is the pressure.
   subroutine write_overlay(plots, overlay, number)
      type(plots_t), intent(inout) :: plots
      type(overlay_t), intent(in) :: overlay
      integer(ip), intent(in) :: number             !< of the pair
      integer(ip), allocatable :: shown(:)
      character(len=:), allocatable :: doubt, points
      type(range_t) :: along
      integer(ip) :: i, label_width, k
      integer(ip), parameter :: MARK(MOST_IN_LEGEND) = [7, 5, 9, 11, 13, 6, 4, 8, 10, 12]

      associate (runs => overlay%runs, pair => overlay%pairs(number))
         shown = [FIELD_PRESSURE]
         if (pair%has_weighted) shown = [shown, FIELD_WEIGHTED]
         if (pair%has_shear) shown = [shown, FIELD_SHEAR, FIELD_SLIP]
         shown = [shown, FIELD_GAP]
         label_width = 0
         doubt = ''
         do i = 1, size(runs, kind=ip)
            label_width = max(label_width, len(runs(i)%label, kind=ip))
            if (runs(i)%not_converged) doubt = doubt//', '//runs(i)%label
         end do
         if (len(doubt) > 0) doubt = ';  NOT CONVERGED: '//doubt(3:)
         along = range_of([0.0_wp, pair%s%low, pair%s%high])
         if (span(along) <= 0.0_wp) along = padded(along)
         call begin_script(plots, OVERLAY_PLOT//to_text(number), 'contact pair '//to_text(number)//' of several runs along s')
         call put_contact_columns(plots, number, '', 'last_step[i]', 'last_increment[i]')
         call put_runs(plots, runs, overlay%is_csv)
         call put(plots, 'heading = '//quoted(overlay%title)//LF// &
                  'pair_line = '//quoted(cleaned(pair_line(number, pair%name)//doubt, LONGEST_TITLE)))
         call put_frame(plots, size(shown, kind=ip), along, '"s [L]"')
         call put(plots, 'right = '//to_text(min(WIDEST, 0.925_wp - 0.009_wp*real(label_width, wp)), 3)// &
                  '   # leaves room for the names')
         call put_terminal(plots, '1000,height')
         call put(plots, 'set multiplot title heading."\n".pair_line noenhanced')
         if (size(runs) > MOST_IN_LEGEND) then
            call put_palette(plots, overlay)
         else
            ! A line style a run.
            do k = 1, size(runs, kind=ip)
               points = ' dt '//trim(DASH(k))//' ps 0' ! long lines have no marks
               if (pair%most_points <= MOST_MARKED) points = ' dt 1 pt '//to_text(MARK(k))//' ps 0.8*dot'
               call put(plots, 'set style line '//to_text(k)//' lw 1.8 lc rgb "'//COLOUR(mod(k - 1, N_COLOURS) + 1)//'"'//points)
            end do
         end if
         do i = 1, size(shown, kind=ip)
            call put_field(plots, i, FIELDS(shown(i)), pair%field(shown(i)), size(runs) > MOST_IN_LEGEND)
         end do
      end associate
      call put(plots, 'unset multiplot')
   end subroutine write_overlay

   !> `pair 1: OVER-BOTTOM on SUPPORT-TOP`, or `pair 1`.
   pure function pair_line(number, name) result(text)
      integer(ip), intent(in) :: number
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: text

      text = 'pair '//to_text(number)
      if (len(name) > 0) text = text//': '//name
   end function pair_line

   !> Folder, name and value of each run.
   subroutine put_runs(plots, list, is_csv)
      type(plots_t), intent(inout) :: plots
      type(overlay_run_t), intent(in) :: list(:)
      logical, intent(in) :: is_csv                 !< of the tables
      character(len=:), allocatable :: k
      integer(ip) :: i

      call put(plots, 'runs = '//to_text(size(list, kind=ip))//LF// &
               'array folder[runs]; array label[runs]; array value_of[runs]'//LF// &
               'array last_step[runs]; array last_increment[runs]')
      do i = 1, size(list, kind=ip)
         k = '['//to_text(i)//'] = '
         call put(plots, 'folder'//k//quoted(list(i)%from_plots)//'; label'//k//quoted(list(i)%label)//'; value_of'//k// &
                  trimmed_real(list(i)%value, 12)//LF// &
                  'last_step'//k//to_text(list(i)%step)//'; last_increment'//k//to_text(list(i)%increment))
      end do
      if (is_csv) call put(plots, CSV_SEPARATOR)
      call put(plots, 'table(i) = folder[i]."/contact'//merge(CSV_ENDING, TAB_ENDING, is_csv)//'"')
   end subroutine put_runs

   !> The palette viridis without its palest end, and the bar to the right of the panels.
   subroutine put_palette(plots, overlay)
      type(plots_t), intent(inout) :: plots
      type(overlay_t), intent(in) :: overlay
      character(len=:), allocatable :: names
      type(range_t) :: range
      integer(ip) :: i

      range = range_of(overlay%runs%value)
      if (span(range) <= 0.0_wp) range = padded(range)
      call put(plots, 'set palette defined (0 "#440154", 1 "#472c7a", 2 "#3b518b", 3 "#2c718e", 4 "#21908d", '// &
               '5 "#27ad81", 6 "#5cc863", 7 "#aadc32")'//LF// &
               'set colorbox user origin screen right + 0.03, screen bottom(panels) '// &
               'size screen 0.02, screen top(1) - bottom(panels)'//LF//'set cbrange '//range_text(range))
      if (overlay%by_value) then
         call put(plots, 'set cblabel '//quoted(overlay%parameter)//' noenhanced'//LF//'set format cb "%h"')
         if (is_logarithmic(overlay%runs%value)) call put(plots, 'set logscale cb; set format cb "10^{%T}"')
      else if (size(overlay%runs) <= MOST_NAMED) then
         names = ''
         do i = 1, size(overlay%runs, kind=ip)
            names = names//', '//quoted(overlay%runs(i)%label)//' '//trimmed_real(overlay%runs(i)%value, 12)
         end do
         call put(plots, 'set cbtics noenhanced ('//names(3:)//')')
      else
         call put(plots, 'set cblabel "number of the run"')
      end if
   end subroutine put_palette

   subroutine put_field(plots, place, field, range, has_palette)
      type(plots_t), intent(inout) :: plots
      integer(ip), intent(in) :: place              !< of the panel
      type(field_t), intent(in) :: field
      type(range_t), intent(in) :: range
      logical, intent(in) :: has_palette
      character(len=:), allocatable :: line

      call put_panel(plots, place, trim(field%label), trim(field%dimension), range)
      line = 'plot for [i=1:runs] table(i) using 4:(col('//to_text(field%column)//'))'
      if (has_palette) then
         if (place == 2) call put(plots, 'unset colorbox')
         line = line//':(value_of[i]) with lines lw 1.5 lc palette'
      else
         line = line//' with linespoints ls i'
         if (place == 1) line = line//' title label[i] noenhanced'
      end if
      call put(plots, line)
   end subroutine put_field

   !> Writes overlay-summary.dat and overlay-summary.gp.
   subroutine write_summary_plot(plots, overlay)
      type(plots_t), intent(inout) :: plots
      type(overlay_t), intent(in) :: overlay
      type(overlay_t) :: sorted
      character(len=:), allocatable :: heading, observed
      integer(ip), allocatable :: shown(:)
      integer(ip) :: i, n
      integer :: k, j, next
      logical :: doubt, is_left(size(overlay%runs))
      real(wp) :: factor
      type(range_t) :: range

      sorted = overlay
      ! The runs with a summary, by growing value, so that lines go from left to right.
      is_left = [(allocated(overlay%runs(j)%quantity), j=1, size(overlay%runs))]
      deallocate (sorted%runs)
      allocate (sorted%runs(count(is_left)))
      do j = 1, size(sorted%runs)
         next = minloc(overlay%runs%value, dim=1, mask=is_left)
         sorted%runs(j) = overlay%runs(next)
         is_left(next) = .false.
      end do
      call write_quantities(plots, sorted)
      associate (runs => sorted%runs, is_one => size(overlay%pairs) == 1)
         doubt = any(runs%not_converged)
         shown = [(i, i=1, size(overlay%quantities, kind=ip))]
         n = size(QUANTITIES, kind=ip)
         if (.not. any([(any(abs(runs(i)%quantity(n, :)) > 0.0_wp), i=1, size(runs))])) shown = pack(shown, shown /= n)   ! no shear
         observed = ''
         do i = n + 1, size(overlay%quantities, kind=ip)
            if (.not. any([(any(ieee_is_finite(runs(k)%quantity(i, :))), k=1, size(runs))])) shown = pack(shown, shown /= i)
            observed = observed//', '//to_text(column_of(i))//' '//trim(overlay%quantities(i)%name)
         end do
         call begin_script(plots, OVERLAY_SUMMARY, 'quantities of several runs against the parameter that varies', &
                           'Columns of overlay-summary.dat: 1 parameter, 2 normal resultant [F], 3 effective area [%],'//LF// &
                           '# 4 largest pressure [F/L^2], 5 largest shear [F/L^2], 6 is 1 if not converged'//observed// &
                           '; a block a pair')
         call put(plots, 'pairs = '//to_text(size(overlay%pairs, kind=ip))//LF//'array name[pairs]')
         do i = 1, size(overlay%pairs, kind=ip)
            call put(plots, 'name['//to_text(i)//'] = '//quoted(pair_legend(i, overlay%pairs(i)%name)))
         end do
         heading = quoted(overlay%title)
         if (is_one) heading = heading//'."\n".'//quoted(cleaned(pair_line(1_ip, overlay%pairs(1)%name), LONGEST_TITLE))
         call put(plots, 'heading = '//heading)
         call cover(range, runs%value)
         if (is_logarithmic(runs%value)) then
            factor = (range%high/range%low)**0.03_wp
            range = range_t(range%low/factor, range%high*factor)
         else if (is_logarithmic(pack(runs%value, runs%value > 0.0_wp)) .and. range%low >= 0.0_wp) then
            range = range_t(-0.15_wp*minval(runs%value, mask=runs%value > 0.0_wp), 1.3_wp*range%high)
         else
            range = padded(range)
         end if
         call put_frame(plots, size(shown, kind=ip), range, quoted(overlay%parameter))
         call put_parameter_axis(plots, runs%value)
         if (is_one .and. .not. doubt) call put(plots, 'right = 0.95')   ! no legend
         call put_terminal(plots, '1000,height')
         call put(plots, 'set multiplot title heading noenhanced'//LF//colour_styles(' lw 1.8 pt 7 ps 0.9*dot'))
         do i = 1, size(shown, kind=ip)
            call put_quantity(plots, i, shown(i), sorted,.not. is_one, doubt)
         end do
      end associate
      call put(plots, 'unset multiplot')
   end subroutine write_summary_plot

   !> A parameter whose values span decades has a logarithmic axis; where 0 is among them, one that is straight from 0 to the least
   !> of the others. Of few values these are the numbers at the axis.
   subroutine put_parameter_axis(plots, values)
      type(plots_t), intent(inout) :: plots
      real(wp), intent(in) :: values(:)             !< growing
      character(len=:), allocatable :: numbers, least
      integer :: i

      if (is_logarithmic(values)) then
         call put(plots, 'set logscale x; x_format = "10^{%T}"')
      else if (is_logarithmic(pack(values, values > 0.0_wp)) .and. minval(values) >= 0.0_wp) then
         least = to_text(minval(values, mask=values > 0.0_wp), 12)
         call put(plots, 'least = '//least//LF//'set nonlinear x via x > least ? 1 + log10(x/least) : x/least '// &
                  'inverse x > 1 ? least*10**(x - 1) : x*least')
      else
         return
      end if
      if (size(values) > MOST_NUMBERS) return
      numbers = ''
      do i = 1, size(values)
         numbers = numbers//', '//to_text(values(i), 6)
      end do
      call put(plots, 'set xtics ('//numbers(3:)//'); x_format = "%g"')
   end subroutine put_parameter_axis

   subroutine write_quantities(plots, overlay)
      type(plots_t), intent(inout) :: plots
      type(overlay_t), intent(in) :: overlay
      character(len=:), allocatable :: line
      integer(ip) :: pair
      integer :: i, j

      line = ''
      do i = size(QUANTITIES) + 1, size(overlay%quantities)
         line = line//'  '//trim(overlay%quantities(i)%name)
      end do
      call begin_data(plots, OVERLAY_SUMMARY, 'a block a pair; columns: '//overlay%parameter//'  normal_resultant [F]  '// &
                      'effective_area_percent  max_pressure [F/L^2]  max_abs_shear [F/L^2]  1 if not converged'//line)
      do pair = 1, size(overlay%pairs, kind=ip)
         call put(plots, '# pair '//to_text(pair))
         do i = 1, size(overlay%runs)
            if (pair > size(overlay%runs(i)%quantity, 2)) cycle
            line = trimmed_real(overlay%runs(i)%value, 12)
            do j = 1, size(overlay%quantities)
               line = line//' '//trimmed_real(overlay%runs(i)%quantity(j, pair), 12)
               if (j == size(QUANTITIES)) line = line//merge(' 1', ' 0', overlay%runs(i)%not_converged)
            end do
            call put(plots, line)
         end do
         call put(plots, LF)
      end do
   end subroutine write_quantities

   !> The column of a quantity in overlay-summary.dat.
   pure integer(ip) function column_of(place)
      integer(ip), intent(in) :: place              !< in overlay_t%quantities

      column_of = place + merge(1_ip, 2_ip, place <= size(QUANTITIES))
   end function column_of

   subroutine put_quantity(plots, panel, place, overlay, has_pairs, has_doubt)
      type(plots_t), intent(inout) :: plots
      integer(ip), intent(in) :: panel, place       !< place: in overlay%quantities
      type(overlay_t), intent(in) :: overlay
      logical, intent(in) :: has_pairs, has_doubt   !< several; a run did not converge
      character(len=:), allocatable :: line, column
      type(range_t) :: range
      real(wp) :: room
      logical :: is_steep
      integer :: i

      associate (runs => overlay%runs)
         do i = 1, size(runs)
            call cover(range, runs(i)%quantity(place, :))
         end do
         is_steep = is_logarithmic([(runs(i)%quantity(place, :), i=1, size(runs))])
      end associate
      room = LEAST_SPAN*max(abs(range%low), abs(range%high))
      if (range%low <= range%high .and. span(range) < room) range = range_t(range%low - room, range%high + room)
      call put(plots, 'unset logscale y; set format y "%h"')    ! of the panel before
      call put_panel(plots, panel, trim(overlay%quantities(place)%label), trim(overlay%quantities(place)%dimension), range)
      if (is_steep) then
         call put(plots, 'set yrange ['//to_text(range%low/1.5_wp, 6)//'/unit:'//to_text(range%high*1.5_wp, 6)// &
                  '/unit]'//LF//'set logscale y; set format y "10^{%T}"')
      end if
      column = to_text(column_of(place))
      line = 'plot for [i=1:pairs] "overlay-summary.dat" index i-1 using 1:($'//column// &
             '/unit) with linespoints ls (i-1)%'//to_text(N_COLOURS)//'+1'
      if (panel == 1 .and. has_pairs) line = line//' title name[i] noenhanced'
      if (has_doubt) line = line//', "overlay-summary.dat" using 1:($6 > 0 ? $'//column//'/unit : NaN) with points pt 6 lw 1.5 '// &
                            'ps 2*dot lc rgb "black"'
      if (panel == 1 .and. has_doubt) line = line//' title "not converged"'
      call put(plots, line)
   end subroutine put_quantity

end module atrito_overlay_plots
