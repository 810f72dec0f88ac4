!> A deck as it was run: all files that it includes in their places, parameters replaced by their values. It runs by itself.
module atrito_deck_as_run
   use atrito_as_run_names, only: as_run_name, mesh_copy_name
   use atrito_deck, only: deck_t, after_byte_order_mark
   use atrito_edits, only: put_before_steps
   use atrito_kinds, only: ip
   use atrito_own_files, only: DECK_MARK, MESH_MARK
   use atrito_patched_text, only: patched_text_t, named_text_t, append_place, append_words, OWN_WORDS, UNCOUNTED
   use atrito_strings, only: deck_name
   implicit none (type, external)
   private
   public :: take_deck_as_run

   character(len=1), parameter :: LINE_FEED = achar(10)

contains

   !> The deck first, then the meshes of other programs that it includes. The texts of the deck are moved; it is of no use
   !> afterwards.
   subroutine take_deck_as_run(deck, files, before_steps)
      type(deck_t), intent(inout) :: deck                      !< edits noted; loses its texts
      type(named_text_t), allocatable, intent(out) :: files(:) !< deck, then copies of meshes, with their names
      character(len=*), intent(in), optional :: before_steps   !< cards that are put before the first *STEP
      integer(ip) :: i, n, edit, last

      if (present(before_steps)) call put_before_steps(deck%edits, before_steps)
      n = count(deck%sources(:deck%n_sources)%is_mesh, kind=ip)
      allocate (files(n + 1))
      files(1)%name = as_run_name(deck_name(deck%path))
      files(1)%text%words%n = deck%edits%words%n
      if (deck%edits%words%n > 0) call move_alloc(deck%edits%words%letters, files(1)%text%words%letters)
      edit = 1
      call put_source(1_ip, files(1)%text)
      allocate (files(1)%text%texts(deck%n_sources))
      n = 1
      do i = 1, deck%n_sources
         if (deck%sources(i)%is_mesh) then
            n = n + 1
            files(n)%name = mesh_copy_name(deck_name(deck%path), n - 1)
            allocate (files(n)%text%texts(1))
            ! up to the words by which the copy of a mesh says that atrito wrote it; the writer adds them anew
            last = index(deck%sources(i)%text, MESH_MARK, back=.true., kind=ip) - 1
            if (last < 0) last = len(deck%sources(i)%text, kind=ip)
            call append_place(files(n)%text, 1_ip, 1_ip, last)
            call move_alloc(deck%sources(i)%text, files(n)%text%texts(1)%s)
         else
            call move_alloc(deck%sources(i)%text, files(1)%text%texts(i)%s)
         end if
      end do

   contains

      !> A file of the deck, with what it includes.
      recursive subroutine put_source(source, patched)
         integer(ip), intent(in) :: source
         type(patched_text_t), intent(inout) :: patched
         integer(ip) :: position, child, last

         last = len(deck%sources(source)%text, kind=ip)
         position = after_mark(deck%sources(source)%text)
         child = next_child(deck, source, source)
         do while (child > 0)
            associate (included => deck%sources(child))
               call put_edited(source, included%include_first - 1, position, patched)
               call put_source(child, patched)
               ! What follows an included file begins a line.
               if (len(included%text) /= 0) then
                  if (included%text(len(included%text):) /= LINE_FEED) call append_words(patched, LINE_FEED)
               end if
               position = included%include_last + 1
            end associate
            child = next_child(deck, source, child)
         end do
         call put_edited(source, last, position, patched)
      end subroutine put_source

      !> The characters of a file up to `last`, with the edits among them.
      subroutine put_edited(source, last, position, patched)
         integer(ip), intent(in) :: source, last
         integer(ip), intent(inout) :: position           !< the first character that is left
         type(patched_text_t), intent(inout) :: patched

         do while (edit <= deck%edits%n)
            associate (one => deck%edits%list(edit))
               if (one%source /= source .or. one%first > last) exit
               call append_place(patched, source, position, one%first - 1)
               call append_place(patched, merge(UNCOUNTED, OWN_WORDS, one%is_name), one%from, one%to)
               position = one%last + 1
            end associate
            edit = edit + 1
         end do
         call append_place(patched, source, position, last)
         position = max(position, last + 1)
      end subroutine put_edited
   end subroutine take_deck_as_run

   !> The first character behind the line by which a deck says so.
   pure integer(ip) function after_mark(text) result(position)
      character(len=*), intent(in) :: text

      position = after_byte_order_mark(text)
      if (index(text(position:), DECK_MARK) /= 1) return
      position = position + index(text(position:)//LINE_FEED, LINE_FEED, kind=ip)
   end function after_mark

   !> The next file, not a mesh, that one includes; 0: there is none.
   pure integer(ip) function next_child(deck, source, before) result(child)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: source, before

      do child = before + 1, deck%n_sources
         if (deck%sources(child)%parent == source .and. .not. deck%sources(child)%is_mesh) return
      end do
      child = 0
   end function next_child

end module atrito_deck_as_run
