!> Initial gaps that the deck gives, whatever the coordinates say (*CLEARANCE; negative ones are a press fit), and initial overlaps
!> that are resolved over a step, not at once (*CONTACT INTERFERENCE, SHRINK): until the step the whole overlap is allowed, so that
!> contact does not feel it; over the step what is allowed goes to 0.
module atrito_clearance
   use atrito_build_context, only: build_context_t, count_cards, place_text
   use atrito_deck, only: card_t, data_line_t, token_t, last_item, line_item, keyword_name, option_t, count_lines
   use atrito_diagnostics, only: report_error, report_note
   use atrito_growth, only: make_room, number_list_t, add_numbers, numbers_of
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_items, only: get_real, has_option, option_real, option_text, find_option, get_name
   use atrito_kinds, only: ip, wp, lp
   use atrito_mesh, only: face_nodes
   use atrito_name_list, only: find_name
   use atrito_parameters, only: evaluate_function
   use atrito_points, only: contact_points_t
   use atrito_references, only: find_nodes, report_unknown
   use atrito_refined_members, only: edge_value
   use atrito_refinement, only: refinement_t, edge_place, is_refined
   use atrito_sorting, only: each_once, first_at_least, sorted_places
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: clearance_t, read_clearances, set_clearances, interference_t, read_interferences, set_interferences

   character(len=*), parameter :: WHAT = 'initial gap, a real, negative for an overlap [L]'

   !> The gaps of a pair: one for all its points, or some by the slave's nodes.
   type :: clearance_t
      integer(ip) :: pair = 0                          !< place in model%pairs
      type(token_t) :: place                           !< of the name of the slave
      logical :: is_uniform = .false.                  !< one gap for all points: value
      logical :: is_function = .false.                 !< the values are those of a function at all nodes of the slave
      real(wp) :: value = 0.0_wp                       !< [L]
      integer(ip), allocatable :: node(:)              !< places in the mesh
      real(wp), allocatable :: values(:)               !< of the nodes [L]
   end type clearance_t

   character(len=*), parameter :: SHRINK_KEYWORD = 'CONTACT INTERFERENCE'

   !> What a line says.
   type :: interference_t
      integer(ip) :: pair = 0                          !< place in model%pairs
      integer(ip) :: step = 0                          !< that resolves the overlap
      type(token_t) :: place                           !< of the name of the slave
   end type interference_t

   !> The pairs of the model, sorted by their surfaces: a deck may name each of thousands.
   type :: pair_index_t
      integer(lp), allocatable :: key(:)               !< rising
      integer(ip), allocatable :: pair(:)              !< in the order of their keys
      logical :: is_complete = .false.                 !< each line of *CONTACT PAIR has made one
   end type pair_index_t

