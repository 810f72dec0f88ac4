!> What of a deck's text is replaced when the deck is written as it was run: places of its files, and the words that take them.
module atrito_edits
   use atrito_growth, only: growing_text_t, append_text
   use atrito_kinds, only: ip
   use atrito_name_list, only: name_list_t, add_name, find_name
   implicit none (type, external)
   private
   public :: edit_t, edits_t, append_edit, append_known_edit, put_before_steps, take_known_edit

   type :: edit_t
      integer(ip) :: source = 0                      !< which file
      integer(ip) :: first = 0, last = 0             !< characters of it that are replaced
      integer(ip) :: from = 0, to = 0                !< the words that take their place, in `words`
      logical :: is_name = .false.                   !< they are the name of a file that is written, too
   end type edit_t

   !> In the order in which the deck is read.
   type :: edits_t
      integer(ip) :: n = 0                            !< edits so far
      type(edit_t), allocatable :: list(:)            !< (n) or more
      type(growing_text_t) :: words                   !< all words, one behind the other
      integer(ip) :: before_steps = 0                 !< place of the edit, empty at first, before the first *STEP; 0: there is none
      type(name_list_t), private :: known             !< texts that were replaced before: a deck can have one a node
      integer(ip), allocatable, private :: edit_of(:) !< an edit of each
   end type edits_t

   integer(ip), parameter :: SOME = 64

contains

   !> Appends an edit with words of its own.
   pure subroutine append_edit(edits, source, first, last, words, is_name)
      type(edits_t), intent(inout) :: edits          !< gets an edit more, of a later place
      integer(ip), intent(in) :: source, first, last !< as of edit_t
      character(len=*), intent(in) :: words          !< that take their place; '': they go
      logical, intent(in), optional :: is_name       !< left out: .false.
      integer(ip) :: from

      from = edits%words%n + 1
      call append_text(edits%words, words)
      call append_place(edits, edit_t(source, first, last, from, edits%words%n))
      if (present(is_name)) edits%list(edits%n)%is_name = is_name
   end subroutine append_edit

   !> Puts words before the first *STEP.
   pure subroutine put_before_steps(edits, words)
      type(edits_t), intent(inout) :: edits !< the edit before the first *STEP gets them
      character(len=*), intent(in) :: words !< whole lines, with their ends

      if (edits%before_steps == 0) return
      edits%list(edits%before_steps)%from = edits%words%n + 1
      call append_text(edits%words, words)
      edits%list(edits%before_steps)%to = edits%words%n
   end subroutine put_before_steps

   !> Appends an edit whose words may serve again for the same text.
   pure subroutine append_known_edit(edits, text, source, first, last, words)
      type(edits_t), intent(inout) :: edits          !< gets an edit more, of a later place
      character(len=*), intent(in) :: text, words    !< what is replaced, by which words are found again; what takes its place
      integer(ip), intent(in) :: source, first, last !< as of edit_t

      call append_edit(edits, source, first, last, words)
      call add_name(edits%known, text)
      if (.not. allocated(edits%edit_of)) allocate (edits%edit_of(SOME))
      if (edits%known%n > size(edits%edit_of)) edits%edit_of = [edits%edit_of, edits%edit_of]
      edits%edit_of(edits%known%n) = edits%n
   end subroutine append_known_edit

   !> Appends an edit with the words of an earlier one of the same text, where there is one.
   pure subroutine take_known_edit(edits, text, source, first, last, found)
      type(edits_t), intent(inout) :: edits          !< gets an edit more where the text is known
      character(len=*), intent(in) :: text           !< what is replaced
      integer(ip), intent(in) :: source, first, last !< as of edit_t
      logical, intent(out) :: found                  !< an edit has been appended
      type(edit_t) :: edit
      integer(ip) :: known

      known = find_name(edits%known, text)
      found = known > 0
      if (.not. found) return
      edit = edits%list(edits%edit_of(known))
      call append_place(edits, edit_t(source, first, last, edit%from, edit%to))
   end subroutine take_known_edit

   pure subroutine append_place(edits, edit)
      type(edits_t), intent(inout) :: edits
      type(edit_t), intent(in) :: edit

      if (.not. allocated(edits%list)) allocate (edits%list(SOME))
      if (edits%n == size(edits%list)) edits%list = [edits%list, edits%list]
      edits%n = edits%n + 1
      edits%list(edits%n) = edit
   end subroutine append_place

end module atrito_edits
