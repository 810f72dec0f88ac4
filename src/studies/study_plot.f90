!> The picture of a study: errors against the side of an element, the number of displacements and the processor time, and the time
!> against the first two, all on logarithmic axes, a curve an element type, its last slope in the legend. And the pictures of
!> `atrito limit`: what is watched against the parameter, up to the limit; and the mechanism.
module atrito_study_plot
   use atrito_body_plots, only: write_mechanism_plot
   use atrito_gnuplot, only: draw_written
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: plot_folder, STUDY_PLOT, LIMIT_PLOT, MECHANISM_PLOT
   use atrito_plot_scripts, only: plots_t, begin_plots, end_plots, put, begin_data, begin_script, put_terminal
   use atrito_plot_text, only: range_t, cover, log_axis, quoted, cleaned, LF, COLOUR, N_COLOURS, padded, range_of, range_text, &
                               engineering_exponent, power_text
   use atrito_plot_view, only: plot_view_t
   use atrito_stability_result, only: stability_t
   use atrito_status, only: status_t, STATUS_OK, STATUS_NOT_CONVERGED
   use atrito_strings, only: string_t, to_text
   use atrito_study_errors, only: study_t
   implicit none (type, external)
   private
   public :: write_study_plot, write_stability_plots

   integer, parameter :: LONGEST_TITLE = 90          !< characters
   !> Columns of study.dat; the errors of the quantities follow.
   integer(ip), parameter :: SIDE = 1, DOFS = 2, SECONDS = 3, ESTIMATE = 4
   character(len=*), parameter :: X_LABELS(3) = [character(len=24) :: 'side of an element [L]', 'displacements', &
                                                                                                               'processor time [s]']

   integer, parameter :: MANY_DIGITS = 12            !< of limit.dat: values crowd at the limit

