!> Shape functions of the quadrilaterals on [-1,1]^2 (Lagrange's, and eight nodes), of the triangles with xi, eta and 1 - xi - eta
!> >= 0, and of their faces, and Gauss points.
!>
!> Nodes: corners counter-clockwise from (-1,-1), of triangles from (0,0), then mid-sides (1-2, 2-3, 3-4, 4-1; 1-2, 2-3, 3-1), then
!> the centre.
!>
!> Of four and nine nodes a shape function is a product of Lagrange's polynomials along xi and eta, N = l_i(xi) l_j(eta), where i
!> and j are the place of the node in its grid. Eight nodes (serendipity) are the nine whose centre follows the others: its
!> displacement is half the sum of the mid-sides less a quarter of the sum of the corners, so that N_a = N_a(9) + c_a N_9(9) with
!> c_a = 1/2 and -1/4 (OF_CENTRE). Triangles have the areas L1, L2, L3: N = L, or L (2 L - 1) at corners and 4 L L' between them.
!>
!> n Gauss points along a line are exact for polynomials of degree 2n - 1. On a quadrilateral the rule is a product of two of a
!> line, on a triangle those of Dunavant, or a square with one side drawn together to a point.
module atrito_shape_functions
   use atrito_element_table, only: SHAPES
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: shape_values, shape_gradients, face_shape_values, face_shape_slopes, gauss_rule, gauss_point, rule_point
   public :: T1_XI_SLOPES, T1_ETA_SLOPES, T2_XI_SLOPES, T2_ETA_SLOPES, T1_WEIGHT, T2_WEIGHT
   public :: Q1_XI_SLOPES, Q1_ETA_SLOPES, Q2_XI_SLOPES, Q2_ETA_SLOPES, S2_XI_SLOPES, S2_ETA_SLOPES, Q2_WEIGHTS
   public :: Q1R_XI_SLOPES, Q1R_ETA_SLOPES, S2R_XI_SLOPES, S2R_ETA_SLOPES

   !> Places of the nodes in the tensor grid: index along xi and along eta (1: -1, 2: 0 or +1 for Q1, 3: +1).
   integer(ip), parameter :: Q1_NODES = 4, S2_NODES = 8, Q2_NODES = 9
   integer(ip), parameter :: Q1_GRID(2, Q1_NODES) = reshape([1, 1, 2, 1, 2, 2, 1, 2], [2, 4])
   integer(ip), parameter :: Q2_GRID(2, Q2_NODES) = reshape([1, 1, 3, 1, 3, 3, 1, 3, 2, 1, 3, 2, 2, 3, 1, 2, 2, 2], [2, 9])

   ! What stiffnesses need, tabulated: the same as shape_gradients and gauss_point give.
   !> Indices of the Gauss points along xi and eta, in the order of gauss_point.
   integer(ip), parameter :: Q1_POINTS(4, 2) = reshape([1, 2, 1, 2, 1, 1, 2, 2], [4, 2])
   integer(ip), parameter :: Q2_POINTS(9, 2) = reshape([1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 1, 1, 2, 2, 2, 3, 3, 3], [9, 2])
   real(wp), parameter :: T2(2) = [-1.0_wp, 1.0_wp]/sqrt(3.0_wp)
   real(wp), parameter :: T3(3) = [-1.0_wp, 0.0_wp, 1.0_wp]*sqrt(0.6_wp)
   real(wp), parameter :: W3(3) = [5.0_wp, 8.0_wp, 5.0_wp]/9.0_wp
   !> line_values and line_slopes there: (place in the grid, point).
   real(wp), parameter :: V2(2, 2) = transpose(reshape([0.5_wp*(1 - T2), 0.5_wp*(1 + T2)], [2, 2]))
   real(wp), parameter :: D2(2, 2) = reshape([-0.5_wp, 0.5_wp, -0.5_wp, 0.5_wp], [2, 2])
   real(wp), parameter :: V3(3, 3) = transpose(reshape([0.5_wp*T3*(T3 - 1), (1 - T3)*(1 + T3), 0.5_wp*T3*(T3 + 1)], [3, 3]))
   real(wp), parameter :: D3(3, 3) = transpose(reshape([T3 - 0.5_wp, -2*T3, T3 + 0.5_wp], [3, 3]))
   !> Derivatives of the shape functions at the Gauss points: (node, point).
   real(wp), parameter :: Q1_XI_SLOPES(Q1_NODES, 4) = D2(Q1_GRID(1, :), Q1_POINTS(:, 1))*V2(Q1_GRID(2, :), Q1_POINTS(:, 2))
   real(wp), parameter :: Q1_ETA_SLOPES(Q1_NODES, 4) = V2(Q1_GRID(1, :), Q1_POINTS(:, 1))*D2(Q1_GRID(2, :), Q1_POINTS(:, 2))
   real(wp), parameter :: Q2_XI_SLOPES(Q2_NODES, 9) = D3(Q2_GRID(1, :), Q2_POINTS(:, 1))*V3(Q2_GRID(2, :), Q2_POINTS(:, 2))
   real(wp), parameter :: Q2_ETA_SLOPES(Q2_NODES, 9) = V3(Q2_GRID(1, :), Q2_POINTS(:, 1))*D3(Q2_GRID(2, :), Q2_POINTS(:, 2))
   !> Eight nodes are the nine with a centre that follows the others: what each of them takes of its shape function.
   real(wp), parameter :: OF_CENTRE(S2_NODES) = [-0.25_wp, -0.25_wp, -0.25_wp, -0.25_wp, 0.5_wp, 0.5_wp, 0.5_wp, 0.5_wp]
   real(wp), parameter :: S2_XI_SLOPES(S2_NODES, 9) = Q2_XI_SLOPES(:S2_NODES, :) + &
                          spread(OF_CENTRE, 2, 9)*spread(Q2_XI_SLOPES(Q2_NODES, :), 1, S2_NODES)
   real(wp), parameter :: S2_ETA_SLOPES(S2_NODES, 9) = Q2_ETA_SLOPES(:S2_NODES, :) + &
                          spread(OF_CENTRE, 2, 9)*spread(Q2_ETA_SLOPES(Q2_NODES, :), 1, S2_NODES)
   !> The same at four points, for reduced integration; and of four nodes in the middle.
   real(wp), parameter :: V3R(3, 2) = transpose(reshape([0.5_wp*T2*(T2 - 1), (1 - T2)*(1 + T2), 0.5_wp*T2*(T2 + 1)], [2, 3]))
   real(wp), parameter :: D3R(3, 2) = transpose(reshape([T2 - 0.5_wp, -2*T2, T2 + 0.5_wp], [2, 3]))
   real(wp), parameter :: R2_XI_SLOPES(Q2_NODES, 4) = D3R(Q2_GRID(1, :), Q1_POINTS(:, 1))*V3R(Q2_GRID(2, :), Q1_POINTS(:, 2))
   real(wp), parameter :: R2_ETA_SLOPES(Q2_NODES, 4) = V3R(Q2_GRID(1, :), Q1_POINTS(:, 1))*D3R(Q2_GRID(2, :), Q1_POINTS(:, 2))
   real(wp), parameter :: S2R_XI_SLOPES(S2_NODES, 4) = R2_XI_SLOPES(:S2_NODES, :) + &
                          spread(OF_CENTRE, 2, 4)*spread(R2_XI_SLOPES(Q2_NODES, :), 1, S2_NODES)
   real(wp), parameter :: S2R_ETA_SLOPES(S2_NODES, 4) = R2_ETA_SLOPES(:S2_NODES, :) + &
                          spread(OF_CENTRE, 2, 4)*spread(R2_ETA_SLOPES(Q2_NODES, :), 1, S2_NODES)
   real(wp), parameter :: Q1R_XI_SLOPES(Q1_NODES) = [-0.25_wp, 0.25_wp, 0.25_wp, -0.25_wp]
   real(wp), parameter :: Q1R_ETA_SLOPES(Q1_NODES) = [-0.25_wp, -0.25_wp, 0.25_wp, 0.25_wp]
   !> Weights of the nine points; those of the four are 1.
   real(wp), parameter :: Q2_WEIGHTS(9) = W3(Q2_POINTS(:, 1))*W3(Q2_POINTS(:, 2))

   ! Triangles. xi and eta of the points of three rules, and their weights: exact up to the degrees 1, 2 and 4 (D. A. Dunavant, Int.
   ! J. Numer. Methods Eng. 21, 1985; two triples, each a point near a corner, 1 - 2t there and t beside).
   integer(ip), parameter :: T1_NODES = 3, T2_NODES = 6
   real(wp), parameter :: ROOT = sqrt(38.0_wp - 44.0_wp*sqrt(0.4_wp)), SIXTH = 1.0_wp/6.0_wp
   real(wp), parameter :: T6(2) = (8.0_wp - sqrt(10.0_wp) + [ROOT, -ROOT])/18.0_wp
   real(wp), parameter :: W_ROOT = sqrt(213125.0_wp - 53320.0_wp*sqrt(10.0_wp))
   real(wp), parameter :: W6(2) = [620.0_wp + W_ROOT, 620.0_wp - W_ROOT]/7440.0_wp
   real(wp), parameter :: T1_WEIGHT = 0.5_wp, T2_WEIGHT = SIXTH
   real(wp), parameter :: T1_XI_SLOPES(T1_NODES) = [-1.0_wp, 1.0_wp, 0.0_wp], T1_ETA_SLOPES(T1_NODES) = [-1.0_wp, 0.0_wp, 1.0_wp]
   !> At the three points: (node, point). There L1, L2, L3 are 4/6 and twice 1/6.
   real(wp), parameter :: T2_XI_SLOPES(T2_NODES, 3) = reshape([-5, -1, 0, 6, 2, -2, 1, 5, 0, -6, 2, -2, 1, -1, 0, 0, 8, -8]/ &
                                                              3.0_wp, [T2_NODES, 3_ip])
   real(wp), parameter :: T2_ETA_SLOPES(T2_NODES, 3) = reshape([-5, 0, -1, -2, 2, 6, 1, 0, -1, -8, 8, 0, 1, 0, 5, -2, 2, -6]/ &
                                                               3.0_wp, [T2_NODES, 3_ip])

contains

   !> Values of the shape functions at a place.
   pure function shape_values(n_nodes, xi) result(n)
      integer(ip), intent(in) :: n_nodes           !< of the element: place in SHAPES
      real(wp), intent(in) :: xi(2)                !< in [-1,1]^2, or in the triangle
      real(wp) :: n(n_nodes)
      real(wp) :: a(3), b(3)
      integer(ip) :: i, grid(2)

      if (SHAPES(n_nodes)%n_corners == 3) then
         n = triangle_values(n_nodes, xi)
         return
      end if
      a = line_values(n_nodes, xi(1))
      b = line_values(n_nodes, xi(2))
      do i = 1, n_nodes
         grid = grid_of(n_nodes, i)
         n(i) = a(grid(1))*b(grid(2))
      end do
      if (n_nodes == S2_NODES) n = n + OF_CENTRE*(a(2)*b(2))
   end function shape_values

   !> Derivatives of the shape functions with respect to xi (column 1) and eta (column 2).
   pure function shape_gradients(n_nodes, xi) result(dn)
      integer(ip), intent(in) :: n_nodes !< of the element: place in SHAPES
      real(wp), intent(in) :: xi(2)      !< in [-1,1]^2, or in the triangle
      real(wp) :: dn(n_nodes, 2)
      real(wp) :: a(3), b(3), da(3), db(3)
      integer(ip) :: i, grid(2)

      if (SHAPES(n_nodes)%n_corners == 3) then
         dn = triangle_gradients(n_nodes, xi)
         return
      end if
      a = line_values(n_nodes, xi(1))
      b = line_values(n_nodes, xi(2))
      da = line_slopes(n_nodes, xi(1))
      db = line_slopes(n_nodes, xi(2))
      do i = 1, n_nodes
         grid = grid_of(n_nodes, i)
         dn(i, :) = [da(grid(1))*b(grid(2)), a(grid(1))*db(grid(2))]
      end do
      if (n_nodes == S2_NODES) then
         dn(:, 1) = dn(:, 1) + OF_CENTRE*(da(2)*b(2))
         dn(:, 2) = dn(:, 2) + OF_CENTRE*(a(2)*db(2))
      end if
   end function shape_gradients

   !> Of a triangle: L1 = 1 - xi - eta, L2 = xi, L3 = eta; of six nodes L (2 L - 1) and 4 L L'.
   pure function triangle_values(n_nodes, xi) result(n)
      integer(ip), intent(in) :: n_nodes
      real(wp), intent(in) :: xi(2)
      real(wp) :: n(n_nodes)
      real(wp) :: l(3)

      l = [1 - xi(1) - xi(2), xi(1), xi(2)]
      if (n_nodes == T1_NODES) then
         n(:3) = l
      else
         n(:3) = l*(2*l - 1)
         n(4:) = 4*l*[l(2), l(3), l(1)]
      end if
   end function triangle_values

   !> Of the area coordinates L = (1 - xi - eta, xi, eta) the three nodes of the first degree have N_i = L_i. Of the second a corner
   !> has L_i (2 L_i - 1), with the derivative (4 L_i - 1) dL_i, and the middle of a side 4 L_i L_j, with 4 (L_i dL_j + L_j dL_i).
   pure function triangle_gradients(n_nodes, xi) result(dn)
      integer(ip), intent(in) :: n_nodes
      real(wp), intent(in) :: xi(2)
      real(wp) :: dn(n_nodes, 2)
      real(wp) :: l(3), dl(3)
      integer(ip) :: k

      l = [1 - xi(1) - xi(2), xi(1), xi(2)]
      do k = 1, 2
         dl = merge(T1_XI_SLOPES, T1_ETA_SLOPES, k == 1)
         if (n_nodes == T1_NODES) then
            dn(:3, k) = dl
         else
            dn(:3, k) = (4*l - 1)*dl
            dn(4:, k) = 4*(l*[dl(2), dl(3), dl(1)] + dl*[l(2), l(3), l(1)])
         end if
      end do
   end function triangle_gradients

   pure function grid_of(n_nodes, node) result(grid)
      integer(ip), intent(in) :: n_nodes, node
      integer(ip) :: grid(2)

      if (n_nodes == Q1_NODES) then
         grid = Q1_GRID(:, node)
      else
         grid = Q2_GRID(:, node)
      end if
   end function grid_of

   !> Lagrange polynomials on the line: two points for Q1, three for Q2.
   pure function line_values(n_nodes, t) result(v)
      integer(ip), intent(in) :: n_nodes
      real(wp), intent(in) :: t
      real(wp) :: v(3)

      if (n_nodes == Q1_NODES) then
         v = [0.5_wp*(1 - t), 0.5_wp*(1 + t), 0.0_wp]
      else
         v = [0.5_wp*t*(t - 1), (1 - t)*(1 + t), 0.5_wp*t*(t + 1)]
      end if
   end function line_values

   pure function line_slopes(n_nodes, t) result(v)
      integer(ip), intent(in) :: n_nodes
      real(wp), intent(in) :: t
      real(wp) :: v(3)

      if (n_nodes == Q1_NODES) then
         v = [-0.5_wp, 0.5_wp, 0.0_wp]
      else
         v = [t - 0.5_wp, -2*t, t + 0.5_wp]
      end if
   end function line_slopes

   !> Values on a face at t in [-1,1]; nodes in the order of face_nodes: first, last, middle.
   pure function face_shape_values(n_face_nodes, t) result(n)
      integer(ip), intent(in) :: n_face_nodes      !< 2 or 3
      real(wp), intent(in) :: t                    !< in [-1,1] along the face
      real(wp) :: n(n_face_nodes)
      real(wp) :: v(3)

      if (n_face_nodes == 2) then
         v = line_values(Q1_NODES, t)
         n = v(:2)
      else
         v = line_values(Q2_NODES, t)
         n = v([1, 3, 2])
      end if
   end function face_shape_values

   !> Derivatives of face_shape_values.
   pure function face_shape_slopes(n_face_nodes, t) result(n)
      integer(ip), intent(in) :: n_face_nodes !< 2 or 3
      real(wp), intent(in) :: t               !< in [-1,1] along the face
      real(wp) :: n(n_face_nodes)
      real(wp) :: v(3)

      if (n_face_nodes == 2) then
         v = line_slopes(Q1_NODES, t)
         n = v(:2)
      else
         v = line_slopes(Q2_NODES, t)
         n = v([1, 3, 2])
      end if
   end function face_shape_slopes

   !> Points and weights of the Gauss rule with 1 to 5 points on [-1,1].
   pure subroutine gauss_rule(n, points, weights)
      integer(ip), intent(in) :: n                   !< 1 .. 5
      real(wp), intent(out) :: points(n), weights(n) !< ascending in [-1,1]; their sum is 2
      real(wp) :: near, far

      if (n == 1) then
         points = 0.0_wp
         weights = 2.0_wp
      else if (n == 2) then
         points = [-1.0_wp, 1.0_wp]/sqrt(3.0_wp)
         weights = 1.0_wp
      else if (n == 3) then
         points = [-1.0_wp, 0.0_wp, 1.0_wp]*sqrt(0.6_wp)
         weights = [5.0_wp, 8.0_wp, 5.0_wp]/9.0_wp
      else if (n == 4) then
         near = sqrt((3 - 2*sqrt(1.2_wp))/7)
         far = sqrt((3 + 2*sqrt(1.2_wp))/7)
         points = [-far, -near, near, far]
         weights = (18 + [-1, 1, 1, -1]*sqrt(30.0_wp))/36
      else
         near = sqrt(5 - 2*sqrt(10.0_wp/7))/3
         far = sqrt(5 + 2*sqrt(10.0_wp/7))/3
         points = [-far, -near, 0.0_wp, near, far]
         weights = [[322.0_wp, 322.0_wp, 512.0_wp, 322.0_wp, 322.0_wp] + [-13, 13, 0, 13, -13]*sqrt(70.0_wp)]/900
      end if
   end subroutine gauss_rule

   !> The k-th Gauss point of an element's stiffness.
   pure subroutine gauss_point(n_nodes, k, xi, weight)
      integer(ip), intent(in) :: n_nodes           !< of the element: place in SHAPES
      integer(ip), intent(in) :: k                 !< 1 .. n_points of its shape
      real(wp), intent(out) :: xi(2), weight       !< place in the parent square or triangle; its weight

      call rule_point(n_nodes, SHAPES(n_nodes)%n_points, k, xi, weight)
   end subroutine gauss_point

   !> The k-th of n points of a rule over an element: of a quadrilateral xi fastest, from the corner at node 1, of a triangle from
   !> node to node.
   pure subroutine rule_point(n_nodes, n, k, xi, weight)
      integer(ip), intent(in) :: n_nodes           !< place in SHAPES
      integer(ip), intent(in) :: n                 !< 1, 4 or 9; 1, 3, 6, 16 or 25
      integer(ip), intent(in) :: k                 !< 1 .. n
      real(wp), intent(out) :: xi(2), weight       !< place in the parent square or triangle; its weight

      if (SHAPES(n_nodes)%n_corners == 3) then
         call triangle_point(n, k, xi, weight)
      else
         call square_point(n, k, xi, weight)
      end if
   end subroutine rule_point

   pure subroutine square_point(n, k, xi, weight)
      integer(ip), intent(in) :: n                 !< a square, of a number up to 5
      integer(ip), intent(in) :: k
      real(wp), intent(out) :: xi(2), weight
      real(wp) :: points(5), weights(5)
      integer(ip) :: order, i, j

      order = nint(sqrt(real(n, wp)), ip)
      call gauss_rule(order, points(:order), weights(:order))
      i = mod(k - 1, order) + 1
      j = (k - 1)/order + 1
      xi = [points(i), points(j)]
      weight = weights(i)*weights(j)
   end subroutine square_point

   !> Point k of a rule of n. Up to six of them lie in threes: with t, t and 1 - 2t for the area coordinates a triple is the same
   !> from each corner. More are those of Gauss in the square (a, b), of which a side is drawn together to a corner: xi = (1 +
   !> a)/2, eta = (1 + b)(1 - xi)/2, whose Jacobian is (1 - xi)/4.
   pure subroutine triangle_point(n, k, xi, weight)
      integer(ip), intent(in) :: n                 !< exact for polynomials of degree 1, 2, 4, 6, 8: 1, 3, 6, 16, 25
      integer(ip), intent(in) :: k
      real(wp), intent(out) :: xi(2), weight
      real(wp) :: t

      if (n > 6) then
         ! of the square whose side at xi = 1 is drawn together to a corner: the Jacobian takes one degree
         call square_point(n, k, xi, weight)
         xi(1) = 0.5_wp*(1 + xi(1))
         xi(2) = 0.5_wp*(1 + xi(2))*(1 - xi(1))
         weight = 0.25_wp*weight*(1 - xi(1))
         return
      end if
      if (n == 1) then
         t = 2*SIXTH
         weight = T1_WEIGHT
      else if (n == 3) then
         t = SIXTH
         weight = T2_WEIGHT
      else
         t = T6((k + 2)/3)
         weight = W6((k + 2)/3)
      end if
      xi = t
      if (mod(k, 3_ip) == 2) xi(1) = 1 - 2*t
      if (mod(k, 3_ip) == 0) xi(2) = 1 - 2*t
   end subroutine triangle_point

end module atrito_shape_functions
