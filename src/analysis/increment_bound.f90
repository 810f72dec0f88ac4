!> The bound of the error of an increment (atrito_error_bound).
module atrito_increment_bound
   use atrito_body_cache, only: body_cache_t
   use atrito_bounded_quantities, only: bound_quantities
   use atrito_contact_form, only: CONTACT_DENSE
   use atrito_contact_solution, only: contact_solution_t
   use atrito_error_bound, only: bound_error
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
      type(scene_data_t), intent(inout) :: data
      integer, intent(in) :: form                           !< CONTACT_*, that the solution was found by
      type(body_cache_t), intent(inout) :: store
      type(contact_solution_t), intent(in) :: solution
      type(results_t), intent(in) :: results                !< when

      if (allocated(data%exchanged)) deallocate (data%exchanged)
      if (.not. is_wanted(data, results) .or. form /= CONTACT_DENSE .or. .not. solution%converged) return
      call exchange_with_factors(data%model, data, solution, store%bodies, data%exchanged)
   end subroutine prepare_bound

   !> The bound of a solution that has passed its check, with the loads of its time.
   subroutine prove_bound(data, solution, results)
      type(scene_data_t), intent(inout) :: data
      type(contact_solution_t), intent(in) :: solution
      type(results_t), intent(inout) :: results
      type(step_t) :: acting

      if (.not. (results%converged .and. results%law_holds)) return
      if (data%is_distributed .and. allocated(data%quantities)) call bound_quantities(data, acting, solution, results)
      if (.not. is_wanted(data, results)) return
      call start_phase('prove')
      call report_progress(data%reporter, 'bound of the error')
      call act_at(data%model, data%step, moment_t(results%step_time, results%time), acting)
      call bound_error(data%model, acting, data, solution, data%exchanged, data%proof == PROOF_AUTO, results)
      if (allocated(data%quantities)) call bound_quantities(data, acting, solution, results)
      if (allocated(data%exchanged)) deallocate (data%exchanged)
      call stop_phase('prove')
   end subroutine prove_bound

   !> Whether a solution gets a bound of its error: without being asked for it at the ends of steps alone, since the increments of a
   !> history that use the same factors take less time than a bound.
   pure logical function is_wanted(data, results)
      type(scene_data_t), intent(in) :: data
      type(results_t), intent(in) :: results

      is_wanted = data%is_printed .and. .not. data%is_distributed .and. &
                  (data%proof == PROOF_ON .or. (data%proof == PROOF_AUTO .and. results%ends_step))
   end function is_wanted

end module atrito_increment_bound
