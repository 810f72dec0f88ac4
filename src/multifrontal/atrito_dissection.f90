!> Elimination order for the sparse solver: nested dissection by the places of the elements.
!>
!> A set of elements is cut across its longer side, counted in elements; the nodes that both parts have are the separator and are
!> eliminated last, after the two parts, which are cut in turn (George, SIAM J. Numer. Anal. 10 (1973) 345-363). Near the optimum
!> for plane meshes of even sizes, whatever the numbering, in n log n steps: minimum degree takes 0.7 to 3 times the operations,
!> depending on the numbering. Sets of the same shape are cut alike, so that regular meshes have few different fronts. A guide
!> gives cuts that were found otherwise, and has them refined.
!>
!> The largest sets are cut level by level, the sets of a level by several threads; then each of the others goes to one thread.
module atrito_dissection
   use atrito_cut_refinement, only: corner_lists_t, sides_of_cut_t, begin_sides, leave_out, refine_cut, &
                                    LOWER_SIDE, UPPER_SIDE
   use atrito_growth, only: grow
   use atrito_kinds, only: ip, lp, wp
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: dissect, dissection_t, dissection_guide_t

   !> The order of the nodes, and its parts in postorder: each separator after the two parts that it divides.
   type :: dissection_t
      integer(ip) :: n_nodes = 0
      integer(ip), allocatable :: order(:)       !< (n_nodes)
      integer(ip) :: n = 0                       !< parts
      integer(ip), allocatable :: last(:)        !< (n or more) last place of each part in the order
      integer(ip), allocatable :: parent(:)      !< (n or more) 0: none
      integer(ip), allocatable :: element(:)     !< the elements in the order of the parts that they belong to
      real(wp) :: work = 0.0_wp                  !< sum of (nodes of a separator)**3
      real(wp) :: regular_work = 0.0_wp          !< the same with separators no longer than those of a square of a regular mesh
   end type dissection_t

   !> Where to cut, in place of what the places of the elements say.
   type :: dissection_guide_t
      real(wp) :: cosine = 1.0_wp, sine = 0.0_wp !< of the angle from the first axis to the direction across which is cut
      integer :: n_halvings = 0                  !< the first cuts of each element are given: sets, halves, halves of these ...
      integer(ip), allocatable :: half(:)        !< (all elements) bit n_halvings - 1: the half in the first cut, and so on
      logical :: refines = .false.               !< elements change sides where that makes the separator smaller
      type(corner_lists_t) :: lists              !< where it does
   end type dissection_guide_t

   !> Elements with their centres, a set a run of them.
   type :: pieces_t
      integer(ip), allocatable :: element(:)
      real(wp), allocatable :: centre(:, :)      !< (2, elements) [L]
      real(wp), allocatable :: extent(:, :)      !< (2, all elements) [L] of those in the list
   end type pieces_t

   !> What is known of the nodes, and their order. Parts of a set have no node in common that is not taken: they share these lists.
   type :: marks_t
      logical, allocatable :: taken(:)           !< in the order already, or not wanted there
      integer(lp), allocatable :: upper_of(:)    !< last cut that had the node in its upper part
      integer(ip), allocatable :: order(:)       !< each set has its own places there
      type(sides_of_cut_t) :: sides              !< where cuts are refined
   end type marks_t

   !> Sets of so few nodes, counted with each element, are not cut any more.
   integer(ip), parameter :: LEAF = 64_ip
   !> A set that is cut by itself, and not within the recursion: number k, its parts 2 k and 2 k + 1.
   type :: set_t
      integer(ip) :: first = 1, last = 0         !< elements
      integer(ip) :: n_before = 0, n_free = 0    !< nodes that stand before its own in the order, and its own
      logical :: divided = .false.               !< into two sets
      integer(ip), allocatable :: separator(:)   !< between them
      type(dissection_t) :: parts                !< where it is not
      integer(ip) :: root = 0                    !< the last one
   end type set_t

   !> Sets of more elements are cut by themselves, level by level, so often: threads share them out.
   integer(ip), parameter :: LARGE = 4096_ip
   integer, parameter :: LEVELS = 6
   !> Elements whose median and mean stand for those of all.
   integer, parameter :: MOST_SAMPLES = 63
   !> Elements closer to the cut than this share of the extent lie on it: round-off of a regular mesh.
   real(wp), parameter :: ON_CUT = 1.0e-6_wp
   !> A cut in the middle is good when each part has this share of the elements.
   real(wp), parameter :: BALANCED = 0.4_wp
   !> Elements from which on a cut is refined, where it is asked for.
   integer(ip), parameter :: WORTH_REFINING = 256_ip
   !> A number a cut lasts for so many levels.
   integer(lp), parameter :: LAST_CUT = 2_lp**61

