!> Small string tools: case, numbers to text, nearest names, lists of strings.
module atrito_strings
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: string_t, string_list_t, add_string, take_strings, replaced, recoded
   public :: break_line, trimmed_strings, split_words
   public :: lower_case, upper_case, to_text, join, nearest_names, edit_distance, same_name, append_string, deck_name, count_symbol
   public :: begins_with, ends_with, fits_pattern

   !> A string of its own length, for lists of strings.
   type :: string_t
      character(len=:), allocatable :: s !< not allocated: nothing has been set
   end type string_t

   !> Strings that come one after the other, for lists that may become long.
   type :: string_list_t
      integer(ip) :: n = 0                                 !< strings in the list
      type(string_t), allocatable, private :: strings(:)   !< those up to n are in use
   end type string_list_t

   !> Nothing is near a longer name: it is no name.
   integer, parameter :: LONGEST_NAME = 200

   !> Number to text, without blanks.
   interface to_text
      module procedure integer_to_text, long_to_text, real_to_text
   end interface to_text

contains

   !> A text of the same length with the letters A to Z made small; other bytes stay as they are.
   pure function lower_case(text) result(lower)
      character(len=*), intent(in) :: text !< any bytes
      character(len=len(text)) :: lower
      integer :: i

      lower = text
      do i = 1, len(text)
         if (text(i:i) >= 'A' .and. text(i:i) <= 'Z') lower(i:i) = achar(iachar(text(i:i)) + 32)
      end do
   end function lower_case

   !> A text of the same length with the letters a to z made capitals; other bytes stay as they are.
   pure function upper_case(text) result(upper)
      character(len=*), intent(in) :: text !< any bytes
      character(len=len(text)) :: upper
      integer :: i

      upper = text
      do i = 1, len(text)
         if (text(i:i) >= 'a' .and. text(i:i) <= 'z') upper(i:i) = achar(iachar(text(i:i)) - 32)
      end do
   end function upper_case

   !> How often a symbol stands in a text; quick for long ones.
   pure integer(lp) function count_symbol(text, symbol) result(n)
      character(len=*), intent(in) :: text   !< any bytes
      character(len=1), intent(in) :: symbol !< one byte
      integer, parameter :: PIECE = 4096
      integer :: first, i, found

      n = 0_lp
      do first = 1, len(text), PIECE
         found = 0
         do i = first, min(len(text), first + PIECE - 1)   ! without an exit: the compiler takes many symbols at a time
            found = found + merge(1, 0, text(i:i) == symbol)
         end do
         n = n + int(found, lp)
      end do
   end function count_symbol

   !> Names are without case.
   pure logical function same_name(a, b)
      character(len=*), intent(in) :: a, b !< blanks at their ends do not count

      integer :: i, n

      n = len_trim(a)
      same_name = n == len_trim(b)
      if (.not. same_name) return
      do i = 1, n
         if (a(i:i) == b(i:i)) cycle                  ! most names differ early: no copies of them are made
         same_name = lower_case(a(i:i)) == lower_case(b(i:i))
         if (.not. same_name) return
      end do
   end function same_name

   pure function integer_to_text(i) result(text)
      integer(ip), intent(in) :: i !< any integer
      character(len=:), allocatable :: text

      text = long_to_text(int(i, lp))
   end function integer_to_text

   !> By digits: a formatted write takes thirty times as long, and a listing is full of numbers.
   pure function long_to_text(i) result(text)
      integer(lp), intent(in) :: i !< any integer
      character(len=:), allocatable :: text
      character(len=24) :: buffer
      integer(lp) :: rest
      integer :: first

      rest = i                                      ! not positive: the least integer has no opposite
      if (i > 0) rest = -i
      first = len(buffer)
      buffer(first:first) = achar(iachar('0') - int(mod(rest, 10_lp)))
      do while (rest <= -10_lp)
         rest = rest/10_lp
         first = first - 1
         buffer(first:first) = achar(iachar('0') - int(mod(rest, 10_lp)))
      end do
      if (i < 0) first = first - 1
      if (i < 0) buffer(first:first) = '-'
      text = buffer(first:)
   end function long_to_text

   !> Real to text for messages: shortest of fixed and exponent form with `digits` significant digits (default 6).
   pure function real_to_text(x, digits) result(text)
      real(wp), intent(in) :: x               !< finite
      integer, intent(in), optional :: digits !< significant ones, 1 .. 17
      character(len=:), allocatable :: text
      character(len=40) :: buffer
      integer :: d, e

      d = 6
      if (present(digits)) d = digits
      if (x == 0.0_wp) then
         text = '0'
         return
      end if
      if (abs(x) >= 1.0e-3_wp .and. abs(x) < 10.0_wp**min(d, 15)) then
         e = floor(log10(abs(x))) + 1
         write (buffer, '(f0.'//integer_to_text(int(max(d - e, 0), ip))//')') x
         text = without_trailing_zeros(trim(buffer))
      else
         write (buffer, '(es32.'//integer_to_text(int(d - 1, ip))//'e3)') x
         text = short_exponent(trim(adjustl(buffer)))
      end if
      if (text(1:1) == '.') text = '0'//text
      if (len(text) > 1) then
         if (text(1:2) == '-.') text = '-0'//text(2:)
      end if
   end function real_to_text

   pure function without_trailing_zeros(text) result(short)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: short
      integer :: last

      last = len(text)
      if (index(text, '.') > 0) then
         do while (text(last:last) == '0')
            last = last - 1
         end do
         if (text(last:last) == '.') last = last - 1
      end if
      short = text(:last)
   end function without_trailing_zeros

   !> 1.50000E-007 becomes 1.5e-7.
   pure function short_exponent(text) result(short)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: short
      integer :: e, first

      e = index(text, 'E')
      if (e == 0) then
         short = text
         return
      end if
      first = e + 2
      do while (first < len(text) .and. text(first:first) == '0')
         first = first + 1
      end do
      short = without_trailing_zeros(text(:e - 1))//'e'
      if (text(e + 1:e + 1) == '-') short = short//'-'
      short = short//text(first:)
   end function short_exponent

   !> The strings of a list with a separator between them.
   pure function join(list, separator) result(text)
      type(string_t), intent(in) :: list(:)     !< all of them allocated
      character(len=*), intent(in) :: separator !< may be empty
      character(len=:), allocatable :: text
      integer :: i, n

      n = len(separator)*max(0, size(list) - 1)
      do i = 1, size(list)
         n = n + len(list(i)%s)
      end do
      allocate (character(len=n) :: text)
      n = 0
      do i = 1, size(list)
         if (i > 1) text(n + 1:n + len(separator)) = separator
         if (i > 1) n = n + len(separator)
         text(n + 1:n + len(list(i)%s)) = list(i)%s
         n = n + len(list(i)%s)
      end do
   end function join

   !> Words of a table as strings, without the blanks at their ends.
   pure function trimmed_strings(words) result(list)
      character(len=*), intent(in) :: words(:) !< of one length, filled up with blanks
      type(string_t) :: list(size(words))
      integer :: i

      do i = 1, size(words)
         list(i)%s = trim(words(i))
      end do
   end function trimmed_strings

   !> Adds a text at the end of a list; a list that is not allocated counts as an empty one. The texts before it are moved, not
   !> copied: n of them take n such steps, so long lists are made by add_string.
   pure subroutine append_string(list, text)
      type(string_t), allocatable, intent(inout) :: list(:) !< becomes longer by one
      character(len=*), intent(in) :: text                  !< is copied
      type(string_t), allocatable :: longer(:)
      integer :: i, n

      n = 0
      if (allocated(list)) n = size(list)
      allocate (longer(n + 1))
      do i = 1, n
         call move_alloc(list(i)%s, longer(i)%s)
      end do
      longer(n + 1)%s = text
      call move_alloc(longer, list)
   end subroutine append_string

   !> Appends a string; where there is no room, it doubles, and the strings are handed on without a copy.
   pure subroutine add_string(list, text)
      type(string_list_t), intent(inout) :: list !< gets one string more
      character(len=*), intent(in) :: text       !< is copied

      if (.not. allocated(list%strings)) allocate (list%strings(16))
      if (list%n == size(list%strings)) call move_strings(list, 2*list%n)
      list%n = list%n + 1
      list%strings(list%n)%s = text
   end subroutine add_string

   !> Gives the strings away; what is left is an empty list.
   pure subroutine take_strings(list, strings)
      type(string_list_t), intent(inout) :: list             !< is empty afterwards
      type(string_t), allocatable, intent(out) :: strings(:) !< (n) in the order in which they came

      call move_strings(list, list%n)
      call move_alloc(list%strings, strings)
      list%n = 0
   end subroutine take_strings

   pure subroutine move_strings(list, length)
      type(string_list_t), intent(inout) :: list
      integer(ip), intent(in) :: length
      type(string_t), allocatable :: moved(:)
      integer(ip) :: i

      allocate (moved(length))
      do i = 1, list%n
         call move_alloc(list%strings(i)%s, moved(i)%s)
      end do
      call move_alloc(moved, list%strings)
   end subroutine move_strings

   !> Least number of single-character changes (insert, delete, replace, swap of neighbours) from a to b, without case.
   pure integer function edit_distance(a, b) result(distance)
      character(len=*), intent(in) :: a, b !< in either case
      integer :: d(0:len(a), 0:len(b))
      character(len=len(a)) :: x
      character(len=len(b)) :: y
      integer :: i, j, cost

      x = lower_case(a)
      y = lower_case(b)
      d(:, 0) = [(i, i=0, len(a))]
      d(0, :) = [(j, j=0, len(b))]
      do j = 1, len(b)
         do i = 1, len(a)
            cost = merge(0, 1, x(i:i) == y(j:j))
            d(i, j) = min(d(i - 1, j) + 1, d(i, j - 1) + 1, d(i - 1, j - 1) + cost)
            if (swapped(x(:i), y(:j))) d(i, j) = min(d(i, j), d(max(i - 2, 0), max(j - 2, 0)) + 1)
         end do
      end do
      distance = d(len(a), len(b))
   end function edit_distance

   !> The last two letters of a are those of b the other way round.
   pure logical function swapped(a, b)
      character(len=*), intent(in) :: a, b
      integer :: m, n

      m = len(a)
      n = len(b)
      swapped = m > 1 .and. n > 1
      if (swapped) swapped = a(m:m) == b(n - 1:n - 1) .and. a(m - 1:m - 1) == b(n:n)
   end function swapped

   !> Up to `most` names of `known` that are near `name`, nearest first: a third of its letters wrong at most, or one name begins
   !> the other.
   pure function nearest_names(name, known, most) result(near)
      character(len=*), intent(in) :: name   !< as the user wrote it
      type(string_t), intent(in) :: known(:) !< valid names
      integer, intent(in) :: most            !< the longest list wanted
      type(string_t), allocatable :: near(:)
      integer :: distance(size(known)), allowed, i, best

      allocate (near(0))
      allowed = max(1, len(name)/3)
      distance = huge(1)
      if (len(name) > LONGEST_NAME) return
      do i = 1, size(known)
         if (differing_letters(name, known(i)%s) <= allowed) distance(i) = edit_distance(name, known(i)%s)
         if (is_prefix(name, known(i)%s) .or. is_prefix(known(i)%s, name)) distance(i) = min(distance(i), 1)
         if (distance(i) > allowed) distance(i) = huge(1)
      end do
      do while (size(near) < most .and. size(near) < size(known))
         best = minloc(distance, dim=1)
         if (distance(best) == huge(1)) exit
         call append_string(near, known(best)%s)
         distance(best) = huge(1)
      end do
   end function nearest_names

   !> A lower bound of the edit distance, soon found: letters that the longer of two names has and the other one has not.
   pure integer function differing_letters(a, b) result(n)
      character(len=*), intent(in) :: a, b
      integer :: excess(0:31), i               ! of letters, whose last bits are the same in both cases

      n = abs(len(a) - len(b))
      if (n > len(a)/3 + 1) return
      excess = 0
      do i = 1, len(a)
         excess(iand(iachar(a(i:i)), 31)) = excess(iand(iachar(a(i:i)), 31)) + 1
      end do
      do i = 1, len(b)
         excess(iand(iachar(b(i:i)), 31)) = excess(iand(iachar(b(i:i)), 31)) - 1
      end do
      n = max(sum(max(excess, 0)), sum(max(-excess, 0)))
   end function differing_letters

   pure logical function is_prefix(a, b)
      character(len=*), intent(in) :: a, b

      is_prefix = len(a) >= 3 .and. len(a) <= len(b)
      if (is_prefix) is_prefix = lower_case(a) == lower_case(b(:len(a)))
   end function is_prefix

   !> Whether a text begins with another one, letter by letter.
   pure logical function begins_with(text, beginning)
      character(len=*), intent(in) :: text, beginning !< to look into; what it may begin with

      begins_with = .false.
      if (len(text) >= len(beginning)) begins_with = text(:len(beginning)) == beginning
   end function begins_with

   !> Whether a text has something before this ending.
   pure logical function ends_with(text, ending)
      character(len=*), intent(in) :: text, ending !< to look into; what it may end with

      ends_with = .false.
      if (len(text) > len(ending)) ends_with = text(len(text) - len(ending) + 1:) == ending
   end function ends_with

   !> Whether a text is a pattern in which each * stands for any letters, or none; without case. A * takes as few letters as it can,
   !> and more where what follows does not fit: the last * alone can be wrong, since what stood before it fits in any case.
   pure logical function fits_pattern(text, pattern) result(fits)
      character(len=*), intent(in) :: text, pattern !< to look into; with any number of *
      integer :: i, k, star, taken                      ! places in both; the last *, and where what it has not taken begins

      i = 1
      k = 1
      star = 0
      taken = 1
      fits = .false.
      do while (i <= len(text))
         if (k <= len(pattern)) then
            if (pattern(k:k) == '*') then
               star = k
               taken = i
               k = k + 1
               cycle
            else if (same_name(pattern(k:k), text(i:i))) then
               i = i + 1
               k = k + 1
               cycle
            end if
         end if
         if (star == 0) return
         taken = taken + 1
         i = taken
         k = star + 1
      end do
      fits = verify(pattern(min(k, len(pattern) + 1):), '*') == 0
   end function fits_pattern

   !> Name of a deck: its path without folder and .inp.
   pure function deck_name(path) result(name)
      character(len=*), intent(in) :: path !< with folders or without
      character(len=:), allocatable :: name

      name = path(index(path, '/', back=.true.) + 1:)
      if (ends_with(lower_case(name), '.inp')) name = name(:len(name) - len('.inp'))
   end function deck_name

   !> The words of a text.
   pure subroutine split_words(text, between, words)
      character(len=*), intent(in) :: text, between         !< characters of the latter stand between words, and round them
      type(string_t), allocatable, intent(out) :: words(:)  !< none is empty
      integer :: first, last

      allocate (words(0))
      last = 0
      do
         first = verify(text(last + 1:), between)
         if (first == 0) return
         first = last + first
         last = first + scan(text(first:)//between, between) - 2
         call append_string(words, text(first:last))
      end do
   end subroutine split_words

   !> A text of the same length with one letter in the place of each of some.
   pure function replaced(text, letters, by)
      character(len=*), intent(in) :: text, letters !< to look into; each of them is replaced
      character(len=1), intent(in) :: by            !< in the place of each
      character(len=len(text)) :: replaced
      integer :: i

      replaced = text
      do i = 1, len(text)
         if (index(letters, text(i:i)) > 0) replaced(i:i) = by
      end do
   end function replaced

   !> A text in which each of some letters stands as another format writes it.
   pure function recoded(text, letters, codes)
      character(len=*), intent(in) :: text, letters !< to look into; each of them is replaced
      character(len=*), intent(in) :: codes(:)      !< (len(letters)), without the blanks behind them
      character(len=:), allocatable :: recoded
      integer :: i, k

      recoded = ''
      do i = 1, len(text)
         k = index(letters, text(i:i))
         if (k > 0) recoded = recoded//trim(codes(k))
         if (k == 0) recoded = recoded//text(i:i)
      end do
   end function recoded

   !> One line of a text that is broken at its blanks: text(first:last), no longer than `room`; the next one begins at `next`.
   pure subroutine break_line(text, room, first, last, next)
      character(len=*), intent(in) :: text          !< without blanks at its end
      integer, intent(in) :: room                   !< > 0
      integer, intent(in) :: first                  !< place where the line begins
      integer, intent(out) :: last, next            !< next > len(text): that was the last line
      integer :: blank

      last = len(text)
      if (last - first + 1 > room) then             ! before the last blank, else at the full width
         blank = index(text(first:first + room), ' ', back=.true.)
         last = first + room - 1
         if (blank > 1) last = first + blank - 2
      end if
      next = last + 1
      do while (next < len(text))
         if (text(next:next) /= ' ') exit
         next = next + 1
      end do
   end subroutine break_line

end module atrito_strings
