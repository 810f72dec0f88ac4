!> The pictures of a run, `--plot`: scripts and data into DIR/plots, then gnuplot.
!>
!> Comes after the tables, which are complete whatever happens here: every failure is a warning, W-PLOT.
module atrito_write_plots
   use atrito_body_plots, only: draw_mesh, write_mesh_plot
   use atrito_contact_plot, only: write_contact_plot
   use atrito_contour_fields, only: contour_t, contours_of
   use atrito_contour_plot, only: write_contour_plots
   use atrito_drawing, only: drawing_t
   use atrito_force_plots, only: has_traction_plot, write_traction_plot, has_joint_plot, write_joint_plot
   use atrito_gnuplot, only: draw_written
   use atrito_history_plot, only: has_history_plot, has_loop_plot, write_history_plot, write_loop_plot
   use atrito_kinds, only: ip
   use atrito_model, only: model_t
   use atrito_motion_plot, only: write_motion_plot
   use atrito_path_plot, only: plotted_paths, write_path_plot
   use atrito_plot_files, only: plot_folder, CONTACT_PLOT, MESH_PLOT, JOINT_PLOT, HISTORY_PLOT, LOOP_PLOT, MOTION_PLOT, &
                                PATH_PLOT, TRACTION_PLOT
   use atrito_plot_scripts, only: plots_t, begin_plots, end_plots
   use atrito_plot_view, only: plot_view_t
   use atrito_results, only: results_t, history_t, last_frame
   use atrito_status, only: status_t
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_summary, only: pair_count
   use atrito_timers, only: start_phase, stop_phase
   implicit none (type, external)
   private
   public :: write_plots, write_plot_scripts, plot_names

   !> Of more pairs than these there are no pictures of their own beside that of the joints.
   integer(ip), parameter :: MANY_PAIRS = 20

contains

   !> Writes the scripts of all pictures into <folder>/plots and draws them.
   subroutine write_plots(model, history, folder, view, drawn)
      type(model_t), intent(in) :: model                    !< as solved
      type(history_t), intent(in) :: history                !< printed increments
      character(len=*), intent(in) :: folder                !< of the tables
      type(plot_view_t), intent(in) :: view                 !< what is asked of the pictures of bodies
      type(string_t), allocatable, intent(out) :: drawn(:)  !< pictures, names without ending
      type(status_t) :: status

      call start_phase('plot')
      call write_plot_scripts(model, history, plot_folder(folder), view, status)
      call draw_written(folder, plot_names(model, history), status, drawn)
      call stop_phase('plot')
   end subroutine write_plots

   !> Pictures of a run: the mesh, contours, tractions, what is drawn of a history, the joints where they are asked for, and each
   !> pair that has points, and paths.
   pure function plot_names(model, history) result(names)
      type(model_t), intent(in) :: model         !< what its steps ask for
      type(history_t), intent(in) :: history     !< printed increments
      type(string_t), allocatable :: names(:)
      type(contour_t), allocatable :: contours(:)
      integer(ip) :: i

      associate (results => history%frames(last_frame(history)))
         call append_string(names, MESH_PLOT)
         contours = contours_of(results)
         do i = 1, size(contours, kind=ip)
            call append_string(names, trim(contours(i)%name))
         end do
         if (has_traction_plot(results)) call append_string(names, TRACTION_PLOT)
         if (has_history_plot(model, history)) call append_string(names, HISTORY_PLOT)
         if (has_loop_plot(model, history)) call append_string(names, LOOP_PLOT)
         if (size(history%frames) > 1) call append_string(names, MOTION_PLOT)
         if (has_joint_plot(model, results)) call append_string(names, JOINT_PLOT)
         do i = 1, plotted_pairs(model, results)
            if (results%contact(i)%n > 0) call append_string(names, CONTACT_PLOT//to_text(i))
         end do
         do i = 1, plotted_paths(model, results)
            call append_string(names, PATH_PLOT//to_text(i))
         end do
      end associate
   end function plot_names

   !> How many pairs have pictures of their own, those without points among them: all or none.
   pure integer(ip) function plotted_pairs(model, results) result(n)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results

      n = pair_count(results)
      if (n > MANY_PAIRS .and. has_joint_plot(model, results)) n = 0
   end function plotted_pairs

   !> Writes scripts and data, which appear together or not at all: those of the last frame, over the ends of steps before it, then
   !> those of a history.
   !>
   !> status: STATUS_FILE
   subroutine write_plot_scripts(model, history, folder, view, status)
      type(model_t), intent(in), target :: model            !< as solved
      type(history_t), intent(in), target :: history        !< printed increments; one at least
      character(len=*), intent(in) :: folder                !< of the plots
      type(plot_view_t), intent(in) :: view                 !< what is asked of the pictures of bodies
      type(status_t), intent(out) :: status                 !< STATUS_OK or STATUS_FILE
      type(plots_t), target :: plots
      type(drawing_t) :: drawing
      integer(ip) :: i

      call begin_plots(plots, folder, model%units)
      associate (results => history%frames(last_frame(history)))
         call draw_mesh(model, results, view, drawing)
         call write_mesh_plot(plots, drawing)
         call write_contour_plots(plots, drawing)
         if (has_traction_plot(results)) call write_traction_plot(plots, drawing)
         if (has_joint_plot(model, results)) call write_joint_plot(plots, drawing)
         do i = 1, plotted_pairs(model, results)
            if (results%contact(i)%n > 0) call write_contact_plot(plots, model, history, i)
         end do
         do i = 1, plotted_paths(model, results)
            call write_path_plot(plots, model, history, i)
         end do
      end associate
      if (has_history_plot(model, history)) call write_history_plot(plots, model, history)
      if (has_loop_plot(model, history)) call write_loop_plot(plots, model, history)
      if (size(history%frames) > 1) call write_motion_plot(plots, model, history, view)
      call end_plots(plots, status)
   end subroutine write_plot_scripts

end module atrito_write_plots
