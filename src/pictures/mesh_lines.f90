!> The lines of pictures of bodies in the plane: edges of the mesh and rigid surfaces, where they are and where they go.
!>
!> Data files hold edges as polylines of place and displacement, so that the script can choose the scale. Each edge is there once.
module atrito_mesh_lines
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_element_table, only: MOST_SIDES
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_faces, only: node_elements_t, list_node_elements
   use atrito_files, only: file_set_t, text_file_t, put_line, close_text
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_end, side_between, side_count, middle_node
   use atrito_model, only: model_t, surface_t, SURFACE_SEGMENTS
   use atrito_number_text, only: trimmed_real
   use atrito_plot_text, only: range_t, cover, range_text, span, quoted, cleaned, put_terminal, put_plot, N_COLOURS
   use atrito_plot_files, only: open_data, JOINT_PLOT
   use atrito_plot_view, only: plot_view_t, shown_window
   use atrito_results, only: rigid_result_t
   use atrito_status, only: status_t
   use atrito_strings, only: string_t, append_string, to_text
   implicit none (type, external)
   private
   public :: mesh_lines_t, drawing_t, begin_drawing, displace, displacement_scale, collect_lines
   public :: write_lines, put_lines, put_rigid_lines, put_place, put_window, put_axes, put_frame, put_scene
   public :: add_lines, add_rigid_lines, is_drawn_rigid, rigid_places, body_style
   public :: LINE_INNER, MOST_NAMES, LONGEST_NAME

   integer, parameter :: DIGITS = 7                 !< of the data: a picture has a thousand pixels
   integer, parameter :: PIECES = 10                !< straight pieces of a curved edge
   integer, parameter :: ARC_PIECES = 60            !< of a rigid arc
   !> An edge whose middle node is off the middle by less than this share of the scene, or of the largest displacement, is straight.
   real(wp), parameter :: STRAIGHT = 3.0e-4_wp
   !> The largest displacement is drawn at most this long, as a share of the scene's diagonal.
   real(wp), parameter :: LARGEST_SHARE = 0.08_wp
   integer(ip), parameter :: MOST_NAMES = 8         !< bodies in the legend
   integer, parameter :: LONGEST_NAME = 24          !< characters of a body's name
   integer, parameter :: LEGEND_LINE = 22           !< pixels
   integer(ip), parameter :: LINE_INNER = 1, LINE_OUTER = 2

   !> What is drawn: edges of the mesh, in runs of one kind and body.
   type :: mesh_lines_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: element(:), face(:)   !< (n)
      integer(ip) :: n_runs = 0
      integer(ip), allocatable :: first(:)              !< (n_runs + 1) where each begins
      integer(ip), allocatable :: kind(:), body(:)      !< (n_runs)
   end type mesh_lines_t

   !> Lines, and how they are displaced.
   type :: drawing_t
      type(mesh_lines_t) :: lines
      type(range_t) :: window(2)                        !< what both shapes cover [L]
      real(wp) :: size = 0.0_wp                         !< diagonal of the undisplaced bodies [L]
      real(wp) :: largest = 0.0_wp                      !< displacement [L]
      real(wp) :: scale = 1.0_wp                        !< of the displacements
      type(plot_view_t) :: view                         !< what is asked of it
      type(rigid_result_t), allocatable :: rigid(:)     !< motions of the model's rigid bodies; without them they stay
   end type drawing_t

