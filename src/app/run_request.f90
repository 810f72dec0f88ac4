!> What rank 0 tells the others of runs that it will hand out: the arguments of the program, of which each makes the command anew.
module atrito_run_request
   use atrito_command_line, only: command_t, fetch_arguments, parse_command
   use atrito_console, only: print_status
   use atrito_kinds, only: ip
   use atrito_messages, only: message_t, clear_messages
   use atrito_model, only: model_t
   use atrito_observations, only: observations_t, read_observations
   use atrito_mpi, only: rank_count
   use atrito_buffer, only: buffer_t, put, take
   use atrito_rank_services, only: send_to_others, SERVICE_RUNS
   use atrito_rank_tasks, only: rank_tasks_t, rank_times_t, hand_out
   use atrito_load_model, only: read_model
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: make_tasks, put_arguments, take_request, is_sound, print_lost

   integer(ip), parameter :: FIRST_SIGNAL = 128_ip   !< exit codes above it are of signals

contains

   !> Makes some runs of a series: one after the other in this process until one stops the series, or, with several ranks, by all of
   !> them, which are told the arguments of the program first.
   subroutine make_tasks(tasks, list, times)
      class(rank_tasks_t), intent(inout) :: tasks   !< keeps what each task gives; is_stopped ends it
      integer(ip), intent(in) :: list(:)            !< of tasks, in the order in which they begin
      type(rank_times_t), intent(out) :: times      !< of the ranks; defaults on one
      type(buffer_t) :: buffer
      type(string_t), allocatable :: arguments(:)
      integer :: i

      if (size(list) == 0) return
      if (rank_count() > 1) then
         call fetch_arguments(arguments)
         call put(buffer, SERVICE_RUNS)
         call put_arguments(arguments, buffer)
         call send_to_others(buffer)
         call hand_out(tasks, list, times)
         return
      end if
      do i = 1, size(list)
         call tasks%begin(list(i))
         buffer = buffer_t()
         call tasks%make(list(i), buffer)
         call tasks%keep(list(i), buffer, 0)
         if (tasks%is_stopped) exit
      end do
   end subroutine make_tasks

   !> The arguments of the program, for another rank.
   subroutine put_arguments(arguments, buffer)
      type(string_t), intent(in) :: arguments(:)    !< as fetch_arguments gives them
      type(buffer_t), intent(inout) :: buffer       !< get them behind what it has
      integer :: i

      call put(buffer, size(arguments, kind=ip))
      do i = 1, size(arguments)
         call put(buffer, arguments(i)%s)
      end do
   end subroutine put_arguments

   !> On the other ranks: the command, from a request whose first number has been taken.
   subroutine take_request(request, command)
      type(buffer_t), intent(inout) :: request      !< its next items are taken
      type(command_t), intent(out) :: command       !< as on rank 0; a difference stops the program
      type(string_t), allocatable :: arguments(:)
      type(message_t) :: error
      integer(ip) :: i, n
      logical :: ok

      call take(request, n)
      allocate (arguments(n))
      do i = 1, n
         call take(request, arguments(i)%s)
      end do
      call parse_command(arguments, command, ok, error)
      if (.not. ok) error stop 'atrito: ranks do not agree on the command line; is the same program installed on all machines?'
   end subroutine take_request

   !> Whether a run begins: its deck has no errors, and --observe none either. Nothing is told.
   logical function is_sound(command)
      type(command_t), intent(in) :: command        !< of the run
      type(model_t) :: model
      type(observations_t) :: observations
      type(message_t) :: error

      call clear_messages()
      call read_model(command, model, is_sound)
      if (is_sound) call read_observations(command%observe, model, observations, is_sound, error)
      call clear_messages()
   end function is_sound

   !> A run was lost with the process that made it.
   subroutine print_lost(command, label, end_code)
      type(command_t), intent(in) :: command        !< of the series; json is read
      character(len=*), intent(in) :: label         !< of the run
      integer, intent(in) :: end_code               !< its exit code, or 128 and the number of the signal
      type(status_t) :: status
      character(len=:), allocatable :: text

      text = 'ended with exit code '//to_text(int(end_code, ip))
      if (end_code > FIRST_SIGNAL) text = 'was ended by signal '//to_text(int(end_code, ip) - FIRST_SIGNAL)
      call set_status(status, STATUS_INTERNAL, 'the process of the run '//label//' '//text//'; the other runs go on')
      call print_status(status, command%names(1)%s, command%json)
   end subroutine print_lost

end module atrito_run_request
