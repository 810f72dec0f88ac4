!> `atrito limit` over ranks: the questions of the curve, which do not depend on each other, are answered by whoever is free.
!>
!> All other questions of the search depend on the answers before and are rank 0's. When the first one of the curve comes, rank 0
!> hands out all of them together, a round. The search goes on as by one process: it finds answers in what the rounds left. What it
!> learns, and so the table, is that of one process.
module atrito_stability_rounds
   use atrito_body_cache, only: body_cache_t
   use atrito_command_line, only: command_t
   use atrito_kinds, only: ip, wp
   use atrito_mpi, only: rank_count
   use atrito_parcel, only: parcel_t, put, take
   use atrito_rank_services, only: send_to_others
   use atrito_rank_tasks, only: rank_tasks_t, rank_times_t, hand_out, work_for_first
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_run_request, only: begin_request, has_own_process, text_of_end
   use atrito_stability_questions, only: question_t, answer_t, ask, TELL_NOTHING
   use atrito_stability_search, only: search_t, list_curve
   use atrito_status, only: STATUS_OK, STATUS_INTERNAL
   use atrito_strings, only: to_text
   use atrito_threads, only: set_threads
   implicit none (type, external)
   private
   public :: rounds_t, begin_rounds, look_up, serve_round, put_answer, take_answer

   !> Questions that were asked, and what was answered. The tasks of ranks are the questions of a round.
   type, extends(rank_tasks_t) :: rounds_t
      type(command_t) :: command
      character(len=:), allocatable :: parameter
      type(question_t), allocatable :: questions(:)   !< of all rounds
      type(answer_t), allocatable :: answers(:)       !< code: not STATUS_OK where a question has to be asked again
      integer(ip) :: before = 0                       !< questions of the rounds before this one
      integer(ip) :: n_used = 0                       !< answers that the search asked for
      type(body_cache_t) :: store
      type(reporter_t) :: reporter
   contains
      procedure :: make => make_task
      procedure :: begin => begin_task
      procedure :: keep => keep_answer
   end type rounds_t

