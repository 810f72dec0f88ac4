!> One static step, from the model to the results.
module atrito_solve
   use atrito_blas_info, only: is_reference_blas
   use atrito_body_cache, only: body_cache_t
   use atrito_body_sums, only: sum_bodies
   use atrito_unsettled_points, only: report_unsettled
   use atrito_condensed_body, only: motion_text, body_text, how_it_moves
   use atrito_contact_form, only: can_be_dense, contact_form_name, CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE
   use atrito_contact_problem, only: motion_body
   use atrito_contact_scales, only: usual_growth
   use atrito_contact_solution, only: contact_solution_t
   use atrito_dense_form, only: solve_dense_form
   use atrito_final_check, only: check_equilibrium, check_balance, check_law, equilibrium_t
   use atrito_force_sums, only: sum_forces
   use atrito_friction_law, only: FRICTION_NONE
   use atrito_joint_sums, only: sum_joints
   use atrito_kinds, only: ip, wp
   use atrito_linear_limits, only: find_large, warn_of_large
   use atrito_mesh, only: is_revolved
   use atrito_messages, only: add_note, add_warning
   use atrito_model, only: controls_t, model_t, METHOD_ANDERSON, METHOD_NEWTON, METHOD_PICARD
   use atrito_outer_loop, only: FREE_MOTION
   use atrito_recovery, only: contact_forces, add_rigid_motions, recover_contact, recover_stress, &
                              estimate_error
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_results, only: results_t, scene_t, pair_scene_t
   use atrito_rigid_results, only: take_rigid_results
   use atrito_row_forces, only: share_out_rows, clear_balance
   use atrito_scene_data, only: scene_data_t, asked_t, prepare, assemble, check_known_points
   use atrito_scene_forecast, only: forecast_memory
   use atrito_scene_survey, only: describe_scene, count_fronts, check_scene
   use atrito_shared_points, only: note_shared_points
   use atrito_solver_choice, only: SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE, SOLVER_MUMPS
   use atrito_sparse_form, only: solve_sparse_form
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: to_text
   use atrito_thermal_loads, only: elastic_energy
   use atrito_timers, only: start_phase, stop_phase
   use atrito_verdict, only: judge_balance
   use atrito_weak_forces, only: contact_sizes_t
   implicit none (type, external)
   private
   public :: solve_options_t, solve_static, survey_scene
   public :: SOLVER_AUTO, SOLVER_SKYLINE, SOLVER_BANDED, SOLVER_SPARSE, SOLVER_MUMPS
   public :: CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE

   integer, parameter :: SOLVER_AUTO = 0

   type, extends(asked_t) :: solve_options_t
   end type solve_options_t

   real(wp), parameter :: MANY_DIGITS = 10.0_wp             !< lost digits worth a warning
   real(wp), parameter :: MUCH_LOST = 1.0e8_wp              !< condition of the contact line worth a warning
   real(wp), parameter :: LARGE_FRICTION = 3.0_wp           !< from here on other solutions have been seen

   !> Entries of C to go through where either form may be taken: with 400 unknown forces 900 linear solves, with 100 15,000.
   real(wp), parameter :: MOST_ENTRIES = 1.5e8_wp

   !> What is tried last, in the order of what it found in 10,000 random scenes that nothing else had solved.
   type :: attempt_t
      integer :: form, method
      integer(ip) :: times                                 !< MAXIT
      real(wp) :: relaxation
      logical :: is_coarse                                 !< controls_t
   end type attempt_t

   type(attempt_t), parameter :: PATIENT(5) = [attempt_t(CONTACT_DENSE, METHOD_ANDERSON, 1, 1.0_wp, .true.), &
                                               attempt_t(CONTACT_DENSE, METHOD_ANDERSON, 3, 1.0_wp, .false.), &
                                               attempt_t(CONTACT_SPARSE, METHOD_ANDERSON, 2, 1.0_wp, .false.), &
                                               attempt_t(CONTACT_DENSE, METHOD_PICARD, 10, 0.3_wp, .false.), &
                                               attempt_t(CONTACT_DENSE, METHOD_PICARD, 10, 1.0_wp, .false.)]
   integer, parameter :: MOST_PATIENT = 400                !< unknown forces

