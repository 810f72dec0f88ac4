!> A deck in parts becomes one without: in the place of each instance stand the cards of its part, whose numbers and names are the
!> instance's own. The first instance of a part takes the items of the part as they are, further ones copies of them. Items are
!> places in the text, so a message about any instance points into the part.
module atrito_instances
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t, scope_t, is_empty_token, append_card, append_line, append_token
   use atrito_diagnostics, only: report_error, report_note
   use atrito_items, only: has_option, option_text, option_word
   use atrito_kinds, only: ip, lp
   use atrito_memory, only: available_memory, memory_text
   use atrito_name_list, only: name_list_t, add_name, find_name
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_strings, only: same_name, to_text
   implicit none (type, external)
   private
   public :: expand_instances

   !> A part: deck%cards(first:last), *PART and *END PART not among them.
   type :: part_t
      integer(ip) :: card = 0                      !< *PART
      integer(ip) :: first = 1, last = 0           !< cards in it
      logical :: is_taken = .false.                !< its items are those of an instance
   end type part_t

   type :: parts_t
      type(name_list_t) :: names                   !< of parts, without case
      type(part_t), allocatable :: list(:)         !< in the order of the names
      type(name_list_t) :: instances               !< in the order of deck%scopes
      character(len=:), allocatable :: assembly    !< name of the assembly; '' without one
      logical :: is_undetermined = .false.         !< of some part the name is not known
      logical :: is_nameless = .false.             !< of some instance the name is not known
   end type parts_t

   !> What an item or a line more takes at the most, the lists of them being copied as they double.
   integer(lp), parameter :: ITEM_BYTES = 120_lp
   !> More than this is a slip of the pen.
   integer(ip), parameter :: MOST_CARDS = 10000000, MOST_ITEMS = 1000000000

   !> Numbers of an instance begin behind a multiple of this, or of a greater power of ten.
   integer(lp), parameter :: LEAST_ROUND = 100_lp

