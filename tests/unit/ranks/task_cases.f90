!> Tasks of which a unit test knows what comes out: squares; one of them ends its process.
module task_cases
   use atrito_kinds, only: ip
   use atrito_buffer, only: buffer_t, put, take
   use atrito_rank_tasks, only: rank_tasks_t
   use atrito_system, only: terminate
   implicit none (type, external)
   private
   public :: squares_t

   type, extends(rank_tasks_t) :: squares_t
      integer(ip) :: bad = 0                        !< the task that ends its process
      integer(ip) :: made = 0                       !< by this process so far
      integer(ip), allocatable :: begun(:)          !< in their order
      integer(ip), allocatable :: found(:)          !< of each task
      integer(ip), allocatable :: before(:)         !< how many the process had made before it
      integer, allocatable :: end_code(:)
   contains
      procedure :: make => square
      procedure :: begin => note
      procedure :: keep => keep_square
   end type squares_t

contains

   subroutine square(self, task, answer)
      class(squares_t), intent(inout) :: self
      integer(ip), intent(in) :: task
      type(buffer_t), intent(inout) :: answer

      if (task == self%bad) call terminate()
      call put(answer, [task*task, self%made])
      self%made = self%made + 1
   end subroutine square

   subroutine note(self, task)
      class(squares_t), intent(inout) :: self
      integer(ip), intent(in) :: task

      self%begun = [self%begun, task]
   end subroutine note

   subroutine keep_square(self, task, answer, end_code)
      class(squares_t), intent(inout) :: self
      integer(ip), intent(in) :: task
      type(buffer_t), intent(inout) :: answer
      integer, intent(in) :: end_code
      integer(ip), allocatable :: numbers(:)

      self%end_code(task) = end_code
      if (end_code /= 0) return
      call take(answer, numbers)
      self%found(task) = numbers(1)
      self%before(task) = numbers(2)
   end subroutine keep_square

end module task_cases
