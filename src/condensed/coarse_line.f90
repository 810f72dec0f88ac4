!> A contact line of fewer points inside another one, for a start.
!>
!> The loop on a long line takes many full steps only to find which stretches of it are open, stick and slip. A coarse line tells
!> that nearly as well, for 1/64 of the operations: every STRIDE-th point of each pair is kept, and its last one. Stresses between
!> them are linear in the number of the point: with the shares I_ci of point i between the coarse points c at or before it and
!> behind it (their sum is 1) the forces are
!>
!>     q = R' q_c,    R_ci = w_i I_ci / w_c,    w_c = sum of w_i I_ci,
!>
!> and the bound-constrained QP of the coarse line is that of the fine one for these forces alone: C_c = R C R', G_c = R G, g0_c =
!> R g0, h_c = h. No body is asked again. The average S_rho is that of the fine line at the coarse points, applied to what is
!> linear between them; the law is that of the pair. A coarse line may have a coarse line.
!>
!> The states of the fine line are those of the nearest coarse points, its first bound is nu S_rho of the pressure that is linear
!> between them. Whatever is wrong with that, the loop on the fine line puts right.
module atrito_coarse_line
   use atrito_average, only: average_t, identity_average
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t
   use atrito_contact_line, only: pressure_of, contact_line_t, last_of_pair, number_unknowns, normal_bounds, friction_bound
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: interpolation_t, has_coarse_line, coarsen_line, start_from_coarse

   integer(ip), parameter :: STRIDE = 4_ip
   integer(ip), parameter :: LEAST_RATIO = 2_ip  !< of the points, for which a coarse line is worth while

   !> How the points of a line lie between those of its coarse line.
   type :: interpolation_t
      integer(ip), allocatable :: point(:)       !< (n_c) point of the line at each coarse one
      integer(ip), allocatable :: before(:)      !< (n) the coarse point at or before
      real(wp), allocatable :: share(:)          !< (n) of the coarse point after it; 0 at a coarse point
   end type interpolation_t

