!> The picture of the joints: where they are open, stick and slip, and the line of thrust, over the outlines of the bodies.
!>
!> The line of thrust goes through the places of the joints' resultants. Within a body the places of its joints are joined to their
!> mean, weighted by n: a straight line for two joints, a star for more. The script reads mesh.dat for the outlines.
module atrito_joint_plot
   use atrito_contact_plot, only: state_of, N_STATES, STATE_WORD, STATE_COLOUR
   use atrito_drawing, only: drawing_t, put_place, put_head, put_plane, put_title, scale_title, MOVED
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: JOINT_PLOT, MESH_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_data, end_data, begin_script, end_script, put_plot
   use atrito_plot_text, only: COLOUR, LF
   use atrito_results, only: results_t, joint_t, contact_result_t
   use atrito_strings, only: string_t, append_string, to_text
   implicit none (type, external)
   private
   public :: write_joint_plot, has_joint_plot

   integer(ip), parameter :: N_WIDTHS = 5           !< of the line of thrust
   real(wp), parameter :: LEAST_SHARE = 1.0e-3_wp   !< of the largest n; a joint with less is not on the line of thrust
   real(wp), parameter :: MANY_JOINTS = 40.0_wp     !< from here on markers and lines are smaller
   integer, parameter :: DIGITS = 7

contains

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
      type(string_t), allocatable :: curves(:)      ! of joints.dat, one a block
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
         call end_data(plots)
      end associate
      call begin_script(plots, JOINT_PLOT, 'the joints and the line of thrust', &
                        'Columns of '//MESH_PLOT//'.dat and '//JOINT_PLOT//'.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; '// &
                        '5 n over the largest n')
      call put_head(plots, drawing, 'moved = "'//MOVED//'"'//LF)
      call put_plane(plots, drawing)
      call put_title(plots, scale_title(drawing))
      call put(plots, 'marker = '//to_text(2.0_wp*smaller, 3)//'*dot'//LF//'thrust_width = '//to_text(0.8_wp*smaller, 3)//LF// &
               'joint_width = '//to_text(2.0_wp + 2.0_wp*smaller, 3))
      call put_plot(plots, [outlines(drawing), curves])
      call end_script(plots)
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

end module atrito_joint_plot
