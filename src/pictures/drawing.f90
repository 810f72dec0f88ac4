!> Pictures of bodies in the plane: edges of the mesh and rigid surfaces, where they are and where they go.
!>
!> Data files hold edges as polylines of place and displacement, so that the script can choose the scale. Each edge is there once.
module atrito_drawing
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_end, middle_node
   use atrito_mesh_lines, only: mesh_lines_t, collect_lines, rigid_places, LINE_INNER
   use atrito_model, only: model_t, SURFACE_SEGMENTS
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: JOINT_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_data, put_terminal, put_plot
   use atrito_plot_text, only: range_t, cover, range_text, span, quoted, cleaned, round_step, LF, MOST_STYLES, TIMES
   use atrito_plot_view, only: plot_view_t, shown_window
   use atrito_results, only: results_t, rigid_result_t
   use atrito_strings, only: string_t, append_string, to_text
   implicit none (type, external)
   private
   public :: drawing_t, begin_drawing, displace, displacement_scale, overlap_scale, largest_length
   public :: write_lines, put_lines, put_rigid_lines, put_place, put_head, put_window, put_axes, put_plane, put_scene
   public :: add_lines, add_rigid_lines, put_title, scale_title, displacement_text, overlap_text, put_ticks, pixel_of
   public :: run_styles, body_style, body_title, MOVED

   integer, parameter :: DIGITS = 7                 !< of the data: a picture has a thousand pixels
   integer, parameter :: PIECES = 10                !< straight pieces of a curved edge
   !> An edge whose middle node is off the middle by less than this share of the scene, or of the largest displacement, is straight.
   real(wp), parameter :: STRAIGHT = 3.0e-4_wp
   !> The largest displacement is drawn at most this long, as a share of the scene's diagonal.
   real(wp), parameter :: LARGEST_SHARE = 0.08_wp
   !> Sides that overlap by less than this share are seen to touch; where they would overlap by more the scale is less, but not so
   !> small that the largest displacement is drawn shorter than the other share.
   real(wp), parameter :: SEEN_SHARE = 0.004_wp, LEAST_SHARE = 0.005_wp
   !> Of the plane of a picture, in pixels: put_window makes it so. Numbers at the axes are no nearer than APART.
   real(wp), parameter :: PLANE_WIDTH = 860.0_wp, MOST_HEIGHT = 946.0_wp, APART = 70.0_wp
   integer(ip), parameter :: MOST_NAMES = MOST_STYLES   !< bodies in the legend
   integer, parameter :: LONGEST_NAME = 24          !< characters of a body's name
   integer(ip), parameter :: LEGEND_LINE = 22       !< pixels
   !> How a script has a place with its displacement.
   character(len=*), parameter :: MOVED = '($1 + scale*$3):($2 + scale*$4)'
   !> What is said of lines of each kind.
   character(len=*), parameter :: OF_KIND(2) = [character(len=40) :: ', edges inside', ', outline and lines between sections']

   !> A scene with its lines, and how they are displaced.
   type :: drawing_t
      type(model_t), pointer :: model => null()         !< not the drawing's own
      type(results_t), pointer :: results => null()     !< of a run: those of its last frame
      character(len=:), allocatable :: heading          !< first line of the title
      real(wp), allocatable :: u(:, :)                  !< (2, n_nodes) [L]
      type(mesh_lines_t) :: lines                       !< edges that are drawn, in runs
      integer(ip) :: n_inner = 0                        !< runs of inner edges, which come first
      integer(ip), allocatable :: surface(:), body(:)   !< rigid surfaces that are masters of pairs; their bodies, 0: they stay
      type(range_t) :: window(2)                        !< what both shapes cover [L]
      real(wp) :: size = 0.0_wp                         !< diagonal of the undisplaced bodies [L]
      real(wp) :: largest = 0.0_wp                      !< displacement [L]
      real(wp) :: scale = 0.0_wp                        !< of the displacements
      logical :: overlaps = .false.                 !< that scale makes sides overlap
      type(plot_view_t) :: view                         !< what is asked of it
      type(rigid_result_t), allocatable :: rigid(:)     !< motions of the model's rigid bodies; without them they stay
   end type drawing_t

