!> The twin of src/fields/hdf5.f90 in a build without HDF5 (ATRITO_HDF5=OFF). A deck that asks for fields or restart files is
!> refused before it is solved; --restart comes here and fails.
module atrito_hdf5
   use atrito_kinds, only: ip, lp, wp
   use atrito_status, only: status_t, set_status, STATUS_FILE
   implicit none (type, external)
   private
   public :: hdf5_file_t, has_hdf5, create_hdf5, open_hdf5, put_array, put_attribute, put_list, get_list, close_hdf5

   !> The same components as with HDF5: the test of this twin links it with an archive that was compiled with the other.
   type :: hdf5_file_t
      type(status_t) :: status                                   !< always a failure, once it was opened
      integer(lp), private :: id = 0                             !< stays 0
      logical, private :: is_open = .false., has_lists = .false. !< stay false
      character(len=:), allocatable, private :: path             !< stays not allocated
   end type hdf5_file_t

   interface put_array
      module procedure put_real_array, put_integer_array
   end interface put_array

   interface put_attribute
      module procedure put_text_attribute, put_integer_attribute
   end interface put_attribute

   interface put_list
      module procedure put_reals, put_longs, put_text
   end interface put_list

   interface get_list
      module procedure get_reals, get_longs, get_text
   end interface get_list

contains

   !> This build has no HDF5.
   pure logical function has_hdf5()
      has_hdf5 = .false.
   end function has_hdf5

   !> The file fails: this build has no HDF5.
   subroutine create_hdf5(path, final_path, has_lists, file)
      character(len=*), intent(in) :: path, final_path !< not used; what the message calls it
      logical, intent(in) :: has_lists                 !< not used
      type(hdf5_file_t), intent(out) :: file           !< failed: STATUS_FILE

      call set_status(file%status, STATUS_FILE, final_path//': this build of atrito has no HDF5')
   end subroutine create_hdf5

   !> The file fails: this build has no HDF5.
   subroutine open_hdf5(path, file)
      character(len=*), intent(in) :: path       !< for the message
      type(hdf5_file_t), intent(out) :: file     !< failed: STATUS_FILE

      call set_status(file%status, STATUS_FILE, path//': this build of atrito has no HDF5')
   end subroutine open_hdf5

   subroutine put_real_array(file, path, values, name, dimension)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name, dimension
      real(wp), contiguous, target, intent(in) :: values(:, :)
   end subroutine put_real_array

   subroutine put_integer_array(file, path, values, name, dimension)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name, dimension
      integer(ip), contiguous, target, intent(in) :: values(:, :)
   end subroutine put_integer_array

   subroutine put_text_attribute(file, path, name, text)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name, text
   end subroutine put_text_attribute

   subroutine put_integer_attribute(file, path, name, number)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name
      integer(ip), intent(in) :: number
   end subroutine put_integer_attribute

   subroutine put_reals(file, path, values)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      real(wp), contiguous, target, intent(in) :: values(:)
   end subroutine put_reals

   subroutine put_longs(file, path, values)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(lp), contiguous, target, intent(in) :: values(:)
   end subroutine put_longs

   subroutine put_text(file, path, text)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      character(len=*), target, intent(in) :: text
   end subroutine put_text

   subroutine get_reals(file, path, values)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      real(wp), allocatable, target, intent(out) :: values(:)

      allocate (values(0))
   end subroutine get_reals

   subroutine get_longs(file, path, values)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(lp), allocatable, target, intent(out) :: values(:)

      allocate (values(0))
   end subroutine get_longs

   subroutine get_text(file, path, text)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      character(len=:), allocatable, target, intent(out) :: text

      allocate (character(len=0) :: text)
   end subroutine get_text

   !> status: STATUS_FILE, of create_hdf5 or open_hdf5.
   subroutine close_hdf5(file, status)
      type(hdf5_file_t), intent(inout) :: file   !< failed
      type(status_t), intent(out) :: status      !< STATUS_FILE

      status = file%status
   end subroutine close_hdf5

end module atrito_hdf5
