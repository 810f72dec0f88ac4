!> Rigid surfaces that move, and pre-tension sections: rigid.tab, and their lines of the listing.
module atrito_rigid_report
   use atrito_kinds, only: ip, wp
   use atrito_load_resultants, only: last_value
   use atrito_model, only: model_t, nodal_values_t, rigid_body_name
   use atrito_page, only: page_t, add_entry, add_line, add_blank, left, right, number
   use atrito_grid, only: grid_t, begin_grid, add_row, put_grid, CELL
   use atrito_results, only: results_t, rigid_result_t
   use atrito_strings, only: string_t, to_text
   use atrito_summary, only: scales_t
   use atrito_table, only: table_t, begin_step_table, add_integers, add_words, add_real_columns, clear_small, one_word
   implicit none (type, external)
   private
   public :: build_rigid_table, describe_rigid_bodies, describe_references

   integer, parameter :: DIGITS = 6
   real(wp), parameter :: SUMMED = 100.0_wp         !< round-offs of a moment, which is the sum of those of all points
   character(len=8), parameter :: DOF_NAMES(6) = ['u1      ', 'u2      ', '        ', '        ', '        ', 'rotation']

contains

   !> A row a rigid surface with a reference node.
   subroutine build_rigid_table(results, scales, table)
      type(results_t), intent(in) :: results        !< with rigid bodies
      type(scales_t), intent(in) :: scales          !< of the history: what is nothing beside them is 0
      type(table_t), intent(out) :: table           !< a row a body
      character(len=:), allocatable :: title
      type(string_t) :: names(size(results%rigid))
      real(wp) :: field(size(results%rigid), 6)
      integer(ip) :: i, n

      n = size(results%rigid, kind=ip)
      do i = 1, n
         names(i)%s = one_word(results%rigid(i)%name)
         field(i, :) = numbers_of(results%rigid(i), scales)
      end do
      title = 'a row a rigid surface with a reference node'
      if (any(results%rigid%is_section)) title = title//', or a pre-tension section'
      call begin_step_table(table, 'rigid', title//': its motion and what holds it', n, results%step)
      call add_words(table, 'body', '-', names, on_the_left=.true.)
      call add_integers(table, 'node', results%rigid%node)
      call add_real_columns(table, ['u1', 'u2', 'ur'], ['L', 'L', '-'], field(:, :3))
      call add_real_columns(table, ['r1    ', 'r2    ', 'moment'], ['F  ', 'F  ', 'F*L'], field(:, 4:))
   end subroutine build_rigid_table

   !> Motion and reaction of a body, what is rounding in them 0.
   pure function numbers_of(body, scales) result(numbers)
      type(rigid_result_t), intent(in) :: body
      type(scales_t), intent(in) :: scales
      real(wp) :: numbers(6), force

      numbers = [body%u, body%rotation, body%reaction, body%moment]
      if (body%is_section) numbers(4) = body%force
      force = max(scales%force, norm2(body%reaction), abs(body%force))
      call clear_small(scales%displacement, numbers(1:2))
      call clear_small(scales%displacement/body%size, numbers(3:3))
      call clear_small(force, numbers(4:5))
      call clear_small(SUMMED*force*body%size, numbers(6:6))
   end function numbers_of

   !> The rigid surfaces that move, and what of them is prescribed at the end of a step; pre-tension sections, by what they take out
   !> or the force that acts then.
   subroutine describe_references(page, model, step)
      type(page_t), intent(inout) :: page !< the lines are added to it
      type(model_t), intent(in) :: model  !< rigid bodies and what is prescribed of them
      integer(ip), intent(in) :: step     !< from 1
      character(len=:), allocatable :: text
      real(wp) :: moved, force
      logical :: is_held, is_loaded
      integer(ip) :: i, k

      if (.not. allocated(model%rigid_bodies)) return
      do i = 1, size(model%rigid_bodies, kind=ip)
         text = ''
         associate (held => model%steps(step)%rigid_prescribed, node => model%rigid_bodies(i)%node)
            if (model%rigid_bodies(i)%is_section) then
               call add_up(model, step, node, held, moved, is_held)
               call add_up(model, step, node, model%steps(step)%rigid_loads, force, is_loaded)
               text = 'force '//number(force, DIGITS)//' [F]'
               if (is_held) text = number(moved, DIGITS)//' [L] taken out'
               call add_entry(page, 'pre-tension '//model%surfaces(model%rigid_bodies(i)%surface)%name, &
                              'node '//to_text(model%mesh%node_id(node))//', '//text)
               cycle
            end if
            do k = 1, held%n
               if (held%node(k) /= node) cycle
               if (len(text) > 0) text = text//', '
               text = text//trim(DOF_NAMES(held%dof(k)))//' = '//number(last_value(model, step, held, k), DIGITS)
            end do
            do k = 1, model%inclined%n
               if (model%inclined%node(k) /= node) cycle
               if (len(text) > 0) text = text//', '
               text = text//'along its axis '//to_text(model%inclined%dof(k))//': '//number(model%inclined%value(k), DIGITS)
            end do
            if (len(text) == 0) text = 'free'
            call add_entry(page, 'rigid body '//rigid_body_name(model, i), &
                           'reference node '//to_text(model%mesh%node_id(node))//', '//text)
         end associate
      end do
   end subroutine describe_references

   !> What a list has at dof 1 of a node at the end of a step.
   subroutine add_up(model, step, node, list, total, is_there)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: step, node
      type(nodal_values_t), intent(in) :: list
      real(wp), intent(out) :: total
      logical, intent(out) :: is_there
      integer(ip) :: k

      total = 0.0_wp
      is_there = .false.
      do k = 1, list%n
         if (list%node(k) /= node .or. list%dof(k) /= 1) cycle
         is_there = .true.
         total = total + last_value(model, step, list, k)
      end do
   end subroutine add_up

   !> Motions and reactions, as rigid.tab has them, for the listing.
   subroutine describe_rigid_bodies(page, results, scales)
      type(page_t), intent(inout) :: page    !< the lines are added to it
      type(results_t), intent(in) :: results !< of one increment; without rigid bodies nothing is told
      type(scales_t), intent(in) :: scales   !< of the history: what is nothing beside them is 0
      type(grid_t) :: grid
      real(wp) :: numbers(6)
      integer :: i, j

      if (.not. allocated(results%rigid)) return
      ! What the sides of sections approach by, and their forces.
      if (any(results%rigid%is_section)) then
         call add_blank(page)
         call add_line(page, '   '//left('pre-tension', 15)//right('taken out [L]', 16)//right('force [F]', 14))
         do j = 1, size(results%rigid)
            associate (body => results%rigid(j))
               if (.not. body%is_section) cycle
               call add_line(page, '   '//left(body%name, 15)//right(number(body%u(1), DIGITS), 16) &
                             //right(number(body%force, DIGITS), 14))
            end associate
         end do
      end if
      if (all(results%rigid%is_section)) return
      call add_blank(page)
      call begin_grid(grid, 1, 'rigid body'//CELL//'u1 [L]'//CELL//'u2 [L]'//CELL//'rotation'//CELL//'R1 [F]'//CELL//'R2 [F]'// &
                      CELL//'moment [F L]')
      do i = 1, size(results%rigid)
         associate (body => results%rigid(i))
            if (body%is_section) cycle
            numbers = numbers_of(body, scales)
            call add_row(grid, body%name//CELL//number(numbers(1), DIGITS)//CELL//number(numbers(2), DIGITS)//CELL// &
                         number(numbers(3), DIGITS)//CELL//held(body%has_reaction(1), numbers(4))//CELL// &
                         held(body%has_reaction(2), numbers(5))//CELL//held(body%is_prescribed(3), numbers(6)))
         end associate
      end do
      call put_grid(page, grid)
   end subroutine describe_rigid_bodies

   !> A reaction, where there may be one.
   pure function held(is_prescribed, value) result(text)
      logical, intent(in) :: is_prescribed
      real(wp), intent(in) :: value
      character(len=:), allocatable :: text

      text = 'free'
      if (is_prescribed) text = number(value, DIGITS)
   end function held

end module atrito_rigid_report
