!> `atrito sweep`: one run a value, each in a folder of its own, one table of all.
!>
!> The first run is made before the others and leaves its factored bodies to them, and to the workers of --threads, which are
!> copies of this process. What a worker finds stands in the files of its runs and in the integers that all share. With ranks
!> (atrito_mpi) the runs are handed out to them instead, each to one rank with all of --threads.
module atrito_sweep
   use, intrinsic :: iso_c_binding, only: c_int
   use atrito_body_cache, only: body_cache_t
   use atrito_command_line, only: command_t, output_folder
   use atrito_console, only: print_status, reporter_of
   use atrito_folder_claim, only: folder_claim_t, release_folder
   use atrito_kinds, only: ip, lp, wp
   use atrito_messages, only: clear_messages
   use atrito_overlay_plots, only: write_overlay_plots
   use atrito_mpi, only: rank_count
   use atrito_page, only: page_t, add_above_rule, number, plural
   use atrito_buffer, only: buffer_t, put, take
   use atrito_plot_files, only: plot_folder
   use atrito_processes, only: begin_worker, end_worker, share_integers
   use atrito_rank_tasks, only: rank_tasks_t, rank_times_t, work_for_first
   use atrito_report, only: report_t
   use atrito_reporter, only: reporter_t, report_phase
   use atrito_run, only: run_deck
   use atrito_run_request, only: make_tasks, is_sound, print_lost
   use atrito_series_reports, only: begin_series, report_of_sweep
   use atrito_series, only: claim_output, find_origin, find_observed, begin_pictures, print_closing, seconds_since
   use atrito_status, only: status_t, set_status, is_ok, STATUS_USAGE, STATUS_NOT_CONVERGED, STATUS_INTERNAL
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_study_errors, only: run_facts_t
   use atrito_sweep_plan, only: sweep_journal_t, begin_journal, note_begin, note_end, find_done, remove_journal, OUTCOMES, &
                                sweep_plan_t, plan_sweep
   use atrito_sweep_tables, only: sweep_run_t, read_summary, build_sweep, build_runs, compose_sweep
   use atrito_table, only: origin_t, table_t
   use atrito_table_text, only: write_table_set
   use atrito_system, only: await_workers
   use atrito_timers, only: reset_timers
   implicit none (type, external)
   private
   public :: run_sweep, serve_sweep

   integer, parameter :: NOT_DONE = -1              !< in the place of the exit code of a run

   !> What is asked, and what became of the runs. The tasks of ranks are the runs.
   type, extends(rank_tasks_t) :: sweep_t
      type(command_t) :: command                       !< of the sweep
      type(sweep_plan_t) :: plan                       !< names, values and folders of the runs
      type(origin_t) :: origin                         !< of its tables
      type(sweep_journal_t) :: journal                 !< notes runs that begin and end
      integer(c_int), pointer :: shared(:) => null()   !< (OUTCOMES*n_runs) all exit codes, all factorisations, all that was written
      type(body_cache_t) :: store                      !< factored bodies that runs hand on
      integer(ip) :: n_left = 0                        !< runs that were done before
      type(rank_times_t) :: times                      !< of the ranks
   contains
      procedure :: make => make_run
      procedure :: begin => begin_run
      procedure :: keep => end_run
   end type sweep_t

