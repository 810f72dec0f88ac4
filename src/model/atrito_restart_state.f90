!> Where a history stands after a converged increment: what the solver begins the next one from. Filled and taken by solve/, kept in
!> a restart file by output/.
module atrito_restart_state
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: restart_state_t

   type :: restart_state_t
      integer(ip) :: step = 1, increment = 0        !< the last one that converged; increment 0: the step begins
      real(wp) :: time = 0.0_wp, step_time = 0.0_wp !< of the history, of the step
      real(wp) :: length = 0.0_wp                   !< of the next increment, before it is cut at the end of the step
      logical :: ends_step = .false.
      real(wp), allocatable :: u(:, :)              !< (2, n_nodes) [L]
      real(wp), allocatable :: reaction(:, :)       !< (2, n_nodes) [F]
      real(wp), allocatable :: slip(:)              !< u_T of the points of all pairs [L]
      real(wp), allocatable :: rest_slip(:)         !< at which the law is at rest [L]
      real(wp), allocatable :: shear(:)             !< [F/L^2]
      real(wp), allocatable :: bound(:)             !< friction bound tau [F/L^2]
      integer(ip), allocatable :: states(:)         !< of the unknowns of the contact line
      real(wp), allocatable :: q(:)                 !< their forces
      real(wp), allocatable :: x(:)                 !< unknowns of the sparse form
      real(wp), allocatable :: dissipation(:)       !< (pairs) so far [F L]
   end type restart_state_t

end module atrito_restart_state
