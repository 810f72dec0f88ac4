!> Words of a text, line by line: what the reader of Gmsh's files walks on. It keeps the first thing that is wrong, and where.
module atrito_gmsh_words
   use atrito_kinds, only: ip, lp, wp
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: words_t, fault_t, next_line, take_word, take_integer, take_real, end_line, fail, word_is
   public :: go_on, begin_line, read_head, check_count, check_number

   !> What is wrong with a text, and where.
   type :: fault_t
      character(len=:), allocatable :: text        !< not allocated: nothing
      character(len=:), allocatable :: expected    !< what should be there
      integer(ip) :: line = 1, column = 1          !< where, from 1
      integer(ip) :: first = 1, last = 0           !< characters of the text
   end type fault_t

   !> A text and a place in it. A line is over when take_word finds nothing more.
   type :: words_t
      character(len=:), pointer :: text => null()  !< of whoever reads it
      integer(ip) :: position = 1                  !< next character
      integer(ip) :: line = 0                      !< number of the present line
      integer(ip) :: start = 1                     !< its first character
      integer(ip) :: first = 1, last = 0           !< the word taken last; last < first: there was none
      logical :: ok = .true.                       !< nothing is wrong so far
      type(fault_t) :: fault                       !< the first one
   end type words_t

   character(len=1), parameter :: LINE_FEED = achar(10)

