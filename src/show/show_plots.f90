!> Pictures of the views: the skylines, the outer iterations and the laws, drawn from the tables of --show; and of the error on the
!> meshes of --adapt.
module atrito_show_plots
   use atrito_gnuplot, only: draw_written
   use atrito_kinds, only: ip, wp
   use atrito_plot_files, only: plot_folder, SHOWN_PLOTS
   use atrito_plot_scripts, only: plots_t, begin_plots, end_plots, put, begin_script, put_table, put_terminal
   use atrito_plot_text, only: range_t, cover, log_axis, LF
   use atrito_status, only: status_t
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_table, only: table_t
   implicit none (type, external)
   private
   public :: draw_shown

   integer(ip), parameter :: MOST_BODIES = 3, MOST_CURVES = 10
   character(len=*), parameter :: LOOKS = 'set border 3 lt 1 lw 1 lc rgb "#404040"; set tics nomirror out scale 0.6'//LF// &
                                  'set grid lt 1 lw 1 lc rgb "#E0E0E0"; set key outside right top noautotitle'

contains

   !> Draws what there is of the views into DIR/plots. A failure is a warning, W-PLOT.
   subroutine draw_shown(folder, tables, drawn)
      character(len=*), intent(in) :: folder        !< of the tables
      type(table_t), intent(in) :: tables(:)        !< of the views; others are passed over
      type(string_t), allocatable, intent(out) :: drawn(:) !< names of those that have their pictures now
      type(plots_t) :: plots
      type(status_t) :: status
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      call begin_plots(plots, plot_folder(folder))
      do i = 1, size(tables)
         if (.not. any(SHOWN_PLOTS == tables(i)%name) .or. tables(i)%n_rows < merge(2, 1, tables(i)%name == 'adapt')) cycle
         call append_string(names, tables(i)%name)
         call write_plot(plots, tables(i))
      end do
      call end_plots(plots, status)
      call draw_written(folder, names, status, drawn)
   end subroutine draw_shown

   !> The script of a table: what it draws, of which columns, the settings before the terminal and its size, and the commands.
   subroutine write_plot(plots, table)
      type(plots_t), intent(inout) :: plots
      type(table_t), intent(in) :: table            !< of SHOWN_PLOTS
      character(len=:), allocatable :: what, columns, settings, room, commands
      type(range_t) :: error
      integer(ip) :: i

      room = '1000,760'
      select case (table%name)
      case ('adapt')                                ! the error against the displacements and against the time
         what = 'the error on the meshes of --adapt, by the displacements and the time'
         columns = '3 dofs, 4 error [%], 6 seconds by the clock'
         settings = 'set logscale xy; set format x "%g"; set format y "%g"; unset mxtics; unset mytics'
         room = '1000,420'
         call cover(error, table%columns(4)%reals)
         commands = 'set multiplot layout 1,2; set ylabel "error [%]"'//LF//log_axis('y', error, 6_ip)//LF// &
                    panel('displacements', [(real(table%columns(3)%integers(i), wp), i=1, table%n_rows)], '3')//LF// &
                    panel('time from the beginning [s]', table%columns(6)%reals, '6')
      case ('show-matrix')                          ! a row of panels a body, columns from their first rows down to the diagonal
         i = min(maxval(table%columns(1)%integers), MOST_BODIES)
         what = 'the skylines of the bodies'
         columns = '1 body, 2 equation, 5 first row as the nodes come, 8 first row renumbered'
         settings = 'set size ratio -1; set xlabel "equation"; set tmargin 3'
         room = '1000,'//to_text(480*i)
         commands = 'set multiplot layout '//to_text(i)//',2 columnsfirst downwards'//LF// &
                    'do for [c in "5 8"] {'//LF//'do for [b=1:'//to_text(i)//'] {'//LF// &
                    'set xrange [*:*]; set yrange [*:*]; stats table using ($1==b ? $2 : 1/0) nooutput'//LF// &
                    'set xrange [0:STATS_max+1]; set yrange [STATS_max+1:0]'//LF// &
                    'set title sprintf("body %d, %s", b, (c eq "5" ? "as the nodes come" : "renumbered, contact last"))'//LF// &
                    'plot table using ($1==b ? $2 : 1/0):(column(int(c))-0.5):(0):($2-column(int(c))+1) with vectors nohead '// &
                    'lw 320.0/STATS_max lc rgb "#0072B2", x with lines lw 1 lc rgb "#D55E00"'//LF//'}'//LF//'}'
      case ('show-picard')                          ! from light to dark
         what = 'pressure and friction bound of the outer iterations, first pair'
         columns = '1 outer iteration, 2 pair, 4 s [L], 7 pressure, 8 bound [F/L^2]'
         settings = 'last = '//to_text(min(maxval(table%columns(1)%integers), MOST_CURVES))//LF// &
                    'set palette defined (0 "#C6DBEF", 0.5 "#4292C6", 1 "#08306B")'//LF// &
                    'unset colorbox; set cbrange [0:last+1]; set xlabel "s [L]"'
         commands = 'set multiplot layout 2,1'//LF//'do for [c in "7 8"] {'//LF// &
                    'set ylabel (c eq "7" ? "pressure [F/L^2]" : "friction bound [F/L^2]")'//LF// &
               'plot for [k=0:last] table using ($1==k && $2==1 ? $4 : 1/0):(column(int(c))):(k) with linespoints palette lw 2 '// &
                    'pt 7 ps 0.5*dot title sprintf("outer %d", k)'//LF//'}'
      case default                                  ! both laws, with the points
         what = 'the laws of friction and of pressure, and the points on them'
         columns = '4 overlap [L], 5 delta [L^3/F], 6 pressure [F/L^2], 9 bound, 10 friction [F/L^2], 11 u'
         settings = 'set samples 1001; stats table using 5 nooutput; delta = STATS_max'//LF// &
                    'stats table using 4 nooutput; deep = STATS_max > 0 ? 1.1*STATS_max : 1'
         commands = 'set multiplot layout 2,1'//LF//'set xlabel "u = slip over the slip at which friction is full"; '// &
                    'set ylabel "t over its bound"; set yrange [-1.2:1.2]; set xrange [-3:3]'//LF// &
                    'plot (abs(x) < 1 ? x : sgn(x)) with lines lw 2 lc rgb "#0072B2" title "law", table using '// &
                    '($9 > 0 ? ($11 > 3 ? 3 : $11 < -3 ? -3 : $11) : 1/0):($10/$9) with points pt 7 ps dot lc rgb "#D55E00" '// &
                    'title "points"'//LF//'set xlabel "overlap [L]"; set ylabel "pressure [F/L^2]"; set yrange [0:*]; '// &
                    'set xrange [-0.2*deep:deep]'//LF// &
                    'plot (x < 0 ? 0 : delta > 0 ? x/delta : 1/0) with lines lw 2 lc rgb "#0072B2" title "law", table using '// &
                    '($4 < -0.2*deep ? -0.2*deep : $4):6 with points pt 7 ps dot lc rgb "#D55E00" title "points"'
      end select
      call begin_script(plots, table%name, what, 'Columns of '//table%name//'.tab: '//columns)
      call put_table(plots, table%name)
      call put(plots, LOOKS//LF//settings)
      call put_terminal(plots, room)
      call put(plots, commands//LF//'unset multiplot')
   end subroutine write_plot

   !> The commands of one panel of the errors.
   function panel(label, values, column) result(commands)
      character(len=*), intent(in) :: label, column
      real(wp), intent(in) :: values(:)
      character(len=:), allocatable :: commands
      type(range_t) :: range

      call cover(range, values)
      commands = 'set xlabel "'//label//'"; '//log_axis('x', range, 5_ip)//LF//'plot table using '//column// &
                 ':4 with linespoints lw 1.8 pt 7 ps 0.9*dot lc rgb "#0072B2"'
   end function panel

end module atrito_show_plots
