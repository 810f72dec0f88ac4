!> What the builders share while a model grows: the deck, the model so far, and what nobody needs afterwards, as places in the deck,
!> and which names and numbers an error has invalid.
!>
!> One mistake, one message: whoever refers to a thing whose definition was faulty is passed over in silence. Silence is allowed
!> only once an error has been reported, so a deck is never accepted with something left out.
module atrito_build_context
   use atrito_build_parts, only: drawn_lines_t, open_step_t, inherited_t, replaced_t, numbered_t, block_t, section_cut_t, &
                                 node_finder_t, BLOCK_SIDES, LOOSE_HELD, LOOSE_RELEASED, LOOSE_MOVES, curve_list_t, line_list_t
   use atrito_deck, only: deck_t, card_t, token_t, data_line_t, token_text, is_empty_token, line_item, keyword_name, scope_shift, &
                          scope_text, model_number
   use atrito_diagnostics, only: report_error
   use atrito_faces, only: face_list_t, node_elements_t
   use atrito_growth, only: make_room
   use atrito_id_map, only: id_map_t, add_id
   use atrito_items, only: option_text
   use atrito_joined_blocks, only: joined_blocks_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_messages, only: count_messages, SEVERITY_ERROR
   use atrito_model, only: model_t
   use atrito_coordinates, only: motion_t
   use atrito_sets, only: part_place_name
   use atrito_name_list, only: name_list_t, add_name, find_name, has_name
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_refinement, only: refinement_t
   use atrito_strings, only: lower_case, same_name, to_text
   implicit none (type, external)
   private
   public :: LOOSE_HELD, LOOSE_RELEASED, LOOSE_MOVES
   public :: build_context_t, open_step_t, inherited_t, replaced_t, numbered_t, block_t, section_cut_t, node_finder_t
   public :: BLOCK_SIDES
   public :: prepare_context, add_context_block, note_undetermined_mesh, line_token, open_line
   public :: invalidate_block, invalidate_name, spoil_number, is_invalid, is_undetermined, has_errors, has_lost_elements
   public :: place_token, place_text, note_number, note_place, note_places, keep_token, define_name, count_cards, ids_text, MOST_IDS

   !> What the builders share.
   type :: build_context_t
      type(deck_t), pointer :: deck => null()          !< as read; not the context's own
      type(model_t), pointer :: model => null()        !< so far
      type(motion_t), allocatable :: motions(:)        !< (0:instances), as deck%scopes
      integer(lp) :: memory = huge(1_lp)               !< that the mesh may take [bytes]
      logical :: has_room = .true.                     !< nothing asked for more
      type(name_list_t) :: invalid                     !< names whose definition is faulty
      type(name_list_t) :: surface_names, material_names, interaction_names, amplitude_names !< in the order of the model's lists
      type(name_list_t) :: orientation_names           !< in the order of orientation_axis
      type(name_list_t) :: source_names                !< keywords and names: in the order of the model's sources
      type(name_list_t) :: undetermined                      !< nouns: one of these should have been defined, its name is not known
      type(numbered_t) :: nodes, elements              !< what is known of them by number
      real(wp) :: spread = -1.0_wp                     !< longer side of the box round the nodes of *NODE [L]; < 0: not asked yet
      integer(ip) :: n_blocks = 0                      !< *BLOCK cards and copies read so far
      type(block_t), allocatable :: blocks(:)          !< the first n_blocks are in use
      type(joined_blocks_t) :: joined                  !< those up to the last one that has MERGE
      integer(ip), allocatable :: block_of_card(:)     !< for each card the first one; 0: none
      integer(ip) :: elements_to_come = 0              !< of blocks whose elements are not made yet
      type(line_list_t) :: lines                       !< line elements of *ELEMENT, without stiffness
      type(node_finder_t) :: finder                    !< of all nodes of elements
      type(curve_list_t) :: curves                     !< lines that carry names
      type(curve_list_t) :: node_surfaces              !< of *SURFACE, TYPE=NODE
      integer(ip), allocatable :: mesh_shift(:)        !< of the node numbers of each mesh of the deck; < 0: it is refused
      integer(ip), allocatable :: set_card(:)          !< for each node set the card that made it
      type(open_step_t) :: open                        !< the step that is being built
      integer(ip), allocatable :: step_cards(:, :)     !< (2, 0:steps) first and last card of each step; 0: those outside of steps
      logical, allocatable :: card_done(:)             !< *NSET and *ELSET cards that are read already
      type(node_elements_t) :: around                  !< elements round each node
      type(section_cut_t), allocatable :: cuts(:)      !< of *PRE-TENSION SECTION, in the order of the cards
      type(drawn_lines_t) :: drawn_cuts = drawn_lines_t('cut'), drawn_paths = drawn_lines_t('path') !< lines read
      !< so far
      type(face_list_t) :: cut_faces                   !< of both sides of all cuts
      type(refinement_t) :: refinement                 !< how the mesh came from that of the deck, if it is another one
      real(wp), allocatable :: node_thickness(:)       !< *NODAL THICKNESS, 0 where there is none [L]; unallocated: no card
      logical :: thickness_undetermined = .false.      !< one of these was not understood
      type(id_map_t) :: rigid_bodies                   !< by their reference nodes
      integer(ip), allocatable :: pending_elsets(:)    !< cards of *ELSET that wait for their elements, so far
      integer(ip) :: n_pending = 0, last_elset = 0     !< how many; the cards up to this one were looked at
      type(name_list_t) :: section_surfaces            !< of *PRE-TENSION SECTION
      integer(ip), allocatable :: outer_elements(:)    !< those with a face on the outline, rising; not listed before it is wanted
      integer(ip) :: least_sides = 0                   !< that an element has; known when these are listed
      type(id_map_t) :: deck_elements                  !< refined: places of the deck's elements in its own mesh
      type(token_t), allocatable :: ties(:)            !< of each the slave
      type(token_t), allocatable :: surfaces(:), materials(:), poisson(:), sections(:), interactions(:), slaves(:), masters(:)
      !< of each where it is named; of poisson the item of mu
      type(token_t), allocatable :: amplitudes(:), orientations(:) !< of each its name
      real(wp), allocatable :: orientation_axis(:, :)  !< (2, orientations) first axis of the material; 0: the card is faulty
      logical, allocatable :: elastic_given(:), elastic_invalid(:)  !< for each material
      logical :: membranes_told = .false.                    !< the note of M3D elements
      logical :: sections_undetermined = .false.             !< a *SOLID SECTION could not be understood
      logical :: pairs_undetermined = .false.                !< a *CONTACT PAIR could not be understood
      logical :: rigid_undetermined = .false.                !< a *RIGID BODY names another surface than it should
      integer(ip), allocatable :: loose_held(:, :)     !< (3, n_nodes) LOOSE_*: supports of nodes of no element; third: rotations
      logical, allocatable :: held_singly(:, :)        !< refined: (2, nodes of the deck) supported by a line of one node
      integer(ip), allocatable :: dof_entry(:, :)      !< (3, n_nodes): place in open%supports; 0: free; third: rotations
      real(wp), allocatable :: axes(:, :, :)           !< (2, dof, n_nodes) local axes; 0: along x and y; not allocated: nowhere
   end type build_context_t

   integer(ip), parameter :: MOST_IDS = 8              !< numbers that a message lists

