!> Kinds of numbers used everywhere.
module atrito_kinds
   use, intrinsic :: iso_fortran_env, only: int32, int64, real64
   implicit none (type, external)
   private
   public :: wp, ip, lp, EPS_MACH, HUGE_REAL, PI, is_nan

   integer, parameter :: wp = real64   !< every real of the program
   integer, parameter :: ip = int32    !< node, element and equation numbers
   integer, parameter :: lp = int64    !< lengths that grow faster than the mesh: profiles, bytes

   real(wp), parameter :: EPS_MACH = epsilon(1.0_wp)
   real(wp), parameter :: HUGE_REAL = huge(1.0_wp)
   real(wp), parameter :: PI = 3.14159265358979323846264338327950288_wp

contains

   !> The same as ieee_is_nan. A procedure that uses the intrinsic modules of IEEE arithmetic saves and restores the state of the
   !> processor at every call, which costs more than what the small ones do.
   elemental logical function is_nan(x)
      real(wp), intent(in) :: x !< any value, NaN among them

      is_nan = x /= x
   end function is_nan

end module atrito_kinds
