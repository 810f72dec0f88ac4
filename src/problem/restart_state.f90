!> Where a history stands after a converged increment: all that the next one begins from. analysis/ fills it and goes on from it,
!> fields/ keeps it in a restart file.
module atrito_restart_state
   use atrito_bound_qp, only: box_bounds_t, box_state_t
   use atrito_kinds, only: ip, wp
   use atrito_multipliers, only: multiplier_t
   use atrito_results, only: results_t
   implicit none (type, external)
   private
   public :: restart_state_t, slip_memory_t, warm_start_t

   !> What the contact line is started from; factors are not among it. See contact_solution_t.
   type :: warm_start_t
      integer(ip) :: form = 0                       !< CONTACT_*; 0: there is nothing to start from
      real(wp), allocatable :: p(:), tau(:), t(:)   !< at the points [F/L^2]
      type(box_state_t) :: state                    !< states, q, a and r of the m unknowns
      type(box_bounds_t) :: bounds                  !< of the m forces
      logical, allocatable :: is_shared(:)          !< (unknowns) the force is not unique
      integer(ip), allocatable :: tangential_of(:)  !< (normal unknowns)
      real(wp) :: residual = 0.0_wp, contraction = 0.0_wp !< of the Picard map, relative
      type(multiplier_t), allocatable :: multipliers !< of the sparse form
   end type warm_start_t

   !> What friction remembers: see atrito_slip_memory.
   type :: slip_memory_t
      logical, allocatable :: is_incremental(:)      !< (points) the law has a rest slip
      real(wp), allocatable :: rest(:)               !< (points) s0 [L]
      real(wp), allocatable :: slip(:)               !< (points) u_T of the last increment [L]
      real(wp), allocatable :: shear(:)              !< (points) t of the last increment [F/L^2]
      logical, allocatable :: slides(:)              !< (points) the friction of the last increment was at its bound
      real(wp), allocatable :: dissipation(:)        !< (pairs) from the beginning [F L]
      real(wp), allocatable :: moved(:)              !< (pairs) largest displacement and slip so far [L]
   end type slip_memory_t

   type :: restart_state_t
      integer(ip) :: step = 1, increment = 0        !< the last one that converged
      real(wp) :: step_time = 0.0_wp                !< that it came to
      real(wp) :: length = 0.0_wp                   !< of the next increment, before it is cut off at the end of the step
      logical :: ends_step = .false.                !< the increment came to the end of the step
      real(wp) :: began = 0.0_wp                    !< when the step began, time of the history
      real(wp) :: condition = 1.0_wp                !< the largest so far
      real(wp) :: digit_error = 0.0_wp              !< to which stiffnesses are taken as equal
      real(wp), allocatable :: had_motion(:), had_force(:) !< (bodies) the largest so far [L], [F]
      integer(ip) :: contact_form = 0               !< CONTACT_*, of the scene
      character(len=:), allocatable :: contact_reason !< why
      real(wp), allocatable :: from(:)              !< prescribed, at the beginning of the step [L]; not allocated: the deck's
      real(wp), allocatable :: from_of_motions(:)   !< prescribed at reference nodes, at the beginning of the step
      real(wp), allocatable :: released(:, :)       !< (2, n_nodes) of supports that the step does not have [F]
      type(slip_memory_t) :: memory                 !< all but is_incremental, which the deck gives
      type(warm_start_t) :: start                   !< what the next increment starts from
      type(results_t) :: last                       !< the increment
   end type restart_state_t

end module atrito_restart_state
