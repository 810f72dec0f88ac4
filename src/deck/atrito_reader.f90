!> Reads a deck: sources, cards and parameters, checked against the keyword table.
module atrito_reader
   use atrito_kinds, only: ip, lp
   use atrito_card_data, only: check_data
   use atrito_card_order, only: order_t, check_order, check_end
   use atrito_cards, only: make_card, check_options
   use atrito_deck, only: deck_t, card_t, token_t, KEYWORD_UNKNOWN, allocate_deck, append_source, append_token, append_line, &
                          append_card, reading_order
   use atrito_diagnostics, only: report_error, report_note, report_deck_error
   use atrito_files, only: read_file, true_path
   use atrito_items, only: option_text
   use atrito_keyword, only: keyword_t, KIND_TEXT
   use atrito_keyword_table, only: keyword_table
   use atrito_lexer, only: line_t, items_t, take_line, split_items, LINE_KEYWORD, LINE_DATA
   use atrito_memory, only: available_memory, memory_text
   use atrito_parameters, only: settings_t, read_settings, define_parameter, check_settings
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, to_text, count_symbol
   implicit none (type, external)
   private
   public :: read_deck

   !> What becomes of data lines.
   integer, parameter :: MODE_NO_KEYWORD = 0       !< an error: no keyword yet
   integer, parameter :: MODE_SKIP = 1             !< of an unknown keyword, or one without effect
   integer, parameter :: MODE_ITEMS = 2
   integer, parameter :: MODE_TEXT = 3             !< the whole line is one item
   integer, parameter :: MODE_PARAMETER = 4        !< `name = expression`

   integer, parameter :: DEEPEST_INCLUDE = 20
   !> What an item or a line takes at the most, the lists of them being copied as they double.
   integer(lp), parameter :: ITEM_BYTES = 100_lp
   !> A smaller file is not worth the question.
   integer(ip), parameter :: SMALL_FILE = 1000000
   !> Includes that each include two others would fill any memory at a depth of 20.
   integer(ip), parameter :: MOST_SOURCES = 10000
   integer(lp), parameter :: MOST_CHARACTERS = 2000000000_lp   !< of all files

   !> The reader between two lines.
   type :: reading_t
      type(settings_t) :: settings
      type(order_t) :: order
      integer :: mode = MODE_NO_KEYWORD
      integer :: depth = 0                         !< of includes
      type(items_t) :: items                       !< work space
   end type reading_t

   !> A place between two lines of a source.
   type :: cursor_t
      integer(ip) :: source = 1
      integer(ip) :: position = 1                  !< first character of the next line
      integer(ip) :: line = 0                      !< number of the last line
   end type cursor_t

