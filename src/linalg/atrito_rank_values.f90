!> Values of unknowns that several ranks have, by way of rank 0, who has all of them. All ranks call every procedure.
module atrito_rank_values
   use atrito_kinds, only: ip, wp
   use atrito_mpi, only: own_rank, spread_from_first, sum_to_first
   implicit none (type, external)
   private
   public :: spread_values, add_up_values

contains

   !> Gives each rank its part of what rank 0 has.
   subroutine spread_values(n, unknown, x, values)
      integer(ip), intent(in) :: n               !< unknowns of all ranks
      integer(ip), intent(in) :: unknown(:)      !< those of this rank, in any order, as often as it likes
      real(wp), intent(in) :: x(:, :)            !< (n, columns) on rank 0; other ranks: of any size
      real(wp), allocatable, intent(out) :: values(:, :)   !< (size(unknown), columns)
      real(wp) :: columns(1), column(n)
      integer(ip) :: j

      columns = real(size(x, 2), wp)
      call spread_from_first(columns)
      allocate (values(size(unknown), nint(columns(1))))
      do j = 1, size(values, 2, kind=ip)
         if (own_rank() == 0) column = x(:, j)
         call spread_from_first(column)
         values(:, j) = column(unknown)
      end do
   end subroutine spread_values

   !> Adds up what the ranks have.
   subroutine add_up_values(n, unknown, values, x)
      integer(ip), intent(in) :: n               !< unknowns of all ranks
      integer(ip), intent(in) :: unknown(:)      !< those of this rank; one that is there twice counts twice
      real(wp), intent(in) :: values(:, :)       !< (size(unknown), columns), as many columns on all ranks
      real(wp), intent(inout) :: x(:, :)         !< (n, columns) on rank 0: the sums on return; other ranks: of any size
      real(wp) :: column(n)
      integer(ip) :: j, k

      do j = 1, size(values, 2, kind=ip)
         column = 0.0_wp
         do k = 1, size(unknown, kind=ip)
            column(unknown(k)) = column(unknown(k)) + values(k, j)
         end do
         call sum_to_first(column)
         if (own_rank() == 0) x(:, j) = column
      end do
   end subroutine add_up_values

end module atrito_rank_values
