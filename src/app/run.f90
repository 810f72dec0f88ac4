!> One run: read the deck, build the model, solve, write.
!>
!>     run_deck
!>       load_model                 the deck becomes cards and a model; all errors of the deck are told here, exit 2
!>       prepare_observations       what *OBSERVE and --observe mean in this model
!>       check_folder, check_files  what could not be written, or would replace what is not ours, is told before an hour of solving
!>       solve_history              the solution; with --adapt as often as take_next_mesh has a finer mesh to solve on
!>       agree_on_outcome           results that are not converged, or that the final check refuses, make exit 3
!>       write_run                  in a folder that no other run may write into meanwhile:
!>         write_results            tables, listing, fields, which appear together
!>         write_plots, draw_shown  pictures, and make_run_report the page: a failure there is a warning
!>         write_others             other solutions that were found, each in a folder of its own
!>         compose_summary          the screen
!>
!> A run without a last increment (no equilibrium, a contradiction in the deck) writes nothing; older tables stay, and a note says
!> so.
module atrito_run
   use, intrinsic :: iso_fortran_env, only: output_unit
   use atrito_adaptation, only: adaptation_t, adaptation_text, begin_adaptation, build_adaptation, mesh_text, missed_text
   use atrito_as_run_names, only: as_run_name
   use atrito_body_cache, only: body_cache_t
   use atrito_command_line, only: command_t, output_folder, TASK_RUN
   use atrito_console, only: print_messages, print_status, reporter_of
   use atrito_element_table, only: DEGREE_OF, KINDS
   use atrito_files, only: check_folder, check_all_own, check_length, check_own, forget_inputs, is_folder, file_exists, &
                           judge_file, protect_input
   use atrito_fingerprint, only: fingerprint_t, take_fingerprint
   use atrito_folder_claim, only: folder_claim_t, claim_folder, release_folder
   use atrito_frame_spool, only: begin_frames, end_frames, frame_spool_t
   use atrito_history, only: solve_history
   use atrito_kinds, only: ip, wp, lp
   use atrito_load_model, only: check_bounds, load_model, prepare_observations, take_next_mesh, note_older_results
   use atrito_mesh, only: signed_area
   use atrito_messages, only: count_messages, message_t, add_message, SEVERITY_WARNING
   use atrito_model, only: model_t
   use atrito_observations, only: observations_t, observation_names
   use atrito_option_table, only: place_of_word
   use atrito_page, only: page_t, add_above_rule, print_page
   use atrito_plot_files, only: plot_folder, solution_folder, list_plots, PLOTS_OF_RUN
   use atrito_rank_distribution, only: distribute_over_ranks
   use atrito_recorder, only: recorder_t
   use atrito_report_maker, only: make_run_report
   use atrito_reporter, only: reporter_t, report_phase
   use atrito_restart_file, only: restart_name, read_restart, write_restart
   use atrito_restart_state, only: restart_state_t
   use atrito_results, only: history_t, results_t, last_frame, frame_store_t
   use atrito_screen, only: compose_summary
   use atrito_show, only: show_t
   use atrito_show_plots, only: draw_shown
   use atrito_solve, only: solve_options_t, PROOF_AUTO, PROOF_OFF, PROOF_ON, CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE, &
                           SOLVER_AUTO, SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE
   use atrito_status, only: status_t, set_status, reword_status, is_ok, STATUS_OK, STATUS_USAGE, STATUS_NOT_CONVERGED
   use atrito_strings, only: string_t, join
   use atrito_study_errors, only: run_facts_t
   use atrito_system, only: address_space_limit
   use atrito_table, only: table_t
   use atrito_threads, only: lent_threads, set_threads
   use atrito_write_plots, only: write_plots, plot_names
   use atrito_write_results, only: write_results, remove_results, list_files_of_run
   implicit none (type, external)
   private
   public :: run_deck, take_threads, solve_options, agree_on_outcome

   !> A file holds all increments that are printed, so the next one takes longer. What takes some time is written as often as it is
   !> less than a fifth of the processor time of the run; a run that is killed has lost no more than four times that.
   real(wp), parameter :: SOME_TIME = 0.02_wp        !< [s]
   real(wp), parameter :: BETWEEN = 4.0_wp           !< processor time between two files over that of writing one

   !> Who writes the restart files of a run (recorder_t).
   type, extends(recorder_t) :: restart_recorder_t
      character(len=:), allocatable :: folder, name  !< of the restart files, and their name in it
      character(len=:), allocatable :: deck_path     !< for messages
      type(fingerprint_t) :: fingerprint             !< of the model and the options
      integer(ip) :: last_step = 0                   !< of the model
      real(wp) :: written = 0.0_wp, took = 0.0_wp    !< processor time when the last file was there, and that it took [s]
      logical :: has_warned = .false.                !< that writing takes long: told once
   contains
      procedure :: record => write_record
   end type restart_recorder_t

