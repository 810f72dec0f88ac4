!> A mesh as a file of Gmsh has it: nodes, elements of dimension 0 to 2 on the entities of a drawing, and physical groups of these.
!>
!> Besides, the words of such a file, line by line, on which its reader walks: they keep the first thing that is wrong, and where.
module atrito_gmsh_mesh
   use atrito_element_table, only: MOST_NODES
   use atrito_growth, only: make_room, resize
   use atrito_kinds, only: ip, wp, lp
   use atrito_name_list, only: name_list_t, add_name, find_name
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: gmsh_mesh_t, add_part, find_part, add_element, trim_gmsh_mesh, move_mesh, group_name, part_name, note_key, key_of, &
             keys_t, words_t, fault_t, next_line, take_word, take_integer, take_real, end_line, fail, word_is, go_on, begin_line, &
             read_head, check_count, check_number

   !> An entity of the drawing with the physical groups to which it belongs.
   type :: gmsh_part_t
      integer(ip) :: dim = 0                       !< 0: a point, 1: a curve, 2: a surface
      integer(ip) :: tag = 0                       !< number of the entity in its dimension
      integer(ip), allocatable :: groups(:)        !< tags of physical groups, > 0
   end type gmsh_part_t

   !> The name of a physical group.
   type :: gmsh_name_t
      integer(ip) :: dim = 0, tag = 0       !< of the group
      character(len=:), allocatable :: name !< without blanks
   end type gmsh_name_t

   !> Where what has a key stands that is made of numbers: meshes have as many entities and groups as a drawing has.
   type :: keys_t
      type(name_list_t) :: keys                    !< as texts
      integer(ip), allocatable :: place(:)         !< of each key; the last one that was noted
   end type keys_t

   type :: gmsh_mesh_t
      character(len=:), allocatable :: file                   !< as the user wrote it
      integer(ip) :: card = 0                                 !< of the *INCLUDE that names it, place in the deck's cards
      integer(ip) :: n_nodes = 0, n_elements = 0, n_parts = 0 !< in use; the arrays may be longer
      integer(ip), allocatable :: node_id(:)                  !< (n_nodes) numbers in the file
      real(wp), allocatable :: x(:, :)                        !< (2, n_nodes) [L]
      integer(ip), allocatable :: element_id(:)               !< (n_elements) numbers in the file
      integer(ip), allocatable :: shape(:)                    !< how many nodes each element has
      integer(ip), allocatable :: part(:)                     !< of each element, place in parts
      integer(ip), allocatable :: nodes(:, :)                 !< (MOST_NODES, n_elements) numbers
      type(gmsh_part_t), allocatable :: parts(:)              !< the first n_parts are in use
      type(gmsh_name_t), allocatable :: names(:)              !< of groups that have one
      type(keys_t) :: part_keys, name_keys                    !< by dimension, tag and, where it matters, group
   end type gmsh_mesh_t

   !> Words of Gmsh's own Abaqus files for what has no name, by dimension.
   character(len=7), parameter :: ENTITY(0:2) = ['Point  ', 'Line   ', 'Surface']

   !> What is wrong with a text, and where.
   type :: fault_t
      character(len=:), allocatable :: text        !< not allocated: nothing
      character(len=:), allocatable :: expected    !< what should be there
      integer(ip) :: line = 1, column = 1          !< where, from 1
      integer(ip) :: first = 1, last = 0           !< characters of the text
   end type fault_t

   !> A text and a place in it. A line is over when take_word finds nothing more.
   type :: words_t
      character(len=:), pointer :: text => null()  !< of whoever reads it
      integer(ip) :: position = 1                  !< next character
      integer(ip) :: line = 0                      !< number of the present line
      integer(ip) :: start = 1                     !< its first character
      integer(ip) :: first = 1, last = 0           !< the word taken last; last < first: there was none
      logical :: ok = .true.                       !< nothing is wrong so far
      type(fault_t) :: fault                       !< the first one
   end type words_t

   character(len=1), parameter :: LINE_FEED = achar(10)

