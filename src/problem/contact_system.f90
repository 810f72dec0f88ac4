!> What the multiplier method needs of the bodies: their stiffness, their loads and the constraint rows over their unknowns.
!>
!> Unknowns x are the displacements u_e of all bodies, without rigid motions, and after them the amplitudes a of the rigid motions
!> of floating bodies: u = u_e + Z a. A is the stiffness of the bodies; at as many displacements of a floating body as it has
!> motions there is a spring to the ground besides. It takes no force where the forces on the body balance, and only says which
!> part of u is u_e.
!>
!> What a method may ask is to multiply by A, to factor A + B' R B + P with stiffnesses R >= 0 of the rows and P >= 0 of
!> the amplitudes, and to solve with the last factor. What A is made of, and where its parts are, it does not know: one
!> sparse matrix of all bodies (multiplier/), a dense one in tests, parts of a scene elsewhere.
module atrito_contact_system
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: contact_system_t

   type, abstract :: contact_system_t
      integer(ip) :: n = 0                       !< unknowns
      integer(ip) :: k = 0                       !< of them, the last ones: amplitudes of rigid motions
      integer(ip) :: n_bodies = 0                !< that its motions are of
      integer(ip) :: failed = 0                  !< unknown whose pivot was not positive in the last factorisation; 0: none
      integer(ip) :: generation = 0              !< counts the factorisations
      type(constraint_rows_t) :: rows            !< B
      real(wp), allocatable :: g0(:)             !< (rows) B (prescribed displacements), less the gap for normal rows [L]
      real(wp), allocatable :: flexibility(:)    !< (rows) c_i = sum_j B_ij^2 / A_jj over the displacements [L/F]
      real(wp), allocatable :: load(:)           !< (n) [F]
      real(wp), allocatable :: size_of_load(:)   !< (n) [F] of the terms that a load is the sum of
      integer(ip), allocatable :: body(:)        !< (n) of each unknown
   contains
      procedure(multiply_stiffness), deferred :: multiply
      procedure(factor_system), deferred :: factor
      procedure(solve_system), deferred :: solve
      procedure :: solve_at_rows
      procedure(count_bytes), deferred :: memory_bytes
   end type contact_system_t

   abstract interface

      !> y = A x.
      subroutine multiply_stiffness(self, x, y)
         import :: contact_system_t, wp
         class(contact_system_t), intent(in) :: self
         real(wp), intent(in) :: x(:)            !< (n) [L]
         real(wp), intent(out) :: y(:)           !< (n) [F]
      end subroutine multiply_stiffness

      !> Factors A + B' diag(stiffness) B + diag(pull) on the amplitudes. status: STATUS_SINGULAR when a pivot is not positive
      !> (self%failed), STATUS_INTERNAL when the memory does not suffice.
      subroutine factor_system(self, stiffness, pull, status)
         import :: contact_system_t, wp, status_t
         class(contact_system_t), intent(inout) :: self
         real(wp), intent(in) :: stiffness(:)    !< (rows) [F/L]; 0: the row takes no part
         real(wp), intent(in) :: pull(:)         !< (k) [F/L]
         type(status_t), intent(out) :: status
      end subroutine factor_system

      !> x <- the solution with the matrix that was factored last.
      subroutine solve_system(self, x)
         import :: contact_system_t, wp
         class(contact_system_t), intent(in) :: self
         real(wp), intent(inout) :: x(:)         !< (n) [F] in, [L] out
      end subroutine solve_system

      !> Memory held [bytes].
      pure integer(lp) function count_bytes(self)
         import :: contact_system_t, lp
         class(contact_system_t), intent(in) :: self
      end function count_bytes

   end interface

contains

   !> x <- the same at the unknowns of the rows and the amplitudes, of a load at these alone; what it is elsewhere is of no use. A
   !> system that can do no less solves for all.
   subroutine solve_at_rows(self, x)
      class(contact_system_t), intent(in) :: self
      real(wp), intent(inout) :: x(:)            !< (n) [F] in, [L] out

      call self%solve(x)
   end subroutine solve_at_rows

end module atrito_contact_system
