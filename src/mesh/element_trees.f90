!> Elements of the deck cut where that is asked for, their parts again, and so on: trees, whose leaves are what the mesh is made of
!> (atrito_cut_mesh).
!>
!> A quadrilateral is cut into four. A leaf beside a finer one has a node of that in the middle of a side: leaves are cut besides
!> until none has a side cut twice, and none more than two such nodes. It gets pieces then that need no node in the middle of a
!> side, which are no leaves, so that they are never cut themselves.
!>
!> Of a slender quadrilateral no triangle is made that were more slender still: with a node in the middle of a short side it gets
!> one on the side opposite, too, and is two, and so on from neighbour to neighbour.
!>
!> A triangle is cut in two, from its newest vertex to the middle of the side opposite (W. F. Mitchell, ACM Trans. Math. Softw. 15,
!> 1989), first of its longest; its neighbours are cut until no node lies in the middle of a side.
!>
!> Sides that belong together though each has its own nodes (the two of a contact pair that match, ties, equations of two nodes)
!> have the same corners here, so that they are cut alike.
!>
!> Trees as words, for decks: of an element a letter a cell, C where it is cut and L where it is a leaf, each followed by those of
!> its parts; leaves at the end are left out. CLC is an element that is cut, and its second part, too.
module atrito_element_trees
   use atrito_growth, only: growing_text_t, append_text, make_room, resize
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, side_count
   implicit none (type, external)
   private
   public :: code_of_tree, take_code
   public :: element_trees_t, begin_trees, cut_all, cut_cell, cut_leaves, count_leaves, is_side_cut, list_leaves
   public :: part_count
   public :: SIDE, MOST_CUTS, corner_count

   integer(ip), parameter :: SIDE = 2_ip**28          !< of an element of the deck, by which places in it are counted
   integer(ip), parameter :: MOST_CUTS = 22           !< of an element into four: middles of pieces still are whole numbers
   real(wp), parameter :: SLENDER = 3.0_wp            !< length over width
   real(wp), parameter :: ALIKE = 1.0e-9_wp           !< lengths that differ by less, relatively, are the same
   !> Places of the corners of elements.
   integer(ip), parameter :: SQUARE(2, 4) = SIDE*reshape([integer(ip) :: 0, 0, 1, 0, 1, 1, 0, 1], [2, 4])
   integer(ip), parameter :: TRIANGLE(2, 4) = SIDE*reshape([integer(ip) :: 0, 0, 1, 0, 0, 1, 0, 0], [2, 4])

   !> The cells: elements of the deck in their order, then their parts.
   type :: element_trees_t
      integer(ip) :: n = 0                            !< cells; 0: there are no trees
      integer(ip) :: n_roots = 0                      !< elements of the deck
      integer(ip), allocatable :: root_id(:)          !< their numbers
      integer(ip), allocatable :: short_side(:)       !< of a slender one: 1 or 2, with the side opposite; else 0
      integer(ip), allocatable :: first_child(:)      !< of four, or two of a triangle; 0: a leaf
      integer(ip), allocatable :: root(:)             !< element of the deck
      integer(ip), allocatable :: place(:, :, :)      !< (2, 4, cells) of corners, along the sides 1-2 and 1-4 (1-3) of the root
      integer(ip), allocatable :: corner(:, :)        !< (4, cells) vertices; of triangles the third is the newest, the fourth 0
      integer(ip) :: n_vertices = 0                   !< nodes of the deck, middles of sides and centres
      integer(ip) :: n_edges = 0                      !< sides that have been cut
      integer(ip), allocatable :: first_edge(:)       !< of a vertex: to others of greater number; 0: none
      integer(ip), allocatable :: edge_end(:), edge_middle(:), next_edge(:)  !< the other end, the vertex in its middle or 0
      integer(ip), allocatable :: leaf_of(:)          !< leaf of each element of the present mesh, set where that is made
   end type element_trees_t

   character(len=1), parameter :: CUT = 'C', LEAF = 'L'

