!> *BOUNDARY: prescribed displacements, and the words ENCASTRE, XSYMM, ... that hold several dofs at once.
module atrito_build_supports
   use atrito_build_steps, only: take_amplitude, refuse_step_options
   use atrito_build_rigid_bodies, only: can_move, is_reference, ROTATION_DOF
   use atrito_deck, only: data_line_t, last_item, token_t, token_text, keyword_name, is_empty_token, LEVEL_MODEL
   use atrito_diagnostics, only: report_error, report_note
   use atrito_build_context, only: build_context_t, line_token, open_line, place_text, ids_text, has_errors, LOOSE_HELD, &
                                   LOOSE_RELEASED, LOOSE_MOVES
   use atrito_items, only: get_integer, get_real, has_option
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: condition_t, condition_list_t, add_condition, dof_slot, SLOTS
   use atrito_parameters, only: evaluate_function
   use atrito_propagation, only: is_inherited, propagate, removes_all, open_source
   use atrito_references, only: find_nodes, in_no_element
   use atrito_refined_members, only: edge_value
   use atrito_refinement, only: edge_place, is_refined
   use atrito_growth, only: number_list_t, add_number, numbers_of
   use atrito_row_dofs, only: has_no_unknowns, WHAT_DOF, AT_REFERENCE
   use atrito_strings, only: same_name, string_t, to_text
   implicit none (type, external)
   private
   public :: build_supports

   integer(ip), parameter :: PLANE_DOFS = 2, LAST_DOF = 6

   !> Two values of one dof are the same when they differ by less than this part of the largest: expressions are rounded, as 0.3 x
   !> and 0.1 x + 0.2 at x = 1.
   real(wp), parameter :: SAME_VALUE = 1.0e-12_wp

   !> A refined mesh: what the lines of a card prescribe at single nodes, one after the other along an edge.
   type :: by_number_t
      integer(ip), allocatable :: line(:, :)           !< (2, nodes of the deck); 0: not prescribed
      real(wp), allocatable :: value(:, :)             !< [L]
      integer(ip) :: n = 0                             !< lines
   end type by_number_t

   !> Words that hold several dofs at once.
   type :: support_word_t
      character(len=8) :: name                   !< as the deck has it
      logical :: holds(LAST_DOF)                 !< dofs, by their numbers
   end type support_word_t

   logical, parameter :: T = .true., F = .false.
   type(support_word_t), parameter :: WORDS(8) = [ &
                                      support_word_t('ENCASTRE', [T, T, T, T, T, T]), &
                                      support_word_t('PINNED  ', [T, T, T, F, F, F]), &
                                      support_word_t('XSYMM   ', [T, F, F, F, T, T]), &
                                      support_word_t('YSYMM   ', [F, T, F, T, F, T]), &
                                      support_word_t('ZSYMM   ', [F, F, T, T, T, F]), &
                                      support_word_t('XASYMM  ', [F, T, T, T, F, F]), &
                                      support_word_t('YASYMM  ', [T, F, T, F, T, F]), &
                                      support_word_t('ZASYMM  ', [T, T, F, F, F, T])]

