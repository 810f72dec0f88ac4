!> `atrito sweep`: one run a value, each in a folder of its own, one table of all.
!>
!> The first run is made before the others and leaves its factored bodies to them, and to the workers of --threads, which are
!> copies of this process. What a worker finds stands in the files of its runs and in the integers that all share.
module atrito_sweep
   use, intrinsic :: iso_c_binding, only: c_int
   use, intrinsic :: iso_fortran_env, only: output_unit
   use atrito_body_store, only: body_store_t
   use atrito_command_line, only: command_t, output_folder
   use atrito_console, only: print_messages, print_status
   use atrito_files, only: check_folder
   use atrito_folder_claim, only: folder_claim_t, claim_folder, release_folder
   use atrito_kinds, only: ip, lp, wp
   use atrito_messages, only: clear_messages
   use atrito_overlay_plots, only: write_overlay_plots
   use atrito_page, only: page_t, print_page
   use atrito_plot_files, only: plot_folder, remove_plots
   use atrito_processes, only: begin_worker, end_worker, share_integers
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_run, only: run_deck
   use atrito_status, only: status_t, set_status, is_ok, STATUS_OK, STATUS_USAGE, STATUS_NOT_CONVERGED, STATUS_FILE, STATUS_INTERNAL
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_sweep_plan, only: sweep_plan_t, plan_sweep
   use atrito_sweep_tables, only: sweep_run_t, read_summary, write_sweep, compose_sweep
   use atrito_table, only: origin_t
   use atrito_system, only: await_workers, processor_seconds
   use atrito_timers, only: reset_timers
   implicit none (type, external)
   private
   public :: run_sweep

   integer(c_int), parameter :: NOT_DONE = -1_c_int

