!> Files that were written under temporary names get their final ones, all of them or none.
!>
!> By plain renaming, which every file system has. First the former files step aside, then the new ones take their names, then the
!> former ones go. So a failure can be taken back; and a process that is killed in the middle leaves each former or each new file
!> whole, under its own name or its temporary one, and no new file beside a former one.
module atrito_renaming
   use, intrinsic :: iso_c_binding, only: c_null_char
   use atrito_own_files, only: check_own, check_unread, is_own, names_with, remove_own_file, TEMPORARY, FORMER
   use atrito_paths, only: file_exists, is_folder, remove_file
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use atrito_strings, only: string_t, append_string, ends_with
   use atrito_system, only: c_rename, c_may_write
   implicit none (type, external)
   private
   public :: find_obstacle, replace_files, name_new_files, recover_files

contains

   !> What can be seen before anything is replaced: a folder in the place of a file, a file that this run has read, or one that its
   !> owner has protected.
   subroutine find_obstacle(folder, names, stale, status, may_be_read)
      character(len=*), intent(in) :: folder        !< as the user wrote it, without / at its end
      type(string_t), intent(in) :: names(:)        !< that will be written, without folder
      type(string_t), intent(in) :: stale(:)        !< that will be removed, without folder
      type(status_t), intent(out) :: status         !< STATUS_FILE where something is in the way
      logical, intent(in), optional :: may_be_read  !< what is written holds all that the file held
      integer :: i

      do i = 1, size(names)
         if (is_folder(folder//'/'//names(i)%s)) then
            call set_status(status, STATUS_FILE, folder//'/'//names(i)%s//': cannot be written, it is a folder')
            return
         end if
         call check_unread(folder//'/'//names(i)%s, status, may_be_read)
         if (is_ok(status)) call find_protection(folder//'/'//names(i)%s, status)
         if (.not. is_ok(status)) return
      end do
      do i = 1, size(stale)
         call check_unread(folder//'/'//stale(i)%s, status)
         if (is_ok(status)) call find_protection(folder//'/'//stale(i)%s, status)
         if (.not. is_ok(status)) return
      end do
   end subroutine find_obstacle

   !> A file that was made read-only shall stay as it is, though a renaming would get past that.
   subroutine find_protection(path, status)
      character(len=*), intent(in) :: path
      type(status_t), intent(out) :: status

      if (.not. file_exists(path)) return
      if (c_may_write(path//c_null_char) == 1) return
      call set_status(status, STATUS_FILE, path//': is write-protected; nothing is replaced')
   end subroutine find_protection

   !> Gives all new files their names and removes the stale ones. status: STATUS_FILE, and then the former files are back.
   subroutine replace_files(folder, names, stale, status)
      character(len=*), intent(in) :: folder        !< as the user wrote it, without / at its end
      type(string_t), intent(in) :: names(:)        !< of new files, which have temporary names; without folder
      type(string_t), intent(in) :: stale(:)        !< of former files that have no successor; a name may be among the new ones, too
      type(status_t), intent(out) :: status         !< STATUS_FILE, and then nothing has changed
      type(string_t), allocatable :: paths(:)       ! gfortran 12 spoils the lengths in one of fixed size
      logical :: is_aside(size(names) + size(stale))
      integer :: i, j, done

      allocate (paths(0))
      do i = 1, size(names)
         call append_string(paths, folder//'/'//names(i)%s)
      end do
      do i = 1, size(stale)
         call append_string(paths, folder//'/'//stale(i)%s)
      end do
      call move_aside(paths, is_aside, status)
      call name_new_files(folder, names, done, status)
      if (is_ok(status)) then
         do i = 1, size(paths)
            if (is_aside(i)) call remove_file(paths(i)%s//FORMER)
         end do
      else
         ! The names go back to the files that had them before.
         do j = 1, size(paths)
            if (j <= done) call remove_file(paths(j)%s)
            if (.not. is_aside(j)) cycle
            if (.not. renamed(paths(j)%s//FORMER, paths(j)%s)) status%text = status%text//'; the former one is '//paths(j)%s//FORMER
         end do
      end if
   end subroutine replace_files

   !> What a run left that was killed among its renamings: former files come back, whatever deck they are of; where all new ones
   !> have their names already, those go that stepped aside. Then files go that were not complete.
   subroutine recover_files(folder)
      character(len=*), intent(in) :: folder !< as the user wrote it, without / at its end
      type(string_t), allocatable :: names(:)
      logical :: is_whole
      integer :: i

      names = names_with(folder, TEMPORARY)
      if (size(names) == 0) return
      is_whole = .true.
      do i = 1, size(names)
         if (.not. ends_with(names(i)%s, FORMER)) is_whole = is_whole .and. .not. is_own(folder//'/'//names(i)%s)
      end do
      do i = 1, size(names)
         if (ends_with(names(i)%s, FORMER) .and. .not. is_whole) call bring_back(folder//'/'//names(i)%s)
      end do
      do i = 1, size(names)
         call remove_own_file(folder//'/'//names(i)%s)
      end do
   end subroutine recover_files

   !> A former file gets its first name again, also from a new one.
   subroutine bring_back(path)
      character(len=*), intent(in) :: path          !< its second name
      character(len=:), allocatable :: first
      type(status_t) :: status
      logical :: ignored

      first = path(:len(path) - len(FORMER))
      call check_own(path, status)
      if (is_ok(status)) call check_own(first, status)
      if (is_ok(status) .and. .not. is_folder(first)) ignored = renamed(path, first)
   end subroutine bring_back

   !> Gives former files their second name; a folder with the name of a stale file is somebody else's.
   subroutine move_aside(paths, is_aside, status)
      type(string_t), intent(in) :: paths(:)
      logical, intent(out) :: is_aside(:)
      type(status_t), intent(out) :: status
      integer :: i

      is_aside = .false.
      do i = 1, size(paths)
         if (is_folder(paths(i)%s)) cycle
         is_aside(i) = renamed(paths(i)%s, paths(i)%s//FORMER)
         if (is_aside(i) .or. .not. file_exists(paths(i)%s)) cycle
         call set_status(status, STATUS_FILE, paths(i)%s//': cannot be replaced')
         return
      end do
   end subroutine move_aside

   !> Gives new files their names, over former ones.
   subroutine name_new_files(folder, names, done, status)
      character(len=*), intent(in) :: folder        !< as the user wrote it, without / at its end
      type(string_t), intent(in) :: names(:)        !< of new files, which have temporary names; without folder
      integer, intent(out) :: done                  !< files that have their names
      type(status_t), intent(inout) :: status       !< nothing is done where it is not STATUS_OK; STATUS_FILE where one has no name

      done = 0
      do while (is_ok(status) .and. done < size(names))
         associate (path => folder//'/'//names(done + 1)%s)
            if (.not. renamed(path//TEMPORARY, path)) call set_status(status, STATUS_FILE, path//': cannot be written')
         end associate
         if (is_ok(status)) done = done + 1
      end do
   end subroutine name_new_files

   logical function renamed(from, to)
      character(len=*), intent(in) :: from, to

      renamed = c_rename(from//c_null_char, to//c_null_char) == 1
   end function renamed

end module atrito_renaming
