!> *NSET and *ELSET: lists of numbers and earlier sets, or ranges of numbers (GENERATE); *NCOPY and *ELCOPY: the nodes and elements
!> of a set once more, elsewhere and with other numbers.
module atrito_build_sets
   use atrito_build_context, only: build_context_t, place_text, ids_text, has_errors, invalidate_block
   use atrito_build_elements, only: copy_element_once
   use atrito_build_lines, only: is_line_item
   use atrito_build_nodes, only: put_node_set, place_node
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t, token_text, line_item, is_id_token, is_empty_token, keyword_name, &
                          scope_shift, scope_text, model_number
   use atrito_diagnostics, only: report_error, report_note
   use atrito_growth, only: make_room, number_list_t, add_number, numbers_of
   use atrito_id_map, only: id_map_t, find_id, is_whole_sequence
   use atrito_items, only: get_integer, has_option, option_text, option_integer
   use atrito_kinds, only: ip, lp, wp
   use atrito_model_memory, only: fits_memory
   use atrito_coordinates, only: motion_t, read_shift, read_rotation, moved
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_places, only: read_places
   use atrito_sets, only: ranges_t, add_range, add_numbers, add_ranges, count_numbers, set_list_t, find_set, grow_set, members_of
   use atrito_references, only: get_id, find_nodes, find_elements, report_unknown
   use atrito_strings, only: to_text, upper_case
   implicit none (type, external)
   private
   public :: try_set_card, read_set_card, read_copy_card

