!> A linear solve of the contact line as a row of iterations.tab.
module atrito_iteration
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: iteration_t

   !> One inner solve: a row of iterations.tab. Changes are relative to the largest value.
   type :: iteration_t
      integer(ip) :: step = 1, increment = 1         !< of the step, counted from 1
      integer(ip) :: outer = 0, inner = 0            !< iteration of the outer loop, and solve in it, from 1
      real(wp) :: change_displacement = 0.0_wp, change_pressure = 0.0_wp, change_friction = 0.0_wp !< since the solve before
      integer(ip) :: open = 0, stick = 0, slip = 0   !< points of the line in each state
      real(wp) :: residual = 0.0_wp                  !< |nu S_rho(p) - tau| / |tau|, of the last outer iteration
   end type iteration_t

end module atrito_iteration
