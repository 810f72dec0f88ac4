!> The master of a contact pair as a list of pieces, straight or parabolic, and what a point of the slave sees of it.
module atrito_master
   use atrito_faces, only: face_list_t
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_mesh, only: mesh_t, face_nodes
   implicit none (type, external)
   private
   public :: master_t, sight_t, master_of_faces, master_of_segments, look_along, look_at_end, nearest_end

   !> A piece is x = a + t d + 4 t (1 - t) sag with t in [0,1]: a face of elements, or a rigid segment.
   type :: master_t
      logical :: rigid = .false.
      integer(ip) :: n = 0
      real(wp), allocatable :: a(:, :)              !< (2, n) first ends [L]
      real(wp), allocatable :: d(:, :)              !< (2, n) last end less first [L]
      real(wp), allocatable :: sag(:, :)            !< (2, n) middle node less the middle of the chord [L]; 0: straight
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
      allocate (master%a(2, faces%n), master%d(2, faces%n), master%sag(2, faces%n))
      do i = 1, faces%n
         nodes = face_nodes(mesh, faces%element(i), faces%face(i))
         master%a(:, i) = mesh%x(:, nodes(1))
         master%d(:, i) = mesh%x(:, nodes(2)) - mesh%x(:, nodes(1))
         master%sag(:, i) = sag_of(mesh%x(:, nodes))
      end do
   end subroutine master_of_faces

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
   pure subroutine master_of_segments(ends, master)
      real(wp), intent(in) :: ends(:, :)            !< (2, segments + 1) [L]
      type(master_t), intent(out) :: master
      integer(ip) :: n

      n = max(size(ends, 2, kind=ip) - 1, 0)
      master%rigid = .true.
      master%side = -1.0_wp
      master%n = n
      allocate (master%a(2, n), master%d(2, n))
      master%a = ends(:, :n)
      master%d = ends(:, 2:) - ends(:, :n)
      allocate (master%sag(2, n), source=0.0_wp)
   end subroutine master_of_segments

   !> The nearest piece of the master on the line through x along the normal; a piece seen from behind is not seen, nor one that
   !> lies deeper inside than the longer of the slave's face and the piece.
   pure function look_along(x, normal, reach, master) result(best)
      real(wp), intent(in) :: x(2), normal(2)
      real(wp), intent(in) :: reach                 !< length of the slave's face [L]
      type(master_t), intent(in) :: master
      type(sight_t) :: best
      real(wp) :: t(2), distance
      integer(ip) :: i, k, n_roots

      do i = 1, master%n
         call cross_line(master, i, x, normal, t, n_roots)
         do k = 1, n_roots
            if (t(k) < -END_TOLERANCE .or. t(k) > 1 + END_TOLERANCE) cycle
            t(k) = at_node(min(max(t(k), 0.0_wp), 1.0_wp))
            if (dot_product(normal, normal_at(master, i, t(k))) > FACING) cycle
            distance = dot_product(place_at(master, i, t(k)) - x, normal)
            if (distance < -max(reach, norm2(master%d(:, i)))) cycle
            if (best%piece == 0 .or. abs(distance) < abs(best%distance)) best = sight_t(i, t(k), distance)
         end do
      end do
   end function look_along

   !> Where the line through x along the normal crosses a piece: a quadratic equation, one root of which is lost in round-off when
   !> the piece is straight or nearly so. Roots far beyond the ends may be left out.
   pure subroutine cross_line(master, i, x, normal, t, n_roots)
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
      discriminant = b**2 - 4*a*c
      if (discriminant < 0.0_wp) return
      q = -0.5_wp*(b + sign(sqrt(discriminant), b))
      if (abs(c) <= 2*abs(q) .and. abs(q) > 0.0_wp) then
         n_roots = 1
         t(1) = c/q
      end if
      if (abs(q) <= 2*abs(a) .and. abs(a) > 0.0_wp) then
         n_roots = n_roots + 1
         t(n_roots) = q/a
      end if
   end subroutine cross_line

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

      x = master%a(:, i) + (t*master%d(:, i) + 4*t*(1 - t)*master%sag(:, i))
   end function place_at

   !> Outward unit normal of a piece.
   pure function normal_at(master, i, t) result(n)
      type(master_t), intent(in) :: master
      integer(ip), intent(in) :: i
      real(wp), intent(in) :: t
      real(wp) :: n(2), d(2)

      d = master%d(:, i) + 4*(1 - 2*t)*master%sag(:, i)
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
