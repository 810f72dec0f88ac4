!> Lines and items of a text: only places, no copies.
module atrito_lexer
   use atrito_kinds, only: ip, lp
   implicit none (type, external)
   private
   public :: line_t, items_t, take_line, split_items, trim_place, find_equals, count_data_lines
   public :: LINE_BLANK, LINE_COMMENT, LINE_KEYWORD, LINE_DATA

   integer, parameter :: LINE_BLANK = 0, LINE_COMMENT = 1, LINE_KEYWORD = 2, LINE_DATA = 3

   !> A line of the text, without its end.
   type :: line_t
      integer(ip) :: start = 1         !< its first character
      integer(ip) :: first = 1         !< its first and last character that are not blank
      integer(ip) :: last = 0          !< first - 1 of a blank line
      integer :: kind = LINE_BLANK     !< LINE_*
      integer(ip) :: control = 0       !< its first control character; 0: none
   end type line_t

   !> Places of the items of a line; an empty item has last = first - 1.
   type :: items_t
      integer(ip) :: n = 0                          !< items in use
      integer(ip), allocatable :: first(:), last(:) !< (n) or more: characters of the text
      integer(ip) :: bad_quote = 0                  !< quote without partner, or with letters beside it; 0: none
   end type items_t

   integer, parameter :: TAB = 9, LINE_FEED = 10, CARRIAGE_RETURN = 13, DELETE = 127

contains

   !> The line that begins at `position`, which moves to the next one. Ends of line are LF, CR LF, and the end of the text.
   pure subroutine take_line(text, position, line)
      character(len=*), intent(in) :: text   !< a whole file
      integer(ip), intent(inout) :: position !< first character of the line; then of the next one
      type(line_t), intent(out) :: line      !< its places count from the beginning of the text
      integer(ip) :: i
      integer :: code

      line%start = position
      do i = position, len(text)
         code = ichar(text(i:i))
         if (code >= 32 .and. code /= DELETE) cycle
         if (code == LINE_FEED) exit
         if (code /= TAB .and. line%control == 0) line%control = i
      end do
      position = i + 1
      line%last = i - 1
      if (line%last >= line%start) then
         if (ichar(text(line%last:line%last)) == CARRIAGE_RETURN) then
            if (line%control == line%last) line%control = 0
            line%last = line%last - 1
         end if
      end if
      line%first = line%start
      call trim_place(text, line%first, line%last)
      if (line%last < line%first) then
         line%kind = LINE_BLANK
      else if (text(line%first:line%first) /= '*') then
         line%kind = LINE_DATA
      else
         line%kind = LINE_KEYWORD
         if (line%last > line%first) then
            if (text(line%first + 1:line%first + 1) == '*') line%kind = LINE_COMMENT
         end if
      end if
   end subroutine take_line

   !> How many lines of a text are neither blank nor begin with a star.
   pure integer(lp) function count_data_lines(text) result(n)
      character(len=*), intent(in) :: text !< a whole file
      integer :: i, code
      logical :: is_begun                          ! the line has something, or begins with a star

      n = 0_lp
      is_begun = .false.
      do i = 1, len(text)
         code = ichar(text(i:i))
         if (code == LINE_FEED) then
            is_begun = .false.
         else if (.not. is_begun .and. code > 32) then
            is_begun = .true.
            if (text(i:i) /= '*') n = n + 1_lp
         end if
      end do
   end function count_data_lines

   !> Moves the ends of a place inwards over blanks and tabs. Of a blank place, last = first - 1.
   pure subroutine trim_place(text, first, last)
      character(len=*), intent(in) :: text      !< the place is in it
      integer(ip), intent(inout) :: first, last !< characters; last = first - 1 where all is blank

      do while (last >= first)
         if (.not. is_blank(text(last:last))) exit
         last = last - 1
      end do
      do while (first <= last)
         if (.not. is_blank(text(first:first))) exit
         first = first + 1
      end do
   end subroutine trim_place

   pure logical function is_blank(symbol)
      character(len=1), intent(in) :: symbol

      is_blank = symbol == ' ' .or. ichar(symbol) == TAB
   end function is_blank

   !> The items between the commas of text(first:last), commas in quotes and in <...> apart. One comma at the end of the line is
   !> free.
   pure subroutine split_items(text, first, last, items)
      character(len=*), intent(in) :: text       !< the line is in it
      integer(ip), intent(in) :: first, last     !< its characters
      type(items_t), intent(inout) :: items      !< its arrays are kept and grow
      integer(ip) :: i, start, quote, closing          ! closing: end of the last <...>

      items%n = 0
      items%bad_quote = 0
      if (.not. allocated(items%first)) allocate (items%first(64), items%last(64))
      start = first
      quote = 0
      closing = 0
      do i = first, last
         if (text(i:i) == '"') then
            if (.not. is_beside(text, first, last, i, opening=quote == 0)) items%bad_quote = i
            quote = merge(0_ip, i, quote > 0)
         else if (text(i:i) == ',' .and. quote == 0) then
            if (i < closing) cycle
            call add_place(text, start, i - 1, items)
            start = i + 1
         else if (text(i:i) == '<' .and. quote == 0) then
            closing = closing_bracket(text, i, last)
         end if
      end do
      if (quote > 0) items%bad_quote = quote
      ! what follows the comma at the end of the line is no item
      if (start <= last .or. items%n == 0) call add_place(text, start, last, items)
   end subroutine split_items

   !> Place of the `>` that closes a `<`, before any other `<`; 0 when there is none: then it is no bracket.
   pure integer(ip) function closing_bracket(text, opening, last) result(place)
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: opening, last

      do place = opening + 1, last
         if (text(place:place) == '>') return
         if (text(place:place) == '<' .or. text(place:place) == '"') exit
      end do
      place = 0
   end function closing_bracket

   !> A quote opens at the beginning of an item or value, and closes at its end. Beside a dot it is one of two names, "a b".c.
   pure logical function is_beside(text, first, last, quote, opening)
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: first, last, quote
      logical, intent(in) :: opening
      integer(ip) :: i, step

      is_beside = .true.
      step = merge(-1, 1, opening)
      i = quote + step
      do while (i >= first .and. i <= last)
         if (.not. is_blank(text(i:i))) then
            is_beside = text(i:i) == ',' .or. (opening .and. text(i:i) == '=') .or. (text(i:i) == '.' .and. i == quote + step)
            return
         end if
         i = i + step
      end do
   end function is_beside

   pure subroutine add_place(text, first, last, items)
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: first, last
      type(items_t), intent(inout) :: items
      integer(ip) :: a, b

      a = first
      b = last
      call trim_place(text, a, b)
      if (items%n == size(items%first)) then
         items%first = [items%first, items%first]
         items%last = [items%last, items%last]
      end if
      items%n = items%n + 1
      items%first(items%n) = a
      items%last(items%n) = b
   end subroutine add_place

   !> Place of the first equals sign outside quotes in text(first:last), 0 when there is none.
   pure integer(ip) function find_equals(text, first, last) result(place)
      character(len=*), intent(in) :: text   !< the item is in it
      integer(ip), intent(in) :: first, last !< its characters
      logical :: quoted

      quoted = .false.
      do place = first, last
         if (text(place:place) == '"') quoted = .not. quoted
         if (text(place:place) == '=' .and. .not. quoted) return
      end do
      place = 0
   end function find_equals

end module atrito_lexer
