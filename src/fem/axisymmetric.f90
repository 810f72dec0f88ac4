!> What an axisymmetric element has besides a plane one: the hoop strain u1/x1, and integrals over the circle 2 pi x1.
!>
!> x1 is the radius r, x2 the axis z. With B the strains [err, ezz, ett, 2 erz] of the nodes, g the gradients of their shape
!> functions N and h = N/r,
!>
!>     K = int B' D B 2 pi r dr dz,   err = g1 u1, ezz = g2 u2, ett = h u1, 2 erz = g2 u1 + g1 u2.
!>
!> Gauss points lie inside the element, never on the axis, so r > 0 there.
module atrito_axisymmetric
   use atrito_element_table, only: SHAPES, MOST_NODES, has_mean_dilatation, point_count
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_orthotropy, only: SPATIAL
   use atrito_plane_state, only: elastic_t, elasticity_matrix, COMPONENTS, depth_at
   use atrito_shape_functions, only: shape_values, shape_gradients, rule_point
   implicit none (type, external)
   private
   public :: axisymmetric_stiffness, mean_rows
   public :: strain_rows_t, strain_rows, mean_strain_rows, add_point, add_orthotropic_point, balance_axis

   !> Bits of the largest entry of a stiffness that are kept, as in atrito_element.
   integer, parameter :: KEPT_BITS = digits(1.0_wp) - 4
   integer(ip), parameter :: MOST_DOFS = 2*MOST_NODES

   !> The strains at a Gauss point by the displacements of the nodes.
   type :: strain_rows_t
      real(wp) :: g(2, MOST_NODES) = 0.0_wp        !< gradients of the shape functions [1/L]
      real(wp) :: h(MOST_NODES) = 0.0_wp           !< shape functions over the radius [1/L]
      real(wp) :: weight = 0.0_wp                  !< of the point: 2 pi r dr dz [L^3]
   end type strain_rows_t

