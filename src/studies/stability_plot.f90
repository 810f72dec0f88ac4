!> The pictures of `atrito limit`: what is watched against the parameter, up to the limit; and the mechanism.
module atrito_stability_plot
   use atrito_body_plots, only: write_mechanism_plot
   use atrito_gnuplot, only: draw_written
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: plot_folder, LIMIT_PLOT, MECHANISM_PLOT
   use atrito_plot_scripts, only: plots_t, begin_plots, end_plots, put, begin_data, begin_script, put_terminal
   use atrito_plot_text, only: range_t, cover, padded, range_of, range_text, engineering_exponent, power_text, quoted, &
                               cleaned, LF, COLOUR
   use atrito_plot_view, only: plot_view_t
   use atrito_stability_result, only: stability_t
   use atrito_status, only: status_t, STATUS_OK, STATUS_NOT_CONVERGED
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
      character(len=*), intent(in) :: title          !< of the deck, or its name
      type(model_t), intent(in) :: model             !< at the value that falls
      type(stability_t), intent(in) :: limit         !< whose limit was found
      type(plot_view_t), intent(in) :: view          !< of the mechanism
      type(string_t), allocatable, intent(out) :: drawn(:) !< names of those that have their pictures now
      type(plots_t) :: plots
      type(status_t) :: status
      type(string_t) :: names(2)

      call begin_plots(plots, plot_folder(folder), model%units)
      call begin_data(plots, LIMIT_PLOT, 'blocks: solved and checked, not converged; columns: '//limit%parameter// &
                      ', displacement [L]')
      call put_values(plots, limit, STATUS_OK)
      call put_values(plots, limit, STATUS_NOT_CONVERGED)
      call write_script(plots, title, limit)
      call write_mechanism_plot(plots, model, limit, title, view)
      call end_plots(plots, status)
      names(1)%s = LIMIT_PLOT
      names(2)%s = MECHANISM_PLOT
      call draw_written(folder, names, status, drawn)
   end subroutine write_stability_plots

   !> The block of the values that ended so.
   subroutine put_values(plots, limit, code)
      type(plots_t), intent(inout) :: plots
      type(stability_t), intent(in) :: limit
      integer, intent(in) :: code
      integer :: i

      do i = 1, size(limit%values)
         associate (one => limit%values(i))
            if (one%code == code) call put(plots, trimmed_real(one%value, MANY_DIGITS)//' '// &
                                           trimmed_real(one%displacement, MANY_DIGITS))
         end associate
      end do
      call put(plots, LF)
   end subroutine put_values

   !> The curve; the part beyond the limit is shaded.
   subroutine write_script(plots, title, limit)
      type(plots_t), intent(inout) :: plots
      character(len=*), intent(in) :: title
      type(stability_t), intent(in) :: limit
      type(range_t) :: across, up
      integer :: i
      character(len=:), allocatable :: line, falls, fallen, unit
      integer(ip) :: power

      across = range_of([limit%stands, limit%falls])
      call cover(up, [0.0_wp])
      do i = 1, size(limit%values)
         if (limit%values(i)%code /= STATUS_OK) cycle
         call cover(across, [limit%values(i)%value])
         call cover(up, [limit%values(i)%displacement])
      end do
      power = engineering_exponent(up)
      unit = '1e'//to_text(power)
      up = range_t(up%low/10.0_wp**power, up%high/10.0_wp**power)
      falls = 'first '//to_text(limit%falls, MANY_DIGITS)
      fallen = 'graph 0, graph 0 to '//falls
      if (limit%falls > limit%stands) fallen = falls//', graph 0 to graph 1'
      call begin_script(plots, LIMIT_PLOT, 'a displacement up to the limit of '//limit%parameter, &
                        'Columns of limit.dat: 1 '//limit%parameter//', 2 displacement [L]')
      call put(plots, 'set border 3 lt 1 lw 1 lc rgb "#404040"; set tics nomirror out scale 0.6 textcolor rgb "black"'//LF// &
               'set grid lt 1 lw 1 lc rgb "#E0E0E0"; set format x "%h"; set format y "%h"'//LF// &
               'set xrange '//range_text(padded(across))//'; set yrange '//range_text(padded(up))//LF// &
               'set style rect fc rgb "#D55E00" fs transparent solid 0.12 noborder'//LF// &
               'set object 1 rect from '//fallen//', graph 1 behind'//LF// &
               'set arrow 1 from '//falls//', graph 0 rto 0, graph 1 nohead lt 1 lw 1.5 lc rgb "#D55E00"')
      call put_terminal(plots, '1000,560')
      call put(plots, 'set title '//quoted(cleaned(title, LONGEST_TITLE))//' noenhanced'//LF// &
               'set xlabel '//quoted(limit%parameter)//' noenhanced; set ylabel '// &
               quoted(limit%watched//' ['//power_text(power)//'L]')//LF// &
               'set key noautotitle outside bottom center horizontal Left reverse samplen 2.5')
      line = 'plot "limit.dat" index 0 using 1:($2/'//unit//') with linespoints lt 1 lw 1.8 pt 7 ps 0.9*dot lc rgb "'//COLOUR(1)// &
             '" title "stands"'
      if (any(limit%values%code == STATUS_NOT_CONVERGED)) line = line//', "limit.dat" index 1 using 1:(0) with points lt 1'// &
                                                                 ' lw 1.5 pt 2 ps 1.1*dot lc rgb "#606060" title "undecided"'
      call put(plots, line//', NaN with lines lt 1 lw 1.5 lc rgb "#D55E00" title '// &
               quoted('falls from '//to_text(limit%falls, 8)//' on')//' noenhanced')
   end subroutine write_script

end module atrito_stability_plot
