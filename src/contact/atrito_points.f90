!> Quadrature points of a contact pair: where they lie, what they weigh, what they face.
!>
!> NODAL quadrature, as in the paper: the points are the slave's nodes, trapezoidal for Q1 and Simpson for Q2. Each looks along
!> the slave's normal for the master, element faces or rigid segments.
module atrito_points
   use atrito_element_table, only: MOST_SIDES
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_mesh, only: mesh_t, face_nodes
   use atrito_face_geometry, only: face_arc_length, face_direction, outward_normal
   use atrito_faces, only: face_list_t
   use atrito_master, only: master_t, sight_t, is_out_of_sight, look_along, look_at_end, &
                            nearest_end
   use atrito_plane_state, only: depth_at
   use atrito_shape_functions, only: face_shape_values
   implicit none (type, external)
   private
   public :: contact_points_t, pair_with_master, finds_master

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
      integer(lp), allocatable :: faces(:)          !< a number of its own for each of the slave's faces that are not left out
      logical :: matching = .false.                 !< every point faces a master node and the orders are equal
      logical :: rigid = .false.
   end type contact_points_t

   !> The nodal rule on a face, in the order of travel.
   type :: nodal_rule_t
      integer(ip) :: n = 0
      integer(ip) :: node(3) = 0
      real(wp) :: s(3) = 0.0_wp                     !< arc length from the face's first node [L]
      real(wp) :: weight(3) = 0.0_wp                !< [L]
      real(wp) :: normal(2, 3) = 0.0_wp             !< outward unit normals of the face
   end type nodal_rule_t

   !> From this sine on two faces meet at a corner, and do not stand for a curve.
   real(wp), parameter, public :: CORNER = 0.8_wp
   !> Errors of rounding that a distance may have.
   real(wp), parameter :: ROUND_OFFS = 8.0_wp
   !> Sides match when their nodes are this close, in parts of an edge.
   real(wp), parameter :: MATCH_TOLERANCE = 1.0e-6_wp

