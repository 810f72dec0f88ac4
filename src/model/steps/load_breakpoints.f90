!> The times of a step at which its loads can be the hardest to balance.
!>
!> The loads that contact can balance are a convex set: between two that can be balanced all can. So where loads go linearly from
!> one time to the next only these times need to be asked about: the end of a step, and the points of the amplitudes that it uses.
module atrito_load_breakpoints
   use atrito_amplitudes, only: time_before
   use atrito_kinds, only: ip, wp
   use atrito_model, only: amplitude_t, model_t
   implicit none (type, external)
   private
   public :: load_breakpoints

contains

   !> Ascending, the end of the step the last. A step of one increment has its end alone: nothing is solved before.
   pure function load_breakpoints(model, k) result(times)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: k                  !< the step
      real(wp), allocatable :: times(:)             !< of the step
      real(wp) :: began
      logical :: is_used(size(model%amplitudes))
      integer :: i

      associate (step => model%steps(k))
         times = [step%increments%period]
         if (step%increments%initial >= step%increments%period) return
         is_used = .false.
         call mark(step%node_loads%amplitude, is_used)
         call mark(step%element_loads%amplitude, is_used)
         if (.not. any(is_used)) return
         began = time_before(model%steps, k)
         call add_time(step%increments%initial, times)    ! loads may be there at once
         do i = 1, size(is_used)
            if (is_used(i)) call add_points(model%amplitudes(i), began, step%increments%initial, times)
         end do
      end associate
   end function load_breakpoints

   pure subroutine mark(amplitude, is_used)
      integer(ip), allocatable, intent(in) :: amplitude(:)
      logical, intent(inout) :: is_used(:)
      integer :: i

      if (.not. allocated(amplitude)) return
      do i = 1, size(amplitude)
         if (amplitude(i) > 0) is_used(amplitude(i)) = .true.
      end do
   end subroutine mark

   !> The points of a curve behind the first increment of the step.
   pure subroutine add_points(amplitude, began, first, times)
      type(amplitude_t), intent(in) :: amplitude
      real(wp), intent(in) :: began, first
      real(wp), allocatable, intent(inout) :: times(:)
      real(wp) :: time
      integer :: i

      do i = 1, size(amplitude%time)
         time = amplitude%time(i)
         if (amplitude%is_total_time) time = time - began
         if (time > first .and. time < times(size(times))) call add_time(time, times)
      end do
   end subroutine add_points

   !> Puts a time at its place, once.
   pure subroutine add_time(time, times)
      real(wp), intent(in) :: time
      real(wp), allocatable, intent(inout) :: times(:)

      if (any(abs(times - time) <= 0.0_wp)) return
      times = [pack(times, times < time), time, pack(times, times > time)]
   end subroutine add_time

end module atrito_load_breakpoints
