!> The picture of the joints: where they are open, stick and slip, and the line of thrust, over the outlines of the bodies.
!>
!> The line of thrust goes through the places of the joints' resultants. Within a body the places of its joints are joined to their
!> mean, weighted by n: a straight line for two joints, a star for more. The script reads mesh.dat for the outlines.
module atrito_joint_plot
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_status, only: status_t
   use atrito_contact_plot, only: state_of, N_STATES, STATE_WORD, STATE_COLOUR
   use atrito_files, only: file_set_t, text_file_t, put_line, close_text
   use atrito_mesh_lines, only: drawing_t, put_place, put_frame, is_drawn_rigid, LINE_INNER
   use atrito_mesh_plot, only: put_heading
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_results, only: results_t, joint_t, contact_result_t
   use atrito_write_tables, only: origin_of
   use atrito_plot_files, only: open_data, JOINT_PLOT, MESH_PLOT
   use atrito_plot_text, only: quoted, picture_title, begin_script, end_script, put_plot, COLOUR
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

   !> Writes joints.dat and joints.gp into the set of the plots' folder, which has mesh.dat.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_joint_plot(set, model, results, drawing, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results        !< with joints
      type(drawing_t), intent(in) :: drawing        !< that of the mesh
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(string_t), allocatable :: curves(:)      !< of joints.dat, one a block

      call open_data(set, JOINT_PLOT, file)
      call put_line(file, '# joints by state, the line of thrust by width, places of the resultants; columns: '// &
                    'x [L]  y [L]  u1 [L]  u2 [L], and n over the largest n of the places')
      allocate (curves(0))
      call put_states(file, results, curves)
      call put_thrust(file, results, curves)
      call put_places(file, results%joints, curves)
      call close_text(file, status)
      if (status%code == 0) call write_script(set, model, results, drawing, curves, status)
   end subroutine write_joint_plot

   !> A block a state: what its points have of the joints, from middle to middle between the points.
   subroutine put_states(file, results, curves)
      type(text_file_t), intent(inout) :: file
      type(results_t), intent(in) :: results
      type(string_t), allocatable, intent(inout) :: curves(:)
      integer(ip) :: state, i, j
      logical :: begun

      do state = 0, N_STATES - 1
         begun = .false.
         do i = 1, size(results%contact, kind=ip)
            associate (contact => results%contact(i))
               do j = 1, contact%n
                  if (state_of(contact%status(j), contact%has_friction) /= state) cycle
                  if (.not. begun) call begin_block(file, trim(STATE_WORD(state)), ' using @moved with lines lt 1 lw'// &
                                                    ' joint_width lc rgb "'//COLOUR(STATE_COLOUR(state))//'" title "'// &
                                                    trim(STATE_WORD(state))//'"', curves)
                  begun = .true.
                  call put_share(file, contact, j)
               end do
            end associate
         end do
         if (begun) call put_line(file, '')
      end do
   end subroutine put_states

   subroutine put_share(file, contact, j)
      type(text_file_t), intent(inout) :: file
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: j

      if (contact%follows(j)) call put_place(file, 0.5_wp*(at_point(contact, j - 1) + at_point(contact, j)))
      call put_place(file, at_point(contact, j))
      if (j < contact%n) then
         if (contact%follows(j + 1)) call put_place(file, 0.5_wp*(at_point(contact, j) + at_point(contact, j + 1)))
      end if
      call put_line(file, '')
   end subroutine put_share

   pure function at_point(contact, j) result(v)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: j
      real(wp) :: v(4)

      v = [contact%x(:, j), contact%u(:, j)]
   end function at_point

   !> A block a width: pieces from the places of a body's joints to their mean.
   subroutine put_thrust(file, results, curves)
      type(text_file_t), intent(inout) :: file
      type(results_t), intent(in) :: results
      type(string_t), allocatable, intent(inout) :: curves(:)
      real(wp), allocatable :: mean(:, :)
      integer(ip), allocatable :: held_by(:)
      integer(ip) :: width, i, side
      logical :: begun

      call find_means(results%joints, mean, held_by)
      do width = 1, N_WIDTHS
         begun = .false.
         do i = 1, size(results%joints, kind=ip)
            if (width_of(results%joints, i) /= width) cycle
            do side = 1, 2
               associate (body => results%joints(i)%bodies(side))
                  if (body == 0) cycle
                  if (held_by(body) < 2) cycle
                  if (.not. begun) call begin_block(file, 'line of thrust, width '//to_text(width), ' using @moved with lines'// &
                                                    ' lt 1 lw '//to_text(width)//'*thrust_width lc rgb "black"', curves)
                  begun = .true.
                  call put_place(file, at_joint(results%joints(i)))
                  call put_place(file, mean(:, body))
                  call put_line(file, '')
               end associate
            end do
         end do
         if (begun) call put_line(file, '')
      end do
   end subroutine put_thrust

   !> The mean place and displacement of each body's joints, weighted by n, and how many they are.
   pure subroutine find_means(joints, mean, n_joints)
      type(joint_t), intent(in) :: joints(:)
      real(wp), allocatable, intent(out) :: mean(:, :)      !< (4, bodies that have joints, and others)
      integer(ip), allocatable, intent(out) :: n_joints(:)
      real(wp), allocatable :: total(:)
      real(wp) :: share
      integer(ip) :: i, side, n

      n = 0
      do i = 1, size(joints, kind=ip)
         n = max(n, maxval(joints(i)%bodies))
      end do
      allocate (mean(4, n), total(n), source=0.0_wp)
      allocate (n_joints(n), source=0_ip)
      do i = 1, size(joints, kind=ip)
         if (width_of(joints, i) == 0) cycle
         do side = 1, 2
            associate (body => joints(i)%bodies(side))
               if (body == 0) cycle
               n_joints(body) = n_joints(body) + 1
               total(body) = total(body) + joints(i)%n
               share = joints(i)%n/total(body)
               mean(:, body) = mean(:, body) + share*(at_joint(joints(i)) - mean(:, body))
            end associate
         end do
      end do
   end subroutine find_means

   pure function at_joint(joint) result(v)
      type(joint_t), intent(in) :: joint
      real(wp) :: v(4)

      v = [joint%place, joint%u]
   end function at_joint

   !> Width of the line of thrust at a joint, by its share of the largest n; 0: the joint is not on the line.
   pure integer(ip) function width_of(joints, i) result(width)
      type(joint_t), intent(in) :: joints(:)
      integer(ip), intent(in) :: i
      real(wp) :: share

      share = share_of(joints, i)
      width = 0
      if (share >= LEAST_SHARE) width = min(N_WIDTHS, int(share*N_WIDTHS, ip) + 1)
   end function width_of

   !> n over the largest n; 0 for a joint that is open.
   pure real(wp) function share_of(joints, i) result(share)
      type(joint_t), intent(in) :: joints(:)
      integer(ip), intent(in) :: i

      share = 0.0_wp
      if (is_nan(joints(i)%place(1))) return
      share = joints(i)%n/largest_n(joints)
   end function share_of

   pure real(wp) function largest_n(joints) result(largest)
      type(joint_t), intent(in) :: joints(:)

      largest = max(0.0_wp, maxval(joints%n, mask=.not. is_nan(joints%n)))
   end function largest_n

   !> The last block: places of the resultants, with n over the largest n.
   subroutine put_places(file, joints, curves)
      type(text_file_t), intent(inout) :: file
      type(joint_t), intent(in) :: joints(:)
      type(string_t), allocatable, intent(inout) :: curves(:)
      integer(ip) :: i
      logical :: begun

      begun = .false.
      do i = 1, size(joints, kind=ip)
         if (width_of(joints, i) == 0) cycle
         if (.not. begun) call begin_block(file, 'places of the resultants', ' using @moved:(marker*(0.15 + 0.85*sqrt($5)))'// &
                                           ' with points pt 7 ps variable lc rgb "black" title "line of thrust, n up to '// &
                                           to_text(largest_n(joints), 4)//' [F]"', curves)
         begun = .true.
         call put_place(file, at_joint(joints(i)), trimmed_real(share_of(joints, i), DIGITS))
      end do
   end subroutine put_places

   subroutine write_script(set, model, results, drawing, curves, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(drawing_t), intent(in) :: drawing
      type(string_t), intent(in) :: curves(:)
      type(status_t), intent(out) :: status
      type(text_file_t) :: file

      call begin_script(set, JOINT_PLOT, 'the joints and the line of thrust', file)
      call put_line(file, '# Columns of '//MESH_PLOT//'.dat and '//JOINT_PLOT//'.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; '// &
                    '5 n over the largest n')
      call put_line(file, 'scale = '//to_text(drawing%scale, 15)//'   # of the displacements; change it here')
      call put_line(file, 'moved = "($1 + scale*$3):($2 + scale*$4)"')
      call put_line(file, 'heading = '//quoted(picture_title(origin_of(model, results))))
      call put_frame(file, JOINT_PLOT, drawing%window, drawing%view)
      call put_heading(file, drawing)
      call put_line(file, 'marker = '//to_text(2.0_wp*size_share(results%joints), 3)//'*dot')
      call put_line(file, 'thrust_width = '//to_text(0.8_wp*size_share(results%joints), 3))
      call put_line(file, 'joint_width = '//to_text(2.0_wp + 2.0_wp*size_share(results%joints), 3))
      call put_curves(file, model, drawing, curves)
      call end_script(file, status)
   end subroutine write_script

   !> Markers and joints are drawn smaller where there are many.
   pure real(wp) function size_share(joints)
      type(joint_t), intent(in) :: joints(:)

      size_share = min(1.0_wp, max(0.45_wp, sqrt(MANY_JOINTS/real(max(1, size(joints)), wp))))
   end function size_share

   !> One plot: outlines, undeformed and deformed, rigid surfaces, joints by state, the line of thrust and its places.
   subroutine put_curves(file, model, drawing, joint_curves)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(drawing_t), intent(in) :: drawing
      type(string_t), intent(in) :: joint_curves(:)
      type(string_t), allocatable :: curves(:)
      character(len=:), allocatable :: outlines
      integer(ip) :: i, n, n_rigid

      n = drawing%lines%n_runs
      n_rigid = count([(is_drawn_rigid(model, i), i=1, size(model%surfaces, kind=ip))], kind=ip)
      outlines = '"'//MESH_PLOT//'.dat" index '//to_text(count(drawing%lines%kind(:n) == LINE_INNER, kind=ip))//':'//to_text(n - 1)
      call append_string(curves, 'plot '//outlines//' using 1:2 with lines lt 1 lw 1 lc rgb "#C8C8C8" title "undeformed"')
      call append_string(curves, '   '//outlines//' using @moved with lines lt 1 lw 1 lc rgb "#707070"')
      if (n_rigid > 0) call append_string(curves, '   "'//MESH_PLOT//'.dat" index '//to_text(n)//':'//to_text(n + n_rigid - 1)// &
                                          ' using 1:2 with lines lt 1 lw 4 lc rgb "#404040"')
      call put_plot(file, [curves, joint_curves])
   end subroutine put_curves

   !> Begins a block of joints.dat, and adds the curve that it is.
   subroutine begin_block(file, what, curve, curves)
      type(text_file_t), intent(inout) :: file
      character(len=*), intent(in) :: what, curve
      type(string_t), allocatable, intent(inout) :: curves(:)

      call put_line(file, '# '//what)
      call append_string(curves, '   "'//JOINT_PLOT//'.dat" index '//to_text(size(curves, kind=ip))//curve)
   end subroutine begin_block

end module atrito_joint_plot
