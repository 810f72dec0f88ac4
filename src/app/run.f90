!> One run: read the deck, build the model, solve, write.
module atrito_run
   use, intrinsic :: iso_fortran_env, only: output_unit
   use atrito_adaptation, only: adaptation_t, adaptation_text, begin_adaptation, build_adaptation, follow_error, missed_text
   use atrito_as_run_names, only: as_run_name
   use atrito_body_cache, only: body_cache_t
   use atrito_build_model, only: build_model
   use atrito_build_requests, only: refuse_field_files
   use atrito_build_trees, only: card_of_trees
   use atrito_command_line, only: command_t, output_folder, TASK_RUN
   use atrito_console, only: print_message, print_messages, print_status, reporter_of
   use atrito_deck, only: deck_t
   use atrito_deck_as_run, only: take_deck_as_run
   use atrito_element_table, only: DEGREE_OF, KINDS, kind_named
   use atrito_files, only: check_folder, check_all_own, check_length, check_own, forget_inputs, is_folder, protect_input
   use atrito_folder_claim, only: folder_claim_t, claim_folder, release_folder
   use atrito_frame_spool, only: begin_frames, end_frames, frame_spool_t
   use atrito_given_options, only: options_of_run
   use atrito_hdf5, only: has_hdf5
   use atrito_history, only: solve_history
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: signed_area
   use atrito_messages, only: message_t, clear_messages, count_messages, sort_messages, SEVERITY_ERROR
   use atrito_model, only: model_t
   use atrito_observations, only: observations_t, read_observations
   use atrito_older_results, only: note_older_results
   use atrito_option_table, only: place_of_word
   use atrito_page, only: page_t, add_above_rule, print_page
   use atrito_parameter_text, only: list_parameters
   use atrito_patched_text, only: digest_of_texts
   use atrito_plane_state, only: FULL_STATE
   use atrito_plot_files, only: plot_folder, solution_folder, list_plots, PLOTS_OF_RUN
   use atrito_reader, only: read_deck
   use atrito_report_maker, only: make_run_report
   use atrito_rank_distribution, only: distribute_over_ranks
   use atrito_reporter, only: reporter_t, report_phase
   use atrito_restart_file, only: restart_name
   use atrito_restart_recorder, only: restart_recorder_t, begin_recorder
   use atrito_results, only: history_t, results_t, last_frame
   use atrito_screen, only: compose_summary
   use atrito_show, only: begin_show, show_t
   use atrito_show_plots, only: draw_shown
   use atrito_solve, only: solve_options_t, PROOF_AUTO, PROOF_OFF, PROOF_ON, CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE, &
                           SOLVER_AUTO, SOLVER_SKYLINE, &
                           SOLVER_BANDED, SOLVER_SPARSE
   use atrito_status, only: status_t, set_status, reword_status, is_ok, STATUS_OK, STATUS_USAGE, STATUS_DECK, STATUS_NOT_CONVERGED
   use atrito_strings, only: string_t, upper_case
   use atrito_study_errors, only: run_facts_t
   use atrito_system, only: address_space_limit
   use atrito_table, only: table_t
   use atrito_threads, only: lent_threads, set_threads
   use atrito_timers, only: start_phase, stop_phase
   use atrito_write_plots, only: write_plots, plot_names
   use atrito_write_results, only: write_results, remove_results, list_files_of_run
   implicit none (type, external)
   private
   public :: run_deck, take_threads, load_model, read_model, prepare_observations, solve_options, agree_on_outcome

