!> Where a pair touches and where it sticks, between the points; and when it closes and opens, between the increments.
!>
!> At the end of a zone of contact the pressure goes like the root of the distance (Hertz), and where a zone of stick ends what is
!> left to the friction bound, tau - |t|, does so, too (Cattaneo). So the square of it at the last two points of the zone, continued
!> as a straight line, is zero at the end, which lies between the last point and the next one. Where it does not fall the end is
!> half-way. A zone that holds the last point of the surface ends there.
module atrito_contact_zones
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_kinds, only: ip, wp
   use atrito_results, only: contact_result_t, history_row_t, POINT_OPEN, POINT_STICK
   implicit none (type, external)
   private
   public :: contact_zone, stick_zone, closing_time, opening_time

contains

   !> First and last s of the contact, with what is open between them [L]; nan without contact.
   pure function contact_zone(contact) result(ends)
      type(contact_result_t), intent(in) :: contact
      real(wp) :: ends(2)

      ends = zone_ends(contact%s(:contact%n), contact%pressure(:contact%n), contact%status(:contact%n) /= POINT_OPEN)
   end function contact_zone

   !> The same of the points that stick.
   pure function stick_zone(contact, nu) result(ends)
      type(contact_result_t), intent(in) :: contact
      real(wp), intent(in) :: nu                     !< coefficient of friction
      real(wp) :: ends(2)

      associate (n => contact%n)
         ends = zone_ends(contact%s(:n), max(nu*contact%weighted_pressure(:n) - abs(contact%shear(:n)), 0.0_wp), &
                          contact%status(:n) == POINT_STICK)
      end associate
   end function stick_zone

   pure function zone_ends(s, f, is_in) result(ends)
      real(wp), intent(in) :: s(:)                   !< rising [L]
      real(wp), intent(in) :: f(:)                   !< what goes like a root at the ends, >= 0
      logical, intent(in) :: is_in(:)
      real(wp) :: ends(2)

      ends = ieee_value(1.0_wp, ieee_quiet_nan)
      if (.not. any(is_in)) return
      ends(1) = end_of_zone(findloc(is_in, .true., dim=1), -1)
      ends(2) = end_of_zone(findloc(is_in, .true., dim=1, back=.true.), 1)

   contains

      pure real(wp) function end_of_zone(last, way) result(place)
         integer, intent(in) :: last, way            !< its last point along way, +-1
         integer :: before, next
         real(wp) :: share                           ! of the way to the next point

         place = s(last)
         next = last + way
         before = last - way
         if (next < 1 .or. next > size(s)) return
         share = 0.5_wp
         if (before >= 1 .and. before <= size(s)) then
            if (is_in(before) .and. f(before) > f(last)) then
               associate (ratio => f(last)/f(before))
                  share = ratio**2/(1.0_wp - ratio**2)*abs(s(last) - s(before))
                  share = min(1.0_wp, share/max(abs(s(next) - s(last)), tiny(share)))
               end associate
            end if
         end if
         place = s(last) + share*(s(next) - s(last))
      end function end_of_zone

   end function zone_ends

   !> When a pair has closed last: the time at which its normal force, continued backwards from the first two increments with
   !> contact, is zero, but not before the end of the last one without; nan where it has not closed.
   pure real(wp) function closing_time(rows, pair) result(time)
      type(history_row_t), intent(in) :: rows(:)     !< of the history so far
      integer(ip), intent(in) :: pair
      type(history_row_t), allocatable :: own(:)
      integer :: i

      time = ieee_value(1.0_wp, ieee_quiet_nan)
      own = pack(rows, rows%pair == pair)
      do i = size(own), 1, -1
         if (.not. touches(own(i))) cycle
         if (i > 1) then
            if (touches(own(i - 1))) cycle
         end if
         time = own(i)%time
         if (i < size(own)) then
            if (touches(own(i + 1))) time = zero_of(own(i), own(i + 1))
         end if
         if (i > 1) time = max(time, own(i - 1)%time)
         time = max(time, 0.0_wp)
         return
      end do
   end function closing_time

   !> When it has opened last, in the same way; nan where it has not.
   pure real(wp) function opening_time(rows, pair) result(time)
      type(history_row_t), intent(in) :: rows(:)     !< of the history so far
      integer(ip), intent(in) :: pair
      type(history_row_t), allocatable :: own(:)
      integer :: i

      time = ieee_value(1.0_wp, ieee_quiet_nan)
      own = pack(rows, rows%pair == pair)
      do i = size(own), 2, -1
         if (touches(own(i)) .or. .not. touches(own(i - 1))) cycle
         time = own(i)%time
         if (i > 2) then
            if (touches(own(i - 2))) time = min(time, zero_of(own(i - 1), own(i - 2)))
         end if
         return
      end do
   end function opening_time

   pure logical function touches(row)
      type(history_row_t), intent(in) :: row

      touches = row%stick + row%slip > 0
   end function touches

   !> Where the line through the normal forces of two increments is zero, behind the first as seen from the second; else the time
   !> of the first.
   pure real(wp) function zero_of(near, far) result(time)
      type(history_row_t), intent(in) :: near, far

      time = near%time
      if (far%normal > near%normal) time = near%time - near%normal*(far%time - near%time)/(far%normal - near%normal)
   end function zero_of

end module atrito_contact_zones
