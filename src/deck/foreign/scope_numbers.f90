!> The numbers of a deck in parts: those of each instance begin at 1 again, in the model each node and element has one of its own.
module atrito_scope_numbers
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t
   use atrito_diagnostics, only: report_error
   use atrito_kinds, only: ip, lp
   use atrito_numbers, only: read_integer, NUMBER_OK
   implicit none (type, external)
   private
   public :: number_scopes

   !> Numbers of an instance begin behind a multiple of this, or of a greater power of ten.
   integer(lp), parameter :: LEAST_ROUND = 100_lp

contains

   !> The first scope with nodes keeps its numbers. To those of the next ones a power of ten is added, its double and so on: the
   !> least power that is greater than any number; or, where there is no room for that, what fits.
   subroutine number_scopes(deck)
      type(deck_t), intent(inout) :: deck !< its scopes get `shift` and `span`
      integer(ip) :: greatest(0:size(deck%scopes) - 1), order(size(deck%scopes)), i, n
      integer(lp) :: round, shift, spans(size(deck%scopes))

      n = size(order, kind=ip)
      call find_numbers(deck, greatest, order)
      round = LEAST_ROUND
      do while (round <= maxval(greatest))
         round = 10_lp*round
      end do
      spans = round - 1_lp
      if (n*round > int(huge(1_ip), lp)) spans = greatest(order)
      shift = 0_lp
      do i = 1, n
         deck%scopes(order(i))%shift = int(min(shift, int(huge(1_ip), lp)), ip)
         deck%scopes(order(i))%span = int(min(spans(i), huge(1_ip) - shift), ip)
         shift = shift + spans(i)
         if (spans(i) == round - 1_lp) shift = shift + 1_lp
      end do
      if (shift > int(huge(1_ip), lp)) call report_error(deck, deck%cards(deck%scopes(1)%card)%place, 'E-ID', &
                                                         'the numbers of all instances do not fit one behind the other', &
                                                         expected='less than 2147483647 in all', keyword='INSTANCE')
   end subroutine number_scopes

   !> The greatest number of a node or element of each scope, and the scopes in the order of their first nodes.
   subroutine find_numbers(deck, greatest, order)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(out) :: greatest(0:)
      integer(ip), intent(out) :: order(:)
      logical :: has_nodes(0:size(greatest) - 1)
      integer(ip) :: i, k, n

      greatest = 0
      has_nodes = .false.
      n = 0
      do i = 1, deck%n_cards
         associate (card => deck%cards(i))
            select case (card%name)
            case ('NODE', 'ELEMENT', 'ELGEN')
               do k = card%first_line, card%first_line + card%n_lines - 1
                  greatest(card%scope) = max(greatest(card%scope), greatest_of(deck, card, deck%lines(k)))
               end do
            end select
            if (card%name /= 'NODE' .or. has_nodes(card%scope)) cycle
            has_nodes(card%scope) = .true.
            n = n + 1
            order(n) = card%scope
         end associate
      end do
      do i = 0, size(greatest, kind=ip) - 1
         if (has_nodes(i)) cycle
         n = n + 1
         order(n) = i
      end do
   end subroutine find_numbers

   !> The greatest number that a line makes.
   pure integer(ip) function greatest_of(deck, card, line) result(greatest)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(data_line_t), intent(in) :: line
      integer(lp) :: last
      integer(ip) :: k

      last = max(integer_of(deck, line, 1_ip, 0_ip), 0)
      if (card%name == 'ELGEN') then
         do k = 2, line%n_tokens, 3
            last = last + (int(integer_of(deck, line, k, 1_ip), lp) - 1_lp)*int(integer_of(deck, line, k + 2, 1_ip), lp)
         end do
      end if
      greatest = int(max(0_lp, min(last, int(huge(1_ip), lp))), ip)
   end function greatest_of

   !> An item that is a plain integer; another value where it is none.
   pure integer(ip) function integer_of(deck, line, i, default) result(number)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: i, default
      type(token_t) :: token
      integer :: outcome

      number = default
      if (i > line%n_tokens) return
      token = deck%tokens(line%first_token + i - 1)
      if (token%last < token%first) return
      call read_integer(deck%sources(token%source)%text(token%first:token%last), number, outcome)
      if (outcome /= NUMBER_OK) number = default
   end function integer_of

end module atrito_scope_numbers
