!> Forces of supports and loads, set by set: resultants.tab, and their lines of the listing and on the screen.
module atrito_resultant_report
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_grid, only: grid_t, begin_grid, add_row, put_grid, CELL
   use atrito_page, only: page_t, add_blank, add_item, add_line, number
   use atrito_resultants, only: resultant_t, find_resultants, holds
   use atrito_results, only: results_t
   use atrito_strings, only: string_t, to_text
   use atrito_summary, only: scales_t
   use atrito_table, only: table_t, begin_step_table, add_real_columns, add_words, clear_small, one_word
   implicit none (type, external)
   private
   public :: has_resultants, build_resultants, describe_resultants, add_supports

   integer, parameter :: DIGITS = 6, SCREEN_DIGITS = 5
   real(wp), parameter :: SUMMED = 10.0_wp          !< round-offs of a reaction, which is a sum over elements
   real(wp), parameter :: SHOWN = 1.0e5_wp          !< what is less than 1e-9 of all forces is nothing to people

contains

   !> Whether the deck has supports, loads or contact pairs.
   pure logical function has_resultants(model) result(has)
      type(model_t), intent(in) :: model !< its sources are read

      has = .false.
      if (allocated(model%sources)) has = size(model%sources) > 0
   end function has_resultants

   !> The resultants of a frame; what is rounding in them is 0.
   subroutine find_clear_resultants(model, results, length, list)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      real(wp), intent(in) :: length                !< of the mesh [L]
      type(resultant_t), allocatable, intent(out) :: list(:)
      real(wp) :: all_forces, scale, moment(1)
      integer :: i

      call find_resultants(model, results, list)
      all_forces = sum(list%force%terms)
      do i = 1, size(list)
         associate (force => list(i)%force)
            scale = force%terms
            if (holds(list(i))) scale = SUMMED*all_forces
            call clear_small(scale, force%f)
            moment = force%moment
            call clear_small(scale*length, moment)
            force%moment = moment(1)
         end associate
      end do
   end subroutine find_clear_resultants

   !> A row a support, a rigid surface or a load.
   subroutine build_resultants(model, results, scales, table)
      type(model_t), intent(in) :: model     !< its sources, loads and mesh are read
      type(results_t), intent(in) :: results !< of one increment
      type(scales_t), intent(in) :: scales   !< of the history; its length is read
      type(table_t), intent(out) :: table    !< a row a support or a load
      type(resultant_t), allocatable :: list(:)
      type(string_t), allocatable :: names(:), keywords(:)
      real(wp), allocatable :: field(:, :)
      integer :: i

      call find_clear_resultants(model, results, scales%length, list)
      allocate (names(size(list)), keywords(size(list)), field(size(list), 3))
      do i = 1, size(list)
         names(i)%s = one_word(list(i)%name)
         keywords(i)%s = list(i)%keyword
         field(i, :) = [list(i)%force%f, list(i)%force%moment]
      end do
      call begin_step_table(table, 'resultants', &
                            'a row a support or a load: its force upon the bodies, and moment about the origin', &
                            size(list, kind=ip), results%step)
      call add_words(table, 'set', '-', names, on_the_left=.true.)
      call add_words(table, 'keyword', '-', keywords, on_the_left=.true.)
      call add_real_columns(table, ['fx    ', 'fy    ', 'moment'], ['F  ', 'F  ', 'F*L'], field)
   end subroutine build_resultants

   !> For the listing: all of them.
   subroutine describe_resultants(page, model, results, scales)
      type(page_t), intent(inout) :: page            !< the lines are added to it
      type(model_t), intent(in) :: model             !< its sources, loads and mesh are read
      type(results_t), intent(in) :: results         !< of one increment
      type(scales_t), intent(in) :: scales           !< of the history; its length is read
      integer, parameter :: MOST = 40                !< lines
      type(resultant_t), allocatable :: list(:)
      type(grid_t) :: grid
      real(wp) :: moment(1)
      integer :: i

      call find_clear_resultants(model, results, scales%length, list)
      if (size(list) == 0) return
      call add_blank(page)
      call begin_grid(grid, 1, 'set by set'//CELL//'F1 [F]'//CELL//'F2 [F]'//CELL//'moment about 0,0 [F L]')
      do i = 1, min(size(list), MOST)
         associate (force => list(i)%force)
            moment = force%moment
            call clear_small(SHOWN*sum(list%force%terms), force%f)
            call clear_small(SHOWN*sum(list%force%terms)*scales%length, moment)
            call add_row(grid, '*'//list(i)%keyword//' '//list(i)%name//CELL//number(force%f(1), DIGITS)//CELL// &
                         number(force%f(2), DIGITS)//CELL//number(moment(1), DIGITS))
         end associate
      end do
      call put_grid(page, grid)
      if (size(list) > MOST) call add_line(page, '   ... and '//to_text(size(list, kind=ip) - MOST)//' more in resultants.tab')
   end subroutine describe_resultants

   !> For the screen: what holds the bodies, set by set where there is room, else in all. What is small beside the rest is 0.
   subroutine add_supports(page, model, results)
      type(page_t), intent(inout) :: page            !< one line is added to it
      type(model_t), intent(in) :: model             !< its sources, loads and mesh are read
      type(results_t), intent(in) :: results         !< of one increment
      integer, parameter :: ROOM = 66                !< columns behind the label
      type(resultant_t), allocatable :: list(:)
      character(len=:), allocatable :: text
      real(wp) :: f(2), total(2), scale
      integer :: i, n

      call find_clear_resultants(model, results, 0.0_wp, list)
      text = ''
      total = 0.0_wp
      scale = SHOWN*sum(list%force%terms)
      n = 0
      do i = 1, size(list)
         if (.not. holds(list(i))) cycle
         n = n + 1
         f = list(i)%force%f
         total = total + f
         call clear_small(scale, f)
         if (len(text) > ROOM) cycle
         if (n > 1) text = text//', '
         text = text//list(i)%name//' '//force_text(f)
      end do
      if (n == 0) return
      call clear_small(scale, total)
      text = text//' [F]'
      if (len(text) > ROOM) text = force_text(total)//' [F] in all; resultants.tab has the '//to_text(int(n, ip))//' sets'
      call add_item(page, 'held by', text)
   end subroutine add_supports

   !> `(1.5, 0)`
   pure function force_text(f) result(text)
      real(wp), intent(in) :: f(2)
      character(len=:), allocatable :: text

      text = '('//number(f(1), SCREEN_DIGITS)//', '//number(f(2), SCREEN_DIGITS)//')'
   end function force_text

end module atrito_resultant_report
