!> What changed from one linear solve of the contact line to the next: the rows of iterations.tab.
!>
!> An outer iteration freezes the friction bounds; the inner ones are the linear solves that find the states for them.
!> Of each solve are recorded the changes of displacements, pressures and friction from the solve before, |now -
!> before|/|now| in the largest norm, the residual of the bounds that the last outer iteration ended with, and how many
!> points are open, stick and slip. The states at the end of the last OUTER_KEPT outer iterations are kept, to tell of
!> points that do not come to rest when a loop does not converge.
module atrito_solve_history
   use atrito_kinds, only: ip, wp
   use atrito_controls, only: iteration_t
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE, FROZEN
   implicit none (type, external)
   private
   public :: solve_history_t, solve_log_t, record_solve, restart_history, begin_outer, end_outer, state_letters, OUTER_KEPT

   integer(ip), parameter :: OUTER_KEPT = 8          !< outer iterations whose states are kept
   !> State of a point: open, closed without a tangential unknown, sticking, slipping along T and against it.
   integer(ip), parameter :: IS_OPEN = 1, IS_CLOSED = 2, IS_STUCK = 3, SLIPS_ALONG = 4, SLIPS_AGAINST = 5
   character(len=1), parameter :: LETTERS(5) = ['o', 'c', '=', '+', '-']
   !> State of a closed point by that of its tangential unknown.
   integer(ip), parameter :: BY_TANGENTIAL(FREE:FROZEN) = [IS_STUCK, SLIPS_AGAINST, SLIPS_ALONG, IS_CLOSED]

   !> The first MOST_LOGGED linear solves in full, where they are asked for (bound_qp_t%is_logged).
   type :: solve_log_t
      integer(ip), allocatable :: states(:, :)       !< (n_normal, MOST_LOGGED) of points, as state_letters has them; 0: no point
      real(wp), allocatable :: q(:, :), upper(:, :)  !< (m, MOST_LOGGED) forces and their upper bounds [F]
   end type solve_log_t
   integer(ip), parameter :: MOST_LOGGED = 500

   type :: solve_history_t
      integer(ip) :: n = 0 !< records that are used
      type(iteration_t), allocatable :: records(:) !< (>= n) one a linear solve
      integer(ip) :: outer = 0, inner = 0          !< the iteration, and the solve in it, that comes last
      real(wp) :: last_residual = 1.0_wp             !< of the friction bounds, at the end of the last outer iteration
      real(wp), allocatable :: moved(:), stress(:)   !< of the solve before
      integer(ip), allocatable :: tangential_of(:)   !< (n_normal) tangential unknown of the same point; 0: none; < 0: no contact
      integer(ip), allocatable :: states(:, :)       !< (n_normal, OUTER_KEPT) at the end of the last outer iterations, oldest first
      integer(ip) :: kept = 0                        !< of them there are
      type(solve_log_t) :: log                       !< its arrays are not allocated where nobody asked for it
   end type solve_history_t