contains

   !> Goes to the next line that has a word, and takes that word; found is .false. at the end of the text.
   subroutine next_line(words, found)
      type(words_t), intent(inout) :: words !< goes on to the first word of that line
      logical, intent(out) :: found         !< there is one
      integer(ip) :: i

      found = .false.
      do
         if (words%line > 0) then                  ! over the rest of the present line
            do i = words%position, len(words%text)
               if (words%text(i:i) == LINE_FEED) exit
            end do
            words%position = min(i, len(words%text)) + 1
         end if
         if (words%position > len(words%text)) exit
         words%line = words%line + 1
         words%start = words%position
         call take_word(words)
         found = words%last >= words%first
         if (found) return
      end do
   end subroutine next_line

   !> The next word of the line; none: last < first.
   pure subroutine take_word(words)
      type(words_t), intent(inout) :: words !< goes on behind the word

      call find_word(words%text, words%position, words%first, words%last)
      words%position = words%last + 1
   end subroutine take_word

   pure subroutine find_word(text, position, first, last)
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: position
      integer(ip), intent(out) :: first, last

      do first = position, len(text)
         if (text(first:first) == LINE_FEED .or. iachar(text(first:first)) > iachar(' ')) exit
      end do
      do last = first, len(text)
         if (iachar(text(last:last)) <= iachar(' ')) exit
      end do
      last = last - 1
   end subroutine find_word

   !> The next word, which must be an integer.
   subroutine take_integer(words, what, value)
      character(len=*), intent(in) :: what  !< what it is, for a message
      type(words_t), intent(inout) :: words !< goes on behind the word; may fail
      integer(ip), intent(out) :: value     !< 0 where there is none
      integer(lp) :: sum
      integer(ip) :: i, first
      integer :: digit

      value = 0
      if (.not. words%ok) return
      call take_word(words)
      sum = 0_lp
      first = words%first
      if (first < words%last) then
         if (words%text(first:first) == '-') first = first + 1
      end if
      words%ok = words%last >= first
      do i = first, words%last
         digit = iachar(words%text(i:i)) - iachar('0')
         words%ok = words%ok .and. digit >= 0 .and. digit <= 9
         if (.not. words%ok) exit                    ! a long word of other characters would leave the integers
         sum = min(10_lp*sum + int(digit, lp), int(huge(1_ip), lp) + 1_lp)
      end do
      if (.not. words%ok) then
         call fail(words, missing_or(words, 'this is not an integer'), what//', an integer')
      else if (sum > int(huge(1_ip), lp)) then
         call fail(words, 'this number is too large', what//', at most '//to_text(huge(1_ip)))
      else
         value = int(sum, ip)
         if (first > words%first) value = -value
      end if
   end subroutine take_integer

   !> The next word, which must be a real.
   subroutine take_real(words, what, value)
      character(len=*), intent(in) :: what  !< what it is, for a message
      type(words_t), intent(inout) :: words !< goes on behind the word; may fail
      real(wp), intent(out) :: value        !< 0 where there is none
      integer :: outcome

      value = 0.0_wp
      if (.not. words%ok) return
      call take_word(words)
      call read_real(words%text(words%first:words%last), value, outcome)
      if (outcome /= NUMBER_OK) call fail(words, missing_or(words, 'this is not a number'), what//', a real')
   end subroutine take_real

   pure function missing_or(words, text) result(problem)
      type(words_t), intent(in) :: words
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: problem

      problem = text
      if (words%last < words%first) problem = 'the line ends too early'
   end function missing_or

   !> Nothing more may stand in the line.
   subroutine end_line(words, expected)
      character(len=*), intent(in) :: expected !< what the line should be, for a message
      type(words_t), intent(inout) :: words    !< stays in the line; may fail
      integer(ip) :: first, last

      if (.not. words%ok) return
      first = words%first
      last = words%last
      call take_word(words)
      if (words%last >= words%first) call fail(words, 'an item too many', expected)
      words%first = first                          ! what is said next is of the last item
      words%last = last
   end subroutine end_line

   !> Keeps what is wrong at the word taken last; only the first time counts.
   subroutine fail(words, text, expected)
      type(words_t), intent(inout) :: words          !< not ok from now on
      character(len=*), intent(in) :: text, expected !< what is wrong; what should be there

      words%ok = .false.
      if (allocated(words%fault%text)) return
      words%fault%text = text
      words%fault%expected = expected
      words%fault%line = max(words%line, 1_ip)
      words%fault%first = words%first
      words%fault%last = words%last
      words%fault%column = words%first - words%start + 1
   end subroutine fail

   !> Whether the word that was read last is this one, letter for letter.
   pure logical function word_is(words, word)
      character(len=*), intent(in) :: word !< letter for letter
      type(words_t), intent(in) :: words   !< behind a word

      word_is = words%last - words%first + 1 == len(word)
      if (word_is) word_is = words%text(words%first:words%last) == word
   end function word_is

   !> To the next line, which must be there.
   subroutine go_on(words, expected)
      character(len=*), intent(in) :: expected !< what should follow, for a message
      type(words_t), intent(inout) :: words    !< goes on to the next line; may fail
      logical :: found

      if (.not. words%ok) return
      call next_line(words, found)
      if (.not. found) call fail(words, 'the file ends too early', expected)
   end subroutine go_on

   !> The first word of the next line as an integer.
   subroutine begin_line(words, what, value)
      character(len=*), intent(in) :: what  !< what it is, for a message
      type(words_t), intent(inout) :: words !< goes on to the next line; may fail
      integer(ip), intent(out) :: value     !< 0 where there is none

      value = 0
      call go_on(words, what)
      if (.not. words%ok) return
      words%position = words%first
      call take_integer(words, what, value)
   end subroutine begin_line

   !> A count of lines that the rest of the text can hold; each of so many characters at the least.
   subroutine check_count(words, n, least)
      type(words_t), intent(inout) :: words !< may fail
      integer(ip), intent(in) :: n, least   !< lines that follow; characters of each, > 0

      if (.not. words%ok) return
      if (n < 0) call fail(words, 'a negative number', 'a number of lines')
      if (n > (len(words%text) - words%position)/least + 1) call fail(words, 'the rest of the file is too short for so many', &
                                                                      'as many as follow')
   end subroutine check_count

   !> Fails, with a message at the word that was read last, where a number is not positive.
   subroutine check_number(words, number)
      type(words_t), intent(inout) :: words !< may fail
      integer(ip), intent(in) :: number     !< that is to be > 0

      if (words%ok .and. number <= 0) call fail(words, 'this number is not positive', 'a number from 1')
   end subroutine check_number

   !> The head of a block of format 4.1.
   subroutine read_head(words, what, head)
      character(len=*), intent(in) :: what             !< what the last number counts, for a message
      type(words_t), intent(inout) :: words            !< goes on over the line; may fail
      integer(ip), intent(out) :: head(4)              !< dimension, entity, kind, how many

      head = 0
      call begin_line(words, 'dimension of the entity', head(1))
      call take_integer(words, 'tag of the entity', head(2))
      call take_integer(words, 'kind', head(3))
      call take_integer(words, what, head(4))
      call end_line(words, 'four integers')
   end subroutine read_head

end module atrito_gmsh_words
