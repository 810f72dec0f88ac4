!> A deck as it was read: source texts, the places of their items, cards and parameters.
!>
!> The texts are kept whole and an item is only a place in one of them, so that a large deck is read without a copy and every
!> later message can show where it comes from.
module atrito_deck
   use atrito_edits, only: edits_t
   use atrito_foreign_keywords, only: subject_t, take_subjects
   use atrito_gmsh_mesh, only: gmsh_mesh_t, move_mesh
   use atrito_kinds, only: ip, lp, wp
   use atrito_growth, only: make_room_in => make_room
   use atrito_keyword, only: keyword_t, LEVEL_MODEL, LEVEL_STEP
   use atrito_lexer, only: trim_place
   use atrito_name_list, only: name_list_t
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: source_t, token_t, option_t, card_t, data_line_t, scope_t, parameter_t, deck_t
   public :: KEYWORD_UNKNOWN, LEVEL_MODEL, LEVEL_STEP
   public :: token_text, is_empty_token, is_quoted, is_id_token, keyword_name, count_lines, line_item, last_item, &
             reading_order, take_source_line, part_of, scope_shift, scope_text, model_number
   public :: after_byte_order_mark
   public :: allocate_deck, make_room, append_source, note_include, append_token, append_line, append_card, append_mesh

   !> A card whose keyword is not in the table, is not built or has no effect here; already reported.
   integer, parameter :: KEYWORD_UNKNOWN = 0

   type :: source_t
      character(len=:), allocatable :: name        !< FILE as the user wrote it
      character(len=:), allocatable :: text        !< the whole file; not allocated once it is given away
      integer(ip) :: parent = 0                    !< source that includes this one; 0: the deck itself
      integer(ip) :: include_line = 0              !< line of it that does
      integer(ip) :: include_first = 1, include_last = 0 !< characters of that one's text that its *INCLUDE takes, whole lines
      logical :: is_mesh = .false.                 !< of another program: *INCLUDE, TYPE=GMSH
      integer(ip) :: n_lines = 0                   !< with those of the files that it includes
      integer(ip) :: order = 0                     !< lines read before its first
      integer(lp) :: identity(2) = -1_lp           !< of the file, whatever its name
      integer(ip) :: n_children = 0                !< sources that it includes
      integer(ip), allocatable :: children(:)      !< sources that it includes, in their order; the first n_children are in use
   end type source_t

   !> The place of an item. An empty item has last < first; `first` is where it should stand.
   type :: token_t
      integer(ip) :: source = 0                    !< index in deck%sources; 0: no place
      integer(ip) :: scope = 0                     !< of a number or a name: whose it is, index in deck%scopes
      integer(ip) :: line = 0, column = 0          !< from 1
      integer(ip) :: first = 1, last = 0           !< characters of sources(source)%text, with the quotes
   end type token_t

   !> NAME or NAME=VALUE behind a keyword.
   type :: option_t
      type(token_t) :: name                        !< before the equals sign
      type(token_t) :: value                       !< behind it; empty where has_value is false
      logical :: has_value = .false.               !< there is an equals sign
      integer :: spec = 0                          !< in the options of the keyword's definition; 0: unknown; -1: foreign
   end type option_t

   type :: card_t
      integer :: keyword = KEYWORD_UNKNOWN         !< index in deck%keywords
      character(len=32) :: name = ''               !< as in the table, e.g. 'CONTACT PAIR'; blank: KEYWORD_UNKNOWN
      type(token_t) :: place                       !< the keyword itself
      type(option_t), allocatable :: options(:)    !< in the order of the keyword line
      integer(ip) :: first_line = 1                !< deck%lines(first_line : first_line + n_lines - 1)
      integer(ip) :: n_lines = 0                   !< data lines; 0: none
      integer :: level = LEVEL_MODEL               !< where it stands: LEVEL_MODEL or LEVEL_STEP
      integer(ip) :: step = 0                      !< in which it stands; 0: none
      integer(ip) :: block = 0                     !< the *PART or *INSTANCE in which it stands, counted; 0: none
      integer(ip) :: scope = 0                     !< whose it is, index in deck%scopes
      logical :: ok = .true.                       !< nothing wrong with its keyword line
      character(len=32) :: meant = ''              !< then the keyword that is nearest, if any
      logical :: is_ignored = .false.              !< of other programs, without effect
      logical :: is_refused = .false.              !< refused by name: passed over with its data lines
      logical :: changes_model = .false.           !< a keyword that changes the model in a step, which is refused
      logical :: is_outside = .false.              !< the same, and without it nothing of the scene is left
      integer :: subject = 0                       !< of what is outside, see atrito_foreign_keywords; 0: of none of them
   end type card_t

   type :: data_line_t
      integer(ip) :: first_token = 1               !< deck%tokens(first_token : first_token + n_tokens - 1)
      integer(ip) :: n_tokens = 0                  !< items, empty ones among them
      logical :: ok = .true.                       !< the number of items is right and the words are known
   end type data_line_t

   !> An instance of a part, or (0) the assembly with all that stands outside of parts. The numbers of nodes and elements in it
   !> begin at 1 again, its sets and surfaces have names of their own.
   type :: scope_t
      character(len=:), allocatable :: name        !< of the instance; the assembly: ''
      integer(ip) :: card = 0                      !< *INSTANCE, index in deck%cards
      integer(ip) :: shift = 0                     !< added to its numbers, which makes them those of the model
      integer(ip) :: span = huge(1_ip)             !< no number of it is greater
      logical :: ok = .true.                       !< if not, that is reported
   end type scope_t

   type :: parameter_t
      character(len=:), allocatable :: name        !< as in the deck, without case
      real(wp) :: value = 0.0_wp                   !< 0 where it is not known
      type(token_t) :: place                       !< where it is defined
      type(token_t) :: expression                  !< what stands behind the equals sign
      integer(ip) :: order = 0                     !< in reading order
      logical :: known = .false.                   !< its expression has a value; if not, that is reported
      logical :: overridden = .false.              !< by --set
   end type parameter_t

   !> The arrays have spare room: n_lines, n_tokens ... count. cards and parameters are cut to size when the deck is read.
   type :: deck_t
      character(len=:), allocatable :: path           !< of the main file, as the user wrote it
      type(source_t), allocatable :: sources(:)       !< files, the deck itself first
      type(card_t), allocatable :: cards(:)           !< in reading order, later in that of the instances
      type(data_line_t), allocatable :: lines(:)      !< data lines of all cards
      type(token_t), allocatable :: tokens(:)         !< items of all lines
      type(parameter_t), allocatable :: parameters(:) !< in the order of their definitions
      type(name_list_t) :: parameter_names            !< in their order
      type(keyword_t), allocatable :: keywords(:)     !< the keyword table: heads, and the definitions of those that the deck has
      type(string_t), allocatable :: definitions(:)   !< its lines
      type(subject_t), allocatable :: subjects(:)     !< what lies outside, by other programs' names
      logical :: has_lost_parameters = .false.        !< definitions that could not be read: an unknown one may be among them
      logical :: is_outside = .false.                 !< a scene that atrito does not solve: what only follows is not reported
      integer :: subject = 0                          !< of the elements that it does not solve
      type(gmsh_mesh_t), allocatable :: meshes(:)     !< of *INCLUDE, TYPE=GMSH, in their order
      type(edits_t) :: edits                          !< what is replaced when the deck is written as it was run
      type(scope_t), allocatable :: scopes(:)         !< (0:instances); not allocated: a deck without parts
      logical :: is_read = .false.                    !< its cards are all there
      integer(ip) :: n_sources = 0, n_cards = 0, n_lines = 0, n_tokens = 0, n_parameters = 0 !< in use
   end type deck_t

   character(len=1), parameter :: LINE_FEED = achar(10), CARRIAGE_RETURN = achar(13)

