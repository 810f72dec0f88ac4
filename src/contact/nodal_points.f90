!> NODAL quadrature of a contact pair, as in the paper: where its points lie, what they weigh, what they face.
!>
!> The points are the slave's nodes. The integral of a pressure over a face is the trapezoidal rule for two nodes,
!> Simpson's for three,
!>
!>     int p ds ~ sum_a p(x_a) l_a,     l_a = omega_a |dx/dt|(t_a),     omega = (1, 1) or (1, 4, 1)/3 with t in [-1,1];
!>
!> a node of two faces is one point, with the sum of both lengths and their mean normal weighted by them: sum l_a n_a of
!> a face are the nodal forces of a uniform pressure, exactly. The weight w_j is l_j times the thickness; on the full
!> circle, and where the thickness is tapered, weights and normals come from atrito_revolved_faces.
!>
!> Each point looks along its normal for the master (atrito_master). It sees the place t of a piece, where the piece's
!> nodes k have the shape functions phi_k(t), so the row of the point is (atrito_points)
!>
!>     u_j - sum_k phi_k(t) u_k,     s_j = n_j . (x_master(t) - x_j),
!>
!> n_j then being the normal that both sides have in common. A face of the slave takes part only where all of its nodes see the
!> master: a part of a face has no rule of its own here (MORTAR has one).
module atrito_nodal_points
   use atrito_element_table, only: DEGREE_OF, MOST_SIDES
   use atrito_id_map, only: id_map_t
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_mesh, only: mesh_t, face_nodes
   use atrito_faces, only: face_list_t
   use atrito_master, only: master_t, sight_t, smooth_normal, share_of_master, is_straight, kink_near, look_along, &
                            look_at_end, nearest_end
   use atrito_piece_tree, only: is_far_off
   use atrito_pieces, only: place_at
   use atrito_plane_state, only: depth_at, IS_TAPERED, STATES
   use atrito_points, only: contact_points_t, terms_t, allocate_points, add_point, add_entries, drop_points
   use atrito_revolved_faces, only: revolved_face_t, revolve_face, note_mixed, mix_rows
   use atrito_shape_functions, only: face_shape_values
   use atrito_slave_faces, only: nodal_rule_t, nodal_rule, common_ends, turn_at, is_end_of_side, sine, &
                                 clear_small_component, CORNER, TILTED
   use atrito_smooth_normals, only: smooth_surface, common_normal
   implicit none (type, external)
   private
   public :: pair_with_master, finds_master

   !> Most entries of a point: the slave's node and a face of the master.
   integer(ip), parameter :: NODAL_ENTRIES = 4
   !> Errors of rounding that a distance may have.
   real(wp), parameter :: ROUND_OFFS = 8.0_wp
   !> Sides match when their nodes are this close, in parts of an edge.
   real(wp), parameter :: MATCH_TOLERANCE = 1.0e-6_wp
   !> A face whose node sees the master hangs over its end where this part of the face does, too.
   real(wp), parameter :: INSIDE = 1.0e-3_wp
   !> Nodes of the slave that lie farther apart than so many times those of the master have others between them.
   real(wp), parameter :: NEIGHBOURS = 1.25_wp
   !> A kink of the master is felt by a point this near to it, in parts of its length; below this cosine sides hardly face each
   !> other.
   real(wp), parameter :: NEAR_KINK = 0.05_wp, ASLANT = 0.1_wp
   !> The curvature of a corner, whose radius is nothing; and of the straight end of a slave, which may stand on its master.
   real(wp), parameter :: AT_CORNER = huge(1.0_wp), AT_END = -1.0_wp

