!> Long runs of data lines, as a mesh has them: all threads split them.
!>
!> A line is plain when it has nothing but items with commas between them: no quote, no bracket, no star, no control character, and
!> no comma at its end. What stands in a plain line does not depend on the lines before it, and how many items a piece of such lines
!> has follows from its commas. So each piece has its place in the lists of the deck before it is split. A run ends before the first
!> line that is not plain; the reader takes that one as ever.
module atrito_plain_lines
   use atrito_deck, only: deck_t, data_line_t, token_t, make_room
   use atrito_kinds, only: ip
   use atrito_lexer, only: count_data_lines
   use atrito_strings, only: count_symbol
   use atrito_threads, only: n_threads
   implicit none (type, external)
   private
   public :: take_plain_lines

   !> Whole lines of a text, and the places of what they hold in the lists of the deck.
   type :: piece_t
      integer(ip) :: first = 1, last = 0               !< characters
      integer(ip) :: n_lines = 0, n_tokens = 0         !< where all of it is plain
      integer(ip) :: line = 0, token = 0               !< in the lists before it
      integer(ip) :: lines_taken = 0, tokens_taken = 0 !< of them, up to the first line that is not plain
      integer(ip) :: next = 1                          !< first character that was not taken
   end type piece_t

   !> Characters of a piece, and of a run that is worth it.
   integer(ip), parameter :: PIECE = 65536_ip, LEAST = 2*PIECE
   integer(ip), parameter :: GLANCE = 200_ip

   integer, parameter :: WORD = 0, BLANK = 1, COMMA = 2, LINE_END = 3, CARRIAGE = 4, ODD = 5
   !> Characters with a meaning of their own; all other control characters are odd.
   character(len=*), parameter :: SPECIAL = achar(9)//' ,'//achar(10)//achar(13)//'"<*'//achar(127)
   integer, parameter :: OF_SPECIAL(9) = [BLANK, BLANK, COMMA, LINE_END, CARRIAGE, ODD, ODD, ODD, ODD]

