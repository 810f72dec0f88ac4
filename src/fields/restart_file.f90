!> The restart file, docs/user/loads.md: <deck name>.restart.h5 holds all that was found of a history so far, and the state that
!> the next increment begins from. It is written whole under a temporary name and takes the place of the one before in one step of
!> the file system, so that a run that is killed at any moment leaves the last one that was whole.
module atrito_restart_file
   use atrito_archive, only: archive_t, create_archive, open_archive, begin_part, end_part, demand, is_sound, close_archive
   use atrito_exchange, only: exchange, exchange_length, exchange_numbers, exchange_vector
   use atrito_exchange_results, only: exchange_results, exchange_iterations
   use atrito_files, only: file_set_t, begin_files, file_exists, judge_file, reserve_file, commit_over, discard_files
   use atrito_fingerprint, only: fingerprint_t, find_difference
   use atrito_kinds, only: ip
   use atrito_model, only: model_t
   use atrito_multipliers, only: multiplier_t
   use atrito_restart_state, only: restart_state_t, warm_start_t
   use atrito_results, only: frame_store_t, results_t, history_t, history_row_t, observed_list_t, put_aside, view_frame
   use atrito_status, only: status_t, set_status, is_ok, STATUS_DECK, STATUS_FILE
   use atrito_strings, only: to_text
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   implicit none (type, external)
   private
   public :: restart_name, write_restart, read_restart

   character(len=*), parameter :: FORMAT = 'restart file of '//PROGRAM_NAME//', format 2'