contains

   !> All *CLEARANCE of a deck. The surfaces of its pairs are known.
   subroutine read_clearances(context, list)
      type(build_context_t), intent(inout) :: context        !< gap_is_given of its pairs
      type(clearance_t), allocatable, intent(out) :: list(:) !< each pair once
      type(clearance_t) :: one
      type(pair_index_t) :: pairs
      integer(ip), allocatable :: of_pair(:)           ! place in the list; 0: none so far
      integer(ip) :: i, k, n
      logical :: ok

      allocate (list(count_cards(context%deck, 'CLEARANCE')))
      if (size(list) == 0) return
      call index_pairs(context, pairs)
      allocate (of_pair(size(context%model%pairs)), source=0_ip)
      n = 0
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) /= 'CLEARANCE') cycle
         call read_card(context%deck%cards(i), context, pairs, one, ok)
         if (.not. ok) cycle
         k = of_pair(one%pair)
         if (k > 0) then
            call report_error(context%deck, one%place, 'E-TWICE', 'this pair has its clearance already, in '// &
                              place_text(context%deck, list(k)%place, one%place), expected='one *CLEARANCE a pair')
            cycle
         end if
         n = n + 1
         list(n) = one
         of_pair(one%pair) = n
         context%model%pairs(one%pair)%gap_is_given = .true.
      end do
      list = list(:n)
   end subroutine read_clearances

   !> The pair of the surfaces SLAVE and MASTER, and its gaps.
   subroutine read_card(card, context, pairs, one, ok)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(in) :: context
      type(pair_index_t), intent(in) :: pairs
      type(clearance_t), intent(out) :: one
      logical, intent(out) :: ok
      type(string_t) :: names(2)
      type(token_t) :: places(2)
      type(number_list_t) :: nodes
      type(id_map_t) :: of_slave
      real(wp), allocatable :: values(:)
      integer(ip), allocatable :: on_face(:)
      integer(ip) :: i, k
      logical :: has_table, found(2), known

      call option_text(context%deck, card, 'SLAVE', names(1)%s, found(1), places(1))
      call option_text(context%deck, card, 'MASTER', names(2)%s, found(2), places(2))
      one%place = places(1)
      if (all(found)) call find_pair(context, pairs, names, places, 'SLAVE='//names(2)%s//', MASTER='//names(1)%s, one%pair)
      has_table = has_option(context%deck, card, 'TABULAR')
      call option_real(context%deck, card, 'VALUE', WHAT, one%value, one%is_uniform)
      one%is_function = has_option(context%deck, card, 'FUNCTION')
      ok = card%ok
      if (ok .and. count([has_table, one%is_uniform, one%is_function]) /= 1) then
         ok = .false.
         call report_error(context%deck, card%place, 'E-CONFLICT', '*CLEARANCE without VALUE, TABULAR or FUNCTION, or with two '// &
                           'of them', expected='VALUE=; or TABULAR and data lines node, gap; or FUNCTION and an expression')
      end if
      ok = ok .and. one%pair > 0
      if (.not. ok) return
      allocate (one%node(0), one%values(0))
      if (one%is_uniform) return
      associate (faces => context%model%surfaces(context%model%pairs(one%pair)%slave)%faces)
         do i = 1, faces%n
            on_face = face_nodes(context%model%mesh, faces%element(i), faces%face(i))
            if (one%is_function) call add_numbers(nodes, on_face)
            do k = 1, merge(0_ip, size(on_face, kind=ip), one%is_function)
               call add_id(of_slave, on_face(k), 1_ip, known)
            end do
         end do
      end associate
      if (one%is_function) then
         call read_function(context%deck%lines(card%first_line), context, each_once(numbers_of(nodes)), one, ok)
         return
      end if
      do i = card%first_line, card%first_line + card%n_lines - 1
         call read_line(context%deck%lines(i), nodes)
      end do
      one%node = numbers_of(nodes)
      if (nodes%n > 0) one%values = values(:nodes%n)

   contains

      !> node or set, gap.
      subroutine read_line(line, all_nodes)
         type(data_line_t), intent(in) :: line
         type(number_list_t), intent(inout) :: all_nodes  !< of the lines so far
         integer(ip), allocatable :: nodes(:)
         real(wp) :: gap
         integer(ip) :: i
         logical :: good(2)

         ok = ok .and. line%ok
         if (.not. line%ok) return
         call find_nodes(context, line_item(context%deck, line, 1_ip), nodes, good(1))
         call get_real(context%deck, line_item(context%deck, line, 2_ip), WHAT, gap, good(2))
         ok = ok .and. all(good)
         if (.not. all(good)) return
         nodes = pack(nodes, [(find_id(of_slave, nodes(i)) > 0, i=1, size(nodes, kind=ip))])
         if (size(nodes) == 0) then
            ok = .false.
            call report_error(context%deck, line_item(context%deck, line, 1_ip), 'E-NODE', 'no node of the slave is meant', &
                              expected='a node of the slave, or a set with nodes of it')
         end if
         call make_room(values, all_nodes%n, all_nodes%n + size(nodes, kind=ip))
         values(all_nodes%n + 1:all_nodes%n + size(nodes)) = gap
         call add_numbers(all_nodes, nodes)
      end subroutine read_line
   end subroutine read_card

   !> An expression in x and y, evaluated at the nodes of the slave.
   subroutine read_function(line, context, nodes, one, ok)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:)
      type(clearance_t), intent(inout) :: one
      logical, intent(out) :: ok
      type(token_t) :: expression, last

      ok = line%ok
      if (.not. ok) return
      expression = line_item(context%deck, line, 1_ip)
      last = last_item(context%deck, line)
      expression%last = last%last                      ! commas belong to the expression: max(x, y)
      one%node = nodes
      deallocate (one%values)
      allocate (one%values(size(nodes)))
      call evaluate_function(context%deck, expression, context%model%mesh%x(:, nodes), one%values, ok, 'CLEARANCE')
   end subroutine read_function

   !> Gives the points of the pairs their gaps.
   subroutine set_clearances(list, n_nodes, refinement, points)
      type(clearance_t), intent(in) :: list(:)         !< each pair once
      integer(ip), intent(in) :: n_nodes               !< of the mesh
      type(refinement_t), intent(in) :: refinement     !< how it came from the deck's, whose nodes the lists name
      type(contact_points_t), intent(inout) :: points(:) !< of each pair
      real(wp), allocatable :: value(:)
      logical, allocatable :: is_given(:)
      real(wp) :: total, weight
      integer(ip) :: i, j, k

      do i = 1, size(list, kind=ip)
         if (list(i)%is_uniform) then
            points(list(i)%pair)%gap = list(i)%value
            points(list(i)%pair)%given_gap = [list(i)%value]
            cycle
         end if
         if (.not. allocated(value)) allocate (value(n_nodes), is_given(n_nodes))
         is_given = .false.
         do k = 1, size(list(i)%node, kind=ip)
            value(list(i)%node(k)) = list(i)%values(k)
            is_given(list(i)%node(k)) = .true.
         end do
         if (is_refined(refinement) .and. .not. list(i)%is_function) call fill_edges(refinement, points(list(i)%pair), value, &
                                                                                     is_given)
         ! the gap of a point is that of its node; of MORTAR the mean over the nodes of its row that have one, as their
         ! displacements are
         associate (pair => points(list(i)%pair))
            pair%given_node = pack([(k, k=1, n_nodes)], is_given)
            pair%given_gap = value(pair%given_node)
            do j = 1, pair%n
               if (.not. is_given(pair%node(j))) cycle
               total = 0.0_wp
               weight = 0.0_wp
               do k = pair%first(j), pair%first(j + 1) - 1
                  if (pair%coefficient(k) <= 0.0_wp .or. .not. is_given(pair%entry(k))) cycle
                  total = total + pair%coefficient(k)*value(pair%entry(k))
                  weight = weight + pair%coefficient(k)
               end do
               pair%gap(j) = total/weight
            end do
         end associate
      end do
   end subroutine set_clearances

   !> The deck's faces interpolate: what --refine and --elements make between nodes of which one is in the table gets the gap
   !> between theirs, also where a set has it, and that of a node that is not in the table is the one of its coordinates.
   pure subroutine fill_edges(refinement, points, value, is_given)
      type(refinement_t), intent(in) :: refinement
      type(contact_points_t), intent(in) :: points
      real(wp), intent(inout) :: value(:)              !< of the nodes of the mesh [L]
      logical, intent(inout) :: is_given(:)
      logical :: is_known(size(value))
      integer(ip) :: edge, j, k, n

      is_known = is_given
      do j = 1, points%n
         if (points%node(j) > refinement%n_nodes .or. is_known(points%node(j))) cycle
         value(points%node(j)) = points%gap(j)
         is_known(points%node(j)) = .true.
      end do
      do edge = 1, refinement%n_edges
         n = merge(3_ip, 2_ip, refinement%edge_node(3, edge) > 0)
         associate (nodes => refinement%edge_node(:n, edge))
            if (.not. (any(is_given(nodes)) .and. all(is_known(nodes)))) cycle
            do k = refinement%edge_first(edge), refinement%edge_first(edge + 1) - 1
               value(k) = edge_value(value(nodes), edge_place(refinement, edge, k))
               is_given(k) = .true.
            end do
         end associate
      end do
   end subroutine fill_edges

   !> All lines of a deck. The surfaces of its pairs are known.
   subroutine read_interferences(context, list)
      type(build_context_t), intent(inout) :: context           !< is_resolved of its pairs
      type(interference_t), allocatable, intent(out) :: list(:) !< each pair once
      type(interference_t) :: one
      type(pair_index_t) :: pairs
      type(string_t) :: names(2)
      type(token_t) :: places(2)
      integer(ip), allocatable :: of_pair(:)           ! place in the list; 0: none so far
      integer(ip) :: i, j, k, n, twin
      logical :: ok(2)

      allocate (list(size(context%model%pairs)))       ! a pair is resolved once
      allocate (of_pair(size(list)), source=0_ip)
      call index_pairs(context, pairs)
      n = 0
      do i = 1, context%deck%n_cards
         associate (card => context%deck%cards(i))
            if (keyword_name(card) /= SHRINK_KEYWORD .or. .not. card%ok) cycle
            if (.not. has_shrink(context, card)) cycle
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (.not. context%deck%lines(k)%ok) cycle
               do j = 1, 2                             ! slave, master
                  places(j) = line_item(context%deck, context%deck%lines(k), j)
                  call get_name(context%deck, places(j), 'name of a surface', names(j)%s, ok(j))
               end do
               if (.not. all(ok)) cycle
               one = interference_t(step=card%step, place=places(1))
               call find_pair(context, pairs, names, places, names(2)%s//', '//names(1)%s, one%pair)
               if (one%pair == 0) cycle
               twin = of_pair(one%pair)
               if (twin > 0) then
                  call report_error(context%deck, one%place, 'E-TWICE', 'the overlap of this pair is resolved already, in '// &
                                    place_text(context%deck, list(twin)%place, one%place), expected='each pair in one step')
                  cycle
               end if
               n = n + 1
               list(n) = one
               of_pair(one%pair) = n
               context%model%pairs(one%pair)%is_resolved = .true.
            end do
         end associate
      end do
      list = list(:n)
   end subroutine read_interferences

   !> Allowed interferences that are given are not built.
   logical function has_shrink(context, card)
      type(build_context_t), intent(in) :: context
      type(card_t), intent(in) :: card
      type(option_t) :: option
      logical :: found

      has_shrink = has_option(context%deck, card, 'SHRINK')
      call find_option(context%deck, card, 'AMPLITUDE', option, found)
      if (.not. has_shrink) then
         call report_error(context%deck, card%place, 'E-NOT-BUILT', 'an interference that is given is not built', &
                           expected='SHRINK, which resolves the initial overlap over the step; *CLEARANCE, VALUE= gives it')
      else if (found) then
         has_shrink = .false.
         call report_error(context%deck, option%name, 'E-CONFLICT', 'SHRINK resolves the overlap linearly over the step', &
                           expected='SHRINK without AMPLITUDE')
      end if
   end function has_shrink

   !> Gives the steps what they allow; the points of the pairs are known.
   subroutine set_interferences(list, context)
      type(interference_t), intent(in) :: list(:)      !< each pair once
      type(build_context_t), intent(inout) :: context  !< steps of its model get overlap and overlap_from
      integer(ip) :: i, k

      if (size(list) == 0) return
      associate (model => context%model)
         do k = 1, size(model%steps, kind=ip)
            allocate (model%steps(k)%overlap(size(model%pairs)), model%steps(k)%overlap_from(size(model%pairs)), source=0.0_wp)
            do i = 1, size(list, kind=ip)
               if (k < list(i)%step) model%steps(k)%overlap(list(i)%pair) = 1.0_wp
               if (k <= list(i)%step) model%steps(k)%overlap_from(list(i)%pair) = 1.0_wp
            end do
         end do
      end associate
      do i = 1, size(list, kind=ip)
         associate (gap => context%model%points(list(i)%pair)%gap)
            if (.not. any(gap < 0.0_wp)) call report_note(context%deck, list(i)%place, 'N-NO-OVERLAP', &
                                                          'this pair has no initial overlap; its least gap is '// &
                                                          to_text(minval(gap), 4)//' [L]')
         end associate
      end do
   end subroutine set_interferences

   !> Sorts the contact pairs by their surfaces, so that find_pair finds them by name.
   subroutine index_pairs(context, pairs)
      type(build_context_t), intent(in) :: context     !< the pairs of its model are indexed
      type(pair_index_t), intent(out) :: pairs         !< sorted by the two surfaces
      integer(ip) :: i

      associate (all_pairs => context%model%pairs)
         pairs%key = [(key_of(context, [all_pairs(i)%slave, all_pairs(i)%master]), i=1, size(all_pairs, kind=ip))]
      end associate
      pairs%pair = sorted_places(pairs%key)
      pairs%key = pairs%key(pairs%pair)
      ! Each line of *CONTACT PAIR has made a pair; where one has not, an error has been reported.
      pairs%is_complete = size(context%model%pairs) == count_lines(context%deck, 'CONTACT PAIR')
   end subroutine index_pairs

   pure integer(lp) function key_of(context, surfaces) result(key)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: surfaces(2)           !< slave and master

      key = int(surfaces(1), lp)*(size(context%model%surfaces, kind=lp) + 1) + surfaces(2)
   end function key_of

   !> The pair of two surfaces, of several the last; 0: there is none.
   pure integer(ip) function pair_of(context, pairs, surfaces) result(pair)
      type(build_context_t), intent(in) :: context
      type(pair_index_t), intent(in) :: pairs
      integer(ip), intent(in) :: surfaces(2)           !< slave and master
      integer(ip) :: i

      pair = 0
      i = first_at_least(pairs%key, key_of(context, surfaces) + 1) - 1
      if (i == 0) return
      if (pairs%key(i) == key_of(context, surfaces)) pair = pairs%pair(i)
   end function pair_of

   !> The pair of a slave and a master. What is wrong is reported at the place of the name.
   subroutine find_pair(context, pairs, names, places, turned, pair)
      type(build_context_t), intent(in) :: context     !< names of its surfaces are read
      type(pair_index_t), intent(in) :: pairs          !< of index_pairs
      type(string_t), intent(in) :: names(2)           !< slave and master, as the deck has them
      type(token_t), intent(in) :: places(2)           !< of the two names
      character(len=*), intent(in) :: turned           !< how it should read if the surfaces are the other way round
      integer(ip), intent(out) :: pair                 !< place in model%pairs; 0: none
      integer(ip) :: surface(2), i

      pair = 0
      do i = 1, 2
         surface(i) = find_name(context%surface_names, names(i)%s)
         if (surface(i) == 0) call report_unknown(context, places(i), 'surface', 'E-SURFACE', context%surface_names)
      end do
      if (any(surface == 0)) return
      pair = pair_of(context, pairs, surface)
      if (pair > 0 .or. .not. pairs%is_complete) return
      if (pair_of(context, pairs, surface(2:1:-1)) > 0) then
         call report_error(context%deck, places(1), 'E-PAIR', names(1)%s//' is the master of this pair, '//names(2)%s// &
                           ' the slave', expected=turned)
      else
         call report_error(context%deck, places(1), 'E-PAIR', 'no *CONTACT PAIR has the slave '//names(1)%s//' and the master '// &
                           names(2)%s, expected='the surfaces of one *CONTACT PAIR')
      end if
   end subroutine find_pair

end module atrito_clearance
