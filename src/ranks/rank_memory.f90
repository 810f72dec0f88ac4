!> How much memory each rank can get: asked of all of them by the first.
!>
!> What `ulimit -v` leaves is of a rank alone; what its host has is there for all ranks of the host together.
module atrito_rank_memory
   use atrito_files, only: read_system_line
   use atrito_kinds, only: ip, lp
   use atrito_memory, only: address_space_left, resident_memory, shared_memory_left
   use atrito_mpi, only: rank_count, receive_parcel, send_parcel
   use atrito_parcel, only: parcel_t, put, take
   use atrito_rank_services, only: send_to_others, SERVICE_MEMORY
   use atrito_system, only: reusable_memory
   implicit none (type, external)
   private
   public :: rank_memory_t, ask_for_memory, serve_memory

   type :: rank_memory_t
      character(len=:), allocatable :: host      !< its name
      integer(lp) :: held = 0                    !< bytes that the rank needs as they are
      integer(lp) :: free = 0                    !< bytes that it has besides: they were given back, and serve again
      integer(lp) :: own = huge(1_lp)            !< bytes that it may still get by its own limit
      integer(lp) :: of_host = huge(1_lp)        !< bytes that all processes of its host can still get together
   end type rank_memory_t

contains

   !> Asks all ranks.
   subroutine ask_for_memory(ranks)
      type(rank_memory_t), allocatable, intent(out) :: ranks(:)   !< (ranks) from 0
      type(parcel_t) :: request, answer
      integer(ip) :: rank
      integer(lp), allocatable :: bytes(:)

      allocate (ranks(0:rank_count() - 1))
      call put(request, SERVICE_MEMORY)
      call send_to_others(request)
      call own_memory(ranks(0))
      do rank = 1, rank_count() - 1
         call receive_parcel(answer, rank)
         call take(answer, ranks(rank)%host)
         call take(answer, bytes)
         ranks(rank)%held = bytes(1)
         ranks(rank)%free = bytes(2)
         ranks(rank)%own = bytes(3)
         ranks(rank)%of_host = bytes(4)
      end do
   end subroutine ask_for_memory

   !> The answer of another rank.
   subroutine serve_memory()
      type(rank_memory_t) :: own
      type(parcel_t) :: answer

      call own_memory(own)
      call put(answer, own%host)
      call put(answer, [own%held, own%free, own%own, own%of_host])
      call send_parcel(answer, 0_ip)
   end subroutine serve_memory

   !> Of this rank.
   subroutine own_memory(own)
      type(rank_memory_t), intent(out) :: own
      logical :: found

      call read_system_line('/proc/sys/kernel/hostname', '', own%host, found)
      if (.not. found) own%host = ''
      own%free = min(reusable_memory(), resident_memory())
      own%held = resident_memory() - own%free
      own%own = address_space_left()
      own%of_host = shared_memory_left()
   end subroutine own_memory

end module atrito_rank_memory
