!> From the members of each set to the sets of each member: from the nodes of the elements to the elements round each node.
!>
!> The sets are shared out in parts, a thread a part. Each counts its own first, so that every thread knows where the sets of its
!> part go and the lists come out in the order of the sets, for any number of threads.
module atrito_incidence
   use atrito_kinds, only: ip, lp
   use atrito_threads, only: n_threads, is_shared, chunk_count, find_chunk
   implicit none (type, external)
   private
   public :: list_holders

   integer(ip), parameter :: MOST_PARTS = 8_ip       !< each takes an integer a member

contains

   !> The sets that hold each of the members, in rising order: holder(first(i):first(i + 1) - 1) for member i; in linear time.
   subroutine list_holders(n, sets, first, holder, row)
      integer(ip), intent(in) :: n                   !< members
      integer(ip), intent(in) :: sets(:, :)          !< (most members of a set, sets) 1..n; from the first 0 of a column on: none
      integer(ip), allocatable, intent(out) :: first(:)   !< (n + 1)
      integer(ip), allocatable, intent(out) :: holder(:) !< places of the sets, member after member
      integer(ip), allocatable, intent(out), optional :: row(:)   !< where in the set the member stands
      integer(ip), allocatable :: at(:, :)           !< (n, n_parts): counts, then where the part's next set goes
      integer(ip), allocatable :: place(:)           !< row; of no length where it is not wanted
      integer(ip) :: part, n_parts, length

      n_parts = 1
      if (is_shared(size(sets, 2, kind=ip))) n_parts = min(n_threads(), MOST_PARTS)
      allocate (at(n, n_parts), first(n + 1))
      !$omp parallel do schedule(static, 1) default(none) shared(sets, n_parts, at)
      do part = 1, n_parts
         call count_members(sets, part, n_parts, at(:, part))
      end do
      !$omp end parallel do
      call counts_to_starts(at, first)
      length = first(n + 1) - 1
      allocate (holder(length), place(merge(length, 0_ip, present(row))))
      !$omp parallel do schedule(static, 1) default(none) shared(sets, n_parts, at, holder, place)
      do part = 1, n_parts
         call fill_lists(sets, part, n_parts, at(:, part), holder, place)
      end do
      !$omp end parallel do
      if (present(row)) call move_alloc(place, row)
   end subroutine list_holders

   !> The last set of a part; that of part 0 is 0.
   pure integer(ip) function part_end(part, n_parts, n)
      integer(ip), intent(in) :: part, n_parts, n

      part_end = int((int(n, lp)*part)/n_parts, ip)
   end function part_end

   pure subroutine count_members(sets, part, n_parts, count)
      integer(ip), intent(in) :: sets(:, :), part, n_parts
      integer(ip), intent(out) :: count(:)
      integer(ip) :: s, k, n

      n = size(sets, 2, kind=ip)
      count = 0
      do s = part_end(part - 1, n_parts, n) + 1, part_end(part, n_parts, n)
         do k = 1, size(sets, 1, kind=ip)
            if (sets(k, s) == 0) exit
            count(sets(k, s)) = count(sets(k, s)) + 1
         end do
      end do
   end subroutine count_members

   !> From the lengths of the lists, by parts, to their starts; chunk by chunk of the members.
   subroutine counts_to_starts(at, first)
      integer(ip), intent(inout) :: at(:, :)         !< (n, n_parts)
      integer(ip), intent(out) :: first(:)           !< (n + 1)
      integer(ip) :: start(chunk_count(size(at, 1, kind=ip)) + 1)
      integer(ip) :: chunk, low, high, n

      n = size(at, 1, kind=ip)
      start(1) = 1
      !$omp parallel do schedule(static) private(low, high) if (is_shared(n))
      do chunk = 1, chunk_count(n)
         call find_chunk(chunk, n, low, high)
         start(chunk + 1) = sum(at(low:high, :))
      end do
      !$omp end parallel do
      do chunk = 2, size(start, kind=ip)
         start(chunk) = start(chunk) + start(chunk - 1)
      end do
      !$omp parallel do schedule(static) private(low, high) if (is_shared(n))
      do chunk = 1, chunk_count(n)
         call find_chunk(chunk, n, low, high)
         call starts_in_chunk(start(chunk), at(low:high, :), first(low:high))
      end do
      !$omp end parallel do
      first(n + 1) = start(size(start))
   end subroutine counts_to_starts

   pure subroutine starts_in_chunk(start, at, first)
      integer(ip), intent(in) :: start
      integer(ip), intent(inout) :: at(:, :)
      integer(ip), intent(out) :: first(:)
      integer(ip) :: i, part, next, count

      next = start
      do i = 1, size(first, kind=ip)
         first(i) = next
         do part = 1, size(at, 2, kind=ip)
            count = at(i, part)
            at(i, part) = next
            next = next + count
         end do
      end do
   end subroutine starts_in_chunk

   pure subroutine fill_lists(sets, part, n_parts, at, holder, row)
      integer(ip), intent(in) :: sets(:, :), part, n_parts
      integer(ip), intent(inout) :: at(:)
      integer(ip), intent(inout) :: holder(:)        !< changed where the sets of this part go
      integer(ip), intent(inout) :: row(:)           !< of no length: not wanted
      integer(ip) :: s, k, n, i
      logical :: is_wanted

      is_wanted = size(row) > 0
      n = size(sets, 2, kind=ip)
      do s = part_end(part - 1, n_parts, n) + 1, part_end(part, n_parts, n)
         do k = 1, size(sets, 1, kind=ip)
            i = sets(k, s)
            if (i == 0) exit
            holder(at(i)) = s
            if (is_wanted) row(at(i)) = k
            at(i) = at(i) + 1
         end do
      end do
   end subroutine fill_lists

end module atrito_incidence
