!> What rank 0 tells the others of runs that it will hand out: the arguments of the program, of which each makes the command anew.
module atrito_run_request
   use atrito_command_line, only: command_t, fetch_arguments, parse_command
   use atrito_console, only: print_status
   use atrito_kinds, only: ip
   use atrito_messages, only: message_t, clear_messages
   use atrito_model, only: model_t
   use atrito_observations, only: observations_t, read_observations
   use atrito_parcel, only: parcel_t, put, take
   use atrito_rank_services, only: send_to_others, SERVICE_RUNS
   use atrito_run, only: read_model
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: request_runs, put_arguments, take_arguments, take_request, is_sound, print_lost, text_of_end

   integer(ip), parameter :: FIRST_SIGNAL = 128_ip   !< exit codes above it are of signals

contains

   !> On rank 0: the others get ready for what the command line of the program asks for.
   subroutine request_runs()
      type(parcel_t) :: request
      type(string_t), allocatable :: arguments(:)

      call fetch_arguments(arguments)
      call put(request, SERVICE_RUNS)
      call put_arguments(arguments, request)
      call send_to_others(request)
   end subroutine request_runs

   !> The arguments of the program, for another rank.
   subroutine put_arguments(arguments, parcel)
      type(string_t), intent(in) :: arguments(:)
      type(parcel_t), intent(inout) :: parcel
      integer :: i

      call put(parcel, size(arguments, kind=ip))
      do i = 1, size(arguments)
         call put(parcel, arguments(i)%s)
      end do
   end subroutine put_arguments

   !> The same from the parcel that the first rank has sent.
   subroutine take_arguments(parcel, arguments)
      type(parcel_t), intent(inout) :: parcel
      type(string_t), allocatable, intent(out) :: arguments(:)
      integer(ip) :: i, n

      call take(parcel, n)
      allocate (arguments(n))
      do i = 1, n
         call take(parcel, arguments(i)%s)
      end do
   end subroutine take_arguments

   !> On the other ranks: the command, from a request whose first number has been taken.
   subroutine take_request(request, command)
      type(parcel_t), intent(inout) :: request
      type(command_t), intent(out) :: command
      type(string_t), allocatable :: arguments(:)
      type(message_t) :: error
      logical :: ok

      call take_arguments(request, arguments)
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
      if (is_sound .and. size(command%observe) > 0) call read_observations(command%observe, model, observations, is_sound, error)
      call clear_messages()
   end function is_sound

   !> A run was lost with the process that made it.
   subroutine print_lost(command, label, end_code)
      type(command_t), intent(in) :: command
      character(len=*), intent(in) :: label         !< of the run
      integer, intent(in) :: end_code               !< its exit code, or 128 and the number of the signal
      type(status_t) :: status

      call set_status(status, STATUS_INTERNAL, 'the process of the run '//label//' '//text_of_end(end_code) &
                      //'; the other runs go on')
      call print_status(status, command%names(1)%s, command%json)
   end subroutine print_lost

   !> How a process came to its end.
   pure function text_of_end(end_code) result(text)
      integer, intent(in) :: end_code               !< its exit code, or 128 and the number of the signal
      character(len=:), allocatable :: text

      text = 'ended with exit code '//to_text(int(end_code, ip))
      if (end_code > FIRST_SIGNAL) text = 'was ended by signal '//to_text(int(end_code, ip) - FIRST_SIGNAL)
   end function text_of_end

end module atrito_run_request
