!> What --refine and --elements mean for things that a deck says of single blocks, nodes and sides.
!>
!> Blocks with arcs: new nodes lie on the map of the block, not on that of their coarse element, so that a side stays the circle
!> that it is. The places of the new nodes in the block's unit square are those of a refined mesh whose coordinates they are: there
!> every element is a rectangle, and the map of the element is exact.
!>
!> Equations and supports: those that a deck gives node by node along a side may have none at the nodes between, which is told.
!> Of equations between two sets the nodes are put into corresponding orders, since the new nodes of a set stand edge by edge,
!> and edges run either way.
module atrito_refined_deck
   use atrito_bilateral_rows, only: ROW_EQUATION, ROW_SPRING
   use atrito_block_map, only: map_point, has_arcs
   use atrito_build_context, only: build_context_t
   use atrito_diagnostics, only: report_error, report_note
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_refined_members, only: fine_elements
   use atrito_refinement, only: map_element, is_refined, refinement_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: place_on_arcs, note_free_sides, order_like

   !> Places of one node by two elements are two if they differ by more than this part of the coarse element.
   real(wp), parameter :: SAME_PLACE = 1.0e-5_wp

   integer(ip), parameter :: PLANE_DOFS = 2
   !> What a dof of a node is: the first of an equation, another one, supported by a line of one node, supported by a set.
   integer(ip), parameter :: FIRST = 1, OTHER = 2, SINGLE = 3, SET = 4

