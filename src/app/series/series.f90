!> What sweeps, studies and limits have in common: they claim their folder for all of their runs, write tables, draw, and tell it.
module atrito_series
   use, intrinsic :: iso_fortran_env, only: output_unit
   use atrito_command_line, only: command_t, output_folder, TASK_LIMIT, TASK_SWEEP
   use atrito_console, only: print_messages, print_status
   use atrito_deck, only: deck_t
   use atrito_deck_as_run, only: take_deck_as_run
   use atrito_files, only: check_folder, check_all_own
   use atrito_folder_claim, only: folder_claim_t, claim_folder
   use atrito_given_options, only: options_of_series
   use atrito_kinds, only: ip, lp, wp
   use atrito_messages, only: add_warning, clear_messages, count_messages, SEVERITY_ERROR
   use atrito_model, only: observed_line_t
   use atrito_observations, only: observation_names
   use atrito_build_model, only: list_observed
   use atrito_page, only: page_t, print_page, add_above_rule
   use atrito_patched_text, only: named_text_t, digest_of_texts
   use atrito_parameters, only: list_parameters
   use atrito_plot_files, only: plot_folder, list_plots, remove_plots, PLOTS_OF_SWEEP, PLOTS_OF_STUDY, PLOTS_OF_LIMIT, &
                                REPORT_NAME, remove_report
   use atrito_reader, only: read_deck
   use atrito_report, only: report_t
   use atrito_report_maker, only: make_report
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, append_string
   use atrito_sweep_plan, only: JOURNAL_NAME
   use atrito_table, only: origin_t, TAB_ENDING, CSV_ENDING
   use atrito_system, only: processor_seconds
   implicit none (type, external)
   private
   public :: claim_output, find_origin, find_observed, begin_pictures, print_closing, seconds_since

   !> Whose the pictures of a command are.
   integer, parameter :: WHOSE(TASK_SWEEP:TASK_LIMIT) = [PLOTS_OF_SWEEP, PLOTS_OF_STUDY, PLOTS_OF_LIMIT]

contains

   !> Claims the folder of the command; two at once would leave runs of both. A failure, also an earlier one, is told.
   subroutine claim_output(command, tables, claim, status)
      type(command_t), intent(in) :: command        !< its folder and deck are read
      character(len=*), intent(in) :: tables(:)     !< that it writes besides those of its runs; their names
      type(folder_claim_t), intent(out) :: claim    !< held until release_folder, where status is OK
      type(status_t), intent(inout) :: status       !< of what came before; STATUS_FILE

      if (is_ok(status)) call check_folder(output_folder(command), status)
      if (is_ok(status)) call check_files(command, tables, status)
      if (is_ok(status)) call claim_folder(output_folder(command), claim, status, silent=command%json)
      if (.not. is_ok(status)) call print_status(status, command%names(1)%s, command%json)
   end subroutine claim_output

   !> Whether what is going to be replaced or removed is atrito's.
   subroutine check_files(command, tables, status)
      type(command_t), intent(in) :: command
      character(len=*), intent(in) :: tables(:)
      type(status_t), intent(out) :: status
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      call append_string(names, REPORT_NAME)
      if (command%task == TASK_SWEEP) call append_string(names, JOURNAL_NAME)
      do i = 1, size(tables)
         call append_string(names, trim(tables(i))//TAB_ENDING)
         call append_string(names, trim(tables(i))//CSV_ENDING)
      end do
      call check_all_own(output_folder(command), names, status)
      if (is_ok(status)) call check_all_own(plot_folder(output_folder(command)), &
                                            list_plots(output_folder(command), WHOSE(command%task)), status)
   end subroutine check_files

   !> The comment lines at the top of the tables: what they tell of the deck, with its own values where a parameter varies. What is
   !> wrong with the deck its runs will tell.
   subroutine find_origin(command, origin)
      type(command_t), intent(in) :: command        !< deck, --set, --vary and options are read
      type(origin_t), intent(out) :: origin         !< its digest is missing where the deck has errors
      type(string_t), allocatable :: varied(:)
      type(named_text_t), allocatable :: files(:)
      type(deck_t) :: deck
      type(status_t) :: status
      logical :: has_errors
      integer :: i

      origin%deck = command%names(1)%s(index(command%names(1)%s, '/', back=.true.) + 1:)
      allocate (origin%heading(0), varied(0))
      call clear_messages()
      do i = 1, size(command%vary)
         call append_string(varied, trim(adjustl(command%vary(i)%s(:index(command%vary(i)%s, '=') - 1))))
      end do
      call options_of_series(command, origin%options)
      call read_deck(command%names(1)%s, command%settings, deck, status)
      has_errors = count_messages(SEVERITY_ERROR) > 0
      call clear_messages()
      if (.not. is_ok(status)) return
      call list_parameters(deck, varied, origin%parameters)
      if (has_errors) return
      call take_deck_as_run(deck, files)
      origin%digest = digest_of_texts(files)
   end subroutine find_origin

   !> The names of what is observed in each run, those of the deck first.
   subroutine find_observed(command, names)
      type(command_t), intent(in) :: command               !< deck, --set and --observe are read
      type(string_t), allocatable, intent(out) :: names(:) !< of the deck, then of --observe
      type(observed_line_t), allocatable :: lines(:)
      type(deck_t) :: deck
      type(status_t) :: status

      call clear_messages()
      call read_deck(command%names(1)%s, command%settings, deck, status)
      call clear_messages()                         ! its runs tell what is wrong
      allocate (lines(0))
      if (is_ok(status)) call list_observed(deck, lines)
      names = observation_names(lines, command%observe)
   end subroutine find_observed

   !> The command's pictures and report of an earlier time go, made anew or not, for its tables are new.
   subroutine begin_pictures(command)
      type(command_t), intent(in) :: command        !< its folder and task are read
      type(status_t) :: status

      call clear_messages()
      call check_files(command, [character(len=1) ::], status)     ! an hour may have passed
      if (is_ok(status)) then
         call remove_plots(output_folder(command), WHOSE(command%task))
         call remove_report(output_folder(command))
      else
         call add_warning('W-PLOT', status%text)
      end if
   end subroutine begin_pictures

   !> Writes the report, where one is asked for, and prints the closing lines.
   subroutine print_closing(command, page, report)
      type(command_t), intent(in) :: command        !< of the series; report, json and quiet are read
      type(page_t), intent(inout) :: page           !< gets a line about the report
      type(report_t), intent(inout) :: report       !< gets the command; written, if asked for
      logical :: has_report

      has_report = .false.
      if (command%report) call make_report(command, report, has_report)
      if (has_report) call add_above_rule(page, 'report', output_folder(command)//'/'//REPORT_NAME)
      call print_messages(command%quiet, 1_ip, command%json)
      if (.not. command%quiet) call print_page(page, output_unit)
   end subroutine print_closing

   !> Wall clock since a count of system_clock, and processor time of the process.
   function seconds_since(began) result(seconds)
      integer(lp), intent(in) :: began              !< count of system_clock
      real(wp) :: seconds(2)
      integer(lp) :: ended, rate

      call system_clock(ended, rate)
      seconds = [real(ended - began, wp)/real(rate, wp), processor_seconds()]
   end function seconds_since

end module atrito_series
