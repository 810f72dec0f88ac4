!> Changes of a text of lines and items: what mutations are made of.
module fuzz_edits
   use atrito_kinds, only: ip
   use fuzz_random, only: random_t, random_integer, random_chance
   implicit none (type, external)
   private
   public :: replace_place, find_item, find_line, find_card, insert_at_line
   public :: flip_byte, delete_span, delete_item, change_digit, delete_line, copy_line, swap_lines, truncate_deck, delete_card, &
             move_card, use_windows_ends

   character(len=1), parameter :: NEW_LINE_CHARACTER = achar(10)

contains

   subroutine flip_byte(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: i, bit

      if (len(text) == 0) return
      call random_integer(random, 1_ip, len(text, kind=ip), i)
      call random_integer(random, 0_ip, 7_ip, bit)
      text(i:i) = char(ieor(ichar(text(i:i)), shiftl(1, bit)))
   end subroutine flip_byte

   subroutine delete_span(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: first, length

      call random_integer(random, 1_ip, len(text, kind=ip), first)
      call random_integer(random, 1_ip, 30_ip, length)
      call replace_place(text, first, min(first + length - 1, len(text, kind=ip)), '')
   end subroutine delete_span

   !> text(first:last) becomes `new`; last = first - 1 inserts.
   pure subroutine replace_place(text, first, last, new)
      character(len=:), allocatable, intent(inout) :: text
      integer(ip), intent(in) :: first, last
      character(len=*), intent(in) :: new
      character(len=:), allocatable :: changed

      changed = text(:first - 1)//new//text(last + 1:)
      call move_alloc(changed, text)
   end subroutine replace_place

   !> The ends of an item chosen at random: between commas, equals signs and ends of lines. Mostly not one of a comment.
   subroutine find_item(random, text, first, last)
      type(random_t), intent(inout) :: random
      character(len=*), intent(in) :: text
      integer(ip), intent(out) :: first, last
      character(len=*), parameter :: ENDS = ',='//NEW_LINE_CHARACTER
      integer(ip) :: i, attempt

      first = 1
      last = 0
      do attempt = 1, 8
         call random_integer(random, 1_ip, len(text, kind=ip), i)
         if (i > len(text)) return
         first = scan(text(:i - 1), ENDS, back=.true., kind=ip) + 1
         last = first + scan(text(first:)//NEW_LINE_CHARACTER, ENDS, kind=ip) - 2
         if (.not. in_comment(text, first)) return
      end do
   end subroutine find_item

   pure logical function in_comment(text, place)
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: place
      integer(ip) :: first

      first = scan(text(:place - 1), NEW_LINE_CHARACTER, back=.true., kind=ip) + 1
      in_comment = index(text(first:min(first + 1, len(text, kind=ip))), '**') == 1
   end function in_comment

   subroutine delete_item(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: first, last
      logical :: with_comma

      call find_item(random, text, first, last)
      call random_chance(random, 2_ip, with_comma)
      if (with_comma) last = min(last + 1, len(text, kind=ip))
      call replace_place(text, first, last, '')
   end subroutine delete_item

   !> Another digit, sign or exponent in a number.
   subroutine change_digit(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=*), parameter :: PARTS = '0123456789.-+eEdD'
      integer(ip) :: i, k, attempt
      logical :: insert

      do attempt = 1, 20
         call random_integer(random, 1_ip, len(text, kind=ip), i)
         if (i > len(text)) return
         if (scan(text(i:i), '0123456789.') == 0) cycle
         if (in_comment(text, i)) cycle
         call random_integer(random, 1_ip, len(PARTS, kind=ip), k)
         call random_chance(random, 2_ip, insert)
         call replace_place(text, i, merge(i - 1, i, insert), PARTS(k:k))
         return
      end do
   end subroutine change_digit

   !> A line with its end.
   subroutine find_line(random, text, first, last)
      type(random_t), intent(inout) :: random
      character(len=*), intent(in) :: text
      integer(ip), intent(out) :: first, last
      integer(ip) :: i

      call random_integer(random, 1_ip, max(len(text, kind=ip), 1_ip), i)
      first = scan(text(:min(i - 1, len(text, kind=ip))), NEW_LINE_CHARACTER, back=.true., kind=ip) + 1
      last = min(first + scan(text(first:)//NEW_LINE_CHARACTER, NEW_LINE_CHARACTER, kind=ip) - 1, len(text, kind=ip))
   end subroutine find_line

   !> A keyword line with all lines up to the next one.
   subroutine find_card(random, text, first, last)
      type(random_t), intent(inout) :: random
      character(len=*), intent(in) :: text
      integer(ip), intent(out) :: first, last
      integer(ip) :: i

      call random_integer(random, 1_ip, max(len(text, kind=ip), 1_ip), i)
      first = index(text(:min(i, len(text, kind=ip))), NEW_LINE_CHARACTER//'*', back=.true., kind=ip) + 1
      last = index(text(first:), NEW_LINE_CHARACTER//'*', kind=ip) + first - 1
      if (last < first) last = len(text, kind=ip)
   end subroutine find_card

   subroutine delete_line(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: first, last

      call find_line(random, text, first, last)
      call replace_place(text, first, last, '')
   end subroutine delete_line

   subroutine copy_line(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: first, last

      call find_line(random, text, first, last)
      call insert_at_line(random, text(first:last), text)
   end subroutine copy_line

   subroutine insert_at_line(random, new, text)
      type(random_t), intent(inout) :: random
      character(len=*), intent(in) :: new
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: first, last

      call find_line(random, text, first, last)
      call replace_place(text, first, first - 1, new)
   end subroutine insert_at_line

   subroutine swap_lines(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: changed
      integer(ip) :: a(2), b(2), held(2)

      call find_line(random, text, a(1), a(2))
      call find_line(random, text, b(1), b(2))
      if (a(1) == b(1)) return
      if (a(1) > b(1)) then
         held = a
         a = b
         b = held
      end if
      changed = text(:a(1) - 1)//text(b(1):b(2))//text(a(2) + 1:b(1) - 1)//text(a(1):a(2))//text(b(2) + 1:)
      call move_alloc(changed, text)
   end subroutine swap_lines

   subroutine truncate_deck(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: i

      call random_integer(random, 0_ip, len(text, kind=ip), i)
      text = text(:i)
   end subroutine truncate_deck

   subroutine delete_card(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: first, last

      call find_card(random, text, first, last)
      call replace_place(text, first, last, '')
   end subroutine delete_card

   subroutine move_card(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: card
      integer(ip) :: first, last
      logical :: copy

      call find_card(random, text, first, last)
      card = text(first:last)
      call random_chance(random, 2_ip, copy)
      if (.not. copy) call replace_place(text, first, last, '')
      call find_card(random, text, first, last)
      call replace_place(text, first, first - 1, card)
   end subroutine move_card

   pure subroutine use_windows_ends(text)
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: longer
      integer(ip) :: i, n

      allocate (character(len=2*len(text)) :: longer)
      n = 0
      do i = 1, len(text, kind=ip)
         if (text(i:i) == NEW_LINE_CHARACTER) then
            n = n + 1
            longer(n:n) = achar(13)
         end if
         n = n + 1
         longer(n:n) = text(i:i)
      end do
      text = longer(:n)
   end subroutine use_windows_ends

end module fuzz_edits
