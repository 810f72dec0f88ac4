!> One front: a dense symmetric matrix, its pivots eliminated by Cholesky's method.
!>
!> With p for the pivots and b for the border of the front F
!>
!>     F_pp = L_p L_p',      L_b = F_bp L_p^-T,      U = F_bb - L_b L_b':
!>
!> the columns of L_p and L_b are those of the factor, U is the update, which the front of the parent takes. Pivots are taken in
!> panels (right-looking): the triangle of a panel is factored (dpotrf), the rows below it are divided by it (dtrsm), and the
!> products of these rows are taken off all that is left (dsyrk on the diagonal, dgemm below): n m^2 operations for n pivots and m
!> rows, nearly all of them in dgemm, at the full rate of the processor.
!>
!> The lower triangle is worked on in tiles whose size does not depend on the number of threads, so that results do not either.
!> Large fronts share their tiles out as tasks of the enclosing parallel region, if there is one: the divisions of a panel are
!> independent of one another, and so are the columns of tiles that are updated; a taskwait stands between the two.
module atrito_front
   use atrito_kinds, only: ip, lp, wp
   use atrito_lapack, only: dgemm, dpotrf, dsyrk, dtrsm
   implicit none (type, external)
   private
   public :: clear_front, eliminate, add_element, add_update, pack_columns, packed_length

   !> Pivots eliminated at a time, and rows or columns of a tile.
   integer(ip), parameter :: PANEL = 128_ip, TILE = 192_ip
   !> Columns moved at a time, and the order from which on that is shared out.
   integer(ip), parameter :: STRIP = 64_ip, LARGE = 512_ip

