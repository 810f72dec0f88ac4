!> Progress of a run on standard error: one line that is rewritten at a terminal, elsewhere a line a phase, or every iteration.
module atrito_reporter
   use, intrinsic :: iso_c_binding, only: c_int, c_null_char
   use, intrinsic :: iso_fortran_env, only: error_unit
   use atrito_system, only: c_begin_line, c_set_line
   use atrito_utf8, only: visible
   implicit none (type, external)
   private
   public :: reporter_t, report_progress, report_phase, report_place, begin_line
   public :: PROGRESS_ALL, PROGRESS_PHASES, PROGRESS_LINE

   integer, parameter :: PROGRESS_ALL = 0, PROGRESS_PHASES = 1, PROGRESS_LINE = 2

   type :: reporter_t
      logical :: quiet = .false.                    !< nothing is written
      integer :: form = PROGRESS_ALL                !< one of PROGRESS_...
   end type reporter_t

contains

   !> From now on progress is one line of the terminal, where the system has a thread for it.
   subroutine begin_line(reporter)
      type(reporter_t), intent(inout) :: reporter !< `form` is set

      reporter%form = merge(PROGRESS_LINE, PROGRESS_PHASES, c_begin_line() == 1)
   end subroutine begin_line

   !> What is being done: an iteration, a body.
   subroutine report_progress(reporter, text)
      type(reporter_t), intent(in) :: reporter !< quiet, or how much is written
      character(len=*), intent(in) :: text     !< one line, without indentation

      call report(reporter, text, is_place=.false., is_line=reporter%form == PROGRESS_ALL)
   end subroutine report_progress

   !> A phase begins: reading, writing, a run of many.
   subroutine report_phase(reporter, text)
      type(reporter_t), intent(in) :: reporter !< quiet, or how much is written
      character(len=*), intent(in) :: text     !< one line, without indentation

      call report(reporter, text, is_place=.true., is_line=.true.)
   end subroutine report_phase

   !> Where the run is; with a line for each iteration it has none of its own.
   subroutine report_place(reporter, text, is_phase)
      type(reporter_t), intent(in) :: reporter      !< quiet, or how much is written
      character(len=*), intent(in) :: text          !< one line, without indentation
      logical, intent(in) :: is_phase               !< new enough for a line of its own

      call report(reporter, text, is_place=.true., is_line=is_phase .and. reporter%form == PROGRESS_PHASES)
   end subroutine report_place

   subroutine report(reporter, text, is_place, is_line)
      type(reporter_t), intent(in) :: reporter
      character(len=*), intent(in) :: text
      logical, intent(in) :: is_place, is_line
      integer :: ignored

      if (reporter%quiet) return
      if (reporter%form == PROGRESS_LINE) then
         call c_set_line(merge(1_c_int, 0_c_int, is_place), visible(text)//c_null_char)
      else if (is_line) then
         write (error_unit, '(a)', iostat=ignored) visible(text)
         flush (error_unit, iostat=ignored)         ! a file is watched, too
      end if
   end subroutine report

end module atrito_reporter
