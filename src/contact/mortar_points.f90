!> MORTAR quadrature of a contact pair: the gap is small in the mean, weighted by functions psi_j of the slave's nodes.
!>
!> With the thickness h (2 pi r on the full circle), W_j = int psi_j h ds over the part of the slave that faces the
!> master, and x_m(x) the place of the master that the place x of the slave faces, the row of node j is
!>
!>     (1/W_j) int psi_j (u(x) - u(x_m(x))) h ds,     s_j = (1/W_j) int psi_j g h ds,     n_j ~ int psi_j n h ds,
!>
!> g the distance along the common normal n of both sides. Put into shape functions phi of either side it has the coefficients
!>
!>     c_jk = (1/W_j) int psi_j phi_k h ds of the slave's nodes,     -(1/W_j) int psi_j phi_k h ds of the master's.
!>
!> The integrals are taken by three Gauss points on each segment (atrito_mortar_segments), on which the shape functions
!> of both sides are smooth. Three choices of psi, all with sum 1, so that a uniform pressure is carried over exactly
!> (the patch test):
!>
!> 1. A face that is covered whole has functions that are dual to its shape functions (B. Wohlmuth, SIAM J. Numer. Anal. 38 (2000)
!>    989-1012):
!>
!>        psi = A phi,     A = D M^-1,     M_ab = int phi_a phi_b h ds,     D_aa = int phi_a h ds,
!>
!>    which makes int psi_a phi_b h ds = delta_ab D_aa: the slave's part of the row is its own node with 1, and W_j =
!>    D_jj is the nodal force of a uniform pressure. The integrals are made with phi and multiplied by A at the end (make_dual).
!> 2. A face that hangs over the end of the master has hat functions of the nodes that are covered, constant beyond them:
!>    dual functions would give weights near zero or below, and points at nodes that face nothing. The force then acts
!>    at x_j = sum c_jk x_k.
!> 3. At the tip of a crack, a node of both sides, there is no row: the last face has the hat functions of its other nodes.
!>
!> psi_j of dual functions has both signs, and the mean of a gap could be below all gaps, an overlap of sides that touch
!> beside a bend: s_j is no less than the least g that is met on the faces of psi_j. At a corner of the slave between
!> two faces that both see the master, the gap is measured along the master's normals.
!>
!> Where faces with two nodes stand for curves, what their chords are short of the curve that both sides take under
!> pressure is added to g: see join_curves in atrito_mortar_segments and lift_of.
module atrito_mortar_points
   use atrito_dense, only: solve_lu
   use atrito_element_table, only: MOST_SIDES
   use atrito_face_geometry, only: face_direction
   use atrito_faces, only: face_list_t
   use atrito_id_map, only: id_map_t
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_master, only: master_t, smooth_normal, share_of_master, is_straight
   use atrito_mesh, only: mesh_t, face_nodes, is_revolved, depth_places
   use atrito_mortar_segments, only: segments_t, slave_face_t, cut_slave, join_curves, take_face, place_on_face, direction_at
   use atrito_plane_state, only: depth_at
   use atrito_pieces, only: cross_piece, place_at, normal_at
   use atrito_points, only: contact_points_t, terms_t, allocate_points, add_point, add_entries, add_term, drop_points
   use atrito_shape_functions, only: face_shape_values, gauss_rule
   use atrito_revolved_faces, only: is_at_axis, hats
   use atrito_slave_faces, only: nodal_rule_t, nodal_rule, common_ends, is_end_of_side, sine, clear_small_component, TILTED
   use atrito_sorting, only: sorted_places
   use atrito_smooth_normals, only: common_normal
   implicit none (type, external)
   private
   public :: pair_by_mortar

   integer(ip), parameter :: MOST = 3               !< nodes of a face
   integer(ip), parameter :: N_GAUSS = 3
   !> Of a coefficient: the rest is rounding of the integrals.
   real(wp), parameter :: ROUND_OFF = 1.0e-13_wp
   real(wp), parameter :: ROUND_OFFS = 8.0_wp       !< that a distance may have
   !> A node this far outside of what is covered, on [-1,1], is covered, and a face with no more that is not is whole: where sides
   !> end together, rounding of their coordinates decides nothing.
   real(wp), parameter :: AT_NODE = 1.0e-3_wp

   !> Integrals over a face with the weighting functions of its nodes: with the shape functions phi until make_dual,
   !> where the face is covered whole.
   type :: face_integrals_t
      logical :: is_whole = .true.                  !< no part of it is uncovered
      logical :: has_point(MOST) = .true.           !< nodes that get a weighting function
      real(wp) :: length(MOST) = 0.0_wp             !< int psi ds [L]
      real(wp) :: weight(MOST) = 0.0_wp             !< int psi h ds [L^2]
      real(wp) :: normal(2, MOST, 2) = 0.0_wp       !< int psi n h ds [L^2], n (1) common to both sides, (2) the master's
      real(wp) :: gap(MOST, 2) = 0.0_wp             !< int psi g h ds [L^3], g along these
      real(wp) :: least = huge(1.0_wp)              !< of g [L]
      real(wp) :: slave(MOST, MOST) = 0.0_wp        !< int psi_a phi_b h ds [L^2]
      integer(ip) :: n = 0                          !< nodes of the master
      integer(ip), allocatable :: node(:)           !< (n or more) maybe twice
      real(wp), allocatable :: master(:, :)         !< (MOST, n or more) int psi_a phi_k h ds [L^2]
   end type face_integrals_t

   !> The rows while faces are added.
   type :: rows_t
      type(id_map_t) :: place                       !< of the points of nodes
      real(wp), allocatable :: least(:)             !< of the gaps that a point sees [L]
      type(terms_t) :: slave, master                !< of the rows on nodes of the slave, of the master
   end type rows_t

