!> Writes a run: all tables, the field file and the listing, which appear together or not at all.
module atrito_write_results
   use atrito_strings, only: string_t
   use atrito_status, only: status_t, is_ok
   use atrito_files, only: file_set_t, begin_files, end_files
   use atrito_timers, only: start_phase, stop_phase
   use atrito_model, only: model_t
   use atrito_results, only: history_t
   use atrito_write_tables, only: write_tables, write_timing, list_table_files
   use atrito_write_fields, only: write_fields, list_field_files
   use atrito_listing, only: write_listing
   use atrito_plot_files, only: remove_plots
   implicit none (type, external)
   private
   public :: write_results

contains

   !> Writes everything into a folder, which is made where it is missing, and removes the files of an earlier run that this one
   !> does not write, its pictures too.
   !>
   !> status: STATUS_FILE, and then what the folder held before is untouched.
   subroutine write_results(model, history, digits, folder, written, status, pictures)
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history            !< with frames
      integer, intent(in) :: digits                     !< significant digits of the tables, 6..17
      character(len=*), intent(in) :: folder
      type(string_t), allocatable, intent(out) :: written(:) !< names of the files, without folder
      type(status_t), intent(out) :: status
      type(string_t), intent(in), optional :: pictures(:)    !< that will be drawn after this, for the listing
      type(file_set_t) :: set

      allocate (written(0))
      call begin_files(set, folder, status)
      if (.not. is_ok(status)) return
      call start_phase('write')
      call write_tables(model, history, digits, set, status)
      if (is_ok(status)) call write_fields(model, history, set, status)
      call stop_phase('write')
      ! these two tell the time, that of writing the tables included
      if (is_ok(status)) call write_timing(model, history, digits, set, status)
      if (is_ok(status)) call write_listing(model, history, set, status, pictures)
      call end_files(set, status, [list_table_files(), list_field_files(model)])
      if (.not. is_ok(status)) return
      written = set%names
      call remove_plots(folder)
   end subroutine write_results

end module atrito_write_results
