!> One element: stiffness, loads and stresses of an isoparametric quadrilateral.
module atrito_element
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_elasticity, only: elastic_t, elasticity_matrix, stress_33, von_mises
   use atrito_shape_functions, only: shape_values, shape_gradients, face_shape_values, face_shape_slopes, gauss_rule, &
                                     gauss_point, gauss_count
   implicit none (type, external)
   private
   public :: element_stiffness, pressure_load, body_load, element_stress

   !> Bits of the largest entry of a stiffness that are kept: four fewer than a double has, room for exact sums.
   integer, parameter :: KEPT_BITS = digits(1.0_wp) - 4

contains

   !> Stiffness [F/L] of an element, full Gauss integration.
   pure subroutine element_stiffness(x, section, state, k)
      real(wp), intent(in) :: x(:, :)              !< coordinates [L], (2, n)
      type(elastic_t), intent(in) :: section
      integer(ip), intent(in) :: state             !< PLANE_STRAIN or PLANE_STRESS
      real(wp), intent(out) :: k(:, :)             !< (2n, 2n)
      real(wp) :: b(3, size(k, 1)), d(3, 3), xi(2), weight, jacobian
      integer(ip) :: n, point

      n = size(x, 2, kind=ip)
      d = elasticity_matrix(section, state)
      k = 0.0_wp
      do point = 1, gauss_count(n)**2
         call gauss_point(n, point, xi, weight)
         call strain_matrix(x, xi, b, jacobian)
         k = k + matmul(transpose(b), matmul(d, b))*(weight*jacobian*section%thickness)
      end do
      k = 0.5_wp*(k + transpose(k))
      call balance_stiffness(k)
   end subroutine element_stiffness

   !> Makes the forces of a translation vanish to the last bit, K_aa = -sum_b K_ab for the 2 x 2 blocks of the nodes.
   !>
   !> Round-off alone leaves a translation a stiffness of some eps K; where elements move much more than they deform, and all
   !> have the same error, as equal elements have, that costs three digits of the answer. Off-diagonal blocks are rounded to a
   !> common grid, so that their sums are exact; the diagonal blocks come out symmetric because the antisymmetric parts of the
   !> others are made to cancel round each node.
   pure subroutine balance_stiffness(k)
      real(wp), intent(inout) :: k(:, :)           !< (2n, 2n), symmetric
      real(wp) :: spacing, defect
      integer(ip) :: n, a, b

      n = size(k, 1, kind=ip)/2
      spacing = set_exponent(1.0_wp, exponent(maxval(abs(k))) - KEPT_BITS)
      if (maxval(abs(k)) < 1.0_wp/huge(1.0_wp)/EPS_MACH) return
      k = anint(k/spacing)*spacing
      do a = 1, n - 1
         defect = 0.0_wp
         do b = 1, n
            if (b /= a) defect = defect + (k(2*a - 1, 2*b) - k(2*a, 2*b - 1))
         end do
         k(2*a - 1, 2*a + 2) = k(2*a - 1, 2*a + 2) - defect
         k(2*a + 2, 2*a - 1) = k(2*a - 1, 2*a + 2)
      end do
      do a = 1, n
         k(2*a - 1:2*a, 2*a - 1:2*a) = 0.0_wp
         do b = 1, n
            if (b /= a) k(2*a - 1:2*a, 2*a - 1:2*a) = k(2*a - 1:2*a, 2*a - 1:2*a) - k(2*a - 1:2*a, 2*b - 1:2*b)
         end do
      end do
   end subroutine balance_stiffness

   !> Strain = b * displacements at a place, and the Jacobian [L^2].
   pure subroutine strain_matrix(x, xi, b, jacobian)
      real(wp), intent(in) :: x(:, :), xi(2)
      real(wp), intent(out) :: b(:, :)             !< (3, 2n) [1/L]
      real(wp), intent(out) :: jacobian
      real(wp) :: dn(size(x, 2), 2), dx(size(x, 2), 2), j(2, 2), inverse(2, 2)
      integer(ip) :: n, i

      n = size(x, 2, kind=ip)
      dn = shape_gradients(n, xi)
      j = matmul(x, dn)
      jacobian = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
      inverse = reshape([j(2, 2), -j(2, 1), -j(1, 2), j(1, 1)], [2, 2])/jacobian
      dx = matmul(dn, inverse)
      b = 0.0_wp
      do i = 1, n
         b(1, 2*i - 1) = dx(i, 1)
         b(2, 2*i) = dx(i, 2)
         b(3, 2*i - 1) = dx(i, 2)
         b(3, 2*i) = dx(i, 1)
      end do
   end subroutine strain_matrix

   !> Nodal forces [F] of a pressure on a face; a positive pressure pushes on the element.
   pure subroutine pressure_load(x, pressure, thickness, f)
      real(wp), intent(in) :: x(:, :)              !< the face's nodes in the order of face_nodes [L], (2, 2 or 3)
      real(wp), intent(in) :: pressure             !< [F/L^2]
      real(wp), intent(in) :: thickness            !< [L]
      real(wp), intent(out) :: f(:, :)             !< shape of x
      real(wp) :: points(3), weights(3), n(size(x, 2)), tangent(2)
      integer(ip) :: i, order, n_face

      n_face = size(x, 2, kind=ip)
      order = n_face
      call gauss_rule(order, points(:order), weights(:order))
      f = 0.0_wp
      do i = 1, order
         n = face_shape_values(n_face, points(i))
         tangent = matmul(x, face_shape_slopes(n_face, points(i)))
         ! travelling counter-clockwise the inward normal is the tangent turned by +90 degrees
         f(1, :) = f(1, :) - n*tangent(2)*(weights(i)*pressure*thickness)
         f(2, :) = f(2, :) + n*tangent(1)*(weights(i)*pressure*thickness)
      end do
   end subroutine pressure_load

   !> Nodal forces [F] of a constant force per volume.
   pure subroutine body_load(x, density, thickness, f)
      real(wp), intent(in) :: x(:, :)              !< (2, n) [L]
      real(wp), intent(in) :: density(2)           !< [F/L^3]
      real(wp), intent(in) :: thickness            !< [L]
      real(wp), intent(out) :: f(:, :)             !< (2, n)
      real(wp) :: xi(2), weight, jacobian, b(3, 2*size(x, 2)), n(size(x, 2))
      integer(ip) :: point, n_nodes

      n_nodes = size(x, 2, kind=ip)
      f = 0.0_wp
      do point = 1, gauss_count(n_nodes)**2
         call gauss_point(n_nodes, point, xi, weight)
         call strain_matrix(x, xi, b, jacobian)
         n = shape_values(n_nodes, xi)*(weight*jacobian*thickness)
         f(1, :) = f(1, :) + n*density(1)
         f(2, :) = f(2, :) + n*density(2)
      end do
   end subroutine body_load

   !> Place [L] and stresses s11 s22 s33 s12 mises [F/L^2] at one Gauss point.
   pure subroutine element_stress(x, section, state, u, point, place, s)
      real(wp), intent(in) :: x(:, :)              !< (2, n) [L]
      type(elastic_t), intent(in) :: section
      integer(ip), intent(in) :: state
      real(wp), intent(in) :: u(:, :)              !< (2, n) [L]
      integer(ip), intent(in) :: point             !< 1 .. gauss_count**2
      real(wp), intent(out) :: place(2), s(5)
      real(wp) :: xi(2), weight, jacobian, b(3, 2*size(x, 2)), plane(3)
      integer(ip) :: n_nodes

      n_nodes = size(x, 2, kind=ip)
      call gauss_point(n_nodes, point, xi, weight)
      call strain_matrix(x, xi, b, jacobian)
      plane = matmul(elasticity_matrix(section, state), matmul(b, reshape(u, [2*n_nodes])))
      place = matmul(x, shape_values(n_nodes, xi))
      s(1:2) = plane(1:2)
      s(3) = stress_33(section, state, plane)
      s(4) = plane(3)
      s(5) = von_mises(plane, s(3))
   end subroutine element_stress

end module atrito_element
