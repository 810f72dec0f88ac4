!> Reads a table file back, for `atrito compare` and the tests.
module atrito_read_table
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t, append_string, lower_case, to_text
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use atrito_files, only: read_file
   use atrito_table, only: MARK_COLUMNS, MARK_NOT_CONVERGED
   implicit none (type, external)
   private
   public :: table_file_t, read_table, parse_table, find_column, item_text
   public :: ITEM_WORD, ITEM_INTEGER, ITEM_REAL, ITEM_NAN

   integer, parameter :: ITEM_WORD = 0, ITEM_INTEGER = 1, ITEM_REAL = 2, ITEM_NAN = 3

   !> A table as it stands in its file.
   type :: table_file_t
      character(len=:), allocatable :: name            !< file name without folder
      logical :: not_converged = .false.
      type(string_t), allocatable :: columns(:)        !< their names
      integer(ip) :: n_columns = 0, n_rows = 0
      character(len=:), allocatable :: text
      integer(ip), allocatable :: first(:, :), last(:, :) !< places of the items in text, (n_columns, n_rows)
      integer, allocatable :: kind(:, :)               !< ITEM_*
      real(wp), allocatable :: value(:, :)             !< of the numbers; NaN for words
   end type table_file_t

   character(len=1), parameter :: LINE_FEED = achar(10), CARRIAGE_RETURN = achar(13), TAB = achar(9)
   character(len=*), parameter :: BLANKS = ' '//TAB//CARRIAGE_RETURN

