!> The outcome of a call that can fail for numerical reasons or because of files.
!>
!> Deck errors do not travel this way: they are collected in atrito_messages.
module atrito_status
   implicit none (type, external)
   private
   public :: status_t, set_status, reword_status, is_ok
   public :: STATUS_OK, STATUS_USAGE, STATUS_DECK, STATUS_NOT_CONVERGED, STATUS_SINGULAR, STATUS_FILE, STATUS_INTERNAL

   !> Exit codes of the program (docs/user/running.md).
   integer, parameter :: STATUS_OK = 0             !< solved, checked, written
   integer, parameter :: STATUS_USAGE = 1          !< wrong command line, or tables differ
   integer, parameter :: STATUS_DECK = 2           !< errors in the deck, listed in atrito_messages
   integer, parameter :: STATUS_NOT_CONVERGED = 3  !< last iterate written
   integer, parameter :: STATUS_SINGULAR = 4       !< singular or indefinite system, free motion
   integer, parameter :: STATUS_FILE = 5           !< cannot read, cannot write
   integer, parameter :: STATUS_INTERNAL = 9       !< a broken invariant

   type :: status_t
      integer :: code = STATUS_OK                  !< one of STATUS_*
      character(len=:), allocatable :: text        !< one line or more for the user; allocated unless OK
   end type status_t

contains

   !> Says what went wrong.
   pure subroutine set_status(status, code, text)
      type(status_t), intent(out) :: status        !< what it said before is lost
      integer, intent(in) :: code                  !< one of STATUS_*
      character(len=*), intent(in) :: text         !< one line or more for the user

      status%code = code
      status%text = text
   end subroutine set_status

   !> Says the same in other words.
   pure subroutine reword_status(status, text)
      type(status_t), intent(inout) :: status !< one that has failed; its code stays
      character(len=*), intent(in) :: text    !< one line or more for the user

      status%text = text
   end subroutine reword_status

   !> Whether nothing has failed: the code is STATUS_OK.
   pure logical function is_ok(status)
      type(status_t), intent(in) :: status !< as the call left it

      is_ok = status%code == STATUS_OK
   end function is_ok

end module atrito_status
