!> What rank 0 may want of the others: the first number of a buffer that it sends them.
module atrito_rank_services
   use, intrinsic :: iso_c_binding, only: c_double
   use atrito_kinds, only: ip, lp, wp
   use atrito_mpi, only: has_message, rank_count, send_buffer
   use atrito_buffer, only: buffer_t, put
   use atrito_system, only: pause_for
   implicit none (type, external)
   private
   public :: dismiss_ranks, send_to_others, await_message
   public :: SERVICE_END, SERVICE_FIELDS, SERVICE_PART, SERVICE_MEMORY, SERVICE_RUNS

   integer(ip), parameter :: SERVICE_END = 0_ip    !< nothing more
   integer(ip), parameter :: SERVICE_FIELDS = 1_ip !< stresses and their error (atrito_shared_fields)
   integer(ip), parameter :: SERVICE_PART = 2_ip   !< of the part of a scene that the rank has (atrito_part_service)
   integer(ip), parameter :: SERVICE_MEMORY = 3_ip !< how much there is for the rank (atrito_rank_memory)
   integer(ip), parameter :: SERVICE_RUNS = 4_ip   !< runs of a sweep or a study: the arguments of the program follow

   real(wp), parameter :: ALERT = 2.0e-3_wp        !< [s] who waits looks so long without a pause: requests come in quick succession
   real(c_double), parameter :: PAUSE = 1.0e-4_c_double    !< [s] behind that: who waits for long leaves the core to others

contains

   !> The others may end.
   subroutine dismiss_ranks()
      type(buffer_t) :: buffer

      call put(buffer, SERVICE_END)
      call send_to_others(buffer)
   end subroutine dismiss_ranks

   !> The same buffer to all ranks but the first.
   subroutine send_to_others(buffer)
      type(buffer_t), intent(in) :: buffer         !< begins with a service, SERVICE_*
      integer(ip) :: rank

      do rank = 1, rank_count() - 1
         call send_buffer(buffer, rank)
      end do
   end subroutine send_to_others

   !> Waits for a buffer of any rank without taking a core for it.
   subroutine await_message()
      integer(lp) :: began, now, rate

      call system_clock(began, rate)
      do while (.not. has_message())
         call system_clock(now)
         if (real(now - began, wp) > ALERT*real(rate, wp)) call pause_for(PAUSE)
      end do
   end subroutine await_message

end module atrito_rank_services
