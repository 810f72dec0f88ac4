!> What the contact transmits, over the outlines of the bodies: its tractions upon the slaves, as arrows; and the joints, where they
!> are open, stick and slip, with the line of thrust.
!>
!> The line of thrust goes through the places of the joints' resultants. Within a body the places of its joints are joined to their
!> mean, weighted by n: a straight line for two joints, a star for more. The scripts read mesh.dat for the outlines.
module atrito_force_plots
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_contact_plot, only: state_of, N_STATES, STATE_WORD, STATE_COLOUR, STATE_DASH
   use atrito_drawing, only: drawing_t, put_head, put_plane, put_title, add_lines, add_rigid_lines, displacement_text, &
                             largest_length, scale_title
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: TRACTION_PLOT, MESH_PLOT, JOINT_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_script, put_plot
   use atrito_plot_text, only: range_t, COLOUR, LF
   use atrito_results, only: results_t, contact_result_t, joint_t
   use atrito_strings, only: string_t, to_text
   use atrito_summary, only: pair_count
   use atrito_symbols, only: symbols_t, begin_symbols, end_symbols, begin_block, put_path, put_point, put_text, thinned, widen
   implicit none (type, external)
   private
   public :: has_traction_plot, write_traction_plot, traction, longest_arrow, has_joint_plot, write_joint_plot

   real(wp), parameter :: LONGEST = 0.12_wp         !< arrow, as a share of the scene's diagonal
   real(wp), parameter :: HALF_WAY = 0.45_wp, CLOSE = 0.02_wp   !< between pairs; nearer ones, as shares of the diagonal, are one
   real(wp), parameter :: SHORTEST = 4.0_wp, BETWEEN = 9.0_wp   !< arrow, and distance of two of them [pixels]
   character(len=6), parameter :: HEAD(0:N_STATES - 1) = ['empty ', 'filled', 'empty ', 'filled']
   integer, parameter :: ARROW_DIGITS = 6

   integer(ip), parameter :: N_WIDTHS = 5           !< of the line of thrust
   real(wp), parameter :: LEAST_SHARE = 1.0e-3_wp   !< of the largest n; a joint with less is not on the line of thrust
   real(wp), parameter :: MANY_JOINTS = 40.0_wp     !< from here on markers and lines are smaller

