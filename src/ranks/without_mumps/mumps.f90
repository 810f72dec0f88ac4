!> The twin of src/ranks/mumps.F90 in a build without MUMPS, which has one rank: all of it fails, and nobody gets there.
module atrito_mumps
   use atrito_kinds, only: ip, lp, wp
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   implicit none (type, external)
   private
   public :: mumps_system_t, begin_mumps_system, end_mumps_system, factor_mumps_system, solve_mumps_system, mumps_system_bytes
   public :: has_mumps, mumps_version, mumps_trouble

   !> No system.
   type :: mumps_system_t
      integer(ip) :: n = 0                       !< unknowns; stays 0
      integer(ip) :: weakest = 0                 !< unknown; stays 0
   end type mumps_system_t

contains

   !> status: STATUS_INTERNAL, with the reason, where there is anything to solve.
   subroutine begin_mumps_system(system, n, unknown, status)
      type(mumps_system_t), intent(inout) :: system !< stays empty
      integer(ip), intent(in) :: n, unknown(:)      !< unknowns of the system and of this rank
      type(status_t), intent(out) :: status         !< STATUS_INTERNAL where n > 0

      if (n > 0) call set_status(status, STATUS_INTERNAL, mumps_trouble())
   end subroutine begin_mumps_system

   !> Not called, since no system begins.
   subroutine factor_mumps_system(system, values, status)
      type(mumps_system_t), intent(inout) :: system            !< not used
      real(wp), intent(inout), contiguous, target :: values(:) !< stay
      type(status_t), intent(out) :: status                    !< STATUS_OK
   end subroutine factor_mumps_system

   !> Not called, since no system begins.
   subroutine solve_mumps_system(system, x, status)
      type(mumps_system_t), intent(inout) :: system !< not used
      real(wp), intent(inout) :: x(:)               !< stays
      type(status_t), intent(out) :: status         !< STATUS_OK
   end subroutine solve_mumps_system

   !> Nothing is held [bytes].
   pure integer(lp) function mumps_system_bytes(system) result(bytes)
      type(mumps_system_t), intent(in) :: system !< not used

      bytes = 0
   end function mumps_system_bytes

   !> There is nothing to let go of.
   subroutine end_mumps_system(system)
      type(mumps_system_t), intent(inout) :: system !< not used
   end subroutine end_mumps_system

   !> This build has none.
   pure logical function has_mumps()
      has_mumps = .false.
   end function has_mumps

   !> Of no library: empty.
   pure function mumps_version() result(version)
      character(len=:), allocatable :: version

      version = ''
   end function mumps_version

   !> Why there is no MUMPS.
   pure function mumps_trouble() result(text)
      character(len=:), allocatable :: text

      text = 'this build has none'
   end function mumps_trouble

end module atrito_mumps
