!> Prints a dataset of an HDF5 file: its attributes, then its rows. `print_dataset FILE PATH`; for a group or the file, `/`, the
!> attributes alone; `print_dataset FILE` lists what there is.
program print_dataset
   use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_loc, c_null_char, c_ptr
   use, intrinsic :: iso_fortran_env, only: error_unit
   use atrito_kinds, only: wp
   use hdf5, only: hid_t, hsize_t, size_t, h5open_f, h5eset_auto_f, h5fopen_f, H5F_ACC_RDONLY_F, h5oopen_f, h5oclose_f, &
                   h5dopen_f, h5dread_f, h5dget_space_f, h5sget_simple_extent_dims_f, H5T_NATIVE_DOUBLE, h5aget_num_attrs_f, &
                   h5aopen_by_idx_f, h5aget_name_f, h5aget_type_f, h5aread_f, h5aclose_f, h5tget_class_f, H5T_STRING_F, &
                   H5T_NATIVE_INTEGER, H5_INDEX_NAME_F, H5_ITER_INC_F, h5gn_members_f, h5gget_obj_info_idx_f, H5G_DATASET_F
   implicit none (type, external)
   character(len=1024) :: file_name, path
   integer(hid_t) :: file
   integer :: error

   call get_command_argument(1, file_name)
   call get_command_argument(2, path)
   call h5open_f(error)
   call h5eset_auto_f(0, error)
   call h5fopen_f(trim(file_name), H5F_ACC_RDONLY_F, file, error)
   if (error < 0) call fail(trim(file_name)//' cannot be read')
   if (len_trim(path) == 0) then
      call list('')
   else
      call print_attributes()
      call print_rows()
   end if

contains

   subroutine fail(text)
      character(len=*), intent(in) :: text

      write (error_unit, '(a)') text
      stop 1
   end subroutine fail

   !> The paths of all datasets below a group.
   recursive subroutine list(group)
      character(len=*), intent(in) :: group
      character(len=256) :: name
      integer :: n, i, kind

      call h5gn_members_f(file, group//'/', n, error)
      do i = 0, n - 1
         call h5gget_obj_info_idx_f(file, group//'/', i, name, kind, error)
         if (kind == H5G_DATASET_F) then
            print '(a)', group//'/'//trim(name)
         else
            call list(group//'/'//trim(name))
         end if
      end do
   end subroutine list

   subroutine print_attributes()
      integer(hid_t) :: object, attribute, kind
      integer(hsize_t) :: i
      integer(size_t) :: length
      character(len=64) :: name
      integer :: n, class, number

      call h5oopen_f(file, trim(path), object, error)
      if (error < 0) call fail(trim(path)//' is not there')
      call h5aget_num_attrs_f(object, n, error)
      do i = 0, n - 1
         call h5aopen_by_idx_f(object, '.', H5_INDEX_NAME_F, H5_ITER_INC_F, i, attribute, error)
         length = len(name)
         call h5aget_name_f(attribute, length, name, error)
         call h5aget_type_f(attribute, kind, error)
         call h5tget_class_f(kind, class, error)
         if (class == H5T_STRING_F) then
            print '(a)', '# '//trim(name)//': '//text_of(attribute, kind)
         else
            call h5aread_f(attribute, H5T_NATIVE_INTEGER, number, [0_hsize_t], error)
            print '(a,i0)', '# '//trim(name)//': ', number
         end if
         call h5aclose_f(attribute, error)
      end do
      call h5oclose_f(object, error)
   end subroutine print_attributes

   function text_of(attribute, kind) result(text)
      integer(hid_t), intent(in) :: attribute, kind
      character(len=:), allocatable :: text
      type(c_ptr), target :: address(1)
      type(c_ptr), target :: buffer
      character(kind=c_char), pointer :: letters(:)
      integer :: i

      text = ''
      buffer = c_loc(address(1))
      call h5aread_f(attribute, kind, buffer, error)
      if (error < 0) call fail('an attribute cannot be read')
      call c_f_pointer(address(1), letters, [100000])
      do i = 1, size(letters)
         if (letters(i) == c_null_char) exit
         text = text//letters(i)
      end do
   end function text_of

   subroutine print_rows()
      integer(hid_t) :: dataset, space
      integer(hsize_t) :: dims(2), most(2)
      real(wp), allocatable :: rows(:, :)
      integer :: i

      call h5dopen_f(file, trim(path), dataset, error)
      if (error < 0) return
      call h5dget_space_f(dataset, space, error)
      dims = 1
      call h5sget_simple_extent_dims_f(space, dims, most, error)
      if (error == 1) dims = [1_hsize_t, dims(1)]
      allocate (rows(dims(1), dims(2)))
      call h5dread_f(dataset, H5T_NATIVE_DOUBLE, rows, dims, error)
      if (error < 0) call fail(trim(path)//' cannot be read')
      do i = 1, size(rows, 2)
         print '(*(es24.16,:,1x))', rows(:, i)
      end do
   end subroutine print_rows

end program print_dataset
