!> *NODE, *NGEN and *NFILL: the nodes of the mesh, in the order of the deck.
!>
!> Data lines of nodes and of elements that are numbers alone, of which there is nothing to tell, all threads read. A line that is
!> anything else is left to who reads line by line and has the messages.
module atrito_build_nodes
   use atrito_build_context, only: build_context_t, spoil_number, note_number, note_place
   use atrito_coordinates, only: get_coordinate, spread_of_nodes, FLAT, moved, is_coordinate
   use atrito_deck, only: data_line_t, line_item, keyword_name, deck_t, token_t
   use atrito_diagnostics, only: report_error
   use atrito_growth, only: number_list_t, add_numbers, numbers_of
   use atrito_items, only: get_integer, get_real, option_text
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: add_node, find_node, mesh_t
   use atrito_model_memory, only: fits_memory, most_nodes
   use atrito_numbers, only: read_integer, read_real, NUMBER_OK
   use atrito_sets, only: ranges_t, add_to_ranges => add_numbers, grow_set, set_count
   use atrito_references, only: get_id, find_nodes, find_one_node
   use atrito_sliding_motions, only: printed_digit_error
   use atrito_strings, only: to_text
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: read_node_card, read_fill_card, place_node, put_node_set, note_digits, read_plain_nodes, read_plain_elements, SLICE

   character(len=*), parameter :: WHAT_STEP = 'increment of the numbers, an integer'

   !> Puts nodes into a node set and keeps which card made it: call put_node_set(context, i_card, name, places), or a ranges_t.
   interface put_node_set
      module procedure put_node_numbers, put_node_ranges
   end interface put_node_set

   !> Lines that are read at a time: their numbers need no more memory than this.
   integer(ip), parameter :: SLICE = 262144_ip

