!> The pieces of a contact surface's outline, straight, parabolic or circular: places, normals, and where a line crosses them.
!>
!> Piece i is, with t in [0,1] from its first end to its last,
!>
!>     x(t) = a + t d + 4 t (1 - t) sag      a face of elements (sag = 0: two nodes, or three in a line), a rigid segment
!>     x(t) = c + R(t sweep) (a - c)         a rigid arc about c, R(angle) a rotation
!>
!> and its outward normal is dx/dt turned by -90 degrees (side = 1) or +90 degrees (side = -1), over its length.
!>
!> The line x0 + s n crosses a piece where cross(x(t) - x0, n) = 0, cross(p, q) = p1 q2 - p2 q1. For a parabola this is
!>
!>     A t^2 + B t + C = 0,     A = -4 cross(sag, n),   B = cross(d, n) - A,   C = -cross(x0 - a, n),
!>
!> solved by q = -(B + sign(B) sqrt(B^2 - 4 A C))/2, t = C/q and t = q/A: no digits are lost by a difference of near
!> numbers, and with A = 0 (a straight piece) only t = C/q is left. The circle of an arc with the radius r is met at s =
!> -(x0 - c).n -+ sqrt(r^2 - cross(x0 - c, n)^2), the root taken as sqrt((r - |cross|)(r + |cross|)), and t is the angle
!> of that place over the sweep.
module atrito_pieces
   use atrito_kinds, only: ip, wp, EPS_MACH
   implicit none (type, external)
   private
   public :: pieces_t, allocate_pieces, sag_of, place_at, normal_at, cross_piece, box_of_piece, cross
   public :: END_TOLERANCE

   !> A piece is x = a + t d + 4 t (1 - t) sag with t in [0,1]: a face of elements, or a rigid segment. A rigid arc turns a round
   !> its centre by the angle t sweep.
   type :: pieces_t
      integer(ip) :: n = 0                          !< pieces
      real(wp), allocatable :: a(:, :)              !< (2, n) first ends [L]
      real(wp), allocatable :: d(:, :)              !< (2, n) last end less first [L]
      real(wp), allocatable :: sag(:, :)            !< (2, n) middle node less the middle of the chord [L]; 0: straight
      real(wp), allocatable :: centre(:, :)         !< (2, n) of arcs [L]
      real(wp), allocatable :: sweep(:)             !< (n) of arcs: -pi < sweep < pi; 0: no arc
      real(wp) :: side = 1.0_wp                     !< the outside lies at the right (1) or the left (-1) of the direction of travel
   end type pieces_t

   !> A point may hang over the end of the master by this part of its piece.
   real(wp), parameter :: END_TOLERANCE = 1.0e-6_wp

