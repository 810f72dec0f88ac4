!> How the outer loop goes: *CONTROLS of a deck, and what the program adds when it tries again; and a linear solve of the contact
!> line as a row of iterations.tab.
module atrito_controls
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: controls_t, METHOD_ANDERSON, METHOD_PICARD, METHOD_NEWTON, METHOD_NAME, METHOD_EASED, iteration_t

   integer(ip), parameter :: METHOD_ANDERSON = 1, METHOD_PICARD = 2, METHOD_NEWTON = 3
   character(len=8), parameter :: METHOD_NAME(3) = ['ANDERSON', 'PICARD  ', 'NEWTON  ']
   !> From the solution with much more friction to that with the deck's: no deck asks for it.
   integer(ip), parameter :: METHOD_EASED = 4

   !> Of the outer iteration. A deck gives the first five.
   type :: controls_t
      integer(ip) :: method = METHOD_ANDERSON       !< METHOD_*
      real(wp) :: tolerance = 1.0e-10_wp            !< of the outer loop
      integer(ip) :: max_iterations = 100           !< outer iterations
      real(wp) :: relaxation = 1.0_wp               !< of PICARD and of the mixing of ANDERSON, 0 < r <= 1
      integer(ip) :: starts = 0                     !< of a search for other solutions; 0: none is looked for
      logical :: is_coarse = .false.                !< bound_qp_t%is_coarse: states that round-off turns to and fro
      real(wp) :: most_entries = huge(1.0_wp)       !< of C to go through, over all linear solves, before it is given up
      integer(ip) :: most_factorisations = huge(1_ip) !< of the sparse form, before it is given up
      logical :: is_rung = .false.                  !< tried before without a solution: the increment before is no start
      logical :: logs_solves = .false.              !< the states and forces of every linear solve are kept
   end type controls_t

   !> One inner solve: a row of iterations.tab. Changes are relative to the largest value.
   type :: iteration_t
      integer(ip) :: step = 1, increment = 1         !< of the step, counted from 1
      integer(ip) :: outer = 0, inner = 0            !< iteration of the outer loop, and solve in it, from 1
      real(wp) :: change_displacement = 0.0_wp, change_pressure = 0.0_wp, change_friction = 0.0_wp !< since the solve before
      integer(ip) :: open = 0, stick = 0, slip = 0   !< points of the line in each state
      real(wp) :: residual = 0.0_wp                  !< |nu S_rho(p) - tau| / |tau|, of the last outer iteration
   end type iteration_t

contains

end module atrito_controls