contains

   !> Points of the slave that face the master. n = 0 when none does.
   !>
   !> 1. Which faces take part: those all of whose nodes find the master (finds_master).
   !> 2. A point at each node of these, with length, weight, normal and curvature (place_points).
   !> 3. What each point faces: gap, common normal, row (look_for_master).
   !> 4. At the axis of revolution the rows of a face's nodes are mixed to those of its points (mix_rows).
   !> 5. Nodes at the tip of a crack, of both sides, have no point (common_ends).
   pure subroutine pair_with_master(mesh, thickness, slave, master_faces, master, points)
      type(mesh_t), intent(in) :: mesh              !< the slave's and the master's elements
      real(wp), intent(in) :: thickness(:)          !< of each element [L]
      type(face_list_t), intent(in) :: slave        !< one chain, ordered (order_chain)
      type(face_list_t), intent(in) :: master_faces !< n = 0: the master is rigid
      type(master_t), intent(in) :: master          !< of these faces
      type(contact_points_t), intent(out) :: points !< of the pair, with rows and gaps
      logical, allocatable :: used(:)
      real(wp), allocatable :: curvature(:)         ! of the slave at the points [1/L]
      type(terms_t) :: mixed
      integer(ip) :: i

      points%rigid = master%rigid
      points%n_faces = slave%n
      used = [(finds_master(mesh, slave, i, master), i=1, slave%n)]
      points%n_left_out = count(.not. used, kind=ip)
      if (points%n_left_out == slave%n) points%n_seeing = count([(sees_master(mesh, slave, i, master), i=1, slave%n)], kind=ip)
      points%faces = pack([(int(slave%element(i), lp)*MOST_SIDES + slave%face(i), i=1, slave%n)], used)
      call allocate_points(3*slave%n, 3*slave%n*NODAL_ENTRIES, points)
      call place_points(mesh, thickness, slave, used, master%digit_error, points, curvature, mixed)
      call look_for_master(master_faces, points)
      if (.not. master%rigid) points%matching = are_matching(mesh, slave, master, points)
      if (points%matching .and. points%n > 0) then
         do i = 1, slave%n
            if (.not. used(i)) points%matching = points%matching .and. .not. hangs_over(mesh, slave, i, master)
         end do
      end if
      call mix_rows(mixed, points)
      call drop_points(common_ends(mesh, slave, master_faces), points)

   contains

      !> Initial distances, and the master's shape functions where each point faces it: the row u_j - sum phi_k(t) u_k. A
      !> distance that is round-off of the coordinates is none: displacements may be smaller than that. A point at a corner
      !> of the slave whose mean normal misses the master takes the end that is nearest to it.
      pure subroutine look_for_master(faces, points)
         type(face_list_t), intent(in) :: faces        !< of the master
         type(contact_points_t), intent(inout) :: points
         type(sight_t) :: sight
         integer(ip), allocatable :: nodes(:)
         real(wp) :: round_off
         integer(ip) :: i

         allocate (points%piece(points%n))
         if (points%n == 0) return
         round_off = ROUND_OFFS*EPS_MACH*maxval(abs(points%x(:, :points%n)))
         do i = 1, points%n
            sight = look_along(points%x(:, i), points%normal(:, i), 2*points%length(i), master)
            ! where two faces meet at an angle, the mean normal may miss the end of the master
            if (sight%piece == 0) sight = nearest_end(points%x(:, i), points%normal(:, i), master, any_side=.true.)
            points%piece(i) = sight%piece
            points%gap(i) = sight%distance
            call turn_to_common_normal(master, curvature(i), points%x(:, i), points%length(i), sight, points%normal(:, i), &
                                       points%gap(i))
            if (abs(points%gap(i)) <= round_off) points%gap(i) = 0.0_wp
            points%first(i + 1) = points%first(i)
            call add_entries([points%node(i)], [1.0_wp], i, points)
            if (master%rigid) cycle
            nodes = face_nodes(mesh, faces%element(sight%piece), faces%face(sight%piece))
            call add_entries(nodes, -face_shape_values(size(nodes, kind=ip), 2*sight%t - 1), i, points)
         end do
         if (.not. master%rigid) call find_coarsest(mesh, master, faces, points)
      end subroutine look_for_master

   end subroutine pair_with_master

   !> A node of the face finds the master, or the middle of a straight one does: for the message about a pair none of
   !> whose faces sees the master with all of its nodes.
   pure logical function sees_master(mesh, slave, i, master) result(sees)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave
      integer(ip), intent(in) :: i                  !< face of the slave
      type(master_t), intent(in) :: master
      type(nodal_rule_t) :: rule
      type(sight_t) :: sight
      integer(ip) :: k

      rule = nodal_rule(mesh, slave%element(i), slave%face(i))
      sight = look_along(0.5_wp*(mesh%x(:, rule%node(1)) + mesh%x(:, rule%node(rule%n))), rule%normal(:, 1), rule%s(rule%n), &
                         master)
      sees = sight%piece > 0
      do k = 1, rule%n
         sees = sees .or. node_finds(mesh, slave, i, rule, k, master)
      end do
   end function sees_master

   !> A face that is left out sees the master with a part of it, not only at a node where both sides have one: they do not match.
   pure logical function hangs_over(mesh, slave, i, master)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave
      integer(ip), intent(in) :: i                  !< face of the slave
      type(master_t), intent(in) :: master
      type(nodal_rule_t) :: rule
      type(sight_t) :: sight
      real(wp) :: inwards(2)
      integer(ip) :: k

      hangs_over = .false.
      rule = nodal_rule(mesh, slave%element(i), slave%face(i))
      do k = 1, rule%n, rule%n - 1
         if (.not. node_finds(mesh, slave, i, rule, k, master)) cycle
         inwards = mesh%x(:, rule%node(rule%n + 1 - k)) - mesh%x(:, rule%node(k))
         sight = look_along(mesh%x(:, rule%node(k)) + INSIDE*inwards, rule%normal(:, k), rule%s(rule%n), master)
         hangs_over = hangs_over .or. sight%piece > 0
      end do
   end function hangs_over

   !> A face is a candidate when each of its nodes finds the master along the face's normal there. On a curved slave
   !> that normal is only as good as the faces resolve the curve: at the end of the master it may miss by as much as the
   !> normal turns at the face, that is by the distance times the sine of the angle from this face to its neighbours
   !> (turn_at).
   pure logical function finds_master(mesh, slave, i, master) result(finds)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave        !< one chain, ordered
      integer(ip), intent(in) :: i                  !< face of the slave
      type(master_t), intent(in) :: master
      type(nodal_rule_t) :: rule
      integer(ip) :: k

      rule = nodal_rule(mesh, slave%element(i), slave%face(i))
      finds = .true.
      do k = 1, rule%n
         finds = node_finds(mesh, slave, i, rule, k, master)
         if (.not. finds) return
      end do
   end function finds_master

   !> Whether a node of face i sees the master along the face's normal there, or an end of it within the doubt about that normal.
   pure logical function node_finds(mesh, slave, i, rule, k, master) result(finds)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave        !< one chain, ordered
      integer(ip), intent(in) :: i                  !< face of the slave
      type(nodal_rule_t), intent(in) :: rule           !< of face i
      integer(ip), intent(in) :: k                  !< node of the face, in the order of travel
      type(master_t), intent(in) :: master
      type(sight_t) :: sight

      associate (x => mesh%x(:, rule%node(k)), normal => rule%normal(:, k), reach => rule%s(rule%n))
         finds = .not. is_far_off(master%tree, x, normal, CORNER)
         if (.not. finds) return
         sight = look_along(x, normal, reach, master)
         if (sight%piece == 0) sight = look_at_end(x, normal, reach, turn_at(mesh, slave, i, rule), master)
      end associate
      finds = sight%piece > 0
   end function node_finds

   !> One point a slave node; weights and normals of the faces that share it are summed: l_j = sum l_a, w_j = sum l_a
   !> h_a, and the normal is that of sum l_a n_a. The curvature of a point is the mean of its faces', weighted by l_a,
   !> AT_CORNER where they meet at a corner, and AT_END where a straight side ends.
   pure subroutine place_points(mesh, thickness, slave, used, digit_error, points, curvature, mixed)
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: thickness(:)          !< of each element [L]
      type(face_list_t), intent(in) :: slave        !< one chain, ordered
      logical, intent(in) :: used(:)                !< (faces) that take part
      real(wp), intent(in) :: digit_error           !< to which the nodes are known [L]
      type(contact_points_t), intent(inout) :: points
      real(wp), allocatable, intent(out) :: curvature(:) !< of the slave at the points [1/L]
      type(terms_t), intent(inout) :: mixed         !< of rows at the axis
      real(wp), allocatable :: ends(:, :, :), of_face(:), bend(:)
      type(id_map_t) :: place                       ! point of a node
      type(nodal_rule_t) :: rule
      type(revolved_face_t) :: face
      logical :: is_corner(size(points%s)), is_end(size(points%s))
      real(wp) :: s
      integer(ip) :: i, j, k, end, of_node(3)

      call smooth_surface(mesh, slave, ends, of_face, bend, digit_error)
      allocate (curvature(size(points%s)), source=0.0_wp)
      is_corner = .false.
      is_end = .false.
      s = 0.0_wp
      do i = 1, slave%n
         rule = nodal_rule(mesh, slave%element(i), slave%face(i))
         face = revolved_face_t()
         if (STATES(mesh%state(slave%element(i)))%has_hoop .or. IS_TAPERED(mesh%state(slave%element(i)))) then
            face = revolve_face(mesh, mesh%state(slave%element(i)), thickness(slave%element(i)), rule)
         end if
         do k = 1, merge(rule%n, 0_ip, used(i))
            call add_point(mesh, rule%node(k), s + rule%s(k), points, place, j)
            of_node(k) = j
            if (points%length(j) > 0.0_wp) is_corner(j) = sine(points%normal(:, j)/norm2(points%normal(:, j)), &
                                                               rule%normal(:, k)) > CORNER
            if (k == 1 .or. k == rule%n) then
               end = merge(1_ip, 2_ip, k == 1)
               if (is_end_of_side(mesh, slave, ends, i, end)) then
                  is_end(j) = .true.
                  rule%normal(:, k) = ends(:, end, i)
               end if
            end if
            points%length(j) = points%length(j) + rule%weight(k)
            curvature(j) = curvature(j) + rule%weight(k)*of_face(i)
            if (face%n > 0) then
               points%weight(j) = points%weight(j) + face%weight(k)
               points%normal(:, j) = points%normal(:, j) + face%weight(k)*face%normal(:, k)
               cycle
            end if
            points%weight(j) = points%weight(j) + rule%weight(k)* &
                               depth_at(mesh%state(slave%element(i)), thickness(slave%element(i)), mesh%x(1, rule%node(k)))
            points%normal(:, j) = points%normal(:, j) + rule%weight(k)*rule%normal(:, k)
         end do
         if (used(i)) call note_mixed(face, of_node, mixed)
         s = s + rule%s(rule%n)
      end do
      curvature(:points%n) = merge(AT_CORNER, curvature(:points%n)/points%length(:points%n), is_corner(:points%n))
      where (is_end(:points%n) .and. .not. curvature(:points%n) > 0.0_wp) curvature(:points%n) = AT_END
      do i = 1, points%n
         points%normal(:, i) = points%normal(:, i)/norm2(points%normal(:, i))
         call clear_small_component(points%x(:, i), points%length(i), points%normal(:, i))
      end do
   end subroutine place_points

   !> The gap is measured along the normal that both sides have in common, n ~ (1 - f) n_s - f n_m, f = k_s/(k_s + k_m)
   !> with the curvatures of both sides (share_of_master). f fades out where the master has a kink within NEAR_KINK of
   !> the point's length, since the normal beyond it is another one, and where the sides hardly face each other
   !> (ASLANT): the normal is the slave's there. A corner of the slave, whose curvature is without bound, takes the
   !> master's normal and looks along it once more, since the mean normal of its faces may lead far away; so does the
   !> end of a straight side that is TILTED against a straight master, on which it stands.
   pure subroutine turn_to_common_normal(master, curvature, x, length, sight, normal, gap)
      type(master_t), intent(in) :: master
      real(wp), intent(in) :: curvature             !< of the slave [1/L]
      real(wp), intent(in) :: x(2), length          !< [L]
      type(sight_t), intent(inout) :: sight         !< what the point sees
      real(wp), intent(inout) :: normal(2)          !< in: of the slave; out: of both sides
      real(wp), intent(inout) :: gap                !< [L]
      real(wp) :: n(2), of_master(2), share
      logical :: is_corner
      type(sight_t) :: again

      of_master = smooth_normal(master, sight%piece, sight%t)
      is_corner = curvature >= AT_CORNER
      if (curvature <= AT_END) is_corner = is_straight(master, sight%piece) .and. sine(normal, -of_master) > TILTED
      share = share_of_master(master, sight%piece, sight%t, merge(AT_CORNER, max(curvature, 0.0_wp), is_corner)) &
              *min(-dot_product(normal, of_master)/ASLANT, 1.0_wp) &
              *(1 - kink_near(master, sight%piece, sight%t, NEAR_KINK*length))
      n = common_normal(normal, of_master, share)
      if (is_corner) then
         again = look_along(x, n, 2*length, master)
         if (again%piece > 0) sight = again
      else if (.not. share > 0.0_wp) then
         return
      end if
      normal = n
      call clear_small_component(x, length, normal)
      gap = dot_product(place_at(master, sight%piece, sight%t) - x, normal)
   end subroutine turn_to_common_normal

   !> Where neighbours on the slave lie farthest apart, by the distance of the master's nodes that are faced from the
   !> middle between them: what is pushed between them meets no point. coarseness is the largest ratio of these two
   !> distances, coarse_node where it is; the check of the deck warns of it.
   pure subroutine find_coarsest(mesh, master, faces, points)
      type(mesh_t), intent(in) :: mesh
      type(master_t), intent(in) :: master
      type(face_list_t), intent(in) :: faces        !< of the master
      type(contact_points_t), intent(inout) :: points
      type(sight_t) :: sight
      real(wp) :: distance, spacing, d(2)
      integer(ip) :: i

      do i = 2, points%n
         distance = points%s(i) - points%s(i - 1)
         ! neighbours on a face, not on both sides of faces that are left out
         if (distance > 2*(points%length(i) + points%length(i - 1))) cycle
         d = points%x(:, i) - points%x(:, i - 1)
         sight = look_along(points%x(:, i - 1) + 0.5_wp*d, [d(2), -d(1)]/norm2(d), distance, master)
         if (sight%piece == 0) cycle
         spacing = norm2(master%d(:, sight%piece)) &
                   /(size(face_nodes(mesh, faces%element(sight%piece), faces%face(sight%piece))) - 1)
         if (distance <= points%coarseness*spacing) cycle
         points%coarseness = distance/spacing
         points%coarse_node = points%node(i)
      end do
   end subroutine find_coarsest

   !> Each slave node faces a master node (it has a coefficient of -1), neighbours face neighbours, and both sides are of one order.
   pure logical function are_matching(mesh, slave, master, points)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave        !< one chain, ordered
      type(master_t), intent(in) :: master
      type(contact_points_t), intent(in) :: points
      integer(ip) :: i

      are_matching = points%coarseness < NEIGHBOURS
      do i = 1, points%n
         are_matching = are_matching .and. &
                        minval(points%coefficient(points%first(i):points%first(i + 1) - 1)) <= -(1 - 4*MATCH_TOLERANCE)
      end do
      if (slave%n > 0) are_matching = are_matching .and. master%degree == DEGREE_OF(mesh%shape(slave%element(1)))
   end function are_matching

end module atrito_nodal_points
