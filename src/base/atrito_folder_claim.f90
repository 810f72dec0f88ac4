!> A folder of output belongs to one run at a time: two that write into the same one do so one after the other, and what stands
!> there in the end is all from one of them.
!>
!> The claim is a lock on the folder itself (flock), which ends with the process however it ends: no lock file, none that is stale.
!> Where the file system has no locks, or the folder cannot be read, there is no claim and the run goes on.
module atrito_folder_claim
   use, intrinsic :: iso_c_binding, only: c_null_char
   use, intrinsic :: iso_fortran_env, only: error_unit
   use atrito_kinds, only: wp
   use atrito_paths, only: make_folder, remove_folders
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use atrito_strings, only: string_t, to_text
   use atrito_system, only: c_open_folder, c_close_folder, c_is_same_folder, c_lock_folder
   implicit none (type, external)
   private
   public :: folder_claim_t, claim_folder, release_folder

   type :: folder_claim_t
      type(string_t), allocatable :: made(:)         !< folders that were made for it
      integer :: descriptor = -1
   end type folder_claim_t

   integer, parameter :: MOST_TRIES = 5
   real(wp), parameter :: LONGEST_WAIT = 3600.0_wp   !< [s]

contains

   !> Makes a folder where it is missing and claims it; waits, and says so, while another run has it.
   !>
   !> status: STATUS_FILE when the folder cannot be made, or another run keeps it too long. Then nothing is claimed.
   subroutine claim_folder(folder, claim, status, patience, silent)
      character(len=*), intent(in) :: folder
      type(folder_claim_t), intent(out) :: claim
      type(status_t), intent(out) :: status
      real(wp), intent(in), optional :: patience     !< [s] to wait for another run; default an hour
      logical, intent(in), optional :: silent        !< not a word about the wait
      integer :: i
      real(wp) :: seconds
      logical :: tells

      seconds = LONGEST_WAIT
      if (present(patience)) seconds = patience
      tells = .true.
      if (present(silent)) tells = .not. silent
      do i = 1, MOST_TRIES
         call make_folder(folder, status, claim%made)
         if (is_ok(status)) then
            claim%descriptor = c_open_folder(folder//c_null_char)
            if (claim%descriptor < 0) cycle
            call await_lock(claim%descriptor, folder, seconds, tells, status)
         end if
         if (.not. is_ok(status)) then
            call release_folder(claim)
            return
         end if
         ! the run that had it may have failed and removed it
         if (c_is_same_folder(claim%descriptor, folder//c_null_char) == 1) return
         call c_close_folder(claim%descriptor)
         claim%descriptor = -1
      end do
   end subroutine claim_folder

   subroutine await_lock(descriptor, folder, seconds, tells, status)
      integer, intent(in) :: descriptor
      character(len=*), intent(in) :: folder
      real(wp), intent(in) :: seconds
      logical, intent(in) :: tells
      type(status_t), intent(inout) :: status
      integer :: ios

      if (c_lock_folder(descriptor, 0.0_wp) == 1) return
      if (tells) write (error_unit, '(a)', iostat=ios) 'wait  another run writes into '//folder
      flush (error_unit, iostat=ios)
      if (c_lock_folder(descriptor, seconds) == 1) return
      call set_status(status, STATUS_FILE, folder//': another run has had this folder for '//to_text(seconds/60.0_wp, 3)// &
                      ' minutes; end it, or take another folder (-o)')
   end subroutine await_lock

   !> Ends a claim. Folders that were made for it and are empty are removed.
   subroutine release_folder(claim)
      type(folder_claim_t), intent(inout) :: claim

      call remove_folders(claim%made)
      if (claim%descriptor >= 0) call c_close_folder(claim%descriptor)
      claim%descriptor = -1
   end subroutine release_folder

end module atrito_folder_claim
