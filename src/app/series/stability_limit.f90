!> `atrito limit`: the value of a parameter from which on a scene does not stand.
!>
!> What is asked of which value is atrito_stability_search's: whether the loads can be balanced, which needs no stiffness, or what
!> the solution is. Runs hand their factored bodies on, so that those that the parameter leaves as they are are factored once.
module atrito_stability_limit
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_balance_probe, only: describe_gaps, predict_share, probe_balance
   use atrito_body_cache, only: body_cache_t
   use atrito_clp, only: has_clp, clp_trouble
   use atrito_command_line, only: command_t, output_folder
   use atrito_console, only: print_messages, print_status, reporter_of
   use atrito_folder_claim, only: folder_claim_t, release_folder
   use atrito_frame_spool, only: begin_frames, end_frames, frame_spool_t
   use atrito_history, only: solve_history
   use atrito_pairing, only: add_end_points
   use atrito_kinds, only: ip, lp, wp
   use atrito_load_model, only: load_model, prepare_observations
   use atrito_mesh, only: find_node
   use atrito_messages, only: add_warning, clear_messages, count_messages
   use atrito_model, only: model_t
   use atrito_observations, only: observations_t
   use atrito_page, only: page_t
   use atrito_report, only: report_t
   use atrito_reporter, only: reporter_t, report_phase
   use atrito_results, only: history_t, results_t
   use atrito_series_reports, only: begin_series, report_of_limit
   use atrito_series, only: claim_output, find_origin, find_observed, begin_pictures, print_closing, seconds_since
   use atrito_solve, only: solve_options_t
   use atrito_restart_state, only: warm_start_t
   use atrito_run, only: take_threads, solve_options, agree_on_outcome
   use atrito_study_plot, only: write_stability_plots
   use atrito_sweep_plan, only: read_range
   use atrito_stability_result, only: stability_t, stability_value_t, CODE_NOT_RUN
   use atrito_stability_search, only: search_t, begin_search, next_step, suggest_root, record_balance, record_solution, &
                                      standing_value, falling_value, balanced_value, STEP_BALANCE, STEP_DONE, STANDS, FALLS, &
                                      UNDECIDED, FOUND_LIMIT, FOUND_INTERVAL, BOTH_STAND, BOTH_FALL
   use atrito_stability_tables, only: build_values, build_mechanism, compose_stability, large_where_it_stands
   use atrito_status, only: status_t, set_status, reword_status, is_ok, STATUS_OK, STATUS_USAGE, &
                            STATUS_NOT_CONVERGED, STATUS_SINGULAR
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_table, only: origin_t, table_t
   use atrito_table_text, only: write_table_set
   implicit none (type, external)
   private
   public :: run_limit

   integer, parameter :: ALL_DIGITS = 17            !< a value as text gives the same value again
   integer(ip), parameter :: MOST_TIMES = 2_ip, FEW = 200_ip !< factorisations, over the most that a solution took so far

