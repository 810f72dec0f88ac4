!> Cuts of a mesh into parts by the places of its elements: each straight across a side, then shortened by elements that change
!> sides (atrito_cut_refinement).
!>
!> Near what METIS finds where elements have even sizes and lie in no narrow bends, in a fraction of the time; where it is not,
!> that is told.
module atrito_place_cuts
   use atrito_compact_mesh, only: compact_mesh_t, compact
   use atrito_cut_refinement, only: corner_lists_t, sides_of_cut_t, list_corners, begin_sides, refine_cut, LOWER_SIDE, UPPER_SIDE
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: cut_by_places

   !> The mesh, and what is found.
   type :: workspace_t
      integer(ip), pointer :: elements(:) => null(), nodes(:, :) => null(), n_nodes_of(:) => null()
      real(wp), pointer :: x(:, :) => null(), target(:) => null()
      real(wp), allocatable :: centre(:, :)      !< (2, elements of the list) [L]
      integer(ip), allocatable :: seen(:)        !< (all nodes) last set whose lower part has it; less than 0: both have
      integer(ip) :: n_sets = 0
      integer(ip), allocatable :: part(:)        !< (elements of the list)
      logical :: is_short = .true.               !< every cut is
   end type workspace_t

   !> A set in two.
   type :: cut_t
      logical, allocatable :: is_lower(:)        !< (elements of the set)
      integer(ip) :: n_lower = 0, n_border = 0   !< nodes of the lower part, those that both have
      real(wp) :: reach(2) = 0.0_wp              !< of the nodes that both have, along the side that is cut [L]
      logical :: is_even = .false.               !< the parts have their shares
   end type cut_t

   !> A cut is short that has no more nodes than this times those of a cut through a square of a regular mesh.
   real(wp), parameter :: SHORT = 1.3_wp
   !> The share of the weight by which a part may differ from its own: looked for, at the most.
   real(wp), parameter :: WANTED = 0.002_wp, EVEN = 0.05_wp
   !> Elements closer to the cut than this share of the extent lie on it: round-off of a regular mesh.
   real(wp), parameter :: ON_CUT = 1.0e-9_wp
   !> Halvings of the length along which a place is looked for.
   integer, parameter :: MOST_HALVINGS = 50
   !> Elements change sides that are no farther from the border than so many elements of a square would be.
   real(wp), parameter :: NEAR = 8.0_wp

