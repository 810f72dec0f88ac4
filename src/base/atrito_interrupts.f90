!> What happens when the program is ended from outside (SIGINT, SIGTERM, SIGHUP) or by a fault of its own (SIGSEGV and the like):
!> files that are not complete are removed, folders that were made for them and are empty too, and workers end first.
!>
!> A factorisation may take minutes, so a handler does all this at once rather than set a flag for the next phase. It may only call
!> what POSIX calls async-signal-safe: no allocation, no Fortran output. What is to be removed therefore stands ready as C strings,
!> and hold_interrupts puts off the end where half of the work would be worse than all or none of it.
!>
!> The structures are those of the C libraries of Linux.
module atrito_interrupts
   use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_procpointer, c_funloc, c_funptr, c_int, c_intptr_t, c_loc, &
                                                                     c_long, c_null_char, c_null_funptr, c_null_ptr, c_ptr, c_size_t
   use atrito_status, only: STATUS_INTERNAL
   implicit none (type, external)
   private
   public :: guard_interrupts, hold_interrupts, release_interrupts, forget_everything
   public :: note_file, forget_file, note_folder, forget_folder, note_worker, note_group, forget_child

   integer(c_int), parameter :: SIGHUP = 1, SIGINT = 2, SIGILL = 4, SIGBUS = 7, SIGFPE = 8, SIGKILL = 9, SIGSEGV = 11, &
                                SIGTERM = 15, SIGCONT = 18
   integer(c_int), parameter :: ENDINGS(3) = [SIGHUP, SIGINT, SIGTERM]
   integer(c_int), parameter :: FAULTS(4) = [SIGILL, SIGBUS, SIGFPE, SIGSEGV]
   integer(c_int), parameter :: CODE_OF_SIGNAL = 128        !< plus its number: the exit code, as the shell tells it
   integer(c_int), parameter :: STANDARD_ERROR = 2
   integer(c_intptr_t), parameter :: SIG_IGN = 1
   integer(c_int), parameter :: SA_SIGINFO = 4, SA_ONSTACK = int(z'08000000', c_int), SA_RESTART = int(z'10000000', c_int)
   integer(c_int), parameter :: AT_ONCE = 1                 ! WNOHANG
   integer(c_int), parameter :: TICK = 10                   ! ms
   integer, parameter :: WORKER_TICKS = 500, GROUP_TICKS = 200

   !> struct sigaction
   type, bind(C) :: action_t
      type(c_funptr) :: handler = c_null_funptr
      integer(c_int) :: mask(32) = 0
      integer(c_int) :: flags = 0
      type(c_funptr) :: restorer = c_null_funptr
   end type action_t

   !> stack_t
   type, bind(C) :: stack_t
      type(c_ptr) :: place = c_null_ptr
      integer(c_int) :: flags = 0
      integer(c_size_t) :: length = 0
   end type stack_t

   ! A handler has no argument but the number of the signal, hence this state. Lists of C strings that were allocated by strdup.
   type(c_ptr), allocatable :: files(:), folders(:)
   integer(c_int), allocatable :: children(:)               !< processes, and groups of processes as negative numbers
   integer, volatile :: n_files = 0, n_folders = 0, n_children = 0
   integer, volatile :: held = 0                            !< depth of hold_interrupts
   integer(c_int), volatile :: waiting = 0                  !< a signal that came meanwhile
   integer(c_intptr_t) :: main_thread = 0
   logical :: is_silent = .false.                           !< a worker leaves the word to the process that made it
   type(c_funptr) :: former_handler(size(FAULTS)) = c_null_funptr
   !> The stack on which a handler runs when the program's own one has overflown.
   integer(c_long), target :: spare_stack(32768)

   abstract interface
      subroutine handler_of_signal(number) bind(C)
         import :: c_int
         integer(c_int), value :: number
      end subroutine handler_of_signal
   end interface

   interface
      integer(c_int) function c_sigaction(number, action, former) bind(C, name='sigaction')
         import :: action_t, c_int
         integer(c_int), value :: number
         type(action_t), intent(in), optional :: action
         type(action_t), intent(out), optional :: former
      end function c_sigaction
      integer(c_int) function c_sigaltstack(stack, former) bind(C, name='sigaltstack')
         import :: c_int, c_ptr, stack_t
         type(stack_t), intent(in) :: stack
         type(c_ptr), value :: former
      end function c_sigaltstack
      integer(c_int) function c_atexit(handler) bind(C, name='atexit')
         import :: c_funptr, c_int
         type(c_funptr), value :: handler
      end function c_atexit
      integer(c_intptr_t) function c_pthread_self() bind(C, name='pthread_self')
         import :: c_intptr_t
      end function c_pthread_self
      integer(c_int) function c_pthread_kill(thread, number) bind(C, name='pthread_kill')
         import :: c_int, c_intptr_t
         integer(c_intptr_t), value :: thread
         integer(c_int), value :: number
      end function c_pthread_kill
      integer(c_int) function c_kill(process, number) bind(C, name='kill')
         import :: c_int
         integer(c_int), value :: process, number
      end function c_kill
      integer(c_int) function c_waitpid(process, state, options) bind(C, name='waitpid')
         import :: c_int
         integer(c_int), value :: process, options
         integer(c_int), intent(out) :: state
      end function c_waitpid
      integer(c_int) function c_poll(descriptors, n, milliseconds) bind(C, name='poll')
         import :: c_int, c_long, c_ptr
         type(c_ptr), value :: descriptors
         integer(c_long), value :: n
         integer(c_int), value :: milliseconds
      end function c_poll
      integer(c_int) function c_unlink(path) bind(C, name='unlink')
         import :: c_int, c_ptr
         type(c_ptr), value :: path
      end function c_unlink
      integer(c_int) function c_rmdir(path) bind(C, name='rmdir')
         import :: c_int, c_ptr
         type(c_ptr), value :: path
      end function c_rmdir
      integer(c_size_t) function c_write(descriptor, text, length) bind(C, name='write')
         import :: c_char, c_int, c_size_t
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: text(*)
         integer(c_size_t), value :: length
      end function c_write
      subroutine c_exit_now(code) bind(C, name='_exit')
         import :: c_int
         integer(c_int), value :: code
      end subroutine c_exit_now
      type(c_ptr) function c_strdup(text) bind(C, name='strdup')
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: text(*)
      end function c_strdup
      integer(c_int) function c_strcmp(a, b) bind(C, name='strcmp')
         import :: c_char, c_int, c_ptr
         type(c_ptr), value :: a
         character(kind=c_char), intent(in) :: b(*)
      end function c_strcmp
      subroutine c_free(place) bind(C, name='free')
         import :: c_ptr
         type(c_ptr), value :: place
      end subroutine c_free
   end interface

