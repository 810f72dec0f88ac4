!> The twin of src/linalg/mumps.F90 in a build without MUMPS (ATRITO_MUMPS=OFF, or not found). The command line does not
!> accept this solver then, so nothing here is reached; create fails all the same.
module atrito_mumps
   use atrito_mumps_library, only: mumps_trouble
   use atrito_profile, only: profile_t
   use atrito_sparse_solver, only: sparse_t
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL
   implicit none (type, external)
   private
   public :: mumps_t

   type, extends(sparse_t) :: mumps_t
   contains
      procedure :: create => create_mumps
   end type mumps_t

contains

   subroutine create_mumps(self, profile, status)
      class(mumps_t), intent(inout) :: self
      type(profile_t), intent(in) :: profile
      type(status_t), intent(out) :: status

      call set_status(status, STATUS_INTERNAL, 'this solver is MUMPS, and '//mumps_trouble())
   end subroutine create_mumps

end module atrito_mumps
