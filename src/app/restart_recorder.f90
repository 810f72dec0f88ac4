!> Between the solver, which knows of increments, and the restart file, which knows of files.
module atrito_restart_recorder
   use atrito_command_line, only: command_t, output_folder
   use atrito_files, only: file_exists, judge_file, protect_input
   use atrito_fingerprint, only: fingerprint_t, take_fingerprint
   use atrito_folder_claim, only: folder_claim_t, claim_folder, release_folder
   use atrito_kinds, only: ip, lp, wp
   use atrito_messages, only: message_t, add_message, SEVERITY_WARNING
   use atrito_model, only: model_t
   use atrito_observations, only: observation_names
   use atrito_recorder, only: recorder_t
   use atrito_restart_file, only: read_restart, restart_name, write_restart
   use atrito_restart_state, only: restart_state_t
   use atrito_results, only: frame_store_t, history_t
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: join
   implicit none (type, external)
   private
   public :: restart_recorder_t, begin_recorder

   !> A file holds all increments that are printed, so the next one takes longer. What takes some time is written as often as it is
   !> less than a fifth of the processor time of the run; a run that is killed has lost no more than four times that.
   real(wp), parameter :: SOME_TIME = 0.02_wp        !< [s]
   real(wp), parameter :: BETWEEN = 4.0_wp           !< processor time between two files over that of writing one

   !> Who writes the restart files of a run (recorder_t).
   type, extends(recorder_t) :: restart_recorder_t
      private
      character(len=:), allocatable :: folder, name  !< of the restart files, and their name in it
      character(len=:), allocatable :: deck_path     !< for messages
      type(fingerprint_t) :: fingerprint             !< of the model and the options
      integer(ip) :: last_step = 0                   !< of the model
      real(wp) :: written = 0.0_wp, took = 0.0_wp    !< processor time when the last file was there, and that it took [s]
      logical :: has_warned = .false.                !< that writing takes long: told once
   contains
      procedure :: record => write_record
   end type restart_recorder_t

contains

   !> Reads the file of --restart, and gets ready to write those that the deck asks for. status: that of read_restart.
   subroutine begin_recorder(command, model, recorder, frames, status)
      type(command_t), intent(in) :: command                !< --restart, and what its file must agree with
      type(model_t), intent(in) :: model                    !< as built, with *RESTART
      type(restart_recorder_t), intent(out) :: recorder     !< resumes where --restart is given
      class(frame_store_t), intent(inout), target :: frames !< will keep the increments that are printed
      type(status_t), intent(out) :: status                 !< STATUS_OK, or why --restart cannot be read
      character(len=:), allocatable :: options
      integer(lp) :: identity(2)
      integer :: i

      recorder%resumes = allocated(command%restart)
      recorder%every = model%restart_every
      if (recorder%every == 0 .and. .not. recorder%resumes) return
      recorder%folder = output_folder(command)
      recorder%name = restart_name(model)
      if (recorder%resumes) recorder%source = command%restart
      recorder%observed = observation_names(model%observed, command%observe)
      recorder%deck_path = model%deck_path
      recorder%last_step = size(model%steps, kind=ip)
      ! what is solved by another form or another solver differs in the last digits
      options = '--contact '//trim(command%contact)//', --solver '//trim(command%solver)
      ! what was observed in increments that are not printed is in the file alone
      do i = 1, size(model%observed)
         options = options//', *OBSERVE '//model%observed(i)%text
      end do
      if (size(command%observe) > 0) options = options//', --observe '//join(command%observe, ', --observe ')
      call take_fingerprint(model, options, recorder%fingerprint)
      if (.not. recorder%resumes) return
      call judge_file(command%restart, status, identity)
      if (is_ok(status)) call protect_input(identity, status)
      if (file_exists(command%restart) .and. .not. is_ok(status)) return
      call read_restart(command%restart, recorder%fingerprint, recorder%found, recorder%state, status, frames)
   end subroutine begin_recorder

   !> Writes the file anew, where it is time to. A failure is told once, and the run goes on: its tables are not lost with it.
   subroutine write_record(self, history, state)
      class(restart_recorder_t), intent(inout) :: self
      type(history_t), intent(inout) :: history
      type(restart_state_t), intent(inout) :: state
      type(folder_claim_t) :: claim
      type(status_t) :: status
      type(message_t) :: message
      real(wp) :: began
      logical :: is_last

      is_last = state%ends_step .and. state%step == self%last_step
      call cpu_time(began)
      if (.not. is_last .and. self%took > SOME_TIME .and. began - self%written < BETWEEN*self%took) return
      call claim_folder(self%folder, claim, status)
      if (is_ok(status)) call write_restart(self%folder, self%name, self%fingerprint, history, state, status)
      call release_folder(claim)
      call cpu_time(self%written)
      self%took = self%written - began
      if (is_ok(status) .or. self%has_warned) return
      message%severity = SEVERITY_WARNING
      message%id = 'W-RESTART'
      message%file = self%deck_path
      message%text = 'no restart file: '//status%text
      call add_message(message)
      self%has_warned = .true.
   end subroutine write_record

end module atrito_restart_recorder
