!> Cuts of a mesh into parts that are solved side by side: METIS_PartMeshDual, or by the places of the elements where there is
!> no METIS.
!>
!> METIS takes most of its time to find numbers in memory where neighbours are far apart, as they are in meshes of most
!> generators. So the elements are sorted into squares first and their nodes numbered as they come (docs/developer/solvers.md).
module atrito_element_cuts
   use atrito_kinds, only: ip, wp
   use atrito_metis, only: cut_mesh
   implicit none (type, external)
   private
   public :: cut_elements, cut_by_places

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
   !> Halvings of the length along which a place of a cut is looked for.
   integer, parameter :: MOST_HALVINGS = 50

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
      type(sorted_mesh_t) :: mesh
      integer(ip), allocatable :: sorted(:)
      logical :: done

      part = 1
      if (size(target) < 2 .or. size(elements) < size(target)) return
      call sort_elements(elements, nodes, n_nodes_of, x, mesh)
      allocate (sorted(size(elements)))
      call cut_mesh(mesh%first, mesh%corner, mesh%n_nodes, n_nodes_of(elements(mesh%order)), target, sorted, done)
      if (done) then
         part(mesh%order) = sorted
      else
         call cut_by_places(elements, nodes, n_nodes_of, x, target, part)
      end if
   end subroutine cut_elements

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

   !> The places in a list of nodes, square by square.
   pure subroutine sort_by_squares(x, nodes, order)
      real(wp), intent(in) :: x(:, :)            !< (2, all nodes) [L]
      integer(ip), intent(in) :: nodes(:)
      integer(ip), allocatable, intent(out) :: order(:)
      integer(ip), allocatable :: first(:)
      real(wp) :: low(2), side
      integer(ip) :: n(2), i, s

      low = [minval(x(1, nodes)), minval(x(2, nodes))]
      associate (extent => [maxval(x(1, nodes)), maxval(x(2, nodes))] - low)
         side = sqrt(max(product(extent), maxval(extent)**2/real(size(nodes), wp))*OF_A_SQUARE/real(size(nodes), wp))
         n = int(extent/max(side, tiny(side)), ip) + 1_ip
      end associate
      allocate (first(0:n(1)*n(2)), order(size(nodes)))
      first = 0
      do i = 1, size(nodes, kind=ip)
         s = square_of(i)
         first(s + 1) = first(s + 1) + 1
      end do
      do s = 1, n(1)*n(2)
         first(s) = first(s) + first(s - 1)
      end do
      do i = 1, size(nodes, kind=ip)
         s = square_of(i)
         first(s) = first(s) + 1
         order(first(s)) = i
      end do

   contains

      !> Numbered from 0.
      pure integer(ip) function square_of(i)
         integer(ip), intent(in) :: i
         integer(ip) :: at(2)

         at = min(int((x(:, nodes(i)) - low)/max(side, tiny(side)), ip), n - 1_ip)
         square_of = at(1) + n(1)*at(2)
      end function square_of

   end subroutine sort_by_squares

   !> The same by the places of the elements: across the longer side, as far along it as half of the parts have their share.
   subroutine cut_by_places(elements, nodes, n_nodes_of, x, target, part)
      integer(ip), intent(in) :: elements(:), nodes(:, :), n_nodes_of(:)
      real(wp), intent(in) :: x(:, :), target(:)
      integer(ip), intent(out) :: part(:)
      integer(ip), allocatable :: list(:)
      integer(ip) :: i

      part = 1
      list = [(i, i=1, size(elements, kind=ip))]
      call cut_list(1_ip, size(target, kind=ip), list)

   contains

      recursive subroutine cut_list(first, last, list)
         integer(ip), intent(in) :: first, last  !< parts
         integer(ip), intent(in) :: list(:)      !< places in `elements`
         logical :: is_lower(size(list))
         integer(ip) :: middle

         if (first == last) then
            part(list) = first
            return
         end if
         middle = (first + last - 1)/2
         associate (of_list => elements(list))
            call find_lower(x(:, nodes(1, of_list)), n_nodes_of(of_list), sum(target(first:middle))/sum(target(first:last)), &
                            is_lower)
         end associate
         call cut_list(first, middle, pack(list, is_lower))
         call cut_list(middle + 1, last, pack(list,.not. is_lower))
      end subroutine cut_list

   end subroutine cut_by_places

   !> Finds what lies below a place along the longer side, so that it has a share of the weight.
   pure subroutine find_lower(at, weight, share, is_lower)
      real(wp), intent(in) :: at(:, :)           !< (2, n) [L]
      integer(ip), intent(in) :: weight(:)       !< (n)
      real(wp), intent(in) :: share              !< 0 to 1
      logical, intent(out) :: is_lower(:)        !< (n)
      real(wp) :: low, high, place
      integer :: along, halving

      is_lower = .true.
      if (size(at, 2) == 0) return
      along = maxloc([(maxval(at(along, :)) - minval(at(along, :)), along=1, 2)], dim=1)
      low = minval(at(along, :))
      high = maxval(at(along, :))
      do halving = 1, MOST_HALVINGS
         place = 0.5_wp*low + 0.5_wp*high
         if (sum(real(weight, wp), mask=at(along, :) < place) < share*sum(real(weight, wp))) then
            low = place
         else
            high = place
         end if
      end do
      is_lower = at(along, :) < high
   end subroutine find_lower

end module atrito_element_cuts
