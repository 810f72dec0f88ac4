!> The outcome of a call, and texts that need not be there, in parcels.
module atrito_status_parcel
   use atrito_kinds, only: ip
   use atrito_parcel, only: parcel_t, put, take
   use atrito_status, only: status_t
   implicit none (type, external)
   private
   public :: put_status, take_status, put_text

contains

   !> Adds an outcome.
   subroutine put_status(parcel, status)
      type(parcel_t), intent(inout) :: parcel
      type(status_t), intent(in) :: status

      call put(parcel, int(status%code, ip))
      call put_text(parcel, status%text)
   end subroutine put_status

   !> The next item, an outcome.
   subroutine take_status(parcel, status)
      type(parcel_t), intent(inout) :: parcel
      type(status_t), intent(out) :: status
      integer(ip) :: code

      call take(parcel, code)
      status%code = int(code)
      call take(parcel, status%text)
   end subroutine take_status

   !> Adds a text; one that is not there is empty.
   subroutine put_text(parcel, text)
      type(parcel_t), intent(inout) :: parcel
      character(len=:), allocatable, intent(in) :: text

      if (allocated(text)) then
         call put(parcel, text)
      else
         call put(parcel, '')
      end if
   end subroutine put_text

end module atrito_status_parcel
