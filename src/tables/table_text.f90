!> How tables become a text file that people, numpy and gnuplot read, or one of comma-separated values.
module atrito_table_text
   use atrito_csv_text, only: put_csv_names, put_csv_rows
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t, append_string
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   use atrito_files, only: file_set_t, text_file_t, begin_files, end_files, open_text, put_line, put_lines, close_text, &
                           NEW_LINE_CHARACTER
   use atrito_status, only: status_t, is_ok
   use atrito_threads, only: n_threads, is_shared
   use atrito_number_text, only: put_reals, put_integers, real_width, integer_width
   use atrito_table, only: table_t, column_t, origin_t, MARK_NOT_CONVERGED, MARK_COLUMNS, MARK_DIMENSIONS, TAB_ENDING, &
                           CSV_ENDING, HEAD_ENDING, KIND_REAL, KIND_INTEGER, KIND_WORD
   use atrito_utf8, only: visible
   implicit none (type, external)
   private
   public :: write_table, write_table_set, growing_table_t, measure_rows, open_table, put_table, close_table, fetch_integers, &
             fetch_reals

   !> Rows that are made into text at a time: that of a wide table stays in the nearer part of the cache.
   integer(ip), parameter :: PIECE_ROWS = 256
   !> Pieces of a round for each thread: where there are many, a thread that is late matters little.
   integer(ip), parameter :: PIECES_OF_THREAD = 64

   !> A table that is written piece by piece: tables of the same columns, the rows of which stand under one head. Each column is as
   !> wide as the pieces that were measured before (measure_rows) need it, or else the first one that is written.
   type :: growing_table_t
      private
      type(table_t) :: head                          !< without rows
      type(text_file_t) :: file                      !< that of the table
      type(text_file_t) :: head_file                 !< of comma-separated values
      logical :: is_csv = .false., has_top = .false. !< comma-separated values; the top has been written
   end type growing_table_t

