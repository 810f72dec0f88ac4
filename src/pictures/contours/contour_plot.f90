!> Contour pictures of a run: stresses recovered at the nodes, displacement and estimated error, on the displaced bodies.
!>
!> The colours are a raster, a value a pixel, which costs the same for a hundred elements and for a million, and is an image in the
!> svg. What lies over it are lines of mesh.dat.
module atrito_contour_plot
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_contour_bar, only: bar_t, make_bar, usual_range, palette_text
   use atrito_contour_fields, only: contour_t, contours_of, field_t, places_t, node_places, element_places, make_field
   use atrito_contour_layout, only: layout_t, make_layout, put_layout, put_bar_place
   use atrito_contour_raster, only: raster_t, lay_raster, nodal_values, element_values
   use atrito_files, only: file_set_t, text_file_t, open_text, put_line, put_lines, close_text
   use atrito_kinds, only: ip, wp
   use atrito_mesh_lines, only: drawing_t, add_lines, add_rigid_lines, LINE_INNER
   use atrito_mesh_plot, only: displacement_text, FEW_NODES
   use atrito_model, only: model_t
   use atrito_plot_files, only: MESH_PLOT
   use atrito_plot_text, only: range_t, cover, span, quoted, picture_title, begin_script, end_script, put_plot
   use atrito_plot_view, only: shown_window, warn_of_box
   use atrito_results, only: results_t
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_write_tables, only: origin_of
   implicit none (type, external)
   private
   public :: write_contour_plots

   integer(ip), parameter :: BESIDE = 255           !< the byte of a pixel beside the bodies
   integer, parameter :: DIGITS = 4                 !< of the largest and the least

