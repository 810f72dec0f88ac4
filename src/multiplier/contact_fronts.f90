!> Many points: which of them are open, stick and slip, before the steps of the multipliers; on long contact lines, where stick ends
!> and slip begins, and where contact ends.
!>
!> Newton's method with a line search (atrito_multiplier_step) falls in every step and always ends, but its step goes as far as a
!> few points change: a front between stick and slip moves by a few points a solve, however fine the mesh is, and a wall of a
!> thousand blocks takes a hundred. With many points the states are found first, by a primal and dual active set: solve with the
!> states held, let the law say of each point whether it would be in another state,
!>
!>     closed -> open    p < 0             stick -> slip    |t| > tau
!>     open -> closed    u_n > s           slip -> stick    the slip goes against its friction
!>
!> and change all of them at once. What is new is how far a front goes. Near a front at its place the excess of the stress over
!> its bound is -C sqrt(s) at the distance s on one side, the slip or the gap is A s^(3/2) on the other (as at the edge of Hertz'
!> contact, and of Cattaneo's stick zone). At a front that is wrong by d, to first order in d,
!>
!>     d short        excess  -C (s - d)^(1/2)  ~  -C s^(1/2) + C d/2 s^(-1/2)     > 0 for s < d/2
!>     d too far      slip     A (s - d)^(3/2)  ~   A s^(3/2) - 3 A d/2 s^(1/2)    < 0 for s < 3 d/2
!>
!> So a run of m points beside a front that would leave the inner state takes as many more with it, and of a run that would come
!> back only two thirds do: then the error d falls to what the next term says, and not by half in each solve. Elements that are
!> long across the line smear the root: one point at the front bears the whole excess, and m is one however large d is. Then the
!> forces tell d: points beyond the bound hand their excess on to those behind them, as far as it takes until these can bear it,
!>
!>     sum over i = 1 .. D of (|q_i| - bound_i) = 0,     D = 3 d/2 for the stresses above,
!>
!> and the front goes by 2 D/3, or 2 m if that is more. Half of what the law leaves in front of it stays: let go at once, a body
!> that the last stuck points hold would fly. So the number of solves does not grow with the number of points.
!>
!> The friction bound is frozen while more than FEW_CHANGES of the points change, as in the Picard loop. Then bound and forces are
!> made to agree with the states (atrito_held_states), nearly where these change, and to the tolerance where they do not. Of the
!> changes that the law asks for some wait (atrito_state_changes). What is found is a start for the steps of the multipliers, which
!> go to the last digit and ask whether the states are right. Where states do not come to rest they take the solve after which the
!> law asked for the fewest changes; where these are more than NEAR of the points (bodies that nothing holds while all slips, say),
!> they begin without.
module atrito_contact_fronts
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE, AT_LOWER, AT_UPPER, FROZEN
   use atrito_sparse_rows, only: multiply_rows
   use atrito_contact_line, only: contact_line_t, set_friction_bounds
   use atrito_contact_solution, only: contact_solution_t, bound_of_state
   use atrito_contact_system, only: contact_system_t
   use atrito_held_states, only: held_states_t, hold_states, agree, take_agreed
   use atrito_kinds, only: ip, wp
   use atrito_multiplier_step, only: residual_of, provide_factor, set_held_forces
   use atrito_multipliers, only: multiplier_t
   use atrito_state_changes, only: states_of_law, keep_held, furthest_off_first
   use atrito_solve_history, only: solve_history_t, record_solve
   use atrito_status, only: status_t, is_ok, STATUS_SINGULAR
   implicit none (type, external)
   private
   public :: find_fronts, has_many_points, move_fronts

   !> Displacements, forces, states and bound.
   type :: place_t
      real(wp), allocatable :: x(:), e(:), q_old(:), a_old(:), tau(:) ! of multiplier_t and contact_solution_t
      type(box_state_t) :: state
      type(box_bounds_t) :: bounds
      integer(ip) :: changes = huge(1_ip)        !< that the law asks for there
   end type place_t

   integer(ip), parameter :: MANY_POINTS = 100_ip  !< for which it is worth it
   integer(ip), parameter :: MOST_SOLVES = 60_ip
   integer(ip), parameter :: MOST_IN_VAIN = 10_ip  !< of them, since fewer points changed than in each of the three before
   real(wp), parameter :: NEAR = 0.05_wp           !< of the points may still change in a start
   integer(ip), parameter :: LOOKS_AHEAD = 8_ip    !< points that do not change, before those that do are looked for no more
   real(wp), parameter :: FEW_CHANGES = 0.1_wp     !< of the points: the friction bound may follow

contains

   !> Whether there are so many points that it is worth to change the states of all at once.
   pure logical function has_many_points(line)
      type(contact_line_t), intent(in) :: line

      has_many_points = line%n - line%n_bilateral >= MANY_POINTS
   end function has_many_points

   !> States, friction bound, forces and displacements near a solution. found: whether the states came to rest, or nearly
   !> (multipliers%changed); else all is as it was, as it is where a matrix of states that were tried is singular. status: that of
   !> system%factor but for that.
   subroutine find_fronts(system, shape, line, tolerance, multipliers, solution, found, status)
      class(contact_system_t), intent(inout) :: system !< A, B, loads, flexibilities
      type(bound_qp_t), intent(in) :: shape   !< numbers of unknowns and weights
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      real(wp), intent(in) :: tolerance !< of forces and bound once states have come to rest, of the largest of the pair
      type(multiplier_t), intent(inout) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      type(contact_solution_t), intent(inout) :: solution !< states, bound tau; what is found
      logical, intent(out) :: found
      type(status_t), intent(out) :: status
      type(place_t) :: begun, best
      integer(ip), allocatable :: normal(:), tangential(:) ! how far a front went that has passed each point
      integer(ip) :: before(system%rows%n), raw(system%rows%n), turns(system%rows%n)
      real(wp) :: beyond(system%rows%n, AT_LOWER:AT_UPPER)
      integer(ip) :: solves, changes, last(3), since ! changes of the last solves; solves since there were fewer
      real(wp) :: noise(system%rows%n)
      logical :: follows, agrees, kept(system%rows%n)
      type(held_states_t) :: held

      begun = place_of(multipliers, solution)
      found = .false.
      follows = .true.
      call multiply_rows(system%rows, multipliers%x, multipliers%e, noise)
      multipliers%e = multipliers%e + system%g0
      turns = 0
      kept = .false.
      last = huge(last)
      since = 0
      do solves = 1, MOST_SOLVES
         before = solution%state%state
         call solve_with_states(system, solution%bounds, multipliers, solution%state, status)
         if (.not. is_ok(status)) then
            if (status%code == STATUS_SINGULAR) status = status_t()
            multipliers%generation = -1                ! there is no factor
            best%changes = huge(changes)               ! and no way on from there
            exit
         end if
         call record_solve(solution%history, shape, solution%bounds, solution%state)
         call follow_bound()
         ! the proximal terms stand at what is found
         multipliers%q_old = min(max(solution%state%q, solution%bounds%lower), solution%bounds%upper)
         raw = states_of_law(system, shape, solution%bounds, multipliers, solution%state, before)
         changes = count(raw /= before, kind=ip)
         if (changes < best%changes) then
            best = place_of(multipliers, solution)
            best%changes = changes
         end if
         found = changes == 0 .and. follows
         follows = changes <= FEW_CHANGES*line%n
         solution%state%state = raw
         beyond(:, AT_LOWER) = solution%bounds%lower - solution%state%q
         beyond(:, AT_UPPER) = solution%state%q - solution%bounds%upper
         call move_fronts(line, line%normal, before, raw, solution%state%state, normal, beyond)
         call move_fronts(line, line%tangential, before, raw, solution%state%state, tangential, beyond)
         call keep_held(system, before, beyond, kept, solution%state%state)
         call furthest_off_first(system, line, solution%bounds, before, turns, normal, tangential, solution%state)
         where (solution%state%state /= before) turns = turns + 1
         since = merge(0_ip, since + 1_ip, all(changes < last))
         last = [last(2:), changes]
         multipliers%changed = .not. found
         if (found) return
         if (since >= MOST_IN_VAIN) exit
      end do
      found = is_ok(status) .and. best%changes <= NEAR*line%n
      if (found) begun = best
      call go_to(begun, multipliers, solution)

   contains

      !> Forces and friction bound that nearly agree with the states of the solve; Picard's bound where they do not come to that.
      subroutine follow_bound()
         agrees = .false.
         if (follows) call hold_states(system, line, multipliers, solution, held)
         if (follows) call agree(system, shape, line, multipliers, tolerance, held, agrees)
         if (agrees) call take_agreed(shape, line, held, multipliers, solution)
         if (agrees) return
         multipliers%a_old = multipliers%x(system%n - system%k + 1:)
         if (follows) solution%tau = bound_of_state(line, solution)
         call set_friction_bounds(line, shape, solution%tau, solution%bounds, solution%state)
      end subroutine follow_bound

   end subroutine find_fronts

   !> Where the fronts are.
   pure function place_of(multipliers, solution) result(place)
      type(multiplier_t), intent(in) :: multipliers
      type(contact_solution_t), intent(in) :: solution
      type(place_t) :: place

      place%x = multipliers%x
      place%e = multipliers%e
      place%q_old = multipliers%q_old
      place%a_old = multipliers%a_old
      place%state = solution%state
      place%bounds = solution%bounds
      place%tau = solution%tau
   end function place_of

   !> Back to a place.
   pure subroutine go_to(place, multipliers, solution)
      type(place_t), intent(in) :: place
      type(multiplier_t), intent(inout) :: multipliers
      type(contact_solution_t), intent(inout) :: solution

      multipliers%x = place%x
      multipliers%e = place%e
      multipliers%q_old = place%q_old
      multipliers%a_old = place%a_old
      solution%state = place%state
      solution%bounds = place%bounds
      solution%tau = place%tau
   end subroutine go_to

   !> The displacements for which FREE rows obey their law and the others have the force of their bound.
   !>
   !>     A x + kappa H (a - a_o) + B' q = f,   q_i = (B_i x + g0_i + rho_i q_o,i)/(D_i + rho_i) in FREE rows, else its bound
   !>
   !> Linear: one solve with the matrix of the states. q is not clipped: where it is beyond a bound, the law asks for another state.
   subroutine solve_with_states(system, bounds, multipliers, state, status)
      class(contact_system_t), intent(inout) :: system
      type(box_bounds_t), intent(in) :: bounds
      type(multiplier_t), intent(inout) :: multipliers
      type(box_state_t), intent(inout) :: state
      type(status_t), intent(out) :: status
      real(wp) :: dx(system%n), de(system%rows%n)

      call set_held_forces(system, bounds, multipliers, state)
      call residual_of(system, multipliers, state%q, dx)
      call provide_factor(system, bounds, state, multipliers, status)
      if (.not. is_ok(status)) return
      call system%solve(dx)
      multipliers%solves = multipliers%solves + 1
      multipliers%x = multipliers%x + dx
      call multiply_rows(system%rows, dx, de)
      multipliers%e = multipliers%e + de
      call set_held_forces(system, bounds, multipliers, state)

   end subroutine solve_with_states

   !> Moves the fronts: where points of two states are neighbours, and those of one side would be in the state of the other.
   pure subroutine move_fronts(line, unknown, before, raw, new, went, beyond)
      type(contact_line_t), intent(in) :: line   !< whose points follow each other along each pair
      integer(ip), intent(in) :: unknown(:)      !< (points) normal or tangential unknown of each; 0: none
      integer(ip), intent(in) :: before(:)       !< (m) states
      integer(ip), intent(in) :: raw(:)          !< (m) states that the law asks for
      integer(ip), intent(inout) :: new(:)       !< (m) at first raw; states with the fronts where they go to
      !> (points) How far a front went that passed it in the step before, else 0; of this one. Not allocated before the first.
      integer(ip), allocatable, intent(inout) :: went(:)
      !> (m, AT_LOWER:AT_UPPER) How much the forces of the solve are beyond their bounds [F]; without it fronts go by their runs.
      real(wp), intent(in), optional :: beyond(:, AT_LOWER:)
      integer(ip) :: last(line%n), j

      last = 0
      if (allocated(went)) last = went
      went = spread(0_ip, 1, line%n)
      do j = 1, line%n - 1
         if (unknown(j) == 0 .or. unknown(j + 1) == 0) cycle
         if (allocated(line%pair)) then
            if (line%pair(j) /= line%pair(j + 1)) cycle
         end if
         associate (left => before(unknown(j)), right => before(unknown(j + 1)))
            ! one of the two is stuck or closed
            if (left == right .or. (left /= FREE .and. right /= FREE) .or. left == FROZEN .or. right == FROZEN) cycle
         end associate
         call move_front(line, unknown, before, raw, last, [j, j + 1], new, went, beyond)
         call move_front(line, unknown, before, raw, last, [j + 1, j], new, went, beyond)
      end do
   end subroutine move_fronts

   !> Moves one front in one direction: the points beside it take the state of the point `edge`, which is the last one behind it.
   !>
   !> Stresses beside a front may go up and down from point to point (sides that do not match): its run is the longest of which at
   !> least half of the points would change.
   pure subroutine move_front(line, unknown, before, raw, last, front, new, went, beyond)
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: unknown(:), before(:), raw(:)
      integer(ip), intent(in) :: last(:)         !< (points) how far a front went in the step before
      integer(ip), intent(in) :: front(2)        !< the points behind it and in front of it, neighbours
      integer(ip), intent(inout) :: new(:)
      integer(ip), intent(inout) :: went(:)      !< (points) of this step
      real(wp), intent(in), optional :: beyond(:, AT_LOWER:)
      integer(ip) :: edge, side, from, to, m, taken, ahead, i, changing

      edge = front(1)
      side = front(2) - edge
      to = before(unknown(edge))
      from = before(unknown(edge + side))
      m = 0
      changing = 0
      i = 0
      do while (is_from(i + 1) .and. i <= 2*changing + LOOKS_AHEAD)
         i = i + 1
         if (raw(unknown(edge + side*i)) /= to) cycle
         changing = changing + 1
         if (2*changing >= i) m = i
      end do
      ! a run that ends at another front is no run of this one
      if (m == 0 .or. .not. is_from(m + 1)) return
      ! where the points behind it change as well there is no front, but for one that has gone far too far: what sticks behind it is
      ! dragged the other way
      if (raw(unknown(edge)) /= to .and. (to /= FREE .or. raw(unknown(edge)) == from .or. m <= LOOKS_AHEAD)) return
      new(unknown(edge)) = to
      if (from == FREE) then
         taken = 2*m
         if (present(beyond)) taken = max(taken, (2*reach_of_excess())/3)
         ! never all that holds the body: half of what would be left stays
         ahead = m
         do while (is_from(ahead + 1))
            ahead = ahead + 1
         end do
         taken = min(taken, (m + ahead)/2)
      else
         taken = (2*m + 1)/3
      end if
      ! it came from there: its place is between
      if (last(edge + side) > 0) taken = min(taken, max(1_ip, 2*last(edge + side)/3))
      do i = 1, max(m, taken)
         if (.not. is_from(i)) exit
         associate (j => edge + side*i)
            new(unknown(j)) = merge(from, to, i > taken)
            if (i <= taken) went(j) = taken
         end associate
      end do

   contains

      !> Whether the i-th point in front of the edge is of the same pair and in the state that is left.
      pure logical function is_from(i)
         integer(ip), intent(in) :: i

         is_from = edge + side*i >= 1 .and. edge + side*i <= line%n
         if (.not. is_from) return
         is_from = unknown(edge + side*i) > 0
         if (is_from .and. allocated(line%pair)) is_from = line%pair(edge + side*i) == line%pair(edge)
         if (is_from) is_from = before(unknown(edge + side*i)) == from
      end function is_from

      !> D: the points in front of the edge, the run among them, whose forces are within their bounds in the sum.
      pure integer(ip) function reach_of_excess() result(reach)
         real(wp) :: excess

         excess = 0.0_wp
         reach = 0
         do while (is_from(reach + 1) .and. (reach < m .or. excess > 0.0_wp))
            reach = reach + 1
            excess = excess + beyond(unknown(edge + side*reach), to)
         end do
      end function reach_of_excess

   end subroutine move_front

end module atrito_contact_fronts
