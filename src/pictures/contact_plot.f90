!> The picture of a contact pair: pressure, shear, slip and gap along s, in panels one below the other.
!>
!> Of a history of several steps the end of the last one is drawn over those of the steps before it.
!>
!> The script reads contact.tab in the folder above, so it draws what the table says. A pair without friction has no panels of
!> shear and slip, and one without a nonlocal law no weighted pressure.
module atrito_contact_plot
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t, interaction_t, FRICTION_NONE, FRICTION_LOCAL, FRICTION_NONLOCAL
   use atrito_plot_files, only: CONTACT_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_script, put_table, put_terminal, put_frame, put_panel
   use atrito_plot_text, only: range_t, cover, padded, range_of, quoted, cleaned, picture_title, evenly, COLOUR, DASH, LF, &
                               GREEK_NU, GREEK_EPSILON, GREEK_RHO, GREEK_DELTA, PLUS_MINUS
   use atrito_results, only: results_t, contact_result_t, history_t, last_frame, view_frame, POINT_OPEN, POINT_SLIP
   use atrito_strings, only: to_text
   use atrito_summary, only: pair_name
   use atrito_write_tables, only: origin_of
   implicit none (type, external)
   private
   public :: write_contact_plot, shown_frames, pair_title, pair_legend, law_text, put_contact_columns, shows_slip_bound
   public :: shear_range, state_of, N_STATES, STATE_WORD, STATE_COLOUR, STATE_DASH

   !> The bound of the shear is shown whole up to so many times the largest shear; a greater one would hide the shear itself.
   real(wp), parameter :: MOST_BOUND = 4.0_wp
   !> The lines +-eps are shown where eps over the largest slip lies between these: else they are one line, or hide the slip.
   real(wp), parameter :: LEAST_EPS = 0.02_wp, MOST_EPS = 4.0_wp
   integer(ip), parameter :: MOST_STEPS = 8         !< ends of steps in a picture, the last one among them
   !> Those before the last one, from early to late.
   character(len=7), parameter :: EARLY(MOST_STEPS - 1) = &
                                  ['#909090', '#E69F00', '#56B4E9', '#CC79A7', '#8C564B', '#009E73', '#606060']
   integer(ip), parameter :: FIRST_EARLY = 10       !< line style of the first of them
   !> Columns of contact.tab.
   integer(ip), parameter :: GAP = 7, PRESSURE = 8, SHEAR = 10, SLIP = 11
   integer, parameter :: LONGEST_NAME = 64, LONGEST_LEGEND = 17   !< characters of a pair's name

   integer(ip), parameter :: N_STATES = 4, STATE_CLOSED = 3 !< closed: without friction
   character(len=6), parameter :: STATE_WORD(0:N_STATES - 1) = ['open  ', 'stick ', 'slip  ', 'closed']
   integer, parameter :: STATE_COLOUR(0:N_STATES - 1) = [5, 3, 2, 6]   !< places in COLOUR
   !> Without colours they are told by these.
   character(len=8), parameter :: STATE_DASH(0:N_STATES - 1) = ['dt (1,1)', 'dt 1    ', 'dt (3,1)', 'dt 1    ']

