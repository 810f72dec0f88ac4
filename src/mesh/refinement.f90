!> Uniform refinement: every element into pieces x pieces of the same shape, or all of one shape with as many corners, on the
!> isoparametric map of its parent, so that curved edges stay what they are. Nodes of the coarse mesh keep their places; those on
!> edges follow, then those inside elements.
!>
!> Cut into m x m pieces of degree p a square has the grid of its nodes at (i/n, j/n), i, j = 0..n with n = m p intervals: 4 nodes
!> of the parent, n - 1 on each edge, (n - 1)^2 inside; a triangle, i + j <= n, has (n - 1)(n - 2)/2 inside. Where the parent has
!> nodes on its edges or in its centre these are nodes of the grid already (n is even then) and are not made again; pieces without a
!> centre node leave m^2 places of the grid empty. These counts give every edge and every element the number of its first new node
!> (edge_first, inner_first), and from these alone any node's number follows: no search, and neighbours agree on their edge.
module atrito_refinement
   use atrito_element_table, only: SHAPES, DEGREE_OF, CORNERS_OF, MOST_NODES, MOST_SIDES
   use atrito_faces, only: find_across, node_elements_t
   use atrito_id_map, only: add_id
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: mesh_t, side_count, face_end, middle_node, nodes_of_square, is_hollow, element_coordinates
   use atrito_triangle_pieces, only: piece_of_triangle, piece_nodes, triangle_point
   implicit none (type, external)
   private
   public :: refinement_t, refine_mesh, count_fine_nodes, drops_centre, is_refined, edge_place, map_element, has_centre
   public :: begin_refinement, place_nodes

   !> How a fine mesh came from a coarse one.
   type :: refinement_t
      integer(ip) :: pieces = 1                     !< along an edge of a coarse element; 1: not refined
      integer(ip) :: shape = 0                      !< of all fine elements; 0: that of their parents
      integer(ip) :: n_nodes = 0, n_elements = 0    !< of the coarse mesh
      integer(ip) :: n_edges = 0                    !< of the coarse mesh
      integer(ip), allocatable :: edge_node(:, :)   !< (3, n_edges): first, last, middle (0 for Q1), coarse places
      integer(ip), allocatable :: edge_element(:, :) !< (2, n_edges): its elements; the second 0 on the outline
      integer(ip), allocatable :: edge_first(:)     !< (n_edges + 1): place of its first new node
      integer(ip), allocatable :: inner_first(:)    !< (n_elements + 1): place of an element's first new node inside
      integer(ip), allocatable :: face_edge(:, :)   !< (4, n_elements)
      logical, allocatable :: is_triangle(:)        !< (n_elements)
      ! Where each coarse element is cut in its own way (atrito_cut_mesh); else not allocated
      integer(ip), allocatable :: piece_first(:)    !< (n_elements + 1): its first piece
      integer(ip), allocatable :: own_face(:, :)    !< (4, fine elements): the face of a piece on each face of its parent; 0: none
      real(wp), allocatable :: edge_t(:)            !< of the new nodes on edges: 0..1 from the edge's first node
      real(wp), allocatable :: inner_place(:, :)    !< (2, ) of those inside elements: 0..1 along the sides 1-2 and 1-4, or 1-3
      logical, allocatable :: drops(:)              !< (n_elements) the node in its middle belongs to no piece
   end type refinement_t

