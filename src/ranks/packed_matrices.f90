!> Dense symmetric matrices, each over a few of the unknowns of a larger system whose matrix is their sum.
!>
!> Their values are one array: the lower triangles by columns, one matrix after the other, as LAPACK packs a triangle.
module atrito_packed_matrices
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: packed_matrices_t, packed_length, put_packed, list_coordinates, add_diagonals, scale_packed, &
             raise_diagonals

   type :: packed_matrices_t
      integer(ip), allocatable :: start(:)       !< (matrices + 1) matrix m is over unknown(start(m):start(m + 1) - 1)
      integer(ip), allocatable :: unknown(:)     !< none twice in a matrix
   end type packed_matrices_t

contains

   !> Values before matrix m.
   pure integer(lp) function values_before(matrices, m) result(length)
      type(packed_matrices_t), intent(in) :: matrices
      integer(ip), intent(in) :: m
      integer(ip) :: k

      length = 0
      do k = 1, m - 1
         associate (order => int(matrices%start(k + 1) - matrices%start(k), lp))
            length = length + order*(order + 1)/2
         end associate
      end do
   end function values_before

   !> Values of all matrices.
   pure integer(lp) function packed_length(matrices) result(length)
      type(packed_matrices_t), intent(in) :: matrices

      length = values_before(matrices, size(matrices%start, kind=ip))
   end function packed_length

   !> Puts the values of a matrix to their place.
   pure subroutine put_packed(matrices, m, matrix, values)
      type(packed_matrices_t), intent(in) :: matrices
      integer(ip), intent(in) :: m
      real(wp), intent(in) :: matrix(:, :)       !< its lower triangle is read
      real(wp), intent(inout) :: values(:)       !< (packed_length)
      integer(lp) :: k, length
      integer(ip) :: j

      k = values_before(matrices, m)
      do j = 1, size(matrix, 2, kind=ip)
         length = size(matrix, 1, kind=lp) - j + 1
         values(k + 1:k + length) = matrix(j:, j)
         k = k + length
      end do
   end subroutine put_packed

   !> Unknowns of row and column of each value.
   pure subroutine list_coordinates(matrices, row, column)
      type(packed_matrices_t), intent(in) :: matrices
      integer(ip), intent(out), contiguous :: row(:), column(:)   !< (packed_length)
      integer(lp) :: k
      integer(ip) :: m, a, b

      k = 0
      do m = 1, size(matrices%start, kind=ip) - 1
         do b = matrices%start(m), matrices%start(m + 1) - 1
            do a = b, matrices%start(m + 1) - 1
               k = k + 1
               row(k) = matrices%unknown(a)
               column(k) = matrices%unknown(b)
            end do
         end do
      end do
   end subroutine list_coordinates

   !> Adds the diagonals of all matrices to that of the system.
   pure subroutine add_diagonals(matrices, values, diagonal)
      type(packed_matrices_t), intent(in) :: matrices
      real(wp), intent(in) :: values(:)
      real(wp), intent(inout) :: diagonal(:)     !< (unknowns of the system)
      integer(lp) :: k
      integer(ip) :: m, a

      k = 1
      do m = 1, size(matrices%start, kind=ip) - 1
         do a = matrices%start(m), matrices%start(m + 1) - 1
            diagonal(matrices%unknown(a)) = diagonal(matrices%unknown(a)) + values(k)
            k = k + matrices%start(m + 1) - a
         end do
      end do
   end subroutine add_diagonals

   !> Multiplies rows and columns of all matrices.
   pure subroutine scale_packed(matrices, scale, values)
      type(packed_matrices_t), intent(in) :: matrices
      real(wp), intent(in) :: scale(:)           !< (unknowns of the system)
      real(wp), intent(inout) :: values(:)
      integer(lp) :: k, length
      integer(ip) :: m, b

      k = 0
      do m = 1, size(matrices%start, kind=ip) - 1
         associate (own => matrices%unknown(matrices%start(m):matrices%start(m + 1) - 1))
            do b = 1, size(own, kind=ip)
               length = size(own, kind=lp) - b + 1
               values(k + 1:k + length) = values(k + 1:k + length)*scale(own(b))*scale(own(b:))
               k = k + length
            end do
         end associate
      end do
   end subroutine scale_packed

   !> Multiplies the diagonals of all matrices.
   pure subroutine raise_diagonals(matrices, factor, values)
      type(packed_matrices_t), intent(in) :: matrices
      real(wp), intent(in) :: factor
      real(wp), intent(inout) :: values(:)
      integer(lp) :: k
      integer(ip) :: m, a

      k = 1
      do m = 1, size(matrices%start, kind=ip) - 1
         do a = matrices%start(m), matrices%start(m + 1) - 1
            values(k) = values(k)*factor
            k = k + matrices%start(m + 1) - a
         end do
      end do
   end subroutine raise_diagonals

end module atrito_packed_matrices
