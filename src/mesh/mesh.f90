!> The mesh: nodes, elements and their topology.
module atrito_mesh
   use atrito_element_table, only: SHAPES, CORNERS_OF, MOST_NODES
   use atrito_growth, only: resize
   use atrito_id_map, only: id_map_t, add_id, add_sequence, find_id
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: STATES, IS_TAPERED
   use atrito_threads, only: is_shared
   use atrito_triangle_pieces, only: triangles_of_square
   implicit none (type, external)
   private
   public :: turned_nodes, is_clockwise
   public :: mesh_t, reserve_mesh, add_node, add_nodes, add_element, add_block, find_node, find_element, trim_mesh
   public :: face_nodes, face_end
   public :: side_between, nodes_of_square, is_hollow, elements_of_square
   public :: side_count, middle_node, element_coordinates, signed_area, is_revolved, depth_places

   type :: mesh_t
      integer(ip) :: n_nodes = 0, n_elements = 0    !< in use; the arrays may be longer
      integer(ip), allocatable :: node_id(:)        !< the user's numbers
      real(wp), allocatable :: x(:, :)              !< coordinates [L], (2, n_nodes)
      real(wp) :: digit_error = 0.0_wp              !< of places that the deck gives, where nodes are made of them [L]; else 0
      integer(ip), allocatable :: element_id(:)     !< the user's numbers
      integer(ip), allocatable :: shape(:)          !< place in SHAPES: how many nodes they have
      integer(ip), allocatable :: state(:)          !< place in STATES
      real(wp), allocatable :: thickness(:)         !< of the nodes (n_nodes) [L]; allocated where elements are tapered
      integer(ip), allocatable :: nodes(:, :)       !< (MOST_NODES, n_elements): corners counter-clockwise, mid-sides, centre
      type(id_map_t) :: node_map, element_map       !< from the user's numbers to places
   end type mesh_t

