!> Processes side by side on one machine: workers, each with its own copy of everything made so far (fork of POSIX), and commands
!> of the shell. All of them end when this process is interrupted.
module atrito_processes
   use, intrinsic :: iso_c_binding, only: c_associated, c_f_pointer, c_int, c_null_char, c_ptr, c_size_t
   use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
   use atrito_kinds, only: ip, wp
   use atrito_system, only: c_begin_worker, c_end_worker, await_workers, c_run_command, c_share_memory
   implicit none (type, external)
   private
   public :: begin_worker, end_worker, await_workers, share_integers, run_command, TOO_LATE

   integer, parameter :: TOO_LATE = 124               !< the time was over, and the command was ended

contains

   !> Makes a worker. is_worker tells whom of the two this is; made is false when there is no worker.
   subroutine begin_worker(is_worker, made, number)
      logical, intent(out) :: is_worker, made          !< this process is the new one; there is a new one
      integer, intent(out), optional :: number         !< of the worker's process
      integer :: id

      call flush_output()
      id = c_begin_worker()
      is_worker = id == 0
      made = id >= 0
      if (present(number)) number = id
   end subroutine begin_worker

   !> Ends a worker. It leaves no word: what it found stands in its files and in shared integers.
   subroutine end_worker()

      call flush_output()
      call c_end_worker()
   end subroutine end_worker

   subroutine flush_output()
      integer :: ios

      flush (output_unit, iostat=ios)
      flush (error_unit, iostat=ios)
   end subroutine flush_output

   !> Has the shell run a command and waits for its end, no longer than so many seconds.
   subroutine run_command(command, seconds, code)
      character(len=*), intent(in) :: command          !< as the shell takes it
      real(wp), intent(in) :: seconds                  !< after which it is ended [s]
      integer, intent(out) :: code                     !< exit code; 128 and the number of the signal that ended it; TOO_LATE

      call flush_output()
      code = c_run_command(command//c_null_char, seconds)
   end subroutine run_command

   !> Integers that all workers to come see and change. Not associated: the system has none.
   subroutine share_integers(n, list)
      integer(ip), intent(in) :: n                     !< > 0
      integer(c_int), pointer, intent(out) :: list(:)  !< (n), all 0
      type(c_ptr) :: memory

      nullify (list)
      memory = c_share_memory(4_c_size_t*int(n, c_size_t))
      if (c_associated(memory)) call c_f_pointer(memory, list, [n])
   end subroutine share_integers

end module atrito_processes
