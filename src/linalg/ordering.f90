!> Node numbering for the profile: reverse Cuthill-McKee with the contact nodes last.
!>
!> Reference: A. George, J. W. H. Liu, Computer Solution of Large Sparse Positive Definite Systems, 1981, chapter 4.
!>
!> Two nodes are neighbours in the graph when they share an element. Cuthill and McKee number the graph in layers: a root, its
!> neighbours, their neighbours, and so on, within a layer in the order of the neighbours in the layer before, and of those of one
!> node the ones of low degree first. An edge joins nodes of one layer or of two that follow each other, so no column reaches back
!> over more than two layers: the bandwidth is at most the sum of the sizes of two of them. Long and narrow structures of layers are
!> wanted, which begin at a node at an end of the graph; a pseudo-peripheral node is found by going from the last layer back to the
!> first until that makes no more layers (find_peripheral_node).
!>
!> Reversing the numbers leaves the bandwidth as it is and never makes the profile longer (Liu and Sherman, SIAM J. Numer. Anal. 13
!> (1976) 198-213): a column then begins at the first of the neighbours in the next layer, not at that in the one before.
!>
!> The contact nodes are retained equations and have to come last. So they are the root, which the reversal puts to the end, all of
!> them in one layer: the layers approach the contact line from the far side of the body, and the rows that couple with the
!> retained equations are the last ones of the interior, which keeps the columns of the coupling short.
!>
!> A strip of three elements whose contact nodes are 4 and 8, in this order:
!>
!>     5 --- 6 --- 7 --- 8        layers:     8 4 | 3 7 | 2 6 | 1 5       3 before 7: of the same degree, the lower number
!>     |     |     |     |
!>     1 --- 2 --- 3 --- 4        reversed:   5 1   6 2   7 3   4 8
!>
!> In the new numbers no two neighbours are more than 3 apart (5 and 2 are numbers 1 and 4); in the old ones 1 and 6 are 5 apart.
module atrito_ordering
   use atrito_incidence, only: list_holders
   use atrito_joined_sets, only: find_lowest
   use atrito_kinds, only: ip, lp
   implicit none (type, external)
   private
   public :: graph_t, build_graph, order_contact_last, connected_components, mesh_components

   !> Which nodes share an element. Node itself left out.
   type :: graph_t
      integer(ip) :: n = 0                       !< nodes
      integer(ip), allocatable :: xadj(:)        !< (n + 1) neighbours of i are adjncy(xadj(i):xadj(i + 1) - 1)
      integer(ip), allocatable :: adjncy(:)      !< may be longer than they need
   end type graph_t

   !> A sequence of nodes being made, breadth first.
   type :: walk_t
      integer(ip), allocatable :: nodes(:)       !< (n)
      integer(ip) :: length = 0                  !< nodes in the walk, the first ones of `nodes`
      logical, allocatable :: seen(:)            !< (n)
   end type walk_t

