!> The master of a contact pair as a list of pieces, straight, parabolic or circular, and what a point of the slave sees of it.
module atrito_master
   use atrito_faces, only: face_list_t
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_mesh, only: mesh_t, face_nodes
   implicit none (type, external)
   private
   public :: master_t, sight_t, master_of_faces, master_of_segments, look_along, look_at_end, nearest_end

   !> A piece is x = a + t d + 4 t (1 - t) sag with t in [0,1]: a face of elements, or a rigid segment. A rigid arc turns a round
   !> its centre by the angle t sweep.
   type :: master_t
      logical :: rigid = .false.
      integer(ip) :: n = 0
      real(wp), allocatable :: a(:, :)              !< (2, n) first ends [L]
      real(wp), allocatable :: d(:, :)              !< (2, n) last end less first [L]
      real(wp), allocatable :: sag(:, :)            !< (2, n) middle node less the middle of the chord [L]; 0: straight
      real(wp), allocatable :: centre(:, :)         !< (2, n) of arcs [L]
      real(wp), allocatable :: sweep(:)             !< (n) of arcs: -pi < sweep < pi; 0: no arc
      real(wp) :: side = 1.0_wp                     !< the outside lies at the right (1) or the left (-1) of the direction of travel
   end type master_t

   !> What a point sees.
   type :: sight_t
      integer(ip) :: piece = 0                      !< 0: nothing
      real(wp) :: t = 0.0_wp                        !< place on the piece, 0..1
      real(wp) :: distance = 0.0_wp                 !< along the normal [L]
   end type sight_t

   !> A point may hang over the end of the master by this part of its piece.
   real(wp), parameter :: END_TOLERANCE = 1.0e-6_wp
   !> Closer than this to a node of the master is at the node.
   real(wp), parameter :: NODE_TOLERANCE = 1.0e-10_wp
   !> Cosine below which two surfaces face each other.
   real(wp), parameter :: FACING = -1.0e-3_wp

