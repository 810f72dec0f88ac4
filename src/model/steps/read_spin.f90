!> What a line of *DLOAD, CENTRIF says: the axis about which elements turn.
!>
!> The way from the axis, of direction a through x0, is S (x - x0): S = 1 for an axis across the plane, S = 1 - a a' for one that
!> lies in it. An oblique axis would push out of the plane.
module atrito_read_spin
   use atrito_build_context, only: build_context_t
   use atrito_coordinates, only: get_reals
   use atrito_deck, only: data_line_t, line_item
   use atrito_diagnostics, only: report_error
   use atrito_kinds, only: ip, wp
   use atrito_read_face_load, only: magnitude_of
   implicit none (type, external)
   private
   public :: read_spin

   integer(ip), parameter :: FIRST = 4, AXIS = 7       !< items of the line: point, direction
   character(len=*), parameter :: WHAT_POINT = 'a point of the axis, x, y, z [L]', &
                                  WHAT_AXIS = 'direction of the axis, ax, ay, az, in the plane or across it, not all 0 [-]'

contains

   !> The axis of items 4 to 9, and the way from it: way(1:3) are S11, S12, S22, and S x0 is -there.
   subroutine read_spin(line, context, square, is_ring, way, there, ok)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      real(wp), intent(in) :: square                   !< item 3, of the angular velocity [1/T^2]
      logical, intent(in) :: is_ring                   !< axisymmetric elements: the axis is x2
      real(wp), intent(out) :: way(3), there(2)        !< [-], [L]
      logical, intent(out) :: ok
      real(wp) :: point(3), a(3)
      logical :: good(2)

      way = 0.0_wp
      there = 0.0_wp
      ok = square >= 0.0_wp
      if (.not. ok) call report_error(context%deck, line_item(context%deck, line, 3_ip), 'E-VALUE', &
                                      'the square of an angular velocity is negative', expected=magnitude_of('CENTRIF'), &
                                      keyword='DLOAD')
      call get_reals(context%deck, line, FIRST, WHAT_POINT, point, good(1), 'DLOAD', spread(0.0_wp, 1, 3))
      call get_reals(context%deck, line, AXIS, WHAT_AXIS, a, good(2), 'DLOAD', spread(0.0_wp, 1, 3))
      ok = ok .and. all(good)
      if (.not. ok) return
      if (maxval(abs(a)) > 0.0_wp) a = a/maxval(abs(a))
      call check_axis(line, context, is_ring, point, a, ok)
      if (.not. ok) return
      if (is_ring) then
         way(1) = 1.0_wp
      else if (abs(a(3)) > 0.0_wp) then
         way = [1.0_wp, 0.0_wp, 1.0_wp]
      else
         a = a/norm2(a)
         way = [a(2)*a(2), -a(1)*a(2), a(1)*a(1)]
      end if
      there = -[way(1)*point(1) + way(2)*point(2), way(2)*point(1) + way(3)*point(2)]
   end subroutine read_spin

   subroutine check_axis(line, context, is_ring, point, a, ok)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      logical, intent(in) :: is_ring
      real(wp), intent(in) :: point(3), a(3)
      logical, intent(out) :: ok
      logical :: is_across

      ok = .false.
      is_across = abs(a(3)) > 0.0_wp
      if (.not. any(abs(a) > 0.0_wp)) then
         call report_error(context%deck, line_item(context%deck, line, min(AXIS, line%n_tokens + 1)), 'E-VALUE', &
                           'the axis of CENTRIF has no direction', expected=WHAT_AXIS, keyword='DLOAD')
      else if (is_ring .and. (is_across .or. abs(a(1)) > 0.0_wp .or. abs(point(1)) > 0.0_wp .or. abs(point(3)) > 0.0_wp)) then
         call report_error(context%deck, line_item(context%deck, line, FIRST), 'E-VALUE', &
                           'axisymmetric elements turn about the axis y alone', &
                           expected='0, 0, 0, 0, 1, 0: a point of the axis and its direction', keyword='DLOAD')
      else if (is_across .and. any(abs(a(:2)) > 0.0_wp)) then
         call report_error(context%deck, line_item(context%deck, line, AXIS), 'E-VALUE', &
                           'an oblique axis of CENTRIF pushes out of the plane', expected=WHAT_AXIS, keyword='DLOAD')
      else if (.not. is_across .and. abs(point(3)) > 0.0_wp) then
         call report_error(context%deck, line_item(context%deck, line, FIRST + 2), 'E-VALUE', &
                           'an axis of CENTRIF beside the plane pushes out of it', expected='z = 0 [L]', keyword='DLOAD')
      else
         ok = .true.
      end if
   end subroutine check_axis

end module atrito_read_spin