contains

   !> To what the places are known that the deck gives, where other nodes are made of them: those have more digits.
   subroutine note_digits(is_refined, context)
      logical, intent(in) :: is_refined                !< nodes of a finer mesh will be made
      type(build_context_t), intent(inout) :: context  !< with all nodes; digit_error of its mesh is set
      integer(ip), allocatable :: given(:)
      integer(ip) :: i

      associate (mesh => context%model%mesh)
         given = pack([(i, i=1, mesh%n_nodes)], context%nodes%place(:mesh%n_nodes) > 0)
         if (size(given) == 0 .or. (size(given) == mesh%n_nodes .and. .not. is_refined)) return
         mesh%digit_error = max(mesh%digit_error, printed_digit_error(mesh%x(:, given)))
      end associate
   end subroutine note_digits

   !> *NODE: number, x, y[, z].
   subroutine read_node_card(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      type(build_context_t), intent(inout) :: context  !< its mesh gets nodes, and NSET= the set
      integer(ip), allocatable :: id(:)
      real(wp), allocatable :: x(:, :)
      logical, allocatable :: is_plain(:)
      integer(ip) :: begin, last, i, k, first
      logical :: fits

      first = context%model%mesh%n_nodes + 1
      associate (card => context%deck%cards(i_card), lines => context%deck%lines)
         fits = fits_memory(card%place, context, int(card%n_lines, lp), 0_lp)
         k = min(SLICE, card%n_lines)
         allocate (id(k), x(2, k), is_plain(k))
         do begin = card%first_line, card%first_line + card%n_lines - 1, SLICE
            last = min(card%first_line + card%n_lines, begin + SLICE) - 1
            if (fits) call read_plain_nodes(context%deck, lines(begin:last), id, x, is_plain)
            do i = begin, last
               k = i - begin + 1
               if (.not. fits) then
                  call spoil_number(context%deck, lines(i), context%nodes)
               else if (is_plain(k)) then
                  call place_moved_node(context, id(k), x(:, k), lines(i)%first_token)
               else
                  call read_node_line(lines(i), context)
               end if
            end do
         end do
      end associate
      call put_named_set(i_card, context, [(i, i=first, context%model%mesh%n_nodes)])
   end subroutine read_node_card

   !> Adds a node that stands in a line of its own; that of an instance where the instance is.
   subroutine place_moved_node(context, id, x, token)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: id
      real(wp), intent(in) :: x(2)                     !< as it stands there [L]
      integer(ip), intent(in) :: token                 !< of the deck: its number
      real(wp) :: place(2)
      logical :: ok

      place = x
      if (context%deck%tokens(token)%scope > 0) place = moved(context%motions(context%deck%tokens(token)%scope), x)
      call place_node(context, id, place, token, ok)
   end subroutine place_moved_node

   !> A line of *NODE that is not just plain numbers: number, x, y[, z].
   subroutine read_node_line(line, context)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(inout) :: context
      real(wp) :: x(2), z
      integer(ip) :: id
      logical :: ok(4)

      ok = line%ok
      associate (deck => context%deck)
         if (line%ok) then
            call get_id(deck, deck%tokens(line%first_token), 'node number', id, ok(1))
            call get_coordinate(deck, line_item(deck, line, 2_ip), 'x, a real [L]', x(1), ok(2), 0.0_wp)
            call get_coordinate(deck, line_item(deck, line, 3_ip), 'y, a real [L]', x(2), ok(3), 0.0_wp)
            z = 0.0_wp
            if (line%n_tokens > 3) call get_real(deck, line_item(deck, line, 4_ip), 'z [L], which is 0 in the plane', z, ok(4), &
                                                 0.0_wp)
            if (ok(4) .and. abs(z) > 0.0_wp) then
               if (context%spread < 0.0_wp) context%spread = spread_of_nodes(deck)
               ok(4) = abs(z) <= FLAT*context%spread
               if (.not. ok(4)) call report_error(deck, line_item(deck, line, 4_ip), 'E-VALUE', 'the scene is plane: z is not 0', &
                                                  expected='z = 0 [L], or no third coordinate')
            end if
         end if
         if (all(ok)) then
            call place_moved_node(context, id, x, line%first_token)
         else
            call spoil_number(deck, line, context%nodes)
         end if
      end associate
   end subroutine read_node_line

   !> Adds a node and keeps where it comes from; a number given twice is an error.
   subroutine place_node(context, id, x, place, ok)
      type(build_context_t), intent(inout) :: context  !< its mesh gets the node
      integer(ip), intent(in) :: id                    !< > 0
      real(wp), intent(in) :: x(2)                     !< [L]
      integer(ip), intent(in) :: place                 !< token (> 0) or card (< 0) of the deck
      logical, intent(out) :: ok                       !< the number was free; else that is reported
      integer(ip) :: i
      logical :: known

      call add_node(context%model%mesh, id, x, known)
      ok = .not. known
      i = context%model%mesh%n_nodes
      if (known) i = find_node(context%model%mesh, id)
      call note_number(context%deck, context%nodes, 'node', id, i, place, known)
   end subroutine place_node

   subroutine put_node_numbers(context, i_card, name, members)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: i_card
      character(len=*), intent(in) :: name
      integer(ip), intent(in) :: members(:)            !< places
      type(ranges_t) :: ranges

      call add_to_ranges(ranges, members)
      call put_node_ranges(context, i_card, name, ranges)
   end subroutine put_node_numbers

   subroutine put_node_ranges(context, i_card, name, members)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: i_card
      character(len=*), intent(in) :: name
      type(ranges_t), intent(in) :: members            !< places
      integer(ip) :: n

      n = set_count(context%model%node_sets)
      call grow_set(context%model%node_sets, name, members)
      if (set_count(context%model%node_sets) > n) call note_place(context%set_card, n + 1, i_card)
   end subroutine put_node_ranges

   !> *NGEN and *NFILL: nodes between two nodes, or between those of two sets, line by line. A set NSET= has all of them.
   subroutine read_fill_card(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      type(build_context_t), intent(inout) :: context  !< its mesh gets nodes, and NSET= the set
      type(number_list_t) :: members
      integer(ip), allocatable :: from(:), to(:)
      integer(ip) :: i, k, n, step, first_new
      logical :: ok

      associate (card => context%deck%cards(i_card))
         do i = card%first_line, card%first_line + card%n_lines - 1
            if (.not. context%deck%lines(i)%ok) cycle
            if (keyword_name(card) == 'NGEN') then
               call read_ngen_line(context%deck%lines(i), from, to)
            else
               call read_nfill_line(context%deck%lines(i), context, from, to, n, step, ok)
            end if
            if (.not. ok) cycle
            first_new = context%model%mesh%n_nodes + 1
            call fill_lines(context%deck%lines(i)%first_token)
            call add_numbers(members, from)
            call add_numbers(members, [(k, k=first_new, context%model%mesh%n_nodes)])
            call add_numbers(members, to)
         end do
      end associate
      call put_named_set(i_card, context, numbers_of(members))

   contains

      !> First node, last node, increment of the numbers, which leads from the first to the last.
      subroutine read_ngen_line(line, from, to)
         type(data_line_t), intent(in) :: line
         integer(ip), allocatable, intent(out) :: from(:), to(:)   !< places of the two nodes
         integer(ip) :: apart
         logical :: good(3)

         allocate (from(1), to(1))
         call find_one_node(context, context%deck%tokens(line%first_token), from(1), good(1))
         call find_one_node(context, line_item(context%deck, line, 2_ip), to(1), good(2))
         call get_integer(context%deck, line_item(context%deck, line, 3_ip), WHAT_STEP, step, good(3), 1_ip)
         ok = all(good)
         if (.not. ok) return
         associate (first => context%model%mesh%node_id(from(1)), last => context%model%mesh%node_id(to(1)))
            apart = last - first
            n = 0
            if (step /= 0) n = apart/step
            ok = n > 0 .and. n*step == apart .and. int(n, lp) <= most_nodes()
            if (.not. ok) call report_error(context%deck, line_item(context%deck, line, merge(3_ip, 2_ip, line%n_tokens > 2)), &
                                            'E-VALUE', 'steps of '//to_text(step)//' do not lead from node '//to_text(first)// &
                                            ' to node '//to_text(last), expected='an increment that divides '//to_text(apart))
         end associate
         if (ok) ok = fits_memory(context%deck%tokens(line%first_token), context, int(n, lp), 0_lp)
      end subroutine read_ngen_line

      !> Nodes between each two, equally spaced, numbered by `step` from the first of the two.
      subroutine fill_lines(place)
         integer(ip), intent(in) :: place
         real(wp) :: t, x(2)
         integer(ip) :: i, k
         logical :: ok

         do i = 1, size(from, kind=ip)
            do k = 1, n - 1
               t = real(k, wp)/real(n, wp)
               x = (1 - t)*context%model%mesh%x(:, from(i)) + t*context%model%mesh%x(:, to(i))
               call place_node(context, context%model%mesh%node_id(from(i)) + k*step, x, place, ok)
               if (.not. ok) return
            end do
         end do
      end subroutine fill_lines
   end subroutine read_fill_card

   !> Two sets of as many nodes, number of intervals, increment of the numbers, which stay positive and in the range of an integer.
   subroutine read_nfill_line(line, context, from, to, n, step, ok)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(inout) :: context
      integer(ip), allocatable, intent(out) :: from(:), to(:)   !< places, node by node
      integer(ip), intent(out) :: n, step              !< as of read_ngen_line
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'number of intervals, a positive integer'
      integer(lp) :: reach
      logical :: good(4)

      associate (deck => context%deck)
         call find_nodes(context, deck%tokens(line%first_token), from, good(1))
         call find_nodes(context, line_item(deck, line, 2_ip), to, good(2))
         call get_integer(deck, line_item(deck, line, 3_ip), WHAT, n, good(3))
         call get_integer(deck, line_item(deck, line, 4_ip), WHAT_STEP, step, good(4), 1_ip)
         ok = all(good)
         if (good(3) .and. n < 1) then
            ok = .false.
            call report_error(deck, line_item(deck, line, 3_ip), 'E-VALUE', to_text(n)//' intervals', expected=WHAT)
         end if
         if (all(good(:2)) .and. size(from) /= size(to)) then
            ok = .false.
            call report_error(deck, line_item(deck, line, 2_ip), 'E-SET', 'the two sets have '//to_text(size(from, kind=ip))// &
                              ' and '//to_text(size(to, kind=ip))//' nodes', expected='two node sets of as many nodes')
         end if
         if (.not. ok) return
         reach = int(n - 1, lp)*int(step, lp)
         if (n > 1 .and. size(from) > 0) then
            associate (ids => context%model%mesh%node_id(from))
               ok = minval(ids) + reach > 0_lp .and. maxval(ids) + reach <= int(huge(1_ip), lp) .and. step /= 0 &
                    .and. int(n, lp)*size(ids, kind=lp) <= most_nodes()
            end associate
         end if
         if (.not. ok) call report_error(deck, line_item(deck, line, 3_ip), 'E-VALUE', to_text(n)//' intervals in steps of '// &
                                         to_text(step)//' lead to node numbers that cannot be', &
                                         expected='positive node numbers, at most '//to_text(most_nodes())//' nodes')
      end associate
      if (ok) ok = fits_memory(context%deck%tokens(line%first_token), context, int(n - 1, lp)*size(from, kind=lp), 0_lp)
   end subroutine read_nfill_line

   !> The set that NSET= of a card names.
   subroutine put_named_set(i_card, context, members)
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: members(:)
      character(len=:), allocatable :: name
      logical :: found

      call option_text(context%deck, context%deck%cards(i_card), 'NSET', name, found)
      if (found .and. len(name) > 0) call put_node_set(context, i_card, name, members)
   end subroutine put_named_set

   !> The numbers and coordinates of lines of *NODE, as they stand there: those of an instance are not moved.
   subroutine read_plain_nodes(deck, lines, id, x, is_plain)
      type(deck_t), intent(in) :: deck                 !< as read
      type(data_line_t), intent(in) :: lines(:)        !< of one card
      integer(ip), intent(inout) :: id(:)              !< (>= lines) in the model
      real(wp), intent(inout) :: x(:, :)               !< (2, >= lines) [L]
      logical, intent(inout) :: is_plain(:)            !< (>= lines) what is not has no numbers here
      real(wp) :: z
      integer(ip) :: i

      !$omp parallel do schedule(static) private(z) if (is_shared(size(lines, kind=ip)))
      do i = 1, size(lines, kind=ip)
         id(i) = 0
         x(:, i) = 0.0_wp
         z = 0.0_wp
         is_plain(i) = lines(i)%ok .and. (lines(i)%n_tokens == 3 .or. lines(i)%n_tokens == 4)
         if (.not. is_plain(i)) cycle
         associate (first => lines(i)%first_token)
            call read_id(deck, deck%tokens(first), id(i), is_plain(i))
            if (is_plain(i)) call read_coordinate(deck, deck%tokens(first + 1), x(1, i), is_plain(i))
            if (is_plain(i)) call read_coordinate(deck, deck%tokens(first + 2), x(2, i), is_plain(i))
            if (is_plain(i) .and. lines(i)%n_tokens == 4) call read_coordinate(deck, deck%tokens(first + 3), z, is_plain(i))
         end associate
         is_plain(i) = is_plain(i) .and. .not. abs(z) > 0.0_wp
      end do
   end subroutine read_plain_nodes

   !> The numbers of lines of *ELEMENT, and the places of their nodes, which are there and different.
   subroutine read_plain_elements(deck, mesh, lines, id, nodes, is_plain)
      type(deck_t), intent(in) :: deck                 !< as read
      type(mesh_t), intent(in) :: mesh                 !< its nodes are complete
      type(data_line_t), intent(in) :: lines(:)        !< of one card
      integer(ip), intent(inout) :: id(:)              !< (>= lines) in the model
      integer(ip), intent(inout) :: nodes(:, :)        !< (nodes of an element, >= lines)
      logical, intent(inout) :: is_plain(:)            !< (>= lines) what is not has no numbers here
      integer(ip) :: i, k, node_id

      !$omp parallel do schedule(static) private(k, node_id) if (is_shared(size(lines, kind=ip)))
      do i = 1, size(lines, kind=ip)
         id(i) = 0
         nodes(:, i) = 0
         is_plain(i) = lines(i)%ok .and. lines(i)%n_tokens == size(nodes, 1) + 1
         if (is_plain(i)) call read_id(deck, deck%tokens(lines(i)%first_token), id(i), is_plain(i))
         do k = 1, size(nodes, 1, kind=ip)
            if (is_plain(i)) call read_id(deck, deck%tokens(lines(i)%first_token + k), node_id, is_plain(i))
            if (.not. is_plain(i)) exit
            nodes(k, i) = find_node(mesh, node_id)
            is_plain(i) = nodes(k, i) > 0 .and. all(nodes(:k - 1, i) /= nodes(k, i))
         end do
      end do
   end subroutine read_plain_elements

   !> The number in the model of a node or element.
   pure subroutine read_id(deck, token, id, is_plain)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      integer(ip), intent(out) :: id
      logical, intent(out) :: is_plain
      integer :: outcome

      call read_integer(deck%sources(token%source)%text(token%first:token%last), id, outcome)
      is_plain = outcome == NUMBER_OK .and. id > 0
      if (.not. is_plain .or. .not. allocated(deck%scopes)) return
      associate (scope => deck%scopes(token%scope))
         is_plain = scope%ok .and. id <= scope%span
         if (is_plain) id = id + scope%shift
      end associate
   end subroutine read_id

   !> A coordinate that is a plain number.
   pure subroutine read_coordinate(deck, token, x, is_plain)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      real(wp), intent(out) :: x                       !< [L]
      logical, intent(out) :: is_plain
      integer :: outcome

      call read_real(deck%sources(token%source)%text(token%first:token%last), x, outcome)
      is_plain = outcome == NUMBER_OK
      if (is_plain) is_plain = is_coordinate(x)
   end subroutine read_coordinate

end module atrito_build_nodes
