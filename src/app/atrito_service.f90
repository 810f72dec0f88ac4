!> What ranks other than the first do: they wait for what the first wants of them, and do it.
module atrito_service
   use atrito_kinds, only: ip
   use atrito_mpi, only: receive_parcel
   use atrito_parcel, only: parcel_t, take
   use atrito_part_service, only: serve_parts
   use atrito_part_store, only: part_store_t
   use atrito_part_tops, only: serve_tops, top_store_t
   use atrito_rank_services, only: SERVICE_END, SERVICE_FIELDS, SERVICE_PARTS, SERVICE_TOPS
   use atrito_shared_fields, only: serve_fields
   implicit none (type, external)
   private
   public :: serve

contains

   !> Comes back when nothing more is wanted.
   subroutine serve()
      type(parcel_t) :: request
      type(part_store_t) :: parts
      type(top_store_t) :: tops
      integer(ip) :: service

      do
         call receive_parcel(request, 0_ip)
         call take(request, service)
         select case (service)
         case (SERVICE_END)
            return
         case (SERVICE_PARTS)
            call serve_parts(parts, request)
         case (SERVICE_TOPS)
            call serve_tops(parts, tops, request)
         case (SERVICE_FIELDS)
            call serve_fields(request)
         case default
            error stop 'atrito_service: an unknown service is wanted'
         end select
      end do
   end subroutine serve

end module atrito_service
