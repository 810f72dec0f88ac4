!> The two questions of `atrito limit` about a value of its parameter: whether the loads can be balanced, and what the solution is.
module atrito_stability_questions
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_balance_probe, only: probe_balance
   use atrito_body_cache, only: body_cache_t
   use atrito_command_line, only: command_t, output_folder
   use atrito_console, only: print_messages, print_status
   use atrito_frame_spool, only: begin_frames, end_frames, frame_spool_t
   use atrito_history, only: solve_history
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: find_node
   use atrito_messages, only: clear_messages
   use atrito_model, only: model_t
   use atrito_reporter, only: reporter_t
   use atrito_results, only: history_t, results_t
   use atrito_run, only: load_model, solve_options, agree_on_outcome
   use atrito_stability_search, only: STANDS, UNDECIDED, UNKNOWN, STEP_BALANCE
   use atrito_status, only: status_t, set_status, is_ok, STATUS_OK, STATUS_USAGE, STATUS_NOT_CONVERGED, &
                            STATUS_SINGULAR
   use atrito_strings, only: append_string, to_text
   implicit none (type, external)
   private
   public :: question_t, answer_t, ask, load_value
   public :: TELL_ALL, TELL_ERRORS

   integer, parameter :: ALL_DIGITS = 17            !< a value as text gives the same value again
   integer, parameter :: TELL_ALL = 1, TELL_ERRORS = 2   !< of the messages of the deck

   type :: question_t
      real(wp) :: x = 0.0_wp                        !< value of the parameter
      integer :: step = STEP_BALANCE                !< or STEP_SOLVE
   end type question_t

   type :: answer_t
      integer :: code = STATUS_OK                   !< else there is none: the deck has errors at this value, and the like
      integer :: verdict = UNKNOWN                  !< STANDS, FALLS, UNDECIDED
      real(wp) :: excess = 0.0_wp                   !< of the balance
      real(wp) :: displacement = 0.0_wp             !< that is watched [L]; nan without a solution
      integer(ip) :: iterations = 0, solves = 0     !< outer iterations and linear solves
      integer(ip) :: factorisations = 0             !< of bodies
   end type answer_t

contains

   !> Asks one question of a limit: whether the loads balance at a value of the parameter, or what a solution has there. What there
   !> is to tell of a value that is not to be had stands in answer%code, one of STATUS_*.
   subroutine ask(command, parameter, question, telling, store, answer)
      type(command_t), intent(in) :: command
      character(len=*), intent(in) :: parameter     !< that varies
      type(question_t), intent(in) :: question
      integer, intent(in) :: telling                !< TELL_*; news of a solution are told with TELL_ALL
      type(body_cache_t), intent(inout) :: store    !< factored bodies of earlier solutions
      type(answer_t), intent(out) :: answer
      type(model_t) :: model
      type(status_t) :: status
      integer(ip) :: told

      answer%displacement = ieee_value(1.0_wp, ieee_quiet_nan)
      ! what the deck has to say has been told when it was asked about its balance
      call load_value(command, parameter, question%x, &
                      merge(TELL_ERRORS, telling, question%step /= STEP_BALANCE), model, answer%code, told)
      if (answer%code /= STATUS_OK) return
      if (question%step == STEP_BALANCE) then
         call probe_balance(model, answer%verdict, answer%excess, status)
      else
         call solve(command, model, store, answer, status)
         if (telling == TELL_ALL .and. answer%verdict /= UNKNOWN) call print_messages(command%quiet, told + 1, command%json)
      end if
      answer%code = status%code
      if (.not. is_ok(status)) call print_failure(command, parameter//' = '//to_text(question%x, ALL_DIGITS), status)
   end subroutine ask

   !> A run that ends with 0 or 3 is an answer, any other is a failure: what falls has been proved before. Of a history 4 is one,
   !> too, once something has been solved: it ends at a time that the balance was not asked about (supports that go, smooth
   !> amplitudes), and neither bound is narrowed.
   subroutine solve(command, model, store, answer, status)
      type(command_t), intent(in) :: command
      type(model_t), intent(inout) :: model
      type(body_cache_t), intent(inout) :: store
      type(answer_t), intent(inout) :: answer
      type(status_t), intent(out) :: status          !< STATUS_USAGE where there is no node to watch
      type(history_t) :: history
      type(frame_spool_t) :: frames
      type(reporter_t) :: reporter
      integer :: n

      reporter%quiet = .true.
      call begin_frames(output_folder(command), frames)
      call solve_history(model, solve_options(command), reporter, history, status, store, frames=frames)
      call end_frames(frames)
      n = size(history%frames)
      if (n > 0) call agree_on_outcome(status, history%frames(n), history%ending%is_early)
      if (status%code == STATUS_SINGULAR .and. n > 0) call set_status(status, STATUS_NOT_CONVERGED, status%text)
      if (status%code /= STATUS_OK .and. status%code /= STATUS_NOT_CONVERGED) return
      answer%verdict = merge(STANDS, UNDECIDED, is_ok(status))
      status = status_t()
      if (n == 0) return
      call watch(model, history%frames(n), command%watched, answer%displacement, status)
      call count_work(history, answer)
   end subroutine solve

   !> Of all increments; of a single one its own.
   pure subroutine count_work(history, answer)
      type(history_t), intent(in) :: history
      type(answer_t), intent(inout) :: answer
      integer :: n

      n = size(history%frames)
      answer%factorisations = history%factorisations
      answer%iterations = history%frames(n)%outer_iterations
      answer%solves = history%frames(n)%linear_solves
      if (.not. allocated(history%iterations) .or. size(history%rows) == 0) return
      answer%iterations = count(history%iterations%outer > 0 .and. history%iterations%inner == 1, kind=ip)
      answer%solves = size(history%iterations, kind=ip)
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

   !> Reads the deck with a value. code: STATUS_DECK and the like, told.
   subroutine load_value(command, parameter, x, telling, model, code, read_so_far)
      type(command_t), intent(in) :: command
      character(len=*), intent(in) :: parameter
      real(wp), intent(in) :: x
      integer, intent(in) :: telling                !< TELL_*
      type(model_t), intent(out) :: model
      integer, intent(out) :: code
      integer(ip), intent(out) :: read_so_far       !< messages of the deck
      type(command_t) :: one
      type(reporter_t) :: reporter

      one = command
      reporter%quiet = .true.
      call append_string(one%settings, parameter//'='//to_text(x, ALL_DIGITS))
      call clear_messages()
      call load_model(one, reporter, model, read_so_far, code, only_errors=telling == TELL_ERRORS)
   end subroutine load_value

   subroutine print_failure(command, place, status)
      type(command_t), intent(in) :: command
      character(len=*), intent(in) :: place         !< parameter and value
      type(status_t), intent(in) :: status
      type(status_t) :: longer

      if (status%code == STATUS_USAGE) then         ! of any value
         call print_status(status, command%names(1)%s, command%json)
         return
      end if
      call print_messages(command%quiet, 1_ip, command%json)
      if (.not. allocated(status%text)) return
      call set_status(longer, status%code, 'at '//place//': '//status%text)
      call print_status(longer, command%names(1)%s, command%json)
   end subroutine print_failure

end module atrito_stability_questions
