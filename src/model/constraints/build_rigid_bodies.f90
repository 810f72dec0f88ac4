!> *RIGID BODY: rigid surfaces, those that move with a reference node, and nodes of elements that do.
module atrito_build_rigid_bodies
   use atrito_build_context, only: build_context_t, count_cards
   use atrito_deck, only: card_t, token_t, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_growth, only: resize, number_list_t, add_numbers, numbers_of
   use atrito_id_map, only: add_id, find_id
   use atrito_items, only: has_option, option_text
   use atrito_kinds, only: ip, wp
   use atrito_local_axes, only: has_local_axes
   use atrito_mesh, only: is_revolved
   use atrito_model, only: model_t, rigid_body_name, rigid_body_t, SURFACE_SEGMENTS
   use atrito_references, only: find_elements, find_nodes, find_surface, in_no_element
   use atrito_refined_members, only: add_nodes_between
   use atrito_refinement, only: is_refined
   use atrito_sorting, only: each_once
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: build_rigid_bodies, read_tied_nodes, can_move, is_reference, rigid_body_of, append_rigid_body, find_free_node, &
             make_solver_mesh, carriers_of, ROTATION_DOF, CARRIERS

   integer(ip), parameter :: ROTATION_DOF = 6_ip
   !> Nodes whose displacements give those of any place of a rigid body: itself, and one along each axis.
   integer(ip), parameter :: CARRIERS = 3_ip
   !> Options that name nodes, or elements with them.
   character(len=8), parameter :: NODE_OPTIONS(4) = ['NSET    ', 'PIN NSET', 'TIE NSET', 'ELSET   ']

