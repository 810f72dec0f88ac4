!> The pictures of a history: what the pairs transmit over time, and the loop of the shear resultant over the mean slip.
!>
!> The first script reads history.tab in the folder above; the second one has loop.dat, for the mean slip is in no table.
module atrito_history_plot
   use atrito_contact_plot, only: pair_title, pair_legend
   use atrito_increments, only: has_history
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t, FRICTION_LOCAL, FRICTION_NONE
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: HISTORY_PLOT, LOOP_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_data, begin_script, put_table, put_terminal, put_frame, put_panel
   use atrito_plot_text, only: range_t, cover, padded, span, range_of, quoted, picture_title, engineering_exponent, power_text, &
                               colour_styles, LF, N_COLOURS, GREEK_NU, PLUS_MINUS
   use atrito_results, only: history_t, history_row_t, results_t, last_frame
   use atrito_strings, only: to_text
   use atrito_summary, only: pair_name
   use atrito_write_tables, only: origin_of
   implicit none (type, external)
   private
   public :: has_history_plot, has_loop_plot, write_history_plot, write_loop_plot, shown_pairs, step_ends, end_labels

   integer(ip), parameter :: MOST_PAIRS = N_COLOURS     !< curves in a picture
   integer(ip), parameter :: MOST_MARKED = 60       !< increments of a curve with a marker at each
   integer(ip), parameter :: MOST_STEPS = 60        !< steps that are separated by lines
   !> A step at least so long, as a share of the time, has its number, and where all have this, the word before it.
   real(wp), parameter :: LEAST_NUMBERED = 0.02_wp, LEAST_WORDED = 0.07_wp
   !> The bound of the shear is drawn up to so many times the largest shear; a greater one would hide it.
   real(wp), parameter :: MOST_BOUND = 4.0_wp
   !> Ends of steps nearer than this, as a share of the picture, have one label.
   real(wp), parameter :: SAME_PLACE = 0.03_wp
   real(wp), parameter :: ROUNDING = 1.0e-10_wp     !< share of the displacements that is no slip, of the largest shear that is none
   integer, parameter :: DIGITS = 9                 !< of loop.dat
   integer, parameter :: LABEL_LENGTH = 40
   integer(ip), parameter :: COLUMN_NORMAL = 5, COLUMN_SHEAR = 6, COLUMN_LENGTH = 8, COLUMN_PRESSURE = 10, &
                             COLUMN_DISSIPATION = 14   !< of history.tab