contains

   !> Solves a deck and writes its tables. What it reads is protected for so long.
   subroutine run_deck(command, store, code, facts)
      type(command_t), intent(in) :: command
      type(body_cache_t), intent(inout) :: store    !< bodies of an earlier run; those of this one
      integer, intent(out) :: code                  !< one of STATUS_*
      type(run_facts_t), intent(out), optional :: facts
      type(reporter_t) :: reporter
      type(model_t) :: model
      type(observations_t) :: observations
      type(restart_recorder_t) :: recorder
      type(frame_spool_t), target :: frames
      type(show_t), target :: show
      type(adaptation_t) :: adaptation
      type(status_t) :: status
      integer(ip) :: n_printed

      call begin_adaptation(command, adaptation)
      call forget_inputs()
      call take_threads(command)                    ! the other ranks have nothing to do yet
      reporter = reporter_of(command)
      call load_model(command, reporter, model, n_printed, code, keeps_deck=.true., adaptation=adaptation)
      if (code == STATUS_OK) call prepare_observations(command, model, observations, code)
      if (code == STATUS_OK) then
         call check_adaptable(command, model, status)
         if (is_ok(status)) call check_folder(output_folder(command), status)
         call begin_frames(output_folder(command), frames)
         if (is_ok(status)) call begin_recorder(command, model, recorder, frames, status)
         if (is_ok(status)) call check_files(command, model, status)
         code = status%code
         if (is_ok(status)) then
            call set_threads(command%threads)
            call solve_and_write()
         else                                       ! better now than after an hour
            call print_status(status, model%deck_path, command%json)
         end if
         call end_frames(frames)
      end if
      call forget_inputs()

   contains

      subroutine solve_and_write()
         type(history_t), target :: history
         type(solve_options_t) :: options

         options = solve_options(command)
         if (allocated(command%show)) then
            call begin_show(command%show, show)
            if (size(command%show) > 0) options%viewer => show
         end if
         do
            call solve_history(model, options, reporter, history, status, store, recorder, observations, frames)
            if (.not. has_next_mesh(history)) exit
         end do
         if (last_frame(history) == 0) call note_older_results(output_folder(command), model%deck_path, model%provenance)
         call print_messages(command%quiet, n_printed + 1, command%json)
         associate (n => last_frame(history))
            if (n > 0) call agree_on_outcome(status, history%frames(n), history%ending%is_early)
            if (is_ok(status) .and. allocated(adaptation%why)) call set_status(status, STATUS_NOT_CONVERGED, &
                                                                               missed_text(adaptation))
            code = status%code
            if (n == 0 .and. .not. command%quiet) call print_page(show%page, output_unit)
            if (n > 0) then
               call take_threads(command)           ! the other ranks have nothing more to do
               call write_run(command, reporter, model, history, show, adaptation, code)
            end if
            if (.not. is_ok(status)) call print_status(status, model%deck_path, command%json)
            if (n == 0) return
            if (.not. present(facts)) return
            facts = facts_of(model, history%frames(n))
            facts%is_written = code == status%code      ! else they could not be
            facts%is_whole = facts%is_written .and. .not. history%ending%is_early
         end associate
      end subroutine solve_and_write

      !> Whether the error asks for another mesh; the model is that of the next one then.
      logical function has_next_mesh(history) result(has)
         type(history_t), intent(in), target :: history
         type(reporter_t) :: silent

         has = adaptation%target > 0.0_wp .and. is_ok(status) .and. last_frame(history) > 0
         if (has) has = all(history%frames%converged .and. history%frames%law_holds)
         if (has) call follow_error(model, history, adaptation, has)
         if (.not. has) return
         call end_frames(frames)
         call begin_frames(output_folder(command), frames)
         call report_phase(reporter, 'adapt '//adaptation_text(adaptation))
         silent%quiet = .true.
         call forget_inputs()                       ! as before the first
         call clear_messages()                      ! what is said is of the last mesh
         call load_model(command, silent, model, n_printed, code, only_errors=.true., keeps_deck=.true., adaptation=adaptation)
         has = code == STATUS_OK
         if (has) call prepare_observations(command, model, observations, code)
      end function has_next_mesh

   end subroutine run_deck

   !> --adapt begins anew with each mesh: there is nothing to go on from. status: STATUS_USAGE.
   subroutine check_adaptable(command, model, status)
      type(command_t), intent(in) :: command
      type(model_t), intent(in) :: model
      type(status_t), intent(out) :: status

      if (command%adapt > 0.0_wp .and. (model%restart_every > 0 .or. allocated(command%restart))) then
         call set_status(status, STATUS_USAGE, '--adapt: each mesh begins anew, without *RESTART and --restart')
      end if
   end subroutine check_adaptable

   !> The threads of this run, with those of ranks that wait on the same host: not where `ulimit -v` counts what each reserves.
   subroutine take_threads(command)
      type(command_t), intent(in) :: command
      logical :: is_alone

      is_alone = command%on_one_rank .or. address_space_limit() >= 0
      call set_threads(lent_threads(command%threads, merge(1_ip, command%n_on_host, is_alone)))
   end subroutine take_threads

   pure type(run_facts_t) function facts_of(model, results) result(facts)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      real(wp) :: area
      integer(ip) :: e
      integer :: i

      facts%n_dofs = results%scene%n_dofs
      facts%n_points = sum(results%scene%pairs%n_points)
      area = 0.0_wp
      do e = 1, model%mesh%n_elements
         area = area + signed_area(model%mesh, e)
      end do
      facts%h = sqrt(area/real(model%mesh%n_elements, wp))
      associate (degree => DEGREE_OF(model%mesh%shape))
         if (all(degree == degree(1))) facts%degree = degree(1)
      end associate
      if (size(model%pairs) == 0) return
      do i = 1, size(model%pairs)
         associate (law => model%interactions(model%pairs(i)%interaction))
            facts%has_delta = facts%has_delta .or. law%delta > 0.0_wp
            facts%has_eps = facts%has_eps .or. (law%nu > 0.0_wp .and. law%eps > 0.0_wp)
            facts%has_stick_slope = facts%has_stick_slope .or. (law%nu > 0.0_wp .and. law%stick_slope > 0.0_wp)
         end associate
      end do
      associate (contact => results%contact(1))
         if (contact%n == 0) return
         i = maxloc(contact%pressure(:contact%n), dim=1)
         facts%peak = contact%x(:, i)
         facts%peak_is_end = i == 1 .or. i == contact%n
      end associate
   end function facts_of

   !> Tables and listing of each other solution, in a folder of its own below that of the run; those of an earlier run go.
   subroutine write_others(command, model, history, folder, status)
      type(command_t), intent(in) :: command
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      character(len=*), intent(in) :: folder
      type(status_t), intent(inout) :: status
      type(history_t) :: other
      type(string_t), allocatable :: written(:), pictures(:)
      integer(ip) :: k, n

      n = 0
      if (allocated(history%others)) n = size(history%others, kind=ip)
      allocate (other%rows(0), other%frames(1))
      do k = 1, n
         other%frames(1) = history%others(k)
         other%iterations = history%others(k)%iterations
         if (.not. is_ok(status)) exit
         if (command%plot) pictures = plot_names(model, other)
         call write_results(model, other, int(command%digits), solution_folder(folder, k + 1), written, status, pictures, &
                            command%is_csv)
         if (command%plot .and. is_ok(status)) then
            call write_plots(model, other, solution_folder(folder, k + 1), command%view, pictures)
         end if
      end do
      k = n + 2
      do while (is_ok(status) .and. is_folder(solution_folder(folder, k)))
         call remove_results(model, solution_folder(folder, k), status)
         k = k + 1
      end do
   end subroutine write_others

   !> The status and the results say the same of a run: solved, or not converged and why. A history that ended early keeps its
   !> status.
   subroutine agree_on_outcome(status, results, ends_early)
      type(status_t), intent(inout) :: status
      type(results_t), intent(inout) :: results     !< the last there are
      logical, intent(in) :: ends_early
      character(len=:), allocatable :: text

      if (ends_early) then
         if (allocated(status%text)) call reword_status(status, status%text//'; what converged before is written')
         return
      end if
      if (is_ok(status) .and. results%converged .and. results%law_holds) return
      text = 'not converged'
      if (allocated(results%verdict)) text = results%verdict
      if (.not. is_ok(status)) then
         if (allocated(status%text)) text = status%text
         results%law_holds = .false.
      end if
      if (.not. allocated(results%verdict)) results%verdict = text
      call set_status(status, STATUS_NOT_CONVERGED, text//'; the last iterate is written')
   end subroutine agree_on_outcome

   subroutine write_run(command, reporter, model, history, show, adaptation, code)
      type(command_t), intent(in) :: command
      type(reporter_t), intent(in) :: reporter
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      type(show_t), intent(in) :: show              !< what --show has seen
      type(adaptation_t), intent(in) :: adaptation
      integer, intent(inout) :: code
      type(status_t) :: status
      type(folder_claim_t) :: claim
      type(page_t) :: page
      type(string_t), allocatable :: written(:), pictures(:), drawn(:)
      type(table_t), allocatable :: shown(:)
      character(len=:), allocatable :: folder
      integer(ip) :: n_printed
      integer :: n_shown

      n_shown = 0
      if (allocated(show%tables)) n_shown = size(show%tables)
      allocate (shown(n_shown + merge(1, 0, adaptation%target > 0.0_wp)))
      if (n_shown > 0) shown(:n_shown) = show%tables
      if (size(shown) > n_shown) call build_adaptation(adaptation, shown(n_shown + 1))
      folder = output_folder(command)
      call report_phase(reporter, 'write '//folder)
      n_printed = count_messages()
      ! not allocated: an optional argument that is not there
      if (command%plot) pictures = plot_names(model, history)
      call claim_folder(folder, claim, status, silent=command%json)
      if (is_ok(status)) call check_files(command, model, status)    ! an hour may have passed
      if (is_ok(status)) call write_results(model, history, int(command%digits), folder, written, status, pictures, &
                                            command%is_csv, shown)
      if (.not. is_ok(status)) then
         call release_folder(claim)
         call print_status(status, model%deck_path, command%json)
         code = status%code
         return
      end if
      if (command%plot) then
         call report_phase(reporter, 'plot  '//plot_folder(folder))
         call write_plots(model, history, folder, command%view, pictures)
         if (size(shown) > 0) then
            call draw_shown(folder, shown, drawn)
            pictures = [pictures, drawn]
         end if
      end if
      if (command%report) call make_run_report(command, model, history, written, pictures)
      call write_others(command, model, history, folder, status)
      call release_folder(claim)
      call print_messages(command%quiet, n_printed + 1, command%json)
      if (.not. is_ok(status)) then
         call print_status(status, model%deck_path, command%json)
         code = status%code
      end if
      if (command%quiet) return
      call compose_summary(model, history, folder, written, page, pictures)
      if (adaptation%target > 0.0_wp) call add_above_rule(page, 'adapted', adaptation_text(adaptation))
      call print_page(page, output_unit)
      call print_page(show%page, output_unit)
   end subroutine write_run

   !> Reads a deck and builds its model. All messages are printed; errors of the deck give STATUS_DECK.
   subroutine load_model(command, reporter, model, n_printed, code, only_errors, keeps_deck, adaptation)
      type(command_t), intent(in) :: command
      type(reporter_t), intent(in) :: reporter
      type(model_t), intent(out) :: model
      integer(ip), intent(out) :: n_printed         !< messages printed so far
      integer, intent(out) :: code
      logical, intent(in), optional :: only_errors  !< the others of this deck have been printed
      logical, intent(in), optional :: keeps_deck   !< as it is run, in the model; left out: .false.
      type(adaptation_t), intent(inout), optional :: adaptation !< how the elements of the deck are cut, where they are
      type(deck_t) :: deck
      type(status_t) :: status
      logical :: silent

      call report_phase(reporter, 'read  '//command%names(1)%s)
      call start_phase('read')
      call read_deck(command%names(1)%s, command%settings, deck, status)
      call stop_phase('read')
      n_printed = 0
      code = STATUS_DECK
      if (is_ok(status) .or. status%code == STATUS_DECK) then
         call start_phase('mesh')
         if (command%adapt > 0.0_wp .and. present(adaptation)) then
            call build_model(deck, model, command%refine, trees=adaptation%trees)
         else
            call build_model(deck, model, command%refine, shape=command%shape, state=command%state)
         end if
         if (.not. has_hdf5()) call refuse_field_files(deck)
         call stop_phase('mesh')
         call list_parameters(deck, [string_t ::], model%provenance%parameters)
         call options_of_run(command, model%provenance%options)
         call sort_messages()
         if (present(keeps_deck) .and. count_messages(SEVERITY_ERROR) > 0) call note_older_results(output_folder(command), &
                                                                                               command%names(1)%s, model%provenance)
         silent = .false.
         if (present(only_errors)) silent = only_errors .and. count_messages(SEVERITY_ERROR) == 0
         if (.not. silent) call print_messages(command%quiet, 1_ip, command%json)
         n_printed = count_messages()
         if (count_messages(SEVERITY_ERROR) > 0) return
         if (is_ok(status) .and. .not. has_state(model, command%element)) then
            call set_status(status, STATUS_USAGE, '--elements '//trim(command%element)// &
                            ': the deck has elements of the other plane state')
         end if
      end if
      if (present(keeps_deck) .and. is_ok(status)) call keep_deck(deck, model, status, adaptation)
      code = status%code
      if (.not. is_ok(status)) call print_status(status, command%names(1)%s, command%json)
   end subroutine load_model

   !> The model of a command of which nothing is printed. ok: its deck has no errors.
   subroutine read_model(command, model, ok)
      type(command_t), intent(in) :: command
      type(model_t), intent(out) :: model
      logical, intent(out) :: ok
      type(deck_t) :: deck
      type(status_t) :: status

      call read_deck(command%names(1)%s, command%settings, deck, status)
      ok = is_ok(status) .and. count_messages(SEVERITY_ERROR) == 0
      if (.not. ok) return
      call build_model(deck, model, command%refine, shape=command%shape, state=command%state)
      ok = count_messages(SEVERITY_ERROR) == 0
   end subroutine read_model

   !> Reads the expressions of the deck and of --observe. code: STATUS_DECK or STATUS_USAGE for one that is wrong, which is printed.
   subroutine prepare_observations(command, model, observations, code)
      type(command_t), intent(in) :: command
      type(model_t), intent(in) :: model
      type(observations_t), intent(out) :: observations
      integer, intent(out) :: code
      type(message_t) :: error
      type(string_t), allocatable :: texts(:)
      logical :: ok

      code = STATUS_OK
      texts = [string_t ::]
      if (allocated(command%observe)) texts = command%observe
      call read_observations(texts, model, observations, ok, error)
      if (ok) return
      code = merge(STATUS_DECK, STATUS_USAGE, error%line > 0)
      call print_message(error, command%json)
   end subroutine prepare_observations

   !> Whether what the run is going to replace or remove is atrito's, and nothing that it has read. status: STATUS_FILE.
   subroutine check_files(command, model, status)
      type(command_t), intent(in) :: command
      type(model_t), intent(in) :: model
      type(status_t), intent(out) :: status
      character(len=:), allocatable :: folder

      folder = output_folder(command)
      call check_length(folder, as_run_name(model%deck_name), status)
      if (.not. is_ok(status) .or. .not. is_folder(folder)) return
      call check_all_own(folder, list_files_of_run(model, folder), status)
      if (is_ok(status)) call check_all_own(plot_folder(folder), list_plots(folder, PLOTS_OF_RUN), status)
      if (is_ok(status)) call check_own(folder//'/'//restart_name(model), status, may_be_read=.true.)
   end subroutine check_files

   !> The deck as it is run, and its digest; its files are protected.
   subroutine keep_deck(deck, model, status, adaptation)
      type(deck_t), intent(inout) :: deck
      type(model_t), intent(inout) :: model
      type(status_t), intent(inout) :: status
      type(adaptation_t), intent(in), optional :: adaptation !< whose mesh the deck gets
      logical :: is_cut
      integer(ip) :: i

      do i = 1, deck%n_sources
         if (is_ok(status)) call protect_input(deck%sources(i)%identity, status)
      end do
      is_cut = .false.
      if (present(adaptation)) is_cut = adaptation%target > 0.0_wp .and. model%n_cut > 0
      if (is_cut) then
         call take_deck_as_run(deck, model%as_run, card_of_trees(deck, adaptation%trees))
      else
         call take_deck_as_run(deck, model%as_run)
      end if
      model%provenance%digest = digest_of_texts(model%as_run)
   end subroutine keep_deck

   !> Whether all elements of the deck have the plane state of a kind; nothing asked is always there.
   pure logical function has_state(model, element)
      type(model_t), intent(in) :: model
      character(len=*), intent(in) :: element       !< name of a kind, or empty

      has_state = .true.
      if (len_trim(element) > 0) has_state = all(FULL_STATE(model%mesh%state) &
                                                 == FULL_STATE(KINDS(kind_named(upper_case(trim(element))))%state))
   end function has_state

   !> What the command line asks of the solver: its kind, the form of the contact system, and what else has to be found.
   function solve_options(command) result(options)
      type(command_t), intent(in) :: command
      type(solve_options_t) :: options
      integer, parameter :: KINDS(*) = [SOLVER_AUTO, SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE]
      integer, parameter :: FORMS(*) = [CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE]
      integer, parameter :: PROOFS(*) = [PROOF_AUTO, PROOF_ON, PROOF_OFF]

      options%solver_kind = KINDS(place_of_word('--solver', command%solver))
      options%contact_form = FORMS(place_of_word('--contact', command%contact))
      options%element_errors = command%plot .or. command%adapt > 0.0_wp
      options%starts = command%starts
      options%proof = PROOFS(place_of_word('--proof', command%proof))
      ! the runs of sweeps, studies and limits stay where they are
      if (command%task == TASK_RUN .and. command%share /= 'none' .and. command%adapt <= 0.0_wp) then
         call distribute_over_ranks(command%share == 'all', options%distribution)
      end if
   end function solve_options

end module atrito_run
