!> The picture of a mechanism: the bodies displaced by their rigid motions, those that move in colour, over where they were.
!>
!> mechanism.dat holds the outlines as polylines of place and motion, so that the script can choose the scale.
module atrito_mechanism_plot
   use atrito_files, only: file_set_t, text_file_t, put_line
   use atrito_kinds, only: ip, wp
   use atrito_mesh_lines, only: drawing_t, begin_drawing, displace, displacement_scale, write_lines, put_frame, put_scene, &
                                body_style, MOST_NAMES, LONGEST_NAME
   use atrito_model, only: model_t
   use atrito_plot_files, only: MECHANISM_PLOT
   use atrito_plot_text, only: quoted, cleaned, begin_script, end_script, COLOUR, N_COLOURS
   use atrito_plot_view, only: plot_view_t, asked_scale
   use atrito_results, only: rigid_result_t
   use atrito_stability_result, only: stability_t, collapse_t
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: write_mechanism_plot, mechanism_scale

   integer, parameter :: LONGEST_TITLE = 90         !< characters
   !> Rotations are drawn as the linear part of a turn, which makes a body larger by half their square.
   real(wp), parameter :: LARGEST_TURN = 0.25_wp

contains

   !> Writes mechanism.dat and mechanism.gp into the set of the plots' folder. status: STATUS_FILE.
   subroutine write_mechanism_plot(set, model, limit, title, view, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model            !< at the value that falls
      type(stability_t), intent(in) :: limit
      character(len=*), intent(in) :: title
      type(plot_view_t), intent(in) :: view
      type(status_t), intent(out) :: status
      type(drawing_t) :: drawing

      call begin_drawing(model, .true., drawing)
      drawing%view = view
      call displace(drawing, model%mesh, limit%collapse%u, 1.0_wp, &
                    asked_scale(view, mechanism_scale(limit%collapse, drawing%size)))
      drawing%rigid = rigid_motions(model, limit%collapse, drawing)
      call write_lines(set, MECHANISM_PLOT, '# outlines of the bodies as polylines; columns: x [L]  y [L]  u1 [L]  u2 [L], '// &
                       'the largest u is 1', ['', ''], model, limit%collapse%u, drawing, status)
      if (is_ok(status)) call write_script(set, model, limit, title, drawing, status)
   end subroutine write_mechanism_plot

   !> The motions of rigid surfaces, which are bodies behind those of elements.
   pure function rigid_motions(model, collapse, drawing) result(rigid)
      type(model_t), intent(in) :: model
      type(collapse_t), intent(in) :: collapse
      type(drawing_t), intent(in) :: drawing
      type(rigid_result_t), allocatable :: rigid(:)
      integer(ip) :: i, k

      allocate (rigid(0))
      if (.not. allocated(model%rigid_bodies)) return
      deallocate (rigid)
      allocate (rigid(size(model%rigid_bodies)))
      do i = 1, size(collapse%bodies, kind=ip)
         k = collapse%bodies(i) - maxval(drawing%lines%body)
         if (k < 1) cycle
         rigid(k)%u = collapse%motion(:2, i)
         rigid(k)%rotation = collapse%motion(3, i)
      end do
   end function rigid_motions

   !> The number with which a motion of one is drawn 3 to 8 % of the scene long, or less where bodies would turn much.
   pure real(wp) function mechanism_scale(collapse, size_of_scene) result(scale)
      type(collapse_t), intent(in) :: collapse
      real(wp), intent(in) :: size_of_scene         !< diagonal [L]
      real(wp) :: turn

      scale = displacement_scale(1.0_wp, size_of_scene)
      turn = maxval(abs(collapse%motion(3, :)))
      if (turn*scale > LARGEST_TURN) scale = LARGEST_TURN/turn
   end function mechanism_scale

   !> Those that rest are drawn all alike.
   subroutine write_script(set, model, limit, title, drawing, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(stability_t), intent(in) :: limit
      character(len=*), intent(in) :: title
      type(drawing_t), intent(in) :: drawing
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(string_t) :: styles(drawing%lines%n_runs)
      integer(ip) :: i

      call begin_script(set, MECHANISM_PLOT, 'the mechanism of a scene at its limit', file)
      call put_line(file, '# Columns of mechanism.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; a block a body')
      call put_line(file, 'scale = '//to_text(drawing%scale, 15)//'   # of the motion; change it here')
      call put_frame(file, MECHANISM_PLOT, drawing%window, drawing%view)
      call put_line(file, 'set style line 10 lt 1 lw 1.5 lc rgb "#404040"')
      do i = 1, N_COLOURS
         call put_line(file, 'set style line '//to_text(i)//' lt 1 lw 2.5 lc rgb "'//COLOUR(i)//'"')
      end do
      call put_line(file, 'heading = '//quoted(cleaned(title, LONGEST_TITLE)))
      call put_line(file, 'value = '//quoted('mechanism at '//limit%parameter//' = '//to_text(limit%falls, 8)))
      call put_line(file, 'set tmargin 4')
      call put_line(file, 'set label 1 heading.sprintf("\n%s, its largest displacement drawn %g [L]", value, scale)'// &
                    ' at screen 0.5, screen 1 - 22.0/height center noenhanced')
      do i = 1, size(styles, kind=ip)
         styles(i)%s = style_text(limit%collapse, drawing%lines%body(i))
      end do
      call put_scene(file, MECHANISM_PLOT, 0_ip, 'undisplaced', styles, model)
      call end_script(file, status)
   end subroutine write_script

   !> Colours by the bodies' numbers; the fastest ones have their names in the legend.
   pure function style_text(collapse, body) result(text)
      type(collapse_t), intent(in) :: collapse
      integer(ip), intent(in) :: body
      character(len=:), allocatable :: text
      integer :: place                              !< among those that move, the fastest first; 0: it rests

      place = findloc(collapse%bodies, body, dim=1)
      text = 'ls 10'
      if (place == 0) return
      text = body_style(body)
      if (place <= MOST_NAMES) text = text//' title '//quoted(cleaned(collapse%names(place)%s, LONGEST_NAME))//' noenhanced'
   end function style_text

end module atrito_mechanism_plot
