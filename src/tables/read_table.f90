!> Reads a table file back, for `atrito compare`, sweeps and the tests: one with a head of comments, or comma-separated values.
module atrito_read_table
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t, append_string, lower_case, to_text
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use atrito_csv_text, only: is_formula, NO_FORMULA
   use atrito_files, only: read_file, file_exists
   use atrito_utf8, only: has_controls
   use atrito_table, only: MARK_COLUMNS, MARK_NOT_CONVERGED, TAB_ENDING, CSV_ENDING, HEAD_ENDING
   implicit none (type, external)
   private
   public :: table_file_t, read_table, parse_table, table_path, comment_of, find_column, item_text
   public :: ITEM_WORD, ITEM_INTEGER, ITEM_REAL, ITEM_NAN, HEAD_NAMES

   integer, parameter :: ITEM_WORD = 0, ITEM_INTEGER = 1, ITEM_REAL = 2, ITEM_NAN = 3

   !> What the head says of where a table comes from.
   character(len=10), parameter :: HEAD_NAMES(4) = ['deck      ', 'parameters', 'options   ', 'digest    ']

   !> A table as it stands in its file.
   type :: table_file_t
      character(len=:), allocatable :: name               !< file name without folder
      logical :: is_csv = .false.                         !< its head is a file beside it
      logical :: has_head = .false.                       !< else it does not tell whether the run converged, and of what
      type(string_t) :: head(size(HEAD_NAMES))            !< what it says; '': nothing
      logical :: not_converged = .false.                  !< its head says so
      type(string_t), allocatable :: columns(:)           !< their names
      integer(ip) :: n_columns = 0, n_rows = 0            !< in the file
      character(len=:), allocatable :: text               !< the whole file
      integer(ip), allocatable :: first(:, :), last(:, :) !< places of the items in text, (n_columns, n_rows)
      integer, allocatable :: kind(:, :)                  !< ITEM_*
      real(wp), allocatable :: value(:, :)                !< of the numbers; NaN for words
   end type table_file_t

   integer, parameter :: MOST_COLUMNS = 10000          !< a table of more is none of atrito
   character(len=1), parameter :: LINE_FEED = achar(10), CARRIAGE_RETURN = achar(13), TAB = achar(9)
   character(len=*), parameter :: BLANKS = ' '//TAB//CARRIAGE_RETURN
   character(len=1), parameter :: QUOTE = '"'

