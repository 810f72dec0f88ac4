!> The picture of a contact pair: pressure, shear, slip and gap along s, in panels one below the other.
!>
!> Of a history of several steps the end of the last one is drawn over those of the steps before it.
!>
!> The script reads contact.tab in the folder above, so it draws what the table says. A pair without friction has no panels of
!> shear and slip, and one without a nonlocal law no weighted pressure.
module atrito_contact_plot
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: to_text
   use atrito_status, only: status_t
   use atrito_files, only: file_set_t, text_file_t, put_line
   use atrito_model, only: model_t, interaction_t, FRICTION_NONE, FRICTION_LOCAL, FRICTION_NONLOCAL
   use atrito_results, only: results_t, contact_result_t, history_t, last_frame, view_frame, POINT_OPEN, POINT_SLIP
   use atrito_write_tables, only: origin_of
   use atrito_plot_files, only: CONTACT_PLOT
   use atrito_plot_text, only: range_t, cover, padded, quoted, cleaned, picture_title, put_table, begin_script, end_script, &
                               put_terminal, put_frame, put_panel, COLOUR, GREEK_NU, GREEK_EPSILON, GREEK_RHO, GREEK_DELTA, &
                               PLUS_MINUS
   implicit none (type, external)
   private
   public :: write_contact_plot, shown_frames, pair_title, law_text, put_contact_columns, shows_slip_bound, shear_range, state_of, &
             N_STATES, STATE_WORD, STATE_COLOUR

   !> The bound of the shear is shown whole up to so many times the largest shear; a greater one would hide the shear itself.
   real(wp), parameter :: MOST_BOUND = 4.0_wp
   !> The lines +-eps are shown where eps over the largest slip lies between these: else they are one line, or hide the slip.
   real(wp), parameter :: LEAST_EPS = 0.02_wp, MOST_EPS = 4.0_wp
   integer(ip), parameter :: MOST_STEPS = 8         !< ends of steps in a picture, the last one among them
   !> Those before the last one, from early to late.
   character(len=7), parameter :: EARLY(MOST_STEPS - 1) = &
                                  ['#909090', '#E69F00', '#56B4E9', '#CC79A7', '#8C564B', '#009E73', '#606060']
   integer(ip), parameter :: FIRST_EARLY = 10       !< line style of the first of them
   integer(ip), parameter :: OF_PRESSURE = 1, OF_SHEAR = 2, OF_SLIP = 3, OF_GAP = 4
   integer, parameter :: LONGEST_NAME = 30          !< characters of a surface's name

   integer(ip), parameter :: N_STATES = 4, STATE_CLOSED = 3 !< closed: without friction
   character(len=6), parameter :: STATE_WORD(0:N_STATES - 1) = ['open  ', 'stick ', 'slip  ', 'closed']
   integer, parameter :: STATE_COLOUR(0:N_STATES - 1) = [5, 3, 2, 6]   !< places in COLOUR

