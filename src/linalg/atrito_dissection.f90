!> Elimination order for the sparse solver: nested dissection by the places of the nodes.
!>
!> A set of nodes is cut across its longer side at the median of the nodes; of the lower part those that touch the upper one are
!> the separator and are eliminated last, after the two parts, which are cut in turn (George, SIAM J. Numer. Anal. 10 (1973)
!> 345-363). Near the optimum for plane meshes, whatever the numbering of the nodes, in n log n steps: minimum degree takes 0.7 to
!> 3 times the operations, depending on the numbering, and METIS ten times as long to find an order no better (docs/developer).
module atrito_dissection
   use atrito_kinds, only: ip, wp
   use atrito_ordering, only: graph_t
   implicit none (type, external)
   private
   public :: dissect, dissection_t

   !> Sets so small are not cut any more.
   integer, parameter :: LEAF = 8
   !> Nodes whose median stands for that of all.
   integer, parameter :: MOST_SAMPLES = 63
   !> Nodes closer to the cut than this share of the extent lie on it: round-off of a regular mesh.
   real(wp), parameter :: ON_CUT = 1.0e-6_wp

   !> The parts of a dissected set, in postorder: each separator after the two parts that it divides.
   type :: dissection_t
      integer(ip) :: n = 0                       !< parts
      integer(ip), allocatable :: last(:)        !< (n or more) last node of each part in the list of the nodes; a part may be empty
      integer(ip), allocatable :: parent(:)      !< (n or more) 0: none
   end type dissection_t

   type :: work_t
      integer(ip) :: cut = 0                     !< number of the cut being made
      integer(ip), allocatable :: upper_of(:)    !< (nodes of the graph) last cut that had the node above it
      integer(ip), allocatable :: buffer(:)
   end type work_t

