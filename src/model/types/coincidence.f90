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
      real(wp) :: low(2), high(2), least, distance
      integer(ip) :: i, j, k, n

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
         least = reach
         do j = first_at_least(key, order_key(points(k, i) - reach)), n
            if (others(k, near(j)) > points(k, i) + reach) exit
            distance = norm2(others(:, near(j)) - points(:, i))
            if (distance > least) cycle
            least = distance
            match(i) = near(j)
         end do
      end do
   end function match_points

end module atrito_coincidence
