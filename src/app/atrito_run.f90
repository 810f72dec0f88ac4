!> One run: read the deck, build the model, solve, write.
module atrito_run
   use, intrinsic :: iso_fortran_env, only: output_unit
   use atrito_body_store, only: body_store_t
   use atrito_build_model, only: build_model
   use atrito_build_requests, only: refuse_field_files
   use atrito_command_line, only: command_t, output_folder
   use atrito_console, only: print_messages, print_status
   use atrito_deck, only: deck_t
   use atrito_hdf5, only: has_hdf5
   use atrito_kinds, only: ip
   use atrito_messages, only: count_messages, sort_messages, SEVERITY_ERROR
   use atrito_model, only: model_t
   use atrito_page, only: page_t, print_page
   use atrito_plot_files, only: plot_folder
   use atrito_reader, only: read_deck
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_results, only: results_t
   use atrito_screen, only: compose_summary
   use atrito_solve, only: solve_static, solve_options_t, SOLVER_AUTO, SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE
   use atrito_status, only: status_t, set_status, is_ok, STATUS_OK, STATUS_DECK, STATUS_NOT_CONVERGED
   use atrito_strings, only: string_t
   use atrito_timers, only: start_phase, stop_phase
   use atrito_write_plots, only: write_plots, plot_names
   use atrito_write_results, only: write_results
   implicit none (type, external)
   private
   public :: run_deck, load_model, solve_options

contains

   !> Solves a deck and writes its tables.
   subroutine run_deck(command, store, code)
      type(command_t), intent(in) :: command
      type(body_store_t), intent(inout) :: store    !< bodies of an earlier run; those of this one
      integer, intent(out) :: code                  !< one of STATUS_*
      type(model_t) :: model
      type(results_t) :: results
      type(reporter_t) :: reporter
      type(status_t) :: status
      integer(ip) :: told

      reporter%quiet = command%quiet
      call load_model(command, reporter, model, told, code)
      if (code /= STATUS_OK) return
      call solve_static(model, solve_options(command), reporter, results, status, store)
      call print_messages(command%quiet, told + 1)
      if (is_ok(status) .or. status%code == STATUS_NOT_CONVERGED) call agree_on_outcome(status, results)
      if (.not. is_ok(status)) call print_status(status, model%deck_path)
      code = status%code
      if (code /= STATUS_OK .and. code /= STATUS_NOT_CONVERGED) return
      call write_run(command, reporter, model, results, code)
   end subroutine run_deck

   !> The status and the results say the same of a run: solved, or not converged and why.
   subroutine agree_on_outcome(status, results)
      type(status_t), intent(inout) :: status
      type(results_t), intent(inout) :: results
      character(len=:), allocatable :: text

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

   subroutine write_run(command, reporter, model, results, code)
      type(command_t), intent(in) :: command
      type(reporter_t), intent(in) :: reporter
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      integer, intent(inout) :: code
      type(status_t) :: status
      type(page_t) :: page
      type(string_t), allocatable :: written(:), pictures(:)
      character(len=:), allocatable :: folder
      integer(ip) :: told

      folder = output_folder(command)
      call report_progress(reporter, 'write '//folder)
      told = count_messages()
      if (command%plot) pictures = plot_names(results)       ! not allocated: an optional argument that is not there
      call write_results(model, results, int(command%digits), folder, written, status, pictures)
      if (.not. is_ok(status)) then
         call print_status(status, model%deck_path)
         code = status%code
         return
      end if
      if (command%plot) then
         call report_progress(reporter, 'plot  '//plot_folder(folder))
         call write_plots(model, results, folder, pictures)
      end if
      call print_messages(command%quiet, told + 1)
      if (command%quiet) return
      call compose_summary(model, results, folder, written, page, pictures)
      call print_page(page, output_unit)
   end subroutine write_run

   !> Reads a deck and builds its model. All messages are told; errors of the deck give STATUS_DECK.
   subroutine load_model(command, reporter, model, told, code)
      type(command_t), intent(in) :: command
      type(reporter_t), intent(in) :: reporter
      type(model_t), intent(out) :: model
      integer(ip), intent(out) :: told              !< messages printed so far
      integer, intent(out) :: code
      type(deck_t) :: deck
      type(status_t) :: status

      call report_progress(reporter, 'read  '//command%names(1)%s)
      call start_phase('read')
      call read_deck(command%names(1)%s, command%settings, deck, status)
      call stop_phase('read')
      told = 0
      if (is_ok(status) .or. status%code == STATUS_DECK) then
         call start_phase('model')
         call build_model(deck, model, command%refine)
         if (.not. has_hdf5()) call refuse_field_files(deck)
         call stop_phase('model')
      end if
      code = status%code
      if (.not. is_ok(status) .and. code /= STATUS_DECK) then
         call print_status(status, command%names(1)%s)
         return
      end if
      call sort_messages()
      call print_messages(command%quiet, 1_ip)
      told = count_messages()
      if (count_messages(SEVERITY_ERROR) > 0) then
         code = STATUS_DECK
      else if (.not. is_ok(status)) then
         call print_status(status, command%names(1)%s)
      end if
   end subroutine load_model

   pure function solve_options(command) result(options)
      type(command_t), intent(in) :: command
      type(solve_options_t) :: options

      options%storage_kind = SOLVER_AUTO
      if (command%solver == 'skyline') options%storage_kind = SOLVER_SKYLINE
      if (command%solver == 'banded') options%storage_kind = SOLVER_BANDED
      if (command%solver == 'sparse') options%storage_kind = SOLVER_SPARSE
      options%threads = command%threads
   end function solve_options

end module atrito_run
