!> The search for other solutions of an increment: what Newton's method finds on the contact line becomes results of its own, and
!> counts where the final check passes it.
module atrito_solution_search
   use atrito_body_cache, only: body_cache_t
   use atrito_contact_form, only: CONTACT_DENSE
   use atrito_contact_scales, only: had_t, widen
   use atrito_contact_solution, only: contact_solution_t
   use atrito_increment, only: begin_results, finish_form, is_solved
   use atrito_kinds, only: ip, wp
   use atrito_other_solutions, only: find_others
   use atrito_reporter, only: report_progress
   use atrito_results, only: results_t
   use atrito_scene_data, only: scene_data_t
   use atrito_solve_condensed, only: expand_solution
   use atrito_status, only: status_t
   use atrito_strings, only: to_text
   use atrito_timers, only: start_phase, stop_phase
   use atrito_uniqueness, only: is_certified, judge_solution
   implicit none (type, external)
   private
   public :: search_solutions

contains

   !> Searches from data%starts starts. The numbers of both go into the results. Where the dense form was not tried there is nothing
   !> to search with, and where one solution is certified there is nothing to search for.
   subroutine search_solutions(data, store, first, results, others)
      type(scene_data_t), intent(inout) :: data             !< with C and G
      type(body_cache_t), intent(inout) :: store            !< with the bodies
      type(contact_solution_t), intent(in) :: first         !< from which the others are told apart
      type(results_t), intent(inout) :: results             !< of it
      type(results_t), allocatable, intent(out) :: others(:) !< each passed its check; without stresses
      type(contact_solution_t), allocatable :: found(:)
      type(results_t), allocatable :: list(:)
      type(had_t) :: had
      real(wp), allocatable :: u(:, :)
      type(status_t) :: status
      integer(ip) :: i, n

      allocate (others(0))
      if (data%starts == 0) return
      if (.not. (allocated(data%flexibility) .and. data%line%has_friction)) then
         if (data%line%has_friction .and. .not. results%uniqueness%up_to_nu > 0.0_wp) then
            results%uniqueness%why_not = 'no search either, the sparse form has no matrix'
         end if
         results%uniqueness%starts = data%starts
         return
      end if
      allocate (found(0))
      if (.not. is_certified(results%uniqueness)) then
         call start_phase('search')
         call find_others(data%flexibility, data%line, data%step%controls, first, data%starts, found)
         call stop_phase('search')
      end if
      allocate (list(size(found)))
      had = data%had                                        ! what is rounding beside the first is so in all
      call widen(data%had, first%body_motion, first%body_force)
      n = 0
      do i = 1, size(found, kind=ip)
         associate (other => list(n + 1))
            call begin_results(results, other)
            other%uniqueness = results%uniqueness
            call judge_solution(data%flexibility, data%line, found(i), .false., data%certificate, other%uniqueness)
            found(i)%form = CONTACT_DENSE
            call expand_solution(data, data%step%controls, store, other%scene, found(i), u)
            call finish_form(data, data%step%controls, found(i), u, other, status)
            if (is_solved(other, status)) n = n + 1
         end associate
      end do
      data%had = had
      others = list(:n)
      results%uniqueness%starts = data%starts
      results%uniqueness%solutions = n + 1
      others%uniqueness%starts = data%starts
      others%uniqueness%solutions = n + 1
      call report_progress(data%reporter, 'search '//to_text(data%starts)//' starts, '//to_text(n)//' other solutions')
   end subroutine search_solutions

end module atrito_solution_search
