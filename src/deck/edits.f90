!> What of a deck's text is replaced when the deck is written as it was run: places of its files, and the words that take them.
module atrito_edits
   use atrito_kinds, only: ip
   use atrito_name_list, only: name_list_t, add_name, find_name
   implicit none (type, external)
   private
   public :: edits_t, append_edit, append_known_edit, take_known_edit

   !> In the order in which the deck is read.
   type :: edits_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: source(:)          !< which file
      integer(ip), allocatable :: first(:), last(:)  !< characters of it that are replaced
      integer(ip), allocatable :: from(:), to(:)     !< the words, in `words`
      logical, allocatable :: is_name(:)             !< of a file that is written, too
      integer(ip) :: n_words = 0
      character(len=:), allocatable :: words         !< those up to n_words are in use
      type(name_list_t), private :: known            !< texts that were replaced before: a deck can have one a node
      integer(ip), allocatable, private :: edit_of(:) !< an edit of each
   end type edits_t

   integer(ip), parameter :: SOME = 64

contains

   !> Appends an edit with words of its own.
   pure subroutine append_edit(edits, source, first, last, words, is_name)
      type(edits_t), intent(inout) :: edits
      integer(ip), intent(in) :: source, first, last
      character(len=*), intent(in) :: words
      logical, intent(in), optional :: is_name       !< left out: .false.
      integer(ip) :: n

      n = edits%n_words + len(words, kind=ip)
      if (.not. allocated(edits%words)) edits%words = repeat(' ', max(SOME, len(words, kind=ip)))
      if (n > len(edits%words)) edits%words = edits%words//repeat(' ', max(len(edits%words), len(words)))
      edits%words(edits%n_words + 1:n) = words
      call append_place(edits, source, first, last, edits%n_words + 1, n)
      if (present(is_name)) edits%is_name(edits%n) = is_name
      edits%n_words = n
   end subroutine append_edit

   !> Appends an edit whose words may serve again for the same text.
   pure subroutine append_known_edit(edits, text, source, first, last, words)
      type(edits_t), intent(inout) :: edits
      character(len=*), intent(in) :: text, words
      integer(ip), intent(in) :: source, first, last

      call append_edit(edits, source, first, last, words)
      call add_name(edits%known, text)
      if (.not. allocated(edits%edit_of)) allocate (edits%edit_of(SOME))
      if (edits%known%n > size(edits%edit_of)) edits%edit_of = [edits%edit_of, edits%edit_of]
      edits%edit_of(edits%known%n) = edits%n
   end subroutine append_known_edit

   !> Appends an edit with the words of an earlier one of the same text, where there is one.
   pure subroutine take_known_edit(edits, text, source, first, last, found)
      type(edits_t), intent(inout) :: edits
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: source, first, last
      logical, intent(out) :: found
      integer(ip) :: known, from, to

      known = find_name(edits%known, text)
      found = known > 0
      if (.not. found) return
      from = edits%from(edits%edit_of(known))         ! of their own: the list that has them may move
      to = edits%to(edits%edit_of(known))
      call append_place(edits, source, first, last, from, to)
   end subroutine take_known_edit

   pure subroutine append_place(edits, source, first, last, from, to)
      type(edits_t), intent(inout) :: edits
      integer(ip), intent(in) :: source, first, last, from, to

      if (.not. allocated(edits%source)) then
         allocate (edits%source(SOME), edits%first(SOME), edits%last(SOME), edits%from(SOME), edits%to(SOME), edits%is_name(SOME))
      else if (edits%n == size(edits%source)) then
         edits%source = [edits%source, edits%source]
         edits%first = [edits%first, edits%first]
         edits%last = [edits%last, edits%last]
         edits%from = [edits%from, edits%from]
         edits%to = [edits%to, edits%to]
         edits%is_name = [edits%is_name, edits%is_name]
      end if
      edits%n = edits%n + 1
      edits%source(edits%n) = source
      edits%first(edits%n) = first
      edits%last(edits%n) = last
      edits%from(edits%n) = from
      edits%to(edits%n) = to
      edits%is_name(edits%n) = .false.
   end subroutine append_place

end module atrito_edits
