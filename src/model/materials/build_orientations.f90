!> *ORIENTATION: the first axis of a material in the plane.
module atrito_build_orientations
   use atrito_build_context, only: build_context_t, define_name, count_cards
   use atrito_deck, only: card_t, deck_t, data_line_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_items, only: get_real, get_integer
   use atrito_kinds, only: ip, wp, PI
   implicit none (type, external)
   private
   public :: build_orientations

   character(len=*), parameter :: KEYWORD = 'ORIENTATION'

contains

   !> All *ORIENTATION cards: context%orientation_axis, 0 where a card is faulty.
   subroutine build_orientations(context)
      type(build_context_t), intent(inout) :: context
      character(len=:), allocatable :: name
      real(wp) :: axis(2)
      integer(ip) :: i, place

      allocate (context%orientation_axis(2, count_cards(context%deck, KEYWORD)), source=0.0_wp)
      if (size(context%orientation_axis) == 0) return
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) /= KEYWORD) cycle
         call define_name(context%deck, context%deck%cards(i), 'orientation', context%orientation_names, context%orientations, &
                          name, place)
         if (place == 0) cycle
         call read_axis(context%deck%cards(i), context%deck, axis)
         context%orientation_axis(:, place) = axis
      end do
   end subroutine build_orientations

   !> The direction of the first axis; 0: it is faulty.
   subroutine read_axis(card, deck, axis)
      type(card_t), intent(in) :: card
      type(deck_t), intent(in) :: deck
      real(wp), intent(out) :: axis(2)
      real(wp) :: a(3), b(3), turn
      logical :: ok

      axis = 0.0_wp
      if (card%n_lines == 0 .or. .not. card%ok) return
      if (.not. all(deck%lines(card%first_line:card%first_line + card%n_lines - 1)%ok)) return
      call read_points(deck%lines(card%first_line), deck, a, b, ok)
      if (.not. ok) return
      turn = 0.0_wp
      if (card%n_lines > 1) call read_turn(deck%lines(card%first_line + 1), deck, turn, ok)
      if (.not. ok) return
      a = a/norm2(a)
      turn = sign(turn, turn*(a(1)*b(2) - a(2)*b(1)))   ! round the third axis, which points to the viewer or away
      axis = [cosine(turn)*a(1) - cosine(90 - turn)*a(2), cosine(90 - turn)*a(1) + cosine(turn)*a(2)]
   end subroutine read_axis

   !> Of an angle in degrees, exact at multiples of 90.
   pure real(wp) function cosine(angle)
      real(wp), intent(in) :: angle

      cosine = cos(angle*(PI/180))
      if (.not. abs(modulo(angle, 90.0_wp)) > 0.0_wp) cosine = anint(cosine)
   end function cosine

   !> Two points in the plane that span it.
   subroutine read_points(line, deck, a, b, ok)
      type(data_line_t), intent(in) :: line
      type(deck_t), intent(in) :: deck
      real(wp), intent(out) :: a(3), b(3)
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT = 'coordinate, a real [L]'
      real(wp), parameter :: FLAT = 1.0e-10_wp         ! what rounding leaves of 0
      logical :: good(6)
      integer(ip) :: i

      do i = 1, 3
         call get_real(deck, line_item(deck, line, i), WHAT, a(i), good(i), keyword=KEYWORD)
         call get_real(deck, line_item(deck, line, i + 3), WHAT, b(i), good(i + 3), keyword=KEYWORD)
      end do
      ok = all(good)
      if (.not. ok) return
      if (abs(a(3)) <= FLAT*maxval(abs(a(:2)))) a(3) = 0.0_wp
      if (abs(b(3)) <= FLAT*maxval(abs(b(:2)))) b(3) = 0.0_wp
      ok = .not. (abs(a(3)) > 0.0_wp .or. abs(b(3)) > 0.0_wp)
      if (.not. ok) then
         call report_error(deck, line_item(deck, line, merge(3_ip, 6_ip, abs(a(3)) > 0.0_wp)), 'E-VALUE', &
                           'the scene is plane: these axes leave it', expected='za = zb = 0', keyword=KEYWORD)
         return
      end if
      if (maxval(abs(a)) > 0.0_wp) a = a/maxval(abs(a))
      if (maxval(abs(b)) > 0.0_wp) b = b/maxval(abs(b))
      ok = abs(a(1)*b(2) - a(2)*b(1)) > 1.0e-12_wp*norm2(a)*norm2(b)
      if (.not. ok) call report_error(deck, line_item(deck, line, 4_ip), 'E-VALUE', 'the points give no two axes', &
                                      expected='points a and b in two directions from the origin', keyword=KEYWORD)
   end subroutine read_points

   !> A rotation about one of the axes, the third one here.
   subroutine read_turn(line, deck, turn, ok)
      type(data_line_t), intent(in) :: line
      type(deck_t), intent(in) :: deck
      real(wp), intent(out) :: turn                    !< [degrees]
      logical, intent(out) :: ok
      integer(ip) :: about
      logical :: good(2)

      call get_integer(deck, line_item(deck, line, 1_ip), 'local axis, 1, 2 or 3', about, good(1), keyword=KEYWORD)
      call get_real(deck, line_item(deck, line, 2_ip), 'angle, a real in degrees', turn, good(2), 0.0_wp, KEYWORD)
      ok = all(good)
      if (.not. ok .or. about == 3 .or. .not. abs(turn) > 0.0_wp) return
      ok = .false.
      call report_error(deck, line_item(deck, line, 1_ip), 'E-VALUE', 'the scene is plane: this rotation leaves it', &
                        expected='3, the axis across the plane', keyword=KEYWORD)
   end subroutine read_turn

end module atrito_build_orientations
