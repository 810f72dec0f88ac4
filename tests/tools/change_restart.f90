!> Changes a number of a restart file, with checksums that are right: what somebody may write who means harm.
!>    change_restart FILE                          its lists, and how many values each has
!>    change_restart FILE LIST I VALUE             the I-th value of a list; of text the code of a character
!>    change_restart FILE PART NAME I VALUE        the I-th whole number of the first component of that name
!>    change_restart FILE LIST N                   N zeros in the place of a list, which take no room in the file
!> A whole number +N or -+N is that much more or less than it was.
program change_restart
   use, intrinsic :: iso_c_binding, only: c_loc, c_ptr
   use, intrinsic :: iso_fortran_env, only: error_unit
   use atrito_kinds, only: lp, wp
   use hdf5, only: hid_t, hsize_t, h5open_f, h5fopen_f, h5fclose_f, H5F_ACC_RDWR_F, h5gn_members_f, h5gget_obj_info_idx_f, &
                   h5dopen_f, h5dread_f, h5dwrite_f, h5dclose_f, h5dget_space_f, h5sget_simple_extent_dims_f, h5kind_to_type, &
                   H5_INTEGER_KIND, H5T_NATIVE_DOUBLE, H5T_NATIVE_CHARACTER, h5dget_type_f, h5ldelete_f, h5screate_simple_f, &
                   h5pcreate_f, h5pset_chunk_f, h5pset_deflate_f, h5dcreate_f, H5P_DATASET_CREATE_F
   implicit none (type, external)
   character(len=1024) :: argument(5)
   integer(hid_t) :: file
   integer :: i, error

   do i = 1, 5
      call get_command_argument(i, argument(i))
   end do
   call h5open_f(error)
   call h5fopen_f(trim(argument(1)), H5F_ACC_RDWR_F, file, error)
   if (error < 0) call fail(trim(argument(1))//' cannot be opened')
   select case (command_argument_count())
   case (1)
      call list_all()
   case (3)
      call put_zeros(trim(argument(2)), number(argument(3)))
   case (4)
      call change(trim(argument(2)), number(argument(3)), trim(argument(4)))
   case (5)
      call change_named(trim(argument(2)), trim(argument(3)), number(argument(4)), trim(argument(5)))
   case default
      call fail('change_restart FILE [LIST N | LIST I VALUE | PART NAME I VALUE]')
   end select
   call h5fclose_f(file, error)
   if (error < 0) call fail('cannot be written')

contains

   subroutine fail(text)
      character(len=*), intent(in) :: text

      write (error_unit, '(a)') text
      stop 1
   end subroutine fail

   integer(lp) function number(text)
      character(len=*), intent(in) :: text
      integer :: ios

      read (text, '(i30)', iostat=ios) number
      if (ios /= 0) call fail(text//' is no whole number')
   end function number

   subroutine list_all()
      character(len=256) :: part, name
      integer :: n, m, k, kind
      integer(hid_t) :: dataset
      integer(hsize_t) :: length

      call h5gn_members_f(file, '/', n, error)
      do k = 0, n - 1
         call h5gget_obj_info_idx_f(file, '/', k, part, kind, error)
         call h5gn_members_f(file, '/'//trim(part), m, error)
         do i = 0, m - 1
            call h5gget_obj_info_idx_f(file, '/'//trim(part), i, name, kind, error)
            call open_list('/'//trim(part)//'/'//trim(name), dataset, length)
            print '(a,1x,i0)', '/'//trim(part)//'/'//trim(name), length
            call h5dclose_f(dataset, error)
         end do
      end do
   end subroutine list_all

   subroutine open_list(path, dataset, length)
      character(len=*), intent(in) :: path
      integer(hid_t), intent(out) :: dataset
      integer(hsize_t), intent(out) :: length
      integer(hid_t) :: space
      integer(hsize_t) :: dims(1), most(1)

      call h5dopen_f(file, path, dataset, error)
      if (error < 0) call fail('there is no '//path)
      call h5dget_space_f(dataset, space, error)
      call h5sget_simple_extent_dims_f(space, dims, most, error)
      length = dims(1)
   end subroutine open_list

   subroutine change(path, place, text)
      character(len=*), intent(in) :: path, text
      integer(lp), intent(in) :: place
      integer(lp), allocatable, target :: longs(:)
      real(wp), allocatable, target :: reals(:)
      character(len=1), allocatable, target :: letters(:)
      integer(hid_t) :: dataset
      integer(hsize_t) :: n
      integer :: ios

      call open_list(path, dataset, n)
      if (place < 1 .or. place > n) call fail(path//' is not so long')
      ios = 0
      if (index(path, '/integers') > 0) then
         allocate (longs(n))
         call pass(dataset, h5kind_to_type(lp, H5_INTEGER_KIND), c_loc(longs), .false.)
         longs(place) = changed(longs(place), text)
         call pass(dataset, h5kind_to_type(lp, H5_INTEGER_KIND), c_loc(longs), .true.)
      else if (index(path, '/reals') > 0) then
         allocate (reals(n))
         call pass(dataset, H5T_NATIVE_DOUBLE, c_loc(reals), .false.)
         read (text, '(f30.0)', iostat=ios) reals(place)
         call pass(dataset, H5T_NATIVE_DOUBLE, c_loc(reals), .true.)
      else
         allocate (letters(n))
         call pass(dataset, H5T_NATIVE_CHARACTER, c_loc(letters), .false.)
         letters(place) = achar(int(number(text)))
         call pass(dataset, H5T_NATIVE_CHARACTER, c_loc(letters), .true.)
      end if
      call h5dclose_f(dataset, error)
      if (ios /= 0) call fail(text//' is no number')
   end subroutine change

   !> Chunks that nobody writes are zeros.
   subroutine put_zeros(path, n)
      character(len=*), intent(in) :: path
      integer(lp), intent(in) :: n
      integer(hsize_t), parameter :: CHUNK(1) = 1000000
      integer(hid_t) :: dataset, kind, space, properties
      integer(hsize_t) :: length

      call open_list(path, dataset, length)
      call h5dget_type_f(dataset, kind, error)
      call h5dclose_f(dataset, error)
      call h5ldelete_f(file, path, error)
      call h5screate_simple_f(1, [int(n, hsize_t)], space, error)
      call h5pcreate_f(H5P_DATASET_CREATE_F, properties, error)
      call h5pset_chunk_f(properties, 1, CHUNK, error)
      call h5pset_deflate_f(properties, 9, error)
      call h5dcreate_f(file, path, kind, space, dataset, error, properties)
      if (error < 0) call fail('no zeros in '//path)
      call h5dclose_f(dataset, error)
   end subroutine put_zeros

   subroutine pass(dataset, kind, address, is_written)
      integer(hid_t), intent(in) :: dataset, kind
      type(c_ptr), intent(in) :: address
      logical, intent(in) :: is_written
      type(c_ptr) :: place

      place = address
      if (is_written) then
         call h5dwrite_f(dataset, kind, place, error)
      else
         call h5dread_f(dataset, kind, place, error)
      end if
      if (error < 0) call fail('a list cannot be passed')
   end subroutine pass

   integer(lp) function changed(value, text)
      integer(lp), intent(in) :: value
      character(len=*), intent(in) :: text

      if (text(1:1) == '+') then
         changed = value + number(text(2:))
      else if (text(1:min(2, len(text))) == '-+') then
         changed = value - number(text(3:))
      else
         changed = number(text)
      end if
   end function changed

   !> Before each component stands its mark (mark_of of atrito_archive), then the extents of arrays.
   subroutine change_named(part, name, place, text)
      character(len=*), intent(in) :: part, name, text
      integer(lp), intent(in) :: place
      integer, parameter :: WHOLE(5) = [20, 21, 30, 40, 41]     ! integers, of rank 0 and 1, long ones, logicals
      integer(lp), allocatable, target :: longs(:)
      integer(hid_t) :: dataset
      integer(hsize_t) :: n, k
      integer :: m

      call open_list('/'//part//'/integers', dataset, n)
      allocate (longs(n))
      call pass(dataset, h5kind_to_type(lp, H5_INTEGER_KIND), c_loc(longs), .false.)
      call h5dclose_f(dataset, error)
      do m = 1, size(WHOLE)
         do k = 1, n - 1
            if (longs(k) /= mark_of(name, WHOLE(m))) cycle
            if (mod(WHOLE(m), 10) == 1 .and. longs(min(k + 1, n)) < place) cycle
            call change('/'//part//'/integers', k + mod(WHOLE(m), 10) + place, text)
            return
         end do
      end do
      call fail(part//' has no '//name)
   end subroutine change_named

   pure integer(lp) function mark_of(name, start) result(mark)
      character(len=*), intent(in) :: name
      integer, intent(in) :: start

      integer(lp), parameter :: PRIME = 2147483647_lp, PLACE = 1103515245_lp
      integer :: k

      mark = start
      do k = 1, len(name)
         mark = modulo(mark*PLACE + iachar(name(k:k)), PRIME)
      end do
   end function mark_of

end program change_restart
