!> Tables of a report: as they stand in their files, or turned where they are wider than a page.
module atrito_html_table
   use atrito_html, only: html_text, add_element, add_note
   use atrito_kinds, only: ip
   use atrito_page, only: page_t, add_line
   use atrito_read_table, only: ITEM_WORD
   use atrito_strings, only: string_t, to_text
   use atrito_table_top, only: table_top_t, shown_item, is_rounded
   implicit none (type, external)
   private
   public :: add_table, begin_rows, end_rows, add_cells, add_named_row, MOST_ROWS, MANY_COLUMNS

   integer(ip), parameter :: MOST_ROWS = 20         !< of a table that is longer
   integer, parameter :: MOST_REMARKS = 6           !< more of them are a text of its own, which stands elsewhere
   integer(ip), parameter :: SIDE_BY_SIDE = 8       !< rows of a table that is turned
   integer(ip), parameter :: MOST_COLUMNS = 14      !< that a page holds
   integer(ip), parameter :: MANY_COLUMNS = 11      !< that paper holds in small letters

contains

   !> A table with its title, and a note where rows are left out.
   subroutine add_table(page, name, top)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: name          !< of the table, without ending
      type(table_top_t), intent(in) :: top
      integer(ip) :: shown, first
      integer :: i

      call add_element(page, 'h3', name)
      if (len(top%title) > 0) call add_note(page, top%title)
      do i = 1, merge(size(top%remarks), 0, size(top%remarks) <= MOST_REMARKS)
         call add_note(page, top%remarks(i)%s)
      end do
      if (top%table%n_rows == 0) then
         call add_element(page, 'p', 'The table has no rows.')
         return
      end if
      shown = min(top%table%n_rows, MOST_ROWS)
      ! A row of the file becomes a column.
      if (top%table%n_columns > MOST_COLUMNS) then
         do first = 1, shown, SIDE_BY_SIDE
            call add_turned(page, name, top, first, min(shown, first + SIDE_BY_SIDE - 1))
         end do
      else
         call add_upright(page, name, top, shown)
      end if
      if (shown < top%n_rows) then
         call add_note(page, 'The first '//to_text(shown)//' of '//to_text(top%n_rows)//' rows; all are in '//top%table%name//'.')
      else if (is_rounded(top)) then
         call add_note(page, 'Numbers are rounded here; all digits are in '//top%table%name//'.')
      end if
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

   !> A line a column of the file: its name, its dimension, its values.
   subroutine add_turned(page, name, top, first, last)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: name
      type(table_top_t), intent(in) :: top
      integer(ip), intent(in) :: first, last        !< rows of the file
      type(string_t) :: cells(first:last)
      character(len=:), allocatable :: dimension
      integer(ip) :: row, i

      call begin_rows(page, name, .false.)
      call add_line(page, '<tbody>')
      do i = 1, top%table%n_columns
         dimension = ''
         if (size(top%dimensions) == top%table%n_columns) dimension = top%dimensions(i)%s
         do row = first, last
            cells(row)%s = shown_item(top, i, row)
         end do
         call add_named_row(page, top%table%columns(i)%s, dimension, cells)
      end do
      call end_rows(page)
   end subroutine add_turned

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
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: name          !< for those who do not see it
      logical, intent(in) :: is_wide                !< small letters on paper

      call add_line(page, '<div class="scroll" tabindex="0" role="region" aria-label="'//html_text('table '//name)//'">')
      call add_line(page, trim(merge('<table class="wide">', '<table>             ', is_wide)))
   end subroutine begin_rows

   !> Ends the table that begin_rows began.
   pure subroutine end_rows(page)
      type(page_t), intent(inout) :: page

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
