!> Processes side by side on one machine, each with its own copy of everything made so far (fork of POSIX).
module atrito_processes
   use, intrinsic :: iso_c_binding, only: c_int, c_long, c_ptr, c_size_t, c_null_ptr, c_f_pointer, c_intptr_t
   use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: begin_worker, end_worker, await_workers, share_integers

   interface
      integer(c_int) function c_fork() bind(C, name='fork')
         import :: c_int
      end function c_fork
      integer(c_int) function c_wait(state) bind(C, name='wait')
         import :: c_int
         integer(c_int), intent(out) :: state
      end function c_wait
      subroutine c_exit_now(code) bind(C, name='_exit')
         import :: c_int
         integer(c_int), value :: code
      end subroutine c_exit_now
      type(c_ptr) function c_mmap(address, length, protection, flags, file, offset) bind(C, name='mmap')
         import :: c_ptr, c_size_t, c_int, c_long
         type(c_ptr), value :: address
         integer(c_size_t), value :: length
         integer(c_int), value :: protection, flags, file
         integer(c_long), value :: offset
      end function c_mmap
   end interface

contains

   !> Makes a worker. is_worker tells whom of the two this is; made is false when there is no worker.
   subroutine begin_worker(is_worker, made)
      logical, intent(out) :: is_worker, made
      integer(c_int) :: id

      flush (output_unit)
      flush (error_unit)
      id = c_fork()
      is_worker = id == 0_c_int
      made = id >= 0_c_int
   end subroutine begin_worker

   !> Ends a worker. It leaves no word: what it found stands in its files and in shared integers.
   subroutine end_worker()
      flush (output_unit)
      flush (error_unit)
      call c_exit_now(0_c_int)
   end subroutine end_worker

   !> Waits until all workers have ended.
   subroutine await_workers()
      integer(c_int) :: state

      do while (c_wait(state) > 0_c_int)
      end do
   end subroutine await_workers

   !> Integers that all workers to come see and change. Not associated: the system has none.
   subroutine share_integers(n, list)
      integer(ip), intent(in) :: n                     !< > 0
      integer(c_int), pointer, intent(out) :: list(:)  !< (n), all 0
      integer(c_int), parameter :: READ_AND_WRITE = 3_c_int, SHARED_AND_ANONYMOUS = 33_c_int, NO_FILE = -1_c_int
      type(c_ptr) :: memory

      nullify (list)
      memory = c_mmap(c_null_ptr, 4_c_size_t*int(n, c_size_t), READ_AND_WRITE, SHARED_AND_ANONYMOUS, NO_FILE, 0_c_long)
      if (transfer(memory, 0_c_intptr_t) == -1_c_intptr_t) return
      call c_f_pointer(memory, list, [n])
   end subroutine share_integers

end module atrito_processes
