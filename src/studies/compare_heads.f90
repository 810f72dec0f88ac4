!> What the heads of two tables say of where they come from: other parameters, another deck, other options. It counts as no
!> difference, and it is what a reader wants to know first of tables that differ.
module atrito_compare_heads
   use atrito_page, only: page_t, add_line
   use atrito_read_table, only: table_file_t
   use atrito_strings, only: string_t, append_string
   implicit none (type, external)
   private
   public :: heads_t, tell_heads

   integer, parameter :: DECK = 1, PARAMETERS = 2, OPTIONS = 3, DIGEST = 4   !< places in HEAD_NAMES

   !> What was told already: all tables of a run say the same.
   type :: heads_t
      type(string_t), allocatable :: told(:)
   end type heads_t

contains

   !> Adds a line for each thing that two heads say otherwise and that was not told before.
   subroutine tell_heads(a, b, heads, page)
      type(table_file_t), intent(in) :: a, b
      type(heads_t), intent(inout) :: heads
      type(page_t), intent(inout) :: page

      if (.not. allocated(heads%told)) allocate (heads%told(0))
      if (.not. (a%has_head .and. b%has_head)) return
      associate (other_deck => text_of(a, DECK) /= text_of(b, DECK), &
                 other_values => text_of(a, PARAMETERS) /= text_of(b, PARAMETERS))
         if (other_deck) call tell('another deck: '//both(text_of(a, DECK), text_of(b, DECK)))
         if (other_values) call tell('other parameters: '//both(others(text_of(a, PARAMETERS), text_of(b, PARAMETERS)), &
                                                                others(text_of(b, PARAMETERS), text_of(a, PARAMETERS))))
         if (text_of(a, OPTIONS) /= text_of(b, OPTIONS)) then
            call tell('other options: '//both(text_of(a, OPTIONS), text_of(b, OPTIONS)))
         end if
         if (text_of(a, DIGEST) /= text_of(b, DIGEST) .and. len(text_of(a, DIGEST)) > 0 .and. len(text_of(b, DIGEST)) > 0 .and. &
             .not. (other_deck .or. other_values)) call tell('a deck of the same name with other lines (digest)')
      end associate

   contains

      subroutine tell(text)
         character(len=*), intent(in) :: text
         integer :: i

         do i = 1, size(heads%told)
            if (heads%told(i)%s == text) return
         end do
         call append_string(heads%told, text)
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

   pure function text_of(table, i) result(text)
      type(table_file_t), intent(in) :: table
      integer, intent(in) :: i                       !< place in HEAD_NAMES
      character(len=:), allocatable :: text

      text = ''
      if (allocated(table%head(i)%s)) text = table%head(i)%s
   end function text_of

   pure function both(one, two) result(text)
      character(len=*), intent(in) :: one, two
      character(len=:), allocatable :: text

      text = one//' / '//two
      if (len(one) == 0) text = 'none / '//two
      if (len(two) == 0) text = one//' / none'
   end function both

end module atrito_compare_heads
