!> Tasks that do not depend on each other, shared out over the ranks: whoever is free gets the next one.
!>
!> Rank 0 hands them out and does some itself. Each rank does its tasks in a process of its own (atrito_task_process), so that a
!> crash is the end of one task and not of all ranks, and so that rank 0 can hand out while it works.
module atrito_rank_tasks
   use, intrinsic :: iso_c_binding, only: c_double
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: ANY_RANK, has_message, rank_count, receive_buffer, send_buffer
   use atrito_buffer, only: buffer_t, put, take
   use atrito_rank_services, only: await_message
   use atrito_system, only: pause_for
   use atrito_task_process, only: task_process_t, begin_task_process, give_task, ask_answer, end_task_process, await_task, &
                                  give_answer, LAST_TASK
   implicit none (type, external)
   private
   public :: rank_tasks_t, rank_times_t, hand_out, work_for_first

   !> What the tasks are.
   type, abstract :: rank_tasks_t
      logical :: is_stopped = .false.               !< set by keep: no further task is to begin
   contains
      procedure(make_task), deferred :: make
      procedure(begin_task), deferred :: begin
      procedure(take_answer), deferred :: keep
   end type rank_tasks_t

   abstract interface
      !> Does a task, on any rank.
      subroutine make_task(self, task, answer)
         import :: ip, buffer_t, rank_tasks_t
         class(rank_tasks_t), intent(inout) :: self  !< all that is asked, on every rank the same
         integer(ip), intent(in) :: task             !< of the list that is handed out, > 0
         type(buffer_t), intent(inout) :: answer     !< empty
      end subroutine make_task
      !> On rank 0: a task is handed out.
      subroutine begin_task(self, task)
         import :: ip, rank_tasks_t
         class(rank_tasks_t), intent(inout) :: self  !< of rank 0; may note it
         integer(ip), intent(in) :: task             !< of the list that is handed out, > 0
      end subroutine begin_task
      !> On rank 0: a task is done, or lost with the process that did it.
      subroutine take_answer(self, task, answer, end_code)
         import :: ip, buffer_t, rank_tasks_t
         class(rank_tasks_t), intent(inout) :: self  !< of rank 0; may note it
         integer(ip), intent(in) :: task             !< of the list that is handed out, > 0
         type(buffer_t), intent(inout) :: answer     !< that of make
         integer, intent(in) :: end_code             !< 0; of a lost one the exit code, or 128 and the number of the signal
      end subroutine take_answer
   end interface

   !> How the ranks were occupied [s].
   type :: rank_times_t
      integer(ip) :: n_ranks = 1                    !< of the run
      real(wp) :: longest_task = 0.0_wp             !< from handing out to its answer
      real(wp) :: longest_idle = 0.0_wp             !< of a rank, all in all
   end type rank_times_t

   !> What came of a task.
   type :: outcome_t
      type(buffer_t) :: answer                      !< as make filled it; empty of a lost task
      integer :: end_code = 0                       !< 0, or how its process ended
   end type outcome_t

   real(c_double), parameter :: SHORT_PAUSE = 1.0e-4_c_double, LONG_PAUSE = 5.0e-4_c_double, LONGER = 1.2_c_double   !< [s]

