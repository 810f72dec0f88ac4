!> The friction laws at a point, equation (5) with phi of the paper and Coulomb's with a stick slope.
!>
!>     t = min(|u_T|/c, tau) sign(u_T)
!>
!> with the slip u_T, the bound tau and the stick compliance c. The law of Oden and Pires (NONLOCAL) has c = eps/tau:
!> friction grows to its full value within the slip eps, whatever that value is. Coulomb's law with a stick slope k
!> (LOCAL) has c = 1/k: it grows by the same slope at every pressure, and is full at the slip tau/k. c = 0 is exact
!> stick, |t| <= tau with u_T = 0, or t = +-tau with slip the same way. t acts on the master along T; the stress of (5)
!> on the slave is -t.
module atrito_friction_law
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: friction_law_t, stick_compliance, sticking_slip, friction_stress, is_full
   public :: FRICTION_NONE, FRICTION_LOCAL, FRICTION_NONLOCAL, KERNEL_POINTS, KERNEL_LINE

   integer(ip), parameter :: FRICTION_NONE = 0, FRICTION_LOCAL = 1, FRICTION_NONLOCAL = 2
   integer(ip), parameter :: KERNEL_POINTS = 1, KERNEL_LINE = 2

   type :: friction_law_t
      integer(ip) :: kind = FRICTION_NONE  !< FRICTION_*
      real(wp) :: nu = 0.0_wp              !< coefficient of friction
      real(wp) :: eps = 0.0_wp             !< NONLOCAL [L]
      real(wp) :: compliance = 0.0_wp      !< LOCAL: 1 / k [L^3/F]
   end type friction_law_t

contains

   !> c [L^3/F] of a sticking point.
   pure elemental real(wp) function stick_compliance(law, tau) result(c)
      type(friction_law_t), intent(in) :: law
      real(wp), intent(in) :: tau          !< bound [F/L^2], > 0

      c = law%compliance
      if (law%kind == FRICTION_NONLOCAL) c = law%eps/tau
   end function stick_compliance

   !> The largest |u_T| [L] of a sticking point.
   pure elemental real(wp) function sticking_slip(law, tau) result(u)
      type(friction_law_t), intent(in) :: law
      real(wp), intent(in) :: tau

      u = law%compliance*tau
      if (law%kind == FRICTION_NONLOCAL) u = law%eps
   end function sticking_slip

   !> t [F/L^2] at a known slip: tau sign(u_T) from the largest slip of a sticking point on, below it in proportion. A
   !> point of exact stick that does not move has none of its own.
   pure elemental real(wp) function friction_stress(law, tau, slip) result(t)
      type(friction_law_t), intent(in) :: law
      real(wp), intent(in) :: tau, slip    !< [F/L^2], [L]
      real(wp) :: limit

      limit = sticking_slip(law, tau)
      if (slip == 0.0_wp .or. tau <= 0.0_wp) then
         t = 0.0_wp
      else if (abs(slip) >= limit) then
         t = sign(tau, slip)
      else
         t = tau*(slip/limit)
      end if
   end function friction_stress

   !> Whether a friction stress has reached its bound. Where a point that has slid rests there, which of two solutions with the
   !> same stress is found, that it sticks or that it slides by nothing, is a matter of round-off: it is not asked for.
   pure elemental logical function is_full(t, tau)
      real(wp), intent(in) :: t, tau       !< [F/L^2]
      real(wp), parameter :: ROUND_OFF = 1.0e-8_wp

      is_full = abs(t) >= (1.0_wp - ROUND_OFF)*tau
   end function is_full

end module atrito_friction_law
