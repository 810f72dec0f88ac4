!> *NSET, AT: nodes by their places.
module atrito_places
   use atrito_build_context, only: build_context_t, node_finder_t
   use atrito_coordinates, only: get_coordinate, moved
   use atrito_deck, only: card_t, data_line_t, token_t, line_item
   use atrito_diagnostics, only: report_error, report_note
   use atrito_items, only: has_option, option_text
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: mesh_t, side_count, face_end
   use atrito_sets, only: nodes_of_elements, ranges_t, add_range, add_numbers
   use atrito_references, only: find_elements
   use atrito_sorting, only: sorted_places, first_at_least, order_key
   use atrito_strings, only: same_name, to_text
   implicit none (type, external)
   private
   public :: read_places

   !> Two distances are one if they differ by less than this part of an element.
   real(wp), parameter :: SAME = 1.0e-6_wp

   integer, parameter :: DIGITS = 6                    !< of numbers in messages

contains

   !> *NSET, AT: the nearest node of each place, of all elements or of those of ELSET= and of an instance. Without AT all nodes of
   !> ELSET=.
   subroutine read_places(card, context, members)
      type(card_t), intent(in) :: card                 !< *NSET with AT or ELSET=
      type(build_context_t), intent(inout) :: context  !< its finder is made where it is wanted
      type(ranges_t), intent(inout) :: members         !< places of nodes
      type(node_finder_t) :: own
      type(token_t) :: place
      character(len=:), allocatable :: name
      integer(ip), allocatable :: elements(:)
      integer(ip) :: i, scope
      logical :: ok, has_set, are_places

      are_places = has_option(context%deck, card, 'AT')
      call option_text(context%deck, card, 'ELSET', name, has_set, place)
      if (has_set) then
         call find_elements(context, place, elements, ok)
         if (ok .and. .not. are_places) call add_numbers(members, nodes_of_elements(context%model%mesh, elements))
         if (.not. ok) return
      end if
      if (.not. are_places) return
      scope = card%scope
      if (scope == 0) scope = scope_of_option(context, card)
      associate (mesh => context%model%mesh, lines => context%deck%lines(card%first_line:card%first_line + card%n_lines - 1))
         if (has_set .or. scope > 0) then
            if (.not. has_set) elements = [(i, i=1, mesh%n_elements)]
            if (scope > 0) then
               associate (id => mesh%element_id(elements) - context%deck%scopes(scope)%shift)   ! in the instance, from 1
                  elements = pack(elements, id > 0 .and. id <= context%deck%scopes(scope)%span)
               end associate
            end if
            call make_finder(mesh, elements, own)
            call read_lines(lines, card%scope, own, context, members)
         else
            if (.not. allocated(context%finder%node)) call make_finder(mesh, [(i, i=1, mesh%n_elements)], context%finder)
            call read_lines(lines, card%scope, context%finder, context, members)
         end if
      end associate
   end subroutine read_places

   !> The instance that INSTANCE= names; 0: none.
   integer(ip) function scope_of_option(context, card) result(scope)
      type(build_context_t), intent(in) :: context
      type(card_t), intent(in) :: card
      character(len=:), allocatable :: name
      logical :: found

      scope = 0
      call option_text(context%deck, card, 'INSTANCE', name, found)
      if (.not. found .or. .not. allocated(context%deck%scopes)) return
      do scope = ubound(context%deck%scopes, 1, kind=ip), 1, -1
         if (same_name(context%deck%scopes(scope)%name, name)) return
      end do
   end function scope_of_option

   subroutine read_lines(lines, scope, finder, context, members)
      type(data_line_t), intent(in) :: lines(:)
      integer(ip), intent(in) :: scope
      type(node_finder_t), intent(in) :: finder
      type(build_context_t), intent(in) :: context
      type(ranges_t), intent(inout) :: members
      integer :: i

      do i = 1, size(lines)
         if (lines(i)%ok) call read_place(lines(i))
      end do

   contains

      !> x, y: a node within half an element of it.
      subroutine read_place(line)
         type(data_line_t), intent(in) :: line
         type(token_t) :: token
         character(len=:), allocatable :: stands
         real(wp) :: x(2), way, half
         integer(ip) :: k, twin
         logical :: ok(2)

         token = line_item(context%deck, line, 1_ip)
         call get_coordinate(context%deck, token, 'x, a real [L]', x(1), ok(1))
         call get_coordinate(context%deck, line_item(context%deck, line, 2_ip), 'y, a real [L]', x(2), ok(2))
         if (.not. all(ok) .or. size(finder%node) == 0) return   ! without elements the deck is refused
         if (scope > 0) x = moved(context%motions(scope), x)
         associate (mesh => context%model%mesh)
            call find_nearest(mesh, x, k, twin)
            way = norm2(mesh%x(:, finder%node(k)) - x)
            half = 0.5_wp*finder%longest(k)
            stands = 'the nearest node, '//to_text(mesh%node_id(finder%node(k)))//' at ('// &
                     to_text(mesh%x(1, finder%node(k)), DIGITS)//', '//to_text(mesh%x(2, finder%node(k)), DIGITS)//'), is '// &
                     to_text(way, DIGITS)//' from there'
            if (way > half*(1 + SAME)) then
               call report_error(context%deck, token, 'E-PLACE', stands, expected='a place within half an element, '// &
                                 to_text(half, DIGITS)//', of a node [L]')
            else if (twin > 0) then
               call report_error(context%deck, token, 'E-PLACE', 'nodes '//to_text(mesh%node_id(finder%node(k)))//' and '// &
                                 to_text(mesh%node_id(finder%node(twin)))//' both stand there', &
                                 expected='ELSET=, which says of which elements')
            else
               if (way > SAME*half) call report_note(context%deck, token, 'N-PLACE', stands)
               call add_range(members, finder%node(k), finder%node(k))
            end if
         end associate
      end subroutine read_place

      !> The node that is nearest to a place; of several as near that of the least number.
      pure subroutine find_nearest(mesh, x, nearest, twin)
         type(mesh_t), intent(in) :: mesh
         real(wp), intent(in) :: x(2)                     !< [L]
         integer(ip), intent(out) :: nearest              !< place in the finder
         integer(ip), intent(out) :: twin                 !< another one that stands where it stands; 0: none
         real(wp) :: way, least
         integer(ip) :: j, k

         nearest = 0
         twin = 0
         least = 0.0_wp
         k = first_at_least(finder%key, order_key(x(1) - finder%reach*(1 + SAME)))
         do j = k, size(finder%node, kind=ip)
            associate (new => mesh%x(:, finder%node(j)), same_way => SAME*finder%longest(j))
               if (new(1) > x(1) + finder%reach*(1 + SAME)) exit
               way = norm2(new - x)
               if (nearest > 0) then
                  if (way > least + same_way) cycle
                  if (way >= least - same_way) then
                     if (norm2(new - mesh%x(:, finder%node(nearest))) <= same_way) twin = j
                     if (twin == j .or. mesh%node_id(finder%node(j)) > mesh%node_id(finder%node(nearest))) cycle
                  end if
               end if
               nearest = j
               twin = 0
               least = way
            end associate
         end do
         ! farther than half an element from all
         if (nearest == 0) nearest = minloc(norm2(mesh%x(:, finder%node) - spread(x, 2, size(finder%node)), dim=1), dim=1, kind=ip)
      end subroutine find_nearest
   end subroutine read_lines

   !> The nodes of some elements, in the order of their x.
   pure subroutine make_finder(mesh, elements, finder)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: elements(:)           !< places
      type(node_finder_t), intent(out) :: finder
      integer(lp), allocatable :: rising(:)
      integer(ip), allocatable :: order(:)
      real(wp) :: longest
      integer(ip) :: i, k, side

      finder%node = nodes_of_elements(mesh, elements)
      allocate (finder%longest(size(finder%node)), source=0.0_wp)
      rising = finder%node
      do i = 1, size(elements, kind=ip)
         associate (e => elements(i))
            longest = 0.0_wp
            do side = 1, side_count(mesh, e)
               longest = max(longest, norm2(mesh%x(:, mesh%nodes(face_end(mesh, e, side), e)) - mesh%x(:, mesh%nodes(side, e))))
            end do
            do side = 1, mesh%shape(e)
               k = first_at_least(rising, int(mesh%nodes(side, e), lp))
               finder%longest(k) = max(finder%longest(k), longest)
            end do
         end associate
      end do
      order = sorted_places(order_key(mesh%x(1, finder%node)))
      finder%node = finder%node(order)
      finder%longest = finder%longest(order)
      finder%key = order_key(mesh%x(1, finder%node))
      finder%reach = 0.5_wp*maxval([0.0_wp, finder%longest])
   end subroutine make_finder

end module atrito_places