contains

   !> Collects the lines of a scene; nothing is displaced yet. The model is looked at as long as the drawing is in use.
   subroutine begin_drawing(model, only_outline, view, drawing)
      type(model_t), intent(in), target :: model    !< mesh, sections, surfaces and pairs
      logical, intent(in) :: only_outline           !< inner edges are left out
      type(plot_view_t), intent(in) :: view         !< what is asked of the pictures of bodies
      type(drawing_t), intent(out) :: drawing       !< undisplaced, without results
      integer(ip) :: e, i

      drawing%model => model
      drawing%view = view
      allocate (drawing%u(2, model%mesh%n_nodes), source=0.0_wp)
      call collect_lines(model%mesh, model%section_of, only_outline, drawing%lines)
      do e = 1, model%mesh%n_elements               ! nodes in no element do not count
         do i = 1, 2
            call cover(drawing%window(i), model%mesh%x(i, model%mesh%nodes(:model%mesh%shape(e), e)))
         end do
      end do
      drawing%size = hypot(span(drawing%window(1)), span(drawing%window(2)))
      drawing%n_inner = count(drawing%lines%kind(:drawing%lines%n_runs) == LINE_INNER, kind=ip)
      drawing%surface = pack([(i, i=1, size(model%surfaces, kind=ip))], model%surfaces%kind == SURFACE_SEGMENTS .and. &
                             [(any(model%pairs%master == i) .and. allocated(model%surfaces(i)%points), &
                               i=1, size(model%surfaces, kind=ip))])
      allocate (drawing%body(size(drawing%surface)), source=0_ip)
      if (.not. allocated(model%rigid_bodies)) return
      do i = 1, size(drawing%surface, kind=ip)
         drawing%body(i) = findloc(model%rigid_bodies%surface, drawing%surface(i), dim=1, kind=ip)
      end do
   end subroutine begin_drawing

   !> Displaces the bodies, by the scale that is asked for, else by the one that is chosen, and widens the window to them.
   pure subroutine displace(drawing, u, largest, chosen_scale, reach)
      type(drawing_t), intent(inout) :: drawing     !< by begin_drawing
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(in) :: largest               !< displacement [L]
      real(wp), intent(in) :: chosen_scale          !< unless the user asks for one
      real(wp), intent(in) :: reach                 !< a greater scale makes sides overlap
      integer :: i

      drawing%u = u
      drawing%largest = largest
      drawing%scale = chosen_scale
      if (allocated(drawing%view%scale)) drawing%scale = drawing%view%scale
      drawing%overlaps = drawing%scale > reach
      do i = 1, 2
         call cover(drawing%window(i), drawing%model%mesh%x(i, :) + drawing%scale*u(i, :))
      end do
   end subroutine displace

   !> The number of the series 1, 2, 5, 10, ... with which the largest displacement is drawn 3 to 8 % of the scene long, or less
   !> where sides would overlap; 1 where nothing moves.
   pure real(wp) function displacement_scale(largest, size_of_scene, reach) result(scale)
      real(wp), intent(in) :: largest               !< displacement [L]
      real(wp), intent(in) :: size_of_scene         !< diagonal [L]
      real(wp), intent(in), optional :: reach       !< a greater scale makes sides overlap
      real(wp) :: wanted, power

      scale = 1.0_wp
      if (largest <= tiny(largest)*1.0e3_wp .or. size_of_scene <= 0.0_wp) return
      wanted = LARGEST_SHARE*size_of_scene/largest
      if (.not. ieee_is_finite(wanted)) return
      if (present(reach)) wanted = min(wanted, max(reach, wanted*LEAST_SHARE/LARGEST_SHARE))
      power = 10.0_wp**floor(log10(wanted))
      scale = power
      if (2.0_wp*power <= wanted) scale = 2.0_wp*power
      if (5.0_wp*power <= wanted) scale = 5.0_wp*power
   end function displacement_scale

   !> The scale of the displacements beyond which sides are seen to overlap. A point with the initial gap s and the gap g has
   !> s + scale (g - s) between the sides in the picture: with scale > 1 a gap that has closed looks like an overlap.
   pure real(wp) function overlap_scale(model, results, size_of_scene) result(reach)
      type(model_t), intent(in) :: model            !< initial gaps at the points of its pairs
      type(results_t), intent(in) :: results        !< gaps at the same points
      real(wp), intent(in) :: size_of_scene         !< diagonal [L]
      real(wp) :: nearer
      integer(ip) :: pair, j

      reach = huge(1.0_wp)
      if (.not. (allocated(model%points) .and. allocated(results%contact))) return
      do pair = 1, min(size(model%points, kind=ip), size(results%contact, kind=ip))
         associate (contact => results%contact(pair), initial => model%points(pair))
            if (initial%n /= contact%n) cycle
            do j = 1, contact%n
               nearer = initial%gap(j) - contact%gap(j)
               if (.not. ieee_is_finite(nearer)) cycle
               if (nearer > tiny(nearer)*1.0e3_wp) reach = min(reach, (max(0.0_wp, initial%gap(j)) + &
                                                                       SEEN_SHARE*size_of_scene)/nearer)
            end do
         end associate
      end do
   end function overlap_scale

   !> The largest length of some vectors, those left out that are no numbers; 0 where there are none.
   pure real(wp) function largest_length(vectors) result(largest)
      real(wp), intent(in) :: vectors(:, :)         !< (2, n)
      integer(ip) :: i

      largest = 0.0_wp
      do i = 1, size(vectors, 2, kind=ip)
         if (all(ieee_is_finite(vectors(:, i)))) largest = max(largest, hypot(vectors(1, i), vectors(2, i)))
      end do
   end function largest_length

   !> Writes <name>.dat: a block a run of edges, then a block a rigid surface of the pairs.
   subroutine write_lines(plots, name, what, drawing, of_kinds)
      type(plots_t), intent(inout) :: plots         !< get the data
      character(len=*), intent(in) :: name          !< of the file, without .dat
      character(len=*), intent(in) :: what          !< the file holds
      type(drawing_t), intent(in) :: drawing        !< displaced
      logical, intent(in) :: of_kinds               !< the comments say which blocks are inner edges and which outlines

      call begin_data(plots, name, what)
      call put_lines(plots, drawing, drawing%u, of_kinds)
      call put_rigid_lines(plots, drawing, drawing%rigid)
   end subroutine write_lines

   !> A block a run of edges.
   subroutine put_lines(plots, drawing, u, of_kinds)
      type(plots_t), intent(inout) :: plots         !< lines go into its open file
      type(drawing_t), intent(in) :: drawing        !< its lines
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      logical, intent(in) :: of_kinds               !< the comments say which blocks are inner edges
      integer(ip) :: run, i

      associate (lines => drawing%lines)
         do run = 1, lines%n_runs
            call put(plots, '# block '//to_text(run - 1)//': body '//to_text(lines%body(run))// &
                     trim(merge(OF_KIND(lines%kind(run)), repeat(' ', len(OF_KIND)), of_kinds)))
            do i = lines%first(run), lines%first(run + 1) - 1
               call put_edge(plots, drawing, u, lines%element(i), lines%face(i))
            end do
            call put(plots, '')
         end do
      end associate
   end subroutine put_lines

   !> An edge from corner to corner; a curved one in pieces. Place and displacement go along it as its shape functions do: with v1,
   !> v2 at the corners, v3 in the middle and t from -1 to 1,
   !>    v(t) = t(t - 1)/2 v1 + t(t + 1)/2 v2 + (1 - t^2) v3.
   !> It is straight where v3 is nearly the mean of v1 and v2, as it is without a node in the middle.
   subroutine put_edge(plots, drawing, u, element, face)
      type(plots_t), intent(inout) :: plots
      type(drawing_t), intent(in) :: drawing
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: element, face
      real(wp) :: v(4, 3), off(4), t
      integer(ip) :: nodes(3)
      integer :: i, n_pieces

      associate (mesh => drawing%model%mesh)
         nodes = [mesh%nodes(face, element), mesh%nodes(face_end(mesh, element, face), element), middle_node(mesh, element, face)]
         do i = 1, 3
            if (nodes(i) > 0) v(:, i) = [mesh%x(:, nodes(i)), u(:, nodes(i))]
         end do
      end associate
      if (nodes(3) == 0) v(:, 3) = 0.5_wp*(v(:, 1) + v(:, 2))
      n_pieces = PIECES
      off = abs(v(:, 3) - 0.5_wp*(v(:, 1) + v(:, 2)))
      if (all(ieee_is_finite(off))) then
         if (all(off(1:2) <= STRAIGHT*drawing%size) .and. all(off(3:4) <= STRAIGHT*drawing%largest/LARGEST_SHARE)) n_pieces = 1
      end if
      do i = 0, n_pieces
         t = 2.0_wp*real(i, wp)/real(n_pieces, wp) - 1.0_wp
         call put_place(plots, matmul(v, [0.5_wp*t*(t - 1.0_wp), 0.5_wp*t*(t + 1.0_wp), 1.0_wp - t*t]))
      end do
      call put(plots, '')
   end subroutine put_edge

   !> A place and its displacement, and more columns.
   subroutine put_place(plots, v, more)
      type(plots_t), intent(inout) :: plots          !< line goes into its open file
      real(wp), intent(in) :: v(4)                   !< place and displacement [L]
      character(len=*), intent(in), optional :: more !< columns, separated by blanks
      character(len=:), allocatable :: line

      line = trimmed_real(v(1), DIGITS)//' '//trimmed_real(v(2), DIGITS)//' '//trimmed_real(v(3), DIGITS)//' '// &
             trimmed_real(v(4), DIGITS)
      if (present(more)) line = line//' '//more
      call put(plots, line)
   end subroutine put_place

   !> A block a rigid surface of the pairs: its places, and the linear part of its motion there.
   subroutine put_rigid_lines(plots, drawing, rigid)
      type(plots_t), intent(inout) :: plots                    !< lines go into its open file
      type(drawing_t), intent(in) :: drawing                   !< its rigid surfaces
      type(rigid_result_t), intent(in), optional :: rigid(:)   !< left out: they rest
      real(wp), allocatable :: x(:, :)
      real(wp) :: u(2), r(2)
      integer(ip) :: i, k

      associate (model => drawing%model)
         do i = 1, size(drawing%surface, kind=ip)
            call put(plots, '# a rigid surface')
            x = rigid_places(model%surfaces(drawing%surface(i)))
            do k = 1, size(x, 2, kind=ip)
               u = 0.0_wp
               if (present(rigid) .and. drawing%body(i) > 0) then
                  associate (body => drawing%body(i))
                     r = x(:, k) - model%mesh%x(:, model%rigid_bodies(body)%node)
                     u = rigid(body)%u + rigid(body)%rotation*[-r(2), r(1)]
                  end associate
               end if
               call put_place(plots, [x(:, k), u])
            end do
            call put(plots, LF)
         end do
      end associate
   end subroutine put_rigid_lines

   !> What a script draws by: the scale of the displacements, more, and the first line of the title.
   subroutine put_head(plots, drawing, more)
      type(plots_t), intent(inout) :: plots         !< lines go into its open script
      type(drawing_t), intent(in) :: drawing        !< its scale and heading
      character(len=*), intent(in) :: more          !< lines, each with LF behind it

      call put(plots, 'scale = '//to_text(drawing%scale, 15)//'   # of the displacements; change it here'//LF//more// &
               'heading = '//quoted(drawing%heading))
   end subroutine put_head

   !> Ranges, terminal, border and axes of a picture of bodies in the plane.
   subroutine put_plane(plots, drawing, legend)
      type(plots_t), intent(inout) :: plots         !< lines go into its open script
      type(drawing_t), intent(in) :: drawing        !< its window and view
      integer(ip), intent(in), optional :: legend   !< its lines, two of which have room anyhow

      call put_window(plots, drawing)
      if (present(legend)) then
         if (legend > 2) call put(plots, 'height = height + '//to_text(LEGEND_LINE*(legend - 2)))
      end if
      call put_terminal(plots, '1000,height')
      call put_axes(plots)
   end subroutine put_plane

   !> Length of a pixel [L] in a picture of bodies.
   pure real(wp) function pixel_of(shown) result(pixel)
      type(range_t), intent(in) :: shown(2)         !< the window that is shown [L]

      pixel = max(span(shown(1))/PLANE_WIDTH, span(shown(2))/MOST_HEIGHT)
      if (.not. pixel > 0.0_wp) pixel = 1.0_wp
   end function pixel_of

   !> Border and names of the axes, and numbers at both, equally far apart.
   subroutine put_ticks(plots, pixel)
      type(plots_t), intent(inout) :: plots         !< lines go into its open script
      real(wp), intent(in) :: pixel                 !< [L]
      character(len=:), allocatable :: step

      step = to_text(round_step(APART*pixel), 6)
      call put(plots, 'set border lt 1 lw 1 lc rgb "#A0A0A0"'//LF// &
               'set tics nomirror out scale 0.6 textcolor rgb "black" format "%h"'//LF// &
               'set xtics '//step//'; set ytics '//step//LF//'set xlabel "x [L]"; set ylabel "y [L]"')
   end subroutine put_ticks

   !> Ranges, and the height of the picture for a width of 1000.
   subroutine put_window(plots, drawing)
      type(plots_t), intent(inout) :: plots         !< lines go into its open script
      type(drawing_t), intent(in) :: drawing        !< its window and view
      type(range_t) :: shown(2)
      real(wp) :: ratio

      shown = shown_window(drawing%view, drawing%window)
      ratio = 1.0_wp
      if (span(drawing%window(1)) > 0.0_wp) ratio = span(drawing%window(2))/span(drawing%window(1))
      if (allocated(drawing%view%box)) ratio = span(shown(2))/span(shown(1))
      call put(plots, 'set xrange '//range_text(shown(1))//LF//'set yrange '//range_text(shown(2))//LF// &
               'height = '//to_text(nint(160.0_wp + 860.0_wp*min(1.1_wp, max(0.15_wp, ratio)), ip)))
      call put_ticks(plots, pixel_of(shown))
   end subroutine put_window

   !> Form and legend of a picture of bodies, and the line styles 30 (undisplaced) and 31 (rigid).
   subroutine put_axes(plots)
      type(plots_t), intent(inout) :: plots         !< lines go into its open script

      call put(plots, 'set size ratio -1')
      if (plots%name /= JOINT_PLOT) call put(plots, 'set clip two')
      call put(plots, 'set key noautotitle outside bottom center horizontal Left reverse samplen 2 height 0.7'//LF// &
               'set style line 30 lt 1 lw 1 lc rgb "#B0B0B0"'//LF//'set style line 31 lt 1 lw 4 lc rgb "#404040"')
   end subroutine put_axes

   !> The title: a label, for gnuplot measures titles as enhanced text even where they are not, and complains.
   subroutine put_title(plots, text)
      type(plots_t), intent(inout) :: plots         !< line goes into its open script
      character(len=*), intent(in) :: text          !< what is put behind the heading, an expression of gnuplot

      call put(plots, 'set tmargin 4'//LF//'set label 1 heading.'//text// &
               ' at screen 0.5, screen 1 - 22.0/height center noenhanced')
   end subroutine put_title

   !> What titles say of the displacements.
   pure function scale_title(drawing) result(text)
      type(drawing_t), intent(in) :: drawing        !< its largest displacement, and whether sides overlap
      character(len=:), allocatable :: text

      text = 'sprintf("\ndisplacements drawn %g '//TIMES//overlap_text(drawing)// &
             ', the largest is %g [L]", scale, '//to_text(drawing%largest, 4)//')'
   end function scale_title

   !> What a title adds where the scale of displacements makes sides of contact overlap that do not.
   pure function overlap_text(drawing) result(text)
      type(drawing_t), intent(in) :: drawing        !< whether sides overlap
      character(len=:), allocatable :: text

      text = ''
      if (drawing%overlaps) text = ', which makes sides overlap'
   end function overlap_text

   !> The scale of the displacements in words, for a string in double quotes.
   pure function displacement_text(drawing) result(text)
      type(drawing_t), intent(in) :: drawing        !< its scale, and whether sides overlap
      character(len=:), allocatable :: text

      text = 'displacements drawn '//to_text(drawing%scale)//' '//TIMES//overlap_text(drawing)
      if (drawing%scale <= 0.0_wp) text = 'undisplaced'
   end function displacement_text

   !> The plot: where the bodies were (lines of style 30), where they go, each run of edges in its style, and rigid surfaces (31).
   subroutine put_scene(plots, drawing, first, undisplaced, styles, more)
      type(plots_t), intent(inout) :: plots         !< lines go into its open script
      type(drawing_t), intent(in) :: drawing        !< its lines and rigid surfaces
      integer(ip), intent(in) :: first              !< block that is drawn undisplaced, and those behind it; past the last: none
      character(len=*), intent(in) :: undisplaced   !< what they are called
      type(string_t), intent(in) :: styles(:)       !< (runs) of the displaced lines
      type(string_t), intent(in) :: more(:)         !< curves over them
      type(string_t), allocatable :: curves(:)
      integer(ip) :: i, n

      n = size(styles, kind=ip)
      if (first < n) call append_string(curves, 'for [i='//to_text(first)//':'//to_text(n - 1)//'] "'//plots%name// &
                                        '.dat" index i using 1:2 with lines ls 30 title i == '//to_text(first)//' ? "'// &
                                        undisplaced//'" : ""')
      do i = 1, n
         call add_lines(plots%name, i - 1, i - 1, styles(i)%s, curves)
      end do
      if (first >= n) curves(1)%s = '  '//curves(1)%s
      call add_rigid_lines(plots%name, drawing, 'ls 31', .true., curves)
      call put_plot(plots, [curves, more])
   end subroutine put_scene

   !> Adds the lines of some blocks to the curves of a plot.
   subroutine add_lines(name, first, last, style, curves, places)
      character(len=*), intent(in) :: name          !< of the data file, without .dat
      integer(ip), intent(in) :: first, last        !< blocks, from 0
      character(len=*), intent(in) :: style         !< what gnuplot has behind `with lines`
      type(string_t), allocatable, intent(inout) :: curves(:) !< of put_plot; become longer by one
      character(len=*), intent(in), optional :: places   !< columns; default: displaced
      character(len=:), allocatable :: columns

      columns = MOVED
      if (present(places)) columns = places
      call append_string(curves, '"'//name//'.dat" index '//to_text(first)//':'//to_text(last)//' using '//columns// &
                         ' with lines '//style)
   end subroutine add_lines

   !> Adds the rigid surfaces, a block each behind the lines, to the curves of a plot. Those that do not move stay where they are
   !> whatever the scale.
   subroutine add_rigid_lines(name, drawing, style, has_title, curves)
      character(len=*), intent(in) :: name          !< of the data file, without .dat
      type(drawing_t), intent(in) :: drawing        !< its rigid surfaces
      character(len=*), intent(in) :: style         !< what gnuplot has behind `with lines`
      logical, intent(in) :: has_title              !< each has its name in the key
      type(string_t), allocatable, intent(inout) :: curves(:) !< of put_plot; become longer
      character(len=:), allocatable :: places, title
      integer(ip) :: i

      do i = 1, size(drawing%surface, kind=ip)
         places = '1:2'
         if (drawing%body(i) > 0) places = MOVED
         title = ''
         if (has_title) title = ' title '//quoted(cleaned(drawing%model%surfaces(drawing%surface(i))%name, LONGEST_NAME)// &
                                                  ' (rigid)')//' noenhanced'
         call append_string(curves, '"'//name//'.dat" index '//to_text(drawing%lines%n_runs + i - 1)//' using '//places// &
                            ' with lines '//style//title)
      end do
   end subroutine add_rigid_lines

   !> How the lines of each run are drawn: in its body's colour, the outlines with its name in the key.
   pure function run_styles(drawing, names, inner, outer) result(styles)
      type(drawing_t), intent(in) :: drawing        !< its runs
      type(string_t), intent(in) :: names(:)        !< of the bodies
      character(len=*), intent(in) :: inner, outer  !< widths of inner edges and of outlines
      type(string_t) :: styles(drawing%lines%n_runs)
      integer(ip) :: i

      do i = 1, size(styles, kind=ip)
         associate (body => drawing%lines%body(i))
            styles(i)%s = body_style(body)//' lw '//inner
            if (drawing%lines%kind(i) /= LINE_INNER) styles(i)%s = body_style(body)//' lw '//outer// &
                                                                   body_title(names(body)%s, body, size(names, kind=ip))
         end associate
      end do
   end function run_styles

   !> The line style of a body's colour.
   pure function body_style(body) result(text)
      integer(ip), intent(in) :: body               !< from 1; styles come again after MOST_STYLES
      character(len=:), allocatable :: text

      text = 'ls '//to_text(mod(body - 1, MOST_STYLES) + 1)
   end function body_style

   !> The name of a body for the key, where the last that has room says how many follow.
   pure function body_title(name, place, n) result(text)
      character(len=*), intent(in) :: name          !< of the body, as the user wrote it
      integer(ip), intent(in) :: place, n           !< among the bodies, and how many they are
      character(len=:), allocatable :: text

      text = ''
      if (place > MOST_NAMES) return
      text = cleaned(name, LONGEST_NAME)
      if (place == MOST_NAMES .and. n > place) text = text//' and '//to_text(n - place)//' more'
      text = ' title '//quoted(text)//' noenhanced'
   end function body_title

end module atrito_drawing
