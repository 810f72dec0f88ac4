!> The printed listing of a run, <deck name>.lst: made to be read and handed in.
module atrito_listing
   use atrito_as_run_names, only: as_run_name
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t, join, replaced, to_text
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   use atrito_status, only: status_t
   use atrito_files, only: file_set_t, text_file_t, open_text, put_line, close_text
   use atrito_messages, only: count_messages, get_message, format_message
   use atrito_system, only: peak_memory
   use atrito_timers, only: phase_time_t, get_phases
   use atrito_extreme_report, only: describe_extremes
   use atrito_frame_tables, only: has_frame_rows
   use atrito_increments, only: increment_t, list_increments, has_history, increment_name, ending_text, time_text
   use atrito_libraries, only: library_t, list_libraries
   use atrito_model, only: model_t
   use atrito_results, only: unsettled_t, results_t, history_t, scene_t, balance_t, last_frame, view_frame
   use atrito_page, only: page_t, begin_page, add_line, add_blank, add_rule, add_heading, add_entry, add_paragraph, left, right, &
                          number, bytes
   use atrito_model_report, only: describe_model
   use atrito_resultant_report, only: describe_resultants
   use atrito_row_tables, only: describe_rows
   use atrito_rigid_report, only: describe_rigid_bodies
   use atrito_scene_report, only: describe_needs, describe_bodies, describe_pairs
   use atrito_summary, only: quantity_t, scales_t, summarise_pair, pair_quantities, step_quantities, measure_history, pair_name, &
                             uniqueness_text
   use atrito_table, only: ZERO_SHARE
   use atrito_utf8, only: visible
   implicit none (type, external)
   private
   public :: write_listing, compose_listing, list_used_libraries, date_text

   integer, parameter :: WIDTH = 100                !< columns
   integer, parameter :: DIGITS = 6                 !< of numbers for people
   real(wp), parameter :: LEAST_CONTRACTION = 1.0e-6_wp      !< below it nothing couples pressure and friction but round-off

