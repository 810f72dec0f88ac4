!> `--report`: hands what a command found to the room that writes reports, with the words of the command.
module atrito_report_maker
   use atrito_console, only: reporter_of
   use atrito_command_line, only: command_t, fetch_arguments, output_folder
   use atrito_gnuplot, only: shell_quoted
   use atrito_listing, only: date_text
   use atrito_model, only: model_t
   use atrito_report, only: report_t
   use atrito_plot_files, only: REPORT_NAME
   use atrito_reporter, only: reporter_t, report_phase
   use atrito_results, only: history_t
   use atrito_run_report, only: report_of_run
   use atrito_strings, only: string_t, append_string
   use atrito_version, only: PROGRAM_NAME
   use atrito_write_report, only: write_report
   implicit none (type, external)
   private
   public :: make_run_report, make_report

contains

   !> The report of a run; its name is added to the files that were written.
   subroutine make_run_report(command, model, history, files, pictures)
      type(command_t), intent(in) :: command                   !< --report is given; its folder is read
      type(model_t), intent(in) :: model                       !< as solved
      type(history_t), intent(in) :: history                   !< with frames
      type(string_t), allocatable, intent(inout) :: files(:)   !< names without folder
      type(string_t), intent(in) :: pictures(:)                !< that were drawn
      type(report_t) :: report
      logical :: is_written

      call report_of_run(model, history, output_folder(command), files, pictures, report)
      call make_report(command, report, is_written)
      if (is_written) call append_string(files, REPORT_NAME)
   end subroutine make_run_report

   !> Writes a report, which knows everything but the command. A failure is a warning.
   subroutine make_report(command, report, is_written)
      type(command_t), intent(in) :: command     !< its folder and quietness are read
      type(report_t), intent(inout) :: report    !< gets the command
      logical, intent(out) :: is_written         !< else there is a warning
      type(string_t), allocatable :: arguments(:)
      type(reporter_t) :: reporter
      character(len=*), parameter :: PLAIN = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=.,:/%@'
      integer :: i

      reporter = reporter_of(command)
      call report_phase(reporter, 'report '//report%folder//'/'//REPORT_NAME)
      call fetch_arguments(arguments)
      ! The command as it can be given to a shell.
      report%command = PROGRAM_NAME
      do i = 1, size(arguments)
         if (len(arguments(i)%s) > 0 .and. verify(arguments(i)%s, PLAIN) == 0) then
            report%command = report%command//' '//arguments(i)%s
         else
            report%command = report%command//' '//shell_quoted(arguments(i)%s)
         end if
      end do
      call write_report(report, date_text(), is_written)
   end subroutine make_report

end module atrito_report_maker
