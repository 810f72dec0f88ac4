!> The deck's meaning: all cards to one model.
!>
!> *INSTANCE: where the instances of parts stand.
module atrito_build_model
   use atrito_adjustment, only: adjusted_t, adjust_pairs, close_adjusted
   use atrito_axis, only: hold_axis, check_axis
   use atrito_bilateral_rows, only: trim_rows
   use atrito_build_block, only: read_block_card, place_block_elements
   use atrito_build_contact, only: build_contact, contact_rules_t, read_contact_rules
   use atrito_build_context, only: build_context_t, prepare_context, has_errors
   use atrito_build_elements, only: read_element_card, read_elgen_card
   use atrito_build_equations, only: build_equations
   use atrito_build_gmsh, only: read_mesh_nodes, read_mesh_elements
   use atrito_build_lines, only: read_lines, read_curves, turn_elements
   use atrito_build_loads, only: build_loads
   use atrito_build_materials, only: build_materials
   use atrito_build_nodes, only: note_digits, read_node_card, read_fill_card
   use atrito_drawn_lines, only: place_paths, place_cuts
   use atrito_build_pretension, only: build_pretension, add_pretension_rows
   use atrito_build_requests, only: build_requests
   use atrito_build_rigid_bodies, only: build_rigid_bodies, make_solver_mesh
   use atrito_build_sets, only: try_set_card, read_set_card, read_copy_card
   use atrito_build_springs, only: build_springs
   use atrito_build_steps, only: build_amplitudes, build_steps, open_step
   use atrito_build_supports, only: build_supports
   use atrito_build_surfaces, only: build_surfaces
   use atrito_build_ties, only: read_ties, check_ties, build_ties
   use atrito_refine_model, only: build_trees, has_cuts, cut_model, refine_model
   use atrito_check_contact, only: check_surfaces_of_pairs, check_points_of_pairs, note_unused_interactions
   use atrito_check_contact_sense, only: warn_of_overlap, warn_of_loaded_contact, warn_of_pairs_twice
   use atrito_check_mesh, only: check_mesh
   use atrito_clearance, only: clearance_t, interference_t, read_clearances, read_interferences, set_clearances, set_interferences
   use atrito_contact_roles, only: choose_roles
   use atrito_deck, only: deck_t, count_lines, token_t, token_text, line_item, keyword_name, card_t
   use atrito_diagnostics, only: report_error
   use atrito_element_trees, only: element_trees_t, list_leaves
   use atrito_faces, only: chain_report_t, list_node_elements
   use atrito_found_contact, only: find_contact
   use atrito_items, only: option_text, makes_elements
   use atrito_kinds, only: ip, lp, wp
   use atrito_local_axes, only: read_local_axes
   use atrito_memory, only: available_memory
   use atrito_mesh, only: trim_mesh
   use atrito_messages, only: message_mark_t, mark_messages, forget_messages
   use atrito_model, only: model_t, observed_line_t, units_t, N_UNITS
   use atrito_coordinates, only: read_shift, read_rotation
   use atrito_node_fields, only: read_temperatures, read_node_thickness, check_temperatures
   use atrito_pairing, only: order_slaves, pair_all
   use atrito_plane_state, only: FULL_STATE
   use atrito_points, only: contact_points_t
   use atrito_propagation, only: keep_sources
   use atrito_refined_deck, only: note_free_sides
   use atrito_row_dofs, only: add_rigid_rows, turn_supports
   use atrito_strings, only: deck_name
   implicit none (type, external)
   private
   public :: build_model, list_observed

