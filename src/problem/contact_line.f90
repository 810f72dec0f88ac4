!> The contact line of a scene: all points of all pairs, their laws, and where their unknown forces stand.
!>
!> At point j, with the weight w_j, stand the stresses p_j (pressure) and t_j (friction, acting on the master along T);
!> the unknowns are the forces q = w_j p_j and q = w_j t_j. The laws, equation (8) of docs/theory/formulation.md, are
!>
!>     p_j = (1/delta_j) (u_n - s_j)^+                                   delta = 0: contact without penetration
!>     t_j = min(|u_T - rest_j|/c_j, tau_j) sign(u_T - rest_j)           c = 0: exact stick
!>     tau_j = nu_j S_rho(p)_j = nu_j sum_k W_jk max(p_k, 0)             the friction bound
!>
!> Solvers see them as a problem with bounds (atrito_bound_qp): for a normal unknown 0 <= q, D = delta/w; for a tangential one, with
!> tau frozen, -w tau <= q <= w tau, D = c/w. Where tau = 0 a tangential force is frozen at 0. The unknowns are numbered with all
!> normal ones first, in the order of the points, then the tangential ones.
!>
!> A point whose row touches no free displacement has no unknown: u_n - s_j and u_T are known numbers there, and its stresses follow
!> from the laws. For a slip that is prescribed as nothing, or as less than round-off, exact stick leaves t open within -tau .. tau:
!> the point keeps the friction of the increment before.
module atrito_contact_line
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_friction_law, only: friction_law_t, stick_compliance, sticking_slip, friction_stress, FRICTION_NONE
   use atrito_average, only: average_t, apply_average
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE, FROZEN
   implicit none (type, external)
   private
   public :: contact_line_t, share_t, number_unknowns, tangential_of, pairs_of_unknowns, last_contact_pair, last_of_pair, &
             pressure_of, rest_noise, rest_of, shear_force_of, find_shear, slip_noise, slip_of_unknown, friction_bound, &
             normal_bounds, set_friction_bounds

   !> What a support takes of the friction of a point with a known slip (list_shares).
   type :: share_t
      integer(ip) :: point = 0, row = 0               !< of the line
      real(wp) :: part = 0.0_wp                       !< of the force
   end type share_t

   !> The n points. A point whose row of the contact matrix is zero (its dofs are prescribed) has no unknown; its normal
   !> displacement less the distance, and its slip, are known numbers. The last n_bilateral are no points of contact but bilateral
   !> rows (atrito_bilateral_rows): a normal force without a bound, no friction, delta = w times the compliance.
   type :: contact_line_t
      integer(ip) :: n = 0 !< points, with bilateral rows
      integer(ip) :: n_bilateral = 0                  !< of them, the last ones
      real(wp), allocatable :: weight(:)              !< [L^2]
      real(wp), allocatable :: delta(:)               !< [L^3/F]
      type(friction_law_t), allocatable :: law(:)     !< (n) friction of each point
      type(average_t) :: average                      !< S_rho, a row a point
      integer(ip), allocatable :: normal(:)           !< unknown of the normal force; 0: none
      integer(ip), allocatable :: tangential(:)       !< unknown of the tangential force; 0: none
      real(wp), allocatable :: known_overlap(:)       !< u_n - s [L] where normal is 0
      real(wp), allocatable :: known_slip(:)          !< u_T [L] where tangential is 0 for prescribed dofs
      !> Of laws with memory [L]: u_T at which the friction is none. Not allocated: 0.
      real(wp), allocatable :: rest(:) !< (n)
      !> Friction stress of the increment before [F/L^2]: what a point that does not move keeps. Not allocated: 0.
      real(wp), allocatable :: shear_before(:) !< (n)
      !> Largest displacement so far [L] of the pair of each point. Not allocated: none.
      real(wp), allocatable :: moved(:) !< (n)
      !> What round-off may do to a known slip [L]. Not allocated: 0.
      real(wp), allocatable :: noise(:)               !< (n)
      type(share_t), allocatable :: shares(:)         !< of friction that supports take; not allocated: none
      integer(ip), allocatable :: point(:)            !< (unknowns) point of each
      integer(ip), allocatable :: pair(:)             !< (n) contact pair of each, ascending; not allocated: one
      logical :: has_friction = .false.               !< some point has a law with friction
   end type contact_line_t

