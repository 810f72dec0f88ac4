!> Arithmetic of `*PARAMETER` and of `--set`: recursive descent, all real.
!>
!>     sum     = product { (+|-) product }
!>     product = factor { (*|/) factor }
!>     factor  = [+|-] factor | power            so that -2**2 is -4
!>     power   = primary [ ** factor ]           from the right: 2**3**2 = 2**9
!>     primary = number | pi | name | function ( sum {, sum} ) | ( sum )
module atrito_expressions
   use atrito_kinds, only: wp, PI
   use atrito_arithmetic, only: add_safely, multiply_safely, divide_safely, raise_safely, exponential_safely, ARITHMETIC_OK, &
                                ARITHMETIC_OVERFLOW, ARITHMETIC_ZERO_DIVISION
   use atrito_numbers, only: read_real, NUMBER_OK, NUMBER_TOO_LARGE
   use atrito_strings, only: string_t, same_name, append_string, lower_case
   implicit none (type, external)
   private
   public :: expression_fault_t, evaluate_expression, is_reserved_name, is_name, reserved_names

   !> What is wrong with an expression, and where.
   type :: expression_fault_t
      character(len=:), allocatable :: text          !< not allocated: nothing
      integer :: first = 1, last = 1                 !< characters of the expression
      logical :: unknown_name = .false.              !< they are a name that is not known
      logical :: of_value = .false.                  !< an operation has no result for these values; others may be right
   end type expression_fault_t

   !> An expression with the named values that it can use, and how far it is read.
   type :: parser_t
      character(len=:), allocatable :: text
      integer :: position = 1
      integer :: depth = 0
      type(string_t), allocatable :: names(:)
      real(wp), allocatable :: values(:)
      type(expression_fault_t) :: fault
   end type parser_t

   integer, parameter :: DEEPEST = 100               !< nested parentheses
   character(len=*), parameter :: BLANKS = ' '//achar(9)
   character(len=*), parameter :: DIGITS = '0123456789'
   character(len=*), parameter :: LETTERS = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'
   character(len=4), parameter :: FUNCTIONS(10) = ['sqrt', 'abs ', 'exp ', 'log ', 'sin ', 'cos ', 'tan ', 'atan', 'min ', 'max ']

