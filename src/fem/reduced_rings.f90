!> Axisymmetric elements whose stiffness is integrated at fewer points: four nodes (CAX4R); eight nodes take 2 x 2 points and
!> nothing else (atrito_axisymmetric).
!>
!> The strains of four nodes are their means over the volume, hoop strain and all: so a uniform stress has the nodal forces that
!> pressures have on the sides, which one point in the middle would not give, as 2 pi r N,z is not linear. Those four means feel
!> four of the eight motions; one is free anyway. What is left are the two hourglasses and a turn of the section, whose hoop
!> strain changes its sign within the element. They have strains of their own, as in the plane (atrito_reduced_integration), at
!> 2 x 2 points: along the axes 1', 2' of the element, with h = xi eta, q the amplitude of the hourglass and t1 xi + t2 eta what
!> the hoop strain u1/x1 varies by in the element,
!>
!>     e11 = h,1 q1 - m (h,2 q2 + t1 xi),   e22 = h,2 q2 - m (h,1 q1 + t2 eta),   e33 = t1 xi + t2 eta,   2 e12 = 0,
!>
!> m = mu/(1 - mu): those of plates and shells, whose stress across the thickness is none. What varies as xi eta is left out: in
!> that the hourglass would be stiff. All of it is nothing where u1 = c x1 and u2 is linear, and the work of the mean strains on it
!> is left out, which leaves the forces of a uniform stress as they are.
module atrito_reduced_rings
   use atrito_axisymmetric, only: strain_rows_t, strain_rows, mean_strain_rows, add_point, add_orthotropic_point, balance_axis
   use atrito_element_table, only: BEST_OF
   use atrito_kinds, only: ip, wp
   use atrito_orthotropy, only: turned_stiffness
   use atrito_plane_state, only: elastic_t, elasticity_matrix, COMPONENTS, depth_at
   use atrito_reduced_integration, only: share_of_point, hourglass_amplitude, element_axes
   use atrito_shape_functions, only: rule_point, shape_gradients
   implicit none (type, external)
   private
   public :: reduced_ring_stiffness, spread_ring_strains

   integer(ip), parameter :: N = 4, N_DOFS = 2*N
   !> Points of the hourglass strains, and the sum of xi^2 over them.
   integer(ip), parameter :: N_POINTS = 4
   real(wp), parameter :: SQUARES = 4.0_wp/3

