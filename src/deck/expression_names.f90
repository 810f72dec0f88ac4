!> The names and numbers in the text of an expression, the names that it knows by itself, and those that are no arithmetic, with
!> what stands in parentheses behind them: `u2(12)`, `max(mises, BEAM)`. What these mean is not known here.
module atrito_expression_names
   use atrito_strings, only: string_t, same_name, append_string, replaced
   implicit none (type, external)
   private
   public :: call_t, argument_t, read_call, has_argument_of
   public :: is_reserved_name, reserved_names, is_name, is_function, end_of_number, end_of_name, next_name, DIGITS, LETTERS

   character(len=*), parameter :: DIGITS = '0123456789'
   character(len=*), parameter :: LETTERS = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'
   character(len=4), parameter :: FUNCTIONS(10) = ['sqrt', 'abs ', 'exp ', 'log ', 'sin ', 'cos ', 'tan ', 'atan', 'min ', 'max ']

   !> A name or number in parentheses.
   type :: argument_t
      character(len=:), allocatable :: text          !< without the blanks round it, not empty
      integer :: first = 1, last = 1                 !< its characters in the expression
   end type argument_t

   type :: call_t
      character(len=:), allocatable :: name          !< as in the expression
      integer :: first = 1, last = 1                 !< characters of the expression, with the parentheses
      logical :: has_parentheses = .false.           !< arguments follow, or none in ()
      type(argument_t), allocatable :: arguments(:)  !< none without parentheses
   end type call_t

   character(len=*), parameter :: BLANKS = ' '//achar(9)