contains

   !> The characters of an item, without its quotes; a name of an instance is `instance.name`.
   pure function token_text(deck, token) result(text)
      type(deck_t), intent(in) :: deck   !< texts and instances are read
      type(token_t), intent(in) :: token !< of the item; may be empty
      character(len=:), allocatable :: text

      if (is_empty_token(token)) then
         text = ''
      else if (is_quoted(deck, token)) then
         text = deck%sources(token%source)%text(token%first + 1:token%last - 1)
      else
         text = deck%sources(token%source)%text(token%first:token%last)
      end if
      if (token%scope == 0 .or. is_id_token(deck, token)) return
      if (len(text) > 0 .and. index(text, '-<') /= 1) text = deck%scopes(token%scope)%name//'.'//text
   end function token_text

   !> What makes the number that an item is one of the model.
   pure integer(ip) function scope_shift(deck, token) result(shift)
      type(deck_t), intent(in) :: deck   !< instances are read
      type(token_t), intent(in) :: token !< of a number

      shift = 0
      if (allocated(deck%scopes)) shift = deck%scopes(token%scope)%shift
   end function scope_shift

   !> The number in the model; 0 where it is greater than any of its scope.
   pure integer(ip) function model_number(deck, token, number)
      type(deck_t), intent(in) :: deck                 !< instances are read
      type(token_t), intent(in) :: token               !< of the number
      integer(ip), intent(in) :: number                !< as written

      model_number = number
      if (.not. allocated(deck%scopes)) return
      associate (scope => deck%scopes(token%scope))
         model_number = merge(min(number, scope%span) + scope%shift, 0_ip, number > 0 .and. number <= scope%span)
      end associate
   end function model_number

   !> ` of <instance>`; '' where there is none.
   pure function scope_text(deck, token) result(text)
      type(deck_t), intent(in) :: deck   !< instances are read
      type(token_t), intent(in) :: token !< of a number or a name
      character(len=:), allocatable :: text

      text = ''
      if (token%scope > 0) text = ' of '//deck%scopes(token%scope)%name
   end function scope_text

   !> The item at some characters of another one, without the blanks round them.
   pure function part_of(deck, token, first, last) result(part)
      type(deck_t), intent(in) :: deck       !< texts are read
      type(token_t), intent(in) :: token     !< the item that the part is in
      integer(ip), intent(in) :: first, last !< characters of the source
      type(token_t) :: part

      part = token
      part%first = first
      part%last = last
      call trim_place(deck%sources(token%source)%text, part%first, part%last)
      part%column = token%column + part%first - token%first
   end function part_of

   !> Whether nothing stands there: an item between two commas, for example.
   elemental logical function is_empty_token(token)
      type(token_t), intent(in) :: token !< of an item

      is_empty_token = token%last < token%first
   end function is_empty_token

   !> The item stands in "quotes".
   pure logical function is_quoted(deck, token)
      type(deck_t), intent(in) :: deck   !< texts are read
      type(token_t), intent(in) :: token !< of an item

      is_quoted = .false.
      if (token%last <= token%first) return
      associate (first => token%first, last => token%last)
         is_quoted = deck%sources(token%source)%text(first:first) == '"' .and. deck%sources(token%source)%text(last:last) == '"'
      end associate
   end function is_quoted

   !> The item is the number of a node or element, not the name of a set: all digits, or a parameter.
   pure logical function is_id_token(deck, token)
      type(deck_t), intent(in) :: deck   !< texts are read
      type(token_t), intent(in) :: token !< of an item

      is_id_token = .false.
      if (is_empty_token(token)) return
      associate (first => token%first, last => token%last)
         is_id_token = verify(deck%sources(token%source)%text(first:last), '0123456789') == 0 &
                       .or. deck%sources(token%source)%text(first:first) == '<'
      end associate
   end function is_id_token

   !> Name of a card's keyword as in the table, for `select case`; '' when the card is to be passed over.
   pure function keyword_name(card) result(name)
      type(card_t), intent(in) :: card !< its name is read
      character(len=:), allocatable :: name

      name = trim(card%name)
   end function keyword_name

   !> The i-th item of a data line; beyond the last one an empty item with its place.
   pure function line_item(deck, line, i) result(token)
      type(deck_t), intent(in) :: deck      !< items are read
      type(data_line_t), intent(in) :: line !< that has one item at least
      integer(ip), intent(in) :: i          !< 1, 2, ...
      type(token_t) :: token

      if (i <= line%n_tokens) then
         token = deck%tokens(line%first_token + i - 1)
      else
         token = last_item(deck, line)
         token%column = token%column + token%last - token%first + 1
         token%first = token%last + 1
         token%last = token%first - 1
      end if
   end function line_item

   !> How many data lines all cards of a keyword have.
   pure integer(ip) function count_lines(deck, keyword) result(n)
      type(deck_t), intent(in) :: deck        !< cards are read
      character(len=*), intent(in) :: keyword !< as in the table
      integer(ip) :: i

      n = 0
      do i = 1, deck%n_cards
         if (keyword_name(deck%cards(i)) == keyword) n = n + deck%cards(i)%n_lines
      end do
   end function count_lines

   !> The last item of a data line that has some.
   pure function last_item(deck, line) result(token)
      type(deck_t), intent(in) :: deck      !< items are read
      type(data_line_t), intent(in) :: line !< that has one item at least
      type(token_t) :: token

      token = deck%tokens(line%first_token + line%n_tokens - 1)
   end function last_item

   !> The line's number in reading order, included files in their place.
   pure integer(ip) function reading_order(deck, source, line) result(order)
      type(deck_t), intent(in) :: deck        !< sources and what they include
      integer(ip), intent(in) :: source, line !< place in sources; line of it
      integer(ip) :: before, behind, middle

      order = deck%sources(source)%order + line
      if (deck%sources(source)%n_children == 0) return
      before = 0                                   ! the last file that is included above the line: by halves
      behind = deck%sources(source)%n_children + 1
      do while (behind - before > 1)
         middle = (before + behind)/2
         if (deck%sources(deck%sources(source)%children(middle))%include_line < line) then
            before = middle
         else
            behind = middle
         end if
      end do
      if (before == 0) return
      associate (file => deck%sources(deck%sources(source)%children(before)))
         order = file%order + file%n_lines + line - file%include_line
      end associate
   end function reading_order

   !> Makes a source one that another one includes, behind those that it includes already.
   pure subroutine note_include(deck, source, parent, line)
      type(deck_t), intent(inout) :: deck          !< the source gets its place in reading order
      integer(ip), intent(in) :: source, parent    !< places in sources
      integer(ip), intent(in) :: line              !< of the parent, in which it is included

      deck%sources(source)%order = reading_order(deck, parent, line)
      deck%sources(source)%parent = parent
      deck%sources(source)%include_line = line
      associate (above => deck%sources(parent))
         call make_room_in(above%children, above%n_children, above%n_children + 1)
         above%n_children = above%n_children + 1
         above%children(above%n_children) = source
      end associate
   end subroutine note_include

   !> The line of the deck in which an item stands; of a long line the part that reaches so many characters to both sides of the
   !> item's beginning (a line may have as many characters as the deck, and a thousand messages keep theirs).
   pure subroutine take_source_line(deck, token, reach, line, skipped)
      type(deck_t), intent(in) :: deck                   !< texts are read
      type(token_t), intent(in) :: token                 !< of the item
      integer(ip), intent(in) :: reach                   !< characters on each side, >= 0
      character(len=:), allocatable, intent(out) :: line !< without its end
      integer(ip), intent(out) :: skipped                !< characters of the line before this part of it
      integer(ip) :: first, last, length

      skipped = max(0, token%column - 1 - reach)
      first = token%first - token%column + 1 + skipped
      associate (text => deck%sources(token%source)%text)
         last = min(len(text), token%first + reach)
         line = ''
         if (first > last) return
         length = scan(text(first:last), LINE_FEED) - 1
         if (length < 0) length = last - first + 1
         if (length > 0) then
            if (text(first + length - 1:first + length - 1) == CARRIAGE_RETURN) length = length - 1
         end if
         line = text(first:first + length - 1)
      end associate
   end subroutine take_source_line

   !> The first character of a text behind the mark that some editors put before it.
   pure integer(ip) function after_byte_order_mark(text) result(position)
      character(len=*), intent(in) :: text !< of a file, may be empty
      character(len=3), parameter :: MARK = char(239)//char(187)//char(191)

      position = 1
      if (index(text(:min(len(text), len(MARK))), MARK) == 1) position = 1 + len(MARK)
   end function after_byte_order_mark

   !> An empty deck, with room to grow: a list that is full doubles, and what its second half holds is written over.
   subroutine allocate_deck(deck)
      type(deck_t), intent(inout) :: deck !< nothing allocated in it

      allocate (deck%sources(4), deck%cards(64), deck%lines(256), deck%tokens(1024), deck%parameters(16), deck%meshes(0))
      call take_subjects(deck%subjects)
   end subroutine allocate_deck

   !> Room for more items and lines, made once: a list that doubles is there three times while it does.
   subroutine make_room(deck, items, lines)
      type(deck_t), intent(inout) :: deck     !< lists become longer, what is in them stays
      integer(ip), intent(in) :: items, lines !< that are going to be added
      type(token_t), allocatable :: tokens(:)
      type(data_line_t), allocatable :: longer(:)

      if (deck%n_tokens + items > size(deck%tokens)) then
         allocate (tokens(deck%n_tokens + items))
         tokens(:deck%n_tokens) = deck%tokens(:deck%n_tokens)
         call move_alloc(tokens, deck%tokens)
      end if
      if (deck%n_lines + lines <= size(deck%lines)) return
      allocate (longer(deck%n_lines + lines))
      longer(:deck%n_lines) = deck%lines(:deck%n_lines)
      call move_alloc(longer, deck%lines)
   end subroutine make_room

   !> Adds a text as a source of the deck: a file, or what stands in the place of one. Places in the deck name it by its number.
   subroutine append_source(deck, name, text, identity)
      type(deck_t), intent(inout) :: deck                    !< the source is its last one
      character(len=*), intent(in) :: name                   !< of the file, as the user wrote it
      character(len=:), allocatable, intent(inout) :: text   !< moved into the deck
      integer(lp), intent(in), optional :: identity(2)       !< of the file
      type(source_t), allocatable :: longer(:)
      integer(ip) :: i

      if (deck%n_sources == size(deck%sources)) then
         allocate (longer(2*deck%n_sources))
         do i = 1, deck%n_sources
            call move_source(deck%sources(i), longer(i))
         end do
         call move_alloc(longer, deck%sources)
      end if
      deck%n_sources = deck%n_sources + 1
      deck%sources(deck%n_sources)%name = name
      call move_alloc(text, deck%sources(deck%n_sources)%text)
      if (present(identity)) deck%sources(deck%n_sources)%identity = identity
   end subroutine append_source

   !> Moves the text instead of copying it.
   subroutine move_source(from, to)
      type(source_t), intent(inout) :: from, to

      call move_alloc(from%name, to%name)
      call move_alloc(from%text, to%text)
      to%parent = from%parent
      to%include_line = from%include_line
      to%include_first = from%include_first
      to%include_last = from%include_last
      to%is_mesh = from%is_mesh
      to%n_lines = from%n_lines
      to%order = from%order
      to%identity = from%identity
      to%n_children = from%n_children
      call move_alloc(from%children, to%children)
   end subroutine move_source

   !> Adds a token behind those of the deck. Those of a card or a line stand one behind the other.
   subroutine append_token(deck, token)
      type(deck_t), intent(inout) :: deck !< gets one item more
      type(token_t), intent(in) :: token  !< of the last line or card

      if (deck%n_tokens == size(deck%tokens)) call make_room(deck, deck%n_tokens/2 + 1_ip, 0_ip)
      deck%n_tokens = deck%n_tokens + 1
      deck%tokens(deck%n_tokens) = token
   end subroutine append_token

   !> Appends a data line of no items yet; append_token adds them.
   subroutine append_line(deck)
      type(deck_t), intent(inout) :: deck !< gets one line more

      if (deck%n_lines == size(deck%lines)) call make_room(deck, 0_ip, deck%n_lines/2 + 1_ip)
      deck%n_lines = deck%n_lines + 1
      deck%lines(deck%n_lines) = data_line_t(first_token=deck%n_tokens + 1)
   end subroutine append_line

   !> Adds a keyword line with its options; its data lines follow.
   subroutine append_card(deck, card)
      type(deck_t), intent(inout) :: deck !< gets one card more
      type(card_t), intent(in) :: card    !< with its options; lines are not there yet

      if (deck%n_cards == size(deck%cards)) deck%cards = [deck%cards, deck%cards]
      deck%n_cards = deck%n_cards + 1
      deck%cards(deck%n_cards) = card
   end subroutine append_card

   !> The last card names this mesh.
   subroutine append_mesh(deck, mesh)
      type(deck_t), intent(inout) :: deck              !< gets one mesh more, of its last card
      type(gmsh_mesh_t), intent(inout) :: mesh         !< moved into the deck
      type(gmsh_mesh_t), allocatable :: longer(:)
      integer :: i, n

      n = size(deck%meshes)
      allocate (longer(n + 1))
      do i = 1, n
         call move_mesh(deck%meshes(i), longer(i))
      end do
      mesh%card = deck%n_cards
      call move_mesh(mesh, longer(n + 1))
      call move_alloc(longer, deck%meshes)
   end subroutine append_mesh

end module atrito_deck
