!> The pictures of `check --plot`: the scene, its sets and the gaps of its pairs, before anything is solved.
!>
!> As with the pictures of a run, a failure is a warning, W-PLOT. Pictures of an earlier check are replaced; those of a run stay.
module atrito_check_plots
   use atrito_body_plots, only: write_scene_plot
   use atrito_gap_plot, only: write_gap_plot, has_gap_plot
   use atrito_gnuplot, only: draw_written
   use atrito_model, only: model_t
   use atrito_plot_files, only: plot_folder, remove_plots, PLOTS_OF_CHECK, SCENE_PLOT, SET_PLOT, GAP_PLOT
   use atrito_plot_scripts, only: plots_t, begin_plots, end_plots
   use atrito_plot_view, only: plot_view_t
   use atrito_set_plot, only: write_set_plot, has_set_plot
   use atrito_status, only: status_t
   use atrito_strings, only: string_t, append_string
   implicit none (type, external)
   private
   public :: write_check_plots, write_check_scripts, check_plot_names

contains

   !> Writes the scripts of all pictures into <folder>/plots and draws them.
   subroutine write_check_plots(model, view, folder, drawn)
      type(model_t), intent(in) :: model                    !< with the points of its pairs
      type(plot_view_t), intent(in) :: view                 !< of which the box is heeded: nothing is displaced
      character(len=*), intent(in) :: folder
      type(string_t), allocatable, intent(out) :: drawn(:)  !< pictures, names without ending
      type(status_t) :: status

      call remove_plots(folder, PLOTS_OF_CHECK)
      call write_check_scripts(model, view, plot_folder(folder), status)
      call draw_written(folder, check_plot_names(model), status, drawn)
   end subroutine write_check_plots

   !> The pictures that `check --plot` draws of a model, names without ending.
   pure function check_plot_names(model) result(names)
      type(model_t), intent(in) :: model
      type(string_t), allocatable :: names(:)

      call append_string(names, SCENE_PLOT)
      if (has_set_plot(model)) call append_string(names, SET_PLOT)
      if (has_gap_plot(model)) call append_string(names, GAP_PLOT)
   end function check_plot_names

   !> Writes scripts and data, which appear together or not at all.
   !>
   !> status: STATUS_FILE
   subroutine write_check_scripts(model, view, folder, status)
      type(model_t), intent(in) :: model
      type(plot_view_t), intent(in) :: view
      character(len=*), intent(in) :: folder                !< of the plots
      type(status_t), intent(out) :: status
      type(plots_t) :: plots

      call begin_plots(plots, folder)
      call write_scene_plot(plots, model, view)
      if (has_set_plot(model)) call write_set_plot(plots, model, view)
      if (has_gap_plot(model)) call write_gap_plot(plots, model)
      call end_plots(plots, status)
   end subroutine write_check_scripts

end module atrito_check_plots