contains

   !> Whether the coarse line is clearly smaller. Pairs of few points keep most of them; so a line of coarse lines comes to its end.
   !>
   !> A wall of many joints with three points each has no coarse line to speak of.
   pure logical function has_coarse_line(line)
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      type(interpolation_t) :: interpolation

      call choose_points(line, interpolation)
      has_coarse_line = LEAST_RATIO*size(interpolation%point, kind=ip) <= line%n
   end function has_coarse_line

   !> The coarse line and its bound-constrained QP.
   !>
   !> No pass over the bodies: all of it is made from C, G and g0 of the fine line, in m^2 operations for each pass.
   subroutine coarsen_line(problem, line, interpolation, coarse_problem, coarse_line)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      type(interpolation_t), intent(out) :: interpolation !< where the points lie between coarse ones
      type(bound_qp_t), intent(out) :: coarse_problem     !< C, G, g0, h of the coarse points
      type(contact_line_t), intent(out) :: coarse_line    !< every fourth point with the weights between them

      call choose_points(line, interpolation)
      call build_coarse_line(line, interpolation, coarse_line)
      call restrict_problem(coarse_problem)

   contains

      !> C_c = R C R', G_c = R G, g0_c = R g0: the work of the coarse forces on what the fine points do. Two passes over the columns
      !> of C, R having two entries a row.
      subroutine restrict_problem(coarse)
         type(bound_qp_t), intent(out) :: coarse
         real(wp), allocatable :: half(:, :)
         real(wp) :: r
         integer(ip) :: i, c, u

         coarse%m = size(coarse_line%point, kind=ip)
         coarse%k = problem%k
         coarse%n_normal = count(coarse_line%normal > 0, kind=ip)
         coarse%h = problem%h
         if (allocated(problem%h_size)) coarse%h_size = problem%h_size
         coarse%weight = coarse_line%weight(coarse_line%point)
         allocate (coarse%g0(coarse%m), coarse%g(coarse%m, coarse%k), coarse%c(coarse%m, coarse%m), source=0.0_wp)
         ! half = C R', then C_c = R half
         allocate (half(problem%m, coarse%m), source=0.0_wp)
         do i = 1, problem%m
            associate (j => line%point(i))
               do c = interpolation%before(j), last_touched(interpolation, j)
                  u = unknown_of(problem, coarse_line, i, c)
                  r = share_of(interpolation, j, c)*problem%weight(i)/coarse%weight(u)
                  coarse%g0(u) = coarse%g0(u) + r*problem%g0(i)
                  coarse%g(u, :) = coarse%g(u, :) + r*problem%g(i, :)
                  half(:, u) = half(:, u) + r*problem%c(:, i)
               end do
            end associate
         end do
         do i = 1, problem%m
            associate (j => line%point(i))
               do c = interpolation%before(j), last_touched(interpolation, j)
                  u = unknown_of(problem, coarse_line, i, c)
                  r = share_of(interpolation, j, c)*problem%weight(i)/coarse%weight(u)
                  coarse%c(:, u) = coarse%c(:, u) + r*half(i, :)
               end do
            end associate
         end do
      end subroutine restrict_problem

   end subroutine coarsen_line

   !> Every STRIDE-th point of each pair from its first one on, its last one, and all bilateral rows; with the places of all others
   !> between them. Places count in points, not in lengths: what is wanted is a start.
   pure subroutine choose_points(line, interpolation)
      type(contact_line_t), intent(in) :: line
      type(interpolation_t), intent(out) :: interpolation
      integer(ip) :: chosen(line%n), n, j, first, last, in_pair

      allocate (interpolation%before(line%n), interpolation%share(line%n))
      n = 0
      first = 1
      do while (first <= line%n)
         last = last_of_pair(line, first)
         do j = first, last
            in_pair = mod(j - first, STRIDE)
            interpolation%share(j) = 0.0_wp
            ! forces of bilateral rows are no field
            if (in_pair == 0 .or. j == last .or. j > line%n - line%n_bilateral) then
               n = n + 1
               chosen(n) = j
            else
               ! the last interval may be shorter
               interpolation%share(j) = real(in_pair, wp)/real(min(STRIDE, last - (j - in_pair)), wp)
            end if
            interpolation%before(j) = n
         end do
         first = last + 1
      end do
      interpolation%point = chosen(:n)
   end subroutine choose_points

   !> Laws, weights and unknowns of the coarse points. The weight is the sum of those of the fine points by their shares, so that a
   !> uniform pressure has the same resultant; a coarse point has an unknown where a fine one that it bears upon has one.
   subroutine build_coarse_line(line, interpolation, coarse)
      type(contact_line_t), intent(in) :: line
      type(interpolation_t), intent(in) :: interpolation
      type(contact_line_t), intent(out) :: coarse
      logical, allocatable :: normal_row(:), tangential_row(:)
      integer(ip) :: j, c

      coarse%n = size(interpolation%point, kind=ip)
      coarse%n_bilateral = line%n_bilateral
      associate (point => interpolation%point)
         coarse%delta = line%delta(point)
         coarse%law = line%law(point)
         coarse%known_overlap = line%known_overlap(point)
         coarse%known_slip = line%known_slip(point)
         if (allocated(line%rest)) coarse%rest = line%rest(point)
         if (allocated(line%shear_before)) coarse%shear_before = line%shear_before(point)
         if (allocated(line%noise)) coarse%noise = line%noise(point)
         if (allocated(line%pair)) coarse%pair = line%pair(point)
      end associate
      allocate (coarse%weight(coarse%n), source=0.0_wp)
      allocate (normal_row(coarse%n), tangential_row(coarse%n), source=.false.)
      do j = 1, line%n
         do c = interpolation%before(j), last_touched(interpolation, j)
            coarse%weight(c) = coarse%weight(c) + share_of(interpolation, j, c)*line%weight(j)
            normal_row(c) = normal_row(c) .or. line%normal(j) > 0
            tangential_row(c) = tangential_row(c) .or. line%tangential(j) > 0
         end do
      end do
      coarse%average = coarse_average(line%average, interpolation)
      call number_unknowns(coarse, normal_row, tangential_row)
   end subroutine build_coarse_line

   !> The coarse points that a point lies between are before(j) to this one.
   pure integer(ip) function last_touched(interpolation, j)
      type(interpolation_t), intent(in) :: interpolation
      integer(ip), intent(in) :: j

      last_touched = interpolation%before(j)
      if (interpolation%share(j) > 0.0_wp) last_touched = last_touched + 1
   end function last_touched

   pure real(wp) function share_of(interpolation, j, c)
      type(interpolation_t), intent(in) :: interpolation
      integer(ip), intent(in) :: j, c            !< before(j) or the next

      share_of = interpolation%share(j)
      if (c == interpolation%before(j)) share_of = 1.0_wp - share_of
   end function share_of

   !> The rows of the average at the coarse points, applied to what is linear between them.
   !>
   !> (S p)_c = sum_j W_cj sum_d I_jd p_d, the row of W at the fine point under c.
   function coarse_average(average, interpolation) result(coarse)
      type(average_t), intent(in) :: average
      type(interpolation_t), intent(in) :: interpolation
      type(average_t) :: coarse
      real(wp), allocatable :: row(:)
      integer(ip) :: c, d, i, j, n

      n = size(interpolation%point, kind=ip)
      coarse = identity_average(n)
      if (average%is_identity) return
      coarse%is_identity = .false.
      deallocate (coarse%column, coarse%value)
      allocate (coarse%column(0), coarse%value(0))
      allocate (row(n))
      do c = 1, n
         row = 0.0_wp
         do i = average%first(interpolation%point(c)), average%first(interpolation%point(c) + 1) - 1
            j = average%column(i)
            do d = interpolation%before(j), last_touched(interpolation, j)
               row(d) = row(d) + average%value(i)*share_of(interpolation, j, d)
            end do
         end do
         coarse%column = [coarse%column, pack([(d, d=1, n)], row > 0.0_wp)]
         coarse%value = [coarse%value, pack(row, row > 0.0_wp)]
         coarse%first(c + 1) = size(coarse%column, kind=ip) + 1
      end do
   end function coarse_average

   !> The unknown at a coarse point of the same kind as unknown i; 0: none.
   pure integer(ip) function unknown_of(problem, coarse_line, i, c) result(u)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: coarse_line
      integer(ip), intent(in) :: i, c

      u = coarse_line%normal(c)
      if (i > problem%n_normal) u = coarse_line%tangential(c)
   end function unknown_of

   !> States of a line from those of the nearest points of its coarse line, and the friction bound of the coarse pressure.
   !>
   !> A point between two coarse ones takes the state of the nearer one; the pressure between them is linear, and what is negative
   !> counts as none.
   subroutine start_from_coarse(problem, line, interpolation, coarse_line, coarse_state, bounds, state, tau)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(contact_line_t), intent(in) :: line, coarse_line !< the fine line; the coarse one that was solved
      type(interpolation_t), intent(in) :: interpolation !< where the points lie between coarse ones
      type(box_state_t), intent(in) :: coarse_state      !< of the coarse solution
      type(box_bounds_t), intent(out) :: bounds          !< of the m forces, all points closed
      type(box_state_t), intent(out) :: state            !< from which the fine line starts
      real(wp), intent(out) :: tau(:)                !< (n) [F/L^2]
      real(wp) :: p(line%n), coarse_pressure(coarse_line%n)
      integer(ip) :: i, j, c, u

      ! all points closed at first, then the states of the nearest coarse points
      coarse_pressure = pressure_of(coarse_line, coarse_state%q)
      call normal_bounds(line, problem, bounds, state)
      state%a = coarse_state%a
      do i = 1, problem%m
         j = line%point(i)
         c = interpolation%before(j)
         if (interpolation%share(j) > 0.5_wp) c = c + 1
         u = unknown_of(problem, coarse_line, i, c)
         state%state(i) = coarse_state%state(u)
      end do
      do j = 1, line%n
         p(j) = 0.0_wp
         do c = interpolation%before(j), last_touched(interpolation, j)
            p(j) = p(j) + share_of(interpolation, j, c)*max(coarse_pressure(c), 0.0_wp)
         end do
      end do
      tau = friction_bound(line, p)
   end subroutine start_from_coarse

end module atrito_coarse_line
