!> How an iteration on the friction bound comes along: what the Picard loop and the loop of the multipliers have in common.
!>
!> Both stop when their residual is small enough; both must see when it does not get smaller any more, since round-off is all that
!> is left of it, or since nothing comes of it. The measure is the last iteration that halved the best residual so far.
module atrito_loop_progress
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_solve_history, only: solve_history_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: loop_progress_t, note_residual, report_step

   type :: loop_progress_t
      real(wp) :: best = HUGE_REAL                   !< residual of best_outer
      integer(ip) :: best_outer = 0                  !< the last iteration that halved the best residual
   end type loop_progress_t

contains

   !> An iteration has this residual.
   !>
   !> Halving, and not any decrease, is asked for: a residual that is round-off still falls now and then.
   pure subroutine note_residual(progress, outer, residual)
      type(loop_progress_t), intent(inout) :: progress !< best residual so far, and where
      integer(ip), intent(in) :: outer               !< its number
      real(wp), intent(in) :: residual               !< relative, >= 0

      if (.not. residual < 0.5_wp*progress%best) return   ! a NaN is no progress
      progress%best = residual
      progress%best_outer = outer
   end subroutine note_residual

   !> One line an iteration: its number, linear solves, states of the points, and what the loop has to say besides.
   subroutine report_step(reporter, word, outer, history, more, rest)
      type(reporter_t), intent(in) :: reporter !< a line an iteration
      character(len=*), intent(in) :: word           !< outer, step
      integer(ip), intent(in) :: outer               !< number of the iteration
      type(solve_history_t), intent(in) :: history   !< with the solves of the iteration
      character(len=*), intent(in) :: more, rest     !< behind the solves; behind the states

      associate (record => history%records(history%n))
         call report_progress(reporter, word//' '//to_text(outer)//'  solves '//to_text(record%inner)//more//'  open ' &
                              //to_text(record%open)//'  stick '//to_text(record%stick)//'  slip '//to_text(record%slip)//rest)
      end associate
   end subroutine report_step

end module atrito_loop_progress
