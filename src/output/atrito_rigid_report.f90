!> Rigid surfaces that move: rigid.tab, and their lines of the listing.
module atrito_rigid_report
   use atrito_kinds, only: ip, wp
   use atrito_load_resultants, only: last_factor
   use atrito_model, only: model_t
   use atrito_page, only: page_t, add_entry, add_line, add_blank, left, right, number
   use atrito_results, only: results_t
   use atrito_strings, only: string_t, to_text
   use atrito_summary, only: scales_t
   use atrito_table, only: table_t, begin_table, add_integers, add_words, add_real_columns, clear_small, one_word
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
      type(scales_t), intent(in) :: scales
      type(table_t), intent(out) :: table
      type(string_t) :: names(size(results%rigid))
      real(wp) :: field(size(results%rigid), 6), force
      integer(ip) :: i, n

      n = size(results%rigid, kind=ip)
      do i = 1, n
         associate (body => results%rigid(i))
            names(i)%s = one_word(body%name)
            field(i, :) = [body%u, body%rotation, body%reaction, body%moment]
            force = max(scales%force, norm2(body%reaction))
            call clear_small(scales%displacement, field(i, 1:2))
            call clear_small(scales%displacement/body%size, field(i, 3:3))
            call clear_small(force, field(i, 4:5))
            call clear_small(SUMMED*force*body%size, field(i, 6:6))
         end associate
      end do
      call begin_table(table, 'rigid', 'a row a rigid surface with a reference node: its motion and what holds it', n)
      call add_integers(table, 'step', spread(results%step, 1, n))
      call add_words(table, 'body', '-', names, on_the_left=.true.)
      call add_integers(table, 'node', results%rigid%node)
      call add_real_columns(table, ['u1', 'u2', 'ur'], ['L', 'L', '-'], field(:, :3))
      call add_real_columns(table, ['r1    ', 'r2    ', 'moment'], ['F  ', 'F  ', 'F*L'], field(:, 4:))
      call add_integers(table, 'increment', spread(results%increment, 1, n))
   end subroutine build_rigid_table

   !> The rigid surfaces that move, and what of them is prescribed at the end of a step.
   subroutine describe_references(page, model, step)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: step
      character(len=:), allocatable :: text
      integer(ip) :: i, k
      real(wp) :: value

      if (.not. allocated(model%rigid_bodies)) return
      do i = 1, size(model%rigid_bodies, kind=ip)
         text = ''
         associate (held => model%steps(step)%rigid_prescribed, node => model%rigid_bodies(i)%node)
            do k = 1, held%n
               if (held%node(k) /= node) cycle
               value = held%value(k)
               if (allocated(held%amplitude)) value = value*last_factor(model, step, held%amplitude(k))
               if (len(text) > 0) text = text//', '
               text = text//trim(DOF_NAMES(held%dof(k)))//' = '//number(value, DIGITS)
            end do
            if (len(text) == 0) text = 'free'
            call add_entry(page, 'rigid body '//model%surfaces(model%rigid_bodies(i)%surface)%name, &
                           'reference node '//to_text(model%mesh%node_id(node))//', '//text)
         end associate
      end do
   end subroutine describe_references

   !> Motions and reactions, as rigid.tab has them, for the listing.
   subroutine describe_rigid_bodies(page, results)
      type(page_t), intent(inout) :: page
      type(results_t), intent(in) :: results
      integer :: i

      if (.not. allocated(results%rigid)) return
      call add_blank(page)
      call add_line(page, '   '//left('rigid body', 15)//right('u1 [L]', 14)//right('u2 [L]', 14)//right('rotation', 14)// &
                    right('R1 [F]', 14)//right('R2 [F]', 14)//right('moment [F L]', 14))
      do i = 1, size(results%rigid)
         associate (body => results%rigid(i))
            call add_line(page, '   '//left(body%name, 15)//right(number(body%u(1), DIGITS), 14)// &
                          right(number(body%u(2), DIGITS), 14)//right(number(body%rotation, DIGITS), 14)// &
                          right(held(body%is_prescribed(1), body%reaction(1)), 14)// &
                          right(held(body%is_prescribed(2), body%reaction(2)), 14)// &
                          right(held(body%is_prescribed(3), body%moment), 14))
         end associate
      end do
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
