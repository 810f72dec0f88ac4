!> The scene that a linear quantity loads, with the contact states held: what it is made of, and its finite element solution.
!>
!> The mean of a displacement is a uniform load with the resultant 1, the mean of a stress a strain of its own of the elements, the
!> sum of reactions a support that is moved by -1, the resultant of a pair a gap of 1 (atrito_quantity_bound).
module atrito_dual_scene
   use atrito_assembly, only: cached_stiffness, fem_t, stiffness_cache_t
   use atrito_bilateral_rows, only: add_row, begin_rows, trim_rows, ROW_TIE
   use atrito_body_cache, only: body_cache_t
   use atrito_body_motions, only: add_rigid_motions
   use atrito_condensed_body, only: check_held
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_contact_segments, only: segment_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_displacements, only: add_bilateral_forces
   use atrito_element_classes, only: given_of
   use atrito_element_table, only: MOST_NODES
   use atrito_internal_forces, only: internal_forces
   use atrito_joined_sides, only: joints_t, misfit_of_joints, tractions_of_forces
   use atrito_kinds, only: ip, wp
   use atrito_linear_quantity, only: linear_part_t, linear_quantity_t, PART_FACES, PART_PAIR, PART_REACTION, &
                                     PART_STRESS, PART_VOLUME
   use atrito_model, only: element_load_t, model_t, nodal_values_t, step_t, LOAD_BODY, LOAD_TRACTION
   use atrito_nodal_loads, only: nodal_loads
   use atrito_proof_loads, only: take_loads
   use atrito_quantity_bound, only: common_t, held_scene_t
   use atrito_scene_data, only: assemble, drop_assembled, prepare, scene_data_t, solve_options_t
   use atrito_solve_multiplier, only: solve_multiplier
   use atrito_status, only: is_ok, status_t
   implicit none (type, external)
   private
   public :: make_dual

   real(wp), parameter :: NO_JUMP = 1.0e-9_wp       !< of the largest displacement: what joined sides may be apart by