contains

   !> Reads a *NSET or *ELSET when all of its members are known by now, so that a *NFILL, *BLOCK or *ELCOPY below can use it. One
   !> with members that follow later is left to read_set_card.
   subroutine try_set_card(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in the deck's cards
      type(build_context_t), intent(inout) :: context  !< the set and card_done, where all members are known
      logical :: known

      associate (deck => context%deck, card => context%deck%cards(i_card), model => context%model)
         if (has_option(deck, card, 'AT') .or. (keyword_name(card) == 'NSET' .and. has_option(deck, card, 'ELSET'))) then
            known = .false.                            ! all nodes and elements belong to it
         else if (has_option(deck, card, 'GENERATE') .and. keyword_name(card) == 'NSET') then
            known = ranges_are_known(deck, card, model%mesh%node_map)
         else if (has_option(deck, card, 'GENERATE')) then
            known = ranges_are_known(deck, card, model%mesh%element_map)
         else if (keyword_name(card) == 'NSET') then
            known = items_are_known(deck, card, model%mesh%node_map, model%node_sets)
         else
            known = items_are_known(deck, card, model%mesh%element_map, model%element_sets)
         end if
      end associate
      if (.not. known) return
      call read_set_card(i_card, context)
      context%card_done(i_card) = .true.
   end subroutine try_set_card

   !> All numbers and sets in the lines of a card exist.
   pure logical function items_are_known(deck, card, map, sets) result(known)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(id_map_t), intent(in) :: map                !< of the numbers there are
      type(set_list_t), intent(in) :: sets
      integer(ip) :: i, t, id
      integer :: outcome

      known = .true.
      do i = card%first_line, card%first_line + card%n_lines - 1
         do t = deck%lines(i)%first_token, deck%lines(i)%first_token + deck%lines(i)%n_tokens - 1
            if (is_empty_token(deck%tokens(t))) cycle
            if (is_id_token(deck, deck%tokens(t))) then
               call read_integer(token_text(deck, deck%tokens(t)), id, outcome)
               known = outcome == NUMBER_OK
               if (known) known = find_id(map, model_number(deck, deck%tokens(t), id)) > 0
            else
               known = find_set(sets, token_text(deck, deck%tokens(t))) > 0
            end if
            if (.not. known) return
         end do
      end do
   end function items_are_known

   !> All numbers in the ranges of a card exist.
   pure logical function ranges_are_known(deck, card, map) result(known)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(id_map_t), intent(in) :: map
      integer(ip) :: i, k, range(3)
      integer :: outcome

      known = .true.
      do i = card%first_line, card%first_line + card%n_lines - 1
         range = [0_ip, 0_ip, 1_ip]
         do k = 1, min(3_ip, deck%lines(i)%n_tokens)
            if (is_empty_token(line_item(deck, deck%lines(i), k))) cycle
            call read_integer(token_text(deck, line_item(deck, deck%lines(i), k)), range(k), outcome)
            known = known .and. outcome == NUMBER_OK
         end do
         known = known .and. range(3) /= 0
         if (.not. known) return
         do k = 1, 2
            range(k) = model_number(deck, deck%tokens(deck%lines(i)%first_token), range(k))
         end do
         if (is_whole_sequence(map, range(1), range(2))) cycle
         do k = range(1), range(2), merge(-abs(range(3)), range(3), range(2) < range(1))
            known = find_id(map, k) > 0
            if (.not. known) return
         end do
      end do
   end function ranges_are_known

   !> *NSET and *ELSET.
   subroutine read_set_card(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in the deck's cards
      type(build_context_t), intent(inout) :: context  !< its node_sets or element_sets grow
      type(ranges_t) :: members
      type(id_map_t) :: none
      character(len=:), allocatable :: name
      integer(ip) :: i
      logical :: found, is_of_nodes

      associate (card => context%deck%cards(i_card), model => context%model)
         is_of_nodes = keyword_name(card) == 'NSET'
         call option_text(context%deck, card, keyword_name(card), name, found)
         if (.not. found) return
         if (is_of_nodes .and. card%ok) call read_places(card, context, members)
         do i = card%first_line, card%first_line + card%n_lines - 1
            associate (line => context%deck%lines(i))
               if (.not. line%ok .or. has_option(context%deck, card, 'AT')) cycle
               if (.not. has_option(context%deck, card, 'GENERATE')) then
                  if (is_of_nodes) call read_items(line, i_card, model%node_sets, context, members)
                  if (.not. is_of_nodes) call read_items(line, i_card, model%element_sets, context, members)
               else if (is_of_nodes) then
                  call read_range(context%deck, line, model%mesh%node_map, context%nodes%invalid, none, 'node', members)
               else
                  call read_range(context%deck, line, model%mesh%element_map, context%elements%invalid, context%lines%ids, &
                                  'element', members)
               end if
            end associate
         end do
      end associate
      if (is_of_nodes) then
         call put_node_set(context, i_card, name, members)
      else if (count_numbers(members) > 0 .or. find_set(context%lines%sets, name) == 0) then
         call grow_set(context%model%element_sets, name, members)
      end if
   end subroutine read_set_card

   !> A line of numbers and names of sets, whose members are taken over as they are. A node set in a list must be an earlier one: it
   !> could not be complete otherwise.
   subroutine read_items(line, i_card, sets, context, members)
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: i_card
      type(set_list_t), intent(in) :: sets             !< the node sets or the element sets of the model
      type(build_context_t), intent(inout) :: context
      type(ranges_t), intent(inout) :: members
      type(token_t) :: token
      integer(ip), allocatable :: found(:)
      type(card_t) :: maker                            ! of the node set
      integer(ip) :: i, i_set
      logical :: ok, is_of_nodes, is_later

      is_of_nodes = keyword_name(context%deck%cards(i_card)) == 'NSET'
      do i = 1, line%n_tokens
         token = line_item(context%deck, line, i)
         if (.not. is_of_nodes) then
            if (is_line_item(context, token)) cycle    ! read_lines has it
         end if
         i_set = 0
         if (.not. is_id_token(context%deck, token)) i_set = find_set(sets, token_text(context%deck, token))
         is_later = .false.
         if (is_of_nodes .and. i_set > 0) then
            maker = context%deck%cards(context%set_card(i_set))
            is_later = keyword_name(maker) == 'NSET' .and. context%set_card(i_set) >= i_card
         end if
         if (i_set == 0) then
            if (is_of_nodes) then
               call find_nodes(context, token, found, ok)
            else
               call find_elements(context, token, found, ok)
               if (.not. ok) context%sections_undetermined = .true.
            end if
            if (ok) call add_numbers(members, found)
         else if (is_later) then
            call report_error(context%deck, token, 'E-SET', 'node set '//token_text(context%deck, token)// &
                              ' is defined later, in '//place_text(context%deck, maker%place, token), &
                              expected='a node set that is defined above')
         else
            call add_ranges(members, sets%sets(i_set)%members)
         end if
      end do
   end subroutine read_items

   !> A line of GENERATE: first number, last number, increment.
   subroutine read_range(deck, line, map, invalid, others, noun, members)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(id_map_t), intent(in) :: map, invalid       !< known numbers, and those that an error invalid
      type(id_map_t), intent(in) :: others             !< numbers that are passed over
      character(len=*), intent(in) :: noun             !< 'node' or 'element'
      type(ranges_t), intent(inout) :: members
      character(len=:), allocatable :: id
      type(number_list_t) :: missing
      type(token_t) :: token
      integer(ip) :: first, last, step, k
      logical :: ok(3)

      id = 'E-'//upper_case(noun)
      token = line_item(deck, line, 1_ip)
      call get_id(deck, token, 'first '//noun//' number', first, ok(1))
      call get_id(deck, line_item(deck, line, 2_ip), 'last '//noun//' number', last, ok(2))
      call get_integer(deck, line_item(deck, line, 3_ip), 'increment, an integer', step, ok(3), 1_ip)
      if (.not. all(ok)) return
      if (.not. is_range(deck, line, first, last, step)) return
      if ((last - first)/step >= map%n + invalid%n + others%n) then
         call report_error(deck, token, id, 'there are only '//to_text(map%n)//' '//noun//'s', expected='numbers that all exist')
         return
      end if
      if (step == 1 .and. is_whole_sequence(map, first, last)) then
         call add_range(members, find_id(map, first), find_id(map, last))
         return
      end if
      do k = first, last, step
         if (find_id(map, k) > 0) then
            call add_range(members, find_id(map, k), find_id(map, k))
         else if (find_id(others, k) > 0) then
            cycle                                      ! a line, which read_lines has
         else if (find_id(invalid, k) == 0 .or. .not. has_errors()) then
            call add_number(missing, k)
         end if
      end do
      if (missing%n == 0) return
      call report_error(deck, token, id, 'no such '//noun//' in this range: '//ids_text(numbers_of(missing) - &
                                                                                        scope_shift(deck, token))// &
                        scope_text(deck, token), expected='numbers that all exist')
   end subroutine read_range

   !> Increments that lead from first towards last. What other programs read in another way, or silently, is reported.
   logical function is_range(deck, line, first, last, step)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: first, last
      integer(ip), intent(inout) :: step
      integer(ip) :: shift, rest
      type(token_t) :: place

      shift = scope_shift(deck, line_item(deck, line, 1_ip))
      place = line_item(deck, line, merge(3_ip, 2_ip, line%n_tokens > 2))
      is_range = step > 0 .or. (step < 0 .and. last < first)
      if (.not. is_range) then
         call report_error(deck, place, 'E-VALUE', 'steps of '//to_text(step)//' do not lead from '//to_text(first - shift)// &
                           ' to '//to_text(last - shift), expected='an increment > 0')
         return
      end if
      if (last < first) step = -abs(step)              ! however it is written
      rest = mod(last - first, step)
      if (rest /= 0) call report_note(deck, place, 'N-RANGE', 'steps of '//to_text(abs(step))//' do not end at '// &
                                      to_text(last - shift)//'; the last number is '//to_text(last - rest - shift))
      if (last < first) call report_note(deck, line_item(deck, line, 2_ip), 'N-RANGE', 'the range goes down: all from '// &
                                         to_text(first - shift)//' to '//to_text(last - rest - shift)//' are taken')
   end function is_range

   !> *NCOPY: the nodes of a set, moved; *ELCOPY: the elements of a set on other nodes, which are there already. The first number
   !> that cannot be ends it: the others would fail for the same reason.
   subroutine read_copy_card(i_card, context)
      integer(ip), intent(in) :: i_card              !< place in deck%cards
      type(build_context_t), intent(inout) :: context !< its mesh gets nodes or elements, NEW SET the set
      type(motion_t) :: motion
      type(token_t) :: place
      integer(ip), allocatable :: members(:)
      character(len=:), allocatable :: name
      integer(lp) :: id
      integer(ip) :: shift, node_shift, i, first
      logical :: ok(3), found, fits, is_of_nodes

      associate (deck => context%deck, card => context%deck%cards(i_card), mesh => context%model%mesh)
         is_of_nodes = keyword_name(card) == 'NCOPY'
         if (is_of_nodes) then
            call read_motion(deck, card, motion, ok(1))
            call read_shift_of_numbers(deck, card, 'CHANGE NUMBER', shift, place, ok(2))
            call find_old_set(card, 'node set', context%model%node_sets, context, members, ok(3))
         else
            ! sets of elements are read after all elements, those that are wanted here before
            call try_pending_sets(i_card, context)
            call read_shift_of_numbers(deck, card, 'ELEMENT SHIFT', shift, place, ok(1))
            call read_shift_of_numbers(deck, card, 'SHIFT NODES', node_shift, place, ok(2))
            call find_old_set(card, 'element set', context%model%element_sets, context, members, ok(3))
         end if
         call option_text(deck, card, 'NEW SET', name, found)
         fits = all(ok)
         if (fits) fits = fits_memory(place, context, merge(size(members, kind=lp), 0_lp, is_of_nodes), &
                                      merge(0_lp, size(members, kind=lp), is_of_nodes))
         first = merge(mesh%n_nodes, mesh%n_elements, is_of_nodes) + 1
         do i = 1, size(members, kind=ip)
            if (.not. fits) exit
            if (.not. is_of_nodes) then
               call copy_element_once(place, -i_card, context, members(i), int([node_shift, shift], lp), fits)
               cycle
            end if
            id = int(mesh%node_id(members(i)), lp) + int(shift, lp)
            if (id > 0_lp .and. id <= int(huge(1_ip), lp)) then
               call place_node(context, int(id, ip), moved(motion, mesh%x(:, members(i))), -i_card, fits)
            else
               fits = .false.
               call report_error(deck, place, 'E-ID', 'node '//to_text(mesh%node_id(members(i)))//' would become '//to_text(id), &
                                 expected='positive node numbers that are not too large')
            end if
         end do
         if (.not. fits) call invalidate_block(context, name)
         if (.not. found .or. .not. all(ok)) return
         if (is_of_nodes) call put_node_set(context, i_card, name, [(i, i=first, mesh%n_nodes)])
         if (.not. is_of_nodes) call grow_set(context%model%element_sets, name, [(i, i=first, mesh%n_elements)])
      end associate
   end subroutine read_copy_card

   !> An option that must be there: what is added to numbers; and its place.
   subroutine read_shift_of_numbers(deck, card, name, shift, place, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: name
      integer(ip), intent(out) :: shift
      type(token_t), intent(out) :: place
      logical, intent(out) :: ok
      character(len=:), allocatable :: text

      shift = 0
      call option_text(deck, card, name, text, ok, place)
      call option_integer(deck, card, name, 'difference of the numbers, an integer', shift, ok)
   end subroutine read_shift_of_numbers

   !> The members of OLD SET=, which is defined above.
   subroutine find_old_set(card, noun, sets, context, members, ok)
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: noun           !< 'node set' or 'element set'
      type(set_list_t), intent(in) :: sets
      type(build_context_t), intent(in) :: context
      integer(ip), allocatable, intent(out) :: members(:)
      logical, intent(out) :: ok
      character(len=:), allocatable :: name
      type(token_t) :: place
      integer(ip) :: i

      allocate (members(0))
      call option_text(context%deck, card, 'OLD SET', name, ok, place)
      if (.not. ok) return
      i = find_set(sets, name)
      ok = i > 0
      if (ok) then
         members = members_of(sets%sets(i))
      else
         call report_unknown(context, place, 'earlier '//noun, 'E-SET', sets%names)
      end if
   end subroutine find_old_set

   !> The translation, and the rotation as often as MULTIPLE= says.
   subroutine read_motion(deck, card, motion, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(motion_t), intent(out) :: motion
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'how often the rotation is done, a positive integer'
      character(len=:), allocatable :: text
      type(token_t) :: place
      integer(ip) :: times
      logical :: good

      times = 1
      call option_integer(deck, card, 'MULTIPLE', WHAT, times, good)
      if (times < 1) then
         call option_text(deck, card, 'MULTIPLE', text, good, place)
         call report_error(deck, place, 'E-VALUE', 'MULTIPLE = '//to_text(times), expected=WHAT)
      end if
      ok = times >= 1 .and. card%n_lines > 0 .and. all(deck%lines(card%first_line:card%first_line + card%n_lines - 1)%ok)
      if (.not. ok) return
      call read_shift(deck, deck%lines(card%first_line), motion, ok)
      if (card%n_lines > 1) then
         call read_rotation(deck, deck%lines(card%first_line + 1), real(times, wp), motion, good)
         ok = ok .and. good
      end if
   end subroutine read_motion

   !> Reads the sets of elements above a card that can be read by now.
   subroutine try_pending_sets(i_card, context)
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i, n

      do i = context%last_elset + 1, i_card - 1
         if (keyword_name(context%deck%cards(i)) /= 'ELSET') cycle
         call make_room(context%pending_elsets, context%n_pending, context%n_pending + 1)
         context%n_pending = context%n_pending + 1
         context%pending_elsets(context%n_pending) = i
      end do
      context%last_elset = max(context%last_elset, i_card - 1)
      n = 0
      do i = 1, context%n_pending
         associate (card => context%pending_elsets(i))
            if (.not. context%card_done(card)) call try_set_card(card, context)
            if (context%card_done(card)) cycle
            n = n + 1
            context%pending_elsets(n) = card
         end associate
      end do
      context%n_pending = n
   end subroutine try_pending_sets

end module atrito_build_sets
