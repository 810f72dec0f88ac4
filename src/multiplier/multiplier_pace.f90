!> How large the next step of the multipliers is: what the loop remembers of those before, and what it takes of rho, of the pull and
!> of the friction bound (atrito_multiplier_loop).
!>
!> None of this is in the solution. It decides in how many steps the loop comes to it, and keeps it from going round for ever.
module atrito_multiplier_pace
   use atrito_accelerator, only: anderson_t
   use atrito_bound_qp, only: box_bounds_t, box_state_t, FREE
   use atrito_contact_solution, only: contact_solution_t
   use atrito_contact_system, only: contact_system_t
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_loop_progress, only: loop_progress_t
   use atrito_multiplier_distance, only: distance_t
   use atrito_multiplier_step, only: largest_of_pairs, rho_of
   use atrito_multipliers, only: multiplier_t
   implicit none (type, external)
   private
   public :: loop_t, follow_drift, choose_steps, pull_firmly_again, next_start
   public :: LEAST_KAPPA, USUAL_KAPPA, NO_LOAD, LITTLE_LEFT, STALE_DISTANCE

   !> What the loop remembers.
   !>
   !> "pull" is the force kappa H |a - a_o| by which a step holds a motion where it was. It must vanish in the end; while it does
   !> not, the body is on its way to where something holds it, or moves for ever.
   type :: loop_t
      type(loop_progress_t) :: progress
      real(wp) :: drive = 0.0_wp                 !< of the last step: the pull over the largest force of the scene
      integer(ip) :: steady = 0                  !< steps in which the pull on the bodies stayed what it was
      integer(ip) :: moving = 0                  !< of them, those in which it was more than round-off of the largest force
      real(wp), allocatable :: drift(:)          !< (m) change of the forces in the last step, when no state changed [F]
      logical :: asked = .false.                 !< whether forces are unique
      logical :: shares = .false.                !< some are not, and the least are taken
      type(distance_t) :: distance               !< of the last step from a solution
      integer(ip) :: standing = 0                !< steps without a change of states
      integer(ip) :: lagging = 0                 !< of them, those in which the forces changed nearly as much as in the one before
      logical :: can_wait = .true.               !< with the mixing of bounds alone, for forces that come faster
      real(wp) :: change = 0.0_wp                !< of the forces in the last step, relative as in distance
      logical :: is_firm = .false.               !< the pull was made usual again
      logical :: slow = .false.                  !< states went on changing: smaller steps
      real(wp) :: mixed = HUGE_REAL              !< distance of the bound when it was mixed last
      real(wp), allocatable :: share(:)          !< (points) of the way to Picard's bound that the next one goes
      real(wp), allocatable :: off(:)            !< (points) Picard's bound less the last one [F/L^2]
   end type loop_t

   real(wp), parameter :: STALE_DISTANCE = 1.0e-8_wp
   real(wp), parameter :: MOST_MIXING = 5.0_wp        !< times Picard's bound
   real(wp), parameter :: FARTHER = 3.0_wp            !< times the distance of the bound before
   integer(ip), parameter :: MANY_STEPS = 100_ip      !< after which states that still change ask for smaller steps:
   real(wp), parameter :: SLOW_R = 1.0_wp             !< rho over the flexibility of a row then
   real(wp), parameter :: LAGS = 0.5_wp               !< change of the forces over that of the step before that is slow
   integer(ip), parameter :: MOST_LAGGING = 3_ip      !< such steps, before rho falls:
   real(wp), parameter :: LITTLE_LEFT = 1.0e-6_wp     !< change of the forces that is left as it is: it may be a drift without end
   real(wp), parameter :: LESS_PART = 1.0e-2_wp, LEAST_R = 1.0e-7_wp
   real(wp), parameter :: MOST_NOISE = 1.0e-7_wp      !< of the forces of a pair
   integer(ip), parameter :: SLOW_STANDS = 3_ip       !< steps without a change of states before the mixing begins then
   real(wp), parameter :: LESS = 0.7_wp, MORE = 1.2_wp !< of the share of a point whose bound oscillates, and of one whose does not
   real(wp), parameter :: LEAST_SHARE = 0.05_wp
   real(wp), parameter :: STEADY = 0.02_wp            !< change of a drift from one step to the next
   real(wp), parameter :: MOST_DRIFT = 1.0e9_wp       !< steps
   real(wp), parameter :: LEAST_KAPPA = 1.0e-11_wp    !< when bodies move
   real(wp), parameter :: USUAL_KAPPA = 2.0e-8_wp     !< when motions are nearly found
   real(wp), parameter :: NO_LOAD = 1.0e-9_wp         !< pull over the forces of a body that is none

