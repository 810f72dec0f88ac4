!> `atrito sweep`: one run a value, each in a folder of its own, one table of all.
!>
!> The first run is made before the others and leaves its factored bodies to them, and to the workers of --threads, which are
!> copies of this process. What a worker finds stands in the files of its runs and in the integers that all share.
module atrito_sweep
   use, intrinsic :: iso_c_binding, only: c_int
   use atrito_body_cache, only: body_cache_t
   use atrito_command_line, only: command_t, output_folder
   use atrito_console, only: print_status
   use atrito_folder_claim, only: folder_claim_t, release_folder
   use atrito_kinds, only: ip, lp, wp
   use atrito_messages, only: clear_messages
   use atrito_overlay_plots, only: write_overlay_plots
   use atrito_observations, only: observation_names
   use atrito_page, only: page_t
   use atrito_plot_files, only: plot_folder
   use atrito_processes, only: begin_worker, end_worker, share_integers
   use atrito_provenance, only: provenance_t
   use atrito_report, only: report_t
   use atrito_report_maker, only: make_report
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_run, only: run_deck
   use atrito_series_reports, only: begin_series, report_of_sweep
   use atrito_series, only: claim_output, find_provenance, series_origin, begin_pictures, tell_series, seconds_since
   use atrito_status, only: status_t, set_status, is_ok, STATUS_USAGE, STATUS_NOT_CONVERGED, STATUS_INTERNAL
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_study_errors, only: run_facts_t
   use atrito_sweep_plan, only: sweep_plan_t, plan_sweep
   use atrito_sweep_tables, only: sweep_run_t, read_summary, write_sweep, compose_sweep
   use atrito_table, only: origin_t
   use atrito_system, only: await_workers
   use atrito_timers, only: reset_timers
   implicit none (type, external)
   private
   public :: run_sweep

   integer(c_int), parameter :: NOT_DONE = -1_c_int

   !> What is asked, and the exit codes of the runs, then their factorisations, then what they wrote.
   type :: sweep_t
      type(command_t) :: command
      type(sweep_plan_t) :: plan
      type(provenance_t) :: provenance
      integer(c_int), pointer :: shared(:) => null()   !< (3 n_runs)
      type(body_cache_t) :: store
   end type sweep_t

