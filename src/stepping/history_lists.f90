!> The growing lists of a history: they have room for more than there is, and are cut to their lengths in the end.
module atrito_history_lists
   use atrito_growth, only: make_room, resize
   use atrito_kinds, only: ip
   use atrito_results, only: history_row_t, history_t, iteration_t, observed_list_t, put_aside, results_t
   implicit none (type, external)
   private
   public :: add_row, add_iterations, add_observed, add_frame, move_frame, trim_lists

contains

   !> Adds a row of history.tab; the list doubles where it is full, so it may have more room than n.
   pure subroutine add_row(row, n, rows)
      type(history_row_t), intent(in) :: row                     !< copied
      integer(ip), intent(inout) :: n                            !< rows in use; one more afterwards
      type(history_row_t), allocatable, intent(inout) :: rows(:) !< (n or more)
      type(history_row_t), allocatable :: longer(:)

      if (n == size(rows)) then
         allocate (longer(2*n + 8))
         longer(:n) = rows
         call move_alloc(longer, rows)
      end if
      n = n + 1
      rows(n) = row
   end subroutine add_row

   !> Adds the log of an increment behind those before; the list may have more room than n.
   pure subroutine add_iterations(new, n, iterations)
      type(iteration_t), intent(in) :: new(:)                        !< of one increment
      integer(ip), intent(inout) :: n                                !< iterations in use; as many more afterwards
      type(iteration_t), allocatable, intent(inout) :: iterations(:) !< (n or more)
      type(iteration_t), allocatable :: longer(:)

      if (n + size(new) > size(iterations)) then
         allocate (longer(2*n + size(new)))
         longer(:n) = iterations(:n)
         call move_alloc(longer, iterations)
      end if
      iterations(n + 1:n + size(new)) = new
      n = n + size(new, kind=ip)
   end subroutine add_iterations

   !> What was observed in an increment.
   pure subroutine add_observed(results, list)
      type(results_t), intent(in) :: results       !< of one increment; `observed` is allocated
      type(observed_list_t), intent(inout) :: list !< gets one increment more
      integer(ip) :: n

      n = list%n + 1
      call make_room(list%step, list%n, n)
      call make_room(list%increment, list%n, n)
      call make_room(list%time, list%n, n)
      if (.not. allocated(list%values)) allocate (list%values(size(results%observed), size(list%step)))
      if (size(list%values, 2) < n) call resize(list%values, list%n, size(list%step, kind=ip))
      list%n = n
      list%step(n) = results%step
      list%increment(n) = results%increment
      list%time(n) = results%time
      list%values(:, n) = results%observed%value
   end subroutine add_observed

   !> The frame before it goes to the store, where there is one.
   subroutine add_frame(frame, n, history)
      type(results_t), intent(in) :: frame      !< copied
      integer(ip), intent(inout) :: n           !< frames in use; one more afterwards
      type(history_t), intent(inout) :: history !< its list of frames has room for n or more

      if (n > 0) call put_aside(n, history)
      if (n == size(history%frames)) call give_room(n, n + n/4 + 1, history%frames) ! even without fields they are large
      n = n + 1
      history%frames(n) = frame
   end subroutine add_frame

   !> Room for so many frames; the first n stay.
   pure subroutine give_room(n, room, frames)
      integer(ip), intent(in) :: n, room
      type(results_t), allocatable, intent(inout) :: frames(:)
      type(results_t), allocatable :: others(:)
      integer(ip) :: i

      allocate (others(room))
      do i = 1, n
         call move_frame(frames(i), others(i))
      end do
      call move_alloc(others, frames)
   end subroutine give_room

   !> Results go to another place; what is large is not copied.
   pure subroutine move_frame(from, to)
      type(results_t), intent(inout) :: from !< without its large fields afterwards
      type(results_t), intent(inout) :: to   !< what it held is lost
      type(results_t) :: large

      call move_large(from, large)
      to = from
      call move_large(large, to)
   end subroutine move_frame

   pure subroutine move_large(from, to)
      type(results_t), intent(inout) :: from, to

      call move_alloc(from%u, to%u)
      call move_alloc(from%prescribed, to%prescribed)
      call move_alloc(from%reaction, to%reaction)
      call move_alloc(from%contact, to%contact)
      call move_alloc(from%stress_element, to%stress_element)
      call move_alloc(from%stress_point, to%stress_point)
      call move_alloc(from%stress_x, to%stress_x)
      call move_alloc(from%stress, to%stress)
      call move_alloc(from%nodal_stress, to%nodal_stress)
      call move_alloc(from%element_error, to%element_error)
      call move_alloc(from%iterations, to%iterations)
   end subroutine move_large

   !> No room for more than there is.
   pure subroutine trim_lists(n_frames, n_rows, n_iterations, history)
      integer(ip), intent(in) :: n_frames, n_rows, n_iterations !< that are in use
      type(history_t), intent(inout) :: history                 !< its lists get these lengths

      if (size(history%frames) > n_frames) call give_room(n_frames, n_frames, history%frames)
      if (size(history%rows) > n_rows) history%rows = history%rows(:n_rows)
      if (size(history%iterations) > n_iterations) history%iterations = history%iterations(:n_iterations)
      associate (list => history%observed)
         if (list%n == 0) return
         if (size(list%step) == list%n) return
         call resize(list%step, list%n, list%n)
         call resize(list%increment, list%n, list%n)
         call resize(list%time, list%n, list%n)
         call resize(list%values, list%n, list%n)
      end associate
   end subroutine trim_lists

end module atrito_history_lists