contains

   !> Forces of rows that depend on each other, and whose gaps contradict each other a little, change by the same amount in every
   !> step until one comes to its bound, or until the compliance of the rows has taken up the contradiction, which a share of
   !> D/(D + rho) does in each step. They go there at once: the bodies do not feel it.
   !>
   !> Let d be the change of q in a step. Rows that depend on each other have B'd = 0 for some d: the displacements do not answer,
   !> and q <- q + d for ever, d being the contradiction over rho. With a compliance D the contradiction is used up as q grows:
   !> after d'(D + rho)d / d'D d steps. Steps without a change of states, and two changes within STEADY of each other, show it.
   subroutine follow_drift(system, bounds, multipliers, loop, state)
      class(contact_system_t), intent(in) :: system !< A, B, loads, flexibilities
      type(box_bounds_t), intent(in) :: bounds !< of the m forces [F], and their D [L/F]
      type(multiplier_t), intent(in) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      type(loop_t), intent(inout) :: loop !< what the loop remembers
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      real(wp) :: change(size(state%q)), steps, bound, yields
      integer(ip) :: i

      change = state%q - multipliers%q_old
      if (allocated(loop%drift) .and. .not. multipliers%changed) then
         if (norm2(change) > 0.0_wp .and. norm2(change - loop%drift) <= STEADY*norm2(change)) then
            steps = HUGE_REAL
            yields = dot_product(change, bounds%d*change)/dot_product(change, (bounds%d + rho_of(system, multipliers))*change)
            ! what yields may be beside what drifts by round-off
            if (loop%distance%forces <= 10*STALE_DISTANCE) then
               yields = min(yields, 1 - dot_product(change, loop%drift)/dot_product(loop%drift, loop%drift))
            end if
            if (yields > 1/MOST_DRIFT) steps = 1/yields
            do i = 1, size(change, kind=ip)
               if (state%state(i) /= FREE .or. change(i) == 0.0_wp) cycle
               bound = merge(bounds%lower(i), bounds%upper(i), change(i) < 0.0_wp)
               if (abs(bound) < HUGE_REAL) steps = min(steps, (bound - state%q(i))/change(i))
            end do
            if (steps < MOST_DRIFT) state%q = state%q + steps*change
         end if
      end if
      loop%drift = change
   end subroutine follow_drift

   !> States that still change after many steps may do so for ever. With rho of the size of the flexibility, a step moves the
   !> forces about half of the way only. Where states stand and the forces come no faster to their end, rho is large beside what
   !> tells them: it falls as far as its round-off may.
   !>
   !> rho = r c_i is what a step allows the displacements to be off by, per force. A small rho makes a step nearly exact, and a
   !> friction bound that follows it overshoots where more friction at a point leaves less pressure there; a large one damps that.
   !>
   !>     slow       after MANY_STEPS with changes: r = SLOW_R, for good
   !>     lagging    MOST_LAGGING steps whose changes are more than LAGS of those before: the contraction rho/(lambda + rho) is too
   !>                near to 1. The pull kappa falls where a motion comes slowly, else rho at the pairs that have digits to spare.
   subroutine choose_steps(outer, state, multipliers, loop)
      integer(ip), intent(in) :: outer
      type(box_state_t), intent(in) :: state !< states of the m unknowns, q, a, r
      type(multiplier_t), intent(inout) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      type(loop_t), intent(inout) :: loop !< what the loop remembers

      ! steps without a change of states, and those of them in which the forces came slowly
      loop%standing = merge(0_ip, loop%standing + 1_ip, multipliers%changed)
      loop%lagging = merge(loop%lagging + 1_ip, 0_ip, loop%standing > 1 .and. .not. loop%slow .and. &
                           loop%distance%forces > max(LAGS*loop%change, LITTLE_LEFT))
      loop%change = loop%distance%forces
      if (loop%lagging >= MOST_LAGGING) then
         loop%lagging = 0
         ! it is a motion that comes slowly, or forces
         if (loop%distance%pull > NO_LOAD .and. multipliers%kappa > LEAST_KAPPA) then
            multipliers%kappa = max(0.1_wp*multipliers%kappa, LEAST_KAPPA)
         else
            call take_less_rho(state, multipliers, loop%can_wait)
         end if
      end if
      if (loop%slow .or. outer < MANY_STEPS .or. .not. multipliers%changed) return
      loop%slow = .true.
      multipliers%r = SLOW_R
   end subroutine choose_steps

   !> Less rho at the pairs whose forces stay far above the round-off of their rows with it.
   !>
   !> Round-off of B x is a force of eps |B| |x|/rho: so rho may fall as long as that is MOST_NOISE of the forces of the pair.
   pure subroutine take_less_rho(state, multipliers, any_less)
      type(box_state_t), intent(in) :: state
      type(multiplier_t), intent(inout) :: multipliers
      logical, intent(out) :: any_less
      real(wp) :: force(multipliers%n_pairs), noise(multipliers%n_pairs)
      logical :: bears(size(state%q))

      force = largest_of_pairs(multipliers, abs(state%q))
      noise = largest_of_pairs(multipliers, multipliers%noise)
      bears = noise(multipliers%pair) <= LESS_PART*MOST_NOISE*force(multipliers%pair) .and. multipliers%r*multipliers%part > LEAST_R
      where (bears) multipliers%part = LESS_PART*multipliers%part
      any_less = any(bears)
   end subroutine take_less_rho

   !> Bodies that have come to where something holds them need a weak pull no more, and with the usual one the last step is better
   !> conditioned.
   !>
   !> With a weak pull the matrix is badly conditioned where a motion is weakly held. One more step with the usual one costs a
   !> factorisation.
   pure subroutine pull_firmly_again(multipliers, loop, solution)
      type(multiplier_t), intent(inout) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      type(loop_t), intent(inout) :: loop !< what the loop remembers
      type(contact_solution_t), intent(inout) :: solution !< with a state to start from

      if (loop%is_firm .or. multipliers%kappa >= 0.1_wp*USUAL_KAPPA) return
      loop%is_firm = .true.
      loop%steady = 0
      loop%progress%best = HUGE_REAL
      multipliers%kappa = USUAL_KAPPA
      solution%converged = .false.
   end subroutine pull_firmly_again

   !> The friction bound of the next step: Picard's as long as states change, then Anderson's mixing, within a range of Picard's.
   !>
   !> While states change the map is another one each time, and differences tell nothing: the memory is empty.
   subroutine next_start(image, loop, anderson, tau)
      real(wp), intent(in) :: image(:)           !< (points) nu S_rho of the pressures that the last step found [F/L^2]
      type(loop_t), intent(inout) :: loop !< what the loop remembers
      type(anderson_t), intent(inout) :: anderson
      real(wp), intent(inout) :: tau(:)          !< its bound; on return that of the next step
      real(wp) :: mixed(size(tau))

      if (loop%standing >= merge(SLOW_STANDS, 1_ip, loop%slow) .and. all(tau < HUGE_REAL)) then
         call mix_bound()
         return
      end if
      call anderson%reset()
      loop%mixed = HUGE_REAL
      if (loop%slow) then
         call go_part_of_the_way()
      else
         tau = image
      end if

   contains

      !> Anderson's mixing of the bound, once the forces have come. Near a solution differences that are round-off lead away:
      !> then it begins anew.
      subroutine mix_bound()
         logical :: leads_away

         leads_away = loop%mixed <= STALE_DISTANCE .and. loop%distance%bound/FARTHER > loop%mixed
         ! how far Picard's bound leads behind it is not the mixing's
         loop%mixed = merge(HUGE_REAL, loop%distance%bound, leads_away)
         if ((loop%can_wait .and. loop%lagging > 0) .or. leads_away) then
            call anderson%reset()
            tau = image
         else
            call anderson%update(tau, image, mixed)
            tau = min(max(mixed, image/MOST_MIXING), MOST_MIXING*image)
         end if
      end subroutine mix_bound

      !> A point whose bound goes up and down goes a part of the way to Picard's: with much friction, more of it may leave less
      !> pressure there, and the point would slip and open in turn for ever.
      !>
      !> share falls to LESS of itself where the sign of nu S_rho(p) - tau at the point has changed, and grows by MORE elsewhere:
      !> each point finds the damping that it needs.
      subroutine go_part_of_the_way()

         if (.not. allocated(loop%share)) then
            allocate (loop%share(size(tau)), source=1.0_wp)
            allocate (loop%off(size(tau)), source=0.0_wp)
         end if
         where ((image - tau)*loop%off < 0.0_wp)
            loop%share = max(LESS*loop%share, LEAST_SHARE)
         else where
            loop%share = min(MORE*loop%share, 1.0_wp)
         end where
         ! the share of the way that each point goes; whole ways to the last digit
         loop%off = image - tau
         tau = tau + loop%share*loop%off
         where (loop%share >= 1.0_wp) tau = image
      end subroutine go_part_of_the_way

   end subroutine next_start

end module atrito_multiplier_pace
