!> The twin of src/linalg/atrito_mumps.F90 in a build without MUMPS (ATRITO_MUMPS=OFF, or not found). The command line does not
!> accept this solver then, so nothing here is reached; create fails all the same.
module atrito_mumps
   use atrito_kinds, only: ip, lp, wp
   use atrito_mumps_library, only: mumps_trouble
   use atrito_profile, only: profile_t
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   use atrito_linear_solver, only: linear_solver_t
   implicit none (type, external)
   private
   public :: mumps_t

   type, extends(linear_solver_t) :: mumps_t
   contains
      procedure :: create => create_mumps
      procedure :: add => add_to_mumps
      procedure :: factor => factor_mumps
      procedure :: get_schur => get_mumps_schur
      procedure :: reduce => reduce_by_mumps
      procedure :: expand => expand_by_mumps
      procedure :: memory_bytes => mumps_memory
      procedure, nopass :: name => mumps_solver_name
   end type mumps_t

contains

   subroutine create_mumps(self, profile, status)
      class(mumps_t), intent(inout) :: self
      type(profile_t), intent(in) :: profile
      type(status_t), intent(out) :: status

      call set_status(status, STATUS_INTERNAL, 'this solver is MUMPS, and '//mumps_trouble())
   end subroutine create_mumps

   subroutine add_to_mumps(self, equations, matrix)
      class(mumps_t), intent(inout) :: self
      integer(ip), intent(in) :: equations(:)
      real(wp), intent(in) :: matrix(:, :)
   end subroutine add_to_mumps

   subroutine factor_mumps(self, status)
      class(mumps_t), intent(inout) :: self
      type(status_t), intent(out) :: status

      call set_status(status, STATUS_INTERNAL, 'this solver is MUMPS, and '//mumps_trouble())
   end subroutine factor_mumps

   subroutine get_mumps_schur(self, schur)
      class(mumps_t), intent(in) :: self
      real(wp), intent(out) :: schur(:, :)

      schur = 0.0_wp
   end subroutine get_mumps_schur

   subroutine reduce_by_mumps(self, f)
      class(mumps_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: f(:, :)
   end subroutine reduce_by_mumps

   subroutine expand_by_mumps(self, x)
      class(mumps_t), intent(in) :: self
      real(wp), intent(inout), contiguous :: x(:, :)
   end subroutine expand_by_mumps

   pure integer(lp) function mumps_memory(self)
      class(mumps_t), intent(in) :: self

      mumps_memory = 0
   end function mumps_memory

   pure function mumps_solver_name() result(name)
      character(len=:), allocatable :: name

      name = 'mumps'
   end function mumps_solver_name

end module atrito_mumps
