!> The message store: errors, warnings and notes of a run, in one place.
!>
!> Together with the timers the only module state of the program. Deck errors carry a place and are printed as a compiler
!> prints them; numerical warnings carry none. The listing repeats all of them; as JSON a
!> message is one object on one line, docs/user/messages.schema.json.
module atrito_messages
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, append_string, begins_with, break_line, ends_with, join, to_text
   use atrito_utf8, only: visible, disturbs, utf8_length
   implicit none (type, external)
   private
   public :: message_t, add_message, add_warning, add_note, has_room, count_messages, get_message, clear_messages, sort_messages
   public :: message_mark_t, mark_messages, forget_messages
   public :: format_message, place_of_message, severity_word, json_of_message, json_text
   public :: SEVERITY_ERROR, SEVERITY_WARNING, SEVERITY_NOTE, MOST_ERRORS, WIDEST_SOURCE, ID_OUTSIDE

   integer, parameter :: SEVERITY_ERROR = 1, SEVERITY_WARNING = 2, SEVERITY_NOTE = 3
   integer, parameter :: MOST_ERRORS = 50       !< errors printed; the rest is counted
   integer(ip), parameter :: MOST_KEPT = 1000   !< messages of a severity kept; the rest is counted
   character(len=*), parameter :: ID_OUTSIDE = 'E-OUTSIDE'
   integer, parameter :: WIDEST_SOURCE = 100    !< characters shown of a longer line of the deck
   integer, parameter :: LEAST_WIDTH = 40       !< of lines that are broken

   type :: message_t
      integer :: severity = SEVERITY_ERROR      !< one of SEVERITY_...
      character(len=:), allocatable :: id       !< short stable name, e.g. E-NUMBER
      character(len=:), allocatable :: text     !< what is wrong
      character(len=:), allocatable :: file     !< as the user wrote it; not allocated: no place at all
      integer(ip) :: line = 0, column = 0       !< 0: no place within the file
      integer(ip) :: length = 1                 !< characters under the marker
      character(len=:), allocatable :: source   !< the deck's line, or the part of it round the place
      integer(ip) :: skipped = 0                !< characters of the line before that part
      character(len=:), allocatable :: expected !< what was expected, with its dimension
      type(string_t), allocatable :: nearest(:) !< nearest valid names
      type(string_t), allocatable :: known(:)   !< all valid names, when they are few
      character(len=:), allocatable :: keyword  !< for `atrito help KEYWORD`
      logical :: is_of_place = .false.          !< given once a place, whatever its text
      integer(ip) :: order = huge(1_ip)         !< place in reading order: messages are printed in it
      integer(ip) :: more = 0                   !< how many lines more it is true of
   end type message_t

   !> How many messages there were at some time.
   type :: message_mark_t
      integer(ip) :: stored = 0                                !< messages in the store
      integer(ip) :: counted(SEVERITY_ERROR:SEVERITY_NOTE) = 0 !< of each severity, those that were not kept, too
   end type message_mark_t

   type(message_t), allocatable :: store(:)
   integer(ip) :: stored = 0
   integer(ip) :: counted(SEVERITY_ERROR:SEVERITY_NOTE) = 0

