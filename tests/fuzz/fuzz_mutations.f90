!> Mutations of a deck: from single bytes to whole cards.
module fuzz_mutations
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, to_text
   use fuzz_edits, only: replace_place, find_item, find_line, find_card, insert_at_line, flip_byte, delete_span, delete_item, &
                         change_digit, delete_line, copy_line, swap_lines, truncate_deck, delete_card, move_card, use_windows_ends
   use fuzz_random, only: random_t, random_integer, random_chance
   use fuzz_structures, only: mutate_structure
   use fuzz_words, only: dictionary_t
   implicit none (type, external)
   private
   public :: mutate_deck, mutate_once

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

      call random_integer(random, 1_ip, 48_ip, kind)
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
      case (38:45)
         call mutate_structure(random, text)
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

   subroutine insert_line(random, dictionary, text)
      type(random_t), intent(inout) :: random
      type(dictionary_t), intent(in) :: dictionary
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: i

      call random_integer(random, 1_ip, size(dictionary%lines, kind=ip), i)
      call insert_at_line(random, dictionary%lines(i)%s, text)
   end subroutine insert_line

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
