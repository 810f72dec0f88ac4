!> What the sparse form of the contact system keeps from one increment to the next: displacements of all bodies with the amplitudes
!> of their motions, and the sizes of step and pull. A restart file has it, too.
!>
!> A step of the method (multiplier/) solves
!>
!>     A x + kappa hold (a - a_o) + B' q = f,     q = clip((B x + g0 + rho q_o)/(D + rho)),     rho_i = r part_i c_i,
!>
!> from the forces q_o and the amplitudes a_o of the step before: rho is a compliance that each row has besides that of
!> its law, c_i the flexibility of the row (atrito_contact_system), and kappa keeps a motion near where it was. Both
!> vanish from the solution when q = q_o and a = a_o.
module atrito_multipliers
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: multiplier_t

   type :: multiplier_t
      real(wp) :: r = 1.0e-2_wp                  !< rho over the flexibility of the row
      real(wp), allocatable :: part(:)           !< (m) of that, which the row takes: less where its forces come slowly
      real(wp) :: kappa = 1.0e-4_wp              !< pull on a motion over what its rows hold it with
      real(wp), allocatable :: x(:)              !< (n) [L]
      real(wp), allocatable :: e(:)              !< (m) B x + g0 [L]
      real(wp), allocatable :: noise(:)          !< (m) what round-off of e may do to a force [F]
      real(wp), allocatable :: q_old(:)          !< (m) [F]
      real(wp), allocatable :: a_old(:)          !< (k) [L]
      real(wp), allocatable :: went(:), grew(:), bound_grew(:) !< from the increment before: x [L], q [F] and tau [F/L^2]
      integer(ip), allocatable :: were(:)        !< (m) states in the increment before
      real(wp), allocatable :: hold(:)           !< (k) [F/L] sum of G_ij^2/c_i over the rows of the body
      integer(ip), allocatable :: pair(:)        !< (m) contact pair of each row
      real(wp), allocatable :: before(:)         !< (n_pairs) largest force in the increment before, 0 where there is none [F]
      integer(ip) :: n_pairs = 0                 !< pairs and groups of bilateral rows
      integer(ip) :: n_contact_pairs = huge(1_ip) !< those behind are groups of bilateral rows
      real(wp), allocatable :: stiffness(:)      !< (m) that was factored last
      real(wp), allocatable :: pull(:)           !< (k) that was factored last
      logical :: settled = .false.               !< the last step ended with the states that it assumed
      logical :: changed = .false.               !< the last step changed a state: e is computed from x again
      integer(ip) :: factorisations = 0, solves = 0 !< of the increment
      integer(ip) :: generation = -1             !< of the system's factorisation that stiffness and pull are of
   end type multiplier_t

end module atrito_multipliers
