!> *BLOCK: a four-sided block of elements with its sets.
!>
!> Its nodes are made with those of *NODE, in the order of the deck, its elements with those of *ELEMENT, its surfaces with
!> those of *SURFACE; a draft keeps the block in between.
module atrito_build_block
   use atrito_block, only: graded_lines, block_nodes
   use atrito_block_copies, only: copies_t, read_copies, copy_offset, name_copy
   use atrito_build_elements, only: read_element_type
   use atrito_build_nodes, only: put_node_set, MOST_NODES
   use atrito_coincidence, only: match_points
   use atrito_coordinates, only: get_coordinate
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t, option_t, token_text, line_item
   use atrito_diagnostics, only: report_error, report_warning
   use atrito_draft, only: draft_t, block_t, BLOCK_SIDES, add_draft_block, note_places, spoil_block
   use atrito_element_table, only: SHAPES
   use atrito_items, only: get_real, option_text, option_integer, find_option
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: add_nodes, add_block, reserve_mesh
   use atrito_model, only: model_t
   use atrito_model_memory, only: fits_memory
   use atrito_number_list, only: number_list_t, add_numbers, numbers_of
   use atrito_references, only: report_unknown
   use atrito_sets, only: find_set, grow_set
   use atrito_strings, only: same_name, to_text
   implicit none (type, external)
   private
   public :: read_block_card, place_block_elements

   integer(ip), parameter :: CORNERS = 4
   !> Nodes nearer than this part of the shortest element edge coincide.
   real(wp), parameter :: MERGE_TOLERANCE = 1.0e-6_wp
   !> A corner whose Jacobian is smaller than this part of the longest side squared is flat.
   real(wp), parameter :: FLAT = 1.0e-12_wp
   !> The first or the last element would be flat beyond it.
   real(wp), parameter :: LARGEST_GRADE = 1.0e12_wp

   !> Words of the lines that divide a direction.
   character(len=5), parameter :: DIVISIONS(3) = ['GRADE', 'X    ', 'Y    ']

   !> What a *BLOCK says.
   type :: spec_t
      integer(ip) :: state = 0
      integer(ip) :: order = 1                         !< 1 for Q1, 2 for Q2: node intervals of an element along each direction
      integer(ip) :: n(2) = 0                          !< elements along and across
      real(wp) :: corners(2, CORNERS) = 0.0_wp         !< [L]
      real(wp) :: grade(2) = 1.0_wp
      real(wp), allocatable :: along(:), across(:)     !< inner break points, 0..1; not allocated: graded
      type(copies_t) :: copies
   end type spec_t

