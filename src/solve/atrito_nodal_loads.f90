!> Nodal forces of all loads of a step.
module atrito_nodal_loads
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_nodes, element_coordinates
   use atrito_element, only: pressure_load, body_load
   use atrito_face_loads, only: traction_load, hydrostatic_load
   use atrito_model, only: model_t, step_t, element_load_t, LOAD_BODY, LOAD_TRACTION, LOAD_HYDROSTATIC
   implicit none (type, external)
   private
   public :: nodal_loads

contains

   !> f(2, n_nodes) [F]: concentrated loads, pressures on faces, forces per volume.
   pure subroutine nodal_loads(model, step, f)
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: step
      real(wp), allocatable, intent(out) :: f(:, :)    !< (2, n_nodes) [F]
      integer(ip) :: i

      allocate (f(2, model%mesh%n_nodes), source=0.0_wp)
      associate (loads => step%node_loads)
         do i = 1, loads%n
            f(loads%dof(i), loads%node(i)) = f(loads%dof(i), loads%node(i)) + loads%value(i)
         end do
      end associate
      do i = 1, step%element_loads%n
         if (step%element_loads%kind(i) == LOAD_BODY) then
            call add_body_force(model, step%element_loads, i, f)
         else
            call add_face_load(model, step%element_loads, i, f)
         end if
      end do
   end subroutine nodal_loads

   pure subroutine add_face_load(model, loads, i, f)
      type(model_t), intent(in) :: model
      type(element_load_t), intent(in) :: loads
      integer(ip), intent(in) :: i
      real(wp), intent(inout) :: f(:, :)
      integer(ip), allocatable :: nodes(:)
      real(wp), allocatable :: fe(:, :)

      nodes = face_nodes(model%mesh, loads%element(i), loads%face(i))
      allocate (fe(2, size(nodes)))
      select case (loads%kind(i))
      case (LOAD_TRACTION)
         call traction_load(model%mesh%x(:, nodes), loads%value(:2, i), thickness_of(model, loads%element(i)), &
                            model%mesh%state(loads%element(i)), fe)
      case (LOAD_HYDROSTATIC)
         call hydrostatic_load(model%mesh%x(:, nodes), loads%value(1, i), loads%value(2:3, i), &
                               thickness_of(model, loads%element(i)), model%mesh%state(loads%element(i)), fe)
      case default
         call pressure_load(model%mesh%x(:, nodes), loads%value(1, i), thickness_of(model, loads%element(i)), &
                            model%mesh%state(loads%element(i)), fe)
      end select
      f(:, nodes) = f(:, nodes) + fe
   end subroutine add_face_load

   pure subroutine add_body_force(model, loads, i, f)
      type(model_t), intent(in) :: model
      type(element_load_t), intent(in) :: loads
      integer(ip), intent(in) :: i
      real(wp), intent(inout) :: f(:, :)
      integer(ip), allocatable :: nodes(:)
      real(wp), allocatable :: fe(:, :)
      integer(ip) :: e

      e = loads%element(i)
      nodes = model%mesh%nodes(:model%mesh%shape(e), e)
      allocate (fe(2, size(nodes)))
      call body_load(element_coordinates(model%mesh, e), loads%value(:2, i), thickness_of(model, e), &
                     model%mesh%state(e), fe)
      f(:, nodes) = f(:, nodes) + fe
   end subroutine add_body_force

   pure real(wp) function thickness_of(model, element)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: element

      thickness_of = model%sections(model%section_of(element))%thickness
   end function thickness_of

end module atrito_nodal_loads
