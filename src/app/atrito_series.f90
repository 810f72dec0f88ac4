!> What sweeps, studies and limits have in common: they claim their folder for all of their runs, write tables, draw, and tell it.
module atrito_series
   use, intrinsic :: iso_fortran_env, only: output_unit
   use atrito_command_line, only: command_t, output_folder
   use atrito_console, only: print_messages, print_status
   use atrito_files, only: check_folder
   use atrito_folder_claim, only: folder_claim_t, claim_folder
   use atrito_kinds, only: ip, lp, wp
   use atrito_messages, only: clear_messages
   use atrito_page, only: page_t, print_page
   use atrito_plot_files, only: remove_plots
   use atrito_status, only: status_t, is_ok
   use atrito_table, only: origin_t
   use atrito_system, only: processor_seconds
   implicit none (type, external)
   private
   public :: claim_output, series_origin, begin_pictures, tell_series, seconds_since

contains

   !> Claims the folder of the command; two at once would leave runs of both. A failure, also an earlier one, is told.
   subroutine claim_output(command, claim, status)
      type(command_t), intent(in) :: command
      type(folder_claim_t), intent(out) :: claim
      type(status_t), intent(inout) :: status       !< of what came before; STATUS_FILE

      if (is_ok(status)) call check_folder(output_folder(command), status)
      if (is_ok(status)) call claim_folder(output_folder(command), claim, status)
      if (.not. is_ok(status)) call print_status(status, command%names(1)%s)
   end subroutine claim_output

   !> The comment lines at the top of the tables.
   pure function series_origin(command, not_converged) result(origin)
      type(command_t), intent(in) :: command
      logical, intent(in) :: not_converged
      type(origin_t) :: origin

      origin%deck = command%names(1)%s(index(command%names(1)%s, '/', back=.true.) + 1:)
      origin%not_converged = not_converged
      allocate (origin%heading(0))
   end function series_origin

   !> The pictures of an earlier time go, drawn anew or not, for the tables are new.
   subroutine begin_pictures(command)
      type(command_t), intent(in) :: command

      call clear_messages()
      call remove_plots(output_folder(command))
   end subroutine begin_pictures

   !> Prints the closing lines.
   subroutine tell_series(command, page)
      type(command_t), intent(in) :: command
      type(page_t), intent(in) :: page

      call print_messages(command%quiet, 1_ip)
      if (.not. command%quiet) call print_page(page, output_unit)
   end subroutine tell_series

   !> Wall clock since a count of system_clock, and processor time of the process.
   function seconds_since(began) result(seconds)
      integer(lp), intent(in) :: began
      real(wp) :: seconds(2)
      integer(lp) :: ended, rate

      call system_clock(ended, rate)
      seconds = [real(ended - began, wp)/real(rate, wp), processor_seconds()]
   end function seconds_since

end module atrito_series
