!> `atrito study`: one deck at several levels of refinement and with several elements; error against run time.
module atrito_study
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_body_cache, only: body_cache_t
   use atrito_command_line, only: command_t, output_folder
   use atrito_console, only: print_status
   use atrito_element_table, only: KINDS, kind_named
   use atrito_folder_claim, only: folder_claim_t, release_folder
   use atrito_history, only: solve_history
   use atrito_kinds, only: ip, wp
   use atrito_messages, only: clear_messages
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_observations, only: observation_names, observations_t
   use atrito_page, only: page_t
   use atrito_read_table, only: table_file_t, find_column
   use atrito_provenance, only: provenance_t
   use atrito_report, only: report_t
   use atrito_report_maker, only: make_report
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_run, only: run_deck, load_model, prepare_observations, solve_options, agree_on_outcome
   use atrito_series_reports, only: begin_series, take_heading, report_of_study
   use atrito_series, only: claim_output, find_provenance, series_origin, begin_pictures, tell_series
   use atrito_status, only: status_t, set_status, is_ok, STATUS_OK, STATUS_USAGE, STATUS_NOT_CONVERGED
   use atrito_strings, only: string_t, append_string, join, nearest_names, to_text, upper_case
   use atrito_summary, only: quantity_t, scales_t, quantity_names, pair_quantities, step_quantities, summarise_pair
   use atrito_study_errors, only: run_facts_t, study_t, study_row_t, study_probe_t, total_seconds, PROCESSOR
   use atrito_study_plot, only: write_study_plot
   use atrito_model, only: model_t, interaction_t
   use atrito_results, only: history_t, results_t
   use atrito_study_table, only: write_study, compose_study
   use atrito_study_words, only: judge_study
   use atrito_sweep_tables, only: sweep_run_t, read_summary, row_of_quantity
   use atrito_table, only: origin_t
   use atrito_timers, only: phase_time_t, reset_timers, get_phases
   implicit none (type, external)
   private
   public :: run_study

   character(len=*), parameter :: DECK_ELEMENTS = 'deck'   !< instead of a kind of element: as in the deck
   real(wp), parameter :: SHORT = 0.1_wp             !< [s] shorter runs are made three times, for the clock
   integer, parameter :: REPEATS = 2                 !< times that a short run is made again
   integer(ip), parameter :: COARSER = 2             !< levels from the finest one to the one at which regularisations are probed

