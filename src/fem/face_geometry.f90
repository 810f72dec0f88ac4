!> Geometry of an element's face: straight for Q1, a parabola through its three nodes for Q2.
!>
!> With the shape functions of the face, x(t) = sum of N_a(t) x_a for t from -1 to 1. dx/dt is the direction of travel,
!> counter-clockwise round the element, and |dx/dt| dt the length; turned by -90 degrees it points outward. The length of a parabola
!> has a closed form that loses digits where it is nearly straight; it is integrated instead, by five Gauss points on each of
!> sixteen panels.
module atrito_face_geometry
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_shape_functions, only: face_shape_slopes
   implicit none (type, external)
   private
   public :: face_direction, outward_normal, face_arc_length, has_quarter_node, line_rule, RULE_POINTS

   integer(ip), parameter :: RULE_POINTS = 5

   !> Five Gauss points on [-1,1]: the positive ones with their weights, and the weight of the middle.
   real(wp), parameter :: POINTS(2) = [0.53846931010568309104_wp, 0.90617984593866399280_wp]
   real(wp), parameter :: WEIGHTS(2) = [0.47862867049936646804_wp, 0.23692688505618908751_wp]
   real(wp), parameter :: MIDDLE_WEIGHT = 0.56888888888888888889_wp
   !> Panels of a Q2 face: to round-off up to a sag of half the chord.
   integer(ip), parameter :: PANELS = 16
   !> A derivative below this part of the chord is 0.
   real(wp), parameter :: VANISHED = 1.0e-9_wp

contains

   !> dx/dt [L] at t in [-1,1], in the direction of travel.
   pure function face_direction(x, t) result(d)
      real(wp), intent(in) :: x(:, :)              !< the face's nodes in the order of face_nodes [L], (2, 2 or 3)
      real(wp), intent(in) :: t                    !< in [-1,1]
      real(wp) :: d(2)

      d = matmul(x, face_shape_slopes(size(x, 2, kind=ip), t))
   end function face_direction

   !> Outward unit normal: the direction of travel turned by -90 degrees. With the middle node at a quarter of the face dx/dt
   !> vanishes at an end, and the normal is that of the chord.
   pure function outward_normal(x, t) result(n)
      real(wp), intent(in) :: x(:, :)              !< (2, 2 or 3) [L]
      real(wp), intent(in) :: t                    !< in [-1,1]
      real(wp) :: n(2), d(2)

      d = face_direction(x, t)
      if (norm2(d) <= VANISHED*norm2(x(:, 2) - x(:, 1))) d = x(:, 2) - x(:, 1)
      n = [d(2), -d(1)]/norm2(d)
   end function outward_normal

   !> True when dx/dt vanishes at an end of the face.
   pure logical function has_quarter_node(x)
      real(wp), intent(in) :: x(:, :)              !< (2, 2 or 3) [L]

      has_quarter_node = min(norm2(face_direction(x, -1.0_wp)), norm2(face_direction(x, 1.0_wp))) &
                         <= VANISHED*norm2(x(:, 2) - x(:, 1))
   end function has_quarter_node

   !> Five Gauss points on [-1,1] and their weights: exact to degree 9.
   pure subroutine line_rule(place, weight)
      real(wp), intent(out) :: place(RULE_POINTS), weight(RULE_POINTS) !< ascending in [-1,1]; their sum is 2

      place = [-POINTS(2), -POINTS(1), 0.0_wp, POINTS]
      weight = [WEIGHTS(2), WEIGHTS(1), MIDDLE_WEIGHT, WEIGHTS]
   end subroutine line_rule

   !> Arc length [L] from the face's first node to t.
   pure real(wp) function face_arc_length(x, t) result(s)
      real(wp), intent(in) :: x(:, :)              !< (2, 2 or 3) [L]
      real(wp), intent(in) :: t                    !< in [-1,1]
      real(wp) :: half, middle
      integer(ip) :: i, k

      s = 0.5_wp*(1 + t)*norm2(x(:, 2) - x(:, 1))
      if (size(x, 2) == 2) return
      if (norm2(x(:, 3) - 0.5_wp*(x(:, 1) + x(:, 2))) <= 8*EPS_MACH*maxval(abs(x))) return
      s = 0.0_wp
      half = 0.5_wp*(1 + t)/PANELS
      do i = 1, PANELS
         middle = (2*i - 1)*half - 1
         s = s + half*MIDDLE_WEIGHT*norm2(face_direction(x, middle))
         do k = 1, 2
            s = s + half*WEIGHTS(k)*(norm2(face_direction(x, middle - half*POINTS(k))) &
                                     + norm2(face_direction(x, middle + half*POINTS(k))))
         end do
      end do
   end function face_arc_length

end module atrito_face_geometry
