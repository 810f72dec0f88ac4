!> *CLOAD, *DLOAD and *DSLOAD.
module atrito_build_loads
   use atrito_deck, only: is_empty_token, token_t, token_text, keyword_name
   use atrito_diagnostics, only: report_error, report_warning, report_note
   use atrito_build_steps, only: take_amplitude
   use atrito_build_context, only: build_context_t, line_token, replaced_t, ids_text, is_invalid, has_errors, has_lost_elements
   use atrito_build_rigid_bodies, only: can_move, is_reference, ROTATION_DOF
   use atrito_faces, only: is_outer_face
   use atrito_items, only: get_integer, get_real, has_option
   use atrito_kinds, only: ip, wp
   use atrito_local_axes, only: dof_direction
   use atrito_load_lists, only: condition_t, condition_list_t, add_condition, add_part, dof_slot, nodal_values_of, &
                                element_loads_of, SLOTS
   use atrito_model, only: nodal_values_t, LOAD_BODY, LOAD_HYDROSTATIC, LOAD_LINEAR, LOAD_TRACTION, SURFACE_ELEMENTS
   use atrito_growth, only: number_list_t, add_number, numbers_of
   use atrito_numbers, only: read_integer
   use atrito_plane_state, only: STATES
   use atrito_propagation, only: is_of_step, removes_all, propagate, list_inherited, apply_condition, set_to_zero, &
                                 warn_of_replaced, open_source
   use atrito_read_load, only: read_face_function, read_face_load, read_direction, read_spin, has_no_rest, magnitude_of
   use atrito_references, only: find_nodes, find_elements, find_surface, check_faces
   use atrito_refined_members, only: face_on_side
   use atrito_refinement, only: is_refined
   use atrito_row_dofs, only: has_no_unknowns, WHAT_DOF, AT_REFERENCE
   use atrito_strings, only: to_text, upper_case
   implicit none (type, external)
   private
   public :: build_loads

   integer, parameter :: DIGITS = 6                    !< of numbers in messages

   integer(ip), parameter :: LAST_DOF = 6              !< of a node in three dimensions: 3..6 do not exist here

   character(len=6), parameter :: LOAD_KEYWORDS(3) = [character(len=6) :: 'CLOAD', 'DLOAD', 'DSLOAD']

   !> Of *DSLOAD, and then of *DLOAD: a line of a later step takes the place of a load of the same label.
   integer(ip), parameter :: N_SURFACE_LABELS = 3
   character(len=7), parameter :: VOLUME_LABELS(4) = [character(len=7) :: 'BX', 'BY', 'GRAV', 'CENTRIF']
   character(len=7), parameter :: LABELS(19) = [character(len=7) :: 'P', 'TRVEC', 'HP', 'BX', 'BY', 'GRAV', 'CENTRIF', 'P1', 'P2', &
                                                             'P3', 'P4', 'HP1', 'HP2', 'HP3', 'HP4', 'TRVEC1', 'TRVEC2', 'TRVEC3', &
                                                                                                                 'TRVEC4']

