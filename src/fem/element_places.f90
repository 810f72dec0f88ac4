!> Where points of the plane are in a mesh: the elements that hold them, and the values of their shape functions there.
!>
!> The coordinates xi of a point in an element solve x = sum N(xi) x_k, by Newton's method from the element's middle. Where no
!> element holds a point, one that it misses by little does, at the nearest place of its edge: what is drawn round has sides that
!> are straight or parabolas.
module atrito_element_places
   use atrito_element_table, only: CORNERS_OF, MOST_NODES
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: element_coordinates, face_nodes, mesh_t, side_count
   use atrito_shape_functions, only: shape_gradients, shape_values
   use atrito_sorting, only: first_at_least, order_key, sorted_places
   implicit none (type, external)
   private
   public :: place_t, find_places, find_nearest

   !> An element that holds a point.
   type :: place_t
      integer(ip) :: point = 0, element = 0           !< places
      real(wp) :: value(MOST_NODES) = 0.0_wp          !< of its shape functions; 0 behind those that it has
      real(wp), private :: beyond = 0.0_wp            !< how far outside of it the point is, in sides
   end type place_t

   real(wp), parameter :: ON_EDGE = 1.0e-6_wp         !< sides: what a point may miss an element by and still be in it
   real(wp), parameter :: NEAR = 0.05_wp              !< the same, where no other holds it
   real(wp), parameter :: BULGE = 0.25_wp             !< sides of parabolas go so far beyond the box of their nodes, at most
   integer, parameter :: MOST_STEPS = 30              !< of Newton's method

