!> Wall and processor time by phase.
module atrito_timers
   use atrito_kinds, only: lp, wp
   implicit none (type, external)
   private
   public :: phase_time_t, start_phase, stop_phase, get_phases, reset_timers

   type :: phase_time_t
      character(len=16) :: name = '' !< e.g. 'factor'
      real(wp) :: wall = 0.0_wp      !< seconds
      real(wp) :: cpu = 0.0_wp       !< seconds, all threads
      logical :: running = .false.   !< its clock goes
   end type phase_time_t

   integer, parameter :: MOST_PHASES = 32
   type(phase_time_t) :: phases(MOST_PHASES)
   real(wp) :: wall_at_start(MOST_PHASES) = 0.0_wp, cpu_at_start(MOST_PHASES) = 0.0_wp
   integer :: n_phases = 0

contains

   !> Starts, or goes on with, the clock of a phase.
   subroutine start_phase(name)
      character(len=*), intent(in) :: name !< up to 16 letters, without blanks at the end
      integer :: i

      i = find_phase(name)
      if (i == 0) return
      phases(i)%running = .true.
      call read_clocks(wall_at_start(i), cpu_at_start(i))
   end subroutine start_phase

   !> Stops the clock of a phase.
   subroutine stop_phase(name)
      character(len=*), intent(in) :: name !< of start_phase; others are passed over
      real(wp) :: wall, cpu
      integer :: i

      i = find_phase(name)
      if (i == 0) return
      if (.not. phases(i)%running) return
      call read_clocks(wall, cpu)
      phases(i)%wall = phases(i)%wall + (wall - wall_at_start(i))
      phases(i)%cpu = phases(i)%cpu + (cpu - cpu_at_start(i))     ! a sum never falls, by rounding neither
      phases(i)%running = .false.
   end subroutine stop_phase

   !> The phases in the order in which they first began.
   function get_phases() result(list)
      type(phase_time_t), allocatable :: list(:)

      list = phases(:n_phases)
   end function get_phases

   !> Forgets all phases and their times.
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

end module atrito_timers
