!> *ELEMENT, TYPE=SPRING1 and SPRING2, and *SPRING: bilateral rows with a compliance.
module atrito_build_springs
   use atrito_bilateral_rows, only: add_row, ROW_SPRING
   use atrito_build_context, only: build_context_t
   use atrito_turn_supports, only: row_weight
   use atrito_build_loads, only: in_no_element
   use atrito_deck, only: card_t, data_line_t, token_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_items, only: get_integer, get_real, option_text, option_word
   use atrito_kinds, only: ip, wp
   use atrito_local_axes, only: dof_direction
   use atrito_mesh, only: find_element
   use atrito_model, only: spring_t
   use atrito_name_list, only: name_list_t, add_name, find_name, names_of
   use atrito_references, only: get_id, find_one_node, report_unknown
   use atrito_refinement, only: is_refined
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: build_springs, is_spring_card

   !> Springs while they are read: which set each belongs to, and where it stands.
   type :: reading_t
      type(name_list_t) :: sets
      type(id_map_t) :: ids
      integer(ip) :: n = 0                             !< springs so far
      integer(ip), allocatable :: set(:)               !< of each spring
      logical, allocatable :: given(:)                 !< (sets) *SPRING has come
      type(token_t), allocatable :: place(:)           !< of each spring
   end type reading_t

