!> Some elements of a scene (atrito_fem_piece) in parcels: what their stiffness and stresses depend on.
module atrito_piece_parcel
   use atrito_assembly, only: fem_t
   use atrito_element_table, only: MOST_NODES
   use atrito_kinds, only: ip
   use atrito_parcel, only: parcel_t, put, take
   use atrito_plane_state, only: elastic_t
   implicit none (type, external)
   private
   public :: put_piece, receive_piece

contains

   !> Adds mesh and sections. Sections go as they lie in memory, so that none of their components is forgotten.
   subroutine put_piece(parcel, piece)
      type(parcel_t), intent(inout) :: parcel
      type(fem_t), intent(in) :: piece

      associate (mesh => piece%mesh)
         call put(parcel, mesh%x)
         call put(parcel, mesh%shape)
         call put(parcel, mesh%state)
         call put(parcel, [mesh%nodes])
         call put(parcel, mesh%node_id)
         call put(parcel, mesh%element_id)
         call put(parcel, allocated(mesh%thickness))
         if (allocated(mesh%thickness)) call put(parcel, mesh%thickness)
      end associate
      call put(parcel, size(piece%sections, kind=ip))
      call put(parcel, transfer(piece%sections, [0_ip]))
      call put(parcel, piece%section_of)
      call put(parcel, piece%grain)
      call put(parcel, allocated(piece%heating))
      if (allocated(piece%heating)) call put(parcel, piece%heating)
   end subroutine put_piece

   !> The next items, a piece. Its mesh is made here: whoever has the piece gives it back.
   subroutine receive_piece(parcel, piece)
      type(parcel_t), intent(inout) :: parcel
      type(fem_t), intent(inout) :: piece
      type(elastic_t) :: mold(1)
      integer(ip), allocatable :: numbers(:)
      integer(ip) :: n
      logical :: is_there

      allocate (piece%mesh)
      associate (mesh => piece%mesh)
         call take(parcel, mesh%x)
         call take(parcel, mesh%shape)
         call take(parcel, mesh%state)
         call take(parcel, numbers)
         mesh%nodes = reshape(numbers, [MOST_NODES, size(mesh%shape, kind=ip)])
         call take(parcel, mesh%node_id)
         call take(parcel, mesh%element_id)
         call take(parcel, is_there)
         if (is_there) call take(parcel, mesh%thickness)
         mesh%n_nodes = size(mesh%x, 2, kind=ip)
         mesh%n_elements = size(mesh%shape, kind=ip)
      end associate
      call take(parcel, n)
      call take(parcel, numbers)
      piece%sections = transfer(numbers, mold, n)
      call take(parcel, piece%section_of)
      call take(parcel, piece%grain)
      call take(parcel, is_there)
      if (is_there) call take(parcel, piece%heating)
   end subroutine receive_piece

end module atrito_piece_parcel