contains

   !> Evaluates an expression.
   pure subroutine evaluate_expression(text, names, values, value, fault)
      character(len=*), intent(in) :: text
      type(string_t), intent(in) :: names(:)           !< of the variables, without case
      real(wp), intent(in) :: values(:)                !< theirs; as many
      real(wp), intent(out) :: value                   !< 0 when there is a fault
      type(expression_fault_t), intent(out) :: fault   !< fault%text not allocated: none
      type(parser_t) :: parser

      parser%text = text
      parser%names = names
      parser%values = values
      call move_to(parser, 1)
      call take_sum(parser, value)
      if (.not. has_failed(parser) .and. next(parser) /= '') then
         call fail(parser, parser%position, parser%position, "'"//next(parser)//"' is not expected here")
      end if
      fault = parser%fault
      if (has_failed(parser)) value = 0.0_wp
   end subroutine evaluate_expression

   !> Names that a parameter cannot have: functions, and pi.
   pure logical function is_reserved_name(name)
      character(len=*), intent(in) :: name

      is_reserved_name = same_name(name, 'pi') .or. is_function(name)
   end function is_reserved_name

   pure function reserved_names() result(names)
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      do i = 1, size(FUNCTIONS)
         call append_string(names, trim(FUNCTIONS(i)))
      end do
      call append_string(names, 'pi')
   end function reserved_names

   !> Letters, digits and underscores, beginning with a letter.
   pure logical function is_name(text)
      character(len=*), intent(in) :: text

      is_name = len(text) > 0
      if (is_name) is_name = scan(text(1:1), LETTERS) == 1 .and. verify(text, LETTERS//DIGITS//'_') == 0
   end function is_name

   pure logical function is_function(name)
      character(len=*), intent(in) :: name
      integer :: i

      is_function = .false.
      do i = 1, size(FUNCTIONS)
         is_function = is_function .or. same_name(name, FUNCTIONS(i))
      end do
   end function is_function

   pure recursive subroutine take_sum(parser, value)
      type(parser_t), intent(inout) :: parser
      real(wp), intent(out) :: value
      real(wp) :: left, right
      character(len=:), allocatable :: operator
      integer :: place, outcome

      call take_product(parser, value)
      do while (.not. has_failed(parser))
         operator = next(parser)
         if (operator /= '+' .and. operator /= '-') return
         place = parser%position
         call move_to(parser, place + 1)
         call take_product(parser, right)
         if (has_failed(parser)) return
         left = value
         if (operator == '-') right = -right
         call add_safely(left, right, value, outcome)
         call judge(parser, place, place, outcome)
      end do
   end subroutine take_sum

   pure recursive subroutine take_product(parser, value)
      type(parser_t), intent(inout) :: parser
      real(wp), intent(out) :: value
      real(wp) :: left, right
      character(len=:), allocatable :: operator
      integer :: place, outcome

      call take_factor(parser, value)
      do while (.not. has_failed(parser))
         operator = next(parser)
         if (operator /= '*' .and. operator /= '/') return
         place = parser%position
         call move_to(parser, place + 1)
         call take_factor(parser, right)
         if (has_failed(parser)) return
         left = value
         if (operator == '*') then
            call multiply_safely(left, right, value, outcome)
         else
            call divide_safely(left, right, value, outcome)
         end if
         call judge(parser, place, place, outcome)
      end do
   end subroutine take_product

   pure recursive subroutine take_factor(parser, value)
      type(parser_t), intent(inout) :: parser
      real(wp), intent(out) :: value
      character(len=:), allocatable :: sign

      value = 0.0_wp
      call enter(parser)
      if (has_failed(parser)) return
      sign = next(parser)
      if (sign == '+' .or. sign == '-') then
         call move_to(parser, parser%position + 1)
         call take_factor(parser, value)
         if (sign == '-') value = -value
      else
         call take_power(parser, value)
      end if
      parser%depth = parser%depth - 1
   end subroutine take_factor

   pure recursive subroutine take_power(parser, value)
      type(parser_t), intent(inout) :: parser
      real(wp), intent(out) :: value
      real(wp) :: base, power
      integer :: place, outcome

      call take_primary(parser, value)
      if (has_failed(parser)) return
      if (next(parser) /= '**') return
      place = parser%position
      call move_to(parser, place + 2)
      call take_factor(parser, power)
      if (has_failed(parser)) return
      base = value
      call raise_safely(base, power, value, outcome)
      call judge(parser, place, place + 1, outcome)
   end subroutine take_power

   pure recursive subroutine take_primary(parser, value)
      type(parser_t), intent(inout) :: parser
      real(wp), intent(out) :: value
      character(len=:), allocatable :: symbol

      value = 0.0_wp
      symbol = next(parser)
      if (symbol == '') then
         call fail(parser, parser%position, parser%position, 'the expression ends too early')
      else if (symbol == '(') then
         call move_to(parser, parser%position + 1)
         call take_sum(parser, value)
         call take_symbol(parser, ')')
      else if (scan(symbol, DIGITS//'.') == 1) then
         call take_number(parser, value)
      else if (scan(symbol, LETTERS) == 1) then
         call take_name(parser, value)
      else
         call fail(parser, parser%position, parser%position + len(symbol) - 1, "'"//symbol//"' is not expected here")
      end if
   end subroutine take_primary

   pure subroutine take_number(parser, value)
      type(parser_t), intent(inout) :: parser
      real(wp), intent(out) :: value
      integer :: first, last, outcome

      first = parser%position
      last = first
      do while (last < len(parser%text))
         associate (symbol => parser%text(last + 1:last + 1), before => parser%text(last:last))
            if (scan(symbol, DIGITS//LETTERS//'._') == 0) then
               ! the sign of an exponent; hexadecimal and names are refused by read_real
               if (scan(symbol, '+-') == 0 .or. scan(before, 'eEdD') == 0) exit
            end if
         end associate
         last = last + 1
      end do
      call read_real(parser%text(first:last), value, outcome)
      call move_to(parser, last + 1)
      if (outcome == NUMBER_OK) return
      if (outcome == NUMBER_TOO_LARGE) then
         call fail(parser, first, last, parser%text(first:last)//' is too large for a real')
      else
         call fail(parser, first, last, "'"//parser%text(first:last)//"' is not a number")
      end if
   end subroutine take_number

   !> A constant, a variable or a function.
   pure recursive subroutine take_name(parser, value)
      type(parser_t), intent(inout) :: parser
      real(wp), intent(out) :: value
      character(len=:), allocatable :: name
      integer :: first, last, i

      value = 0.0_wp
      first = parser%position
      last = verify(parser%text(first:)//' ', LETTERS//DIGITS//'_') + first - 2
      name = parser%text(first:last)
      call move_to(parser, last + 1)
      do i = 1, size(parser%names)
         if (.not. same_name(parser%names(i)%s, name)) cycle
         value = parser%values(i)
         return
      end do
      if (same_name(name, 'pi')) then
         value = PI
      else if (is_function(name)) then
         call take_function(parser, lower_case(name), first, value)
      else
         call fail(parser, first, last, 'unknown name '//name)
         parser%fault%unknown_name = .true.
      end if
   end subroutine take_name

   pure recursive subroutine take_function(parser, name, first, value)
      type(parser_t), intent(inout) :: parser
      character(len=*), intent(in) :: name
      integer, intent(in) :: first                     !< place of the name
      real(wp), intent(out) :: value
      real(wp) :: argument
      integer :: last

      value = 0.0_wp
      last = first + len(name) - 1
      call take_symbol(parser, '(')
      if (has_failed(parser)) return
      call take_sum(parser, value)
      do while (name == 'min' .or. name == 'max')
         if (has_failed(parser) .or. next(parser) /= ',') exit
         call move_to(parser, parser%position + 1)
         call take_sum(parser, argument)
         value = merge(min(value, argument), max(value, argument), name == 'min')
      end do
      call take_symbol(parser, ')')
      if (has_failed(parser)) return
      argument = value
      call apply_function(parser, name, first, last, argument, value)
   end subroutine take_function

   pure subroutine apply_function(parser, name, first, last, x, value)
      type(parser_t), intent(inout) :: parser
      character(len=*), intent(in) :: name
      integer, intent(in) :: first, last
      real(wp), intent(in) :: x
      real(wp), intent(out) :: value
      integer :: outcome

      value = x
      select case (name)
      case ('sqrt')
         if (x < 0.0_wp) call fail_value(parser, first, last, 'sqrt of a negative number')
         value = sqrt(max(x, 0.0_wp))
      case ('log')
         if (x <= 0.0_wp) call fail_value(parser, first, last, 'log of a number that is not positive')
         if (x > 0.0_wp) value = log(x)
      case ('exp')
         call exponential_safely(x, value, outcome)
         call judge(parser, first, last, outcome)
      case ('abs')
         value = abs(x)
      case ('sin')
         value = sin(x)
      case ('cos')
         value = cos(x)
      case ('tan')
         value = tan(x)
      case ('atan')
         value = atan(x)
      end select
   end subroutine apply_function

   !> Goes on at a place, or at the first symbol behind it.
   pure subroutine move_to(parser, place)
      type(parser_t), intent(inout) :: parser
      integer, intent(in) :: place

      parser%position = place
      do while (parser%position <= len(parser%text))
         if (scan(parser%text(parser%position:parser%position), BLANKS) == 0) return
         parser%position = parser%position + 1
      end do
   end subroutine move_to

   !> Looks at the next symbol, '' at the end.
   pure function next(parser) result(symbol)
      type(parser_t), intent(in) :: parser
      character(len=:), allocatable :: symbol
      integer :: i

      symbol = ''
      i = parser%position
      if (i > len(parser%text)) return
      symbol = parser%text(i:i)
      if (symbol == '*' .and. i < len(parser%text)) then
         if (parser%text(i + 1:i + 1) == '*') symbol = '**'
      end if
   end function next

   pure subroutine take_symbol(parser, symbol)
      type(parser_t), intent(inout) :: parser
      character(len=*), intent(in) :: symbol

      if (has_failed(parser)) return
      if (next(parser) == symbol) then
         call move_to(parser, parser%position + 1)
      else
         call fail(parser, parser%position, parser%position, "'"//symbol//"' is missing")
      end if
   end subroutine take_symbol

   !> A line of a million parentheses must not exhaust the stack.
   pure subroutine enter(parser)
      type(parser_t), intent(inout) :: parser

      parser%depth = parser%depth + 1
      if (parser%depth > DEEPEST) call fail(parser, parser%position, parser%position, 'the expression is nested too deeply')
   end subroutine enter

   pure subroutine judge(parser, first, last, outcome)
      type(parser_t), intent(inout) :: parser
      integer, intent(in) :: first, last, outcome

      select case (outcome)
      case (ARITHMETIC_OK)
      case (ARITHMETIC_OVERFLOW)
         call fail_value(parser, first, last, 'the result is too large for a real')
      case (ARITHMETIC_ZERO_DIVISION)
         call fail_value(parser, first, last, 'division by zero')
      case default
         call fail_value(parser, first, last, 'a negative number can only be raised to a whole power')
      end select
   end subroutine judge

   pure logical function has_failed(parser)
      type(parser_t), intent(in) :: parser

      has_failed = allocated(parser%fault%text)
   end function has_failed

   !> A fault of the values, not of the text.
   pure subroutine fail_value(parser, first, last, text)
      type(parser_t), intent(inout) :: parser
      integer, intent(in) :: first, last
      character(len=*), intent(in) :: text

      if (has_failed(parser)) return
      call fail(parser, first, last, text)
      parser%fault%of_value = .true.
   end subroutine fail_value

   !> The first fault counts.
   pure subroutine fail(parser, first, last, text)
      type(parser_t), intent(inout) :: parser
      integer, intent(in) :: first, last
      character(len=*), intent(in) :: text

      if (has_failed(parser)) return
      parser%fault%text = text
      parser%fault%first = first
      parser%fault%last = last
   end subroutine fail

end module atrito_expressions
