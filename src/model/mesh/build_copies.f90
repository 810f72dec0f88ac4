!> *NCOPY and *ELCOPY: nodes and elements once more, elsewhere and with other numbers.
module atrito_build_copies
   use atrito_build_elements, only: copy_element_once
   use atrito_build_nodes, only: place_node, put_node_set
   use atrito_build_sets, only: try_set_card
   use atrito_deck, only: deck_t, card_t, token_t, option_t, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_build_context, only: build_context_t, invalidate_block
   use atrito_growth, only: make_room
   use atrito_items, only: find_option, option_integer, option_text
   use atrito_kinds, only: ip, lp, wp
   use atrito_model_memory, only: fits_memory
   use atrito_motion, only: motion_t, read_shift, read_rotation, moved
   use atrito_references, only: report_unknown
   use atrito_sets, only: find_set, grow_set, members_of
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_ncopy_card, read_elcopy_card

contains

   !> *NCOPY: the nodes of a set, moved.
   subroutine read_ncopy_card(i_card, context)
      integer(ip), intent(in) :: i_card              !< place in deck%cards
      type(build_context_t), intent(inout) :: context
      type(motion_t) :: motion
      type(token_t) :: token
      integer(ip), allocatable :: members(:)
      character(len=:), allocatable :: name
      integer(ip) :: change, i, first
      logical :: ok(4), found

      associate (card => context%deck%cards(i_card))
         call read_number(context%deck, card, 'CHANGE NUMBER', change, ok(1))
         call find_old_set(card, 'node set', context, members, ok(2))
         call read_motion(context%deck, card, motion, ok(3))
         call option_text(context%deck, card, 'NEW SET', name, found)
         if (.not. found) name = ''
         if (.not. all(ok(:3))) then
            call invalidate_block(context, name)
            return
         end if
         call find_place(context%deck, card, 'CHANGE NUMBER', token)
         ok(4) = fits_memory(token, context, size(members, kind=lp), 0_lp, 'NCOPY')
         first = context%model%mesh%n_nodes + 1
         do i = 1, size(members, kind=ip)
            if (ok(4)) call copy_node(i_card, token, context, members(i), change, motion, ok(4))
         end do
         if (.not. ok(4)) call invalidate_block(context, name)
         if (found) call put_node_set(context, i_card, name, [(i, i=first, context%model%mesh%n_nodes)])
      end associate
   end subroutine read_ncopy_card

   !> ok: .false. for the first number that cannot be: the others would fail for the same reason.
   subroutine copy_node(i_card, token, context, node, change, motion, ok)
      integer(ip), intent(in) :: i_card
      type(token_t), intent(in) :: token             !< of CHANGE NUMBER=
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: node, change
      type(motion_t), intent(in) :: motion
      logical, intent(out) :: ok
      integer(lp) :: id

      id = int(context%model%mesh%node_id(node), lp) + int(change, lp)
      ok = id > 0_lp .and. id <= int(huge(1_ip), lp)
      if (ok) then
         call place_node(context, int(id, ip), moved(motion, context%model%mesh%x(:, node)), -i_card, ok, 'NCOPY')
      else
         call report_error(context%deck, token, 'E-ID', 'node '//to_text(context%model%mesh%node_id(node))//' would become '// &
                           to_text(id), expected='positive node numbers that are not too large', keyword='NCOPY')
      end if
   end subroutine copy_node

   !> An integer option that must be there.
   subroutine read_number(deck, card, name, number, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: name
      integer(ip), intent(out) :: number
      logical, intent(out) :: ok

      number = 0
      call option_integer(deck, card, name, 'difference of the numbers, an integer', number, ok)
   end subroutine read_number

   subroutine find_place(deck, card, name, place)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: name
      type(token_t), intent(out) :: place            !< of the value of an option
      type(option_t) :: option
      logical :: found

      call find_option(deck, card, name, option, found)
      place = card%place
      if (found) place = option%value
   end subroutine find_place

   !> The members of OLD SET=, which is defined above.
   subroutine find_old_set(card, noun, context, members, ok)
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: noun           !< 'node set' or 'element set'
      type(build_context_t), intent(in) :: context
      integer(ip), allocatable, intent(out) :: members(:)
      logical, intent(out) :: ok
      character(len=:), allocatable :: name
      type(token_t) :: place
      integer(ip) :: i

      allocate (members(0))
      call option_text(context%deck, card, 'OLD SET', name, ok, place)
      if (.not. ok) return
      if (noun == 'node set') then
         i = find_set(context%model%node_sets, name)
         if (i > 0) members = members_of(context%model%node_sets%sets(i))
         if (i == 0) call report_unknown(context, place, 'earlier node set', 'E-SET', context%model%node_sets%names, 'NCOPY')
      else
         i = find_set(context%model%element_sets, name)
         if (i > 0) members = members_of(context%model%element_sets%sets(i))
         if (i == 0) call report_unknown(context, place, 'earlier element set', 'E-SET', context%model%element_sets%names, 'ELCOPY')
      end if
      ok = i > 0
   end subroutine find_old_set

   !> The translation, and the rotation as often as MULTIPLE= says.
   subroutine read_motion(deck, card, motion, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(motion_t), intent(out) :: motion
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'how often the rotation is done, a positive integer'
      type(token_t) :: place
      integer(ip) :: times, k
      logical :: good

      ok = card%n_lines > 0
      times = 1
      call option_integer(deck, card, 'MULTIPLE', WHAT, times, good)
      if (times < 1) then
         ok = .false.
         call find_place(deck, card, 'MULTIPLE', place)
         call report_error(deck, place, 'E-VALUE', 'MULTIPLE = '//to_text(times), expected=WHAT, keyword='NCOPY')
      end if
      do k = card%first_line, card%first_line + card%n_lines - 1
         ok = ok .and. deck%lines(k)%ok
      end do
      if (.not. ok) return
      call read_shift(deck, deck%lines(card%first_line), 'NCOPY', motion, ok)
      if (card%n_lines > 1) then
         call read_rotation(deck, deck%lines(card%first_line + 1), 'NCOPY', real(times, wp), motion, good)
         ok = ok .and. good
      end if
   end subroutine read_motion

   !> *ELCOPY: the elements of a set on other nodes, which are there already.
   subroutine read_elcopy_card(i_card, context)
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(inout) :: context
      type(token_t) :: token
      integer(ip), allocatable :: members(:)
      character(len=:), allocatable :: name
      integer(ip) :: shift, node_shift, i, first
      logical :: ok(4), found

      ! sets of elements are read after all elements, those that are wanted here before
      call try_pending_sets(i_card, context)
      associate (card => context%deck%cards(i_card))
         call read_number(context%deck, card, 'ELEMENT SHIFT', shift, ok(1))
         call read_number(context%deck, card, 'SHIFT NODES', node_shift, ok(2))
         call find_old_set(card, 'element set', context, members, ok(3))
         call option_text(context%deck, card, 'NEW SET', name, found)
         if (.not. found) name = ''
         if (.not. all(ok(:3))) then
            call invalidate_block(context, name)
            return
         end if
         call find_place(context%deck, card, 'SHIFT NODES', token)
         ok(4) = fits_memory(token, context, 0_lp, size(members, kind=lp), 'ELCOPY')
         first = context%model%mesh%n_elements + 1
         do i = 1, size(members, kind=ip)
            if (ok(4)) call copy_element_once(token, -i_card, 'ELCOPY', context, members(i), [int(node_shift, lp), &
                                                                                              int(shift, lp)], ok(4))
         end do
         if (.not. ok(4)) call invalidate_block(context, name)
         if (found) call grow_set(context%model%element_sets, name, [(i, i=first, context%model%mesh%n_elements)])
      end associate
   end subroutine read_elcopy_card

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

end module atrito_build_copies
