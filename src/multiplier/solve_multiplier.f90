!> The multiplier form: one increment with all bodies in one sparse matrix, the contact points as elements that change
!> (atrito_assembled_scene), by the proximal method of multipliers (atrito_multiplier_loop).
!>
!> Nothing is condensed and no matrix is full, so long lines and many bodies cost as much as their factors do. The answer is that
!> of the condensed form (atrito_solve_condensed): both end in the same `contact_solution_t`.
module atrito_solve_multiplier
   use atrito_condensed_body, only: loose_text
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_contact_solution, only: contact_solution_t, serves_as_start
   use atrito_controls, only: controls_t
   use atrito_kinds, only: ip, wp
   use atrito_multiplier_loop, only: solve_by_multipliers
   use atrito_problem, only: problem_t
   use atrito_reporter, only: report_progress
   use atrito_row_entries, only: build_constraint_rows
   use atrito_scene_system, only: scene_system_t, displacements_of
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   implicit none (type, external)
   private
   public :: solve_multiplier

contains

   !> Solves one increment: from the increment before, where that leads to a solution, else from the usual start.
   !> status: STATUS_SINGULAR with FREE_MOTION, or with a body that is singular by itself.
   !>
   !> The loop keeps the multipliers in the solution where a next increment goes on from them (problem%keeps). What failed from
   !> there begins anew, but counts amplitudes of motions from the same place; unless no other start is to be tried.
   subroutine solve_multiplier(problem, system, controls, solution, u, status)
      class(problem_t), intent(in) :: problem !< the increment
      class(scene_system_t), intent(inout) :: system        !< of the problem, with its gaps and loads
      type(controls_t), intent(in) :: controls !< method, tolerance, MAXIT
      type(contact_solution_t), intent(out) :: solution !< states, forces, stresses, verdict
      real(wp), allocatable, intent(out) :: u(:, :)         !< displacements without rigid motions, (2, n_nodes) [L]
      type(status_t), intent(out) :: status
      type(contact_solution_t) :: fresh
      logical :: begins
      type(constraint_rows_t) :: rows
      type(status_t) :: fine
      real(wp), allocatable :: x(:)

      call build_constraint_rows(problem%fem, problem%rows, problem%line, .false., rows)
      if (problem%keeps) allocate (fresh%multipliers)
      begins = .true.
      if (serves_as_start(problem%last, CONTACT_SPARSE)) then
         solution = problem%last
         call solve_by_multipliers(system, rows, problem%line, controls, problem%reporter, solution, x, status)
         begins = .not. (problem%only_from_last .or. (is_ok(status) .and. solution%converged))
         if (begins) then
            call report_progress(problem%reporter, 'not from the increment before; from the usual start')
            status = fine
            fresh%state%a = problem%last%state%a
         end if
      end if
      if (begins) then
         solution = fresh
         call solve_by_multipliers(system, rows, problem%line, controls, problem%reporter, solution, x, status)
      end if
      if (system%failed > 0) call name_failure()
      if (.not. allocated(x)) return
      solution%flexibility = system%flexibility
      u = problem%value
      call displacements_of(problem%fem, system, x, u)

   contains

      !> A pivot that is not positive, by its body, node and dof.
      subroutine name_failure()
         integer(ip) :: b, node, dof

         associate (bodies => problem%fem%bodies)
            do node = 1, problem%fem%mesh%n_nodes
               b = bodies%of_node(node)
               if (b == 0) cycle
               do dof = 1, 2
                  if (bodies%equation(dof, node) <= 0) cycle
                  if (system%numbering%before(b) + bodies%equation(dof, node) /= system%failed) cycle
                  call set_status(status, STATUS_SINGULAR, &
                                  loose_text(problem%fem, b, status%text, problem%fem%mesh%node_id(node), dof))
                  return
               end do
            end do
         end associate
      end subroutine name_failure

   end subroutine solve_multiplier

end module atrito_solve_multiplier