contains

   subroutine begin_rounds(command, parameter, rounds)
      type(command_t), intent(in) :: command
      character(len=*), intent(in) :: parameter
      type(rounds_t), intent(out) :: rounds

      rounds%command = command
      rounds%parameter = parameter
      rounds%in_own_process = has_own_process(command)
      rounds%store%keeps = .true.
      rounds%reporter%quiet = command%quiet .or. command%json
      allocate (rounds%questions(0), rounds%answers(0))
   end subroutine begin_rounds

   !> The answer to the next question of a search, for which a round is made where it has not been asked yet. One that nobody else
   !> could answer, of a deck with errors or because the process of the task is gone, is left to who asks, who can tell why.
   subroutine look_up(rounds, search, question, answer, is_there)
      type(rounds_t), intent(inout) :: rounds
      type(search_t), intent(in) :: search
      type(question_t), intent(in) :: question
      type(answer_t), intent(out) :: answer
      logical, intent(out) :: is_there
      integer :: place

      is_there = .false.
      ! the first question tells what is wrong with the deck
      if (rank_count() == 1 .or. size(search%tried) == 0) return
      place = place_of(question, rounds)
      if (place == 0) then
         call make_round(rounds, search, question)
         place = place_of(question, rounds)
      end if
      if (place == 0) return
      answer = rounds%answers(place)
      is_there = answer%code == STATUS_OK
      if (is_there) rounds%n_used = rounds%n_used + 1
   end subroutine look_up

   pure integer function place_of(question, rounds) result(place)
      type(question_t), intent(in) :: question
      type(rounds_t), intent(in) :: rounds

      do place = size(rounds%questions), 1, -1
         associate (other => rounds%questions(place))
            if (other%step == question%step .and. abs(other%x - question%x) <= 0.0_wp) return
         end associate
      end do
   end function place_of

   !> Hands out what belongs to the curve and has not been asked. A single question is left to rank 0, which keeps its factored
   !> bodies.
   subroutine make_round(rounds, search, next)
      type(rounds_t), intent(inout) :: rounds
      type(search_t), intent(in) :: search
      type(question_t), intent(in) :: next
      type(question_t), allocatable :: questions(:)
      type(parcel_t) :: request
      type(rank_times_t) :: times
      integer(ip) :: k

      call choose_questions(rounds, search, next, questions)
      if (size(questions) < 2) return
      rounds%before = size(rounds%questions, kind=ip)
      rounds%questions = [rounds%questions, questions]
      rounds%answers = [rounds%answers, [(answer_t(), k=1, size(questions, kind=ip))]]
      call begin_request(request)
      call put(request, rounds%parameter)
      call put(request, questions%x)
      call put(request, int(questions%step, ip))
      call send_to_others(request)
      call hand_out(rounds, [(k, k=1, size(questions, kind=ip))], times)
   end subroutine make_round

   subroutine choose_questions(rounds, search, next, questions)
      type(rounds_t), intent(in) :: rounds
      type(search_t), intent(in) :: search
      type(question_t), intent(in) :: next
      type(question_t), allocatable, intent(out) :: questions(:)
      real(wp), allocatable :: x(:)
      integer, allocatable :: step(:)
      logical, allocatable :: is_new(:)
      integer :: i

      call list_curve(search, next%x, next%step, x, step)
      allocate (is_new(size(x)))
      do i = 1, size(x)
         is_new(i) = place_of(question_t(x(i), step(i)), rounds) == 0
      end do
      questions = pack([(question_t(x(i), step(i)), i=1, size(x))], is_new)
   end subroutine choose_questions

   !> On the other ranks: answers what rank 0 hands out in a round.
   subroutine serve_round(command, request)
      type(command_t), intent(in) :: command
      type(parcel_t), intent(inout) :: request      !< of which the command has been taken
      type(rounds_t) :: rounds
      character(len=:), allocatable :: parameter
      real(wp), allocatable :: x(:)
      integer(ip), allocatable :: step(:)
      integer :: i

      call take(request, parameter)
      call take(request, x)
      call take(request, step)
      call begin_rounds(command, parameter, rounds)
      rounds%questions = [(question_t(x(i), int(step(i))), i=1, size(x))]
      call work_for_first(rounds)
   end subroutine serve_round

   subroutine make_task(self, task, answer)
      class(rounds_t), intent(inout) :: self
      integer(ip), intent(in) :: task
      type(parcel_t), intent(inout) :: answer
      type(answer_t) :: found

      call set_threads(self%command%threads)        ! of this process: those of the rank would not outlive a fork
      call ask(self%command, self%parameter, self%questions(self%before + task), TELL_NOTHING, self%store, found)
      call put_answer(found, answer)
   end subroutine make_task

   !> Told is what the search asks for.
   subroutine begin_task(self, task)
      class(rounds_t), intent(inout) :: self
      integer(ip), intent(in) :: task

      self%answers(self%before + task)%code = STATUS_INTERNAL   ! until there is one
   end subroutine begin_task

   subroutine keep_answer(self, task, answer, end_code)
      class(rounds_t), intent(inout) :: self
      integer(ip), intent(in) :: task
      type(parcel_t), intent(inout) :: answer
      integer, intent(in) :: end_code

      if (end_code == 0) then
         call take_answer(answer, self%answers(self%before + task))
      else
         associate (question => self%questions(self%before + task))
            call report_progress(self%reporter, self%parameter//' = '//to_text(question%x, 12)// &
                                 '  its process '//text_of_end(end_code)//', the first rank asks again')
         end associate
      end if
   end subroutine keep_answer

   subroutine put_answer(answer, parcel)
      type(answer_t), intent(in) :: answer
      type(parcel_t), intent(inout) :: parcel

      call put(parcel, [int(answer%code, ip), int(answer%verdict, ip), answer%iterations, answer%solves, answer%factorisations])
      call put(parcel, answer%has_news)
      call put(parcel, [answer%excess, answer%displacement])
   end subroutine put_answer

   subroutine take_answer(parcel, answer)
      type(parcel_t), intent(inout) :: parcel
      type(answer_t), intent(out) :: answer
      integer(ip), allocatable :: numbers(:)
      real(wp), allocatable :: amounts(:)

      call take(parcel, numbers)
      call take(parcel, answer%has_news)
      call take(parcel, amounts)
      answer%code = int(numbers(1))
      answer%verdict = int(numbers(2))
      answer%iterations = numbers(3)
      answer%solves = numbers(4)
      answer%factorisations = numbers(5)
      answer%excess = amounts(1)
      answer%displacement = amounts(2)
   end subroutine take_answer

end module atrito_stability_rounds