contains

   !> Points of the slave that face the master. n = 0 when none does.
   pure subroutine pair_with_master(mesh, thickness, slave, master_faces, master, points)
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: thickness(:)          !< of each element [L]
      type(face_list_t), intent(in) :: slave        !< one chain, ordered (order_chain)
      type(face_list_t), intent(in) :: master_faces !< n = 0: the master is rigid
      type(master_t), intent(in) :: master          !< of these faces
      type(contact_points_t), intent(out) :: points
      logical, allocatable :: used(:)
      integer(ip) :: i

      points%rigid = master%rigid
      points%n_faces = slave%n
      used = [(finds_master(mesh, slave, i, master), i=1, slave%n)]
      points%n_left_out = count(.not. used, kind=ip)
      points%faces = pack([(int(slave%element(i), lp)*MOST_SIDES + slave%face(i), i=1, slave%n)], used)
      call allocate_points(points, 3*slave%n)
      call place_points(mesh, thickness, slave, used, points)
      call trim_points(points)
      call look_for_master(mesh, master, master_faces, points)
      if (.not. master%rigid) points%matching = are_matching(mesh, slave, master, points)
   end subroutine pair_with_master

   !> A face is a candidate when each of its nodes finds the master along the face's normal there. On a curved slave that normal is
   !> only as good as the faces resolve the curve: at the end of the master it may miss by as much as the normal turns at the face.
   pure logical function finds_master(mesh, slave, i, master) result(finds)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave
      integer(ip), intent(in) :: i
      type(master_t), intent(in) :: master
      type(nodal_rule_t) :: rule
      type(sight_t) :: sight
      integer(ip) :: k

      rule = nodal_rule(mesh, slave%element(i), slave%face(i))
      finds = .true.
      do k = 1, rule%n
         associate (x => mesh%x(:, rule%node(k)), normal => rule%normal(:, k), reach => rule%s(rule%n))
            finds = .not. is_out_of_sight(x, normal, CORNER, master)
            if (.not. finds) return
            sight = look_along(x, normal, reach, master)
            if (sight%piece == 0) sight = look_at_end(x, normal, reach, turn_at(mesh, slave, i, rule), master)
         end associate
         finds = sight%piece > 0
         if (.not. finds) return
      end do
   end function finds_master

   !> Sine of the angle by which the normal turns along a face, or from it to the next ones of the chain; 0 at a corner.
   pure real(wp) function turn_at(mesh, slave, i, rule) result(turn)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave
      integer(ip), intent(in) :: i
      type(nodal_rule_t), intent(in) :: rule        !< of face i
      type(nodal_rule_t) :: other
      integer(ip) :: k

      turn = sine(rule%normal(:, 1), rule%normal(:, rule%n))
      do k = max(i - 1, 1_ip), min(i + 1, slave%n)
         if (k == i) cycle
         other = nodal_rule(mesh, slave%element(k), slave%face(k))
         if (k < i) turn = max(turn, sine(other%normal(:, other%n), rule%normal(:, 1)))
         if (k > i) turn = max(turn, sine(rule%normal(:, rule%n), other%normal(:, 1)))
      end do
      if (turn > CORNER) turn = 0.0_wp
   end function turn_at

   pure real(wp) function sine(a, b)
      real(wp), intent(in) :: a(2), b(2)            !< unit vectors

      sine = abs(a(1)*b(2) - a(2)*b(1))
      if (dot_product(a, b) < 0.0_wp) sine = 1.0_wp
   end function sine

   pure subroutine allocate_points(points, most)
      type(contact_points_t), intent(inout) :: points
      integer(ip), intent(in) :: most

      allocate (points%node(most), points%n_master(most), points%master_node(MOST_MASTER_NODES, most), source=0_ip)
      allocate (points%x(2, most), points%s(most), points%normal(2, most), points%length(most), points%weight(most), &
                points%gap(most), points%master_shape(MOST_MASTER_NODES, most), source=0.0_wp)
   end subroutine allocate_points

   !> One point a slave node; weights and normals of the faces that share it are summed.
   pure subroutine place_points(mesh, thickness, slave, used, points)
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: thickness(:)
      type(face_list_t), intent(in) :: slave
      logical, intent(in) :: used(:)
      type(contact_points_t), intent(inout) :: points
      type(id_map_t) :: place                       ! point of a node
      type(nodal_rule_t) :: rule
      real(wp) :: s
      integer(ip) :: i, j, k

      s = 0.0_wp
      do i = 1, slave%n
         rule = nodal_rule(mesh, slave%element(i), slave%face(i))
         do k = 1, merge(rule%n, 0_ip, used(i))
            call add_point(mesh, rule%node(k), s + rule%s(k), points, place, j)
            points%length(j) = points%length(j) + rule%weight(k)
            points%weight(j) = points%weight(j) + rule%weight(k)* &
                               depth_at(mesh%state(slave%element(i)), thickness(slave%element(i)), mesh%x(1, rule%node(k)))
            points%normal(:, j) = points%normal(:, j) + rule%weight(k)*rule%normal(:, k)
         end do
         s = s + rule%s(rule%n)
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

   !> Trapezoidal or Simpson's rule on a face. On a curved face the Jacobian differs from node to node. Simpson's weights times the
   !> normals are the nodal forces of a uniform pressure, to the last bit: the shape functions times dx/dt are cubics.
   pure function nodal_rule(mesh, element, face) result(rule)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: element, face
      type(nodal_rule_t) :: rule
      integer(ip) :: nodes(3), k, n
      real(wp) :: x(2, 3), t(3), w(3)

      nodes = 0
      n = size(face_nodes(mesh, element, face), kind=ip)
      nodes(:n) = face_nodes(mesh, element, face)
      x(:, :n) = mesh%x(:, nodes(:n))
      rule%n = n
      if (n == 2) then
         t(:n) = [-1.0_wp, 1.0_wp]
         w(:n) = 1.0_wp
      else
         nodes = nodes([1, 3, 2])
         t = [-1.0_wp, 0.0_wp, 1.0_wp]
         w = [1.0_wp, 4.0_wp, 1.0_wp]/3.0_wp
      end if
      rule%node = nodes
      do k = 1, n
         rule%s(k) = face_arc_length(x(:, :n), t(k))
         rule%weight(k) = w(k)*norm2(face_direction(x(:, :n), t(k)))
         rule%normal(:, k) = outward_normal(x(:, :n), t(k))
      end do
   end function nodal_rule

   !> The point of a node, which is made when it is new.
   pure subroutine add_point(mesh, node, s, points, place, j)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: node
      real(wp), intent(in) :: s
      type(contact_points_t), intent(inout) :: points
      type(id_map_t), intent(inout) :: place
      integer(ip), intent(out) :: j
      logical :: known

      call add_id(place, node, points%n + 1, known)
      j = find_id(place, node)
      if (known) return
      points%n = points%n + 1
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
      real(wp) :: round_off
      integer(ip) :: i, n

      if (points%n == 0) return
      round_off = ROUND_OFFS*EPS_MACH*maxval(abs(points%x))
      do i = 1, points%n
         sight = look_along(points%x(:, i), points%normal(:, i), 2*points%length(i), master)
         ! where two faces meet at an angle, the mean normal may miss the end of the master
         if (sight%piece == 0) sight = nearest_end(points%x(:, i), points%normal(:, i), master, any_side=.true.)
         points%gap(i) = sight%distance
         if (abs(sight%distance) <= round_off) points%gap(i) = 0.0_wp
         if (master%rigid) cycle
         nodes = face_nodes(mesh, faces%element(sight%piece), faces%face(sight%piece))
         n = size(nodes, kind=ip)
         points%n_master(i) = n
         points%master_node(:n, i) = nodes
         points%master_shape(:n, i) = face_shape_values(n, 2*sight%t - 1)
      end do
   end subroutine look_for_master

   !> Each slave node faces a master node, and both sides are of one order.
   pure logical function are_matching(mesh, slave, master, points)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave
      type(master_t), intent(in) :: master
      type(contact_points_t), intent(in) :: points
      integer(ip) :: i

      are_matching = .true.
      do i = 1, points%n
         are_matching = are_matching .and. maxval(points%master_shape(:, i)) >= 1 - 4*MATCH_TOLERANCE
      end do
      if (slave%n > 0) are_matching = are_matching .and. master%shape == mesh%shape(slave%element(1))
   end function are_matching

end module atrito_points
