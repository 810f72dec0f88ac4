!> Curves over time that multiply loads and displacements, and the times of the steps of a history.
module atrito_amplitudes
   use atrito_kinds, only: ip, wp
   use atrito_model, only: amplitude_t, model_t, step_t
   implicit none (type, external)
   private
   public :: amplitude_at, factor_at, load_breakpoints, time_before

contains

   !> What an amplitude multiplies by. Between two times the value goes linearly, or as s^3 (10 - 15 s + 6 s^2) with s from 0 to 1,
   !> whose first and second derivatives are 0 at both; before the first time and after the last it stays.
   pure real(wp) function amplitude_at(amplitude, time) result(value)
      type(amplitude_t), intent(in) :: amplitude       !< one time at least
      real(wp), intent(in) :: time                     !< of the step, or of the history where the amplitude has total times
      real(wp) :: s
      integer(ip) :: k, n, high, middle

      n = size(amplitude%time, kind=ip)
      ! The last of ascending times that is not later; 0: all are.
      k = 0
      high = size(amplitude%time, kind=ip) + 1
      do while (high - k > 1)
         middle = (k + high)/2
         if (amplitude%time(middle) <= time) then
            k = middle
         else
            high = middle
         end if
      end do
      if (k == 0) then
         value = amplitude%value(1)
      else if (k == n) then
         value = amplitude%value(n)
      else
         s = (time - amplitude%time(k))/(amplitude%time(k + 1) - amplitude%time(k))
         if (amplitude%is_smooth) s = s**3*(10.0_wp + s*(6.0_wp*s - 15.0_wp))
         value = amplitude%value(k) + s*(amplitude%value(k + 1) - amplitude%value(k))
      end if
   end function amplitude_at

   !> What the place of an amplitude stands for at a time of a step; 1 for place 0.
   pure real(wp) function factor_at(amplitudes, place, step_time, total_time) result(factor)
      type(amplitude_t), intent(in) :: amplitudes(:)   !< of the model
      integer(ip), intent(in) :: place                 !< 0: no amplitude
      real(wp), intent(in) :: step_time, total_time    !< since the beginning of the step, and of the history

      factor = 1.0_wp
      if (place == 0) return
      factor = amplitude_at(amplitudes(place), merge(total_time, step_time, amplitudes(place)%is_total_time))
   end function factor_at

   !> The time of the history at which a step begins; one behind the last one, too.
   pure real(wp) function time_before(steps, k) result(time)
      type(step_t), intent(in) :: steps(:)          !< of the model; those before k have their times
      integer(ip), intent(in) :: k                  !< 1..steps + 1

      time = 0.0_wp
      if (k > 1) time = steps(k - 1)%began + steps(k - 1)%increments%period
   end function time_before

   !> The times of a step at which its loads can be the hardest to balance, ascending, the end of the step the last. A step of one
   !> increment has its end alone: nothing is solved before.
   !>
   !> The loads that contact can balance are a convex set: between two that can be balanced all can. So where loads go linearly
   !> from one time to the next only these times need to be asked about: the end of a step, and the points of the amplitudes that
   !> it uses.
   pure function load_breakpoints(model, k) result(times)
      type(model_t), intent(in) :: model            !< its steps and amplitudes are read
      integer(ip), intent(in) :: k                  !< the step
      real(wp), allocatable :: times(:)             !< of the step
      real(wp) :: began, time
      logical :: is_used(size(model%amplitudes))
      integer :: i, j

      associate (step => model%steps(k))
         times = [step%increments%period]
         if (step%increments%initial >= step%increments%period) return
         is_used = .false.
         do i = 1, size(is_used)
            if (allocated(step%node_loads%amplitude)) is_used(i) = any(step%node_loads%amplitude == i)
            if (allocated(step%element_loads%amplitude)) is_used(i) = is_used(i) .or. any(step%element_loads%amplitude == i)
         end do
         if (.not. any(is_used)) return
         call add_time(step%increments%initial, times)    ! loads may be there at once
         do i = 1, size(is_used)
            if (.not. is_used(i)) cycle
            began = 0.0_wp
            if (model%amplitudes(i)%is_total_time) began = time_before(model%steps, k)
            do j = 1, size(model%amplitudes(i)%time)
               time = model%amplitudes(i)%time(j) - began
               if (time > step%increments%initial .and. time < times(size(times))) call add_time(time, times)
            end do
         end do
      end associate
   end function load_breakpoints

   !> Puts a time at its place, once.
   pure subroutine add_time(time, times)
      real(wp), intent(in) :: time
      real(wp), allocatable, intent(inout) :: times(:)

      if (any(abs(times - time) <= 0.0_wp)) return
      times = [pack(times, times < time), time, pack(times, times > time)]
   end subroutine add_time

end module atrito_amplitudes
