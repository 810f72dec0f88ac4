!> *STEP and *STATIC: the steps of the history, and how each goes through its time.
module atrito_build_steps
   use atrito_build_context, only: build_context_t
   use atrito_deck, only: deck_t, card_t, data_line_t, keyword_name, last_item, token_t, token_text, line_item
   use atrito_kinds, only: ip
   use atrito_model, only: step_t
   implicit none (type, external)
   private
   public :: build_steps, open_step

contains

   !> The steps, with nothing in them yet; one at least.
   subroutine build_steps(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i

      allocate (context%model%steps(max(1_ip, maxval(context%deck%cards(:context%deck%n_cards)%step))))
      allocate (context%model%amplitudes(0))
      do i = 1, size(context%model%steps, kind=ip)
         context%model%steps(i)%title = ''
      end do
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) /= 'STEP') cycle
         call read_title(context%deck, context%deck%cards(i), context%model%steps(context%deck%cards(i)%step))
      end do
   end subroutine build_steps

   !> The lines behind *STEP, one after the other.
   subroutine read_title(deck, card, step)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(step_t), intent(inout) :: step
      integer(ip) :: k

      do k = card%first_line, card%first_line + card%n_lines - 1
         if (k > card%first_line) step%title = step%title//' '
         step%title = step%title//line_text(deck, deck%lines(k))
      end do
   end subroutine read_title

   !> A whole line, its commas, too.
   pure function line_text(deck, line) result(text)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      character(len=:), allocatable :: text
      type(token_t) :: whole, last

      text = ''
      if (line%n_tokens == 0) return
      whole = line_item(deck, line, 1_ip)
      last = last_item(deck, line)
      whole%last = last%last
      text = token_text(deck, whole)
   end function line_text

   !> Begins with what a step holds.
   subroutine open_step(context, number)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: number
      integer(ip) :: i

      context%open%number = number
      context%open%first_token = 0
      context%open%amplitude = 0
      if (number == 1) return
      do i = 1, context%deck%n_cards
         if (context%deck%cards(i)%step /= number .or. context%deck%cards(i)%n_lines == 0) cycle
         context%open%first_token = context%deck%lines(context%deck%cards(i)%first_line)%first_token
         return
      end do
      context%open%first_token = huge(1_ip)
   end subroutine open_step

end module atrito_build_steps
