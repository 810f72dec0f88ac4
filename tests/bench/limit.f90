!> What one linear solve of a deck's scene costs, by which a run of the program is measured (docs/performance.md): the bodies are
!> glued together along their contact pairs, assembled, ordered, factored by MUMPS and solved once, with one thread.
!>
!>    limit DECK.inp [--ordering amd|metis] [--numbering deck|backward|bodies] [--set NAME=VALUE] [--refine K]
!>    limit DECK.inp --count [--set NAME=VALUE] [--refine K]
!>
!> --ordering   MUMPS's minimum degree (default), or METIS, whose time is counted. One process, one order: its peak memory is its
!> own --numbering  of the equations: nodes as in the deck (default), backward, or the last body first
!> --count      solves nothing, and tells the operations of the factorisation: AMD for each numbering, METIS
!>
!> Exit codes are those of atrito; bodies that cannot be glued are 1.
program limit
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
   use atrito_blas_info, only: choose_blas_kernels, set_blas_threads
   use atrito_command_line, only: command_t, fetch_arguments
   use atrito_console, only: print_status
   use atrito_kinds, only: ip, lp, wp
   use atrito_messages, only: clear_messages
   use atrito_model, only: model_t
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_page, only: page_t, print_page
   use atrito_reporter, only: reporter_t
   use atrito_load_model, only: load_model
   use atrito_status, only: status_t, is_ok, STATUS_OK, STATUS_USAGE
   use atrito_strings, only: string_t, append_string
   use atrito_threads, only: set_threads
   use atrito_timers, only: reset_timers
   use glued_bodies, only: NUMBERINGS
   use linear_solve, only: plan_t, solve_facts_t, solve_once, count_operations, ORDERINGS
   use linear_solve_page, only: compose_solve
   implicit none (type, external)
   type(command_t) :: command
   type(plan_t) :: plan
   type(model_t) :: model
   type(reporter_t) :: reporter
   type(status_t) :: status
   integer(lp) :: begun
   integer(ip) :: told
   integer :: code
   logical :: counts, ok

   call system_clock(begun)
   call set_blas_threads(1_ip)
   call choose_blas_kernels()
   call set_threads(1_ip)
   call clear_messages()
   call reset_timers()
   call read_arguments(ok)
   if (.not. ok) then
      write (error_unit, '(a)') 'usage: limit DECK.inp [--ordering amd|metis] [--numbering deck|backward|bodies] '// &
         '[--set NAME=VALUE] [--refine K] | limit DECK.inp --count [...]'
      stop STATUS_USAGE, quiet = .true.
   end if
   reporter%quiet = .true.
   command%quiet = .true.
   call load_model(command, reporter, model, told, code)
   if (code == STATUS_OK) then
      if (counts) then
         call count_all()
      else
         call solve_and_tell()
      end if
      if (.not. is_ok(status)) call print_status(status, command%names(1)%s, command%json)
      code = status%code
   end if
   stop code, quiet = .true.

contains

   subroutine read_arguments(ok)
      logical, intent(out) :: ok
      type(string_t), allocatable :: arguments(:)
      integer :: i

      call fetch_arguments(arguments)
      allocate (command%names(0), command%settings(0))
      counts = .false.
      ok = .true.
      i = 0
      do while (i < size(arguments) .and. ok)
         i = i + 1
         select case (arguments(i)%s)
         case ('--count')
            counts = .true.
         case ('--ordering', '--numbering', '--set', '--refine')
            ok = i < size(arguments)
            if (ok) call take_value(arguments(i)%s, arguments(i + 1)%s, ok)
            i = i + 1
         case default
            ok = index(arguments(i)%s, '-') /= 1
            call append_string(command%names, arguments(i)%s)
         end select
      end do
      ok = ok .and. size(command%names) == 1
   end subroutine read_arguments

   subroutine take_value(option, value, ok)
      character(len=*), intent(in) :: option, value
      logical, intent(out) :: ok
      integer :: status

      ok = .true.
      select case (option)
      case ('--ordering')
         plan%ordering = findloc(ORDERINGS == value, .true., dim=1)
         ok = plan%ordering > 0
      case ('--numbering')
         plan%numbering = findloc(NUMBERINGS == value, .true., dim=1)
         ok = plan%numbering > 0
      case ('--set')
         call append_string(command%settings, value)
      case ('--refine')
         call read_integer(value, command%refine, status)
         ok = status == NUMBER_OK .and. command%refine >= 0
      end select
   end subroutine take_value

   subroutine solve_and_tell()
      type(solve_facts_t) :: facts
      type(page_t) :: page
      integer(lp) :: ended, rate

      call solve_once(model, plan, facts, status)
      if (.not. is_ok(status)) return
      call system_clock(ended, rate)
      call compose_solve(command%names(1)%s, plan, facts, real(ended - begun, wp)/real(rate, wp), page)
      call print_page(page, output_unit)
   end subroutine solve_and_tell

   subroutine count_all()
      real(wp) :: amd_operations(size(NUMBERINGS)), metis_operations
      integer :: i

      call count_operations(model, amd_operations, metis_operations, status)
      if (.not. is_ok(status)) return
      do i = 1, size(NUMBERINGS)
         write (output_unit, '(a, 1x, a8, es11.3)') 'amd  ', NUMBERINGS(i), amd_operations(i)
      end do
      if (metis_operations >= 0.0_wp) write (output_unit, '(a, 1x, a8, es11.3)') 'metis', NUMBERINGS(1), metis_operations
   end subroutine count_all

end program limit
