!> Coordinates of a deck.
module atrito_coordinates
   use atrito_deck, only: deck_t, token_t
   use atrito_diagnostics, only: report_error
   use atrito_items, only: get_real
   use atrito_kinds, only: wp
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: get_coordinate, is_coordinate

   !> Areas and their squares must be numbers, too.
   real(wp), parameter :: LARGEST_COORDINATE = 1.0e60_wp

contains

   !> The coordinate that an item is.
   subroutine get_coordinate(deck, token, what, x, ok, keyword, default)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      character(len=*), intent(in) :: what             !< e.g. 'x, a real [L]'
      real(wp), intent(out) :: x
      logical, intent(out) :: ok
      character(len=*), intent(in) :: keyword
      real(wp), intent(in), optional :: default        !< of an empty item [L]

      call get_real(deck, token, what, x, ok, default, keyword)
      if (.not. ok .or. is_coordinate(x)) return
      ok = .false.
      call report_error(deck, token, 'E-VALUE', 'a coordinate of '//to_text(x), expected=what//', at most '// &
                        to_text(LARGEST_COORDINATE), keyword=keyword)
   end subroutine get_coordinate

   !> Whether a number may be one.
   pure logical function is_coordinate(x)
      real(wp), intent(in) :: x                        !< [L]

      is_coordinate = abs(x) <= LARGEST_COORDINATE
   end function is_coordinate

end module atrito_coordinates
