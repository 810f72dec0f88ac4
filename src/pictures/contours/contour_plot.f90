!> Contour pictures of a run: stresses recovered at the nodes, displacement and estimated error, on the displaced bodies.
!>
!> The colours are a raster, a value a pixel, which costs the same for a hundred elements and for a million, and is an image in the
!> svg. What lies over it are lines of mesh.dat. Things stand in pixels: the bodies, a bar of colours beside them or under wide
!> ones, and two lines about the largest and the least.
module atrito_contour_plot
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_body_plots, only: FEW_NODES
   use atrito_contour_bar, only: bar_t, make_bar, usual_range, palette_text, levels_of, BESIDE
   use atrito_contour_fields, only: contour_t, contours_of, field_t, places_t, node_places, element_places, make_field
   use atrito_contour_raster, only: raster_t, lay_raster, pixel_values
   use atrito_drawing, only: drawing_t, add_lines, add_rigid_lines, displacement_text, put_ticks
   use atrito_files, only: put_lines
   use atrito_kinds, only: ip, wp
   use atrito_plot_files, only: MESH_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_file, put_terminal, begin_script, put_plot
   use atrito_plot_text, only: range_t, range_text, span, LF, cover, quoted, power_text
   use atrito_plot_view, only: shown_window, warn_of_box
   use atrito_results, only: results_t
   use atrito_strings, only: string_t, to_text, append_string
   implicit none (type, external)
   private
   public :: layout_t, make_layout, write_contour_plots

   !> Where things stand in a contour picture.
   type :: layout_t
      type(range_t) :: window(2)                    !< that is shown [L]
      integer(ip) :: n(2) = 1                       !< pixels of the window
      integer(ip) :: left = 0, bottom = 0           !< of the window in the picture
      integer(ip) :: height = 0                     !< of the picture
      logical :: is_wide = .false.                  !< the bar lies under the bodies
   end type layout_t

   integer(ip), parameter :: WIDTH = 1000
   !> Room round the window: with a bar beside it, whose label stands above it, and with one under it.
   integer(ip), parameter :: LEFT = 95, RIGHT(2) = [135_ip, 35_ip], BOTTOM(2) = [128_ip, 238_ip], TOP(2) = [84_ip, 62_ip]
   integer(ip), parameter :: MOST_HEIGHT = 900      !< of the window
   real(wp), parameter :: WIDE = 0.32_wp            !< height over width below which a bar beside the window were too short

   integer, parameter :: DIGITS = 4                 !< of the largest and the least

