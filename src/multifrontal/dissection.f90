!> Elimination order for the sparse solver: nested dissection by the places of the elements.
!>
!> A set of elements is cut across its longer side, counted in elements; the nodes that both parts have are the separator and are
!> eliminated last, after the two parts, which are cut in turn (George, SIAM J. Numer. Anal. 10 (1973) 345-363). Near the optimum
!> for plane meshes of even sizes, whatever the numbering, in n log n steps: minimum degree takes 0.7 to 3 times the operations,
!> depending on the numbering. Sets of the same shape are cut alike, so that regular meshes have few different fronts. A guide
!> gives cuts that were found otherwise, and has them refined.
!>
!> The parts of a large set are cut by threads of their own.
module atrito_dissection
   use atrito_cut_refinement, only: corner_lists_t, sides_of_cut_t, begin_sides, leave_out, refine_cut, LOWER_SIDE, UPPER_SIDE
   use atrito_kinds, only: ip, lp, wp
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: dissect, dissection_t, dissection_guide_t, sample_place

   !> The order of the nodes, and its parts in postorder: each separator after the two parts that it divides.
   type :: dissection_t
      integer(ip) :: n_nodes = 0                 !< nodes that are ordered
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

   !> What is known of elements and nodes. A set is a range of the list of elements. Parts of a set have no node in common that is
   !> not taken: threads share these lists.
   type :: workspace_t
      integer(ip), pointer :: nodes(:, :) => null(), n_nodes_of(:) => null() !< (most nodes, all elements), (all elements)
      type(dissection_guide_t), pointer :: guide => null() !< belongs to the caller
      integer(ip), allocatable :: element(:)               !< (elements) those of a part stand together
      real(wp), allocatable :: centre(:, :)                !< (2, elements) [L]
      real(wp), allocatable :: extent(:, :)                !< (2, all elements) [L] of those in the list
      logical, allocatable :: taken(:)                     !< in the order already, or not wanted there
      integer(lp), allocatable :: upper_of(:)              !< last cut that had the node in its upper part
      integer(ip), allocatable :: order(:)                 !< each set has its own places there
      type(sides_of_cut_t) :: sides                        !< where cuts are refined
   end type workspace_t

   !> Sets of so few nodes, counted with each element, are not cut any more.
   integer(ip), parameter :: LEAF = 64_ip
   !> Sets of more elements are shared out to threads.
   integer(ip), parameter :: LARGE = 4096_ip
   !> Elements whose median and mean stand for those of all.
   integer(ip), parameter :: MOST_SAMPLES = 63_ip
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
   !>
   !>     1. measure         middle and extent of each element, in the axes of the guide
   !>     2. split           a set of elements in two, by the guide's halves or a line (choose_cut); refined where asked for
   !>     3. take_separator  the free nodes that elements of both parts have
   !>     4. the same with each part, until a set has few nodes (LEAF); these are a part of the order as they come (take_rest)
   !>     5. add_part        order: lower part, upper part, separator
   !>
   !> Why the separator comes last. To eliminate a node couples all its neighbours that are still there. No element joins a node of
   !> the lower part with one of the upper part, so nothing of the one couples to the other until the separator is reached, whose
   !> nodes are few: sqrt(n) of n in a square. Its full matrix takes some n^(3/2) operations; two levels further down there are
   !> four separators half as long, which take half of that together. All cuts of a level look at each element once, and there are
   !> log2(n) levels.
   !>
   !> Threads. A set knows how many free nodes it has before it is cut, so each part knows its places in the order, and parts are
   !> cut at the same time. The order is the same for any number of threads.
   subroutine dissect(elements, nodes, n_nodes_of, x, wanted, guide, parts)
      integer(ip), intent(in) :: elements(:)                !< which
      integer(ip), intent(in), target :: nodes(:, :)        !< (most nodes, all elements)
      integer(ip), intent(in), target :: n_nodes_of(:) !< (all elements) nodes of each; the first four or all stand for its corners
      real(wp), intent(in) :: x(:, :)                       !< (2, all nodes) [L]
      logical, intent(in) :: wanted(:)                      !< (all nodes); those that are belong to the elements
      type(dissection_guide_t), intent(in), target :: guide !< without halvings and refinement: by the places alone
      type(dissection_t), intent(out) :: parts              !< order of the wanted nodes
      type(workspace_t) :: work
      integer(ip) :: i, n, root

      n = size(elements, kind=ip)
      work%nodes => nodes
      work%n_nodes_of => n_nodes_of
      work%guide => guide
      work%element = elements
      allocate (work%centre(2, n), work%extent(2, size(n_nodes_of)))
      !$omp parallel do default(none) shared(elements, x, nodes, n_nodes_of, guide, work, n) if(is_shared(n))
      do i = 1, n
         call measure(x, nodes(:min(4_ip, n_nodes_of(elements(i))), elements(i)), guide, work%centre(:, i), &
                      work%extent(:, elements(i)))
      end do
      !$omp end parallel do
      work%taken = .not. wanted
      if (guide%refines) call begin_sides(guide%lists, wanted, work%sides)
      allocate (work%upper_of(size(wanted)), source=0_lp)
      allocate (work%order(count(wanted)))
      call begin_parts(0_ip, size(work%order, kind=ip), parts)
      !$omp parallel default(none) shared(n, work, parts, root) if(n > LARGE)
      !$omp single
      call cut(1_ip, n, 1_lp, size(work%order, kind=ip), work, parts, root)
      !$omp end single
      !$omp end parallel
      call move_alloc(work%order, parts%order)
      call move_alloc(work%element, parts%element)
   end subroutine dissect

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
   pure subroutine begin_parts(n_nodes, n_free, parts)
      integer(ip), intent(in) :: n_nodes
      integer(ip), intent(in) :: n_free          !< nodes to come
      type(dissection_t), intent(inout) :: parts

      parts%n_nodes = n_nodes
      allocate (parts%last(2*n_free), parts%parent(2*n_free)) ! most parts; what is not touched takes no memory
   end subroutine begin_parts

   !> Appends the nodes of a set to the parts. The depth of the recursion is that of the tree, about log2 of the elements.
   recursive subroutine cut(first, last, number, n_free, work, parts, root)
      integer(ip), intent(in) :: first, last     !< elements of the set
      integer(lp), intent(in) :: number          !< of the cut: 2 number and 2 number + 1 are those of its parts
      integer(ip), intent(in) :: n_free          !< nodes of the set that are not taken
      type(workspace_t), intent(inout) :: work
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(out) :: root           !< the last part made; 0: the set has no nodes
      integer(ip) :: middle, n_lower, n_upper, children(2), before
      integer(ip), allocatable :: separator(:)
      type(dissection_t) :: upper

      before = parts%n_nodes
      middle = last
      if (is_large(work, first, last) .and. number < LAST_CUT) call split(first, last, number, work, middle)
      if (middle < first .or. middle == last) then
         call take_rest(first, last, work, parts, root)
         return
      end if
      call take_separator(first, middle, last, number, work, separator, n_upper)
      n_lower = n_free - n_upper - size(separator, kind=ip)
      if (last - first < LARGE) then
         call cut(first, middle, 2*number, n_lower, work, parts, children(1))
         call cut(middle + 1, last, 2*number + 1, n_upper, work, parts, children(2))
      else
         call begin_parts(before + n_lower, n_upper, upper)
         !$omp task default(none) shared(work, upper, children) firstprivate(middle, last, number, n_upper)
         call cut(middle + 1, last, 2*number + 1, n_upper, work, upper, children(2))
         !$omp end task
         call cut(first, middle, 2*number, n_lower, work, parts, children(1))
         !$omp taskwait
         call append(upper, parts, children(2))
      end if
      call add_part(before, separator, children, work%order, parts, root)
   end subroutine cut

   pure logical function is_large(work, first, last)
      type(workspace_t), intent(in) :: work
      integer(ip), intent(in) :: first, last

      is_large = last - first >= LEAF
      if (.not. is_large) is_large = sum(work%n_nodes_of(work%element(first:last))) > LEAF
   end function is_large

   !> Puts the elements below the cut first; their order stays.
   subroutine split(first, last, number, work, middle)
      integer(ip), intent(in) :: first, last
      integer(lp), intent(in) :: number          !< of the cut
      type(workspace_t), intent(inout) :: work
      integer(ip), intent(out) :: middle         !< the last one below; first - 1 or last: there is no cut
      logical :: is_upper(last - first + 1)
      real(wp) :: place
      integer :: along, bit

      ! of the halvings the one that belongs to the cuts that led to this set: number has one binary digit more than they are
      bit = int(work%guide%n_halvings - (bit_size(number) - leadz(number)))
      associate (element => work%element(first:last), centre => work%centre(:, first:last))
         is_upper = .false.
         if (bit >= 0) is_upper = btest(work%guide%half(element), bit)
         if (all(is_upper) .or. .not. any(is_upper)) then
            call choose_cut(element, centre, work%extent, along, place)
            is_upper = centre(along, :) > place
         end if
         if (work%guide%refines .and. size(element) > WORTH_REFINING) then
            work%sides%side(element) = merge(UPPER_SIDE, LOWER_SIDE, is_upper)
            call refine_cut(element, work%sides)
            is_upper = work%sides%side(element) == UPPER_SIDE
         end if
         call sort_by_side(is_upper, element, centre, middle)
      end associate
      middle = first + middle - 1
   end subroutine split

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
   end subroutine sort_by_side

   !> Where to cut: across the longer side, in the middle, or where that leaves too few on one side, at the median of a sample.
   !>
   !> The side counts in elements: the extent of the set over the mean extent of an element, both ways. The middle comes first,
   !> since sets of one shape are then cut alike and have equal fronts. It is taken where each part has BALANCED of the elements at
   !> least; else the median of a sample is, which in a graded mesh is where the elements are. `margin` moves the line off the
   !> middles of elements that lie on it, so that rounding of the coordinates does not put some of a row on either side.
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
   pure integer(ip) function sample_place(i, n, length)
      integer(ip), intent(in) :: i, n            !< which sample, 1 .. n, of how many
      integer(ip), intent(in) :: length          !< of the list

      sample_place = 1_ip + int((real(i, wp) - 0.5_wp)*real(length, wp)/real(n, wp), ip)
   end function sample_place

   !> Mean extents of some elements of a list.
   pure function sample_mean(element, extent) result(mean)
      integer(ip), intent(in), contiguous :: element(:)
      real(wp), intent(in), contiguous :: extent(:, :)
      real(wp) :: mean(2)
      integer(ip) :: i, n

      n = min(MOST_SAMPLES, size(element, kind=ip))
      mean = 0.0_wp
      do i = 1, n
         mean = mean + extent(:, element(sample_place(i, n, size(element, kind=ip))))/real(n, wp)
      end do
   end function sample_mean

   !> Median of coordinates of elements taken at equal distances from the list.
   pure real(wp) function sample_median(centre, along) result(median)
      real(wp), intent(in), contiguous :: centre(:, :)
      integer, intent(in) :: along
      real(wp) :: sorted(MOST_SAMPLES), next
      integer(ip) :: i, j, n

      n = min(MOST_SAMPLES, size(centre, 2, kind=ip))
      do i = 1, n
         next = centre(along, sample_place(i, n, size(centre, 2, kind=ip)))
         do j = i - 1, 1, -1
            if (sorted(j) <= next) exit
            sorted(j + 1) = sorted(j)
         end do
         sorted(j + 1) = next
      end do
      median = sorted((n + 1)/2)
   end function sample_median

   !> Takes the free nodes that elements of both parts have.
   !>
   !> Each free node of the upper part is marked with the number of the cut; a node of the lower part that has the mark is in both.
   !> The number is another one in each cut, so marks are never taken off, and the time is that of the nodes of the set's elements.
   subroutine take_separator(first, middle, last, number, work, separator, n_upper)
      integer(ip), intent(in) :: first, middle, last
      integer(lp), intent(in) :: number
      type(workspace_t), intent(inout) :: work
      integer(ip), allocatable, intent(out) :: separator(:)
      integer(ip), intent(out) :: n_upper        !< free nodes that are left to the upper part
      integer(ip) :: i, k, n, node

      n_upper = 0
      do i = middle + 1, last
         do k = 1, work%n_nodes_of(work%element(i))
            node = work%nodes(k, work%element(i))
            if (work%taken(node) .or. work%upper_of(node) == number) cycle
            work%upper_of(node) = number
            n_upper = n_upper + 1
         end do
      end do
      allocate (separator(n_upper))
      n = 0
      do i = first, middle
         do k = 1, work%n_nodes_of(work%element(i))
            node = work%nodes(k, work%element(i))
            if (work%taken(node) .or. work%upper_of(node) /= number) cycle
            work%taken(node) = .true.
            n = n + 1
            separator(n) = node
         end do
      end do
      separator = separator(:n)
      n_upper = n_upper - n
      if (work%guide%refines) call leave_out(separator, work%sides)
   end subroutine take_separator

   !> Makes a part of the free nodes of a set that is not cut.
   pure subroutine take_rest(first, last, work, parts, root)
      integer(ip), intent(in) :: first, last
      type(workspace_t), intent(inout) :: work
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(out) :: root
      integer(ip) :: i, k, node, before

      before = parts%n_nodes
      do i = first, last
         do k = 1, work%n_nodes_of(work%element(i))
            node = work%nodes(k, work%element(i))
            if (work%taken(node)) cycle
            work%taken(node) = .true.
            parts%n_nodes = parts%n_nodes + 1
            work%order(parts%n_nodes) = node
         end do
      end do
      root = 0
      if (parts%n_nodes > before) call close_part(parts, root)
   end subroutine take_rest

   !> Adds a separator, the parent of two parts where they are.
   pure subroutine add_part(before, separator, children, order, parts, root)
      integer(ip), intent(in) :: before          !< nodes that stood in the order before those of the set
      integer(ip), intent(in) :: separator(:), children(2)
      integer(ip), intent(inout) :: order(:)
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(out) :: root
      real(wp) :: work
      integer(ip) :: n, i

      root = maxval(children)
      n = size(separator, kind=ip)
      if (n == 0 .and. minval(children) == 0) return
      order(parts%n_nodes + 1:parts%n_nodes + n) = separator
      parts%n_nodes = parts%n_nodes + n
      work = real(n, wp)**3                      ! and were the set a square of a regular mesh
      parts%work = parts%work + work
      parts%regular_work = parts%regular_work + min(work, real(parts%n_nodes - before, wp)**1.5_wp)
      call close_part(parts, root)
      do i = 1, 2
         if (children(i) > 0) parts%parent(children(i)) = root
      end do
   end subroutine add_part

   !> Ends a part at the last node; it has no parent yet.
   pure subroutine close_part(parts, root)
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(out) :: root           !< its number

      parts%n = parts%n + 1
      parts%last(parts%n) = parts%n_nodes
      parts%parent(parts%n) = 0
      root = parts%n
   end subroutine close_part

   !> Puts parts behind others; their nodes stand behind those of the others already.
   pure subroutine append(more, parts, root)
      type(dissection_t), intent(in) :: more
      type(dissection_t), intent(inout) :: parts
      integer(ip), intent(inout) :: root         !< a part of those that are added, or 0

      associate (n => parts%n, m => more%n)
         parts%last(n + 1:n + m) = more%last(:m)
         parts%parent(n + 1:n + m) = merge(more%parent(:m) + n, 0_ip, more%parent(:m) > 0)
         if (root > 0) root = root + n
         n = n + m
      end associate
      parts%n_nodes = more%n_nodes
      parts%work = parts%work + more%work
      parts%regular_work = parts%regular_work + more%regular_work
   end subroutine append

end module atrito_dissection