contains

   !> Keeps a message. One that says the same of the same place is kept once, a name that is unknown where it stands first,
   !> and a note or a refusal that says the same of another line with a count. When a thousand of its severity are kept, it is
   !> counted only (a large deck can be wrong in every line).
   subroutine add_message(message)
      type(message_t), intent(in) :: message !< with severity, id and text at least
      integer(ip) :: i

      if (.not. has_room(message%severity)) then
         counted(message%severity) = counted(message%severity) + 1
         return
      end if
      if (.not. allocated(store)) allocate (store(16))
      do i = 1, stored
         if (is_same(store(i), message)) then
            if (message%order < store(i)%order) store(i) = message
            return
         end if
         if (.not. is_same_kind(store(i), message)) cycle
         store(i)%more = store(i)%more + 1
         return
      end do
      if (stored == size(store)) store = [store, store]    ! doubled
      stored = stored + 1
      store(stored) = message
      counted(message%severity) = counted(message%severity) + 1
   end subroutine add_message

   !> Another message of this severity would be kept, not only counted.
   logical function has_room(severity)
      integer, intent(in) :: severity !< one of SEVERITY_...

      has_room = counted(severity) < MOST_KEPT
   end function has_room

   pure logical function is_same(a, b)
      type(message_t), intent(in) :: a, b

      is_same = a%severity == b%severity .and. a%line == b%line .and. a%column == b%column .and. a%order == b%order
      if (is_same .and. b%is_of_place .and. b%line > 0) then
         is_same = a%id == b%id
         return
      end if
      if (a%text /= b%text) then                   ! asked first: a deck can be wrong in every line
         is_same = .false.
      else if (.not. is_same) then
         is_same = a%severity == b%severity .and. tells_a_name(a)
      end if
   end function is_same

   !> Of other lines the same need not be said again: what has no effect, and what is refused by its name.
   pure logical function is_same_kind(a, b)
      type(message_t), intent(in) :: a, b

      is_same_kind = a%severity == b%severity .and. min(a%line, b%line) > 0
      if (.not. is_same_kind) return
      is_same_kind = a%severity == SEVERITY_NOTE .or. a%id == ID_OUTSIDE
      if (is_same_kind) is_same_kind = a%id == b%id .and. a%text == b%text
   end function is_same_kind

   !> The message is about a name or number that does not exist, not about the place where it stands: it is missing once.
   pure logical function tells_a_name(message)
      type(message_t), intent(in) :: message
      character(len=*), parameter :: IDS = ' E-NODE E-ELEMENT E-SET E-SURFACE E-MATERIAL E-INTERACTION E-AMPLITUDE E-PARAMETER '// &
                                     'E-EXPRESSION E-PART '
      character(len=*), parameter :: UNKNOWN = 'unknown ', MISSING = ' does not exist'

      tells_a_name = .false.
      if (.not. (allocated(message%id) .and. allocated(message%text))) return
      if (index(IDS, ' '//message%id//' ') == 0) return
      tells_a_name = begins_with(message%text, UNKNOWN) .or. ends_with(message%text, MISSING)
   end function tells_a_name

   !> A warning without a place.
   subroutine add_warning(id, text)
      character(len=*), intent(in) :: id, text !< short stable name; what is wrong

      call add_message(message_t(severity=SEVERITY_WARNING, id=id, text=text))
   end subroutine add_warning

   !> A note without a place.
   subroutine add_note(id, text)
      character(len=*), intent(in) :: id, text !< short stable name; what is told

      call add_message(message_t(severity=SEVERITY_NOTE, id=id, text=text))
   end subroutine add_note

   !> How many messages of one severity there were; without it, how many are kept and can be fetched.
   integer(ip) function count_messages(severity) result(n)
      integer, intent(in), optional :: severity !< one of SEVERITY_...

      n = stored
      if (present(severity)) n = counted(severity)
   end function count_messages

   !> The i-th message, 1 <= i <= count_messages().
   function get_message(i) result(message)
      integer(ip), intent(in) :: i !< place in the store
      type(message_t) :: message

      message = store(i)
   end function get_message

   !> Forgets all: a new deck begins.
   subroutine clear_messages()
      if (allocated(store)) deallocate (store)
      stored = 0
      counted = 0
   end subroutine clear_messages

   !> Marks the messages that there are now.
   function mark_messages() result(mark)
      type(message_mark_t) :: mark

      mark = message_mark_t(stored, counted)
   end function mark_messages

   !> Forgets the messages since a mark; the messages must not have been sorted in between.
   subroutine forget_messages(mark)
      type(message_mark_t), intent(in) :: mark !< of the messages before; it is not later than now

      stored = mark%stored
      counted = mark%counted
   end subroutine forget_messages

   !> Puts the messages into the order of the deck; those without a place keep theirs at the end.
   subroutine sort_messages()
      integer(ip) :: place(stored), i, j, held

      place = [(i, i=1, stored)]
      do i = 2, stored
         held = place(i)
         j = i - 1
         do while (j >= 1)
            associate (a => store(place(j)), b => store(held))
               if (a%order < b%order .or. (a%order == b%order .and. a%column <= b%column)) exit
            end associate
            place(j + 1) = place(j)
            j = j - 1
         end do
         place(j + 1) = held
      end do
      if (stored > 0) store = store(place)
   end subroutine sort_messages

   !> The lines of a message as they are printed, docs/user/messages.md.
   function format_message(message, width) result(lines)
      type(message_t), intent(in) :: message        !< as it was added
      integer, intent(in), optional :: width        !< columns, where lines are broken
      type(string_t), allocatable :: lines(:)
      character(len=:), allocatable :: text
      integer :: i, columns

      allocate (lines(0))
      columns = huge(columns)
      if (present(width)) columns = max(width, LEAST_WIDTH)
      text = place_of_message(message)//severity_word(message%severity)//' ['//message%id//'] '//message%text
      if (message%more > 0) text = text//' (and '//to_text(message%more)//' more '// &
                                   trim(merge('line ', 'lines', message%more == 1))//')'
      call append_broken(lines, '', text, 4, columns)
      if (allocated(message%source) .and. message%column > 0) then
         call append_source(lines, message, int(min(WIDEST_SOURCE, columns - 10)))
      end if
      if (allocated(message%expected)) call append_broken(lines, '    expected: ', message%expected, 14, columns)
      if (allocated(message%nearest)) then
         if (size(message%nearest) > 0) call append_broken(lines, '    nearest:  ', join(message%nearest, ', '), 14, columns)
      end if
      if (allocated(message%known)) then
         if (size(message%known) > 0) call append_broken(lines, '    known:    ', join(message%known, ', '), 14, columns)
      end if
      if (allocated(message%keyword)) call append_string(lines, '    see:      atrito help '//message%keyword)
      do i = 1, size(lines)
         lines(i)%s = visible(lines(i)%s)             ! names and paths are the user's
      end do
   end function format_message

   !> A text behind its label, broken into lines of a width; those behind the first one have a margin.
   subroutine append_broken(lines, label, text, margin, width)
      type(string_t), allocatable, intent(inout) :: lines(:)
      character(len=*), intent(in) :: label, text
      integer, intent(in) :: margin, width
      integer :: first, last, next

      first = 1
      call break_line(trim(text), width - max(len(label), 1), first, last, next)
      call append_string(lines, label//text(:last))
      do while (next <= len_trim(text))
         first = next
         call break_line(trim(text), width - margin - 1, first, last, next)
         call append_string(lines, repeat(' ', margin)//text(first:last))
      end do
   end subroutine append_broken

   !> `FILE:LINE:COLUMN: `, what stands before the word of the severity; empty where there is no place at all.
   pure function place_of_message(message) result(text)
      type(message_t), intent(in) :: message !< as it was added
      character(len=:), allocatable :: text

      text = ''
      if (.not. allocated(message%file)) return
      text = message%file//':'
      if (message%line > 0) text = text//to_text(message%line)//':'//to_text(max(message%column, 1_ip))//':'
      text = text//' '
   end function place_of_message

   !> A severity as messages begin with it: `error`, `warning` or `note`.
   pure function severity_word(severity) result(word)
      integer, intent(in) :: severity               !< SEVERITY_...
      character(len=:), allocatable :: word
      character(len=7), parameter :: WORDS(SEVERITY_NOTE) = ['error  ', 'warning', 'note   ']

      word = trim(WORDS(severity))
   end function severity_word

   !> The deck's line and the marker below it; of a long line the part round the marker.
   subroutine append_source(lines, message, widest)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(message_t), intent(in) :: message
      integer, intent(in) :: widest                 !< characters of it
      character(len=:), allocatable :: before, after, shown
      integer :: first, last, length, column

      column = message%column - message%skipped
      first = 1
      last = len(message%source)
      if (last > widest) then
         first = max(1, min(column - widest/2, last - widest + 1))
         last = min(last, first + widest - 1)
      end if
      before = repeat('.', merge(3, 0, first > 1))
      after = repeat('.', merge(3, 0, last < len(message%source)))
      length = max(1, min(message%length, last - column + 1))
      shown = visible(message%source(first:last))    ! blanks for tabs, so that the marker stands below its place
      call append_string(lines, '    '//before//shown//after)
      call append_string(lines, '    '//before//marker(shown, column - first + 1, length))
   end subroutine append_source

   !> The marker under characters of a line: `^~~`.
   pure function marker(source, column, length) result(text)
      character(len=*), intent(in) :: source
      integer, intent(in) :: column, length
      character(len=:), allocatable :: text
      integer :: last

      last = min(len(source), column + length - 1)
      text = repeat(' ', column - 1 - continuations(source(:min(column - 1, len(source)))))//'^'
      text = text//repeat('~', max(0, length - 1 - continuations(source(column:last))))
   end function marker

   !> Bytes that continue a character of UTF-8: they take no room on the screen.
   pure integer function continuations(text) result(n)
      character(len=*), intent(in) :: text
      integer :: i

      n = 0
      do i = 1, len(text)
         if (iand(ichar(text(i:i)), 192) == 128) n = n + 1
      end do
   end function continuations

   !> All members are there, always; what a message has not is null.
   function json_of_message(message) result(line)
      type(message_t), intent(in) :: message !< as it was added
      character(len=:), allocatable :: line
      logical :: has_place

      has_place = message%line > 0
      line = '{"severity":"'//severity_word(message%severity)//'"'//text_member('id', message%id)// &
             text_member('file', message%file)//number_member('line', message%line, has_place)// &
             number_member('column', max(message%column, 1_ip), has_place)// &
             number_member('length', max(message%length, 1_ip), has_place)//text_member('text', message%text)// &
             text_member('expected', message%expected)//list_member('nearest', message%nearest)// &
             list_member('known', message%known)//text_member('keyword', message%keyword)// &
             text_member('source', message%source)//number_member('skipped', message%skipped, allocated(message%source))// &
             number_member('more', message%more, .true.)//'}'
   end function json_of_message

   pure function text_member(name, text) result(member)
      character(len=*), intent(in) :: name
      character(len=*), intent(in), optional :: text
      character(len=:), allocatable :: member

      member = 'null'
      if (present(text)) member = json_text(text)
      member = ',"'//name//'":'//member
   end function text_member

   pure function number_member(name, number, is_there) result(member)
      character(len=*), intent(in) :: name
      integer(ip), intent(in) :: number
      logical, intent(in) :: is_there
      character(len=:), allocatable :: member

      member = 'null'
      if (is_there) member = to_text(number)
      member = ',"'//name//'":'//member
   end function number_member

   !> An empty list tells nothing: null.
   pure function list_member(name, list) result(member)
      character(len=*), intent(in) :: name
      type(string_t), intent(in), optional :: list(:)
      character(len=:), allocatable :: member
      integer :: i

      member = ''
      if (present(list)) then
         do i = 1, size(list)
            member = member//','//json_text(list(i)%s)
         end do
      end if
      if (len(member) == 0) then
         member = 'null'
      else
         member = '['//member(2:)//']'
      end if
      member = ',"'//name//'":'//member
   end function list_member

   !> A text in quotes. Bytes that are not UTF-8 are taken for Latin-1: the text of a deck may be anything, JSON is UTF-8.
   pure function json_text(text) result(quoted)
      character(len=*), intent(in) :: text !< any bytes
      character(len=:), allocatable :: quoted
      integer :: i, n

      quoted = '"'
      i = 1
      do while (i <= len(text))
         n = utf8_length(text(i:))
         if (n > 1 .and. disturbs(text(i:i + max(n, 1) - 1))) then
            quoted = quoted//escaped_code(text(i:i + n - 1))
         else if (n > 1) then
            quoted = quoted//text(i:i + n - 1)
         else
            quoted = quoted//escaped(text(i:i))
         end if
         i = i + max(n, 1)
      end do
      quoted = quoted//'"'
   end function json_text

   !> The code of a character of two or three bytes.
   pure function escaped_code(symbol) result(text)
      character(len=*), intent(in) :: symbol
      character(len=6) :: text
      integer :: code, i

      code = iand(ichar(symbol(1:1)), merge(31, 15, len(symbol) == 2))
      do i = 2, len(symbol)
         code = 64*code + iand(ichar(symbol(i:i)), 63)
      end do
      write (text, '(a, z4.4)') '\u', code
   end function escaped_code

   !> One byte that is a character by itself.
   pure function escaped(symbol) result(text)
      character(len=1), intent(in) :: symbol
      character(len=:), allocatable :: text
      character(len=6) :: code

      text = symbol
      if (symbol == '"' .or. symbol == '\') then
         text = '\'//symbol
      else if (ichar(symbol) < 32 .or. ichar(symbol) >= 127) then
         write (code, '(a, z4.4)') '\u', ichar(symbol)
         text = code
      end if
   end function escaped

end module atrito_messages