contains

   !> The nodes of a block, or of its copies, and the node sets.
   subroutine read_block_card(deck, i_card, model, draft)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      type(model_t), intent(inout) :: model
      type(draft_t), intent(inout) :: draft
      type(spec_t) :: spec
      character(len=:), allocatable :: name
      logical :: ok, named

      call option_text(deck, deck%cards(i_card), 'ELSET', name, named)
      call read_spec(deck, deck%cards(i_card), spec, ok)
      ok = ok .and. named
      if (ok) ok = fits_memory(deck, deck%cards(i_card)%place, model, draft, count_nodes(spec), &
                               product(int(spec%n, lp))*product(int(spec%copies%n, lp)), 'BLOCK')
      if (ok) call place_copies(deck, i_card, spec, name, model, draft, ok)
      if (.not. ok) call spoil_block(draft, name)
   end subroutine read_block_card

   subroutine place_copies(deck, i_card, spec, name, model, draft, ok)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: i_card
      type(spec_t), intent(in) :: spec
      character(len=*), intent(in) :: name             !< of the *BLOCK
      type(model_t), intent(inout) :: model
      type(draft_t), intent(inout) :: draft
      logical, intent(out) :: ok
      integer(ip) :: i, j

      ok = .true.
      do j = 1, spec%copies%n(2)
         do i = 1, spec%copies%n(1)
            if (ok) call place_copy(deck, i_card, spec, name, i, j, model, draft, ok)
         end do
      end do
      if (ok .and. spec%copies%given) call put_array_sets(i_card, name, model, draft)
   end subroutine place_copies

   !> Copy i, j of a block; the block itself where there are no others.
   subroutine place_copy(deck, i_card, spec, name, i, j, model, draft, ok)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: i_card
      type(spec_t), intent(in) :: spec
      character(len=*), intent(in) :: name             !< of the *BLOCK
      integer(ip), intent(in) :: i, j
      type(model_t), intent(inout) :: model
      type(draft_t), intent(inout) :: draft
      logical, intent(out) :: ok
      type(spec_t) :: shifted
      type(block_t) :: block
      integer(ip) :: k

      shifted = spec
      do k = 1, CORNERS
         shifted%corners(:, k) = spec%corners(:, k) + copy_offset(spec%copies, i, j)
      end do
      call name_copy(spec%copies, name, i, j, block)
      block%card = i_card
      block%state = spec%state
      block%order = spec%order
      call place_block_nodes(deck, i_card, shifted, model, draft, block, ok)
      if (.not. ok) return
      call put_block_sets(model, draft, block)
      call add_draft_block(draft, block)
      draft%elements_to_come = draft%elements_to_come + count_elements(block)
   end subroutine place_copy

   subroutine read_spec(deck, card, spec, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(spec_t), intent(out) :: spec
      logical, intent(out) :: ok
      integer(ip) :: n_nodes
      logical :: good(6)

      call read_element_type(deck, card, n_nodes, spec%state, good(1))
      spec%order = SHAPES(n_nodes)%degree
      call read_count(deck, card, 'NX', spec%n(1), good(2))
      call read_count(deck, card, 'NY', spec%n(2), good(3))
      call read_corners(deck, card, spec, good(4))
      call read_divisions(deck, card, all(good(2:3)), spec, good(5))
      call read_copies(deck, card, spec%copies, good(6))
      ok = all(good)
      if (.not. all(good([2, 3, 6]))) return
      if (count_nodes(spec) <= int(MOST_NODES, lp)) return
      ok = .false.
      call report_error(deck, card%place, 'E-VALUE', 'a block of more than '//to_text(MOST_NODES)//' nodes', &
                        expected='fewer elements NX, NY, or fewer copies', keyword='BLOCK')
   end subroutine read_spec

   !> Nodes of a block of two counts with all copies; many more than there can be where they would not fit into a long integer.
   pure integer(lp) function count_nodes(spec) result(n)
      type(spec_t), intent(in) :: spec
      integer(lp) :: factors(4)

      factors = [int(spec%order, lp)*int(spec%n, lp) + 1_lp, int(spec%copies%n, lp)]
      n = huge(1_ip)
      if (product(real(factors, wp)) < real(n, wp)) n = product(factors)
   end function count_nodes

   !> The line begins with one of these words; other lines are corners.
   pure logical function has_word(deck, line, words)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      character(len=*), intent(in) :: words(:)
      character(len=:), allocatable :: word
      integer :: i

      word = token_text(deck, line_item(deck, line, 1_ip))
      has_word = any([(same_name(word, words(i)), i=1, size(words))])
   end function has_word

   subroutine read_count(deck, card, name, n, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: name             !< NX or NY
      integer(ip), intent(out) :: n
      logical, intent(out) :: ok
      type(option_t) :: option
      character(len=*), parameter :: WHAT = 'number of elements, a positive integer'
      logical :: found

      n = 0
      call option_integer(deck, card, name, WHAT, n, ok)
      if (.not. ok .or. n > 0) return
      ok = .false.
      call find_option(deck, card, name, option, found)
      call report_error(deck, option%value, 'E-VALUE', name//' = '//to_text(n), expected=WHAT, keyword='BLOCK')
   end subroutine read_count

   !> ok is .false., too, when there are not four of them, which the reader reports.
   subroutine read_corners(deck, card, spec, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(spec_t), intent(inout) :: spec
      logical, intent(out) :: ok
      integer(ip) :: i, k, n, lines(CORNERS)
      logical :: good

      ok = .true.
      n = 0
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (has_word(deck, deck%lines(i), [DIVISIONS, 'COPY ']) .or. n == CORNERS) cycle
         n = n + 1
         lines(n) = i
         ok = ok .and. deck%lines(i)%ok
         if (.not. deck%lines(i)%ok) cycle
         do k = 1, 2
            call get_coordinate(deck, line_item(deck, deck%lines(i), k), 'coordinate of a corner, a real [L]', &
                                spec%corners(k, n), good, 'BLOCK')
            ok = ok .and. good
         end do
      end do
      ok = ok .and. n == CORNERS
      if (ok) ok = is_convex(deck, lines, spec%corners)
   end subroutine read_corners

   subroutine read_divisions(deck, card, counted, spec, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      logical, intent(in) :: counted                   !< NX and NY are known
      type(spec_t), intent(inout) :: spec
      logical, intent(out) :: ok
      integer(ip) :: i
      logical :: good

      ok = .true.
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (.not. counted .or. .not. has_word(deck, deck%lines(i), DIVISIONS)) cycle
         call read_division(deck, deck%lines(i), spec, good)
         ok = ok .and. good
      end do
   end subroutine read_divisions

   logical function is_convex(deck, lines, x)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: lines(CORNERS)        !< places in deck%lines
      real(wp), intent(in) :: x(2, CORNERS)
      real(wp) :: jacobian(CORNERS), a(2), b(2), longest
      integer(ip) :: i

      longest = 0.0_wp
      do i = 1, CORNERS
         a = x(:, modulo(i, CORNERS) + 1) - x(:, i)
         b = x(:, modulo(i - 2, CORNERS) + 1) - x(:, i)
         jacobian(i) = a(1)*b(2) - a(2)*b(1)
         longest = max(longest, norm2(a))
      end do
      is_convex = all(jacobian > FLAT*longest**2)
      if (is_convex) return
      i = minloc(jacobian, dim=1, kind=ip)
      if (all(jacobian < 0.0_wp)) then
         call report_error(deck, line_item(deck, deck%lines(lines(1)), 1_ip), 'E-SHAPE', &
                           'the corners of the block run clockwise', expected='four corners counter-clockwise', keyword='BLOCK')
      else
         call report_error(deck, line_item(deck, deck%lines(lines(i)), 1_ip), 'E-SHAPE', &
                           'the block has no angle between 0 and 180 degrees at its corner '//to_text(i), &
                           expected='four corners counter-clockwise of a convex quadrilateral', keyword='BLOCK')
      end if
   end function is_convex

   !> GRADE, X or Y.
   subroutine read_division(deck, line, spec, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(spec_t), intent(inout) :: spec
      logical, intent(out) :: ok
      character(len=:), allocatable :: word

      ok = line%ok
      if (.not. ok) return
      word = token_text(deck, line_item(deck, line, 1_ip))
      if (same_name(word, 'GRADE')) then
         call read_grade(deck, line, spec, ok)
      else if (same_name(word, 'X')) then
         call read_breaks(deck, line, spec%n(1), spec%grade(1), spec%along, ok)
      else
         call read_breaks(deck, line, spec%n(2), spec%grade(2), spec%across, ok)
      end if
   end subroutine read_division

   subroutine read_grade(deck, line, spec, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(spec_t), intent(inout) :: spec
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'last over first element length, a real, 1e-12 to 1e12 [-]'
      integer(ip) :: k
      logical :: good

      ok = .true.
      do k = 1, 2
         call get_real(deck, line_item(deck, line, k + 1), WHAT, spec%grade(k), good, 1.0_wp, 'BLOCK')
         ok = ok .and. good
         if (.not. good .or. (spec%grade(k) >= 1/LARGEST_GRADE .and. spec%grade(k) <= LARGEST_GRADE)) cycle
         ok = .false.
         call report_error(deck, line_item(deck, line, k + 1), 'E-VALUE', 'a grading of '//to_text(spec%grade(k)), &
                           expected=WHAT, keyword='BLOCK')
      end do
      if (allocated(spec%along) .and. abs(spec%grade(1) - 1) > 0 .or. allocated(spec%across) .and. abs(spec%grade(2) - 1) > 0) then
         ok = .false.
         call report_error(deck, line_item(deck, line, 1_ip), 'E-CONFLICT', 'GRADE and break points for one direction', &
                           expected='one of them', keyword='BLOCK')
      end if
   end subroutine read_grade

   !> Break points of one direction, rising between 0 and 1.
   subroutine read_breaks(deck, line, n, grade, breaks, ok)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: n                     !< elements
      real(wp), intent(in) :: grade
      real(wp), allocatable, intent(inout) :: breaks(:)
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'rising inner break points between 0 and 1 [-]'
      real(wp) :: lower
      integer(ip) :: i
      logical :: good

      ok = .not. allocated(breaks) .and. .not. abs(grade - 1) > 0
      if (.not. ok) call report_error(deck, line_item(deck, line, 1_ip), 'E-CONFLICT', &
                                      'this direction has its break points already', expected='GRADE or break points, once', &
                                      keyword='BLOCK')
      if (line%n_tokens - 1 /= n - 1) then
         ok = .false.
         call report_error(deck, line_item(deck, line, 1_ip), 'E-VALUE', to_text(line%n_tokens - 1)// &
                           ' inner break points for '//to_text(n)//' elements', expected=to_text(n - 1)//' '//WHAT, &
                           keyword='BLOCK')
      end if
      if (.not. ok) return
      allocate (breaks(n - 1))
      lower = 0.0_wp
      do i = 1, n - 1
         call get_real(deck, line_item(deck, line, i + 1), WHAT, breaks(i), good, keyword='BLOCK')
         ok = ok .and. good
         if (.not. good) cycle
         if (breaks(i) <= lower .or. breaks(i) >= 1.0_wp) then
            ok = .false.
            call report_error(deck, line_item(deck, line, i + 1), 'E-VALUE', to_text(breaks(i))//' does not lie between '// &
                              to_text(lower)//' and 1', expected=WHAT, keyword='BLOCK')
         end if
         lower = breaks(i)
      end do
   end subroutine read_breaks

   !> Makes the nodes of a block, sharing those of the set that MERGE= names.
   subroutine place_block_nodes(deck, i_card, spec, model, draft, block, ok)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: i_card
      type(spec_t), intent(in) :: spec
      type(model_t), intent(inout) :: model
      type(draft_t), intent(inout) :: draft
      type(block_t), intent(inout) :: block
      logical, intent(out) :: ok
      real(wp), allocatable :: x(:, :)
      integer(ip) :: i, j, k, n(2), n_new

      n = spec%order*spec%n
      allocate (x(2, (n(1) + 1)*(n(2) + 1)))
      call block_nodes(spec%corners, node_lines(lines_of(spec%n(1), spec%grade(1), spec%along), spec%order), &
                       node_lines(lines_of(spec%n(2), spec%grade(2), spec%across), spec%order), x)
      allocate (block%nodes(0:n(1), 0:n(2)), source=0_ip)
      call share_nodes(deck, i_card, x, model, draft, block%nodes, ok)
      if (.not. ok) return
      k = 0
      n_new = 0
      do j = 0, n(2)
         do i = 0, n(1)
            k = k + 1
            if (block%nodes(i, j) > 0) cycle
            n_new = n_new + 1
            x(:, n_new) = x(:, k)
            block%nodes(i, j) = model%mesh%n_nodes + n_new
         end do
      end do
      ok = draft%greatest_node <= huge(1_ip) - n_new
      if (ok .and. n_new > 0) then
         call add_nodes(model%mesh, draft%greatest_node + 1, x(:, :n_new))
         call note_places(draft%node_place, model%mesh%n_nodes - n_new + 1, model%mesh%n_nodes, -i_card)
         draft%greatest_node = draft%greatest_node + n_new
      else if (.not. ok) then
         call report_error(deck, deck%cards(i_card)%place, 'E-ID', 'the node numbers of the block, which follow the greatest '// &
                           'so far, are too large', keyword='BLOCK')
      end if
   end subroutine place_block_nodes

   !> Lines of nodes: for Q2 also those in the middle between the lines of the elements.
   pure function node_lines(lines, order) result(t)
      real(wp), intent(in) :: lines(0:)                !< of the elements, 0..1
      integer(ip), intent(in) :: order                 !< 1 or 2
      real(wp), allocatable :: t(:)
      integer(ip) :: n

      n = ubound(lines, 1, kind=ip)
      allocate (t(0:order*n))
      t(0::order) = lines
      if (order == 2) t(1::2) = 0.5_wp*(lines(:n - 1) + lines(1:))
   end function node_lines

   pure function lines_of(n, grade, breaks) result(t)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: grade
      real(wp), allocatable, intent(in) :: breaks(:)
      real(wp) :: t(0:n)

      if (allocated(breaks)) then
         t = [0.0_wp, breaks, 1.0_wp]
      else
         t = graded_lines(n, grade)
      end if
   end function lines_of

   !> Finds the nodes on the outline of the block that lie on nodes of the set that MERGE= names.
   subroutine share_nodes(deck, i_card, x, model, draft, nodes, ok)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: i_card
      real(wp), intent(in) :: x(:, :)                  !< of the block, row by row [L]
      type(model_t), intent(in) :: model
      type(draft_t), intent(in) :: draft
      integer(ip), intent(inout) :: nodes(0:, 0:)      !< 0 so far
      logical, intent(out) :: ok
      type(token_t) :: place
      character(len=:), allocatable :: other
      integer(ip), allocatable :: outline(:), match(:)
      integer(ip) :: i_set, k, width
      logical :: found

      ok = .true.
      call option_text(deck, deck%cards(i_card), 'MERGE', other, found, place)
      if (.not. found) return
      i_set = find_set(model%node_sets, other)
      ok = i_set > 0
      if (.not. ok) then
         call report_unknown(deck, draft, place, 'earlier node set', 'E-SET', model%node_sets%names, 'BLOCK')
         return
      end if
      width = size(nodes, 1, kind=ip)
      outline = outline_of(width, size(nodes, 2, kind=ip))
      associate (members => model%node_sets%sets(i_set)%members)
         match = match_points(x(:, outline), model%mesh%x(:, members), MERGE_TOLERANCE*shortest_edge(x, width))
         do k = 1, size(outline, kind=ip)
            if (match(k) > 0) nodes(modulo(outline(k) - 1, width), (outline(k) - 1)/width) = members(match(k))
         end do
      end associate
      ok = any(match > 0)
      if (.not. ok) call report_error(deck, place, 'E-BLOCK', 'no node of this block lies on a node of '//other, &
                                      expected='blocks whose nodes coincide along a side, within 1e-6 of an element edge', &
                                      keyword='BLOCK')
      if (ok) call warn_of_hanging_nodes(deck, place, nodes)
   end subroutine share_nodes

   pure function outline_of(width, height) result(outline)
      integer(ip), intent(in) :: width, height         !< nodes
      integer(ip) :: outline(2*(width + height) - 4)
      integer(ip) :: i, n

      n = width*height
      outline = [(i, i=1, width), (i, i=n - width + 1, n), &
                 (1 + i*width, i=1, height - 2), ((i + 1)*width, i=1, height - 2)]
   end function outline_of

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

   !> A node between two shared ones that is not shared itself leaves a crack, which was hardly meant.
   subroutine warn_of_hanging_nodes(deck, place, nodes)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: place
      integer(ip), intent(in) :: nodes(0:, 0:)
      integer(ip) :: nx, ny, n

      nx = ubound(nodes, 1, kind=ip)
      ny = ubound(nodes, 2, kind=ip)
      n = between(nodes(:, 0)) + between(nodes(:, ny)) + between(nodes(0, :)) + between(nodes(nx, :))
      if (n > 0) call report_warning(deck, place, 'W-BLOCK', to_text(n)//' nodes of this block lie between shared nodes but '// &
                                     'on none of the other block: they leave a crack', &
                                     expected='as many elements on both sides, with the same grading', keyword='BLOCK')
   end subroutine warn_of_hanging_nodes

   pure integer(ip) function between(side) result(n)
      integer(ip), intent(in) :: side(:)               !< 0: not shared
      integer(ip) :: first, last

      first = findloc(side > 0, .true., dim=1, kind=ip)
      last = findloc(side > 0, .true., dim=1, kind=ip, back=.true.)
      n = 0
      if (first > 0) n = count(side(first:last) == 0, kind=ip)
   end function between

   subroutine put_block_sets(model, draft, block)
      type(model_t), intent(inout) :: model
      type(draft_t), intent(inout) :: draft
      type(block_t), intent(in) :: block
      integer(ip) :: k

      call put_node_set(model, draft, block%card, block%name, reshape(block%nodes, [size(block%nodes)]))
      do k = 1, size(BLOCK_SIDES, kind=ip)
         call put_node_set(model, draft, block%card, block%name//trim(BLOCK_SIDES(k)), side_nodes(block, k))
      end do
   end subroutine put_block_sets

   pure function side_nodes(block, side) result(nodes)
      type(block_t), intent(in) :: block
      integer(ip), intent(in) :: side                  !< 1..4, as in BLOCK_SIDES
      integer(ip), allocatable :: nodes(:)

      select case (side)
      case (1)
         nodes = block%nodes(:, 0)
      case (2)
         nodes = block%nodes(ubound(block%nodes, 1), :)
      case (3)
         nodes = block%nodes(:, ubound(block%nodes, 2))
      case default
         nodes = block%nodes(0, :)
      end select
   end function side_nodes

   !> All nodes of the copies of a block, and those at the sides of all of them.
   subroutine put_array_sets(i_card, name, model, draft)
      integer(ip), intent(in) :: i_card
      character(len=*), intent(in) :: name             !< of the *BLOCK
      type(model_t), intent(inout) :: model
      type(draft_t), intent(inout) :: draft
      type(number_list_t) :: at_side(size(BLOCK_SIDES))
      integer(ip) :: b, k, first

      first = draft%blocks(draft%block_of_card(i_card))%nodes(0, 0)
      call put_node_set(model, draft, i_card, name, [(k, k=first, model%mesh%n_nodes)])
      do b = draft%block_of_card(i_card), draft%n_blocks
         do k = 1, size(BLOCK_SIDES, kind=ip)
            if (draft%blocks(b)%at_side(k)) call add_numbers(at_side(k), side_nodes(draft%blocks(b), k))
         end do
      end do
      do k = 1, size(BLOCK_SIDES, kind=ip)
         call put_node_set(model, draft, i_card, name//trim(BLOCK_SIDES(k)), numbers_of(at_side(k)))
      end do
   end subroutine put_array_sets

   !> The elements of the blocks that a card made, if it could.
   subroutine place_block_elements(deck, i_card, model, draft)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: i_card
      type(model_t), intent(inout) :: model
      type(draft_t), intent(inout) :: draft
      integer(ip) :: b, k, first

      first = model%mesh%n_elements + 1
      b = draft%block_of_card(i_card)
      if (b == 0) return
      do
         call place_elements_of(deck, b, model, draft)
         if (b == draft%n_blocks) exit
         if (draft%blocks(b + 1)%card /= i_card) exit
         b = b + 1
      end do
      if (allocated(draft%blocks(b)%array)) call grow_set(model%element_sets, draft%blocks(b)%array, &
                                                          [(k, k=first, model%mesh%n_elements)])
   end subroutine place_block_elements

   subroutine place_elements_of(deck, b, model, draft)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: b                     !< place in draft%blocks
      type(model_t), intent(inout) :: model
      type(draft_t), intent(inout) :: draft
      integer(ip) :: k, n
      logical :: ok

      associate (block => draft%blocks(b), i_card => draft%blocks(b)%card)
         n = count_elements(block)
         block%first_element = model%mesh%n_elements + 1
         ok = draft%greatest_element <= huge(1_ip) - n
         if (ok) then
            call reserve_mesh(model%mesh, 0_ip, draft%elements_to_come)   ! with those of the blocks that follow
            call add_block(model%mesh, draft%greatest_element + 1, block%state, block%order, block%nodes)
            call note_places(draft%element_place, block%first_element, model%mesh%n_elements, -i_card)
            draft%greatest_element = draft%greatest_element + n
         else
            call report_error(deck, deck%cards(i_card)%place, 'E-ID', 'the element numbers of the block, which follow the '// &
                              'greatest so far, are too large', keyword='BLOCK')
         end if
         draft%elements_to_come = draft%elements_to_come - n
         call grow_set(model%element_sets, block%name, [(k, k=block%first_element, model%mesh%n_elements)])
      end associate
   end subroutine place_elements_of

   pure integer(ip) function count_elements(block) result(n)
      type(block_t), intent(in) :: block

      n = (ubound(block%nodes, 1, kind=ip)/block%order)*(ubound(block%nodes, 2, kind=ip)/block%order)
   end function count_elements

end module atrito_build_block
