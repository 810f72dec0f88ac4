!> *NCOPY and *ELCOPY: nodes and elements once more, elsewhere and with other numbers.
module atrito_build_copies
   use atrito_build_elements, only: copy_element_once
   use atrito_build_nodes, only: place_node, put_node_set
   use atrito_build_sets, only: try_set_card
   use atrito_deck, only: deck_t, card_t, token_t, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_build_context, only: build_context_t, invalidate_block
   use atrito_growth, only: make_room
   use atrito_items, only: option_integer, option_text
   use atrito_kinds, only: ip, lp, wp
   use atrito_model_memory, only: fits_memory
   use atrito_motion, only: motion_t, read_shift, read_rotation, moved
   use atrito_references, only: report_unknown
   use atrito_sets, only: set_list_t, find_set, grow_set, members_of
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_ncopy_card, read_elcopy_card

contains

   !> *NCOPY: the nodes of a set, moved. The first number that cannot be ends it: the others would fail for the same reason.
   subroutine read_ncopy_card(i_card, context)
      integer(ip), intent(in) :: i_card              !< place in deck%cards
      type(build_context_t), intent(inout) :: context
      type(motion_t) :: motion
      type(token_t) :: place
      integer(ip), allocatable :: members(:)
      character(len=:), allocatable :: name
      integer(lp) :: id
      integer(ip) :: change, i, first
      logical :: ok(3), found, fits

      associate (deck => context%deck, card => context%deck%cards(i_card), mesh => context%model%mesh)
         call read_shift_of_numbers(deck, card, 'CHANGE NUMBER', change, place, ok(1))
         call find_old_set(card, 'node set', context%model%node_sets, context, members, ok(2))
         call read_motion(deck, card, motion, ok(3))
         call option_text(deck, card, 'NEW SET', name, found)
         fits = all(ok)
         if (fits) fits = fits_memory(place, context, size(members, kind=lp), 0_lp, 'NCOPY')
         first = mesh%n_nodes + 1
         do i = 1, size(members, kind=ip)
            if (.not. fits) exit
            id = int(mesh%node_id(members(i)), lp) + int(change, lp)
            if (id > 0_lp .and. id <= int(huge(1_ip), lp)) then
               call place_node(context, int(id, ip), moved(motion, mesh%x(:, members(i))), -i_card, fits, 'NCOPY')
            else
               fits = .false.
               call report_error(deck, place, 'E-ID', 'node '//to_text(mesh%node_id(members(i)))//' would become '//to_text(id), &
                                 expected='positive node numbers that are not too large', keyword='NCOPY')
            end if
         end do
         if (.not. fits) call invalidate_block(context, name)
         if (found .and. all(ok)) call put_node_set(context, i_card, name, [(i, i=first, mesh%n_nodes)])
      end associate
   end subroutine read_ncopy_card

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
         call report_unknown(context, place, 'earlier '//noun, 'E-SET', sets%names, keyword_name(card))
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
         call report_error(deck, place, 'E-VALUE', 'MULTIPLE = '//to_text(times), expected=WHAT, keyword='NCOPY')
      end if
      ok = times >= 1 .and. card%n_lines > 0 .and. all(deck%lines(card%first_line:card%first_line + card%n_lines - 1)%ok)
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
      type(token_t) :: unused, place
      integer(ip), allocatable :: members(:)
      character(len=:), allocatable :: name
      integer(ip) :: shift, node_shift, i, first
      logical :: ok(3), found, fits

      ! sets of elements are read after all elements, those that are wanted here before
      call try_pending_sets(i_card, context)
      associate (deck => context%deck, card => context%deck%cards(i_card), mesh => context%model%mesh)
         call read_shift_of_numbers(deck, card, 'ELEMENT SHIFT', shift, unused, ok(1))
         call read_shift_of_numbers(deck, card, 'SHIFT NODES', node_shift, place, ok(2))
         call find_old_set(card, 'element set', context%model%element_sets, context, members, ok(3))
         call option_text(deck, card, 'NEW SET', name, found)
         fits = all(ok)
         if (fits) fits = fits_memory(place, context, 0_lp, size(members, kind=lp), 'ELCOPY')
         first = mesh%n_elements + 1
         do i = 1, size(members, kind=ip)
            if (fits) call copy_element_once(place, -i_card, 'ELCOPY', context, members(i), [int(node_shift, lp), &
                                                                                             int(shift, lp)], fits)
         end do
         if (.not. fits) call invalidate_block(context, name)
         if (found .and. all(ok)) call grow_set(context%model%element_sets, name, [(i, i=first, mesh%n_elements)])
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
