!> Some of the elements by themselves: a mesh of their own, with their sections.
module atrito_fem_piece
   use atrito_assembly, only: fem_t
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: take_piece

contains

   !> Mesh and sections of some elements, in their order; bodies and equations are not made.
   subroutine take_piece(fem, nodes, elements, piece)
      type(fem_t), intent(in) :: fem             !< of all elements
      integer(ip), intent(in) :: nodes(:)        !< all nodes of the elements, each once
      integer(ip), intent(in) :: elements(:)     !< places in the mesh, in the order wanted
      type(fem_t), intent(inout) :: piece        !< its mesh is made here: whoever has the piece gives it back
      integer(ip), allocatable :: local(:)
      integer(ip) :: i, before

      allocate (piece%mesh)
      associate (own => piece%mesh, mesh => fem%mesh)
         own%n_nodes = size(nodes, kind=ip)
         own%n_elements = size(elements, kind=ip)
         own%node_id = mesh%node_id(nodes)
         own%x = mesh%x(:, nodes)
         own%element_id = mesh%element_id(elements)
         own%shape = mesh%shape(elements)
         own%state = mesh%state(elements)
         own%nodes = mesh%nodes(:, elements)
         if (allocated(mesh%thickness)) own%thickness = mesh%thickness(nodes)
         before = minval(nodes) - 1                ! less than all numbers
         allocate (local(maxval(nodes) - before))
         do i = 1, own%n_nodes
            local(nodes(i) - before) = i
         end do
         do i = 1, own%n_elements
            own%nodes(:own%shape(i), i) = local(own%nodes(:own%shape(i), i) - before)
         end do
      end associate
      piece%sections = fem%sections
      piece%section_of = fem%section_of(elements)
      piece%digit_error = fem%digit_error
      if (allocated(fem%heating)) piece%heating = fem%heating(nodes)
   end subroutine take_piece

end module atrito_fem_piece
