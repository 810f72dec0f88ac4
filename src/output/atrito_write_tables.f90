!> The tables of a run, docs/user/tables.md: which there are and when each is written.
module atrito_write_tables
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_status, only: status_t, is_ok
   use atrito_files, only: file_set_t
   use atrito_system, only: peak_memory
   use atrito_timers, only: phase_time_t, get_phases
   use atrito_model, only: model_t
   use atrito_results, only: results_t, history_t, last_frame
   use atrito_frame_tables, only: due_frames, build_frame_table
   use atrito_history_tables, only: build_summary, build_history, build_iterations
   use atrito_increments, only: has_history, ending_text
   use atrito_summary, only: scales_t, measure_history, pair_scales
   use atrito_table, only: table_t, origin_t, begin_table, add_reals, add_words, one_word, TAB_ENDING, CSV_ENDING
   use atrito_table_text, only: write_table
   implicit none (type, external)
   private
   public :: write_tables, write_timing, list_table_files, origin_of, TABLE_NAMES

   !> Every table that atrito can write.
   character(len=12), parameter :: TABLE_NAMES(18) = [character(len=12) :: 'contact', 'summary', 'extremes', 'resultants', &
                                                              'history', 'nodes', 'reactions', 'stress', 'nodal_stress', 'bodies', &
                                                                    'rigid', 'joints', 'sections', 'ties', 'equations', 'springs', &
                                                                                                             'iterations', 'timing']

   !> The comment lines at the top: of one result, or of a history.
   interface origin_of
      module procedure origin_of_results, origin_of_history
   end interface origin_of

contains

   !> File names of every table that atrito can write: what a new run replaces or removes.
   pure function list_table_files() result(names)
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(2*size(TABLE_NAMES)))
      do i = 1, size(TABLE_NAMES)
         names(2*i - 1)%s = trim(TABLE_NAMES(i))//TAB_ENDING
         names(2*i)%s = trim(TABLE_NAMES(i))//CSV_ENDING
      end do
   end function list_table_files

   pure function origin_of_results(model, results) result(origin)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(origin_t) :: origin

      origin%deck = model%deck_path(index(model%deck_path, '/', back=.true.) + 1:)
      origin%heading = model%heading
      origin%provenance_t = model%provenance
      origin%not_converged = .not. (results%converged .and. results%law_holds)
   end function origin_of_results

   !> A history that ended early is marked, though what it holds converged.
   pure function origin_of_history(model, history) result(origin)
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      type(origin_t) :: origin

      origin = origin_of_results(model, history%frames(last_frame(history)))
      if (.not. history%ending%is_early) return
      origin%not_converged = .true.
      origin%ending = ending_text(history)
   end function origin_of_history

   !> Writes all tables of a run but timing.tab, which comes last: contact whenever there is a pair, history when there is one,
   !> summary and iterations always, the rest when the deck asks.
   !>
   !> status: STATUS_FILE when one could not be written; the rest is not tried then.
   subroutine write_tables(model, history, digits, set, status, is_csv)
      type(model_t), intent(in), target :: model
      type(history_t), intent(in), target :: history
      integer, intent(in) :: digits                 !< significant digits, 6..17
      type(file_set_t), intent(inout) :: set
      type(status_t), intent(out) :: status
      logical, intent(in), optional :: is_csv       !< left out: .false.
      type(scales_t) :: scales
      type(scales_t), allocatable :: own(:)
      type(table_t), allocatable :: tables(:)
      type(origin_t) :: origin
      integer :: i

      origin = origin_of(model, history)
      scales = measure_history(model, history)
      own = pair_scales(scales, history)
      do i = 1, size(TABLE_NAMES)
         call build_tables(model, history, scales, own, trim(TABLE_NAMES(i)), digits, tables)
         if (size(tables) == 0) cycle
         call write_table(set, tables, origin, digits, status, is_csv)
         if (.not. is_ok(status)) return
      end do
   end subroutine write_tables

   !> What a file holds: one table of all increments, or a table a frame that is due. None: it is not written, or not here.
   subroutine build_tables(model, history, scales, own, name, digits, tables)
      type(model_t), intent(in), target :: model
      type(history_t), intent(in), target :: history
      type(scales_t), intent(in) :: scales, own(:)  !< of the history, of each pair
      character(len=*), intent(in) :: name
      integer, intent(in) :: digits
      type(table_t), allocatable, intent(out) :: tables(:)
      integer(ip), allocatable :: due(:)
      integer :: i

      select case (name)
      case ('timing')
         allocate (tables(0))
      case ('history')
         allocate (tables(merge(1, 0, has_rows(model, history))))
         if (size(tables) > 0) call build_history(history, scales%length, tables(1))
      case ('summary')
         allocate (tables(1))
         call build_summary(history, scales, own, digits, tables(1))
      case ('iterations')
         allocate (tables(1))
         call build_iterations(history, tables(1))
      case default
         due = due_frames(model, history, name)
         allocate (tables(size(due)))
         do i = 1, size(due)
            call build_frame_table(model, history%frames(due(i)), scales, own, name, tables(i))
         end do
      end select
   end subroutine build_tables

   !> Whether there is a history to be told of.
   pure logical function has_rows(model, history)
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history

      has_rows = .false.
      if (.not. allocated(history%rows)) return
      has_rows = size(history%rows) > 0
      if (has_rows) then
         has_rows = has_history(model, history)
      else
         has_rows = history%observed%n > 1
      end if
   end function has_rows

   !> Writes the table timing: the phases that have ended, their sum, and the peak memory as a comment.
   subroutine write_timing(model, history, digits, set, status, is_csv)
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      integer, intent(in) :: digits
      type(file_set_t), intent(inout) :: set
      type(status_t), intent(out) :: status
      logical, intent(in), optional :: is_csv       !< left out: .false.
      type(phase_time_t), allocatable :: phases(:)
      type(string_t), allocatable :: names(:)
      type(table_t) :: table
      integer :: i

      phases = get_phases()
      allocate (names(0))
      do i = 1, size(phases)
         call append_string(names, one_word(trim(phases(i)%name)))
      end do
      call append_string(names, 'total')
      call begin_table(table, 'timing', 'a row a phase, seconds', size(names, kind=ip))
      call append_string(table%remarks, 'peak memory [bytes]: '//to_text(peak_memory()))
      call add_words(table, 'phase', '-', names, on_the_left=.true.)
      call add_reals(table, 'wall', 's', [phases%wall, sum(phases%wall)], 0.0_wp)
      call add_reals(table, 'cpu', 's', [phases%cpu, sum(phases%cpu)], 0.0_wp)
      call write_table(set, table, origin_of(model, history), digits, status, is_csv)
   end subroutine write_timing

end module atrito_write_tables