contains

   !> Begins a context: the names and numbers that faulty cards would have defined are invalid.
   subroutine prepare_context(deck, context)
      type(deck_t), intent(in), target :: deck         !< as read; lives as long as the context
      type(build_context_t), intent(out) :: context    !< empty lists, with what an error has invalid
      integer(ip) :: i, k

      context%deck => deck
      allocate (context%blocks(64), context%set_card(0))
      allocate (context%nodes%place(64), context%elements%place(64))
      allocate (context%surfaces(0), context%materials(0), context%poisson(0), context%sections(0), context%interactions(0))
      allocate (context%slaves(0), context%masters(0), context%amplitudes(0), context%orientations(0))
      allocate (context%mesh_shift(size(deck%meshes)), source=-1_ip)
      allocate (context%card_done(deck%n_cards), source=.false.)
      allocate (context%block_of_card(deck%n_cards), source=0_ip)
      if (.not. has_errors()) return
      if (allocated(deck%scopes)) then
         if (size(deck%scopes) == 1) call note_undetermined_mesh(context)
      end if
      do i = 1, deck%n_cards
         call note_nameless(deck%cards(i), context)
         if (deck%cards(i)%ok .and. len(keyword_name(deck%cards(i))) > 0) cycle
         if (any(keyword_name(deck%cards(i)) == ['ELEMENT', 'ELSET  '])) context%sections_undetermined = .true.
         call invalidate_options(deck%cards(i), context)
         if (len(keyword_name(deck%cards(i))) > 0) cycle
         do k = deck%cards(i)%first_line, deck%cards(i)%first_line + deck%cards(i)%n_lines - 1
            ! what an unknown keyword would have defined begins each of its lines
            call spoil_number(deck, deck%lines(k), context%nodes)
            call spoil_number(deck, deck%lines(k), context%elements)
         end do
      end do
   end subroutine prepare_context

   !> Keeps a block; where there is no room the list doubles.
   pure subroutine add_context_block(context, block)
      type(build_context_t), intent(inout) :: context  !< the block becomes its last
      type(block_t), intent(in) :: block               !< its card is set
      type(block_t), allocatable :: longer(:)

      if (context%n_blocks == size(context%blocks)) then
         allocate (longer(2*context%n_blocks))
         longer(:context%n_blocks) = context%blocks
         call move_alloc(longer, context%blocks)
      end if
      context%n_blocks = context%n_blocks + 1
      context%blocks(context%n_blocks) = block
      if (context%block_of_card(block%card) == 0) context%block_of_card(block%card) = context%n_blocks
   end subroutine add_context_block

   !> A definition without its name, or with one that cannot be read: any unknown name may be the one that was meant.
   subroutine note_nameless(card, context)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context

      select case (keyword_name(card))
      case ('MATERIAL', 'AMPLITUDE', 'SURFACE INTERACTION', 'SURFACE')
         if (is_nameless(context%deck, card, 'NAME')) call note_undetermined(context, lower_case(keyword_name(card)))
      case ('NSET')
         if (is_nameless(context%deck, card, 'NSET')) call note_undetermined(context, 'node set')
      case ('ELSET')
         if (is_nameless(context%deck, card, 'ELSET')) call note_undetermined(context, 'element set')
      case ('BLOCK')
         if (is_nameless(context%deck, card, 'ELSET')) call note_undetermined_mesh(context)
      case ('INCLUDE')
         if (card%ok) return
         call note_undetermined_mesh(context)          ! a file that could not be read may have defined anything
         call note_undetermined(context, 'material')
         call note_undetermined(context, 'amplitude')
         call note_undetermined(context, 'surface interaction')
         context%sections_undetermined = .true.
         context%pairs_undetermined = .true.
      end select
   end subroutine note_nameless

   !> Nodes, elements, sets and surfaces of a mesh; a deck in parts without an instance has none.
   subroutine note_undetermined_mesh(context)
      type(build_context_t), intent(inout) :: context  !< names and numbers become undetermined
      character(len=19), parameter :: NOUNS(7) = [character(len=19) :: 'node set', 'earlier node set', 'element set', &
                                                                                'earlier element set', 'surface', 'node', 'element']
      integer :: i

      do i = 1, size(NOUNS)
         call note_undetermined(context, trim(NOUNS(i)))
      end do
   end subroutine note_undetermined_mesh

   !> The option that names a thing is not there or cannot be read; misspelt options are left to invalidate_options.
   logical function is_nameless(deck, card, option)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      character(len=*), intent(in) :: option
      character(len=:), allocatable :: name
      integer :: i, k

      is_nameless = .true.
      if (.not. allocated(card%options)) return
      do i = 1, size(card%options)
         if (.not. card%options(i)%has_value) cycle
         if (same_name(token_text(deck, card%options(i)%name), option)) then
            name = token_text(deck, card%options(i)%value)
            is_nameless = len(name) == 0 .or. any([(iachar(name(k:k)) < iachar(' '), k=1, len(name))])
            return
         end if
         if (card%options(i)%spec == 0) is_nameless = .false.
      end do
   end function is_nameless

   subroutine invalidate_options(card, context)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      character(len=:), allocatable :: name
      integer :: i

      if (.not. allocated(card%options)) return
      do i = 1, size(card%options)
         name = token_text(context%deck, card%options(i)%name)
         if (len(keyword_name(card)) == 0) then
            if (same_name(name, 'MATERIAL')) context%sections_undetermined = .true.
            if (same_name(name, 'INTERACTION')) context%pairs_undetermined = .true.
         end if
         if (.not. card%options(i)%has_value) cycle
         if (.not. is_empty_token(card%options(i)%value)) call invalidate_name(context, token_text(context%deck, &
                                                                                                   card%options(i)%value))
      end do
   end subroutine invalidate_options

   subroutine note_undetermined(context, noun)
      type(build_context_t), intent(inout) :: context
      character(len=*), intent(in) :: noun

      if (.not. has_name(context%undetermined, noun)) call add_name(context%undetermined, noun)
   end subroutine note_undetermined

   !> A block that could not be made: its sets, and the numbers of nodes and elements from there on.
   subroutine invalidate_block(context, name)
      type(build_context_t), intent(inout) :: context  !< names and numbers become invalid
      character(len=*), intent(in) :: name             !< of the block

      call invalidate_name(context, name)
      call note_undetermined(context, 'node')
      call note_undetermined(context, 'element')
   end subroutine invalidate_block

   !> Passes over, in silence, all that refers to this name or to the sides of a block of this name.
   subroutine invalidate_name(context, name)
      type(build_context_t), intent(inout) :: context  !< the name becomes invalid
      character(len=*), intent(in) :: name             !< of what is faulty

      call add_name(context%invalid, name)
   end subroutine invalidate_name

   !> Passes over, in silence, all that refers to the number with which a data line begins.
   subroutine spoil_number(deck, line, numbered)
      type(deck_t), intent(in) :: deck                 !< as read
      type(data_line_t), intent(in) :: line            !< data line whose first item is the number
      type(numbered_t), intent(inout) :: numbered      !< nodes or elements: the number becomes invalid
      integer(ip) :: id
      character(len=:), allocatable :: text
      integer :: outcome
      logical :: known

      if (line%n_tokens == 0) return
      text = token_text(deck, deck%tokens(line%first_token))
      text = text(verify(text//' ', '-'):)             ! -6 and 6.0 are meant to be 6
      call read_integer(text(:scan(text//'.', '.') - 1), id, outcome)
      if (outcome /= NUMBER_OK) return
      id = model_number(deck, deck%tokens(line%first_token), id)
      if (id > 0) call add_id(numbered%invalid, id, 1_ip, known)
   end subroutine spoil_number

   !> True when a name, or that of the block whose side or copy it is, is to be passed over in silence; of a name of an instance,
   !> when the instance is.
   recursive logical function is_invalid(context, name) result(invalid)
      type(build_context_t), intent(in) :: context     !< invalid and undetermined names are read
      character(len=*), intent(in) :: name             !< as an item has it
      character(len=:), allocatable :: block
      integer(ip) :: place
      integer :: i, k

      invalid = .false.
      if (.not. has_errors()) return
      call part_place_name(name, block, place)
      invalid = is_invalid_block(context, name)
      if (place > 0) invalid = invalid .or. is_invalid_block(context, block)
      do i = 1, size(BLOCK_SIDES)
         k = len(name) - len_trim(BLOCK_SIDES(i))
         if (invalid .or. k < 0) cycle
         if (same_name(name(k + 1:), BLOCK_SIDES(i))) invalid = is_invalid_block(context, name(:k))
      end do
      k = index(name, '.')
      if (invalid .or. k == 0 .or. .not. allocated(context%deck%scopes)) return
      invalid = is_invalid_block(context, name(:k - 1)) .or. is_invalid(context, name(k + 1:))
   end function is_invalid

   !> The name itself, or without the -2-3 of a copy.
   logical function is_invalid_block(context, name) result(is_invalid)
      type(build_context_t), intent(in) :: context
      character(len=*), intent(in) :: name
      integer :: i, k

      is_invalid = has_name(context%invalid, name)
      k = len(name)
      do i = 1, 2
         if (is_invalid) return
         k = verify(name(:k), '0123456789', back=.true.) - 1
         if (k < 1) return
         if (name(k + 1:k + 1) /= '-') return
      end do
      is_invalid = has_name(context%invalid, name(:k))
   end function is_invalid_block

   !> True when one of these should have been defined, under a name that is not known.
   logical function is_undetermined(context, noun)
      type(build_context_t), intent(in) :: context     !< undetermined nouns are read
      character(len=*), intent(in) :: noun             !< e.g. 'surface', singular

      is_undetermined = .false.
      if (has_errors()) is_undetermined = has_name(context%undetermined, noun)
   end function is_undetermined

   !> Elements are missing, which has been reported: what belongs to none may belong to one of them.
   logical function has_lost_elements(context)
      type(build_context_t), intent(in) :: context     !< its elements' invalid numbers are read

      has_lost_elements = has_errors() .and. (context%elements%invalid%n > 0 .or. is_undetermined(context, 'element'))
   end function has_lost_elements

   !> Whether an error was reported so far.
   logical function has_errors()
      has_errors = count_messages(SEVERITY_ERROR) > 0
   end function has_errors

   !> The line that is being read.
   pure type(data_line_t) function open_line(context)
      type(build_context_t), intent(in) :: context     !< open%line is a data line of the deck

      open_line = context%deck%lines(context%open%line)
   end function open_line

   !> An item of the line that is being read; an empty one where it has none.
   pure type(token_t) function line_token(context, k)
      type(build_context_t), intent(in) :: context     !< open%line is a data line of the deck
      integer(ip), intent(in) :: k                     !< item, from 1

      line_token = line_item(context%deck, open_line(context), k)
   end function line_token

   !> The item at a place kept by note_place.
   pure function place_token(deck, place) result(token)
      type(deck_t), intent(in) :: deck           !< as read
      integer(ip), intent(in) :: place           !< token (> 0) or card (< 0) of the deck
      type(token_t) :: token

      if (place > 0) then
         token = deck%tokens(place)
      else
         token = deck%cards(-place)%place
      end if
   end function place_token

   !> 'line 12', with the file where it is not the one of `from`.
   pure function place_text(deck, token, from) result(text)
      type(deck_t), intent(in) :: deck           !< as read
      type(token_t), intent(in) :: token, from   !< what is told, and where it is told
      character(len=:), allocatable :: text

      text = 'line '//to_text(token%line)
      if (token%source /= from%source) text = text//' of '//deck%sources(token%source)%name
   end function place_text

   !> Keeps where the i-th node or element comes from; a number given twice is an error, i being the place of the earlier one.
   subroutine note_number(deck, numbered, noun, id, i, place, known)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(numbered_t), intent(inout) :: numbered      !< nodes or elements; gets place and greatest
      character(len=*), intent(in) :: noun             !< 'node' or 'element'
      integer(ip), intent(in) :: id, i                 !< number in the model, and place in the mesh
      integer(ip), intent(in) :: place                 !< token (> 0) or card (< 0) of the deck
      logical, intent(in) :: known                     !< the number is given twice
      type(token_t) :: token

      if (known) then
         token = place_token(deck, place)
         call report_error(deck, token, 'E-TWICE', noun//' '//to_text(id - scope_shift(deck, token))//scope_text(deck, token)// &
                           ' is given twice, first in '//place_text(deck, place_token(deck, numbered%place(i)), token), &
                           expected=trim(merge('an', 'a ', noun == 'element'))//' '//noun//' number that is free')
      else
         call note_place(numbered%place, i, place)
         numbered%greatest = max(numbered%greatest, id)
      end if
   end subroutine note_number

   !> Keeps where the i-th node or element comes from, i counting up.
   pure subroutine note_place(places, i, place)
      integer(ip), allocatable, intent(inout) :: places(:) !< (>= i) grows as needed
      integer(ip), intent(in) :: i, place                  !< place in the mesh; token (> 0) or card (< 0)

      call make_room(places, size(places, kind=ip), i)
      places(i) = place
   end subroutine note_place

   !> Keeps that the i-th to the j-th come from one place.
   pure subroutine note_places(places, i, j, place)
      integer(ip), allocatable, intent(inout) :: places(:) !< (>= j) grows as needed
      integer(ip), intent(in) :: i, j, place               !< first and last in the mesh; token (> 0) or card (< 0)

      if (j < i) return
      call note_place(places, j, place)
      places(i:j) = place
   end subroutine note_places

   !> Keeps the place of the i-th material, section, surface, ..., i counting up.
   pure subroutine keep_token(list, i, token)
      type(token_t), allocatable, intent(inout) :: list(:) !< (>= i) grows by doubling
      integer(ip), intent(in) :: i                         !< at most one more than were kept
      type(token_t), intent(in) :: token                   !< where it is named

      ! the second half is written over
      do while (i > size(list))
         list = [list, list, token]
      end do
      list(i) = token
   end subroutine keep_token

   !> The name that a card defines becomes the last of a list, unless it is there already, which is reported.
   subroutine define_name(deck, card, noun, names, places, name, i)
      type(deck_t), intent(in) :: deck                 !< as read; messages name its lines
      type(card_t), intent(in) :: card                 !< its NAME= is read
      character(len=*), intent(in) :: noun             !< what is defined, e.g. 'material'
      type(name_list_t), intent(inout) :: names        !< of all that there are
      type(token_t), allocatable, intent(inout) :: places(:) !< where they are defined
      character(len=:), allocatable, intent(out) :: name !< as the card has it; '' without one
      integer(ip), intent(out) :: i                    !< its place; 0: it cannot be defined
      type(token_t) :: place
      logical :: found

      i = 0
      call option_text(deck, card, 'NAME', name, found, place)
      if (.not. found) return
      if (has_name(names, name)) then
         call report_error(deck, place, 'E-TWICE', noun//' '//name//' is defined twice, first in '// &
                           place_text(deck, places(find_name(names, name)), place), expected='a name that no other '//noun//' has')
         return
      end if
      call add_name(names, name)
      i = names%n
      call keep_token(places, i, place)
   end subroutine define_name

   !> How many cards of a keyword a deck has: as many things as they can make at most.
   pure integer(ip) function count_cards(deck, keyword) result(n)
      type(deck_t), intent(in) :: deck           !< as read
      character(len=*), intent(in) :: keyword    !< in capitals, e.g. 'CONTACT PAIR'
      integer(ip) :: i

      n = 0
      do i = 1, deck%n_cards
         if (keyword_name(deck%cards(i)) == keyword) n = n + 1
      end do
   end function count_cards

   !> '3, 4, 5 and 12 more'
   pure function ids_text(ids, n_all) result(text)
      integer(ip), intent(in) :: ids(:)                !< numbers of nodes or elements, in the order they are told
      integer(ip), intent(in), optional :: n_all       !< how many there are, where only the first MOST_IDS are given
      character(len=:), allocatable :: text
      integer(ip) :: i, n, n_ids

      n_ids = size(ids, kind=ip)
      if (present(n_all)) n_ids = n_all
      n = n_ids
      if (n > MOST_IDS) n = MOST_IDS - 1
      text = ''
      do i = 1, n
         if (i > 1) text = text//', '
         text = text//to_text(ids(i))
      end do
      if (n < n_ids) text = text//' and '//to_text(n_ids - n)//' more'
   end function ids_text

end module atrito_build_context
