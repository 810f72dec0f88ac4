!> The root of an increasing, piecewise linear function: the derivative of a convex, piecewise quadratic one along a line.
!>
!>     s(t) = constant + slope t + sum_i v_i clip((e_i + t v_i + h_i)/c_i, lower_i, upper_i)
module atrito_line_search
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: search_line, clipped

   integer(ip), parameter :: MOST_DOUBLINGS = 10_ip, MOST_STEPS = 250_ip
   integer(ip), parameter :: MOST_STAYS = 3_ip   !< steps after which an end that stays is no use: the next one halves the interval
   real(wp), parameter :: EXACT = 1.0e-10_wp     !< of the slope at the start

contains

   !> q = clip((e + h)/c, lower, upper).
   pure elemental real(wp) function clipped(e, h, c, lower, upper) result(q)
      real(wp), intent(in) :: e, h               !< [L]
      real(wp), intent(in) :: c                  !< [L/F] > 0
      real(wp), intent(in) :: lower, upper       !< [F]

      q = min(max((e + h)/c, lower), upper)
   end function clipped

   !> t > 0 with s(t) = 0, where s(0) < 0; the largest t tried when s stays negative.
   pure real(wp) function search_line(constant, slope, v, e, h, c, lower, upper) result(t)
      real(wp), intent(in) :: constant, slope
      real(wp), intent(in) :: v(:), e(:), h(:), c(:), lower(:), upper(:)
      real(wp) :: start, before, after, here, s_before, s_after, s
      integer(ip) :: i, side, stays

      start = value_at(0.0_wp)
      before = 0.0_wp
      s_before = start
      after = 1.0_wp
      s_after = value_at(after)
      do i = 1, MOST_DOUBLINGS
         if (s_after >= 0.0_wp) exit
         before = after
         s_before = s_after
         after = 2*after
         s_after = value_at(after)
      end do
      t = after
      if (s_after <= EXACT*abs(start)) return
      side = 0
      stays = 0
      do i = 1, MOST_STEPS
         ! false position, the end that stays weighted by half (Illinois)
         here = (before*s_after - after*s_before)/(s_after - s_before)
         if (stays >= MOST_STAYS .or. .not. (here > before .and. here < after)) here = 0.5_wp*(before + after)
         s = value_at(here)
         t = here
         if (abs(s) <= EXACT*abs(start)) return
         stays = merge(stays + 1_ip, 0_ip, side == merge(-1_ip, 1_ip, s < 0.0_wp) .and. stays < MOST_STAYS)
         if (s < 0.0_wp) then
            before = here
            s_before = s
            if (side == -1) s_after = 0.5_wp*s_after
            side = -1
         else
            after = here
            s_after = s
            if (side == 1) s_before = 0.5_wp*s_before
            side = 1
         end if
      end do

   contains

      pure real(wp) function value_at(t)
         real(wp), intent(in) :: t

         value_at = constant + slope*t + sum(v*clipped(e + t*v, h, c, lower, upper))
      end function value_at

   end function search_line

end module atrito_line_search
