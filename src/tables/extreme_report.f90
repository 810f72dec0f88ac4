!> The largest and least displacements, stresses and tractions: extremes.tab, and their lines of the listing and on the screen.
module atrito_extreme_report
   use atrito_kinds, only: ip, wp
   use atrito_grid, only: grid_t, begin_grid, add_row, put_grid, CELL
   use atrito_page, only: page_t, add_blank, add_item, add_line, left, number
   use atrito_results, only: results_t, extreme_t
   use atrito_strings, only: append_string, replaced, string_t, to_text
   use atrito_summary, only: scales_t
   use atrito_table, only: table_t, begin_step_table, add_integers, add_reals, add_words, clear_small
   implicit none (type, external)
   private
   public :: build_extremes, describe_extremes, add_extremes

   integer, parameter :: DIGITS = 6, SCREEN_DIGITS = 5

contains

   !> A row a quantity.
   subroutine build_extremes(results, scales, table)
      type(results_t), intent(in) :: results        !< with extremes
      type(scales_t), intent(in) :: scales          !< of the history: what is nothing beside them is 0
      type(table_t), intent(out) :: table           !< a row a quantity
      type(string_t) :: names(size(results%extremes))
      real(wp) :: values(size(results%extremes))
      integer(ip) :: i, n

      n = size(results%extremes, kind=ip)
      do i = 1, n
         associate (extreme => results%extremes(i))
            names(i)%s = trim(extreme%quantity)
            values(i:i) = extreme%value
            call clear_small(scale_of(extreme, scales), values(i:i))
         end associate
      end do
      call begin_step_table(table, 'extremes', 'a row a quantity: its largest or least value, and where', n, results%step)
      call append_string(table%remarks, '[L]: u u1_max u1_min u2_max u2_min')
      call append_string(table%remarks, '[F/L^2]: mises s1_max s3_min contact_pressure contact_shear')
      call add_words(table, 'quantity', '-', names, on_the_left=.true.)
      call add_reals(table, 'value', 'mixed', values, 0.0_wp)
      call add_reals(table, 'x', 'L', results%extremes%x(1), scales%length)
      call add_reals(table, 'y', 'L', results%extremes%x(2), scales%length)
      call add_integers(table, 'node_or_element', results%extremes%id)
   end subroutine build_extremes

   !> The largest value of the field that a quantity is of.
   pure real(wp) function scale_of(extreme, scales) result(scale)
      type(extreme_t), intent(in) :: extreme
      type(scales_t), intent(in) :: scales

      select case (extreme%quantity(1:1))
      case ('u')
         scale = scales%displacement
      case ('c')
         scale = scales%pressure
      case default
         scale = scales%nodal_stress
      end select
   end function scale_of

   !> For the listing: all of them.
   subroutine describe_extremes(page, results, scales)
      type(page_t), intent(inout) :: page    !< the lines are added to it
      type(results_t), intent(in) :: results !< of one increment; without extremes nothing is told
      type(scales_t), intent(in) :: scales   !< of the history: what is nothing beside them is 0
      type(grid_t) :: grid
      real(wp) :: value(1), x(2)
      integer :: i
      character(len=:), allocatable :: label

      if (.not. allocated(results%extremes)) return
      call add_blank(page)
      call add_line(page, '   '//left('largest and least; stresses are those recovered at the nodes', 60))
      call begin_grid(grid, 1, CELL//'value'//CELL//'node'//CELL//'x [L]'//CELL//'y [L]')
      do i = 1, size(results%extremes)
         associate (extreme => results%extremes(i))
            value = extreme%value
            call clear_small(scale_of(extreme, scales), value)
            x = extreme%x
            call clear_small(scales%length, x)
            ! `u1 max [L]`; |u| is the size of the displacement.
            label = replaced(trim(extreme%quantity), '_', ' ')
            if (label == 'u') label = '|u|'
            label = label//trim(merge(' [L]    ', ' [F/L^2]', extreme%quantity(1:1) == 'u'))
            call add_row(grid, label//CELL//number(value(1), DIGITS)//CELL//to_text(extreme%id)//CELL//number(x(1), DIGITS)// &
                         CELL//number(x(2), DIGITS))
         end associate
      end do
      call put_grid(page, grid)
   end subroutine describe_extremes

   !> For the screen: the largest displacement and the largest stress.
   subroutine add_extremes(page, results)
      type(page_t), intent(inout) :: page    !< two lines are added to it
      type(results_t), intent(in) :: results !< of one increment; without extremes nothing is told
      integer :: i

      if (.not. allocated(results%extremes)) return
      do i = 1, size(results%extremes)
         associate (extreme => results%extremes(i))
            if (extreme%quantity == 'u') call add_item(page, 'displaced', at_most(extreme, '[L]'))
            if (extreme%quantity == 'mises') call add_item(page, 'stressed', at_most(extreme, '[F/L^2], mises,'))
         end associate
      end do
   end subroutine add_extremes

   !> `at most 1.2e-3 [L] at node 5 (0.5, 2)`
   pure function at_most(extreme, unit) result(text)
      type(extreme_t), intent(in) :: extreme
      character(len=*), intent(in) :: unit
      character(len=:), allocatable :: text

      text = 'at most '//number(extreme%value, SCREEN_DIGITS)//' '//unit//' at node '//to_text(extreme%id)//' ('// &
             number(extreme%x(1), SCREEN_DIGITS)//', '//number(extreme%x(2), SCREEN_DIGITS)//')'
   end function at_most

end module atrito_extreme_report
