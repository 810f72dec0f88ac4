!> The names of the files that atrito writes into DIR/plots, and their removal.
!>
!> Pictures of an earlier run beside new tables would lie, so a run that replaces tables removes them, whether or not it draws
!> new ones; so do a sweep, a study and a limit with theirs. Files under other names are another command's or the user's and stay.
module atrito_plot_files
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, append_string, to_text
   use atrito_version, only: PROGRAM_VERSION
   use atrito_files, only: file_exists, is_folder, remove_file, remove_empty_folder, file_set_t, text_file_t, open_text, put_line
   use atrito_messages, only: add_warning
   use atrito_own_files, only: check_own, OWN_MARK
   use atrito_status, only: status_t, is_ok
   implicit none (type, external)
   private
   public :: plot_folder, solution_folder
   public :: remove_plots, told_pictures, PLOTS_OF_RUN, PLOTS_OF_SWEEP, PLOTS_OF_STUDY, PLOTS_OF_LIMIT, PLOTS_OF_CHECK
   public :: list_plots, check_scripts, open_data, REPORT_NAME, remove_report
   public :: picture_endings, LOG_NAME, MESH_PLOT, OVERLAY_PLOT, OVERLAY_SUMMARY, CONTACT_PLOT, STUDY_PLOT, LIMIT_PLOT, &
             MECHANISM_PLOT, JOINT_PLOT, HISTORY_PLOT, LOOP_PLOT, MOTION_PLOT, TRACTION_PLOT, CONTOUR_PLOTS, SYMBOLS_OF, &
             SCENE_PLOT, SET_PLOT, GAP_PLOT, PATH_PLOT, SHOWN_PLOTS

   character(len=*), parameter :: MESH_PLOT = 'mesh', OVERLAY_SUMMARY = 'overlay-summary', STUDY_PLOT = 'study', &
                                  LIMIT_PLOT = 'limit', MECHANISM_PLOT = 'mechanism', JOINT_PLOT = 'joints', &
                                  HISTORY_PLOT = 'history', LOOP_PLOT = 'loop', MOTION_PLOT = 'motion', &
                                  TRACTION_PLOT = 'tractions'
   !> Contours of a run, in the order in which they are drawn.
   character(len=20), parameter :: CONTOUR_PLOTS(6) = [character(len=20) :: 'contour-mises', 'contour-s11', 'contour-s22', &
                                                                             'contour-s12', 'contour-displacement', 'contour-error']
   character(len=*), parameter :: SYMBOLS_OF = '-symbols'  !< behind the name of a picture: the data of its symbols
   !> What `check --plot` draws.
   character(len=*), parameter :: SCENE_PLOT = 'scene', SET_PLOT = 'sets', GAP_PLOT = 'pairs'
   !> What a run draws of --adapt and --show.
   character(len=11), parameter :: SHOWN_PLOTS(4) = ['adapt      ', 'show-matrix', 'show-picard', 'show-law   ']
   !> Whose a picture is: what another command drew into the same folder stays.
   integer, parameter :: PLOTS_OF_RUN = 1, PLOTS_OF_SWEEP = 2, PLOTS_OF_STUDY = 3, PLOTS_OF_LIMIT = 4, PLOTS_OF_CHECK = 5
   character(len=20), parameter :: PICTURES(25) = [character(len=20) :: &
                  OVERLAY_SUMMARY, STUDY_PLOT, LIMIT_PLOT, MECHANISM_PLOT, SCENE_PLOT, SET_PLOT, GAP_PLOT, SCENE_PLOT//SYMBOLS_OF, &
                                MESH_PLOT, MESH_PLOT//SYMBOLS_OF, JOINT_PLOT, HISTORY_PLOT, LOOP_PLOT, MOTION_PLOT, TRACTION_PLOT, &
                                                   CONTOUR_PLOTS, SHOWN_PLOTS]
   integer, parameter :: OWNER(size(PICTURES)) = [PLOTS_OF_SWEEP, PLOTS_OF_STUDY, spread(PLOTS_OF_LIMIT, 1, 2), &
                                                  spread(PLOTS_OF_CHECK, 1, 4), spread(PLOTS_OF_RUN, 1, size(PICTURES) - 8)]
   character(len=*), parameter :: CONTACT_PLOT = 'contact-', OVERLAY_PLOT = 'overlay-'   !< and the number of the pair
   character(len=*), parameter :: PATH_PLOT = 'path-'       !< and the number of the path
   character(len=*), parameter :: LOG_NAME = 'gnuplot.log'
   character(len=*), parameter :: REPORT_NAME = 'report.html'   !< of --report, in the folder of the tables: there it would lie, too
   character(len=3), parameter :: ENDINGS(6) = ['gp ', 'dat', 'bin', 'png', 'svg', 'gif']

