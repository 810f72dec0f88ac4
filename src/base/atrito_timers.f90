!> Wall and processor time by phase, and the peak memory. With the message store the only module state.
module atrito_timers
   use, intrinsic :: iso_c_binding, only: c_int, c_long
   use atrito_kinds, only: lp, wp
   implicit none (type, external)
   private
   public :: phase_time_t, start_phase, stop_phase, get_phases, reset_timers, peak_memory, processor_seconds

   type :: phase_time_t
      character(len=16) :: name = ''
      real(wp) :: wall = 0.0_wp      !< seconds
      real(wp) :: cpu = 0.0_wp       !< seconds, all threads
      logical :: running = .false.
   end type phase_time_t

   integer, parameter :: MOST_PHASES = 32
   type(phase_time_t) :: phases(MOST_PHASES)
   real(wp) :: wall_at_start(MOST_PHASES) = 0.0_wp, cpu_at_start(MOST_PHASES) = 0.0_wp
   integer :: n_phases = 0

   integer, parameter :: RUSAGE_LENGTH = 36, MAXRSS = 5 !< struct rusage of Linux: two timevals (4 longs), then ru_maxrss in KiB
   integer(c_int), parameter :: RUSAGE_CHILDREN = -1_c_int, RUSAGE_SELF = 0_c_int

   interface
      integer(c_int) function c_getrusage(who, usage) bind(C, name='getrusage')
         import :: c_int, c_long
         integer(c_int), value :: who
         integer(c_long), intent(out) :: usage(*)
      end function c_getrusage
   end interface

contains

   !> Starts, or goes on with, the clock of a phase.
   subroutine start_phase(name)
      character(len=*), intent(in) :: name
      integer :: i

      i = find_phase(name)
      if (i == 0) return
      phases(i)%running = .true.
      call read_clocks(wall_at_start(i), cpu_at_start(i))
   end subroutine start_phase

   !> Stops the clock of a phase.
   subroutine stop_phase(name)
      character(len=*), intent(in) :: name
      real(wp) :: wall, cpu
      integer :: i

      i = find_phase(name)
      if (i == 0) return
      if (.not. phases(i)%running) return
      call read_clocks(wall, cpu)
      phases(i)%wall = phases(i)%wall + wall - wall_at_start(i)
      phases(i)%cpu = phases(i)%cpu + cpu - cpu_at_start(i)
      phases(i)%running = .false.
   end subroutine stop_phase

   !> The phases in the order in which they first began.
   function get_phases() result(list)
      type(phase_time_t), allocatable :: list(:)

      list = phases(:n_phases)
   end function get_phases

   subroutine reset_timers()
      phases = phase_time_t()
      n_phases = 0
   end subroutine reset_timers

   !> Index of a phase, made when it is new; 0 when there is no room.
   integer function find_phase(name) result(i)
      character(len=*), intent(in) :: name

      do i = 1, n_phases
         if (phases(i)%name == name) return
      end do
      i = 0
      if (n_phases == MOST_PHASES) return
      n_phases = n_phases + 1
      i = n_phases
      phases(i)%name = name
   end function find_phase

   subroutine read_clocks(wall, cpu)
      real(wp), intent(out) :: wall, cpu
      integer(lp) :: ticks, rate

      call system_clock(ticks, rate)
      wall = real(ticks, wp)/real(rate, wp)
      call cpu_time(cpu)
   end subroutine read_clocks

   !> Processor time of this process and of the workers that have ended [s]; 0 where the system does not tell.
   real(wp) function processor_seconds() result(seconds)
      integer(c_long) :: usage(RUSAGE_LENGTH)
      integer(c_int) :: who

      seconds = 0.0_wp
      do who = RUSAGE_CHILDREN, RUSAGE_SELF
         usage = 0
         if (c_getrusage(who, usage) /= 0_c_int) cycle
         seconds = seconds + real(usage(1) + usage(3), wp) + 1.0e-6_wp*real(usage(2) + usage(4), wp)
      end do
   end function processor_seconds

   !> Largest resident memory of the process so far [bytes]; 0 where the system does not tell.
   integer(lp) function peak_memory() result(bytes)
      integer(c_long) :: usage(RUSAGE_LENGTH)

      bytes = 0_lp
      usage = 0
      if (c_getrusage(RUSAGE_SELF, usage) == 0_c_int) bytes = int(usage(MAXRSS), lp)*1024_lp
   end function peak_memory

end module atrito_timers
