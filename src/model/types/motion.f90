!> A translation and a rotation in the plane: of *NCOPY and of *INSTANCE.
module atrito_motion
   use atrito_coordinates, only: get_coordinate, spread_of_nodes, FLAT
   use atrito_deck, only: deck_t, data_line_t, line_item
   use atrito_diagnostics, only: report_error
   use atrito_items, only: get_real
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: motion_t, read_shift, read_rotation, moved, turned

   !> A translation, then a rotation about a point of the plane.
   type :: motion_t
      real(wp) :: shift(2) = 0.0_wp                  !< [L]
      real(wp) :: centre(2) = 0.0_wp                 !< [L]
      real(wp) :: angle = 0.0_wp                     !< [degrees], counter-clockwise
      real(wp), private :: cosine = 1.0_wp, sine = 0.0_wp !< of angle; exact for quarter turns
   end type motion_t

   real(wp), parameter :: HALF_TURN = 180.0_wp

contains

   !> Where a place comes to.
   !> With shift s, centre c and rotation R by the angle: y = c + R (x + s - c).
   pure function moved(motion, x) result(y)
      type(motion_t), intent(in) :: motion           !< as read
      real(wp), intent(in) :: x(2)                   !< [L]
      real(wp) :: y(2)

      y = x + motion%shift
      if (abs(motion%angle) > 0.0_wp) y = motion%centre + turned(motion, y - motion%centre)
   end function moved

   !> A direction after the rotation.
   !> R d = (d1 cos a - d2 sin a, d1 sin a + d2 cos a), a the angle.
   pure function turned(motion, d) result(y)
      type(motion_t), intent(in) :: motion           !< its rotation alone is used
      real(wp), intent(in) :: d(2)                   !< direction, of any length
      real(wp) :: y(2)

      y = [motion%cosine*d(1) - motion%sine*d(2), motion%sine*d(1) + motion%cosine*d(2)]
   end function turned

   !> A line of a translation.
   subroutine read_shift(deck, line, motion, ok)
      type(deck_t), intent(in) :: deck               !< as read; messages name its lines
      type(data_line_t), intent(in) :: line          !< data line: dx, dy and, if given, dz = 0
      type(motion_t), intent(inout) :: motion        !< its shift is set
      logical, intent(out) :: ok                     !< the translation lies in the plane; else that is reported
      real(wp) :: z
      logical :: good(3)

      call get_coordinate(deck, line_item(deck, line, 1_ip), 'translation along x, a real [L]', motion%shift(1), good(1))
      call get_coordinate(deck, line_item(deck, line, 2_ip), 'translation along y, a real [L]', motion%shift(2), good(2))
      call get_coordinate(deck, line_item(deck, line, 3_ip), 'translation along z, 0 [L]', z, good(3), 0.0_wp)
      ok = all(good)
      if (.not. ok .or. abs(z) <= FLAT*maxval(abs(motion%shift))) return
      ok = abs(z) <= FLAT*spread_of_nodes(deck)
      if (.not. ok) call report_error(deck, line_item(deck, line, 3_ip), 'E-VALUE', &
                                      'the scene is plane: the translation along z is not 0', expected='0 [L], or no third item')
   end subroutine read_shift

   !> The axis stands upright on the plane; the angle is positive round its direction.
   subroutine read_rotation(deck, line, times, motion, ok)
      type(deck_t), intent(in) :: deck               !< as read; messages name its lines
      type(data_line_t), intent(in) :: line          !< data line: two points of the axis, then the angle
      real(wp), intent(in) :: times                  !< how often it is done
      type(motion_t), intent(inout) :: motion        !< its centre and angle are set, where ok
      logical, intent(out) :: ok                     !< the axis stands upright; else that is reported
      real(wp) :: axis(6), angle
      integer(ip) :: k
      logical :: good

      ok = .true.
      do k = 1, 6
         call get_coordinate(deck, line_item(deck, line, k), 'coordinate of the axis, a real [L]', axis(k), good)
         ok = ok .and. good
      end do
      call get_real(deck, line_item(deck, line, 7_ip), 'angle, a real [degrees]', angle, good)
      ok = ok .and. good
      if (.not. ok) return
      ok = all(abs(axis(4:5) - axis(1:2)) <= FLAT*abs(axis(6) - axis(3))) .and. abs(axis(6) - axis(3)) > 0.0_wp
      if (.not. ok) then
         call report_error(deck, line_item(deck, line, 1_ip), 'E-VALUE', 'the axis does not stand upright on the plane', &
                           expected='xa, ya, za, xb, yb, zb with xb = xa, yb = ya, zb other than za [L]')
         return
      end if
      motion%centre = axis(1:2)
      motion%angle = sign(1.0_wp, axis(6) - axis(3))*angle*times
      motion%cosine = cos(motion%angle*(acos(-1.0_wp)/HALF_TURN))
      motion%sine = sin(motion%angle*(acos(-1.0_wp)/HALF_TURN))
      if (abs(modulo(motion%angle, HALF_TURN/2)) > 0.0_wp) return
      ! quarter turns are exact
      motion%cosine = anint(motion%cosine)
      motion%sine = anint(motion%sine)
   end subroutine read_rotation

end module atrito_motion
