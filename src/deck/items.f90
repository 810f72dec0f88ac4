!> Values of items and options: what the model's constructors ask of a deck. Failures are reported here, at their place.
!> Besides, the expressions that stand in a deck: the parameters that they may use, and their faults at their places.
module atrito_items
   use atrito_deck, only: deck_t, card_t, option_t, token_t, token_text, part_of, is_empty_token, is_quoted, keyword_name, &
                          reading_order, data_line_t, line_item
   use atrito_diagnostics, only: report_error, report_note
   use atrito_expression_names, only: is_name, is_reserved_name, next_name, reserved_names
   use atrito_expressions, only: expression_fault_t, evaluate_expression
   use atrito_growth, only: make_room
   use atrito_keyword_table, only: find_choice
   use atrito_kinds, only: ip, wp
   use atrito_name_list, only: find_name
   use atrito_numbers, only: read_real, read_integer, NUMBER_OK, NUMBER_TOO_LARGE, NUMBER_NOT_INTEGER
   use atrito_sorting, only: each_once
   use atrito_strings, only: same_name, to_text, upper_case, string_t, join
   implicit none (type, external)
   private
   public :: get_real, get_integer, get_name, find_option, has_option, option_text, option_word, makes_elements, option_real, &
             option_integer, refuse_option, check_comma, LONGEST_NAME, evaluate_at, has_own_degree, report_fault, collect_known, &
             put_before, index_of_parameter, is_known_at

   integer, parameter :: LONGEST_NAME = 80
   real(wp), parameter :: ROUND_OFF = 1.0e-12_wp      !< of an expression that is to be whole: 0.1*30

