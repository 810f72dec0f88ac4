!> The picture of the joints: where they are open, stick and slip, and the line of thrust, over the outlines of the bodies.
!>
!> The line of thrust goes through the places of the joints' resultants. Within a body the places of its joints are joined to their
!> mean, weighted by n: a straight line for two joints, a star for more. The script reads mesh.dat for the outlines.
module atrito_joint_plot
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_status, only: status_t
   use atrito_files, only: file_set_t, text_file_t, open_text, put_line, close_text
   use atrito_mesh_plot, only: outline_t, find_outline, put_place
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_results, only: results_t, joint_t, contact_result_t, POINT_OPEN, POINT_STICK, POINT_SLIP
   use atrito_table, only: origin_t
   use atrito_plot_files, only: JOINT_PLOT, MESH_PLOT
   use atrito_plot_text, only: padded, range_text, quoted, picture_title, put_top, put_terminal, COLOUR, TIMES, LOOP_END
   implicit none (type, external)
   private
   public :: write_joint_plot, has_joint_plot

   integer(ip), parameter :: N_STATES = 4, STATE_CLOSED = 3 !< closed: without friction
   character(len=6), parameter :: STATE_WORD(0:N_STATES - 1) = ['open  ', 'stick ', 'slip  ', 'closed']
   integer, parameter :: STATE_COLOUR(0:N_STATES - 1) = [5, 3, 2, 6]
   integer(ip), parameter :: N_WIDTHS = 5           !< of the line of thrust
   real(wp), parameter :: LEAST_SHARE = 1.0e-3_wp   !< of the largest n; a joint with less is not on the line of thrust
   real(wp), parameter :: MANY_JOINTS = 40.0_wp     !< from here on markers and lines are smaller
   integer, parameter :: DIGITS = 7

   !> What joints.dat holds: a block a state, a block a width, and one of places, those that are there.
   type :: blocks_t
      logical :: state(0:N_STATES - 1) = .false.
      logical :: width(N_WIDTHS) = .false.
      logical :: places = .false.
   end type blocks_t

