!> What a study is going to do, its quantities and its runs; and the runs: at a level with an element, and once more with other
!> regularisations.
module atrito_study_runs
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_body_cache, only: body_cache_t
   use atrito_buffer, only: buffer_t, put, take
   use atrito_command_line, only: command_t, output_folder
   use atrito_element_table, only: KINDS, kind_named
   use atrito_frame_spool, only: begin_frames, end_frames, frame_spool_t
   use atrito_history, only: solve_history
   use atrito_kinds, only: ip, wp
   use atrito_load_model, only: load_model, prepare_observations
   use atrito_messages, only: clear_messages
   use atrito_model, only: model_t
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_observations, only: observations_t, observation_name
   use atrito_reporter, only: reporter_t
   use atrito_results, only: history_t
   use atrito_run, only: run_deck, solve_options, agree_on_outcome
   use atrito_series, only: find_observed
   use atrito_solve, only: solve_options_t
   use atrito_status, only: status_t, is_ok, STATUS_OK, STATUS_NOT_CONVERGED, set_status, STATUS_USAGE
   use atrito_strings, only: to_text, upper_case, string_t, append_string, join, nearest_names
   use atrito_study_errors, only: run_facts_t, study_t, study_row_t, total_seconds, PROCESSOR
   use atrito_summary, only: quantity_t, scales_t, pair_quantities, step_quantities, summarise_pair, quantity_names
   use atrito_sweep_tables, only: sweep_run_t, read_summary, summary_value
   use atrito_timers, only: phase_time_t, reset_timers, get_phases
   implicit none (type, external)
   private
   public :: make_run, time_again, find_probe, make_command, has_failed, put_row, take_row, PROBES, plan_study

   real(wp), parameter :: SHORT = 0.1_wp             !< [s] shorter runs are made three times, for the clock
   integer, parameter :: REPEATS = 2                 !< times that a short run is made again
   !> The runs with other regularisations: half of delta, half of eps, half the compliance of the stick slope.
   character(len=*), parameter :: PROBES(3) = [character(len=21) :: 'half the delta', 'half the eps', 'twice the stick slope']

   character(len=*), parameter :: DECK_ELEMENTS = 'deck'   !< instead of a kind of element: as in the deck
   character(len=*), parameter :: ADAPTED = 'adapt'  !< the same, cut where the error is

