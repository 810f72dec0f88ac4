!> Messages about a place in the deck, docs/user/messages.md.
module atrito_diagnostics
   use atrito_kinds, only: ip
   use atrito_deck, only: deck_t, card_t, token_t, token_text, reading_order, take_source_line
   use atrito_messages, only: message_t, add_message, has_room, count_messages, ID_OUTSIDE, MOST_ERRORS, WIDEST_SOURCE, &
                              SEVERITY_ERROR, SEVERITY_WARNING, SEVERITY_NOTE
   use atrito_name_list, only: name_list_t, names_of
   use atrito_strings, only: string_t, nearest_names, upper_case
   implicit none (type, external)
   private
   public :: report_error, refuse_card, report_warning, report_note, report_outside, report_deck_error

   !> What may be wrong because the scene is another one than atrito's: faces, labels and options of other elements.
   character(len=16), parameter :: FOLLOWING(8) = [character(len=16) :: 'E-CHOICE', 'E-ITEMS', 'E-LINES', 'E-OPTION', &
                                                                   'E-OPTION-MISSING', 'E-OPTION-VALUE', 'E-MISSING', 'E-NOT-BUILT']
   integer, parameter :: MOST_NEAREST = 3
   integer, parameter :: LONGEST_TEXT = 240
   integer, parameter :: SHORT_LIST = 8        !< a list of valid names that is listed whole when none of them is near
   integer(ip), parameter :: LONG_LIST = 1000  !< a list that is gone through for as many errors as are printed

