!> Keyword lines: the items of one become a card, checked against the keyword table.
module atrito_cards
   use atrito_kinds, only: ip, wp
   use atrito_deck, only: deck_t, card_t, option_t, token_t, KEYWORD_UNKNOWN, token_text, part_of, is_empty_token, is_quoted
   use atrito_diagnostics, only: report_error, refuse_card, report_note, report_outside
   use atrito_foreign_keywords, only: ask_keyword, ask_element_type, ask_option, NOT_FOREIGN, FOREIGN_IGNORED, FOREIGN_OUTSIDE
   use atrito_items, only: get_real, get_integer, get_name
   use atrito_keyword, only: keyword_t, option_spec_t, KIND_FLAG, KIND_NAME, KIND_WORD, KIND_OPTIONAL_WORD, KIND_REAL, KIND_INTEGER
   use atrito_keyword_table, only: define_keyword, find_keyword, find_option_spec, find_choice, keyword_names, option_names, &
                                   choice_names, packed, option_text_of, with_dimension, choices_text
   use atrito_messages, only: ID_OUTSIDE, SEVERITY_ERROR, has_room
   use atrito_lexer, only: find_equals
   use atrito_strings, only: string_t, nearest_names, upper_case
   implicit none (type, external)
   private
   public :: make_card, check_options, has_options

   !> In option%spec: known of other programs.
   integer, parameter :: FOREIGN_OPTION = -1

   !> Keywords that define a name, and stand for it when they are refused. Without the first three no scene is left.
   character(len=20), parameter :: DEFINING(11) = [character(len=20) :: 'NODE', 'ELEMENT', 'RIGID BODY', 'NSET', 'ELSET', &
                                                       'SURFACE', 'AMPLITUDE', 'MATERIAL', 'SURFACE INTERACTION', 'SOLID SECTION', &
                                                                                                                     'CONTACT PAIR']

