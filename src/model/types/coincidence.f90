!> Which points of a few lie on points of many.
module atrito_coincidence
   use atrito_kinds, only: ip, lp, wp
   use atrito_sorting, only: sorted_places, first_at_least, order_key
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
      integer(lp), allocatable :: key(:)
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
      near = near(sorted_places(order_key(others(k, near))))
      key = order_key(others(k, near))
      do i = 1, size(points, 2, kind=ip)
         match(i) = nearest_of(points(:, i), others, near, first_at_least(key, order_key(points(k, i) - reach)), k, reach)
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

end module atrito_coincidence
