!> The picture that moves: the deformed bodies and the state of their contact, an image a printed increment.
!>
!> All images have one scale of displacements and of pressures. motion.dat holds, an image after the other, the lines of the
!> bodies and the contact points.
module atrito_motion_plot
   use atrito_contact_plot, only: state_of, N_STATES, STATE_WORD, STATE_COLOUR
   use atrito_drawing, only: drawing_t, begin_drawing, displace, displacement_scale, overlap_scale, largest_length, put_lines, &
                             put_rigid_lines, put_place, put_head, put_window, put_axes, overlap_text, MOVED
   use atrito_increments, only: increment_name
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: MOTION_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_data, begin_script, put_plot
   use atrito_plot_text, only: quoted, picture_title, evenly, COLOUR, TIMES, LF
   use atrito_plot_view, only: plot_view_t
   use atrito_results, only: history_t, results_t, view_frame
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_summary, only: pair_count
   use atrito_write_tables, only: origin_of
   implicit none (type, external)
   private
   public :: write_motion_plot, most_lines, MOST_IMAGES

   integer(ip), parameter :: MOST_IMAGES = 200
   !> Nodes times images up to which inner edges are drawn, too.
   integer(ip), parameter :: MOST_PLACES = 40000
   !> An image lasts so that all take about ten seconds, but no longer and no shorter than these [1/100 s].
   integer(ip), parameter :: WHOLE = 1000, LONGEST = 100, SHORTEST = 5
   real(wp), parameter :: NEEDLE_SHARE = 0.1_wp     !< the largest pressure, as a share of the scene's diagonal
   integer, parameter :: DIGITS = 6

   !> What images have in common.
   type :: images_t
      integer(ip), allocatable :: frames(:)         !< their places in the history
      type(drawing_t) :: drawing                    !< its window and scale serve all images
      real(wp) :: pressure = 0.0_wp                 !< the largest [F/L^2]
      logical :: has_state(0:N_STATES - 1) = .false.    !< a point, in any of them
   end type images_t