contains

   !> Draws <folder>/plots/study.png and .svg. A failure is a warning, W-PLOT.
   subroutine write_study_plot(folder, title, study, drawn)
      character(len=*), intent(in) :: folder         !< of the study
      character(len=*), intent(in) :: title          !< of the deck, or its name
      type(study_t), intent(in) :: study             !< judged
      type(string_t), allocatable, intent(out) :: drawn(:) !< names of those that have their pictures now
      type(plots_t) :: plots
      type(status_t) :: status
      type(string_t) :: names(1)
      character(len=:), allocatable :: line
      integer(ip) :: j
      integer :: i, k

      call begin_plots(plots, plot_folder(folder))
      ! A block an element.
      call begin_data(plots, STUDY_PLOT, 'a block an element; columns: side of an element [L], dofs, processor seconds, '// &
                      'estimated error [%], errors of the quantities [%]')
      do i = 1, size(study%elements)
         do k = 1, size(study%rows)
            if (study%rows(k)%element /= study%elements(i)%s) cycle
            line = ''
            do j = SIDE, ESTIMATE + size(study%quantities, kind=ip)
               line = line//' '//trimmed_real(column(study, k, j), 6)
            end do
            call put(plots, line(2:))
         end do
         call put(plots, LF)
      end do
      call write_script(plots, title, study)
      call end_plots(plots, status)
      names(1)%s = STUDY_PLOT
      call draw_written(folder, names, status, drawn)
   end subroutine write_study_plot

   !> A row of panels a quantity that has errors, one of the estimate and one of the time.
   subroutine write_script(plots, title, study)
      type(plots_t), intent(inout) :: plots
      character(len=*), intent(in) :: title
      type(study_t), intent(in) :: study
      logical :: has_panel(size(study%quantities))
      integer(ip) :: i, j, rows

      ! a quantity without a reference has no errors to show, one that is held has nothing but rounding
      has_panel = [((any([(has_points(study, study%elements(i)%s, SECONDS, ESTIMATE + j), i=1, size(study%elements))]) &
                     .and. .not. study%quantities(j)%is_held), j=1, size(has_panel))]
      rows = 2 + count(has_panel, kind=ip)
      call begin_script(plots, STUDY_PLOT, 'errors against the mesh and the run time, and run time against the mesh', &
                        'Columns of study.dat: 1 side of an element [L], 2 dofs, 3 processor seconds, 4 estimated error [%], '// &
                        '5 ... errors'//LF//'# of the quantities [%]')
      call put(plots, 'set logscale xy; set format x "%g"; set format y "%g"; set grid lt 1 lw 1 lc rgb "#E0E0E0"'//LF// &
               'set border 3 lt 1 lw 1 lc rgb "#404040"; set tics nomirror out scale 0.6 textcolor rgb "black"'//LF// &
               'unset mxtics; unset mytics'//LF//'set style line 20 lt 1 dt 2 lw 1.2 lc rgb "#808080"')
      call put_terminal(plots, '1000,'//to_text(60 + 300*rows))
      call put(plots, 'set multiplot layout '//to_text(rows)//',3 margins screen 0.1, screen 0.985, screen '// &
               to_text(70.0_wp/(60 + 300*rows), 3)//', screen '//to_text(1 - 70.0_wp/(60 + 300*rows), 3)// &
               ' spacing screen 0.06, screen '//to_text(95.0_wp/(60 + 300*rows), 3)//' title '// &
               quoted(cleaned(title, LONGEST_TITLE)//'   (slopes are those of the last two levels)')//' noenhanced')
      do j = 1, size(study%quantities, kind=ip)
         if (has_panel(j)) call put_row(plots, study, ESTIMATE + j, 'error of '//study%quantities(j)%name//' [%]')
      end do
      call put_row(plots, study, ESTIMATE, 'estimated error, energy norm [%]')
      call put_row(plots, study, SECONDS, trim(X_LABELS(SECONDS)))
      call put(plots, 'unset multiplot')
   end subroutine write_script

   !> Column y against the side, the displacements and the time. A panel in which no number can be drawn is left empty.
   subroutine put_row(plots, study, y, y_label)
      type(plots_t), intent(inout) :: plots
      type(study_t), intent(in) :: study
      integer(ip), intent(in) :: y
      character(len=*), intent(in) :: y_label
      character(len=:), allocatable :: line, slope_text
      type(range_t) :: range(2)
      real(wp) :: room                              ! of the height, for the legend below the points: lines of 18 of 205 pixels
      integer(ip) :: i, x
      integer :: k, m
      real(wp) :: dx

      do x = SIDE, SECONDS
         range = range_t()
         line = ''
         do i = 1, size(study%elements, kind=ip)
            associate (element => study%elements(i)%s)
               if (x == y .or. .not. has_points(study, element, x, y)) cycle
               ! `, slope -0.49` of the last two points, the difference of the logarithms of y over that of x, which is the
               ! exponent where y goes with a power of x; empty where there are none.
               slope_text = ''
               do m = 2, size(study%rows)
                  if (study%rows(m)%element /= element .or. study%rows(m - 1)%element /= element) cycle
                  slope_text = ''
                  if (.not. (is_point(study, m, x, y) .and. is_point(study, m - 1, x, y))) cycle
                  dx = log(column(study, m, x)/column(study, m - 1, x))
                  if (abs(dx) > 0.0_wp) slope_text = ', slope '//to_text(log(column(study, m, y)/column(study, m - 1, y))/dx, 2)
               end do
               line = line//', "study.dat" index '//to_text(i - 1)//' using '//to_text(x)//':'//to_text(y)// &
                      ' with linespoints lt 1 lw 1.8 pt '//to_text(5 + 2*mod(i, 4_ip))//' ps 0.9*dot lc rgb "'//COLOUR(mod(i - 1, &
                                                                            N_COLOURS) + 1)//'" title '//quoted(element//slope_text)
            end associate
         end do
         if (len(line) == 0) then
            call put(plots, 'set multiplot next')
            cycle
         end if
         do k = 1, size(study%rows)
            if (is_point(study, k, x, y)) call cover(range(1), [column(study, k, x)])
            if (is_point(study, k, x, y)) call cover(range(2), [column(study, k, y)])
         end do
         room = min(0.5_wp, (28 + 18*count([(has_points(study, study%elements(k)%s, x, y), k=1, size(study%elements))]))/205.0_wp)
         call cover(range(2), [range(2)%low*min(0.3_wp, (range(2)%low/range(2)%high)**(room/(1 - room)))])
         call put(plots, log_axis('x', range(1), 4_ip)//LF//log_axis('y', range(2), 6_ip)//LF// &
                  'set xlabel "'//trim(X_LABELS(x))//'"; unset label 1'//LF// &
                  'set key '//trim(merge('right', 'left ', x == SIDE .neqv. y == SECONDS))// &
                  ' bottom Left reverse opaque samplen 1.5')
         if (x == SIDE) call put(plots, 'set label 1 '//quoted(y_label)// &
                                 ' at screen 0.02, graph 0.5 center rotate by 90 noenhanced')
         if (y > ESTIMATE .and. range(2)%low < 1.0_wp) line = line//', 1 with lines ls 20 title "1 %"'
         call put(plots, 'plot '//line(3:))
      end do
   end subroutine put_row

   pure logical function has_points(study, element, x, y) result(has)
      type(study_t), intent(in) :: study
      character(len=*), intent(in) :: element
      integer(ip), intent(in) :: x, y
      integer :: k

      has = .false.
      do k = 1, size(study%rows)
         if (study%rows(k)%element == element) has = has .or. is_point(study, k, x, y)
      end do
   end function has_points

   !> Whether both numbers of a row are positive.
   pure logical function is_point(study, k, x, y)
      type(study_t), intent(in) :: study
      integer, intent(in) :: k
      integer(ip), intent(in) :: x, y

      associate (v => [column(study, k, x), column(study, k, y)])
         is_point = .not. any(is_nan(v))
         if (is_point) is_point = all(v > 0.0_wp)
      end associate
   end function is_point

   !> A number of study.dat.
   pure real(wp) function column(study, k, place)
      type(study_t), intent(in) :: study
      integer, intent(in) :: k                      !< row
      integer(ip), intent(in) :: place

      select case (place)
      case (SIDE)
         column = study%rows(k)%h
      case (DOFS)
         column = real(study%rows(k)%n_dofs, wp)
      case (SECONDS)
         column = sum(study%rows(k)%phases%cpu)
      case (ESTIMATE)
         column = study%rows(k)%estimate
      case default
         column = 100*study%quantities(place - ESTIMATE)%error(k)
      end select
   end function column

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
      call write_limit_script(plots, title, limit)
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
   subroutine write_limit_script(plots, title, limit)
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
   end subroutine write_limit_script

end module atrito_study_plot
