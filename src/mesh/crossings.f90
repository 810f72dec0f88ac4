!> Where a straight line goes through the bodies of a mesh: pieces of the line, element by element, and crossings, each a stretch of
!> the line within one body.
!>
!> A piece is inside where there is material on both sides of the line: an element that the line parts, a face on the line between
!> two elements, a node on the line that elements of both sides share. Else it is an edge: a face of the outline on the line.
!> Elements of the second degree count as polygons of all nodes on their sides.
!>
!> The line is x(s) = start + s along; height h(x) = normal.(x - start) of a node tells its side, and where h changes its sign from
!> node a to node b of a polygon, the line leaves it or enters it at s = s_a + (s_b - s_a) h_a/(h_a - h_b). |h| below SLACK of the
!> element's size is 0: a line along nodes must not depend on the last digits of their coordinates.
!>
!> A cross-section of bodies along a straight cut: the elements and nodes from which the force through it is summed.
!>
!> The elements count as behind or ahead of the line by the mean of their corners. What the part ahead does to the part behind goes
!> through the nodes that elements of both sides share. Elements that the line parts are behind or ahead as a whole, and so is
!> what acts on them; what of it is on the wrong side is put right by whoever sums the forces: loads on elements by the parts of
!> split elements, forces of single nodes by their share. So the result is that of the line, not of the zigzag of the elements.
module atrito_crossings
   use atrito_element_table, only: MOST_SIDES
   use atrito_faces, only: node_elements_t, is_outer_face, face_list_t, add_face
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_end, middle_node, side_count, face_nodes
   use atrito_sorting, only: order_key, sorted_places
   implicit none (type, external)
   private
   public :: cut_line_t, crossing_t, height_over, point_at, outline_of, slack_of, INSIDE, EDGE_BEHIND, EDGE_AHEAD, MOST_OUTLINE, &
             cross_section_t, find_cross_section

   !> A line from one point to another. Behind it is where its normal comes from.
   type :: cut_line_t
      real(wp) :: start(2) = 0.0_wp                 !< the first point [L]
      real(wp) :: along(2) = 0.0_wp                 !< unit vector towards the second
      real(wp) :: normal(2) = 0.0_wp                !< that one turned by -90 degrees
      real(wp) :: length = 0.0_wp                   !< between the points [L]
   end type cut_line_t

   integer(ip), parameter :: INSIDE = 1, EDGE_BEHIND = 2, EDGE_AHEAD = 3 !< an edge whose body lies behind or ahead of the line
   integer(ip), parameter :: MOST_OUTLINE = 2*MOST_SIDES

   !> What the line has of an element.
   type :: piece_t
      integer(ip) :: kind = INSIDE                  !< INSIDE, EDGE_BEHIND or EDGE_AHEAD
      integer(ip) :: element = 0                    !< place in the mesh
      integer(ip) :: face = 0                       !< on the line; 0: none
      logical :: is_split = .false.                 !< the line parts the element
      integer(ip) :: crossing = 0                   !< place in the list of crossings
      real(wp) :: from = 0.0_wp, to = 0.0_wp        !< along the line [L]
   end type piece_t

   !> A stretch of the line within a body.
   type :: crossing_t
      integer(ip) :: kind = INSIDE                  !< INSIDE, EDGE_BEHIND or EDGE_AHEAD
      integer(ip) :: body = 0                       !< place in the list of bodies
      real(wp) :: from = 0.0_wp, to = 0.0_wp        !< along the line [L]
      logical :: is_met = .false.                   !< some of it lies between the two points
      logical :: is_whole = .false.                 !< as good as all of it does
      logical :: is_wanted = .true.                 !< it has elements that are asked for
      logical :: is_all_wanted = .true.             !< and no others
      logical :: is_taken = .false.                 !< it belongs to the cross-section
   end type crossing_t

   !> A node is on the line when it is no farther from it than this part of its element's size.
   real(wp), parameter :: SLACK = 1.0e-6_wp
   !> A crossing of which no more than this part is missing is meant as a whole: nodes on arcs have chords between them, which a
   !> point of the arc does not reach.
   real(wp), parameter :: SHORT = 0.1_wp

   type :: cross_section_t
      type(cut_line_t) :: line                      !< through the two points of the cut
      real(wp) :: middle(2) = 0.0_wp                !< of what the line has of the bodies [L]
      real(wp) :: length = 0.0_wp                   !< of that [L]
      integer(ip), allocatable :: shared(:)         !< nodes of elements behind and of elements ahead
      integer(ip), allocatable :: behind(:)         !< the elements behind round these nodes
      integer(ip), allocatable :: split(:)          !< elements that the line parts
      logical, allocatable :: is_behind(:)          !< of each of them
      integer(ip), allocatable :: node(:)           !< whose own forces have a part in what goes through ...
      real(wp), allocatable :: share(:)             !< ... and which, -1 to 1
      type(face_list_t) :: edge                     !< faces on the line where the cut runs along the edge of a body
      real(wp), allocatable :: edge_share(:)        !< of the loads on them: 1, or -1 where the body lies ahead
   end type cross_section_t

