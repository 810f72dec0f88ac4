!> How long the increments of a step are: cut where there is no solution, and longer again afterwards.
module atrito_increment_length
   use atrito_kinds, only: ip, wp
   use atrito_model, only: increments_t
   implicit none (type, external)
   private
   public :: progress_t, next_time, cut_increment, lengthen, is_longer_than_least

   real(wp), parameter :: CUT = 0.5_wp, RECOVER = 2.0_wp, GROW = 1.5_wp !< lengths after a failure, and after a success
   real(wp), parameter :: SLIVER = 1.0e-6_wp       !< of an increment: what is left of a step by round-off

   !> Where a step is.
   type :: progress_t
      integer(ip) :: increment = 0                  !< that is tried, or was last
      real(wp) :: time = 0.0_wp                     !< of the step, that it has come to
      real(wp) :: length = 0.0_wp                   !< of the next increment
      integer(ip) :: cuts = 0                       !< of the increment that is tried
   end type progress_t

contains

   !> The end of the next increment. What round-off would leave of the step goes with it.
   pure real(wp) function next_time(now, period) result(to)
      type(progress_t), intent(in) :: now !< time and length are read
      real(wp), intent(in) :: period      !< of the step

      to = now%time + now%length
      if (period - to <= SLIVER*now%length) to = period
   end function next_time

   !> The increment that was tried is tried again, shorter.
   pure subroutine cut_increment(control, now)
      type(increments_t), intent(in) :: control !< least length
      type(progress_t), intent(inout) :: now    !< gets another length; its increment is taken back

      now%length = max(CUT*now%length, control%least)
      now%cuts = now%cuts + 1
      now%increment = now%increment - 1
   end subroutine cut_increment

   !> The length after a success: back to what it was before it was cut; beyond it where the deck lets it grow.
   pure subroutine lengthen(control, now)
      type(increments_t), intent(in) :: control !< initial and greatest length
      type(progress_t), intent(inout) :: now    !< gets another length, no cuts

      now%cuts = 0
      if (now%length < control%initial) then
         now%length = min(RECOVER*now%length, control%initial)
      else
         now%length = max(min(GROW*now%length, control%greatest), control%initial)
      end if
   end subroutine lengthen

   !> But for round-off.
   pure logical function is_longer_than_least(control, length)
      type(increments_t), intent(in) :: control !< least length
      real(wp), intent(in) :: length            !< of an increment

      is_longer_than_least = length > (1.0_wp + SLIVER)*control%least
   end function is_longer_than_least

end module atrito_increment_length
