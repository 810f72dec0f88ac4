!> Some elements of a scene (atrito_fem_piece) in buffers: what their stiffness and stresses depend on.
module atrito_piece_buffer
   use atrito_assembly, only: fem_t
   use atrito_element_table, only: MOST_NODES
   use atrito_kinds, only: ip
   use atrito_buffer, only: buffer_t, put, take
   use atrito_plane_state, only: elastic_t
   implicit none (type, external)
   private
   public :: put_piece, receive_piece

contains

   !> Adds mesh and sections. Sections go as they lie in memory, so that none of their components is forgotten.
   subroutine put_piece(buffer, piece)
      type(buffer_t), intent(inout) :: buffer    !< gets the items
      type(fem_t), intent(in) :: piece           !< with mesh, sections and temperatures

      associate (mesh => piece%mesh)
         call put(buffer, mesh%x)
         call put(buffer, mesh%shape)
         call put(buffer, mesh%state)
         call put(buffer, [mesh%nodes])
         call put(buffer, mesh%node_id)
         call put(buffer, mesh%element_id)
         call put(buffer, allocated(mesh%thickness))
         if (allocated(mesh%thickness)) call put(buffer, mesh%thickness)
      end associate
      call put(buffer, size(piece%sections, kind=ip))
      call put(buffer, transfer(piece%sections, [0_ip]))
      call put(buffer, piece%section_of)
      call put(buffer, piece%digit_error)
      call put(buffer, allocated(piece%heating))
      if (allocated(piece%heating)) call put(buffer, piece%heating)
   end subroutine put_piece

   !> The next items, a piece. Its mesh is made here: whoever has the piece gives it back.
   subroutine receive_piece(buffer, piece)
      type(buffer_t), intent(inout) :: buffer    !< its next items are taken
      type(fem_t), intent(inout) :: piece        !< gets a mesh of its own, sections and temperatures
      type(elastic_t) :: mold(1)
      integer(ip), allocatable :: numbers(:)
      integer(ip) :: n
      logical :: is_there

      allocate (piece%mesh)
      associate (mesh => piece%mesh)
         call take(buffer, mesh%x)
         call take(buffer, mesh%shape)
         call take(buffer, mesh%state)
         call take(buffer, numbers)
         mesh%nodes = reshape(numbers, [MOST_NODES, size(mesh%shape, kind=ip)])
         call take(buffer, mesh%node_id)
         call take(buffer, mesh%element_id)
         call take(buffer, is_there)
         if (is_there) call take(buffer, mesh%thickness)
         mesh%n_nodes = size(mesh%x, 2, kind=ip)
         mesh%n_elements = size(mesh%shape, kind=ip)
      end associate
      call take(buffer, n)
      call take(buffer, numbers)
      piece%sections = transfer(numbers, mold, n)
      call take(buffer, piece%section_of)
      call take(buffer, piece%digit_error)
      call take(buffer, is_there)
      if (is_there) call take(buffer, piece%heating)
   end subroutine receive_piece

end module atrito_piece_buffer
