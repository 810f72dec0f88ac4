!> Does what the command line asks for: reads, solves, writes, and tells how it went.
!>
!> What ranks other than the first do: they wait for what the first wants of them, and do it.
module atrito_driver
   use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
   use, intrinsic :: iso_c_binding, only: c_int, c_int64_t
   use atrito_blas_info, only: choose_blas_kernels, set_blas_threads, blas_buffer_bytes, claim_blas_buffers
   use atrito_body_cache, only: body_cache_t
   use atrito_buffer, only: buffer_t, take
   use atrito_check_plots, only: write_check_plots
   use atrito_command_line, only: command_t, confine_command, output_folder, parse_command, wrong, wants_json, fetch_arguments, &
           TASK_USAGE, TASK_RUN, TASK_CHECK, TASK_COMPARE, TASK_HELP, TASK_SWEEP, TASK_STUDY, TASK_LIMIT, TASK_OPTIONS, TASK_VERSION
   use atrito_compare, only: comparison_t, begin_comparison, compare_paths
   use atrito_compare_rules, only: leave_out, read_rules, take_tables
   use atrito_console, only: print_line, print_lines, print_message, print_messages, print_status
   use atrito_files, only: check_all_own
   use atrito_folder_claim, only: folder_claim_t, claim_folder, release_folder
   use atrito_help, only: help_overview, help_keyword, help_manual
   use atrito_help_pages, only: compose_bash_completion, compose_man_page, compose_options, compose_topic, compose_usage
   use atrito_keyword_table, only: keyword_table, keyword_names
   use atrito_kinds, only: ip, lp
   use atrito_libraries, only: library_t, add_libraries, list_libraries, LOADED
   use atrito_load_model, only: load_model, prepare_observations
   use atrito_memory, only: memory_text
   use atrito_messages, only: message_t, add_warning, clear_messages, SEVERITY_ERROR, SEVERITY_WARNING
   use atrito_model, only: model_t
   use atrito_model_memory, only: allow_large_meshes
   use atrito_mpi, only: has_mpi, mpi_name, rank_count, receive_buffer, send_buffer
   use atrito_mumps, only: has_mumps, mumps_trouble, mumps_version
   use atrito_observations, only: observations_t
   use atrito_page, only: page_t, add_item, plural, print_page
   use atrito_part_service, only: answer_question
   use atrito_plot_files, only: plot_folder, list_plots, PLOTS_OF_CHECK
   use atrito_rank_memory, only: serve_memory
   use atrito_rank_services, only: await_message, SERVICE_END, SERVICE_FIELDS, SERVICE_MEMORY, SERVICE_PART, SERVICE_RUNS
   use atrito_reporter, only: reporter_t
   use atrito_results, only: scene_t
   use atrito_run, only: run_deck, solve_options
   use atrito_run_request, only: take_request
   use atrito_screen, only: compose_check
   use atrito_shared_fields, only: answer_fields
   use atrito_solve, only: survey_scene
   use atrito_stability_limit, only: run_limit
   use atrito_status, only: status_t, is_ok, STATUS_OK, STATUS_USAGE, STATUS_FILE, STATUS_INTERNAL, STATUS_DECK
   use atrito_strings, only: string_t, join, upper_case, nearest_names, to_text
   use atrito_study, only: run_study, serve_study
   use atrito_sweep, only: run_sweep, serve_sweep
   use atrito_system, only: guard_interrupts, keep_freed_memory, address_space_limit, c_count_threads, c_has_address_space, &
                            stack_limit, stack_of_thread
   use atrito_threads, only: set_threads
   use atrito_timers, only: reset_timers
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   implicit none (type, external)
   private
   public :: begin_program, run_program, serve

   !> The stack that the program wants; the least with which scenes were solved is 192 KiB.
   integer(lp), parameter :: LEAST_STACK = 2_lp**19
   !> Address space to read a deck with.
   integer(lp), parameter :: TO_BEGIN = 2_lp**22

