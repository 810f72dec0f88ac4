!> A solution of the contact line as plain arrays, and back, so that a history can be interrupted: the increment behind it starts
!> from the same numbers, whether the run goes on or another one does.
!>
!> Factors are left out: they are larger than all else, and made anew. What they are used for depends on them in the last digits, so
!> a run that is recorded leaves its own, too.
module atrito_warm_start
   use atrito_contact_solution, only: contact_solution_t
   use atrito_kinds, only: ip
   use atrito_restart_state, only: warm_start_t
   implicit none (type, external)
   private
   public :: put_start, take_start

contains

   !> Without a solution, or where rows depend on each other, the next increment has the usual start.
   pure subroutine put_start(solution, start)
      type(contact_solution_t), allocatable, intent(in) :: solution
      type(warm_start_t), intent(out) :: start

      if (.not. allocated(solution)) return
      if (allocated(solution%rows) .or. .not. allocated(solution%state%q)) return
      start%form = int(solution%form, ip)
      if (allocated(solution%p)) start%p = solution%p
      if (allocated(solution%tau)) start%tau = solution%tau
      if (allocated(solution%t)) start%t = solution%t
      if (allocated(solution%is_shared)) start%is_shared = solution%is_shared
      if (allocated(solution%history%tangential_of)) start%tangential_of = solution%history%tangential_of
      start%residual = solution%residual
      start%contraction = solution%contraction
      associate (state => solution%state, bounds => solution%bounds)
         start%state = state%state
         start%q = state%q
         if (allocated(state%a)) start%a = state%a
         if (allocated(state%r)) start%r = state%r
         if (allocated(state%shift)) start%shift = state%shift
         start%slack = state%slack
         if (allocated(bounds%lower)) start%lower = bounds%lower
         if (allocated(bounds%upper)) start%upper = bounds%upper
         if (allocated(bounds%d)) start%d = bounds%d
      end associate
      start%has_multipliers = allocated(solution%multipliers)
      if (start%has_multipliers) call put_multipliers(solution, start)
   end subroutine put_start

   pure subroutine put_multipliers(solution, start)
      type(contact_solution_t), intent(in) :: solution
      type(warm_start_t), intent(inout) :: start

      associate (multipliers => solution%multipliers)
         start%step_size = multipliers%r
         start%pull_size = multipliers%kappa
         if (allocated(multipliers%x)) start%x = multipliers%x
         if (allocated(multipliers%e)) start%e = multipliers%e
         if (allocated(multipliers%noise)) start%noise = multipliers%noise
         if (allocated(multipliers%q_old)) start%q_old = multipliers%q_old
         if (allocated(multipliers%a_old)) start%a_old = multipliers%a_old
         if (allocated(multipliers%hold)) start%hold = multipliers%hold
         if (allocated(multipliers%pair)) start%pair = multipliers%pair
         if (allocated(multipliers%stiffness)) start%stiffness = multipliers%stiffness
         if (allocated(multipliers%pull)) start%pull = multipliers%pull
         start%n_pairs = multipliers%n_pairs
         start%n_contact_pairs = multipliers%n_contact_pairs
         start%settled = multipliers%settled
         start%changed = multipliers%changed
      end associate
   end subroutine put_multipliers

   !> A solution without factors. Not allocated: there is none to start from.
   pure subroutine take_start(start, solution)
      type(warm_start_t), intent(in) :: start
      type(contact_solution_t), allocatable, intent(out) :: solution

      if (start%form == 0) return
      allocate (solution)
      solution%form = int(start%form)
      solution%converged = .true.
      solution%inner%solved = .true.
      if (allocated(start%p)) solution%p = start%p
      if (allocated(start%tau)) solution%tau = start%tau
      if (allocated(start%t)) solution%t = start%t
      if (allocated(start%is_shared)) solution%is_shared = start%is_shared
      if (allocated(start%tangential_of)) solution%history%tangential_of = start%tangential_of
      solution%residual = start%residual
      solution%contraction = start%contraction
      if (allocated(start%state)) solution%state%state = start%state
      if (allocated(start%q)) solution%state%q = start%q
      if (allocated(start%a)) solution%state%a = start%a
      if (allocated(start%r)) solution%state%r = start%r
      if (allocated(start%shift)) solution%state%shift = start%shift
      solution%state%slack = start%slack
      if (allocated(start%lower)) solution%bounds%lower = start%lower
      if (allocated(start%upper)) solution%bounds%upper = start%upper
      if (allocated(start%d)) solution%bounds%d = start%d
      if (start%has_multipliers) call take_multipliers(start, solution)
   end subroutine take_start

   pure subroutine take_multipliers(start, solution)
      type(warm_start_t), intent(in) :: start
      type(contact_solution_t), intent(inout) :: solution

      allocate (solution%multipliers)                ! of no factorisation: the first step makes one
      associate (multipliers => solution%multipliers)
         multipliers%r = start%step_size
         multipliers%kappa = start%pull_size
         if (allocated(start%x)) multipliers%x = start%x
         if (allocated(start%e)) multipliers%e = start%e
         if (allocated(start%noise)) multipliers%noise = start%noise
         if (allocated(start%q_old)) multipliers%q_old = start%q_old
         if (allocated(start%a_old)) multipliers%a_old = start%a_old
         if (allocated(start%hold)) multipliers%hold = start%hold
         if (allocated(start%pair)) multipliers%pair = start%pair
         if (allocated(start%stiffness)) multipliers%stiffness = start%stiffness
         if (allocated(start%pull)) multipliers%pull = start%pull
         multipliers%n_pairs = start%n_pairs
         multipliers%n_contact_pairs = start%n_contact_pairs
         multipliers%settled = start%settled
         multipliers%changed = start%changed
      end associate
   end subroutine take_multipliers

end module atrito_warm_start
