!> One element: stiffness and loads of an isoparametric quadrilateral.
!>
!> Coordinates are taken relative to the element's first node: the derivatives of the shape functions add up to zero only but for
!> round-off, which far from the origin would cost digits.
module atrito_element
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_elasticity, only: elastic_t, elasticity_matrix, has_mean_dilatation
   use atrito_mesh, only: Q1_NODES
   use atrito_shape_functions, only: shape_values, shape_gradients, face_shape_values, face_shape_slopes, gauss_rule, &
                                     gauss_point, gauss_count
   implicit none (type, external)
   private
   public :: element_stiffness, mean_gradients, pressure_load, body_load

   !> Bits of the largest entry of a stiffness that are kept: four fewer than a double has, room for exact sums.
   integer, parameter :: KEPT_BITS = digits(1.0_wp) - 4

contains

   !> Stiffness [F/L] of an element, full Gauss integration; with FORMULATION=BBAR of the strains with the mean dilatation.
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
         if (has_mean_dilatation(section, state, n)) call average_dilatation(x, b)
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
      j = matmul(from_first(x), dn)
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

   !> Coordinates less those of the first node [L].
   pure function from_first(x) result(relative)
      real(wp), intent(in) :: x(:, :)              !< (2, n) [L]
      real(wp) :: relative(2, size(x, 2))

      relative(1, :) = x(1, :) - x(1, 1)
      relative(2, :) = x(2, :) - x(2, 1)
   end function from_first

   !> Replaces the dilatation of the strains at a place by the mean of the element, half of it in either direction (T. J. R.
   !> Hughes, Int. J. Numer. Methods Eng. 15, 1980, for the plane: e33 stays 0, and s33 = mu (s11 + s22)).
   pure subroutine average_dilatation(x, b)
      real(wp), intent(in) :: x(:, :)              !< (2, Q1_NODES) [L]
      real(wp), intent(inout) :: b(:, :)           !< (3, 2 Q1_NODES) [1/L]
      real(wp) :: shift(2*Q1_NODES)

      shift = 0.5_wp*(reshape(mean_gradients(x), [2*Q1_NODES]) - (b(1, :) + b(2, :)))
      b(1, :) = b(1, :) + shift
      b(2, :) = b(2, :) + shift
   end subroutine average_dilatation

   !> Means over an element of four nodes of the derivatives of its shape functions [1/L], by Gauss' theorem: the integral of
   !> dN_a/dx1 is half the height of the diagonal from the node before a to the node behind it. sum(mean_gradients*u) is the mean
   !> dilatation.
   pure function mean_gradients(x) result(g)
      real(wp), intent(in) :: x(:, :)              !< (2, Q1_NODES) [L]
      real(wp) :: g(2, Q1_NODES)
      real(wp) :: d(2), e(2), twice_area

      d = x(:, 3) - x(:, 1)
      e = x(:, 4) - x(:, 2)
      twice_area = d(1)*e(2) - d(2)*e(1)
      g(:, 1) = [-e(2), e(1)]/twice_area
      g(:, 2) = [d(2), -d(1)]/twice_area
      g(:, 3) = -g(:, 1)
      g(:, 4) = -g(:, 2)
   end function mean_gradients

   !> Nodal forces [F] of a pressure on a face; a positive pressure pushes on the element.
   pure subroutine pressure_load(x, pressure, thickness, f)
      real(wp), intent(in) :: x(:, :)              !< the face's nodes in the order of face_nodes [L], (2, 2 or 3)
      real(wp), intent(in) :: pressure             !< [F/L^2]
      real(wp), intent(in) :: thickness            !< [L]
      real(wp), intent(out) :: f(:, :)             !< shape of x
      real(wp) :: points(3), weights(3), n(size(x, 2)), tangent(2), relative(2, size(x, 2))
      integer(ip) :: i, order, n_face

      n_face = size(x, 2, kind=ip)
      order = n_face
      relative = from_first(x)
      call gauss_rule(order, points(:order), weights(:order))
      f = 0.0_wp
      do i = 1, order
         n = face_shape_values(n_face, points(i))
         tangent = matmul(relative, face_shape_slopes(n_face, points(i)))
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

end module atrito_element
