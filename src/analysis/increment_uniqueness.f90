!> What is known of other solutions of an increment, from the matrices of its contact line.
module atrito_increment_uniqueness
   use atrito_contact_solution, only: contact_solution_t
   use atrito_results, only: results_t
   use atrito_scene_data, only: scene_data_t
   use atrito_timers, only: start_phase, stop_phase
   use atrito_uniqueness, only: certify_line, certify_scene, judge_contraction, judge_solution
   implicit none (type, external)
   private
   public :: judge_uniqueness

contains

   !> Judges a solution, converged or not. What does not depend on the loads is found once for the matrices of the line. A solution
   !> of the sparse form has a certificate, and is judged where the dense one has been tried and has left its matrices.
   subroutine judge_uniqueness(data, solution, results)
      type(scene_data_t), intent(inout) :: data        !< certificate is made once for its matrices
      type(contact_solution_t), intent(in) :: solution !< of the increment
      type(results_t), intent(inout) :: results        !< get uniqueness and contraction_estimate

      if (.not. data%line%has_friction) return
      call start_phase('unique')
      if (.not. allocated(data%flexibility)) then
         if (.not. allocated(data%certificate)) then
            allocate (data%certificate)
            call certify_scene(data%fem, data%rows, data%line, data%starts > 0, data%certificate)
         end if
         results%uniqueness = data%certificate%known
      else
         if (.not. allocated(data%certificate)) then
            allocate (data%certificate)
            call certify_line(data%flexibility, data%line, data%starts > 0, data%certificate)
         end if
         results%uniqueness = data%certificate%known
         call judge_solution(data%flexibility, data%line, solution, data%is_last, data%certificate, results%uniqueness)
         if (data%is_printed) call judge_contraction(data%flexibility, data%line, solution, data%certificate, &
                                                     results%contraction_estimate)
      end if
      call stop_phase('unique')
   end subroutine judge_uniqueness

end module atrito_increment_uniqueness
