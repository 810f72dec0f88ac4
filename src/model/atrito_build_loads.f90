!> *CLOAD, *DLOAD and *DSLOAD.
module atrito_build_loads
   use atrito_deck, only: data_line_t, token_t, token_text, line_item, keyword_name
   use atrito_diagnostics, only: report_error, report_warning, report_note
   use atrito_build_context, only: build_context_t, ids_text, is_invalid
   use atrito_build_rigid_bodies, only: is_reference, load_reference, ROTATION_DOF
   use atrito_faces, only: is_outer_face
   use atrito_items, only: get_integer, get_real
   use atrito_kinds, only: ip, wp
   use atrito_local_axes, only: dof_direction, has_local_axes
   use atrito_load_lists, only: add_nodal_value, add_element_load, trim_nodal_values, trim_element_loads
   use atrito_model, only: model_t, LOAD_BODY, LOAD_TRACTION, SURFACE_ELEMENTS
   use atrito_name_list, only: find_name
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_numbers, only: read_integer
   use atrito_read_face_load, only: read_face_load, read_direction, has_no_rest, magnitude_of
   use atrito_references, only: find_nodes, find_elements, check_faces, report_unknown
   use atrito_refined_members, only: is_on_side
   use atrito_refinement, only: is_refined
   use atrito_strings, only: to_text, upper_case
   implicit none (type, external)
   private
   public :: build_loads, in_no_element

   integer(ip), parameter :: LAST_DOF = 6              !< of a node in three dimensions: 3..6 do not exist here

