!> Clusters of neighbouring elements, and their graph.
!>
!> Elements are joined in pairs, these in pairs again: each takes the neighbour with which it shares most nodes, so that clusters
!> are compact, whatever the shapes and sizes of the elements. Two clusters are neighbours when they have nodes in common, and the
!> edge between them weighs as many: what a cut through the graph weighs is the separator of the nodes, nearly.
module atrito_element_clusters
   use atrito_cut_refinement, only: corner_lists_t, CORNERS
   use atrito_growth, only: grow
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, lp
   implicit none (type, external)
   private
   public :: cluster_t, join_elements, link_clusters

   !> A graph of clusters.
   type :: cluster_t
      integer(ip) :: n = 0                                !< clusters
      integer(ip), allocatable :: of_element(:)           !< (all elements) 0: not in the list
      integer(ip), allocatable :: weight(:)               !< (n) elements
      integer(ip), allocatable :: first(:)                !< (n + 1) neighbours: neighbour(first(i):first(i + 1) - 1)
      integer(ip), allocatable :: neighbour(:), shared(:) !< and the nodes in common
   end type cluster_t

   !> The neighbours of a cluster, and what it has in common with each.
   type :: tally_t
      integer(ip) :: n = 0                       !< clusters in the list
      integer(ip), allocatable :: list(:)        !< (clusters) the first n
      integer(ip), allocatable :: times(:)       !< (clusters) 0: not in the list
   end type tally_t

