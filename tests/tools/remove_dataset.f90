!> Takes a dataset out of an HDF5 file: `remove_dataset FILE PATH`.
program remove_dataset
   use hdf5, only: hid_t, h5open_f, h5close_f, h5fopen_f, h5fclose_f, h5ldelete_f, H5F_ACC_RDWR_F
   implicit none (type, external)
   character(len=1024) :: file_name, path
   integer(hid_t) :: file
   integer :: error(3)

   call get_command_argument(1, file_name)
   call get_command_argument(2, path)
   call h5open_f(error(1))
   call h5fopen_f(trim(file_name), H5F_ACC_RDWR_F, file, error(1))
   call h5ldelete_f(file, trim(path), error(2))
   call h5fclose_f(file, error(3))
   if (minval(error) < 0) stop 1
   call h5close_f(error(1))
end program remove_dataset
