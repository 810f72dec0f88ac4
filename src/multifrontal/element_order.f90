!> The order of elimination for the sparse solver: which dissection of the elements costs least.
!>
!> By the places of the elements first: across the axes, or across the direction that the elements have in common. What its
!> separators cost is known before anything is factored. Where that is more than METIS would save, the elements are cut by
!> METIS in place of their places: graded meshes, and flat elements that lie in no direction in particular. Where the mesh is
!> irregular and large, elements at the cuts change sides (atrito_cut_refinement).
module atrito_element_order
   use atrito_compact_mesh, only: compact_mesh_t, compact
   use atrito_cut_refinement, only: list_corners
   use atrito_dissection, only: dissect, dissection_t, dissection_guide_t, sample_place
   use atrito_element_clusters, only: cluster_t, join_elements, link_clusters
   use atrito_kinds, only: ip, wp
   use atrito_metis, only: halve_graph
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: order_elements

   !> Fewer elements are cut by their places.
   integer(ip), parameter :: LEAST = 2000_ip
   !> Operations of a factorisation for each unit of a dissection's work, with two equations a node; measured, as all below.
   real(wp), parameter :: OPERATIONS = 65.0_wp
   !> Work of METIS's cuts over that of a regular mesh.
   real(wp), parameter :: METIS_SHARE = 1.45_wp
   !> Work that is left when elements that lie irregularly were moved: cuts by the centres of triangles go to and fro. The least.
   real(wp), parameter :: REFINED_QUADRILATERALS = 0.9_wp, REFINED_TRIANGLES = 0.5_wp, BEST_REFINED = 0.3_wp
   !> What ordering takes for each element, in operations of the factorisation.
   real(wp), parameter :: METIS_COST = 16000.0_wp, REFINING_COST = 6000.0_wp
   !> Elements are joined to clusters of 2**ROUNDS, and sets of no more than so many elements are cut by their places.
   integer, parameter :: ROUNDS = 3
   real(wp), parameter :: METIS_LEAF = 256.0_wp
   !> Thousandths by which a part may be heavier than the mean.
   integer(ip), parameter :: IMBALANCE = 50_ip
   !> Elements that are looked at for their direction and their likeness.
   integer(ip), parameter :: MOST_SAMPLES = 1000_ip
   !> Elements have a direction in common when the mean of exp(4 i angle) of their sides is at least so large, and it counts when it
   !> is this far [rad] from an axis.
   real(wp), parameter :: IN_COMMON = 0.9_wp, LEAST_ANGLE = 0.01_wp
   !> Extents are the same that differ by no more than this share.
   real(wp), parameter :: SAME = 1.0e-6_wp