contains

   !> Nothing is recorded yet, of the same unknowns: a loop goes on from the solution of the increment before.
   pure subroutine restart_history(history)
      type(solve_history_t), intent(inout) :: history !< empty, out
      type(solve_history_t) :: new

      if (allocated(history%tangential_of)) new%tangential_of = history%tangential_of
      history = new
   end subroutine restart_history

   !> The next outer iteration begins, with frozen friction bounds; its inner solves are counted from 1.
   pure subroutine begin_outer(history)
      type(solve_history_t), intent(inout) :: history !< with an outer iteration more

      history%outer = history%outer + 1
      history%inner = 0
   end subroutine begin_outer

   !> An outer iteration ended with this residual of the friction bounds.
   pure subroutine end_outer(history, residual)
      type(solve_history_t), intent(inout) :: history !< its last record gets the residual
      real(wp), intent(in) :: residual              !< |nu S_rho(p) - tau|/|tau|

      history%last_residual = residual
      if (history%n > 0) history%records(history%n)%residual = residual
   end subroutine end_outer

   !> Records a solve: a row of iterations.tab. What is compared from solve to solve are the displacements r + D q of
   !> the points (the opening or slip, without what the laws give way) and the stresses q/w.
   pure subroutine record_solve(history, problem, bounds, state)
      type(solve_history_t), intent(inout) :: history !< with a record more
      type(bound_qp_t), intent(in) :: problem       !< of which the shape counts
      type(box_bounds_t), intent(in) :: bounds      !< of the m forces: a slip is a force at its bound
      type(box_state_t), intent(in) :: state        !< after the solve
      type(iteration_t) :: record
      real(wp) :: moved(problem%m), stress(problem%m)
      integer(ip) :: n

      n = problem%n_normal
      moved = state%r + bounds%d*state%q
      stress = state%q/problem%weight
      if (allocated(history%tangential_of)) then
         where (history%tangential_of < 0) stress(:n) = 0.0_wp
      end if
      if (.not. allocated(history%moved)) then
         allocate (history%moved(problem%m), history%stress(problem%m), source=0.0_wp)
         allocate (history%records(64))
      end if
      history%inner = history%inner + 1
      record%outer = history%outer
      record%inner = history%inner
      record%change_displacement = relative_change(moved, history%moved)
      record%change_pressure = relative_change(stress(:n), history%stress(:n))
      record%change_friction = relative_change(stress(n + 1:), history%stress(n + 1:))
      record%residual = history%last_residual
      call count_states(history, problem, state, record)
      history%moved = moved
      history%stress = stress
      if (history%n == size(history%records)) history%records = [history%records, history%records]   ! doubled
      history%n = history%n + 1
      history%records(history%n) = record
      if (problem%is_logged .and. history%n <= MOST_LOGGED) call log_solve(bounds, state, history)
   end subroutine record_solve

   !> Keeps the last solve.
   pure subroutine log_solve(bounds, state, history)
      type(box_bounds_t), intent(in) :: bounds
      type(box_state_t), intent(in) :: state        !< after the solve
      type(solve_history_t), intent(inout) :: history
      integer(ip) :: m

      m = size(state%q, kind=ip)
      associate (log => history%log, n => history%n)
         if (.not. allocated(log%q)) then
            allocate (log%states(size(history%states, 1), MOST_LOGGED), source=0_ip)
            allocate (log%q(m, MOST_LOGGED), log%upper(m, MOST_LOGGED), source=0.0_wp)
         end if
         log%states(:, n) = history%states(:, max(history%kept, 1_ip))
         log%q(:, n) = state%q
         log%upper(:, n) = bounds%upper
      end associate
   end subroutine log_solve

   !> |now - before|/|now| in the largest norm; 0 where there is nothing now.
   pure real(wp) function relative_change(now, before) result(change)
      real(wp), intent(in) :: now(:), before(:)     !< of this solve and the one before
      real(wp) :: scale

      change = 0.0_wp
      if (size(now) == 0) return
      scale = maxval(abs(now))
      if (scale > 0.0_wp) change = maxval(abs(now/scale - before/scale))
   end function relative_change

   !> Counts the states of points: those without pressure are open; of the closed ones those whose tangential unknown is
   !> free stick, the others slip. The states of the last solve of each outer iteration are kept, OUTER_KEPT of them,
   !> the oldest going first.
   pure subroutine count_states(history, problem, state, record)
      type(solve_history_t), intent(inout) :: history
      type(bound_qp_t), intent(in) :: problem       !< of which the shape counts
      type(box_state_t), intent(in) :: state        !< after the solve
      type(iteration_t), intent(inout) :: record    !< its counts of states are set
      integer(ip) :: now(problem%n_normal), i

      now = [(point_state(history, state, i), i=1, problem%n_normal)]
      record%open = count(now == IS_OPEN, kind=ip)
      record%stick = count(now == IS_STUCK, kind=ip)
      record%slip = count(now > 0, kind=ip) - record%open - record%stick
      ! the last solve of an outer iteration counts
      if (.not. allocated(history%states)) allocate (history%states(size(now), OUTER_KEPT), source=0_ip)
      if (record%inner == 1 .and. history%kept == OUTER_KEPT) history%states(:, :OUTER_KEPT - 1) = history%states(:, 2:)
      if (record%inner == 1 .and. history%kept < OUTER_KEPT) history%kept = history%kept + 1
      history%states(:, max(history%kept, 1_ip)) = now
   end subroutine count_states

   !> The state of a point, IS_OPEN and so on; 0 of a bilateral row, which is no point of contact.
   pure integer(ip) function point_state(history, state, i) result(now)
      type(solve_history_t), intent(in) :: history
      type(box_state_t), intent(in) :: state        !< after the solve
      integer(ip), intent(in) :: i                   !< normal unknown
      integer(ip) :: t

      t = 0
      if (allocated(history%tangential_of)) t = history%tangential_of(i)
      if (t < 0) then
         now = 0
      else if (state%state(i) /= FREE) then
         now = IS_OPEN
      else if (t == 0) then
         now = IS_CLOSED
      else
         now = IS_CLOSED                             ! on its way to a bound, too (atrito_goldfarb_idnani)
         if (state%state(t) <= FROZEN) now = BY_TANGENTIAL(state%state(t))
      end if
   end function point_state

   !> A letter a state: o open, c closed without friction, = sticking, + slipping along T, - against it.
   pure function state_letters(states) result(text)
      integer(ip), intent(in) :: states(:)          !< IS_OPEN and so on
      character(len=size(states)) :: text
      integer :: i

      do i = 1, size(states)
         text(i:i) = LETTERS(states(i))
      end do
   end function state_letters

end module atrito_solve_history
