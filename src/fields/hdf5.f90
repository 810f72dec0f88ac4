!> HDF5 files: the only module that sees the HDF5 library. src/fields/without_hdf5/ has its twin for a build without it.
!>
!> A file of fields is written: arrays, compressed by chunks of rows, with attributes that say what they are. A restart file is
!> written or read: plain lists. Every list has a checksum (Fletcher's), and so has whatever the library keeps of its own (format of
!> version 1.10), so that a byte that was changed is found when it is read.
!>
!> The first failure is kept in the file; later calls do nothing.
module atrito_hdf5
   use, intrinsic :: iso_c_binding, only: c_int, c_int64_t, c_loc, c_null_char, c_ptr
   use atrito_kinds, only: ip, lp, wp
   use atrito_paths, only: remove_file
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use hdf5, only: hid_t, hsize_t, size_t, h5open_f, h5close_f, h5dont_atexit_f, h5eset_auto_f, h5fcreate_f, h5fopen_f, &
                   h5fclose_f, h5fis_hdf5_f, h5fget_filesize_f, H5F_ACC_EXCL_F, H5F_ACC_RDONLY_F, H5F_LIBVER_LATEST_F, &
                   h5pcreate_f, h5pclose_f, h5pset_libver_bounds_f, h5pset_create_inter_group_f, h5pset_chunk_f, &
                   h5pset_fletcher32_f, h5pset_fill_time_f, h5pset_shuffle_f, h5pset_deflate_f, h5pset_obj_track_times_f, &
                   H5D_FILL_TIME_NEVER_F, H5P_FILE_ACCESS_F, H5P_LINK_CREATE_F, H5P_DATASET_CREATE_F, h5screate_f, &
                   h5screate_simple_f, h5sclose_f, H5S_SCALAR_F, h5sget_simple_extent_ndims_f, h5sget_simple_extent_dims_f, &
                   h5dcreate_f, h5dopen_f, h5dwrite_f, h5dread_f, h5dclose_f, h5dget_space_f, h5dget_type_f, h5acreate_by_name_f, &
                   h5awrite_f, h5aclose_f, h5tequal_f, h5tclose_f, h5tget_size_f, h5tcopy_f, h5tset_cset_f, H5T_CSET_UTF8_F, &
                   H5T_STRING, h5kind_to_type, H5_INTEGER_KIND, H5T_NATIVE_DOUBLE, H5T_NATIVE_INTEGER, H5T_NATIVE_CHARACTER
   implicit none (type, external)
   private
   public :: hdf5_file_t, has_hdf5, create_hdf5, open_hdf5, put_array, put_attribute, put_list, get_list, close_hdf5

   integer(hsize_t), parameter :: ROWS_IN_CHUNK = 4096, MOST_IN_CHUNK = 65536   !< of arrays and of lists
   integer, parameter :: DEFLATE_LEVEL = 4         !< of 0..9; higher ones are slow and gain little

   !> An HDF5 file of fields or of lists.
   type :: hdf5_file_t
      type(status_t) :: status                     !< first failure
      integer(hid_t), private :: id = 0                            !< of the library
      logical, private :: is_open = .false., has_lists = .false.   !< lists with checksums; else fields
      character(len=:), allocatable, private :: path               !< for messages
   end type hdf5_file_t

   !> Writes an array (components, rows) of a file of fields under a path, /group/.../name; with one component it is a list there.
   interface put_array
      module procedure put_real_array, put_integer_array
   end interface put_array

   !> Gives a dataset or a group (path), or the file itself ('/'), an attribute.
   interface put_attribute
      module procedure put_text_attribute, put_integer_attribute
   end interface put_attribute

   !> Writes a list under a path, /group/.../name; it may be empty.
   interface put_list
      module procedure put_reals, put_longs, put_text
   end interface put_list

   !> Reads a list that put_list wrote.
   interface get_list
      module procedure get_reals, get_longs, get_text
   end interface get_list

   interface
      !> Of the C library; its Fortran one does not have it.
      integer(c_int) function h5pset_evict_on_close(access, is_so) bind(C, name='H5Pset_evict_on_close')
         import :: c_int, c_int64_t
         integer(c_int64_t), value :: access
         integer(c_int), value :: is_so
      end function h5pset_evict_on_close
   end interface