contains

   !> Stiffness [F/L] of the full circle, full Gauss integration or eight nodes at 2 x 2 points; with FORMULATION=BBAR of the
   !> strains with the mean dilatation.
   !>
   !> D is lambda of the dilatation err + ezz + ett and 2 G of the strains. With the mean dilatation theta_m = sum m u the work is
   !> kappa V theta_m^2 and that of the deviator: lambda = -2/3 G of the dilatation itself, kappa = lambda + 2/3 G.
   pure subroutine axisymmetric_stiffness(x, section, state, k, radius)
      real(wp), intent(in) :: x(:, :)              !< coordinates [L], (2, n)
      type(elastic_t), intent(in) :: section       !< elastic constants, thickness and integration
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(out) :: k(:, :)             !< (2n, 2n)
      real(wp), intent(in), optional :: radius     !< of the origin of x [L]; default 0
      type(strain_rows_t) :: rows
      real(wp) :: d(COMPONENTS, COMPONENTS), lambda, shear, origin, mean(2, size(x, 2)), volume
      integer(ip) :: n, point
      logical :: averages

      n = size(x, 2, kind=ip)
      origin = 0.0_wp
      if (present(radius)) origin = radius
      d = elasticity_matrix(section, state)
      shear = d(3, 3)
      averages = has_mean_dilatation(section, state, n)
      lambda = merge(-2*shear/3, d(1, 2), averages)
      k = 0.0_wp
      do point = 1, point_count(n, state)
         rows = strain_rows(x, origin, section%thickness, state, point_count(n, state), point)
         if (section%is_orthotropic) then
            call add_orthotropic_point(n, rows, section%stiffness, k)
         else
            call add_point(n, rows, lambda, shear, k)
         end if
      end do
      if (averages) then
         call mean_rows(x, origin, section%thickness, state, mean, volume)
         call add_mean(n, mean, (d(1, 2) + 2*shear/3)*volume, k)
      end if
      call balance_axis(n, k)
   end subroutine axisymmetric_stiffness

   !> Strains at a point of the rule of n_points.
   pure function strain_rows(x, origin, thickness, state, n_points, point) result(rows)
      real(wp), intent(in) :: x(:, :)                   !< (2, n) coordinates [L]
      real(wp), intent(in) :: origin                    !< radius of the origin of x [L]
      real(wp), intent(in) :: thickness                 !< of the section, 1 of rings [L]
      integer(ip), intent(in) :: state, n_points, point !< place in STATES; points of the rule; which of them
      type(strain_rows_t) :: rows
      real(wp) :: xi(2), weight, n(size(x, 2)), slopes(size(x, 2), 2), j(2, 2), jacobian, r, relative(2, size(x, 2))
      integer(ip) :: n_nodes, i

      n_nodes = size(x, 2, kind=ip)
      do i = 1, n_nodes                            ! a distance from the origin along the axis costs no digits
         relative(:, i) = x(:, i) - x(:, 1)
      end do
      call rule_point(n_nodes, n_points, point, xi, weight)
      n = shape_values(n_nodes, xi)
      slopes = shape_gradients(n_nodes, xi)
      j = matmul(relative, slopes)
      jacobian = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
      r = origin + x(1, 1) + dot_product(n, relative(1, :))
      rows%g(1, :n_nodes) = (j(2, 2)*slopes(:, 1) - j(2, 1)*slopes(:, 2))/jacobian
      rows%g(2, :n_nodes) = (j(1, 1)*slopes(:, 2) - j(1, 2)*slopes(:, 1))/jacobian
      rows%h(:n_nodes) = n/r
      rows%weight = weight*jacobian*depth_at(state, thickness, r)
   end function strain_rows

   !> Adds what a Gauss point gives to the upper triangle.
   !>
   !> With lambda and G times the weight of the point, and theta_a = g1_a + h_a, which u1 of node a adds to the dilatation:
   !>
   !>     (u1, u1)   lambda theta_a theta_b + G (2 g1_a g1_b + 2 h_a h_b + g2_a g2_b)
   !>     (u2, u1)   lambda g2_a theta_b    + G g1_a g2_b
   !>     (u1, u2)   lambda theta_a g2_b    + G g2_a g1_b
   !>     (u2, u2)   lambda g2_a g2_b       + G (2 g2_a g2_b + g1_a g1_b)
   !>
   !> from the work lambda theta^2 + 2 G (err^2 + ezz^2 + ett^2) + G (2 erz)^2. A motion along the axis, u2 the same at all nodes,
   !> has no strain, since the g2 add up to zero; u1 the same at all nodes has the hoop strain, so a ring has that one rigid motion
   !> alone.
   pure subroutine add_point(n, rows, lambda, shear, k)
      integer(ip), intent(in) :: n                 !< nodes
      type(strain_rows_t), intent(in) :: rows      !< strains at the point, and its weight
      real(wp), intent(in) :: lambda, shear        !< [F/L^2]
      real(wp), intent(inout) :: k(2*n, 2*n)       !< upper triangle, is added to [F/L]
      real(wp) :: bulk, stiff, g1, g2, h, theta
      integer(ip) :: a, b

      bulk = lambda*rows%weight
      stiff = shear*rows%weight
      do b = 1, n
         g1 = rows%g(1, b)
         g2 = rows%g(2, b)
         h = rows%h(b)
         theta = g1 + h
         do a = 1, b
            associate (ga => rows%g(:, a), ha => rows%h(a))
               k(2*a - 1, 2*b - 1) = k(2*a - 1, 2*b - 1) + bulk*((ga(1) + ha)*theta) &
                                     + stiff*(2*(ga(1)*g1 + ha*h) + ga(2)*g2)
               k(2*a, 2*b - 1) = k(2*a, 2*b - 1) + bulk*(ga(2)*theta) + stiff*(ga(1)*g2)
               k(2*a - 1, 2*b) = k(2*a - 1, 2*b) + bulk*((ga(1) + ha)*g2) + stiff*(ga(2)*g1)
               k(2*a, 2*b) = k(2*a, 2*b) + bulk*(ga(2)*g2) + stiff*(2*ga(2)*g2 + ga(1)*g1)
            end associate
         end do
      end do
   end subroutine add_point

   !> The same of any elasticity: B of a node has the rows [g1, 0], [0, g2], [h, 0], [g2, g1] of the components 11, 22, 33, 12.
   pure subroutine add_orthotropic_point(n, rows, c, k)
      integer(ip), intent(in) :: n                 !< nodes
      type(strain_rows_t), intent(in) :: rows      !< strains at the point, and its weight
      real(wp), intent(in) :: c(SPATIAL, SPATIAL)  !< [F/L^2]
      real(wp), intent(inout) :: k(2*n, 2*n)       !< upper triangle, is added to [F/L]
      real(wp) :: b(SPATIAL, 2*n)
      integer(ip) :: j

      b = 0.0_wp
      do j = 1, n
         b(1, 2*j - 1) = rows%g(1, j)
         b(3, 2*j - 1) = rows%h(j)
         b(4, 2*j - 1) = rows%g(2, j)
         b(2, 2*j) = rows%g(2, j)
         b(4, 2*j) = rows%g(1, j)
      end do
      do j = 1, 2*n
         k(:j, j) = k(:j, j) + matmul(rows%weight*matmul(c, b(:, j)), b(:, :j))
      end do
   end subroutine add_orthotropic_point

   !> Means over the volume of the element of the dilatation, node by node: theta_m = sum(mean*u) [1/L].
   pure subroutine mean_rows(x, origin, thickness, state, mean, volume)
      real(wp), intent(in) :: x(:, :)              !< coordinates [L], (2, n)
      real(wp), intent(in) :: origin               !< radius of the origin of x [L]
      real(wp), intent(in) :: thickness            !< of the section
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(out) :: mean(:, :)          !< (2, n)
      real(wp), intent(out) :: volume              !< [L^3]
      type(strain_rows_t) :: rows
      integer(ip) :: point, n

      n = size(x, 2, kind=ip)
      mean = 0.0_wp
      volume = 0.0_wp
      do point = 1, SHAPES(n)%n_points
         rows = strain_rows(x, origin, thickness, state, SHAPES(n)%n_points, point)
         mean(1, :) = mean(1, :) + rows%weight*(rows%g(1, :n) + rows%h(:n))
         mean(2, :) = mean(2, :) + rows%weight*rows%g(2, :n)
         volume = volume + rows%weight
      end do
      mean = mean/volume
   end subroutine mean_rows

   !> The means of all strains over the volume of an element, whose weight is the volume.
   pure function mean_strain_rows(x, origin, thickness, state) result(mean)
      real(wp), intent(in) :: x(:, :)   !< (2, n) coordinates [L]
      real(wp), intent(in) :: origin    !< radius of the origin of x [L]
      real(wp), intent(in) :: thickness !< of the section, 1 of rings [L]
      integer(ip), intent(in) :: state  !< place in STATES
      type(strain_rows_t) :: mean, rows
      integer(ip) :: point, n

      n = size(x, 2, kind=ip)
      do point = 1, SHAPES(n)%n_points
         rows = strain_rows(x, origin, thickness, state, SHAPES(n)%n_points, point)
         mean%g = mean%g + rows%weight*rows%g
         mean%h = mean%h + rows%weight*rows%h
         mean%weight = mean%weight + rows%weight
      end do
      mean%g = mean%g/mean%weight
      mean%h = mean%h/mean%weight
   end function mean_strain_rows

   !> The work of the mean dilatation.
   pure subroutine add_mean(n, mean, bulk, k)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: mean(2*n)
      real(wp), intent(in) :: bulk                 !< kappa V [F L]
      real(wp), intent(inout) :: k(2*n, 2*n)
      integer(ip) :: b

      do b = 1, 2*n
         k(:b, b) = k(:b, b) + mean(:b)*(bulk*mean(b))
      end do
   end subroutine add_mean

   !> Makes the forces of a translation along the axis vanish to the last bit and mirrors the upper triangle. In each row the
   !> entries of axial dofs are rounded to a grid on which sums are exact, and the one of the row's own node follows from the
   !> others; it is no entry of another row but by symmetry, so nothing contradicts.
   pure subroutine balance_axis(n, k)
      integer(ip), intent(in) :: n           !< nodes
      real(wp), intent(inout) :: k(2*n, 2*n) !< upper triangle on entry, both on return [F/L]
      real(wp) :: shift, largest
      integer(ip) :: i, a, b

      largest = 0.0_wp
      do i = 1, 2*n
         largest = max(largest, k(i, i))
      end do
      shift = 0.0_wp
      if (largest >= 1.0_wp/huge(1.0_wp)/EPS_MACH) then
         shift = 1.5_wp/EPS_MACH*set_exponent(1.0_wp, exponent(largest) - KEPT_BITS)
      end if
      do b = 2, n
         do a = 1, b - 1
            k(2*a, 2*b - 1) = (k(2*a, 2*b - 1) + shift) - shift
            k(2*a - 1, 2*b) = (k(2*a - 1, 2*b) + shift) - shift
            k(2*a, 2*b) = (k(2*a, 2*b) + shift) - shift
         end do
      end do
      do i = 1, 2*n
         k(i + 1:, i) = k(i, i + 1:)
      end do
      do a = 1, n
         do i = 2*a - 1, 2*a
            k(i, 2*a) = 0.0_wp
            k(i, 2*a) = -sum(k(i, 2:2*n:2))
         end do
         k(2*a, 2*a - 1) = k(2*a - 1, 2*a)
      end do
   end subroutine balance_axis

end module atrito_axisymmetric
