!> Nodal forces of what acts on a face, besides a uniform pressure: a traction along a direction, and hydrostatic pressure.
!>
!> Faces of the second degree may be curved. Hydrostatic pressure on them is integrated exactly, up to the level where it ends; the
!> length that a traction acts on is not a polynomial there, and is integrated by panels.
module atrito_face_loads
   use atrito_face_geometry, only: face_direction, line_rule, RULE_POINTS
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: depth_at
   use atrito_shape_functions, only: face_shape_values
   implicit none (type, external)
   private
   public :: traction_load, hydrostatic_load

   integer(ip), parameter :: PANELS = 8

contains

   !> Forces [F] of a traction of the same size and direction along the face.
   !>
   !>     f_a = int N_a traction h |dx/dt| dt
   !>
   !> The length |dx/dt| of a curved side is the root of a polynomial, which no Gauss rule has exactly. So the side is cut into
   !> panels of five points each, whose error falls with the tenth power of their length. On straight sides with the middle node in
   !> the middle |dx/dt| is constant, and the points are exact.
   pure subroutine traction_load(x, traction, thickness, state, f, places)
      real(wp), intent(in) :: x(:, :)              !< the face's nodes in the order of face_nodes [L], (2, 2 or 3)
      real(wp), intent(in) :: traction(2)          !< [F/L^2]
      real(wp), intent(in) :: thickness            !< [L]
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(out) :: f(:, :)             !< shape of x
      real(wp), intent(in), optional :: places(:)  !< what the depth goes by at the nodes (depth_places) [L]; default x1
      real(wp) :: points(RULE_POINTS), weights(RULE_POINTS), n(size(x, 2)), goes_by(size(x, 2)), t
      integer(ip) :: i, k, n_face

      goes_by = x(1, :)
      if (present(places)) goes_by = places
      n_face = size(x, 2, kind=ip)
      call line_rule(points, weights)
      f = 0.0_wp
      do k = 1, PANELS
         do i = 1, RULE_POINTS
            t = (2*k - 1 + points(i))/PANELS - 1
            n = face_shape_values(n_face, t)
            n = n*(weights(i)/PANELS*norm2(face_direction(x, t))*depth_at(state, thickness, dot_product(n, goes_by)))
            f(1, :) = f(1, :) + n*traction(1)
            f(2, :) = f(2, :) + n*traction(2)
         end do
      end do
   end subroutine traction_load

   !> Forces [F] of a pressure that is 0 at the level x2 = levels(1) and the magnitude at levels(2), linear in x2 on that side of
   !> the first one and 0 on the other; a positive pressure pushes on the element.
   pure subroutine hydrostatic_load(x, magnitude, levels, thickness, state, f, places)
      real(wp), intent(in) :: x(:, :)              !< the face's nodes in the order of face_nodes [L], (2, 2 or 3)
      real(wp), intent(in) :: magnitude            !< [F/L^2]
      real(wp), intent(in) :: levels(2)            !< [L]
      real(wp), intent(in) :: thickness            !< [L]
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(out) :: f(:, :)             !< shape of x
      real(wp), intent(in), optional :: places(:)  !< what the depth goes by at the nodes (depth_places) [L]; default x1
      real(wp) :: cuts(4), goes_by(size(x, 2))
      integer(ip) :: k, n_cuts

      goes_by = x(1, :)
      if (present(places)) goes_by = places
      f = 0.0_wp
      call cut_face((x(2, :) - levels(1))/(levels(2) - levels(1)), cuts, n_cuts)
      do k = 1, n_cuts - 1
         call add_panel(x, [magnitude, levels], cuts(k:k + 1), goes_by, thickness, state, f)
      end do
   end subroutine hydrostatic_load

   !> The ends of a face, and between them the places where a function of it is 0.
   !>
   !> value(t) = mean + half t + bend t^2 through the three nodes at t = -1, 1 and 0. Of the two roots
   !>
   !>     r = -(half + sign(half) sqrt(half^2 - 4 bend mean))/2,     t1 = mean/r,     t2 = r/bend,
   !>
   !> neither takes the difference of two near numbers, and each quotient is formed only where it is not far outside of the face: a
   !> straight face, bend = 0, has t1 alone. Between two cuts the value keeps its sign, so the pressure is a polynomial on each
   !> panel.
   pure subroutine cut_face(value, cuts, n)
      real(wp), intent(in) :: value(:)             !< at the nodes of the face: first, last, middle
      real(wp), intent(out) :: cuts(4)             !< in [-1,1], rising
      integer(ip), intent(out) :: n
      real(wp) :: half, mean, bend, root, zeros(2)
      integer(ip) :: k

      half = 0.5_wp*(value(2) - value(1))          ! value = mean + half t + bend t^2
      mean = 0.5_wp*(value(1) + value(2))
      bend = 0.0_wp
      if (size(value) > 2) then
         bend = mean - value(3)
         mean = value(3)
      end if
      zeros = 2.0_wp                               ! none on the face
      root = half**2 - 4*bend*mean
      if (root >= 0.0_wp) then
         root = -0.5_wp*(half + sign(sqrt(root), half))
         if (abs(mean) < 1.5_wp*abs(root)) zeros(1) = mean/root
         if (abs(root) < 1.5_wp*abs(bend)) zeros(2) = root/bend
      end if
      if (zeros(1) > zeros(2)) zeros = zeros(2:1:-1)
      n = 1
      cuts(1) = -1.0_wp
      do k = 1, 2
         if (.not. abs(zeros(k)) < 1.0_wp) cycle
         n = n + 1
         cuts(n) = zeros(k)
      end do
      n = n + 1
      cuts(n) = 1.0_wp
   end subroutine cut_face

   !> The part of a face between two places, where the pressure has one sign: none where it is that of the dry side.
   pure subroutine add_panel(x, law, ends, goes_by, thickness, state, f)
      real(wp), intent(in) :: x(:, :), ends(2), thickness
      real(wp), intent(in) :: law(3)               !< magnitude [F/L^2] and levels [L]
      real(wp), intent(in) :: goes_by(:)           !< what the depth goes by at the nodes [L]
      integer(ip), intent(in) :: state
      real(wp), intent(inout) :: f(:, :)
      real(wp) :: points(RULE_POINTS), weights(RULE_POINTS), n(size(x, 2)), tangent(2), place(2), t, share
      integer(ip) :: i

      call line_rule(points, weights)
      do i = 1, RULE_POINTS
         t = 0.5_wp*(ends(1) + ends(2)) + 0.5_wp*(ends(2) - ends(1))*points(i)
         n = face_shape_values(size(x, 2, kind=ip), t)
         place = matmul(x, n)
         share = (place(2) - law(2))/(law(3) - law(2))
         if (share <= 0.0_wp) cycle
         tangent = face_direction(x, t)
         n = n*(0.5_wp*(ends(2) - ends(1))*weights(i)*law(1)*share*depth_at(state, thickness, dot_product(n, goes_by)))
         ! travelling counter-clockwise the inward normal is the tangent turned by +90 degrees
         f(1, :) = f(1, :) - n*tangent(2)
         f(2, :) = f(2, :) + n*tangent(1)
      end do
   end subroutine add_panel

end module atrito_face_loads
