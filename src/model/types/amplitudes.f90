!> Curves over time that multiply loads and displacements, and the times of the steps of a history.
module atrito_amplitudes
   use atrito_kinds, only: ip, wp
   use atrito_model, only: amplitude_t, step_t
   implicit none (type, external)
   private
   public :: amplitude_at, factor_at, time_before

contains

   !> What an amplitude multiplies by. Between two times the value goes linearly, or as s^3 (10 - 15 s + 6 s^2) with s from 0 to 1,
   !> whose first and second derivatives are 0 at both; before the first time and after the last it stays.
   pure real(wp) function amplitude_at(amplitude, time) result(value)
      type(amplitude_t), intent(in) :: amplitude
      real(wp), intent(in) :: time                     !< of the step, or of the history where the amplitude has total times
      real(wp) :: s
      integer(ip) :: k, n

      n = size(amplitude%time, kind=ip)
      k = last_before(amplitude%time, time)
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

   !> The last of ascending times that is not later; 0: all are.
   pure integer(ip) function last_before(times, time) result(low)
      real(wp), intent(in) :: times(:), time
      integer(ip) :: high, middle

      low = 0
      high = size(times, kind=ip) + 1
      do while (high - low > 1)
         middle = (low + high)/2
         if (times(middle) <= time) then
            low = middle
         else
            high = middle
         end if
      end do
   end function last_before

   !> What the place of an amplitude stands for at a time of a step; 1 for place 0.
   pure real(wp) function factor_at(amplitudes, place, step_time, total_time) result(factor)
      type(amplitude_t), intent(in) :: amplitudes(:)
      integer(ip), intent(in) :: place
      real(wp), intent(in) :: step_time, total_time    !< since the beginning of the step, and of the history

      factor = 1.0_wp
      if (place == 0) return
      factor = amplitude_at(amplitudes(place), merge(total_time, step_time, amplitudes(place)%is_total_time))
   end function factor_at

   !> The time of the history at which a step begins; one behind the last one, too.
   pure real(wp) function time_before(steps, k) result(time)
      type(step_t), intent(in) :: steps(:)
      integer(ip), intent(in) :: k

      time = 0.0_wp
      if (k > 1) time = steps(k - 1)%began + steps(k - 1)%increments%period
   end function time_before

end module atrito_amplitudes