contains

   !> Moves the new nodes of all blocks with arcs.
   subroutine place_on_arcs(coarse, context)
      type(mesh_t), intent(in) :: coarse               !< mesh of the deck
      type(build_context_t), intent(inout) :: context  !< places of new nodes of its mesh change
      type(mesh_t) :: square                           ! the coarse mesh in the unit square of a block
      real(wp), allocatable :: place(:, :)             ! of the new nodes there
      integer(ip), allocatable :: owner(:)             ! block that has placed a node; negative: elsewhere than its element; 0: none
      logical, allocatable :: is_done(:)               ! elements of blocks with arcs
      integer(ip), allocatable :: pieces(:)
      integer(ip) :: b, e, i, j

      if (.not. any([(has_arcs(context%blocks(b)%map), b=1, context%n_blocks)])) return
      square = coarse
      allocate (place(2, context%model%mesh%n_nodes))
      allocate (owner(context%model%mesh%n_nodes), source=0_ip)
      allocate (is_done(coarse%n_elements), source=.false.)
      do b = 1, context%n_blocks
         if (.not. has_arcs(context%blocks(b)%map)) cycle
         associate (block => context%blocks(b))
            do j = 0, ubound(block%nodes, 2, kind=ip)
               do i = 0, ubound(block%nodes, 1, kind=ip)
                  if (block%nodes(i, j) > 0) square%x(:, block%nodes(i, j)) = [block%along(i), block%across(j)]
               end do
            end do
            do e = block%first_element, block%first_element + block%n_elements - 1
               is_done(e) = .true.
               call place_element(e, b, coarse, square, context, place, owner)
            end do
         end associate
      end do
      do e = 1, coarse%n_elements                      ! an element of no block with arcs keeps the places of its nodes
         if (is_done(e)) cycle
         pieces = fine_elements(context%refinement, [e])
         look: do i = 1, size(pieces, kind=ip)
            do j = 1, context%model%mesh%shape(pieces(i))
               b = -owner(context%model%mesh%nodes(j, pieces(i)))
               if (b <= 0) cycle
               call report_other_curve(b, 0_ip, context)
               where (abs(owner) == b) owner = 0       ! reported once
               exit look
            end do
         end do look
      end do
   end subroutine place_on_arcs

   !> The new nodes of a coarse element. What another block has placed must lie where this one would place it.
   subroutine place_element(e, b, coarse, square, context, place, owner)
      integer(ip), intent(in) :: e, b
      type(mesh_t), intent(in) :: coarse, square
      type(build_context_t), intent(inout) :: context
      real(wp), intent(inout) :: place(:, :)
      integer(ip), intent(inout) :: owner(:)
      integer(ip), allocatable :: grid(:, :), pieces(:)
      real(wp) :: x(2), reach
      integer(ip) :: i, k, node

      call map_element(square, context%refinement, e, place, grid)
      reach = SAME_PLACE*norm2(coarse%x(:, coarse%nodes(3, e)) - coarse%x(:, coarse%nodes(1, e)))
      pieces = fine_elements(context%refinement, [e])
      associate (mesh => context%model%mesh)
         do i = 1, size(pieces, kind=ip)
            do k = 1, mesh%shape(pieces(i))
               node = mesh%nodes(k, pieces(i))
               if (node <= coarse%n_nodes .or. abs(owner(node)) == b) cycle
               x = map_point(context%blocks(b)%map, place(1, node), place(2, node))
               if (owner(node) == 0) then
                  owner(node) = merge(b, -b, norm2(x - mesh%x(:, node)) <= reach)
                  mesh%x(:, node) = x
               else if (norm2(x - mesh%x(:, node)) > reach) then
                  call report_other_curve(b, abs(owner(node)), context)
                  return
               end if
            end do
         end do
      end associate
   end subroutine place_element

   !> Reports a side that is an arc beside what follows another curve: nodes between those of the deck would lie in two places.
   subroutine report_other_curve(b, other, context)
      integer(ip), intent(in) :: b
      integer(ip), intent(in) :: other                 !< block; 0: elements of no block with arcs
      type(build_context_t), intent(in) :: context
      character(len=:), allocatable :: what

      what = 'elements beside it'
      if (other > 0) what = 'block '//context%blocks(other)%name//' beside it'
      call report_error(context%deck, context%deck%cards(context%blocks(b)%card)%place, 'E-BLOCK', 'a side of block '// &
                        context%blocks(b)%name//' is an arc, but the '//what//' share its nodes and follow another curve', &
                        expected='the same ARC for the sides of both blocks; --refine puts nodes between those of the deck', &
                        keyword='BLOCK')
   end subroutine report_other_curve

   !> Reports the first edge of the outline whose nodes all have equations or supports in a dof, and whose new nodes have none. Ends
   !> that sets support with nothing else between them are two sides, and those that single lines support stand under several cards.
   subroutine note_free_sides(context)
      type(build_context_t), intent(in) :: context     !< refinement, equations and supports are read
      logical, allocatable :: has(:, :, :)             ! (dof, n_nodes, FIRST | OTHER | SINGLE | SET)
      logical :: holds(SET)
      integer(ip) :: dof, edge, i, n
      character(len=8) :: keyword

      if (.not. is_refined(context%refinement)) return
      call note_springs(context)
      if (context%model%equations%n == 0 .and. .not. allocated(context%held_singly)) return
      call list_joined(context, has)
      associate (fine => context%refinement)
         do edge = 1, fine%n_edges
            if (fine%edge_element(2, edge) > 0) cycle  ! inside
            n = merge(3_ip, 2_ip, fine%edge_node(3, edge) > 0)
            do dof = 1, PLANE_DOFS
               associate (nodes => fine%edge_node(:n, edge))
                  if (.not. all(any(has(dof, nodes, :), dim=2))) cycle
                  if (any(has(dof, fine%edge_first(edge):fine%edge_first(edge + 1) - 1, :))) cycle
                  holds = any(has(dof, nodes, :), dim=1)
                  if (.not. merge(holds(FIRST), holds(SINGLE) .and. any(holds([FIRST, OTHER, SET])), &
                                  all(any(has(dof, nodes, FIRST:OTHER), dim=2)))) cycle
                  keyword = merge('EQUATION', 'BOUNDARY', any(holds(FIRST:OTHER)))
                  i = findloc(context%deck%cards(:context%deck%n_cards)%name, keyword, dim=1, kind=ip)
                  associate (id => context%model%mesh%node_id(nodes(:2)))
                     call report_note(context%deck, context%deck%cards(i)%place, 'N-REFINE', 'the finer mesh has nodes between '// &
                                      'those with equations or supports, as between '//to_text(id(1))//' and '//to_text(id(2))// &
                                      ', and they have none; where one set has all of a side they have', keyword=keyword)
                  end associate
                  return
               end associate
            end do
         end do
      end associate
   end subroutine note_free_sides

   !> Reports the first edge of the outline whose nodes all have springs, and whose new nodes have none: the bed is that of the
   !> deck.
   subroutine note_springs(context)
      type(build_context_t), intent(in) :: context
      logical :: has(context%model%mesh%n_nodes)
      integer(ip) :: edge, i, n

      has = .false.
      associate (rows => context%model%bilateral, fine => context%refinement, id => context%model%mesh%node_id)
         do i = 1, rows%n
            if (rows%kind(i) /= ROW_SPRING) cycle
            associate (nodes => rows%node(rows%first(i):rows%first(i + 1) - 1))
               has(pack(nodes, nodes <= size(has))) = .true.
            end associate
         end do
         if (.not. any(has)) return
         do edge = 1, fine%n_edges
            n = merge(3_ip, 2_ip, fine%edge_node(3, edge) > 0)
            if (fine%edge_element(2, edge) > 0 .or. .not. all(has(fine%edge_node(:n, edge)))) cycle
            i = findloc(context%deck%cards(:context%deck%n_cards)%name, 'SPRING', dim=1, kind=ip)
            call report_note(context%deck, context%deck%cards(i)%place, 'N-REFINE', 'springs are those of the deck: the finer '// &
                             'mesh has nodes between them, as between '//to_text(id(fine%edge_node(1, edge)))//' and '// &
                             to_text(id(fine%edge_node(2, edge)))//', and they have none', keyword='SPRING')
            return
         end do
      end associate
   end subroutine note_springs

   !> Which dofs of nodes are the first of equations, are others of them, are supported by lines of one node, and by others.
   subroutine list_joined(context, has)
      type(build_context_t), intent(in) :: context
      logical, allocatable, intent(out) :: has(:, :, :) !< (2, n_nodes, SET)
      integer(ip) :: i, k

      allocate (has(PLANE_DOFS, context%model%mesh%n_nodes, SET), source=.false.)
      associate (rows => context%model%bilateral, n => context%model%mesh%n_nodes, equations => context%model%equations)
         do i = 1, rows%n
            if (rows%kind(i) /= ROW_EQUATION) cycle
            do k = rows%first(i), rows%first(i + 1) - 1
               if (rows%node(k) <= n) has(:, rows%node(k), OTHER) = has(:, rows%node(k), OTHER) .or. abs(rows%vector(:, k)) > 0.0_wp
            end do
         end do
         do i = 1, equations%n
            if (equations%dof(i) <= PLANE_DOFS) has(equations%dof(i), equations%node(i), FIRST) = .true.
         end do
      end associate
      if (allocated(context%held_singly)) has(:, :context%refinement%n_nodes, SINGLE) = context%held_singly
      do i = 1, size(context%model%steps, kind=ip)
         associate (held => context%model%steps(i)%prescribed)
            do k = 1, held%n
               if (held%dof(k) <= PLANE_DOFS) has(held%dof(k), held%node(k), SET) = .true.
            end do
         end associate
      end do
      has(:, :, SET) = has(:, :, SET) .and. .not. has(:, :, SINGLE)
   end subroutine list_joined

   !> Puts the nodes of `other` into the order of those of `set`: the nodes of the deck correspond as they stand, new ones between
   !> two of them to those between their partners. ok: .false. where there are none.
   pure subroutine order_like(refinement, set, other, ok)
      type(refinement_t), intent(in) :: refinement     !< from the deck's mesh
      integer(ip), intent(in) :: set(:)                !< places of nodes; those of the deck first
      integer(ip), intent(inout) :: other(:)           !< as many
      logical, intent(out) :: ok                       !< both have as many nodes of the deck, and partners
      integer(ip), allocatable :: edges(:)
      integer(ip) :: partner(size(set)), ends(2), i, k, edge

      associate (n => count(set <= refinement%n_nodes, kind=ip))
         ok = n == count(other <= refinement%n_nodes)
         if (.not. ok) return
         edges = [(edge_of(refinement, other(i)), i=n + 1, size(other, kind=ip))]   ! nodes of an edge stand together: each once
         edges = pack(edges, edges > 0 .and. edges /= eoshift(edges, -1))
         partner(:n) = other(:n)
         do i = n + 1, size(set, kind=ip)
            edge = edge_of(refinement, set(i))
            ok = edge > 0
            if (.not. ok) return
            ends = [(findloc(set(:n), refinement%edge_node(k, edge), dim=1, kind=ip), k=1, 2)]
            ok = all(ends > 0)
            if (.not. ok) return
            partner(i) = node_between(refinement, edges, other(ends), set(i) - refinement%edge_first(edge))
            ok = partner(i) > 0
            if (.not. ok) return
         end do
      end associate
      other = partner
   end subroutine order_like

   !> The new node of an edge between two nodes, so many after the first of them; 0 where there is no such edge.
   pure integer(ip) function node_between(refinement, edges, ends, before) result(node)
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: edges(:), ends(2), before
      integer(ip) :: i

      node = 0
      do i = 1, size(edges, kind=ip)
         associate (own => refinement%edge_node(:2, edges(i)))
            if (all(own == ends)) node = refinement%edge_first(edges(i)) + before
            if (all(own == ends([2, 1]))) node = refinement%edge_first(edges(i) + 1) - 1 - before
         end associate
         if (node > 0) exit
      end do
      if (node == 0) return
      if (node < refinement%edge_first(edges(i)) .or. node >= refinement%edge_first(edges(i) + 1)) node = 0
   end function node_between

   !> The edge that a new node lies on; 0: none.
   pure integer(ip) function edge_of(refinement, node) result(edge)
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: node
      integer(ip) :: low, high, middle

      edge = 0
      if (node >= refinement%edge_first(refinement%n_edges + 1) .or. node < refinement%edge_first(1)) return
      low = 1
      high = refinement%n_edges
      do while (low < high)
         middle = (low + high + 1)/2
         if (refinement%edge_first(middle) <= node) then
            low = middle
         else
            high = middle - 1
         end if
      end do
      edge = low
   end function edge_of

end module atrito_refined_deck
