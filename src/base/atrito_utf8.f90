!> Letters of several bytes (RFC 3629): the text of a deck may be anything, what is written for others is UTF-8.
module atrito_utf8
   implicit none (type, external)
   private
   public :: utf8_length, has_controls

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

   !> Whether a text has characters that may tell a terminal something: those below the blank but tabs and ends of lines, DEL, and
   !> those of two bytes, U+0080 to U+009F.
   pure logical function has_controls(text)
      character(len=*), intent(in) :: text
      integer :: i, code, before

      has_controls = .false.
      before = 0
      do i = 1, len(text)
         code = ichar(text(i:i))
         has_controls = has_controls .or. (code < 32 .and. (code < 9 .or. code > 10) .and. code /= 13) .or. code == 127 &
                        .or. (before == 194 .and. code >= 128 .and. code < 160)
         before = code
      end do
   end function has_controls

end module atrito_utf8
