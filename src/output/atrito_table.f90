!> A table: named columns with dimensions, and how it becomes a text file that people, numpy and gnuplot read.
module atrito_table
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_strings, only: string_t, append_string
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   use atrito_files, only: file_set_t, text_file_t, begin_files, end_files, open_text, put_line, put_lines, close_text, &
                           NEW_LINE_CHARACTER
   use atrito_status, only: status_t, is_ok
   use atrito_threads, only: n_threads, is_shared
   use atrito_number_text, only: put_reals, put_integers, real_width, integer_width
   implicit none (type, external)
   private
   public :: table_t, origin_t, begin_table, add_reals, add_field, add_integers, add_integer_field, add_words, &
             add_real_columns, write_table, write_table_set, clear_small, abs_is_below, one_word
   public :: MARK_NOT_CONVERGED, MARK_COLUMNS, MARK_DIMENSIONS, ZERO_SHARE

   character(len=*), parameter :: MARK_NOT_CONVERGED = '# NOT CONVERGED'
   character(len=*), parameter :: MARK_COLUMNS = '# columns:'
   character(len=*), parameter :: MARK_DIMENSIONS = '# dimensions:'
   !> A value below this share of its field's scale is rounding and is written as 0.
   real(wp), parameter :: ZERO_SHARE = 1.0e-14_wp

   integer, parameter :: KIND_REAL = 1, KIND_INTEGER = 2, KIND_WORD = 3
   !> Rows that are made into text at a time: that of a wide table stays in the nearer part of the cache.
   integer(ip), parameter :: PIECE_ROWS = 256
   !> Pieces of a round for each thread: where there are many, a thread that is late matters little.
   integer(ip), parameter :: PIECES_OF_THREAD = 64

   type :: column_t
      character(len=:), allocatable :: name, dimension
      integer :: kind = KIND_REAL
      real(wp) :: zero = 0.0_wp                    !< smaller values are written as 0
      logical :: on_the_left = .false.             !< within its field
      integer :: first = 0, last = 0               !< its place in a line
      real(wp), allocatable :: reals(:)
      real(wp), pointer :: field(:) => null()      !< reals that stay where they are; the table knows which of them
      integer(ip), allocatable :: integers(:)      !< (n_rows), or one for all rows
      integer(ip), pointer :: integer_field(:) => null(), ids(:) => null()   !< integers that stay where they are
      type(string_t), allocatable :: words(:)
   end type column_t

   type :: table_t
      character(len=:), allocatable :: name        !< file name without .tab
      character(len=:), allocatable :: title       !< what a row is
      type(string_t), allocatable :: remarks(:)    !< further comment lines
      integer(ip) :: n_rows = 0
      integer(ip), allocatable :: places(:)        !< of each row in the fields; not allocated: all, in order
      type(column_t), allocatable :: columns(:)
   end type table_t

   !> Where tables come from: the comment lines at their top.
   type :: origin_t
      character(len=:), allocatable :: deck        !< file name, without folder
      type(string_t), allocatable :: heading(:)
      logical :: not_converged = .false.
   end type origin_t

