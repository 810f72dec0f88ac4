!> *ELEMENT and *ELGEN: the elements of the mesh, in the order of the deck, after all nodes.
module atrito_build_elements
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t, line_item
   use atrito_diagnostics, only: report_error, report_note
   use atrito_build_context, only: build_context_t, spoil_number, note_number, has_errors, is_undetermined
   use atrito_element_table, only: KINDS, kind_named, is_membrane
   use atrito_id_map, only: find_id
   use atrito_items, only: get_integer, option_text, option_word
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: add_element, find_element, find_node
   use atrito_model_memory, only: fits_memory
   use atrito_growth, only: number_list_t, add_number, add_numbers, numbers_of
   use atrito_build_nodes, only: read_plain_elements, SLICE
   use atrito_references, only: get_id, find_one_node, find_one_element
   use atrito_sets, only: grow_set
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_element_card, read_elgen_card, read_element_type, place_element, copy_element_once

   !> One direction of *ELGEN.
   type :: repeat_t
      integer(ip) :: n = 1                             !< elements, the first one included
      integer(ip) :: node_step = 1, element_step = 1   !< of the numbers
   end type repeat_t

contains

   !> Shape and state of the elements that TYPE= of a card makes.
   subroutine read_element_type(deck, card, n_nodes, state, ok)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(card_t), intent(in) :: card                 !< whose TYPE= is read
      integer(ip), intent(out) :: n_nodes              !< place in SHAPES
      integer(ip), intent(out) :: state                !< place in STATES
      logical, intent(out) :: ok                       !< .false.: a type that is not built or unknown, reported by the reader
      integer(ip) :: kind

      kind = kind_named(option_word(deck, card, 'TYPE'))
      ok = kind > 0
      n_nodes = KINDS(max(kind, 1_ip))%shape
      state = KINDS(max(kind, 1_ip))%state
   end subroutine read_element_type

   !> *ELEMENT: number, nodes. Membranes are taken as plane stress, which is noted once.
   subroutine read_element_card(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      type(build_context_t), intent(inout) :: context  !< its mesh gets elements, and ELSET= the set
      character(len=:), allocatable :: name
      integer(ip), allocatable :: id(:), nodes(:, :)
      logical, allocatable :: is_plain(:)
      integer(ip) :: begin, last, i, k, first, n_nodes, state
      logical :: ok, fits

      first = context%model%mesh%n_elements + 1
      associate (card => context%deck%cards(i_card), lines => context%deck%lines)
         call read_element_type(context%deck, card, n_nodes, state, fits)
         if (fits) fits = fits_memory(card%place, context, 0_lp, int(card%n_lines, lp), n_nodes)
         name = option_word(context%deck, card, 'TYPE')
         if (fits .and. is_membrane(name) .and. .not. context%membranes_told) then
            context%membranes_told = .true.
            call report_note(context%deck, card%place, 'N-MEMBRANE', 'membranes are taken as plane stress: '//name//' as CPS'// &
                             name(4:))
         end if
         k = min(SLICE, card%n_lines)
         allocate (id(k), nodes(n_nodes, k), is_plain(k))
         do begin = card%first_line, card%first_line + card%n_lines - 1, SLICE
            last = min(card%first_line + card%n_lines, begin + SLICE) - 1
            if (fits) call read_plain_elements(context%deck, context%model%mesh, lines(begin:last), id, nodes, is_plain)
            do i = begin, last
               k = i - begin + 1
               ok = fits
               if (ok) ok = is_plain(k)
               if (ok) then
                  call place_element(context, id(k), state, nodes(:, k), lines(i)%first_token, ok)
               else if (fits .and. lines(i)%ok) then
                  call read_element_line(lines(i), n_nodes, state, context, ok)
               end if
               if (.not. ok) call spoil_number(context%deck, lines(i), context%elements)
            end do
         end do
      end associate
      call put_named_set(i_card, context, [(i, i=first, context%model%mesh%n_elements)])
   end subroutine read_element_card

   !> A line of *ELEMENT that is not just plain numbers: number, nodes.
   subroutine read_element_line(line, n_nodes, state, context, good)
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: n_nodes, state
      type(build_context_t), intent(inout) :: context
      logical, intent(out) :: good                     !< .false. when reported
      integer(ip) :: id, nodes(n_nodes), i
      logical :: ok

      call get_id(context%deck, context%deck%tokens(line%first_token), 'element number', id, good)
      do i = 1, n_nodes
         call find_one_node(context, line_item(context%deck, line, i + 1), nodes(i), ok)
         if (ok .and. any(nodes(:i - 1) == nodes(i))) then
            ok = .false.
            call report_error(context%deck, line_item(context%deck, line, i + 1), 'E-SHAPE', 'the element has this node twice', &
                              expected='different nodes, corners counter-clockwise')
         end if
         good = good .and. ok
      end do
      if (good) call place_element(context, id, state, nodes, line%first_token, good)
   end subroutine read_element_line

   !> Adds an element and keeps where it comes from; a number given twice is an error.
   subroutine place_element(context, id, state, nodes, place, ok)
      type(build_context_t), intent(inout) :: context  !< its mesh gets the element
      integer(ip), intent(in) :: id                    !< > 0
      integer(ip), intent(in) :: state                 !< place in STATES
      integer(ip), intent(in) :: nodes(:)              !< places
      integer(ip), intent(in) :: place                 !< token (> 0) or card (< 0) of the deck
      logical, intent(out) :: ok                       !< the number was free; else that is reported
      integer(ip) :: i
      logical :: known

      call add_element(context%model%mesh, id, state, nodes, known)
      ok = .not. known
      i = context%model%mesh%n_elements
      if (known) i = find_element(context%model%mesh, id)
      call note_number(context%deck, context%elements, 'element', id, i, place, known)
   end subroutine place_element

   !> The set that ELSET= of a card names.
   subroutine put_named_set(i_card, context, members)
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: members(:)
      character(len=:), allocatable :: name
      logical :: found

      call option_text(context%deck, context%deck%cards(i_card), 'ELSET', name, found)
      if (found .and. len(name) > 0) call grow_set(context%model%element_sets, name, members)
   end subroutine put_named_set

   !> *ELGEN: rows, and rows of rows, of copies of an element. The first copy that cannot be made ends a line: the others would fail
   !> for the same reason.
   subroutine read_elgen_card(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      type(build_context_t), intent(inout) :: context  !< its mesh gets elements, and ELSET= the set
      type(number_list_t) :: members
      character(len=*), parameter :: WHAT = 'number of elements, the first included'
      type(repeat_t) :: repeats(3)
      type(token_t) :: token, items(3)
      integer(lp) :: n, shift(3)
      integer(ip) :: line, i, j, k, master, first_new
      logical :: ok, good(3)

      associate (deck => context%deck, card => context%deck%cards(i_card))
         do line = card%first_line, card%first_line + card%n_lines - 1
            if (.not. deck%lines(line)%ok) cycle
            token = line_item(deck, deck%lines(line), 1_ip)
            call find_one_element(context, token, master, ok)
            if (.not. ok) cycle
            repeats = repeat_t()
            do k = 1, 3                                ! of each direction, where it is given
               i = 3*k - 1
               if (i > deck%lines(line)%n_tokens) exit
               items = [(line_item(deck, deck%lines(line), j), j=i, i + 2)]
               call get_integer(deck, items(1), WHAT, repeats(k)%n, good(1), 1_ip)
               call get_integer(deck, items(2), 'increment of the node numbers', repeats(k)%node_step, good(2), 1_ip)
               call get_integer(deck, items(3), 'increment of the element numbers', repeats(k)%element_step, good(3), 1_ip)
               if (good(1) .and. repeats(k)%n <= 0) call report_error(deck, items(1), 'E-VALUE', to_text(repeats(k)%n)// &
                                                                      ' elements', expected=WHAT//': 1 or more')
               ok = ok .and. all(good) .and. repeats(k)%n > 0
            end do
            if (.not. ok) cycle
            ! the product of three integers may be larger than any of them can be
            n = int(min(product(real(repeats%n, wp)), real(huge(1_ip), wp)), lp)
            if (.not. fits_memory(token, context, 0_lp, n)) cycle
            first_new = context%model%mesh%n_elements + 1
            copies: do k = 0, repeats(3)%n - 1
               do j = 0, repeats(2)%n - 1
                  do i = 0, repeats(1)%n - 1
                     shift = [i, j, k]
                     if (all(shift == 0_lp)) cycle
                     call copy_element_once(token, deck%lines(line)%first_token, context, master, [sum(shift*repeats%node_step), &
                                                                                               sum(shift*repeats%element_step)], ok)
                     if (.not. ok) exit copies
                  end do
               end do
            end do copies
            call add_number(members, master)
            call add_numbers(members, [(i, i=first_new, context%model%mesh%n_elements)])
         end do
      end associate
      call put_named_set(i_card, context, numbers_of(members))
   end subroutine read_elgen_card

   !> An element once more on other nodes.
   subroutine copy_element_once(token, place, context, master, shift, ok)
      type(token_t), intent(in) :: token               !< at which errors are reported
      integer(ip), intent(in) :: place                 !< token (> 0) or card (< 0) of the deck
      type(build_context_t), intent(inout) :: context  !< its mesh gets the element
      integer(ip), intent(in) :: master                !< place
      integer(lp), intent(in) :: shift(2)              !< of the numbers of nodes and of elements, which may become too large
      logical, intent(out) :: ok                       !< it was made; else that is reported
      integer(lp) :: ids(context%model%mesh%shape(master)), id
      integer(ip) :: nodes(size(ids)), i

      id = context%model%mesh%element_id(master) + shift(2)
      ids = context%model%mesh%node_id(context%model%mesh%nodes(:size(nodes), master)) + shift(1)
      do i = 1, size(nodes, kind=ip)
         nodes(i) = 0
         if (ids(i) <= int(huge(1_ip), lp)) nodes(i) = find_node(context%model%mesh, int(max(ids(i), 0_lp), ip))
         ok = nodes(i) > 0
         if (.not. ok) exit
      end do
      if (.not. ok) then
         if (ids(i) > 0_lp .and. ids(i) <= int(huge(1_ip), lp) .and. has_errors()) then
            if (find_id(context%nodes%invalid, int(ids(i), ip)) > 0) return
         end if
         if (is_undetermined(context, 'node')) return
         call report_error(context%deck, token, 'E-NODE', 'node '//to_text(ids(i))//' of the generated element '//to_text(id)// &
                           ' does not exist', expected='copies whose nodes all exist')
      else if (id < 1_lp .or. id > int(huge(1_ip), lp)) then
         ok = .false.
         call report_error(context%deck, token, 'E-ID', 'the generated element number '//to_text(id)// &
                           trim(merge(' is too large   ', ' is not positive', id > 0_lp)), expected='positive element numbers')
      else
         call place_element(context, int(id, ip), context%model%mesh%state(master), nodes, place, ok)
      end if
   end subroutine copy_element_once

end module atrito_build_elements
