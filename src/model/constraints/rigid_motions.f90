!> What a step prescribes and applies at the reference nodes of rigid surfaces, and what it has from the step before.
module atrito_rigid_motions
   use atrito_build_context, only: build_context_t, place_text, references_t
   use atrito_build_rigid_bodies, only: rigid_body_of, ROTATION_DOF
   use atrito_carry_on, only: carry_values, list_carried, take_force_place
   use atrito_deck, only: token_t
   use atrito_diagnostics, only: report_error
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: add_nodal_value, amplitude_of, replace_nodal_value, replace_source
   use atrito_local_axes, only: has_local_axes
   use atrito_mesh, only: is_revolved
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: prescribe_reference, load_reference, is_prescribed, entry_of, carry_reference_loads

   !> Two values of one dof are the same when they differ by less than this part of them: expressions are rounded.
   real(wp), parameter :: SAME_VALUE = 1.0e-12_wp

contains

   !> Whether a reference node can be displaced or loaded there: not along a radius nor about the axis of bodies of revolution, nor
   !> along axes of its own where it moves along one axis alone.
   logical function can_move(context, place, node, dof, value, keyword) result(can)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: place            !< of the line
      integer(ip), intent(in) :: node, dof
      real(wp), intent(in) :: value
      character(len=*), intent(in) :: keyword

      associate (body => context%model%rigid_bodies(rigid_body_of(context, node)))
         can = .not. (has_local_axes(context, node) .and. (is_revolved(context%model%mesh) .or. body%is_section))
      end associate
      if (.not. can) then
         call report_error(context%deck, place, 'E-NODE', 'reference node '//to_text(context%model%mesh%node_id(node)) &
                           //' moves along one axis alone, and has local axes', expected='a node without *TRANSFORM', &
                           keyword=keyword)
      else if (context%model%rigid_bodies(rigid_body_of(context, node))%is_section) then
         can = dof == 1 .or. abs(value) <= 0.0_wp
         if (.not. can) call report_error(context%deck, place, 'E-DOF', 'the node of a pre-tension section has no dof ' &
                                          //to_text(dof), expected='dof 1: what the sides approach by, or the force', &
                                          keyword=keyword)
      else if (is_revolved(context%model%mesh) .and. dof /= 2 .and. abs(value) > 0.0_wp) then
         can = .false.
         call report_error(context%deck, place, 'E-DOF', 'a rigid surface round an axis moves along it alone, not by dof ' &
                           //to_text(dof), expected='dof 2 of a reference node beside CAX elements', keyword=keyword)
      end if
   end function can_move

   !> Place of a dof of a reference node among those that are prescribed; 0: it is free.
   pure integer(ip) function entry_of(references, node, dof) result(entry)
      type(references_t), intent(in) :: references
      integer(ip), intent(in) :: node, dof

      associate (list => references%prescribed)
         do entry = 1, list%n
            if (list%node(entry) == node .and. list%dof(entry) == dof) return
         end do
      end associate
      entry = 0
   end function entry_of

   !> Whether a dof of a reference node is prescribed in the step that is built: 1 and 2 its displacements, 6 its rotation.
   pure logical function is_prescribed(context, node, dof)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: node, dof

      is_prescribed = entry_of(context%open%references, node, dof) > 0
   end function is_prescribed

   !> Prescribes a dof of a reference node: 1, 2, or 6. A line of a later step takes the place of an earlier one.
   subroutine prescribe_reference(context, token, node, dof, value)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: token              !< first of the line
      integer(ip), intent(in) :: node, dof
      real(wp), intent(in) :: value                 !< [L], or [-]
      integer(ip) :: entry

      if (.not. can_move(context, context%deck%tokens(token), node, dof, value, 'BOUNDARY')) return
      associate (open => context%open, list => context%open%references%prescribed)
         entry = entry_of(open%references, node, dof)
         if (entry > 0) call replace_source(list, entry, open%source)
         if (entry == 0) then
            call add_nodal_value(list, node, dof, value, amplitude=open%amplitude, source=open%source)
            if (.not. allocated(open%references%token)) allocate (open%references%token(0))
            open%references%token = [open%references%token(:list%n - 1), token]
         else if (open%references%token(entry) < open%first_token) then
            call replace_nodal_value(list, entry, value, open%amplitude)
            open%references%token(entry) = token
         else if (abs(list%value(entry) - value) > SAME_VALUE*max(abs(list%value(entry)), abs(value))) then
            call report_clash(context, token, entry, 'is '//to_text(value)//' here but '//to_text(list%value(entry))//' in ', &
                              'one value for each dof in a step [L]')
         else if (abs(value) > 0.0_wp .and. amplitude_of(list, entry) /= open%amplitude) then
            call report_clash(context, token, entry, 'has another amplitude here than in ', &
                              'one AMPLITUDE= for each dof in a step')
         end if
      end associate
   end subroutine prescribe_reference

   !> Two lines of a step do not agree.
   subroutine report_clash(context, token, entry, what, expected)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: token              !< first of the line
      integer(ip), intent(in) :: entry              !< that an earlier line gives
      character(len=*), intent(in) :: what, expected

      associate (list => context%open%references%prescribed, tokens => context%deck%tokens)
         call report_error(context%deck, tokens(token), 'E-CONFLICT', 'dof '//to_text(list%dof(entry))//' of node ' &
                           //to_text(context%model%mesh%node_id(list%node(entry)))//' '//what &
                           //place_text(context%deck, tokens(context%open%references%token(entry)), tokens(token)), &
                           expected=expected, keyword='BOUNDARY')
      end associate
   end subroutine report_clash

   !> Adds a force or, with dof 6, a moment at a reference node; in a later step in the place of what is carried on there.
   subroutine load_reference(context, line, node, dof, value)
      type(build_context_t), intent(inout) :: context
      type(token_t), intent(in) :: line             !< its first token
      integer(ip), intent(in) :: node, dof
      real(wp), intent(in) :: value                 !< [F], or [F L]
      integer(ip) :: place

      if (.not. can_move(context, line, node, dof, value, 'CLOAD')) return
      associate (open => context%open, references => context%open%references)
         place = 0
         if (references%old_loads%n > 0) call take_force_place(dof_place(context, node, dof), open%amplitude, &
                                                               references%old_loads, references%loads, place)
         if (place > 0) then
            call replace_nodal_value(references%loads, place, value, open%amplitude)
            call replace_source(references%loads, place, open%source)
         else
            call add_nodal_value(references%loads, node, dof, value, amplitude=open%amplitude, source=open%source)
         end if
      end associate
   end subroutine load_reference

   !> Number of a dof among those of all reference nodes.
   pure integer(ip) function dof_place(context, node, dof)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: node, dof

      dof_place = ROTATION_DOF*(rigid_body_of(context, node) - 1) + dof
   end function dof_place

   !> The loads of the step before.
   subroutine carry_reference_loads(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i

      associate (references => context%open%references)
         call carry_values(context, references%loads, keeps_zeros=.false.)
         call list_carried(ROTATION_DOF*size(context%model%rigid_bodies, kind=ip), &
                           [(dof_place(context, references%loads%node(i), references%loads%dof(i)), i=1, references%loads%n)], &
                           references%old_loads)
      end associate
   end subroutine carry_reference_loads

end module atrito_rigid_motions
