!> A history of loads, step by step and increment by increment: the table of contents of what a run solves.
!>
!> What was factored serves as long as the same dofs are held; an increment changes what acts (atrito_step_loads) and the rest slips
!> of friction (atrito_slip_memory), and starts from the one before. One that fails is cut. A run of one increment is solve_static
!> and nothing else.
!>
!>     solve_history
!>       resume                     behind a recorded increment, where there is one: its state, rows and frames
!>       begin_step                 k = 1: bodies, points, rows; later: the same ones, unless other dofs are held
!>       go_through_step            until the time of the step is over
!>         try_increment            loads of the time reached, solve_increment, the search for other solutions
!>         keep_increment           solved: rest slips, a row a pair, iterations, what is observed, the frame where it is printed
!>         record                   what the next one begins from, to whoever keeps it (a restart file)
!>         cut_increment            not solved: a shorter one from the same state, down to the least length
!>       end_early                  not even so: the last increment that was solved is printed
!>       finish                     lists to their lengths; warnings, of the worst of all frames
!>
!> What the next increment needs of the one before is in run_t: the contact line as it was left (data%last), the memory of slip
!> (memory), the sizes of all motions and forces so far (data%had), which say what is round-off where little acts, and the results
!> (last). An increment that fails changes none of it, which is why it may simply be tried again over a shorter time.
module atrito_history
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_body_cache, only: body_cache_t, release_bodies
   use atrito_contact_scales, only: had_t, widen
   use atrito_contact_solution, only: contact_solution_t
   use atrito_history_lists, only: add_frame, add_iterations, add_row, move_frame, trim_lists
   use atrito_force_sense, only: tell_forces, watch_forces
   use atrito_history_run, only: run_t, is_recorded, is_resumed, resume, record
   use atrito_increment, only: is_solved, search_solutions, solve_increment
   use atrito_increment_results, only: complete_results
   use atrito_increment_length, only: cut_increment, is_longer_than_least, lengthen, next_time, progress_t
   use atrito_kinds, only: ip, wp
   use atrito_model, only: all_frequencies, is_due, model_t, requests_t
   use atrito_observer, only: note_observed, observer_t
   use atrito_points, only: contact_points_t
   use atrito_pressure_warnings, only: warn_of_pressures
   use atrito_recorder, only: recorder_t
   use atrito_reporter, only: reporter_t, report_place, report_progress, PROGRESS_LINE
   use atrito_restart_state, only: warm_start_t
   use atrito_results, only: ending_t, extreme_t, history_t, results_t, contact_result_t, history_row_t, POINT_OPEN, POINT_STICK, &
                             POINT_SLIP
   use atrito_rigid_bodies, only: hold_the_same
   use atrito_rigid_results, only: leave_mesh_alone
   use atrito_rigid_steps, only: begin_motions_from, released_forces
   use atrito_scene_builder, only: list_held
   use atrito_scene_data, only: check_known_points, drop_assembled, set_time
   use atrito_scene_forecast, only: forecast_memory
   use atrito_slip_memory, only: begin_memory, put_rest, remember_slips
   use atrito_solution_warnings, only: warn, idle_text
   use atrito_solve, only: begin_scene, note_method, solve_options_t, solve_static
   use atrito_status, only: is_ok, reword_status, set_status, status_t, STATUS_NOT_CONVERGED, STATUS_SINGULAR
   use atrito_step_change, only: begin_from, changes_form
   use atrito_step_loads, only: moment_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: solve_history

