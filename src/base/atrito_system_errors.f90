!> Why the last call of the system failed. Linux (glibc, musl): its errno and the numbers of the cases that are told apart.
module atrito_system_errors
   use, intrinsic :: iso_c_binding, only: c_f_pointer, c_int, c_ptr
   implicit none (type, external)
   private
   public :: last_error, NO_SUCH_FILE, WOULD_WAIT, NOT_A_FOLDER

   integer(c_int), parameter :: NO_SUCH_FILE = 2_c_int            ! ENOENT
   integer(c_int), parameter :: WOULD_WAIT = 11_c_int             ! EAGAIN
   integer(c_int), parameter :: NOT_A_FOLDER = 20_c_int           ! ENOTDIR

   interface
      type(c_ptr) function c_errno_place() bind(C, name='__errno_location')
         import :: c_ptr
      end function c_errno_place
   end interface

contains

   !> The calling thread's own number, of the call before: ask at once.
   integer(c_int) function last_error()
      integer(c_int), pointer :: number

      call c_f_pointer(c_errno_place(), number)
      last_error = number
   end function last_error

end module atrito_system_errors
