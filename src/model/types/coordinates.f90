!> Coordinates of a deck, other rows of reals, and arcs by their ends and their centre.
module atrito_coordinates
   use atrito_deck, only: data_line_t, deck_t, keyword_name, line_item, token_t
   use atrito_diagnostics, only: report_error
   use atrito_items, only: get_real
   use atrito_kinds, only: ip, wp
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: get_coordinate, get_reals, is_coordinate, spread_of_nodes, FLAT, get_point, centre_arc

   !> Areas and their squares must be numbers, too.
   real(wp), parameter :: LARGEST_COORDINATE = 1.0e60_wp

   !> A z up to this part of the scene is what preprocessors leave of a rotation.
   real(wp), parameter :: FLAT = 1.0e-10_wp

   !> Coordinates of a deck have a few digits: the centre of an arc lies as far from both ends within this part of the radius.
   real(wp), parameter :: RADIUS_TOLERANCE = 1.0e-4_wp

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

end module atrito_coordinates
