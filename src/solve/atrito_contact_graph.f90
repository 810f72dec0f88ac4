!> The contact graph: what is shared out to ranks, bodies or pieces of them, and how much each two have in common: contact points,
!> bilateral rows, nodes of a cut. Shares of it of equal work.
module atrito_contact_graph
   use atrito_contact_rows, only: contact_rows_t
   use atrito_growth, only: make_room
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, wp
   use atrito_multifrontal, only: share_graph
   implicit none (type, external)
   private
   public :: contact_graph_t, begin_contact_graph, add_edge, add_rows, close_contact_graph, share_vertices, add_greedily, unevenness

   type :: contact_graph_t
      integer(ip) :: n = 0                       !< vertices
      integer(ip), allocatable :: first(:)       !< (n + 1) neighbours of i: neighbour(first(i):first(i + 1) - 1)
      integer(ip), allocatable :: neighbour(:), weight(:) !< and what they have in common, >= 1
      integer(ip) :: n_edges = 0                 !< until closed, one by one
      integer(ip), allocatable :: one(:), other(:)
   end type contact_graph_t

   !> The works of METIS are whole numbers of this sum, nearly.
   real(wp), parameter :: SUM_OF_WEIGHTS = 1.0e6_wp
   !> A share that METIS makes is even when no rank has more than this over the mean.
   real(wp), parameter :: EVEN = 1.1_wp

contains

   pure subroutine begin_contact_graph(n, graph)
      integer(ip), intent(in) :: n
      type(contact_graph_t), intent(out) :: graph

      graph%n = n
      allocate (graph%one(n), graph%other(n))
   end subroutine begin_contact_graph

   !> Two vertices have one more thing in common; nothing where one of them is 0, or both are the same.
   pure subroutine add_edge(one, other, graph)
      integer(ip), intent(in) :: one, other
      type(contact_graph_t), intent(inout) :: graph

      if (one == other .or. one == 0 .or. other == 0) return
      call make_room(graph%one, graph%n_edges, graph%n_edges + 2)
      call make_room(graph%other, graph%n_edges, graph%n_edges + 2)
      graph%one(graph%n_edges + 1:graph%n_edges + 2) = [one, other]
      graph%other(graph%n_edges + 1:graph%n_edges + 2) = [other, one]
      graph%n_edges = graph%n_edges + 2
   end subroutine add_edge

   !> The contact points and bilateral rows: the vertex of the first entry with those of the others.
   pure subroutine add_rows(rows, vertex_of, graph)
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: vertex_of(:)    !< (nodes) 0: of none
      type(contact_graph_t), intent(inout) :: graph
      integer(ip) :: j, k, before

      do j = 1, rows%n
         before = vertex_of(rows%node(rows%first(j)))
         do k = rows%first(j) + 1, rows%first(j + 1) - 1
            if (vertex_of(rows%node(k)) == before) cycle
            before = vertex_of(rows%node(k))
            call add_edge(vertex_of(rows%node(rows%first(j))), before, graph)
         end do
      end do
   end subroutine add_rows

   !> Sums the edges of each two vertices.
   subroutine close_contact_graph(graph)
      type(contact_graph_t), intent(inout) :: graph
      integer(ip), allocatable :: first(:), edge(:)
      integer(ip) :: seen(graph%n), i, k, n

      call list_holders(graph%n, reshape(graph%one(:graph%n_edges), [1, int(graph%n_edges)]), first, edge)
      allocate (graph%first(graph%n + 1), graph%neighbour(graph%n_edges), graph%weight(graph%n_edges))
      seen = 0
      n = 0
      do i = 1, graph%n
         graph%first(i) = n + 1
         do k = first(i), first(i + 1) - 1
            associate (other => graph%other(edge(k)))
               if (seen(other) < graph%first(i)) then
                  n = n + 1
                  graph%neighbour(n) = other
                  graph%weight(n) = 0
                  seen(other) = n
               end if
               graph%weight(seen(other)) = graph%weight(seen(other)) + 1
            end associate
         end do
      end do
      graph%first(graph%n + 1) = n + 1
      graph%neighbour = graph%neighbour(:n)
      graph%weight = graph%weight(:n)
   end subroutine close_contact_graph

   !> The rank of each vertex, from 1 on: by METIS, what has much in common on one rank; or greedily, where that is more even.
   subroutine share_vertices(graph, work, n_ranks, rank_of)
      type(contact_graph_t), intent(in) :: graph
      real(wp), intent(in) :: work(:)            !< (n) >= 0
      integer(ip), intent(in) :: n_ranks
      integer(ip), intent(out) :: rank_of(:)        !< (n) 1..n_ranks
      integer(ip) :: greedy(size(work))
      real(wp) :: load(n_ranks)
      logical :: done

      load = 0.0_wp
      call add_greedily(work, load, greedy)
      rank_of = greedy
      if (n_ranks == 1 .or. graph%n <= n_ranks) return
      call share_graph(graph%first, graph%neighbour, max(1_ip, int(SUM_OF_WEIGHTS*work/sum(work), ip)), graph%weight, n_ranks, &
                       rank_of, done)
      if (done) done = unevenness(work, rank_of, n_ranks) <= max(EVEN, unevenness(work, greedy, n_ranks))
      if (.not. done) rank_of = greedy
   end subroutine share_vertices

   !> Gives the heavier vertices first, in classes of powers of two, each to the rank that has least by then.
   pure subroutine add_greedily(work, load, rank_of)
      real(wp), intent(in) :: work(:)            !< (n) >= 0
      real(wp), intent(inout) :: load(:)         !< (ranks)
      integer(ip), intent(out) :: rank_of(:)        !< (n) 1..size(load)
      integer(ip) :: magnitude(size(work)), m, i

      magnitude = exponent(work)
      do m = maxval(magnitude), minval(magnitude), -1_ip
         do i = 1, size(work, kind=ip)
            if (magnitude(i) /= m) cycle
            rank_of(i) = minloc(load, dim=1, kind=ip)
            load(rank_of(i)) = load(rank_of(i)) + work(i)
         end do
      end do
   end subroutine add_greedily

   !> The largest work of a rank over the mean.
   pure real(wp) function unevenness(work, rank_of, n_ranks)
      real(wp), intent(in) :: work(:)
      integer(ip), intent(in) :: rank_of(:)         !< 1..n_ranks
      integer(ip), intent(in) :: n_ranks
      real(wp) :: load(n_ranks)
      integer(ip) :: i

      load = 0.0_wp
      do i = 1, size(work, kind=ip)
         load(rank_of(i)) = load(rank_of(i)) + work(i)
      end do
      unevenness = maxval(load)*real(n_ranks, wp)/max(sum(load), tiny(1.0_wp))
   end function unevenness

end module atrito_contact_graph