contains

   !> The points of a slave that faces a master, on a deformable master's faces or rigid.
   !>
   !> 1. The faces are cut into segments (cut_slave), and the curve that both sides take is found (join_curves).
   !> 2. Face by face the integrals over its segments are taken (integrate_face) and added to the points at its nodes (add_face).
   !> 3. The points get unit normals, mean gaps, and rows over their weight, terms of one node together (finish_points).
   subroutine pair_by_mortar(mesh, thickness, slave, master_faces, master, compliance, master_compliance, points)
      type(mesh_t), intent(in) :: mesh              !< the slave's and the master's elements
      real(wp), intent(in) :: thickness(:)          !< of each element [L]
      type(face_list_t), intent(in) :: slave        !< one chain, ordered (order_chain)
      type(face_list_t), intent(in) :: master_faces !< n = 0: the master is rigid
      type(master_t), intent(in) :: master          !< of these faces
      real(wp), intent(in) :: compliance(:), master_compliance(:) !< of the faces, (1 - mu^2)/E in plane strain [L^2/F]
      type(contact_points_t), intent(out) :: points               !< of the pair, with rows and gaps
      type(segments_t) :: segments
      type(rows_t) :: rows
      type(face_integrals_t) :: integrals
      type(slave_face_t) :: face
      type(nodal_rule_t) :: rule
      real(wp) :: s
      integer(ip) :: i, tips(2)

      points%rigid = master%rigid
      points%is_mortar = .true.
      points%n_faces = slave%n
      call cut_slave(mesh, slave, master, segments)
      call join_curves(master, compliance, master_compliance, segments)
      call allocate_points(MOST*slave%n, 0_ip, points)
      allocate (rows%least(MOST*slave%n), source=huge(1.0_wp))
      tips = common_ends(mesh, slave, master_faces)
      s = 0.0_wp
      do i = 1, slave%n
         face = take_face(mesh, slave, i, segments)
         rule = nodal_rule(mesh, slave%element(i), slave%face(i))
         if (segments%first(i + 1) == segments%first(i)) then
            points%n_left_out = points%n_left_out + 1
         else
            face%state = mesh%state(slave%element(i))
            face%thickness = thickness(slave%element(i))
            face%places(:face%n) = depth_places(mesh, face%state, face%node(:face%n))
            face%is_corner(:2) = [is_corner_at(mesh, slave, master, segments, i, face%node(1), 1_ip), &
                                  is_corner_at(mesh, slave, master, segments, i, face%node(2), 2_ip)]
            call integrate_face(master_faces, integrals)
            call add_face(mesh, face, rule, s, integrals, rows, points)
         end if
         s = s + rule%s(rule%n)
      end do
      allocate (points%piece(0))
      if (allocated(segments%piece)) points%piece = segments%piece(:segments%first(slave%n + 1) - 1)
      points%faces = pack([(int(slave%element(i), lp)*MOST_SIDES + slave%face(i), i=1, slave%n)], &
                          segments%first(2:) > segments%first(:slave%n))
      call finish_points(mesh, rows, points)

   contains

      !> The integrals over the segments of a face: N_GAUSS points on each, t = ((1 - g) from + (1 + g) to)/2, exact to
      !> degree five, and both ends for the least gap. A face that is covered whole gets its dual functions at the end,
      !> when int phi_a phi_b is known.
      subroutine integrate_face(faces, integrals)
         type(face_list_t), intent(in) :: faces        !< of the master
         type(face_integrals_t), intent(out) :: integrals !< of the face
         real(wp) :: gauss(N_GAUSS), weights(N_GAUSS), t, weight
         integer(ip), allocatable :: nodes(:)
         integer(ip) :: k, g

         call judge_cover(face, tips, segments%from(segments%first(i):segments%first(i + 1) - 1), &
                          segments%to(segments%first(i):segments%first(i + 1) - 1), integrals)
         call gauss_rule(N_GAUSS, gauss, weights)
         k = MOST*(segments%first(i + 1) - segments%first(i))
         allocate (integrals%node(k), nodes(0))
         allocate (integrals%master(MOST, k), source=0.0_wp)
         do k = segments%first(i), segments%first(i + 1) - 1
            if (.not. master%rigid) nodes = face_nodes(mesh, faces%element(segments%piece(k)), faces%face(segments%piece(k)))
            do g = 1, N_GAUSS
               t = 0.5_wp*((1 - gauss(g))*segments%from(k) + (1 + gauss(g))*segments%to(k))
               weight = 0.5_wp*weights(g)*(segments%to(k) - segments%from(k))
               call add_place(face, t, weight, master, segments%piece(k), nodes, segments%common(k), integrals)
            end do
            ! a weight of 0: for the least gap alone
            call add_place(face, segments%from(k), 0.0_wp, master, segments%piece(k), nodes, segments%common(k), integrals)
            call add_place(face, segments%to(k), 0.0_wp, master, segments%piece(k), nodes, segments%common(k), integrals)
         end do
         if (integrals%is_whole) call make_dual(face%n, integrals)
      end subroutine integrate_face

   end subroutine pair_by_mortar

   !> Whether face i has a corner at one of its ends, where the normal is the master's, whatever the slopes: it meets another
   !> face that sees the master at an angle, the mean of both normals being that of neither, or it is straight, its side ends
   !> there, and it is TILTED against a straight master.
   pure logical function is_corner_at(mesh, slave, master, segments, i, node, end)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave
      type(master_t), intent(in) :: master
      type(segments_t), intent(in) :: segments
      integer(ip), intent(in) :: i                  !< face of the slave
      integer(ip), intent(in) :: node               !< at that end of it
      integer(ip), intent(in) :: end                !< 1 or 2
      integer(ip) :: k, m

      is_corner_at = is_end_of_side(mesh, slave, segments%direction, i, end)
      if (.not. is_corner_at) return
      k = modulo(i + 2*end - 4, slave%n) + 1        ! the face before or behind; of a ring the last one is before the first
      associate (nodes => face_nodes(mesh, slave%element(k), slave%face(k)))
         if (nodes(3 - end) == node .and. segments%first(k + 1) > segments%first(k)) return
      end associate
      m = segments%piece(merge(segments%first(i), segments%first(i + 1) - 1, end == 1))
      is_corner_at = .not. segments%curvature(i) > 0.0_wp .and. is_straight(master, m)
      if (is_corner_at) is_corner_at = sine(segments%direction(:, end, i), -normal_at(master, m, 0.5_wp)) > TILTED
   end function is_corner_at

   !> Adds what a place x(t) of the slave is worth to the integrals, with ds = weight |dx/dt| and the depth h there:
   !>
   !>     length += psi ds,   weight += psi h ds,   normal += psi n h ds,   gap += psi (g + bulge) h ds,   slave += psi phi' h ds,
   !>
   !> and the master's psi phi_m' h ds. Displacements that are linear along a chord show nothing of the curve that both
   !> sides take under pressure: it bulges over a chord c by k c^2/8 (1 - t^2), k its curvature. On the master's chord,
   !> with t in [0,1], that is k c^2/2 t (1 - t); on the slave's, less its own bulge, see lift_of. A weight of 0 counts
   !> for the least gap alone.
   pure subroutine add_place(face, t, weight, master, piece, nodes, curvature, integrals)
      type(slave_face_t), intent(in) :: face        !< of the slave
      real(wp), intent(in) :: t, weight             !< on the face, in [-1,1]
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: piece              !< of the master, that the place faces
      integer(ip), intent(in) :: nodes(:)           !< of the piece; none of a rigid one
      real(wp), intent(in) :: curvature             !< of the curve that both sides take under pressure [1/L]
      type(face_integrals_t), intent(inout) :: integrals !< of the face
      real(wp) :: ds, psi(MOST), phi(MOST), on_master, normal(2, 2), gap(2), bulge
      integer(ip) :: v

      associate (n => face%n)
         phi = 0.0_wp
         phi(:n) = face_shape_values(n, t)
         psi = phi
         if (.not. integrals%is_whole) psi = hats(integrals%has_point, t)
         ds = weight*norm2(face_direction(face%x(:, :n), t))
         integrals%length = integrals%length + ds*psi
         ds = ds*depth_at(face%state, face%thickness, dot_product(phi(:n), face%places(:n)))
         call look_at_piece(face, t, master, piece, on_master, normal(:, 1), gap(1))
         normal(:, 2) = -smooth_normal(master, piece, on_master)
         gap(2) = dot_product(place_at(master, piece, on_master) - place_on_face(face, t), normal(:, 2))
         bulge = 0.0_wp
         if (size(nodes) == 2) bulge = 0.5_wp*curvature*on_master*(1 - on_master)*sum(master%d(:, piece)**2)
         if (n == 2) bulge = bulge + 0.125_wp*(1 - t**2)*lift_of(face%length**2, master, piece, size(nodes) == 2, curvature)
         gap = gap + bulge
         do v = 1, 2
            integrals%normal(:, :, v) = integrals%normal(:, :, v) + ds*spread(normal(:, v), 2, MOST)*spread(psi, 1, 2)
            integrals%gap(:, v) = integrals%gap(:, v) + (ds*gap(v))*psi
         end do
         integrals%weight = integrals%weight + ds*psi
         integrals%least = min(integrals%least, gap(1), gap(2))
         integrals%slave = integrals%slave + ds*spread(psi, 2, MOST)*spread(phi, 1, MOST)
      end associate
      if (.not. master%rigid) call add_master(nodes, face_shape_values(size(nodes, kind=ip), 2*on_master - 1), ds*psi, integrals)
   end subroutine add_place

   !> What a chord of the slave adds, 8 times in its middle: less the bulge of the curve that both sides take. A finer master is a
   !> curve against it, whose nodes between those of the slave would be an overlap in the mean of two sides that touch: as much is
   !> added. One that is as fine may have its nodes at those of the slave: the power says how soon it is a curve.
   pure real(wp) function lift_of(square, master, piece, is_chord, curvature) result(lift)
      real(wp), intent(in) :: square                !< of the chord's length [L^2]
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: piece              !< of the master
      logical, intent(in) :: is_chord               !< the piece of the master is one, too
      real(wp), intent(in) :: curvature             !< of the curve that both sides take under pressure [1/L]

      lift = square
      if (is_chord) lift = square*max(1 - (sum(master%d(:, piece)**2)/square)**4, 0.0_wp)
      lift = (curvature + master%bend(piece))*lift - curvature*square
   end function lift_of

   !> Whether a face is covered whole, and which nodes get a weighting function where it is not: those that are covered, or the
   !> one that is nearest to what is. A node within AT_NODE outside of what is covered counts as
   !> covered, so where both sides end together the rounding of their coordinates decides nothing.
   pure subroutine judge_cover(face, tips, from, to, integrals)
      type(slave_face_t), intent(in) :: face        !< of the slave
      integer(ip), intent(in) :: tips(:)            !< nodes without a point
      real(wp), intent(in) :: from(:), to(:)        !< of its segments
      type(face_integrals_t), intent(inout) :: integrals !< of the face
      real(wp), parameter :: NODES(MOST) = [-1.0_wp, 1.0_wp, 0.0_wp]
      real(wp) :: away(MOST)
      logical :: may_have(MOST)
      integer(ip) :: a

      integrals%is_whole = sum(to - from) >= 2 - AT_NODE
      may_have = [(a <= face%n .and. .not. any(tips == face%node(a)), a=1, MOST)]
      integrals%has_point = may_have
      if (any(.not. may_have(:face%n))) integrals%is_whole = .false.
      if (integrals%is_whole) then                  ! at the axis dual functions would divide by nothing
         integrals%is_whole = .not. is_at_axis(face%state, face%x(:, :face%n))
         return
      end if
      away = huge(1.0_wp)
      do a = 1, face%n
         if (may_have(a)) away(a) = minval(max(from - NODES(a), NODES(a) - to))
      end do
      integrals%has_point = away <= AT_NODE
      if (.not. any(integrals%has_point)) integrals%has_point = [(a == minloc(away, dim=1) .and. may_have(a), a=1, MOST)]
   end subroutine judge_cover

   !> The place t in [0,1] of a piece that a place of the slave faces, the direction in which they would touch, and how far off it
   !> is along that. The line of sight may cross a parabola twice; the nearer place counts, and one beyond an end is the end.
   pure subroutine look_at_piece(face, t, master, piece, on_master, normal, gap)
      type(slave_face_t), intent(in) :: face        !< of the slave
      real(wp), intent(in) :: t                     !< on the face, in [-1,1]
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: piece              !< of the master
      real(wp), intent(out) :: on_master, normal(2), gap !< gap: [L]
      real(wp) :: x(2), d(2), roots(2), distance, nearest
      integer(ip) :: k, n

      x = place_on_face(face, t)
      d = direction_at(face, t)
      call cross_piece(master, piece, x, d, roots, n)
      on_master = 0.5_wp
      nearest = huge(1.0_wp)
      do k = 1, n
         roots(k) = min(max(roots(k), 0.0_wp), 1.0_wp)
         distance = dot_product(place_at(master, piece, roots(k)) - x, d)
         if (abs(distance) >= nearest) cycle
         nearest = abs(distance)
         on_master = roots(k)
      end do
      normal = common_normal(d, smooth_normal(master, piece, on_master), share_of_master(master, piece, on_master, face%curvature))
      gap = dot_product(place_at(master, piece, on_master) - x, normal)
   end subroutine look_at_piece

   !> Adds a place's part of the master's integrals, int psi_a phi_k h ds. A node is looked for among those of the last
   !> pieces alone: one that comes again later has another entry, and both are added up by gather.
   pure subroutine add_master(nodes, values, psi, integrals)
      integer(ip), intent(in) :: nodes(:)           !< of the piece
      real(wp), intent(in) :: values(:)             !< shape functions
      real(wp), intent(in) :: psi(MOST)             !< times weight [L^2]
      type(face_integrals_t), intent(inout) :: integrals !< of the face
      integer(ip) :: k, at, recent

      recent = max(integrals%n - 2*MOST, 0_ip)
      do k = 1, size(nodes, kind=ip)
         at = recent + findloc(integrals%node(recent + 1:integrals%n), nodes(k), dim=1, kind=ip)
         if (at == recent) then
            integrals%n = integrals%n + 1
            at = integrals%n
            integrals%node(at) = nodes(k)
         end if
         integrals%master(:, at) = integrals%master(:, at) + values(k)*psi
      end do
   end subroutine add_master

   !> From shape functions to the functions that are dual to them: psi = A phi, A = D M^-1, M = int phi phi' h ds, D =
   !> diag(int phi h ds).
   !>
   !> All integrals are linear in psi, so those with the dual functions are A times those with phi. The weights stay: A has row sums
   !> that keep them, sum_b A_ab D_bb = D_aa, since M 1 = D 1. Lengths are those with phi. The normal int psi n h ds is the rate of
   !> the gap in a translation, and that of the curve at the node. int psi phi' h ds = A M = D, exactly.
   subroutine make_dual(n, integrals)
      integer(ip), intent(in) :: n                  !< nodes of the face
      type(face_integrals_t), intent(inout) :: integrals !< of the face
      real(wp) :: m(n, n), a(n, n)
      integer(ip) :: k
      integer :: info

      m = integrals%slave(:n, :n)
      a = 0.0_wp
      do k = 1, n
         a(k, k) = integrals%weight(k)
      end do
      call solve_lu(m, a, info)                     ! M^-1 D, the transpose of A
      a = transpose(a)
      integrals%gap(:n, 1) = matmul(a, integrals%gap(:n, 1))
      integrals%gap(:n, 2) = matmul(a, integrals%gap(:n, 2))
      do k = 1, 2
         integrals%normal(:, :n, k) = matmul(integrals%normal(:, :n, k), transpose(a))
      end do
      integrals%master(:n, :integrals%n) = matmul(a, integrals%master(:n, :integrals%n))
      integrals%slave = 0.0_wp
      do k = 1, n
         integrals%slave(k, k) = integrals%weight(k)
      end do
   end subroutine make_dual

   !> Adds the integrals of a face to its points, which are made when their node is met for the first time. At a corner of the slave
   !> the gap is that along the master's normals, and these make the normal of the point.
   pure subroutine add_face(mesh, face, rule, s, integrals, rows, points)
      type(mesh_t), intent(in) :: mesh
      type(slave_face_t), intent(in) :: face        !< of the slave
      type(nodal_rule_t), intent(in) :: rule        !< of the face
      real(wp), intent(in) :: s                     !< arc length at the beginning of the face [L]
      type(face_integrals_t), intent(in) :: integrals !< of the face
      type(rows_t), intent(inout) :: rows           !< of the faces so far
      type(contact_points_t), intent(inout) :: points
      integer(ip) :: order(MOST), k, a, b, j, v

      order = [1_ip, 2_ip, 3_ip]
      if (face%n == 3) order = [1_ip, 3_ip, 2_ip]
      do k = 1, face%n
         a = order(k)
         if (.not. integrals%has_point(a)) cycle
         call add_point(mesh, face%node(a), s + rule%s(k), points, rows%place, j)
         points%length(j) = points%length(j) + integrals%length(a)
         points%weight(j) = points%weight(j) + integrals%weight(a)
         v = merge(2, 1, face%is_corner(a))
         points%gap(j) = points%gap(j) + integrals%gap(a, v)
         points%normal(:, j) = points%normal(:, j) + integrals%normal(:, a, v)
         rows%least(j) = min(rows%least(j), integrals%least)
         call add_term(j, face%node(a), integrals%slave(a, a), rows%slave)
         do b = 1, face%n
            if (b /= a) call add_term(j, face%node(b), integrals%slave(a, b), rows%slave)
         end do
         do b = 1, integrals%n
            call add_term(j, integrals%node(b), -integrals%master(a, b), rows%master)
         end do
      end do
   end subroutine add_face

   !> Unit normals, mean gaps, and the rows by points: of each the slave's nodes, its own first, then the master's. The functions
   !> psi change their signs, and with them the mean may be below all gaps: sides that touch beside a bend do not overlap.
   !>
   !>     n_j = N/|N|,  N = int psi_j n h ds;     s_j = max(int psi_j g h ds/W_j, least g);     c_jk = int psi_j phi_k h ds/W_j
   subroutine finish_points(mesh, rows, points)
      type(mesh_t), intent(in) :: mesh
      type(rows_t), intent(in) :: rows              !< of all faces
      type(contact_points_t), intent(inout) :: points
      integer(ip), allocatable :: first_own(:), first_other(:), of_own(:), of_other(:)
      real(wp) :: round_off
      integer(ip) :: j

      deallocate (points%entry, points%coefficient)
      allocate (points%entry(rows%slave%n + rows%master%n), points%coefficient(rows%slave%n + rows%master%n))
      call list_terms(points%n, rows%slave, first_own, of_own)
      call list_terms(points%n, rows%master, first_other, of_other)
      round_off = 0.0_wp
      if (points%n > 0) round_off = ROUND_OFFS*EPS_MACH*maxval(abs(points%x(:, :points%n)))
      do j = 1, points%n
         points%normal(:, j) = points%normal(:, j)/norm2(points%normal(:, j))
         call clear_small_component(points%x(:, j), points%length(j), points%normal(:, j))
         points%gap(j) = max(points%gap(j)/points%weight(j), rows%least(j))
         if (abs(points%gap(j)) <= round_off) points%gap(j) = 0.0_wp
         points%first(j + 1) = points%first(j)
         call gather(rows%slave, of_own(first_own(j):first_own(j + 1) - 1), j, points)
         if (.not. is_revolved(mesh)) call place_force(mesh, j, points)
         call gather(rows%master, of_other(first_other(j):first_other(j + 1) - 1), j, points)
      end do
      call drop_points([0_ip], points)
   end subroutine finish_points

   !> The terms of each of n points.
   subroutine list_terms(n, terms, first, of_point)
      integer(ip), intent(in) :: n                  !< nodes of the face
      type(terms_t), intent(in) :: terms
      integer(ip), allocatable, intent(out) :: first(:)    !< (n + 1)
      integer(ip), allocatable, intent(out) :: of_point(:) !< those of point j are first(j) .. first(j + 1) - 1
      integer(ip) :: i

      call list_holders(n, reshape([(terms%point(i), i=1, terms%n)], [1_ip, terms%n]), first, of_point)
   end subroutine list_terms

   !> Moves a point from its node to where its force acts on the slave, x_j = sum c_k x_k: elsewhere on a face that is covered in
   !> part. Rings of forces have no moment that would have to be kept.
   pure subroutine place_force(mesh, j, points)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: j                  !< the point; its entries so far are those of the slave
      type(contact_points_t), intent(inout) :: points
      real(wp) :: away(2)
      integer(ip) :: k

      away = 0.0_wp
      do k = points%first(j), points%first(j + 1) - 1
         away = away + points%coefficient(k)*(mesh%x(:, points%entry(k)) - mesh%x(:, points%node(j)))
      end do
      points%x(:, j) = points%x(:, j) + away
      points%s(j) = points%s(j) + (points%normal(1, j)*away(2) - points%normal(2, j)*away(1))
   end subroutine place_force

   !> Appends terms of a point to its row, those of one node together, over its weight: its own node first, others by number.
   !> Coefficients below ROUND_OFF are left out; they are rounding of the integrals.
   pure subroutine gather(terms, list, j, points)
      type(terms_t), intent(in) :: terms
      integer(ip), intent(in) :: list(:)            !< terms of the point
      integer(ip), intent(in) :: j                  !< point
      type(contact_points_t), intent(inout) :: points
      integer(ip) :: order(size(list)), k
      real(wp) :: value

      if (size(list) == 0) return
      associate (node => terms%node(list))
         order = list(sorted_places(int(merge(0_ip, node, node == points%node(j)), lp)))
      end associate
      value = 0.0_wp
      do k = 1, size(order, kind=ip)
         value = value + terms%value(order(k))/points%weight(j)
         if (any(terms%node(order(k + 1:min(k + 1, size(order)))) == terms%node(order(k)))) cycle
         if (abs(value) > ROUND_OFF) call add_entries([terms%node(order(k))], [value], j, points)
         value = 0.0_wp
      end do
   end subroutine gather

end module atrito_mortar_points
