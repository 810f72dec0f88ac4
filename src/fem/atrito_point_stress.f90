!> Stresses at given points of many elements, fast: shape functions are evaluated once for each kind of element, and the
!> innermost loops run over the points of an element.
module atrito_point_stress
   use atrito_assembly, only: fem_t
   use atrito_elasticity, only: elasticity_matrix, has_mean_dilatation
   use atrito_element, only: mean_gradients
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: Q1_NODES, Q2_NODES
   use atrito_shape_functions, only: shape_values, shape_gradients, gauss_rule
   implicit none (type, external)
   private
   public :: point_rule_t, element_data_t, point_values_t, MOST_POINTS, make_point_rule, fetch_element, point_stresses

   integer(ip), parameter :: MOST_POINTS = 9

   !> A Gauss rule with the shape functions of one kind of element.
   type :: point_rule_t
      integer(ip) :: n = 0
      real(wp) :: weight(MOST_POINTS) = 0.0_wp
      real(wp) :: value(MOST_POINTS, Q2_NODES) = 0.0_wp       !< shape functions at each point
      real(wp) :: slope(MOST_POINTS, 2, Q2_NODES) = 0.0_wp    !< their derivatives along xi and eta
   end type point_rule_t

   !> What the points of an element share. Coordinates and displacements are relative to its first node, so that neither the
   !> place of the origin nor a rigid translation costs digits.
   type :: element_data_t
      integer(ip) :: n                           !< nodes
      real(wp) :: x(2, Q2_NODES), u(2, Q2_NODES) !< [L]
      real(wp) :: d(3, 3)                        !< elasticity matrix [F/L^2]
      logical :: averages                        !< the dilatation is the same everywhere in the element: FORMULATION=BBAR
      real(wp) :: dilatation                     !< which
   end type element_data_t

   !> What the points of a rule have in an element.
   type :: point_values_t
      real(wp) :: x(MOST_POINTS, 2)              !< place less the element's first node [L]
      real(wp) :: s(MOST_POINTS, 3)              !< s11, s22, s12 [F/L^2]
      real(wp) :: jacobian(MOST_POINTS)          !< [L^2]
      real(wp) :: steepness(MOST_POINTS)         !< sum of the squares of dxi/dx [1/L^2]
   end type point_values_t

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
            rule%value(rule%n, :n_nodes) = shape_values(n_nodes, xi)
            rule%slope(rule%n, :, :n_nodes) = transpose(shape_gradients(n_nodes, xi))
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
      associate (section => fem%sections(fem%section_of(e)), state => fem%mesh%state(e))
         data%d = elasticity_matrix(section, state)
         data%averages = has_mean_dilatation(section, state, data%n)
      end associate
      data%dilatation = 0.0_wp
      if (data%averages) data%dilatation = sum(mean_gradients(data%x(:, :Q1_NODES))*data%u(:, :Q1_NODES))
   end subroutine fetch_element

   !> Places, stresses and Jacobians at the points of a rule.
   pure subroutine point_stresses(data, rule, at)
      type(element_data_t), intent(in) :: data
      type(point_rule_t), intent(in) :: rule
      type(point_values_t), intent(out) :: at    !< the first rule%n of each
      real(wp), dimension(MOST_POINTS, 2) :: dx, dy, du, dv  !< derivatives along xi and eta
      real(wp) :: h11, h12, h21, h22, e11, e22, e12, shift
      integer(ip) :: k, i, direction

      at%x(:rule%n, :) = 0.0_wp
      do direction = 1, 2
         dx(:rule%n, direction) = 0.0_wp
         dy(:rule%n, direction) = 0.0_wp
         du(:rule%n, direction) = 0.0_wp
         dv(:rule%n, direction) = 0.0_wp
         do k = 2, data%n                        ! the first node is the origin of all
            do i = 1, rule%n
               dx(i, direction) = dx(i, direction) + data%x(1, k)*rule%slope(i, direction, k)
               dy(i, direction) = dy(i, direction) + data%x(2, k)*rule%slope(i, direction, k)
               du(i, direction) = du(i, direction) + data%u(1, k)*rule%slope(i, direction, k)
               dv(i, direction) = dv(i, direction) + data%u(2, k)*rule%slope(i, direction, k)
               at%x(i, direction) = at%x(i, direction) + data%x(direction, k)*rule%value(i, k)
            end do
         end do
      end do
      do i = 1, rule%n
         at%jacobian(i) = dx(i, 1)*dy(i, 2) - dx(i, 2)*dy(i, 1)
         h11 = dy(i, 2)/at%jacobian(i)           ! h = d(xi, eta)/d(x, y)
         h12 = -dx(i, 2)/at%jacobian(i)
         h21 = -dy(i, 1)/at%jacobian(i)
         h22 = dx(i, 1)/at%jacobian(i)
         at%steepness(i) = h11**2 + h12**2 + h21**2 + h22**2
         e11 = du(i, 1)*h11 + du(i, 2)*h21
         e22 = dv(i, 1)*h12 + dv(i, 2)*h22
         e12 = du(i, 1)*h12 + du(i, 2)*h22 + dv(i, 1)*h11 + dv(i, 2)*h21
         if (data%averages) then
            shift = 0.5_wp*(data%dilatation - (e11 + e22))
            e11 = e11 + shift
            e22 = e22 + shift
         end if
         at%s(i, 1) = data%d(1, 1)*e11 + data%d(1, 2)*e22
         at%s(i, 2) = data%d(1, 2)*e11 + data%d(2, 2)*e22
         at%s(i, 3) = data%d(3, 3)*e12
      end do
   end subroutine point_stresses

end module atrito_point_stress
