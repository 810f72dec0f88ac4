!> `atrito study`: one deck at several levels of refinement and with several elements; error against run time.
module atrito_study
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_command_line, only: command_t, output_folder
   use atrito_console, only: print_status
   use atrito_folder_claim, only: folder_claim_t, release_folder
   use atrito_kinds, only: ip, wp
   use atrito_mpi, only: rank_count
   use atrito_page, only: page_t
   use atrito_parcel, only: parcel_t, put, take
   use atrito_provenance, only: provenance_t
   use atrito_rank_tasks, only: rank_tasks_t, rank_times_t, hand_out, work_for_first
   use atrito_report, only: report_t
   use atrito_report_maker, only: make_report
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_run_request, only: request_runs, print_lost
   use atrito_series_reports, only: begin_series, take_heading, report_of_study
   use atrito_series, only: claim_output, find_provenance, series_origin, begin_pictures, tell_series
   use atrito_plot_files, only: PLOTS_OF_STUDY
   use atrito_status, only: status_t, set_status, is_ok, STATUS_OK, STATUS_USAGE, STATUS_NOT_CONVERGED, STATUS_INTERNAL
   use atrito_strings, only: string_t, join, to_text
   use atrito_study_errors, only: study_t, study_row_t, study_probe_t
   use atrito_study_parcel, only: put_row, take_row
   use atrito_study_plan, only: plan_study
   use atrito_study_plot, only: write_study_plot
   use atrito_study_runs, only: make_timed_run, find_probe, make_command, has_failed, PROBES
   use atrito_study_table, only: write_study, compose_study
   use atrito_study_words, only: judge_study
   use atrito_table, only: origin_t
   implicit none (type, external)
   private
   public :: run_study, serve_study

   integer(ip), parameter :: COARSER = 2             !< levels from the finest one to the one at which regularisations are probed

   !> The tasks of ranks: the rows, then the probes of all kinds.
   type, extends(rank_tasks_t) :: study_runs_t
      type(command_t) :: command
      type(study_t) :: study
      type(reporter_t) :: reporter
      type(status_t) :: status                       !< of the first run that could not be read back
      logical :: is_first = .true.                   !< no run was made by this process
      logical :: is_complete = .false.               !< all rows were made
   contains
      procedure :: make => make_task
      procedure :: begin => begin_task
      procedure :: keep => take_answer
   end type study_runs_t