contains

   !> Entries of the first columns of a lower triangle.
   pure elemental integer(lp) function packed_length(order, columns)
      integer(ip), intent(in) :: order, columns  !< columns <= order

      packed_length = int(columns, lp)*int(order, lp) - int(columns, lp)*int(columns - 1, lp)/2
   end function packed_length

   !> Adds an element matrix, a packed lower triangle.
   pure subroutine add_element(order, front, m, positions, matrix)
      integer(ip), intent(in) :: order, m            !< rows of the front; of the element matrix
      real(wp), intent(inout) :: front(order, order) !< lower triangle alone
      integer(ip), intent(in) :: positions(m)        !< in the front; 0: prescribed
      real(wp), intent(in) :: matrix(*)              !< (m (m + 1)/2) by columns
      integer(ip) :: a, b, i, j, k

      k = 0
      do b = 1, m
         do a = b, m
            k = k + 1
            i = max(positions(a), positions(b))
            j = min(positions(a), positions(b))
            if (j > 0) front(i, j) = front(i, j) + matrix(k)
         end do
      end do
   end subroutine add_element

   !> Zeroes the lower triangle.
   subroutine clear_front(order, front)
      integer(ip), intent(in) :: order               !< rows of the front
      real(wp), intent(inout) :: front(order, order) !< lower triangle alone
      integer(ip) :: first, j

      do first = 1, order, STRIP
         !$omp task default(none) shared(front) firstprivate(first, order) private(j) if(order > LARGE)
         do j = first, min(first + STRIP - 1, order)
            front(j:, j) = 0.0_wp
         end do
         !$omp end task
      end do
      !$omp taskwait
   end subroutine clear_front

   !> Adds what the elimination of a child left, a packed lower triangle.
   subroutine add_update(order, front, m, positions, update)
      integer(ip), intent(in) :: order, m            !< rows of the front; of the update
      real(wp), intent(inout) :: front(order, order) !< lower triangle alone
      integer(ip), intent(in) :: positions(m)        !< in the front, ascending
      real(wp), intent(in) :: update(*)              !< (m (m + 1)/2) by columns
      integer(ip) :: first

      do first = 1, m, STRIP
         !$omp task default(none) shared(front, positions, update) firstprivate(first, order, m) if(m > LARGE)
         call add_strip(order, front, m, positions, update, first, min(first + STRIP - 1, m))
         !$omp end task
      end do
      !$omp taskwait
   end subroutine add_update

   !> Adds some columns of an update. Each has a column of the front to itself.
   pure subroutine add_strip(order, front, m, positions, update, first, last)
      integer(ip), intent(in) :: order, m, first, last
      real(wp), intent(inout) :: front(order, order)
      integer(ip), intent(in) :: positions(m)
      real(wp), intent(in) :: update(*)
      integer(ip) :: a, b, j
      integer(lp) :: k

      k = packed_length(m, first - 1)
      do b = first, last
         j = positions(b)
         do a = b, m
            k = k + 1
            front(positions(a), j) = front(positions(a), j) + update(k)
         end do
      end do
   end subroutine add_strip

   !> Eliminates the first pivots: their columns become those of L, the rest the Schur complement.
   subroutine eliminate(order, n_pivots, front, failed)
      integer(ip), intent(in) :: order, n_pivots     !< rows of the front; those eliminated, the first ones
      real(wp), intent(inout) :: front(order, order) !< lower triangle: F, then L_p, L_b and U
      integer(ip), intent(out) :: failed             !< the first pivot that is not positive, 0: none; it is left on the diagonal
      integer(ip) :: first, last, info

      failed = 0
      do first = 1, n_pivots, PANEL
         last = min(first + PANEL - 1, n_pivots)
         call dpotrf('L', last - first + 1, front(first, first), order, info)
         if (info /= 0) then
            failed = first + info - 1
            return
         end if
         if (last < order) call update_rest(order, first, last, front)
      end do
   end subroutine eliminate

   !> Columns of L below a panel, and their products taken off the rest.
   subroutine update_rest(order, first, last, front)
      integer(ip), intent(in) :: order, first, last
      real(wp), intent(inout) :: front(order, order)
      integer(ip) :: start, n

      do start = last + 1, order, TILE
         !$omp task default(none) shared(front) firstprivate(start, order, first, last) if(order - last > 2*TILE)
         call dtrsm('R', 'L', 'T', 'N', min(TILE, order - start + 1), last - first + 1, 1.0_wp, front(first, first), order, &
                    front(start, first), order)
         !$omp end task
      end do
      !$omp taskwait
      do start = last + 1, order, TILE
         !$omp task default(none) shared(front) firstprivate(start, order, first, last) private(n) if(order - last > 2*TILE)
         n = min(TILE, order - start + 1)
         call dsyrk('L', 'N', n, last - first + 1, -1.0_wp, front(start, first), order, 1.0_wp, front(start, start), order)
         if (start + n <= order) call dgemm('N', 'T', order - start - n + 1, n, last - first + 1, -1.0_wp, &
                                            front(start + n, first), order, front(start, first), order, 1.0_wp, &
                                            front(start + n, start), order)
         !$omp end task
      end do
      !$omp taskwait
   end subroutine update_rest

   !> Columns of a lower triangle one behind the other.
   subroutine pack_columns(order, front, first, last, packed)
      integer(ip), intent(in) :: order, first, last !< rows of the front; its columns from here to there
      real(wp), intent(in) :: front(order, order)   !< lower triangle alone
      real(wp), intent(inout) :: packed(*)          !< from the diagonal down, column after column
      integer(ip) :: start

      do start = first, last, STRIP
         !$omp task default(none) shared(front, packed) firstprivate(start, order, first, last) if(order > LARGE)
         call pack_strip(order, front, start, min(start + STRIP - 1, last), &
                         packed(packed_length(order, start - 1) - packed_length(order, first - 1) + 1))
         !$omp end task
      end do
      !$omp taskwait
   end subroutine pack_columns

   pure subroutine pack_strip(order, front, first, last, packed)
      integer(ip), intent(in) :: order, first, last
      real(wp), intent(in) :: front(order, order)
      real(wp), intent(inout) :: packed(*)
      integer(ip) :: j
      integer(lp) :: k

      k = 0
      do j = first, last
         packed(k + 1:k + order - j + 1) = front(j:order, j)
         k = k + order - j + 1
      end do
   end subroutine pack_strip

end module atrito_front