contains

   !> Nodes of the refined mesh, before it is made.
   pure integer(lp) function count_fine_nodes(mesh, pieces, shape) result(n)
      type(mesh_t), intent(in) :: mesh              !< coarse
      integer(ip), intent(in) :: pieces             !< along an edge, >= 1
      integer(ip), intent(in) :: shape              !< of all fine elements; 0: that of their parents
      integer(lp) :: intervals
      integer(ip) :: e

      n = mesh%n_nodes
      do e = 1, mesh%n_elements
         intervals = int(SHAPES(fine_shape(mesh, shape, e))%degree, lp)*int(pieces, lp)
         ! edges between two elements are counted twice, which is no matter here
         n = n + intervals**2*(side_count(mesh, e) - 2)/2 + 2*intervals
      end do
   end function count_fine_nodes

   !> Refines a mesh.
   pure subroutine refine_mesh(mesh, around, pieces, shape, fine, refinement)
      type(mesh_t), intent(in) :: mesh              !< coarse
      type(node_elements_t), intent(in) :: around   !< elements round each node of mesh
      integer(ip), intent(in) :: pieces             !< 1, 2, 4, 8, ...: of each edge; even where nine-node elements become four-node
      integer(ip), intent(in) :: shape              !< of all fine elements; 0: that of their parents
      type(mesh_t), intent(out) :: fine             !< its elements are the pieces
      type(refinement_t), intent(out) :: refinement !< edges and new nodes of the coarse mesh

      refinement%shape = shape
      refinement%pieces = pieces
      call begin_refinement(mesh, around, refinement)
      call number_nodes(mesh, refinement)
      call place_nodes(mesh, refinement, fine)
      call place_elements(mesh, refinement, fine)
   end subroutine refine_mesh

   !> What a refinement says of the coarse mesh: its edges, each once; elements of different order do not share theirs.
   pure subroutine begin_refinement(mesh, around, refinement)
      type(mesh_t), intent(in) :: mesh                !< coarse
      type(node_elements_t), intent(in) :: around     !< elements round each node of mesh
      type(refinement_t), intent(inout) :: refinement !< edges are set, places of new nodes are not
      integer(ip) :: e, face, n, other, other_face

      refinement%n_nodes = mesh%n_nodes
      refinement%n_elements = mesh%n_elements
      refinement%is_triangle = CORNERS_OF(mesh%shape(:mesh%n_elements)) == 3
      allocate (refinement%face_edge(MOST_SIDES, mesh%n_elements), source=0_ip)
      n = MOST_SIDES*mesh%n_elements
      allocate (refinement%edge_node(3, n), refinement%edge_element(2, n), source=0_ip)
      n = 0
      do e = 1, mesh%n_elements
         do face = 1, side_count(mesh, e)
            if (refinement%face_edge(face, e) > 0) cycle
            n = n + 1
            refinement%face_edge(face, e) = n
            refinement%edge_node(:, n) = [mesh%nodes(face, e), mesh%nodes(face_end(mesh, e, face), e), middle_node(mesh, e, face)]
            refinement%edge_element(1, n) = e
            call find_across(mesh, around, e, face, other, other_face)
            if (other == 0) cycle
            refinement%face_edge(other_face, other) = n
            refinement%edge_element(2, n) = other
         end do
      end do
      refinement%n_edges = n
      refinement%edge_node = refinement%edge_node(:, :n)
      refinement%edge_element = refinement%edge_element(:, :n)
   end subroutine begin_refinement

   !> Coordinates and numbers of the nodes: new numbers follow the greatest.
   pure subroutine place_nodes(mesh, refinement, fine)
      type(mesh_t), intent(in) :: mesh             !< coarse
      type(refinement_t), intent(in) :: refinement !< edge_first and inner_first are known
      type(mesh_t), intent(inout) :: fine          !< gets nodes; it has none before
      integer(ip), allocatable :: grid(:, :)
      integer(ip) :: n, e, i, greatest
      logical :: known

      n = refinement%inner_first(mesh%n_elements + 1) - 1
      fine%n_nodes = n
      allocate (fine%node_id(n), fine%x(2, n))
      fine%x(:, :mesh%n_nodes) = mesh%x(:, :mesh%n_nodes)
      fine%node_id(:mesh%n_nodes) = mesh%node_id(:mesh%n_nodes)
      greatest = maxval(mesh%node_id(:mesh%n_nodes))
      fine%node_id(mesh%n_nodes + 1:) = [(greatest + i, i=1, n - mesh%n_nodes)]
      fine%node_map = mesh%node_map
      do i = mesh%n_nodes + 1, n
         call add_id(fine%node_map, fine%node_id(i), i, known)
      end do
      do e = 1, mesh%n_elements
         call map_element(mesh, refinement, e, fine%x, grid)
      end do
   end subroutine place_nodes

   !> Shape of the pieces of an element.
   pure integer(ip) function fine_shape(mesh, shape, element)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: shape, element

      fine_shape = shape
      if (shape == 0) fine_shape = mesh%shape(element)
   end function fine_shape

   !> Node intervals of the fine mesh along an edge of an element, and along an edge by its number.
   pure integer(ip) function element_intervals(mesh, refinement, element) result(n)
      type(mesh_t), intent(in) :: mesh
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: element

      n = SHAPES(fine_shape(mesh, refinement%shape, element))%degree*refinement%pieces
   end function element_intervals

   pure integer(ip) function edge_intervals(refinement, edge) result(n)
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: edge

      n = refinement%pieces
      if (refinement%shape > 0) then
         n = SHAPES(refinement%shape)%degree*n
      else if (refinement%edge_node(3, edge) > 0) then
         n = 2*n
      end if
   end function edge_intervals

   !> edge_first and inner_first, by the counts at the head of this file.
   pure subroutine number_nodes(mesh, refinement)
      type(mesh_t), intent(in) :: mesh
      type(refinement_t), intent(inout) :: refinement
      integer(ip) :: k, e, intervals, n

      allocate (refinement%edge_first(refinement%n_edges + 1), refinement%inner_first(mesh%n_elements + 1))
      n = mesh%n_nodes + 1
      do k = 1, refinement%n_edges
         refinement%edge_first(k) = n
         n = n + edge_intervals(refinement, k) - 1
         if (refinement%edge_node(3, k) > 0) n = n - 1
      end do
      refinement%edge_first(k) = n
      do e = 1, mesh%n_elements
         refinement%inner_first(e) = n
         intervals = element_intervals(mesh, refinement, e)
         n = n + merge(((intervals - 1)*(intervals - 2))/2, (intervals - 1)**2, refinement%is_triangle(e))
         if (SHAPES(fine_shape(mesh, refinement%shape, e))%hollow) n = n - refinement%pieces**2
         if (has_centre(mesh, e) .and. .not. drops_centre(mesh, refinement, e)) n = n - 1
      end do
      refinement%inner_first(e) = n
   end subroutine number_nodes

   !> Whether an element has a node in its centre.
   pure logical function has_centre(mesh, element)
      type(mesh_t), intent(in) :: mesh   !< shapes are read
      integer(ip), intent(in) :: element !< place in the mesh

      has_centre = mesh%shape(element) > 2*side_count(mesh, element)
   end function has_centre

   !> Whether the node in the middle of an element belongs to none of its pieces: nine nodes become eight.
   pure logical function drops_centre(mesh, refinement, element)
      type(mesh_t), intent(in) :: mesh             !< coarse
      type(refinement_t), intent(in) :: refinement !< made from `mesh`
      integer(ip), intent(in) :: element           !< place in the coarse mesh

      if (allocated(refinement%drops)) then
         drops_centre = refinement%drops(element)
      else
         drops_centre = has_centre(mesh, element) .and. is_hollow(fine_shape(mesh, refinement%shape, element), refinement%pieces, &
                                                                  refinement%pieces)
      end if
   end function drops_centre

   !> Places the new nodes of an element where its isoparametric map takes the points of a uniform grid.
   !>
   !> An edge is mapped by its own nodes alone, hence alike from both sides.
   pure subroutine map_element(mesh, refinement, element, x, grid)
      type(mesh_t), intent(in) :: mesh                        !< coarse
      type(refinement_t), intent(in) :: refinement            !< edge_first and inner_first are known
      integer(ip), intent(in) :: element                      !< place in the coarse mesh
      real(wp), intent(inout) :: x(:, :)                      !< (2, fine nodes) [L]; those of this element are set
      integer(ip), allocatable, intent(inout) :: grid(:, :)   !< room
      integer(ip) :: i, j, k, n

      if (allocated(refinement%inner_place)) then
         do k = refinement%inner_first(element), refinement%inner_first(element + 1) - 1
            x(:, k) = point_in(refinement%inner_place(:, k - refinement%inner_first(1) + 1))
         end do
      else
         call fill_grid(mesh, refinement, element, grid)
         n = ubound(grid, 1, kind=ip)
         do j = 0, n
            do i = 0, merge(n - j, n, refinement%is_triangle(element))
               k = grid(i, j)
               if (k > mesh%n_nodes) x(:, k) = point_in([real(i, wp)/real(n, wp), real(j, wp)/real(n, wp)])
            end do
         end do
      end if
      do i = 1, side_count(mesh, element)
         associate (edge => refinement%face_edge(i, element), node => refinement%edge_node(:, refinement%face_edge(i, element)))
            do k = refinement%edge_first(edge), refinement%edge_first(edge + 1) - 1
               x(:, k) = along(node(1), node(2), node(3), edge_place(refinement, edge, k))
            end do
         end associate
      end do

   contains

      !> The point of an element at s, 0..1 along its side 1-2, and t along 1-4, or 1-3 of a triangle [L].
      !>
      !> The map of a quadrilateral is a line (or a parabola, of the second degree) in s through points that lie on lines
      !> (parabolas)
      !> in t: through nodes 1 and 4, nodes 2 and 3, and the middles. The differences are formed first, so that a constant
      !> coordinate
      !> stays constant to the last bit.
      pure function point_in(place) result(x)
         real(wp), intent(in) :: place(2)              !< s, t
         real(wp) :: x(2), line(2, 3)

         associate (nodes => mesh%nodes(:, element), s => place(1), t => place(2))
            if (side_count(mesh, element) == 3) then
               x = triangle_point(element_coordinates(mesh, element), place)
               return
            end if
            line(:, 1) = along(nodes(1), nodes(4), nodes(8), t)
            line(:, 2) = along(nodes(2), nodes(3), nodes(6), t)
            if (DEGREE_OF(mesh%shape(element)) > 1) then
               line(:, 3) = parabola(mesh%x(:, nodes(5)), mesh%x(:, nodes(7)), centre_of(), t)
               x = parabola(line(:, 1), line(:, 2), line(:, 3), s)
            else
               x = line(:, 1) + s*(line(:, 2) - line(:, 1))
            end if
         end associate
      end function point_in

      !> The middle of an element of the second degree [L]; of eight nodes where their shape functions have it.
      pure function centre_of() result(x)
         real(wp) :: x(2), away(2, 8)

         associate (nodes => mesh%nodes(:, element))
            if (has_centre(mesh, element)) then
               x = mesh%x(:, nodes(9))
            else
               away = mesh%x(:, nodes(:8)) - spread(mesh%x(:, nodes(1)), 2, 8)
               x = mesh%x(:, nodes(1)) + (0.5_wp*sum(away(:, 5:), dim=2) - 0.25_wp*sum(away(:, :4), dim=2))
            end if
         end associate
      end function centre_of

      !> The point t = 0..1 of the straight line between two nodes, or of the parabola through a third one in their middle; 0: none.
      pure function along(first, last, middle, t) result(x)
         integer(ip), intent(in) :: first, last, middle
         real(wp), intent(in) :: t
         real(wp) :: x(2)

         x = mesh%x(:, first) + t*(mesh%x(:, last) - mesh%x(:, first))
         if (middle > 0) x = parabola(mesh%x(:, first), mesh%x(:, last), mesh%x(:, middle), t)
      end function along
   end subroutine map_element

   !> Place 0..1 of a new node on its coarse edge, from the edge's first node.
   pure real(wp) function edge_place(refinement, edge, node) result(t)
      type(refinement_t), intent(in) :: refinement   !< made from a coarse mesh that has this edge
      integer(ip), intent(in) :: edge, node          !< node: edge_first(edge) .. edge_first(edge + 1) - 1
      integer(ip) :: position, intervals

      if (allocated(refinement%edge_t)) then
         t = refinement%edge_t(node - refinement%n_nodes)
         return
      end if
      intervals = edge_intervals(refinement, edge)
      position = node - refinement%edge_first(edge) + 1
      if (refinement%edge_node(3, edge) > 0 .and. 2*position >= intervals) position = position + 1
      t = real(position, wp)/real(intervals, wp)
   end function edge_place

   !> The point t = 0..1 of the parabola that is at a for t = 0, at `middle` for t = 1/2 and at b for t = 1: the straight line, and
   !> 4 t (1 - t) times what the middle is off its chord by.
   pure function parabola(a, b, middle, t) result(x)
      real(wp), intent(in) :: a(2), b(2), middle(2), t
      real(wp) :: x(2)

      x = a + t*(b - a)
      x = x + 4*t*(1 - t)*((middle - a) - 0.5_wp*(b - a))
   end function parabola

   !> The places of all nodes of a refined element, from node 1 along its sides 1-2 and 1-4, (0:n, 0:n); of a triangle 1-2 and 1-3.
   pure subroutine fill_grid(mesh, refinement, element, grid)
      type(mesh_t), intent(in) :: mesh
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: element
      integer(ip), allocatable, intent(inout) :: grid(:, :)   !< kept where its size is right: there are many elements
      integer(ip), allocatable :: line(:)
      integer(ip) :: i, j, k, n

      n = element_intervals(mesh, refinement, element)
      if (allocated(grid)) then
         if (ubound(grid, 1) /= n) deallocate (grid)
      end if
      if (.not. allocated(grid)) allocate (grid(0:n, 0:n))
      call put_edge(mesh, refinement, element, 1_ip, grid(:, 0))
      if (refinement%is_triangle(element)) then                         ! its second side is the diagonal: half of the grid is used
         allocate (line(0:n))
         call put_edge(mesh, refinement, element, 2_ip, line)
         do i = 0, n
            grid(n - i, i) = line(i)
         end do
      else
         call put_edge(mesh, refinement, element, 2_ip, grid(n, :))
         call put_edge(mesh, refinement, element, 3_ip, grid(n:0:-1, n))
      end if
      call put_edge(mesh, refinement, element, side_count(mesh, element), grid(0, n:0:-1))
      k = refinement%inner_first(element)
      do j = 1, n - 1
         do i = 1, merge(n - j, n, refinement%is_triangle(element)) - 1
            if (is_hollow(fine_shape(mesh, refinement%shape, element), i, j)) then
               grid(i, j) = 0
            else if (has_centre(mesh, element) .and. 2*i == n .and. 2*j == n) then
               grid(i, j) = mesh%nodes(mesh%shape(element), element)
            else
               grid(i, j) = k
               k = k + 1
            end if
         end do
      end do
   end subroutine fill_grid

   !> The nodes of an edge in the direction in which an element travels it.
   pure subroutine put_edge(mesh, refinement, element, face, line)
      type(mesh_t), intent(in) :: mesh
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: element, face
      integer(ip), intent(inout) :: line(0:)
      integer(ip) :: edge, i, k, n

      edge = refinement%face_edge(face, element)
      n = ubound(line, 1, kind=ip)
      associate (node => refinement%edge_node(:, edge))
         line(0) = node(1)
         k = refinement%edge_first(edge)
         do i = 1, n - 1
            if (node(3) > 0 .and. 2*i == n) then
               line(i) = node(3)
            else
               line(i) = k
               k = k + 1
            end if
         end do
         line(n) = node(2)
         if (node(1) /= mesh%nodes(face, element)) line = line(n:0:-1)
      end associate
   end subroutine put_edge

   !> The pieces of an element stand together, row by row from its side 1-2; they are numbered (id - 1) pieces^2 + 1, 2, ... where
   !> these numbers are not too large, else from 1.
   pure subroutine place_elements(mesh, refinement, fine)
      type(mesh_t), intent(in) :: mesh
      type(refinement_t), intent(in) :: refinement
      type(mesh_t), intent(inout) :: fine
      integer(ip), allocatable :: grid(:, :)
      integer(ip) :: e, k, n, piece, children, shape
      logical :: known, keep

      children = refinement%pieces**2
      n = mesh%n_elements*children
      fine%n_elements = n
      allocate (fine%element_id(n), fine%shape(n), fine%state(n), fine%nodes(MOST_NODES, n))
      fine%nodes = 0
      keep = int(maxval(mesh%element_id(:mesh%n_elements)), lp)*int(children, lp) <= int(huge(1_ip), lp)
      k = 0
      do e = 1, mesh%n_elements
         call fill_grid(mesh, refinement, e, grid)
         shape = fine_shape(mesh, refinement%shape, e)
         do piece = 0, children - 1
            k = k + 1
            call take_piece(shape, refinement%pieces, piece, grid, fine%nodes(:shape, k))
            fine%element_id(k) = k
            if (keep) fine%element_id(k) = k + (mesh%element_id(e) - e)*children
            fine%shape(k) = shape
            fine%state(k) = mesh%state(e)
            call add_id(fine%element_map, fine%element_id(k), k, known)
         end do
      end do
   end subroutine place_elements

   !> The nodes of a piece of an element.
   pure subroutine take_piece(shape, pieces, piece, grid, nodes)
      integer(ip), intent(in) :: shape, pieces
      integer(ip), intent(in) :: piece               !< 0 .. pieces^2 - 1
      integer(ip), intent(in) :: grid(0:, 0:)
      integer(ip), intent(out) :: nodes(shape)
      integer(ip) :: m, place(2)
      logical :: is_turned

      m = DEGREE_OF(shape)
      if (CORNERS_OF(shape) == 3) then
         call piece_of_triangle(pieces, piece, place, is_turned)
         call piece_nodes(grid, m, place, is_turned, nodes)
      else
         place = m*[mod(piece, pieces), piece/pieces]
         nodes = nodes_of_square(shape, grid(place(1):place(1) + m, place(2):place(2) + m))
      end if
   end subroutine take_piece

   !> Whether the mesh is a refined one.
   pure logical function is_refined(refinement)
      type(refinement_t), intent(in) :: refinement !< not made, as a scene has it that is not refined

      is_refined = refinement%n_elements > 0
   end function is_refined

end module atrito_refinement
