!> The files of some pictures while they are written, one after the other, and the lines that all scripts share. Each file ends
!> where the next one begins.
!>
!> Scripts and data of a command's pictures appear together or not at all.
module atrito_plot_scripts
   use atrito_files, only: file_set_t, text_file_t, begin_files, open_text, put_line, close_text, end_files
   use atrito_kinds, only: ip
   use atrito_plot_files, only: check_scripts, open_data, picture_endings
   use atrito_plot_text, only: range_t, padded, range_text, engineering_exponent, power_text, LF
   use atrito_read_table, only: table_path
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t, to_text
   use atrito_table, only: CSV_ENDING
   use atrito_model, only: name_units, units_t
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   implicit none (type, external)
   private
   public :: plots_t, begin_plots, end_plots, put, begin_file, begin_data, begin_script
   public :: put_table, CSV_SEPARATOR, put_terminal, put_frame, put_panel, put_plot

   !> What a script has to say before it reads comma-separated values.
   character(len=*), parameter :: CSV_SEPARATOR = 'set datafile separator comma'

   !> The files of some pictures, one of which is open.
   type :: plots_t
      type(file_set_t) :: set                       !< in the folder of the plots
      type(status_t) :: status                      !< the first failure: STATUS_FILE; no file is opened behind it
      type(text_file_t) :: file                     !< that is being written
      logical :: is_script = .false.                !< it is one that draws both kinds of picture in a loop
      character(len=:), allocatable :: name         !< of the picture whose script it is, without ending
      type(units_t) :: units                        !< of the deck, in scripts
   end type plots_t