contains

   !> Reads a table file. status: STATUS_FILE when it cannot be read or is no table of atrito.
   subroutine read_table(path, table, status)
      character(len=*), intent(in) :: path
      type(table_file_t), intent(out) :: table
      type(status_t), intent(out) :: status
      character(len=:), allocatable :: text

      call read_file(path, text, status)
      if (.not. is_ok(status)) return
      call parse_table(text, path(index(path, '/', back=.true.) + 1:), table, status)
      if (.not. is_ok(status)) call set_status(status, STATUS_FILE, path//': '//status%text)
   end subroutine read_table

   !> Takes the text of a table apart. status: STATUS_FILE and a reason without the file's name.
   subroutine parse_table(text, name, table, status)
      character(len=*), intent(in) :: text, name
      type(table_file_t), intent(out) :: table
      type(status_t), intent(out) :: status
      integer :: first, last
      integer(ip) :: line, n_rows

      table%name = name
      table%text = text
      allocate (table%columns(0))
      if (index(text, achar(0)) > 0) then
         call set_status(status, STATUS_FILE, 'is not a text file')
         return
      end if
      call read_comments(table, n_rows)
      table%n_columns = size(table%columns, kind=ip)
      if (table%n_columns == 0) then
         call set_status(status, STATUS_FILE, 'is no table of atrito: it has no line `'//MARK_COLUMNS//' ...`')
         return
      end if
      allocate (table%first(table%n_columns, n_rows), table%last(table%n_columns, n_rows), source=0_ip)
      allocate (table%kind(table%n_columns, n_rows), source=ITEM_WORD)
      allocate (table%value(table%n_columns, n_rows), source=0.0_wp)
      first = 1
      line = 0
      do while (first <= len(text) .and. is_ok(status))
         last = end_of_line(text, first)
         line = line + 1
         if (is_row(text(first:last))) call read_row(table, first, last, line, status)
         first = last + 2
      end do
   end subroutine parse_table

   !> Place of the last character of the line that begins at `first`.
   pure integer function end_of_line(text, first) result(last)
      character(len=*), intent(in) :: text
      integer, intent(in) :: first

      last = index(text(first:), LINE_FEED)
      last = merge(len(text), first + last - 2, last == 0)
   end function end_of_line

   !> A line that is neither blank nor a comment.
   pure logical function is_row(line)
      character(len=*), intent(in) :: line
      integer :: i

      i = verify(line, BLANKS)
      is_row = i > 0
      if (is_row) is_row = line(i:i) /= '#'
   end function is_row

   !> The column names, the mark of a run that did not converge, and how many rows there are.
   subroutine read_comments(table, n_rows)
      type(table_file_t), intent(inout) :: table
      integer(ip), intent(out) :: n_rows
      integer :: first, last

      n_rows = 0
      first = 1
      do while (first <= len(table%text))
         last = end_of_line(table%text, first)
         associate (line => table%text(first:last))
            if (is_row(line)) n_rows = n_rows + 1
            if (index(line, MARK_NOT_CONVERGED) == 1) table%not_converged = .true.
            if (index(line, MARK_COLUMNS) == 1) call read_names(line(len(MARK_COLUMNS) + 1:), table%columns)
         end associate
         first = last + 2
      end do
   end subroutine read_comments

   subroutine read_names(line, names)
      character(len=*), intent(in) :: line
      type(string_t), allocatable, intent(inout) :: names(:)
      integer :: first, last

      last = 0
      do
         call next_item(line, last, first)
         if (first > last) exit
         call append_string(names, line(first:last))
      end do
   end subroutine read_names

   !> The next item behind `last`; first > last where there is none.
   pure subroutine next_item(line, last, first)
      character(len=*), intent(in) :: line
      integer, intent(inout) :: last
      integer, intent(out) :: first
      integer :: n

      n = verify(line(last + 1:), BLANKS)
      first = merge(last + n, len(line) + 1, n > 0)
      n = scan(line(first:), BLANKS)
      last = merge(first + n - 2, len(line), n > 0)
   end subroutine next_item

   subroutine read_row(table, begins, ends, line, status)
      type(table_file_t), intent(inout) :: table
      integer, intent(in) :: begins, ends           !< the row in table%text
      integer(ip), intent(in) :: line               !< its number, for the message
      type(status_t), intent(inout) :: status
      integer :: first, last
      integer(ip) :: n

      n = 0
      last = 0
      table%n_rows = table%n_rows + 1
      do
         call next_item(table%text(begins:ends), last, first)
         if (first > last) exit
         n = n + 1
         if (n > table%n_columns) cycle
         table%first(n, table%n_rows) = int(begins - 1 + first, ip)
         table%last(n, table%n_rows) = int(begins - 1 + last, ip)
         call read_item(table%text(begins - 1 + first:begins - 1 + last), table%kind(n, table%n_rows), &
                        table%value(n, table%n_rows))
      end do
      if (n /= table%n_columns) then
         call set_status(status, STATUS_FILE, 'line '//to_text(line)//' has '//to_text(n)//' values for '// &
                         to_text(table%n_columns)//' columns')
      end if
   end subroutine read_row

   !> A number, nan or a word. What does not fit into a double is a word.
   subroutine read_item(text, kind, value)
      character(len=*), intent(in) :: text
      integer, intent(out) :: kind                  !< ITEM_*
      real(wp), intent(out) :: value
      integer :: outcome

      call read_real(text, value, outcome)
      if (outcome == NUMBER_OK) then
         kind = merge(ITEM_REAL, ITEM_INTEGER, scan(text, '.eEdD') > 0)
         return
      end if
      value = ieee_value(1.0_wp, ieee_quiet_nan)
      kind = ITEM_WORD
      if (len(text) == 3) then
         if (lower_case(text) == 'nan') kind = ITEM_NAN
      end if
   end subroutine read_item

   !> Place of a column by name; 0 when there is none.
   pure integer(ip) function find_column(table, name) result(i)
      type(table_file_t), intent(in) :: table
      character(len=*), intent(in) :: name

      do i = 1, table%n_columns
         if (table%columns(i)%s == name) return
      end do
      i = 0
   end function find_column

   !> An item as it stands in the file.
   pure function item_text(table, column, row) result(text)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: column, row
      character(len=:), allocatable :: text

      text = table%text(table%first(column, row):table%last(column, row))
   end function item_text

end module atrito_read_table
