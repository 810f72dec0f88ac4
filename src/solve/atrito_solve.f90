!> One static step, from the model to the results.
module atrito_solve
   use atrito_assembly, only: fem_t, body_profile
   use atrito_blas_info, only: is_reference_blas
   use atrito_box_problem, only: box_problem_t, DEPENDENT_POINTS
   use atrito_body_store, only: body_store_t, provide_bodies, take_numbering, release_bodies
   use atrito_condensed_body, only: choose_storage, motion_text
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_problem, only: build_line, build_problem, motion_body
   use atrito_contact_rows, only: contact_rows_t, build_rows
   use atrito_contact_solution, only: contact_solution_t, outer_controls_t
   use atrito_final_check, only: check_equilibrium, check_balance, check_law, equilibrium_t
   use atrito_chatter, only: report_chatter
   use atrito_force_sums, only: sum_forces
   use atrito_free_motion, only: free_motion_text
   use atrito_friction_law, only: FRICTION_NONE
   use atrito_internal_forces, only: internal_forces
   use atrito_kinds, only: ip, lp, wp
   use atrito_messages, only: add_warning
   use atrito_model, only: model_t
   use atrito_nodal_loads, only: nodal_loads
   use atrito_outer_loop, only: solve_contact_line, FREE_MOTION
   use atrito_points, only: contact_points_t
   use atrito_profile, only: profile_t
   use atrito_recovery, only: contact_forces, elastic_displacements, add_rigid_motions, recover_contact, recover_stress, &
                              estimate_error
   use atrito_reporter, only: reporter_t
   use atrito_results, only: results_t, scene_t, iteration_t, body_result_t
   use atrito_scene_builder, only: build_scene, build_bodies
   use atrito_scene_memory, only: check_memory, check_average_memory
   use atrito_solve_history, only: solve_history_t
   use atrito_solver_choice, only: STORAGE_SKYLINE, STORAGE_BANDED, STORAGE_SPARSE, STORAGE_MUMPS
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR, STATUS_DECK
   use atrito_strings, only: to_text, append_string
   use atrito_timers, only: start_phase, stop_phase
   use atrito_uniqueness, only: estimate_contraction
   implicit none (type, external)
   private
   public :: solve_options_t, solve_static, survey_scene
   public :: SOLVER_AUTO, SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE, SOLVER_MUMPS

   integer, parameter :: SOLVER_AUTO = 0, SOLVER_SKYLINE = STORAGE_SKYLINE, SOLVER_BANDED = STORAGE_BANDED, &
                         SOLVER_SPARSE = STORAGE_SPARSE, SOLVER_MUMPS = STORAGE_MUMPS

   type :: solve_options_t
      integer :: storage_kind = SOLVER_AUTO
      integer(lp) :: memory = huge(1_lp)                    !< bytes; what the machine has counts where it is less
   end type solve_options_t

   !> The scene with everything that the phases of a solution share.
   type :: scene_data_t
      type(fem_t) :: fem
      logical, allocatable :: held(:, :)                    !< (2, n_nodes)
      real(wp), allocatable :: value(:, :)                  !< (2, n_nodes) prescribed displacements [L]
      type(contact_points_t), allocatable :: points(:)
      type(contact_rows_t) :: rows
      type(contact_line_t) :: line
      real(wp), allocatable :: f(:, :)                      !< (2, n_nodes) applied forces [F]
   end type scene_data_t

   real(wp), parameter :: MANY_DIGITS = 10.0_wp             !< lost digits worth a warning
   real(wp), parameter :: MUCH_LOST = 1.0e8_wp              !< condition of the contact line worth a warning
   real(wp), parameter :: LARGE_FRICTION = 3.0_wp           !< from here on other solutions have been seen

