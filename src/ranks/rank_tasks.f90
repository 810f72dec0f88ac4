!> Tasks that do not depend on each other, shared out over the ranks: whoever is free gets the next one.
!>
!> Rank 0 hands them out and does some itself. Each rank does its tasks in a process of its own (atrito_task_process), so that a
!> crash is the end of one task and not of all ranks, and so that rank 0 can hand out while it works. While there are tasks enough,
!> a rank has its next one before the last is done, and does not wait for it. Where others have nothing left to do it gives back
!> what it has not begun: nobody is without a task but at the end, no longer than the longest one.
module atrito_rank_tasks
   use, intrinsic :: iso_c_binding, only: c_double
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: ANY_RANK, has_message, rank_count, receive_parcel, send_parcel
   use atrito_parcel, only: parcel_t, put, take
   use atrito_rank_services, only: await_message, send_to_others
   use atrito_system, only: pause_for
   use atrito_task_process, only: task_process_t, begin_task_process, give_task, take_task_back, ask_answer, end_task_process, &
                                  await_task, give_answer, is_ready, is_there, LAST_TASK
   implicit none (type, external)
   private
   public :: rank_tasks_t, rank_times_t, hand_out, work_for_first

   !> What the tasks are.
   type, abstract :: rank_tasks_t
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

   integer, parameter :: DEPTH = 2                   !< tasks that a rank has: the one it does and the next

   !> A rank's own work: the first task is being done.
   type :: own_work_t
      type(task_process_t) :: process
      integer(ip) :: tasks(DEPTH) = 0
      integer :: n = 0
      integer :: n_given = 0                        !< to the process, of the n
   end type own_work_t

   !> What rank 0 knows.
   type :: hand_out_t
      integer(ip), allocatable :: list(:)           !< tasks that nobody has been given; behind them room for those that come back
      integer(ip) :: next = 1, last = 0             !< places in it
      integer(ip) :: last_new = 0                   !< those behind it have come back
      integer(ip), allocatable :: tasks(:, :)       !< (DEPTH, 0:n_ranks - 1) of each rank; the first is being done
      integer, allocatable :: n(:)                  !< (0:n_ranks - 1) how many
      logical, allocatable :: is_recalled(:)        !< (0:n_ranks - 1) was asked to give a task back and has not replied
      real(wp), allocatable :: busy(:)              !< (0:n_ranks - 1) [s]
      real(wp) :: longest = 0.0_wp                  !< [s]
      type(own_work_t) :: own
   end type hand_out_t

   integer(ip), parameter :: RECALL = -2_ip          !< in place of a task: give the next one back
   integer(ip), parameter :: ANSWER_OF = 1_ip, GIVEN_BACK = 2_ip   !< what a rank says
   real(c_double), parameter :: SHORT_PAUSE = 1.0e-4_c_double, LONG_PAUSE = 1.0e-3_c_double, LONGER = 1.2_c_double   !< [s]