contains

   !> Solves the dual scene. constant: what the quantity has besides, of tractions that are held.
   subroutine make_dual(data, prescribed, quantity, both, segments, dual, u_of_loads, constant, why_not)
      type(scene_data_t), intent(in) :: data        !< the scene that is solved
      type(nodal_values_t), intent(in) :: prescribed !< of its supports
      type(linear_quantity_t), intent(in) :: quantity
      type(common_t), intent(in) :: both
      type(segment_t), intent(in) :: segments(:)    !< with its tractions
      type(held_scene_t), intent(inout) :: dual
      real(wp), allocatable, intent(out) :: u_of_loads(:, :) !< (2, n_nodes) as it was solved; dual%u closes the joints [L]
      real(wp), intent(out) :: constant
      character(len=:), allocatable, intent(inout) :: why_not
      type(model_t), target :: model
      type(scene_data_t) :: scene
      real(wp), allocatable :: q(:), reaction(:, :)

      dual%segments = segments
      call hold_states(quantity, both%joints, dual%segments, constant)
      model = data%model
      call make_model(prescribed, quantity, both%joints, dual%segments, model)
      call solve_linear(model, quantity, scene, dual, q, reaction, why_not)
      if (allocated(why_not)) return
      u_of_loads = dual%u
      call close_joints(both%joints, dual%segments, scene%held, dual%u)
      if (misfit_of_joints(both%joints, dual%segments, dual%u) > NO_JUMP*maxval(abs(dual%u))) then
         why_not = 'supports on both sides of a contact that is joined'
         if (any(quantity%parts%kind == PART_PAIR)) why_not = 'the pair is joined to others or to supports at its ends'
         return
      end if
      call tractions_of_forces(both%joints, q, dual%segments)
      call take_loads(model, model%steps(1), scene%fem, both%sides, both%degree, scene%held, reaction, dual%loads, why_not)
      dual%fem%mesh => data%fem%mesh                ! the model of the dual scene goes
   end subroutine make_dual

   !> Gaps and rest slips of joined sides, and the part of the tractions that are held.
   pure subroutine hold_states(quantity, joints, segments, constant)
      type(linear_quantity_t), intent(in) :: quantity
      type(joints_t), intent(in) :: joints
      type(segment_t), intent(inout) :: segments(:) !< with the tractions of the scene; on return without them
      real(wp), intent(out) :: constant
      integer(ip) :: i, k

      constant = quantity%constant
      do i = 1, size(segments, kind=ip)
         associate (s => segments(i))
            s%gap = 0.0_wp
            s%rest = 0.0_wp
            do k = 1, size(quantity%parts, kind=ip)
               associate (part => quantity%parts(k))
                  if (part%kind /= PART_PAIR .or. part%pair /= s%pair) cycle
                  associate (area => s%length*s%thickness)
                     if (part%component == 1) then
                        if (joints%joined(1, i)) s%gap = s%gap + part%factor
                        if (.not. joints%joined(1, i)) constant = constant + 0.5_wp*part%factor*area*sum(s%p)
                     else                           ! the shear that is told is that on the slave
                        if (joints%joined(2, i)) s%rest = s%rest - part%factor
                        if (.not. joints%joined(2, i)) constant = constant - 0.5_wp*part%factor*area*sum(s%t)
                     end if
                  end associate
               end associate
            end do
            s%p = 0.0_wp
            s%t = 0.0_wp
         end associate
      end do
   end subroutine hold_states

   !> The model of the dual scene: the bodies, joined by rows in place of contact, one step with the loads of the quantity.
   subroutine make_model(prescribed, quantity, joints, segments, model)
      type(nodal_values_t), intent(in) :: prescribed
      type(linear_quantity_t), intent(in) :: quantity
      type(joints_t), intent(in) :: joints
      type(segment_t), intent(in) :: segments(:)
      type(model_t), intent(inout) :: model         !< on entry that of the scene
      type(step_t) :: step
      real(wp) :: value(joints%n_rows)
      integer(ip) :: i, d, e, k

      model%pairs = model%pairs(:0)
      model%points = model%points(:0)
      model%interactions = model%interactions(:0)
      value = 0.0_wp
      do i = 1, size(segments, kind=ip)
         do d = 1, 2
            if (.not. joints%joined(d, i)) cycle
            do e = 1, 2
               value(joints%row(d, joints%point(e, i))) = merge(segments(i)%gap(e), segments(i)%rest(e), d == 1)
            end do
         end do
      end do
      call begin_rows(model%bilateral)
      do i = 1, joints%n_rows
         k = merge(2, 1, joints%master(i) > 0)
         associate (nodes => [joints%slave(i), joints%master(i)], d => joints%direction(:, i))
            call add_row(nodes(:k), reshape([d, -d], [2_ip, k]), value(i), joints%compliance(i), joints%weight(i), &
                         [ROW_TIE, 1_ip, 1_ip], model%bilateral)
         end associate
      end do
      call trim_rows(model%bilateral)
      step%title = ''
      step%prescribed%n = prescribed%n
      allocate (step%prescribed%node(prescribed%n), step%prescribed%dof(prescribed%n))
      if (prescribed%n > 0) then                    ! else its lists may not be there
         step%prescribed%node = prescribed%node(:prescribed%n)
         step%prescribed%dof = prescribed%dof(:prescribed%n)
      end if
      allocate (step%prescribed%value(prescribed%n), source=0.0_wp)
      allocate (step%node_loads%node(0), step%node_loads%dof(0), step%node_loads%value(0))
      allocate (step%element_loads%element(0), step%element_loads%kind(0), step%element_loads%face(0), step%element_loads%line(0))
      allocate (step%element_loads%value(3, 0))
      model%steps = [step]
      do k = 1, size(quantity%parts, kind=ip)
         call add_part(quantity%parts(k), model)
      end do
   end subroutine make_model

   !> What a part of a quantity loads.
   subroutine add_part(part, model)
      type(linear_part_t), intent(in) :: part
      type(model_t), intent(inout) :: model
      type(element_load_t) :: loads
      integer(ip) :: i

      associate (step => model%steps(1))
         select case (part%kind)
         case (PART_FACES)
            loads = uniform_load(model, part%element, part%face, part%component, part%factor)
            call append_loads(loads, step%element_loads)
         case (PART_VOLUME)
            loads = uniform_load(model, part%element, [(0_ip, i=1, size(part%element, kind=ip))], part%component, part%factor)
            call append_loads(loads, step%element_loads)
         case (PART_REACTION)
            do i = 1, step%prescribed%n
               if (step%prescribed%dof(i) == part%component .and. any(part%node == step%prescribed%node(i))) then
                  step%prescribed%value(i) = step%prescribed%value(i) - part%factor
               end if
            end do
         end select
      end associate
   end subroutine add_part

   !> A load of the same strength on faces, or within elements (face 0), with the resultant `factor` along an axis.
   function uniform_load(model, element, face, component, factor) result(loads)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: element(:), face(:)
      integer, intent(in) :: component
      real(wp), intent(in) :: factor
      type(element_load_t) :: loads
      type(step_t) :: unit
      real(wp), allocatable :: f(:, :)
      integer(ip) :: i

      loads%n = size(element, kind=ip)
      loads%element = element
      loads%face = face
      loads%kind = merge(LOAD_BODY, LOAD_TRACTION, face == 0)
      loads%line = [(0_ip, i=1, loads%n)]
      allocate (loads%value(3, loads%n), source=0.0_wp)
      loads%value(component, :) = 1.0_wp
      unit%element_loads = loads
      call nodal_loads(model, unit, f)
      loads%value(component, :) = factor/sum(f(component, :))
   end function uniform_load

   pure subroutine append_loads(more, loads)
      type(element_load_t), intent(in) :: more
      type(element_load_t), intent(inout) :: loads
      integer(ip) :: n

      n = loads%n + more%n
      loads%element = [loads%element, more%element]
      loads%face = [loads%face, more%face]
      loads%kind = [loads%kind, more%kind]
      loads%line = [loads%line, more%line]
      loads%value = reshape([loads%value, more%value], [3_ip, n])
      loads%n = n
   end subroutine append_loads

   !> The finite element solution of the dual scene, in the sparse form. dual: its elements, loads and displacements.
   subroutine solve_linear(model, quantity, scene, dual, q, reaction, why_not)
      type(model_t), intent(in), target :: model
      type(linear_quantity_t), intent(in) :: quantity
      type(scene_data_t), intent(inout) :: scene
      type(held_scene_t), intent(inout) :: dual
      real(wp), allocatable, intent(out) :: q(:)    !< (rows) [F]
      real(wp), allocatable, intent(out) :: reaction(:, :) !< (2, n_nodes) [F]
      character(len=:), allocatable, intent(inout) :: why_not
      type(body_cache_t) :: store
      type(contact_solution_t) :: solution
      type(status_t) :: status
      real(wp) :: energy
      integer(ip) :: b, j

      call prepare(model, store, solve_options_t(contact_form=CONTACT_SPARSE), scene, status)
      do b = 1, scene%fem%bodies%n
         if (is_ok(status)) call check_held(scene%fem, b, status)
      end do
      dual%fem = scene%fem
      dual%f = scene%f
      call add_own_strains(model, quantity, dual%fem, scene%f)
      if (is_ok(status)) call assemble(scene, status)
      if (is_ok(status)) call solve_multiplier(scene, scene%assembled, scene%step%controls, solution, dual%u, status)
      call drop_assembled(scene)
      if (.not. is_ok(status)) then
         why_not = 'with the contact states held a body can move'
      else if (.not. allocated(dual%u)) then           ! one that is not exact makes the bounds wider, no more
         why_not = 'the scene that it loads was not solved'
      end if
      if (allocated(why_not)) return
      q = scene%line%weight*solution%p
      allocate (reaction, mold=dual%u)
      reaction = -scene%f
      energy = 0.0_wp                                  ! is not asked for
      call internal_forces(dual%fem, dual%u, reaction, energy)
      call add_bilateral_forces(scene%rows, [(.true., j=1, scene%rows%n_bilateral)], q, reaction)
      where (.not. scene%held) reaction = 0.0_wp
      call add_rigid_motions(scene%fem, solution%state%a, dual%u)
   end subroutine solve_linear

   !> Strains of their own of elements whose mean stress is asked for: Q = int s : strain; and their forces on the nodes.
   subroutine add_own_strains(model, quantity, fem, f)
      type(model_t), intent(in) :: model
      type(linear_quantity_t), intent(in) :: quantity
      type(fem_t), intent(inout) :: fem
      real(wp), intent(inout) :: f(:, :)            !< (2, n_nodes) to which they are added [F]
      type(element_load_t) :: loads
      type(stiffness_cache_t) :: cache
      real(wp) :: x(2*MOST_NODES), none(2, size(f, 2)), force(2*MOST_NODES)
      integer(ip) :: e, i, k, n

      if (.not. any(quantity%parts%kind == PART_STRESS)) return
      allocate (fem%own_strain(3, fem%mesh%n_elements), source=0.0_wp)
      do k = 1, size(quantity%parts, kind=ip)
         associate (part => quantity%parts(k))
            if (part%kind /= PART_STRESS) cycle
            loads = uniform_load(model, part%element, [(0_ip, i=1, size(part%element, kind=ip))], 1, part%factor)
            do i = 1, size(part%element, kind=ip)
               associate (strain => fem%own_strain(part%component, part%element(i)))
                  strain = strain + loads%value(1, i)
               end associate
            end do
         end associate
      end do
      none = 0.0_wp
      do e = 1, fem%mesh%n_elements
         if (all(fem%own_strain(:, e) == 0.0_wp)) cycle
         call cached_stiffness(fem, e, cache)
         call given_of(fem, e, none, x, n)
         n = 2*fem%mesh%shape(e)
         force(:n) = -matmul(cache%k(:n, :n), x(:n))
         associate (nodes => fem%mesh%nodes(:n/2, e))
            f(:, nodes) = f(:, nodes) + reshape(force(:n), [2_ip, n/2])
         end associate
      end do
   end subroutine add_own_strains

   !> Takes round-off out of jumps of joined sides without compliance: the slave's node follows, or the master's where it is held.
   pure subroutine close_joints(joints, segments, held, u)
      type(joints_t), intent(in) :: joints
      type(segment_t), intent(in) :: segments(:)
      logical, intent(in) :: held(:, :)             !< (2, n_nodes)
      real(wp), intent(inout) :: u(:, :)            !< (2, n_nodes) [L]
      integer, parameter :: ROUNDS = 20             ! a node may be in several joints
      real(wp), parameter :: ALONG = 1.0e-12_wp
      real(wp) :: jump
      integer(ip) :: i, d, e
      integer :: round

      do round = 1, ROUNDS
         do i = 1, size(segments, kind=ip)
            do d = 1, 2
               if (.not. joints%joined(d, i)) cycle
               do e = 1, 2
                  associate (row => joints%row(d, joints%point(e, i)))
                     if (joints%compliance(row) > 0.0_wp) cycle
                     associate (slave => joints%slave(row), master => joints%master(row), axis => joints%direction(:, row))
                        jump = dot_product(axis, u(:, slave)) - merge(segments(i)%gap(e), segments(i)%rest(e), d == 1)
                        if (master > 0) jump = jump - dot_product(axis, u(:, master))
                        if (.not. any(held(:, slave) .and. abs(axis) > ALONG)) then
                           u(:, slave) = u(:, slave) - jump*axis
                        else if (master > 0) then
                           if (.not. any(held(:, master) .and. abs(axis) > ALONG)) u(:, master) = u(:, master) + jump*axis
                        end if
                     end associate
                  end associate
               end do
            end do
         end do
      end do
   end subroutine close_joints

end module atrito_dual_scene
