!> Elements whose stiffness is integrated at fewer points: eight nodes at 2 x 2, four nodes in the middle alone.
!>
!> In the middle four nodes feel nothing of u ~ xi eta, the hourglass. Its strains are those that bending has (T. Belytschko and
!> L. P. Bindeman, Comput. Methods Appl. Mech. Eng. 88, 1991, quintessential bending and incompressibility): along the
!> axes 1', 2' of the element, with h = xi eta and q the amplitude of the hourglass,
!>
!>     e11 = h,1 q1 - m h,2 q2,   e22 = h,2 q2 - m h,1 q1,   2 e12 = 0,   m = mu (thin), mu/(1 - mu) (else)
!>
!> so that s11 = E' h,1 q1 and s22 = E' h,2 q2, E' the modulus of a strip: nothing shears in bending, and nothing changes its volume
!> at mu = 1/2. No parameter is left to choose.
module atrito_reduced_integration
   use atrito_element_table, only: BEST_OF, MOST_NODES
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: elastic_t, compliance_matrix, COMPONENTS
   use atrito_shape_functions, only: rule_point, shape_values, shape_gradients, Q1_XI_SLOPES, Q1_ETA_SLOPES
   implicit none (type, external)
   private
   public :: hourglass_stiffness, spread_gradients, spread_values, share_of_point, hourglass_amplitude, element_axes

   !> xi eta at four nodes, and its derivatives at 2 x 2 points in the order of Q1_XI_SLOPES.
   real(wp), parameter :: HOURGLASS(4) = [1.0_wp, -1.0_wp, 1.0_wp, -1.0_wp]

