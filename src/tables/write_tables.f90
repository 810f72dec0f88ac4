!> The tables of a run, docs/user/tables.md: which there are and when each is written.
module atrito_write_tables
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_status, only: status_t, is_ok
   use atrito_files, only: file_set_t
   use atrito_own_files, only: names_with
   use atrito_system, only: peak_memory
   use atrito_timers, only: phase_time_t, get_phases
   use atrito_model, only: model_t
   use atrito_results, only: results_t, history_t, last_frame, view_frame
   use atrito_frame_tables, only: has_frame_rows, build_frame_table
   use atrito_history_tables, only: build_summary, note_quantities, dimension_remarks, build_history, build_iterations
   use atrito_increments, only: has_history, ending_text
   use atrito_summary, only: scales_t, measure_history
   use atrito_table, only: table_t, origin_t, begin_table, add_reals, add_words, one_word, TAB_ENDING, CSV_ENDING, HEAD_ENDING
   use atrito_table_text, only: write_table, growing_table_t, measure_rows, open_table, put_table, close_table
   implicit none (type, external)
   private
   public :: write_tables, write_timing, list_table_files, origin_of, TABLE_NAMES, SHOWN_TABLES

   !> Every table that atrito can write.
   character(len=12), parameter :: TABLE_NAMES(19) = [character(len=12) :: 'contact', 'summary', 'extremes', 'resultants', &
                                                              'history', 'nodes', 'reactions', 'stress', 'nodal_stress', 'bodies', &
                                                            'rigid', 'joints', 'sections', 'path', 'ties', 'equations', 'springs', &
                                                                                                             'iterations', 'timing']

   !> Those of --adapt and --show.
   character(len=12), parameter :: SHOWN_TABLES(8) = [character(len=12) :: 'adapt', 'show-element', 'show-matrix', 'show-line', &
                                                                           'show-motions', 'show-states', 'show-law', 'show-picard']

   !> What all tables of a run have in common.
   type :: common_t
      integer :: digits                             !< significant ones, 6..17
      logical :: is_csv                             !< comma-separated values
      type(origin_t) :: origin                      !< what stands at the top of each
      type(scales_t) :: scales                      !< of the history: what is nothing beside them is written as 0
      type(scales_t), allocatable :: own(:)         !< of each pair
   end type common_t

   !> A table that gets its rows frame by frame.
   type :: series_t
      character(len=:), allocatable :: name         !< of the table
      logical, allocatable :: is_due(:)             !< (frames) that have rows in it
      type(string_t), allocatable :: quantities(:)  !< of the summary, by dimension
      type(string_t), allocatable :: remarks(:)     !< that all frames have a part in; not allocated: there are none
      type(growing_table_t) :: file                 !< open while frames are written
   end type series_t

   !> The comment lines at the top: of one result, or of a history.
   interface origin_of
      module procedure origin_of_results, origin_of_history
   end interface origin_of