contains

   !> Whether a run has this picture: the deck asks for its joints and there are some.
   pure logical function has_joint_plot(model, results)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results

      has_joint_plot = model%requests%joints .and. allocated(results%joints)
      if (has_joint_plot) has_joint_plot = size(results%joints) > 0
   end function has_joint_plot

   !> Writes joints.dat and joints.gp into the set of the plots' folder, which has mesh.dat.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_joint_plot(set, model, results, origin, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results        !< with joints
      type(origin_t), intent(in) :: origin
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(blocks_t) :: blocks
      type(outline_t) :: outline

      call find_outline(model, results, outline)
      call open_text(set, JOINT_PLOT//'.dat', file)
      call put_line(file, '# joints by state, the line of thrust by width, places of the resultants; columns: '// &
                    'x [L]  y [L]  u1 [L]  u2 [L], and n over the largest n of the places')
      call put_states(file, results, blocks)
      call put_thrust(file, results, blocks)
      call put_places(file, results%joints, blocks)
      call close_text(file, status)
      if (status%code == 0) call write_script(set, results, origin, outline, blocks, status)
   end subroutine write_joint_plot

   !> The state of a point; a closed one of a pair without friction neither sticks nor slips.
   elemental integer(ip) function state_of(status, has_friction) result(state)
      integer(ip), intent(in) :: status             !< POINT_*
      logical, intent(in) :: has_friction

      state = status
      if (status /= POINT_OPEN .and. .not. has_friction) state = STATE_CLOSED
   end function state_of

   !> A block a state: what its points have of the joints, from middle to middle between the points.
   subroutine put_states(file, results, blocks)
      type(text_file_t), intent(inout) :: file
      type(results_t), intent(in) :: results
      type(blocks_t), intent(inout) :: blocks
      integer(ip) :: state, i, j

      do state = 0, N_STATES - 1
         do i = 1, size(results%contact, kind=ip)
            associate (contact => results%contact(i))
               do j = 1, contact%n
                  if (state_of(contact%status(j), contact%has_friction) /= state) cycle
                  if (.not. blocks%state(state)) call put_line(file, '# '//trim(STATE_WORD(state)))
                  blocks%state(state) = .true.
                  call put_share(file, contact, j)
               end do
            end associate
         end do
         if (blocks%state(state)) call put_line(file, '')
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
   subroutine put_thrust(file, results, blocks)
      type(text_file_t), intent(inout) :: file
      type(results_t), intent(in) :: results
      type(blocks_t), intent(inout) :: blocks
      real(wp), allocatable :: mean(:, :)
      integer(ip), allocatable :: held_by(:)
      integer(ip) :: width, i, side

      call find_means(results%joints, mean, held_by)
      do width = 1, N_WIDTHS
         do i = 1, size(results%joints, kind=ip)
            if (width_of(results%joints, i) /= width) cycle
            do side = 1, 2
               associate (body => results%joints(i)%bodies(side))
                  if (body == 0) cycle
                  if (held_by(body) < 2) cycle
                  if (.not. blocks%width(width)) call put_line(file, '# line of thrust, width '//to_text(width))
                  blocks%width(width) = .true.
                  call put_place(file, at_joint(results%joints(i)))
                  call put_place(file, mean(:, body))
                  call put_line(file, '')
               end associate
            end do
         end do
         if (blocks%width(width)) call put_line(file, '')
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
      integer(ip) :: i

      largest = 0.0_wp
      do i = 1, size(joints, kind=ip)
         if (.not. is_nan(joints(i)%n)) largest = max(largest, joints(i)%n)
      end do
   end function largest_n

   !> The last block: places of the resultants, with n over the largest n.
   subroutine put_places(file, joints, blocks)
      type(text_file_t), intent(inout) :: file
      type(joint_t), intent(in) :: joints(:)
      type(blocks_t), intent(inout) :: blocks
      integer(ip) :: i

      do i = 1, size(joints, kind=ip)
         if (width_of(joints, i) == 0) cycle
         if (.not. blocks%places) call put_line(file, '# places of the resultants')
         blocks%places = .true.
         call put_place(file, at_joint(joints(i)), trimmed_real(share_of(joints, i), DIGITS))
      end do
   end subroutine put_places

   subroutine write_script(set, results, origin, outline, blocks, status)
      type(file_set_t), intent(inout) :: set
      type(results_t), intent(in) :: results
      type(origin_t), intent(in) :: origin
      type(outline_t), intent(in) :: outline
      type(blocks_t), intent(in) :: blocks
      type(status_t), intent(out) :: status
      type(text_file_t) :: file

      call open_text(set, JOINT_PLOT//'.gp', file)
      call put_top(file, JOINT_PLOT, 'the joints and the line of thrust')
      call put_line(file, '# Columns of '//MESH_PLOT//'.dat and '//JOINT_PLOT//'.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; '// &
                    '5 n over the largest n')
      call put_line(file, 'scale = '//to_text(outline%scale)//'   # of the displacements; change it here')
      call put_line(file, 'moved = "($1 + scale*$3):($2 + scale*$4)"')
      call put_line(file, 'heading = '//quoted(picture_title(origin)))
      call put_line(file, 'set xrange '//range_text(padded(outline%window(1))))
      call put_line(file, 'set yrange '//range_text(padded(outline%window(2))))
      call put_line(file, 'height = '//outline%height)
      call put_terminal(file, JOINT_PLOT, '1000,height')
      call put_line(file, 'set size ratio -1')
      call put_line(file, 'set border lt 1 lw 1 lc rgb "#A0A0A0"')
      call put_line(file, 'set tics nomirror out scale 0.6 textcolor rgb "black" format "%h"')
      call put_line(file, 'set key noautotitle outside bottom center horizontal Left reverse samplen 2 height 0.7')
      call put_line(file, 'set xlabel "x [L]"')
      call put_line(file, 'set ylabel "y [L]"')
      call put_line(file, 'set tmargin 4')
      call put_line(file, 'set label 1 heading.sprintf("\ndisplacements drawn %g '//TIMES//', the largest is %g [L]", scale, '// &
                    to_text(outline%largest, 4)//') at screen 0.5, screen 1 - 22.0/height center noenhanced')
      call put_line(file, 'marker = '//to_text(2.0_wp*size_share(results%joints), 3)//'*dot')
      call put_line(file, 'thrust_width = '//to_text(0.8_wp*size_share(results%joints), 3))
      call put_line(file, 'joint_width = '//to_text(2.0_wp + 2.0_wp*size_share(results%joints), 3))
      call put_curves(file, results, outline, blocks)
      call put_line(file, LOOP_END)
      call put_line(file, 'set output')
      call close_text(file, status)
   end subroutine write_script

   !> Markers and joints are drawn smaller where there are many.
   pure real(wp) function size_share(joints)
      type(joint_t), intent(in) :: joints(:)

      size_share = min(1.0_wp, max(0.45_wp, sqrt(MANY_JOINTS/real(max(1, size(joints)), wp))))
   end function size_share

   !> One plot: outlines, undeformed and deformed, rigid surfaces, joints by state, the line of thrust and its places.
   subroutine put_curves(file, results, outline, blocks)
      type(text_file_t), intent(inout) :: file
      type(results_t), intent(in) :: results
      type(outline_t), intent(in) :: outline
      type(blocks_t), intent(in) :: blocks
      type(string_t), allocatable :: curves(:)
      character(len=:), allocatable :: outlines
      integer(ip) :: k

      outlines = '"'//MESH_PLOT//'.dat" index '//to_text(outline%first)//':'//to_text(outline%last)
      call append_string(curves, 'plot '//outlines//' using 1:2 with lines lt 1 lw 1 lc rgb "#C8C8C8" title "undeformed"')
      call append_string(curves, '   '//outlines//' using @moved with lines lt 1 lw 1 lc rgb "#707070"')
      if (outline%n_rigid > 0) then
         call append_string(curves, '   "'//MESH_PLOT//'.dat" index '//to_text(outline%last + 1)//':'// &
                            to_text(outline%last + outline%n_rigid)//' using 1:2 with lines lt 1 lw 4 lc rgb "#404040"')
      end if
      call add_joint_curves(results, blocks, curves)
      do k = 1, size(curves, kind=ip) - 1
         call put_line(file, curves(k)%s//', \')
      end do
      call put_line(file, curves(size(curves))%s)
   end subroutine put_curves

   !> The curves of joints.dat, block by block.
   subroutine add_joint_curves(results, blocks, curves)
      type(results_t), intent(in) :: results
      type(blocks_t), intent(in) :: blocks
      type(string_t), allocatable, intent(inout) :: curves(:)
      character(len=*), parameter :: BLOCK_OF = '   "'//JOINT_PLOT//'.dat" index '
      integer(ip) :: k, block

      block = 0
      do k = 0, N_STATES - 1
         if (.not. blocks%state(k)) cycle
         call append_string(curves, BLOCK_OF//to_text(block)//' using @moved with lines lt 1 lw joint_width lc rgb "'// &
                            COLOUR(STATE_COLOUR(k))//'" title "'//trim(STATE_WORD(k))//'"')
         block = block + 1
      end do
      do k = 1, N_WIDTHS
         if (.not. blocks%width(k)) cycle
         call append_string(curves, BLOCK_OF//to_text(block)//' using @moved with lines lt 1 lw '// &
                            to_text(k)//'*thrust_width lc rgb "black"')
         block = block + 1
      end do
      if (.not. blocks%places) return
      call append_string(curves, BLOCK_OF//to_text(block)//' using @moved:(marker*(0.15 + 0.85*sqrt($5))) with points pt 7 '// &
                         'ps variable lc rgb "black" title "line of thrust, n up to '// &
                         to_text(largest_n(results%joints), 4)//' [F]"')
   end subroutine add_joint_curves

end module atrito_joint_plot
