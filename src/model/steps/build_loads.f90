!> *CLOAD, *DLOAD and *DSLOAD.
module atrito_build_loads
   use atrito_deck, only: is_empty_token, data_line_t, token_t, token_text, line_item, keyword_name
   use atrito_diagnostics, only: report_error, report_warning, report_note
   use atrito_build_amplitudes, only: take_amplitude
   use atrito_build_context, only: build_context_t, carried_t, replaced_t, ids_text, is_invalid, has_errors, has_lost_elements
   use atrito_build_rigid_bodies, only: is_reference, ROTATION_DOF
   use atrito_carry_on, only: is_of_step, removes_all, carry_values, carry_loads, list_carried, take_force_place, &
                              take_load_place, remove_load
   use atrito_faces, only: is_outer_face
   use atrito_items, only: get_integer, get_real
   use atrito_kinds, only: ip, wp
   use atrito_local_axes, only: dof_direction
   use atrito_load_lists, only: add_nodal_value, add_element_load, replace_nodal_value, replace_element_load, replace_source, &
                                trim_nodal_values, trim_element_loads, amplitude_of, from_of, source_of
   use atrito_model, only: model_t, nodal_values_t, element_load_t, LOAD_BODY, LOAD_LINEAR, LOAD_TRACTION, SURFACE_ELEMENTS
   use atrito_name_list, only: find_name
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_numbers, only: read_integer
   use atrito_plane_state, only: STATES
   use atrito_read_face_load, only: read_face_load, read_direction, has_no_rest, magnitude_of
   use atrito_read_spin, only: read_spin
   use atrito_references, only: find_nodes, find_elements, check_faces, report_unknown
   use atrito_refined_members, only: is_on_side
   use atrito_refinement, only: is_refined
   use atrito_replaced_loads, only: warn_of_replaced
   use atrito_rigid_motions, only: carry_reference_loads, load_reference, is_prescribed
   use atrito_sources, only: open_source
   use atrito_strings, only: to_text, upper_case
   implicit none (type, external)
   private
   public :: build_loads, in_no_element

   integer(ip), parameter :: LAST_DOF = 6              !< of a node in three dimensions: 3..6 do not exist here

   character(len=6), parameter :: LOAD_KEYWORDS(3) = [character(len=6) :: 'CLOAD', 'DLOAD', 'DSLOAD']

   !> Of *DSLOAD, and then of *DLOAD: a line of a later step takes the place of a load of the same label.
   integer(ip), parameter :: N_SURFACE_LABELS = 3
   character(len=7), parameter :: VOLUME_LABELS(4) = [character(len=7) :: 'BX', 'BY', 'GRAV', 'CENTRIF']
   character(len=7), parameter :: LABELS(19) = [character(len=7) :: 'P', 'TRVEC', 'HP', 'BX', 'BY', 'GRAV', 'CENTRIF', 'P1', 'P2', &
                                                             'P3', 'P4', 'HP1', 'HP2', 'HP3', 'HP4', 'TRVEC1', 'TRVEC2', 'TRVEC3', &
                                                                                                                 'TRVEC4']

