!> Dofs in bilateral rows: displacements of nodes of elements, and of reference nodes the displacements of those that carry their
!> motion; the rows of nodes of elements that belong to rigid bodies.
!>
!> Supports along local axes: what is prescribed along x and y in each step, and bilateral rows along other directions.
module atrito_row_dofs
   use atrito_bilateral_rows, only: add_row, ROW_RIGID, begin_rows, ROW_SUPPORT
   use atrito_build_context, only: build_context_t, has_lost_elements, ids_text
   use atrito_build_rigid_bodies, only: carriers_of, is_reference, read_tied_nodes, rigid_body_of, CARRIERS, ROTATION_DOF
   use atrito_deck, only: token_t, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_items, only: option_text
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: condition_t, condition_list_t, add_condition, add_part, nodal_values_of
   use atrito_local_axes, only: dof_direction, has_local_axes
   use atrito_mesh, only: is_revolved
   use atrito_model, only: model_t, nodal_values_t
   use atrito_propagation, only: is_inherited
   use atrito_references, only: find_nodes, in_no_element
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: add_rigid_rows, row_weight, check_row_nodes, check_row_dof, has_no_unknowns, row_node, row_terms, arm_of, &
             TERMS_A_DOF, WHAT_DOF, AT_REFERENCE, turn_supports

   !> A rotation is a difference of two displacements.
   integer(ip), parameter :: TERMS_A_DOF = 2
   character(len=*), parameter :: WHAT_DOF = 'degree of freedom: 1 (x) or 2 (y)', &
                                  AT_REFERENCE = '; of the reference node of a *RIGID BODY also 6'