contains

   !> Brings nodes into the order of their elimination.
   pure subroutine dissect(graph, x, nodes, parts)
      type(graph_t), intent(in) :: graph
      real(wp), intent(in) :: x(:, :)            !< (2, nodes of the graph) [L]
      integer(ip), intent(inout), contiguous :: nodes(:) !< distinct nodes of the graph, in any order
      type(dissection_t), intent(out) :: parts
      type(work_t) :: work
      integer(ip), parameter :: ROOM = 64_ip

      allocate (parts%last(ROOM), parts%parent(ROOM))
      allocate (work%upper_of(graph%n), source=0_ip)
      allocate (work%buffer(size(nodes)))
      if (size(nodes) > 0) call cut(graph, x, nodes, 0_ip, parts, work)
   end subroutine dissect

   !> The depth of the recursion is that of the tree, about log2 of the nodes.
   pure recursive subroutine cut(graph, x, nodes, before, parts, work)
      type(graph_t), intent(in) :: graph
      real(wp), intent(in) :: x(:, :)
      integer(ip), intent(inout), contiguous :: nodes(:)
      integer(ip), intent(in) :: before          !< nodes that stand before these in the list
      type(dissection_t), intent(inout) :: parts
      type(work_t), intent(inout) :: work
      integer(ip) :: n_lower, n_upper, lower, upper
      integer :: along
      real(wp) :: place

      n_upper = 0
      if (size(nodes) > LEAF) then
         call choose_cut(x, nodes, along, place)
         call split(graph, x, along, place, nodes, work, n_lower, n_upper)
      end if
      if (n_upper == 0 .or. n_upper == size(nodes)) then
         call add_part(parts, before + size(nodes, kind=ip))
         return
      end if
      lower = 0
      if (n_lower > 0) then
         call cut(graph, x, nodes(:n_lower), before, parts, work)
         lower = parts%n
      end if
      call cut(graph, x, nodes(n_lower + 1:n_lower + n_upper), before + n_lower, parts, work)
      upper = parts%n
      call add_part(parts, before + size(nodes, kind=ip))
      if (lower > 0) parts%parent(lower) = parts%n
      parts%parent(upper) = parts%n
   end subroutine cut

   !> Adds a part without a parent, which ends with a node of the list.
   pure subroutine add_part(parts, last)
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(in) :: last
      integer(ip), allocatable :: longer(:)

      if (parts%n == size(parts%last)) then
         allocate (longer(2*parts%n))
         longer(:parts%n) = parts%last
         call move_alloc(longer, parts%last)
         allocate (longer(2*parts%n))
         longer(:parts%n) = parts%parent
         call move_alloc(longer, parts%parent)
      end if
      parts%n = parts%n + 1
      parts%last(parts%n) = last
      parts%parent(parts%n) = 0
   end subroutine add_part

   !> Where to cut: across the longer side, a little above the median of a sample.
   pure subroutine choose_cut(x, nodes, along, place)
      real(wp), intent(in) :: x(:, :)
      integer(ip), intent(in), contiguous :: nodes(:)
      integer, intent(out) :: along              !< 1 or 2
      real(wp), intent(out) :: place             !< [L]
      real(wp) :: low(2), high(2), margin
      integer(ip) :: i

      low = x(:, nodes(1))
      high = low
      do i = 2, size(nodes, kind=ip)
         low = min(low, x(:, nodes(i)))
         high = max(high, x(:, nodes(i)))
      end do
      along = merge(1, 2, high(1) - low(1) >= high(2) - low(2))
      margin = ON_CUT*(high(along) - low(along))
      place = sample_median(x, along, nodes) + margin
      ! more than half of the nodes at the upper end: any cut between is better than none
      if (place >= high(along) - margin) place = 0.5_wp*low(along) + 0.5_wp*high(along)
   end subroutine choose_cut

   !> Median of coordinates of nodes taken at equal distances from the list.
   pure real(wp) function sample_median(x, along, nodes) result(median)
      real(wp), intent(in) :: x(:, :)
      integer, intent(in) :: along
      integer(ip), intent(in), contiguous :: nodes(:)
      real(wp) :: sorted(MOST_SAMPLES), next
      integer :: i, j, n

      n = min(MOST_SAMPLES, size(nodes))
      do i = 1, n
         next = x(along, nodes(1 + int((real(i, wp) - 0.5_wp)*real(size(nodes), wp)/real(n, wp))))
         do j = i - 1, 1, -1
            if (sorted(j) <= next) exit
            sorted(j + 1) = sorted(j)
         end do
         sorted(j + 1) = next
      end do
      median = sorted((n + 1)/2)
   end function sample_median

   !> Puts the nodes below the cut first, those above it next, the separator last. All stay where they are when there is none
   !> above it, or none below.
   pure subroutine split(graph, x, along, place, nodes, work, n_lower, n_upper)
      type(graph_t), intent(in) :: graph
      real(wp), intent(in) :: x(:, :)
      integer, intent(in) :: along
      real(wp), intent(in) :: place
      integer(ip), intent(inout), contiguous :: nodes(:)
      type(work_t), intent(inout) :: work
      integer(ip), intent(out) :: n_lower, n_upper
      integer(ip) :: i, node, n, n_separator

      work%cut = work%cut + 1
      n = size(nodes, kind=ip)
      n_lower = 0
      n_upper = 0
      do i = 1, n
         if (x(along, nodes(i)) <= place) cycle
         work%upper_of(nodes(i)) = work%cut
         n_upper = n_upper + 1
      end do
      if (n_upper == 0 .or. n_upper == n) return
      n_upper = 0
      n_separator = 0
      do i = 1, n
         node = nodes(i)
         if (work%upper_of(node) == work%cut) then
            n_upper = n_upper + 1
            work%buffer(n_upper) = node
         else if (touches(graph, node, work)) then
            work%buffer(n - n_separator) = node
            n_separator = n_separator + 1
         else
            n_lower = n_lower + 1
            nodes(n_lower) = node
         end if
      end do
      nodes(n_lower + 1:n_lower + n_upper) = work%buffer(:n_upper)
      nodes(n_lower + n_upper + 1:) = work%buffer(n:n - n_separator + 1:-1)
   end subroutine split

   !> Whether a node has a neighbour above the cut.
   pure logical function touches(graph, node, work)
      type(graph_t), intent(in) :: graph
      integer(ip), intent(in) :: node
      type(work_t), intent(in) :: work
      integer(ip) :: k

      touches = .false.
      do k = graph%xadj(node), graph%xadj(node + 1) - 1
         if (work%upper_of(graph%adjncy(k)) == work%cut) then
            touches = .true.
            return
         end if
      end do
   end function touches

end module atrito_dissection
