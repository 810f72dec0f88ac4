!> Tables on a page for people: columns as wide as what stands in them; what is too wide for the page goes on below, with the first
!> columns again.
module atrito_grid
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use atrito_kinds, only: ip, wp
   use atrito_page, only: page_t, add_blank, add_line, add_paragraph, left, number, text_width
   use atrito_strings, only: append_string, count_symbol, string_t, to_text
   use atrito_table, only: table_t, KIND_INTEGER, KIND_REAL, KIND_WORD
   use atrito_table_text, only: fetch_integers, fetch_reals
   use atrito_model, only: name_units
   implicit none (type, external)
   private
   public :: grid_t, begin_grid, add_row, put_grid, put_table, CELL, add_matrix

   character(len=1), parameter :: CELL = achar(9)   !< between the cells of a row
   integer, parameter :: INDENT = 3, GAP = 2, DIGITS = 6
   integer(ip), parameter :: MOST_ROWS = 60         !< of a table of results; of longer ones the extremes are told

   type :: grid_t
      integer :: n_left = 0                         !< so many columns are words, on the left
      integer :: n_kept = 1                         !< columns that begin each part of a wide one
      type(string_t), allocatable :: rows(:)        !< the first one is the head
   end type grid_t

   integer(ip), parameter :: COLUMNS = 8             !< of a block: a terminal of 80 columns does not wrap

