!> *ELEMENT, TYPE=SPRING1, SPRING2 and SPRINGA, and *SPRING: bilateral rows with a compliance.
module atrito_build_springs
   use atrito_bilateral_rows, only: add_row, ROW_SPRING
   use atrito_build_context, only: build_context_t, has_errors, LOOSE_HELD
   use atrito_build_rigid_bodies, only: ROTATION_DOF
   use atrito_deck, only: card_t, data_line_t, token_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_id_map, only: id_map_t, add_id
   use atrito_incidence, only: list_holders
   use atrito_items, only: get_integer, get_real, option_text, option_word, makes_elements
   use atrito_kinds, only: ip, wp
   use atrito_local_axes, only: dof_direction, has_local_axes
   use atrito_model, only: spring_t
   use atrito_name_list, only: name_list_t, add_name, find_name, names_of
   use atrito_references, only: element_of_deck, find_one_node, get_id, report_unknown
   use atrito_row_dofs, only: arm_of, check_row_dof, check_row_nodes, has_no_unknowns, row_node, row_terms, row_weight, &
                              TERMS_A_DOF, WHAT_DOF
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: build_springs

   !> Springs while they are read: which set each belongs to, and where it stands.
   type :: reading_t
      type(name_list_t) :: sets                        !< names of the element sets, in the order of first use
      type(id_map_t) :: ids                            !< the user's numbers
      integer(ip) :: n = 0                             !< springs so far
      integer(ip), allocatable :: set(:)               !< of each spring
      logical, allocatable :: given(:)                 !< (sets) *SPRING has come
      logical, allocatable :: is_axial(:)              !< of each spring: SPRINGA
      type(token_t), allocatable :: place(:)           !< of each spring
      integer(ip), allocatable :: sorted(:), first(:)  !< springs of set k: sorted(first(k):first(k + 1) - 1)
      real(wp) :: weight = 1.0_wp                      !< of their rows [L^2]
   end type reading_t