contains

   !> Joins elements to clusters of 2**n_rounds at most.
   !>
   !> A round halves the number of clusters, nearly: what finds no partner stays alone. The work of METIS goes with the number of
   !> vertices, so three rounds save most of it, and what they give away is little: elements of a cluster mostly share sides, and a
   !> cut through the middle of a cluster is at most an element away from one round it.
   !>
   !> An element counts for a neighbour as many nodes as both have, each of them for each element of the neighbour, so a side in
   !> common (two nodes) counts more than a corner, and a neighbour round two sides more than one at a single side.
   subroutine join_elements(lists, elements, n_rounds, clusters)
      type(corner_lists_t), intent(in) :: lists !< corners of these elements at least
      integer(ip), intent(in) :: elements(:)    !< distinct ones
      integer, intent(in) :: n_rounds           !< >= 0; each may double a cluster
      type(cluster_t), intent(out) :: clusters  !< `n` and `of_element` alone; link_clusters finds the others
      integer(ip) :: i
      integer :: round

      clusters%n = size(elements, kind=ip)
      allocate (clusters%of_element(size(lists%corner, 2)), source=0_ip)
      clusters%of_element(elements) = [(i, i=1, clusters%n)]
      do round = 1, n_rounds
         call join_pairs(lists, clusters)
      end do
   end subroutine join_elements

   !> Each cluster joins the neighbour with which its elements share most nodes, of those that are alone as yet.
   subroutine join_pairs(lists, clusters)
      type(corner_lists_t), intent(in) :: lists
      type(cluster_t), intent(inout) :: clusters
      integer(ip), allocatable :: first(:), element(:), partner(:)
      type(tally_t) :: tally
      integer(ip) :: c, i, best

      call list_holders(clusters%n, reshape(clusters%of_element, [1, size(clusters%of_element)]), first, element)
      call begin_tally(clusters%n, tally)
      allocate (partner(clusters%n), source=0_ip)
      do c = 1, clusters%n
         if (partner(c) /= 0) cycle
         do i = first(c), first(c + 1) - 1
            call count_neighbours(lists, clusters%of_element, partner, c, element(i), tally)
         end do
         best = c                                ! the first of those that were counted most often, if there is one
         if (tally%n > 0) best = tally%list(maxloc(tally%times(tally%list(:tally%n)), dim=1))
         call clear_tally(tally)
         partner(c) = best
         partner(best) = c
      end do
      call number_pairs(partner, clusters)
   end subroutine join_pairs

   pure subroutine begin_tally(n, tally)
      integer(ip), intent(in) :: n
      type(tally_t), intent(out) :: tally

      allocate (tally%list(n))
      allocate (tally%times(n), source=0_ip)
   end subroutine begin_tally

   pure subroutine add_one(cluster, tally)
      integer(ip), intent(in) :: cluster
      type(tally_t), intent(inout) :: tally

      if (tally%times(cluster) == 0) then
         tally%n = tally%n + 1
         tally%list(tally%n) = cluster
      end if
      tally%times(cluster) = tally%times(cluster) + 1
   end subroutine add_one

   pure subroutine clear_tally(tally)
      type(tally_t), intent(inout) :: tally

      tally%times(tally%list(:tally%n)) = 0
      tally%n = 0
   end subroutine clear_tally

   !> Counts the nodes that an element of cluster c shares with each element of others that have no partner.
   pure subroutine count_neighbours(lists, of_element, partner, c, e, tally)
      type(corner_lists_t), intent(in) :: lists
      integer(ip), intent(in) :: of_element(:), partner(:), c, e
      type(tally_t), intent(inout) :: tally
      integer(ip) :: k, h, v, other

      do k = 1, CORNERS
         v = lists%corner(k, e)
         if (v == 0) return
         do h = lists%first(v), lists%first(v + 1) - 1
            other = of_element(lists%element(h))
            if (other == c) cycle
            if (partner(other) == 0) call add_one(other, tally)
         end do
      end do
   end subroutine count_neighbours

   !> Numbers the pairs in the order of their first members.
   pure subroutine number_pairs(partner, clusters)
      integer(ip), intent(inout) :: partner(:)   !< becomes the number
      type(cluster_t), intent(inout) :: clusters
      integer(ip) :: c, n, e

      n = 0
      do c = 1, clusters%n
         if (partner(c) < c) then
            partner(c) = partner(partner(c))
         else
            n = n + 1
            partner(c) = n
         end if
      end do
      do e = 1, size(clusters%of_element, kind=ip)
         if (clusters%of_element(e) > 0) clusters%of_element(e) = partner(clusters%of_element(e))
      end do
      clusters%n = n
   end subroutine number_pairs

   !> Finds the neighbours of the clusters and how many nodes they share.
   subroutine link_clusters(lists, clusters)
      type(corner_lists_t), intent(in) :: lists  !< as for join_elements
      type(cluster_t), intent(inout) :: clusters !< from join_elements; gets weights and neighbours
      integer(ip), allocatable :: first(:), element(:), seen(:)
      type(tally_t) :: tally
      integer(ip) :: c, i, n

      call list_holders(clusters%n, reshape(clusters%of_element, [1, size(clusters%of_element)]), first, element)
      call begin_tally(clusters%n, tally)
      clusters%weight = first(2:) - first(:clusters%n)
      allocate (seen(size(lists%first) - 1), source=0_ip)
      allocate (clusters%first(clusters%n + 1), clusters%neighbour(8*clusters%n), clusters%shared(8*clusters%n))
      clusters%first(1) = 1
      do c = 1, clusters%n
         do i = first(c), first(c + 1) - 1
            call count_shared_nodes(lists, clusters%of_element, c, element(i), seen, tally)
         end do
         n = clusters%first(c)
         if (n + tally%n > size(clusters%neighbour)) then
            call grow(clusters%neighbour, 2*int(n + tally%n, lp))
            call grow(clusters%shared, 2*int(n + tally%n, lp))
         end if
         clusters%neighbour(n:n + tally%n - 1) = tally%list(:tally%n)
         clusters%shared(n:n + tally%n - 1) = tally%times(tally%list(:tally%n))
         clusters%first(c + 1) = n + tally%n
         call clear_tally(tally)
      end do
   end subroutine link_clusters

   !> Counts the nodes of an element that cluster c shares with others, each node once.
   pure subroutine count_shared_nodes(lists, of_element, c, e, seen, tally)
      type(corner_lists_t), intent(in) :: lists
      integer(ip), intent(in) :: of_element(:), c, e
      integer(ip), intent(inout) :: seen(:)      !< (nodes) the last cluster that counted it
      type(tally_t), intent(inout) :: tally
      integer(ip) :: k, h, v, other

      do k = 1, CORNERS
         v = lists%corner(k, e)
         if (v == 0) return
         if (seen(v) == c) cycle
         seen(v) = c
         do h = lists%first(v), lists%first(v + 1) - 1
            other = of_element(lists%element(h))
            if (other == c) cycle
            if (any(of_element(lists%element(lists%first(v):h - 1)) == other)) cycle
            call add_one(other, tally)
         end do
      end do
   end subroutine count_shared_nodes

end module atrito_element_clusters
