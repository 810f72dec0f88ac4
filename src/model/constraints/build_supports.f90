!> *BOUNDARY: prescribed displacements.
module atrito_build_supports
   use atrito_build_amplitudes, only: take_amplitude, refuse_step_options
   use atrito_build_loads, only: in_no_element
   use atrito_build_rigid_bodies, only: is_reference, ROTATION_DOF
   use atrito_carry_on, only: carry_values, removes_all
   use atrito_deck, only: deck_t, data_line_t, token_t, line_item, keyword_name, is_empty_token, LEVEL_MODEL
   use atrito_diagnostics, only: report_error, report_note
   use atrito_build_context, only: build_context_t, references_t, place_text, ids_text, has_errors, LOOSE_HELD, &
                                   LOOSE_RELEASED, LOOSE_MOVES
   use atrito_items, only: get_integer, get_real, has_option
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: add_nodal_value, replace_nodal_value, replace_source, trim_nodal_values, amplitude_of
   use atrito_model, only: nodal_values_t
   use atrito_parameters, only: evaluate_function
   use atrito_references, only: find_nodes
   use atrito_refined_members, only: edge_value
   use atrito_refinement, only: edge_place, is_refined
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_rigid_motions, only: prescribe_reference, is_prescribed
   use atrito_sources, only: open_source
   use atrito_strings, only: to_text
   use atrito_support_words, only: is_support_word, find_dofs_of_word
   implicit none (type, external)
   private
   public :: build_supports

   integer(ip), parameter :: PLANE_DOFS = 2, LAST_DOF = 6, LOOSE_DOFS = 3
   character(len=*), parameter :: WHAT_DOF = 'degree of freedom: 1 (x) or 2 (y)'

   !> Two values of one dof are the same when they differ by less than this part of the values: expressions are rounded.
   real(wp), parameter :: SAME_VALUE = 1.0e-12_wp

   !> A refined mesh: what the lines of a card prescribe at single nodes, one after the other along an edge.
   type :: by_number_t
      integer(ip), allocatable :: token(:, :)          !< (2, nodes of the deck): first of the line; 0: not prescribed
      real(wp), allocatable :: value(:, :)             !< [L]
      integer(ip) :: n = 0
   end type by_number_t

