!> What of the results goes into an archive, or comes out of it (atrito_archive): all of an increment, bit by bit.
module atrito_exchange_results
   use atrito_archive, only: archive_t, exchange, exchange_vector, exchange_numbers, exchange_word, exchange_length
   use atrito_exchange_scene, only: exchange_scene
   use atrito_kinds, only: ip
   use atrito_results, only: results_t, contact_result_t, unsettled_t, balance_t, body_motion_t, rigid_result_t, joint_t, &
                             cut_force_t, extreme_t, iteration_t, observed_t
   implicit none (type, external)
   private
   public :: exchange_results, exchange_iteration_list

contains

   !> An increment: one part of the file.
   subroutine exchange_results(archive, results)
      type(archive_t), intent(inout) :: archive
      type(results_t), intent(inout) :: results

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
      call exchange_contact_list(archive, 'contact', results%contact)
      call exchange(archive, 'row_x', results%row_x)
      call exchange(archive, 'row_force', results%row_force)
      call exchange(archive, 'stress_element', results%stress_element)
      call exchange(archive, 'stress_point', results%stress_point)
      call exchange(archive, 'stress_x', results%stress_x)
      call exchange(archive, 'stress', results%stress)
      call exchange(archive, 'nodal_stress', results%nodal_stress)
      call exchange(archive, 'error_estimate', results%error_estimate)
      call exchange(archive, 'element_error', results%element_error)
      call exchange_iteration_list(archive, 'iterations', results%iterations)
      call exchange(archive, 'outer_iterations', results%outer_iterations)
      call exchange(archive, 'linear_solves', results%linear_solves)
      call exchange(archive, 'factorisations', results%factorisations)
      call exchange_unsettled_list(archive, 'unsettled', results%unsettled)
      call exchange(archive, 'contraction', results%contraction)
      call exchange(archive, 'contraction_estimate', results%contraction_estimate)
      call exchange(archive, 'equilibrium_residual', results%equilibrium_residual)
      call exchange(archive, 'strain_energy', results%strain_energy)
      call exchange(archive, 'external_work', results%external_work)
      call exchange_extreme_list(archive, 'extremes', results%extremes)
      call exchange_extreme(archive, results%large_strain)
      call exchange_extreme(archive, results%large_rotation)
      call exchange_extreme(archive, results%large_slip)
      call exchange_balance(archive, results%balance)
      call exchange_motion_list(archive, 'bodies', results%bodies)
      call exchange_rigid_list(archive, 'rigid', results%rigid)
      call exchange_joint_list(archive, 'joints', results%joints)
      call exchange_observed(archive, 'observed', results%observed)
      call exchange_cut_list(archive, 'cuts', results%cuts)
   end subroutine exchange_results

   subroutine exchange_contact_list(archive, name, list)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      type(contact_result_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, name, n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange_contact(archive, list(i))
      end do
   end subroutine exchange_contact_list

   subroutine exchange_contact(archive, contact)
      type(archive_t), intent(inout) :: archive
      type(contact_result_t), intent(inout) :: contact

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
   end subroutine exchange_contact

   subroutine exchange_unsettled_list(archive, name, list)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      type(unsettled_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, name, n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange_unsettled(archive, list(i))
      end do
   end subroutine exchange_unsettled_list

   subroutine exchange_unsettled(archive, point)
      type(archive_t), intent(inout) :: archive
      type(unsettled_t), intent(inout) :: point

      call exchange(archive, 'pair', point%pair)
      call exchange(archive, 'point', point%point)
      call exchange(archive, 'node', point%node)
      call exchange_vector(archive, 'x', point%x)
      call exchange_word(archive, 'states', point%states)
   end subroutine exchange_unsettled

   subroutine exchange_motion_list(archive, name, list)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      type(body_motion_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, name, n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange_motion(archive, list(i))
      end do
   end subroutine exchange_motion_list

   subroutine exchange_motion(archive, body)
      type(archive_t), intent(inout) :: archive
      type(body_motion_t), intent(inout) :: body

      call exchange(archive, 'name', body%name)
      call exchange_vector(archive, 'centre', body%centre)
      call exchange(archive, 'size', body%size)
      call exchange_vector(archive, 'u', body%u)
      call exchange(archive, 'rotation', body%rotation)
      call exchange_vector(archive, 'loads', body%loads)
      call exchange_vector(archive, 'supports', body%supports)
      call exchange_vector(archive, 'contact', body%contact)
      call exchange_vector(archive, 'terms', body%terms)
   end subroutine exchange_motion

   subroutine exchange_rigid_list(archive, name, list)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      type(rigid_result_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, name, n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange_rigid(archive, list(i))
      end do
   end subroutine exchange_rigid_list

   subroutine exchange_rigid(archive, body)
      type(archive_t), intent(inout) :: archive
      type(rigid_result_t), intent(inout) :: body
      integer :: i

      call exchange(archive, 'name', body%name)
      call exchange(archive, 'node', body%node)
      call exchange(archive, 'size', body%size)
      call exchange(archive, 'is_section', body%is_section)
      call exchange(archive, 'force', body%force)
      do i = 1, size(body%is_prescribed)
         call exchange(archive, 'is_prescribed', body%is_prescribed(i))
      end do
      do i = 1, size(body%has_reaction)
         call exchange(archive, 'has_reaction', body%has_reaction(i))
      end do
      call exchange_vector(archive, 'u', body%u)
      call exchange(archive, 'rotation', body%rotation)
      call exchange_vector(archive, 'reaction', body%reaction)
      call exchange(archive, 'moment', body%moment)
   end subroutine exchange_rigid

   subroutine exchange_joint_list(archive, name, list)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      type(joint_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, name, n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange_joint(archive, list(i))
      end do
   end subroutine exchange_joint_list

   subroutine exchange_joint(archive, joint)
      type(archive_t), intent(inout) :: archive
      type(joint_t), intent(inout) :: joint

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
   end subroutine exchange_joint

   subroutine exchange_observed(archive, name, list)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      type(observed_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, name, n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange_word(archive, 'name', list(i)%name)
         call exchange(archive, 'value', list(i)%value)
      end do
   end subroutine exchange_observed

   subroutine exchange_cut_list(archive, name, list)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      type(cut_force_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, name, n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange_cut(archive, list(i))
      end do
   end subroutine exchange_cut_list

   subroutine exchange_cut(archive, cut)
      type(archive_t), intent(inout) :: archive
      type(cut_force_t), intent(inout) :: cut

      call exchange(archive, 'name', cut%name)
      call exchange_vector(archive, 'middle', cut%middle)
      call exchange(archive, 'length', cut%length)
      call exchange(archive, 'n', cut%n)
      call exchange(archive, 'v', cut%v)
      call exchange(archive, 'm', cut%m)
      call exchange_vector(archive, 'terms', cut%terms)
   end subroutine exchange_cut

   subroutine exchange_iteration_list(archive, name, list)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      type(iteration_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n

      call exchange_length(archive, name, n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      if (n >= 0) call exchange_iterations(archive, list)
   end subroutine exchange_iteration_list

   !> Column by column: there may be thousands, in every file.
   subroutine exchange_iterations(archive, list)
      type(archive_t), intent(inout) :: archive
      type(iteration_t), intent(inout) :: list(:)

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

   subroutine exchange_extreme_list(archive, name, list)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      type(extreme_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, name, n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange_extreme(archive, list(i))
      end do
   end subroutine exchange_extreme_list

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

      call exchange_vector(archive, 'applied', balance%applied)
      call exchange_vector(archive, 'reactions', balance%reactions)
      call exchange(archive, 'applied_moment', balance%applied_moment)
      call exchange(archive, 'reaction_moment', balance%reaction_moment)
      call exchange_vector(archive, 'rigid', balance%rigid)
      call exchange(archive, 'is_revolved', balance%is_revolved)
      call exchange_vector(archive, 'rows', balance%rows)
   end subroutine exchange_balance

end module atrito_exchange_results
