!> Processes side by side on one machine: workers, each with its own copy of everything made so far (fork of POSIX), and commands
!> of the shell. All of them end when this process is interrupted.
module atrito_processes
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_long, c_loc, c_ptr, c_size_t, c_null_char, c_null_ptr, c_f_pointer, &
                                                                             c_intptr_t
   use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
   use atrito_interrupts, only: hold_interrupts, release_interrupts, forget_everything, note_worker, note_group, forget_child
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: begin_worker, end_worker, await_workers, share_integers, run_command, begin_anew

   integer(c_int), parameter :: NO_PROGRAM = 127_c_int      !< the shell's code for a program that is not there

   interface
      integer(c_int) function c_fork() bind(C, name='fork')
         import :: c_int
      end function c_fork
      integer(c_int) function c_wait(state) bind(C, name='wait')
         import :: c_int
         integer(c_int), intent(out) :: state
      end function c_wait
      integer(c_int) function c_waitpid(process, state, options) bind(C, name='waitpid')
         import :: c_int
         integer(c_int), value :: process, options
         integer(c_int), intent(out) :: state
      end function c_waitpid
      integer(c_int) function c_setpgid(process, group) bind(C, name='setpgid')
         import :: c_int
         integer(c_int), value :: process, group
      end function c_setpgid
      integer(c_int) function c_execv(path, words) bind(C, name='execv')
         import :: c_char, c_int, c_ptr
         character(kind=c_char), intent(in) :: path(*)
         type(c_ptr), intent(in) :: words(*)
      end function c_execv
      integer(c_int) function c_setenv(name, value, replace) bind(C, name='setenv')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: name(*), value(*)
         integer(c_int), value :: replace
      end function c_setenv
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
      integer :: ios

      flush (output_unit, iostat=ios)
      flush (error_unit, iostat=ios)
      call hold_interrupts()
      id = c_fork()
      is_worker = id == 0_c_int
      made = id >= 0_c_int
      if (is_worker) then
         call forget_everything()
      else if (made) then
         call note_worker(id)
      end if
      call release_interrupts()
   end subroutine begin_worker

   !> Ends a worker. It leaves no word: what it found stands in its files and in shared integers.
   subroutine end_worker()
      integer :: ios

      flush (output_unit, iostat=ios)
      flush (error_unit, iostat=ios)
      call c_exit_now(0_c_int)
   end subroutine end_worker

   !> Waits until all workers have ended.
   subroutine await_workers()
      integer(c_int) :: state, id

      do
         id = c_wait(state)
         if (id <= 0_c_int) exit
         call forget_child(id)
      end do
   end subroutine await_workers

   !> Has the shell run a command and waits for its end. The command is a group of processes of its own: a signal from the terminal
   !> comes to this process alone, which ends the group.
   subroutine run_command(command, code)
      character(len=*), intent(in) :: command
      integer, intent(out) :: code                     !< exit code; 128 and the number of the signal that ended it
      character(len=:), allocatable, target :: words(:)
      type(c_ptr) :: arguments(4)
      integer(c_int) :: id, state, ignored
      integer :: ios
      character(len=*), parameter :: SHELL = '/bin/sh'//c_null_char

      code = int(NO_PROGRAM)
      allocate (character(len=len(command) + 1) :: words(3))
      words(1) = 'sh'//c_null_char
      words(2) = '-c'//c_null_char
      words(3) = command//c_null_char
      arguments = [c_loc(words(1)), c_loc(words(2)), c_loc(words(3)), c_null_ptr]
      flush (output_unit, iostat=ios)
      flush (error_unit, iostat=ios)
      call hold_interrupts()
      id = c_fork()
      if (id == 0_c_int) then
         ignored = c_setpgid(0_c_int, 0_c_int)
         ignored = c_execv(SHELL, arguments)
         call c_exit_now(NO_PROGRAM)
      end if
      if (id > 0_c_int) then
         ignored = c_setpgid(id, id)                   ! here, too: nobody knows who comes first
         call note_group(id)
      end if
      call release_interrupts()
      if (id < 0_c_int) return
      if (c_waitpid(id, state, 0_c_int) == id) code = code_of(state)
      call forget_child(id)
   end subroutine run_command

   !> Begins this program anew, with the same command line and one variable of the environment more. Returns where that cannot be.
   subroutine begin_anew(name, value)
      character(len=*), intent(in) :: name, value
      character(len=:), allocatable, target :: words(:)
      type(c_ptr) :: arguments(command_argument_count() + 2)
      integer(c_int) :: ignored
      integer :: i, length, longest, ios
      character(len=*), parameter :: THIS_PROGRAM = '/proc/self/exe'//c_null_char

      longest = 0
      do i = 0, command_argument_count()
         call get_command_argument(i, length=length)
         longest = max(longest, length)
      end do
      allocate (character(len=longest + 1) :: words(command_argument_count() + 1))
      do i = 1, size(words)
         call get_command_argument(i - 1, words(i), length)
         words(i) (length + 1:) = c_null_char
         arguments(i) = c_loc(words(i))
      end do
      arguments(size(arguments)) = c_null_ptr
      flush (output_unit, iostat=ios)
      flush (error_unit, iostat=ios)
      if (c_setenv(name//c_null_char, value//c_null_char, 1_c_int) == 0_c_int) ignored = c_execv(THIS_PROGRAM, arguments)
   end subroutine begin_anew

   !> The state that waitpid gives, as a shell tells it.
   pure integer function code_of(state) result(code)
      integer(c_int), intent(in) :: state

      code = int(iand(state, 127_c_int))
      if (code > 0) then
         code = 128 + code
      else
         code = int(iand(ishft(state, -8), 255_c_int))
      end if
   end function code_of

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
