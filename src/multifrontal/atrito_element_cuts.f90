!> Cuts of a mesh into parts that are solved side by side: by the places of the elements where that is about as short as on a
!> regular mesh, else by METIS_PartMeshDual where there is METIS, and its cut has fewer nodes.
!>
!> METIS takes most of its time to find numbers in memory where neighbours are far apart, as they are in meshes of most
!> generators. So the elements are sorted into squares first and their nodes numbered as they come (docs/developer/solvers.md).
module atrito_element_cuts
   use atrito_kinds, only: ip, wp
   use atrito_metis, only: cut_mesh
   use atrito_place_cuts, only: cut_by_places
   implicit none (type, external)
   private
   public :: cut_elements, cut_by_metis, sort_by_squares

   !> Elements of a mesh in the order of the squares that they lie in.
   type :: sorted_mesh_t
      integer(ip), allocatable :: order(:)       !< (elements) place in the list
      integer(ip), allocatable :: first(:)       !< (elements + 1) corners: corner(first(i):first(i + 1) - 1)
      integer(ip), allocatable :: corner(:)      !< 1..n_nodes
      integer(ip) :: n_nodes = 0
   end type sorted_mesh_t

   !> The first four nodes of an element, or all, stand for its corners.
   integer(ip), parameter :: CORNERS = 4_ip
   !> Elements of a square, nearly.
   real(wp), parameter :: OF_A_SQUARE = 64.0_wp

contains

   !> The part of each element. An element weighs as much as it has nodes; each part has its share of the weight, but for some
   !> hundredths, and as few nodes in common with the others as may be. Parts may be unconnected.
   subroutine cut_elements(elements, nodes, n_nodes_of, x, target, part)
      integer(ip), intent(in) :: elements(:)     !< which
      integer(ip), intent(in) :: nodes(:, :)     !< (most nodes, all elements)
      integer(ip), intent(in) :: n_nodes_of(:)   !< (all elements)
      real(wp), intent(in) :: x(:, :)            !< (2, all nodes) [L]
      real(wp), intent(in) :: target(:)          !< (parts) shares of the weight; their sum is 1
      integer(ip), intent(out) :: part(:)        !< (elements) 1..size(target)
      integer(ip), allocatable :: other(:)
      logical :: is_short, done

      part = 1
      if (size(target) < 2 .or. size(elements) < size(target)) return
      call cut_by_places(elements, nodes, n_nodes_of, x, target, part, is_short)
      if (is_short) return
      allocate (other(size(elements)))
      call cut_by_metis(elements, nodes, n_nodes_of, x, target, other, done)
      if (.not. done) return
      if (count_border(elements, nodes, n_nodes_of, other) < count_border(elements, nodes, n_nodes_of, part)) part = other
   end subroutine cut_elements

   subroutine cut_by_metis(elements, nodes, n_nodes_of, x, target, part, done)
      integer(ip), intent(in) :: elements(:), nodes(:, :), n_nodes_of(:)
      real(wp), intent(in) :: x(:, :), target(:)
      integer(ip), intent(out) :: part(:)
      logical, intent(out) :: done               !< there is METIS, and it had enough memory
      type(sorted_mesh_t) :: mesh
      integer(ip), allocatable :: sorted(:)

      call sort_elements(elements, nodes, n_nodes_of, x, mesh)
      allocate (sorted(size(elements)))
      call cut_mesh(mesh%first, mesh%corner, mesh%n_nodes, n_nodes_of(elements(mesh%order)), target, sorted, done)
      if (done) part(mesh%order) = sorted
   end subroutine cut_by_metis

   !> Nodes that more than one part has.
   pure integer(ip) function count_border(elements, nodes, n_nodes_of, part) result(n)
      integer(ip), intent(in) :: elements(:), nodes(:, :), n_nodes_of(:), part(:)
      integer(ip) :: first_of(maxval(nodes(:, elements))), i, k, node

      n = 0
      first_of = 0                               ! part that has a node; less than 0: others have it, too
      do i = 1, size(elements, kind=ip)
         do k = 1, n_nodes_of(elements(i))
            node = nodes(k, elements(i))
            if (first_of(node) == 0) first_of(node) = part(i)
            if (first_of(node) < 0 .or. first_of(node) == part(i)) cycle
            first_of(node) = -part(i)
            n = n + 1
         end do
      end do
   end function count_border

   subroutine sort_elements(elements, nodes, n_nodes_of, x, mesh)
      integer(ip), intent(in) :: elements(:), nodes(:, :), n_nodes_of(:)
      real(wp), intent(in) :: x(:, :)
      type(sorted_mesh_t), intent(out) :: mesh
      integer(ip), allocatable :: number(:)
      integer(ip) :: i, k, e, node, n

      call sort_by_squares(x, nodes(1, elements), mesh%order)
      allocate (number(size(x, 2)), source=0_ip)
      allocate (mesh%first(size(elements) + 1), mesh%corner(CORNERS*size(elements)))
      n = 0
      mesh%first(1) = 1
      do i = 1, size(elements, kind=ip)
         e = elements(mesh%order(i))
         do k = 1, min(CORNERS, n_nodes_of(e))
            node = nodes(k, e)
            if (any(nodes(:k - 1, e) == node)) cycle
            if (number(node) == 0) then
               mesh%n_nodes = mesh%n_nodes + 1
               number(node) = mesh%n_nodes
            end if
            n = n + 1
            mesh%corner(n) = number(node)
         end do
         mesh%first(i + 1) = n + 1
      end do
      mesh%corner = mesh%corner(:n)
   end subroutine sort_elements

   !> The places in a list of nodes, square by square: what is near in the plane is near in the list.
   pure subroutine sort_by_squares(x, nodes, order)
      real(wp), intent(in) :: x(:, :)            !< (2, all nodes) [L]
      integer(ip), intent(in) :: nodes(:)
      integer(ip), allocatable, intent(out) :: order(:)
      integer(ip), allocatable :: first(:), square(:)
      real(wp) :: low(2), high(2), side
      integer(ip) :: n(2), at(2), i, s

      allocate (square(size(nodes)), order(size(nodes)))
      if (size(nodes) == 0) return
      low = x(:, nodes(1))
      high = low
      do i = 2, size(nodes, kind=ip)
         low = min(low, x(:, nodes(i)))
         high = max(high, x(:, nodes(i)))
      end do
      associate (extent => high - low, n_nodes => real(size(nodes), wp))
         side = sqrt(max(product(extent), maxval(extent)**2/n_nodes)*OF_A_SQUARE/n_nodes)
         n = int(extent/max(side, tiny(side)), ip) + 1_ip
      end associate
      allocate (first(0:n(1)*n(2)), source=0_ip)
      do i = 1, size(nodes, kind=ip)
         at = min(int((x(:, nodes(i)) - low)/max(side, tiny(side)), ip), n - 1_ip)
         square(i) = at(1) + n(1)*at(2)          ! from 0
         first(square(i) + 1) = first(square(i) + 1) + 1
      end do
      do s = 1, n(1)*n(2)
         first(s) = first(s) + first(s - 1)
      end do
      do i = 1, size(nodes, kind=ip)
         first(square(i)) = first(square(i)) + 1
         order(first(square(i))) = i
      end do
   end subroutine sort_by_squares

end module atrito_element_cuts
