!> Tasks that do not depend on each other, shared out over the ranks: whoever is free gets the next one.
!>
!> Rank 0 hands them out and does some itself. Each rank does its tasks in a process of its own (atrito_task_process), so that a
!> crash is the end of one task and not of all ranks, and so that rank 0 can hand out while it works. A rank is without a task only
!> where none is left: at the end no longer than the longest task.
module atrito_rank_tasks
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: ANY_RANK, has_message, rank_count, receive_parcel, send_parcel
   use atrito_parcel, only: parcel_t, put, take
   use atrito_rank_services, only: await_message, send_to_others
   use atrito_system, only: pause_for
   use atrito_task_process, only: task_process_t, begin_task_process, give_task, ask_answer, end_task_process, await_task, &
                                  give_answer, is_there, LAST_TASK, SHORT_PAUSE
   implicit none (type, external)
   private
   public :: rank_tasks_t, rank_times_t, hand_out, work_for_first

   !> What the tasks are.
   type, abstract :: rank_tasks_t
      logical :: in_own_process = .true.            !< else by the ranks themselves, rank 0 doing none where there are others
   contains
      procedure(make_task), deferred :: make
      procedure(begin_task), deferred :: begin
      procedure(take_answer), deferred :: keep
   end type rank_tasks_t

   abstract interface
      !> Does a task, on any rank.
      subroutine make_task(self, task, answer)
         import :: ip, parcel_t, rank_tasks_t
         class(rank_tasks_t), intent(inout) :: self
         integer(ip), intent(in) :: task
         type(parcel_t), intent(inout) :: answer     !< empty
      end subroutine make_task
      !> On rank 0: a task is handed out.
      subroutine begin_task(self, task)
         import :: ip, rank_tasks_t
         class(rank_tasks_t), intent(inout) :: self
         integer(ip), intent(in) :: task
      end subroutine begin_task
      !> On rank 0: a task is done, or lost with the process that did it.
      subroutine take_answer(self, task, answer, end_code)
         import :: ip, parcel_t, rank_tasks_t
         class(rank_tasks_t), intent(inout) :: self
         integer(ip), intent(in) :: task
         type(parcel_t), intent(inout) :: answer     !< that of make
         integer, intent(in) :: end_code             !< 0; of a lost one the exit code, or 128 and the number of the signal
      end subroutine take_answer
   end interface

   !> How the ranks were occupied [s].
   type :: rank_times_t
      integer(ip) :: n_ranks = 1
      real(wp) :: longest_task = 0.0_wp
      real(wp) :: longest_idle = 0.0_wp             !< of a rank, all in all
   end type rank_times_t

   !> A rank's own work.
   type :: work_t
      type(task_process_t) :: process
      integer(ip) :: task = 0                       !< that is being done; 0: none
      integer(lp) :: began = 0
   end type work_t

   !> What rank 0 knows.
   type :: hand_out_t
      integer(ip), allocatable :: task_of(:)        !< (0:n_ranks - 1) that was given to it; 0: none
      real(wp), allocatable :: busy(:)              !< [s] of each
      type(work_t) :: own
      logical :: works = .true.                     !< rank 0 does tasks, too
      real(wp) :: longest = 0.0_wp                  !< [s]
   end type hand_out_t

