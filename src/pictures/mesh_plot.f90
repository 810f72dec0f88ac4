!> The picture of the mesh: the deformed bodies, each in its colour, over the undeformed ones.
!>
!> Only edges are drawn; of a big mesh only the outlines and the lines between sections, which keeps the files small.
module atrito_mesh_plot
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_files, only: file_set_t, text_file_t, put_line
   use atrito_kinds, only: ip, wp
   use atrito_mesh_lines, only: drawing_t, begin_drawing, displace, displacement_scale, write_lines, put_frame, put_scene, &
                                body_style, LINE_INNER, MOST_NAMES, LONGEST_NAME
   use atrito_model, only: model_t
   use atrito_plot_files, only: MESH_PLOT
   use atrito_plot_text, only: range_t, quoted, cleaned, picture_title, begin_script, end_script, COLOUR, N_COLOURS, TIMES
   use atrito_plot_view, only: plot_view_t, asked_scale
   use atrito_results, only: results_t
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, to_text
   use atrito_write_symbols, only: write_symbols, legend_lines
   use atrito_write_tables, only: origin_of
   implicit none (type, external)
   private
   public :: write_mesh_plot, draw_mesh, put_heading, displacement_text, FEW_NODES

   integer(ip), parameter :: MOST_NODES = 10000     !< of a mesh that is drawn with all its edges
   integer(ip), parameter :: FEW_NODES = 2000       !< of one whose undeformed edges are all drawn too

contains

   !> What mesh.dat holds, and how the scene is drawn.
   subroutine draw_mesh(model, results, view, drawing)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(plot_view_t), intent(in) :: view
      type(drawing_t), intent(out) :: drawing
      real(wp) :: largest
      integer(ip) :: i

      call begin_drawing(model, model%mesh%n_nodes > MOST_NODES, drawing)
      largest = 0.0_wp
      do i = 1, size(results%u, 2, kind=ip)
         if (all(ieee_is_finite(results%u(:, i)))) largest = max(largest, hypot(results%u(1, i), results%u(2, i)))
      end do
      drawing%view = view
      call displace(drawing, model%mesh, results%u, largest, asked_scale(view, displacement_scale(largest, drawing%size)))
      if (allocated(results%rigid)) drawing%rigid = results%rigid
   end subroutine draw_mesh

   !> Writes mesh.dat, mesh-symbols.dat and mesh.gp into the set of the plots' folder.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_mesh_plot(set, model, results, drawing, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(drawing_t), intent(inout) :: drawing     !< by draw_mesh; its window has room for the symbols while this is written
      type(status_t), intent(out) :: status
      type(string_t), allocatable :: symbols(:)
      type(range_t) :: window(2)

      window = drawing%window
      call write_lines(set, MESH_PLOT, '# edges of the elements as polylines; columns: x [L]  y [L]  u1 [L]  u2 [L]', &
                       [character(len=40) :: ', edges inside', ', outline and lines between sections'], model, results%u, &
                       drawing, status)
      if (is_ok(status)) call write_symbols(set, MESH_PLOT, model, results%step, results%u, drawing, symbols, status)
      if (is_ok(status)) call write_script(set, model, results, drawing, symbols, status)
      drawing%window = window
   end subroutine write_mesh_plot

   subroutine write_script(set, model, results, drawing, symbols, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(drawing_t), intent(in) :: drawing
      type(string_t), intent(in) :: symbols(:)      !< curves over the bodies
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(string_t) :: styles(drawing%lines%n_runs)
      integer(ip) :: i, first

      call begin_script(set, MESH_PLOT, 'the deformed mesh over the undeformed one', file)
      call put_line(file, '# Columns of mesh.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; a block a body and kind of line')
      call put_line(file, 'scale = '//to_text(drawing%scale, 15)//'   # of the displacements; change it here')
      call put_line(file, 'heading = '//quoted(picture_title(origin_of(model, results))))
      call put_frame(file, MESH_PLOT, drawing%window, drawing%view, legend_lines(symbols))
      do i = 1, N_COLOURS
         call put_line(file, 'set style line '//to_text(i)//' lt 1 lc rgb "'//COLOUR(i)//'"')
      end do
      call put_heading(file, drawing)
      first = 0
      if (model%mesh%n_nodes > FEW_NODES) first = count(drawing%lines%kind(:size(styles)) == LINE_INNER, kind=ip)
      do i = 1, size(styles, kind=ip)
         styles(i)%s = body_style(drawing%lines%body(i))//legend_text(results, drawing, i, model%mesh%n_nodes)
      end do
      call put_scene(file, MESH_PLOT, first, 'undeformed', styles, model, symbols)
      call end_script(file, status)
   end subroutine write_script

   !> The title with the scale: a label, for gnuplot measures titles as enhanced text even where they are not, and complains.
   subroutine put_heading(file, drawing)
      type(text_file_t), intent(inout) :: file
      type(drawing_t), intent(in) :: drawing

      call put_line(file, 'set tmargin 4')
      call put_line(file, 'set label 1 heading.sprintf("\ndisplacements drawn %g '//TIMES//', the largest is %g [L]", scale, '// &
                    to_text(drawing%largest, 4)//') at screen 0.5, screen 1 - 22.0/height center noenhanced')
   end subroutine put_heading

   !> The scale of the displacements in words, for a string in double quotes.
   pure function displacement_text(scale) result(text)
      real(wp), intent(in) :: scale
      character(len=:), allocatable :: text

      text = 'displacements drawn '//to_text(scale)//' '//TIMES
      if (scale <= 0.0_wp) text = 'undisplaced'
   end function displacement_text

   !> Width and name of a run of lines; the name stands at the outline.
   pure function legend_text(results, drawing, run, n_nodes) result(text)
      type(results_t), intent(in) :: results
      type(drawing_t), intent(in) :: drawing
      integer(ip), intent(in) :: run, n_nodes
      character(len=:), allocatable :: text

      text = ' lw 1'
      if (n_nodes > FEW_NODES) text = ' lw 0.5'
      if (drawing%lines%kind(run) == LINE_INNER) return
      text = ' lw 2.5'
      if (drawing%lines%body(run) > MOST_NAMES) return
      text = text//' title '//quoted(body_name(results, drawing%lines%body(run)))//' noenhanced'
   end function legend_text

   pure function body_name(results, body) result(name)
      type(results_t), intent(in) :: results
      integer(ip), intent(in) :: body
      character(len=:), allocatable :: name

      name = 'body '//to_text(body)
      if (.not. allocated(results%scene%bodies)) return
      if (body > size(results%scene%bodies)) return
      if (allocated(results%scene%bodies(body)%name)) name = cleaned(results%scene%bodies(body)%name, LONGEST_NAME)
   end function body_name

end module atrito_mesh_plot
