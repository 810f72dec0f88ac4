!> How much memory the machine has to give, so that a scene that needs more is refused before it is allocated: Linux promises
!> more than it has, and ends the program when the promise is called in.
!>
!> The memory that the control groups of a process leave (Linux, versions 1 and 2): what a job of a batch system, a service or a
!> container may have. /proc/meminfo knows nothing of it, and the process that takes more is killed.
!>
!> A group lies in its parents, each of which may have a limit; it and all processes in it share what is left there. What files
!> in memory take is counted as used, though it is given back when it is wanted.
module atrito_memory
   use atrito_files, only: read_system_lines, read_system_line
   use atrito_kinds, only: ip, lp, wp
   use atrito_strings, only: to_text, string_t
   use atrito_system, only: address_space_limit, reusable_memory
   implicit none (type, external)
   private
   public :: available_memory, address_space_left, shared_memory_left, resident_memory, held_memory, memory_text, group_memory_left

   integer(lp), parameter :: KIB = 1024_lp
   !> Share of the memory that was given back before that will be taken again: the rest lies in pieces between what is held.
   real(wp), parameter :: SERVES_AGAIN = 0.5_wp

   !> Where a version keeps its groups, and how it names what they tell.
   type :: version_t
      character(len=24) :: folder                  !< where its groups are folders
      character(len=24) :: limit, used             !< files
      character(len=24) :: files_in_memory(2)      !< labels in memory.stat
   end type version_t

   type(version_t), parameter :: VERSION_1 = version_t('/sys/fs/cgroup/memory', 'memory.limit_in_bytes', &
                                         'memory.usage_in_bytes', [character(len=24) :: 'total_active_file', 'total_inactive_file'])
   type(version_t), parameter :: VERSION_2 = version_t('/sys/fs/cgroup', 'memory.max', 'memory.current', &
                                                       [character(len=24) :: 'active_file', 'inactive_file'])

   !> What is said where the system does not tell, or sets no limit.
   integer(lp), parameter :: UNLIMITED = huge(1_lp)

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

   !> Bytes that the process can still get before a control group is full, or the most that matter.
   integer(lp) function group_memory_left(root, most) result(bytes)
      character(len=*), intent(in) :: root             !< folder in which /proc and /sys are; '' of the machine
      integer(lp), intent(in) :: most                  !< what else there is
      type(string_t), allocatable :: groups(:)

      call read_system_lines(root//'/proc/self/cgroup', groups)
      bytes = most
      call look_along(root, VERSION_2, group_of(groups, ''), bytes)
      call look_along(root, VERSION_1, group_of(groups, 'memory'), bytes)
   end function group_memory_left

   !> Takes the least that a group and its parents leave. Of a group that lies outside the container only the parents are seen.
   subroutine look_along(root, version, group, bytes)
      character(len=*), intent(in) :: root
      type(version_t), intent(in) :: version
      character(len=*), intent(in) :: group            !< '/job/step'
      integer(lp), intent(inout) :: bytes
      integer :: last

      last = len(group)
      do while (last > 0)
         call look_into(root//trim(version%folder)//group(:last), version, bytes)
         last = index(group(:last), '/', back=.true.) - 1
      end do
      call look_into(root//trim(version%folder), version, bytes)
   end subroutine look_along

   !> Takes what one group leaves where that is less. What its files take is asked only where it matters.
   subroutine look_into(folder, version, bytes)
      character(len=*), intent(in) :: folder
      type(version_t), intent(in) :: version
      integer(lp), intent(inout) :: bytes
      integer(lp) :: limit, used
      integer(ip) :: i

      limit = count_of(folder//'/'//trim(version%limit), '', 1_lp)
      if (limit == UNLIMITED) return
      used = known(count_of(folder//'/'//trim(version%used), '', 1_lp))
      if (limit - used >= bytes) return
      do i = 1, size(version%files_in_memory, kind=ip)
         used = used - known(count_of(folder//'/memory.stat', trim(version%files_in_memory(i))//' ', 1_lp))
      end do
      bytes = min(bytes, max(0_lp, limit - max(0_lp, used)))
   end subroutine look_into

   !> 0 where the system does not tell.
   pure integer(lp) function known(count)
      integer(lp), intent(in) :: count

      known = merge(0_lp, count, count == UNLIMITED)
   end function known

   !> '/job/step' of a line '4:cpu,memory:/job/step', which names the controllers of the group; '' for the root, and where no
   !> line has the controller. Groups of version 2 name none.
   pure function group_of(lines, controller) result(group)
      type(string_t), intent(in) :: lines(:)           !< of /proc/self/cgroup
      character(len=*), intent(in) :: controller
      character(len=:), allocatable :: group
      integer :: first, second
      integer(ip) :: i

      group = ''
      do i = 1, size(lines, kind=ip)
         associate (line => lines(i)%s)
            first = index(line, ':')
            second = first + index(line(first + 1:), ':')
            if (index(','//line(first + 1:second - 1)//',', ','//controller//',') == 0) cycle
            group = line(second + 1:)
         end associate
         if (group == '/') group = ''
         return
      end do
   end function group_of

   !> The number that follows a label at the beginning of a line of a file; UNLIMITED where there is none.
   integer(lp) function count_of(path, label, unit) result(bytes)
      character(len=*), intent(in) :: path, label      !< of the file; with which the line begins
      integer(lp), intent(in) :: unit                  !< bytes
      character(len=:), allocatable :: line
      character(len=*), parameter :: BLANKS = ' '//achar(9)  ! a tab follows the labels of /proc/self/status
      logical :: found

      bytes = UNLIMITED
      call read_system_line(path, label, line, found)
      if (.not. found) return
      line = line(len(label) + 1:)
      line = line(max(verify(line, BLANKS), 1):)
      if (verify(line(:min(1, len(line))), '0123456789') > 0 .or. len(line) == 0) return
      bytes = unit*leading_number(line)
   end function count_of

   !> The number that a text begins with; 0 where it does not.
   pure integer(lp) function leading_number(text) result(number)
      character(len=*), intent(in) :: text
      integer :: i, d

      number = 0_lp
      do i = 1, min(len(text), 15)
         d = iachar(text(i:i)) - iachar('0')
         if (d < 0 .or. d > 9) exit
         number = 10_lp*number + int(d, lp)
      end do
   end function leading_number

end module atrito_memory
