!> Values of items and options: what the model's constructors ask of a deck. Failures are reported here, at their place.
module atrito_items
   use atrito_keyword_table, only: find_choice
   use atrito_kinds, only: ip, wp
   use atrito_deck, only: deck_t, card_t, option_t, token_t, token_text, part_of, is_empty_token, written_length, keyword_name, &
                          reading_order, data_line_t, line_item
   use atrito_diagnostics, only: report_error, report_note
   use atrito_deck_expressions, only: evaluate_at, has_own_degree, report_later, index_of_parameter
   use atrito_expression_names, only: is_name, is_reserved_name
   use atrito_numbers, only: read_real, read_integer, NUMBER_OK, NUMBER_TOO_LARGE, NUMBER_NOT_INTEGER
   use atrito_strings, only: same_name, to_text, upper_case
   implicit none (type, external)
   private
   public :: get_real, get_integer, get_name, find_option, has_option, option_text, option_word, option_real, option_integer, &
             refuse_option, check_comma
   public :: LONGEST_NAME

   integer, parameter :: LONGEST_NAME = 80
   real(wp), parameter :: ROUND_OFF = 1.0e-12_wp      !< of an expression that is to be whole: 0.1*30

contains

   !> The real value of an item: a number, `<expression>` or `-<expression>` of parameters.
   !> An empty item takes the default, or is an error when there is none. ok: .false. when reported.
   subroutine get_real(deck, token, what, value, ok, default, keyword)
      type(deck_t), intent(in) :: deck                   !< its texts and parameters are read
      type(token_t), intent(in) :: token                 !< the item
      character(len=*), intent(in) :: what               !< e.g. 'x coordinate, a real [L]'
      real(wp), intent(out) :: value                     !< 0 where it is not ok
      logical, intent(out) :: ok                         !< false where that was reported
      real(wp), intent(in), optional :: default          !< of an empty item
      character(len=*), intent(in), optional :: keyword  !< for `atrito help KEYWORD`

      call get_number(deck, token, what, .false., value, ok, present(default), keyword)
      if (ok .and. present(default) .and. is_empty_token(token)) value = default
   end subroutine get_real

   !> The integer value of an item, as get_real. It may not be written as a real; a parameter must be whole.
   subroutine get_integer(deck, token, what, value, ok, default, keyword)
      type(deck_t), intent(in) :: deck                   !< its texts and parameters are read
      type(token_t), intent(in) :: token                 !< the item
      character(len=*), intent(in) :: what               !< e.g. 'node number, an integer'
      integer(ip), intent(out) :: value                  !< 0 where it is not ok
      logical, intent(out) :: ok                         !< false where that was reported
      integer(ip), intent(in), optional :: default       !< of an empty item
      character(len=*), intent(in), optional :: keyword  !< for `atrito help KEYWORD`
      real(wp) :: x

      call get_number(deck, token, what, .true., x, ok, present(default), keyword)
      value = 0
      if (ok) value = int(x, ip)                       ! whole
      if (ok .and. present(default) .and. is_empty_token(token)) value = default
   end subroutine get_integer

   !> A real, or an integer, which a double holds exactly.
   subroutine get_number(deck, token, what, is_whole, value, ok, may_be_empty, keyword)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      character(len=*), intent(in) :: what
      logical, intent(in) :: is_whole
      real(wp), intent(out) :: value
      logical, intent(out) :: ok
      logical, intent(in) :: may_be_empty
      character(len=*), intent(in), optional :: keyword

      value = 0.0_wp
      if (is_empty_token(token)) then
         ok = may_be_empty
         if (.not. ok) call report_error(deck, token, 'E-MISSING', 'a value is missing', expected=what, keyword=keyword)
         return
      end if
      associate (text => deck%sources(token%source)%text(token%first:token%last))
         if (index(text, '<') /= 1 .and. index(text, '-<') /= 1) then   ! value_of_expression checks the rest
            call number_of_text(deck, token, text, what, is_whole, value, ok, keyword)
            return
         end if
      end associate
      call value_of_expression(deck, token, what, value, ok, keyword)
      if (.not. (ok .and. is_whole)) return
      ok = abs(value) <= real(huge(1_ip), wp) .and. abs(value - anint(value)) <= ROUND_OFF*abs(value)
      if (ok) value = anint(value)
      if (ok) return
      call report_error(deck, token, 'E-INTEGER', token_text(deck, token)//' is '//to_text(value)//', not an integer', &
                        expected=what, keyword=keyword)
   end subroutine get_number

   subroutine number_of_text(deck, token, text, what, is_whole, value, ok, keyword)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      character(len=*), intent(in) :: text, what
      logical, intent(in) :: is_whole
      real(wp), intent(out) :: value
      logical, intent(out) :: ok
      character(len=*), intent(in), optional :: keyword
      character(len=:), allocatable :: noun
      integer(ip) :: i
      integer :: outcome

      if (is_whole) then
         call read_integer(text, i, outcome)
         value = real(i, wp)
      else
         call read_real(text, value, outcome)
      end if
      ok = outcome == NUMBER_OK
      if (ok .and. .not. (is_whole .or. abs(value) > 0.0_wp)) then
         if (scan(text(:scan(text//'e', 'eEdD') - 1), '123456789') > 0) then
            call report_note(deck, token, 'N-ZERO', text//' is less than the smallest real: it is 0', keyword=keyword)
         end if
      end if
      if (ok) return
      noun = trim(merge('an integer', 'a real    ', is_whole))
      select case (outcome)
      case (NUMBER_TOO_LARGE)
         call report_error(deck, token, 'E-NUMBER', text//' is too large for '//noun, expected=what, keyword=keyword)
      case (NUMBER_NOT_INTEGER)
         call report_error(deck, token, 'E-INTEGER', text//' is a real', expected=what, keyword=keyword)
      case default
         if (.not. is_whole) noun = 'a number'
         call report_error(deck, token, 'E-NUMBER', "'"//text//"' is not "//noun, expected=what, keyword=keyword)
      end select
   end subroutine number_of_text

   !> The value of `<expression>` or `-<expression>`; of a name alone it is that of the parameter.
   subroutine value_of_expression(deck, token, what, value, ok, keyword)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      character(len=*), intent(in) :: what
      real(wp), intent(out) :: value
      logical, intent(out) :: ok
      character(len=*), intent(in), optional :: keyword
      character(len=:), allocatable :: text
      type(token_t) :: place

      value = 0.0_wp
      text = token_text(deck, token)
      place = part_of(deck, token, token%first + merge(2, 1, text(1:1) == '-'), token%last - 1)
      ok = .not. is_empty_token(place) .and. text(len(text):) == '>'
      if (.not. ok) then
         call report_error(deck, token, 'E-NUMBER', "'"//text//"' is neither a number nor <expression> of parameters", &
                           expected=what, keyword=keyword)
      else if (is_own_name(deck, place)) then
         call value_of_parameter(deck, place, what, value, ok)
      else
         call evaluate_at(deck, place, value, ok)
      end if
      if (ok .and. text(1:1) == '-') value = -value
   end subroutine value_of_expression

   !> A name alone that is no constant of the expressions.
   pure logical function is_own_name(deck, place)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: place

      associate (text => deck%sources(place%source)%text(place%first:place%last))
         is_own_name = is_name(text)
         if (is_own_name) is_own_name = .not. is_reserved_name(text)
         if (is_own_name .and. same_name(text, 'deg')) is_own_name = has_own_degree(deck)
      end associate
   end function is_own_name

   !> The value of the parameter that an item names; ok: .false. when there is none before this place, which is reported here, or
   !> its definition was reported.
   subroutine value_of_parameter(deck, place, what, value, ok)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: place               !< its name
      character(len=*), intent(in) :: what
      real(wp), intent(out) :: value
      logical, intent(out) :: ok
      integer(ip) :: i

      value = 0.0_wp
      i = index_of_parameter(deck, token_text(deck, place))
      ok = i > 0
      if (.not. ok) then
         if (deck%has_lost_parameters) return
         call report_error(deck, place, 'E-PARAMETER', 'unknown parameter '//token_text(deck, place), expected=what, &
                           among=deck%parameter_names, keyword='PARAMETER')
         return
      end if
      associate (parameter => deck%parameters(i))
         ok = parameter%order < reading_order(deck, place%source, place%line)
         if (.not. ok) call report_later(deck, place, i, what)
         ok = ok .and. parameter%known
         if (ok) value = parameter%value
      end associate
   end subroutine value_of_parameter

   !> An item that is a name: not empty, of at most 80 characters.
   subroutine get_name(deck, token, what, name, ok, keyword)
      type(deck_t), intent(in) :: deck                   !< its texts and instances are read
      type(token_t), intent(in) :: token                 !< the item
      character(len=*), intent(in) :: what               !< e.g. 'name of a node set'
      character(len=:), allocatable, intent(out) :: name !< as written, without quotes; names are without case
      logical, intent(out) :: ok                         !< false where that was reported
      character(len=*), intent(in), optional :: keyword  !< for `atrito help KEYWORD`

      name = token_text(deck, token)
      ok = len(name) > 0 .and. written_length(deck, token) <= LONGEST_NAME
      if (len(name) == 0) then
         call report_error(deck, token, 'E-MISSING', 'a name is missing', expected=what, keyword=keyword)
      else if (.not. ok) then
         call report_error(deck, token, 'E-NAME', 'a name of '//to_text(int(len(name), ip))//' characters', &
                           expected=what//', of at most '//to_text(int(LONGEST_NAME, ip))//' characters', keyword=keyword)
      end if
   end subroutine get_name

   !> The option of a card by its name in the table.
   pure subroutine find_option(deck, card, name, option, found)
      type(deck_t), intent(in) :: deck      !< its keyword table is read
      type(card_t), intent(in) :: card      !< its options are searched
      character(len=*), intent(in) :: name  !< as in the keyword table
      type(option_t), intent(out) :: option !< of no use where it is not found
      logical, intent(out) :: found         !< the option is given
      integer :: i

      found = .false.
      if (card%keyword < 1) return
      do i = 1, size(card%options)
         if (card%options(i)%spec < 1) cycle
         found = deck%keywords(card%keyword)%options(card%options(i)%spec)%name == name
         if (found) then
            option = card%options(i)
            return
         end if
      end do
   end subroutine find_option

   !> Whether an option is given on the keyword line, with or without a value.
   pure logical function has_option(deck, card, name)
      type(deck_t), intent(in) :: deck     !< its keyword table is read
      type(card_t), intent(in) :: card     !< its options are searched
      character(len=*), intent(in) :: name !< as in the keyword table
      type(option_t) :: option

      call find_option(deck, card, name, option, has_option)
   end function has_option

   !> The value of an option as written, without quotes; '' when it is not given. place: where, for messages.
   pure subroutine option_text(deck, card, name, text, found, place)
      type(deck_t), intent(in) :: deck                   !< its keyword table and texts are read
      type(card_t), intent(in) :: card                   !< its options are searched
      character(len=*), intent(in) :: name               !< as in the keyword table
      character(len=:), allocatable, intent(out) :: text !< without quotes
      logical, intent(out) :: found                      !< the option is given, with a value
      type(token_t), intent(out), optional :: place      !< the value, or the keyword when not found
      type(option_t) :: option

      text = ''
      if (present(place)) place = card%place
      call find_option(deck, card, name, option, found)
      if (found) found = option%has_value
      if (.not. found) return
      text = token_text(deck, option%value)
      if (present(place)) place = option%value
   end subroutine option_text

   !> The word chosen by an option, as the table has it; its default when it is not given. An option that may stand alone (NLGEOM)
   !> is then its first word.
   pure function option_word(deck, card, name) result(word)
      type(deck_t), intent(in) :: deck     !< its keyword table and texts are read
      type(card_t), intent(in) :: card     !< its options are searched
      character(len=*), intent(in) :: name !< as in the keyword table
      character(len=:), allocatable :: word
      logical :: found
      integer :: i, choice

      call option_text(deck, card, name, word, found)
      word = upper_case(word)
      if (card%keyword < 1) return
      associate (options => deck%keywords(card%keyword)%options)
         do i = 1, size(options)
            if (options(i)%name /= name) cycle
            if (found) then
               choice = find_choice(options(i)%choices, word)
               if (choice > 0) word = options(i)%choices(choice)%name
               return
            end if
            word = options(i)%default
            if (has_option(deck, card, name) .and. size(options(i)%choices) > 0) word = options(i)%choices(1)%name
         end do
      end associate
   end function option_word

   !> The real value of an option. found: it is given and is a real; otherwise value is untouched (and any fault reported).
   subroutine option_real(deck, card, name, what, value, found)
      type(deck_t), intent(in) :: deck           !< its keyword table, texts and parameters are read
      type(card_t), intent(in) :: card           !< its options are searched
      character(len=*), intent(in) :: name, what !< as in the keyword table; e.g. 'stiffness, a real [F/L]'
      real(wp), intent(inout) :: value           !< what it is without the option, on entry
      logical, intent(out) :: found              !< it is given and good
      type(option_t) :: option
      real(wp) :: x

      call find_option(deck, card, name, option, found)
      if (.not. found) return
      call get_real(deck, option%value, what, x, found, keyword=keyword_name(card))
      if (found) value = x
   end subroutine option_real

   !> The integer value of an option, as option_real.
   subroutine option_integer(deck, card, name, what, value, found)
      type(deck_t), intent(in) :: deck           !< its keyword table, texts and parameters are read
      type(card_t), intent(in) :: card           !< its options are searched
      character(len=*), intent(in) :: name, what !< as in the keyword table; e.g. 'a number, an integer'
      integer(ip), intent(inout) :: value        !< what it is without the option, on entry
      logical, intent(out) :: found              !< it is given and good
      type(option_t) :: option
      integer(ip) :: i

      call find_option(deck, card, name, option, found)
      if (.not. found) return
      call get_integer(deck, option%value, what, i, found, keyword=keyword_name(card))
      if (found) value = i
   end subroutine option_integer

   !> Reports an option whose value is out of range. what: what it may be, in words.
   subroutine refuse_option(deck, card, name, what)
      type(deck_t), intent(in) :: deck           !< its keyword table and texts are read
      type(card_t), intent(in) :: card           !< has the option
      character(len=*), intent(in) :: name, what !< as in the keyword table; e.g. 'a real > 0'
      type(option_t) :: option
      logical :: found

      call find_option(deck, card, name, option, found)
      call report_error(deck, option%value, 'E-VALUE', name//' = '//token_text(deck, option%value)//' is out of range', &
                        expected=what, keyword=keyword_name(card))
   end subroutine refuse_option

   !> Of a line of n values: `2,5` and `1,2e-5` are decimal commas, `7850, 20` and `7.85e-9,20` have a further item. False: the
   !> first, reported.
   logical function check_comma(deck, line, n, expected, keyword) result(ok)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(data_line_t), intent(in) :: line            !< data line
      integer(ip), intent(in) :: n                     !< values of a line
      character(len=*), intent(in) :: expected, keyword !< for the message: items, and help of the card
      character(len=*), parameter :: DIGITS = '0123456789'
      character(len=:), allocatable :: behind
      type(token_t) :: value, next

      ok = .true.
      if (line%n_tokens <= n) return
      value = line_item(deck, line, n)
      next = line_item(deck, line, n + 1)
      if (is_empty_token(next) .or. next%first /= value%last + 2) return
      behind = token_text(deck, next)
      ok = verify(token_text(deck, value)//behind(:1), DIGITS) > 0 .or. scan(behind, '.') > 0
      if (.not. ok) call report_error(deck, next, 'E-ITEMS', to_text(n + 1)//' items, where '//to_text(n)//' belong'// &
                                      trim(merge('s', ' ', n == 1)), expected=expected, keyword=keyword)
   end function check_comma

end module atrito_items