contains

   !> Puts the parts of a deck into their places. n_blocks: how many parts and instances were read.
   subroutine expand_instances(deck, n_blocks)
      type(deck_t), intent(inout) :: deck !< its cards are put in the order of the model
      integer(ip), intent(in) :: n_blocks !< where it is 0 nothing is expanded
      type(parts_t) :: parts
      type(card_t), allocatable :: cards(:)
      integer(ip) :: i, n

      if (n_blocks > 0) then
         n = deck%n_cards
         call list_parts()
         call list_instances(deck, parts)
         if (.not. fits_memory(deck, parts)) deck%scopes(1:)%ok = .false.
         call move_alloc(deck%cards, cards)
         allocate (deck%cards(n))
         deck%n_cards = 0
         call place_cards(deck, cards(:n), parts)
         call number_scopes(deck)
         call note_unused()
      end if
      do i = 1, deck%n_cards
         call take_instance_option(deck, deck%cards(i), parts)
      end do

   contains

      !> Names and cards of all parts, and the name of the assembly.
      subroutine list_parts()
         character(len=:), allocatable :: name
         type(token_t) :: place
         type(part_t), allocatable :: list(:)
         integer(ip), allocatable :: last(:)
         integer(ip) :: i, n
         logical :: found

         ! the last card that belongs to each block, *END PART not among them
         allocate (last(0:max(0_ip, maxval(deck%cards(:deck%n_cards)%block))), source=0_ip)
         do i = 1, deck%n_cards
            last(deck%cards(i)%block) = merge(i - 1, i, deck%cards(i)%name == 'END PART')
         end do
         allocate (list(count(deck%cards(:deck%n_cards)%name == 'PART')))
         n = 0
         parts%assembly = ''
         do i = 1, deck%n_cards
            select case (deck%cards(i)%name)
            case ('ASSEMBLY')
               call option_text(deck, deck%cards(i), 'NAME', parts%assembly, found)
            case ('PART')
               call option_text(deck, deck%cards(i), 'NAME', name, found, place)
               if (.not. found .or. len(name) == 0) then
                  parts%is_undetermined = .true.
               else if (find_name(parts%names, name) > 0) then
                  call report_twice(deck, place, deck%cards(list(find_name(parts%names, name))%card)%place, 'part', name)
               else
                  call add_name(parts%names, name)
                  n = n + 1
                  list(n) = part_t(i, i + 1, last(deck%cards(i)%block))
               end if
            end select
         end do
         parts%list = list(:n)
      end subroutine list_parts

      !> A part without an instance is left out; a deck without any instance is an error.
      subroutine note_unused()
         integer(ip) :: i
         logical :: all_known

         if (size(deck%scopes) == 1) then
            call report_error(deck, cards(findloc(cards%name, 'PART', dim=1))%place, 'E-PART', &
                              'the deck has parts, but no *INSTANCE of any', &
                              expected='*ASSEMBLY, *INSTANCE, NAME=, PART=, *END INSTANCE, *END ASSEMBLY', keyword='INSTANCE')
            return
         end if
         all_known = all(deck%scopes%ok)
         do i = 1, size(parts%list, kind=ip)
            if (parts%list(i)%is_taken .or. .not. all_known) cycle
            call report_note(deck, cards(parts%list(i)%card)%place, 'N-PART', 'no *INSTANCE has this part: nothing of it is in '// &
                             'the scene', keyword='INSTANCE')
         end do
      end subroutine note_unused
   end subroutine expand_instances

   !> A scope for each instance, one that is faulty too: what refers to it is passed over in silence.
   subroutine list_instances(deck, parts)
      type(deck_t), intent(inout) :: deck
      type(parts_t), intent(inout) :: parts
      type(scope_t), allocatable :: scopes(:)
      type(token_t) :: place
      integer(ip) :: i, n
      logical :: found

      allocate (scopes(0:count(deck%cards(:deck%n_cards)%name == 'INSTANCE')))
      scopes(0)%name = ''
      n = 0
      do i = 1, deck%n_cards
         if (deck%cards(i)%name /= 'INSTANCE') cycle
         n = n + 1
         scopes(n)%card = i
         scopes(n)%ok = deck%cards(i)%ok
         call option_text(deck, deck%cards(i), 'NAME', scopes(n)%name, found, place)
         if (find_name(parts%instances, scopes(n)%name) > 0 .and. found) then
            scopes(n)%ok = .false.
            parts%is_nameless = .true.
            call report_twice(deck, place, deck%cards(scopes(find_name(parts%instances, scopes(n)%name))%card)%place, &
                              'instance', scopes(n)%name)
         end if
         call add_name(parts%instances, scopes(n)%name)
         if (part_of(deck, deck%cards(i), parts, is_told=.true.) == 0) scopes(n)%ok = .false.
         deck%cards(i)%ok = scopes(n)%ok
         parts%is_nameless = parts%is_nameless .or. .not. found
      end do
      call move_alloc(scopes, deck%scopes)
   end subroutine list_instances

   subroutine report_twice(deck, place, earlier, noun, name)
      type(deck_t), intent(in) :: deck
      type(token_t), intent(in) :: place, earlier
      character(len=*), intent(in) :: noun, name

      call report_error(deck, place, 'E-TWICE', noun//' '//name//' is defined twice, first in line '//to_text(earlier%line), &
                        expected='a name that no other '//noun//' has')
   end subroutine report_twice

   !> The part of which a card makes an instance; 0: it is unknown, which is reported where `is_told`.
   integer(ip) function part_of(deck, card, parts, is_told) result(part)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(parts_t), intent(in) :: parts
      logical, intent(in) :: is_told
      character(len=:), allocatable :: name
      type(token_t) :: place
      logical :: found

      part = 0
      call option_text(deck, card, 'PART', name, found, place)
      if (.not. found) return
      part = find_name(parts%names, name)
      if (part > 0 .or. parts%is_undetermined .or. .not. is_told) return
      call report_error(deck, place, 'E-PART', 'unknown part '//name, expected='name of a part of this deck', &
                        among=parts%names, keyword='INSTANCE')
   end function part_of

   !> False, and an error, when the copies need more memory than there is.
   logical function fits_memory(deck, parts) result(fits)
      type(deck_t), intent(in) :: deck
      type(parts_t), intent(in) :: parts
      integer(lp) :: items, cards, memory
      integer(ip) :: s, p, i, last

      fits = size(deck%scopes) == 1
      if (fits) return
      items = 0
      cards = deck%n_cards
      do s = 1, size(deck%scopes, kind=ip) - 1
         p = part_of(deck, deck%cards(deck%scopes(s)%card), parts, is_told=.false.)
         if (p == 0) cycle
         cards = cards + parts%list(p)%last - parts%list(p)%first + 1
         do i = parts%list(p)%first, parts%list(p)%last
            associate (card => deck%cards(i))
               if (card%n_lines == 0) cycle
               last = card%first_line + card%n_lines - 1
               items = items + card%n_lines + deck%lines(last)%first_token + deck%lines(last)%n_tokens &
                       - deck%lines(card%first_line)%first_token
            end associate
         end do
      end do
      memory = available_memory()
      fits = cards <= MOST_CARDS .and. ITEM_BYTES*items <= memory .and. items < MOST_ITEMS - deck%n_tokens
      if (.not. fits) call report_error(deck, deck%cards(deck%scopes(1)%card)%place, 'E-MEMORY', 'instances of '// &
                                        to_text(items)//' items in all need about '//memory_text(ITEM_BYTES*items)//' of memory', &
                                        expected='fewer instances, or a larger machine', keyword='INSTANCE')
   end function fits_memory

   !> All cards in their places: those of parts stand behind their *INSTANCE.
   subroutine place_cards(deck, cards, parts)
      type(deck_t), intent(inout) :: deck          !< without cards
      type(card_t), intent(in) :: cards(:)
      type(parts_t), intent(inout) :: parts
      integer(ip) :: i, s, scope, part, instance_block

      s = 0
      instance_block = 0
      do i = 1, size(cards, kind=ip)
         if (cards(i)%name == 'INSTANCE') then
            s = s + 1
            deck%scopes(s)%card = deck%n_cards + 1
            instance_block = cards(i)%block
            call append_card(deck, cards(i))
            part = part_of(deck, cards(i), parts, is_told=.false.)
            if (part > 0 .and. deck%scopes(s)%ok) call place_part(parts%list(part), s)
         else if (cards(i)%block == 0 .or. cards(i)%block == instance_block) then
            scope = merge(s, 0_ip, cards(i)%block > 0 .and. cards(i)%block == instance_block)
            call append_card(deck, cards(i))
            call mark_card(deck, deck%cards(deck%n_cards), scope)
            if (scope == 0) call find_owners(deck%cards(deck%n_cards))
         end if
      end do

   contains

      subroutine place_part(part, scope)
         type(part_t), intent(inout) :: part
         integer(ip), intent(in) :: scope
         type(card_t) :: card
         integer(ip) :: i

         do i = part%first, part%last
            if (cards(i)%block /= cards(part%card)%block) cycle
            card = cards(i)
            if (part%is_taken) call copy_lines(deck, card)
            call append_card(deck, card)
            call mark_card(deck, deck%cards(deck%n_cards), scope)
         end do
         part%is_taken = .true.
      end subroutine place_part

      !> Outside of parts, `instance.name`, `instance.12` and `assembly.instance.name` are the instance's.
      subroutine find_owners(card)
         type(card_t), intent(inout) :: card
         integer(ip) :: i, k
         integer :: o

         if (any(card%name == [character(len=9) :: 'HEADING', 'PARAMETER', 'UNITS', 'OBSERVE'])) return
         do o = 1, size(card%options)
            if (card%options(o)%has_value) call find_owner(card%options(o)%value)
         end do
         do i = card%first_line, card%first_line + card%n_lines - 1
            do k = deck%lines(i)%first_token, deck%lines(i)%first_token + deck%lines(i)%n_tokens - 1
               call find_owner(deck%tokens(k))
            end do
         end do
      end subroutine find_owners

      pure subroutine find_owner(token)
         type(token_t), intent(inout) :: token
         integer(ip) :: dot, scope
         integer :: k, quoted

         do k = 1, 2
            if (is_empty_token(token)) return
            associate (text => deck%sources(token%source)%text(token%first:token%last))
               quoted = merge(1, 0, text(1:1) == '"')     ! "my part-1".top
               dot = index(text, trim(merge('".', '. ', quoted == 1))) + quoted
               if (dot < 2 + 2*quoted .or. dot == len(text)) return
               scope = find_name(parts%instances, text(1 + quoted:dot - 1 - quoted))
               if (scope == 0 .and. .not. same_name(text(1 + quoted:dot - 1 - quoted), parts%assembly)) return
            end associate
            token%first = token%first + dot
            token%column = token%column + dot
            token%scope = scope
            if (scope > 0) return
         end do
      end subroutine find_owner
   end subroutine place_cards

   !> Gives a card lines and items of its own.
   subroutine copy_lines(deck, card)
      type(deck_t), intent(inout) :: deck
      type(card_t), intent(inout) :: card
      type(data_line_t) :: line
      type(token_t) :: token
      integer(ip) :: i, k, first

      first = deck%n_lines + 1
      do i = card%first_line, card%first_line + card%n_lines - 1
         line = deck%lines(i)
         call append_line(deck)
         do k = line%first_token, line%first_token + line%n_tokens - 1
            token = deck%tokens(k)                       ! a copy: the list may move while it grows
            call append_token(deck, token)
         end do
         line%first_token = deck%lines(deck%n_lines)%first_token
         deck%lines(deck%n_lines) = line
      end do
      card%first_line = first
   end subroutine copy_lines

   !> The numbers and names of a card are those of a scope.
   subroutine mark_card(deck, card, scope)
      type(deck_t), intent(inout) :: deck
      type(card_t), intent(inout) :: card
      integer(ip), intent(in) :: scope
      integer(ip) :: i, k, n
      integer :: o

      card%scope = scope
      if (scope == 0 .or. len_trim(card%name) == 0) return
      do o = 1, size(card%options)
         if (card%options(o)%spec <= 0) cycle           ! unknown, or of other programs
         select case (deck%keywords(card%keyword)%options(card%options(o)%spec)%name)
         case ('NSET', 'ELSET', 'NAME', 'ORIENTATION', 'REF NODE', 'ANALYTICAL SURFACE') ! materials are of the whole deck
            card%options(o)%value%scope = scope
         end select
      end do
      ! How many items at the beginning of each line of a card are numbers or names of the block in which it stands.
      select case (card%name)
      case ('NODE', 'ELGEN', 'NODAL THICKNESS')
         n = 1
      case ('NGEN', 'NFILL')
         n = 2
      case ('ELEMENT', 'NSET', 'ELSET', 'EQUATION')
         n = merge(0_ip, huge(1_ip), has_option(deck, card, 'AT'))
      case ('SURFACE')
         n = merge(0_ip, 1_ip, option_word(deck, card, 'TYPE') == 'SEGMENTS')
      case default
         n = 0
      end select
      do i = card%first_line, card%first_line + card%n_lines - 1
         do k = deck%lines(i)%first_token, deck%lines(i)%first_token + min(n, deck%lines(i)%n_tokens) - 1
            deck%tokens(k)%scope = scope
         end do
      end do
   end subroutine mark_card

   !> The members of a set with INSTANCE= are those of the instance, its name is that of the assembly.
   subroutine take_instance_option(deck, card, parts)
      type(deck_t), intent(inout) :: deck
      type(card_t), intent(inout) :: card
      type(parts_t), intent(in) :: parts
      character(len=:), allocatable :: name
      type(token_t) :: place
      integer(ip) :: scope, i, k
      logical :: found

      if (card%name /= 'NSET' .and. card%name /= 'ELSET') return
      call option_text(deck, card, 'INSTANCE', name, found, place)
      if (.not. found) return
      scope = find_name(parts%instances, name)
      if (scope == 0 .and. .not. parts%is_nameless) then
         call report_error(deck, place, 'E-PART', 'unknown instance '//name, expected='name of an *INSTANCE', &
                           among=parts%instances, keyword=trim(card%name))
      end if
      card%ok = card%ok .and. scope > 0
      if (has_option(deck, card, 'AT')) return          ! of places
      do i = card%first_line, card%first_line + card%n_lines - 1
         if (scope == 0) deck%lines(i)%ok = .false.
         do k = deck%lines(i)%first_token, deck%lines(i)%first_token + deck%lines(i)%n_tokens - 1
            deck%tokens(k)%scope = scope
         end do
      end do
   end subroutine take_instance_option

   !> The numbers of a deck in parts: those of each instance begin at 1 again, in the model each node and element has one of its
   !> own.
   !>
   !> The first scope with nodes keeps its numbers. To those of the next ones a power of ten is added, its double and so on: the
   !> least power that is greater than any number; or, where there is no room for that, what fits.
   subroutine number_scopes(deck)
      type(deck_t), intent(inout) :: deck !< its scopes get `shift` and `span`
      integer(ip) :: greatest(0:size(deck%scopes) - 1), order(size(deck%scopes)), i, n
      integer(lp) :: round, shift, spans(size(deck%scopes))

      n = size(order, kind=ip)
      call find_numbers(deck, greatest, order)
      round = LEAST_ROUND
      do while (round <= maxval(greatest))
         round = 10_lp*round
      end do
      spans = round - 1_lp
      if (n*round > int(huge(1_ip), lp)) spans = greatest(order)
      shift = 0_lp
      do i = 1, n
         deck%scopes(order(i))%shift = int(min(shift, int(huge(1_ip), lp)), ip)
         deck%scopes(order(i))%span = int(min(spans(i), huge(1_ip) - shift), ip)
         shift = shift + spans(i)
         if (spans(i) == round - 1_lp) shift = shift + 1_lp
      end do
      if (shift > int(huge(1_ip), lp)) call report_error(deck, deck%cards(deck%scopes(1)%card)%place, 'E-ID', &
                                                         'the numbers of all instances do not fit one behind the other', &
                                                         expected='less than 2147483647 in all', keyword='INSTANCE')
   end subroutine number_scopes

   !> The greatest number of a node or element of each scope, and the scopes in the order of their first nodes.
   subroutine find_numbers(deck, greatest, order)
      type(deck_t), intent(in) :: deck
      integer(ip), intent(out) :: greatest(0:)
      integer(ip), intent(out) :: order(:)
      logical :: has_nodes(0:size(greatest) - 1)
      integer(ip) :: i, k, n

      greatest = 0
      has_nodes = .false.
      n = 0
      do i = 1, deck%n_cards
         associate (card => deck%cards(i))
            select case (card%name)
            case ('NODE', 'ELEMENT', 'ELGEN')
               do k = card%first_line, card%first_line + card%n_lines - 1
                  greatest(card%scope) = max(greatest(card%scope), greatest_of(deck, card, deck%lines(k)))
               end do
            end select
            if (card%name /= 'NODE' .or. has_nodes(card%scope)) cycle
            has_nodes(card%scope) = .true.
            n = n + 1
            order(n) = card%scope
         end associate
      end do
      do i = 0, size(greatest, kind=ip) - 1
         if (has_nodes(i)) cycle
         n = n + 1
         order(n) = i
      end do
   end subroutine find_numbers

   !> The greatest number that a line makes.
   pure integer(ip) function greatest_of(deck, card, line) result(greatest)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(data_line_t), intent(in) :: line
      integer(lp) :: last
      integer(ip) :: k

      last = max(integer_of(deck, line, 1_ip, 0_ip), 0)
      if (card%name == 'ELGEN') then
         do k = 2, line%n_tokens, 3
            last = last + (int(integer_of(deck, line, k, 1_ip), lp) - 1_lp)*int(integer_of(deck, line, k + 2, 1_ip), lp)
         end do
      end if
      greatest = int(max(0_lp, min(last, int(huge(1_ip), lp))), ip)
   end function greatest_of

   !> An item that is a plain integer; another value where it is none.
   pure integer(ip) function integer_of(deck, line, i, default) result(number)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: i, default
      type(token_t) :: token
      integer :: outcome

      number = default
      if (i > line%n_tokens) return
      token = deck%tokens(line%first_token + i - 1)
      if (token%last < token%first) return
      call read_integer(deck%sources(token%source)%text(token%first:token%last), number, outcome)
      if (outcome /= NUMBER_OK) number = default
   end function integer_of

end module atrito_instances
