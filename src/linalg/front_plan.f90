!> The fronts of a system whose matrix is a sum over ranks, each of which has some of the unknowns: who eliminates what.
!>
!> Ranks are joined two by two, those first that have most unknowns in common. What only the two have is eliminated where they are
!> joined, by one of their ranks; what others have, too, goes on to the next joint. So the fronts are a binary tree, in which all
!> fronts that are as far from the root may be worked on at the same time (nested dissection with the ranks for leaves).
!> The root is the first rank's.
module atrito_front_plan
   use atrito_kinds, only: ip, lp, wp
   use atrito_parcel, only: parcel_t, put, take
   use atrito_sorting, only: each_once
   implicit none (type, external)
   private
   public :: front_plan_t, shared_front_t, make_front_plan, put_plan, take_plan, largest_order

   type :: shared_front_t
      integer(ip) :: holder = 0                  !< rank
      integer(ip) :: parent = 0                  !< 0: the root
      integer(ip) :: child(2) = 0                !< 0: none, a rank's own front
      integer(ip) :: n_pivots = 0
      integer(ip), allocatable :: position(:)    !< of its unknowns in the order of elimination, ascending: the pivots come first
   end type shared_front_t

   type :: front_plan_t
      integer(ip) :: n = 0                       !< unknowns
      integer(ip), allocatable :: unknown(:)     !< (n) at each position
      integer(ip), allocatable :: position(:)    !< (n) of each unknown
      type(shared_front_t), allocatable :: front(:) !< children first; that of rank r is number r + 1, the root the last
   end type front_plan_t

   !> Unknowns of a rank, or of several that are joined, which are not eliminated yet.
   type :: cluster_t
      integer(ip) :: front = 0
      integer(ip), allocatable :: member(:)
   end type cluster_t

