!> Stresses at given points of many elements, fast: shape functions are evaluated once for each kind of element.
module atrito_point_stress
   use atrito_assembly, only: fem_t
   use atrito_elasticity, only: elasticity_matrix
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: Q2_NODES
   use atrito_shape_functions, only: shape_values, shape_gradients, gauss_rule
   implicit none (type, external)
   private
   public :: point_rule_t, element_data_t, MOST_POINTS, make_point_rule, fetch_element, point_stress

   integer(ip), parameter :: MOST_POINTS = 9

   !> A Gauss rule with the shape functions of one kind of element.
   type :: point_rule_t
      integer(ip) :: n = 0
      real(wp) :: weight(MOST_POINTS) = 0.0_wp
      real(wp) :: value(Q2_NODES, MOST_POINTS) = 0.0_wp       !< shape functions at each point
      real(wp) :: slope(2, Q2_NODES, MOST_POINTS) = 0.0_wp    !< their derivatives along xi and eta
   end type point_rule_t

   !> What the points of an element share. Coordinates and displacements are relative to its first node, so that neither the
   !> place of the origin nor a rigid translation costs digits.
   type :: element_data_t
      integer(ip) :: n                           !< nodes
      real(wp) :: x(2, Q2_NODES), u(2, Q2_NODES) !< [L]
      real(wp) :: d(3, 3)                        !< elasticity matrix [F/L^2]
   end type element_data_t

contains

   !> The rule of order x order points; 1 is the centre.
   pure subroutine make_point_rule(n_nodes, order, rule)
      integer(ip), intent(in) :: n_nodes         !< Q1_NODES or Q2_NODES
      integer(ip), intent(in) :: order           !< 1, 2 or 3
      type(point_rule_t), intent(out) :: rule
      real(wp) :: points(3), weights(3), xi(2)
      integer(ip) :: i, j

      points = 0.0_wp
      weights = 2.0_wp
      if (order > 1) call gauss_rule(order, points(:order), weights(:order))
      do j = 1, order
         do i = 1, order
            rule%n = rule%n + 1
            xi = [points(i), points(j)]
            rule%weight(rule%n) = weights(i)*weights(j)
            rule%value(:n_nodes, rule%n) = shape_values(n_nodes, xi)
            rule%slope(:, :n_nodes, rule%n) = transpose(shape_gradients(n_nodes, xi))
         end do
      end do
   end subroutine make_point_rule

   pure subroutine fetch_element(fem, e, u, data)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: u(:, :)            !< (2, n_nodes) [L]
      type(element_data_t), intent(out) :: data
      integer(ip) :: k, node, first

      data%n = fem%mesh%shape(e)
      first = fem%mesh%nodes(1, e)
      do k = 1, data%n
         node = fem%mesh%nodes(k, e)
         data%x(:, k) = fem%mesh%x(:, node) - fem%mesh%x(:, first)
         data%u(:, k) = u(:, node) - u(:, first)
      end do
      data%d = elasticity_matrix(fem%sections(fem%section_of(e)), fem%mesh%state(e))
   end subroutine fetch_element

   !> Stresses s11, s22, s12 [F/L^2] at a point of the rule, and the inverse of the Jacobian's matrix [1/L] with its area factor.
   pure subroutine point_stress(data, rule, point, s, inverse, jacobian)
      type(element_data_t), intent(in) :: data
      type(point_rule_t), intent(in) :: rule
      integer(ip), intent(in) :: point
      real(wp), intent(out) :: s(3)
      real(wp), intent(out) :: inverse(2, 2)
      real(wp), intent(out) :: jacobian          !< [L^2]
      real(wp) :: j(2, 2), h(2, 2), g(2, 2), strain(3)
      integer(ip) :: k

      j = 0.0_wp
      h = 0.0_wp
      do k = 2, data%n
         j(:, 1) = j(:, 1) + data%x(:, k)*rule%slope(1, k, point)
         j(:, 2) = j(:, 2) + data%x(:, k)*rule%slope(2, k, point)
         h(:, 1) = h(:, 1) + data%u(:, k)*rule%slope(1, k, point)
         h(:, 2) = h(:, 2) + data%u(:, k)*rule%slope(2, k, point)
      end do
      jacobian = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
      inverse(:, 1) = [j(2, 2), -j(2, 1)]/jacobian
      inverse(:, 2) = [-j(1, 2), j(1, 1)]/jacobian
      g(:, 1) = h(:, 1)*inverse(1, 1) + h(:, 2)*inverse(2, 1)
      g(:, 2) = h(:, 1)*inverse(1, 2) + h(:, 2)*inverse(2, 2)
      strain = [g(1, 1), g(2, 2), g(1, 2) + g(2, 1)]
      s(1) = data%d(1, 1)*strain(1) + data%d(1, 2)*strain(2)
      s(2) = data%d(1, 2)*strain(1) + data%d(2, 2)*strain(2)
      s(3) = data%d(3, 3)*strain(3)
   end subroutine point_stress

end module atrito_point_stress
