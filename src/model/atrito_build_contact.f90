!> *SURFACE INTERACTION with *SURFACE BEHAVIOR and *FRICTION, and *CONTACT PAIR.
module atrito_build_contact
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t, token_text, line_item, is_empty_token, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_draft, only: draft_t, keep_token, define_name, count_cards
   use atrito_items, only: get_real, has_option, option_text, option_word
   use atrito_kinds, only: ip, wp
   use atrito_model, only: interaction_t, pair_t, FRICTION_NONE, FRICTION_LOCAL, FRICTION_NONLOCAL, KERNEL_LINE
   use atrito_name_list, only: find_name
   use atrito_references, only: report_unknown
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: build_contact

contains

   !> All interactions and pairs of a model.
   subroutine build_contact(draft)
      type(draft_t), intent(inout) :: draft
      logical :: given(2)                              ! *SURFACE BEHAVIOR, *FRICTION of the current interaction
      integer(ip) :: i, current, n_pairs

      allocate (draft%model%interactions(count_cards(draft%deck, 'SURFACE INTERACTION')), &
                draft%model%pairs(count_pair_lines(draft%deck)))
      current = 0
      given = .false.
      do i = 1, draft%deck%n_cards
         select case (keyword_name(draft%deck%cards(i)))
         case ('SURFACE INTERACTION')
            call read_interaction_card(draft%deck%cards(i), draft, current)
            given = .false.
         case ('SURFACE BEHAVIOR')
            if (current > 0) call read_behavior_card(draft%deck, draft%deck%cards(i), draft%model%interactions(current), given(1))
         case ('FRICTION')
            if (current > 0) call read_friction_card(draft%deck, draft%deck%cards(i), draft%model%interactions(current), given(2))
         end select
      end do
      draft%model%interactions = draft%model%interactions(:draft%interaction_names%n)
      n_pairs = 0
      do i = 1, draft%deck%n_cards
         if (keyword_name(draft%deck%cards(i)) == 'CONTACT PAIR') call read_pair_card(draft%deck%cards(i), draft, &
                                                                                      n_pairs)
      end do
      draft%model%pairs = draft%model%pairs(:n_pairs)
   end subroutine build_contact

   !> Each line makes a pair at most.
   pure integer(ip) function count_pair_lines(deck) result(n)
      type(deck_t), intent(in) :: deck
      integer(ip) :: i

      n = 0
      do i = 1, deck%n_cards
         if (keyword_name(deck%cards(i)) == 'CONTACT PAIR') n = n + deck%cards(i)%n_lines
      end do
   end function count_pair_lines

   subroutine read_interaction_card(card, draft, current)
      type(card_t), intent(in) :: card
      type(draft_t), intent(inout) :: draft
      integer(ip), intent(out) :: current              !< the interaction that has begun; 0: none
      character(len=:), allocatable :: name

      call define_name(draft%deck, card, 'surface interaction', draft%interaction_names, draft%interactions, name, current)
      if (current > 0) draft%model%interactions(current) = interaction_t(name=name)
   end subroutine read_interaction_card

   !> A keyword that an interaction has at most once.
   logical function is_first(deck, card, name, given)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: name             !< of the interaction
      logical, intent(inout) :: given

      is_first = .not. given
      given = .true.
      ! one that stands in a wrong place is reported by the reader
      if (is_first .or. .not. card%ok) return
      call report_error(deck, card%place, 'E-TWICE', 'surface interaction '//name//' has two *'//keyword_name(card), &
                        expected='one *'//keyword_name(card)//' a surface interaction', keyword=keyword_name(card))
   end function is_first

   subroutine read_behavior_card(deck, card, interaction, given)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(interaction_t), intent(inout) :: interaction
      logical, intent(inout) :: given
      real(wp) :: slope
      logical :: ok

      if (.not. is_first(deck, card, interaction%name, given)) return
      if (card%n_lines == 0) return
      associate (line => deck%lines(card%first_line))
         if (.not. line%ok) return
         select case (option_word(deck, card, 'PRESSURE-OVERCLOSURE'))
         case ('LINEAR')
            call get_value(deck, card, line_item(deck, line, 1_ip), 'slope, a real > 0 [F/L^3]', slope, ok, positive=.true.)
            if (ok) interaction%delta = 1.0_wp/slope
         case ('PENALTY')
            call get_value(deck, card, line_item(deck, line, 1_ip), 'delta, a real >= 0 [L^3/F]', interaction%delta, ok)
         end select
      end associate
   end subroutine read_behavior_card

   !> A value that is not negative, or positive. Its reciprocal must be a number, too.
   subroutine get_value(deck, card, token, what, value, ok, positive)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(token_t), intent(in) :: token
      character(len=*), intent(in) :: what
      real(wp), intent(out) :: value
      logical, intent(out) :: ok
      logical, intent(in), optional :: positive
      logical :: may_be_zero

      call get_real(deck, token, what, value, ok, keyword=keyword_name(card))
      if (.not. ok) return
      may_be_zero = .not. present(positive)
      if (may_be_zero .and. .not. abs(value) > 0.0_wp) return
      ok = value > 1.0_wp/huge(1.0_wp)
      if (.not. ok) call report_error(deck, token, 'E-VALUE', to_text(value)//' is out of range', expected=what, &
                                      keyword=keyword_name(card))
   end subroutine get_value

   subroutine read_friction_card(deck, card, interaction, given)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(interaction_t), intent(inout) :: interaction
      logical, intent(inout) :: given
      logical :: ok

      if (.not. is_first(deck, card, interaction%name, given)) return
      if (card%n_lines == 0) return
      associate (line => deck%lines(card%first_line))
         if (.not. line%ok) return
         call get_value(deck, card, line_item(deck, line, 1_ip), 'coefficient of friction nu, a real >= 0 [-]', &
                        interaction%nu, ok)
         if (has_option(deck, card, 'NONLOCAL')) then
            interaction%friction = FRICTION_NONLOCAL
            call get_value(deck, card, line_item(deck, line, 2_ip), 'slip eps, a real >= 0 [L]', interaction%eps, ok)
            call get_value(deck, card, line_item(deck, line, 3_ip), 'radius rho, a real >= 0 [L]', interaction%rho, ok)
            if (option_word(deck, card, 'KERNEL') == 'LINE') interaction%kernel = KERNEL_LINE
         else
            interaction%friction = FRICTION_LOCAL
            if (.not. is_empty_token(line_item(deck, line, 2_ip))) then
               call get_value(deck, card, line_item(deck, line, 2_ip), 'stick slope, a real > 0 [F/L^3]', &
                              interaction%stick_slope, ok, positive=.true.)
            end if
         end if
      end associate
      ! without a coefficient there are no tangential unknowns at all
      if (.not. interaction%nu > 0.0_wp) interaction%friction = FRICTION_NONE
   end subroutine read_friction_card

   !> *CONTACT PAIR: slave, master.
   subroutine read_pair_card(card, draft, n_pairs)
      type(card_t), intent(in) :: card
      type(draft_t), intent(inout) :: draft
      integer(ip), intent(inout) :: n_pairs            !< that there are
      type(pair_t) :: pair
      type(token_t) :: place
      character(len=:), allocatable :: name
      integer(ip) :: i
      logical :: found

      call option_text(draft%deck, card, 'INTERACTION', name, found, place)
      pair%interaction = find_name(draft%interaction_names, name)
      if (found .and. pair%interaction == 0) call report_unknown(draft, place, 'surface interaction', 'E-INTERACTION', &
                                                                 draft%interaction_names, 'CONTACT PAIR')
      pair%quadrature_given = has_option(draft%deck, card, 'QUADRATURE')
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (.not. draft%deck%lines(i)%ok) cycle
         call find_surface(draft%deck%lines(i), 1_ip, draft, pair%slave)
         call find_surface(draft%deck%lines(i), 2_ip, draft, pair%master)
         draft%pairs_unsure = draft%pairs_unsure .or. pair%interaction == 0
         if (min(pair%interaction, pair%slave, pair%master) == 0) cycle
         n_pairs = n_pairs + 1
         draft%model%pairs(n_pairs) = pair
         call keep_token(draft%slaves, n_pairs, line_item(draft%deck, draft%deck%lines(i), 1_ip))
         call keep_token(draft%masters, n_pairs, line_item(draft%deck, draft%deck%lines(i), 2_ip))
      end do
   end subroutine read_pair_card

   subroutine find_surface(line, item, draft, surface)
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: item
      type(draft_t), intent(in) :: draft
      integer(ip), intent(out) :: surface              !< place; 0: unknown, reported
      type(token_t) :: token

      token = line_item(draft%deck, line, item)
      surface = find_name(draft%surface_names, token_text(draft%deck, token))
      if (surface == 0) call report_unknown(draft, token, 'surface', 'E-SURFACE', draft%surface_names, 'CONTACT PAIR')
   end subroutine find_surface

end module atrito_build_contact