contains

   !> Solves all steps. status: of a run of one increment that of solve_static; of others OK, or why the history ended early, with
   !> STATUS_NOT_CONVERGED, STATUS_SINGULAR, or a status of begin_scene. What converged before is in the history.
   subroutine solve_history(model, options, reporter, history, status, store, recorder, observer, start)
      type(model_t), intent(in), target :: model     !< as built; looked at while the history is solved
      type(solve_options_t), intent(in) :: options   !< form, solver, memory, viewer and frames
      type(reporter_t), intent(in) :: reporter       !< tells how far the work is
      type(history_t), intent(out) :: history        !< all that was found, even where it ended early
      type(status_t), intent(out) :: status          !< STATUS_OK, or why there is no end
      type(body_cache_t), intent(inout) :: store     !< bodies of an earlier run, or none; on return those of this one
      class(recorder_t), intent(inout), target, optional :: recorder !< left out: nothing is recorded, nothing resumed
      class(observer_t), intent(inout), target, optional :: observer !< left out: nothing is observed
      type(warm_start_t), intent(inout), optional :: start !< of a run of one increment: as solve_static has it
      type(run_t), target :: run
      type(progress_t) :: now
      integer(ip) :: k, first
      logical :: has_one_increment

      allocate (history%rows(0), history%iterations(0))
      if (present(recorder)) run%recorder => recorder
      if (present(observer)) then
         if (observer%is_there) run%observer => observer
      end if
      ! Whether there is one step that is one increment, which is not cut.
      associate (control => model%steps(1)%increments)
         has_one_increment = size(model%steps) == 1 .and. control%initial >= control%period .and. control%least >= control%period
      end associate
      if (has_one_increment .and. .not. is_recorded(run)) then
         call solve_only_increment(model, options, reporter, history, status, store, start)
         if (associated(run%observer) .and. is_ok(status)) call run%observer%observe(history%frames(1), &
                                                                                     history%rows)
         return
      end if
      allocate (history%frames(0))
      history%store => options%frames                ! has the frames of recorder%found
      run%options = options
      run%reporter = reporter
      first = 1
      if (is_resumed(run)) then
         call resume(model, store, run, history, now, status)
         if (.not. is_ok(status)) return
         first = run%recorder%state%step
      end if
      do k = first, size(model%steps, kind=ip)
         if (now%increment == 0) call begin_step(model, k, store, run, status)
         if (.not. is_ok(status)) then
            call end_early(k, progress_t(), run, history, status)
         else
            call go_through_step(model, k, store, run, now, history, status)
         end if
         if (.not. is_ok(status)) exit
         run%began = run%began + model%steps(k)%increments%period
         now = progress_t()
      end do
      call finish(run, history)
      if (store%factorisations > 0) store%factorisations = history%factorisations
      call drop_assembled(run%data)
      call release_bodies(store)
   end subroutine solve_history

   subroutine solve_only_increment(model, options, reporter, history, status, store, start)
      type(model_t), intent(in), target :: model
      type(solve_options_t), intent(in) :: options
      type(reporter_t), intent(in) :: reporter
      type(history_t), intent(inout) :: history
      type(status_t), intent(out) :: status
      type(body_cache_t), intent(inout) :: store
      type(warm_start_t), intent(inout), optional :: start
      integer(ip) :: i

      allocate (history%frames(1))
      call solve_static(model, options, reporter, history%frames(1), status, store, history%others, start)
      if (.not. is_ok(status)) then
         deallocate (history%frames)
         allocate (history%frames(0))
         return
      end if
      call warn_of_pressures(model, history)
      associate (frame => history%frames(1))
         frame%time = model%steps(1)%increments%period
         frame%step_time = frame%time
         do i = 1, size(frame%contact, kind=ip)
            frame%contact(i)%slip_increment = frame%contact(i)%slip
         end do
         history%iterations = frame%iterations
         history%factorisations = frame%factorisations
      end associate
   end subroutine solve_only_increment

   !> Makes the scene of a step. With the same dofs held, and methods of the same form, it is the one that is there.
   subroutine begin_step(model, k, store, run, status)
      type(model_t), intent(in), target :: model
      integer(ip), intent(in) :: k
      type(body_cache_t), intent(inout) :: store
      type(run_t), intent(inout), target :: run
      type(status_t), intent(out) :: status
      logical, allocatable :: held(:, :), before(:, :)
      real(wp), allocatable :: value(:, :), released(:, :)
      type(had_t) :: had

      if (k == 1) then
         call begin_scene(model, run%options, store, .false., run%data, run%scene, status)
         if (.not. is_ok(status)) return
         call begin_memory(model, run%data%points%n, run%memory)
         call note_method(run%data, model%steps(:1))
      else
         call list_held(model, model%steps(k), held, value)
         if (all(held .eqv. run%data%held) .and. .not. changes_form(model, k) &
             .and. hold_the_same(model, run%data%rigid_prescribed, model%steps(k)%rigid_prescribed)) then
            run%data%step => model%steps(k)
            if (run%options%starts == 0) run%data%starts = model%steps(k)%controls%starts
            if (allocated(run%data%released)) deallocate (run%data%released)
            if (allocated(run%data%bases)) deallocate (run%data%bases)
            run%data%asks_for_bases = .true.
            return
         end if
         before = run%data%held
         run%step = model%steps(k)
         call begin_from(before, run%last%u, run%step)
         call begin_motions_from(model, run%data%rigid_prescribed, run%last%rigid, run%step%rigid_prescribed)
         released = released_forces(run%data, run%last, held, model%steps(k)%rigid_prescribed)
         had = run%data%had
         call begin_scene(model, run%options, store, .false., run%data, run%scene, status, run%step)
         if (.not. is_ok(status)) return
         run%data%had = had
         if (changes_form(model, k)) call note_method(run%data, model%steps(k:k))
         call move_alloc(released, run%data%released)
         call put_rest(run%memory, run%data%line)
      end if
      run%data%keeps = .true.
      run%data%asks_for_bases = .true.
   end subroutine begin_step

   !> All increments of a step.
   subroutine go_through_step(model, k, store, run, now, history, status)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: k
      type(body_cache_t), intent(inout) :: store
      type(run_t), intent(inout), target :: run
      type(progress_t), intent(inout) :: now         !< at the beginning of the step, or behind an increment of it
      type(history_t), intent(inout) :: history
      type(status_t), intent(out) :: status
      type(results_t) :: results
      type(contact_solution_t) :: solution
      real(wp) :: to
      logical :: may_be_cut
      character(len=:), allocatable :: text

      associate (control => model%steps(k)%increments)
         if (now%increment == 0) now%length = control%initial
         do while (now%time < control%period)
            to = next_time(now, control%period)
            now%increment = now%increment + 1
            if (now%increment > control%most) then
               call set_status(status, STATUS_NOT_CONVERGED, 'the step takes more than INC='//to_text(control%most)//' increments')
               call end_early(k, now, run, history, status)
               return
            end if
            ! `step 2 of 3`, and behind its first increment `step 2 of 3, increment 5, 45 %` of the whole history.
            text = 'step '//to_text(k)//' of '//to_text(size(model%steps, kind=ip))
            if (now%increment > 1) text = text//', increment '//to_text(now%increment)//', '// &
                                          to_text(int(100*(run%began + now%time)/sum(model%steps%increments%period), ip))//' %'
            call report_place(run%reporter, text, is_phase=now%increment == 1)
            run%data%may_cut = is_longer_than_least(control, min(now%length, to - now%time))
            call try_increment(k, now%increment, to, store, run, results, solution, status)
            history%factorisations = history%factorisations + results%factorisations
            if (is_solved(results, status)) then
               call tell(run%reporter, results, now%cuts)
               call keep_increment(model, results, solution, run, history)
               now%time = to
               call lengthen(control, now)
               call record(now, run, history)
            else
               now%length = min(now%length, to - now%time)
               ! shorter increments are of use where there is no solution, not where memory or the deck fail
               may_be_cut = is_ok(status) .or. any(status%code == [STATUS_NOT_CONVERGED, STATUS_SINGULAR])
               if (.not. (may_be_cut .and. is_longer_than_least(control, now%length))) then
                  if (is_ok(status)) then
                     if (.not. allocated(results%verdict)) results%verdict = 'not converged'
                     call set_status(status, STATUS_NOT_CONVERGED, results%verdict)
                  end if
                  call end_early(k, now, run, history, status)
                  return
               end if
               call report_progress(run%reporter, 'increment '//to_text(now%increment)//' of step '//to_text(k) &
                                    //' has no solution; cut')
               call cut_increment(control, now)
            end if
         end do
      end associate
   end subroutine go_through_step

   !> Solves from the state that is left to a time of the step, and keeps nothing.
   subroutine try_increment(k, increment, to, store, run, results, solution, status)
      integer(ip), intent(in) :: k, increment
      real(wp), intent(in) :: to                     !< time of the step
      type(body_cache_t), intent(inout) :: store
      type(run_t), intent(inout), target :: run
      type(results_t), intent(out) :: results
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(results_t), allocatable :: others(:)      ! which are counted alone

      results%scene = run%scene
      results%step = k
      results%increment = increment
      results%step_time = to
      results%time = run%began + to
      results%ends_step = to >= run%data%step%increments%period
      ! Whether anything is printed of an increment.
      run%data%is_printed = any(is_due(all_frequencies(run%data%step%requests%every), increment, results%ends_step))
      run%data%is_last = results%ends_step .and. k == size(run%data%model%steps)
      if (run%reporter%form == PROGRESS_LINE) run%data%reporter = run%reporter
      nullify (run%data%before)
      if (run%has_last) run%data%before => run%last%u
      call set_time(run%data, moment_t(to, results%time))
      call check_known_points(run%data, status)
      if (is_ok(status)) call solve_increment(run%data, run%options%contact_form, store, results, solution, status)
      if (is_solved(results, status) .and. run%data%is_printed) then
         call search_solutions(run%data, store, solution, results, others)
      end if
   end subroutine try_increment

   !> A converged increment: rest slips, rows, iterations, and the frame where it is printed.
   subroutine keep_increment(model, results, solution, run, history)
      type(model_t), intent(in) :: model
      type(results_t), intent(inout) :: results
      type(contact_solution_t), intent(in) :: solution
      type(run_t), intent(inout) :: run
      type(history_t), intent(inout) :: history
      character(len=:), allocatable :: idle
      integer(ip) :: i

      run%data%last = solution
      call widen(run%data%had, solution%body_motion, solution%body_force)
      run%condition = max(run%condition, solution%inner%condition)
      run%scene%bodies = results%scene%bodies        ! as they were factored
      call remember_slips(run%data%line, solution%tau, results%contact, run%memory)
      call put_rest(run%memory, run%data%line)
      call watch_forces(run%data, results, run%sense)
      do i = 1, size(results%contact, kind=ip)
         call add_row(row_of_pair(run%data%points(i), results, i, run%memory%dissipation(i)), run%n_rows, history%rows)
      end do
      results%iterations%step = results%step
      results%iterations%increment = results%increment
      call add_iterations(results%iterations, run%n_iterations, history%iterations)
      if (associated(run%observer)) call note_observed(run%observer, run%data, results, history%rows(:run%n_rows), &
                                                       history%observed)
      if (run%data%is_printed) then
         results%scene%memory = forecast_memory(model, run%data, results%scene)
         idle = idle_text(run%data, solution)
         if (len(idle) > 0) then
            if (run%n_idle == 0) run%idle = idle//' (step '//to_text(results%step)//', increment '//to_text(results%increment)
            run%n_idle = run%n_idle + 1
         end if
         call add_frame(results, run%n_frames, history)
      end if
      call move_frame(results, run%last)
      run%has_last = .true.
   end subroutine keep_increment

   !> The history ends here: what converged last is printed, whatever was asked for.
   subroutine end_early(k, now, run, history, status)
      integer(ip), intent(in) :: k
      type(progress_t), intent(in) :: now
      type(run_t), intent(inout) :: run
      type(history_t), intent(inout) :: history
      type(status_t), intent(inout) :: status
      character(len=:), allocatable :: reason

      reason = 'no reason is known'
      if (allocated(status%text)) reason = status%text
      history%ending = ending_t(.true., k, max(now%increment, 1_ip), run%began + now%time + now%length, reason)
      associate (ending => history%ending)
         if (allocated(status%text)) call reword_status(status, 'ended in step '//to_text(ending%step)//', increment ' &
                                                        //to_text(ending%increment)//', time '//to_text(ending%time)//': '//reason)
      end associate
      if (.not. run%has_last .or. now%increment == 0) return
      if (run%data%is_printed .and. run%last%ends_step) return
      if (run%n_frames > 0) then
         if (history%frames(run%n_frames)%time >= run%last%time) then
            history%frames(run%n_frames)%ends_step = .true.
            return
         end if
      end if
      if (run%last%step /= k) return                 ! the end of a step is a frame
      call set_time(run%data, moment_t(run%last%step_time, run%last%time))
      call complete_results(run%data, run%last)
      call leave_mesh_alone(run%data, run%last)
      run%last%ends_step = .true.
      call add_frame(run%last, run%n_frames, history)
   end subroutine end_early

   !> Lists to their lengths, and what a careful user should know, once.
   subroutine finish(run, history)
      type(run_t), intent(inout) :: run
      type(history_t), intent(inout) :: history
      character(len=:), allocatable :: idle
      integer(ip) :: i

      call trim_lists(run%n_frames, run%n_rows, run%n_iterations, history)
      if (.not. run%has_last .or. run%n_frames == 0 .or. .not. allocated(run%data%last)) return
      run%data%last%inner%condition = run%condition
      run%last = history%frames(run%n_frames)
      do i = 1, run%n_frames
         call take_larger(history%frames(i)%large_strain, run%last%large_strain)
         call take_larger(history%frames(i)%large_rotation, run%last%large_rotation)
         call take_larger(history%frames(i)%large_slip, run%last%large_slip)
         run%last%contraction = max(run%last%contraction, history%frames(i)%contraction)
         associate (known => history%frames(i)%uniqueness)
            run%last%uniqueness%solutions = max(run%last%uniqueness%solutions, known%solutions)
            run%last%uniqueness%index = min(run%last%uniqueness%index, known%index)
            run%last%uniqueness%up_to_nu = min(run%last%uniqueness%up_to_nu, known%up_to_nu)
         end associate
         run%last%contraction_estimate = max(run%last%contraction_estimate, history%frames(i)%contraction_estimate)
      end do
      idle = ''
      if (run%n_idle > 0) idle = run%idle//')'
      if (run%n_idle > 1) idle = run%idle//' and '//to_text(run%n_idle - 1_ip)//' more of those printed)'
      call warn(run%data, run%data%last, run%last, idle)
      call warn_of_pressures(run%data%model, history)
      call tell_forces(run%last%scene%pairs, run%last%contact, run%sense)
   end subroutine finish

   pure subroutine take_larger(one, largest)
      type(extreme_t), intent(in) :: one
      type(extreme_t), intent(inout) :: largest

      if (one%value > largest%value) largest = one
   end subroutine take_larger

   !> One line an increment.
   subroutine tell(reporter, results, cuts)
      type(reporter_t), intent(in) :: reporter
      type(results_t), intent(in) :: results
      integer(ip), intent(in) :: cuts
      character(len=:), allocatable :: text

      text = 'step '//to_text(results%step)//'  increment '//to_text(results%increment)//'  time '//to_text(results%time, 6) &
             //'  outer '//to_text(results%outer_iterations)
      if (cuts > 0) text = text//'  cut '//to_text(cuts)//trim(merge(' time ', ' times', cuts == 1))
      call report_progress(reporter, text)
   end subroutine tell

   !> The row of one pair.
   pure type(history_row_t) function row_of_pair(points, results, pair, dissipation) result(row)
      type(contact_points_t), intent(in) :: points   !< directions of the points of this pair
      type(results_t), intent(in) :: results         !< of the increment
      integer(ip), intent(in) :: pair                !< place in the list of pairs
      real(wp), intent(in) :: dissipation            !< from the beginning of the history [F L]
      real(wp) :: force(2), of_s
      integer(ip) :: j

      row%step = results%step
      row%increment = results%increment
      row%time = results%time
      row%pair = pair
      row%dissipation = dissipation
      row%elastic_energy = results%strain_energy
      row%unique_up_to_nu = results%uniqueness%up_to_nu
      row%index = results%uniqueness%index
      associate (c => results%contact(pair))
         row%open = count(c%status == POINT_OPEN, kind=ip)
         row%stick = count(c%status == POINT_STICK, kind=ip)
         row%slip = count(c%status == POINT_SLIP, kind=ip)
         if (c%n > 0) row%max_pressure = maxval(c%pressure(:c%n))
         if (c%n > 0) row%mean_slip = dot_product(c%weight(:c%n), c%slip(:c%n))/sum(c%weight(:c%n))
         ! Of the tractions on the slave, -p n + sigma_T T.
         of_s = 0.0_wp
         do j = 1, c%n
            associate (n => c%normal(:, j), p => c%pressure(j), w => c%weight(j))
               force = w*(c%shear(j)*[-n(2), n(1)] - p*n)
               row%normal = row%normal + w*p
               row%shear = row%shear + w*c%shear(j)
               row%moment = row%moment + (c%x(1, j)*force(2) - c%x(2, j)*force(1))
               of_s = of_s + w*p*c%s(j)
               if (p > 0.0_wp) row%length = row%length + points%length(j)
            end associate
         end do
         row%centre = ieee_value(1.0_wp, ieee_quiet_nan)
         if (row%normal > 0.0_wp) row%centre = of_s/row%normal
      end associate
   end function row_of_pair

end module atrito_history