contains

   !> What the depth of an element goes by at some of its nodes, for depth_at: x1, or their thickness where it is tapered [L].
   pure function depth_places(mesh, state, nodes) result(places)
      type(mesh_t), intent(in) :: mesh              !< coordinates, or thicknesses where the element is tapered
      integer(ip), intent(in) :: state              !< of the element, place in STATES
      integer(ip), intent(in) :: nodes(:)           !< places of some of its nodes
      real(wp) :: places(size(nodes))
      integer(ip) :: k

      if (IS_TAPERED(state)) then
         places = mesh%thickness(nodes)
         return
      end if
      do k = 1, size(nodes, kind=ip)
         places(k) = mesh%x(1, nodes(k))
      end do
   end function depth_places

   !> Makes room for nodes and elements that are going to be added: once, not by doubling.
   pure subroutine reserve_mesh(mesh, new_nodes, new_elements)
      type(mesh_t), intent(inout) :: mesh                !< arrays get longer; what is there stays
      integer(ip), intent(in) :: new_nodes, new_elements !< that will be added, >= 0

      if (.not. allocated(mesh%node_id)) allocate (mesh%node_id(0), mesh%x(2, 0))
      if (.not. allocated(mesh%element_id)) allocate (mesh%element_id(0), mesh%shape(0), mesh%state(0), mesh%nodes(MOST_NODES, 0))
      if (mesh%n_nodes + new_nodes > size(mesh%node_id)) call resize_nodes(mesh, mesh%n_nodes + max(new_nodes, mesh%n_nodes/4))
      if (mesh%n_elements + new_elements > size(mesh%element_id)) then
         call resize_elements(mesh, mesh%n_elements + max(new_elements, mesh%n_elements/4))
      end if
   end subroutine reserve_mesh

   !> Adds a node. known: the id was there already, and nothing is changed.
   pure subroutine add_node(mesh, id, x, known)
      type(mesh_t), intent(inout) :: mesh           !< gets one node more, behind the others
      integer(ip), intent(in) :: id                 !< > 0
      real(wp), intent(in) :: x(2)                  !< coordinates [L]
      logical, intent(out) :: known                 !< the id was there already

      call add_id(mesh%node_map, id, mesh%n_nodes + 1, known)
      if (known) return
      if (.not. allocated(mesh%node_id)) call reserve_mesh(mesh, 0_ip, 0_ip)
      if (mesh%n_nodes == size(mesh%node_id)) call resize_nodes(mesh, 2*mesh%n_nodes + 64)
      mesh%n_nodes = mesh%n_nodes + 1
      mesh%node_id(mesh%n_nodes) = id
      mesh%x(:, mesh%n_nodes) = x
   end subroutine add_node

   !> Adds an element. known: the id was there already, and nothing is changed.
   pure subroutine add_element(mesh, id, state, nodes, known)
      type(mesh_t), intent(inout) :: mesh           !< gets one element more, behind the others
      integer(ip), intent(in) :: id                 !< > 0
      integer(ip), intent(in) :: state              !< place in STATES
      integer(ip), intent(in) :: nodes(:)           !< places of its nodes, as many as its shape has
      logical, intent(out) :: known                 !< the id was there already
      integer(ip) :: e

      call add_id(mesh%element_map, id, mesh%n_elements + 1, known)
      if (known) return
      if (.not. allocated(mesh%element_id)) call reserve_mesh(mesh, 0_ip, 0_ip)
      if (mesh%n_elements == size(mesh%element_id)) call resize_elements(mesh, 2*mesh%n_elements + 64)
      e = mesh%n_elements + 1
      mesh%n_elements = e
      mesh%element_id(e) = id
      mesh%state(e) = state
      mesh%shape(e) = size(nodes, kind=ip)
      mesh%nodes(:, e) = 0
      mesh%nodes(:size(nodes), e) = nodes
   end subroutine add_element

   !> Adds nodes with the numbers first_id, first_id + 1, ..., none of which is there yet.
   subroutine add_nodes(mesh, first_id, x)
      type(mesh_t), intent(inout) :: mesh           !< gets the nodes behind the others
      integer(ip), intent(in) :: first_id           !< > 0
      real(wp), intent(in) :: x(:, :)               !< (2, new nodes) [L]
      integer(ip) :: k, n, before

      n = size(x, 2, kind=ip)
      before = mesh%n_nodes
      call reserve_mesh(mesh, n, 0_ip)
      call add_sequence(mesh%node_map, first_id, before + 1, n)
      !$omp parallel do default(none) shared(mesh, first_id, x, n, before) if(is_shared(n))
      do k = 1, n
         mesh%node_id(before + k) = first_id + k - 1
         mesh%x(:, before + k) = x(:, k)
      end do
      !$omp end parallel do
      mesh%n_nodes = before + n
   end subroutine add_nodes

   !> Adds the elements of a block, row by row, triangles in twos, with the numbers first_id, first_id + 1, ..., none of
   !> which is there yet.
   subroutine add_block(mesh, first_id, state, shape, nodes)
      type(mesh_t), intent(inout) :: mesh           !< gets the elements behind the others
      integer(ip), intent(in) :: first_id           !< > 0
      integer(ip), intent(in) :: state              !< place in STATES
      integer(ip), intent(in) :: shape              !< place in SHAPES
      integer(ip), intent(in) :: nodes(0:, 0:)      !< places, in lines along the block, (degree nx + 1, degree ny + 1)
      integer(ip) :: i, j, order, per, e, nx, ny, before

      order = SHAPES(shape)%degree
      per = elements_of_square(shape)
      nx = ubound(nodes, 1, kind=ip)/order
      ny = ubound(nodes, 2, kind=ip)/order
      before = mesh%n_elements
      call reserve_mesh(mesh, 0_ip, per*nx*ny)
      call add_sequence(mesh%element_map, first_id, before + 1, per*nx*ny)
      !$omp parallel do default(none) private(i, e) shared(mesh, shape, order, per, nodes, nx, ny, before) &
      !$omp if(is_shared(nx*ny))
      do j = 0, ny - 1
         do i = 0, nx - 1
            e = before + per*(j*nx + i) + 1
            if (per == 1) then
               mesh%nodes(:shape, e) = nodes_of_square(shape, nodes(order*i:order*(i + 1), order*j:order*(j + 1)))
            else
               mesh%nodes(:shape, e:e + 1) = triangles_of_square(nodes(order*i:order*(i + 1), order*j:order*(j + 1)))
            end if
            mesh%nodes(shape + 1:, e:e + per - 1) = 0
         end do
      end do
      !$omp end parallel do
      mesh%n_elements = before + per*nx*ny
      do e = before + 1, mesh%n_elements
         mesh%element_id(e) = first_id + (e - before - 1)
         mesh%state(e) = state
         mesh%shape(e) = shape
      end do
   end subroutine add_block

   !> Gives back the room that was kept for growing; to be called when the mesh is complete.
   pure subroutine trim_mesh(mesh)
      type(mesh_t), intent(inout) :: mesh !< arrays become as long as they need to be

      call reserve_mesh(mesh, 0_ip, 0_ip)
      if (size(mesh%node_id) > mesh%n_nodes) call resize_nodes(mesh, mesh%n_nodes)
      if (size(mesh%element_id) > mesh%n_elements) call resize_elements(mesh, mesh%n_elements)
   end subroutine trim_mesh

   pure subroutine resize_nodes(mesh, length)
      type(mesh_t), intent(inout) :: mesh
      integer(ip), intent(in) :: length

      call resize(mesh%node_id, mesh%n_nodes, length)
      call resize(mesh%x, mesh%n_nodes, length)
   end subroutine resize_nodes

   pure subroutine resize_elements(mesh, length)
      type(mesh_t), intent(inout) :: mesh
      integer(ip), intent(in) :: length

      call resize(mesh%element_id, mesh%n_elements, length)
      call resize(mesh%shape, mesh%n_elements, length)
      call resize(mesh%state, mesh%n_elements, length)
      call resize(mesh%nodes, mesh%n_elements, length)
   end subroutine resize_elements

   !> Place of a node by the user's number; 0 when there is none.
   pure integer(ip) function find_node(mesh, id)
      type(mesh_t), intent(in) :: mesh !< its map of node numbers is read
      integer(ip), intent(in) :: id    !< the user's number

      find_node = find_id(mesh%node_map, id)
   end function find_node

   !> Place of an element by the user's number; 0 when there is none.
   pure integer(ip) function find_element(mesh, id)
      type(mesh_t), intent(in) :: mesh !< its map of element numbers is read
      integer(ip), intent(in) :: id    !< the user's number

      find_element = find_id(mesh%element_map, id)
   end function find_element

   !> Nodes of a face in the direction of travel (counter-clockwise round the element): first, last, and middle if there is one.
   pure function face_nodes(mesh, element, face) result(nodes)
      type(mesh_t), intent(in) :: mesh              !< nodes of the element are read
      integer(ip), intent(in) :: element, face      !< face 1..4
      integer(ip), allocatable :: nodes(:)

      nodes = [mesh%nodes(face, element), mesh%nodes(face_end(mesh, element, face), element)]
      if (middle_node(mesh, element, face) > 0) nodes = [nodes, middle_node(mesh, element, face)]
   end function face_nodes

   !> Whether the elements are the section of a body of revolution: all are, or none.
   pure logical function is_revolved(mesh)
      type(mesh_t), intent(in) :: mesh !< the state of its first element is read

      is_revolved = .false.
      if (mesh%n_elements > 0) is_revolved = STATES(mesh%state(1))%has_hoop
   end function is_revolved

   !> Faces of an element, and its corners.
   pure integer(ip) function side_count(mesh, element)
      type(mesh_t), intent(in) :: mesh   !< shape of the element is read
      integer(ip), intent(in) :: element !< place in the mesh

      side_count = CORNERS_OF(mesh%shape(element))
   end function side_count

   !> Local corner at which a face ends; it begins at the corner of its own number.
   pure integer(ip) function face_end(mesh, element, face)
      type(mesh_t), intent(in) :: mesh         !< shape of the element is read
      integer(ip), intent(in) :: element, face !< place in the mesh; 1..4

      face_end = mod(face, side_count(mesh, element)) + 1
   end function face_end

   !> The node in the middle of a face; 0 where there is none.
   pure integer(ip) function middle_node(mesh, element, face)
      type(mesh_t), intent(in) :: mesh         !< nodes of the element are read
      integer(ip), intent(in) :: element, face !< place in the mesh; 1..4

      associate (shape => SHAPES(mesh%shape(element)))
         middle_node = 0
         if (shape%degree > 1) middle_node = mesh%nodes(shape%n_corners + face, element)
      end associate
   end function middle_node

   !> The side of an element from one corner to another, with this node in its middle (0: none); 0: the element has none.
   pure integer(ip) function side_between(mesh, element, from, to, middle) result(side)
      type(mesh_t), intent(in) :: mesh              !< nodes of the element are read
      integer(ip), intent(in) :: element, from, to  !< place in the mesh; places of the two corners
      integer(ip), intent(in), optional :: middle   !< left out: any or none

      do side = 1, side_count(mesh, element)
         if (mesh%nodes(side, element) /= from .or. mesh%nodes(face_end(mesh, element, side), element) /= to) cycle
         if (.not. present(middle)) return
         if (middle_node(mesh, element, side) == middle) return
      end do
      side = 0
   end function side_between

   !> The nodes of an element from their square of 2 x 2 or 3 x 3: corners counter-clockwise, mid-sides, centre.
   pure function nodes_of_square(shape, square) result(nodes)
      integer(ip), intent(in) :: shape              !< place in SHAPES
      integer(ip), intent(in) :: square(:, :)       !< (2, 2) or (3, 3): place of the node at (i, j)
      integer(ip) :: nodes(shape)
      integer(ip) :: n

      n = size(square, 1, kind=ip)
      nodes(:4) = [square(1, 1), square(n, 1), square(n, n), square(1, n)]
      if (n == 3) nodes(5:8) = [square(2, 1), square(3, 2), square(2, 3), square(1, 2)]
      if (shape == 9) nodes(9) = square(2, 2)
   end function nodes_of_square

   !> Elements of a block in one of its squares.
   pure integer(ip) function elements_of_square(shape)
      integer(ip), intent(in) :: shape              !< place in SHAPES

      elements_of_square = 5 - SHAPES(shape)%n_corners
   end function elements_of_square

   !> Whether a place of the grid of nodes of such elements, from 0 at a corner, has none: the middle of an element of eight nodes.
   pure logical function is_hollow(shape, i, j)
      integer(ip), intent(in) :: shape !< place in SHAPES
      integer(ip), intent(in) :: i, j  !< intervals from the corner, >= 0

      is_hollow = SHAPES(shape)%hollow .and. mod(i, 2_ip) == 1 .and. mod(j, 2_ip) == 1
   end function is_hollow

   !> Coordinates [L] of an element's nodes, (2, shape).
   pure function element_coordinates(mesh, element) result(x)
      type(mesh_t), intent(in) :: mesh   !< coordinates and nodes of the element are read
      integer(ip), intent(in) :: element !< place in the mesh
      real(wp) :: x(2, mesh%shape(element))

      x = mesh%x(:, mesh%nodes(:mesh%shape(element), element))
   end function element_coordinates

   !> Signed area [L^2] of the polygon of an element's corners, positive when they run counter-clockwise.
   pure real(wp) function signed_area(mesh, element) result(area)
      type(mesh_t), intent(in) :: mesh   !< coordinates of the corners are read
      integer(ip), intent(in) :: element !< place in the mesh
      real(wp) :: d(2), e(2)

      d = mesh%x(:, mesh%nodes(3, element)) - mesh%x(:, mesh%nodes(1, element))
      ! of a triangle the last corner is the third: sides 1-3 and 2-3, whose cross product is the same
      e = mesh%x(:, mesh%nodes(side_count(mesh, element), element)) - mesh%x(:, mesh%nodes(2, element))
      area = 0.5_wp*(d(1)*e(2) - d(2)*e(1))
   end function signed_area

   !> The nodes of an element the other way round, from the same first corner.
   pure function turned_nodes(nodes) result(turned)
      integer(ip), intent(in) :: nodes(:)              !< as many as the shape has: corners, mid-sides, centre
      integer(ip) :: turned(size(nodes))

      associate (n => CORNERS_OF(size(nodes)))
         turned = nodes
         turned(2:n) = nodes(n:2:-1)
         if (size(nodes) > n) turned(n + 1:2*n) = nodes(2*n:n + 1:-1)
      end associate
   end function turned_nodes

   !> The polygon of the corners has a negative area.
   pure logical function is_clockwise(x)
      real(wp), intent(in) :: x(:, :)                  !< (2, corners) [L]
      real(wp) :: d(2), e(2)

      d = x(:, 3) - x(:, 1)
      e = x(:, size(x, 2)) - x(:, 2)                   ! of a triangle the third corner is the last: the same area
      is_clockwise = d(1)*e(2) - d(2)*e(1) < 0.0_wp
   end function is_clockwise

end module atrito_mesh