contains

   !> Makes the springs of all *ELEMENT cards of type SPRING1, SPRING2 and SPRINGA, with directions and stiffnesses of *SPRING, and
   !> their rows among the bilateral ones.
   subroutine build_springs(context)
      type(build_context_t), intent(inout) :: context  !< its model gets springs and their bilateral rows
      type(reading_t) :: reading
      type(string_t), allocatable :: names(:)
      integer(ip) :: i, k, n

      n = 0
      do i = 1, context%deck%n_cards
         if (makes_elements(context%deck, context%deck%cards(i), 'SPRING')) n = n + context%deck%cards(i)%n_lines
      end do
      allocate (context%model%springs(n), reading%place(n), reading%set(n), reading%is_axial(n))
      do i = 1, context%deck%n_cards
         if (.not. makes_elements(context%deck, context%deck%cards(i), 'SPRING')) cycle
         call read_elements(context%deck%cards(i), context, reading)
      end do
      context%model%springs = context%model%springs(:reading%n)
      call list_holders(reading%sets%n, reshape(reading%set(:reading%n), [1_ip, reading%n]), reading%first, reading%sorted)
      reading%weight = row_weight(context%model)
      names = names_of(reading%sets)
      allocate (reading%given(reading%sets%n), source=.false.)
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == 'SPRING') call read_spring_card(context%deck%cards(i), context, reading)
      end do
      ! a misspelt *SPRING: its springs are not blamed for missing it
      if (any(context%deck%cards%name == '' .and. .not. context%deck%cards%is_ignored) .and. has_errors()) return
      do k = 1, reading%sets%n
         i = reading%first(k)
         if (reading%given(k) .or. reading%first(k + 1) == i) cycle
         call report_error(context%deck, reading%place(reading%sorted(i)), 'E-SPRING', 'the springs of '//names(k)%s// &
                           ' have no *SPRING', expected='*SPRING, ELSET='//names(k)%s)
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
                                        expected='*ELEMENT, TYPE=SPRING1, ELSET=name')
         return
      end if
      set = find_name(reading%sets, name)
      if (set == 0) then
         call add_name(reading%sets, name)
         set = reading%sets%n
      end if
      n_ends = merge(1_ip, 2_ip, option_word(context%deck, card, 'TYPE') == 'SPRING1')
      reading%is_axial(reading%n + 1:) = option_word(context%deck, card, 'TYPE') == 'SPRINGA'
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
      call get_id(context%deck, place, 'element number', spring%id, ok)
      do i = 1, n_ends
         call find_one_node(context, line_item(context%deck, line, i + 1), spring%node(i), good)
         if (good .and. n_ends == 1) call check_row_nodes(context, line_item(context%deck, line, i + 1), spring%node(i:i), &
                                                          'nodes of elements that are not springs', good)
         ok = ok .and. good
      end do
      if (.not. ok) return
      known = element_of_deck(context, spring%id) > 0
      if (.not. known) call add_id(reading%ids, spring%id, reading%n + 1, known)
      if (known) then
         call report_error(context%deck, place, 'E-TWICE', 'element '//to_text(spring%id)//' is defined twice', &
                           expected='a number of its own for each element and spring')
         return
      end if
      if (n_ends == 2 .and. spring%node(1) == spring%node(2)) then
         call report_error(context%deck, place, 'E-SHAPE', 'both ends of spring '//to_text(spring%id)//' are one node', &
                           expected='two nodes')
         return
      end if
      reading%n = reading%n + 1
      context%model%springs(reading%n) = spring
      reading%set(reading%n) = set
      reading%place(reading%n) = place
   end subroutine read_element_line

   !> *SPRING: dofs, stiffness.
   subroutine read_spring_card(card, context, reading)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      type(reading_t), intent(inout) :: reading
      character(len=:), allocatable :: name
      type(token_t) :: place
      integer(ip), allocatable :: places(:)            ! of the springs of the set
      integer(ip) :: set, dof(2)
      real(wp) :: stiffness
      logical :: found, ok

      call option_text(context%deck, card, 'ELSET', name, found, place)
      if (.not. found) return
      set = find_name(reading%sets, name)
      if (set == 0) then
         call report_unknown(context, place, 'element set of springs', 'E-SET', reading%sets)
         return
      end if
      if (reading%given(set)) then
         call report_error(context%deck, place, 'E-TWICE', 'the springs of '//name//' have a *SPRING already', &
                           expected='one *SPRING for each set')
         return
      end if
      reading%given(set) = .true.
      places = reading%sorted(reading%first(set):reading%first(set + 1) - 1)
      call read_constants(any(reading%is_axial(places)))
      if (any(reading%is_axial(places)) .and. .not. all(reading%is_axial(places))) then
         ok = .false.
         call report_error(context%deck, place, 'E-SPRING', 'the springs of '//name//' are SPRINGA and others', &
                           expected='a set for each type')
      end if
      if (ok) call add_springs(context, places, reading, dof, stiffness)

   contains

      !> Dofs, and below them the stiffness. Of SPRINGA the last line has the stiffness; one before it says nothing.
      subroutine read_constants(is_axial)
         logical, intent(in) :: is_axial                  !< SPRINGA
         character(len=*), parameter :: WHAT = 'stiffness, a real > 0 [F/L]'
         type(token_t) :: place
         logical :: good

         dof = 0
         ok = card%ok .and. card%n_lines > merge(0, 1, is_axial)
         if (card%ok .and. .not. (ok .or. is_axial)) call report_error(context%deck, card%place, 'E-LINES', &
                                                                       '*SPRING needs 2 data lines', &
                                                                       expected='dofs, and below them the stiffness')
         if (.not. ok) return
         associate (deck => context%deck, first => context%deck%lines(card%first_line), &
                    last => context%deck%lines(card%first_line + merge(card%n_lines - 1_ip, 1_ip, is_axial)))
            ok = last%ok .and. (first%ok .or. is_axial)
            if (.not. ok) return
            if (.not. is_axial) call read_dofs(first, context, places, dof, ok)
            place = line_item(deck, last, 1_ip)
            call get_real(deck, place, WHAT, stiffness, good)
            ok = ok .and. good
            if (.not. good .or. (stiffness > 1.0_wp/huge(1.0_wp) .and. 1.0_wp/stiffness > 0.0_wp)) return
            ok = .false.
            call report_error(deck, place, 'E-VALUE', to_text(stiffness)//' is out of range', expected=WHAT)
         end associate
      end subroutine read_constants
   end subroutine read_spring_card

   !> The dofs of both ends: two displacements, or two rotations. The second is the first where it is left out.
   subroutine read_dofs(line, context, places, dof, ok)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: places(:)             !< of the springs
      integer(ip), intent(out) :: dof(2)
      logical, intent(out) :: ok
      integer(ip), allocatable :: nodes(:)
      type(token_t) :: item(2)
      logical :: good(2)
      integer(ip) :: i

      item = [line_item(context%deck, line, 1_ip), line_item(context%deck, line, 2_ip)]
      call get_integer(context%deck, item(1), WHAT_DOF, dof(1), good(1))
      call get_integer(context%deck, item(2), WHAT_DOF, dof(2), good(2), dof(1))
      do i = 1, 2
         nodes = context%model%springs(places)%node(i)
         nodes = pack(nodes, nodes > 0)
         nodes = pack(nodes,.not. has_no_unknowns(context, nodes)) ! the ground has any dof
         if (good(i)) call check_row_dof(context, item(i), nodes, dof(i), good(i))
         if (.not. good(i) .and. dof(2) == dof(1)) exit
      end do
      ok = all(good)
      if (.not. ok .or. ((dof(1) == ROTATION_DOF) .eqv. (dof(2) == ROTATION_DOF))) return
      ok = all(context%model%springs(places)%node(2) == 0)
      if (.not. ok) call report_error(context%deck, item(2), 'E-DOF', 'one end moves, the other one turns', &
                                      expected='two dofs of one kind')
   end subroutine read_dofs

   !> Rows of the springs at some places. The first end gets the direction, the second one the opposite; along SPRINGA both point
   !> outwards, so that the force is a tension. An end that is the ground has no part in the row.
   subroutine add_springs(context, places, reading, dof, stiffness)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: places(:), dof(2)
      type(reading_t), intent(in) :: reading
      real(wp), intent(in) :: stiffness
      integer(ip) :: i, group
      real(wp) :: vectors(2, 2)
      logical :: ok

      group = context%model%bilateral%n_groups + 1
      do i = 1, size(places, kind=ip)
         associate (spring => context%model%springs(places(i)))
            spring%dof = dof
            spring%stiffness = stiffness
            call find_directions(spring, reading%place(places(i)))
            if (ok) call ground_ends(reading%place(places(i)), spring)
            if (ok) call add_spring(context, spring, vectors, [ROW_SPRING, group, places(i)], reading%weight)
         end associate
      end do

   contains

      subroutine find_directions(spring, place)
         type(spring_t), intent(in) :: spring
         type(token_t), intent(in) :: place
         real(wp) :: way(2)

         ok = .true.
         vectors = 0.0_wp
         if (spring%dof(1) == ROTATION_DOF) return
         if (spring%dof(1) > 0) then
            vectors(:, 1) = dof_direction(context, spring%node(1), spring%dof(1))
            if (spring%node(2) > 0) vectors(:, 2) = -dof_direction(context, spring%node(2), spring%dof(2))
            return
         end if
         way = context%model%mesh%x(:, spring%node(2)) - context%model%mesh%x(:, spring%node(1))
         ok = norm2(way) > 0.0_wp
         if (ok) vectors = reshape([-way, way], [2, 2])/norm2(way)
         if (.not. ok) call report_error(context%deck, place, 'E-SHAPE', 'both ends of spring '//to_text(spring%id)// &
                                         ' lie at one place', expected='two places: the force is along the line between them')
      end subroutine find_directions

      !> Ends that belong to no element: held at 0 in all steps they are the ground.
      subroutine ground_ends(place, spring)
         type(token_t), intent(in) :: place
         type(spring_t), intent(inout) :: spring
         logical :: is_ground(2), is_held(3)
         integer(ip) :: i

         ok = .true.
         if (spring%node(2) == 0) return                  ! SPRING1: its node has been looked at
         is_ground = has_no_unknowns(context, spring%node)
         do i = 1, 2
            if (.not. is_ground(i)) cycle
            is_held = context%loose_held(:, spring%node(i)) == LOOSE_HELD
            if (spring%dof(i) == ROTATION_DOF) then
               if (is_held(3)) cycle
            else if (all(is_held(:2) .or. (abs(vectors(:, i)) <= 0.0_wp .and. .not. has_local_axes(context, spring%node(i))))) then
               cycle
            end if
            call report_error(context%deck, place, 'E-NODE', 'node '//to_text(context%model%mesh%node_id(spring%node(i)))// &
                              ' belongs to no element and is not held', expected='nodes of elements that are not springs, or '// &
                              'the ground: a node that *BOUNDARY holds at 0 in all steps')
            ok = .false.
            return
         end do
         ok = .not. all(is_ground)
         if (.not. ok) call report_error(context%deck, place, 'E-NODE', 'no end of spring '//to_text(spring%id)// &
                                         ' belongs to an element', expected='a node of an element')
         if (.not. ok .or. .not. any(is_ground)) return
         i = merge(2_ip, 1_ip, is_ground(1))
         vectors(:, 1) = vectors(:, i)
         if (i == 2 .and. spring%dof(1) > 0) vectors(:, 1) = -vectors(:, 1)
         spring%node = [spring%node(i), 0_ip]
         spring%dof = [spring%dof(i), 0_ip]
      end subroutine ground_ends
   end subroutine add_springs

   !> The row of a spring between two ends, v1 . u1 + v2 . u2 = q/k: the force q pulls the ends along -v1 and -v2, k is the
   !> stiffness. A spring of rotations takes them times an arm, the larger of the sizes of its rigid bodies, so that its row has the
   !> unit of the others: q is its moment over the arm, and the compliance is arm**2/k.
   subroutine add_spring(context, spring, vectors, identity, weight)
      type(build_context_t), intent(inout) :: context
      type(spring_t), intent(inout) :: spring
      real(wp), intent(in) :: vectors(2, 2)            !< of its ends, where they move along them
      integer(ip), intent(in) :: identity(3)
      real(wp), intent(in) :: weight                   !< of the row [L^2]
      integer(ip) :: i, n, nodes(TERMS_A_DOF, 2)
      real(wp) :: terms(2, TERMS_A_DOF, 2)

      n = count(spring%node > 0, kind=ip)
      if (any(spring%dof(:n) == ROTATION_DOF)) spring%arm = maxval([(arm_of(context, spring%node(i)), i=1, n)])
      terms = 0.0_wp
      do i = 1, n
         if (spring%dof(i) == ROTATION_DOF) then
            call row_terms(context, spring%node(i), ROTATION_DOF, spring%arm, nodes(:, i), terms(:, :, i))
            if (i == 2) terms(:, :, i) = -terms(:, :, i)
         else
            nodes(:, i) = row_node(context, spring%node(i))
            terms(:, 1, i) = vectors(:, i)
         end if
      end do
      call add_row([nodes(:, :n)], reshape(terms(:, :, :n), [2_ip, TERMS_A_DOF*n]), 0.0_wp, spring%arm**2/spring%stiffness, &
                   weight, identity, context%model%bilateral)
   end subroutine add_spring

end module atrito_build_springs