contains

   !> K_ab = shape(a) shape(b) amount for the 2 x 2 blocks of nodes a, b.
   !>
   !> From the strains at the head of this module: s11 = E' h,1 q1 and s22 = E' h,2 q2 work on e11 and e22, so that
   !>
   !>     s11 e11 + s22 e22 = E' (h,1^2 q1^2 - 2 m h,1 h,2 q1 q2 + h,2^2 q2^2),     E' = 1/c11,   m = -c12/c11
   !>
   !> with the compliance c of the plane state. Integrated over the element that is q'[ h11 -m h12 ; -m h12 h22 ] q E' t; turned
   !> from the axes of the element to x1, x2 it is `amount`. The four points that h_ij are summed over see xi eta, which the middle
   !> does not.
   pure subroutine hourglass_stiffness(x, section, state, shape, amount)
      real(wp), intent(in) :: x(2, 4)              !< less those of the first node [L]
      type(elastic_t), intent(in) :: section       !< elastic constants and thickness
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(out) :: shape(4)            !< the hourglass less what of it is a linear field: q = sum of shape u
      real(wp), intent(out) :: amount(2, 2)        !< [F/L]
      real(wp) :: axes(2, 2), h(2, 2), c(COMPONENTS, COMPONENTS), ratio

      call hourglass_amplitude(x, shape)
      axes = element_axes(x)
      h = matmul(transpose(axes), matmul(products_of_slopes(x), axes))
      c = compliance_matrix(section, state)
      if (section%is_orthotropic) then
         amount = section%thickness*matmul(axes, matmul(orthotropic_amount(h, c, axes), transpose(axes)))
         return
      end if
      ratio = -c(1, 2)/c(1, 1)
      amount = h
      amount(1, 2) = -ratio*h(1, 2)
      amount(2, 1) = amount(1, 2)
      amount = (section%thickness/c(1, 1))*matmul(axes, matmul(amount, transpose(axes)))
   end subroutine hourglass_stiffness

   !> The same along the axes of the element where they are not those of the material: stresses s11 = h,1 q1/c11, s22 = h,2 q2/c22
   !> alone have the energy h11 q1^2/c11 + 2 h12 q1 q2 c12/(c11 c22) + h22 q2^2/c22, with the compliance along those axes.
   pure function orthotropic_amount(h, c, axes) result(amount)
      real(wp), intent(in) :: h(2, 2)              !< integrals of h,i h,j along the axes
      real(wp), intent(in) :: c(COMPONENTS, COMPONENTS) !< compliance along x1, x2 [L^2/F]
      real(wp), intent(in) :: axes(2, 2)
      real(wp) :: amount(2, 2)
      real(wp) :: unit(COMPONENTS, 2), along(2, 2)
      integer(ip) :: i

      do i = 1, 2                                  ! a stress of 1 along the axis
         unit(:, i) = [axes(1, i)**2, axes(2, i)**2, axes(1, i)*axes(2, i)]
      end do
      along = matmul(transpose(unit), matmul(c, unit))
      amount(1, 1) = h(1, 1)/along(1, 1)
      amount(2, 2) = h(2, 2)/along(2, 2)
      amount(1, 2) = h(1, 2)*along(1, 2)/(along(1, 1)*along(2, 2))
      amount(2, 1) = amount(1, 2)
   end function orthotropic_amount

   !> (h - (h.x1) b1 - (h.x2) b2)/4, b the gradients in the middle.
   pure subroutine hourglass_amplitude(x, shape)
      real(wp), intent(in) :: x(2, 4)   !< coordinates [L]; the origin does not matter
      real(wp), intent(out) :: shape(4) !< q = sum of shape u
      real(wp) :: d(2), e(2), b(2, 4), of_x(2)

      d = x(:, 3) - x(:, 1)
      e = x(:, 4) - x(:, 2)
      b(:, 1) = [-e(2), e(1)]/(d(1)*e(2) - d(2)*e(1))
      b(:, 2) = [d(2), -d(1)]/(d(1)*e(2) - d(2)*e(1))
      b(:, 3) = -b(:, 1)
      b(:, 4) = -b(:, 2)
      of_x = matmul(x, HOURGLASS)
      shape = 0.25_wp*(HOURGLASS - of_x(1)*b(1, :) - of_x(2)*b(2, :))
   end subroutine hourglass_amplitude

   !> Orthogonal axes that turn with the element and do not depend on which node is the first: as far from the direction of xi on
   !> one side as from that of eta on the other.
   pure function element_axes(x) result(axes)
      real(wp), intent(in) :: x(2, 4)              !< coordinates [L]; the origin does not matter
      real(wp) :: axes(2, 2)                       !< (component, axis)
      real(wp) :: along_xi(2), along_eta(2)

      along_xi = x(:, 2) + x(:, 3) - x(:, 1) - x(:, 4)
      along_eta = x(:, 3) + x(:, 4) - x(:, 1) - x(:, 2)
      along_xi = along_xi/norm2(along_xi)
      along_eta = along_eta/norm2(along_eta)
      axes(:, 1) = along_xi + [along_eta(2), -along_eta(1)]
      axes(:, 1) = axes(:, 1)/norm2(axes(:, 1))
      axes(:, 2) = [-axes(2, 1), axes(1, 1)]
   end function element_axes

   !> The integrals of h,i h,j by 2 x 2 points.
   pure function products_of_slopes(x) result(h)
      real(wp), intent(in) :: x(2, 4)
      real(wp) :: h(2, 2)
      real(wp) :: along_xi(2), along_eta(2), slopes(2), g(2), jacobian
      integer(ip) :: i

      h = 0.0_wp
      do i = 1, 4
         along_xi = matmul(x, Q1_XI_SLOPES(:, i))
         along_eta = matmul(x, Q1_ETA_SLOPES(:, i))
         jacobian = along_xi(1)*along_eta(2) - along_eta(1)*along_xi(2)
         slopes = [dot_product(HOURGLASS, Q1_XI_SLOPES(:, i)), dot_product(HOURGLASS, Q1_ETA_SLOPES(:, i))]
         g = [along_eta(2)*slopes(1) - along_xi(2)*slopes(2), along_xi(1)*slopes(2) - along_eta(1)*slopes(1)]
         h(:, 1) = h(:, 1) + g*(g(1)/jacobian)
         h(:, 2) = h(:, 2) + g*(g(2)/jacobian)
      end do
   end function products_of_slopes

   !> Gradients of the shape functions at n points from those at the points of the stiffness: the strains of an element with reduced
   !> integration are what they are there, constant (one point) or linear along xi and eta (four).
   pure subroutine spread_gradients(n, n_nodes, x, gradient)
      integer(ip), intent(in) :: n                 !< points: 1, 4 or 9
      integer(ip), intent(in) :: n_nodes           !< of the element: 4 or 8
      real(wp), intent(in) :: x(2, MOST_NODES)     !< less those of the first node [L]
      real(wp), intent(inout) :: gradient(:, :, :) !< (points, 2, nodes) [1/L]
      real(wp) :: own(2, n_nodes, 4), slopes(n_nodes, 2), j(2, 2), xi(2), weight, share
      integer(ip) :: i, k, m

      m = BEST_OF(n_nodes)
      do k = 1, m
         call rule_point(4_ip, m, k, xi, weight)
         slopes = shape_gradients(n_nodes, xi)
         j = matmul(x(:, :n_nodes), slopes)
         own(1, :, k) = (j(2, 2)*slopes(:, 1) - j(2, 1)*slopes(:, 2))/(j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1))
         own(2, :, k) = (j(1, 1)*slopes(:, 2) - j(1, 2)*slopes(:, 1))/(j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1))
      end do
      gradient(:n, :, :n_nodes) = 0.0_wp
      do i = 1, n
         do k = 1, m
            share = share_of_point(m, k, n, i)
            gradient(i, :, :n_nodes) = gradient(i, :, :n_nodes) + share*own(:, :, k)
         end do
      end do
   end subroutine spread_gradients

   !> The same of the shape functions: what strains of the temperature are compared with strains of displacements.
   pure subroutine spread_values(n, n_nodes, value)
      integer(ip), intent(in) :: n                 !< points: 1, 4 or 9
      integer(ip), intent(in) :: n_nodes           !< of the element: 4 or 8
      real(wp), intent(inout) :: value(:, :)       !< (points, nodes); the first n and n_nodes are set
      real(wp) :: own(n_nodes), xi(2), weight
      integer(ip) :: i, k

      value(:n, :n_nodes) = 0.0_wp
      do k = 1, BEST_OF(n_nodes)
         call rule_point(4_ip, BEST_OF(n_nodes), k, xi, weight)
         own = shape_values(n_nodes, xi)
         do i = 1, n
            value(i, :n_nodes) = value(i, :n_nodes) + share_of_point(BEST_OF(n_nodes), k, n, i)*own
         end do
      end do
   end subroutine spread_values

   !> The value at point i of n of the function that is 1 at point k of m and 0 at the others.
   pure real(wp) function share_of_point(m, k, n, i) result(share)
      integer(ip), intent(in) :: m, k, n, i !< points of the stiffness, 1 or 4, which; points of the rule, which
      real(wp) :: here(2), own(2), weight

      share = 1.0_wp
      if (m == 1) return
      call rule_point(4_ip, m, k, own, weight)
      call rule_point(4_ip, n, i, here, weight)
      share = 0.25_wp*(1 + 3*own(1)*here(1))*(1 + 3*own(2)*here(2))   ! own is 1/sqrt(3) on either side
   end function share_of_point

end module atrito_reduced_integration
