!> Reads a deck: sources, cards and parameters, checked against the keyword table.
module atrito_reader
   use atrito_kinds, only: ip, lp
   use atrito_card_data, only: check_data
   use atrito_card_order, only: order_t, check_order, check_end
   use atrito_cards, only: make_card, check_options, has_options
   use atrito_deck, only: deck_t, card_t, token_t, KEYWORD_UNKNOWN, allocate_deck, make_room, append_source, &
                          after_byte_order_mark, append_token, append_line, append_card, append_mesh, note_include
   use atrito_diagnostics, only: report_error, report_deck_error
   use atrito_files, only: read_file
   use atrito_gmsh_file, only: read_gmsh_text
   use atrito_gmsh_mesh, only: gmsh_mesh_t, fault_t
   use atrito_includes, only: path_of_include, may_include, is_told
   use atrito_instances, only: expand_instances
   use atrito_items, only: has_option, option_text, option_word
   use atrito_keyword, only: KIND_TEXT
   use atrito_keyword_table, only: define_keyword, take_table
   use atrito_lexer, only: line_t, items_t, take_line, split_items, count_data_lines, LINE_COMMENT, LINE_KEYWORD, LINE_DATA
   use atrito_memory, only: available_memory, memory_text
   use atrito_deck_as_run, only: note_edits
   use atrito_plain_lines, only: take_plain_lines
   use atrito_parameters, only: settings_t, read_settings, define_parameter, check_settings
   use atrito_status, only: status_t, set_status, is_ok, STATUS_FILE
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

   !> What an item or a line takes at the most.
   integer(lp), parameter :: ITEM_BYTES = 40_lp
   !> Room for items and lines that stand behind a large file, so that the lists of all need not become longer.
   integer(ip), parameter :: BEHIND = 4096_ip
   !> A smaller file is not worth the question.
   integer(ip), parameter :: SMALL_FILE = 1000000

   !> The reader between two lines.
   type :: reading_t
      type(settings_t) :: settings                 !< of --set
      type(order_t) :: order                       !< steps and parts so far
      integer :: mode = MODE_NO_KEYWORD            !< MODE_*
      integer :: depth = 0                         !< of includes
      type(status_t) :: refusal                    !< of the first include that is no plain file, or may not be read
      logical :: may_be_plain = .false.            !< the next lines may be a run of plain ones
      type(items_t) :: items                       !< work space
   end type reading_t

   !> A place between two lines of a source.
   type :: cursor_t
      integer(ip) :: source = 1                    !< place in deck%sources
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
      type(deck_t), intent(out) :: deck                !< with what could be read of it
      type(status_t), intent(out) :: status            !< OK, although the deck may have errors
      type(reading_t) :: reading
      character(len=:), allocatable :: text
      integer(lp) :: identity(2)

      deck%path = path
      call take_table(deck%definitions, deck%keywords)
      call allocate_deck(deck)
      call read_settings(settings, reading%settings, status)
      if (is_ok(status)) call read_file(path, text, status, identity=identity)
      if (is_ok(status)) then
         call append_source(deck, path, text, identity)
         call read_source(deck, reading, 1_ip)
         call finish_card(deck)
         call check_end(deck, reading%order)
         call note_edits(deck)
         call expand_instances(deck, reading%order%parts%n_blocks)
         call check_settings(deck, reading%settings, status)
         if (.not. is_ok(reading%refusal)) status = reading%refusal
      end if
      ! lines and tokens are many: they keep their spare room
      deck%cards = deck%cards(:deck%n_cards)
      deck%parameters = deck%parameters(:deck%n_parameters)
      deck%is_read = .true.
   end subroutine read_deck

   !> Reads a source to its end.
   recursive subroutine read_source(deck, reading, source)
      type(deck_t), intent(inout) :: deck
      type(reading_t), intent(inout) :: reading
      integer(ip), intent(in) :: source
      type(cursor_t) :: cursor
      type(line_t) :: line
      integer(ip) :: i
      logical :: sound, is_binary

      cursor%source = source
      ! A zero byte is in no text: the file is another thing, and reading on would only give nonsense.
      is_binary = count_symbol(deck%sources(source)%text, achar(0)) > 0_lp
      if (is_binary) call report_deck_error(deck, 'E-BINARY', 'not a text file', expected='a deck', source=source)
      sound = .not. is_binary
      if (sound) sound = fits_memory(deck, source)
      if (.not. sound) then
         reading%order%incomplete = .true.
         return
      end if
      cursor%position = after_byte_order_mark(deck%sources(source)%text)
      do while (cursor%position <= len(deck%sources(source)%text))
         if (reading%may_be_plain) then
            ! Takes many data lines at once, where they are plain; what ends them is read line by line.
            reading%may_be_plain = .false.
            call take_plain_lines(deck, cursor%source, cursor%position, cursor%line)
            deck%cards(deck%n_cards)%n_lines = deck%n_lines - deck%cards(deck%n_cards)%first_line + 1
            cycle
         end if
         call next_line(deck, cursor, line)
         select case (line%kind)
         case (LINE_KEYWORD)
            call read_keyword_line(deck, reading, cursor, line)
         case (LINE_DATA)
            call read_data_line()
         end select
         reading%may_be_plain = reading%mode == MODE_ITEMS .and. (line%kind == LINE_KEYWORD .or. line%kind == LINE_COMMENT)
      end do
      deck%sources(source)%n_lines = cursor%line
      do i = 1, deck%sources(source)%n_children
         deck%sources(source)%n_lines = deck%sources(source)%n_lines + deck%sources(deck%sources(source)%children(i))%n_lines
      end do

   contains

      subroutine read_data_line()
         type(token_t) :: whole
         integer(ip) :: i

         if (line%control > 0 .and. reading%mode /= MODE_ITEMS) return
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
            deck%lines(deck%n_lines)%ok = reading%items%bad_quote == 0 .and. line%control == 0
         end select
         if (deck%n_cards > 0) deck%cards(deck%n_cards)%n_lines = deck%n_lines - deck%cards(deck%n_cards)%first_line + 1
      end subroutine read_data_line
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

   !> Reads a keyword line with the lines that continue it.
   recursive subroutine read_keyword_line(deck, reading, cursor, line)
      type(deck_t), intent(inout) :: deck
      type(reading_t), intent(inout) :: reading
      type(cursor_t), intent(inout) :: cursor
      type(line_t), intent(in) :: line
      type(token_t), allocatable :: items(:)
      type(card_t) :: card

      call gather_items(items)
      call make_card(deck, items, card)
      if (card%keyword /= KEYWORD_UNKNOWN) call define_keyword(deck%definitions, deck%keywords(card%keyword))
      call check_order(deck, reading%order, card)
      if (card%name == 'INCLUDE') then
         call check_options(deck, card)
         call read_include(deck, reading, cursor, card)
      else
         call finish_card(deck)
         call begin_card()
      end if

   contains

      !> The items of a keyword line; a comma at its end goes on with the next line, if that has options.
      subroutine gather_items(items)
         type(token_t), allocatable, intent(out) :: items(:)
         type(line_t) :: next
         type(cursor_t) :: ahead
         integer(ip) :: n, i
         logical :: goes_on

         allocate (items(16))
         n = 0
         next = line
         associate (text => deck%sources(cursor%source)%text)
            do
               call split_line(deck, reading, cursor, next)
               ! Appends the items of a line to a list of n so far, which doubles where it is too short.
               do while (n + reading%items%n > size(items))
                  items = [items, items]
               end do
               do i = 1, reading%items%n
                  items(n + i) = token_at(cursor, next, reading%items%first(i), reading%items%last(i))
               end do
               n = n + reading%items%n
               if (text(next%last:next%last) /= ',') exit
               ahead = cursor
               call look_ahead(deck, ahead, next, goes_on)
               if (goes_on) goes_on = has_options(deck, text(items(1)%first:items(1)%last), text(next%first:next%last))
               if (.not. goes_on) exit
               cursor = ahead
            end do
         end associate
         items = items(:n)
      end subroutine gather_items

      subroutine begin_card()

         card%first_line = deck%n_lines + 1
         reading%mode = MODE_SKIP
         if (card%keyword /= KEYWORD_UNKNOWN) then
            call check_options(deck, card)
            reading%mode = MODE_ITEMS
            associate (forms => deck%keywords(card%keyword)%forms)
               if (size(forms) > 0) reading%mode = merge(MODE_TEXT, MODE_ITEMS, forms(1)%items(1)%kind == KIND_TEXT)
            end associate
            if (card%name == 'PARAMETER') reading%mode = MODE_PARAMETER
         else if (card%meant == 'NODE' .or. card%meant == 'ELEMENT') then
            reading%mode = MODE_ITEMS                     ! the numbers of its lines are not unknown, they are lost
         else if (card%meant == 'PARAMETER') then
            deck%has_lost_parameters = .true.
         end if
         if (card%is_refused) then
            reading%mode = MODE_SKIP
            card%keyword = KEYWORD_UNKNOWN
            card%name = ''
         end if
         deck%is_outside = deck%is_outside .or. card%is_outside
         if (deck%subject == 0) deck%subject = card%subject
         call append_card(deck, card)
      end subroutine begin_card
   end subroutine read_keyword_line

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

   !> Checks the data lines of the card read last.
   subroutine finish_card(deck)
      type(deck_t), intent(inout) :: deck
      type(card_t) :: card

      if (deck%n_cards == 0) return
      card = deck%cards(deck%n_cards)
      if (card%keyword /= KEYWORD_UNKNOWN) call check_data(deck, card)
      if (card%n_lines == deck%cards(deck%n_cards)%n_lines) return
      deck%cards(deck%n_cards)%n_lines = card%n_lines
      deck%n_lines = card%first_line + card%n_lines - 1
   end subroutine finish_card

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
      integer(lp) :: identity(2)
      logical :: found, is_plain
      type(card_t) :: failed

      call option_text(deck, card, 'INPUT', name, found, place)
      found = found .and. len(name) > 0 .and. (card%ok .or. .not. has_option(deck, card, 'TYPE'))
      if (found) then
         name = path_of_include(deck%sources(cursor%source)%name, name)
         found = may_include(deck, reading%depth, cursor%source, name, place)
      end if
      if (found) then
         call read_file(name, text, status, is_plain, identity)
         found = is_ok(status)
         if (.not. is_plain .and. is_ok(reading%refusal)) then   ! no error of the deck: the run ends with it
            call set_status(reading%refusal, STATUS_FILE, deck%sources(place%source)%name//', line '//to_text(place%line)// &
                            ': '//status%text)
         end if
         if (.not. found) call report_error(deck, place, 'E-INCLUDE', status%text, expected='a file, relative to the folder of '// &
                                            deck%sources(cursor%source)%name, keyword='INCLUDE')
      end if
      if (found) found = is_told(deck, card, text, place)
      if (.not. found) then
         ! What the file would have defined is not known: the card says so.
         reading%order%incomplete = .true.
         call finish_card(deck)
         reading%mode = MODE_SKIP
         failed = card
         failed%ok = .false.
         failed%first_line = deck%n_lines + 1
         call append_card(deck, failed)
         return
      end if
      call append_source(deck, name, text, identity)
      source = deck%n_sources
      call note_include(deck, source, cursor%source, card%place%line)
      deck%sources(source)%include_first = card%place%first - card%place%column + 1
      deck%sources(source)%include_last = min(cursor%position - 1, len(deck%sources(cursor%source)%text, kind=ip))
      if (option_word(deck, card, 'TYPE') == 'GMSH') then
         call read_mesh_file()
         return
      end if
      reading%depth = reading%depth + 1
      call read_source(deck, reading, source)
      reading%depth = reading%depth - 1

   contains

      !> A mesh in a file of another program. Messages of what stands in it name the *INCLUDE.
      subroutine read_mesh_file()
         type(card_t) :: mesh_card
         type(gmsh_mesh_t) :: mesh
         type(fault_t) :: fault

         call finish_card(deck)
         mesh%file = deck%sources(source)%name
         deck%sources(source)%is_mesh = .true.
         call read_gmsh_text(deck%sources(source)%text, mesh, fault)
         mesh_card = card
         mesh_card%first_line = deck%n_lines + 1
         mesh_card%ok = card%ok .and. .not. allocated(fault%text)
         reading%mode = MODE_ITEMS
         call append_card(deck, mesh_card)
         if (allocated(fault%text)) then
            call report_error(deck, token_t(source, 0_ip, fault%line, fault%column, fault%first, fault%last), 'E-GMSH', &
                              fault%text, expected=fault%expected, keyword='INCLUDE')
         end if
         deck%sources(source)%n_lines = int(count_symbol(deck%sources(source)%text, achar(10)), ip)
         call append_mesh(deck, mesh)
      end subroutine read_mesh_file
   end subroutine read_include

   !> Makes room for the items of a large file. False, and an error, when they need more memory than there is.
   logical function fits_memory(deck, source) result(fits)
      type(deck_t), intent(inout) :: deck
      integer(ip), intent(in) :: source
      integer(lp) :: items, lines, memory

      fits = len(deck%sources(source)%text) <= SMALL_FILE
      if (fits) return
      lines = count_data_lines(deck%sources(source)%text)
      items = count_symbol(deck%sources(source)%text, ',') + lines
      memory = available_memory()
      fits = ITEM_BYTES*items <= memory
      if (fits) then
         call make_room(deck, int(items, ip) + BEHIND, int(lines, ip) + BEHIND)
      else
         call report_deck_error(deck, 'E-MEMORY', 'a file of '//to_text(items)//' items and lines needs about '// &
                                memory_text(ITEM_BYTES*items)//' of memory, there are '//memory_text(memory), &
                                expected='a smaller deck, or a larger machine; *BLOCK, *NGEN and *ELGEN save lines', source=source)
      end if
   end function fits_memory

end module atrito_reader
