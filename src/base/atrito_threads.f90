!> Threads of the parallel regions (OpenMP).
!>
!> A region shares out independent pieces of work, and what they give is summed in an order that does not depend on who did them:
!> results are the same to the last bit for any number of threads. The number is OpenMP's own setting of the calling thread; the
!> program sets it at its start, so that no variable of the environment decides.
!>
!> Threads that wait for others go round in a circle for a moment, then sleep. That of gfortran's OpenMP is some milliseconds
!> long: where a core has other work to do, too, threads then wait for one that has no core, and a run took two to eight times as
!> long. A moment of some microseconds costs a few per cent on idle cores (docs/performance.md), so it is taken where the cores are
!> not all idle when a run begins. Only a variable of the environment decides on that, as it is when a program begins.
!>
!> Long lists are shared out in runs of a fixed length. Whatever depends on how far a piece of work reaches - a sum, an element that
!> is compared with the one before - begins anew with each run, whoever does it.
module atrito_threads
   use omp_lib, only: omp_get_max_threads, omp_get_num_procs, omp_get_thread_num, omp_set_num_threads
   use atrito_kinds, only: ip, wp
   use atrito_processes, only: begin_anew
   implicit none (type, external)
   private
   public :: set_threads, sleep_soon, n_threads, this_thread, is_shared, run_count, find_run, RUN_LENGTH

   integer(ip), parameter :: RUN_LENGTH = 1024
   !> Fewer pieces than this are done by one thread: to wake others takes as long.
   integer(ip), parameter :: LEAST_SHARED = 4*RUN_LENGTH

   character(len=*), parameter :: SHORT_WHILE = '2000'   !< rounds before a waiting thread sleeps; gfortran's OpenMP: 300,000
   integer, parameter :: NOT_SET = 1             !< status of get_environment_variable

contains

   !> Threads of the parallel regions that follow.
   subroutine set_threads(n)
      integer(ip), intent(in) :: n              !< >= 1

      call omp_set_num_threads(int(max(n, 1_ip)))
   end subroutine set_threads

   !> Begins the program anew, once, so that its threads go to sleep soon when they wait, where the cores have other work to do; not
   !> where the environment says how they are to wait.
   subroutine sleep_soon(n_threads)
      integer(ip), intent(in) :: n_threads      !< that there will be
      integer :: policy, count

      if (are_cores_free(n_threads)) return
      call get_environment_variable('OMP_WAIT_POLICY', status=policy)
      call get_environment_variable('GOMP_SPINCOUNT', status=count)
      if (policy == NOT_SET .and. count == NOT_SET) call begin_anew('GOMP_SPINCOUNT', SHORT_WHILE)
   end subroutine sleep_soon

   !> Whether so many cores have nothing else to do at the moment, as far as the system tells ('0.61 0.85 1.08 3/97 31301': three
   !> processes run, this one among them).
   logical function are_cores_free(n)
      integer(ip), intent(in) :: n
      real(wp) :: load(3)
      character(len=80) :: line
      integer :: unit, ios, running

      running = 1
      open (newunit=unit, file='/proc/loadavg', action='read', status='old', iostat=ios)
      if (ios == 0) then
         read (unit, '(a)', iostat=ios) line
         close (unit)
      end if
      if (ios == 0) read (line(:index(line//'/', '/') - 1), *, iostat=ios) load, running
      if (ios /= 0) running = 1
      are_cores_free = n + max(running - 1, 0) <= omp_get_num_procs()
   end function are_cores_free

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

   !> Runs in a list.
   pure integer(ip) function run_count(n)
      integer(ip), intent(in) :: n              !< length of the list

      run_count = (n + RUN_LENGTH - 1)/RUN_LENGTH
   end function run_count

   !> Bounds of a run.
   pure subroutine find_run(run, n, first, last)
      integer(ip), intent(in) :: run            !< 1 .. run_count(n)
      integer(ip), intent(in) :: n              !< length of the list
      integer(ip), intent(out) :: first, last

      first = (run - 1)*RUN_LENGTH + 1
      last = min(run*RUN_LENGTH, n)
   end subroutine find_run

end module atrito_threads
