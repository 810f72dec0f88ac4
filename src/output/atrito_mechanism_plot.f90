!> The picture of a mechanism: the bodies displaced by their rigid motions, those that move in colour, over where they were.
!>
!> mechanism.dat holds the outlines as polylines of place and motion, so that the script can choose the scale.
module atrito_mechanism_plot
   use atrito_files, only: file_set_t, text_file_t, open_text, put_line, close_text
   use atrito_kinds, only: ip, wp
   use atrito_mesh_plot, only: mesh_lines_t, collect_lines, displacement_scale, put_edge, put_rigid, is_drawn_rigid, &
                               reference_window, put_frame
   use atrito_model, only: model_t
   use atrito_plot_files, only: MECHANISM_PLOT
   use atrito_plot_text, only: range_t, cover, span, quoted, cleaned, put_top, COLOUR, N_COLOURS, TIMES, LOOP_END
   use atrito_stability_result, only: stability_t, collapse_t
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, append_string, to_text
   implicit none (type, external)
   private
   public :: write_mechanism_plot, mechanism_scale

   integer, parameter :: LONGEST_TITLE = 90         !< characters
   integer, parameter :: LONGEST_NAME = 24
   integer(ip), parameter :: MOST_NAMES = 8         !< bodies in the legend
   !> Rotations are drawn as the linear part of a turn, which makes a body larger by half their square.
   real(wp), parameter :: LARGEST_TURN = 0.25_wp