contains

   !> Orders the wanted nodes of some elements.
   !>
   !> All is told in operations of the factorisation: OPERATIONS for each unit of the sum of (nodes of a separator)^3, plus what
   !> ordering itself takes for each element.
   !>
   !>     1. by the places of the elements: that is what small meshes get, and all those whose separators are short
   !>     2. the same with elements that change sides at the cuts, if the mesh is irregular, what that saves is more than it
   !>        takes, and what may come of it is less than METIS would leave
   !>     3. cuts by METIS of a graph of clusters of up to 2^ROUNDS elements, refined, if less is expected of that than there is
   !>
   !> Each of them is taken if its own separators have less work than those before: a prediction that was wrong costs time, not
   !> work. What METIS would come to is told from separators of a square of a regular mesh (regular_work), METIS_SHARE times them.
   subroutine order_elements(elements, nodes, n_nodes_of, x, wanted, parts, text)
      integer(ip), intent(in) :: elements(:)             !< which
      integer(ip), intent(in) :: nodes(:, :)             !< (most nodes, all elements)
      integer(ip), intent(in) :: n_nodes_of(:) !< (all elements) nodes of each; the first four or all stand for its corners
      real(wp), intent(in) :: x(:, :)                    !< (2, all nodes) [L]
      logical, intent(in) :: wanted(:)                   !< (all nodes); those that are belong to the elements
      type(dissection_t), intent(out) :: parts           !< of the dissection that was chosen
      character(len=:), allocatable, intent(out) :: text !< how, for the listing
      type(dissection_guide_t) :: guide
      type(compact_mesh_t) :: mesh
      real(wp) :: angle, by_metis, by_places, takes
      logical :: refines

      call find_direction(angle)
      guide%cosine = cos(angle)
      guide%sine = sin(angle)
      call dissect(elements, nodes, n_nodes_of, x, wanted, guide, parts)
      text = 'by places'
      if (abs(angle) > 0.0_wp) text = text//', turned by '//to_text(angle*45.0_wp/atan(1.0_wp), 3)//' degrees'
      if (size(elements) < LEAST) return
      by_places = parts%work
      by_metis = METIS_SHARE*OPERATIONS*parts%regular_work + METIS_COST*real(size(elements), wp)
      ! moving elements at the cuts is expected to save more than it takes, and may come to less than METIS
      takes = REFINING_COST*real(size(elements), wp)
      refines = takes < (1.0_wp - expected_share(elements, n_nodes_of))*OPERATIONS*parts%work .and. &
                takes + BEST_REFINED*OPERATIONS*parts%work < by_metis
      if (refines) refines = are_irregular(elements, nodes, x)
      if (.not. refines .and. by_metis >= OPERATIONS*by_places) return
      call compact(parts%element, nodes, n_nodes_of, x, wanted, mesh)
      guide%refines = .true.
      call list_corners(mesh%list, mesh%nodes, mesh%n_nodes_of, size(mesh%node, kind=ip), guide%lists)
      if (refines) call dissect_again(text//', refined')
      if (by_metis >= OPERATIONS*parts%work) return
      call halve_elements(mesh%list, guide)
      if (allocated(guide%half)) call dissect_again('by METIS')

   contains

      !> Another dissection by another guide, where that has less work.
      subroutine dissect_again(how)
         character(len=*), intent(in) :: how
         type(dissection_t) :: other

         call dissect(mesh%list, mesh%nodes, mesh%n_nodes_of, mesh%x, mesh%wanted, guide, other)
         if (other%work >= parts%work) return
         text = how//', predicted operations '//to_text(other%work/by_places, 2)//' of those by places'
         parts = other
         parts%order = mesh%node(other%order)
      end subroutine dissect_again

      !> The angle that the sides of the elements have in common, or that less a right one; 0: none that counts.
      !>
      !> exp(4 i angle) of a side is the same for all four sides of a square, and for the two ways to go along it. So the sum over
      !> a sample of elements is as long as it can be where all are turned alike, and short where they lie in all directions; a
      !> quarter of its angle is the direction.
      pure subroutine find_direction(angle)
         real(wp), intent(out) :: angle             !< [rad] -pi/4 to pi/4
         integer(ip) :: i, n
         complex(wp) :: total, side

         n = min(MOST_SAMPLES, size(elements, kind=ip))
         total = 0.0_wp
         do i = 1, n
            associate (corner => nodes(:2, elements(sample_place(i, n, size(elements, kind=ip)))))
               side = cmplx(x(1, corner(2)) - x(1, corner(1)), x(2, corner(2)) - x(2, corner(1)), wp)
               if (abs(side) > 0.0_wp) total = total + (side/abs(side))**4
            end associate
         end do
         angle = 0.0_wp
         if (abs(total) < IN_COMMON*real(n, wp) .or. n == 0) return
         angle = 0.25_wp*atan2(total%im, total%re)
         if (abs(angle) < LEAST_ANGLE) angle = 0.0_wp
      end subroutine find_direction

   end subroutine order_elements

   !> The share of the work that is left when elements were moved, from what a sample of them has for corners.
   pure real(wp) function expected_share(elements, n_nodes_of) result(share)
      integer(ip), intent(in) :: elements(:), n_nodes_of(:)
      integer(ip) :: i, n, n_triangles

      n = min(MOST_SAMPLES, size(elements, kind=ip))
      n_triangles = 0
      do i = 1, n
         associate (n_nodes => n_nodes_of(elements(sample_place(i, n, size(elements, kind=ip)))))
            if (n_nodes == 3 .or. n_nodes == 6) n_triangles = n_triangles + 1
         end associate
      end do
      share = REFINED_QUADRILATERALS + (REFINED_TRIANGLES - REFINED_QUADRILATERALS)*real(n_triangles, wp)/real(n, wp)
   end function expected_share

   !> Halves, halves of these and so on, by METIS.
   subroutine halve_elements(list, guide)
      integer(ip), intent(in) :: list(:)
      type(dissection_guide_t), intent(inout) :: guide !< halves are on return, where METIS found them
      type(cluster_t) :: clusters
      integer(ip), allocatable :: half(:)
      logical :: done

      call join_elements(guide%lists, list, ROUNDS, clusters)
      call link_clusters(guide%lists, clusters)
      guide%n_halvings = max(1, nint(log(real(size(list), wp)/METIS_LEAF)/log(2.0_wp)))
      allocate (half(clusters%n))
      call halve_graph(clusters%first, clusters%neighbour, clusters%weight, clusters%shared, guide%n_halvings, &
                       IMBALANCE, half, done)
      if (done) guide%half = half(clusters%of_element)
   end subroutine halve_elements

   !> Most elements have not one extent in common with the next one.
   pure logical function are_irregular(elements, nodes, x)
      integer(ip), intent(in) :: elements(:), nodes(:, :)
      real(wp), intent(in) :: x(:, :)
      integer(ip) :: i, n, n_different
      real(wp) :: a(2), b(2)

      n = min(MOST_SAMPLES, size(elements, kind=ip) - 1_ip)
      n_different = 0
      do i = 1, n
         associate (at => sample_place(i, n, size(elements, kind=ip) - 1_ip))
            a = extent(elements(at))
            b = extent(elements(at + 1))
         end associate
         if (all(abs(a - b) > SAME*a)) n_different = n_different + 1
      end do
      are_irregular = 2*n_different > n

   contains

      pure function extent(e)
         integer(ip), intent(in) :: e
         real(wp) :: extent(2)
         integer(ip) :: last

         last = nodes(4, e)
         if (last == 0) last = nodes(1, e)       ! three nodes
         extent = abs(x(:, nodes(1, e)) - x(:, nodes(3, e))) + abs(x(:, nodes(2, e)) - x(:, last))
      end function extent

   end function are_irregular

end module atrito_element_order