contains

   !> Orders the wanted nodes of some elements.
   subroutine dissect(elements, nodes, n_nodes_of, x, wanted, guide, parts)
      integer(ip), intent(in) :: elements(:)     !< which
      integer(ip), intent(in) :: nodes(:, :)     !< (most nodes, all elements)
      integer(ip), intent(in) :: n_nodes_of(:)   !< (all elements) nodes of each; the first four or all are its corners
      real(wp), intent(in) :: x(:, :)            !< (2, all nodes) [L]
      logical, intent(in) :: wanted(:)           !< (all nodes); those that are belong to the elements
      type(dissection_guide_t), intent(in) :: guide
      type(dissection_t), intent(out) :: parts
      type(pieces_t) :: pieces
      type(marks_t) :: marks
      type(set_t) :: sets(2**(LEVELS + 1) - 1)
      integer(ip) :: i, root

      allocate (pieces%centre(2, size(elements)), pieces%extent(2, size(n_nodes_of)))
      pieces%element = elements
      !$omp parallel do default(none) shared(elements, x, nodes, n_nodes_of, guide, pieces) &
      !$omp if(is_shared(size(elements, kind=ip)))
      do i = 1, size(elements, kind=ip)
         call measure(x, nodes(:min(4_ip, n_nodes_of(elements(i))), elements(i)), guide, pieces%centre(:, i), &
                      pieces%extent(:, elements(i)))
      end do
      !$omp end parallel do
      marks%taken = .not. wanted
      if (guide%refines) call begin_sides(guide%lists, wanted, marks%sides)
      allocate (marks%upper_of(size(wanted)), source=0_lp)
      sets(1)%last = size(elements, kind=ip)
      sets(1)%n_free = count(wanted, kind=ip)
      allocate (marks%order(sets(1)%n_free))
      call divide_sets(nodes, n_nodes_of, guide, pieces, marks, sets)
      !$omp parallel do schedule(dynamic, 1) default(none) shared(nodes, n_nodes_of, guide, pieces, marks, sets) &
      !$omp if(size(elements) > LARGE)
      do i = 1, size(sets, kind=ip)
         associate (set => sets(i))
            if (set%divided .or. set%first > set%last) cycle
            call begin_parts(set%parts, set%n_before)
            call cut(nodes, n_nodes_of, guide, pieces%element(set%first:set%last), pieces%centre(:, set%first:set%last), &
                     pieces%extent, int(i, lp), marks, set%parts, set%root)
         end associate
      end do
      !$omp end parallel do
      call begin_parts(parts, 0_ip)
      call join(sets, 1_ip, marks%order, parts, root)
      call move_alloc(marks%order, parts%order)
      call move_alloc(pieces%element, parts%element)
   end subroutine dissect

   !> Cuts the large sets, level by level. Sets have no element in common, nor a node that is not taken.
   subroutine divide_sets(nodes, n_nodes_of, guide, pieces, marks, sets)
      integer(ip), intent(in) :: nodes(:, :), n_nodes_of(:)
      type(dissection_guide_t), intent(in) :: guide
      type(pieces_t), intent(inout) :: pieces
      type(marks_t), intent(inout) :: marks
      type(set_t), intent(inout) :: sets(:)      !< the first is given
      integer(ip) :: k
      integer :: level

      do level = 0, LEVELS - 1
         !$omp parallel do schedule(dynamic, 1) default(none) shared(nodes, n_nodes_of, guide, pieces, marks, sets, level) &
         !$omp if(level > 0 .and. sets(1)%last > LARGE)
         do k = 2**level, 2**(level + 1) - 1
            if (sets(k)%last - sets(k)%first < LARGE) cycle
            call divide(nodes, n_nodes_of, guide, pieces%element(sets(k)%first:sets(k)%last), &
                        pieces%centre(:, sets(k)%first:sets(k)%last), pieces%extent, int(k, lp), marks, sets(k), sets(2*k), &
                        sets(2*k + 1))
         end do
         !$omp end parallel do
      end do
   end subroutine divide_sets

   subroutine divide(nodes, n_nodes_of, guide, element, centre, extent, number, marks, set, lower, upper)
      integer(ip), intent(in) :: nodes(:, :), n_nodes_of(:)
      type(dissection_guide_t), intent(in) :: guide
      integer(ip), intent(inout), contiguous :: element(:)
      real(wp), intent(inout), contiguous :: centre(:, :)
      real(wp), intent(in), contiguous :: extent(:, :)
      integer(lp), intent(in) :: number          !< of the cut: 2 number and 2 number + 1 are those of its parts
      type(marks_t), intent(inout) :: marks
      type(set_t), intent(inout) :: set, lower, upper
      integer(ip) :: n_lower

      call split(guide, number, element, centre, extent, marks, n_lower)
      if (n_lower == 0) return
      call take_separator(nodes, n_nodes_of, element, n_lower, number, marks%taken, marks%upper_of, set%separator, upper%n_free)
      if (guide%refines) call leave_out(set%separator, marks%sides)
      set%divided = .true.
      lower%first = set%first
      lower%last = set%first + n_lower - 1
      lower%n_before = set%n_before
      lower%n_free = set%n_free - upper%n_free - size(set%separator, kind=ip)
      upper%first = lower%last + 1
      upper%last = set%last
      upper%n_before = set%n_before + lower%n_free
   end subroutine divide

   !> Appends the parts of a set to others: those of its lower part, those of its upper part, the separator.
   recursive pure subroutine join(sets, k, order, parts, root)
      type(set_t), intent(in) :: sets(:)
      integer(ip), intent(in) :: k
      integer(ip), intent(inout) :: order(:)
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(out) :: root           !< the last part made; 0: the set has no nodes
      integer(ip) :: children(2), before

      if (sets(k)%divided) then
         before = parts%n_nodes
         call join(sets, 2*k, order, parts, children(1))
         call join(sets, 2*k + 1, order, parts, children(2))
         call add_part(before, sets(k)%separator, children, order, parts, root)
      else
         root = sets(k)%root
         if (root > 0) call append(parts, sets(k)%parts, root)
      end if
   end subroutine join

   pure subroutine measure(x, corners, guide, centre, extent)
      real(wp), intent(in) :: x(:, :)
      integer(ip), intent(in) :: corners(:)
      type(dissection_guide_t), intent(in) :: guide
      real(wp), intent(out) :: centre(2), extent(2)
      real(wp) :: low(2), high(2), place(2)
      integer(ip) :: i

      centre = 0.0_wp
      low = huge(1.0_wp)
      high = -huge(1.0_wp)
      do i = 1, size(corners, kind=ip)
         place = x(:, corners(i))
         if (abs(guide%sine) > 0.0_wp) place = [guide%cosine*place(1) + guide%sine*place(2), &
                                                guide%cosine*place(2) - guide%sine*place(1)]
         centre = centre + place/real(size(corners), wp)
         low = min(low, place)
         high = max(high, place)
      end do
      extent = high - low
   end subroutine measure

   !> No parts so far, behind some nodes of others.
   pure subroutine begin_parts(parts, n_nodes)
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(in) :: n_nodes
      integer(ip), parameter :: ROOM = 64_ip

      parts%n_nodes = n_nodes
      allocate (parts%last(ROOM), parts%parent(ROOM))
   end subroutine begin_parts

   !> Appends the nodes of a set to the parts. The depth of the recursion is that of the tree, about log2 of the elements.
   recursive subroutine cut(nodes, n_nodes_of, guide, element, centre, extent, number, marks, parts, root)
      integer(ip), intent(in) :: nodes(:, :), n_nodes_of(:)
      type(dissection_guide_t), intent(in) :: guide
      integer(ip), intent(inout), contiguous :: element(:)
      real(wp), intent(inout), contiguous :: centre(:, :)
      real(wp), intent(in), contiguous :: extent(:, :)
      integer(lp), intent(in) :: number          !< of the cut: 2 number and 2 number + 1 are those of its parts
      type(marks_t), intent(inout) :: marks
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(out) :: root           !< the last part made; 0: the set has no nodes
      integer(ip) :: n_lower, n_upper, children(2), before
      integer(ip), allocatable :: separator(:)

      before = parts%n_nodes
      n_lower = 0
      if (is_large(n_nodes_of, element) .and. number < LAST_CUT) call split(guide, number, element, centre, extent, marks, n_lower)
      if (n_lower == 0) then
         call take_rest(nodes, n_nodes_of, element, marks%taken, marks%order, parts, root)
         return
      end if
      call take_separator(nodes, n_nodes_of, element, n_lower, number, marks%taken, marks%upper_of, separator, n_upper)
      if (guide%refines) call leave_out(separator, marks%sides)
      call cut(nodes, n_nodes_of, guide, element(:n_lower), centre(:, :n_lower), extent, 2*number, marks, parts, children(1))
      call cut(nodes, n_nodes_of, guide, element(n_lower + 1:), centre(:, n_lower + 1:), extent, 2*number + 1, marks, parts, &
               children(2))
      call add_part(before, separator, children, marks%order, parts, root)
   end subroutine cut

   pure logical function is_large(n_nodes_of, element)
      integer(ip), intent(in) :: n_nodes_of(:), element(:)

      is_large = size(element) > LEAF
      if (.not. is_large) is_large = sum(n_nodes_of(element)) > LEAF
   end function is_large

   !> Puts the elements below the cut first; their order stays. n_lower = 0: there is no cut.
   subroutine split(guide, number, element, centre, extent, marks, n_lower)
      type(dissection_guide_t), intent(in) :: guide
      integer(lp), intent(in) :: number          !< of the cut
      integer(ip), intent(inout), contiguous :: element(:)
      real(wp), intent(inout), contiguous :: centre(:, :)
      real(wp), intent(in), contiguous :: extent(:, :)
      type(marks_t), intent(inout) :: marks
      integer(ip), intent(out) :: n_lower
      logical :: is_upper(size(element))
      real(wp) :: place
      integer :: along, bit

      bit = guide%n_halvings - 1 - depth_of(number)
      if (bit >= 0) is_upper = btest(guide%half(element), bit)
      if (bit >= 0 .and. any(is_upper) .and. .not. all(is_upper)) then
      else
         call choose_cut(element, centre, extent, along, place)
         is_upper = centre(along, :) > place
      end if
      if (guide%refines .and. size(element) > WORTH_REFINING) then
         marks%sides%side(element) = merge(UPPER_SIDE, LOWER_SIDE, is_upper)
         call refine_cut(guide%lists, element, marks%sides)
         is_upper = marks%sides%side(element) == UPPER_SIDE
      end if
      call sort_by_side(is_upper, element, centre, n_lower)
   end subroutine split

   !> Cuts that led to the set of a cut.
   pure integer function depth_of(number)
      integer(lp), intent(in) :: number

      depth_of = int(bit_size(number)) - 1 - leadz(number)
   end function depth_of

   pure subroutine sort_by_side(is_upper, element, centre, n_lower)
      logical, intent(in) :: is_upper(:)
      integer(ip), intent(inout), contiguous :: element(:)
      real(wp), intent(inout), contiguous :: centre(:, :)
      integer(ip), intent(out) :: n_lower
      integer(ip) :: upper(size(element)), i, n_upper
      real(wp) :: upper_centre(2, size(element))

      n_lower = 0
      n_upper = 0
      do i = 1, size(element, kind=ip)
         if (is_upper(i)) then
            n_upper = n_upper + 1
            upper(n_upper) = element(i)
            upper_centre(:, n_upper) = centre(:, i)
         else
            n_lower = n_lower + 1
            element(n_lower) = element(i)
            centre(:, n_lower) = centre(:, i)
         end if
      end do
      element(n_lower + 1:) = upper(:n_upper)
      centre(:, n_lower + 1:) = upper_centre(:, :n_upper)
      if (n_upper == 0) n_lower = 0
   end subroutine sort_by_side

   !> Where to cut: across the longer side, in the middle, or where that leaves too few on one side, at the median of a sample.
   pure subroutine choose_cut(element, centre, extent, along, place)
      integer(ip), intent(in), contiguous :: element(:)
      real(wp), intent(in), contiguous :: centre(:, :), extent(:, :)
      integer, intent(out) :: along              !< 1 or 2
      real(wp), intent(out) :: place             !< [L]
      real(wp) :: low(2), high(2), one(2), margin, share
      integer(ip) :: i

      low = centre(:, 1)
      high = low
      do i = 2, size(centre, 2, kind=ip)
         low = min(low, centre(:, i))
         high = max(high, centre(:, i))
      end do
      one = sample_mean(element, extent)
      ! longer in elements, not in length: flat elements are few along their long side; as many both ways: always across the same
      along = merge(1, 2, (high(1) - low(1))*one(2) >= (high(2) - low(2))*one(1)*(1.0_wp - ON_CUT))
      if (.not. high(along) > low(along)) along = 3 - along
      margin = ON_CUT*(high(along) - low(along))
      place = 0.5_wp*low(along) + 0.5_wp*high(along) + margin
      share = real(count(centre(along, :) <= place), wp)/real(size(centre, 2), wp)
      if (share >= BALANCED .and. share <= 1.0_wp - BALANCED) return
      place = sample_median(centre, along) + margin
      ! more than half of the elements at the upper end: it is cut off
      if (place >= high(along) - margin) place = place - 2.0_wp*margin
      if (.not. place >= low(along)) place = 0.5_wp*low(along) + 0.5_wp*high(along)
   end subroutine choose_cut

   !> The element that is taken for the i-th of n at equal distances in a list.
   pure integer function sample_place(i, n, length)
      integer, intent(in) :: i, n
      integer, intent(in) :: length              !< of the list

      sample_place = 1 + int((real(i, wp) - 0.5_wp)*real(length, wp)/real(n, wp))
   end function sample_place

   !> Mean extents of some elements of a list.
   pure function sample_mean(element, extent) result(mean)
      integer(ip), intent(in), contiguous :: element(:)
      real(wp), intent(in), contiguous :: extent(:, :)
      real(wp) :: mean(2)
      integer :: i, n

      n = min(MOST_SAMPLES, size(element))
      mean = 0.0_wp
      do i = 1, n
         mean = mean + extent(:, element(sample_place(i, n, size(element))))/real(n, wp)
      end do
   end function sample_mean

   !> Median of coordinates of elements taken at equal distances from the list.
   pure real(wp) function sample_median(centre, along) result(median)
      real(wp), intent(in), contiguous :: centre(:, :)
      integer, intent(in) :: along
      real(wp) :: sorted(MOST_SAMPLES), next
      integer :: i, j, n

      n = min(MOST_SAMPLES, size(centre, 2))
      do i = 1, n
         next = centre(along, sample_place(i, n, size(centre, 2)))
         do j = i - 1, 1, -1
            if (sorted(j) <= next) exit
            sorted(j + 1) = sorted(j)
         end do
         sorted(j + 1) = next
      end do
      median = sorted((n + 1)/2)
   end function sample_median

   !> Takes the free nodes that elements of both parts have.
   pure subroutine take_separator(nodes, n_nodes_of, element, n_lower, number, taken, upper_of, separator, n_upper)
      integer(ip), intent(in) :: nodes(:, :), n_nodes_of(:), element(:), n_lower
      integer(lp), intent(in) :: number
      logical, intent(inout) :: taken(:)
      integer(lp), intent(inout) :: upper_of(:)
      integer(ip), allocatable, intent(out) :: separator(:)
      integer(ip), intent(out) :: n_upper        !< free nodes that are left to the upper part
      integer(ip) :: i, k, n, node

      n_upper = 0
      do i = n_lower + 1, size(element, kind=ip)
         do k = 1, n_nodes_of(element(i))
            node = nodes(k, element(i))
            if (taken(node) .or. upper_of(node) == number) cycle
            upper_of(node) = number
            n_upper = n_upper + 1
         end do
      end do
      allocate (separator(64))
      n = 0
      do i = 1, n_lower
         do k = 1, n_nodes_of(element(i))
            node = nodes(k, element(i))
            if (taken(node)) cycle
            if (upper_of(node) /= number) cycle
            taken(node) = .true.
            if (n == size(separator)) call grow(separator, 2*int(n, lp))
            n = n + 1
            separator(n) = node
         end do
      end do
      separator = separator(:n)
      n_upper = n_upper - n
   end subroutine take_separator

   !> Makes a part of the free nodes of a set that is not cut.
   pure subroutine take_rest(nodes, n_nodes_of, element, taken, order, parts, root)
      integer(ip), intent(in) :: nodes(:, :), n_nodes_of(:), element(:)
      logical, intent(inout) :: taken(:)
      integer(ip), intent(inout) :: order(:)
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(out) :: root
      integer(ip) :: i, k, node, before

      before = parts%n_nodes
      do i = 1, size(element, kind=ip)
         do k = 1, n_nodes_of(element(i))
            node = nodes(k, element(i))
            if (taken(node)) cycle
            taken(node) = .true.
            parts%n_nodes = parts%n_nodes + 1
            order(parts%n_nodes) = node
         end do
      end do
      root = 0
      if (parts%n_nodes == before) return
      call close_part(parts)
      root = parts%n
   end subroutine take_rest

   !> Adds a separator, the parent of two parts where they are.
   pure subroutine add_part(before, separator, children, order, parts, root)
      integer(ip), intent(in) :: before          !< nodes that stood in the order before those of the set
      integer(ip), intent(in) :: separator(:), children(2)
      integer(ip), intent(inout) :: order(:)
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(out) :: root
      integer(ip) :: n, i

      root = maxval(children)
      n = size(separator, kind=ip)
      if (n == 0 .and. minval(children) == 0) return
      order(parts%n_nodes + 1:parts%n_nodes + n) = separator
      parts%n_nodes = parts%n_nodes + n
      call add_work(n, parts%n_nodes - before, parts)
      call close_part(parts)
      root = parts%n
      do i = 1, 2
         if (children(i) > 0) parts%parent(children(i)) = root
      end do
   end subroutine add_part

   !> Adds the work of a separator, and what it would be were its set a square of a regular mesh.
   pure subroutine add_work(n_separator, n_nodes, parts)
      integer(ip), intent(in) :: n_separator, n_nodes !< of the set, separator included
      type(dissection_t), intent(inout) :: parts
      real(wp) :: work

      work = real(n_separator, wp)**3
      parts%work = parts%work + work
      parts%regular_work = parts%regular_work + min(work, real(n_nodes, wp)**1.5_wp)
   end subroutine add_work

   !> Ends a part at the last node; it has no parent yet.
   pure subroutine close_part(parts)
      type(dissection_t), intent(inout) :: parts

      call make_room(parts, 1_ip)
      parts%n = parts%n + 1
      parts%last(parts%n) = parts%n_nodes
      parts%parent(parts%n) = 0
   end subroutine close_part

   !> Puts parts behind others; their nodes stand behind those of the others already.
   pure subroutine append(parts, more, root)
      type(dissection_t), intent(inout) :: parts
      type(dissection_t), intent(in) :: more
      integer(ip), intent(inout) :: root         !< a part of those that are added, or 0

      call make_room(parts, more%n)
      parts%last(parts%n + 1:parts%n + more%n) = more%last(:more%n)
      parts%parent(parts%n + 1:parts%n + more%n) = merge(more%parent(:more%n) + parts%n, 0_ip, more%parent(:more%n) > 0)
      if (root > 0) root = root + parts%n
      parts%n_nodes = more%n_nodes
      parts%n = parts%n + more%n
      parts%work = parts%work + more%work
      parts%regular_work = parts%regular_work + more%regular_work
   end subroutine append

   pure subroutine make_room(parts, n)
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(in) :: n

      if (parts%n + n <= size(parts%last)) return
      call grow(parts%last, 2*int(parts%n + n, lp))
      call grow(parts%parent, 2*int(parts%n + n, lp))
   end subroutine make_room

end module atrito_dissection
