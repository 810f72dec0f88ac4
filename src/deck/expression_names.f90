!> The names and numbers in the text of an expression, and the names that it knows by itself.
module atrito_expression_names
   use atrito_strings, only: string_t, same_name, append_string
   implicit none (type, external)
   private
   public :: is_reserved_name, reserved_names, is_name, is_function, end_of_number, end_of_name, next_name, DIGITS, LETTERS

   character(len=*), parameter :: DIGITS = '0123456789'
   character(len=*), parameter :: LETTERS = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'
   character(len=4), parameter :: FUNCTIONS(10) = ['sqrt', 'abs ', 'exp ', 'log ', 'sin ', 'cos ', 'tan ', 'atan', 'min ', 'max ']

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

end module atrito_expression_names
