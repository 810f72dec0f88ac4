!> The pictures of `check --plot` before anything is solved: the scene; its sets, a small picture each, node sets as points, element
!> sets filled; and the initial gaps of its pairs along the slave, a panel a pair, of many pairs those with the least gaps.
!>
!> As with the pictures of a run, a failure is a warning, W-PLOT. Pictures of an earlier check are replaced; those of a run stay.
module atrito_check_plots
   use atrito_body_plots, only: write_scene_plot
   use atrito_drawing, only: drawing_t, begin_drawing, put_lines, put_place, pixel_of
   use atrito_gnuplot, only: draw_written
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: side_count
   use atrito_model, only: model_t
   use atrito_number_text, only: trimmed_real
   use atrito_page, only: plural
   use atrito_plot_files, only: plot_folder, remove_plots, PLOTS_OF_CHECK, SCENE_PLOT, SET_PLOT, GAP_PLOT
   use atrito_plot_scripts, only: plots_t, begin_plots, end_plots, put, begin_data, begin_script, put_terminal, put_frame, put_panel
   use atrito_plot_text, only: range_t, range_text, span, quoted, cleaned, scene_title, COLOUR, LF, cover, padded, range_of
   use atrito_plot_view, only: plot_view_t, shown_window
   use atrito_sets, only: set_count, members_of, member_count
   use atrito_status, only: status_t
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_symbols, only: thinned
   implicit none (type, external)
   private
   public :: write_check_plots, write_check_scripts, check_plot_names, shown_sets, shown_set_t, shown_pairs

   integer(ip), parameter :: MOST_SETS = 12
   integer(ip), parameter :: MOST_COLUMNS = 3, WIDTH = 1000
   integer, parameter :: LONGEST_SET = 28
   integer(ip), parameter :: MOST_FILLED = 4000     !< elements of a set that are filled; of more their middles are drawn
   real(wp), parameter :: SPACING = 4.0_wp          !< of points [pixels of a small picture]
   real(wp), parameter :: LEAST_RATIO = 0.12_wp, MOST_RATIO = 1.3_wp   !< height over width of a small picture
   integer(ip), parameter :: HEADING = 76, NAME_LINE = 26   !< [pixels]

   !> A set that is drawn.
   type :: shown_set_t
      logical :: of_nodes = .false.                 !< else of elements
      integer(ip) :: place = 0                      !< in model%node_sets or model%element_sets
   end type shown_set_t

   integer(ip), parameter :: MOST_PANELS = 6
   integer, parameter :: GAP_DIGITS = 8, LONGEST_SURFACE = 26
   !> Gaps below this part of the length of all pairs are round-off and drawn as 0.
   real(wp), parameter :: ROUND_OFF = 1.0e-12_wp
   !> A gap that is the same all along is drawn in the middle of a panel as high as so much of the slave is long.
   real(wp), parameter :: EVEN_SHARE = 0.01_wp