contains

   !> Writes the script of a pair.
   subroutine write_contact_plot(plots, model, history, pair)
      type(plots_t), intent(inout) :: plots         !< get the script
      type(model_t), intent(in) :: model            !< names and laws of its pairs
      type(history_t), intent(in) :: history        !< with contact in all frames
      integer(ip), intent(in) :: pair               !< with at least one point
      type(interaction_t) :: law
      type(range_t) :: along
      integer(ip), allocatable :: shown(:)
      logical :: friction
      character(len=:), allocatable :: dot

      law = model%interactions(model%pairs(pair)%interaction)
      shown = shown_frames(history)
      call begin_script(plots, CONTACT_PLOT//to_text(pair), 'contact pair '//to_text(pair)//' along s')
      associate (last => history%frames(last_frame(history)), contact => history%frames(last_frame(history))%contact(pair))
         friction = contact%has_friction .and. law%friction /= FRICTION_NONE
         call put(plots, 'step = '//to_text(last%step)//LF//'increment = '//to_text(last%increment))
         call put_contact_columns(plots, pair, ', 12 status (0 open, 1 stick, 2 slip)', 'step', 'increment')
         call put(plots, 'marked(c, status) = column(12) == status ? col(c) : NaN')
         call put_early(plots, history, shown)
         call put_table(plots, 'contact')
         call put(plots, 'heading = '//quoted(picture_title(origin_of(model, history)))//LF// &
                  'pair_line = '//quoted(pair_title(last, pair)//law_text(law)))
         along = range_of([0.0_wp, contact%s_end, contact%s(:contact%n)])
         if (along%high <= along%low) along = padded(along)
         call put_frame(plots, merge(4_ip, 2_ip, friction), along, '"s [L]"')
         if (friction) call put(plots, 'nu = '//to_text(law%nu, 12)//LF//'eps = '//to_text(law%eps, 12))
         call put_terminal(plots, '1000,height')
         ! Curves 1 to 3, points of each status 4 to 6; many points are drawn smaller.
         dot = 'dot*'//to_text(min(1.0_wp, max(0.25_wp, 6.0_wp/sqrt(real(max(contact%n, 1_ip), wp)))), 2)
         call put(plots, 'set style line 1 lt 1 lw 2 lc rgb "'//COLOUR(1)//'"'//LF// &
                  'set style line 2 lw 2 dt (8,5) lc rgb "'//COLOUR(6)//'"'//LF// &
                  'set style line 3 lw 1.5 dt (7,5) lc rgb "#404040"'//LF// &
                  'set style line 4 pt 6 lw 1.5 lc rgb "black" ps '//dot//LF// &
                  'set style line 5 pt 7 lw 1.5 lc rgb "black" ps '//dot//LF// &
                  'set style line 6 pt 9 lw 1.5 lc rgb "'//COLOUR(2)//'" ps 1.2*'//dot)
         call put(plots, 'set multiplot title heading."\n".pair_line noenhanced')
         call put_panels(plots, history, shown, pair, law, friction)
      end associate
      call put(plots, 'unset multiplot')
   end subroutine write_contact_plot

   !> Places of the frames that are drawn: the ends of the steps, evenly some of them where they are many, and the last frame.
   pure function shown_frames(history) result(list)
      type(history_t), intent(in) :: history        !< whose frames say if they end a step
      integer(ip), allocatable :: list(:)
      integer(ip) :: i

      list = pack([(i, i=1, last_frame(history))], history%frames%ends_step .or. &
                  [(i == last_frame(history), i=1, last_frame(history))])
      list = list(evenly(size(list, kind=ip), MOST_STEPS))
   end function shown_frames

   !> Which increments the ends of steps before the last one are, and their columns.
   subroutine put_early(plots, history, shown)
      type(plots_t), intent(inout) :: plots
      type(history_t), intent(in) :: history
      integer(ip), intent(in) :: shown(:)
      integer(ip) :: i

      if (size(shown) == 1) return
      call put(plots, 'early_steps = '//to_text(size(shown, kind=ip) - 1_ip)//LF// &
               'array early_step[early_steps]; array early_increment[early_steps]')
      do i = 1, size(shown, kind=ip) - 1
         associate (frame => history%frames(shown(i)))
            call put(plots, 'early_step['//to_text(i)//'] = '//to_text(frame%step)//'; early_increment['//to_text(i)//'] = '// &
                     to_text(frame%increment)//LF// &
                     'set style line '//to_text(FIRST_EARLY + i)//' lw 1.5 dt '//trim(DASH(i + 1))//' lc rgb "'//EARLY(i)//'"')
         end associate
      end do
      call put(plots, 'early(i, c) = is_shown(early_step[i], early_increment[i]) ? column(c)/unit : NaN')
   end subroutine put_early

   !> What the columns of contact.tab are, and a function that takes those of one pair in one increment.
   subroutine put_contact_columns(plots, pair, and_status, step, increment)
      type(plots_t), intent(inout) :: plots         !< lines go into its open script
      integer(ip), intent(in) :: pair               !< place in model%pairs
      character(len=*), intent(in) :: and_status    !< what is said of the status; empty where it is not drawn
      character(len=*), intent(in) :: step, increment !< what gnuplot knows them by

      call put(plots, '# Columns of contact.tab: 2 pair, 4 s [L], 7 gap [L], 8 pressure [F/L^2], 9 weighted pressure [F/L^2],')
      call put(plots, '# 10 shear [F/L^2], 11 slip [L]'//and_status//', 1 step, 15 increment'//LF//'pair = '//to_text(pair))
      call put(plots, 'is_shown(t, k) = column(2) == pair && column(1) == t && column(15) == k')
      call put(plots, 'col(c) = is_shown('//step//', '//increment//') ? column(c)/unit : NaN')
   end subroutine put_contact_columns

   !> A pair with the names of its surfaces: `pair 1: plate-BOTTOM on support-TOP`.
   pure function pair_title(results, pair) result(text)
      type(results_t), intent(in) :: results        !< names of its pairs
      integer(ip), intent(in) :: pair               !< place in model%pairs
      character(len=:), allocatable :: text

      text = 'pair '//to_text(pair)
      if (len(pair_name(results, pair)) > 0) text = text//': '//cleaned(pair_name(results, pair), LONGEST_NAME)
   end function pair_title

   !> A pair in a legend, by the name of its slave: `1: plate-BOTTOM`.
   pure function pair_legend(pair, name) result(text)
      integer(ip), intent(in) :: pair               !< place in model%pairs
      character(len=*), intent(in) :: name          !< `plate-BOTTOM on support-TOP`; '': not known
      character(len=:), allocatable :: text

      text = 'pair '//to_text(pair)
      if (len(name) > 0) text = to_text(pair)//': '//cleaned(name(:index(name//' on ', ' on ') - 1), LONGEST_LEGEND)
   end function pair_legend

   !> The parameters of a pair's laws, those that are in force.
   pure function law_text(law) result(text)
      type(interaction_t), intent(in) :: law        !< of the pair
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

   !> The panels: fields of the last frame over those of the ends of steps before it, with their bounds.
   subroutine put_panels(plots, history, shown, pair, law, friction)
      type(plots_t), intent(inout) :: plots
      type(history_t), intent(in) :: history
      integer(ip), intent(in) :: shown(:), pair     !< shown: frames
      type(interaction_t), intent(in) :: law
      logical, intent(in) :: friction
      character(len=:), allocatable :: name, more
      type(range_t) :: range, bound

      associate (last => history%frames(last_frame(history)), contact => history%frames(last_frame(history))%contact(pair))
         name = 'pressure p'
         if (size(shown) > 1) name = 'step '//to_text(last%step)
         if (size(shown) > 1 .and. .not. last%ends_step) name = name//', increment '//to_text(last%increment)
         more = ''
         if (law%friction == FRICTION_NONLOCAL .and. friction) more = ', table using 4:(col(9)) with lines ls 2'// &
                                                                      ' title "weighted, S_{'//GREEK_RHO//'}(p)"'
         range = range_over(history, shown, pair, PRESSURE)
         call cover(range, contact%weighted_pressure(:contact%n))
         call put_panel(plots, 1_ip, 'pressure', 'F/L^2', range)
         call put_curve(plots, PRESSURE, name, more, contact, friction, size(shown) > 1)
         if (friction) then
            range = range_over(history, shown, pair, SHEAR)
            bound = shear_range(contact, law%nu)
            call cover(range, [bound%low, bound%high])
            call put_panel(plots, 2_ip, 'shear', 'F/L^2', range)
            name = PLUS_MINUS//' '//GREEK_NU//' p'
            if (law%friction == FRICTION_NONLOCAL) name = PLUS_MINUS//' '//GREEK_NU//' S_{'//GREEK_RHO//'}(p)'
            call put_curve(plots, SHEAR, 'shear', ', table using 4:(nu*col(9)) with lines ls 3 title "'//name//'"'// &
                           ', table using 4:(-nu*col(9)) with lines ls 3', contact, friction, size(shown) > 1)
            range = range_over(history, shown, pair, SLIP)
            more = ''
            if (shows_slip_bound(contact, law%eps)) then
               call cover(range, [-law%eps, law%eps])
               more = ', eps/unit with lines ls 3 title "'//PLUS_MINUS//' '//GREEK_EPSILON//'", -eps/unit with lines ls 3'
            end if
            call put_panel(plots, 3_ip, 'slip', 'L', range)
            call put_curve(plots, SLIP, 'slip u_T', more, contact, friction, size(shown) > 1)
         end if
         call put_panel(plots, merge(4_ip, 2_ip, friction), 'gap', 'L', range_over(history, shown, pair, GAP))
         call put_curve(plots, GAP, 'gap', '', contact, friction, size(shown) > 1)
      end associate
   end subroutine put_panels

   !> Zero, and a field of all frames that are shown.
   type(range_t) function range_over(history, shown, pair, column) result(range)
      type(history_t), intent(in), target :: history
      integer(ip), intent(in) :: shown(:), pair, column   !< frames; of contact.tab
      type(results_t), pointer :: frame
      integer(ip) :: i

      call cover(range, [0.0_wp])
      do i = 1, size(shown, kind=ip)
         call view_frame(history, shown(i), frame)
         associate (contact => frame%contact(pair))
            select case (column)
            case (PRESSURE)
               call cover(range, contact%pressure(:contact%n))
            case (SHEAR)
               call cover(range, contact%shear(:contact%n))
            case (SLIP)
               call cover(range, contact%slip(:contact%n))
            case (GAP)
               call cover(range, contact%gap(:contact%n))
            end select
         end associate
      end do
   end function range_over

   !> Zero, the shear, and the bound as far as it does not hide the shear.
   pure type(range_t) function shear_range(contact, nu) result(range)
      type(contact_result_t), intent(in) :: contact !< of a pair at the end
      real(wp), intent(in) :: nu                    !< coefficient of friction
      type(range_t) :: weighted
      real(wp) :: largest, bound, shown

      range = range_of([0.0_wp, contact%shear(:contact%n)])
      weighted = range_of([0.0_wp, contact%weighted_pressure(:contact%n)])
      largest = max(abs(range%low), abs(range%high))
      bound = nu*weighted%high
      shown = bound                                 ! without any shear the bound is all there is to see
      if (largest > 0.0_wp .and. bound > MOST_BOUND*largest) shown = 1.5_wp*largest
      call cover(range, [-shown, shown])
   end function shear_range

   !> Whether the lines +-eps are drawn: eps is neither tiny nor huge beside the slip.
   pure logical function shows_slip_bound(contact, eps)
      type(contact_result_t), intent(in) :: contact !< of a pair at the end
      real(wp), intent(in) :: eps                   !< of the nonlocal law [L]; 0 is exact stick
      type(range_t) :: range
      real(wp) :: largest

      range = range_of([0.0_wp, contact%slip(:contact%n)])
      largest = max(abs(range%low), abs(range%high))
      shows_slip_bound = eps > 0.0_wp .and. eps >= LEAST_EPS*largest .and. eps <= MOST_EPS*largest
   end function shows_slip_bound

   !> A column as a line, further curves, and its points by their status.
   subroutine put_curve(plots, column, title, more, contact, friction, has_early)
      type(plots_t), intent(inout) :: plots
      integer(ip), intent(in) :: column             !< of contact.tab
      character(len=*), intent(in) :: title
      character(len=*), intent(in) :: more          !< further curves, each behind a comma
      type(contact_result_t), intent(in) :: contact
      logical, intent(in) :: friction, has_early    !< has_early: over those of the steps before it
      character(len=:), allocatable :: line, c
      integer(ip) :: k, state
      integer(ip), parameter :: STYLE(0:N_STATES - 1) = [4_ip, 5_ip, 6_ip, 5_ip]

      c = to_text(column)
      line = 'plot '
      if (has_early) then
         line = line//'for [i=1:early_steps] table using 4:(early(i, '//c//')) with lines ls '//to_text(FIRST_EARLY)//'+i'
         if (column == PRESSURE) line = line//' title "step ".early_step[i]'
         line = line//', '
      end if
      line = line//'table using 4:(col('//c//')) with lines ls 1 title "'//title//'"'//more
      do k = POINT_OPEN, POINT_SLIP
         if (all(contact%status(:contact%n) /= k)) cycle
         state = state_of(k, friction)
         line = line//', table using 4:(marked('//c//','//to_text(k)//')) with points ls '//to_text(STYLE(state))
         if (column == PRESSURE) line = line//' title "'//trim(STATE_WORD(state))//'"'
      end do
      call put(plots, line)
   end subroutine put_curve

   !> The state of a point; a closed one of a pair without friction neither sticks nor slips.
   elemental integer(ip) function state_of(status, has_friction) result(state)
      integer(ip), intent(in) :: status             !< POINT_*
      logical, intent(in) :: has_friction           !< of the pair

      state = status
      if (status /= POINT_OPEN .and. .not. has_friction) state = STATE_CLOSED
   end function state_of

end module atrito_contact_plot