contains

   !> Builds the model that a deck describes and checks it. All errors go to atrito_messages; the model is whole and sound when
   !> there are none there, and of no use otherwise.
   !>
   !> Cards are read by subject, not by place: a section may stand before the elements of its set. Only nodes, elements and sets
   !> are made in the order of the deck, since they follow from each other.
   !>
   !> With levels > 0 every element is refined into 4**levels, and with a shape all become elements of that shape. The model is
   !> built without it first: messages name the elements that stand in the deck. With trees their leaves are the elements; empty
   !> ones are begun, and all elements cut as often as there are levels.
   subroutine build_model(deck, model, levels, memory, shape, state, trees)
      type(deck_t), intent(in) :: deck                 !< read and checked by read_deck
      type(model_t), intent(out) :: model              !< whole where no error was reported
      integer(ip), intent(in), optional :: levels      !< of refinement, >= 0; default 0
      integer(lp), intent(in), optional :: memory      !< that the mesh may take [bytes]; default what the machine has
      integer(ip), intent(in), optional :: shape       !< of all elements, place in SHAPES; default 0: as in the deck
      integer(ip), intent(in), optional :: state       !< of all elements with a shape, for its integration; default 0
      type(element_trees_t), intent(inout), optional :: trees !< how the elements of the deck are cut; left out: by `levels`
      type(message_mark_t) :: mark
      integer(lp) :: limit
      type(element_trees_t) :: forest
      integer(ip) :: depth, kind, own

      limit = available_memory()
      if (present(memory)) limit = memory
      depth = 0
      if (present(levels)) depth = levels
      kind = 0
      if (present(shape)) kind = shape
      own = 0
      if (present(state)) own = state
      if (deck%is_outside) return                      ! an error, and the others would follow from it
      mark = mark_messages()
      if (present(trees)) then
         call build_by_trees(deck, depth, limit, model, trees)
         return
      else if (has_cuts(deck) .and. kind == 0) then
         call build_by_trees(deck, depth, limit, model, forest)
         return
      end if
      call build_once(deck, 0_ip, 0_ip, 0_ip, limit, model)
      if (has_errors()) return
      if (own > 0) then                                ! only how the same state is integrated may change
         if (any(FULL_STATE(model%mesh%state) /= FULL_STATE(own))) own = 0
      end if
      if (depth == 0 .and. (kind == 0 .or. all(model%mesh%shape == kind)) .and. (own == 0 .or. all(model%mesh%state == own))) return
      call forget_messages(mark)
      call build_once(deck, depth, kind, own, limit, model)
   end subroutine build_model

   !> The model whose elements are the leaves of trees.
   subroutine build_by_trees(deck, levels, memory, model, trees)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: levels                !< of empty trees, besides what the deck cuts
      integer(lp), intent(in) :: memory
      type(model_t), intent(out) :: model
      type(element_trees_t), intent(inout) :: trees
      type(message_mark_t) :: mark

      if (trees%n == 0) then
         mark = mark_messages()
         call build_once(deck, levels, 0_ip, 0_ip, memory, model, trees)
         if (has_errors()) return
         trees%leaf_of = list_leaves(trees)
         if (size(trees%leaf_of) == trees%n_roots) return
         call forget_messages(mark)
      end if
      call build_once(deck, 0_ip, 0_ip, 0_ip, memory, model, trees)
   end subroutine build_by_trees

   !> Builds the model once, subject by subject. What stands later may refer to what stands before:
   !>
   !>     nodes, elements, sets     in the order of the deck; finer elements take their place before anything else names any
   !>     surfaces, rigid bodies    bolts (*PRE-TENSION SECTION) cut the mesh in two along a surface
   !>     materials, contact        names of pairs, laws, what changes gaps
   !>     steps                     supports, loads and requests of one step after the other: each inherits from the one before
   !>     rows                      equations, springs and bolts, for a node that is held in all steps is the ground of a spring
   !>     ties, pairs               contact that is found, nodes that are moved onto their masters; with an error so far none
   !>     points                    of all pairs, over places that do not change any more
   !>     cuts, paths               through the mesh as it has become
   subroutine build_once(deck, levels, shape, state, memory, model, trees)
      type(deck_t), intent(in), target :: deck
      integer(ip), intent(in) :: levels, shape, state
      integer(lp), intent(in) :: memory
      type(model_t), intent(out), target :: model
      type(element_trees_t), intent(inout), optional :: trees !< empty ones are begun, and change nothing yet
      type(build_context_t) :: context
      type(contact_rules_t) :: rules
      type(chain_report_t), allocatable :: chains(:)
      type(contact_points_t), allocatable :: points(:)
      type(clearance_t), allocatable :: clearances(:)
      type(interference_t), allocatable :: interferences(:)
      type(adjusted_t), allocatable :: adjusted(:)
      integer(ip) :: i

      call prepare_context(deck, context)
      context%model => model
      context%memory = memory
      call take_titles(deck, model)
      call take_units(deck, model%units)
      call take_parameters(deck, model)
      call list_observed(deck, model%observed)
      call build_steps(context)
      call build_amplitudes(context)
      call build_instances(context)
      call build_nodes(context)
      call build_elements(context)
      if (.not. context%has_room) return               ! an error, and others would follow from what was not made
      call trim_mesh(model%mesh)
      context%around = list_node_elements(model%mesh)
      call note_digits(levels > 0 .or. shape > 0 .or. present(trees), context)
      call read_curves(context)
      call read_temperatures(context)
      call read_node_thickness(context)
      if (.not. present(trees)) then
         if (levels > 0 .or. shape > 0) call refine_model(levels, shape, context)
      else if (trees%n > 0) then
         call cut_model(trees, context)
      end if
      if (state > 0) model%mesh%state = state
      call build_surfaces(context)
      call build_rigid_bodies(context)
      call build_pretension(context)
      call build_materials(context)
      call check_temperatures(context)
      call build_contact(context)
      call read_clearances(context, clearances)
      call read_interferences(context, interferences)
      call read_contact_rules(context, rules)
      call read_ties(context)
      call read_local_axes(context)
      call fill_steps(context)
      call build_equations(context)
      call build_springs(context)
      call note_free_sides(context)
      call add_pretension_rows(context)
      call check_mesh(model, context)
      call check_axis(model, context)
      call order_slaves(model, chains)
      call check_surfaces_of_pairs(model, context, chains)
      call check_ties(context, chains)
      if (has_errors()) return
      call build_ties(context)
      call find_contact(rules, context)
      call note_unused_interactions(model, context)
      call adjust_pairs(context, adjusted)
      if (has_errors()) return
      call choose_roles(clearances, context)
      call add_rigid_rows(context)
      call pair_all(model, points)
      do i = 1, size(points, kind=ip)
         call close_adjusted(adjusted(i), points(i))
      end do
      call set_clearances(clearances, model%mesh%n_nodes, context%refinement, points)
      call move_alloc(points, model%points)
      call trim_rows(model%bilateral)
      call check_points_of_pairs(model, context)
      call set_interferences(interferences, context)
      call place_cuts(context)
      call place_paths(context)
      call make_solver_mesh(model)
      call warn_of_overlap(model, context)
      call warn_of_loaded_contact(model, context)
      call warn_of_pairs_twice(model, context)
      if (.not. present(trees)) return
      if (trees%n == 0) call build_trees(levels, context, trees)
   end subroutine build_once

   !> What acts in each step and what it asks for.
   subroutine fill_steps(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i

      do i = 1, size(context%model%steps, kind=ip)
         call open_step(context, i)
         call build_supports(context)
         call hold_axis(context)
         call turn_supports(context)
         call build_loads(context)
         call build_requests(context)
      end do
      call keep_sources(context)
   end subroutine fill_steps

   subroutine take_titles(deck, model)
      type(deck_t), intent(in) :: deck
      type(model_t), intent(inout) :: model
      integer(ip) :: i, k, n

      model%deck_path = deck%path
      model%deck_name = deck_name(deck%path)
      allocate (model%heading(count_lines(deck, 'HEADING')))
      n = 0
      do i = 1, deck%n_cards
         if (keyword_name(deck%cards(i)) /= 'HEADING') cycle
         do k = deck%cards(i)%first_line, deck%cards(i)%first_line + deck%cards(i)%n_lines - 1
            n = n + 1
            model%heading(n)%s = token_text(deck, line_item(deck, deck%lines(k), 1_ip))
         end do
      end do
   end subroutine take_titles

   !> *UNITS.
   subroutine take_units(deck, units)
      type(deck_t), intent(in) :: deck
      type(units_t), intent(inout) :: units
      character(len=*), parameter :: NOT_OF_A_UNIT = '[]{}"''\%@&~_' !! of which scripts of gnuplot make something else
      type(token_t) :: item
      integer(ip) :: i, k

      do i = 1, deck%n_cards
         associate (card => deck%cards(i))
            if (keyword_name(card) /= 'UNITS' .or. card%n_lines == 0) cycle
            if (.not. deck%lines(card%first_line)%ok) cycle
            if (allocated(units%names(1)%s)) call report_error(deck, card%place, 'E-TWICE', '*UNITS is given twice', &
                                                               expected='one *UNITS a deck')
            do k = 1, min(N_UNITS, deck%lines(card%first_line)%n_tokens)
               item = line_item(deck, deck%lines(card%first_line), k)
               units%names(k)%s = token_text(deck, item)
               if (scan(units%names(k)%s, NOT_OF_A_UNIT) > 0) call report_error(deck, item, 'E-NAME', 'no name of a unit', &
                                                                                expected='a name without any of '//NOT_OF_A_UNIT)
               if (len(units%names(k)%s) == 0) deallocate (units%names(k)%s)
            end do
         end associate
      end do
   end subroutine take_units

   subroutine take_parameters(deck, model)
      type(deck_t), intent(in) :: deck
      type(model_t), intent(inout) :: model
      integer(ip) :: i

      allocate (model%parameters(deck%n_parameters))
      do i = 1, deck%n_parameters
         model%parameters(i)%name = deck%parameters(i)%name
         model%parameters(i)%written = token_text(deck, deck%parameters(i)%expression)
         model%parameters(i)%value = deck%parameters(i)%value
         model%parameters(i)%overridden = deck%parameters(i)%overridden
      end do
   end subroutine take_parameters

   !> Nodes, and the node sets that are made with them.
   subroutine build_nodes(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i

      do i = 1, context%deck%n_cards
         select case (keyword_name(context%deck%cards(i)))
         case ('NODE')
            call read_node_card(i, context)
         case ('NGEN', 'NFILL')
            call read_fill_card(i, context)
         case ('NCOPY')
            call read_copy_card(i, context)
         case ('BLOCK')
            call read_block_card(i, context)
         case ('INCLUDE')
            call read_mesh_nodes(i, context)
         case ('NSET')
            call try_set_card(i, context)
         end select
      end do
      call read_lines(context)
   end subroutine build_nodes

   !> The cards of sets that have not been read yet.
   subroutine read_sets(context, keyword)
      type(build_context_t), intent(inout) :: context
      character(len=*), intent(in) :: keyword          !< NSET or ELSET
      integer(ip) :: i

      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == keyword .and. .not. context%card_done(i)) call read_set_card(i, context)
      end do
   end subroutine read_sets

   !> Elements, the element sets, and the node sets that may name them or be of their nodes.
   subroutine build_elements(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i

      do i = 1, context%deck%n_cards
         select case (keyword_name(context%deck%cards(i)))
         case ('ELEMENT')
            if (makes_elements(context%deck, context%deck%cards(i), 'SPRING') .or. &
                makes_elements(context%deck, context%deck%cards(i), 'T3D')) cycle
            call read_element_card(i, context)
         case ('ELGEN')
            call read_elgen_card(i, context)
         case ('ELCOPY')
            call read_copy_card(i, context)
         case ('INCLUDE')
            call read_mesh_elements(i, context)
         case ('BLOCK')
            call place_block_elements(i, context)
         end select
      end do
      call turn_elements(context)
      call read_sets(context, 'ELSET')
      call read_sets(context, 'NSET')
   end subroutine build_elements

   !> The lines in the order of the deck.
   pure subroutine list_observed(deck, lines)
      type(deck_t), intent(in) :: deck                            !< as read
      type(observed_line_t), allocatable, intent(out) :: lines(:) !< not evaluated yet
      type(token_t) :: token
      integer(ip) :: i, k, n

      allocate (lines(count_lines(deck, 'OBSERVE')))
      n = 0
      do i = 1, deck%n_cards
         if (keyword_name(deck%cards(i)) /= 'OBSERVE') cycle
         do k = deck%cards(i)%first_line, deck%cards(i)%first_line + deck%cards(i)%n_lines - 1
            token = line_item(deck, deck%lines(k), 1_ip)
            n = n + 1
            lines(n)%text = token_text(deck, token)
            lines(n)%file = deck%sources(token%source)%name
            lines(n)%line = token%line
            lines(n)%column = token%column
         end do
      end do
   end subroutine list_observed

   !> The motions of all instances and, for people, where their numbers begin. Of a deck without parts there are none.
   subroutine build_instances(context)
      type(build_context_t), intent(inout) :: context !< gets motions, its model instances
      type(card_t) :: card
      integer(ip) :: i, n
      logical :: found

      n = 0
      if (allocated(context%deck%scopes)) n = size(context%deck%scopes, kind=ip) - 1
      allocate (context%model%instances(n), context%motions(0:n))
      do i = 1, n
         associate (scope => context%deck%scopes(i), instance => context%model%instances(i))
            if (.not. scope%ok) cycle
            card = context%deck%cards(scope%card)      ! a line of the translation, and one of the rotation
            associate (deck => context%deck, motion => context%motions(i))
               if (card%n_lines > 0) then
                  if (deck%lines(card%first_line)%ok) call read_shift(deck, deck%lines(card%first_line), motion, found)
               end if
               if (card%n_lines > 1) then
                  if (deck%lines(card%first_line + 1)%ok) call read_rotation(deck, deck%lines(card%first_line + 1), 1.0_wp, &
                                                                             motion, found)
               end if
            end associate
            instance%name = scope%name
            call option_text(context%deck, card, 'PART', instance%part, found)
            instance%first_number = min(scope%shift, huge(scope%shift) - 1) + 1 ! too many are refused
            instance%shift = context%motions(i)%shift
            instance%angle = context%motions(i)%angle
         end associate
      end do
      if (n > 0) call refuse_turned_dofs(context)
   end subroutine build_instances

   !> In a part the axes turn with the instance, but dofs are along those of the scene.
   subroutine refuse_turned_dofs(context)
      type(build_context_t), intent(in) :: context
      integer(ip) :: i

      do i = 1, context%deck%n_cards
         associate (card => context%deck%cards(i))
            if (.not. abs(context%motions(card%scope)%angle) > 0.0_wp) cycle
            if (keyword_name(card) /= 'EQUATION' .and. keyword_name(card) /= 'SPRING') cycle
            call report_error(context%deck, card%place, 'E-PART', '*'//keyword_name(card)//' in a part, of which the instance '// &
                              context%deck%scopes(card%scope)%name//' is turned', &
                              expected='its place in the assembly, where dofs are along x and y', keyword='INSTANCE')
         end associate
      end do
   end subroutine refuse_turned_dofs

end module atrito_build_model
