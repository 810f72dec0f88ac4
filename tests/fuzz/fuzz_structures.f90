!> Mutations of what decks of other programs have: parts and their instances, arithmetic in data lines, lines that go on.
module fuzz_structures
   use atrito_kinds, only: ip
   use atrito_strings, only: to_text
   use fuzz_edits, only: replace_place, find_item, find_line, find_card, insert_at_line
   use fuzz_random, only: random_t, random_integer, random_chance
   implicit none (type, external)
   private
   public :: mutate_structure

   character(len=1), parameter :: NEW_LINE_CHARACTER = achar(10)
   integer(ip), parameter :: DEEPEST = 3000            !< brackets in brackets
   integer(ip), parameter :: MOST_INSTANCES = 200      !< of one mutation

contains

   subroutine mutate_structure(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: kind

      call random_integer(random, 1_ip, 15_ip, kind)
      select case (kind)
      case (1:3)
         call wrap_item(random, text)
      case (4)
         call nest_item(random, text)
      case (5:6)
         call break_line(random, text)
      case (7)
         call join_lines(random, text)
      case (8:9)
         call prefix_item(random, text)
      case (10:12)
         call copy_instances(random, text)
      case (13:14)
         call make_part(random, text)
      case default
         call move_end(random, text)
      end select
   end subroutine mutate_structure

   !> An item becomes arithmetic.
   subroutine wrap_item(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=12), parameter :: BEFORE(10) = [character(len=12) :: '<', '<2*', '<-', '<min(', '<sin(', '-<', '<<', '<(', &
                                                                                                               '<1e300*', '<atan2(']
      character(len=12), parameter :: AFTER(10) = [character(len=12) :: '>', '/2>', '*deg>', ', 3)>', '*deg)>', '>', '>>', ')>', &
                                                                                                                     '**400>', ',>']
      integer(ip) :: first, last, i, k
      logical :: other

      call find_item(random, text, first, last)
      call random_integer(random, 1_ip, size(BEFORE, kind=ip), i)
      call random_integer(random, 1_ip, size(AFTER, kind=ip), k)
      call random_chance(random, 4_ip, other)
      if (.not. other) k = i                             ! mostly they fit
      call replace_place(text, first, last, trim(BEFORE(i))//text(first:last)//trim(AFTER(k)))
   end subroutine wrap_item

   !> Brackets in brackets.
   subroutine nest_item(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=6), parameter :: OPEN (6) = [character(len=6) :: '(', '<', 'sqrt(', '-', 'abs(-', '1+(']
      character(len=1), parameter :: SHUT(6) = [')', '>', ')', ' ', ')', ')']
      integer(ip) :: first, last, i, n
      logical :: whole

      call find_item(random, text, first, last)
      call random_integer(random, 1_ip, size(OPEN, kind=ip), i)
      call random_integer(random, 1_ip, DEEPEST, n)
      call random_chance(random, 2_ip, whole)
      if (.not. whole) n = 1 + n/100
      call replace_place(text, first, last, '<'//repeat(trim(OPEN (i)), n)//text(first:last)//repeat(SHUT(i), n)//'>')
   end subroutine nest_item

   !> A line ends behind an item, with or without a comma.
   subroutine break_line(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: first, last
      logical :: with_comma

      call find_item(random, text, first, last)
      call random_chance(random, 2_ip, with_comma)
      if (with_comma) then
         call replace_place(text, first, first - 1, NEW_LINE_CHARACTER)
      else
         call replace_place(text, last + 1, last, NEW_LINE_CHARACTER)
      end if
   end subroutine break_line

   !> A line goes on with the next one.
   subroutine join_lines(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      integer(ip) :: first, last
      logical :: with_comma

      call find_line(random, text, first, last)
      call random_chance(random, 2_ip, with_comma)
      call replace_place(text, last, last, trim(merge(',', ' ', with_comma)))
   end subroutine join_lines

   !> An item becomes that of an instance or of something else.
   subroutine prefix_item(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: owner
      integer(ip) :: first, last, i, k
      logical :: is_name

      call find_item(random, text, first, last)
      owner = text(first:last)
      call random_chance(random, 2_ip, is_name)
      if (is_name) then                                  ! the name of some instance, if there is one
         call find_word(random, text, '*INSTANCE', i)
         if (i > 0) then
            k = scan(text(i:), '=', kind=ip) + i
            owner = text(k:k + scan(text(k:)//',', ','//NEW_LINE_CHARACTER, kind=ip) - 2)
         end if
      end if
      call find_item(random, text, first, last)
      call replace_place(text, first, first + verify(text(first:last)//'x', ' ') - 2, owner//'.')
   end subroutine prefix_item

   !> Further instances, named by what they are copies of and a number, sometimes the same one.
   subroutine copy_instances(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: block, copies
      integer(ip) :: first, last, i, k, n
      logical :: many

      call find_word(random, text, '*INSTANCE', first)
      if (first == 0) return
      k = index(upper(text(first:)), '*END INSTANCE', kind=ip)
      if (k == 0) return
      last = first + k - 1 + scan(text(first + k:)//NEW_LINE_CHARACTER, NEW_LINE_CHARACTER, kind=ip)
      block = text(first:min(last, len(text, kind=ip)))
      k = scan(block, '=')
      call random_chance(random, 8_ip, many)
      n = 1
      if (many) call random_integer(random, 1_ip, MOST_INSTANCES, n)
      copies = ''
      do i = 1, n
         copies = copies//block(:k)//to_text(i)//block(k + 1:)
      end do
      call replace_place(text, first, first - 1, copies)
   end subroutine copy_instances

   !> Some cards become a part, and an instance of it stands behind them or elsewhere.
   subroutine make_part(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=*), parameter :: INSTANCE = '*INSTANCE, NAME=I0, PART=P0'//NEW_LINE_CHARACTER//'0., -5.'// &
                                     NEW_LINE_CHARACTER//'*END INSTANCE'//NEW_LINE_CHARACTER
      integer(ip) :: i, first, last, ends(2)
      logical :: elsewhere

      do i = 1, 2
         call find_card(random, text, first, last)
         ends(i) = first
      end do
      call random_chance(random, 3_ip, elsewhere)
      if (elsewhere) call insert_at_line(random, INSTANCE, text)
      first = min(minval(ends), len(text, kind=ip) + 1)
      last = min(maxval(ends), len(text, kind=ip) + 1)
      if (elsewhere) then
         call replace_place(text, last, last - 1, '*END PART'//NEW_LINE_CHARACTER)
      else
         call replace_place(text, last, last - 1, '*END PART'//NEW_LINE_CHARACTER//INSTANCE)
      end if
      call replace_place(text, first, first - 1, '*PART, NAME=P0'//NEW_LINE_CHARACTER)
   end subroutine make_part

   !> The end of a block goes elsewhere, or away.
   subroutine move_end(random, text)
      type(random_t), intent(inout) :: random
      character(len=:), allocatable, intent(inout) :: text
      character(len=:), allocatable :: line
      integer(ip) :: first, last
      logical :: away

      call find_word(random, text, '*END ', first)
      if (first == 0) return
      last = min(first + scan(text(first:)//NEW_LINE_CHARACTER, NEW_LINE_CHARACTER, kind=ip) - 1, len(text, kind=ip))
      line = text(first:last)
      call replace_place(text, first, last, '')
      call random_chance(random, 3_ip, away)
      if (.not. away) call insert_at_line(random, line, text)
   end subroutine move_end

   !> Where a keyword begins: its first place behind one chosen at random, else the first of all; 0: there is none.
   subroutine find_word(random, text, word, place)
      type(random_t), intent(inout) :: random
      character(len=*), intent(in) :: text, word
      integer(ip), intent(out) :: place
      character(len=:), allocatable :: capitals
      integer(ip) :: start

      capitals = upper(text)
      call random_integer(random, 1_ip, len(text, kind=ip), start)
      place = index(capitals(start:), word, kind=ip)
      if (place > 0) then
         place = place + start - 1
      else
         place = index(capitals, word, kind=ip)
      end if
   end subroutine find_word

   pure function upper(text)
      character(len=*), intent(in) :: text
      character(len=len(text)) :: upper
      integer :: i

      do i = 1, len(text)
         upper(i:i) = text(i:i)
         if (text(i:i) >= 'a' .and. text(i:i) <= 'z') upper(i:i) = achar(iachar(text(i:i)) - 32)
      end do
   end function upper

end module fuzz_structures
