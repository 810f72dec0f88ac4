!> Tables of a report: the first rows of a table file with what its comments say, as they stand in the file, or turned where they
!> are wider than a page. A table of a large mesh is counted, not taken apart.
module atrito_html_table
   use atrito_files, only: read_file
   use atrito_html, only: html_text, add_element, add_note
   use atrito_kinds, only: ip
   use atrito_page, only: number, page_t, add_line
   use atrito_read_table, only: table_file_t, parse_table, item_text, ITEM_REAL, ITEM_WORD
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, string_list_t, add_string, split_words, take_strings, to_text
   use atrito_table, only: MARK_COLUMNS, MARK_DIMENSIONS, MARK_NOT_CONVERGED
   implicit none (type, external)
   private
   public :: table_top_t, read_top, top_of_text, shown_item, dimension_of, ALL_ROWS, add_table, begin_rows, end_rows, &
             add_cells, add_named_row, MOST_ROWS, MANY_COLUMNS

   integer(ip), parameter :: ALL_ROWS = huge(1_ip)
   integer, parameter :: SHOWN_DIGITS = 6           !< of reals in a report

   !> A table with its first rows.
   type :: table_top_t
      type(table_file_t) :: table                   !< with its first rows alone
      integer(ip) :: n_rows = 0                     !< that the file has
      character(len=:), allocatable :: title        !< what a row is; '' where the file does not say
      type(string_t), allocatable :: dimensions(:)  !< (columns); none where the file does not say
      type(string_t), allocatable :: origin(:)      !< comments before the title: `parameters: nu = 0.3`
      type(string_t), allocatable :: remarks(:)     !< those behind it
   end type table_top_t

   integer(ip), parameter :: MOST_ROWS = 20         !< of a table that is longer
   integer, parameter :: MOST_REMARKS = 6           !< more of them are a text of its own, which stands elsewhere
   integer(ip), parameter :: SIDE_BY_SIDE = 8       !< rows of a table that is turned
   integer(ip), parameter :: MOST_COLUMNS = 14      !< that a page holds
   integer(ip), parameter :: MANY_COLUMNS = 11      !< that paper holds in small letters