contains

   !> The card of a keyword line; its keyword is looked up, its options only split.
   subroutine make_card(deck, items, card)
      type(deck_t), intent(in) :: deck                 !< its texts and keyword table are read
      type(token_t), intent(in) :: items(:)            !< of the line and those that continue it; the first one is *KEYWORD
      type(card_t), intent(out) :: card                !< no level and no lines yet
      integer :: i

      card%place = part_of(deck, items(1), items(1)%first + 1, items(1)%last)
      allocate (card%options(size(items) - 1))
      do i = 1, size(card%options)
         call split_option(deck, items(i + 1), card%options(i))
      end do
      card%keyword = find_keyword(deck%keywords, token_text(deck, card%place))
      if (card%keyword /= KEYWORD_UNKNOWN) then
         card%name = deck%keywords(card%keyword)%name
      else if (is_empty_token(card%place)) then
         call report_error(deck, items(1), 'E-KEYWORD', 'an asterisk without a keyword', expected='*KEYWORD')
      else
         call judge_foreign(deck, card)
      end if
   end subroutine make_card

   !> A keyword that is not in the table: one of other programs, or of none.
   subroutine judge_foreign(deck, card)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(inout) :: card
      character(len=:), allocatable :: name
      type(string_t), allocatable :: near(:)
      integer :: verdict, subject

      if (.not. has_room(SEVERITY_ERROR)) then      ! there may be very many
         call report_error(deck, card%place, 'E-KEYWORD', 'unknown keyword *'//token_text(deck, card%place))
         return
      end if
      name = upper_case(token_text(deck, card%place))
      call ask_keyword(packed(name), verdict, subject)
      select case (verdict)
      case (FOREIGN_IGNORED)
         card%is_ignored = .true.
         call report_note(deck, card%place, 'N-IGNORED', '*'//name//' has no effect')
      case (FOREIGN_OUTSIDE)
         card%is_outside = deck%subjects(subject)%is_scene
         card%changes_model = deck%subjects(subject)%key == 'change'
         if (subject == deck%subject .or. is_company(deck, name)) return   ! of elements, or of a keyword, that are refused
         call report_outside(deck, card%place, '*'//name, subject)
      case (NOT_FOREIGN)
         near = nearest_names(token_text(deck, card%place), keyword_names(deck%keywords), 1)
         if (size(near) > 0) card%meant = near(1)%s
         call report_error(deck, card%place, 'E-KEYWORD', 'unknown keyword *'//token_text(deck, card%place), &
                           expected='a keyword; atrito help lists them', known=keyword_names(deck%keywords))
      end select
   end subroutine judge_foreign

   !> The keyword only goes with another one, which is refused right before or above.
   pure logical function is_company(deck, name)
      type(deck_t), intent(in) :: deck
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: leader
      integer(ip) :: i

      is_company = .false.
      select case (packed(name))
      case ('KINEMATIC', 'DISTRIBUTING')
         leader = 'COUPLING'
      case ('CONTACTINITIALIZATIONASSIGNMENT')
         leader = 'CONTACTINITIALIZATIONDATA'
      case default
         return
      end select
      do i = 1, deck%n_cards
         is_company = is_company .or. packed(upper_case(token_text(deck, deck%cards(i)%place))) == leader
      end do
   end function is_company

   !> NAME or NAME=VALUE.
   subroutine split_option(deck, item, option)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: item
      type(option_t), intent(out) :: option
      integer(ip) :: equals

      equals = find_equals(deck%sources(item%source)%text, item%first, item%last)
      option%has_value = equals > 0
      if (equals == 0) equals = item%last + 1
      option%name = part_of(deck, item, item%first, equals - 1)
      option%value = part_of(deck, item, min(equals + 1, item%last + 1), item%last)
   end subroutine split_option

   !> Whether a line behind a comma at the end of a keyword line goes on with options: what is none is data, and the comma means
   !> nothing. A title of *STEP could be a misspelt option, and is taken for one.
   pure logical function has_options(deck, keyword, text)
      type(deck_t), intent(in) :: deck                 !< its keyword table is read
      character(len=*), intent(in) :: keyword          !< with its asterisk
      character(len=*), intent(in) :: text             !< the line without blanks at its ends
      character(len=:), allocatable :: why
      integer(ip) :: equals, last
      integer :: k, verdict
      type(keyword_t) :: definition

      k = find_keyword(deck%keywords, keyword(2:))
      last = index(text//',', ',') - 1
      equals = find_equals(text, 1_ip, last)
      has_options = equals > 0
      if (k == KEYWORD_UNKNOWN) return
      definition = deck%keywords(k)
      call define_keyword(deck%definitions, definition)
      if (size(definition%options) == 0) has_options = .false.
      if (has_options .or. size(definition%options) == 0) return
      call ask_option(packed(definition%name)//'/'//packed(text(:last)), verdict, why)
      has_options = verdict /= NOT_FOREIGN .or. find_option_spec(definition, text(:last)) > 0 .or. definition%name == 'STEP'
   end function has_options

   !> Checks the options of a card whose keyword is known; card%ok tells the outcome.
   subroutine check_options(deck, card)
      type(deck_t), intent(in) :: deck    !< its texts and keyword table are read
      type(card_t), intent(inout) :: card !< its options get their `spec`
      integer :: i, spec
      character(len=:), allocatable :: name

      do i = 1, size(card%options)
         name = token_text(deck, card%options(i)%name)
         spec = find_option_spec(deck%keywords(card%keyword), name)
         if (len(name) == 0) then
            call refuse_card(deck, card, 'E-OPTION', 'an empty option', place=card%options(i)%name)
         else if (spec == 0) then
            call judge_option(card%options(i))
         else if (any(card%options(:i - 1)%spec == spec)) then
            call refuse_card(deck, card, 'E-OPTION-TWICE', 'option '//name//' is given twice', place=card%options(i)%name)
         else
            card%options(i)%spec = spec
            call check_use(deck, card, card%options(i), deck%keywords(card%keyword)%options(spec))
         end if
      end do
      call check_company()

   contains

      !> An option that the table does not have: one of other programs, or of none.
      subroutine judge_option(option)
         type(option_t), intent(inout) :: option
         character(len=:), allocatable :: name, phrase, text
         integer :: verdict

         name = token_text(deck, option%name)
         phrase = packed(card%name)//'/'//packed(name)
         call ask_option(phrase, verdict, text)
         if (verdict == NOT_FOREIGN .and. option%has_value) then
            call ask_option(phrase//'='//packed(token_text(deck, option%value)), verdict, text)
         end if
         select case (verdict)
         case (FOREIGN_IGNORED)
            option%spec = FOREIGN_OPTION
            call report_note(deck, option%name, 'N-IGNORED', 'option '//upper_case(name)//' of *'//trim(card%name)// &
                             ' has no effect: '//text)
         case (FOREIGN_OUTSIDE)
            option%spec = FOREIGN_OPTION
            call refuse_outside(deck, card, option%name, 'option '//upper_case(name)//' of *'//trim(card%name), text)
         case (NOT_FOREIGN)
            call refuse_card(deck, card, 'E-OPTION', 'unknown option '//name//' of *'//trim(card%name), &
                             known=option_names(deck%keywords(card%keyword)%options), place=option%name)
         end select
      end subroutine judge_option

      !> Options that must be there: the required ones, and those that others need.
      subroutine check_company()
         integer :: i, j, k
         type(string_t), allocatable :: near(:)
         logical :: is_misspelt

         if (card%is_refused .or. card%is_outside) return
         associate (options => deck%keywords(card%keyword)%options)
            do i = 1, size(options)
               if (options(i)%required .and. .not. any(card%options%spec == i)) then
                  card%ok = .false.
                  ! An unknown option, which was reported, is nearest to this one.
                  is_misspelt = .false.
                  do k = 1, size(card%options)
                     if (card%options(k)%spec /= 0) cycle
                     near = nearest_names(token_text(deck, card%options(k)%name), &
                                          option_names(deck%keywords(card%keyword)%options), 1)
                     if (size(near) > 0) is_misspelt = is_misspelt .or. near(1)%s == options(i)%name
                  end do
                  if (is_misspelt) cycle
                  call refuse_card(deck, card, 'E-OPTION-MISSING', '*'//trim(card%name)//' needs the option '//options(i)%name, &
                                   meaning(options(i)))
               end if
            end do
            do j = 1, size(card%options)
               if (card%options(j)%spec < 1) cycle
               i = find_option_spec(deck%keywords(card%keyword), options(card%options(j)%spec)%needs)
               if (i == 0 .or. any(card%options%spec == i)) cycle
               call refuse_card(deck, card, 'E-OPTION', 'option '//options(card%options(j)%spec)%name//' goes with '// &
                                options(i)%name//' only', place=card%options(j)%name)
            end do
         end associate
      end subroutine check_company
   end subroutine check_options

   !> Refuses a card by the name of what it asks for. What defines a name keeps it, so that nobody misses the name; without nodes
   !> and elements nothing of the scene is left.
   subroutine refuse_outside(deck, card, place, name, instead)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(inout) :: card
      type(token_t), intent(in) :: place
      character(len=*), intent(in) :: name, instead

      card%ok = .false.
      card%is_refused = .not. any(DEFINING == card%name)
      card%is_outside = any(card%name == DEFINING(:3)) .or. card%name == 'RESTART'
      call report_error(deck, place, ID_OUTSIDE, name//' is outside of atrito', expected=instead)
   end subroutine refuse_outside

   subroutine check_use(deck, card, option, spec)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(inout) :: card
      type(option_t), intent(in) :: option
      type(option_spec_t), intent(in) :: spec

      if (spec%harmless) then
         call report_note(deck, option%name, 'N-IGNORED', 'option '//spec%name//' of *'//trim(card%name)// &
                          ' has no effect: '//spec%doc)
      else if (.not. spec%built) then
         call refuse_card(deck, card, 'E-NOT-BUILT', 'option '//spec%name//' of *'//trim(card%name)//' is not built yet', &
                          place=option%name)
      else if (spec%kind == KIND_FLAG) then
         if (option%has_value) call refuse_card(deck, card, 'E-OPTION-VALUE', 'option '//spec%name//' takes no value', &
                                                place=option%value)
      else if (spec%kind /= KIND_OPTIONAL_WORD .and. is_empty_token(option%value)) then
         call refuse_card(deck, card, 'E-OPTION-VALUE', 'option '//spec%name//' needs a value', meaning(spec), option%value)
      else
         call check_value()
      end if

   contains

      subroutine check_value()
         character(len=:), allocatable :: name
         real(wp) :: x
         integer(ip) :: i
         logical :: ok

         ok = .true.
         select case (spec%kind)
         case (KIND_WORD, KIND_OPTIONAL_WORD)
            call check_word(ok)
         case (KIND_REAL)
            call get_real(deck, option%value, meaning(spec), x, ok, keyword=trim(card%name))
         case (KIND_INTEGER)
            call get_integer(deck, option%value, meaning(spec), i, ok, keyword=trim(card%name))
         case (KIND_NAME)
            call get_name(deck, option%value, meaning(spec), name, ok, keyword=trim(card%name))
            if (ok .and. verify(name, '0123456789') == 0 .and. .not. is_quoted(deck, option%value)) then
               ok = .false.                              ! nothing could distinguish a set named 12 from node 12
               call report_error(deck, option%value, 'E-NAME', 'all digits means a number, not a name', &
                                 expected=meaning(spec), keyword=trim(card%name))
            end if
         end select
         card%ok = card%ok .and. ok
      end subroutine check_value

      subroutine check_word(ok)
         logical, intent(out) :: ok
         character(len=:), allocatable :: word
         type(token_t) :: place
         integer :: choice

         word = token_text(deck, option%value)
         place = option%value
         if (.not. option%has_value) then
            word = spec%choices(1)%name               ! alone, the option stands for its first word
            place = option%name
         end if
         choice = find_choice(spec%choices, word)
         ok = choice > 0
         if (.not. ok) then
            if (is_foreign_word(deck, card, place, spec, word, ok)) return
            call report_error(deck, place, 'E-CHOICE', spec%name//'='//word//' is unknown to *'//trim(card%name), &
                              expected=meaning(spec), known=choice_names(spec%choices), &
                              keyword=trim(card%name))
            return
         end if
         ok = spec%choices(choice)%built
         if (.not. ok) call report_error(deck, place, 'E-NOT-BUILT', spec%name//'='//spec%choices(choice)%name//' of *'// &
                                         trim(card%name)//' is not built yet', expected=meaning(spec), &
                                         keyword=trim(card%name))
      end subroutine check_word
   end subroutine check_use

   !> A word, or a type of elements, that other programs know: ok where it has no effect, else it is refused by its name.
   logical function is_foreign_word(deck, card, place, spec, word, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(inout) :: card
      type(token_t), intent(in) :: place
      type(option_spec_t), intent(in) :: spec
      character(len=*), intent(in) :: word
      logical, intent(out) :: ok
      character(len=:), allocatable :: text
      integer :: verdict, subject

      ok = .false.
      if (card%name == 'ELEMENT' .and. spec%name == 'TYPE') then
         subject = ask_element_type(word)
         is_foreign_word = subject > 0
         card%is_outside = card%is_outside .or. is_foreign_word
         card%subject = subject
         if (is_foreign_word) call report_outside(deck, place, 'TYPE='//upper_case(word)//' of *ELEMENT', subject)
      else
         call ask_option(packed(card%name)//'/'//packed(spec%name)//'='//packed(word), verdict, text)
         is_foreign_word = verdict /= NOT_FOREIGN
         ok = verdict == FOREIGN_IGNORED
         if (ok) call report_note(deck, place, 'N-IGNORED', spec%name//'='//upper_case(word)//' of *'//trim(card%name)// &
                                  ' has no effect: '//text)
         if (verdict == FOREIGN_OUTSIDE) call refuse_outside(deck, card, place, spec%name//'='//upper_case(word)//' of *'// &
                                                             trim(card%name), text)
      end if
   end function is_foreign_word

   !> `MATERIAL=name: their material`.
   pure function meaning(spec) result(text)
      type(option_spec_t), intent(in) :: spec
      character(len=:), allocatable :: text

      text = option_text_of(spec)//': '//spec%doc
      if (size(spec%choices) > 0) text = text//', '//choices_text(spec%choices)
      text = with_dimension(text, spec%dimension)
   end function meaning

end module atrito_cards
