!> Supports along local axes: what is prescribed along x and y in each step, and bilateral rows along other directions.
module atrito_turn_supports
   use atrito_bilateral_rows, only: begin_rows, add_row, ROW_SUPPORT
   use atrito_build_context, only: build_context_t
   use atrito_build_rigid_bodies, only: is_reference, ROTATION_DOF
   use atrito_deck, only: token_t, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: add_nodal_value, trim_nodal_values, amplitude_of, from_of, source_of
   use atrito_local_axes, only: dof_direction, has_local_axes
   use atrito_model, only: model_t, nodal_values_t
   use atrito_rigid_motions, only: entry_of
   use atrito_row_dofs, only: row_node
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: turn_supports, row_weight

contains

   !> What forces of rows are divided by where several may share a load [L^2].
   pure real(wp) function row_weight(model) result(weight)
      type(model_t), intent(in) :: model

      weight = 0.0_wp
      associate (x => model%mesh%x(:, :model%mesh%n_nodes))
         if (size(x) > 0) weight = norm2(maxval(x, dim=2) - minval(x, dim=2))
      end associate
      if (.not. weight > 0.0_wp) weight = 1.0_wp
      if (size(model%sections) > 0) weight = weight*model%sections(1)%thickness
      if (allocated(model%mesh%thickness)) weight = weight*maxval(model%mesh%thickness)
   end function row_weight

   !> Prescribed displacements of a step along local axes: both of a node become prescribed ones along x and y, a single one a row,
   !> which holds in all steps.
   subroutine turn_supports(context)
      type(build_context_t), intent(inout) :: context
      type(nodal_values_t) :: inclined

      if (context%open%number == 1) call begin_rows(context%model%bilateral)
      associate (step => context%model%steps(context%open%number))
         call turn_list(context, context%open%supports, step%prescribed, inclined)
         call turn_list(context, context%open%references%prescribed, step%rigid_prescribed, inclined)
      end associate
      call trim_nodal_values(inclined)
      if (allocated(context%axes)) call keep_inclined(context, inclined)
   end subroutine turn_supports

   !> A list of the deck's dofs along x and y; rotations stay, and what is neither is added to the inclined ones.
   subroutine turn_list(context, local, turned, inclined)
      type(build_context_t), intent(in) :: context
      type(nodal_values_t), intent(in) :: local
      type(nodal_values_t), intent(out) :: turned
      type(nodal_values_t), intent(inout) :: inclined
      integer(ip) :: i, other, axis
      real(wp) :: direction(2)

      if (.not. allocated(context%axes)) then
         turned = local
         call trim_nodal_values(turned)
         return
      end if
      do i = 1, local%n
         if (local%dof(i) == ROTATION_DOF .or. .not. has_local_axes(context, local%node(i))) then
            call add_part(local, i, local%dof(i), 1.0_wp, turned)
            cycle
         end if
         direction = dof_direction(context, local%node(i), local%dof(i))
         other = place_in_list(context, local%node(i), 3 - local%dof(i))
         if (other > 0) then
            ! once, by the first of the two
            if (i < other) call add_both(context, local, i, other, turned)
         else if (any(direction == 0.0_wp)) then
            axis = merge(2_ip, 1_ip, direction(1) == 0.0_wp)
            call add_part(local, i, axis, direction(axis), turned)
         else
            call add_nodal_value(inclined, local%node(i), local%dof(i), local%value(i), amplitude=amplitude_of(local, i), &
                                 source=source_of(local, i))
         end if
      end do
      call trim_nodal_values(turned)
   end subroutine turn_list

   !> Where a dof stands in its list, of reference nodes or of all others; 0: it is free.
   pure integer(ip) function place_in_list(context, node, dof) result(place)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: node, dof

      if (is_reference(context, node)) then
         place = entry_of(context%open%references, node, dof)
      else
         place = context%dof_entry(dof, node)
      end if
   end function place_in_list

   !> The first token of the line that prescribes a dof; 0: none does.
   pure integer(ip) function token_of(context, node, dof) result(token)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: node, dof

      if (.not. is_reference(context, node)) then
         token = context%dof_token(dof, node)
         return
      end if
      token = entry_of(context%open%references, node, dof)
      if (token > 0) token = context%open%references%token(token)
   end function token_of

   !> A prescribed displacement, times a part, along an axis.
   pure subroutine add_part(local, i, axis, part, turned)
      type(nodal_values_t), intent(in) :: local
      integer(ip), intent(in) :: i, axis
      real(wp), intent(in) :: part
      type(nodal_values_t), intent(inout) :: turned

      call add_nodal_value(turned, local%node(i), axis, local%value(i)*part, from_of(local, i)*part, amplitude_of(local, i), &
                           source_of(local, i))
   end subroutine add_part

   !> Both displacements of a node.
   subroutine add_both(context, local, i, other, turned)
      type(build_context_t), intent(in) :: context
      type(nodal_values_t), intent(in) :: local
      integer(ip), intent(in) :: i, other              !< in the list
      type(nodal_values_t), intent(inout) :: turned
      real(wp) :: along(2), across(2), value(2), from(2)
      integer(ip) :: axis

      along = dof_direction(context, local%node(i), local%dof(i))
      across = dof_direction(context, local%node(i), 3 - local%dof(i))
      value = local%value(i)*along + local%value(other)*across
      from = from_of(local, i)*along + from_of(local, other)*across
      if (amplitude_of(local, i) /= amplitude_of(local, other)) call refuse_inclined(context, local, i, &
                                                                     'two displacements along local axes with different amplitudes')
      do axis = 1, 2
         call add_nodal_value(turned, local%node(i), axis, value(axis), from(axis), amplitude_of(local, i), source_of(local, i))
      end do
   end subroutine add_both

   !> Single displacements along directions that are no axis: rows, the same in all steps.
   subroutine keep_inclined(context, inclined)
      type(build_context_t), intent(inout) :: context
      type(nodal_values_t), intent(in) :: inclined     !< of this step
      real(wp) :: weight
      integer(ip) :: i

      if (context%open%number > 1) then
         call check_inclined(context, inclined)
         return
      end if
      weight = row_weight(context%model)
      do i = 1, inclined%n
         if (amplitude_of(inclined, i) > 0) call refuse_inclined(context, inclined, i, &
                                                                 'an amplitude of a displacement along an inclined axis')
         call add_row([row_node(context, inclined%node(i))], &
                      reshape(dof_direction(context, inclined%node(i), inclined%dof(i)), [2, 1]), inclined%value(i), 0.0_wp, &
                      weight, [ROW_SUPPORT, 1_ip, inclined%dof(i)], context%model%bilateral)
      end do
      context%model%inclined = inclined
   end subroutine keep_inclined

   !> What is along inclined axes in this step is so in the first.
   subroutine check_inclined(context, inclined)
      type(build_context_t), intent(in) :: context
      type(nodal_values_t), intent(in) :: inclined
      character(len=*), parameter :: WHAT = 'a displacement along an inclined axis that changes after the first step'
      integer(ip) :: i

      associate (first => context%model%inclined)
         do i = 1, min(inclined%n, first%n)
            if (inclined%node(i) == first%node(i) .and. inclined%dof(i) == first%dof(i) &
                .and. inclined%value(i) == first%value(i) .and. amplitude_of(inclined, i) == 0) cycle
            call refuse_inclined(context, inclined, i, WHAT)
            return
         end do
         if (inclined%n > first%n) call refuse_inclined(context, inclined, first%n + 1, WHAT)
         if (inclined%n < first%n) call refuse_inclined(context, first, inclined%n + 1, WHAT)
      end associate
   end subroutine check_inclined

   !> At the line that gives a displacement; at the *STEP where there is none.
   subroutine refuse_inclined(context, list, i, what)
      type(build_context_t), intent(in) :: context
      type(nodal_values_t), intent(in) :: list
      integer(ip), intent(in) :: i
      character(len=*), intent(in) :: what
      type(token_t) :: place
      integer(ip) :: c

      place = context%deck%tokens(max(1_ip, token_of(context, list%node(i), list%dof(i))))
      if (token_of(context, list%node(i), list%dof(i)) < context%open%first_token) then
         do c = context%open%first_card, context%open%last_card
            if (context%deck%cards(c)%step /= context%open%number) cycle
            if (keyword_name(context%deck%cards(c)) == 'STEP') place = context%deck%cards(c)%place
         end do
      end if
      call report_error(context%deck, place, 'E-NOT-BUILT', what//', of node '// &
                        to_text(context%model%mesh%node_id(list%node(i)))//', is not built yet', &
                        expected='the same value through all steps, without an amplitude, or both dofs of the node', &
                        keyword='TRANSFORM')
   end subroutine refuse_inclined

end module atrito_turn_supports
