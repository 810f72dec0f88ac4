!> `atrito compare`: are two tables, or two folders of them, the same?
!>
!> A number differs if |a-b| > rtol S + atol, S the largest |value| of its column over all increments; of its quantity and pair in
!> summary.tab; of its contact pair and step for pressure, shear and slip; of its pair in history.tab; of a family of columns in
!> bodies.tab, joints.tab, sections.tab and history.tab. A column may have rules of its own (atrito_compare_rules). Integers and
!> words must be equal; nan equals nan. timing, iterations and adapt are left out; the equilibrium residual must be small in both.
module atrito_compare
   use atrito_column_scales, only: kind_of, columns_of_scale, row_scales, summary_scales, moment_scale, is_of_pair, is_number
   use atrito_compare_rules, only: rule_t, rules_t, rule_of, takes_table, ANY_NAME, COMPARED_TABLES
   use atrito_files, only: file_exists, is_folder
   use atrito_kinds, only: ip, wp
   use atrito_page, only: page_t, begin_page, add_line, plural
   use atrito_read_table, only: table_file_t, read_table, table_path, find_column, item_text, ITEM_WORD, ITEM_INTEGER, ITEM_NAN
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE, STATUS_OK, STATUS_USAGE
   use atrito_strings, only: string_t, append_string, to_text, join
   implicit none (type, external)
   private
   public :: comparison_t, begin_comparison, compare_paths, compare_tables, DEFAULT_RTOL, DEFAULT_ATOL

   real(wp), parameter :: DEFAULT_RTOL = 1.0e-6_wp, DEFAULT_ATOL = 0.0_wp
   real(wp), parameter :: LARGEST_RESIDUAL = 1.0e-8_wp  !< of the equilibrium; its digits are rounding
   integer, parameter :: MOST_LINES = 20, MOST_KEPT = 1000 !< differences printed, kept; the rest is counted
   !> Tables of times and iterations: their numbers depend on the machine and on the method, not on the solution.
   character(len=*), parameter :: LEFT_OUT(3) = [character(len=10) :: 'adapt', 'timing', 'iterations']

   !> A comparison while it goes on.
   type :: comparison_t
      type(rules_t) :: rules                        !< tolerances, and what is left out
      integer(ip) :: n_tables = 0, n_values = 0, n_differences = 0 !< so far; of the tables that were compared
      type(string_t), allocatable :: left_out(:)    !< names of tables
      type(string_t), allocatable :: differences(:) !< all that are kept, in words
      type(page_t) :: page                          !< what is to be printed
   end type comparison_t

   integer, parameter :: DECK = 1, PARAMETERS = 2, OPTIONS = 3, DIGEST = 4   !< places in HEAD_NAMES

