!> A linear programme and its solution, as plain data: what atrito_clp takes and gives.
!>
!>     minimise objective'x   with   row_lower <= A x <= row_upper,   lower <= x <= upper
!>
!> At an optimum there is a dual y, a number a row, such that the reduced costs z = objective - A'y and the rows say why no step
!> makes the objective smaller: z_j > 0 only where x_j is at its lower bound, z_j < 0 only at its upper one, and in the same way y_i
!> > 0 only where row i is at row_lower, y_i < 0 only at row_upper. y_i is what the objective gains by a unit of the bound of row i.
!>
!> Where no x keeps all rows and bounds, there is a combination y of the rows that proves it (Farkas): the largest that y'A x can be
!> within the bounds of x is less than the least that the bounds of the rows ask for. That is how balance and mechanism of a scene
!> are two sides of one programme (limit/).
module atrito_linear_program
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: linear_program_t, linear_solution_t
   public :: LP_BY_SIMPLEX, LP_BY_BARRIER
   public :: LP_OPTIMAL, LP_INFEASIBLE, LP_UNBOUNDED, LP_FAILED, LP_NOT_AVAILABLE

   !> How a solution ended. LP_FAILED: too many steps or trouble with round-off. LP_NOT_AVAILABLE: there is no solver.
   integer, parameter :: LP_OPTIMAL = 0, LP_INFEASIBLE = 1, LP_UNBOUNDED = 2, LP_FAILED = 3, LP_NOT_AVAILABLE = 4

   !> The dual simplex method from the basis of the rows; or an interior point method, which ends with simplex steps to a basis.
   integer, parameter :: LP_BY_SIMPLEX = 1, LP_BY_BARRIER = 2

   !> A bound of HUGE_REAL, or -HUGE_REAL, is none.
   type :: linear_program_t
      integer(ip) :: n_rows = 0                                 !< rows of A
      integer(ip) :: n_columns = 0                              !< columns of A, unknowns
      integer(ip), allocatable :: first(:)           !< (n_columns + 1) A by columns: entries first(j) : first(j+1) - 1
      integer(ip), allocatable :: row(:)             !< of each entry, 1 .. n_rows
      real(wp), allocatable :: entry(:)                         !< values, in the order of `row`
      real(wp), allocatable :: lower(:), upper(:), objective(:) !< (n_columns)
      real(wp), allocatable :: row_lower(:), row_upper(:)       !< (n_rows)
   end type linear_program_t

   type :: linear_solution_t
      integer :: status = LP_NOT_AVAILABLE           !< LP_*
      real(wp), allocatable :: x(:)                  !< (n_columns)
      real(wp), allocatable :: dual(:)               !< (n_rows) what the objective gains with the bound of a row
      real(wp) :: objective = 0.0_wp                 !< objective'x at the optimum
      integer(ip) :: iterations = 0                  !< steps that the solver took
   end type linear_solution_t

end module atrito_linear_program
