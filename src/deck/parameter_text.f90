!> The parameters of a deck in words: names and values, and those that runs of a series give other values.
module atrito_parameter_text
   use atrito_deck, only: deck_t, token_text
   use atrito_deck_expressions, only: index_of_parameter
   use atrito_expression_names, only: next_name
   use atrito_growing_text, only: growing_text_t, append_text, take_text
   use atrito_kinds, only: ip
   use atrito_numbers, only: exact_text
   use atrito_strings, only: string_t, same_name
   implicit none (type, external)
   private
   public :: list_parameters

contains

   !> `nu = 0.3, q = 10 (--set), eps varies`, in the order of the deck; not allocated where it has none.
   subroutine list_parameters(deck, varied, text)
      type(deck_t), intent(in) :: deck                   !< its parameters are read
      type(string_t), intent(in) :: varied(:)            !< names of those that take several values
      character(len=:), allocatable, intent(out) :: text !< in one line
      type(growing_text_t) :: words
      logical, allocatable :: varies(:)
      integer(ip) :: i, k

      if (deck%n_parameters == 0) return
      allocate (varies(deck%n_parameters), source=.false.)
      do i = 1, deck%n_parameters                      ! the varied ones and those that depend on them
         do k = 1, size(varied, kind=ip)
            varies(i) = varies(i) .or. same_name(deck%parameters(i)%name, varied(k)%s)
         end do
         if (.not. (varies(i) .or. deck%parameters(i)%overridden)) varies(i) = names_one(deck, i, varies)
      end do
      do i = 1, deck%n_parameters
         associate (parameter => deck%parameters(i))
            if (i > 1) call append_text(words, ', ')
            call append_text(words, parameter%name)
            if (varies(i)) then
               call append_text(words, ' varies')
            else
               call append_text(words, ' = '//exact_text(parameter%value))
               if (parameter%overridden) call append_text(words, ' (--set)')
            end if
         end associate
      end do
      call take_text(words, text)
   end subroutine list_parameters

   !> The expression of the i-th parameter names one before it that varies.
   pure logical function names_one(deck, i, varies)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: i
      logical, intent(in) :: varies(:)
      character(len=:), allocatable :: expression
      integer :: first, last
      integer(ip) :: k

      names_one = .false.
      expression = token_text(deck, deck%parameters(i)%expression)
      last = 0
      do while (.not. names_one)
         call next_name(expression, last, first)
         if (first > len(expression)) return
         k = index_of_parameter(deck, expression(first:last))
         if (k > 0 .and. k < i) names_one = varies(k)
      end do
   end function names_one

end module atrito_parameter_text
