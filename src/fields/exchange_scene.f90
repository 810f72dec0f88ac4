!> What of a scene goes into an archive, or comes out of it: atrito_archive.
module atrito_exchange_scene
   use atrito_archive, only: archive_t, exchange, exchange_vector, exchange_length
   use atrito_kinds, only: ip
   use atrito_results, only: body_result_t, pair_scene_t, scene_t
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: exchange_scene, exchange_strings

contains

   subroutine exchange_scene(archive, scene)
      type(archive_t), intent(inout) :: archive
      type(scene_t), intent(inout) :: scene
      integer(ip) :: i

      call provide_bodies(archive, scene%bodies)
      if (allocated(scene%bodies)) then
         do i = 1, size(scene%bodies, kind=ip)
            call exchange_body(archive, scene%bodies(i))
         end do
      end if
      call provide_pairs(archive, scene%pairs)
      if (allocated(scene%pairs)) then
         do i = 1, size(scene%pairs, kind=ip)
            call exchange_pair(archive, scene%pairs(i))
         end do
      end if
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
      call exchange_strings(archive, 'left_out', scene%left_out)
   end subroutine exchange_scene

   !> A list of as many bodies as there were, when it is read.
   subroutine provide_bodies(archive, bodies)
      type(archive_t), intent(inout) :: archive
      type(body_result_t), allocatable, intent(inout) :: bodies(:)
      integer(ip) :: n

      call exchange_length(archive, 'bodies', n, bodies)
      if (archive%is_reading .and. n >= 0) allocate (bodies(n))
   end subroutine provide_bodies

   subroutine exchange_body(archive, body)
      type(archive_t), intent(inout) :: archive
      type(body_result_t), intent(inout) :: body

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
   end subroutine exchange_body

   subroutine provide_pairs(archive, pairs)
      type(archive_t), intent(inout) :: archive
      type(pair_scene_t), allocatable, intent(inout) :: pairs(:)
      integer(ip) :: n

      call exchange_length(archive, 'pairs', n, pairs)
      if (archive%is_reading .and. n >= 0) allocate (pairs(n))
   end subroutine provide_pairs

   subroutine exchange_pair(archive, pair)
      type(archive_t), intent(inout) :: archive
      type(pair_scene_t), intent(inout) :: pair

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
   end subroutine exchange_pair

   subroutine exchange_strings(archive, name, list)
      type(archive_t), intent(inout) :: archive
      character(len=*), intent(in) :: name
      type(string_t), allocatable, intent(inout) :: list(:)
      integer(ip) :: n, i

      call exchange_length(archive, name, n, list)
      if (archive%is_reading .and. n >= 0) allocate (list(n))
      do i = 1, n
         call exchange(archive, name, list(i)%s)
      end do
   end subroutine exchange_strings

end module atrito_exchange_scene