contains

   !> File names of every table that atrito can write: what a new run replaces or removes. Those of --show, and heads of
   !> comma-separated values, as far as they are there: few runs leave any.
   function list_table_files(folder) result(names)
      character(len=*), intent(in) :: folder !< of the tables
      type(string_t), allocatable :: names(:)
      character(len=12), parameter :: ALL_TABLES(*) = [TABLE_NAMES, SHOWN_TABLES]
      integer :: i

      allocate (names(2*size(TABLE_NAMES)))
      do i = 1, size(TABLE_NAMES)
         names(2*i - 1)%s = trim(TABLE_NAMES(i))//TAB_ENDING
         names(2*i)%s = trim(TABLE_NAMES(i))//CSV_ENDING
      end do
      call append_found(HEAD_ENDING, ALL_TABLES)
      call append_found(TAB_ENDING, SHOWN_TABLES)
      call append_found(CSV_ENDING, SHOWN_TABLES)

   contains

      subroutine append_found(ending, tables)
         character(len=*), intent(in) :: ending, tables(:)
         type(string_t), allocatable :: found(:)
         integer :: k

         found = names_with(folder, ending)
         do k = 1, size(found)
            if (any(tables == found(k)%s(:len(found(k)%s) - len(ending)))) call append_string(names, found(k)%s)
         end do
      end subroutine append_found

   end function list_table_files

   pure function origin_of_results(model, results) result(origin)
      type(model_t), intent(in) :: model     !< path, heading and provenance are read
      type(results_t), intent(in) :: results !< of one increment; whether it converged is read
      type(origin_t) :: origin

      origin%deck = model%deck_path(index(model%deck_path, '/', back=.true.) + 1:)
      origin%heading = model%heading
      origin%provenance_t = model%provenance
      origin%not_converged = .not. (results%converged .and. results%law_holds)
   end function origin_of_results

   !> A history that ended early is marked, though what it holds converged.
   pure function origin_of_history(model, history) result(origin)
      type(model_t), intent(in) :: model     !< path, heading and provenance are read
      type(history_t), intent(in) :: history !< with all frames; it is not empty
      type(origin_t) :: origin

      origin = origin_of_results(model, history%frames(last_frame(history)))
      if (.not. history%ending%is_early) return
      origin%not_converged = .true.
      origin%ending = ending_text(history)
   end function origin_of_history

   !> Writes all tables of a run but timing.tab, which comes last: contact whenever there is a pair, history when there is one,
   !> summary and iterations always, the rest when the deck asks. The frames are shown one after the other: to be measured, to find
   !> how wide the columns are, and to be written, each into all tables.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_tables(model, history, digits, set, status, is_csv)
      type(model_t), intent(in), target :: model     !< as solved
      type(history_t), intent(in), target :: history !< with all frames; it is not empty
      integer, intent(in) :: digits                  !< significant digits, 6..17
      type(file_set_t), intent(inout) :: set         !< begun; gets the files
      type(status_t), intent(out) :: status          !< STATUS_FILE where one could not be written
      logical, intent(in) :: is_csv                  !< comma-separated values
      type(common_t) :: whole
      type(series_t) :: series(size(TABLE_NAMES))
      type(results_t), pointer :: frame
      type(table_t) :: piece
      type(status_t) :: of_file
      integer(ip) :: i
      integer :: k

      whole%digits = digits
      whole%is_csv = is_csv
      whole%origin = origin_of(model, history)
      call measure_history(model, history, whole%scales, whole%own)
      do k = 1, size(series)
         series(k)%name = trim(TABLE_NAMES(k))
         allocate (series(k)%is_due(last_frame(history)))
      end do
      do i = 1, last_frame(history)
         call view_frame(history, i, frame)
         do k = 1, size(series)
            call measure_series(model, frame, whole, i, series(k))
         end do
      end do
      do k = 1, size(series)
         if (is_ok(status)) call begin_series(model, history, whole, set, series(k), status)
      end do
      do i = 1, merge(last_frame(history), 0_ip, is_ok(status))
         call view_frame(history, i, frame)
         do k = 1, size(series)
            if (.not. series(k)%is_due(i)) cycle
            if (allocated(series(k)%quantities)) series(k)%remarks = dimension_remarks(series(k)%quantities)
            call build_piece(model, frame, whole, series(k)%name, piece)
            call put_table(series(k)%file, piece, whole%origin, whole%digits, series(k)%remarks)
         end do
      end do
      do k = 1, size(series)
         call close_table(series(k)%file, of_file)
         if (is_ok(status)) status = of_file
      end do
   end subroutine write_tables

   !> Notes whether a table has rows of a frame, and the room that they need. Tables of the whole history have none, nor has that of
   !> the times, which comes last.
   subroutine measure_series(model, frame, whole, i, series)
      type(model_t), intent(in), target :: model
      type(results_t), intent(in), target :: frame
      type(common_t), intent(in) :: whole
      integer(ip), intent(in) :: i                  !< which frame
      type(series_t), intent(inout) :: series
      type(table_t) :: piece
      integer :: n

      n = size(series%is_due)
      associate (name => series%name)
         series%is_due(i) = .not. any(name == [character(len=10) :: 'history', 'iterations', 'timing'])
         if (series%is_due(i) .and. name /= 'summary') series%is_due(i) = has_frame_rows(model, frame, name, i == n)
         if (name == 'summary') call note_quantities(frame, whole%own, series%quantities)
         if (n == 1 .or. .not. series%is_due(i)) return
         call build_piece(model, frame, whole, name, piece)
         call measure_rows(series%file, piece, whole%digits)
      end associate
   end subroutine measure_series

   !> Opens a table that has rows of frames; one of the whole history is written.
   subroutine begin_series(model, history, whole, set, series, status)
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      type(common_t), intent(in) :: whole
      type(file_set_t), intent(inout) :: set
      type(series_t), intent(inout) :: series
      type(status_t), intent(inout) :: status
      type(table_t) :: table

      select case (series%name)
      case ('timing')
         return
      case ('history')
         if (.not. merge(has_history(model, history), history%observed%n > 1, size(history%rows) > 0)) return
         call build_history(history, whole%scales%length, table)
         call write_table(set, table, whole%origin, whole%digits, status, whole%is_csv)
      case ('iterations')
         call build_iterations(history, table)
         call write_table(set, table, whole%origin, whole%digits, status, whole%is_csv)
      case default
         if (any(series%is_due)) call open_table(set, series%name, series%file, whole%is_csv)
      end select
   end subroutine begin_series

   !> The rows of a frame; they may point at the fields of model and frame.
   subroutine build_piece(model, frame, whole, name, piece)
      type(model_t), intent(in), target :: model
      type(results_t), intent(in), target :: frame
      type(common_t), intent(in) :: whole
      character(len=*), intent(in) :: name
      type(table_t), intent(out) :: piece

      if (name == 'summary') then
         call build_summary(frame, whole%own, whole%digits, piece)
      else
         call build_frame_table(model, frame, whole%scales, whole%own, name, piece)
      end if
   end subroutine build_piece

   !> Writes the table timing: the phases that have ended, their sum, and the peak memory as a comment.
   subroutine write_timing(model, history, digits, set, status, is_csv)
      type(model_t), intent(in) :: model            !< path, heading and provenance are read
      type(history_t), intent(in) :: history        !< with all frames; it is not empty
      integer, intent(in) :: digits                 !< significant digits, 6..17
      type(file_set_t), intent(inout) :: set        !< begun; gets the file
      type(status_t), intent(out) :: status         !< STATUS_FILE where it could not be written
      logical, intent(in) :: is_csv                 !< comma-separated values
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
