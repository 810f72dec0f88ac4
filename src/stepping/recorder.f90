!> Who is told of converged increments while a history is solved, and may have it begin behind one of them: what writes and reads
!> restart files is not known here.
module atrito_recorder
   use atrito_kinds, only: ip
   use atrito_restart_state, only: restart_state_t
   use atrito_results, only: history_t
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: recorder_t

   type, abstract :: recorder_t
      integer(ip) :: every = 0                       !< so many increments, and the ends of steps, are recorded; 0: none
      logical :: resumes = .false.                   !< the history goes on behind `state`; `found` is what was found before
      type(restart_state_t) :: state                 !< behind the last increment that was recorded
      type(history_t) :: found                       !< until then
      character(len=:), allocatable :: source        !< where both come from, for messages
      type(string_t), allocatable :: observed(:)     !< names of what is observed; not allocated: nothing
   contains
      procedure(record_increment), deferred :: record
   end type recorder_t

   abstract interface
      !> An increment has converged: all that was found so far, and the state behind it. Neither is changed.
      subroutine record_increment(self, history, state)
         import :: recorder_t, history_t, restart_state_t
         class(recorder_t), intent(inout) :: self      !< notes what it records
         type(history_t), intent(inout) :: history     !< all increments so far
         type(restart_state_t), intent(inout) :: state !< behind the last of them
      end subroutine record_increment
   end interface

end module atrito_recorder