contains

   !> All prescribed displacements of a step, along the dofs of the deck: those of the model, which are there before the first,
   !> those that are carried on, and its own.
   subroutine build_supports(context)
      type(build_context_t), intent(inout) :: context
      type(by_number_t) :: numbered
      type(nodal_values_t) :: before
      type(references_t) :: motions_before

      if (context%open%number == 1) then
         allocate (context%dof_entry(PLANE_DOFS, context%model%mesh%n_nodes), &
                   context%dof_token(PLANE_DOFS, context%model%mesh%n_nodes), &
                   context%loose_held(LOOSE_DOFS, context%model%mesh%n_nodes), source=0_ip)
         call read_cards(context, 0_ip, numbered)
      else
         call carry_values(context, context%open%supports, keeps_zeros=.true.)
         call carry_values(context, context%open%references%prescribed, keeps_zeros=.true.)
      end if
      where (context%loose_held == LOOSE_RELEASED) context%loose_held = LOOSE_MOVES
      if (removes_all(context, 'BOUNDARY')) then
         before = context%open%supports
         motions_before = context%open%references
         call release_all(context)
         where (context%loose_held == LOOSE_HELD) context%loose_held = LOOSE_RELEASED
      end if
      call read_cards(context, context%open%number, numbered)
      if (allocated(before%from)) call begin_where_it_was(before, context)
      if (before%n + motions_before%prescribed%n > 0) call note_released(before, motions_before, context)
   end subroutine build_supports

   !> A displacement that is given anew by OP=NEW begins with what it has come to.
   pure subroutine begin_where_it_was(before, context)
      type(nodal_values_t), intent(in) :: before       !< with `from`, of this step
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i, entry

      associate (supports => context%open%supports)
         if (.not. allocated(supports%from)) allocate (supports%from(size(supports%value)), source=0.0_wp)
         do i = 1, before%n
            entry = context%dof_entry(before%dof(i), before%node(i))
            if (entry > 0) supports%from(entry) = before%from(i)
         end do
      end associate
      call trim_nodal_values(context%open%supports)
   end subroutine begin_where_it_was

   !> OP=NEW lets go of those of the model, too.
   pure subroutine release_all(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i

      associate (supports => context%open%supports)
         do i = 1, supports%n
            context%dof_entry(supports%dof(i), supports%node(i)) = 0
         end do
         supports%n = 0
      end associate
      context%open%references%prescribed%n = 0
   end subroutine release_all

   !> What stands before the first *STEP holds in every step, until OP=NEW lets go of it: that is told.
   subroutine note_released(before, motions_before, context)
      type(nodal_values_t), intent(in) :: before
      type(references_t), intent(in) :: motions_before
      type(build_context_t), intent(in) :: context
      type(number_list_t) :: released
      type(token_t) :: place
      integer(ip) :: i, of_model

      of_model = 0                                     ! last token of the lines of the model
      do i = context%deck%n_cards, 1, -1
         associate (card => context%deck%cards(i))
            if (keyword_name(card) /= 'BOUNDARY') cycle
            if (card%step == context%open%number) place = card%place
            if (card%step > 0 .or. card%n_lines == 0) cycle
            of_model = max(of_model, context%deck%lines(card%first_line + card%n_lines - 1)%first_token)
         end associate
      end do
      do i = 1, before%n
         if (context%dof_entry(before%dof(i), before%node(i)) > 0) cycle
         associate (token => context%dof_token(before%dof(i), before%node(i)))
            if (token > 0 .and. token <= of_model) call add_number(released, context%model%mesh%node_id(before%node(i)))
         end associate
      end do
      do i = 1, motions_before%prescribed%n
         if (motions_before%token(i) > of_model) cycle
         associate (node => motions_before%prescribed%node(i))
            if (is_prescribed(context, node, motions_before%prescribed%dof(i))) cycle
            call add_number(released, context%model%mesh%node_id(node))
         end associate
      end do
      if (released%n > 0 .and. .not. has_errors()) call report_note(context%deck, place, 'N-RELEASED', &
                                        'OP=NEW lets go of what is held before *STEP, too: node '//ids_text(numbers_of(released)), &
                                            expected='its supports again in this step, or OP=MOD, to keep them', keyword='BOUNDARY')
   end subroutine note_released

   !> The cards of a step; 0: of the model.
   subroutine read_cards(context, step, numbered)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: step
      type(by_number_t), intent(inout) :: numbered
      integer(ip) :: i, k

      do i = merge(1_ip, context%open%first_card, step == 0), merge(context%deck%n_cards, context%open%last_card, step == 0)
         associate (card => context%deck%cards(i))
            if (keyword_name(card) /= 'BOUNDARY' .or. card%step /= step) cycle
            if (card%level == LEVEL_MODEL) call refuse_step_options(context%deck, card)
            call take_amplitude(context, card)
            call begin_numbers(context, numbered)
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (.not. context%deck%lines(k)%ok) cycle
               call open_source(context, 'BOUNDARY', context%deck%tokens(context%deck%lines(k)%first_token))
               if (has_option(context%deck, card, 'FUNCTION')) then
                  call read_function_line(context%deck%lines(k), card%level == LEVEL_MODEL .and. card%ok, context, &
                                          numbered)
               else
                  call read_line(context%deck%lines(k), card%level == LEVEL_MODEL .and. card%ok, context, numbered)
               end if
            end do
            call hold_edges(context, numbered)
         end associate
      end do
      call trim_nodal_values(context%open%supports)
   end subroutine read_cards

   !> Node or set, and a word in the place of the dofs, or first dof[, last dof[, value]].
   subroutine read_line(line, in_model, context, numbered)
      type(data_line_t), intent(in) :: line
      logical, intent(in) :: in_model                  !< before *STEP
      type(build_context_t), intent(inout) :: context
      type(by_number_t), intent(inout) :: numbered
      integer(ip), allocatable :: nodes(:)
      real(wp) :: value
      integer(ip) :: first, last, dof, i
      logical :: ok(4), turns

      if (is_support_word(context%deck, line)) then
         call read_word_line(line, context, numbered)
         return
      end if
      call read_place(line, context, nodes, first, last, ok(:3))
      call get_real(context%deck, line_item(context%deck, line, 4_ip), 'displacement, a real [L]', value, ok(4), 0.0_wp, 'BOUNDARY')
      if (.not. all(ok(2:))) return
      if (in_model .and. abs(value) > 0.0_wp) then
         ok(4) = .false.
         call report_error(context%deck, line_item(context%deck, line, 4_ip), 'E-VALUE', &
                           'a displacement other than 0 before *STEP', &
                           expected='0 [L] here; other values in the step', keyword='BOUNDARY')
      end if
      turns = size(nodes) > 0 .and. all(is_reference(context, nodes))
      if (.not. are_dofs(context%deck, line, first, last, value, turns)) return
      if (.not. all(ok)) return
      call note_loose(line, context, nodes)
      do dof = first, min(last, PLANE_DOFS)
         call prescribe(line, nodes, dof, [(value, i=1, size(nodes, kind=ip))], context)
      end do
      if (last == ROTATION_DOF) call turn(line, nodes, [(value, i=1, size(nodes, kind=ip))], context)
      if (size(nodes) == 1 .and. is_refined(context%refinement)) call take_number(line, nodes(1), first, last, value, numbered)
   end subroutine read_line

   !> Node or set, and a word for some dofs.
   subroutine read_word_line(line, context, numbered)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(inout) :: context
      type(by_number_t), intent(inout) :: numbered
      integer(ip), allocatable :: nodes(:)
      real(wp), allocatable :: zeros(:)
      integer(ip) :: dof
      logical :: held(ROTATION_DOF), ok

      call find_dofs_of_word(context%deck, line, held, ok)
      if (.not. ok) return
      call find_nodes(context, context%deck%tokens(line%first_token), nodes, ok, 'BOUNDARY')
      if (.not. ok) return
      allocate (zeros(size(nodes)), source=0.0_wp)
      call note_loose(line, context, nodes)
      do dof = 1, PLANE_DOFS
         if (.not. held(dof)) cycle
         call prescribe(line, nodes, dof, zeros, context)
         if (size(nodes) == 1 .and. is_refined(context%refinement)) call take_number(line, nodes(1), dof, dof, 0.0_wp, numbered)
      end do
      if (held(ROTATION_DOF)) call turn(line, nodes, zeros, context)
   end subroutine read_word_line

   !> Node or set, first dof[, last dof]: what both kinds of line begin with.
   subroutine read_place(line, context, nodes, first, last, ok)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), allocatable, intent(out) :: nodes(:)
      integer(ip), intent(out) :: first, last
      logical, intent(out) :: ok(3)

      call find_nodes(context, context%deck%tokens(line%first_token), nodes, ok(1), 'BOUNDARY')
      call get_integer(context%deck, line_item(context%deck, line, 2_ip), 'first '//WHAT_DOF, first, ok(2), keyword='BOUNDARY')
      call get_integer(context%deck, line_item(context%deck, line, 3_ip), 'last '//WHAT_DOF, last, ok(3), first, 'BOUNDARY')
   end subroutine read_place

   !> Node or set, first dof[, last dof], expression in x and y.
   subroutine read_function_line(line, in_model, context, numbered)
      type(data_line_t), intent(in) :: line
      logical, intent(in) :: in_model                  !< before *STEP
      type(build_context_t), intent(inout) :: context
      type(by_number_t), intent(inout) :: numbered
      type(token_t) :: expression
      integer(ip), allocatable :: nodes(:)
      real(wp), allocatable :: values(:)
      integer(ip) :: first, last, dof
      logical :: ok(4)

      call read_place(line, context, nodes, first, last, ok(:3))
      ! commas belong to the expression: max(x, y)
      expression = line_item(context%deck, line, 4_ip)
      expression%last = context%deck%tokens(line%first_token + line%n_tokens - 1)%last
      ok(4) = .not. in_model
      if (in_model) call report_error(context%deck, expression, 'E-VALUE', 'a displacement other than 0 before *STEP', &
                                      expected='*BOUNDARY, FUNCTION in the step', keyword='BOUNDARY')
      ! a function is not 0, whatever it is: there are no harmless dofs
      if (all(ok(2:3))) ok(2) = are_dofs(context%deck, line, first, last, 1.0_wp, .false.)
      allocate (values(size(nodes)))
      if (ok(4)) call evaluate_function(context%deck, expression, context%model%mesh%x(:, nodes), values, ok(4), 'BOUNDARY')
      if (.not. all(ok)) return
      call note_loose(line, context, nodes)
      do dof = first, last
         call prescribe(line, nodes, dof, values, context)
      end do
      if (size(nodes) == 1 .and. is_refined(context%refinement)) call take_number(line, nodes(1), first, last, values(1), numbered)
   end subroutine read_function_line

   pure subroutine begin_numbers(context, numbered)
      type(build_context_t), intent(in) :: context
      type(by_number_t), intent(inout) :: numbered

      if (.not. is_refined(context%refinement)) return
      if (.not. allocated(numbered%token)) then
         allocate (numbered%token(PLANE_DOFS, context%refinement%n_nodes), source=0_ip)
         allocate (numbered%value(PLANE_DOFS, context%refinement%n_nodes), source=0.0_wp)
      else if (numbered%n > 0) then
         numbered%token = 0
      end if
      numbered%n = 0
   end subroutine begin_numbers

   pure subroutine take_number(line, node, first, last, value, numbered)
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: node, first, last
      real(wp), intent(in) :: value
      type(by_number_t), intent(inout) :: numbered
      integer(ip) :: dof

      do dof = first, min(last, PLANE_DOFS)
         numbered%token(dof, node) = line%first_token
         numbered%value(dof, node) = value
      end do
      numbered%n = numbered%n + 1
   end subroutine take_number

   !> An edge of the outline all of whose nodes a card prescribes one by one is prescribed between them, too.
   subroutine hold_edges(context, numbered)
      type(build_context_t), intent(inout) :: context
      type(by_number_t), intent(in) :: numbered
      type(data_line_t) :: line
      integer(ip) :: edge, dof, k, n

      if (numbered%n < 2) return
      associate (fine => context%refinement)
         do edge = 1, fine%n_edges
            if (fine%edge_element(2, edge) > 0) cycle
            n = merge(3_ip, 2_ip, fine%edge_node(3, edge) > 0)
            do dof = 1, PLANE_DOFS
               if (any(numbered%token(dof, fine%edge_node(:n, edge)) == 0)) cycle
               line%first_token = numbered%token(dof, fine%edge_node(1, edge))
               line%n_tokens = 1
               call open_source(context, 'BOUNDARY', context%deck%tokens(line%first_token))
               do k = fine%edge_first(edge), fine%edge_first(edge + 1) - 1
                  call prescribe(line, [k], dof, [edge_value(numbered%value(dof, fine%edge_node(:n, edge)), edge_place(fine, edge, &
                                                                                                                       k))], &
                                 context)
               end do
            end do
         end do
      end associate
   end subroutine hold_edges

   !> The dofs of a line exist, or are those of three dimensions and harmless.
   logical function are_dofs(deck, line, first, last, value, turns)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: first, last
      real(wp), intent(in) :: value
      logical, intent(in) :: turns                     !< they are of reference nodes, which have a dof 6
      integer(ip) :: item
      character(len=:), allocatable :: expected

      are_dofs = .false.
      expected = WHAT_DOF
      if (turns .or. last == ROTATION_DOF) expected = WHAT_DOF//'; of the reference node of a *RIGID BODY also 6'
      item = merge(2_ip, 3_ip, first < 1 .or. first > LAST_DOF .or. is_empty_token(line_item(deck, line, 3_ip)))
      if (turns .and. first >= 1 .and. first < ROTATION_DOF .and. last > PLANE_DOFS .and. last <= LAST_DOF .and. &
          abs(value) > 0.0_wp) then
         call report_error(deck, line_item(deck, line, 2_ip), 'E-DOF', 'the dofs 3 to 5 do not exist in the plane', &
                           expected=expected, keyword='BOUNDARY')
      else if (first < 1 .or. max(first, last) > LAST_DOF .or. (last > PLANE_DOFS .and. abs(value) > 0.0_wp .and. .not. turns)) then
         call report_error(deck, line_item(deck, line, item), 'E-DOF', 'dof '//to_text(merge(first, last, item == 2))// &
                           ' does not exist in the plane', expected=expected, keyword='BOUNDARY')
      else if (last < first) then
         call report_error(deck, line_item(deck, line, 3_ip), 'E-DOF', 'the last dof, '//to_text(last)// &
                           ', is less than the first', expected=WHAT_DOF//', not less than the first', keyword='BOUNDARY')
      else
         are_dofs = .true.
         if (last <= PLANE_DOFS .or. turns .and. first == ROTATION_DOF) return
         call report_note(deck, line_item(deck, line, item), 'N-DOF', 'the dofs 3 to '//trim(merge('5', '6', turns)) &
                          //' do not exist in the plane; their value is 0', keyword='BOUNDARY')
      end if
   end function are_dofs

   subroutine note_loose(line, context, nodes)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:)
      logical :: loose(size(nodes))

      loose = in_no_element(context, nodes) .and. .not. is_reference(context, nodes)
      if (.not. any(loose) .or. has_errors()) return
      call report_note(context%deck, line_item(context%deck, line, 1_ip), 'N-NODE', 'node '// &
                       ids_text(pack(context%model%mesh%node_id(nodes), loose))// &
                       ' belongs to no element; the support has no effect there but on springs', keyword='BOUNDARY')
   end subroutine note_loose

   !> Prescribes a dof of those of some nodes that are reference nodes.
   subroutine prescribe_references(line, nodes, dof, value, context)
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: nodes(:), dof
      real(wp), intent(in) :: value(:)                 !< of each node [L], or [-]
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i

      if (size(context%model%rigid_bodies) == 0) return
      do i = 1, size(nodes, kind=ip)
         if (is_reference(context, nodes(i))) call prescribe_reference(context, line%first_token, nodes(i), dof, value(i))
      end do
   end subroutine prescribe_references

   !> Prescribes the rotation of reference nodes; that of the ground, for springs.
   subroutine turn(line, nodes, value, context)
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: nodes(:)
      real(wp), intent(in) :: value(:)                 !< of each node [-]
      type(build_context_t), intent(inout) :: context
      logical :: loose(size(nodes))
      integer(ip) :: i

      call prescribe_references(line, nodes, ROTATION_DOF, value, context)
      loose = in_no_element(context, nodes)
      do i = 1, size(nodes, kind=ip)
         if (loose(i)) call hold_loose(context, nodes(i), LOOSE_DOFS, value(i))
      end do
   end subroutine turn

   !> A node of no element that is held at 0 in all steps is the ground, for springs.
   pure subroutine hold_loose(context, node, dof, value)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: node, dof
      real(wp), intent(in) :: value

      associate (held => context%loose_held(dof, node))
         if (abs(value) > 0.0_wp .or. (held == 0 .and. context%open%number > 1)) then
            held = LOOSE_MOVES
         else if (held /= LOOSE_MOVES) then
            held = LOOSE_HELD
         end if
      end associate
   end subroutine hold_loose

   !> Prescribes a dof of some nodes. A value that differs from an earlier one is an error, told once a line.
   subroutine prescribe(line, nodes, dof, value, context)
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: nodes(:), dof
      real(wp), intent(in) :: value(:)                 !< of each node [L]
      type(build_context_t), intent(inout) :: context
      type(number_list_t) :: clashes, curves
      real(wp) :: first_value, scale
      logical :: loose(size(nodes))
      integer(ip) :: i, entry

      call prescribe_references(line, nodes, dof, value, context)
      loose = in_no_element(context, nodes)
      scale = 0.0_wp
      if (size(nodes) > 0) scale = maxval(abs(value))
      do i = 1, size(nodes, kind=ip)
         if (loose(i)) then
            call hold_loose(context, nodes(i), dof, value(i))
            cycle
         end if
         entry = context%dof_entry(dof, nodes(i))
         if (entry > 0) call replace_source(context%open%supports, entry, context%open%source)
         if (entry == 0) then
            call add_nodal_value(context%open%supports, nodes(i), dof, value(i), amplitude=context%open%amplitude, &
                                 source=context%open%source)
            context%dof_entry(dof, nodes(i)) = context%open%supports%n
            context%dof_token(dof, nodes(i)) = line%first_token
         else if (context%dof_token(dof, nodes(i)) < context%open%first_token) then
            call replace_nodal_value(context%open%supports, entry, value(i), context%open%amplitude)
            context%dof_token(dof, nodes(i)) = line%first_token
         else if (.not. is_same(context%open%supports%value(entry), value(i), scale)) then
            if (clashes%n == 0) first_value = value(i)
            call add_number(clashes, nodes(i))
         else if (abs(value(i)) > 0.0_wp .and. amplitude_of(context%open%supports, entry) /= context%open%amplitude) then
            call add_number(curves, nodes(i))
         end if
      end do
      if (clashes%n > 0) call report_clash(line, context, numbers_of(clashes), dof, first_value)
      if (curves%n > 0) call report_curves(line, context, numbers_of(curves), dof)
   end subroutine prescribe

   !> Equal but for round-off: 0.3 x and 0.1 x + 0.2 at x = 1.
   pure logical function is_same(earlier, value, scale)
      real(wp), intent(in) :: earlier, value
      real(wp), intent(in) :: scale                    !< largest value of the line

      is_same = abs(earlier - value) <= SAME_VALUE*max(abs(earlier), scale)
   end function is_same

   subroutine report_clash(line, context, nodes, dof, value)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:), dof
      real(wp), intent(in) :: value
      integer, parameter :: FEW = 6, ALL_DIGITS = 15
      type(token_t) :: earlier
      real(wp) :: other
      integer :: digits

      earlier = context%deck%tokens(context%dof_token(dof, nodes(1)))
      other = context%open%supports%value(context%dof_entry(dof, nodes(1)))
      digits = merge(ALL_DIGITS, FEW, to_text(value, FEW) == to_text(other, FEW))
      call report_error(context%deck, line_item(context%deck, line, 1_ip), 'E-CONFLICT', 'dof '//to_text(dof)//' of node '// &
                        ids_text(context%model%mesh%node_id(nodes))//' is '//to_text(value, digits)//' here but '//to_text(other, &
                                                                                digits)//' in '//place_text(context%deck, earlier, &
                                                                                           context%deck%tokens(line%first_token)), &
                        expected='one value for each dof in a step [L]', keyword='BOUNDARY')
   end subroutine report_clash

   !> One displacement with two amplitudes.
   subroutine report_curves(line, context, nodes, dof)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:), dof

      call report_error(context%deck, line_item(context%deck, line, 1_ip), 'E-CONFLICT', 'dof '//to_text(dof)//' of node '// &
                        ids_text(context%model%mesh%node_id(nodes))//' has another amplitude here than in '// &
                        place_text(context%deck, context%deck%tokens(context%dof_token(dof, nodes(1))), &
                                   context%deck%tokens(line%first_token)), expected='one AMPLITUDE= for each dof in a step', &
                        keyword='BOUNDARY')
   end subroutine report_curves

end module atrito_build_supports
