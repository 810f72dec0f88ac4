!> The mesh of the leaves of trees (atrito_element_trees): without hanging nodes, on the map of the elements of the deck.
!>
!> A quadrilateral leaf with nodes in the middle of sides becomes pieces: three triangles with one of them, two quadrilaterals with
!> two on opposite sides, three round its centre with two on sides that meet.
!>
!> The nodes of a piece are found by their places in the element of the deck, in parts of its side: on a corner, on a side (which it
!> shares with its neighbour), or inside.
module atrito_cut_mesh
   use atrito_element_table, only: SHAPES, MOST_NODES, MOST_SIDES, kind_of
   use atrito_element_trees, only: element_trees_t, is_side_cut, list_leaves, SIDE, corner_count
   use atrito_faces, only: node_elements_t
   use atrito_id_map, only: add_id
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: mesh_t, side_count
   use atrito_plane_state, only: FULL_STATE
   use atrito_refinement, only: refinement_t, begin_refinement, has_centre, place_nodes
   use atrito_sorting, only: first_at_least, sorted_places
   implicit none (type, external)
   private
   public :: cut_mesh

   integer(ip), parameter :: MOST_PIECES = 3          !< of a leaf
   integer(lp), parameter :: ROW = 2_lp**32           !< keys of places: ROW t + s

   !> Pieces of leaves, and the places of their nodes.
   type :: pieces_t
      integer(ip) :: n = 0                            !< pieces of all leaves
      integer(ip), allocatable :: leaf(:), root(:)    !< (n) cell that is cut up; element of the deck
      integer(ip), allocatable :: shape(:)            !< place in SHAPES
      integer(ip), allocatable :: place(:, :, :)      !< (2, MOST_NODES, n)
   end type pieces_t

