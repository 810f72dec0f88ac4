!> Solving with the dense form: bodies condensed to their contact dofs, and the flexibility of all points.
module atrito_dense_form
   use atrito_base_loads, only: forget_reduced, load_bodies
   use atrito_body_cache, only: body_cache_t, provide_bodies, reload_bodies, release_bodies, forget_bodies, forget_loads
   use atrito_bound_qp, only: bound_qp_t, DEPENDENT_POINTS
   use atrito_contact_form, only: CONTACT_DENSE
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_problem, only: build_flexibility, set_right_hand_sides
   use atrito_contact_solution, only: contact_solution_t, serves_as_start, asks_no_force, let_rest
   use atrito_controls, only: controls_t, METHOD_ANDERSON
   use atrito_dense_refinement, only: refine_dense_solution
   use atrito_displacements, only: contact_forces, elastic_displacements
   use atrito_kinds, only: ip, wp
   use atrito_outer_loop, only: solve_contact_line, continue_contact_line
   use atrito_reporter, only: report_progress
   use atrito_results, only: results_t
   use atrito_scene_data, only: scene_data_t, free_load
   use atrito_solve_history, only: restart_history
   use atrito_shared_points, only: has_dependent_points, solve_shared_points
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   use atrito_strings, only: to_text
   use atrito_timers, only: start_phase, stop_phase
   use atrito_uniqueness, only: estimate_contraction
   implicit none (type, external)
   private
   public :: solve_dense_form

