!> --show states and --show picard: what the solver of the contact line went through. A linear solve has states of the points; an
!> outer iteration ends with pressures, found with the friction bound that it froze.
module atrito_show_loop
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_controls, only: iteration_t
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_page, only: page_t, add_heading, add_line, left, right
   use atrito_points, only: contact_points_t
   use atrito_results, only: results_t
   use atrito_solve_history, only: state_letters
   use atrito_strings, only: append_string, string_t, to_text
   use atrito_table, only: table_t, add_integers, add_real_columns, add_reals, add_words, begin_table
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
      type(results_t), intent(in) :: results           !< step and increment
      type(contact_solution_t), intent(in) :: solution !< with the log of its solves
      type(states_t), intent(inout) :: states          !< get the rows, up to MOST_ROWS
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
      type(states_t), intent(in) :: states           !< of all increments
      type(page_t), intent(inout) :: page            !< gets the view
      type(table_t), intent(out) :: table            !< show-states
      integer(ip) :: i, n
      character(len=:), allocatable :: place, shown

      n = size(states%letters, kind=ip)
      call add_heading(page, 'states of the points, a line a linear solve, the points pair by pair along s')
      call add_line(page, LETTERS)
      call add_line(page, 'step.increment outer.solve; outer 0: without friction, to begin with')
      do i = 1, n
         place = ''
         if (states%numbers(4, i) == 1) place = to_text(states%numbers(1, i))//'.'//to_text(states%numbers(2, i))
         place = right(place, 7)//right(to_text(states%numbers(3, i)), 5)//'.'//left(to_text(states%numbers(4, i)), 3)//'  '
         shown = states%letters(i)%s
         if (len(shown) > ROOM) shown = shown(:ROOM - 2)//'..'
         call add_line(page, place//shown)
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
   pure subroutine view_picard(line, points, results, solution, page, table)
      type(contact_line_t), intent(in) :: line        !< unknowns and weights of the points
      type(contact_points_t), intent(in) :: points(:) !< of each pair
      type(results_t), intent(in) :: results          !< step and increment
      type(contact_solution_t), intent(in) :: solution !< with the log of its solves
      type(page_t), intent(inout) :: page             !< gets the view
      type(table_t), intent(out) :: table             !< show-picard
      integer(ip), allocatable :: numbers(:, :)     ! (rows, 3): outer, pair, point
      real(wp), allocatable :: values(:, :)         ! (rows, 5): s, x, y, pressure, bound
      real(wp) :: residual, before
      type(iteration_t) :: record
      integer(ip) :: i, j, k, pair, first, n

      call add_heading(page, 'outer iterations, in each the bound of the friction is frozen')
      call add_line(page, 'outer  solves   largest pressure   largest bound   residual   over before')
      allocate (numbers(logged(solution)*line%n, 3), values(logged(solution)*line%n, 5))
      before = 0.0_wp
      n = 0
      do i = 1, logged(solution)
         record = solution%history%records(i)
         if (i < solution%history%n) then
            if (solution%history%records(i + 1)%outer == record%outer) cycle
         end if
         first = n + 1
         do pair = 1, size(points, kind=ip)
            do k = 1, points(pair)%n
               n = n + 1
               j = n - first + 1
               numbers(n, :) = [record%outer, pair, k]
               values(n, :) = [points(pair)%s(k), points(pair)%x(:, k), stress(line%normal(j), solution%history%log%q), &
                               stress(line%tangential(j), solution%history%log%upper)]
            end do
         end do
         residual = record%residual
         if (record%outer == 0) residual = 0.0_wp
         call add_line(page, right(to_text(record%outer), 5)//right(to_text(record%inner), 8)// &
                       right(to_text(maxval([values(first:n, 4), 0.0_wp]), 6), 19)// &
                       right(to_text(maxval([values(first:n, 5), 0.0_wp]), 6), 16)// &
                       right(ratio(residual, 1.0_wp), 12)//right(ratio(residual, before), 12))
         before = residual
      end do
      call begin_table(table, 'show-picard', 'a row a point at the end of an outer iteration', n)
      call append_string(table%remarks, 'of step '//to_text(results%step)//', increment '//to_text(results%increment)// &
                         '; the pressure was found with the bound |t| <= bound; outer 0: without friction')
      call add_integers(table, 'outer', numbers(:n, 1))
      call add_integers(table, 'pair', numbers(:n, 2))
      call add_integers(table, 'point', numbers(:n, 3))
      call add_real_columns(table, [character(len=8) :: 's', 'x', 'y', 'pressure', 'bound'], &
                            [character(len=5) :: 'L', 'L', 'L', 'F/L^2', 'F/L^2'], values(:n, :))

   contains

      !> Of an unknown in solve i: 0 where there is none, and for the bound of a point that cannot slip.
      pure real(wp) function stress(unknown, forces)
         integer(ip), intent(in) :: unknown
         real(wp), intent(in) :: forces(:, :)       !< (unknowns, solves)

         stress = 0.0_wp
         if (unknown == 0) return
         if (forces(unknown, i) < HUGE_REAL) stress = forces(unknown, i)/line%weight(j)
      end function stress

   end subroutine view_picard

   !> A residual over another one, or 1; '' where one of them is none.
   pure function ratio(x, over) result(text)
      real(wp), intent(in) :: x, over
      character(len=:), allocatable :: text

      text = ''
      if (min(x, over) > 0.0_wp) text = to_text(x/over, 3)
   end function ratio

end module atrito_show_loop
