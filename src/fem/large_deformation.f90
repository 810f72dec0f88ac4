!> Where a displacement field is larger than a linear theory knows: strains and rotations at the points of the elements where they
!> are most accurate (four nodes: the middle; more: 2 x 2 Gauss points). The hoop strain u1/x1 of a ring is one of its strains.
!>
!> What is small everywhere is found small by much less than that: strains by a bound that the error estimate has at hand, rotations
!> by the diagonals of the elements.
module atrito_large_deformation
   use atrito_assembly, only: fem_t
   use atrito_element_table, only: BEST_OF, CORNERS_OF, DEGREE_OF, MOST_NODES
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, is_revolved
   use atrito_point_stress, only: point_rule_t, point_geometry_t, make_point_rules, fetch_geometry, hoop_strain
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: deformation_t, may_rotate, measure_deformation

   !> The largest strain and rotation, and where.
   type :: deformation_t
      real(wp) :: strain = 0.0_wp                  !< largest absolute principal strain in the plane, or round the circle
      real(wp) :: rotation = 0.0_wp                !< largest |du2/dx1 - du1/dx2|/2 [rad]
      integer(ip) :: strain_element = 0, rotation_element = 0 !< places in the mesh; 0: none was looked at
      real(wp) :: strain_x(2) = 0.0_wp, rotation_x(2) = 0.0_wp !< [L]
   end type deformation_t

