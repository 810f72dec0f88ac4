!> What a point sees of a master, every piece looked at one after the other: what the search through the tree is compared with.
module exhaustive_sight
   use atrito_kinds, only: ip, wp
   use atrito_master, only: master_t, sight_t
   implicit none (type, external)
   private
   public :: look_everywhere, end_everywhere

   !> A point may hang over the end of the master by this part of its piece.
   real(wp), parameter :: END_TOLERANCE = 1.0e-6_wp
   !> Closer than this to a node of the master is at the node.
   real(wp), parameter :: NODE_TOLERANCE = 1.0e-10_wp
   !> Cosine below which two surfaces face each other.
   real(wp), parameter :: FACING = -1.0e-3_wp

contains

   !> The nearest piece of the master on the line through x along the normal; a piece seen from behind is not seen, nor one that
   !> lies deeper inside than the longer of the slave's face and the piece. A piece that the line misses by END_TOLERANCE or less is
   !> taken only where no other is as near. The distance is that to the piece or its continuation.
   pure function look_everywhere(x, normal, reach, master) result(best)
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
   end function look_everywhere

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

   !> The master's end that is nearest to the line through x along the normal.
   pure function end_everywhere(x, normal, master) result(best)
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
   end function end_everywhere

end module exhaustive_sight