contains

   !> All *RIGID BODY cards; surfaces are there, and which nodes have elements.
   subroutine build_rigid_bodies(context)
      type(build_context_t), intent(inout) :: context  !< its model gets rigid_bodies
      integer(ip) :: i

      ! with room for the sections' nodes, too
      allocate (context%model%rigid_bodies(count_cards(context%deck, 'RIGID BODY') + count_cards(context%deck, &
                                                                                                 'PRE-TENSION SECTION')))
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == 'RIGID BODY') call read_card(context%deck%cards(i), context)
      end do
   end subroutine build_rigid_bodies

   !> A drawn surface, nodes, or both.
   subroutine read_card(card, context)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      type(token_t) :: place
      character(len=:), allocatable :: name
      integer(ip) :: i, surface
      logical :: found

      surface = 0
      call option_text(context%deck, card, 'ANALYTICAL SURFACE', name, found, place)
      if (found) then
         call find_surface(context, place, surface)
         if (surface > 0) found = context%model%surfaces(surface)%kind == SURFACE_SEGMENTS
         if (.not. found) call report_error(context%deck, place, 'E-SURFACE', 'surface '//name//' is made of element faces', &
                                            expected='a surface of TYPE=SEGMENTS')
         if (surface == 0 .or. .not. found) then
            context%rigid_undetermined = .true.
            return
         end if
         context%model%surfaces(surface)%is_rigid_body = .true.
      else if (.not. any([(has_option(context%deck, card, trim(NODE_OPTIONS(i))), i=1, size(NODE_OPTIONS, kind=ip))])) then
         if (card%ok) call report_error(context%deck, card%place, 'E-OPTION-MISSING', &
                                        '*RIGID BODY has neither a surface nor nodes', &
                                        expected='ANALYTICAL SURFACE=, or REF NODE= and one of NSET=, TIE NSET=, ELSET=')
         return
      end if
      call read_reference()

   contains

      !> REF NODE=: one node of no element, of one surface alone.
      subroutine read_reference()
         type(rigid_body_t) :: body
         type(token_t) :: place
         character(len=*), parameter :: WHAT = 'a node of no element that is the reference of this surface alone'
         character(len=:), allocatable :: wrong
         integer(ip), allocatable :: tied(:)
         logical :: ok

         call read_tied_nodes(card, context, body%name, tied, ok)
         if (.not. (ok .and. card%ok)) return
         if (.not. has_option(context%deck, card, 'REF NODE')) then
            if (allocated(body%name)) call report_error(context%deck, card%place, 'E-OPTION-MISSING', &
                                                        'nodes of a rigid body need REF NODE=, with which they move', &
                                                        expected='*RIGID BODY, REF NODE=number, TIE NSET=name')
            return
         end if
         call find_free_node(card, context, 'REF NODE', WHAT, body%node, place)
         if (body%node == 0) return
         wrong = what_is_wrong(body%node)
         if (len(wrong) > 0) then
            call report_error(context%deck, place, 'E-NODE', wrong, expected=WHAT)
            return
         end if
         body%surface = surface
         body%size = reach_of(context, surface, tied, context%model%mesh%x(:, body%node))
         call append_rigid_body(context, body)
      end subroutine read_reference

      !> Why a node cannot be the reference of a surface; '' where it can.
      function what_is_wrong(node) result(wrong)
         integer(ip), intent(in) :: node
         character(len=:), allocatable :: wrong

         wrong = ''
         associate (others => context%model%rigid_bodies(:context%rigid_bodies%n))
            if (rigid_body_of(context, node) > 0) then
               wrong = 'node '//to_text(context%model%mesh%node_id(node))//' is the reference node of '// &
                       trim(merge('surface', 'set    ', others(rigid_body_of(context, node))%surface > 0))//' '// &
                       rigid_body_name(context%model, rigid_body_of(context, node))
            else if (surface > 0 .and. any(others%surface == surface)) then
               wrong = 'surface '//context%model%surfaces(surface)%name//' has the reference node ' &
                       //to_text(context%model%mesh%node_id(others(findloc(others%surface, surface, dim=1))%node))
            end if
         end associate
      end function what_is_wrong
   end subroutine read_card

   !> The one node that an option names; it belongs to no element.
   subroutine find_free_node(card, context, option, expected, node, place)
      type(card_t), intent(in) :: card                 !< whose option names it
      type(build_context_t), intent(in) :: context     !< its mesh and sets are searched
      character(len=*), intent(in) :: option, expected !< what node it should be, for messages
      integer(ip), intent(out) :: node                 !< place; 0: there is none, which is reported
      type(token_t), intent(out) :: place              !< of the option's value
      character(len=:), allocatable :: name, wrong
      integer(ip), allocatable :: nodes(:)
      logical :: ok

      node = 0
      call option_text(context%deck, card, option, name, ok, place)
      if (ok) call find_nodes(context, place, nodes, ok)
      if (.not. ok) return
      wrong = ''
      if (size(nodes) /= 1) then
         wrong = 'set '//name//' has '//to_text(size(nodes, kind=ip))//' nodes'
      else if (.not. all(in_no_element(context, nodes))) then
         wrong = 'node '//to_text(context%model%mesh%node_id(nodes(1)))//' belongs to an element'
      else
         node = nodes(1)
      end if
      if (node == 0) call report_error(context%deck, place, 'E-NODE', wrong, expected=expected)
   end subroutine find_free_node

   !> The nodes of elements that a card names, each once. The name is that of the first option; not allocated: there is none.
   subroutine read_tied_nodes(card, context, name, nodes, ok)
      type(card_t), intent(in) :: card                   !< *RIGID BODY
      type(build_context_t), intent(in) :: context       !< its mesh, sets and refinement are read
      character(len=:), allocatable, intent(out) :: name !< of a set, or the number of a node
      integer(ip), allocatable, intent(out) :: nodes(:)  !< places, rising
      logical, intent(out) :: ok                         !< no error; without an option there are no nodes
      character(len=:), allocatable :: set
      integer(ip), allocatable :: members(:)
      type(number_list_t) :: found_nodes
      type(token_t) :: place
      logical :: found
      integer(ip) :: i, e

      ok = .true.
      allocate (nodes(0))
      do i = 1, size(NODE_OPTIONS, kind=ip)
         call option_text(context%deck, card, trim(NODE_OPTIONS(i)), set, found, place)
         if (.not. found .or. .not. ok) cycle
         if (.not. allocated(name)) name = set
         if (NODE_OPTIONS(i) == 'ELSET') then
            call find_elements(context, place, members, ok)
            do e = 1, size(members, kind=ip)
               associate (corners => context%model%mesh%nodes(:, members(e)))
                  call add_numbers(found_nodes, pack(corners, corners > 0))
               end associate
            end do
         else
            call find_nodes(context, place, members, ok)
            call add_numbers(found_nodes, members)
         end if
      end do
      nodes = each_once(numbers_of(found_nodes))
      nodes = pack(nodes,.not. in_no_element(context, nodes))
      if (is_refined(context%refinement)) call add_nodes_between(context%model%mesh, context%refinement, nodes)
      if (.not. ok .or. .not. allocated(name) .or. size(nodes) > 0) return
      ok = .false.
      call report_error(context%deck, card%place, 'E-NODE', 'no node of '//name//' belongs to an element', &
                        expected='nodes of elements')
   end subroutine read_tied_nodes

   !> Largest distance of a surface and of nodes from a place: by this the nodes that carry its motion stand apart.
   pure real(wp) function reach_of(context, surface, nodes, x) result(reach)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: surface, nodes(:)     !< surface 0: none
      real(wp), intent(in) :: x(2)
      integer(ip) :: i

      reach = 0.0_wp
      if (surface > 0) then
         associate (points => context%model%surfaces(surface)%points)
            reach = maxval([(norm2(points(:, i) - x), i=1, size(points, 2, kind=ip))])
         end associate
      end if
      associate (mesh => context%model%mesh)
         if (size(nodes) > 0) reach = max(reach, maxval([(norm2(mesh%x(:, nodes(i)) - x), i=1, size(nodes, kind=ip))]))
         if (.not. reach > 0.0_wp) reach = norm2(maxval(mesh%x(:, :mesh%n_nodes), dim=2) - minval(mesh%x(:, :mesh%n_nodes), dim=2))
      end associate
   end function reach_of

   !> Which nodes are reference nodes.
   pure elemental logical function is_reference(context, node)
      type(build_context_t), intent(in) :: context     !< its rigid bodies are read
      integer(ip), intent(in) :: node                  !< place in the mesh

      is_reference = .false.
      if (context%rigid_bodies%n > 0) is_reference = find_id(context%rigid_bodies, node) > 0
   end function is_reference

   !> The rigid body of a reference node; 0: it is none.
   pure integer(ip) function rigid_body_of(context, node) result(body)
      type(build_context_t), intent(in) :: context     !< its rigid bodies are read
      integer(ip), intent(in) :: node                  !< place in the mesh

      body = find_id(context%rigid_bodies, node)
   end function rigid_body_of

   !> Whether a reference node can be displaced or loaded there: not along a radius nor about the axis of bodies of revolution, nor
   !> along axes of its own where it moves along one axis alone.
   logical function can_move(context, place, node, dof, value) result(can)
      type(build_context_t), intent(in) :: context  !< its rigid bodies and axes are read
      type(token_t), intent(in) :: place            !< of the line
      integer(ip), intent(in) :: node, dof          !< place of a reference node; 1, 2 or 6
      real(wp), intent(in) :: value                 !< of the dof; 0 is always possible but along local axes
      logical :: is_section

      is_section = context%model%rigid_bodies(rigid_body_of(context, node))%is_section
      can = .not. (has_local_axes(context, node) .and. (is_revolved(context%model%mesh) .or. is_section))
      if (.not. can) then
         call report_error(context%deck, place, 'E-NODE', 'reference node '//to_text(context%model%mesh%node_id(node))// &
                           ' moves along one axis alone, and has local axes', expected='a node without *TRANSFORM')
      else if (is_section) then
         can = dof == 1 .or. abs(value) <= 0.0_wp
         if (.not. can) call report_error(context%deck, place, 'E-DOF', 'the node of a pre-tension section has no dof '// &
                                          to_text(dof), expected='dof 1: what the sides approach by, or the force')
      else if (is_revolved(context%model%mesh) .and. dof /= 2 .and. abs(value) > 0.0_wp) then
         can = .false.
         call report_error(context%deck, place, 'E-DOF', 'a rigid surface round an axis moves along it alone, not by dof '// &
                           to_text(dof), expected='dof 2 of a reference node beside CAX elements')
      end if
   end function can_move

   !> Appends a rigid body; the list has room for all.
   pure subroutine append_rigid_body(context, body)
      type(build_context_t), intent(inout) :: context  !< its model has room for the body
      type(rigid_body_t), intent(in) :: body           !< its node is not yet one
      logical :: known

      context%model%rigid_bodies(context%rigid_bodies%n + 1) = body
      call add_id(context%rigid_bodies, body%node, context%rigid_bodies%n + 1, known)
   end subroutine append_rigid_body

   !> The nodes that carry the motion of a rigid body: at its reference node, and at its size from that along 1 and along 2.
   pure function carriers_of(model, i) result(nodes)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i                     !< of the rigid bodies
      integer(ip) :: nodes(CARRIERS)

      nodes = model%mesh%n_nodes + CARRIERS*(i - 1) + [1_ip, 2_ip, 3_ip]
   end function carriers_of

   !> The mesh with three more nodes for each rigid surface that moves, of which the displacement of any place of it is the sum by
   !> its barycentric coordinates: so a contact point sees a rigid master as it sees a face of elements.
   pure subroutine make_solver_mesh(model)
      type(model_t), intent(inout) :: model
      integer(ip) :: i, nodes(CARRIERS), before

      if (size(model%rigid_bodies) == 0) return
      model%solver_mesh = model%mesh
      before = model%mesh%n_nodes
      associate (mesh => model%solver_mesh)
         mesh%n_nodes = before + CARRIERS*size(model%rigid_bodies, kind=ip)
         call resize(mesh%x, before, mesh%n_nodes)
         call resize(mesh%node_id, before, mesh%n_nodes)
         do i = 1, size(model%rigid_bodies, kind=ip)
            nodes = carriers_of(model, i)
            associate (body => model%rigid_bodies(i))
               mesh%x(:, nodes) = spread(mesh%x(:, body%node), 2, CARRIERS)
               mesh%x(1, nodes(2)) = mesh%x(1, nodes(2)) + body%size
               mesh%x(2, nodes(3)) = mesh%x(2, nodes(3)) + body%size
               mesh%node_id(nodes) = mesh%node_id(body%node)
            end associate
         end do
      end associate
   end subroutine make_solver_mesh

end module atrito_build_rigid_bodies