contains

   !> Whether something is transmitted.
   pure logical function has_traction_plot(results)
      type(results_t), intent(in) :: results        !< its contact is read

      has_traction_plot = largest_traction(results) > 0.0_wp
   end function has_traction_plot

   !> The traction upon the slave at a point: -p n + sigma_T T, T being n turned by +90 degrees [F/L^2].
   pure function traction(contact, j) result(t)
      type(contact_result_t), intent(in) :: contact !< of a pair
      integer(ip), intent(in) :: j                  !< point of the pair
      real(wp) :: t(2)

      associate (n => contact%normal(:, j))
         t = -contact%pressure(j)*n
         if (contact%has_friction) t = t + contact%shear(j)*[-n(2), n(1)]
      end associate
   end function traction

   pure real(wp) function largest_traction(results) result(largest)
      type(results_t), intent(in) :: results
      integer(ip) :: pair, j

      largest = 0.0_wp
      do pair = 1, pair_count(results)
         do j = 1, results%contact(pair)%n
            largest = max(largest, largest_length(reshape(traction(results%contact(pair), j), [2, 1])))
         end do
      end do
   end function largest_traction

   !> The longest arrow [L]: a share of the scene, but less than half of the way between the middles of two pairs, so that the
   !> arrows of one do not cross those of another.
   pure real(wp) function longest_arrow(results, size_of_scene) result(length)
      type(results_t), intent(in) :: results        !< points of its contact
      real(wp), intent(in) :: size_of_scene         !< diagonal of what is shown [L]
      real(wp) :: middle(2, size(results%contact)), apart
      integer :: i, k

      length = LONGEST*size_of_scene
      do i = 1, size(middle, 2)
         associate (contact => results%contact(i))
            middle(:, i) = sum(contact%x(:, :contact%n), dim=2)/max(1, contact%n)
            do k = 1, merge(i - 1, 0, contact%n > 0)
               apart = norm2(middle(:, i) - middle(:, k))
               if (apart > CLOSE*size_of_scene .and. results%contact(k)%n > 0) length = min(length, HALF_WAY*apart)
            end do
         end associate
      end do
   end function longest_arrow

   !> Writes tractions.dat and tractions.gp beside mesh.dat.
   subroutine write_traction_plot(plots, drawing)
      type(plots_t), intent(inout), target :: plots !< get data and script
      type(drawing_t), intent(inout) :: drawing     !< that of the mesh; its window has room for the arrows while this is written
      type(symbols_t) :: symbols
      type(string_t), allocatable :: curves(:)
      type(range_t) :: window(2)
      character(len=:), allocatable :: fewer
      real(wp) :: arrow, largest
      integer(ip) :: n_drawn, n

      largest = largest_traction(drawing%results)
      arrow = drawing%size
      if (allocated(drawing%view%box)) arrow = norm2(drawing%view%box(3:) - drawing%view%box(:2))
      arrow = longest_arrow(drawing%results, arrow)/largest
      call begin_symbols(plots, TRACTION_PLOT, 'contact points by state, then all of them in lines; columns: x [L]  y [L]  '// &
                         'u1 [L]  u2 [L]  traction upon the slave along x and y [F/L^2]', drawing, symbols)
      call put_tractions(drawing%results, arrow, symbols, n_drawn, n)
      call end_symbols(symbols)
      window = drawing%window
      drawing%window = symbols%window
      call begin_script(plots, TRACTION_PLOT, 'the tractions of the contact upon the slaves', &
                        'Columns of '//TRACTION_PLOT//'.dat and of '//MESH_PLOT//'.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L];'// &
                        LF//'# 5, 6 traction upon the slave [F/L^2]')
      call put_head(plots, drawing, 'arrow = '//to_text(arrow, ARROW_DIGITS)// &
                    '   # length of a traction of one; change it here'//LF)
      call put_plane(plots, drawing)
      fewer = ''
      if (n_drawn < n) fewer = ', at '//to_text(n_drawn)//' of '//to_text(n)//' points'
      call put_title(plots, '"\ntractions upon the slaves, up to '//to_text(largest, 4)//' [F/L^2]'//fewer//'; '// &
                     displacement_text(drawing)//'"')
      call add_lines(MESH_PLOT, drawing%n_inner, drawing%lines%n_runs - 1, 'lt 1 lw 1.2 lc rgb "#808080"', curves)
      call add_rigid_lines(MESH_PLOT, drawing, 'lt 1 lw 4 lc rgb "#404040"', .false., curves)
      call put_plot(plots, [curves, symbols%curves])
      drawing%window = window
   end subroutine write_traction_plot

   !> A block of arrows a state, none nearer to another than can be seen, and the lines through the ends of all.
   subroutine put_tractions(results, arrow, symbols, n_drawn, n)
      type(results_t), intent(in) :: results
      real(wp), intent(in) :: arrow                 !< length of a traction of one [L]
      type(symbols_t), intent(inout) :: symbols
      integer(ip), intent(out) :: n_drawn, n        !< arrows, and points that are not too small for one
      real(wp), dimension(2, sum(results%contact%n)) :: place, u, t
      integer(ip) :: state(size(t, 2)), pair, j, i
      logical :: is_drawn(size(t, 2)), goes_on(size(t, 2))

      i = 0
      do pair = 1, pair_count(results)
         associate (contact => results%contact(pair))
            do j = 1, contact%n
               i = i + 1
               t(:, i) = traction(contact, j)
               u(:, i) = contact%u(:, j)
               place(:, i) = contact%x(:, j) + symbols%scale*u(:, i)
               state(i) = state_of(contact%status(j), contact%has_friction)
               if (.not. all(ieee_is_finite([t(:, i), place(:, i)]))) t(:, i) = 0.0_wp
               goes_on(i) = j < contact%n
               if (goes_on(i)) goes_on(i) = contact%follows(j + 1)
            end do
         end associate
      end do
      is_drawn = norm2(t, dim=1)*arrow >= SHORTEST*symbols%pixel
      n = count(is_drawn, kind=ip)
      is_drawn = unpack(thinned(place(:, pack([(i, i=1, size(is_drawn, kind=ip))], is_drawn)), BETWEEN*symbols%pixel), is_drawn, &
                        .false.)
      n_drawn = count(is_drawn, kind=ip)
      do j = 0, N_STATES - 1
         call begin_block(symbols, trim(STATE_WORD(j)), ':(arrow*$5):(arrow*$6)', 'with vectors '//trim(HEAD(j))// &
                          ' head size screen 0.009,18 lt 1 lw 1.2 '//trim(STATE_DASH(j))//' lc rgb "'//COLOUR(STATE_COLOUR(j))// &
                          '" title "'//trim(STATE_WORD(j))//'"')
         do i = 1, size(state, kind=ip)
            if (is_drawn(i) .and. state(i) == j) call put_traction(i)
         end do
      end do
      call begin_block(symbols, 'ends of the arrows of all points', '', 'with lines lt 1 lw 0.8 lc rgb "#909090"', &
                       '($1 + scale*$3 + arrow*$5):($2 + scale*$4 + arrow*$6)')
      do i = 1, size(state, kind=ip)
         call put_traction(i, goes_on(i))
      end do

   contains

      subroutine put_traction(point, to_next)
         integer(ip), intent(in) :: point
         logical, intent(in), optional :: to_next   !< a line goes on

         call put_text(symbols, u(:, point), place(:, point) - symbols%scale*u(:, point), &
                       trimmed_real(t(1, point), ARROW_DIGITS)//' '//trimmed_real(t(2, point), ARROW_DIGITS), to_next)
         call widen(symbols, reshape(place(:, point) + arrow*t(:, point), [2, 1]))
      end subroutine put_traction

   end subroutine put_tractions

   !> Whether a run has this picture: the deck asks for its joints and there are some.
   pure logical function has_joint_plot(model, results)
      type(model_t), intent(in) :: model            !< what its steps ask for
      type(results_t), intent(in) :: results        !< last frame of the run

      has_joint_plot = model%steps(results%step)%requests%joints .and. allocated(results%joints)
      if (has_joint_plot) has_joint_plot = size(results%joints) > 0
   end function has_joint_plot

   !> Writes joints.dat and joints.gp beside mesh.dat.
   subroutine write_joint_plot(plots, drawing)
      type(plots_t), intent(inout), target :: plots !< get data and script
      type(drawing_t), intent(in) :: drawing        !< that of the mesh, with joints
      type(symbols_t) :: symbols
      type(string_t), allocatable :: curves(:)
      real(wp) :: share(size(drawing%results%joints)), smaller, largest
      integer(ip) :: i

      associate (joints => drawing%results%joints)
         largest = max(0.0_wp, maxval(joints%n, mask=.not. is_nan(joints%n)))
         share = 0.0_wp
         where (.not. is_nan(joints%place(1))) share = joints%n/largest
         smaller = min(1.0_wp, max(0.45_wp, sqrt(MANY_JOINTS/real(max(1, size(joints)), wp))))
         call begin_symbols(plots, JOINT_PLOT, 'joints by state, the line of thrust by width, places of the resultants; '// &
                            'columns: x [L]  y [L]  u1 [L]  u2 [L], and n over the largest n of the places', drawing, symbols)
         call put_states(drawing%results, symbols)
         call put_thrust(joints, share, symbols)
         call begin_block(symbols, 'places of the resultants', ':(marker*(0.15 + 0.85*sqrt($5)))', &
                          'with points pt 7 ps variable lc rgb "black" title "line of thrust, n up to '//to_text(largest, 4) &
                          //' [F]"')
         do i = 1, size(joints, kind=ip)
            if (share(i) >= LEAST_SHARE) call put_point(symbols, joints(i)%u, joints(i)%place, [share(i)])
         end do
         call end_symbols(symbols)
      end associate
      call begin_script(plots, JOINT_PLOT, 'the joints and the line of thrust', &
                        'Columns of '//MESH_PLOT//'.dat and '//JOINT_PLOT//'.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; '// &
                        '5 n over the largest n')
      call put_head(plots, drawing, '')
      call put_plane(plots, drawing)
      call put_title(plots, scale_title(drawing))
      call put(plots, 'marker = '//to_text(2.0_wp*smaller, 3)//'*dot'//LF//'thrust_width = '//to_text(0.8_wp*smaller, 3)//LF// &
               'joint_width = '//to_text(2.0_wp + 2.0_wp*smaller, 3))
      call add_lines(MESH_PLOT, drawing%n_inner, drawing%lines%n_runs - 1, 'ls 30 title "undeformed"', curves, '1:2')
      call add_lines(MESH_PLOT, drawing%n_inner, drawing%lines%n_runs - 1, 'lt 1 lw 1 lc rgb "#707070"', curves)
      call add_rigid_lines(MESH_PLOT, drawing, 'ls 31', .false., curves)
      call put_plot(plots, [curves, symbols%curves])
   end subroutine write_joint_plot

   !> A block a state: what its points have of the joints, from middle to middle between the points.
   subroutine put_states(results, symbols)
      type(results_t), intent(in) :: results
      type(symbols_t), intent(inout) :: symbols
      real(wp) :: v(4, 3)
      character(len=:), allocatable :: word
      integer(ip) :: state, i, j
      integer :: first, last

      do state = 0, N_STATES - 1
         word = trim(STATE_WORD(state))
         call begin_block(symbols, word, '', 'with lines lt 1 '//trim(STATE_DASH(state))//' lw joint_width lc rgb "'// &
                          COLOUR(STATE_COLOUR(state))//'" title "'//word//'"')
         do i = 1, size(results%contact, kind=ip)
            associate (contact => results%contact(i))
               do j = 1, contact%n
                  if (state_of(contact%status(j), contact%has_friction) /= state) cycle
                  first = merge(1, 2, contact%follows(j))
                  last = 2
                  if (j < contact%n) last = merge(3, 2, contact%follows(j + 1))
                  v(:, 2) = at_point(contact, j)
                  if (first == 1) v(:, 1) = 0.5_wp*(at_point(contact, j - 1) + v(:, 2))
                  if (last == 3) v(:, 3) = 0.5_wp*(v(:, 2) + at_point(contact, j + 1))
                  call put_path(symbols, v(3:, first:last), v(:2, first:last))
               end do
            end associate
         end do
      end do
   end subroutine put_states

   pure function at_point(contact, j) result(v)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: j
      real(wp) :: v(4)

      v = [contact%x(:, j), contact%u(:, j)]
   end function at_point

   !> A block a width: pieces from the places of a body's joints to their mean.
   subroutine put_thrust(joints, share, symbols)
      type(joint_t), intent(in) :: joints(:)
      real(wp), intent(in) :: share(:)              !< n over the largest n; 0 for a joint that is open
      type(symbols_t), intent(inout) :: symbols
      real(wp), allocatable :: mean(:, :)
      integer(ip), allocatable :: n_joints(:)
      integer(ip) :: width, i, side

      call find_means(joints, share, mean, n_joints)
      do width = 1, N_WIDTHS
         call begin_block(symbols, 'line of thrust, width '//to_text(width), '', 'with lines lt 1 lw '//to_text(width)// &
                          '*thrust_width lc rgb "black"')
         do i = 1, size(joints, kind=ip)
            if (share(i) < LEAST_SHARE .or. min(N_WIDTHS, int(share(i)*N_WIDTHS, ip) + 1) /= width) cycle
            do side = 1, 2
               associate (body => joints(i)%bodies(side))
                  if (body == 0) cycle
                  if (n_joints(body) < 2) cycle
                  call put_path(symbols, reshape([joints(i)%u, mean(3:, body)], [2, 2]), &
                                reshape([joints(i)%place, mean(:2, body)], [2, 2]))
               end associate
            end do
         end do
      end do
   end subroutine put_thrust

   !> The mean place and displacement of each body's joints, weighted by n, and how many they are.
   pure subroutine find_means(joints, share, mean, n_joints)
      type(joint_t), intent(in) :: joints(:)
      real(wp), intent(in) :: share(:)
      real(wp), allocatable, intent(out) :: mean(:, :)      !< (4, bodies that have joints, and others)
      integer(ip), allocatable, intent(out) :: n_joints(:)
      real(wp), allocatable :: total(:)
      integer(ip) :: i, side, n

      n = 0
      do i = 1, size(joints, kind=ip)
         n = max(n, maxval(joints(i)%bodies))
      end do
      allocate (mean(4, n), total(n), source=0.0_wp)
      allocate (n_joints(n), source=0_ip)
      do i = 1, size(joints, kind=ip)
         if (share(i) < LEAST_SHARE) cycle
         do side = 1, 2
            associate (body => joints(i)%bodies(side))
               if (body == 0) cycle
               n_joints(body) = n_joints(body) + 1
               total(body) = total(body) + joints(i)%n
               mean(:, body) = mean(:, body) + joints(i)%n/total(body)*([joints(i)%place, joints(i)%u] - mean(:, body))
            end associate
         end do
      end do
   end subroutine find_means

end module atrito_force_plots
