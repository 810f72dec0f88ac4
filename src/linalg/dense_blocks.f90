!> Dense linear algebra of large orders, shared out to the threads by blocks.
!>
!> The blocks do not depend on the number of threads, and each entry of a result is computed by one of them: results are the same
!> to the last bit for any number of threads. All of it works at order 0.
!>
!> A block is as large as a core can keep near it: of 96 columns a square takes 74 KB. Products of blocks then do 96 operations for
!> each number that comes from memory, while a product of a matrix and a vector, which uses each entry once, waits for memory
!> whatever is done, and is not shared out.
module atrito_dense_blocks
   use atrito_halting, only: halting_t, suspend_halting, restore_halting
   use atrito_kinds, only: ip, wp
   use atrito_lapack, only: dgemm, dsymv, dtrsm, dtrsv
   use atrito_front, only: eliminate
   implicit none (type, external)
   private
   public :: factor_in_blocks, solve_with_triangle, solve_with_half, divide_by_triangle, multiply_symmetric, add_inverse_form

   integer(ip), parameter :: BLOCK = 96_ip             !< columns of a block
   integer(ip), parameter :: LARGE = 400_ip            !< order from which on work is shared out

contains

   !> A = L L' in place: reads and writes the lower triangle alone. The caller scales.
   !>
   !> Right-looking: a panel of columns is factored, the rows below it are divided by its triangle, and their products are taken off
   !> what is left, tile by tile. It is the elimination of a front (atrito_front) all of whose equations are pivots; the tiles are
   !> tasks for the threads.
   subroutine factor_in_blocks(a, pivot_failed)
      real(wp), intent(inout), contiguous :: a(:, :)   !< (n, n)
      integer(ip), intent(out) :: pivot_failed         !< 0, or the first row whose pivot is not positive
      type(halting_t) :: halting
      integer(ip) :: n

      n = size(a, 1, kind=ip)
      call suspend_halting(halting)
      !$omp parallel default(none) shared(a, n, pivot_failed) if(n > LARGE)
      !$omp single
      call eliminate(n, n, a, pivot_failed)
      !$omp end single
      !$omp end parallel
      call restore_halting(halting)
   end subroutine factor_in_blocks

   !> x <- A^-1 x with the factor of A, for one x: waits for memory alone (dpotrs packs the factor first).
   subroutine solve_with_triangle(a, x)
      real(wp), intent(in), contiguous :: a(:, :)      !< (n, n) factor, lower triangle
      real(wp), intent(inout), contiguous :: x(:)      !< (n)

      call solve_with_half(a, .false., x)
      call solve_with_half(a, .true., x)
   end subroutine solve_with_triangle

   !> x <- L^-1 x, or L'^-1 x.
   subroutine solve_with_half(a, is_transposed, x)
      real(wp), intent(in), contiguous :: a(:, :)      !< (n, n) factor, lower triangle
      logical, intent(in) :: is_transposed             !< L'
      real(wp), intent(inout), contiguous :: x(:)      !< (n)
      type(halting_t) :: halting
      integer(ip) :: n

      n = size(a, 1, kind=ip)
      if (n == 0) return
      call suspend_halting(halting)
      call dtrsv('L', merge('T', 'N', is_transposed), 'N', n, a, n, x, 1_ip)
      call restore_halting(halting)
   end subroutine solve_with_half

   !> X <- L^-1 X
   subroutine divide_by_triangle(a, x)
      real(wp), intent(in), contiguous :: a(:, :)      !< (n, n) factor, lower triangle
      real(wp), intent(inout), contiguous :: x(:, :)   !< (n, k)
      type(halting_t) :: halting
      integer(ip) :: n

      n = size(a, 1, kind=ip)
      if (size(x) == 0) return
      call suspend_halting(halting)
      call dtrsm('L', 'L', 'N', 'N', n, size(x, 2, kind=ip), 1.0_wp, a, n, x, n)
      call restore_halting(halting)
   end subroutine divide_by_triangle

   !> y <- A x, A symmetric: reads the lower triangle alone.
   subroutine multiply_symmetric(a, x, y)
      real(wp), intent(in), contiguous :: a(:, :)      !< (n, n)
      real(wp), intent(in), contiguous :: x(:)         !< (n)
      real(wp), intent(out), contiguous :: y(:)        !< (n)
      type(halting_t) :: halting
      integer(ip) :: n

      n = size(a, 1, kind=ip)
      y = 0.0_wp
      if (n == 0) return
      call suspend_halting(halting)
      call dsymv('L', n, 1.0_wp, a, n, x, 1_ip, 0.0_wp, y, 1_ip)
      call restore_halting(halting)
   end subroutine multiply_symmetric

   !> C <- C + B F B' for F = (L L')^-1, as X'X with X = L^-1 B'.
   !>
   !> That is how the compliance of a body at its contact points comes about: L is the factor of its condensed stiffness, the rows
   !> of B take the motions of the points from the displacements. In this form C is symmetric to the last bit, as each product of
   !> two columns of X is computed once and put into both places, and positive semidefinite up to the rounding of one sum; F itself
   !> is never formed.
   !>
   !> A column of B' that begins with zeros down to row k has a column of X that does, as L^-1 is a lower triangle: its triangular
   !> solve and its products begin at row k. Columns are taken in blocks, each from the first row of its first column on, so they
   !> are best sorted by that. The blocks of X'X in the lower triangle are counted one after the other and shared out to the
   !> threads: no two of them write to the same place.
   subroutine add_inverse_form(factor, x, first, place, c)
      real(wp), intent(in), contiguous :: factor(:, :) !< (n, n) lower triangle L
      real(wp), intent(inout), contiguous :: x(:, :)   !< (n, k) B'; on return L^-1 B'
      integer(ip), intent(in) :: first(:)              !< (k) first entry of each column that is not zero, ascending
      integer(ip), intent(in) :: place(:)              !< (k) row and column of C of each; all different
      real(wp), intent(inout), contiguous :: c(:, :)   !< symmetric
      type(halting_t) :: halting
      integer(ip) :: n, k, m, start, pair, pairs

      n = size(x, 1, kind=ip)
      k = size(x, 2, kind=ip)
      m = size(c, 1, kind=ip)
      pairs = triangle((k + BLOCK - 1)/BLOCK)
      call suspend_halting(halting)
      !$omp parallel do schedule(dynamic, 1) default(none) shared(factor, x, first, n, k) if(n > LARGE)
      do start = 1, k, BLOCK
         call divide_columns(n, start, min(start + BLOCK - 1, k), first(start), factor, x)
      end do
      !$omp end parallel do
      !$omp parallel do schedule(dynamic, 1) default(none) shared(x, first, place, c, n, k, m, pairs) if(n > LARGE)
      do pair = 1, pairs
         call add_pair(n, k, m, pair, x, first, place, c)
      end do
      !$omp end parallel do
      call restore_halting(halting)
   end subroutine add_inverse_form

   !> 1 + 2 + ... + n: blocks in the first n rows of a lower triangle.
   pure integer(ip) function triangle(n)
      integer(ip), intent(in) :: n !< order of the matrix

      triangle = n*(n + 1)/2
   end function triangle

   !> X = L^-1 B' of some columns, from their first entry on.
   subroutine divide_columns(n, start, end, first, factor, x)
      integer(ip), intent(in) :: n, start, end, first
      real(wp), intent(in) :: factor(n, n)
      real(wp), intent(inout) :: x(n, *)

      if (first > n) return
      call dtrsm('L', 'L', 'N', 'N', n - first + 1, end - start + 1, 1.0_wp, factor(first, first), n, x(first, start), n)
   end subroutine divide_columns

   !> One block of X'X and its mirror image. Pairs are counted by rows of the lower triangle of blocks: pair number p is in row r
   !> with r (r + 1)/2 < p <= (r + 1)(r + 2)/2, rows counted from 0, which is the root of a square rounded down. On the diagonal the
   !> lower triangle of the block alone is added, and mirrored.
   subroutine add_pair(n, k, m, pair, x, first, place, c)
      integer(ip), intent(in) :: n, k, m, pair
      real(wp), intent(in) :: x(n, k)
      integer(ip), intent(in) :: first(k), place(k)
      real(wp), intent(inout) :: c(m, m)
      real(wp) :: product(BLOCK, BLOCK)
      integer(ip) :: row, column, i, j, rows, columns, a, b, from

      row = int((sqrt(8.0_wp*real(pair, wp) - 7.0_wp) - 1.0_wp)/2.0_wp, ip)
      if (triangle(row + 1) < pair) row = row + 1       ! should the root have been rounded down
      if (triangle(row) >= pair) row = row - 1
      column = pair - triangle(row) - 1
      i = row*BLOCK
      j = column*BLOCK
      rows = min(BLOCK, k - i)
      columns = min(BLOCK, k - j)
      from = first(i + 1)                               ! the later of both
      if (from > n) return
      call dgemm('T', 'N', rows, columns, n - from + 1, 1.0_wp, x(from, i + 1), n, x(from, j + 1), n, 0.0_wp, product, BLOCK)
      do b = 1, columns
         do a = merge(b, 1_ip, row == column), rows
            c(place(i + a), place(j + b)) = c(place(i + a), place(j + b)) + product(a, b)
            if (i + a /= j + b) c(place(j + b), place(i + a)) = c(place(j + b), place(i + a)) + product(a, b)
         end do
      end do
   end subroutine add_pair

end module atrito_dense_blocks
