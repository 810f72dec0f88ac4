!> Rows of a table as comma-separated values, RFC 4180: names in the first row, lines that end with CR LF, quotes where a value
!> holds a comma or a quote. No comments: many programs that read such files know none. A word that a spreadsheet would take for a
!> formula has an apostrophe before it.
module atrito_csv_text
   use atrito_files, only: text_file_t, put_line
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_kinds, only: wp
   use atrito_table, only: table_t
   implicit none (type, external)
   private
   public :: put_csv_names, put_csv_rows, is_formula, NO_FORMULA

   character(len=1), parameter :: CARRIAGE_RETURN = achar(13), QUOTE = '"', NO_FORMULA = ''''

contains

   !> Writes the names of the columns.
   subroutine put_csv_names(file, table)
      type(text_file_t), intent(inout) :: file !< open; gets the first row
      type(table_t), intent(in) :: table       !< names of its columns
      character(len=:), allocatable :: line
      integer :: i

      line = ''
      do i = 1, size(table%columns)
         if (i > 1) line = line//','
         if (is_formula(table%columns(i)%name)) line = line//csv_item(NO_FORMULA//table%columns(i)%name)
         if (.not. is_formula(table%columns(i)%name)) line = line//csv_item(table%columns(i)%name)
      end do
      call put_line(file, line//CARRIAGE_RETURN)
   end subroutine put_csv_names

   !> Writes rows that are laid out already, each column at its place of the line.
   subroutine put_csv_rows(file, table, rows)
      type(text_file_t), intent(inout) :: file            !< open; gets the rows
      type(table_t), intent(in) :: table                  !< its columns have their places
      character(len=*), contiguous, intent(in) :: rows(:) !< lines of text, a row each
      character(len=:), allocatable :: line
      integer :: i, row, last, first

      allocate (character(len=2*len(rows) + 3*size(table%columns) + 1) :: line)
      do row = 1, size(rows)
         last = 0
         do i = 1, size(table%columns)
            associate (field => rows(row) (table%columns(i)%first:table%columns(i)%last))
               first = max(1, verify(field, ' '))
               call append_item(field(first:len_trim(field)), line, last)
            end associate
         end do
         line(last:last) = CARRIAGE_RETURN           ! in the place of the last comma
         call put_line(file, line(:last))
      end do
   end subroutine put_csv_rows

   !> Appends an item and a comma to the first `last` characters of a line.
   pure subroutine append_item(item, line, last)
      character(len=*), intent(in) :: item
      character(len=*), intent(inout) :: line
      integer, intent(inout) :: last
      character(len=:), allocatable :: quoted
      integer :: n

      if (is_formula(item)) then
         quoted = csv_item(NO_FORMULA//item)
         n = len(quoted)
         line(last + 1:last + n) = quoted
      else if (scan(item, ','//QUOTE) > 0) then
         quoted = csv_item(item)                    ! no associate: gfortran 12 would free it twice
         n = len(quoted)
         line(last + 1:last + n) = quoted
      else
         n = len(item)
         line(last + 1:last + n) = item
         if (item == 'nan') line(last + 1:last + n) = 'NaN'
      end if
      line(last + n + 1:last + n + 1) = ','
      last = last + n + 1
   end subroutine append_item

   !> A spreadsheet computes what begins so, unless it is a number; some take the wide forms of the signs, too (three bytes).
   pure logical function is_formula(item)
      character(len=*), intent(in) :: item !< as it would stand in the file
      character(len=*), parameter :: SIGNS = '=+-@'//achar(9)//achar(13)
      real(wp) :: value
      integer :: outcome

      is_formula = .false.
      if (len(item) == 0) return
      if (index(SIGNS, item(1:1)) > 0) then
         call read_real(item, value, outcome)
         is_formula = outcome /= NUMBER_OK
      else if (len(item) >= 3) then
         if (item(1:2) == char(239)//char(188)) is_formula = any(ichar(item(3:3)) == [139, 141, 157, 160])
      end if
   end function is_formula

   !> An item, in quotes where it needs them; quotes within are doubled.
   pure function csv_item(text) result(item)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: item
      integer :: i

      item = text
      if (scan(text, ','//QUOTE) == 0) return
      item = QUOTE
      do i = 1, len(text)
         if (text(i:i) == QUOTE) item = item//QUOTE
         item = item//text(i:i)
      end do
      item = item//QUOTE
   end function csv_item

end module atrito_csv_text
