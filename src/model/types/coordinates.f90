!> Coordinates of a deck, other rows of reals, and arcs by their ends and their centre.
!>
!> A translation and a rotation in the plane: of *NCOPY and of *INSTANCE.
module atrito_coordinates
   use atrito_deck, only: data_line_t, deck_t, keyword_name, line_item, token_t
   use atrito_diagnostics, only: report_error
   use atrito_items, only: get_real
   use atrito_kinds, only: ip, wp
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: get_coordinate, get_positive, get_reals, is_coordinate, spread_of_nodes, FLAT, get_point, centre_arc, motion_t, &
             read_shift, read_rotation, moved, turned

   !> Areas and their squares must be numbers, too.
   real(wp), parameter :: LARGEST_COORDINATE = 1.0e60_wp

   !> A z up to this part of the scene is what preprocessors leave of a rotation.
   real(wp), parameter :: FLAT = 1.0e-10_wp

   !> Coordinates of a deck have a few digits: the centre of an arc lies as far from both ends within this part of the radius.
   real(wp), parameter :: RADIUS_TOLERANCE = 1.0e-4_wp

   !> A translation, then a rotation about a point of the plane.
   type :: motion_t
      real(wp) :: shift(2) = 0.0_wp                  !< [L]
      real(wp) :: centre(2) = 0.0_wp                 !< [L]
      real(wp) :: angle = 0.0_wp                     !< [degrees], counter-clockwise
      real(wp), private :: cosine = 1.0_wp, sine = 0.0_wp !< of angle; exact for quarter turns
   end type motion_t

   real(wp), parameter :: HALF_TURN = 180.0_wp

contains

   !> The reals that some items of a line are, one after the other: values(i) is item first + i - 1.
   subroutine get_reals(deck, line, first, what, values, ok, defaults)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(data_line_t), intent(in) :: line            !< data line of the deck
      integer(ip), intent(in) :: first                 !< item
      character(len=*), intent(in) :: what             !< each is, e.g. 'coordinate, a real [L]'
      real(wp), intent(out) :: values(:)               !< as many as there are items
      logical, intent(out) :: ok                       !< all of them are reals; what is not is reported
      real(wp), intent(in), optional :: defaults(:)    !< of empty items
      logical :: good(size(values))
      integer(ip) :: i

      do i = 1, size(values, kind=ip)
         if (present(defaults)) then
            call get_real(deck, line_item(deck, line, first + i - 1), what, values(i), good(i), defaults(i))
         else
            call get_real(deck, line_item(deck, line, first + i - 1), what, values(i), good(i))
         end if
      end do
      ok = all(good)
   end subroutine get_reals

   !> The coordinate that an item is.
   subroutine get_coordinate(deck, token, what, x, ok, default)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(token_t), intent(in) :: token               !< the item; messages point at it
      character(len=*), intent(in) :: what             !< e.g. 'x, a real [L]'
      real(wp), intent(out) :: x                       !< [L]; what get_real leaves where it is no real
      logical, intent(out) :: ok                       !< it is a real within LARGEST_COORDINATE; else that is reported
      real(wp), intent(in), optional :: default        !< of an empty item [L]

      call get_real(deck, token, what, x, ok, default)
      if (.not. ok .or. is_coordinate(x)) return
      ok = .false.
      call report_error(deck, token, 'E-VALUE', 'a coordinate of '//to_text(x), expected=what//', at most '// &
                        to_text(LARGEST_COORDINATE))
   end subroutine get_coordinate

   !> Whether a number may be one.
   pure logical function is_coordinate(x)
      real(wp), intent(in) :: x                        !< [L]

      is_coordinate = abs(x) <= LARGEST_COORDINATE
   end function is_coordinate

   !> The longer side of the box round all lines of *NODE, as they stand there; what is no plain number has no part in it.
   pure real(wp) function spread_of_nodes(deck) result(spread)
      type(deck_t), intent(in) :: deck           !< as read
      real(wp) :: low(2), high(2), x
      integer(ip) :: i, axis, k
      integer :: outcome

      low = 0.25_wp*huge(1.0_wp)
      high = -low
      do i = 1, deck%n_cards
         if (keyword_name(deck%cards(i)) /= 'NODE') cycle
         do k = deck%cards(i)%first_line, deck%cards(i)%first_line + deck%cards(i)%n_lines - 1
            do axis = 1, 2
               associate (token => line_item(deck, deck%lines(k), axis + 1))
                  call read_real(deck%sources(token%source)%text(token%first:token%last), x, outcome)
               end associate
               if (outcome /= NUMBER_OK .or. .not. is_coordinate(x)) cycle
               low(axis) = min(low(axis), x)
               high(axis) = max(high(axis), x)
            end do
         end do
      end do
      spread = maxval(max(high - low, 0.0_wp))
   end function spread_of_nodes

   !> Two items of a line that are the coordinates of a point.
   subroutine get_point(deck, line, first, what, x, ok)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(data_line_t), intent(in) :: line            !< data line of the deck
      integer(ip), intent(in) :: first                 !< item
      character(len=*), intent(in) :: what(2)          !< what is expected
      real(wp), intent(out) :: x(2)                    !< [L]
      logical, intent(inout) :: ok                     !< false where there is an error
      integer(ip) :: k
      logical :: good

      do k = 1, 2
         call get_coordinate(deck, line_item(deck, line, first + k - 1), trim(what(k)), x(k), good)
         ok = ok .and. good
      end do
   end subroutine get_point

   !> The centre is as far from both ends, within the digits of a deck, and moved so that it is exactly; the arc is less than a half
   !> circle, else it could run on either side.
   subroutine centre_arc(deck, tokens, a, b, centre, ok)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(token_t), intent(in) :: tokens(2)           !< of the centre, and of the arc
      real(wp), intent(in) :: a(2), b(2)               !< ends [L]
      real(wp), intent(inout) :: centre(2)             !< [L]
      logical, intent(out) :: ok                       !< it is such an arc; else that is reported
      real(wp) :: chord(2), middle(2), radius(2)

      radius = [norm2(a - centre), norm2(b - centre)]
      ok = abs(radius(1) - radius(2)) <= RADIUS_TOLERANCE*maxval(radius)
      if (.not. ok) then
         call report_error(deck, tokens(1), 'E-VALUE', 'the centre is '//to_text(radius(1))//' from the start of the arc and '// &
                           to_text(radius(2))//' from its end', expected='a centre as far from both ends, within 1e-4 [L]')
         return
      end if
      chord = (b - a)/norm2(b - a)
      middle = 0.5_wp*a + 0.5_wp*b
      centre = centre - dot_product(centre - middle, chord)*chord
      ok = norm2(centre - middle) > RADIUS_TOLERANCE*maxval(radius)
      if (.not. ok) call report_error(deck, tokens(2), 'E-VALUE', 'the arc is a half circle, which could '//'run on either side', &
                                      expected='arcs of less than 180 degrees')
   end subroutine centre_arc

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

   !> A real that must be positive.
   subroutine get_positive(deck, token, what, name, value, ok)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(token_t), intent(in) :: token               !< the item; messages point at it
      character(len=*), intent(in) :: what, name       !< what is expected, and what stands before the value in a message
      real(wp), intent(out) :: value                   !< > 0 where ok
      logical, intent(out) :: ok                       !< it is one; else that is reported

      call get_real(deck, token, what, value, ok)
      if (.not. ok .or. value > 0.0_wp) return
      ok = .false.
      call report_error(deck, token, 'E-VALUE', name//to_text(value)//' is not positive', expected=what)
   end subroutine get_positive

end module atrito_coordinates
