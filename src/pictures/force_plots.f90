!> What the contact transmits, over the outlines of the bodies: its tractions upon the slaves, as arrows; and the joints, where they
!> are open, stick and slip, with the line of thrust.
!>
!> The line of thrust goes through the places of the joints' resultants. Within a body the places of its joints are joined to their
!> mean, weighted by n: a straight line for two joints, a star for more. The scripts read mesh.dat for the outlines.
module atrito_force_plots
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_contact_plot, only: state_of, N_STATES, STATE_WORD, STATE_COLOUR
   use atrito_drawing, only: drawing_t, put_place, put_head, put_plane, put_title, add_lines, add_rigid_lines, displacement_text, &
                             largest_length, MOVED, scale_title
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: TRACTION_PLOT, MESH_PLOT, JOINT_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_data, begin_script, put_plot
   use atrito_plot_text, only: range_t, cover, COLOUR, LF
   use atrito_results, only: results_t, contact_result_t, joint_t
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_summary, only: pair_count
   implicit none (type, external)
   private
   public :: has_traction_plot, write_traction_plot, traction, arrow_stride, has_joint_plot, write_joint_plot

   integer(ip), parameter :: MOST_ARROWS = 3000
   real(wp), parameter :: LONGEST = 0.12_wp         !< arrow, as a share of the scene's diagonal; shorter where there are many
   real(wp), parameter :: MANY = 150.0_wp, SHORTEST = 0.25_wp !< points from which on they are, down to this share of it
   integer, parameter :: ARROW_DIGITS = 6

   integer(ip), parameter :: N_WIDTHS = 5           !< of the line of thrust
   real(wp), parameter :: LEAST_SHARE = 1.0e-3_wp   !< of the largest n; a joint with less is not on the line of thrust
   real(wp), parameter :: MANY_JOINTS = 40.0_wp     !< from here on markers and lines are smaller
   integer, parameter :: DIGITS = 7