contains

   !> Name of the file, without folder.
   pure function restart_name(model) result(name)
      type(model_t), intent(in) :: model         !< its deck_name is read
      character(len=:), allocatable :: name

      name = model%deck_name//'.restart.h5'
   end function restart_name

   !> Writes what was found so far. status: STATUS_FILE, and then the file that was there is as it was.
   subroutine write_restart(folder, name, fingerprint, history, state, status)
      character(len=*), intent(in) :: folder, name      !< of the tables; name of the file in it
      type(fingerprint_t), intent(inout) :: fingerprint !< these three are not changed: writing and reading are one procedure
      type(history_t), intent(inout), target :: history !< all that was found so far
      type(restart_state_t), intent(inout) :: state     !< from which the next increment begins
      type(status_t), intent(out) :: status             !< STATUS_OK or STATUS_FILE
      type(file_set_t) :: set
      type(archive_t) :: archive
      character(len=:), allocatable :: path, kind, program
      integer(ip), allocatable :: increments(:)
      type(results_t), pointer :: frame
      integer(ip) :: i

      call begin_files(set, folder, status)
      if (.not. is_ok(status)) return
      call reserve_file(set, name, path)
      call create_archive(path, folder//'/'//name, archive)
      call exchange_origin(archive, kind, program, fingerprint)
      call exchange_findings(archive, history, state, increments)
      if (allocated(history%frames) .and. is_sound(archive)) then
         do i = 1, size(history%frames, kind=ip)
            call view_frame(history, i, frame)
            call begin_part(archive, 'frame_'//to_text(i))
            call exchange_results(archive, frame)
            call end_part(archive)
         end do
      end if
      call close_archive(archive, status)
      if (is_ok(status)) then
         call commit_over(set, status)
      else
         call discard_files(set)
      end if
   end subroutine write_restart

   !> Reads a file. status: STATUS_FILE when it cannot be read or is damaged; STATUS_DECK when it belongs to another program, to
   !> another deck or to another version of it. Whether what it holds can be of the deck is asked by who uses it (check_found and
   !> check_start in stepping/).
   subroutine read_restart(path, fingerprint, history, state, status, frames)
      character(len=*), intent(in) :: path              !< of the file, as the user wrote it
      type(fingerprint_t), intent(in) :: fingerprint    !< of the deck and the options
      type(history_t), intent(out) :: history           !< as at the end of its last increment
      type(restart_state_t), intent(out) :: state       !< from which the next increment begins
      type(status_t), intent(out) :: status             !< STATUS_OK, STATUS_FILE or STATUS_DECK
      class(frame_store_t), intent(inout), target, optional :: frames !< keeps all frames but the last
      type(archive_t) :: archive
      type(fingerprint_t) :: in_file
      type(status_t) :: closing
      character(len=:), allocatable :: kind, program, difference
      integer(ip), allocatable :: increments(:)

      if (.not. file_exists(path)) call set_status(status, STATUS_FILE, path//': there is no such file')
      if (is_ok(status)) call judge_file(path, status)
      if (.not. is_ok(status)) return
      call open_archive(path, archive)
      call exchange_origin(archive, kind, program, in_file)
      if (is_sound(archive)) then
         ! Why a file is not one of this program, in words; '' when it is.
         difference = ''
         if (program /= PROGRAM_NAME//' '//PROGRAM_VERSION) then
            difference = 'it was written by '//program//', this is '//PROGRAM_NAME//' '//PROGRAM_VERSION
         else if (kind /= FORMAT) then
            difference = 'it is a '//kind//', expected is a '//FORMAT
         end if
         if (len(difference) == 0) call exchange_findings(archive, history, state, increments)
         if (len(difference) == 0 .and. is_sound(archive)) difference = find_difference(in_file, fingerprint, state%step)
         if (len(difference) > 0) call set_status(status, STATUS_DECK, path//': is no restart file of this deck: '//difference)
      end if
      if (present(frames)) history%store => frames
      if (is_ok(status) .and. is_sound(archive)) call read_frames()
      call close_archive(archive, closing)
      if (is_ok(status)) status = closing

   contains

      !> Reads the frames; those before the last go to the store, where there is one.
      subroutine read_frames()
         integer(ip) :: i

         if (.not. allocated(increments)) return
         allocate (history%frames(size(increments)))
         do i = 1, size(increments, kind=ip)
            if (i > 1) call put_aside(i - 1, history)
            call begin_part(archive, 'frame_'//to_text(i))
            call exchange_results(archive, history%frames(i))
            call demand(archive, history%frames(i)%increment == increments(i), 'increment')
            call end_part(archive)
            if (.not. is_sound(archive)) return
         end do
      end subroutine read_frames

   end subroutine read_restart

   !> What the file is and which deck it belongs to.
   subroutine exchange_origin(archive, kind, program, fingerprint)
      type(archive_t), intent(inout) :: archive
      character(len=:), allocatable, intent(out) :: kind, program
      type(fingerprint_t), intent(inout) :: fingerprint
      integer(ip) :: n, i

      kind = FORMAT
      program = PROGRAM_NAME//' '//PROGRAM_VERSION
      call begin_part(archive, 'origin')
      call exchange(archive, 'kind', kind)
      call exchange(archive, 'program', program)
      call exchange(archive, 'n_steps', fingerprint%n_steps)
      call exchange_length(archive, 'parts', n, fingerprint%parts)
      if (archive%is_reading) allocate (fingerprint%parts(max(n, 0_ip)))
      do i = 1, n
         call exchange(archive, 'name', fingerprint%parts(i)%name)
         call exchange(archive, 'size', fingerprint%parts(i)%size)
         call exchange(archive, 'digest', fingerprint%parts(i)%digest)
         call exchange(archive, 'step', fingerprint%parts(i)%step)
      end do
      call end_part(archive)
   end subroutine exchange_origin

   !> The state and the rows of every increment. Each increment that is printed is a part of its own. (A list of the file costs
   !> more than some thousand numbers in it.)
   subroutine exchange_findings(archive, history, state, increments)
      type(archive_t), intent(inout) :: archive
      type(history_t), intent(inout) :: history
      type(restart_state_t), intent(inout) :: state
      integer(ip), allocatable, intent(out) :: increments(:) !< of the frames

      call begin_part(archive, 'state')
      call exchange_state(archive, state)
      call exchange_results(archive, state%last)
      call exchange_rows(archive, history%rows)
      call exchange_iterations(archive, history%iterations)
      call exchange_observed_list(archive, history%observed)
      if (allocated(history%frames)) increments = history%frames%increment
      call exchange(archive, 'increments of frames', increments)
      call end_part(archive)
   end subroutine exchange_findings

   subroutine exchange_state(archive, state)
      type(archive_t), intent(inout) :: archive
      type(restart_state_t), intent(inout) :: state

      call exchange(archive, 'step', state%step)
      call exchange(archive, 'increment', state%increment)
      call exchange(archive, 'step_time', state%step_time)
      call exchange(archive, 'length', state%length)
      call exchange(archive, 'ends_step', state%ends_step)
      call exchange(archive, 'began', state%began)
      call exchange(archive, 'condition', state%condition)
      call exchange(archive, 'digit_error', state%digit_error)
      call exchange(archive, 'had_motion', state%had_motion)
      call exchange(archive, 'had_force', state%had_force)
      call exchange(archive, 'contact_form', state%contact_form)
      call exchange(archive, 'contact_reason', state%contact_reason)
      call exchange(archive, 'from', state%from)
      call exchange(archive, 'from_of_motions', state%from_of_motions)
      call exchange(archive, 'released', state%released)
      associate (memory => state%memory)
         call exchange(archive, 'rest', memory%rest)
         call exchange(archive, 'slip', memory%slip)
         call exchange(archive, 'shear', memory%shear)
         call exchange(archive, 'slides', memory%slides)
         call exchange(archive, 'dissipation', memory%dissipation)
         call exchange(archive, 'moved', memory%moved)
      end associate
      call exchange_start(archive, state%start)
   end subroutine exchange_state

   !> What the contact line is started from.
   subroutine exchange_start(archive, start)
      type(archive_t), intent(inout) :: archive
      type(warm_start_t), intent(inout) :: start
      type(multiplier_t) :: multipliers              ! those of the dense form are in the file, too, without arrays
      logical :: has_multipliers

      call exchange(archive, 'form', start%form)
      call exchange(archive, 'p', start%p)
      call exchange(archive, 'tau', start%tau)
      call exchange(archive, 't', start%t)
      associate (state => start%state, bounds => start%bounds)
         call exchange(archive, 'state', state%state)
         call exchange(archive, 'q', state%q)
         call exchange(archive, 'a', state%a)
         call exchange(archive, 'r', state%r)
         call exchange(archive, 'shift', state%shift)
         call exchange(archive, 'slack', state%slack)
         call exchange(archive, 'lower', bounds%lower)
         call exchange(archive, 'upper', bounds%upper)
         call exchange(archive, 'd', bounds%d)
      end associate
      call exchange(archive, 'is_shared', start%is_shared)
      call exchange(archive, 'tangential_of', start%tangential_of)
      call exchange(archive, 'residual', start%residual)
      call exchange(archive, 'contraction', start%contraction)
      has_multipliers = allocated(start%multipliers)
      if (has_multipliers) multipliers = start%multipliers
      call exchange(archive, 'has_multipliers', has_multipliers)
      call exchange_multipliers(archive, multipliers)
      if (archive%is_reading .and. has_multipliers) start%multipliers = multipliers
   end subroutine exchange_start

   subroutine exchange_multipliers(archive, multipliers)
      type(archive_t), intent(inout) :: archive
      type(multiplier_t), intent(inout) :: multipliers

      call exchange(archive, 'step_size', multipliers%r)
      call exchange(archive, 'pull_size', multipliers%kappa)
      call exchange(archive, 'x', multipliers%x)
      call exchange(archive, 'e', multipliers%e)
      call exchange(archive, 'noise', multipliers%noise)
      call exchange(archive, 'q_old', multipliers%q_old)
      call exchange(archive, 'a_old', multipliers%a_old)
      call exchange(archive, 'went', multipliers%went)
      call exchange(archive, 'grew', multipliers%grew)
      call exchange(archive, 'bound_grew', multipliers%bound_grew)
      call exchange(archive, 'were', multipliers%were)
      call exchange(archive, 'hold', multipliers%hold)
      call exchange(archive, 'pair', multipliers%pair)
      call exchange(archive, 'n_pairs', multipliers%n_pairs)
      call exchange(archive, 'n_contact_pairs', multipliers%n_contact_pairs)
      call exchange(archive, 'stiffness', multipliers%stiffness)
      call exchange(archive, 'pull', multipliers%pull)
      call exchange(archive, 'settled', multipliers%settled)
      call exchange(archive, 'changed', multipliers%changed)
   end subroutine exchange_multipliers

   subroutine exchange_observed_list(archive, list)
      type(archive_t), intent(inout) :: archive
      type(observed_list_t), intent(inout) :: list

      call exchange(archive, 'observed', list%n)
      call exchange(archive, 'step', list%step)
      call exchange(archive, 'increment', list%increment)
      call exchange(archive, 'time', list%time)
      call exchange(archive, 'values', list%values)
      if (list%n == 0 .or. .not. (archive%is_reading .and. is_sound(archive))) return
      call demand(archive, allocated(list%step) .and. allocated(list%increment) .and. allocated(list%time) &
                  .and. allocated(list%values), 'observed')
      if (.not. is_sound(archive)) return
      call demand(archive, all([size(list%step), size(list%increment), size(list%time), size(list%values, 2)] == list%n), &
                  'observed')
   end subroutine exchange_observed_list

   !> Column by column: there is a row of every increment and pair, in every file.
   subroutine exchange_rows(archive, list)
      type(archive_t), intent(inout) :: archive
      type(history_row_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n

      call exchange_length(archive, 'rows', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      if (n < 0) return
      call exchange_numbers(archive, 'step', list%step)
      call exchange_numbers(archive, 'increment', list%increment)
      call exchange_numbers(archive, 'pair', list%pair)
      call exchange_vector(archive, 'time', list%time)
      call exchange_vector(archive, 'normal', list%normal)
      call exchange_vector(archive, 'shear', list%shear)
      call exchange_vector(archive, 'moment', list%moment)
      call exchange_vector(archive, 'length', list%length)
      call exchange_vector(archive, 'centre', list%centre)
      call exchange_vector(archive, 'max_pressure', list%max_pressure)
      call exchange_numbers(archive, 'open', list%open)
      call exchange_numbers(archive, 'stick', list%stick)
      call exchange_numbers(archive, 'slip', list%slip)
      call exchange_vector(archive, 'dissipation', list%dissipation)
      call exchange_vector(archive, 'elastic_energy', list%elastic_energy)
      call exchange_vector(archive, 'unique_up_to_nu', list%unique_up_to_nu)
      call exchange_numbers(archive, 'index', list%index)
      call exchange_vector(archive, 'mean_slip', list%mean_slip)
   end subroutine exchange_rows

end module atrito_restart_file