contains

   !> Makes a short run again and keeps the times of the fastest; the first run of a process pays for loading it, and is made
   !> again however long it takes.
   subroutine time_again(command, study, row, is_first, status)
      type(command_t), intent(in) :: command        !< of the study
      type(study_t), intent(in) :: study            !< its quantities are read
      type(study_row_t), intent(inout) :: row       !< of a run that was made; gets the best times
      logical, intent(in) :: is_first               !< no run was made by this process before
      type(status_t), intent(out) :: status         !< STATUS_OK, or as of make_run
      type(phase_time_t), allocatable :: best(:)
      integer :: i

      best = row%phases
      do i = 1, REPEATS
         if (sum(best%cpu) > SHORT .and. .not. (is_first .and. i == 1)) exit
         call make_run(command, study, row, status)
         if (.not. is_ok(status)) return
         if (total_seconds(row, PROCESSOR) < sum(best%cpu)) best = row%phases
      end do
      row%phases = best
   end subroutine time_again

   !> A run once more, of which nothing is written, with half of a regularisation, or half the compliance of the stick slope.
   subroutine find_probe(command, study, k, kind, values)
      type(command_t), intent(in) :: command        !< of the study
      type(study_t), intent(in) :: study            !< its rows and quantities are read
      integer, intent(in) :: k                      !< row
      integer, intent(in) :: kind                   !< place in PROBES
      real(wp), intent(out) :: values(:)            !< one a quantity; nan where the run has none
      type(command_t) :: one
      type(body_cache_t) :: store
      type(model_t) :: model
      type(history_t) :: history
      type(frame_spool_t), target :: frames
      type(solve_options_t) :: options
      type(observations_t) :: observations
      type(reporter_t) :: reporter
      type(status_t) :: status
      integer(ip) :: told
      integer :: code, i, m
      type(quantity_t), allocatable :: list(:)

      values = ieee_value(1.0_wp, ieee_quiet_nan)
      reporter%quiet = .true.
      call make_command(command, study%rows(k), one)
      call clear_messages()
      call load_model(one, reporter, model, told, code)
      if (code == STATUS_OK) call prepare_observations(one, model, observations, code)
      if (code == STATUS_OK) then
         associate (laws => model%interactions)
            if (kind == 1) then
               laws%delta = 0.5_wp*laws%delta
            else
               laws%eps = 0.5_wp*laws%eps
               laws%stick_slope = 2*laws%stick_slope
            end if
         end associate
         call begin_frames(output_folder(command), frames)
         options = solve_options(one)
         options%frames => frames
         call solve_history(model, options, reporter, history, status, store, observer=observations)
         associate (n => size(history%frames))
            if (n > 0) call agree_on_outcome(status, history%frames(n), history%ending%is_early)
            if (is_ok(status)) then
               associate (last => history%frames(n))
                  list = [pair_quantities(summarise_pair(last%contact(1)), scales_t()), step_quantities(last)]
               end associate
               do i = 1, size(values)
                  do m = 1, size(list)
                     if (list(m)%name == study%quantities(i)%name) values(i) = list(m)%value
                  end do
               end do
            end if
         end associate
         call end_frames(frames)
      end if
      call clear_messages()
   end subroutine find_probe

   !> Whether a run has no solution, not even a last iterate.
   pure logical function has_failed(row)
      type(study_row_t), intent(in) :: row          !< of a run that was made

      has_failed = row%code /= STATUS_OK .and. row%code /= STATUS_NOT_CONVERGED
   end function has_failed

   !> Adds what was found in a run, for another rank. What has a fixed size goes as it lies in memory, so that no component is
   !> forgotten. Element and level stay.
   subroutine put_row(row, buffer)
      type(study_row_t), intent(in) :: row          !< with values and phases
      type(buffer_t), intent(inout) :: buffer       !< gets the items

      call put(buffer, transfer(row%run_facts_t, [0_ip]))
      call put(buffer, row%code)
      call put(buffer, [row%estimate, row%bound, row%penetration, row%pressure])
      call put(buffer, row%values)
      call put(buffer, size(row%phases, kind=ip))
      call put(buffer, transfer(row%phases, [0_ip]))
   end subroutine put_row

   !> The next items, a row.
   subroutine take_row(buffer, row)
      type(buffer_t), intent(inout) :: buffer       !< its next items are taken
      type(study_row_t), intent(inout) :: row       !< element and level are set; gets the rest
      integer(ip), allocatable :: memory(:)
      real(wp), allocatable :: amounts(:)
      integer(ip) :: n

      call take(buffer, memory)
      row%run_facts_t = transfer(memory, row%run_facts_t)
      call take(buffer, row%code)
      call take(buffer, amounts)
      row%estimate = amounts(1)
      row%bound = amounts(2)
      row%penetration = amounts(3)
      row%pressure = amounts(4)
      call take(buffer, row%values)
      call take(buffer, n)
      call take(buffer, memory)
      row%phases = transfer(memory, [phase_time_t()], n)
   end subroutine take_row

   !> One run of a study, with its own deck and mesh, and what its row keeps of it. status: as of read_summary.
   subroutine make_run(command, study, row, status)
      type(command_t), intent(in) :: command        !< of the study
      type(study_t), intent(in) :: study            !< its quantities are read
      type(study_row_t), intent(inout) :: row       !< element and level are given
      type(status_t), intent(out) :: status         !< STATUS_OK or STATUS_FILE
      type(command_t) :: one
      type(body_cache_t) :: store
      type(run_facts_t) :: facts
      type(sweep_run_t) :: run
      real(wp) :: nan
      integer :: i, code

      call make_command(command, row, one)
      call clear_messages()
      call reset_timers()
      call run_deck(one, store, code, facts)
      row%code = int(code, ip)
      row%run_facts_t = facts
      row%phases = get_phases()
      run%code = code
      run%is_written = facts%is_whole                ! values of another time are no values of the study
      call read_summary(one%folder, run, status)
      nan = ieee_value(1.0_wp, ieee_quiet_nan)
      row%values = [(summary_value(run%summary, study%quantities(i)%name, nan), i=1, size(study%quantities))]
      row%estimate = summary_value(run%summary, 'error_estimate_percent', nan)
      row%bound = summary_value(run%summary, 'error_bound_percent', -1.0_wp)
      row%penetration = summary_value(run%summary, 'max_penetration', 0.0_wp)
      row%pressure = summary_value(run%summary, 'max_pressure', 0.0_wp)
   end subroutine make_run

   !> The command of one run.
   pure subroutine make_command(command, row, one)
      type(command_t), intent(in) :: command        !< of the study
      type(study_row_t), intent(in) :: row          !< element, level and is_adapted are read
      type(command_t), intent(out) :: one           !< quiet, without pictures, with a folder of its own

      one = command
      one%on_one_rank = .true.
      one%quiet = .true.
      one%plot = .false.
      one%report = .false.
      one%refine = command%refine + row%level
      one%adapt = 0.0_wp
      if (row%is_adapted) then
         one%refine = command%refine
         ! that of the command on the last level, twice as much on each one before it
         one%adapt = min(100.0_wp, command%adapt*2.0_wp**(command%levels - 1 - row%level))
      else if (row%element /= DECK_ELEMENTS) then
         one%element = row%element
      end if
      one%shape = 0                                 ! those of the deck
      one%state = 0
      if (len_trim(one%element) > 0) then
         associate (kind => KINDS(kind_named(upper_case(trim(one%element)))))
            one%shape = kind%shape
            one%state = kind%state
         end associate
      end if
      one%folder = output_folder(command)//'/'//row%element//'_'//to_text(row%level)
   end subroutine make_command

   !> status: STATUS_USAGE of a reference that means nothing.
   subroutine plan_study(asked, command, study, status)
      type(command_t), intent(in) :: asked          !< as the user gave it
      type(command_t), intent(out) :: command       !< of all runs
      type(study_t), intent(out) :: study           !< with quantities and rows
      type(status_t), intent(out) :: status         !< STATUS_OK or STATUS_USAGE
      integer(ip) :: k

      command = asked
      ! one solver on all levels: another one from some level on would put a step into the times
      if (command%solver == 'auto') command%solver = 'sparse'
      call choose_quantities(command, study, status)
      if (.not. is_ok(status)) return
      study%elements = command%elements
      if (size(study%elements) == 0) call append_string(study%elements, DECK_ELEMENTS)
      if (command%adapt > 0.0_wp) call append_string(study%elements, ADAPTED)
      allocate (study%rows(size(study%elements)*command%levels))
      do k = 1, size(study%rows, kind=ip)            ! every element at every level
         study%rows(k)%level = mod(k - 1, command%levels)
         study%rows(k)%element = study%elements((k - 1)/command%levels + 1)%s
         study%rows(k)%is_adapted = study%rows(k)%element == ADAPTED
      end do
   end subroutine plan_study

   !> --reference QUANTITY[=VALUE]; without any the energy and the resultants of the first pair. What is observed is studied in any
   !> case.
   subroutine choose_quantities(command, study, status)
      type(command_t), intent(in) :: command
      type(study_t), intent(inout) :: study
      type(status_t), intent(out) :: status
      type(string_t), allocatable :: list(:), observed(:)
      integer :: i, equals, outcome

      call find_observed(command, observed)
      call list_references(list)
      allocate (study%quantities(size(list)))
      do i = 1, size(list)
         associate (quantity => study%quantities(i))
            equals = index(list(i)%s, '=')
            quantity%name = observation_name(list(i)%s)
            call check_name(quantity%name)
            if (.not. is_ok(status)) return
            if (equals == 0) cycle
            quantity%is_given = .true.
            quantity%source = 'given'
            call read_real(list(i)%s(equals + 1:), quantity%reference, outcome)
            if (outcome == NUMBER_OK) cycle
            call set_status(status, STATUS_USAGE, '--reference '//list(i)%s//': QUANTITY=VALUE with a number is expected')
            return
         end associate
      end do

   contains

      !> The references, then what is observed and not among them; without any reference the energy and the resultants last.
      subroutine list_references(list)
         type(string_t), allocatable, intent(out) :: list(:)
         integer :: i, k

         list = command%references
         do i = 1, size(observed)
            do k = 1, size(command%references)
               if (observation_name(command%references(k)%s) == observed(i)%s) exit
            end do
            if (k > size(command%references)) call append_string(list, observed(i)%s)
         end do
         if (size(command%references) > 0) return
         call append_string(list, 'strain_energy')
         call append_string(list, 'normal_resultant')
      end subroutine list_references

      subroutine check_name(name)
         character(len=*), intent(in) :: name
         type(string_t), allocatable :: names(:), near(:)
         character(len=:), allocatable :: text
         integer :: i

         names = quantity_names()
         do i = 1, size(observed)
            call append_string(names, observed(i)%s)
         end do
         do i = 1, size(names)
            if (names(i)%s == name) return
         end do
         text = '--reference '//name//': summary.tab has no such quantity'
         near = nearest_names(name, names, 3)
         if (size(near) > 0) text = text//'; nearest: '//join(near, ', ')
         call set_status(status, STATUS_USAGE, text)
      end subroutine check_name
   end subroutine choose_quantities

end module atrito_study_runs
