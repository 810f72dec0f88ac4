!> A history that is being solved, and how it is recorded and taken up again where it was interrupted.
!>
!> What is handed to a recorder is all that the next increment starts from (restart_state_t); the run takes the same on itself, so
!> it does not matter which run solves the next increment.
module atrito_history_run
   use atrito_body_cache, only: body_cache_t
   use atrito_check_found, only: check_found
   use atrito_contact_scales, only: widen
   use atrito_history_lists, only: trim_lists
   use atrito_force_sense, only: force_sense_t, pair_force
   use atrito_increment_length, only: progress_t
   use atrito_kinds, only: ip, wp
   use atrito_model, only: is_due, model_t, step_t
   use atrito_observer, only: observer_t
   use atrito_record_checks, only: check_place, check_start
   use atrito_recorder, only: recorder_t
   use atrito_reporter, only: reporter_t
   use atrito_restart_state, only: restart_state_t, slip_memory_t
   use atrito_results, only: history_t, results_t, scene_t
   use atrito_scene_data, only: scene_data_t
   use atrito_slip_memory, only: begin_memory, put_rest
   use atrito_solve, only: begin_scene, note_method, solve_options_t, CONTACT_SPARSE
   use atrito_status, only: is_ok, set_status, status_t, STATUS_DECK
   use atrito_warm_start, only: put_start, take_start
   implicit none (type, external)
   private
   public :: run_t, is_recorded, is_resumed, resume, record

   !> A history that is being solved.
   type :: run_t
      type(solve_options_t) :: options              !< as asked for
      type(reporter_t) :: reporter                  !< tells how far the work is
      type(scene_data_t) :: data                    !< of the step, and what the next increment needs
      type(scene_t) :: scene                        !< with what is known of the bodies since they were factored
      type(step_t) :: step                          !< that began with other supports than the one before
      type(slip_memory_t) :: memory                 !< of all points
      type(results_t) :: last                       !< the last increment that converged
      logical :: has_last = .false.                 !< else no increment has converged yet
      real(wp) :: began = 0.0_wp                    !< when the step began, time of the history
      real(wp) :: condition = 1.0_wp                !< the largest of the contact line
      type(force_sense_t) :: sense                  !< of all increments so far
      integer(ip) :: n_frames = 0, n_rows = 0, n_iterations = 0 !< of the history so far
      character(len=:), allocatable :: idle         !< the first motion of a printed increment that nothing determines, and when
      integer(ip) :: n_idle = 0                     !< printed increments with one
      class(recorder_t), pointer :: recorder => null() !< not associated: nothing is recorded
      class(observer_t), pointer :: observer => null() !< not associated: nothing is observed
   end type run_t

