!> What acts at a time of a step: the values that the loads, the prescribed displacements and the temperatures have come to.
!>
!> Without an amplitude a value goes linearly from that of the beginning of the step to that of its end, which it has to the last
!> digit when the time has come; with one it is multiplied by it. A hydrostatic pressure whose level changes is the sum of two,
!> one that goes and one that comes: what it does is linear in the pressure, and not in the level.
!>
!> Besides, the curves over time themselves (amplitude_t), and the times of the steps of a history.
module atrito_step_loads
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: amplitude_of, scaled
   use atrito_model, only: element_load_t, model_t, nodal_values_t, step_t, LOAD_HYDROSTATIC, amplitude_t
   implicit none (type, external)
   private
   public :: moment_t, is_end, share_at, act_at, list_bases, base_of, base_factors, BASE_BEGIN, BASE_END, amplitude_at, factor_at, &
             load_breakpoints, time_before

   !> What acts is a sum of bases: what is there at the beginning of the step, at its end, and what each amplitude (> 0) multiplies.
   integer(ip), parameter :: BASE_BEGIN = -1, BASE_END = 0

   !> A time of a history.
   type :: moment_t
      real(wp) :: step_time = 1.0_wp                !< since the step began
      real(wp) :: time = 1.0_wp                     !< since the history began
   end type moment_t

