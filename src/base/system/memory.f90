!> How much memory the machine has to give, so that a scene that needs more is refused before it is allocated: Linux promises
!> more than it has, and ends the program when the promise is called in.
module atrito_memory
   use atrito_group_memory, only: group_memory_left
   use atrito_kinds, only: ip, lp, wp
   use atrito_strings, only: to_text
   use atrito_system, only: address_space_limit, reusable_memory
   use atrito_system_counts, only: count_of, UNLIMITED
   implicit none (type, external)
   private
   public :: available_memory, address_space_left, shared_memory_left, resident_memory, held_memory, memory_text

   integer(lp), parameter :: KIB = 1024_lp
   !> Share of the memory that was given back before that will be taken again: the rest lies in pieces between what is held.
   real(wp), parameter :: SERVES_AGAIN = 0.5_wp

contains

   !> Memory that the program can still get [bytes]: the least of what is free (swap left out), what `ulimit -v` leaves and what
   !> the job or the container allows. A very large number where the system does not tell.
   integer(lp) function available_memory() result(bytes)
      bytes = min(shared_memory_left(), address_space_left())
   end function available_memory

   !> The same of all processes of the machine, job or container together [bytes].
   integer(lp) function shared_memory_left() result(bytes)
      bytes = group_memory_left('', count_of('/proc/meminfo', 'MemAvailable:', KIB))
   end function shared_memory_left

   !> Memory that the process holds now [bytes], libraries included; 0 where the system does not tell.
   integer(lp) function resident_memory() result(bytes)
      bytes = count_of('/proc/self/status', 'VmRSS:', KIB)
      if (bytes == UNLIMITED) bytes = 0_lp
   end function resident_memory

   !> The same without what was given back and serves again [bytes].
   integer(lp) function held_memory() result(bytes)
      bytes = resident_memory() - int(SERVES_AGAIN*real(reusable_memory(), wp), lp)
   end function held_memory

   !> Address space below the limit that `ulimit -v` sets [bytes].
   integer(lp) function address_space_left() result(bytes)
      integer(lp) :: limit, used

      bytes = UNLIMITED
      limit = address_space_limit()
      if (limit < 0_lp) return
      used = count_of('/proc/self/status', 'VmSize:', KIB)
      if (used == UNLIMITED) used = 0_lp
      bytes = max(0_lp, limit - used)
   end function address_space_left

   !> '1.5 GiB'
   pure function memory_text(bytes) result(text)
      integer(lp), intent(in) :: bytes !< >= 0
      character(len=:), allocatable :: text
      character(len=3), parameter :: NAMES(5) = ['B  ', 'KiB', 'MiB', 'GiB', 'TiB']
      real(wp) :: x
      integer(ip) :: i

      x = real(bytes, wp)
      do i = 1, size(NAMES, kind=ip) - 1
         if (x < real(KIB, wp)) exit
         x = x/real(KIB, wp)
      end do
      text = to_text(x, 4)//' '//trim(NAMES(i))
   end function memory_text

end module atrito_memory
