!> The names of the files that atrito writes into DIR/plots, and their removal.
!>
!> Pictures of an earlier run beside new tables would lie, so a run that replaces tables removes them, whether or not it draws
!> new ones. Files under other names are the user's and stay.
module atrito_plot_files
   use atrito_kinds, only: ip
   use atrito_strings, only: to_text
   use atrito_files, only: file_exists, is_folder, remove_file, remove_empty_folder
   use atrito_messages, only: add_warning
   implicit none (type, external)
   private
   public :: plot_folder, remove_plots, picture_endings, LOG_NAME, MESH_PLOT, OVERLAY_PLOT, OVERLAY_SUMMARY, CONTACT_PLOT, &
             STUDY_PLOT, LIMIT_PLOT, MECHANISM_PLOT, JOINT_PLOT, HISTORY_PLOT, LOOP_PLOT, MOTION_PLOT

   character(len=*), parameter :: MESH_PLOT = 'mesh', OVERLAY_SUMMARY = 'overlay-summary', STUDY_PLOT = 'study', &
                                  LIMIT_PLOT = 'limit', MECHANISM_PLOT = 'mechanism', JOINT_PLOT = 'joints', &
                                  HISTORY_PLOT = 'history', LOOP_PLOT = 'loop', MOTION_PLOT = 'motion'
   character(len=15), parameter :: PICTURES(9) = [character(len=15) :: MESH_PLOT, OVERLAY_SUMMARY, STUDY_PLOT, LIMIT_PLOT, &
                                                                   MECHANISM_PLOT, JOINT_PLOT, HISTORY_PLOT, LOOP_PLOT, MOTION_PLOT]
   character(len=*), parameter :: CONTACT_PLOT = 'contact-', OVERLAY_PLOT = 'overlay-'   !< and the number of the pair
   character(len=*), parameter :: LOG_NAME = 'gnuplot.log'
   character(len=3), parameter :: ENDINGS(5) = ['gp ', 'dat', 'png', 'svg', 'gif']

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

   !> Removes atrito's own files from the folder of plots, and the folder when nothing else is in it. A
   !> picture that stays is a warning.
   subroutine remove_plots(folder)
      character(len=*), intent(in) :: folder        !< of the tables
      character(len=:), allocatable :: path
      integer :: i

      path = plot_folder(folder)
      if (.not. is_folder(path)) return
      do i = 1, size(PICTURES)
         call remove_picture(path//'/'//trim(PICTURES(i)))
      end do
      call remove_numbered(path//'/'//CONTACT_PLOT)
      call remove_numbered(path//'/'//OVERLAY_PLOT)
      call remove_file(path//'/'//LOG_NAME)
      call remove_empty_folder(path)
      if (.not. file_exists(path//'/'//MESH_PLOT//'.png')) return
      call add_warning('W-PLOT', path//': pictures of an earlier run cannot be removed')
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
