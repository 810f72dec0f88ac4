!> The motions of rigid surfaces and the reactions at their reference nodes, and results without the nodes that carried them.
module atrito_rigid_results
   use atrito_body_motions, only: motions_of_bodies
   use atrito_contact_solution, only: contact_solution_t
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: is_revolved
   use atrito_linear_limits, only: LARGE_ROTATION
   use atrito_results, only: extreme_t, results_t, rigid_result_t
   use atrito_rigid_bodies, only: carriers_of, has_moving_surfaces, prescribed_motion
   use atrito_scene_data, only: scene_data_t
   implicit none (type, external)
   private
   public :: take_rigid_results, leave_mesh_alone

contains

   !> Fills results%rigid, gives the reference nodes their displacements and reactions, and leaves the nodes of the mesh alone.
   subroutine take_rigid_results(data, solution, results)
      type(scene_data_t), intent(in) :: data           !< rigid bodies of its model, supports and loads
      type(contact_solution_t), intent(in) :: solution !< amplitudes a of the rigid motions
      type(results_t), intent(inout) :: results        !< with the carriers' u, reactions; without them then
      integer(ip) :: i, j
      logical :: has_fixed_surfaces

      if (.not. has_moving_surfaces(data%model) .or. .not. allocated(results%u)) return
      if (allocated(results%rigid)) deallocate (results%rigid)
      allocate (results%rigid(size(data%model%rigid_bodies)))
      do i = 1, size(results%rigid, kind=ip)
         call take_body(data, i, solution%state%a, results, results%rigid(i))
         associate (body => results%rigid(i), node => data%model%rigid_bodies(i)%node)
            results%u(:, node) = body%u
            results%reaction(:, node) = body%reaction
            results%prescribed(:, node) = body%has_reaction .and. [.true.,.not. body%is_section]
         end associate
      end do
      ! nothing but round-off goes to the ground where all rigid surfaces of pairs move
      ! Whether the master of a pair is a rigid surface that stays where it is.
      has_fixed_surfaces = .false.
      do j = 1, size(data%points, kind=ip)
         has_fixed_surfaces = has_fixed_surfaces .or. (data%points(j)%rigid .and. .not. any(data%model%rigid_bodies%surface &
                                                                                            == data%model%pairs(j)%master))
      end do
      if (.not. has_fixed_surfaces) results%balance%rigid(:2) = 0.0_wp
      call leave_mesh_alone(data, results)
   end subroutine take_rigid_results

   !> The fields without the nodes that carry motions; rotations that are not small are those of rigid surfaces, too.
   pure subroutine leave_mesh_alone(data, results)
      type(scene_data_t), intent(in) :: data     !< its mesh and rigid bodies are read
      type(results_t), intent(inout) :: results  !< arrays get as long as the mesh has nodes
      integer(ip) :: i

      if (.not. has_moving_surfaces(data%model)) return
      associate (n => data%model%mesh%n_nodes)
         results%u = results%u(:, :n)
         results%reaction = results%reaction(:, :n)
         results%prescribed = results%prescribed(:, :n)
         if (allocated(results%nodal_stress)) results%nodal_stress = results%nodal_stress(:, :n)
      end associate
      ! A rigid surface may rotate more than any element.
      if (allocated(results%rigid)) then
         do i = 1, size(results%rigid, kind=ip)
            associate (rotation => abs(results%rigid(i)%rotation))
               if (rotation <= max(LARGE_ROTATION, results%large_rotation%value)) cycle
               results%large_rotation = extreme_t(rotation, results%rigid(i)%node, data%model%mesh%x(:, &
                                                                                   data%model%rigid_bodies(i)%node), is_node=.true.)
            end associate
         end do
      end if
   end subroutine leave_mesh_alone

   !> The prescribed motion and the free one; the forces that hold the nodes that carry it, as one force and one moment.
   subroutine take_body(data, i, a, results, body)
      type(scene_data_t), intent(in) :: data
      integer(ip), intent(in) :: i                     !< of the rigid bodies
      real(wp), intent(in) :: a(:)                     !< amplitudes of all motions
      type(results_t), intent(in) :: results
      type(rigid_result_t), intent(out) :: body
      real(wp) :: motion(3), mode(3), all_modes(3, data%fem%bodies%n), arm(2)
      integer(ip) :: b, k, nodes(3)

      associate (bodies => data%fem%bodies)
         b = bodies%n - bodies%n_rigid + i
         body%name = bodies%list(b)%name
         body%size = bodies%list(b)%size
         body%is_section = data%model%rigid_bodies(i)%is_section
         body%node = data%fem%mesh%node_id(data%model%rigid_bodies(i)%node)
         call prescribed_motion(data%model, data%rigid_prescribed, i, body%is_prescribed, motion)
         all_modes = motions_of_bodies(bodies, a)
         mode = all_modes(:, b)
      end associate
      body%u = motion(:2) + mode(:2)
      body%rotation = motion(3) + mode(3)/body%size
      nodes = carriers_of(data%model, i)
      do k = 1, size(nodes, kind=ip)
         associate (r => results%reaction(:, nodes(k)))
            arm = data%fem%mesh%x(:, nodes(k)) - data%fem%mesh%x(:, nodes(1))
            body%reaction = body%reaction + r
            body%moment = body%moment + (arm(1)*r(2) - arm(2)*r(1))
         end associate
      end do
      if (is_revolved(data%fem%mesh) .and. .not. data%model%rigid_bodies(i)%is_section) then
         body%reaction(1) = 0.0_wp                     ! on the full circle these balance in themselves
         body%moment = 0.0_wp
      end if
      body%has_reaction = body%is_prescribed(:2)
      associate (inclined => data%model%inclined)
         if (inclined%n > 0) body%has_reaction = body%has_reaction .or. any(inclined%node(:inclined%n) &
                                                                            == data%model%rigid_bodies(i)%node)
      end associate
      where (.not. body%has_reaction) body%reaction = 0.0_wp
      if (.not. body%is_prescribed(3)) body%moment = 0.0_wp
      if (.not. body%is_section) return
      body%reaction(2) = 0.0_wp                        ! round-off: these are no dofs
      body%moment = 0.0_wp
      body%force = data%f(1, nodes(1)) + body%reaction(1)
   end subroutine take_body

end module atrito_rigid_results
