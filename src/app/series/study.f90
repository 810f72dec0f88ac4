!> `atrito study`: one deck at several levels of refinement and with several elements; error against run time.
module atrito_study
   use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
   use atrito_command_line, only: command_t, output_folder
   use atrito_console, only: print_status, reporter_of
   use atrito_folder_claim, only: folder_claim_t, release_folder
   use atrito_kinds, only: ip, wp
   use atrito_mpi, only: rank_count
   use atrito_page, only: page_t
   use atrito_buffer, only: buffer_t, put, put_status, take, take_status
   use atrito_rank_tasks, only: rank_tasks_t, rank_times_t, work_for_first
   use atrito_report, only: report_t
   use atrito_reporter, only: reporter_t, report_phase
   use atrito_run_request, only: make_tasks, print_lost
   use atrito_series_reports, only: begin_series, take_heading, report_of_study
   use atrito_series, only: claim_output, find_origin, begin_pictures, print_closing
   use atrito_status, only: status_t, is_ok, STATUS_OK, STATUS_USAGE, STATUS_NOT_CONVERGED, STATUS_INTERNAL
   use atrito_strings, only: string_t, join, to_text
   use atrito_study_errors, only: last_uniform, study_t
   use atrito_study_runs, only: plan_study, find_probe, make_command, has_failed, put_row, take_row, PROBES, make_run, time_again
   use atrito_study_plot, only: write_study_plot
   use atrito_study_table, only: build_study, compose_study
   use atrito_study_words, only: judge_study
   use atrito_table, only: origin_t, table_t
   use atrito_table_text, only: write_table_set
   implicit none (type, external)
   private
   public :: run_study, serve_study

   integer(ip), parameter :: COARSER = 2             !< levels from the finest one to the one at which regularisations are probed

   !> The tasks of ranks: the rows, then the probes of all kinds.
   type, extends(rank_tasks_t) :: study_runs_t
      type(command_t) :: command                     !< of all runs, by plan_study
      type(study_t) :: study                         !< gets rows and probes
      type(reporter_t) :: reporter                   !< tells the runs
      type(status_t) :: status                       !< of the first run that could not be read back
      logical :: is_first = .true.                   !< no run was made by this process
   contains
      procedure :: make => make_task
      procedure :: begin => begin_task
      procedure :: keep => take_answer
   end type study_runs_t

