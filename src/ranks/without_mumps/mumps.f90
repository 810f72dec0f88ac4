!> The twin of src/ranks/mumps.F90 in a build without MUMPS, which has one rank: all of it fails, and nobody gets there.
module atrito_mumps
   use atrito_kinds, only: ip, lp, wp
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   implicit none (type, external)
   private
   public :: mumps_system_t, begin_mumps_system, end_mumps_system, factor_mumps_system, solve_mumps_system, mumps_system_bytes
   public :: has_mumps, mumps_version, mumps_trouble

   type :: mumps_system_t
      integer(ip) :: n = 0
      integer(ip) :: weakest = 0
   end type mumps_system_t

contains

   subroutine begin_mumps_system(system, n, unknown, status)
      type(mumps_system_t), intent(inout) :: system
      integer(ip), intent(in) :: n, unknown(:)
      type(status_t), intent(out) :: status

      if (n > 0) call set_status(status, STATUS_INTERNAL, mumps_trouble())
   end subroutine begin_mumps_system

   subroutine factor_mumps_system(system, values, status)
      type(mumps_system_t), intent(inout) :: system
      real(wp), intent(inout), contiguous, target :: values(:)
      type(status_t), intent(out) :: status
   end subroutine factor_mumps_system

   subroutine solve_mumps_system(system, x, status)
      type(mumps_system_t), intent(inout) :: system
      real(wp), intent(inout) :: x(:)
      type(status_t), intent(out) :: status
   end subroutine solve_mumps_system

   pure integer(lp) function mumps_system_bytes(system) result(bytes)
      type(mumps_system_t), intent(in) :: system

      bytes = 0
   end function mumps_system_bytes

   subroutine end_mumps_system(system)
      type(mumps_system_t), intent(inout) :: system
   end subroutine end_mumps_system

   pure logical function has_mumps()
      has_mumps = .false.
   end function has_mumps

   pure function mumps_version() result(version)
      character(len=:), allocatable :: version

      version = ''
   end function mumps_version

   pure function mumps_trouble() result(text)
      character(len=:), allocatable :: text

      text = 'this build has none'
   end function mumps_trouble

end module atrito_mumps
