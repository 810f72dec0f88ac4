!> Lists of prescribed displacements and loads that grow by doubling.
module atrito_load_lists
   use atrito_kinds, only: ip, wp
   use atrito_model, only: prescribed_t, node_load_t, element_load_t
   implicit none (type, external)
   private
   public :: add_prescribed, add_node_load, add_element_load, trim_prescribed, trim_node_loads, trim_element_loads

   integer(ip), parameter :: FIRST_LENGTH = 16

contains

   !> Adds a prescribed displacement.
   pure subroutine add_prescribed(list, node, dof, value)
      type(prescribed_t), intent(inout) :: list
      integer(ip), intent(in) :: node, dof             !< place; 1 or 2
      real(wp), intent(in) :: value                    !< [L]

      if (.not. allocated(list%node)) call resize_prescribed(list, FIRST_LENGTH)
      if (list%n == size(list%node)) call resize_prescribed(list, 2*list%n)
      list%n = list%n + 1
      list%node(list%n) = node
      list%dof(list%n) = dof
      list%value(list%n) = value
   end subroutine add_prescribed

   !> Gives back the room kept for growing.
   pure subroutine trim_prescribed(list)
      type(prescribed_t), intent(inout) :: list

      call resize_prescribed(list, list%n)
   end subroutine trim_prescribed

   pure subroutine resize_prescribed(list, length)
      type(prescribed_t), intent(inout) :: list
      integer(ip), intent(in) :: length

      call resize(list%node, list%n, length)
      call resize(list%dof, list%n, length)
      call resize_values(list%value, list%n, length)
   end subroutine resize_prescribed

   !> Adds a force at a node.
   pure subroutine add_node_load(list, node, dof, value)
      type(node_load_t), intent(inout) :: list
      integer(ip), intent(in) :: node, dof             !< place; 1 or 2
      real(wp), intent(in) :: value                    !< [F]

      if (.not. allocated(list%node)) call resize_node_loads(list, FIRST_LENGTH)
      if (list%n == size(list%node)) call resize_node_loads(list, 2*list%n)
      list%n = list%n + 1
      list%node(list%n) = node
      list%dof(list%n) = dof
      list%value(list%n) = value
   end subroutine add_node_load

   pure subroutine trim_node_loads(list)
      type(node_load_t), intent(inout) :: list

      call resize_node_loads(list, list%n)
   end subroutine trim_node_loads

   pure subroutine resize_node_loads(list, length)
      type(node_load_t), intent(inout) :: list
      integer(ip), intent(in) :: length

      call resize(list%node, list%n, length)
      call resize(list%dof, list%n, length)
      call resize_values(list%value, list%n, length)
   end subroutine resize_node_loads

   !> Adds a load on an element.
   pure subroutine add_element_load(list, element, kind, face, value)
      type(element_load_t), intent(inout) :: list
      integer(ip), intent(in) :: element               !< place
      integer(ip), intent(in) :: kind                  !< LOAD_PRESSURE or LOAD_BODY
      integer(ip), intent(in) :: face                  !< LOAD_PRESSURE: 1..4
      real(wp), intent(in) :: value(2)                 !< pressure, 0 [F/L^2] or force per volume [F/L^3]

      if (.not. allocated(list%element)) call resize_element_loads(list, FIRST_LENGTH)
      if (list%n == size(list%element)) call resize_element_loads(list, 2*list%n)
      list%n = list%n + 1
      list%element(list%n) = element
      list%kind(list%n) = kind
      list%face(list%n) = face
      list%value(:, list%n) = value
   end subroutine add_element_load

   pure subroutine trim_element_loads(list)
      type(element_load_t), intent(inout) :: list

      call resize_element_loads(list, list%n)
   end subroutine trim_element_loads

   pure subroutine resize_element_loads(list, length)
      type(element_load_t), intent(inout) :: list
      integer(ip), intent(in) :: length
      real(wp), allocatable :: value(:, :)

      call resize(list%element, list%n, length)
      call resize(list%kind, list%n, length)
      call resize(list%face, list%n, length)
      allocate (value(2, length))
      if (allocated(list%value)) value(:, :list%n) = list%value(:, :list%n)
      call move_alloc(value, list%value)
   end subroutine resize_element_loads

   pure subroutine resize(list, used, length)
      integer(ip), allocatable, intent(inout) :: list(:)
      integer(ip), intent(in) :: used, length
      integer(ip), allocatable :: longer(:)

      allocate (longer(length))
      if (allocated(list)) longer(:used) = list(:used)
      call move_alloc(longer, list)
   end subroutine resize

   pure subroutine resize_values(list, used, length)
      real(wp), allocatable, intent(inout) :: list(:)
      integer(ip), intent(in) :: used, length
      real(wp), allocatable :: longer(:)

      allocate (longer(length))
      if (allocated(list)) longer(:used) = list(:used)
      call move_alloc(longer, list)
   end subroutine resize_values

end module atrito_load_lists
