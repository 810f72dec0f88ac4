!> Key numbers and quantities of a run, from summary and extremes as they stand in the folder.
module atrito_report_numbers
   use atrito_html, only: fact_t, add_fact, add_element, add_note, unbroken
   use atrito_html_table, only: table_top_t, shown_item, dimension_of, begin_rows, end_rows, add_named_row
   use atrito_kinds, only: ip
   use atrito_page, only: page_t, add_line, number
   use atrito_read_table, only: find_column, item_text, ITEM_NAN
   use atrito_strings, only: string_t, to_text
   use atrito_summary, only: quantity_names
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
   character(len=*), parameter :: NUMBERS(5) = [character(len=22) :: 'strain_energy', 'external_work', &
                                                            'error_bound_percent', 'error_estimate_percent', 'equilibrium_residual']
   character(len=*), parameter :: NUMBER_WORDS(size(NUMBERS)) = [character(len=40) :: &
                                                                 'strain energy', 'external work', &
                                                                 'largest error of the energy norm', &
                                                                 'estimated error of the energy norm', &
                                                                 'equilibrium residual over largest force']
   character(len=*), parameter :: NUMBER_UNITS(size(NUMBERS)) = [character(len=6) :: '[F L]', '[F L]', '%', '%', '']
   integer, parameter :: NUMBER_DIGITS(size(NUMBERS)) = [6, 6, 3, 3, 2]

   !> Rows of summary that belong together: a pair in an increment, or, with pair 0, an increment.
   type :: group_t
      character(len=:), allocatable :: step, increment, pair !< as the table has them; '' without the column
      integer(ip) :: first = 0, last = 0                     !< rows of the table
   end type group_t

contains

   !> The extremes of the last increment.
   subroutine add_extremes(top, facts)
      type(table_top_t), intent(in) :: top          !< of extremes, with all rows
      type(fact_t), allocatable, intent(inout) :: facts(:) !< get one a quantity of EXTREMES that is there
      character(len=:), allocatable :: place
      integer(ip) :: column, row, x, y
      integer :: i

      column = find_column(top%table, 'quantity')
      if (column == 0 .or. find_column(top%table, 'value') == 0) return
      x = find_column(top%table, 'x')
      y = find_column(top%table, 'y')
      do i = 1, size(EXTREMES)
         do row = top%table%n_rows, 1, -1
            if (item_text(top%table, column, row) == EXTREMES(i)) exit
         end do
         if (row == 0) cycle
         place = ''
         if (min(x, y) > 0) place = 'at '//shown_item(top, x, row)//', '//shown_item(top, y, row)
         call add_fact(facts, trim(EXTREME_WORDS(i)), value_of(top, trim(EXTREMES(i)), row), place)
      end do
   end subroutine add_extremes

   !> A value with its dimension.
   function value_of(top, quantity, row) result(text)
      type(table_top_t), intent(in) :: top
      character(len=*), intent(in) :: quantity
      integer(ip), intent(in) :: row
      character(len=:), allocatable :: text

      text = shown_item(top, find_column(top%table, 'value'), row)
      if (len(dimension_of(top, quantity)) > 0) text = text//' '//unbroken('['//dimension_of(top, quantity)//']')
   end function value_of

   !> What a run was asked to observe, which is what not every run may have; then energies and checks, at the end.
   subroutine add_summary_numbers(top, facts)
      type(table_top_t), intent(in) :: top          !< of summary, with all rows
      type(fact_t), allocatable, intent(inout) :: facts(:) !< get one a quantity that is there
      type(group_t), allocatable :: groups(:)
      type(string_t), allocatable :: known(:)
      character(len=:), allocatable :: name
      integer(ip) :: row, quantity, value
      integer :: i

      call find_groups(top, .true., groups)
      if (size(groups) == 0) return
      known = quantity_names()
      quantity = find_column(top%table, 'quantity')
      value = find_column(top%table, 'value')
      associate (last => groups(size(groups)))
         do row = last%first, last%last
            name = item_text(top%table, quantity, row)
            if (.not. any([(known(i)%s == name, i=1, size(known))])) call add_fact(facts, name, value_of(top, name, row))
         end do
         do i = 1, size(NUMBERS)
            do row = last%first, last%last
               if (item_text(top%table, quantity, row) /= NUMBERS(i) .or. top%table%kind(value, row) == ITEM_NAN) cycle
               call add_fact(facts, trim(NUMBER_WORDS(i)), number(top%table%value(value, row), NUMBER_DIGITS(i))//' '// &
                             unbroken(trim(NUMBER_UNITS(i))))
            end do
         end do
      end associate
   end subroutine add_summary_numbers

   !> The quantities of pairs, or of steps, a line each; side by side the pairs, and the ends of the steps.
   subroutine add_quantities(page, top, of_steps)
      type(page_t), intent(inout) :: page           !< gets lines of HTML
      type(table_top_t), intent(in) :: top          !< of summary, with all rows
      logical, intent(in) :: of_steps               !< pair 0
      type(group_t), allocatable :: groups(:)
      type(string_t), allocatable :: cells(:)
      character(len=:), allocatable :: name
      integer(ip) :: row, other, quantity, shown, i

      call find_groups(top, of_steps, groups)
      if (size(groups) == 0) return
      quantity = find_column(top%table, 'quantity')
      shown = min(size(groups, kind=ip), MOST_GROUPS)
      call add_line(page, '<div class="whole">')
      call add_element(page, 'h3', trim(merge('Quantities of the step ', 'Quantities of the pairs', of_steps)))
      call begin_rows(page, 'summary', .false.)
      call add_line(page, '<thead><tr><th class="word">quantity</th><th></th>')
      do i = 1, shown
         name = 'step '//groups(i)%step
         if (.not. of_steps) name = 'pair '//groups(i)%pair//', '//name
         call add_element(page, 'th', name)
      end do
      call add_line(page, '</tr></thead><tbody>')
      allocate (cells(shown))
      do row = groups(1)%first, groups(1)%last
         name = item_text(top%table, quantity, row)
         do i = 1, shown
            cells(i)%s = ''
            do other = groups(i)%first, groups(i)%last
               if (item_text(top%table, quantity, other) == name) then
                  cells(i)%s = shown_item(top, find_column(top%table, 'value'), other)
               end if
            end do
         end do
         call add_named_row(page, name, dimension_of(top, name), cells)
      end do
      call end_rows(page)
      if (shown < size(groups)) call add_note(page, 'The first '//to_text(shown)//' of '//to_text(size(groups, kind=ip))// &
                                              '; all are in '//top%table%name//'.')
      call add_line(page, '</div>')
   end subroutine add_quantities

   !> The groups at the end of each step; where they would be too many, those at the end of the last step.
   subroutine find_groups(top, of_steps, groups)
      type(table_top_t), intent(in) :: top
      logical, intent(in) :: of_steps
      type(group_t), allocatable, intent(out) :: groups(:)
      logical, allocatable :: at_end(:)
      integer :: i, k

      call list_groups(top, of_steps, groups)
      if (size(groups) == 0) return
      allocate (at_end(size(groups)), source=.true.)
      do i = 1, size(groups)
         do k = i + 1, size(groups)
            if (groups(k)%step /= groups(i)%step) exit
            at_end(i) = groups(k)%increment == groups(i)%increment
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
