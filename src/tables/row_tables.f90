!> Ties, equations and springs: their tables, and what the listing and the screen say of them.
module atrito_row_tables
   use atrito_bilateral_rows, only: bilateral_rows_t, ROW_TIE, ROW_EQUATION, ROW_SPRING
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_page, only: page_t, add_blank, add_entry, add_line, number, plural
   use atrito_results, only: results_t
   use atrito_strings, only: to_text
   use atrito_summary, only: scales_t
   use atrito_table, only: table_t, begin_step_table, add_integers, add_reals, add_real_columns, clear_small, ZERO_SHARE
   implicit none (type, external)
   private
   public :: has_rows, build_ties, build_equations, build_springs, describe_rows, joined_text

   character(len=9), parameter :: ROW_TABLES(3) = ['ties     ', 'equations', 'springs  ']
   integer(ip), parameter :: KIND_OF_TABLE(3) = [ROW_TIE, ROW_EQUATION, ROW_SPRING]
   integer, parameter :: DIGITS = 6                 !< of numbers for people

contains

   !> Whether there are rows for a table.
   pure logical function has_rows(model, results, name)
      type(model_t), intent(in) :: model            !< its bilateral rows are read
      type(results_t), intent(in) :: results        !< of one increment
      character(len=*), intent(in) :: name          !< of ROW_TABLES

      has_rows = size(rows_of(model, KIND_OF_TABLE(findloc(ROW_TABLES == name, .true., dim=1)))) > 0 .and. &
                 allocated(results%row_force)
   end function has_rows

   !> Places of the rows of a kind.
   pure function rows_of(model, kind) result(list)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: kind
      integer(ip), allocatable :: list(:)
      integer(ip) :: j

      allocate (list(0))
      if (model%bilateral%n > 0) list = pack([(j, j=1, model%bilateral%n)], model%bilateral%kind == kind)
   end function rows_of

   !> A row a node of a slave: the force that the tie exerts upon it. Its rows along x and y stand one behind the other.
   subroutine build_ties(model, results, scales, table)
      type(model_t), intent(in) :: model     !< ties, mesh and bilateral rows are read
      type(results_t), intent(in) :: results !< of one increment, with forces of rows
      type(scales_t), intent(in) :: scales   !< of the history: what is nothing beside them is 0
      type(table_t), intent(out) :: table    !< a row a node of a slave
      integer(ip), allocatable :: first(:), node(:)
      real(wp), allocatable :: field(:, :)
      integer(ip) :: n, k

      first = rows_of(model, ROW_TIE)
      first = first(1::2)
      n = size(first, kind=ip)
      allocate (field(n, 6))
      associate (rows => model%bilateral)
         node = rows%node(rows%first(first))
         field(:, 1:2) = transpose(model%mesh%x(:, node))
         field(:, 3) = -results%row_force(first)
         field(:, 4) = -results%row_force(first + 1)
         do k = 5, 6
            field(:, k) = field(:, k - 2)/rows%weight(first)
         end do
         call begin_step_table(table, 'ties', 'a row a node of a slave, with what the tie does to it', n, results%step)
         call add_integers(table, 'tie', rows%part(first))
      end associate
      do k = 1, 2
         call clear_small(scales%length, field(:, k))
         call clear_small(scales%force, field(:, k + 2))
         call clear_small(maxval([abs(field(:, 5:6)), 0.0_wp]), field(:, k + 4))
      end do
      call add_integers(table, 'node', model%mesh%node_id(node))
      call add_real_columns(table, ['x ', 'y ', 'f1', 'f2', 't1', 't2'], &
                            [character(len=5) :: 'L', 'L', 'F', 'F', 'F/L^2', 'F/L^2'], field)
   end subroutine build_ties

   !> A row an equation: the force that it exerts upon the dof of its first term.
   subroutine build_equations(model, results, scales, table)
      type(model_t), intent(in) :: model     !< equations, mesh and bilateral rows are read
      type(results_t), intent(in) :: results !< of one increment, with forces of rows
      type(scales_t), intent(in) :: scales   !< of the history: what is nothing beside them is 0
      type(table_t), intent(out) :: table    !< a row an equation
      integer(ip), allocatable :: rows(:)
      integer(ip) :: n

      rows = rows_of(model, ROW_EQUATION)
      n = size(rows, kind=ip)
      associate (part => model%bilateral%part(rows), equations => model%equations)
         call begin_step_table(table, 'equations', 'a row an equation, with the force upon the dof of its first term', n, &
                               results%step)
         call add_integers(table, 'equation', part)
         call add_integers(table, 'node', model%mesh%node_id(equations%node(part)))
         call add_integers(table, 'dof', equations%dof(part))
         call add_reals(table, 'force', 'F', -equations%value(part)*results%row_force(rows), scales%force)
      end associate
   end subroutine build_equations

   !> A row a spring.
   subroutine build_springs(model, results, scales, table)
      type(model_t), intent(in) :: model     !< springs, mesh and bilateral rows are read
      type(results_t), intent(in) :: results !< of one increment, with forces of rows
      type(scales_t), intent(in) :: scales   !< of the history: what is nothing beside them is 0
      type(table_t), intent(out) :: table    !< a row a spring
      integer(ip), allocatable :: rows(:), second(:)
      integer(ip) :: n

      rows = rows_of(model, ROW_SPRING)
      n = size(rows, kind=ip)
      associate (springs => model%springs(model%bilateral%part(rows)))
         second = springs%node(2)
         where (second > 0) second = model%mesh%node_id(max(second, 1_ip))
         call begin_step_table(table, 'springs', 'a row a spring; node_2 = 0 is the ground', n, results%step)
         call add_integers(table, 'spring', springs%id)
         call add_integers(table, 'node_1', model%mesh%node_id(springs%node(1)))
         call add_integers(table, 'dof_1', springs%dof(1))
         call add_integers(table, 'node_2', second)
         call add_integers(table, 'dof_2', springs%dof(2))
         call add_reals(table, 'relative_u', 'L', springs%arm*results%row_force(rows)/springs%stiffness, 0.0_wp)
         call add_reals(table, 'force', 'F', springs%arm*results%row_force(rows), scales%force)
      end associate
   end subroutine build_springs

   !> For the listing: the resultant of each tie, and the largest forces of the others.
   subroutine describe_rows(page, model, results)
      type(page_t), intent(inout) :: page    !< the lines are added to it
      type(model_t), intent(in) :: model     !< ties, equations, springs and bilateral rows are read
      type(results_t), intent(in) :: results !< of one increment; without forces of rows nothing is told
      integer(ip), allocatable :: rows(:)
      integer(ip) :: i

      if (model%bilateral%n == 0 .or. .not. allocated(results%row_force)) return
      do i = 1, size(model%ties, kind=ip)
         call describe_tie(page, model, results, i)
      end do
      rows = rows_of(model, ROW_EQUATION)
      if (size(rows) > 0) then
         call add_blank(page)
         call add_entry(page, 'equations', to_text(size(rows, kind=ip)))
         call add_entry(page, 'largest force of an equation', number(maxval(abs(model%equations%value(model%bilateral%part(rows)) &
                                                                                *results%row_force(rows))), DIGITS)//' [F]')
      end if
      rows = rows_of(model, ROW_SPRING)
      if (size(rows) == 0) return
      call add_blank(page)
      call add_entry(page, 'springs', to_text(size(rows, kind=ip)))
      call add_entry(page, 'largest force of a spring', number(maxval(abs(results%row_force(rows))), DIGITS)//' [F]')
   end subroutine describe_rows

   subroutine describe_tie(page, model, results, i)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      integer(ip), intent(in) :: i
      real(wp) :: resultant(2), terms(2), moment
      integer(ip) :: j, axis

      resultant = 0.0_wp
      terms = 0.0_wp
      moment = 0.0_wp
      associate (rows => model%bilateral, tie => model%ties(i))
         axis = 2
         do j = 1, rows%n
            if (rows%kind(j) /= ROW_TIE .or. rows%part(j) /= i) cycle
            axis = 3 - axis
            resultant(axis) = resultant(axis) - results%row_force(j)
            terms(axis) = terms(axis) + abs(results%row_force(j))
            moment = moment + moment_of(rows, model%mesh%x, j, axis)*results%row_force(j)
         end do
         where (abs(resultant) < ZERO_SHARE*maxval(terms)) resultant = 0.0_wp
         call add_blank(page)
         call add_line(page, '   tie '//to_text(i)//' '//tie%name//': '//model%surfaces(tie%slave)%name//' on '// &
                       model%surfaces(tie%master)%name)
         call add_entry(page, 'nodes of the slave that are tied', to_text(tie%n_nodes))
         if (tie%n_far > 0) call add_entry(page, 'nodes that are too far', to_text(tie%n_far))
         call add_entry(page, 'resultant upon the slave', number(resultant(1), DIGITS)//', '//number(resultant(2), DIGITS)//' [F]')
         call add_entry(page, 'moment about 0,0', number(moment, DIGITS)//' [F*L]')
      end associate
   end subroutine describe_tie

   !> The moment about the origin, per unit force of a row, of what it does to the slave, whose entries come first and sum to one.
   pure real(wp) function moment_of(rows, x, j, axis) result(moment)
      type(bilateral_rows_t), intent(in) :: rows
      real(wp), intent(in) :: x(:, :)
      integer(ip), intent(in) :: j, axis
      real(wp), parameter :: ALL_OF_SLAVE = 1 - 1.0e-9_wp
      real(wp) :: total
      integer(ip) :: k

      moment = 0.0_wp
      total = 0.0_wp
      do k = rows%first(j), rows%first(j + 1) - 1
         if (total >= ALL_OF_SLAVE) return
         total = total + rows%vector(axis, k)
         if (axis == 1) moment = moment + x(2, rows%node(k))*rows%vector(1, k)
         if (axis == 2) moment = moment - x(1, rows%node(k))*rows%vector(2, k)
      end do
   end function moment_of

   !> `1 tie, 2 equations, 3 springs`; '' where there is nothing of the kind.
   pure function joined_text(model) result(text)
      type(model_t), intent(in) :: model !< ties, equations and springs are counted
      character(len=:), allocatable :: text
      integer(ip) :: n

      text = ''
      if (model%bilateral%n == 0) return
      n = 0
      if (allocated(model%ties)) n = size(model%ties, kind=ip)
      if (n > 0) text = text//', '//plural(n, 'tie', 'ties')
      n = model%equations%n
      if (n > 0) text = text//', '//plural(n, 'equation', 'equations')
      n = 0
      if (allocated(model%springs)) n = size(model%springs, kind=ip)
      if (n > 0) text = text//', '//plural(n, 'spring', 'springs')
      if (len(text) > 0) text = text(3:)
   end function joined_text

end module atrito_row_tables
