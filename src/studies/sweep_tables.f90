!> What a sweep writes beside the folders of its runs: sweep.tab, runs.tab, and the closing lines on the screen.
module atrito_sweep_tables
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, wp
   use atrito_page, only: page_t, begin_report, add_item, add_files, add_line, add_rule, left, right, number, plural
   use atrito_read_table, only: table_file_t, read_table, table_path, find_column, item_text
   use atrito_status, only: status_t, STATUS_OK
   use atrito_strings, only: string_t, append_string, join, to_text
   use atrito_table, only: table_t, begin_table, add_reals, add_integers, add_words
   implicit none (type, external)
   private
   public :: sweep_run_t, read_summary, row_of_quantity, summary_value, build_sweep, build_runs, compose_sweep, last_increment

   !> One run of a sweep.
   type :: sweep_run_t
      character(len=:), allocatable :: label           !< 'nu=0.3, eps=1e-4'
      character(len=:), allocatable :: folder          !< below the sweep's
      type(string_t), allocatable :: texts(:)          !< values of the parameters as the user wrote them
      real(wp), allocatable :: values(:)               !< the same as numbers
      integer :: code = STATUS_OK                      !< exit code of the run
      logical :: is_written = .false., is_whole = .false. !< it wrote tables; they go to the end of its history
      integer(ip) :: factorisations = 0                !< of bodies
      type(table_file_t) :: summary                    !< summary.tab; without rows where there is none
   end type sweep_run_t

   integer(ip), parameter :: MOST_ROWS = 12              !< runs on the screen; all are in runs.tab
   integer, parameter :: DIGITS = 5
   integer, parameter :: VALUE_WIDTH = 13
   character(len=32), parameter :: USUAL(4) = [character(len=32) :: 'effective_area_percent', 'normal_resultant', 'max_pressure', &
                                                                                                                'max_abs_shear']

   character(len=VALUE_WIDTH), parameter :: USUAL_HEADINGS(size(USUAL)) = &
                                            [character(len=VALUE_WIDTH) :: 'area [%]', 'normal [F]', 'max. p', 'max. |shear|']