contains

   !> Keeps an entity.
   subroutine add_part(mesh, dim, tag, groups)
      type(gmsh_mesh_t), intent(inout) :: mesh       !< gets an entity more
      integer(ip), intent(in) :: dim, tag, groups(:) !< as of gmsh_part_t
      type(gmsh_part_t), allocatable :: longer(:)

      if (.not. allocated(mesh%parts)) allocate (mesh%parts(16))
      if (mesh%n_parts == size(mesh%parts)) then
         allocate (longer(2*mesh%n_parts))
         longer(:mesh%n_parts) = mesh%parts
         call move_alloc(longer, mesh%parts)
      end if
      mesh%n_parts = mesh%n_parts + 1
      associate (part => mesh%parts(mesh%n_parts))
         part%dim = dim
         part%tag = tag
         allocate (part%groups, source=groups)     ! of length 0 as well: a constructor leaves it unallocated then
      end associate
      call note_key(mesh%part_keys, key_of(dim, tag), mesh%n_parts)
      call note_key(mesh%part_keys, key_of(dim, tag, sum(groups(:min(1, size(groups))))), mesh%n_parts)
   end subroutine add_part

   !> The place of an entity that was kept, with its first group where one is given; 0: none. Of several it is the last.
   pure integer(ip) function find_part(mesh, dim, tag, group) result(i)
      type(gmsh_mesh_t), intent(in) :: mesh        !< its entities are searched
      integer(ip), intent(in) :: dim, tag          !< as of gmsh_part_t
      integer(ip), intent(in), optional :: group   !< of none: 0

      i = place_of(mesh%part_keys, key_of(dim, tag, group))
   end function find_part

   !> By what a part or a name is found: its dimension and number, and its physical group.
   pure function key_of(dim, tag, group) result(key)
      integer(ip), intent(in) :: dim, tag        !< as of gmsh_part_t
      integer(ip), intent(in), optional :: group !< left out: a key without it
      character(len=:), allocatable :: key

      key = to_text(dim)//' '//to_text(tag)
      if (present(group)) key = key//' '//to_text(group)
   end function key_of

   !> Notes where in a list the thing with a key is; a later one takes the place of an earlier one.
   pure subroutine note_key(list, key, place)
      type(keys_t), intent(inout) :: list !< gets the key, or another place for it
      character(len=*), intent(in) :: key !< of key_of
      integer(ip), intent(in) :: place    !< where it is, > 0

      if (find_name(list%keys, key) == 0) call add_name(list%keys, key)
      call make_room(list%place, list%keys%n - 1, list%keys%n)
      list%place(find_name(list%keys, key)) = place
   end subroutine note_key

   pure integer(ip) function place_of(list, key) result(place)
      type(keys_t), intent(in) :: list
      character(len=*), intent(in) :: key

      place = find_name(list%keys, key)
      if (place > 0) place = list%place(place)
   end function place_of

   !> Keeps an element.
   subroutine add_element(mesh, id, part, nodes)
      type(gmsh_mesh_t), intent(inout) :: mesh      !< gets an element more; it has been trimmed before
      integer(ip), intent(in) :: id, part, nodes(:) !< number; place of its entity; numbers of its nodes
      integer(ip) :: e

      e = mesh%n_elements + 1
      if (e > size(mesh%element_id)) call resize_elements(mesh, 2*e)
      mesh%n_elements = e
      mesh%element_id(e) = id
      mesh%shape(e) = size(nodes, kind=ip)
      mesh%part(e) = part
      mesh%nodes(:size(nodes), e) = nodes
   end subroutine add_element

   subroutine resize_elements(mesh, length)
      type(gmsh_mesh_t), intent(inout) :: mesh
      integer(ip), intent(in) :: length

      call resize(mesh%element_id, mesh%n_elements, length)
      call resize(mesh%shape, mesh%n_elements, length)
      call resize(mesh%part, mesh%n_elements, length)
      call resize(mesh%nodes, mesh%n_elements, length)
   end subroutine resize_elements

   !> Makes room for so many elements: at the beginning, and at the end what is there.
   subroutine trim_gmsh_mesh(mesh, n_elements)
      type(gmsh_mesh_t), intent(inout) :: mesh !< lists of elements get this length
      integer(ip), intent(in) :: n_elements    !< >= those that there are

      if (.not. allocated(mesh%element_id)) allocate (mesh%element_id(0), mesh%shape(0), mesh%part(0), mesh%nodes(MOST_NODES, 0))
      call resize_elements(mesh, n_elements)
   end subroutine trim_gmsh_mesh

   !> Hands a mesh on without a copy.
   subroutine move_mesh(from, to)
      type(gmsh_mesh_t), intent(inout) :: from, to !< gives all; gets all

      call move_alloc(from%file, to%file)
      call move_alloc(from%node_id, to%node_id)
      call move_alloc(from%x, to%x)
      call move_alloc(from%element_id, to%element_id)
      call move_alloc(from%shape, to%shape)
      call move_alloc(from%part, to%part)
      call move_alloc(from%nodes, to%nodes)
      call move_alloc(from%parts, to%parts)
      call move_alloc(from%names, to%names)
      to%part_keys = from%part_keys
      to%name_keys = from%name_keys
      to%card = from%card
      to%n_nodes = from%n_nodes
      to%n_elements = from%n_elements
      to%n_parts = from%n_parts
   end subroutine move_mesh

   !> The name of a physical group as Gmsh's own Abaqus files have it: without blanks, and one for those that have none.
   pure function group_name(mesh, dim, tag) result(name)
      type(gmsh_mesh_t), intent(in) :: mesh !< its names are read
      integer(ip), intent(in) :: dim, tag   !< of the physical group
      character(len=:), allocatable :: name
      integer(ip) :: i

      i = place_of(mesh%name_keys, key_of(dim, tag))
      if (size(mesh%names) == 0) i = 0                 ! the second list was empty
      name = 'Physical'//trim(ENTITY(dim))//to_text(tag)
      if (i > 0) name = mesh%names(i)%name
   end function group_name

   !> The name of an entity.
   pure function part_name(part) result(name)
      type(gmsh_part_t), intent(in) :: part !< dimension and number are read
      character(len=:), allocatable :: name

      name = trim(ENTITY(part%dim))//to_text(part%tag)
   end function part_name

   !> Goes to the next line that has a word, and takes that word; found is .false. at the end of the text.
   subroutine next_line(words, found)
      type(words_t), intent(inout) :: words !< goes on to the first word of that line
      logical, intent(out) :: found         !< there is one
      integer(ip) :: i

      found = .false.
      do
         if (words%line > 0) then                  ! over the rest of the present line
            do i = words%position, len(words%text)
               if (words%text(i:i) == LINE_FEED) exit
            end do
            words%position = min(i, len(words%text)) + 1
         end if
         if (words%position > len(words%text)) exit
         words%line = words%line + 1
         words%start = words%position
         call take_word(words)
         found = words%last >= words%first
         if (found) return
      end do
   end subroutine next_line

   !> The next word of the line; none: last < first.
   pure subroutine take_word(words)
      type(words_t), intent(inout) :: words !< goes on behind the word

      call find_word(words%text, words%position, words%first, words%last)
      words%position = words%last + 1
   end subroutine take_word

   pure subroutine find_word(text, position, first, last)
      character(len=*), intent(in) :: text
      integer(ip), intent(in) :: position
      integer(ip), intent(out) :: first, last

      do first = position, len(text)
         if (text(first:first) == LINE_FEED .or. iachar(text(first:first)) > iachar(' ')) exit
      end do
      do last = first, len(text)
         if (iachar(text(last:last)) <= iachar(' ')) exit
      end do
      last = last - 1
   end subroutine find_word

   !> The next word, which must be an integer.
   subroutine take_integer(words, what, value)
      character(len=*), intent(in) :: what  !< what it is, for a message
      type(words_t), intent(inout) :: words !< goes on behind the word; may fail
      integer(ip), intent(out) :: value     !< 0 where there is none
      integer(lp) :: sum
      integer(ip) :: i, first
      integer :: digit

      value = 0
      if (.not. words%ok) return
      call take_word(words)
      sum = 0_lp
      first = words%first
      if (first < words%last) then
         if (words%text(first:first) == '-') first = first + 1
      end if
      words%ok = words%last >= first
      do i = first, words%last
         digit = iachar(words%text(i:i)) - iachar('0')
         words%ok = words%ok .and. digit >= 0 .and. digit <= 9
         if (.not. words%ok) exit                    ! a long word of other characters would leave the integers
         sum = min(10_lp*sum + int(digit, lp), int(huge(1_ip), lp) + 1_lp)
      end do
      if (.not. words%ok) then
         call fail(words, missing_or(words, 'this is not an integer'), what//', an integer')
      else if (sum > int(huge(1_ip), lp)) then
         call fail(words, 'this number is too large', what//', at most '//to_text(huge(1_ip)))
      else
         value = int(sum, ip)
         if (first > words%first) value = -value
      end if
   end subroutine take_integer

   !> The next word, which must be a real.
   subroutine take_real(words, what, value)
      character(len=*), intent(in) :: what  !< what it is, for a message
      type(words_t), intent(inout) :: words !< goes on behind the word; may fail
      real(wp), intent(out) :: value        !< 0 where there is none
      integer :: outcome

      value = 0.0_wp
      if (.not. words%ok) return
      call take_word(words)
      call read_real(words%text(words%first:words%last), value, outcome)
      if (outcome /= NUMBER_OK) call fail(words, missing_or(words, 'this is not a number'), what//', a real')
   end subroutine take_real

   pure function missing_or(words, text) result(problem)
      type(words_t), intent(in) :: words
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: problem

      problem = text
      if (words%last < words%first) problem = 'the line ends too early'
   end function missing_or

   !> Nothing more may stand in the line.
   subroutine end_line(words, expected)
      character(len=*), intent(in) :: expected !< what the line should be, for a message
      type(words_t), intent(inout) :: words    !< stays in the line; may fail
      integer(ip) :: first, last

      if (.not. words%ok) return
      first = words%first
      last = words%last
      call take_word(words)
      if (words%last >= words%first) call fail(words, 'an item too many', expected)
      words%first = first                          ! what is said next is of the last item
      words%last = last
   end subroutine end_line

   !> Keeps what is wrong at the word taken last; only the first time counts.
   subroutine fail(words, text, expected)
      type(words_t), intent(inout) :: words          !< not ok from now on
      character(len=*), intent(in) :: text, expected !< what is wrong; what should be there

      words%ok = .false.
      if (allocated(words%fault%text)) return
      words%fault%text = text
      words%fault%expected = expected
      words%fault%line = max(words%line, 1_ip)
      words%fault%first = words%first
      words%fault%last = words%last
      words%fault%column = words%first - words%start + 1
   end subroutine fail

   !> Whether the word that was read last is this one, letter for letter.
   pure logical function word_is(words, word)
      character(len=*), intent(in) :: word !< letter for letter
      type(words_t), intent(in) :: words   !< behind a word

      word_is = words%last - words%first + 1 == len(word)
      if (word_is) word_is = words%text(words%first:words%last) == word
   end function word_is

   !> To the next line, which must be there.
   subroutine go_on(words, expected)
      character(len=*), intent(in) :: expected !< what should follow, for a message
      type(words_t), intent(inout) :: words    !< goes on to the next line; may fail
      logical :: found

      if (.not. words%ok) return
      call next_line(words, found)
      if (.not. found) call fail(words, 'the file ends too early', expected)
   end subroutine go_on

   !> The first word of the next line as an integer.
   subroutine begin_line(words, what, value)
      character(len=*), intent(in) :: what  !< what it is, for a message
      type(words_t), intent(inout) :: words !< goes on to the next line; may fail
      integer(ip), intent(out) :: value     !< 0 where there is none

      value = 0
      call go_on(words, what)
      if (.not. words%ok) return
      words%position = words%first
      call take_integer(words, what, value)
   end subroutine begin_line

   !> A count of lines that the rest of the text can hold; each of so many characters at the least.
   subroutine check_count(words, n, least)
      type(words_t), intent(inout) :: words !< may fail
      integer(ip), intent(in) :: n, least   !< lines that follow; characters of each, > 0

      if (.not. words%ok) return
      if (n < 0) call fail(words, 'a negative number', 'a number of lines')
      if (n > (len(words%text) - words%position)/least + 1) call fail(words, 'the rest of the file is too short for so many', &
                                                                      'as many as follow')
   end subroutine check_count

   !> Fails, with a message at the word that was read last, where a number is not positive.
   subroutine check_number(words, number)
      type(words_t), intent(inout) :: words !< may fail
      integer(ip), intent(in) :: number     !< that is to be > 0

      if (words%ok .and. number <= 0) call fail(words, 'this number is not positive', 'a number from 1')
   end subroutine check_number

   !> The head of a block of format 4.1.
   subroutine read_head(words, what, head)
      character(len=*), intent(in) :: what             !< what the last number counts, for a message
      type(words_t), intent(inout) :: words            !< goes on over the line; may fail
      integer(ip), intent(out) :: head(4)              !< dimension, entity, kind, how many

      head = 0
      call begin_line(words, 'dimension of the entity', head(1))
      call take_integer(words, 'tag of the entity', head(2))
      call take_integer(words, 'kind', head(3))
      call take_integer(words, what, head(4))
      call end_line(words, 'four integers')
   end subroutine read_head

end module atrito_gmsh_mesh
