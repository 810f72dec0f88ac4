!> The picture of the mesh: the deformed bodies, each in its colour, over the undeformed ones.
!>
!> mesh.dat holds edges as polylines of place and displacement, so that the script can choose the scale. Only edges are drawn,
!> each once; of a big mesh only the outlines and the lines between sections, which keeps the files small.
module atrito_mesh_plot
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_element_table, only: MOST_SIDES
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_status, only: status_t, is_ok
   use atrito_files, only: file_set_t, text_file_t, open_text, put_line, close_text
   use atrito_mesh, only: mesh_t, face_end, middle_node, side_count
   use atrito_faces, only: node_elements_t, list_node_elements
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_model, only: model_t, surface_t, SURFACE_SEGMENTS
   use atrito_results, only: results_t
   use atrito_number_text, only: trimmed_real
   use atrito_table, only: origin_t
   use atrito_plot_files, only: MESH_PLOT
   use atrito_plot_text, only: range_t, cover, padded, range_text, span, quoted, cleaned, picture_title, put_top, put_terminal, &
                               COLOUR, N_COLOURS, TIMES, LOOP_END
   implicit none (type, external)
   private
   public :: write_mesh_plot, displacement_scale, collect_lines, mesh_lines_t, outline_t, find_outline, put_place
   public :: put_edge, put_rigid, is_drawn_rigid, reference_window, put_frame   ! of the mechanism, too

   integer, parameter :: DIGITS = 7                 !< of mesh.dat: a picture has a thousand pixels
   integer(ip), parameter :: MOST_NODES = 10000     !< of a mesh that is drawn with all its edges
   integer(ip), parameter :: FEW_NODES = 2000       !< of one whose undeformed edges are all drawn too
   integer, parameter :: PIECES = 10                !< straight pieces of a curved edge
   integer, parameter :: ARC_PIECES = 60            !< of a rigid arc
   !> An edge whose middle node is off the middle by less than this share of the scene, or of the largest displacement, is straight.
   real(wp), parameter :: STRAIGHT = 3.0e-4_wp
   !> The largest displacement is drawn at most this long, as a share of the scene's diagonal.
   real(wp), parameter :: LARGEST_SHARE = 0.08_wp
   integer(ip), parameter :: MOST_NAMES = 8         !< bodies in the legend
   integer, parameter :: LONGEST_NAME = 24          !< characters of a body's name
   integer(ip), parameter :: LINE_INNER = 1, LINE_OUTER = 2, LINE_RIGID = 3

   !> What is drawn: edges of the mesh, in runs of one kind and body.
   type :: mesh_lines_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: element(:), face(:)   !< (n)
      integer(ip) :: n_runs = 0
      integer(ip), allocatable :: first(:)              !< (n_runs + 1) where each begins
      integer(ip), allocatable :: kind(:), body(:)      !< (n_runs)
   end type mesh_lines_t

   !> Where mesh.dat has the outlines, and how the scene is drawn: for pictures of something else over them.
   type :: outline_t
      integer(ip) :: first = 0, last = 0                !< blocks of mesh.dat with the bodies' outlines, from 0
      integer(ip) :: n_rigid = 0                        !< blocks of rigid surfaces behind them
      type(range_t) :: window(2)                        !< what both shapes cover [L]
      real(wp) :: scale = 1.0_wp                        !< of the displacements
      real(wp) :: largest = 0.0_wp                      !< displacement [L]
      character(len=:), allocatable :: height           !< pixels of the picture
   end type outline_t

