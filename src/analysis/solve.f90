!> One static step, from the model to the results.
module atrito_solve
   use atrito_body_cache, only: body_cache_t
   use atrito_contact_form, only: CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE
   use atrito_contact_solution, only: contact_solution_t
   use atrito_controls, only: METHOD_ANDERSON
   use atrito_force_sense, only: force_sense_t, tell_forces, watch_forces
   use atrito_increment, only: is_solved, solve_increment
   use atrito_messages, only: add_note
   use atrito_model, only: model_t, step_t
   use atrito_number_range, only: is_out_of_range
   use atrito_reporter, only: reporter_t, report_place
   use atrito_restart_state, only: warm_start_t
   use atrito_results, only: results_t, scene_t
   use atrito_scene_data, only: scene_data_t, solve_options_t, PROOF_AUTO, PROOF_OFF, PROOF_ON, prepare, assemble, &
                                drop_assembled, check_known_points
   use atrito_scene_forecast, only: forecast_memory
   use atrito_scene_survey, only: describe_scene, describe_order, count_fronts, check_scene
   use atrito_solution_warnings, only: warn, idle_text
   use atrito_solver_choice, only: SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE
   use atrito_solution_search, only: search_solutions
   use atrito_solve_condensed, only: release_condensed
   use atrito_status, only: status_t, is_ok
   use atrito_timers, only: start_phase, stop_phase
   use atrito_unsettled_points, only: report_unsettled
   use atrito_warm_start, only: put_start, take_start
   implicit none (type, external)
   private
   public :: PROOF_AUTO, PROOF_OFF, PROOF_ON, solve_options_t, solve_static, survey_scene, begin_scene, note_method
   public :: SOLVER_AUTO, SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE
   public :: CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE

   integer, parameter :: SOLVER_AUTO = 0

