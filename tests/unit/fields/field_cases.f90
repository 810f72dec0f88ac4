!> Reads what the field tests have written.
module field_cases
   use atrito_kinds, only: wp
   use hdf5, only: hid_t, hsize_t, h5open_f, h5close_f, h5eset_auto_f, h5fopen_f, h5fclose_f, H5F_ACC_RDONLY_F, h5dopen_f, &
                   h5dclose_f, h5dread_f, h5dget_space_f, h5sget_simple_extent_dims_f, h5sclose_f, H5T_NATIVE_DOUBLE
   implicit none (type, external)
   private
   public :: read_dataset

contains

   !> The rows of a dataset as columns (n_components, n_rows); (0, 0) when there is no such dataset.
   function read_dataset(name, path) result(rows)
      character(len=*), intent(in) :: name             !< of the file
      character(len=*), intent(in) :: path
      real(wp), allocatable :: rows(:, :)
      integer(hid_t) :: file, dataset, space
      integer(hsize_t) :: dims(2), most(2)
      integer :: rank, error

      allocate (rows(0, 0))
      call h5open_f(error)
      call h5eset_auto_f(0, error)
      call h5fopen_f(name, H5F_ACC_RDONLY_F, file, error)
      if (error < 0) return
      call h5dopen_f(file, path, dataset, error)
      if (error >= 0) then
         call h5dget_space_f(dataset, space, error)
         call h5sget_simple_extent_dims_f(space, dims, most, rank)
         if (rank == 1) dims = [1_hsize_t, dims(1)]
         deallocate (rows)
         allocate (rows(dims(1), dims(2)))
         call h5dread_f(dataset, H5T_NATIVE_DOUBLE, rows, dims, error)
         call h5sclose_f(space, error)
         call h5dclose_f(dataset, error)
      end if
      call h5fclose_f(file, error)
      call h5close_f(error)
   end function read_dataset

end module field_cases