contains

   !> Whether an *ELEMENT card makes springs.
   logical function is_spring_card(context, card)
      type(build_context_t), intent(in) :: context
      type(card_t), intent(in) :: card

      is_spring_card = keyword_name(card) == 'ELEMENT'
      if (is_spring_card) is_spring_card = index(option_word(context%deck, card, 'TYPE'), 'SPRING') == 1
   end function is_spring_card

   subroutine build_springs(context)
      type(build_context_t), intent(inout) :: context
      type(reading_t) :: reading
      type(string_t), allocatable :: names(:)
      integer(ip) :: i, k, n

      n = 0
      do i = 1, context%deck%n_cards
         if (is_spring_card(context, context%deck%cards(i))) n = n + context%deck%cards(i)%n_lines
      end do
      allocate (context%model%springs(n), reading%place(n))
      allocate (reading%set(n), source=0_ip)
      do i = 1, context%deck%n_cards
         if (.not. is_spring_card(context, context%deck%cards(i))) cycle
         call read_elements(context%deck%cards(i), context, reading)
      end do
      context%model%springs = context%model%springs(:reading%n)
      names = names_of(reading%sets)
      allocate (reading%given(reading%sets%n), source=.false.)
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == 'SPRING') call read_spring_card(context%deck%cards(i), context, reading)
      end do
      do k = 1, reading%sets%n
         if (reading%given(k)) cycle
         i = findloc(reading%set, k, dim=1, kind=ip)
         if (i > 0) call report_error(context%deck, reading%place(i), 'E-SPRING', 'the springs of '//names(k)%s// &
                                      ' have no *SPRING', expected='*SPRING, ELSET='//names(k)%s, keyword='SPRING')
      end do
   end subroutine build_springs

   !> *ELEMENT, TYPE=SPRING1 or SPRING2: number, one node or two.
   subroutine read_elements(card, context, reading)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      type(reading_t), intent(inout) :: reading
      character(len=:), allocatable :: name
      integer(ip) :: i, set, n_ends
      logical :: found

      call option_text(context%deck, card, 'ELSET', name, found)
      if (.not. found) then
         if (card%ok) call report_error(context%deck, card%place, 'E-OPTION-MISSING', 'springs need ELSET=, which *SPRING names', &
                                        expected='*ELEMENT, TYPE=SPRING1, ELSET=name', keyword='SPRING')
         return
      end if
      set = find_name(reading%sets, name)
      if (set == 0) then
         call add_name(reading%sets, name)
         set = reading%sets%n
      end if
      n_ends = merge(1_ip, 2_ip, option_word(context%deck, card, 'TYPE') == 'SPRING1')
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (context%deck%lines(i)%ok) call read_element_line(context%deck%lines(i), n_ends, set, context, reading)
      end do
   end subroutine read_elements

   subroutine read_element_line(line, n_ends, set, context, reading)
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: n_ends, set
      type(build_context_t), intent(inout) :: context
      type(reading_t), intent(inout) :: reading
      type(spring_t) :: spring
      type(token_t) :: place
      integer(ip) :: i
      logical :: ok, good, known

      place = line_item(context%deck, line, 1_ip)
      call get_id(context%deck, place, 'element number', spring%id, ok, 'SPRING')
      do i = 1, n_ends
         call find_one_node(context, line_item(context%deck, line, i + 1), spring%node(i), good, 'SPRING')
         if (good) call check_node(context, line_item(context%deck, line, i + 1), spring%node(i), good)
         ok = ok .and. good
      end do
      if (.not. ok) return
      known = is_element(context, spring%id)
      if (.not. known) call add_id(reading%ids, spring%id, reading%n + 1, known)
      if (known) then
         call report_error(context%deck, place, 'E-TWICE', 'element '//to_text(spring%id)//' is defined twice', &
                           expected='a number of its own for each element and spring', keyword='SPRING')
         return
      end if
      if (n_ends == 2 .and. spring%node(1) == spring%node(2)) then
         call report_error(context%deck, place, 'E-SHAPE', 'both ends of spring '//to_text(spring%id)//' are one node', &
                           expected='two nodes', keyword='SPRING')
         return
      end if
      reading%n = reading%n + 1
      context%model%springs(reading%n) = spring
      reading%set(reading%n) = set
      reading%place(reading%n) = place
   end subroutine read_element_line

   !> A number that an element of the deck has.
   pure logical function is_element(context, id)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: id

      if (is_refined(context%refinement)) then
         is_element = find_id(context%deck_elements, id) > 0
      else
         is_element = find_element(context%model%mesh, id) > 0
      end if
   end function is_element

   subroutine check_node(context, place, node, ok)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: place
      integer(ip), intent(in) :: node
      logical, intent(out) :: ok

      ok = .not. any(in_no_element(context, [node]))
      if (.not. ok) call report_error(context%deck, place, 'E-NODE', 'node '//to_text(context%model%mesh%node_id(node))// &
                                      ' belongs to no element', expected='nodes of elements that are not springs', &
                                      keyword='SPRING')
   end subroutine check_node

   !> *SPRING: dofs, stiffness.
   subroutine read_spring_card(card, context, reading)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      type(reading_t), intent(inout) :: reading
      character(len=:), allocatable :: name
      type(token_t) :: place
      integer(ip) :: set, dof(2)
      real(wp) :: stiffness
      logical :: found, ok

      call option_text(context%deck, card, 'ELSET', name, found, place)
      if (.not. found) return
      set = find_name(reading%sets, name)
      if (set == 0) then
         call report_unknown(context, place, 'element set of springs', 'E-SET', reading%sets, 'SPRING')
         return
      end if
      if (reading%given(set)) then
         call report_error(context%deck, place, 'E-TWICE', 'the springs of '//name//' have a *SPRING already', &
                           expected='one *SPRING for each set', keyword='SPRING')
      end if
      ok = .not. reading%given(set)
      reading%given(set) = .true.
      if (ok) call read_constants(card, context, dof, stiffness, ok)
      if (ok) call add_springs(context, pack_places(reading%set == set), dof, stiffness)
   end subroutine read_spring_card

   subroutine read_constants(card, context, dof, stiffness, ok)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(in) :: context
      integer(ip), intent(out) :: dof(2)
      real(wp), intent(out) :: stiffness               !< [F/L]
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT_DOF = 'degree of freedom: 1 (x) or 2 (y)', WHAT = 'stiffness, a real > 0 [F/L]'
      type(token_t) :: place
      logical :: good(3)
      integer(ip) :: i

      ok = .false.
      if (card%n_lines < 2 .or. .not. card%ok) return
      associate (deck => context%deck, line => context%deck%lines(card%first_line))
         if (.not. (line%ok .and. deck%lines(card%first_line + 1)%ok)) return
         call get_integer(deck, line_item(deck, line, 1_ip), WHAT_DOF, dof(1), good(1), keyword='SPRING')
         call get_integer(deck, line_item(deck, line, 2_ip), WHAT_DOF, dof(2), good(2), dof(1), 'SPRING')
         do i = 1, 2
            if (.not. good(i) .or. (dof(i) >= 1 .and. dof(i) <= 2)) cycle
            good(i) = .false.
            call report_error(deck, line_item(deck, line, i), 'E-DOF', 'dof '//to_text(dof(i))//' does not exist in the plane', &
                              expected=WHAT_DOF, keyword='SPRING')
            if (i == 1 .and. dof(2) == dof(1)) exit
         end do
         place = line_item(deck, deck%lines(card%first_line + 1), 1_ip)
         call get_real(deck, place, WHAT, stiffness, good(3), keyword='SPRING')
         if (good(3) .and. .not. (stiffness > 1.0_wp/huge(1.0_wp) .and. 1.0_wp/stiffness > 0.0_wp)) then
            good(3) = .false.
            call report_error(deck, place, 'E-VALUE', to_text(stiffness)//' is out of range', expected=WHAT, keyword='SPRING')
         end if
      end associate
      ok = all(good)
   end subroutine read_constants

   !> Rows of the springs at some places.
   subroutine add_springs(context, places, dof, stiffness)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: places(:), dof(2)
      real(wp), intent(in) :: stiffness
      integer(ip) :: i, group, n
      real(wp) :: vectors(2, 2)

      group = context%model%bilateral%n_groups + 1
      do i = 1, size(places, kind=ip)
         associate (spring => context%model%springs(places(i)))
            spring%dof = dof
            spring%stiffness = stiffness
            n = count(spring%node > 0, kind=ip)
            vectors(:, 1) = dof_direction(context, spring%node(1), dof(1))
            if (n == 2) vectors(:, 2) = -dof_direction(context, spring%node(2), dof(2))
            call add_row(spring%node(:n), vectors(:, :n), 0.0_wp, 1/stiffness, row_weight(context%model), &
                         [ROW_SPRING, group, places(i)], context%model%bilateral)
         end associate
      end do
   end subroutine add_springs

   pure function pack_places(mask) result(places)
      logical, intent(in) :: mask(:)
      integer(ip), allocatable :: places(:)
      integer(ip) :: i

      places = pack([(i, i=1, size(mask, kind=ip))], mask)
   end function pack_places

end module atrito_build_springs
