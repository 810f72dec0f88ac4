!> Makes the separator of a cut smaller: elements at the cut change sides.
!>
!> The method of Fiduccia and Mattheyses (19th Design Automation Conference (1982) 175-181), with the nodes that both sides have
!> in place of cut edges: the element whose move saves most nodes goes, even if that costs some, and stays where it is from then on;
!> when that has led nowhere for a while, all is taken back to the best that was there.
!>
!> A node is in the separator when elements of both sides have it. Of each node the elements on either side are counted, so a move
!> changes the counts of its corners alone, and what it saves, the gain, is found from them:
!>
!>     +1 for each corner that the element alone has on its side, while others have it on the other: it leaves the separator,
!>     -1 for each corner that several elements have, all of them on the element's side: it gets into the separator.
!>
!> Gains are -CORNERS..CORNERS, so the elements at the cut wait in as many lists a side, and the best is the first of the highest
!> list that is not empty. A move changes the gains of the elements round its corners alone, so it takes the same few operations
!> in a large mesh as in a small one. Neither side gets smaller than LEAST_SHARE of the elements, unless it was.
module atrito_cut_refinement
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: corner_lists_t, sides_of_cut_t, list_corners, begin_sides, leave_out, refine_cut, CORNERS, LOWER_SIDE, UPPER_SIDE

   integer(ip), parameter :: CORNERS = 4_ip
   integer(ip), parameter :: LOWER_SIDE = 1_ip, UPPER_SIDE = 2_ip

   !> The different corners of elements, and the elements round each node.
   type :: corner_lists_t
      integer(ip), allocatable :: corner(:, :)   !< (4, all elements) 0: none, from there on
      integer(ip), allocatable :: first(:)       !< (nodes + 1) elements round node i: element(first(i):first(i + 1) - 1)
      integer(ip), allocatable :: element(:)     !< one list behind the other, that of node 1 first
   end type corner_lists_t

   !> What is known of elements and nodes. Sets that have no element and no free node in common may be cut at the same time.
   type :: sides_of_cut_t
      type(corner_lists_t), pointer, private :: lists => null()          !< belongs to the caller
      integer(ip), allocatable :: side(:)        !< (all elements) LOWER_SIDE, UPPER_SIDE
      integer(ip), allocatable, private :: gain(:), next(:), previous(:) !< (all elements)
      logical, allocatable, private :: waits(:), moved(:) !< (all elements)
      integer(ip), allocatable, private :: count(:) !< (nodes) elements of the lower side, MANY times those of the upper
   end type sides_of_cut_t

   !> A set that is refined: elements that wait for their move, by what it saves and by their side, the first of each list.
   type :: queue_t
      integer(ip) :: head(-CORNERS:CORNERS, 2) = 0 !< element, by gain and side; 0: none
      integer(ip) :: weight(2) = 0                 !< elements of the sides
      integer(ip) :: least = 0                     !< that each keeps
   end type queue_t

   !> More than the elements round a node.
   integer(ip), parameter :: MANY = 2_ip**15
   integer(ip), parameter :: ONE_OF(2) = [1_ip, MANY], LEFT_OUT = -1_ip
   integer, parameter :: MOST_PASSES = 6
   !> Moves that lead nowhere before a pass ends.
   integer(ip), parameter :: PATIENCE = 30_ip
   !> The share of the elements that each side keeps.
   real, parameter :: LEAST_SHARE = 0.42

