!> The points of a contact pair as constraints on the nodes of both sides. atrito_nodal_points and atrito_mortar_points make them;
!> what solves for their forces does not know which of the two did.
!>
!> Point j stands for a part of the slave surface: for its length l_j in averages, for its weight w_j = l_j times the thickness (or
!> 2 pi r) where stresses become forces, q_j = w_j p_j. With its unit normal n_j, out of the slave, and T_j, n_j turned by +90
!> degrees, its row is
!>
!>     N_j u = n_j . sum_k c_jk u_k,     T_j u = T_j . sum_k c_jk u_k
!>
!> over nodes k of both sides. The coefficients c_jk of the slave add up to 1, those of the master to -1, so a translation of both
!> bodies is nothing to a point, and the forces q_j c_jk n_j on the nodes are equal and opposite. The sides touch where
!> N_j u = s_j, the gap; contact asks for N_j u - s_j <= 0, p_j >= 0 and p_j (N_j u - s_j) = 0 (or = delta p_j).
!>
!> The rows are kept by their entries (compressed rows): those of point j are first(j) .. first(j + 1) - 1.
module atrito_points
   use atrito_growth, only: make_room
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: mesh_t
   implicit none (type, external)
   private
   public :: contact_points_t, sliding_t, terms_t, allocate_points, add_point, add_entries, add_term, drop_points, &
             insert_point

   !> A motion in which both sides of a pair slide along themselves (atrito_sliding_motions).
   type :: sliding_t
      logical :: exists = .false.                   !< a motion was found
      logical :: is_of_both = .true.                !< both sides slide along themselves; else one that is straight, or round
      logical :: meets_round = .false.              !< the other one is round then
      logical :: is_round = .false.                 !< a rotation about the centre; else a translation
      logical :: is_convex = .false.                !< of the side that it was found by: the centre lies inside its body
      real(wp) :: direction(2) = 0.0_wp             !< of a translation, unit vector
      real(wp) :: centre(2) = 0.0_wp                !< [L]
      real(wp) :: radius = 0.0_wp                   !< [L]
      real(wp) :: extent = 0.0_wp                   !< the radius, or the length of the straight side [L]
      real(wp) :: digit_error = 0.0_wp              !< to which its nodes are known [L]
   end type sliding_t

   !> The points of a pair as constraints: the relative displacement of point j is the sum over its entries k, from first(j) to
   !> first(j+1) - 1, of coefficient(k) u(entry(k)), of which the slave's are positive and the master's negative.
   type :: contact_points_t
      integer(ip) :: n = 0                          !< points
      integer(ip), allocatable :: node(:)           !< slave node of each point
      real(wp), allocatable :: x(:, :)              !< (2, n) [L]
      real(wp), allocatable :: s(:)                 !< arc length along the slave surface [L]
      real(wp), allocatable :: normal(:, :)         !< (2, n) outward unit normal of the slave
      real(wp), allocatable :: length(:)            !< quadrature weight [L]
      real(wp), allocatable :: weight(:)            !< quadrature weight times thickness [L^2]
      real(wp), allocatable :: gap(:)               !< initial distance s_j along the normal [L]; negative: overclosed
      real(wp), allocatable :: given_gap(:)         !< of the nodes given_node, or (1) of all, where *CLEARANCE gives them [L]
      integer(ip), allocatable :: given_node(:)     !< not allocated: given_gap is of all
      integer(ip), allocatable :: first(:)          !< (n + 1) of the entries of each point, the slave's before the master's
      integer(ip), allocatable :: entry(:)          !< nodes
      real(wp), allocatable :: coefficient(:)       !< (entries) share of the entry's displacement
      integer(ip) :: n_faces = 0, n_left_out = 0    !< slave faces; those of them that find no master
      integer(ip) :: n_seeing = 0                   !< NODAL, where all are left out: those that see it with a part of them
      integer(lp), allocatable :: faces(:)          !< a number of its own for each of the slave's faces that are not left out
      integer(ip), allocatable :: piece(:)          !< of the master, that are seen; some more than once
      real(wp), allocatable :: doubt(:)             !< (n) by what the normals may be off [rad]; not allocated: round-off
      logical, allocatable :: is_held(:, :)         !< (2, n) supports hold all nodes of a row along the normal, along the tangent
      type(sliding_t) :: sliding                    !< that both sides have, if they have one
      logical :: matching = .false.                 !< every point faces a master node and the orders are equal
      logical :: rigid = .false.                    !< the master does not deform: it has no entries
      logical :: is_mortar = .false.                !< of MORTAR: means over the faces; else at nodes
      real(wp) :: coarseness = 0.0_wp               !< NODAL: largest distance of slave nodes over that of the master's there
      integer(ip) :: coarse_node = 0                !< where
   end type contact_points_t

   !> Terms of the rows of points in any order, several of one node among them: what integrals over faces give one after the other.
   type :: terms_t
      integer(ip) :: n = 0                          !< terms
      integer(ip), allocatable :: point(:)          !< (n or more)
      integer(ip), allocatable :: node(:)           !< (n or more) a node, or a point whose row takes part
      real(wp), allocatable :: value(:)             !< (n or more) coefficient times weight [L^2]
   end type terms_t

