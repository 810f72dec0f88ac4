!> A folder of output belongs to one run at a time: two that write into the same one do so one after the other, and what stands
!> there in the end is all from one of them.
!>
!> The claim is a lock on the folder itself (flock), which ends with the process however it ends: no lock file, none that is stale.
!> Where the file system has no locks, or the folder cannot be read, there is no claim and the run goes on.
module atrito_folder_claim
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
   use, intrinsic :: iso_fortran_env, only: error_unit
   use atrito_paths, only: is_folder, make_folder, remove_folders
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t
   use atrito_system_errors, only: last_error, WOULD_WAIT
   implicit none (type, external)
   private
   public :: folder_claim_t, claim_folder, release_folder

   type :: folder_claim_t
      type(string_t), allocatable :: made(:)         !< folders that were made for it
      integer(c_int) :: descriptor = -1
   end type folder_claim_t

   integer(c_int), parameter :: TO_READ = 0_c_int                 ! O_RDONLY
   integer(c_int), parameter :: LOCK_EX = 2_c_int, LOCK_NB = 4_c_int
   integer, parameter :: MOST_TRIES = 5

   interface
      integer(c_int) function c_open(path, flags) bind(C, name='open')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: flags
      end function c_open
      integer(c_int) function c_close(descriptor) bind(C, name='close')
         import :: c_int
         integer(c_int), value :: descriptor
      end function c_close
      integer(c_int) function c_flock(descriptor, operation) bind(C, name='flock')
         import :: c_int
         integer(c_int), value :: descriptor, operation
      end function c_flock
   end interface

contains

   !> Makes a folder where it is missing and claims it; waits, and says so, while another run has it.
   !>
   !> status: STATUS_FILE when the folder cannot be made. Then nothing is claimed.
   subroutine claim_folder(folder, claim, status)
      character(len=*), intent(in) :: folder
      type(folder_claim_t), intent(out) :: claim
      type(status_t), intent(out) :: status
      integer :: i
      integer(c_int) :: ignored

      do i = 1, MOST_TRIES
         call make_folder(folder, status, claim%made)
         if (.not. is_ok(status)) then
            call remove_folders(claim%made)
            return
         end if
         claim%descriptor = c_open(folder//c_null_char, TO_READ)
         if (claim%descriptor < 0) cycle
         call await_lock(claim%descriptor, folder)
         ! the run that had it may have failed and removed it
         if (is_folder(folder)) return
         ignored = c_close(claim%descriptor)
         claim%descriptor = -1
      end do
   end subroutine claim_folder

   subroutine await_lock(descriptor, folder)
      integer(c_int), intent(in) :: descriptor
      character(len=*), intent(in) :: folder
      integer(c_int) :: ignored
      integer :: ios

      if (c_flock(descriptor, LOCK_EX + LOCK_NB) == 0_c_int) return
      if (last_error() /= WOULD_WAIT) return
      write (error_unit, '(a)', iostat=ios) 'wait  another run writes into '//folder
      flush (error_unit, iostat=ios)
      ignored = c_flock(descriptor, LOCK_EX)
   end subroutine await_lock

   !> Ends a claim. Folders that were made for it and are empty are removed.
   subroutine release_folder(claim)
      type(folder_claim_t), intent(inout) :: claim
      integer(c_int) :: ignored

      call remove_folders(claim%made)
      if (claim%descriptor >= 0) ignored = c_close(claim%descriptor)
      claim%descriptor = -1
   end subroutine release_folder

end module atrito_folder_claim