contains

   !> Names that a parameter cannot have: functions, and pi.
   pure logical function is_reserved_name(name)
      character(len=*), intent(in) :: name !< without case

      is_reserved_name = same_name(name, 'pi') .or. is_function(name)
   end function is_reserved_name

   !> Names that expressions know by themselves: the functions, `pi` and, where no parameter has its name, `deg`.
   pure function reserved_names() result(names)
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      do i = 1, size(FUNCTIONS)
         call append_string(names, trim(FUNCTIONS(i)))
      end do
      call append_string(names, 'pi')
      call append_string(names, 'deg')
   end function reserved_names

   !> Letters, digits and underscores, beginning with a letter.
   pure logical function is_name(text)
      character(len=*), intent(in) :: text !< without blanks round it

      is_name = len(text) > 0
      if (is_name) is_name = scan(text(1:1), LETTERS) == 1 .and. verify(text, LETTERS//DIGITS//'_') == 0
   end function is_name

   !> Whether a name, of any case, is that of a function.
   pure logical function is_function(name)
      character(len=*), intent(in) :: name !< without case
      integer :: i

      is_function = .false.
      do i = 1, size(FUNCTIONS)
         is_function = is_function .or. same_name(name, FUNCTIONS(i))
      end do
   end function is_function

   !> The last character of the number that begins at `first`.
   pure integer function end_of_number(text, first) result(last)
      character(len=*), intent(in) :: text !< the expression
      integer, intent(in) :: first         !< first digit of the number, or its point

      last = first
      do while (last < len(text))
         associate (symbol => text(last + 1:last + 1), before => text(last:last))
            if (scan(symbol, DIGITS//LETTERS//'._') == 0) then
               ! the sign of an exponent; hexadecimal and names are refused by read_real
               if (scan(symbol, '+-') == 0 .or. scan(before, 'eEdD') == 0) exit
            end if
         end associate
         last = last + 1
      end do
   end function end_of_number

   !> The last character of the name that begins at `first`.
   pure integer function end_of_name(text, first) result(last)
      character(len=*), intent(in) :: text !< the expression
      integer, intent(in) :: first         !< first letter of the name

      last = first                                    ! letter by letter: a text may have a million names
      do while (last < len(text))
         if (scan(text(last + 1:last + 1), LETTERS//DIGITS//'_') == 0) return
         last = last + 1
      end do
   end function end_of_name

   !> The next name of a sound expression behind `last`; first > len(text) when there is none. The e of 1e5 is no name.
   pure subroutine next_name(text, last, first)
      character(len=*), intent(in) :: text             !< an expression whose text is sound
      integer, intent(inout) :: last                   !< 0: of the whole expression the first; then that of the name
      integer, intent(out) :: first                    !< its first character

      do first = last + 1, len(text)
         if (first <= last) cycle
         if (scan(text(first:first), LETTERS) == 1) then
            last = end_of_name(text, first)
            return
         end if
         if (scan(text(first:first), DIGITS//'.') == 1) last = end_of_number(text, first)
      end do
   end subroutine next_name

   !> Reads the call whose name stands at some characters of an expression.
   pure subroutine read_call(text, first, last, one, problem, place)
      character(len=*), intent(in) :: text                  !< the expression
      integer, intent(in) :: first, last                    !< of the name
      type(call_t), intent(out) :: one                      !< of no use where there is a problem
      character(len=:), allocatable, intent(out) :: problem !< what is wrong; not allocated: nothing
      integer, intent(out) :: place                         !< and where
      integer :: i, depth, begin
      character(len=1) :: symbol

      one%name = text(first:last)
      one%first = first
      one%last = last
      allocate (one%arguments(0))
      place = first_behind(text, last)
      symbol = ' '
      if (place <= len(text)) symbol = text(place:place)
      one%has_parentheses = symbol == '('
      if (.not. one%has_parentheses) return
      begin = place + 1
      depth = 0
      do i = place, len(text)
         if (text(i:i) == '(') depth = depth + 1
         if (text(i:i) == ')') depth = depth - 1
         if (.not. (depth == 0 .or. (depth == 1 .and. text(i:i) == ','))) cycle
         call add_argument(text, begin, i - 1, one%arguments, problem, place)
         begin = i + 1
         if (allocated(problem)) return
         if (depth > 0) cycle
         one%last = i
         return
      end do
      place = len(text) + 1
      problem = "')' is missing"
   end subroutine read_call

   !> Whether the first argument behind a name is one of some names: that distinguishes the minimum of a field from one of numbers.
   pure logical function has_argument_of(text, last, names)
      character(len=*), intent(in) :: text             !< the expression
      integer, intent(in) :: last                      !< of the name
      type(string_t), intent(in) :: names(:)           !< without case
      type(call_t) :: one
      character(len=:), allocatable :: problem
      integer :: i, place

      has_argument_of = .false.
      call read_call(text, last, last, one, problem, place)
      if (allocated(problem) .or. size(one%arguments) == 0) return
      do i = 1, size(names)
         has_argument_of = has_argument_of .or. same_name(names(i)%s, one%arguments(1)%text)
      end do
   end function has_argument_of

   !> Appends what stands at some characters, without the blanks round it.
   pure subroutine add_argument(text, first, last, list, problem, place)
      character(len=*), intent(in) :: text
      integer, intent(in) :: first, last               !< last may be first - 1: nothing
      type(argument_t), allocatable, intent(inout) :: list(:)
      character(len=:), allocatable, intent(inout) :: problem
      integer, intent(inout) :: place
      type(argument_t), allocatable :: longer(:)
      integer :: i, n

      i = first_behind(text, first - 1)
      if (i > last) then
         place = last + 1
         problem = 'a name or a number is missing'
         return
      end if
      n = size(list)
      allocate (longer(n + 1))                         ! gfortran leaks a text in an array constructor
      longer(:n) = list
      longer(n + 1)%first = i
      longer(n + 1)%last = first + len_trim(replaced(text(first:last), BLANKS, ' ')) - 1
      longer(n + 1)%text = text(i:longer(n + 1)%last)
      call move_alloc(longer, list)
   end subroutine add_argument

   !> The first character behind a place that is no blank; one behind the end when there is none.
   pure integer function first_behind(text, place) result(i)
      character(len=*), intent(in) :: text
      integer, intent(in) :: place

      do i = place + 1, len(text)
         if (scan(text(i:i), BLANKS) == 0) return
      end do
      i = len(text) + 1
   end function first_behind

end module atrito_expression_names
