!> Changes the numbers of a folder of tables one by one and asks whether `atrito compare` would notice each.
!>
!>    perturb_tables FOLDER [RTOL]
!>
!> Every number of contact, nodes, reactions, stress and summary is changed in the text of its table by 1e-5 of its column's size
!> (summary: of its own value), up or down in turn, and the text is read and compared as the program does it; of tables with many
!> numbers one in so many, every column in its turn. The row equilibrium_residual is left out: its digits are rounding. RTOL
!> (default: that of compare) serves the must-fail test of this program itself. Exit 0: all noticed; 1: some were not, the first
!> ones are named, and nothing more is tried; 2: no folder of tables.
program perturb_tables
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: to_text
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_status, only: status_t, is_ok
   use atrito_files, only: file_exists
   use atrito_number_text, only: trimmed_real
   use atrito_read_table, only: table_file_t, read_table, parse_table, find_column, item_text, ITEM_WORD, ITEM_NAN
   use atrito_compare, only: comparison_t, begin_comparison, compare_tables, DEFAULT_RTOL
   implicit none (type, external)

   character(len=9), parameter :: NAMES(5) = ['contact  ', 'nodes    ', 'reactions', 'stress   ', 'summary  ']
   real(wp), parameter :: CHANGE = 1.0e-5_wp
   integer, parameter :: MOST_LINES = 20
   integer(ip), parameter :: MANY_NUMBERS = 1000_ip   !< of a table; of more only some are changed
   character(len=:), allocatable :: folder
   real(wp) :: rtol
   integer :: i, n_tables, n_changed, n_missed

   call read_arguments(folder, rtol)
   n_tables = 0
   n_changed = 0
   n_missed = 0
   do i = 1, size(NAMES)
      if (.not. file_exists(folder//'/'//trim(NAMES(i))//'.tab')) cycle
      n_tables = n_tables + 1
      call perturb_table(folder//'/'//trim(NAMES(i))//'.tab', n_changed, n_missed)
   end do
   print '(a)', to_text(int(n_tables, ip))//' tables, '//to_text(int(n_changed, ip))//' changes, '// &
      to_text(int(n_missed, ip))//' not noticed'
   if (n_changed == 0) stop 2, quiet = .true.
   if (n_missed > 0) stop 1, quiet = .true.

contains

   subroutine read_arguments(name, tolerance)
      character(len=:), allocatable, intent(out) :: name
      real(wp), intent(out) :: tolerance
      character(len=1000) :: argument
      integer :: outcome

      call get_command_argument(1, argument)
      name = trim(argument)
      tolerance = DEFAULT_RTOL
      if (command_argument_count() < 2) return
      call get_command_argument(2, argument)
      call read_real(trim(argument), tolerance, outcome)
      if (outcome /= NUMBER_OK) stop 2, quiet = .true.
   end subroutine read_arguments

   !> Changes each number of one table in turn.
   subroutine perturb_table(path, changed, missed)
      character(len=*), intent(in) :: path
      integer, intent(inout) :: changed, missed
      type(table_file_t) :: table
      type(status_t) :: status
      integer(ip) :: column, row
      real(wp) :: size_of_change
      integer(ip) :: stride

      call read_table(path, table, status)
      if (.not. is_ok(status)) then
         print '(a)', status%text
         stop 2, quiet = .true.
      end if
      if (differs(table, table%text)) then
         print '(a)', path//': differs from itself'
         missed = missed + 1
      end if
      stride = 1 + table%n_columns*table%n_rows/MANY_NUMBERS
      do column = 1, table%n_columns
         do row = 1 + mod(column, stride), table%n_rows, stride
            if (missed >= MOST_LINES) return
            if (table%kind(column, row) == ITEM_WORD .or. is_residual(table, row)) cycle
            size_of_change = CHANGE*scale_of(table, column, row)
            if (mod(row, 2_ip) == 0) size_of_change = -size_of_change
            call try_change(table, column, row, size_of_change, changed, missed)
         end do
      end do
   end subroutine perturb_table

   logical function is_residual(table, row)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: row
      integer(ip) :: column

      column = find_column(table, 'quantity')
      is_residual = .false.
      if (column > 0) is_residual = item_text(table, column, row) == 'equilibrium_residual'
   end function is_residual

   !> Size of a column; of the value itself in the column `value` of a summary. 1 where all is zero or not a number.
   real(wp) function scale_of(table, column, row) result(scale)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: column, row
      integer(ip) :: i

      scale = 0.0_wp
      do i = 1, table%n_rows
         if (table%columns(column)%s == 'value' .and. i /= row) cycle
         if (table%kind(column, i) == ITEM_WORD .or. table%kind(column, i) == ITEM_NAN) cycle
         scale = max(scale, abs(table%value(column, i)))
      end do
      if (scale <= 0.0_wp) scale = 1.0_wp
   end function scale_of

   subroutine try_change(table, column, row, by, changed, missed)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: column, row
      real(wp), intent(in) :: by
      integer, intent(inout) :: changed, missed
      character(len=:), allocatable :: text
      real(wp) :: value

      value = by
      if (table%kind(column, row) /= ITEM_NAN) value = table%value(column, row) + by
      text = table%text(:table%first(column, row) - 1)//trimmed_real(value, 17)//table%text(table%last(column, row) + 1:)
      changed = changed + 1
      if (differs(table, text)) return
      missed = missed + 1
      print '(a)', table%name//', row '//to_text(row)//', '//table%columns(column)%s//': '// &
         item_text(table, column, row)//' changed to '//trimmed_real(value, 17)//' is not noticed'
   end subroutine try_change

   !> Would `atrito compare` see a difference between a table and a changed text of it?
   logical function differs(table, text)
      type(table_file_t), intent(in) :: table
      character(len=*), intent(in) :: text
      type(table_file_t) :: other
      type(status_t) :: status
      type(comparison_t) :: comparison

      call parse_table(text, table%name, other, status)
      call begin_comparison(comparison, rtol, 0.0_wp)
      if (is_ok(status)) call compare_tables(table, other, comparison)
      differs = comparison%n_differences > 0
   end function differs

end program perturb_tables
