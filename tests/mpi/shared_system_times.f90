!> How long fronts and MUMPS take for dense blocks that ranks share [s of the clock]; asserts nothing (docs/developer/solvers.md, Over ranks).
!>
!>     mpirun -n N shared_system_times ORDER BLOCKS MOST
!>
!> BLOCKS matrices of that order, dealt out to the ranks; each shares a quarter of its unknowns with the one before it. MOST: order of
!> the largest front; 0: by MUMPS.
program shared_system_times
   use, intrinsic :: iso_fortran_env, only: output_unit
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: begin_ranks, end_ranks, largest_of_ranks, own_rank, rank_count
   use atrito_packed_matrices, only: packed_length, put_packed
   use atrito_shared_system, only: shared_system_t, begin_shared, end_shared, factor_shared, memory_of_shared, solve_shared
   use atrito_status, only: status_t, is_ok
   use atrito_system, only: peak_memory
   implicit none (type, external)

   type(shared_system_t) :: system
   type(status_t) :: status
   integer(ip) :: order, blocks, n
   integer(ip), allocatable :: start(:), unknown(:)
   real(wp), allocatable :: values(:), x(:, :)
   real(wp) :: times(4)

   call begin_ranks()
   order = argument(1)
   blocks = argument(2)
   call make_pattern()
   times(1) = clock()
   call begin_shared(system, n, start, unknown, status, argument(3))
   times(2) = clock()
   if (is_ok(status)) then
      call make_values()
      times(2:3) = [times(2) - times(1), clock()]
      call factor_shared(system, values, status)
   end if
   if (is_ok(status)) then
      times(3:4) = [clock() - times(3), clock()]
      deallocate (values)
      allocate (x(n, 1), source=1.0_wp)
      call solve_shared(system, x, status)
      times(4) = clock() - times(4)
      call tell()
   else if (own_rank() == 0) then
      write (output_unit, '(a)') status%text
   end if
   call end_shared(system)
   call end_ranks()

contains

   integer(ip) function argument(k) result(number)
      integer, intent(in) :: k
      character(len=20) :: text

      call get_command_argument(k, text)
      read (text, *) number
   end function argument

   real(wp) function clock()
      integer(lp) :: count, rate

      call system_clock(count, rate)
      clock = real(count, wp)/real(rate, wp)
   end function clock

   subroutine make_pattern()
      integer(ip) :: m, i, shift

      shift = (3*order)/4
      n = order + (blocks - 1)*shift
      start = [1_ip]
      allocate (unknown(0))
      do m = 0, blocks - 1
         if (modulo(m, rank_count()) /= own_rank()) cycle
         unknown = [unknown, (m*shift + i, i=1, order)]
         start = [start, size(unknown, kind=ip) + 1]
      end do
   end subroutine make_pattern

   subroutine make_values()
      real(wp), allocatable :: a(:, :)
      integer(ip) :: m, i

      allocate (values(packed_length(system%own)), a(order, order))
      a = 1.0_wp
      do i = 1, order
         a(i, i) = 10.0_wp
      end do
      do m = 1, size(start, kind=ip) - 1
         call put_packed(system%own, m, a, values)
      end do
   end subroutine make_values

   subroutine tell()
      integer(ip) :: peak, factor

      peak = largest_of_ranks(int(peak_memory()/1000000, ip))
      factor = largest_of_ranks(int(memory_of_shared(system)/1000000, ip))
      if (own_rank() == 0) write (output_unit, '(3(a,i0),3(a,f0.2),2(a,i0),a)') &
         'ranks ', rank_count(), ', blocks ', blocks, ' of ', order, ': analysis ', times(2), &
         ', factor ', times(3), ', solve ', times(4), ' s; largest rank: factor ', factor, ', peak ', peak, ' MB'
   end subroutine tell

end program shared_system_times