contains

   !> On rank 0: all tasks of a list, in its order as far as ranks are free. The other ranks call work_for_first.
   subroutine hand_out(tasks, list, times)
      class(rank_tasks_t), intent(inout) :: tasks
      integer(ip), intent(in) :: list(:)            !< > 0
      type(rank_times_t), intent(out) :: times
      type(hand_out_t) :: state
      type(parcel_t) :: last
      integer(lp) :: began
      real(c_double) :: wait_time
      logical :: any_news

      call system_clock(began)
      call begin_hand_out(list, state)
      wait_time = SHORT_PAUSE
      do
         call give_to_free(tasks, state)
         if (all(state%n == 0) .and. .not. any(state%is_recalled)) exit
         call recall_for_idle(state)
         call look_for_answer(tasks, state, any_news)
         if (any_news) wait_time = SHORT_PAUSE
         if (.not. any_news) call sleep_longer(wait_time)
      end do
      times = rank_times_t(size(state%n, kind=ip), state%longest, seconds_from(began) - minval(state%busy))
      call put(last, LAST_TASK)
      call send_to_others(last)
      call end_task_process(state%own%process)
   end subroutine hand_out

   subroutine begin_hand_out(list, state)
      integer(ip), intent(in) :: list(:)
      type(hand_out_t), intent(out) :: state
      integer(ip) :: n

      n = rank_count()
      allocate (state%tasks(DEPTH, 0:n - 1), source=0_ip)
      allocate (state%n(0:n - 1), source=0)
      allocate (state%busy(0:n - 1), source=0.0_wp)
      allocate (state%is_recalled(0:n - 1), source=.false.)
      state%list = list
      state%last = size(list, kind=ip)
      state%last_new = state%last
   end subroutine begin_hand_out

   !> To each rank without a task one, then to each a next one; what came back goes to who has none.
   subroutine give_to_free(tasks, state)
      class(rank_tasks_t), intent(inout) :: tasks
      type(hand_out_t), intent(inout) :: state
      integer(ip) :: rank
      integer :: n

      do n = 0, DEPTH - 1
         do rank = ubound(state%n, 1), 0, -1         ! the others first: rank 0 may have to make its process
            if (state%next > merge(state%last, state%last_new, n == 0)) return
            if (state%n(rank) == n) call give_next(tasks, state, rank)
         end do
      end do
   end subroutine give_to_free

   subroutine give_next(tasks, state, rank)
      class(rank_tasks_t), intent(inout) :: tasks
      type(hand_out_t), intent(inout) :: state
      integer(ip), intent(in) :: rank

      associate (task => state%list(state%next))
         if (state%next <= state%last_new) call tasks%begin(task)
         state%n(rank) = state%n(rank) + 1
         state%tasks(state%n(rank), rank) = task
         if (rank == 0) then
            call add_task(state%own, task)
            call pass_on(tasks, state%own)
         else
            call tell(task, rank)
         end if
      end associate
      state%next = state%next + 1
   end subroutine give_next

   !> A number for another rank.
   subroutine tell(number, rank)
      integer(ip), intent(in) :: number, rank
      type(parcel_t) :: parcel

      call put(parcel, number)
      call send_parcel(parcel, rank)
   end subroutine tell

   !> Asks as many ranks for their next task as are without any; all tasks have been given.
   subroutine recall_for_idle(state)
      type(hand_out_t), intent(inout) :: state
      integer(ip) :: rank, task

      do rank = 0, ubound(state%n, 1)
         if (count(state%n == 0) <= count(state%is_recalled)) return
         if (state%n(rank) < DEPTH .or. state%is_recalled(rank)) cycle
         if (rank > 0) then
            call tell(RECALL, rank)
            state%is_recalled(rank) = .true.
         else
            call give_back(state%own, task)
            call take_back(state, rank, task)
         end if
      end do
   end subroutine recall_for_idle

   !> A rank has given its next task back, or has begun it.
   subroutine take_back(state, rank, task)
      type(hand_out_t), intent(inout) :: state
      integer(ip), intent(in) :: rank
      integer(ip), intent(in) :: task               !< 0 where it has begun

      state%is_recalled(rank) = .false.
      if (task == 0) return
      state%n(rank) = state%n(rank) - 1
      state%list = [state%list, task]
      state%last = state%last + 1
   end subroutine take_back

   !> One answer, of another rank or of this one.
   subroutine look_for_answer(tasks, state, any_news)
      class(rank_tasks_t), intent(inout) :: tasks
      type(hand_out_t), intent(inout) :: state
      logical, intent(out) :: any_news
      type(parcel_t) :: head, answer
      integer(ip) :: rank, what, number
      integer :: end_code
      real(wp) :: seconds

      any_news = .false.
      if (size(state%n) > 1) any_news = has_message()
      if (any_news) then
         call receive_parcel(head, ANY_RANK, rank)
         call take(head, what)
         call take(head, number)
         if (what == GIVEN_BACK) then
            call take_back(state, rank, number)
            return
         end if
         call take(head, seconds)
         call receive_parcel(answer, rank)
         end_code = int(number)
      else
         rank = 0
         call look_at_own(tasks, state%own, answer, any_news, end_code, seconds)
         if (.not. any_news) return
      end if
      state%busy(rank) = state%busy(rank) + seconds
      state%longest = max(state%longest, seconds)
      call tasks%keep(state%tasks(1, rank), answer, end_code)
      state%tasks(:, rank) = eoshift(state%tasks(:, rank), 1)
      state%n(rank) = state%n(rank) - 1
   end subroutine look_for_answer

   !> On the other ranks: does what rank 0 hands out, until there is nothing more.
   subroutine work_for_first(tasks)
      class(rank_tasks_t), intent(inout) :: tasks
      type(own_work_t) :: own
      type(parcel_t) :: answer
      integer :: end_code
      real(wp) :: seconds
      real(c_double) :: wait_time
      logical :: is_done, is_last

      is_last = .false.
      wait_time = SHORT_PAUSE
      do
         if (own%n == 0) call await_message()
         if (has_message()) call listen(own, is_last)
         if (is_last) exit
         call look_at_own(tasks, own, answer, is_done, end_code, seconds)
         if (is_done) then
            call send_answer(answer, end_code, seconds)
            wait_time = SHORT_PAUSE
         else if (own%n > 0) then
            call sleep_longer(wait_time)
         end if
      end do
      call end_task_process(own%process)
   end subroutine work_for_first

   !> What rank 0 says: a task, to give one back, or that this was the last.
   subroutine listen(own, is_last)
      type(own_work_t), intent(inout) :: own
      logical, intent(out) :: is_last
      type(parcel_t) :: request, reply
      integer(ip) :: number, task

      call receive_parcel(request, 0_ip)
      call take(request, number)
      is_last = number == LAST_TASK
      if (is_last) return
      if (number == RECALL) then
         call give_back(own, task)
         call put(reply, GIVEN_BACK)
         call put(reply, task)
         call send_parcel(reply, 0_ip)
      else
         call add_task(own, number)
      end if
   end subroutine listen

   subroutine send_answer(answer, end_code, seconds)
      type(parcel_t), intent(in) :: answer
      integer, intent(in) :: end_code
      real(wp), intent(in) :: seconds
      type(parcel_t) :: head

      call put(head, ANSWER_OF)
      call put(head, int(end_code, ip))
      call put(head, seconds)
      call send_parcel(head, 0_ip)
      call send_parcel(answer, 0_ip)
   end subroutine send_answer

   subroutine add_task(own, task)
      type(own_work_t), intent(inout) :: own
      integer(ip), intent(in) :: task

      own%n = own%n + 1
      own%tasks(own%n) = task
   end subroutine add_task

   !> The next task, where it has not begun; else 0.
   subroutine give_back(own, task)
      type(own_work_t), intent(inout) :: own
      integer(ip), intent(out) :: task

      task = 0
      if (own%n < DEPTH) return
      if (own%n_given == DEPTH) then
         task = take_task_back(own%process)
         if (task == 0) return
         own%n_given = own%n_given - 1
      end if
      task = own%tasks(DEPTH)
      own%n = own%n - 1
   end subroutine give_back

   !> Gives the next task to the process of this rank, which is made where there is none.
   subroutine pass_on(tasks, own)
      class(rank_tasks_t), intent(inout) :: tasks
      type(own_work_t), intent(inout) :: own
      logical :: is_copy

      if (own%n_given == own%n) return
      if (.not. is_there(own%process)) then
         call begin_task_process(own%process, is_copy)
         if (is_copy) call work_in_copy(tasks, own%process)
         if (.not. is_there(own%process)) return
      end if
      if (.not. is_ready(own%process)) return
      own%n_given = own%n_given + 1
      call give_task(own%process, own%tasks(own%n_given))
   end subroutine pass_on

   !> Does not come back.
   subroutine work_in_copy(tasks, process)
      class(rank_tasks_t), intent(inout) :: tasks
      type(task_process_t), intent(inout) :: process
      type(parcel_t) :: answer
      integer(ip) :: task
      integer(lp) :: began

      do
         call await_task(process, task)
         call system_clock(began)
         answer = parcel_t()
         call tasks%make(task, answer)
         call give_answer(process, answer, seconds_from(began))
      end do
   end subroutine work_in_copy

   !> Whether the task of this rank is done. Where there is no process to do it, it is done here and now.
   subroutine look_at_own(tasks, own, answer, is_done, end_code, seconds)
      class(rank_tasks_t), intent(inout) :: tasks
      type(own_work_t), intent(inout) :: own
      type(parcel_t), intent(out) :: answer
      logical, intent(out) :: is_done
      integer, intent(out) :: end_code              !< that of ask_answer
      real(wp), intent(out) :: seconds              !< that it took
      integer(lp) :: began

      is_done = .false.
      end_code = 0
      seconds = 0.0_wp
      if (own%n == 0) return
      call pass_on(tasks, own)
      if (own%n_given > 0) then
         call ask_answer(own%process, answer, is_done, end_code, seconds)
      else
         call system_clock(began)
         call tasks%make(own%tasks(1), answer)
         seconds = seconds_from(began)
         is_done = .true.
      end if
      if (.not. is_done) return
      own%tasks = eoshift(own%tasks, 1)
      own%n = own%n - 1
      own%n_given = max(own%n_given - 1, 0)
      if (end_code /= 0) own%n_given = 0              ! the next one had not begun
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