contains

   !> What a scene needs, without solving it: for `check`, and for the listing. status: STATUS_DECK as in solve_static.
   subroutine survey_scene(model, options, scene, status)
      type(model_t), intent(in), target :: model
      type(solve_options_t), intent(in) :: options
      type(scene_t), intent(out) :: scene
      type(status_t), intent(out) :: status
      type(scene_data_t) :: data
      type(body_store_t) :: store

      call prepare(model, store, options, data, status)
      if (.not. is_ok(status)) return
      call describe_scene(model, data, options, scene)
      call check_scene(model, options, scene, status)
      if (is_ok(status)) call check_known_points(data, status)
   end subroutine survey_scene

   !> Solves. status: STATUS_SINGULAR (free motion, singular body, dependent points), STATUS_DECK (contradiction of prescribed
   !> displacements and hard contact; too little memory, which is told by a message). results%converged and law_holds tell the rest.
   subroutine solve_static(model, options, reporter, results, status, kept)
      type(model_t), intent(in), target :: model
      type(solve_options_t), intent(in) :: options
      type(reporter_t), intent(in) :: reporter
      type(results_t), intent(out) :: results
      type(status_t), intent(out) :: status
      type(body_store_t), intent(inout), optional :: kept  !< bodies of an earlier run; on return those of this one
      type(body_store_t) :: store

      if (present(kept)) then
         call solve_with_store(model, options, reporter, kept, results, status)
      else
         call solve_with_store(model, options, reporter, store, results, status)
      end if
   end subroutine solve_static

   subroutine solve_with_store(model, options, reporter, store, results, status)
      type(model_t), intent(in), target :: model
      type(solve_options_t), intent(in) :: options
      type(reporter_t), intent(in) :: reporter
      type(body_store_t), intent(inout) :: store
      type(results_t), intent(out) :: results
      type(status_t), intent(out) :: status
      type(scene_data_t) :: data
      type(box_problem_t) :: problem
      type(contact_solution_t) :: solution
      type(outer_controls_t) :: controls

      call start_phase('order')
      call prepare(model, store, options, data, status)
      if (is_ok(status)) call describe_scene(model, data, options, results%scene)
      call stop_phase('order')
      if (is_ok(status)) call check_scene(model, options, results%scene, status)
      if (is_ok(status)) call check_known_points(data, status)
      if (.not. is_ok(status)) return
      call provide_bodies(store, data%fem, data%held, data%points, free_load(data), options%storage_kind, reporter, &
                          results%scene%bodies, status)
      results%factorisations = store%factorisations
      if (.not. is_ok(status)) return
      call start_phase('iterate')
      call build_problem(data%fem, store%bodies, data%rows, data%line, data%value, data%f, problem)
      controls = outer_controls_t(model%controls%method, model%controls%tolerance, model%controls%max_iterations, &
                                  model%controls%relaxation)
      call solve_contact_line(problem, data%line, controls, reporter, solution, status)
      if (is_ok(status)) results%contraction_estimate = estimate_contraction(problem, data%line, solution%bounds%d, &
                                                                             solution%state%state)
      call stop_phase('iterate')
      if (.not. is_ok(status)) then
         call explain_failure(data, problem, solution, status)
         return
      end if
      call start_phase('recover')
      call recover(model, data, store, solution, results)
      call stop_phase('recover')
      call start_phase('estimate')
      call estimate_error(data%fem, results)
      call stop_phase('estimate')
      call start_phase('check')
      call check_law(data%rows, data%line, max(controls%tolerance, solution%residual), results)
      call stop_phase('check')
      call report_chatter(data%fem%mesh, data%points, data%rows, data%line, solution, results)
      call warn(model, data, solution, results)
   end subroutine solve_with_store

   subroutine prepare(model, store, options, data, status)
      type(model_t), intent(in), target :: model
      type(body_store_t), intent(in) :: store
      type(solve_options_t), intent(in) :: options
      type(scene_data_t), intent(out) :: data
      type(status_t), intent(out) :: status
      logical :: known

      call build_scene(model, data%fem, data%held, data%value, data%points)
      call take_numbering(store, data%held, data%points, options%storage_kind, data%fem, known)
      if (.not. known) call build_bodies(model, data%held, data%points, options%storage_kind, data%fem)
      call build_rows(data%points, data%rows)
      if (any(model%interactions%rho > 0.0_wp)) then
         call check_average_memory(model%deck_path, data%rows%n, options%memory, status)
         if (.not. is_ok(status)) return
      end if
      call build_line(model, data%fem, data%points, data%rows, data%value, data%line)
      call nodal_loads(model, data%f)
   end subroutine prepare

   !> status: STATUS_DECK when the matrices of the scene need more memory than there is.
   subroutine check_scene(model, options, scene, status)
      type(model_t), intent(in) :: model
      type(solve_options_t), intent(in) :: options
      type(scene_t), intent(in) :: scene
      type(status_t), intent(inout) :: status

      call check_memory(model%deck_path, 'the scene, '//to_text(scene%n_dofs)//' free displacements and '// &
                        to_text(scene%n_normal + scene%n_tangential)//' contact unknowns,', scene%memory, options%memory, status)
   end subroutine check_scene

   !> Fills what `check` and the listing print of a scene.
   subroutine describe_scene(model, data, options, scene)
      type(model_t), intent(in) :: model
      type(scene_data_t), intent(in) :: data
      type(solve_options_t), intent(in) :: options
      type(scene_t), intent(out) :: scene
      type(profile_t) :: profile
      integer(ip) :: b
      integer :: kind

      allocate (scene%bodies(data%fem%bodies%n))
      do b = 1, data%fem%bodies%n
         associate (body => data%fem%bodies%list(b), result => scene%bodies(b))
            result%name = body%name
            result%n_nodes = size(body%nodes, kind=ip)
            result%n_elements = size(body%elements, kind=ip)
            result%n_equations = body%n
            result%n_contact_equations = body%n_kept
            result%n_free_motions = size(body%modes, 2, kind=ip)
            call body_profile(data%fem, b, profile)
            call choose_storage(profile, options%storage_kind, kind, result)
            scene%n_dofs = scene%n_dofs + body%n
            scene%n_rigid = scene%n_rigid + result%n_free_motions
            scene%memory = scene%memory + result%memory
         end associate
      end do
      call describe_pairs(model, data, scene)
      scene%n_normal = count(data%line%normal > 0, kind=ip)
      scene%n_tangential = count(data%line%tangential > 0, kind=ip)
      scene%outer_loop = data%line%has_friction
      scene%memory = scene%memory + 3*8_lp*int(scene%n_normal + scene%n_tangential, lp)**2 &
                     + 200_lp*int(model%mesh%n_nodes + model%mesh%n_elements, lp)
      call list_left_out(data, scene)
   end subroutine describe_scene

   subroutine describe_pairs(model, data, scene)
      type(model_t), intent(in) :: model
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(inout) :: scene
      integer(ip) :: i

      allocate (scene%pairs(size(data%points)))
      do i = 1, size(data%points, kind=ip)
         associate (pair => scene%pairs(i), points => data%points(i))
            pair%slave = model%surfaces(model%pairs(i)%slave)%name
            pair%master = model%surfaces(model%pairs(i)%master)%name
            pair%interaction = model%interactions(model%pairs(i)%interaction)%name
            pair%n_points = points%n
            pair%n_left_out = points%n_left_out
            pair%matching = points%matching
            pair%master_is_rigid = points%rigid
            if (points%n > 0) pair%least_gap = minval(points%gap)
            if (points%n > 0) pair%greatest_gap = maxval(points%gap)
         end associate
      end do
   end subroutine describe_pairs

   !> What the scene does not need, in sentences.
   subroutine list_left_out(data, scene)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(inout) :: scene

      allocate (scene%left_out(0))
      if (size(data%points) == 0) call append_string(scene%left_out, 'no contact pair: no contact line, one solve a body')
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

   !> Hard contact cannot take an overlap of prescribed dofs.
   pure subroutine check_known_points(data, status)
      type(scene_data_t), intent(in) :: data
      type(status_t), intent(out) :: status
      integer(ip) :: j

      do j = 1, data%line%n
         if (data%line%normal(j) > 0 .or. data%line%delta(j) > 0.0_wp) cycle
         if (data%line%known_overlap(j) <= 1.0e-12_wp*(maxval(abs(data%fem%mesh%x)))) cycle
         call set_status(status, STATUS_DECK, 'node '//to_text(data%fem%mesh%node_id(data%rows%node(1, j))) &
                         //' is prescribed to penetrate a hard contact by '//to_text(data%line%known_overlap(j)) &
                         //' [L]; a penalty (PRESSURE-OVERCLOSURE=LINEAR) could take it')
         return
      end do
   end subroutine check_known_points

   !> Applied forces less those of the prescribed displacements.
   function free_load(data) result(load)
      type(scene_data_t), intent(in) :: data
      real(wp), allocatable :: load(:, :), force(:, :)
      real(wp) :: energy

      load = data%f
      if (all(data%value == 0.0_wp)) return
      allocate (force, mold=load)
      force = 0.0_wp
      energy = 0.0_wp
      call internal_forces(data%fem, data%value, force, energy)
      load = load - force
   end function free_load

   !> Puts a failure of the contact line into words.
   subroutine explain_failure(data, problem, solution, status)
      type(scene_data_t), intent(in) :: data
      type(box_problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      type(status_t), intent(inout) :: status
      integer(ip) :: node

      if (status%text == FREE_MOTION) then
         call set_status(status, STATUS_SINGULAR, free_motion_text(data%fem, data%held, data%rows, data%line, problem, solution))
      else if (status%text == DEPENDENT_POINTS) then
         node = data%rows%node(1, data%line%point(solution%inner%dependent))
         call set_status(status, STATUS_SINGULAR, 'the contact point at node '//to_text(data%fem%mesh%node_id(node)) &
                         //trim(merge(' (normal)    ', ' (tangential)', solution%inner%dependent <= problem%n_normal)) &
                         //' repeats what other points ask: two pairs share it, or the slave is finer than its own dofs')
      end if
   end subroutine explain_failure

   !> Displacements, reactions, stresses, contact fields, energies and balances.
   subroutine recover(model, data, store, solution, results)
      type(model_t), intent(in) :: model
      type(scene_data_t), intent(in) :: data
      type(body_store_t), intent(inout) :: store           !< its factored bodies are not needed after the displacements
      type(contact_solution_t), intent(in) :: solution
      type(results_t), intent(inout) :: results
      real(wp), allocatable :: contact(:, :)
      type(equilibrium_t) :: equilibrium
      real(wp) :: imbalance
      integer(ip) :: b

      contact = contact_forces(data%fem, data%rows, data%line, solution)
      results%u = data%value
      do b = 1, data%fem%bodies%n
         call elastic_displacements(data%fem, b, store%bodies(b), contact, results%u)
      end do
      call release_bodies(store)
      allocate (results%reaction, mold=results%u)
      call check_equilibrium(data%fem, results%u, data%f, contact, data%held, results%reaction, equilibrium)
      imbalance = check_balance(data%fem, data%f, contact)
      call add_rigid_motions(data%fem, solution%state%a, results%u)
      results%prescribed = data%held
      results%converged = solution%converged
      results%law_holds = equilibrium%holds .and. imbalance <= 1.0e-8_wp
      if (equilibrium%largest_force > 0.0_wp) results%equilibrium_residual = equilibrium%residual/equilibrium%largest_force
      if (.not. results%law_holds) results%verdict = 'the bodies are not in equilibrium: residual ' &
                                                     //to_text(results%equilibrium_residual, 3)//', imbalance ' &
                                                     //to_text(imbalance, 3)
      if (.not. solution%converged) results%verdict = solution%verdict
      results%strain_energy = equilibrium%energy
      call sum_forces(data%fem%mesh%x, results%u, data%f, results%reaction, contact, results%balance, results%external_work)
      call recover_contact(data%line, data%rows, data%points, solution, results%u, results%contact)
      call recover_stress(model, data%fem, results)
      call copy_history(solution, results)
   end subroutine recover

   pure subroutine copy_history(solution, results)
      type(contact_solution_t), intent(in) :: solution
      type(results_t), intent(inout) :: results
      integer(ip) :: i

      allocate (results%iterations(solution%history%n))
      do i = 1, solution%history%n
         associate (r => solution%history%records(i))
            results%iterations(i) = iteration_t(r%outer, r%inner, r%change_displacement, r%change_pressure, r%change_friction, &
                                                r%open, r%stick, r%slip, r%residual)
         end associate
      end do
      results%outer_iterations = solution%history%outer
      results%linear_solves = max(solution%history%n, 1_ip)
      results%contraction = solution%contraction
   end subroutine copy_history

   !> What a careful user should know of a solution.
   subroutine warn(model, data, solution, results)
      type(model_t), intent(in) :: model
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(in) :: solution
      type(results_t), intent(in) :: results
      integer(ip) :: b
      real(wp) :: mode(3)

      if (is_reference_blas()) call add_warning('W-BLAS', 'this program was linked with the reference BLAS; with OpenBLAS' &
                                                //' it is about three times as fast')
      if (allocated(solution%inner%idle)) then
         call motion_body(data%fem, solution%inner%idle, b, mode)
         call add_warning('W-IDLE', motion_text(data%fem, b, mode)//': no load does it and nothing prevents it; the least' &
                          //' motion is given')
      end if
      do b = 1, size(results%scene%bodies, kind=ip)
         associate (body => results%scene%bodies(b))
            if (body%digits_lost > MANY_DIGITS) call add_warning('W-DIGITS', 'body '//body%name//': the pivot of node ' &
                              //to_text(body%worst_node)//' dof '//to_text(body%worst_dof)//' lost '//to_text(body%digits_lost, 3) &
                                        //' digits: a very slender or nearly incompressible body, or one that is barely held there')
         end associate
      end do
      if (solution%inner%condition > MUCH_LOST) call add_warning('W-DIGITS', 'the equations of the contact line lose ' &
                                                     //to_text(log10(solution%inner%condition), 3)//' digits of 16: a stiff slave' &
                                                                 //' with more points than its soft master has nodes, or points' &
                                                                 //' that are almost one')
      call warn_of_others(model, results)
   end subroutine warn

   !> Whether there may be other solutions.
   subroutine warn_of_others(model, results)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: measured
      real(wp) :: nu

      nu = maxval([pack(model%interactions%nu, model%interactions%friction /= FRICTION_NONE), 0.0_wp])
      if (results%contraction_estimate < 1.0_wp .and. nu < LARGE_FRICTION) return
      measured = ' (estimated contraction of the outer loop '//to_text(results%contraction_estimate, 3)
      if (results%contraction > 0.0_wp) measured = measured//', measured '//to_text(results%contraction, 3)
      if (results%contraction_estimate >= 1.0_wp) then
         call add_warning('W-UNIQUE', 'friction coefficient '//to_text(nu)//': there may be other solutions than the one found;' &
                          //' one alone is expected below '//to_text(nu/results%contraction_estimate, 3)//measured//')')
      else
         call add_warning('W-UNIQUE', 'friction coefficient '//to_text(nu)//': there may be other solutions than the one found' &
                          //measured//'; below 1 others are rare)')
      end if
   end subroutine warn_of_others

end module atrito_solve
