!> The twin of src/linalg/atrito_shared_system.f90 in a build without MUMPS, which has one rank: nothing is shared then.
!> begin_shared fails all the same.
module atrito_shared_system
   use atrito_kinds, only: ip, lp, wp
   use atrito_linear_solver, only: factor_report_t
   use atrito_mumps_library, only: mumps_trouble
   use atrito_packed_matrices, only: packed_matrices_t
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   implicit none (type, external)
   private
   public :: shared_system_t, begin_shared, end_shared, factor_shared, schur_of_shared
   public :: solve_shared, reduce_shared, expand_shared, add_up_shared
   public :: memory_of_shared

   type :: shared_system_t
      integer(ip) :: n = 0
      integer(ip) :: n_kept = 0
      type(factor_report_t) :: report
      type(packed_matrices_t) :: own
   end type shared_system_t

contains

   subroutine begin_shared(system, n, n_kept, start, unknown, status)
      type(shared_system_t), intent(inout) :: system
      integer(ip), intent(in) :: n, n_kept, start(:), unknown(:)
      type(status_t), intent(out) :: status

      call no_mumps(status)
   end subroutine begin_shared

   subroutine no_mumps(status)
      type(status_t), intent(out) :: status

      call set_status(status, STATUS_INTERNAL, 'the ranks share a system by MUMPS, and '//mumps_trouble())
   end subroutine no_mumps

   subroutine factor_shared(system, values, status)
      type(shared_system_t), intent(inout) :: system
      real(wp), intent(inout), contiguous, target :: values(:)
      type(status_t), intent(out) :: status

      call no_mumps(status)
   end subroutine factor_shared

   subroutine schur_of_shared(system, schur)
      type(shared_system_t), intent(inout) :: system
      real(wp), intent(inout) :: schur(:, :)
   end subroutine schur_of_shared

   subroutine solve_shared(system, x, own, status)
      type(shared_system_t), intent(inout) :: system
      real(wp), intent(inout) :: x(:, :)
      real(wp), allocatable, intent(out) :: own(:, :)
      type(status_t), intent(out) :: status

      allocate (own(0, 0))
      call no_mumps(status)
   end subroutine solve_shared

   subroutine reduce_shared(system, f, status)
      type(shared_system_t), intent(inout) :: system
      real(wp), intent(inout) :: f(:, :)
      type(status_t), intent(out) :: status

      call no_mumps(status)
   end subroutine reduce_shared

   subroutine expand_shared(system, x, own, status)
      type(shared_system_t), intent(inout) :: system
      real(wp), intent(inout) :: x(:, :)
      real(wp), allocatable, intent(out) :: own(:, :)
      type(status_t), intent(out) :: status

      allocate (own(0, 0))
      call no_mumps(status)
   end subroutine expand_shared

   subroutine add_up_shared(system, own, x)
      type(shared_system_t), intent(in) :: system
      real(wp), intent(in) :: own(:, :)
      real(wp), intent(inout) :: x(:, :)
   end subroutine add_up_shared

   pure integer(lp) function memory_of_shared(system) result(bytes)
      type(shared_system_t), intent(in) :: system

      bytes = 0
   end function memory_of_shared

   subroutine end_shared(system)
      type(shared_system_t), intent(inout) :: system
   end subroutine end_shared

end module atrito_shared_system
