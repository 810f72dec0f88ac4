!> Quadrature points of a contact pair: where they lie, what they weigh, what they face.
!>
!> NODAL quadrature, as in the paper: the points are the slave's nodes, trapezoidal for Q1 and Simpson for Q2. Each looks along
!> the slave's normal for the master, element faces or rigid segments.
module atrito_points
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_mesh, only: mesh_t, face_nodes
   use atrito_faces, only: face_list_t, face_length, face_normal
   use atrito_shape_functions, only: face_shape_values
   implicit none (type, external)
   private
   public :: contact_points_t, pair_surfaces

   integer(ip), parameter, public :: MOST_MASTER_NODES = 3

   type :: contact_points_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: node(:)           !< slave node of each point
      real(wp), allocatable :: x(:, :)              !< (2, n) [L]
      real(wp), allocatable :: s(:)                 !< arc length along the slave surface [L]
      real(wp), allocatable :: normal(:, :)         !< (2, n) outward unit normal of the slave
      real(wp), allocatable :: length(:)            !< quadrature weight [L]
      real(wp), allocatable :: weight(:)            !< quadrature weight times thickness [L^2]
      real(wp), allocatable :: gap(:)               !< initial distance s_j along the normal [L]; negative: overclosed
      integer(ip), allocatable :: n_master(:)       !< nodes of the master face; 0: rigid
      integer(ip), allocatable :: master_node(:, :) !< (3, n)
      real(wp), allocatable :: master_shape(:, :)   !< (3, n)
      integer(ip) :: n_faces = 0, n_left_out = 0    !< slave faces; those of them that find no master
      logical :: matching = .false.                 !< every point faces a master node and the orders are equal
      logical :: rigid = .false.
   end type contact_points_t

   !> The master as a list of straight pieces in the plane.
   type :: master_t
      logical :: rigid = .false.
      integer(ip) :: n = 0
      real(wp), allocatable :: a(:, :), b(:, :)     !< (2, n) ends [L]
      real(wp), allocatable :: normal(:, :)         !< (2, n) outward
   end type master_t

   !> What a point sees.
   type :: sight_t
      integer(ip) :: piece = 0                      !< 0: nothing
      real(wp) :: t = 0.0_wp                        !< place on the piece, 0..1
      real(wp) :: distance = 0.0_wp                 !< along the normal [L]
   end type sight_t

   !> A point may hang over the end of the master by this part of its piece; nodes that match do so within it.
   real(wp), parameter :: END_TOLERANCE = 1.0e-6_wp
   !> Closer than this to a master node is at the node.
   real(wp), parameter :: NODE_TOLERANCE = 1.0e-10_wp
   !> Errors of rounding that a distance may have.
   real(wp), parameter :: ROUND_OFFS = 8.0_wp
   !> Cosine below which two surfaces face each other.
   real(wp), parameter :: FACING = -1.0e-3_wp

