!> What the fields of a contact pair are measured by when they are judged: its own stresses and motions, and what double precision
!> leaves uncertain of them.
!>
!> A displacement u of a body with n equations is wrong by about cond(K) EPS_MACH |u|, cond(K) being no less than 5e4
!> for small bodies, growing with n, and 10^digits where pivots have lost digits (usual_growth). So a slip or an opening
!> is none, below
!>
!>     1e-9 (largest relative motion of the pair) + growth EPS_MACH (displacement of the body),
!>
!> and a gap besides below the round-off of the coordinates that it is a difference of (measure_places). Of a history
!> the largest so far counts (had_t): what is left when loads go is round-off of that. Where the solver knows the terms
!> that gaps and slips are differences of, their round-off counts, too (add_round_off).
module atrito_contact_scales
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t, row_value
   use atrito_kinds, only: ip, wp, EPS_MACH
   implicit none (type, external)
   private
   public :: contact_scales_t, had_t, measure_places, printed_as_none, usual_growth, widen, had_motion, had_force, &
             force_round_off, add_round_off

   !> The largest that a history has had so far, body by body: what is left of it when loads go is round-off of that, however little
   !> else there is.
   type :: had_t
      real(wp), allocatable :: motion(:)         !< (bodies) displacement [L]; not allocated: nothing yet
      real(wp), allocatable :: force(:)          !< (bodies) load, contact force or reaction at a node [F]
   end type had_t

   type :: contact_scales_t
      real(wp) :: friction = 0.0_wp              !< largest friction bound [F/L^2]
      real(wp) :: slip = 0.0_wp, gap = 0.0_wp    !< that are none [L]
   end type contact_scales_t

   real(wp), parameter :: PLACE_TOLERANCE = 1.0e-9_wp  !< of the largest motion of a pair's sides against each other
   real(wp), parameter :: USUAL_CONDITION = 5.0e4_wp   !< of small bodies: a solution is wrong by its condition times EPS_MACH
   real(wp), parameter :: CONDITION_A_DOF = 10.0_wp    !< of fine meshes
   real(wp), parameter :: ROUND_OFFS = 8.0_wp          !< EPS_MACH of the largest coordinate in an initial distance

   real(wp), parameter, public :: NONE_OF_HAD = 1.0e-13_wp !< of what a history has had: displacements and forces that are none
   real(wp), parameter :: PRINTED_ZERO = 1.0e-14_wp    !< of the largest displacement: it is printed as none (atrito_number_text)

contains

   !> The displacement of a body that moves so much less than others that none of it is printed; else 0 [L].
   elemental real(wp) function printed_as_none(of_body, of_all)
      real(wp), intent(in) :: of_body            !< largest displacement of the body [L]
      real(wp), intent(in) :: of_all             !< of all [L]

      printed_as_none = merge(PRINTED_ZERO*of_all, 0.0_wp, of_body <= PRINTED_ZERO*of_all)
   end function printed_as_none

   !> Takes another increment into account: the largest motion and force of each body so far.
   pure subroutine widen(had, motion, force)
      type(had_t), intent(inout) :: had           !< only grows
      real(wp), intent(in) :: motion(:), force(:) !< (bodies) [L], [F]

      if (.not. allocated(had%motion)) then
         had%motion = motion
         had%force = force
         return
      end if
      had%motion = max(had%motion, motion)
      had%force = max(had%force, force)
   end subroutine widen

   !> [L] of body b; 0 at the beginning.
   pure real(wp) function had_motion(had, b) result(motion)
      type(had_t), intent(in) :: had
      integer(ip), intent(in) :: b

      motion = 0.0_wp
      if (allocated(had%motion)) motion = had%motion(b)
   end function had_motion

   !> [F] of body b; 0 at the beginning.
   pure real(wp) function had_force(had, b) result(force)
      type(had_t), intent(in) :: had
      integer(ip), intent(in) :: b

      force = 0.0_wp
      if (allocated(had%force)) force = had%force(b)
   end function had_force

   !> The force at a node that is round-off of those that the bodies have had [F].
   pure real(wp) function force_round_off(had) result(force)
      type(had_t), intent(in) :: had

      force = 0.0_wp
      if (allocated(had%force)) force = NONE_OF_HAD*maxval(had%force)
   end function force_round_off

   !> By how much round-off grows in the displacements of a body: max(5e4, 10 n, 10^(digits that pivots lost)), which stands for the
   !> condition of its stiffness.
   elemental real(wp) function usual_growth(n, digits_lost) result(growth)
      integer(ip), intent(in) :: n               !< equations
      real(wp), intent(in) :: digits_lost        !< by its worst pivot

      growth = max(USUAL_CONDITION, CONDITION_A_DOF*n, 10.0_wp**digits_lost)
   end function usual_growth

   !> Slips and gaps of a pair that are none, scales%slip and %gap: 1e-9 of the largest |N_j u|, |T_j u| and overlap
   !> delta p, and the uncertainty of the displacements at its points; of gaps the rounding of coordinates besides.
   pure subroutine measure_places(rows, u, uncertain, first, last, overlap, far, scales)
      type(contact_rows_t), intent(in) :: rows   !< of all points, over nodes
      real(wp), intent(in) :: u(:, :)            !< (2, n_nodes) [L]
      real(wp), intent(in) :: uncertain(:)       !< (n_nodes) of the displacements of the node's body [L]
      integer(ip), intent(in) :: first, last     !< points of the pair
      real(wp), intent(in) :: overlap            !< largest delta p [L]
      real(wp), intent(in) :: far                !< largest coordinate [L]
      type(contact_scales_t), intent(inout) :: scales !< slip and gap are replaced
      real(wp) :: motion, uncertainty
      integer(ip) :: j

      motion = overlap
      uncertainty = 0.0_wp
      do j = first, last
         motion = max(motion, abs(row_value(rows, j, rows%normal(:, j), u)), abs(row_value(rows, j, rows%tangent(:, j), u)))
         uncertainty = max(uncertainty, maxval(uncertain(rows%node(rows%first(j):rows%first(j + 1) - 1))))
      end do
      scales%slip = PLACE_TOLERANCE*motion + uncertainty
      scales%gap = scales%slip + ROUND_OFFS*EPS_MACH*far
   end subroutine measure_places

   !> Adds to them what the solver knows of its gaps and slips: differences of terms, each of which may be far larger than the
   !> displacements, as the sag of a slender bar by its load alone is that its bed takes back.
   pure subroutine add_round_off(line, round_off, first, last, scales)
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: round_off(:)       !< (unknowns) [L]
      integer(ip), intent(in) :: first, last     !< points of the pair
      type(contact_scales_t), intent(inout) :: scales
      real(wp) :: of_gap, of_slip
      integer(ip) :: j

      of_gap = 0.0_wp
      of_slip = 0.0_wp
      do j = first, last
         if (line%normal(j) > 0) of_gap = max(of_gap, round_off(line%normal(j)))
         if (line%tangential(j) > 0) of_slip = max(of_slip, round_off(line%tangential(j)))
      end do
      scales%gap = scales%gap + of_gap
      scales%slip = scales%slip + of_slip
   end subroutine add_round_off

end module atrito_contact_scales
