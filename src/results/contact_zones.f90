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
   public :: contact_zone, stick_zone, time_of_change

contains

   !> First and last s of the contact, with what is open between them [L]; nan without contact.
   pure function contact_zone(contact) result(ends)
      type(contact_result_t), intent(in) :: contact  !< of a pair, by s
      real(wp) :: ends(2)

      ends = zone_ends(contact%s(:contact%n), contact%pressure(:contact%n), contact%status(:contact%n) /= POINT_OPEN)
   end function contact_zone

   !> The same of the points that stick.
   pure function stick_zone(contact, nu) result(ends)
      type(contact_result_t), intent(in) :: contact  !< of a pair, by s
      real(wp), intent(in) :: nu                     !< coefficient of friction
      real(wp) :: ends(2)

      associate (n => contact%n)
         ends = zone_ends(contact%s(:n), max(nu*contact%weighted_pressure(:n) - abs(contact%shear(:n)), 0.0_wp), &
                          contact%status(:n) == POINT_STICK)
      end associate
   end function stick_zone

   !> The two ends of a zone. With f^2 linear in s, f_b at the last point but one and f_l at the last, d apart, the end is
   !>    d f_l^2 / (f_b^2 - f_l^2)
   !> behind the last point; no farther than the next point, and half-way to it where f does not fall.
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

   !> When a pair has closed last, or opened: the time at which its normal force, continued as a line from the two increments with
   !> contact that are nearest, is zero, within the increment in which it changes; nan where it has not. At first it is open.
   pure real(wp) function time_of_change(rows, pair, closes) result(time)
      type(history_row_t), intent(in) :: rows(:)     !< of the history so far
      integer(ip), intent(in) :: pair                !< place in model%pairs
      logical, intent(in) :: closes                  !< else it opens
      type(history_row_t), allocatable :: own(:)
      integer :: i, way, near

      time = ieee_value(1.0_wp, ieee_quiet_nan)
      own = [history_row_t(), pack(rows, rows%pair == pair)]
      do i = size(own), 2, -1
         if (touches(own(i)) .eqv. touches(own(i - 1))) cycle
         if (touches(own(i)) .eqv. closes) exit
      end do
      if (i < 2) return
      way = merge(1, -1, closes)                     ! towards the contact
      near = merge(i, i - 1, closes)
      time = own(i)%time
      if (near + way < 1 .or. near + way > size(own)) return
      associate (first => own(near), second => own(near + way))
         if (.not. touches(second) .or. second%normal <= first%normal) return
         time = first%time - first%normal*(second%time - first%time)/(second%normal - first%normal)
         time = min(max(time, own(i - 1)%time), own(i)%time)
      end associate
   end function time_of_change

   pure logical function touches(row)
      type(history_row_t), intent(in) :: row

      touches = row%stick + row%slip > 0
   end function touches

end module atrito_contact_zones
