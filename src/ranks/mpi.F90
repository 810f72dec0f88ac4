!> The processes of one run, its ranks, by MPI; the only module that knows it. without_mpi/ has its twin, with one rank.
!>
!> Rank 0 is the program; the others wait for what it wants of them. A message is a buffer. Its length goes before it, so that
!> whoever receives can make room.
module atrito_mpi
   use, intrinsic :: iso_fortran_env, only: int8
   use atrito_kinds, only: ip, lp, wp
   use atrito_buffer, only: buffer_t, make_buffer, buffer_bytes
   use mpi_f08, only: MPI_Allreduce, MPI_ANY_SOURCE, MPI_BYTE, MPI_Comm, MPI_Comm_free, MPI_Comm_rank, MPI_Comm_size, &
                      MPI_Comm_split_type, MPI_COMM_TYPE_SHARED, MPI_COMM_WORLD, MPI_DOUBLE_PRECISION, MPI_Finalize, &
                      MPI_Get_library_version, MPI_IN_PLACE, MPI_INFO_NULL, MPI_Init_thread, MPI_INTEGER8, MPI_Iprobe, &
                      MPI_MAX_LIBRARY_VERSION_STRING, MPI_Recv, MPI_Send, MPI_Status, MPI_STATUS_IGNORE, MPI_SUM, &
                      MPI_THREAD_FUNNELED
   implicit none (type, external)
   private
   public :: begin_ranks, end_ranks, own_rank, rank_count, ranks_on_host, ANY_RANK
   public :: send_buffer, receive_buffer, has_message, sum_over_ranks
   public :: all_ranks_communicator, has_mpi, mpi_name

   !> The sender of any message that waits.
   integer(ip), parameter :: ANY_RANK = -1_ip
   integer, parameter :: LENGTH_TAG = 1, CONTENT_TAG = 2
   !> MPI counts in default integers: what is longer goes in slices [bytes].
   integer(lp), parameter :: SLICE = 2_lp**30

contains

   !> Before anything else that is said here.
   subroutine begin_ranks()
      integer :: provided

      call MPI_Init_thread(MPI_THREAD_FUNNELED, provided)
   end subroutine begin_ranks

   !> After it nothing is said any more. All ranks come here, whatever became of the run.
   subroutine end_ranks()

      call MPI_Finalize()
   end subroutine end_ranks

   !> 0 is the first.
   integer(ip) function own_rank() result(rank)
      integer :: r

      call MPI_Comm_rank(MPI_COMM_WORLD, r)
      rank = int(r, ip)
   end function own_rank

   !> All of them; 1 in a program that was not begun by mpirun.
   integer(ip) function rank_count() result(n)
      integer :: ranks

      call MPI_Comm_size(MPI_COMM_WORLD, ranks)
      n = int(ranks, ip)
   end function rank_count

   !> Ranks that share the memory of this one's host, itself among them. All ranks call it.
   integer(ip) function ranks_on_host() result(n)
      type(MPI_Comm) :: host
      integer :: ranks

      call MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, host)
      call MPI_Comm_size(host, ranks)
      call MPI_Comm_free(host)
      n = int(ranks, ip)
   end function ranks_on_host

   !> Comes back when the buffer may be changed.
   subroutine send_buffer(buffer, to)
      type(buffer_t), intent(in), target :: buffer   !< is not changed
      integer(ip), intent(in) :: to                  !< rank, not this one
      integer(int8), pointer :: bytes(:)
      integer(lp) :: length, first, last

      bytes => buffer_bytes(buffer)
      length = size(bytes, kind=lp)
      call MPI_Send([length], 1, MPI_INTEGER8, int(to), LENGTH_TAG, MPI_COMM_WORLD)
      do first = 1, length, SLICE
         last = min(length, first + SLICE - 1)
         call MPI_Send(bytes(first:last), int(last - first + 1), MPI_BYTE, int(to), CONTENT_TAG, MPI_COMM_WORLD)
      end do
   end subroutine send_buffer

   !> The next buffer of a rank, or of the first that has one.
   subroutine receive_buffer(buffer, from, sender)
      type(buffer_t), intent(out), target :: buffer  !< filled, nothing of it taken
      integer(ip), intent(in) :: from                !< or ANY_RANK
      integer(ip), intent(out), optional :: sender   !< rank that has sent it
      type(MPI_Status) :: status
      integer(int8), pointer :: bytes(:)
      integer(lp) :: length(1), first, last
      integer :: source

      source = int(from)
      if (from == ANY_RANK) source = MPI_ANY_SOURCE
      call MPI_Recv(length, 1, MPI_INTEGER8, source, LENGTH_TAG, MPI_COMM_WORLD, status)
      source = status%MPI_SOURCE
      if (present(sender)) sender = int(source, ip)
      call make_buffer(length(1), buffer)
      bytes => buffer_bytes(buffer)
      do first = 1, length(1), SLICE
         last = min(length(1), first + SLICE - 1)
         call MPI_Recv(bytes(first:last), int(last - first + 1), MPI_BYTE, source, CONTENT_TAG, MPI_COMM_WORLD, &
                       MPI_STATUS_IGNORE)
      end do
   end subroutine receive_buffer

   !> Whether a buffer of any rank waits.
   logical function has_message()
      call MPI_Iprobe(MPI_ANY_SOURCE, LENGTH_TAG, MPI_COMM_WORLD, has_message, MPI_STATUS_IGNORE)
   end function has_message

   !> Adds up a list of numbers over all ranks, for all of them. All ranks call it.
   subroutine sum_over_ranks(x)
      real(wp), intent(inout), contiguous :: x(:)    !< of each rank; on return the sums

      call MPI_Allreduce(MPI_IN_PLACE, x, size(x), MPI_DOUBLE_PRECISION, MPI_SUM, MPI_COMM_WORLD)
   end subroutine sum_over_ranks

   !> The communicator of all ranks, for a library that takes it as a number.
   integer function all_ranks_communicator() result(communicator)
      communicator = MPI_COMM_WORLD%MPI_VAL
   end function all_ranks_communicator

   !> Whether the ranks are those of MPI: a library that comes in two kinds is wanted in that for MPI then.
   pure logical function has_mpi()
      has_mpi = .true.
   end function has_mpi

   !> For --version: 'Open MPI v4.1.4'.
   function mpi_name() result(name)
      character(len=:), allocatable :: name
      character(len=MPI_MAX_LIBRARY_VERSION_STRING) :: text
      integer :: length

      call MPI_Get_library_version(text, length)
      name = text(:length)
      if (index(name, ',') > 0) name = name(:index(name, ',') - 1)
   end function mpi_name

end module atrito_mpi
