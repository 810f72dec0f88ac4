!> What rank 0 may want of the others: the first number of a parcel that it sends them.
module atrito_rank_services
   use atrito_kinds, only: ip
   use atrito_mpi, only: rank_count, send_parcel
   use atrito_parcel, only: parcel_t, put
   implicit none (type, external)
   private
   public :: dismiss_ranks, SERVICE_END, SERVICE_PARTS, SERVICE_TOPS, SERVICE_FIELDS

   integer(ip), parameter :: SERVICE_END = 0_ip    !< nothing more
   integer(ip), parameter :: SERVICE_PARTS = 1_ip  !< of the parts of a scene (atrito_part_service)
   integer(ip), parameter :: SERVICE_TOPS = 2_ip   !< of what their bodies have in common (atrito_part_tops)
   integer(ip), parameter :: SERVICE_FIELDS = 3_ip !< stresses and their error (atrito_shared_fields)

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
