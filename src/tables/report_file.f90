!> The name of the file in which a report is written, and its removal: beside new tables an old one would lie.
module atrito_report_file
   use atrito_files, only: file_exists, remove_file
   use atrito_messages, only: add_warning
   implicit none (type, external)
   private
   public :: REPORT_NAME, remove_report

   character(len=*), parameter :: REPORT_NAME = 'report.html'

contains

   !> Removes the report of an earlier run. One that stays is a warning.
   subroutine remove_report(folder)
      character(len=*), intent(in) :: folder        !< of the tables

      call remove_file(folder//'/'//REPORT_NAME)
      if (file_exists(folder//'/'//REPORT_NAME)) then
         call add_warning('W-REPORT', folder//'/'//REPORT_NAME//': the report of an earlier run cannot be removed')
      end if
   end subroutine remove_report

end module atrito_report_file
