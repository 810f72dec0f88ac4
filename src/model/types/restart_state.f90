!> Where a history stands after a converged increment: all that the next one begins from. Filled and taken by solve/, kept in a
!> restart file by output/.
module atrito_restart_state
   use atrito_kinds, only: ip, wp
   use atrito_results, only: results_t
   implicit none (type, external)
   private
   public :: restart_state_t, warm_start_t

   !> What the contact line is started from, as plain arrays; factors are not among it. See contact_solution_t in solve/.
   type :: warm_start_t
      integer(ip) :: form = 0                       !< CONTACT_*; 0: there is nothing to start from
      real(wp), allocatable :: p(:), tau(:), t(:)   !< at the points [F/L^2]
      integer(ip), allocatable :: state(:)          !< of the unknowns
      real(wp), allocatable :: q(:), a(:), r(:), shift(:)
      real(wp) :: slack = 0.0_wp
      real(wp), allocatable :: lower(:), upper(:), d(:)
      logical, allocatable :: is_shared(:)
      integer(ip), allocatable :: tangential_of(:)
      real(wp) :: residual = 0.0_wp, contraction = 0.0_wp
      logical :: has_multipliers = .false.          !< what follows is theirs: of the sparse form
      real(wp) :: step_size = 0.0_wp, pull_size = 0.0_wp
      real(wp), allocatable :: x(:), e(:), noise(:), q_old(:), a_old(:), hold(:)
      integer(ip), allocatable :: pair(:)
      integer(ip) :: n_pairs = 0, n_contact_pairs = 0
      real(wp), allocatable :: stiffness(:), pull(:)
      logical :: settled = .false., changed = .false.
   end type warm_start_t

   type :: restart_state_t
      integer(ip) :: step = 1, increment = 0        !< the last one that converged
      real(wp) :: step_time = 0.0_wp                !< that it came to
      real(wp) :: length = 0.0_wp                   !< of the next increment, before it is cut off at the end of the step
      logical :: ends_step = .false.
      real(wp) :: began = 0.0_wp                    !< when the step began, time of the history
      real(wp) :: condition = 1.0_wp                !< the largest so far
      real(wp) :: grain = 0.0_wp                    !< to which stiffnesses are taken as equal
      real(wp), allocatable :: had_motion(:), had_force(:) !< (bodies) the largest so far [L], [F]
      integer(ip) :: contact_form = 0               !< CONTACT_*, of the scene
      character(len=:), allocatable :: contact_reason !< why
      real(wp), allocatable :: from(:)              !< prescribed, at the beginning of the step [L]; not allocated: the deck's
      real(wp), allocatable :: from_of_motions(:)   !< prescribed at reference nodes, at the beginning of the step
      real(wp), allocatable :: released(:, :)       !< (2, n_nodes) of supports that the step does not have [F]
      real(wp), allocatable :: rest(:)              !< (points) rest slip [L]
      real(wp), allocatable :: slip(:)              !< (points) u_T [L]
      real(wp), allocatable :: shear(:)             !< (points) [F/L^2]
      logical, allocatable :: slides(:)             !< (points)
      real(wp), allocatable :: dissipation(:)       !< (pairs) so far [F L]
      real(wp), allocatable :: moved(:)             !< (pairs) largest displacement and slip so far [L]
      type(warm_start_t) :: start
      type(results_t) :: last                       !< the increment
   end type restart_state_t

end module atrito_restart_state
