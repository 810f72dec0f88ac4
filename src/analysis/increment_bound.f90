!> The bound of the error of an increment (atrito_error_bound).
module atrito_increment_bound
   use atrito_body_cache, only: body_cache_t
   use atrito_bounded_quantities, only: bound_quantities
   use atrito_contact_form, only: CONTACT_DENSE
   use atrito_contact_solution, only: contact_solution_t
   use atrito_error_bound, only: bound_error, is_tried_twice
   use atrito_exchanged_tractions, only: exchange_with_factors
   use atrito_model, only: step_t
   use atrito_reporter, only: report_progress
   use atrito_results, only: results_t
   use atrito_scene_data, only: scene_data_t, PROOF_AUTO, PROOF_ON
   use atrito_step_loads, only: act_at, moment_t
   use atrito_timers, only: start_phase, stop_phase
   implicit none (type, external)
   private
   public :: prepare_bound, prove_bound

contains

   !> What the bound wants of the factors of the bodies, while they are there.
   subroutine prepare_bound(data, form, store, solution, results)
      type(scene_data_t), intent(inout) :: data             !< exchanged is made, where the bound is wanted
      integer, intent(in) :: form                           !< CONTACT_*, that the solution was found by
      type(body_cache_t), intent(inout) :: store            !< with factors of the bodies
      type(contact_solution_t), intent(in) :: solution      !< of the increment
      type(results_t), intent(in) :: results                !< when

      call forget(data)
      if (.not. is_wanted(data, results) .or. form /= CONTACT_DENSE .or. .not. solution%converged) return
      call exchange_with_factors(data%model, data, solution, .true., store%bodies, data%exchanged)
      if (.not. (allocated(data%exchanged) .and. is_tried_twice(data))) return
      call exchange_with_factors(data%model, data, solution, .false., store%bodies, data%exchanged_by_points)
   end subroutine prepare_bound

   !> The bound of a solution that has passed its check, with the loads of its time.
   subroutine prove_bound(data, solution, results)
      type(scene_data_t), intent(inout) :: data             !< exchanged goes
      type(contact_solution_t), intent(in) :: solution      !< of the increment
      type(results_t), intent(inout) :: results             !< checked; get error_bound
      type(step_t) :: acting

      if (.not. (results%converged .and. results%law_holds)) return
      if (data%is_distributed .and. allocated(data%quantities)) call bound_quantities(data, acting, solution, results)
      if (.not. is_wanted(data, results)) return
      call start_phase('prove')
      call report_progress(data%reporter, 'bound of the error')
      call act_at(data%model, data%step, moment_t(results%step_time, results%time), acting)
      call bound_error(data%model, acting, data, solution, data%exchanged, data%exchanged_by_points, data%proof == PROOF_AUTO, &
                       results)
      if (allocated(data%quantities)) call bound_quantities(data, acting, solution, results)
      call forget(data)
      call stop_phase('prove')
   end subroutine prove_bound

   subroutine forget(data)
      type(scene_data_t), intent(inout) :: data

      if (allocated(data%exchanged)) deallocate (data%exchanged)
      if (allocated(data%exchanged_by_points)) deallocate (data%exchanged_by_points)
   end subroutine forget

   !> Whether a solution gets a bound of its error: without being asked for it at the ends of steps alone, since the increments of a
   !> history that use the same factors take less time than a bound.
   pure logical function is_wanted(data, results)
      type(scene_data_t), intent(in) :: data
      type(results_t), intent(in) :: results

      is_wanted = data%is_printed .and. .not. data%is_distributed .and. &
                  (data%proof == PROOF_ON .or. (data%proof == PROOF_AUTO .and. results%ends_step))
   end function is_wanted

end module atrito_increment_bound
