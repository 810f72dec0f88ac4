!> The pictures of a history: what the pairs transmit over time, and the loop of the shear resultant over the mean slip.
!>
!> The first script reads history.tab in the folder above; the second one has loop.dat, for the mean slip is in no table.
module atrito_history_plot
   use atrito_files, only: file_set_t, text_file_t, put_line, close_text
   use atrito_increments, only: has_history
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t, FRICTION_LOCAL, FRICTION_NONE
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: open_data, HISTORY_PLOT, LOOP_PLOT
   use atrito_plot_text, only: range_t, cover, padded, span, quoted, picture_title, put_table, begin_script, end_script, &
                               put_terminal, put_frame, put_panel, engineering_exponent, COLOUR, N_COLOURS, GREEK_NU, PLUS_MINUS
   use atrito_results, only: history_t, history_row_t, last_frame
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: to_text
   use atrito_write_tables, only: origin_of
   use atrito_contact_plot, only: pair_title
   implicit none (type, external)
   private
   public :: has_history_plot, has_loop_plot, write_history_plot, write_loop_plot, shown_pairs, step_ends, end_labels

   integer, parameter :: MOST_PAIRS = N_COLOURS     !< curves in a picture
   integer(ip), parameter :: MOST_MARKED = 60       !< increments of a curve with a marker at each
   integer(ip), parameter :: MOST_STEPS = 60        !< steps that are told apart by lines
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
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history

      has = .false.
      if (.not. allocated(history%rows)) return
      if (size(history%rows) < 2 .or. .not. has_history(model, history)) return
      has = size(history%rows, kind=ip) > pairs_in(history%rows)
   end function has_history_plot

   !> A loop needs shear, and slip that is more than rounding beside the displacements.
   pure logical function has_loop_plot(model, history) result(has)
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
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

   pure integer(ip) function pairs_in(rows)
      type(history_row_t), intent(in) :: rows(:)

      pairs_in = maxval(rows%pair)
   end function pairs_in

   pure logical function has_friction(model, rows)
      type(model_t), intent(in) :: model
      type(history_row_t), intent(in) :: rows(:)
      integer(ip) :: i

      has_friction = .false.
      do i = 1, pairs_in(rows)
         if (model%interactions(model%pairs(i)%interaction)%friction /= FRICTION_NONE) has_friction = .true.
      end do
   end function has_friction

   !> The pairs that are drawn, by number: where they are too many those with the largest forces, or those that slip most.
   pure function shown_pairs(rows, by_slip) result(list)
      type(history_row_t), intent(in) :: rows(:)
      logical, intent(in) :: by_slip
      integer(ip), allocatable :: list(:)
      real(wp) :: largest(pairs_in(rows)), here, least
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
      type(history_row_t), intent(in) :: rows(:)
      integer(ip), allocatable :: places(:)
      logical :: is_end(size(rows))
      integer(ip) :: i

      is_end = .true.
      do i = 1, size(rows, kind=ip) - 1
         is_end(i) = rows(i)%step /= rows(i + 1)%step
      end do
      places = pack([(i, i=1, size(rows, kind=ip))], is_end)
   end function step_ends

   !> Writes history.gp into the set of the plots' folder. status: STATUS_FILE.
   subroutine write_history_plot(set, model, history, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history        !< with rows
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(range_t) :: time
      logical :: friction, has_legend

      friction = has_friction(model, history%rows)
      call cover(time, [0.0_wp, history%rows%time])
      call begin_script(set, HISTORY_PLOT, 'what the contact pairs transmit, over time', file)
      call put_line(file, '# Columns of history.tab: 3 time, 4 pair, 5 normal resultant [F], 6 shear resultant [F], 8 contact '// &
                    'length [L],')
      call put_line(file, '# 10 largest pressure [F/L^2], 14 dissipation [F L]; a row an increment and pair')
      call put_table(set, 'history', file)
      call put_titles(file, model, history, 'with the largest forces')
      call put_frame(file, merge(4, 3, friction), time, '"time"')
      has_legend = pairs_in(history%rows) > 1 .or. shows_bound(model, history%rows)
      call put_line(file, 'height = 145 + 230*panels; top(i) = 1 - (85.0 + (i - 1)*230)/height   # room for the steps')
      call put_line(file, 'right = '//merge('0.85', '0.95', has_legend))
      call put_terminal(file, HISTORY_PLOT, '1000,height')
      call put_styles(file, history%rows)
      call put_line(file, 'set multiplot title heading."\n".pair_line noenhanced')
      call put_steps(file, history%rows)
      call put_panels(file, model, history%rows, friction)
      call put_line(file, 'unset multiplot')
      call end_script(file, status)
   end subroutine write_history_plot

   subroutine put_titles(file, model, history, which)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      character(len=*), intent(in) :: which         !< pairs are drawn of many
      character(len=:), allocatable :: text
      integer(ip) :: n

      n = pairs_in(history%rows)
      text = pair_title(history%frames(last_frame(history)), 1_ip)
      if (n > 1) text = to_text(n)//' pairs'
      if (n > MOST_PAIRS) text = 'the '//to_text(int(MOST_PAIRS, ip))//' of '//text//' '//which
      call put_line(file, 'heading = '//quoted(picture_title(origin_of(model, history))))
      call put_line(file, 'pair_line = '//quoted(text))
   end subroutine put_titles

   !> A colour a pair; markers where there are few increments.
   subroutine put_styles(file, rows)
      type(text_file_t), intent(inout) :: file
      type(history_row_t), intent(in) :: rows(:)
      character(len=:), allocatable :: points
      integer(ip) :: i

      points = ' ps 0'
      if (size(rows) <= MOST_MARKED*pairs_in(rows)) points = ' ps 0.6*dot'
      do i = 1, N_COLOURS
         call put_line(file, 'set style line '//to_text(i)//' lt 1 lw 2 pt 7'//points//' lc rgb "'//COLOUR(i)//'"')
      end do
      call put_line(file, 'set style line 8 lw 1.5 dt (7,5) lc rgb "#404040"')
   end subroutine put_styles

   !> Thin lines between the steps, in all panels, and their numbers above the first one.
   subroutine put_steps(file, rows)
      type(text_file_t), intent(inout) :: file
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
         if (i < n) call put_line(file, 'set arrow from '//to_text(rows(ends(i))%time, 12)//', graph 0 to '// &
                                  to_text(rows(ends(i))%time, 12)//', graph 1 nohead back lt 1 lw 1 lc rgb "#A0A0A0"')
         if (share(i) < LEAST_NUMBERED) cycle
         call put_line(file, 'set label '//to_text(i + 10_ip)//' "'//word//to_text(rows(ends(i))%step)//'" at '// &
                       to_text(0.5_wp*(begins(i) + rows(ends(i))%time), 12)//', graph 1.07 center textcolor rgb "#606060"')
      end do
   end subroutine put_steps

   subroutine put_panels(file, model, rows, friction)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(history_row_t), intent(in) :: rows(:)
      logical, intent(in) :: friction
      type(history_row_t), allocatable :: shown(:)
      integer(ip) :: i

      shown = shown_rows(rows, by_slip=.false.)
      call put_panel(file, 1, 'normal resultant', 'F', range_of([0.0_wp, shown%normal]))
      call put_curves(file, COLUMN_NORMAL, rows, '', with_legend=pairs_in(rows) > 1)
      do i = 1, min(MOST_STEPS, size(step_ends(rows), kind=ip))
         call put_line(file, 'unset label '//to_text(i + 10_ip))
      end do
      if (friction) then
         call put_panel(file, 2, 'shear resultant', 'F', shear_range(model, shown))
         call put_curves(file, COLUMN_SHEAR, rows, bound_curves(model, rows), with_legend=.false.)
         call put_panel(file, 3, 'contact length', 'L', range_of([0.0_wp, shown%length]))
         call put_curves(file, COLUMN_LENGTH, rows, '', with_legend=.false.)
         call put_panel(file, 4, 'dissipation', 'F L', range_of([0.0_wp, shown%dissipation]))
         call put_curves(file, COLUMN_DISSIPATION, rows, '', with_legend=.false.)
      else
         call put_panel(file, 2, 'largest pressure', 'F/L^2', range_of([0.0_wp, shown%max_pressure]))
         call put_curves(file, COLUMN_PRESSURE, rows, '', with_legend=.false.)
         call put_panel(file, 3, 'contact length', 'L', range_of([0.0_wp, shown%length]))
         call put_curves(file, COLUMN_LENGTH, rows, '', with_legend=.false.)
      end if
   end subroutine put_panels

   pure type(range_t) function range_of(values)
      real(wp), intent(in) :: values(:)

      call cover(range_of, values)
   end function range_of

   !> One pair with Coulomb's friction, whose bound does not hide its shear.
   pure logical function shows_bound(model, rows)
      type(model_t), intent(in) :: model
      type(history_row_t), intent(in) :: rows(:)

      shows_bound = pairs_in(rows) == 1
      if (.not. shows_bound) return
      associate (law => model%interactions(model%pairs(1)%interaction))
         shows_bound = law%friction == FRICTION_LOCAL .and. law%nu*maxval(rows%normal) <= MOST_BOUND*maxval(abs(rows%shear))
      end associate
   end function shows_bound

   pure type(range_t) function shear_range(model, rows) result(range)
      type(model_t), intent(in) :: model
      type(history_row_t), intent(in) :: rows(:)
      real(wp) :: bound

      range = range_of([0.0_wp, rows%shear])
      if (.not. shows_bound(model, rows)) return
      bound = model%interactions(model%pairs(1)%interaction)%nu*maxval(rows%normal)
      call cover(range, [-bound, bound])
   end function shear_range

   pure function bound_curves(model, rows) result(text)
      type(model_t), intent(in) :: model
      type(history_row_t), intent(in) :: rows(:)
      character(len=:), allocatable :: text, nu

      text = ''
      if (.not. shows_bound(model, rows)) return
      nu = to_text(model%interactions(model%pairs(1)%interaction)%nu, 12)
      text = ', table using 3:('//nu//'*$5/unit) with lines ls 8 title "'//PLUS_MINUS//' '//GREEK_NU//' N"'// &
             ', table using 3:(-'//nu//'*$5/unit) with lines ls 8'
   end function bound_curves

   !> A curve a pair; the rows of the pairs alternate.
   subroutine put_curves(file, column, rows, more, with_legend)
      type(text_file_t), intent(inout) :: file
      integer(ip), intent(in) :: column             !< of history.tab
      type(history_row_t), intent(in) :: rows(:)
      character(len=*), intent(in) :: more          !< further curves, each behind a comma
      logical, intent(in) :: with_legend
      integer(ip), allocatable :: pairs(:)
      character(len=:), allocatable :: line
      integer(ip) :: i

      pairs = shown_pairs(rows, by_slip=.false.)
      line = 'plot '
      do i = 1, size(pairs, kind=ip)
         if (i > 1) line = line//', '
         line = line//'table every '//to_text(pairs_in(rows))//'::'//to_text(pairs(i) - 1_ip)//' using 3:(column('// &
                to_text(column)//')/unit) with linespoints ls '//to_text(i)
         if (with_legend) line = line//' title "pair '//to_text(pairs(i))//'"'
      end do
      call put_line(file, line//more)
   end subroutine put_curves

   !> Writes loop.dat and loop.gp into the set of the plots' folder. status: STATUS_FILE.
   subroutine write_loop_plot(set, model, history, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history        !< with rows
      type(status_t), intent(out) :: status

      call write_loop_data(set, history%rows, status)
      if (is_ok(status)) call write_loop_script(set, model, history, status)
   end subroutine write_loop_plot

   !> A block a pair that is drawn.
   subroutine write_loop_data(set, rows, status)
      type(file_set_t), intent(inout) :: set
      type(history_row_t), intent(in) :: rows(:)
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      integer(ip), allocatable :: pairs(:)
      integer(ip) :: i, j

      pairs = shown_pairs(rows, by_slip=.true.)
      call open_data(set, LOOP_PLOT, file)
      call put_line(file, '# a block a pair; columns: mean slip of all points [L]  shear resultant [F]  step  increment  time')
      do i = 1, size(pairs, kind=ip)
         call put_line(file, '# pair '//to_text(pairs(i)))
         do j = 1, size(rows, kind=ip)
            if (rows(j)%pair /= pairs(i)) cycle
            call put_line(file, trimmed_real(rows(j)%mean_slip, DIGITS)//' '//trimmed_real(rows(j)%shear, DIGITS)//' '// &
                          to_text(rows(j)%step)//' '//to_text(rows(j)%increment)//' '//trimmed_real(rows(j)%time, DIGITS))
         end do
         call put_line(file, '')
         call put_line(file, '')
      end do
      call close_text(file, status)
   end subroutine write_loop_data

   subroutine write_loop_script(set, model, history, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(history_row_t), allocatable :: rows(:)
      type(range_t) :: slip, shear
      integer :: power

      rows = shown_rows(history%rows, by_slip=.true.)
      slip = range_of(rows%mean_slip)
      shear = range_of([0.0_wp, -rows%shear])
      power = engineering_exponent(slip)
      call begin_script(set, LOOP_PLOT, 'the shear resultant, which is against the slip, over the mean slip', file)
      call put_line(file, '# Columns of loop.dat: 1 mean slip of all points [L], 2 shear resultant [F], 3 step, 4 increment, '// &
                    '5 time; a block a pair')
      call put_titles(file, model, history, 'that slip most')
      slip = padded(slip)
      call put_frame(file, 1, range_t(slip%low/10.0_wp**power, slip%high/10.0_wp**power), '""')
      call put_line(file, 'height = 620; bottom(i) = 70.0/height')
      call put_line(file, 'right = '//merge('0.95', '0.85', pairs_in(history%rows) == 1))
      call put_line(file, 'slip_unit = 1e'//to_text(int(power, ip)))
      call put_terminal(file, LOOP_PLOT, '1000,height')
      call put_styles(file, history%rows)
      call put_line(file, 'set multiplot title heading."\n".pair_line noenhanced')
      call put_panel(file, 1, '- shear resultant', 'F', shear)
      call put_line(file, 'set yzeroaxis lt 1 lw 1 lc rgb "#808080"')
      call put_line(file, 'set xlabel "mean slip ['//power_text(power)//'L]" enhanced')
      if (pairs_in(history%rows) == 1) call put_ends(file, history%rows)
      call put_loops(file, history%rows)
      call put_line(file, 'unset multiplot')
      call end_script(file, status)
   end subroutine write_loop_script

   pure function power_text(power) result(text)
      integer, intent(in) :: power
      character(len=:), allocatable :: text

      text = ''
      if (power /= 0) text = '10^{'//to_text(int(power, ip))//'} '
   end function power_text

   subroutine put_loops(file, rows)
      type(text_file_t), intent(inout) :: file
      type(history_row_t), intent(in) :: rows(:)
      integer(ip), allocatable :: pairs(:)
      character(len=:), allocatable :: line
      integer(ip) :: i

      pairs = shown_pairs(rows, by_slip=.true.)
      line = 'plot '
      do i = 1, size(pairs, kind=ip)
         if (i > 1) line = line//', '
         line = line//'"'//LOOP_PLOT//'.dat" index '//to_text(i - 1_ip)//' using ($1/slip_unit):(-$2/unit) with linespoints ls '// &
                to_text(i)
         if (size(pairs) > 1) line = line//' title "pair '//to_text(pairs(i))//'"'
      end do
      call put_line(file, line)
   end subroutine put_loops

   !> Marks the ends of the steps.
   subroutine put_ends(file, rows)
      type(text_file_t), intent(inout) :: file
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
            call put_line(file, 'set label '//to_text(i + 10_ip)//' "'//trim(labels(i))//'" at '//to_text(row%mean_slip, 9)// &
                          '/slip_unit, '//to_text(-row%shear, 9)//'/unit'//side//' point pt 7 ps 1.3*dot lc rgb "black" front')
         end associate
      end do
   end subroutine put_ends

   !> `step 1`, and `steps 2, 4` at the first of several ends that lie at one place; '' at the others of them.
   pure function end_labels(rows, ends) result(labels)
      type(history_row_t), intent(in) :: rows(:)
      integer(ip), intent(in) :: ends(:)
      character(len=LABEL_LENGTH) :: labels(size(ends))
      character(len=:), allocatable :: numbers
      real(wp) :: size_of(2)
      integer :: i, j

      size_of = [span(range_of(rows%mean_slip)), span(range_of([0.0_wp, rows%shear]))]
      labels = '?'
      do i = 1, size(ends)
         if (labels(i) == '') cycle
         numbers = to_text(rows(ends(i))%step)
         do j = i + 1, size(ends)
            if (.not. is_near(rows(ends(i)), rows(ends(j)), size_of)) cycle
            numbers = numbers//', '//to_text(rows(ends(j))%step)
            labels(j) = ''
         end do
         labels(i) = 'step '//numbers
         if (index(numbers, ',') > 0) labels(i) = 'steps '//numbers
         if (len(numbers) > LABEL_LENGTH - 6) labels(i) (LABEL_LENGTH - 1:) = '..'
      end do
   end function end_labels

   pure logical function is_near(a, b, size_of)
      type(history_row_t), intent(in) :: a, b
      real(wp), intent(in) :: size_of(2)            !< of the picture [L], [F]

      is_near = abs(a%mean_slip - b%mean_slip) <= SAME_PLACE*size_of(1) .and. abs(a%shear - b%shear) <= SAME_PLACE*size_of(2)
   end function is_near

end module atrito_history_plot
