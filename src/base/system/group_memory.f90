!> The memory that the control groups of a process leave (Linux, versions 1 and 2): what a job of a batch system, a service or a
!> container may have. /proc/meminfo knows nothing of it, and the process that takes more is killed.
!>
!> A group lies in its parents, each of which may have a limit; it and all processes in it share what is left there. What files
!> in memory take is counted as used, though it is given back when it is wanted.
module atrito_group_memory
   use atrito_files, only: read_system_lines
   use atrito_kinds, only: ip, lp
   use atrito_strings, only: string_t
   use atrito_system_counts, only: count_of, UNLIMITED
   implicit none (type, external)
   private
   public :: group_memory_left

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

contains

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

end module atrito_group_memory
