!> A history of two increments made by hand, with all that is hard to keep, and files that are damaged on purpose.
module restart_cases
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_fingerprint, only: fingerprint_t, take_fingerprint
   use atrito_hdf5, only: hdf5_file_t, open_hdf5, get_list, close_hdf5
   use atrito_kinds, only: ip, lp, wp
   use atrito_model, only: model_t
   use atrito_restart_file, only: write_restart, read_restart
   use atrito_restart_state, only: restart_state_t
   use atrito_results, only: history_t, results_t
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t
   use output_cases, only: make_model, make_results, make_contact, make_joints
   implicit none (type, external)
   private
   public :: make_history, write_case, try_bytes, read_bytes, write_bytes, FOLDER, NAME

   character(len=*), parameter :: FOLDER = 'restart_files', NAME = 'case.restart.h5'

contains

   subroutine make_history(model, history, state)
      type(model_t), intent(out) :: model
      type(history_t), intent(out) :: history
      type(restart_state_t), intent(out) :: state
      integer :: i

      call make_model(model)
      allocate (history%frames(2), history%rows(2), history%iterations(3))
      do i = 1, 2
         call make_results(history%frames(i))
         history%frames(i)%increment = i
         history%frames(i)%u(1, i) = -0.0_wp
         history%frames(i)%u(2, i) = ieee_value(1.0_wp, ieee_quiet_nan)
         history%frames(i)%verdict = repeat('a long verdict ', 500*(i - 1))
         if (.not. allocated(history%frames(i)%contact)) history%frames(i)%contact = [make_contact()]
         history%frames(i)%scene%left_out = [string_t('one'), string_t('')]
         history%frames(i)%row_force = [real(wp) ::]
      end do
      call make_joints(history%frames(2))
      history%rows%increment = [1_ip, 2_ip]
      history%rows%mean_slip = [0.125_wp, 0.3_wp]
      history%rows%centre = [ieee_value(1.0_wp, ieee_quiet_nan), 0.1_wp]
      history%iterations%inner = [1_ip, 2_ip, 1_ip]
      history%iterations%residual = [0.1_wp, tiny(1.0_wp)/4, huge(1.0_wp)]
      state%increment = 2
      state%last = history%frames(2)
      state%memory%rest = [1.0_wp/3, -0.0_wp]
      allocate (state%start%multipliers)
      state%start%multipliers%pair = [integer(ip) ::]
   end subroutine make_history

   subroutine write_case(model, history, state, status)
      type(model_t), intent(in) :: model
      type(history_t), intent(inout) :: history
      type(restart_state_t), intent(inout) :: state
      type(status_t), intent(out) :: status
      type(fingerprint_t) :: fingerprint

      call take_fingerprint(model, 'auto', fingerprint)
      call write_restart(FOLDER, NAME, fingerprint, history, state, status)
   end subroutine write_case

   !> Reads a file of these bytes. same: what was read is written again as it stands in the undamaged file.
   subroutine try_bytes(bytes, model, status, same)
      character(len=*), intent(in) :: bytes
      type(model_t), intent(in) :: model
      type(status_t), intent(out) :: status
      logical, intent(out) :: same
      type(history_t) :: history
      type(restart_state_t) :: state
      type(fingerprint_t) :: fingerprint
      type(status_t) :: writing

      call write_bytes(FOLDER//'/damaged.h5', bytes)
      call take_fingerprint(model, 'auto', fingerprint)
      call read_restart(FOLDER//'/damaged.h5', fingerprint, history, state, status)
      same = .false.
      if (.not. is_ok(status)) return
      call write_restart(FOLDER, 'again.h5', fingerprint, history, state, writing)
      if (is_ok(writing)) same = has_same_lists(FOLDER//'/again.h5', FOLDER//'/'//NAME)
   end subroutine try_bytes

   !> The lists of two files are equal bit by bit. The files need not be: the library leaves gaps.
   logical function has_same_lists(one, other)
      character(len=*), intent(in) :: one, other
      character(len=7), parameter :: PARTS(4) = ['origin ', 'state  ', 'frame_1', 'frame_2']
      type(hdf5_file_t) :: a, b
      type(status_t) :: status(2)
      real(wp), allocatable :: x(:), y(:)
      integer(lp), allocatable :: i(:), j(:)
      character(len=:), allocatable :: s, t
      integer :: k

      call open_hdf5(one, a)
      call open_hdf5(other, b)
      has_same_lists = .true.
      do k = 1, size(PARTS)
         call get_list(a, '/'//trim(PARTS(k))//'/reals', x)
         call get_list(b, '/'//trim(PARTS(k))//'/reals', y)
         call get_list(a, '/'//trim(PARTS(k))//'/integers', i)
         call get_list(b, '/'//trim(PARTS(k))//'/integers', j)
         call get_list(a, '/'//trim(PARTS(k))//'/text', s)
         call get_list(b, '/'//trim(PARTS(k))//'/text', t)
         has_same_lists = has_same_lists .and. size(x) == size(y) .and. size(i) == size(j) .and. len(s) == len(t)
         if (.not. has_same_lists) exit
         has_same_lists = all(transfer(x, [0_lp], size(x)) == transfer(y, [0_lp], size(y))) .and. all(i == j) .and. s == t
      end do
      call close_hdf5(a, status(1))
      call close_hdf5(b, status(2))
      has_same_lists = has_same_lists .and. is_ok(status(1)) .and. is_ok(status(2))
   end function has_same_lists

   function read_bytes(path) result(bytes)
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: bytes
      integer :: unit
      integer(lp) :: n

      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read')
      inquire (unit=unit, size=n)
      allocate (character(len=n) :: bytes)
      read (unit) bytes
      close (unit)
   end function read_bytes

   subroutine write_bytes(path, bytes)
      character(len=*), intent(in) :: path, bytes
      integer :: unit

      open (newunit=unit, file=path, access='stream', form='unformatted', status='replace', action='write')
      write (unit) bytes
      close (unit)
   end subroutine write_bytes

end module restart_cases
