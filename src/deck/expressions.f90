!> Arithmetic of `*PARAMETER` and of `--set`: recursive descent, all real.
!>
!>     sum     = product { (+|-) product }
!>     product = factor { (*|/) factor }
!>     factor  = [+|-] factor | power            so that -2**2 is -4
!>     power   = primary [ ** factor ]           from the right: 2**3**2 = 2**9
!>     primary = number | pi | deg | name | function ( sum {, sum} ) | ( sum ) | call
!>
!> Calls, names that are no arithmetic (atrito_expression_calls), are there where the caller gives them values: --observe.
module atrito_expressions
   use atrito_kinds, only: wp, PI
   use atrito_arithmetic, only: add_safely, multiply_safely, divide_safely, raise_safely, exponential_safely, ARITHMETIC_OK, &
                                ARITHMETIC_OVERFLOW, ARITHMETIC_ZERO_DIVISION
   use atrito_expression_names, only: call_t, read_call, has_argument_of, end_of_name, end_of_number, is_function, DIGITS, LETTERS
   use atrito_name_list, only: name_list_t, add_name, find_name
   use atrito_numbers, only: read_real, NUMBER_OK, NUMBER_TOO_LARGE
   use atrito_strings, only: string_t, same_name, lower_case
   implicit none (type, external)
   private
   public :: expression_fault_t, evaluate_expression, list_calls

   !> What is wrong with an expression, and where.
   type :: expression_fault_t
      character(len=:), allocatable :: text          !< not allocated: nothing
      integer :: first = 1, last = 1                 !< characters of the expression
      logical :: unknown_name = .false.              !< they are a name that is not known
      logical :: of_value = .false.                  !< an operation has no result for these values; others may be right
   end type expression_fault_t

   !> An expression with the named values that it can use, and how far it is read.
   type :: parser_t
      character(len=:), allocatable :: text          !< the expression
      integer :: position = 1                        !< of the next character
      integer :: depth = 0                           !< of nested parentheses
      type(name_list_t) :: names                     !< of variables, without case
      real(wp), allocatable :: values(:)             !< theirs; as many
      logical :: has_degree = .true.                 !< deg is pi/180
      logical :: is_listing = .false.                !< only the text counts: calls are listed, and have no values
      type(string_t), allocatable :: fields(:)       !< then: what min and max take as first argument of a call
      type(call_t), allocatable :: calls(:)          !< those found, or those with values; not allocated: there are none
      real(wp), allocatable :: amounts(:)            !< the values
      type(expression_fault_t) :: fault              !< the first one
   end type parser_t

   integer, parameter :: DEEPEST = 100               !< nested parentheses
   character(len=*), parameter :: BLANKS = ' '//achar(9)

