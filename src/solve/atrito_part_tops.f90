!> The top systems of bodies that are in pieces: what their parts leave of the unknowns that they have in common, eliminated by all
!> ranks together.
!>
!> All ranks have each top and do the same with it at the same time: the first one tells the others (ask_for_top), then joins in.
module atrito_part_tops
   use atrito_kinds, only: ip, wp
   use atrito_mpi, only: rank_count, send_parcel
   use atrito_packed_matrices, only: packed_length, put_packed
   use atrito_parcel, only: parcel_t, put, take
   use atrito_part_store, only: part_store_t
   use atrito_rank_services, only: SERVICE_TOPS
   use atrito_shared_system, only: shared_system_t, begin_shared, end_shared, factor_shared, reduce_shared, expand_shared, &
                                   MOST_ORDER
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: top_store_t, serve_tops, find_top, ask_for_top, make_top, forget_top
   public :: TOP_MAKE, TOP_REDUCE, TOP_EXPAND, TOP_FORGET

   !> The top of a body.
   type :: held_top_t
      integer(ip) :: group = 0                   !< of its parts
      type(shared_system_t) :: system
   end type held_top_t

   type :: top_store_t
      type(held_top_t), allocatable :: list(:)
   end type top_store_t

   ! What is wanted.
   integer(ip), parameter :: TOP_MAKE = 1, TOP_REDUCE = 2, TOP_EXPAND = 3, TOP_FORGET = 4

contains

   !> Joins in what the first rank does; what is left of the parcel comes behind SERVICE_TOPS.
   subroutine serve_tops(parts, tops, request)
      type(part_store_t), intent(inout) :: parts
      type(top_store_t), intent(inout) :: tops
      type(parcel_t), intent(inout) :: request
      integer(ip), allocatable :: told(:)        ! what is wanted, group, unknowns, kept ones, equations
      type(status_t) :: status
      real(wp) :: nothing(0, 0)

      call take(request, told)
      select case (told(1))
      case (TOP_MAKE)
         call make_top(parts, tops, told(2), told(3:5), status)
      case (TOP_REDUCE)
         call reduce_shared(tops%list(find_top(tops, told(2)))%system, nothing, status)
      case (TOP_EXPAND)
         call expand_shared(tops%list(find_top(tops, told(2)))%system, nothing, status)
      case (TOP_FORGET)
         call forget_top(tops, told(2))
      end select
   end subroutine serve_tops

   !> The first rank tells the others what they are to join in.
   subroutine ask_for_top(wanted, group, sizes)
      integer(ip), intent(in) :: wanted, group
      integer(ip), intent(in) :: sizes(3)        !< unknowns, how many of them are kept, equations of the body
      type(parcel_t) :: request
      integer(ip) :: rank

      call put(request, SERVICE_TOPS)
      call put(request, [wanted, group, sizes])
      do rank = 1, rank_count() - 1
         call send_parcel(request, rank)
      end do
   end subroutine ask_for_top

   !> Its place in the list; 0: it is not there.
   pure integer(ip) function find_top(tops, group) result(i)
      type(top_store_t), intent(in) :: tops
      integer(ip), intent(in) :: group

      i = 0
      if (.not. allocated(tops%list)) return
      do i = size(tops%list, kind=ip), 1, -1
         if (tops%list(i)%group == group) return
      end do
   end function find_top

   !> Puts the Schur complements of the parts of a group together and eliminates the border. status: the same on all ranks.
   subroutine make_top(parts, tops, group, sizes, status)
      type(part_store_t), intent(inout) :: parts !< what is left of the parts is given back
      type(top_store_t), intent(inout) :: tops
      integer(ip), intent(in) :: group
      integer(ip), intent(in) :: sizes(3)        !< unknowns, how many of them are kept, equations of the body
      type(status_t), intent(out) :: status
      integer(ip), allocatable :: start(:), unknown(:)
      real(wp), allocatable :: values(:), diagonal(:)
      integer(ip) :: i, m, at

      at = place_for(tops, group)
      start = [1_ip]
      allocate (unknown(0), diagonal(0))
      do i = 1, parts%n
         if (parts%list(i)%group /= group) cycle
         unknown = [unknown, parts%list(i)%part%top]
         diagonal = [diagonal, parts%list(i)%solver%retained_diagonal]
         start = [start, size(unknown, kind=ip) + 1_ip]
      end do
      associate (system => tops%list(at)%system)
         call begin_shared(system, sizes(1), sizes(2), start, unknown, status, MOST_ORDER)
         if (.not. is_ok(status)) return
         allocate (values(packed_length(system%own)))
         m = 0
         do i = 1, parts%n
            if (parts%list(i)%group /= group) cycle
            m = m + 1
            call put_packed(system%own, m, parts%list(i)%schur, values)
            deallocate (parts%list(i)%schur)
         end do
         call factor_shared(system, values, diagonal, sizes(3), status)
      end associate
   end subroutine make_top

   !> Its place, or a free one.
   integer(ip) function place_for(tops, group) result(at)
      type(top_store_t), intent(inout) :: tops
      integer(ip), intent(in) :: group
      type(held_top_t), allocatable :: longer(:)
      integer(ip) :: n

      at = find_top(tops, group)
      if (at == 0) at = find_top(tops, 0_ip)
      if (at == 0) then
         n = 0
         if (allocated(tops%list)) n = size(tops%list, kind=ip)
         allocate (longer(n + 2))
         if (n > 0) longer(:n) = tops%list
         call move_alloc(longer, tops%list)
         at = n + 1
      end if
      tops%list(at)%group = group
   end function place_for

   !> All ranks together: MUMPS ends an instance on all of them.
   subroutine forget_top(tops, group)
      type(top_store_t), intent(inout) :: tops
      integer(ip), intent(in) :: group
      integer(ip) :: at

      at = find_top(tops, group)
      if (at == 0) return
      call end_shared(tops%list(at)%system)
      tops%list(at)%group = 0
   end subroutine forget_top

end module atrito_part_tops
