!> A tree over the pieces of a surface: those of a branch lie in a box, their normals in another one, so that whole branches are
!> passed over that a line cannot meet, or would meet from behind.
!>
!> The pieces are put in the order of a curve that fills the plane (Morton: the bits of both coordinates in turn), so
!> pieces near each other mostly follow each other, and the order is halved until few are left: branch k has the halves
!> 2 k and 2 k + 1. Building it takes n log n, a search some log n.
!>
!> For the line x + s n and a branch with the box low .. high of its places and another one of its normals m, these hold
!> for every place y of the branch, n.m and the others being bounded coordinate by coordinate (the least of a product
!> over an interval is at one of its ends):
!>
!>     n.m > FACING for all m             nothing in the branch faces the line: it is passed over
!>     |cross(y - x, n)| >= across        across > 0: the line does not meet the branch
!>     |(y - x).n| >= along               a bound of the distance at which it may be met
!>
!> Each bound is given away by `margin`, the round-off of the coordinates, so a search finds what looking at all pieces
!> would find. The branches that are still to be looked at wait in the order of their bound; the nearest is opened next,
!> and the search ends when the nearest bound is above what was found.
module atrito_piece_tree
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_pieces, only: pieces_t, box_of_piece
   use atrito_sorting, only: sorted_places
   implicit none (type, external)
   private
   public :: piece_tree_t, search_t, plant, begin_search, next_leaf, is_far_off
   public :: FACING

   !> What holds some of the pieces.
   type :: branch_t
      real(wp) :: low(2) = huge(1.0_wp), high(2) = -huge(1.0_wp)              !< [L] box round them
      real(wp) :: normal_low(2) = 1.0_wp, normal_high(2) = -1.0_wp            !< box round their outward unit normals
   end type branch_t

   type :: piece_tree_t
      integer(ip) :: n = 0                          !< pieces
      integer(ip), allocatable :: order(:)          !< (n) the pieces, branch by branch
      type(branch_t), allocatable :: branches(:)    !< the halves of branch k are 2 k and 2 k + 1
      real(wp) :: round_off = 0.0_wp                !< of the coordinates [L]
   end type piece_tree_t

   !> A branch that is still to be looked at.
   type :: waiting_t
      integer(ip) :: branch = 0                     !< its number: halves are 2 k and 2 k + 1
      integer(ip) :: first = 0, last = 0            !< its pieces in the order
      real(wp) :: bound = 0.0_wp                    !< [L] nothing in the branch is nearer than this
   end type waiting_t

   !> A line x + s normal on its way through the tree.
   type :: search_t
      real(wp) :: x(2) = 0.0_wp, normal(2) = 0.0_wp !< a place of the line [L], its unit vector
      logical :: crossing = .true.                  !< what the line crosses, by the distance along it; else all, by that from it
      real(wp) :: margin = 0.0_wp                   !< [L] rounding of what is compared
      integer(ip) :: n = 0                          !< branches that wait
      type(waiting_t), allocatable :: waiting(:)    !< the first n are in use; the nearest is the last
   end type search_t

   !> Cosine below which two surfaces face each other.
   real(wp), parameter :: FACING = -1.0e-3_wp
   !> Branches that wait at first.
   integer(ip), parameter :: FIRST_LENGTH = 64_ip
   !> So few pieces are not divided any more.
   integer(ip), parameter :: LEAF = 4_ip
   !> Errors of rounding that a place may have.
   real(wp), parameter :: ROUND_OFFS = 64.0_wp
   !> The same of a product of unit vectors.
   real(wp), parameter :: NORMAL_ROUND_OFF = 1.0e-9_wp

