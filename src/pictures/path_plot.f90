!> The pictures of paths: stresses and displacements along each, in two panels, at the end of the history. The data has an empty
!> line where a path leaves a body.
module atrito_path_plot
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t, path_t
   use atrito_frame_tables, only: path_values, PATH_COLUMNS
   use atrito_plot_files, only: PATH_PLOT
   use atrito_plot_scripts, only: plots_t, put, begin_data, begin_script, put_terminal, put_frame, put_panel, put_plot
   use atrito_plot_text, only: cleaned, colour_styles, picture_title, quoted, range_of, DASH, LF
   use atrito_results, only: history_t, results_t, last_frame
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_write_tables, only: origin_of
   implicit none (type, external)
   private
   public :: plotted_paths, write_path_plot

   integer, parameter :: MOST_PATHS = 20                !< that have a picture
   integer, parameter :: LONGEST_NAME = 30, DIGITS = 10
   !> What is drawn: normal stresses, the shear stress, displacements, of a straight path and about a centre.
   character(len=8), parameter :: DRAWN(5, 2) = reshape([character(len=8) :: 's_along', 's_across', 's_shear', 'u_along', &
                                                                          'u_across', 's_rr', 's_tt', 's_rt', 'u_r', 'u_t'], [5, 2])
   character(len=10), parameter :: TITLES(5, 2) = reshape([character(len=10) :: 'along', 'across', 'shear', 'along', 'across', &
                                                                         'radial', 'hoop', 'shear', 'radial', 'tangential'], [5, 2])

contains

   !> How many paths have a picture.
   pure integer(ip) function plotted_paths(model, results) result(n)
      type(model_t), intent(in) :: model               !< what its steps ask for
      type(results_t), intent(in) :: results           !< of the last frame

      n = 0
      associate (requests => model%steps(results%step)%requests)
         if (allocated(requests%paths) .and. allocated(results%nodal_stress)) n = min(MOST_PATHS, size(requests%paths))
      end associate
   end function plotted_paths

   !> Writes data and script of one of them.
   subroutine write_path_plot(plots, model, history, i)
      type(plots_t), intent(inout) :: plots      !< get data and script
      type(model_t), intent(in) :: model         !< its paths, as placed
      type(history_t), intent(in) :: history     !< its last frame is drawn
      integer(ip), intent(in) :: i               !< of the paths that are asked for, from 1
      real(wp), allocatable :: values(:, :)
      type(path_t) :: path
      character(len=:), allocatable :: name, line
      integer :: columns(size(DRAWN, 1)), kind, k, j, m

      name = PATH_PLOT//to_text(i)
      associate (results => history%frames(last_frame(history)))
         path = model%paths(model%steps(results%step)%requests%paths(i))
         values = path_values(model, results, path)
      end associate
      kind = merge(2, 1, path%is_arc .or. path%has_centre)
      do k = 1, size(DRAWN, 1)
         columns(k) = column_of(DRAWN(k, kind))
      end do
      call begin_data(plots, name, 'the columns: '//name//'.gp')
      do j = 1, size(values, 1)
         if (j > 1) then
            if (path%place(j)%point /= path%place(j - 1)%point + 1) call put(plots, '')
         end if
         line = to_text(path%s(j), DIGITS)
         do m = 1, size(values, 2)
            line = line//' '//to_text(values(j, m), DIGITS)
         end do
         call put(plots, line)
      end do
      call begin_script(plots, name, 'stresses and displacements along path '//cleaned(path%name, LONGEST_NAME), &
                        'Columns of '//name//'.dat: 1 s [L], '// &
                        'then those of path.tab behind element; an empty line where the path leaves a body')
      call put(plots, 'heading = '//quoted(picture_title(origin_of(model, history)))//LF// &
               'path_line = '//quoted('path '//cleaned(path%name, LONGEST_NAME)))
      call put_frame(plots, 2_ip, range_of(path%s), '"s [L]"')
      call put_terminal(plots, '1000,height')
      call put(plots, colour_styles(' lw 2')//LF//'set style line 2 dt '//DASH(2)//LF//'set style line 3 dt '//DASH(3)//LF// &
               'set style line 4 lw 1.5 dt '//trim(DASH(8))//' lc rgb "#404040"')
      call put(plots, 'set multiplot title heading."\n".path_line noenhanced')
      call put_panel(plots, 1_ip, 'stress', 'F/L^2', range_of([0.0_wp, values(:, columns(1)), values(:, columns(2)), &
                                                               values(:, columns(3)), values(:, column_of('mises'))]))
      call put_curves(plots, name, [columns(:3), column_of('mises')], [TITLES(:3, kind), 'mises     '])
      call put_panel(plots, 2_ip, 'displacement', 'L', range_of([0.0_wp, values(:, columns(4)), values(:, columns(5))]))
      call put_curves(plots, name, columns(4:5), TITLES(4:, kind))
      call put(plots, 'unset multiplot')
   end subroutine write_path_plot

   pure integer function column_of(name)
      character(len=*), intent(in) :: name

      column_of = findloc(PATH_COLUMNS == name, .true., dim=1)
   end function column_of

   subroutine put_curves(plots, name, columns, titles)
      type(plots_t), intent(inout) :: plots
      character(len=*), intent(in) :: name, titles(:)
      integer, intent(in) :: columns(:)                !< places in PATH_COLUMNS
      type(string_t), allocatable :: curves(:)
      integer :: i

      allocate (curves(0))
      do i = 1, size(columns)
         call append_string(curves, '"'//name//'.dat" using 1:(column('//to_text(int(columns(i) + 1, ip))// &
                            ')/unit) with lines ls '//to_text(int(i, ip))//' title "'//trim(titles(i))//'"')
      end do
      call put_plot(plots, curves)
   end subroutine put_curves

end module atrito_path_plot