contains

   !> Graph of a mesh, in time linear in the number of pairs of nodes within elements: for each node its elements, and of these the
   !> nodes that were not seen yet from it. Instead of emptying the marks for each node, a mark is the node from which one was seen
   !> last.
   subroutine build_graph(n, elements, graph)
      integer(ip), intent(in) :: n               !< nodes
      integer(ip), intent(in) :: elements(:, :)  !< (nodes per element, elements): 1..n, 0 beyond the count
      type(graph_t), intent(out) :: graph        !< neighbours of each node, once each
      integer(ip), allocatable :: start(:), list(:), last_seen_from(:)
      integer(ip) :: i, used, e, k, node

      call list_holders(n, elements, start, list)
      graph%n = n
      allocate (graph%xadj(n + 1), last_seen_from(n))
      ! a node shares an element with at most all others of each of its elements; what is not touched takes no memory
      allocate (graph%adjncy(size(list, kind=lp)*max(size(elements, 1) - 1, 0)))
      last_seen_from = 0
      used = 0
      do i = 1, n
         graph%xadj(i) = used + 1
         ! Appends the neighbours of node i.
         associate (around => list(start(i):start(i + 1) - 1))
            last_seen_from(i) = i
            do e = 1, size(around, kind=ip)
               do k = 1, size(elements, 1, kind=ip)
                  node = elements(k, around(e))
                  if (node == 0) exit
                  if (last_seen_from(node) == i) cycle
                  last_seen_from(node) = i
                  used = used + 1
                  graph%adjncy(used) = node
               end do
            end do
         end associate
      end do
      graph%xadj(n + 1) = used + 1
   end subroutine build_graph

   !> Numbers the connected components of a mesh from 1 in the order of their lowest nodes, without its graph.
   !>
   !> Sets of nodes are joined element by element, in a time that is as good as linear.
   pure subroutine mesh_components(n, elements, component, n_components)
      integer(ip), intent(in) :: n               !< nodes
      integer(ip), intent(in) :: elements(:, :)  !< (nodes per element, elements): 1..n, 0 beyond the count
      integer(ip), intent(out) :: component(:)   !< (n) 1..n_components; a node without element is one by itself
      integer(ip), intent(out) :: n_components   !< components, isolated nodes among them
      integer(ip) :: parent(n), e, k, i, one, other

      parent = [(i, i=1, n)]
      do e = 1, size(elements, 2, kind=ip)
         one = elements(1, e)
         call find_lowest(parent, one)
         do k = 2, size(elements, 1, kind=ip)
            if (elements(k, e) == 0) exit
            other = elements(k, e)
            call find_lowest(parent, other)
            parent(max(one, other)) = min(one, other)
            one = min(one, other)
         end do
      end do
      n_components = 0
      do i = 1, n                                ! a parent is lower than its children
         if (parent(i) == i) then
            n_components = n_components + 1
            component(i) = n_components
         else
            component(i) = component(parent(i))
         end if
      end do
   end subroutine mesh_components

   !> Reverse Cuthill-McKee numbering that ends with given nodes.
   !>
   !> The given nodes are the root level of the search, so that the rest is numbered in layers that approach them: their columns
   !> stay short. They stand in the walk from the last to the first, and the reversal at the end puts them in the order that is
   !> wanted. A component without any of them begins at a pseudo-peripheral node. Components follow one another: equations of two
   !> components have no entry in common, so nothing is gained or lost by their order. Time linear in the number of edges (and in
   !> last_nodes times the components that hold any) where no node has very many.
   pure subroutine order_contact_last(graph, last_nodes, order, connected)
      type(graph_t), intent(in) :: graph         !< neighbours of each node, as build_graph makes it
      integer(ip), intent(in) :: last_nodes(:)   !< distinct nodes, in the order wanted (along the chain); may be empty
      integer(ip), intent(out) :: order(:)       !< (n) order(k) = node at place k
      logical, intent(in), optional :: connected !< the graph is known to be one component; default .false.
      type(walk_t) :: walk, trial
      integer(ip), allocatable :: component(:)
      integer(ip) :: n_components, i, root
      logical, allocatable :: done(:)
      logical :: is_one

      is_one = .false.
      if (present(connected)) is_one = connected
      allocate (component(graph%n), source=1_ip)
      n_components = 1
      if (.not. is_one) call connected_components(graph, component, n_components)
      allocate (done(n_components))
      done = .false.
      call begin_walk(walk, graph%n)
      do i = size(last_nodes, kind=ip), 1, -1
         call visit(walk, last_nodes(i))
      end do
      do i = size(last_nodes, kind=ip), 1, -1
         if (done(component(last_nodes(i)))) cycle
         done(component(last_nodes(i))) = .true.
         call grow_layers(graph, pack(last_nodes, component(last_nodes) == component(last_nodes(i))), walk)
      end do
      do i = 1, graph%n
         if (done(component(i))) cycle
         done(component(i)) = .true.
         if (.not. allocated(trial%nodes)) call begin_walk(trial, graph%n)
         call find_peripheral_node(graph, i, trial, root)
         call visit(walk, root)
         call grow_layers(graph, [root], walk)
      end do
      order = walk%nodes(graph%n:1:-1)
   end subroutine order_contact_last

   !> Cuthill-McKee from the given roots, which are in the walk: those at the end of the list first. The walk itself is the queue:
   !> the neighbours of its next node are appended, so it is gone through layer by layer.
   pure subroutine grow_layers(graph, roots, walk)
      type(graph_t), intent(in) :: graph
      integer(ip), intent(in) :: roots(:)
      type(walk_t), intent(inout) :: walk
      integer(ip) :: i, next

      next = walk%length + 1
      do i = size(roots, kind=ip), 1, -1
         call visit_neighbours(graph, roots(i), walk)
      end do
      do while (next <= walk%length)
         call visit_neighbours(graph, walk%nodes(next), walk)
         next = next + 1
      end do
   end subroutine grow_layers

   !> A node from which the component has many layers (George and Liu): from the last layer take the node of least degree and
   !> look back, as long as that makes more layers.
   !>
   !> Of a strip the walk from any node ends at one of its ends, the walk from there at the other one: two or three walks do, each
   !> in time linear in the edges of the component. The number of layers rises with every repetition and is at most the number of
   !> nodes, so the loop ends. That no pair of nodes is farther apart is not proved, nor needed.
   pure subroutine find_peripheral_node(graph, node, trial, root)
      type(graph_t), intent(in) :: graph
      integer(ip), intent(in) :: node
      type(walk_t), intent(inout) :: trial
      integer(ip), intent(out) :: root
      integer(ip) :: far, layers, before

      call find_far_node(graph, node, trial, layers, far)
      do
         root = far
         before = layers
         call find_far_node(graph, root, trial, layers, far)
         if (layers <= before) exit
      end do
   end subroutine find_peripheral_node

   !> The number of layers seen from `root`, and the node of least degree in the last one: the fewer neighbours it has, the more
   !> likely it lies at an end of the graph. The trial walk is left empty, by taking back the marks of its nodes alone, so that
   !> small components of a large graph take little time.
   pure subroutine find_far_node(graph, root, trial, layers, far)
      type(graph_t), intent(in) :: graph
      integer(ip), intent(in) :: root
      type(walk_t), intent(inout) :: trial
      integer(ip), intent(out) :: layers, far
      integer(ip) :: i, first, last

      call visit(trial, root)
      layers = 0
      first = 1
      last = 0
      do while (last < trial%length)
         first = last + 1
         last = trial%length
         layers = layers + 1
         do i = first, last
            call visit_neighbours(graph, trial%nodes(i), trial)
         end do
      end do
      far = trial%nodes(first)
      do i = first, last
         if (degree(graph, trial%nodes(i)) < degree(graph, far)) far = trial%nodes(i)
      end do
      trial%seen(trial%nodes(:last)) = .false.
      trial%length = 0
   end subroutine find_far_node

   !> Numbers the connected components from 1 in the order of their lowest nodes: a walk from a node that nobody has seen reaches
   !> all of its component and nothing else. Time linear in the number of edges.
   pure subroutine connected_components(graph, component, n_components)
      type(graph_t), intent(in) :: graph         !< neighbours of each node, as build_graph makes it
      integer(ip), intent(out) :: component(:)   !< (n) 1..n_components
      integer(ip), intent(out) :: n_components   !< components, isolated nodes among them
      type(walk_t) :: walk
      integer(ip) :: i, first

      call begin_walk(walk, graph%n)
      n_components = 0
      do i = 1, graph%n
         if (walk%seen(i)) cycle
         n_components = n_components + 1
         first = walk%length + 1
         call visit(walk, i)
         call grow_layers(graph, [i], walk)
         component(walk%nodes(first:walk%length)) = n_components
      end do
   end subroutine connected_components

   !> An empty sequence; nobody has been seen.
   pure subroutine begin_walk(walk, n)
      type(walk_t), intent(out) :: walk
      integer(ip), intent(in) :: n

      allocate (walk%nodes(n), walk%seen(n))
      walk%seen = .false.
   end subroutine begin_walk

   !> Appends a node, unless it is there.
   pure subroutine visit(walk, node)
      type(walk_t), intent(inout) :: walk
      integer(ip), intent(in) :: node

      if (walk%seen(node)) return
      walk%seen(node) = .true.
      walk%length = walk%length + 1
      walk%nodes(walk%length) = node
   end subroutine visit

   !> Appends the neighbours that nobody has seen, those of lower degree first, of the same degree those of lower number.
   pure subroutine visit_neighbours(graph, node, walk)
      type(graph_t), intent(in) :: graph
      integer(ip), intent(in) :: node
      type(walk_t), intent(inout) :: walk
      integer(ip) :: k, first

      first = walk%length + 1
      do k = graph%xadj(node), graph%xadj(node + 1) - 1
         call visit(walk, graph%adjncy(k))
      end do
      if (walk%length > first) call sort_by_degree(graph, walk%nodes(first:walk%length))
   end subroutine visit_neighbours

   !> Shell's sort: by insertion where there are few. For each gap of the sequence 1, 4, 13, 40, ..., the largest first, the nodes
   !> that are so far apart are sorted among themselves; with the gap of 1 all of them are, and few have far to go by then.
   pure subroutine sort_by_degree(graph, nodes)
      type(graph_t), intent(in) :: graph
      integer(ip), intent(inout) :: nodes(:)
      integer(ip), parameter :: FACTOR = 3
      integer(ip) :: gap, i, k, node

      gap = 1
      do while (gap < size(nodes)/FACTOR)
         gap = FACTOR*gap + 1
      end do
      do while (gap > 0)
         do i = gap + 1, size(nodes, kind=ip)
            node = nodes(i)
            k = i
            do while (k > gap)
               associate (other => nodes(k - gap))
                  if (degree(graph, node) > degree(graph, other)) exit
                  if (degree(graph, node) == degree(graph, other) .and. node >= other) exit
               end associate
               nodes(k) = nodes(k - gap)
               k = k - gap
            end do
            nodes(k) = node
         end do
         gap = gap/FACTOR
      end do
   end subroutine sort_by_degree

   !> How many neighbours a node has.
   pure integer(ip) function degree(graph, node)
      type(graph_t), intent(in) :: graph
      integer(ip), intent(in) :: node

      degree = graph%xadj(node + 1) - graph%xadj(node)
   end function degree

end module atrito_ordering