contains

   !> Appends the lines of the run that begins at `position`, which moves behind it; none where it is short.
   subroutine take_plain_lines(deck, source, position, line)
      type(deck_t), intent(inout) :: deck          !< gets lines and items
      integer(ip), intent(in) :: source            !< place in sources
      integer(ip), intent(inout) :: position       !< first character of a line
      integer(ip), intent(inout) :: line           !< number of the line before it
      type(piece_t), allocatable :: pieces(:)
      integer :: meaning(0:255)
      integer(ip) :: last, i

      last = end_of_run(deck%sources(source)%text, position)
      if (last - position + 1 < LEAST) return
      meaning = meanings()
      call cut_run(deck%sources(source)%text, position, last, pieces)
      call make_room(deck, sum(pieces%n_tokens), sum(pieces%n_lines))
      associate (text => deck%sources(source)%text, n_tokens => deck%n_tokens, n_lines => deck%n_lines)
         !$omp parallel do schedule(dynamic) if (n_threads() > 1)
         do i = 1, size(pieces, kind=ip)
            call split_piece(text, meaning, source, line, n_tokens, pieces(i), &
                             deck%tokens(n_tokens + pieces(i)%token + 1:n_tokens + pieces(i)%token + pieces(i)%n_tokens), &
                             deck%lines(n_lines + pieces(i)%line + 1:n_lines + pieces(i)%line + pieces(i)%n_lines))
         end do
      end associate
      do i = 1, size(pieces, kind=ip)
         deck%n_tokens = deck%n_tokens + pieces(i)%tokens_taken
         deck%n_lines = deck%n_lines + pieces(i)%lines_taken
         line = line + pieces(i)%lines_taken
         position = pieces(i)%next
         if (position <= pieces(i)%last) exit
      end do
   end subroutine take_plain_lines

   !> What characters are, by their codes.
   pure function meanings() result(meaning)
      integer :: meaning(0:255), i

      meaning = WORD
      meaning(:31) = ODD
      do i = 1, len(SPECIAL)
         meaning(iachar(SPECIAL(i:i))) = OF_SPECIAL(i)
      end do
   end function meanings

   !> The end of the last whole line before the next star; position - 1: there is none.
   pure integer(ip) function end_of_run(text, position) result(last)
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: position
      integer(ip) :: first

      last = position - 1
      if (index(text(position:min(len(text, kind=ip), position + GLANCE)), '*') > 0) return  ! no run that is worth it
      last = len(text, kind=ip)
      do first = position, len(text, kind=ip), PIECE
         associate (piece => text(first:min(len(text, kind=ip), first + PIECE - 1)))
            if (count_symbol(piece, '*') == 0) cycle
            last = first + index(piece, '*', kind=ip) - 2
            exit
         end associate
      end do
      do while (last >= position)
         if (text(last:last) == achar(10)) exit
         last = last - 1
      end do
   end function end_of_run

   !> Cuts text(first:last), whole lines, and counts what each piece has.
   subroutine cut_run(text, first, last, pieces)
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: first, last
      type(piece_t), allocatable, intent(out) :: pieces(:)
      integer(ip) :: i, n, next

      allocate (pieces((last - first)/PIECE + 1))
      n = 0
      next = first
      do while (next <= last)
         n = n + 1
         pieces(n)%first = next
         pieces(n)%last = min(last, next + PIECE - 1)
         pieces(n)%last = pieces(n)%last - 1 + index(text(pieces(n)%last:last), achar(10), kind=ip)
         next = pieces(n)%last + 1
      end do
      pieces = pieces(:n)
      !$omp parallel do schedule(static) if (n_threads() > 1)
      do i = 1, n
         pieces(i)%n_lines = int(count_data_lines(text(pieces(i)%first:pieces(i)%last)), ip)  ! blank lines end a run
         pieces(i)%n_tokens = pieces(i)%n_lines + int(count_symbol(text(pieces(i)%first:pieces(i)%last), ','), ip)
      end do
      do i = 2, n
         pieces(i)%line = pieces(i - 1)%line + pieces(i - 1)%n_lines
         pieces(i)%token = pieces(i - 1)%token + pieces(i - 1)%n_tokens
      end do
   end subroutine cut_run

   !> Splits the lines of a piece as far as they are plain.
   pure subroutine split_piece(text, meaning, source, line, n_tokens, piece, tokens, lines)
      character(len=*), intent(in) :: text
      integer, intent(in) :: meaning(0:255)
      integer(ip), intent(in) :: source
      integer(ip), intent(in) :: line              !< number of the line before the run
      integer(ip), intent(in) :: n_tokens          !< of the deck before the run
      type(piece_t), intent(inout) :: piece
      type(token_t), intent(inout), contiguous :: tokens(:)    !< those of the piece
      type(data_line_t), intent(inout), contiguous :: lines(:) !< the same
      integer(ip) :: n, next
      logical :: is_plain

      piece%next = piece%first
      do while (piece%next <= piece%last)
         n = piece%tokens_taken
         call split_line(text, meaning, source, line + piece%line + piece%lines_taken + 1, piece%next, n, tokens, next, is_plain)
         if (.not. is_plain) exit
         piece%lines_taken = piece%lines_taken + 1
         lines(piece%lines_taken) = data_line_t(n_tokens + piece%token + piece%tokens_taken + 1, n - piece%tokens_taken)
         piece%tokens_taken = n
         piece%next = next
      end do
   end subroutine split_piece

   !> Adds the items of a line.
   pure subroutine split_line(text, meaning, source, line, start, n, tokens, next, is_plain)
      character(len=*), intent(in) :: text
      integer, intent(in) :: meaning(0:255)          !< of characters, by their codes
      integer(ip), intent(in) :: source, line
      integer(ip), intent(in) :: start             !< its first character
      integer(ip), intent(inout) :: n
      type(token_t), intent(inout), contiguous :: tokens(:)
      integer(ip), intent(out) :: next             !< first character of the next line, where this one is plain
      logical, intent(out) :: is_plain
      integer(ip) :: i, before, first, last        ! of an item; first = 0: no character of it yet

      before = start
      first = 0
      last = 0
      is_plain = .false.
      i = start - 1
      do
         i = i + 1
         select case (meaning(ichar(text(i:i))))
         case (WORD)
            if (first == 0) first = i
            do while (meaning(ichar(text(i + 1:i + 1))) == WORD)
               i = i + 1
            end do
            last = i
         case (COMMA)
            if (first == 0) then                   ! an empty one stands behind the comma before it, or where the line begins
               first = merge(i, before, before == start)
               last = first - 1
            end if
            n = n + 1
            tokens(n) = token_t(source, 0_ip, line, first - start + 1, first, last)
            before = i + 1
            first = 0
         case (LINE_END)
            exit
         case (CARRIAGE)
            if (text(i + 1:min(i + 1, len(text, kind=ip))) /= achar(10)) return
         case (ODD)
            return
         end select
      end do
      is_plain = first > 0                         ! else it is blank, or has a comma at its end
      if (.not. is_plain) return
      n = n + 1
      tokens(n) = token_t(source, 0_ip, line, first - start + 1, first, last)
      next = i + 1
   end subroutine split_line

end module atrito_plain_lines
