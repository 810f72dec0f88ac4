!> An HDF5 file being written: the only module that sees the HDF5 library. src/fields/without_hdf5/ has its twin for a build
!> without it.
!>
!> A dataset is begun with its size and filled row by row; rows are collected into chunks, so no second copy of a field is made.
!> The first failure is kept in the file until close_hdf5; later calls do nothing.
module atrito_hdf5
   use, intrinsic :: iso_c_binding, only: c_int, c_int64_t, c_loc, c_null_char, c_ptr
   use atrito_kinds, only: ip, wp
   use atrito_paths, only: remove_file
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use hdf5, only: hid_t, hsize_t, h5open_f, h5close_f, h5dont_atexit_f, h5eset_auto_f, h5fcreate_f, h5fclose_f, H5F_ACC_EXCL_F, &
                   h5pcreate_f, h5pclose_f, h5pset_create_inter_group_f, h5pset_chunk_f, h5pset_shuffle_f, h5pset_deflate_f, &
                   h5pset_obj_track_times_f, H5P_LINK_CREATE_F, H5P_FILE_ACCESS_F, H5P_DATASET_CREATE_F, h5screate_f, &
                   h5screate_simple_f, h5sclose_f, h5sselect_hyperslab_f, H5S_SCALAR_F, H5S_SELECT_SET_F, h5dcreate_f, h5dwrite_f, &
                   h5dclose_f, h5acreate_by_name_f, h5awrite_f, h5aclose_f, h5tcopy_f, h5tclose_f, h5tset_cset_f, H5T_CSET_UTF8_F, &
                   H5T_STRING, H5T_NATIVE_DOUBLE, H5T_NATIVE_INTEGER
   implicit none (type, external)
   private
   public :: hdf5_file_t, has_hdf5, open_hdf5, begin_dataset, put_row, put_attribute, close_hdf5

   integer, parameter :: CHUNK_ROWS = 4096
   integer, parameter :: DEFLATE_LEVEL = 4         !< of 0..9; higher ones are slow and gain little

   type :: hdf5_file_t
      private
      integer(hid_t) :: id = 0
      character(len=:), allocatable :: final_path  !< for messages
      type(status_t) :: status                     !< first failure
      integer(hid_t) :: dataset = 0                !< the one that is being filled
      integer(ip) :: n_components = 1, n_rows = 0
      integer(ip) :: n_written = 0, n_held = 0     !< rows in the file, rows collected
      real(wp), allocatable :: reals(:, :)         !< (n_components, CHUNK_ROWS)
      integer(ip), allocatable :: integers(:, :)
   end type hdf5_file_t

   !> Adds a row to the dataset that was begun last.
   interface put_row
      module procedure put_real_row, put_integer_row
   end interface put_row

   !> Gives a dataset or a group (path), or the file itself ('/'), an attribute.
   interface put_attribute
      module procedure put_text_attribute, put_integer_attribute
   end interface put_attribute

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

   !> Creates a file, not what a link leads to. The library is started here, not with the program; it trims names: a zero ends
   !> them before a blank does.
   subroutine open_hdf5(path, final_path, file)
      character(len=*), intent(in) :: path            !< where it is written
      character(len=*), intent(in) :: final_path      !< what messages call it
      type(hdf5_file_t), intent(out) :: file
      integer(hid_t) :: access
      integer :: error

      file%final_path = final_path
      ! after a failure the library would try again at the program's end, on a file that is gone
      call h5dont_atexit_f(error)
      call h5open_f(error)
      call keep(file, error)
      if (.not. is_ok(file%status)) return
      ! its own error stack is of no use to anybody who did not write the calls
      call h5eset_auto_f(0, error)
      call h5pcreate_f(H5P_FILE_ACCESS_F, access, error)
      call keep(file, error)
      ! else the library keeps up to 32 MiB of datasets that are complete
      if (h5pset_evict_on_close(int(access, c_int64_t), 1_c_int) < 0) call keep(file, -1)
      call remove_file(path)
      call h5fcreate_f(path//c_null_char, H5F_ACC_EXCL_F, file%id, error, access_prp=access)
      if (error < 0) call set_status(file%status, STATUS_FILE, final_path//': cannot be written')
      call h5pclose_f(access, error)
   end subroutine open_hdf5

   !> Keeps the first failure.
   subroutine keep(file, error)
      type(hdf5_file_t), intent(inout) :: file
      integer, intent(in) :: error                    !< < 0: failed

      if (error >= 0 .or. .not. is_ok(file%status)) return
      call set_status(file%status, STATUS_FILE, file%final_path//': cannot be written completely; is the disk full?')
   end subroutine keep

   !> Begins a dataset of n_rows > 0 rows, an array (n_rows) or, with several components, (n_rows, n_components). It is complete
   !> when its last row has been put. Groups on its path are made where they are missing.
   subroutine begin_dataset(file, path, n_components, n_rows, is_real, name, dimension)
      type(hdf5_file_t), intent(inout) :: file
      character(len=*), intent(in) :: path            !< /group/.../dataset
      integer(ip), intent(in) :: n_components, n_rows
      logical, intent(in) :: is_real                  !< else integer
      character(len=*), intent(in) :: name            !< attribute: what it is, in words
      character(len=*), intent(in) :: dimension       !< attribute: in F and L; '-' for none
      integer(hid_t) :: space, creation, link
      integer(hsize_t) :: dims(2)
      integer :: rank, error

      if (.not. is_ok(file%status)) return
      file%n_components = n_components
      file%n_rows = n_rows
      file%n_written = 0
      file%n_held = 0
      if (is_real) then
         allocate (file%reals(n_components, min(n_rows, CHUNK_ROWS)))
      else
         allocate (file%integers(n_components, min(n_rows, CHUNK_ROWS)))
      end if
      rank = merge(1, 2, n_components == 1)
      ! Fortran's first index is the last one of HDF5
      dims = [int(n_components, hsize_t), int(n_rows, hsize_t)]
      call h5screate_simple_f(rank, dims(3 - rank:), space, error)
      call keep(file, error)
      call set_creation(file, rank, [dims(1), min(dims(2), int(CHUNK_ROWS, hsize_t))], creation, link)
      call h5dcreate_f(file%id, path, merge(H5T_NATIVE_DOUBLE, H5T_NATIVE_INTEGER, is_real), space, file%dataset, error, &
                       dcpl_id=creation, lcpl_id=link)
      call keep(file, error)
      call h5pclose_f(creation, error)
      call h5pclose_f(link, error)
      call h5sclose_f(space, error)
      call put_attribute(file, path, 'name', name)
      call put_attribute(file, path, 'dimension', dimension)
   end subroutine begin_dataset

   !> Chunks of whole rows, compressed; no dates, so that equal runs write equal files.
   subroutine set_creation(file, rank, chunk, creation, link)
      type(hdf5_file_t), intent(inout) :: file
      integer, intent(in) :: rank
      integer(hsize_t), intent(in) :: chunk(2)
      integer(hid_t), intent(out) :: creation, link
      integer :: error(6)

      call h5pcreate_f(H5P_DATASET_CREATE_F, creation, error(1))
      call h5pset_chunk_f(creation, rank, chunk(3 - rank:), error(2))
      call h5pset_shuffle_f(creation, error(3))
      call h5pset_deflate_f(creation, DEFLATE_LEVEL, error(4))
      call h5pset_obj_track_times_f(creation, .false., error(5))
      call h5pcreate_f(H5P_LINK_CREATE_F, link, error(5))
      call h5pset_create_inter_group_f(link, 1, error(6))
      call keep(file, minval(error))
   end subroutine set_creation

   subroutine put_real_row(file, values)
      type(hdf5_file_t), intent(inout) :: file
      real(wp), intent(in) :: values(:)               !< (n_components)

      if (.not. is_ok(file%status)) return
      file%n_held = file%n_held + 1
      file%reals(:, file%n_held) = values
      call write_when_full(file)
   end subroutine put_real_row

   subroutine put_integer_row(file, values)
      type(hdf5_file_t), intent(inout) :: file
      integer(ip), intent(in) :: values(:)            !< (n_components)

      if (.not. is_ok(file%status)) return
      file%n_held = file%n_held + 1
      file%integers(:, file%n_held) = values
      call write_when_full(file)
   end subroutine put_integer_row

   !> Writes the collected rows when they fill a chunk or are the last ones; these end the dataset.
   subroutine write_when_full(file)
      type(hdf5_file_t), intent(inout) :: file
      integer :: error

      if (file%n_held < CHUNK_ROWS .and. file%n_written + file%n_held < file%n_rows) return
      call write_rows(file)
      file%n_written = file%n_written + file%n_held
      file%n_held = 0
      if (file%n_written < file%n_rows) return
      call h5dclose_f(file%dataset, error)
      call keep(file, error)
      if (allocated(file%reals)) deallocate (file%reals)
      if (allocated(file%integers)) deallocate (file%integers)
   end subroutine write_when_full

   subroutine write_rows(file)
      type(hdf5_file_t), intent(inout) :: file
      integer(hid_t) :: memory, space
      integer(hsize_t) :: dims(2), start(2), count(2)
      integer :: rank, error(4)

      rank = merge(1, 2, file%n_components == 1)
      dims = [int(file%n_components, hsize_t), int(file%n_rows, hsize_t)]
      start = [0_hsize_t, int(file%n_written, hsize_t)]
      count = [dims(1), int(file%n_held, hsize_t)]
      call h5screate_simple_f(rank, dims(3 - rank:), space, error(1))
      call h5sselect_hyperslab_f(space, H5S_SELECT_SET_F, start(3 - rank:), count(3 - rank:), error(2))
      call h5screate_simple_f(rank, count(3 - rank:), memory, error(3))
      if (allocated(file%reals)) then
         call h5dwrite_f(file%dataset, H5T_NATIVE_DOUBLE, file%reals, count, error(4), memory, space)
      else
         call h5dwrite_f(file%dataset, H5T_NATIVE_INTEGER, file%integers, count, error(4), memory, space)
      end if
      call keep(file, minval(error))
      call h5sclose_f(memory, error(1))
      call h5sclose_f(space, error(1))
   end subroutine write_rows

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

   !> Completes a file. status: STATUS_FILE when any part of it could not be written.
   subroutine close_hdf5(file, status)
      type(hdf5_file_t), intent(inout) :: file
      type(status_t), intent(out) :: status
      integer :: error

      if (is_ok(file%status)) then
         call h5fclose_f(file%id, error)
         call keep(file, error)
      end if
      ! what could not be written hangs in the library, which is left as it is
      if (is_ok(file%status)) call h5close_f(error)
      status = file%status
   end subroutine close_hdf5

end module atrito_hdf5
