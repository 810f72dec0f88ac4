!> The first rows of a table file, and what its comments say. A table of a large mesh is counted, not taken apart.
module atrito_table_top
   use atrito_files, only: read_file
   use atrito_kinds, only: ip
   use atrito_page, only: number
   use atrito_read_table, only: table_file_t, parse_table, item_text, ITEM_REAL
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, string_list_t, add_string, append_string, take_strings
   use atrito_table, only: MARK_COLUMNS, MARK_DIMENSIONS, MARK_NOT_CONVERGED
   implicit none (type, external)
   private
   public :: table_top_t, read_top, top_of_text, shown_item, dimension_of, is_rounded, ALL_ROWS

   integer(ip), parameter :: ALL_ROWS = huge(1_ip)
   integer, parameter :: SHOWN_DIGITS = 6           !< of reals in a report

   !> A table with its first rows.
   type :: table_top_t
      type(table_file_t) :: table
      integer(ip) :: n_rows = 0                     !< that the file has
      character(len=:), allocatable :: title        !< what a row is; '' where the file does not say
      type(string_t), allocatable :: dimensions(:)  !< (columns); none where the file does not say
      type(string_t), allocatable :: origin(:)      !< comments before the title: `parameters: nu = 0.3`
      type(string_t), allocatable :: remarks(:)     !< those behind it
   end type table_top_t

contains

   !> Reads the first rows of a table. status: STATUS_FILE when it cannot be read or is no table.
   subroutine read_top(path, most_rows, top, status)
      character(len=*), intent(in) :: path
      integer(ip), intent(in) :: most_rows
      type(table_top_t), intent(out) :: top
      type(status_t), intent(out) :: status
      character(len=:), allocatable :: text

      call read_file(path, text, status)
      if (is_ok(status)) call top_of_text(text, path(index(path, '/', back=.true.) + 1:), most_rows, top, status)
   end subroutine read_top

   !> Takes the top of a table's text apart. status: STATUS_FILE.
   subroutine top_of_text(text, name, most_rows, top, status)
      character(len=*), intent(in) :: text, name
      integer(ip), intent(in) :: most_rows
      type(table_top_t), intent(out) :: top
      type(status_t), intent(out) :: status
      integer :: behind
      integer(ip) :: shown, all_rows

      call count_rows(text, most_rows, behind, shown, all_rows)
      call parse_table(text(:behind), name, top%table, status)
      if (.not. is_ok(status)) return
      top%n_rows = all_rows - (shown - top%table%n_rows)   ! names in the first row are no row
      call read_comments(text(:behind), top)
   end subroutine top_of_text

   !> Lines that are no comments, and where the first of them end.
   subroutine count_rows(text, most_rows, behind, shown, all_rows)
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: most_rows
      integer, intent(out) :: behind                !< the last place that belongs to the first rows
      integer(ip), intent(out) :: shown, all_rows
      integer :: first, last

      shown = 0
      all_rows = 0
      behind = len(text)
      first = 1
      do while (first <= len(text))
         last = index(text(first:), achar(10))
         last = merge(len(text), first + last - 1, last == 0)
         if (text(first:first) /= '#' .and. last > first) then
            all_rows = all_rows + 1
            if (all_rows <= most_rows) shown = all_rows
            if (all_rows == most_rows) behind = last
         end if
         first = last + 1
      end do
   end subroutine count_rows

   !> Sorts the comments before the first row.
   subroutine read_comments(text, top)
      character(len=*), intent(in) :: text
      type(table_top_t), intent(inout) :: top
      character(len=*), parameter :: TITLE = '# table: '
      type(string_list_t) :: origin, remarks
      integer :: first, last, comma

      allocate (top%dimensions(0))
      top%title = ''
      first = 1
      do while (first <= len(text))
         if (text(first:first) /= '#') exit
         last = index(text(first:), achar(10))
         last = merge(len(text), first + last - 2, last == 0)
         associate (line => text(first:last))
            if (index(line, TITLE) == 1) then
               comma = index(line, ', ')
               if (comma > 0) top%title = line(comma + 2:)
            else if (index(line, MARK_DIMENSIONS) == 1) then
               call append_words(line(len(MARK_DIMENSIONS) + 1:), top%dimensions)
            else if (index(line, MARK_COLUMNS) == 1 .or. index(line, MARK_NOT_CONVERGED) == 1) then
               continue
            else if (len(top%title) > 0) then
               call add_string(remarks, line(3:))
            else
               call add_string(origin, line(3:))
            end if
         end associate
         first = last + 2
      end do
      call take_strings(origin, top%origin)
      call take_strings(remarks, top%remarks)
   end subroutine read_comments

   !> The words of a line.
   subroutine append_words(line, words)
      character(len=*), intent(in) :: line
      type(string_t), allocatable, intent(inout) :: words(:)
      integer :: first, last

      last = 0
      do
         first = verify(line(last + 1:), ' ')
         if (first == 0) return
         first = last + first
         last = scan(line(first:)//' ', ' ') + first - 2
         call append_string(words, line(first:last))
      end do
   end subroutine append_words

   !> An item for readers: reals with six digits.
   function shown_item(top, column, row) result(text)
      type(table_top_t), intent(in) :: top
      integer(ip), intent(in) :: column, row
      character(len=:), allocatable :: text

      if (top%table%kind(column, row) == ITEM_REAL) then
         text = number(top%table%value(column, row), SHOWN_DIGITS)
      else
         text = item_text(top%table, column, row)
      end if
   end function shown_item

   !> Whether any item that is shown has more digits in the file.
   pure logical function is_rounded(top)
      type(table_top_t), intent(in) :: top

      is_rounded = .false.
      if (top%table%n_rows > 0) is_rounded = any(top%table%kind == ITEM_REAL)
   end function is_rounded

   !> Dimension of a quantity of a table with a row a quantity, from remarks as `[F L]: strain_energy external_work`; '' where none
   !> is told.
   pure function dimension_of(top, quantity) result(dimension)
      type(table_top_t), intent(in) :: top
      character(len=*), intent(in) :: quantity
      character(len=:), allocatable :: dimension
      integer :: i, ends

      dimension = ''
      do i = 1, size(top%remarks)
         associate (line => top%remarks(i)%s)
            ends = index(line, ']: ')
            if (index(line, '[') /= 1 .or. ends == 0) cycle
            if (index(line(ends + 2:)//' ', ' '//quantity//' ') > 0) dimension = line(2:ends - 1)
         end associate
      end do
   end function dimension_of

end module atrito_table_top
