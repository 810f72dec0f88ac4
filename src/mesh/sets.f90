!> Named lists of nodes or elements. A set named again grows; members are kept once, in the order in which they came.
!>
!> They are kept as runs of neighbours (ranges_t): a thousand sets that name a block of a million elements are a thousand runs.
!> What is added is put behind the others as it is, and looked through for what stands there twice when the list has doubled: so a
!> list that grows number by number takes n log n operations.
!>
!> A name of nodes means those of a node set, of the elements of an element set, or that in a corner or a middle of a block. The
!> last two have no set of their own, since few of them are asked for: they are found by the node sets of the four sides,
!> <block>-BOTTOM, -RIGHT, -TOP and -LEFT.
module atrito_sets
   use atrito_growth, only: resize
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: mesh_t
   use atrito_name_list, only: name_list_t, add_name, find_name
   use atrito_sorting, only: each_once, first_at_least
   use atrito_strings, only: ends_with, to_text, upper_case
   implicit none (type, external)
   private
   public :: set_t, set_list_t, set_count, find_set, grow_set, members_of, member_count, replace_members, ranges_t, add_range, &
             add_numbers, add_ranges, numbers_in, numbers_among, count_numbers, first_number, find_named_nodes, nodes_of_elements, &
             part_place_name, BLOCK_SIDES

   type :: ranges_t
      integer(ip) :: n = 0                               !< runs
      integer(ip) :: n_clean = 0                         !< the first so many hold no number twice, and none goes on with the next
      integer(ip), allocatable :: first(:), last(:)      !< those up to n are in use
   end type ranges_t

   type :: set_t
      character(len=:), allocatable :: name    !< as it was written first
      type(ranges_t) :: members                !< places, not ids
   end type set_t

   type :: set_list_t
      type(set_t), allocatable :: sets(:)      !< the first set_count are in use
      type(name_list_t) :: names               !< of them, in their order
   end type set_list_t

   !> Adds members to a set, which is made when it is new: call grow_set(list, name, places), or those of a ranges_t.
   interface grow_set
      module procedure grow_by_numbers, grow_by_ranges
   end interface grow_set

   integer(ip), parameter :: FIRST_LENGTH = 8

   integer(ip), parameter :: FEW = 32

   !> Ends of the names that a *BLOCK gives to its sides, in the order of the faces S1..S4; the corners at which they begin, their
   !> middles, and the centre.
   character(len=7), parameter :: BLOCK_SIDES(4) = ['-BOTTOM', '-RIGHT ', '-TOP   ', '-LEFT  ']
   character(len=14), parameter :: PLACES(9) = [character(len=14) :: '-BOTTOM-LEFT', '-BOTTOM-RIGHT', '-TOP-RIGHT', '-TOP-LEFT', &
                                                        '-BOTTOM-MIDDLE', '-RIGHT-MIDDLE', '-TOP-MIDDLE', '-LEFT-MIDDLE', '-CENTRE']
   integer(ip), parameter :: CENTRE = 9

   !> A node stands in a place if it is not farther from it than this part of the block's side.
   real(wp), parameter :: SAME_PLACE = 1.0e-6_wp

