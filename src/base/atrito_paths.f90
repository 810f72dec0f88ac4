!> Files and folders by their names: what is there, what can be made, what is removed.
module atrito_paths
   use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_int, c_null_char, c_ptr
   use atrito_interrupts, only: hold_interrupts, release_interrupts, note_folder, forget_folder
   use atrito_status, only: status_t, set_status, STATUS_FILE
   use atrito_strings, only: string_t, append_string
   use atrito_system_errors, only: last_error, NO_SUCH_FILE, NOT_A_FOLDER
   implicit none (type, external)
   private
   public :: file_exists, is_folder, may_write, make_folder, remove_folders, remove_file, remove_empty_folder, check_folder

   integer(c_int), parameter :: FOLDER_MODE = int(o'777', c_int)
   integer(c_int), parameter :: TO_WRITE = 2_c_int, TO_WRITE_AND_SEARCH = 3_c_int, TO_USE = 7_c_int
   integer, parameter :: MOST_TRIES = 5

   interface
      integer(c_int) function c_mkdir(path, mode) bind(C, name='mkdir')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: mode
      end function c_mkdir
      integer(c_int) function c_access(path, mode) bind(C, name='access')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: mode
      end function c_access
      integer(c_int) function c_unlink(path) bind(C, name='unlink')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
      end function c_unlink
      type(c_ptr) function c_opendir(path) bind(C, name='opendir')
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*)
      end function c_opendir
      integer(c_int) function c_closedir(folder) bind(C, name='closedir')
         import :: c_int, c_ptr
         type(c_ptr), value :: folder
      end function c_closedir
      integer(c_int) function c_rmdir(path) bind(C, name='rmdir')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
      end function c_rmdir
   end interface

contains

   logical function file_exists(path)
      character(len=*), intent(in) :: path

      inquire (file=path, exist=file_exists)
   end function file_exists

   logical function is_folder(path)
      character(len=*), intent(in) :: path
      type(c_ptr) :: folder
      integer(c_int) :: ignored

      folder = c_opendir(path//c_null_char)
      is_folder = c_associated(folder)
      if (is_folder) ignored = c_closedir(folder)
   end function is_folder

   !> Whether this user may write into a file that is there.
   logical function may_write(path)
      character(len=*), intent(in) :: path

      may_write = c_access(path//c_null_char, TO_WRITE) == 0_c_int
   end function may_write

   !> Makes a folder and those above it where they are missing. Those that were made are appended to `made`, and noted: an
   !> interrupted program removes them where they are empty, until remove_folders or forget_folder.
   !>
   !> Another run may remove what it made just then: hence several tries. status: STATUS_FILE.
   subroutine make_folder(path, status, made)
      character(len=*), intent(in) :: path
      type(status_t), intent(out) :: status
      type(string_t), allocatable, intent(inout), optional :: made(:)
      integer :: attempt, i

      do attempt = 1, MOST_TRIES
         do i = 2, len(path)
            if (path(i:i) == '/') call make_one_folder(path(:i - 1), made)
         end do
         call make_one_folder(path, made)
         if (is_folder(path)) return
      end do
      call set_status(status, STATUS_FILE, path//': the folder cannot be made')
   end subroutine make_folder

   subroutine make_one_folder(path, made)
      character(len=*), intent(in) :: path
      type(string_t), allocatable, intent(inout), optional :: made(:)
      logical :: is_new

      call hold_interrupts()
      is_new = c_mkdir(path//c_null_char, FOLDER_MODE) == 0_c_int
      if (is_new .and. present(made)) then
         call note_folder(path)
         call append_string(made, path)
      end if
      call release_interrupts()
   end subroutine make_one_folder

   !> Removes the folders that were made, where they are empty.
   subroutine remove_folders(made)
      type(string_t), allocatable, intent(in) :: made(:)
      integer :: i

      if (.not. allocated(made)) return
      do i = size(made), 1, -1
         call remove_empty_folder(made(i)%s)
         call forget_folder(made(i)%s)
      end do
   end subroutine remove_folders

   !> Whether files can be written into a folder that is there, or into one that is to be made. (They may fail all the same: a disk
   !> may be full.) One question to the system decides: between two, another run may make the folder or remove it.
   !> status: STATUS_FILE.
   recursive subroutine check_folder(path, status)
      character(len=*), intent(in) :: path
      type(status_t), intent(out) :: status
      integer(c_int) :: error

      if (c_access(path//'/.'//c_null_char, TO_USE) == 0_c_int) return
      error = last_error()
      if (error == NOT_A_FOLDER .and. file_exists(path)) then
         call set_status(status, STATUS_FILE, path//': is no folder that can be read and written into')
      else if (error == NO_SUCH_FILE .or. error == NOT_A_FOLDER) then
         if (len(path) > 1) call check_folder(parent_of(path), status)
      else if (c_access(path//c_null_char, TO_WRITE_AND_SEARCH) == 0_c_int) then
         call set_status(status, STATUS_FILE, path//': the folder cannot be read')
      else
         call set_status(status, STATUS_FILE, path//': the folder cannot be written into')
      end if
   end subroutine check_folder

   function parent_of(path) result(parent)
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: parent
      integer :: slash

      slash = index(path, '/', back=.true.)
      parent = '.'
      if (slash == 1) parent = '/'
      if (slash > 1) parent = path(:slash - 1)
   end function parent_of

   !> Removes a file; one that is not there is no failure.
   subroutine remove_file(path)
      character(len=*), intent(in) :: path
      integer(c_int) :: ignored

      ignored = c_unlink(path//c_null_char)
   end subroutine remove_file

   !> Removes a folder; one that is not empty stays.
   subroutine remove_empty_folder(path)
      character(len=*), intent(in) :: path
      integer(c_int) :: ignored

      ignored = c_rmdir(path//c_null_char)
   end subroutine remove_empty_folder

end module atrito_paths
