!> When the run-time library ends the program (an array that cannot be allocated, an index out of its range), it does so with
!> exit codes that mean something else here: 2 is an error in the deck. From guard_exit to release_exit such an end is code 9.
module atrito_exit_guard
   use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int
   use atrito_status, only: STATUS_INTERNAL
   implicit none (type, external)
   private
   public :: guard_exit, release_exit

   ! what exit() calls has no arguments, hence this state
   logical :: on_guard = .false.

   interface
      integer(c_int) function c_atexit(handler) bind(C, name='atexit')
         import :: c_funptr, c_int
         type(c_funptr), value :: handler
      end function c_atexit
      subroutine c_exit_now(code) bind(C, name='_exit')
         import :: c_int
         integer(c_int), value :: code
      end subroutine c_exit_now
   end interface

contains

   subroutine guard_exit()
      integer(c_int) :: ignored

      on_guard = .true.
      ignored = c_atexit(c_funloc(change_code))
   end subroutine guard_exit

   !> The program ends on its own account.
   subroutine release_exit()
      on_guard = .false.
   end subroutine release_exit

   subroutine change_code() bind(C)
      if (on_guard) call c_exit_now(int(STATUS_INTERNAL, c_int))
   end subroutine change_code

end module atrito_exit_guard
