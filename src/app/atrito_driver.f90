!> Does what the command line asks for: reads, solves, writes, and tells how it went.
module atrito_driver
   use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
   use atrito_files, only: ignore_broken_pipe
   use atrito_kinds, only: ip
   use atrito_blas_info, only: set_blas_threads
   use atrito_strings, only: string_t, join, upper_case, to_text, nearest_names
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   use atrito_status, only: status_t, set_status, is_ok, STATUS_OK, STATUS_USAGE, STATUS_DECK, STATUS_NOT_CONVERGED, &
                            STATUS_SINGULAR, STATUS_FILE
   use atrito_messages, only: message_t, count_messages, get_message, sort_messages, format_message, clear_messages, &
                              SEVERITY_ERROR, SEVERITY_NOTE, MOST_ERRORS
   use atrito_timers, only: start_phase, stop_phase, reset_timers
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_deck, only: deck_t
   use atrito_reader, only: read_deck
   use atrito_keyword_table, only: keyword_table, keyword_names
   use atrito_help, only: help_overview, help_keyword, help_manual
   use atrito_model, only: model_t
   use atrito_build_model, only: build_model
   use atrito_results, only: results_t, scene_t
   use atrito_solve, only: solve_static, survey_scene, solve_options_t, SOLVER_AUTO, SOLVER_SKYLINE, SOLVER_BANDED
   use atrito_page, only: page_t, print_page
   use atrito_write_results, only: write_results
   use atrito_screen, only: compose_summary
   use atrito_check_report, only: compose_check
   use atrito_compare, only: comparison_t, begin_comparison, compare_paths
   use atrito_usage, only: compose_usage, compose_options
   use atrito_command_line, only: command_t, parse_command, fetch_arguments, TASK_USAGE, TASK_RUN, TASK_CHECK, TASK_COMPARE, &
                                  TASK_HELP, TASK_OPTIONS, TASK_VERSION
   implicit none (type, external)
   private
   public :: run_program