contains

   !> Room for points without entries. Lengths, weights, normals and gaps begin at 0: faces add to them.
   pure subroutine allocate_points(most, most_entries, points)
      integer(ip), intent(in) :: most, most_entries  !< points and entries at the most
      type(contact_points_t), intent(inout) :: points !< n = 0 in

      allocate (points%node(most), source=0_ip)
      allocate (points%first(most + 1), source=1_ip)
      allocate (points%entry(most_entries), points%coefficient(most_entries))
      allocate (points%x(2, most), points%s(most), points%normal(2, most), points%length(most), points%weight(most), &
                points%gap(most), source=0.0_wp)
   end subroutine allocate_points

   !> The point of a node, which is made when it is new: faces that share a node share its point.
   pure subroutine add_point(mesh, node, s, points, place, j)
      type(mesh_t), intent(in) :: mesh !< where the node lies
      integer(ip), intent(in) :: node  !< of the slave
      real(wp), intent(in) :: s        !< arc length along the slave surface [L]
      type(contact_points_t), intent(inout) :: points !< with a point more, if the node is new
      type(id_map_t), intent(inout) :: place          !< of the points of nodes
      integer(ip), intent(out) :: j                   !< the node's point
      logical :: known

      call add_id(place, node, points%n + 1, known)
      j = find_id(place, node)
      if (known) return
      points%n = points%n + 1
      points%node(points%n) = node
      points%x(:, points%n) = mesh%x(:, node)
      points%s(points%n) = s
   end subroutine add_point

   !> Appends to the entries of the last point so far those that are not 0; points get their entries one after the other.
   pure subroutine add_entries(nodes, coefficients, i, points)
      integer(ip), intent(in) :: nodes(:) !< of the row
      real(wp), intent(in) :: coefficients(:)       !< (nodes) those that are 0 are left out
      integer(ip), intent(in) :: i                  !< the point
      type(contact_points_t), intent(inout) :: points !< with the entries of point i
      integer(ip) :: k

      associate (next => points%first(i + 1))
         do k = 1, size(nodes, kind=ip)
            if (coefficients(k) == 0.0_wp) cycle
            points%entry(next) = nodes(k)
            points%coefficient(next) = coefficients(k)
            next = next + 1
         end do
      end associate
   end subroutine add_entries

   !> Appends a term to a list; the list grows by doubling.
   pure subroutine add_term(point, node, value, terms)
      integer(ip), intent(in) :: point, node        !< 1.. both
      real(wp), intent(in) :: value                 !< [L^2]
      type(terms_t), intent(inout) :: terms         !< with a term more

      call make_room(terms%point, terms%n, terms%n + 1)
      call make_room(terms%node, terms%n, terms%n + 1)
      call make_room(terms%value, terms%n, terms%n + 1)
      terms%n = terms%n + 1
      terms%point(terms%n) = point
      terms%node(terms%n) = node
      terms%value(terms%n) = value
   end subroutine add_term

   !> Takes away the points of some nodes, and gives back what was allocated for more points and entries.
   pure subroutine drop_points(nodes, points)
      integer(ip), intent(in) :: nodes(:)           !< 0: none
      type(contact_points_t), intent(inout) :: points !< the rest keep their order
      integer(ip) :: i

      call take_points(pack([(i, i=1, points%n)], [(.not. any(nodes == points%node(i)), i=1, points%n)]), points)
   end subroutine drop_points

   !> Puts a point behind those that lie before it along the slave.
   pure subroutine insert_point(one, points)
      type(contact_points_t), intent(in) :: one      !< n = 1
      type(contact_points_t), intent(inout) :: points
      integer(ip) :: before, i

      associate (n => points%n, last => points%first(points%n + 1) - 1)
         points%entry = [points%entry(:last), one%entry(:one%first(2) - 1)]
         points%coefficient = [points%coefficient(:last), one%coefficient(:one%first(2) - 1)]
         points%first = [points%first(:n + 1), last + one%first(2)]
         points%node = [points%node(:n), one%node]
         points%x = reshape([points%x(:, :n), one%x], [2_ip, n + 1])
         points%s = [points%s(:n), one%s]
         points%normal = reshape([points%normal(:, :n), one%normal], [2_ip, n + 1])
         points%length = [points%length(:n), one%length]
         points%weight = [points%weight(:n), one%weight]
         points%gap = [points%gap(:n), one%gap]
         if (allocated(points%doubt)) points%doubt = [points%doubt(:n), one%doubt]
         before = count(points%s(:n) <= one%s(1), kind=ip)
      end associate
      points%n = points%n + 1
      call take_points([[(i, i=1, before)], points%n, [(i, i=before + 1, points%n - 1)]], points)
   end subroutine insert_point

   !> Keeps the points of a list, in its order.
   pure subroutine take_points(list, points)
      integer(ip), intent(in) :: list(:)
      type(contact_points_t), intent(inout) :: points
      integer(ip), allocatable :: entries(:)
      integer(ip) :: i, k

      entries = [((k, k=points%first(list(i)), points%first(list(i) + 1) - 1), i=1, size(list, kind=ip))]
      points%entry = points%entry(entries)
      points%coefficient = points%coefficient(entries)
      entries = [1_ip, points%first(list + 1) - points%first(list)]      ! from numbers of entries to the first of each point
      do i = 1, size(list, kind=ip)
         entries(i + 1) = entries(i) + entries(i + 1)
      end do
      points%first = entries
      points%n = size(list, kind=ip)
      points%node = points%node(list)
      points%x = points%x(:, list)
      points%s = points%s(list)
      points%normal = points%normal(:, list)
      points%length = points%length(list)
      points%weight = points%weight(list)
      points%gap = points%gap(list)
      if (allocated(points%doubt)) points%doubt = points%doubt(list)
   end subroutine take_points

end module atrito_points
