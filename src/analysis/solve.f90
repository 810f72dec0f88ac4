!> One static step, from the model to the results.
module atrito_solve
   use atrito_assembly, only: body_profile
   use atrito_body_cache, only: body_cache_t
   use atrito_body_cost, only: choose_solver, estimate_body_memory, count_body_memory
   use atrito_contact_form, only: CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE, contact_form_name
   use atrito_contact_solution, only: contact_solution_t
   use atrito_controls, only: METHOD_ANDERSON
   use atrito_force_sense, only: force_sense_t, tell_forces, watch_forces
   use atrito_increment, only: is_solved, search_solutions, solve_increment
   use atrito_kinds, only: ip, lp
   use atrito_memory, only: available_memory, held_memory, resident_memory
   use atrito_messages, only: add_note
   use atrito_model, only: model_t, step_t
   use atrito_number_range, only: is_out_of_range
   use atrito_points, only: contact_points_t
   use atrito_profile, only: profile_t
   use atrito_reporter, only: reporter_t, report_place
   use atrito_restart_state, only: warm_start_t
   use atrito_results, only: results_t, scene_t, body_result_t, pair_scene_t
   use atrito_scene_data, only: scene_data_t, solve_options_t, PROOF_AUTO, PROOF_OFF, PROOF_ON, prepare, assemble, &
                                drop_assembled, check_known_points
   use atrito_scene_forecast, only: forecast_memory
   use atrito_scene_memory, only: check_memory
   use atrito_solution_warnings, only: warn, idle_text, report_unsettled
   use atrito_solver_choice, only: SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE
   use atrito_solve_condensed, only: release_condensed
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: to_text, append_string
   use atrito_system, only: peak_memory
   use atrito_timers, only: start_phase, stop_phase
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

   !> Fills what `check` and the listing print of a scene.
   subroutine describe_scene(data, scene)
      type(scene_data_t), intent(in) :: data     !< prepared, nothing factored
      type(scene_t), intent(out) :: scene        !< whole
      integer(ip) :: b

      allocate (scene%bodies(data%fem%bodies%n))
      do b = 1, data%fem%bodies%n
         call describe_body(scene%bodies(b))
         scene%n_dofs = scene%n_dofs + scene%bodies(b)%n_equations
         scene%n_rigid = scene%n_rigid + scene%bodies(b)%n_free_motions
      end do
      call describe_pairs()
      scene%n_normal = count(data%line%normal > 0, kind=ip)
      scene%n_rows = count(data%line%normal(data%line%n - data%line%n_bilateral + 1:) > 0, kind=ip)
      scene%n_tangential = count(data%line%tangential > 0, kind=ip)
      scene%outer_loop = data%line%has_friction
      scene%contact_form = contact_form_name(data%contact_form)
      scene%contact_reason = data%reason
      if (data%is_assembled) call describe_order(data, scene)
      scene%peak_before = max(peak_memory(), resident_memory())
      scene%memory_before = held_memory()
      scene%memory = forecast_memory(data%model, data, scene)
      call list_left_out(data, scene)

   contains

      !> A body, and the solver of its matrix where it has one of its own.
      subroutine describe_body(result)
         type(body_result_t), intent(inout) :: result
         type(profile_t) :: profile

         associate (body => data%fem%bodies%list(b))
            result%name = body%name
            result%n_nodes = size(body%nodes, kind=ip)
            result%n_elements = size(body%elements, kind=ip)
            result%n_equations = body%n
            result%n_contact_equations = body%n_retained
            result%n_free_motions = size(body%modes, 2, kind=ip)
         end associate
         if (data%fem%bodies%list(b)%is_rigid) then
            result%n_nodes = 1                                ! its reference node
            result%solver = 'none'
            result%reason = 'rigid'
         else if (data%contact_form == CONTACT_SPARSE) then
            result%solver = 'scene'
         else
            call body_profile(data%fem, b, profile)
            call choose_solver(profile, data%solver_kind, result)
            call estimate_body_memory(data%fem, b, result)
         end if
      end subroutine describe_body

      subroutine describe_pairs()
         integer(ip) :: i, least, greatest

         allocate (scene%pairs(size(data%points)))
         do i = 1, size(data%points, kind=ip)
            associate (pair => scene%pairs(i), points => data%points(i))
               pair%slave = data%model%surfaces(data%model%pairs(i)%slave)%name
               pair%master = data%model%surfaces(data%model%pairs(i)%master)%name
               pair%interaction = data%model%interactions(data%model%pairs(i)%interaction)%name
               pair%n_points = points%n
               pair%n_left_out = points%n_left_out
               pair%matching = points%matching
               pair%master_is_rigid = points%rigid
               if (points%n > 0) then
                  ! The least and the greatest initial gap, and where.
                  least = minloc(points%gap, 1, kind=ip)
                  greatest = maxloc(points%gap, 1, kind=ip)
                  pair%least_gap = points%gap(least)
                  pair%greatest_gap = points%gap(greatest)
                  pair%least_node = data%model%mesh%node_id(points%node(least))
                  pair%greatest_node = data%model%mesh%node_id(points%node(greatest))
                  pair%least_x = points%x(:, least)
                  pair%greatest_x = points%x(:, greatest)
               end if
            end associate
         end do
      end subroutine describe_pairs

   end subroutine describe_scene

   !> Of the sparse form, when it is assembled.
   subroutine describe_order(data, scene)
      type(scene_data_t), intent(in) :: data     !< with the assembled scene
      type(scene_t), intent(inout) :: scene      !< get order and solving

      scene%solving = data%assembled%solving_bytes()
      scene%order = data%assembled%order
   end subroutine describe_order

   !> Counts what could be estimated only: the fronts of bodies with the sparse solver. A run, which makes them itself in a while,
   !> wants it where the estimate does not fit.
   subroutine count_fronts(data, always, scene)
      type(scene_data_t), intent(in) :: data     !< bodies are read
      logical, intent(in) :: always              !< else only where the estimate does not fit
      type(scene_t), intent(inout) :: scene      !< memory of its bodies, and its own
      integer(ip) :: b

      if (.not. any(scene%bodies%solver_kind == SOLVER_SPARSE)) return
      if (.not. always) then
         if (scene%memory - scene%memory_before <= available_memory()) return
      end if
      do b = 1, size(scene%bodies, kind=ip)
         if (scene%bodies(b)%solver_kind == SOLVER_SPARSE) call count_body_memory(data%fem, b, scene%bodies(b))
      end do
      scene%peak_before = max(scene%peak_before, peak_memory())
      scene%memory = forecast_memory(data%model, data, scene)
   end subroutine count_fronts

   !> status: STATUS_DECK when the matrices of the scene need more memory than there is.
   subroutine check_scene(model, memory, scene, status)
      type(model_t), intent(in) :: model                    !< its deck_path is read
      integer(lp), intent(in) :: memory                     !< bytes there are
      type(scene_t), intent(in) :: scene                    !< memory and sizes are read
      type(status_t), intent(inout) :: status               !< STATUS_DECK where it does not fit; else as it was

      call check_memory(model%deck_path, 'the scene, '//to_text(scene%n_dofs)//' free displacements and '// &
                        to_text(scene%n_normal + scene%n_tangential)//' contact unknowns,', scene%memory, memory, status, &
                        held=scene%memory_before)
   end subroutine check_scene

   !> What the scene does not need, in sentences.
   subroutine list_left_out(data, scene)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(inout) :: scene

      allocate (scene%left_out(0))
      if (size(data%points) == 0 .and. scene%n_rows == 0) then
         call append_string(scene%left_out, 'no contact pair: no contact line, one solve a body')
      else if (size(data%points) == 0) then
         call append_string(scene%left_out, 'no contact pair: nothing opens or slides, no iteration')
      end if
      if (size(data%points) > 0 .and. .not. data%line%has_friction) then
         call append_string(scene%left_out, 'no friction: no tangential unknowns, no outer loop')
      end if
      if (any(data%points%rigid)) then
         call append_string(scene%left_out, 'rigid surface: no second body and no matrix for it')
      end if
      if (data%line%has_friction .and. data%line%average%is_identity) then
         call append_string(scene%left_out, 'local friction: no averaging of the pressure')
      end if
   end subroutine list_left_out

end module atrito_solve
