!> The increments of a history one by one, as history.tab, the listing and the screen tell of them.
module atrito_increments
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_results, only: history_t, iteration_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: increment_t, list_increments, has_history, increment_name, ending_text, time_text

   integer, parameter :: TIME_DIGITS = 10

   type :: increment_t
      integer(ip) :: step = 1, increment = 1       !< from 1; increments count within the step
      real(wp) :: time = 0.0_wp                    !< of the history
      integer(ip) :: outer = 0                     !< outer iterations; 0: none are known
      real(wp) :: residual = 0.0_wp                !< of the friction bounds at their end
   end type increment_t

contains

   !> All increments that converged, in the order of time; without contact, which history has rows of, those that are printed.
   pure function list_increments(history) result(list)
      type(history_t), intent(in) :: history !< with rows, or with frames alone
      type(increment_t), allocatable :: list(:)
      integer(ip) :: n, i
      logical :: has_rows

      has_rows = size(history%rows) > 0
      n = size(history%frames, kind=ip)
      if (has_rows) n = size(history%rows, kind=ip)
      allocate (list(n))
      do i = 1, n
         if (has_rows) then
            list(i) = increment_t(history%rows(i)%step, history%rows(i)%increment, history%rows(i)%time)
         else
            list(i) = increment_t(history%frames(i)%step, history%frames(i)%increment, history%frames(i)%time)
         end if
      end do
      ! Rows of one increment stand together: the first of them is kept.
      list = pack(list, [(.true., i=1, min(n, 1_ip)), &
                         list(2:)%step /= list(:n - 1)%step .or. list(2:)%increment /= list(:n - 1)%increment])
      call add_outcomes(history%iterations, list)
   end function list_increments

   !> The outcome of each increment is that of its last iteration.
   pure subroutine add_outcomes(iterations, list)
      type(iteration_t), intent(in) :: iterations(:)
      type(increment_t), intent(inout) :: list(:)
      integer(ip) :: i, k

      k = 1
      do i = 1, size(iterations, kind=ip)
         do while (k < size(list))
            if (list(k)%step > iterations(i)%step) exit
            if (list(k)%step == iterations(i)%step .and. list(k)%increment >= iterations(i)%increment) exit
            k = k + 1
         end do
         if (k > size(list)) return
         if (list(k)%step /= iterations(i)%step .or. list(k)%increment /= iterations(i)%increment) cycle
         list(k)%outer = iterations(i)%outer
         list(k)%residual = iterations(i)%residual
      end do
   end subroutine add_outcomes

   !> More than one increment, a deck of several steps, or an end before the end.
   pure logical function has_history(model, history)
      type(model_t), intent(in) :: model     !< its steps are counted
      type(history_t), intent(in) :: history !< with all frames

      has_history = size(model%steps) > 1 .or. size(history%frames) > 1 .or. history%ending%is_early
      if (.not. has_history) has_history = size(list_increments(history)) > 1
   end function has_history

   !> `step 2, increment 5, time 1.25`
   pure function increment_name(step, increment, time) result(text)
      integer(ip), intent(in) :: step, increment !< from 1; increments count within the step
      real(wp), intent(in) :: time               !< of the history
      character(len=:), allocatable :: text

      text = 'step '//to_text(step)//', increment '//to_text(increment)//', time '//time_text(time)
   end function increment_name

   !> A time for readers, in so many digits that increments differ.
   pure function time_text(time) result(text)
      real(wp), intent(in) :: time !< of the history
      character(len=:), allocatable :: text

      text = to_text(time, TIME_DIGITS)
   end function time_text

   !> `ended in step 2, increment 5, time 1.25: reason`, in one line; '' where the history did not end early.
   pure function ending_text(history) result(text)
      type(history_t), intent(in) :: history !< its ending is read
      character(len=:), allocatable :: text
      integer :: i

      text = ''
      if (.not. history%ending%is_early) return
      associate (ending => history%ending)
         text = 'ended in '//increment_name(ending%step, ending%increment, ending%time)
         if (allocated(ending%reason)) text = text//': '//ending%reason
      end associate
      do i = 1, len(text)
         if (text(i:i) < ' ') text(i:i) = ' '       ! the first line of a table is one line
      end do
   end function ending_text

end module atrito_increments