contains

   !> The elements of the deck, none of which is cut.
   pure subroutine begin_trees(mesh, partner, trees)
      type(mesh_t), intent(in) :: mesh                !< of the deck; its elements become the roots
      integer(ip), intent(in) :: partner(:)           !< of each node: itself, or the node with which it is one vertex
      type(element_trees_t), intent(out) :: trees     !< a leaf for each element
      integer(ip) :: e, n, i
      real(wp) :: length(4)

      trees%n_roots = mesh%n_elements
      trees%root_id = mesh%element_id(:mesh%n_elements)
      trees%n_vertices = mesh%n_nodes
      allocate (trees%first_edge(mesh%n_nodes), source=0_ip)
      associate (n => mesh%n_elements)
         allocate (trees%first_child(n), trees%root(n), trees%place(2, 4, n), trees%corner(4, n))
         allocate (trees%short_side(n), source=0_ip)
      end associate
      do e = 1, mesh%n_elements
         if (side_count(mesh, e) == 4) then
            length = [(norm2(mesh%x(:, mesh%nodes(mod(i, 4_ip) + 1, e)) - mesh%x(:, mesh%nodes(i, e))), i=1, 4)]
            trees%short_side(e) = 0
            if (length(2) + length(4) > SLENDER*(length(1) + length(3))) trees%short_side(e) = 1
            if (length(1) + length(3) > SLENDER*(length(2) + length(4))) trees%short_side(e) = 2
            call add_cell(e, SQUARE, partner(mesh%nodes(:4, e)), trees)
         else
            n = longest_side(mesh, partner, e)
            call add_cell(e, reshape([cshift(TRIANGLE(:, :3), n - 1, dim=2), 0_ip, 0_ip], [2, 4]), &
                          [cshift(partner(mesh%nodes(:3, e)), n - 1), 0_ip], trees)
         end if
      end do
   end subroutine begin_trees

   !> The longest side of a triangle; of some as long the one of the least vertices, so that two neighbours agree.
   pure integer(ip) function longest_side(mesh, partner, e) result(longest)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: partner(:), e
      real(wp) :: length(3)
      integer(ip) :: ends(2, 3), i

      do i = 1, 3
         associate (a => mesh%nodes(i, e), b => mesh%nodes(mod(i, 3_ip) + 1, e))
            length(i) = norm2(mesh%x(:, b) - mesh%x(:, a))
            ends(:, i) = [min(partner(a), partner(b)), max(partner(a), partner(b))]
         end associate
      end do
      longest = 1
      do i = 2, 3
         if (length(i) < (1 - ALIKE)*length(longest)) cycle
         if (length(i) > (1 + ALIKE)*length(longest) .or. ends(1, i) < ends(1, longest) .or. &
             (ends(1, i) == ends(1, longest) .and. ends(2, i) < ends(2, longest))) longest = i
      end do
   end function longest_side

   pure subroutine add_cell(root, place, corner, trees)
      integer(ip), intent(in) :: root, place(2, 4), corner(4)
      type(element_trees_t), intent(inout) :: trees
      integer(ip), allocatable :: longer(:, :, :)
      integer(ip) :: n

      n = trees%n + 1
      if (n > size(trees%root)) then
         call resize(trees%first_child, trees%n, 2*n)
         call resize(trees%root, trees%n, 2*n)
         call resize(trees%corner, trees%n, 2*n)
         allocate (longer(2, 4, 2*n))
         longer(:, :, :trees%n) = trees%place(:, :, :trees%n)
         call move_alloc(longer, trees%place)
      end if
      trees%n = n
      trees%first_child(n) = 0
      trees%root(n) = root
      trees%place(:, :, n) = place
      trees%corner(:, n) = corner
   end subroutine add_cell

   !> Cuts some leaves into four, and those that have to be cut with them. Leaves that are too small stay.
   !>
   !>     1. the leaves that are asked for: a quadrilateral into four, a triangle into two and each of these into two
   !>     2. all leaves: one with a side cut twice, or with more cut sides than its pieces can do with, is cut, too; slender
   !>        ones get the middle of the side opposite
   !>     3. 2 again, until a pass over all leaves changes nothing
   !>
   !> What is cut in 2 is larger than the neighbour for which it is cut, so cuts spread to coarser leaves and die out; cells have a
   !> least size besides, so there are finitely many, and the passes end.
   pure subroutine cut_leaves(leaves, trees)
      integer(ip), intent(in) :: leaves(:)          !< cells that are to be cut
      type(element_trees_t), intent(inout) :: trees !< new cells stand behind the others
      integer(ip) :: i, n, n_edges

      do i = 1, size(leaves, kind=ip)
         call cut_cell(leaves(i), trees)
         if (corner_count(trees, leaves(i)) == 4 .or. trees%first_child(leaves(i)) == 0) cycle
         call cut_cell(trees%first_child(leaves(i)), trees)
         call cut_cell(trees%first_child(leaves(i)) + 1, trees)
      end do
      do
         n = trees%n
         n_edges = trees%n_edges
         do i = 1, n
            if (trees%first_child(i) > 0) cycle
            if (has_to_be_cut(trees, i)) then
               call cut_cell(i, trees)
            else if (trees%short_side(trees%root(i)) > 0) then
               call halve_slender(i, trees)
            end if
         end do
         if (trees%n == n .and. trees%n_edges == n_edges) exit
      end do
   end subroutine cut_leaves

   !> Of a slender leaf with a node in the middle of one of its short sides, and no other, the other short side gets one, too.
   pure subroutine halve_slender(cell, trees)
      integer(ip), intent(in) :: cell
      type(element_trees_t), intent(inout) :: trees
      logical :: is_cut(4)
      integer(ip) :: i, middle, short

      is_cut = [(is_side_cut(trees, cell, i), i=1, 4)]
      short = trees%short_side(trees%root(cell))
      if (count(is_cut) /= 1 .or. .not. any(is_cut([short, short + 2]))) return
      do i = short, short + 2, 2
         call need_middle(trees%corner(i, cell), trees%corner(mod(i, 4_ip) + 1, cell), trees, middle)
      end do
   end subroutine halve_slender

   !> Cuts all leaves, so many times.
   pure subroutine cut_all(times, trees)
      integer(ip), intent(in) :: times              !< >= 0
      type(element_trees_t), intent(inout) :: trees !< new cells stand behind the others
      integer(ip) :: i

      do i = 1, times
         call cut_leaves(list_leaves(trees), trees)
      end do
   end subroutine cut_all

   !> The cells that are not cut.
   pure function list_leaves(trees) result(leaves)
      type(element_trees_t), intent(in) :: trees !< leaves rise by their places
      integer(ip), allocatable :: leaves(:)
      integer(ip) :: i

      leaves = pack([(i, i=1, trees%n)], trees%first_child(:trees%n) == 0)
   end function list_leaves

   !> How many these are.
   pure integer(ip) function count_leaves(trees) result(n)
      type(element_trees_t), intent(in) :: trees !< cells that are cut are not counted

      n = count(trees%first_child(:trees%n) == 0, kind=ip)
   end function count_leaves

   !> Whether a triangle has a side that is cut; a quadrilateral one of which a half is cut, or more than its pieces can do with.
   pure logical function has_to_be_cut(trees, cell) result(has)
      type(element_trees_t), intent(in) :: trees
      integer(ip), intent(in) :: cell
      integer(ip) :: i, n, middle, n_cut
      integer(ip) :: ends(2)

      n = corner_count(trees, cell)
      n_cut = 0
      has = .false.
      do i = 1, n
         ends = trees%corner([i, mod(i, n) + 1], cell)
         middle = middle_of(trees, ends(1), ends(2))
         if (middle == 0) cycle
         n_cut = n_cut + 1
         has = has .or. middle_of(trees, ends(1), middle) > 0 .or. middle_of(trees, middle, ends(2)) > 0
      end do
      has = has .or. n_cut > merge(0, 2, n == 3)
   end function has_to_be_cut

   !> Four of one, or two of a triangle, whatever is beside it. One that is cut stays as it is.
   pure subroutine cut_cell(cell, trees)
      integer(ip), intent(in) :: cell               !< place in the trees
      type(element_trees_t), intent(inout) :: trees !< gets the parts, and vertices in the middle of sides
      integer(ip) :: m(5), v(4), p(2, 4), q(2, 5), n, i, root

      p = trees%place(:, :, cell)
      n = corner_count(trees, cell)
      if (trees%first_child(cell) > 0 .or. maxval(abs(p(:, 2:n) - p(:, :n - 1))) <= SIDE/2**MOST_CUTS) return
      v = trees%corner(:, cell)
      root = trees%root(cell)
      do i = 1, merge(1_ip, 4_ip, n == 3)
         call need_middle(v(i), v(mod(i, n) + 1), trees, m(i))
         q(:, i) = (p(:, i) + p(:, mod(i, n) + 1))/2
      end do
      trees%first_child(cell) = trees%n + 1
      if (n == 3) then
         call add_cell(root, reshape([p(:, 3), p(:, 1), q(:, 1), 0_ip, 0_ip], [2, 4]), [v(3), v(1), m(1), 0_ip], trees)
         call add_cell(root, reshape([p(:, 2), p(:, 3), q(:, 1), 0_ip, 0_ip], [2, 4]), [v(2), v(3), m(1), 0_ip], trees)
      else
         call add_vertex(trees, m(5))
         q(:, 5) = (p(:, 1) + p(:, 3))/2
         call add_cell(root, reshape([p(:, 1), q(:, 1), q(:, 5), q(:, 4)], [2, 4]), [v(1), m(1), m(5), m(4)], trees)
         call add_cell(root, reshape([q(:, 1), p(:, 2), q(:, 2), q(:, 5)], [2, 4]), [m(1), v(2), m(2), m(5)], trees)
         call add_cell(root, reshape([q(:, 5), q(:, 2), p(:, 3), q(:, 3)], [2, 4]), [m(5), m(2), v(3), m(3)], trees)
         call add_cell(root, reshape([q(:, 4), q(:, 5), q(:, 3), p(:, 4)], [2, 4]), [m(4), m(5), m(3), v(4)], trees)
      end if
   end subroutine cut_cell

   !> Corners of a cell, 3 or 4.
   pure integer(ip) function corner_count(trees, cell) result(n)
      type(element_trees_t), intent(in) :: trees !< corners of the cell are read
      integer(ip), intent(in) :: cell            !< place in the trees

      n = merge(3_ip, 4_ip, trees%corner(4, cell) == 0)
   end function corner_count

   !> Into how many a cell is cut.
   pure integer(ip) function part_count(trees, cell) result(n)
      type(element_trees_t), intent(in) :: trees !< corners of the cell are read
      integer(ip), intent(in) :: cell            !< place in the trees

      n = merge(2_ip, 4_ip, corner_count(trees, cell) == 3)
   end function part_count

   !> Whether there is a node in the middle of a side.
   pure logical function is_side_cut(trees, cell, side)
      type(element_trees_t), intent(in) :: trees !< corners and middles are read
      integer(ip), intent(in) :: cell, side      !< place in the trees; 1..4, or 1..3

      is_side_cut = middle_of(trees, trees%corner(side, cell), trees%corner(mod(side, corner_count(trees, cell)) + 1, cell)) > 0
   end function is_side_cut

   !> The vertex between two; 0: there is none.
   pure integer(ip) function middle_of(trees, a, b) result(middle)
      type(element_trees_t), intent(in) :: trees
      integer(ip), intent(in) :: a, b
      integer(ip) :: edge

      middle = 0
      edge = edge_between(trees, a, b)
      if (edge > 0) middle = trees%edge_middle(edge)
   end function middle_of

   pure integer(ip) function edge_between(trees, a, b) result(edge)
      type(element_trees_t), intent(in) :: trees
      integer(ip), intent(in) :: a, b

      edge = trees%first_edge(min(a, b))
      do while (edge > 0)
         if (trees%edge_end(edge) == max(a, b)) return
         edge = trees%next_edge(edge)
      end do
   end function edge_between

   !> The same, made where there is none.
   pure subroutine need_middle(a, b, trees, middle)
      integer(ip), intent(in) :: a, b
      type(element_trees_t), intent(inout) :: trees
      integer(ip), intent(out) :: middle
      integer(ip) :: n

      middle = middle_of(trees, a, b)
      if (middle > 0) return
      call add_vertex(trees, middle)
      n = trees%n_edges + 1
      call make_room(trees%edge_end, trees%n_edges, n)
      call make_room(trees%edge_middle, trees%n_edges, n)
      call make_room(trees%next_edge, trees%n_edges, n)
      trees%n_edges = n
      trees%edge_end(n) = max(a, b)
      trees%edge_middle(n) = middle
      trees%next_edge(n) = trees%first_edge(min(a, b))
      trees%first_edge(min(a, b)) = n
   end subroutine need_middle

   pure subroutine add_vertex(trees, vertex)
      type(element_trees_t), intent(inout) :: trees
      integer(ip), intent(out) :: vertex

      vertex = trees%n_vertices + 1
      call make_room(trees%first_edge, trees%n_vertices, vertex)
      trees%first_edge(vertex) = 0
      trees%n_vertices = vertex
   end subroutine add_vertex

   !> The word of an element that is cut.
   pure function code_of_tree(trees, root) result(code)
      type(element_trees_t), intent(in) :: trees      !< children of cells are read
      integer(ip), intent(in) :: root                 !< element of the deck
      character(len=:), allocatable :: code
      type(growing_text_t) :: text

      call add(root, text)
      code = text%letters(:index(text%letters(:text%n), CUT, back=.true.))

   contains

      pure recursive subroutine add(cell, text)
         integer(ip), intent(in) :: cell
         type(growing_text_t), intent(inout) :: text
         integer(ip) :: k

         if (trees%first_child(cell) == 0) then
            call append_text(text, LEAF)
         else
            call append_text(text, CUT)
            do k = 0, part_count(trees, cell) - 1
               call add(trees%first_child(cell) + k, text)
            end do
         end if
      end subroutine add

   end function code_of_tree

   !> Cuts an element as a word says; what is cut already stays cut. The neighbours are not looked after.
   pure subroutine take_code(root, code, trees)
      integer(ip), intent(in) :: root                 !< element of the deck
      character(len=*), intent(in) :: code            !< of letters C, c and L, l, as code_of_tree writes it
      type(element_trees_t), intent(inout) :: trees   !< gets the cells that the word asks for
      integer :: position

      position = 0
      call take(root, trees, position)

   contains

      pure recursive subroutine take(cell, trees, position)
         integer(ip), intent(in) :: cell
         type(element_trees_t), intent(inout) :: trees
         integer, intent(inout) :: position           !< the last letter that was taken
         integer(ip) :: k

         position = position + 1
         if (position > len(code)) return
         if (scan(code(position:position), 'Cc') == 0) return
         call cut_cell(cell, trees)
         if (trees%first_child(cell) == 0) return     ! it cannot be cut further
         do k = 0, part_count(trees, cell) - 1
            call take(trees%first_child(cell) + k, trees, position)
         end do
      end subroutine take

   end subroutine take_code

end module atrito_element_trees
