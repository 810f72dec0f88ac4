!> *SURFACE INTERACTION with *SURFACE BEHAVIOR and *FRICTION, and *CONTACT PAIR.
module atrito_build_contact
   use atrito_deck, only: deck_t, card_t, token_t, count_lines, line_item, is_empty_token, keyword_name
   use atrito_adjustment, only: read_adjustment
   use atrito_contact_rules, only: quadrature_of
   use atrito_diagnostics, only: report_error, report_note
   use atrito_build_context, only: build_context_t, keep_token, define_name, count_cards
   use atrito_items, only: check_comma, get_real, has_option, option_text, option_word
   use atrito_kinds, only: ip, wp
   use atrito_model, only: interaction_t, pair_t, QUADRATURE_AUTO, QUADRATURE_NODAL, &
                           FRICTION_NONE, FRICTION_LOCAL, FRICTION_NONLOCAL, KERNEL_LINE
   use atrito_name_list, only: find_name
   use atrito_references, only: find_surface, report_unknown
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: build_contact

contains

   !> All interactions and pairs of a model.
   subroutine build_contact(context)
      type(build_context_t), intent(inout) :: context  !< its model gets interactions and pairs
      logical :: given(2)                              ! *SURFACE BEHAVIOR, *FRICTION of the current interaction
      character(len=:), allocatable :: name
      integer(ip) :: i, current, n_pairs

      allocate (context%model%interactions(count_cards(context%deck, 'SURFACE INTERACTION')), &
                context%model%pairs(count_lines(context%deck, 'CONTACT PAIR')))
      current = 0
      given = .false.
      n_pairs = 0
      do i = 1, context%deck%n_cards
         associate (deck => context%deck, card => context%deck%cards(i), interactions => context%model%interactions)
            select case (keyword_name(card))
            case ('SURFACE INTERACTION')
               call define_name(deck, card, 'surface interaction', context%interaction_names, context%interactions, name, current)
               if (current > 0) interactions(current)%name = name
               given = .false.
            case ('SURFACE BEHAVIOR')
               if (current > 0) call read_behavior_card(deck, card, interactions(current), given(1))
            case ('FRICTION')
               if (current > 0) call read_friction_card(deck, card, interactions(current), given(2))
            end select
         end associate
      end do
      context%model%interactions = context%model%interactions(:context%interaction_names%n)
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == 'CONTACT PAIR') call read_pair_card(context%deck%cards(i), context, n_pairs)
      end do
      context%model%pairs = context%model%pairs(:n_pairs)
   end subroutine build_contact

   !> The data line of a card that an interaction has at most once; a second card is reported, unless it stands in a wrong place,
   !> which the reader has reported. has_line: there is one to be read.
   subroutine take_once(deck, card, name, given, has_line)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: name             !< of the interaction
      logical, intent(inout) :: given
      logical, intent(out) :: has_line

      has_line = .not. given .and. card%n_lines > 0
      if (has_line) has_line = deck%lines(card%first_line)%ok
      if (given .and. card%ok) call report_error(deck, card%place, 'E-TWICE', 'surface interaction '//name//' has two *'// &
                                                 keyword_name(card), expected='one *'//keyword_name(card)//' a surface interaction')
      given = .true.
   end subroutine take_once

   !> *SURFACE BEHAVIOR: the compliance delta of the normal direction, p = -g/delta where the gap g < 0; 0 is hard contact.
   subroutine read_behavior_card(deck, card, interaction, given)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(interaction_t), intent(inout) :: interaction
      logical, intent(inout) :: given
      real(wp) :: slope
      logical :: ok

      call take_once(deck, card, interaction%name, given, ok)
      if (.not. ok) return
      associate (item => line_item(deck, deck%lines(card%first_line), 1_ip))
         select case (option_word(deck, card, 'PRESSURE-OVERCLOSURE'))
         case ('LINEAR')
            call get_value(deck, item, 'slope, a real > 0 [F/L^3]', .true., slope, ok)
            if (ok) interaction%delta = 1.0_wp/slope
         case ('PENALTY')
            call get_value(deck, item, 'delta, a real >= 0 [L^3/F]', .false., interaction%delta, ok)
         end select
      end associate
   end subroutine read_behavior_card

   !> A value that is not negative, or positive. Its reciprocal must be a number, too.
   subroutine get_value(deck, token, what, is_positive, value, ok)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      character(len=*), intent(in) :: what
      logical, intent(in) :: is_positive
      real(wp), intent(out) :: value
      logical, intent(out) :: ok

      call get_real(deck, token, what, value, ok)
      if (.not. ok .or. value > 1.0_wp/huge(1.0_wp)) return
      ok = .not. (is_positive .or. abs(value) > 0.0_wp)
      if (.not. ok) call report_error(deck, token, 'E-VALUE', to_text(value)//' is out of range', expected=what)
   end subroutine get_value

   !> *FRICTION: nu, and of NONLOCAL friction eps and rho, of local friction the slope of sticking.
   subroutine read_friction_card(deck, card, interaction, given)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(interaction_t), intent(inout) :: interaction
      logical, intent(inout) :: given
      type(token_t) :: items(3)
      integer(ip) :: k
      logical :: ok

      call take_once(deck, card, interaction%name, given, ok)
      if (.not. ok) return
      items = [(line_item(deck, deck%lines(card%first_line), k), k=1, 3)]
      call get_value(deck, items(1), 'coefficient of friction nu, a real >= 0 [-]', .false., interaction%nu, ok)
      if (has_option(deck, card, 'NONLOCAL')) then
         interaction%friction = FRICTION_NONLOCAL
         call get_value(deck, items(2), 'slip eps, a real >= 0 [L]', .false., interaction%eps, ok)
         call get_value(deck, items(3), 'radius rho, a real >= 0 [L]', .false., interaction%rho, ok)
         if (option_word(deck, card, 'KERNEL') == 'LINE') interaction%kernel = KERNEL_LINE
         interaction%is_incremental = option_word(deck, card, 'SLIP') == 'INCREMENTAL'
      else
         interaction%friction = FRICTION_LOCAL
         interaction%is_incremental = option_word(deck, card, 'SLIP') /= 'TOTAL'
         if (ok) ok = check_comma(deck, deck%lines(card%first_line), 1_ip, 'nu [-]; a stick slope behind it as 1000.')
         if (ok .and. .not. is_empty_token(items(2))) then
            call get_value(deck, items(2), 'stick slope, a real > 0 [F/L^3]', .true., interaction%stick_slope, ok)
         end if
      end if
      ! without a coefficient there are no tangential unknowns at all
      if (.not. interaction%nu > 0.0_wp) interaction%friction = FRICTION_NONE
   end subroutine read_friction_card

   !> *CONTACT PAIR: slave, master.
   subroutine read_pair_card(card, context, n_pairs)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(inout) :: n_pairs            !< that there are
      type(pair_t) :: pair
      type(token_t) :: place, slave, master
      character(len=:), allocatable :: name
      integer(ip) :: i
      logical :: found

      call option_text(context%deck, card, 'INTERACTION', name, found, place)
      pair%interaction = find_name(context%interaction_names, name)
      if (found .and. pair%interaction == 0) call report_unknown(context, place, 'surface interaction', 'E-INTERACTION', &
                                                                 context%interaction_names)
      call read_quadrature(context%deck, card, pair%quadrature)
      call read_adjustment(context, card, pair)
      do i = card%first_line, card%first_line + card%n_lines - 1
         associate (line => context%deck%lines(i))
            if (.not. line%ok) cycle
            slave = line_item(context%deck, line, 1_ip)
            master = line_item(context%deck, line, 2_ip)
         end associate
         call find_surface(context, slave, pair%slave)
         call find_surface(context, master, pair%master)
         context%pairs_undetermined = context%pairs_undetermined .or. pair%interaction == 0
         if (min(pair%interaction, pair%slave, pair%master) == 0) cycle
         n_pairs = n_pairs + 1
         context%model%pairs(n_pairs) = pair
         call keep_token(context%slaves, n_pairs, slave)
         call keep_token(context%masters, n_pairs, master)
      end do
   end subroutine read_pair_card

   !> QUADRATURE, or TYPE in the words of other programs.
   subroutine read_quadrature(deck, card, quadrature)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      integer(ip), intent(out) :: quadrature
      character(len=:), allocatable :: word
      type(token_t) :: place
      integer(ip) :: by_type
      logical :: found

      quadrature = quadrature_of(option_word(deck, card, 'QUADRATURE'))
      by_type = quadrature_of(option_word(deck, card, 'TYPE'))
      if (by_type == QUADRATURE_AUTO) return
      call option_text(deck, card, 'TYPE', word, found, place)
      word = 'TYPE='//option_word(deck, card, 'TYPE')
      if (quadrature == QUADRATURE_AUTO) then
         call report_note(deck, place, 'N-QUADRATURE', word//' means QUADRATURE='// &
                          merge('NODAL ', 'MORTAR', by_type == QUADRATURE_NODAL))
         quadrature = by_type
      else if (quadrature /= by_type) then
         call report_error(deck, place, 'E-QUADRATURE', word//' and QUADRATURE='//option_word(deck, card, 'QUADRATURE')// &
                           ' are different things', expected='one of them')
      end if
   end subroutine read_quadrature

end module atrito_build_contact
