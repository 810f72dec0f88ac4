!> One increment: from what acts to displacements, contact and its checks. The form of the contact system, and what is tried where
!> it finds no solution.
!>
!>     solve_increment
!>       solve_one_form             in the form that the scene has, dense or sparse
!>         solve_form               the contact system: solve_condensed, or assemble and solve_multiplier
!>           judge_outcome          no solution: can there be one? A proof that there is none ends the run (exit 4)
!>           settle_idle_motions    a solution: of those that differ by motions which nothing determines, the least
!>         finish_form              results, then the final check; a check that fails is judged as no solution is
!>       solve_without_near         not solved, and elements that nearly equal were taken as equal: again, each by itself
!>       climb                      not solved: the rungs of the ladder, one after the other, until one finds a solution
!>       attempt                    not solved, and a motion is idle: it lets out of a thin wedge that friction might hold
!>
!> A solution counts where the outer loop has converged and the final check, which knows nothing of how it was found, holds
!> (is_solved). All attempts begin from the same results (begin_results) and loads (put_back_loads), so an attempt that fails leaves
!> no trace but its time.
!>
!> Two steps can find that the loads hang on the last digits of the deck: a roller that would turn for a moment that only rounding
!> makes. Then these digits are taken out of the loads and the form is solved again, MOST_CHANGES times at most (`again`).
module atrito_increment
   use atrito_body_cache, only: body_cache_t
   use atrito_body_motions, only: body_text, find_moved_body, how_it_moves
   use atrito_condensed_body, only: check_held
   use atrito_contact_form, only: contact_form_name, CONTACT_AUTO, CONTACT_DENSE, CONTACT_SPARSE
   use atrito_contact_scales, only: usual_growth, had_t, widen
   use atrito_contact_solution, only: contact_solution_t
   use atrito_controls, only: controls_t, METHOD_ANDERSON
   use atrito_final_check, only: check_law
   use atrito_increment_bound, only: prepare_bound, prove_bound
   use atrito_increment_results, only: begin_early, clear_round_off, clear_what_is_left, complete_results, had_by_forces, recover
   use atrito_idle_motions, only: settle_idle_motions, stop_slow_motion
   use atrito_kinds, only: ip, wp
   use atrito_ladder, only: RUNGS, is_tried, controls_of_rung, rung_text
   use atrito_number_range, only: explain_range, is_out_of_range
   use atrito_other_solutions, only: find_others
   use atrito_outer_loop, only: FREE_MOTION
   use atrito_picard_loop, only: is_too_much
   use atrito_reporter, only: report_progress
   use atrito_results, only: results_t
   use atrito_rigid_results, only: take_rigid_results
   use atrito_scene_data, only: scene_data_t, assemble, drop_assembled, forces_at_end, put_back_loads
   use atrito_solve_condensed, only: solve_condensed, release_condensed, expand_solution
   use atrito_solve_multiplier, only: solve_multiplier
   use atrito_status, only: status_t, is_ok
   use atrito_step_loads, only: moment_t
   use atrito_strings, only: to_text
   use atrito_timers, only: start_phase, stop_phase
   use atrito_uniqueness, only: certify_line, certify_scene, judge_contraction, judge_solution, is_certified
   use atrito_verdict, only: judge_balance
   implicit none (type, external)
   private
   public :: solve_increment, search_solutions, is_solved

   !> Entries of C to go through where either form may be taken: with 400 unknown forces 900 linear solves, with 100 15,000.
   real(wp), parameter :: MOST_ENTRIES = 1.5e8_wp

   integer, parameter :: MOST_CHANGES = 6                  !< of loads that hang on the digits of the deck

