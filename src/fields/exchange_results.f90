!> What of the results goes into an archive, or comes out of it (atrito_archive): all of an increment, bit by bit.
module atrito_exchange_results
   use atrito_archive, only: archive_t
   use atrito_exchange, only: exchange, exchange_length, exchange_numbers, exchange_vector, exchange_word
   use atrito_kinds, only: ip
   use atrito_results, only: results_t, contact_result_t, unsettled_t, balance_t, body_motion_t, rigid_result_t, joint_t, &
                             cut_force_t, extreme_t, iteration_t, observed_t, body_result_t, pair_scene_t, scene_t, uniqueness_t, &
                             error_bound_t, quantity_bound_t
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: exchange_results, exchange_iterations

contains

   !> An increment: one part of the file.
   subroutine exchange_results(archive, results)
      type(archive_t), intent(inout) :: archive  !< with an open part, or spooled
      type(results_t), intent(inout) :: results  !< what is written or read, all components

      call exchange(archive, 'step', results%step)
      call exchange(archive, 'increment', results%increment)
      call exchange(archive, 'time', results%time)
      call exchange(archive, 'step_time', results%step_time)
      call exchange(archive, 'ends_step', results%ends_step)
      call exchange(archive, 'converged', results%converged)
      call exchange(archive, 'law_holds', results%law_holds)
      call exchange(archive, 'verdict', results%verdict)
      call exchange_scene(archive, results%scene)
      call exchange(archive, 'u', results%u)
      call exchange(archive, 'prescribed', results%prescribed)
      call exchange(archive, 'reaction', results%reaction)
      call exchange_contact(archive, results%contact)
      call exchange(archive, 'row_x', results%row_x)
      call exchange(archive, 'row_force', results%row_force)
      call exchange(archive, 'stress_element', results%stress_element)
      call exchange(archive, 'stress_point', results%stress_point)
      call exchange(archive, 'stress_x', results%stress_x)
      call exchange(archive, 'stress', results%stress)
      call exchange(archive, 'nodal_stress', results%nodal_stress)
      call exchange(archive, 'error_estimate', results%error_estimate)
      call exchange_bound(archive, results%error_bound)
      call exchange(archive, 'element_error', results%element_error)
      call exchange_iterations(archive, results%iterations)
      call exchange(archive, 'outer_iterations', results%outer_iterations)
      call exchange(archive, 'linear_solves', results%linear_solves)
      call exchange(archive, 'factorisations', results%factorisations)
      call exchange_unsettled(archive, results%unsettled)
      call exchange(archive, 'contraction', results%contraction)
      call exchange(archive, 'contraction_estimate', results%contraction_estimate)
      call exchange_uniqueness(archive, results%uniqueness)
      call exchange(archive, 'equilibrium_residual', results%equilibrium_residual)
      call exchange(archive, 'strain_energy', results%strain_energy)
      call exchange(archive, 'external_work', results%external_work)
      call exchange_extremes(archive, results%extremes)
      call exchange_extreme(archive, results%large_strain)
      call exchange_extreme(archive, results%large_rotation)
      call exchange_extreme(archive, results%large_slip)
      call exchange_balance(archive, results%balance)
      call exchange_motion(archive, results%bodies)
      call exchange_rigid(archive, results%rigid)
      call exchange_joint(archive, results%joints)
      call exchange_observed(archive, results%observed)
      call exchange_bounded(archive, results%bounded)
      call exchange_cut(archive, results%cuts)
   end subroutine exchange_results

   subroutine exchange_bound(archive, bound)
      type(archive_t), intent(inout) :: archive
      type(error_bound_t), intent(inout) :: bound

      call exchange(archive, 'exists', bound%exists)
      call exchange(archive, 'is_certified', bound%is_certified)
      call exchange(archive, 'is_of_polygon', bound%is_of_polygon)
      call exchange(archive, 'percent', bound%percent)
      call exchange(archive, 'norm', bound%norm)
      call exchange(archive, 'bulk', bound%bulk)
      call exchange(archive, 'normal', bound%normal)
      call exchange(archive, 'tangential', bound%tangential)
      call exchange(archive, 'residual', bound%residual)
      call exchange_word(archive, 'why_not', bound%why_not)
   end subroutine exchange_bound

   subroutine exchange_uniqueness(archive, uniqueness)
      type(archive_t), intent(inout) :: archive
      type(uniqueness_t), intent(inout) :: uniqueness

      call exchange(archive, 'nu', uniqueness%nu)
      call exchange(archive, 'up_to_nu', uniqueness%up_to_nu)
      call exchange(archive, 'same_way_up_to_nu', uniqueness%same_way_up_to_nu)
      call exchange(archive, 'index', uniqueness%index)
      call exchange(archive, 'starts', uniqueness%starts)
      call exchange(archive, 'solutions', uniqueness%solutions)
      call exchange_word(archive, 'why_not', uniqueness%why_not)
   end subroutine exchange_uniqueness

   subroutine exchange_contact(archive, list)
      type(archive_t), intent(inout) :: archive
      type(contact_result_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, 'contact', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         associate (contact => list(i))
            call exchange(archive, 'n', contact%n)
            call exchange(archive, 's', contact%s)
            call exchange(archive, 'x', contact%x)
            call exchange(archive, 'normal', contact%normal)
            call exchange(archive, 'u', contact%u)
            call exchange(archive, 'gap', contact%gap)
            call exchange(archive, 'pressure', contact%pressure)
            call exchange(archive, 'weighted_pressure', contact%weighted_pressure)
            call exchange(archive, 'shear', contact%shear)
            call exchange(archive, 'slip', contact%slip)
            call exchange(archive, 'slip_increment', contact%slip_increment)
            call exchange(archive, 'status', contact%status)
            call exchange(archive, 'weight', contact%weight)
            call exchange(archive, 'joint', contact%joint)
            call exchange(archive, 'follows', contact%follows)
            call exchange(archive, 's_end', contact%s_end)
            call exchange(archive, 'has_friction', contact%has_friction)
         end associate
      end do
   end subroutine exchange_contact

   subroutine exchange_unsettled(archive, list)
      type(archive_t), intent(inout) :: archive
      type(unsettled_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, 'unsettled', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         associate (point => list(i))
            call exchange(archive, 'pair', point%pair)
            call exchange(archive, 'point', point%point)
            call exchange(archive, 'node', point%node)
            call exchange_vector(archive, 'x', point%x)
            call exchange_word(archive, 'states', point%states)
         end associate
      end do
   end subroutine exchange_unsettled

   subroutine exchange_motion(archive, list)
      type(archive_t), intent(inout) :: archive
      type(body_motion_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, 'bodies', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         associate (body => list(i))
            call exchange(archive, 'name', body%name)
            call exchange_vector(archive, 'centre', body%centre)
            call exchange(archive, 'size', body%size)
            call exchange_vector(archive, 'u', body%u)
            call exchange(archive, 'rotation', body%rotation)
            call exchange_vector(archive, 'loads', body%loads)
            call exchange_vector(archive, 'supports', body%supports)
            call exchange_vector(archive, 'contact', body%contact)
            call exchange_vector(archive, 'terms', body%terms)
         end associate
      end do
   end subroutine exchange_motion

   subroutine exchange_rigid(archive, list)
      type(archive_t), intent(inout) :: archive
      type(rigid_result_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i
      integer :: k

      call exchange_length(archive, 'rigid', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         associate (body => list(i))
            call exchange(archive, 'name', body%name)
            call exchange(archive, 'node', body%node)
            call exchange(archive, 'size', body%size)
            call exchange(archive, 'is_section', body%is_section)
            call exchange(archive, 'force', body%force)
            do k = 1, size(body%is_prescribed)
               call exchange(archive, 'is_prescribed', body%is_prescribed(k))
            end do
            do k = 1, size(body%has_reaction)
               call exchange(archive, 'has_reaction', body%has_reaction(k))
            end do
            call exchange_vector(archive, 'u', body%u)
            call exchange(archive, 'rotation', body%rotation)
            call exchange_vector(archive, 'reaction', body%reaction)
            call exchange(archive, 'moment', body%moment)
         end associate
      end do
   end subroutine exchange_rigid

   subroutine exchange_joint(archive, list)
      type(archive_t), intent(inout) :: archive
      type(joint_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, 'joints', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         associate (joint => list(i))
            call exchange(archive, 'pair', joint%pair)
            call exchange(archive, 'bodies', joint%bodies(1))
            call exchange(archive, 'bodies', joint%bodies(2))
            call exchange(archive, 'n', joint%n)
            call exchange(archive, 't', joint%t)
            call exchange(archive, 'm', joint%m)
            call exchange_vector(archive, 'place', joint%place)
            call exchange(archive, 'opening', joint%opening)
            call exchange(archive, 'sliding', joint%sliding)
            call exchange(archive, 'force', joint%force)
            call exchange(archive, 'length', joint%length)
            call exchange_vector(archive, 'u', joint%u)
         end associate
      end do
   end subroutine exchange_joint

   subroutine exchange_observed(archive, list)
      type(archive_t), intent(inout) :: archive
      type(observed_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, 'observed', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange_word(archive, 'name', list(i)%name)
         call exchange(archive, 'value', list(i)%value)
      end do
   end subroutine exchange_observed

   subroutine exchange_bounded(archive, list)
      type(archive_t), intent(inout) :: archive
      type(quantity_bound_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, 'bounded', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         associate (bound => list(i))
            call exchange_word(archive, 'name', bound%name)
            call exchange(archive, 'exists', bound%exists)
            call exchange(archive, 'is_certified', bound%is_certified)
            call exchange(archive, 'is_of_states', bound%is_of_states)
            call exchange(archive, 'is_of_friction', bound%is_of_friction)
            call exchange(archive, 'least', bound%least)
            call exchange(archive, 'most', bound%most)
            call exchange_word(archive, 'why_not', bound%why_not)
         end associate
      end do
   end subroutine exchange_bounded

   subroutine exchange_cut(archive, list)
      type(archive_t), intent(inout) :: archive
      type(cut_force_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, 'cuts', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         associate (cut => list(i))
            call exchange(archive, 'name', cut%name)
            call exchange_vector(archive, 'middle', cut%middle)
            call exchange(archive, 'length', cut%length)
            call exchange(archive, 'n', cut%n)
            call exchange(archive, 'v', cut%v)
            call exchange(archive, 'm', cut%m)
            call exchange_vector(archive, 'terms', cut%terms)
         end associate
      end do
   end subroutine exchange_cut

   !> The log of iterations, column by column: there may be thousands, in every file.
   subroutine exchange_iterations(archive, list)
      type(archive_t), intent(inout) :: archive                !< with an open part, or spooled
      type(iteration_t), allocatable, intent(inout) :: list(:) !< what is written; read: not allocated on entry
      integer(ip) :: n

      call exchange_length(archive, 'iterations', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      if (n < 0) return
      call exchange_numbers(archive, 'step', list%step)
      call exchange_numbers(archive, 'increment', list%increment)
      call exchange_numbers(archive, 'outer', list%outer)
      call exchange_numbers(archive, 'inner', list%inner)
      call exchange_vector(archive, 'change_displacement', list%change_displacement)
      call exchange_vector(archive, 'change_pressure', list%change_pressure)
      call exchange_vector(archive, 'change_friction', list%change_friction)
      call exchange_numbers(archive, 'open', list%open)
      call exchange_numbers(archive, 'stick', list%stick)
      call exchange_numbers(archive, 'slip', list%slip)
      call exchange_vector(archive, 'residual', list%residual)
   end subroutine exchange_iterations

   subroutine exchange_extremes(archive, list)
      type(archive_t), intent(inout) :: archive
      type(extreme_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, 'extremes', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange_extreme(archive, list(i))
      end do
   end subroutine exchange_extremes

   subroutine exchange_extreme(archive, extreme)
      type(archive_t), intent(inout) :: archive
      type(extreme_t), intent(inout) :: extreme

      call exchange(archive, 'value', extreme%value)
      call exchange(archive, 'id', extreme%id)
      call exchange_vector(archive, 'x', extreme%x)
      call exchange(archive, 'is_node', extreme%is_node)
      call exchange_word(archive, 'quantity', extreme%quantity)
   end subroutine exchange_extreme

   subroutine exchange_balance(archive, balance)
      type(archive_t), intent(inout) :: archive
      type(balance_t), intent(inout) :: balance

      call exchange_vector(archive, 'applied', balance%applied(:2))
      call exchange_vector(archive, 'reactions', balance%reactions(:2))
      call exchange(archive, 'applied_moment', balance%applied(3))
      call exchange(archive, 'reaction_moment', balance%reactions(3))
      call exchange_vector(archive, 'rigid', balance%rigid(:2))
      call exchange(archive, 'rigid_moment', balance%rigid(3))
      call exchange(archive, 'is_revolved', balance%is_revolved)
      call exchange_vector(archive, 'rows', balance%rows(:2))
      call exchange(archive, 'rows_moment', balance%rows(3))
   end subroutine exchange_balance

   subroutine exchange_scene(archive, scene)
      type(archive_t), intent(inout) :: archive
      type(scene_t), intent(inout) :: scene

      call exchange_bodies(archive, scene%bodies)
      call exchange_pairs(archive, scene%pairs)
      call exchange(archive, 'n_dofs', scene%n_dofs)
      call exchange(archive, 'n_normal', scene%n_normal)
      call exchange(archive, 'n_tangential', scene%n_tangential)
      call exchange(archive, 'n_rows', scene%n_rows)
      call exchange(archive, 'n_rigid', scene%n_rigid)
      call exchange(archive, 'outer_loop', scene%outer_loop)
      call exchange(archive, 'near_elements', scene%near_elements)
      call exchange(archive, 'contact_form', scene%contact_form)
      call exchange(archive, 'contact_reason', scene%contact_reason)
      call exchange(archive, 'order', scene%order)
      call exchange(archive, 'memory', scene%memory)
      call exchange(archive, 'memory_before', scene%memory_before)
      call exchange(archive, 'peak_before', scene%peak_before)
      call exchange(archive, 'solving', scene%solving)
      call exchange_left_out(archive, scene%left_out)
   end subroutine exchange_scene

   subroutine exchange_bodies(archive, list)
      type(archive_t), intent(inout) :: archive
      type(body_result_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, 'bodies', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         associate (body => list(i))
            call exchange(archive, 'name', body%name)
            call exchange(archive, 'n_nodes', body%n_nodes)
            call exchange(archive, 'n_elements', body%n_elements)
            call exchange(archive, 'n_equations', body%n_equations)
            call exchange(archive, 'n_contact_equations', body%n_contact_equations)
            call exchange(archive, 'n_free_motions', body%n_free_motions)
            call exchange(archive, 'solver_kind', body%solver_kind)
            call exchange(archive, 'solver', body%solver)
            call exchange(archive, 'reason', body%reason)
            call exchange(archive, 'order', body%order)
            call exchange(archive, 'profile', body%profile)
            call exchange(archive, 'memory', body%memory)
            call exchange(archive, 'most_memory', body%most_memory)
            call exchange(archive, 'half_bandwidth', body%half_bandwidth)
            call exchange(archive, 'digits_lost', body%digits_lost)
            call exchange(archive, 'worst_node', body%worst_node)
            call exchange(archive, 'worst_dof', body%worst_dof)
            call exchange(archive, 'sign_changes', body%sign_changes)
            call exchange(archive, 'n_fronts', body%n_fronts)
            call exchange(archive, 'n_different_fronts', body%n_different_fronts)
         end associate
      end do
   end subroutine exchange_bodies

   subroutine exchange_pairs(archive, list)
      type(archive_t), intent(inout) :: archive
      type(pair_scene_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, 'pairs', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         associate (pair => list(i))
            call exchange(archive, 'slave', pair%slave)
            call exchange(archive, 'master', pair%master)
            call exchange(archive, 'interaction', pair%interaction)
            call exchange(archive, 'n_points', pair%n_points)
            call exchange(archive, 'n_left_out', pair%n_left_out)
            call exchange(archive, 'matching', pair%matching)
            call exchange(archive, 'master_is_rigid', pair%master_is_rigid)
            call exchange(archive, 'least_gap', pair%least_gap)
            call exchange(archive, 'greatest_gap', pair%greatest_gap)
            call exchange(archive, 'least_node', pair%least_node)
            call exchange(archive, 'greatest_node', pair%greatest_node)
            call exchange_vector(archive, 'least_x', pair%least_x)
            call exchange_vector(archive, 'greatest_x', pair%greatest_x)
         end associate
      end do
   end subroutine exchange_pairs

   subroutine exchange_left_out(archive, list)
      type(archive_t), intent(inout) :: archive
      type(string_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, 'left_out', n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange(archive, 'left_out', list(i)%s)
      end do
   end subroutine exchange_left_out

end module atrito_exchange_results