contains

   !> The faces of elements as a master; their outside lies at the right of the direction of travel.
   pure subroutine master_of_faces(mesh, faces, master)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: faces
      type(master_t), intent(out) :: master
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: i

      master%n = faces%n
      call allocate_pieces(faces%n, master)
      do i = 1, faces%n
         nodes = face_nodes(mesh, faces%element(i), faces%face(i))
         master%a(:, i) = mesh%x(:, nodes(1))
         master%d(:, i) = mesh%x(:, nodes(2)) - mesh%x(:, nodes(1))
         master%sag(:, i) = sag_of(mesh%x(:, nodes))
      end do
   end subroutine master_of_faces

   pure subroutine allocate_pieces(n, master)
      integer(ip), intent(in) :: n
      type(master_t), intent(inout) :: master

      master%n = n
      allocate (master%a(2, n), master%d(2, n), master%sag(2, n), master%centre(2, n), master%sweep(n), source=0.0_wp)
   end subroutine allocate_pieces

   !> Round-off of a straight face's middle is no sag.
   pure function sag_of(x) result(sag)
      real(wp), intent(in) :: x(:, :)               !< (2, 2 or 3) [L]
      real(wp) :: sag(2)

      sag = 0.0_wp
      if (size(x, 2) == 2) return
      sag = x(:, 3) - 0.5_wp*(x(:, 1) + x(:, 2))
      if (norm2(sag) <= 8*EPS_MACH*maxval(abs(x))) sag = 0.0_wp
   end function sag_of

   !> Rigid segments: the outward normal is the direction of travel turned by +90 degrees.
   pure subroutine master_of_segments(ends, master, is_arc, centre)
      real(wp), intent(in) :: ends(:, :)            !< (2, segments + 1) [L]
      type(master_t), intent(out) :: master
      logical, intent(in), optional :: is_arc(:)    !< (segments); default: none
      real(wp), intent(in), optional :: centre(:, :) !< (2, segments) of arcs [L], as far from one end as from the other
      real(wp) :: from(2), to(2)
      integer(ip) :: i, n

      n = max(size(ends, 2, kind=ip) - 1, 0)
      call allocate_pieces(n, master)
      master%rigid = .true.
      master%side = -1.0_wp
      master%a = ends(:, :n)
      master%d = ends(:, 2:) - ends(:, :n)
      if (.not. (present(is_arc) .and. present(centre))) return
      do i = 1, n
         if (.not. is_arc(i)) cycle
         from = ends(:, i) - centre(:, i)
         to = ends(:, i + 1) - centre(:, i)
         master%centre(:, i) = centre(:, i)
         master%sweep(i) = atan2(cross(from, to), dot_product(from, to))
      end do
   end subroutine master_of_segments

   !> The nearest piece of the master on the line through x along the normal; a piece seen from behind is not seen, nor one that
   !> lies deeper inside than the longer of the slave's face and the piece. A piece that the line misses by END_TOLERANCE or less is
   !> taken only where no other is as near. The distance is that to the piece or its continuation.
   pure function look_along(x, normal, reach, master) result(best)
      real(wp), intent(in) :: x(2), normal(2)
      real(wp), intent(in) :: reach                 !< length of the slave's face [L]
      type(master_t), intent(in) :: master
      type(sight_t) :: best
      real(wp) :: t(2), distance, nearness, nearest
      integer(ip) :: i, k, n_roots

      nearest = huge(nearest)
      do i = 1, master%n
         if (is_arc(master, i)) then
            call cross_arc(master, i, x, normal, t, n_roots)
         else
            call cross_parabola(master, i, x, normal, t, n_roots)
         end if
         do k = 1, n_roots
            if (t(k) < -END_TOLERANCE .or. t(k) > 1 + END_TOLERANCE) cycle
            distance = dot_product(place_at(master, i, t(k)) - x, normal)
            nearness = abs(distance)
            if (t(k) < -NODE_TOLERANCE .or. t(k) > 1 + NODE_TOLERANCE) nearness = nearness + 2*END_TOLERANCE*norm2(master%d(:, i))
            t(k) = at_node(min(max(t(k), 0.0_wp), 1.0_wp))
            if (dot_product(normal, normal_at(master, i, t(k))) > FACING) cycle
            if (distance < -max(reach, norm2(master%d(:, i))) .or. nearness >= nearest) cycle
            nearest = nearness
            best = sight_t(i, t(k), distance)
         end do
      end do
   end function look_along

   !> Where the line through x along the normal crosses a piece: a quadratic equation, linear for a straight piece. Roots far beyond
   !> the ends are left out, so that none overflows when the piece is nearly straight.
   pure subroutine cross_parabola(master, i, x, normal, t, n_roots)
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i                  !< the piece
      real(wp), intent(in) :: x(2), normal(2)
      real(wp), intent(out) :: t(2)
      integer(ip), intent(out) :: n_roots
      real(wp) :: a, b, c, q, discriminant

      t = 0.0_wp
      n_roots = 0
      a = -4*cross(master%sag(:, i), normal)
      b = cross(master%d(:, i), normal) - a
      c = -cross(x - master%a(:, i), normal)
      if (.not. abs(a) > 0.0_wp) then
         if (abs(c) > 2*abs(b) .or. .not. abs(b) > 0.0_wp) return
         n_roots = 1
         t(1) = -c/b
         return
      end if
      discriminant = b**2 - 4*a*c
      if (discriminant < 0.0_wp) return
      q = -0.5_wp*(b + sign(sqrt(discriminant), b))
      if (abs(c) <= 2*abs(q) .and. abs(q) > 0.0_wp) then
         n_roots = 1
         t(1) = c/q
      end if
      if (abs(q) <= 2*abs(a)) then
         n_roots = n_roots + 1
         t(n_roots) = q/a
      end if
   end subroutine cross_parabola

   !> Where the line through x along the normal crosses an arc's circle.
   pure subroutine cross_arc(master, i, x, normal, t, n_roots)
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i                  !< the piece
      real(wp), intent(in) :: x(2), normal(2)
      real(wp), intent(out) :: t(2)
      integer(ip), intent(out) :: n_roots
      real(wp) :: from(2), place(2), along, across, radius, distance
      integer(ip) :: k

      t = 0.0_wp
      n_roots = 0
      from = master%a(:, i) - master%centre(:, i)
      place = x - master%centre(:, i)
      radius = norm2(from)
      along = dot_product(place, normal)
      across = abs(cross(place, normal))
      if (across >= radius) return
      n_roots = 2
      do k = 1, 2
         distance = real(2*k - 3, wp)*sqrt((radius - across)*(radius + across)) - along
         t(k) = atan2(cross(from, place + distance*normal), dot_product(from, place + distance*normal))/master%sweep(i)
      end do
   end subroutine cross_arc

   pure logical function is_arc(master, i)
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i

      is_arc = abs(master%sweep(i)) > 0.0_wp
   end function is_arc

   !> A vector turned by an angle.
   pure function turned(v, angle) result(w)
      real(wp), intent(in) :: v(2), angle
      real(wp) :: w(2)

      w = [cos(angle)*v(1) - sin(angle)*v(2), sin(angle)*v(1) + cos(angle)*v(2)]
   end function turned

   pure real(wp) function cross(a, b)
      real(wp), intent(in) :: a(2), b(2)

      cross = a(1)*b(2) - a(2)*b(1)
   end function cross

   !> Round-off does not move a point off a node of the master.
   pure real(wp) function at_node(t) result(place)
      real(wp), intent(in) :: t
      integer(ip) :: k

      place = t
      do k = 0, 2
         if (abs(t - 0.5_wp*k) < NODE_TOLERANCE) place = 0.5_wp*k
      end do
   end function at_node

   pure function place_at(master, i, t) result(x)
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i
      real(wp), intent(in) :: t
      real(wp) :: x(2)

      if (is_arc(master, i)) then
         x = master%centre(:, i) + turned(master%a(:, i) - master%centre(:, i), t*master%sweep(i))
      else
         x = master%a(:, i) + (t*master%d(:, i) + 4*t*(1 - t)*master%sag(:, i))
      end if
   end function place_at

   !> Outward unit normal of a piece.
   pure function normal_at(master, i, t) result(n)
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i
      real(wp), intent(in) :: t
      real(wp) :: n(2), d(2)

      if (is_arc(master, i)) then
         d = turned(master%a(:, i) - master%centre(:, i), t*master%sweep(i))
         d = [-d(2), d(1)]*sign(1.0_wp, master%sweep(i))
      else
         d = master%d(:, i) + 4*(1 - 2*t)*master%sag(:, i)
         ! a middle node at a quarter of the face
         if (norm2(d) <= END_TOLERANCE*norm2(master%d(:, i))) d = master%d(:, i)
      end if
      n = [d(2), -d(1)]*(master%side/norm2(d))
   end function normal_at

   !> The end of the master that the line through x along the normal misses by no more than its distance times `turn`.
   pure function look_at_end(x, normal, reach, turn, master) result(best)
      real(wp), intent(in) :: x(2), normal(2), reach
      real(wp), intent(in) :: turn                  !< sine of the angle by which the normal is in doubt
      type(master_t), intent(in) :: master
      type(sight_t) :: best
      real(wp) :: away

      best = nearest_end(x, normal, master)
      if (best%piece == 0) return
      away = abs(cross(place_at(master, best%piece, best%t) - x, normal))
      if (away > turn*abs(best%distance) .or. best%distance < -max(reach, norm2(master%d(:, best%piece)))) best = sight_t()
   end function look_at_end

   !> The master's end that is nearest to the line through x along the normal.
   pure function nearest_end(x, normal, master) result(best)
      real(wp), intent(in) :: x(2), normal(2)
      type(master_t), intent(in) :: master
      type(sight_t) :: best
      real(wp) :: away, least, d(2), t
      integer(ip) :: i, k

      least = huge(least)
      do i = 1, master%n
         do k = 0, 1
            t = real(k, wp)
            d = place_at(master, i, t) - x
            away = abs(cross(d, normal))
            if (away >= least .or. dot_product(normal, normal_at(master, i, t)) > FACING) cycle
            least = away
            best = sight_t(i, t, dot_product(d, normal))
         end do
      end do
   end function nearest_end

end module atrito_master
