!> One increment: from what acts to displacements, contact and its checks. The form of the contact system, and what is tried where
!> it finds no solution.
module atrito_increment
   use atrito_body_cache, only: body_cache_t
   use atrito_body_sums, only: sum_bodies
   use atrito_body_motions, only: add_rigid_motions, body_text, find_moved_body, how_it_moves
   use atrito_condensed_body, only: check_held
   use atrito_contact_form, only: contact_form_name, CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE
   use atrito_contact_rows, only: bodies_of_row
   use atrito_contact_scales, only: usual_growth, force_round_off, NONE_OF_HAD
   use atrito_contact_solution, only: contact_solution_t
   use atrito_controls, only: controls_t, METHOD_ANDERSON
   use atrito_displacements, only: contact_forces
   use atrito_extremes, only: find_extremes
   use atrito_final_check, only: check_equilibrium, check_balance, check_law, equilibrium_t
   use atrito_force_sums, only: sum_forces
   use atrito_joint_sums, only: sum_joints
   use atrito_increment_bound, only: prepare_bound, prove_bound
   use atrito_increment_uniqueness, only: judge_uniqueness
   use atrito_idle_motions, only: settle_idle_motions, stop_slow_motion
   use atrito_kinds, only: ip, wp
   use atrito_ladder, only: RUNGS, is_tried, controls_of_rung, rung_text
   use atrito_linear_limits, only: find_large
   use atrito_mesh, only: is_revolved
   use atrito_number_range, only: explain_range
   use atrito_outer_loop, only: FREE_MOTION
   use atrito_picard_loop, only: is_too_much
   use atrito_recovery, only: recover_contact, recover_stress, estimate_error
   use atrito_reporter, only: report_progress
   use atrito_results, only: results_t, has_forces
   use atrito_rigid_results, only: take_rigid_results
   use atrito_row_entries, only: first_motions
   use atrito_row_forces, only: share_out_rows, clear_balance, leave_out_sections
   use atrito_scene_data, only: scene_data_t, assemble, drop_assembled, forces_at_end
   use atrito_section_forces, only: sum_cuts
   use atrito_solve_condensed, only: solve_condensed, release_condensed
   use atrito_solve_multiplier, only: solve_multiplier
   use atrito_status, only: status_t, is_ok
   use atrito_step_loads, only: moment_t
   use atrito_strings, only: to_text
   use atrito_thermal_loads, only: elastic_energy
   use atrito_timers, only: start_phase, stop_phase
   use atrito_verdict, only: judge_balance
   use atrito_weak_forces, only: contact_sizes_t
   implicit none (type, external)
   private
   public :: solve_increment, begin_results, finish_form, complete_results, is_solved

   !> Entries of C to go through where either form may be taken: with 400 unknown forces 900 linear solves, with 100 15,000.
   real(wp), parameter :: MOST_ENTRIES = 1.5e8_wp

   integer, parameter :: MOST_CHANGES = 3                  !< of loads that hang on the digits of the deck