contains

   !> Numbers the unknowns: normal ones first, in the order of the points; tangential ones where there is friction.
   pure subroutine number_unknowns(line, normal_row, tangential_row)
      type(contact_line_t), intent(inout) :: line              !< with laws in; point, normal and tangential out
      logical, intent(in) :: normal_row(:), tangential_row(:)  !< (n) the point has a row
      logical :: has_tangential(line%n)
      integer(ip) :: j, m

      line%has_friction = any(line%law%kind /= FRICTION_NONE)
      has_tangential = tangential_row .and. line%law%kind /= FRICTION_NONE
      line%point = [pack([(j, j=1, line%n)], normal_row), pack([(j, j=1, line%n)], has_tangential)]
      m = count(normal_row, kind=ip)
      line%normal = unpack([(j, j=1, m)], normal_row, 0_ip)
      line%tangential = unpack([(j, j=m + 1, size(line%point, kind=ip))], has_tangential, 0_ip)
   end subroutine number_unknowns

   !> The contact pair of each unknown; those of bilateral rows are groups behind the pairs. Forces are judged by the
   !> largest of their own pair or group, so that a weak one beside a strong one keeps its digits.
   pure function pairs_of_unknowns(line) result(pair)
      type(contact_line_t), intent(in) :: line !< numbered
      integer(ip) :: pair(size(line%point))

      pair = 1
      if (allocated(line%pair)) pair = line%pair(line%point)
   end function pairs_of_unknowns

   !> The last pair that is one of contact; huge where all are.
   pure integer(ip) function last_contact_pair(line) result(last)
      type(contact_line_t), intent(in) :: line

      last = huge(1_ip)
      if (line%n_bilateral > 0) last = line%pair(line%n - line%n_bilateral + 1) - 1
   end function last_contact_pair

   !> The tangential unknown at the point of each of the n normal ones; 0: none, without friction; -1: no point of
   !> contact, a bilateral row.
   pure function tangential_of(line, n) result(i)
      type(contact_line_t), intent(in) :: line      !< numbered
      integer(ip), intent(in) :: n                  !< normal unknowns
      integer(ip) :: i(n)

      i = line%tangential(line%point(:n))
      where (line%point(:n) > line%n - line%n_bilateral) i = -1
   end function tangential_of

   !> The last point of the pair that begins at `first`; the points of a pair follow each other. Where no pairs are told
   !> all are of one.
   pure integer(ip) function last_of_pair(line, first) result(last)
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: first              !< its first point

      last = line%n
      if (.not. allocated(line%pair)) return
      last = first
      do while (last < line%n)
         if (line%pair(last + 1) /= line%pair(first)) exit
         last = last + 1
      end do
   end function last_of_pair

   !> Pressure p [F/L^2] at the points from the forces q: p = q/w, or (u_n - s)^+/delta of a known overlap. A known
   !> overlap of a contact without delta is an error of the deck, and has been told. Bilateral rows have their force
   !> over their weight, of either sign.
   pure function pressure_of(line, q) result(p)
      type(contact_line_t), intent(in) :: line      !< points, laws, numbering
      real(wp), intent(in) :: q(:)                  !< (unknowns) forces [F]
      real(wp) :: p(line%n)                         !< [F/L^2]
      integer(ip) :: j

      do j = 1, line%n
         if (line%normal(j) > 0) then
            p(j) = q(line%normal(j))/line%weight(j)
         else if ((line%known_overlap(j) > 0.0_wp .or. j > line%n - line%n_bilateral) .and. line%delta(j) > 0.0_wp) then
            p(j) = line%known_overlap(j)/line%delta(j)
         else
            p(j) = 0.0_wp
         end if
      end do
   end function pressure_of

   !> u_T [L] at which the friction of a point is none: laws with memory count the slip from there (atrito_slip_memory),
   !> others from 0.
   pure real(wp) function rest_of(line, j) result(rest)
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: j                  !< point

      rest = 0.0_wp
      if (allocated(line%rest)) rest = line%rest(j)
   end function rest_of

   !> Friction stress t [F/L^2] at the points (it acts on the master along T): t = q/w, or the law's of a slip that is known.
   pure function shear_force_of(line, q, tau) result(t)
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: q(:), tau(:)          !< (unknowns) [F], (n) friction bounds [F/L^2]
      real(wp) :: t(line%n)                         !< [F/L^2]
      integer(ip) :: j

      do j = 1, line%n
         if (line%tangential(j) > 0) then
            t(j) = q(line%tangential(j))/line%weight(j)
         else if (line%law(j)%kind /= FRICTION_NONE) then
            t(j) = known_shear(line, j, tau(j))
         else
            t(j) = 0.0_wp
         end if
      end do
   end function shear_force_of

   !> The friction, and the forces of supports that hold a known slip without it: their unknowns have the sum of both, since that
   !> friction has none.
   pure subroutine find_shear(line, q, tau, p, t)
      type(contact_line_t), intent(in) :: line !< with the shares of supports
      real(wp), intent(in) :: q(:), tau(:)          !< (unknowns) [F], (n) friction bounds [F/L^2]
      real(wp), intent(inout) :: p(:)               !< (n) from pressure_of [F/L^2]
      real(wp), allocatable, intent(inout) :: t(:)  !< (n) is replaced [F/L^2]
      integer(ip) :: i

      t = shear_force_of(line, q, tau)
      if (.not. allocated(line%shares)) return
      do i = 1, size(line%shares, kind=ip)
         associate (share => line%shares(i))
            p(share%row) = p(share%row) - share%part*t(share%point)*line%weight(share%point)/line%weight(share%row)
         end associate
      end do
   end subroutine find_shear

   !> What is none of a slip that is known [L].
   pure real(wp) function slip_noise(line, j) result(noise)
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: j                  !< point

      noise = 0.0_wp
      if (allocated(line%noise)) noise = line%noise(j)
   end function slip_noise

   !> What is none of a slip that counts from a rest slip [L]; without one every slip is one.
   pure real(wp) function rest_noise(line, j) result(noise)
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: j                  !< point

      noise = 0.0_wp
      if (abs(line%rest(j)) > 0.0_wp) noise = slip_noise(line, j)
   end function rest_noise

   !> The friction stress of a point whose slip is prescribed. Where nothing moves, exact stick, and a spring that round-off would
   !> strain, leave it open within its bound: it keeps what it had.
   pure real(wp) function known_shear(line, j, tau) result(t)
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: j                  !< point
      real(wp), intent(in) :: tau                   !< friction bound [F/L^2]

      associate (slip => line%known_slip(j) - rest_of(line, j))
         if (max(abs(slip), sticking_slip(line%law(j), tau)) > slip_noise(line, j)) then
            t = friction_stress(line%law(j), tau, slip)
         else
            t = 0.0_wp
            if (allocated(line%shear_before)) t = min(max(line%shear_before(j), -tau), tau)
         end if
      end associate
   end function known_shear

   !> u_T less the rest slip [L] of a tangential unknown, D q + r: that of its law, c t, where it sticks (r = 0), which
   !> has more digits than the displacements; and what it slides by besides where its friction is full.
   pure real(wp) function slip_of_unknown(bounds, state, i) result(slip)
      type(box_bounds_t), intent(in) :: bounds
      type(box_state_t), intent(in) :: state
      integer(ip), intent(in) :: i                  !< tangential unknown

      slip = bounds%d(i)*state%q(i)
      if (state%state(i) /= FREE) slip = slip + state%r(i)
   end function slip_of_unknown

   !> The friction bound tau = nu S_rho(p) [F/L^2] at the points, tau_j = nu_j sum_k W_jk max(p_k, 0): tensions, which
   !> an iteration may have and a solution has not, count as none.
   pure function friction_bound(line, p) result(tau)
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: p(:)                  !< (n) pressures [F/L^2]
      real(wp) :: tau(line%n)                       !< [F/L^2]

      tau = line%law%nu*apply_average(line%average, max(p, 0.0_wp))
   end function friction_bound

   !> Bounds and compliances of the normal forces, 0 <= q and D = delta/w, those of bilateral rows without a bound; and
   !> all points closed, none with friction.
   pure subroutine normal_bounds(line, problem, bounds, state)
      type(contact_line_t), intent(in) :: line
      type(bound_qp_t), intent(in) :: problem       !< of which the shape counts
      type(box_bounds_t), intent(out) :: bounds     !< lower, upper [F], d [L/F]
      type(box_state_t), intent(out) :: state       !< all free or frozen, no forces
      integer(ip) :: i

      allocate (bounds%lower(problem%m), bounds%d(problem%m), source=0.0_wp)
      allocate (bounds%upper(problem%m), source=HUGE_REAL)
      allocate (state%state(problem%m), source=FREE)
      allocate (state%q(problem%m), state%a(problem%k), state%r(problem%m), source=0.0_wp)
      do i = 1, problem%n_normal
         bounds%d(i) = line%delta(line%point(i))/line%weight(line%point(i))
         if (line%point(i) > line%n - line%n_bilateral) bounds%lower(i) = -HUGE_REAL
      end do
      state%state(problem%n_normal + 1:) = FROZEN
   end subroutine normal_bounds

   !> Bounds and compliances of the tangential forces for a friction bound: -w tau <= q <= w tau, D = c(tau)/w. Points
   !> that had none begin stuck; points that have none now take no part. The bound HUGE_REAL is none at all: stuck
   !> whatever the force.
   !>
   !>     tau                    bound         D                  state
   !>     HUGE_REAL              none          0                  FREE: it sticks, whatever the force
   !>     0                      0             0                  FROZEN: no friction
   !>     else                   w tau         c(tau)/w           as it is; a point that was FROZEN begins stuck
   !>
   !> c is the compliance of sticking: 0 or 1/k of LOCAL, eps/tau of NONLOCAL. States stay from one bound to the next, so the QP of
   !> the next bound begins where that of the last one ended.
   pure subroutine set_friction_bounds(line, problem, tau, bounds, state)
      type(contact_line_t), intent(in) :: line
      type(bound_qp_t), intent(in) :: problem       !< of which the shape counts
      real(wp), intent(in) :: tau(:)                  !< (n) [F/L^2]
      type(box_bounds_t), intent(inout) :: bounds
      type(box_state_t), intent(inout) :: state
      integer(ip) :: i, j

      do i = problem%n_normal + 1, problem%m
         j = line%point(i)
         bounds%d(i) = 0.0_wp
         if (tau(j) >= HUGE_REAL) then
            bounds%upper(i) = HUGE_REAL
            state%state(i) = FREE
         else if (tau(j) == 0.0_wp) then
            bounds%upper(i) = 0.0_wp
            state%state(i) = FROZEN
         else
            bounds%upper(i) = tau(j)*line%weight(j)
            bounds%d(i) = stick_compliance(line%law(j), tau(j))/line%weight(j)
            if (state%state(i) == FROZEN) state%state(i) = FREE
         end if
         bounds%lower(i) = -bounds%upper(i)
      end do
   end subroutine set_friction_bounds

end module atrito_contact_line
