!> One element: stiffness and loads of an isoparametric quadrilateral or triangle.
!>
!> Places and displacements have the same shape functions N_a of the coordinates xi of the parent square or triangle,
!>
!>     x = sum_a N_a(xi) x_a,     u = sum_a N_a(xi) u_a,     J = dx/dxi,     g_a = J^-T dN_a/dxi,
!>
!> and with the strains e = B u, whose rows are made of g_a, the work of the stresses D e on them gives
!>
!>     K = int B'D B t dA = sum over the Gauss points of weight det(J) t B'D B.
!>
!> g_a det(J) is linear in the coordinates, so sums are formed of it, and divided by det(J) once.
!>
!> Coordinates are taken relative to the element's first node: the derivatives of the shape functions add up to zero only but for
!> round-off, which far from the origin would cost digits.
module atrito_element
   use atrito_axisymmetric, only: axisymmetric_stiffness
   use atrito_element_table, only: BEST_OF, CORNERS_OF, DEGREE_OF, MOST_NODES, POINTS_OF, has_mean_dilatation, point_count
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_plane_state, only: elastic_t, elasticity_matrix, IS_REDUCED, IS_TAPERED, COMPONENTS, depth_at, STATES
   use atrito_reduced_integration, only: hourglass_stiffness
   use atrito_reduced_rings, only: reduced_ring_stiffness
   use atrito_shape_functions, only: shape_values, shape_gradients, face_shape_values, face_shape_slopes, gauss_rule, &
                                     rule_point, Q1_XI_SLOPES, Q1_ETA_SLOPES, Q2_XI_SLOPES, Q2_ETA_SLOPES, S2_XI_SLOPES, &
                                     S2_ETA_SLOPES, Q2_WEIGHTS, T1_XI_SLOPES, T1_ETA_SLOPES, T2_XI_SLOPES, T2_ETA_SLOPES, &
                                     T1_WEIGHT, T2_WEIGHT, Q1R_XI_SLOPES, Q1R_ETA_SLOPES, S2R_XI_SLOPES, S2R_ETA_SLOPES
   use atrito_tapered, only: tapered_means
   implicit none (type, external)
   private
   public :: element_stiffness, mean_gradients, pressure_load, body_load

   !> Bits of the largest entry of a stiffness that are kept: four fewer than a double has, room for exact sums.
   integer, parameter :: KEPT_BITS = digits(1.0_wp) - 4
   !> Dofs of the largest element.
   integer, parameter :: MOST_DOFS = 2*MOST_NODES