contains

   !> Whether every value is that of the end of the step, as the step has it.
   pure logical function is_end(step, moment)
      type(step_t), intent(in) :: step              !< as the deck has it
      type(moment_t), intent(in) :: moment          !< a time of the step

      is_end = (moment%step_time >= step%increments%period .or. step%at_once) &
               .and. .not. (follows(step%prescribed%amplitude) .or. follows(step%node_loads%amplitude) &
                            .or. follows(step%element_loads%amplitude) &
                            .or. follows(step%rigid_prescribed%amplitude) .or. follows(step%rigid_loads%amplitude))
   end function is_end

   pure logical function follows(amplitude)
      integer(ip), allocatable, intent(in) :: amplitude(:)

      follows = .false.
      if (allocated(amplitude)) follows = any(amplitude > 0)
   end function follows

   !> The share of the way from the beginning of the step to its end.
   pure real(wp) function share_at(step, moment) result(share)
      type(step_t), intent(in) :: step              !< its period and at_once are read
      type(moment_t), intent(in) :: moment          !< a time of the step

      share = 1.0_wp
      if (.not. step%at_once .and. moment%step_time < step%increments%period) share = moment%step_time/step%increments%period
   end function share_at

   !> The loads, displacements and temperatures of a step at a time of it, as those of a step that ends there.
   pure subroutine act_at(model, step, moment, now)
      type(model_t), intent(in) :: model            !< its amplitudes are read
      type(step_t), intent(in) :: step              !< one of the model's
      type(moment_t), intent(in) :: moment          !< a time of the step
      type(step_t), intent(out) :: now              !< with nothing else of the step
      real(wp), allocatable :: factor(:)            ! of each amplitude
      real(wp) :: share
      integer :: a

      share = share_at(step, moment)
      factor = [real(wp) ::]
      if (allocated(model%amplitudes)) then
         factor = [(factor_at(model%amplitudes, int(a, ip), moment%step_time, moment%time), a=1, size(model%amplitudes))]
      end if
      call values_at(step%prescribed, now%prescribed)
      call values_at(step%node_loads, now%node_loads)
      call values_at(step%rigid_prescribed, now%rigid_prescribed)
      call values_at(step%rigid_loads, now%rigid_loads)
      call element_loads_at(step%element_loads, now%element_loads)
      if (.not. allocated(step%heating)) return
      now%heating = step%heating
      if (share == 1.0_wp) return
      now%heating = share*step%heating
      if (allocated(step%heating_from)) now%heating = between(step%heating_from, step%heating, share)

   contains

      pure subroutine values_at(values, now)
         type(nodal_values_t), intent(in) :: values
         type(nodal_values_t), intent(out) :: now
         real(wp) :: from
         integer(ip) :: i, a

         call take_values(values, now)
         from = 0.0_wp
         do i = 1, values%n
            a = amplitude_of(values%amplitude, i)
            if (a > 0) then
               now%value(i) = values%value(i)*factor(a)
            else
               if (allocated(values%from)) from = values%from(i)
               now%value(i) = between(from, values%value(i), share)
            end if
         end do
      end subroutine values_at

      pure subroutine element_loads_at(loads, now)
         type(element_load_t), intent(in) :: loads
         type(element_load_t), intent(out) :: now
         real(wp) :: from(3)
         integer(ip) :: i, a

         if (loads%n == 0) return
         call take_loads(loads, loads%value, [(i, i=1, loads%n)], now)
         from = 0.0_wp
         do i = 1, loads%n
            a = amplitude_of(loads%amplitude, i)
            associate (value => now%value(:, i), kind => loads%kind(i))
               if (a > 0) then
                  value = scaled(kind, value, factor(a))
               else if (kind == LOAD_HYDROSTATIC) then
                  value = scaled(kind, value, share)
               else
                  if (allocated(loads%from)) from = loads%from(:, i)
                  value = between(from, value, share)
               end if
            end associate
         end do
         if (share < 1.0_wp .and. allocated(loads%from)) call add_levels_that_go(loads, share, now)
      end subroutine element_loads_at
   end subroutine act_at

   pure elemental real(wp) function between(from, to, share)
      real(wp), intent(in) :: from, to, share

      between = to
      if (share < 1.0_wp) between = from + share*(to - from)
   end function between

   !> The values of the end of a step alone.
   pure subroutine take_values(values, now)
      type(nodal_values_t), intent(in) :: values
      type(nodal_values_t), intent(out) :: now

      now%n = values%n
      if (values%n == 0) return
      now%node = values%node
      now%dof = values%dof
      now%value = values%value
      if (allocated(values%source)) now%source = values%source
   end subroutine take_values

   !> Some loads, with their values.
   pure subroutine take_loads(loads, value, wanted, now)
      type(element_load_t), intent(in) :: loads
      real(wp), intent(in) :: value(:, :)           !< of all loads
      integer(ip), intent(in) :: wanted(:)
      type(element_load_t), intent(out) :: now

      now%n = size(wanted, kind=ip)
      now%element = loads%element(wanted)
      now%kind = loads%kind(wanted)
      now%face = loads%face(wanted)
      if (allocated(loads%source)) now%source = loads%source(wanted)
      now%value = value(:, wanted)
   end subroutine take_loads

   !> Adds what is left of the hydrostatic pressures of the beginning.
   pure subroutine add_levels_that_go(loads, share, now)
      type(element_load_t), intent(in) :: loads
      real(wp), intent(in) :: share
      type(element_load_t), intent(inout) :: now
      type(element_load_t) :: own, going
      integer(ip), allocatable :: wanted(:)
      integer(ip) :: i

      wanted = pack([(i, i=1, loads%n)], [(loads%kind(i) == LOAD_HYDROSTATIC .and. amplitude_of(loads%amplitude, i) == 0 &
                                           .and. loads%from(1, i) /= 0.0_wp, i=1, loads%n)])
      if (size(wanted) == 0) return
      call take_loads(loads, loads%from, wanted, going)
      going%value(1, :) = (1.0_wp - share)*going%value(1, :)
      own = now
      now%n = own%n + going%n
      now%element = [own%element, going%element]
      now%kind = [own%kind, going%kind]
      now%face = [own%face, going%face]
      if (allocated(own%source)) now%source = [own%source, going%source]
      now%value = reshape([own%value, going%value], [size(own%value, 1), int(now%n)])
   end subroutine add_levels_that_go

   !> The bases of which there is something at some time of the step.
   pure function list_bases(step) result(bases)
      type(step_t), intent(in) :: step              !< one of the model's
      integer(ip), allocatable :: bases(:)

      bases = [BASE_END]
      if (.not. step%at_once) bases = [BASE_BEGIN, BASE_END]
      call add_amplitudes(step%prescribed%amplitude, bases)
      call add_amplitudes(step%node_loads%amplitude, bases)
      call add_amplitudes(step%element_loads%amplitude, bases)
   end function list_bases

   pure subroutine add_amplitudes(amplitude, bases)
      integer(ip), allocatable, intent(in) :: amplitude(:)
      integer(ip), allocatable, intent(inout) :: bases(:)
      integer(ip) :: i

      if (.not. allocated(amplitude)) return
      do i = 1, size(amplitude, kind=ip)
         if (amplitude(i) > 0 .and. .not. any(bases == amplitude(i))) bases = [bases, amplitude(i)]
      end do
   end subroutine add_amplitudes

   !> How much of each base there is at a time; at the end of the step, 1 of BASE_END and nothing of BASE_BEGIN.
   pure function base_factors(model, step, bases, moment) result(factor)
      type(model_t), intent(in) :: model            !< its amplitudes are read
      type(step_t), intent(in) :: step              !< one of the model's
      integer(ip), intent(in) :: bases(:)           !< BASE_*, or places in model%amplitudes
      type(moment_t), intent(in) :: moment          !< a time of the step
      real(wp) :: factor(size(bases))
      integer(ip) :: i

      do i = 1, size(bases, kind=ip)
         select case (bases(i))
         case (BASE_BEGIN)
            factor(i) = 1.0_wp - share_at(step, moment)
         case (BASE_END)
            factor(i) = share_at(step, moment)
         case default
            factor(i) = factor_at(model%amplitudes, bases(i), moment%step_time, moment%time)
         end select
      end do
   end function base_factors

   !> What acts of a base alone, as a step that ends with it: the same dofs are held.
   pure subroutine base_of(step, base, now)
      type(step_t), intent(in) :: step              !< one of the model's
      integer(ip), intent(in) :: base               !< BASE_*, or place in model%amplitudes
      type(step_t), intent(out) :: now              !< with nothing else of the step
      integer(ip) :: i

      call values_of_base(step%prescribed, base, now%prescribed)
      call values_of_base(step%node_loads, base, now%node_loads)
      associate (loads => step%element_loads)
         if (loads%n > 0) then
            call take_loads(loads, loads%value, [(i, i=1, loads%n)], now%element_loads)
            do i = 1, loads%n
               associate (value => now%element_loads%value(:, i))
                  if (base == BASE_BEGIN .or. .not. is_of_base(loads%amplitude, i, base)) then
                     value = scaled(loads%kind(i), value, 0.0_wp)
                  end if
                  if (base == BASE_BEGIN .and. allocated(loads%from) .and. is_of_base(loads%amplitude, i, base)) then
                     value = loads%from(:, i)
                  end if
               end associate
            end do
         end if
      end associate
      if (.not. allocated(step%heating)) return
      allocate (now%heating, mold=step%heating)
      now%heating = 0.0_wp
      if (base == BASE_END) now%heating = step%heating
      if (base == BASE_BEGIN .and. allocated(step%heating_from)) now%heating = step%heating_from
   end subroutine base_of

   pure subroutine values_of_base(values, base, now)
      type(nodal_values_t), intent(in) :: values
      integer(ip), intent(in) :: base
      type(nodal_values_t), intent(out) :: now
      integer(ip) :: i

      call take_values(values, now)
      if (values%n == 0) return
      if (base == BASE_BEGIN) then
         now%value = 0.0_wp
         if (allocated(values%from)) now%value = values%from
      end if
      do i = 1, values%n
         if (.not. is_of_base(values%amplitude, i, base)) now%value(i) = 0.0_wp
      end do
   end subroutine values_of_base

   pure logical function is_of_base(amplitude, i, base)
      integer(ip), allocatable, intent(in) :: amplitude(:)
      integer(ip), intent(in) :: i, base

      is_of_base = amplitude_of(amplitude, i) == max(base, 0_ip)
   end function is_of_base

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

end module atrito_step_loads
