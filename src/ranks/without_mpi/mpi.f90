!> The twin of src/ranks/mpi.F90: one rank, which has nobody to talk to. It is in the library of the room; atrito-mpi alone
!> links the other in front of it, so both have the same procedures with the same interfaces.
module atrito_mpi
   use atrito_kinds, only: ip, wp
   use atrito_buffer, only: buffer_t
   implicit none (type, external)
   private
   public :: begin_ranks, end_ranks, own_rank, rank_count, ranks_on_host, ANY_RANK
   public :: send_buffer, receive_buffer, has_message, sum_over_ranks
   public :: all_ranks_communicator, has_mpi, mpi_name

   integer(ip), parameter :: ANY_RANK = -1_ip
   character(len=*), parameter :: NOBODY = 'atrito_mpi: there is no other rank'

contains

   !> Nothing begins.
   subroutine begin_ranks()
   end subroutine begin_ranks

   !> Nothing ends.
   subroutine end_ranks()
   end subroutine end_ranks

   !> The only one there is.
   integer(ip) function own_rank()
      own_rank = 0
   end function own_rank

   !> 1.
   integer(ip) function rank_count()
      rank_count = 1
   end function rank_count

   !> 1.
   integer(ip) function ranks_on_host()
      ranks_on_host = 1
   end function ranks_on_host

   !> Nobody takes it: an invariant is broken.
   subroutine send_buffer(buffer, to)
      type(buffer_t), intent(in), target :: buffer !< not used
      integer(ip), intent(in) :: to                !< not used

      error stop NOBODY
   end subroutine send_buffer

   !> Nobody sends one: an invariant is broken.
   subroutine receive_buffer(buffer, from, sender)
      type(buffer_t), intent(out), target :: buffer !< not used
      integer(ip), intent(in) :: from               !< not used
      integer(ip), intent(out), optional :: sender  !< not used

      if (present(sender)) sender = from
      error stop NOBODY
   end subroutine receive_buffer

   !> None ever comes.
   logical function has_message()
      has_message = .false.
   end function has_message

   !> A sum over one rank is what it was.
   subroutine sum_over_ranks(x)
      real(wp), intent(inout), contiguous :: x(:) !< stays
   end subroutine sum_over_ranks

   !> What sequential libraries take for a communicator.
   integer function all_ranks_communicator()
      all_ranks_communicator = 0
   end function all_ranks_communicator

   !> There is no MPI in this program.
   pure logical function has_mpi()
      has_mpi = .false.
   end function has_mpi

   !> For --version.
   function mpi_name() result(name)
      character(len=:), allocatable :: name

      name = 'no MPI'
   end function mpi_name

end module atrito_mpi