contains

   !> Points of the slave that face the master. n = 0 when none does.
   pure subroutine pair_surfaces(mesh, thickness, slave, master_faces, master_points, points)
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: thickness(:)          !< of each element [L]
      type(face_list_t), intent(in) :: slave        !< one chain, ordered (order_chain)
      type(face_list_t), intent(in) :: master_faces !< n = 0: the master is rigid
      real(wp), intent(in) :: master_points(:, :)   !< ends of the rigid segments [L], (2, pieces+1) or (2, 0)
      type(contact_points_t), intent(out) :: points
      type(master_t) :: master
      integer(ip), allocatable :: place(:)
      logical, allocatable :: used(:)
      integer(ip) :: i

      if (master_faces%n > 0) then
         call take_faces(mesh, master_faces, master)
      else
         call take_segments(master_points, master)
      end if
      points%rigid = master%rigid
      points%n_faces = slave%n
      used = [(finds_master(mesh, slave, i, master), i=1, slave%n)]
      points%n_left_out = count(.not. used, kind=ip)
      call allocate_points(points, 3*slave%n)
      allocate (place(mesh%n_nodes), source=0_ip)
      call place_points(mesh, thickness, slave, used, points, place)
      call trim_points(points)
      call look_for_master(mesh, master, master_faces, points)
      if (.not. master%rigid) points%matching = are_matching(mesh, slave, master_faces, points)
   end subroutine pair_surfaces

   pure subroutine take_faces(mesh, faces, master)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: faces
      type(master_t), intent(out) :: master
      integer(ip) :: i, ends(3)

      master%n = faces%n
      allocate (master%a(2, faces%n), master%b(2, faces%n), master%normal(2, faces%n))
      do i = 1, faces%n
         ends(:2) = reshape(face_nodes(mesh, faces%element(i), faces%face(i)), [2])
         master%a(:, i) = mesh%x(:, ends(1))
         master%b(:, i) = mesh%x(:, ends(2))
         master%normal(:, i) = face_normal(mesh, faces%element(i), faces%face(i))
      end do
   end subroutine take_faces

   !> Rigid segments: the outward normal is the direction of travel turned by +90 degrees.
   pure subroutine take_segments(ends, master)
      real(wp), intent(in) :: ends(:, :)
      type(master_t), intent(out) :: master
      real(wp) :: d(2)
      integer(ip) :: i

      master%rigid = .true.
      master%n = max(size(ends, 2, kind=ip) - 1, 0)
      allocate (master%a(2, master%n), master%b(2, master%n), master%normal(2, master%n))
      do i = 1, master%n
         master%a(:, i) = ends(:, i)
         master%b(:, i) = ends(:, i + 1)
         d = ends(:, i + 1) - ends(:, i)
         master%normal(:, i) = [-d(2), d(1)]/norm2(d)
      end do
   end subroutine take_segments

   !> A face is a candidate when each of its nodes finds the master along the face's normal.
   pure logical function finds_master(mesh, slave, i, master) result(finds)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave
      integer(ip), intent(in) :: i
      type(master_t), intent(in) :: master
      type(sight_t) :: sight
      real(wp) :: normal(2), reach
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: k

      nodes = face_nodes(mesh, slave%element(i), slave%face(i))
      normal = face_normal(mesh, slave%element(i), slave%face(i))
      reach = face_length(mesh, slave%element(i), slave%face(i))
      finds = .true.
      do k = 1, size(nodes, kind=ip)
         sight = look_along(mesh%x(:, nodes(k)), normal, reach, master)
         finds = finds .and. sight%piece > 0
      end do
   end function finds_master

   !> The nearest piece of the master on the line through x along the normal; a piece seen from behind is not seen, nor one that
   !> lies deeper inside than the longer of the slave's face and the piece. A piece that the line misses by END_TOLERANCE or less is
   !> taken only where no other is as near. The distance is that to the piece or its straight continuation.
   pure function look_along(x, normal, reach, master) result(best)
      real(wp), intent(in) :: x(2), normal(2)
      real(wp), intent(in) :: reach                 !< length of the slave's face [L]
      type(master_t), intent(in) :: master
      type(sight_t) :: best
      real(wp) :: d(2), r(2), cross, t, distance, nearness, nearest
      integer(ip) :: i

      nearest = huge(nearest)
      do i = 1, master%n
         if (dot_product(normal, master%normal(:, i)) > FACING) cycle
         d = master%b(:, i) - master%a(:, i)
         r = x - master%a(:, i)
         cross = d(1)*normal(2) - d(2)*normal(1)
         t = (r(1)*normal(2) - r(2)*normal(1))/cross
         if (t < -END_TOLERANCE .or. t > 1 + END_TOLERANCE) cycle
         nearness = 0.0_wp
         if (t < -NODE_TOLERANCE .or. t > 1 + NODE_TOLERANCE) nearness = 2*END_TOLERANCE*norm2(d)
         distance = dot_product(t*d - r, normal)
         if (t < NODE_TOLERANCE) t = 0.0_wp
         if (t > 1 - NODE_TOLERANCE) t = 1.0_wp
         if (distance < -max(reach, norm2(d))) cycle
         nearness = nearness + abs(distance)
         if (nearness >= nearest) cycle
         nearest = nearness
         best = sight_t(i, t, distance)
      end do
   end function look_along

   pure subroutine allocate_points(points, most)
      type(contact_points_t), intent(inout) :: points
      integer(ip), intent(in) :: most

      allocate (points%node(most), points%n_master(most), points%master_node(MOST_MASTER_NODES, most), source=0_ip)
      allocate (points%x(2, most), points%s(most), points%normal(2, most), points%length(most), points%weight(most), &
                points%gap(most), points%master_shape(MOST_MASTER_NODES, most), source=0.0_wp)
   end subroutine allocate_points

   !> One point a slave node; weights and normals of the faces that share it are summed.
   pure subroutine place_points(mesh, thickness, slave, used, points, place)
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: thickness(:)
      type(face_list_t), intent(in) :: slave
      logical, intent(in) :: used(:)
      type(contact_points_t), intent(inout) :: points
      integer(ip), intent(inout) :: place(:)        !< point of a node, 0 so far
      integer(ip), allocatable :: nodes(:)
      real(wp) :: s, length
      real(wp), allocatable :: rule(:), where_on_face(:)
      integer(ip) :: i, k

      s = 0.0_wp
      do i = 1, slave%n
         length = face_length(mesh, slave%element(i), slave%face(i))
         if (used(i)) then
            call nodal_rule(face_nodes(mesh, slave%element(i), slave%face(i)), nodes, rule, where_on_face)
            do k = 1, size(nodes, kind=ip)
               call add_point(mesh, nodes(k), s + where_on_face(k)*length, points, place)
               associate (j => place(nodes(k)))
                  points%length(j) = points%length(j) + rule(k)*length
                  points%weight(j) = points%weight(j) + rule(k)*length*thickness(slave%element(i))
                  points%normal(:, j) = points%normal(:, j) + length*face_normal(mesh, slave%element(i), slave%face(i))
               end associate
            end do
         end if
         s = s + length
      end do
      do i = 1, points%n
         points%normal(:, i) = points%normal(:, i)/norm2(points%normal(:, i))
         call clear_round_off(points%x(:, i), points%length(i), points%normal(:, i))
      end do
   end subroutine place_points

   !> A component of the normal that is round-off of the coordinates is none: along a symmetry line or a supported base the rows of
   !> the points are zero only then.
   pure subroutine clear_round_off(x, length, normal)
      real(wp), intent(in) :: x(2), length
      real(wp), intent(inout) :: normal(2)

      where (abs(normal) < max(1.0e-13_wp, 8*EPS_MACH*maxval(abs(x))/length)) normal = 0.0_wp
      normal = normal/norm2(normal)
   end subroutine clear_round_off

   !> Trapezoidal or Simpson's rule on a face, nodes in the order of travel.
   pure subroutine nodal_rule(face, nodes, rule, where_on_face)
      integer(ip), intent(in) :: face(:)            !< first, last[, middle]
      integer(ip), allocatable, intent(out) :: nodes(:)
      real(wp), allocatable, intent(out) :: rule(:), where_on_face(:)

      if (size(face) == 2) then
         nodes = face
         rule = [0.5_wp, 0.5_wp]
         where_on_face = [0.0_wp, 1.0_wp]
      else
         nodes = face([1, 3, 2])
         rule = [1.0_wp, 4.0_wp, 1.0_wp]/6.0_wp
         where_on_face = [0.0_wp, 0.5_wp, 1.0_wp]
      end if
   end subroutine nodal_rule

   pure subroutine add_point(mesh, node, s, points, place)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: node
      real(wp), intent(in) :: s
      type(contact_points_t), intent(inout) :: points
      integer(ip), intent(inout) :: place(:)

      if (place(node) > 0) return
      points%n = points%n + 1
      place(node) = points%n
      points%node(points%n) = node
      points%x(:, points%n) = mesh%x(:, node)
      points%s(points%n) = s
   end subroutine add_point

   pure subroutine trim_points(points)
      type(contact_points_t), intent(inout) :: points
      integer(ip) :: n

      n = points%n
      points%node = points%node(:n)
      points%x = points%x(:, :n)
      points%s = points%s(:n)
      points%normal = points%normal(:, :n)
      points%length = points%length(:n)
      points%weight = points%weight(:n)
      points%gap = points%gap(:n)
      points%n_master = points%n_master(:n)
      points%master_node = points%master_node(:, :n)
      points%master_shape = points%master_shape(:, :n)
   end subroutine trim_points

   !> Initial distances, and the master's shape functions where each point faces it. A distance that is round-off of the
   !> coordinates is none: displacements may be smaller than that.
   pure subroutine look_for_master(mesh, master, faces, points)
      type(mesh_t), intent(in) :: mesh
      type(master_t), intent(in) :: master
      type(face_list_t), intent(in) :: faces
      type(contact_points_t), intent(inout) :: points
      type(sight_t) :: sight
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: i, n

      do i = 1, points%n
         sight = look_along(points%x(:, i), points%normal(:, i), 2*points%length(i), master)
         ! where two faces meet at an angle, the mean normal may miss the end of the master
         if (sight%piece == 0) sight = nearest_end(points%x(:, i), points%normal(:, i), master)
         points%gap(i) = sight%distance
         if (abs(sight%distance) <= ROUND_OFFS*EPS_MACH*maxval(abs(points%x))) points%gap(i) = 0.0_wp
         if (master%rigid) cycle
         nodes = face_nodes(mesh, faces%element(sight%piece), faces%face(sight%piece))
         n = size(nodes, kind=ip)
         points%n_master(i) = n
         points%master_node(:n, i) = nodes
         points%master_shape(:n, i) = face_shape_values(n, 2*sight%t - 1)
      end do
   end subroutine look_for_master

   !> The master's end that is nearest to the line through x along the normal.
   pure function nearest_end(x, normal, master) result(best)
      real(wp), intent(in) :: x(2), normal(2)
      type(master_t), intent(in) :: master
      type(sight_t) :: best
      real(wp) :: away, least, d(2)
      integer(ip) :: i, k

      least = huge(least)
      do i = 1, master%n
         do k = 0, 1
            d = merge(master%a(:, i), master%b(:, i), k == 0) - x
            away = abs(d(1)*normal(2) - d(2)*normal(1))
            if (away >= least .or. dot_product(normal, master%normal(:, i)) > FACING) cycle
            least = away
            best = sight_t(i, real(k, wp), dot_product(d, normal))
         end do
      end do
   end function nearest_end

   !> Each slave node faces a master node, and both sides are of one order.
   pure logical function are_matching(mesh, slave, faces, points)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave, faces
      type(contact_points_t), intent(in) :: points
      integer(ip) :: i

      are_matching = .true.
      do i = 1, points%n
         are_matching = are_matching .and. maxval(points%master_shape(:, i)) >= 1 - 4*END_TOLERANCE
      end do
      if (slave%n > 0) are_matching = are_matching .and. &
                                      all(mesh%shape(faces%element(:faces%n)) == mesh%shape(slave%element(1)))
   end function are_matching

end module atrito_points
