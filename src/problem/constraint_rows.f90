!> The rows of the contact constraints over displacement dofs, and which of them can depend on each other.
!>
!> A row is what an unknown contact force does: B' q are the forces on the dofs. Forces with the same B' q move the
!> bodies alike, so where rows depend on each other, B' q = 0 for some q /= 0, the forces are not unique. Which rows may
!> take part in such a q is found without a factorisation, in time that is linear in the number of entries:
!>
!> 1. Let d be the dofs that point j alone touches. In B' q = 0 the equations of d have no terms but those of j. So if the rows of j
!>    (normal and tangential) are independent on d, its forces are 0 in every such q: the point takes no part in any dependence.
!> 2. Without this point its neighbours may be alone with some dofs, and are asked again. Of each dof the number of
!>    points that touch it is kept, and the sum of their numbers: when one is left the sum is that one's number. A point is
!>    in the queue once at most.
!> 3. The points that are left when the queue is empty are joined where they share a dof (union by the smallest number). Each
!>    component is a dependence of its own, and is examined by itself with a dense matrix (atrito_least_forces).
!>
!> Two rows a, b are independent on d where |a| and the part of b across a are more than INDEPENDENT of the whole rows.
module atrito_constraint_rows
   use atrito_incidence, only: list_holders
   use atrito_joined_sets, only: find_lowest, join_sets
   use atrito_kinds, only: ip, lp, wp
   use atrito_sparse_rows, only: sparse_rows_t
   implicit none (type, external)
   private
   public :: constraint_rows_t, list_components

   !> B: rows of unknown forces, columns of dofs.
   type, extends(sparse_rows_t) :: constraint_rows_t
      integer(ip), allocatable :: point(:)       !< (n) 1.., the point of each row: one or two rows have the same
      logical, allocatable :: to_ground(:)       !< (n) a joint of one node, as a support along its own axis; left out: none
   end type constraint_rows_t

   !> Who touches the dofs: the number of points, and the sum of their numbers, which names the last one.
   type :: touches_t
      integer(ip), allocatable :: count(:)       !< (columns)
      integer(lp), allocatable :: sum(:)         !< (columns)
   end type touches_t

   integer(ip), parameter :: MOST_OF_POINT = 2   !< rows
   real(wp), parameter :: INDEPENDENT = 1.0e-6_wp !< part of a row on dofs of its own that makes it independent of other points

