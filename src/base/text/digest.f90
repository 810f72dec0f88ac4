!> A digest of data: a number of 62 bits that is another one, but for a chance of about 2**-62, where a value, its kind of zero or
!> the order of the values differs.
!>
!> Two polynomials in the values, modulo the prime 2**31 - 1, at two places: whole numbers that never overflow.
module atrito_digest
   use atrito_kinds, only: ip, lp, wp
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: digest_t, add_to, add_allocated, digest_text
   public :: text_digest_t, add_characters, hexadecimal

   integer(lp), parameter :: PRIME = 2147483647_lp
   integer(lp), parameter :: PLACE(2) = [1103515245_lp, 805306457_lp]

   type :: digest_t
      integer(lp) :: value(2) = [1_lp, 1_lp] !< the two polynomials so far, 0 .. PRIME - 1
   end type digest_t

   !> That of a text which comes in parts: how it is cut does not matter. Four characters are a word.
   type, extends(digest_t) :: text_digest_t
      integer(lp), private :: word = 0_lp          !< the characters of the last one that is not full
      integer, private :: n = 0                    !< how many they are, 0..3
      integer(lp), private :: length = 0_lp        !< of the text so far
   end type text_digest_t

   integer, parameter :: WORD_LENGTH = 4
   integer(lp), parameter :: BYTE = 256_lp
   integer, parameter :: PRIME_BITS = 31

   !> Takes a value, or a list with its length, into a digest.
   interface add_to
      module procedure add_real, add_reals, add_columns, add_integer, add_integers, add_table, add_logical, add_logicals, add_text
   end interface add_to

   !> Takes what may not be allocated, which is another thing than what is empty.
   interface add_allocated
      module procedure add_allocated_reals, add_allocated_columns, add_allocated_integers, add_allocated_logicals, &
         add_allocated_text
   end interface add_allocated