contains

   !> Begins a table without columns.
   pure subroutine begin_table(table, name, title, n_rows)
      type(table_t), intent(out) :: table
      character(len=*), intent(in) :: name, title
      integer(ip), intent(in) :: n_rows

      table%name = name
      table%title = title
      table%n_rows = n_rows
      allocate (table%columns(0), table%remarks(0))
   end subroutine begin_table

   !> Adds a column of reals.
   pure subroutine add_reals(table, name, dimension, values, scale)
      type(table_t), intent(inout) :: table
      character(len=*), intent(in) :: name
      character(len=*), intent(in) :: dimension     !< in F and L; '-' for none
      real(wp), intent(in) :: values(:)             !< (n_rows)
      real(wp), intent(in) :: scale                 !< largest value of the field; 0: nothing is rounding
      type(column_t) :: column

      column%kind = KIND_REAL
      column%zero = ZERO_SHARE*scale
      column%reals = values
      call add_column(table, name, dimension, column)
   end subroutine add_reals

   !> Adds columns of reals of which nothing is rounding.
   pure subroutine add_real_columns(table, names, dimensions, values)
      type(table_t), intent(inout) :: table
      character(len=*), intent(in) :: names(:), dimensions(:)
      real(wp), intent(in) :: values(:, :)          !< (n_rows, columns)
      integer :: i

      do i = 1, size(names)
         call add_reals(table, trim(names(i)), trim(dimensions(i)), values(:, i), 0.0_wp)
      end do
   end subroutine add_real_columns

   !> Adds a column of reals that are not copied but read when the table is written: those at table%places.
   subroutine add_field(table, name, dimension, field, scale)
      type(table_t), intent(inout) :: table
      character(len=*), intent(in) :: name, dimension
      real(wp), intent(in), target :: field(:)
      real(wp), intent(in) :: scale
      type(column_t) :: column

      column%kind = KIND_REAL
      column%zero = ZERO_SHARE*scale
      column%field => field
      call add_column(table, name, dimension, column)
   end subroutine add_field

   !> Adds a column of integers.
   pure subroutine add_integers(table, name, values)
      type(table_t), intent(inout) :: table
      character(len=*), intent(in) :: name
      integer(ip), intent(in) :: values(:)          !< (n_rows), or one for all rows
      type(column_t) :: column

      column%kind = KIND_INTEGER
      column%integers = values
      call add_column(table, name, '-', column)
   end subroutine add_integers

   !> Adds a column of integers that are not copied but read when the table is written: those at table%places. With ids they are
   !> places in them, and the ids are written.
   subroutine add_integer_field(table, name, field, ids)
      type(table_t), intent(inout) :: table
      character(len=*), intent(in) :: name
      integer(ip), intent(in), target :: field(:)
      integer(ip), intent(in), target, optional :: ids(:)
      type(column_t) :: column

      column%kind = KIND_INTEGER
      column%integer_field => field
      if (present(ids)) column%ids => ids
      call add_column(table, name, '-', column)
   end subroutine add_integer_field

   !> Adds a column of words; none may be empty or hold a blank.
   pure subroutine add_words(table, name, dimension, values, on_the_left)
      type(table_t), intent(inout) :: table
      character(len=*), intent(in) :: name, dimension
      type(string_t), intent(in) :: values(:)       !< (n_rows)
      logical, intent(in) :: on_the_left            !< names; numbers stand on the right
      type(column_t) :: column

      column%kind = KIND_WORD
      column%on_the_left = on_the_left
      column%words = values
      call add_column(table, name, dimension, column)
   end subroutine add_words

   pure subroutine add_column(table, name, dimension, column)
      type(table_t), intent(inout) :: table
      character(len=*), intent(in) :: name, dimension
      type(column_t), intent(inout) :: column
      type(column_t), allocatable :: longer(:)
      integer :: i, n

      n = size(table%columns)
      allocate (longer(n + 1))
      do i = 1, n
         call move_column(table%columns(i), longer(i))
      end do
      call move_column(column, longer(n + 1))
      longer(n + 1)%name = name
      longer(n + 1)%dimension = dimension
      call move_alloc(longer, table%columns)
   end subroutine add_column

   !> Hands a column on without a copy of its numbers.
   pure subroutine move_column(from, to)
      type(column_t), intent(inout) :: from, to

      to%kind = from%kind
      to%zero = from%zero
      to%on_the_left = from%on_the_left
      to%field => from%field
      to%integer_field => from%integer_field
      to%ids => from%ids
      if (allocated(from%name)) call move_alloc(from%name, to%name)
      if (allocated(from%dimension)) call move_alloc(from%dimension, to%dimension)
      if (allocated(from%reals)) call move_alloc(from%reals, to%reals)
      if (allocated(from%integers)) call move_alloc(from%integers, to%integers)
      if (allocated(from%words)) call move_alloc(from%words, to%words)
   end subroutine move_column

   !> Writes <name>.tab into a set of files.
   !>
   !> status: STATUS_FILE when it could not be written.
   subroutine write_table(set, table, origin, digits, status)
      type(file_set_t), intent(inout) :: set
      type(table_t), intent(inout) :: table         !< its columns get their places
      type(origin_t), intent(in) :: origin
      integer, intent(in) :: digits                 !< significant digits, 6..17
      type(status_t), intent(out) :: status
      type(text_file_t) :: file

      call open_text(set, table%name//'.tab', file)
      call place_columns(table, digits)
      call write_top(file, table, origin)
      call write_rows(file, table, digits)
      call close_text(file, status)
   end subroutine write_table

   !> Writes tables into a folder, all or none. status: STATUS_FILE.
   subroutine write_table_set(folder, tables, origin, digits, status)
      character(len=*), intent(in) :: folder
      type(table_t), intent(inout) :: tables(:)
      type(origin_t), intent(in) :: origin
      integer, intent(in) :: digits
      type(status_t), intent(out) :: status
      type(file_set_t) :: set
      integer :: i

      call begin_files(set, folder, status)
      do i = 1, size(tables)
         if (is_ok(status)) call write_table(set, tables(i), origin, digits, status)
      end do
      call end_files(set, status)
   end subroutine write_table_set

   !> Gives each column room for its values, its name and its dimension, so that the names stand above the numbers.
   subroutine place_columns(table, digits)
      type(table_t), intent(inout) :: table
      integer, intent(in) :: digits
      integer :: i, last, width

      last = len(MARK_DIMENSIONS)
      do i = 1, size(table%columns)
         associate (column => table%columns(i))
            width = max(len(column%name), len(column%dimension), value_width(table, column, digits))
            column%first = last + 2
            column%last = last + 1 + width
            last = column%last
         end associate
      end do
   end subroutine place_columns

   integer function value_width(table, column, digits) result(width)
      type(table_t), intent(in) :: table
      type(column_t), intent(in) :: column
      integer, intent(in) :: digits
      integer :: i

      width = 1
      select case (column%kind)
      case (KIND_REAL)
         width = real_width(digits)
      case (KIND_INTEGER)
         width = width_of_integers(table, column)
      case (KIND_WORD)
         do i = 1, size(column%words)
            width = max(width, len(column%words(i)%s))
         end do
      end select
   end function value_width

   integer function width_of_integers(table, column) result(width)
      type(table_t), intent(in) :: table
      type(column_t), intent(in) :: column
      integer(ip) :: x(PIECE_ROWS), before, n

      width = 1
      !$omp parallel do default(none) private(n, x) shared(table, column) reduction(max:width) if(is_shared(table%n_rows))
      do before = 0, table%n_rows - 1, PIECE_ROWS
         n = min(PIECE_ROWS, table%n_rows - before)
         call fetch_integers(table, column, before, x(:n))
         width = max(width, integer_width(maxval(x(:n))), integer_width(minval(x(:n))))
      end do
      !$omp end parallel do
   end function width_of_integers

   subroutine write_top(file, table, origin)
      type(text_file_t), intent(inout) :: file
      type(table_t), intent(in) :: table
      type(origin_t), intent(in) :: origin
      type(string_t), allocatable :: names(:), dimensions(:)
      integer :: i

      if (origin%not_converged) call put_line(file, MARK_NOT_CONVERGED)
      call put_line(file, '# program: '//PROGRAM_NAME//' '//PROGRAM_VERSION)
      call put_line(file, '# deck: '//origin%deck)
      do i = 1, size(origin%heading)
         call put_line(file, '# heading: '//origin%heading(i)%s)
      end do
      call put_line(file, '# table: '//table%name//', '//table%title)
      do i = 1, size(table%remarks)
         call put_line(file, '# '//table%remarks(i)%s)
      end do
      do i = 1, size(table%columns)
         call append_string(names, table%columns(i)%name)
         call append_string(dimensions, table%columns(i)%dimension)
      end do
      call put_line(file, title_line(table, MARK_COLUMNS, names))
      call put_line(file, title_line(table, MARK_DIMENSIONS, dimensions))
   end subroutine write_top

   pure function title_line(table, mark, titles) result(line)
      type(table_t), intent(in) :: table
      character(len=*), intent(in) :: mark
      type(string_t), intent(in) :: titles(:)
      character(len=:), allocatable :: line
      integer :: i

      line = repeat(' ', table%columns(size(table%columns))%last)
      line(:len(mark)) = mark
      do i = 1, size(titles)
         call put_word(titles(i)%s, table%columns(i)%on_the_left, line(table%columns(i)%first:table%columns(i)%last))
      end do
   end function title_line

   !> Writes the rows by rounds: while the text of one is made, in pieces that threads share out, that of the one before is written.
   !> What stands in the file depends neither on the rounds nor on the pieces.
   subroutine write_rows(file, table, digits)
      type(text_file_t), intent(inout) :: file
      type(table_t), intent(in) :: table
      integer, intent(in) :: digits
      character(len=:), allocatable :: text(:, :)
      integer(ip) :: pieces, round, i

      pieces = 1
      if (n_threads() > 1) pieces = PIECES_OF_THREAD*n_threads()
      round = min(pieces*PIECE_ROWS, table%n_rows)
      if (round == 0) return
      allocate (character(len=table%columns(size(table%columns))%last + 1) :: text(round, 2))
      do i = 1, (table%n_rows - 1)/round + 2
         call write_round(file, table, digits, i, text)
      end do
   end subroutine write_rows

   !> Makes the text of a round and writes that of the one before; there is none before the first, nor in the last.
   subroutine write_round(file, table, digits, i_round, text)
      type(text_file_t), intent(inout) :: file
      type(table_t), intent(in) :: table
      integer, intent(in) :: digits
      integer(ip), intent(in) :: i_round
      character(len=*), contiguous, intent(inout) :: text(:, :)   !< (rows of a round, 2): rounds take turns
      integer(ip) :: round, before, first, n, own, other

      round = size(text, 1, kind=ip)
      before = (i_round - 1)*round
      n = rows_of_round(table, round, i_round)
      own = 1 + mod(i_round, 2_ip)
      other = 3 - own
      !$omp parallel do schedule(dynamic, 1) default(shared) private(first) if (round > PIECE_ROWS)
      do first = 1 - PIECE_ROWS, n, PIECE_ROWS
         if (first < 1) then
            call put_lines(file, text(:rows_of_round(table, round, i_round - 1), other))
         else
            call format_rows(table, digits, before + first - 1, text(first:min(n, first + PIECE_ROWS - 1), own))
         end if
      end do
      !$omp end parallel do
   end subroutine write_round

   pure integer(ip) function rows_of_round(table, round, i_round) result(n)
      type(table_t), intent(in) :: table
      integer(ip), intent(in) :: round             !< rows of a full one
      integer(ip), intent(in) :: i_round           !< 0: before the first

      n = 0
      if (i_round > 0) n = max(0_ip, min(round, table%n_rows - (i_round - 1)*round))
   end function rows_of_round

   !> The text of some rows, each with the character that ends a line.
   subroutine format_rows(table, digits, before, lines)
      type(table_t), intent(in) :: table
      integer, intent(in) :: digits
      integer(ip), intent(in) :: before            !< rows before the first of them
      character(len=*), intent(out) :: lines(:)    !< (rows)
      integer(ip) :: row
      integer :: i

      lines = ''
      do row = 1, size(lines, kind=ip)
         lines(row) (len(lines):) = NEW_LINE_CHARACTER
      end do
      do i = 1, size(table%columns)
         call format_column(table, table%columns(i), digits, before, lines)
      end do
   end subroutine format_rows

   subroutine format_column(table, column, digits, before, lines)
      type(table_t), intent(in) :: table
      type(column_t), intent(in) :: column
      integer, intent(in) :: digits
      integer(ip), intent(in) :: before
      character(len=*), intent(inout) :: lines(:)  !< (rows), PIECE_ROWS of them at most
      real(wp) :: x(PIECE_ROWS)
      integer(ip) :: k(PIECE_ROWS), row, n

      n = size(lines, kind=ip)
      select case (column%kind)
      case (KIND_REAL)
         call fetch_reals(table, column, before, x(:n))
         call put_reals(x(:n), column%zero, digits, column%first, column%last, lines)
      case (KIND_INTEGER)
         call fetch_integers(table, column, before, k(:n))
         call put_integers(k(:n), column%first, column%last, lines)
      case (KIND_WORD)
         do row = 1, n
            call put_word(column%words(before + row)%s, column%on_the_left, lines(row) (column%first:column%last))
         end do
      end select
   end subroutine format_column

   pure subroutine fetch_reals(table, column, before, x)
      type(table_t), intent(in) :: table
      type(column_t), intent(in) :: column
      integer(ip), intent(in) :: before
      real(wp), intent(out) :: x(:)
      integer(ip) :: n

      n = size(x, kind=ip)
      if (.not. associated(column%field)) then
         x = column%reals(before + 1:before + n)
      else if (allocated(table%places)) then
         x = column%field(table%places(before + 1:before + n))
      else
         x = column%field(before + 1:before + n)
      end if
   end subroutine fetch_reals

   pure subroutine fetch_integers(table, column, before, k)
      type(table_t), intent(in) :: table
      type(column_t), intent(in) :: column
      integer(ip), intent(in) :: before
      integer(ip), intent(out) :: k(:)
      integer(ip) :: n

      n = size(k, kind=ip)
      if (associated(column%integer_field)) then
         if (allocated(table%places)) then
            k = column%integer_field(table%places(before + 1:before + n))
         else
            k = column%integer_field(before + 1:before + n)
         end if
         if (associated(column%ids)) k = column%ids(k)
      else if (size(column%integers) == 1) then
         k = column%integers(1)
      else
         k = column%integers(before + 1:before + n)
      end if
   end subroutine fetch_integers

   pure subroutine put_word(word, on_the_left, field)
      character(len=*), intent(in) :: word
      logical, intent(in) :: on_the_left
      character(len=*), intent(out) :: field

      field = word
      if (.not. on_the_left) field = adjustr(field)
   end subroutine put_word

   !> What is rounding in the values of a field becomes 0.
   pure subroutine clear_small(scale, values)
      real(wp), intent(in) :: scale                 !< largest value of the field; 0: nothing is rounding
      real(wp), intent(inout) :: values(:)
      integer(ip) :: i

      do i = 1, size(values, kind=ip)
         if (abs_is_below(values(i), ZERO_SHARE*scale)) values(i) = 0.0_wp
      end do
   end subroutine clear_small

   !> |x| < limit, false for NaN, which must not meet an ordered comparison while invalid operations are trapped.
   pure logical function abs_is_below(x, limit)
      real(wp), intent(in) :: x, limit

      abs_is_below = .false.
      if (.not. is_nan(x)) abs_is_below = abs(x) < limit
   end function abs_is_below

   !> Underscores for blanks, and for #, which numpy takes for the beginning of a comment.
   pure function one_word(text) result(word)
      character(len=*), intent(in) :: text
      character(len=len(text)) :: word
      integer :: i

      word = text
      do i = 1, len(text)
         if (text(i:i) == ' ' .or. text(i:i) == '#') word(i:i) = '_'
      end do
   end function one_word

end module atrito_table
