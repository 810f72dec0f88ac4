!> The twin of src/fields/hdf5.f90 in a build without HDF5 (ATRITO_HDF5=OFF). A deck that asks for fields is refused before
!> it is solved, so nothing here is reached; open_hdf5 fails all the same.
module atrito_hdf5
   use atrito_kinds, only: ip, wp
   use atrito_status, only: status_t, set_status, STATUS_FILE
   implicit none (type, external)
   private
   public :: hdf5_file_t, has_hdf5, open_hdf5, begin_dataset, put_row, put_attribute, close_hdf5

   type :: hdf5_file_t
      private
      type(status_t) :: status
   end type hdf5_file_t

   interface put_row
      module procedure put_real_row, put_integer_row
   end interface put_row

   interface put_attribute
      module procedure put_text_attribute, put_integer_attribute
   end interface put_attribute

contains

   !> This build has no HDF5.
   pure logical function has_hdf5()
      has_hdf5 = .false.
   end function has_hdf5

   !> The file fails: this build has no HDF5.
   subroutine open_hdf5(path, final_path, file)
      character(len=*), intent(in) :: path, final_path
      type(hdf5_file_t), intent(out) :: file

      if (len(path) > 0) call set_status(file%status, STATUS_FILE, final_path//': this build of atrito has no HDF5')
   end subroutine open_hdf5

   !> Does nothing.
   subroutine begin_dataset(file, path, n_components, n_rows, is_real, name, dimension)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name, dimension
      integer(ip), intent(in) :: n_components, n_rows
      logical, intent(in) :: is_real
   end subroutine begin_dataset

   subroutine put_real_row(file, values)
      type(hdf5_file_t), intent(inout) :: file
      real(wp), intent(in) :: values(:)
   end subroutine put_real_row

   subroutine put_integer_row(file, values)
      type(hdf5_file_t), intent(inout) :: file
      integer(ip), intent(in) :: values(:)
   end subroutine put_integer_row

   subroutine put_text_attribute(file, path, name, text)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name, text
   end subroutine put_text_attribute

   subroutine put_integer_attribute(file, path, name, number)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name
      integer(ip), intent(in) :: number
   end subroutine put_integer_attribute

   !> status: STATUS_FILE, of open_hdf5.
   subroutine close_hdf5(file, status)
      type(hdf5_file_t), intent(inout) :: file
      type(status_t), intent(out) :: status

      status = file%status
   end subroutine close_hdf5

end module atrito_hdf5