contains

   !> The nodes of a list that belong to no element and carry no rigid surface.
   pure function has_no_unknowns(context, nodes) result(loose)
      type(build_context_t), intent(in) :: context     !< which nodes have elements, and rigid bodies
      integer(ip), intent(in) :: nodes(:)              !< places
      logical :: loose(size(nodes))

      loose = in_no_element(context, nodes) .and. .not. is_reference(context, nodes)
   end function has_no_unknowns

   !> ok is false, and an error reported, where some nodes have no unknowns.
   subroutine check_row_nodes(context, place, nodes, expected, ok)
      type(build_context_t), intent(in) :: context      !< which nodes have elements, and rigid bodies
      type(token_t), intent(in) :: place                !< at which the error is told
      integer(ip), intent(in) :: nodes(:)               !< places in the mesh
      character(len=*), intent(in) :: expected !< for the message: what should be there
      logical, intent(out) :: ok                        !< all have unknowns

      ok = .not. any(has_no_unknowns(context, nodes))
      if (ok .or. has_lost_elements(context)) return
      call report_error(context%deck, place, 'E-NODE', 'node '//ids_text(pack(context%model%mesh%node_id(nodes), &
                                                                              has_no_unknowns(context, nodes)))// &
                        ' belongs to no element', expected=expected)
   end subroutine check_row_nodes

   !> ok is false, and an error reported, where some nodes do not have a dof.
   subroutine check_row_dof(context, place, nodes, dof, ok)
      type(build_context_t), intent(in) :: context     !< its rigid bodies are read
      type(token_t), intent(in) :: place               !< of the dof
      integer(ip), intent(in) :: nodes(:), dof         !< places in the mesh; as the deck has it
      logical, intent(out) :: ok                       !< all have the dof
      character(len=:), allocatable :: what
      integer(ip) :: i

      ok = dof == 1 .or. dof == 2 .or. (dof == ROTATION_DOF .and. all(is_reference(context, nodes)))
      if (.not. ok) then
         call report_error(context%deck, place, 'E-DOF', 'dof '//to_text(dof)//' does not exist in the plane', expected=WHAT_DOF// &
                           repeat(AT_REFERENCE, merge(1, 0, dof == ROTATION_DOF)))
         return
      end if
      if (.not. any(is_reference(context, nodes))) return
      what = ''
      do i = 1, size(nodes, kind=ip)
         if (.not. is_reference(context, nodes(i)) .or. len(what) > 0) cycle
         associate (body => context%model%rigid_bodies(rigid_body_of(context, nodes(i))))
            if (body%is_section) then
               if (dof /= 1) what = 'the node of a pre-tension section has dof 1 alone, not '
            else if (is_revolved(context%model%mesh) .and. dof /= 2) then
               what = 'a rigid surface round an axis moves along it alone, not by dof '
            end if
         end associate
      end do
      ok = len(what) == 0
      if (.not. ok) call report_error(context%deck, place, 'E-DOF', what//to_text(dof), expected='a dof by which it moves')
   end subroutine check_row_dof

   !> The node of the solver's mesh whose displacement is that of a node: of a reference node the first of those that carry it.
   pure integer(ip) function row_node(context, node) result(moves)
      type(build_context_t), intent(in) :: context     !< its rigid bodies are read
      integer(ip), intent(in) :: node                  !< place in the mesh
      integer(ip) :: carriers(3)

      moves = node
      if (.not. is_reference(context, node)) return
      carriers = carriers_of(context%model, rigid_body_of(context, node))
      moves = carriers(1)
   end function row_node

   !> What a dof is in a row: a displacement along its direction, or the rotation of a reference node times an arm, which is the
   !> difference of what the first two of its nodes move by along 2: they lie the size of the surface apart along 1.
   pure subroutine row_terms(context, node, dof, arm, nodes, vectors)
      type(build_context_t), intent(in) :: context     !< its axes and rigid bodies are read
      integer(ip), intent(in) :: node, dof             !< place in the mesh; 1, 2 or 6
      real(wp), intent(in) :: arm                      !< that a rotation is multiplied by [L]
      integer(ip), intent(out) :: nodes(TERMS_A_DOF)   !< of the solver's mesh
      real(wp), intent(out) :: vectors(2, TERMS_A_DOF) !< dof, or arm times rotation: sum of vectors . u(nodes) [-]
      integer(ip) :: carriers(3)

      nodes = row_node(context, node)
      vectors = 0.0_wp
      if (dof /= ROTATION_DOF) then
         vectors(:, 1) = dof_direction(context, node, dof)
         return
      end if
      carriers = carriers_of(context%model, rigid_body_of(context, node))
      nodes = carriers(:TERMS_A_DOF)
      vectors(2, :) = [-arm, arm]/arm_of(context, node)
   end subroutine row_terms

   !> The size of the surface of a reference node [L].
   pure real(wp) function arm_of(context, node) result(arm)
      type(build_context_t), intent(in) :: context     !< its rigid bodies are read
      integer(ip), intent(in) :: node                  !< place of a reference node

      arm = context%model%rigid_bodies(rigid_body_of(context, node))%size
   end function arm_of

   !> What forces of rows are divided by where several may share a load [L^2].
   pure real(wp) function row_weight(model) result(weight)
      type(model_t), intent(in) :: model         !< its mesh and sections are read

      weight = 0.0_wp
      associate (x => model%mesh%x(:, :model%mesh%n_nodes))
         if (size(x) > 0) weight = norm2(maxval(x, dim=2) - minval(x, dim=2))
      end associate
      if (.not. weight > 0.0_wp) weight = 1.0_wp
      if (size(model%sections) > 0) weight = weight*model%sections(1)%thickness
      if (allocated(model%mesh%thickness)) weight = weight*maxval(model%mesh%thickness)
   end function row_weight

   !> The rows by which nodes of elements move as their rigid bodies do; no nodes are made any more, and all are where they stay.
   subroutine add_rigid_rows(context)
      type(build_context_t), intent(inout) :: context  !< its model gets bilateral rows
      type(token_t) :: place
      character(len=:), allocatable :: name
      integer(ip), allocatable :: nodes(:), reference(:)
      real(wp) :: weight
      integer(ip) :: i
      logical :: ok

      weight = row_weight(context%model)
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) /= 'RIGID BODY') cycle
         call read_tied_nodes(context%deck%cards(i), context, name, nodes, ok)
         if (.not. allocated(name)) cycle
         call option_text(context%deck, context%deck%cards(i), 'REF NODE', name, ok, place)
         call find_nodes(context, place, reference, ok)
         call tie_nodes(context, rigid_body_of(context, reference(1)), nodes, weight)
      end do
   end subroutine add_rigid_rows

   !> u = sum N_i u_i along x and y, with the barycentric coordinates N_i of a node in the triangle of those that carry the motion.
   subroutine tie_nodes(context, b, nodes, weight)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: b                     !< of the rigid bodies
      integer(ip), intent(in) :: nodes(:)
      real(wp), intent(in) :: weight                   !< of the rows [L^2]
      integer(ip) :: places(CARRIERS), i, axis, group
      real(wp) :: arm(2), part(CARRIERS + 1), vectors(2, CARRIERS + 1)

      places = carriers_of(context%model, b)
      group = context%model%bilateral%n_groups + 1
      do i = 1, size(nodes, kind=ip)
         associate (body => context%model%rigid_bodies(b), x => context%model%mesh%x)
            arm = (x(:, nodes(i)) - x(:, body%node))/body%size
         end associate
         part = [1.0_wp, -(1 - arm(1) - arm(2)), -arm(1), -arm(2)]
         do axis = 1, 2
            vectors = 0.0_wp
            vectors(axis, :) = part
            call add_row([nodes(i), places], vectors, 0.0_wp, 0.0_wp, weight, [ROW_RIGID, group, b], context%model%bilateral)
         end do
      end do
   end subroutine tie_nodes

   !> Prescribed displacements of a step along local axes e1 and e2 of a node.
   !>
   !> Where an axis is one of the scene a component is prescribed. Else, where both are prescribed, the displacement is
   !> u = u1 e1 + u2 e2, whose components along x and y are prescribed; a single one, e . u = value, is a bilateral row, which holds
   !> in all steps.
   subroutine turn_supports(context)
      type(build_context_t), intent(inout) :: context  !< its open step gets prescribed; rows, where inclined
      type(condition_list_t) :: inclined

      if (context%open%number == 1) call begin_rows(context%model%bilateral)
      call turn_list(.false., context%model%steps(context%open%number)%prescribed)
      call turn_list(.true., context%model%steps(context%open%number)%rigid_prescribed)
      if (allocated(context%axes)) call keep_inclined()

   contains

      !> The supports along x and y; rotations stay, and what is neither is added to the inclined ones.
      subroutine turn_list(of_references, turned)
         logical, intent(in) :: of_references             !< those of reference nodes, or those of all others
         type(nodal_values_t), intent(out) :: turned
         type(condition_list_t) :: along_axes
         integer(ip) :: i, other, axis
         real(wp) :: direction(2)

         do i = 1, context%open%supports%n
            associate (support => context%open%supports%list(i))
               if (is_reference(context, support%place) .neqv. of_references) cycle
               if (support%dof == ROTATION_DOF .or. .not. has_local_axes(context, support%place)) then
                  call add_condition(along_axes, support)
                  cycle
               end if
               direction = dof_direction(context, support%place, support%dof)
               other = context%dof_entry(3 - support%dof, support%place)
               if (any(direction == 0.0_wp)) then
                  axis = merge(2_ip, 1_ip, direction(1) == 0.0_wp)
                  call add_part(along_axes, support, axis, direction(axis))
               else if (other > 0) then
                  ! once, by the first of the two
                  if (i < other) call add_both(context, support, context%open%supports%list(other), along_axes)
               else
                  call add_condition(inclined, support)
               end if
            end associate
         end do
         turned = nodal_values_of(along_axes)
      end subroutine turn_list

      !> Single displacements along directions that are no axis: rows, the same in all steps.
      subroutine keep_inclined()
         real(wp) :: weight
         integer(ip) :: i

         if (context%open%number > 1) then
            call check_inclined()
            return
         end if
         weight = row_weight(context%model)
         do i = 1, inclined%n
            associate (support => inclined%list(i))
               if (support%amplitude > 0) call refuse_inclined(context, support%place, support%dof, &
                                                               'an amplitude of a displacement along an inclined axis')
               call add_row([row_node(context, support%place)], &
                            reshape(dof_direction(context, support%place, support%dof), [2, 1]), support%value(1), 0.0_wp, &
                            weight, [ROW_SUPPORT, 1_ip, support%dof], context%model%bilateral)
            end associate
         end do
         context%model%inclined = nodal_values_of(inclined)
      end subroutine keep_inclined

      !> What is along inclined axes in this step is so in the first.
      subroutine check_inclined()
         character(len=*), parameter :: WHAT = 'a displacement along an inclined axis that changes after the first step'
         integer(ip) :: i

         associate (first => context%model%inclined)
            do i = 1, inclined%n
               associate (support => inclined%list(i))
                  if (i <= first%n) then
                     if (support%place == first%node(i) .and. support%dof == first%dof(i) &
                         .and. support%value(1) == first%value(i) .and. support%amplitude == 0) cycle
                  end if
                  call refuse_inclined(context, support%place, support%dof, WHAT)
                  return
               end associate
            end do
            if (inclined%n < first%n) call refuse_inclined(context, first%node(inclined%n + 1), first%dof(inclined%n + 1), WHAT)
         end associate
      end subroutine check_inclined
   end subroutine turn_supports

   !> Both displacements of a node.
   subroutine add_both(context, first, other, turned)
      type(build_context_t), intent(in) :: context
      type(condition_t), intent(in) :: first, other
      type(condition_list_t), intent(inout) :: turned
      type(condition_t) :: along_axis
      real(wp) :: along(2), across(2)
      integer(ip) :: axis

      along = dof_direction(context, first%place, first%dof)
      across = dof_direction(context, other%place, other%dof)
      if (first%amplitude /= other%amplitude) call refuse_inclined(context, first%place, first%dof, &
                                                                   'two displacements along local axes with different amplitudes')
      along_axis = first
      do axis = 1, 2
         along_axis%dof = axis
         along_axis%value = first%value*along(axis) + other%value*across(axis)
         along_axis%from = first%from*along(axis) + other%from*across(axis)
         call add_condition(turned, along_axis)
      end do
   end subroutine add_both

   !> At the line that gives a displacement; at the *STEP where there is none.
   subroutine refuse_inclined(context, node, dof, what)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: node, dof
      character(len=*), intent(in) :: what
      type(token_t) :: place
      integer(ip) :: c, entry
      logical :: is_given

      entry = context%dof_entry(dof, node)
      is_given = .false.
      if (entry > 0) then
         place = context%deck%tokens(context%deck%lines(context%open%supports%list(entry)%line)%first_token)
         is_given = .not. is_inherited(context, context%open%supports%list(entry))
      end if
      do c = context%open%first_card, context%open%last_card
         if (is_given .or. context%deck%cards(c)%step /= context%open%number) cycle
         if (keyword_name(context%deck%cards(c)) == 'STEP') place = context%deck%cards(c)%place
      end do
      call report_error(context%deck, place, 'E-NOT-BUILT', what//', of node '// &
                        to_text(context%model%mesh%node_id(node))//', is not built yet', &
                        expected='the same value through all steps, without an amplitude, or both dofs of the node', &
                        keyword='TRANSFORM')
   end subroutine refuse_inclined

end module atrito_row_dofs
