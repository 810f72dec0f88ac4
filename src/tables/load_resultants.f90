!> Resultants of what acts upon a model.
module atrito_load_resultants
   use atrito_step_loads, only: factor_at, time_before
   use atrito_element, only: body_load, pressure_load
   use atrito_element_table, only: MOST_NODES
   use atrito_face_loads, only: traction_load, hydrostatic_load
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_end, face_nodes, depth_places
   use atrito_model, only: model_t, element_load_t, nodal_values_t, is_on_volume, LOAD_PRESSURE, LOAD_BODY, LOAD_TRACTION, &
                           LOAD_HYDROSTATIC, LOAD_LINEAR
   use atrito_plane_state, only: depth_at, IS_TAPERED
   implicit none (type, external)
   private
   public :: force_t, load_resultants, last_factor, last_value, add_to, add_value, add_element_load, is_section_node

   !> A resultant [F] and its moment about the origin [F L].
   type :: force_t
      real(wp) :: f(2) = 0.0_wp                     !< along x and y [F]
      real(wp) :: moment = 0.0_wp                   !< about the origin [F L]
      real(wp) :: terms = 0.0_wp                    !< sum of the sizes of what was added [F]
   end type force_t

contains

   !> Resultants of the three kinds of load at the end of a step.
   pure subroutine load_resultants(model, concentrated, pressure, body, k)
      type(model_t), intent(in) :: model            !< loads, amplitudes and mesh are read
      type(force_t), intent(out) :: concentrated    !< on nodes
      type(force_t), intent(out) :: pressure        !< on element faces
      type(force_t), intent(out) :: body            !< in elements
      integer(ip), intent(in) :: k                  !< the step
      type(element_load_t) :: last
      integer(ip) :: i
      integer :: n

      call add_nodal_loads(model, k, model%steps(k)%node_loads, concentrated)
      call add_nodal_loads(model, k, model%steps(k)%rigid_loads, concentrated)
      last = model%steps(k)%element_loads
      do i = 1, last%n
         if (allocated(last%amplitude)) then
            n = merge(1, 3, last%kind(i) == LOAD_HYDROSTATIC)
            last%value(:n, i) = last%value(:n, i)*last_factor(model, k, last%amplitude(i))
         end if
         if (is_on_volume(last%kind(i))) call add_element_load(model, last, i, body)
         if (.not. is_on_volume(last%kind(i))) call add_element_load(model, last, i, pressure)
      end do
   end subroutine load_resultants

   !> Forces on nodes, forces and moments on the reference nodes of rigid surfaces. That of a pre-tension section is two forces that
   !> balance each other.
   pure subroutine add_nodal_loads(model, k, loads, force)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: k                  !< the step
      type(nodal_values_t), intent(in) :: loads
      type(force_t), intent(inout) :: force
      integer(ip) :: i

      do i = 1, loads%n
         if (is_section_node(model, loads%node(i))) cycle
         call add_value(force, loads%dof(i), last_value(model, k, loads, i), model%mesh%x(:, loads%node(i)))
      end do
   end subroutine add_nodal_loads

   !> Whether a node is that of a pre-tension section.
   pure logical function is_section_node(model, node) result(is)
      type(model_t), intent(in) :: model !< its rigid bodies are read
      integer(ip), intent(in) :: node    !< place in the mesh

      is = .false.
      if (allocated(model%rigid_bodies)) is = any(model%rigid_bodies%is_section .and. model%rigid_bodies%node == node)
   end function is_section_node

   !> An entry of a list at the end of a step.
   pure real(wp) function last_value(model, k, list, i) result(value)
      type(model_t), intent(in) :: model            !< its steps and amplitudes are read
      integer(ip), intent(in) :: k, i               !< the step; the entry
      type(nodal_values_t), intent(in) :: list      !< loads or prescribed displacements of the step

      value = list%value(i)
      if (allocated(list%amplitude)) value = value*last_factor(model, k, list%amplitude(i))
   end function last_value

   !> What an amplitude multiplies by at the end of a step.
   pure real(wp) function last_factor(model, k, amplitude) result(factor)
      type(model_t), intent(in) :: model      !< its steps and amplitudes are read
      integer(ip), intent(in) :: k, amplitude !< the step; place in amplitudes, 0: none

      factor = factor_at(model%amplitudes, amplitude, model%steps(k)%increments%period, time_before(model%steps, k + 1))
   end function last_factor

   !> Adds the resultant of one load.
   pure subroutine add_element_load(model, loads, i, force)
      type(model_t), intent(in) :: model            !< its mesh and sections are read
      type(element_load_t), intent(in) :: loads     !< on faces or in elements, with their full values
      integer(ip), intent(in) :: i                  !< place in loads
      type(force_t), intent(inout) :: force         !< is added to
      real(wp) :: a(2), b(2), push
      integer(ip) :: e, face

      select case (loads%kind(i))
      case (LOAD_PRESSURE)
         ! where the thickness varies no simple formula knows where the resultant goes through
         if (IS_TAPERED(model%mesh%state(loads%element(i))) .or. any(abs(loads%value(2:, i)) > 0.0_wp)) then
            call add_face_load(model, loads, i, force)
         else
            ! A uniform pressure on a face, curved or not, has the resultant of the same pressure on its chord.
            e = loads%element(i)
            face = loads%face(i)
            a = model%mesh%x(:, model%mesh%nodes(face, e))
            b = model%mesh%x(:, model%mesh%nodes(face_end(model%mesh, e, face), e))
            push = loads%value(1, i)*depth_at(model%mesh%state(e), model%sections(model%section_of(e))%thickness, &
                                              0.5_wp*a(1) + 0.5_wp*b(1))
            call add_to(force, push*[a(2) - b(2), b(1) - a(1)], 0.5_wp*a + 0.5_wp*b)
         end if
      case (LOAD_BODY)
         call add_nodal_forces(model, loads%element(i), loads%value(:2, i), [0.0_wp, 0.0_wp, 0.0_wp], force)
      case (LOAD_LINEAR)
         call add_nodal_forces(model, loads%element(i), [0.0_wp, 0.0_wp], loads%value(:, i), force)
      case default
         call add_face_load(model, loads, i, force)
      end select
   end subroutine add_element_load

   !> Adds a force at a place.
   pure subroutine add_to(force, f, x)
      type(force_t), intent(inout) :: force         !< is added to
      real(wp), intent(in) :: f(2)                  !< [F]
      real(wp), intent(in) :: x(2)                  !< [L]

      force%f = force%f + f
      force%terms = force%terms + (abs(f(1)) + abs(f(2)))
      force%moment = force%moment + (x(1)*f(2) - x(2)*f(1))
   end subroutine add_to

   !> Adds a force along a dof (1, 2), or a moment (6), at a place.
   pure subroutine add_value(force, dof, value, x)
      type(force_t), intent(inout) :: force         !< is added to
      integer(ip), intent(in) :: dof                !< 1, 2 or 6
      real(wp), intent(in) :: value                 !< [F], [F L]
      real(wp), intent(in) :: x(2)                  !< [L]
      real(wp) :: f(2)

      f = 0.0_wp
      if (dof <= 2) f(dof) = value
      call add_to(force, f, x)
      if (dof > 2) force%moment = force%moment + value
   end subroutine add_value

   !> A load that is not uniform, or whose length counts: shape functions add up to 1, and times the nodes to the place.
   pure subroutine add_face_load(model, loads, i, force)
      type(model_t), intent(in) :: model
      type(element_load_t), intent(in) :: loads
      integer(ip), intent(in) :: i                  !< place in the element_loads
      type(force_t), intent(inout) :: force
      integer(ip), allocatable :: nodes(:)
      real(wp), allocatable :: f(:, :), places(:)
      integer(ip) :: e, k

      e = loads%element(i)
      nodes = face_nodes(model%mesh, e, loads%face(i))
      allocate (f(2, size(nodes)))
      places = depth_places(model%mesh, model%mesh%state(e), nodes)
      associate (value => loads%value(:, i), x => model%mesh%x(:, nodes), &
                 thickness => model%sections(model%section_of(e))%thickness)
         select case (loads%kind(i))
         case (LOAD_TRACTION)
            call traction_load(x, value(:2), thickness, model%mesh%state(e), f, places)
         case (LOAD_HYDROSTATIC)
            call hydrostatic_load(x, value(1), value(2:3), thickness, model%mesh%state(e), f, places)
         case default
            call pressure_load(x, value(1), thickness, model%mesh%state(e), f, places, value(2:))
         end select
         do k = 1, size(nodes, kind=ip)
            call add_to(force, f(:, k), x(:, k))
         end do
      end associate
   end subroutine add_face_load

   !> A force per volume, which may be linear in the place, by its nodal forces.
   pure subroutine add_nodal_forces(model, e, density, slope, force)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: e                  !< element
      real(wp), intent(in) :: density(2), slope(3)  !< of body_load [F/L^3, F/L^4]
      type(force_t), intent(inout) :: force
      real(wp) :: f(2, MOST_NODES)
      integer(ip) :: k, n

      n = model%mesh%shape(e)
      associate (nodes => model%mesh%nodes(:n, e), state => model%mesh%state(e))
         call body_load(model%mesh%x(:, nodes), density, model%sections(model%section_of(e))%thickness, state, f(:, :n), &
                        slope, depth_places(model%mesh, state, nodes))
         do k = 1, n
            call add_to(force, f(:, k), model%mesh%x(:, nodes(k)))
         end do
      end associate
   end subroutine add_nodal_forces

end module atrito_load_resultants