contains

   !> Reports an error at an item of the deck; it is counted, and reading goes on.
   subroutine report_error(deck, token, id, text, expected, known, keyword, among)
      type(deck_t), intent(in) :: deck                      !< its texts are shown
      type(token_t), intent(in) :: token                    !< where; the marker stands under it
      character(len=*), intent(in) :: id                    !< short stable name, docs/user/messages.md
      character(len=*), intent(in) :: text                  !< what is wrong
      character(len=*), intent(in), optional :: expected    !< what should be there, with its dimension
      type(string_t), intent(in), optional :: known(:)      !< valid names: the message has those nearest to the item
      character(len=*), intent(in), optional :: keyword     !< for `atrito help KEYWORD`; left out: that of the card
      type(name_list_t), intent(in), optional :: among      !< further valid names, which may be many

      if (deck%is_outside) then
         if (any(FOLLOWING == id)) return
      end if
      call report(deck, token, SEVERITY_ERROR, id, text, expected, known, keyword, among)
   end subroutine report_error

   !> Reports an error of a card, whose `ok` is false from then on.
   subroutine refuse_card(deck, card, id, text, expected, place, known)
      type(deck_t), intent(in) :: deck                      !< its texts are shown
      type(card_t), intent(inout) :: card                   !< becomes not ok
      character(len=*), intent(in) :: id, text              !< as of report_error
      character(len=*), intent(in), optional :: expected    !< as of report_error
      type(token_t), intent(in), optional :: place          !< where; its keyword when left out
      type(string_t), intent(in), optional :: known(:)      !< as of report_error
      type(token_t) :: at

      card%ok = .false.
      at = card%place
      if (present(place)) at = place
      call report_error(deck, at, id, text, expected, known, trim(card%name))
   end subroutine refuse_card

   !> Refuses by name what atrito does not solve, and says what to do instead.
   subroutine report_outside(deck, token, name, subject)
      type(deck_t), intent(in) :: deck                      !< its texts are shown
      type(token_t), intent(in) :: token                    !< where; the marker stands under it
      character(len=*), intent(in) :: name                  !< as in the deck, or as in the list
      integer, intent(in) :: subject                        !< its place, atrito_foreign_keywords

      call report(deck, token, SEVERITY_ERROR, ID_OUTSIDE, name//' is outside of atrito: '//deck%subjects(subject)%what, &
                  expected=deck%subjects(subject)%instead, keyword='')
   end subroutine report_outside

   !> As report_error, a warning.
   subroutine report_warning(deck, token, id, text, expected, keyword)
      type(deck_t), intent(in) :: deck                            !< its texts are shown
      type(token_t), intent(in) :: token                          !< as of report_error
      character(len=*), intent(in) :: id, text                    !< as of report_error
      character(len=*), intent(in), optional :: expected, keyword !< as of report_error

      call report(deck, token, SEVERITY_WARNING, id, text, expected, keyword=keyword)
   end subroutine report_warning

   !> As report_error, a note.
   subroutine report_note(deck, token, id, text, expected, keyword)
      type(deck_t), intent(in) :: deck                            !< its texts are shown
      type(token_t), intent(in) :: token                          !< as of report_error
      character(len=*), intent(in) :: id, text                    !< as of report_error
      character(len=*), intent(in), optional :: expected, keyword !< as of report_error

      call report(deck, token, SEVERITY_NOTE, id, text, expected, keyword=keyword)
   end subroutine report_note

   !> Reports an error of a file as a whole, without a line.
   subroutine report_deck_error(deck, id, text, expected, keyword, source)
      type(deck_t), intent(in) :: deck                            !< its paths are shown
      character(len=*), intent(in) :: id, text                    !< as of report_error
      integer(ip), intent(in), optional :: source                 !< the file; the deck itself when left out
      character(len=*), intent(in), optional :: expected, keyword !< as of report_error
      type(message_t) :: message

      message%severity = SEVERITY_ERROR
      message%id = id
      message%text = text
      message%file = deck%path
      if (present(source)) message%file = deck%sources(source)%name
      if (present(expected)) message%expected = expected
      if (present(keyword)) message%keyword = keyword
      call add_message(message)
   end subroutine report_deck_error

   subroutine report(deck, token, severity, id, text, expected, known, keyword, among)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      integer, intent(in) :: severity
      character(len=*), intent(in) :: id, text
      character(len=*), intent(in), optional :: expected, keyword
      type(string_t), intent(in), optional :: known(:)
      type(name_list_t), intent(in), optional :: among
      type(message_t) :: message

      message%severity = severity
      message%id = id
      ! A text that quotes a very long item, without its middle.
      message%text = text
      if (len(text) > LONGEST_TEXT) message%text = text(:LONGEST_TEXT/2)//'...'//text(len(text) - LONGEST_TEXT/2 + 1:)
      message%is_of_place = allocated(deck%scopes)          ! the same of another instance of a part
      if (.not. has_room(severity)) then
         call add_message(message)                          ! it is only counted
         return
      end if
      if (present(expected)) message%expected = expected
      message%keyword = keyword_at(deck, token)
      if (present(keyword)) message%keyword = keyword
      if (len(message%keyword) == 0) deallocate (message%keyword)
      if (present(known) .or. present(among)) call tell_names(token_text(deck, token), known, among, message)
      if (token%source > 0) then
         message%file = deck%sources(token%source)%name
         message%line = token%line
         message%column = token%column
         message%length = max(1, token%last - token%first + 1)
         call take_source_line(deck, token, WIDEST_SOURCE, message%source, message%skipped)
         message%order = reading_order(deck, token%source, token%line)
      else
         message%file = deck%path
      end if
      call add_message(message)
   end subroutine report

   !> The keyword that explains an item: that of its card, the last one that begins before it in the same file; *SPRING for the
   !> *ELEMENT of a spring. '' of none, and while cards are still being read: they report their faults with their own keyword.
   pure function keyword_at(deck, token) result(keyword)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: token
      character(len=:), allocatable :: keyword
      integer(ip) :: i, found, line

      keyword = ''
      if (.not. deck%is_read .or. token%source == 0) return
      found = 0
      line = 0
      do i = 1, deck%n_cards
         associate (place => deck%cards(i)%place)
            if (place%source /= token%source .or. place%line > token%line .or. place%line < line) cycle
            found = i
            line = place%line
         end associate
      end do
      if (found == 0) return
      keyword = trim(deck%cards(found)%name)
      if (keyword /= 'ELEMENT' .or. .not. allocated(deck%cards(found)%options)) return
      associate (options => deck%cards(found)%options)
         do i = 1, size(options, kind=ip)
            if (index(upper_case(token_text(deck, options(i)%value)), 'SPRING') == 1) keyword = 'SPRING'
         end do
      end associate
   end function keyword_at

   !> Tells the valid names that are nearest; all of a short list, since it is soon read. Where they are many, the errors that are
   !> printed have them, and no others.
   subroutine tell_names(name, known, among, message)
      character(len=*), intent(in) :: name                  !< what the deck has
      type(string_t), intent(in), optional :: known(:)
      type(name_list_t), intent(in), optional :: among
      type(message_t), intent(inout) :: message
      type(string_t), allocatable :: all_names(:), more(:)
      integer :: i, n

      n = 0
      if (present(known)) n = size(known)
      if (present(among)) then
         if (among%n <= LONG_LIST .or. count_messages(SEVERITY_ERROR) < MOST_ERRORS) more = names_of(among)
      end if
      if (.not. allocated(more)) allocate (more(0))
      allocate (all_names(n + size(more)))
      do i = 1, n
         all_names(i)%s = known(i)%s
      end do
      do i = 1, size(more)
         call move_alloc(more(i)%s, all_names(n + i)%s)
      end do
      message%nearest = nearest_names(name, all_names, MOST_NEAREST)
      if (size(message%nearest) == 0 .and. size(all_names) <= SHORT_LIST) call move_alloc(all_names, message%known)
   end subroutine tell_names

end module atrito_diagnostics
