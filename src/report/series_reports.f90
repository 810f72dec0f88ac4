!> The reports of sweeps, studies and limits: verdict, key numbers, and a table of the runs.
module atrito_series_reports
   use atrito_files, only: file_exists
   use atrito_html, only: add_element, add_fact, add_list, add_note, unbroken
   use atrito_html_table, only: table_top_t, read_top, begin_rows, end_rows, add_cells, MANY_COLUMNS
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_libraries, only: library_t, list_libraries
   use atrito_page, only: page_t, add_line, number, plural
   use atrito_read_table, only: find_column, item_text
   use atrito_report, only: report_t, page_section_t, begin_section, add_section
   use atrito_stability_result, only: stability_t
   use atrito_stability_tables, only: limit_text, values_text, list_remarks
   use atrito_status, only: status_t, is_ok, STATUS_OK
   use atrito_strings, only: string_t, string_list_t, add_string, append_string, take_strings, to_text
   use atrito_study_errors, only: study_t, total_seconds, PROCESSOR
   use atrito_summary, only: quantity_names
   use atrito_sweep_tables, only: sweep_run_t, row_of_quantity, last_increment
   implicit none (type, external)
   private
   public :: begin_series, take_heading, report_of_sweep, report_of_study, report_of_limit

   integer, parameter :: DIGITS = 6
   integer, parameter :: MOST_RUNS = 200            !< in the table of runs
   !> Quantities of a sweep's runs that a reader looks at first.
   character(len=*), parameter :: SHOWN(6) = [character(len=22) :: 'effective_area_percent', 'normal_resultant', &
                                                                               'shear_resultant', 'max_pressure', 'strain_energy', &
                                                                                                           'error_estimate_percent']

