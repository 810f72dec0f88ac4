!> Rigid surfaces from one step to the next: a motion that is prescribed now and was free begins where it is, what held one that is
!> free now fades.
module atrito_rigid_steps
   use atrito_internal_forces, only: internal_force_sizes
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_load_lists, only: add_nodal_value
   use atrito_model, only: model_t, nodal_values_t
   use atrito_results, only: results_t, rigid_result_t
   use atrito_rigid_bodies, only: add_rigid_loads, has_moving_surfaces, prescribed_motion, DOF_OF_MOTION
   use atrito_scene_data, only: scene_data_t
   implicit none (type, external)
   private
   public :: begin_motions_from, released_forces

   !> A reaction that is less than this part of what was added up in it is none: a body that is free now would be driven by it.
   real(wp), parameter :: ROUND_OFF = 100*EPS_MACH

contains

   !> Sets where motions begin that were free in the step before.
   pure subroutine begin_motions_from(model, before, last, prescribed)
      type(model_t), intent(in) :: model                       !< its rigid bodies are read
      type(nodal_values_t), intent(in) :: before               !< prescribed in the step before
      type(rigid_result_t), allocatable, intent(in) :: last(:) !< at its end
      type(nodal_values_t), intent(inout) :: prescribed        !< in this step
      logical :: was_prescribed(3)
      real(wp) :: motion(3)
      integer(ip) :: i, k, m

      if (prescribed%n == 0 .or. .not. allocated(last)) return
      if (.not. allocated(prescribed%from)) allocate (prescribed%from(prescribed%n), source=0.0_wp)
      do k = 1, prescribed%n
         i = findloc(model%rigid_bodies%node, prescribed%node(k), dim=1, kind=ip)
         m = findloc(DOF_OF_MOTION, prescribed%dof(k), dim=1, kind=ip)
         call prescribed_motion(model, before, i, was_prescribed, motion)
         if (was_prescribed(m)) cycle
         motion = [last(i)%u, last(i)%rotation]
         prescribed%from(k) = motion(m)
      end do
   end subroutine begin_motions_from

   !> The reactions at what was prescribed in the last increment and is free now.
   function released_forces(data, last, held, prescribed) result(released)
      type(scene_data_t), intent(in) :: data               !< of the last increment
      type(results_t), intent(in) :: last                  !< its results
      logical, intent(in) :: held(:, :)                    !< now, (2, nodes of the solver's mesh)
      type(nodal_values_t), intent(in) :: prescribed       !< now, of reference nodes
      real(wp), allocatable :: released(:, :)              !< (2, nodes of the solver's mesh) [F]
      real(wp), allocatable :: of_terms(:, :)
      integer(ip) :: n, i, m
      logical :: is_prescribed(3)
      real(wp) :: motion(3), reaction(3)
      type(nodal_values_t) :: loads

      n = data%model%mesh%n_nodes
      released = merge(last%reaction, 0.0_wp, data%held(:, :n) .and. .not. held(:, :n))
      if (any(abs(released) > 0.0_wp)) then
         allocate (of_terms(2, n))
         call internal_force_sizes(data%fem, last%u, of_terms)
         where (abs(released) <= ROUND_OFF*of_terms) released = 0.0_wp
      end if
      if (.not. has_moving_surfaces(data%model)) return
      released(:, data%model%rigid_bodies%node) = 0.0_wp
      ! The same at reference nodes, where what holds them is a load now.
      do i = 1, size(last%rigid, kind=ip)
         call prescribed_motion(data%model, prescribed, i, is_prescribed, motion)
         reaction = [last%rigid(i)%reaction, last%rigid(i)%moment]
         do m = 1, size(reaction, kind=ip)
            if (is_prescribed(m) .or. .not. last%rigid(i)%is_prescribed(m)) cycle
            call add_nodal_value(loads, data%model%rigid_bodies(i)%node, DOF_OF_MOTION(m), reaction(m))
         end do
      end do
      call add_rigid_loads(data%model, loads, released)
   end function released_forces

end module atrito_rigid_steps
