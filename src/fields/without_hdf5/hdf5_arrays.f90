!> The twin of src/fields/hdf5_arrays.f90 in a build without HDF5 (ATRITO_HDF5=OFF). A deck that asks for restart files is
!> refused before it is solved; --restart comes here and fails.
module atrito_hdf5_arrays
   use atrito_kinds, only: lp, wp
   use atrito_status, only: status_t, set_status, STATUS_FILE
   implicit none (type, external)
   private
   public :: hdf5_arrays_t, create_arrays, open_arrays, put_list, get_list, outcome_of, close_arrays

   !> The same components as with HDF5: the test of this twin links it with an archive that was compiled with the other.
   type :: hdf5_arrays_t
      private
      integer(lp) :: id = 0
      logical :: is_open = .false.
      character(len=:), allocatable :: path
      type(status_t) :: status
   end type hdf5_arrays_t

   interface put_list
      module procedure put_reals, put_longs, put_text
   end interface put_list

   interface get_list
      module procedure get_reals, get_longs, get_text
   end interface get_list

contains

   !> The file fails: this build has no HDF5.
   subroutine create_arrays(path, final_path, file)
      character(len=*), intent(in) :: path, final_path
      type(hdf5_arrays_t), intent(out) :: file

      if (len(path) > 0) call set_status(file%status, STATUS_FILE, final_path//': this build of atrito has no HDF5')
   end subroutine create_arrays

   !> The file fails: this build has no HDF5.
   subroutine open_arrays(path, file)
      character(len=*), intent(in) :: path
      type(hdf5_arrays_t), intent(out) :: file

      call set_status(file%status, STATUS_FILE, path//': this build of atrito has no HDF5')
   end subroutine open_arrays

   subroutine put_reals(file, path, values)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      real(wp), contiguous, target, intent(in) :: values(:)
   end subroutine put_reals

   subroutine put_longs(file, path, values)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(lp), contiguous, target, intent(in) :: values(:)
   end subroutine put_longs

   subroutine put_text(file, path, text)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      character(len=*), target, intent(in) :: text
   end subroutine put_text

   subroutine get_reals(file, path, values)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      real(wp), allocatable, target, intent(out) :: values(:)

      allocate (values(0))
   end subroutine get_reals

   subroutine get_longs(file, path, values)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(lp), allocatable, target, intent(out) :: values(:)

      allocate (values(0))
   end subroutine get_longs

   subroutine get_text(file, path, text)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      character(len=:), allocatable, target, intent(out) :: text

      allocate (character(len=0) :: text)
   end subroutine get_text

   !> status: STATUS_FILE, of create_arrays or open_arrays.
   subroutine outcome_of(file, status)
      type(hdf5_arrays_t), intent(in) :: file
      type(status_t), intent(out) :: status

      status = file%status
   end subroutine outcome_of

   !> status: STATUS_FILE, of create_arrays or open_arrays.
   subroutine close_arrays(file, status)
      type(hdf5_arrays_t), intent(inout) :: file
      type(status_t), intent(out) :: status

      status = file%status
   end subroutine close_arrays

end module atrito_hdf5_arrays
