!> The picture of a scene before anything is solved: the mesh with its bodies in colours, supports, loads, and surfaces with their
!> normals.
module atrito_scene_plot
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_body_names, only: name_bodies
   use atrito_files, only: file_set_t, text_file_t, put_line
   use atrito_kinds, only: ip, wp
   use atrito_mesh_lines, only: drawing_t, begin_drawing, write_lines, put_frame, put_scene, body_style, LINE_INNER, MOST_NAMES, &
                                LONGEST_NAME
   use atrito_model, only: model_t, step_t, nodal_values_t
   use atrito_plot_files, only: SCENE_PLOT
   use atrito_plot_text, only: quoted, cleaned, scene_title, begin_script, end_script, COLOUR, N_COLOURS
   use atrito_plot_view, only: plot_view_t, shows_none, warn_of_box
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, to_text
   use atrito_write_symbols, only: write_symbols, legend_lines
   implicit none (type, external)
   private
   public :: write_scene_plot, shown_step

   integer(ip), parameter :: MOST_NODES = 10000     !< of a mesh that is drawn with all its edges
   integer(ip), parameter :: FEW_NODES = 2000       !< of one whose edges are not thin

contains

   !> Writes scene.dat, scene-symbols.dat and scene.gp into the set of the plots' folder.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_scene_plot(set, model, view, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(plot_view_t), intent(in) :: view
      type(status_t), intent(out) :: status
      type(drawing_t) :: drawing
      type(string_t), allocatable :: symbols(:)
      real(wp), allocatable :: u(:, :)

      allocate (u(2, model%mesh%n_nodes), source=0.0_wp)
      call begin_drawing(model, model%mesh%n_nodes > MOST_NODES, drawing)
      drawing%view = view
      if (shows_none(view, drawing%window)) call warn_of_box(view, drawing%window)
      call write_lines(set, SCENE_PLOT, '# edges of the elements as polylines; columns: x [L]  y [L], and 0  0', &
                       [character(len=40) :: ', edges inside', ', outline and lines between sections'], model, u, drawing, status)
      if (is_ok(status)) call write_symbols(set, SCENE_PLOT, model, shown_step(model%steps), u, drawing, symbols, status)
      if (is_ok(status)) call write_script(set, model, drawing, symbols, status)
   end subroutine write_scene_plot

   !> The first step in which something acts; the first one where nothing does.
   pure integer(ip) function shown_step(steps) result(k)
      type(step_t), intent(in) :: steps(:)

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

   subroutine write_script(set, model, drawing, symbols, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(drawing_t), intent(in) :: drawing
      type(string_t), intent(in) :: symbols(:)
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(string_t) :: styles(drawing%lines%n_runs)
      type(bodies_t) :: bodies
      integer(ip) :: i

      call find_bodies(model%mesh, bodies)
      call name_bodies(model, bodies)
      call begin_script(set, SCENE_PLOT, 'mesh, supports, loads and surfaces, before anything is solved', file)
      call put_line(file, '# Columns of scene.dat and scene-symbols.dat: 1 x [L], 2 y [L], 3 and 4 are 0; '// &
                    'of arrows 5 and 6 their components [L], of markers 5 their size')
      call put_line(file, 'scale = 0')
      call put_line(file, 'heading = '//quoted(scene_title(model%deck_path, model%heading)))
      call put_frame(file, SCENE_PLOT, drawing%window, drawing%view, legend_lines(symbols))
      do i = 1, N_COLOURS
         call put_line(file, 'set style line '//to_text(i)//' lt 1 lc rgb "'//COLOUR(i)//'"')
      end do
      call put_line(file, 'set tmargin 4')
      call put_line(file, 'set label 1 heading."\n'//what_is_shown(model)//'" at screen 0.5, '// &
                    'screen 1 - 22.0/height center noenhanced')
      do i = 1, size(styles, kind=ip)
         styles(i)%s = body_style(drawing%lines%body(i))//line_width(drawing%lines%kind(i), model%mesh%n_nodes)
         if (drawing%lines%kind(i) == LINE_INNER .or. drawing%lines%body(i) > MOST_NAMES) cycle
         styles(i)%s = styles(i)%s//' title '//quoted(cleaned(bodies%list(drawing%lines%body(i))%name, LONGEST_NAME))//' noenhanced'
      end do
      call put_scene(file, SCENE_PLOT, size(styles, kind=ip), '', styles, model, symbols)
      call end_script(file, status)
   end subroutine write_script

   !> The second line of the title.
   pure function what_is_shown(model) result(text)
      type(model_t), intent(in) :: model
      character(len=:), allocatable :: text

      text = 'before anything is solved'
      if (size(model%steps) > 1) text = text//': supports and loads of step '//to_text(shown_step(model%steps))//' of '// &
                                        to_text(size(model%steps, kind=ip))//', at its end'
   end function what_is_shown

   pure function line_width(kind, n_nodes) result(text)
      integer(ip), intent(in) :: kind, n_nodes
      character(len=:), allocatable :: text

      text = ' lw 2'
      if (kind == LINE_INNER) text = trim(merge(' lw 0.4', ' lw 0.7', n_nodes > FEW_NODES))
   end function line_width

end module atrito_scene_plot