contains

   pure subroutine make_front_plan(n, first, unknown, plan)
      integer(ip), intent(in) :: n
      integer(ip), intent(in) :: first(:)        !< (ranks + 1)
      integer(ip), intent(in) :: unknown(:)      !< of rank r: unknown(first(r + 1):first(r + 2) - 1), 1..n
      type(front_plan_t), intent(out) :: plan
      type(cluster_t), allocatable :: cluster(:)
      integer(ip) :: held_by(n), next, n_ranks, r, i

      n_ranks = size(first, kind=ip) - 1
      plan%n = n
      allocate (plan%position(n), plan%front(2*n_ranks - 1), cluster(n_ranks))
      plan%position = 0
      held_by = 0
      do r = 1, n_ranks
         cluster(r)%front = r
         cluster(r)%member = each_once(unknown(first(r):first(r + 1) - 1))
         held_by(cluster(r)%member) = held_by(cluster(r)%member) + 1
         plan%front(r)%holder = r - 1
      end do
      next = 0
      do r = 1, n_ranks
         call eliminate_own(held_by, cluster(r), plan, next)
      end do
      i = n_ranks
      do while (size(cluster) > 1)
         call join_clusters(held_by, cluster, plan, i, next)
      end do
      do i = 1, n                                ! what nobody has
         if (plan%position(i) > 0) cycle
         next = next + 1
         plan%position(i) = next
      end do
      allocate (plan%unknown(n))
      plan%unknown(plan%position) = [(i, i=1, n)]
      call number_fronts(plan)
      call choose_holders(n_ranks, plan)
   end subroutine make_front_plan

   !> The pivots of a front are what its ranks alone have; the rest stays in the cluster. The front has unknowns until they all have
   !> positions.
   pure subroutine eliminate_own(held_by, cluster, plan, next)
      integer(ip), intent(in) :: held_by(:)
      type(cluster_t), intent(inout) :: cluster
      type(front_plan_t), intent(inout) :: plan
      integer(ip), intent(inout) :: next
      logical :: is_pivot(size(cluster%member))
      integer(ip) :: i

      is_pivot = held_by(cluster%member) == 1
      associate (front => plan%front(cluster%front))
         front%position = cluster%member
         front%n_pivots = count(is_pivot, kind=ip)
      end associate
      do i = 1, size(is_pivot, kind=ip)
         if (.not. is_pivot(i)) cycle
         next = next + 1
         plan%position(cluster%member(i)) = next
      end do
      cluster%member = pack(cluster%member,.not. is_pivot)
   end subroutine eliminate_own

   !> One more level of the tree: each cluster with the one that it has most in common with; one may be left over.
   pure subroutine join_clusters(held_by, cluster, plan, n_fronts, next)
      integer(ip), intent(inout) :: held_by(:)   !< (n) clusters that have an unknown
      type(cluster_t), allocatable, intent(inout) :: cluster(:)
      type(front_plan_t), intent(inout) :: plan
      integer(ip), intent(inout) :: n_fronts, next
      type(cluster_t), allocatable :: joined(:)
      integer(ip) :: partner(size(cluster)), both(plan%n), i, n

      call find_partners(plan%n, cluster, partner)
      allocate (joined(count(partner > [(i, i=1, size(cluster, kind=ip))]) + count(partner == 0)))
      n = 0
      do i = 1, size(cluster, kind=ip)
         if (partner(i) > 0 .and. partner(i) < i) cycle
         n = n + 1
         joined(n) = cluster(i)
         if (partner(i) == 0) cycle
         n_fronts = n_fronts + 1
         plan%front([cluster(i)%front, cluster(partner(i))%front])%parent = n_fronts
         plan%front(n_fronts)%child = [cluster(i)%front, cluster(partner(i))%front]
         both = 0
         both(cluster(i)%member) = 1
         both(cluster(partner(i))%member) = both(cluster(partner(i))%member) + 1
         where (both == 2) held_by = held_by - 1
         joined(n)%front = n_fronts
         joined(n)%member = each_once([cluster(i)%member, cluster(partner(i))%member])
         call eliminate_own(held_by, joined(n), plan, next)
      end do
      call move_alloc(joined, cluster)
   end subroutine join_clusters

   !> In their order, each takes the one of those behind it that has most in common with it. 0: there is none.
   pure subroutine find_partners(n, cluster, partner)
      integer(ip), intent(in) :: n
      type(cluster_t), intent(in) :: cluster(:)
      integer(ip), intent(out) :: partner(:)
      logical :: has(n)
      integer(ip) :: i, j, common, most

      partner = 0
      do i = 1, size(cluster, kind=ip)
         if (partner(i) > 0) cycle
         has = .false.
         has(cluster(i)%member) = .true.
         most = -1
         do j = i + 1, size(cluster, kind=ip)
            if (partner(j) > 0) cycle
            common = count(has(cluster(j)%member), kind=ip)
            if (common <= most) cycle
            most = common
            partner(i) = j
         end do
         if (partner(i) > 0) partner(partner(i)) = i
      end do
   end subroutine find_partners

   !> Positions in place of unknowns.
   pure subroutine number_fronts(plan)
      type(front_plan_t), intent(inout) :: plan
      integer(ip) :: f

      do f = 1, size(plan%front, kind=ip)
         plan%front(f)%position = each_once(plan%position(plan%front(f)%position))
      end do
   end subroutine number_fronts

   !> Each joint to that of its ranks which has least so far; the root to the first rank.
   pure subroutine choose_holders(n_ranks, plan)
      integer(ip), intent(in) :: n_ranks
      type(front_plan_t), intent(inout) :: plan
      real(wp) :: load(0:n_ranks - 1)
      logical :: is_below(0:n_ranks - 1, size(plan%front))
      integer(ip) :: f, n

      n = size(plan%front, kind=ip)
      load = 0.0_wp
      load(0) = real(size(plan%front(n)%position), wp)**2
      is_below = .false.
      do f = 1, n
         if (f <= n_ranks) then
            is_below(f - 1, f) = .true.
            cycle
         end if
         is_below(:, f) = is_below(:, plan%front(f)%child(1)) .or. is_below(:, plan%front(f)%child(2))
         if (f == n) exit
         plan%front(f)%holder = minloc(load, dim=1, kind=ip, mask=is_below(:, f)) - 1
         associate (own => load(plan%front(f)%holder))
            own = own + real(size(plan%front(f)%position), wp)**2
         end associate
      end do
      plan%front(n)%holder = 0
   end subroutine choose_holders

   !> Of the fronts, in unknowns.
   pure integer(ip) function largest_order(plan) result(order)
      type(front_plan_t), intent(in) :: plan
      integer(ip) :: f

      order = 0
      do f = 1, size(plan%front, kind=ip)
         order = max(order, size(plan%front(f)%position, kind=ip))
      end do
   end function largest_order

   subroutine put_plan(parcel, plan)
      type(parcel_t), intent(inout) :: parcel
      type(front_plan_t), intent(in) :: plan
      integer(ip) :: f

      call put(parcel, [plan%n, size(plan%front, kind=ip)])
      call put(parcel, plan%unknown)
      call put(parcel, plan%position)
      do f = 1, size(plan%front, kind=ip)
         associate (front => plan%front(f))
            call put(parcel, [front%holder, front%parent, front%child, front%n_pivots])
            call put(parcel, front%position)
         end associate
      end do
   end subroutine put_plan

   subroutine take_plan(parcel, plan)
      type(parcel_t), intent(inout) :: parcel
      type(front_plan_t), intent(out) :: plan
      integer(ip), allocatable :: numbers(:)
      integer(ip) :: f

      call take(parcel, numbers)
      plan%n = numbers(1)
      allocate (plan%front(numbers(2)))
      call take(parcel, plan%unknown)
      call take(parcel, plan%position)
      do f = 1, size(plan%front, kind=ip)
         call take(parcel, numbers)
         plan%front(f)%holder = numbers(1)
         plan%front(f)%parent = numbers(2)
         plan%front(f)%child = numbers(3:4)
         plan%front(f)%n_pivots = numbers(5)
         call take(parcel, plan%front(f)%position)
      end do
   end subroutine take_plan

end module atrito_front_plan