contains

   !> Stiffness [F/L] of an element, full Gauss integration; with FORMULATION=BBAR of the strains with the mean dilatation.
   !>
   !> Of isotropic elasticity B'DB of two nodes is, with g the gradients of their shape functions,
   !>
   !>     (lambda + G) ga gb' + G [ga.gb, -(ga x gb); ga x gb, ga.gb]
   !>
   !> the work of the dilatation and that of the rest, so that the integrals of ga gb' are all that is wanted of the Gauss points.
   !> The mean dilatation changes the first part alone. Only pairs a < b are computed: the blocks of the diagonal follow from them.
   pure subroutine element_stiffness(x, section, state, k, radius, thickness)
      real(wp), intent(in) :: x(:, :)                !< coordinates [L], (2, n)
      type(elastic_t), intent(in) :: section         !< elastic constants, thickness and integration
      integer(ip), intent(in) :: state               !< place in STATES
      real(wp), intent(out) :: k(:, :)               !< (2n, 2n)
      real(wp), intent(in), optional :: radius       !< of the origin of x [L], where that matters; default 0
      real(wp), intent(in), optional :: thickness(:) !< of the nodes [L], of a tapered state
      real(wp) :: upper(MOST_DOFS, MOST_DOFS), relative(2, MOST_NODES), d(COMPONENTS, COMPONENTS), bulk, shear, middle
      integer(ip) :: n, i, j

      if (STATES(state)%has_hoop) then
         if (IS_REDUCED(state) .and. size(x, 2) == 4) then
            call reduced_ring_stiffness(x, section, state, k, radius)
         else
            call axisymmetric_stiffness(x, section, state, k, radius)
         end if
         return
      end if
      n = size(x, 2, kind=ip)
      do i = 1, n
         relative(:, i) = x(:, i) - x(:, 1)
      end do
      middle = 1.0_wp
      if (IS_TAPERED(state)) then
         call integrate_tapered(n, state, relative, thickness, upper)
         middle = sum(thickness)/n
      else
         call integrate_products(n, IS_REDUCED(state), relative, upper)
      end if
      d = elasticity_matrix(section, state)
      bulk = (d(1, 2) + d(3, 3))*section%thickness
      shear = d(3, 3)*section%thickness
      if (section%is_orthotropic) then
         call combine_orthotropic(n, section%thickness*d, upper)
      else if (has_mean_dilatation(section, state, n)) then
         call combine_products(n, 0.0_wp, shear, upper)
         call add_mean_dilatation(relative, state, bulk, upper, thickness)
      else
         call combine_products(n, bulk, shear, upper)
      end if
      if (IS_REDUCED(state) .and. n == 4) call add_hourglass(relative, section, state, middle, upper)
      call balance_stiffness(n, upper)
      do j = 1, 2*n
         do i = 1, j
            k(i, j) = upper(i, j)
            k(j, i) = upper(i, j)
         end do
      end do
   end subroutine element_stiffness

   !> The integrals over the element of ga gb', a < b.
   !>
   !>     nodes       points     degree of ga gb' in xi and in eta     reduced
   !>     4           2 x 2      2                                     1
   !>     8, 9        3 x 3      4                                     2 x 2 of eight nodes
   !>     3           1          0
   !>     6           3          2, of both together
   !>
   !> The degrees are those of parallelograms and straight triangles, where det(J) is constant: full rules are exact for them. In
   !> other elements ga gb' is a quotient. For all shapes every rule has the integral of ga exactly, since ga det(J) is a
   !> polynomial that it reaches: a uniform stress has its exact nodal forces in distorted elements, too (patch test).
   pure subroutine integrate_products(n, is_reduced, x, products)
      integer(ip), intent(in) :: n
      logical, intent(in) :: is_reduced
      real(wp), intent(in) :: x(2, MOST_NODES)       !< less those of the first node [L]
      real(wp), intent(out) :: products(MOST_DOFS, MOST_DOFS) !< blocks a < b; others are undefined
      integer(ip) :: i

      products(:2*n, :2*n) = 0.0_wp
      if (is_reduced .and. n == 4) then
         call add_products(n, x, Q1R_XI_SLOPES, Q1R_ETA_SLOPES, 4.0_wp, products)
      else if (is_reduced) then
         do i = 1, size(S2R_XI_SLOPES, 2, kind=ip)
            call add_products(n, x, S2R_XI_SLOPES(:, i), S2R_ETA_SLOPES(:, i), 1.0_wp, products)
         end do
      else if (n == 4) then
         do i = 1, size(Q1_XI_SLOPES, 2, kind=ip)
            call add_products(n, x, Q1_XI_SLOPES(:, i), Q1_ETA_SLOPES(:, i), 1.0_wp, products)
         end do
      else if (n == 8) then
         do i = 1, size(S2_XI_SLOPES, 2, kind=ip)
            call add_products(n, x, S2_XI_SLOPES(:, i), S2_ETA_SLOPES(:, i), Q2_WEIGHTS(i), products)
         end do
      else if (n == 3) then
         call add_products(n, x, T1_XI_SLOPES, T1_ETA_SLOPES, T1_WEIGHT, products)
      else if (n == 6) then
         do i = 1, size(T2_XI_SLOPES, 2, kind=ip)
            call add_products(n, x, T2_XI_SLOPES(:, i), T2_ETA_SLOPES(:, i), T2_WEIGHT, products)
         end do
      else
         do i = 1, size(Q2_XI_SLOPES, 2, kind=ip)
            call add_products(n, x, Q2_XI_SLOPES(:, i), Q2_ETA_SLOPES(:, i), Q2_WEIGHTS(i), products)
         end do
      end if
   end subroutine integrate_products

   !> The same with the thickness at each point; four nodes with reduced integration have their means over the volume, since one
   !> point in the middle would not give the nodal forces of a uniform stress.
   pure subroutine integrate_tapered(n, state, x, thickness, products)
      integer(ip), intent(in) :: n, state
      real(wp), intent(in) :: x(2, MOST_NODES)       !< less those of the first node [L]
      real(wp), intent(in) :: thickness(:)         !< of the nodes [L]
      real(wp), intent(out) :: products(MOST_DOFS, MOST_DOFS) !< blocks a < b; others are undefined
      real(wp) :: xi(2), weight, slopes(n, 2), mean(2*n)
      integer(ip) :: i, b

      products(:2*n, :2*n) = 0.0_wp
      if (IS_REDUCED(state) .and. n == 4) then
         call tapered_means(x(:, :n), thickness, mean, weight)
         do b = 3, 2*n
            products(:2*((b - 1)/2), b) = mean(:2*((b - 1)/2))*(weight*mean(b))
         end do
         return
      end if
      do i = 1, point_count(n, state)
         call rule_point(n, point_count(n, state), i, xi, weight)
         slopes = shape_gradients(n, xi)
         call add_products(n, x, slopes(:, 1), slopes(:, 2), weight*dot_product(shape_values(n, xi), thickness), products)
      end do
   end subroutine integrate_tapered

   !> What of the stiffness of four nodes the middle does not feel, in the blocks a < b.
   pure subroutine add_hourglass(x, section, state, thickness, k)
      real(wp), intent(in) :: x(2, MOST_NODES)
      type(elastic_t), intent(in) :: section
      integer(ip), intent(in) :: state
      real(wp), intent(in) :: thickness            !< of a tapered state in the middle [L]; else 1
      real(wp), intent(inout) :: k(MOST_DOFS, MOST_DOFS)
      real(wp) :: shape(4), amount(2, 2)
      integer(ip) :: a, b

      call hourglass_stiffness(x(:, :4), section, state, shape, amount)
      amount = thickness*amount
      do b = 2, 4
         do a = 1, b - 1
            k(2*a - 1:2*a, 2*b - 1:2*b) = k(2*a - 1:2*a, 2*b - 1:2*b) + shape(a)*shape(b)*amount
         end do
      end do
   end subroutine add_hourglass

   !> What a Gauss point gives to the integrals of ga gb'.
   !>
   !> The columns of J are x_xi = sum_a x_a dN_a/dxi and x_eta likewise. J^-T det(J) has no quotient,
   !>
   !>     ga det(J) = [ y_eta N_xi - y_xi N_eta,  x_xi N_eta - x_eta N_xi ],
   !>
   !> so that with g = ga det(J) the point adds weight det(J) ga gb' = g_a g_b' weight/det(J): one division, in `factor`. Blocks
   !> a < b alone: b goes through the nodes, i through the dofs of those before it. Arrays of a fixed length, since the compiler
   !> makes more of them.
   pure subroutine add_products(n, x, dxi, deta, weight, products)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: x(2, n)
      real(wp), intent(in) :: dxi(n), deta(n)      !< derivatives of the shape functions
      real(wp), intent(in) :: weight
      real(wp), intent(inout) :: products(MOST_DOFS, MOST_DOFS)
      real(wp) :: along_xi(2), along_eta(2), factor
      real(wp) :: g(MOST_DOFS), h(MOST_DOFS)       ! gradients times the Jacobian [L]; g weight/Jacobian
      integer(ip) :: a, b, i

      along_xi = 0.0_wp
      along_eta = 0.0_wp
      do a = 2, n                                  ! x(:, 1) is 0
         along_xi = along_xi + x(:, a)*dxi(a)
         along_eta = along_eta + x(:, a)*deta(a)
      end do
      factor = weight/(along_xi(1)*along_eta(2) - along_eta(1)*along_xi(2))
      do a = 1, n
         g(2*a - 1) = along_eta(2)*dxi(a) - along_xi(2)*deta(a)
         g(2*a) = along_xi(1)*deta(a) - along_eta(1)*dxi(a)
      end do
      h(:2*n) = g(:2*n)*factor
      do b = 2, n
         do i = 1, 2*b - 2
            products(i, 2*b - 1) = products(i, 2*b - 1) + g(i)*h(2*b - 1)
            products(i, 2*b) = products(i, 2*b) + g(i)*h(2*b)
         end do
      end do
   end subroutine add_products

   !> From the integrals of ga gb' to the blocks of the stiffness, in place: of an isotropic D the sum of element_stiffness, in
   !> which `dot` is G times the integral of ga.gb and `cross` G times that of ga x gb = ga1 gb2 - ga2 gb1.
   pure subroutine combine_products(n, bulk, shear, k)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: bulk, shear          !< lambda + G and G times the thickness [F/L]
      real(wp), intent(inout) :: k(MOST_DOFS, MOST_DOFS)
      real(wp) :: dot, cross
      integer(ip) :: a, b

      do b = 2, n
         do a = 1, b - 1
            dot = shear*(k(2*a - 1, 2*b - 1) + k(2*a, 2*b))
            cross = shear*(k(2*a - 1, 2*b) - k(2*a, 2*b - 1))
            k(2*a - 1, 2*b - 1) = bulk*k(2*a - 1, 2*b - 1) + dot
            k(2*a, 2*b - 1) = bulk*k(2*a, 2*b - 1) + cross
            k(2*a - 1, 2*b) = bulk*k(2*a - 1, 2*b) - cross
            k(2*a, 2*b) = bulk*k(2*a, 2*b) + dot
         end do
      end do
   end subroutine combine_products

   !> The same of any D: with g the gradients, B of a node has the rows [g1, 0], [0, g2], [g2, g1] of the strains e11, e22, 2 e12.
   !> With p_ij the integral of ga_i gb_j the block Ba'D Bb has in its first entry d11 p11 + d13 (p12 + p21) + d33 p22, and the
   !> others likewise.
   pure subroutine combine_orthotropic(n, d, k)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: d(COMPONENTS, COMPONENTS) !< times the thickness [F/L]
      real(wp), intent(inout) :: k(MOST_DOFS, MOST_DOFS)
      real(wp) :: p11, p12, p21, p22
      integer(ip) :: a, b

      do b = 2, n
         do a = 1, b - 1
            p11 = k(2*a - 1, 2*b - 1)
            p21 = k(2*a, 2*b - 1)
            p12 = k(2*a - 1, 2*b)
            p22 = k(2*a, 2*b)
            k(2*a - 1, 2*b - 1) = d(1, 1)*p11 + d(1, 3)*(p12 + p21) + d(3, 3)*p22
            k(2*a, 2*b - 1) = d(1, 2)*p21 + d(1, 3)*p11 + d(2, 3)*p22 + d(3, 3)*p12
            k(2*a - 1, 2*b) = d(1, 2)*p12 + d(1, 3)*p11 + d(2, 3)*p22 + d(3, 3)*p21
            k(2*a, 2*b) = d(2, 2)*p22 + d(2, 3)*(p12 + p21) + d(3, 3)*p11
         end do
      end do
   end subroutine combine_orthotropic

   !> The work of the mean dilatation (T. J. R. Hughes, Int. J. Numer. Methods Eng. 15, 1980, for the plane: half of it in either
   !> direction; e33 stays 0, and s33 = mu (s11 + s22)).
   !>
   !>     theta_m = sum_a m_a . u_a  in place of  theta = sum_a ga . u_a:     (lambda + G) A m_a m_b' t,     m_a the mean of ga
   !>
   !> As mu goes to 1/2 lambda grows without bound; theta = 0 at four points, with two dofs an element in a large mesh, would lock
   !> it.
   pure subroutine add_mean_dilatation(x, state, bulk, k, thickness)
      real(wp), intent(in) :: x(2, MOST_NODES)       !< of four nodes [L]
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(in) :: bulk
      real(wp), intent(inout) :: k(MOST_DOFS, MOST_DOFS)
      real(wp), intent(in), optional :: thickness(:) !< of the nodes of a tapered state [L]
      real(wp) :: mean(8), of_nodes(2, 4), d(2), e(2), area
      integer(ip) :: b

      if (IS_TAPERED(state)) then
         call tapered_means(x(:, :4), thickness, of_nodes, area)
         mean = reshape(of_nodes, [8])
      else
         mean = reshape(mean_gradients(x(:, :4)), [8])
         d = x(:, 3) - x(:, 1)
         e = x(:, 4) - x(:, 2)
         area = 0.5_wp*(d(1)*e(2) - d(2)*e(1))
      end if
      do b = 3, 8
         associate (last => 2*((b - 1)/2))         ! dofs of the nodes before
            k(:last, b) = k(:last, b) + mean(:last)*(bulk*area*mean(b))
         end associate
      end do
   end subroutine add_mean_dilatation

   !> Makes the forces of a translation vanish to the last bit, K_aa = -sum_b K_ab for the 2 x 2 blocks of the nodes.
   !>
   !> Round-off alone leaves a translation a stiffness of some eps K; where elements move much more than they deform, and all
   !> have the same error, as equal elements have, that costs three digits of the answer. Off-diagonal blocks are rounded to a
   !> common grid, so that their sums are exact; the diagonal blocks come out symmetric because the antisymmetric parts of the
   !> others are made to cancel round each node.
   pure subroutine balance_stiffness(n, k)
      integer(ip), intent(in) :: n
      real(wp), intent(inout) :: k(MOST_DOFS, MOST_DOFS) !< blocks a < b; those of the diagonal on return, their upper triangles
      real(wp) :: defect
      integer(ip) :: a, b

      call sum_diagonal_blocks(n, k)
      call round_to_grid(n, k)
      do a = 1, n - 1
         defect = 0.0_wp
         do b = 1, a - 1
            defect = defect + (k(2*b, 2*a - 1) - k(2*b - 1, 2*a))
         end do
         do b = a + 1, n
            defect = defect + (k(2*a - 1, 2*b) - k(2*a, 2*b - 1))
         end do
         k(2*a - 1, 2*a + 2) = k(2*a - 1, 2*a + 2) - defect
      end do
      call sum_diagonal_blocks(n, k)
   end subroutine balance_stiffness

   !> Rounds the blocks a < b to a grid that has KEPT_BITS digits of the largest entry, which stands on the diagonal. When 1.5/eps
   !> of its spacings are added, no digits are left for anything finer.
   pure subroutine round_to_grid(n, k)
      integer(ip), intent(in) :: n
      real(wp), intent(inout) :: k(MOST_DOFS, MOST_DOFS)
      real(wp) :: largest, spacing, shift
      integer(ip) :: i, b

      largest = 0.0_wp
      do i = 1, 2*n
         largest = max(largest, abs(k(i, i)))
      end do
      if (largest < 1.0_wp/huge(1.0_wp)/EPS_MACH) return
      spacing = set_exponent(1.0_wp, exponent(largest) - KEPT_BITS)
      shift = 1.5_wp/EPS_MACH*spacing
      do b = 2, n
         do i = 1, 2*b - 2
            k(i, 2*b - 1) = (k(i, 2*b - 1) + shift) - shift
            k(i, 2*b) = (k(i, 2*b) + shift) - shift
         end do
      end do
   end subroutine round_to_grid

   !> The upper triangles of the diagonal blocks, less the sums of the others in their rows.
   pure subroutine sum_diagonal_blocks(n, k)
      integer(ip), intent(in) :: n
      real(wp), intent(inout) :: k(MOST_DOFS, MOST_DOFS)
      real(wp) :: k11, k12, k22
      integer(ip) :: a, b

      do a = 1, n
         k11 = 0.0_wp
         k12 = 0.0_wp
         k22 = 0.0_wp
         do b = 1, a - 1
            k11 = k11 - k(2*b - 1, 2*a - 1)
            k12 = k12 - k(2*b, 2*a - 1)
            k22 = k22 - k(2*b, 2*a)
         end do
         do b = a + 1, n
            k11 = k11 - k(2*a - 1, 2*b - 1)
            k12 = k12 - k(2*a - 1, 2*b)
            k22 = k22 - k(2*a, 2*b)
         end do
         k(2*a - 1, 2*a - 1) = k11
         k(2*a - 1, 2*a) = k12
         k(2*a, 2*a) = k22
      end do
   end subroutine sum_diagonal_blocks

   !> Coordinates less those of the first node [L].
   pure function from_first(x) result(relative)
      real(wp), intent(in) :: x(:, :)              !< (2, n) [L]
      real(wp) :: relative(2, size(x, 2))

      relative(1, :) = x(1, :) - x(1, 1)
      relative(2, :) = x(2, :) - x(2, 1)
   end function from_first

   !> Means over an element of four nodes of the derivatives of its shape functions [1/L], by Gauss' theorem: the integral of
   !> dN_a/dx1 is half the height of the diagonal from the node before a to the node behind it. sum(mean_gradients*u) is the mean
   !> dilatation.
   pure function mean_gradients(x) result(g)
      real(wp), intent(in) :: x(:, :)              !< (2, 4) [L]
      real(wp) :: g(2, 4)
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
   pure subroutine pressure_load(x, pressure, thickness, state, f, places, slope)
      real(wp), intent(in) :: x(:, :)              !< the face's nodes in the order of face_nodes [L], (2, 2 or 3)
      real(wp), intent(in) :: pressure             !< [F/L^2]
      real(wp), intent(in) :: thickness            !< [L]
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(out) :: f(:, :)             !< shape of x
      real(wp), intent(in), optional :: places(:)  !< what the depth goes by at the nodes (depth_places) [L]; default x1
      real(wp), intent(in), optional :: slope(2)   !< [F/L^3] of a pressure that is linear in the place, `pressure` at the origin
      real(wp) :: points(3), weights(3), n(size(x, 2)), tangent(2), relative(2, size(x, 2)), goes_by(size(x, 2)), push
      integer(ip) :: i, order, n_face

      goes_by = x(1, :)
      if (present(places)) goes_by = places
      n_face = size(x, 2, kind=ip)
      order = n_face
      relative = from_first(x)
      call gauss_rule(order, points(:order), weights(:order))
      f = 0.0_wp
      do i = 1, order
         n = face_shape_values(n_face, points(i))
         push = pressure
         if (present(slope)) push = pressure + dot_product(slope, matmul(x, n))
         push = weights(i)*push*depth_at(state, thickness, dot_product(n, goes_by))
         tangent = matmul(relative, face_shape_slopes(n_face, points(i)))
         ! travelling counter-clockwise the inward normal is the tangent turned by +90 degrees
         f(1, :) = f(1, :) - n*tangent(2)*push
         f(2, :) = f(2, :) + n*tangent(1)*push
      end do
   end subroutine pressure_load

   !> Points for a force per volume. Of triangles they are exact: shape functions and Jacobian, which is of the degree 2 with curved
   !> sides, times the depth and the place where these are not constant.
   pure integer(ip) function volume_points(n_nodes, state, is_linear) result(n)
      integer(ip), intent(in) :: n_nodes, state    !< places in SHAPES and STATES
      logical, intent(in) :: is_linear             !< in the place
      integer(ip) :: degree

      n = POINTS_OF(n_nodes)
      if (IS_REDUCED(state) .and. n_nodes == 8) n = BEST_OF(n_nodes) ! as other programs have it
      if (CORNERS_OF(n_nodes) /= 3) return
      associate (own => DEGREE_OF(n_nodes))
         degree = own + 2*(own - 1)
         if (STATES(state)%has_hoop .or. IS_TAPERED(state)) degree = degree + own
         if (is_linear) degree = degree + own
      end associate
      select case (degree)
      case (:1)
         n = 1
      case (2)
         n = 3
      case (3:4)
         n = 6
      case (5:6)
         n = 16
      case default
         n = 25
      end select
   end function volume_points

   !> Nodal forces [F] of a force per volume, constant or linear in the place: density + A x.
   pure subroutine body_load(x, density, thickness, state, f, slope, places)
      real(wp), intent(in) :: x(:, :)              !< (2, n) [L]
      real(wp), intent(in) :: density(2)           !< [F/L^3]
      real(wp), intent(in) :: thickness            !< [L]
      integer(ip), intent(in) :: state             !< place in STATES
      real(wp), intent(out) :: f(:, :)             !< (2, n)
      real(wp), intent(in), optional :: slope(3)   !< A11, A12 = A21, A22 [F/L^4]; default 0
      real(wp), intent(in), optional :: places(:)  !< what the depth goes by at the nodes (depth_places) [L]; default x1
      real(wp) :: xi(2), weight, j(2, 2), jacobian, n(size(x, 2)), here(2), place(2), goes_by(size(x, 2))
      integer(ip) :: point, n_points, n_nodes

      goes_by = x(1, :)
      if (present(places)) goes_by = places
      n_nodes = size(x, 2, kind=ip)
      f = 0.0_wp
      n_points = volume_points(n_nodes, state, present(slope))
      here = density
      do point = 1, n_points
         call rule_point(n_nodes, n_points, point, xi, weight)
         j = matmul(from_first(x), shape_gradients(n_nodes, xi))
         jacobian = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
         n = shape_values(n_nodes, xi)
         if (present(slope)) then
            place = matmul(x, n)
            here = density + [slope(1)*place(1) + slope(2)*place(2), slope(2)*place(1) + slope(3)*place(2)]
         end if
         n = n*(weight*jacobian*depth_at(state, thickness, dot_product(n, goes_by)))
         f(1, :) = f(1, :) + n*here(1)
         f(2, :) = f(2, :) + n*here(2)
      end do
   end subroutine body_load

end module atrito_element
