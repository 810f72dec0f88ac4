!> Key numbers and quantities of a run, from summary and extremes as they stand in the folder.
module atrito_report_numbers
   use atrito_html, only: fact_t, add_fact, add_element, add_note, html_text, unbroken
   use atrito_html_table, only: begin_rows, end_rows
   use atrito_kinds, only: ip
   use atrito_page, only: page_t, add_line, number
   use atrito_read_table, only: find_column, item_text, ITEM_NAN
   use atrito_strings, only: string_t, to_text
   use atrito_summary, only: quantity_names
   use atrito_table_top, only: table_top_t, shown_item, dimension_of
   implicit none (type, external)
   private
   public :: add_extremes, add_summary_numbers, add_quantities

   integer(ip), parameter :: MOST_GROUPS = 8        !< columns that stand side by side

   !> Extremes that come first, and their names for readers.
   character(len=*), parameter :: EXTREMES(6) = [character(len=16) :: 'u', 'mises', 's1_max', 's3_min', 'contact_pressure', &
                                                                                                                    'contact_shear']
   character(len=*), parameter :: EXTREME_WORDS(size(EXTREMES)) = [character(len=26) :: &
                                                                   'largest displacement', 'largest Mises stress', &
                                                                   'largest principal stress', 'least principal stress', &
                                                                   'largest contact pressure', 'largest contact shear']

   !> Quantities of a step that come first.
   character(len=*), parameter :: NUMBERS(4) = [character(len=22) :: 'strain_energy', 'external_work', &
                                                                                   'error_estimate_percent', 'equilibrium_residual']
   character(len=*), parameter :: NUMBER_WORDS(size(NUMBERS)) = [character(len=40) :: &
                                                                 'strain energy', 'external work', &
                                                                 'estimated error of the energy norm', &
                                                                 'equilibrium residual over largest force']
   character(len=*), parameter :: NUMBER_UNITS(size(NUMBERS)) = [character(len=6) :: '[F L]', '[F L]', '%', '']
   integer, parameter :: NUMBER_DIGITS(size(NUMBERS)) = [6, 6, 3, 2]

   !> Rows of summary that belong together: a pair in an increment, or, with pair 0, an increment.
   type :: group_t
      character(len=:), allocatable :: step, increment, pair
      integer(ip) :: first = 0, last = 0
   end type group_t