contains

   !> Collects the lines of a scene; nothing is displaced yet.
   subroutine begin_drawing(model, only_outline, drawing)
      type(model_t), intent(in) :: model
      logical, intent(in) :: only_outline
      type(drawing_t), intent(out) :: drawing
      integer(ip) :: e, i

      call collect_lines(model%mesh, model%section_of, only_outline, drawing%lines)
      do e = 1, model%mesh%n_elements               ! nodes in no element do not count
         do i = 1, 2
            call cover(drawing%window(i), model%mesh%x(i, model%mesh%nodes(:model%mesh%shape(e), e)))
         end do
      end do
      drawing%size = hypot(span(drawing%window(1)), span(drawing%window(2)))
   end subroutine begin_drawing

   !> Widens the window by the displaced shape.
   pure subroutine displace(drawing, mesh, u, largest, scale)
      type(drawing_t), intent(inout) :: drawing
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(in) :: largest, scale
      integer :: i

      drawing%largest = largest
      drawing%scale = scale
      do i = 1, 2
         call cover(drawing%window(i), mesh%x(i, :) + scale*u(i, :))
      end do
   end subroutine displace

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
      integer(ip) :: e, face, i, a, b

      around = list_node_elements(mesh)
      allocate (neighbour(MOST_SIDES, mesh%n_elements), source=0_ip)
      do e = 1, mesh%n_elements
         do face = 1, side_count(mesh, e)
            a = mesh%nodes(face, e)
            b = mesh%nodes(face_end(mesh, e, face), e)
            do i = around%first(a), around%first(a + 1) - 1
               if (side_between(mesh, around%list(i), b, a) > 0) neighbour(face, e) = around%list(i)
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

   !> Writes <name>.dat: a block a run of edges, then a block a rigid surface of the pairs.
   subroutine write_lines(set, name, heading, of_kind, model, u, drawing, status)
      type(file_set_t), intent(inout) :: set
      character(len=*), intent(in) :: name, heading
      character(len=*), intent(in) :: of_kind(:)    !< what is said of inner edges and of outlines
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(drawing_t), intent(in) :: drawing
      type(status_t), intent(out) :: status
      type(text_file_t) :: file

      call open_data(set, name, file)
      call put_line(file, heading)
      call put_lines(file, of_kind, model, u, drawing)
      call put_rigid_lines(file, model, drawing%rigid)
      call close_text(file, status)
   end subroutine write_lines

   !> A block a run of edges.
   subroutine put_lines(file, of_kind, model, u, drawing)
      type(text_file_t), intent(inout) :: file
      character(len=*), intent(in) :: of_kind(:)    !< what is said of inner edges and of outlines
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(drawing_t), intent(in) :: drawing
      integer(ip) :: run, i

      associate (lines => drawing%lines)
         do run = 1, lines%n_runs
            call put_line(file, '# block '//to_text(run - 1)//': body '//to_text(lines%body(run))//trim(of_kind(lines%kind(run))))
            do i = lines%first(run), lines%first(run + 1) - 1
               call put_edge(file, model%mesh, u, lines%element(i), lines%face(i), [drawing%size, drawing%largest])
            end do
            call put_line(file, '')
         end do
      end associate
   end subroutine put_lines

   !> A block a rigid surface of the pairs.
   subroutine put_rigid_lines(file, model, rigid)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(rigid_result_t), intent(in), optional :: rigid(:)
      real(wp) :: motion(5)
      integer(ip) :: i

      do i = 1, size(model%surfaces, kind=ip)
         motion = 0.0_wp
         if (present(rigid)) motion = motion_of(model, i, rigid)
         if (is_drawn_rigid(model, i)) call put_rigid(file, model%surfaces(i), motion)
      end do
   end subroutine put_rigid_lines

   !> The rigid body of a surface; 0: it stays where it is.
   pure integer(ip) function body_of_surface(model, surface) result(body)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: surface

      body = 0
      if (allocated(model%rigid_bodies)) body = findloc(model%rigid_bodies%surface, surface, dim=1, kind=ip)
   end function body_of_surface

   !> u1, u2 and rotation of a rigid surface, and the place about which it turns.
   pure function motion_of(model, surface, rigid) result(motion)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: surface
      type(rigid_result_t), intent(in) :: rigid(:)
      real(wp) :: motion(5)                         !< [L], [L], [-], [L], [L]

      motion = 0.0_wp
      associate (body => body_of_surface(model, surface))
         if (body > 0) motion = [rigid(body)%u, rigid(body)%rotation, model%mesh%x(:, model%rigid_bodies(body)%node)]
      end associate
   end function motion_of

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

   subroutine put_rigid(file, surface, motion)
      type(text_file_t), intent(inout) :: file
      type(surface_t), intent(in) :: surface        !< of segments
      real(wp), intent(in) :: motion(5)             !< as motion_of has it
      real(wp), allocatable :: places(:, :)
      integer :: i

      call put_line(file, '# a rigid surface')
      places = rigid_places(surface)
      do i = 1, size(places, 2)
         call put_place(file, moved(places(:, i)))
      end do
      call put_line(file, '')
      call put_line(file, '')

   contains

      pure function moved(x) result(v)
         real(wp), intent(in) :: x(2)
         real(wp) :: v(4)

         v = [x, motion(1) - motion(3)*(x(2) - motion(5)), motion(2) + motion(3)*(x(1) - motion(4))]
      end function moved

   end subroutine put_rigid

   !> The places of a rigid surface from its first end to its last, arcs in pieces.
   pure function rigid_places(surface) result(places)
      type(surface_t), intent(in) :: surface        !< of segments
      real(wp), allocatable :: places(:, :)         !< (2, n) [L]
      integer :: i, j, n

      n = size(surface%points, 2)
      do i = 1, size(surface%points, 2) - 1
         if (is_arc(surface, i)) n = n + ARC_PIECES - 1
      end do
      allocate (places(2, n))
      places(:, 1) = surface%points(:, 1)
      n = 1
      do i = 1, size(surface%points, 2) - 1
         do j = 1, merge(ARC_PIECES, 1, is_arc(surface, i)) - 1
            n = n + 1
            places(:, n) = arc_place(surface, i, real(j, wp)/real(ARC_PIECES, wp))
         end do
         n = n + 1
         places(:, n) = surface%points(:, i + 1)
      end do
   end function rigid_places

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

   !> Ranges, terminal, border and axes of a picture of bodies in the plane, and what it says above.
   subroutine put_frame(file, name, window, view, legend)
      type(text_file_t), intent(inout) :: file
      character(len=*), intent(in) :: name          !< of the picture
      type(range_t), intent(in) :: window(2)        !< of all that is drawn [L]
      type(plot_view_t), intent(in) :: view
      integer, intent(in), optional :: legend       !< its lines, two of which have room anyhow

      call put_window(file, window, view)
      if (present(legend)) then
         if (legend > 2) call put_line(file, 'height = height + '//to_text(int(LEGEND_LINE*(legend - 2), ip)))
      end if
      call put_terminal(file, name, '1000,height')
      call put_axes(file, name)
   end subroutine put_frame

   !> Ranges, and the height of the picture for a width of 1000.
   subroutine put_window(file, window, view)
      type(text_file_t), intent(inout) :: file
      type(range_t), intent(in) :: window(2)        !< of all that is drawn [L]
      type(plot_view_t), intent(in) :: view
      type(range_t) :: shown(2)
      real(wp) :: ratio

      shown = shown_window(view, window)
      ratio = 1.0_wp
      if (span(window(1)) > 0.0_wp) ratio = span(window(2))/span(window(1))
      if (allocated(view%box)) ratio = span(shown(2))/span(shown(1))
      call put_line(file, 'set xrange '//range_text(shown(1)))
      call put_line(file, 'set yrange '//range_text(shown(2)))
      call put_line(file, 'height = '//to_text(nint(160.0_wp + 860.0_wp*min(1.1_wp, max(0.15_wp, ratio)), ip)))
   end subroutine put_window

   !> Border, marks, legend and the names of the axes of a picture of bodies, and the line styles 8 (undisplaced) and 9 (rigid).
   subroutine put_axes(file, name)
      type(text_file_t), intent(inout) :: file
      character(len=*), intent(in) :: name          !< of the picture

      call put_line(file, 'set size ratio -1')
      if (name /= JOINT_PLOT) call put_line(file, 'set clip two')
      call put_line(file, 'set border lt 1 lw 1 lc rgb "#A0A0A0"')
      call put_line(file, 'set tics nomirror out scale 0.6 textcolor rgb "black" format "%h"')
      call put_line(file, 'set key noautotitle outside bottom center horizontal Left reverse samplen 2 height 0.7')
      call put_line(file, 'set xlabel "x [L]"')
      call put_line(file, 'set ylabel "y [L]"')
      if (name == JOINT_PLOT) return
      call put_line(file, 'set style line 8 lt 1 lw 1 lc rgb "#B0B0B0"')
      call put_line(file, 'set style line 9 lt 1 lw 4 lc rgb "#404040"')
   end subroutine put_axes

   !> The plot: where the bodies were (lines of style 8), where they go, each run of edges in its style, and rigid surfaces (9).
   subroutine put_scene(file, name, first, undisplaced, styles, model, more)
      type(text_file_t), intent(inout) :: file
      character(len=*), intent(in) :: name          !< of the data file, without .dat
      integer(ip), intent(in) :: first              !< block that is drawn undisplaced, and those behind it; past the last: none
      character(len=*), intent(in) :: undisplaced   !< what they are called
      type(string_t), intent(in) :: styles(:)       !< (runs) of the displaced lines
      type(model_t), intent(in) :: model
      type(string_t), intent(in), optional :: more(:)   !< curves over them
      type(string_t), allocatable :: curves(:)
      integer(ip) :: i, n

      n = size(styles, kind=ip)
      if (first < n) call append_string(curves, 'plot for [i='//to_text(first)//':'//to_text(n - 1)//'] "'//name// &
                                        '.dat" index i using 1:2 with lines ls 8 title i == '//to_text(first)//' ? "'// &
                                        undisplaced//'" : ""')
      do i = 1, n
         call add_lines(name, i - 1, i - 1, styles(i)%s, curves)
      end do
      if (first >= n) curves(1)%s = 'plot'//curves(1)%s
      call add_rigid_lines(name, n, 'ls 9', .true., model, curves)
      if (present(more)) curves = [curves, more]
      call put_plot(file, curves)
   end subroutine put_scene

   !> Adds the displaced lines of some blocks to the curves of a plot.
   subroutine add_lines(name, first, last, style, curves)
      character(len=*), intent(in) :: name          !< of the data file, without .dat
      integer(ip), intent(in) :: first, last        !< blocks, from 0
      character(len=*), intent(in) :: style
      type(string_t), allocatable, intent(inout) :: curves(:)
      character(len=:), allocatable :: blocks

      blocks = to_text(first)
      if (last > first) blocks = blocks//':'//to_text(last)
      call append_string(curves, '   "'//name//'.dat" index '//blocks//' using ($1 + scale*$3):($2 + scale*$4) with lines '//style)
   end subroutine add_lines

   !> Adds the rigid surfaces, a block each, to the curves of a plot. Those that do not move stay where they are whatever the scale.
   subroutine add_rigid_lines(name, first, style, has_title, model, curves)
      character(len=*), intent(in) :: name          !< of the data file, without .dat
      integer(ip), intent(in) :: first              !< block
      character(len=*), intent(in) :: style
      logical, intent(in) :: has_title              !< each has its name in the key
      type(model_t), intent(in) :: model
      type(string_t), allocatable, intent(inout) :: curves(:)
      character(len=:), allocatable :: places, title
      integer(ip) :: i, n

      n = first
      do i = 1, size(model%surfaces, kind=ip)
         if (.not. is_drawn_rigid(model, i)) cycle
         places = '1:2'
         if (body_of_surface(model, i) > 0) places = '($1 + scale*$3):($2 + scale*$4)'
         title = ''
         if (has_title) title = ' title '//quoted(cleaned(model%surfaces(i)%name, LONGEST_NAME)//' (rigid)')//' noenhanced'
         call append_string(curves, '   "'//name//'.dat" index '//to_text(n)//' using '//places//' with lines '//style//title)
         n = n + 1
      end do
   end subroutine add_rigid_lines

   !> The line style of a body's colour.
   pure function body_style(body) result(text)
      integer(ip), intent(in) :: body
      character(len=:), allocatable :: text

      text = 'ls '//to_text(mod(body - 1, int(N_COLOURS, ip)) + 1_ip)
   end function body_style

end module atrito_mesh_lines