contains

   !> A grid with its head and no rows. The first n_left columns are words, to the left; the others are numbers, to the right.
   pure subroutine begin_grid(grid, n_left, head)
      type(grid_t), intent(out) :: grid             !< its head alone
      integer, intent(in) :: n_left                 !< >= 0
      character(len=*), intent(in) :: head          !< names of the columns, CELL between them

      grid%n_left = n_left
      grid%n_kept = max(1, n_left)
      allocate (grid%rows(0))
      call append_string(grid%rows, head)
   end subroutine begin_grid

   !> One more row, with as many cells as the head has.
   pure subroutine add_row(grid, cells)
      type(grid_t), intent(inout) :: grid           !< begun; gets one row more
      character(len=*), intent(in) :: cells         !< CELL between them

      call append_string(grid%rows, cells)
   end subroutine add_row

   !> Puts it on a page.
   pure subroutine put_grid(page, grid)
      type(page_t), intent(inout) :: page           !< the lines are added to it, in its units
      type(grid_t), intent(inout) :: grid           !< its units get their names
      integer, allocatable :: ends(:, :), width(:)
      integer :: first, last, i, k, n

      n = 1 + int(count_symbol(grid%rows(1)%s, CELL))
      allocate (ends(0:n, size(grid%rows)), width(n))
      width = 0
      do i = 1, size(grid%rows)
         call name_units(page%units, grid%rows(i)%s)
      end do
      do i = 1, size(grid%rows)
         associate (row => grid%rows(i)%s)
            ends(:, i) = len(row) + 1
            ends(0, i) = 0
            do k = 1, n - 1
               last = index(row(min(ends(k - 1, i), len(row)) + 1:), CELL)
               if (last == 0) exit
               ends(k, i) = ends(k - 1, i) + last
            end do
            do k = 1, n
               first = ends(k - 1, i) + 1
               if (k <= grid%n_left) width(k) = max(width(k), text_width(row(first:ends(k, i) - 1)))
               if (k > grid%n_left) width(k) = max(width(k), ends(k, i) - first)
            end do
         end associate
      end do
      width(:grid%n_left) = min(width(:grid%n_left), (page%width - INDENT)/2)
      associate (kept => grid%n_kept)
         last = kept
         do while (last < n)
            first = last + 1
            last = first
            do while (last < n)
               if (sum(width(:kept) + GAP) + sum(width(first:last + 1) + GAP) - GAP > page%width - INDENT) exit
               last = last + 1
            end do
            if (first > kept + 1) call add_blank(page)
            do i = 1, size(grid%rows)
               call put_row(page, grid, i, ends(:, i), width, [(k, k=1, kept), (k, k=first, last)])
            end do
         end do
      end associate
   end subroutine put_grid

   !> Some columns of a row.
   pure subroutine put_row(page, grid, i, ends, width, columns)
      type(page_t), intent(inout) :: page
      type(grid_t), intent(in) :: grid
      integer, intent(in) :: i                      !< the row
      integer, intent(in) :: ends(0:), width(:)
      integer, intent(in) :: columns(:)
      character(len=:), allocatable :: words
      character(len=sum(width(columns) + GAP)) :: line
      integer :: k, place

      words = repeat(' ', INDENT)
      line = ''
      place = 0
      do k = 1, size(columns)
         associate (cell => grid%rows(i)%s(ends(columns(k) - 1) + 1:ends(columns(k)) - 1), wide => width(columns(k)))
            if (columns(k) <= grid%n_left) then
               words = words//left(cell, wide)//repeat(' ', GAP)
            else
               place = place + wide
               line(place - len(cell) + 1:place) = cell
               place = place + GAP
            end if
         end associate
      end do
      call add_line(page, words//line)
   end subroutine put_row

   !> A table of results but for some of its columns; of many rows the least and the greatest value of each column.
   subroutine put_table(page, table, without)
      type(page_t), intent(inout) :: page           !< the lines are added to it
      type(table_t), intent(in) :: table            !< its columns and rows are read
      character(len=*), intent(in) :: without       !< ' step increment ', names with blanks round them
      type(grid_t) :: grid
      character(len=:), allocatable :: text
      integer :: k, kept                            ! columns before the first of reals; then less than 0
      integer(ip) :: row

      call add_blank(page)
      text = ''
      if (table%n_rows > MOST_ROWS) text = '; '//to_text(table%n_rows)//' rows, in '//table%name//'.tab'
      call add_paragraph(page, table%name//': '//table%title//text, INDENT)
      if (table%n_rows > MOST_ROWS) then
         call put_extremes(page, table)
         return
      end if
      kept = 0
      do row = -1, table%n_rows                     ! names, dimensions, rows
         text = ''
         do k = 1, size(table%columns)
            associate (column => table%columns(k))
               if (index(without, ' '//column%name//' ') > 0) cycle
               if (row == -1) text = text//CELL//column%name
               if (row == 0 .and. column%dimension == '-') text = text//CELL
               if (row == 0 .and. column%dimension /= '-') text = text//CELL//'['//column%dimension//']'
               if (row > 0) text = text//CELL//text_of(table, k, row)
               if (row == -1 .and. kept >= 0) kept = merge(kept + 1, -kept - 1, column%kind /= KIND_REAL)
            end associate
         end do
         if (row == -1) call begin_grid(grid, 0, text(2:))
         if (row > -1) call add_row(grid, text(2:))
      end do
      grid%n_kept = max(1, -kept - 1)
      call put_grid(page, grid)
   end subroutine put_table

   !> A row a column of reals: its least and greatest value, and the row of each by its integers.
   subroutine put_extremes(page, table)
      type(page_t), intent(inout) :: page
      type(table_t), intent(in) :: table
      type(grid_t) :: grid
      real(wp), allocatable :: x(:)
      integer(ip) :: least, greatest, row
      integer :: k

      call begin_grid(grid, 1, CELL//'least'//CELL//'at '//place_of(0_ip)//CELL//'greatest'//CELL//'at '//place_of(0_ip))
      allocate (x(table%n_rows))
      do k = 1, size(table%columns)
         if (table%columns(k)%kind /= KIND_REAL .or. any(table%columns(k)%name == ['x', 'y'])) cycle
         call fetch_reals(table, table%columns(k), 0_ip, x)
         do least = 1, table%n_rows
            if (.not. ieee_is_nan(x(least))) exit
         end do
         if (least > table%n_rows) cycle            ! undefined everywhere
         greatest = least
         do row = least + 1, table%n_rows
            if (x(row) >= x(least) .and. x(row) <= x(greatest)) cycle
            if (x(row) > x(greatest)) greatest = row
            if (x(row) < x(least)) least = row      ! no NaN is either
         end do
         call add_row(grid, table%columns(k)%name//' ['//table%columns(k)%dimension//']'//CELL//text_of(table, k, least)//CELL// &
                      place_of(least)//CELL//text_of(table, k, greatest)//CELL//place_of(greatest))
      end do
      call put_grid(page, grid)

   contains

      !> `7, 3`, of a row; what these are, of row 0: `element, point`
      function place_of(row) result(text)
         integer(ip), intent(in) :: row
         character(len=:), allocatable :: text
         integer :: i

         text = ''
         do i = 1, size(table%columns)
            if (index(' step increment status ', ' '//table%columns(i)%name//' ') > 0) cycle
            if (table%columns(i)%kind /= KIND_INTEGER) cycle
            if (row == 0) text = text//', '//table%columns(i)%name
            if (row > 0) text = text//', '//text_of(table, i, row)
         end do
         text = text(3:)
      end function place_of

   end subroutine put_extremes

   !> An item of a table in words; what is small beside its column is 0.
   function text_of(table, k, row) result(text)
      type(table_t), intent(in) :: table
      integer, intent(in) :: k                      !< the column
      integer(ip), intent(in) :: row
      character(len=:), allocatable :: text
      real(wp) :: x(1)
      integer(ip) :: i(1)

      associate (column => table%columns(k))
         select case (column%kind)
         case (KIND_REAL)
            call fetch_reals(table, column, row - 1, x)
            if (.not. ieee_is_nan(x(1))) then
               if (abs(x(1)) < column%zero) x = 0.0_wp
            end if
            text = number(x(1), DIGITS)
         case (KIND_INTEGER)
            call fetch_integers(table, column, row - 1, i)
            text = to_text(i(1))
         case (KIND_WORD)
            text = column%words(row)%s
         end select
      end associate
   end function text_of

   !> A matrix, its columns in blocks, as four decimals times a power of ten, which the title tells.
   pure subroutine add_matrix(page, title, a, first)
      type(page_t), intent(inout) :: page                !< gets the lines
      character(len=*), intent(in) :: title              !< what it is, with its dimension
      real(wp), intent(in) :: a(:, :)                    !< of any shape, finite
      character(len=*), intent(in), optional :: first(:) !< what stands before each row; left out: its number
      character(len=4 + 9*COLUMNS) :: line
      integer(ip) :: i, j, k, power

      power = 0
      if (maxval(abs(a)) > 0.0_wp) power = floor(log10(maxval(abs(a))), ip)
      call add_line(page, title//', in 1e'//to_text(power))
      do j = 1, size(a, 2, kind=ip), COLUMNS
         associate (last => min(j + COLUMNS - 1, size(a, 2, kind=ip)))
            if (size(a, 2) > COLUMNS) call add_line(page, '  columns '//to_text(j)//' to '//to_text(last))
            do i = 1, size(a, 1, kind=ip)
               line = ''
               if (present(first)) then
                  line(:4) = first(i)
               else
                  write (line(:4), '(i3)') i
               end if
               write (line(5:), '(*(f9.4))') (a(i, k)/10.0_wp**power, k=j, last)
               call add_line(page, line)
            end do
         end associate
      end do
   end subroutine add_matrix

end module atrito_grid
