!> Lists of prescribed displacements and loads that grow by doubling.
module atrito_load_lists
   use atrito_growth, only: make_room, resize
   use atrito_kinds, only: ip, wp
   use atrito_model, only: nodal_values_t, element_load_t
   implicit none (type, external)
   private
   public :: add_nodal_value, add_element_load, trim_nodal_values, trim_element_loads

contains

   !> Adds a prescribed displacement, or a force at a node.
   pure subroutine add_nodal_value(list, node, dof, value)
      type(nodal_values_t), intent(inout) :: list
      integer(ip), intent(in) :: node, dof             !< place; 1 or 2
      real(wp), intent(in) :: value                    !< [L] or [F]

      call make_room(list%node, list%n, list%n + 1)
      call make_room(list%dof, list%n, list%n + 1)
      call make_room(list%value, list%n, list%n + 1)
      list%n = list%n + 1
      list%node(list%n) = node
      list%dof(list%n) = dof
      list%value(list%n) = value
   end subroutine add_nodal_value

   !> Gives back the room kept for growing.
   pure subroutine trim_nodal_values(list)
      type(nodal_values_t), intent(inout) :: list

      call resize(list%node, list%n, list%n)
      call resize(list%dof, list%n, list%n)
      call resize(list%value, list%n, list%n)
   end subroutine trim_nodal_values

   !> Adds a load on an element.
   pure subroutine add_element_load(list, element, kind, face, value)
      type(element_load_t), intent(inout) :: list
      integer(ip), intent(in) :: element               !< place
      integer(ip), intent(in) :: kind                  !< LOAD_*
      integer(ip), intent(in) :: face                  !< 1..4; LOAD_BODY: 0
      real(wp), intent(in) :: value(:)                 !< as element_load_t has it; what is not given is 0

      call make_room(list%element, list%n, list%n + 1)
      call make_room(list%kind, list%n, list%n + 1)
      call make_room(list%face, list%n, list%n + 1)
      call make_room(list%line, list%n, list%n + 1)
      if (.not. allocated(list%value)) allocate (list%value(3, size(list%element)))
      if (list%n == size(list%value, 2)) call resize(list%value, list%n, size(list%element, kind=ip))
      list%n = list%n + 1
      list%element(list%n) = element
      list%kind(list%n) = kind
      list%face(list%n) = face
      list%line(list%n) = 0
      list%value(:, list%n) = 0.0_wp
      list%value(:size(value), list%n) = value
   end subroutine add_element_load

   pure subroutine trim_element_loads(list)
      type(element_load_t), intent(inout) :: list

      call resize(list%element, list%n, list%n)
      call resize(list%kind, list%n, list%n)
      call resize(list%face, list%n, list%n)
      call resize(list%line, list%n, list%n)
      if (.not. allocated(list%value)) allocate (list%value(3, 0))
      call resize(list%value, list%n, list%n)
   end subroutine trim_element_loads

end module atrito_load_lists
