!> The contact problem in the contact forces, friction bounds frozen: a convex quadratic problem with bounds.
!>
!> Unknowns are the forces q_i at the points (normal: q = w p, tangential: q = w t) and the amplitudes a of the rigid motions:
!>
!>     r = g0 - (C + D) q + G a,       G' q = h
!>     free   lower <= q <= upper and r = 0      (closed, sticking)
!>     fixed  q = lower and r <= 0, or q = upper and r >= 0      (open, slipping)
!>
!> These are the conditions of the minimum of the complementary energy of the bodies under the bounds,
!>
!>     1/2 q' (C + D) q - g0' q -> min     with  lower <= q <= upper,   G' q = h,
!>
!> a being the multipliers of equilibrium and r those of the bounds: with L = 1/2 q' (C + D) q - g0' q - a' (G' q - h)
!> the gradient by q is -r. C is positive semidefinite and D >= 0, so every solution is a minimum, and where the rows of
!> the free unknowns are independent there is one.
!>
!> C is the flexibility of the bodies seen from the points, D the compliances of the laws (delta/w, eps/(w tau)), G the rigid
!> motions at the points, h the loads' work on them (docs/theory/formulation.md, section 4).
!> With a shift v in the state, r = g0 + v - (C + D) q + G a. What solves it stands in condensed/: atrito_free_set where the free
!> unknowns are known, atrito_active_set and atrito_goldfarb_idnani where they are to be found.
module atrito_bound_qp
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: bound_qp_t, box_bounds_t, box_state_t, box_outcome_t
   public :: FREE, AT_LOWER, AT_UPPER, FROZEN, DEPENDENT_POINTS

   !> State of an unknown. FROZEN: q = 0 whatever r is (a point without friction).
   integer(ip), parameter :: FREE = 0, AT_LOWER = 1, AT_UPPER = 2, FROZEN = 3

   type :: bound_qp_t
      integer(ip) :: m = 0                       !< unknown forces
      integer(ip) :: k = 0                       !< rigid motions
      integer(ip) :: n_normal = 0                !< the first ones are normal
      real(wp), allocatable :: c(:, :)           !< (m, m) [L/F]
      real(wp), allocatable :: g(:, :)           !< (m, k) dimensionless
      real(wp), allocatable :: g0(:)             !< (m) [L]
      real(wp), allocatable :: h(:)              !< (k) [F]
      real(wp), allocatable :: h_size(:)         !< (k) [F] the same of all forces without sign; not allocated: |h|
      real(wp), allocatable :: weight(:)         !< (m) weight of the point [L^2]: stress = q / weight
      real(wp), allocatable :: slip_noise(:)     !< (m) slips that are none, of points with a rest slip [L]; not allocated: 0
      logical :: is_coarse = .false.             !< all rows have the round-off of the largest
      logical :: is_logged = .false.             !< every linear solve is kept (solve_log_t), for who wants to look at them
   end type bound_qp_t

   type :: box_bounds_t
      real(wp), allocatable :: lower(:), upper(:) !< (m) [F]; upper may be huge
      real(wp), allocatable :: d(:)              !< (m) [L/F]
   end type box_bounds_t

   type :: box_state_t
      integer(ip), allocatable :: state(:)       !< (m)
      real(wp), allocatable :: q(:)              !< (m) [F]
      real(wp), allocatable :: a(:)              !< (k) [L]
      real(wp), allocatable :: r(:)              !< (m) [L]
      real(wp), allocatable :: shift(:)          !< (m) [L] added to g0 (atrito_proximal); not allocated: none
      real(wp) :: slack = 0.0_wp                 !< round-off of the largest r, whatever its row [L]
   end type box_state_t

   character(len=*), parameter :: DEPENDENT_POINTS = 'dependent contact points'

   !> How the solution of the problem went (atrito_active_set and others).
   type :: box_outcome_t
      logical :: solved = .false.                 !< no unknown breaks its condition
      logical :: moves = .false.                  !< no equilibrium: a free motion under the load
      logical :: hardly = .false.                 !< with moves: so little load that the body rests where nothing stops it
      real(wp), allocatable :: motion(:)          !< (k) that motion
      real(wp), allocatable :: undetermined(:)            !< (k) a motion that nothing holds and nothing drives; else not allocated
      real(wp) :: condition = 1.0_wp                      !< of the last matrix, estimated; 1: not asked for
      integer(ip) :: dependent = 0                !< unknown whose row depends on others
      logical :: used_goldfarb_idnani = .false.   !< full steps did not settle
      logical, allocatable :: is_shared(:)        !< (m) the force is not unique, the least is given; not allocated: not asked for
   end type box_outcome_t

end module atrito_bound_qp
