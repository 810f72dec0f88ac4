!> Floating-point halting off around calls of LAPACK and BLAS, which raise harmless exceptions inside.
!>
!> The program stops at an invalid operation, a division by zero or an overflow of its own (it is built so for tests): each would be
!> a mistake. LAPACK tries some operations that may raise one, and looks at the result; fast kernels compute in lanes that hold
!> nothing. So the exceptions of a call are neither stopped at nor kept.
!>
!> C's feholdexcept and fesetenv, not ieee_set_halting_mode: a Fortran procedure restores the halting modes of its caller when
!> it returns (F2018, 17.6), so that a helper cannot switch them off for anybody else.
module atrito_halting
   use, intrinsic :: iso_c_binding, only: c_int64_t
   use atrito_system, only: c_suspend_halting, c_restore_halting
   implicit none (type, external)
   private
   public :: halting_t, suspend_halting, restore_halting

   !> A floating-point environment. C's fenv_t is 32 bytes on x86-64, less elsewhere.
   type :: halting_t
      private
      integer(c_int64_t) :: environment(32) = 0_c_int64_t !< bytes of a fenv_t, with room to spare
   end type halting_t

contains

   !> Saves the environment, clears the exception flags and stops the halting on any exception.
   subroutine suspend_halting(saved)
      type(halting_t), intent(out) :: saved !< for restore_halting

      call c_suspend_halting(saved%environment)
   end subroutine suspend_halting

   !> Back to what suspend_halting found: flags and halting modes.
   subroutine restore_halting(saved)
      type(halting_t), intent(in) :: saved !< as suspend_halting left it

      call c_restore_halting(saved%environment)
   end subroutine restore_halting

end module atrito_halting