contains

   !> Solves for what acts in `data`. status: as solve_static. results%converged and law_holds tell the rest.
   subroutine solve_increment(data, asked_form, store, results, solution, status)
      type(scene_data_t), intent(inout) :: data             !< with the loads of its time; matrices stay in it
      integer, intent(in) :: asked_form                     !< CONTACT_*
      type(body_cache_t), intent(inout) :: store            !< of bodies, factored or not yet
      type(results_t), intent(inout) :: results             !< with the scene; nothing else is there yet
      type(contact_solution_t), intent(out) :: solution     !< of the attempt that counts
      type(status_t), intent(out) :: status                 !< STATUS_OK, STATUS_SINGULAR, STATUS_DECK or STATUS_INTERNAL
      type(controls_t) :: controls
      integer :: idle_form                                  ! in which a motion was idle, but no solution
      type(contact_solution_t) :: tried
      logical :: found

      controls = data%step%controls
      if (asked_form == CONTACT_AUTO) controls%most_entries = MOST_ENTRIES
      controls%most_factorisations = data%most_factorisations
      controls%logs_solves = associated(data%viewer)
      call solve_one_form(data, data%contact_form, controls, store, results, solution, status)
      if (.not. is_solved(results, status)) call explain_range(data, results, status)
      if (.not. is_out_of_range(results)) then              ! else no attempt can help
         if (results%scene%near_elements .and. .not. is_solved(results, status)) then
            call solve_without_near(data, controls, store, results, solution, status)
         end if
         idle_form = data%contact_form
         if (.not. allocated(solution%inner%undetermined)) idle_form = CONTACT_AUTO
         if (is_ok(status) .and. .not. is_solved(results, status)) then
            call climb(data, asked_form, controls, store, results, solution, idle_form)
         end if
         if (is_ok(status) .and. .not. is_solved(results, status) .and. data%line%has_friction .and. idle_form /= CONTACT_AUTO) then
            ! A thin wedge lets out what nothing presses into it. With friction it may hold it as well, which the rungs would have
            ! found: now the least motion goes as far as it must.
            data%lets_out = .true.
            call attempt(data, idle_form, controls, store, results, solution, tried, found)
            data%lets_out = .false.
         end if
      end if
      if (associated(data%viewer)) call data%viewer%view(data, results, solution)
      if (.not. data%keeps) call release_condensed(data, store)
   end subroutine solve_increment

   !> Whether an increment has a solution: the outer loop converged and the final check holds.
   pure logical function is_solved(results, status)
      type(results_t), intent(in) :: results     !< converged and law_holds are read
      type(status_t), intent(in) :: status       !< of the solve

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
      data%fem%digit_error = 0.0_wp
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

      call put_back_loads(data)
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
      type(scene_data_t), intent(inout) :: data             !< with the loads of its time
      type(controls_t), intent(in) :: controls              !< of this attempt
      type(contact_solution_t), intent(inout) :: solution   !< round-off of bodies that rest is cleared
      real(wp), allocatable, intent(inout) :: u(:, :)       !< without rigid motions, (2, n_nodes) [L]; moved to the results
      type(results_t), intent(inout) :: results             !< with the scene
      type(status_t), intent(out) :: status                 !< STATUS_OK, or a proof that there is no solution
      character(len=:), allocatable :: verdict
      integer(ip) :: b
      logical :: again

      call start_phase('recover')
      if (data%is_printed) call begin_early(data, solution, u)
      call clear_round_off(data, solution)
      if (allocated(data%had%motion)) call clear_what_is_left(data, solution, u)
      call recover(data, solution, u, results)
      call stop_phase('recover')
      if (data%is_printed) call complete_results(data, results)
      call start_phase('check')
      call check_law(data%rows, data%line, max(controls%tolerance, solution%residual), results, data%fem%bodies%of_node, &
                     [(usual_growth(data%fem%bodies%list(b)%n, results%scene%bodies(b)%digits_lost), b=1, data%fem%bodies%n)], &
                     had_by_forces(data, solution), solution%inner%condition, solution%round_off)
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
      if (again .or. solution%converged) return
      call judge_outcome(data, results, solution, again, status)
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

   !> One rung after the other, until one finds a solution.
   subroutine climb(data, asked_form, controls, store, results, solution, idle_form)
      type(scene_data_t), intent(inout) :: data
      integer, intent(in) :: asked_form                     !< CONTACT_*
      type(controls_t), intent(in) :: controls
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(inout) :: solution
      integer, intent(inout) :: idle_form                   !< in which a motion was idle; CONTACT_AUTO: in none yet
      type(contact_solution_t) :: tried
      type(controls_t) :: its_controls
      integer(ip) :: m, solves
      integer :: i
      logical :: found

      if (controls%method /= METHOD_ANDERSON) return        ! the user's own choice
      m = size(data%line%point, kind=ip)
      solves = merge(solution%history%n, 0_ip, data%contact_form == CONTACT_DENSE)
      do i = 1, size(RUNGS)
         if (.not. is_tried(i, data%contact_form, asked_form, m, data%may_cut, data%is_brief)) cycle
         if (RUNGS(i)%form == CONTACT_DENSE .and. is_too_much(controls, m, solves)) cycle
         its_controls = controls_of_rung(RUNGS(i), controls)
         call report_progress(data%reporter, 'no solution; the '//contact_form_name(RUNGS(i)%form) &
                              //' form of the contact system'//rung_text(RUNGS(i), its_controls))
         call attempt(data, RUNGS(i)%form, its_controls, store, results, solution, tried, found)
         if (found) return
         if (RUNGS(i)%form == CONTACT_DENSE) solves = solves + tried%history%n
         if (idle_form == CONTACT_AUTO .and. allocated(tried%inner%undetermined)) idle_form = RUNGS(i)%form
      end do
   end subroutine climb

   !> Solves once more. What is found counts when it converges and its law holds; else results and solution are as they were.
   subroutine attempt(data, form, controls, store, results, solution, tried, found)
      type(scene_data_t), intent(inout) :: data
      integer, intent(in) :: form                           !< CONTACT_DENSE or CONTACT_SPARSE
      type(controls_t), intent(in) :: controls              !< of this attempt
      type(body_cache_t), intent(inout) :: store
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(inout) :: solution
      type(contact_solution_t), intent(out) :: tried        !< its solution, or last iterate
      logical, intent(out) :: found
      type(results_t) :: other
      type(status_t) :: status

      call begin_results(results, other)
      if (form /= data%contact_form) then
         other%scene%contact_form = contact_form_name(form)
         other%scene%contact_reason = 'what was tried before found no solution'
      end if
      call solve_one_form(data, form, controls, store, other, tried, status)
      found = is_solved(other, status)
      if (.not. found) return
      solution = tried
      results = other
   end subroutine attempt

   !> Scene, and place in the history, of another attempt.
   pure subroutine begin_results(results, other)
      type(results_t), intent(in) :: results     !< of the first attempt, or of the first solution
      type(results_t), intent(out) :: other      !< nothing of a solution

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

   !> Judges a solution, converged or not. What does not depend on the loads is found once for the matrices of the line. A solution
   !> of the sparse form has a certificate, and is judged where the dense one has been tried and has left its matrices.
   subroutine judge_uniqueness(data, solution, results)
      type(scene_data_t), intent(inout) :: data        !< certificate is made once for its matrices
      type(contact_solution_t), intent(in) :: solution !< of the increment
      type(results_t), intent(inout) :: results        !< get uniqueness and contraction_estimate

      if (.not. data%line%has_friction) return
      call start_phase('unique')
      if (.not. allocated(data%flexibility)) then
         if (.not. allocated(data%certificate)) then
            allocate (data%certificate)
            call certify_scene(data%fem, data%rows, data%line, data%starts > 0, data%certificate)
         end if
         results%uniqueness = data%certificate%known
      else
         if (.not. allocated(data%certificate)) then
            allocate (data%certificate)
            call certify_line(data%flexibility, data%line, data%starts > 0, data%certificate)
         end if
         results%uniqueness = data%certificate%known
         call judge_solution(data%flexibility, data%line, solution, data%is_last, data%certificate, results%uniqueness)
         if (data%is_printed) call judge_contraction(data%flexibility, data%line, solution, data%certificate, &
                                                     results%contraction_estimate)
      end if
      call stop_phase('unique')
   end subroutine judge_uniqueness

   !> Searches from data%starts starts. The numbers of both go into the results. Where the dense form was not tried there is nothing
   !> to search with, and where one solution is certified there is nothing to search for.
   subroutine search_solutions(data, store, first, results, others)
      type(scene_data_t), intent(inout) :: data             !< with C and G
      type(body_cache_t), intent(inout) :: store            !< with the bodies
      type(contact_solution_t), intent(in) :: first         !< from which the others are told apart
      type(results_t), intent(inout) :: results             !< of it
      type(results_t), allocatable, intent(out) :: others(:) !< each passed its check; without stresses
      type(contact_solution_t), allocatable :: found(:)
      type(results_t), allocatable :: list(:)
      type(had_t) :: had
      real(wp), allocatable :: u(:, :)
      type(status_t) :: status
      integer(ip) :: i, n

      allocate (others(0))
      if (data%starts == 0) return
      if (.not. (allocated(data%flexibility) .and. data%line%has_friction)) then
         if (data%line%has_friction .and. .not. results%uniqueness%up_to_nu > 0.0_wp) then
            results%uniqueness%why_not = 'no search either, the sparse form has no matrix'
         end if
         results%uniqueness%starts = data%starts
         return
      end if
      allocate (found(0))
      if (.not. is_certified(results%uniqueness)) then
         call start_phase('search')
         call find_others(data%flexibility, data%line, data%step%controls, first, data%starts, found)
         call stop_phase('search')
      end if
      allocate (list(size(found)))
      had = data%had                                        ! what is rounding beside the first is so in all
      call widen(data%had, first%body_motion, first%body_force)
      n = 0
      do i = 1, size(found, kind=ip)
         associate (other => list(n + 1))
            call begin_results(results, other)
            other%uniqueness = results%uniqueness
            call judge_solution(data%flexibility, data%line, found(i), .false., data%certificate, other%uniqueness)
            found(i)%form = CONTACT_DENSE
            call expand_solution(data, data%step%controls, store, other%scene, found(i), u)
            call finish_form(data, data%step%controls, found(i), u, other, status)
            if (is_solved(other, status)) n = n + 1
         end associate
      end do
      data%had = had
      others = list(:n)
      results%uniqueness%starts = data%starts
      results%uniqueness%solutions = n + 1
      others%uniqueness%starts = data%starts
      others%uniqueness%solutions = n + 1
      call report_progress(data%reporter, 'search '//to_text(data%starts)//' starts, '//to_text(n)//' other solutions')
   end subroutine search_solutions

end module atrito_increment
