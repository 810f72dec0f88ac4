!> The picture that moves: the deformed bodies and the state of their contact, an image a printed increment.
!>
!> All images have one scale of displacements and of pressures. motion.dat holds, an image after the other, the lines of the
!> bodies and the contact points.
module atrito_motion_plot
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_contact_plot, only: state_of, N_STATES, STATE_WORD, STATE_COLOUR
   use atrito_files, only: file_set_t, text_file_t, put_line, close_text
   use atrito_increments, only: increment_name
   use atrito_kinds, only: ip, wp
   use atrito_mesh_lines, only: drawing_t, begin_drawing, displace, displacement_scale, put_lines, put_rigid_lines, put_place, &
                                put_window, put_axes, is_drawn_rigid, LINE_INNER
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: open_data, MOTION_PLOT
   use atrito_plot_text, only: quoted, picture_title, begin_script, end_script, put_plot, COLOUR, TIMES
   use atrito_plot_view, only: plot_view_t, asked_scale
   use atrito_results, only: history_t, results_t, contact_result_t, view_frame
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_summary, only: pair_count
   use atrito_write_tables, only: origin_of
   implicit none (type, external)
   private
   public :: has_motion_plot, write_motion_plot, image_frames, most_lines

   integer(ip), parameter :: MOST_IMAGES = 200
   !> Nodes times images up to which inner edges are drawn, too.
   integer(ip), parameter :: MOST_PLACES = 40000
   !> An image lasts so that all take about ten seconds, but no longer and no shorter than these [1/100 s].
   integer(ip), parameter :: WHOLE = 1000, LONGEST = 100, SHORTEST = 5
   real(wp), parameter :: NEEDLE_SHARE = 0.1_wp     !< the largest pressure, as a share of the scene's diagonal
   integer, parameter :: DIGITS = 6

