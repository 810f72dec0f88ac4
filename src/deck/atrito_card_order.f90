!> Where a keyword stands: model, step, or behind the end; and to what it belongs.
module atrito_card_order
   use atrito_deck, only: deck_t, card_t, token_t, KEYWORD_UNKNOWN, LEVEL_MODEL, LEVEL_STEP
   use atrito_diagnostics, only: report_error, report_deck_error
   use atrito_keyword, only: LEVEL_BOTH
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: order_t, check_order, check_end

   !> What has been read so far.
   type :: order_t
      logical :: in_step = .false.
      integer(ip) :: n_steps = 0
      type(token_t) :: step                        !< the *STEP begun last
      character(len=32) :: parent = ''             !< keyword to whose block the next ones belong
      logical :: incomplete = .false.              !< a file could not be read: no word about what is missing
   end type order_t

contains

   !> Checks the place of a card and marks its level.
   subroutine check_order(deck, order, card)
      type(deck_t), intent(in) :: deck
      type(order_t), intent(inout) :: order
      type(card_t), intent(inout) :: card

      card%level = merge(LEVEL_STEP, LEVEL_MODEL, order%in_step)
      card%step = merge(order%n_steps, 0_ip, order%in_step)
      if (card%keyword == KEYWORD_UNKNOWN) return
      select case (card%name)
      case ('STEP')
         call begin_step(deck, order, card)
      case ('END STEP')
         if (.not. order%in_step) call refuse(deck, card, 'E-STEP', '*END STEP without a *STEP', '*STEP before it')
         order%in_step = .false.
      case default
         call check_level(deck, order, card)
      end select
      call check_parent(deck, order, card)
   end subroutine check_order

   subroutine begin_step(deck, order, card)
      type(deck_t), intent(in) :: deck
      type(order_t), intent(inout) :: order
      type(card_t), intent(inout) :: card

      if (order%in_step) call refuse(deck, card, 'E-STEP', '*STEP inside a step', 'the *END STEP of the step before')
      order%n_steps = order%n_steps + 1
      order%in_step = .true.
      order%step = card%place
      card%level = LEVEL_STEP
      card%step = order%n_steps
   end subroutine begin_step

   subroutine check_level(deck, order, card)
      type(deck_t), intent(in) :: deck
      type(order_t), intent(in) :: order
      type(card_t), intent(inout) :: card
      integer :: level

      level = deck%keywords(card%keyword)%level
      if (order%n_steps > 0 .and. .not. order%in_step) then
         call refuse(deck, card, 'E-STEP', '*'//trim(card%name)//' stands after an *END STEP', &
                     'a *STEP, or nothing behind it')
      else if (level == LEVEL_MODEL .and. order%in_step) then
         call refuse(deck, card, 'E-LEVEL', '*'//trim(card%name)//' stands inside the step', 'its place before *STEP')
      else if (level == LEVEL_STEP .and. .not. order%in_step) then
         call refuse(deck, card, 'E-LEVEL', '*'//trim(card%name)//' stands outside of a step', &
                     'its place between *STEP and *END STEP')
      end if
   end subroutine check_level

   !> *ELASTIC belongs to the *MATERIAL before it; what may stand anywhere may stand between.
   subroutine check_parent(deck, order, card)
      type(deck_t), intent(in) :: deck
      type(order_t), intent(inout) :: order
      type(card_t), intent(inout) :: card

      associate (keyword => deck%keywords(card%keyword))
         if (len(keyword%parent) == 0) then
            if (keyword%level /= LEVEL_BOTH .and. .not. keyword%harmless) order%parent = card%name
         else if (keyword%parent /= order%parent) then
            call refuse(deck, card, 'E-PARENT', '*'//trim(card%name)//' belongs to no *'//keyword%parent, &
                        'its place behind *'//keyword%parent)
         end if
      end associate
   end subroutine check_parent

   !> Checks at the end of the deck that there was a step and that it ended.
   subroutine check_end(deck, order)
      type(deck_t), intent(in) :: deck
      type(order_t), intent(in) :: order

      if (order%incomplete) return
      if (deck%n_cards == 0) then
         call report_deck_error(deck, 'E-EMPTY', 'the deck holds no keyword', expected='a deck, see atrito help')
      else if (order%n_steps == 0) then
         call report_deck_error(deck, 'E-STEP', 'the deck has no *STEP', expected='*STEP ... *END STEP', keyword='STEP')
      else if (order%in_step) then
         call report_error(deck, order%step, 'E-STEP', '*STEP without *END STEP', expected='*END STEP at the end of the deck', &
                           keyword='STEP')
      end if
   end subroutine check_end

   subroutine refuse(deck, card, id, text, expected)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(inout) :: card
      character(len=*), intent(in) :: id, text, expected

      card%ok = .false.
      call report_error(deck, card%place, id, text, expected=expected, keyword=trim(card%name))
   end subroutine refuse

end module atrito_card_order