contains

   !> What a scene needs, without solving it: for `check`, and for the listing. status: STATUS_DECK as in solve_static.
   subroutine survey_scene(model, options, scene, status)
      type(model_t), intent(in), target :: model
      type(solve_options_t), intent(in) :: options
      type(scene_t), intent(out) :: scene
      type(status_t), intent(out) :: status
      type(scene_data_t) :: data
      type(body_cache_t) :: store

      call begin_scene(model, options, store, .true., data, scene, status)
   end subroutine survey_scene

   !> Everything before the first number is computed. status: STATUS_DECK as in solve_static.
   subroutine begin_scene(model, options, store, exact, data, scene, status)
      type(model_t), intent(in), target :: model
      type(solve_options_t), intent(in) :: options
      type(body_cache_t), intent(in) :: store
      logical, intent(in) :: exact                          !< all fronts are counted, before a run makes them
      type(scene_data_t), intent(out) :: data
      type(scene_t), intent(out) :: scene
      type(status_t), intent(out) :: status

      call start_phase('order')
      call prepare(model, store, options%asked_t, data, status)
      if (is_ok(status) .and. data%contact_form == CONTACT_SPARSE) call assemble(data, status)
      if (is_ok(status)) call describe_scene(data, scene)
      if (is_ok(status)) call count_fronts(data, exact, scene)
      call stop_phase('order')
      if (is_ok(status)) call check_scene(model, options%memory, scene, status)
      if (is_ok(status)) call check_known_points(data, status)
   end subroutine begin_scene

   !> Solves. status: STATUS_SINGULAR (free motion, singular body, dependent points), STATUS_DECK (contradiction of prescribed
   !> displacements and hard contact; too little memory, which is told by a message). results%converged and law_holds tell the rest.
   subroutine solve_static(model, options, reporter, results, status, store)
      type(model_t), intent(in), target :: model
      type(solve_options_t), intent(in) :: options
      type(reporter_t), intent(in) :: reporter
      type(results_t), intent(out) :: results
      type(status_t), intent(out) :: status
      type(body_cache_t), intent(inout) :: store           !< bodies of an earlier run, or none; on return those of this one
      type(scene_data_t) :: data
      type(contact_solution_t) :: solution
      type(controls_t) :: controls

      call begin_scene(model, options, store, .false., data, results%scene, status)
      if (.not. is_ok(status)) return
      data%reporter = reporter
      controls = data%step%controls
      if (options%contact_form == CONTACT_AUTO) controls%most_entries = MOST_ENTRIES
      if (data%contact_form == CONTACT_SPARSE .and. controls%method /= METHOD_ANDERSON) then
         call add_note('N-METHOD', 'METHOD is one of the dense form of the contact system; the sparse one, which was taken, has' &
                       //' its own')
      end if
      call solve_one_form(data, data%contact_form, controls, store, results, solution, status)
      if (results%scene%near_elements .and. .not. is_solved(results, status)) then
         call solve_without_near(data, controls, store, results, solution, status)
      end if
      if (options%contact_form == CONTACT_AUTO .and. data%assembled%failed > 0 .and. .not. is_ok(status)) then
         ! what is singular for the one form need not be so for the other
         if (can_be_dense(size(data%line%point, kind=ip))) then
            call solve_one_form(data, CONTACT_DENSE, controls, store, results, solution, status)
         end if
      end if
      if (options%contact_form == CONTACT_AUTO .and. is_ok(status) .and. .not. (results%converged .and. results%law_holds)) then
         call try_others(data, controls, store, results, solution)
      end if
      if (.not. is_ok(status)) return
      ! with the fronts that the bodies have in place of those that were expected
      results%scene%memory = forecast_memory(model, data, results%scene)
      call report_unsettled(data%fem%mesh, data%points, data%rows, data%line, solution, results)
      call warn(data, solution, results)
   end subroutine solve_static

   pure logical function is_solved(results, status)
      type(results_t), intent(in) :: results
      type(status_t), intent(in) :: status

      is_solved = is_ok(status) .and. results%converged .and. results%law_holds
   end function is_solved

   !> Solves again with the stiffness of each element: where a body is as slender as the digits of its nodes are few, taking near
   !> elements as equal says nothing of it, and refinement does not converge.
   subroutine solve_without_near(data, controls, store, results, solution, status)
      type(scene_data_t), intent(inout) :: data
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(results_t) :: again

      call report_progress(data%reporter, 'not solved; each element with its own last digits')
      again%scene = results%scene
      again%scene%near_elements = .false.
      results = again
      data%fem%grain = 0.0_wp
      data%is_assembled = .false.
      call solve_one_form(data, data%contact_form, controls, store, results, solution, status)
   end subroutine solve_without_near

   !> Solves by one form of the contact system, and checks what it found. Without a solution it is judged whether there can be one:
   !> status is STATUS_SINGULAR where there is none.
   subroutine solve_one_form(data, form, controls, store, results, solution, status)
      type(scene_data_t), intent(inout) :: data
      integer, intent(in) :: form                           !< CONTACT_DENSE or CONTACT_SPARSE
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results             !< with the scene; nothing else is there yet
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      real(wp), allocatable :: u(:, :)                      ! without rigid motions, (2, n_nodes) [L]
      real(wp) :: strain_bound

      if (form == CONTACT_SPARSE) then
         call solve_sparse_form(data, controls, results, solution, u, status)
      else
         call solve_dense_form(data, controls, store, results, solution, u, status)
      end if
      call start_phase('iterate')
      call judge_outcome(data, results%scene%pairs, solution, status)
      call stop_phase('iterate')
      if (.not. is_ok(status)) return
      call start_phase('recover')
      call recover(data, solution, u, results)
      call stop_phase('recover')
      call start_phase('estimate')
      call estimate_error(data%fem, results, strain_bound)
      call find_large(data%model, data%fem, strain_bound, results)
      call stop_phase('estimate')
      call start_phase('check')
      call check_law(data%rows, data%line, max(controls%tolerance, solution%residual), results, data%fem%bodies%of_node, &
                     growth_of_bodies(data, results%scene))
      call judge_failed_check(data, results, status)
      call stop_phase('check')
      call take_rigid_results(data, solution, results)
   end subroutine solve_one_form

   !> By how much round-off grows in the displacements of each body, as far as its factorisation tells.
   pure function growth_of_bodies(data, scene) result(growth)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(in) :: scene
      real(wp) :: growth(data%fem%bodies%n)
      integer(ip) :: b

      do b = 1, size(growth, kind=ip)
         growth(b) = usual_growth(data%fem%bodies%list(b)%n, scene%bodies(b)%digits_lost)
      end do
   end function growth_of_bodies

   !> The other form of the contact system, and Newton's method from a start of its own; with few points also what takes long:
   !> what is found counts when it converges and its law holds.
   subroutine try_others(data, controls, store, results, solution)
      type(scene_data_t), intent(inout) :: data
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(inout) :: solution
      type(controls_t) :: newton, patient_controls
      integer :: attempt

      if (controls%method /= METHOD_ANDERSON) return        ! the user's own choice
      call try_form(data, merge(CONTACT_SPARSE, CONTACT_DENSE, data%contact_form == CONTACT_DENSE), controls, store, results, &
                    solution)
      if (results%converged .and. results%law_holds) return
      newton = controls
      newton%method = METHOD_NEWTON
      call try_form(data, CONTACT_DENSE, newton, store, results, solution)
      if (size(data%line%point) > MOST_PATIENT) return
      do attempt = 1, size(PATIENT)
         if (results%converged .and. results%law_holds) return
         patient_controls = controls_t(PATIENT(attempt)%method, controls%tolerance, &
                                       PATIENT(attempt)%times*controls%max_iterations, PATIENT(attempt)%relaxation, &
                                       PATIENT(attempt)%is_coarse, controls%most_entries)
         call try_form(data, PATIENT(attempt)%form, patient_controls, store, results, solution)
      end do
   end subroutine try_others

   subroutine try_form(data, form, controls, store, results, solution)
      type(scene_data_t), intent(inout) :: data
      integer, intent(in) :: form                           !< CONTACT_DENSE or CONTACT_SPARSE
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(inout) :: solution
      type(results_t) :: other
      type(contact_solution_t) :: other_solution
      type(status_t) :: status

      if (form == CONTACT_DENSE .and. .not. can_be_dense(size(data%line%point, kind=ip))) return
      call report_progress(data%reporter, 'no solution; the '//contact_form_name(form)//' form of the contact system'// &
                           attempt_text(data%step%controls%max_iterations, controls))
      other%scene = results%scene
      other%scene%contact_form = contact_form_name(form)
      other%scene%contact_reason = 'what was tried before found no solution'
      call solve_one_form(data, form, controls, store, other, other_solution, status)
      if (.not. (is_ok(status) .and. other%converged .and. other%law_holds)) return
      solution = other_solution
      results = other
   end subroutine try_form

   !> What an attempt is, besides its form.
   function attempt_text(usual, controls) result(text)
      integer(ip), intent(in) :: usual                      !< MAXIT of the deck
      type(controls_t), intent(in) :: controls
      character(len=:), allocatable :: text

      text = ''
      if (controls%method == METHOD_NEWTON) text = ', NEWTON'
      if (controls%method == METHOD_PICARD) text = ', PICARD, RELAXATION='//to_text(controls%relaxation)
      if (controls%is_coarse) text = text//', coarse round-off'
      if (controls%max_iterations > usual) text = text//', MAXIT='//to_text(controls%max_iterations)
   end function attempt_text

   !> Without a solution: whether there can be one. Free motion becomes a proof of it, or a last iterate that did not converge.
   subroutine judge_outcome(data, pairs, solution, status)
      type(scene_data_t), intent(in) :: data
      type(pair_scene_t), intent(in) :: pairs(:)
      type(contact_solution_t), intent(inout) :: solution
      type(status_t), intent(inout) :: status
      logical :: moves

      moves = .false.
      if (.not. is_ok(status)) moves = status%text == FREE_MOTION
      if (.not. moves .and. (solution%converged .or. .not. is_ok(status))) return
      solution%converged = .false.
      if (moves) solution%verdict = 'no friction bound that was tried holds the bodies'//moving_text(data, solution)
      call judge_balance(data%fem, data%held, data%rows, data%line, data%f, pairs, solution%verdict, status)
   end subroutine judge_outcome

   !> The body that moved most under the last friction bound, and how.
   function moving_text(data, solution) result(text)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(in) :: solution
      character(len=:), allocatable :: text
      integer(ip) :: b
      real(wp) :: mode(3)

      text = ''
      if (.not. allocated(solution%inner%motion)) return
      if (.not. any(abs(solution%inner%motion) > 0.0_wp)) return
      call motion_body(data%fem, solution%inner%motion, b, mode)
      text = ': '//body_text(data%fem, b)//' would '//how_it_moves(data%fem, b, mode)
   end function moving_text

   !> The same where the loop ended well and the final check did not.
   subroutine judge_failed_check(data, results, status)
      type(scene_data_t), intent(in) :: data
      type(results_t), intent(inout) :: results
      type(status_t), intent(inout) :: status

      if (results%law_holds .or. .not. results%converged .or. data%line%n == 0) return
      call judge_balance(data%fem, data%held, data%rows, data%line, data%f, results%scene%pairs, results%verdict, status)
   end subroutine judge_failed_check

   !> Displacements, reactions, stresses, contact fields, energies and balances.
   subroutine recover(data, solution, u, results)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(in) :: solution
      real(wp), allocatable, intent(inout) :: u(:, :)      !< without rigid motions, (2, n_nodes) [L]; moved to the results
      type(results_t), intent(inout) :: results
      real(wp), allocatable :: contact(:, :)
      type(equilibrium_t) :: equilibrium
      real(wp) :: imbalance, others(2)

      contact = contact_forces(data%fem, data%rows, data%line, solution)
      call move_alloc(u, results%u)
      allocate (results%reaction, mold=results%u)
      call check_equilibrium(data%fem, results%u, data%f, contact, data%held, results%reaction, equilibrium, &
                             sizes_at_points(data, solution), data%thermal)
      imbalance = check_balance(data%fem, data%f, contact, data%rows)
      results%strain_energy = elastic_energy(data%fem, results%u, equilibrium%energy)
      call add_rigid_motions(data%fem, solution%state%a, results%u)
      results%converged = solution%converged
      results%law_holds = equilibrium%holds .and. imbalance <= 1.0e-8_wp
      if (equilibrium%largest_force > 0.0_wp) results%equilibrium_residual = equilibrium%residual/equilibrium%largest_force
      if (.not. results%law_holds) results%verdict = 'the bodies are not in equilibrium: residual ' &
                                                     //to_text(results%equilibrium_residual, 3)//', imbalance ' &
                                                     //to_text(imbalance, 3)
      if (.not. solution%converged) results%verdict = solution%verdict
      others = 0.0_wp
      results%prescribed = data%held
      if (data%rows%n_bilateral > 0) call share_out_rows(data, solution, contact, results, others)
      call sum_forces(data%fem%mesh%x, results%u, data%f, results%reaction, contact, results%balance, results%external_work)
      results%balance%is_revolved = is_revolved(data%fem%mesh)
      results%balance%rows = others
      results%balance%rigid = results%balance%rigid - others
      if (data%rows%n_bilateral > 0) call clear_balance(results%balance)
      if (data%step%requests%bodies) call sum_bodies(data%fem, results%u, data%f, results%reaction, contact, results%bodies)
      call recover_contact(data%line, data%rows, data%points, solution, results%u, results%contact)
      call sum_joints(data%fem%bodies%of_node, data%points, results%contact, results%joints)
      call recover_stress(data%step%requests, data%fem, results)
      call copy_history(solution, results)
   end subroutine recover

   !> The forces at the contact points and their pairs, and the rigid motions of the bodies.
   pure function sizes_at_points(data, solution) result(sizes)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(in) :: solution
      type(contact_sizes_t) :: sizes
      integer(ip) :: b, first, n

      sizes%force = data%line%weight*hypot(solution%p, solution%t)
      sizes%pair = data%line%pair
      sizes%rows = data%rows
      allocate (sizes%motion(data%fem%bodies%n))
      first = 1
      do b = 1, data%fem%bodies%n
         n = size(data%fem%bodies%list(b)%modes, 2, kind=ip)
         sizes%motion(b) = sum(abs(solution%state%a(first:first + n - 1)))
         first = first + n
      end do
   end function sizes_at_points

   pure subroutine copy_history(solution, results)
      type(contact_solution_t), intent(in) :: solution
      type(results_t), intent(inout) :: results

      allocate (results%iterations(0))
      if (solution%history%n > 0) results%iterations = solution%history%records(:solution%history%n)
      results%outer_iterations = solution%history%outer
      results%linear_solves = max(solution%history%n, 1_ip)
      results%contraction = solution%contraction
   end subroutine copy_history

   !> What a careful user should know of a solution.
   subroutine warn(data, solution, results)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(in) :: solution
      type(results_t), intent(in) :: results
      integer(ip) :: b
      real(wp) :: mode(3)

      if (is_reference_blas()) call add_warning('W-BLAS', 'this program was linked with the reference BLAS; with OpenBLAS' &
                                                //' it is about three times as fast')
      if (allocated(solution%inner%undetermined)) then
         call motion_body(data%fem, solution%inner%undetermined, b, mode)
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
      call note_shared_points(data%fem%mesh, data%rows, data%line, solution)
      call warn_of_others(data%model, results)
      call warn_of_large(results)
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