contains

   !> On rank 0: all tasks of a list, in its order as far as ranks are free. The other ranks call work_for_first.
   subroutine hand_out(tasks, list, times)
      class(rank_tasks_t), intent(inout) :: tasks
      integer(ip), intent(in) :: list(:)            !< > 0
      type(rank_times_t), intent(out) :: times
      type(hand_out_t) :: state
      type(parcel_t) :: last
      integer(ip) :: next, n
      integer(lp) :: began
      logical :: any_news

      n = rank_count()
      allocate (state%task_of(0:n - 1), source=0_ip)
      allocate (state%busy(0:n - 1), source=0.0_wp)
      state%works = tasks%in_own_process .or. n == 1
      call system_clock(began)
      next = 1
      do
         call give_to_free(tasks, state, list, next)
         if (all(state%task_of == 0)) exit
         call look_for_answer(tasks, state, any_news)
         if (.not. any_news) call pause_for(SHORT_PAUSE)
      end do
      times = rank_times_t(n, state%longest, seconds_from(began) - minval(state%busy, mask=takes_part(state)))
      call put(last, LAST_TASK)
      call send_to_others(last)
      call end_task_process(state%own%process)
   end subroutine hand_out

   pure function takes_part(state) result(takes)
      type(hand_out_t), intent(in) :: state
      logical :: takes(size(state%busy))

      takes = .true.
      takes(1) = state%works
   end function takes_part

   !> The others first: rank 0 may have to make its process.
   subroutine give_to_free(tasks, state, list, next)
      class(rank_tasks_t), intent(inout) :: tasks
      type(hand_out_t), intent(inout) :: state
      integer(ip), intent(in) :: list(:)
      integer(ip), intent(inout) :: next            !< place in the list
      type(parcel_t) :: parcel
      integer(ip) :: rank

      do rank = ubound(state%task_of, 1), 0, -1
         if (next > size(list)) return
         if (state%task_of(rank) /= 0 .or. (rank == 0 .and. .not. state%works)) cycle
         call tasks%begin(list(next))
         state%task_of(rank) = list(next)
         if (rank == 0) then
            call begin_own(tasks, state%own, list(next))
         else
            parcel = parcel_t()
            call put(parcel, list(next))
            call send_parcel(parcel, rank)
         end if
         next = next + 1
      end do
   end subroutine give_to_free

   !> One answer, of another rank or of this one.
   subroutine look_for_answer(tasks, state, any_news)
      class(rank_tasks_t), intent(inout) :: tasks
      type(hand_out_t), intent(inout) :: state
      logical, intent(out) :: any_news
      type(parcel_t) :: head, answer
      integer(ip) :: rank, end_code
      real(wp) :: seconds

      any_news = .false.
      if (size(state%task_of) > 1) any_news = has_message()
      if (any_news) then
         call receive_parcel(head, ANY_RANK, rank)
         call receive_parcel(answer, rank)
         call take(head, end_code)
         call take(head, seconds)
      else
         rank = 0
         if (state%own%task == 0) return
         call look_at_own(tasks, state%own, answer, any_news, end_code, seconds)
         if (.not. any_news) return
      end if
      state%busy(rank) = state%busy(rank) + seconds
      state%longest = max(state%longest, seconds)
      call tasks%keep(state%task_of(rank), answer, int(end_code))
      state%task_of(rank) = 0
   end subroutine look_for_answer

   !> On the other ranks: does what rank 0 hands out, until there is nothing more.
   subroutine work_for_first(tasks)
      class(rank_tasks_t), intent(inout) :: tasks
      type(parcel_t) :: request, head, answer
      type(work_t) :: own
      integer(ip) :: task, end_code
      real(wp) :: seconds
      logical :: is_done

      do
         call await_message()
         call receive_parcel(request, 0_ip)
         call take(request, task)
         if (task == LAST_TASK) exit
         call begin_own(tasks, own, task)
         do
            call look_at_own(tasks, own, answer, is_done, end_code, seconds)
            if (is_done) exit
            call pause_for(SHORT_PAUSE)
         end do
         head = parcel_t()
         call put(head, end_code)
         call put(head, seconds)
         call send_parcel(head, 0_ip)
         call send_parcel(answer, 0_ip)
      end do
      call end_task_process(own%process)
   end subroutine work_for_first

   !> Gives a task to the process of this rank, which is made where there is none.
   subroutine begin_own(tasks, own, task)
      class(rank_tasks_t), intent(inout) :: tasks
      type(work_t), intent(inout) :: own
      integer(ip), intent(in) :: task
      logical :: is_copy

      call system_clock(own%began)
      own%task = task
      if (.not. tasks%in_own_process) return
      if (.not. is_there(own%process)) then
         call begin_task_process(own%process, is_copy)
         if (is_copy) call work_in_copy(tasks, own%process)
      end if
      if (is_there(own%process)) call give_task(own%process, task)
   end subroutine begin_own

   !> Does not come back.
   subroutine work_in_copy(tasks, process)
      class(rank_tasks_t), intent(inout) :: tasks
      type(task_process_t), intent(inout) :: process
      type(parcel_t) :: answer
      integer(ip) :: task

      do
         call await_task(process, task)
         answer = parcel_t()
         call tasks%make(task, answer)
         call give_answer(process, answer)
      end do
   end subroutine work_in_copy

   !> Whether the task of this rank is done. Where there is no process to do it, it is done here and now.
   subroutine look_at_own(tasks, own, answer, is_done, end_code, seconds)
      class(rank_tasks_t), intent(inout) :: tasks
      type(work_t), intent(inout) :: own
      type(parcel_t), intent(out) :: answer
      logical, intent(out) :: is_done
      integer(ip), intent(out) :: end_code
      real(wp), intent(out) :: seconds               !< that it took
      integer :: code

      code = 0
      if (is_there(own%process)) then
         call ask_answer(own%process, answer, is_done, code)
      else
         call tasks%make(own%task, answer)
         is_done = .true.
      end if
      end_code = int(code, ip)
      seconds = seconds_from(own%began)
      if (is_done) own%task = 0
   end subroutine look_at_own

   real(wp) function seconds_from(began) result(seconds)
      integer(lp), intent(in) :: began
      integer(lp) :: now, rate

      call system_clock(now, rate)
      seconds = real(now - began, wp)/real(rate, wp)
   end function seconds_from

end module atrito_rank_tasks
