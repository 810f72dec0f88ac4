!> *NSET and *ELSET: lists of numbers and earlier sets, or ranges of numbers (GENERATE).
module atrito_build_sets
   use atrito_build_lines, only: is_line_item
   use atrito_build_nodes, only: put_node_set
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t, token_text, line_item, is_id_token, is_empty_token, keyword_name, &
                          scope_shift, scope_text, model_number
   use atrito_diagnostics, only: report_error, report_note
   use atrito_build_context, only: build_context_t, place_text, ids_text, has_errors
   use atrito_id_map, only: id_map_t, find_id, is_whole_sequence
   use atrito_items, only: get_integer, has_option, option_text
   use atrito_kinds, only: ip
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_ranges, only: ranges_t, add_range, add_numbers, add_ranges, count_numbers
   use atrito_references, only: get_id, find_nodes, find_elements
   use atrito_sets, only: set_list_t, find_set, grow_set
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: try_set_card, read_set_card

contains

   !> Reads a *NSET or *ELSET when all of its members are known by now, so that a *NFILL, *BLOCK or *ELCOPY below can use it. One
   !> with members that follow later is left to read_set_card.
   subroutine try_set_card(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in the deck's cards
      type(build_context_t), intent(inout) :: context
      logical :: known

      associate (deck => context%deck, card => context%deck%cards(i_card))
         if (keyword_name(card) == 'NSET') then
            known = members_are_known(deck, card, context%model%mesh%node_map, context%model%node_sets)
         else
            known = members_are_known(deck, card, context%model%mesh%element_map, context%model%element_sets)
         end if
      end associate
      if (.not. known) return
      call read_set_card(i_card, context)
      context%card_done(i_card) = .true.
   end subroutine try_set_card

   pure logical function members_are_known(deck, card, map, sets) result(known)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(id_map_t), intent(in) :: map                !< of the numbers there are
      type(set_list_t), intent(in) :: sets

      if (has_option(deck, card, 'GENERATE')) then
         known = ranges_are_known(deck, card, map)
      else
         known = items_are_known(deck, card, map, sets)
      end if
   end function members_are_known

   pure logical function items_are_known(deck, card, map, sets) result(known)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(id_map_t), intent(in) :: map
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
         do k = range(1), range(2), towards(range(1), range(2), range(3))
            known = find_id(map, k) > 0
            if (.not. known) return
         end do
      end do
   end function ranges_are_known

   !> *NSET and *ELSET.
   subroutine read_set_card(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in the deck's cards
      type(build_context_t), intent(inout) :: context
      type(ranges_t) :: members
      type(id_map_t) :: none
      character(len=:), allocatable :: name, keyword
      integer(ip) :: i
      logical :: found

      associate (card => context%deck%cards(i_card))
         keyword = keyword_name(card)
         call option_text(context%deck, card, keyword, name, found)
         if (.not. found) return
         do i = card%first_line, card%first_line + card%n_lines - 1
            if (.not. context%deck%lines(i)%ok) cycle
            if (.not. has_option(context%deck, card, 'GENERATE')) then
               call read_items(context%deck%lines(i), i_card, context, members)
            else if (keyword == 'NSET') then
               call read_range(context%deck, context%deck%lines(i), context%model%mesh%node_map, context%nodes%invalid, none, &
                               'node', members)
            else
               call read_range(context%deck, context%deck%lines(i), context%model%mesh%element_map, context%elements%invalid, &
                               context%lines%ids, 'element', members)
            end if
         end do
      end associate
      if (keyword == 'NSET') then
         call put_node_set(context, i_card, name, members)
      else if (count_numbers(members) > 0 .or. find_set(context%lines%sets, name) == 0) then
         call grow_set(context%model%element_sets, name, members)
      end if
   end subroutine read_set_card

   subroutine read_items(line, i_card, context, members)
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(inout) :: context
      type(ranges_t), intent(inout) :: members
      type(token_t) :: token
      integer(ip), allocatable :: found(:)
      integer(ip) :: i, i_set
      logical :: ok

      do i = 1, line%n_tokens
         token = line_item(context%deck, line, i)
         if (keyword_name(context%deck%cards(i_card)) == 'NSET') then
            i_set = set_of_item(context, token, context%model%node_sets)
            if (i_set > 0) then
               if (is_earlier(token, i_card, context)) call add_ranges(members, context%model%node_sets%sets(i_set)%members)
               cycle
            end if
            call find_nodes(context, token, found, ok, 'NSET')
         else if (is_line_item(context, token)) then
            cycle                                      ! read_lines has it
         else
            i_set = set_of_item(context, token, context%model%element_sets)
            if (i_set > 0) then
               call add_ranges(members, context%model%element_sets%sets(i_set)%members)
               cycle
            end if
            call find_elements(context, token, found, ok, 'ELSET')
            if (.not. ok) context%sections_undetermined = .true.
         end if
         if (ok) call add_numbers(members, found)
      end do
   end subroutine read_items

   !> The set that an item names, whose members are taken over as they are; 0: there is none, or it is a number.
   pure integer(ip) function set_of_item(context, token, sets) result(i)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: token
      type(set_list_t), intent(in) :: sets

      i = 0
      if (.not. is_id_token(context%deck, token)) i = find_set(sets, token_text(context%deck, token))
   end function set_of_item

   !> A set in a list must be an earlier one: it could not be complete otherwise.
   logical function is_earlier(token, i_card, context)
      type(token_t), intent(in) :: token
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(in) :: context
      integer(ip) :: i

      is_earlier = .true.
      if (is_id_token(context%deck, token)) return
      i = find_set(context%model%node_sets, token_text(context%deck, token))
      if (keyword_name(context%deck%cards(context%set_card(i))) /= 'NSET') return
      is_earlier = context%set_card(i) < i_card
      if (.not. is_earlier) call report_error(context%deck, token, 'E-SET', 'node set '//token_text(context%deck, token)// &
                                 ' is defined later, in '//place_text(context%deck, context%deck%cards(context%set_card(i))%place, &
                                                                                   token), &
                                              expected='a node set that is defined above', keyword='NSET')
   end function is_earlier

   !> A line of GENERATE: first number, last number, increment.
   subroutine read_range(deck, line, map, invalid, others, noun, members)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      type(id_map_t), intent(in) :: map, invalid       !< known numbers, and those that an error invalid
      type(id_map_t), intent(in) :: others             !< numbers that are passed over
      character(len=*), intent(in) :: noun             !< 'node' or 'element'
      type(ranges_t), intent(inout) :: members
      character(len=:), allocatable :: keyword
      type(number_list_t) :: missing
      type(token_t) :: token
      integer(ip) :: first, last, step, k
      logical :: ok(3)

      keyword = trim(merge('NSET ', 'ELSET', noun == 'node'))
      token = line_item(deck, line, 1_ip)
      call get_id(deck, token, 'first '//noun//' number', first, ok(1), keyword)
      call get_id(deck, line_item(deck, line, 2_ip), 'last '//noun//' number', last, ok(2), keyword)
      call get_integer(deck, line_item(deck, line, 3_ip), 'increment, an integer', step, ok(3), 1_ip, keyword)
      if (.not. all(ok)) return
      if (.not. is_range(deck, line, first, last, step, keyword)) return
      if ((last - first)/step >= map%n + invalid%n + others%n) then
         call report_error(deck, line_item(deck, line, 1_ip), 'E-'//trim(merge('NODE   ', 'ELEMENT', noun == 'node')), &
                           'there are only '//to_text(map%n)//' '//noun//'s', expected='numbers that all exist', keyword=keyword)
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
      call report_error(deck, line_item(deck, line, 1_ip), 'E-'//trim(merge('NODE   ', 'ELEMENT', noun == 'node')), &
                        'no such '//noun//' in this range: '//ids_text(numbers_of(missing) - scope_shift(deck, token))// &
                        scope_text(deck, token), &
                        expected='numbers that all exist', keyword=keyword)
   end subroutine read_range

   !> The increment from first to last: of a range that goes down it is negative, however it is written.
   pure integer(ip) function towards(first, last, step)
      integer(ip), intent(in) :: first, last, step

      towards = step
      if (last < first) towards = -abs(step)
   end function towards

   !> Increments that lead from first towards last. What other programs read in another way, or silently, is told.
   logical function is_range(deck, line, first, last, step, keyword)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: first, last
      integer(ip), intent(inout) :: step
      character(len=*), intent(in) :: keyword
      integer(ip) :: shift, rest
      type(token_t) :: place

      shift = scope_shift(deck, line_item(deck, line, 1_ip))
      place = line_item(deck, line, merge(3_ip, 2_ip, line%n_tokens > 2))
      is_range = step > 0 .or. (step < 0 .and. last < first)
      if (.not. is_range) then
         call report_error(deck, place, 'E-VALUE', 'steps of '//to_text(step)//' do not lead from '//to_text(first - shift)// &
                           ' to '//to_text(last - shift), expected='an increment > 0', keyword=keyword)
         return
      end if
      step = towards(first, last, step)
      rest = mod(last - first, step)
      if (rest /= 0) call report_note(deck, place, 'N-RANGE', 'steps of '//to_text(abs(step))//' do not end at '// &
                                      to_text(last - shift)//'; the last number is '//to_text(last - rest - shift), keyword=keyword)
      if (last < first) call report_note(deck, line_item(deck, line, 2_ip), 'N-RANGE', 'the range goes down: all from '// &
                                         to_text(first - shift)//' to '//to_text(last - rest - shift)//' are taken', &
                                         keyword=keyword)
   end function is_range

end module atrito_build_sets