contains

   !> All prescribed displacements of a step, along the dofs of the deck: those of the model, which are there before the first,
   !> those that are inherited, and its own.
   subroutine build_supports(context)
      type(build_context_t), intent(inout) :: context  !< open%supports, dof_entry and loose_held change
      type(by_number_t) :: numbered
      type(condition_list_t) :: before, inherited
      integer(ip) :: i, entry

      if (context%open%number == 1) then
         allocate (context%dof_entry(SLOTS, context%model%mesh%n_nodes), &
                   context%loose_held(SLOTS, context%model%mesh%n_nodes), source=0_ip)
         call read_cards(context, 0_ip, numbered)
      else
         call propagate(context, context%open%supports, keeps_zeros=.true.)
      end if
      where (context%loose_held == LOOSE_RELEASED) context%loose_held = LOOSE_MOVES
      if (removes_all(context, 'BOUNDARY')) then
         before = context%open%supports
         context%open%supports%n = 0
         context%dof_entry = 0
         where (context%loose_held == LOOSE_HELD) context%loose_held = LOOSE_RELEASED
      end if
      if (is_refined(context%refinement)) inherited = context%open%supports
      call read_cards(context, context%open%number, numbered)
      call follow_ends(inherited, context)
      do i = 1, before%n
         associate (old => before%list(i))
            ! a displacement that is given anew by OP=NEW begins with what it has come to
            entry = context%dof_entry(dof_slot(old%dof), old%place)
            if (entry > 0) context%open%supports%list(entry)%from = old%from
         end associate
      end do
      if (before%n > 0) call note_released(before, context)
   end subroutine build_supports

   !> What stands before the first *STEP holds in every step, until OP=NEW removes it, which is noted.
   subroutine note_released(before, context)
      type(condition_list_t), intent(in) :: before
      type(build_context_t), intent(in) :: context
      type(number_list_t) :: released
      type(token_t) :: place
      integer(ip) :: i, pass, of_model

      of_model = 0                                     ! last line of the model
      do i = context%deck%n_cards, 1, -1
         associate (card => context%deck%cards(i))
            if (keyword_name(card) /= 'BOUNDARY') cycle
            if (card%step == context%open%number) place = card%place
            if (card%step == 0) of_model = max(of_model, card%first_line + card%n_lines - 1)
         end associate
      end do
      do pass = 1, 2                                   ! reference nodes last
         do i = 1, before%n
            associate (old => before%list(i))
               if (is_reference(context, old%place) .neqv. pass == 2) cycle
               if (context%dof_entry(dof_slot(old%dof), old%place) > 0 .or. old%line == 0 .or. old%line > of_model) cycle
               call add_number(released, context%model%mesh%node_id(old%place))
            end associate
         end do
      end do
      if (released%n > 0 .and. .not. has_errors()) call report_note(context%deck, place, 'N-RELEASED', &
                                                                    'OP=NEW lets go of what is held before *STEP, too: node '// &
                                                                    ids_text(numbers_of(released)), &
                                                                expected='its supports again in this step, or OP=MOD, to keep them')
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
            if (is_refined(context%refinement) .and. .not. allocated(numbered%line)) then
               allocate (numbered%line(PLANE_DOFS, context%refinement%n_nodes), source=0_ip)
               allocate (numbered%value(PLANE_DOFS, context%refinement%n_nodes), source=0.0_wp)
            else if (numbered%n > 0) then
               numbered%line = 0
            end if
            numbered%n = 0
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (.not. context%deck%lines(k)%ok) cycle
               context%open%line = k
               call open_source(context, 'BOUNDARY', line_token(context, 1_ip))
               call read_line(has_option(context%deck, card, 'FUNCTION'), card%level == LEVEL_MODEL .and. card%ok, context, &
                              numbered)
            end do
            call prescribe_edges(context, numbered)
            if (numbered%n == 0) cycle
            if (.not. allocated(context%held_singly)) then
               allocate (context%held_singly(PLANE_DOFS, context%refinement%n_nodes), source=.false.)
            end if
            context%held_singly = context%held_singly .or. numbered%line > 0
         end associate
      end do
   end subroutine read_cards

   !> Node or set, and a word in the place of the dofs, or first dof[, last dof[, value]], or these and a function of x and y.
   subroutine read_line(is_function, in_model, context, numbered)
      logical, intent(in) :: is_function
      logical, intent(in) :: in_model                  !< before *STEP
      type(build_context_t), intent(inout) :: context
      type(by_number_t), intent(inout) :: numbered
      integer(ip), allocatable :: nodes(:)
      real(wp), allocatable :: values(:)               ! of the nodes
      logical, allocatable :: loose(:), turns(:)       ! nodes without unknowns, and those that are reference nodes
      integer(ip) :: dof, i
      logical :: held(LAST_DOF), ok

      if (is_support_word(context) .and. .not. is_function) then
         call find_dofs_of_word(context, held, ok)
         if (ok) call find_nodes(context, line_token(context, 1_ip), nodes, ok)
         if (ok) values = spread(0.0_wp, 1, size(nodes))
      else
         call read_values(nodes, values, ok)
      end if
      if (.not. ok) return
      loose = has_no_unknowns(context, nodes)
      if (any(loose) .and. .not. has_errors()) then
         call report_note(context%deck, line_token(context, 1_ip), 'N-NODE', 'node '// &
                          ids_text(pack(context%model%mesh%node_id(nodes), loose))// &
                          ' belongs to no element; the support has no effect there but on springs')
      end if
      turns = is_reference(context, nodes)
      do dof = 1, LAST_DOF
         if (.not. held(dof) .or. (dof > PLANE_DOFS .and. dof /= ROTATION_DOF)) cycle
         do i = 1, size(nodes, kind=ip)
            if (turns(i)) call prescribe([nodes(i)], dof, [values(i)], context)
         end do
         call prescribe(pack(nodes,.not. turns), dof, pack(values,.not. turns), context)
      end do
      if (size(nodes) /= 1 .or. .not. is_refined(context%refinement)) return
      where (held(:PLANE_DOFS))
         numbered%line(:, nodes(1)) = context%open%line
         numbered%value(:, nodes(1)) = values(1)
      end where
      numbered%n = numbered%n + 1

   contains

      !> Node or set, first dof[, last dof[, value]], or in the place of the value an expression in x and y.
      subroutine read_values(nodes, values, is_ok)
         integer(ip), allocatable, intent(out) :: nodes(:)
         real(wp), allocatable, intent(out) :: values(:)  !< of the nodes [L], or [-]
         logical, intent(out) :: is_ok
         type(token_t) :: place, last_token
         real(wp) :: value
         integer(ip) :: first, last
         logical :: ok(4)

         is_ok = .false.
         call find_nodes(context, line_token(context, 1_ip), nodes, ok(1))
         call get_integer(context%deck, line_token(context, 2_ip), 'first '//WHAT_DOF, first, ok(2))
         call get_integer(context%deck, line_token(context, 3_ip), 'last '//WHAT_DOF, last, ok(3), first)
         place = line_token(context, 4_ip)
         if (is_function) then
            last_token = last_item(context%deck, open_line(context))
            place%last = last_token%last                  ! commas belong to the expression: max(x, y)
            value = 1.0_wp                                ! a function is not 0, whatever it is: there are no harmless dofs
            ok(4) = .true.
         else
            call get_real(context%deck, place, 'displacement, a real [L]', value, ok(4), 0.0_wp)
            if (.not. all(ok(2:))) return
         end if
         if (in_model .and. abs(value) > 0.0_wp) then
            ok(4) = .false.
            call report_error(context%deck, place, 'E-VALUE', 'a displacement other than 0 before *STEP', &
                              expected=trim(merge('*BOUNDARY, FUNCTION in the step     ', '0 [L] here; other values in the step', &
                                                  is_function)))
         end if
         if (all(ok(2:3))) ok(2) = are_dofs(context, first, last, value,.not. is_function .and. size(nodes) > 0 .and. &
                                            all(is_reference(context, nodes)))
         values = spread(value, 1, size(nodes))
         if (is_function .and. ok(4)) call evaluate_function(context%deck, place, context%model%mesh%x(:, nodes), values, ok(4), &
                                                             'BOUNDARY')
         is_ok = all(ok)
         if (.not. is_ok) return
         held = .false.
         held(first:last) = .true.
         held(ROTATION_DOF) = last == ROTATION_DOF
      end subroutine read_values
   end subroutine read_line

   !> An edge of the outline all of whose nodes a card prescribes one by one is prescribed between them, too.
   subroutine prescribe_edges(context, numbered)
      type(build_context_t), intent(inout) :: context
      type(by_number_t), intent(in) :: numbered
      integer(ip) :: edge, dof, k, n

      if (numbered%n < 2) return
      associate (fine => context%refinement)
         do edge = 1, fine%n_edges
            if (fine%edge_element(2, edge) > 0) cycle
            n = merge(3_ip, 2_ip, fine%edge_node(3, edge) > 0)
            do dof = 1, PLANE_DOFS
               associate (nodes => fine%edge_node(:n, edge))
                  if (any(numbered%line(dof, nodes) == 0)) cycle
                  context%open%line = numbered%line(dof, nodes(1))
                  call open_source(context, 'BOUNDARY', line_token(context, 1_ip))
                  do k = fine%edge_first(edge), fine%edge_first(edge + 1) - 1
                     call prescribe([k], dof, [edge_value(numbered%value(dof, nodes), edge_place(fine, edge, k))], context)
                  end do
               end associate
            end do
         end do
      end associate
   end subroutine prescribe_edges

   !> Where a line of the step moves a node of a set that an earlier step holds, the new nodes of the edges beside it go along:
   !> they stay between the nodes of the deck. Values that have curves of their own do not add up to one, which is told.
   subroutine follow_ends(inherited, context)
      type(condition_list_t), intent(in) :: inherited  !< supports before the lines of the step; empty where nothing is
      type(build_context_t), intent(inout) :: context  !< values of new nodes change
      integer(ip) :: edge, dof, entry(3), i, k, n
      logical :: is_told

      is_told = .false.
      if (inherited%n == 0) return
      associate (fine => context%refinement, now => context%open%supports%list, ids => context%model%mesh%node_id)
         do edge = 1, fine%n_edges
            n = merge(3_ip, 2_ip, fine%edge_node(3, edge) > 0)
            do dof = 1, PLANE_DOFS
               entry(:n) = context%dof_entry(dof, fine%edge_node(:n, edge))
               if (any(entry(:n) == 0 .or. entry(:n) > inherited%n)) cycle
               if (all([(is_inherited(context, now(entry(i))), i=1, n)])) cycle
               do k = fine%edge_first(edge), fine%edge_first(edge + 1) - 1
                  associate (new => context%dof_entry(dof, k))
                     if (new == 0) cycle
                     if (.not. is_inherited(context, now(new))) cycle
                     if (all(now(entry(:n))%amplitude == now(entry(1))%amplitude)) then
                        now(new)%value(1) = edge_value(now(entry(:n))%value(1), edge_place(fine, edge, k))
                        now(new)%amplitude = now(entry(1))%amplitude
                     else if (.not. is_told) then
                        is_told = .true.
                        call report_note(context%deck, line_token(context, 1_ip), 'N-REFINE', 'nodes '// &
                                         to_text(ids(fine%edge_node(1, edge)))//' and '//to_text(ids(fine%edge_node(2, edge)))// &
                                         ' have other amplitudes; nodes of the finer mesh between them keep what they had')
                     end if
                  end associate
               end do
            end do
         end do
      end associate
   end subroutine follow_ends

   !> The dofs of a line exist, or are those of three dimensions and harmless.
   logical function are_dofs(context, first, last, value, turns)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: first, last
      real(wp), intent(in) :: value
      logical, intent(in) :: turns                     !< they are of reference nodes, which have a dof 6
      integer(ip) :: item
      character(len=:), allocatable :: expected

      are_dofs = .false.
      expected = WHAT_DOF
      if (turns .or. last == ROTATION_DOF) expected = WHAT_DOF//AT_REFERENCE
      item = merge(2_ip, 3_ip, first < 1 .or. first > LAST_DOF .or. is_empty_token(line_token(context, 3_ip)))
      if (turns .and. first >= 1 .and. first < ROTATION_DOF .and. last > PLANE_DOFS .and. last <= LAST_DOF .and. &
          abs(value) > 0.0_wp) then
         call report_error(context%deck, line_token(context, 2_ip), 'E-DOF', 'the dofs 3 to 5 do not exist in the plane', &
                           expected=expected)
      else if (first < 1 .or. max(first, last) > LAST_DOF .or. (last > PLANE_DOFS .and. abs(value) > 0.0_wp .and. .not. turns)) then
         call report_error(context%deck, line_token(context, item), 'E-DOF', 'dof '//to_text(merge(first, last, item == 2))// &
                           ' does not exist in the plane', expected=expected)
      else if (last < first) then
         call report_error(context%deck, line_token(context, 3_ip), 'E-DOF', 'the last dof, '//to_text(last)// &
                           ', is less than the first', expected=WHAT_DOF//', not less than the first')
      else
         are_dofs = .true.
         if (last <= PLANE_DOFS .or. turns .and. first == ROTATION_DOF) return
         call report_note(context%deck, line_token(context, item), 'N-DOF', 'the dofs 3 to '//trim(merge('5', '6', turns))// &
                          ' do not exist in the plane; their value is 0')
      end if
   end function are_dofs

   !> A node of no element that is held at 0 in all steps is the ground, for springs.
   pure subroutine note_ground(context, node, dof, value)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: node, dof
      real(wp), intent(in) :: value

      associate (held => context%loose_held(dof_slot(dof), node))
         if (abs(value) > 0.0_wp .or. (held == 0 .and. context%open%number > 1)) then
            held = LOOSE_MOVES
         else if (held /= LOOSE_MOVES) then
            held = LOOSE_HELD
         end if
      end associate
   end subroutine note_ground

   !> Prescribes a dof of some nodes; a line of a later step takes the place of an earlier one. A value that differs from an earlier
   !> one of the step is an error, reported once a line.
   subroutine prescribe(nodes, dof, value, context)
      integer(ip), intent(in) :: nodes(:), dof         !< dof 1, 2, or 6: the rotation of reference nodes
      real(wp), intent(in) :: value(:)                 !< of each node [L], or [-]
      type(build_context_t), intent(inout) :: context
      type(number_list_t) :: clashes, curves
      type(condition_t) :: new
      real(wp) :: first_value, scale
      logical :: loose(size(nodes))
      integer(ip) :: i, entry

      associate (open => context%open)
         new = condition_t(dof=dof, line=open%line, amplitude=open%amplitude, source=open%source)
         loose = in_no_element(context, nodes)
         scale = 0.0_wp
         if (size(nodes) > 0) scale = maxval(abs(value))
         do i = 1, size(nodes, kind=ip)
            if (loose(i)) call note_ground(context, nodes(i), dof, value(i))
            if (is_reference(context, nodes(i))) then
               if (.not. can_move(context, line_token(context, 1_ip), nodes(i), dof, value(i))) cycle
            else if (loose(i) .or. dof == ROTATION_DOF) then
               cycle
            end if
            entry = context%dof_entry(dof_slot(dof), nodes(i))
            if (entry == 0) then
               new%place = nodes(i)
               new%value(1) = value(i)
               call add_condition(open%supports, new)
               context%dof_entry(dof_slot(dof), nodes(i)) = open%supports%n
               cycle
            end if
            associate (old => open%supports%list(entry))
               old%source = open%source
               if (is_inherited(context, old)) then
                  old%value(1) = value(i)
                  old%amplitude = open%amplitude
                  old%line = open%line
               else if (abs(old%value(1) - value(i)) > SAME_VALUE*max(abs(old%value(1)), scale)) then
                  if (clashes%n == 0) first_value = value(i)
                  call add_number(clashes, nodes(i))
               else if (abs(value(i)) > 0.0_wp .and. old%amplitude /= open%amplitude) then
                  call add_number(curves, nodes(i))
               end if
            end associate
         end do
      end associate
      if (clashes%n > 0) call report_clash(context, numbers_of(clashes), dof, first_value)
      if (curves%n > 0) call report_conflict(context, numbers_of(curves), dof, 'has another amplitude here than', &
                                             'one AMPLITUDE= for each dof in a step')
   end subroutine prescribe

   !> Two values of one dof, with as many digits as tell them apart.
   subroutine report_clash(context, nodes, dof, value)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:), dof
      real(wp), intent(in) :: value
      integer, parameter :: FEW = 6, ALL_DIGITS = 15
      real(wp) :: other
      integer :: digits

      other = context%open%supports%list(context%dof_entry(dof_slot(dof), nodes(1)))%value(1)
      digits = merge(ALL_DIGITS, FEW, to_text(value, FEW) == to_text(other, FEW))
      call report_conflict(context, nodes, dof, 'is '//to_text(value, digits)//' here but '//to_text(other, digits), &
                           'one value for each dof in a step [L]')
   end subroutine report_clash

   !> The line that is being read says other things of a dof of some nodes than an earlier line of the step.
   subroutine report_conflict(context, nodes, dof, what, expected)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:), dof
      character(len=*), intent(in) :: what, expected
      integer(ip) :: earlier

      earlier = context%open%supports%list(context%dof_entry(dof_slot(dof), nodes(1)))%line
      associate (deck => context%deck, place => line_token(context, 1_ip))
         call report_error(deck, place, 'E-CONFLICT', 'dof '//to_text(dof)//' of node '// &
                           ids_text(context%model%mesh%node_id(nodes))//' '//what//' in '// &
                           place_text(deck, deck%tokens(deck%lines(earlier)%first_token), place), expected=expected)
      end associate
   end subroutine report_conflict

   !> The second item of a line begins with a letter: no dof does.
   pure logical function is_support_word(context)
      type(build_context_t), intent(in) :: context
      character(len=1) :: first
      type(token_t) :: token

      token = line_token(context, 2_ip)
      is_support_word = .not. is_empty_token(token)
      if (.not. is_support_word) return
      first = context%deck%sources(token%source)%text(token%first:token%first)
      is_support_word = (first >= 'A' .and. first <= 'Z') .or. (first >= 'a' .and. first <= 'z')
   end function is_support_word

   !> The dofs that the word of a line holds.
   subroutine find_dofs_of_word(context, holds, ok)
      type(build_context_t), intent(in) :: context
      logical, intent(out) :: holds(LAST_DOF)
      logical, intent(out) :: ok
      type(data_line_t) :: line
      type(string_t) :: known(size(WORDS))
      type(token_t) :: token
      integer :: i

      token = line_token(context, 2_ip)
      line = open_line(context)
      holds = .false.
      ok = .false.
      do i = 1, size(WORDS)
         known(i)%s = trim(WORDS(i)%name)
         if (.not. same_name(token_text(context%deck, token), known(i)%s)) cycle
         holds = WORDS(i)%holds
         ok = .true.
      end do
      if (.not. ok) then
         call report_error(context%deck, token, 'E-DOF', token_text(context%deck, token)// &
                           ' is neither a dof nor a word for several', expected='degree of freedom: 1 (x) or 2 (y), or a word: '// &
                           'ENCASTRE and PINNED hold both, XSYMM dof 1, YSYMM dof 2', known=known)
      else if (line%n_tokens > 2) then
         ok = .false.
         call report_error(context%deck, line_token(context, 3_ip), 'E-ITEMS', 'items behind '//token_text(context%deck, token), &
                           expected='nothing: what a word holds is 0')
      end if
   end subroutine find_dofs_of_word

end module atrito_build_supports