contains

   !> Puts the pieces into the tree. Those that are near each other come one after the other (Morton's order of their first ends),
   !> and are halved until few are left.
   pure subroutine plant(pieces, tree)
      class(pieces_t), intent(in) :: pieces         !< those of the tree
      type(piece_tree_t), intent(out) :: tree       !< over all pieces
      integer(lp) :: key(pieces%n)
      real(wp) :: low(2), extent
      integer(ip) :: i

      tree%n = pieces%n
      allocate (tree%branches(n_branches(pieces%n)))
      if (pieces%n == 0) return
      low = minval(pieces%a, dim=2)
      extent = maxval(maxval(pieces%a, dim=2) - low)
      key = 0_lp
      if (extent > 0.0_wp) then
         do i = 1, pieces%n
            key(i) = morton((pieces%a(:, i) - low)/extent)
         end do
      end if
      tree%order = sorted_places(key)
      tree%round_off = ROUND_OFFS*EPS_MACH*max(maxval(abs(pieces%a)), maxval(abs(pieces%d)), maxval(abs(pieces%sag)), &
                                               maxval(abs(pieces%centre)))
      call enclose(pieces, tree, 1_ip, 1_ip, pieces%n)
   end subroutine plant

   !> The number of branches of a tree over n pieces, a full one: 2^levels - 1.
   pure integer(ip) function n_branches(n)
      integer(ip), intent(in) :: n
      integer(ip) :: m

      n_branches = 1
      m = n
      do while (m > LEAF)
         m = (m + 1)/2
         n_branches = 2*n_branches + 1
      end do
   end function n_branches

   !> Place along a curve that passes through a square: the bits of both coordinates in turn.
   pure integer(lp) function morton(x) result(key)
      real(wp), intent(in) :: x(2)                  !< 0..1
      integer, parameter :: BITS = 30
      integer(lp) :: cell(2)
      integer :: b

      cell = int(x*real(2_lp**BITS - 1_lp, wp), lp)
      key = 0_lp
      do b = BITS - 1, 0, -1
         key = 4_lp*key + 2_lp*ibits(cell(1), b, 1) + ibits(cell(2), b, 1)
      end do
   end function morton

   !> The boxes of a branch and of all below it.
   pure recursive subroutine enclose(pieces, tree, k, first, last)
      class(pieces_t), intent(in) :: pieces         !< those of the tree
      type(piece_tree_t), intent(inout) :: tree
      integer(ip), intent(in) :: k                  !< the branch
      integer(ip), intent(in) :: first, last        !< its pieces in the order
      type(branch_t) :: own
      integer(ip) :: i, middle

      if (last - first < LEAF) then
         do i = first, last
            call box_of_piece(pieces, tree%order(i), own%low, own%high, own%normal_low, own%normal_high)
            call widen(tree%branches(k), own)
         end do
         return
      end if
      middle = (first + last)/2
      call enclose(pieces, tree, 2*k, first, middle)
      call enclose(pieces, tree, 2*k + 1, middle + 1, last)
      call widen(tree%branches(k), tree%branches(2*k))
      call widen(tree%branches(k), tree%branches(2*k + 1))
   end subroutine enclose

   !> Makes the boxes of a branch so large that another one's are in them.
   pure subroutine widen(branch, other)
      type(branch_t), intent(inout) :: branch
      type(branch_t), intent(in) :: other

      branch%low = min(branch%low, other%low)
      branch%high = max(branch%high, other%high)
      branch%normal_low = min(branch%normal_low, other%normal_low)
      branch%normal_high = max(branch%normal_high, other%normal_high)
   end subroutine widen

   !> Whether all pieces lie farther off the line than `turn` times their greatest distance from x, or turn their backs
   !> on it: a line in doubt by the angle with this sine meets none. The box of the whole tree tells; most faces of a
   !> long slave are so far off a short master.
   pure logical function is_far_off(tree, x, normal, turn)
      type(piece_tree_t), intent(in) :: tree
      real(wp), intent(in) :: x(2), normal(2)       !< place [L] and unit vector of the line
      real(wp), intent(in) :: turn                  !< sine of the angle by which the normal may be in doubt
      type(search_t) :: search
      real(wp) :: across, along, farthest
      logical :: facing_it

      is_far_off = tree%n == 0
      if (is_far_off) return
      call aim(tree, x, normal, search)
      call judge_branch(tree%branches(1), search, facing_it, across, along)
      farthest = norm2(max(abs(tree%branches(1)%low - x), abs(tree%branches(1)%high - x))) + search%margin
      is_far_off = .not. facing_it .or. across > turn*farthest
   end function is_far_off

   !> The line of a search, and the rounding that its comparisons may have.
   pure subroutine aim(tree, x, normal, search)
      type(piece_tree_t), intent(in) :: tree
      real(wp), intent(in) :: x(2), normal(2)       !< place [L] and unit vector of the line
      type(search_t), intent(out) :: search         !< at its beginning

      search%x = x
      search%normal = normal
      search%margin = tree%round_off + ROUND_OFFS*EPS_MACH*maxval(abs(x))
   end subroutine aim

   !> A search for what the line through x along the normal crosses, or (not crossing) comes near.
   pure subroutine begin_search(tree, x, normal, crossing, search)
      type(piece_tree_t), intent(in) :: tree        !< over the pieces of a master
      real(wp), intent(in) :: x(2), normal(2)       !< place [L] and unit vector of the line
      logical, intent(in) :: crossing               !< only what the line crosses
      type(search_t), intent(out) :: search         !< at its beginning

      call aim(tree, x, normal, search)
      search%crossing = crossing
      if (tree%n > 0) call add_branch(tree, 1_ip, 1_ip, tree%n, search)
   end subroutine begin_search

   !> Whether anything in a branch may face the line, and how far off it is at least: across the line and along it. The
   !> bounds of n.m, of cross(y - x, n) and of (y - x).n over the boxes are sums of the bounds of their two terms, each
   !> at an end of its interval.
   pure subroutine judge_branch(branch, search, facing_it, across, along)
      type(branch_t), intent(in) :: branch          !< that is judged
      type(search_t), intent(in) :: search
      logical, intent(out) :: facing_it             !< something may face the line
      real(wp), intent(out) :: across, along        !< [L]
      real(wp) :: low(2), high(2)

      associate (n => search%normal)
         low = min(n*branch%normal_low, n*branch%normal_high)
         facing_it = low(1) + low(2) <= FACING + NORMAL_ROUND_OFF
         low = branch%low - search%x
         high = branch%high - search%x
         across = away_from(min(low(1)*n(2), high(1)*n(2)) - max(low(2)*n(1), high(2)*n(1)), &
                            max(low(1)*n(2), high(1)*n(2)) - min(low(2)*n(1), high(2)*n(1))) - search%margin
         along = away_from(min(low(1)*n(1), high(1)*n(1)) + min(low(2)*n(2), high(2)*n(2)), &
                           max(low(1)*n(1), high(1)*n(1)) + max(low(2)*n(2), high(2)*n(2))) - search%margin
      end associate
   end subroutine judge_branch

   !> How far 0 lies off an interval.
   pure real(wp) function away_from(low, high)
      real(wp), intent(in) :: low, high             !< ends of the interval

      away_from = max(low, -high, 0.0_wp)
   end function away_from

   !> Adds a branch to those that are to be looked at.
   pure subroutine add_branch(tree, k, first, last, search)
      type(piece_tree_t), intent(in) :: tree
      integer(ip), intent(in) :: k, first, last     !< branch; its pieces in the order
      type(search_t), intent(inout) :: search       !< with the branches that wait
      real(wp) :: across, along
      logical :: facing_it

      call judge_branch(tree%branches(k), search, facing_it, across, along)
      if (.not. facing_it .or. (search%crossing .and. across > 0.0_wp)) return
      call put_in_order(waiting_t(k, first, last, merge(along, across, search%crossing)), search)
   end subroutine add_branch

   !> Puts a branch among those that wait, by insertion: the farther ones first, so that the nearest is taken from the
   !> end of the list; of those that are as near the one that comes later is looked at first. Some log n branches wait,
   !> so the list is short.
   pure subroutine put_in_order(new, search)
      type(waiting_t), intent(in) :: new            !< to be put among those that wait
      type(search_t), intent(inout) :: search       !< with the branches that wait
      integer(ip) :: i

      if (.not. allocated(search%waiting)) allocate (search%waiting(FIRST_LENGTH))
      if (search%n == size(search%waiting)) search%waiting = [search%waiting, search%waiting]    ! doubled
      do i = search%n, 1, -1
         if (search%waiting(i)%bound >= new%bound) exit
         search%waiting(i + 1) = search%waiting(i)
      end do
      search%waiting(i + 1) = new
      search%n = search%n + 1
   end subroutine put_in_order

   !> The next pieces to be looked at: those of the nearest branch, if it is not farther off than what was found. A
   !> branch that is no leaf is replaced by its halves. None: nothing that still waits can be nearer, the search is at
   !> its end.
   pure subroutine next_leaf(tree, found, search, first, last)
      type(piece_tree_t), intent(in) :: tree        !< the search was begun with
      real(wp), intent(in) :: found                 !< [L]
      type(search_t), intent(inout) :: search       !< with the branches that wait
      integer(ip), intent(out) :: first, last       !< places in the order; none: last < first
      type(waiting_t) :: next
      integer(ip) :: middle

      first = 1
      last = 0
      do while (search%n > 0)
         next = search%waiting(search%n)
         search%n = search%n - 1
         if (next%bound > found) return
         if (next%last - next%first < LEAF) then
            first = next%first
            last = next%last
            return
         end if
         middle = (next%first + next%last)/2
         call add_branch(tree, 2*next%branch, next%first, middle, search)
         call add_branch(tree, 2*next%branch + 1, middle + 1, next%last, search)
      end do
   end subroutine next_leaf

end module atrito_piece_tree