contains

   !> Distance of a point from the line [L]: negative behind it.
   pure real(wp) function height_over(line, x)
      type(cut_line_t), intent(in) :: line          !< its start and its normal are read
      real(wp), intent(in) :: x(2)                  !< [L]

      height_over = dot_product(line%normal, x - line%start)
   end function height_over

   !> Where along the line a point lies, from its first point [L].
   pure real(wp) function place_along(line, x)
      type(cut_line_t), intent(in) :: line
      real(wp), intent(in) :: x(2)                  !< [L]

      place_along = dot_product(line%along, x - line%start)
   end function place_along

   !> The point of a line at a distance from its start [L].
   pure function point_at(line, place) result(x)
      type(cut_line_t), intent(in) :: line          !< its start and its direction are read
      real(wp), intent(in) :: place                 !< along the line [L]
      real(wp) :: x(2)

      x = line%start + place*line%along
   end function point_at

   !> The nodes on the sides of an element in their order round it, corners and middles.
   pure subroutine outline_of(mesh, element, nodes, n)
      type(mesh_t), intent(in) :: mesh                !< nodes of elements are read
      integer(ip), intent(in) :: element              !< place in the mesh
      integer(ip), intent(out) :: nodes(MOST_OUTLINE) !< places of the nodes, counter-clockwise, the first n
      integer(ip), intent(out) :: n                   !< nodes on the sides, 3..8
      integer(ip) :: side

      n = 0
      do side = 1, side_count(mesh, element)
         n = n + 1
         nodes(n) = mesh%nodes(side, element)
         if (middle_node(mesh, element, side) == 0) cycle
         n = n + 1
         nodes(n) = middle_node(mesh, element, side)
      end do
   end subroutine outline_of

   !> On which side of the line an element counts: that of the mean of its corners.
   pure logical function is_ahead(mesh, line, element)
      type(mesh_t), intent(in) :: mesh     !< corners of the element are read
      type(cut_line_t), intent(in) :: line !< start and normal are read
      integer(ip), intent(in) :: element   !< place in the mesh
      integer(ip) :: k
      real(wp) :: mean

      mean = 0.0_wp
      do k = 1, side_count(mesh, element)
         mean = mean + height_over(line, mesh%x(:, mesh%nodes(k, element)))
      end do
      is_ahead = mean > slack_of(mesh, element)
   end function is_ahead

   !> Nodes of an element that are no farther from a line are on it [L].
   pure real(wp) function slack_of(mesh, element)
      type(mesh_t), intent(in) :: mesh   !< corners of the element are read
      integer(ip), intent(in) :: element !< place in the mesh

      associate (corners => mesh%nodes(:side_count(mesh, element), element))
         slack_of = SLACK*maxval(maxval(mesh%x(:, corners), dim=2) - minval(mesh%x(:, corners), dim=2))
      end associate
   end function slack_of

   !> All pieces of the line, however far it goes, and the crossings that they make.
   !>
   !>     1. heights of the nodes of each element: all on one side, most elements have nothing of the line
   !>     2. nodes on both sides: the line parts the element, from its first to its last change of sign (span_of_split)
   !>     3. none beyond the line on one side: sides that lie on it, and corners shared with the other side (look_beside)
   !>     4. pieces of one body and kind that touch make a crossing (join_pieces)
   !>     5. of each crossing how much lies between the two points of the line
   pure subroutine find_crossings(mesh, around, of_element, line, pieces, crossings)
      type(mesh_t), intent(in) :: mesh                           !< nodes and elements are read
      type(node_elements_t), intent(in) :: around                !< elements round each node of mesh
      integer(ip), intent(in) :: of_element(:)                   !< body of each element
      type(cut_line_t), intent(in) :: line                       !< between its two points; it is followed beyond them
      type(piece_t), allocatable, intent(out) :: pieces(:)       !< in the order of the elements
      type(crossing_t), allocatable, intent(out) :: crossings(:) !< `is_wanted` and `is_taken` are the caller's to set
      type(piece_t), allocatable :: list(:)
      real(wp) :: common, size_of
      integer(ip) :: e, i, n

      allocate (list(64))
      n = 0
      do e = 1, mesh%n_elements
         call look_at_element(mesh, around, line, e, list, n)
      end do
      pieces = list(:n)
      call join_pieces(mesh, of_element, pieces, crossings)
      do i = 1, size(crossings, kind=ip)             ! how much of each lies between the points of the line?
         associate (c => crossings(i))
            size_of = c%to - c%from
            common = min(c%to, line%length) - max(c%from, 0.0_wp)
            c%is_met = common > SLACK*size_of .or. (size_of <= SLACK*line%length .and. common >= -SLACK*line%length)
            c%is_whole = c%is_met .and. (common >= (1 - SHORT)*size_of .or. size_of <= SLACK*line%length)
         end associate
      end do
   end subroutine find_crossings

   !> The pieces of an element: most have none.
   pure subroutine look_at_element(mesh, around, line, e, list, n)
      type(mesh_t), intent(in) :: mesh
      type(node_elements_t), intent(in) :: around
      type(cut_line_t), intent(in) :: line
      integer(ip), intent(in) :: e
      type(piece_t), allocatable, intent(inout) :: list(:)
      integer(ip), intent(inout) :: n
      integer(ip) :: nodes(MOST_OUTLINE), n_nodes, k
      real(wp) :: height(MOST_OUTLINE), near
      type(piece_t) :: piece

      call outline_of(mesh, e, nodes, n_nodes)
      do k = 1, n_nodes
         height(k) = height_over(line, mesh%x(:, nodes(k)))
      end do
      near = slack_of(mesh, e)
      if (minval(height(:n_nodes)) > near .or. maxval(height(:n_nodes)) < -near) return
      if (minval(height(:n_nodes)) < -near .and. maxval(height(:n_nodes)) > near) then
         piece%element = e
         piece%is_split = .true.
         call span_of_split(nodes(:n_nodes), height(:n_nodes), piece%from, piece%to)
         call add_piece(piece, list, n)
      else
         call look_beside(abs(height(:n_nodes)) <= near, list, n)
      end if

   contains

      !> What the line has of an element that lies beside it: sides on the line, and corners on the line where elements lie on the
      !> other side, too.
      pure subroutine look_beside(is_on, list, n)
         logical, intent(in) :: is_on(:)               !< the nodes on its sides, in their order: they are on the line
         type(piece_t), allocatable, intent(inout) :: list(:)
         integer(ip), intent(inout) :: n
         real(wp) :: place(2)
         integer(ip) :: side, stride, kind, i
         logical :: ahead

         ahead = is_ahead(mesh, line, e)
         stride = size(is_on, kind=ip)/side_count(mesh, e)   ! from a corner to the next
         do side = 1, side_count(mesh, e)
            if (.not. all(is_on(stride*(side - 1) + 1:stride*side)) .or. .not. is_on(mod(stride*side, size(is_on)) + 1)) cycle
            place = [place_along(line, mesh%x(:, mesh%nodes(side, e))), &
                     place_along(line, mesh%x(:, mesh%nodes(face_end(mesh, e, side), e)))]
            kind = INSIDE
            if (is_outer_face(mesh, around, e, side)) kind = merge(EDGE_AHEAD, EDGE_BEHIND, ahead)
            call add_piece(piece_t(kind=kind, element=e, face=side, from=minval(place), to=maxval(place)), list, n)
         end do
         do side = 1, side_count(mesh, e)
            associate (node => mesh%nodes(side, e))
               if (.not. is_on(stride*(side - 1) + 1)) cycle
               if (all([(is_ahead(mesh, line, around%list(i)) .eqv. ahead, &
                         i=around%first(node), around%first(node + 1) - 1)])) cycle
               place = place_along(line, mesh%x(:, node))
            end associate
            call add_piece(piece_t(element=e, from=place(1), to=place(1)), list, n)
         end do
      end subroutine look_beside

      !> From where to where along the line it runs through a polygon.
      pure subroutine span_of_split(nodes, height, from, to)
         integer(ip), intent(in) :: nodes(:)           !< in their order
         real(wp), intent(in) :: height(:)             !< of the nodes [L]
         real(wp), intent(out) :: from, to             !< [L]
         real(wp) :: place, share
         integer(ip) :: k, next

         from = huge(from)
         to = -huge(to)
         do k = 1, size(nodes, kind=ip)
            next = mod(k, size(nodes, kind=ip)) + 1
            if (height(k) > 0.0_wp .eqv. height(next) > 0.0_wp) cycle
            share = height(k)/(height(k) - height(next))
            place = (1 - share)*place_along(line, mesh%x(:, nodes(k))) + share*place_along(line, mesh%x(:, nodes(next)))
            from = min(from, place)
            to = max(to, place)
         end do
      end subroutine span_of_split

   end subroutine look_at_element

   pure subroutine add_piece(piece, list, n)
      type(piece_t), intent(in) :: piece
      type(piece_t), allocatable, intent(inout) :: list(:)
      integer(ip), intent(inout) :: n
      type(piece_t), allocatable :: longer(:)

      if (n == size(list)) then
         allocate (longer(2*n))
         longer(:n) = list
         call move_alloc(longer, list)
      end if
      n = n + 1
      list(n) = piece
   end subroutine add_piece

   !> Pieces of one kind and body that touch make one crossing.
   !>
   !> The pieces are gone through by where they begin. Of each body and kind one crossing is open: a piece that begins before its
   !> end, or within the slack of an element behind it, makes it longer; one that begins farther off opens the next. n log n for n
   !> pieces.
   pure subroutine join_pieces(mesh, of_element, pieces, crossings)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: of_element(:)
      type(piece_t), intent(inout) :: pieces(:)
      type(crossing_t), allocatable, intent(out) :: crossings(:)
      type(crossing_t) :: found(size(pieces))
      integer(ip) :: last(EDGE_AHEAD, maxval([of_element, 0_ip])), order(size(pieces)), i, n

      order = sorted_places(order_key(pieces%from))
      last = 0
      n = 0
      do i = 1, size(pieces, kind=ip)
         associate (piece => pieces(order(i)))
            associate (open => last(piece%kind, of_element(piece%element)))
               if (open > 0) then
                  if (piece%from > found(open)%to + slack_of(mesh, piece%element)) open = 0
               end if
               if (open == 0) then
                  n = n + 1
                  open = n
                  found(n) = crossing_t(piece%kind, of_element(piece%element), piece%from, piece%to)
               end if
               found(open)%to = max(found(open)%to, piece%to)
               piece%crossing = open
            end associate
         end associate
      end do
      crossings = found(:n)
   end subroutine join_pieces

   !> The cross-section along a cut, and all crossings of its line. Without one that is taken the section is empty.
   pure subroutine find_cross_section(mesh, around, of_element, ends, wanted, section, crossings)
      type(mesh_t), intent(in) :: mesh                           !< nodes and elements are read
      type(node_elements_t), intent(in) :: around                !< elements round each node of mesh
      integer(ip), intent(in) :: of_element(:)                   !< body of each element
      real(wp), intent(in) :: ends(2, 2)                         !< of the cut, two points that differ [L]
      logical, intent(in) :: wanted(:)                           !< elements: crossings without one of them do not count
      type(cross_section_t), intent(out) :: section              !< parts of the crossings that are taken
      type(crossing_t), allocatable, intent(out) :: crossings(:) !< all along the line, with what tells of each
      type(piece_t), allocatable :: pieces(:)
      real(wp), allocatable :: place(:), weight(:)  ! of each crossing
      integer(ip) :: i

      section%line%start = ends(:, 1)
      section%line%length = norm2(ends(:, 2) - ends(:, 1))
      section%line%along = (ends(:, 2) - ends(:, 1))/section%line%length
      section%line%normal = [section%line%along(2), -section%line%along(1)]
      call find_crossings(mesh, around, of_element, section%line, pieces, crossings)
      crossings%is_wanted = .false.
      do i = 1, size(pieces, kind=ip)
         associate (c => crossings(pieces(i)%crossing))
            c%is_wanted = c%is_wanted .or. wanted(pieces(i)%element)
            c%is_all_wanted = c%is_all_wanted .and. wanted(pieces(i)%element)
         end associate
      end do
      call take_crossings(crossings)
      place = 0.5_wp*(crossings%from + crossings%to)
      weight = merge(crossings%to - crossings%from, 0.0_wp, crossings%is_taken)
      section%length = sum(weight)
      if (.not. section%length > 0.0_wp) weight = merge(1.0_wp, 0.0_wp, crossings%is_taken)   ! of points the middle is their mean
      if (any(crossings%is_taken)) section%middle = point_at(section%line, sum(weight/sum(weight)*place))
      call collect_parts(section)

   contains

      !> Elements and nodes of the crossings that are taken.
      pure subroutine collect_parts(section)
         type(cross_section_t), intent(inout) :: section
         logical :: is_known(mesh%n_nodes)
         integer(ip) :: i

         allocate (section%node(0), section%share(0), section%shared(0), section%split(0), section%is_behind(0), &
                   section%edge_share(0))
         is_known = .false.
         do i = 1, size(pieces, kind=ip)
            associate (piece => pieces(i), e => pieces(i)%element)
               if (.not. crossings(piece%crossing)%is_taken) cycle
               if (piece%kind == INSIDE) then
                  call add_nodes_inside(mesh, around, e, is_known, section)
                  if (.not. piece%is_split) cycle
                  section%split = [section%split, e]
                  section%is_behind = [section%is_behind,.not. is_ahead(mesh, section%line, e)]
               else
                  call add_edge(mesh, piece, is_known, section)
               end if
            end associate
         end do
         call collect_behind(section)
      end subroutine collect_parts

      !> The elements behind the line round the shared nodes, each once.
      pure subroutine collect_behind(section)
         type(cross_section_t), intent(inout) :: section
         logical :: is_in(mesh%n_elements)
         integer(ip) :: i, k

         is_in = .false.
         allocate (section%behind(0))
         do i = 1, size(section%shared, kind=ip)
            do k = around%first(section%shared(i)), around%first(section%shared(i) + 1) - 1
               associate (e => around%list(k))
                  if (is_in(e) .or. is_ahead(mesh, section%line, e)) cycle
                  is_in(e) = .true.
                  section%behind = [section%behind, e]
               end associate
            end do
         end do
      end subroutine collect_behind
   end subroutine find_cross_section

   !> Edges count where their body is not crossed; those of bodies ahead, which lie against what is behind, where there is nothing
   !> else.
   pure subroutine take_crossings(crossings)
      type(crossing_t), intent(inout) :: crossings(:)
      integer(ip) :: i

      crossings%is_taken = crossings%is_met .and. crossings%is_wanted .and. crossings%kind == INSIDE
      do i = 1, size(crossings, kind=ip)
         associate (c => crossings(i))
            if (c%kind /= EDGE_BEHIND .or. .not. (c%is_met .and. c%is_wanted)) cycle
            c%is_taken = .not. any(crossings%is_taken .and. crossings%kind == INSIDE .and. crossings%body == c%body)
         end associate
      end do
      if (any(crossings%is_taken)) return
      crossings%is_taken = crossings%is_met .and. crossings%is_wanted .and. crossings%kind == EDGE_AHEAD
   end subroutine take_crossings

   !> The nodes of an element at the line: whether elements of both sides share them, and what part of their own forces counts.
   !>
   !> What acts on a node is behind the line or ahead of it as the node is; half of it is where the node is on the line and shared.
   !> In the sum over the elements behind it is behind where the node is of these alone.
   pure subroutine add_nodes_inside(mesh, around, e, is_known, section)
      type(mesh_t), intent(in) :: mesh
      type(node_elements_t), intent(in) :: around
      integer(ip), intent(in) :: e
      logical, intent(inout) :: is_known(:)         !< (n_nodes)
      type(cross_section_t), intent(inout) :: section
      logical :: behind, ahead
      real(wp) :: height, part, counted
      integer(ip) :: k, i

      do k = 1, mesh%shape(e)
         associate (node => mesh%nodes(k, e))
            if (is_known(node)) cycle
            is_known(node) = .true.
            associate (sides => [(is_ahead(mesh, section%line, around%list(i)), i=around%first(node), around%first(node + 1) - 1)])
               ahead = any(sides)
               behind = .not. all(sides)
            end associate
            height = height_over(section%line, mesh%x(:, node))
            counted = merge(1.0_wp, 0.0_wp,.not. ahead)
            part = merge(1.0_wp, 0.0_wp, height < 0.0_wp)
            if (abs(height) <= slack_of(mesh, e)) part = merge(0.5_wp, counted, behind .and. ahead)
            if (behind .and. ahead) section%shared = [section%shared, node]
            if (part /= counted) call add_share(node, counted - part, section)
         end associate
      end do
   end subroutine add_nodes_inside

   !> A face of the outline on the line: all that acts there comes from the other side.
   pure subroutine add_edge(mesh, piece, is_known, section)
      type(mesh_t), intent(in) :: mesh
      type(piece_t), intent(in) :: piece
      logical, intent(inout) :: is_known(:)         !< (n_nodes)
      type(cross_section_t), intent(inout) :: section
      integer(ip), allocatable :: nodes(:)
      real(wp) :: share
      integer(ip) :: k

      share = merge(1.0_wp, -1.0_wp, piece%kind == EDGE_BEHIND)
      call add_face(section%edge, piece%element, piece%face)
      section%edge_share = [section%edge_share, share]
      nodes = face_nodes(mesh, piece%element, piece%face)
      do k = 1, size(nodes, kind=ip)
         if (is_known(nodes(k))) cycle
         is_known(nodes(k)) = .true.
         call add_share(nodes(k), share, section)
      end do
   end subroutine add_edge

   pure subroutine add_share(node, share, section)
      integer(ip), intent(in) :: node
      real(wp), intent(in) :: share
      type(cross_section_t), intent(inout) :: section

      section%node = [section%node, node]
      section%share = [section%share, share]
   end subroutine add_share

end module atrito_crossings