contains

   !> Finds the outlines in the mesh.dat that write_mesh_plot writes.
   subroutine find_outline(model, results, outline)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(outline_t), intent(out) :: outline
      type(mesh_lines_t) :: lines
      integer(ip) :: i

      call collect_lines(model%mesh, model%section_of, model%mesh%n_nodes > MOST_NODES, lines)
      outline%first = count(lines%kind(:lines%n_runs) == LINE_INNER, kind=ip)
      outline%last = lines%n_runs - 1
      outline%n_rigid = count([(is_drawn_rigid(model, i), i=1, size(model%surfaces, kind=ip))], kind=ip)
      call choose_window(model, results, outline%window, outline%largest, outline%scale)
      outline%height = height_text(outline%window)
   end subroutine find_outline

   !> The scale of the displacements, and what both shapes cover then.
   subroutine choose_window(model, results, window, largest, scale)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(range_t), intent(out) :: window(2)
      real(wp), intent(out) :: largest, scale

      window = reference_window(model%mesh)
      largest = largest_displacement(results%u)
      scale = displacement_scale(largest, hypot(span(window(1)), span(window(2))))
      call cover(window(1), model%mesh%x(1, :) + scale*results%u(1, :))
      call cover(window(2), model%mesh%x(2, :) + scale*results%u(2, :))
   end subroutine choose_window

   !> Writes mesh.dat and mesh.gp into the set of the plots' folder.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_mesh_plot(set, model, results, origin, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(origin_t), intent(in) :: origin
      type(status_t), intent(out) :: status
      type(mesh_lines_t) :: lines
      type(range_t) :: window(2)
      real(wp) :: largest, scale

      call collect_lines(model%mesh, model%section_of, model%mesh%n_nodes > MOST_NODES, lines)
      call choose_window(model, results, window, largest, scale)
      call write_data(set, model, results, lines, status)
      if (is_ok(status)) call write_script(set, model, results, origin, lines, window, largest, scale, status)
   end subroutine write_mesh_plot

   !> Collects the edges, each once. A line between two sections counts as outline; rigid surfaces are not among them.
   subroutine collect_lines(mesh, section_of, only_outline, lines)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: section_of(:)      !< (n_elements)
      logical, intent(in) :: only_outline
      type(mesh_lines_t), intent(out) :: lines
      type(bodies_t) :: bodies
      integer(ip), allocatable :: neighbour(:, :)
      integer(ip) :: body, kind

      call find_bodies(mesh, bodies)
      call find_neighbours(mesh, neighbour)
      allocate (lines%element(MOST_SIDES*mesh%n_elements), lines%face(MOST_SIDES*mesh%n_elements), source=0_ip)
      allocate (lines%first(2*bodies%n + 1), lines%kind(2*bodies%n), lines%body(2*bodies%n), source=1_ip)
      do kind = LINE_INNER, LINE_OUTER
         if (kind == LINE_INNER .and. only_outline) cycle
         do body = 1, bodies%n
            call add_edges(mesh, bodies%list(body)%elements, neighbour, section_of, kind, lines)
            if (lines%n + 1 == lines%first(lines%n_runs + 1)) cycle
            lines%n_runs = lines%n_runs + 1
            lines%kind(lines%n_runs) = kind
            lines%body(lines%n_runs) = body
            lines%first(lines%n_runs + 1) = lines%n + 1
         end do
      end do
   end subroutine collect_lines

   !> The element beyond each face; 0 where there is none.
   subroutine find_neighbours(mesh, neighbour)
      type(mesh_t), intent(in) :: mesh
      integer(ip), allocatable, intent(out) :: neighbour(:, :)  !< (MOST_SIDES, n_elements)
      type(node_elements_t) :: around
      integer(ip) :: e, face, i, other, a, b

      around = list_node_elements(mesh)
      allocate (neighbour(MOST_SIDES, mesh%n_elements), source=0_ip)
      do e = 1, mesh%n_elements
         do face = 1, side_count(mesh, e)
            a = mesh%nodes(face, e)
            b = mesh%nodes(face_end(mesh, e, face), e)
            do i = around%first(a), around%first(a + 1) - 1
               do other = 1, side_count(mesh, around%list(i))
                  if (mesh%nodes(other, around%list(i)) == b .and. &
                      mesh%nodes(face_end(mesh, around%list(i), other), around%list(i)) == a) neighbour(face, e) = around%list(i)
               end do
            end do
         end do
      end do
   end subroutine find_neighbours

   pure subroutine add_edges(mesh, elements, neighbour, section_of, kind, lines)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: elements(:)        !< of a body
      integer(ip), intent(in) :: neighbour(:, :), section_of(:)
      integer(ip), intent(in) :: kind               !< LINE_INNER or LINE_OUTER
      type(mesh_lines_t), intent(inout) :: lines
      integer(ip) :: i, e, face, beyond, its_kind

      do i = 1, size(elements, kind=ip)
         e = elements(i)
         do face = 1, side_count(mesh, e)
            beyond = neighbour(face, e)
            if (beyond > 0 .and. beyond < e) cycle
            its_kind = LINE_OUTER
            if (beyond > 0) its_kind = merge(LINE_INNER, LINE_OUTER, section_of(beyond) == section_of(e))
            if (its_kind /= kind) cycle
            lines%n = lines%n + 1
            lines%element(lines%n) = e
            lines%face(lines%n) = face
         end do
      end do
   end subroutine add_edges

   !> What the undeformed bodies cover; nodes in no element do not count.
   pure function reference_window(mesh) result(window)
      type(mesh_t), intent(in) :: mesh
      type(range_t) :: window(2)
      integer(ip) :: e, i

      do e = 1, mesh%n_elements
         do i = 1, 2
            call cover(window(i), mesh%x(i, mesh%nodes(:mesh%shape(e), e)))
         end do
      end do
   end function reference_window

   pure real(wp) function largest_displacement(u) result(largest)
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      integer(ip) :: i

      largest = 0.0_wp
      do i = 1, size(u, 2, kind=ip)
         if (all(ieee_is_finite(u(:, i)))) largest = max(largest, hypot(u(1, i), u(2, i)))
      end do
   end function largest_displacement

   !> The number of the series 1, 2, 5, 10, ... with which the largest displacement is drawn 3 to 8 % of the scene long; 1
   !> where nothing moves.
   pure real(wp) function displacement_scale(largest, size_of_scene) result(scale)
      real(wp), intent(in) :: largest               !< displacement [L]
      real(wp), intent(in) :: size_of_scene         !< diagonal [L]
      real(wp) :: wanted, power
      integer :: exponent_of_ten

      scale = 1.0_wp
      if (largest <= tiny(largest)*1.0e3_wp .or. size_of_scene <= 0.0_wp) return
      wanted = LARGEST_SHARE*size_of_scene/largest
      if (.not. ieee_is_finite(wanted)) return
      exponent_of_ten = floor(log10(wanted))
      power = 10.0_wp**exponent_of_ten
      scale = power
      if (2.0_wp*power <= wanted) scale = 2.0_wp*power
      if (5.0_wp*power <= wanted) scale = 5.0_wp*power
   end function displacement_scale

   !> Blocks of mesh.dat: the runs of edges, then the rigid surfaces of the pairs.
   subroutine write_data(set, model, results, lines, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(mesh_lines_t), intent(in) :: lines
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      integer(ip) :: run, i
      real(wp) :: sizes(2)

      call open_text(set, MESH_PLOT//'.dat', file)
      call put_line(file, '# edges of the elements as polylines; columns: x [L]  y [L]  u1 [L]  u2 [L]')
      sizes = [scene_size(model%mesh), largest_displacement(results%u)]
      do run = 1, lines%n_runs
         call put_line(file, '# block '//to_text(run - 1)//': '//run_text(lines, run))
         do i = lines%first(run), lines%first(run + 1) - 1
            call put_edge(file, model%mesh, results%u, lines%element(i), lines%face(i), sizes)
         end do
         call put_line(file, '')
      end do
      do i = 1, size(model%surfaces, kind=ip)
         if (is_drawn_rigid(model, i)) call put_rigid(file, model%surfaces(i))
      end do
      call close_text(file, status)
   end subroutine write_data

   pure real(wp) function scene_size(mesh)
      type(mesh_t), intent(in) :: mesh
      type(range_t) :: window(2)

      window = reference_window(mesh)
      scene_size = hypot(span(window(1)), span(window(2)))
   end function scene_size

   pure function run_text(lines, run) result(text)
      type(mesh_lines_t), intent(in) :: lines
      integer(ip), intent(in) :: run
      character(len=:), allocatable :: text

      text = 'body '//to_text(lines%body(run))
      if (lines%kind(run) == LINE_INNER) then
         text = text//', edges inside'
      else
         text = text//', outline and lines between sections'
      end if
   end function run_text

   !> An edge from corner to corner; a curved one in pieces.
   subroutine put_edge(file, mesh, u, element, face, sizes)
      type(text_file_t), intent(inout) :: file
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: element, face
      real(wp), intent(in) :: sizes(2)              !< of the scene and of the displacements [L]
      real(wp) :: v(4, 3), n(3), t
      integer :: i, n_pieces

      v(:, 1) = at_node(mesh, u, mesh%nodes(face, element))
      v(:, 2) = at_node(mesh, u, mesh%nodes(face_end(mesh, element, face), element))
      v(:, 3) = 0.5_wp*(v(:, 1) + v(:, 2))
      if (middle_node(mesh, element, face) > 0) v(:, 3) = at_node(mesh, u, middle_node(mesh, element, face))
      n_pieces = merge(1, PIECES, is_straight(v, sizes))
      do i = 0, n_pieces
         t = 2.0_wp*real(i, wp)/real(n_pieces, wp) - 1.0_wp
         n = [0.5_wp*t*(t - 1.0_wp), 0.5_wp*t*(t + 1.0_wp), 1.0_wp - t*t]
         call put_place(file, matmul(v, n))
      end do
      call put_line(file, '')
   end subroutine put_edge

   pure function at_node(mesh, u, node) result(v)
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: node
      real(wp) :: v(4)

      v = [mesh%x(:, node), u(:, node)]
   end function at_node

   pure logical function is_straight(v, sizes)
      real(wp), intent(in) :: v(4, 3), sizes(2)
      real(wp) :: off(4)

      is_straight = .false.
      off = abs(v(:, 3) - 0.5_wp*(v(:, 1) + v(:, 2)))
      if (.not. all(ieee_is_finite(off))) return
      is_straight = all(off(1:2) <= STRAIGHT*sizes(1)) .and. all(off(3:4) <= STRAIGHT*sizes(2)/LARGEST_SHARE)
   end function is_straight

   !> A place and its displacement, and more columns.
   subroutine put_place(file, v, more)
      type(text_file_t), intent(inout) :: file
      real(wp), intent(in) :: v(4)
      character(len=*), intent(in), optional :: more
      character(len=:), allocatable :: line

      line = trimmed_real(v(1), DIGITS)//' '//trimmed_real(v(2), DIGITS)//' '//trimmed_real(v(3), DIGITS)//' '// &
             trimmed_real(v(4), DIGITS)
      if (present(more)) line = line//' '//more
      call put_line(file, line)
   end subroutine put_place

   !> A rigid surface that is the master of a pair.
   pure logical function is_drawn_rigid(model, surface)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: surface

      is_drawn_rigid = model%surfaces(surface)%kind == SURFACE_SEGMENTS .and. any(model%pairs%master == surface)
      if (is_drawn_rigid) is_drawn_rigid = allocated(model%surfaces(surface)%points)
   end function is_drawn_rigid

   subroutine put_rigid(file, surface)
      type(text_file_t), intent(inout) :: file
      type(surface_t), intent(in) :: surface        !< of segments
      real(wp) :: place(2)
      integer :: i, j, n_pieces

      call put_line(file, '# a rigid surface')
      call put_place(file, [surface%points(:, 1), 0.0_wp, 0.0_wp])
      do i = 1, size(surface%points, 2) - 1
         n_pieces = 1
         if (is_arc(surface, i)) n_pieces = ARC_PIECES
         do j = 1, n_pieces
            place = surface%points(:, i + 1)
            if (j < n_pieces) place = arc_place(surface, i, real(j, wp)/real(n_pieces, wp))
            call put_place(file, [place, 0.0_wp, 0.0_wp])
         end do
      end do
      call put_line(file, '')
      call put_line(file, '')
   end subroutine put_rigid

   pure logical function is_arc(surface, segment)
      type(surface_t), intent(in) :: surface
      integer, intent(in) :: segment

      is_arc = allocated(surface%is_arc) .and. allocated(surface%centre)
      if (is_arc) is_arc = surface%is_arc(segment)
   end function is_arc

   !> The place at a share of an arc, which goes the shorter way round its centre.
   pure function arc_place(surface, segment, share) result(place)
      type(surface_t), intent(in) :: surface
      integer, intent(in) :: segment
      real(wp), intent(in) :: share                 !< 0..1
      real(wp) :: place(2), from(2), to(2), angle

      associate (centre => surface%centre(:, segment))
         from = surface%points(:, segment) - centre
         to = surface%points(:, segment + 1) - centre
         angle = share*atan2(from(1)*to(2) - from(2)*to(1), dot_product(from, to))
         place = centre + cos(angle)*from + sin(angle)*[-from(2), from(1)]
      end associate
   end function arc_place

   subroutine write_script(set, model, results, origin, lines, window, largest, scale, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(origin_t), intent(in) :: origin
      type(mesh_lines_t), intent(in) :: lines
      type(range_t), intent(in) :: window(2)        !< what both shapes cover
      real(wp), intent(in) :: largest, scale
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      integer(ip) :: body

      call open_text(set, MESH_PLOT//'.gp', file)
      call put_top(file, MESH_PLOT, 'the deformed mesh over the undeformed one')
      call put_line(file, '# Columns of mesh.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; a block a body and kind of line')
      call put_line(file, 'scale = '//to_text(scale)//'   # of the displacements; change it here')
      call put_line(file, 'heading = '//quoted(picture_title(origin)))
      call put_frame(file, MESH_PLOT, window)
      do body = 1, N_COLOURS
         call put_line(file, 'set style line '//to_text(body)//' lt 1 lc rgb "'//COLOUR(body)//'"')
      end do
      ! a label, not a title: gnuplot measures titles as enhanced text even where they are not, and complains
      call put_line(file, 'set tmargin 4')
      call put_line(file, 'set label 1 heading.sprintf("\ndisplacements drawn %g '//TIMES//', the largest is %g [L]", scale, '// &
                    to_text(largest, 4)//') at screen 0.5, screen 1 - 22.0/height center noenhanced')
      call put_curves(file, model, results, lines)
      call put_line(file, LOOP_END)
      call put_line(file, 'set output')
      call close_text(file, status)
   end subroutine write_script

   !> Pixels of height that go with a width of 1000 and equal axes.
   pure function height_text(window) result(text)
      type(range_t), intent(in) :: window(2)
      character(len=:), allocatable :: text
      real(wp) :: ratio

      ratio = 1.0_wp
      if (span(window(1)) > 0.0_wp) ratio = span(window(2))/span(window(1))
      text = to_text(nint(160.0_wp + 860.0_wp*min(1.1_wp, max(0.15_wp, ratio)), ip))
   end function height_text

   !> One plot: the undeformed edges, the deformed ones inside, then the outlines with the bodies' names, and rigid surfaces.
   subroutine put_curves(file, model, results, lines)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(mesh_lines_t), intent(in) :: lines
      type(string_t), allocatable :: curves(:)
      integer(ip) :: run, i, n_blocks, first

      first = 1
      if (model%mesh%n_nodes > FEW_NODES) first = count(lines%kind(:lines%n_runs) == LINE_INNER, kind=ip) + 1_ip
      call append_string(curves, 'plot for [i='//to_text(first - 1)//':'//to_text(lines%n_runs - 1)// &
                         '] "mesh.dat" index i using 1:2 with lines ls 8 title i == '//to_text(first - 1)//' ? "undeformed" : ""')
      do run = 1, lines%n_runs
         call append_string(curves, '   "mesh.dat" index '//to_text(run - 1)// &
                            ' using ($1 + scale*$3):($2 + scale*$4) with lines ls '// &
                            to_text(mod(lines%body(run) - 1, int(N_COLOURS, ip)) + 1_ip)// &
                            legend_text(results, lines, run, model%mesh%n_nodes))
      end do
      n_blocks = lines%n_runs
      do i = 1, size(model%surfaces, kind=ip)
         if (.not. is_drawn_rigid(model, i)) cycle
         call append_string(curves, '   "mesh.dat" index '//to_text(n_blocks)//' using 1:2 with lines ls 9 title '// &
                            quoted(cleaned(model%surfaces(i)%name, LONGEST_NAME)//' (rigid)')//' noenhanced')
         n_blocks = n_blocks + 1
      end do
      do i = 1, size(curves, kind=ip) - 1
         call put_line(file, curves(i)%s//', \')
      end do
      call put_line(file, curves(size(curves))%s)
   end subroutine put_curves

   !> Width and name of a run of lines; the name stands at the outline.
   pure function legend_text(results, lines, run, n_nodes) result(text)
      type(results_t), intent(in) :: results
      type(mesh_lines_t), intent(in) :: lines
      integer(ip), intent(in) :: run, n_nodes
      character(len=:), allocatable :: text

      text = ' lw 1'
      if (n_nodes > FEW_NODES) text = ' lw 0.5'
      if (lines%kind(run) == LINE_INNER) return
      text = ' lw 2.5'
      if (lines%body(run) > MOST_NAMES) return
      text = text//' title '//quoted(body_name(results, lines%body(run)))//' noenhanced'
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

   !> Ranges, terminal, border and the lines of what is undisplaced (8) and rigid (9), of a picture of bodies in the plane.
   subroutine put_frame(file, name, window)
      type(text_file_t), intent(inout) :: file
      character(len=*), intent(in) :: name           !< of the picture
      type(range_t), intent(in) :: window(2)        !< [L]

      call put_line(file, 'set xrange '//range_text(padded(window(1))))
      call put_line(file, 'set yrange '//range_text(padded(window(2))))
      call put_line(file, 'height = '//height_text(window))
      call put_terminal(file, name, '1000,height')
      call put_line(file, 'set size ratio -1')
      call put_line(file, 'set clip two')
      call put_line(file, 'set border lt 1 lw 1 lc rgb "#A0A0A0"')
      call put_line(file, 'set tics nomirror out scale 0.6 textcolor rgb "black" format "%h"')
      call put_line(file, 'set key noautotitle outside bottom center horizontal Left reverse samplen 2 height 0.7')
      call put_line(file, 'set xlabel "x [L]"')
      call put_line(file, 'set ylabel "y [L]"')
      call put_line(file, 'set style line 8 lt 1 lw 1 lc rgb "#B0B0B0"')
      call put_line(file, 'set style line 9 lt 1 lw 4 lc rgb "#404040"')
   end subroutine put_frame

end module atrito_mesh_plot
