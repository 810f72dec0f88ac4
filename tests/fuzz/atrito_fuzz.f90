!> Reads mutated decks, many in one process, and checks what must hold of every reading. docs/verification/fuzzing.md
!>
!>     atrito_fuzz [--seed S] [--count N] [--first K] [--one K] [--solve] [--keep] [--write FILE] [--seconds T] DECK...
!>[MESH.msh...]
!> Mutation K of seed S is the same on every machine. `--one K` does it alone, tells its messages and leaves the deck in FILE.
!> With meshes it is they that are mutated, the deck that includes them less often; the mesh is left in FILE.msh.
!> `--keep` only writes all mutated decks, to FILE.K, for run-program.sh.
program atrito_fuzz
   use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
   use atrito_body_cache, only: body_cache_t
   use atrito_build_model, only: build_model
   use atrito_deck, only: deck_t
   use atrito_files, only: read_file, remove_file
   use atrito_kinds, only: ip, lp, wp
   use atrito_messages, only: clear_messages, count_messages, get_message, format_message, SEVERITY_ERROR
   use atrito_model, only: model_t
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_reader, only: read_deck
   use atrito_reporter, only: reporter_t
   use atrito_results, only: results_t
   use atrito_solve, only: solve_static, solve_options_t
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_system, only: peak_memory
   use atrito_timers, only: reset_timers
   use fuzz_checks, only: check_reading, check_model, check_results
   use fuzz_meshes, only: choose_mesh, mutate_mesh
   use fuzz_mutations, only: mutate_deck, mutate_once
   use fuzz_random, only: random_t, begin_random, random_integer, random_chance
   use fuzz_watch, only: begin_watch, watch_mutation, end_watch
   use fuzz_words, only: dictionary_t, build_dictionary
   implicit none (type, external)

   !> What the command line asks for.
   type :: task_t
      integer(ip) :: seed = 1, first = 1, count = 1000, seconds = 10
      logical :: alone = .false., solve = .false., keep = .false.
      character(len=:), allocatable :: path
      type(string_t), allocatable :: decks(:)
      type(string_t), allocatable :: meshes(:), names(:) !< files of Gmsh, and what decks call them
   end type task_t

   !> What came of the mutations.
   type :: tally_t
      integer(ip) :: done = 0, sound = 0, solved = 0, failed = 0
      integer(lp) :: errors = 0
      integer(ip) :: slowest = 0                       !< the mutation that took longest
      real(wp) :: longest = 0.0_wp                     !< seconds of processor
   end type tally_t

   !> A mutated deck is small: a model of more than this is refused for want of memory.
   integer(lp), parameter :: MEMORY = 30000000_lp
   !> Solved are models of at most so many nodes.
   integer(ip), parameter :: MOST_SOLVED = 2000
   integer(ip), parameter :: MOST_LEVELS = 2
   !> What a deck calls itself that includes itself; the fuzzer's own decks have this name by default.
   character(len=*), parameter :: OWN_NAME = 'fuzz-deck.inp'
   !> What its mesh has behind that.
   character(len=*), parameter :: MESH_END = '.msh'
   type(task_t) :: task
   type(tally_t) :: tally
   type(dictionary_t) :: dictionary
   integer(ip) :: k
   real(wp) :: start

   call read_command(task)
   call build_dictionary(dictionary)
   call begin_watch()
   do k = task%first, task%first + task%count - 1
      call watch_mutation('--seed '//to_text(task%seed)//' --one '//to_text(k), int(task%seconds))
      call cpu_time(start)
      call do_mutation(task, dictionary, k, tally)
      call note_time(start, k, tally)
      call end_watch()
   end do
   if (.not. task%alone) then
      call remove_file(task%path)
      if (size(task%meshes) > 0) call remove_file(task%path//MESH_END)
   end if
   if (task%keep) stop
   write (output_unit, '(*(g0))') 'seed ', task%seed, ', mutations ', task%first, ' to ', task%first + task%count - 1, ': ', &
      tally%sound, ' without error, ', tally%solved, ' solved, ', tally%errors, ' errors told, ', tally%failed, &
      ' failed; peak memory ', peak_memory()/1048576_lp, ' MiB; slowest ', tally%slowest
   flush (output_unit)
   if (tally%failed > 0) stop 1, quiet = .true.

contains

   subroutine do_mutation(task, dictionary, k, tally)
      type(task_t), intent(in) :: task
      type(dictionary_t), intent(in) :: dictionary
      integer(ip), intent(in) :: k
      type(tally_t), intent(inout) :: tally
      type(random_t) :: random
      type(deck_t) :: deck
      type(status_t) :: status
      type(model_t) :: model
      character(len=:), allocatable :: text, mesh, fault
      type(string_t) :: no_settings(0)
      integer(ip) :: levels

      call begin_random(random, task%seed, k)
      call make_deck(random, task, dictionary, text, mesh)
      if (task%keep) then
         call write_deck(task%path//'.'//to_text(k), text)
         if (allocated(mesh)) call write_deck(task%path//'.'//to_text(k)//MESH_END, mesh)
         return
      end if
      call random_integer(random, -7_ip, MOST_LEVELS, levels)
      call write_deck(task%path, text)
      if (allocated(mesh)) call write_deck(task%path//MESH_END, mesh)
      call clear_messages()
      call reset_timers()
      call read_deck(task%path, no_settings, deck, status)
      call build_model(deck, model, max(levels, 0_ip), MEMORY)
      call check_reading(deck, status, fault)
      tally%done = tally%done + 1
      tally%errors = tally%errors + count_messages(SEVERITY_ERROR)
      if (count_messages(SEVERITY_ERROR) == 0 .and. .not. allocated(fault)) then
         tally%sound = tally%sound + 1
         call check_model(model, fault)
         if (task%solve .and. model%mesh%n_nodes <= MOST_SOLVED .and. .not. allocated(fault)) then
            call solve_model(model, fault)
            tally%solved = tally%solved + 1
         end if
      end if
      if (task%alone) call tell_messages()
      if (.not. allocated(fault)) return
      tally%failed = tally%failed + 1
      write (error_unit, '(a)') 'FAILED: --seed '//to_text(task%seed)//' --one '//to_text(k)//': '//fault
   end subroutine do_mutation

   !> A mutated deck; with meshes a mutated mesh and the deck that includes it, in which one time in four something is changed.
   subroutine make_deck(random, task, dictionary, text, mesh)
      type(random_t), intent(inout) :: random
      type(task_t), intent(in) :: task
      type(dictionary_t), intent(in) :: dictionary
      character(len=:), allocatable, intent(out) :: text, mesh
      integer(ip) :: i
      logical :: hit

      if (size(task%meshes) == 0) then
         call mutate_deck(random, task%decks, dictionary, OWN_NAME, text)
         return
      end if
      call random_integer(random, 1_ip, size(task%decks, kind=ip), i)
      text = task%decks(i)%s
      call choose_mesh(task%names, task%meshes, mesh_name(task), text, mesh)
      call mutate_mesh(random, task%meshes, mesh)
      call random_chance(random, 4_ip, hit)
      if (hit) call mutate_once(random, task%decks, dictionary, OWN_NAME, text)
   end subroutine make_deck

   !> What the deck calls the mesh, which lies beside it. run-program.sh gives kept decks their own name.
   function mesh_name(task) result(name)
      type(task_t), intent(in) :: task
      character(len=:), allocatable :: name

      name = OWN_NAME//MESH_END
      if (.not. task%keep) name = base_name(task%path)//MESH_END
   end function mesh_name

   pure function base_name(path) result(name)
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: name

      name = path(scan(path, '/', back=.true.) + 1:)
   end function base_name

   subroutine note_time(start, k, tally)
      real(wp), intent(in) :: start
      integer(ip), intent(in) :: k
      type(tally_t), intent(inout) :: tally
      real(wp) :: now

      call cpu_time(now)
      if (now - start <= tally%longest) return
      tally%longest = now - start
      tally%slowest = k
      if (task%alone) write (error_unit, '(*(g0))') now - start, ' s'
   end subroutine note_time

   subroutine solve_model(model, fault)
      type(model_t), intent(in) :: model
      character(len=:), allocatable, intent(inout) :: fault
      type(solve_options_t) :: options
      type(reporter_t) :: reporter
      type(results_t) :: results
      type(body_cache_t) :: store
      type(status_t) :: status

      reporter%quiet = .true.
      call solve_static(model, options, reporter, results, status, store)
      call check_results(results, status, fault)
   end subroutine solve_model

   !> The mutated deck to its file, byte by byte.
   subroutine write_deck(path, text)
      character(len=*), intent(in) :: path, text
      integer :: unit

      open (newunit=unit, file=path, access='stream', form='unformatted', status='replace', action='write')
      write (unit) text
      close (unit)
   end subroutine write_deck

   subroutine tell_messages()
      type(string_t), allocatable :: lines(:)
      integer(ip) :: i, j

      do i = 1, count_messages()
         lines = format_message(get_message(i))
         do j = 1, size(lines, kind=ip)
            write (error_unit, '(a)') lines(j)%s
         end do
      end do
   end subroutine tell_messages

   subroutine read_command(task)
      type(task_t), intent(out) :: task
      integer :: i

      task%path = OWN_NAME
      allocate (task%decks(0), task%meshes(0), task%names(0))
      i = 1
      do while (i <= command_argument_count())
         select case (argument(i))
         case ('--seed')
            task%seed = number(i + 1)
         case ('--count')
            task%count = number(i + 1)
         case ('--first')
            task%first = number(i + 1)
         case ('--seconds')
            task%seconds = number(i + 1)
         case ('--one')
            task%first = number(i + 1)
            task%count = 1
            task%alone = .true.
         case ('--write')
            task%path = argument(i + 1)
         case ('--keep')
            task%keep = .true.
            i = i - 1
         case ('--solve')
            task%solve = .true.
            i = i - 1
         case default
            call take_deck(argument(i), task)
            i = i - 1
         end select
         i = i + 2
      end do
      if (size(task%decks) == 0) error stop 'atrito_fuzz: no deck'
   end subroutine read_command

   subroutine take_deck(path, task)
      character(len=*), intent(in) :: path
      type(task_t), intent(inout) :: task
      character(len=:), allocatable :: text
      type(status_t) :: status

      call read_file(path, text, status)
      if (.not. is_ok(status)) error stop 'atrito_fuzz: a deck or option that cannot be read'
      if (index(path, MESH_END, back=.true.) == len(path) - len(MESH_END) + 1) then
         call append_string(task%meshes, text)
         call append_string(task%names, base_name(path))
      else
         call append_string(task%decks, text)
      end if
   end subroutine take_deck

   function argument(i) result(text)
      integer, intent(in) :: i
      character(len=:), allocatable :: text
      integer :: length

      call get_command_argument(i, length=length)
      allocate (character(len=length) :: text)
      call get_command_argument(i, text)
   end function argument

   integer(ip) function number(i)
      integer, intent(in) :: i
      integer :: outcome

      call read_integer(argument(i), number, outcome)
      if (outcome /= NUMBER_OK) error stop 'atrito_fuzz: a number is expected'
   end function number

end program atrito_fuzz