contains

   !> Runs the program on its command line; code is the exit code.
   subroutine run_program(code)
      integer, intent(out) :: code                  !< one of STATUS_*
      type(string_t), allocatable :: arguments(:)
      type(command_t) :: command
      type(message_t) :: error
      type(page_t) :: page
      logical :: ok

      call ignore_broken_pipe()
      call set_blas_threads(1_ip)
      call clear_messages()
      call reset_timers()
      call fetch_arguments(arguments)
      call parse_command(arguments, command, ok, error)
      code = STATUS_USAGE
      if (.not. ok) then
         call print_lines(format_message(error), error_unit)
         call print_lines([string_t('    see:      atrito --help')], error_unit)
         return
      end if
      select case (command%task)
      case (TASK_RUN)
         call run_deck(command, code)
      case (TASK_CHECK)
         call check_deck(command, code)
      case (TASK_COMPARE)
         call compare_tables(command, code)
      case (TASK_HELP)
         call print_help(command, code)
      case (TASK_OPTIONS)
         call compose_options(page)
         call print_page(page, output_unit)
         code = STATUS_OK
      case (TASK_VERSION)
         call print_lines([string_t(PROGRAM_NAME//' '//PROGRAM_VERSION)], output_unit)
         code = STATUS_OK
      case (TASK_USAGE)
         call compose_usage(page)
         call print_page(page, error_unit)
      end select
   end subroutine run_program

   !> Solves a deck and writes its tables.
   subroutine run_deck(command, code)
      type(command_t), intent(in) :: command
      integer, intent(out) :: code
      type(model_t) :: model
      type(results_t) :: results
      type(reporter_t) :: reporter
      type(status_t) :: status
      integer(ip) :: told

      reporter%quiet = command%quiet
      call load_model(command, reporter, model, told, code)
      if (code /= STATUS_OK) return
      call solve_static(model, solve_options(command), reporter, results, status)
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
      type(string_t), allocatable :: written(:)
      character(len=:), allocatable :: folder

      folder = 'output/'//model%deck_name
      if (allocated(command%folder)) folder = command%folder
      call report_progress(reporter, 'write '//folder)
      call write_results(model, results, int(command%digits), folder, written, status)
      if (.not. is_ok(status)) then
         call print_status(status, model%deck_path)
         code = status%code
      else if (.not. command%quiet) then
         call compose_summary(model, results, folder, written, page)
         call print_page(page, output_unit)
      end if
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
      options%threads = command%threads
   end function solve_options

   !> Tells what a deck needs; solves nothing, writes no file.
   subroutine check_deck(command, code)
      type(command_t), intent(in) :: command
      integer, intent(out) :: code
      type(model_t) :: model
      type(scene_t) :: scene
      type(reporter_t) :: reporter
      type(status_t) :: status
      type(page_t) :: page
      integer(ip) :: told

      reporter%quiet = .true.
      call load_model(command, reporter, model, told, code)
      if (code /= STATUS_OK) return
      call survey_scene(model, solve_options(command), scene, status)
      call print_messages(command%quiet, told + 1)
      code = status%code
      if (.not. is_ok(status)) then
         call print_status(status, model%deck_path)
      else if (.not. command%quiet) then
         call compose_check(model, scene, page)
         call print_page(page, output_unit)
      end if
   end subroutine check_deck

   subroutine compare_tables(command, code)
      type(command_t), intent(in) :: command
      integer, intent(out) :: code
      type(comparison_t) :: comparison
      type(status_t) :: status

      call begin_comparison(comparison, command%rtol, command%atol)
      call compare_paths(command%names(1)%s, command%names(2)%s, comparison, status)
      if (.not. command%quiet) call print_page(comparison%page, output_unit)
      ! tables that differ are told on standard output; anything else is an error
      if (.not. is_ok(status) .and. comparison%n_differences == 0) call print_status(status, PROGRAM_NAME)
      if (status%code == STATUS_FILE .and. comparison%n_differences > 0) call print_status(status, PROGRAM_NAME)
      code = status%code
   end subroutine compare_tables

   subroutine print_help(command, code)
      type(command_t), intent(in) :: command
      integer, intent(out) :: code
      type(string_t), allocatable :: lines(:)
      character(len=:), allocatable :: keyword
      logical :: known

      keyword = upper_case(join(command%names, ' '))
      known = .true.
      if (len(keyword) == 0) then
         call help_overview(lines)
      else if (keyword == 'ALL') then
         call help_manual(lines)
      else
         call help_keyword(keyword, lines, known)
      end if
      code = STATUS_OK
      if (known) then
         call print_lines(lines, output_unit)
      else
         code = STATUS_USAGE
         call print_unknown_keyword(keyword)
      end if
   end subroutine print_help

   subroutine print_unknown_keyword(keyword)
      character(len=*), intent(in) :: keyword
      type(message_t) :: error

      error%id = 'E-COMMAND'
      error%file = PROGRAM_NAME
      error%text = 'there is no keyword '//keyword
      error%nearest = nearest_names(keyword, keyword_names(keyword_table()), 3)
      call print_lines(format_message(error), error_unit)
      call print_lines([string_t('    see:      atrito help')], error_unit)
   end subroutine print_unknown_keyword

   !> Prints the messages from number `first` on: the first errors, warnings and notes, and the count of the others.
   subroutine print_messages(quiet, first)
      logical, intent(in) :: quiet                  !< no notes
      integer(ip), intent(in) :: first
      type(message_t) :: message
      integer(ip) :: i, printed(SEVERITY_NOTE), n(SEVERITY_NOTE)
      character(len=8), parameter :: WORD(SEVERITY_NOTE) = ['errors  ', 'warnings', 'notes   ']

      n = 0
      do i = first, count_messages()
         message = get_message(i)
         if (quiet .and. message%severity == SEVERITY_NOTE) cycle
         n(message%severity) = n(message%severity) + 1
         if (n(message%severity) <= MOST_ERRORS) call print_lines(format_message(message), error_unit)
      end do
      printed = min(n, int(MOST_ERRORS, ip))
      do i = 1, SEVERITY_NOTE
         if (n(i) > printed(i)) call print_lines([string_t('... the first '//to_text(printed(i))//' of '//to_text(n(i))// &
                                                           ' '//trim(WORD(i)))], error_unit)
      end do
      if (n(SEVERITY_ERROR) > 0) call print_lines([string_t(to_text(n(SEVERITY_ERROR))//' '// &
                                                        trim(merge('error ', 'errors', n(SEVERITY_ERROR) == 1))//' in the deck')], &
                                                  error_unit)
   end subroutine print_messages

   !> Tells a failure that belongs to no place in the deck.
   subroutine print_status(status, file)
      type(status_t), intent(in) :: status
      character(len=*), intent(in) :: file          !< the deck, as the user wrote it
      type(message_t) :: message

      if (.not. allocated(status%text)) return
      message%id = status_id(status%code)
      message%file = file
      if (status%code == STATUS_FILE .or. status%code == STATUS_USAGE) message%file = PROGRAM_NAME
      message%text = status%text
      call print_lines(format_message(message), error_unit)
   end subroutine print_status

   pure function status_id(code) result(id)
      integer, intent(in) :: code
      character(len=:), allocatable :: id

      select case (code)
      case (STATUS_USAGE)
         id = 'E-COMMAND'
      case (STATUS_DECK)
         id = 'E-DECK'
      case (STATUS_NOT_CONVERGED)
         id = 'E-NOT-CONVERGED'
      case (STATUS_SINGULAR)
         id = 'E-SINGULAR'
      case (STATUS_FILE)
         id = 'E-FILE'
      case default
         id = 'E-INTERNAL'
      end select
   end function status_id

   !> A failure to print is nobody's error.
   subroutine print_lines(lines, unit)
      type(string_t), intent(in) :: lines(:)
      integer, intent(in) :: unit
      integer :: i, ios

      do i = 1, size(lines)
         write (unit, '(a)', iostat=ios) lines(i)%s
         if (ios /= 0) return
      end do
   end subroutine print_lines

end module atrito_driver
