!> Threads of the parallel regions (OpenMP).
!>
!> A region shares out independent pieces of work, and what they give is summed in an order that does not depend on who did them:
!> results are the same to the last bit for any number of threads. The number is OpenMP's own setting of the calling thread; the
!> program sets it at its start, so that no variable of the environment decides.
!>
!> Long lists are shared out in chunks of a fixed length. Whatever depends on how far a piece of work reaches - a sum, an element
!> that is compared with the one before - begins anew with each chunk, whoever does it.
module atrito_threads
   use omp_lib, only: omp_get_max_threads, omp_get_num_procs, omp_get_thread_num, omp_set_num_threads
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: set_threads, lent_threads, n_threads, this_thread, is_shared, chunk_count, find_chunk, CHUNK_LENGTH

   integer(ip), parameter :: CHUNK_LENGTH = 1024
   !> Fewer pieces than this are done by one thread: to wake others takes as long.
   integer(ip), parameter :: LEAST_SHARED = 4*CHUNK_LENGTH

contains

   !> Threads of the parallel regions that follow.
   subroutine set_threads(n)
      integer(ip), intent(in) :: n              !< >= 1

      call omp_set_num_threads(int(max(n, 1_ip)))
   end subroutine set_threads

   !> Threads for what one of several processes does while the others wait: theirs, too, where it may run on as many processors.
   integer(ip) function lent_threads(n, n_processes)
      integer(ip), intent(in) :: n              !< >= 1, of each
      integer(ip), intent(in) :: n_processes    !< >= 1, of the machine

      lent_threads = max(n, min(n*n_processes, int(omp_get_num_procs(), ip)))
   end function lent_threads

   !> Threads that a parallel region would take.
   integer(ip) function n_threads()
      n_threads = int(omp_get_max_threads(), ip)
   end function n_threads

   !> Number of the thread that asks, 1 .. n_threads(), in a parallel region.
   integer(ip) function this_thread()
      this_thread = int(omp_get_thread_num(), ip) + 1
   end function this_thread

   !> Whether a list is long enough for more than one thread: the `if` of the parallel regions.
   pure logical function is_shared(n)
      integer(ip), intent(in) :: n              !< pieces of work, from a few operations on

      is_shared = n >= LEAST_SHARED
   end function is_shared

   !> Chunks in a list.
   pure integer(ip) function chunk_count(n)
      integer(ip), intent(in) :: n              !< length of the list

      chunk_count = (n + CHUNK_LENGTH - 1)/CHUNK_LENGTH
   end function chunk_count

   !> Bounds of a run.
   pure subroutine find_chunk(chunk, n, first, last)
      integer(ip), intent(in) :: chunk            !< 1 .. chunk_count(n)
      integer(ip), intent(in) :: n              !< length of the list
      integer(ip), intent(out) :: first, last   !< places in the list

      first = (chunk - 1)*CHUNK_LENGTH + 1
      last = min(chunk*CHUNK_LENGTH, n)
   end subroutine find_chunk

end module atrito_threads