contains

   !> Makes all runs; code is the worst of theirs.
   subroutine run_study(asked, code)
      type(command_t), intent(in) :: asked
      integer, intent(out) :: code                  !< one of STATUS_*
      type(command_t) :: command
      type(study_t) :: study
      type(status_t) :: status
      type(folder_claim_t) :: claim

      command = asked
      ! one solver on all levels: another one from some level on would put a step into the times
      if (command%solver == 'auto') command%solver = 'sparse'
      call choose_quantities(command, study, status)
      call claim_output(command, claim, status)
      code = status%code
      if (.not. is_ok(status)) return
      call make_runs(command, study, code)
      call release_folder(claim)
   end subroutine run_study

   !> The runs and what is made of them.
   subroutine make_runs(command, study, code)
      type(command_t), intent(in) :: command
      type(study_t), intent(inout) :: study
      integer, intent(out) :: code
      type(status_t) :: status
      type(reporter_t) :: reporter
      type(provenance_t) :: provenance
      integer :: k

      reporter%quiet = command%quiet .or. command%json
      call find_provenance(command, provenance)
      call list_runs(command, study)
      code = STATUS_OK
      do k = 1, size(study%rows)
         associate (row => study%rows(k))
            call report_progress(reporter, 'run '//to_text(int(k, ip))//' of '//to_text(size(study%rows, kind=ip))//'  ' &
                                 //row%element//', level '//to_text(row%level))
            call make_run(command, study, row, status)
            if (is_ok(status) .and. .not. has_failed(row)) call time_again(command, study, row, k == 1, status)
            code = max(code, status%code, int(row%code))
            ! a fault of the command line or the deck is the same at every level
            if (.not. is_ok(status) .or. row%code == STATUS_USAGE .or. (k == 1 .and. has_failed(row))) exit
         end associate
      end do
      if (is_ok(status) .and. k > size(study%rows)) then
         call make_probes(command, study, reporter)
         call finish(command, provenance, study, status)
      end if
      if (.not. is_ok(status)) call print_status(status, command%names(1)%s, command%json)
      code = max(code, status%code)
   end subroutine make_runs

   !> Makes a short run again and keeps the times of the fastest; the first run of a process pays for loading it, and is made
   !> again however long it takes.
   subroutine time_again(command, study, row, is_first, status)
      type(command_t), intent(in) :: command
      type(study_t), intent(in) :: study
      type(study_row_t), intent(inout) :: row
      logical, intent(in) :: is_first
      type(status_t), intent(out) :: status
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

   !> What half of delta and half of eps do to the quantities, at a level of the last element that costs little.
   subroutine make_probes(command, study, reporter)
      type(command_t), intent(in) :: command
      type(study_t), intent(inout) :: study
      type(reporter_t), intent(in) :: reporter
      integer :: k

      k = size(study%rows) - int(min(COARSER, command%levels - 1_ip))
      allocate (study%probes(0))
      associate (row => study%rows(k))
         if (row%code /= STATUS_OK) return
         if (row%has_delta .or. row%has_eps .or. row%has_stick_slope) call report_progress(reporter, 'half of delta, half of eps')
         if (row%has_delta) call add_probe(command, 'half the delta', .true., k, study)
         if (row%has_eps) call add_probe(command, 'half the eps', .false., k, study)
         if (row%has_stick_slope .and. .not. row%has_eps) call add_probe(command, 'twice the stick slope', .false., k, study)
      end associate
   end subroutine make_probes

   !> A run once more, of which nothing is written, with half of a regularisation, or half the compliance of the stick slope.
   subroutine add_probe(command, what, is_penalty, k, study)
      type(command_t), intent(in) :: command
      character(len=*), intent(in) :: what
      logical, intent(in) :: is_penalty
      integer, intent(in) :: k                      !< row
      type(study_t), intent(inout) :: study
      type(study_probe_t) :: probe
      type(command_t) :: one
      type(body_cache_t) :: store
      type(model_t) :: model
      type(history_t) :: history
      type(observations_t) :: observations
      type(reporter_t) :: reporter
      type(status_t) :: status
      integer(ip) :: told
      integer :: code

      probe = study_probe_t(what, is_penalty, k)
      allocate (probe%values(size(study%quantities)), source=ieee_value(1.0_wp, ieee_quiet_nan))
      reporter%quiet = .true.
      call make_command(command, study%rows(k), one)
      call clear_messages()
      call load_model(one, reporter, model, told, code)
      if (code == STATUS_OK) call prepare_observations(one, model, observations, code)
      if (code == STATUS_OK) then
         call scale_laws(model%interactions, merge(0.5_wp, 1.0_wp, is_penalty), merge(1.0_wp, 0.5_wp, is_penalty))
         call solve_history(model, solve_options(one), reporter, history, status, store, observer=observations)
         associate (n => size(history%frames))
            if (n > 0) call agree_on_outcome(status, history%frames(n), history%ending%is_early)
            if (is_ok(status)) call find_values(history%frames(n), study, probe%values)
         end associate
      end if
      call clear_messages()
      study%probes = [study%probes, probe]
   end subroutine add_probe

   !> Every element at every level.
   pure subroutine list_runs(command, study)
      type(command_t), intent(in) :: command
      type(study_t), intent(inout) :: study
      integer(ip) :: i, k

      study%elements = command%elements
      if (size(study%elements) == 0) study%elements = [string_t(DECK_ELEMENTS)]
      allocate (study%rows(size(study%elements)*command%levels))
      do k = 1, size(study%rows, kind=ip)
         i = (k - 1)/command%levels + 1
         study%rows(k)%level = k - 1 - (i - 1)*command%levels
         study%rows(k)%element = study%elements(i)%s
      end do
   end subroutine list_runs

   pure logical function has_failed(row)
      type(study_row_t), intent(in) :: row

      has_failed = row%code /= STATUS_OK .and. row%code /= STATUS_NOT_CONVERGED
   end function has_failed

   !> --reference QUANTITY[=VALUE]; without any the energy and the resultants of the first pair. What is observed is studied in any
   !> case.
   subroutine choose_quantities(command, study, status)
      type(command_t), intent(in) :: command
      type(study_t), intent(inout) :: study
      type(status_t), intent(out) :: status
      type(string_t), allocatable :: list(:)
      integer :: i, equals, outcome

      call list_references(command, list)
      allocate (study%quantities(size(list)))
      do i = 1, size(list)
         associate (quantity => study%quantities(i))
            equals = index(list(i)%s, '=')
            quantity%name = quantity_of(list(i)%s)
            call check_name(quantity%name, observation_names(command%observe), status)
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
   end subroutine choose_quantities

   !> The references, then what is observed and not among them; without any reference the energy and the resultants last.
   subroutine list_references(command, list)
      type(command_t), intent(in) :: command
      type(string_t), allocatable, intent(out) :: list(:)
      type(string_t), allocatable :: observed(:)
      integer :: i, k

      list = command%references
      observed = observation_names(command%observe)
      do i = 1, size(observed)
         do k = 1, size(command%references)
            if (quantity_of(command%references(k)%s) == observed(i)%s) exit
         end do
         if (k > size(command%references)) call append_string(list, observed(i)%s)
      end do
      if (size(command%references) > 0) return
      call append_string(list, 'strain_energy')
      call append_string(list, 'normal_resultant')
   end subroutine list_references

   !> QUANTITY of `QUANTITY=VALUE` or of itself.
   pure function quantity_of(reference) result(name)
      character(len=*), intent(in) :: reference
      character(len=:), allocatable :: name

      name = reference
      if (index(reference, '=') > 0) name = reference(:index(reference, '=') - 1)
   end function quantity_of

   subroutine check_name(name, observed, status)
      character(len=*), intent(in) :: name
      type(string_t), intent(in) :: observed(:)     !< names of --observe
      type(status_t), intent(inout) :: status
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

   subroutine make_run(command, study, row, status)
      type(command_t), intent(in) :: command
      type(study_t), intent(in) :: study
      type(study_row_t), intent(inout) :: row       !< element and level are given
      type(status_t), intent(out) :: status
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
      row%values = [(amount(run%summary, study%quantities(i)%name, nan), i=1, size(study%quantities))]
      row%estimate = amount(run%summary, 'error_estimate_percent', nan)
      row%penetration = amount(run%summary, 'max_penetration', 0.0_wp)
      row%pressure = amount(run%summary, 'max_pressure', 0.0_wp)
   end subroutine make_run

   !> The command of one run.
   pure subroutine make_command(command, row, one)
      type(command_t), intent(in) :: command
      type(study_row_t), intent(in) :: row
      type(command_t), intent(out) :: one

      one = command
      one%quiet = .true.
      one%plot = .false.
      one%report = .false.
      one%refine = command%refine + row%level
      if (row%element /= DECK_ELEMENTS) one%element = row%element
      one%shape = shape_of(one%element)
      one%state = state_of(one%element)
      one%folder = output_folder(command)//'/'//row%element//'_'//to_text(row%level)
   end subroutine make_command

   !> 0: the deck's own.
   pure integer(ip) function shape_of(element)
      character(len=*), intent(in) :: element

      shape_of = 0
      if (len_trim(element) > 0) shape_of = KINDS(kind_named(upper_case(trim(element))))%shape
   end function shape_of

   !> The same of the state.
   pure integer(ip) function state_of(element)
      character(len=*), intent(in) :: element

      state_of = 0
      if (len_trim(element) > 0) state_of = KINDS(kind_named(upper_case(trim(element))))%state
   end function state_of

   !> A quantity of the first pair, or of the step; `missing` where the summary has none.
   pure real(wp) function amount(summary, name, missing)
      type(table_file_t), intent(in) :: summary
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: missing
      integer(ip) :: row

      row = row_of_quantity(summary, name)
      amount = missing
      if (row > 0) amount = summary%value(find_column(summary, 'value'), row)
   end function amount

   subroutine finish(command, provenance, study, status)
      type(command_t), intent(in) :: command
      type(provenance_t), intent(in) :: provenance
      type(study_t), intent(inout) :: study
      type(status_t), intent(out) :: status
      type(origin_t) :: origin
      type(page_t) :: page
      type(report_t) :: report
      type(command_t) :: one
      type(string_t), allocatable :: drawn(:)
      logical :: has_report
      character(len=:), allocatable :: title       !< the deck and what --set changed of it

      study%rounding = max(study%rounding, 10.0_wp**(1 - command%digits))
      call judge_study(study)
      origin = series_origin(command, provenance, any(study%rows%code == STATUS_NOT_CONVERGED))
      call write_study(output_folder(command), origin, study, int(command%digits), status, command%is_csv)
      if (.not. is_ok(status)) return
      call begin_pictures(command)
      title = origin%deck
      if (size(command%settings) > 0) title = title//', '//join(command%settings, ', ')
      if (command%plot) call write_study_plot(output_folder(command), title, study, drawn)
      call compose_study(command%names(1)%s, output_folder(command), study, page)
      has_report = .false.
      if (command%report) then
         call begin_series('study', command%names(1)%s, output_folder(command), ['study'], drawn, report)
         call make_command(command, study%rows(1), one)
         call take_heading(one%folder, report)
         call report_of_study(study, report)
         call make_report(command, report, has_report)
      end if
      call tell_series(command, page, has_report)
   end subroutine finish

   pure elemental subroutine scale_laws(law, delta_factor, eps_factor)
      type(interaction_t), intent(inout) :: law
      real(wp), intent(in) :: delta_factor, eps_factor

      law%delta = delta_factor*law%delta
      law%eps = eps_factor*law%eps
      law%stick_slope = law%stick_slope/eps_factor
   end subroutine scale_laws

   pure subroutine find_values(results, study, values)
      type(results_t), intent(in) :: results
      type(study_t), intent(in) :: study
      real(wp), intent(inout) :: values(:)
      type(quantity_t), allocatable :: list(:)
      integer :: i, k

      list = [pair_quantities(summarise_pair(results%contact(1)), scales_t()), step_quantities(results)]
      do i = 1, size(values)
         do k = 1, size(list)
            if (list(k)%name == study%quantities(i)%name) values(i) = list(k)%value
         end do
      end do
   end subroutine find_values

end module atrito_study