contains

   !> All loads of a step: those that are carried on, and its own.
   subroutine build_loads(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i, k

      context%open%replaced = replaced_t()
      if (context%open%number > 1) call carry_on(context)
      do i = context%open%first_card, context%open%last_card
         if (.not. is_of_step(context, i)) cycle
         associate (card => context%deck%cards(i))
            if (any(keyword_name(card) == LOAD_KEYWORDS)) call take_amplitude(context, card)
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (.not. context%deck%lines(k)%ok) cycle
               context%open%line = k
               if (any(keyword_name(card) == LOAD_KEYWORDS)) then
                  call open_source(context, keyword_name(card), context%deck%tokens(context%deck%lines(k)%first_token))
               end if
               if (context%open%old_loads%n > 0) context%open%label = label_place(context, k)
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
            end do
         end associate
      end do
      call warn_of_replaced(context)
      call trim_nodal_values(context%open%forces)
      associate (step => context%model%steps(context%open%number))
         call turn_forces(context, context%open%forces, step%node_loads)
         call turn_forces(context, context%open%references%loads, step%rigid_loads)
      end associate
      call trim_element_loads(context%model%steps(context%open%number)%element_loads)
   end subroutine build_loads

   !> The loads of the step before; OP=NEW lets them go to 0.
   subroutine carry_on(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i

      associate (open => context%open, loads => context%model%steps(context%open%number)%element_loads)
         call carry_values(context, open%forces, keeps_zeros=.false.)
         call list_carried(2*context%model%mesh%n_nodes, [(2*open%forces%node(i) + open%forces%dof(i) - 2, i=1, open%forces%n)], &
                           open%old_forces)
         call carry_reference_loads(context)
         if (removes_all(context, 'CLOAD')) then
            do i = 1, open%forces%n
               call replace_nodal_value(open%forces, i, 0.0_wp, 0_ip)
            end do
            do i = 1, open%references%loads%n
               call replace_nodal_value(open%references%loads, i, 0.0_wp, 0_ip)
            end do
         end if
         loads = context%model%steps(open%number - 1)%element_loads
         call carry_loads(context, loads)
         call list_carried(context%model%mesh%n_elements, loads%element(:loads%n), open%old_loads)
         open%old_loads%label = labels_of(context, loads)
         call remove_loads(removes_all(context, 'DLOAD'), removes_all(context, 'DSLOAD'), open%old_loads, loads)
      end associate
   end subroutine carry_on

   !> Which label of the deck each load has.
   pure function labels_of(context, loads) result(labels)
      type(build_context_t), intent(in) :: context
      type(element_load_t), intent(in) :: loads
      integer(ip) :: labels(loads%n)
      integer(ip) :: i, label, line

      label = 0
      line = 0
      do i = 1, loads%n
         if (loads%line(i) /= line) label = label_place(context, loads%line(i))
         line = loads%line(i)
         labels(i) = label
      end do
   end function labels_of

   !> Place in LABELS of the label on a line.
   pure integer(ip) function label_place(context, line) result(place)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: line
      character(len=:), allocatable :: label

      label = upper_case(token_text(context%deck, line_item(context%deck, context%deck%lines(line), 2_ip)))
      do place = 1, size(LABELS, kind=ip)
         if (LABELS(place) == label) return
      end do
      place = 0
   end function label_place

   !> Loads of *DLOAD, and of *DSLOAD, go to 0.
   pure subroutine remove_loads(of_elements, of_surfaces, carried, loads)
      logical, intent(in) :: of_elements, of_surfaces
      type(carried_t), intent(in) :: carried
      type(element_load_t), intent(inout) :: loads
      integer(ip) :: i

      if (.not. (of_elements .or. of_surfaces)) return
      do i = 1, carried%n
         if (merge(of_surfaces, of_elements, carried%label(i) <= N_SURFACE_LABELS)) call remove_load(loads, i)
      end do
   end subroutine remove_loads

   !> A load in the place of one that is carried on, or a new one.
   pure subroutine add_load(context, element, kind, face, value)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: element, kind, face
      real(wp), intent(in) :: value(:)
      integer(ip) :: place

      associate (open => context%open, loads => context%model%steps(context%open%number)%element_loads)
         place = 0
         if (open%old_loads%n > 0) call take_load_place(element, face, open%label, open%amplitude, open%line, open%old_loads, &
                                                        loads, open%replaced, place)
         if (place > 0) then                           ! a CENTRIF is two loads: the other one is added
            if (loads%kind(place) /= kind) place = 0
         end if
         if (place > 0) then
            call replace_element_load(loads, place, value, open%amplitude)
            loads%source(place) = open%source          ! all loads have one
         else
            call add_element_load(loads, element, kind, face, value, open%amplitude, open%source)
            place = loads%n
         end if
         loads%line(place) = open%line
      end associate
   end subroutine add_load

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
      type(build_context_t), intent(inout) :: context
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
         if (has_lost_elements(context)) return
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
      type(build_context_t), intent(inout) :: context
      integer(ip), allocatable, intent(inout) :: nodes(:)
      integer(ip) :: i

      if (size(context%model%rigid_bodies) == 0) return
      do i = 1, size(nodes, kind=ip)
         if (.not. is_reference(context, nodes(i))) cycle
         call load_reference(context, line_item(context%deck, line, 1_ip), nodes(i), dof, force)
         if (.not. is_prescribed(context, nodes(i), dof)) cycle
         call report_note(context%deck, line_item(context%deck, line, 2_ip), 'N-SUPPORT', 'dof '//to_text(dof)//' of node ' &
                          //to_text(context%model%mesh%node_id(nodes(i)))//' is prescribed: the force goes into the reaction', &
                          keyword='CLOAD')
      end do
      nodes = pack(nodes,.not. is_reference(context, nodes))
   end subroutine load_references

   !> A force along a dof of the deck, in the place of what is carried on there or besides what the step has.
   pure subroutine add_force(context, node, dof, force)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: node, dof
      real(wp), intent(in) :: force                    !< [F]
      integer(ip) :: place

      associate (open => context%open)
         place = 0
         if (open%old_forces%n > 0) call take_force_place(2*node + dof - 2, open%amplitude, open%old_forces, open%forces, place)
         if (place > 0) then
            call replace_nodal_value(open%forces, place, force, open%amplitude)
            call replace_source(open%forces, place, open%source)
         else
            call add_nodal_value(open%forces, node, dof, force, amplitude=open%amplitude, source=open%source)
         end if
      end associate
   end subroutine add_force

   !> Forces along x and y; moments stay.
   pure subroutine turn_forces(context, forces, loads)
      type(build_context_t), intent(in) :: context
      type(nodal_values_t), intent(in) :: forces       !< along the dofs of the deck
      type(nodal_values_t), intent(inout) :: loads
      real(wp) :: along(2), from
      integer(ip) :: axis, i

      if (.not. allocated(context%axes)) then
         loads = forces
         call trim_nodal_values(loads)
         return
      end if
      do i = 1, forces%n
         from = from_of(forces, i)
         if (forces%dof(i) == ROTATION_DOF) then
            call add_nodal_value(loads, forces%node(i), ROTATION_DOF, forces%value(i), from, amplitude_of(forces, i), &
                                 source_of(forces, i))
            cycle
         end if
         along = dof_direction(context, forces%node(i), forces%dof(i))
         do axis = 1, 2
            if (along(axis) == 0.0_wp .or. (forces%value(i) == 0.0_wp .and. from == 0.0_wp)) cycle
            call add_nodal_value(loads, forces%node(i), axis, forces%value(i)*along(axis), from*along(axis), &
                                 amplitude_of(forces, i), source_of(forces, i))
         end do
      end do
      call trim_nodal_values(loads)
   end subroutine turn_forces

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
      type(build_context_t), intent(inout) :: context
      character(len=:), allocatable :: label
      integer(ip), allocatable :: elements(:)
      integer(ip) :: kind, i
      real(wp) :: magnitude, value(3)
      logical :: ok, good

      label = upper_case(token_text(context%deck, line_item(context%deck, line, 2_ip)))
      if (is_empty_token(context%deck%tokens(line%first_token)) .and. any(label == VOLUME_LABELS)) then
         elements = [(i, i=1, context%model%mesh%n_elements)]
         ok = .true.
      else
         call find_elements(context, context%deck%tokens(line%first_token), elements, ok, 'DLOAD')
      end if
      if (.not. any(label == VOLUME_LABELS)) then
         call read_face_load(line, context, label, 'DLOAD', kind, value, good)
         if (ok .and. good) call load_faces(line, context, elements, label, kind, value)
         return
      end if
      call get_real(context%deck, line_item(context%deck, line, 3_ip), magnitude_of(label), magnitude, good, keyword='DLOAD')
      ok = ok .and. good .and. has_no_rest(line, context, label, 'DLOAD')
      select case (label)
      case ('BX')
         if (ok) call pull_elements(context, elements, [magnitude, 0.0_wp])
      case ('BY')
         if (ok) call pull_elements(context, elements, [0.0_wp, magnitude])
      case ('GRAV')
         call weigh_elements(line, context, elements, magnitude, ok)
      case ('CENTRIF')
         call spin_elements(line, context, elements, magnitude, ok)
      end select
   end subroutine read_dload_line

   !> A load on the face of each element that the label ends with.
   subroutine load_faces(line, context, elements, label, kind, value)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(inout) :: context
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
         call add_load(context, elements(i), kind, face, value)
         if (.not. is_outer_face(context%model%mesh, context%around, elements(i), face)) then
            call add_number(inside, context%model%mesh%element_id(elements(i)))
         end if
      end do
      if (inside%n > 0) call report_warning(context%deck, line_item(context%deck, line, 2_ip), 'W-FACE', 'the ' &
                              //trim(merge('traction', 'pressure', kind == LOAD_TRACTION))//' acts inside the mesh, too, on face ' &
                                            //label(len(label):)//' of element '//ids_text(numbers_of(inside)), &
                                            expected='elements on the outline of the body', keyword='DLOAD')
   end subroutine load_faces

   pure subroutine pull_elements(context, elements, force)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: elements(:)
      real(wp), intent(in) :: force(2)                 !< per volume [F/L^3]
      integer(ip) :: i

      do i = 1, size(elements, kind=ip)
         call add_load(context, elements(i), LOAD_BODY, 0_ip, force)
      end do
   end subroutine pull_elements

   !> GRAV: density times acceleration, along a direction of any length.
   subroutine weigh_elements(line, context, elements, acceleration, good)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(inout) :: context
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
         call add_load(context, elements(i), LOAD_BODY, 0_ip, density*acceleration*direction)
      end do
   end subroutine weigh_elements

   !> Of CENTRIF: density times the square of the angular velocity times the way from the axis, S (x - x0), as a linear and a
   !> constant force per volume.
   subroutine spin_elements(line, context, elements, square, good)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: elements(:)
      real(wp), intent(in) :: square                   !< of the angular velocity [1/T^2]
      logical, intent(in) :: good                      !< elements and square are known
      real(wp) :: way(3), there(2), force
      integer(ip) :: i
      logical :: ok, is_ring

      is_ring = .false.
      if (size(elements) > 0) is_ring = STATES(context%model%mesh%state(elements(1)))%has_hoop
      call read_spin(line, context, square, is_ring, way, there, ok)
      if (.not. (ok .and. good)) return
      call need_density(line, context, elements)
      do i = 1, size(elements, kind=ip)
         force = density_of(context%model, elements(i))*square
         call add_load(context, elements(i), LOAD_LINEAR, 0_ip, force*way)
         if (any(abs(there) > 0.0_wp)) call add_load(context, elements(i), LOAD_BODY, 0_ip, force*there)
      end do
   end subroutine spin_elements

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
      type(build_context_t), intent(inout) :: context
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
         else if (surface%faces%n == 0) then
            if (is_invalid(context, surface%name) .or. has_errors()) return   ! elements are missing, and that was told
            call report_error(context%deck, token, 'E-SURFACE', 'surface '//surface%name// &
                              ' has no faces: others join it everywhere', expected='a surface on the outline of a body', &
                              keyword='DSLOAD')
         end if
         if (.not. ok) return
         do i = 1, surface%faces%n
            call add_load(context, surface%faces%element(i), kind, surface%faces%face(i), value)
         end do
      end associate
   end subroutine read_dsload_line

end module atrito_build_loads
