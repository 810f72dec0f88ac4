!> A matrix by the entries of its rows, and its products.
!>
!>     (A x)_i = sum of value(k) x(column(k)) over k = first(i) .. first(i+1) - 1
!>
!> The rows of the contact constraints over displacements (B), those of the rigid motions at the points (G) and the average of
!> pressures (S_rho) are such matrices: a row has a few entries, whatever the size of the scene. A sum that is less than some
!> EPS_MACH of the sum of its terms without their signs, |A| |x|, is round-off; who judges one asks for both.
module atrito_sparse_rows
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: sparse_rows_t, multiply_rows, add_transposed, transposed_sizes

   !> What has more to say of its rows or columns extends it.
   type :: sparse_rows_t
      integer(ip) :: n = 0                       !< rows
      integer(ip) :: n_columns = 0               !< length of x
      integer(ip), allocatable :: first(:)       !< (n + 1)
      integer(ip), allocatable :: column(:)      !< of each entry
      real(wp), allocatable :: value(:)          !< of each entry
   end type sparse_rows_t

contains

   !> y = A x, and the sums of the sizes of its terms, |A| |x|.
   pure subroutine multiply_rows(rows, x, y, sizes)
      class(sparse_rows_t), intent(in) :: rows   !< A
      real(wp), intent(in) :: x(:)               !< (columns)
      real(wp), intent(out) :: y(:)              !< (rows)
      real(wp), intent(out), optional :: sizes(:) !< (rows)
      integer(ip) :: i, k

      do i = 1, rows%n
         y(i) = 0.0_wp
         do k = rows%first(i), rows%first(i + 1) - 1
            y(i) = y(i) + rows%value(k)*x(rows%column(k))
         end do
      end do
      if (.not. present(sizes)) return
      do i = 1, rows%n
         sizes(i) = 0.0_wp
         do k = rows%first(i), rows%first(i + 1) - 1
            sizes(i) = sizes(i) + abs(rows%value(k)*x(rows%column(k)))
         end do
      end do
   end subroutine multiply_rows

   !> y <- y + factor A' q, row by row; rows whose q is zero are passed over.
   pure subroutine add_transposed(rows, factor, q, y)
      class(sparse_rows_t), intent(in) :: rows   !< A
      real(wp), intent(in) :: factor             !< 1 or -1, mostly
      real(wp), intent(in) :: q(:)               !< (rows)
      real(wp), intent(inout) :: y(:)            !< (columns)
      integer(ip) :: i, k

      do i = 1, rows%n
         if (q(i) == 0.0_wp) cycle
         do k = rows%first(i), rows%first(i + 1) - 1
            y(rows%column(k)) = y(rows%column(k)) + factor*(rows%value(k)*q(i))
         end do
      end do
   end subroutine add_transposed

   !> |A|' |q|, the sums of the sizes of the terms of A' q.
   pure function transposed_sizes(rows, q) result(sizes)
      class(sparse_rows_t), intent(in) :: rows   !< A
      real(wp), intent(in) :: q(:)               !< (rows)
      real(wp) :: sizes(rows%n_columns)
      integer(ip) :: i, k

      sizes = 0.0_wp
      do i = 1, rows%n
         do k = rows%first(i), rows%first(i + 1) - 1
            sizes(rows%column(k)) = sizes(rows%column(k)) + abs(rows%value(k)*q(i))
         end do
      end do
   end function transposed_sizes

end module atrito_sparse_rows
