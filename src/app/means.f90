!> What a run needs of the process besides memory for its scene, asked before anything is computed: libraries that do not get it
!> hang or end the program.
module atrito_means
   use, intrinsic :: iso_c_binding, only: c_int, c_int64_t
   use atrito_blas_info, only: blas_buffer_bytes, claim_blas_buffers
   use atrito_command_line, only: command_t
   use atrito_console, only: print_message
   use atrito_kinds, only: ip, lp
   use atrito_memory, only: memory_text
   use atrito_messages, only: message_t, SEVERITY_ERROR, SEVERITY_WARNING
   use atrito_status, only: STATUS_DECK, STATUS_OK
   use atrito_strings, only: to_text
   use atrito_system, only: address_space_limit, c_count_threads, c_has_address_space, stack_limit, stack_of_thread
   use atrito_version, only: PROGRAM_NAME
   implicit none (type, external)
   private
   public :: secure_means

   !> The stack that the program wants; the least with which scenes were solved is 192 KiB.
   integer(lp), parameter :: LEAST_STACK = 2_lp**19
   !> Address space to read a deck with.
   integer(lp), parameter :: TO_BEGIN = 2_lp**22

contains

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

end module atrito_means
