!> Letters of several bytes (RFC 3629): the text of a deck may be anything, what is written for others is UTF-8.
module atrito_utf8
   use, intrinsic :: iso_c_binding, only: c_size_t
   use atrito_system, only: c_is_plain
   implicit none (type, external)
   private
   public :: utf8_length, has_controls, visible, disturbs

contains

   !> Bytes of the character of UTF-8 with which a text begins; 0: it begins with none. Neither longer forms than needed, nor
   !> surrogates, nor codes beyond 10FFFF are UTF-8 (RFC 3629).
   pure integer function utf8_length(text) result(n)
      character(len=*), intent(in) :: text             !< not empty
      integer :: first, second, i

      first = ichar(text(1:1))
      n = 0
      if (first < 128) n = 1
      if (first >= 194 .and. first < 224) n = 2
      if (first >= 224 .and. first < 240) n = 3
      if (first >= 240 .and. first < 245) n = 4
      if (n > len(text)) n = 0
      do i = 2, n
         if (iand(ichar(text(i:i)), 192) /= 128) n = 0
         if (n == 0) return
      end do
      if (n < 3) return
      second = ichar(text(2:2))
      if ((first == 224 .and. second < 160) .or. (first == 237 .and. second >= 160) .or. &
          (first == 240 .and. second < 144) .or. (first == 244 .and. second >= 144)) n = 0
   end function utf8_length

   !> Whether a text has characters that disturb (visible), but for tabs and ends of lines.
   pure logical function has_controls(text)
      character(len=*), intent(in) :: text !< any bytes
      character(len=len(text)) :: plain
      integer :: i

      plain = text
      do i = 1, len(text)
         if (any(text(i:i) == [achar(9), achar(10), achar(13)])) plain(i:i) = ' '
      end do
      has_controls = visible(plain) /= plain
   end function has_controls

   !> Blanks for tabs, and ? for each byte of what disturbs a terminal or lies about the order of letters: control characters, those
   !> of one byte and of two (C1), and marks that turn the direction. The names of files and what a deck says are the user's.
   pure function visible(source) result(text)
      character(len=*), intent(in) :: source !< any bytes
      character(len=len(source)) :: text
      integer :: i, n

      text = source
      if (c_is_plain(source, len(source, kind=c_size_t)) == 1) return
      i = 0
      do while (i < len(source))
         i = i + 1
         if (ichar(source(i:i)) >= 32 .and. ichar(source(i:i)) < 127) cycle
         n = utf8_length(source(i:min(i + 3, len(source))))
         if (source(i:i) == achar(9)) then
            text(i:i) = ' '
         else if (n == 0) then
            if (ichar(source(i:i)) < 160) text(i:i) = '?'   ! a letter of Latin-1 stays
         else if (disturbs(source(i:i + n - 1))) then
            text(i:i + n - 1) = repeat('?', n)
         end if
         i = i + max(n, 1) - 1
      end do
   end function visible

   !> Whether a character is one of those.
   pure logical function disturbs(symbol)
      character(len=*), intent(in) :: symbol           !< a character of UTF-8
      integer :: first, second, third

      first = ichar(symbol(1:1))
      second = ichar(symbol(min(2, len(symbol)):min(2, len(symbol))))
      third = ichar(symbol(len(symbol):))
      disturbs = .false.
      select case (len(symbol))
      case (1)
         disturbs = first < 32 .or. first == 127
      case (2)
         disturbs = first == 194 .and. second < 160                             ! U+0080 to U+009F
         disturbs = disturbs .or. (first == 216 .and. second == 156)            ! U+061C
      case (3)
         if (first == 226 .and. second == 128) then                             ! U+200E, U+200F, U+2028 to U+202E
            disturbs = third == 142 .or. third == 143 .or. (third >= 168 .and. third <= 174)
         else if (first == 226 .and. second == 129) then                        ! U+2066 to U+2069
            disturbs = third >= 166 .and. third <= 169
         end if
      end select
   end function disturbs

end module atrito_utf8