contains

   !> Begins a comparison without findings.
   subroutine begin_comparison(comparison, rtol, atol)
      type(comparison_t), intent(out) :: comparison !< without findings, with rtol and atol
      real(wp), intent(in) :: rtol                  !< 0..1
      real(wp), intent(in) :: atol                  !< >= 0, in the dimension of each column

      comparison%rules%rtol = rtol
      comparison%rules%atol = atol
      allocate (comparison%left_out(0), comparison%differences(0), comparison%rules%list(0))
      call begin_page(comparison%page, 100)
   end subroutine begin_comparison

   !> Compares two files or two folders; comparison%page says what differs.
   !>
   !> status: STATUS_USAGE when they differ, or when one is a file and one a folder; STATUS_FILE when a file cannot be read.
   subroutine compare_paths(a, b, comparison, status)
      character(len=*), intent(in) :: a, b            !< two files or two folders, as the user wrote them
      type(comparison_t), intent(inout) :: comparison !< begun; counts and differences are added
      type(status_t), intent(out) :: status           !< STATUS_OK, STATUS_USAGE or STATUS_FILE
      logical :: folder(2), there(2)

      folder(1) = is_folder(a)
      folder(2) = is_folder(b)
      there = are_there(a, b)
      if (.not. any(there)) then
         call set_status(status, STATUS_FILE, a//' and '//b//': neither is there')
      else if (.not. all(there)) then
         call report_missing(comparison, a, b, there)
      else if (folder(1) .neqv. folder(2)) then
         call set_status(status, STATUS_USAGE, a//' and '//b//': one is a folder, the other a file')
      else if (folder(1)) then
         call compare_folders(a, b, comparison, status)
      else
         call compare_there(a, b, comparison, status)
      end if
      if (is_ok(status)) call conclude(comparison, status)
   end subroutine compare_paths

   !> Which of two files or folders are there.
   function are_there(a, b) result(there)
      character(len=*), intent(in) :: a, b
      logical :: there(2)

      there(1) = file_exists(a) .or. is_folder(a)
      there(2) = file_exists(b) .or. is_folder(b)
   end function are_there

   subroutine report_missing(comparison, a, b, there)
      type(comparison_t), intent(inout) :: comparison
      character(len=*), intent(in) :: a, b
      logical, intent(in) :: there(2)

      if (.not. there(1)) call report(comparison, a//': missing')
      if (.not. there(2)) call report(comparison, b//': missing')
   end subroutine report_missing

   subroutine compare_folders(a, b, comparison, status)
      character(len=*), intent(in) :: a, b
      type(comparison_t), intent(inout) :: comparison
      type(status_t), intent(inout) :: status
      character(len=:), allocatable :: file_a, file_b
      logical :: there(2)
      integer :: i

      do i = 1, size(COMPARED_TABLES)
         file_a = table_path(a, trim(COMPARED_TABLES(i)))
         file_b = table_path(b, trim(COMPARED_TABLES(i)))
         there = are_there(file_a, file_b)
         if (.not. any(there)) cycle
         if (any(LEFT_OUT == COMPARED_TABLES(i)) .or. .not. takes_table(comparison%rules, trim(COMPARED_TABLES(i)))) then
            call append_string(comparison%left_out, trim(COMPARED_TABLES(i)))
         else if (.not. all(there)) then
            call report_missing(comparison, file_a, file_b, there)
         else
            call compare_there(file_a, file_b, comparison, status)
            if (.not. is_ok(status)) return
         end if
      end do
      if (comparison%n_tables == 0 .and. comparison%n_differences == 0) then
         call set_status(status, STATUS_FILE, a//' and '//b//': there are no tables to compare')
      end if
   end subroutine compare_folders

   subroutine compare_there(a, b, comparison, status)
      character(len=*), intent(in) :: a, b
      type(comparison_t), intent(inout) :: comparison
      type(status_t), intent(inout) :: status
      type(table_file_t) :: table_a, table_b

      call read_table(a, table_a, status)
      if (is_ok(status)) call read_table(b, table_b, status)
      if (.not. is_ok(status)) return
      call tell_heads(table_a, table_b, comparison%page)
      if (any(LEFT_OUT == kind_of(table_a)) .and. kind_of(table_a) == kind_of(table_b)) then
         call append_string(comparison%left_out, kind_of(table_a))
      else
         call compare_tables(table_a, table_b, comparison)
      end if
   end subroutine compare_there

   !> Compares two tables item by item.
   subroutine compare_tables(a, b, comparison)
      type(table_file_t), intent(in) :: a, b          !< of one name, or that the user gives
      type(comparison_t), intent(inout) :: comparison !< begun; counts and differences are added
      integer(ip), allocatable :: column_in_b(:)
      integer(ip) :: before, column, i, k, quantity

      comparison%n_tables = comparison%n_tables + 1
      before = comparison%n_differences
      if ((a%not_converged .neqv. b%not_converged) .and. a%has_head .and. b%has_head) then
         call report(comparison, a%name//': NOT CONVERGED in the '//trim(merge('first ', 'second', a%not_converged))//' only')
      end if
      call match_columns(a, b, comparison, column_in_b)
      ! A rule for a column that the table has not would be of no use, unseen.
      quantity = merge(find_column(a, 'quantity'), 0_ip, has_quantities(a))
      do i = 1, size(comparison%rules%list, kind=ip)
         associate (rule => comparison%rules%list(i))
            if (rule%table /= stem(a) .or. rule%column == ANY_NAME) cycle
            if (quantity == 0 .and. find_column(a, rule%column) > 0) cycle
            if (quantity > 0) then
               if (any([(item_text(a, quantity, k) == rule%column, k=1, a%n_rows)])) cycle
            end if
            call report(comparison, a%name//': there is no '//rule%column//', of which --tolerances or --ignore tells')
         end associate
      end do
      if (kind_of(a) == kind_of(b) .and. has_quantities(a)) then
         call compare_summaries(a, b, comparison)
         return
      end if
      if (a%n_rows /= b%n_rows) then
         call report(comparison, a%name//': '//plural(a%n_rows, 'row', 'rows')//' / '//plural(b%n_rows, 'row', 'rows'))
         return
      end if
      do column = 1, a%n_columns
         if (column_in_b(column) > 0) call compare_columns(a, b, column, column_in_b(column), comparison)
      end do
   end subroutine compare_tables

   !> The name of a table: that of its file without the ending.
   pure function stem(table) result(name)
      type(table_file_t), intent(in) :: table
      character(len=:), allocatable :: name

      name = table%name(:index(table%name//'.', '.') - 1)
   end function stem

   !> Place in b of each column of a; 0 and a difference where there is none. The order counts too: scripts use it.
   subroutine match_columns(a, b, comparison, column_in_b)
      type(table_file_t), intent(in) :: a, b
      type(comparison_t), intent(inout) :: comparison
      integer(ip), allocatable, intent(out) :: column_in_b(:)
      integer(ip) :: i
      logical :: all_there

      all_there = a%n_columns == b%n_columns
      allocate (column_in_b(a%n_columns))
      do i = 1, a%n_columns
         column_in_b(i) = find_column(b, a%columns(i)%s)
         if (column_in_b(i) == 0) call report(comparison, a%name//': column '//a%columns(i)%s//' is missing in the second')
         all_there = all_there .and. column_in_b(i) > 0
      end do
      do i = 1, b%n_columns
         if (find_column(a, b%columns(i)%s) > 0) cycle
         call report(comparison, a%name//': column '//b%columns(i)%s//' is missing in the first')
         all_there = .false.
      end do
      if (.not. all_there) return
      if (any(column_in_b /= [(i, i=1, a%n_columns)])) then
         call report(comparison, a%name//': the columns stand in another order: '//join(a%columns, ' ')//' / '// &
                     join(b%columns, ' '))
      end if
   end subroutine match_columns

   subroutine compare_columns(a, b, i, j, comparison)
      type(table_file_t), intent(in) :: a, b
      integer(ip), intent(in) :: i, j               !< the column in a and in b
      type(comparison_t), intent(inout) :: comparison
      integer(ip), allocatable :: of_a(:), of_b(:)
      real(wp) :: scale(a%n_rows)
      logical :: exact, by_pair
      integer(ip) :: row

      of_a = columns_of_scale(a, i)
      of_b = columns_of_scale(b, j)
      exact = is_integer_column(a, i, 1_ip, a%n_rows) .or. is_integer_column(b, j, 1_ip, b%n_rows)
      by_pair = is_of_pair(a, i) .and. is_of_pair(b, j)
      scale = max(row_scales(a, of_a, by_pair), row_scales(b, of_b, by_pair), moment_scale(a, i), moment_scale(b, j))
      do row = 1, a%n_rows
         call compare_items(a, b, [i, row], [j, row], scale(row), exact, comparison)
      end do
   end subroutine compare_columns

   !> All items are integers and not all are 0, which a column of reals may hold as well.
   pure logical function is_integer_column(table, column, first, last)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: column, first, last  !< rows

      is_integer_column = all(table%kind(column, first:last) == ITEM_INTEGER)
      if (is_integer_column) is_integer_column = any(abs(table%value(column, first:last)) > 0.0_wp)
   end function is_integer_column

   !> Compares two items; at = [column, row].
   subroutine compare_items(a, b, at_a, at_b, scale, exact, comparison)
      type(table_file_t), intent(in) :: a, b
      integer(ip), intent(in) :: at_a(2), at_b(2)
      real(wp), intent(in) :: scale
      logical, intent(in) :: exact
      type(comparison_t), intent(inout) :: comparison
      integer :: kind_a, kind_b
      integer(ip) :: quantity
      real(wp) :: half_difference, half_allowed
      character(len=:), allocatable :: text, name
      type(rule_t) :: rule

      name = a%columns(at_a(1))%s
      quantity = find_column(a, 'quantity')
      if (quantity > 0) then                        ! before the kind of the table is asked, for each value
         if (has_quantities(a)) name = item_text(a, quantity, at_a(2))
      end if
      rule = rule_of(comparison%rules, stem(a), name)
      if (rule%is_left_out) return
      comparison%n_values = comparison%n_values + 1
      kind_a = a%kind(at_a(1), at_a(2))
      kind_b = b%kind(at_b(1), at_b(2))
      if (kind_a == ITEM_NAN .and. kind_b == ITEM_NAN) return
      text = ''                                     ! what is told of a difference
      if (is_number(kind_a) .and. is_number(kind_b)) then
         ! halves, since the difference of two huge numbers overflows
         half_difference = abs(0.5_wp*a%value(at_a(1), at_a(2)) - 0.5_wp*b%value(at_b(1), at_b(2)))
         half_allowed = 0.0_wp
         if (.not. exact) half_allowed = rule%rtol*(0.5_wp*scale) + 0.5_wp*rule%atol
         if (half_difference <= half_allowed) return
         if (half_difference < 0.25_wp*huge(half_difference)) text = ', differ by '//to_text(2.0_wp*half_difference, 3)
         if (exact) then
            text = text//', must be equal'
         else
            text = text//', allowed '//to_text(2.0_wp*min(half_allowed, 0.25_wp*huge(half_allowed)), 3)
         end if
      else if (kind_a == ITEM_WORD .and. kind_b == ITEM_WORD) then
         if (item_text(a, at_a(1), at_a(2)) == item_text(b, at_b(1), at_b(2))) return
      end if
      call report(comparison, a%name//', '//row_name(a, at_a(2))//', '//name//': '//item_text(a, at_a(1), at_a(2))//' / '// &
                  item_text(b, at_b(1), at_b(2))//text)
   end subroutine compare_items

   !> `row 3, pair 1, point 3, s = 1e-1`
   pure function row_name(table, row) result(text)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: row
      character(len=:), allocatable :: text
      character(len=7), parameter :: KEYS(7) = ['pair   ', 'body   ', 'body_1 ', 'body_2 ', 'node   ', 'element', 'point  ']
      integer(ip) :: column
      integer :: i

      text = 'row '//to_text(row)
      do i = 1, size(KEYS)
         column = find_column(table, trim(KEYS(i)))
         if (column > 0) text = text//', '//trim(KEYS(i))//' '//item_text(table, column, row)
      end do
      column = find_column(table, 's')
      if (column > 0) text = text//', s = '//item_text(table, column, row)
   end function row_name

   !> A summary, or extremes: their rows have names. Where an extreme is does not count, since another place may be as good.
   pure logical function has_quantities(table) result(has)
      type(table_file_t), intent(in) :: table

      has = kind_of(table) == 'summary' .or. kind_of(table) == 'extremes'
   end function has_quantities

   !> Rows are matched by their quantity, pair, increment and step, as far as both have these columns.
   subroutine compare_summaries(a, b, comparison)
      type(table_file_t), intent(in) :: a, b
      type(comparison_t), intent(inout) :: comparison
      character(len=9), parameter :: NAMES(3) = ['step     ', 'increment', 'pair     ']
      type(string_t), allocatable :: keys(:)
      real(wp) :: scale_a(a%n_rows), scale_b(b%n_rows)
      integer(ip) :: row, other, i

      allocate (keys(0))
      do i = 1, size(NAMES, kind=ip)
         if (min(find_column(a, trim(NAMES(i))), find_column(b, trim(NAMES(i)))) > 0) call append_string(keys, trim(NAMES(i)))
      end do
      scale_a = summary_scales(a)
      scale_b = summary_scales(b)
      do row = 1, a%n_rows
         other = find_row(b, keys, row_key(a, keys, row), row)
         if (other == 0) then
            call report(comparison, a%name//': '//row_key(a, keys, row)//' is missing in the second')
         else
            call compare_quantity(a, b, row, other, max(scale_a(row), scale_b(other)), comparison)
         end if
      end do
      do row = 1, b%n_rows
         if (find_row(a, keys, row_key(b, keys, row), row) == 0) then
            call report(comparison, a%name//': '//row_key(b, keys, row)//' is missing in the first')
         end if
      end do
   end subroutine compare_summaries

   subroutine compare_quantity(a, b, row_a, row_b, scale, comparison)
      type(table_file_t), intent(in) :: a, b
      integer(ip), intent(in) :: row_a, row_b
      real(wp), intent(in) :: scale
      type(comparison_t), intent(inout) :: comparison
      type(rule_t) :: rule
      integer(ip) :: i, j
      logical :: exact

      i = find_column(a, 'value')
      j = find_column(b, 'value')
      if (item_text(a, find_column(a, 'quantity'), row_a) == 'equilibrium_residual') then
         rule = rule_of(comparison%rules, stem(a), 'equilibrium_residual')
         if (rule%is_left_out) return
         comparison%n_values = comparison%n_values + 1
         if (is_small(a, i, row_a) .and. is_small(b, j, row_b)) return
         call report(comparison, a%name//', equilibrium_residual: '//item_text(a, i, row_a)//' / '//item_text(b, j, row_b)// &
                     ', must be below '//to_text(LARGEST_RESIDUAL)//' in both')
      else
         exact = is_integer_column(a, i, row_a, row_a) .or. is_integer_column(b, j, row_b, row_b)
         call compare_items(a, b, [i, row_a], [j, row_b], scale, exact, comparison)
      end if
   end subroutine compare_quantity

   pure logical function is_small(table, column, row)
      type(table_file_t), intent(in) :: table
      integer(ip), intent(in) :: column, row

      is_small = is_number(table%kind(column, row))
      if (is_small) is_small = abs(table%value(column, row)) < LARGEST_RESIDUAL
   end function is_small

   !> `step 1, increment 1, pair 0, strain_energy`: what a row of a summary is known by.
   pure function row_key(table, keys, row) result(key)
      type(table_file_t), intent(in) :: table
      type(string_t), intent(in) :: keys(:)
      integer(ip), intent(in) :: row
      character(len=:), allocatable :: key
      integer :: i

      key = ''
      do i = 1, size(keys)
         key = key//keys(i)%s//' '//item_text(table, find_column(table, keys(i)%s), row)//', '
      end do
      key = key//item_text(table, find_column(table, 'quantity'), row)
   end function row_key

   !> Row of a key, looked for first where it is expected; 0 when there is none.
   pure integer(ip) function find_row(table, keys, key, expected) result(row)
      type(table_file_t), intent(in) :: table
      type(string_t), intent(in) :: keys(:)
      character(len=*), intent(in) :: key
      integer(ip), intent(in) :: expected

      row = expected
      if (row <= table%n_rows) then
         if (row_key(table, keys, row) == key) return
      end if
      do row = 1, table%n_rows
         if (row_key(table, keys, row) == key) return
      end do
      row = 0
   end function find_row

   !> Counts a difference and prints the first ones.
   subroutine report(comparison, text)
      type(comparison_t), intent(inout) :: comparison
      character(len=*), intent(in) :: text

      comparison%n_differences = comparison%n_differences + 1
      if (comparison%n_differences <= MOST_LINES) call add_line(comparison%page, text)
      if (comparison%n_differences <= MOST_KEPT) call append_string(comparison%differences, text)
   end subroutine report

   !> The last lines and the outcome.
   subroutine conclude(comparison, status)
      type(comparison_t), intent(inout) :: comparison
      type(status_t), intent(inout) :: status
      character(len=:), allocatable :: text

      text = plural(comparison%n_tables, 'table', 'tables')//', '//plural(comparison%n_values, 'value', 'values')
      if (size(comparison%left_out) > 0) text = text//', left out: '//join(comparison%left_out, ' ')
      if (comparison%n_differences > MOST_LINES) then
         call add_line(comparison%page, '... and '//to_text(comparison%n_differences - MOST_LINES)//' more')
      end if
      if (comparison%n_differences == 0) then
         call add_line(comparison%page, 'same: '//text)
         status%code = STATUS_OK
      else
         call add_line(comparison%page, 'different: '//plural(comparison%n_differences, 'difference', 'differences')//' in '//text)
         call set_status(status, STATUS_USAGE, 'the tables differ')
      end if
   end subroutine conclude

   !> Adds a line for each thing that two heads say otherwise: other parameters, another deck, other options. It counts as no
   !> difference, but a reader wants to know it first. What the page has already is not told again.
   subroutine tell_heads(a, b, page)
      type(table_file_t), intent(in) :: a, b     !< of one name
      type(page_t), intent(inout) :: page        !< gets lines that it has not

      if (.not. (a%has_head .and. b%has_head)) return
      associate (one => a%head, two => b%head, other_deck => a%head(DECK)%s /= b%head(DECK)%s, &
                 other_values => a%head(PARAMETERS)%s /= b%head(PARAMETERS)%s)
         if (other_deck) call tell('another deck: '//both(one(DECK)%s, two(DECK)%s))
         if (other_values) call tell('other parameters: '//both(others(one(PARAMETERS)%s, two(PARAMETERS)%s), &
                                                                others(two(PARAMETERS)%s, one(PARAMETERS)%s)))
         if (one(OPTIONS)%s /= two(OPTIONS)%s) call tell('other options: '//both(one(OPTIONS)%s, two(OPTIONS)%s))
         if (one(DIGEST)%s /= two(DIGEST)%s .and. min(len(one(DIGEST)%s), len(two(DIGEST)%s)) > 0 .and. &
             .not. (other_deck .or. other_values)) call tell('a deck of the same name with other lines (digest)')
      end associate

   contains

      subroutine tell(text)
         character(len=*), intent(in) :: text
         integer :: i

         do i = 1, page%n
            if (page%lines(i)%s == text) return
         end do
         call add_line(page, text)
      end subroutine tell

   end subroutine tell_heads

   !> The items `name = value` of one list that do not stand in the other.
   pure function others(list, other) result(text)
      character(len=*), intent(in) :: list, other
      character(len=:), allocatable :: text
      integer :: first, last

      text = ''
      first = 1
      do while (first <= len(list))
         last = first + index(list(first:)//', ', ', ') - 2
         if (index(', '//other//', ', ', '//list(first:last)//', ') == 0) then
            if (len(text) > 0) text = text//', '
            text = text//list(first:last)
         end if
         first = last + 3
      end do
   end function others

   pure function both(one, two) result(text)
      character(len=*), intent(in) :: one, two
      character(len=:), allocatable :: text

      text = one//' / '//two
      if (len(one) == 0) text = 'none / '//two
      if (len(two) == 0) text = one//' / none'
   end function both

end module atrito_compare
