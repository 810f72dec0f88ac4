!> The system that holds the parts of a scene together, as one full matrix: for few shared unknowns.
module atrito_dense_top
   use atrito_dense, only: solve_cholesky
   use atrito_kinds, only: ip, lp, wp
   use atrito_multifrontal, only: eliminate
   use atrito_status, only: status_t, set_status, STATUS_INTERNAL, STATUS_SINGULAR
   implicit none (type, external)
   private
   public :: dense_top_t, begin_top, add_packed_to_top, factor_top, solve_top, top_bytes, expected_top_bytes

   type :: dense_top_t
      integer(ip) :: n = 0
      integer(ip) :: failed = 0                  !< unknown whose pivot was not positive; 0: none
      real(wp), allocatable, private :: matrix(:, :) !< (n, n) lower triangle, then its factor
   end type dense_top_t

contains

   !> Zero. status: STATUS_INTERNAL when the memory does not suffice.
   subroutine begin_top(n, top, status)
      integer(ip), intent(in) :: n
      type(dense_top_t), intent(inout) :: top
      type(status_t), intent(out) :: status
      integer :: no_memory

      top%n = n
      top%failed = 0
      no_memory = 0
      if (.not. allocated(top%matrix)) allocate (top%matrix(n, n), stat=no_memory)
      if (no_memory == 0) top%matrix = 0.0_wp
      if (no_memory /= 0) call set_status(status, STATUS_INTERNAL, 'not enough memory for what the parts share')
   end subroutine begin_top

   !> Adds what is left of a part: the lower triangle by columns (atrito_packed_matrices).
   pure subroutine add_packed_to_top(unknown, values, top)
      integer(ip), intent(in) :: unknown(:)      !< number of each of its kept unknowns
      real(wp), intent(in) :: values(:)
      type(dense_top_t), intent(inout) :: top
      integer(ip) :: i, j
      integer(lp) :: k

      k = 0
      do j = 1, size(unknown, kind=ip)
         do i = j, size(unknown, kind=ip)
            k = k + 1
            associate (row => max(unknown(i), unknown(j)), column => min(unknown(i), unknown(j)))
               top%matrix(row, column) = top%matrix(row, column) + values(k)
            end associate
         end do
      end do
   end subroutine add_packed_to_top

   !> status: STATUS_SINGULAR when a pivot is not positive.
   subroutine factor_top(top, status)
      type(dense_top_t), intent(inout) :: top
      type(status_t), intent(out) :: status

      call eliminate(top%n, top%n, top%matrix, top%failed)
      if (top%failed > 0) call set_status(status, STATUS_SINGULAR, 'a pivot is not positive')
   end subroutine factor_top

   !> x <- A^-1 x.
   subroutine solve_top(top, x)
      type(dense_top_t), intent(in) :: top
      real(wp), intent(inout), contiguous :: x(:)

      if (top%n > 0) call solve_cholesky(top%matrix, x)
   end subroutine solve_top

   pure integer(lp) function top_bytes(top) result(bytes)
      type(dense_top_t), intent(in) :: top

      bytes = 0
      if (allocated(top%matrix)) bytes = size(top%matrix, kind=lp)*(storage_size(1.0_wp)/8)
   end function top_bytes

   !> What a top of n unknowns will take.
   pure integer(lp) function expected_top_bytes(n) result(bytes)
      integer(ip), intent(in) :: n

      bytes = int(n, lp)**2*(storage_size(1.0_wp)/8)
   end function expected_top_bytes

end module atrito_dense_top
