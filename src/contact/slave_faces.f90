!> The faces of a slave surface: the nodal rule on each, and how the normal turns along them.
!>
!> A face has the places x(t), t in [-1,1], from its first node to its last. The nodal rule takes its nodes with
!>
!>     l_a = omega_a |dx/dt|(t_a),     omega = (1, 1) for two nodes, (1, 4, 1)/3 for three,
!>
!> so that sum_a l_a f(x_a) is int f ds: exact for linear f on a straight face of two nodes, for cubics on one of three.
!> On a parabola l_a n_a = omega_a (dx/dt turned) is still exact for the nodal forces int N_a n ds of a uniform
!> pressure, N_a dx/dt being a cubic.
module atrito_slave_faces
   use atrito_face_geometry, only: face_arc_length, face_direction, outward_normal
   use atrito_faces, only: face_list_t
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_mesh, only: mesh_t, face_end, face_nodes
   implicit none (type, external)
   private
   public :: nodal_rule_t, nodal_rule, common_ends, turn_at, is_end_of_side, sine, clear_small_component

   !> The nodal rule on a face, in the order of travel.
   type :: nodal_rule_t
      integer(ip) :: n = 0 !< nodes with a weight
      integer(ip) :: node(3) = 0                    !< in the order of face_nodes
      real(wp) :: s(3) = 0.0_wp                     !< arc length from the face's first node [L]
      real(wp) :: weight(3) = 0.0_wp                !< [L]
      real(wp) :: normal(2, 3) = 0.0_wp             !< outward unit normals of the face
   end type nodal_rule_t

   !> From this sine on two faces meet at a corner, and do not stand for a curve.
   real(wp), parameter, public :: CORNER = 0.8_wp
   !> From this sine on the straight end of a slave does not lie on its master but stands on it, at a corner of its body.
   real(wp), parameter, public :: TILTED = 0.01_wp

contains

   !> The ends of a slave that are nodes of its master, too: at the tip of a crack nothing opens or slips, so there is no point.
   !> 0: none.
   pure function common_ends(mesh, slave, master) result(nodes)
      type(mesh_t), intent(in) :: mesh              !< nodes of the faces
      type(face_list_t), intent(in) :: slave        !< one chain, ordered (order_chain)
      type(face_list_t), intent(in) :: master       !< n = 0: it is rigid
      integer(ip) :: nodes(2)
      logical :: is_common(2)
      integer(ip) :: i

      nodes = 0
      if (slave%n == 0) return
      nodes = [mesh%nodes(slave%face(1), slave%element(1)), &
               mesh%nodes(face_end(mesh, slave%element(slave%n), slave%face(slave%n)), slave%element(slave%n))]
      is_common = .false.
      do i = 1, master%n
         associate (e => master%element(i), f => master%face(i))
            is_common = is_common .or. nodes == mesh%nodes(f, e) .or. nodes == mesh%nodes(face_end(mesh, e, f), e)
         end associate
      end do
      where (.not. is_common) nodes = 0
   end function common_ends

   !> Sine of the angle by which the normal turns along a face, or from it to the next ones of the chain; 0 at a corner,
   !> where the faces do not stand for a curve. By so much a normal at the end of the face may be off that of the curve.
   pure real(wp) function turn_at(mesh, slave, i, rule) result(turn)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave        !< one chain, ordered
      integer(ip), intent(in) :: i                  !< face of the slave
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

   !> Whether a side of the slave ends at an end of face i: no face of the chain is beside it, or one at a corner. Faces that see
   !> no master count: where a master ends below a side that goes on the slave has no corner.
   pure logical function is_end_of_side(mesh, slave, normals, i, end) result(is_end)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: slave        !< one chain, ordered
      real(wp), intent(in) :: normals(:, :, :)      !< (2, first and last end and more, faces) of the smooth surface
      integer(ip), intent(in) :: i                  !< face of the slave
      integer(ip), intent(in) :: end                !< 1 or 2
      integer(ip) :: k

      k = modulo(i + 2*end - 4, slave%n) + 1        ! the face before or behind; of a ring the last one is before the first
      associate (own => face_nodes(mesh, slave%element(i), slave%face(i)), &
                 other => face_nodes(mesh, slave%element(k), slave%face(k)))
         is_end = other(3 - end) /= own(end)
      end associate
      if (.not. is_end) is_end = sine(normals(:, end, i), normals(:, 3 - end, k)) > CORNER
   end function is_end_of_side

   !> The sine of the angle between two directions; 1 where it is more than a right one.
   pure real(wp) function sine(a, b)
      real(wp), intent(in) :: a(2), b(2)            !< unit vectors

      sine = abs(a(1)*b(2) - a(2)*b(1))
      if (dot_product(a, b) < 0.0_wp) sine = 1.0_wp
   end function sine

   !> A component of the normal that is round-off of the coordinates is none: along a symmetry line or a supported base
   !> the rows of the points are zero only then. Below 1e-13, or 8 EPS_MACH |x|/l for a point of the length l far from
   !> the origin, it is round-off.
   pure subroutine clear_small_component(x, length, normal)
      real(wp), intent(in) :: x(2), length          !< place and length of the point [L]
      real(wp), intent(inout) :: normal(2)          !< unit vector

      where (abs(normal) < max(1.0e-13_wp, 8*EPS_MACH*maxval(abs(x))/length)) normal = 0.0_wp
      normal = normal/norm2(normal)
   end subroutine clear_small_component

   !> Trapezoidal or Simpson's rule on a face. On a curved face the Jacobian differs from node to node. Simpson's weights times the
   !> normals are the nodal forces of a uniform pressure, to the last bit: the shape functions times dx/dt are cubics.
   pure function nodal_rule(mesh, element, face) result(rule)
      type(mesh_t), intent(in) :: mesh              !< shape of the face, thickness or radius
      integer(ip), intent(in) :: element, face      !< element and its side
      type(nodal_rule_t) :: rule                    !< in the order of travel
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

end module atrito_slave_faces
