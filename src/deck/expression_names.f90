!> The names that expressions know by themselves.
module atrito_expression_names
   use atrito_strings, only: string_t, same_name, append_string
   implicit none (type, external)
   private
   public :: is_reserved_name, reserved_names, is_name, is_function, DIGITS, LETTERS

   character(len=*), parameter :: DIGITS = '0123456789'
   character(len=*), parameter :: LETTERS = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'
   character(len=4), parameter :: FUNCTIONS(10) = ['sqrt', 'abs ', 'exp ', 'log ', 'sin ', 'cos ', 'tan ', 'atan', 'min ', 'max ']

contains

   !> Names that a parameter cannot have: functions, and pi.
   pure logical function is_reserved_name(name)
      character(len=*), intent(in) :: name

      is_reserved_name = same_name(name, 'pi') .or. is_function(name)
   end function is_reserved_name

   !> Names that parameters cannot have: the functions, `pi` and `deg`.
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
      character(len=*), intent(in) :: text

      is_name = len(text) > 0
      if (is_name) is_name = scan(text(1:1), LETTERS) == 1 .and. verify(text, LETTERS//DIGITS//'_') == 0
   end function is_name

   !> Whether a name, of any case, is that of a function of one number.
   pure logical function is_function(name)
      character(len=*), intent(in) :: name
      integer :: i

      is_function = .false.
      do i = 1, size(FUNCTIONS)
         is_function = is_function .or. same_name(name, FUNCTIONS(i))
      end do
   end function is_function

end module atrito_expression_names
