!> Shapes of elements of eight nodes with reduced integration that strain none of their points: one an element,
!> u = xi (1 - 3 eta^2), v = -eta (1 - 3 xi^2) of a square. It leaves the points where they are, so the hoop strain of a ring does
!> not feel it either. Neighbours do not share it, but those on two opposite sides alone resist it the less the thinner the elements
!> of a row are.
module atrito_hourglass
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: body_t
   use atrito_dense, only: eigen_symmetric, orthonormalise
   use atrito_element_table, only: BEST_OF, POINTS_OF
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_plane_state, only: IS_REDUCED, STATES
   use atrito_shape_functions, only: rule_point, shape_gradients, shape_values
   implicit none (type, external)
   private
   public :: free_hourglass, worst_hourglass

   integer(ip), parameter :: EIGHT = 8, CORNERS = 4, STRAINS = 4, RIGID = 3
   real(wp), parameter :: NONE = 1.0e-10_wp        !< eigenvalue of a shape without strain, of the largest
   real(wp), parameter :: SAME = 1.0e-8_wp         !< singular value of constraints that say nothing new

contains

   !> The element (the user's number) of a body of one element, whose supports leave its hourglass free; 0: there is none.
   !>
   !> The displacements that strain none of the four points are four: two translations, a rotation, and the hourglass; of a ring
   !> two: the translation along the axis, and the hourglass. Of those n + 1, the ones that leave all held dofs at rest are the null
   !> space of their rows there, of the dimension n + 1 - rank; of the n rigid motions alone it is n - rank of their rows. Where
   !> both ranks are the same there is one motion more that no support feels, and it is no rigid one. A second element beside it
   !> would share no hourglass, so only bodies of one element are asked.
   integer(ip) function free_hourglass(fem, body) result(element)
      type(fem_t), intent(in) :: fem   !< the body's elements and equations are read
      type(body_t), intent(in) :: body !< one of fem's
      real(wp) :: x(2, EIGHT), shapes(2*EIGHT, RIGID + 1), motions(2*EIGHT, RIGID)
      logical :: is_held(2*EIGHT)
      logical :: found
      integer(ip) :: e, i, k, n

      element = 0
      if (size(body%elements) /= 1) return
      e = body%elements(1)
      if (.not. has_hourglass(fem%mesh, e)) return
      n = merge(1_ip, RIGID, is_ring(fem%mesh, e))
      x = fem%mesh%x(:, fem%mesh%nodes(:EIGHT, e))
      call find_shapes()
      if (.not. found) return
      do i = 1, EIGHT
         motions(2*i - 1:2*i, :) = reshape([0.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, [-1, 1]*(x([2, 1], i) - x([2, 1], 1)) &
                                            /maxval(abs(x - spread(x(:, 1), 2, EIGHT)))], [2, RIGID])
         is_held(2*i - 1:2*i) = fem%bodies%equation(:, fem%mesh%nodes(i, e)) == 0
      end do
      associate (held => pack([(k, k=1, 2*EIGHT)], is_held))
         if (rank_of(shapes(held, :n + 1)) == rank_of(motions(held, :n))) element = fem%mesh%element_id(e)
      end associate

   contains

      !> The displacements of an element that strain none of its points, columns of length 1; not found where they are not n + 1.
      !> They are sought in an element that is mapped to about a square, of which no aspect ratio is left: with x = J y strains are
      !> J' e J, of displacements J' u. In the place of the hoop strain u_1/r stands u_1, which is 0 where that is, far from the
      !> axis too.
      subroutine find_shapes()
         real(wp) :: j(2, 2), inverse(2, 2), y(2, EIGHT), strain(STRAINS, 2*EIGHT), products(2*EIGHT, 2*EIGHT), values(2*EIGHT), &
                     xi(2)
         real(wp) :: weight
         integer(ip) :: k, i, info

         j = matmul(x - spread(x(:, 1), 2, EIGHT), shape_gradients(EIGHT, [0.0_wp, 0.0_wp]))
         inverse = inverse_of(j)
         y = matmul(inverse, x - spread(x(:, 1), 2, EIGHT))
         products = 0.0_wp
         do k = 1, BEST_OF(EIGHT)
            call rule_point(EIGHT, BEST_OF(EIGHT), k, xi, weight)
            strain = strains_at(y, xi)
            if (is_ring(fem%mesh, e)) then
               strain(STRAINS, 1::2) = shape_values(EIGHT, xi)*(inverse(1, 1)/norm2(inverse(:, 1)))
               strain(STRAINS, 2::2) = shape_values(EIGHT, xi)*(inverse(2, 1)/norm2(inverse(:, 1)))
            end if
            products = products + matmul(transpose(strain), strain)
         end do
         call eigen_symmetric(products, values, info)
         found = info == 0 .and. count(values <= NONE*values(2*EIGHT)) == n + 1
         do k = 1, n + 1
            do i = 1, EIGHT
               shapes(2*i - 1:2*i, k) = matmul(transpose(inverse), products(2*i - 1:2*i, k))
            end do
            shapes(:, k) = shapes(:, k)/norm2(shapes(:, k))
         end do
      end subroutine find_shapes

   end function free_hourglass

   !> Of a body's elements that have neighbours on two sides at most: the strain energy that full integration would see in their
   !> hourglasses, over that which reduced integration sees in their displacements, both for mu = 0. With the element
   !> (the user's number) in which most of it is unseen. 0: there are none.
   subroutine worst_hourglass(fem, body, u, ratio, element)
      type(fem_t), intent(in) :: fem               !< the body's elements are read
      type(body_t), intent(in) :: body             !< one of fem's
      real(wp), intent(in) :: u(:, :)              !< (2, n_nodes) [L]
      real(wp), intent(out) :: ratio               !< unseen over seen energy, >= 0
      integer(ip), intent(out) :: element          !< the user's number; 0: there is none
      integer(ip), allocatable :: on_sides(:)      ! of each node in the middle of a side the elements there
      integer(ip) :: i
      real(wp) :: seen, all_seen, whole, most_unseen

      ratio = 0.0_wp
      element = 0
      if (.not. any([(has_hourglass(fem%mesh, body%elements(i)), i=1, size(body%elements, kind=ip))])) return
      allocate (on_sides(fem%mesh%n_nodes), source=0_ip)
      do i = 1, size(body%elements, kind=ip)
         associate (nodes => fem%mesh%nodes(CORNERS + 1:, body%elements(i)))
            on_sides(pack(nodes, nodes > 0)) = on_sides(pack(nodes, nodes > 0)) + 1
         end associate
      end do
      all_seen = 0.0_wp
      whole = 0.0_wp
      most_unseen = 0.0_wp
      do i = 1, size(body%elements, kind=ip)
         associate (e => body%elements(i))
            if (.not. has_hourglass(fem%mesh, e)) cycle
            associate (nodes => fem%mesh%nodes(:EIGHT, e))
               if (count(on_sides(nodes(CORNERS + 1:)) > 1) > 2) cycle
               seen = energy_of(fem%mesh%x(:, nodes), u(:, nodes), BEST_OF(EIGHT), is_ring(fem%mesh, e))
               all_seen = all_seen + seen
               seen = energy_of(fem%mesh%x(:, nodes), hourglass_of(fem%mesh%x(:, nodes), u(:, nodes)), POINTS_OF(EIGHT), &
                                is_ring(fem%mesh, e))
               whole = whole + seen
               if (seen > most_unseen) then
                  most_unseen = seen
                  element = fem%mesh%element_id(e)
               end if
            end associate
         end associate
      end do
      if (all_seen > 0.0_wp) ratio = whole/all_seen
   end subroutine worst_hourglass

   !> Eight nodes by the 2 x 2 points.
   pure logical function has_hourglass(mesh, e) result(has)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e

      has = mesh%shape(e) == EIGHT .and. IS_REDUCED(mesh%state(e))
   end function has_hourglass

   pure logical function is_ring(mesh, e) result(is)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e

      is = STATES(mesh%state(e))%has_hoop
   end function is_ring

   !> The part of displacements that is the hourglass.
   !>
   !> v = J'u are the displacements in the directions of xi and eta, J of the element's middle. The eight shape functions have two
   !> cubic terms, xi^2 eta and xi eta^2. Let c_u be the factor of xi eta^2 in v_xi and c_v that of xi^2 eta in v_eta: the hourglass
   !> v_xi = A xi (1 - 3 eta^2), v_eta = -A eta (1 - 3 xi^2) has c_u = -3A and c_v = 3A, so that
   !>
   !>     A = (c_v - c_u)/6,     2 c_v = (v3 + v4 - v1 - v2)/2 - v7 + v5,     2 c_u = (v2 + v3 - v1 - v4)/2 - v6 + v8
   !>
   !> with the nodes' v_eta and v_xi. (Bending under a shear force has xi^2 eta along xi, which is not asked for: in coarse rows of
   !> long elements more than full integration bears.)
   pure function hourglass_of(x, u) result(part)
      real(wp), intent(in) :: x(2, EIGHT), u(2, EIGHT) !< [L]
      real(wp) :: part(2, EIGHT), j(2, 2), v(2, EIGHT), amplitude
    real(wp), parameter :: SHAPE(2, EIGHT) = reshape([real(wp) :: 2, -2, -2, -2, -2, 2, 2, 2, 0, 1, 1, 0, 0, -1, -1, 0], [2, EIGHT])

      j = matmul(x - spread(x(:, 1), 2, EIGHT), shape_gradients(EIGHT, [0.0_wp, 0.0_wp]))
      v = matmul(transpose(j), u - spread(u(:, 1), 2, EIGHT))
      amplitude = ((v(2, 3) + v(2, 4) - v(2, 1) - v(2, 2))/2 - v(2, 7) + v(2, 5) &
                   - ((v(1, 2) + v(1, 3) - v(1, 1) - v(1, 4))/2 - v(1, 6) + v(1, 8)))/12
      part = amplitude*matmul(transpose(inverse_of(j)), SHAPE)
   end function hourglass_of

   !> e11, e22, 2 e12 and 0 at a place of an element from the displacements of its nodes.
   pure function strains_at(x, xi) result(strain)
      real(wp), intent(in) :: x(2, EIGHT), xi(2)
      real(wp) :: strain(STRAINS, 2*EIGHT), slopes(EIGHT, 2)

      slopes = shape_gradients(EIGHT, xi)
      slopes = matmul(slopes, inverse_of(matmul(x, slopes)))
      strain = 0.0_wp
      strain(1, 1::2) = slopes(:, 1)
      strain(2, 2::2) = slopes(:, 2)
      strain(3, 1::2) = slopes(:, 2)
      strain(3, 2::2) = slopes(:, 1)
   end function strains_at

   !> The integral of e11^2 + e22^2 + 2 e12^2 over an element [L^2], by a rule: twice the energy for 2G = 1 and mu = 0. Of a ring
   !> with the square of the hoop strain, and times the radius [L^3].
   pure real(wp) function energy_of(x, u, n, of_ring) result(energy)
      real(wp), intent(in) :: x(2, EIGHT), u(2, EIGHT)
      integer(ip), intent(in) :: n                 !< points
      logical, intent(in) :: of_ring
      real(wp) :: xi(2), weight, j(2, 2), e(STRAINS), relative(2, EIGHT), radius
      integer(ip) :: k

      energy = 0.0_wp
      relative = x - spread(x(:, 1), 2, EIGHT)
      do k = 1, n
         call rule_point(EIGHT, n, k, xi, weight)
         j = matmul(relative, shape_gradients(EIGHT, xi))
         e = matmul(strains_at(relative, xi), reshape(u - spread(u(:, 1), 2, EIGHT), [2*EIGHT]))
         radius = 1.0_wp
         if (of_ring) then
            radius = dot_product(x(1, :), shape_values(EIGHT, xi))
            e(4) = dot_product(u(1, :), shape_values(EIGHT, xi))/radius
         end if
         energy = energy + radius*weight*(j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1))*(e(1)**2 + e(2)**2 + 0.5_wp*e(3)**2 + e(4)**2)
      end do
   end function energy_of

   pure function inverse_of(j) result(inverse)
      real(wp), intent(in) :: j(2, 2)
      real(wp) :: inverse(2, 2)

      inverse = reshape([j(2, 2), -j(2, 1), -j(1, 2), j(1, 1)], [2, 2])/(j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1))
   end function inverse_of

   integer(ip) function rank_of(rows) result(rank)
      real(wp), intent(in) :: rows(:, :)
      real(wp), allocatable :: a(:, :)
      integer(ip) :: info

      rank = 0
      if (size(rows, 1) == 0) return
      a = rows
      call orthonormalise(a, rank, SAME, info)
   end function rank_of

end module atrito_hourglass