contains

   !> Stiffness [F/L] of a ring of four nodes, of the full circle.
   pure subroutine reduced_ring_stiffness(x, section, state, k, radius)
      real(wp), intent(in) :: x(:, :)              !< coordinates [L], (2, 4)
      type(elastic_t), intent(in) :: section       !< elastic constants and thickness
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(out) :: k(:, :)             !< (8, 8)
      real(wp), intent(in), optional :: radius     !< of the origin of x [L]; default 0
      real(wp) :: d(COMPONENTS, COMPONENTS), origin

      origin = 0.0_wp
      if (present(radius)) origin = radius
      k = 0.0_wp
      if (section%is_orthotropic) then
         call add_orthotropic_point(N, mean_strain_rows(x, origin, section%thickness, state), section%stiffness, k)
         call add_orthotropic_hourglass(x(:, :N), origin, section, state, k)
         call balance_axis(N, k)
         return
      end if
      d = elasticity_matrix(section, state)
      call add_point(N, mean_strain_rows(x, origin, section%thickness, state), d(1, 2), d(3, 3), k)
      call add_hourglass(x(:, :N), origin, section%thickness, state, d, k)
      call balance_axis(N, k)
   end subroutine reduced_ring_stiffness

   !> The work of the strains that the means do not feel; the depth is that of the middle.
   pure subroutine add_hourglass(x, origin, thickness, state, d, k)
      real(wp), intent(in) :: x(2, N), origin, thickness
      integer(ip), intent(in) :: state
      real(wp), intent(in) :: d(COMPONENTS, COMPONENTS) !< elasticity matrix [F/L^2]
      real(wp), intent(inout) :: k(N_DOFS, N_DOFS)
      real(wp) :: b(3, N_DOFS, N_POINTS), jacobian(N_POINTS), depth, stress(3), lambda, shear
      integer(ip) :: point, j

      call hourglass_strains(x, origin, state, spread(d(1, 2)/d(1, 1), 1, 4), b, jacobian)
      depth = depth_at(state, thickness, origin + 0.25_wp*sum(x(1, :)))
      lambda = d(1, 2)
      shear = d(3, 3)
      do point = 1, N_POINTS
         do j = 1, N_DOFS
            stress = (jacobian(point)*depth)*(lambda*sum(b(:, j, point)) + 2*shear*b(:, j, point))
            k(:j, j) = k(:j, j) + matmul(stress, b(:, :j, point))
         end do
      end do
   end subroutine add_hourglass

   !> The same of any elasticity C along the axes of the element: a strain along one of them, or round the circle, leaves the others
   !> without stress, m = c12/c11 and so on.
   pure subroutine add_orthotropic_hourglass(x, origin, section, state, k)
      real(wp), intent(in) :: x(2, N), origin
      type(elastic_t), intent(in) :: section
      integer(ip), intent(in) :: state
      real(wp), intent(inout) :: k(N_DOFS, N_DOFS)
      real(wp) :: b(3, N_DOFS, N_POINTS), jacobian(N_POINTS), axes(2, 2), c(4, 4), depth
      integer(ip) :: point, j

      axes = element_axes(x)
      c = turned_stiffness(section%stiffness, [axes(1, 1), -axes(2, 1)])
      call hourglass_strains(x, origin, state, [c(1, 2)/c(1, 1), c(1, 3)/c(1, 1), c(1, 2)/c(2, 2), c(2, 3)/c(2, 2)], b, jacobian)
      depth = depth_at(state, section%thickness, origin + 0.25_wp*sum(x(1, :)))
      do point = 1, N_POINTS
         do j = 1, N_DOFS
            k(:j, j) = k(:j, j) + (jacobian(point)*depth)*matmul(matmul(c(:3, :3), b(:, j, point)), b(:, :j, point))
         end do
      end do
   end subroutine add_orthotropic_hourglass

   !> e11, e22, e33 by the displacements of the nodes at 2 x 2 points.
   pure subroutine hourglass_strains(x, origin, state, m, b, jacobian)
      real(wp), intent(in) :: x(2, N), origin
      integer(ip), intent(in) :: state
      real(wp), intent(in) :: m(4)                 !< mu/(1 - mu): of e22 and e33 in e11, of e11 and e33 in e22 [-]
      real(wp), intent(out) :: b(3, N_DOFS, N_POINTS) !< [1/L]
      real(wp), intent(out) :: jacobian(N_POINTS)  !< [L^2]
      real(wp) :: relative(2, N), shape(N), axes(2, 2), t(N, 2), xi(2), weight, slope(2), j(2, 2)
      real(wp) :: e1(N_DOFS), e2(N_DOFS), t1(N_DOFS), t2(N_DOFS)
      integer(ip) :: point

      relative = x - spread(x(:, 1), 2, N)
      call hourglass_amplitude(relative, shape)
      axes = element_axes(relative)
      t = hoop_variation(x, origin, state)
      do point = 1, N_POINTS
         call rule_point(N, N_POINTS, point, xi, weight)
         ! The gradient of xi eta [1/L].
         j = matmul(relative, shape_gradients(N, xi))
         jacobian(point) = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
         slope = [j(2, 2)*xi(2) - j(2, 1)*xi(1), j(1, 1)*xi(1) - j(1, 2)*xi(2)]/jacobian(point)
         slope = matmul(slope, axes)
         e1 = reshape(spread(axes(:, 1), 2, N)*spread(shape, 1, 2), [N_DOFS])*slope(1)
         e2 = reshape(spread(axes(:, 2), 2, N)*spread(shape, 1, 2), [N_DOFS])*slope(2)
         t1 = 0.0_wp
         t2 = 0.0_wp
         t1(1::2) = t(:, 1)*xi(1)
         t2(1::2) = t(:, 2)*xi(2)
         b(1, :, point) = e1 - (m(1)*e2 + m(2)*t1)
         b(2, :, point) = e2 - (m(3)*e1 + m(4)*t2)
         b(3, :, point) = t1 + t2
      end do
   end subroutine hourglass_strains

   !> How the hoop strain varies along xi and eta, node by node: the linear part of u1/x1 at 2 x 2 points.
   pure function hoop_variation(x, origin, state) result(t)
      real(wp), intent(in) :: x(2, N), origin
      integer(ip), intent(in) :: state
      real(wp) :: t(N, 2)                          !< (node, direction) [1/L]
      type(strain_rows_t) :: rows
      real(wp) :: xi(2), weight
      integer(ip) :: point

      t = 0.0_wp
      do point = 1, N_POINTS
         call rule_point(N, N_POINTS, point, xi, weight)
         rows = strain_rows(x, origin, 1.0_wp, state, N_POINTS, point)
         t(:, 1) = t(:, 1) + rows%h(:N)*(xi(1)/SQUARES)
         t(:, 2) = t(:, 2) + rows%h(:N)*(xi(2)/SQUARES)
      end do
   end function hoop_variation

   !> Gradients of the shape functions and their hoop strains at n points from those of the stiffness, as spread_gradients does in
   !> the plane.
   pure subroutine spread_ring_strains(n_points, x, radius, state, gradient, hoop)
      integer(ip), intent(in) :: n_points          !< 1, 4 or 9
      real(wp), intent(in) :: x(:, :)              !< of the nodes, less the first [L]
      real(wp), intent(in) :: radius               !< of the first node [L]
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(inout) :: gradient(:, :, :) !< (points, 2, nodes) [1/L]
      real(wp), intent(inout) :: hoop(:, :)        !< (points, nodes) [1/L]
      type(strain_rows_t) :: rows
      real(wp) :: share
      integer(ip) :: i, k, m, nodes

      nodes = size(x, 2, kind=ip)
      m = BEST_OF(nodes)
      gradient(:n_points, :, :nodes) = 0.0_wp
      hoop(:n_points, :nodes) = 0.0_wp
      do k = 1, m
         if (m == 1) then
            rows = mean_strain_rows(x, radius, 1.0_wp, state)
         else
            rows = strain_rows(x, radius, 1.0_wp, state, m, k)
         end if
         do i = 1, n_points
            share = share_of_point(m, k, n_points, i)
            gradient(i, :, :nodes) = gradient(i, :, :nodes) + share*rows%g(:, :nodes)
            hoop(i, :nodes) = hoop(i, :nodes) + share*rows%h(:nodes)
         end do
      end do
   end subroutine spread_ring_strains

end module atrito_reduced_rings
