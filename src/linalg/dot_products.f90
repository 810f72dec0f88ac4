!> The inner loops of the skyline: dot products of one or two columns with one or four, and multiples taken off a column.
!>
!> A dot product of two columns does two operations for two numbers that it loads, and a processor can do some ten operations in the
!> time in which one number comes from memory. Of one column with four in a panel, which stays in the cache, it does eight for one
!> number from memory, of two columns sixteen for two and with half as many loads from the cache: that is where the arithmetic
!> units are busy. More columns at a time would not fit into the registers, as each product is a sum of its own.
!>
!> The `simd` directives (honoured with -fopenmp-simd, comments otherwise) let the compiler add up in vector lanes, which it may not
!> do on its own, since that changes the order of the terms.
module atrito_dot_products
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: dot, dot_down, dot_1x4, dot_2x4, take_off, PANEL_WIDTH

   integer(ip), parameter :: PANEL_WIDTH = 4_ip   !< columns that are eliminated together

contains

   !> a . b
   pure real(wp) function dot(n, a, b)
      integer(ip), intent(in) :: n       !< terms, >= 0
      real(wp), intent(in) :: a(n), b(n) !< (n) columns
      integer(ip) :: k

      dot = 0.0_wp
      !$omp simd reduction(+:dot)
      do k = 1, n
         dot = dot + a(k)*b(k)
      end do
   end function dot

   !> a . b, from the last to the first, for those who go backward through a.
   pure real(wp) function dot_down(n, a, b)
      integer(ip), intent(in) :: n       !< terms, >= 0
      real(wp), intent(in) :: a(n), b(n) !< (n) columns
      integer(ip) :: k

      dot_down = 0.0_wp
      !$omp simd reduction(+:dot_down)
      do k = n, 1, -1
         dot_down = dot_down + a(k)*b(k)
      end do
   end function dot_down

   !> y <- y - factor a, from the last to the first: the skyline is gone through backward by this, and memory is fetched ahead only
   !> while the addresses go one way.
   pure subroutine take_off(n, factor, a, y)
      integer(ip), intent(in) :: n    !< rows, >= 0
      real(wp), intent(in) :: factor  !< how many times a is taken off
      real(wp), intent(in) :: a(n)    !< (n) column that is subtracted
      real(wp), intent(inout) :: y(n) !< (n) column that is changed
      integer(ip) :: k

      !$omp simd
      do k = n, 1, -1
         y(k) = y(k) - factor*a(k)
      end do
   end subroutine take_off

   !> products(c) = a . panel(:, c)
   pure subroutine dot_1x4(n, a, rows, panel, products)
      integer(ip), intent(in) :: n                           !< terms, >= 0
      real(wp), intent(in) :: a(n)                           !< (n) column
      integer(ip), intent(in) :: rows                        !< leading dimension of the panel
      real(wp), intent(in) :: panel(rows, PANEL_WIDTH)       !< only its first n rows are used
      real(wp), intent(out) :: products(PANEL_WIDTH)         !< one for each column of the panel
      real(wp) :: s1, s2, s3, s4
      integer(ip) :: k

      s1 = 0.0_wp
      s2 = 0.0_wp
      s3 = 0.0_wp
      s4 = 0.0_wp
      !$omp simd reduction(+:s1, s2, s3, s4)
      do k = 1, n
         s1 = s1 + a(k)*panel(k, 1)
         s2 = s2 + a(k)*panel(k, 2)
         s3 = s3 + a(k)*panel(k, 3)
         s4 = s4 + a(k)*panel(k, 4)
      end do
      products = [s1, s2, s3, s4]
   end subroutine dot_1x4

   !> products(c, 1) = a . panel(:, c), products(c, 2) = b . panel(:, c)
   pure subroutine dot_2x4(n, a, b, rows, panel, products)
      integer(ip), intent(in) :: n                           !< terms, >= 0
      real(wp), intent(in) :: a(n), b(n)                     !< (n) two columns
      integer(ip), intent(in) :: rows                        !< leading dimension of the panel
      real(wp), intent(in) :: panel(rows, PANEL_WIDTH)       !< only its first n rows are used
      real(wp), intent(out) :: products(PANEL_WIDTH, 2)      !< of the panel's columns with a, with b
      real(wp) :: s1, s2, s3, s4, t1, t2, t3, t4
      integer(ip) :: k

      s1 = 0.0_wp
      s2 = 0.0_wp
      s3 = 0.0_wp
      s4 = 0.0_wp
      t1 = 0.0_wp
      t2 = 0.0_wp
      t3 = 0.0_wp
      t4 = 0.0_wp
      !$omp simd reduction(+:s1, s2, s3, s4, t1, t2, t3, t4)
      do k = 1, n
         s1 = s1 + a(k)*panel(k, 1)
         s2 = s2 + a(k)*panel(k, 2)
         s3 = s3 + a(k)*panel(k, 3)
         s4 = s4 + a(k)*panel(k, 4)
         t1 = t1 + b(k)*panel(k, 1)
         t2 = t2 + b(k)*panel(k, 2)
         t3 = t3 + b(k)*panel(k, 3)
         t4 = t4 + b(k)*panel(k, 4)
      end do
      products(:, 1) = [s1, s2, s3, s4]
      products(:, 2) = [t1, t2, t3, t4]
   end subroutine dot_2x4

end module atrito_dot_products
