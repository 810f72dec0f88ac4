!> Supports along local axes: what is prescribed along x and y in each step, and bilateral rows along other directions.
module atrito_turn_supports
   use atrito_bilateral_rows, only: begin_rows, add_row, ROW_SUPPORT
   use atrito_build_context, only: build_context_t
   use atrito_build_rigid_bodies, only: is_reference, ROTATION_DOF
   use atrito_deck, only: token_t, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: condition_t, condition_list_t, add_condition, add_part, nodal_values_of
   use atrito_local_axes, only: dof_direction, has_local_axes
   use atrito_model, only: nodal_values_t
   use atrito_propagation, only: is_inherited
   use atrito_row_dofs, only: row_node, row_weight
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: turn_supports

contains

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

end module atrito_turn_supports
