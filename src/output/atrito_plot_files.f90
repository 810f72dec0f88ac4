!> The names of the files that atrito writes into DIR/plots, and their removal.
!>
!> Pictures of an earlier run beside new tables would lie, so a run that replaces tables removes them, whether or not it draws
!> new ones; so do a sweep, a study and a limit with theirs. Files under other names are another command's or the user's and stay.
module atrito_plot_files
   use atrito_kinds, only: ip
   use atrito_strings, only: string_t, to_text
   use atrito_files, only: file_exists, is_folder, remove_file, remove_empty_folder
   use atrito_messages, only: add_warning
   implicit none (type, external)
   private
   public :: plot_folder, remove_plots, told_pictures, PLOTS_OF_RUN, PLOTS_OF_SWEEP, PLOTS_OF_STUDY, PLOTS_OF_LIMIT, PLOTS_OF_CHECK
   public :: picture_endings, LOG_NAME, MESH_PLOT, OVERLAY_PLOT, OVERLAY_SUMMARY, CONTACT_PLOT, STUDY_PLOT, LIMIT_PLOT, &
             MECHANISM_PLOT, JOINT_PLOT, HISTORY_PLOT, LOOP_PLOT, MOTION_PLOT, TRACTION_PLOT, CONTOUR_PLOTS, SYMBOLS_OF, &
             SCENE_PLOT, SET_PLOT, GAP_PLOT

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
   !> Whose a picture is: what another command drew into the same folder stays.
   integer, parameter :: PLOTS_OF_RUN = 1, PLOTS_OF_SWEEP = 2, PLOTS_OF_STUDY = 3, PLOTS_OF_LIMIT = 4, PLOTS_OF_CHECK = 5
   character(len=20), parameter :: PICTURES(21) = [character(len=20) :: OVERLAY_SUMMARY, STUDY_PLOT, LIMIT_PLOT, MECHANISM_PLOT, &
                                                                           SCENE_PLOT, SET_PLOT, GAP_PLOT, SCENE_PLOT//SYMBOLS_OF, &
                                                            MESH_PLOT, MESH_PLOT//SYMBOLS_OF, JOINT_PLOT, HISTORY_PLOT, LOOP_PLOT, &
                                                                                          MOTION_PLOT, TRACTION_PLOT, CONTOUR_PLOTS]
   integer, parameter :: OWNER(size(PICTURES)) = [PLOTS_OF_SWEEP, PLOTS_OF_STUDY, PLOTS_OF_LIMIT, PLOTS_OF_LIMIT, &
                                                  PLOTS_OF_CHECK, PLOTS_OF_CHECK, PLOTS_OF_CHECK, PLOTS_OF_CHECK, &
                                                  spread(PLOTS_OF_RUN, 1, size(PICTURES) - 8)]
   character(len=*), parameter :: CONTACT_PLOT = 'contact-', OVERLAY_PLOT = 'overlay-'   !< and the number of the pair
   character(len=*), parameter :: LOG_NAME = 'gnuplot.log'
   character(len=3), parameter :: ENDINGS(6) = ['gp ', 'dat', 'bin', 'png', 'svg', 'gif']

contains

   pure function plot_folder(folder) result(path)
      character(len=*), intent(in) :: folder        !< of the tables
      character(len=:), allocatable :: path

      path = folder//'/plots'
   end function plot_folder

   !> Endings of the files in which a picture is drawn, with their dots: the one that moves is a gif.
   pure function picture_endings(name) result(list)
      character(len=*), intent(in) :: name          !< without ending
      character(len=4), allocatable :: list(:)

      list = ['.png', '.svg']
      if (name == MOTION_PLOT) list = ['.gif']
   end function picture_endings

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

   !> Removes the pictures of one command from the folder of plots, and the folder when nothing else is in it. A
   !> picture that stays is a warning.
   subroutine remove_plots(folder, whose)
      character(len=*), intent(in) :: folder        !< of the tables
      integer, intent(in) :: whose                  !< PLOTS_OF_*
      character(len=:), allocatable :: path
      logical :: stays
      integer :: i

      path = plot_folder(folder)
      if (.not. is_folder(path)) return
      stays = .false.
      do i = 1, size(PICTURES)
         if (OWNER(i) /= whose) cycle
         call remove_picture(path//'/'//trim(PICTURES(i)))
         stays = stays .or. has_picture(path//'/'//trim(PICTURES(i)))
      end do
      if (whose == PLOTS_OF_RUN) call remove_numbered(path//'/'//CONTACT_PLOT)
      if (whose == PLOTS_OF_SWEEP) call remove_numbered(path//'/'//OVERLAY_PLOT)
      call remove_file(path//'/'//LOG_NAME)
      call remove_empty_folder(path)
      if (stays) call add_warning('W-PLOT', path//': pictures of an earlier run cannot be removed')
   end subroutine remove_plots

   !> Removes the pictures of pair 1, 2, ... until there is none.
   subroutine remove_numbered(path)
      character(len=*), intent(in) :: path          !< without the number
      integer(ip) :: i

      i = 1
      do while (has_picture(path//to_text(i)))
         call remove_picture(path//to_text(i))
         i = i + 1
      end do
   end subroutine remove_numbered

   logical function has_picture(path)
      character(len=*), intent(in) :: path          !< without ending
      integer :: i

      has_picture = .false.
      do i = 1, size(ENDINGS)
         if (file_exists(path//'.'//trim(ENDINGS(i)))) has_picture = .true.
      end do
   end function has_picture

   subroutine remove_picture(path)
      character(len=*), intent(in) :: path          !< without ending
      integer :: i

      do i = 1, size(ENDINGS)
         call remove_file(path//'.'//trim(ENDINGS(i)))
      end do
   end subroutine remove_picture

end module atrito_plot_files