contains

   !> How many sets a list has.
   pure integer(ip) function set_count(list) result(n)
      type(set_list_t), intent(in) :: list !< may be empty

      n = list%names%n
   end function set_count

   !> Index of a set by name, without case; 0 when there is none.
   pure integer(ip) function find_set(list, name) result(i)
      type(set_list_t), intent(in) :: list !< searched by hash
      character(len=*), intent(in) :: name !< as written, in either case

      i = find_name(list%names, name)
   end function find_set

   !> The members of a set, one by one.
   pure function members_of(set) result(members)
      type(set_t), intent(in) :: set !< places of nodes or of elements
      integer(ip), allocatable :: members(:)

      members = numbers_in(set%members)
   end function members_of

   !> How many numbers a set has, each counted once.
   pure integer(ip) function member_count(set) result(n)
      type(set_t), intent(in) :: set !< places of nodes or of elements

      n = count_numbers(set%members)
   end function member_count

   !> Gives a set other members (places of nodes or elements), in any order.
   pure subroutine replace_members(set, members)
      type(set_t), intent(inout) :: set     !< keeps its name
      integer(ip), intent(in) :: members(:) !< places; may be repeated

      set%members = ranges_t()
      call add_numbers(set%members, members)
   end subroutine replace_members

   pure subroutine grow_by_numbers(list, name, members)
      type(set_list_t), intent(inout) :: list !< gets a set, or a longer one
      character(len=*), intent(in) :: name    !< in either case
      integer(ip), intent(in) :: members(:)   !< places; those that are there already are passed over
      integer(ip) :: i

      call find_or_append(list, name, i)
      call add_numbers(list%sets(i)%members, members)
   end subroutine grow_by_numbers

   pure subroutine grow_by_ranges(list, name, members)
      type(set_list_t), intent(inout) :: list !< gets a set, or a longer one
      character(len=*), intent(in) :: name    !< in either case
      type(ranges_t), intent(in) :: members   !< places; those that are there already are passed over
      integer(ip) :: i

      call find_or_append(list, name, i)
      call add_ranges(list%sets(i)%members, members)
   end subroutine grow_by_ranges

   !> The place of a set; a new one has no members. Where there is no room the list doubles, the sets handed on without a copy.
   pure subroutine find_or_append(list, name, i)
      type(set_list_t), intent(inout) :: list
      character(len=*), intent(in) :: name
      integer(ip), intent(out) :: i
      type(set_t), allocatable :: longer(:)
      integer(ip) :: k

      i = find_set(list, name)
      if (i > 0) return
      i = set_count(list) + 1
      if (.not. allocated(list%sets)) allocate (list%sets(FIRST_LENGTH))
      if (i > size(list%sets)) then
         allocate (longer(2*i))
         do k = 1, i - 1
            call move_alloc(list%sets(k)%name, longer(k)%name)
            call move_ranges(list%sets(k)%members, longer(k)%members)
         end do
         call move_alloc(longer, list%sets)
      end if
      list%sets(i)%name = name
      call add_name(list%names, name)
   end subroutine find_or_append

   !> Appends first, first + 1, ..., last; those that are there already are passed over.
   pure subroutine add_range(ranges, first, last)
      type(ranges_t), intent(inout) :: ranges            !< gets them behind the others
      integer(ip), intent(in) :: first, last             !< >= first

      if (ranges%n > 0) then
         if (first == ranges%last(ranges%n) + 1) then
            ranges%last(ranges%n) = last
            ranges%n_clean = min(ranges%n_clean, ranges%n - 1)
            return
         end if
      end if
      if (.not. allocated(ranges%first)) allocate (ranges%first(1), ranges%last(1))  ! most sets are one run
      if (ranges%n == size(ranges%first)) then
         call resize(ranges%first, ranges%n, 2*ranges%n)
         call resize(ranges%last, ranges%n, 2*ranges%n)
      end if
      ranges%n = ranges%n + 1
      ranges%first(ranges%n) = first
      ranges%last(ranges%n) = last
      if (ranges%n > 2*ranges%n_clean + FEW) call clean(ranges)
   end subroutine add_range

   !> Appends numbers.
   pure subroutine add_numbers(ranges, numbers)
      type(ranges_t), intent(inout) :: ranges !< gets them behind the others
      integer(ip), intent(in) :: numbers(:)   !< in any order, also repeated
      integer(ip) :: i

      do i = 1, size(numbers, kind=ip)
         call add_range(ranges, numbers(i), numbers(i))
      end do
   end subroutine add_numbers

   !> Appends the numbers of another list.
   pure subroutine add_ranges(ranges, others)
      type(ranges_t), intent(inout) :: ranges !< gets them behind the others
      type(ranges_t), intent(in) :: others    !< is not changed
      integer(ip) :: i

      do i = 1, others%n
         call add_range(ranges, others%first(i), others%last(i))
      end do
   end subroutine add_ranges

   !> Hands the ranges of one list to another without copying them; the first one is not to be used any more.
   pure subroutine move_ranges(from, to)
      type(ranges_t), intent(inout) :: from, to          !< the second one is empty

      to%n = from%n
      to%n_clean = from%n_clean
      call move_alloc(from%first, to%first)
      call move_alloc(from%last, to%last)
   end subroutine move_ranges

   !> All numbers, one by one.
   pure function numbers_in(ranges) result(numbers)
      type(ranges_t), intent(in) :: ranges !< in the order in which they came
      integer(ip), allocatable :: numbers(:)
      type(ranges_t) :: runs
      integer(ip) :: i, k, n

      runs = cleaned(ranges)
      allocate (numbers(count_numbers(runs)))
      n = 0
      do i = 1, runs%n
         do k = runs%first(i), runs%last(i)
            n = n + 1
            numbers(n) = k
         end do
      end do
   end function numbers_in

   !> Those numbers that stand in a rising list, too: of a few of them nobody goes through all.
   pure function numbers_among(ranges, some) result(numbers)
      type(ranges_t), intent(in) :: ranges               !< in any order
      integer(ip), intent(in) :: some(:)                 !< rising
      integer(ip), allocatable :: numbers(:)
      type(ranges_t) :: runs, found
      integer(lp) :: key(size(some))
      integer(ip) :: i, k

      key = some
      runs = cleaned(ranges)
      do i = 1, runs%n
         do k = first_at_least(key, int(runs%first(i), lp)), size(some, kind=ip)
            if (some(k) > runs%last(i)) exit
            call add_range(found, some(k), some(k))
         end do
      end do
      numbers = numbers_in(found)
   end function numbers_among

   !> How many numbers there are.
   pure integer(ip) function count_numbers(ranges) result(n)
      type(ranges_t), intent(in) :: ranges !< each number is counted once
      type(ranges_t) :: runs

      runs = cleaned(ranges)
      n = 0
      if (runs%n > 0) n = sum(runs%last(:runs%n) - runs%first(:runs%n) + 1)
   end function count_numbers

   !> The number that came first; 0 of an empty list.
   pure integer(ip) function first_number(ranges) result(number)
      type(ranges_t), intent(in) :: ranges !< may be empty

      number = 0
      if (ranges%n > 0) number = ranges%first(1)
   end function first_number

   !> The same list, in which no number stands twice.
   pure type(ranges_t) function cleaned(ranges)
      type(ranges_t), intent(in) :: ranges

      cleaned = ranges
      if (cleaned%n_clean < cleaned%n) call clean(cleaned)
   end function cleaned

   !> Leaves of each run what no earlier one has, and joins runs that go on with each other.
   !>
   !> Where the runs do not rise one behind the other, the ends of all runs cut the numbers into pieces, each of which a run has as
   !> a whole or not at all. The runs take their pieces in turn. next(piece) leads to the first piece from there on that is still
   !> free, as in a union-find structure, so that n runs take some n log n operations however much they overlap.
   pure subroutine clean(ranges)
      type(ranges_t), intent(inout) :: ranges
      type(ranges_t) :: all_once
      integer(ip), allocatable :: bounds(:), next(:)
      integer(lp), allocatable :: key(:)
      integer(ip) :: i, piece, last_piece

      associate (n => ranges%n)
         if (any(ranges%first(2:n) <= ranges%last(:n - 1))) then
            bounds = each_once([ranges%first(:n), ranges%last(:n) + 1])
            key = bounds
            next = [(i, i=1, size(bounds, kind=ip))]
            do i = 1, n
               piece = first_at_least(key, int(ranges%first(i), lp))
               last_piece = first_at_least(key, ranges%last(i) + 1_lp)
               call find_free(next, piece)
               do while (piece < last_piece)
                  call append_run(all_once, bounds(piece), bounds(piece + 1) - 1)
                  next(piece) = piece + 1
                  call find_free(next, piece)
               end do
            end do
         else
            do i = 1, n
               call append_run(all_once, ranges%first(i), ranges%last(i))
            end do
         end if
      end associate
      all_once%n_clean = all_once%n
      call move_ranges(all_once, ranges)
   end subroutine clean

   !> Goes from a piece on to the first that is free; the way is shorter the next time.
   pure subroutine find_free(next, piece)
      integer(ip), intent(inout) :: next(:)
      integer(ip), intent(inout) :: piece

      do while (next(piece) /= piece)
         next(piece) = next(next(piece))
         piece = next(piece)
      end do
   end subroutine find_free

   pure subroutine append_run(ranges, first, last)
      type(ranges_t), intent(inout) :: ranges
      integer(ip), intent(in) :: first, last

      ranges%n_clean = ranges%n                          ! add_range need not look through it
      call add_range(ranges, first, last)
   end subroutine append_run

   !> Of a name of both a node set and an element set the nodes are those of the node set.
   pure subroutine find_named_nodes(mesh, node_sets, element_sets, name, nodes, found, fault)
      type(mesh_t), intent(in) :: mesh                        !< places of nodes, and nodes of elements
      type(set_list_t), intent(in) :: node_sets, element_sets !< of the scene as far as it is read
      character(len=*), intent(in) :: name                    !< as the user wrote it, without case
      integer(ip), allocatable, intent(out) :: nodes(:)       !< places
      logical, intent(out) :: found                           !< the name means some nodes
      character(len=:), allocatable, intent(out) :: fault     !< allocated: what a corner or middle that is named lacks
      integer(ip) :: i

      i = find_set(node_sets, name)
      found = i > 0
      if (found) then
         nodes = members_of(node_sets%sets(i))
         return
      end if
      i = find_set(element_sets, name)
      found = i > 0
      if (found) then
         nodes = nodes_of_elements(mesh, members_of(element_sets%sets(i)))
      else
         call find_place_of_block(mesh, node_sets, name, nodes, fault)
         found = size(nodes) > 0
      end if
   end subroutine find_named_nodes

   !> All nodes of some elements, rising.
   pure function nodes_of_elements(mesh, elements) result(nodes)
      type(mesh_t), intent(in) :: mesh                       !< nodes of the elements are read
      integer(ip), intent(in) :: elements(:)                 !< places
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: i, n

      allocate (nodes(sum(mesh%shape(elements))))
      n = 0
      do i = 1, size(elements, kind=ip)
         associate (of_element => mesh%nodes(:mesh%shape(elements(i)), elements(i)))
            nodes(n + 1:n + size(of_element)) = of_element
            n = n + size(of_element, kind=ip)
         end associate
      end do
      nodes = each_once(nodes)
   end function nodes_of_elements

   !> The node of <block>-TOP-RIGHT, -TOP-MIDDLE, -CENTRE and their like; none: the name is none of these, or none or several nodes
   !> stand there.
   pure subroutine find_place_of_block(mesh, sets, name, nodes, fault)
      type(mesh_t), intent(in) :: mesh
      type(set_list_t), intent(in) :: sets                   !< of nodes
      character(len=*), intent(in) :: name
      integer(ip), allocatable, intent(out) :: nodes(:)
      character(len=:), allocatable, intent(out) :: fault
      character(len=:), allocatable :: block
      real(wp) :: x(2, CENTRE)                               ! of the places [L]
      integer(ip) :: side(4), wanted, place, k

      nodes = [integer(ip) ::]
      call part_place_name(name, block, wanted)
      if (wanted == 0) return
      side = [(find_set(sets, block//trim(BLOCK_SIDES(k))), k=1, 4)]
      if (any(side == 0)) return                             ! it is no block
      do place = 1, wanted
         if (place > 4 .and. place < wanted .and. wanted < CENTRE) cycle
         k = mod(place - 1, 4_ip) + 1
         if (place <= 4) then
            nodes = numbers_among(sets%sets(side(k))%members, each_once(members_of(sets%sets(side(mod(k + 2, 4_ip) + 1)))))
         else if (place < CENTRE) then
            nodes = members_of(sets%sets(side(k)))
            nodes = pack(nodes, is_halfway(mesh%x(:, nodes), x(:, k), x(:, mod(k, 4_ip) + 1)))
         else                                                ! as the map of a block has it (atrito_block_map)
            nodes = members_of(sets%sets(find_set(sets, block)))
            x(:, CENTRE) = 0.5_wp*sum(x(:, 5:8), dim=2) - 0.25_wp*sum(x(:, :4), dim=2)
            nodes = pack(nodes, norm2(mesh%x(:, nodes) - spread(x(:, CENTRE), 2, size(nodes)), dim=1) <= &
                         SAME_PLACE*norm2(x(:, 3) - x(:, 1)))
         end if
         if (size(nodes) /= 1) exit
         x(:, place) = mesh%x(:, nodes(1))
      end do
      if (size(nodes) == 1) return
      fault = 'no node stands in '//name
      if (size(nodes) > 1) fault = to_text(size(nodes, kind=ip))//' nodes stand in '//name
      nodes = [integer(ip) ::]
   end subroutine find_place_of_block

   !> The block whose corner, middle or centre a name may be, and which of them.
   pure subroutine part_place_name(name, block, place)
      character(len=*), intent(in) :: name                   !< as the user wrote it
      character(len=:), allocatable, intent(out) :: block    !< name of the block; '' where there is none
      integer(ip), intent(out) :: place                      !< in PLACES; 0: none

      block = ''
      do place = CENTRE, 1, -1
         if (ends_with(upper_case(name), trim(PLACES(place)))) exit
      end do
      if (place > 0) block = name(:len(name) - len_trim(PLACES(place)))
   end subroutine part_place_name

   !> Points as far from one place as from another: of a straight side or an arc its middle.
   pure function is_halfway(points, a, b) result(halfway)
      real(wp), intent(in) :: points(:, :), a(2), b(2)       !< [L]
      logical :: halfway(size(points, 2))
      real(wp), dimension(size(points, 2)) :: to_a, to_b

      to_a = norm2(points - spread(a, 2, size(points, 2)), dim=1)
      to_b = norm2(points - spread(b, 2, size(points, 2)), dim=1)
      halfway = abs(to_a - to_b) <= SAME_PLACE*(to_a + to_b)
   end function is_halfway

end module atrito_sets