contains

   !> Writes the script of a pair into the set of the plots' folder.
   !>
   !> status: STATUS_FILE when it could not be written.
   subroutine write_contact_plot(set, model, history, pair, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      integer(ip), intent(in) :: pair               !< with at least one point
      type(status_t), intent(out) :: status

      associate (last => history%frames(last_frame(history)))
         call write_script(set, model, history, last, pair, status)
      end associate
   end subroutine write_contact_plot

   subroutine write_script(set, model, history, results, pair, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      type(results_t), intent(in) :: results        !< its last frame
      integer(ip), intent(in) :: pair
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(interaction_t) :: law
      logical :: friction
      character(len=:), allocatable :: name

      name = CONTACT_PLOT//to_text(pair)
      law = model%interactions(model%pairs(pair)%interaction)
      friction = results%contact(pair)%has_friction .and. law%friction /= FRICTION_NONE
      call begin_script(set, name, 'contact pair '//to_text(pair)//' along s', file)
      call put_line(file, 'step = '//to_text(results%step))
      call put_line(file, 'increment = '//to_text(results%increment))
      call put_contact_columns(file, pair, ', 12 status (0 open, 1 stick, 2 slip)', 'step', 'increment')
      call put_line(file, 'marked(c, status) = column(12) == status ? col(c) : NaN')
      call put_early(file, history)
      call put_table(set, 'contact', file)
      call put_line(file, 'heading = '//quoted(picture_title(origin_of(model, history))))
      call put_line(file, 'pair_line = '//quoted(pair_title(results, pair)//law_text(law)))
      call put_frame(file, merge(4, 2, friction), slave_range(results%contact(pair)), '"s [L]"')
      if (friction) call put_line(file, 'nu = '//to_text(law%nu, 12))
      if (friction) call put_line(file, 'eps = '//to_text(law%eps, 12))
      call put_terminal(file, name, '1000,height')
      call put_styles(file, results%contact(pair)%n)
      call put_line(file, 'set multiplot title heading."\n".pair_line noenhanced')
      call put_panels(file, history, pair, law, friction)
      call put_line(file, 'unset multiplot')
      call end_script(file, status)
   end subroutine write_script

   !> Places of the frames that are drawn: the ends of the steps, evenly some of them where they are many, and the last frame.
   pure function shown_frames(history) result(list)
      type(history_t), intent(in) :: history
      integer(ip), allocatable :: list(:)
      integer(ip) :: i, n

      list = pack([(i, i=1, last_frame(history))], history%frames%ends_step .or. &
                  [(i == last_frame(history), i=1, last_frame(history))])
      n = size(list, kind=ip)
      if (n <= MOST_STEPS) return
      list = list([(1_ip + nint(real(i - 1, wp)*real(n - 1, wp)/real(MOST_STEPS - 1, wp), ip), i=1, MOST_STEPS)])
   end function shown_frames

   !> Which increments the ends of steps before the last one are, and their columns.
   subroutine put_early(file, history)
      type(text_file_t), intent(inout) :: file
      type(history_t), intent(in) :: history
      integer(ip), allocatable :: shown(:)
      integer(ip) :: i

      shown = shown_frames(history)
      if (size(shown) == 1) return
      call put_line(file, 'early_steps = '//to_text(size(shown, kind=ip) - 1_ip))
      call put_line(file, 'array early_step[early_steps]; array early_increment[early_steps]')
      do i = 1, size(shown, kind=ip) - 1
         associate (frame => history%frames(shown(i)))
            call put_line(file, 'early_step['//to_text(i)//'] = '//to_text(frame%step)//'; early_increment['//to_text(i)//'] = '// &
                          to_text(frame%increment))
         end associate
         call put_line(file, 'set style line '//to_text(FIRST_EARLY + i)//' lt 1 lw 1.5 lc rgb "'//EARLY(i)//'"')
      end do
      call put_line(file, 'early(i, c) = is_shown(early_step[i], early_increment[i]) ? column(c)/unit : NaN')
   end subroutine put_early

   !> What the columns of contact.tab are, and a function that takes those of one pair in one increment.
   subroutine put_contact_columns(file, pair, and_status, step, increment)
      type(text_file_t), intent(inout) :: file
      integer(ip), intent(in) :: pair
      character(len=*), intent(in) :: and_status    !< what is said of the status; empty where it is not drawn
      character(len=*), intent(in) :: step, increment !< what gnuplot knows them by

      call put_line(file, '# Columns of contact.tab: 2 pair, 4 s [L], 7 gap [L], 8 pressure [F/L^2], 9 weighted pressure [F/L^2],')
      call put_line(file, '# 10 shear [F/L^2], 11 slip [L]'//and_status//', 1 step, 15 increment')
      call put_line(file, 'pair = '//to_text(pair))
      call put_line(file, 'is_shown(t, k) = column(2) == pair && column(1) == t && column(15) == k')
      call put_line(file, 'col(c) = is_shown('//step//', '//increment//') ? column(c)/unit : NaN')
   end subroutine put_contact_columns

   !> A pair with the names of its surfaces: `pair 1: plate-BOTTOM on support-TOP`.
   pure function pair_title(results, pair) result(text)
      type(results_t), intent(in) :: results
      integer(ip), intent(in) :: pair
      character(len=:), allocatable :: text

      text = 'pair '//to_text(pair)
      if (.not. allocated(results%scene%pairs)) return
      if (pair > size(results%scene%pairs)) return
      associate (scene => results%scene%pairs(pair))
         text = text//': '//cleaned(scene%slave, LONGEST_NAME)//' on '//cleaned(scene%master, LONGEST_NAME)
      end associate
   end function pair_title

   !> The parameters of a pair's laws, those that are in force.
   pure function law_text(law) result(text)
      type(interaction_t), intent(in) :: law
      character(len=:), allocatable :: text

      select case (law%friction)
      case (FRICTION_NONLOCAL)
         text = ';  '//GREEK_NU//' = '//to_text(law%nu)//', '//GREEK_EPSILON//' = '//to_text(law%eps)//', '// &
                GREEK_RHO//' = '//to_text(law%rho)
      case (FRICTION_LOCAL)
         text = ';  '//GREEK_NU//' = '//to_text(law%nu)
         if (law%stick_slope > 0.0_wp) text = text//', k = '//to_text(law%stick_slope)
      case default
         text = ';  no friction'
      end select
      if (law%delta > 0.0_wp) text = text//', '//GREEK_DELTA//' = '//to_text(law%delta)
   end function law_text

   !> s of the pair, from 0 to its last point.
   pure type(range_t) function slave_range(contact) result(range)
      type(contact_result_t), intent(in) :: contact

      call cover(range, [0.0_wp, contact%s_end, contact%s(:contact%n)])
      if (range%high <= range%low) range = padded(range)
   end function slave_range

   !> Curves 1 to 3, points of each status 4 to 6; many points are drawn smaller.
   subroutine put_styles(file, n)
      type(text_file_t), intent(inout) :: file
      integer(ip), intent(in) :: n                  !< points
      character(len=:), allocatable :: dot

      dot = 'dot*'//to_text(min(1.0_wp, max(0.25_wp, 6.0_wp/sqrt(real(max(n, 1_ip), wp)))), 2)
      call put_line(file, 'set style line 1 lt 1 lw 2 lc rgb "'//COLOUR(1)//'"')
      call put_line(file, 'set style line 2 lw 2 dt (8,5) lc rgb "'//COLOUR(6)//'"')
      call put_line(file, 'set style line 3 lw 1.5 dt (7,5) lc rgb "#404040"')
      call put_line(file, 'set style line 4 pt 6 lw 1.5 lc rgb "black" ps '//dot)
      call put_line(file, 'set style line 5 pt 7 lw 1.5 lc rgb "black" ps '//dot)
      call put_line(file, 'set style line 6 pt 9 lw 1.5 lc rgb "'//COLOUR(2)//'" ps 1.2*'//dot)
   end subroutine put_styles

   subroutine put_panels(file, history, pair, law, friction)
      type(text_file_t), intent(inout) :: file
      type(history_t), intent(in) :: history
      integer(ip), intent(in) :: pair
      type(interaction_t), intent(in) :: law
      logical, intent(in) :: friction
      character(len=:), allocatable :: early
      integer(ip) :: n

      early = ''
      if (size(shown_frames(history)) > 1) early = step_name(history)
      n = history%frames(last_frame(history))%contact(pair)%n
      associate (contact => history%frames(last_frame(history))%contact(pair))
         call put_panel(file, 1, 'pressure', 'F/L^2', &
                        with_early(field_range(contact%pressure(:n), contact%weighted_pressure(:n)), history, pair, OF_PRESSURE))
         call put_pressure(file, contact, law, friction, early)
         if (friction) then
            call put_panel(file, 2, 'shear', 'F/L^2', with_early(shear_range(contact, law%nu), history, pair, OF_SHEAR))
            call put_curve(file, 10, 'shear', bound_curves(law), contact, friction, early)
            call put_panel(file, 3, 'slip', 'L', with_early(slip_range(contact, law%eps), history, pair, OF_SLIP))
            call put_curve(file, 11, 'slip u_T', slip_curves(contact, law%eps), contact, friction, early)
         end if
         call put_panel(file, merge(4, 2, friction), 'gap', 'L', &
                        with_early(field_range(contact%gap(:n), contact%gap(:n)), history, pair, OF_GAP))
         call put_curve(file, 7, 'gap', '', contact, friction, early)
      end associate
   end subroutine put_panels

   !> What the last frame of a history is called.
   pure function step_name(history) result(text)
      type(history_t), intent(in) :: history
      character(len=:), allocatable :: text

      associate (last => history%frames(last_frame(history)))
         text = 'step '//to_text(last%step)
         if (.not. last%ends_step) text = text//', increment '//to_text(last%increment)
      end associate
   end function step_name

   subroutine put_pressure(file, contact, law, friction, early)
      type(text_file_t), intent(inout) :: file
      type(contact_result_t), intent(in) :: contact
      type(interaction_t), intent(in) :: law
      logical, intent(in) :: friction
      character(len=*), intent(in) :: early         !< what the last frame is called beside those before it; empty: there are none
      character(len=:), allocatable :: title

      title = 'pressure p'
      if (len(early) > 0) title = early
      if (law%friction == FRICTION_NONLOCAL .and. friction) then
         call put_curve(file, 8, title, ', table using 4:(col(9)) with lines ls 2 title "weighted, S_{'// &
                        GREEK_RHO//'}(p)"', contact, friction, early)
      else
         call put_curve(file, 8, title, '', contact, friction, early)
      end if
   end subroutine put_pressure

   !> A range widened by a field of the ends of steps before the last one.
   type(range_t) function with_early(range, history, pair, field) result(wide)
      type(range_t), intent(in) :: range
      type(history_t), intent(in), target :: history
      integer(ip), intent(in) :: pair, field        !< OF_*
      type(results_t), pointer :: frame
      integer(ip), allocatable :: shown(:)
      integer(ip) :: i

      wide = range
      shown = shown_frames(history)
      do i = 1, size(shown, kind=ip) - 1
         call view_frame(history, shown(i), frame)
         associate (contact => frame%contact(pair))
            select case (field)
            case (OF_PRESSURE)
               call cover(wide, contact%pressure(:contact%n))
            case (OF_SHEAR)
               call cover(wide, contact%shear(:contact%n))
            case (OF_SLIP)
               call cover(wide, contact%slip(:contact%n))
            case (OF_GAP)
               call cover(wide, contact%gap(:contact%n))
            end select
         end associate
      end do
   end function with_early

   !> Zero and both fields.
   pure type(range_t) function field_range(a, b) result(range)
      real(wp), intent(in) :: a(:), b(:)

      call cover(range, [0.0_wp])
      call cover(range, a)
      call cover(range, b)
   end function field_range

   !> Zero, the shear, and the bound as far as it does not hide the shear.
   pure type(range_t) function shear_range(contact, nu) result(range)
      type(contact_result_t), intent(in) :: contact
      real(wp), intent(in) :: nu
      type(range_t) :: bound
      real(wp) :: largest, shown

      range = field_range(contact%shear(:contact%n), [real(wp) ::])
      call cover(bound, [0.0_wp])
      call cover(bound, contact%weighted_pressure(:contact%n))
      largest = max(abs(range%low), abs(range%high))
      shown = min(MOST_BOUND*largest, nu*bound%high)
      ! without any shear the bound is all there is to see
      if (largest <= 0.0_wp) shown = nu*bound%high
      if (nu*bound%high > MOST_BOUND*largest .and. largest > 0.0_wp) shown = 1.5_wp*largest
      call cover(range, [-shown, shown])
   end function shear_range

   pure function bound_curves(law) result(text)
      type(interaction_t), intent(in) :: law
      character(len=:), allocatable :: text, name

      name = PLUS_MINUS//' '//GREEK_NU//' p'
      if (law%friction == FRICTION_NONLOCAL) name = PLUS_MINUS//' '//GREEK_NU//' S_{'//GREEK_RHO//'}(p)'
      text = ', table using 4:(nu*col(9)) with lines ls 3 title "'//name//'"'// &
             ', table using 4:(-nu*col(9)) with lines ls 3'
   end function bound_curves

   !> True where the lines +-eps tell something.
   pure logical function shows_slip_bound(contact, eps)
      type(contact_result_t), intent(in) :: contact
      real(wp), intent(in) :: eps
      type(range_t) :: range
      real(wp) :: largest

      range = field_range(contact%slip(:contact%n), [real(wp) ::])
      largest = max(abs(range%low), abs(range%high))
      shows_slip_bound = eps > 0.0_wp .and. eps >= LEAST_EPS*largest .and. eps <= MOST_EPS*largest
   end function shows_slip_bound

   pure type(range_t) function slip_range(contact, eps) result(range)
      type(contact_result_t), intent(in) :: contact
      real(wp), intent(in) :: eps

      range = field_range(contact%slip(:contact%n), [real(wp) ::])
      if (shows_slip_bound(contact, eps)) call cover(range, [-eps, eps])
   end function slip_range

   pure function slip_curves(contact, eps) result(text)
      type(contact_result_t), intent(in) :: contact
      real(wp), intent(in) :: eps
      character(len=:), allocatable :: text

      text = ''
      if (.not. shows_slip_bound(contact, eps)) return
      text = ', eps/unit with lines ls 3 title "'//PLUS_MINUS//' '//GREEK_EPSILON//'", -eps/unit with lines ls 3'
   end function slip_curves

   !> A column as a line, further curves, and its points by their status.
   subroutine put_curve(file, column, title, more, contact, friction, early)
      type(text_file_t), intent(inout) :: file
      integer, intent(in) :: column                 !< of contact.tab
      character(len=*), intent(in) :: title
      character(len=*), intent(in) :: more          !< further curves, each behind a comma
      type(contact_result_t), intent(in) :: contact
      logical, intent(in) :: friction
      character(len=*), intent(in) :: early         !< not empty: over those of the steps before it
      character(len=:), allocatable :: line, c
      integer(ip) :: k
      integer(ip), parameter :: STYLE(0:N_STATES - 1) = [4_ip, 5_ip, 6_ip, 5_ip]

      c = to_text(int(column, ip))
      line = 'plot '
      if (len(early) > 0) then
         line = line//'for [i=1:early_steps] table using 4:(early(i, '//c//')) with lines ls '//to_text(FIRST_EARLY)//'+i'
         if (column == 8) line = line//' title "step ".early_step[i]'
         line = line//', '
      end if
      line = line//'table using 4:(col('//c//')) with lines ls 1 title "'//title//'"'//more
      do k = POINT_OPEN, POINT_SLIP
         if (all(contact%status(:contact%n) /= k)) cycle
         line = line//', table using 4:(marked('//c//','//to_text(k)//')) with points ls '//to_text(STYLE(state_of(k, friction)))
         if (column == 8) line = line//' title "'//trim(STATE_WORD(state_of(k, friction)))//'"'
      end do
      call put_line(file, line)
   end subroutine put_curve

   !> The state of a point; a closed one of a pair without friction neither sticks nor slips.
   elemental integer(ip) function state_of(status, has_friction) result(state)
      integer(ip), intent(in) :: status             !< POINT_*
      logical, intent(in) :: has_friction

      state = status
      if (status /= POINT_OPEN .and. .not. has_friction) state = STATE_CLOSED
   end function state_of

end module atrito_contact_plot