contains

   !> Where the parts of a contour picture are, for the window that it shows: the raster as large as there is room, the bar below it
   !> where the window is wide, else beside it.
   pure type(layout_t) function make_layout(window) result(layout)
      type(range_t), intent(in) :: window(2)        !< to be shown, of some length [L]
      real(wp) :: side(2), pixel
      integer :: form
      integer(ip) :: room

      side = [span(window(1)), span(window(2))]
      layout%window = window
      layout%is_wide = side(2) < WIDE*side(1)
      form = merge(2, 1, layout%is_wide)
      room = WIDTH - LEFT - RIGHT(form)
      pixel = max(side(1)/room, side(2)/MOST_HEIGHT)
      layout%n = max(1_ip, nint(side/pixel, ip))
      layout%left = LEFT + (room - layout%n(1))/2
      layout%bottom = BOTTOM(form)
      layout%height = layout%bottom + layout%n(2) + TOP(form)
   end function make_layout

   !> Place of the bar, and what it is of: above a bar that stands, where long numbers at the bar are not in its way.
   subroutine put_bar_place(plots, layout, what)
      type(plots_t), intent(inout) :: plots
      type(layout_t), intent(in) :: layout
      character(len=*), intent(in) :: what

      if (layout%is_wide) then
         call put(plots, 'set colorbox horizontal user origin screen across('//to_text(layout%left)//'), screen up(138)'// &
                  ' size screen across('//to_text(layout%n(1))//'), screen up(16)'//LF//'set cblabel "'//what//'"')
      else
         call put(plots, 'set colorbox vertical user origin screen across('//to_text(layout%left + layout%n(1) + 22)// &
                  '), screen up('//to_text(layout%bottom)//') size screen across(20), screen up('//to_text(layout%n(2))//')'//LF// &
                  'set label 2 "'//what//'" at screen across('// &
                  to_text(min(WIDTH - 10_ip, layout%left + layout%n(1) + 125))//'), screen up('// &
                  to_text(layout%bottom + layout%n(2) + 14)//') right')
      end if
   end subroutine put_bar_place

   !> Writes .gp and .bin of all contours that there are, beside mesh.dat.
   subroutine write_contour_plots(plots, drawing)
      type(plots_t), intent(inout) :: plots         !< get data and scripts
      type(drawing_t), intent(in) :: drawing        !< of a run
      type(contour_t), allocatable :: list(:)
      type(places_t) :: nodes, elements
      type(layout_t) :: layout
      type(raster_t) :: raster
      type(field_t) :: field
      integer :: i
      real(wp), allocatable :: pixels(:, :)
      type(bar_t) :: bar

      list = contours_of(drawing%results)
      if (size(list) == 0) return
      layout = make_layout(shown_window(drawing%view, drawing%window))
      associate (mesh => drawing%model%mesh, scale => drawing%scale)
         call lay_raster(mesh, drawing%u, scale, layout%window, layout%n, raster)
         if (all(raster%element == 0)) call warn_of_box(drawing%view, drawing%window)
         call node_places(mesh, drawing%u, scale, layout%window, nodes)
         call element_places(mesh, drawing%u, scale, layout%window, elements)
      end associate
      do i = 1, size(list)
         call make_field(list(i), drawing%results, drawing%model%mesh, nodes, elements, field)
         ! The raster and the script of a field.
         pixels = pixel_values(raster, drawing%model%mesh, field%value, field%contour%of_elements)
         if (.not. field%is_shown) call cover(field%range, reshape(pixels, [size(pixels)]))   ! the window lies within an element
         if (field%range%low > field%range%high) field%range = range_t(0.0_wp, 0.0_wp)   ! or beside all of them
         bar = make_bar(usual_range(reshape(pixels, [size(pixels)]), field%range, field%is_smooth))
         call write_raster(plots, trim(field%contour%name), pixels, bar)
         call write_script(plots, drawing, layout, field, bar)
      end do
   end subroutine write_contour_plots

   !> <name>.bin: of each pixel a byte, from below. Each band of the bar is so many levels, and none lies in two bands; the last one
   !> is that of a pixel with another band above it or to the right: these are the contour lines.
   subroutine write_raster(plots, name, pixels, bar)
      type(plots_t), intent(inout) :: plots
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: pixels(:, :)          !< [F/L^2] or as the field
      type(bar_t), intent(in) :: bar
      character(len=size(pixels, 1)) :: row(1)
      integer(ip) :: level(size(pixels, 1) + 1, 2)  ! of a row and of the one above it
      integer(ip) :: i, j, width, levels

      call begin_file(plots, name//'.bin')
      width = size(pixels, 1, kind=ip)
      levels = levels_of(bar)
      level = BESIDE
      level(:width, 2) = level_of(pixels(:, 1))
      do j = 1, size(pixels, 2, kind=ip)
         level(:, 1) = level(:, 2)
         level(:, 2) = BESIDE
         if (j < size(pixels, 2)) level(:width, 2) = level_of(pixels(:, j + 1))
         do i = 1, width
            associate (it => level(i, 1), others => [level(i + 1, 1), level(i, 2)])
               row(1) (i:i) = char(it)
               if (it == BESIDE) cycle
               if (any(others /= BESIDE .and. others/levels /= it/levels)) row(1) (i:i) = char((it/levels + 1)*levels - 1)
            end associate
         end do
         call put_lines(plots%file, row)
      end do

   contains

      !> The level of a value, none of a line.
      elemental integer(ip) function level_of(value) result(at)
         real(wp), intent(in) :: value
         integer(ip) :: band

         at = BESIDE
         if (.not. ieee_is_finite(value)) return
         at = int(max(0.0_wp, min(real(BESIDE, wp), bar%n_bands*levels/span(bar%range)*(value - bar%range%low))), ip)
         band = min(at/levels, bar%n_bands - 1)
         at = max(band*levels, min(at, (band + 1)*levels - 2))
      end function level_of

   end subroutine write_raster

   subroutine write_script(plots, drawing, layout, field, bar)
      type(plots_t), intent(inout) :: plots
      type(drawing_t), intent(in) :: drawing
      type(layout_t), intent(in) :: layout
      type(field_t), intent(in) :: field
      type(bar_t), intent(in) :: bar
      character(len=:), allocatable :: name, title, text

      name = trim(field%contour%name)
      title = trim(field%contour%title)
      call begin_script(plots, name, title//' on the displaced bodies', &
                        name//'.bin: a byte a pixel, in rows from below; '//to_text(BESIDE)//': beside the bodies')
      call put(plots, 'field(k) = k == '//to_text(BESIDE)//' ? NaN : '//to_text(bar%range%low, 10)//' + (k + 0.5)*'// &
               to_text(bar%step/levels_of(bar), 10)//'   # ['//trim(field%contour%dimension)//']'//LF// &
               'scale = '//to_text(drawing%scale, 15)// &
               '   # of the displacements, also of the raster: another one needs a run with --plot-scale'//LF// &
               'heading = '//quoted(drawing%heading))
      ! Ranges, terminal, margins and axes.
      call put(plots, 'set xrange '//range_text(layout%window(1))//LF//'set yrange '//range_text(layout%window(2))//LF// &
               'width = '//to_text(WIDTH)//'.0; height = '//to_text(layout%height)//'.0   # of the picture in pixels'//LF// &
               'across(pixels) = pixels/width'//LF//'up(pixels) = pixels/height')
      call put_terminal(plots, 'int(width),int(height)')
      call put(plots, 'set lmargin at screen across('//to_text(layout%left)//'); set rmargin at screen across('// &
               to_text(layout%left + layout%n(1))//')'//LF//'set bmargin at screen up('//to_text(layout%bottom)// &
               '); set tmargin at screen up('//to_text(layout%bottom + layout%n(2))//')'//LF//'set clip two; unset key')
      call put_ticks(plots, span(layout%window(1))/layout%n(1))
      ! What the shares of the elements are of: the bound of the error, or the estimate.
      text = to_text(drawing%results%error_estimate, 3)//' %'
      if (drawing%results%error_bound%exists) text = 'at most '//to_text(drawing%results%error_bound%percent, 3)//' %'
      if (field%contour%of_elements) title = title//', share of each element, together '//text
      call put(plots, 'set label 1 heading."\n'//title//'; '//displacement_text(drawing)// &
               '" at screen 0.5, screen up(height - 20) center noenhanced')
      ! Colours, range and marks of the bar.
      call put(plots, 'unit = 1e'//to_text(bar%exponent)//LF//'set palette maxcolors '//to_text(bar%n_bands*levels_of(bar))// &
               ' defined ('// &
               palette_text(bar, field%contour%is_signed)//')'//LF// &
               'set cbrange ['//to_text(bar%range%low, 10)//'/unit:'//to_text(bar%range%high, 10)//'/unit]'//LF// &
               'set cbtics '//to_text(merge(1, 2, bar%n_bands <= 10)*bar%step, 10)//'/unit format "%g"')
      if (bar%is_flat) call put(plots, 'set cbtics ('//to_text(field%range%low, DIGITS)//'/unit)')
      call put_bar_place(plots, layout, trim(field%contour%symbol)//' ['//power_text(bar%exponent)// &
                         trim(field%contour%dimension)//']')
      if (field%is_shown) call put_extremes(plots, layout, field, bar)
      call put_curves(plots, drawing, layout)
   end subroutine write_script

   !> Marks at the largest and at the least value, and lines that say where these are.
   subroutine put_extremes(plots, layout, field, bar)
      type(plots_t), intent(inout) :: plots
      type(layout_t), intent(in) :: layout
      type(field_t), intent(in) :: field
      type(bar_t), intent(in) :: bar
      character(len=*), parameter :: WORD(2) = ['largest', 'least  ']
      character(len=*), parameter :: MARK(2) = [' point pt 9 ', ' point pt 11']   !< triangles of gnuplot that are filled: up, down
      character(len=:), allocatable :: left, where, beyond, pt
      integer(ip) :: k

      left = 'screen across('//to_text(layout%left)//'), screen up('
      if (bar%is_flat) then
         call put(plots, 'set label 3 "the same everywhere: '//to_text(field%range%low, DIGITS)//'" at '//left// &
                  '40) left noenhanced')
         return
      end if
      do k = 1, 2
         where = to_text(field%drawn(1, k), 8)//', '//to_text(field%drawn(2, k), 8)
         pt = trim(MARK(k))
         associate (extreme => field%extreme(k))
            beyond = ''
            if (extreme%value < bar%range%low .or. extreme%value > bar%range%high) beyond = ', beyond the bar'
            call put(plots, 'set label '//to_text(2*k + 1)//' "'//trim(WORD(k))//' '//to_text(extreme%value, DIGITS)// &
                     ' at '//trim(merge('node   ', 'element', extreme%is_node))//' '//to_text(extreme%id)//', x = '// &
                     to_text(extreme%x(1), 6)//', y = '//to_text(extreme%x(2), 6)//beyond//'" at '//left// &
                     to_text(66 - 24*k)//') left offset 2,0 noenhanced'//pt//' ps 1.3*dot'//LF// &
                     'set label '//to_text(2*k + 6)//' "" at '//where//' front'//pt//' ps 2.6*dot lc rgb "white"'//LF// &
                     'set label '//to_text(2*k + 7)//' "" at '//where//' front'//pt//' ps 1.5*dot lc rgb "black"')
         end associate
      end do
   end subroutine put_extremes

   !> One plot: the raster, edges, outlines and rigid surfaces.
   subroutine put_curves(plots, drawing, layout)
      type(plots_t), intent(inout) :: plots
      type(drawing_t), intent(in) :: drawing
      type(layout_t), intent(in) :: layout
      type(string_t), allocatable :: curves(:)
      real(wp) :: side(2)
      integer(ip) :: n_inner

      associate (n => layout%n, window => layout%window)
         side = [span(window(1)), span(window(2))]/n
         call append_string(curves, '"'//plots%name//'.bin" binary array=('//to_text(n(1))//','//to_text(n(2))//') dx='// &
                            to_text(side(1), 10)//' dy='//to_text(side(2), 10)//' origin=('// &
                            to_text(window(1)%low + 0.5_wp*side(1), 10)//','//to_text(window(2)%low + 0.5_wp*side(2), 10)// &
                            ') format="%uint8" using (field($1)/unit) with image')
      end associate
      n_inner = drawing%n_inner
      if (n_inner > 0 .and. drawing%model%mesh%n_nodes <= FEW_NODES) then
         call add_lines(MESH_PLOT, 0_ip, n_inner - 1, 'lt 1 lw 0.4 lc rgb "#606060"', curves)
      end if
      call add_lines(MESH_PLOT, n_inner, drawing%lines%n_runs - 1, 'lt 1 lw 1.2 lc rgb "#303030"', curves)
      call add_rigid_lines(MESH_PLOT, drawing, 'lt 1 lw 4 lc rgb "#404040"', .false., curves)
      call put_plot(plots, curves)
   end subroutine put_curves

end module atrito_contour_plot
