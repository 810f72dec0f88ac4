!> The solvers for the bodies by kind.
module atrito_solver_choice
   use atrito_banded, only: banded_t
   use atrito_kinds, only: ip
   use atrito_mumps, only: mumps_t
   use atrito_skyline, only: skyline_t
   use atrito_sparse_storage, only: sparse_t
   use atrito_storage, only: storage_t
   implicit none (type, external)
   private
   public :: new_storage, storage_name, N_STORAGES, STORAGE_SKYLINE, STORAGE_BANDED, STORAGE_SPARSE, STORAGE_MUMPS
   public :: needs_profile

   integer, parameter :: STORAGE_SKYLINE = 1
   integer, parameter :: STORAGE_BANDED = 2
   integer, parameter :: STORAGE_SPARSE = 3
   integer, parameter :: STORAGE_MUMPS = 4
   integer, parameter :: N_STORAGES = 4
   !> Equations from which on the sparse solver is the fastest for a body of any shape, so that no profile is needed to choose it.
   integer(ip), parameter :: LEAST_SPARSE = 4000_ip

contains

   !> Whether a body of n equations is to be numbered for its profile: it is not when it gets a solver with an order of its own.
   pure logical function needs_profile(asked, n)
      integer, intent(in) :: asked                               !< STORAGE_* or 0 for the choice
      integer(ip), intent(in) :: n

      needs_profile = asked == STORAGE_SKYLINE .or. asked == STORAGE_BANDED
      if (asked == 0) needs_profile = n < LEAST_SPARSE
   end function needs_profile

   !> An empty storage of a kind; not allocated when the kind is none of STORAGE_*.
   subroutine new_storage(kind, storage)
      integer, intent(in) :: kind                                !< one of STORAGE_*
      class(storage_t), allocatable, intent(out) :: storage

      select case (kind)
      case (STORAGE_SKYLINE)
         allocate (skyline_t :: storage)
      case (STORAGE_BANDED)
         allocate (banded_t :: storage)
      case (STORAGE_SPARSE)
         allocate (sparse_t :: storage)
      case (STORAGE_MUMPS)
         allocate (mumps_t :: storage)
      end select
   end subroutine new_storage

   !> 'skyline', 'banded', 'sparse' or 'mumps'.
   pure function storage_name(kind) result(name)
      integer, intent(in) :: kind                                !< one of STORAGE_*
      character(len=:), allocatable :: name
      character(len=7), parameter :: NAMES(N_STORAGES) = ['skyline', 'banded ', 'sparse ', 'mumps  ']

      name = trim(NAMES(kind))
   end function storage_name

end module atrito_solver_choice
