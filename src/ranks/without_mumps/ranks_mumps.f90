!> The twin of src/linalg/atrito_ranks_mumps.f90 in a build without MUMPS: all of it fails, and nobody gets there.
module atrito_ranks_mumps
   use atrito_kinds, only: ip, lp, wp
   use atrito_linear_solver, only: factor_report_t
   use atrito_mumps_library, only: mumps_trouble
   use atrito_packed_matrices, only: packed_matrices_t
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   implicit none (type, external)
   private
   public :: ranks_mumps_t, begin_by_mumps, end_by_mumps, factor_by_mumps, solve_by_mumps, memory_by_mumps

   type :: ranks_mumps_t
      integer(ip) :: n = 0
      type(factor_report_t) :: report
      type(packed_matrices_t) :: own
   end type ranks_mumps_t

contains

   subroutine begin_by_mumps(system, n, start, unknown, status)
      type(ranks_mumps_t), intent(inout) :: system
      integer(ip), intent(in) :: n, start(:), unknown(:)
      type(status_t), intent(out) :: status

      call no_mumps(status)
   end subroutine begin_by_mumps

   subroutine no_mumps(status)
      type(status_t), intent(out) :: status

      call set_status(status, STATUS_INTERNAL, 'the ranks share a system by MUMPS, and '//mumps_trouble())
   end subroutine no_mumps

   subroutine factor_by_mumps(system, values, status)
      type(ranks_mumps_t), intent(inout) :: system
      real(wp), intent(inout), contiguous, target :: values(:)
      type(status_t), intent(out) :: status

      call no_mumps(status)
   end subroutine factor_by_mumps

   subroutine solve_by_mumps(system, x, status)
      type(ranks_mumps_t), intent(inout) :: system
      real(wp), intent(inout) :: x(:, :)
      type(status_t), intent(out) :: status

      call no_mumps(status)
   end subroutine solve_by_mumps

   pure integer(lp) function memory_by_mumps(system) result(bytes)
      type(ranks_mumps_t), intent(in) :: system

      bytes = 0
   end function memory_by_mumps

   subroutine end_by_mumps(system)
      type(ranks_mumps_t), intent(inout) :: system
   end subroutine end_by_mumps

end module atrito_ranks_mumps
