!> Some elements of a mesh with numbers of their own, for them and for their nodes: what is listed together is near in memory.
module atrito_compact_mesh
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: compact_mesh_t, compact

   type :: compact_mesh_t
      integer(ip), allocatable :: list(:)        !< (elements) 1, 2, ...
      integer(ip), allocatable :: nodes(:, :)    !< (most nodes, elements)
      integer(ip), allocatable :: n_nodes_of(:)  !< (elements)
      integer(ip), allocatable :: node(:)        !< (n) of all
      real(wp), allocatable :: x(:, :)           !< (2, n) [L]
      logical, allocatable :: wanted(:)          !< (n)
   end type compact_mesh_t

contains

   !> Numbers the elements as they are listed, and their nodes as they come.
   subroutine compact(elements, nodes, n_nodes_of, x, wanted, mesh)
      integer(ip), intent(in) :: elements(:)    !< which, in the order that they get
      integer(ip), intent(in) :: nodes(:, :)    !< (most nodes, all elements)
      integer(ip), intent(in) :: n_nodes_of(:)  !< (all elements)
      real(wp), intent(in) :: x(:, :)           !< (2, all nodes) [L]
      logical, intent(in) :: wanted(:)          !< (all nodes)
      type(compact_mesh_t), intent(out) :: mesh !< copies, with numbers from 1
      integer(ip) :: number(size(wanted)), list(size(wanted)), i, k, n, node

      mesh%list = [(i, i=1, size(elements, kind=ip))]
      mesh%n_nodes_of = n_nodes_of(elements)
      allocate (mesh%nodes(size(nodes, 1), size(elements)), source=0_ip)
      number = 0
      n = 0
      do i = 1, size(elements, kind=ip)
         do k = 1, mesh%n_nodes_of(i)
            node = nodes(k, elements(i))
            if (number(node) == 0) then
               n = n + 1
               number(node) = n
               list(n) = node
            end if
            mesh%nodes(k, i) = number(node)
         end do
      end do
      mesh%node = list(:n)
      mesh%x = x(:, mesh%node)
      mesh%wanted = wanted(mesh%node)
   end subroutine compact

end module atrito_compact_mesh
