!> The root of an increasing, piecewise linear function: the derivative of a convex, piecewise quadratic one along a line.
!>
!>     s(t) = constant + slope t + sum_i v_i clip((e_i + t v_i + h_i)/c_i, lower_i, upper_i)
!>
!> is the derivative of phi (atrito_multiplier_step) at x + t dx, with v = B dx: each term increases with t, its slope v_i^2/c_i
!> between the bounds and 0 beyond. s(0) < 0, as dx is a direction in which phi falls, so the root is the least phi on the line.
!>
!> The interval is doubled until s >= 0 at its end, then narrowed by false position with the weights of the Illinois method, which
!> comes to a root of a piecewise linear function in few steps; where one end stays all the same, the middle is taken. s is a sum
!> over the rows: a step costs one pass through them, nothing is solved.
module atrito_line_search
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: search_line, clipped

   integer(ip), parameter :: MOST_DOUBLINGS = 10_ip, MOST_STEPS = 250_ip
   integer(ip), parameter :: MOST_STAYS = 3_ip   !< steps after which an end that stays is no use: the next one halves the interval
   real(wp), parameter :: EXACT = 1.0e-10_wp     !< of the slope at the start

   !> An interval with the values at its ends, which may be weighted.
   !>
   !> s_before < 0 <= s_after. The weights move the secant towards the end that has stayed; they are no values of s any more.
   type :: bracket_t
      real(wp) :: before = 0.0_wp, after = 1.0_wp
      real(wp) :: s_before = 0.0_wp, s_after = 0.0_wp
      integer(ip) :: side = 0                    !< -1 and 1: the end that came last
      integer(ip) :: stays = 0                   !< steps since the other one came
   end type bracket_t

contains

   !> q = clip((e + h)/c, lower, upper).
   pure elemental real(wp) function clipped(e, h, c, lower, upper) result(q)
      real(wp), intent(in) :: e, h               !< [L]
      real(wp), intent(in) :: c                  !< [L/F] > 0
      real(wp), intent(in) :: lower, upper       !< [F]

      q = min(max((e + h)/c, lower), upper)
   end function clipped

   !> t > 0 with s(t) = 0, where s(0) < 0; the largest t tried when s stays negative.
   !>
   !> A step beyond dx (t > 1) is taken where phi falls on: with many rows at their bounds Newton's step is often too short.
   pure real(wp) function search_line(constant, slope, v, e, h, c, lower, upper, unit) result(t)
      real(wp), intent(in) :: constant, slope    !< over the unit
      real(wp), intent(in) :: v(:), e(:), h(:), c(:), lower(:), upper(:)
      real(wp), intent(in), optional :: unit     !< a length that s is divided by: work may leave the range of numbers; 1
      type(bracket_t) :: bracket
      real(wp) :: start, s, length
      integer(ip) :: i

      length = 1.0_wp
      if (present(unit)) length = unit
      start = value_at(0.0_wp)
      bracket%s_before = start
      bracket%s_after = value_at(bracket%after)
      do i = 1, MOST_DOUBLINGS
         if (bracket%s_after >= 0.0_wp) exit
         bracket%before = bracket%after
         bracket%s_before = bracket%s_after
         bracket%after = 2*bracket%after
         bracket%s_after = value_at(bracket%after)
      end do
      t = bracket%after
      if (bracket%s_after <= EXACT*abs(start)) return
      do i = 1, MOST_STEPS
         t = place_within(bracket)
         s = value_at(t)
         if (abs(s) <= EXACT*abs(start)) return
         call narrow(bracket, t, s)
      end do

   contains

      pure real(wp) function value_at(t)
         real(wp), intent(in) :: t

         value_at = constant + slope*t + sum((v/length)*clipped(e + t*v, h, c, lower, upper))
      end function value_at

   end function search_line

   !> By false position, or the middle where that is no use.
   !>
   !> The root of the line through both ends. Round-off, or an end that stays MOST_STAYS times, asks for the middle.
   pure real(wp) function place_within(bracket) result(here)
      type(bracket_t), intent(in) :: bracket

      associate (b => bracket)
         here = (b%before*b%s_after - b%after*b%s_before)/(b%s_after - b%s_before)
         if (b%stays >= MOST_STAYS .or. .not. (here > b%before .and. here < b%after)) here = 0.5_wp*(b%before + b%after)
      end associate
   end function place_within

   !> A new end; the one that stays once more is weighted by half (Illinois).
   !>
   !> Without that false position would keep one end for ever where s is convex, and come from one side in small steps.
   pure subroutine narrow(bracket, here, s)
      type(bracket_t), intent(inout) :: bracket
      real(wp), intent(in) :: here, s
      integer(ip) :: side

      side = merge(-1_ip, 1_ip, s < 0.0_wp)
      bracket%stays = merge(bracket%stays + 1_ip, 0_ip, side == bracket%side .and. bracket%stays < MOST_STAYS)
      if (s < 0.0_wp) then
         bracket%before = here
         bracket%s_before = s
         if (side == bracket%side) bracket%s_after = 0.5_wp*bracket%s_after
      else
         bracket%after = here
         bracket%s_after = s
         if (side == bracket%side) bracket%s_before = 0.5_wp*bracket%s_before
      end if
      bracket%side = side
   end subroutine narrow

end module atrito_line_search