contains

   !> Begins the files of pictures in their folder.
   subroutine begin_plots(plots, folder, units)
      type(plots_t), intent(out) :: plots           !< no file is open yet; status STATUS_FILE where the folder cannot be
      character(len=*), intent(in) :: folder        !< of the plots
      type(units_t), intent(in), optional :: units

      call begin_files(plots%set, folder, plots%status)
      plots%file%status = plots%status
      if (present(units)) plots%units = units
   end subroutine begin_plots

   !> Gives all files their names, or removes them where one failed. status: STATUS_FILE.
   subroutine end_plots(plots, status)
      type(plots_t), intent(inout) :: plots         !< no file is open on return
      type(status_t), intent(out) :: status         !< STATUS_OK or STATUS_FILE

      call end_file(plots)
      status = plots%status
      call check_scripts(plots%set, status)
      call end_files(plots%set, status)
   end subroutine end_plots

   !> Ends the file that is being written, if there is one.
   subroutine end_file(plots)
      type(plots_t), intent(inout) :: plots

      if (plots%is_script) call put(plots, '}'//LF//'set output')
      plots%is_script = .false.
      call close_text(plots%file, plots%status)
   end subroutine end_file

   !> Begins a file.
   subroutine begin_file(plots, name)
      type(plots_t), intent(inout) :: plots         !< its file ends, and the next begins
      character(len=*), intent(in) :: name          !< of the file, with its ending

      call end_file(plots)
      if (is_ok(plots%status)) call open_text(plots%set, name, plots%file)
   end subroutine begin_file

   !> Writes a line, or several with LF between them. Words of the user stand in single quotes.
   subroutine put(plots, text)
      type(plots_t), intent(inout) :: plots         !< lines go into its open file
      character(len=*), intent(in) :: text          !< without LF at its end
      character(len=:), allocatable :: named

      named = text
      if (plots%is_script) call name_units(plots%units, named, quote="'")
      call put_line(plots%file, named)
   end subroutine put

   !> Begins the data of a picture.
   subroutine begin_data(plots, name, what)
      type(plots_t), intent(inout) :: plots         !< its file ends, and the next begins
      character(len=*), intent(in) :: name          !< of the file, without .dat
      character(len=*), intent(in) :: what          !< stands in it: a comment

      call end_file(plots)
      if (is_ok(plots%status)) call open_data(plots%set, name, plots%file)
      call put(plots, '# '//what)
   end subroutine begin_data

   !> Begins a script: what it draws, how it is used, and what the columns of its data are.
   subroutine begin_script(plots, name, what, columns)
      type(plots_t), intent(inout) :: plots         !< its file ends, and the next begins
      character(len=*), intent(in) :: name          !< of the picture
      character(len=*), intent(in) :: what          !< it draws, in a few words
      character(len=*), intent(in), optional :: columns   !< with LF between lines, of which all but the first have their mark
      character(len=4), allocatable :: endings(:)
      character(len=:), allocatable :: pictures
      integer :: i

      endings = picture_endings(name)
      pictures = name//endings(1)
      do i = 2, size(endings)
         pictures = pictures//' and '//name//endings(i)
      end do
      plots%name = name
      call begin_file(plots, name//'.gp')
      plots%is_script = .true.
      call put(plots, '# '//PROGRAM_NAME//' '//PROGRAM_VERSION//': '//what)
      call put(plots, '# In this folder: gnuplot '//name//'.gp draws '//pictures//' again.')
      call put(plots, '# The next run removes this file: to keep changes, copy it under another name.'//LF//'reset'//LF// &
               'set encoding utf8')
      if (present(columns)) call put(plots, '# '//columns)
   end subroutine begin_script

   !> Tells a script which table it draws: that in the folder above, in the form in which it is there.
   subroutine put_table(plots, name)
      type(plots_t), intent(inout) :: plots         !< lines go into its open script
      character(len=*), intent(in) :: name          !< of the table
      character(len=:), allocatable :: path

      path = table_path(plots%set%folder//'/..', name)
      if (path(len(path) - len(CSV_ENDING) + 1:) == CSV_ENDING) call put(plots, CSV_SEPARATOR)
      call put(plots, 'table = "..'//path(index(path, '/', back=.true.):)//'"')
   end subroutine put_table

   !> The loop over both kinds of picture; what is drawn follows, and the end of the file ends it.
   subroutine put_terminal(plots, size_text)
      type(plots_t), intent(inout) :: plots         !< lines go into its open script
      character(len=*), intent(in) :: size_text     !< width,height in pixels

      call put(plots, 'do for [kind in "png svg"] {'//LF//'if (kind eq "png") { set terminal pngcairo size '//size_text// &
               ' font "sans-serif,11" background "white" enhanced'//LF// &
               '} else { set terminal svg size '//size_text//' font "sans-serif,15" background "white" enhanced }'//LF// &
               'set output "'//plots%name//'.".kind'//LF//'dot = kind eq "png" ? 1.0 : 0.6')
   end subroutine put_terminal

   !> A column of panels over one axis: places and looks.
   subroutine put_frame(plots, panels, range, x_label)
      type(plots_t), intent(inout) :: plots         !< lines go into its open script
      integer(ip), intent(in) :: panels             !< how many, one below the other
      type(range_t), intent(in) :: range            !< of the axis below
      character(len=*), intent(in) :: x_label       !< a string of gnuplot

      call put(plots, 'panels = '//to_text(panels)//LF// &
               'height = 120 + 230*panels'//LF// &
               'top(i) = 1 - (60.0 + (i - 1)*230)/height'//LF// &
               'bottom(i) = top(i) - 205.0/height'//LF// &
               'middle(i) = 0.5*top(i) + 0.5*bottom(i)'//LF// &
               'set border 3 lt 1 lw 1 lc rgb "#404040"'//LF// &
               'set tics nomirror out scale 0.6 textcolor rgb "black"'//LF// &
               'set grid lt 1 lw 1 lc rgb "#E0E0E0"'//LF// &
               'set xzeroaxis lt 1 lw 1 lc rgb "#808080"'//LF// &
               'set format y "%h"'//LF//'set lmargin at screen 0.13'//LF//'right = 0.78'//LF// &
               'set xrange '//range_text(range)//LF//'axis_label = '//x_label//LF//'x_format = "%h"')
   end subroutine put_frame

   !> Goes to a panel, whose values are to be divided by `unit`. Its label stands at the same place in all panels, its legend to
   !> the right of it.
   subroutine put_panel(plots, place, name, dimension, range)
      type(plots_t), intent(inout) :: plots           !< lines go into its open script
      integer(ip), intent(in) :: place                !< 1 the uppermost
      character(len=*), intent(in) :: name, dimension !< of what is drawn, and in F and L or ''
      type(range_t), intent(in) :: range            !< of the values
      type(range_t) :: window
      character(len=:), allocatable :: i, unit
      integer(ip) :: power

      i = to_text(place)
      window = padded(range)
      power = engineering_exponent(range)
      unit = trim(power_text(power)//dimension)
      if (len(unit) > 0) unit = ' ['//unit//']'
      call put(plots, 'set rmargin at screen right; set tmargin at screen top('//i//'); set bmargin at screen bottom('//i//')'// &
               LF//'set key noautotitle at screen right + 0.015, screen top('//i// &
               ') left top Left reverse samplen 2.5 spacing 1.15'//LF// &
               'set label 1 "'//name//unit//'" at screen 0.03, screen middle('//i// &
               ') center rotate by 90'//LF// &
               'if ('//i//' == panels) { set format x x_format; set xlabel axis_label noenhanced } '// &
               'else { set format x ""; unset xlabel }'//LF//'unit = 1e'//to_text(power)//LF// &
               'set yrange ['//to_text(window%low, 8)//'/unit:'//to_text(window%high, 8)//'/unit]')
   end subroutine put_panel

   !> A plot of some curves, a line each.
   subroutine put_plot(plots, curves)
      type(plots_t), intent(inout) :: plots         !< lines go into its open script
      type(string_t), intent(in) :: curves(:)       !< one at least, as gnuplot has them
      character(len=:), allocatable :: line
      integer :: i

      line = 'plot '
      do i = 1, size(curves) - 1
         call put(plots, line//curves(i)%s//', \')
         line = '   '
      end do
      call put(plots, line//curves(size(curves))%s)
   end subroutine put_plot

end module atrito_plot_scripts