contains

   !> The extremes of the last increment.
   subroutine add_extremes(top, facts)
      type(table_top_t), intent(in) :: top          !< of extremes, with all rows
      type(fact_t), allocatable, intent(inout) :: facts(:)
      integer(ip) :: row
      integer :: i

      if (find_column(top%table, 'quantity') == 0 .or. find_column(top%table, 'value') == 0) return
      do i = 1, size(EXTREMES)
         row = last_row_of(top, trim(EXTREMES(i)))
         if (row > 0) call add_fact(facts, trim(EXTREME_WORDS(i)), value_of(top, trim(EXTREMES(i)), row), place_of(top, row))
      end do
   end subroutine add_extremes

   pure integer(ip) function last_row_of(top, quantity) result(row)
      type(table_top_t), intent(in) :: top
      character(len=*), intent(in) :: quantity
      integer(ip) :: column

      column = find_column(top%table, 'quantity')
      do row = top%table%n_rows, 1, -1
         if (item_text(top%table, column, row) == quantity) return
      end do
      row = 0
   end function last_row_of

   !> A value with its dimension.
   function value_of(top, quantity, row) result(text)
      type(table_top_t), intent(in) :: top
      character(len=*), intent(in) :: quantity
      integer(ip), intent(in) :: row
      character(len=:), allocatable :: text

      text = shown_item(top, find_column(top%table, 'value'), row)
      if (len(dimension_of(top, quantity)) > 0) text = text//' '//unbroken('['//dimension_of(top, quantity)//']')
   end function value_of

   !> `at 1.5, 0.5`
   function place_of(top, row) result(text)
      type(table_top_t), intent(in) :: top
      integer(ip), intent(in) :: row
      character(len=:), allocatable :: text
      integer(ip) :: x, y

      x = find_column(top%table, 'x')
      y = find_column(top%table, 'y')
      text = ''
      if (min(x, y) > 0) text = 'at '//shown_item(top, x, row)//', '//shown_item(top, y, row)
   end function place_of

   !> What a run was asked to observe, then energies and checks, at the end.
   subroutine add_summary_numbers(top, facts)
      type(table_top_t), intent(in) :: top          !< of summary, with all rows
      type(fact_t), allocatable, intent(inout) :: facts(:)
      type(group_t), allocatable :: groups(:)
      character(len=:), allocatable :: name
      integer(ip) :: row
      integer :: i

      call find_groups(top, .true., groups)
      if (size(groups) == 0) return
      associate (last => groups(size(groups)))
         do row = last%first, last%last
            name = item_text(top%table, find_column(top%table, 'quantity'), row)
            if (.not. is_known(name)) call add_fact(facts, name, value_of(top, name, row))
         end do
         do i = 1, size(NUMBERS)
            do row = last%first, last%last
               if (item_text(top%table, find_column(top%table, 'quantity'), row) /= NUMBERS(i)) cycle
               if (top%table%kind(find_column(top%table, 'value'), row) == ITEM_NAN) cycle
               call add_fact(facts, trim(NUMBER_WORDS(i)), number(top%table%value(find_column(top%table, 'value'), row), &
                                                                  NUMBER_DIGITS(i))//' '//unbroken(trim(NUMBER_UNITS(i))))
            end do
         end do
      end associate
   end subroutine add_summary_numbers

   !> Whether every run may have this quantity.
   pure logical function is_known(name)
      character(len=*), intent(in) :: name
      type(string_t), allocatable :: names(:)
      integer :: i

      names = quantity_names()
      is_known = .true.
      do i = 1, size(names)
         if (names(i)%s == name) return
      end do
      is_known = .false.
   end function is_known

   !> The quantities of pairs, or of steps, a line each; side by side the pairs, and the ends of the steps.
   subroutine add_quantities(page, top, of_steps)
      type(page_t), intent(inout) :: page
      type(table_top_t), intent(in) :: top          !< of summary, with all rows
      logical, intent(in) :: of_steps               !< pair 0
      type(group_t), allocatable :: groups(:)
      integer(ip) :: row
      integer :: shown, i

      call find_groups(top, of_steps, groups)
      if (size(groups) == 0) return
      shown = min(size(groups), int(MOST_GROUPS))
      call begin_rows(page, 'summary', .false.)
      call add_line(page, '<thead><tr><th class="word">quantity</th><th></th>')
      do i = 1, shown
         call add_element(page, 'th', group_name(groups(i), of_steps))
      end do
      call add_line(page, '</tr></thead><tbody>')
      do row = groups(1)%first, groups(1)%last
         call add_quantity(page, top, groups(:shown), item_text(top%table, find_column(top%table, 'quantity'), row))
      end do
      call end_rows(page)
      if (shown < size(groups)) call add_note(page, 'The first '//to_text(int(shown, ip))//' of '// &
                                              to_text(size(groups, kind=ip))//'; all are in '//top%table%name//'.')
   end subroutine add_quantities

   subroutine add_quantity(page, top, groups, name)
      type(page_t), intent(inout) :: page
      type(table_top_t), intent(in) :: top
      type(group_t), intent(in) :: groups(:)
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: line, cell
      integer(ip) :: row
      integer :: i

      line = '<tr><th scope="row">'//html_text(name)//'</th><td class="unit">'
      if (len(dimension_of(top, name)) > 0) line = line//html_text('['//dimension_of(top, name)//']')
      line = line//'</td>'
      do i = 1, size(groups)
         cell = ''
         do row = groups(i)%first, groups(i)%last
            if (item_text(top%table, find_column(top%table, 'quantity'), row) /= name) cycle
            cell = shown_item(top, find_column(top%table, 'value'), row)
         end do
         line = line//'<td>'//html_text(cell)//'</td>'
      end do
      call add_line(page, line//'</tr>')
   end subroutine add_quantity

   pure function group_name(group, of_steps) result(name)
      type(group_t), intent(in) :: group
      logical, intent(in) :: of_steps
      character(len=:), allocatable :: name

      name = 'step '//group%step
      if (.not. of_steps) name = 'pair '//group%pair//', '//name
   end function group_name

   !> The groups at the end of each step; where they would be too many, those at the end of the last step.
   subroutine find_groups(top, of_steps, groups)
      type(table_top_t), intent(in) :: top
      logical, intent(in) :: of_steps
      type(group_t), allocatable, intent(out) :: groups(:)
      logical, allocatable :: at_end(:)
      integer :: i, k

      call list_groups(top, of_steps, groups)
      if (size(groups) == 0) return
      allocate (at_end(size(groups)))
      do i = 1, size(groups)
         at_end(i) = .true.
         do k = i + 1, size(groups)
            if (groups(k)%step /= groups(i)%step) exit
            if (groups(k)%increment /= groups(i)%increment) at_end(i) = .false.
            if (.not. at_end(i)) exit
         end do
      end do
      groups = pack(groups, at_end)
      if (size(groups) <= MOST_GROUPS) return
      groups = pack(groups, [(groups(i)%step == groups(size(groups))%step, i=1, size(groups))])
   end subroutine find_groups

   subroutine list_groups(top, of_steps, groups)
      type(table_top_t), intent(in) :: top
      logical, intent(in) :: of_steps
      type(group_t), allocatable, intent(out) :: groups(:)
      type(group_t) :: group
      integer(ip) :: columns(4), row

      allocate (groups(0))
      columns = [find_column(top%table, 'step'), find_column(top%table, 'increment'), find_column(top%table, 'pair'), &
                 find_column(top%table, 'quantity')]
      if (minval(columns) == 0 .or. find_column(top%table, 'value') == 0) return
      do row = 1, top%table%n_rows
         group%step = item_text(top%table, columns(1), row)
         group%increment = item_text(top%table, columns(2), row)
         group%pair = item_text(top%table, columns(3), row)
         group%first = row
         group%last = row
         if ((group%pair == '0') .neqv. of_steps) cycle
         if (size(groups) > 0) then
            associate (last => groups(size(groups)))
               if (last%step == group%step .and. last%increment == group%increment .and. last%pair == group%pair) then
                  last%last = row
                  cycle
               end if
            end associate
         end if
         groups = [groups, group]
      end do
   end subroutine list_groups

end module atrito_report_numbers
