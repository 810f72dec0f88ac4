!> Sorting by whole numbers, and what is found in sorted lists.
module atrito_sorting
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: sorted_places, each_once, first_at_least, order_key

contains

   !> The places of some keys in rising order of the keys, equal ones in the order in which they come: a merge sort.
   !>
   !> Runs of one, then of two, four, ... neighbours are sorted each; two of them are merged into one of twice the length by taking
   !> the lower of their first keys again and again, of equal ones that of the left run. That is n comparisons a doubling, n log2 n
   !> in all, whatever the keys. Keys that are sorted already, as those of a deck often are, are seen at once.
   pure function sorted_places(key) result(places)
      integer(lp), intent(in) :: key(:) !< (n) in any order
      integer(ip) :: places(size(key))
      integer(ip), allocatable :: merged(:)
      integer(ip) :: i, n, length, middle, last

      n = size(key, kind=ip)
      do i = 1, n
         places(i) = i
      end do
      if (all(key(2:) >= key(:n - 1))) return
      allocate (merged(n))
      length = 1
      do while (length < n)
         do i = 1, n, 2*length
            middle = min(i + length - 1, n)
            last = min(middle + length, n)
            call merge_runs(key, places(i:middle), places(middle + 1:last), merged(i:last))
         end do
         places = merged
         length = 2*length
      end do
   end function sorted_places

   pure subroutine merge_runs(key, left, right, merged)
      integer(lp), intent(in) :: key(:)
      integer(ip), intent(in) :: left(:), right(:)   !< sorted
      integer(ip), intent(out) :: merged(:)
      integer(ip) :: i, j, k
      logical :: from_left

      i = 1
      j = 1
      do k = 1, size(merged, kind=ip)
         from_left = j > size(right)
         if (.not. from_left .and. i <= size(left)) from_left = key(left(i)) <= key(right(j))
         if (from_left) then
            merged(k) = left(i)
            i = i + 1
         else
            merged(k) = right(j)
            j = j + 1
         end if
      end do
   end subroutine merge_runs

   !> Numbers in rising order, each once.
   pure function each_once(numbers) result(once)
      integer(ip), intent(in) :: numbers(:) !< in any order
      integer(ip), allocatable :: once(:)
      logical :: is_new(size(numbers))

      once = numbers(sorted_places(int(numbers, lp)))
      is_new = .true.
      is_new(2:) = once(2:) > once(:size(once) - 1)
      once = pack(once, is_new)
   end function each_once

   !> Place of the first key that is not below a bound; one more than there are when all are.
   pure integer(ip) function first_at_least(key, bound) result(low)
      integer(lp), intent(in) :: key(:)              !< rising
      integer(lp), intent(in) :: bound               !< what the key is not to be below
      integer(ip) :: high, middle

      low = 1
      high = size(key, kind=ip) + 1
      do while (low < high)
         middle = low + (high - low)/2
         if (key(middle) < bound) then
            low = middle + 1
         else
            high = middle
         end if
      end do
   end function first_at_least

   !> A whole number for a real: they have the same order. Of numbers that are not negative the bits, exponent before fraction,
   !> are whole numbers in their order (IEEE 754). Negative ones have the first bit set, which makes a negative whole number, and
   !> the same bits behind it in falling order: these are turned over. (-0 comes just before 0.)
   pure elemental integer(lp) function order_key(x) result(key)
      real(wp), intent(in) :: x !< finite or infinite

      key = transfer(x, key)
      if (key < 0_lp) key = ieor(key, huge(key))
   end function order_key

end module atrito_sorting