contains

   !> The part of each element, which weighs as much as it has nodes.
   subroutine cut_by_places(elements, nodes, n_nodes_of, x, target, part, is_short)
      integer(ip), intent(in), target :: elements(:) !< which
      integer(ip), intent(in), target :: nodes(:, :) !< (most nodes, all elements)
      integer(ip), intent(in), target :: n_nodes_of(:) !< (all elements)
      real(wp), intent(in), target :: x(:, :)    !< (2, all nodes) [L]
      real(wp), intent(in), target :: target(:)  !< (parts) shares of the weight; their sum is 1
      integer(ip), intent(out) :: part(:)        !< (elements) 1..size(target)
      logical, intent(out) :: is_short           !< about as short as those of a regular mesh, and the parts have their shares
      type(workspace_t) :: work
      integer(ip) :: i

      work%elements => elements
      work%nodes => nodes
      work%n_nodes_of => n_nodes_of
      work%x => x
      work%target => target
      allocate (work%centre(2, size(elements)), work%part(size(elements)))
      allocate (work%seen(size(x, 2)), source=0_ip)
      do i = 1, size(elements, kind=ip)
         associate (corners => nodes(:min(4_ip, n_nodes_of(elements(i))), elements(i)))
            work%centre(:, i) = sum(x(:, corners), dim=2)/real(size(corners), wp)
         end associate
      end do
      call cut_set(1_ip, size(target, kind=ip), [(i, i=1, size(elements, kind=ip))], work)
      part = work%part
      is_short = work%is_short
   end subroutine cut_by_places

   !> Shares out a set among some parts.
   recursive subroutine cut_set(first, last, set, work)
      integer(ip), intent(in) :: first, last     !< parts
      integer(ip), intent(in) :: set(:)          !< places in the list of elements
      type(workspace_t), intent(inout) :: work
      type(cut_t) :: best, other
      integer(ip) :: middle
      integer :: along
      real(wp) :: share

      if (first == last) then
         work%part(set) = first
         return
      end if
      middle = (first + last - 1)/2
      share = sum(work%target(first:middle))/sum(work%target(first:last))
      along = longer_side(work%centre(:, set))
      call cut_across(along, share, set, work, best)
      if (.not. is_good(best, share)) then
         call cut_across(3 - along, share, set, work, other)
         if (other%is_even .and. (other%n_border < best%n_border .or. .not. best%is_even)) best = other
      end if
      work%is_short = work%is_short .and. is_good(best, share)
      call cut_set(first, middle, pack(set, best%is_lower), work)
      call cut_set(middle + 1, last, pack(set,.not. best%is_lower), work)
   end subroutine cut_set

   pure logical function is_good(cut, share)
      type(cut_t), intent(in) :: cut
      real(wp), intent(in) :: share              !< of the lower part

      is_good = cut%is_even .and. real(cut%n_border, wp) <= SHORT*sqrt(real(cut%n_lower, wp)/share)
   end function is_good

   pure integer function longer_side(centre) result(along)
      real(wp), intent(in) :: centre(:, :)

      along = 1
      if (size(centre, 2) == 0) return
      if (maxval(centre(2, :)) - minval(centre(2, :)) > maxval(centre(1, :)) - minval(centre(1, :))) along = 2
   end function longer_side

   !> Straight across a side, or shortened where that is of use.
   subroutine cut_across(along, share, set, work, cut)
      integer, intent(in) :: along               !< 1 or 2
      real(wp), intent(in) :: share              !< of the lower part, 0 to 1
      integer(ip), intent(in) :: set(:)
      type(workspace_t), intent(inout) :: work
      type(cut_t), intent(out) :: cut
      type(cut_t) :: shorter
      real(wp) :: at(size(set)), weight(size(set))

      at = work%centre(along, set)
      weight = real(work%n_nodes_of(work%elements(set)), wp)
      call find_lower(at, weight, share, cut%is_lower)
      call measure_cut(along, set, work, cut)
      cut%is_even = is_even(cut)
      if (cut%n_border < 2) return
      call move_elements(at, set, work, cut, shorter%is_lower)
      call measure_cut(along, set, work, shorter)
      shorter%is_even = is_even(shorter)
      if (shorter%n_border < cut%n_border .and. (shorter%is_even .or. .not. cut%is_even)) cut = shorter

   contains

      pure logical function is_even(some)
         type(cut_t), intent(in) :: some

         is_even = abs(sum(weight, mask=some%is_lower) - share*sum(weight)) <= EVEN*sum(weight)
      end function is_even

   end subroutine cut_across

   !> Finds what lies below a place, so that it has a share of the weight.
   pure subroutine find_lower(at, weight, share, is_lower)
      real(wp), intent(in) :: at(:)              !< [L]
      real(wp), intent(in) :: weight(:)
      real(wp), intent(in) :: share              !< 0 to 1
      logical, allocatable, intent(out) :: is_lower(:)
      integer(ip), allocatable :: undecided(:)
      logical, allocatable :: is_below(:)
      real(wp) :: low, high, margin, place, below, more, total
      integer(ip) :: i
      integer :: halving

      allocate (is_lower(size(at)), source=.true.)
      if (size(at) == 0) return
      low = minval(at)
      high = maxval(at)
      margin = ON_CUT*(high - low)
      undecided = [(i, i=1, size(at, kind=ip))]
      total = sum(weight)
      below = 0.0_wp
      do halving = 1, MOST_HALVINGS
         place = 0.5_wp*low + 0.5_wp*high
         is_below = at(undecided) <= place + margin
         more = sum(weight(undecided), mask=is_below)
         if (below + more < share*total) then
            low = place
            below = below + more
            undecided = pack(undecided,.not. is_below)
         else
            high = place
            if (below + more <= (share + WANTED)*total) exit
            undecided = pack(undecided, is_below)
         end if
      end do
      is_lower = at <= high + margin
   end subroutine find_lower

   !> Counts the nodes of a cut.
   pure subroutine measure_cut(along, set, work, cut)
      integer, intent(in) :: along
      integer(ip), intent(in) :: set(:)
      type(workspace_t), intent(inout) :: work
      type(cut_t), intent(inout) :: cut
      integer(ip) :: i, k, node

      work%n_sets = work%n_sets + 1
      cut%n_lower = 0
      do i = 1, size(set, kind=ip)
         if (.not. cut%is_lower(i)) cycle
         do k = 1, work%n_nodes_of(work%elements(set(i)))
            node = work%nodes(k, work%elements(set(i)))
            if (work%seen(node) == work%n_sets) cycle
            work%seen(node) = work%n_sets
            cut%n_lower = cut%n_lower + 1
         end do
      end do
      cut%n_border = 0
      cut%reach = [huge(0.0_wp), -huge(0.0_wp)]
      do i = 1, size(set, kind=ip)
         if (cut%is_lower(i)) cycle
         do k = 1, work%n_nodes_of(work%elements(set(i)))
            node = work%nodes(k, work%elements(set(i)))
            if (work%seen(node) /= work%n_sets) cycle
            work%seen(node) = -work%n_sets
            cut%n_border = cut%n_border + 1
            cut%reach = [min(cut%reach(1), work%x(along, node)), max(cut%reach(2), work%x(along, node))]
         end do
      end do
   end subroutine measure_cut

   !> Elements in a band round a cut change sides. Those at its edges do not know their neighbours outside: whether the cut has
   !> become shorter is seen when it is measured.
   subroutine move_elements(at, set, work, cut, is_lower)
      real(wp), intent(in) :: at(:)              !< (elements of the set) along the side that is cut [L]
      integer(ip), intent(in) :: set(:)
      type(workspace_t), intent(in) :: work
      type(cut_t), intent(in) :: cut
      logical, allocatable, intent(out) :: is_lower(:)
      type(compact_mesh_t) :: mesh
      type(corner_lists_t), target :: lists
      type(sides_of_cut_t) :: sides
      integer(ip), allocatable :: band(:)
      real(wp) :: width
      integer(ip) :: i

      is_lower = cut%is_lower
      width = NEAR*(maxval(at) - minval(at))/sqrt(real(size(set), wp))
      band = pack([(i, i=1, size(set, kind=ip))], at >= cut%reach(1) - width .and. at <= cut%reach(2) + width)
      call compact(work%elements(set(band)), work%nodes, work%n_nodes_of, work%x, spread(.true., 1, size(work%x, 2)), mesh)
      call list_corners(mesh%list, mesh%nodes, mesh%n_nodes_of, size(mesh%node, kind=ip), lists)
      call begin_sides(lists, mesh%wanted, sides)
      sides%side = merge(LOWER_SIDE, UPPER_SIDE, is_lower(band))
      call refine_cut(mesh%list, sides)
      is_lower(band) = sides%side == LOWER_SIDE
   end subroutine move_elements

end module atrito_place_cuts