contains

   !> Makes all runs; code is the worst of theirs.
   subroutine run_sweep(command, code)
      type(command_t), intent(in) :: command        !< of a sweep: --vary, --resume and options of runs
      integer, intent(out) :: code                  !< one of STATUS_*
      type(sweep_t) :: sweep
      type(status_t) :: status
      type(folder_claim_t) :: claim

      sweep%command = command
      call plan_sweep(command%vary, command%settings, sweep%plan, status)
      if (is_ok(status)) then
         call share_integers(OUTCOMES*sweep%plan%n_runs, sweep%shared)
         if (.not. associated(sweep%shared)) call set_status(status, STATUS_INTERNAL, 'no memory for the outcome of the runs')
      end if
      call claim_output(command, ['sweep', 'runs '], claim, status)
      code = status%code
      if (.not. is_ok(status)) return
      call make_and_collect(sweep, code)
      call release_folder(claim)
   end subroutine run_sweep

   !> The runs and what is made of them. Runs that were done before keep what they have.
   subroutine make_and_collect(sweep, code)
      type(sweep_t), intent(inout) :: sweep
      integer, intent(out) :: code
      type(sweep_run_t), allocatable :: runs(:)
      type(status_t) :: status
      logical :: is_done(sweep%plan%n_runs), is_possible
      integer :: outcomes_of(OUTCOMES, sweep%plan%n_runs)
      integer(lp) :: began
      integer(ip) :: run

      call system_clock(began)
      call find_origin(sweep%command, sweep%origin)
      call begin_journal(sweep%command, sweep%origin%provenance_t, sweep%journal)
      is_done = .false.
      if (sweep%command%resume) call find_done(sweep%journal, sweep%plan, is_done, outcomes_of)
      sweep%n_left = count(is_done, kind=ip)
      do run = 1, sweep%plan%n_runs
         if (.not. is_done(run)) outcomes_of(:, run) = [NOT_DONE, 0, 0]
         sweep%shared(run::sweep%plan%n_runs) = int(outcomes_of(:, run), c_int)
      end do
      call make_runs(sweep, pack([(run, run=1, sweep%plan%n_runs)],.not. is_done), is_possible)
      code = STATUS_USAGE
      if (.not. is_possible) call remove_journal(sweep%journal)
      if (.not. is_possible) return                       ! the deck has no such parameter: told by the first run
      call collect(sweep, runs, status)
      if (is_ok(status)) call finish(sweep, runs, seconds_since(began), status)
      if (.not. is_ok(status)) call print_status(status, sweep%command%names(1)%s, sweep%command%json)
      code = max(maxval(runs%code), status%code)
   end subroutine make_and_collect

   !> The first run is made alone, so that the others have its bodies, and what is wrong with all of them is told once; but where it
   !> is likely to be sound, ranks begin with all of them. One that says that the command line is wrong says so for all.
   subroutine make_runs(sweep, list, is_possible)
      type(sweep_t), intent(inout) :: sweep
      integer(ip), intent(in) :: list(:)            !< of the runs
      logical, intent(out) :: is_possible
      type(command_t) :: first
      integer(ip) :: n_alone

      is_possible = .true.
      if (size(list) == 0) return
      sweep%store%keeps = size(list) > 1
      n_alone = 1
      if (rank_count() > 1) then
         call make_command(sweep, list(1), first)
         if (is_sound(first)) n_alone = 0
      end if
      call make_tasks(sweep, list(:n_alone), sweep%times)
      is_possible = sweep%shared(list(1)) /= STATUS_USAGE
      if (.not. is_possible) return
      if (rank_count() == 1) call make_by_workers(sweep, list(2:))
      if (rank_count() > 1) call make_tasks(sweep, list(1 + n_alone:), sweep%times)
      is_possible = sweep%shared(list(1)) /= STATUS_USAGE
   end subroutine make_runs

   !> Runs in this process, or by workers, which take turns.
   subroutine make_by_workers(sweep, list)
      type(sweep_t), intent(inout) :: sweep
      integer(ip), intent(in) :: list(:)
      integer(ip) :: n_workers, w
      logical :: is_worker, made

      n_workers = max(1_ip, min(sweep%command%threads, size(list, kind=ip)))
      do w = 1, n_workers
         is_worker = .false.
         made = .false.
         if (n_workers > 1) call begin_worker(is_worker, made)
         if (is_worker .or. .not. made) call make_tasks(sweep, list(w::n_workers), sweep%times)
         if (is_worker) call end_worker()
      end do
      if (n_workers > 1) call await_workers()
   end subroutine make_by_workers

   !> On the other ranks: makes what runs rank 0 hands out.
   subroutine serve_sweep(command)
      type(command_t), intent(in) :: command        !< as on rank 0
      type(sweep_t) :: sweep
      type(status_t) :: status

      sweep%command = command
      sweep%store%keeps = .true.
      call plan_sweep(command%vary, command%settings, sweep%plan, status)
      call work_for_first(sweep)
   end subroutine serve_sweep

   subroutine begin_run(self, task)
      class(sweep_t), intent(inout) :: self
      integer(ip), intent(in) :: task
      type(reporter_t) :: reporter

      reporter = reporter_of(self%command)
      call report_phase(reporter, 'run '//to_text(task)//' of '//to_text(self%plan%n_runs)//'  '//self%plan%labels(task)%s)
      call note_begin(self%journal, self%plan, task)
   end subroutine begin_run

   !> Makes a run, on any rank.
   subroutine make_run(self, task, answer)
      class(sweep_t), intent(inout) :: self
      integer(ip), intent(in) :: task
      type(buffer_t), intent(inout) :: answer
      type(command_t) :: one
      type(run_facts_t) :: facts
      integer :: code

      call make_command(self, task, one)
      call clear_messages()
      call reset_timers()
      self%store%factorisations = 0
      call run_deck(one, self%store, code, facts)
      call put(answer, [int(code, ip), self%store%factorisations, count([facts%is_written, facts%is_whole], kind=ip)])
   end subroutine make_run

   !> What became of a run. Where the process of a rank crashed, it has failed.
   subroutine end_run(self, task, answer, end_code)
      class(sweep_t), intent(inout) :: self
      integer(ip), intent(in) :: task
      type(buffer_t), intent(inout) :: answer
      integer, intent(in) :: end_code
      integer(ip), allocatable :: outcome(:)

      outcome = [STATUS_INTERNAL, 0, 0]
      if (end_code == 0) call take(answer, outcome)
      if (end_code /= 0) call print_lost(self%command, self%plan%labels(task)%s, end_code)
      self%shared(task::self%plan%n_runs) = int(outcome, c_int)
      call note_end(self%journal, self%plan, task, int(outcome))
   end subroutine end_run

   !> The command of one run.
   subroutine make_command(sweep, run, one)
      class(sweep_t), intent(in) :: sweep
      integer(ip), intent(in) :: run
      type(command_t), intent(out) :: one
      integer :: i

      one = sweep%command
      one%quiet = .true.
      one%report = .false.
      one%plot = .false.                            ! the pictures of a sweep lay its runs over one another
      if (rank_count() == 1) one%threads = 1         ! the runs are side by side instead
      one%on_one_rank = .true.
      one%folder = output_folder(sweep%command)//'/'//sweep%plan%folders(run)%s
      do i = 1, size(sweep%plan%names)
         call append_string(one%settings, sweep%plan%names(i)%s//'='//sweep%plan%texts(i, run)%s)
      end do
   end subroutine make_command

   !> How the runs ended, and their summaries. status: STATUS_FILE.
   subroutine collect(sweep, runs, status)
      type(sweep_t), intent(in) :: sweep
      type(sweep_run_t), allocatable, intent(out) :: runs(:)
      type(status_t), intent(out) :: status
      integer(ip) :: i

      allocate (runs(sweep%plan%n_runs))
      do i = 1, sweep%plan%n_runs
         runs(i)%label = sweep%plan%labels(i)%s
         runs(i)%folder = sweep%plan%folders(i)%s
         runs(i)%texts = sweep%plan%texts(:, i)
         runs(i)%values = sweep%plan%values(:, i)
         runs(i)%code = int(sweep%shared(i))
         if (sweep%shared(i) == NOT_DONE) runs(i)%code = STATUS_INTERNAL
         runs(i)%factorisations = int(sweep%shared(sweep%plan%n_runs + i), ip)
         runs(i)%is_written = sweep%shared(2*sweep%plan%n_runs + i) > 0
         runs(i)%is_whole = sweep%shared(2*sweep%plan%n_runs + i) > 1
         if (is_ok(status)) call read_summary(output_folder(sweep%command)//'/'//runs(i)%folder, runs(i), status)
      end do
   end subroutine collect

   !> The tables of the sweep and the closing lines. A sweep of which no run wrote anything writes nothing.
   subroutine finish(sweep, runs, seconds, status)
      type(sweep_t), intent(in) :: sweep
      type(sweep_run_t), intent(in) :: runs(:)
      real(wp), intent(in) :: seconds(2)            !< wall clock and processor
      type(status_t), intent(out) :: status
      type(table_t) :: tables(2)
      type(page_t) :: page
      type(report_t) :: report
      type(origin_t) :: origin
      type(string_t), allocatable :: pictures(:), observed(:)

      if (.not. any(runs%is_written)) then
         call remove_journal(sweep%journal)
         return
      end if
      associate (command => sweep%command, plan => sweep%plan)
         origin = sweep%origin
         origin%not_converged = any(runs%code == STATUS_NOT_CONVERGED .or. (runs%is_written .and. .not. runs%is_whole))
         call find_observed(command, observed)
         call build_sweep(plan%names, observed, runs, tables(1))
         call build_runs(plan%names, observed, runs, tables(2))
         call write_table_set(output_folder(command), tables, origin, int(command%digits), status, command%is_csv)
         if (.not. is_ok(status)) return
         call begin_pictures(command)
         allocate (pictures(0))
         if (command%plot) call plot_sweep(command, plan, runs, origin%deck, pictures)
         call compose_sweep(command%names(1)%s, plan%names, observed, runs, output_folder(command), seconds, page, pictures)
         if (command%report) then
            call begin_series('sweep', command%names(1)%s, output_folder(command), ['sweep', 'runs '], pictures, report)
            call report_of_sweep(plan%names, runs, seconds, report)
         end if
         ! What is to be told of ranks, and of what was done before.
         if (sweep%n_left > 0) call add_above_rule(page, 'left alone', &
                                                   plural(sweep%n_left, 'run', 'runs')//', made by an earlier sweep')
         associate (times => sweep%times)
            if (times%n_ranks > 1) call add_above_rule(page, 'ranks', to_text(times%n_ranks)//', idle for '// &
                                                       number(times%longest_idle, 3)//' s at most; longest run '// &
                                                       number(times%longest_task, 3)//' s')
         end associate
         call print_closing(command, page, report)
      end associate
   end subroutine finish

   !> Lays the runs that came to their end over one another.
   subroutine plot_sweep(command, plan, runs, deck, drawn)
      type(command_t), intent(in) :: command
      type(sweep_plan_t), intent(in) :: plan
      type(sweep_run_t), intent(in) :: runs(:)
      character(len=*), intent(in) :: deck          !< its name
      type(string_t), allocatable, intent(out) :: drawn(:)
      type(reporter_t) :: reporter
      type(string_t), allocatable :: labels(:)
      real(wp), allocatable :: values(:)
      character(len=:), allocatable :: name
      integer, allocatable :: order(:)
      integer :: i

      reporter = reporter_of(command)
      call report_phase(reporter, 'plot  '//plot_folder(output_folder(command)))
      order = pack([(i, i=1, size(runs))], runs%is_whole)
      allocate (drawn(0))
      if (size(order) == 0) return
      labels = plan%labels(order)
      do i = 1, size(order)                         ! comma-separated values have no head that tells it
         if (command%is_csv .and. runs(order(i))%code == STATUS_NOT_CONVERGED) labels(i)%s = labels(i)%s//' NOT CONVERGED'
      end do
      name = ''
      allocate (values(0))
      if (size(plan%names) == 1) then
         name = plan%names(1)%s
         values = plan%values(1, order)
      end if
      call write_overlay_plots(output_folder(command), deck, labels, plan%folders(order), name, values, drawn)
   end subroutine plot_sweep

end module atrito_sweep
