!> Mesh and sections of a part of a scene in parcels: what stresses and stiffness of its elements depend on.
module atrito_mesh_parcel
   use atrito_assembly, only: fem_t
   use atrito_kinds, only: ip
   use atrito_mesh, only: mesh_t
   use atrito_parcel, only: parcel_t, put, take
   use atrito_plane_state, only: elastic_t
   implicit none (type, external)
   private
   public :: put_mesh, take_mesh, put_sections, take_sections

contains

   !> Adds a mesh without its sets of numbers; the user's numbers where it has them.
   subroutine put_mesh(parcel, mesh)
      type(parcel_t), intent(inout) :: parcel
      type(mesh_t), intent(in) :: mesh

      call put(parcel, mesh%x)
      call put(parcel, mesh%shape)
      call put(parcel, mesh%state)
      call put(parcel, mesh%nodes)
      call put(parcel, [allocated(mesh%thickness), allocated(mesh%node_id)])
      if (allocated(mesh%thickness)) call put(parcel, mesh%thickness)
      if (.not. allocated(mesh%node_id)) return
      call put(parcel, mesh%node_id)
      call put(parcel, mesh%element_id)
   end subroutine put_mesh

   !> The next items, a mesh.
   subroutine take_mesh(parcel, mesh)
      type(parcel_t), intent(inout) :: parcel
      type(mesh_t), intent(out) :: mesh
      logical, allocatable :: are_there(:)

      call take(parcel, mesh%x)
      call take(parcel, mesh%shape)
      call take(parcel, mesh%state)
      call take(parcel, mesh%nodes)
      call take(parcel, are_there)
      if (are_there(1)) call take(parcel, mesh%thickness)
      mesh%n_nodes = size(mesh%x, 2, kind=ip)
      mesh%n_elements = size(mesh%shape, kind=ip)
      if (.not. are_there(2)) return
      call take(parcel, mesh%node_id)
      call take(parcel, mesh%element_id)
   end subroutine take_mesh

   !> Adds the sections of the elements and what goes with them. Sections go as they lie in memory, so that none of their components
   !> is forgotten.
   subroutine put_sections(parcel, fem)
      type(parcel_t), intent(inout) :: parcel
      type(fem_t), intent(in) :: fem

      call put(parcel, size(fem%sections, kind=ip))
      call put(parcel, transfer(fem%sections, [0_ip]))
      call put(parcel, fem%section_of)
      call put(parcel, fem%grain)
      call put(parcel, allocated(fem%heating))
      if (allocated(fem%heating)) call put(parcel, fem%heating)
   end subroutine put_sections

   !> The next items, sections.
   subroutine take_sections(parcel, fem)
      type(parcel_t), intent(inout) :: parcel
      type(fem_t), intent(inout) :: fem
      type(elastic_t) :: mold(1)
      integer(ip), allocatable :: numbers(:)
      integer(ip) :: n
      logical :: is_there

      call take(parcel, n)
      call take(parcel, numbers)
      fem%sections = transfer(numbers, mold, n)
      call take(parcel, fem%section_of)
      call take(parcel, fem%grain)
      call take(parcel, is_there)
      if (is_there) call take(parcel, fem%heating)
   end subroutine take_sections

end module atrito_mesh_parcel
