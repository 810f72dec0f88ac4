!> One increment: from what acts to displacements, contact and its checks. The form of the contact system, and what is tried where
!> it finds no solution.
module atrito_increment
   use atrito_body_cache, only: body_cache_t
   use atrito_body_sums, only: sum_bodies
   use atrito_body_motions, only: add_rigid_motions, body_text, find_moved_body, how_it_moves
   use atrito_contact_form, only: can_be_dense, contact_form_name, CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE
   use atrito_contact_rows, only: bodies_of_row
   use atrito_contact_scales, only: usual_growth, force_round_off, NONE_OF_HAD
   use atrito_contact_solution, only: contact_solution_t
   use atrito_controls, only: controls_t, METHOD_ANDERSON, METHOD_NEWTON, METHOD_PICARD
   use atrito_dense_form, only: solve_dense_form
   use atrito_displacements, only: contact_forces
   use atrito_extremes, only: find_extremes
   use atrito_final_check, only: check_equilibrium, check_balance, check_law, equilibrium_t
   use atrito_force_sums, only: sum_forces
   use atrito_joint_sums, only: sum_joints
   use atrito_idle_motions, only: settle_idle_motions, stop_slow_motion
   use atrito_kinds, only: ip, wp
   use atrito_linear_limits, only: find_large
   use atrito_mesh, only: is_revolved
   use atrito_number_range, only: explain_range
   use atrito_outer_loop, only: FREE_MOTION
   use atrito_recovery, only: recover_contact, recover_stress, estimate_error
   use atrito_reporter, only: report_progress
   use atrito_results, only: results_t, scene_t
   use atrito_rigid_results, only: take_rigid_results
   use atrito_row_forces, only: share_out_rows, clear_balance, leave_out_sections
   use atrito_scene_data, only: scene_data_t, drop_assembled, forces_at_end
   use atrito_section_forces, only: sum_cuts
   use atrito_sparse_form, only: solve_sparse_form
   use atrito_status, only: status_t, is_ok
   use atrito_step_loads, only: moment_t
   use atrito_strings, only: to_text
   use atrito_thermal_loads, only: elastic_energy
   use atrito_timers, only: start_phase, stop_phase
   use atrito_verdict, only: judge_balance
   use atrito_weak_forces, only: contact_sizes_t
   implicit none (type, external)
   private
   public :: solve_increment, complete_results, is_solved

   !> Entries of C to go through where either form may be taken: with 400 unknown forces 900 linear solves, with 100 15,000.
   real(wp), parameter :: MOST_ENTRIES = 1.5e8_wp

   !> What is tried where the first attempt found no solution and there is no proof that there is none: other forms and methods.
   type :: attempt_t
      integer :: form, method
      integer(ip) :: times = 1                             !< MAXIT
      real(wp) :: relaxation = 1.0_wp
      logical :: is_coarse = .false.                       !< controls_t
   end type attempt_t

   !> In this order. Of 7,500 random scenes the first solved 113, the second, with its own attempts (atrito_outer_loop), 56, the
   !> others one, one, one and two.
   type(attempt_t), parameter :: ATTEMPTS(6) = [attempt_t(CONTACT_SPARSE, METHOD_ANDERSON), &
                                                attempt_t(CONTACT_DENSE, METHOD_ANDERSON), &
                                                attempt_t(CONTACT_DENSE, METHOD_NEWTON), &
                                                attempt_t(CONTACT_DENSE, METHOD_ANDERSON, is_coarse=.true.), &
                                                attempt_t(CONTACT_DENSE, METHOD_ANDERSON, 3), &
                                                attempt_t(CONTACT_DENSE, METHOD_PICARD, 10, 0.3_wp)]
   integer, parameter :: BRIEF = 2, QUICK = 3              !< of them where a shorter increment may do, and where points are many:
   integer, parameter :: MOST_PATIENT = 400                !< unknown forces
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
      type(controls_t) :: controls, first

      controls = data%step%controls
      controls%is_brief = data%may_cut
      if (asked_form == CONTACT_AUTO) controls%most_entries = MOST_ENTRIES
      first = controls
      first%is_first = asked_form == CONTACT_AUTO
      call solve_one_form(data, data%contact_form, first, store, results, solution, status)
      if (results%scene%near_elements .and. .not. is_solved(results, status)) then
         call solve_without_near(data, controls, store, results, solution, status)
      end if
      if (asked_form == CONTACT_AUTO .and. has_failed(data) .and. .not. is_ok(status)) then
         ! what is singular for the one form need not be so for the other
         if (can_be_dense(size(data%line%point, kind=ip))) then
            call solve_one_form(data, CONTACT_DENSE, controls, store, results, solution, status)
         end if
      end if
      if (asked_form == CONTACT_AUTO .and. is_ok(status) .and. .not. (results%converged .and. results%law_holds)) then
         call try_others(data, controls, store, results, solution)
      end if
      if (.not. is_solved(results, status)) call explain_range(data, results, status)
   end subroutine solve_increment

   !> Whether the matrix of the sparse form had no factor the last time.
   pure logical function has_failed(data)
      type(scene_data_t), intent(in) :: data

      has_failed = allocated(data%assembled)
      if (has_failed) has_failed = data%assembled%failed > 0
   end function has_failed

   !> Whether an increment has a solution: the outer loop converged and the final check holds.
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
      call begin_results(results, again)
      again%scene%near_elements = .false.
      results = again
      data%fem%grain = 0.0_wp
      call drop_assembled(data)
      if (allocated(data%flexibility)) deallocate (data%flexibility)
      if (allocated(data%last)) deallocate (data%last)
      call solve_one_form(data, data%contact_form, controls, store, results, solution, status)
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
      call start_phase('recover')
      if (data%is_printed) call begin_early(data, solution, u)
      if (allocated(data%had%motion)) call clear_what_is_left(data, solution, u)
      call recover(data, solution, u, results)
      call stop_phase('recover')
      if (data%is_printed) call complete_results(data, results)
      call start_phase('check')
      call check_law(data%rows, data%line, max(controls%tolerance, solution%residual), results, data%fem%bodies%of_node, &
                     growth_of_bodies(data, results%scene), data%had, solution%inner%condition)
      call judge_failed_check(data, results, status)
      call stop_phase('check')
      call take_rigid_results(data, solution, results)
   end subroutine solve_one_form

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
         call solve_sparse_form(data, controls, results, solution, u, status)
      else
         call solve_dense_form(data, controls, store, results, solution, u, status)
      end if
      if (allocated(data%assembled)) call data%assembled%check_solves(status)   ! whatever came of a solve that failed
      solution%form = form
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

   !> Where nothing acts on a body any more, what is left of its displacements and of the forces on it is round-off of what it had.
   pure subroutine clear_what_is_left(data, solution, u)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(inout) :: solution
      real(wp), intent(inout) :: u(:, :)                    !< without rigid motions, (2, n_nodes) [L]
      logical :: is_still(data%fem%bodies%n)
      integer(ip) :: b, i, j, first, n

      is_still = .false.
      first = 1
      do b = 1, data%fem%bodies%n
         associate (body => data%fem%bodies%list(b), a => solution%state%a)
            n = size(body%modes, 2, kind=ip)
            is_still(b) = maxval(abs(u(:, body%nodes))) + sum(abs(a(first:first + n - 1))) <= NONE_OF_HAD*data%had%motion(b)
            is_still(b) = is_still(b) .and. all(data%f(:, body%nodes) == 0.0_wp)
            if (is_still(b)) then
               u(:, body%nodes) = 0.0_wp
               a(first:first + n - 1) = 0.0_wp
            end if
            first = first + n
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

   !> One attempt after the other. What is found counts when it converges and its law holds.
   subroutine try_others(data, controls, store, results, solution)
      type(scene_data_t), intent(inout) :: data
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(inout) :: solution
      type(controls_t) :: other
      integer :: i, last

      if (controls%method /= METHOD_ANDERSON) return        ! the user's own choice
      last = size(ATTEMPTS)
      if (size(data%line%point) > MOST_PATIENT) last = QUICK
      if (controls%is_brief) last = BRIEF
      do i = 1, last
         if (ATTEMPTS(i)%form == CONTACT_SPARSE .and. data%contact_form == CONTACT_SPARSE) cycle
         other = controls
         other%method = ATTEMPTS(i)%method
         other%max_iterations = ATTEMPTS(i)%times*controls%max_iterations
         other%relaxation = ATTEMPTS(i)%relaxation
         other%is_coarse = ATTEMPTS(i)%is_coarse
         call try_form(data, ATTEMPTS(i)%form, other, store, results, solution)
         if (results%converged .and. results%law_holds) return
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
      call begin_results(results, other)
      other%scene%contact_form = contact_form_name(form)
      other%scene%contact_reason = 'what was tried before found no solution'
      call solve_one_form(data, form, controls, store, other, other_solution, status)
      if (.not. (is_ok(status) .and. other%converged .and. other%law_holds)) return
      solution = other_solution
      results = other
   end subroutine try_form

   !> Scene, and place in the history, of another attempt.
   pure subroutine begin_results(results, other)
      type(results_t), intent(in) :: results
      type(results_t), intent(inout) :: other

      other%scene = results%scene
      other%step = results%step
      other%increment = results%increment
      other%time = results%time
      other%step_time = results%step_time
      other%ends_step = results%ends_step
   end subroutine begin_results

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
   subroutine judge_outcome(data, results, solution, again, status)
      type(scene_data_t), intent(inout) :: data
      type(results_t), intent(in) :: results               !< when, and the pairs
      type(contact_solution_t), intent(inout) :: solution
      logical, intent(inout) :: again                      !< in: whether loads may change; out: they have
      type(status_t), intent(inout) :: status
      real(wp), allocatable :: f_end(:, :)
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
      call forces_at_end(data, moment_t(results%step_time, results%time), f_end)
      again = may_change
      call judge_balance(data, f_end, results%scene%pairs, solution%verdict, again, status)
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

   !> The same where the loop ended well and the final check did not.
   subroutine judge_failed_check(data, results, status)
      type(scene_data_t), intent(inout) :: data
      type(results_t), intent(inout) :: results
      type(status_t), intent(inout) :: status
      real(wp), allocatable :: f_end(:, :)
      logical :: again

      if (results%law_holds .or. .not. results%converged .or. data%line%n == 0) return
      call forces_at_end(data, moment_t(results%step_time, results%time), f_end)
      again = .false.
      call judge_balance(data, f_end, results%scene%pairs, results%verdict, again, status)
   end subroutine judge_failed_check

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
      call find_large(data%model, data%fem, strain_bound, results)
      call find_extremes(data%model%mesh, data%fem%bodies%of_node, data%points, results)
      call stop_phase('estimate')
   end subroutine complete_results

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
      real(wp) :: imbalance, others(2)

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
      results%balance%rows = others
      results%balance%rigid = results%balance%rigid - others
      if (data%rows%n_bilateral > 0) call clear_balance(results%balance)
      ! with the contact forces less those of bilateral rows that are supports
      if (data%step%requests%bodies) call sum_bodies(data%fem, results%u, data%f, results%reaction, contact, results%bodies)
      call recover_contact(data%line, data%rows, data%points, solution, results%u, results%contact)
      call copy_history(solution, results)
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
      integer(ip) :: b, first, n

      sizes%force = data%line%weight*hypot(solution%p, solution%t)
      sizes%pair = data%line%pair
      sizes%rows = data%rows
      sizes%had = data%had
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

end module atrito_increment
