!> Dofs in bilateral rows: displacements of nodes of elements, and of reference nodes the displacements of those that carry their
!> motion; the rows of nodes of elements that belong to rigid bodies.
module atrito_row_dofs
   use atrito_bilateral_rows, only: add_row, ROW_RIGID
   use atrito_build_context, only: build_context_t, has_lost_elements, ids_text
   use atrito_build_rigid_bodies, only: carriers_of, is_reference, read_tied_nodes, rigid_body_of, CARRIERS, ROTATION_DOF
   use atrito_deck, only: token_t, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_items, only: option_text
   use atrito_kinds, only: ip, wp
   use atrito_local_axes, only: dof_direction
   use atrito_mesh, only: is_revolved
   use atrito_model, only: model_t
   use atrito_references, only: find_nodes, in_no_element
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: add_rigid_rows, row_weight
   public :: check_row_nodes, check_row_dof, has_no_unknowns, row_node, row_terms, arm_of, TERMS_A_DOF, WHAT_DOF, AT_REFERENCE

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

end module atrito_row_dofs
