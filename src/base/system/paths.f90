!> Files and folders by their names: what is there, what can be made, what is removed.
module atrito_paths
   use, intrinsic :: iso_c_binding, only: c_null_char
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use atrito_strings, only: string_t, append_string
   use atrito_system, only: c_is_folder, c_exists, c_may_hold, c_kind_of, c_true_path, c_make_folder, c_judge_folder, &
                            c_remove_file, c_remove_folder, forget_path
   implicit none (type, external)
   private
   public :: file_exists, is_folder, make_folder, remove_folders, remove_file, remove_empty_folder, check_folder, true_path, &
             target_path, nearest_folder

   !> What keeps a run from writing into a folder (judge_folder).
   integer, parameter :: NOTHING = 0, IS_MISSING = 1, IS_BELOW_A_FILE = 2, NOT_READABLE = 3
   integer, parameter :: MOST_TRIES = 100            !< to make a folder that another run removes each time
   integer, parameter :: LONGEST_PATH = 4096
   integer, parameter :: IS_LINK = 3                 !< answer of c_kind_of
   character(len=*), parameter :: OUT_OF_BOUNDS = ': is outside of the folder of output, and --confine was given'

contains

   !> Whether there is a file or a folder of this path; a link that leads nowhere is none.
   logical function file_exists(path)
      character(len=*), intent(in) :: path !< as the user wrote it

      file_exists = c_exists(path//c_null_char) == 1
   end function file_exists

   !> Whether there is a folder of this path, or a link to one.
   logical function is_folder(path)
      character(len=*), intent(in) :: path !< as the user wrote it

      is_folder = c_is_folder(path//c_null_char) == 1
   end function is_folder

   !> The path of a file without links, `.` and `..`, which is the same for each of its names; `path` itself where there is no
   !> such file.
   function true_path(path) result(true)
      character(len=*), intent(in) :: path !< as the user wrote it
      character(len=:), allocatable :: true
      character(len=LONGEST_PATH) :: buffer
      integer :: length

      true = path
      length = c_true_path(path//c_null_char, buffer, len(buffer))
      if (length > 0) true = buffer(:length)
   end function true_path

   !> The true path of a folder that may have to be made; what is missing of it is taken as it is written.
   recursive function target_path(path) result(target)
      character(len=*), intent(in) :: path !< as the user wrote it
      character(len=:), allocatable :: target
      integer :: slash

      target = true_path(path)
      if (index(target, '/') == 1 .and. (file_exists(path) .or. len(path) == 1)) return
      slash = index(path, '/', back=.true.)
      if (slash == 0) then
         target = true_path('.')//'/'//path
      else
         target = target_path(path(:max(slash - 1, 1)))//'/'//path(slash + 1:)
      end if
   end function target_path

   !> Makes a folder and those above it where they are missing. Those that were made are appended to `made`, and noted: an
   !> interrupted program removes them where they are empty, until remove_folders or forget_path.
   !>
   !> Another run may remove what it made just then: hence several tries. status: STATUS_FILE.
   subroutine make_folder(path, status, made)
      character(len=*), intent(in) :: path                            !< of the folder, as the user wrote it
      type(status_t), intent(out) :: status                           !< STATUS_FILE where it cannot be made or --confine forbids it
      type(string_t), allocatable, intent(inout), optional :: made(:) !< paths that were made, the outer one first
      integer :: attempt, i

      if (c_may_hold(target_path(path)//c_null_char) == 0) then
         call set_status(status, STATUS_FILE, path//OUT_OF_BOUNDS)
         return
      end if
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

      is_new = c_make_folder(path//c_null_char, merge(1, 0, present(made))) == 1
      if (is_new .and. present(made)) call append_string(made, path)
   end subroutine make_one_folder

   !> Removes the folders that were made, where they are empty.
   subroutine remove_folders(made)
      type(string_t), allocatable, intent(in) :: made(:) !< by make_folder; not allocated: none
      integer :: i

      if (.not. allocated(made)) return
      do i = size(made), 1, -1
         call remove_empty_folder(made(i)%s)
         call forget_path(made(i)%s)
      end do
   end subroutine remove_folders

   !> Whether files can be written into a folder that is there, or into one that is to be made. (They may fail all the same: a disk
   !> may be full.) status: STATUS_FILE.
   !>
   !> One that is missing is made and removed: links that lead nowhere, names that are too long and file systems that take no
   !> folders show in nothing else.
   subroutine check_folder(path, status)
      character(len=*), intent(in) :: path  !< of the folder, as the user wrote it
      type(status_t), intent(out) :: status !< STATUS_FILE where files cannot be written there
      type(string_t), allocatable :: made(:)

      if (c_may_hold(target_path(path)//c_null_char) == 0) then
         call set_status(status, STATUS_FILE, path//OUT_OF_BOUNDS)
         return
      end if
      call check_place(path, status)
      if (is_folder(path) .or. .not. is_ok(status)) return
      call make_folder(path, status, made)
      call remove_folders(made)
   end subroutine check_folder

   !> The same of a folder, or of the nearest one above it that is there.
   recursive subroutine check_place(path, status)
      character(len=*), intent(in) :: path
      type(status_t), intent(out) :: status
      integer :: obstacle

      obstacle = c_judge_folder(path//'/.'//c_null_char)
      if (obstacle == NOTHING) return
      if (c_kind_of(path//c_null_char) == IS_LINK .and. .not. file_exists(path)) then
         call set_status(status, STATUS_FILE, path//': is a link to nothing; the folder cannot be made')
         return
      end if
      if (obstacle == IS_BELOW_A_FILE .and. file_exists(path)) then
         call set_status(status, STATUS_FILE, path//': is no folder that can be read and written into')
      else if (obstacle == IS_MISSING .or. obstacle == IS_BELOW_A_FILE) then
         if (len(path) > 1) call check_place(parent_of(path), status)
      else if (obstacle == NOT_READABLE) then
         call set_status(status, STATUS_FILE, path//': the folder cannot be read')
      else
         call set_status(status, STATUS_FILE, path//': the folder cannot be written into')
      end if
   end subroutine check_place

   !> A folder, or the nearest one above it that is there.
   recursive function nearest_folder(path) result(folder)
      character(len=*), intent(in) :: path !< as the user wrote it
      character(len=:), allocatable :: folder

      folder = path
      if (.not. is_folder(path) .and. path /= '.' .and. path /= '/') folder = nearest_folder(parent_of(path))
   end function nearest_folder

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
      character(len=*), intent(in) :: path !< of the file, which need not be there

      call c_remove_file(path//c_null_char)
   end subroutine remove_file

   !> Removes a folder; one that is not empty stays.
   subroutine remove_empty_folder(path)
      character(len=*), intent(in) :: path !< of the folder, which need not be there

      call c_remove_folder(path//c_null_char)
   end subroutine remove_empty_folder

end module atrito_paths
