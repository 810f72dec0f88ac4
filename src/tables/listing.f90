!> The printed listing of a run, <deck name>.lst: made to be read and handed in.
module atrito_listing
   use atrito_as_run_names, only: as_run_name
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t, count_symbol, join, replaced, to_text
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   use atrito_status, only: status_t
   use atrito_files, only: file_set_t, text_file_t, open_text, put_line, close_text, NEW_LINE_CHARACTER
   use atrito_messages, only: count_messages, get_message, format_message
   use atrito_system, only: peak_memory
   use atrito_timers, only: phase_time_t, get_phases
   use atrito_energy_report, only: describe_energies
   use atrito_extreme_report, only: describe_extremes
   use atrito_frame_tables, only: build_frame_table, has_frame_rows
   use atrito_grid, only: grid_t, begin_grid, add_row, put_grid, put_table, CELL
   use atrito_increments, only: has_history, increment_name, ending_text
   use atrito_model, only: model_t, name_units
   use atrito_results, only: results_t, history_t, error_bound_t, last_frame, view_frame
   use atrito_page, only: page_t, begin_page, add_line, add_blank, add_rule, add_heading, add_entry, add_paragraph, left, right, &
                          number, bytes
   use atrito_model_report, only: describe_model
   use atrito_resultant_report, only: describe_resultants
   use atrito_row_tables, only: describe_rows
   use atrito_rigid_report, only: describe_rigid_bodies
   use atrito_scene_report, only: describe_needs, describe_pairs
   use atrito_solver_report, only: describe_solver, describe_increments, describe_iterations
   use atrito_summary, only: bound_text, quantity_t, scales_t, summarise_pair, pair_quantities, step_quantities, measure_history, &
                             pair_count, pair_name
   use atrito_patched_text, only: take_ends
   use atrito_table, only: table_t, clear_small, ZERO_SHARE
   use atrito_utf8, only: visible
   implicit none (type, external)
   private
   public :: write_listing, compose_listing, date_text

   integer, parameter :: WIDTH = 80                 !< columns
   integer, parameter :: MOST_LINES = 200           !< of the deck; of a longer one half as many at each end
   integer, parameter :: DIGITS = 6                 !< of numbers for people
   character(len=22), parameter :: SAID_ELSEWHERE(*) = &
                                   [character(len=22) :: 'error_estimate_percent', 'strain_energy', 'external_work']