contains

   !> What all of them have: names, tables, pictures, versions.
   subroutine begin_series(what, deck, folder, tables, pictures, report)
      character(len=*), intent(in) :: what          !< sweep, study, limit
      character(len=*), intent(in) :: deck, folder  !< path as the user wrote it; of the series
      character(len=*), intent(in) :: tables(:)     !< names without ending
      type(string_t), intent(in) :: pictures(:)     !< that were drawn
      type(report_t), intent(out) :: report         !< with names and versions, nothing of the runs
      type(library_t), allocatable :: libraries(:)
      integer :: i

      report%what = what
      report%deck = deck
      report%folder = folder
      report%pictures = pictures
      allocate (report%heading(0), report%details(0), report%facts(0), report%files(0), report%versions(0))
      do i = 1, size(tables)
         if (file_exists(folder//'/'//trim(tables(i))//'.tab')) call append_string(report%files, trim(tables(i))//'.tab')
         if (file_exists(folder//'/'//trim(tables(i))//'.csv')) call append_string(report%files, trim(tables(i))//'.csv')
      end do
      call list_libraries(.false., libraries)
      do i = 1, size(libraries)
         call add_fact(report%versions, trim(libraries(i)%name), libraries(i)%version)
      end do
   end subroutine begin_series

   !> The heading of the deck, as a table of one of its runs has it; none where there is no such table.
   subroutine take_heading(folder, report)
      character(len=*), intent(in) :: folder        !< of the run
      type(report_t), intent(inout) :: report       !< heading is set, where there is a table
      character(len=*), parameter :: MARK = 'heading: '
      type(table_top_t) :: top
      type(string_list_t) :: lines
      type(status_t) :: status
      integer :: i

      if (.not. file_exists(folder//'/summary.tab')) return
      call read_top(folder//'/summary.tab', 1_ip, top, status)
      if (.not. is_ok(status)) return
      do i = 1, size(top%origin)
         if (index(top%origin(i)%s, MARK) == 1) call add_string(lines, top%origin(i)%s(len(MARK) + 1:))
      end do
      call take_strings(lines, report%heading)
   end subroutine take_heading

   !> Runs that were solved of all that there are.
   subroutine judge_runs(n_solved, n, report)
      integer(ip), intent(in) :: n_solved, n
      type(report_t), intent(inout) :: report

      report%is_good = n_solved == n
      if (report%is_good) then
         report%verdict = 'All '//to_text(n)//' runs solved and checked'
      else
         report%verdict = to_text(n - n_solved)//' of '//plural(n, 'run', 'runs')//' NOT SOLVED'
         call append_string(report%details, 'The others are solved and checked. The exit codes are in the table of runs: '// &
                            '3 not converged, 4 no equilibrium.')
      end if
   end subroutine judge_runs

   !> Verdict, key numbers and the table of runs of a sweep.
   subroutine report_of_sweep(names, runs, seconds, report)
      type(string_t), intent(in) :: names(:)        !< the parameters
      type(sweep_run_t), intent(in) :: runs(:)      !< in the order of the sweep
      real(wp), intent(in) :: seconds(2)            !< wall clock and processor
      type(report_t), intent(inout) :: report       !< begun
      type(page_section_t) :: section
      integer :: i

      i = findloc(runs%is_written, .true., dim=1)
      if (i > 0) call take_heading(report%folder//'/'//runs(i)%folder, report)
      call judge_runs(count(runs%code == STATUS_OK, kind=ip), size(runs, kind=ip), report)
      call add_fact(report%facts, 'runs', to_text(size(runs, kind=ip)))
      call add_fact(report%facts, 'factorisations', to_text(sum(runs%factorisations)))
      call add_time(seconds, report)
      call begin_section(section, 'Runs')
      call add_note(section%page, 'A row a run, in the last increment; contact: of the first pair; exit 0: solved and checked.')
      call add_runs(section%page, names, runs)
      call add_section(report%leading, section)
      report%other_messages = 'Warnings and notes of the runs are in their listings, in the folders of the runs.'
   end subroutine report_of_sweep

   subroutine add_time(seconds, report)
      real(wp), intent(in) :: seconds(2)
      type(report_t), intent(inout) :: report

      call add_fact(report%facts, 'time', number(seconds(1), 3)//' s', number(seconds(2), 3)//' s of processor')
   end subroutine add_time

   !> A row of a table of runs; the titles before the first one. The column of words stands on the left.
   subroutine add_run(page, is_first, titles, cells, word)
      type(page_t), intent(inout) :: page
      logical, intent(in) :: is_first
      type(string_t), intent(in) :: titles(:), cells(:)
      integer, intent(in) :: word                   !< column
      integer :: k

      if (is_first) then
         call begin_rows(page, 'runs', size(titles) > MANY_COLUMNS)
         call add_line(page, '<thead>')
         call add_cells(page, 'th', titles, [(k == word, k=1, size(titles))])
         call add_line(page, '</thead><tbody>')
      end if
      call add_cells(page, 'td', cells, [(k == word, k=1, size(cells))])
   end subroutine add_run

   subroutine add_runs(page, names, runs)
      type(page_t), intent(inout) :: page
      type(string_t), intent(in) :: names(:)
      type(sweep_run_t), intent(in) :: runs(:)
      type(string_t), allocatable :: titles(:), columns(:), cells(:), known(:)
      integer :: i, k, j, l
      character(len=:), allocatable :: name
      integer(ip) :: row

      titles = names
      call append_string(titles, 'exit')
      ! Quantities that any run has: the first ones, and what the runs were asked to observe.
      known = quantity_names()
      allocate (columns(0))
      do l = 1, size(SHOWN)
         if (any([(len(amount_text(runs(j), trim(SHOWN(l)))) > 0, j=1, size(runs))])) call append_string(columns, trim(SHOWN(l)))
      end do
      do j = 1, size(runs)
         if (runs(j)%summary%n_rows == 0) cycle
         do row = last_increment(runs(j)%summary), runs(j)%summary%n_rows
            name = item_text(runs(j)%summary, find_column(runs(j)%summary, 'quantity'), row)
            if (.not. any([(known(l)%s == name, l=1, size(known)), (columns(l)%s == name, l=1, size(columns))])) then
               call append_string(columns, name)
            end if
         end do
      end do
      titles = [titles, columns]
      call append_string(titles, 'folder')
      do i = 1, min(size(runs), MOST_RUNS)
         cells = runs(i)%texts
         call append_string(cells, to_text(int(runs(i)%code, ip)))
         do k = size(cells) + 1, size(titles) - 1
            call append_string(cells, amount_text(runs(i), titles(k)%s))
         end do
         call append_string(cells, runs(i)%folder)
         call add_run(page, i == 1, titles, cells, size(cells))
      end do
      call end_rows(page)
      if (size(runs) > MOST_RUNS) call add_note(page, 'The first '//to_text(int(MOST_RUNS, ip))//' runs; all: table runs.')
   end subroutine add_runs

   !> A quantity of a run; '' where it has none.
   function amount_text(run, name) result(text)
      type(sweep_run_t), intent(in) :: run
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: text
      integer(ip) :: row

      text = ''
      if (run%summary%n_rows == 0) return
      row = row_of_quantity(run%summary, name)
      if (row > 0) text = number(run%summary%value(find_column(run%summary, 'value'), row), DIGITS)
   end function amount_text

   !> Verdict, references, what is said of the errors, and the table of runs of a study.
   subroutine report_of_study(study, report)
      type(study_t), intent(in) :: study            !< judged
      type(report_t), intent(inout) :: report       !< begun
      type(page_section_t) :: section
      integer :: i

      call judge_runs(count(study%rows%code == STATUS_OK, kind=ip), size(study%rows, kind=ip), report)
      do i = 1, size(study%quantities)
         associate (quantity => study%quantities(i))
            if (.not. is_nan(quantity%reference)) call add_fact(report%facts, quantity%name//', reference', &
                                                                number(quantity%reference, DIGITS), quantity%source)
         end associate
      end do
      call begin_section(section, 'What becomes of the errors')
      call add_list(section%page, study%words)
      call add_section(report%sections, section)
      call begin_section(section, 'Runs')
      call add_note(section%page, 'A row a run. Errors are relative to the reference; the order is that between this level and '// &
                    'the one before; cpu: seconds of processor.')
      call add_levels(section%page, study)
      call add_section(report%sections, section)
      report%other_messages = 'Warnings and notes of the runs are in their listings, in the folders of the runs.'
   end subroutine report_of_study

   subroutine add_levels(page, study)
      type(page_t), intent(inout) :: page
      type(study_t), intent(in) :: study
      type(string_t), allocatable :: titles(:), cells(:)
      integer :: i, k

      do k = 1, size(study%rows)
         titles = [string_t ::]
         cells = [string_t ::]
         associate (row => study%rows(k))
            call add('element', row%element)
            call add('level', to_text(row%level))
            call add('exit', to_text(row%code))
            call add('dofs', to_text(row%n_dofs))
            do i = 1, size(study%quantities)
               call add(study%quantities(i)%name, number(row%values(i), DIGITS))
               call add('error [%]', short_text(100*study%quantities(i)%error(k)))
               call add('order', short_text(study%quantities(i)%order(k)))
            end do
            call add('estimate [%]', short_text(row%estimate))
            call add('cpu [s]', number(total_seconds(row, PROCESSOR), 3))
         end associate
         call add_run(page, k == 1, titles, cells, 1)
      end do
      call end_rows(page)

   contains

      subroutine add(title, text)
         character(len=*), intent(in) :: title, text

         call append_string(titles, title)
         call append_string(cells, text)
      end subroutine add

   end subroutine add_levels

   !> A number, nothing where there is none.
   pure function short_text(x) result(text)
      real(wp), intent(in) :: x
      character(len=:), allocatable :: text

      text = ''
      if (.not. is_nan(x)) text = number(x, 3)
   end function short_text

   !> Verdict, the values that stand and fall, and the mechanism of a limit.
   subroutine report_of_limit(limit, seconds, report)
      type(stability_t), intent(in) :: limit        !< as found, with its collapse
      real(wp), intent(in) :: seconds(2)            !< wall clock and processor
      type(report_t), intent(inout) :: report       !< begun
      type(page_section_t) :: section
      type(string_t), allocatable :: labels(:), texts(:)
      character(len=:), allocatable :: text
      integer :: i

      report%is_good = limit%is_close
      report%verdict = 'Limit of '//limit%parameter//': '//limit_text(limit)
      if (.not. report%is_good) report%verdict = 'NOT AS CLOSE AS ASKED. '//report%verdict
      call append_string(report%details, 'It stands at '//limit%parameter//' = '//number(limit%stands, 10)//': solved and checked.')
      call append_string(report%details, 'It falls at '//limit%parameter//' = '//number(limit%falls, 10)//': proved.')
      call list_remarks(limit, labels, texts)
      do i = 1, size(texts)
         call append_string(report%details, labels(i)%s//': '//texts(i)%s)
      end do
      call add_fact(report%facts, 'stands at '//limit%parameter, number(limit%stands, 10), 'solved and checked')
      call add_fact(report%facts, 'falls at '//limit%parameter, number(limit%falls, 10), 'proved')
      do i = 1, size(limit%values)
         if (abs(limit%values(i)%value - limit%stands) > 0.0_wp .or. limit%values(i)%code /= STATUS_OK) cycle
         text = unbroken(number(limit%values(i)%displacement, DIGITS)//' [L]')
         call add_fact(report%facts, limit%watched, text, 'where it stands')
      end do
      text = values_text(limit)
      call add_fact(report%facts, 'values that were tried', text(:index(text, ': ') - 1), text(index(text, ': ') + 2:))
      report%other_messages = 'Warnings and notes of the deck were printed when its first value was read; they are not kept.'
      call add_time(seconds, report)
      call begin_section(section, 'Mechanism')
      call add_element(section%page, 'p', limit%collapse%text)
      call add_section(report%sections, section)
   end subroutine report_of_limit

end module atrito_series_reports
