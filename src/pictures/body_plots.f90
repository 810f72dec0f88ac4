!> Pictures of the bodies: the scene before anything is solved, the deformed mesh, and a mechanism.
!>
!> Only edges are drawn, each body in its colour; of a big mesh only the outlines and the lines between sections, which keeps the
!> files small.
module atrito_body_plots
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_body_names, only: name_bodies
   use atrito_drawing, only: drawing_t, begin_drawing, displace, displacement_scale, overlap_scale, largest_length, write_lines, &
                             put_head, put_plane, put_title, scale_title, put_scene, run_styles, body_style, body_title
   use atrito_kinds, only: ip, wp
   use atrito_labels, only: put_labels
   use atrito_link_symbols, only: put_links
   use atrito_load_symbols, only: put_loads
   use atrito_model, only: model_t, step_t, nodal_values_t
   use atrito_plot_files, only: MESH_PLOT, SCENE_PLOT, MECHANISM_PLOT, SYMBOLS_OF
   use atrito_plot_scripts, only: plots_t, put, begin_script
   use atrito_plot_text, only: range_t, quoted, cleaned, picture_title, scene_title, colour_styles, LF
   use atrito_plot_view, only: plot_view_t, shows_none, warn_of_box
   use atrito_results, only: results_t
   use atrito_stability_result, only: stability_t, collapse_t
   use atrito_strings, only: string_t, to_text
   use atrito_support_symbols, only: put_supports
   use atrito_surface_symbols, only: put_surfaces
   use atrito_symbols, only: symbols_t, begin_symbols, end_symbols
   use atrito_write_tables, only: origin_of
   implicit none (type, external)
   private
   public :: draw_mesh, write_mesh_plot, write_scene_plot, shown_step, write_mechanism_plot, mechanism_scale, FEW_NODES

   integer(ip), parameter :: MOST_NODES = 10000     !< of a mesh that is drawn with all its edges
   integer(ip), parameter :: FEW_NODES = 2000       !< of one whose edges are not thin, and are all drawn undeformed, too
   integer, parameter :: LONGEST_TITLE = 90         !< characters
   !> Rotations are drawn as the linear part of a turn, which makes a body larger by half their square.
   real(wp), parameter :: LARGEST_TURN = 0.25_wp

