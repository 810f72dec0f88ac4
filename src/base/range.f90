!> Sums whose terms may leave the range of numbers where nothing else does: the work of forces that are 1e300 in the user's units.
module atrito_range
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_positive_inf, ieee_negative_inf
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_threads, only: is_shared, chunk_count, find_chunk
   implicit none (type, external)
   private
   public :: work_of, unit_of, largest_at

contains

   !> sum(force*displacement); infinite, without raising an exception, where that is too large for a number.
   pure real(wp) function work_of(n, force, displacement) result(work)
      integer(ip), intent(in) :: n                 !< dofs, >= 0
      real(wp), intent(in) :: force(n)             !< [F]
      real(wp), intent(in) :: displacement(n)      !< [L]
      real(wp) :: scale, total

      work = 0.0_wp
      if (n == 0) return
      scale = maxval(abs(displacement))
      if (scale <= 0.0_wp) return
      total = sum(force*(displacement/scale))
      if (abs(total) <= HUGE_REAL/max(scale, 1.0_wp)) then
         work = total*scale
      else if (total > 0.0_wp) then
         work = ieee_value(work, ieee_positive_inf)
      else
         work = ieee_value(work, ieee_negative_inf)
      end if
   end function work_of

   !> A power of two next to the largest of the values: what they are over it is not above 1, without rounding. 1 of nothing and of
   !> zeros.
   real(wp) function unit_of(values) result(unit)
      real(wp), intent(in) :: values(:, :)                 !< of any shape, their sizes alone count
      integer, parameter :: MOST = maxexponent(1.0_wp) - 2 !< 1/unit is a number as well
      real(wp) :: largest(chunk_count(size(values, 2, kind=ip)))
      integer(ip) :: chunk, first, last

      unit = 1.0_wp
      if (size(largest) == 0) return
      !$omp parallel do schedule(static) private(first, last) if (is_shared(size(values, 2, kind=ip)))
      do chunk = 1, size(largest, kind=ip)
         call find_chunk(chunk, size(values, 2, kind=ip), first, last)
         largest(chunk) = maxval(abs(values(:, first:last)))
      end do
      !$omp end parallel do
      if (maxval(largest) > 0.0_wp) unit = scale(1.0_wp, max(-MOST, min(MOST, exponent(maxval(largest)))))
   end function unit_of

   !> The largest size in some columns; 0: there are none. A loop costs a fifth of maxval with a list of places.
   pure real(wp) function largest_at(values, columns) result(largest)
      real(wp), intent(in) :: values(:, :)                 !< of any dimension
      integer(ip), intent(in) :: columns(:)                !< places along the second extent
      integer(ip) :: i, k

      largest = 0.0_wp
      do k = 1, size(columns, kind=ip)
         do i = 1, size(values, 1, kind=ip)
            if (abs(values(i, columns(k))) > largest) largest = abs(values(i, columns(k)))
         end do
      end do
   end function largest_at

end module atrito_range
