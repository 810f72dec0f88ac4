!> *OBSERVE: the lines of all its cards. What they mean is found out where expressions are evaluated.
module atrito_observed_lines
   use atrito_deck, only: deck_t, count_lines, keyword_name, line_item, token_t, token_text
   use atrito_kinds, only: ip
   use atrito_model, only: observed_line_t
   implicit none (type, external)
   private
   public :: list_observed

contains

   !> The lines in the order of the deck.
   pure subroutine list_observed(deck, lines)
      type(deck_t), intent(in) :: deck                            !< as read
      type(observed_line_t), allocatable, intent(out) :: lines(:) !< not evaluated yet
      type(token_t) :: token
      integer(ip) :: i, k, n

      allocate (lines(count_lines(deck, 'OBSERVE')))
      n = 0
      do i = 1, deck%n_cards
         if (keyword_name(deck%cards(i)) /= 'OBSERVE') cycle
         do k = deck%cards(i)%first_line, deck%cards(i)%first_line + deck%cards(i)%n_lines - 1
            token = line_item(deck, deck%lines(k), 1_ip)
            n = n + 1
            lines(n)%text = token_text(deck, token)
            lines(n)%file = deck%sources(token%source)%name
            lines(n)%line = token%line
            lines(n)%column = token%column
         end do
      end do
   end subroutine list_observed

end module atrito_observed_lines