contains

   !> From now on the endings of this module hold. Called once, by the main thread. A signal that is ignored already (nohup, a job
   !> in the background of a script) stays so.
   subroutine guard_interrupts()
      type(action_t) :: action
      type(stack_t) :: stack
      integer :: i
      integer(c_int) :: ignored

      main_thread = c_pthread_self()
      action%flags = SA_RESTART
      action%handler = c_funloc(obey)
      do i = 1, size(ENDINGS)
         if (.not. is_ignored(ENDINGS(i))) ignored = c_sigaction(ENDINGS(i), action)
      end do
      stack%place = c_loc(spare_stack)
      stack%length = size(spare_stack, kind=c_size_t)*storage_size(spare_stack, kind=c_size_t)/8_c_size_t
      ignored = c_sigaltstack(stack, c_null_ptr)
      do i = 1, size(FAULTS)
         call guard_fault(i)
      end do
      ignored = c_atexit(c_funloc(remove_unfinished))
   end subroutine guard_interrupts

   logical function is_ignored(number)
      integer(c_int), intent(in) :: number
      type(action_t) :: present
      integer(c_int) :: ignored

      ignored = c_sigaction(number, former=present)
      is_ignored = transfer(present%handler, SIG_IGN) == SIG_IGN
   end function is_ignored

   !> The handler of the run-time library, which tells where the fault was, is called too. One of another kind, which a sanitizer
   !> sets, is left alone.
   subroutine guard_fault(i)
      integer, intent(in) :: i                       !< of FAULTS
      type(action_t) :: action, former
      integer(c_int) :: ignored

      ignored = c_sigaction(FAULTS(i), former=former)
      if (iand(former%flags, SA_SIGINFO) /= 0) return
      if (transfer(former%handler, SIG_IGN) > SIG_IGN) former_handler(i) = former%handler
      action%flags = SA_ONSTACK
      action%handler = c_funloc(fail)
      ignored = c_sigaction(FAULTS(i), action)
   end subroutine guard_fault

   !> Puts off the end by a signal until release_interrupts. Calls may be nested.
   subroutine hold_interrupts()
      held = held + 1
   end subroutine hold_interrupts

   subroutine release_interrupts()
      held = held - 1
      if (held == 0 .and. waiting /= 0) call end_by(waiting)
   end subroutine release_interrupts

   !> Threads of the linear algebra may be given the signal; hold_interrupts speaks for the main thread alone.
   subroutine obey(number) bind(C)
      integer(c_int), value :: number
      integer(c_int) :: ignored

      if (c_pthread_self() /= main_thread) then
         ignored = c_pthread_kill(main_thread, number)
      else if (held > 0) then
         waiting = number
      else
         call end_by(number)
      end if
   end subroutine obey

   subroutine end_by(number)
      integer(c_int), intent(in) :: number

      held = held + 1                                ! a second signal changes nothing
      call end_children()
      call remove_unfinished()
      select case (number)
      case (SIGINT)
         call say('atrito: error [E-INTERRUPTED] interrupted; files that were not complete are removed')
      case (SIGTERM)
         call say('atrito: error [E-INTERRUPTED] terminated; files that were not complete are removed')
      case default
         call say('atrito: error [E-INTERRUPTED] the terminal hung up; files that were not complete are removed')
      end select
      call c_exit_now(CODE_OF_SIGNAL + number)
   end subroutine end_by

   !> A fault of the program.
   subroutine fail(number) bind(C)
      integer(c_int), value :: number
      procedure(handler_of_signal), pointer :: former
      integer :: i

      call end_children()
      call remove_unfinished()
      do i = 1, size(FAULTS)
         if (FAULTS(i) /= number .or. .not. c_associated(former_handler(i))) cycle
         call c_f_procpointer(former_handler(i), former)
         former_handler(i) = c_null_funptr           ! once, should it fail itself
         call former(number)
      end do
      call say('atrito: error [E-INTERNAL] a fault of the program ended it; files that were not complete are removed')
      call c_exit_now(int(STATUS_INTERNAL, c_int))
   end subroutine fail

   !> Workers are asked to end and clean up themselves; groups, which are programs that draw, just end.
   subroutine end_children()
      integer :: i
      integer(c_int) :: ignored

      do i = 1, n_children
         ignored = c_kill(children(i), merge(SIGKILL, SIGTERM, children(i) < 0))
         if (children(i) > 0) ignored = c_kill(children(i), SIGCONT)
      end do
      do i = 1, n_children
         if (children(i) > 0) call await_worker(children(i))
         if (children(i) < 0) call await_group(-children(i))
      end do
   end subroutine end_children

   subroutine await_worker(process)
      integer(c_int), intent(in) :: process
      integer(c_int) :: state, ignored
      integer :: i

      do i = 1, WORKER_TICKS
         if (c_waitpid(process, state, AT_ONCE) /= 0) return
         ignored = c_poll(c_null_ptr, 0_c_long, TICK)
      end do
      ignored = c_kill(process, SIGKILL)
      ignored = c_waitpid(process, state, 0_c_int)
   end subroutine await_worker

   !> Waits for the first process of a group, then until the others are gone, too.
   subroutine await_group(process)
      integer(c_int), intent(in) :: process
      integer(c_int) :: state, ignored
      integer :: i

      ignored = c_waitpid(process, state, 0_c_int)
      do i = 1, GROUP_TICKS
         if (c_kill(-process, 0_c_int) /= 0) return
         ignored = c_poll(c_null_ptr, 0_c_long, TICK)
      end do
   end subroutine await_group

   subroutine remove_unfinished() bind(C)
      integer :: i
      integer(c_int) :: ignored

      do i = 1, n_files
         ignored = c_unlink(files(i))
      end do
      do i = n_folders, 1, -1
         ignored = c_rmdir(folders(i))
      end do
   end subroutine remove_unfinished

   subroutine say(text)
      character(len=*), intent(in) :: text
      integer(c_size_t) :: ignored

      if (is_silent) return
      ignored = c_write(STANDARD_ERROR, text, len(text, kind=c_size_t))
      ignored = c_write(STANDARD_ERROR, [achar(10)], 1_c_size_t)
   end subroutine say

   !> A file that is to be removed when the program ends before forget_file.
   subroutine note_file(path)
      character(len=*), intent(in) :: path

      call hold_interrupts()
      call append_text(files, n_files, path)
      call release_interrupts()
   end subroutine note_file

   subroutine forget_file(path)
      character(len=*), intent(in) :: path

      call hold_interrupts()
      call remove_text(files, n_files, path)
      call release_interrupts()
   end subroutine forget_file

   !> A folder that is to be removed when the program ends before forget_folder and it is empty then.
   subroutine note_folder(path)
      character(len=*), intent(in) :: path

      call hold_interrupts()
      call append_text(folders, n_folders, path)
      call release_interrupts()
   end subroutine note_folder

   subroutine forget_folder(path)
      character(len=*), intent(in) :: path

      call hold_interrupts()
      call remove_text(folders, n_folders, path)
      call release_interrupts()
   end subroutine forget_folder

   subroutine append_text(list, n, text)
      type(c_ptr), allocatable, intent(inout) :: list(:)
      integer, volatile, intent(inout) :: n
      character(len=*), intent(in) :: text
      type(c_ptr), allocatable :: longer(:)

      if (.not. allocated(list)) allocate (list(64))
      if (n == size(list)) then
         allocate (longer(2*n))
         longer(:n) = list
         call move_alloc(longer, list)
      end if
      list(n + 1) = c_strdup(text//c_null_char)
      if (c_associated(list(n + 1))) n = n + 1
   end subroutine append_text

   subroutine remove_text(list, n, text)
      type(c_ptr), allocatable, intent(inout) :: list(:)
      integer, volatile, intent(inout) :: n
      character(len=*), intent(in) :: text
      integer :: i

      do i = n, 1, -1
         if (c_strcmp(list(i), text//c_null_char) /= 0) cycle
         call c_free(list(i))
         list(i:n - 1) = list(i + 1:n)               ! folders keep their order
         n = n - 1
         return
      end do
   end subroutine remove_text

   !> A worker, which ends with this process.
   subroutine note_worker(process)
      integer(c_int), intent(in) :: process          !< > 0

      call append_child(process)
   end subroutine note_worker

   !> A group of processes, which ends with this process.
   subroutine note_group(process)
      integer(c_int), intent(in) :: process          !< its first process, > 0

      call append_child(-process)
   end subroutine note_group

   subroutine append_child(child)
      integer(c_int), intent(in) :: child
      integer(c_int), allocatable :: list(:)
      integer :: n

      call hold_interrupts()
      n = n_children
      allocate (list(n + 1))
      if (n > 0) list(:n) = children(:n)
      list(n + 1) = child
      call move_alloc(list, children)
      n_children = n + 1
      call release_interrupts()
   end subroutine append_child

   !> A worker, or the first process of a group, has ended.
   subroutine forget_child(process)
      integer(c_int), intent(in) :: process

      call hold_interrupts()
      children = pack(children(:n_children), abs(children(:n_children)) /= process)
      n_children = size(children)
      call release_interrupts()
   end subroutine forget_child

   !> In a new worker: files and children are those of the process that made it.
   subroutine forget_everything()
      n_files = 0
      n_folders = 0
      n_children = 0
      waiting = 0
      is_silent = .true.
   end subroutine forget_everything

end module atrito_interrupts
