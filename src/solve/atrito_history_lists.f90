!> The growing lists of a history: they have room for more than there is, and are cut to their lengths in the end.
module atrito_history_lists
   use atrito_kinds, only: ip
   use atrito_results, only: history_row_t, history_t, iteration_t, results_t
   implicit none (type, external)
   private
   public :: add_row, add_iterations, add_frame, trim_lists

contains

   pure subroutine add_row(row, n, rows)
      type(history_row_t), intent(in) :: row
      integer(ip), intent(inout) :: n
      type(history_row_t), allocatable, intent(inout) :: rows(:)
      type(history_row_t), allocatable :: longer(:)

      if (n == size(rows)) then
         allocate (longer(2*n + 8))
         longer(:n) = rows
         call move_alloc(longer, rows)
      end if
      n = n + 1
      rows(n) = row
   end subroutine add_row

   pure subroutine add_iterations(new, n, iterations)
      type(iteration_t), intent(in) :: new(:)
      integer(ip), intent(inout) :: n
      type(iteration_t), allocatable, intent(inout) :: iterations(:)
      type(iteration_t), allocatable :: longer(:)

      if (n + size(new) > size(iterations)) then
         allocate (longer(2*n + size(new)))
         longer(:n) = iterations(:n)
         call move_alloc(longer, iterations)
      end if
      iterations(n + 1:n + size(new)) = new
      n = n + size(new, kind=ip)
   end subroutine add_iterations

   subroutine add_frame(frame, n, frames)
      type(results_t), intent(in) :: frame
      integer(ip), intent(inout) :: n
      type(results_t), allocatable, intent(inout) :: frames(:)
      type(results_t), allocatable :: longer(:)

      if (n == size(frames)) then
         allocate (longer(2*n + 1))
         longer(:n) = frames
         call move_alloc(longer, frames)
      end if
      n = n + 1
      frames(n) = frame
   end subroutine add_frame

   !> No room for more than there is.
   pure subroutine trim_lists(n_frames, n_rows, n_iterations, history)
      integer(ip), intent(in) :: n_frames, n_rows, n_iterations
      type(history_t), intent(inout) :: history

      if (size(history%frames) > n_frames) history%frames = history%frames(:n_frames)
      if (size(history%rows) > n_rows) history%rows = history%rows(:n_rows)
      if (size(history%iterations) > n_iterations) history%iterations = history%iterations(:n_iterations)
   end subroutine trim_lists

end module atrito_history_lists