contains

   !> Makes the mesh of the leaves, and notes of which leaf each of its elements is.
   subroutine cut_mesh(mesh, around, trees, fine, refinement)
      type(mesh_t), intent(in) :: mesh               !< of the deck
      type(node_elements_t), intent(in) :: around    !< elements round each node of mesh
      type(element_trees_t), intent(inout) :: trees  !< `leaf_of` is set
      type(mesh_t), intent(out) :: fine              !< elements are the pieces, numbered from 1
      type(refinement_t), intent(out) :: refinement  !< places of new nodes, pieces of each element
      type(pieces_t) :: pieces
      integer(lp), allocatable :: edge_key(:), inner_key(:)

      call begin_refinement(mesh, around, refinement)
      call list_pieces(pieces)
      trees%leaf_of = pieces%leaf(:pieces%n)
      call number_nodes(mesh, pieces, refinement, edge_key, inner_key)
      call straighten()
      call place_nodes(mesh, refinement, fine)
      call place_elements(mesh, pieces, edge_key, inner_key, refinement, fine)

   contains

      !> Middles of inner sides that run aslant through an element with straight sides go to the middles of their chords; the map
      !> makes
      !> such lines curved, x = c_0 + c_1 s + c_2 t + c_3 s t, and bounds of the error ask for straight ones.
      subroutine straighten()
         integer(ip) :: i, k, n, edge, node, at
         integer(lp) :: key
         real(wp) :: ends(2, 2)

         do i = 1, pieces%n
            if (SHAPES(pieces%shape(i))%degree == 1) cycle
            if (refinement%is_triangle(pieces%root(i))) cycle
            if (.not. is_bilinear(mesh, pieces%root(i))) cycle
            n = SHAPES(pieces%shape(i))%n_corners
            do k = 1, n
               ends = real(pieces%place(:, [k, mod(k, n) + 1], i), wp)/SIDE
               if (any(ends(:, 1) == ends(:, 2))) cycle
               call sort_place(mesh, refinement, pieces%root(i), pieces%place(:, n + k, i), edge, key, node)
               if (node > 0 .or. edge > 0) cycle
               associate (first => refinement%inner_first(pieces%root(i)), last => refinement%inner_first(pieces%root(i) + 1) - 1, &
                          before => refinement%inner_first(1) - 1)
                  at = first - 1 + first_at_least(inner_key(first - before:last - before), key) - before
               end associate
               refinement%inner_place(:, at) = chord_middle(mesh%x(:, mesh%nodes(:4, pieces%root(i))), ends)
            end do
         end do
      end subroutine straighten

      !> The pieces of all leaves: by their element of the deck, then by their middles row by row from its first side.
      !>
      !> Places are whole numbers (s, t), 0..SIDE along the sides 1-2 and 1-4 (or 1-3) of the element of the deck: halving loses
      !> nothing, equal places are equal numbers, and a node that two pieces share is one key, ROW t + s, without a tolerance. The
      !> middle of 3 or 4 corners is their sum over 3 or 4, taken times 12/16 to stay whole and within the key.
      subroutine list_pieces(pieces)
         type(pieces_t), intent(out) :: pieces
         integer(ip), allocatable :: leaves(:), order(:)
         integer(lp), allocatable :: key(:)
         integer(lp) :: middle(2)
         integer(ip) :: corners(2, 4, MOST_PIECES), sizes(MOST_PIECES), i, k, n

         leaves = list_leaves(trees)
         n = MOST_PIECES*size(leaves, kind=ip)
         allocate (pieces%leaf(n), pieces%root(n), pieces%shape(n), pieces%place(2, MOST_NODES, n), key(n))
         n = 0
         do i = 1, size(leaves, kind=ip)
            call cut_leaf(trees, leaves(i), corners, sizes)
            do k = 1, count(sizes > 0, kind=ip)
               n = n + 1
               pieces%leaf(n) = leaves(i)
               pieces%root(n) = trees%root(leaves(i))
               pieces%shape(n) = mesh%shape(pieces%root(n))
               associate (shape => SHAPES(pieces%shape(n)))    ! triangles among quadrilaterals have their degree
                  if (shape%n_corners /= sizes(k)) pieces%shape(n) = sizes(k)*shape%degree
               end associate
               call fill_places(pieces%shape(n), corners(:, :sizes(k), k), pieces%place(:, :, n))
               associate (place => pieces%place(:, :sizes(k), n))
                  middle = (12/sizes(k))*sum(int(place, lp), dim=2)/16  ! places are multiples of 32
                  key(n) = ROW*middle(2) + middle(1)
               end associate
            end do
         end do
         pieces%n = n
         order = sorted_places(key(:n))
         order = order(sorted_places(int(pieces%root(order), lp)))
         pieces%leaf = pieces%leaf(order)
         pieces%root = pieces%root(order)
         pieces%shape = pieces%shape(order)
         pieces%place = pieces%place(:, :, order)
      end subroutine list_pieces
   end subroutine cut_mesh

   !> The corners of a leaf's pieces: as it is, or with a node m (and o) in the middle of sides that a neighbour has cut.
   !>
   !>     4-----------3      4-----o-----3      4-----------3
   !>     | \       / |      |     |     |      | \         |
   !>     |   \   /   |      |     |     |      |   \ c-----o
   !>     |     \/    |      |     |     |      |     |     |
   !>     1-----m-----2      1-----m-----2      1-----m-----2
   !>
   !> The leaf is turned first so that its side 1 is cut, of two that meet the one that comes first. Trees are cut so that no side
   !> has two nodes in its middle and no leaf more than two such sides.
   subroutine cut_leaf(trees, leaf, corners, sizes)
      type(element_trees_t), intent(in) :: trees
      integer(ip), intent(in) :: leaf
      integer(ip), intent(out) :: corners(2, 4, MOST_PIECES)
      integer(ip), intent(out) :: sizes(MOST_PIECES) !< corners of each; 0: there are no more
      integer(ip), allocatable :: p(:, :)            ! corners, beginning at the first side that is cut
      integer(ip) :: m(2), other(2), i
      logical :: is_cut(4)

      p = trees%place(:, :corner_count(trees, leaf), leaf)
      is_cut = .false.
      if (size(p, 2) == 4) is_cut = [(is_side_cut(trees, leaf, i), i=1, 4)]
      sizes = 0
      corners = 0
      if (.not. any(is_cut)) then
         call put(p)
         return
      end if
      i = findloc(is_cut, .true., dim=1, kind=ip)
      if (is_cut(4) .and. is_cut(1)) i = 4           ! of two neighbours the first
      p = cshift(p, i - 1, dim=2)
      is_cut = cshift(is_cut, i - 1)
      m = (p(:, 1) + p(:, 2))/2
      if (is_cut(2)) then
         other = (p(:, 2) + p(:, 3))/2
         associate (centre => (p(:, 1) + p(:, 3))/2)
            call put(reshape([m, p(:, 2), other, centre], [2, 4]))
            call put(reshape([p(:, 1), m, centre, p(:, 4)], [2, 4]))
            call put(reshape([centre, other, p(:, 3), p(:, 4)], [2, 4]))
         end associate
      else if (is_cut(3)) then
         other = (p(:, 3) + p(:, 4))/2
         call put(reshape([p(:, 1), m, other, p(:, 4)], [2, 4]))
         call put(reshape([m, p(:, 2), p(:, 3), other], [2, 4]))
      else
         call put(reshape([p(:, 1), m, p(:, 4)], [2, 3]))
         call put(reshape([m, p(:, 2), p(:, 3)], [2, 3]))
         call put(reshape([m, p(:, 3), p(:, 4)], [2, 3]))
      end if

   contains

      subroutine put(piece)
         integer(ip), intent(in) :: piece(:, :)
         integer(ip) :: k

         k = count(sizes > 0, kind=ip) + 1
         sizes(k) = size(piece, 2, kind=ip)
         corners(:, :sizes(k), k) = piece
      end subroutine put

   end subroutine cut_leaf

   !> The places of a piece's nodes: corners, middles of sides, centre.
   pure subroutine fill_places(shape, corners, place)
      integer(ip), intent(in) :: shape
      integer(ip), intent(in) :: corners(:, :)
      integer(ip), intent(out) :: place(2, MOST_NODES)
      integer(ip) :: n

      n = size(corners, 2, kind=ip)
      place = 0
      place(:, :n) = corners
      if (SHAPES(shape)%degree > 1) place(:, n + 1:2*n) = (corners + cshift(corners, 1, dim=2))/2
      if (shape > 2*n) place(:, shape) = sum(corners, dim=2)/n
   end subroutine fill_places

   !> Whether a place lies on a side of an element.
   pure logical function is_on(place, side_number, is_triangle)
      integer(ip), intent(in) :: place(2), side_number
      logical, intent(in) :: is_triangle

      select case (side_number)
      case (1)
         is_on = place(2) == 0
      case (2)
         is_on = place(1) + merge(place(2), 0_ip, is_triangle) == SIDE
      case (3)
         is_on = merge(place(1) == 0, place(2) == SIDE, is_triangle)
      case default
         is_on = place(1) == 0
      end select
   end function is_on

   !> Where a place of an element is kept: edge and key on it, or edge 0 and the key inside; node: of the deck, or 0.
   !>
   !> A place on an edge is told by how far it is from the first node of the edge, whichever of the two elements asks, so both find
   !> the same node without comparing coordinates. Places are whole numbers (parts of a side of SIDE), and so are all middles.
   pure subroutine sort_place(mesh, refinement, e, place, edge, key, node)
      type(mesh_t), intent(in) :: mesh
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: e
      integer(ip), intent(in) :: place(2)
      integer(ip), intent(out) :: edge, node
      integer(lp), intent(out) :: key
      integer(ip) :: i, t

      edge = 0
      node = 0
      key = ROW*int(place(2), lp) + int(place(1), lp)
      do i = 1, side_count(mesh, e)
         if (.not. is_on(place, i, refinement%is_triangle(e))) cycle
         ! How far a place on a side is from where the side begins.
         select case (i)
         case (1)
            t = place(1)
         case (2)
            t = place(2)
         case (3)
            t = SIDE - merge(place(2), place(1), refinement%is_triangle(e))
         case default
            t = SIDE - place(2)
         end select
         if (t == 0) node = mesh%nodes(i, e)
         if (t == SIDE) cycle                         ! where the next one begins
         edge = refinement%face_edge(i, e)
         if (refinement%edge_node(1, edge) /= mesh%nodes(i, e)) t = SIDE - t
         if (node == 0 .and. t == SIDE/2) node = refinement%edge_node(3, edge)
         key = int(t, lp)
         return
      end do
      if (has_centre(mesh, e) .and. all(place == SIDE/2)) node = mesh%nodes(mesh%shape(e), e)
   end subroutine sort_place

   !> New nodes: on each edge from its first node on, then inside each element row by row.
   !>
   !> A place is kept with the edge that it lies on, as its distance from where the edge begins, or inside its element, as row and
   !> column. Of the two elements at an edge the first lists the places there; both find the same numbers later, since the keys are
   !> whole numbers and sorted (append_keys). So a node on an edge is made once, and no coordinates are compared. Nodes of the deck
   !> are not made again.
   subroutine number_nodes(mesh, pieces, refinement, edge_key, inner_key)
      type(mesh_t), intent(in) :: mesh
      type(pieces_t), intent(in) :: pieces
      type(refinement_t), intent(inout) :: refinement
      integer(lp), allocatable, intent(out) :: edge_key(:), inner_key(:) !< of the new nodes, in their order
      integer(lp), allocatable :: keys(:)
      integer(ip), allocatable :: edges(:)
      integer(ip) :: e, i, k, n, first, last, node, edge, n_edge, n_inner, centre
      integer(lp) :: key

      n = sum(pieces%shape(:pieces%n))
      allocate (edge_key(n), inner_key(n))
      allocate (refinement%edge_first(refinement%n_edges + 1), refinement%inner_first(mesh%n_elements + 1))
      allocate (refinement%piece_first(mesh%n_elements + 1), refinement%drops(mesh%n_elements))
      n_edge = 0
      n_inner = 0
      last = 0
      do e = 1, mesh%n_elements
         first = last + 1
         refinement%piece_first(e) = first
         do while (last < pieces%n)
            if (pieces%root(last + 1) /= e) exit
            last = last + 1
         end do
         n = sum(pieces%shape(first:last))
         allocate (keys(n), edges(n))
         n = 0
         centre = 0
         do i = first, last
            do k = 1, pieces%shape(i)
               call sort_place(mesh, refinement, e, pieces%place(:, k, i), edge, key, node)
               if (node > 0 .and. edge == 0) centre = node
               if (node > 0) cycle
               if (edge > 0) then
                  if (refinement%edge_element(1, edge) /= e) cycle
               end if
               n = n + 1
               keys(n) = key
               edges(n) = edge
            end do
         end do
         refinement%drops(e) = has_centre(mesh, e) .and. centre == 0
         do i = 1, side_count(mesh, e)
            edge = refinement%face_edge(i, e)
            if (refinement%edge_element(1, edge) /= e) cycle
            refinement%edge_first(edge) = mesh%n_nodes + n_edge + 1     ! edges are numbered in this order
            call append_keys(pack(keys(:n), edges(:n) == edge), edge_key, n_edge)
         end do
         refinement%inner_first(e) = n_inner + 1
         call append_keys(pack(keys(:n), edges(:n) == 0), inner_key, n_inner)
         deallocate (keys, edges)
      end do
      refinement%piece_first(e) = last + 1
      refinement%inner_first(e) = n_inner + 1
      refinement%edge_first(refinement%n_edges + 1) = mesh%n_nodes + n_edge + 1
      refinement%inner_first = refinement%inner_first + mesh%n_nodes + n_edge
      edge_key = edge_key(:n_edge)
      inner_key = inner_key(:n_inner)
      refinement%edge_t = real(edge_key, wp)/SIDE
      allocate (refinement%inner_place(2, n_inner))
      refinement%inner_place(1, :) = real(mod(inner_key, ROW), wp)/SIDE
      refinement%inner_place(2, :) = real(inner_key/ROW, wp)/SIDE
   end subroutine number_nodes

   !> Whether middles of sides and the centre are where the corners alone would have them.
   pure logical function is_bilinear(mesh, e)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e
      real(wp), parameter :: STRAIGHT = 1.0e-10_wp   !< of an element's size
      real(wp) :: x(2, MOST_NODES), off
      integer(ip) :: k

      x(:, :mesh%shape(e)) = mesh%x(:, mesh%nodes(:mesh%shape(e), e))
      off = 0.0_wp
      do k = 1, min(4_ip, mesh%shape(e) - 4)
         off = max(off, norm2(x(:, 4 + k) - 0.5_wp*(x(:, k) + x(:, mod(k, 4) + 1))))
      end do
      if (has_centre(mesh, e)) off = max(off, norm2(x(:, mesh%shape(e)) - 0.25_wp*sum(x(:, :4), dim=2)))
      is_bilinear = off <= STRAIGHT*norm2(x(:, 3) - x(:, 1))
   end function is_bilinear

   !> The place of the middle between two places of an element, by Newton's method from the middle of the places.
   pure function chord_middle(x, ends) result(place)
      real(wp), intent(in) :: x(:, :)                !< (2, 4) corners [L]
      real(wp), intent(in) :: ends(2, 2)             !< places, 0 to 1
      real(wp) :: place(2)
      real(wp) :: a(2), b(2), c(2), r(2), j(2, 2)
      integer :: i

      a = x(:, 2) - x(:, 1)
      b = x(:, 4) - x(:, 1)
      c = x(:, 1) - x(:, 2) + x(:, 3) - x(:, 4)
      place = 0.5_wp*sum(ends, dim=2)
      do i = 1, 6
         r = 0.5_wp*(a*sum(ends(1, :)) + b*sum(ends(2, :)) + c*sum(ends(1, :)*ends(2, :))) &
             - a*place(1) - b*place(2) - c*place(1)*place(2)
         j(:, 1) = a + c*place(2)
         j(:, 2) = b + c*place(1)
         place = place + [j(2, 2)*r(1) - j(1, 2)*r(2), j(1, 1)*r(2) - j(2, 1)*r(1)]/(j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1))
      end do
   end function chord_middle

   !> Appends keys in rising order, each once.
   subroutine append_keys(keys, list, n)
      integer(lp), intent(in) :: keys(:)
      integer(lp), intent(inout) :: list(:)
      integer(ip), intent(inout) :: n
      integer(lp) :: before
      integer(ip) :: order(size(keys)), i

      order = sorted_places(keys)
      before = -1
      do i = 1, size(keys, kind=ip)
         if (keys(order(i)) == before) cycle
         before = keys(order(i))
         n = n + 1
         list(n) = before
      end do
   end subroutine append_keys

   !> The elements are the pieces, numbered from 1. A node is found by halves by its key among the rising ones of its edge, or of
   !> those inside its element of the deck.
   subroutine place_elements(mesh, pieces, edge_key, inner_key, refinement, fine)
      type(mesh_t), intent(in) :: mesh
      type(pieces_t), intent(in) :: pieces
      integer(lp), intent(in) :: edge_key(:), inner_key(:)
      type(refinement_t), intent(inout) :: refinement
      type(mesh_t), intent(inout) :: fine
      integer(ip) :: e, i, k, n, root
      logical :: known

      n = pieces%n
      fine%n_elements = n
      fine%shape = pieces%shape(:n)
      fine%element_id = [(e, e=1, n)]
      allocate (fine%state(n), fine%nodes(MOST_NODES, n), refinement%own_face(MOST_SIDES, n))
      fine%nodes = 0
      do e = 1, n
         root = pieces%root(e)
         do k = 1, fine%shape(e)
            fine%nodes(k, e) = node_at(root, pieces%place(:, k, e))
         end do
         fine%state(e) = mesh%state(root)
         if (kind_of(fine%shape(e), fine%state(e)) == 0) fine%state(e) = FULL_STATE(fine%state(e)) ! triangles are never reduced
         call add_id(fine%element_map, e, e, known)
         refinement%own_face(:, e) = [(own_face(pieces%place(:, :side_count(fine, e), e), i, refinement%is_triangle(root)), &
                                       i=1, MOST_SIDES)]
      end do

   contains

      pure integer(ip) function node_at(root, place) result(node)
         integer(ip), intent(in) :: root, place(2)
         integer(ip) :: edge
         integer(lp) :: key

         call sort_place(mesh, refinement, root, place, edge, key, node)
         if (node > 0) return
         if (edge > 0) then
            associate (first => refinement%edge_first(edge), last => refinement%edge_first(edge + 1) - 1)
               node = first - 1 + first_at_least(edge_key(first - mesh%n_nodes:last - mesh%n_nodes), key)
            end associate
         else
            associate (first => refinement%inner_first(root), last => refinement%inner_first(root + 1) - 1, &
                       before => refinement%inner_first(1) - 1)
               node = first - 1 + first_at_least(inner_key(first - before:last - before), key)
            end associate
         end if
      end function node_at

   end subroutine place_elements

   !> The side of a piece that lies on a side of its element; 0: none does.
   pure integer(ip) function own_face(corners, side_number, is_triangle) result(own)
      integer(ip), intent(in) :: corners(:, :)
      integer(ip), intent(in) :: side_number         !< of the element
      logical, intent(in) :: is_triangle             !< the element is one
      integer(ip) :: n

      n = size(corners, 2, kind=ip)
      if (.not. (is_triangle .and. side_number == 4)) then
         do own = 1, n
            if (is_on(corners(:, own), side_number, is_triangle) .and. &
                is_on(corners(:, mod(own, n) + 1), side_number, is_triangle)) return
         end do
      end if
      own = 0
   end function own_face

end module atrito_cut_mesh