contains

   !> Runs the program on its command line; code is the exit code.
   subroutine run_program(n_on_host, code)
      integer(ip), intent(in) :: n_on_host          !< ranks of the first one's host, itself among them
      integer, intent(out) :: code                  !< one of STATUS_*
      type(string_t), allocatable :: arguments(:)
      type(library_t), allocatable :: libraries(:)
      type(command_t) :: command
      type(message_t) :: error
      type(page_t) :: page
      type(body_cache_t) :: store
      type(status_t) :: status
      logical :: ok
      integer :: i

      call fetch_arguments(arguments)
      call parse_command(arguments, command, ok, error)
      command%n_on_host = n_on_host
      code = STATUS_USAGE
      if (.not. ok) then
         call print_wrong(error, 'atrito --help', wants_json(arguments))
         return
      end if
      call confine_command(command, status)
      code = status%code
      if (.not. is_ok(status)) then
         call print_status(status, PROGRAM_NAME, command%json)
         return
      end if
      if (any(command%task == [TASK_RUN, TASK_SWEEP, TASK_STUDY, TASK_LIMIT, TASK_CHECK])) then
         call secure_means(command, code)
         if (code /= STATUS_OK) return
      end if
      select case (command%task)
      case (TASK_RUN)
         call run_deck(command, store, code)
      case (TASK_SWEEP)
         call run_sweep(command, code)
      case (TASK_STUDY)
         call run_study(command, code)
      case (TASK_LIMIT)
         call run_limit(command, code)
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
         if (has_mpi()) call name_libraries(.true.)
         call print_line(PROGRAM_NAME//' '//PROGRAM_VERSION, output_unit)
         call list_libraries(.false., libraries)
         do i = 1, size(libraries)
            call print_line(trim(libraries(i)%name)//': '//libraries(i)%version, output_unit)
         end do
         code = STATUS_OK
      case (TASK_USAGE)
         call compose_usage(page)
         call print_page(page, error_unit)
      end select
   end subroutine run_program

   !> What is to be so before anything else is done.
   subroutine begin_program()
      call keep_freed_memory()
      call guard_interrupts(STATUS_INTERNAL)
      call set_blas_threads(1_ip)
      call choose_blas_kernels()
      call set_threads(1_ip)
      call clear_messages()
      call reset_timers()
      if (has_mpi()) call allow_large_meshes()
      if (rank_count() > 1) call name_libraries(.false.)
   end subroutine begin_program

   !> MUMPS and MPI, of a program that has them.
   subroutine name_libraries(are_tried)
      logical, intent(in) :: are_tried              !< what cannot be loaded is printed
      type(library_t) :: list(2)

      list%name = [character(len=8) :: 'MUMPS', 'MPI']
      list(1)%version = mumps_version()//LOADED
      if (are_tried) then
         if (.not. has_mumps()) list(1)%version = 'not used: '//mumps_trouble()
      end if
      list(2)%version = mpi_name()//', '//plural(rank_count(), 'rank', 'ranks')
      call add_libraries(list)
   end subroutine name_libraries

   !> Tells what a deck needs, and draws it where that is asked for; solves nothing, writes nothing else.
   subroutine check_deck(command, code)
      type(command_t), intent(in) :: command
      integer, intent(out) :: code
      type(model_t) :: model
      type(scene_t) :: scene
      type(observations_t) :: observations
      type(reporter_t) :: reporter
      type(status_t) :: status
      type(page_t) :: page
      type(string_t), allocatable :: pictures(:)
      integer(ip) :: n_printed

      reporter%quiet = .true.
      call set_threads(command%threads)             ! each has a place for fronts
      call load_model(command, reporter, model, n_printed, code)
      if (code == STATUS_OK) call prepare_observations(command, model, observations, code)
      if (code /= STATUS_OK) return
      call survey_scene(model, solve_options(command), scene, status)
      if (command%plot) call draw_scene(command, model, pictures)
      call print_messages(command%quiet, n_printed + 1, command%json)
      code = status%code
      if (.not. is_ok(status)) then
         call print_status(status, model%deck_path, command%json)
      else if (.not. command%quiet) then
         call compose_check(model, scene, page)
         if (command%plot) then
            if (size(pictures) > 0) call add_item(page, 'plots in', plot_folder(output_folder(command))//': '//join(pictures, ' '))
         end if
         call print_page(page, output_unit)
      end if
   end subroutine check_deck

   !> The pictures of a scene, into a folder that is claimed as that of a run; a failure is a warning.
   subroutine draw_scene(command, model, pictures)
      type(command_t), intent(in) :: command
      type(model_t), intent(in) :: model
      type(string_t), allocatable, intent(out) :: pictures(:)   !< that were drawn, without ending
      type(folder_claim_t) :: claim
      type(status_t) :: status

      call claim_folder(output_folder(command), claim, status, silent=command%json)
      if (is_ok(status)) call check_all_own(plot_folder(output_folder(command)), &
                                            list_plots(output_folder(command), PLOTS_OF_CHECK), status)
      if (is_ok(status)) then
         call write_check_plots(model, command%view, output_folder(command), pictures)
      else
         allocate (pictures(0))
         call add_warning('W-PLOT', 'no plots are written: '//status%text)
      end if
      call release_folder(claim)
   end subroutine draw_scene

   subroutine compare_tables(command, code)
      type(command_t), intent(in) :: command
      integer, intent(out) :: code
      type(comparison_t) :: comparison
      type(status_t) :: status
      type(message_t) :: message
      integer :: i

      call begin_comparison(comparison, command%rtol, command%atol)
      if (allocated(command%tolerances)) call read_rules(command%tolerances, comparison%rules, status)
      if (allocated(command%tables) .and. is_ok(status)) call take_tables(command%tables, comparison%rules, status)
      if (allocated(command%ignore) .and. is_ok(status)) call leave_out(command%ignore, comparison%rules, status)
      if (is_ok(status)) call compare_paths(command%names(1)%s, command%names(2)%s, comparison, status)
      if (command%json) then                        ! each difference as a message
         do i = 1, size(comparison%differences)
            message = wrong(comparison%differences(i)%s)
            message%id = 'E-DIFFERENT'
            call print_message(message, .true.)
         end do
      end if
      if (.not. command%quiet) call print_page(comparison%page, output_unit)
      ! tables that differ are printed on standard output; anything else is an error
      if (.not. is_ok(status) .and. comparison%n_differences == 0) call print_status(status, PROGRAM_NAME, command%json)
      if (status%code == STATUS_FILE .and. comparison%n_differences > 0) call print_status(status, PROGRAM_NAME, command%json)
      code = status%code
   end subroutine compare_tables

   !> `atrito help`: a keyword, or one of the pages that are made of the tables.
   subroutine print_help(command, code)
      type(command_t), intent(in) :: command
      integer, intent(out) :: code
      type(string_t), allocatable :: lines(:)
      type(page_t) :: page
      character(len=:), allocatable :: words
      logical :: is_known

      words = upper_case(join(command%names, ' '))
      is_known = .true.
      select case (words)
      case ('')
         call help_overview(lines)
      case ('ALL')
         call help_manual(lines)
      case ('MAN')
         call compose_man_page(page)
      case ('BASH')
         call compose_bash_completion(page)
      case default
         call help_keyword(words, lines, is_known)
         call compose_topic(words, page)
         if (is_known) call print_lines(lines, output_unit)
         is_known = is_known .or. page%n > 0
         lines = lines(:0)
      end select
      code = STATUS_OK
      if (page%n > 0) then
         call print_page(page, output_unit)
      else if (is_known) then
         call print_lines(lines, output_unit)
      else
         code = STATUS_USAGE
         call print_wrong(wrong('there is no keyword, command or option '//words, &
                                nearest=nearest_names(words, keyword_names(keyword_table()), 3)), &
                          'atrito help', command%json)
      end if
   end subroutine print_help

   !> Tells what is wrong with the command line, and which command tells more.
   subroutine print_wrong(error, see, json)
      type(message_t), intent(in) :: error
      character(len=*), intent(in) :: see
      logical, intent(in) :: json

      call print_message(error, json)
      if (.not. json) call print_line('    see:      '//see, error_unit)
   end subroutine print_wrong

   !> What a run needs of the process besides memory for its scene, asked before anything is computed: libraries that do not get it
   !> hang or end the program.
   !>
   !> The stack, the threads, and of each thread the buffer of BLAS. Fewer threads than were asked for are told and taken.
   !> code: STATUS_DECK for want of memory, which is told.
   subroutine secure_means(command, code)
      type(command_t), intent(inout) :: command  !< its threads may become fewer
      integer, intent(out) :: code               !< STATUS_OK or STATUS_DECK
      integer(ip) :: n

      code = STATUS_DECK
      if (stack_limit() >= 0 .and. stack_limit() < LEAST_STACK) then
         call print_problem(command, SEVERITY_ERROR, 'E-MEMORY', 'the stack may have '//memory_text(stack_limit())// &
                            ' (ulimit -s), '//memory_text(LEAST_STACK)//' are needed')
         return
      end if
      if (address_space_limit() >= 0) then
         if (.not. has_buffers(command)) return
      end if
      code = STATUS_OK
      if (command%threads <= 1) return
      n = 1 + int(c_count_threads(int(command%threads - 1, c_int)), ip)
      if (n == command%threads) return
      call print_problem(command, SEVERITY_WARNING, 'W-THREADS', 'the system gives '//to_text(n)//' of '// &
                         to_text(command%threads)//' threads (ulimit -u, or the limit of a job); the results are the same')
      command%threads = n
   end subroutine secure_means

   !> Whether BLAS can have its buffers under the limit of the address space; it has them then.
   logical function has_buffers(command)
      type(command_t), intent(in) :: command
      integer(ip) :: fits

      do fits = command%threads, 1, -1
         if (c_has_address_space(int(bytes_of(fits), c_int64_t)) == 1) exit
      end do
      has_buffers = fits == command%threads
      if (has_buffers) then
         if (blas_buffer_bytes() > 0) call claim_blas_buffers(fits)
      else if (fits == 0) then
         call print_problem(command, SEVERITY_ERROR, 'E-MEMORY', 'the linear algebra needs '//memory_text(bytes_of(1_ip))// &
                    ' of address space to begin with; ulimit -v is '//memory_text(address_space_limit())//', and does not leave it')
      else
         call print_problem(command, SEVERITY_ERROR, 'E-MEMORY', to_text(command%threads)//' threads need '// &
                            memory_text(bytes_of(command%threads))//' of address space to begin with; ulimit -v is '// &
                            memory_text(address_space_limit())//', and does not leave it; --threads '//to_text(fits)//' fits')
      end if

   contains

      integer(lp) function bytes_of(n)
         integer(ip), intent(in) :: n

         bytes_of = TO_BEGIN + n*blas_buffer_bytes() + (n - 1)*stack_of_thread()
      end function bytes_of

   end function has_buffers

   subroutine print_problem(command, severity, id, text)
      type(command_t), intent(in) :: command
      integer, intent(in) :: severity
      character(len=*), intent(in) :: id, text
      type(message_t) :: message

      message%severity = severity
      message%id = id
      message%file = PROGRAM_NAME
      message%text = text
      call print_message(message, command%json)
   end subroutine print_problem

   !> Comes back when nothing more is wanted.
   subroutine serve()
      type(buffer_t) :: request, answer
      type(command_t) :: command
      type(status_t) :: status
      integer(ip) :: service

      do
         call await_message()
         call receive_buffer(request, 0_ip)
         call take(request, service)
         select case (service)
         case (SERVICE_END)
            return
         case (SERVICE_PART)
            answer = buffer_t()
            call answer_question(request, answer)
            call send_buffer(answer, 0_ip)
         case (SERVICE_FIELDS)
            call answer_fields(request, answer)
            call send_buffer(answer, 0_ip)
         case (SERVICE_MEMORY)
            call serve_memory()
         case (SERVICE_RUNS)
            call take_request(request, command)
            call confine_command(command, status)   ! rank 0 has told what is wrong
            if (command%task == TASK_SWEEP) call serve_sweep(command)
            if (command%task == TASK_STUDY) call serve_study(command)
         case default
            error stop 'atrito_service: an unknown service is wanted'
         end select
      end do
   end subroutine serve

end module atrito_driver
