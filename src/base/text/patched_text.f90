!> A text in pieces: places of other texts, which are not copied, and words that stand between them. So a text of 100 MB of which
!> some words are replaced takes no second 100 MB.
module atrito_patched_text
   use atrito_digest, only: text_digest_t, add_characters, hexadecimal
   use atrito_files, only: file_set_t, text_file_t, open_text, put_text, close_text
   use atrito_growth, only: growing_text_t, append_text
   use atrito_kinds, only: ip
   use atrito_status, only: status_t
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: patched_text_t, named_text_t, append_place, append_words, write_patched, take_ends, digest_of_texts, OWN_WORDS, &
             UNCOUNTED

   !> In the place of a text: a piece is a place in `words`; or one that no digest counts, the name of another file.
   integer(ip), parameter :: OWN_WORDS = 0, UNCOUNTED = -1

   type :: piece_t
      integer(ip) :: text = OWN_WORDS                !< place in texts, OWN_WORDS or UNCOUNTED
      integer(ip) :: first = 0, last = 0             !< its characters there
   end type piece_t

   !> The pieces follow each other.
   type :: patched_text_t
      type(string_t), allocatable :: texts(:)        !< that pieces are places of; the caller sets them
      type(growing_text_t) :: words                  !< all words between the places
      integer(ip) :: n = 0                           !< pieces
      type(piece_t), allocatable :: pieces(:)        !< (n) or more, in the order of the text
   end type patched_text_t

   type :: named_text_t
      character(len=:), allocatable :: name          !< of the file, without folder
      type(patched_text_t) :: text                   !< its contents
   end type named_text_t

   integer, parameter :: SOME = 64

contains

   !> Appends a place of one of the texts; an empty one is passed over.
   pure subroutine append_place(patched, text, first, last)
      type(patched_text_t), intent(inout) :: patched !< gets a piece more
      integer(ip), intent(in) :: text, first, last   !< place in texts; its characters from here to there

      if (last < first) return
      if (.not. allocated(patched%pieces)) allocate (patched%pieces(SOME))
      if (patched%n == size(patched%pieces)) patched%pieces = [patched%pieces, patched%pieces]
      patched%n = patched%n + 1
      patched%pieces(patched%n) = piece_t(text, first, last)
   end subroutine append_place

   !> Appends words of their own.
   pure subroutine append_words(patched, words)
      type(patched_text_t), intent(inout) :: patched !< gets a piece more
      character(len=*), intent(in) :: words          !< copied; may be empty
      integer(ip) :: first

      first = patched%words%n + 1
      call append_text(patched%words, words)
      call append_place(patched, OWN_WORDS, first, patched%words%n)
   end subroutine append_words

   !> Writes it as a file of a set. status: STATUS_FILE when it could not be written.
   subroutine write_patched(set, name, patched, status, before, behind)
      type(file_set_t), intent(inout) :: set                     !< begun; gets the file
      character(len=*), intent(in) :: name           !< final name, without folder
      type(patched_text_t), intent(in) :: patched                !< pieces in their order
      type(status_t), intent(out) :: status                      !< STATUS_FILE where it could not be written
      character(len=*), intent(in), optional :: before, behind   !< text that is not part of it
      type(text_file_t) :: file
      integer(ip) :: i

      call open_text(set, name, file)
      if (present(before)) call put_text(file, before)
      do i = 1, patched%n
         associate (k => patched%pieces(i)%text, first => patched%pieces(i)%first, last => patched%pieces(i)%last)
            if (k < 1) then
               call put_text(file, patched%words%letters(first:last))
            else
               call put_text(file, patched%texts(k)%s(first:last))
            end if
         end associate
      end do
      if (present(behind)) call put_text(file, behind)
      call close_text(file, status)
   end subroutine write_patched

   !> The first characters of a text, and its last ones where they are not among those.
   pure subroutine take_ends(patched, room, front, back)
      type(patched_text_t), intent(in) :: patched               !< pieces in their order
      integer(ip), intent(in) :: room                           !< characters of each at most
      character(len=:), allocatable, intent(out) :: front, back !< first characters; last ones, '' where `front` has all
      integer(ip) :: i, begin, total

      total = sum(patched%pieces(:patched%n)%last - patched%pieces(:patched%n)%first + 1)
      front = ''
      back = ''
      begin = 0                                      ! characters before the piece
      do i = 1, patched%n
         associate (k => patched%pieces(i)%text, first => patched%pieces(i)%first, last => patched%pieces(i)%last)
            call take(min(last, first + room - 1 - begin), first, front)
            if (total > room) call take(last, max(first, first + total - room - begin), back)
            begin = begin + (last - first + 1)
         end associate
      end do

   contains

      pure subroutine take(last, first, text)
         integer(ip), intent(in) :: last, first
         character(len=:), allocatable, intent(inout) :: text

         if (last < first) return
         if (patched%pieces(i)%text < 1) text = text//patched%words%letters(first:last)
         if (patched%pieces(i)%text > 0) text = text//patched%texts(patched%pieces(i)%text)%s(first:last)
      end subroutine take

   end subroutine take_ends

   !> Sixteen hexadecimal digits of texts one after the other, whatever the pieces they are made of.
   pure function digest_of_texts(list) result(text)
      type(named_text_t), intent(in) :: list(:) !< in the order in which they count
      character(len=16) :: text
      type(text_digest_t) :: digest
      integer :: i
      integer(ip) :: j

      do i = 1, size(list)
         associate (patched => list(i)%text)
            do j = 1, patched%n
               associate (k => patched%pieces(j)%text, first => patched%pieces(j)%first, last => patched%pieces(j)%last)
                  if (k == OWN_WORDS) call add_characters(digest, patched%words%letters(first:last))
                  if (k > 0) call add_characters(digest, patched%texts(k)%s(first:last))
               end associate
            end do
         end associate
      end do
      text = hexadecimal(digest)
   end function digest_of_texts

end module atrito_patched_text
