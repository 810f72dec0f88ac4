!> Mutations of a deck: from single bytes to whole cards.
module fuzz_mutations
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, to_text
   use fuzz_random, only: random_t, random_integer, random_chance
   use fuzz_words, only: dictionary_t
   implicit none (type, external)
   private
   public :: mutate_deck

   character(len=1), parameter :: NEW_LINE_CHARACTER = achar(10)
   integer(ip), parameter :: MOST_STEPS = 6            !< mutations of one deck
   integer(ip), parameter :: LARGEST_DECK = 400000     !< characters

contains

   !> A deck, changed once to six times, more often a few times: it shall often be sound but for one thing.
   subroutine mutate_deck(random, decks, dictionary, own_name, text)
      type(random_t), intent(inout) :: random
      type(string_t), intent(in) :: decks(:)
      type(dictionary_t), intent(in) :: dictionary
      character(len=*), intent(in) :: own_name         !< of the file that the text goes to: it may include itself
      character(len=:), allocatable, intent(out) :: text
      integer(ip) :: i, n, steps

      call random_integer(random, 1_ip, size(decks, kind=ip), i)
      text = decks(i)%s
      call random_integer(random, 1_ip, MOST_STEPS, steps)
      call random_integer(random, 1_ip, (steps), steps)
      do n = 1, steps
         call mutate_once(random, decks, dictionary, own_name, text)
         if (len(text) > LARGEST_DECK) call replace_place(text, LARGEST_DECK + 1, len(text, kind=ip), '')
      end do
   end subroutine mutate_deck

   subroutine mutate_once(random, decks, dictionary, own_name, text)
      type(random_t), intent(inout) :: random
      type(string_t), intent(in) :: decks(:)
      type(dictionary_t), intent(in) :: dictionary
      character(len=*), intent(in) :: own_name
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: kind

      call random_integer(random, 1_ip, 40_ip, kind)
      select case (kind)
      case (1:2)
         call flip_byte(random, text)
      case (3)
         call delete_span(random, text)
      case (4)
         call insert_item(random, dictionary, text)
      case (5:15)
         call replace_item(random, dictionary, text)
      case (16:18)
         call change_digit(random, text)
      case (19:20)
         call delete_item(random, text)
      case (21:22)
         call delete_line(random, text)
      case (23:24)
         call copy_line(random, text)
      case (25)
         call swap_lines(random, text)
      case (26:28)
         call splice(random, decks, text)
      case (29)
         call truncate_deck(random, text)
      case (30:32)
         call insert_line(random, dictionary, text)
      case (33:35)
         call delete_card(random, text)
      case (36:37)
         call move_card(random, text)
      case default
         call disturb_whole(random, dictionary, own_name, text)
      end select
   end subroutine mutate_once

   !> Rare and large changes.
   subroutine disturb_whole(random, dictionary, own_name, text)
      type(random_t), intent(inout) :: random
      type(dictionary_t), intent(in) :: dictionary
      character(len=*), intent(in) :: own_name
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: kind

      call random_integer(random, 1_ip, 8_ip, kind)
      select case (kind)
      case (1)
         call use_windows_ends(text)
      case (2)
         call insert_long_line(random, dictionary, text)
      case (3:4)
         call insert_parameters(random, text)
      case (5)
         call insert_at_line(random, '*INCLUDE, INPUT='//own_name//NEW_LINE_CHARACTER, text)
      case (6)
         call insert_at_line(random, '*INCLUDE, INPUT=/proc/self/cwd/./'//own_name//NEW_LINE_CHARACTER, text)
      case default
         call insert_item(random, dictionary, text)
      end select
   end subroutine disturb_whole

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

   subroutine any_item(random, dictionary, item)
      type(random_t), intent(inout) :: random
      type(dictionary_t), intent(in) :: dictionary
      character(len=:), allocatable, intent(out) :: item
      integer(ip) :: i

      call random_integer(random, 1_ip, size(dictionary%items, kind=ip), i)
      item = dictionary%items(i)%s
   end subroutine any_item

   subroutine insert_item(random, dictionary, text)
      type(random_t), intent(inout) :: random
      type(dictionary_t), intent(in) :: dictionary
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: item
      integer(ip) :: i

      call any_item(random, dictionary, item)
      call random_integer(random, 1_ip, len(text, kind=ip) + 1, i)
      call replace_place(text, i, i - 1, item)
   end subroutine insert_item

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

   subroutine replace_item(random, dictionary, text)
      type(random_t), intent(inout) :: random
      type(dictionary_t), intent(in) :: dictionary
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: item
      integer(ip) :: first, last, i, j
      logical :: own

      call find_item(random, text, first, last)
      call random_chance(random, 3_ip, own)
      if (own) then                                      ! another item of the same deck
         call find_item(random, text, i, j)
         item = text(i:j)
      else
         call any_item(random, dictionary, item)
      end if
      call replace_place(text, first, last, item)
   end subroutine replace_item

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

   !> A card of a deck in the place of a line's beginning, or the end of one deck behind the beginning of another.
   subroutine splice(random, decks, text)
      type(random_t), intent(inout) :: random
      type(string_t), intent(in) :: decks(:)
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: changed
      integer(ip) :: i, first, last, cut, ignored
      logical :: whole

      call random_integer(random, 1_ip, size(decks, kind=ip), i)
      call find_card(random, decks(i)%s, first, last)
      call random_chance(random, 5_ip, whole)
      if (whole) then
         call find_line(random, text, cut, ignored)
         changed = text(:cut - 1)//decks(i)%s(first:)
         call move_alloc(changed, text)
      else
         call insert_at_line(random, decks(i)%s(first:last), text)
      end if
   end subroutine splice

   subroutine truncate_deck(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: i

      call random_integer(random, 0_ip, len(text, kind=ip), i)
      text = text(:i)
   end subroutine truncate_deck

   subroutine insert_line(random, dictionary, text)
      type(random_t), intent(inout) :: random
      type(dictionary_t), intent(in) :: dictionary
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: i

      call random_integer(random, 1_ip, size(dictionary%lines, kind=ip), i)
      call insert_at_line(random, dictionary%lines(i)%s, text)
   end subroutine insert_line

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

   !> A line of up to 20000 items, behind a line of the deck or in the place of its end.
   subroutine insert_long_line(random, dictionary, text)
      type(random_t), intent(inout) :: random
      type(dictionary_t), intent(in) :: dictionary
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: item
      integer(ip) :: n, first, last

      call any_item(random, dictionary, item)
      call random_integer(random, 100_ip, 20000_ip, n)
      call find_line(random, text, first, last)
      n = min(n, LARGEST_DECK/(len(item, kind=ip) + 2))
      call replace_place(text, max(last, 1_ip), max(last, 1_ip) - 1, repeat(', '//item, n))
   end subroutine insert_long_line

   !> Up to 300 parameters, each the one before with something done to it.
   subroutine insert_parameters(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=16), parameter :: TAIL(8) = [character(len=16) :: '+1', '*2', '**2', '-d0', '/3', '*d0/d0', '**0.5', '*1e300']
      character(len=:), allocatable :: lines
      integer(ip) :: n, i, k

      call random_integer(random, 1_ip, 300_ip, n)
      call random_integer(random, 1_ip, size(TAIL, kind=ip), k)
      lines = '*PARAMETER'//NEW_LINE_CHARACTER//'d0 = 1'//NEW_LINE_CHARACTER
      do i = 1, n
         lines = lines//'d'//to_text(i)//' = (d'//to_text(i - 1)//trim(TAIL(k))//')'//NEW_LINE_CHARACTER
      end do
      call insert_at_line(random, lines, text)
   end subroutine insert_parameters

end module fuzz_mutations
