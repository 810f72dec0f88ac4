!> Which points of a few lie on points of many.
module atrito_coincidence
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: match_points

contains

   !> For each of some points the one of `others` that is nearest within `reach`; 0 when there is none.
   pure function match_points(points, others, reach) result(match)
      real(wp), intent(in) :: points(:, :)    !< (2, n) [L]
      real(wp), intent(in) :: others(:, :)    !< (2, m) [L]
      real(wp), intent(in) :: reach           !< [L], >= 0
      integer(ip) :: match(size(points, 2))
      integer(ip), allocatable :: near(:)
      real(wp), allocatable :: key(:)
      real(wp) :: low(2), high(2)
      integer(ip) :: i, k, n

      match = 0
      if (size(points, 2) == 0) return
      low = minval(points, dim=2) - reach
      high = maxval(points, dim=2) + reach
      near = pack([(i, i=1, size(others, 2, kind=ip))], others(1, :) >= low(1) .and. others(1, :) <= high(1) .and. &
                  others(2, :) >= low(2) .and. others(2, :) <= high(2))
      n = size(near, kind=ip)
      k = merge(1_ip, 2_ip, high(1) - low(1) >= high(2) - low(2))
      call sort_by(others(k, :), near)
      key = others(k, near)
      do i = 1, size(points, 2, kind=ip)
         match(i) = nearest_of(points(:, i), others, near, first_at_least(key, points(k, i) - reach), k, reach)
      end do
   end function match_points

   !> The nearest of the sorted candidates from the first-th on.
   pure integer(ip) function nearest_of(x, others, near, first, k, reach) result(match)
      real(wp), intent(in) :: x(2), others(:, :)
      integer(ip), intent(in) :: near(:), first, k
      real(wp), intent(in) :: reach
      real(wp) :: least, distance
      integer(ip) :: i

      match = 0
      least = reach
      do i = first, size(near, kind=ip)
         if (others(k, near(i)) > x(k) + reach) return
         distance = norm2(others(:, near(i)) - x)
         if (distance > least) cycle
         least = distance
         match = near(i)
      end do
   end function nearest_of

   pure integer(ip) function first_at_least(key, bound) result(low)
      real(wp), intent(in) :: key(:)          !< rising
      real(wp), intent(in) :: bound
      integer(ip) :: high, middle

      low = 1
      high = size(key, kind=ip) + 1
      do while (low < high)
         middle = (low + high)/2
         if (key(middle) < bound) then
            low = middle + 1
         else
            high = middle
         end if
      end do
   end function first_at_least

   !> Heap sort of places by their key.
   pure subroutine sort_by(key, places)
      real(wp), intent(in) :: key(:)
      integer(ip), intent(inout) :: places(:)
      integer(ip) :: i, n, held

      n = size(places, kind=ip)
      do i = n/2, 1, -1
         call sift_down(key, places, i, n)
      end do
      do i = n, 2, -1
         held = places(1)
         places(1) = places(i)
         places(i) = held
         call sift_down(key, places, 1_ip, i - 1)
      end do
   end subroutine sort_by

   pure subroutine sift_down(key, places, top, n)
      real(wp), intent(in) :: key(:)
      integer(ip), intent(inout) :: places(:)
      integer(ip), intent(in) :: top, n
      integer(ip) :: i, child, held

      i = top
      held = places(i)
      do
         child = 2*i
         if (child > n) exit
         if (child < n) then
            if (key(places(child + 1)) > key(places(child))) child = child + 1
         end if
         if (key(places(child)) <= key(held)) exit
         places(i) = places(child)
         i = child
      end do
      places(i) = held
   end subroutine sift_down

end module atrito_coincidence
