!> The picture of a study: error against processor time, and processor time against the number of displacements, both on
!> logarithmic axes, a curve an element type, its last slope in the legend.
module atrito_study_plot
   use atrito_files, only: file_set_t, text_file_t, begin_files, put_line, close_text, end_files
   use atrito_gnuplot, only: draw_written
   use atrito_kinds, only: ip, wp, is_nan
   use atrito_number_text, only: trimmed_real
   use atrito_plot_files, only: open_data, check_scripts, plot_folder, STUDY_PLOT
   use atrito_plot_text, only: quoted, cleaned, begin_script, end_script, put_terminal, COLOUR, N_COLOURS
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, to_text
   use atrito_study_errors, only: study_t
   implicit none (type, external)
   private
   public :: write_study_plot

   integer, parameter :: LONGEST_TITLE = 90          !< characters

contains

   !> Draws <folder>/plots/study.png and .svg. A failure is a warning, W-PLOT.
   subroutine write_study_plot(folder, title, study, drawn)
      character(len=*), intent(in) :: folder         !< of the study
      character(len=*), intent(in) :: title
      type(study_t), intent(in) :: study
      type(string_t), allocatable, intent(out) :: drawn(:)
      type(file_set_t) :: set
      type(status_t) :: status
      type(string_t) :: plots(1)

      call begin_files(set, plot_folder(folder), status)
      if (is_ok(status)) call write_data(set, study, status)
      if (is_ok(status)) call write_script(set, title, study, status)
      call check_scripts(set, status)
      call end_files(set, status)
      plots(1)%s = STUDY_PLOT
      call draw_written(folder, plots, status, drawn)
   end subroutine write_study_plot

   !> A block an element: dofs, seconds, estimate, then the error of each quantity [%].
   subroutine write_data(set, study, status)
      type(file_set_t), intent(inout) :: set
      type(study_t), intent(in) :: study
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      character(len=:), allocatable :: line
      integer :: i, j, k

      call open_data(set, STUDY_PLOT, file)
      call put_line(file, '# a block an element; columns: dofs, processor seconds, estimated error [%], errors of the '// &
                    'quantities [%]')
      do i = 1, size(study%elements)
         do k = 1, size(study%rows)
            associate (row => study%rows(k))
               if (row%element /= study%elements(i)%s) cycle
               line = to_text(row%n_dofs)//' '//trimmed_real(sum(row%phases%cpu), 6)//' '//trimmed_real(row%estimate, 6)
               do j = 1, size(study%quantities)
                  line = line//' '//trimmed_real(100*study%quantities(j)%error(k), 6)
               end do
               call put_line(file, line)
            end associate
         end do
         call put_line(file, '')
         call put_line(file, '')
      end do
      call close_text(file, status)
   end subroutine write_data

   subroutine write_script(set, title, study, status)
      type(file_set_t), intent(inout) :: set
      character(len=*), intent(in) :: title
      type(study_t), intent(in) :: study
      type(status_t), intent(out) :: status
      type(text_file_t) :: file
      integer :: j, panels

      panels = 2 + count([(has_panel(study, j), j=1, size(study%quantities))])
      call begin_script(set, STUDY_PLOT, 'error against run time, and run time against size', file)
      call put_line(file, '# Columns of study.dat: 1 dofs, 2 processor seconds, 3 estimated error [%], 4 ... errors of the '// &
                    'quantities [%]')
      call put_line(file, 'set logscale xy; set format x "%g"; set format y "%g"; set grid lt 1 lw 1 lc rgb "#E0E0E0"')
      call put_line(file, 'set border 3 lt 1 lw 1 lc rgb "#404040"; set tics nomirror out scale 0.6 textcolor rgb "black"')
      call put_line(file, 'set lmargin at screen 0.12; set rmargin at screen 0.76')
      call put_line(file, 'set key at screen 0.775, graph 1 left top Left reverse samplen 2.5 noenhanced')
      call put_line(file, 'set style line 20 lt 1 dt 2 lw 1.2 lc rgb "#808080"')
      call put_terminal(file, STUDY_PLOT, '1000,'//to_text(int(60 + 320*panels, ip)))
      call put_line(file, 'set multiplot layout '//to_text(int(panels, ip))//',1 title '// &
                    quoted(cleaned(title, LONGEST_TITLE)//'   (slopes are those of the last two levels)')//' noenhanced')
      do j = 1, size(study%quantities)
         if (.not. has_panel(study, j)) cycle
         call put_labels(file, 'processor time [s]', 'error of '//study%quantities(j)%name//' [%]')
         call put_curves(file, study, 2, 3 + j)
      end do
      call put_labels(file, 'processor time [s]', 'estimated error, energy norm [%]')
      call put_curves(file, study, 2, 3)
      call put_labels(file, 'displacements', 'processor time [s]')
      call put_curves(file, study, 1, 2)
      call put_line(file, 'unset multiplot')
      call end_script(file, status)
   end subroutine write_script

   !> A quantity without a reference has no errors to show, one that is held has nothing but rounding.
   pure logical function has_panel(study, j)
      type(study_t), intent(in) :: study
      integer, intent(in) :: j                      !< quantity
      integer :: i

      has_panel = .false.
      if (study%quantities(j)%is_held) return
      do i = 1, size(study%elements)
         has_panel = has_panel .or. has_points(study, study%elements(i)%s, 2, 3 + j)
      end do
   end function has_panel

   !> The label of the ordinate stands at the same place in all panels, however long their numbers are.
   subroutine put_labels(file, x_label, y_label)
      type(text_file_t), intent(inout) :: file
      character(len=*), intent(in) :: x_label, y_label

      call put_line(file, 'set xlabel '//quoted(x_label)//'; set label 1 '//quoted(y_label)// &
                    ' at screen 0.03, graph 0.5 center rotate by 90 noenhanced')
   end subroutine put_labels

   !> One panel: column y against column x. Where no number can be drawn the panel is left empty.
   subroutine put_curves(file, study, x, y)
      type(text_file_t), intent(inout) :: file
      type(study_t), intent(in) :: study
      integer, intent(in) :: x, y
      character(len=:), allocatable :: line
      integer :: i

      line = ''
      do i = 1, size(study%elements)
         if (.not. has_points(study, study%elements(i)%s, x, y)) cycle
         if (len(line) > 0) line = line//', '
         line = line//'"study.dat" index '//to_text(int(i - 1, ip))//' using '//to_text(int(x, ip))//':'//to_text(int(y, ip)) &
                //' with linespoints lt 1 lw 1.8 pt '//to_text(int(5 + 2*mod(i, 4), ip))//' ps 0.9*dot lc rgb "' &
                //COLOUR(mod(i - 1, N_COLOURS) + 1)//'" title '// &
                quoted(study%elements(i)%s//slope_text(study, study%elements(i)%s, x, y))
      end do
      if (len(line) == 0) then
         call put_line(file, 'set multiplot next')
      else
         if (y > 3) line = line//', 1 with lines ls 20 title "1 %"'
         call put_line(file, 'plot '//line)
      end if
   end subroutine put_curves

   pure logical function has_points(study, element, x, y)
      type(study_t), intent(in) :: study
      character(len=*), intent(in) :: element
      integer, intent(in) :: x, y
      integer :: k

      has_points = .false.
      do k = 1, size(study%rows)
         if (study%rows(k)%element /= element) cycle
         has_points = has_points .or. (is_positive(column(study, k, x)) .and. is_positive(column(study, k, y)))
      end do
   end function has_points

   !> `, slope -0.49` of the last two points; empty where there are none.
   pure function slope_text(study, element, x, y) result(text)
      type(study_t), intent(in) :: study
      character(len=*), intent(in) :: element
      integer, intent(in) :: x, y
      character(len=:), allocatable :: text
      real(wp) :: dx
      integer :: k

      text = ''
      do k = 2, size(study%rows)
         if (study%rows(k)%element /= element .or. study%rows(k - 1)%element /= element) cycle
         text = ''
         if (.not. (is_positive(column(study, k, x)) .and. is_positive(column(study, k - 1, x)))) cycle
         if (.not. (is_positive(column(study, k, y)) .and. is_positive(column(study, k - 1, y)))) cycle
         dx = log(column(study, k, x)/column(study, k - 1, x))
         if (dx > 0.0_wp) text = ', slope '//to_text(log(column(study, k, y)/column(study, k - 1, y))/dx, 2)
      end do
   end function slope_text

   pure logical function is_positive(x)
      real(wp), intent(in) :: x

      is_positive = .false.
      if (.not. is_nan(x)) is_positive = x > 0.0_wp
   end function is_positive

   !> A number of study.dat.
   pure real(wp) function column(study, k, place)
      type(study_t), intent(in) :: study
      integer, intent(in) :: k, place

      select case (place)
      case (1)
         column = real(study%rows(k)%n_dofs, wp)
      case (2)
         column = sum(study%rows(k)%phases%cpu)
      case (3)
         column = study%rows(k)%estimate
      case default
         column = study%quantities(place - 3)%error(k)
      end select
   end function column

end module atrito_study_plot