contains

   !> The file of a table in a folder, in the form in which it is there; that with a head where it is there in neither.
   function table_path(folder, name) result(path)
      character(len=*), intent(in) :: folder, name     !< name of the table
      character(len=:), allocatable :: path

      path = folder//'/'//name//TAB_ENDING
      if (file_exists(path)) return
      if (file_exists(folder//'/'//name//CSV_ENDING)) path = folder//'/'//name//CSV_ENDING
   end function table_path

   !> Reads a table file. status: STATUS_FILE when it cannot be read or is no table of atrito.
   subroutine read_table(path, table, status)
      character(len=*), intent(in) :: path     !< as the user wrote it, with folder and ending
      type(table_file_t), intent(out) :: table !< of no use where the status is not OK
      type(status_t), intent(out) :: status    !< STATUS_FILE where it cannot be read or is no table of atrito
      character(len=:), allocatable :: text

      call read_file(path, text, status)
      if (.not. is_ok(status)) return
      call parse_table(text, path(index(path, '/', back=.true.) + 1:), table, status)
      if (.not. is_ok(status)) call set_status(status, STATUS_FILE, path//': '//status%text)
      if (.not. (is_ok(status) .and. table%is_csv)) return
      associate (beside => path(:len(path) - len(CSV_ENDING))//HEAD_ENDING)
         if (.not. file_exists(beside)) return
         call read_file(beside, text, status)
         if (is_ok(status)) call read_head(text, table)
      end associate
   end subroutine read_table

   !> Takes the text of a table apart. status: STATUS_FILE and a reason without the file's name.
   subroutine parse_table(text, name, table, status)
      character(len=*), intent(in) :: text, name !< the whole file; its name without folder
      type(table_file_t), intent(out) :: table   !< of no use where the status is not OK
      type(status_t), intent(out) :: status      !< STATUS_FILE and what is wrong, without the name
      integer :: first, last, i, k
      integer(ip) :: line, n_rows

      do i = 1, size(HEAD_NAMES)
         table%head(i)%s = ''
      end do
      table%name = name
      table%text = text
      table%is_csv = index(name, CSV_ENDING, back=.true.) == max(1, len(name) - len(CSV_ENDING) + 1)
      allocate (table%columns(0))
      if (place_of(achar(0), text, 1) <= len(text)) then
         call set_status(status, STATUS_FILE, 'is not a text file')
         return
      end if
      first = 1
      if (table%is_csv) then
         call read_first_row(table, first, n_rows, status)
      else
         call read_comments(table, n_rows)
         if (size(table%columns) == 0) then
            call set_status(status, STATUS_FILE, 'is no table of atrito: it has no line `'//MARK_COLUMNS//' ...`')
         end if
      end if
      if (.not. is_ok(status)) return
      table%n_columns = size(table%columns, kind=ip)
      ! status: STATUS_FILE for names that no table has.
      if (size(table%columns) > MOST_COLUMNS) call set_status(status, STATUS_FILE, 'is no table of atrito: it has more than '// &
                                                              to_text(MOST_COLUMNS)//' columns')
      do k = 1, size(table%columns)
         if (has_controls(table%columns(k)%s)) call set_status(status, STATUS_FILE, &
                                                               'is no table of atrito: a name has control characters')
      end do
      if (.not. is_ok(status)) return
      ! a row that is whole has a character for each column; behind one that is not nothing is read
      n_rows = min(n_rows, int(len(text)/table%n_columns, ip) + 2_ip)
      allocate (table%first(table%n_columns, n_rows), table%last(table%n_columns, n_rows), source=0_ip)
      allocate (table%kind(table%n_columns, n_rows), source=ITEM_WORD)
      allocate (table%value(table%n_columns, n_rows), source=0.0_wp)
      line = merge(1, 0, table%is_csv)
      do while (first <= len(text) .and. is_ok(status))
         last = end_of_line(text, first)
         line = line + 1
         if (is_row(text(first:last), table%is_csv)) then
            call read_row(table, first, last, line, status)
            if (has_controls(text(first:last))) call set_status(status, STATUS_FILE, 'line '//to_text(line)// &
                                                                ' has control characters')
         end if
         first = last + 2
      end do
   end subroutine parse_table

   !> Place of the last character of the line that begins at `first`.
   pure integer function end_of_line(text, first) result(last)
      character(len=*), intent(in) :: text
      integer, intent(in) :: first

      last = place_of(LINE_FEED, text, first) - 1
   end function end_of_line

   !> Where a character stands first, from `first` on; behind the text where it does not. `index` takes several times as long.
   pure integer function place_of(character, text, first) result(i)
      character(len=1), intent(in) :: character
      character(len=*), intent(in) :: text
      integer, intent(in) :: first

      do i = first, len(text)
         if (text(i:i) == character) exit
      end do
   end function place_of

   !> A line that is neither blank nor a comment; among comma-separated values there are none.
   pure logical function is_row(line, is_csv)
      character(len=*), intent(in) :: line
      logical, intent(in) :: is_csv
      integer :: i

      i = verify(line, BLANKS)
      is_row = i > 0
      if (is_row .and. .not. is_csv) is_row = line(i:i) /= '#'
   end function is_row

   !> The names in the first row of comma-separated values, and how many rows follow.
   subroutine read_first_row(table, next, n_rows, status)
      type(table_file_t), intent(inout) :: table
      integer, intent(out) :: next                  !< first character of the next line
      integer(ip), intent(out) :: n_rows
      type(status_t), intent(inout) :: status
      real(wp) :: value
      integer :: first, last, ends, outcome

      ends = end_of_line(table%text, 1)
      next = 1
      outcome = NUMBER_OK
      do while (next <= last_of_row(table%text, ends) + 1)
         call take_csv_item(table%text(:ends), next, first, last)
         call append_string(table%columns, table%text(first:last))
         call read_real(table%text(first:last), value, outcome)
         if (outcome == NUMBER_OK .or. first > last .or. size(table%columns) > MOST_COLUMNS) exit
      end do
      if (size(table%columns) == 0 .or. outcome == NUMBER_OK .or. first > last) then
         call set_status(status, STATUS_FILE, 'is no table of atrito: its first row has no names')
      end if
      next = ends + 2
      n_rows = 0
      first = next
      do while (first <= len(table%text))
         last = end_of_line(table%text, first)
         if (is_row(table%text(first:last), .true.)) n_rows = n_rows + 1
         first = last + 2
      end do
   end subroutine read_first_row

   !> Place of the last character of a row, the carriage return apart.
   pure integer function last_of_row(text, ends) result(last)
      character(len=*), intent(in) :: text
      integer, intent(in) :: ends                   !< of the line; 0: it is empty

      last = ends
      if (ends == 0) return
      if (text(ends:ends) == CARRIAGE_RETURN) last = ends - 1
   end function last_of_row

   !> The item of comma-separated values that begins at `next`, which moves to that behind it: beyond the character after the row
   !> there is none. Of an item in quotes what stands between them, doubled quotes as single ones.
   pure subroutine take_csv_item(text, next, first, last)
      character(len=*), intent(inout) :: text       !< up to the end of the row
      integer, intent(inout) :: next
      integer, intent(out) :: first, last
      integer :: i

      first = next
      last = last_of_row(text, len(text))
      next = index(text(first:last), ',')
      next = merge(first + next, last + 2, next > 0)
      if (text(first:min(first, last)) /= QUOTE) then
         last = next - 2
         if (is_guarded(text(first:last))) first = first + 1
         return
      end if
      first = first + 1
      i = first
      next = first                                  ! where the next character goes
      do while (i <= last)
         if (text(i:i) == QUOTE) then
            if (text(i + 1:min(i + 1, last)) /= QUOTE) exit
            i = i + 1
         end if
         text(next:next) = text(i:i)
         next = next + 1
         i = i + 1
      end do
      last = next - 1
      next = i + 2
      if (is_guarded(text(first:last))) first = first + 1
   end subroutine take_csv_item

   !> An apostrophe keeps spreadsheets from computing the word behind it.
   pure logical function is_guarded(item)
      character(len=*), intent(in) :: item

      is_guarded = .false.
      if (len(item) > 1) is_guarded = item(1:1) == NO_FORMULA .and. is_formula(item(2:))
   end function is_guarded

   !> The column names, the mark of a run that did not converge, and how many rows there are.
   subroutine read_comments(table, n_rows)
      type(table_file_t), intent(inout) :: table
      integer(ip), intent(out) :: n_rows
      integer :: first, last

      n_rows = 0
      first = 1
      call read_head(table%text, table)
      do while (first <= len(table%text))
         last = end_of_line(table%text, first)
         associate (line => table%text(first:last))
            if (is_row(line, .false.)) n_rows = n_rows + 1
            if (line(:min(len(line), len(MARK_COLUMNS))) == MARK_COLUMNS) then
               call read_names(line(len(MARK_COLUMNS) + 1:), table%columns)
            end if
         end associate
         first = last + 2
      end do
   end subroutine read_comments

   !> The mark of a run that did not converge, and what the head says of it: the first comment lines of a text.
   pure subroutine read_head(text, table)
      character(len=*), intent(in) :: text
      type(table_file_t), intent(inout) :: table
      integer :: first, last, i

      table%has_head = .true.
      first = 1
      do while (first <= len(text))
         last = end_of_line(text, first)
         if (text(first:first) /= '#') exit
         associate (line => text(first:last))
            if (index(line, MARK_NOT_CONVERGED) == 1) table%not_converged = .true.
            do i = 1, size(HEAD_NAMES)
               associate (mark => '# '//trim(HEAD_NAMES(i))//': ')
                  if (index(line, mark) == 1) table%head(i)%s = trim(line(len(mark) + 1:))
               end associate
            end do
         end associate
         first = last + 2
      end do
   end subroutine read_head

   subroutine read_names(line, names)
      character(len=*), intent(in) :: line
      type(string_t), allocatable, intent(inout) :: names(:)
      integer :: first, last

      last = 0
      do
         call next_item(line, last, first)
         if (first > last .or. size(names) > MOST_COLUMNS) exit
         call append_string(names, line(first:last))
      end do
   end subroutine read_names

   !> The next item behind `last`; first > last where there is none.
   pure subroutine next_item(line, last, first)
      character(len=*), intent(in) :: line
      integer, intent(inout) :: last
      integer, intent(out) :: first

      do first = last + 1, len(line)
         if (.not. is_blank(line(first:first))) exit
      end do
      do last = first, len(line) - 1
         if (is_blank(line(last + 1:last + 1))) exit
      end do
      last = min(last, len(line))
   end subroutine next_item

   pure logical function is_blank(letter)
      character(len=1), intent(in) :: letter

      is_blank = letter == ' ' .or. letter == TAB .or. letter == CARRIAGE_RETURN
   end function is_blank

   subroutine read_row(table, begins, ends, line, status)
      type(table_file_t), intent(inout) :: table
      integer, intent(in) :: begins, ends           !< the row in table%text
      integer(ip), intent(in) :: line               !< its number, for the message
      type(status_t), intent(inout) :: status
      integer :: first, last, next
      integer(ip) :: n

      n = 0
      last = begins - 1
      next = begins
      table%n_rows = table%n_rows + 1
      do
         if (table%is_csv) then
            if (next > last_of_row(table%text, ends) + 1) exit
            call take_csv_item(table%text(:ends), next, first, last)
         else
            call next_item(table%text(:ends), last, first)
            if (first > last) exit
         end if
         n = n + 1
         if (n > table%n_columns) cycle
         table%first(n, table%n_rows) = int(first, ip)
         table%last(n, table%n_rows) = int(last, ip)
         call read_item(table%text(first:last), table%kind(n, table%n_rows), table%value(n, table%n_rows))
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

   !> The first line `# <what>: ...` of a table, without its mark; empty where there is none.
   pure function comment_of(text, what) result(comment)
      character(len=*), intent(in) :: text, what    !< the whole file; 'heading', 'deck'
      character(len=:), allocatable :: comment
      integer :: first, length

      comment = ''
      first = index(text, new_line('a')//'# '//what//': ')
      if (first == 0) return
      first = first + len(what) + 5
      length = index(text(first:), new_line('a')) - 1
      if (length > 0) comment = trim(text(first:first + length - 1))
   end function comment_of

   !> Place of a column by name; 0 when there is none.
   pure integer(ip) function find_column(table, name) result(i)
      type(table_file_t), intent(in) :: table !< read
      character(len=*), intent(in) :: name    !< letter for letter

      do i = 1, table%n_columns
         if (table%columns(i)%s == name) return
      end do
      i = 0
   end function find_column

   !> An item as it stands in the file.
   pure function item_text(table, column, row) result(text)
      type(table_file_t), intent(in) :: table !< read
      integer(ip), intent(in) :: column, row  !< from 1
      character(len=:), allocatable :: text

      text = table%text(table%first(column, row):table%last(column, row))
   end function item_text

end module atrito_read_table