contains

   !> Whether a point may rotate by more than a bound. The gradient that maps the diagonals d, e of the corners to how their ends
   !> move apart, a and b, rotates by (a.e - b.d)/2(d x e), four nodes in their middle exactly so. With more nodes a side whose
   !> middle leaves the chord by m rotates at its ends by 4 |m| over its length besides.
   logical function may_rotate(mesh, u, bound)
      type(mesh_t), intent(in) :: mesh             !< elements and places of the nodes are read
      real(wp), intent(in) :: u(:, :)              !< (2, n_nodes) [L]
      real(wp), intent(in) :: bound                !< [rad]
      integer(ip) :: e

      may_rotate = .false.
      !$omp parallel do reduction(.or.:may_rotate) if (is_shared(mesh%n_elements))
      do e = 1, mesh%n_elements
         may_rotate = may_rotate .or. rotates(mesh%nodes(:, e), mesh%shape(e), mesh%x, u, bound)
      end do
      !$omp end parallel do
   end function may_rotate

   pure logical function rotates(nodes, shape, x, u, bound)
      integer(ip), intent(in) :: nodes(:), shape
      real(wp), intent(in) :: x(:, :), u(:, :), bound
      integer(ip) :: from(2), to(2)
      real(wp), dimension(2) :: a, b, d, e
      real(wp) :: least

      from = nodes([1, 2])
      to = nodes([3, 4])
      if (CORNERS_OF(shape) == 3) then       ! two sides in place of the diagonals
         from = nodes([1, 1])
         to = nodes([2, 3])
      end if
      a = u(:, to(1)) - u(:, from(1))
      b = u(:, to(2)) - u(:, from(2))
      d = x(:, to(1)) - x(:, from(1))
      e = x(:, to(2)) - x(:, from(2))
      least = bound
      if (DEGREE_OF(shape) > 1) least = bound - bending(nodes, CORNERS_OF(shape), x, u)
      rotates = abs(a(1)*e(1) + a(2)*e(2) - b(1)*d(1) - b(2)*d(2)) > 2*least*(d(1)*e(2) - d(2)*e(1))
   end function rotates

   !> By how much the ends of sides with a node in their middle rotate against the chord, at the most [rad].
   pure real(wp) function bending(nodes, n_corners, x, u)
      integer(ip), intent(in) :: nodes(:), n_corners
      real(wp), intent(in) :: x(:, :), u(:, :)
      real(wp) :: sag(2), chord(2)
      integer(ip) :: k, next

      bending = 0.0_wp
      do k = 1, n_corners
         next = nodes(merge(1_ip, k + 1, k == n_corners))
         sag = u(:, nodes(n_corners + k)) - 0.5_wp*(u(:, nodes(k)) + u(:, next))
         chord = x(:, next) - x(:, nodes(k))
         bending = max(bending, 4*(abs(sag(1)) + abs(sag(2)))/max(abs(chord(1)), abs(chord(2))))
      end do
   end function bending

   !> The largest strain and rotation at the best points, of all elements or of those that may rotate by more than a bound.
   subroutine measure_deformation(fem, u, whole, bound, largest)
      type(fem_t), intent(in) :: fem               !< mesh and sections are read
      real(wp), contiguous, intent(in) :: u(:, :)  !< (2, n_nodes) [L]
      logical, intent(in) :: whole                 !< all elements
      real(wp), intent(in) :: bound                !< else those that may rotate by more [rad]
      type(deformation_t), intent(out) :: largest  !< with zeros where nothing was looked at
      type(point_rule_t) :: rules(MOST_NODES)
      type(point_geometry_t) :: geometry
      integer(ip) :: e

      call make_point_rules(BEST_OF, rules)
      do e = 1, fem%mesh%n_elements
         if (.not. whole) then
            if (.not. rotates(fem%mesh%nodes(:, e), fem%mesh%shape(e), fem%mesh%x, u, bound)) cycle
         end if
         if (DEGREE_OF(fem%mesh%shape(e)) == 1) then
            call measure_middle(fem%mesh, u, e, CORNERS_OF(fem%mesh%shape(e)), largest)
         else
            call fetch_geometry(fem, e, rules(fem%mesh%shape(e)), geometry)
            call measure_points(fem%mesh, u, e, rules(fem%mesh%shape(e)), geometry, largest)
         end if
      end do
   end subroutine measure_deformation

   !> The middle of an element whose nodes are its corners.
   !>
   !> The diagonals d, e of four nodes and how their ends move apart, a and b, give the gradient of the displacements in the middle
   !> without shape functions: H d = a and H e = b hold there exactly, hence
   !>
   !>     H = [a b] [d e]^-1,     [d e]^-1 = [ e2  -e1 ; -d2  d1 ]/(d1 e2 - d2 e1).
   !>
   !> In a triangle H is the same everywhere, and two of its sides take the place of the diagonals.
   pure subroutine measure_middle(mesh, u, element, n_corners, largest)
      type(mesh_t), intent(in) :: mesh
      real(wp), contiguous, intent(in) :: u(:, :)
      integer(ip), intent(in) :: element, n_corners
      type(deformation_t), intent(inout) :: largest
      integer(ip) :: from(2), to(2)
      real(wp) :: a(2), b(2), d(2), e(2), per, h(2, 2), x(2)

      associate (nodes => mesh%nodes(:, element))
         from = [nodes(1), merge(nodes(2), nodes(1), n_corners == 4)]  ! of three nodes two sides in place of the diagonals
         to = [nodes(n_corners - 1), nodes(n_corners)]
      end associate
      a = u(:, to(1)) - u(:, from(1))
      b = u(:, to(2)) - u(:, from(2))
      d = mesh%x(:, to(1)) - mesh%x(:, from(1))
      e = mesh%x(:, to(2)) - mesh%x(:, from(2))
      per = 1/(d(1)*e(2) - d(2)*e(1))
      h(:, 1) = (a*e(2) - b*d(2))*per
      h(:, 2) = (b*d(1) - a*e(1))*per
      if (strain_of(h) <= largest%strain .and. rotation_of(h) <= largest%rotation .and. .not. is_revolved(mesh)) return
      x = 0.25_wp*(mesh%x(:, from(1)) + mesh%x(:, from(2)) + mesh%x(:, to(1)) + mesh%x(:, to(2)))
      if (n_corners == 3) x = (mesh%x(:, from(1)) + mesh%x(:, to(1)) + mesh%x(:, to(2)))/3
      call note_gradient(h, element, x, largest)
      if (is_revolved(mesh)) then
         associate (corners => mesh%nodes(:n_corners, element))
            call note_strain(abs(sum(u(1, corners))/sum(mesh%x(1, corners))), element, x, largest)
         end associate
      end if
   end subroutine measure_middle

   pure subroutine measure_points(mesh, u, e, rule, geometry, largest)
      type(mesh_t), intent(in) :: mesh
      real(wp), contiguous, intent(in) :: u(:, :)
      integer(ip), intent(in) :: e
      type(point_rule_t), intent(in) :: rule
      type(point_geometry_t), intent(in) :: geometry
      type(deformation_t), intent(inout) :: largest
      real(wp) :: h(2, 2), way(2, MOST_NODES)
      integer(ip) :: i, k, first

      first = mesh%nodes(1, e)
      do k = 1, geometry%shape
         way(:, k) = u(:, mesh%nodes(k, e)) - u(:, first)
      end do
      do i = 1, rule%n
         h = 0.0_wp
         do k = 2, geometry%shape
            h(:, 1) = h(:, 1) + way(:, k)*geometry%gradient(i, 1, k)
            h(:, 2) = h(:, 2) + way(:, k)*geometry%gradient(i, 2, k)
         end do
         associate (x => mesh%x(:, first) + geometry%place(i, :))
            call note_gradient(h, e, x, largest)
            if (geometry%has_hoop) call note_strain(abs(hoop_strain(rule, geometry, i, way, u(1, first))), e, x, largest)
         end associate
      end do
   end subroutine measure_points

   !> The largest absolute principal strain in the plane.
   pure real(wp) function strain_of(h)
      real(wp), intent(in) :: h(2, 2)

      strain_of = 0.5_wp*(abs(h(1, 1) + h(2, 2)) + hypot(h(1, 1) - h(2, 2), h(1, 2) + h(2, 1)))
   end function strain_of

   !> The rotation of a gradient h(i, j) = du_i/dx_j.
   pure real(wp) function rotation_of(h)
      real(wp), intent(in) :: h(2, 2)

      rotation_of = 0.5_wp*abs(h(2, 1) - h(1, 2))
   end function rotation_of

   !> Strain and rotation of a gradient.
   pure subroutine note_gradient(h, e, x, largest)
      real(wp), intent(in) :: h(2, 2)
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: x(2)                 !< [L]
      type(deformation_t), intent(inout) :: largest
      real(wp) :: rotation

      rotation = rotation_of(h)
      call note_strain(strain_of(h), e, x, largest)
      if (rotation > largest%rotation) then
         largest%rotation = rotation
         largest%rotation_element = e
         largest%rotation_x = x
      end if
   end subroutine note_gradient

   pure subroutine note_strain(strain, e, x, largest)
      real(wp), intent(in) :: strain
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: x(2)                 !< [L]
      type(deformation_t), intent(inout) :: largest

      if (strain <= largest%strain) return
      largest%strain = strain
      largest%strain_element = e
      largest%strain_x = x
   end subroutine note_strain

end module atrito_large_deformation
