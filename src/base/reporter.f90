!> Progress of a run, reported on standard error unless --quiet.
module atrito_reporter
   use, intrinsic :: iso_fortran_env, only: error_unit
   use atrito_utf8, only: visible
   implicit none (type, external)
   private
   public :: reporter_t, report_progress

   type :: reporter_t
      logical :: quiet = .false.
   end type reporter_t

contains

   !> One line of progress.
   subroutine report_progress(reporter, text)
      type(reporter_t), intent(in) :: reporter
      character(len=*), intent(in) :: text
      integer :: ignored

      if (reporter%quiet) return
      write (error_unit, '(a)', iostat=ignored) visible(text)
      flush (error_unit, iostat=ignored)             ! a file is watched, too
   end subroutine report_progress

end module atrito_reporter