contains

   !> The folder of the pictures: DIR/plots.
   pure function plot_folder(folder) result(path)
      character(len=*), intent(in) :: folder        !< of the tables
      character(len=:), allocatable :: path

      path = folder//'/plots'
   end function plot_folder

   !> The folder of solution k, below that of the run, which has the first.
   pure function solution_folder(folder, k) result(path)
      character(len=*), intent(in) :: folder        !< of the tables of the run
      integer(ip), intent(in) :: k                  !< 2, 3, ..
      character(len=:), allocatable :: path

      path = folder//'/solution-'//to_text(k)
   end function solution_folder

   !> Endings of the files in which a picture is drawn, with their dots: the one that moves is a gif.
   pure function picture_endings(name) result(list)
      character(len=*), intent(in) :: name          !< without ending
      character(len=4), allocatable :: list(:)

      list = ['.png', '.svg']
      if (name == MOTION_PLOT) list = ['.gif']
   end function picture_endings

   !> Opens the data of a picture in a set of files; the first line says whose they are.
   subroutine open_data(set, name, file)
      type(file_set_t), intent(inout) :: set        !< begun in the folder of pictures; gets the file
      character(len=*), intent(in) :: name          !< without .dat
      type(text_file_t), intent(out) :: file        !< open, with its first line

      call open_text(set, name//'.dat', file)
      call put_line(file, OWN_MARK//PROGRAM_VERSION//': data of a picture')
   end subroutine open_data

   !> Whether what a set of scripts is going to replace, and the pictures that gnuplot writes beside them, is atrito's.
   !> status: STATUS_FILE.
   subroutine check_scripts(set, status)
      type(file_set_t), intent(in) :: set           !< scripts are reserved in it, not committed
      type(status_t), intent(inout) :: status       !< nothing is asked where it is not STATUS_OK
      character(len=4), allocatable :: endings(:)
      integer :: i, k, n

      if (is_ok(status)) call check_own(set%folder//'/'//LOG_NAME, status)
      if (.not. allocated(set%names)) return
      do i = 1, size(set%names)
         if (is_ok(status)) call check_own(set%folder//'/'//set%names(i)%s, status)
         n = len(set%names(i)%s) - len('.gp')
         if (index(set%names(i)%s, '.gp', back=.true.) /= n + 1) cycle
         endings = picture_endings(set%names(i)%s(:n))
         do k = 1, size(endings)
            if (is_ok(status)) call check_own(set%folder//'/'//set%names(i)%s(:n)//endings(k), status)
         end do
      end do
   end subroutine check_scripts

   !> Names of pictures with blanks between them; the contours are told together.
   pure function told_pictures(names) result(text)
      type(string_t), intent(in) :: names(:)        !< without ending
      character(len=:), allocatable :: text
      logical :: have_contours
      integer :: i

      text = ''
      have_contours = .false.
      do i = 1, size(names)
         if (.not. any(CONTOUR_PLOTS == names(i)%s)) then
            text = text//' '//names(i)%s
         else if (.not. have_contours) then
            text = text//' contours'
            have_contours = .true.
         end if
      end do
      text = text(2:)
   end function told_pictures

   !> The files that remove_plots removes, as far as they are there and are atrito's; none where there is no folder of pictures.
   function list_plots(folder, whose) result(names)
      character(len=*), intent(in) :: folder        !< of the tables
      integer, intent(in) :: whose                  !< PLOTS_OF_*
      type(string_t), allocatable :: names(:)       !< without folder
      integer :: i

      allocate (names(0))
      if (.not. is_folder(plot_folder(folder))) return
      call append_string(names, LOG_NAME)
      do i = 1, size(PICTURES)
         if (OWNER(i) == whose) call append_picture(trim(PICTURES(i)))
      end do
      if (whose /= PLOTS_OF_RUN .and. whose /= PLOTS_OF_SWEEP) return
      call append_numbered(merge(CONTACT_PLOT, OVERLAY_PLOT, whose == PLOTS_OF_RUN))
      if (whose == PLOTS_OF_RUN) call append_numbered(PATH_PLOT)

   contains

      subroutine append_numbered(name)
         character(len=*), intent(in) :: name       !< without number
         integer(ip) :: n

         n = 1
         do while (has_picture(name//to_text(n)))
            call append_picture(name//to_text(n))
            n = n + 1
         end do
      end subroutine append_numbered

      subroutine append_picture(name)
         character(len=*), intent(in) :: name       !< without ending
         integer :: k

         do k = 1, size(ENDINGS)
            call append_string(names, name//'.'//trim(ENDINGS(k)))
         end do
      end subroutine append_picture

      logical function has_picture(name)
         character(len=*), intent(in) :: name       !< without ending
         integer :: k

         has_picture = .false.
         do k = 1, size(ENDINGS)
            if (file_exists(plot_folder(folder)//'/'//name//'.'//trim(ENDINGS(k)))) has_picture = .true.
         end do
      end function has_picture

   end function list_plots

   !> Removes the pictures of one command from the folder of plots, and the folder when nothing else is in it. A
   !> picture that stays is a warning.
   subroutine remove_plots(folder, whose)
      character(len=*), intent(in) :: folder        !< of the tables
      integer, intent(in) :: whose                  !< PLOTS_OF_*
      type(string_t), allocatable :: names(:)
      logical :: stays
      integer :: i

      names = list_plots(folder, whose)
      stays = .false.
      do i = 1, size(names)
         call remove_file(plot_folder(folder)//'/'//names(i)%s)
         if (names(i)%s /= LOG_NAME) stays = stays .or. file_exists(plot_folder(folder)//'/'//names(i)%s)
      end do
      if (size(names) > 0) call remove_empty_folder(plot_folder(folder))
      if (stays) call add_warning('W-PLOT', plot_folder(folder)//': pictures of an earlier run cannot be removed')
   end subroutine remove_plots

   !> Removes the report of an earlier run. One that stays is a warning.
   subroutine remove_report(folder)
      character(len=*), intent(in) :: folder        !< of the tables

      call remove_file(folder//'/'//REPORT_NAME)
      if (file_exists(folder//'/'//REPORT_NAME)) then
         call add_warning('W-REPORT', folder//'/'//REPORT_NAME//': the report of an earlier run cannot be removed')
      end if
   end subroutine remove_report

end module atrito_plot_files