contains

   !> Solves for what acts in `data`. status: as solve_static. results%converged and law_holds tell the rest.
   subroutine solve_increment(data, asked_form, store, results, solution, status)
      type(scene_data_t), intent(inout) :: data
      integer, intent(in) :: asked_form                     !< CONTACT_*
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results             !< with the scene; nothing else is there yet
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(controls_t) :: controls

      controls = data%step%controls
      if (asked_form == CONTACT_AUTO) controls%most_entries = MOST_ENTRIES
      controls%most_factorisations = data%most_factorisations
      controls%logs_solves = associated(data%viewer)
      call solve_one_form(data, data%contact_form, controls, store, results, solution, status)
      if (results%scene%near_elements .and. .not. is_solved(results, status)) then
         call solve_without_near(data, controls, store, results, solution, status)
      end if
      if (is_ok(status) .and. .not. is_solved(results, status)) call climb(data, asked_form, controls, store, results, solution)
      if (associated(data%viewer)) call data%viewer%view(data, results, solution)
      if (.not. data%keeps) call release_condensed(data, store)
      if (.not. is_solved(results, status)) call explain_range(data, results, status)
   end subroutine solve_increment

   !> Whether an increment has a solution: the outer loop converged and the final check holds.
   pure logical function is_solved(results, status)
      type(results_t), intent(in) :: results
      type(status_t), intent(in) :: status

      is_solved = is_ok(status) .and. results%converged .and. results%law_holds
   end function is_solved

   !> Solves again with the stiffness of each element: where a body is as slender as the digits of its nodes are few, taking near
   !> elements as equal says nothing of it, and refinement does not converge. It does not begin from the increment before,
   !> which stays what was found last.
   subroutine solve_without_near(data, controls, store, results, solution, status)
      type(scene_data_t), intent(inout) :: data
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(results_t) :: again
      type(contact_solution_t), allocatable :: last

      call report_progress(data%reporter, 'not solved; each element with its own last digits')
      call begin_results(results, again)
      again%scene%near_elements = .false.
      results = again
      data%fem%grain = 0.0_wp
      call drop_assembled(data)
      if (allocated(data%flexibility)) deallocate (data%flexibility)
      call move_alloc(data%last, last)
      call solve_one_form(data, data%contact_form, controls, store, results, solution, status)
      call move_alloc(last, data%last)
   end subroutine solve_without_near

   !> Solves by one form of the contact system, and checks what it found. Without a solution it is judged whether there can be one:
   !> status is STATUS_SINGULAR where there is none, STATUS_INTERNAL where the memory did not suffice for a solve.
   subroutine solve_one_form(data, form, controls, store, results, solution, status)
      type(scene_data_t), intent(inout) :: data
      integer, intent(in) :: form                           !< CONTACT_DENSE or CONTACT_SPARSE
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results             !< with the scene; nothing else is there yet
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      real(wp), allocatable :: u(:, :)                      ! without rigid motions, (2, n_nodes) [L]
      logical :: again
      integer :: change

      do change = 1, MOST_CHANGES + 1
         again = change <= MOST_CHANGES
         call solve_form(data, form, controls, store, results, solution, u, again, status)
         if (.not. again) exit                              ! the loads have lost what only the digits of the deck make of them
      end do
      if (.not. is_ok(status)) return
      call finish_form(data, controls, solution, u, results, status)
   end subroutine solve_one_form

   !> From a solution of the contact system to results, and the final check. status: as solve_one_form.
   subroutine finish_form(data, controls, solution, u, results, status)
      type(scene_data_t), intent(inout) :: data
      type(controls_t), intent(in) :: controls
      type(contact_solution_t), intent(inout) :: solution
      real(wp), allocatable, intent(inout) :: u(:, :)       !< without rigid motions, (2, n_nodes) [L]; moved to the results
      type(results_t), intent(inout) :: results             !< with the scene
      type(status_t), intent(out) :: status
      character(len=:), allocatable :: verdict
      integer(ip) :: b
      logical :: again

      call start_phase('recover')
      if (data%is_printed) call begin_early(data, solution, u)
      if (allocated(data%had%motion)) call clear_what_is_left(data, solution, u)
      call recover(data, solution, u, results)
      call stop_phase('recover')
      if (data%is_printed) call complete_results(data, results)
      call start_phase('check')
      call check_law(data%rows, data%line, max(controls%tolerance, solution%residual), results, data%fem%bodies%of_node, &
                     [(usual_growth(data%fem%bodies%list(b)%n, results%scene%bodies(b)%digits_lost), b=1, data%fem%bodies%n)], &
                     data%had, solution%inner%condition)
      if (results%converged .and. .not. results%law_holds .and. data%line%n > 0) then
         call move_alloc(results%verdict, verdict)
         again = .false.
         call judge(data, results, verdict, again, status)
         call move_alloc(verdict, results%verdict)
      end if
      call stop_phase('check')
      call take_rigid_results(data, solution, results)
      call prove_bound(data, solution, results)
   end subroutine finish_form

   !> The solution of one form, with the least of the idle motions.
   subroutine solve_form(data, form, controls, store, results, solution, u, again, status)
      type(scene_data_t), intent(inout) :: data
      integer, intent(in) :: form                           !< CONTACT_DENSE or CONTACT_SPARSE
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(out) :: solution
      real(wp), allocatable, intent(out) :: u(:, :)         !< without rigid motions, (2, n_nodes) [L]
      logical, intent(inout) :: again                       !< in: whether loads may change; out: they have
      type(status_t), intent(out) :: status
      logical :: may_change

      may_change = again
      again = .false.
      if (form == CONTACT_SPARSE) then
         call solve_assembled(data, controls, results, solution, u, status)
      else
         if (.not. allocated(data%flexibility) .and. allocated(data%certificate)) deallocate (data%certificate)
         call solve_condensed(data, controls, store, results%scene, solution, u, status)
         if (solution%factorisations > 0) results%factorisations = solution%factorisations
      end if
      if (allocated(data%assembled)) call data%assembled%check_solves(status)   ! whatever came of a solve that failed
      solution%form = form
      if (is_ok(status)) call judge_uniqueness(data, solution, results)
      call prepare_bound(data, form, store, solution, results)
      if (form == CONTACT_DENSE .and. solution%converged .and. .not. data%keeps) call release_condensed(data, store)
      call start_phase('iterate')
      again = may_change
      call judge_outcome(data, results, solution, again, status)
      call stop_phase('iterate')
      if (again .or. .not. (is_ok(status) .and. solution%converged)) return
      call start_phase('recover')
      again = may_change
      call settle_idle_motions(data, u, data%before, solution, again)
      call stop_phase('recover')
   end subroutine solve_form

   !> The sparse form: all bodies in one matrix, which is assembled where it is not there.
   subroutine solve_assembled(data, controls, results, solution, u, status)
      type(scene_data_t), intent(inout) :: data
      type(controls_t), intent(in) :: controls
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(out) :: solution
      real(wp), allocatable, intent(out) :: u(:, :)         !< without rigid motions, (2, n_nodes) [L]
      type(status_t), intent(out) :: status
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
      call solve_multiplier(data, data%assembled, controls, solution, u, status)
      results%factorisations = solution%factorisations
      call stop_phase('iterate')
      if (allocated(u) .and. .not. data%keeps) call drop_assembled(data)   ! the stresses want the memory of the factors
   end subroutine solve_assembled

   !> Where nothing acts on a body any more, what is left of its displacements and of the forces on it is round-off of what it had.
   pure subroutine clear_what_is_left(data, solution, u)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(inout) :: solution
      real(wp), intent(inout) :: u(:, :)                    !< without rigid motions, (2, n_nodes) [L]
      logical :: is_still(data%fem%bodies%n)
      integer(ip) :: first(data%fem%bodies%n + 1), b, i, j

      first = first_motions(data%fem%bodies)
      do b = 1, data%fem%bodies%n
         associate (nodes => data%fem%bodies%list(b)%nodes, a => solution%state%a(first(b):first(b + 1) - 1))
            is_still(b) = maxval(abs(u(:, nodes))) + sum(abs(a)) <= NONE_OF_HAD*data%had%motion(b) .and. &
                          all(data%f(:, nodes) == 0.0_wp)
            if (is_still(b)) then
               u(:, nodes) = 0.0_wp
               a = 0.0_wp
            end if
         end associate
      end do
      do i = 1, size(data%line%point, kind=ip)
         j = data%line%point(i)
         associate (of_row => bodies_of_row(data%rows, j, data%fem%bodies%of_node))
            if (.not. all(is_still(pack(of_row, of_row > 0)))) cycle
            if (abs(solution%state%q(i)) > NONE_OF_HAD*maxval(data%had%force(pack(of_row, of_row > 0)))) cycle
         end associate
         solution%state%q(i) = 0.0_wp
         if (data%line%normal(j) == i) solution%p(j) = 0.0_wp
         if (data%line%tangential(j) == i) solution%t(j) = 0.0_wp
      end do
   end subroutine clear_what_is_left

   !> One rung after the other. What is found counts when it converges and its law holds; else all is as it was.
   subroutine climb(data, asked_form, controls, store, results, solution)
      type(scene_data_t), intent(inout) :: data
      integer, intent(in) :: asked_form                     !< CONTACT_*
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(inout) :: solution
      type(results_t) :: other
      type(contact_solution_t) :: other_solution
      type(controls_t) :: its_controls
      type(status_t) :: status
      integer(ip) :: m, solves
      integer :: i

      if (controls%method /= METHOD_ANDERSON) return        ! the user's own choice
      m = size(data%line%point, kind=ip)
      solves = merge(solution%history%n, 0_ip, data%contact_form == CONTACT_DENSE)
      do i = 1, size(RUNGS)
         if (.not. is_tried(i, data%contact_form, asked_form, m, data%may_cut, data%is_brief)) cycle
         if (RUNGS(i)%form == CONTACT_DENSE .and. is_too_much(controls, m, solves)) cycle
         its_controls = controls_of_rung(RUNGS(i), controls)
         call report_progress(data%reporter, 'no solution; the '//contact_form_name(RUNGS(i)%form) &
                              //' form of the contact system'//rung_text(RUNGS(i), its_controls))
         call begin_results(results, other)
         if (RUNGS(i)%form /= data%contact_form) then
            other%scene%contact_form = contact_form_name(RUNGS(i)%form)
            other%scene%contact_reason = 'what was tried before found no solution'
         end if
         call solve_one_form(data, RUNGS(i)%form, its_controls, store, other, other_solution, status)
         if (RUNGS(i)%form == CONTACT_DENSE) solves = solves + other_solution%history%n
         if (.not. is_solved(other, status)) cycle
         solution = other_solution
         results = other
         return
      end do
   end subroutine climb

   !> Scene, and place in the history, of another attempt.
   pure subroutine begin_results(results, other)
      type(results_t), intent(in) :: results
      type(results_t), intent(out) :: other

      other%scene = results%scene
      other%step = results%step
      other%increment = results%increment
      other%time = results%time
      other%step_time = results%step_time
      other%ends_step = results%ends_step
      other%factorisations = results%factorisations         ! of bodies that serve again
   end subroutine begin_results

   !> Without a solution: whether there can be one. Free motion becomes a proof of it, or a last iterate that did not converge.
   subroutine judge_outcome(data, results, solution, again, status)
      type(scene_data_t), intent(inout) :: data
      type(results_t), intent(in) :: results               !< when, and the pairs
      type(contact_solution_t), intent(inout) :: solution
      logical, intent(inout) :: again                      !< in: whether loads may change; out: they have
      type(status_t), intent(inout) :: status
      logical :: moves, may_change

      may_change = again
      again = .false.

      moves = .false.
      if (.not. is_ok(status)) moves = status%text == FREE_MOTION
      if (.not. moves .and. (solution%converged .or. .not. is_ok(status))) return
      solution%converged = .false.
      if (moves) solution%verdict = trim(merge('no friction bound that was tried holds the bodies', &
                                               'no contact forces that were tried hold the bodies', &
                                               data%line%has_friction))//moving_text(data, solution)
      again = may_change
      call judge(data, results, solution%verdict, again, status)
      if (may_change .and. is_ok(status) .and. .not. again) call stop_slow_motion(data, solution, again)
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
      call find_moved_body(data%fem%bodies, solution%inner%motion, b, mode)
      text = ': '//body_text(data%fem, b)//' would '//how_it_moves(data%fem, b, mode)
   end function moving_text

   !> Whether there can be a solution, in words behind the verdict. status: STATUS_SINGULAR where none can be.
   subroutine judge(data, results, verdict, again, status)
      type(scene_data_t), intent(inout) :: data
      type(results_t), intent(in) :: results                !< when, and the pairs
      character(len=:), allocatable, intent(inout) :: verdict
      logical, intent(inout) :: again                       !< in: whether loads may change; out: they have
      type(status_t), intent(inout) :: status
      real(wp), allocatable :: f_end(:, :)

      call forces_at_end(data, moment_t(results%step_time, results%time), f_end)
      call judge_balance(data, f_end, results%scene%pairs, verdict, again, status)
   end subroutine judge

   !> What is worth its time where it is printed: sums by joint, stresses and their error, the largest of all, the limits of
   !> a linear theory.
   subroutine complete_results(data, results)
      type(scene_data_t), intent(inout) :: data
      type(results_t), intent(inout) :: results
      real(wp) :: strain_bound

      call start_phase('recover')
      if (data%is_distributed) call data%distribution%begin_fields(data%fem, results%u, data%wants_element_errors)
      call sum_joints(data%fem%bodies%of_node, data%points, results%contact, results%joints)
      call recover_stress(data%step%requests, data%fem, results)
      call stop_phase('recover')
      call start_phase('estimate')
      if (data%is_distributed) then
         call data%distribution%end_fields(data%fem, results, strain_bound)
      else
         call estimate_error(data%fem, results, strain_bound, data%wants_element_errors)
      end if
      if (.not. (has_forces(results) .or. allocated(data%thermal))) call clear_stresses(results)
      call find_large(data%model, data%fem, strain_bound, results)
      call find_extremes(data%model%mesh, data%fem%bodies%of_node, data%points, results)
      call stop_phase('estimate')
   end subroutine complete_results

   !> Without forces stresses are round-off of displacements.
   pure subroutine clear_stresses(results)
      type(results_t), intent(inout) :: results

      if (allocated(results%stress)) results%stress = 0.0_wp
      if (allocated(results%nodal_stress)) results%nodal_stress = 0.0_wp
      if (allocated(results%element_error)) results%element_error = 0.0_wp
      results%error_estimate = 0.0_wp
   end subroutine clear_stresses

   !> Where there are several processes the others begin with the fields, while this one checks the equilibrium.
   subroutine begin_early(data, solution, u)
      type(scene_data_t), intent(inout) :: data
      type(contact_solution_t), intent(in) :: solution
      real(wp), intent(in) :: u(:, :)                       !< without rigid motions, (2, n_nodes) [L]
      real(wp), allocatable :: total(:, :)

      if (.not. data%is_distributed) return
      total = u
      call add_rigid_motions(data%fem, solution%state%a, total)
      call data%distribution%begin_fields(data%fem, total, data%wants_element_errors)
   end subroutine begin_early

   !> Displacements, reactions, contact fields, energies and balances.
   subroutine recover(data, solution, u, results)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(inout) :: solution
      real(wp), allocatable, intent(inout) :: u(:, :)      !< without rigid motions, (2, n_nodes) [L]; moved to the results
      type(results_t), intent(inout) :: results
      real(wp), allocatable :: contact(:, :)
      type(equilibrium_t) :: equilibrium
      real(wp) :: imbalance, others(3)

      contact = contact_forces(data%fem, data%rows, data%line, solution)
      call move_alloc(u, results%u)
      allocate (results%reaction, mold=results%u)
      call check_equilibrium(data%fem, results%u, data%f, contact, data%held, results%reaction, equilibrium, &
                             sizes_at_points(data, solution), data%thermal)
      imbalance = check_balance(data%fem, data%f, contact, data%rows, data%had)
      results%strain_energy = elastic_energy(data%fem, results%u, equilibrium%energy)
      if (allocated(data%step%requests%cuts)) then          ! rigid motions would cost digits
         call sum_cuts(data, moment_t(results%step_time, results%time), results%u, results%reaction - contact, results%cuts)
      end if
      call add_rigid_motions(data%fem, solution%state%a, results%u)
      results%converged = solution%converged
      results%law_holds = equilibrium%holds .and. imbalance <= 1.0e-8_wp
      if (results%law_holds .and. .not. equilibrium%has_forces) then   ! bodies that move without strain
         results%reaction = 0.0_wp
         results%strain_energy = 0.0_wp
         equilibrium%residual = 0.0_wp
      end if
      associate (force => max(equilibrium%largest_force, force_round_off(data%had)/NONE_OF_HAD))
         if (force > 0.0_wp) results%equilibrium_residual = equilibrium%residual/force
      end associate
      if (.not. results%law_holds) results%verdict = 'the bodies are not in equilibrium: residual ' &
                                                     //to_text(results%equilibrium_residual, 3)//', imbalance ' &
                                                     //to_text(imbalance, 3)
      if (.not. solution%converged) results%verdict = solution%verdict
      others = 0.0_wp
      results%prescribed = data%held
      if (data%rows%n_bilateral > 0) call share_out_rows(data, solution, contact, results, others)
      call sum_forces(data%fem%mesh%x, results%u, data%f, results%reaction, contact, results%balance, results%external_work)
      call leave_out_sections(data, results%reaction, contact, results%balance)
      results%balance%is_revolved = is_revolved(data%fem%mesh)
      results%balance%rows = others(:2)
      results%balance%rows_moment = others(3)
      results%balance%rigid = results%balance%rigid - others(:2)
      results%balance%rigid_moment = results%balance%rigid_moment - others(3)
      if (data%rows%n_bilateral > 0) call clear_balance(results%balance)
      ! with the contact forces less those of bilateral rows that are supports
      if (data%step%requests%bodies) call sum_bodies(data%fem, results%u, data%f, results%reaction, contact, results%bodies)
      call recover_contact(data%line, data%rows, data%points, solution, results%u, results%contact)
      allocate (results%iterations(0))
      if (solution%history%n > 0) results%iterations = solution%history%records(:solution%history%n)
      results%outer_iterations = solution%history%outer
      results%linear_solves = max(solution%history%n, 1_ip)
      results%contraction = solution%contraction
      call measure_sizes(data, contact, results, solution)
   end subroutine recover

   !> The largest displacement of each body, and the largest force at a node of it.
   pure subroutine measure_sizes(data, contact, results, solution)
      type(scene_data_t), intent(in) :: data
      real(wp), intent(in) :: contact(:, :)                 !< (2, n_nodes) [F]
      type(results_t), intent(in) :: results
      type(contact_solution_t), intent(inout) :: solution
      integer(ip) :: b

      solution%body_motion = [(0.0_wp, b=1, data%fem%bodies%n)]
      solution%body_force = solution%body_motion
      do b = 1, data%fem%bodies%n
         associate (nodes => data%fem%bodies%list(b)%nodes)
            solution%body_motion(b) = maxval(abs(results%u(:, nodes)))
            solution%body_force(b) = max(maxval(abs(data%f(:, nodes))), maxval(abs(contact(:, nodes))), &
                                         maxval(abs(results%reaction(:, nodes))))
         end associate
      end do
   end subroutine measure_sizes

   !> The forces at the contact points and their pairs, and the rigid motions of the bodies.
   pure function sizes_at_points(data, solution) result(sizes)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(in) :: solution
      type(contact_sizes_t) :: sizes
      integer(ip) :: first(data%fem%bodies%n + 1), b

      sizes%force = data%line%weight*hypot(solution%p, solution%t)
      sizes%pair = data%line%pair
      sizes%rows = data%rows
      sizes%had = data%had
      first = first_motions(data%fem%bodies)
      sizes%motion = [(sum(abs(solution%state%a(first(b):first(b + 1) - 1))), b=1, data%fem%bodies%n)]
   end function sizes_at_points

end module atrito_increment
