!> The map of a block from the unit square: sides that are straight or arcs of circles, blended between them (Coons);
!> lines of nodes in the square, and where they lie.
module atrito_block_map
   use atrito_kinds, only: ip, wp
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: block_map_t, between, side_point, map_point, map_jacobian, has_arcs, graded_lines, block_nodes, curved_nodes

   !> The four sides in the order of the faces, BOTTOM from corner 1 to 2, RIGHT from 2 to 3, TOP from 4 to 3, LEFT from 1 to 4.
   type :: block_map_t
      real(wp) :: corners(2, 4) = 0.0_wp             !< [L], counter-clockwise
      logical :: is_arc(4) = .false.                 !< sides that run the shorter way round their centre
      real(wp) :: centre(2, 4) = 0.0_wp              !< [L], as far from both ends
   end type block_map_t

   integer(ip), parameter :: FROM(4) = [1_ip, 2_ip, 4_ip, 1_ip], TO(4) = [2_ip, 3_ip, 3_ip, 4_ip]

contains

   !> Whether a side of the block is an arc.
   pure logical function has_arcs(map)
      type(block_map_t), intent(in) :: map !< its sides that are arcs are asked for

      has_arcs = any(map%is_arc)
   end function has_arcs

   !> The point t = 0..1 of a side; along an arc t is in proportion to the angle.
   pure function side_point(map, side, t) result(x)
      type(block_map_t), intent(in) :: map           !< corners and centres are read
      integer(ip), intent(in) :: side                !< 1..4
      real(wp), intent(in) :: t                      !< 0..1, taken as 0 or 1 beyond
      real(wp) :: x(2)

      associate (a => map%corners(:, FROM(side)), b => map%corners(:, TO(side)))
         if (t <= 0.0_wp) then
            x = a
         else if (t >= 1.0_wp) then
            x = b
         else if (map%is_arc(side)) then
            x = arc_point(a, b, map%centre(:, side), t)
         else
            x = between(a, b, t)
         end if
      end associate
   end function side_point

   !> The derivative of side_point [L].
   pure function side_tangent(map, side, t) result(d)
      type(block_map_t), intent(in) :: map
      integer(ip), intent(in) :: side
      real(wp), intent(in) :: t
      real(wp) :: d(2), away(2), angle

      associate (a => map%corners(:, FROM(side)), b => map%corners(:, TO(side)), c => map%centre(:, side))
         if (map%is_arc(side)) then
            angle = arc_angle(a, b, c)
            away = arc_point(a, b, c, t) - c
            d = sign(angle, cross(a - c, b - c))*[-away(2), away(1)]
         else
            d = b - a
         end if
      end associate
   end function side_tangent

   !> The point t of an arc, from the middle of it: the same from both ends, and on the axis of a circle where it lies on one.
   pure function arc_point(a, b, centre, t) result(x)
      real(wp), intent(in) :: a(2), b(2), centre(2)  !< [L]
      real(wp), intent(in) :: t
      real(wp) :: x(2), middle(2), chord(2), radius, angle

      radius = norm2(a - centre)
      middle = 0.5_wp*((a - centre) + (b - centre))
      chord = b - a
      angle = (t - 0.5_wp)*arc_angle(a, b, centre)
      x = centre + (radius*cos(angle)/norm2(middle))*middle + (radius*sin(angle)/norm2(chord))*chord
   end function arc_point

   !> The angle of an arc, 0..pi.
   pure real(wp) function arc_angle(a, b, centre)
      real(wp), intent(in) :: a(2), b(2), centre(2)

      arc_angle = 2*atan2(norm2(b - a), norm2((a - centre) + (b - centre)))
   end function arc_angle

   pure real(wp) function cross(a, b)
      real(wp), intent(in) :: a(2), b(2)

      cross = a(1)*b(2) - a(2)*b(1)
   end function cross

   !> The point (u, v) of the unit square: on the sides exactly theirs, inside the Coons patch
   !>    x(u, v) = (1 - v) B(u) + v T(u) + (1 - u) L(v) + u R(v) - [(1 - v)((1 - u) c1 + u c2) + v ((1 - u) c4 + u c3)]
   !> of the sides bottom, top, left and right: the sum of what each pair of sides gives, less what the corners c alone would give,
   !> which both pairs have.
   pure function map_point(map, u, v) result(x)
      type(block_map_t), intent(in) :: map !< corners and centres are read
      real(wp), intent(in) :: u, v         !< 0..1 along BOTTOM; along LEFT
      real(wp) :: x(2)

      if (v <= 0.0_wp) then
         x = side_point(map, 1_ip, u)
      else if (v >= 1.0_wp) then
         x = side_point(map, 3_ip, u)
      else if (u <= 0.0_wp) then
         x = side_point(map, 4_ip, v)
      else if (u >= 1.0_wp) then
         x = side_point(map, 2_ip, v)
      else
         associate (c => map%corners)
            x = (1 - v)*side_point(map, 1_ip, u) + v*side_point(map, 3_ip, u) + &
                (1 - u)*side_point(map, 4_ip, v) + u*side_point(map, 2_ip, v) - &
                ((1 - v)*((1 - u)*c(:, 1) + u*c(:, 2)) + v*((1 - u)*c(:, 4) + u*c(:, 3)))
         end associate
      end if
   end function map_point

   !> The Jacobian of the map, dx/du x dx/dv [L^2], from the derivatives of the patch of map_point; not positive where the block is
   !> folded.
   pure real(wp) function map_jacobian(map, u, v)
      type(block_map_t), intent(in) :: map !< corners and centres are read
      real(wp), intent(in) :: u, v         !< 0..1 along BOTTOM; along LEFT
      real(wp) :: along(2), across(2)

      associate (c => map%corners)
         along = (1 - v)*side_tangent(map, 1_ip, u) + v*side_tangent(map, 3_ip, u) + side_point(map, 2_ip, v) - &
                 side_point(map, 4_ip, v) - ((1 - v)*(c(:, 2) - c(:, 1)) + v*(c(:, 3) - c(:, 4)))
         across = (1 - u)*side_tangent(map, 4_ip, v) + u*side_tangent(map, 2_ip, v) + side_point(map, 3_ip, u) - &
                  side_point(map, 1_ip, u) - ((1 - u)*(c(:, 4) - c(:, 1)) + u*(c(:, 3) - c(:, 2)))
      end associate
      map_jacobian = cross(along, across)
   end function map_jacobian

   !> a at t = 0, b at t = 1, and a all the way where a = b: sides that lie on each other must not be apart by round-off, which is
   !> no less a gap than any other.
   pure elemental real(wp) function between(a, b, t)
      real(wp), intent(in) :: a, b                   !< [L]
      real(wp), intent(in) :: t                      !< 0..1

      between = a + t*(b - a)
      if (t > 0.5_wp) between = b - (1 - t)*(b - a)
   end function between

   !> Lines 0..1 of one direction with n elements: equal, or each longer than the one before by a constant factor such that
   !> the last is `grade` times the first; of both halves from the ends on, such that the middle is `grade` times the ends.
   !>
   !> The element lengths are 1, r, r^2, ... r^(n - 1), over their sum, with r = grade^(1/(n - 1)). Of halves the exponent of
   !> element i is min(i - 1, n - i), the same from both ends, and r = grade^(1/((n - 1)/2)) with the quotient rounded down. The
   !> second half is the mirror of the first to the last bit, so a block that is symmetric has a symmetric mesh.
   pure function graded_lines(n, grade, of_halves) result(t)
      integer(ip), intent(in) :: n        !< elements, >= 1
      real(wp), intent(in) :: grade       !< last over first element length, > 0
      logical, intent(in) :: of_halves    !< grade from both ends to the middle
      real(wp) :: t(0:n), ratio
      integer(ip) :: i, steps

      steps = n - 1
      if (of_halves) steps = steps/2
      ratio = 1.0_wp
      if (steps > 0) ratio = grade**(1.0_wp/real(steps, wp))
      if (ratio == 1.0_wp) then
         t = [(real(i, wp)/real(n, wp), i=0, n)]
         return
      end if
      t(0) = 0.0_wp
      do i = 1, n
         t(i) = t(i - 1) + ratio**merge(min(i - 1, n - i), i - 1, of_halves)
      end do
      t = t/t(n)
      if (of_halves) t(n:n - n/2 + 1:-1) = 1 - t(:n/2 - 1)   ! the same both ways
      if (of_halves .and. mod(n, 2_ip) == 0) t(n/2) = 0.5_wp
   end function graded_lines

   !> Nodes of a block, row by row from BOTTOM (corner 1 to 2) to TOP (corner 4 to 3).
   subroutine block_nodes(corners, tx, ty, x)
      real(wp), intent(in) :: corners(2, 4)          !< [L], counter-clockwise
      real(wp), intent(in) :: tx(0:), ty(0:)         !< lines 0..1 along and across
      real(wp), intent(out) :: x(:, :)               !< (2, size(tx)*size(ty)) [L]
      real(wp) :: bottom(2, 0:size(tx) - 1), top(2, 0:size(tx) - 1)
      integer(ip) :: i, j, n

      do i = 0, size(tx, kind=ip) - 1
         bottom(:, i) = between(corners(:, 1), corners(:, 2), tx(i))
         top(:, i) = between(corners(:, 4), corners(:, 3), tx(i))
      end do
      n = size(tx, kind=ip)
      !$omp parallel do default(none) shared(n, bottom, top, ty, x) if(is_shared(n*size(ty, kind=ip)))
      do j = 0, size(ty, kind=ip) - 1
         do i = 0, n - 1
            x(:, j*n + i + 1) = between(bottom(:, i), top(:, i), ty(j))
         end do
      end do
      !$omp end parallel do
   end subroutine block_nodes

   !> The same for a block whose sides are arcs.
   subroutine curved_nodes(map, tx, ty, x)
      type(block_map_t), intent(in) :: map           !< corners, and the centres of the arcs
      real(wp), intent(in) :: tx(0:), ty(0:)         !< lines 0..1 along and across
      real(wp), intent(out) :: x(:, :)               !< (2, size(tx)*size(ty)) [L]
      integer(ip) :: i, j, n

      n = size(tx, kind=ip)
      !$omp parallel do default(none) shared(n, map, tx, ty, x) if(is_shared(n*size(ty, kind=ip)))
      do j = 0, size(ty, kind=ip) - 1
         do i = 0, n - 1
            x(:, j*n + i + 1) = map_point(map, tx(i), ty(j))
         end do
      end do
      !$omp end parallel do
   end subroutine curved_nodes

end module atrito_block_map
