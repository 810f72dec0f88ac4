!> A four-sided block of elements: lines of nodes in the unit square, and where they lie.
module atrito_block
   use atrito_block_map, only: block_map_t, between, map_point
   use atrito_kinds, only: ip, wp
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: graded_lines, block_nodes, curved_nodes

contains

   !> Lines 0..1 of one direction with n elements: equal, or each longer than the one before by a constant factor such that
   !> the last is `grade` times the first; of both halves from the ends on, such that the middle is `grade` times the ends.
   !>
   !> The element lengths are 1, r, r^2, ... r^(n - 1), over their sum, with r = grade^(1/(n - 1)). Of halves the exponent of
   !> element i is min(i - 1, n - i), the same from both ends, and r = grade^(1/((n - 1)/2)) with the quotient rounded down. The
   !> second half is the mirror of the first to the last bit, so a block that is symmetric has a symmetric mesh.
   pure function graded_lines(n, grade, of_halves) result(t)
      integer(ip), intent(in) :: n        !< elements, >= 1
      real(wp), intent(in) :: grade       !< last over first element length, > 0
      logical, intent(in) :: of_halves    !< grade from both ends to the middle
      real(wp) :: t(0:n), ratio
      integer(ip) :: i, steps

      steps = n - 1
      if (of_halves) steps = steps/2
      ratio = 1.0_wp
      if (steps > 0) ratio = grade**(1.0_wp/real(steps, wp))
      if (ratio == 1.0_wp) then
         t = [(real(i, wp)/real(n, wp), i=0, n)]
         return
      end if
      t(0) = 0.0_wp
      do i = 1, n
         t(i) = t(i - 1) + ratio**merge(min(i - 1, n - i), i - 1, of_halves)
      end do
      t = t/t(n)
      if (of_halves) t(n:n - n/2 + 1:-1) = 1 - t(:n/2 - 1)   ! the same both ways
      if (of_halves .and. mod(n, 2_ip) == 0) t(n/2) = 0.5_wp
   end function graded_lines

   !> Nodes of a block, row by row from BOTTOM (corner 1 to 2) to TOP (corner 4 to 3).
   subroutine block_nodes(corners, tx, ty, x)
      real(wp), intent(in) :: corners(2, 4)          !< [L], counter-clockwise
      real(wp), intent(in) :: tx(0:), ty(0:)         !< lines 0..1 along and across
      real(wp), intent(out) :: x(:, :)               !< (2, size(tx)*size(ty)) [L]
      real(wp) :: bottom(2, 0:size(tx) - 1), top(2, 0:size(tx) - 1)
      integer(ip) :: i, j, n

      do i = 0, size(tx, kind=ip) - 1
         bottom(:, i) = between(corners(:, 1), corners(:, 2), tx(i))
         top(:, i) = between(corners(:, 4), corners(:, 3), tx(i))
      end do
      n = size(tx, kind=ip)
      !$omp parallel do default(none) shared(n, bottom, top, ty, x) if(is_shared(n*size(ty, kind=ip)))
      do j = 0, size(ty, kind=ip) - 1
         do i = 0, n - 1
            x(:, j*n + i + 1) = between(bottom(:, i), top(:, i), ty(j))
         end do
      end do
      !$omp end parallel do
   end subroutine block_nodes

   !> The same for a block whose sides are arcs.
   subroutine curved_nodes(map, tx, ty, x)
      type(block_map_t), intent(in) :: map           !< corners, and the centres of the arcs
      real(wp), intent(in) :: tx(0:), ty(0:)         !< lines 0..1 along and across
      real(wp), intent(out) :: x(:, :)               !< (2, size(tx)*size(ty)) [L]
      integer(ip) :: i, j, n

      n = size(tx, kind=ip)
      !$omp parallel do default(none) shared(n, map, tx, ty, x) if(is_shared(n*size(ty, kind=ip)))
      do j = 0, size(ty, kind=ip) - 1
         do i = 0, n - 1
            x(:, j*n + i + 1) = map_point(map, tx(i), ty(j))
         end do
      end do
      !$omp end parallel do
   end subroutine curved_nodes

end module atrito_block