contains

   !> Writes .gp and .bin of all contours that there are into the set of the plots' folder, which has mesh.dat.
   !>
   !> status: STATUS_FILE when one could not be written.
   subroutine write_contour_plots(set, model, results, drawing, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(drawing_t), intent(in) :: drawing
      type(status_t), intent(out) :: status
      type(contour_t), allocatable :: list(:)
      type(places_t) :: nodes, elements
      type(layout_t) :: layout
      type(raster_t) :: raster
      type(field_t) :: field
      integer :: i

      list = contours_of(results)
      if (size(list) == 0) return
      layout = make_layout(shown_window(drawing%view, drawing%window))
      call lay_raster(model%mesh, results%u, drawing%scale, layout%window, layout%n, raster)
      if (all(raster%element == 0)) call warn_of_box(drawing%view, drawing%window)
      call node_places(model%mesh, results%u, drawing%scale, layout%window, nodes)
      call element_places(model%mesh, results%u, drawing%scale, layout%window, elements)
      do i = 1, size(list)
         if (.not. is_ok(status)) return
         call make_field(list(i), results, nodes, elements, field)
         call write_contour(set, model, results, drawing, layout, raster, field, status)
      end do
   end subroutine write_contour_plots

   !> The raster and the script of a field.
   subroutine write_contour(set, model, results, drawing, layout, raster, field, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(drawing_t), intent(in) :: drawing
      type(layout_t), intent(in) :: layout
      type(raster_t), intent(in) :: raster
      type(field_t), intent(inout) :: field
      type(status_t), intent(out) :: status
      real(wp), allocatable :: pixels(:, :)
      type(bar_t) :: bar

      if (field%contour%of_elements) then
         pixels = element_values(raster, field%value)
      else
         pixels = nodal_values(raster, model%mesh, field%value)
      end if
      if (.not. field%is_shown) call cover(field%range, reshape(pixels, [size(pixels)]))   ! the window lies within an element
      if (field%range%low > field%range%high) field%range = range_t(0.0_wp, 0.0_wp)        ! or beside all of them
      bar = make_bar(usual_range(reshape(pixels, [size(pixels)]), field%range))
      call write_raster(set, trim(field%contour%name), pixels, bar, status)
      if (is_ok(status)) call write_script(set, model, results, drawing, layout, field, bar, status)
   end subroutine write_contour

   !> <name>.bin: of each pixel a byte, from below. Each band of the bar is so many levels, and none lies in two bands.
   subroutine write_raster(set, name, pixels, bar, status)
      type(file_set_t), intent(inout) :: set
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: pixels(:, :)          !< [F/L^2] or as the field
      type(bar_t), intent(in) :: bar
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      character(len=size(pixels, 1)) :: row(1)
      real(wp) :: per_level
      integer :: i, j, level

      call open_text(set, name//'.bin', file)
      per_level = bar%n_bands*levels_of(bar)/span(bar%range)
      do j = 1, size(pixels, 2)
         do i = 1, size(pixels, 1)
            level = BESIDE
            if (ieee_is_finite(pixels(i, j))) then
               level = int(max(0.0_wp, min(real(BESIDE, wp), per_level*(pixels(i, j) - bar%range%low))))
               level = min(level, bar%n_bands*levels_of(bar) - 1)
            end if
            row(1) (i:i) = char(level)
         end do
         call put_lines(file, row)
      end do
      call close_text(file, status)
   end subroutine write_raster

   !> Levels of a band.
   pure integer(ip) function levels_of(bar) result(levels)
      type(bar_t), intent(in) :: bar

      levels = BESIDE/bar%n_bands
   end function levels_of

   subroutine write_script(set, model, results, drawing, layout, field, bar, status)
      type(file_set_t), intent(inout) :: set
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(drawing_t), intent(in) :: drawing
      type(layout_t), intent(in) :: layout
      type(field_t), intent(in) :: field
      type(bar_t), intent(in) :: bar
      type(status_t), intent(out) :: status
      type(text_file_t) :: file

      associate (contour => field%contour)
         call begin_script(set, trim(contour%name), trim(contour%title)//' on the displaced bodies', file)
         call put_line(file, '# '//trim(contour%name)//'.bin: a byte a pixel, in rows from below; '//to_text(BESIDE)// &
                       ': beside the bodies')
         call put_line(file, 'field(k) = k == '//to_text(BESIDE)//' ? NaN : '//to_text(bar%range%low, 10)//' + (k + 0.5)*'// &
                       to_text(bar%step/levels_of(bar), 10)//'   # ['//trim(contour%dimension)//']')
         call put_line(file, 'scale = '//to_text(drawing%scale, 15)// &
                       '   # of the displacements, also of the raster: another one needs a run with --plot-scale')
         call put_line(file, 'heading = '//quoted(picture_title(origin_of(model, results))))
         call put_layout(file, trim(contour%name), layout)
         call put_line(file, 'set label 1 heading."\n'//title_of(contour, results)//'; '//displacement_text(drawing%scale)// &
                       '" at screen 0.5, screen up(height - 20) center noenhanced')
         call put_bar(file, layout, field, bar)
         call put_extremes(file, layout, field, bar)
         call put_curves(file, model, drawing, layout, trim(contour%name))
      end associate
      call end_script(file, status)
   end subroutine write_script

   !> What is drawn, with the whole of what is drawn in shares.
   pure function title_of(contour, results) result(title)
      type(contour_t), intent(in) :: contour
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: title

      title = trim(contour%title)
      if (contour%of_elements) title = title//', share of each element in '//to_text(results%error_estimate, 3)//' %'
   end function title_of

   !> Colours, range and marks of the bar.
   subroutine put_bar(file, layout, field, bar)
      type(text_file_t), intent(inout) :: file
      type(layout_t), intent(in) :: layout
      type(field_t), intent(in) :: field
      type(bar_t), intent(in) :: bar
      character(len=:), allocatable :: power
      integer(ip) :: every

      every = merge(1_ip, 2_ip, bar%n_bands <= 10)
      power = ''
      if (bar%exponent /= 0) power = '10^{'//to_text(int(bar%exponent, ip))//'} '
      call put_line(file, 'unit = 1e'//to_text(int(bar%exponent, ip)))
      call put_line(file, 'set palette maxcolors '//to_text(bar%n_bands)//' defined ('// &
                    palette_text(bar, field%contour%is_signed)//')')
      call put_line(file, 'set cbrange ['//to_text(bar%range%low, 10)//'/unit:'//to_text(bar%range%high, 10)//'/unit]')
      call put_line(file, 'set cbtics '//to_text(every*bar%step, 10)//'/unit format "%g"')
      if (bar%is_flat) call put_line(file, 'set cbtics ('//to_text(field%range%low, DIGITS)//'/unit)')
      call put_bar_place(file, layout, trim(field%contour%symbol)//' ['//power//trim(field%contour%dimension)//']')
   end subroutine put_bar

   !> Marks at the largest and at the least, and lines that tell them.
   subroutine put_extremes(file, layout, field, bar)
      type(text_file_t), intent(inout) :: file
      type(layout_t), intent(in) :: layout
      type(field_t), intent(in) :: field
      type(bar_t), intent(in) :: bar
      character(len=*), parameter :: WORD(2) = ['largest', 'least  ']
      integer, parameter :: UP = 9, DOWN = 11       !< triangles of gnuplot that are filled
      character(len=:), allocatable :: where, mark
      integer(ip) :: k

      if (.not. field%is_shown) return
      if (bar%is_flat) then
         call put_line(file, 'set label 3 "the same everywhere: '//to_text(field%range%low, DIGITS)//'" at screen across('// &
                       to_text(layout%left)//'), screen up(40) left noenhanced')
         return
      end if
      do k = 1, 2
         mark = ' point pt '//to_text(merge(UP, DOWN, k == 1)*1_ip)
         where = 'screen across('//to_text(layout%left)//'), screen up('//to_text(66_ip - 24_ip*k)//')'
         associate (extreme => field%extreme(k))
            call put_line(file, 'set label '//to_text(2*k + 1)//' "'//trim(WORD(k))//' '//to_text(extreme%value, DIGITS)// &
                          ' at '//trim(merge('node   ', 'element', extreme%is_node))//' '//to_text(extreme%id)//', x = '// &
                          to_text(extreme%x(1), 6)//', y = '//to_text(extreme%x(2), 6)//beyond(bar, extreme%value)// &
                          '" at '//where//' left offset 2,0 noenhanced'//mark//' ps 1.3*dot')
         end associate
         where = to_text(field%drawn(1, k), 8)//', '//to_text(field%drawn(2, k), 8)
         call put_line(file, 'set label '//to_text(2*k + 6)//' "" at '//where//' front'//mark//' ps 2.6*dot lc rgb "white"')
         call put_line(file, 'set label '//to_text(2*k + 7)//' "" at '//where//' front'//mark//' ps 1.5*dot lc rgb "black"')
      end do
   end subroutine put_extremes

   !> What is said of a value that the bar does not reach.
   pure function beyond(bar, value) result(text)
      type(bar_t), intent(in) :: bar
      real(wp), intent(in) :: value
      character(len=:), allocatable :: text

      text = ''
      if (value < bar%range%low .or. value > bar%range%high) text = ', beyond the bar'
   end function beyond

   !> One plot: the raster, edges, outlines and rigid surfaces.
   subroutine put_curves(file, model, drawing, layout, name)
      type(text_file_t), intent(inout) :: file
      type(model_t), intent(in) :: model
      type(drawing_t), intent(in) :: drawing
      type(layout_t), intent(in) :: layout
      character(len=*), intent(in) :: name
      type(string_t), allocatable :: curves(:)
      real(wp) :: side(2)
      integer(ip) :: n_inner

      associate (n => layout%n, window => layout%window)
         side = [span(window(1)), span(window(2))]/n
         call append_string(curves, 'plot "'//name//'.bin" binary array=('//to_text(n(1))//','//to_text(n(2))//') dx='// &
                            to_text(side(1), 10)//' dy='//to_text(side(2), 10)//' origin=('// &
                            to_text(window(1)%low + 0.5_wp*side(1), 10)//','//to_text(window(2)%low + 0.5_wp*side(2), 10)// &
                            ') format="%uint8" using (field($1)/unit) with image')
      end associate
      n_inner = count(drawing%lines%kind(:drawing%lines%n_runs) == LINE_INNER, kind=ip)
      if (n_inner > 0 .and. model%mesh%n_nodes <= FEW_NODES) call add_lines(MESH_PLOT, 0_ip, n_inner - 1, &
                                                                            'lt 1 lw 0.4 lc rgb "#606060"', curves)
      call add_lines(MESH_PLOT, n_inner, drawing%lines%n_runs - 1, 'lt 1 lw 1.2 lc rgb "#303030"', curves)
      call add_rigid_lines(MESH_PLOT, drawing%lines%n_runs, 'lt 1 lw 4 lc rgb "#404040"', .false., model, curves)
      call put_plot(file, curves)
   end subroutine put_curves

end module atrito_contour_plot
