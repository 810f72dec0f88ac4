!> Threads of the parallel regions (OpenMP).
!>
!> A region shares out independent pieces of work, and what they give is summed in an order that does not depend on who did them:
!> results are the same to the last bit for any number of threads. The number is OpenMP's own setting of the calling thread; the
!> program sets it at its start, so that no variable of the environment decides.
module atrito_threads
   use omp_lib, only: omp_get_max_threads, omp_set_num_threads
   use atrito_kinds, only: ip
   implicit none (type, external)
   private
   public :: set_threads, n_threads

contains

   !> Threads of the parallel regions that follow.
   subroutine set_threads(n)
      integer(ip), intent(in) :: n              !< >= 1

      call omp_set_num_threads(int(max(n, 1_ip)))
   end subroutine set_threads

   !> Threads that a parallel region would take.
   integer(ip) function n_threads()
      n_threads = int(omp_get_max_threads(), ip)
   end function n_threads

end module atrito_threads
