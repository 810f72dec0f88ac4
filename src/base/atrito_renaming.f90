!> Files that were written under temporary names get their final ones, all of them or none.
module atrito_renaming
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
   use atrito_paths, only: file_exists, is_folder, may_write, remove_file
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: find_obstacle, rename_all, TEMPORARY

   character(len=*), parameter :: TEMPORARY = '.part', FORMER = '.old'

   interface
      integer(c_int) function c_link(old, new) bind(C, name='link')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: old(*), new(*)
      end function c_link
      integer(c_int) function c_rename(old, new) bind(C, name='rename')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: old(*), new(*)
      end function c_rename
   end interface

contains

   !> What can be seen before anything is replaced: a folder in the place of a file, or a file that its owner has protected.
   subroutine find_obstacle(folder, names, stale, status)
      character(len=*), intent(in) :: folder
      type(string_t), intent(in) :: names(:)        !< that will be written, without folder
      type(string_t), intent(in) :: stale(:)        !< that will be removed, without folder
      type(status_t), intent(out) :: status
      integer :: i

      do i = 1, size(names)
         if (is_folder(folder//'/'//names(i)%s)) then
            call set_status(status, STATUS_FILE, folder//'/'//names(i)%s//': cannot be written, it is a folder')
            return
         end if
         call find_protection(folder//'/'//names(i)%s, status)
         if (.not. is_ok(status)) return
      end do
      do i = 1, size(stale)
         call find_protection(folder//'/'//stale(i)%s, status)
         if (.not. is_ok(status)) return
      end do
   end subroutine find_obstacle

   !> A file that was made read-only shall stay as it is, though a renaming would get past that.
   subroutine find_protection(path, status)
      character(len=*), intent(in) :: path
      type(status_t), intent(out) :: status

      if (.not. file_exists(path)) return
      if (may_write(path)) return
      call set_status(status, STATUS_FILE, path//': is write-protected; nothing is replaced')
   end subroutine find_protection

   !> Renames all files, or none. The former ones keep a second name until all is done.
   subroutine rename_all(folder, names, status)
      character(len=*), intent(in) :: folder
      type(string_t), intent(in) :: names(:)        !< without folder
      type(status_t), intent(out) :: status
      character(len=:), allocatable :: path
      logical :: has_former(size(names))
      integer :: i, done

      done = 0
      do i = 1, size(names)
         path = folder//'/'//names(i)%s
         call remove_file(path//FORMER//TEMPORARY)
         has_former(i) = c_link(path//c_null_char, path//FORMER//TEMPORARY//c_null_char) == 0_c_int
         if (c_rename(path//TEMPORARY//c_null_char, path//c_null_char) /= 0_c_int) then
            call set_status(status, STATUS_FILE, path//': cannot be written')
            exit
         end if
         done = i
      end do
      do i = 1, size(names)
         path = folder//'/'//names(i)%s
         if (.not. is_ok(status) .and. i <= done) call take_back(path, has_former(i))
         call remove_file(path//FORMER//TEMPORARY)
      end do
   end subroutine rename_all

   !> Gives a name back to the file that had it before.
   subroutine take_back(path, has_former)
      character(len=*), intent(in) :: path
      logical, intent(in) :: has_former
      integer(c_int) :: ignored

      if (has_former) then
         ignored = c_rename(path//FORMER//TEMPORARY//c_null_char, path//c_null_char)
      else
         call remove_file(path)
      end if
   end subroutine take_back

end module atrito_renaming
