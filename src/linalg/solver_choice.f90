!> The solvers for the bodies by kind.
!>
!> All three give the same numbers but for rounding. The skyline is the fastest for bodies of some hundred equations; the band goes
!> at the rate of LAPACK where all columns are about equally high; from a few thousand equations on nested dissection needs less
!> operations than any numbering of a profile, and the sparse solver is the choice whatever the shape (LEAST_SPARSE). Below that the
!> operations and the memory that atrito_profile predicts are compared.
module atrito_solver_choice
   use atrito_banded, only: banded_t
   use atrito_kinds, only: ip
   use atrito_skyline, only: skyline_t
   use atrito_sparse_solver, only: sparse_t
   use atrito_linear_solver, only: linear_solver_t
   implicit none (type, external)
   private
   public :: new_solver, solver_name, N_STORAGES, SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE
   public :: needs_profile

   integer, parameter :: SOLVER_SKYLINE = 1
   integer, parameter :: SOLVER_BANDED = 2
   integer, parameter :: SOLVER_SPARSE = 3
   integer, parameter :: N_STORAGES = 3
   !> Equations from which on the sparse solver is the fastest for a body of any shape, so that no profile is needed to choose it.
   integer(ip), parameter :: LEAST_SPARSE = 4000_ip

contains

   !> Whether a body of n equations is to be numbered for its profile: it is not when it gets a solver with an order of its own.
   pure logical function needs_profile(asked, n)
      integer, intent(in) :: asked                               !< SOLVER_* or 0 for the choice
      integer(ip), intent(in) :: n                               !< equations of the body

      needs_profile = asked == SOLVER_SKYLINE .or. asked == SOLVER_BANDED
      if (asked == 0) needs_profile = n < LEAST_SPARSE
   end function needs_profile

   !> An empty solver of a kind; not allocated when the kind is none of SOLVER_*.
   subroutine new_solver(kind, solver)
      integer, intent(in) :: kind                                !< one of SOLVER_*
      class(linear_solver_t), allocatable, intent(out) :: solver !< of this kind, without a matrix

      select case (kind)
      case (SOLVER_SKYLINE)
         allocate (skyline_t :: solver)
      case (SOLVER_BANDED)
         allocate (banded_t :: solver)
      case (SOLVER_SPARSE)
         allocate (sparse_t :: solver)
      end select
   end subroutine new_solver

   !> 'skyline', 'banded' or 'sparse'.
   pure function solver_name(kind) result(name)
      integer, intent(in) :: kind                                !< one of SOLVER_*
      character(len=:), allocatable :: name
      character(len=7), parameter :: NAMES(N_STORAGES) = ['skyline', 'banded ', 'sparse ']

      name = trim(NAMES(kind))
   end function solver_name

end module atrito_solver_choice
