!> --show states and --show picard: what the solver of the contact line went through. A linear solve has states of the points; an
!> outer iteration ends with pressures, found with the friction bound that it froze.
module atrito_show_loop
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_page, only: page_t, add_heading, add_line, left, right
   use atrito_results, only: contact_result_t, results_t
   use atrito_solve_history, only: state_letters
   use atrito_strings, only: append_string, string_t, to_text
   use atrito_table, only: table_t, add_integers, add_reals, add_words, begin_table, one_word
   implicit none (type, external)
   private
   public :: states_t, add_states, view_states, view_picard

   character(len=*), parameter :: LETTERS = 'o open, c closed without friction, = sticking, + slipping along T, - against it'
   integer, parameter :: ROOM = 55                   !< characters of states on a line of the screen
   integer(ip), parameter :: MOST_ROWS = 2000        !< of a history

   !> A row a linear solve, of all increments.
   type :: states_t
      integer(ip), allocatable :: numbers(:, :)      !< (4, n): step, increment, outer and inner iteration
      real(wp), allocatable :: residual(:)           !< of the friction bound
      type(string_t), allocatable :: letters(:)      !< of the points
   end type states_t

contains

   !> Adds the solves of an increment.
   pure subroutine add_states(results, solution, states)
      type(results_t), intent(in) :: results
      type(contact_solution_t), intent(in) :: solution
      type(states_t), intent(inout) :: states
      integer(ip), allocatable :: of_points(:)
      integer(ip) :: i

      if (.not. allocated(states%letters)) allocate (states%numbers(4, 0), states%residual(0), states%letters(0))
      do i = 1, logged(solution)
         if (size(states%letters) >= MOST_ROWS) exit
         of_points = solution%history%log%states(:, i)
         of_points = pack(of_points, of_points > 0)
         if (size(of_points) == 0) exit
         associate (record => solution%history%records(i))
            states%numbers = reshape([states%numbers, results%step, results%increment, record%outer, record%inner], &
                                     [4, size(states%letters) + 1])
            states%residual = [states%residual, record%residual]
            call append_string(states%letters, state_letters(of_points))
         end associate
      end do
   end subroutine add_states

   !> How many linear solves were logged.
   pure integer(ip) function logged(solution) result(n)
      type(contact_solution_t), intent(in) :: solution

      n = 0
      if (allocated(solution%history%log%q)) n = min(solution%history%n, size(solution%history%log%q, 2, kind=ip))
   end function logged

   !> Page and table of the states.
   pure subroutine view_states(states, page, table)
      type(states_t), intent(in) :: states
      type(page_t), intent(inout) :: page
      type(table_t), intent(out) :: table
      integer(ip) :: i, n
      character(len=:), allocatable :: place

      n = size(states%letters, kind=ip)
      call add_heading(page, 'states of the points, a line a linear solve, the points pair by pair along s')
      call add_line(page, LETTERS)
      call add_line(page, 'step.increment outer.solve; outer 0: without friction, to begin with')
      do i = 1, n
         place = ''
         if (states%numbers(4, i) == 1) place = to_text(states%numbers(1, i))//'.'//to_text(states%numbers(2, i))
         place = right(place, 7)//right(to_text(states%numbers(3, i)), 5)//'.'//left(to_text(states%numbers(4, i)), 3)//'  '
         associate (letters => states%letters(i)%s)
            if (len(letters) > ROOM) then
               call add_line(page, place//letters(:ROOM - 2)//'..')
            else
               call add_line(page, place//letters)
            end if
         end associate
      end do
      call begin_table(table, 'show-states', 'a row a linear solve', n)
      call append_string(table%remarks, LETTERS//'; a letter a point, pair by pair along s')
      call add_integers(table, 'step', states%numbers(1, :))
      call add_integers(table, 'increment', states%numbers(2, :))
      call add_integers(table, 'outer', states%numbers(3, :))
      call add_integers(table, 'solve', states%numbers(4, :))
      call add_reals(table, 'residual', '-', states%residual, 0.0_wp)
      call add_words(table, 'states', '-', states%letters, on_the_left=.true.)
   end subroutine view_states

   !> Page and table of the outer iterations of an increment: the last solve of each.
   pure subroutine view_picard(line, results, solution, page, table)
      type(contact_line_t), intent(in) :: line
      type(results_t), intent(in) :: results
      type(contact_solution_t), intent(in) :: solution
      type(page_t), intent(inout) :: page
      type(table_t), intent(out) :: table
      integer(ip), allocatable :: last(:), numbers(:, :)
      real(wp), allocatable :: values(:, :)         ! (5, rows): s, x, y, pressure, bound
      real(wp) :: p(line%n), tau(line%n), residual, before
      integer(ip) :: i, j, k

      call add_heading(page, 'outer iterations, in each the bound of the friction is frozen')
      call add_line(page, 'outer  solves   largest pressure   largest bound   residual   over before')
      allocate (numbers(3, 0), values(5, 0), last(0))
      before = 0.0_wp
      associate (records => solution%history%records)
         do i = 1, logged(solution)
            if (i < solution%history%n) then
               if (records(i + 1)%outer == records(i)%outer) cycle
            end if
            call fetch_stresses(line, solution, i, p, tau)
            residual = records(i)%residual
            if (records(i)%outer == 0) residual = 0.0_wp
            call add_line(page, right(to_text(records(i)%outer), 5)//right(to_text(records(i)%inner), 8)// &
                          right(to_text(maxval([p, 0.0_wp]), 6), 19)//right(to_text(maxval([tau, 0.0_wp]), 6), 16)// &
                          right(text_of(residual), 12)//right(ratio(residual, before), 12))
            before = residual
            k = 0
            do j = 1, line%n - line%n_bilateral
               associate (pair => line%pair(j))
                  k = k + 1
                  if (j > 1) then
                     if (line%pair(j - 1) /= pair) k = 1
                  end if
                  numbers = reshape([numbers, records(i)%outer, pair, k], [3, size(values, 2) + 1])
                  values = reshape([values, place_of(results, pair, k), p(j), tau(j)], [5, size(numbers, 2)])
               end associate
            end do
         end do
      end associate
      call begin_table(table, 'show-picard', 'a row a point at the end of an outer iteration', size(values, 2, kind=ip))
      call append_string(table%remarks, 'of step '//to_text(results%step)//', increment '//to_text(results%increment)// &
                         '; the pressure was found with the bound |t| <= bound; outer 0: without friction')
      call add_integers(table, 'outer', numbers(1, :))
      call add_integers(table, 'pair', numbers(2, :))
      call add_integers(table, 'point', numbers(3, :))
      call add_reals(table, 's', 'L', values(1, :), 0.0_wp)
      call add_reals(table, 'x', 'L', values(2, :), 0.0_wp)
      call add_reals(table, 'y', 'L', values(3, :), 0.0_wp)
      call add_reals(table, 'pressure', 'F/L^2', values(4, :), 0.0_wp)
      call add_reals(table, 'bound', 'F/L^2', values(5, :), 0.0_wp)
   end subroutine view_picard

   !> Pressures and bounds of solve i; 0 where there are no unknowns, and for the bound of a point that cannot slip.
   pure subroutine fetch_stresses(line, solution, i, p, tau)
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(in) :: solution
      integer(ip), intent(in) :: i
      real(wp), intent(out) :: p(:), tau(:)         !< (points) [F/L^2]
      integer(ip) :: j

      p = 0.0_wp
      tau = 0.0_wp
      associate (log => solution%history%log)
         do j = 1, line%n
            if (line%normal(j) > 0) p(j) = log%q(line%normal(j), i)/line%weight(j)
            if (line%tangential(j) == 0) cycle
            if (log%upper(line%tangential(j), i) < HUGE_REAL) tau(j) = log%upper(line%tangential(j), i)/line%weight(j)
         end do
      end associate
   end subroutine fetch_stresses

   !> s, x and y of a point; 0 where no increment was found.
   pure function place_of(results, pair, k) result(place)
      type(results_t), intent(in) :: results
      integer(ip), intent(in) :: pair, k
      real(wp) :: place(3)

      place = 0.0_wp
      if (.not. allocated(results%contact)) return
      place = [results%contact(pair)%s(k), results%contact(pair)%x(:, k)]
   end function place_of

   pure function text_of(x) result(text)
      real(wp), intent(in) :: x
      character(len=:), allocatable :: text

      text = ''
      if (x > 0.0_wp) text = to_text(x, 3)
   end function text_of

   pure function ratio(x, before) result(text)
      real(wp), intent(in) :: x, before
      character(len=:), allocatable :: text

      text = ''
      if (min(x, before) > 0.0_wp) text = to_text(x/before, 3)
   end function ratio

end module atrito_show_loop
