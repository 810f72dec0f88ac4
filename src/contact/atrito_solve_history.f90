!> What changed from one linear solve of the contact line to the next: the rows of iterations.tab.
module atrito_solve_history
   use atrito_kinds, only: ip, wp
   use atrito_box_problem, only: box_problem_t, box_bounds_t, box_state_t, FREE
   implicit none (type, external)
   private
   public :: solve_record_t, solve_history_t, record_solve, begin_outer, end_outer

   type :: solve_record_t
      integer(ip) :: outer = 0, inner = 0
      real(wp) :: change_displacement = 0.0_wp, change_pressure = 0.0_wp, change_friction = 0.0_wp
      integer(ip) :: open = 0, stick = 0, slip = 0
      real(wp) :: residual = 0.0_wp
   end type solve_record_t

   type :: solve_history_t
      integer(ip) :: n = 0
      type(solve_record_t), allocatable :: records(:)
      integer(ip) :: outer = 0, inner = 0
      real(wp) :: last_residual = 1.0_wp             !< of the friction bounds, at the end of the last outer iteration
      real(wp), allocatable :: moved(:), stress(:)   !< of the solve before
      integer(ip), allocatable :: tangential_of(:)   !< (n_normal) tangential unknown of the same point; 0: none
   end type solve_history_t

contains

   !> The next outer iteration begins.
   pure subroutine begin_outer(history)
      type(solve_history_t), intent(inout) :: history

      history%outer = history%outer + 1
      history%inner = 0
   end subroutine begin_outer

   !> An outer iteration ended with this residual of the friction bounds.
   pure subroutine end_outer(history, residual)
      type(solve_history_t), intent(inout) :: history
      real(wp), intent(in) :: residual

      history%last_residual = residual
      if (history%n > 0) history%records(history%n)%residual = residual
   end subroutine end_outer

   !> Records a solve.
   pure subroutine record_solve(history, problem, bounds, state)
      type(solve_history_t), intent(inout) :: history
      type(box_problem_t), intent(in) :: problem
      type(box_bounds_t), intent(in) :: bounds
      type(box_state_t), intent(in) :: state
      type(solve_record_t) :: record
      type(solve_record_t), allocatable :: longer(:)
      real(wp) :: moved(problem%m), stress(problem%m)
      integer(ip) :: n

      n = problem%n_normal
      moved = state%r + bounds%d*state%q
      stress = state%q/problem%weight
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
      if (history%n == size(history%records)) then
         allocate (longer(2*history%n))
         longer(:history%n) = history%records
         call move_alloc(longer, history%records)
      end if
      history%n = history%n + 1
      history%records(history%n) = record
   end subroutine record_solve

   pure real(wp) function relative_change(now, before) result(change)
      real(wp), intent(in) :: now(:), before(:)
      real(wp) :: scale

      change = 0.0_wp
      if (size(now) == 0) return
      scale = maxval(abs(now))
      if (scale > 0.0_wp) change = maxval(abs(now/scale - before/scale))
   end function relative_change

   !> Points without pressure are open; of the closed ones those whose tangential unknown is free stick, the others slip.
   pure subroutine count_states(history, problem, state, record)
      type(solve_history_t), intent(in) :: history
      type(box_problem_t), intent(in) :: problem
      type(box_state_t), intent(in) :: state
      type(solve_record_t), intent(inout) :: record
      integer(ip) :: i, t

      do i = 1, problem%n_normal
         t = 0
         if (allocated(history%tangential_of)) t = history%tangential_of(i)
         if (state%state(i) /= FREE) then
            record%open = record%open + 1
         else if (t == 0) then
            record%slip = record%slip + 1
         else if (state%state(t) == FREE) then
            record%stick = record%stick + 1
         else
            record%slip = record%slip + 1
         end if
      end do
   end subroutine count_states

end module atrito_solve_history
