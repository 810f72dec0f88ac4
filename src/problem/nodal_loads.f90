!> Nodal forces of all loads of a step.
!>
!> Consistent forces of the shape functions N_a of an element or a face:
!>
!>     f_a = int N_a b h dA         forces per volume b; b may be linear in place (GRAV, CENTRIF: LOAD_BODY, LOAD_LINEAR)
!>     f_a = -int N_a p n h ds      a pressure p on a face with the outward normal n, uniform or hydrostatic
!>     f_a = int N_a t h ds         a traction t along a direction (TRVEC)
!>
!> with the thickness h, or 2 pi r on the full circle. f = sum over elements and faces; concentrated forces add to it.
!> The same integrals over a part of an element, which has the shape of a triangle or a chord, serve section forces
!> (atrito_split_loads).
module atrito_nodal_loads
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_nodes, depth_places
   use atrito_element, only: pressure_load, body_load
   use atrito_face_loads, only: traction_load, hydrostatic_load
   use atrito_model, only: model_t, step_t, element_load_t, LOAD_BODY, LOAD_LINEAR, LOAD_TRACTION, LOAD_HYDROSTATIC, is_on_volume
   implicit none (type, external)
   private
   public :: nodal_loads, add_element_load, forces_of_load

contains

   !> f(2, n_nodes) [F]: concentrated loads, pressures on faces, forces per volume. All of them add up, also several on
   !> one node or face.
   pure subroutine nodal_loads(model, step, f)
      type(model_t), intent(in) :: model            !< mesh, thickness, materials
      type(step_t), intent(in) :: step              !< with the loads of this increment
      real(wp), allocatable, intent(out) :: f(:, :)    !< (2, n_nodes) [F]
      integer(ip) :: i

      allocate (f(2, model%mesh%n_nodes), source=0.0_wp)
      associate (loads => step%node_loads)
         do i = 1, loads%n
            f(loads%dof(i), loads%node(i)) = f(loads%dof(i), loads%node(i)) + loads%value(i)
         end do
      end associate
      do i = 1, step%element_loads%n
         call add_element_load(model, step%element_loads, i, f)
      end do
   end subroutine nodal_loads

   !> Adds one of the loads on elements to the forces of the nodes: of a load on the volume to all nodes of the element,
   !> else to those of its face.
   pure subroutine add_element_load(model, loads, i, f)
      type(model_t), intent(in) :: model            !< mesh, thickness, materials
      type(element_load_t), intent(in) :: loads     !< all loads on elements
      integer(ip), intent(in) :: i                  !< load
      real(wp), intent(inout) :: f(:, :)               !< (2, n_nodes) [F]
      integer(ip), allocatable :: nodes(:)
      real(wp), allocatable :: fe(:, :)
      integer(ip) :: e

      e = loads%element(i)
      if (is_on_volume(loads%kind(i))) then
         nodes = model%mesh%nodes(:model%mesh%shape(e), e)
      else
         nodes = face_nodes(model%mesh, e, loads%face(i))
      end if
      allocate (fe(2, size(nodes)))
      call forces_of_load(model, loads, i, model%mesh%x(:, nodes), depth_places(model%mesh, model%mesh%state(e), nodes), fe)
      f(:, nodes) = f(:, nodes) + fe
   end subroutine add_element_load

   !> The forces of a load on an element or on a face, or on a part of it that has such a shape, too: the number of
   !> nodes tells the shape, and the thickness or the radius comes from their places.
   pure subroutine forces_of_load(model, loads, i, x, places, fe)
      type(model_t), intent(in) :: model            !< mesh, thickness, materials
      type(element_load_t), intent(in) :: loads     !< all loads on elements
      integer(ip), intent(in) :: i                  !< load
      real(wp), intent(in) :: x(:, :)                  !< its nodes, those of a face in the order of face_nodes (2, n) [L]
      real(wp), intent(in) :: places(:)                !< what the depth goes by there (depth_places) (n) [L]
      real(wp), intent(out) :: fe(:, :)                !< (2, n) [F]

      associate (state => model%mesh%state(loads%element(i)), value => loads%value(:, i), &
                 thickness => model%sections(model%section_of(loads%element(i)))%thickness)
         select case (loads%kind(i))
         case (LOAD_LINEAR)
            call body_load(x, [0.0_wp, 0.0_wp], thickness, state, fe, value, places)
         case (LOAD_BODY)
            call body_load(x, value(:2), thickness, state, fe, places=places)
         case (LOAD_TRACTION)
            call traction_load(x, value(:2), thickness, state, fe, places)
         case (LOAD_HYDROSTATIC)
            call hydrostatic_load(x, value(1), value(2:3), thickness, state, fe, places)
         case default
            call pressure_load(x, value(1), thickness, state, fe, places, value(2:))
         end select
      end associate
   end subroutine forces_of_load

end module atrito_nodal_loads
