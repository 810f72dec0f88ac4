!> The picture of the sets of a scene before anything is solved: a small picture each, node sets as points, element sets filled.
module atrito_set_plot
   use atrito_drawing, only: drawing_t, begin_drawing, put_lines, put_place
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: side_count
   use atrito_model, only: model_t
   use atrito_page, only: plural
   use atrito_plot_files, only: SET_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_data, end_data, begin_script, end_script, put_terminal, put_plot
   use atrito_plot_text, only: range_t, range_text, span, quoted, cleaned, scene_title, COLOUR, LF
   use atrito_plot_view, only: plot_view_t, shown_window
   use atrito_sets, only: set_count, members_of, member_count
   use atrito_strings, only: string_t, to_text
   use atrito_symbols, only: pixel_of, thinned
   implicit none (type, external)
   private
   public :: write_set_plot, has_set_plot, shown_sets, shown_set_t

   integer(ip), parameter :: MOST_SETS = 12
   integer(ip), parameter :: MOST_COLUMNS = 3, WIDTH = 1000
   integer, parameter :: LONGEST_NAME = 28
   integer(ip), parameter :: MOST_FILLED = 4000     !< elements of a set that are filled; of more their middles are drawn
   real(wp), parameter :: SPACING = 4.0_wp          !< of points [pixels of a small picture]
   real(wp), parameter :: LEAST_RATIO = 0.12_wp, MOST_RATIO = 1.3_wp   !< height over width of a small picture
   integer(ip), parameter :: HEADING = 76, NAME_LINE = 26   !< [pixels]

   !> A set that is drawn.
   type :: shown_set_t
      logical :: of_nodes = .false.
      integer(ip) :: place = 0                      !< in model%node_sets or model%element_sets
   end type shown_set_t

contains

   !> Whether the deck defines sets.
   pure logical function has_set_plot(model)
      type(model_t), intent(in) :: model

      has_set_plot = set_count(model%node_sets) + set_count(model%element_sets) > 0
   end function has_set_plot

   !> The sets that are drawn: of either kind the first ones, half of the room for each unless the other leaves some.
   pure function shown_sets(model) result(shown)
      type(model_t), intent(in) :: model
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

   !> Writes sets.dat and sets.gp.
   subroutine write_set_plot(plots, model, view)
      type(plots_t), intent(inout) :: plots
      type(model_t), intent(in), target :: model    !< with sets
      type(plot_view_t), intent(in) :: view
      type(drawing_t) :: drawing
      type(shown_set_t), allocatable :: shown(:)
      integer(ip) :: i

      call begin_drawing(model, .true., view, drawing)
      if (allocated(view%box)) drawing%window = shown_window(view, drawing%window)
      shown = shown_sets(model)
      call begin_data(plots, SET_PLOT, 'outlines of the bodies, then the members of each set; columns: x [L]  y [L]')
      call put_lines(plots, drawing, drawing%u, .false.)
      do i = 1, size(shown, kind=ip)
         call put(plots, '# block '//to_text(drawing%lines%n_runs + i - 1)//': '//set_title(model, shown(i)))
         call put_members(plots, model, shown(i), pixel_of(drawing%window)*columns_of(shown))
         call put(plots, '')
      end do
      call end_data(plots)
      call write_script(plots, drawing, shown)
   end subroutine write_set_plot

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
            title = cleaned(it%name, LONGEST_NAME)//' ('//plural(member_count(it), 'node', 'nodes')//')'
         end associate
      else
         associate (it => model%element_sets%sets(shown%place))
            title = cleaned(it%name, LONGEST_NAME)//' ('//plural(member_count(it), 'element', 'elements')//')'
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

   subroutine write_script(plots, drawing, shown)
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
      window = shown_window(drawing%view, drawing%window)
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
      call end_script(plots)
   end subroutine write_script

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
         if (member_count(drawing%model%element_sets%sets(shown%place)) <= MOST_FILLED) &
            drawn = 'filledcurves closed lc rgb "#80'//COLOUR(1) (2:)//'"'
      end if
      call put_plot(plots, [string_t('"sets.dat" index 0:'//to_text(n - 1)// &
                                     ' using 1:2 with lines lt 1 lw 0.8 lc rgb "#909090"'), &
                            string_t('"sets.dat" index '//to_text(n + place - 1)//' using 1:2 with '//drawn)])
   end subroutine put_small_picture

end module atrito_set_plot
