!> The library of MUMPS: its one routine and the type of its argument.
!>
!> It is loaded when it is asked for, not with the program: starting would cost a millisecond more for it and for what it needs, and
!> most scenes do without. CMake says which file that is (ATRITO_MUMPS_LIBRARY, its name with the version in it, so that
!> dmumps_struc has the layout of the header compiled in) and its version (ATRITO_MUMPS_VERSION).
module atrito_mumps_library
   use, intrinsic :: iso_c_binding, only: c_associated, c_f_procpointer, c_funptr
   use atrito_system, only: find_routine
   implicit none (type, external)
   private
   public :: dmumps_struc, call_mumps, load_mumps, has_mumps, mumps_name, mumps_trouble

   include 'dmumps_struc.h'

   abstract interface
      subroutine call_mumps(instance)
         import :: dmumps_struc
         type(dmumps_struc), intent(inout) :: instance
      end subroutine call_mumps
   end interface

contains

   !> Whether the library can be loaded.
   logical function has_mumps()
      procedure(call_mumps), pointer :: mumps

      call load_mumps(mumps)
      has_mumps = associated(mumps)
   end function has_mumps

   !> For the listing: 'MUMPS 5.5.1'.
   pure function mumps_name() result(name)
      character(len=:), allocatable :: name

      name = 'MUMPS '//ATRITO_MUMPS_VERSION
   end function mumps_name

   !> Why there is no MUMPS, where there is none.
   pure function mumps_trouble() result(text)
      character(len=:), allocatable :: text

      text = 'the library '//ATRITO_MUMPS_LIBRARY//' cannot be loaded'
   end function mumps_trouble

   !> Not associated where the library is not installed. Loading it again costs next to nothing.
   subroutine load_mumps(mumps)
      procedure(call_mumps), pointer, intent(out) :: mumps
      type(c_funptr) :: routine

      mumps => null()
      routine = find_routine(ATRITO_MUMPS_LIBRARY, 'dmumps_')
      if (c_associated(routine)) call c_f_procpointer(routine, mumps)
   end subroutine load_mumps

end module atrito_mumps_library
