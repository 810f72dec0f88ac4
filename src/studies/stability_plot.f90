!> The pictures of `atrito limit`: what is watched against the parameter, up to the limit; and the mechanism.
module atrito_stability_plot
   use atrito_kinds, only: wp
   use atrito_files, only: file_set_t, text_file_t, begin_files, put_line, close_text, end_files
   use atrito_gnuplot, only: draw_written
   use atrito_mechanism_plot, only: write_mechanism_plot
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: open_data, check_scripts, plot_folder, LIMIT_PLOT, MECHANISM_PLOT
   use atrito_plot_text, only: range_t, cover, padded, range_text, quoted, cleaned, begin_script, end_script, put_terminal, COLOUR
   use atrito_plot_view, only: plot_view_t
   use atrito_stability_result, only: stability_t
   use atrito_status, only: status_t, is_ok, STATUS_OK, STATUS_NOT_CONVERGED
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: write_stability_plots

   integer, parameter :: LONGEST_TITLE = 90          !< characters
   integer, parameter :: MANY_DIGITS = 12            !< of limit.dat: values crowd at the limit

contains

   !> Draws <folder>/plots/limit and mechanism, .png and .svg. A failure is a warning, W-PLOT.
   subroutine write_stability_plots(folder, title, model, limit, view, drawn)
      character(len=*), intent(in) :: folder         !< of the tables
      character(len=*), intent(in) :: title
      type(model_t), intent(in) :: model             !< at the value that falls
      type(stability_t), intent(in) :: limit
      type(plot_view_t), intent(in) :: view          !< of the mechanism
      type(string_t), allocatable, intent(out) :: drawn(:)
      type(file_set_t) :: set
      type(status_t) :: status
      type(string_t) :: plots(2)
      type(text_file_t) :: file

      call begin_files(set, plot_folder(folder), status)
      ! Blocks: values that stand, values without a decision.
      if (is_ok(status)) then
         call open_data(set, LIMIT_PLOT, file)
         call put_line(file, '# blocks: solved and checked, not converged; columns: '//limit%parameter//', displacement [L]')
         call put_values(file, limit, STATUS_OK)
         call put_values(file, limit, STATUS_NOT_CONVERGED)
         call close_text(file, status)
      end if
      if (is_ok(status)) call write_script(set, title, limit, status)
      if (is_ok(status)) call write_mechanism_plot(set, model, limit, title, view, status)
      call check_scripts(set, status)
      call end_files(set, status)
      plots(1)%s = LIMIT_PLOT
      plots(2)%s = MECHANISM_PLOT
      call draw_written(folder, plots, status, drawn)
   end subroutine write_stability_plots

   subroutine put_values(file, limit, code)
      type(text_file_t), intent(inout) :: file
      type(stability_t), intent(in) :: limit
      integer, intent(in) :: code
      integer :: i

      do i = 1, size(limit%values)
         associate (one => limit%values(i))
            if (one%code == code) call put_line(file, trimmed_real(one%value, MANY_DIGITS)//' ' &
                                                //trimmed_real(one%displacement, MANY_DIGITS))
         end associate
      end do
      call put_line(file, '')
      call put_line(file, '')
   end subroutine put_values

   subroutine write_script(set, title, limit, status)
      type(file_set_t), intent(inout) :: set
      character(len=*), intent(in) :: title
      type(stability_t), intent(in) :: limit
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(range_t) :: across, up
      integer :: i
      character(len=:), allocatable :: line

      call cover(across, [limit%stands, limit%falls])
      call cover(up, [0.0_wp])
      do i = 1, size(limit%values)
         if (limit%values(i)%code /= STATUS_OK) cycle
         call cover(across, [limit%values(i)%value])
         call cover(up, [limit%values(i)%displacement])
      end do
      call begin_script(set, LIMIT_PLOT, 'a displacement up to the limit of '//limit%parameter, file)
      call put_line(file, '# Columns of limit.dat: 1 '//limit%parameter//', 2 displacement [L]')
      call put_line(file, 'set border 3 lt 1 lw 1 lc rgb "#404040"; set tics nomirror out scale 0.6 textcolor rgb "black"')
      call put_line(file, 'set grid lt 1 lw 1 lc rgb "#E0E0E0"; set format x "%h"; set format y "%h"')
      call put_line(file, 'set xrange '//range_text(padded(across))//'; set yrange '//range_text(padded(up)))
      call put_line(file, 'set style rect fc rgb "#D55E00" fs transparent solid 0.12 noborder')
      call put_fallen(file, limit)
      call put_terminal(file, LIMIT_PLOT, '1000,560')
      call put_line(file, 'set title '//quoted(cleaned(title, LONGEST_TITLE))//' noenhanced')
      call put_line(file, 'set xlabel '//quoted(limit%parameter)//' noenhanced; set ylabel '//quoted(limit%watched//' [L]')// &
                    ' noenhanced')
      call put_line(file, 'set key noautotitle outside bottom center horizontal Left reverse samplen 2.5')
      line = 'plot "limit.dat" index 0 using 1:2 with linespoints lt 1 lw 1.8 pt 7 ps 0.9*dot lc rgb "'//COLOUR(1)// &
             '" title "stands"'
      if (any(limit%values%code == STATUS_NOT_CONVERGED)) line = line//', "limit.dat" index 1 using 1:(0) with points lt 1'// &
                                                                 ' lw 1.5 pt 2 ps 1.1*dot lc rgb "#606060" title "undecided"'
      call put_line(file, line//', NaN with lines lt 1 lw 1.5 lc rgb "#D55E00" title '// &
                    quoted('falls from '//to_text(limit%falls, 8)//' on')//' noenhanced')
      call end_script(file, status)
   end subroutine write_script

   !> The part beyond the limit is shaded.
   subroutine put_fallen(file, limit)
      type(text_file_t), intent(inout) :: file
      type(stability_t), intent(in) :: limit
      character(len=:), allocatable :: left, right

      left = 'graph 0'
      right = 'first '//to_text(limit%falls, MANY_DIGITS)
      if (limit%falls > limit%stands) then
         left = right
         right = 'graph 1'
      end if
      call put_line(file, 'set object 1 rect from '//left//', graph 0 to '//right//', graph 1 behind')
      call put_line(file, 'set arrow 1 from first '//to_text(limit%falls, MANY_DIGITS)//', graph 0 rto 0, graph 1 nohead lt 1'// &
                    ' lw 1.5 lc rgb "#D55E00"')
   end subroutine put_fallen

end module atrito_stability_plot