contains

   !> Makes all runs; code is the worst of theirs.
   subroutine run_study(asked, code)
      type(command_t), intent(in) :: asked
      integer, intent(out) :: code                  !< one of STATUS_*
      type(study_runs_t) :: runs
      type(status_t) :: status
      type(folder_claim_t) :: claim

      call plan_study(asked, runs%command, runs%study, status)
      call claim_output(runs%command, ['study'], PLOTS_OF_STUDY, claim, status)
      code = status%code
      if (.not. is_ok(status)) return
      call make_runs(runs, code)
      call release_folder(claim)
   end subroutine run_study

   !> On the other ranks: makes what runs rank 0 hands out.
   subroutine serve_study(asked)
      type(command_t), intent(in) :: asked
      type(study_runs_t) :: runs
      type(status_t) :: status

      call plan_study(asked, runs%command, runs%study, status)
      call work_for_first(runs)
   end subroutine serve_study

   !> The runs and what is made of them.
   subroutine make_runs(runs, code)
      type(study_runs_t), intent(inout) :: runs
      integer, intent(out) :: code
      type(provenance_t) :: provenance

      associate (command => runs%command, status => runs%status)
         runs%reporter%quiet = command%quiet .or. command%json
         call find_provenance(command, provenance)
         if (rank_count() > 1) then
            call make_on_ranks(runs)
         else
            call make_here(runs)
         end if
         if (is_ok(status) .and. runs%is_complete) then
            call make_probes(runs)
            call finish(command, provenance, runs%study, status)
         end if
         if (.not. is_ok(status)) call print_status(status, command%names(1)%s, command%json)
         code = max(int(maxval(runs%study%rows%code)), status%code)
      end associate
   end subroutine make_runs

   !> One after the other. A fault of the command line or the deck is the same at every level.
   subroutine make_here(runs)
      type(study_runs_t), intent(inout) :: runs
      integer(ip) :: k

      do k = 1, size(runs%study%rows, kind=ip)
         call begin_task(runs, k)
         associate (row => runs%study%rows(k))
            call make_timed_run(runs%command, runs%study, row, runs%is_first, runs%status)
            runs%is_first = .false.
            if (.not. is_ok(runs%status) .or. row%code == STATUS_USAGE .or. (k == 1 .and. has_failed(row))) return
         end associate
      end do
      runs%is_complete = .true.
   end subroutine make_here

   !> The first run shows whether there is any sense in the others; of these the longest begin first.
   subroutine make_on_ranks(runs)
      type(study_runs_t), intent(inout) :: runs
      integer(ip), allocatable :: order(:)
      integer(ip) :: level, k

      call share_out(runs, [1_ip])
      if (.not. is_ok(runs%status) .or. has_failed(runs%study%rows(1))) return
      allocate (order(0))
      do level = runs%command%levels - 1, 0, -1
         order = [order, pack([(k, k=1, size(runs%study%rows, kind=ip))], runs%study%rows%level == level)]
      end do
      call share_out(runs, pack(order, order > 1))
      runs%is_complete = all(runs%study%rows%code /= STATUS_USAGE)
   end subroutine make_on_ranks

   subroutine share_out(runs, list)
      type(study_runs_t), intent(inout) :: runs
      integer(ip), intent(in) :: list(:)
      type(rank_times_t) :: times

      if (size(list) == 0) return
      call request_runs()
      call hand_out(runs, list, times)
   end subroutine share_out

   !> What half of delta and half of eps do to the quantities.
   subroutine make_probes(runs)
      type(study_runs_t), intent(inout) :: runs
      integer(ip), allocatable :: list(:)
      integer(ip) :: i
      integer :: k

      k = probed_row(runs)
      allocate (runs%study%probes(0))
      associate (row => runs%study%rows(k))
         if (row%code /= STATUS_OK) return
         list = pack([(i, i=1, size(PROBES, kind=ip))], &
                     [row%has_delta, row%has_eps, row%has_stick_slope .and. .not. row%has_eps])
      end associate
      if (size(list) == 0) return
      call report_progress(runs%reporter, 'half of delta, half of eps')
      deallocate (runs%study%probes)
      allocate (runs%study%probes(size(list)))
      do i = 1, size(list, kind=ip)
         if (rank_count() == 1) call find_probe(runs%command, runs%study, k, int(list(i)), runs%study%probes(i))
         if (rank_count() > 1) call name_probe(runs, int(list(i)), runs%study%probes(i))
      end do
      if (rank_count() > 1) call share_out(runs, list + size(runs%study%rows, kind=ip))
   end subroutine make_probes

   !> A level of the last element that costs little.
   pure integer function probed_row(runs) result(k)
      class(study_runs_t), intent(in) :: runs

      k = size(runs%study%rows) - int(min(COARSER, runs%command%levels - 1_ip))
   end function probed_row

   !> A probe of which nothing is known.
   subroutine name_probe(runs, kind, probe)
      class(study_runs_t), intent(in) :: runs
      integer, intent(in) :: kind                   !< place in PROBES
      type(study_probe_t), intent(out) :: probe

      probe = study_probe_t(trim(PROBES(kind)), kind == 1, probed_row(runs))
      allocate (probe%values(size(runs%study%quantities)), source=ieee_value(1.0_wp, ieee_quiet_nan))
   end subroutine name_probe

   subroutine begin_task(self, task)
      class(study_runs_t), intent(inout) :: self
      integer(ip), intent(in) :: task

      associate (rows => self%study%rows)
         if (task > size(rows)) return
         call report_progress(self%reporter, 'run '//to_text(task)//' of '//to_text(size(rows, kind=ip))//'  ' &
                              //rows(task)%element//', level '//to_text(rows(task)%level))
      end associate
   end subroutine begin_task

   !> A row or a probe, on any rank.
   subroutine make_task(self, task, answer)
      class(study_runs_t), intent(inout) :: self
      integer(ip), intent(in) :: task
      type(parcel_t), intent(inout) :: answer
      type(study_probe_t) :: probe
      type(status_t) :: status
      integer(ip) :: n

      n = size(self%study%rows, kind=ip)
      if (task <= n) then
         call make_timed_run(self%command, self%study, self%study%rows(task), self%is_first, status)
         call put_row(self%study%rows(task), answer)
         call put(answer, int(status%code, ip))
         if (.not. is_ok(status)) call put(answer, status%text)
         self%is_first = .false.
      else
         call find_probe(self%command, self%study, probed_row(self), int(task - n), probe)
         call put(answer, probe%values)
      end if
   end subroutine make_task

   !> What a rank found. Where its process crashed, the run has failed, and a probe says nothing.
   subroutine take_answer(self, task, answer, end_code)
      class(study_runs_t), intent(inout) :: self
      integer(ip), intent(in) :: task
      type(parcel_t), intent(inout) :: answer
      integer, intent(in) :: end_code
      integer :: i
      character(len=:), allocatable :: text
      integer(ip) :: code

      if (task > size(self%study%rows)) then
         if (end_code /= 0) return
         do i = 1, size(self%study%probes)
            if (self%study%probes(i)%what == PROBES(task - size(self%study%rows))) call take(answer, self%study%probes(i)%values)
         end do
      else if (end_code == 0) then
         call take_row(answer, self%study%rows(task))
         call take(answer, code)
         if (code /= STATUS_OK) then
            call take(answer, text)
            if (is_ok(self%status)) call set_status(self%status, int(code), text)
         end if
      else
         call lose_row(self, self%study%rows(task), end_code)
      end if
   end subroutine take_answer

   subroutine lose_row(runs, row, end_code)
      class(study_runs_t), intent(in) :: runs
      type(study_row_t), intent(inout) :: row
      integer, intent(in) :: end_code
      real(wp) :: nan

      call print_lost(runs%command, row%element//', level '//to_text(row%level), end_code)
      nan = ieee_value(1.0_wp, ieee_quiet_nan)
      row%code = int(STATUS_INTERNAL, ip)
      allocate (row%values(size(runs%study%quantities)), source=nan)
      row%estimate = nan
      allocate (row%phases(0))
   end subroutine lose_row

   subroutine finish(command, provenance, study, status)
      type(command_t), intent(in) :: command
      type(provenance_t), intent(in) :: provenance
      type(study_t), intent(inout) :: study
      type(status_t), intent(out) :: status
      type(origin_t) :: origin
      type(page_t) :: page
      type(report_t) :: report
      type(command_t) :: one
      type(string_t), allocatable :: drawn(:)
      logical :: has_report
      character(len=:), allocatable :: title       !< the deck and what --set changed of it

      study%rounding = max(study%rounding, 10.0_wp**(1 - command%digits))
      call judge_study(study)
      origin = series_origin(command, provenance, any(study%rows%code == STATUS_NOT_CONVERGED))
      call write_study(output_folder(command), origin, study, int(command%digits), status, command%is_csv)
      if (.not. is_ok(status)) return
      call begin_pictures(command)
      title = origin%deck
      if (size(command%settings) > 0) title = title//', '//join(command%settings, ', ')
      if (command%plot) call write_study_plot(output_folder(command), title, study, drawn)
      call compose_study(command%names(1)%s, output_folder(command), study, page)
      has_report = .false.
      if (command%report) then
         call begin_series('study', command%names(1)%s, output_folder(command), ['study'], drawn, report)
         call make_command(command, study%rows(1), one)
         call take_heading(one%folder, report)
         call report_of_study(study, report)
         call make_report(command, report, has_report)
      end if
      call tell_series(command, page, has_report)
   end subroutine finish

end module atrito_study