contains

   !> Writes <deck name>.lst into a set of files.
   !>
   !> status: STATUS_FILE when it could not be written.
   subroutine write_listing(model, history, set, status, pictures)
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      type(file_set_t), intent(inout) :: set
      type(status_t), intent(out) :: status
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
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      type(page_t), intent(out) :: page
      type(string_t), intent(in), optional :: pictures(:)    !< that are drawn after the listing, names without ending
      type(scales_t) :: scales
      type(scales_t), allocatable :: own(:)

      call begin_page(page, WIDTH)
      call add_title(page, model, history)
      call add_heading(page, '1  WHAT WAS UNDERSTOOD')
      call describe_model(page, model)
      call add_blank(page)
      associate (last => history%frames(last_frame(history)))
         call describe_pairs(page, last%scene, some=.false.)
         call add_heading(page, '2  WHAT THE SCENE NEEDS')
         call describe_needs(page, last%scene)
         call add_heading(page, '3  ORDER, STORAGE AND SOLVER')
         call add_solver(page, history, last)
         call add_heading(page, '4  ITERATIONS')
         if (has_history(model, history)) call add_increments(page, history)
         call add_iterations(page, last)
         call add_heading(page, '5  CONTACT')
         call measure_history(model, history, scales, own)
         call add_contact(page, model, history, own)
         call describe_rows(page, model, last)
         call add_heading(page, '6  REACTIONS AND EQUILIBRIUM')
         if (has_history(model, history)) call add_line(page, '   at the end: '//frame_name(last))
         call add_equilibrium(page, model, last, scales)
         call describe_extremes(page, last, scales)
         call add_end(page, last, pictures)
      end associate
   end subroutine compose_listing

   !> How the bodies were factored, and by which libraries.
   subroutine add_solver(page, history, results)
      type(page_t), intent(inout) :: page
      type(history_t), intent(in) :: history
      type(results_t), intent(in) :: results        !< the last of it
      type(library_t), allocatable :: list(:)
      integer :: i

      call describe_bodies(page, results%scene, factored=.true., some=.false.)
      if (uses(results%scene, 'skyline') .or. uses(results%scene, 'banded')) then
         call add_entry(page, 'order', 'reverse Cuthill-McKee, contact nodes last')
      end if
      if (uses(results%scene, 'sparse')) then
         call add_entry(page, 'order of sparse bodies', 'nested dissection, contact nodes last')
      end if
      call add_entry(page, 'factorisations', to_text(max(history%factorisations, int(results%factorisations, ip))))
      call add_entry(page, 'linear solves of the line', to_text(int(results%linear_solves, ip)))
      call list_used_libraries(results%scene, list)
      do i = 1, size(list)
         call add_entry(page, trim(list(i)%name), list(i)%version)
      end do
   end subroutine add_solver

   !> Messages, pictures, the estimated error and the times.
   subroutine add_end(page, results, pictures)
      type(page_t), intent(inout) :: page
      type(results_t), intent(in) :: results
      type(string_t), intent(in), optional :: pictures(:)

      call add_heading(page, '7  MESSAGES')
      call add_messages(page)
      if (present(pictures)) then
         call add_blank(page)
         call add_entry(page, 'plots, drawn after this listing', 'plots/')
         call add_paragraph(page, join(pictures, ', '), 6)
      end if
      call add_heading(page, '8  ERROR AND TIME')
      call add_entry(page, 'estimated error', number(results%error_estimate, DIGITS)//' % of the energy norm')
      call add_times(page)
   end subroutine add_end

   pure function frame_name(results) result(text)
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: text

      text = increment_name(results%step, results%increment, results%time)
   end function frame_name

   !> A row an increment; its iterations are in iterations.tab.
   subroutine add_increments(page, history)
      type(page_t), intent(inout) :: page
      type(history_t), intent(in) :: history
      type(increment_t), allocatable :: list(:)
      integer :: i

      list = list_increments(history)
      call add_line(page, right('step', 8)//right('increment', 11)//right('time', 18)//right('outer iterations', 18)// &
                    right('residual', 14))
      do i = 1, size(list)
         call add_line(page, right(to_text(list(i)%step), 8)//right(to_text(list(i)%increment), 11)// &
                       right(time_text(list(i)%time), 18)//right(to_text(list(i)%outer), 18)// &
                       right(number(list(i)%residual, 4), 14))
      end do
      call add_blank(page)
      call add_line(page, '   of the last increment that is printed, '//frame_name(history%frames(last_frame(history)))//':')
      call add_blank(page)
   end subroutine add_increments

   !> Compiler and libraries; those that this run did not use are told so.
   subroutine list_used_libraries(scene, list)
      type(scene_t), intent(in) :: scene
      type(library_t), allocatable, intent(out) :: list(:)

      call list_libraries(.true., list, is_by_metis(scene))
   end subroutine list_used_libraries

   !> Whether any order of elimination is METIS's.
   pure logical function is_by_metis(scene)
      type(scene_t), intent(in) :: scene
      integer :: i

      is_by_metis = .false.
      if (allocated(scene%order)) is_by_metis = index(scene%order, 'METIS') > 0
      do i = 1, size(scene%bodies)
         if (allocated(scene%bodies(i)%order)) is_by_metis = is_by_metis .or. index(scene%bodies(i)%order, 'METIS') > 0
      end do
   end function is_by_metis

   !> Whether any body has a solver.
   pure logical function uses(scene, solver)
      type(scene_t), intent(in) :: scene
      character(len=*), intent(in) :: solver       !< skyline, ...
      integer :: i

      uses = .false.
      do i = 1, size(scene%bodies)
         if (.not. allocated(scene%bodies(i)%solver)) cycle
         uses = uses .or. scene%bodies(i)%solver == solver
      end do
   end function uses

   subroutine add_title(page, model, history)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      integer :: i

      call add_rule(page, '=')
      call add_line(page, left(PROGRAM_NAME//' '//PROGRAM_VERSION, 60)//right(date_text(), WIDTH - 60))
      call add_line(page, 'deck  '//model%deck_path)
      do i = 1, size(model%heading)
         call add_paragraph(page, model%heading(i)%s, 6)
      end do
      if (allocated(model%provenance%options)) call add_line(page, left('options  '//model%provenance%options, WIDTH))
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

   !> yyyy-mm-dd hh:mm
   function date_text() result(text)
      character(len=:), allocatable :: text
      character(len=8) :: date
      character(len=10) :: time

      call date_and_time(date=date, time=time)
      text = date(1:4)//'-'//date(5:6)//'-'//date(7:8)//' '//time(1:2)//':'//time(3:4)
   end function date_text

   subroutine add_iterations(page, results)
      type(page_t), intent(inout) :: page
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: unique
      integer :: i

      call add_entry(page, 'outer iterations', to_text(int(results%outer_iterations, ip)))
      if (results%contraction > 0.0_wp) call add_entry(page, 'contraction, measured', number(results%contraction, 3))
      unique = uniqueness_text(results%uniqueness)
      if (len(unique) > 0) call add_entry(page, 'uniqueness', unique)
      if (results%contraction_estimate > LEAST_CONTRACTION) then
         call add_entry(page, 'contraction, estimated', number(results%contraction_estimate, 3) &
                        //'; from 1 on there may be several solutions')
      end if
      if (allocated(results%verdict)) call add_entry(page, 'outcome', results%verdict)
      if (.not. allocated(results%iterations)) return
      if (size(results%iterations) == 0) return
      call add_blank(page)
      call add_line(page, right('outer', 8)//right('inner', 6)//right('open', 7)//right('stick', 7)//right('slip', 7)// &
                    right('d displ.', 14)//right('d pressure', 14)//right('d friction', 14)//right('residual', 14))
      do i = 1, size(results%iterations)
         associate (row => results%iterations(i))
            call add_line(page, right(to_text(row%outer), 8)//right(to_text(row%inner), 6)//right(to_text(row%open), 7)// &
                          right(to_text(row%stick), 7)//right(to_text(row%slip), 7)// &
                          right(number(row%change_displacement, 4), 14)//right(number(row%change_pressure, 4), 14)// &
                          right(number(row%change_friction, 4), 14)//right(number(row%residual, 4), 14))
         end associate
      end do
      if (allocated(results%unsettled)) call add_unsettled(page, results%unsettled)
   end subroutine add_iterations

   !> All points that changed their states in the last outer iterations.
   subroutine add_unsettled(page, unsettled)
      type(page_t), intent(inout) :: page
      type(unsettled_t), intent(in) :: unsettled(:)
      integer :: i

      if (size(unsettled) == 0) return
      call add_blank(page)
      call add_paragraph(page, &
                         'Points that are unsettled, with their states at the end of the last outer iterations, oldest first: ' &
                         //'o open, = sticking, + slipping along T, - against it, c closed without friction', 3)
      call add_line(page, right('pair', 8)//right('point', 7)//right('node', 10)//right('x', 16)//right('y', 16)//'   states')
      do i = 1, size(unsettled)
         associate (c => unsettled(i))
            call add_line(page, right(to_text(c%pair), 8)//right(to_text(c%point), 7)//right(to_text(c%node), 10)// &
                          right(number(c%x(1), DIGITS), 16)//right(number(c%x(2), DIGITS), 16)//'   '//c%states)
         end associate
      end do
   end subroutine add_unsettled

   !> The pairs of each increment whose contact is printed.
   subroutine add_contact(page, model, history, own)
      type(page_t), intent(inout) :: page
      type(model_t), intent(in) :: model
      type(history_t), intent(in), target :: history
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
         if (has_history(model, history)) call add_line(page, frame_name(frame))
         call add_pairs(page, frame, own)
         if (has_history(model, history)) call describe_rigid_bodies(page, frame)
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
      type(balance_t) :: b
      real(wp) :: total(2)
      integer :: i

      b = results%balance
      if (b%is_revolved) then
         call add_line(page, '   of the full circle: what is radial, and moments, balance in themselves')
         b = balance_t([0.0_wp, b%applied(2)], [0.0_wp, b%reactions(2)], rigid=[0.0_wp, b%rigid(2)], &
                       rows=[0.0_wp, b%rows(2)])
      end if
      call add_line(page, '   '//left('resultants', 30)//right('F1 [F]', 18)//right('F2 [F]', 18)// &
                    right('moment about 0,0', 20))
      call add_line(page, force_line('applied', b%applied)//right(number(b%applied_moment, DIGITS), 20))
      call add_line(page, force_line('reactions of the supports', b%reactions)//right(number(b%reaction_moment, DIGITS), 20))
      call add_line(page, force_line('from rigid surfaces', -b%rigid))
      if (any(abs(b%rows) > 0.0_wp)) call add_line(page, force_line('from springs and equations', -b%rows))
      total = b%applied + b%reactions - b%rigid - b%rows     ! equilibrium makes it zero; rounding of its parts is nothing
      where (abs(total) < ZERO_SHARE*(abs(b%applied) + abs(b%reactions) + abs(b%rigid) + abs(b%rows))) total = 0.0_wp
      call add_line(page, force_line('sum', total))
      call describe_resultants(page, model, results, scales)
      call describe_rigid_bodies(page, results)
      call add_blank(page)
      list = step_quantities(results)
      do i = 1, size(list)
         if (list(i)%is_count .or. list(i)%name == 'error_estimate_percent') cycle
         call add_quantity(page, list(i))
      end do
      call add_entry(page, 'contact law, checked anew', trim(merge('holds at every point             ', &
                                                                   'DOES NOT HOLD, or was not reached', &
                                                                   results%converged .and. results%law_holds)))
   end subroutine add_equilibrium

   pure function force_line(name, f) result(text)
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: f(2)
      character(len=:), allocatable :: text

      text = '   '//left(name, 30)//right(number(f(1), DIGITS), 18)//right(number(f(2), DIGITS), 18)
   end function force_line

   subroutine add_messages(page)
      type(page_t), intent(inout) :: page
      type(string_t), allocatable :: lines(:)
      integer(ip) :: i
      integer :: j

      if (count_messages() == 0) call add_line(page, '   none')
      do i = 1, count_messages()
         lines = format_message(get_message(i))
         do j = 1, size(lines)
            call add_paragraph(page, trim(lines(j)%s), merge(3, 6, j == 1))
         end do
      end do
   end subroutine add_messages

   subroutine add_times(page)
      type(page_t), intent(inout) :: page
      type(phase_time_t), allocatable :: phases(:)
      integer :: i

      call add_entry(page, 'peak memory', bytes(peak_memory()))
      call add_blank(page)
      call add_line(page, '   '//left('phase', 24)//right('wall [s]', 12)//right('cpu [s]', 12))
      phases = get_phases()
      do i = 1, size(phases)
         call add_line(page, time_line(trim(phases(i)%name), phases(i)%wall, phases(i)%cpu))
      end do
      call add_line(page, time_line('total', sum(phases%wall), sum(phases%cpu)))
   end subroutine add_times

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
