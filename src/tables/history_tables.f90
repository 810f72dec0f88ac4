!> The tables with rows of all increments, docs/user/tables.md: summary, history, iterations.
module atrito_history_tables
   use atrito_kinds, only: ip, wp
   use atrito_number_text, only: trimmed_real
   use atrito_results, only: results_t, history_t, history_row_t, last_frame, observed_list_t
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_summary, only: pair_summary_t, quantity_t, scales_t, summarise_pair, pair_quantities, step_quantities, pair_count
   use atrito_table, only: table_t, begin_table, add_reals, add_integers, add_words, abs_is_below, ZERO_SHARE
   implicit none (type, external)
   private
   public :: build_summary, note_quantities, dimension_remarks, build_history, build_iterations

   !> Of quantities, in the order in which summary.tab has them.
   character(len=8), parameter :: DIMENSIONS(5) = [character(len=8) :: 'L', 'L^2', 'F', 'F/L^2', 'F L']

contains

   !> A row a quantity of a frame: the pairs, then the step as pair 0.
   subroutine build_summary(frame, own, digits, table)
      type(results_t), intent(in) :: frame          !< of one increment
      type(scales_t), intent(in) :: own(:)          !< of each pair
      integer, intent(in) :: digits                 !< significant digits, 6..17
      type(table_t), intent(out) :: table           !< step, pair, quantity, value, increment
      type(quantity_t), allocatable :: list(:)
      integer(ip), allocatable :: pair(:)
      type(string_t), allocatable :: names(:), values(:)
      integer(ip) :: i, n

      call list_quantities(frame, own, list, pair)
      n = size(list, kind=ip)
      allocate (names(n), values(n))
      do i = 1, n
         names(i)%s = trim(list(i)%name)
         if (list(i)%is_count) then
            values(i)%s = to_text(nint(list(i)%value, ip))
         else if (abs_is_below(list(i)%value, ZERO_SHARE*list(i)%scale)) then
            values(i)%s = '0'
         else
            values(i)%s = trimmed_real(list(i)%value, digits)
         end if
      end do
      call begin_table(table, 'summary', 'a row a quantity, by pair; pair 0 is the step', n)
      call add_integers(table, 'step', [frame%step])
      call add_integers(table, 'pair', pair)
      call add_words(table, 'quantity', '-', names, on_the_left=.true.)
      call add_words(table, 'value', 'mixed', values, on_the_left=.false.)
      call add_integers(table, 'increment', [frame%increment])
   end subroutine build_summary

   subroutine list_quantities(frame, own, list, pair)
      type(results_t), intent(in) :: frame
      type(scales_t), intent(in) :: own(:)
      type(quantity_t), allocatable, intent(out) :: list(:)
      integer(ip), allocatable, intent(out) :: pair(:)
      integer(ip) :: i, n, n_each

      n = pair_count(frame)
      n_each = size(pair_quantities(pair_summary_t(), scales_t()), kind=ip)
      associate (of_step => step_quantities(frame))
         allocate (list(n*n_each + size(of_step)))
         allocate (pair(size(list)), source=0_ip)
         do i = 1, n
            list((i - 1)*n_each + 1:i*n_each) = pair_quantities(summarise_pair(frame%contact(i)), own(i))
            pair((i - 1)*n_each + 1:i*n_each) = i
         end do
         list(n*n_each + 1:) = of_step
      end associate
   end subroutine list_quantities

   !> Notes the names of a frame's quantities by their dimensions, each once, in the order in which they come.
   subroutine note_quantities(frame, own, names)
      type(results_t), intent(in) :: frame                   !< of one increment
      type(scales_t), intent(in) :: own(:)                   !< of each pair
      type(string_t), allocatable, intent(inout) :: names(:) !< (dimensions) with blanks before each; not allocated: none so far
      type(quantity_t), allocatable :: list(:)
      integer(ip), allocatable :: pair(:)
      integer :: i, k

      if (.not. allocated(names)) then
         allocate (names(size(DIMENSIONS)))
         do k = 1, size(names)
            names(k)%s = ''
         end do
      end if
      call list_quantities(frame, own, list, pair)
      do i = 1, size(list)
         k = findloc(DIMENSIONS == list(i)%dimension, .true., dim=1)
         if (k == 0) cycle
         if (index(names(k)%s//' ', ' '//trim(list(i)%name)//' ') == 0) names(k)%s = names(k)%s//' '//trim(list(i)%name)
      end do
   end subroutine note_quantities

   !> The dimensions of the column `value`, one comment line a dimension.
   pure function dimension_remarks(names) result(remarks)
      type(string_t), intent(in) :: names(:)        !< by note_quantities
      type(string_t), allocatable :: remarks(:)
      integer :: k

      allocate (remarks(0))
      do k = 1, size(names)
         if (len(names(k)%s) > 0) call append_string(remarks, '['//trim(DIMENSIONS(k))//']:'//names(k)%s)
      end do
   end function dimension_remarks

   !> A row an increment and pair, and what is observed; without a pair a row an increment with what is observed.
   subroutine build_history(history, length, table)
      type(history_t), intent(in) :: history        !< with rows, or with what was observed
      real(wp), intent(in) :: length                !< largest coordinate [L]
      type(table_t), intent(out) :: table           !< step, increment, time, and what is known of each
      integer(ip) :: i, k, place(size(history%rows))

      associate (list => history%observed)
         if (size(history%rows) > 0) then
            call build_rows(history%rows, length, table)
            ! Where the increment of each row is in the list; both go with the time.
            k = 1
            do i = 1, merge(size(history%rows, kind=ip), 0_ip, list%n > 0)
               associate (row => history%rows(i))
                  do while (k < list%n .and. (list%step(k) /= row%step .or. list%increment(k) /= row%increment))
                     k = k + 1
                  end do
               end associate
               place(i) = k
            end do
            if (list%n > 0) call add_observed(history, place, table)
         else
            call begin_table(table, 'history', 'a row an increment', list%n)
            call add_integers(table, 'step', list%step(:list%n))
            call add_integers(table, 'increment', list%increment(:list%n))
            call add_reals(table, 'time', '-', list%time(:list%n), 0.0_wp)
            call add_observed(history, [(i, i=1, list%n)], table)
         end if
      end associate
   end subroutine build_history

   !> A column each of what is observed.
   subroutine add_observed(history, place, table)
      type(history_t), intent(in) :: history        !< with frames: they have the names
      integer(ip), intent(in) :: place(:)           !< (n_rows) in the list
      type(table_t), intent(inout) :: table
      integer :: i

      associate (named => history%frames(last_frame(history))%observed)
         do i = 1, size(named)
            call add_reals(table, trim(named(i)%name), 'mixed', history%observed%values(i, place), 0.0_wp)
         end do
      end associate
   end subroutine add_observed

   !> What is rounding beside the largest of its pair becomes 0.
   subroutine build_rows(rows, length, table)
      type(history_row_t), intent(in) :: rows(:)
      real(wp), intent(in) :: length                !< largest coordinate [L]
      type(table_t), intent(out) :: table
      type(history_row_t) :: clean(size(rows))

      clean = rows
      call clear_rounding(length, clean)
      call begin_table(table, 'history', 'a row an increment and pair', size(rows, kind=ip))
      call add_integers(table, 'step', (rows%step))
      call add_integers(table, 'increment', (rows%increment))
      call add_reals(table, 'time', '-', (rows%time), 0.0_wp)
      call add_integers(table, 'pair', (rows%pair))
      call add_reals(table, 'normal_resultant', 'F', (clean%normal), 0.0_wp)
      call add_reals(table, 'shear_resultant', 'F', (clean%shear), 0.0_wp)
      call add_reals(table, 'moment', 'F*L', (clean%moment), 0.0_wp)
      call add_reals(table, 'contact_length', 'L', (clean%length), 0.0_wp)
      call add_reals(table, 'centre', 'L', (clean%centre), length)
      call add_reals(table, 'max_pressure', 'F/L^2', (clean%max_pressure), 0.0_wp)
      call add_integers(table, 'open', (rows%open))
      call add_integers(table, 'stick', (rows%stick))
      call add_integers(table, 'slip', (rows%slip))
      call add_reals(table, 'dissipation', 'F*L', (clean%dissipation), 0.0_wp)
      call add_reals(table, 'elastic_energy', 'F*L', (clean%elastic_energy), 0.0_wp)
      if (.not. any(rows%unique_up_to_nu > 0.0_wp)) return
      call add_reals(table, 'unique_up_to_nu', '-', (rows%unique_up_to_nu), 0.0_wp)
      call add_integers(table, 'index', (rows%index))
   end subroutine build_rows

   !> By the largest resultant and pressure of each pair in the history, and that resultant times the length for the moment.
   pure subroutine clear_rounding(length, rows)
      real(wp), intent(in) :: length
      type(history_row_t), intent(inout) :: rows(:)
      real(wp) :: force(maxval([rows%pair, 0_ip])), pressure(maxval([rows%pair, 0_ip]))
      integer :: i

      force = 0.0_wp
      pressure = 0.0_wp
      do i = 1, size(rows)
         associate (row => rows(i))
            force(row%pair) = max(force(row%pair), abs(row%normal), abs(row%shear))
            pressure(row%pair) = max(pressure(row%pair), abs(row%max_pressure))
         end associate
      end do
      do i = 1, size(rows)
         associate (row => rows(i))
            if (abs_is_below(row%normal, ZERO_SHARE*force(row%pair))) row%normal = 0.0_wp
            if (abs_is_below(row%shear, ZERO_SHARE*force(row%pair))) row%shear = 0.0_wp
            if (abs_is_below(row%moment, ZERO_SHARE*force(row%pair)*length)) row%moment = 0.0_wp
            if (abs_is_below(row%max_pressure, ZERO_SHARE*pressure(row%pair))) row%max_pressure = 0.0_wp
         end associate
      end do
   end subroutine clear_rounding

   !> A row an inner solve.
   subroutine build_iterations(history, table)
      type(history_t), intent(in) :: history !< with all frames
      type(table_t), intent(out) :: table    !< a row an inner solve

      associate (rows => history%iterations)
         call begin_table(table, 'iterations', 'a row an inner solve', size(rows, kind=ip))
         call add_integers(table, 'step', (rows%step))
         call add_integers(table, 'outer', (rows%outer))
         call add_integers(table, 'inner', (rows%inner))
         call add_reals(table, 'change_displacement', '-', (rows%change_displacement), 0.0_wp)
         call add_reals(table, 'change_pressure', '-', (rows%change_pressure), 0.0_wp)
         call add_reals(table, 'change_friction', '-', (rows%change_friction), 0.0_wp)
         call add_integers(table, 'open', (rows%open))
         call add_integers(table, 'stick', (rows%stick))
         call add_integers(table, 'slip', (rows%slip))
         call add_reals(table, 'residual', '-', (rows%residual), 0.0_wp)
         call add_integers(table, 'increment', (rows%increment))
      end associate
   end subroutine build_iterations

end module atrito_history_tables
