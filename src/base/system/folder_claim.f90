!> A folder of output belongs to one run at a time: two that write into the same one do so one after the other, and what stands
!> there in the end is all from one of them.
!>
!> The claim is a lock (flock) on the file .atrito.lock in it, which ends with the process however it ends: a file that is left by
!> one that was killed claims nothing. Nobody may read that file, so that only who may write into the folder can claim it. Where
!> the file system has no locks, or the file cannot be made, there is no claim and the run goes on.
module atrito_folder_claim
   use, intrinsic :: iso_c_binding, only: c_null_char
   use, intrinsic :: iso_fortran_env, only: error_unit
   use atrito_kinds, only: wp
   use atrito_paths, only: make_folder, remove_file, remove_folders
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
   use atrito_strings, only: string_t, to_text
   use atrito_system, only: c_open_lock, c_close_lock, c_is_lock_of, c_lock_folder, hide_line, note_path, forget_path
   use atrito_utf8, only: visible
   implicit none (type, external)
   private
   public :: folder_claim_t, claim_folder, release_folder

   type :: folder_claim_t
      type(string_t), allocatable :: made(:)         !< folders that were made for it
      character(len=:), allocatable :: lock          !< path of the file that is locked
      integer :: descriptor = -1                     !< of c_open_lock; -1: nothing is claimed
   end type folder_claim_t

   integer, parameter :: MOST_TRIES = 5               !< to make the file; another run may remove the folder meanwhile
   character(len=*), parameter :: LOCK_NAME = '.atrito.lock'
   real(wp), parameter :: LONGEST_WAIT = 3600.0_wp   !< [s]

contains

   !> Makes a folder where it is missing and claims it; waits, and says so, while another run has it.
   !>
   !> status: STATUS_FILE when the folder cannot be made, or another run keeps it too long. Then nothing is claimed.
   subroutine claim_folder(folder, claim, status, patience, silent)
      character(len=*), intent(in) :: folder         !< as the user wrote it
      type(folder_claim_t), intent(out) :: claim     !< for release_folder
      type(status_t), intent(out) :: status          !< STATUS_FILE without a folder, or where another run has it
      real(wp), intent(in), optional :: patience     !< [s] to wait for another run; default an hour
      logical, intent(in), optional :: silent        !< not a word about the wait
      integer :: tries
      real(wp) :: seconds
      logical :: tells

      seconds = LONGEST_WAIT
      if (present(patience)) seconds = patience
      tells = .true.
      if (present(silent)) tells = .not. silent
      tries = 0
      do while (tries < MOST_TRIES)
         call make_folder(folder, status, claim%made)
         if (is_ok(status)) then
            claim%descriptor = c_open_lock(folder//c_null_char)
            if (claim%descriptor < 0) tries = tries + 1
            if (claim%descriptor < 0) cycle
            call await_lock(claim%descriptor, folder, seconds, tells, status)
         end if
         if (.not. is_ok(status)) then
            call release_folder(claim)
            return
         end if
         ! the run that had it has removed the file, or the folder
         if (c_is_lock_of(claim%descriptor, folder//c_null_char) == 1) then
            claim%lock = folder//'/'//LOCK_NAME
            call note_path(claim%lock)
            return
         end if
         call c_close_lock(claim%descriptor)
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
      call hide_line()
      if (tells) write (error_unit, '(a)', iostat=ios) 'wait  another run writes into '//visible(folder)
      flush (error_unit, iostat=ios)
      if (c_lock_folder(descriptor, seconds) == 1) return
      call set_status(status, STATUS_FILE, folder//': another run has had this folder for '//to_text(seconds/60.0_wp, 3)// &
                      ' minutes; end it, or take another folder (-o)')
   end subroutine await_lock

   !> Ends a claim. Folders that were made for it and are empty are removed.
   subroutine release_folder(claim)
      type(folder_claim_t), intent(inout) :: claim !< of claim_folder; claims nothing afterwards

      if (allocated(claim%lock)) then
         call remove_file(claim%lock)
         call forget_path(claim%lock)
         deallocate (claim%lock)
      end if
      call remove_folders(claim%made)
      if (claim%descriptor >= 0) call c_close_lock(claim%descriptor)
      claim%descriptor = -1
   end subroutine release_folder

end module atrito_folder_claim
