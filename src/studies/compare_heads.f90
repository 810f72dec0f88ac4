!> What the heads of two tables say of where they come from: other parameters, another deck, other options. It counts as no
!> difference, and it is what a reader wants to know first of tables that differ.
module atrito_compare_heads
   use atrito_page, only: page_t, add_line
   use atrito_read_table, only: table_file_t
   implicit none (type, external)
   private
   public :: tell_heads

   integer, parameter :: DECK = 1, PARAMETERS = 2, OPTIONS = 3, DIGEST = 4   !< places in HEAD_NAMES

contains

   !> Adds a line for each thing that two heads say otherwise. What the page has already is not told again: all tables of a run say
   !> the same.
   subroutine tell_heads(a, b, page)
      type(table_file_t), intent(in) :: a, b     !< of one name
      type(page_t), intent(inout) :: page        !< gets lines that it has not

      if (.not. (a%has_head .and. b%has_head)) return
      associate (one => a%head, two => b%head, other_deck => a%head(DECK)%s /= b%head(DECK)%s, &
                 other_values => a%head(PARAMETERS)%s /= b%head(PARAMETERS)%s)
         if (other_deck) call tell('another deck: '//both(one(DECK)%s, two(DECK)%s))
         if (other_values) call tell('other parameters: '//both(others(one(PARAMETERS)%s, two(PARAMETERS)%s), &
                                                                others(two(PARAMETERS)%s, one(PARAMETERS)%s)))
         if (one(OPTIONS)%s /= two(OPTIONS)%s) call tell('other options: '//both(one(OPTIONS)%s, two(OPTIONS)%s))
         if (one(DIGEST)%s /= two(DIGEST)%s .and. min(len(one(DIGEST)%s), len(two(DIGEST)%s)) > 0 .and. &
             .not. (other_deck .or. other_values)) call tell('a deck of the same name with other lines (digest)')
      end associate

   contains

      subroutine tell(text)
         character(len=*), intent(in) :: text
         integer :: i

         do i = 1, page%n
            if (page%lines(i)%s == text) return
         end do
         call add_line(page, text)
      end subroutine tell

   end subroutine tell_heads

   !> The items `name = value` of one list that do not stand in the other.
   pure function others(list, other) result(text)
      character(len=*), intent(in) :: list, other
      character(len=:), allocatable :: text
      integer :: first, last

      text = ''
      first = 1
      do while (first <= len(list))
         last = first + index(list(first:)//', ', ', ') - 2
         if (index(', '//other//', ', ', '//list(first:last)//', ') == 0) then
            if (len(text) > 0) text = text//', '
            text = text//list(first:last)
         end if
         first = last + 3
      end do
   end function others

   pure function both(one, two) result(text)
      character(len=*), intent(in) :: one, two
      character(len=:), allocatable :: text

      text = one//' / '//two
      if (len(one) == 0) text = 'none / '//two
      if (len(two) == 0) text = one//' / none'
   end function both

end module atrito_compare_heads