contains

   !> Makes all runs; code is the worst of theirs.
   subroutine run_sweep(command, code)
      type(command_t), intent(in) :: command
      integer, intent(out) :: code                  !< one of STATUS_*
      type(sweep_t) :: sweep
      type(status_t) :: status
      type(folder_claim_t) :: claim

      sweep%command = command
      call plan_sweep(command%vary, command%settings, sweep%plan, status)
      if (is_ok(status)) then
         call share_integers(3*sweep%plan%n_runs, sweep%shared)
         if (.not. associated(sweep%shared)) call set_status(status, STATUS_INTERNAL, 'no memory for the outcome of the runs')
      end if
      call claim_output(command, claim, status)
      code = status%code
      if (.not. is_ok(status)) return
      call make_and_collect(sweep, code)
      call release_folder(claim)
   end subroutine run_sweep

   !> The runs and what is made of them.
   subroutine make_and_collect(sweep, code)
      type(sweep_t), intent(inout) :: sweep
      integer, intent(out) :: code
      type(sweep_run_t), allocatable :: runs(:)
      type(status_t) :: status
      integer(lp) :: began

      call system_clock(began)
      call find_provenance(sweep%command, sweep%provenance)
      sweep%shared = 0
      sweep%shared(:sweep%plan%n_runs) = NOT_DONE
      call make_runs(sweep)
      code = STATUS_USAGE
      if (sweep%shared(1) == STATUS_USAGE) return         ! the deck has no such parameter: told by the first run
      call collect(sweep, runs, status)
      if (is_ok(status)) call finish(sweep, runs, seconds_since(began), status)
      if (.not. is_ok(status)) call print_status(status, sweep%command%names(1)%s, sweep%command%json)
      code = max(maxval(runs%code), status%code)
   end subroutine make_and_collect

   !> The first run here, the others here or by workers, which take turns.
   subroutine make_runs(sweep)
      type(sweep_t), intent(inout) :: sweep
      integer(ip) :: n_workers, w, run
      logical :: is_worker, made

      sweep%store%keeps = sweep%plan%n_runs > 1
      call make_run(sweep, 1_ip)
      if (sweep%shared(1) == STATUS_USAGE) return
      n_workers = max(1_ip, min(sweep%command%threads, sweep%plan%n_runs - 1))
      do w = 1, n_workers
         is_worker = .false.
         made = .false.
         if (n_workers > 1) call begin_worker(is_worker, made)
         do run = 1 + w, sweep%plan%n_runs, n_workers
            if (is_worker .or. .not. made) call make_run(sweep, run)
         end do
         if (is_worker) call end_worker()
      end do
      if (n_workers > 1) call await_workers()
   end subroutine make_runs

   subroutine make_run(sweep, run)
      type(sweep_t), intent(inout) :: sweep
      integer(ip), intent(in) :: run
      type(command_t) :: one
      type(reporter_t) :: reporter
      type(run_facts_t) :: facts
      integer :: i, code

      one = sweep%command
      reporter%quiet = one%quiet .or. one%json
      call report_progress(reporter, 'run '//to_text(run)//' of '//to_text(sweep%plan%n_runs)//'  '//sweep%plan%labels(run)%s)
      one%quiet = .true.
      one%report = .false.
      one%plot = .false.                            ! the pictures of a sweep lay its runs over one another
      one%threads = 1
      one%folder = run_folder(sweep, run)
      do i = 1, size(sweep%plan%names)
         call append_string(one%settings, sweep%plan%names(i)%s//'='//sweep%plan%texts(i, run)%s)
      end do
      call clear_messages()
      call reset_timers()
      sweep%store%factorisations = 0
      call run_deck(one, sweep%store, code, facts)
      sweep%shared(2*sweep%plan%n_runs + run) = count([facts%is_written, facts%is_whole], kind=c_int)
      sweep%shared(sweep%plan%n_runs + run) = int(sweep%store%factorisations, c_int)
      sweep%shared(run) = int(code, c_int)
   end subroutine make_run

   pure function run_folder(sweep, run) result(folder)
      type(sweep_t), intent(in) :: sweep
      integer(ip), intent(in) :: run
      character(len=:), allocatable :: folder

      folder = output_folder(sweep%command)//'/'//sweep%plan%folders(run)%s
   end function run_folder

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
         if (is_ok(status)) call read_summary(run_folder(sweep, i), runs(i), status)
      end do
   end subroutine collect

   !> The tables of the sweep and the closing lines. A sweep of which no run wrote anything writes nothing.
   subroutine finish(sweep, runs, seconds, status)
      type(sweep_t), intent(in) :: sweep
      type(sweep_run_t), intent(in) :: runs(:)
      real(wp), intent(in) :: seconds(2)            !< wall clock and processor
      type(status_t), intent(out) :: status
      type(page_t) :: page
      type(report_t) :: report
      type(origin_t) :: origin
      type(string_t), allocatable :: pictures(:)
      logical :: has_report

      if (.not. any(runs%is_written)) return
      associate (command => sweep%command, plan => sweep%plan)
         origin = series_origin(command, sweep%provenance, any(runs%code == STATUS_NOT_CONVERGED .or. &
                                                               (runs%is_written .and. .not. runs%is_whole)))
         call write_sweep(output_folder(command), origin, plan%names, observation_names(command%observe), runs, &
                          int(command%digits), status, command%is_csv)
         if (.not. is_ok(status)) return
         call begin_pictures(command)
         allocate (pictures(0))
         if (command%plot) call plot_sweep(command, plan, runs, origin%deck, pictures)
         call compose_sweep(command%names(1)%s, plan%names, observation_names(command%observe), runs, &
                            output_folder(command), seconds, page, pictures)
         has_report = .false.
         if (command%report) then
            call begin_series('sweep', command%names(1)%s, output_folder(command), ['sweep', 'runs '], pictures, report)
            call report_of_sweep(plan%names, runs, seconds, report)
            call make_report(command, report, has_report)
         end if
         call tell_series(command, page, has_report)
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

      reporter%quiet = command%quiet .or. command%json
      call report_progress(reporter, 'plot  '//plot_folder(output_folder(command)))
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
