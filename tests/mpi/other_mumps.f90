!> A stand-in for another version of MUMPS: it says which one it is, and does nothing else.
subroutine dmumps(instance)
   implicit none (type, external)
   include 'dmumps_struc.h'
   type(dmumps_struc), intent(inout) :: instance

   instance%version_number = '4.10.0'
   instance%infog = 0
   if (instance%job /= -1) stop 'this version of MUMPS was used'
end subroutine dmumps