contains

   !> Takes the table summary of a run that wrote one. status: STATUS_FILE.
   subroutine read_summary(folder, run, status)
      character(len=*), intent(in) :: folder           !< of the run
      type(sweep_run_t), intent(inout) :: run          !< gets its summary, if it wrote tables
      type(status_t), intent(out) :: status            !< STATUS_OK or STATUS_FILE

      if (.not. run%is_written) return
      call read_table(table_path(folder, 'summary'), run%summary, status)
   end subroutine read_summary

   !> The row of a quantity of the first pair, or of the step, in the last increment; 0 where the summary has none.
   pure integer(ip) function row_of_quantity(summary, quantity) result(row)
      type(table_file_t), intent(in) :: summary  !< summary.tab of a run
      character(len=*), intent(in) :: quantity   !< in its column quantity

      do row = last_increment(summary), summary%n_rows
         if (item_text(summary, find_column(summary, 'quantity'), row) == quantity) return
      end do
      row = 0
   end function row_of_quantity

   !> The value of a quantity of the first pair, or of the step, in the last increment.
   pure real(wp) function summary_value(summary, quantity, missing) result(value)
      type(table_file_t), intent(in) :: summary  !< summary.tab of a run
      character(len=*), intent(in) :: quantity   !< in its column quantity
      real(wp), intent(in) :: missing            !< where it has none
      integer(ip) :: row

      row = row_of_quantity(summary, quantity)
      value = missing
      if (row > 0) value = summary%value(find_column(summary, 'value'), row)
   end function summary_value

   !> The first row of the last increment.
   pure integer(ip) function last_increment(summary) result(row)
      type(table_file_t), intent(in) :: summary  !< summary.tab of a run; may have no rows
      integer(ip) :: step, increment

      step = find_column(summary, 'step')
      increment = find_column(summary, 'increment')
      row = 1
      if (min(step, increment) == 0) return
      do row = summary%n_rows, 2, -1
         if (item_text(summary, step, row - 1) /= item_text(summary, step, row)) return
         if (item_text(summary, increment, row - 1) /= item_text(summary, increment, row)) return
      end do
      row = 1
   end function last_increment

   !> The parameters, then the columns of summary.tab, then what is observed in the increment.
   subroutine build_sweep(names, observed, runs, table)
      type(string_t), intent(in) :: names(:), observed(:) !< the parameters; quantities of the step that have a column of their own
      type(sweep_run_t), intent(in) :: runs(:)            !< in the order of the sweep
      type(table_t), intent(out) :: table                 !< 'sweep'
      integer(ip), allocatable :: of_row(:), step(:), pair(:), increment(:)
      type(string_t), allocatable :: quantities(:), amounts(:)
      integer(ip) :: i, j, n

      n = sum(runs%summary%n_rows)
      allocate (of_row(n), step(n), pair(n), increment(n), quantities(n), amounts(n))
      n = 0
      do i = 1, size(runs, kind=ip)
         associate (summary => runs(i)%summary)
            do j = 1, summary%n_rows
               n = n + 1
               of_row(n) = i
               step(n) = nint(summary%value(find_column(summary, 'step'), j), ip)
               pair(n) = nint(summary%value(find_column(summary, 'pair'), j), ip)
               increment(n) = nint(summary%value(find_column(summary, 'increment'), j), ip)
               quantities(n)%s = item_text(summary, find_column(summary, 'quantity'), j)
               amounts(n)%s = item_text(summary, find_column(summary, 'value'), j)
            end do
         end associate
      end do
      call begin_table(table, 'sweep', 'a row a quantity of a run: the parameters, then the columns of summary', n)
      do i = 1, size(names, kind=ip)
         call add_reals(table, names(i)%s, '-', [(runs(of_row(j))%values(i), j=1, n)], 0.0_wp)
      end do
      call add_integers(table, 'step', step)
      call add_integers(table, 'pair', pair)
      call add_words(table, 'quantity', '-', quantities, on_the_left=.true.)
      call add_words(table, 'value', 'mixed', amounts, on_the_left=.false.)
      call add_integers(table, 'increment', increment)
      do i = 1, size(observed, kind=ip)
         call add_reals(table, observed(i)%s, 'mixed', [(values_in_rows(runs(j)%summary, observed(i)%s), j=1, size(runs))], 0.0_wp)
      end do
      do i = 1, size(runs, kind=ip)
         if (runs(i)%code == STATUS_OK) cycle
         call append_string(table%remarks, runs(i)%label//': exit code '//to_text(int(runs(i)%code, ip))// &
                            trim(merge(', its history ends early', '                        ', &
                                       runs(i)%is_written .and. .not. runs(i)%is_whole)))
      end do
   end subroutine build_sweep

   !> For each row of a summary the value of a quantity in its increment; nan where there is none.
   pure function values_in_rows(summary, quantity) result(values)
      type(table_file_t), intent(in) :: summary
      character(len=*), intent(in) :: quantity
      real(wp) :: values(summary%n_rows)
      integer(ip) :: j, name, step, increment

      values = ieee_value(1.0_wp, ieee_quiet_nan)
      name = find_column(summary, 'quantity')
      step = find_column(summary, 'step')
      increment = find_column(summary, 'increment')
      do j = 1, summary%n_rows
         if (item_text(summary, name, j) /= quantity) cycle
         where (summary%value(step, :summary%n_rows) == summary%value(step, j) &
                .and. summary%value(increment, :summary%n_rows) == summary%value(increment, j)) &
            values = summary%value(find_column(summary, 'value'), j)
      end do
   end function values_in_rows

   !> A row a run: how it ended, where it is, and what is observed at its end.
   subroutine build_runs(names, observed, runs, table)
      type(string_t), intent(in) :: names(:), observed(:) !< as of build_sweep
      type(sweep_run_t), intent(in) :: runs(:)            !< in the order of the sweep
      type(table_t), intent(out) :: table                 !< 'runs'
      type(string_t) :: folders(size(runs))
      real(wp) :: nan
      integer(ip) :: i, j, n

      nan = ieee_value(1.0_wp, ieee_quiet_nan)
      n = size(runs, kind=ip)
      do i = 1, n
         folders(i)%s = runs(i)%folder
      end do
      call begin_table(table, 'runs', 'a row a run', n)
      call add_integers(table, 'run', [(i, i=1, n)])
      do i = 1, size(names, kind=ip)
         call add_reals(table, names(i)%s, '-', [(runs(j)%values(i), j=1, n)], 0.0_wp)
      end do
      call add_integers(table, 'exit', [(int(runs(i)%code, ip), i=1, n)])
      call add_integers(table, 'factorisations', [(runs(i)%factorisations, i=1, n)])
      do i = 1, size(observed, kind=ip)
         call add_reals(table, observed(i)%s, 'mixed', [(merge(summary_value(runs(j)%summary, observed(i)%s, nan), nan, &
                                                               runs(j)%is_whole), j=1, n)], 0.0_wp)
      end do
      call add_words(table, 'folder', '-', folders, on_the_left=.true.)
   end subroutine build_runs

   !> The closing lines: a row a run, what is observed first, as far as there is room, and the usual quantities of the first contact
   !> pair behind it.
   subroutine compose_sweep(deck, names, observed, runs, folder, seconds, page, pictures)
      character(len=*), intent(in) :: deck, folder     !< path as the user wrote it; of the sweep
      type(string_t), intent(in) :: names(:), observed(:) !< of the parameters, and of what is observed
      type(sweep_run_t), intent(in) :: runs(:)         !< in the order of the sweep
      real(wp), intent(in) :: seconds(2)               !< wall clock and processor
      type(page_t), intent(out) :: page                !< what is to be printed
      type(string_t), intent(in) :: pictures(:)        !< that were drawn, names without folder and ending
      type(string_t) :: shown(size(USUAL))             ! quantities
      character(len=VALUE_WIDTH) :: cells(size(USUAL))
      integer(ip) :: i, k, n, n_observed

      n = size(runs, kind=ip)
      n_observed = min(size(observed, kind=ip), size(USUAL, kind=ip))
      do k = 1, size(USUAL, kind=ip)
         if (k <= n_observed) then
            shown(k) = observed(k)
            cells(k) = left(observed(k)%s, VALUE_WIDTH - 1)
         else
            shown(k)%s = trim(USUAL(k - n_observed))
            cells(k) = USUAL_HEADINGS(k - n_observed)
         end if
      end do
      call begin_report(page, '   sweep of '//deck)
      call add_rule(page, '-')
      call add_line(page, row_of(join(names, ', '), 'outer', cells, 'exit'))
      do i = 1, min(n, MOST_ROWS)
         do k = 1, size(shown, kind=ip)
            cells(k) = amount(runs(i), shown(k)%s)
         end do
         call add_line(page, row_of(join(runs(i)%texts, ', '), trim(amount(runs(i), 'picard_iterations')), cells, &
                                    to_text(int(runs(i)%code, ip))))
      end do
      if (n > MOST_ROWS) call add_line(page, '... and '//plural(n - MOST_ROWS, 'run', 'runs')//' more in sweep.tab')
      call add_rule(page, '-')
      call add_item(page, 'runs', to_text(n)//', '//to_text(count(runs%code == STATUS_OK, kind=ip))// &
                    ' of them solved and checked; '//plural(sum(runs%factorisations), 'factorisation', 'factorisations'))
      call add_item(page, 'time', number(seconds(1), 3)//' s ('//number(seconds(2), 3)//' s of processor)')
      call add_files(page, folder, 'sweep runs, and a folder a run', pictures)
   end subroutine compose_sweep

   !> Columns of the screen.
   pure function row_of(values, outer, amounts, code) result(text)
      character(len=*), intent(in) :: values, outer, amounts(:), code
      character(len=:), allocatable :: text
      integer :: i

      text = left(values, 16)//right(outer, 6)
      do i = 1, size(amounts)
         text = text//right(trim(amounts(i)), VALUE_WIDTH)
      end do
      text = text//right(code, 5)
   end function row_of

   !> A value of the summary as text of a few digits; '-' where there is none, or none of the end of the history.
   pure function amount(run, quantity) result(text)
      type(sweep_run_t), intent(in) :: run
      character(len=*), intent(in) :: quantity
      character(len=VALUE_WIDTH) :: text
      integer(ip) :: row

      row = row_of_quantity(run%summary, quantity)
      text = '-'
      if (row > 0 .and. run%is_whole) text = number(run%summary%value(find_column(run%summary, 'value'), row), DIGITS)
   end function amount

end module atrito_sweep_tables
