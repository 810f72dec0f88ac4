!> MERGE of *BLOCK: which nodes of a block are those of earlier ones.
!>
!> Only what is named is merged: blocks that touch and do not name each other are two bodies.
module atrito_block_joints
   use atrito_block_map, only: side_point
   use atrito_build_context, only: build_context_t, block_t, BLOCK_SIDES
   use atrito_deck, only: deck_t, card_t, token_t, token_text, keyword_name, line_item
   use atrito_diagnostics, only: report_error, report_warning
   use atrito_items, only: option_text
   use atrito_joined_blocks, only: add_joined_block, blocks_named, join_blocks, are_joined_blocks, blocks_near
   use atrito_kinds, only: ip, lp, wp
   use atrito_references, only: report_unknown
   use atrito_sets, only: find_set, members_of
   use atrito_sorting, only: each_once, first_at_least, sorted_places, order_key
   use atrito_strings, only: same_name, to_text
   implicit none (type, external)
   private
   public :: match_points, share_nodes, side_nodes

   !> Nodes nearer than this part of the shortest element edge coincide.
   real(wp), parameter :: MERGE_TOLERANCE = 1.0e-6_wp
   !> The middles of two sides between the same corners, in parts of their distance: farther apart they are two curves.
   real(wp), parameter :: SAME_CURVE = 1.0e-3_wp

