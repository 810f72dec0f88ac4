!> What the solver found: filled by results/ and analysis/, read by tables/, fields/ and pictures/. No text layout here.
module atrito_results
   use atrito_kinds, only: ip, lp, wp
   use atrito_controls, only: iteration_t
   use atrito_linear_quantity, only: quantity_bound_t
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: results_t, contact_result_t, iteration_t, body_result_t, scene_t, pair_scene_t, balance_t, unsettled_t
   public :: body_motion_t, rigid_result_t, joint_t, cut_force_t, extreme_t, history_t, history_row_t, ending_t, last_frame
   public :: observed_t, observed_list_t, quantity_bound_t, uniqueness_t, error_bound_t, frame_numbers_t, frame_store_t, &
             put_aside, view_frame, has_forces
   public :: POINT_OPEN, POINT_STICK, POINT_SLIP, EXTREME_NAMES

   integer(ip), parameter :: POINT_OPEN = 0, POINT_STICK = 1, POINT_SLIP = 2   !< column status of contact.tab

   !> Fields at the quadrature points of one contact pair, in the order of s.
   type :: contact_result_t
      integer(ip) :: n = 0                          !< points
      real(wp), allocatable :: s(:)                 !< arc length along the slave surface [L]
      real(wp), allocatable :: x(:, :)              !< (2, n) [L]
      real(wp), allocatable :: normal(:, :)         !< (2, n) outward unit normal of the slave
      real(wp), allocatable :: u(:, :)              !< (2, n) displacement of the slave [L]
      real(wp), allocatable :: gap(:)               !< initial distance - u_n [L]; negative: penetration
      real(wp), allocatable :: pressure(:)          !< p = -sigma_n [F/L^2], >= 0
      real(wp), allocatable :: weighted_pressure(:) !< S_rho(p) [F/L^2]
      real(wp), allocatable :: shear(:)             !< sigma_T on the slave along T [F/L^2]
      real(wp), allocatable :: slip(:)              !< u_T [L]
      real(wp), allocatable :: slip_increment(:)    !< u_T less that of the increment before [L]
      integer(ip), allocatable :: status(:)         !< POINT_*
      real(wp), allocatable :: weight(:)            !< quadrature weight times thickness [L^2]
      integer(ip), allocatable :: joint(:)          !< place of its joint in the results' joints
      logical, allocatable :: follows(:)            !< a face of the joint lies between the point and the one before
      real(wp) :: s_end = 0.0_wp                    !< s of the last candidate point [L]
      logical :: has_friction = .false.             !< at some point of the pair
   end type contact_result_t

   !> A contact point that changes its state from one outer iteration to the next.
   type :: unsettled_t
      integer(ip) :: pair = 0, point = 0, node = 0  !< node: the user's number
      real(wp) :: x(2) = 0.0_wp                     !< [L]
      character(len=8) :: states = ' '              !< at the end of the last ones, oldest first: o open, c closed without
      !< friction, = sticking, + slipping along T, - against it
   end type unsettled_t

   !> How a body was handled.
   type :: body_result_t
      character(len=:), allocatable :: name         !< of its element set, or its number
      integer(ip) :: n_nodes = 0, n_elements = 0, n_equations = 0, n_contact_equations = 0 !< without the supported
      !< dofs; of contact: retained
      integer(ip) :: n_free_motions = 0             !< rigid motions left by the supports
      integer :: solver_kind = 0                   !< one of STORAGE_*; 0: not chosen yet
      character(len=:), allocatable :: solver      !< its name
      character(len=:), allocatable :: reason       !< why this solver
      character(len=:), allocatable :: order        !< how the order of the sparse solver was found
      integer(lp) :: profile = 0, memory = 0        !< entries; bytes
      integer(lp) :: most_memory = 0                !< bytes while it is factored
      integer(ip) :: half_bandwidth = 0             !< of the stiffness, as it is numbered
      real(wp) :: digits_lost = 0.0_wp              !< at the worst pivot: log10 of diagonal over pivot, 0..16
      integer(ip) :: worst_node = 0, worst_dof = 0  !< place of the worst pivot (user's node number)
      integer(ip) :: sign_changes = 0               !< negative pivots; the banded solver stops at the first
      integer(ip) :: n_fronts = 0, n_different_fronts = 0 !< of the sparse solver; 0: none
   end type body_result_t

   !> One contact pair before the solution.
   type :: pair_scene_t
      character(len=:), allocatable :: slave, master, interaction !< names, as in the deck
      integer(ip) :: n_points = 0, n_left_out = 0   !< candidate points; slave faces without a master
      logical :: matching = .false., master_is_rigid = .false. !< each point faces a node of the master
      real(wp) :: least_gap = 0.0_wp, greatest_gap = 0.0_wp   !< initial [L]; negative: overlap
      integer(ip) :: least_node = 0, greatest_node = 0        !< of the slave, where: the user's numbers
      real(wp) :: least_x(2) = 0.0_wp, greatest_x(2) = 0.0_wp !< [L]
   end type pair_scene_t

   !> What the scene needs, and what was left out: printed by `check` and in the listing.
   type :: scene_t
      type(body_result_t), allocatable :: bodies(:) !< in the order of the mesh
      type(pair_scene_t), allocatable :: pairs(:)   !< in the order of the model's
      integer(ip) :: n_dofs = 0                     !< free dofs of all bodies
      integer(ip) :: n_normal = 0, n_tangential = 0 !< unknowns of the contact line
      integer(ip) :: n_rows = 0                     !< of the normal ones those of ties, equations, supports, springs
      integer(ip) :: n_rigid = 0                    !< rigid motions carried as unknowns
      logical :: outer_loop = .false.               !< the friction bound follows the pressure by iterations
      logical :: near_elements = .false.            !< some that are near, not equal, had one stiffness; refined
      character(len=:), allocatable :: contact_form, contact_reason !< dense or sparse, and why
      character(len=:), allocatable :: order        !< how the order of elimination of a sparse form was found
      integer(lp) :: memory = 0                     !< bytes, predicted: the most that the process will hold
      integer(lp) :: memory_before = 0, peak_before = 0 !< bytes held before anything is factored, and the most so far
      integer(lp) :: solving = 0                    !< bytes that the sparse form will take to solve
      type(string_t), allocatable :: left_out(:)    !< sentences: what this scene does not need
   end type scene_t

   !> Resultants along 1 and 2 [F], and their moments about the origin [F L].
   type :: balance_t
      real(wp) :: applied(3) = 0.0_wp, reactions(3) = 0.0_wp !< upon the bodies
      real(wp) :: rigid(3) = 0.0_wp                 !< of the bodies' contact upon rigid surfaces; the moment with what is left
      !                                             between the sides of all contact (W-SUMS)
      logical :: is_revolved = .false.              !< forces along 1 are radial: they and the moments balance in themselves
      real(wp) :: rows(3) = 0.0_wp                  !< of the bodies upon springs to the ground and equations
   end type balance_t

   !> A row of bodies.tab: the rigid motion that comes nearest to the displacements of a body, and what acts upon it.
   type :: body_motion_t
      character(len=:), allocatable :: name         !< of the body
      real(wp) :: centre(2) = 0.0_wp                !< of its volume [L]
      real(wp) :: size = 0.0_wp                     !< largest distance of a node from the middle of the body [L]
      real(wp) :: u(2) = 0.0_wp                     !< of the centre [L]
      real(wp) :: rotation = 0.0_wp                 !< counter-clockwise [rad]
      real(wp) :: loads(3) = 0.0_wp                 !< resultant along x and y [F], moment about the centre [F L]
      real(wp) :: supports(3) = 0.0_wp, contact(3) = 0.0_wp !< the same of supports and of contact
      real(wp) :: terms(2) = 0.0_wp                 !< sizes of all that is summed in them [F], [F L]: what rounding is measured by
   end type body_motion_t

   !> A row of rigid.tab: a rigid surface that moves with a reference node.
   type :: rigid_result_t
      character(len=:), allocatable :: name         !< of the surface
      integer(ip) :: node = 0                       !< the user's number
      real(wp) :: size = 0.0_wp                     !< largest distance of the surface from the node [L]
      logical :: is_section = .false.               !< a pre-tension section: u1 is what its sides approach by
      logical :: is_prescribed(3) = .false.         !< u1, u2, rotation
      real(wp) :: u(2) = 0.0_wp                     !< of the node [L]
      real(wp) :: rotation = 0.0_wp                 !< about it, counter-clockwise [rad]
      logical :: has_reaction(2) = .false.          !< along x and y: also where it is held along an inclined axis
      real(wp) :: reaction(2) = 0.0_wp              !< [F]; 0 where there is none
      real(wp) :: force = 0.0_wp                    !< in a section, that of its load and its reaction [F]
      real(wp) :: moment = 0.0_wp                   !< about the node [F L]; 0 where the rotation is free
   end type rigid_result_t

   !> A row of joints.tab: what one body of a pair does to the other. NaN stands for what is not defined.
   type :: joint_t
      integer(ip) :: pair = 0                       !< place in model%pairs
      integer(ip) :: bodies(2) = 0                  !< of the slave and of the master; 0: rigid surface
      real(wp) :: n = 0.0_wp, t = 0.0_wp            !< resultant along the mean normal, compression positive, and the tangent [F]
      real(wp) :: m = 0.0_wp                        !< moment about the middle of the joint [F L]
      real(wp) :: place(2) = 0.0_wp                 !< where the resultant crosses the line of the joint [L]
      real(wp) :: opening = 0.0_wp, sliding = 0.0_wp !< largest gap, mean slip [L]
      real(wp) :: force = 0.0_wp                    !< the resultant's size [F]
      real(wp) :: length = 0.0_wp                   !< largest distance of a point from the middle [L]
      real(wp) :: u(2) = 0.0_wp                     !< displacement of the slave at the place [L]
   end type joint_t

   !> A row of sections.tab: what the part ahead of a cut does to the part behind it.
   type :: cut_force_t
      character(len=:), allocatable :: name         !< as the deck has it
      real(wp) :: middle(2) = 0.0_wp                !< of the cross-section [L]
      real(wp) :: length = 0.0_wp                   !< of it [L]
      real(wp) :: n = 0.0_wp, v = 0.0_wp            !< along the normal, tension positive, and along the cut [F]
      real(wp) :: m = 0.0_wp                        !< about the middle, counter-clockwise [F L]
      real(wp) :: terms(2) = 0.0_wp                 !< sizes of all that is summed in them [F], [F L]: what rounding is measured by
   end type cut_force_t

   !> The largest of a field, and where.
   type :: extreme_t
      real(wp) :: value = 0.0_wp                    !< of the quantity, in its dimension
      integer(ip) :: id = 0                         !< the user's number of the element or node
      real(wp) :: x(2) = 0.0_wp                     !< [L]
      logical :: is_node = .false.                  !< id is that of a node
      character(len=16) :: quantity = ''            !< in extremes.tab; '': none of it
   end type extreme_t

   !> What extremes.tab has, in its order.
   character(len=16), parameter :: EXTREME_NAMES(10) = [character(len=16) :: 'u', 'u1_max', 'u1_min', 'u2_max', 'u2_min', &
                                                                                  'mises', 's1_max', 's3_min', 'contact_pressure', &
                                                                                                                    'contact_shear']

   !> A quantity that the user asked for by --observe.
   type :: observed_t
      character(len=32) :: name = ''                !< as the user wrote it
      real(wp) :: value = 0.0_wp                    !< nan: it is not defined
   end type observed_t

   !> Whether the solution is the only one (atrito_uniqueness).
   type :: uniqueness_t
      real(wp) :: nu = 0.0_wp                       !< the largest coefficient of friction; 0: without friction there is one
      real(wp) :: up_to_nu = 0.0_wp                 !< one solution for every load, all coefficients scaled, this the largest
      real(wp) :: same_way_up_to_nu = 0.0_wp        !< no other one that moves the same way at every point; 0: no proof
      integer(ip) :: index = 0                      !< 1 or -1; 0: not known
      integer(ip) :: starts = 0, solutions = 0      !< of the search: tried, and found with the one that is printed; 0: none
      character(len=64) :: why_not = ''             !< why there is no certificate
   end type uniqueness_t

   !> A bound of the error of displacements and stresses (atrito_error_bound).
   type :: error_bound_t
      logical :: exists = .false.                   !< there is one; else why_not says why
      logical :: is_certified = .false.             !< proved for the friction bound of the run; else every step but one is
      logical :: is_of_polygon = .false.            !< of the bodies as meshed: the deck has arcs
      real(wp) :: percent = 0.0_wp                  !< the energy norm of the error over that of the displacements, at most [%]
      real(wp) :: norm = 0.0_wp                     !< the same without that norm, eta [(F L)^(1/2)]
      real(wp) :: bulk = 0.0_wp, normal = 0.0_wp, tangential = 0.0_wp !< shares of eta^2: bodies, contact, friction
      real(wp) :: residual = 0.0_wp                 !< of the equilibrium of the stresses that prove it, over the largest force
      character(len=64) :: why_not = ''             !< why it is not certified, or is not there
   end type error_bound_t

   !> The numbers of an increment.
   type :: frame_numbers_t
      integer(ip) :: step = 1, increment = 1        !< counted from 1
      real(wp) :: time = 1.0_wp, step_time = 1.0_wp !< of the history, of the step
      logical :: ends_step = .true.                 !< it is the last of its step
      logical :: converged = .false.                !< the outer loop met its tolerance
      logical :: law_holds = .false.                !< outcome of the final check
      real(wp) :: error_estimate = 0.0_wp           !< of the stresses, in the energy norm, relative [%]; Zienkiewicz and Zhu
      type(error_bound_t) :: error_bound            !< of this increment, where it was asked for
      integer(ip) :: outer_iterations = 0, linear_solves = 0, factorisations = 0 !< of this increment
      real(wp) :: contraction = 0.0_wp              !< measured rate of the outer loop; 0 unknown
      real(wp) :: contraction_estimate = 0.0_wp     !< of the Picard map from its matrix; from 1 on there may be several solutions
      type(uniqueness_t) :: uniqueness              !< as far as it was looked for
      real(wp) :: equilibrium_residual = 0.0_wp     !< over the largest force of a node
      real(wp) :: strain_energy = 0.0_wp, external_work = 0.0_wp   !< [F L]
      type(extreme_t) :: large_strain, large_rotation, large_slip  !< where they pass what a linear theory knows; 0: they do not
      type(balance_t) :: balance                    !< of all forces upon the bodies
   end type frame_numbers_t

   !> An increment of a history, or a run of one.
   type, extends(frame_numbers_t) :: results_t
      character(len=:), allocatable :: verdict      !< in words: why not converged, or what the check found
      type(scene_t) :: scene                        !< as solved, with what each body took
      real(wp), allocatable :: u(:, :)              !< (2, n_nodes) [L]
      logical, allocatable :: prescribed(:, :)      !< (2, n_nodes)
      real(wp), allocatable :: reaction(:, :)       !< (2, n_nodes) [F]; 0 where not prescribed
      type(contact_result_t), allocatable :: contact(:)   !< one a pair
      real(wp), allocatable :: row_x(:, :)          !< (2, bilateral rows) a node of each [L]
      real(wp), allocatable :: row_force(:)         !< (bilateral rows) q: what row j takes along its vectors [F]
      integer(ip), allocatable :: stress_element(:) !< (n_stress) places of elements, rows of stress.tab
      integer(ip), allocatable :: stress_point(:)   !< (n_stress) 1.. in the element, xi fastest
      real(wp), allocatable :: stress_x(:, :)       !< (2, n_stress) [L]
      real(wp), allocatable :: stress(:, :)         !< (5, n_stress): s11 s22 s33 s12 mises [F/L^2]
      real(wp), allocatable :: nodal_stress(:, :)   !< (5, n_nodes): s11 s22 s33 s12 mises recovered at the nodes [F/L^2]
      real(wp), allocatable :: element_error(:)     !< (n_elements) shares of the estimate, the root of the sum of their squares [%]
      type(iteration_t), allocatable :: iterations(:) !< of this increment, in their order
      type(unsettled_t), allocatable :: unsettled(:)    !< of a run that did not converge, the most restless first
      type(extreme_t), allocatable :: extremes(:)   !< rows of extremes.tab
      type(body_motion_t), allocatable :: bodies(:) !< when asked for
      type(rigid_result_t), allocatable :: rigid(:) !< rigid surfaces with a reference node; not allocated: there are none
      type(joint_t), allocatable :: joints(:)       !< by pair, then along s
      type(observed_t), allocatable :: observed(:)  !< not allocated: nothing is
      type(quantity_bound_t), allocatable :: bounded(:) !< what is bounded of it; not allocated: nothing is
      type(cut_force_t), allocatable :: cuts(:)     !< when asked for
   end type results_t

   !> A row of history.tab: what a pair transmits at the end of an increment, of what is on the slave. NaN: not defined.
   type :: history_row_t
      integer(ip) :: step = 1, increment = 1, pair = 0 !< counted from 1; pair: place in model%pairs
      real(wp) :: time = 0.0_wp                     !< of the history
      real(wp) :: normal = 0.0_wp, shear = 0.0_wp   !< resultants [F], as in summary.tab
      real(wp) :: moment = 0.0_wp                   !< of the tractions upon the slave about the origin [F L]
      real(wp) :: length = 0.0_wp                   !< of the slave with pressure [L]
      real(wp) :: centre = 0.0_wp                   !< s of the resultant of the pressure [L]
      real(wp) :: max_pressure = 0.0_wp             !< [F/L^2]
      integer(ip) :: open = 0, stick = 0, slip = 0  !< points of the pair in each state
      real(wp) :: dissipation = 0.0_wp              !< by friction, from the beginning of the history [F L]
      real(wp) :: elastic_energy = 0.0_wp           !< of all bodies [F L]
      real(wp) :: unique_up_to_nu = 0.0_wp          !< of the increment, all pairs (uniqueness_t)
      integer(ip) :: index = 0                      !< of the increment, all pairs (uniqueness_t)
      real(wp) :: mean_slip = 0.0_wp                !< of u_T over the area of all points, open ones too [L]; drawn alone
   end type history_row_t

   !> What was observed at the end of each increment, printed or not.
   type :: observed_list_t
      integer(ip) :: n = 0                          !< increments; the arrays may be longer
      integer(ip), allocatable :: step(:), increment(:) !< (>= n) counted from 1
      real(wp), allocatable :: time(:)              !< of the history
      real(wp), allocatable :: values(:, :)         !< (observed, n)
   end type observed_list_t

   !> How a history ended before its end.
   type :: ending_t
      logical :: is_early = .false.                 !< it did not reach the end of its last step
      integer(ip) :: step = 0, increment = 0        !< that failed
      real(wp) :: time = 0.0_wp                     !< of the history, that it should have reached
      character(len=:), allocatable :: reason       !< in words
   end type ending_t

   !> Who keeps the frames of a history out of the memory: how is not known here.
   type, abstract :: frame_store_t
      logical :: has_failed = .false.               !< a frame did not come back
   contains
      procedure(put_frame), deferred :: put
      procedure(get_frame), deferred :: get
   end type frame_store_t

   abstract interface
      !> Takes frame i, which comes behind frame i - 1. done: else there is no room, and it has to stay where it is.
      subroutine put_frame(self, i, frame, done)
         import :: frame_store_t, results_t, ip
         class(frame_store_t), intent(inout) :: self !< holds frames 1..i - 1
         integer(ip), intent(in) :: i               !< place in the history's frames
         type(results_t), intent(inout) :: frame    !< is not changed
         logical, intent(out) :: done               !< it is kept
      end subroutine put_frame

      !> Shows frame i until it is asked again. Not associated: it did not come back.
      subroutine get_frame(self, i, frame)
         import :: frame_store_t, results_t, ip
         class(frame_store_t), intent(inout), target :: self !< holds frame i
         integer(ip), intent(in) :: i               !< place in the history's frames
         type(results_t), pointer, intent(out) :: frame !< of the store; not associated: it did not come back
      end subroutine get_frame
   end interface

   !> What was found of a history: the increments that are printed, and a row of every increment and pair.
   type :: history_t
      type(results_t), allocatable :: frames(:)     !< in the order of time; of a run that ended well the last is its end
      type(results_t), allocatable :: others(:)     !< other solutions of a run of one increment; not allocated: none was found
      class(frame_store_t), pointer :: store => null() !< not associated: all frames are whole
      integer(ip) :: n_stored = 0                   !< the first frames: here are their numbers, view_frame shows their fields
      type(history_row_t), allocatable :: rows(:)   !< (increments x pairs) by increment, then by pair
      type(iteration_t), allocatable :: iterations(:) !< of all increments
      type(observed_list_t) :: observed             !< *OBSERVE and --observe, at every increment
      type(ending_t) :: ending                      !< why no more increments were tried
      integer(ip) :: factorisations = 0             !< of all increments that were tried
   end type history_t

contains

   !> Place of the frame that pictures, the screen and studies show: the last increment that is printed.
   pure integer(ip) function last_frame(history)
      type(history_t), intent(in) :: history        !< with frames

      last_frame = size(history%frames, kind=ip)
   end function last_frame

   !> Hands a frame to the store, where there is one, and keeps its numbers. One that is not taken stays whole, and all behind it.
   subroutine put_aside(i, history)
      integer(ip), intent(in) :: i                  !< place in the history's frames
      type(history_t), intent(inout) :: history     !< frame i keeps its numbers alone, if the store took it
      type(results_t) :: numbers
      logical :: done

      if (.not. associated(history%store) .or. history%n_stored /= i - 1) return
      call history%store%put(i, history%frames(i), done)
      if (.not. done) return
      numbers%frame_numbers_t = history%frames(i)%frame_numbers_t
      history%frames(i) = numbers                   ! the fields are gone
      history%n_stored = i
   end subroutine put_aside

   !> Shows a whole frame, until the next one is shown. The last is always there.
   subroutine view_frame(history, i, frame)
      type(history_t), intent(in), target :: history !< frames that were put aside come from its store
      integer(ip), intent(in) :: i                   !< place in the history's frames
      type(results_t), pointer, intent(out) :: frame !< into the history, or into its store

      frame => history%frames(i)
      if (i > history%n_stored) return
      call history%store%get(i, frame)
      if (associated(frame)) return
      history%store%has_failed = .true.             ! write_results reports it; what is shown instead has the right sizes
      frame => history%frames(last_frame(history))
   end subroutine view_frame

   !> Whether anything acts upon the bodies.
   pure logical function has_forces(results)
      type(results_t), intent(in) :: results        !< its energy and reactions are read

      has_forces = results%strain_energy > 0.0_wp
      if (allocated(results%reaction) .and. .not. has_forces) has_forces = any(abs(results%reaction) > 0.0_wp)
   end function has_forces

end module atrito_results
