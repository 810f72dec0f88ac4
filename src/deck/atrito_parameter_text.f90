!> The parameters of a deck in words: names and values, and those that runs of a series give other values.
module atrito_parameter_text
   use atrito_deck, only: deck_t, token_text
   use atrito_expressions, only: next_name
   use atrito_kinds, only: ip
   use atrito_numbers, only: exact_text
   use atrito_strings, only: string_t, same_name
   implicit none (type, external)
   private
   public :: list_parameters

contains

   !> `nu = 0.3, q = 10 (--set), eps varies`, in the order of the deck; not allocated where it has none.
   subroutine list_parameters(deck, varied, text)
      type(deck_t), intent(in) :: deck
      type(string_t), intent(in) :: varied(:)          !< names of those that take several values
      character(len=:), allocatable, intent(out) :: text
      logical, allocatable :: varies(:)
      integer(ip) :: i

      if (deck%n_parameters == 0) return
      call find_varying(deck, varied, varies)
      text = ''
      do i = 1, deck%n_parameters
         associate (parameter => deck%parameters(i))
            if (i > 1) text = text//', '
            text = text//parameter%name
            if (varies(i)) then
               text = text//' varies'
            else
               text = text//' = '//exact_text(parameter%value)
               if (parameter%overridden) text = text//' (--set)'
            end if
         end associate
      end do
   end subroutine list_parameters

   !> The varied parameters and those that depend on them.
   pure subroutine find_varying(deck, varied, varies)
      type(deck_t), intent(in) :: deck
      type(string_t), intent(in) :: varied(:)
      logical, allocatable, intent(out) :: varies(:)   !< (deck%n_parameters)
      integer(ip) :: i, k

      allocate (varies(deck%n_parameters), source=.false.)
      do i = 1, deck%n_parameters
         do k = 1, size(varied, kind=ip)
            varies(i) = varies(i) .or. same_name(deck%parameters(i)%name, varied(k)%s)
         end do
         if (deck%parameters(i)%overridden) cycle
         do k = 1, i - 1
            if (varies(i)) exit
            if (varies(k)) varies(i) = has_name(token_text(deck, deck%parameters(i)%expression), deck%parameters(k)%name)
         end do
      end do
   end subroutine find_varying

   !> A name stands in an expression.
   pure logical function has_name(expression, name)
      character(len=*), intent(in) :: expression, name
      integer :: first, last

      has_name = .false.
      last = 0
      do
         call next_name(expression, last, first)
         if (first > len(expression)) return
         has_name = same_name(expression(first:last), name)
         if (has_name) return
      end do
   end function has_name

end module atrito_parameter_text