contains

   !> All loads of the step.
   subroutine build_loads(context)
      type(build_context_t), intent(in) :: context
      integer(ip) :: i, k, n

      do i = 1, context%deck%n_cards
         associate (card => context%deck%cards(i))
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (.not. context%deck%lines(k)%ok) cycle
               n = context%model%steps(1)%element_loads%n
               select case (keyword_name(card))
               case ('CLOAD')
                  call read_cload_line(context%deck%lines(k), context)
               case ('DLOAD')
                  call read_dload_line(context%deck%lines(k), context)
               case ('DSLOAD')
                  call read_dsload_line(context%deck%lines(k), context)
               case default
                  exit
               end select
               associate (loads => context%model%steps(1)%element_loads)
                  if (loads%n > n) loads%line(n + 1:loads%n) = k
               end associate
            end do
         end associate
      end do
      call trim_nodal_values(context%model%steps(1)%node_loads)
      call trim_element_loads(context%model%steps(1)%element_loads)
   end subroutine build_loads

   !> The nodes of a list that belong to no element.
   pure function in_no_element(context, nodes) result(loose)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:)              !< places
      logical :: loose(size(nodes))

      loose = context%around%first(nodes + 1) == context%around%first(nodes)
   end function in_no_element

   !> Node or set, dof, force.
   subroutine read_cload_line(line, context)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      character(len=*), parameter :: WHAT = 'degree of freedom: 1 (x) or 2 (y)', &
                                     AT_REFERENCE = '; of the reference node of a *RIGID BODY also 6'
      integer(ip), allocatable :: nodes(:)
      real(wp) :: force
      integer(ip) :: dof, i
      logical :: ok(3), turns

      call find_nodes(context, context%deck%tokens(line%first_token), nodes, ok(1), 'CLOAD')
      ! a concentrated force stays where the deck puts it
      if (is_refined(context%refinement)) nodes = pack(nodes, nodes <= context%refinement%n_nodes)
      call get_integer(context%deck, line_item(context%deck, line, 2_ip), WHAT, dof, ok(2), keyword='CLOAD')
      call get_real(context%deck, line_item(context%deck, line, 3_ip), 'force, a real [F]', force, ok(3), keyword='CLOAD')
      if (.not. all(ok(2:))) return
      turns = dof == ROTATION_DOF .and. size(nodes) > 0 .and. all(is_reference(context, nodes))
      if (dof > 2 .and. dof <= LAST_DOF .and. .not. abs(force) > 0.0_wp .and. .not. turns) then
         call report_note(context%deck, line_item(context%deck, line, 2_ip), 'N-DOF', 'dof '//to_text(dof)// &
                          ' does not exist in the plane; its force is 0', keyword='CLOAD')
         return
      end if
      if ((dof < 1 .or. dof > 2) .and. .not. turns) then
         call report_error(context%deck, line_item(context%deck, line, 2_ip), 'E-DOF', 'dof '//to_text(dof)// &
                           ' does not exist in the plane', expected=WHAT//repeat(AT_REFERENCE, merge(1, 0, dof == ROTATION_DOF)), &
                           keyword='CLOAD')
         return
      end if
      if (.not. ok(1)) return
      call load_references(line, dof, force, context, nodes)
      if (turns) return
      if (any(in_no_element(context, nodes)) .and. abs(force) > 0.0_wp) then
         call report_error(context%deck, line_item(context%deck, line, 1_ip), 'E-NODE', 'node '// &
                           ids_text(pack(context%model%mesh%node_id(nodes), in_no_element(context, nodes)))// &
                           ' belongs to no element and cannot carry a force', expected='nodes of elements', keyword='CLOAD')
         return
      end if
      do i = 1, size(nodes, kind=ip)
         call add_force(context, nodes(i), dof, force)
      end do
      call note_supported(line, context, nodes, dof)
   end subroutine read_cload_line

   !> Loads those of the nodes that are reference nodes, and leaves the others.
   subroutine load_references(line, dof, force, context, nodes)
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: dof
      real(wp), intent(in) :: force                   !< [F], or [F L]
      type(build_context_t), intent(in) :: context
      integer(ip), allocatable, intent(inout) :: nodes(:)
      integer(ip) :: i

      if (size(context%model%rigid_bodies) == 0) return
      do i = 1, size(nodes, kind=ip)
         if (.not. is_reference(context, nodes(i))) cycle
         call load_reference(context, line_item(context%deck, line, 1_ip), context%model%steps(1)%rigid_loads, nodes(i), dof, force)
         associate (held => context%model%steps(1)%rigid_prescribed)
            if (held%n == 0) cycle
            if (any(held%node(:held%n) == nodes(i) .and. held%dof(:held%n) == dof)) call report_note( &
               context%deck, line_item(context%deck, line, 2_ip), 'N-SUPPORT', 'dof '//to_text(dof)//' of node ' &
               //to_text(context%model%mesh%node_id(nodes(i)))//' is prescribed: the force goes into the reaction', keyword='CLOAD')
         end associate
      end do
      nodes = pack(nodes,.not. is_reference(context, nodes))
   end subroutine load_references

   !> A force along a dof, which may be a local axis.
   subroutine add_force(context, node, dof, force)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: node, dof
      real(wp), intent(in) :: force                    !< [F]
      real(wp) :: along(2)
      integer(ip) :: axis

      if (.not. has_local_axes(context, node)) then
         call add_nodal_value(context%model%steps(1)%node_loads, node, dof, force)
         return
      end if
      along = force*dof_direction(context, node, dof)
      do axis = 1, 2
         if (along(axis) /= 0.0_wp) call add_nodal_value(context%model%steps(1)%node_loads, node, axis, along(axis))
      end do
   end subroutine add_force

   !> A force on a prescribed dof moves nothing.
   subroutine note_supported(line, context, nodes, dof)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:), dof
      logical :: held(size(nodes))

      held = context%dof_entry(dof, nodes) > 0
      if (any(held)) call report_note(context%deck, line_item(context%deck, line, 2_ip), 'N-SUPPORT', 'dof '//to_text(dof)// &
                                      ' of node '//ids_text(pack(context%model%mesh%node_id(nodes), &
                                                                 held))//' is prescribed: the force goes into the reaction', &
                                      keyword='CLOAD')
   end subroutine note_supported

   !> Element or set, label, magnitude[, direction or levels].
   subroutine read_dload_line(line, context)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      character(len=:), allocatable :: label
      integer(ip), allocatable :: elements(:)
      integer(ip) :: kind
      real(wp) :: magnitude, value(3)
      logical :: ok, good

      call find_elements(context, context%deck%tokens(line%first_token), elements, ok, 'DLOAD')
      label = upper_case(token_text(context%deck, line_item(context%deck, line, 2_ip)))
      if (label(1:1) /= 'B' .and. label /= 'GRAV') then
         call read_face_load(line, context, label, 'DLOAD', kind, value, good)
         if (ok .and. good) call load_faces(line, context, elements, label, kind, value)
         return
      end if
      call get_real(context%deck, line_item(context%deck, line, 3_ip), magnitude_of(label), magnitude, good, keyword='DLOAD')
      ok = ok .and. good .and. has_no_rest(line, context, label, 'DLOAD')
      select case (label)
      case ('BX')
         if (ok) call pull_elements(context%model, elements, [magnitude, 0.0_wp])
      case ('BY')
         if (ok) call pull_elements(context%model, elements, [0.0_wp, magnitude])
      case ('GRAV')
         call weigh_elements(line, context, elements, magnitude, ok)
      end select
   end subroutine read_dload_line

   !> A load on the face of each element that the label ends with.
   subroutine load_faces(line, context, elements, label, kind, value)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: elements(:)
      character(len=*), intent(in) :: label
      integer(ip), intent(in) :: kind
      real(wp), intent(in) :: value(3)
      type(number_list_t) :: inside
      integer(ip) :: i, face
      integer :: outcome
      logical :: ok

      call read_integer(label(len(label):), face, outcome)
      call check_faces(context, line_item(context%deck, line, 2_ip), elements, face, 'DLOAD', ok)
      if (.not. ok) return
      do i = 1, size(elements, kind=ip)
         if (.not. is_on_side(context%refinement, elements(i), face)) cycle
         call add_element_load(context%model%steps(1)%element_loads, elements(i), kind, face, value)
         if (.not. is_outer_face(context%model%mesh, context%around, elements(i), face)) then
            call add_number(inside, context%model%mesh%element_id(elements(i)))
         end if
      end do
      if (inside%n > 0) call report_warning(context%deck, line_item(context%deck, line, 2_ip), 'W-FACE', 'the ' &
                              //trim(merge('traction', 'pressure', kind == LOAD_TRACTION))//' acts inside the mesh, too, on face ' &
                                            //label(len(label):)//' of element '//ids_text(numbers_of(inside)), &
                                            expected='elements on the outline of the body', keyword='DLOAD')
   end subroutine load_faces

   pure subroutine pull_elements(model, elements, force)
      type(model_t), intent(inout) :: model
      integer(ip), intent(in) :: elements(:)
      real(wp), intent(in) :: force(2)                 !< per volume [F/L^3]
      integer(ip) :: i

      do i = 1, size(elements, kind=ip)
         call add_element_load(model%steps(1)%element_loads, elements(i), LOAD_BODY, 0_ip, force)
      end do
   end subroutine pull_elements

   !> GRAV: density times acceleration, along a direction of any length.
   subroutine weigh_elements(line, context, elements, acceleration, good)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: elements(:)
      real(wp), intent(in) :: acceleration             !< [L/T^2]
      logical, intent(in) :: good                      !< elements and acceleration are known
      real(wp) :: direction(2), density
      integer(ip) :: i
      logical :: ok

      call read_direction(line, context, 'gravity', 'DLOAD', direction, ok)
      if (.not. (ok .and. good)) return
      call need_density(line, context, elements)
      do i = 1, size(elements, kind=ip)
         density = density_of(context%model, elements(i))
         call add_element_load(context%model%steps(1)%element_loads, elements(i), LOAD_BODY, 0_ip, density*acceleration*direction)
      end do
   end subroutine weigh_elements

   pure real(wp) function density_of(model, element) result(density)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: element

      density = 0.0_wp
      if (model%section_of(element) > 0) density = model%materials(model%sections(model%section_of(element))%material)%density
   end function density_of

   subroutine need_density(line, context, elements)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: elements(:)
      integer(ip) :: i, material

      do i = 1, size(elements, kind=ip)
         if (context%model%section_of(elements(i)) <= 0) cycle
         material = context%model%sections(context%model%section_of(elements(i)))%material
         if (context%model%materials(material)%density > 0.0_wp .or. is_invalid(context, &
                                                                                context%model%materials(material)%name)) cycle
         call report_error(context%deck, line_item(context%deck, line, 2_ip), 'E-DENSITY', 'material '// &
                           context%model%materials(material)%name//' has no density', &
                           expected='*DENSITY in this material [F T^2/L^4]', keyword='DENSITY')
         return
      end do
   end subroutine need_density

   !> Surface, label, magnitude[, direction or levels].
   subroutine read_dsload_line(line, context)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      type(token_t) :: token
      character(len=:), allocatable :: label
      real(wp) :: value(3)
      integer(ip) :: i, kind, s
      logical :: ok

      token = context%deck%tokens(line%first_token)
      label = upper_case(token_text(context%deck, line_item(context%deck, line, 2_ip)))
      call read_face_load(line, context, label, 'DSLOAD', kind, value, ok)
      s = find_name(context%surface_names, token_text(context%deck, token))
      if (s == 0) then
         call report_unknown(context, token, 'surface', 'E-SURFACE', context%surface_names, 'DSLOAD')
         return
      end if
      associate (surface => context%model%surfaces(s))
         if (surface%kind /= SURFACE_ELEMENTS) then
            call report_error(context%deck, token, 'E-SURFACE', 'surface '//surface%name// &
                              ' is a drawn line, which carries no pressure', expected='a surface of TYPE=ELEMENT', &
                              keyword='DSLOAD')
         else if (surface%faces%n == 0 .and. .not. is_invalid(context, surface%name)) then
            call report_error(context%deck, token, 'E-SURFACE', 'surface '//surface%name// &
                              ' has no faces: others join it everywhere', expected='a surface on the outline of a body', &
                              keyword='DSLOAD')
         end if
         if (.not. ok) return
         do i = 1, surface%faces%n
            call add_element_load(context%model%steps(1)%element_loads, surface%faces%element(i), kind, surface%faces%face(i), &
                                  value)
         end do
      end associate
   end subroutine read_dsload_line

end module atrito_build_loads