contains

   !> u: displacements without rigid motions. status: STATUS_SINGULAR of provide_bodies and solve_contact_line.
   subroutine solve_dense_form(data, controls, store, results, solution, u, status)
      type(scene_data_t), intent(inout) :: data
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(out) :: solution
      real(wp), allocatable, intent(out) :: u(:, :)
      type(status_t), intent(out) :: status
      type(bound_qp_t), allocatable :: problem
      logical :: is_right

      call move_alloc(data%flexibility, problem)
      call solve_condensed(data, controls, store, results, problem, solution, u, status)
      if (is_ok(status) .and. solution%converged .and. results%scene%near_elements) then
         call start_phase('refine')
         call refine_dense_solution(data, controls, store%bodies, problem, solution, u, is_right)
         call stop_phase('refine')
         if (.not. is_right) then
            call report_progress(data%reporter, 'refinement does not converge; each element with its own last digits')
            data%fem%grain = 0.0_wp
            call forget_bodies(store)
            deallocate (problem)
            if (allocated(data%last)) deallocate (data%last)
            call solve_condensed(data, controls, store, results, problem, solution, u, status)
         end if
      end if
      if (allocated(solution%state%a) .and. has_position(data, solution%state%a)) then
         solution%state%a = solution%state%a + data%last%state%a
      end if
      if (data%keeps) then
         call move_alloc(problem, data%flexibility)
      else
         call release_bodies(store)
      end if
   end subroutine solve_dense_form

   !> Whether it is known where the bodies were in the increment before: amplitudes count from there, so that a motion that nothing
   !> determines is none.
   pure logical function has_position(data, a)
      type(scene_data_t), intent(in) :: data
      real(wp), intent(in) :: a(:)                   !< amplitudes of the rigid motions [L]

      has_position = serves_as_start(data%last, CONTACT_DENSE)
      if (has_position) has_position = allocated(data%last%state%a)
      if (has_position) has_position = size(data%last%state%a) == size(a)
   end function has_position

   !> Solves with the bodies as they are factored.
   subroutine solve_condensed(data, controls, store, results, problem, solution, u, status)
      type(scene_data_t), intent(inout) :: data
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(bound_qp_t), allocatable, intent(inout) :: problem !< with C and G, where the bodies are those of the increment before
      type(contact_solution_t), intent(out) :: solution
      real(wp), allocatable, intent(out) :: u(:, :)
      type(status_t), intent(out) :: status

      store%reporter = data%reporter
      call provide_loaded_bodies(data, store, results, problem, status)
      if (.not. is_ok(status)) return
      call start_phase('iterate')
      if (.not. allocated(problem)) then
         allocate (problem)
         call build_flexibility(data%fem, store%bodies, data%rows, data%line, problem)
      end if
      call set_right_hand_sides(data%fem, store%bodies, data%rows, data%line, data%value, data%f, problem)
      if (has_position(data, problem%h)) problem%g0 = problem%g0 + matmul(problem%g, data%last%state%a)
      problem%is_coarse = controls%is_coarse
      call solve_line(data, controls, problem, solution, status)
      if (is_ok(status) .and. data%is_printed) then
         results%contraction_estimate = estimate_contraction(problem, data%line, solution%bounds%d, solution%state%state)
      end if
      call stop_phase('iterate')
      if (.not. is_ok(status)) call explain_failure(data, problem, solution, status)
      if (allocated(solution%p)) call expand_bodies(data, store, solution, u)
   end subroutine solve_condensed

   !> The bodies with the loads of the increment; those of the increment before stay as they are factored.
   subroutine provide_loaded_bodies(data, store, results, problem, status)
      type(scene_data_t), intent(inout) :: data
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(bound_qp_t), allocatable, intent(inout) :: problem
      type(status_t), intent(out) :: status

      if (allocated(problem) .and. allocated(store%bodies)) then
         if (.not. allocated(data%bases)) call reload_bodies(store, data%fem, free_load(data))
      else
         if (allocated(problem)) deallocate (problem)
         call forget_reduced(data%bases)
         call provide_bodies(store, data%fem, data%held, data%points, free_load(data), data%solver_kind, results%scene%bodies, &
                             status, data%model%bilateral)
         results%factorisations = store%factorisations
      end if
      if (is_ok(status) .and. allocated(data%bases)) then
         call start_phase('factor')
         call load_bodies(data%fem, data%bases, store%bodies)
         call forget_loads(store)
         call stop_phase('factor')
      end if
      if (is_ok(status)) results%scene%near_elements = any(store%bodies%is_near)
   end subroutine provide_loaded_bodies

   !> Solves the contact line: from the increment before, where that leads to a solution, else from the usual start.
   subroutine solve_line(data, controls, problem, solution, status)
      type(scene_data_t), intent(in) :: data
      type(controls_t), intent(in) :: controls
      type(bound_qp_t), intent(in) :: problem
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(contact_solution_t) :: nothing
      type(status_t) :: fine

      if (all(problem%h == 0.0_wp) .and. asks_no_force(data%line, problem, problem%g0)) then
         call let_rest(data%line, problem, problem%g0, solution)
         return
      end if
      if (serves_as_start(data%last, CONTACT_DENSE) .and. controls%method == METHOD_ANDERSON) then
         solution = data%last
         if (has_position(data, problem%h)) solution%state%a = 0.0_wp
         call restart_history(solution%history)
         call continue_contact_line(problem, data%line, controls, data%reporter, solution, status)
         if (is_ok(status) .and. solution%converged) return
         call report_progress(data%reporter, 'not from the increment before; from the usual start')
         solution = nothing
         status = fine
      end if
      if (gives_way_nowhere(problem, data%line)) then
         call set_status(status, STATUS_SINGULAR, DEPENDENT_POINTS)
      else
         call solve_contact_line(problem, data%line, controls, data%reporter, solution, status)
      end if
      if (has_dependent_points(status)) call solve_shared_points(problem, data%fem, data%rows, data%line, controls, data%reporter, &
                                                                 solution, status)
   end subroutine solve_line
   !> Whether a force displaces nothing but rigid surfaces, and its law does not give way: a held node faces one that moves, an
   !> equation joins two of them.
   pure logical function gives_way_nowhere(problem, line) result(nowhere)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      integer(ip) :: i

      nowhere = .false.
      do i = 1, problem%m
         if (problem%c(i, i) > 0.0_wp) cycle
         nowhere = nowhere .or. i > problem%n_normal .or. .not. line%delta(line%point(i)) > 0.0_wp
      end do
   end function gives_way_nowhere

   !> Puts a failure of the contact line into words.
   subroutine explain_failure(data, problem, solution, status)
      type(scene_data_t), intent(in) :: data
      type(bound_qp_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      type(status_t), intent(inout) :: status
      integer(ip) :: node

      if (status%text == DEPENDENT_POINTS) then
         node = data%rows%node(data%rows%first(data%line%point(solution%inner%dependent)))
         call set_status(status, STATUS_SINGULAR, 'the contact point at node '//to_text(data%fem%mesh%node_id(node)) &
                         //trim(merge(' (normal)    ', ' (tangential)', solution%inner%dependent <= problem%n_normal)) &
                         //' repeats what other points ask: two pairs share it, or the slave is finer than its own dofs')
      end if
   end subroutine explain_failure

   !> The displacements of all bodies without their rigid motions.
   subroutine expand_bodies(data, store, solution, u)
      type(scene_data_t), intent(in) :: data
      type(body_cache_t), intent(in) :: store
      type(contact_solution_t), intent(in) :: solution
      real(wp), allocatable, intent(out) :: u(:, :)
      real(wp), allocatable :: contact(:, :)
      integer(ip) :: b

      call start_phase('recover')
      contact = contact_forces(data%fem, data%rows, data%line, solution)
      u = data%value
      do b = 1, data%fem%bodies%n
         call elastic_displacements(data%fem, b, store%bodies(b), contact, u)
      end do
      call stop_phase('recover')
   end subroutine expand_bodies

end module atrito_dense_form