contains

   !> The elements that hold some points, point by point: of each body that does one, the first. A point that lies outside of all
   !> has none.
   subroutine find_places(mesh, wanted, x, places)
      type(mesh_t), intent(in) :: mesh                     !< nodes of elements and their places are read
      logical, intent(in) :: wanted(:)                     !< (n_elements) those that count
      real(wp), intent(in) :: x(:, :)                      !< (2, points) [L]
      type(place_t), allocatable, intent(out) :: places(:) !< by points, ascending
      type(place_t), allocatable :: found(:)
      integer(ip), allocatable :: order(:), n_of(:)
      integer(ip) :: i, k, n
      logical, allocatable :: is_kept(:)

      call list_holders(mesh, wanted, x, found, n)
      allocate (is_kept(n), source=.true.)
      allocate (n_of(size(x, 2)), source=0_ip)
      order = sorted_places(int(found(:n)%point, lp))
      found = found(order)                            ! in the order of the elements where the point is the same
      do i = 1, n
         do k = i - 1, 1, -1                          ! of those before it at the same point
            if (found(k)%point /= found(i)%point) exit
            if (.not. is_kept(k)) cycle
            if (max(found(i)%beyond, found(k)%beyond) > ON_EDGE) then
               is_kept(merge(i, k, found(i)%beyond >= found(k)%beyond)) = .false.   ! the nearer one
            else if (share_node(mesh, found(i)%element, found(k)%element)) then
               is_kept(i) = .false.
            end if
            if (.not. is_kept(i)) exit
         end do
      end do
      places = pack(found, is_kept)
   end subroutine find_places

   !> All elements that hold any of the points, or miss it by little.
   !>
   !> The points are sorted along the axis on which they lie farther apart. The box round an element, wider by BULGE for sides that
   !> are parabolas, cuts an interval out of them, whose first point is found by halves: of m points and n elements that makes about
   !> n log m questions and those for the points that lie in the boxes, not m n.
   subroutine list_holders(mesh, wanted, x, found, n)
      type(mesh_t), intent(in) :: mesh
      logical, intent(in) :: wanted(:)
      real(wp), intent(in) :: x(:, :)
      type(place_t), allocatable, intent(out) :: found(:)
      integer(ip), intent(out) :: n                   !< how many
      type(place_t), allocatable :: longer(:)
      type(place_t) :: one
      integer(ip), allocatable :: order(:)
      integer(lp), allocatable :: key(:)
      real(wp) :: nodes(2, MOST_NODES), low(2), high(2), margin
      integer(ip) :: e, i, k, axis, m

      allocate (found(16))
      n = 0
      ! along which the points are farther apart
      axis = merge(1, 2, span(x(1, :)) >= span(x(2, :)))
      order = sorted_places(order_key(x(axis, :)))
      key = order_key(x(axis, order))
      do e = 1, mesh%n_elements
         if (.not. wanted(e)) cycle
         m = mesh%shape(e)
         nodes(:, :m) = element_coordinates(mesh, e)
         low = minval(nodes(:, :m), dim=2)
         high = maxval(nodes(:, :m), dim=2)
         margin = BULGE*maxval(high - low)
         do i = first_at_least(key, order_key(low(axis) - margin)), size(order, kind=ip)
            k = order(i)
            if (x(axis, k) > high(axis) + margin) exit
            if (any(x(:, k) < low - margin .or. x(:, k) > high + margin)) cycle
            call look_into(m, nodes(:, :m), x(:, k), one)
            if (one%beyond > NEAR) cycle
            if (n == size(found)) then
               allocate (longer(2*n))
               longer(:n) = found
               call move_alloc(longer, found)
            end if
            n = n + 1
            found(n) = one
            found(n)%point = k
            found(n)%element = e
         end do
      end do
   end subroutine list_holders

   pure real(wp) function span(values)
      real(wp), intent(in) :: values(:)

      span = 0.0_wp
      if (size(values) > 0) span = maxval(values) - minval(values)
   end function span

   !> Where a point is in an element: place%beyond, and the shape functions there, or at the nearest place of its edge.
   !>
   !> Newton's method for r(xi) = sum_k N_k(xi) (x_k - x) = 0, with the Jacobian J = dr/dxi = sum_k (x_k - x) dN_k/dxi': each step
   !> solves J change = -r by Cramer's rule. Nodes are taken less the point, so that what is left of r near the root is not the
   !> difference of two large numbers. In straight-sided triangles and parallelograms r is linear, and one step finds the root; in
   !> others a few do. A point far outside may have no root, or one at which J is singular: it is given up then.
   pure subroutine look_into(n, nodes, x, place)
      integer(ip), intent(in) :: n                    !< of its nodes
      real(wp), intent(in) :: nodes(2, n), x(2)       !< [L]
      type(place_t), intent(out) :: place
      real(wp) :: xi(2), change(2), jacobian(2, 2), rest(2), det
      integer :: step

      place%beyond = huge(1.0_wp)
      xi = merge(1.0_wp/3.0_wp, 0.0_wp, CORNERS_OF(n) == 3)
      do step = 1, MOST_STEPS
         jacobian = matmul(nodes - spread(x, 2, int(n)), shape_gradients(n, xi))
         rest = matmul(nodes - spread(x, 2, int(n)), shape_values(n, xi))
         det = jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1)
         if (abs(det) <= epsilon(det)*maxval(abs(jacobian))**2) return
         change = [jacobian(1, 2)*rest(2) - jacobian(2, 2)*rest(1), jacobian(2, 1)*rest(1) - jacobian(1, 1)*rest(2)]/det
         xi = xi + change
         if (maxval(abs(xi)) > 10.0_wp) return
         if (maxval(abs(change)) < 1.0e-3_wp*ON_EDGE) exit
      end do
      if (step > MOST_STEPS) return
      if (CORNERS_OF(n) == 3) then
         place%beyond = max(-xi(1), -xi(2), xi(1) + xi(2) - 1.0_wp, 0.0_wp)
         xi = max(xi, 0.0_wp)
         xi = xi/max(1.0_wp, sum(xi))
      else
         place%beyond = 0.5_wp*max(maxval(abs(xi)) - 1.0_wp, 0.0_wp)
         xi = min(max(xi, -1.0_wp), 1.0_wp)
      end if
      place%value(:n) = shape_values(n, xi)
   end subroutine look_into

   !> Elements that hold the same point and have a node in common belong to one body.
   pure logical function share_node(mesh, one, other)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: one, other
      integer(ip) :: k

      share_node = any([(any(mesh%nodes(:mesh%shape(one), one) == mesh%nodes(k, other)), k=1, mesh%shape(other))])
   end function share_node

   !> The element that is nearest to a point outside of all, and how far its edge is; sides count as straight between their nodes.
   pure subroutine find_nearest(mesh, wanted, x, element, distance)
      type(mesh_t), intent(in) :: mesh                !< nodes of elements and their places are read
      logical, intent(in) :: wanted(:)                !< (n_elements) those that count
      real(wp), intent(in) :: x(2)                    !< [L]
      integer(ip), intent(out) :: element             !< 0: none counts
      real(wp), intent(out) :: distance               !< [L]
      integer(ip) :: e, k
      real(wp) :: d

      element = 0
      distance = huge(1.0_wp)
      do e = 1, mesh%n_elements
         if (.not. wanted(e)) cycle
         do k = 1, side_count(mesh, e)
            associate (nodes => face_nodes(mesh, e, k))
               if (size(nodes) == 2) d = to_segment(x, mesh%x(:, nodes))
               if (size(nodes) == 3) d = min(to_segment(x, mesh%x(:, nodes([1, 3]))), to_segment(x, mesh%x(:, nodes([3, 2]))))
            end associate
            if (d >= distance) cycle
            element = e
            distance = d
         end do
      end do
   end subroutine find_nearest

   !> The distance of a point from a segment [L].
   pure real(wp) function to_segment(x, ends) result(d)
      real(wp), intent(in) :: x(2), ends(2, 2)
      real(wp) :: along(2), from(2)

      along = ends(:, 2) - ends(:, 1)
      from = x - ends(:, 1)
      d = norm2(from - along*min(1.0_wp, max(0.0_wp, dot_product(from, along)/max(dot_product(along, along), tiny(d)))))
   end function to_segment

end module atrito_element_places