contains

   !> The value of an expression of earlier parameters. known: .false. when it has none; that is reported, except when it
   !> uses a parameter that has none itself.
   subroutine evaluate_at(deck, expression, value, known, silent)
      type(deck_t), intent(in) :: deck                 !< its texts and parameters are read
      type(token_t), intent(in) :: expression          !< place of its text, without < and >
      real(wp), intent(out) :: value                   !< 0 where it is not known
      logical, intent(out) :: known                    !< the expression has a value
      logical, intent(in), optional :: silent          !< nothing is reported; default .false.
      type(string_t), allocatable :: names(:)
      real(wp), allocatable :: values(:)
      type(expression_fault_t) :: fault

      call collect_known(deck, expression, names, values)
      call evaluate_expression(token_text(deck, expression), names, values, value, fault, has_own_degree(deck))
      known = .not. allocated(fault%text)
      if (present(silent)) then
         if (silent) return
      end if
      if (.not. known) call report_fault(deck, expression, fault, [string_t ::], 'PARAMETER')
   end subroutine evaluate_at

   !> The deck has a parameter of the name deg: before its definition deg is nothing.
   pure logical function has_own_degree(deck)
      type(deck_t), intent(in) :: deck !< its parameters are read

      has_own_degree = index_of_parameter(deck, 'deg') > 0
   end function has_own_degree

   !> A fault of an expression, at its place. Passed over in silence when it is a parameter whose definition was reported.
   subroutine report_fault(deck, expression, fault, also, keyword)
      type(deck_t), intent(in) :: deck                 !< its texts and parameters are read
      type(token_t), intent(in) :: expression          !< the place that `fault` counts from
      type(expression_fault_t), intent(in) :: fault    !< of this expression
      type(string_t), intent(in) :: also(:)            !< names that the expression knows besides
      character(len=*), intent(in) :: keyword          !< for `atrito help KEYWORD`
      type(token_t) :: place
      type(string_t), allocatable :: names(:)
      character(len=:), allocatable :: others
      integer(ip) :: i

      place = expression
      place%first = expression%first + fault%first - 1
      place%last = min(expression%last, expression%first + fault%last - 1)
      place%column = expression%column + fault%first - 1
      others = join(also, ', ')
      if (len(others) > 0) others = others//', '
      i = 0
      if (fault%unknown_name) i = index_of_parameter(deck, token_text(deck, place))
      if (.not. fault%unknown_name) then
         call report_error(deck, place, 'E-EXPRESSION', fault%text, keyword=keyword, &
                           expected='numbers, '//others//'earlier parameters, + - * / ** ( ), functions')
      else if (i == 0) then
         if (deck%has_lost_parameters) return
         names = reserved_names()
         call put_before(also, names)
         call report_error(deck, place, 'E-EXPRESSION', fault%text, keyword=keyword, known=names, among=deck%parameter_names, &
                           expected=others//'an earlier parameter, a function or pi')
      else if (deck%parameters(i)%known) then
         call report_later(deck, place, i, others//'an earlier parameter, a function or pi')
      end if
   end subroutine report_fault

   !> Not an array constructor: what function results hold in one is never given back (gfortran 12).
   pure subroutine put_before(first, names)
      type(string_t), intent(in) :: first(:)                 !< names that come first; copied
      type(string_t), allocatable, intent(inout) :: names(:) !< (n) becomes longer; its strings are moved
      type(string_t), allocatable :: both(:)
      integer :: i

      allocate (both(size(first) + size(names)))
      do i = 1, size(first)
         both(i)%s = first(i)%s
      end do
      do i = 1, size(names)
         call move_alloc(names(i)%s, both(size(first) + i)%s)
      end do
      call move_alloc(both, names)
   end subroutine put_before

   !> The parameters that an expression names, have values and are defined before its place: a deck can have thousands of others.
   subroutine collect_known(deck, place, names, values)
      type(deck_t), intent(in) :: deck                     !< its texts and parameters are read
      type(token_t), intent(in) :: place                   !< of the expression
      type(string_t), allocatable, intent(out) :: names(:) !< (n) in the order of their definitions
      real(wp), allocatable, intent(out) :: values(:)      !< (n)
      character(len=:), allocatable :: text
      integer(ip), allocatable :: used(:)
      integer(ip) :: i, n
      integer :: first, last

      text = token_text(deck, place)
      n = 0
      last = 0
      do
         call next_name(text, last, first)
         if (first > len(text)) exit
         i = index_of_parameter(deck, text(first:last))
         if (.not. is_known_at(deck, i, place)) cycle
         call make_room(used, n, n + 1)
         n = n + 1
         used(n) = i
      end do
      if (n > 0) used = each_once(used(:n))
      if (n > 0) n = size(used, kind=ip)
      allocate (names(n), values(n))
      do i = 1, n
         names(i)%s = deck%parameters(used(i))%name
         values(i) = deck%parameters(used(i))%value
      end do
   end subroutine collect_known

   !> A parameter has a value, and is defined before a place.
   pure logical function is_known_at(deck, i, place)
      type(deck_t), intent(in) :: deck                 !< its parameters are read
      integer(ip), intent(in) :: i                     !< the parameter; 0: there is none
      type(token_t), intent(in) :: place               !< of an expression

      is_known_at = i > 0
      if (is_known_at) is_known_at = deck%parameters(i)%known .and. &
                                     deck%parameters(i)%order < reading_order(deck, place%source, place%line)
   end function is_known_at

   !> A parameter is used before its definition.
   subroutine report_later(deck, place, i, what)
      type(deck_t), intent(in) :: deck                 !< its texts and parameters are read
      type(token_t), intent(in) :: place               !< of the name
      integer(ip), intent(in) :: i                     !< the parameter
      character(len=*), intent(in) :: what             !< what was expected

      associate (parameter => deck%parameters(i))
         call report_error(deck, place, 'E-PARAMETER', 'parameter '//token_text(deck, place)//' is used before its '// &
                           'definition in '//deck%sources(parameter%place%source)%name//':'//to_text(parameter%place%line), &
                           expected=what, keyword='PARAMETER')
      end associate
   end subroutine report_later

   !> Index of a parameter, 0 when there is none of this name.
   pure integer(ip) function index_of_parameter(deck, name) result(i)
      type(deck_t), intent(in) :: deck     !< its parameters are read
      character(len=*), intent(in) :: name !< without case

      i = find_name(deck%parameter_names, name)
   end function index_of_parameter

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
            call number_of_text(text)
            return
         end if
      end associate
      call value_of_expression()
      if (.not. (ok .and. is_whole)) return
      ok = abs(value) <= real(huge(1_ip), wp) .and. abs(value - anint(value)) <= ROUND_OFF*abs(value)
      if (ok) value = anint(value)
      if (ok) return
      call report_error(deck, token, 'E-INTEGER', token_text(deck, token)//' is '//to_text(value)//', not an integer', &
                        expected=what, keyword=keyword)

   contains

      subroutine number_of_text(text)
         character(len=*), intent(in) :: text
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
            if (scan(text(:scan(text//'e', 'eEdD') - 1), '123456789') > 0) call report_note(deck, token, 'N-ZERO', &
                                                                  text//' is less than the smallest real: it is 0', keyword=keyword)
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
      subroutine value_of_expression()
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
   end subroutine get_number

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
      ok = len(name) > 0 .and. token%last - token%first + 1 - merge(2, 0, is_quoted(deck, token)) <= LONGEST_NAME   ! as written
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

   !> Whether a card is an *ELEMENT of a type that begins so: SPRING, or T3D of lines.
   pure logical function makes_elements(deck, card, beginning)
      type(deck_t), intent(in) :: deck          !< its keyword table and texts are read
      type(card_t), intent(in) :: card          !< of any keyword
      character(len=*), intent(in) :: beginning !< of TYPE=, in capitals

      makes_elements = keyword_name(card) == 'ELEMENT'
      if (makes_elements) makes_elements = index(option_word(deck, card, 'TYPE'), beginning) == 1
   end function makes_elements

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
   logical function check_comma(deck, line, n, expected) result(ok)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(data_line_t), intent(in) :: line            !< data line
      integer(ip), intent(in) :: n                     !< values of a line
      character(len=*), intent(in) :: expected         !< for the message: items
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
                                      trim(merge('s', ' ', n == 1)), expected=expected)
   end function check_comma

end module atrito_items