contains

   !> Evaluates an expression.
   pure subroutine evaluate_expression(text, names, values, value, fault, own_degree, calls, amounts)
      character(len=*), intent(in) :: text             !< the expression, without < and >
      type(string_t), intent(in) :: names(:)           !< of the variables, without case
      real(wp), intent(in) :: values(:)                !< theirs; as many
      real(wp), intent(out) :: value                   !< 0 when there is a fault
      type(expression_fault_t), intent(out) :: fault   !< fault%text not allocated: none
      logical, intent(in), optional :: own_degree      !< deg is one of the variables, here or elsewhere: it is not pi/180
      type(call_t), intent(in), optional :: calls(:)   !< those of the expression, from list_calls
      real(wp), intent(in), optional :: amounts(:)     !< their values; as many
      type(parser_t) :: parser

      parser%text = text
      call take_names(parser, names)
      parser%values = values
      if (present(own_degree)) parser%has_degree = .not. own_degree
      ! not allocated: an optional argument that is not there
      if (present(calls)) parser%calls = calls
      if (present(amounts)) parser%amounts = amounts
      call take_all(parser, value)
      fault = parser%fault
      if (has_failed(parser)) value = 0.0_wp
   end subroutine evaluate_expression

   !> Lists what an expression has besides arithmetic. fault: of its text; what its values do is not known yet.
   pure subroutine list_calls(text, names, fields, calls, fault, own_degree)
      character(len=*), intent(in) :: text               !< the expression, without < and >
      type(string_t), intent(in) :: names(:)             !< of the variables, without case
      type(string_t), intent(in) :: fields(:)            !< what min and max may have as first argument that is no number
      type(call_t), allocatable, intent(out) :: calls(:) !< in their order
      type(expression_fault_t), intent(out) :: fault     !< fault%text not allocated: none
      logical, intent(in) :: own_degree                  !< as in evaluate_expression
      type(parser_t) :: parser
      real(wp) :: value

      parser%text = text
      call take_names(parser, names)
      allocate (parser%values(size(names)), source=1.0_wp)
      parser%has_degree = .not. own_degree
      parser%is_listing = .true.
      parser%fields = fields
      allocate (parser%calls(0))
      call take_all(parser, value)
      fault = parser%fault
      call move_alloc(parser%calls, calls)
   end subroutine list_calls

   pure subroutine take_names(parser, names)
      type(parser_t), intent(inout) :: parser
      type(string_t), intent(in) :: names(:)
      integer :: i

      do i = 1, size(names)
         call add_name(parser%names, names(i)%s)
      end do
   end subroutine take_names

   !> The whole text.
   pure subroutine take_all(parser, value)
      type(parser_t), intent(inout) :: parser
      real(wp), intent(out) :: value

      call move_to(parser, 1)
      call take_terms(parser, 1, value)
      if (.not. has_failed(parser) .and. next(parser) /= '') then
         call fail(parser, parser%position, parser%position, "'"//next(parser)//"' is not expected here")
      end if
   end subroutine take_all

   !> Terms from the left: of rank 1 products, joined by + and -; of rank 2 factors, joined by * and /.
   pure recursive subroutine take_terms(parser, rank, value)
      type(parser_t), intent(inout) :: parser
      integer, intent(in) :: rank
      real(wp), intent(out) :: value
      character(len=2), parameter :: OPERATORS(2) = ['+-', '*/']
      real(wp) :: left, right
      character(len=:), allocatable :: operator        !< before the term; '': it is the first
      integer :: place, outcome

      operator = ''
      value = 0.0_wp
      place = 0
      do
         if (rank == 1) then
            call take_terms(parser, 2, right)
         else
            call take_factor(parser, right)
         end if
         left = value
         outcome = ARITHMETIC_OK
         select case (operator)
         case ('')
            value = right
         case ('+')
            call add_safely(left, right, value, outcome)
         case ('-')
            call add_safely(left, -right, value, outcome)
         case ('*')
            call multiply_safely(left, right, value, outcome)
         case ('/')
            call divide_safely(left, right, value, outcome)
         end select
         call judge(parser, place, place, outcome)   ! where a term has failed, that was said before
         operator = next(parser)
         if (has_failed(parser) .or. len(operator) /= 1 .or. verify(operator, OPERATORS(rank)) > 0) return
         place = parser%position
         call move_to(parser, place + 1)
      end do
   end subroutine take_terms

   pure recursive subroutine take_factor(parser, value)
      type(parser_t), intent(inout) :: parser
      real(wp), intent(out) :: value
      character(len=:), allocatable :: sign

      value = 0.0_wp
      parser%depth = parser%depth + 1                 ! a line of a million parentheses must not exhaust the stack
      if (parser%depth > DEEPEST) call fail(parser, parser%position, parser%position, 'the expression is nested too deeply')
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
         call take_terms(parser, 1, value)
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
      last = end_of_number(parser%text, first)
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
      character(len=:), allocatable :: name, problem
      integer :: first, last, i, k, place
      type(call_t) :: one

      value = 0.0_wp
      first = parser%position
      last = end_of_name(parser%text, first)
      name = parser%text(first:last)
      call move_to(parser, last + 1)
      i = int(find_name(parser%names, name))
      if (allocated(parser%calls) .and. next(parser) == '(') i = 0   ! where there are calls, a variable has no parentheses
      if (i > 0) then
         value = parser%values(i)
      else if (same_name(name, 'pi')) then
         value = PI
      else if (same_name(name, 'deg') .and. parser%has_degree) then
         value = PI/180
      else if (is_call(parser, name, last)) then
         ! Lists a call, or takes its value.
         value = 1.0_wp
         if (parser%is_listing) then
            call read_call(parser%text, first, last, one, problem, place)
            if (allocated(problem)) call fail(parser, place, place, problem)
            parser%calls = [parser%calls, one]
            k = size(parser%calls)
         else
            k = findloc(parser%calls%first, first, dim=1)
            value = parser%amounts(k)
         end if
         call move_to(parser, parser%calls(k)%last + 1)
      else if (is_function(name)) then
         call take_function(parser, lower_case(name), first, value)
      else
         call fail(parser, first, last, 'unknown name '//name)
         parser%fault%unknown_name = .true.
      end if
   end subroutine take_name

   !> Whether the name that ends at a place is a call: no function, or a least or largest value of a field.
   pure logical function is_call(parser, name, last)
      type(parser_t), intent(in) :: parser
      character(len=*), intent(in) :: name
      integer, intent(in) :: last

      is_call = .false.
      if (.not. allocated(parser%calls)) return
      if (.not. parser%is_listing) then
         is_call = any(parser%calls%first == last + 1 - len(name))
      else if (same_name(name, 'min') .or. same_name(name, 'max')) then
         is_call = has_argument_of(parser%text, last, parser%fields)
      else
         is_call = .not. is_function(name)
      end if
   end function is_call

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
      call take_terms(parser, 1, value)
      do while (name == 'min' .or. name == 'max')
         if (has_failed(parser) .or. next(parser) /= ',') exit
         call move_to(parser, parser%position + 1)
         call take_terms(parser, 1, argument)
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

      if (has_failed(parser) .or. parser%is_listing) return
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
