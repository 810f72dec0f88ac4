!> The picture of the sets of a scene before anything is solved: a small picture each, node sets as points, element sets filled.
module atrito_set_plot
   use atrito_files, only: file_set_t, text_file_t, put_line, close_text
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, side_count
   use atrito_mesh_lines, only: drawing_t, begin_drawing, put_lines, put_place
   use atrito_model, only: model_t
   use atrito_plot_files, only: open_data, SET_PLOT
   use atrito_plot_text, only: range_t, range_text, span, quoted, cleaned, scene_title, begin_script, end_script, &
                               put_terminal, COLOUR
   use atrito_plot_view, only: plot_view_t, shown_window
   use atrito_sets, only: set_count, members_of, member_count
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: to_text
   use atrito_symbols, only: pixel_of, thinned
   implicit none (type, external)
   private
   public :: write_set_plot, has_set_plot, shown_sets, shown_set_t

   integer(ip), parameter :: MOST_SETS = 12
   integer, parameter :: MOST_COLUMNS = 3, WIDTH = 1000, LONGEST_NAME = 28
   integer(ip), parameter :: MOST_FILLED = 4000     !< elements of a set that are filled; of more their middles are drawn
   real(wp), parameter :: SPACING = 4.0_wp          !< of points [pixels of a small picture]
   real(wp), parameter :: LEAST_RATIO = 0.12_wp, MOST_RATIO = 1.3_wp   !< height over width of a small picture
   integer, parameter :: HEADING = 76, NAME_LINE = 26   !< [pixels]

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

   !> Writes sets.dat and sets.gp into the set of the plots' folder.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_set_plot(set, model, view, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model            !< with sets
      type(plot_view_t), intent(in) :: view
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(drawing_t) :: drawing
      type(shown_set_t), allocatable :: shown(:)
      real(wp), allocatable :: u(:, :)
      integer(ip) :: i

      allocate (u(2, model%mesh%n_nodes), source=0.0_wp)
      call begin_drawing(model, .true., drawing)
      drawing%view = view
      if (allocated(view%box)) drawing%window = shown_window(view, drawing%window)
      shown = shown_sets(model)
      call open_data(set, SET_PLOT, file)
      call put_line(file, '# outlines of the bodies, then the members of each set; columns: x [L]  y [L]')
      call put_lines(file, [character(len=40) :: '', ''], model, u, drawing)
      do i = 1, size(shown, kind=ip)
         call put_line(file, '# block '//to_text(drawing%lines%n_runs + i - 1)//': '//set_title(model, shown(i)))
         call put_members(file, model, shown(i), pixel_of(drawing%window)*columns_of(shown))
         call put_line(file, '')
      end do
      call close_text(file, status)
      if (is_ok(status)) call write_script(set, model, drawing, shown, status)
   end subroutine write_set_plot

   !> Small pictures side by side.
   pure integer function columns_of(shown) result(n)
      type(shown_set_t), intent(in) :: shown(:)

      n = min(MOST_COLUMNS, size(shown))
      if (size(shown) == 4) n = 2
   end function columns_of

   !> `PLATE (120 elements)`
   pure function set_title(model, shown) result(title)
      type(model_t), intent(in) :: model
      type(shown_set_t), intent(in) :: shown
      character(len=:), allocatable :: title

      if (shown%of_nodes) then
         associate (it => model%node_sets%sets(shown%place))
            title = cleaned(it%name, LONGEST_NAME)//' ('//counted(member_count(it), 'node')//')'
         end associate
      else
         associate (it => model%element_sets%sets(shown%place))
            title = cleaned(it%name, LONGEST_NAME)//' ('//counted(member_count(it), 'element')//')'
         end associate
      end if
   end function set_title

   pure function counted(n, what) result(text)
      integer(ip), intent(in) :: n
      character(len=*), intent(in) :: what
      character(len=:), allocatable :: text

      text = to_text(n)//' '//what
      if (n /= 1) text = text//'s'
   end function counted

   !> Nodes as places, elements as polygons, or where they are many their middles.
   subroutine put_members(file, model, shown, pixel)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(shown_set_t), intent(in) :: shown
      real(wp), intent(in) :: pixel                 !< of a small picture [L]
      integer(ip), allocatable :: members(:)
      integer(ip) :: i, k, n

      if (shown%of_nodes) then
         call put_thinned(file, model%mesh%x(:, members_of(model%node_sets%sets(shown%place))), pixel)
         return
      end if
      members = members_of(model%element_sets%sets(shown%place))
      if (size(members) > MOST_FILLED) then
         call put_thinned(file, middles_of(model%mesh, members), pixel)
      else
         do i = 1, size(members, kind=ip)
            n = side_count(model%mesh, members(i))
            do k = 0, n
               call put_place(file, [model%mesh%x(:, model%mesh%nodes(1 + mod(k, n), members(i))), 0.0_wp, 0.0_wp])
            end do
            call put_line(file, '')
         end do
      end if
      if (size(members) == 0) call put_line(file, 'NaN NaN')
   end subroutine put_members

   pure function middles_of(mesh, elements) result(places)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: elements(:)
      real(wp) :: places(2, size(elements))
      integer(ip) :: i, n

      do i = 1, size(elements, kind=ip)
         n = side_count(mesh, elements(i))
         places(:, i) = sum(mesh%x(:, mesh%nodes(:n, elements(i))), dim=2)/n
      end do
   end function middles_of

   subroutine put_thinned(file, places, pixel)
      type(text_file_t), intent(inout) :: file
      real(wp), intent(in) :: places(:, :)          !< (2, n) [L]
      real(wp), intent(in) :: pixel
      logical :: keep(size(places, 2))
      integer(ip) :: i

      keep = thinned(places, SPACING*pixel)
      do i = 1, size(places, 2, kind=ip)
         if (keep(i)) call put_place(file, [places(:, i), 0.0_wp, 0.0_wp])
      end do
      if (size(places, 2) == 0) call put_line(file, 'NaN NaN')
      call put_line(file, '')
   end subroutine put_thinned

   subroutine write_script(set, model, drawing, shown, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(drawing_t), intent(in) :: drawing
      type(shown_set_t), intent(in) :: shown(:)
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      type(range_t) :: window(2)
      character(len=:), allocatable :: layout
      integer(ip) :: i, rows

      rows = (size(shown, kind=ip) + columns_of(shown) - 1)/columns_of(shown)
      layout = to_text(rows)//','//to_text(int(columns_of(shown), ip))
      call begin_script(set, SET_PLOT, 'the sets of nodes and elements', file)
      call put_line(file, '# Columns of sets.dat: 1 x [L], 2 y [L]; outlines of the bodies, then a block a set')
      call put_line(file, 'heading = '//quoted(scene_title(model%deck_path, model%heading)))
      window = shown_window(drawing%view, drawing%window)
      call put_line(file, 'set xrange '//range_text(window(1))//'; set yrange '//range_text(window(2)))
      call put_line(file, 'set size ratio -1; unset border; unset tics; unset key')
      call put_line(file, 'set lmargin 0.5; set rmargin 0.5; set bmargin 0.5; set tmargin 1.8')
      call put_terminal(file, SET_PLOT, to_text(int(WIDTH, ip))//','//to_text(HEADING + rows*height_of(drawing, shown)))
      call put_line(file, 'set multiplot layout '//layout//' title heading."\n'//what_is_shown(model, shown)//'\n " noenhanced')
      do i = 1, size(shown, kind=ip)
         call put_small_picture(file, model, drawing, shown(i), i)
      end do
      call put_line(file, 'unset multiplot')
      call end_script(file, status)
   end subroutine write_script

   !> Height of a small picture with its name [pixels].
   pure integer(ip) function height_of(drawing, shown) result(height)
      type(drawing_t), intent(in) :: drawing
      type(shown_set_t), intent(in) :: shown(:)
      real(wp) :: ratio

      ratio = 1.0_wp
      if (span(drawing%window(1)) > 0.0_wp) ratio = span(drawing%window(2))/span(drawing%window(1))
      height = NAME_LINE + nint(min(MOST_RATIO, max(LEAST_RATIO, ratio))*WIDTH/max(2, columns_of(shown)), ip)
   end function height_of

   pure function what_is_shown(model, shown) result(text)
      type(model_t), intent(in) :: model
      type(shown_set_t), intent(in) :: shown(:)
      character(len=:), allocatable :: text
      integer(ip) :: n

      n = set_count(model%node_sets) + set_count(model%element_sets)
      text = 'sets of elements and nodes'
      if (size(shown) < n) text = text//': '//to_text(size(shown, kind=ip))//' of '//to_text(n)
   end function what_is_shown

   !> Outlines in grey, and over them the members.
   subroutine put_small_picture(file, model, drawing, shown, place)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(drawing_t), intent(in) :: drawing
      type(shown_set_t), intent(in) :: shown
      integer(ip), intent(in) :: place
      character(len=:), allocatable :: data, drawn
      integer(ip) :: n

      n = drawing%lines%n_runs
      call put_line(file, 'set title '//quoted(set_title(model, shown))//' noenhanced offset 0,-0.8')
      data = '"'//SET_PLOT//'.dat" index '
      drawn = 'with points pt 7 ps 0.6*dot lc rgb "'//COLOUR(2)//'"'
      if (.not. shown%of_nodes) then
         drawn = 'with points pt 5 ps 0.45*dot lc rgb "#80'//COLOUR(1) (2:)//'"'
         if (member_count(model%element_sets%sets(shown%place)) <= MOST_FILLED) then
            drawn = 'with filledcurves closed lc rgb "#80'//COLOUR(1) (2:)//'"'
         end if
      end if
      call put_line(file, 'plot '//data//'0:'//to_text(n - 1)//' using 1:2 with lines lt 1 lw 0.8 lc rgb "#909090", \')
      call put_line(file, '   '//data//to_text(n + place - 1)//' using 1:2 '//drawn)
   end subroutine put_small_picture

end module atrito_set_plot