contains

   !> This build can write HDF5 files.
   pure logical function has_hdf5()
      has_hdf5 = .true.
   end function has_hdf5

   !> Creates a file, not what a link leads to. The library trims names: a zero ends them before a blank does.
   subroutine create_hdf5(path, final_path, has_lists, file)
      character(len=*), intent(in) :: path            !< where it is written
      character(len=*), intent(in) :: final_path      !< what messages call it
      logical, intent(in) :: has_lists                !< of put_list; else arrays and attributes
      type(hdf5_file_t), intent(out) :: file          !< open; its status tells a failure
      integer(hid_t) :: access
      integer :: error(4)

      call start_library(final_path, file)
      if (.not. is_ok(file%status)) return
      file%has_lists = has_lists
      call h5pcreate_f(H5P_FILE_ACCESS_F, access, error(1))
      if (has_lists) then
         call h5pset_libver_bounds_f(access, H5F_LIBVER_LATEST_F, H5F_LIBVER_LATEST_F, error(2))
      else                                            ! or the library keeps up to 32 MiB of datasets that are complete
         error(2) = int(h5pset_evict_on_close(int(access, c_int64_t), 1_c_int))
      end if
      call remove_file(path)
      call h5fcreate_f(path//c_null_char, H5F_ACC_EXCL_F, file%id, error(3), access_prp=access)
      call h5pclose_f(access, error(4))
      file%is_open = error(3) >= 0
      if (minval(error) < 0) call set_status(file%status, STATUS_FILE, final_path//': cannot be written')
   end subroutine create_hdf5

   !> Opens a file to be read.
   subroutine open_hdf5(path, file)
      character(len=*), intent(in) :: path            !< of the file
      type(hdf5_file_t), intent(out) :: file          !< open; its status tells a failure
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
   end subroutine open_hdf5

   !> Starts the library, which is silent and leaves the end of the program alone: after a failure it would try again there, on a
   !> file that is gone.
   subroutine start_library(path, file)
      character(len=*), intent(in) :: path
      type(hdf5_file_t), intent(inout) :: file
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

   subroutine put_real_array(file, path, values, name, dimension)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      real(wp), contiguous, target, intent(in) :: values(:, :)   !< (components, rows), none of them 0
      character(len=*), intent(in) :: name, dimension !< what it is, in words, and in F and L ('-': none), as attributes

      call write_dataset(file, path, H5T_NATIVE_DOUBLE, shape(values, kind=hsize_t), c_loc(values))
      call put_attribute(file, path, 'name', name)
      call put_attribute(file, path, 'dimension', dimension)
   end subroutine put_real_array

   subroutine put_integer_array(file, path, values, name, dimension)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(ip), contiguous, target, intent(in) :: values(:, :)
      character(len=*), intent(in) :: name, dimension

      call write_dataset(file, path, H5T_NATIVE_INTEGER, shape(values, kind=hsize_t), c_loc(values))
      call put_attribute(file, path, 'name', name)
      call put_attribute(file, path, 'dimension', dimension)
   end subroutine put_integer_array

   subroutine put_reals(file, path, values)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      real(wp), contiguous, target, intent(in) :: values(:)

      call write_dataset(file, path, H5T_NATIVE_DOUBLE, [1_hsize_t, size(values, kind=hsize_t)], c_loc(values))
   end subroutine put_reals

   subroutine put_longs(file, path, values)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(lp), contiguous, target, intent(in) :: values(:)

      call write_dataset(file, path, h5kind_to_type(lp, H5_INTEGER_KIND), [1_hsize_t, size(values, kind=hsize_t)], c_loc(values))
   end subroutine put_longs

   !> A list of single characters.
   subroutine put_text(file, path, text)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      character(len=*), target, intent(in) :: text

      call write_dataset(file, path, H5T_NATIVE_CHARACTER, [1_hsize_t, len(text, kind=hsize_t)], c_loc(text))
   end subroutine put_text

   !> A dataset of an array (components, rows): an array of one component becomes a list. Fortran's first index is the last one of
   !> HDF5. Groups on its path are made where they are missing. There are no dates, so that equal runs write equal files.
   subroutine write_dataset(file, path, kind, dims, address)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path
      integer(hid_t), intent(in) :: kind
      integer(hsize_t), intent(in) :: dims(2)
      type(c_ptr), intent(in) :: address
      integer(hid_t) :: dataset, space, creation, link
      integer :: rank, error(11)

      if (.not. is_ok(file%status)) return
      error = 0
      rank = merge(1, 2, dims(1) == 1)
      call h5screate_simple_f(rank, dims(3 - rank:), space, error(1))
      call h5pcreate_f(H5P_DATASET_CREATE_F, creation, error(2))
      call h5pset_obj_track_times_f(creation, .false., error(3))
      if (.not. file%has_lists) then
         call h5pset_chunk_f(creation, rank, [dims(1:rank - 1), min(dims(2), ROWS_IN_CHUNK)], error(4))
         call h5pset_shuffle_f(creation, error(5))
         call h5pset_deflate_f(creation, DEFLATE_LEVEL, error(9))
      else if (dims(2) > 0) then
         call h5pset_chunk_f(creation, 1, [min(dims(2), MOST_IN_CHUNK)], error(4))
         call h5pset_fletcher32_f(creation, error(5))
         call h5pset_fill_time_f(creation, H5D_FILL_TIME_NEVER_F, error(9))   ! all of it is written
      end if
      call h5pcreate_f(H5P_LINK_CREATE_F, link, error(6))
      call h5pset_create_inter_group_f(link, 1, error(7))
      call h5dcreate_f(file%id, path, kind, space, dataset, error(8), dcpl_id=creation, lcpl_id=link)
      if (error(8) >= 0 .and. dims(2) > 0) call h5dwrite_f(dataset, kind, address, error(10))
      if (error(8) >= 0) call h5dclose_f(dataset, error(11))
      call keep(file, minval(error))
      call h5pclose_f(creation, error(1))
      call h5pclose_f(link, error(1))
      call h5sclose_f(space, error(1))
   end subroutine write_dataset

   !> Keeps the first failure to write.
   subroutine keep(file, error)
      type(hdf5_file_t), intent(inout) :: file
      integer, intent(in) :: error                    !< < 0: failed

      if (error >= 0 .or. .not. is_ok(file%status)) return
      call set_status(file%status, STATUS_FILE, file%path//': cannot be written completely; is the disk full?')
   end subroutine keep

   !> Text of any length in UTF-8, which every reader takes for a string.
   subroutine put_text_attribute(file, path, name, text)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name, text
      character(len=len(text) + 1), target :: c_text
      type(c_ptr), target :: address(1)
      integer(hid_t) :: kind, attribute
      integer :: error(4)

      if (.not. is_ok(file%status)) return
      c_text = text//c_null_char
      address(1) = c_loc(c_text)
      call h5tcopy_f(H5T_STRING, kind, error(1))
      call h5tset_cset_f(kind, H5T_CSET_UTF8_F, error(2))
      call create_attribute(file, path, name, kind, attribute)
      call h5awrite_f(attribute, kind, c_loc(address(1)), error(3))
      call h5aclose_f(attribute, error(4))
      call keep(file, minval(error))
      call h5tclose_f(kind, error(1))
   end subroutine put_text_attribute

   subroutine put_integer_attribute(file, path, name, number)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name
      integer(ip), intent(in) :: number
      integer(hid_t) :: attribute
      integer :: error(2)
      integer(hsize_t), parameter :: NO_DIMENSIONS(1) = 0

      if (.not. is_ok(file%status)) return
      call create_attribute(file, path, name, H5T_NATIVE_INTEGER, attribute)
      call h5awrite_f(attribute, H5T_NATIVE_INTEGER, number, NO_DIMENSIONS, error(1))
      call h5aclose_f(attribute, error(2))
      call keep(file, minval(error))
   end subroutine put_integer_attribute

   subroutine create_attribute(file, path, name, kind, attribute)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path, name
      integer(hid_t), intent(in) :: kind
      integer(hid_t), intent(out) :: attribute
      integer(hid_t) :: space
      integer :: error(3)

      call h5screate_f(H5S_SCALAR_F, space, error(1))
      call h5acreate_by_name_f(file%id, path, name, kind, space, attribute, error(2))
      call h5sclose_f(space, error(3))
      call keep(file, minval(error))
   end subroutine create_attribute

   subroutine get_reals(file, path, values)
      type(hdf5_file_t), intent(inout) :: file
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
      type(hdf5_file_t), intent(inout) :: file
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
      type(hdf5_file_t), intent(inout) :: file
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
      type(hdf5_file_t), intent(inout) :: file
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
      type(hdf5_file_t), intent(in) :: file
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
      type(hdf5_file_t), intent(inout) :: file
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
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path

      if (is_ok(file%status)) call set_status(file%status, STATUS_FILE, file%path//': is damaged: '//path//' cannot be read')
   end subroutine find_damaged

   !> Ends a file. status: STATUS_FILE when any part of it could not be written or read.
   subroutine close_hdf5(file, status)
      type(hdf5_file_t), intent(inout) :: file        !< open or failed; closed on return
      type(status_t), intent(out) :: status           !< STATUS_OK, or its first failure: STATUS_FILE
      integer :: error

      if (file%is_open) call h5fclose_f(file%id, error)
      if (file%is_open) call keep(file, error)
      file%is_open = .false.
      ! what could not be written hangs in the library, which is left as it is
      if (is_ok(file%status)) call h5close_f(error)
      status = file%status
   end subroutine close_hdf5

end module atrito_hdf5
