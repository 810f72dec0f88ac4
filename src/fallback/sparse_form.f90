!> Solving with the sparse form: all bodies in one matrix, the contact points as elements that change.
module atrito_sparse_form
   use atrito_condensed_body, only: check_held, loose_text
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_contact_solution, only: contact_solution_t, serves_as_start
   use atrito_controls, only: controls_t
   use atrito_kinds, only: ip, wp
   use atrito_multiplier_loop, only: solve_by_multipliers
   use atrito_reporter, only: report_progress
   use atrito_results, only: results_t
   use atrito_scene_data, only: scene_data_t, assemble, drop_assembled
   use atrito_row_entries, only: build_constraint_rows
   use atrito_scene_system, only: displacements_of
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   use atrito_timers, only: start_phase, stop_phase
   implicit none (type, external)
   private
   public :: solve_sparse_form

contains

   !> u: displacements without rigid motions. status: STATUS_SINGULAR with FREE_MOTION, or with a body that is singular by itself.
   subroutine solve_sparse_form(data, controls, results, solution, u, status)
      type(scene_data_t), intent(inout) :: data
      type(controls_t), intent(in) :: controls
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(out) :: solution
      real(wp), allocatable, intent(out) :: u(:, :)
      type(status_t), intent(out) :: status
      type(constraint_rows_t) :: rows
      real(wp), allocatable :: x(:)
      integer(ip) :: b

      call start_phase('assemble')
      do b = 1, data%fem%bodies%n                  ! a floating body that no contact point touches is held by nothing
         if (is_ok(status)) call check_held(data%fem, b, status)
      end do
      if (is_ok(status)) call assemble(data, status)
      call stop_phase('assemble')
      if (.not. is_ok(status)) return
      results%scene%near_elements = data%assembled%is_near
      call start_phase('iterate')
      call build_constraint_rows(data%fem, data%rows, data%line, .false., rows)
      call solve_rows(data, rows, controls, solution, x, status)
      results%factorisations = solution%factorisations
      call stop_phase('iterate')
      if (data%assembled%failed > 0) call name_failure(data, status)
      if (.not. allocated(x)) return
      u = data%value
      call displacements_of(data%fem, data%assembled, x, u)
      if (data%keeps) return
      call drop_assembled(data)                    ! the stresses want the memory of the factors
   end subroutine solve_sparse_form

   !> From the increment before, where that leads to a solution, else from the usual start.
   subroutine solve_rows(data, rows, controls, solution, x, status)
      type(scene_data_t), intent(inout) :: data
      type(constraint_rows_t), intent(in) :: rows
      type(controls_t), intent(in) :: controls
      type(contact_solution_t), intent(out) :: solution
      real(wp), allocatable, intent(out) :: x(:)
      type(status_t), intent(out) :: status
      type(contact_solution_t) :: fresh
      type(status_t) :: fine

      if (data%keeps) allocate (fresh%multipliers)
      if (serves_as_start(data%last, CONTACT_SPARSE)) then
         solution = data%last
         call solve_by_multipliers(data%assembled, rows, data%line, controls, data%reporter, solution, x, status)
         if (is_ok(status) .and. solution%converged) return
         call report_progress(data%reporter, 'not from the increment before; from the usual start')
         status = fine
         fresh%state%a = data%last%state%a
      end if
      solution = fresh
      call solve_by_multipliers(data%assembled, rows, data%line, controls, data%reporter, solution, x, status)
   end subroutine solve_rows

   !> A pivot that is not positive, by its body, node and dof.
   subroutine name_failure(data, status)
      type(scene_data_t), intent(in) :: data
      type(status_t), intent(inout) :: status
      integer(ip) :: b, node, dof

      associate (failed => data%assembled%failed, bodies => data%fem%bodies)
         do node = 1, data%fem%mesh%n_nodes
            b = bodies%of_node(node)
            if (b == 0) cycle
            do dof = 1, 2
               if (bodies%equation(dof, node) <= 0) cycle
               if (data%assembled%numbering%before(b) + bodies%equation(dof, node) /= failed) cycle
               call set_status(status, STATUS_SINGULAR, loose_text(data%fem, b, status%text, data%fem%mesh%node_id(node), dof))
               return
            end do
         end do
      end associate
   end subroutine name_failure

end module atrito_sparse_form