contains

   !> Whether increments are recorded, or have been before.
   pure logical function is_recorded(run)
      type(run_t), intent(in) :: run                !< its recorder is read

      is_recorded = is_resumed(run)
      if (associated(run%recorder)) is_recorded = is_recorded .or. run%recorder%every > 0
   end function is_recorded

   !> Whether the history goes on behind a recorded increment.
   pure logical function is_resumed(run)
      type(run_t), intent(in) :: run                !< its recorder is read

      is_resumed = .false.
      if (associated(run%recorder)) is_resumed = run%recorder%resumes
   end function is_resumed

   !> Makes the scene of the step in which a history was interrupted, and goes behind the increment that was recorded last.
   subroutine resume(model, store, run, history, now, status)
      type(model_t), intent(in), target :: model     !< as built
      type(body_cache_t), intent(inout) :: store     !< of bodies; begun for this scene
      type(run_t), intent(inout), target :: run      !< with recorder and options; all else is set
      type(history_t), intent(inout) :: history      !< empty; stays so without success
      type(progress_t), intent(out) :: now           !< where in its step the history goes on
      type(status_t), intent(out) :: status          !< STATUS_OK, STATUS_DECK and others of begin_scene
      type(solve_options_t) :: as_before
      character(len=:), allocatable :: wrong
      integer(ip) :: first, i

      associate (state => run%recorder%state)
         call check_place(model, state, wrong)
         if (allocated(wrong)) then
            call refuse_record(run%recorder, wrong, status)
            return
         end if
         run%step = model%steps(state%step)
         if (allocated(state%from)) run%step%prescribed%from = state%from
         if (allocated(state%from_of_motions)) run%step%rigid_prescribed%from = state%from_of_motions
         as_before = run%options
         as_before%contact_form = int(state%contact_form)   ! its choice depends on the memory of the machine
         call begin_scene(model, as_before, store, .false., run%data, run%scene, status, run%step)
         if (.not. is_ok(status)) return
         call check_start(run%data, run%scene, state, wrong)
         if (.not. allocated(run%recorder%observed)) allocate (run%recorder%observed(0))
         call check_found(run%data, run%scene, run%recorder%observed, run%recorder%found, state, wrong)
         if (allocated(wrong)) then
            call refuse_record(run%recorder, wrong, status)
            return
         end if
         run%data%reason = state%contact_reason
         run%scene%contact_reason = state%contact_reason
         if (.not. allocated(state%from)) run%data%step => model%steps(state%step)
         call begin_memory(model, run%data%points%n, run%memory)
         ! a form that is asked for serves all steps so far, one that was chosen this one
         first = merge(1_ip, state%step, run%options%contact_form == CONTACT_SPARSE)
         call note_method(run%data, model%steps(first:state%step))
         run%data%keeps = .true.
         run%data%asks_for_bases = .true.
         if (allocated(state%released)) run%data%released = state%released
         run%data%fem%digit_error = state%digit_error
         if (allocated(state%had_motion)) call widen(run%data%had, state%had_motion, state%had_force)
         state%memory%is_incremental = run%memory%is_incremental
         run%memory = state%memory
         call put_rest(run%memory, run%data%line)
         run%last = state%last
         run%has_last = .true.
         run%scene%bodies = state%last%scene%bodies
         run%condition = state%condition
         run%sense%asked = sum([(pair_force(state%last%contact(i)), i=1, size(state%last%contact, kind=ip))])
         run%began = state%began
         now = progress_t(state%increment, state%step_time, state%length)
      end associate
      call take_start(run%recorder%state%start, run%data%last)
      history = run%recorder%found
      run%n_frames = size(history%frames, kind=ip)
      run%n_rows = size(history%rows, kind=ip)
      run%n_iterations = size(history%iterations, kind=ip)
   end subroutine resume

   !> A record that has what its deck does not give.
   subroutine refuse_record(recorder, wrong, status)
      class(recorder_t), intent(in) :: recorder
      character(len=*), intent(in) :: wrong          !< what, in words
      type(status_t), intent(inout) :: status
      character(len=:), allocatable :: source

      source = 'the restart file'
      if (allocated(recorder%source)) source = recorder%source
      call set_status(status, STATUS_DECK, source//': does not fit this deck: '//wrong)
   end subroutine refuse_record

   !> Hands on what was found so far, where that is asked for. The next increment starts from what is recorded and from nothing
   !> else, so that it does not matter which run solves it.
   subroutine record(now, run, history)
      type(progress_t), intent(in) :: now           !< end of the increment
      type(run_t), intent(inout), target :: run     !< its last increment converged
      type(history_t), intent(inout) :: history     !< so far; its lists get their lengths
      type(restart_state_t) :: state

      if (.not. associated(run%recorder)) return
      if (run%recorder%every == 0 .or. .not. is_due(run%recorder%every, now%increment, run%last%ends_step)) return
      call trim_lists(run%n_frames, run%n_rows, run%n_iterations, history)
      state%step = run%last%step
      state%increment = now%increment
      state%step_time = now%time
      state%length = now%length
      state%ends_step = run%last%ends_step
      state%began = run%began
      state%condition = run%condition
      state%digit_error = run%data%fem%digit_error
      if (allocated(run%data%had%motion)) then
         state%had_motion = run%data%had%motion
         state%had_force = run%data%had%force
      end if
      state%contact_form = int(run%data%contact_form, ip)
      state%contact_reason = run%data%reason
      if (associated(run%data%step, run%step)) then
         state%from = run%step%prescribed%from
         if (allocated(run%step%rigid_prescribed%from)) state%from_of_motions = run%step%rigid_prescribed%from
      end if
      if (allocated(run%data%released)) state%released = run%data%released
      state%memory = run%memory
      state%last = run%last
      if (allocated(run%data%last)) call put_start(run%data%last, state%start)
      call take_start(state%start, run%data%last)
      call run%recorder%record(history, state)
   end subroutine record

end module atrito_history_run