contains

   !> Writes <name>.tab, or <name>.csv, into a set of files.
   !>
   !> status: STATUS_FILE when it could not be written.
   subroutine write_table(set, table, origin, digits, status, is_csv)
      type(file_set_t), intent(inout) :: set        !< begun; gets the file
      type(table_t), intent(inout) :: table         !< its columns get their places
      type(origin_t), intent(in) :: origin          !< what stands at the top
      integer, intent(in) :: digits                 !< significant digits, 6..17
      type(status_t), intent(out) :: status         !< STATUS_FILE where it could not be written
      logical, intent(in), optional :: is_csv       !< left out: .false.
      type(growing_table_t) :: file

      call open_table(set, table%name, file, is_csv)
      call put_table(file, table, origin, digits)
      call close_table(file, status)
   end subroutine write_table

   !> Gives the columns the room that a piece needs.
   subroutine measure_rows(file, piece, digits)
      type(growing_table_t), intent(inout) :: file  !< columns become wider; it is not open yet
      type(table_t), intent(inout) :: piece         !< its columns get their widths
      integer, intent(in) :: digits                 !< significant digits, 6..17
      integer :: i, k, value_width, j

      ! Gives each column room for its values, its name and its dimension, so that the names stand above the numbers.
      do i = 1, size(piece%columns)
         associate (column => piece%columns(i))
            value_width = 1
            select case (column%kind)
            case (KIND_REAL)
               value_width = real_width(digits)
            case (KIND_INTEGER)
               value_width = width_of_integers(piece, column)
            case (KIND_WORD)
               do k = 1, size(column%words)
                  value_width = max(value_width, len(column%words(k)%s))
               end do
            end select
            column%width = max(len(column%name), len(column%dimension), value_width)
         end associate
      end do
      if (.not. allocated(file%head%columns)) then
         file%head%name = piece%name
         file%head%title = piece%title
         file%head%remarks = piece%remarks
         allocate (file%head%columns(size(piece%columns)))
         do j = 1, size(piece%columns)
            file%head%columns(j)%name = piece%columns(j)%name
            file%head%columns(j)%dimension = piece%columns(j)%dimension
            file%head%columns(j)%on_the_left = piece%columns(j)%on_the_left
         end do
      end if
      do i = 1, size(piece%columns)
         file%head%columns(i)%width = max(file%head%columns(i)%width, piece%columns(i)%width)
      end do
   end subroutine measure_rows

   !> Opens the file of a table. What was measured for it stays.
   subroutine open_table(set, name, file, is_csv)
      type(file_set_t), intent(inout) :: set        !< begun; gets the file
      character(len=*), intent(in) :: name          !< without its ending
      type(growing_table_t), intent(inout) :: file  !< measured or not; is open afterwards
      logical, intent(in), optional :: is_csv       !< left out: .false.

      if (present(is_csv)) file%is_csv = is_csv
      if (file%is_csv) call open_text(set, name//HEAD_ENDING, file%head_file)
      call open_text(set, name//merge(CSV_ENDING, TAB_ENDING, file%is_csv), file%file)
   end subroutine open_table

   !> Writes the rows of a piece. A failure is kept in the file until close_table.
   subroutine put_table(file, piece, origin, digits, remarks)
      type(growing_table_t), intent(inout) :: file       !< open; gets the rows, before the first ones its top
      type(table_t), intent(inout) :: piece              !< its columns get their places
      type(origin_t), intent(in) :: origin               !< what stands at the top
      integer, intent(in) :: digits                      !< significant digits, 6..17
      type(string_t), intent(in), optional :: remarks(:) !< of the whole table; left out: those of its first piece
      integer :: i
      character(len=:), allocatable :: text(:, :)
      integer(ip) :: pieces, round, j

      if (.not. file%has_top) then
         if (.not. allocated(file%head%columns)) call measure_rows(file, piece, digits)
         if (present(remarks)) file%head%remarks = remarks
         call place_columns(file%head)
         if (file%is_csv) then
            call write_top(file%head_file, file%head, origin)
            call put_csv_names(file%file, file%head)
         else
            call write_top(file%file, file%head, origin)
         end if
         file%has_top = .true.
      end if
      do i = 1, size(piece%columns)
         piece%columns(i)%width = file%head%columns(i)%width
      end do
      call place_columns(piece)
      ! Rows are written by rounds: while the text of one is made, in pieces that threads share out, that of the one before is
      ! written. What stands in the file depends neither on the rounds nor on the pieces.
      pieces = 1
      if (n_threads() > 1) pieces = PIECES_OF_THREAD*n_threads()
      round = min(pieces*PIECE_ROWS, piece%n_rows)
      if (round /= 0) then
         allocate (character(len=piece%columns(size(piece%columns))%last + 1) :: text(round, 2))
         do j = 1, (piece%n_rows - 1)/round + 2
            call write_round(file%file, piece, digits, file%is_csv, j, text)
         end do
      end if
   end subroutine put_table

   !> status: STATUS_FILE when it could not be written.
   subroutine close_table(file, status)
      type(growing_table_t), intent(inout) :: file !< open; is closed in any case
      type(status_t), intent(out) :: status        !< STATUS_FILE where it could not be written

      type(status_t) :: of_head

      if (file%is_csv) call close_text(file%head_file, of_head)
      call close_text(file%file, status)
      if (is_ok(status)) status = of_head
   end subroutine close_table

   !> Writes tables into a folder, all or none; those of the other form that stand there go. status: STATUS_FILE.
   subroutine write_table_set(folder, tables, origin, digits, status, is_csv)
      character(len=*), intent(in) :: folder        !< as the user wrote it; is made where it is missing
      type(table_t), intent(inout) :: tables(:)     !< their columns get their places
      type(origin_t), intent(in) :: origin          !< what stands at the top of each
      integer, intent(in) :: digits                 !< significant digits, 6..17
      type(status_t), intent(out) :: status         !< STATUS_FILE, and then nothing was replaced
      logical, intent(in), optional :: is_csv       !< left out: .false.
      type(file_set_t) :: set
      type(string_t), allocatable :: stale(:)
      integer :: i

      allocate (stale(0))
      call begin_files(set, folder, status)
      do i = 1, size(tables)
         if (is_ok(status)) call write_table(set, tables(i), origin, digits, status, is_csv)
         call append_string(stale, tables(i)%name//TAB_ENDING)
         call append_string(stale, tables(i)%name//CSV_ENDING)
         call append_string(stale, tables(i)%name//HEAD_ENDING)
      end do
      call end_files(set, status, stale)
   end subroutine write_table_set

   pure subroutine place_columns(table)
      type(table_t), intent(inout) :: table
      integer :: i, last

      last = len(MARK_DIMENSIONS)
      do i = 1, size(table%columns)
         table%columns(i)%first = last + 2
         table%columns(i)%last = last + 1 + table%columns(i)%width
         last = table%columns(i)%last
      end do
   end subroutine place_columns

   integer function width_of_integers(table, column) result(width)
      type(table_t), intent(in) :: table
      type(column_t), intent(in) :: column
      integer(ip) :: x(PIECE_ROWS), before, n

      width = 1
      if (table%n_rows > 0 .and. allocated(column%integers)) then
         if (size(column%integers) == 1) then
            width = integer_width(column%integers(1))
            return
         end if
      end if
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
      integer :: i

      if (allocated(origin%ending)) then
         call put_line(file, visible(MARK_NOT_CONVERGED//': '//origin%ending))
      else if (origin%not_converged) then
         call put_line(file, visible(MARK_NOT_CONVERGED))
      end if
      call put_line(file, visible('# program: '//PROGRAM_NAME//' '//PROGRAM_VERSION))
      call put_line(file, visible('# deck: '//origin%deck))
      do i = 1, size(origin%heading)
         call put_line(file, visible('# heading: '//origin%heading(i)%s))
      end do
      if (allocated(origin%parameters)) call put_line(file, visible('# parameters: '//origin%parameters))
      if (allocated(origin%options)) call put_line(file, visible('# options: '//origin%options))
      if (allocated(origin%digest)) call put_line(file, visible('# digest: '//origin%digest))
      call put_line(file, visible('# table: '//table%name//', '//table%title))
      do i = 1, size(table%remarks)
         call put_line(file, visible('# '//table%remarks(i)%s))
      end do
      call put_titles(file, table, MARK_COLUMNS)
      call put_titles(file, table, MARK_DIMENSIONS)
   end subroutine write_top

   !> The line of the names, or that of the dimensions.
   subroutine put_titles(file, table, mark)
      type(text_file_t), intent(inout) :: file
      type(table_t), intent(in) :: table
      character(len=*), intent(in) :: mark          !< which of them
      character(len=table%columns(size(table%columns))%last) :: line
      character(len=:), allocatable :: title
      integer :: i

      line = mark
      do i = 1, size(table%columns)
         associate (column => table%columns(i))
            title = column%dimension
            if (mark == MARK_COLUMNS) title = column%name
            call put_word(title, column%on_the_left, line(column%first:column%last))
         end associate
      end do
      call put_line(file, visible(line))
   end subroutine put_titles

   !> Makes the text of a round and writes that of the one before; there is none before the first, nor in the last.
   subroutine write_round(file, table, digits, csv, i_round, text)
      type(text_file_t), intent(inout) :: file
      type(table_t), intent(in) :: table
      integer, intent(in) :: digits
      logical, intent(in) :: csv
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
         if (first < 1 .and. csv) then
            call put_csv_rows(file, table, text(:rows_of_round(table, round, i_round - 1), other))
         else if (first < 1) then
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
      integer(ip), intent(in) :: i_round           !< before the first: 0

      n = 0
      if (i_round > 0) n = max(0_ip, min(round, table%n_rows - (i_round - 1)*round))
   end function rows_of_round

   !> The text of some rows, each with the character that ends a line.
   subroutine format_rows(table, digits, before, lines)
      type(table_t), intent(in) :: table
      integer, intent(in) :: digits
      integer(ip), intent(in) :: before            !< rows before the first of them
      character(len=*), intent(out) :: lines(:)    !< (rows), PIECE_ROWS of them at most
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
      character(len=*), intent(inout) :: lines(:)
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

   !> The values of some rows of a column, before + 1 and the following: its own, or those of the field that it points at.
   pure subroutine fetch_reals(table, column, before, x)
      type(table_t), intent(in) :: table   !< that has the column
      type(column_t), intent(in) :: column !< of reals
      integer(ip), intent(in) :: before    !< rows before the first one wanted
      real(wp), intent(out) :: x(:)        !< (rows wanted)
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

   !> The same of a column of integers; of numbers of nodes or elements those of the deck.
   pure subroutine fetch_integers(table, column, before, k)
      type(table_t), intent(in) :: table   !< that has the column
      type(column_t), intent(in) :: column !< of integers
      integer(ip), intent(in) :: before    !< rows before the first one wanted
      integer(ip), intent(out) :: k(:)     !< (rows wanted)
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

end module atrito_table_text
