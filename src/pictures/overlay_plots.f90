!> Pictures that lay the runs of a sweep one over the other: overlay-<pair> with a curve a run along s, and, where one parameter
!> varies, overlay-summary with quantities of summary.tab against it.
!>
!> As with the pictures of a run, a failure is a warning, W-PLOT.
module atrito_overlay_plots
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_status, only: status_t, is_ok
   use atrito_files, only: file_set_t, text_file_t, begin_files, put_line, end_files
   use atrito_number_text, only: trimmed_real
   use atrito_gnuplot, only: draw_written
   use atrito_plot_files, only: check_scripts, plot_folder, OVERLAY_PLOT, OVERLAY_SUMMARY
   use atrito_plot_text, only: range_t, cover, padded, range_text, span, quoted, cleaned, begin_script, end_script, put_terminal, &
                               put_frame, put_panel, CSV_SEPARATOR, COLOUR, N_COLOURS
   use atrito_table, only: TAB_ENDING, CSV_ENDING
   use atrito_contact_plot, only: put_contact_columns
   use atrito_overlay_data, only: overlay_t, overlay_run_t, overlay_pair_t, read_runs, is_logarithmic, FIELD_COLUMN, N_FIELDS, &
                                  LONGEST_LABEL, FIELD_PRESSURE, FIELD_WEIGHTED, FIELD_SHEAR, FIELD_SLIP, FIELD_GAP
   use atrito_overlay_summary, only: write_summary_plot
   implicit none (type, external)
   private
   public :: write_overlay_plots, write_overlay_scripts, path_from_plots

   integer, parameter :: MOST_IN_LEGEND = 10        !< runs; more are told by a colour bar
   integer, parameter :: MOST_NAMED = 30            !< runs named beside the colour bar
   integer, parameter :: MOST_MARKED = 40           !< points of a curve that has markers
   integer, parameter :: LONGEST_TITLE = 100        !< characters
   real(wp), parameter :: WIDEST = 0.78_wp          !< right end of the panels, as a share of the width

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
      character(len=*), intent(in) :: folder, title, parameter_name
      type(string_t), intent(in) :: labels(:), runs(:)
      real(wp), intent(in) :: values(:)
      type(string_t), allocatable, intent(out) :: names(:)   !< without .gp
      type(status_t), intent(out) :: status
      type(overlay_t) :: overlay
      type(file_set_t) :: set
      integer(ip) :: i

      allocate (names(0))
      overlay%by_value = size(values) > 0
      overlay%parameter = cleaned(parameter_name, LONGEST_LABEL)
      overlay%runs = collect_runs(folder, labels, runs, values)
      call read_runs(overlay)
      if (len(overlay%title) == 0) overlay%title = title
      overlay%title = cleaned(overlay%title, LONGEST_TITLE)
      overlay%runs = pack(overlay%runs, overlay%runs%has_tables)
      if (size(overlay%runs) == 0 .or. size(overlay%pairs) == 0) return
      call begin_files(set, plot_folder(folder), status)
      do i = 1, size(overlay%pairs, kind=ip)
         if (overlay%pairs(i)%most_points == 0 .or. .not. is_ok(status)) cycle
         call write_overlay(set, overlay, i, status)
         call append_string(names, OVERLAY_PLOT//to_text(i))
      end do
      if (is_ok(status) .and. overlay%by_value .and. has_summaries(overlay%runs)) then
         call write_summary_plot(set, overlay, status)
         call append_string(names, OVERLAY_SUMMARY)
      end if
      call check_scripts(set, status)
      call end_files(set, status)
   end subroutine write_overlay_scripts

   pure function collect_runs(folder, labels, runs, values) result(list)
      character(len=*), intent(in) :: folder
      type(string_t), intent(in) :: labels(:), runs(:)
      real(wp), intent(in) :: values(:)
      type(overlay_run_t), allocatable :: list(:)
      integer :: i

      allocate (list(size(runs)))
      do i = 1, size(runs)
         list(i)%label = cleaned(labels(i)%s, LONGEST_LABEL)
         list(i)%from_plots = path_from_plots(folder, runs(i)%s)
         list(i)%path = runs(i)%s
         if (index(runs(i)%s, '/') /= 1 .and. index(runs(i)%s, folder//'/') /= 1) list(i)%path = folder//'/'//runs(i)%s
         list(i)%value = real(i, wp)
         if (size(values) > 0) list(i)%value = values(i)
      end do
   end function collect_runs

   !> Path of a run's folder, seen from the folder of the plots.
   pure function path_from_plots(folder, run) result(path)
      character(len=*), intent(in) :: folder, run
      character(len=:), allocatable :: path

      if (index(run, folder//'/') == 1) then
         path = '../'//run(len(folder) + 2:)
      else if (index(run, '/') == 1) then
         path = run
      else
         path = '../'//run
      end if
   end function path_from_plots

   !> There is something to draw against the parameter.
   pure logical function has_summaries(list)
      type(overlay_run_t), intent(in) :: list(:)
      type(range_t) :: range
      integer :: i

      do i = 1, size(list)
         if (allocated(list(i)%quantity)) call cover(range, [list(i)%value])
      end do
      has_summaries = span(range) > 0.0_wp
   end function has_summaries

   !> The script of a pair: a panel a field, a curve a run.
   subroutine write_overlay(set, overlay, number, status)
      type(file_set_t), intent(inout) :: set
      type(overlay_t), intent(in) :: overlay
      integer(ip), intent(in) :: number             !< of the pair
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      character(len=:), allocatable :: name
      integer, allocatable :: fields(:)
      integer :: i, label_width

      name = OVERLAY_PLOT//to_text(number)
      label_width = maxval([(len(overlay%runs(i)%label), i=1, size(overlay%runs))])
      fields = shown_fields(overlay%pairs(number))
      call begin_script(set, name, 'contact pair '//to_text(number)//' of several runs along s', file)
      call put_contact_columns(file, number, '', 'last_step[i]', 'last_increment[i]')
      call put_runs(file, overlay%runs, overlay%is_csv)
      call put_line(file, 'heading = '//quoted(overlay%title))
      call put_line(file, 'pair_line = '//quoted('pair '//to_text(number)//doubt_text(overlay%runs)))
      call put_frame(file, size(fields), pair_range(overlay%pairs(number)), '"s [L]"')
      call put_line(file, 'right = '//to_text(min(WIDEST, 0.925_wp - 0.009_wp*real(label_width, wp)), 3)// &
                    '   # leaves room for the names')
      call put_terminal(file, name, '1000,height')
      call put_line(file, 'set multiplot title heading."\n".pair_line noenhanced')
      call put_looks(file, overlay, overlay%pairs(number)%most_points <= MOST_MARKED)
      do i = 1, size(fields)
         call put_field(file, i, fields(i), overlay%pairs(number), size(overlay%runs))
      end do
      call put_line(file, 'unset multiplot')
      call end_script(file, status)
   end subroutine write_overlay

   !> No shear and slip where no run has friction, no weighted pressure where it is the pressure.
   pure function shown_fields(pair) result(fields)
      type(overlay_pair_t), intent(in) :: pair
      integer, allocatable :: fields(:)

      fields = [FIELD_PRESSURE]
      if (pair%has_weighted) fields = [fields, FIELD_WEIGHTED]
      if (pair%has_shear) fields = [fields, FIELD_SHEAR, FIELD_SLIP]
      fields = [fields, FIELD_GAP]
   end function shown_fields

   pure type(range_t) function pair_range(pair) result(range)
      type(overlay_pair_t), intent(in) :: pair

      range = pair%s
      call cover(range, [0.0_wp])
      if (span(range) <= 0.0_wp) range = padded(range)
   end function pair_range

   !> The runs that did not converge, in words.
   pure function doubt_text(list) result(text)
      type(overlay_run_t), intent(in) :: list(:)
      character(len=:), allocatable :: text
      integer :: i

      text = ''
      do i = 1, size(list)
         if (.not. list(i)%not_converged) cycle
         if (len(text) > 0) text = text//', '
         text = text//list(i)%label
      end do
      if (len(text) > 0) text = ';  NOT CONVERGED: '//text
      text = cleaned(text, LONGEST_TITLE)
   end function doubt_text

   !> Folder, name and value of each run.
   subroutine put_runs(file, list, is_csv)
      type(text_file_t), intent(inout) :: file
      type(overlay_run_t), intent(in) :: list(:)
      logical, intent(in) :: is_csv                 !< of the tables
      character(len=:), allocatable :: k
      integer(ip) :: i

      call put_line(file, 'runs = '//to_text(size(list, kind=ip)))
      call put_line(file, 'array folder[runs]; array label[runs]; array value_of[runs]')
      call put_line(file, 'array last_step[runs]; array last_increment[runs]')
      do i = 1, size(list, kind=ip)
         k = '['//to_text(i)//'] = '
         call put_line(file, 'folder'//k//quoted(list(i)%from_plots)//'; label'//k//quoted(list(i)%label)//'; value_of'//k// &
                       trimmed_real(list(i)%value, 12))
         call put_line(file, 'last_step'//k//to_text(list(i)%step)//'; last_increment'//k//to_text(list(i)%increment))
      end do
      if (is_csv) call put_line(file, CSV_SEPARATOR)
      call put_line(file, 'table(i) = folder[i]."/contact'//merge(CSV_ENDING, TAB_ENDING, is_csv)//'"')
   end subroutine put_runs

   !> Colours: a line style a run as long as the legend holds them, else a palette with a bar.
   subroutine put_looks(file, overlay, is_marked)
      type(text_file_t), intent(inout) :: file
      type(overlay_t), intent(in) :: overlay
      logical, intent(in) :: is_marked
      integer, parameter :: MARK(MOST_IN_LEGEND) = [7, 5, 9, 11, 13, 6, 4, 8, 10, 12]
      character(len=9), parameter :: DASH(0:1) = ['dt 1     ', 'dt (8,4) ']
      character(len=:), allocatable :: points
      integer(ip) :: i

      if (size(overlay%runs) > MOST_IN_LEGEND) then
         call put_palette(file, overlay)
         return
      end if
      do i = 1, size(overlay%runs, kind=ip)
         points = ' ps 0'
         if (is_marked) points = ' pt '//to_text(int(MARK(i), ip))//' ps 0.8*dot'
         call put_line(file, 'set style line '//to_text(i)//' lw 1.8 lc rgb "'//COLOUR(mod(i - 1, int(N_COLOURS, ip)) + 1)// &
                       '" '//DASH((i - 1)/N_COLOURS)//points)
      end do
   end subroutine put_looks

   !> The palette viridis without its palest end, and the bar to the right of the panels.
   subroutine put_palette(file, overlay)
      type(text_file_t), intent(inout) :: file
      type(overlay_t), intent(in) :: overlay
      character(len=:), allocatable :: names
      type(range_t) :: range
      integer(ip) :: i

      call put_line(file, 'set palette defined (0 "#440154", 1 "#472c7a", 2 "#3b518b", 3 "#2c718e", 4 "#21908d", '// &
                    '5 "#27ad81", 6 "#5cc863", 7 "#aadc32")')
      call put_line(file, 'set colorbox user origin screen right + 0.03, screen bottom(panels) '// &
                    'size screen 0.02, screen top(1) - bottom(panels)')
      call cover(range, overlay%runs%value)
      if (span(range) <= 0.0_wp) range = padded(range)
      call put_line(file, 'set cbrange '//range_text(range))
      if (overlay%by_value) then
         call put_line(file, 'set cblabel '//quoted(overlay%parameter)//' noenhanced')
         call put_line(file, 'set format cb "%h"')
         if (is_logarithmic(overlay%runs%value)) call put_line(file, 'set logscale cb; set format cb "10^{%T}"')
      else if (size(overlay%runs) <= MOST_NAMED) then
         names = ''
         do i = 1, size(overlay%runs, kind=ip)
            if (i > 1) names = names//', '
            names = names//quoted(overlay%runs(i)%label)//' '//trimmed_real(overlay%runs(i)%value, 12)
         end do
         call put_line(file, 'set cbtics noenhanced ('//names//')')
      else
         call put_line(file, 'set cblabel "number of the run"')
      end if
   end subroutine put_palette

   subroutine put_field(file, place, field, pair, n_runs)
      type(text_file_t), intent(inout) :: file
      integer, intent(in) :: place                  !< of the panel
      integer, intent(in) :: field
      type(overlay_pair_t), intent(in) :: pair
      integer, intent(in) :: n_runs
      character(len=17), parameter :: LABEL(N_FIELDS) = &
                                      [character(len=17) :: 'pressure', 'weighted pressure', 'shear', 'slip', 'gap']
      character(len=5), parameter :: DIMENSION(N_FIELDS) = ['F/L^2', 'F/L^2', 'F/L^2', 'L    ', 'L    ']
      character(len=:), allocatable :: column

      call put_panel(file, place, trim(LABEL(field)), trim(DIMENSION(field)), pair%field(field))
      column = to_text(int(FIELD_COLUMN(field), ip))
      if (n_runs > MOST_IN_LEGEND) then
         if (place == 2) call put_line(file, 'unset colorbox')
         call put_line(file, 'plot for [i=1:runs] table(i) using 4:(col('//column//')):(value_of[i]) with lines lw 1.5 lc palette')
      else if (place == 1) then
         call put_line(file, 'plot for [i=1:runs] table(i) using 4:(col('//column// &
                       ')) with linespoints ls i title label[i] noenhanced')
      else
         call put_line(file, 'plot for [i=1:runs] table(i) using 4:(col('//column//')) with linespoints ls i')
      end if
   end subroutine put_field

end module atrito_overlay_plots