contains

   !> Inner edges too, or outlines alone.
   pure logical function most_lines(n_nodes, n_images)
      integer(ip), intent(in) :: n_nodes, n_images  !< of the mesh; printed increments that are drawn

      most_lines = real(n_nodes, wp)*real(n_images, wp) <= real(MOST_PLACES, wp)
   end function most_lines

   !> Writes motion.dat and motion.gp.
   subroutine write_motion_plot(plots, model, history, view)
      type(plots_t), intent(inout) :: plots         !< get data and script
      type(model_t), intent(in), target :: model    !< as solved
      type(history_t), intent(in) :: history        !< of several frames
      type(plot_view_t), intent(in) :: view         !< what is asked of the pictures of bodies
      type(images_t) :: images

      images%frames = evenly(size(history%frames, kind=ip), MOST_IMAGES)
      call begin_drawing(model,.not. most_lines(model%mesh%n_nodes, size(images%frames, kind=ip)), view, images%drawing)
      images%drawing%heading = picture_title(origin_of(model, history))
      call measure(history, images)
      call write_data(plots, history, images)
      call write_script(plots, history, images)
   end subroutine write_motion_plot

   !> Window and scale of all images, and what their contact points have.
   subroutine measure(history, images)
      type(history_t), intent(in), target :: history
      type(images_t), intent(inout) :: images
      type(results_t), pointer :: frame
      real(wp) :: largest, reach
      integer(ip) :: i, pair, state

      largest = 0.0_wp
      reach = huge(1.0_wp)
      do i = 1, size(images%frames, kind=ip)
         call view_frame(history, images%frames(i), frame)
         largest = max(largest, largest_length(frame%u))
         reach = min(reach, overlap_scale(images%drawing%model, frame, images%drawing%size))
         do pair = 1, pair_count(frame)
            associate (contact => frame%contact(pair))
               if (contact%n > 0) images%pressure = max(images%pressure, maxval(contact%pressure(:contact%n)))
               do state = 0, N_STATES - 1
                  images%has_state(state) = images%has_state(state) .or. &
                                            any(state_of(contact%status(:contact%n), contact%has_friction) == state)
               end do
            end associate
         end do
      end do
      do i = 1, size(images%frames, kind=ip)
         call view_frame(history, images%frames(i), frame)
         call displace(images%drawing, frame%u, largest, displacement_scale(largest, images%drawing%size, reach), reach)
      end do
   end subroutine measure

   !> Of each image the rigid surfaces, the lines of the bodies, and the contact points.
   subroutine write_data(plots, history, images)
      type(plots_t), intent(inout) :: plots
      type(history_t), intent(in), target :: history
      type(images_t), intent(in) :: images
      type(results_t), pointer :: frame
      real(wp) :: v(2)
      integer(ip) :: i, pair, j

      call begin_data(plots, MOTION_PLOT, 'columns: x [L]  y [L]  u1 [L]  u2 [L]; of contact points: pressure [F/L^2] along '// &
                      'the inward normal, in two columns; state')
      do i = 1, size(images%frames, kind=ip)
         call view_frame(history, images%frames(i), frame)
         call put(plots, '# '//increment_name(frame%step, frame%increment, frame%time))
         call put_rigid_lines(plots, images%drawing, frame%rigid)
         call put_lines(plots, images%drawing, frame%u, .true.)
         if (.not. has_points(frame)) cycle
         do pair = 1, pair_count(frame)
            associate (contact => frame%contact(pair))
               do j = 1, contact%n
                  v = -contact%pressure(j)*contact%normal(:, j)
                  call put_place(plots, [contact%x(:, j), contact%u(:, j)], trimmed_real(v(1), DIGITS)//' '// &
                                 trimmed_real(v(2), DIGITS)//' '//to_text(state_of(contact%status(j), contact%has_friction)))
               end do
            end associate
         end do
         call put(plots, LF)
      end do
   end subroutine write_data

   pure logical function has_points(frame)
      type(results_t), intent(in) :: frame

      has_points = .false.
      if (pair_count(frame) > 0) has_points = any(frame%contact%n > 0)
   end function has_points

   subroutine write_script(plots, history, images)
      type(plots_t), intent(inout) :: plots
      type(history_t), intent(in) :: history
      type(images_t), intent(in) :: images
      character(len=:), allocatable :: pressures
      real(wp) :: needle
      integer(ip) :: i, n

      n = size(images%frames, kind=ip)
      needle = 0.0_wp
      if (images%pressure > tiny(needle)*1.0e3_wp) needle = NEEDLE_SHARE*images%drawing%size/images%pressure
      call begin_script(plots, MOTION_PLOT, 'the bodies and their contact, an image a printed increment', &
                        'Columns of '//MOTION_PLOT//'.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; of contact points 5, 6 '// &
                        'the pressure along the'//LF// &
                        '# inward normal [F/L^2], 7 state (0 open, 1 stick, 2 slip, 3 closed without friction)')
      call put_head(plots, images%drawing, 'needle = '//to_text(needle, 6)//'   # length of a pressure of one'//LF)
      if (n < size(history%frames)) call put(plots, '# '//to_text(n)//' of the '//to_text(size(history%frames, kind=ip))// &
                                             ' printed increments, evenly taken')
      call put(plots, 'images = '//to_text(n)//LF//'array name[images]')
      do i = 1, n
         associate (frame => history%frames(images%frames(i)))
            call put(plots, 'name['//to_text(i)//'] = '//quoted(increment_name(frame%step, frame%increment, frame%time)))
         end associate
      end do
      call put_window(plots, images%drawing)
      call put(plots, 'set terminal gif animate delay '//to_text(min(LONGEST, max(SHORTEST, WHOLE/n)))// &
               ' loop 0 size 800,int(0.8*height) font "sans-serif,11" background "white" enhanced'//LF// &
               'set output "'//MOTION_PLOT//'.gif"')
      call put_axes(plots)
      pressures = ''
      if (images%pressure > 0.0_wp) pressures = ', pressures up to '//to_text(images%pressure, 4)//' [F/L^2]'
      call put(plots, 'set tmargin 4'//LF//'do for [k=1:images] {')
      call put(plots, 'set label 1 heading.sprintf("\n%s; displacements drawn %g '//TIMES// &
               overlap_text(images%drawing)//pressures//'", name[k], scale)'// &
               ' at screen 0.5, screen 1 - 20.0/(0.8*height) center noenhanced')
      call put_image(plots, images, has_points(history%frames(size(history%frames))))
   end subroutine write_script

   !> One plot: outlines where they were, the lines of the image, rigid surfaces, pressures and points by state.
   subroutine put_image(plots, images, has_contact)
      type(plots_t), intent(inout) :: plots
      type(images_t), intent(in) :: images
      logical, intent(in) :: has_contact            !< there are points behind the lines
      type(string_t), allocatable :: curves(:)
      character(len=:), allocatable :: block, outlines, colours, points
      integer(ip) :: n_rigid, n_lines, n_inner, i

      n_rigid = size(images%drawing%surface, kind=ip)
      n_lines = images%drawing%lines%n_runs
      n_inner = images%drawing%n_inner
      block = '"'//MOTION_PLOT//'.dat" index first'
      outlines = block//'+'//to_text(n_inner)//':first+'//to_text(n_lines - 1)//' using '
      call put(plots, 'first = '//to_text(n_rigid)//' + '//to_text(n_rigid + n_lines + merge(1, 0, has_contact))//'*(k - 1)')
      call append_string(curves, outlines//'1:2 with lines ls 30 title "undeformed"')
      if (n_inner > 0) call append_string(curves, block//':first+'//to_text(n_inner - 1)//' using '//MOVED// &
                                          ' with lines lt 1 lw 1 lc rgb "#B0B0B0"')
      call append_string(curves, outlines//MOVED//' with lines lt 1 lw 2 lc rgb "#404040"')
      if (n_rigid > 0) call append_string(curves, '"'//MOTION_PLOT//'.dat" index first-'//to_text(n_rigid)//':first-1 using '// &
                                          MOVED//' with lines ls 31 title "rigid"')
      if (has_contact) then
         points = block//'+'//to_text(n_lines)//' using '//MOVED//':'
         colours = '0'
         do i = 0, N_STATES - 1
            colours = '$7 == '//to_text(i)//' ? 0x'//COLOUR(STATE_COLOUR(i)) (2:)//' : '//colours
         end do
         if (images%pressure > 0.0_wp) call append_string(curves, points//'(needle*$5):(needle*$6):('//colours// &
                                                          ') with vectors nohead lw 2 lc rgb variable')
         call append_string(curves, points//'('//colours//') with points pt 7 ps 0.7 lc rgb variable')
         do i = 0, N_STATES - 1
            if (images%has_state(i)) call append_string(curves, 'NaN with lines lt 1 lw 3 lc rgb "'//COLOUR(STATE_COLOUR(i))// &
                                                        '" title "'//trim(STATE_WORD(i))//'"')
         end do
      end if
      call put_plot(plots, curves)
   end subroutine put_image

end module atrito_motion_plot
