!> Writes a run: all tables, the field file and the listing, which appear together or not at all.
module atrito_write_results
   use atrito_as_run_names, only: as_run_name, mesh_copy_name
   use atrito_own_files, only: DECK_MARK, MESH_MARK
   use atrito_patched_text, only: patched_text_t, write_patched
   use atrito_strings, only: string_t, append_string
   use atrito_status, only: status_t, is_ok, set_status, STATUS_FILE
   use atrito_files, only: file_set_t, begin_files, end_files, file_exists, remove_empty_folder, NEW_LINE_CHARACTER
   use atrito_kinds, only: ip
   use atrito_timers, only: start_phase, stop_phase
   use atrito_model, only: model_t
   use atrito_version, only: PROGRAM_VERSION
   use atrito_results, only: history_t
   use atrito_table, only: table_t
   use atrito_table_text, only: write_table
   use atrito_write_tables, only: write_tables, write_timing, list_table_files, origin_of
   use atrito_write_fields, only: write_fields, list_field_files
   use atrito_listing, only: write_listing
   use atrito_plot_files, only: remove_plots, PLOTS_OF_RUN, REPORT_NAME, remove_report
   implicit none (type, external)
   private
   public :: write_results, remove_results, list_files_of_run

contains

   !> The files that a run of this model may write into a folder, or remove from it, without folder.
   function list_files_of_run(model, folder) result(names)
      type(model_t), intent(in) :: model         !< names of its deck, cuts and paths
      character(len=*), intent(in) :: folder     !< of the tables
      type(string_t), allocatable :: names(:)

      call list_stale_files(model, folder, names)
      call append_string(names, model%deck_name//'.lst')
      call append_string(names, REPORT_NAME)
   end function list_files_of_run

   !> Writes everything into a folder, which is made where it is missing, and removes the files of an earlier run that this one
   !> does not write, its pictures and its report too.
   !>
   !> status: STATUS_FILE, and then what the folder held before is untouched.
   subroutine write_results(model, history, digits, folder, written, status, pictures, is_csv, shown)
      type(model_t), intent(in) :: model                     !< as solved
      type(history_t), intent(in) :: history            !< with frames
      integer, intent(in) :: digits                     !< significant digits of the tables, 6..17
      character(len=*), intent(in) :: folder                 !< of the tables; made where it is missing
      type(string_t), allocatable, intent(out) :: written(:) !< names of the files, without folder
      type(status_t), intent(out) :: status                  !< STATUS_OK or STATUS_FILE
      type(string_t), intent(in), optional :: pictures(:)    !< that will be drawn after this, for the listing
      logical, intent(in), optional :: is_csv                !< tables as comma-separated values; left out: .false.
      type(table_t), intent(in), optional :: shown(:)        !< further tables, of --show
      type(file_set_t) :: set
      type(string_t), allocatable :: stale(:)
      type(table_t) :: table
      logical :: as_csv
      integer :: i

      as_csv = .false.
      if (present(is_csv)) as_csv = is_csv
      allocate (written(0))
      call begin_files(set, folder, status)
      if (.not. is_ok(status)) return
      call start_phase('write')
      call write_tables(model, history, digits, set, status, as_csv)
      if (present(shown)) then
         do i = 1, size(shown)
            table = shown(i)
            if (is_ok(status)) call write_table(set, table, origin_of(model, history), digits, status, as_csv)
         end do
      end if
      if (is_ok(status)) call write_fields(model, history, set, status)
      if (is_ok(status)) call write_deck_as_run(model, set, status)
      call stop_phase('write')
      ! these two tell the time, that of writing the tables included
      if (is_ok(status)) call write_timing(model, history, digits, set, status, as_csv)
      if (is_ok(status)) call write_listing(model, history, set, status, pictures)
      if (associated(history%store) .and. is_ok(status)) then
         if (history%store%has_failed) call set_status(status, STATUS_FILE, folder//': what was put aside there while it was '// &
                                                       'solved cannot be read again')
      end if
      call list_stale_files(model, folder, stale)
      call end_files(set, status, stale)
      if (.not. is_ok(status)) return
      written = set%names
      call remove_plots(folder, PLOTS_OF_RUN)
      call remove_report(folder)
   end subroutine write_results

   !> Removes what a run of this model has written into a folder, and the folder where nothing else is in it.
   !>
   !> status: STATUS_FILE, and then it is as it was.
   subroutine remove_results(model, folder, status)
      type(model_t), intent(in) :: model         !< names of its deck, cuts and paths
      character(len=*), intent(in) :: folder     !< of the tables
      type(status_t), intent(out) :: status      !< STATUS_OK or STATUS_FILE
      type(file_set_t) :: set

      call begin_files(set, folder, status)
      call end_files(set, status, list_files_of_run(model, folder))
      if (.not. is_ok(status)) return
      call remove_plots(folder, PLOTS_OF_RUN)
      call remove_report(folder)
      call remove_empty_folder(folder)
   end subroutine remove_results

   !> Writes the deck as it was run, and the meshes of other programs beside it, with the words by which a later run knows them.
   subroutine write_deck_as_run(model, set, status)
      type(model_t), intent(in) :: model
      type(file_set_t), intent(inout) :: set
      type(status_t), intent(inout) :: status
      integer :: i, last
      character(len=:), allocatable :: words

      if (.not. allocated(model%as_run)) return
      do i = 1, size(model%as_run)
         if (.not. is_ok(status)) return
         associate (file => model%as_run(i))
            if (i == 1) then
               call write_patched(set, file%name, file%text, status, &
                                  before=DECK_MARK//PROGRAM_VERSION//' ran this'//NEW_LINE_CHARACTER)
            else
               ! What stands behind the copy of a mesh, on lines of its own.
               words = MESH_MARK//PROGRAM_VERSION//NEW_LINE_CHARACTER//'$EndComments'//NEW_LINE_CHARACTER
               if (file%text%n /= 0) then
                  last = file%text%pieces(file%text%n)%last
                  if (file%text%texts(1)%s(last:last) /= NEW_LINE_CHARACTER) words = NEW_LINE_CHARACTER//words
               end if
               call write_patched(set, file%name, file%text, status, behind=words)
            end if
         end associate
      end do
   end subroutine write_deck_as_run

   !> What an earlier run may have left: tables, fields, and its deck.
   subroutine list_stale_files(model, folder, names)
      type(model_t), intent(in) :: model
      character(len=*), intent(in) :: folder
      type(string_t), allocatable, intent(out) :: names(:)
      type(string_t), allocatable :: fields(:)
      integer(ip) :: i

      names = list_table_files(folder)
      fields = list_field_files(model)
      do i = 1, size(fields, kind=ip)
         call append_string(names, fields(i)%s)
      end do
      call append_string(names, as_run_name(model%deck_name))
      i = 1
      if (allocated(model%as_run)) i = size(model%as_run, kind=ip)
      do i = 1, i - 1
         call append_string(names, mesh_copy_name(model%deck_name, i))
      end do
      do while (file_exists(folder//'/'//mesh_copy_name(model%deck_name, i)))
         call append_string(names, mesh_copy_name(model%deck_name, i))
         i = i + 1
      end do
   end subroutine list_stale_files

end module atrito_write_results