contains

   !> Whether there are several frames to show one after the other.
   pure logical function has_motion_plot(history)
      type(history_t), intent(in) :: history

      has_motion_plot = size(history%frames) > 1
   end function has_motion_plot

   !> Places of the frames that have images: all, or evenly some of them, the first and the last among these.
   pure function image_frames(n) result(list)
      integer(ip), intent(in) :: n                  !< frames
      integer(ip), allocatable :: list(:)
      integer(ip) :: i, m

      m = min(n, MOST_IMAGES)
      if (m == n) then
         list = [(i, i=1, n)]
      else
         list = [(1_ip + nint(real(i - 1, wp)*real(n - 1, wp)/real(m - 1, wp), ip), i=1, m)]
      end if
   end function image_frames

   !> Inner edges too, or outlines alone.
   pure logical function most_lines(n_nodes, n_images)
      integer(ip), intent(in) :: n_nodes, n_images

      most_lines = real(n_nodes, wp)*real(n_images, wp) <= real(MOST_PLACES, wp)
   end function most_lines

   !> Writes motion.dat and motion.gp into the set of the plots' folder. status: STATUS_FILE.
   subroutine write_motion_plot(set, model, history, view, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history        !< of several frames
      type(plot_view_t), intent(in) :: view
      type(status_t), intent(out) :: status
      type(drawing_t) :: drawing
      integer(ip), allocatable :: images(:)

      images = image_frames(size(history%frames, kind=ip))
      call draw_images(model, history, images, view, drawing)
      call write_data(set, model, history, images, drawing, status)
      if (is_ok(status)) call write_script(set, model, history, images, drawing, status)
   end subroutine write_motion_plot

   !> Lines, window and scale of all images.
   subroutine draw_images(model, history, images, view, drawing)
      type(model_t), intent(in) :: model
      type(history_t), intent(in), target :: history
      integer(ip), intent(in) :: images(:)
      type(plot_view_t), intent(in) :: view
      type(drawing_t), intent(out) :: drawing
      type(results_t), pointer :: frame
      real(wp) :: largest
      integer(ip) :: i

      call begin_drawing(model,.not. most_lines(model%mesh%n_nodes, size(images, kind=ip)), drawing)
      largest = 0.0_wp
      do i = 1, size(images, kind=ip)
         call view_frame(history, images(i), frame)
         largest = max(largest, largest_displacement(frame))
      end do
      drawing%view = view
      do i = 1, size(images, kind=ip)
         call view_frame(history, images(i), frame)
         call displace(drawing, model%mesh, frame%u, largest, &
                       asked_scale(view, displacement_scale(largest, drawing%size)))
      end do
   end subroutine draw_images

   pure real(wp) function largest_displacement(frame) result(largest)
      type(results_t), intent(in) :: frame
      integer :: i

      largest = 0.0_wp
      do i = 1, size(frame%u, 2)
         if (all(ieee_is_finite(frame%u(:, i)))) largest = max(largest, hypot(frame%u(1, i), frame%u(2, i)))
      end do
   end function largest_displacement

   !> Of each image the rigid surfaces, the lines of the bodies, and the contact points.
   subroutine write_data(set, model, history, images, drawing, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(history_t), intent(in), target :: history
      integer(ip), intent(in) :: images(:)
      type(drawing_t), intent(in) :: drawing
      type(status_t), intent(out) :: status
      type(results_t), pointer :: frame
      type(text_file_t) :: file
      integer(ip) :: i, pair

      call open_data(set, MOTION_PLOT, file)
      call put_line(file, '# columns: x [L]  y [L]  u1 [L]  u2 [L]; of contact points: pressure [F/L^2] along the inward '// &
                    'normal, in two columns; state')
      do i = 1, size(images, kind=ip)
         call view_frame(history, images(i), frame)
         call put_line(file, '# '//increment_name(frame%step, frame%increment, frame%time))
         call put_rigid_lines(file, model, frame%rigid)
         call put_lines(file, [character(len=40) :: ', edges inside', ', outline and lines between sections'], model, frame%u, &
                        drawing)
         if (.not. has_points(frame)) cycle
         do pair = 1, pair_count(frame)
            call put_points(file, frame%contact(pair))
         end do
         call put_line(file, '')
         call put_line(file, '')
      end do
      call close_text(file, status)
   end subroutine write_data

   pure logical function has_points(frame)
      type(results_t), intent(in) :: frame

      has_points = .false.
      if (pair_count(frame) > 0) has_points = any(frame%contact%n > 0)
   end function has_points

   subroutine put_points(file, contact)
      type(text_file_t), intent(inout) :: file
      type(contact_result_t), intent(in) :: contact
      real(wp) :: v(2)
      integer(ip) :: j

      do j = 1, contact%n
         v = -contact%pressure(j)*contact%normal(:, j)
         call put_place(file, [contact%x(:, j), contact%u(:, j)], trimmed_real(v(1), DIGITS)//' '//trimmed_real(v(2), DIGITS)// &
                        ' '//to_text(state_of(contact%status(j), contact%has_friction)))
      end do
   end subroutine put_points

   subroutine write_script(set, model, history, images, drawing, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      integer(ip), intent(in) :: images(:)
      type(drawing_t), intent(in) :: drawing
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      real(wp) :: pressure

      pressure = largest_pressure(history, images)
      call begin_script(set, MOTION_PLOT, 'the bodies and their contact, an image a printed increment', file)
      call put_line(file, '# Columns of '//MOTION_PLOT//'.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; of contact points 5, 6 '// &
                    'the pressure along the')
      call put_line(file, '# inward normal [F/L^2], 7 state (0 open, 1 stick, 2 slip, 3 closed without friction)')
      call put_line(file, 'scale = '//to_text(drawing%scale, 15)//'   # of the displacements; change it here')
      call put_line(file, 'needle = '//to_text(needle_length(drawing, pressure), 6)//'   # length of a pressure of one')
      call put_line(file, 'heading = '//quoted(picture_title(origin_of(model, history))))
      call put_names(file, history, images)
      call put_window(file, drawing%window, drawing%view)
      call put_line(file, 'set terminal gif animate delay '//to_text(delay(size(images, kind=ip)))// &
                    ' loop 0 size 800,int(0.8*height) font "sans-serif,11" background "white" enhanced')
      call put_line(file, 'set output "'//MOTION_PLOT//'.gif"')
      call put_axes(file, MOTION_PLOT)
      call put_line(file, 'set tmargin 4')
      call put_line(file, 'do for [k=1:images] {')
      call put_line(file, 'set label 1 heading.sprintf("\n%s; displacements drawn %g '//TIMES//pressure_text(pressure)// &
                    '", name[k], scale)'// &
                    ' at screen 0.5, screen 1 - 20.0/(0.8*height) center noenhanced')
      call put_image(file, model, history, images, drawing, pressure)
      call end_script(file, status)
   end subroutine write_script

   !> What is said above each image.
   subroutine put_names(file, history, images)
      type(text_file_t), intent(inout) :: file
      type(history_t), intent(in) :: history
      integer(ip), intent(in) :: images(:)
      integer(ip) :: i

      if (size(images) < size(history%frames)) call put_line(file, '# '//to_text(size(images, kind=ip))//' of the '// &
                                                        to_text(size(history%frames, kind=ip))//' printed increments, evenly taken')
      call put_line(file, 'images = '//to_text(size(images, kind=ip)))
      call put_line(file, 'array name[images]')
      do i = 1, size(images, kind=ip)
         associate (frame => history%frames(images(i)))
            call put_line(file, 'name['//to_text(i)//'] = '//quoted(increment_name(frame%step, frame%increment, frame%time)))
         end associate
      end do
   end subroutine put_names

   pure integer(ip) function delay(n_images)
      integer(ip), intent(in) :: n_images

      delay = min(LONGEST, max(SHORTEST, WHOLE/n_images))
   end function delay

   real(wp) function largest_pressure(history, images) result(largest)
      type(history_t), intent(in), target :: history
      integer(ip), intent(in) :: images(:)
      type(results_t), pointer :: frame
      integer(ip) :: i, pair

      largest = 0.0_wp
      do i = 1, size(images, kind=ip)
         call view_frame(history, images(i), frame)
         do pair = 1, pair_count(frame)
            associate (contact => frame%contact(pair))
               if (contact%n > 0) largest = max(largest, maxval(contact%pressure(:contact%n)))
            end associate
         end do
      end do
   end function largest_pressure

   pure function pressure_text(pressure) result(text)
      real(wp), intent(in) :: pressure              !< the largest [F/L^2]
      character(len=:), allocatable :: text

      text = ''
      if (pressure > 0.0_wp) text = ', pressures up to '//to_text(pressure, 4)//' [F/L^2]'
   end function pressure_text

   pure real(wp) function needle_length(drawing, pressure) result(length)
      type(drawing_t), intent(in) :: drawing
      real(wp), intent(in) :: pressure              !< the largest [F/L^2]

      length = 0.0_wp
      if (pressure > tiny(pressure)*1.0e3_wp) length = NEEDLE_SHARE*drawing%size/pressure
   end function needle_length

   !> One plot: outlines where they were, the lines of the image, rigid surfaces, pressures and points by state.
   subroutine put_image(file, model, history, images, drawing, pressure)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(history_t), intent(in) :: history
      integer(ip), intent(in) :: images(:)
      type(drawing_t), intent(in) :: drawing
      real(wp), intent(in) :: pressure              !< the largest [F/L^2]
      type(string_t), allocatable :: curves(:)
      character(len=:), allocatable :: moved, block
      integer(ip) :: n_rigid, n_lines, n_inner, n_blocks, i

      n_rigid = count([(is_drawn_rigid(model, i), i=1, size(model%surfaces, kind=ip))], kind=ip)
      n_lines = drawing%lines%n_runs
      n_inner = count(drawing%lines%kind(:n_lines) == LINE_INNER, kind=ip)
      n_blocks = n_lines + merge(1_ip, 0_ip, has_points(history%frames(size(history%frames))))
      block = '"'//MOTION_PLOT//'.dat" index first'
      moved = ' using ($1 + scale*$3):($2 + scale*$4)'
      call put_line(file, 'first = '//to_text(n_rigid)//' + '//to_text(n_rigid + n_blocks)//'*(k - 1)')
      call append_string(curves, 'plot '//block//'+'//to_text(n_inner)//':first+'//to_text(n_lines - 1)// &
                         ' using 1:2 with lines ls 8 title "undeformed"')
      if (n_inner > 0) call append_string(curves, '   '//block//':first+'//to_text(n_inner - 1)//moved// &
                                          ' with lines lt 1 lw 1 lc rgb "#B0B0B0"')
      call append_string(curves, '   '//block//'+'//to_text(n_inner)//':first+'//to_text(n_lines - 1)//moved// &
                         ' with lines lt 1 lw 2 lc rgb "#404040"')
      if (n_rigid > 0) call append_string(curves, '   "'//MOTION_PLOT//'.dat" index first-'//to_text(n_rigid)//':first-1'// &
                                          moved//' with lines ls 9 title "rigid"')
      if (n_blocks > n_lines) call add_contact(block//'+'//to_text(n_lines)//moved, history, images, pressure, curves)
      call put_plot(file, curves)
   end subroutine put_image

   subroutine add_contact(points, history, images, pressure, curves)
      character(len=*), intent(in) :: points        !< their block and places
      type(history_t), intent(in) :: history
      integer(ip), intent(in) :: images(:)
      real(wp), intent(in) :: pressure              !< the largest [F/L^2]
      type(string_t), allocatable, intent(inout) :: curves(:)
      character(len=:), allocatable :: colours
      integer(ip) :: i

      colours = '0'
      do i = 0, N_STATES - 1
         colours = '$7 == '//to_text(i)//' ? 0x'//COLOUR(STATE_COLOUR(i)) (2:)//' : '//colours
      end do
      if (pressure > 0.0_wp) call append_string(curves, '   '//points//':(needle*$5):(needle*$6):('//colours// &
                                                ') with vectors nohead lw 2 lc rgb variable')
      call append_string(curves, '   '//points//':('//colours//') with points pt 7 ps 0.7 lc rgb variable')
      do i = 0, N_STATES - 1
         if (.not. has_state(history, images, i)) cycle
         call append_string(curves, '   NaN with lines lt 1 lw 3 lc rgb "'//COLOUR(STATE_COLOUR(i))//'" title "'// &
                            trim(STATE_WORD(i))//'"')
      end do
   end subroutine add_contact

   !> Whether a point has the state in any image.
   logical function has_state(history, images, state) result(has)
      type(history_t), intent(in), target :: history
      integer(ip), intent(in) :: images(:), state
      type(results_t), pointer :: frame
      integer(ip) :: i, pair

      has = .false.
      do i = 1, size(images, kind=ip)
         call view_frame(history, images(i), frame)
         do pair = 1, pair_count(frame)
            associate (contact => frame%contact(pair))
               has = has .or. any(state_of(contact%status(:contact%n), contact%has_friction) == state)
            end associate
         end do
      end do
   end function has_state

end module atrito_motion_plot