contains

   !> On rank 0: all tasks of a list, in its order as far as ranks are free. The other ranks call work_for_first.
   subroutine hand_out(tasks, list, times)
      class(rank_tasks_t), intent(inout) :: tasks   !< keeps the answers, and tells when to stop
      integer(ip), intent(in) :: list(:)            !< > 0
      type(rank_times_t), intent(out) :: times      !< of this call
      type(task_process_t) :: process
      type(outcome_t) :: outcome
      integer(ip), allocatable :: task_of(:)        ! (ranks) from 0; 0: none
      real(wp), allocatable :: busy(:)              ! [s]
      integer(ip) :: next, rank
      integer(lp) :: began
      integer(lp), allocatable :: given(:)
      real(c_double) :: wait_time
      logical :: is_done

      call system_clock(began)
      times%n_ranks = rank_count()
      allocate (task_of(0:rank_count() - 1), source=0_ip)
      allocate (busy(0:rank_count() - 1), source=0.0_wp)
      allocate (given(0:rank_count() - 1))
      next = 1
      wait_time = SHORT_PAUSE
      do
         do rank = ubound(task_of, 1, kind=ip), 0, -1     ! the others first: rank 0 may have to make its process
            if (task_of(rank) > 0 .or. next > size(list) .or. tasks%is_stopped) cycle
            task_of(rank) = list(next)
            next = next + 1
            call tasks%begin(task_of(rank))
            call system_clock(given(rank))
            if (rank > 0) call send_number(task_of(rank), rank)
            if (rank == 0) call begin_own(tasks, process, task_of(0))
         end do
         if (all(task_of == 0)) exit
         call look_for_outcome(task_of(0), rank, outcome, is_done)
         if (is_done) then
            busy(rank) = busy(rank) + seconds_from(given(rank))
            times%longest_task = max(times%longest_task, seconds_from(given(rank)))
            call tasks%keep(task_of(rank), outcome%answer, outcome%end_code)
            task_of(rank) = 0
            wait_time = SHORT_PAUSE
         else
            call sleep_longer(wait_time)
         end if
      end do
      times%longest_idle = seconds_from(began) - minval(busy)
      do rank = 1, rank_count() - 1
         call send_number(LAST_TASK, rank)
      end do
      call end_task_process(process)

   contains

      !> What came of a task, of another rank or of rank 0's own.
      subroutine look_for_outcome(own_task, rank, outcome, is_done)
         integer(ip), intent(in) :: own_task           !< 0: none
         integer(ip), intent(out) :: rank
         type(outcome_t), intent(out) :: outcome
         logical, intent(out) :: is_done
         type(buffer_t) :: head
         integer(ip) :: end_code

         rank = 0
         is_done = .false.
         if (rank_count() > 1) is_done = has_message()
         if (is_done) then
            call receive_buffer(head, ANY_RANK, rank)
            call take(head, end_code)
            outcome%end_code = int(end_code)
            call receive_buffer(outcome%answer, rank)
         else if (own_task > 0) then
            call look_at_own(tasks, process, own_task, outcome, is_done)
         end if
      end subroutine look_for_outcome

   end subroutine hand_out

   !> A number for another rank.
   subroutine send_number(number, rank)
      integer(ip), intent(in) :: number, rank
      type(buffer_t) :: buffer

      call put(buffer, number)
      call send_buffer(buffer, rank)
   end subroutine send_number

   !> On the other ranks: does what rank 0 hands out, until there is nothing more.
   subroutine work_for_first(tasks)
      class(rank_tasks_t), intent(inout) :: tasks   !< its make does the tasks
      type(task_process_t) :: process
      type(outcome_t) :: outcome
      type(buffer_t) :: request, head
      integer(ip) :: task
      real(c_double) :: wait_time
      logical :: is_done

      do
         call await_message()
         call receive_buffer(request, 0_ip)
         call take(request, task)
         if (task == LAST_TASK) exit
         call begin_own(tasks, process, task)
         wait_time = SHORT_PAUSE
         do
            call look_at_own(tasks, process, task, outcome, is_done)
            if (is_done) exit
            call sleep_longer(wait_time)
         end do
         head = buffer_t()
         call put(head, int(outcome%end_code, ip))
         call send_buffer(head, 0_ip)
         call send_buffer(outcome%answer, 0_ip)
      end do
      call end_task_process(process)
   end subroutine work_for_first

   !> Gives a task to the process of this rank, which is made where there is none.
   subroutine begin_own(tasks, process, task)
      class(rank_tasks_t), intent(inout) :: tasks
      type(task_process_t), intent(inout) :: process
      integer(ip), intent(in) :: task
      logical :: is_copy

      if (.not. process%runs) then
         call begin_task_process(process, is_copy)
         if (is_copy) call work_in_copy(tasks, process)
      end if
      if (process%runs) call give_task(process, task)
   end subroutine begin_own

   !> Does not come back.
   subroutine work_in_copy(tasks, process)
      class(rank_tasks_t), intent(inout) :: tasks
      type(task_process_t), intent(inout) :: process
      type(buffer_t) :: answer
      integer(ip) :: task

      do
         call await_task(process, task)
         answer = buffer_t()
         call tasks%make(task, answer)
         call give_answer(process, answer)
      end do
   end subroutine work_in_copy

   !> Whether the task of this rank is done. Where there is no process to do it, it is done here and now.
   subroutine look_at_own(tasks, process, task, outcome, is_done)
      class(rank_tasks_t), intent(inout) :: tasks
      type(task_process_t), intent(inout) :: process
      integer(ip), intent(in) :: task
      type(outcome_t), intent(out) :: outcome
      logical, intent(out) :: is_done

      is_done = .true.
      if (process%runs) then
         call ask_answer(process, outcome%answer, is_done, outcome%end_code)
      else
         call tasks%make(task, outcome%answer)
      end if
   end subroutine look_at_own

   subroutine sleep_longer(wait_time)
      real(c_double), intent(inout) :: wait_time        !< [s]

      call pause_for(wait_time)
      wait_time = min(LONG_PAUSE, LONGER*wait_time)
   end subroutine sleep_longer

   real(wp) function seconds_from(began) result(seconds)
      integer(lp), intent(in) :: began
      integer(lp) :: now, rate

      call system_clock(now, rate)
      seconds = real(now - began, wp)/real(rate, wp)
   end function seconds_from

end module atrito_rank_tasks
