!> What rank 0 may want of the others: the first number of a parcel that it sends them.
module atrito_rank_services
   use atrito_kinds, only: ip
   use atrito_mpi, only: rank_count, send_parcel
   use atrito_parcel, only: parcel_t, put
   implicit none (type, external)
   private
   public :: dismiss_ranks, SERVICE_END

   integer(ip), parameter :: SERVICE_END = 0_ip    !< nothing more

contains

   !> The others may end.
   subroutine dismiss_ranks()
      type(parcel_t) :: parcel
      integer(ip) :: rank

      call put(parcel, SERVICE_END)
      do rank = 1, rank_count() - 1
         call send_parcel(parcel, rank)
      end do
   end subroutine dismiss_ranks

end module atrito_rank_services
