!> The bound of the error of an increment (atrito_error_bound).
module atrito_increment_bound
   use atrito_balanced_contact, only: balanced_segments
   use atrito_body_cache, only: body_cache_t
   use atrito_contact_form, only: CONTACT_DENSE
   use atrito_contact_segments, only: segment_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_dual_scene, only: make_dual
   use atrito_error_bound, only: bound_error, is_tried_twice, check_hypotheses
   use atrito_exchanged_tractions, only: exchange_with_factors, exchange
   use atrito_joined_sides, only: find_joints, misfit_of_joints
   use atrito_kinds, only: wp
   use atrito_linear_quantity, only: quantity_bound_t, POTENTIAL_ENERGY
   use atrito_model, only: step_t
   use atrito_proof_loads, only: take_loads
   use atrito_quantity_bound, only: begin_common, bound_between, bound_potential, common_t, find_stress, has_digits, held_scene_t
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

   !> results%bounded: the bounds of data%quantities, or why there are none.
   subroutine bound_quantities(data, acting, solution, results)
      type(scene_data_t), intent(inout) :: data
      type(step_t), intent(in) :: acting            !< with the loads of the time
      type(contact_solution_t), intent(in) :: solution
      type(results_t), intent(inout) :: results     !< with displacements and reactions
      type(common_t) :: both
      type(held_scene_t) :: primal, dual
      type(segment_t), allocatable :: balanced(:)
      character(len=:), allocatable :: why_not, why_this
      integer :: i
      real(wp), allocatable :: u_of_loads(:, :)

      allocate (results%bounded(size(data%quantities)))
      call check_hypotheses(data, results%u, why_not)
      if (data%rows%n_bilateral > 0) why_not = 'ties, equations, springs or inclined supports'
      if (data%is_distributed) why_not = 'a scene over several processes: --share none'
      if (.not. allocated(why_not)) call find_primal(data, acting, solution, results, both, primal, balanced, why_not)
      do i = 1, size(data%quantities)
         associate (bound => results%bounded(i))
            bound%name = data%quantities(i)%name
            bound%is_of_states = size(primal%segments) > 0
            if (allocated(why_this)) deallocate (why_this)
            if (allocated(why_not)) then
               why_this = why_not
            else if (bound%name == POTENTIAL_ENERGY) then
               call bound_energy(data, primal, balanced, bound, why_this)
            else
               call make_dual(data, acting%prescribed, data%quantities(i), both, primal%segments, dual, u_of_loads, bound%least, &
                              why_this)
               if (.not. allocated(why_this)) call find_stress(both, u_of_loads, dual, why_this)
               if (.not. allocated(why_this)) call bound_between(both, primal, dual, bound, why_this)
            end if
            if (allocated(why_this)) bound%why_not = why_this
         end associate
      end do
   end subroutine bound_quantities

   !> The scene that is solved, with its stress in equilibrium.
   subroutine find_primal(data, acting, solution, results, both, primal, balanced, why_not)
      type(scene_data_t), intent(inout) :: data
      type(step_t), intent(in) :: acting
      type(contact_solution_t), intent(in) :: solution
      type(results_t), intent(in) :: results
      type(common_t), intent(inout) :: both
      type(held_scene_t), intent(inout) :: primal
      type(segment_t), allocatable, intent(out) :: balanced(:) !< with the tractions and the friction bound of the proof
      character(len=:), allocatable, intent(inout) :: why_not
      real(wp), parameter :: NO_JUMP = 1.0e-9_wp
      real(wp), allocatable :: no_joints(:)

      call balanced_segments(data%model, data, solution, .true., primal%segments, no_joints, why_not)
      if (allocated(why_not)) return
      balanced = primal%segments
      call find_joints(data, solution, primal%segments, both%joints, why_not)
      if (allocated(why_not)) return
      primal%fem = data%fem
      primal%f = data%f
      primal%u = results%u
      if (misfit_of_joints(both%joints, primal%segments, primal%u) > NO_JUMP*maxval(abs(primal%u))) then
         why_not = 'joined sides with a gap that is not linear'
         return
      end if
      call begin_common(data%fem, both)
      call take_loads(data%model, acting, data%fem, both%sides, both%degree, data%held, results%reaction, primal%loads, why_not)
      if (.not. (allocated(why_not) .or. allocated(data%exchanged))) then
         call exchange(data, solution, primal%segments, no_joints, data%exchanged, why_not)
      end if
      if (.not. allocated(why_not)) call find_stress(both, primal%u + data%exchanged, primal, why_not)
   end subroutine find_primal

   !> Bounds of the potential energy: no states are held.
   subroutine bound_energy(data, primal, balanced, bound, why_not)
      type(scene_data_t), intent(in) :: data
      type(held_scene_t), intent(in) :: primal
      type(segment_t), intent(in) :: balanced(:)
      type(quantity_bound_t), intent(inout) :: bound
      character(len=:), allocatable, intent(inout) :: why_not
      real(wp), parameter :: ROUND_OFF = 1.0e-13_wp
      real(wp) :: lost
      logical :: overlaps

      call bound_potential(balanced, primal%u, sum(data%f*primal%u), primal%of_displacements, sum(primal%outlines%energy), &
                           bound%least, bound%most, overlaps)
      if (overlaps) then
         why_not = 'sides without delta overlap between their nodes'
         return
      end if
      lost = ROUND_OFF*(primal%of_displacements + sum(abs(data%f*primal%u)))
      bound%least = bound%least - lost
      bound%most = bound%most + lost
      bound%exists = .true.
      bound%is_of_states = .false.
      bound%is_of_friction = data%line%has_friction
      bound%is_certified = has_digits(primal)
      if (.not. bound%is_certified) bound%why_not = 'round-off of the equilibrium'
   end subroutine bound_energy

end module atrito_increment_bound