contains

   !> Reads and checks a deck with all files that it includes. Its errors go to atrito_messages, all of them; the caller counts
   !> them.
   !> status: STATUS_FILE when the main file cannot be read, STATUS_USAGE when a setting is faulty or names no parameter.
   subroutine read_deck(path, settings, deck, status)
      character(len=*), intent(in) :: path             !< as the user wrote it
      type(string_t), intent(in) :: settings(:)        !< 'NAME=VALUE' of --set, in their order
      type(deck_t), intent(out) :: deck
      type(status_t), intent(out) :: status
      type(reading_t) :: reading
      character(len=:), allocatable :: text

      deck%path = path
      deck%keywords = keyword_table()
      call allocate_deck(deck)
      call read_settings(settings, reading%settings, status)
      if (is_ok(status)) call read_file(path, text, status)
      if (is_ok(status)) then
         call append_source(deck, path, text)
         call read_source(deck, reading, 1_ip)
         call finish_card(deck)
         call check_end(deck, reading%order)
         call check_settings(deck, reading%settings, status)
      end if
      call cut_to_size(deck)
   end subroutine read_deck

   subroutine cut_to_size(deck)
      type(deck_t), intent(inout) :: deck

      ! lines and tokens are many: they keep their spare room
      deck%cards = deck%cards(:deck%n_cards)
      deck%parameters = deck%parameters(:deck%n_parameters)
   end subroutine cut_to_size

   !> Reads a source to its end.
   recursive subroutine read_source(deck, reading, source)
      type(deck_t), intent(inout) :: deck
      type(reading_t), intent(inout) :: reading
      integer(ip), intent(in) :: source
      type(cursor_t) :: cursor
      type(line_t) :: line
      integer(ip) :: i
      logical :: sound

      cursor%source = source
      sound = .not. is_binary(deck, source)
      if (sound) sound = fits_memory(deck, source)
      if (.not. sound) then
         reading%order%incomplete = .true.
         return
      end if
      cursor%position = after_byte_order_mark(deck%sources(source)%text)
      do while (cursor%position <= len(deck%sources(source)%text))
         call next_line(deck, cursor, line)
         select case (line%kind)
         case (LINE_KEYWORD)
            call read_keyword_line(deck, reading, cursor, line)
         case (LINE_DATA)
            call read_data_line(deck, reading, cursor, line)
         end select
      end do
      deck%sources(source)%n_lines = cursor%line
      do i = source + 1, deck%n_sources
         if (deck%sources(i)%parent /= source) cycle
         deck%sources(source)%n_lines = deck%sources(source)%n_lines + deck%sources(i)%n_lines
      end do
   end subroutine read_source

   !> Takes the next line and reports a control character in it.
   subroutine next_line(deck, cursor, line)
      type(deck_t), intent(in) :: deck
      type(cursor_t), intent(inout) :: cursor
      type(line_t), intent(out) :: line
      integer :: code

      call take_line(deck%sources(cursor%source)%text, cursor%position, line)
      cursor%line = cursor%line + 1
      if (line%control == 0) return
      code = ichar(deck%sources(cursor%source)%text(line%control:line%control))
      call report_error(deck, token_at(cursor, line, line%control, line%control), 'E-CONTROL', &
                        'a control character, code '//to_text(code), expected='text; ends of line are LF or CR LF')
   end subroutine next_line

   pure type(token_t) function token_at(cursor, line, first, last) result(token)
      type(cursor_t), intent(in) :: cursor
      type(line_t), intent(in) :: line
      integer(ip), intent(in) :: first, last

      token%source = cursor%source
      token%line = cursor%line
      token%column = first - line%start + 1
      token%first = first
      token%last = last
   end function token_at

   !> A zero byte is in no text: the file is another thing, and reading on would only give nonsense.
   logical function is_binary(deck, source)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: source

      is_binary = count_symbol(deck%sources(source)%text, achar(0)) > 0_lp
      if (is_binary) call report_deck_error(deck, 'E-BINARY', 'not a text file', expected='a deck', source=source)
   end function is_binary

   pure integer(ip) function after_byte_order_mark(text) result(position)
      character(len=*), intent(in) :: text
      character(len=3), parameter :: MARK = char(239)//char(187)//char(191)

      position = 1
      if (index(text, MARK) == 1) position = 4
   end function after_byte_order_mark

   !> Reads a keyword line with the lines that continue it.
   recursive subroutine read_keyword_line(deck, reading, cursor, line)
      type(deck_t), intent(inout) :: deck
      type(reading_t), intent(inout) :: reading
      type(cursor_t), intent(inout) :: cursor
      type(line_t), intent(in) :: line
      type(token_t), allocatable :: items(:)
      type(card_t) :: card

      call gather_items(deck, reading, cursor, line, items)
      call make_card(deck, items, card)
      call check_order(deck, reading%order, card)
      if (card%name == 'INCLUDE') then
         call check_options(deck, card)
         call read_include(deck, reading, cursor, card)
      else
         call finish_card(deck)
         call begin_card(deck, reading, card)
      end if
   end subroutine read_keyword_line

   !> The items of a keyword line; a comma at its end goes on with the next line.
   subroutine gather_items(deck, reading, cursor, line, items)
      type(deck_t), intent(in) :: deck
      type(reading_t), intent(inout) :: reading
      type(cursor_t), intent(inout) :: cursor
      type(line_t), intent(in) :: line
      type(token_t), allocatable, intent(out) :: items(:)
      type(line_t) :: next
      type(cursor_t) :: ahead
      integer(ip) :: n
      logical :: goes_on

      allocate (items(16))
      n = 0
      next = line
      do
         call split_line(deck, reading, cursor, next)
         call add_tokens(reading%items, cursor, next, items, n)
         goes_on = deck%sources(cursor%source)%text(next%last:next%last) == ','
         if (.not. goes_on) then
            items = items(:n)
            return
         end if
         ahead = cursor
         call look_ahead(deck, ahead, next, goes_on)
         if (.not. goes_on) exit
         cursor = ahead
      end do
      items = items(:n)
      call report_error(deck, items(size(items)), 'E-CONTINUATION', 'a comma at the end of the keyword line, but no line goes on', &
                        expected='no comma, or further options')
   end subroutine gather_items

   !> The next line with something on it; found: it is no keyword line.
   subroutine look_ahead(deck, cursor, line, found)
      type(deck_t), intent(in) :: deck
      type(cursor_t), intent(inout) :: cursor
      type(line_t), intent(inout) :: line
      logical, intent(out) :: found
      type(line_t) :: next

      found = .false.
      do while (cursor%position <= len(deck%sources(cursor%source)%text))
         call next_line(deck, cursor, next)
         if (next%kind /= LINE_KEYWORD .and. next%kind /= LINE_DATA) cycle
         found = next%kind == LINE_DATA
         if (found) line = next
         return
      end do
   end subroutine look_ahead

   !> Splits a line into reading%items and reports a stray quote.
   subroutine split_line(deck, reading, cursor, line)
      type(deck_t), intent(in) :: deck
      type(reading_t), intent(inout) :: reading
      type(cursor_t), intent(in) :: cursor
      type(line_t), intent(in) :: line

      call split_items(deck%sources(cursor%source)%text, line%first, line%last, reading%items)
      if (reading%items%bad_quote > 0) then
         call report_error(deck, token_at(cursor, line, reading%items%bad_quote, reading%items%bad_quote), 'E-QUOTE', &
                           'a stray quote', expected='quotes round a whole item: "my set"')
      end if
   end subroutine split_line

   !> Appends the items of a line to a list of n so far, which doubles where it is too short.
   pure subroutine add_tokens(items, cursor, line, tokens, n)
      type(items_t), intent(in) :: items
      type(cursor_t), intent(in) :: cursor
      type(line_t), intent(in) :: line
      type(token_t), allocatable, intent(inout) :: tokens(:)
      integer(ip), intent(inout) :: n
      type(token_t), allocatable :: longer(:)
      integer(ip) :: i

      if (n + items%n > size(tokens)) then
         allocate (longer(2*(n + items%n)))
         longer(:n) = tokens(:n)
         call move_alloc(longer, tokens)
      end if
      do i = 1, items%n
         tokens(n + i) = token_at(cursor, line, items%first(i), items%last(i))
      end do
      n = n + items%n
   end subroutine add_tokens

   subroutine begin_card(deck, reading, card)
      type(deck_t), intent(inout) :: deck
      type(reading_t), intent(inout) :: reading
      type(card_t), intent(inout) :: card

      card%first_line = deck%n_lines + 1
      reading%mode = MODE_SKIP
      if (card%keyword /= KEYWORD_UNKNOWN) call judge_keyword(deck, card, deck%keywords(card%keyword))
      if (card%keyword /= KEYWORD_UNKNOWN) then
         call check_options(deck, card)
         reading%mode = mode_of(deck%keywords(card%keyword))
      end if
      call append_card(deck, card)
   end subroutine begin_card

   !> A keyword that has no effect, or none yet, is passed over with its data lines.
   subroutine judge_keyword(deck, card, keyword)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(inout) :: card
      type(keyword_t), intent(in) :: keyword

      if (keyword%built .and. .not. keyword%harmless) return
      if (keyword%harmless) then
         call report_note(deck, card%place, 'N-IGNORED', '*'//keyword%name//' has no effect')
      else
         call report_error(deck, card%place, 'E-NOT-BUILT', '*'//keyword%name//' is not built yet', keyword=keyword%name)
      end if
      card%keyword = KEYWORD_UNKNOWN
      card%name = ''
   end subroutine judge_keyword

   pure integer function mode_of(keyword) result(mode)
      type(keyword_t), intent(in) :: keyword

      mode = MODE_ITEMS
      if (keyword%name == 'PARAMETER') mode = MODE_PARAMETER
      if (mode == MODE_PARAMETER .or. size(keyword%forms) == 0) return
      if (keyword%forms(1)%items(1)%kind == KIND_TEXT) mode = MODE_TEXT
   end function mode_of

   !> Checks the data lines of the card read last.
   subroutine finish_card(deck)
      type(deck_t), intent(inout) :: deck
      type(card_t) :: card

      if (deck%n_cards == 0) return
      card = deck%cards(deck%n_cards)
      if (card%keyword /= KEYWORD_UNKNOWN) call check_data(deck, card)
   end subroutine finish_card

   subroutine read_data_line(deck, reading, cursor, line)
      type(deck_t), intent(inout) :: deck
      type(reading_t), intent(inout) :: reading
      type(cursor_t), intent(in) :: cursor
      type(line_t), intent(in) :: line
      type(token_t) :: whole
      integer(ip) :: i

      if (line%control > 0) return
      whole = token_at(cursor, line, line%first, line%last)
      select case (reading%mode)
      case (MODE_NO_KEYWORD)
         call report_error(deck, whole, 'E-DATA', 'data before the first keyword', expected='*KEYWORD')
         reading%mode = MODE_SKIP
      case (MODE_TEXT, MODE_PARAMETER)
         call append_line(deck)
         call append_token(deck, whole)
         deck%lines(deck%n_lines)%n_tokens = 1
         if (reading%mode == MODE_PARAMETER) call define_parameter(deck, whole, reading%settings)
      case (MODE_ITEMS)
         call split_line(deck, reading, cursor, line)
         call append_line(deck)
         do i = 1, reading%items%n
            call append_token(deck, token_at(cursor, line, reading%items%first(i), reading%items%last(i)))
         end do
         deck%lines(deck%n_lines)%n_tokens = reading%items%n
      end select
      if (deck%n_cards > 0) deck%cards(deck%n_cards)%n_lines = deck%n_lines - deck%cards(deck%n_cards)%first_line + 1
   end subroutine read_data_line

   !> Reads the file that an *INCLUDE names, in its place.
   recursive subroutine read_include(deck, reading, cursor, card)
      type(deck_t), intent(inout) :: deck
      type(reading_t), intent(inout) :: reading
      type(cursor_t), intent(in) :: cursor
      type(card_t), intent(in) :: card
      character(len=:), allocatable :: name, text
      type(token_t) :: place
      type(status_t) :: status
      integer(ip) :: source
      logical :: found

      call option_text(deck, card, 'INPUT', name, found, place)
      if (.not. found .or. len(name) == 0) then
         reading%order%incomplete = .true.
         return
      end if
      name = relative_path(deck%sources(cursor%source)%name, name)
      if (.not. may_include(deck, reading, cursor%source, name, place)) return
      call read_file(name, text, status)
      if (.not. is_ok(status)) then
         reading%order%incomplete = .true.
         call report_error(deck, place, 'E-INCLUDE', status%text, expected='a file, relative to the folder of '// &
                           deck%sources(cursor%source)%name, keyword='INCLUDE')
         return
      end if
      call append_source(deck, name, text)
      source = deck%n_sources
      deck%sources(source)%order = reading_order(deck, cursor%source, card%place%line)
      deck%sources(source)%parent = cursor%source
      deck%sources(source)%include_line = card%place%line
      reading%depth = reading%depth + 1
      call read_source(deck, reading, source)
      reading%depth = reading%depth - 1
   end subroutine read_include

   !> No circle, and not too deep.
   logical function may_include(deck, reading, from, name, place)
      type(deck_t), intent(in) :: deck
      type(reading_t), intent(inout) :: reading
      integer(ip), intent(in) :: from
      character(len=*), intent(in) :: name
      type(token_t), intent(in) :: place
      character(len=:), allocatable :: path
      integer(ip) :: above

      may_include = .false.
      path = true_path(name)                       ! a/../a/deck.inp is deck.inp again
      above = from
      do while (above > 0)
         if (true_path(deck%sources(above)%name) == path) exit
         above = deck%sources(above)%parent
      end do
      if (above > 0) then
         call report_error(deck, place, 'E-INCLUDE', 'the includes go in a circle: '//name//' is being read', &
                           expected='another file', keyword='INCLUDE')
      else if (reading%depth >= DEEPEST_INCLUDE) then
         call report_error(deck, place, 'E-INCLUDE', 'includes more than '//to_text(DEEPEST_INCLUDE)//' deep', keyword='INCLUDE')
      else if (deck%n_sources >= MOST_SOURCES .or. characters(deck) > MOST_CHARACTERS) then
         call report_error(deck, place, 'E-INCLUDE', 'includes of more than '//to_text(MOST_SOURCES)//' files, or 2 GB in all', &
                           keyword='INCLUDE')
      else
         may_include = .true.
      end if
      if (.not. may_include) reading%order%incomplete = .true.
   end function may_include

   !> Characters of all files so far.
   pure integer(lp) function characters(deck) result(n)
      type(deck_t), intent(in) :: deck
      integer(ip) :: i

      n = 0_lp
      do i = 1, deck%n_sources
         n = n + len(deck%sources(i)%text, kind=lp)
      end do
   end function characters

   !> The path of a file relative to the folder of another one, without `./`.
   pure function relative_path(from, name) result(path)
      character(len=*), intent(in) :: from, name
      character(len=:), allocatable :: path

      path = name
      do while (index(path, './') == 1 .and. len(path) > 2)
         path = path(3:)
         do while (path(1:1) == '/' .and. len(path) > 1)
            path = path(2:)                        ! .//a is no absolute path
         end do
      end do
      if (path(1:1) /= '/') path = from(:index(from, '/', back=.true.))//path
   end function relative_path

   !> False, and an error, when the items of a file need more memory than there is.
   logical function fits_memory(deck, source) result(fits)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(in) :: source
      integer(lp) :: items, memory

      fits = len(deck%sources(source)%text) <= SMALL_FILE
      if (fits) return
      items = count_symbol(deck%sources(source)%text, ',') + count_symbol(deck%sources(source)%text, achar(10))
      memory = available_memory()
      fits = ITEM_BYTES*items <= memory
      if (.not. fits) call report_deck_error(deck, 'E-MEMORY', 'a file of '//to_text(items)//' items and lines needs about '// &
                                             memory_text(ITEM_BYTES*items)//' of memory, there are '//memory_text(memory), &
                                             expected='a smaller deck, or a larger machine; *BLOCK, *NGEN and *ELGEN save lines', &
                                             source=source)
   end function fits_memory

end module atrito_reader