contains

   !> What a scene needs, without solving it: for `check`, and for the listing. status: STATUS_DECK as in solve_static.
   subroutine survey_scene(model, options, scene, status)
      type(model_t), intent(in), target :: model   !< as built
      type(solve_options_t), intent(in) :: options !< form, solver and memory are read
      type(scene_t), intent(out) :: scene          !< what it needs
      type(status_t), intent(out) :: status        !< STATUS_OK, or that of begin_scene
      type(scene_data_t) :: data
      type(body_cache_t) :: store

      call begin_scene(model, options, store, .true., data, scene, status)
   end subroutine survey_scene

   !> Everything before the first number is computed. status: STATUS_DECK as in solve_static.
   subroutine begin_scene(model, options, store, exact, data, scene, status, step)
      type(model_t), intent(in), target :: model            !< as built; looked at as long as data are used
      type(solve_options_t), intent(in) :: options          !< form, solver, memory, viewer and distribution
      type(body_cache_t), intent(in) :: store               !< bodies of an earlier run, or none
      logical, intent(in) :: exact                          !< all fronts are counted, before a run makes them
      type(scene_data_t), intent(out) :: data               !< what the solver works on
      type(scene_t), intent(out) :: scene                   !< what it needs, bodies as expected
      type(status_t), intent(out) :: status                 !< STATUS_OK, or why nothing can be solved
      type(step_t), intent(in), target, optional :: step    !< left out: the first of the model

      call start_phase('order')
      call prepare(model, store, options, data, status, step)
      if (data%is_distributed) then
         ! The memory of all processes is asked for before their parts are made, for METIS, which cuts the scene, ends the program
         ! when it has too little; and again before the parts are factored.
         if (is_ok(status)) call describe_scene(data, scene)
         if (is_ok(status)) call data%distribution%check_memory(data, options%memory, scene, status)
         if (is_ok(status)) call assemble(data, status)
         if (is_ok(status)) call describe_order(data, scene)
         if (is_ok(status)) call data%distribution%check_memory(data, options%memory, scene, status)
         call stop_phase('order')
      else
         if (is_ok(status) .and. data%contact_form == CONTACT_SPARSE) call assemble(data, status)
         if (is_ok(status)) call describe_scene(data, scene)
         if (is_ok(status)) call count_fronts(data, exact, scene)
         call stop_phase('order')
         if (is_ok(status)) call check_scene(model, options%memory, scene, status)
      end if
      if (is_ok(status)) call check_known_points(data, status)
      if (is_ok(status) .and. associated(data%viewer)) call data%viewer%check(data, status)
   end subroutine begin_scene

   !> Solves. status: STATUS_SINGULAR (free motion, singular body, dependent points), STATUS_DECK (contradiction of prescribed
   !> displacements and hard contact; too little memory, which is told by a message). results%converged and law_holds tell the rest.
   !>
   !> start: a solution near this one, of other loads, say; what its iteration ended with, once there is a solution. The sparse form
   !> begins from it.
   subroutine solve_static(model, options, reporter, results, status, store, others, start)
      type(model_t), intent(in), target :: model           !< as built, of one increment
      type(solve_options_t), intent(in) :: options         !< as asked for
      type(reporter_t), intent(in) :: reporter             !< tells how far the work is
      type(results_t), intent(out) :: results              !< of the first solution that counts
      type(status_t), intent(out) :: status                !< STATUS_OK, or why there is no solution
      type(body_cache_t), intent(inout) :: store           !< bodies of an earlier run, or none; on return those of this one
      type(results_t), allocatable, intent(out), optional :: others(:) !< other solutions that a search has found
      type(warm_start_t), intent(inout), optional :: start !< left out: from nothing
      type(scene_data_t) :: data
      type(contact_solution_t) :: solution
      type(force_sense_t) :: sense
      type(results_t), allocatable :: found(:)

      call begin_scene(model, options, store, .false., data, results%scene, status)
      if (is_ok(status)) then
         data%reporter = reporter
         call report_place(reporter, 'solve', is_phase=.true.)
         data%keeps = associated(data%viewer) .or. data%starts > 0     ! C and G of the bodies, for views and searches
         call note_method(data, model%steps(1:1))
         if (present(start)) call begin_from(start, data)
         call solve_increment(data, options%contact_form, store, results, solution, status)
         if (present(start) .and. is_solved(results, status)) call put_start(solution, start)
         if (is_solved(results, status)) call search_solutions(data, store, solution, results, found)
         if (present(others)) call move_alloc(found, others)
         if (data%keeps) call release_condensed(data, store)
      end if
      call drop_assembled(data)
      if (.not. is_ok(status)) return
      ! with the fronts that the bodies have in place of those that were expected
      results%scene%memory = forecast_memory(model, data, results%scene)
      if (is_out_of_range(results)) return                  ! and so is what could be told of its points and motions
      call report_unsettled(data%fem%mesh, data%points, data%rows, data%line, solution, results)
      call warn(data, solution, results, idle_text(data, solution))
      if (.not. is_solved(results, status)) return
      call watch_forces(data, results, sense)
      call tell_forces(results%scene%pairs, results%contact, sense)
   end subroutine solve_static

   !> Begins from a solution near by where the unknowns are as many.
   subroutine begin_from(start, data)
      type(warm_start_t), intent(in) :: start
      type(scene_data_t), intent(inout) :: data

      if (data%contact_form /= CONTACT_SPARSE) return
      data%keeps = .true.
      if (start%form /= CONTACT_SPARSE .or. .not. allocated(start%multipliers)) return
      if (size(start%state%q) /= size(data%line%point) .or. size(start%multipliers%x) /= data%assembled%n) return
      call take_start(start, data%last)
      data%only_from_last = allocated(data%last) .and. data%is_brief
   end subroutine begin_from

   !> Methods that the form of the scene does not have.
   subroutine note_method(data, steps)
      type(scene_data_t), intent(in) :: data                !< its form is read
      type(step_t), intent(in) :: steps(:)                  !< that the scene serves

      if (data%contact_form /= CONTACT_SPARSE .or. all(steps%controls%method == METHOD_ANDERSON)) return
      call add_note('N-METHOD', 'METHOD is one of the dense form of the contact system; the sparse one, which was taken, has' &
                    //' its own')
   end subroutine note_method

end module atrito_solve
