!> Checks of the finished mesh: shapes, sections, loose nodes, materials in use.
module atrito_check_mesh
   use atrito_check_shapes, only: check_shapes
   use atrito_diagnostics, only: report_error, report_warning, report_note, report_deck_error
   use atrito_build_context, only: build_context_t, place_token, ids_text, has_errors
   use atrito_element_table, only: SHAPES, DEGREE_OF, can_average
   use atrito_id_map, only: find_id
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: mesh_t, side_between, side_count, face_end, middle_node
   use atrito_model, only: model_t, FORMULATION_STANDARD, FORMULATION_BBAR
   use atrito_growth, only: number_list_t, add_number, numbers_of
   use atrito_plane_state, only: STATES, IS_REDUCED
   use atrito_refinement, only: is_refined
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: check_mesh

   !> From this ratio on fully integrated elements lock in plane strain: those with three or four nodes altogether, those with more
   !> in their pressures.
   real(wp), parameter :: LOCKING_RATIO = 0.49_wp
   !> What elements do there: nothing, six and more nodes, four nodes of FORMULATION=STANDARD, three nodes; the worst is reported.
   integer(ip), parameter :: FITS = 0, OSCILLATES = 1, LOCKS = 2, TRIANGLE_LOCKS = 3

contains

   !> Reports what is wrong with the mesh of a model whose cards have all been read.
   subroutine check_mesh(model, context)
      type(model_t), intent(in) :: model               !< cards all read; mesh as it is solved
      type(build_context_t), intent(in) :: context     !< places in the deck, for messages
      integer(ip), allocatable :: found(:)
      integer(ip) :: i

      associate (mesh => model%mesh, deck => context%deck, around => context%around%first)
         if (mesh%n_elements == 0) then
            if (.not. has_errors()) call report_deck_error(deck, 'E-EMPTY', 'the deck has no elements', &
                                                           expected='*ELEMENT or *BLOCK', keyword='BLOCK')
            return
         end if
         call check_shapes(mesh, context)
         if (.not. is_refined(context%refinement)) call check_edges(mesh, context)
         if (.not. (context%sections_undetermined .and. has_errors())) then
            found = pack([(i, i=1, mesh%n_elements)], model%section_of == 0)
            if (size(found) > 0) call report_error(deck, place_token(deck, context%elements%place(found(1))), 'E-SECTION', &
                                                   'no *SOLID SECTION for element '//ids_text(mesh%element_id(found)), &
                                                   expected='one *SOLID SECTION for each element', keyword='SOLID SECTION')
         end if
         call check_materials(model, context)
         if (has_errors()) return
         call check_neighbours(mesh, context)
         call note_formulations(model, context)
         found = pack([(i, i=1, mesh%n_nodes)], around(2:mesh%n_nodes + 1) == around(:mesh%n_nodes))
         found = pack(found, [(find_id(context%rigid_bodies, found(i)) == 0, i=1, size(found, kind=ip))])
         if (size(found) > 0) call report_note(deck, place_token(deck, context%nodes%place(found(1))), 'N-NODE', 'node '// &
                                               ids_text(mesh%node_id(found))//' belongs to no element and has no unknowns', &
                                               keyword='NODE')
      end associate
   end subroutine check_mesh

   !> Materials in use have their constants, which fit the elements.
   subroutine check_materials(model, context)
      type(model_t), intent(in) :: model
      type(build_context_t), intent(in) :: context
      integer(ip), dimension(size(model%materials)) :: state, response
      integer(ip) :: e, i

      state = 0                                        ! of elements that mu = 1/2 makes incompressible; 0: none
      response = FITS                                   ! the worst of such elements
      do e = 1, model%mesh%n_elements
         if (model%section_of(e) <= 0) cycle
         associate (section => model%sections(model%section_of(e)))
            if (STATES(model%mesh%state(e))%is_thin) cycle
            i = section%material
            state(i) = model%mesh%state(e)
            if (IS_REDUCED(state(i))) cycle
            if (SHAPES(model%mesh%shape(e))%degree > 1) then
               response(i) = max(response(i), OSCILLATES)
            else if (model%mesh%shape(e) == 3) then
               response(i) = max(response(i), TRIANGLE_LOCKS)
            else if (section%formulation == FORMULATION_STANDARD) then
               response(i) = max(response(i), LOCKS)
            end if
         end associate
      end do
      do i = 1, size(model%materials, kind=ip)
         if (context%elastic_given(i)) then
            if (state(i) > 0 .and. .not. context%elastic_invalid(i)) call check_strained(context, model%materials(i)%poisson, i, &
                                                                                         state(i), response(i))
         else if (.not. (context%elastic_invalid(i) .and. has_errors())) then
            call report_error(context%deck, context%materials(i), 'E-MATERIAL', &
                              'material '//model%materials(i)%name//' has no *ELASTIC', &
                              expected='*ELASTIC below *MATERIAL: E [F/L^2], mu [-]', keyword='ELASTIC')
         end if
      end do
   end subroutine check_materials

   !> Poisson's ratio of a material that cannot give way across the plane.
   subroutine check_strained(context, poisson, i, state, response)
      type(build_context_t), intent(in) :: context
      real(wp), intent(in) :: poisson
      integer(ip), intent(in) :: i                     !< the material
      integer(ip), intent(in) :: state                 !< of its elements, place in STATES
      integer(ip), intent(in) :: response               !< that they have where it is nearly incompressible
      character(len=:), allocatable :: there, what, instead

      there = ' in '//trim(STATES(state)%name)
      if (STATES(state)%has_hoop) there = there//' elements'
      if (poisson >= 0.5_wp) then
         call report_error(context%deck, context%poisson(i), 'E-VALUE', 'mu = '//to_text(poisson, 15)//there, &
                           expected="Poisson's ratio mu, plane strain -1 < mu < 0.5, plane stress -1 < mu <= 0.5 [-]", &
                           keyword='ELASTIC')
      end if
      if (poisson >= 0.5_wp .or. poisson < LOCKING_RATIO .or. response == FITS) return
      instead = 'elements with four nodes and FORMULATION=BBAR'
      select case (response)
      case (TRIANGLE_LOCKS)
         what = ' triangles with three nodes are much too stiff'//there
         instead = instead//' of *SOLID SECTION'
      case (LOCKS)
         what = ' fully integrated Q1 elements are much too stiff'//there
         instead = 'FORMULATION=BBAR of *SOLID SECTION'
      case default
         what = there//' the pressures of elements with six, eight or nine nodes oscillate, in contact too'
      end select
      call report_warning(context%deck, context%poisson(i), 'W-LOCKING', 'nearly incompressible:'//what, &
                          expected=instead//', or mu < 0.49 [-]', keyword='ELASTIC')
   end subroutine check_strained

   !> BBAR is for four nodes where nothing gives way across the plane; elsewhere it changes nothing, reported once a section.
   subroutine note_formulations(model, context)
      type(model_t), intent(in) :: model
      type(build_context_t), intent(in) :: context
      type(number_list_t), allocatable :: elements(:)  ! of each section, those that it is not for
      integer(ip) :: i, e

      allocate (elements(size(model%sections)))
      do e = 1, model%mesh%n_elements
         i = model%section_of(e)
         if (model%sections(i)%formulation /= FORMULATION_BBAR) cycle
         if (can_average(model%mesh%shape(e), model%mesh%state(e))) cycle
         call add_number(elements(i), model%mesh%element_id(e))
      end do
      do i = 1, size(model%sections, kind=ip)
         if (elements(i)%n == 0) cycle
         call report_note(context%deck, context%sections(i), 'N-FORMULATION', 'FORMULATION=BBAR changes nothing in element '// &
                          ids_text(numbers_of(elements(i)))//' of set '//model%sections(i)%elset// &
                          ': it is for four nodes in plane strain or axisymmetric', expected='CPE4 or CAX4 elements', &
                          keyword='SOLID SECTION')
      end do
   end subroutine note_formulations

   !> Elements that have an edge in common have all nodes of it in common: four-node beside nine-node elements, or large ones of
   !> nine nodes beside small ones, would leave a crack between common corners that nobody sees in a list of nodes. Reports, in one
   !> message, the neighbours of an element of the second degree that have the corners of its edge and not its middle, or its
   !> middle as something else than the middle of the same edge; of two such elements the one that comes later.
   subroutine check_edges(mesh, context)
      type(mesh_t), intent(in) :: mesh
      type(build_context_t), intent(in) :: context
      logical, allocatable :: misfit(:)
      integer(ip), allocatable :: found(:)
      integer(ip) :: e, face, k, other, middle

      if (all(DEGREE_OF(mesh%shape(:mesh%n_elements)) == 1)) return
      allocate (misfit(mesh%n_elements), source=.false.)
      do e = 1, mesh%n_elements
         if (DEGREE_OF(mesh%shape(e)) == 1) cycle
         do face = 1, side_count(mesh, e)
            associate (a => mesh%nodes(face, e), b => mesh%nodes(face_end(mesh, e, face), e), first => context%around%first)
               middle = middle_node(mesh, e, face)
               do k = first(middle), first(middle + 1) - 1
                  other = context%around%list(k)
                  if (other == e .or. side_between(mesh, other, b, a, middle) > 0) cycle
                  if (side_between(mesh, other, a, b, middle) > 0) cycle ! it lies over this one
                  misfit(max(e, other)) = .true.
               end do
               do k = first(a), first(a + 1) - 1
                  other = context%around%list(k)
                  if (side_between(mesh, other, b, a) == 0 .or. side_between(mesh, other, b, a, middle) > 0) cycle
                  misfit(max(e, other)) = .true.
               end do
            end associate
         end do
      end do
      found = pack([(e, e=1, mesh%n_elements)], misfit)
      if (size(found) == 0) return
      call report_error(context%deck, place_token(context%deck, context%elements%place(found(1))), 'E-EDGE', 'element '// &
                        ids_text(mesh%element_id(found))//' and a neighbour share nodes of an edge, but not all of them', &
                        expected='elements of one order and size on both sides of an edge (CPE3 and CPE4, or CPE6, CPE8 and '// &
                        'CPE9; so CPS), or no common nodes and a *CONTACT PAIR', keyword='ELEMENT')
   end subroutine check_edges

   !> Elements round a node stand side by side: each goes on from it to a corner, from which the next one comes. Reports those that
   !> go on to the same corner, so that one lies over the other, and nodes at which several rows of them begin, which share nothing
   !> else. Either leaves nodes where the corners gone on to are others than those come from; their squares do not add up there.
   subroutine check_neighbours(mesh, context)
      type(mesh_t), intent(in) :: mesh
      type(build_context_t), intent(in) :: context
      logical :: lies_over(mesh%n_elements), is_hinge(mesh%n_nodes)
      integer(lp) :: squares(mesh%n_nodes)             ! of the corners gone on to less those come from
      integer(ip), allocatable :: found(:)
      integer(ip) :: e, k, n, side

      squares = 0
      do e = 1, mesh%n_elements
         n = side_count(mesh, e)
         do side = 1, n
            associate (from => mesh%nodes(side, e), next => mesh%nodes(merge(1_ip, side + 1, side == n), e))
               squares(from) = squares(from) + int(next, lp)**2
               squares(next) = squares(next) - int(from, lp)**2
            end associate
         end do
      end do
      lies_over = .false.
      is_hinge = .false.
      do k = 1, mesh%n_nodes
         if (squares(k) /= 0) call look_round(k, context%around%list(context%around%first(k):context%around%first(k + 1) - 1))
      end do
      found = pack([(k, k=1, mesh%n_elements)], lies_over)
      if (size(found) > 0) then
         call report_warning(context%deck, place_token(context%deck, context%elements%place(found(1))), 'W-LAYERS', 'element '// &
                             ids_text(mesh%element_id(found))//' lies over another one, which goes along the same edge in the '// &
                             'same direction: their stiffnesses, weights and loads add up', &
                             expected='elements beside each other', keyword='ELEMENT')
         return
      end if
      found = pack([(k, k=1, mesh%n_nodes)], is_hinge)
      if (size(found) == 0) return
      call report_warning(context%deck, place_token(context%deck, context%nodes%place(found(1))), 'W-HINGE', &
                          'node '//ids_text(mesh%node_id(found))//' is all that elements on its sides have in common: they '// &
                          'hang together there as by a hinge', expected='elements that share edges; a node for each body, '// &
                          'and a *TIE or a *CONTACT PAIR, where two bodies touch', keyword='ELEMENT')

   contains

      !> The corners behind and before a node in each element round it.
      subroutine look_round(node, around)
         integer(ip), intent(in) :: node, around(:)
         integer(ip) :: to(size(around)), from(size(around)) ! 0: the node is in the middle of a side
         integer(ip) :: i, side

         to = 0
         from = 0
         do i = 1, size(around, kind=ip)
            do side = 1, side_count(mesh, around(i))
               associate (a => mesh%nodes(side, around(i)), b => mesh%nodes(face_end(mesh, around(i), side), around(i)))
                  if (a == node) to(i) = b
                  if (b == node) from(i) = a
               end associate
            end do
            if (to(i) > 0 .and. any(to(:i - 1) == to(i))) lies_over(around(i)) = .true.
         end do
         is_hinge(node) = count([(to(i) > 0 .and. all(from /= to(i)), i=1, size(to, kind=ip))]) > 1
      end subroutine look_round

   end subroutine check_neighbours

end module atrito_check_mesh