contains

   !> Numbers below 2**33, so that the products stay below 2**63.
   pure subroutine add_word(digest, word)
      type(digest_t), intent(inout) :: digest
      integer(lp), intent(in) :: word              !< 0..2**32

      digest%value = modulo(digest%value*PLACE + word, PRIME)
   end subroutine add_word

   pure subroutine add_real(digest, value)
      type(digest_t), intent(inout) :: digest !< gets the value
      real(wp), intent(in) :: value           !< by its bits: -0 is not 0
      integer(lp) :: bits

      bits = transfer(value, bits)
      call add_word(digest, ibits(bits, 0, 32))
      call add_word(digest, ibits(bits, 32, 32))
   end subroutine add_real

   pure subroutine add_integer(digest, value)
      type(digest_t), intent(inout) :: digest !< gets the value
      integer(ip), intent(in) :: value        !< by its bits

      call add_word(digest, ibits(int(value, lp), 0, 32))
   end subroutine add_integer

   pure subroutine add_logical(digest, value)
      type(digest_t), intent(inout) :: digest !< gets the value
      logical, intent(in) :: value            !< 1 or 0

      call add_word(digest, merge(1_lp, 0_lp, value))
   end subroutine add_logical

   pure subroutine add_text(digest, text)
      type(digest_t), intent(inout) :: digest !< gets length and letters
      character(len=*), intent(in) :: text    !< of any bytes
      integer :: i

      call add_integer(digest, len(text, kind=ip))
      do i = 1, len(text)
         call add_word(digest, int(iachar(text(i:i)), lp))
      end do
   end subroutine add_text

   pure subroutine add_reals(digest, values)
      type(digest_t), intent(inout) :: digest !< gets length and values
      real(wp), intent(in) :: values(:)       !< (n)
      integer :: i

      call add_integer(digest, size(values, kind=ip))
      do i = 1, size(values)
         call add_real(digest, values(i))
      end do
   end subroutine add_reals

   pure subroutine add_columns(digest, values)
      type(digest_t), intent(inout) :: digest !< gets length and columns
      real(wp), intent(in) :: values(:, :)    !< (rows, n) each column with its length
      integer :: i

      call add_integer(digest, size(values, 2, kind=ip))
      do i = 1, size(values, 2)
         call add_reals(digest, values(:, i))
      end do
   end subroutine add_columns

   pure subroutine add_integers(digest, values)
      type(digest_t), intent(inout) :: digest !< gets length and values
      integer(ip), intent(in) :: values(:)    !< (n)
      integer :: i

      call add_integer(digest, size(values, kind=ip))
      do i = 1, size(values)
         call add_integer(digest, values(i))
      end do
   end subroutine add_integers

   pure subroutine add_table(digest, values)
      type(digest_t), intent(inout) :: digest !< gets length and columns
      integer(ip), intent(in) :: values(:, :) !< (rows, n) each column with its length
      integer :: i

      call add_integer(digest, size(values, 2, kind=ip))
      do i = 1, size(values, 2)
         call add_integers(digest, values(:, i))
      end do
   end subroutine add_table

   pure subroutine add_logicals(digest, values)
      type(digest_t), intent(inout) :: digest !< gets length and values
      logical, intent(in) :: values(:)        !< (n)
      integer :: i

      call add_integer(digest, size(values, kind=ip))
      do i = 1, size(values)
         call add_logical(digest, values(i))
      end do
   end subroutine add_logicals

   pure subroutine add_allocated_reals(digest, values)
      type(digest_t), intent(inout) :: digest        !< gets whether it is allocated, and the values
      real(wp), allocatable, intent(in) :: values(:) !< (n), or not allocated

      call add_logical(digest, allocated(values))
      if (allocated(values)) call add_reals(digest, values)
   end subroutine add_allocated_reals

   pure subroutine add_allocated_columns(digest, values)
      type(digest_t), intent(inout) :: digest           !< gets whether it is allocated, and the columns
      real(wp), allocatable, intent(in) :: values(:, :) !< (rows, n), or not allocated

      call add_logical(digest, allocated(values))
      if (allocated(values)) call add_columns(digest, values)
   end subroutine add_allocated_columns

   pure subroutine add_allocated_integers(digest, values)
      type(digest_t), intent(inout) :: digest           !< gets whether it is allocated, and the values
      integer(ip), allocatable, intent(in) :: values(:) !< (n), or not allocated

      call add_logical(digest, allocated(values))
      if (allocated(values)) call add_integers(digest, values)
   end subroutine add_allocated_integers

   pure subroutine add_allocated_logicals(digest, values)
      type(digest_t), intent(inout) :: digest       !< gets whether it is allocated, and the values
      logical, allocatable, intent(in) :: values(:) !< (n), or not allocated

      call add_logical(digest, allocated(values))
      if (allocated(values)) call add_logicals(digest, values)
   end subroutine add_allocated_logicals

   pure subroutine add_allocated_text(digest, text)
      type(digest_t), intent(inout) :: digest
      character(len=:), allocatable, intent(in) :: text

      call add_logical(digest, allocated(text))
      if (allocated(text)) call add_text(digest, text)
   end subroutine add_allocated_text

   !> Takes the next part of a text.
   pure subroutine add_characters(digest, text)
      type(text_digest_t), intent(inout) :: digest !< of the parts before
      character(len=*), intent(in) :: text         !< goes on with them
      integer(lp) :: value(2), word
      integer :: i, first

      first = 1
      do while (first <= len(text) .and. digest%n > 0)
         call add_character(digest, text(first:first))
         first = first + 1
      end do
      value = digest%value
      do i = first, len(text) - WORD_LENGTH + 1, WORD_LENGTH
         word = ichar(text(i:i), lp) + BYTE*(ichar(text(i + 1:i + 1), lp) + BYTE*(ichar(text(i + 2:i + 2), lp) + &
                                                                                  BYTE*ichar(text(i + 3:i + 3), lp)))
         value = folded(folded(value*PLACE + word))
         digest%length = digest%length + WORD_LENGTH
      end do
      digest%value = modulo(value, PRIME)
      do i = i, len(text)
         call add_character(digest, text(i:i))
      end do
   end subroutine add_characters

   pure subroutine add_character(digest, symbol)
      type(text_digest_t), intent(inout) :: digest
      character(len=1), intent(in) :: symbol

      digest%word = digest%word + BYTE**digest%n*ichar(symbol, lp)
      digest%n = digest%n + 1
      digest%length = digest%length + 1
      if (digest%n < WORD_LENGTH) return
      call add_word(digest%digest_t, digest%word)
      digest%word = 0_lp
      digest%n = 0
   end subroutine add_character

   !> The same modulo the prime, below 2**31 + 2**(b - 31) of a number of b bits: 2**31 is 1.
   elemental integer(lp) function folded(x)
      integer(lp), intent(in) :: x

      folded = iand(x, PRIME) + shiftr(x, PRIME_BITS)
   end function folded

   !> Sixteen hexadecimal digits of a text.
   pure function hexadecimal(digest) result(text)
      type(text_digest_t), intent(in) :: digest !< of the whole text
      character(len=16) :: text
      character(len=16), parameter :: DIGITS = '0123456789abcdef'
      type(digest_t) :: whole
      integer :: i, k

      whole = digest%digest_t
      call add_word(whole, digest%word)
      call add_word(whole, ibits(digest%length, 0, 32))
      do i = 1, len(text)
         associate (value => whole%value(1 + (i - 1)/8))
            k = int(ibits(value, 4*(7 - mod(i - 1, 8)), 4))
            text(i:i) = DIGITS(k + 1:k + 1)
         end associate
      end do
   end function hexadecimal

   !> A digest as text: its two numbers, 0 to 2**31 - 2, with a hyphen between them.
   pure function digest_text(digest) result(text)
      type(digest_t), intent(in) :: digest !< of all values
      character(len=:), allocatable :: text

      text = to_text(digest%value(1))//'-'//to_text(digest%value(2))
   end function digest_text

end module atrito_digest