contains

   !> Components of the rows that may depend on each other; rows outside `used` do not count, as those of open points.
   !> No component: the forces are unique.
   subroutine list_components(rows, used, first, member)
      type(constraint_rows_t), intent(in) :: rows !< of all unknowns, over displacements
      logical, intent(in) :: used(:)             !< (n)
      integer(ip), allocatable, intent(out) :: first(:)    !< (components + 1)
      integer(ip), allocatable, intent(out) :: member(:)   !< rows; those of component i are first(i) .. first(i+1)-1
      integer(ip), allocatable :: rows_of(:, :)  ! (MOST_OF_POINT, points) those that count; 0: none
      logical, allocatable :: waits(:)
      integer(ip) :: i

      allocate (rows_of(MOST_OF_POINT, maxval([rows%point, 0_ip])), source=0_ip)
      do i = 1, rows%n
         if (used(i)) rows_of(merge(1, 2, rows_of(1, rows%point(i)) == 0), rows%point(i)) = i
      end do
      waits = rows_of(1, :) > 0
      call set_aside()
      call group(first, member)

   contains

      !> Takes out the points that dofs of their own make independent, until there is none (steps 1 and 2 at the head of
      !> the module). The queue is a ring of as many places as points wait at first; a point goes in again when it has
      !> become alone with a dof.
      subroutine set_aside()
         type(touches_t) :: touches
         integer(ip), allocatable :: queue(:), dofs(:)
         logical :: queued(size(waits))
         integer(ip) :: j, k, head, tail            !< head and tail: taken out and put in so far

         call count_touches(rows, rows_of, waits, touches)
         queue = pack([(j, j=1, size(waits, kind=ip))], waits) ! a ring: a point is in it once at most
         queued = waits
         head = 0
         tail = size(queue, kind=ip)
         do while (tail > head)
            head = head + 1
            j = queue(mod(head - 1, size(queue, kind=ip)) + 1)
            queued(j) = .false.
            if (.not. waits(j)) cycle
            dofs = dofs_of_point(rows, rows_of(:, j))
            if (.not. stands_alone(rows, rows_of(:, j), touches)) cycle
            waits(j) = .false.
            do k = 1, size(dofs, kind=ip)
               touches%count(dofs(k)) = touches%count(dofs(k)) - 1
               touches%sum(dofs(k)) = touches%sum(dofs(k)) - j
               if (touches%count(dofs(k)) /= 1) cycle
               associate (last => int(touches%sum(dofs(k)), ip))
                  if (queued(last)) cycle
                  tail = tail + 1
                  queue(mod(tail - 1, size(queue, kind=ip)) + 1) = last
                  queued(last) = .true.
               end associate
            end do
         end do
      end subroutine set_aside

      !> Lists the rows of the points that are left by what shares dofs, in the order of the points.
      subroutine group(first, member)
         integer(ip), allocatable, intent(out) :: first(:), member(:) !< as in list_components
         integer(ip), allocatable :: root(:), component(:, :), points(:), of_points(:)
         integer(ip) :: j, n

         call join_points(rows, rows_of, waits, root)
         allocate (component(1, size(waits)), source=0_ip)
         n = 0
         do j = 1, size(waits, kind=ip)                ! the root of a component is its first point
            if (.not. waits(j)) cycle
            if (root(j) == j) n = n + 1
            component(1, j) = merge(n, component(1, root(j)), root(j) == j)
         end do
         call list_holders(n, component, first, points)
         member = pack(rows_of(:, points), rows_of(:, points) > 0)
         of_points = first
         do j = 1, n
            first(j + 1) = first(j) + count(rows_of(:, points(of_points(j):of_points(j + 1) - 1)) > 0, kind=ip)
         end do
      end subroutine group

   end subroutine list_components

   !> The points that touch each dof, and the sum of their numbers.
   pure subroutine count_touches(rows, rows_of, waits, touches)
      type(constraint_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: rows_of(:, :)      !< (MOST_OF_POINT, points) of each; 0: none
      logical, intent(in) :: waits(:)               !< (points) that may depend on others
      type(touches_t), intent(out) :: touches
      integer(ip) :: j

      allocate (touches%count(rows%n_columns), source=0_ip)
      allocate (touches%sum(rows%n_columns), source=0_lp)
      do j = 1, size(waits, kind=ip)
         if (.not. waits(j)) cycle
         associate (dofs => dofs_of_point(rows, rows_of(:, j)))
            touches%count(dofs) = touches%count(dofs) + 1
            touches%sum(dofs) = touches%sum(dofs) + j
         end associate
      end do
   end subroutine count_touches

   !> The dofs of a point's rows, each once: some four to ten, so they are looked for one by one.
   pure function dofs_of_point(rows, own) result(dofs)
      type(constraint_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: own(:)             !< rows of the point; 0: none
      integer(ip), allocatable :: dofs(:)
      integer(ip) :: i, k

      allocate (dofs(0))
      do i = 1, MOST_OF_POINT
         if (own(i) == 0) cycle
         do k = rows%first(own(i)), rows%first(own(i) + 1) - 1
            if (.not. any(dofs == rows%column(k))) dofs = [dofs, rows%column(k)]
         end do
      end do
   end function dofs_of_point

   !> Whether a point's rows are independent on the dofs that it alone touches: what these dofs have of the first row,
   !> and of the second row across the first (one step of Gram and Schmidt), is more than INDEPENDENT of the whole row.
   pure logical function stands_alone(rows, own, touches)
      type(constraint_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: own(:)             !< rows of the point; 0: none
      type(touches_t), intent(in) :: touches
      integer(ip), allocatable :: dofs(:)
      real(wp), allocatable :: a(:), b(:)
      real(wp) :: whole

      dofs = dofs_of_point(rows, own)
      dofs = pack(dofs, touches%count(dofs) == 1)
      call spread_row(rows, own(1), dofs, a, whole)
      stands_alone = norm2(a) > INDEPENDENT*whole
      if (.not. stands_alone .or. own(2) == 0) return
      a = a/norm2(a)
      call spread_row(rows, own(2), dofs, b, whole)
      stands_alone = norm2(b - dot_product(a, b)*a) > INDEPENDENT*whole
   end function stands_alone

   !> A row on some dofs, as a vector over these, and its length on all.
   pure subroutine spread_row(rows, i, dofs, a, whole)
      type(constraint_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: i, dofs(:)         !< row; dofs
      real(wp), allocatable, intent(out) :: a(:)    !< (dofs) entries of the row
      real(wp), intent(out) :: whole                !< length of the row on all dofs
      integer(ip) :: k

      allocate (a(size(dofs)), source=0.0_wp)
      do k = rows%first(i), rows%first(i + 1) - 1
         where (dofs == rows%column(k)) a = a + rows%value(k)
      end do
      whole = norm2(rows%value(rows%first(i):rows%first(i + 1) - 1))
   end subroutine spread_row

   !> A common root for all points that shared dofs lead to: of each dof the first point that has it is kept, and every
   !> other one that comes is joined with it.
   subroutine join_points(rows, rows_of, waits, root)
      type(constraint_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: rows_of(:, :)      !< (MOST_OF_POINT, points) of each; 0: none
      logical, intent(in) :: waits(:)               !< (points) that may depend on others
      integer(ip), allocatable, intent(out) :: root(:) !< (points) first point that each is joined with
      integer(ip), allocatable :: holder(:), dofs(:)
      integer(ip) :: j, k

      root = [(j, j=1, size(waits, kind=ip))]
      allocate (holder(rows%n_columns), source=0_ip)
      do j = 1, size(waits, kind=ip)
         if (.not. waits(j)) cycle
         dofs = dofs_of_point(rows, rows_of(:, j))
         do k = 1, size(dofs, kind=ip)
            if (holder(dofs(k)) == 0) then
               holder(dofs(k)) = j
            else
               call join_sets(root, holder(dofs(k)), j)
            end if
         end do
      end do
      do j = 1, size(root, kind=ip)
         k = j
         call find_lowest(root, k)
         root(j) = k
      end do
   end subroutine join_points

end module atrito_constraint_rows
