!> Points that a deck gives, and arcs by their ends and their centre.
module atrito_arcs
   use atrito_coordinates, only: get_coordinate
   use atrito_deck, only: deck_t, data_line_t, token_t, line_item
   use atrito_diagnostics, only: report_error
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: get_point, centre_arc

   !> Coordinates of a deck have a few digits: the centre of an arc lies as far from both ends within this part of the radius.
   real(wp), parameter :: RADIUS_TOLERANCE = 1.0e-4_wp

contains

   !> Two items of a line that are the coordinates of a point.
   subroutine get_point(deck, line, first, what, x, ok, keyword)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(data_line_t), intent(in) :: line            !< data line of the deck
      integer(ip), intent(in) :: first                 !< item
      character(len=*), intent(in) :: what(2)          !< what is expected
      real(wp), intent(out) :: x(2)                    !< [L]
      logical, intent(inout) :: ok                     !< false where there is an error
      character(len=*), intent(in) :: keyword          !< of the card, for `atrito help KEYWORD`
      integer(ip) :: k
      logical :: good

      do k = 1, 2
         call get_coordinate(deck, line_item(deck, line, first + k - 1), trim(what(k)), x(k), good, keyword)
         ok = ok .and. good
      end do
   end subroutine get_point

   !> The centre is as far from both ends, within the digits of a deck, and moved so that it is exactly; the arc is less than a half
   !> circle, else it could run on either side.
   subroutine centre_arc(deck, tokens, a, b, centre, ok, keyword)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(token_t), intent(in) :: tokens(2)           !< of the centre, and of the arc
      real(wp), intent(in) :: a(2), b(2)               !< ends [L]
      real(wp), intent(inout) :: centre(2)             !< [L]
      logical, intent(out) :: ok                       !< it is such an arc; else that is reported
      character(len=*), intent(in) :: keyword          !< of the card, for `atrito help KEYWORD`
      real(wp) :: chord(2), middle(2), radius(2)

      radius = [norm2(a - centre), norm2(b - centre)]
      ok = abs(radius(1) - radius(2)) <= RADIUS_TOLERANCE*maxval(radius)
      if (.not. ok) then
         call report_error(deck, tokens(1), 'E-VALUE', 'the centre is '//to_text(radius(1))// &
                           ' from the start of the arc and '//to_text(radius(2))//' from its end', &
                           expected='a centre as far from both ends, within 1e-4 [L]', keyword=keyword)
         return
      end if
      chord = (b - a)/norm2(b - a)
      middle = 0.5_wp*a + 0.5_wp*b
      centre = centre - dot_product(centre - middle, chord)*chord
      ok = norm2(centre - middle) > RADIUS_TOLERANCE*maxval(radius)
      if (.not. ok) call report_error(deck, tokens(2), 'E-VALUE', 'the arc is a half circle, which could '// &
                                      'run on either side', expected='arcs of less than 180 degrees', keyword=keyword)
   end subroutine centre_arc

end module atrito_arcs