contains

   !> Whether something is transmitted.
   pure logical function has_traction_plot(results)
      type(results_t), intent(in) :: results

      has_traction_plot = largest_traction(results) > 0.0_wp
   end function has_traction_plot

   !> The traction upon the slave at a point: -p n + sigma_T T, T being n turned by +90 degrees [F/L^2].
   pure function traction(contact, j) result(t)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: j
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

   !> Of many points each so manieth has an arrow.
   pure integer(ip) function arrow_stride(n_points) result(stride)
      integer(ip), intent(in) :: n_points

      stride = (n_points + MOST_ARROWS - 1)/MOST_ARROWS
   end function arrow_stride

   !> Writes tractions.dat and tractions.gp beside mesh.dat.
   subroutine write_traction_plot(plots, drawing)
      type(plots_t), intent(inout) :: plots
      type(drawing_t), intent(inout) :: drawing     !< that of the mesh; its window has room for the arrows while this is written
      type(string_t), allocatable :: curves(:)
      type(range_t) :: window(2)
      character(len=:), allocatable :: fewer
      real(wp) :: shorter, arrow, largest
      integer(ip) :: i, n_points
      logical :: has_state(0:N_STATES - 1)

      n_points = sum(drawing%results%contact%n)
      largest = largest_traction(drawing%results)
      shorter = max(SHORTEST, min(1.0_wp, sqrt(MANY/n_points)))     ! so that arrows do not hide each other
      arrow = LONGEST*shorter*drawing%size/largest
      window = drawing%window
      call write_tractions(plots, drawing, arrow, arrow_stride(n_points), has_state)
      call begin_script(plots, TRACTION_PLOT, 'the tractions of the contact upon the slaves', &
                        'Columns of '//TRACTION_PLOT//'.dat and of '//MESH_PLOT//'.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L];'// &
                        LF//'# 5, 6 traction upon the slave [F/L^2], 7 state (0 open, 1 stick, 2 slip, 3 closed without friction)')
      call put_head(plots, drawing, 'arrow = '//to_text(arrow, ARROW_DIGITS)// &
                    '   # length of a traction of one; change it here'//LF)
      call put_plane(plots, drawing)
      fewer = ''
      if (arrow_stride(n_points) > 1) fewer = ', one of '//to_text(arrow_stride(n_points))//' points'
      call put_title(plots, '"\ntractions upon the slaves, up to '//to_text(largest, 4)//' [F/L^2]'//fewer//'; '// &
                     displacement_text(drawing%scale)//'"')
      call put(plots, 'head = '//to_text(0.003_wp + 0.005_wp*shorter, 3)//'   # length of the arrows'' heads')
      allocate (curves(0))
      call add_lines(MESH_PLOT, drawing%n_inner, drawing%lines%n_runs - 1, 'lt 1 lw 1.2 lc rgb "#808080"', curves)
      call add_rigid_lines(MESH_PLOT, drawing, 'lt 1 lw 4 lc rgb "#404040"', .false., curves)
      do i = 0, N_STATES - 1
         if (has_state(i)) call append_string(curves, '"'//TRACTION_PLOT//'.dat" using '//MOVED//':($7 == '//to_text(i)// &
                                              ' ? arrow*$5 : NaN):(arrow*$6) with vectors filled size screen head,18 lt 1'// &
                                              ' lw 1.2 lc rgb "'//COLOUR(STATE_COLOUR(i))//'" title "'//trim(STATE_WORD(i))//'"')
      end do
      call put_plot(plots, curves)
      drawing%window = window
   end subroutine write_traction_plot

   !> Points with their tractions. The window is widened to their arrows.
   subroutine write_tractions(plots, drawing, arrow, stride, has_state)
      type(plots_t), intent(inout) :: plots
      type(drawing_t), intent(inout) :: drawing
      real(wp), intent(in) :: arrow                 !< length of a traction of one [L]
      integer(ip), intent(in) :: stride             !< one of so many points has an arrow
      logical, intent(out) :: has_state(0:)
      real(wp) :: t(2), tip(2)
      integer(ip) :: pair, j, i, state, n

      call begin_data(plots, TRACTION_PLOT, &
                      'columns: x [L]  y [L]  u1 [L]  u2 [L]  traction upon the slave along x and y [F/L^2]  state')
      has_state = .false.
      n = 0
      do pair = 1, pair_count(drawing%results)
         associate (contact => drawing%results%contact(pair))
            do j = 1, contact%n
               t = traction(contact, j)
               if (.not. all(ieee_is_finite(t))) cycle
               if (all(abs(t) <= 0.0_wp)) cycle
               n = n + 1
               if (mod(n - 1, stride) > 0) cycle
               state = state_of(contact%status(j), contact%has_friction)
               has_state(state) = .true.
               tip = contact%x(:, j) + drawing%scale*contact%u(:, j) + arrow*t
               do i = 1, 2
                  call cover(drawing%window(i), tip(i:i))
               end do
               call put_place(plots, [contact%x(:, j), contact%u(:, j)], trimmed_real(t(1), ARROW_DIGITS)//' '// &
                              trimmed_real(t(2), ARROW_DIGITS)//' '//to_text(state))
            end do
         end associate
      end do
   end subroutine write_tractions

   !> Whether a run has this picture: the deck asks for its joints and there are some.
   pure logical function has_joint_plot(model, results)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results

      has_joint_plot = model%steps(results%step)%requests%joints .and. allocated(results%joints)
      if (has_joint_plot) has_joint_plot = size(results%joints) > 0
   end function has_joint_plot

   !> Writes joints.dat and joints.gp beside mesh.dat.
   subroutine write_joint_plot(plots, drawing)
      type(plots_t), intent(inout) :: plots
      type(drawing_t), intent(in) :: drawing        !< that of the mesh, with joints
      type(string_t), allocatable :: lines(:), curves(:)    ! curves: of joints.dat, one a block
      real(wp) :: share(size(drawing%results%joints)), smaller, largest

      associate (joints => drawing%results%joints)
         largest = max(0.0_wp, maxval(joints%n, mask=.not. is_nan(joints%n)))
         share = 0.0_wp
         where (.not. is_nan(joints%place(1))) share = joints%n/largest
         smaller = min(1.0_wp, max(0.45_wp, sqrt(MANY_JOINTS/real(max(1, size(joints)), wp))))
         call begin_data(plots, JOINT_PLOT, 'joints by state, the line of thrust by width, places of the resultants; columns: '// &
                         'x [L]  y [L]  u1 [L]  u2 [L], and n over the largest n of the places')
         allocate (curves(0))
         call put_states(plots, drawing%results, curves)
         call put_thrust(plots, joints, share, curves)
         call put_places(plots, joints, share, 'n up to '//to_text(largest, 4)//' [F]', curves)
      end associate
      call begin_script(plots, JOINT_PLOT, 'the joints and the line of thrust', &
                        'Columns of '//MESH_PLOT//'.dat and '//JOINT_PLOT//'.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; '// &
                        '5 n over the largest n')
      call put_head(plots, drawing, 'moved = "'//MOVED//'"'//LF)
      call put_plane(plots, drawing)
      call put_title(plots, scale_title(drawing))
      call put(plots, 'marker = '//to_text(2.0_wp*smaller, 3)//'*dot'//LF//'thrust_width = '//to_text(0.8_wp*smaller, 3)//LF// &
               'joint_width = '//to_text(2.0_wp + 2.0_wp*smaller, 3))
      lines = outlines(drawing)                     ! gfortran 12 loses what a function in an array constructor allocates
      call put_plot(plots, [lines, curves])
   end subroutine write_joint_plot

   !> The outlines, undeformed and deformed, and rigid surfaces.
   pure function outlines(drawing) result(curves)
      type(drawing_t), intent(in) :: drawing
      type(string_t), allocatable :: curves(:)
      character(len=:), allocatable :: lines

      lines = '"'//MESH_PLOT//'.dat" index '//to_text(drawing%n_inner)//':'//to_text(drawing%lines%n_runs - 1)
      call append_string(curves, lines//' using 1:2 with lines lt 1 lw 1 lc rgb "#C8C8C8" title "undeformed"')
      call append_string(curves, lines//' using @moved with lines lt 1 lw 1 lc rgb "#707070"')
      associate (n => drawing%lines%n_runs, n_rigid => size(drawing%surface, kind=ip))
         if (n_rigid > 0) call append_string(curves, '"'//MESH_PLOT//'.dat" index '//to_text(n)//':'//to_text(n + n_rigid - 1)// &
                                             ' using 1:2 with lines lt 1 lw 4 lc rgb "#404040"')
      end associate
   end function outlines

   !> A block a state: what its points have of the joints, from middle to middle between the points.
   subroutine put_states(plots, results, curves)
      type(plots_t), intent(inout) :: plots
      type(results_t), intent(in) :: results
      type(string_t), allocatable, intent(inout) :: curves(:)
      character(len=:), allocatable :: word
      integer(ip) :: state, i, j
      logical :: begun

      do state = 0, N_STATES - 1
         begun = .false.
         word = trim(STATE_WORD(state))
         do i = 1, size(results%contact, kind=ip)
            associate (contact => results%contact(i))
               do j = 1, contact%n
                  if (state_of(contact%status(j), contact%has_friction) /= state) cycle
                  call begin_block(plots, word, ' using @moved with lines lt 1 lw joint_width lc rgb "'// &
                                   COLOUR(STATE_COLOUR(state))//'" title "'//word//'"', begun, curves)
                  if (contact%follows(j)) call put_place(plots, 0.5_wp*(at_point(contact, j - 1) + at_point(contact, j)))
                  call put_place(plots, at_point(contact, j))
                  if (j < contact%n) then
                     if (contact%follows(j + 1)) call put_place(plots, 0.5_wp*(at_point(contact, j) + at_point(contact, j + 1)))
                  end if
                  call put(plots, '')
               end do
            end associate
         end do
         if (begun) call put(plots, '')
      end do
   end subroutine put_states

   pure function at_point(contact, j) result(v)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: j
      real(wp) :: v(4)

      v = [contact%x(:, j), contact%u(:, j)]
   end function at_point

   !> A block a width: pieces from the places of a body's joints to their mean.
   subroutine put_thrust(plots, joints, share, curves)
      type(plots_t), intent(inout) :: plots
      type(joint_t), intent(in) :: joints(:)
      real(wp), intent(in) :: share(:)              !< n over the largest n; 0 for a joint that is open
      type(string_t), allocatable, intent(inout) :: curves(:)
      real(wp), allocatable :: mean(:, :)
      integer(ip), allocatable :: n_joints(:)
      integer(ip) :: width, i, side
      logical :: begun

      call find_means(joints, share, mean, n_joints)
      do width = 1, N_WIDTHS
         begun = .false.
         do i = 1, size(joints, kind=ip)
            if (share(i) < LEAST_SHARE .or. min(N_WIDTHS, int(share(i)*N_WIDTHS, ip) + 1) /= width) cycle
            do side = 1, 2
               associate (body => joints(i)%bodies(side))
                  if (body == 0) cycle
                  if (n_joints(body) < 2) cycle
                  call begin_block(plots, 'line of thrust, width '//to_text(width), ' using @moved with lines lt 1 lw '// &
                                   to_text(width)//'*thrust_width lc rgb "black"', begun, curves)
                  call put_place(plots, [joints(i)%place, joints(i)%u])
                  call put_place(plots, mean(:, body))
                  call put(plots, '')
               end associate
            end do
         end do
         if (begun) call put(plots, '')
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

   !> The last block: places of the resultants, with n over the largest n.
   subroutine put_places(plots, joints, share, legend, curves)
      type(plots_t), intent(inout) :: plots
      type(joint_t), intent(in) :: joints(:)
      real(wp), intent(in) :: share(:)
      character(len=*), intent(in) :: legend
      type(string_t), allocatable, intent(inout) :: curves(:)
      integer(ip) :: i
      logical :: begun

      begun = .false.
      do i = 1, size(joints, kind=ip)
         if (share(i) < LEAST_SHARE) cycle
         call begin_block(plots, 'places of the resultants', ' using @moved:(marker*(0.15 + 0.85*sqrt($5)))'// &
                          ' with points pt 7 ps variable lc rgb "black" title "line of thrust, '//legend//'"', begun, curves)
         call put_place(plots, [joints(i)%place, joints(i)%u], trimmed_real(share(i), DIGITS))
      end do
   end subroutine put_places

   !> Begins a block of joints.dat unless it is begun, and adds the curve that it is.
   subroutine begin_block(plots, what, curve, begun, curves)
      type(plots_t), intent(inout) :: plots
      character(len=*), intent(in) :: what, curve
      logical, intent(inout) :: begun
      type(string_t), allocatable, intent(inout) :: curves(:)

      if (begun) return
      begun = .true.
      call put(plots, '# '//what)
      call append_string(curves, '"'//JOINT_PLOT//'.dat" index '//to_text(size(curves, kind=ip))//curve)
   end subroutine begin_block

end module atrito_force_plots