contains

   !> Solves a deck and writes its tables. What it reads is protected for so long.
   subroutine run_deck(command, store, code, facts)
      type(command_t), intent(in) :: command        !< of a run; folder, deck and all options
      type(body_cache_t), intent(inout) :: store    !< bodies of an earlier run; those of this one
      integer, intent(out) :: code                  !< one of STATUS_*
      type(run_facts_t), intent(out), optional :: facts !< what a study asks; defaults where nothing is written
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
         if (command%adapt > 0.0_wp .and. (model%restart_every > 0 .or. allocated(command%restart))) then
            call set_status(status, STATUS_USAGE, '--adapt: each mesh begins anew, without *RESTART and --restart')
         end if
         call check_bounds(command, model, status)
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
         logical :: goes_on

         options = solve_options(command)
         options%frames => frames
         do
            if (allocated(command%show)) then       ! of the last mesh
               show%views = command%show
               show%page%n = 0
               if (size(command%show) > 0) options%viewer => show
            end if
            if (allocated(observations%quantities)) options%quantities = observations%quantities
            call solve_history(model, options, reporter, history, status, store, recorder, observations)
            if (adaptation%target <= 0.0_wp .or. .not. is_ok(status)) exit
            call take_next_mesh(command, history, model, observations, adaptation, n_printed, goes_on)
            if (.not. goes_on) exit
            call report_phase(reporter, 'adapt '//mesh_text(adaptation))
            call end_frames(frames)
            call begin_frames(output_folder(command), frames)
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

   end subroutine run_deck

   !> The threads of this run, with those of ranks that wait on the same host: not where `ulimit -v` counts what each reserves.
   subroutine take_threads(command)
      type(command_t), intent(in) :: command        !< its threads and ranks of the host are read
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
      type(status_t), intent(inout) :: status       !< STATUS_OK stays only with a solution
      type(results_t), intent(inout) :: results     !< the last there are
      logical, intent(in) :: ends_early             !< the history did not reach its end
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

      n_shown = show%n_tables
      allocate (shown(n_shown + merge(1, 0, adaptation%target > 0.0_wp)))
      shown(:n_shown) = show%tables(:n_shown)
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

   !> What the command line asks of the solver: its kind, the form of the contact system, and what else has to be found.
   function solve_options(command) result(options)
      type(command_t), intent(in) :: command        !< solver, contact, proof, plot, adapt, share
      type(solve_options_t) :: options
      integer, parameter :: KINDS(*) = [SOLVER_AUTO, SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE]
      integer, parameter :: FORMS(*) = [CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE]
      integer, parameter :: PROOFS(*) = [PROOF_AUTO, PROOF_ON, PROOF_OFF]

      options%solver_kind = KINDS(place_of_word('--solver', command%solver))
      options%contact_form = FORMS(place_of_word('--contact', command%contact))
      options%element_errors = command%plot .or. command%adapt > 0.0_wp
      options%starts = command%starts
      options%proof = PROOFS(place_of_word('--proof', command%proof))
      if (command%adapt > 0.0_wp .and. options%proof == PROOF_AUTO) options%proof = PROOF_ON     ! it is what is followed
      ! the runs of sweeps, studies and limits stay where they are
      if (command%task == TASK_RUN .and. command%share /= 'none' .and. command%adapt <= 0.0_wp) then
         call distribute_over_ranks(command%share == 'all', options%distribution)
      end if
   end function solve_options

   !> Reads the file of --restart, and gets ready to write those that the deck asks for. status: that of read_restart.
   subroutine begin_recorder(command, model, recorder, frames, status)
      type(command_t), intent(in) :: command                !< --restart, and what its file must agree with
      type(model_t), intent(in) :: model                    !< as built, with *RESTART
      type(restart_recorder_t), intent(out) :: recorder     !< resumes where --restart is given
      class(frame_store_t), intent(inout), target :: frames !< will keep the increments that are printed
      type(status_t), intent(out) :: status                 !< STATUS_OK, or why --restart cannot be read
      character(len=:), allocatable :: options
      integer(lp) :: identity(2)
      integer :: i

      recorder%resumes = allocated(command%restart)
      recorder%every = model%restart_every
      if (recorder%every == 0 .and. .not. recorder%resumes) return
      recorder%folder = output_folder(command)
      recorder%name = restart_name(model)
      if (recorder%resumes) recorder%source = command%restart
      recorder%observed = observation_names(model%observed, command%observe)
      recorder%deck_path = model%deck_path
      recorder%last_step = size(model%steps, kind=ip)
      ! what is solved by another form or another solver differs in the last digits
      options = '--contact '//trim(command%contact)//', --solver '//trim(command%solver)
      ! what was observed in increments that are not printed is in the file alone
      do i = 1, size(model%observed)
         options = options//', *OBSERVE '//model%observed(i)%text
      end do
      if (size(command%observe) > 0) options = options//', --observe '//join(command%observe, ', --observe ')
      call take_fingerprint(model, options, recorder%fingerprint)
      if (.not. recorder%resumes) return
      call judge_file(command%restart, status, identity)
      if (is_ok(status)) call protect_input(identity, status)
      if (file_exists(command%restart) .and. .not. is_ok(status)) return
      call read_restart(command%restart, recorder%fingerprint, recorder%found, recorder%state, status, frames)
   end subroutine begin_recorder

   !> Writes the file anew, where it is time to. A failure is told once, and the run goes on: its tables are not lost with it.
   subroutine write_record(self, history, state)
      class(restart_recorder_t), intent(inout) :: self
      type(history_t), intent(inout) :: history
      type(restart_state_t), intent(inout) :: state
      type(folder_claim_t) :: claim
      type(status_t) :: status
      type(message_t) :: message
      real(wp) :: began
      logical :: is_last

      is_last = state%ends_step .and. state%step == self%last_step
      call cpu_time(began)
      if (.not. is_last .and. self%took > SOME_TIME .and. began - self%written < BETWEEN*self%took) return
      call claim_folder(self%folder, claim, status)
      if (is_ok(status)) call write_restart(self%folder, self%name, self%fingerprint, history, state, status)
      call release_folder(claim)
      call cpu_time(self%written)
      self%took = self%written - began
      if (is_ok(status) .or. self%has_warned) return
      message%severity = SEVERITY_WARNING
      message%id = 'W-RESTART'
      message%file = self%deck_path
      message%text = 'no restart file: '//status%text
      call add_message(message)
      self%has_warned = .true.
   end subroutine write_record

end module atrito_run
