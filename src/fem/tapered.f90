!> Plane elements whose thickness is that of their nodes: h = sum of N_a h_a stands behind a point, with the shape functions N of
!> the element, so that
!>
!>     K = int B' D B h dA,     V = int h dA.
module atrito_tapered
   use atrito_element_table, only: SHAPES, MOST_NODES
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_mesh, only: mesh_t
   use atrito_shape_functions, only: shape_values, shape_gradients, rule_point
   implicit none (type, external)
   private
   public :: tapered_means, has_thickness

contains

   !> Means over the volume of the gradients of the shape functions: theta_m = sum(mean*u) [1/L].
   !>
   !>     m_a = (1/V) int h grad N_a dA,     V = int h dA
   !>
   !> det(J) grad N_a is a polynomial, and so is h times it: the rule of the stiffness has both integrals exactly. With h = 1 four
   !> nodes have the means of mean_gradients.
   pure subroutine tapered_means(x, thickness, mean, volume)
      real(wp), intent(in) :: x(:, :)              !< (2, n) less those of the first node [L]
      real(wp), intent(in) :: thickness(:)         !< of the nodes [L]
      real(wp), intent(out) :: mean(2, size(x, 2)) !< of the gradients [1/L]
      real(wp), intent(out) :: volume              !< [L^3]
      real(wp) :: slopes(size(x, 2), 2), j(2, 2), xi(2), weight, depth
      integer(ip) :: point, n

      n = size(x, 2, kind=ip)
      mean = 0.0_wp
      volume = 0.0_wp
      do point = 1, SHAPES(n)%n_points
         call rule_point(n, SHAPES(n)%n_points, point, xi, weight)
         slopes = shape_gradients(n, xi)
         j = matmul(x, slopes)
         depth = weight*dot_product(shape_values(n, xi), thickness)
         mean(1, :) = mean(1, :) + depth*(j(2, 2)*slopes(:, 1) - j(2, 1)*slopes(:, 2))
         mean(2, :) = mean(2, :) + depth*(j(1, 1)*slopes(:, 2) - j(1, 2)*slopes(:, 1))
         volume = volume + depth*(j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1))
      end do
      mean = mean/volume
   end subroutine tapered_means

   !> Whether the nodes of an element have the thickness of those of another one, within rounding.
   pure logical function has_thickness(mesh, element, thickness) result(alike)
      type(mesh_t), intent(in) :: mesh              !< with thicknesses of its nodes
      integer(ip), intent(in) :: element            !< place in the mesh
      real(wp), intent(in) :: thickness(MOST_NODES) !< of the other one [L]
      integer(ip) :: n

      n = mesh%shape(element)
      alike = all(abs(mesh%thickness(mesh%nodes(:n, element)) - thickness(:n)) <= 2*EPS_MACH*thickness(:n))
   end function has_thickness

end module atrito_tapered