contains

   !> Makes all runs; code is the worst of theirs.
   subroutine run_sweep(command, code)
      type(command_t), intent(in) :: command
      integer, intent(out) :: code                  !< one of STATUS_*
      type(sweep_plan_t) :: plan
      type(status_t) :: status
      type(folder_claim_t) :: claim
      integer(c_int), pointer :: shared(:)

      call plan_sweep(command%vary, command%settings, plan, status)
      if (is_ok(status)) then
         call share_integers(2*plan%n_runs, shared)
         if (.not. associated(shared)) call set_status(status, STATUS_INTERNAL, 'no memory for the outcome of the runs')
      end if
      if (is_ok(status)) call check_folder(output_folder(command), status)
      if (is_ok(status)) call claim_folder(output_folder(command), claim, status)
      code = status%code
      if (is_ok(status)) then
         call make_and_collect(command, plan, shared, code)
         call release_folder(claim)
      else
         call print_status(status, command%names(1)%s)
      end if
   end subroutine run_sweep

   !> The folder is claimed all the time: two sweeps at once would leave runs of both.
   subroutine make_and_collect(command, plan, shared, code)
      type(command_t), intent(in) :: command
      type(sweep_plan_t), intent(in) :: plan
      integer(c_int), pointer, intent(in) :: shared(:) !< (2 n_runs) exit codes, then factorisations
      integer, intent(out) :: code
      type(sweep_run_t), allocatable :: runs(:)
      type(status_t) :: status
      integer(lp) :: began, ended, rate

      call system_clock(began, rate)
      shared(:plan%n_runs) = NOT_DONE
      call make_runs(command, plan, shared)
      code = STATUS_USAGE
      if (shared(1) == STATUS_USAGE) return         ! the deck has no such parameter: told by the first run
      call collect(command, plan, shared, runs, status)
      call system_clock(ended)
      if (is_ok(status)) call finish(command, plan, runs, real(ended - began, wp)/real(rate, wp), status)
      if (.not. is_ok(status)) call print_status(status, command%names(1)%s)
      code = max(maxval(runs%code), status%code)
   end subroutine make_and_collect

   !> The first run here, the others here or by workers.
   subroutine make_runs(command, plan, shared)
      type(command_t), intent(in) :: command
      type(sweep_plan_t), intent(in) :: plan
      integer(c_int), pointer, intent(in) :: shared(:) !< (2 n_runs) exit codes, then factorisations
      type(body_store_t) :: store
      integer(ip) :: n_workers, w
      logical :: is_worker, made

      store%keeps = plan%n_runs > 1
      call make_run(command, plan, 1_ip, store, shared)
      if (shared(1) == STATUS_USAGE) return
      n_workers = min(command%threads, plan%n_runs - 1)
      if (n_workers <= 1) then
         call make_share(command, plan, 1_ip, 1_ip, store, shared)
         return
      end if
      do w = 1, n_workers
         call begin_worker(is_worker, made)
         if (is_worker .or. .not. made) call make_share(command, plan, w, n_workers, store, shared)
         if (is_worker) call end_worker()
      end do
      call await_workers()
   end subroutine make_runs

   !> Every n_workers-th run behind the first.
   subroutine make_share(command, plan, w, n_workers, store, shared)
      type(command_t), intent(in) :: command
      type(sweep_plan_t), intent(in) :: plan
      integer(ip), intent(in) :: w, n_workers
      type(body_store_t), intent(inout) :: store
      integer(c_int), pointer, intent(in) :: shared(:)
      integer(ip) :: run

      do run = 1 + w, plan%n_runs, n_workers
         call make_run(command, plan, run, store, shared)
      end do
   end subroutine make_share

   subroutine make_run(command, plan, run, store, shared)
      type(command_t), intent(in) :: command
      type(sweep_plan_t), intent(in) :: plan
      integer(ip), intent(in) :: run
      type(body_store_t), intent(inout) :: store
      integer(c_int), pointer, intent(in) :: shared(:)
      type(command_t) :: one
      type(reporter_t) :: reporter
      integer :: i, code

      reporter%quiet = command%quiet
      call report_progress(reporter, 'run '//to_text(run)//' of '//to_text(plan%n_runs)//'  '//plan%labels(run)%s)
      one = command
      one%quiet = .true.
      one%plot = .false.                            ! the pictures of a sweep lay its runs over one another
      one%threads = 1
      one%folder = run_folder(command, plan, run)
      do i = 1, size(plan%names)
         call append_string(one%settings, plan%names(i)%s//'='//plan%texts(i, run)%s)
      end do
      call clear_messages()
      call reset_timers()
      store%factorisations = 0
      call run_deck(one, store, code)
      shared(plan%n_runs + run) = int(store%factorisations, c_int)
      shared(run) = int(code, c_int)
   end subroutine make_run

   pure function run_folder(command, plan, run) result(folder)
      type(command_t), intent(in) :: command
      type(sweep_plan_t), intent(in) :: plan
      integer(ip), intent(in) :: run
      character(len=:), allocatable :: folder

      folder = output_folder(command)//'/'//plan%folders(run)%s
   end function run_folder

   !> How the runs ended, and their summaries. status: STATUS_FILE.
   subroutine collect(command, plan, shared, runs, status)
      type(command_t), intent(in) :: command
      type(sweep_plan_t), intent(in) :: plan
      integer(c_int), pointer, intent(in) :: shared(:)
      type(sweep_run_t), allocatable, intent(out) :: runs(:)
      type(status_t), intent(out) :: status
      integer(ip) :: i

      allocate (runs(plan%n_runs))
      do i = 1, plan%n_runs
         runs(i)%label = plan%labels(i)%s
         runs(i)%folder = plan%folders(i)%s
         runs(i)%texts = plan%texts(:, i)
         runs(i)%values = plan%values(:, i)
         runs(i)%code = int(shared(i))
         if (shared(i) == NOT_DONE) runs(i)%code = STATUS_INTERNAL
         runs(i)%factorisations = int(shared(plan%n_runs + i), ip)
         if (is_ok(status)) call read_summary(run_folder(command, plan, i), runs(i), status)
      end do
   end subroutine collect

   !> The tables of the sweep and the closing lines. A sweep of which no run wrote anything writes nothing.
   subroutine finish(command, plan, runs, seconds, status)
      type(command_t), intent(in) :: command
      type(sweep_plan_t), intent(in) :: plan
      type(sweep_run_t), intent(in) :: runs(:)
      real(wp), intent(in) :: seconds
      type(status_t), intent(out) :: status
      type(origin_t) :: origin
      type(page_t) :: page
      type(string_t), allocatable :: pictures(:)

      if (all(runs%code /= STATUS_OK .and. runs%code /= STATUS_NOT_CONVERGED)) return
      associate (deck => command%names(1)%s)
         origin%deck = deck(index(deck, '/', back=.true.) + 1:)
         origin%not_converged = any(runs%code == STATUS_NOT_CONVERGED)
         allocate (origin%heading(0))
         call write_sweep(output_folder(command), origin, plan%names, runs, int(command%digits), status)
         if (.not. is_ok(status)) return
         call plot_sweep(command, plan, runs, origin%deck, pictures)
         if (command%quiet) return
         call compose_sweep(deck, plan%names, runs, output_folder(command), [seconds, processor_seconds()], page, pictures)
         call print_page(page, output_unit)
      end associate
   end subroutine finish

   !> Lays the runs that wrote tables over one another. Without --plot the pictures of an earlier sweep go, for the tables are new.
   subroutine plot_sweep(command, plan, runs, title, drawn)
      type(command_t), intent(in) :: command
      type(sweep_plan_t), intent(in) :: plan
      type(sweep_run_t), intent(in) :: runs(:)
      character(len=*), intent(in) :: title         !< where the deck has no heading
      type(string_t), allocatable, intent(out) :: drawn(:)
      type(reporter_t) :: reporter
      type(string_t), allocatable :: labels(:), folders(:)
      integer, allocatable :: order(:)
      integer :: i

      call remove_plots(output_folder(command))
      if (.not. command%plot) return
      reporter%quiet = command%quiet
      call report_progress(reporter, 'plot  '//plot_folder(output_folder(command)))
      order = pack([(i, i=1, size(runs))], runs%code == STATUS_OK .or. runs%code == STATUS_NOT_CONVERGED)
      labels = plan%labels(order)
      folders = plan%folders(order)
      call clear_messages()
      if (size(plan%names) == 1) then
         call write_overlay_plots(output_folder(command), title, labels, folders, plan%names(1)%s, plan%values(1, order), drawn)
      else
         call write_overlay_plots(output_folder(command), title, labels, folders, '', [real(wp) ::], drawn)
      end if
      call print_messages(command%quiet, 1_ip)
   end subroutine plot_sweep

end module atrito_sweep