contains

   !> Writes <deck name>.lst into a set of files.
   !>
   !> status: STATUS_FILE when it could not be written.
   subroutine write_listing(model, history, set, status, pictures)
      type(model_t), intent(in) :: model                     !< as solved
      type(history_t), intent(in) :: history                 !< with all frames; it is not empty
      type(file_set_t), intent(inout) :: set                 !< begun; gets the listing
      type(status_t), intent(out) :: status                  !< STATUS_FILE where it could not be written
      type(string_t), intent(in), optional :: pictures(:)    !< that are drawn after the listing, names without ending
      type(page_t) :: page
      type(text_file_t) :: file
      integer :: i

      call compose_listing(model, history, page, pictures)
      call open_text(set, model%deck_name//'.lst', file)
      do i = 1, page%n
         call put_line(file, visible(page%lines(i)%s))
      end do
      call close_text(file, status)
   end subroutine write_listing

   !> Composes the listing, without writing it.
   subroutine compose_listing(model, history, page, pictures)
      type(model_t), intent(in) :: model                     !< as solved
      type(history_t), intent(in) :: history                 !< with all frames; it is not empty
      type(page_t), intent(out) :: page                      !< lines of at most 80 columns
      type(string_t), intent(in), optional :: pictures(:)    !< that are drawn after the listing, names without ending
      type(scales_t) :: scales
      type(scales_t), allocatable :: own(:)
      integer :: first, i

      call begin_page(page, WIDTH)
      call add_title(page, model, history)
      call add_deck(page, model)
      first = page%n + 1
      page%units = model%units
      call add_heading(page, '1  WHAT WAS UNDERSTOOD')
      call describe_model(page, model)
      call add_blank(page)
      associate (last => history%frames(last_frame(history)))
         call describe_pairs(page, last%scene, some=.false.)
         call add_heading(page, '2  WHAT THE SCENE NEEDS')
         call describe_needs(page, last%scene)
         call add_heading(page, '3  ORDER, STORAGE AND SOLVER')
         call describe_solver(page, history, last)
         call add_heading(page, '4  ITERATIONS')
         if (has_history(model, history)) call describe_increments(page, history)
         call describe_iterations(page, last)
         call add_heading(page, '5  CONTACT')
         call measure_history(model, history, scales, own)
         call add_contact(page, model, history, scales, own)
         call describe_rows(page, model, last)
         call add_heading(page, '6  REACTIONS AND EQUILIBRIUM')
         if (has_history(model, history)) call add_line(page, '   at the end: '// &
                                                        increment_name(last%step, last%increment, last%time))
         call add_equilibrium(page, model, last, scales)
         call describe_extremes(page, last, scales)
         call add_heading(page, '7  WHAT WAS PRINTED')
         call add_tables(page, model, history, scales, own)
         call add_end(page, last, pictures)
      end associate
      do i = first, page%n
         call name_units(model%units, page%lines(i)%s)
      end do
   end subroutine compose_listing

   !> Messages, pictures, the estimated error and the times.
   subroutine add_end(page, results, pictures)
      type(page_t), intent(inout) :: page
      type(results_t), intent(in) :: results
      type(string_t), intent(in), optional :: pictures(:)
      type(string_t), allocatable :: lines(:)
      integer(ip) :: i
      integer :: j, k
      type(phase_time_t), allocatable :: phases(:)

      call add_heading(page, '8  MESSAGES')
      if (count_messages() == 0) call add_line(page, '   none')
      do i = 1, count_messages()
         lines = format_message(get_message(i))
         do j = 1, size(lines)
            call add_paragraph(page, trim(lines(j)%s), merge(3, 6, j == 1))
         end do
      end do
      if (present(pictures)) then
         call add_blank(page)
         call add_entry(page, 'plots, drawn after this listing', 'plots/')
         call add_paragraph(page, join(pictures, ', '), 6)
      end if
      call add_heading(page, '9  ERROR AND TIME')
      call add_entry(page, 'estimated error', number(results%error_estimate, DIGITS)//' % of the energy norm')
      call add_bound(page, results%error_bound)
      if (allocated(results%bounded)) call add_bounded(page, results)
      call add_entry(page, 'peak memory', bytes(peak_memory()))
      call add_blank(page)
      call add_line(page, '   '//left('phase', 24)//right('wall [s]', 12)//right('cpu [s]', 12))
      phases = get_phases()
      do k = 1, size(phases)
         call add_line(page, time_line(trim(phases(k)%name), phases(k)%wall, phases(k)%cpu))
      end do
      call add_line(page, time_line('total', sum(phases%wall), sum(phases%cpu)))
   end subroutine add_end

   !> What is proved of the error, for what, and of which parts it is made.
   subroutine add_bound(page, bound)
      type(page_t), intent(inout) :: page
      type(error_bound_t), intent(in) :: bound

      if (bound%exists) then
         call add_entry(page, 'bound of the error', number(bound%percent, DIGITS)//' % of the energy norm of the displacements')
         call add_entry(page, '', trim(merge('certified for the friction bound of this run', &
                                             'not certified                               ', bound%is_certified)))
         if (bound%is_of_polygon) call add_entry(page, '', 'of the polygon of the mesh: sides of a *BLOCK are arcs')
         call add_entry(page, 'of its square', 'bodies '//number(bound%bulk, 3)//', normal contact '//number(bound%normal, 3) &
                        //', friction '//number(bound%tangential, 3))
         call add_entry(page, 'equilibrium of its stresses', number(bound%residual, 2)//' of the largest force')
      end if
      if (len_trim(bound%why_not) > 0) call add_entry(page, trim(merge('not certified', 'no bound     ', bound%exists)), &
                                                      trim(bound%why_not))
   end subroutine add_bound

   !> The bounds of quantities, and what is proved of what.
   subroutine add_bounded(page, results)
      type(page_t), intent(inout) :: page
      type(results_t), intent(in) :: results
      integer :: i

      do i = 1, size(results%bounded)
         call add_entry(page, trim(results%bounded(i)%name), bound_text(results%bounded(i)))
      end do
      if (.not. any(results%bounded%exists)) return
      if (any(results%bounded%is_of_states)) then
         call add_paragraph(page, 'Bounds "with contact states held" are proved for the exact solution of the problem in which '// &
                            'faces that are closed at all their nodes are joined along the normal, those that stick along '// &
                            'the tangent, too, all others have the tractions of this run. That the exact solution has '// &
                            'these states is not proved.', 6)
      end if
      if (any(results%bounded%is_of_friction)) then
         call add_paragraph(page, 'The bounds of the potential energy are proved for the friction bound of this run.', 6)
      end if
      if (any(results%bounded%exists .and. .not. (results%bounded%is_of_states .or. results%bounded%is_of_friction))) then
         call add_paragraph(page, 'All others are proved for the exact solution, and no states are held.', 6)
      end if
   end subroutine add_bounded

   subroutine add_title(page, model, history)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      integer :: i

      call add_rule(page, '=')
      call add_line(page, left(PROGRAM_NAME//' '//PROGRAM_VERSION, 40)//right(date_text(), WIDTH - 40))
      call add_line(page, 'deck  '//model%deck_path)
      do i = 1, size(model%heading)
         call add_paragraph(page, model%heading(i)%s, 6)
      end do
      if (allocated(model%provenance%options)) call add_paragraph(page, 'options  '//model%provenance%options, 0)
      if (allocated(model%provenance%digest)) call add_line(page, 'as run  '//as_run_name(model%deck_name)//', digest '// &
                                                            model%provenance%digest)
      call add_rule(page, '=')
      if (history%ending%is_early) then
         call add_blank(page)
         call add_paragraph(page, 'NOT CONVERGED: '//ending_text(history), 0)
         call add_line(page, 'What follows converged before.')
      end if
      associate (last => history%frames(last_frame(history)))
         if (last%converged .and. last%law_holds) return
         call add_blank(page)
         call add_line(page, 'NOT CONVERGED: what follows is the last iterate, not a solution.')
         if (allocated(last%verdict)) call add_paragraph(page, last%verdict, 0)
      end associate
   end subroutine add_title

   !> The deck as it was run, which runs by itself: its lines, of a long one those at both ends.
   subroutine add_deck(page, model)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      integer(ip), parameter :: ROOM = 400_ip*MOST_LINES    !< characters that are looked at, at either end
      character(len=:), allocatable :: front, back

      if (.not. allocated(model%as_run)) return
      call take_ends(model%as_run(1)%text, ROOM, front, back)
      if (len(back) == 0 .and. count_symbol(front, NEW_LINE_CHARACTER) > MOST_LINES) back = front
      call add_heading(page, 'THE DECK AS IT WAS RUN')
      call add_lines(page, front, 1, merge(MOST_LINES/2, MOST_LINES, len(back) > 0))
      if (len(back) == 0) return
      call add_line(page, '... the lines between are in '//as_run_name(model%deck_name))
      call add_lines(page, back, int(count_symbol(back, NEW_LINE_CHARACTER)) - MOST_LINES/2 + 1, huge(1))
   end subroutine add_deck

   !> Some lines of a text.
   subroutine add_lines(page, text, first, last)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: text
      integer, intent(in) :: first, last
      character(len=:), allocatable :: line
      integer :: begin, end, i

      end = 0
      i = 0
      do while (end < len(text) .and. i < last)
         i = i + 1
         begin = end + 1
         end = end + index(text(begin:), NEW_LINE_CHARACTER)
         if (end < begin) end = len(text) + 1
         if (i < first) cycle
         line = text(begin:end - 1)
         if (len(line) > 0) line = line(:len(line) - merge(1, 0, line(len(line):) == achar(13)))   ! of Windows
         if (index(line, '**') == 1 .and. len(line) > page%width) line = left(line, page%width)   ! what is read is broken
         if (len_trim(line) <= page%width) then
            call add_line(page, line)
         else
            call add_paragraph(page, line, 0)
         end if
      end do
   end subroutine add_lines

   !> The tables of the last increment that is printed, each with its rows or its extremes.
   subroutine add_tables(page, model, history, scales, own)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      type(history_t), intent(in), target :: history
      type(scales_t), intent(in) :: scales, own(:)
      character(len=12), parameter :: NAMES(8) = [character(len=12) :: 'contact', 'nodes', 'reactions', 'stress', 'nodal_stress', &
                                                                                                     'bodies', 'joints', 'sections']
      type(results_t), pointer :: frame
      type(table_t) :: table
      character(len=:), allocatable :: only_pair
      integer :: i

      call view_frame(history, last_frame(history), frame)
      only_pair = ''
      if (pair_count(frame) == 1) only_pair = 'pair '
      do i = 1, size(NAMES)
         if (.not. has_frame_rows(model, frame, trim(NAMES(i)), .true.)) cycle
         call build_frame_table(model, frame, scales, own, trim(NAMES(i)), table)
         call put_table(page, table, ' step increment s weight weighted_pressure slip_increment '//only_pair)
      end do
   end subroutine add_tables

   !> yyyy-mm-dd hh:mm
   function date_text() result(text)
      character(len=:), allocatable :: text
      character(len=8) :: date
      character(len=10) :: time

      call date_and_time(date=date, time=time)
      text = date(1:4)//'-'//date(5:6)//'-'//date(7:8)//' '//time(1:2)//':'//time(3:4)
   end function date_text

   !> The pairs of each increment whose contact is printed.
   subroutine add_contact(page, model, history, scales, own)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      type(history_t), intent(in), target :: history
      type(scales_t), intent(in) :: scales
      type(scales_t), intent(in) :: own(:)           !< of each pair
      type(results_t), pointer :: frame
      logical :: is_told
      integer(ip) :: i

      is_told = .false.
      do i = 1, last_frame(history)
         call view_frame(history, i, frame)
         if (.not. has_frame_rows(model, frame, 'contact', i == last_frame(history))) cycle
         if (is_told) call add_blank(page)
         is_told = .true.
         if (has_history(model, history)) call add_line(page, increment_name(frame%step, frame%increment, frame%time))
         call add_pairs(page, frame, own)
         if (has_history(model, history)) call describe_rigid_bodies(page, frame, scales)
      end do
      if (.not. is_told) call add_line(page, '   no contact pair')
   end subroutine add_contact

   subroutine add_pairs(page, results, own)
      type(page_t), intent(inout) :: page
      type(results_t), intent(in) :: results
      type(scales_t), intent(in) :: own(:)           !< of each pair
      type(quantity_t), allocatable :: list(:)
      integer(ip) :: i
      integer :: j

      do i = 1, size(results%contact, kind=ip)
         if (i > 1) call add_blank(page)
         call add_line(page, '   pair '//to_text(i)//': '//pair_name(results, i))
         list = pair_quantities(summarise_pair(results%contact(i)), own(i))
         do j = 1, size(list)
            if (.not. results%contact(i)%has_friction) then
               if (list(j)%name == 'stick_points') cycle
               if (list(j)%name == 'slip_points') list(j)%name = 'closed_points'
            end if
            call add_quantity(page, list(j))
         end do
      end do
   end subroutine add_pairs

   subroutine add_quantity(page, quantity)
      type(page_t), intent(inout) :: page
      type(quantity_t), intent(in) :: quantity
      character(len=:), allocatable :: value

      value = number(quantity%value, DIGITS)
      if (value /= 'undefined') then
         if (abs(quantity%value) < ZERO_SHARE*quantity%scale) value = '0'
      end if
      if (quantity%is_count) value = to_text(nint(quantity%value, ip))
      if (quantity%dimension /= '-') value = value//' ['//trim(quantity%dimension)//']'
      call add_entry(page, replaced(trim(quantity%name), '_', ' '), value)
   end subroutine add_quantity

   subroutine add_equilibrium(page, model, results, scales)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(scales_t), intent(in) :: scales
      type(quantity_t), allocatable :: list(:)
      type(grid_t) :: grid
      real(wp) :: parts(3, 5), force
      real(wp), parameter :: SUMMED = 1.0e5_wp       !< 1e-9 of all forces is nothing, as on the screen
      character(len=26), parameter :: PART_NAMES(5) = [character(len=26) :: 'applied', 'reactions of the supports', &
                                                                         'from rigid surfaces', 'from springs and equations', 'sum']
      integer :: i

      associate (b => results%balance)
         parts(:, :4) = reshape([b%applied, b%reactions, -b%rigid, -b%rows], [3, 4])
      end associate
      if (results%balance%is_revolved) then
         call add_line(page, '   of the full circle: what is radial, and moments, balance in themselves')
         parts([1, 3], :4) = 0.0_wp
      end if
      parts(:, 5) = sum(parts(:, :4), dim=2)         ! equilibrium makes it zero
      force = SUMMED*sum(abs(parts(:2, :4)))         ! by which round-off is measured
      call begin_grid(grid, 1, 'resultants'//CELL//'F1 [F]'//CELL//'F2 [F]'//CELL//'moment about 0,0 [F L]')
      do i = 1, size(parts, 2)
         call clear_small(force, parts(:2, i))
         call clear_small(max(force*scales%length, SUMMED*sum(abs(parts(3, :4)))), parts(3:, i))
         if (any(i == [3, 4]) .and. .not. any(abs(parts(:, i)) > 0.0_wp)) cycle
         call add_row(grid, trim(PART_NAMES(i))//CELL//number(parts(1, i), DIGITS)//CELL//number(parts(2, i), DIGITS)//CELL// &
                      number(parts(3, i), DIGITS))
      end do
      call put_grid(page, grid)
      call describe_resultants(page, model, results, scales)
      call describe_rigid_bodies(page, results, scales)
      call add_blank(page)
      list = step_quantities(results)
      do i = 1, size(list)
         if (list(i)%is_count .or. any(list(i)%name == SAID_ELSEWHERE)) cycle
         call add_quantity(page, list(i))
      end do
      call describe_energies(page, model, results, scales)
      call add_entry(page, 'contact law, checked anew', trim(merge('holds at every point             ', &
                                                                   'DOES NOT HOLD, or was not reached', &
                                                                   results%converged .and. results%law_holds)))
   end subroutine add_equilibrium

   pure function time_line(name, wall, cpu) result(text)
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: wall, cpu
      character(len=:), allocatable :: text
      character(len=12) :: first, second

      write (first, '(f12.4)') wall
      write (second, '(f12.4)') cpu
      text = '   '//left(name, 24)//first//second
   end function time_line

end module atrito_listing
