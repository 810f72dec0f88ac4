!> Bytes as text of 64 letters (RFC 4648, section 4), for pictures within a page of HTML.
module atrito_base64
   implicit none (type, external)
   private
   public :: base64_text, base64_length

   character(len=*), parameter :: LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/'
   character(len=1), parameter :: FILLER = '='

contains

   !> Letters that so many bytes need.
   pure integer function base64_length(n_bytes) result(n)
      integer, intent(in) :: n_bytes !< >= 0

      n = 4*((n_bytes + 2)/3)
   end function base64_length

   !> Three bytes in four letters; what the last three lack is filled.
   pure function base64_text(bytes) result(text)
      character(len=*), intent(in) :: bytes         !< any bytes, one a character
      character(len=:), allocatable :: text
      integer :: i, k, word, there

      allocate (character(len=base64_length(len(bytes))) :: text)
      k = 0
      do i = 1, len(bytes), 3
         there = min(3, len(bytes) - i + 1)
         word = 65536*ichar(bytes(i:i))
         if (there > 1) word = word + 256*ichar(bytes(i + 1:i + 1))
         if (there > 2) word = word + ichar(bytes(i + 2:i + 2))
         text(k + 1:k + 4) = letter(word/262144)//letter(word/4096)//letter(word/64)//letter(word)
         if (there < 3) text(k + there + 2:k + 4) = repeat(FILLER, 3 - there)
         k = k + 4
      end do
   end function base64_text

   !> The letter of the last six bits.
   pure character(len=1) function letter(word)
      integer, intent(in) :: word
      integer :: i

      i = iand(word, 63) + 1
      letter = LETTERS(i:i)
   end function letter

end module atrito_base64
