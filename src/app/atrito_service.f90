!> What ranks other than the first do: they wait for what the first wants of them, and do it.
module atrito_service
   use atrito_kinds, only: ip
   use atrito_mpi, only: receive_parcel
   use atrito_parcel, only: parcel_t, take
   use atrito_rank_services, only: SERVICE_END
   implicit none (type, external)
   private
   public :: serve

contains

   !> Comes back when nothing more is wanted.
   subroutine serve()
      type(parcel_t) :: request
      integer(ip) :: service

      do
         call receive_parcel(request, 0_ip)
         call take(request, service)
         select case (service)
         case (SERVICE_END)
            return
         case default
            error stop 'atrito_service: an unknown service is wanted'
         end select
      end do
   end subroutine serve

end module atrito_service