contains

   !> Reads the first rows of a table. status: STATUS_FILE when it cannot be read or is no table.
   subroutine read_top(path, most_rows, top, status)
      character(len=*), intent(in) :: path          !< of the file, with its ending
      integer(ip), intent(in) :: most_rows          !< that are kept, >= 0
      type(table_top_t), intent(out) :: top         !< whole but for the further rows
      type(status_t), intent(out) :: status         !< STATUS_OK or STATUS_FILE
      character(len=:), allocatable :: text

      call read_file(path, text, status)
      if (is_ok(status)) call top_of_text(text, path(index(path, '/', back=.true.) + 1:), most_rows, top, status)
   end subroutine read_top

   !> Takes the top of a table's text apart. status: STATUS_FILE.
   subroutine top_of_text(text, name, most_rows, top, status)
      character(len=*), intent(in) :: text, name    !< of the file, and its name without folder
      integer(ip), intent(in) :: most_rows          !< that are kept, >= 0
      type(table_top_t), intent(out) :: top         !< whole but for the further rows
      type(status_t), intent(out) :: status         !< STATUS_OK or STATUS_FILE
      integer :: behind, first, last
      integer(ip) :: shown, all_rows

      ! Lines that are no comments, and where the first of them end.
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
      call parse_table(text(:behind), name, top%table, status)
      if (.not. is_ok(status)) return
      top%n_rows = all_rows - (shown - top%table%n_rows)   ! names in the first row are no row
      call read_comments(text(:behind), top)
   end subroutine top_of_text

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
               call split_words(line(len(MARK_DIMENSIONS) + 1:), ' ', top%dimensions)
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

   !> An item for readers: reals with six digits.
   function shown_item(top, column, row) result(text)
      type(table_top_t), intent(in) :: top          !< of read_top
      integer(ip), intent(in) :: column, row        !< from 1, among the rows that are kept
      character(len=:), allocatable :: text

      text = item_text(top%table, column, row)
      if (top%table%kind(column, row) == ITEM_REAL) text = number(top%table%value(column, row), SHOWN_DIGITS)
   end function shown_item

   !> Dimension of a quantity of a table with a row a quantity, from remarks as `[F L]: strain_energy external_work`; '' where the
   !> file names none.
   pure function dimension_of(top, quantity) result(dimension)
      type(table_top_t), intent(in) :: top          !< its remarks are read
      character(len=*), intent(in) :: quantity      !< in its column quantity
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

   !> A table with its title, and a note where rows are left out.
   subroutine add_table(page, name, top)
      type(page_t), intent(inout) :: page           !< gets lines of HTML
      character(len=*), intent(in) :: name          !< of the table, without ending
      type(table_top_t), intent(in) :: top          !< of read_top
      type(string_t) :: cells(SIDE_BY_SIDE)
      character(len=:), allocatable :: dimension
      integer(ip) :: shown, first, n, row, k
      integer :: i

      call add_line(page, '<div class="whole">')
      call add_element(page, 'h3', name)
      if (len(top%title) > 0) call add_note(page, top%title)
      do i = 1, merge(size(top%remarks), 0, size(top%remarks) <= MOST_REMARKS)
         call add_note(page, top%remarks(i)%s)
      end do
      shown = min(top%table%n_rows, MOST_ROWS)
      if (shown == 0) then
         call add_element(page, 'p', 'The table has no rows.')
      else if (top%table%n_columns > MOST_COLUMNS) then   ! a row of the file becomes a column
         do first = 1, shown, SIDE_BY_SIDE
            n = min(shown - first + 1, SIDE_BY_SIDE)
            call begin_rows(page, name, .false.)
            call add_line(page, '<tbody>')
            do k = 1, top%table%n_columns           ! a line: its name, its dimension, its values
               dimension = ''
               if (size(top%dimensions) == top%table%n_columns) dimension = top%dimensions(k)%s
               do row = 1, n
                  cells(row)%s = shown_item(top, k, first + row - 1)
               end do
               call add_named_row(page, top%table%columns(k)%s, dimension, cells(:n))
            end do
            call end_rows(page)
         end do
      else
         call add_upright(page, name, top, shown)
      end if
      if (shown < top%n_rows) then
         call add_note(page, 'The first '//to_text(shown)//' of '//to_text(top%n_rows)//' rows; all are in '//top%table%name//'.')
      end if
      call add_line(page, '</div>')
   end subroutine add_table

   subroutine add_upright(page, name, top, shown)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: name
      type(table_top_t), intent(in) :: top
      integer(ip), intent(in) :: shown
      type(string_t) :: cells(top%table%n_columns)
      logical :: words(top%table%n_columns)
      integer(ip) :: row, i

      words = top%table%kind(:, 1) == ITEM_WORD
      call begin_rows(page, name, top%table%n_columns > MANY_COLUMNS)
      call add_line(page, '<thead>')
      call add_cells(page, 'th', top%table%columns, words)
      if (size(top%dimensions) == top%table%n_columns) then
         do i = 1, size(cells, kind=ip)
            cells(i)%s = unit_text(top%dimensions(i)%s)
         end do
         call add_cells(page, 'th', cells, words, ' class="unit"')
      end if
      call add_line(page, '</thead><tbody>')
      do row = 1, shown
         do i = 1, size(cells, kind=ip)
            cells(i)%s = shown_item(top, i, row)
         end do
         call add_cells(page, 'td', cells, words)
      end do
      call end_rows(page)
   end subroutine add_upright

   !> `[F/L^2]`, nothing for numbers without a dimension.
   pure function unit_text(dimension) result(text)
      character(len=*), intent(in) :: dimension
      character(len=:), allocatable :: text

      text = ''
      if (dimension /= '-' .and. dimension /= 'mixed' .and. len(dimension) > 0) text = '['//dimension//']'
   end function unit_text

   !> A row of cells behind its name and its dimension.
   pure subroutine add_named_row(page, name, dimension, cells)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: name, dimension
      type(string_t), intent(in) :: cells(:)
      character(len=:), allocatable :: line
      integer :: i

      line = '<tr><th scope="row">'//html_text(name)//'</th><td class="unit">'//html_text(unit_text(dimension))//'</td>'
      do i = 1, size(cells)
         line = line//'<td>'//html_text(cells(i)%s)//'</td>'
      end do
      call add_line(page, line//'</tr>')
   end subroutine add_named_row

   !> Begins a table in a box of its own that scrolls where the screen is narrow.
   pure subroutine begin_rows(page, name, is_wide)
      type(page_t), intent(inout) :: page           !< gets lines of HTML
      character(len=*), intent(in) :: name          !< for those who do not see it
      logical, intent(in) :: is_wide                !< small letters on paper

      call add_line(page, '<div class="scroll" tabindex="0" role="region" aria-label="'//html_text('table '//name)//'">')
      call add_line(page, trim(merge('<table class="wide">', '<table>             ', is_wide)))
   end subroutine begin_rows

   !> Ends the table that begin_rows began.
   pure subroutine end_rows(page)
      type(page_t), intent(inout) :: page           !< whose table was begun

      call add_line(page, '</tbody></table></div>')
   end subroutine end_rows

   !> A row of cells; words stand on the left.
   pure subroutine add_cells(page, tag, cells, words, attributes)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: tag           !< td or th
      type(string_t), intent(in) :: cells(:)
      logical, intent(in) :: words(:)
      character(len=*), intent(in), optional :: attributes   !< of the row, with a blank before them
      character(len=:), allocatable :: line, text
      integer :: i, k

      line = '<tr>'
      if (present(attributes)) line = '<tr'//attributes//'>'
      do i = 1, size(cells)
         line = line//'<'//tag
         if (words(i)) line = line//' class="word"'
         text = html_text(cells(i)%s)
         if (tag == 'th') then                      ! a name may be broken behind its underscores
            do k = len(text), 1, -1
               if (text(k:k) == '_') text = text(:k)//'<wbr>'//text(k + 1:)
            end do
         end if
         line = line//'>'//text//'</'//tag//'>'
      end do
      call add_line(page, line//'</tr>')
   end subroutine add_cells

end module atrito_html_table