contains

   !> Writes mechanism.dat and mechanism.gp into the set of the plots' folder. status: STATUS_FILE.
   subroutine write_mechanism_plot(set, model, limit, title, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model            !< at the value that falls
      type(stability_t), intent(in) :: limit
      character(len=*), intent(in) :: title
      type(status_t), intent(out) :: status
      type(mesh_lines_t) :: lines
      type(range_t) :: window(2)
      real(wp) :: scale
      integer :: i

      call collect_lines(model%mesh, model%section_of, .true., lines)
      window = reference_window(model%mesh)
      scale = mechanism_scale(limit%collapse, hypot(span(window(1)), span(window(2))))
      do i = 1, 2
         call cover(window(i), model%mesh%x(i, :) + scale*limit%collapse%u(i, :))
      end do
      call write_data(set, model, limit%collapse, lines, status)
      if (is_ok(status)) call write_script(set, model, limit, title, lines, window, scale, status)
   end subroutine write_mechanism_plot

   !> The number with which a motion of one is drawn 3 to 8 % of the scene long, or less where bodies would turn much.
   pure real(wp) function mechanism_scale(collapse, size_of_scene) result(scale)
      type(collapse_t), intent(in) :: collapse
      real(wp), intent(in) :: size_of_scene         !< diagonal [L]
      real(wp) :: turn

      scale = displacement_scale(1.0_wp, size_of_scene)
      turn = maxval(abs(collapse%motion(3, :)))
      if (turn*scale > LARGEST_TURN) scale = LARGEST_TURN/turn
   end function mechanism_scale

   !> A block an outline of a body, then the rigid surfaces of the pairs.
   subroutine write_data(set, model, collapse, lines, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(collapse_t), intent(in) :: collapse
      type(mesh_lines_t), intent(in) :: lines
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(range_t) :: window(2)
      integer(ip) :: run, i

      window = reference_window(model%mesh)
      call open_text(set, MECHANISM_PLOT//'.dat', file)
      call put_line(file, '# outlines of the bodies as polylines; columns: x [L]  y [L]  u1 [L]  u2 [L], the largest u is 1')
      do run = 1, lines%n_runs
         call put_line(file, '# block '//to_text(run - 1)//': body '//to_text(lines%body(run)))
         do i = lines%first(run), lines%first(run + 1) - 1
            call put_edge(file, model%mesh, collapse%u, lines%element(i), lines%face(i), &
                          [hypot(span(window(1)), span(window(2))), 1.0_wp])
         end do
         call put_line(file, '')
      end do
      do i = 1, size(model%surfaces, kind=ip)
         if (is_drawn_rigid(model, i)) call put_rigid(file, model%surfaces(i))
      end do
      call close_text(file, status)
   end subroutine write_data

   subroutine write_script(set, model, limit, title, lines, window, scale, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(stability_t), intent(in) :: limit
      character(len=*), intent(in) :: title
      type(mesh_lines_t), intent(in) :: lines
      type(range_t), intent(in) :: window(2)
      real(wp), intent(in) :: scale
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      integer :: i

      call open_text(set, MECHANISM_PLOT//'.gp', file)
      call put_top(file, MECHANISM_PLOT, 'the mechanism of a scene at its limit')
      call put_line(file, '# Columns of mechanism.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; a block a body')
      call put_line(file, 'scale = '//to_text(scale)//'   # of the motion; change it here')
      call put_frame(file, MECHANISM_PLOT, window)
      call put_line(file, 'set style line 10 lt 1 lw 1.5 lc rgb "#404040"')
      do i = 1, N_COLOURS
         call put_line(file, 'set style line '//to_text(int(i, ip))//' lt 1 lw 2.5 lc rgb "'//COLOUR(i)//'"')
      end do
      call put_line(file, 'heading = '//quoted(cleaned(title, LONGEST_TITLE)))
      call put_line(file, 'value = '//quoted('mechanism at '//limit%parameter//' = '//to_text(limit%falls, 8)))
      call put_line(file, 'set tmargin 4')
      call put_line(file, 'set label 1 heading.sprintf("\n%s, its largest displacement drawn %g [L]", value, scale)'// &
                    ' at screen 0.5, screen 1 - 22.0/height center noenhanced')
      call put_curves(file, model, limit%collapse, lines)
      call put_line(file, LOOP_END)
      call put_line(file, 'set output')
      call close_text(file, status)
   end subroutine write_script

   !> Where the bodies were, where they go, and rigid surfaces. Those that rest are drawn once, all alike.
   subroutine put_curves(file, model, collapse, lines)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(collapse_t), intent(in) :: collapse
      type(mesh_lines_t), intent(in) :: lines
      type(string_t), allocatable :: curves(:)
      integer(ip) :: run, i, place, n_blocks

      call append_string(curves, 'plot for [i=0:'//to_text(lines%n_runs - 1)//'] "mechanism.dat" index i using 1:2 with lines'// &
                         ' ls 8 title i == 0 ? "undisplaced" : ""')
      do run = 1, lines%n_runs
         place = findloc(collapse%bodies, lines%body(run), dim=1, kind=ip)
         call append_string(curves, '   "mechanism.dat" index '//to_text(run - 1)// &
                            ' using ($1 + scale*$3):($2 + scale*$4) with lines '//style_text(collapse, lines%body(run), place))
      end do
      n_blocks = lines%n_runs
      do i = 1, size(model%surfaces, kind=ip)
         if (.not. is_drawn_rigid(model, i)) cycle
         call append_string(curves, '   "mechanism.dat" index '//to_text(n_blocks)//' using 1:2 with lines ls 9 title '// &
                            quoted(cleaned(model%surfaces(i)%name, LONGEST_NAME)//' (rigid)')//' noenhanced')
         n_blocks = n_blocks + 1
      end do
      do i = 1, size(curves, kind=ip) - 1
         call put_line(file, curves(i)%s//', \')
      end do
      call put_line(file, curves(size(curves))%s)
   end subroutine put_curves

   !> Colours by the bodies' numbers; the fastest ones have their names in the legend.
   pure function style_text(collapse, body, place) result(text)
      type(collapse_t), intent(in) :: collapse
      integer(ip), intent(in) :: body
      integer(ip), intent(in) :: place              !< among those that move, the fastest first; 0: it rests
      character(len=:), allocatable :: text

      text = 'ls 10'
      if (place == 0) return
      text = 'ls '//to_text(mod(body - 1, int(N_COLOURS, ip)) + 1_ip)
      if (place <= MOST_NAMES) text = text//' title '//quoted(cleaned(collapse%names(place)%s, LONGEST_NAME))//' noenhanced'
   end function style_text

end module atrito_mechanism_plot