contains

   !> Whether there are at least two increments with contact to draw a curve through.
   pure logical function has_history_plot(model, history) result(has)
      type(model_t), intent(in) :: model            !< its steps are read
      type(history_t), intent(in) :: history        !< its rows are read

      has = .false.
      if (size(history%rows) < 2 .or. .not. has_history(model, history)) return
      has = size(history%rows, kind=ip) > maxval(history%rows%pair)
   end function has_history_plot

   !> A loop needs shear, and slip that is more than rounding beside the displacements.
   pure logical function has_loop_plot(model, history) result(has)
      type(model_t), intent(in) :: model            !< laws of its pairs
      type(history_t), intent(in) :: history        !< rows, and displacements of the last frame
      real(wp) :: largest

      has = has_history_plot(model, history)
      if (.not. has) return
      largest = 0.0_wp
      associate (last => history%frames(last_frame(history)))
         if (allocated(last%u)) largest = maxval(abs(last%u))
      end associate
      has = has_friction(model, history%rows) .and. span(range_of(history%rows%mean_slip)) > ROUNDING*largest .and. &
            span(range_of(history%rows%shear)) > 0.0_wp
   end function has_loop_plot

   pure logical function has_friction(model, rows)
      type(model_t), intent(in) :: model
      type(history_row_t), intent(in) :: rows(:)

      associate (pairs => model%pairs(:maxval(rows%pair)))
         has_friction = any(model%interactions(pairs%interaction)%friction /= FRICTION_NONE)
      end associate
   end function has_friction

   !> The pairs that are drawn, by number: where they are too many those with the largest forces, or those that slip most.
   pure function shown_pairs(rows, by_slip) result(list)
      type(history_row_t), intent(in) :: rows(:)    !< of all increments and pairs
      logical, intent(in) :: by_slip                !< else by their forces
      integer(ip), allocatable :: list(:)
      real(wp) :: largest(maxval(rows%pair)), here, least
      logical :: is_in(size(largest))
      integer(ip) :: i

      largest = 0.0_wp
      least = ROUNDING*maxval(abs(rows%shear))
      do i = 1, size(rows, kind=ip)
         here = max(abs(rows(i)%normal), abs(rows(i)%shear))
         if (by_slip) here = merge(abs(rows(i)%mean_slip), 0.0_wp, abs(rows(i)%shear) > least)   ! open joints slip, too
         largest(rows(i)%pair) = max(largest(rows(i)%pair), here)
      end do
      is_in = .false.
      do i = 1, min(MOST_PAIRS, size(largest))
         is_in(maxloc(largest, dim=1, mask=.not. is_in)) = .true.
      end do
      list = pack([(i, i=1, size(largest, kind=ip))], is_in)
   end function shown_pairs

   !> The rows of the pairs that are drawn.
   pure function shown_rows(rows, by_slip) result(list)
      type(history_row_t), intent(in) :: rows(:)
      logical, intent(in) :: by_slip
      type(history_row_t), allocatable :: list(:)
      integer(ip), allocatable :: pairs(:)
      integer :: i

      pairs = shown_pairs(rows, by_slip)
      list = pack(rows, [(any(pairs == rows(i)%pair), i=1, size(rows))])
   end function shown_rows

   !> Places of the rows that end a step, of the last pair.
   pure function step_ends(rows) result(places)
      type(history_row_t), intent(in) :: rows(:)    !< of all increments and pairs, ascending in time
      integer(ip), allocatable :: places(:)
      integer(ip) :: i, n

      n = size(rows, kind=ip)
      places = [pack([(i, i=1, n - 1)], rows(:n - 1)%step /= rows(2:)%step), n]
   end function step_ends

   !> Writes history.gp.
   subroutine write_history_plot(plots, model, history)
      type(plots_t), intent(inout) :: plots         !< get the script
      type(model_t), intent(in) :: model            !< laws of its pairs, and its steps
      type(history_t), intent(in) :: history        !< with rows
      type(history_row_t), allocatable :: shown(:)
      character(len=:), allocatable :: bounds, nu
      type(range_t) :: range
      real(wp) :: bound
      integer(ip) :: i
      logical :: friction, many

      friction = has_friction(model, history%rows)
      many = maxval(history%rows%pair) > 1
      shown = shown_rows(history%rows, by_slip=.false.)
      call begin_script(plots, HISTORY_PLOT, 'what the contact pairs transmit, over time', &
                        'Columns of history.tab: 3 time, 4 pair, 5 normal resultant [F], 6 shear resultant [F], 8 contact '// &
                        'length [L],'//LF//'# 10 largest pressure [F/L^2], 14 dissipation [F L]; a row an increment and pair')
      call put_table(plots, 'history')
      call put_titles(plots, model, history, 'with the largest forces')
      call put_frame(plots, merge(4_ip, 3_ip, friction), range_of([0.0_wp, history%rows%time]), '"time"')
      call put(plots, 'height = 145 + 230*panels; top(i) = 1 - (85.0 + (i - 1)*230)/height   # room for the steps'//LF// &
               'right = '//right_edge(history, shown_pairs(history%rows, by_slip=.false.), many, &
                                      shows_bound(model, history%rows)))
      call put_terminal(plots, '1000,height')
      call put_styles(plots, history%rows)
      call put(plots, 'set multiplot title heading."\n".pair_line noenhanced')
      call put_steps(plots, history%rows)
      call put_panel(plots, 1_ip, 'normal resultant', 'F', range_of([0.0_wp, shown%normal]))
      call put_curves(plots, COLUMN_NORMAL, history%rows, '', last=history%frames(last_frame(history)))
      do i = 1, min(MOST_STEPS, size(step_ends(history%rows), kind=ip))
         call put(plots, 'unset label '//to_text(i + 10_ip))
      end do
      if (friction) then
         range = range_of([0.0_wp, shown%shear])
         bounds = ''
         if (shows_bound(model, history%rows)) then
            associate (law => model%interactions(model%pairs(1)%interaction))
               bound = law%nu*maxval(shown%normal)
               nu = to_text(law%nu, 12)
            end associate
            call cover(range, [-bound, bound])
            bounds = ', table using 3:('//nu//'*$5/unit) with lines ls 8 title "'//PLUS_MINUS//' '//GREEK_NU//' N"'// &
                     ', table using 3:(-'//nu//'*$5/unit) with lines ls 8'
         end if
         call put_panel(plots, 2_ip, 'shear resultant', 'F', range)
         call put_curves(plots, COLUMN_SHEAR, history%rows, bounds)
      else
         call put_panel(plots, 2_ip, 'largest pressure', 'F/L^2', range_of([0.0_wp, shown%max_pressure]))
         call put_curves(plots, COLUMN_PRESSURE, history%rows, '')
      end if
      call put_panel(plots, 3_ip, 'contact length', 'L', range_of([0.0_wp, shown%length]))
      call put_curves(plots, COLUMN_LENGTH, history%rows, '')
      if (friction) then
         call put_panel(plots, 4_ip, 'dissipation', 'F L', range_of([0.0_wp, shown%dissipation]))
         call put_curves(plots, COLUMN_DISSIPATION, history%rows, '')
      end if
      call put(plots, 'unset multiplot')
   end subroutine write_history_plot

   subroutine put_titles(plots, model, history, which)
      type(plots_t), intent(inout) :: plots
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      character(len=*), intent(in) :: which         !< pairs are drawn of many
      character(len=:), allocatable :: text
      integer(ip) :: n

      n = maxval(history%rows%pair)
      text = pair_title(history%frames(last_frame(history)), 1_ip)
      if (n > 1) text = to_text(n)//' pairs'
      if (n > MOST_PAIRS) text = 'the '//to_text(MOST_PAIRS)//' of '//text//' '//which
      call put(plots, 'heading = '//quoted(picture_title(origin_of(model, history)))//LF//'pair_line = '//quoted(text))
   end subroutine put_titles

   !> A colour a pair; markers where there are few increments.
   subroutine put_styles(plots, rows)
      type(plots_t), intent(inout) :: plots
      type(history_row_t), intent(in) :: rows(:)
      character(len=:), allocatable :: points

      points = '0'
      if (size(rows) <= MOST_MARKED*maxval(rows%pair)) points = '0.6*dot'
      call put(plots, colour_styles(' lw 2 pt 7 ps '//points)//LF//'set style line 8 lw 1.5 dt (7,5) lc rgb "#404040"')
   end subroutine put_styles

   !> Thin lines between the steps, in all panels, and their numbers above the first one.
   subroutine put_steps(plots, rows)
      type(plots_t), intent(inout) :: plots
      type(history_row_t), intent(in) :: rows(:)
      integer(ip), allocatable :: ends(:)
      real(wp) :: begins(size(step_ends(rows))), share(size(begins))
      character(len=:), allocatable :: word
      integer(ip) :: i, n

      ends = step_ends(rows)
      n = size(ends, kind=ip)
      if (n < 2 .or. n > MOST_STEPS) return
      begins = [0.0_wp, rows(ends(:n - 1))%time]
      share = (rows(ends)%time - begins)/rows(size(rows))%time
      word = ''
      if (all(share >= LEAST_WORDED)) word = 'step '
      do i = 1, n
         if (i < n) call put(plots, 'set arrow from '//to_text(rows(ends(i))%time, 12)//', graph 0 to '// &
                             to_text(rows(ends(i))%time, 12)//', graph 1 nohead back lt 1 lw 1 lc rgb "#A0A0A0"')
         if (share(i) < LEAST_NUMBERED) cycle
         call put(plots, 'set label '//to_text(i + 10_ip)//' "'//word//to_text(rows(ends(i))%step)//'" at '// &
                  to_text(0.5_wp*(begins(i) + rows(ends(i))%time), 12)//', graph 1.07 center textcolor rgb "#606060"')
      end do
   end subroutine put_steps

   !> One pair with Coulomb's friction, whose bound does not hide its shear.
   pure logical function shows_bound(model, rows)
      type(model_t), intent(in) :: model
      type(history_row_t), intent(in) :: rows(:)

      shows_bound = maxval(rows%pair) == 1
      if (.not. shows_bound) return
      associate (law => model%interactions(model%pairs(1)%interaction))
         shows_bound = law%friction == FRICTION_LOCAL .and. law%nu*maxval(rows%normal) <= MOST_BOUND*maxval(abs(rows%shear))
      end associate
   end function shows_bound

   !> A curve a pair; the rows of the pairs alternate.
   subroutine put_curves(plots, column, rows, more, last)
      type(plots_t), intent(inout) :: plots
      integer(ip), intent(in) :: column             !< of history.tab
      type(history_row_t), intent(in) :: rows(:)
      character(len=*), intent(in) :: more          !< further curves, each behind a comma
      type(results_t), intent(in), optional :: last !< with the names of several pairs, for a legend
      integer(ip), allocatable :: pairs(:)
      character(len=:), allocatable :: line
      integer(ip) :: i

      pairs = shown_pairs(rows, by_slip=.false.)
      line = ''
      do i = 1, size(pairs, kind=ip)
         line = line//', table every '//to_text(maxval(rows%pair))//'::'//to_text(pairs(i) - 1_ip)//' using 3:(column('// &
                to_text(column)//')/unit) with linespoints ls '//to_text(i)
         if (present(last) .and. maxval(rows%pair) > 1) line = line//legend_of(last, pairs(i))
      end do
      call put(plots, 'plot '//line(3:)//more)
   end subroutine put_curves

   pure function legend_of(results, pair) result(text)
      type(results_t), intent(in) :: results
      integer(ip), intent(in) :: pair
      character(len=:), allocatable :: text

      text = ' title '//quoted(pair_legend(pair, pair_name(results, pair)))//' noenhanced'
   end function legend_of

   !> Where the panels end, as a share of the width: what is left has room for the legend.
   pure function right_edge(history, pairs, has_names, has_bound) result(text)
      type(history_t), intent(in) :: history
      integer(ip), intent(in) :: pairs(:)           !< that are drawn
      logical, intent(in) :: has_names, has_bound   !< the legend has their names, or the bound of the shear alone
      character(len=:), allocatable :: text
      real(wp) :: right
      integer :: i

      right = merge(0.80_wp, 0.95_wp, has_names .or. has_bound)
      if (has_names) then
         associate (last => history%frames(last_frame(history)))
            do i = 1, size(pairs)
               right = min(right, 0.93_wp - 0.0105_wp*len(pair_legend(pairs(i), pair_name(last, pairs(i)))))
            end do
         end associate
      end if
      text = to_text(right, 3)
   end function right_edge

   !> Writes loop.dat, with a block a pair that is drawn, and loop.gp.
   subroutine write_loop_plot(plots, model, history)
      type(plots_t), intent(inout) :: plots         !< get data and script
      type(model_t), intent(in) :: model            !< laws of its pairs
      type(history_t), intent(in) :: history        !< with rows
      type(history_row_t), allocatable :: rows(:)
      type(range_t) :: slip, wide
      integer(ip), allocatable :: pairs(:)
      character(len=:), allocatable :: line
      integer(ip) :: i, power
      logical :: is_one

      pairs = shown_pairs(history%rows, by_slip=.true.)
      is_one = maxval(history%rows%pair) == 1
      call put_loops(plots, history%rows, pairs)
      rows = shown_rows(history%rows, by_slip=.true.)
      slip = range_of(rows%mean_slip)
      power = engineering_exponent(slip)
      wide = padded(slip)
      call begin_script(plots, LOOP_PLOT, 'the shear resultant, which is against the slip, over the mean slip', &
                        'Columns of loop.dat: 1 mean slip of all points [L], 2 shear resultant [F], 3 step, 4 increment, '// &
                        '5 time; a block a pair')
      call put_titles(plots, model, history, 'that slip most')
      call put_frame(plots, 1_ip, range_t(wide%low/10.0_wp**power, wide%high/10.0_wp**power), '""')
      call put(plots, 'height = 620; bottom(i) = 70.0/height'//LF//'right = '// &
               right_edge(history, pairs, size(pairs) > 1, .false.)//LF// &
               'slip_unit = 1e'//to_text(power))
      call put_terminal(plots, '1000,height')
      call put_styles(plots, history%rows)
      call put(plots, 'set multiplot title heading."\n".pair_line noenhanced')
      call put_panel(plots, 1_ip, '- shear resultant', 'F', range_of([0.0_wp, -rows%shear]))
      call put(plots, 'set yzeroaxis lt 1 lw 1 lc rgb "#808080"'//LF//'set xlabel "mean slip ['//power_text(power)//'L]" enhanced')
      if (is_one) call put_ends(plots, history%rows)
      line = ''
      do i = 1, size(pairs, kind=ip)
         line = line//', "'//LOOP_PLOT//'.dat" index '//to_text(i - 1_ip)//' using ($1/slip_unit):(-$2/unit)'// &
                ' with linespoints ls '//to_text(i)
         if (size(pairs) > 1) line = line//legend_of(history%frames(last_frame(history)), pairs(i))
      end do
      call put(plots, 'plot '//line(3:)//LF//'unset multiplot')
   end subroutine write_loop_plot

   subroutine put_loops(plots, rows, pairs)
      type(plots_t), intent(inout) :: plots
      type(history_row_t), intent(in) :: rows(:)
      integer(ip), intent(in) :: pairs(:)
      integer(ip) :: i, j

      call begin_data(plots, LOOP_PLOT, 'a block a pair; columns: mean slip of all points [L]  shear resultant [F]  step  '// &
                      'increment  time')
      do i = 1, size(pairs, kind=ip)
         call put(plots, '# pair '//to_text(pairs(i)))
         do j = 1, size(rows, kind=ip)
            if (rows(j)%pair /= pairs(i)) cycle
            call put(plots, trimmed_real(rows(j)%mean_slip, DIGITS)//' '//trimmed_real(rows(j)%shear, DIGITS)//' '// &
                     to_text(rows(j)%step)//' '//to_text(rows(j)%increment)//' '//trimmed_real(rows(j)%time, DIGITS))
         end do
         call put(plots, LF)
      end do
   end subroutine put_loops

   !> Marks the ends of the steps.
   subroutine put_ends(plots, rows)
      type(plots_t), intent(inout) :: plots
      type(history_row_t), intent(in) :: rows(:)    !< of one pair
      integer(ip), allocatable :: ends(:)
      character(len=LABEL_LENGTH), allocatable :: labels(:)
      character(len=:), allocatable :: side
      type(range_t) :: slip
      integer(ip) :: i

      ends = step_ends(rows)
      labels = end_labels(rows, ends)
      slip = range_of(rows%mean_slip)
      do i = 1, size(ends, kind=ip)
         if (len_trim(labels(i)) == 0) cycle
         associate (row => rows(ends(i)))
            side = ' left offset 0.8,-0.8'
            if (row%mean_slip > slip%low + 0.7_wp*span(slip)) side = ' right offset -0.8,0.8'
            call put(plots, 'set label '//to_text(i + 10_ip)//' "'//trim(labels(i))//'" at '//to_text(row%mean_slip, 9)// &
                     '/slip_unit, '//to_text(-row%shear, 9)//'/unit'//side//' point pt 7 ps 1.3*dot lc rgb "black" front')
         end associate
      end do
   end subroutine put_ends

   !> `step 1`, and `steps 2, 4` at the first of several ends that lie at one place; '' at the others of them.
   pure function end_labels(rows, ends) result(labels)
      type(history_row_t), intent(in) :: rows(:)    !< of all increments and pairs
      integer(ip), intent(in) :: ends(:)            !< places of rows that end a step
      character(len=LABEL_LENGTH) :: labels(size(ends))
      character(len=:), allocatable :: numbers
      real(wp) :: size_of(2)                        ! of the picture [L], [F]
      integer :: i, j

      size_of = [span(range_of(rows%mean_slip)), span(range_of([0.0_wp, rows%shear]))]
      labels = '?'
      do i = 1, size(ends)
         if (labels(i) == '') cycle
         numbers = to_text(rows(ends(i))%step)
         do j = i + 1, size(ends)
            associate (a => rows(ends(i)), b => rows(ends(j)))
               if (abs(a%mean_slip - b%mean_slip) > SAME_PLACE*size_of(1) .or. abs(a%shear - b%shear) > SAME_PLACE*size_of(2)) cycle
            end associate
            numbers = numbers//', '//to_text(rows(ends(j))%step)
            labels(j) = ''
         end do
         labels(i) = 'step '//numbers
         if (index(numbers, ',') > 0) labels(i) = 'steps '//numbers
         if (len(numbers) > LABEL_LENGTH - 6) labels(i) (LABEL_LENGTH - 1:) = '..'
      end do
   end function end_labels

end module atrito_history_plot