contains

   !> The corners of some elements, each node once, and of each node the elements whose corner it is.
   subroutine list_corners(elements, nodes, n_nodes_of, n_nodes, lists)
      integer(ip), intent(in) :: elements(:)                !< of whose corners lists are made; the others have none
      integer(ip), intent(in) :: nodes(:, :), n_nodes_of(:) !< (most nodes, all elements), (all elements)
      integer(ip), intent(in) :: n_nodes                    !< all
      type(corner_lists_t), intent(out) :: lists            !< corners of elements, elements of nodes
      integer(ip) :: i, k, n, node

      allocate (lists%corner(CORNERS, size(n_nodes_of)), source=0_ip)
      do i = 1, size(elements, kind=ip)
         n = 0
         do k = 1, min(CORNERS, n_nodes_of(elements(i)))
            node = nodes(k, elements(i))
            if (any(lists%corner(:n, elements(i)) == node)) cycle
            n = n + 1
            lists%corner(n, elements(i)) = node
         end do
      end do
      call list_holders(n_nodes, lists%corner, lists%first, lists%element)
   end subroutine list_corners

   !> Gets ready to count the elements round nodes on both sides of a cut. Nodes that are not wanted are left out.
   subroutine begin_sides(lists, wanted, sides)
      type(corner_lists_t), intent(in), target :: lists !< stays where it is
      logical, intent(in) :: wanted(:)           !< (nodes) the others do not count
      type(sides_of_cut_t), intent(out) :: sides        !< every count is zero; `side` is the caller's to fill
      integer :: n

      sides%lists => lists
      n = size(lists%corner, 2)
      allocate (sides%side(n), sides%gain(n), sides%next(n), sides%previous(n))
      allocate (sides%waits(n), sides%moved(n), source=.false.)
      sides%count = merge(0_ip, LEFT_OUT, wanted)
   end subroutine begin_sides

   !> Nodes that do not count any more.
   pure subroutine leave_out(nodes, sides)
      integer(ip), intent(in) :: nodes(:)          !< of a separator, which is taken
      type(sides_of_cut_t), intent(inout) :: sides !< counts of these nodes are marked

      sides%count(nodes) = LEFT_OUT
   end subroutine leave_out

   !> Moves elements of a set to the other side of its cut.
   !>
   !> Some passes, until one saves nothing. A pass moves each element once at most, the best first, and notes after which move most
   !> nodes had been saved; what was moved after that is moved back. So it gets out of a dent that costs up to PATIENCE moves, and
   !> ends where it began at the worst. The balance is kept by taking from the heavier side where both have an element of the same
   !> gain, and nothing from a side that has queue%least elements left.
   subroutine refine_cut(element, sides)
      integer(ip), intent(in) :: element(:)        !< of the set, with their sides
      type(sides_of_cut_t), intent(inout) :: sides !< `side` is improved; no other set has these elements
      type(queue_t) :: queue
      integer(ip) :: saved
      integer :: pass

      queue%weight(LOWER_SIDE) = count(sides%side(element) == LOWER_SIDE, kind=ip)
      queue%weight(UPPER_SIDE) = size(element, kind=ip) - queue%weight(LOWER_SIDE)
      queue%least = min(minval(queue%weight), int(LEAST_SHARE*real(size(element)), ip))
      call count_sides(element, sides)
      do pass = 1, MOST_PASSES
         call move_elements(element, sides, queue, saved)
         if (saved == 0) exit
      end do
   end subroutine refine_cut

   !> Counts the elements of a set round each of its nodes, on either side: two counts in one number, the upper one times MANY, so
   !> that a node is looked up once. Nodes that are left out keep their negative number.
   subroutine count_sides(element, sides)
      integer(ip), intent(in) :: element(:)
      type(sides_of_cut_t), intent(inout) :: sides
      integer(ip) :: i, k, v, one

      do i = 1, size(element, kind=ip)
         do k = 1, CORNERS
            v = sides%lists%corner(k, element(i))
            if (v == 0) exit
            if (sides%count(v) > 0) sides%count(v) = 0
         end do
      end do
      do i = 1, size(element, kind=ip)
         one = ONE_OF(sides%side(element(i)))
         do k = 1, CORNERS
            v = sides%lists%corner(k, element(i))
            if (v == 0) exit
            if (sides%count(v) >= 0) sides%count(v) = sides%count(v) + one
         end do
      end do
   end subroutine count_sides

   !> One pass: the elements at the cut wait in the queue by their gains, are moved one after the other, and put those round them
   !> into the queue anew.
   subroutine move_elements(element, sides, queue, saved)
      integer(ip), intent(in) :: element(:)
      type(sides_of_cut_t), intent(inout) :: sides
      type(queue_t), intent(inout) :: queue      !< empty before and after
      integer(ip), intent(out) :: saved
      integer(ip) :: moves(size(element)), n_moves, n_best, now, i, e

      do i = 1, size(element, kind=ip)
         e = element(i)
         if (is_at_cut(sides, e)) call put(e, sides, queue)
      end do
      n_moves = 0
      n_best = 0
      now = 0
      saved = 0
      do while (n_moves - n_best < PATIENCE .and. n_moves < size(element))
         call take_best(queue, e)
         if (e == 0) exit
         now = now + sides%gain(e)
         call move(e, sides, queue)
         n_moves = n_moves + 1
         moves(n_moves) = e
         if (now > saved) then
            saved = now
            n_best = n_moves
         end if
      end do
      call clear(sides, queue)
      do i = n_moves, n_best + 1, -1
         call turn(moves(i), sides, queue%weight)
      end do
      sides%moved(moves(:n_moves)) = .false.
   end subroutine move_elements

   !> Whether a corner of the element has elements of both sides round it.
   pure logical function is_at_cut(sides, e)
      type(sides_of_cut_t), intent(in) :: sides
      integer(ip), intent(in) :: e
      integer(ip) :: k, v

      is_at_cut = .false.
      do k = 1, CORNERS
         v = sides%lists%corner(k, e)
         if (v == 0) return
         is_at_cut = sides%count(v) > MANY .and. iand(sides%count(v), MANY - 1_ip) > 0
         if (is_at_cut) return
      end do
   end function is_at_cut

   !> Nodes that the move of an element to the other side would save.
   pure integer(ip) function gain_of(sides, e) result(gain)
      type(sides_of_cut_t), intent(in) :: sides
      integer(ip), intent(in) :: e
      integer(ip) :: k, v, own, other

      gain = 0
      do k = 1, CORNERS
         v = sides%lists%corner(k, e)
         if (v == 0) return
         if (sides%count(v) < 0) cycle
         own = count_of(sides%side(e), sides%count(v))
         other = count_of(3 - sides%side(e), sides%count(v))
         if (own == 1 .and. other > 0) gain = gain + 1
         if (own > 1 .and. other == 0) gain = gain - 1
      end do
   end function gain_of

   !> The element of the highest gain, of the heavier side where both have one; 0: none may go.
   subroutine take_best(queue, e)
      type(queue_t), intent(in) :: queue
      integer(ip), intent(out) :: e
      integer(ip) :: gain, heavier

      heavier = merge(LOWER_SIDE, UPPER_SIDE, queue%weight(LOWER_SIDE) >= queue%weight(UPPER_SIDE))
      do gain = CORNERS, -CORNERS, -1
         e = 0
         if (queue%weight(heavier) > queue%least) e = queue%head(gain, heavier)
         if (e == 0 .and. queue%weight(3 - heavier) > queue%least) e = queue%head(gain, 3 - heavier)
         if (e /= 0) return
      end do
   end subroutine take_best

   !> Moves an element to the other side, for good in this pass, and finds the gains of those round its corners anew. Those round a
   !> corner with more than two elements on the new side and more than one on the old gain what they did: its part in their gains is
   !> zero before and after.
   subroutine move(e, sides, queue)
      integer(ip), intent(in) :: e
      type(sides_of_cut_t), intent(inout) :: sides
      type(queue_t), intent(inout) :: queue
      integer(ip) :: k, v, h, other, to

      call take_out(e, sides, queue)
      call turn(e, sides, queue%weight)
      sides%moved(e) = .true.
      to = sides%side(e)
      do k = 1, CORNERS
         v = sides%lists%corner(k, e)
         if (v == 0) return
         if (sides%count(v) < 0) cycle
         if (count_of(to, sides%count(v)) > 2 .and. count_of(3 - to, sides%count(v)) > 1) cycle
         do h = sides%lists%first(v), sides%lists%first(v + 1) - 1
            other = sides%lists%element(h)
            if (sides%moved(other)) cycle
            if (sides%waits(other)) call take_out(other, sides, queue)
            if (is_at_cut(sides, other)) call put(other, sides, queue)
         end do
      end do
   end subroutine move

   !> The elements of a side round a node, from its two counts in one number.
   pure integer(ip) function count_of(side, packed)
      integer(ip), intent(in) :: side, packed

      count_of = iand(packed, MANY - 1_ip)
      if (side == UPPER_SIDE) count_of = packed/MANY
   end function count_of

   !> Changes the side of an element, and the counts of its corners.
   pure subroutine turn(e, sides, weight)
      integer(ip), intent(in) :: e
      type(sides_of_cut_t), intent(inout) :: sides
      integer(ip), intent(inout) :: weight(2)
      integer(ip) :: k, v, from

      from = sides%side(e)
      sides%side(e) = 3 - from
      weight(from) = weight(from) - 1
      weight(3 - from) = weight(3 - from) + 1
      do k = 1, CORNERS
         v = sides%lists%corner(k, e)
         if (v == 0) return
         if (sides%count(v) >= 0) sides%count(v) = sides%count(v) - ONE_OF(from) + ONE_OF(3 - from)
      end do
   end subroutine turn

   !> Puts an element first in the list of its gain and side. Lists are linked both ways, so that any member can leave.
   pure subroutine put(e, sides, queue)
      integer(ip), intent(in) :: e
      type(sides_of_cut_t), intent(inout) :: sides
      type(queue_t), intent(inout) :: queue

      sides%gain(e) = gain_of(sides, e)
      associate (head => queue%head(sides%gain(e), sides%side(e)))
         sides%next(e) = head
         sides%previous(e) = 0
         if (head /= 0) sides%previous(head) = e
         head = e
      end associate
      sides%waits(e) = .true.
   end subroutine put

   pure subroutine take_out(e, sides, queue)
      integer(ip), intent(in) :: e
      type(sides_of_cut_t), intent(inout) :: sides
      type(queue_t), intent(inout) :: queue

      if (sides%previous(e) /= 0) then
         sides%next(sides%previous(e)) = sides%next(e)
      else
         queue%head(sides%gain(e), sides%side(e)) = sides%next(e)
      end if
      if (sides%next(e) /= 0) sides%previous(sides%next(e)) = sides%previous(e)
      sides%waits(e) = .false.
   end subroutine take_out

   pure subroutine clear(sides, queue)
      type(sides_of_cut_t), intent(inout) :: sides
      type(queue_t), intent(inout) :: queue
      integer(ip) :: gain, side, e

      do side = LOWER_SIDE, UPPER_SIDE
         do gain = -CORNERS, CORNERS
            e = queue%head(gain, side)
            do while (e /= 0)
               sides%waits(e) = .false.
               e = sides%next(e)
            end do
         end do
      end do
      queue%head = 0
   end subroutine clear

end module atrito_cut_refinement
