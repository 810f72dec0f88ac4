!> A copy of this process that does one task after the other, and keeps what it has made for the next one. Should it crash, the
!> task is lost and nothing else: whoever made it goes on, and makes another copy.
!>
!> The two share a few pages of memory: the task, and the bytes of its answer. Both look again and again whether there is something
!> new, and sleep in between.
module atrito_task_process
   use, intrinsic :: iso_c_binding, only: c_double, c_f_pointer, c_int, c_loc
   use, intrinsic :: iso_fortran_env, only: int8
   use atrito_kinds, only: ip, lp
   use atrito_buffer, only: buffer_t, make_buffer, buffer_bytes
   use atrito_processes, only: begin_worker, end_worker, share_integers
   use atrito_status, only: STATUS_INTERNAL
   use atrito_system, only: get_shared, maker_number, pause_for, process_number, set_shared, swap_shared, worker_end
   implicit none (type, external)
   private
   public :: task_process_t, begin_task_process, give_task, ask_answer, end_task_process, await_task, give_answer
   public :: LAST_TASK

   !> A copy of this process, as its maker sees it and as it sees itself.
   type :: task_process_t
      logical :: runs = .false.                    !< it has been begun, and not been ended
      integer, private :: number = 0               !< of the process
      integer, private :: maker = 0                !< of the one that made it
      integer(c_int), pointer, private :: shared(:) => null() !< HEAD numbers, then the answer; not associated: no copy yet
   end type task_process_t

   integer(ip), parameter :: LAST_TASK = -1_ip      !< there is nothing more to do
   real(c_double), parameter :: SHORT_PAUSE = 1.0e-4_c_double, LONG_PAUSE = 2.0e-3_c_double    !< [s]
   real(c_double), parameter :: LONGER = 1.1_c_double   !< than the pause before
   !> Places in what is shared: the task, whether there is an answer, its length in bytes. The answer follows.
   integer, parameter :: NEXT = 1, ANSWERED = 2, LENGTH = 3, HEAD = 4
   integer(ip), parameter :: MOST_NUMBERS = 65536_ip    !< of an answer; the system has pages for those that are used
   integer(lp), parameter :: NUMBER_BYTES = 4_lp

contains

   !> Makes the copy. is_copy tells which of the two this is. Where the system makes none, it does not run.
   subroutine begin_task_process(process, is_copy)
      type(task_process_t), intent(inout) :: process !< runs where there is a copy
      logical, intent(out) :: is_copy                !< true in the copy, false in its maker

      is_copy = .false.
      if (.not. associated(process%shared)) call share_integers(HEAD + MOST_NUMBERS, process%shared)
      if (.not. associated(process%shared)) return
      process%shared(:HEAD) = 0
      process%maker = process_number()
      call begin_worker(is_copy, process%runs, process%number)
      if (.not. is_copy) return
      if (maker_number() /= process%maker) call end_worker()
   end subroutine begin_task_process

   !> To a copy that has answered the one before.
   subroutine give_task(process, task)
      type(task_process_t), intent(inout) :: process !< runs, and has no task
      integer(ip), intent(in) :: task               !< /= 0

      call set_shared(process%shared(NEXT), int(task, c_int))
   end subroutine give_task

   !> Whether the task is done, or lost: then the copy is gone, and the answer is empty.
   subroutine ask_answer(process, answer, is_done, end_code)
      type(task_process_t), intent(inout) :: process !< runs false where the copy is gone
      type(buffer_t), intent(out), target :: answer !< empty while it is not done, and of a lost task
      logical, intent(out) :: is_done               !< answered, or lost
      integer, intent(out) :: end_code              !< of a copy that is gone, as that of worker_end, never 0; else 0
      integer :: ended
      integer(int8), pointer :: bytes(:), found(:)

      end_code = 0
      ended = -1
      is_done = get_shared(process%shared(ANSWERED)) == 1
      if (.not. is_done) then
         ended = worker_end(process%number)
         ! the copy may have answered and crashed just now
         is_done = get_shared(process%shared(ANSWERED)) == 1
      end if
      if (is_done) then
         call make_buffer(int(process%shared(LENGTH), lp), answer)
         bytes => buffer_bytes(answer)
         found => shared_bytes(process, size(bytes, kind=lp))
         bytes = found
         call set_shared(process%shared(ANSWERED), 0_c_int)
      else if (ended >= 0) then
         is_done = .true.
         process%runs = .false.
         end_code = merge(STATUS_INTERNAL, ended, ended == 0)
      end if
   end subroutine ask_answer

   !> Has a copy end that has nothing to do, and waits for it.
   subroutine end_task_process(process)
      type(task_process_t), intent(inout) :: process !< of any state; does not run on return

      if (.not. process%runs) return
      call give_task(process, LAST_TASK)
      do while (worker_end(process%number) < 0)
         call pause_for(SHORT_PAUSE)
      end do
      process%runs = .false.
   end subroutine end_task_process

   !> In the copy: waits for a task. It ends where there is nothing more to do, or nobody who wants it.
   subroutine await_task(process, task)
      type(task_process_t), intent(inout) :: process !< the copy's own
      integer(ip), intent(out) :: task               !< /= 0
      real(c_double) :: wait_time

      wait_time = SHORT_PAUSE
      do
         task = int(swap_shared(process%shared(NEXT), 0_c_int), ip)
         if (task == LAST_TASK .or. maker_number() /= process%maker) call end_worker()
         if (task /= 0) return
         call pause_for(wait_time)
         wait_time = min(LONG_PAUSE, LONGER*wait_time)
      end do
   end subroutine await_task

   !> In the copy: hands the answer over.
   subroutine give_answer(process, answer)
      type(task_process_t), intent(inout) :: process !< the copy's own
      type(buffer_t), intent(in), target :: answer   !< at most 4 MOST_NUMBERS bytes
      integer(int8), pointer :: bytes(:), room(:)

      bytes => buffer_bytes(answer)
      if (size(bytes, kind=lp) > NUMBER_BYTES*MOST_NUMBERS) error stop 'atrito_task_process: an answer is too long'
      room => shared_bytes(process, size(bytes, kind=lp))
      room = bytes
      process%shared(LENGTH) = int(size(bytes), c_int)
      call set_shared(process%shared(ANSWERED), 1_c_int)
   end subroutine give_answer

   !> The bytes of the answer.
   function shared_bytes(process, n) result(bytes)
      type(task_process_t), intent(in) :: process
      integer(lp), intent(in) :: n
      integer(int8), pointer :: bytes(:)

      call c_f_pointer(c_loc(process%shared(HEAD + 1)), bytes, [n])
   end function shared_bytes

end module atrito_task_process