contains

   !> Searches for the limit and writes what came of it.
   subroutine run_limit(command, code)
      type(command_t), intent(in) :: command        !< of a limit: --vary, --tolerance, --watch
      integer, intent(out) :: code                  !< STATUS_NOT_CONVERGED: only an interval wider than the tolerance; others
      type(stability_t) :: limit
      type(status_t) :: status
      type(folder_claim_t) :: claim

      call take_threads(command)                    ! other ranks have nothing to do
      limit%tolerance = command%limit_tolerance
      call read_range(command%vary(1)%s, command%settings, limit%parameter, limit%ends, status)
      if (is_ok(status) .and. .not. has_clp()) then
         call set_status(status, STATUS_USAGE, 'limit needs Clp, to prove that a scene falls: '//clp_trouble())
      end if
      call claim_output(command, [character(len=9) :: 'limit', 'mechanism'], claim, status)
      code = status%code
      if (.not. is_ok(status)) return
      call find_limit(command, limit, code)
      call release_folder(claim)
   end subroutine run_limit

   subroutine find_limit(command, limit, code)
      type(command_t), intent(in) :: command
      type(stability_t), intent(inout) :: limit
      integer, intent(out) :: code
      type(search_t) :: search
      type(status_t) :: status
      type(model_t) :: model
      type(origin_t) :: origin
      integer(lp) :: began
      integer(ip) :: n_printed
      integer :: answer
      real(wp) :: excess

      call system_clock(began)
      call find_origin(command, origin)
      call find_observed(command, limit%observed)
      limit%watched = 'largest displacement'
      if (command%watched(1) > 0) limit%watched = 'u'//to_text(command%watched(2))//' of node '//to_text(command%watched(1))
      allocate (limit%values(0))
      call begin_search(limit%ends(1), limit%ends(2), limit%tolerance, search)
      call ask_all(command, search, limit, code)
      if (code /= STATUS_OK) return
      call judge_search(search, limit, status)
      if (is_ok(status)) then
         call load_value(command, limit%parameter, limit%balanced, .true., model, code, n_printed)
         if (code == STATUS_OK) call describe_gaps(model, limit%gaps)
         if (code == STATUS_OK) call load_value(command, limit%parameter, limit%falls, .true., model, code, n_printed)
         if (code /= STATUS_OK) return
         call probe_balance(model, answer, excess, status, limit%collapse)
      end if
      if (is_ok(status)) call warn_of_motions()
      if (is_ok(status)) call finish(seconds_since(began), status)
      if (.not. is_ok(status)) call print_status(status, command%names(1)%s, command%json)
      code = status%code
      if (is_ok(status) .and. .not. limit%is_close) code = STATUS_NOT_CONVERGED

   contains

      !> Motions that are not small where it stands, as a run warns of them.
      subroutine warn_of_motions()
         character(len=:), allocatable :: large
         integer(ip) :: n_printed

         large = large_where_it_stands(limit)
         if (len(large) == 0) return
         n_printed = count_messages()
         call add_warning('W-LARGE', 'where it stands, at '//limit%parameter//' = '//to_text(limit%stands, 10)//': '//large// &
                       '; the linear theory, in which forces, normals and places are those without loads, does not know the motion')
         call print_messages(command%quiet, n_printed + 1, command%json)
      end subroutine warn_of_motions

      !> Tables, pictures and closing lines.
      subroutine finish(seconds, status)
         real(wp), intent(in) :: seconds(2)             !< wall clock and processor
         type(status_t), intent(out) :: status
         type(table_t) :: tables(2)
         type(page_t) :: page
         type(report_t) :: report
         type(string_t), allocatable :: pictures(:)

         origin%not_converged = .not. limit%is_close
         call build_values(limit, tables(1))
         call build_mechanism(limit, tables(2))
         call write_table_set(output_folder(command), tables, origin, int(command%digits), status, command%is_csv)
         if (.not. is_ok(status)) return
         call begin_pictures(command)
         allocate (pictures(0))
         if (command%plot) call write_stability_plots(output_folder(command), origin%deck, model, limit, command%view, pictures)
         call compose_stability(command%names(1)%s, output_folder(command), limit, seconds, page, pictures)
         if (command%report) then
            call begin_series('limit', command%names(1)%s, output_folder(command), ['limit    ', 'mechanism'], pictures, report)
            report%heading = model%heading
            call report_of_limit(limit, seconds, report)
         end if
         call print_closing(command, page, report)
      end subroutine finish
   end subroutine find_limit

   !> Asks until the search has what it needs: at a value of the parameter whether the loads can be balanced, or what the solution
   !> is. code: of a deck that has errors at a value, and the like; printed.
   subroutine ask_all(command, search, limit, code)
      type(command_t), intent(in) :: command
      type(search_t), intent(inout) :: search
      type(stability_t), intent(inout) :: limit
      integer, intent(out) :: code
      type(body_cache_t) :: store                   ! factored bodies of earlier solutions
      type(warm_start_t) :: start                   ! the last one
      type(reporter_t) :: reporter
      type(stability_value_t) :: one
      real(wp) :: x
      integer :: step, n, rest
      type(stability_value_t), allocatable :: more(:)
      character(len=:), allocatable :: answer_text

      reporter = reporter_of(command)
      store%keeps = .true.
      do
         call next_step(search, x, step)
         code = STATUS_OK
         if (step == STEP_DONE) exit
         call find_value(limit, x, one)
         if (step == STEP_BALANCE) then
            call ask_balance()
            if (code == STATUS_OK .and. size(search%tried) == 2) call predict_limit(command, limit, search)
         else
            call ask_solution(command, limit, store, start, search, one, code)
         end if
         if (code /= STATUS_OK) exit
         ! Puts the value at its place among the others, or over what was known of it.
         n = count(limit%values%value < one%value)
         rest = count(limit%values%value > one%value)
         allocate (more(n + 1 + rest))
         more(:n) = limit%values(:n)
         more(n + 1) = one
         more(n + 2:) = limit%values(size(limit%values) - rest + 1:)
         call move_alloc(more, limit%values)
         select case (one%code)
         case (STATUS_OK)
            answer_text = 'stands, displacement '//to_text(one%displacement, 5)//' [L]'
         case (STATUS_NOT_CONVERGED)
            answer_text = 'neither a solution nor a proof'
         case (STATUS_SINGULAR)
            answer_text = 'falls'
         case default
            answer_text = 'the loads can be balanced'
            if (one%excess /= one%excess) answer_text = 'too near the limit for a proof'
         end select
         call report_phase(reporter, limit%parameter//' = '//to_text(x, 12)//'  '//answer_text)
      end do

   contains

      !> Whether the loads can be balanced at a value. The first such question tells what the deck has to say.
      subroutine ask_balance()
         type(model_t) :: model
         type(status_t) :: status
         integer(ip) :: n_printed
         integer :: verdict

         call load_value(command, limit%parameter, one%value, size(search%tried) > 0, model, code, n_printed)
         if (code /= STATUS_OK) return
         call probe_balance(model, verdict, one%excess, status)
         code = status%code
         if (.not. is_ok(status)) then
            call print_failure(command, limit%parameter, one%value, status)
            return
         end if
         call record_balance(search, one%value, verdict, one%excess)
         if (verdict == FALLS) one%code = STATUS_SINGULAR
         if (verdict == UNDECIDED) one%excess = ieee_value(1.0_wp, ieee_quiet_nan)
      end subroutine ask_balance
   end subroutine ask_all

   !> Where the balance ends by one linear programme, once both ends are known, where one stands and the other falls.
   subroutine predict_limit(command, limit, search)
      type(command_t), intent(in) :: command
      type(stability_t), intent(in) :: limit
      type(search_t), intent(inout) :: search
      type(model_t) :: models(2)                    ! that stands, that falls
      real(wp) :: ends(2), share
      integer(ip) :: n_printed
      integer :: i, code
      logical :: found

      associate (tried => search%tried)
         if (count(tried%balance == STANDS) /= 1 .or. count(tried%balance == FALLS) /= 1) return
         ends = tried%x
         if (tried(1)%balance == FALLS) ends = ends(2:1:-1)
      end associate
      do i = 1, 2
         call load_value(command, limit%parameter, ends(i), .true., models(i), code, n_printed)
         if (code /= STATUS_OK) return
      end do
      call predict_share(models(1), models(2), share, found)
      if (found) call suggest_root(search, ends(1) + share*(ends(2) - ends(1)))
   end subroutine predict_limit

   !> What the solution at a value is. A run that ends with 0 or 3 is an answer, any other is a failure: what falls has been proved
   !> before. Of a history 4 is one, too, once something has been solved: it ends at a time that the balance was not asked about
   !> (supports that go, smooth amplitudes), and neither bound is narrowed. The first solution tells what it has to add to the
   !> deck's messages.
   subroutine ask_solution(command, limit, store, start, search, one, code)
      type(command_t), intent(in) :: command
      type(stability_t), intent(in) :: limit
      type(body_cache_t), intent(inout) :: store
      type(warm_start_t), intent(inout) :: start
      type(search_t), intent(inout) :: search
      type(stability_value_t), intent(inout) :: one
      integer, intent(out) :: code
      type(model_t) :: model
      type(observations_t) :: observations
      type(status_t) :: status
      type(history_t) :: history
      type(frame_spool_t), target :: frames
      type(reporter_t) :: reporter
      type(solve_options_t) :: options
      integer(ip) :: n_printed
      integer :: n

      one%displacement = ieee_value(1.0_wp, ieee_quiet_nan)
      call load_value(command, limit%parameter, one%value, .true., model, code, n_printed)
      if (code == STATUS_OK) call prepare_observations(command, model, observations, code)
      if (code /= STATUS_OK) return
      reporter%quiet = .true.
      call begin_frames(output_folder(command), frames)
      options = solve_options(command)
      options%frames => frames
      options%is_brief = .true.
      n = max(FEW, maxval([0_ip, limit%values%factorisations], mask=[.true., limit%values%code == STATUS_OK]))
      options%most_factorisations = MOST_TIMES*n
      call solve_history(model, options, reporter, history, status, store, observer=observations, start=start)
      call end_frames(frames)
      n = size(history%frames)
      if (n > 0) call agree_on_outcome(status, history%frames(n), history%ending%is_early)
      if (status%code == STATUS_SINGULAR .and. n > 0) status%code = STATUS_NOT_CONVERGED
      if (status%code == STATUS_OK .or. status%code == STATUS_NOT_CONVERGED) then
         if (all(limit%values%code == CODE_NOT_RUN .or. limit%values%code == STATUS_SINGULAR)) then
            call print_messages(command%quiet, n_printed + 1, command%json)
         end if
         one%code = status%code
         status = status_t()
         if (n > 0) call watch(model, history%frames(n), command%watched, one%displacement, status)
         if (n > 0) call count_work(history, one)
         one%large = [maxval(history%frames%large_strain%value), maxval(history%frames%large_rotation%value), &
                      maxval(history%frames%large_slip%value)]
         one%large = max(one%large, 0.0_wp)
         if (n > 0) then
            if (allocated(history%frames(n)%observed)) one%observed = history%frames(n)%observed%value
         end if
      end if
      code = status%code
      if (.not. is_ok(status)) call print_failure(command, limit%parameter, one%value, status)
      if (is_ok(status)) call record_solution(search, one%value, merge(STANDS, UNDECIDED, one%code == STATUS_OK))
   end subroutine ask_solution

   !> Of all increments; of a single one its own.
   pure subroutine count_work(history, one)
      type(history_t), intent(in) :: history
      type(stability_value_t), intent(inout) :: one
      integer :: n

      n = size(history%frames)
      one%factorisations = history%factorisations
      one%iterations = history%frames(n)%outer_iterations
      one%solves = history%frames(n)%linear_solves
      if (.not. allocated(history%iterations) .or. size(history%rows) == 0) return
      one%iterations = count(history%iterations%outer > 0 .and. history%iterations%inner == 1, kind=ip)
      one%solves = size(history%iterations, kind=ip)
   end subroutine count_work

   !> The displacement of the curve. status: STATUS_USAGE where there is no such node.
   subroutine watch(model, results, watched, displacement, status)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      integer(ip), intent(in) :: watched(2)          !< node and dof; 0: the largest displacement
      real(wp), intent(out) :: displacement          !< [L]
      type(status_t), intent(inout) :: status
      integer(ip) :: node

      displacement = maxval(norm2(results%u, dim=1))
      if (watched(1) == 0) return
      node = find_node(model%mesh, watched(1))
      if (node > 0) then
         displacement = results%u(watched(2), node)
      else
         call set_status(status, STATUS_USAGE, '--watch '//to_text(watched(1))//','//to_text(watched(2)) &
                         //': the deck has no node '//to_text(watched(1)))
      end if
   end subroutine watch

   !> Reads the deck with a value. code: STATUS_DECK and the like; printed.
   subroutine load_value(command, parameter, x, only_errors, model, code, n_printed)
      type(command_t), intent(in) :: command
      character(len=*), intent(in) :: parameter
      real(wp), intent(in) :: x
      logical, intent(in) :: only_errors            !< what else there is to say of the deck has been printed
      type(model_t), intent(out) :: model
      integer, intent(out) :: code
      integer(ip), intent(out) :: n_printed         !< messages of the deck
      type(command_t) :: one
      type(reporter_t) :: reporter

      one = command
      reporter%quiet = .true.
      call append_string(one%settings, parameter//'='//to_text(x, ALL_DIGITS))
      call clear_messages()
      call load_model(one, reporter, model, n_printed, code, only_errors)
      if (code == STATUS_OK) call add_end_points(model)
   end subroutine load_value

   subroutine print_failure(command, parameter, x, status)
      type(command_t), intent(in) :: command
      character(len=*), intent(in) :: parameter
      real(wp), intent(in) :: x
      type(status_t), intent(inout) :: status

      if (status%code /= STATUS_USAGE) then         ! which is of any value
         call print_messages(command%quiet, 1_ip, command%json)
         if (.not. allocated(status%text)) return
         call reword_status(status, 'at '//parameter//' = '//to_text(x, ALL_DIGITS)//': '//status%text)
      end if
      call print_status(status, command%names(1)%s, command%json)
   end subroutine print_failure

   !> What is known of a value so far.
   pure subroutine find_value(limit, x, one)
      type(stability_t), intent(in) :: limit
      real(wp), intent(in) :: x
      type(stability_value_t), intent(out) :: one
      integer :: i

      one%value = x
      one%displacement = ieee_value(1.0_wp, ieee_quiet_nan)
      do i = 1, size(limit%values)
         if (abs(limit%values(i)%value - x) <= 0.0_wp) one = limit%values(i)
      end do
   end subroutine find_value

   !> The bounds. status: STATUS_USAGE where both ends stand or fall, STATUS_NOT_CONVERGED where none is known to stand.
   subroutine judge_search(search, limit, status)
      type(search_t), intent(in) :: search
      type(stability_t), intent(inout) :: limit
      type(status_t), intent(out) :: status
      character(len=:), allocatable :: range

      limit%is_close = search%found == FOUND_LIMIT
      limit%stands = standing_value(search)
      limit%falls = falling_value(search)
      limit%balanced = balanced_value(search)
      range = '--vary '//limit%parameter//'='//to_text(limit%ends(1))//':'//to_text(limit%ends(2))//': '
      select case (search%found)
      case (FOUND_LIMIT, FOUND_INTERVAL)
         return
      case (BOTH_STAND)
         call set_status(status, STATUS_USAGE, range//'the scene stands at both, there is no limit to be found between them')
      case (BOTH_FALL)
         call set_status(status, STATUS_USAGE, range//'the scene falls at both, one of them should stand; a run with' &
                         //' one of them tells how it falls')
      case default
         call set_status(status, STATUS_NOT_CONVERGED, range//end_text(limit, 1)//', '//end_text(limit, 2) &
                         //'; one of them should have a solution, the other should fall')
      end select
   end subroutine judge_search

   pure function end_text(limit, i) result(text)
      type(stability_t), intent(in) :: limit
      integer, intent(in) :: i
      character(len=:), allocatable :: text
      type(stability_value_t) :: one

      call find_value(limit, limit%ends(i), one)
      text = 'at '//to_text(limit%ends(i))//' '
      select case (one%code)
      case (STATUS_OK)
         text = text//'it stands'
      case (STATUS_SINGULAR)
         text = text//'it falls'
      case default
         text = text//'neither a solution nor a proof that there is none was found'
      end select
   end function end_text

end module atrito_stability_limit