contains

   !> How the scene of a run is drawn. Model and results are looked at as long as the drawing is in use.
   subroutine draw_mesh(model, results, view, drawing)
      type(model_t), intent(in), target :: model     !< as solved
      type(results_t), intent(in), target :: results !< last frame of the run
      type(plot_view_t), intent(in) :: view          !< what is asked of the pictures of bodies
      type(drawing_t), intent(out) :: drawing        !< displaced, with its heading
      real(wp) :: largest, reach

      call begin_drawing(model, model%mesh%n_nodes > MOST_NODES, view, drawing)
      drawing%results => results
      drawing%heading = picture_title(origin_of(model, results))
      largest = largest_length(results%u)
      reach = overlap_scale(model, results, drawing%size)
      call displace(drawing, results%u, largest, displacement_scale(largest, drawing%size, reach), reach)
      if (allocated(results%rigid)) drawing%rigid = results%rigid
   end subroutine draw_mesh

   !> Writes mesh.dat, mesh-symbols.dat and mesh.gp.
   subroutine write_mesh_plot(plots, drawing)
      type(plots_t), intent(inout), target :: plots !< get data and script
      type(drawing_t), intent(inout) :: drawing     !< by draw_mesh; its window has room for the symbols while this is written
      type(string_t), allocatable :: symbols(:), styles(:)     ! curves over the bodies
      type(range_t) :: window(2)
      integer(ip) :: first, i
      logical :: is_big
      type(string_t) :: names(maxval(drawing%lines%body))

      window = drawing%window
      call write_lines(plots, MESH_PLOT, 'edges of the elements as polylines; columns: x [L]  y [L]  u1 [L]  u2 [L]', drawing, &
                       .true.)
      call write_symbols(plots, MESH_PLOT, drawing%results%step, drawing, symbols)
      call begin_script(plots, MESH_PLOT, 'the deformed mesh over the undeformed one', &
                        'Columns of mesh.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; a block a body and kind of line')
      call put_head(plots, drawing, '')
      is_big = drawing%model%mesh%n_nodes > FEW_NODES
      ! The bodies' names as the results of a run have them.
      do i = 1, size(names, kind=ip)
         names(i)%s = 'body '//to_text(i)
         if (.not. allocated(drawing%results%scene%bodies)) cycle
         if (i > size(drawing%results%scene%bodies)) cycle
         if (allocated(drawing%results%scene%bodies(i)%name)) names(i)%s = drawing%results%scene%bodies(i)%name
      end do
      styles = run_styles(drawing, names, trim(merge('0.5', '1  ', is_big)), '2.5')
      call put_bodies_plane(plots, drawing, [styles, symbols])
      call put_title(plots, scale_title(drawing))
      first = 0
      if (is_big) first = drawing%n_inner
      call put_scene(plots, drawing, first, 'undeformed', styles, symbols)
      drawing%window = window
   end subroutine write_mesh_plot

   !> Writes scene.dat, scene-symbols.dat and scene.gp.
   subroutine write_scene_plot(plots, model, view)
      type(plots_t), intent(inout), target :: plots !< get data and script
      type(model_t), intent(in), target :: model    !< as built, with mesh and surfaces
      type(plot_view_t), intent(in) :: view         !< its box and labels are used
      type(drawing_t) :: drawing
      type(string_t), allocatable :: symbols(:), names(:), styles(:)
      type(bodies_t) :: bodies
      character(len=:), allocatable :: title
      integer(ip) :: i

      call begin_drawing(model, model%mesh%n_nodes > MOST_NODES, view, drawing)
      if (shows_none(view, drawing%window)) call warn_of_box(view, drawing%window)
      call write_lines(plots, SCENE_PLOT, 'edges of the elements as polylines; columns: x [L]  y [L], and 0  0', drawing, .true.)
      call write_symbols(plots, SCENE_PLOT, shown_step(model%steps), drawing, symbols)
      call begin_script(plots, SCENE_PLOT, 'mesh, supports, loads and surfaces, before anything is solved', &
                        'Columns of scene.dat and scene-symbols.dat: 1 x [L], 2 y [L], 3 and 4 are 0; '// &
                        'of arrows 5 and 6 their components [L], of markers 5 their size')
      call put(plots, 'scale = 0'//LF//'heading = '//quoted(scene_title(model%deck_path, model%heading)))
      title = 'before anything is solved'
      if (size(model%steps) > 1) title = title//': supports and loads of step '//to_text(shown_step(model%steps))//' of '// &
                                         to_text(size(model%steps, kind=ip))//', at its end'
      call find_bodies(model%mesh, bodies)
      call name_bodies(model, bodies)
      allocate (names(bodies%n))
      do i = 1, bodies%n
         names(i)%s = bodies%list(i)%name
      end do
      styles = run_styles(drawing, names, merge('0.4', '0.7', model%mesh%n_nodes > FEW_NODES), '2')
      call put_bodies_plane(plots, drawing, [styles, symbols])
      call put_title(plots, '"\n'//title//'"')
      call put_scene(plots, drawing, drawing%lines%n_runs, '', styles, symbols)
   end subroutine write_scene_plot

   !> The first step in which something acts; the first one where nothing does.
   pure integer(ip) function shown_step(steps) result(k)
      type(step_t), intent(in) :: steps(:)          !< of the model, one at least

      do k = 1, size(steps, kind=ip)
         associate (step => steps(k))
            if (step%node_loads%n + step%rigid_loads%n + step%element_loads%n > 0) return
            if (allocated(step%heating) .or. moves(step%prescribed) .or. moves(step%rigid_prescribed)) return
         end associate
      end do
      k = 1
   end function shown_step

   !> Whether some of the values is not 0.
   pure logical function moves(list)
      type(nodal_values_t), intent(in) :: list

      moves = .false.
      if (list%n > 0) moves = any(abs(list%value(:list%n)) > 0.0_wp)
   end function moves

   !> Writes mechanism.dat and mechanism.gp: the bodies displaced by their rigid motions, those that move in colour, over where they
   !> were. The data hold places and motions, so that the script can choose the scale.
   subroutine write_mechanism_plot(plots, model, limit, title, view)
      type(plots_t), intent(inout) :: plots         !< get data and script
      type(model_t), intent(in), target :: model    !< at the value that falls
      type(stability_t), intent(in) :: limit        !< with its collapse
      character(len=*), intent(in) :: title         !< of the picture, as the user may have written it
      type(plot_view_t), intent(in) :: view         !< what is asked of the pictures of bodies
      type(drawing_t) :: drawing
      type(string_t), allocatable :: styles(:)
      integer(ip) :: i, k, place                    ! among those that move, the fastest first; 0: it rests

      call begin_drawing(model, .true., view, drawing)
      call displace(drawing, limit%collapse%u, 1.0_wp, mechanism_scale(limit%collapse, drawing%size), huge(1.0_wp))
      allocate (drawing%rigid(0))
      if (allocated(model%rigid_bodies)) then       ! rigid surfaces are bodies behind those of elements
         deallocate (drawing%rigid)
         allocate (drawing%rigid(size(model%rigid_bodies)))
      end if
      do i = 1, size(limit%collapse%bodies, kind=ip)
         k = limit%collapse%bodies(i) - maxval(drawing%lines%body)
         if (k < 1 .or. k > size(drawing%rigid)) cycle
         drawing%rigid(k)%u = limit%collapse%motion(:2, i)
         drawing%rigid(k)%rotation = limit%collapse%motion(3, i)
      end do
      call write_lines(plots, MECHANISM_PLOT, 'outlines of the bodies as polylines; columns: x [L]  y [L]  u1 [L]  u2 [L], '// &
                       'the largest u is 1', drawing, .false.)
      call begin_script(plots, MECHANISM_PLOT, 'the mechanism of a scene at its limit', &
                        'Columns of mechanism.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; a block a body')
      call put(plots, 'scale = '//to_text(drawing%scale, 15)//'   # of the motion; change it here')
      call put(plots, 'heading = '//quoted(cleaned(title, LONGEST_TITLE))//LF// &
               'value = '//quoted('mechanism at '//limit%parameter//' = '//to_text(limit%falls, 8)))
      allocate (styles(drawing%lines%n_runs))
      do i = 1, size(styles, kind=ip)
         place = findloc(limit%collapse%bodies, drawing%lines%body(i), dim=1, kind=ip)
         styles(i)%s = 'ls 32'
         if (place > 0) styles(i)%s = body_style(drawing%lines%body(i))//' lw 2.5'// &
                                      body_title(limit%collapse%names(place)%s, place, size(limit%collapse%bodies, kind=ip))
      end do
      call put_bodies_plane(plots, drawing, styles)
      call put_title(plots, 'sprintf("\n%s, its largest displacement drawn %g [L]", value, scale)')
      call put(plots, 'set style line 32 lt 1 lw 1.5 lc rgb "#404040"')
      call put_scene(plots, drawing, 0_ip, 'undisplaced', styles, [string_t ::])
   end subroutine write_mechanism_plot

   !> The number with which a motion of one is drawn 3 to 8 % of the scene long, or less where bodies would turn much.
   pure real(wp) function mechanism_scale(collapse, size_of_scene) result(scale)
      type(collapse_t), intent(in) :: collapse      !< its rotations are read
      real(wp), intent(in) :: size_of_scene         !< diagonal [L]
      real(wp) :: turn

      scale = displacement_scale(1.0_wp, size_of_scene)
      turn = maxval(abs(collapse%motion(3, :)))
      if (turn*scale > LARGEST_TURN) scale = LARGEST_TURN/turn
   end function mechanism_scale

   !> Writes <picture>-symbols.dat. The window of the drawing is widened to the symbols.
   subroutine write_symbols(plots, picture, step, drawing, curves)
      type(plots_t), intent(inout), target :: plots
      character(len=*), intent(in) :: picture       !< without ending; that of a scene has surfaces too, undisplaced
      integer(ip), intent(in) :: step               !< whose supports and loads they are, as at its end
      type(drawing_t), intent(inout), target :: drawing
      type(string_t), allocatable, intent(out) :: curves(:)   !< to be drawn over the bodies
      type(symbols_t) :: symbols

      call begin_symbols(plots, picture//SYMBOLS_OF, 'symbols of supports, loads and surfaces; columns: x [L]  y [L]  u1 [L]  '// &
                         'u2 [L], and of an arrow its components [L], of a marker its size, of a label its text', drawing, symbols)
      symbols%step = step
      if (picture == SCENE_PLOT) call put_surfaces(drawing%model, symbols)
      call put_links(symbols)
      call put_supports(symbols)
      call put_loads(symbols)
      if (drawing%view%labels) call put_labels(drawing, symbols)
      drawing%window = symbols%window
      call move_alloc(symbols%curves, curves)
      call end_symbols(symbols)
   end subroutine write_symbols

   !> Ranges, terminal, axes, and what all curves have in common: room for their legend, colours of bodies, fonts of labels.
   subroutine put_bodies_plane(plots, drawing, curves)
      type(plots_t), intent(inout) :: plots
      type(drawing_t), intent(in) :: drawing
      type(string_t), intent(in) :: curves(:)       !< or their styles
      integer(ip) :: n, i
      logical :: is_long                            ! symbols have long names, so two stand side by side

      n = 1 + size(drawing%surface, kind=ip)
      is_long = .false.
      do i = 1, size(curves, kind=ip)
         if (index(curves(i)%s, ' title ') == 0) cycle
         n = n + 1
         is_long = is_long .or. index(curves(i)%s, ' title "') > 0
      end do
      call put_plane(plots, drawing, 1 + (n - 1)/merge(2_ip, 4_ip, is_long))
      call put(plots, colour_styles('', maxval(drawing%lines%body)))
      if (drawing%view%labels) call put(plots, 'set style textbox opaque fc rgb "#ffffff" noborder margins 0.4,0.2'//LF// &
                                        'SMALL = kind eq "png" ? ",8" : ",11"; MIDDLE = kind eq "png" ? ",9" : ",12"')
   end subroutine put_bodies_plane

end module atrito_body_plots
