!> An HDF5 file of plain lists, written or read whole: what a restart file is made of. Beside atrito_hdf5 the only module that sees
!> the HDF5 library; src/fields/without_hdf5/ has its twin.
!>
!> Every list has a checksum (Fletcher's), and so has whatever the library keeps of its own (format of version 1.10), so that a
!> byte that was changed is found when it is read. The first failure is kept in the file; later calls do nothing.
module atrito_hdf5_arrays
   use, intrinsic :: iso_c_binding, only: c_loc, c_null_char, c_ptr
   use atrito_kinds, only: lp, wp
   use atrito_paths, only: remove_file
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use hdf5, only: hid_t, hsize_t, h5open_f, h5close_f, h5dont_atexit_f, h5eset_auto_f, h5fcreate_f, h5fopen_f, h5fclose_f, &
                   h5fis_hdf5_f, H5F_ACC_EXCL_F, H5F_ACC_RDONLY_F, H5F_LIBVER_LATEST_F, h5pcreate_f, h5pclose_f, &
                   h5pset_libver_bounds_f, h5pset_create_inter_group_f, h5pset_chunk_f, h5pset_fletcher32_f, h5pset_fill_time_f, &
                   H5D_FILL_TIME_NEVER_F, h5pset_obj_track_times_f, H5P_FILE_ACCESS_F, H5P_LINK_CREATE_F, H5P_DATASET_CREATE_F, &
                   h5screate_simple_f, h5sclose_f, h5sget_simple_extent_ndims_f, h5sget_simple_extent_dims_f, h5dcreate_f, &
                   h5dopen_f, h5dwrite_f, h5dread_f, h5dclose_f, h5dget_space_f, h5dget_type_f, h5tequal_f, h5tclose_f, &
                   h5kind_to_type, h5fget_filesize_f, h5tget_size_f, size_t, H5_INTEGER_KIND, H5T_NATIVE_DOUBLE, &
                   H5T_NATIVE_CHARACTER
   implicit none (type, external)
   private
   public :: hdf5_arrays_t, create_arrays, open_arrays, put_list, get_list, outcome_of, close_arrays

   integer(hsize_t), parameter :: MOST_IN_CHUNK = 65536

   type :: hdf5_arrays_t
      private
      integer(hid_t) :: id = 0
      logical :: is_open = .false.
      character(len=:), allocatable :: path        !< for messages
      type(status_t) :: status                     !< first failure
   end type hdf5_arrays_t

   !> Writes a list under a path, /group/.../name; it may be empty.
   interface put_list
      module procedure put_reals, put_longs, put_text
   end interface put_list

   !> Reads a list that put_list wrote.
   interface get_list
      module procedure get_reals, get_longs, get_text
   end interface get_list

contains

   !> Creates a file, not what a link leads to. The library trims names: a zero ends them before a blank does.
   subroutine create_arrays(path, final_path, file)
      character(len=*), intent(in) :: path            !< where it is written
      character(len=*), intent(in) :: final_path      !< what messages call it
      type(hdf5_arrays_t), intent(out) :: file
      integer(hid_t) :: access
      integer :: error(4)

      call start_library(final_path, file)
      if (.not. is_ok(file%status)) return
      call h5pcreate_f(H5P_FILE_ACCESS_F, access, error(1))
      call h5pset_libver_bounds_f(access, H5F_LIBVER_LATEST_F, H5F_LIBVER_LATEST_F, error(2))
      call remove_file(path)
      call h5fcreate_f(path//c_null_char, H5F_ACC_EXCL_F, file%id, error(3), access_prp=access)
      call h5pclose_f(access, error(4))
      file%is_open = error(3) >= 0
      if (minval(error) < 0) call set_status(file%status, STATUS_FILE, final_path//': cannot be written')
   end subroutine create_arrays

   !> Opens a file to be read.
   subroutine open_arrays(path, file)
      character(len=*), intent(in) :: path
      type(hdf5_arrays_t), intent(out) :: file
      logical :: is_hdf5
      integer :: error

      call start_library(path, file)
      if (.not. is_ok(file%status)) return
      call h5fis_hdf5_f(path//c_null_char, is_hdf5, error)
      if (error < 0 .or. .not. is_hdf5) then
         call set_status(file%status, STATUS_FILE, path//': is no HDF5 file, or its beginning is damaged')
         return
      end if
      call h5fopen_f(path//c_null_char, H5F_ACC_RDONLY_F, file%id, error)
      file%is_open = error >= 0
      if (error < 0) call set_status(file%status, STATUS_FILE, path//': is damaged: it is cut off, or its beginning was changed')
   end subroutine open_arrays

   !> Starts the library, which is silent and leaves the end of the program alone.
   subroutine start_library(path, file)
      character(len=*), intent(in) :: path
      type(hdf5_arrays_t), intent(inout) :: file
      integer :: error

      file%path = path
      call h5dont_atexit_f(error)
      call h5open_f(error)
      if (error < 0) then
         call set_status(file%status, STATUS_FILE, path//': the HDF5 library cannot be started')
      else
         call h5eset_auto_f(0, error)
      end if
   end subroutine start_library

   subroutine put_reals(file, path, values)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      real(wp), contiguous, target, intent(in) :: values(:)
      integer(hid_t) :: dataset

      call create_list(file, path, H5T_NATIVE_DOUBLE, size(values, kind=hsize_t), dataset)
      if (is_ok(file%status)) call write_list(file, dataset, H5T_NATIVE_DOUBLE, c_loc(values), size(values) > 0)
   end subroutine put_reals

   subroutine put_longs(file, path, values)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(lp), contiguous, target, intent(in) :: values(:)
      integer(hid_t) :: dataset, kind

      kind = h5kind_to_type(lp, H5_INTEGER_KIND)
      call create_list(file, path, kind, size(values, kind=hsize_t), dataset)
      if (is_ok(file%status)) call write_list(file, dataset, kind, c_loc(values), size(values) > 0)
   end subroutine put_longs

   !> A list of single characters.
   subroutine put_text(file, path, text)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      character(len=*), target, intent(in) :: text
      integer(hid_t) :: dataset

      call create_list(file, path, H5T_NATIVE_CHARACTER, len(text, kind=hsize_t), dataset)
      if (is_ok(file%status)) call write_list(file, dataset, H5T_NATIVE_CHARACTER, c_loc(text), len(text) > 0)
   end subroutine put_text

   !> A dataset with a checksum for every chunk, and without dates.
   subroutine create_list(file, path, kind, n, dataset)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(hid_t), intent(in) :: kind
      integer(hsize_t), intent(in) :: n
      integer(hid_t), intent(out) :: dataset
      integer(hid_t) :: space, creation, link
      integer :: error(9)

      dataset = 0
      if (.not. is_ok(file%status)) return
      error = 0
      call h5screate_simple_f(1, [n], space, error(1))
      call h5pcreate_f(H5P_DATASET_CREATE_F, creation, error(2))
      call h5pset_obj_track_times_f(creation, .false., error(3))
      if (n > 0) then
         call h5pset_chunk_f(creation, 1, [min(n, MOST_IN_CHUNK)], error(4))
         call h5pset_fletcher32_f(creation, error(5))
         call h5pset_fill_time_f(creation, H5D_FILL_TIME_NEVER_F, error(9))   ! all of it is written
      end if
      call h5pcreate_f(H5P_LINK_CREATE_F, link, error(6))
      call h5pset_create_inter_group_f(link, 1, error(7))
      call h5dcreate_f(file%id, path, kind, space, dataset, error(8), dcpl_id=creation, lcpl_id=link)
      if (minval(error) < 0) call fail_to_write(file)
      call h5pclose_f(creation, error(1))
      call h5pclose_f(link, error(1))
      call h5sclose_f(space, error(1))
   end subroutine create_list

   subroutine write_list(file, dataset, kind, address, is_any)
      type(hdf5_arrays_t), intent(inout) :: file
      integer(hid_t), intent(in) :: dataset, kind
      type(c_ptr), intent(in) :: address
      logical, intent(in) :: is_any
      integer :: error(2)

      error = 0
      if (is_any) call h5dwrite_f(dataset, kind, address, error(1))
      call h5dclose_f(dataset, error(2))
      if (minval(error) < 0) call fail_to_write(file)
   end subroutine write_list

   subroutine fail_to_write(file)
      type(hdf5_arrays_t), intent(inout) :: file

      if (is_ok(file%status)) call set_status(file%status, STATUS_FILE, &
                                              file%path//': cannot be written completely; is the disk full?')
   end subroutine fail_to_write

   subroutine get_reals(file, path, values)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      real(wp), allocatable, target, intent(out) :: values(:)
      integer(hid_t) :: dataset
      integer(hsize_t) :: n
      integer :: ios

      call open_list(file, path, H5T_NATIVE_DOUBLE, n, dataset)
      allocate (values(n), stat=ios)
      if (ios == 0) call read_list(file, path, dataset, H5T_NATIVE_DOUBLE, c_loc(values), n > 0)
      if (ios /= 0) call find_damaged(file, path)
   end subroutine get_reals

   subroutine get_longs(file, path, values)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(lp), allocatable, target, intent(out) :: values(:)
      integer(hid_t) :: dataset, kind
      integer(hsize_t) :: n
      integer :: ios

      kind = 0
      if (is_ok(file%status)) kind = h5kind_to_type(lp, H5_INTEGER_KIND)
      call open_list(file, path, kind, n, dataset)
      allocate (values(n), stat=ios)
      if (ios == 0) call read_list(file, path, dataset, kind, c_loc(values), n > 0)
      if (ios /= 0) call find_damaged(file, path)
   end subroutine get_longs

   subroutine get_text(file, path, text)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      character(len=:), allocatable, target, intent(out) :: text
      integer(hid_t) :: dataset
      integer(hsize_t) :: n
      integer :: ios

      call open_list(file, path, H5T_NATIVE_CHARACTER, n, dataset)
      allocate (character(len=n) :: text, stat=ios)
      if (ios == 0) call read_list(file, path, dataset, H5T_NATIVE_CHARACTER, c_loc(text), n > 0)
      if (ios /= 0) call find_damaged(file, path)
   end subroutine get_text

   !> Opens a dataset of a kind that must be a list; n is 0 after a failure.
   subroutine open_list(file, path, kind, n, dataset)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(hid_t), intent(in) :: kind
      integer(hsize_t), intent(out) :: n
      integer(hid_t), intent(out) :: dataset
      integer(hid_t) :: space, found
      integer(hsize_t) :: dims(1), most(1)
      integer :: rank, error
      logical :: same

      n = 0
      dataset = 0
      if (.not. is_ok(file%status)) return
      call h5dopen_f(file%id, path, dataset, error)
      if (error < 0) then
         call set_status(file%status, STATUS_FILE, file%path//': is damaged: '//path//' is missing')
         return
      end if
      call h5dget_type_f(dataset, found, error)
      call h5tequal_f(found, kind, same, error)
      call h5tclose_f(found, error)
      call h5dget_space_f(dataset, space, error)
      call h5sget_simple_extent_ndims_f(space, rank, error)
      if (same .and. rank == 1) call h5sget_simple_extent_dims_f(space, dims, most, error)
      if (same .and. rank == 1 .and. error >= 0) then
         if (fits_file(file, kind, dims(1))) n = dims(1)
         if (n < dims(1)) call find_damaged(file, path)
      else
         call find_damaged(file, path)
      end if
      call h5sclose_f(space, error)
   end subroutine open_list

   !> No list holds more than the file: nothing is compressed. So memory is only asked for what is there.
   logical function fits_file(file, kind, n)
      type(hdf5_arrays_t), intent(in) :: file
      integer(hid_t), intent(in) :: kind
      integer(hsize_t), intent(in) :: n
      integer(hsize_t) :: in_file
      integer(size_t) :: bytes
      integer :: error(2)

      call h5fget_filesize_f(file%id, in_file, error(1))
      call h5tget_size_f(kind, bytes, error(2))
      fits_file = minval(error) >= 0
      if (fits_file) fits_file = n <= in_file/max(bytes, 1_size_t)
   end function fits_file

   subroutine read_list(file, path, dataset, kind, address, is_any)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(hid_t), intent(in) :: dataset, kind
      type(c_ptr), intent(in) :: address
      logical, intent(in) :: is_any
      type(c_ptr) :: place
      integer :: error

      if (dataset == 0) return
      error = 0
      place = address
      if (is_any) call h5dread_f(dataset, kind, place, error)
      if (error < 0) call find_damaged(file, path)
      call h5dclose_f(dataset, error)
   end subroutine read_list

   subroutine find_damaged(file, path)
      type(hdf5_arrays_t), intent(inout) :: file
      character(len=*), intent(in) :: path

      if (is_ok(file%status)) call set_status(file%status, STATUS_FILE, file%path//': is damaged: '//path//' cannot be read')
   end subroutine find_damaged

   !> How it went so far.
   subroutine outcome_of(file, status)
      type(hdf5_arrays_t), intent(in) :: file
      type(status_t), intent(out) :: status

      status = file%status
   end subroutine outcome_of

   !> Ends a file. status: STATUS_FILE when any part of it could not be written or read.
   subroutine close_arrays(file, status)
      type(hdf5_arrays_t), intent(inout) :: file
      type(status_t), intent(out) :: status
      integer :: error

      if (file%is_open) then
         call h5fclose_f(file%id, error)
         if (error < 0) call fail_to_write(file)
      end if
      file%is_open = .false.
      ! what could not be written hangs in the library, which is left as it is
      if (is_ok(file%status)) call h5close_f(error)
      status = file%status
   end subroutine close_arrays

end module atrito_hdf5_arrays
