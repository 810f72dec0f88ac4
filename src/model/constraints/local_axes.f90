!> *TRANSFORM: local axes of nodes, along which supports, forces and equations are given.
module atrito_local_axes
   use atrito_build_context, only: build_context_t, ids_text
   use atrito_coordinates, only: get_reals, moved, turned
   use atrito_deck, only: card_t, token_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error, report_note
   use atrito_items, only: get_real, option_text, option_word
   use atrito_kinds, only: ip, wp
   use atrito_references, only: find_nodes
   use atrito_refinement, only: is_refined
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_local_axes, dof_direction, has_local_axes

   real(wp), parameter :: SAME_AXIS = 1.0e-12_wp   !< sine of an angle that is none

contains

   !> All *TRANSFORM cards: context%axes, which is not allocated where there are none.
   subroutine read_local_axes(context)
      type(build_context_t), intent(inout) :: context !< gets axes, at nodes between others too
      integer(ip) :: i

      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) /= 'TRANSFORM' .or. context%deck%cards(i)%n_lines == 0) cycle
         if (.not. context%deck%lines(context%deck%cards(i)%first_line)%ok .or. .not. context%deck%cards(i)%ok) cycle
         if (.not. allocated(context%axes)) allocate (context%axes(2, 2, context%model%mesh%n_nodes), source=0.0_wp)
         call read_transform_card(context%deck%cards(i), context)
      end do
      if (is_refined(context%refinement) .and. allocated(context%axes)) call fill_edges(context)
   end subroutine read_local_axes

   !> What a finer mesh has between nodes of several sets takes their axes where these are the same; where not that is told.
   subroutine fill_edges(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: edge, i, k, n
      logical :: told

      told = .false.
      associate (fine => context%refinement, axes => context%axes)
         do edge = 1, fine%n_edges
            n = merge(3_ip, 2_ip, fine%edge_node(3, edge) > 0)
            associate (nodes => fine%edge_node(:n, edge), first => fine%edge_first(edge), last => fine%edge_first(edge + 1) - 1)
               if (any([(.not. has_local_axes(context, nodes(k)), k=1, n)])) cycle
               if (any([(has_local_axes(context, k), k=first, last)])) cycle
               if (all([(abs(axes(:, :, nodes(k)) - axes(:, :, nodes(1))) <= SAME_AXIS, k=2, n)])) then
                  axes(:, :, first:last) = spread(axes(:, :, nodes(1)), 3, last - first + 1)
               else if (fine%edge_element(2, edge) == 0 .and. .not. told) then
                  told = .true.
                  i = findloc(context%deck%cards(:context%deck%n_cards)%name, 'TRANSFORM', dim=1, kind=ip)
                  associate (id => context%model%mesh%node_id(nodes(:2)))
                     call report_note(context%deck, context%deck%cards(i)%place, 'N-REFINE', 'the finer mesh has nodes between '// &
                                      to_text(id(1))//' and '//to_text(id(2))//', whose axes are different, and they have none')
                  end associate
               end if
            end associate
         end do
      end associate
   end subroutine fill_edges

   subroutine read_transform_card(card, context)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      character(len=:), allocatable :: name
      integer(ip), allocatable :: nodes(:)
      type(token_t) :: place
      real(wp) :: a(2), b(2), axes(2, 2)
      logical :: found, ok
      integer(ip) :: i

      call option_text(context%deck, card, 'NSET', name, found, place)
      call find_nodes(context, place, nodes, found)
      call read_points(card, context, a, b, ok)
      if (.not. (found .and. ok)) return
      if (option_word(context%deck, card, 'TYPE') == 'R') then
         call rectangular_axes()
         if (ok) call take_axes(spread(axes, 3, size(nodes)))
      else
         associate (x => context%model%mesh%x)
            if (any([(all(x(:, nodes(i)) == a), i=1, size(nodes, kind=ip))])) then
               call report_error(context%deck, line_item(context%deck, context%deck%lines(card%first_line), 1_ip), 'E-VALUE', &
                                 'a node of the set stands on the axis', expected='an axis away from the nodes')
               return
            end if
            call take_axes(reshape([(axes_along(x(:, nodes(i)) - a), i=1, size(nodes, kind=ip))], [2, 2, size(nodes)]))
         end associate
      end if

   contains

      !> R: local x along a, local y to the side of b.
      subroutine rectangular_axes()
         real(wp) :: side

         ok = norm2(a) > 0.0_wp
         axes = 0.0_wp
         if (ok) axes = axes_along(a)
         side = dot_product(axes(:, 2), b)
         if (ok .and. any(b /= a)) ok = abs(side) > SAME_AXIS*norm2(b)
         if (.not. ok) call report_error(context%deck, line_item(context%deck, context%deck%lines(card%first_line), 1_ip), &
                                         'E-VALUE', 'these points give no axes: one is the origin, or both lie on a line with it', &
                                         expected='a point on the local x axis, and one to its side')
         if (side < 0.0_wp) axes(:, 2) = -axes(:, 2)
      end subroutine rectangular_axes

      subroutine take_axes(axes)
         real(wp), intent(in) :: axes(:, :, :)
         logical :: clashes(size(nodes))
         integer(ip) :: i

         do i = 1, size(nodes, kind=ip)
            associate (own => context%axes(:, :, nodes(i)))
               clashes(i) = any(own /= 0.0_wp) .and. any(abs(own - axes(:, :, i)) > SAME_AXIS)
               own = axes(:, :, i)
            end associate
         end do
         if (any(clashes)) call report_error(context%deck, place, 'E-CONFLICT', 'node '// &
                                             ids_text(pack(context%model%mesh%node_id(nodes), clashes))// &
                                             ' has other local axes already', expected='one *TRANSFORM for each node')
      end subroutine take_axes
   end subroutine read_transform_card

   !> The two points of a card in the plane; b is a where it is left out.
   subroutine read_points(card, context, a, b, ok)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(in) :: context
      real(wp), intent(out) :: a(2), b(2)            !< [L]
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'coordinate, a real [L]'
      real(wp) :: other(3), z(2)
      logical :: good(2)
      real(wp), parameter :: FLAT = 1.0e-10_wp
      character(len=:), allocatable :: expected
      integer(ip) :: item

      associate (line => context%deck%lines(card%first_line), deck => context%deck)
         call get_reals(deck, line, 1_ip, WHAT, a, good(1))
         call get_real(deck, line_item(deck, line, 3_ip), WHAT, z(1), good(2), 0.0_wp)
         call get_reals(deck, line, 4_ip, WHAT, other, ok, [a, 0.0_wp])
      end associate
      b = other(:2)
      z(2) = other(3)
      ok = ok .and. all(good)
      ! R: both points lie in the plane. C: they lie on an axis across it.
      if (ok) then
         associate (away => b - a)
            if (option_word(context%deck, card, 'TYPE') == 'R') then
               item = merge(3_ip, 6_ip, abs(z(1)) > FLAT*norm2(away))
               ok = all(abs(z) <= FLAT*norm2(away))
               expected = 'za = zb = 0'
            else
               item = merge(4_ip, 5_ip, abs(away(1)) > FLAT*abs(z(2) - z(1)))
               ok = all(abs(away) <= FLAT*abs(z(2) - z(1)))
               expected = 'xb = xa and yb = ya: an axis along z'
            end if
            if (.not. ok) call report_error(context%deck, line_item(context%deck, context%deck%lines(card%first_line), item), &
                                            'E-VALUE', 'the scene is plane: these axes leave it', expected=expected)
         end associate
      end if
      if (.not. ok .or. card%scope == 0) return
      associate (motion => context%motions(card%scope))
         if (option_word(context%deck, card, 'TYPE') == 'R') then  ! directions
            a = turned(motion, a)
            b = turned(motion, b)
         else
            a = moved(motion, a)
            b = moved(motion, b)
         end if
      end associate
   end subroutine read_points

   !> A direction, and that turned by +90 degrees.
   pure function axes_along(direction) result(axes)
      real(wp), intent(in) :: direction(2)
      real(wp) :: axes(2, 2)

      axes(:, 1) = direction/norm2(direction)
      axes(:, 2) = [-axes(2, 1), axes(1, 1)]
   end function axes_along

   !> Whether a node has axes of its own, by *TRANSFORM.
   pure logical function has_local_axes(context, node)
      type(build_context_t), intent(in) :: context !< its axes are read
      integer(ip), intent(in) :: node              !< place in the mesh

      has_local_axes = .false.
      if (allocated(context%axes)) has_local_axes = any(context%axes(:, 1, node) /= 0.0_wp)
   end function has_local_axes

   !> The direction of a dof of a node.
   pure function dof_direction(context, node, dof) result(direction)
      type(build_context_t), intent(in) :: context !< its axes are read
      integer(ip), intent(in) :: node, dof         !< place in the mesh; 1 or 2
      real(wp) :: direction(2)

      direction = merge([1.0_wp, 0.0_wp], [0.0_wp, 1.0_wp], dof == 1)
      if (has_local_axes(context, node)) direction = context%axes(:, dof, node)
   end function dof_direction

end module atrito_local_axes