contains

   !> Sets the nodes of a block that are those of the blocks it names; the others stay 0.
   subroutine share_nodes(i_card, x, context, block, ok)
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      real(wp), intent(in) :: x(:, :)                  !< of the block, row by row [L]
      type(build_context_t), intent(inout) :: context  !< blocks before it, their nodes, and joined
      type(block_t), intent(inout) :: block            !< nodes, low, high and joined_to are set
      logical, intent(out) :: ok                       !< all names of MERGE are blocks that it meets
      type(token_t), allocatable :: names(:)
      character(len=:), allocatable :: own
      integer(ip), allocatable :: named(:), near(:), outline(:), theirs(:)
      real(wp) :: reach
      integer(ip) :: i, k, n
      logical :: good

      ok = .true.
      block%low = minval(x, dim=2)
      block%high = maxval(x, dim=2)
      reach = MERGE_TOLERANCE*norm2(block%high - block%low)
      names = merge_names(context%deck, context%deck%cards(i_card))
      if (size(names) == 0) return
      do k = context%joined%n + 1, context%n_blocks    ! blocks that are new since the last MERGE
         associate (new => context%blocks(k))
            call add_joined_block(context%joined, new%name, new%low, new%high)
            if (new%joined_to > 0) call join_blocks(context%joined, new%joined_to, k)
         end associate
      end do
      allocate (named(0))
      do i = 1, size(names, kind=ip)
         call share_with(names(i), x, context, block, named, good)
         ok = ok .and. good
      end do
      if (.not. ok .or. size(named) == 0) return
      named = each_once(named)
      block%joined_to = named(1)
      do i = 2, size(named, kind=ip)
         call join_blocks(context%joined, named(1), named(i))
      end do
      call option_text(context%deck, context%deck%cards(i_card), 'ELSET', own, good)
      outline = outline_of(block%nodes)
      theirs = pack(block%nodes, .true.)
      outline = pack(outline, theirs(outline) == 0)    ! not shared
      near = blocks_near(context%joined, block%low - reach, block%high + reach)
      do i = 1, size(near, kind=ip)
         associate (other => context%blocks(near(i)))
            if (any(other%low > block%high + reach) .or. any(other%high < block%low - reach)) cycle
            if (.not. are_joined_blocks(context%joined, named(1), near(i))) cycle
            k = first_at_least(int(named, lp), int(near(i), lp))
            if (named(min(k, size(named, kind=ip))) == near(i)) cycle
            ! nodes that lie on those of a block of the same body that is not named are apart from them
            theirs = [(side_nodes(other%nodes, k), k=1, size(BLOCK_SIDES, kind=ip))]
            n = count(match_points(x(:, outline), context%model%mesh%x(:, theirs), &
                                   MERGE_TOLERANCE*shortest_edge(x, size(block%nodes, 1, kind=ip))) > 0, kind=ip)
            if (n == 0) cycle
            if (is_joint(context%deck, own, other%name)) cycle
            call report_warning(context%deck, names(1), 'W-BLOCK', to_text(n)//' nodes of this block lie on nodes of '// &
                                other%name//', a part of the same body, but are not shared: a crack', &
                                expected='the data line MERGE, '//token_text(context%deck, names(1))//', '//other%name// &
                                ' to close it')
         end associate
      end do
   end subroutine share_nodes

   !> The value of MERGE= and the items of MERGE lines.
   function merge_names(deck, card) result(names)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(token_t), allocatable :: names(:)
      character(len=:), allocatable :: name
      type(token_t) :: place
      integer(ip) :: i, k
      logical :: found

      allocate (names(0))
      call option_text(deck, card, 'MERGE', name, found, place)
      if (found) names = [place]
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (.not. same_name(token_text(deck, line_item(deck, deck%lines(i), 1_ip)), 'MERGE')) cycle
         do k = 2, deck%lines(i)%n_tokens
            names = [names, line_item(deck, deck%lines(i), k)]
         end do
      end do
   end function merge_names

   !> Shares the nodes of the block with those of a node set that lie in the same places.
   subroutine share_with(place, x, context, block, named, ok)
      type(token_t), intent(in) :: place               !< of the name of the set
      real(wp), intent(in) :: x(:, :)
      type(build_context_t), intent(in) :: context
      type(block_t), intent(inout) :: block
      integer(ip), allocatable, intent(inout) :: named(:) !< blocks so far whose name was given
      logical, intent(out) :: ok
      character(len=:), allocatable :: other
      integer(ip), allocatable :: outline(:), match(:), members(:), shared(:, :), flat(:), own(:)
      integer(ip) :: i_set, i, n

      other = token_text(context%deck, place)
      i_set = find_set(context%model%node_sets, other)
      ok = i_set > 0
      if (.not. ok) then
         call report_unknown(context, place, 'earlier node set', 'E-SET', context%model%node_sets%names)
         return
      end if
      outline = outline_of(block%nodes)
      members = members_of(context%model%node_sets%sets(i_set))
      match = match_points(x(:, outline), context%model%mesh%x(:, members), &
                           MERGE_TOLERANCE*shortest_edge(x, size(block%nodes, 1, kind=ip)))
      allocate (flat(size(block%nodes)), source=0_ip)
      flat(pack(outline, match > 0)) = members(pack(match, match > 0))
      shared = reshape(flat, shape(block%nodes))
      n = count(shared > 0 .and. block%nodes > 0 .and. block%nodes /= shared, kind=ip)
      if (n > 0) call report_warning(context%deck, place, 'W-BLOCK', to_text(n)//' nodes of this block lie on nodes of '//other// &
                                     ' and of an earlier name that are not shared by these', &
                                     expected='blocks that are merged with each other')
      block%nodes = merge(shared, block%nodes, shared > 0 .and. block%nodes == 0)
      ok = any(match > 0)
      if (.not. ok) then
         call report_error(context%deck, place, 'E-BLOCK', 'no node of this block lies on a node of '//other, &
                           expected='blocks whose nodes coincide along a side, within 1e-6 of an element edge')
         return
      end if
      own = blocks_named(context%joined, other)
      n = size(own, kind=ip)
      if (n > 0) ok = are_joined(place, context, block, shared, context%blocks(own(n)))
      named = [named, own]
      if (.not. ok) return
      n = sum([(count_between(side_nodes(shared, i)), i=1, size(BLOCK_SIDES, kind=ip))])
      if (n > 0) call report_warning(context%deck, place, 'W-BLOCK', to_text(n)//' nodes of this block lie between shared '// &
                                     'nodes but on none of the other block: they leave a crack', &
                                     expected='as many elements on both sides, with the same grading')
   end subroutine share_with

   !> Sides of both blocks that run from the same corner to the same corner are one side: the same curve, and as many elements on
   !> the same places.
   logical function are_joined(place, context, block, shared, other)
      type(token_t), intent(in) :: place
      type(build_context_t), intent(in) :: context
      type(block_t), intent(in) :: block, other
      integer(ip), intent(in) :: shared(:, :)
      character(len=:), allocatable :: names, text, expected
      integer(ip), allocatable :: own(:), theirs(:)
      integer(ip) :: i, k, n, m, ends(2)
      real(wp) :: apart, long

      are_joined = .true.
      do i = 1, merge(size(BLOCK_SIDES, kind=ip), 0_ip, block%order == other%order)
         own = side_nodes(shared, i)
         n = size(own, kind=ip)
         if (min(own(1), own(n)) == 0) cycle
         do k = 1, size(BLOCK_SIDES, kind=ip)
            theirs = side_nodes(other%nodes, k)
            m = size(theirs, kind=ip)
            ends = theirs([1_ip, m])
            if (any(own([1_ip, n]) /= ends) .and. any(own([1_ip, n]) /= ends([2, 1]))) cycle
            if (n == m .and. all(own > 0)) cycle
            are_joined = .false.
            names = block%name//trim(BLOCK_SIDES(i))//' and '//other%name//trim(BLOCK_SIDES(k))
            apart = norm2(side_point(block%map, i, 0.5_wp) - side_point(other%map, k, 0.5_wp))
            long = norm2(side_point(block%map, i, 1.0_wp) - side_point(block%map, i, 0.0_wp))
            if (apart > SAME_CURVE*long) then
               text = names//' join the same corners by different curves'
               expected = 'the same ARC for both sides, or none'
            else if (n /= m) then
               text = block%name//trim(BLOCK_SIDES(i))//' has '//to_text((n - 1)/block%order)//' elements, '// &
                      other%name//trim(BLOCK_SIDES(k))//' beside it '//to_text((m - 1)/other%order)
               expected = 'as many elements on both sides'
            else
               text = names//' have as many elements, but their nodes lie elsewhere'
               expected = 'the same grading or break points on both sides'
            end if
            call report_error(context%deck, place, 'E-BLOCK', text, expected=expected)
         end do
      end do
   end function are_joined

   !> Places of the nodes on the outline of a grid, counted row by row.
   pure function outline_of(grid) result(outline)
      integer(ip), intent(in) :: grid(:, :)
      integer(ip) :: outline(2*(size(grid, 1) + size(grid, 2)) - 4)
      integer(ip) :: i

      associate (n => size(grid, kind=ip), width => size(grid, 1, kind=ip), height => size(grid, 2, kind=ip))
         outline = [(i, i=1, width), (i, i=n - width + 1, n), (1 + i*width, i=1, height - 2), ((i + 1)*width, i=1, height - 2)]
      end associate
   end function outline_of

   !> The shortest edge of the elements of a block, whose nodes stand row by row [L].
   pure real(wp) function shortest_edge(x, width) result(shortest)
      real(wp), intent(in) :: x(:, :)
      integer(ip), intent(in) :: width                 !< nodes in a row
      integer(ip) :: k

      shortest = huge(shortest)
      do k = 1, size(x, 2, kind=ip)
         if (modulo(k, width) /= 0) shortest = min(shortest, norm2(x(:, k + 1) - x(:, k)))
         if (k + width <= size(x, 2)) shortest = min(shortest, norm2(x(:, k + width) - x(:, k)))
      end do
   end function shortest_edge

   !> Nodes of a side that are not shared, between the first and the last that are.
   pure integer(ip) function count_between(side) result(n)
      integer(ip), intent(in) :: side(:)               !< 0: not shared
      integer(ip) :: first

      first = findloc(side > 0, .true., dim=1, kind=ip)
      n = 0
      if (first > 0) n = count(side(first:findloc(side > 0, .true., dim=1, back=.true.)) == 0, kind=ip)
   end function count_between

   !> Whether the deck ties sides of two blocks, or pairs them: then what lies between them is meant.
   pure logical function is_joint(deck, a, b)
      type(deck_t), intent(in) :: deck
      character(len=*), intent(in) :: a, b             !< names of the blocks
      character(len=:), allocatable :: keyword, slave, master
      integer(ip) :: i, k

      is_joint = .false.
      do i = 1, deck%n_cards
         keyword = keyword_name(deck%cards(i))
         if (keyword /= 'TIE' .and. keyword /= 'CONTACT PAIR') cycle
         do k = deck%cards(i)%first_line, deck%cards(i)%first_line + deck%cards(i)%n_lines - 1
            slave = token_text(deck, line_item(deck, deck%lines(k), 1_ip))
            master = token_text(deck, line_item(deck, deck%lines(k), 2_ip))
            is_joint = (is_side(slave, a) .and. is_side(master, b)) .or. (is_side(slave, b) .and. is_side(master, a))
            if (is_joint) return
         end do
      end do
   end function is_joint

   !> Whether a surface is a side of a block by its name.
   pure logical function is_side(surface, block)
      character(len=*), intent(in) :: surface, block
      integer :: i

      is_side = any([(same_name(surface, block//BLOCK_SIDES(i)), i=1, size(BLOCK_SIDES))])
   end function is_side

   !> The nodes of a side of a block, in the direction in which its map travels it.
   pure function side_nodes(grid, side) result(nodes)
      integer(ip), intent(in) :: grid(:, :)            !< nodes of the block
      integer(ip), intent(in) :: side                  !< 1..4, as in BLOCK_SIDES
      integer(ip), allocatable :: nodes(:)

      select case (side)
      case (1)
         nodes = grid(:, 1)
      case (2)
         nodes = grid(size(grid, 1), :)
      case (3)
         nodes = grid(:, size(grid, 2))
      case default
         nodes = grid(1, :)
      end select
   end function side_nodes

   !> For each of some points the one of `others` that is nearest within `reach`; 0 when there is none.
   pure function match_points(points, others, reach) result(match)
      real(wp), intent(in) :: points(:, :)    !< (2, n) [L]
      real(wp), intent(in) :: others(:, :)    !< (2, m) [L]
      real(wp), intent(in) :: reach           !< [L], >= 0
      integer(ip) :: match(size(points, 2))
      integer(ip), allocatable :: near(:)
      integer(lp), allocatable :: key(:)
      real(wp) :: low(2), high(2), least, distance
      integer(ip) :: i, j, k, n

      match = 0
      if (size(points, 2) == 0) return
      low = minval(points, dim=2) - reach
      high = maxval(points, dim=2) + reach
      near = pack([(i, i=1, size(others, 2, kind=ip))], others(1, :) >= low(1) .and. others(1, :) <= high(1) .and. &
                  others(2, :) >= low(2) .and. others(2, :) <= high(2))
      n = size(near, kind=ip)
      k = merge(1_ip, 2_ip, high(1) - low(1) >= high(2) - low(2))
      near = near(sorted_places(order_key(others(k, near))))
      key = order_key(others(k, near))
      do i = 1, size(points, 2, kind=ip)
         least = reach
         do j = first_at_least(key, order_key(points(k, i) - reach)), n
            if (others(k, near(j)) > points(k, i) + reach) exit
            distance = norm2(others(:, near(j)) - points(:, i))
            if (distance > least) cycle
            least = distance
            match(i) = near(j)
         end do
      end do
   end function match_points

end module atrito_block_joints