contains

   !> Writes the scripts of all pictures into <folder>/plots and draws them.
   subroutine write_check_plots(model, view, folder, drawn)
      type(model_t), intent(in) :: model                    !< with the points of its pairs
      type(plot_view_t), intent(in) :: view                 !< its box alone is used: nothing is displaced
      character(len=*), intent(in) :: folder                !< of the tables
      type(string_t), allocatable, intent(out) :: drawn(:)  !< pictures, names without ending
      type(status_t) :: status

      call remove_plots(folder, PLOTS_OF_CHECK)
      call write_check_scripts(model, view, plot_folder(folder), status)
      call draw_written(folder, check_plot_names(model), status, drawn)
   end subroutine write_check_plots

   !> The pictures that `check --plot` draws of a model, names without ending.
   pure function check_plot_names(model) result(names)
      type(model_t), intent(in) :: model            !< with the points of its pairs
      type(string_t), allocatable :: names(:)

      call append_string(names, SCENE_PLOT)
      if (size(shown_sets(model)) > 0) call append_string(names, SET_PLOT)
      if (size(shown_pairs(model)) > 0) call append_string(names, GAP_PLOT)
   end function check_plot_names

   !> Writes scripts and data, which appear together or not at all.
   !>
   !> status: STATUS_FILE
   subroutine write_check_scripts(model, view, folder, status)
      type(model_t), intent(in) :: model                    !< with the points of its pairs
      type(plot_view_t), intent(in) :: view                 !< what is asked of the pictures of bodies
      character(len=*), intent(in) :: folder                !< of the plots
      type(status_t), intent(out) :: status                 !< STATUS_OK or STATUS_FILE
      type(plots_t) :: plots
      type(drawing_t) :: drawing
      type(shown_set_t), allocatable :: shown(:)
      integer(ip) :: i

      call begin_plots(plots, folder, model%units)
      call write_scene_plot(plots, model, view)
      ! Writes sets.dat and sets.gp.
      if (size(shown_sets(model)) > 0) then
         call begin_drawing(model, .true., view, drawing)
         drawing%window = shown_window(view, drawing%window)
         shown = shown_sets(model)
         call begin_data(plots, SET_PLOT, 'outlines of the bodies, then the members of each set; columns: x [L]  y [L]')
         call put_lines(plots, drawing, drawing%u, .false.)
         do i = 1, size(shown, kind=ip)
            call put(plots, '# block '//to_text(drawing%lines%n_runs + i - 1)//': '//set_title(model, shown(i)))
            call put_members(plots, model, shown(i), pixel_of(drawing%window)*columns_of(shown))
            call put(plots, '')
         end do
         call write_set_script(plots, drawing, shown)
      end if
      if (size(shown_pairs(model)) > 0) call write_gap_plot(plots, model)
      call end_plots(plots, status)
   end subroutine write_check_scripts

   !> The sets that are drawn: of either kind the first ones, half of the room for each unless the other leaves some.
   pure function shown_sets(model) result(shown)
      type(model_t), intent(in) :: model            !< its sets are counted
      type(shown_set_t), allocatable :: shown(:)
      integer(ip) :: i, n_nodes, n_elements

      n_elements = set_count(model%element_sets)
      n_nodes = set_count(model%node_sets)
      if (n_elements + n_nodes > MOST_SETS) then
         n_elements = min(n_elements, max(MOST_SETS/2, MOST_SETS - n_nodes))
         n_nodes = min(n_nodes, MOST_SETS - n_elements)
      end if
      shown = [[(shown_set_t(.false., i), i=1, n_elements)], [(shown_set_t(.true., i), i=1, n_nodes)]]
   end function shown_sets

   !> Small pictures side by side.
   pure integer(ip) function columns_of(shown) result(n)
      type(shown_set_t), intent(in) :: shown(:)

      n = min(MOST_COLUMNS, size(shown, kind=ip))
      if (size(shown) == 4) n = 2
   end function columns_of

   !> `PLATE (120 elements)`
   pure function set_title(model, shown) result(title)
      type(model_t), intent(in) :: model
      type(shown_set_t), intent(in) :: shown
      character(len=:), allocatable :: title

      if (shown%of_nodes) then
         associate (it => model%node_sets%sets(shown%place))
            title = cleaned(it%name, LONGEST_SET)//' ('//plural(member_count(it), 'node', 'nodes')//')'
         end associate
      else
         associate (it => model%element_sets%sets(shown%place))
            title = cleaned(it%name, LONGEST_SET)//' ('//plural(member_count(it), 'element', 'elements')//')'
         end associate
      end if
   end function set_title

   !> Nodes as places, elements as polygons, or where they are many their middles.
   subroutine put_members(plots, model, shown, pixel)
      type(plots_t), intent(inout) :: plots
      type(model_t), intent(in) :: model
      type(shown_set_t), intent(in) :: shown
      real(wp), intent(in) :: pixel                 !< of a small picture [L]
      integer(ip), allocatable :: members(:)
      real(wp), allocatable :: middles(:, :)
      integer(ip) :: i, k, n

      if (shown%of_nodes) then
         call put_thinned(plots, model%mesh%x(:, members_of(model%node_sets%sets(shown%place))), pixel)
         return
      end if
      members = members_of(model%element_sets%sets(shown%place))
      allocate (middles(2, size(members)))
      do i = 1, size(members, kind=ip)
         n = side_count(model%mesh, members(i))
         associate (x => model%mesh%x(:, model%mesh%nodes(:n, members(i))))
            middles(:, i) = sum(x, dim=2)/n
            if (size(members) > MOST_FILLED) cycle
            do k = 0, n
               call put_place(plots, [x(:, 1 + mod(k, n)), 0.0_wp, 0.0_wp])
            end do
         end associate
         call put(plots, '')
      end do
      if (size(members) > MOST_FILLED) call put_thinned(plots, middles, pixel)
      if (size(members) == 0) call put(plots, 'NaN NaN')
   end subroutine put_members

   subroutine put_thinned(plots, places, pixel)
      type(plots_t), intent(inout) :: plots
      real(wp), intent(in) :: places(:, :)          !< (2, n) [L]
      real(wp), intent(in) :: pixel
      logical :: keep(size(places, 2))
      integer(ip) :: i

      keep = thinned(places, SPACING*pixel)
      do i = 1, size(places, 2, kind=ip)
         if (keep(i)) call put_place(plots, [places(:, i), 0.0_wp, 0.0_wp])
      end do
      if (size(places, 2) == 0) call put(plots, 'NaN NaN')
      call put(plots, '')
   end subroutine put_thinned

   subroutine write_set_script(plots, drawing, shown)
      type(plots_t), intent(inout) :: plots
      type(drawing_t), intent(in) :: drawing
      type(shown_set_t), intent(in) :: shown(:)
      type(range_t) :: window(2)
      character(len=:), allocatable :: title
      real(wp) :: ratio
      integer(ip) :: i, n, columns, rows, height    ! of a small picture with its name [pixels]

      columns = columns_of(shown)
      rows = (size(shown, kind=ip) + columns - 1)/columns
      ratio = 1.0_wp
      if (span(drawing%window(1)) > 0.0_wp) ratio = span(drawing%window(2))/span(drawing%window(1))
      height = NAME_LINE + nint(min(MOST_RATIO, max(LEAST_RATIO, ratio))*WIDTH/max(2_ip, columns), ip)
      n = set_count(drawing%model%node_sets) + set_count(drawing%model%element_sets)
      title = 'sets of elements and nodes'
      if (size(shown) < n) title = title//': '//to_text(size(shown, kind=ip))//' of '//to_text(n)
      window = drawing%window
      call begin_script(plots, SET_PLOT, 'the sets of nodes and elements', &
                        'Columns of sets.dat: 1 x [L], 2 y [L]; outlines of the bodies, then a block a set')
      call put(plots, 'heading = '//quoted(scene_title(drawing%model%deck_path, drawing%model%heading))//LF// &
               'set xrange '//range_text(window(1))//'; set yrange '//range_text(window(2))//LF// &
               'set size ratio -1; unset border; unset tics; unset key'//LF// &
               'set lmargin 0.5; set rmargin 0.5; set bmargin 0.5; set tmargin 1.8')
      call put_terminal(plots, to_text(WIDTH)//','//to_text(HEADING + rows*height))
      call put(plots, 'set multiplot layout '//to_text(rows)//','//to_text(columns)//' title heading."\n'//title// &
               '\n " noenhanced')
      do i = 1, size(shown, kind=ip)
         call put_small_picture(plots, drawing, shown(i), i)
      end do
      call put(plots, 'unset multiplot')
   end subroutine write_set_script

   !> Outlines in grey, and over them the members.
   subroutine put_small_picture(plots, drawing, shown, place)
      type(plots_t), intent(inout) :: plots
      type(drawing_t), intent(in) :: drawing
      type(shown_set_t), intent(in) :: shown
      integer(ip), intent(in) :: place
      character(len=:), allocatable :: drawn
      integer(ip) :: n

      n = drawing%lines%n_runs
      call put(plots, 'set title '//quoted(set_title(drawing%model, shown))//' noenhanced offset 0,-0.8')
      drawn = 'points pt 7 ps 0.6*dot lc rgb "'//COLOUR(2)//'"'
      if (.not. shown%of_nodes) then
         drawn = 'points pt 5 ps 0.45*dot lc rgb "#80'//COLOUR(1) (2:)//'"'
         if (member_count(drawing%model%element_sets%sets(shown%place)) <= MOST_FILLED) then
            drawn = 'filledcurves closed lc rgb "#80'//COLOUR(1) (2:)//'"'
         end if
      end if
      call put(plots, 'plot "sets.dat" index 0:'//to_text(n - 1)//' using 1:2 with lines lt 1 lw 0.8 lc rgb "#909090", \'//LF// &
               '   "sets.dat" index '//to_text(n + place - 1)//' using 1:2 with '//drawn)
   end subroutine put_small_picture

   !> The pairs that are drawn, those with the least gaps, in the order of the deck.
   pure function shown_pairs(model) result(shown)
      type(model_t), intent(in) :: model            !< pairs without points are not drawn
      integer(ip), allocatable :: shown(:)
      integer(ip) :: i, k
      real(wp), allocatable :: least(:)
      logical, allocatable :: is_left(:)

      allocate (shown(0))
      if (.not. allocated(model%points)) return
      is_left = model%points%n > 0
      allocate (least(size(is_left)), source=huge(1.0_wp))
      do i = 1, size(least, kind=ip)
         if (is_left(i)) least(i) = minval(model%points(i)%gap(:model%points(i)%n))
      end do
      do k = 1, min(MOST_PANELS, count(is_left, kind=ip))
         is_left(minloc(least, dim=1, mask=is_left, kind=ip)) = .false.
      end do
      shown = pack([(i, i=1, size(least, kind=ip))], model%points%n > 0 .and. .not. is_left)
   end function shown_pairs

   !> Writes pairs.dat and pairs.gp.
   subroutine write_gap_plot(plots, model)
      type(plots_t), intent(inout) :: plots
      type(model_t), intent(in) :: model            !< with pairs that have points
      integer(ip), allocatable :: shown(:)
      type(range_t) :: along
      character(len=:), allocatable :: title
      integer(ip) :: i, j

      shown = shown_pairs(model)
      call begin_data(plots, GAP_PLOT, 'initial gaps of the pairs that are drawn; columns: s [L]  gap [L]')
      do i = 1, size(shown, kind=ip)
         call put(plots, '# block '//to_text(i - 1)//': pair '//to_text(shown(i)))
         associate (points => model%points(shown(i)))
            call cover(along, [0.0_wp, points%s(:points%n)])
            do j = 1, points%n
               call put(plots, trimmed_real(points%s(j), GAP_DIGITS)//' '//trimmed_real(gap_of(model, shown(i), j), GAP_DIGITS))
            end do
         end associate
         call put(plots, LF)
      end do
      if (along%high <= along%low) along = padded(along)
      call begin_script(plots, GAP_PLOT, 'initial gaps of the contact pairs along s', &
                        'Columns of pairs.dat: 1 s [L], 2 gap [L]; a block a pair')
      call put(plots, 'heading = '//quoted(scene_title(model%deck_path, model%heading)))
      call put_frame(plots, size(shown, kind=ip), along, '"s [L]"')
      call put_terminal(plots, '1000,height')
      title = 'initial gaps, negative where the sides overlap'
      if (size(shown) < size(model%pairs)) title = title//': the '//to_text(size(shown, kind=ip))//' of '// &
                                                   to_text(size(model%pairs, kind=ip))//' pairs with the least'
      call put(plots, 'set style fill transparent solid 0.35 noborder'//LF// &
               'set multiplot title heading."\n'//title//'" noenhanced')
      do i = 1, size(shown, kind=ip)
         call put_pair(plots, model, shown(i), i)
      end do
      call put(plots, 'unset multiplot')
   end subroutine write_gap_plot

   !> The gap of a point; 0 where it is round-off.
   pure real(wp) function gap_of(model, pair, j) result(gap)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: pair, j

      associate (points => model%points(pair))
         gap = points%gap(j)
         if (abs(gap) <= ROUND_OFF*maxval(abs(points%s(:points%n)))) gap = 0.0_wp
      end associate
   end function gap_of

   !> The panel of a pair, in its legend the names, the least gap, the number of points, and how many faces see no master.
   subroutine put_pair(plots, model, pair, place)
      type(plots_t), intent(inout) :: plots
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: pair, place        !< place of the panel, 1 the uppermost
      character(len=*), parameter :: ENTRY = '   NaN with lines lc rgb "white" title '
      type(range_t) :: range
      character(len=:), allocatable :: data, points_text
      real(wp), allocatable :: gaps(:)
      real(wp) :: half
      integer(ip) :: j

      associate (points => model%points(pair), surfaces => model%surfaces, it => model%pairs(pair))
         gaps = [(gap_of(model, pair, j), j=1, points%n)]
         range = range_of([0.0_wp, gaps])
         half = EVEN_SHARE*maxval(abs(points%s(:points%n)))
         if (.not. range%high > range%low) call cover(range, [-half, half])
         call put_panel(plots, place, 'gap', 'L', range)
         data = '"'//GAP_PLOT//'.dat" index '//to_text(place - 1)//' using 1:($2/unit) '
         points_text = to_text(points%n)//' points'
         if (points%n_left_out > 0) points_text = points_text//'; '//to_text(points%n_left_out)//' faces alone'
         call put(plots, 'plot '//data//'with filledcurves below y=0 lc rgb "'//COLOUR(2)//'", \'//LF// &
                  '   '//data//'with linespoints lt 1 lw 1.8 pt 7 ps 0.6*dot lc rgb "'//COLOUR(1)//'" title '// &
                  quoted(cleaned(surfaces(it%slave)%name, LONGEST_SURFACE))//' noenhanced, \'//LF// &
                  ENTRY//quoted('on '//cleaned(surfaces(it%master)%name, LONGEST_SURFACE))//' noenhanced, \'//LF// &
                  ENTRY//'"least '//to_text(minval(gaps), 4)//'", \'//LF//ENTRY//'"'//points_text//'"')
      end associate
   end subroutine put_pair

end module atrito_check_plots