contains

   !> Makes all runs; code is the worst of theirs.
   subroutine run_study(asked, code)
      type(command_t), intent(in) :: asked          !< as the user gave it
      integer, intent(out) :: code                  !< one of STATUS_*
      type(study_runs_t) :: runs
      type(folder_claim_t) :: claim
      type(origin_t) :: origin

      associate (command => runs%command, status => runs%status)
         call plan_study(asked, command, runs%study, status)
         call claim_output(command, ['study'], claim, status)
         code = status%code
         if (.not. is_ok(status)) return
         runs%reporter = reporter_of(command)
         call find_origin(command, origin)
         call make_rows(runs)
         if (.not. runs%is_stopped) then
            call make_probes(runs)
            call finish(command, origin, runs%study, status)
         end if
         if (.not. is_ok(status)) call print_status(status, command%names(1)%s, command%json)
         code = max(int(maxval(runs%study%rows%code)), status%code)
         call release_folder(claim)
      end associate
   end subroutine run_study

   !> On the other ranks: makes what runs rank 0 hands out.
   subroutine serve_study(asked)
      type(command_t), intent(in) :: asked           !< as on rank 0
      type(study_runs_t) :: runs
      type(status_t) :: status

      call plan_study(asked, runs%command, runs%study, status)
      call work_for_first(runs)
   end subroutine serve_study

   !> The first run shows whether there is any sense in the others; of these the longest begin first where ranks share them.
   subroutine make_rows(runs)
      type(study_runs_t), intent(inout) :: runs
      type(rank_times_t) :: times
      integer(ip), allocatable :: order(:)
      integer(ip) :: level, k

      call make_tasks(runs, [1_ip], times)
      if (runs%is_stopped) return
      order = [(k, k=2, size(runs%study%rows, kind=ip))]
      if (rank_count() > 1) then
         do level = runs%command%levels - 1, 0, -1
            order = [pack(order, runs%study%rows(order)%level /= level), pack(order, runs%study%rows(order)%level == level)]
         end do
      end if
      call make_tasks(runs, order, times)
   end subroutine make_rows

   !> What half of delta and half of eps do to the quantities, at a level of the last element that costs little.
   subroutine make_probes(runs)
      type(study_runs_t), intent(inout) :: runs
      type(rank_times_t) :: times
      integer(ip), allocatable :: list(:)
      integer(ip) :: i

      allocate (runs%study%probes(0))
      associate (row => runs%study%rows(probed_row(runs)))
         if (row%code /= STATUS_OK) return
         list = pack([(i, i=1, size(PROBES, kind=ip))], [row%has_delta, row%has_eps, row%has_stick_slope .and. .not. row%has_eps])
      end associate
      if (size(list) == 0) return
      call report_phase(runs%reporter, 'half of delta, half of eps')
      deallocate (runs%study%probes)
      allocate (runs%study%probes(size(list)))
      do i = 1, size(list, kind=ip)
         associate (probe => runs%study%probes(i))     ! gfortran leaks a text in a structure constructor
            probe%what = trim(PROBES(list(i)))
            probe%is_penalty = list(i) == 1
            probe%row = probed_row(runs)
            allocate (probe%values(size(runs%study%quantities)), source=ieee_value(1.0_wp, ieee_quiet_nan))
         end associate
      end do
      call make_tasks(runs, list + size(runs%study%rows, kind=ip), times)
   end subroutine make_probes

   pure integer function probed_row(runs) result(k)
      class(study_runs_t), intent(in) :: runs

      k = last_uniform(runs%study%rows) - int(min(COARSER, runs%command%levels - 1_ip))
   end function probed_row

   subroutine begin_task(self, task)
      class(study_runs_t), intent(inout) :: self
      integer(ip), intent(in) :: task

      associate (rows => self%study%rows)
         if (task > size(rows)) return
         call report_phase(self%reporter, 'run '//to_text(task)//' of '//to_text(size(rows, kind=ip))//'  ' &
                           //rows(task)%element//', level '//to_text(rows(task)%level))
      end associate
   end subroutine begin_task

   !> A row or a probe, on any rank.
   subroutine make_task(self, task, answer)
      class(study_runs_t), intent(inout) :: self
      integer(ip), intent(in) :: task
      type(buffer_t), intent(inout) :: answer
      real(wp) :: values(size(self%study%quantities))
      type(status_t) :: status
      integer(ip) :: n

      n = size(self%study%rows, kind=ip)
      if (task <= n) then
         associate (row => self%study%rows(task))
            call make_run(self%command, self%study, row, status)
            if (is_ok(status) .and. .not. has_failed(row)) call time_again(self%command, self%study, row, self%is_first, status)
            call put_row(row, answer)
         end associate
         call put_status(answer, status)
         self%is_first = .false.
      else
         call find_probe(self%command, self%study, probed_row(self), int(task - n), values)
         call put(answer, values)
      end if
   end subroutine make_task

   !> What a rank found. Where its process crashed, the run has failed, and a probe says nothing. A fault of the command line or the
   !> deck is the same at every level: no further run is made.
   subroutine take_answer(self, task, answer, end_code)
      class(study_runs_t), intent(inout) :: self
      integer(ip), intent(in) :: task
      type(buffer_t), intent(inout) :: answer
      integer, intent(in) :: end_code
      type(status_t) :: status
      integer :: i

      if (task > size(self%study%rows)) then
         if (end_code /= 0) return
         i = findloc([(self%study%probes(i)%what == PROBES(task - size(self%study%rows)), i=1, size(self%study%probes))], &
                     .true., dim=1)
         call take(answer, self%study%probes(i)%values)
         return
      end if
      associate (row => self%study%rows(task))
         if (end_code == 0) then
            call take_row(answer, row)
            call take_status(answer, status)
            if (is_ok(self%status)) self%status = status
         else
            call print_lost(self%command, row%element//', level '//to_text(row%level), end_code)
            row%code = int(STATUS_INTERNAL, ip)
            allocate (row%values(size(self%study%quantities)), source=ieee_value(1.0_wp, ieee_quiet_nan))
            row%estimate = ieee_value(1.0_wp, ieee_quiet_nan)
            allocate (row%phases(0))
         end if
         self%is_stopped = self%is_stopped .or. .not. is_ok(self%status) .or. row%code == STATUS_USAGE .or. &
                           (task == 1 .and. has_failed(row))
      end associate
   end subroutine take_answer

   subroutine finish(command, origin, study, status)
      type(command_t), intent(in) :: command
      type(origin_t), intent(inout) :: origin
      type(study_t), intent(inout) :: study
      type(status_t), intent(out) :: status
      type(table_t) :: tables(1)
      type(page_t) :: page
      type(report_t) :: report
      type(command_t) :: one
      type(string_t), allocatable :: drawn(:)
      character(len=:), allocatable :: title       !< the deck and what --set changed of it

      study%rounding = max(study%rounding, 10.0_wp**(1 - command%digits))
      call judge_study(study)
      origin%not_converged = any(study%rows%code == STATUS_NOT_CONVERGED)
      call build_study(study, tables(1))
      call write_table_set(output_folder(command), tables, origin, int(command%digits), status, command%is_csv)
      if (.not. is_ok(status)) return
      call begin_pictures(command)
      title = origin%deck
      if (size(command%settings) > 0) title = title//', '//join(command%settings, ', ')
      if (command%plot) call write_study_plot(output_folder(command), title, study, drawn)
      call compose_study(command%names(1)%s, output_folder(command), study, page)
      if (command%report) then
         call begin_series('study', command%names(1)%s, output_folder(command), ['study'], drawn, report)
         call make_command(command, study%rows(1), one)
         call take_heading(one%folder, report)
         call report_of_study(study, report)
      end if
      call print_closing(command, page, report)
   end subroutine finish

end module atrito_study
