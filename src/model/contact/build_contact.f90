!> *SURFACE INTERACTION with *SURFACE BEHAVIOR and *FRICTION, and *CONTACT PAIR.
!>
!> *CONTACT and what belongs to it: which surfaces may touch, and by which law.
module atrito_build_contact
   use atrito_adjustment, only: read_adjustment
   use atrito_build_context, only: build_context_t, keep_token, define_name, count_cards, place_text, has_errors
   use atrito_deck, only: deck_t, card_t, token_t, count_lines, line_item, is_empty_token, keyword_name, token_text
   use atrito_diagnostics, only: report_error, report_note
   use atrito_growth, only: number_list_t, add_number, numbers_of
   use atrito_items, only: check_comma, get_real, has_option, option_text, option_word, option_real
   use atrito_kinds, only: ip, wp, lp
   use atrito_model, only: interaction_t, pair_t, QUADRATURE_AUTO, QUADRATURE_NODAL, FRICTION_NONE, FRICTION_LOCAL, &
                           FRICTION_NONLOCAL, KERNEL_LINE, SURFACE_SEGMENTS, QUADRATURE_MORTAR
   use atrito_name_list, only: find_name
   use atrito_references, only: find_surface, report_unknown
   use atrito_sorting, only: first_at_least, sorted_places
   use atrito_strings, only: to_text, fits_pattern, same_name
   implicit none (type, external)
   private
   public :: build_contact, contact_rules_t, read_contact_rules, add_rule, last_rule, sort_rules, ANY_BODY

   !> Stands for the outlines of all bodies in the place of a surface.
   integer(ip), parameter :: ANY_BODY = 0_ip

   !> Pairs of surfaces, and a number for each.
   type :: rule_list_t
      type(number_list_t) :: a, b                    !< surfaces: places in the model's list, or ANY_BODY
      type(number_list_t) :: value                   !< of each rule
      integer(lp), allocatable :: key(:)             !< sorted: of the surfaces
      integer(ip), allocatable :: order(:)           !< the rules by their keys; of equal ones the last is the last
   end type rule_list_t

   !> What a name with * stands for: surfaces of elements. Rules name the k-th of these by the number of surfaces + k.
   type :: group_t
      character(len=:), allocatable :: pattern       !< the name with * as the deck has it
      integer(ip), allocatable :: surfaces(:)        !< places in the model's list
   end type group_t

   !> *CONTACT with its inclusions, exclusions and assignments.
   type :: contact_rules_t
      logical :: given = .false.                     !< the deck has *CONTACT
      type(token_t) :: place                         !< of the *CONTACT
      real(wp) :: distance = 0.0_wp                  !< [L]; 0: half a face
      integer(ip) :: quadrature = QUADRATURE_AUTO    !< QUADRATURE_*
      type(group_t), allocatable :: groups(:)        !< in the order in which rules name them
      type(rule_list_t) :: included, excluded        !< values are not used
      type(rule_list_t) :: assigned                  !< value: place of the interaction
   end type contact_rules_t

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

   !> All rules of a deck.
   subroutine read_contact_rules(context, rules)
      type(build_context_t), intent(in) :: context   !< its surfaces are known
      type(contact_rules_t), intent(out) :: rules    !< given is false where there are none
      character(len=*), parameter :: WHAT = 'farthest distance of faces that may touch, a real > 0 [L]'
      character(len=:), allocatable :: text
      type(token_t) :: place
      integer(ip) :: i
      logical :: found

      allocate (rules%groups(0))
      do i = 1, context%deck%n_cards
         associate (deck => context%deck, card => context%deck%cards(i))
            select case (keyword_name(card))
            case ('CONTACT')
               if (rules%given) then
                  call report_error(deck, card%place, 'E-TWICE', '*CONTACT is given twice, first in '// &
                                    place_text(deck, rules%place, card%place), &
                                    expected='one *CONTACT, with all that belongs to it', keyword='CONTACT')
                  cycle
               end if
               rules%given = .true.
               rules%place = card%place
               rules%quadrature = quadrature_of(option_word(deck, card, 'QUADRATURE'))
               call option_real(deck, card, 'DISTANCE', WHAT, rules%distance, found)
               if (.not. found .or. rules%distance > 0.0_wp) cycle
               call option_text(deck, card, 'DISTANCE', text, found, place)
               call report_error(deck, place, 'E-VALUE', 'DISTANCE = '//to_text(rules%distance), expected=WHAT, keyword='CONTACT')
            case ('CONTACT INCLUSIONS')
               if (has_option(deck, card, 'ALL EXTERIOR')) call add_rule(rules%included, ANY_BODY, ANY_BODY, 1_ip)
               call read_lines(card, context, rules%included, rules%groups)
            case ('CONTACT EXCLUSIONS')
               call read_lines(card, context, rules%excluded, rules%groups)
            case ('CONTACT PROPERTY ASSIGNMENT')
               call read_lines(card, context, rules%assigned, rules%groups)
            end select
         end associate
      end do
      if (.not. rules%given .or. rules%included%a%n > 0 .or. has_errors()) return
      call report_error(context%deck, rules%place, 'E-MISSING', '*CONTACT includes nothing', &
                        expected='*CONTACT INCLUSIONS, ALL EXTERIOR, or lines of surfaces', keyword='CONTACT INCLUSIONS')
   end subroutine read_contact_rules

   !> By the words of QUADRATURE, and of TYPE in other programs; QUADRATURE_AUTO where there is none.
   pure integer(ip) function quadrature_of(word) result(quadrature)
      character(len=*), intent(in) :: word           !< in capitals; '' where there is none

      select case (word)
      case ('NODAL', 'NODE TO SURFACE')
         quadrature = QUADRATURE_NODAL
      case ('MORTAR', 'SURFACE TO SURFACE')
         quadrature = QUADRATURE_MORTAR
      case default
         quadrature = QUADRATURE_AUTO
      end select
   end function quadrature_of

   !> Lines of two surfaces, and of an interaction where one belongs. Two rigid surfaces cannot touch each other.
   subroutine read_lines(card, context, rules, groups)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(in) :: context
      type(rule_list_t), intent(inout) :: rules
      type(group_t), allocatable, intent(inout) :: groups(:)
      type(token_t) :: items(3)
      integer(ip) :: i, k, surface(2), value
      logical :: ok(3), is_rigid(2)

      do i = card%first_line, card%first_line + card%n_lines - 1
         if (.not. context%deck%lines(i)%ok) cycle
         items = [(line_item(context%deck, context%deck%lines(i), k), k=1, 3)]
         call find_party(items(1), context, ANY_BODY, groups, surface(1), ok(1))
         call find_party(items(2), context, surface(1), groups, surface(2), ok(2))
         value = 1
         if (keyword_name(card) == 'CONTACT PROPERTY ASSIGNMENT') then
            value = find_name(context%interaction_names, token_text(context%deck, items(3)))
            if (value == 0) call report_unknown(context, items(3), 'surface interaction', 'E-INTERACTION', &
                                                context%interaction_names)
         end if
         ok(3) = value > 0
         if (all(ok(:2))) then
            do k = 1, 2
               is_rigid(k) = surface(k) /= ANY_BODY .and. surface(k) <= size(context%model%surfaces)
               if (is_rigid(k)) is_rigid(k) = context%model%surfaces(surface(k))%kind == SURFACE_SEGMENTS
            end do
            ok(1) = .not. all(is_rigid)
            if (.not. ok(1)) call report_error(context%deck, items(1), 'E-PAIR', 'rigid surfaces do not touch each other', &
                                               expected='a surface of elements, or an empty item, and a rigid surface', &
                                               keyword=keyword_name(card))
         end if
         if (all(ok)) call add_rule(rules, surface(1), surface(2), value)
      end do
   end subroutine read_lines

   !> The surface that an item names, or the group of those that fit its pattern; where the item is empty, another one.
   subroutine find_party(token, context, default, groups, surface, ok)
      type(token_t), intent(in) :: token
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: default             !< of an empty item
      type(group_t), allocatable, intent(inout) :: groups(:)
      integer(ip), intent(out) :: surface            !< place, that of a group, or ANY_BODY
      logical, intent(out) :: ok                     !< .false.: unknown, reported

      surface = default
      ok = .true.
      if (is_empty_token(token)) return
      if (index(token_text(context%deck, token), '*') > 0) then
         call find_group(context, token, groups, surface)
         ok = surface > 0
         return
      end if
      call find_surface(context, token, surface)
      ok = surface > 0
      if (.not. ok) return
      associate (line => context%model%surfaces(surface))
         if (line%kind /= SURFACE_SEGMENTS .or. line%is_rigid_body .or. (context%rigid_undetermined .and. has_errors())) return
         ok = .false.
         call report_error(context%deck, token, 'E-PAIR', 'the drawn surface '//line%name//' belongs to no body', &
                           expected='*RIGID BODY, ANALYTICAL SURFACE='//line%name, keyword='RIGID BODY')
      end associate
   end subroutine find_party

   !> The group of a name with *, a new one where it is the first of this name; 0: nothing fits, reported.
   subroutine find_group(context, token, groups, place)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: token
      type(group_t), allocatable, intent(inout) :: groups(:)
      integer(ip), intent(out) :: place
      type(group_t) :: group
      type(group_t), allocatable :: longer(:)
      integer(ip) :: i

      group%pattern = token_text(context%deck, token)
      associate (surfaces => context%model%surfaces)
         do i = 1, size(groups, kind=ip)
            place = size(surfaces, kind=ip) + i
            if (same_name(groups(i)%pattern, group%pattern)) return
         end do
         place = 0
         group%surfaces = pack([(i, i=1, size(surfaces, kind=ip))], [(surfaces(i)%kind /= SURFACE_SEGMENTS .and. &
                                                      fits_pattern(surfaces(i)%name, group%pattern), i=1, size(surfaces, kind=ip))])
         if (size(group%surfaces) == 0) then
            call report_unknown(context, token, 'surface', 'E-SURFACE', context%surface_names)
            return
         end if
         allocate (longer(size(groups) + 1))
         longer(:size(groups)) = groups
         longer(size(longer)) = group
         call move_alloc(longer, groups)
         place = size(surfaces, kind=ip) + size(groups, kind=ip)
      end associate
   end subroutine find_group

   !> Adds a rule to those that there are.
   pure subroutine add_rule(rules, a, b, value)
      type(rule_list_t), intent(inout) :: rules      !< gets one, of the last word so far
      integer(ip), intent(in) :: a, b, value         !< surfaces, as a and b of the list; and its number

      call add_number(rules%a, a)
      call add_number(rules%b, b)
      call add_number(rules%value, value)
   end subroutine add_rule

   !> To be called before last_rule.
   pure subroutine sort_rules(rules)
      type(rule_list_t), intent(inout) :: rules      !< gets key and order
      integer(lp), allocatable :: key(:)

      key = key_of(numbers_of(rules%a), numbers_of(rules%b))
      rules%order = sorted_places(key)
      rules%key = key(rules%order)
   end subroutine sort_rules

   !> A number for two surfaces, in either order.
   elemental integer(lp) function key_of(a, b)
      integer(ip), intent(in) :: a, b

      key_of = int(min(a, b), lp)*(int(huge(a), lp) + 1_lp) + int(max(a, b), lp)
   end function key_of

   !> The last rule for two things that belong to some surfaces each; 0: none.
   pure integer(ip) function last_rule(rules, a, b) result(last)
      type(rule_list_t), intent(in) :: rules         !< sorted
      integer(ip), intent(in) :: a(:), b(:)          !< surfaces, ANY_BODY one of them for a body
      integer(lp) :: key
      integer(ip) :: i, k, found

      last = 0
      do i = 1, size(a, kind=ip)
         do k = 1, size(b, kind=ip)
            key = key_of(a(i), b(k))
            found = first_at_least(rules%key, key + 1) - 1   ! the last one that is not greater
            if (found == 0) cycle
            if (rules%key(found) == key) last = max(last, rules%order(found))
         end do
      end do
   end function last_rule

end module atrito_build_contact