contains

   !> Room for n pieces; what they are is set by who knows them.
   pure subroutine allocate_pieces(n, pieces)
      integer(ip), intent(in) :: n !< pieces
      class(pieces_t), intent(inout) :: pieces !< all zero: straight, of no length

      pieces%n = n
      allocate (pieces%a(2, n), pieces%d(2, n), pieces%sag(2, n), pieces%centre(2, n), pieces%sweep(n), source=0.0_wp)
   end subroutine allocate_pieces

   !> The sag of a face: by what its middle node is off the middle of its chord. Round-off of a straight face's middle is none.
   pure function sag_of(x) result(sag)
      real(wp), intent(in) :: x(:, :)               !< (2, 2 or 3) [L]
      real(wp) :: sag(2)

      sag = 0.0_wp
      if (size(x, 2) == 2) return
      sag = x(:, 3) - 0.5_wp*(x(:, 1) + x(:, 2))
      if (norm2(sag) <= 8*EPS_MACH*maxval(abs(x))) sag = 0.0_wp
   end function sag_of

   !> The place of a piece at a share t of it, 0 at its first end and 1 at its second [L]: on a line, a parabola or an arc.
   pure function place_at(pieces, i, t) result(x)
      class(pieces_t), intent(in) :: pieces         !< faces, segments or arcs
      integer(ip), intent(in) :: i                  !< piece
      real(wp), intent(in) :: t                     !< share of the piece, 0 to 1
      real(wp) :: x(2)

      if (is_arc(pieces, i)) then
         x = pieces%centre(:, i) + turned(pieces%a(:, i) - pieces%centre(:, i), t*pieces%sweep(i))
      else
         x = pieces%a(:, i) + (t*pieces%d(:, i) + 4*t*(1 - t)*pieces%sag(:, i))
      end if
   end function place_at

   !> Outward unit normal of a piece.
   pure function normal_at(pieces, i, t) result(n)
      class(pieces_t), intent(in) :: pieces         !< faces, segments or arcs
      integer(ip), intent(in) :: i                  !< piece
      real(wp), intent(in) :: t                     !< share of the piece, 0 to 1
      real(wp) :: n(2), d(2)

      if (is_arc(pieces, i)) then
         d = turned(pieces%a(:, i) - pieces%centre(:, i), t*pieces%sweep(i))
         d = [-d(2), d(1)]*sign(1.0_wp, pieces%sweep(i))
      else
         d = pieces%d(:, i) + 4*(1 - 2*t)*pieces%sag(:, i)
         ! a middle node at a quarter of the face
         if (norm2(d) <= END_TOLERANCE*norm2(pieces%d(:, i))) d = pieces%d(:, i)
      end if
      n = [d(2), -d(1)]*(pieces%side/norm2(d))
   end function normal_at

   !> Whether a piece is an arc; a sweep of 0 stands for a line or a parabola.
   pure logical function is_arc(pieces, i)
      class(pieces_t), intent(in) :: pieces
      integer(ip), intent(in) :: i                  !< piece

      is_arc = abs(pieces%sweep(i)) > 0.0_wp
   end function is_arc

   !> Box round a piece with what a point may hang over its ends, and box round its normals, for the tree of pieces.
   !>
   !> A parabola lies within |sag| of its chord in each coordinate, an arc within its rise r (1 - cos(sweep/2)). A point
   !> may hang over an end by END_TOLERANCE of the piece. Normals turn one way along a piece and by less than 180
   !> degrees, so those between the ends are no farther off the normals at the ends than these are apart; where the
   !> middle node makes a cusp nothing is known of them.
   pure subroutine box_of_piece(pieces, i, low, high, normal_low, normal_high)
      class(pieces_t), intent(in) :: pieces         !< faces, segments or arcs
      integer(ip), intent(in) :: i                  !< piece
      real(wp), intent(out) :: low(2), high(2)      !< [L]
      real(wp), intent(out) :: normal_low(2), normal_high(2) !< bounds of the components of its unit normals
      real(wp) :: ends(2, 2), normals(2, 2), radius, bulge(2), spare

      ends = reshape([pieces%a(:, i), pieces%a(:, i) + pieces%d(:, i)], [2, 2])
      normals = reshape([normal_at(pieces, i, 0.0_wp), normal_at(pieces, i, 1.0_wp)], [2, 2])
      if (is_arc(pieces, i)) then
         radius = norm2(pieces%a(:, i) - pieces%centre(:, i))
         bulge = radius*(1 - cos(0.5_wp*pieces%sweep(i)))
         spare = 2*END_TOLERANCE*radius*abs(pieces%sweep(i))
      else
         bulge = abs(pieces%sag(:, i))
         spare = 2*END_TOLERANCE*(norm2(pieces%d(:, i)) + 4*norm2(pieces%sag(:, i)))
      end if
      low = minval(ends, dim=2) - bulge - spare
      high = maxval(ends, dim=2) + bulge + spare
      spare = norm2(normals(:, 2) - normals(:, 1))
      ! a middle node so far off, or so near to an end, that the normals at the ends do not tell those between them
      if (4*norm2(pieces%sag(:, i)) >= 0.9_wp*norm2(pieces%d(:, i))) spare = 2.0_wp
      normal_low = minval(normals, dim=2) - spare
      normal_high = maxval(normals, dim=2) + spare
   end subroutine box_of_piece

   !> Where the line through x along the normal crosses a piece: up to two places t, also beyond the ends.
   pure subroutine cross_piece(pieces, i, x, normal, t, n_roots)
      class(pieces_t), intent(in) :: pieces         !< faces, segments or arcs
      integer(ip), intent(in) :: i                  !< piece
      real(wp), intent(in) :: x(2), normal(2)       !< place [L] and unit vector of the line
      real(wp), intent(out) :: t(2)                 !< the places, the first n_roots are in use
      integer(ip), intent(out) :: n_roots           !< 0, 1 or 2

      if (is_arc(pieces, i)) then
         call cross_arc(pieces, i, x, normal, t, n_roots)
      else
         call cross_parabola(pieces, i, x, normal, t, n_roots)
      end if
   end subroutine cross_piece

   !> Where the line through x along the normal crosses a piece: a quadratic equation, linear for a straight piece. Roots far beyond
   !> the ends are left out, so that none overflows when the piece is nearly straight.
   pure subroutine cross_parabola(pieces, i, x, normal, t, n_roots)
      class(pieces_t), intent(in) :: pieces
      integer(ip), intent(in) :: i                  !< the piece
      real(wp), intent(in) :: x(2), normal(2)       !< place [L] and unit vector of the line
      real(wp), intent(out) :: t(2)                 !< the places, the first n_roots are in use
      integer(ip), intent(out) :: n_roots           !< 0, 1 or 2
      real(wp) :: a, b, c, q, discriminant

      t = 0.0_wp
      n_roots = 0
      a = -4*cross(pieces%sag(:, i), normal)
      b = cross(pieces%d(:, i), normal) - a
      c = -cross(x - pieces%a(:, i), normal)
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

   !> Where the line through x along the normal crosses an arc's circle: twice or not at all; a line that only touches
   !> it does not cross. t is outside of [0,1] where the place is on the circle but not on the arc.
   pure subroutine cross_arc(pieces, i, x, normal, t, n_roots)
      class(pieces_t), intent(in) :: pieces
      integer(ip), intent(in) :: i                  !< the piece
      real(wp), intent(in) :: x(2), normal(2)       !< place [L] and unit vector of the line
      real(wp), intent(out) :: t(2)                 !< the places, the first n_roots are in use
      integer(ip), intent(out) :: n_roots           !< 0, 1 or 2
      real(wp) :: from(2), place(2), along, across, radius, distance
      integer(ip) :: k

      t = 0.0_wp
      n_roots = 0
      from = pieces%a(:, i) - pieces%centre(:, i)
      place = x - pieces%centre(:, i)
      radius = norm2(from)
      along = dot_product(place, normal)
      across = abs(cross(place, normal))
      if (across >= radius) return
      n_roots = 2
      do k = 1, 2
         distance = real(2*k - 3, wp)*sqrt((radius - across)*(radius + across)) - along
         t(k) = atan2(cross(from, place + distance*normal), dot_product(from, place + distance*normal))/pieces%sweep(i)
      end do
   end subroutine cross_arc

   !> A vector turned by an angle.
   pure function turned(v, angle) result(w)
      real(wp), intent(in) :: v(2), angle
      real(wp) :: w(2)

      w = [cos(angle)*v(1) - sin(angle)*v(2), sin(angle)*v(1) + cos(angle)*v(2)]
   end function turned

   !> a1 b2 - a2 b1: positive where b lies to the left of a.
   pure real(wp) function cross(a, b)
      real(wp), intent(in) :: a(2), b(2)

      cross = a(1)*b(2) - a(2)*b(1)
   end function cross

end module atrito_pieces
