!> A solution of the contact line without its factors, and back, so that a history can be interrupted: the increment behind it
!> starts from the same numbers, whether the run goes on or another one does.
!>
!> Factors are larger than all else, and made anew. What they are used for depends on them in the last digits, so a run that is
!> recorded leaves its own, too.
module atrito_warm_start
   use atrito_contact_solution, only: contact_solution_t
   use atrito_kinds, only: ip
   use atrito_restart_state, only: warm_start_t
   implicit none (type, external)
   private
   public :: put_start, take_start

contains

   !> What the next increment starts from; nothing where rows depend on each other.
   pure subroutine put_start(solution, start)
      type(contact_solution_t), intent(in) :: solution !< of the increment that converged
      type(warm_start_t), intent(out) :: start         !< form 0: nothing to start from

      if (allocated(solution%rows) .or. .not. allocated(solution%state%q)) return
      start%form = int(solution%form, ip)
      if (allocated(solution%p)) start%p = solution%p
      if (allocated(solution%tau)) start%tau = solution%tau
      if (allocated(solution%t)) start%t = solution%t
      if (allocated(solution%is_shared)) start%is_shared = solution%is_shared
      if (allocated(solution%history%tangential_of)) start%tangential_of = solution%history%tangential_of
      start%residual = solution%residual
      start%contraction = solution%contraction
      start%state = solution%state
      start%bounds = solution%bounds
      if (.not. allocated(solution%multipliers)) return
      start%multipliers = solution%multipliers
      associate (multipliers => start%multipliers)   ! what belongs to a factorisation, or is counted, begins anew
         if (allocated(multipliers%part)) deallocate (multipliers%part)
         if (allocated(multipliers%before)) deallocate (multipliers%before)
         multipliers%factorisations = 0
         multipliers%solves = 0
         multipliers%generation = -1
      end associate
   end subroutine put_start

   !> A solution without factors: the first step makes one. Not allocated: there is none to start from.
   pure subroutine take_start(start, solution)
      type(warm_start_t), intent(in) :: start                        !< of put_start, or of a file
      type(contact_solution_t), allocatable, intent(out) :: solution !< counts as converged

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
      solution%state = start%state
      solution%bounds = start%bounds
      if (allocated(start%multipliers)) solution%multipliers = start%multipliers
   end subroutine take_start

end module atrito_warm_start