contains

   !> All loads of a step: those that it inherits, and its own.
   subroutine build_loads(context)
      type(build_context_t), intent(inout) :: context  !< loads of its open step are set
      integer(ip) :: i, k

      context%open%replaced = replaced_t()
      if (context%open%number > 1) call inherit_loads(context)
      do i = context%open%first_card, context%open%last_card
         associate (card => context%deck%cards(i))
            if (.not. is_of_step(context, i) .or. all(keyword_name(card) /= LOAD_KEYWORDS)) cycle
            call take_amplitude(context, card)
            do k = card%first_line, card%first_line + card%n_lines - 1
               if (.not. context%deck%lines(k)%ok) cycle
               context%open%line = k
               call open_source(context, keyword_name(card), line_token(context, 1_ip))
               select case (keyword_name(card))
               case ('CLOAD')
                  call read_cload_line(context)
               case ('DLOAD')
                  call read_dload_line(context)
               case ('DSLOAD')
                  call read_dsload_line(context, has_option(context%deck, card, 'FUNCTION'))
               end select
            end do
         end associate
      end do
      call warn_of_replaced(context)
      associate (step => context%model%steps(context%open%number))
         call turn_forces(context, .false., step%node_loads)
         call turn_forces(context, .true., step%rigid_loads)
         step%element_loads = element_loads_of(context%open%loads, context%open%number == 1)
      end associate
   end subroutine build_loads

   !> The loads of the step before; OP=NEW lets them go to 0.
   subroutine inherit_loads(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i
      logical :: of_elements, of_surfaces

      associate (open => context%open, forces => context%open%forces, loads => context%open%loads)
         call propagate(context, forces, keeps_zeros=.false.)
         call list_inherited(SLOTS*context%model%mesh%n_nodes, [(slot_of(forces%list(i)), i=1, forces%n)], open%old_forces)
         if (removes_all(context, 'CLOAD')) then
            do i = 1, forces%n
               call set_to_zero(forces%list(i))
            end do
         end if
         call propagate(context, loads, keeps_zeros=.false.)
         call list_inherited(context%model%mesh%n_elements, [(loads%list(i)%place, i=1, loads%n)], open%old_loads)
         of_elements = removes_all(context, 'DLOAD')
         of_surfaces = removes_all(context, 'DSLOAD')
         do i = 1, loads%n
            if (merge(of_surfaces, of_elements, loads%list(i)%label <= N_SURFACE_LABELS)) call set_to_zero(loads%list(i))
         end do
      end associate
   end subroutine inherit_loads

   !> The slot of a force at a node: one for each dof that a node can have.
   pure integer(ip) function slot_of(force)
      type(condition_t), intent(in) :: force

      slot_of = SLOTS*(force%place - 1) + dof_slot(force%dof)
   end function slot_of

   !> What the loads of the line that is being read have in common.
   pure type(condition_t) function load_of_line(context, label) result(load)
      type(build_context_t), intent(in) :: context
      character(len=*), intent(in) :: label

      load = condition_t(label=findloc(LABELS, label, dim=1, kind=ip), line=context%open%line, amplitude=context%open%amplitude, &
                         source=context%open%source)
   end function load_of_line

   !> A load on an element in the place of one that is inherited, or a new one.
   pure subroutine add_load(context, load, element, value)
      type(build_context_t), intent(inout) :: context
      type(condition_t), intent(inout) :: load         !< with all but these
      integer(ip), intent(in) :: element
      real(wp), intent(in) :: value(:)                 !< as element_load_t has it; what is not given is 0

      load%place = element
      load%value = 0.0_wp
      load%value(:size(value)) = value
      if (load%kind == LOAD_HYDROSTATIC) load%from(2:) = load%value(2:)
      call apply_condition(load, element, context%open%old_loads, context%open%loads, context%open%replaced)
   end subroutine add_load

   !> Node or set, dof, force.
   subroutine read_cload_line(context)
      type(build_context_t), intent(inout) :: context
      integer(ip), allocatable :: nodes(:)
      type(condition_t) :: force
      logical :: ok(3), turns
      integer(ip) :: i

      force%line = context%open%line
      force%amplitude = context%open%amplitude
      force%source = context%open%source
      call find_nodes(context, line_token(context, 1_ip), nodes, ok(1))
      ! a concentrated force stays where the deck puts it
      if (is_refined(context%refinement)) nodes = pack(nodes, nodes <= context%refinement%n_nodes)
      call get_integer(context%deck, line_token(context, 2_ip), WHAT_DOF, force%dof, ok(2))
      call get_real(context%deck, line_token(context, 3_ip), 'force, a real [F]', force%value(1), ok(3))
      if (.not. all(ok(2:))) return
      turns = force%dof == ROTATION_DOF .and. size(nodes) > 0 .and. all(is_reference(context, nodes))
      if ((force%dof < 1 .or. force%dof > 2) .and. .not. turns) then
         ! A dof that there is not in the plane: harmless where the force is 0.
         associate (deck => context%deck, what => 'dof '//to_text(force%dof)//' does not exist in the plane')
            if (force%dof > 2 .and. force%dof <= LAST_DOF .and. .not. abs(force%value(1)) > 0.0_wp) then
               call report_note(deck, line_token(context, 2_ip), 'N-DOF', what//'; its force is 0')
            else
               call report_error(deck, line_token(context, 2_ip), 'E-DOF', what, expected=WHAT_DOF// &
                                 repeat(AT_REFERENCE, merge(1, 0, force%dof == ROTATION_DOF)))
            end if
         end associate
         return
      end if
      if (.not. ok(1)) return
      if (any(has_no_unknowns(context, nodes)) .and. abs(force%value(1)) > 0.0_wp) then
         if (has_lost_elements(context)) return
         call report_error(context%deck, line_token(context, 1_ip), 'E-NODE', 'node '// &
                           ids_text(pack(context%model%mesh%node_id(nodes), has_no_unknowns(context, nodes)))// &
                           ' belongs to no element and cannot carry a force', expected='nodes of elements')
         return
      end if
      if (size(nodes) > 1 .and. abs(force%value(1)) > 0.0_wp) then
         call report_note(context%deck, line_token(context, 3_ip), 'N-EACH', 'each of the '//to_text(size(nodes, kind=ip))// &
                          ' nodes of '//token_text(context%deck, line_token(context, 1_ip))//' takes '// &
                          to_text(force%value(1), DIGITS)//', all together '//to_text(size(nodes)*force%value(1), DIGITS))
      end if
      do i = 1, size(nodes, kind=ip)
         if (is_reference(context, nodes(i))) then
            if (.not. can_move(context, line_token(context, 1_ip), nodes(i), force%dof, force%value(1))) cycle
         end if
         force%place = nodes(i)
         call apply_condition(force, slot_of(force), context%open%old_forces, context%open%forces, context%open%replaced)
         if (is_reference(context, nodes(i))) call note_supported(context, [nodes(i)], force%dof)
      end do
      call note_supported(context, pack(nodes,.not. is_reference(context, nodes)), force%dof)
   end subroutine read_cload_line

   !> Forces along x and y; moments stay.
   pure subroutine turn_forces(context, of_references, loads)
      type(build_context_t), intent(in) :: context
      logical, intent(in) :: of_references             !< those on reference nodes, or those on all others
      type(nodal_values_t), intent(out) :: loads
      type(condition_list_t) :: turned
      real(wp) :: along(2)
      integer(ip) :: axis, i

      do i = 1, context%open%forces%n
         associate (force => context%open%forces%list(i))
            if (is_reference(context, force%place) .neqv. of_references) cycle
            if (force%dof == ROTATION_DOF .or. .not. allocated(context%axes)) then
               call add_condition(turned, force)
               cycle
            end if
            along = dof_direction(context, force%place, force%dof)
            do axis = 1, 2
               if (along(axis) == 0.0_wp .or. (force%value(1) == 0.0_wp .and. force%from(1) == 0.0_wp)) cycle
               call add_part(turned, force, axis, along(axis))
            end do
         end associate
      end do
      loads = nodal_values_of(turned)
   end subroutine turn_forces

   !> A force on a prescribed dof moves nothing.
   subroutine note_supported(context, nodes, dof)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: nodes(:), dof
      logical :: held(size(nodes))

      held = context%dof_entry(dof_slot(dof), nodes) > 0
      if (any(held)) call report_note(context%deck, line_token(context, 2_ip), 'N-SUPPORT', 'dof '//to_text(dof)//' of node '// &
                                      ids_text(pack(context%model%mesh%node_id(nodes), held))// &
                                      ' is prescribed: the force goes into the reaction')
   end subroutine note_supported

   !> Element or set, label, magnitude[, direction or levels].
   subroutine read_dload_line(context)
      type(build_context_t), intent(inout) :: context
      type(condition_t) :: load
      character(len=:), allocatable :: label
      integer(ip), allocatable :: elements(:)
      integer(ip) :: i
      real(wp) :: magnitude, value(3)
      logical :: ok, good

      label = upper_case(token_text(context%deck, line_token(context, 2_ip)))
      load = load_of_line(context, label)
      if (is_empty_token(line_token(context, 1_ip)) .and. any(label == VOLUME_LABELS)) then
         elements = [(i, i=1, context%model%mesh%n_elements)]
         ok = .true.
      else
         call find_elements(context, line_token(context, 1_ip), elements, ok)
      end if
      if (.not. any(label == VOLUME_LABELS)) then
         call read_face_load(context, label, 'DLOAD', load%kind, value, good)
         if (ok .and. good) call load_faces(label(len(label):))
         return
      end if
      call get_real(context%deck, line_token(context, 3_ip), magnitude_of(label), magnitude, good)
      ok = ok .and. good .and. has_no_rest(context, label, 'DLOAD')
      load%kind = LOAD_BODY
      select case (label)
      case ('BX', 'BY')
         if (.not. ok) return
         value(:2) = merge(magnitude, 0.0_wp, [label == 'BX', label == 'BY'])
         do i = 1, size(elements, kind=ip)
            call add_load(context, load, elements(i), value(:2))
         end do
      case ('GRAV', 'CENTRIF')
         call load_masses(context, elements, load, label == 'CENTRIF', magnitude, ok)
      end select

   contains

      !> A load on the face of each element that the label ends with.
      subroutine load_faces(digit)
         character(len=1), intent(in) :: digit            !< of the label
         type(number_list_t) :: inside
         integer(ip) :: face, i
         integer :: outcome
         logical :: ok

         call read_integer(digit, face, outcome)
         call check_faces(context, line_token(context, 2_ip), elements, face, ok)
         if (.not. ok) return
         do i = 1, size(elements, kind=ip)
            load%face = face_on_side(context%refinement, elements(i), face)
            if (load%face == 0) cycle
            call add_load(context, load, elements(i), value)
            if (.not. is_outer_face(context%model%mesh, context%around, elements(i), load%face)) then
               call add_number(inside, context%model%mesh%element_id(elements(i)))
            end if
         end do
         if (inside%n > 0) call report_warning(context%deck, line_token(context, 2_ip), 'W-FACE', 'the '// &
                                               trim(merge('traction', 'pressure', load%kind == LOAD_TRACTION))// &
                                               ' acts inside the mesh, too, on face '//digit//' of element '// &
                                               ids_text(numbers_of(inside)), expected='elements on the outline of the body')
      end subroutine load_faces
   end subroutine read_dload_line

   !> Loads upon the mass of elements, as a force per volume. GRAV: density times acceleration along a direction g, rho a g.
   !> CENTRIF: density times the square of the angular velocity times the way from the axis, rho w^2 S (x - x0), as a linear and a
   !> constant force.
   subroutine load_masses(context, elements, load, turns, magnitude, good)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: elements(:)
      type(condition_t), intent(inout) :: load
      logical, intent(in) :: turns                     !< CENTRIF
      real(wp), intent(in) :: magnitude                !< acceleration [L/T^2], or square of the angular velocity [1/T^2]
      logical, intent(in) :: good                      !< elements and magnitude are known
      real(wp) :: way(3), constant(2), force
      integer(ip) :: i, section
      logical :: ok, is_ring

      if (turns) then
         is_ring = .false.
         if (size(elements) > 0) is_ring = STATES(context%model%mesh%state(elements(1)))%has_hoop
         call read_spin(context, magnitude, is_ring, way, constant, ok)
      else
         call read_direction(context, 'gravity', constant, ok)
      end if
      if (.not. (ok .and. good)) return
      call need_density(context, elements)
      do i = 1, size(elements, kind=ip)
         force = 0.0_wp
         section = context%model%section_of(elements(i))
         if (section > 0) force = context%model%materials(context%model%sections(section)%material)%density*magnitude
         if (turns) then
            load%kind = LOAD_LINEAR
            call add_load(context, load, elements(i), force*way)
            load%kind = LOAD_BODY
         end if
         if (.not. turns .or. any(abs(constant) > 0.0_wp)) call add_load(context, load, elements(i), force*constant)
      end do
   end subroutine load_masses

   subroutine need_density(context, elements)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: elements(:)
      integer(ip) :: i, material

      do i = 1, size(elements, kind=ip)
         if (context%model%section_of(elements(i)) <= 0) cycle
         material = context%model%sections(context%model%section_of(elements(i)))%material
         if (context%model%materials(material)%density > 0.0_wp .or. is_invalid(context, &
                                                                                context%model%materials(material)%name)) cycle
         call report_error(context%deck, line_token(context, 2_ip), 'E-DENSITY', 'material '// &
                           context%model%materials(material)%name//' has no density', &
                           expected='*DENSITY in this material [F T^2/L^4]', keyword='DENSITY')
         return
      end do
   end subroutine need_density

   !> Surface, label, magnitude[, direction or levels].
   subroutine read_dsload_line(context, is_function)
      type(build_context_t), intent(inout) :: context
      logical, intent(in) :: is_function               !< the magnitude is one of x and y
      type(token_t) :: token
      type(condition_t) :: load
      character(len=:), allocatable :: label
      real(wp), allocatable :: values(:, :)            ! of the faces
      integer(ip) :: i, s
      logical :: ok

      token = line_token(context, 1_ip)
      label = upper_case(token_text(context%deck, line_token(context, 2_ip)))
      load = load_of_line(context, label)
      call find_surface(context, token, s)
      allocate (values(3, 1))
      if (.not. is_function) call read_face_load(context, label, 'DSLOAD', load%kind, values(:, 1), ok)
      if (s == 0) return
      if (is_function) call read_face_function(context, label, context%model%surfaces(s)%faces, load%kind, values, ok)
      associate (surface => context%model%surfaces(s))
         if (surface%kind /= SURFACE_ELEMENTS) then
            call report_error(context%deck, token, 'E-SURFACE', 'surface '//surface%name// &
                              ' is a drawn line, which carries no pressure', expected='a surface of TYPE=ELEMENT')
         else if (surface%faces%n == 0) then
            if (is_invalid(context, surface%name) .or. has_errors()) return   ! elements are missing, and that was reported
            call report_error(context%deck, token, 'E-SURFACE', 'surface '//surface%name// &
                              ' has no faces: others join it everywhere', expected='a surface on the outline of a body')
         end if
         if (.not. ok) return
         do i = 1, surface%faces%n
            load%face = surface%faces%face(i)
            call add_load(context, load, surface%faces%element(i), values(:, min(i, size(values, 2, kind=ip))))
         end do
      end associate
   end subroutine read_dsload_line

end module atrito_build_loads
