!> From the solution of an increment to its results: displacements, reactions, contact fields, energies and balances, the final
!> check of equilibrium, and where it is printed sums by joint, stresses and their error.
module atrito_increment_results
   use atrito_body_motions, only: add_rigid_motions
   use atrito_assembly, only: fem_t
   use atrito_contact_rows, only: bodies_of_row
   use atrito_contact_scales, only: force_round_off, had_t, widen, NONE_OF_HAD
   use atrito_contact_solution, only: contact_solution_t
   use atrito_displacements, only: contact_forces
   use atrito_extremes, only: find_extremes
   use atrito_final_check, only: check_equilibrium, check_balance, equilibrium_t
   use atrito_force_sums, only: clear_balance, leave_out_sections, share_out_rows, sum_bodies, sum_forces, sum_joints
   use atrito_kinds, only: ip, wp
   use atrito_linear_limits, only: find_large
   use atrito_mesh, only: is_revolved
   use atrito_plane_state, only: IS_TAPERED
   use atrito_range, only: largest_at
   use atrito_recovery, only: recover_contact, recover_stress, estimate_error
   use atrito_results, only: results_t, has_forces
   use atrito_row_entries, only: first_motions
   use atrito_scene_data, only: scene_data_t
   use atrito_section_forces, only: sum_cuts
   use atrito_step_loads, only: moment_t
   use atrito_strings, only: to_text
   use atrito_thermal_loads, only: elastic_energy
   use atrito_timers, only: start_phase, stop_phase
   use atrito_weak_forces, only: contact_sizes_t
   implicit none (type, external)
   private
   public :: begin_early, clear_round_off, clear_what_is_left, complete_results, had_by_forces, recover

   real(wp), parameter :: ROUND_OFF = 1.0e-14_wp            !< of the largest force on a body

contains

   !> Where nothing acts on a body any more, what is left of its displacements and of the forces on it is round-off of what it had.
   pure subroutine clear_what_is_left(data, solution, u)
      type(scene_data_t), intent(in) :: data                !< loads, and what bodies had before
      type(contact_solution_t), intent(inout) :: solution   !< a, q, p and t of what rests become 0
      real(wp), intent(inout) :: u(:, :)                    !< without rigid motions, (2, n_nodes) [L]
      logical :: is_still(data%fem%bodies%n)
      integer(ip) :: first(data%fem%bodies%n + 1), b, i, j

      first = first_motions(data%fem%bodies)
      do b = 1, data%fem%bodies%n
         associate (nodes => data%fem%bodies%list(b)%nodes, a => solution%state%a(first(b):first(b + 1) - 1))
            is_still(b) = largest_at(u, nodes) + sum(abs(a)) <= NONE_OF_HAD*data%had%motion(b) .and. &
                          largest_at(data%f, nodes) <= 0.0_wp
            if (is_still(b)) then
               u(:, nodes) = 0.0_wp
               a = 0.0_wp
            end if
         end associate
      end do
      do i = 1, size(data%line%point, kind=ip)
         j = data%line%point(i)
         associate (of_row => bodies_of_row(data%rows, j, data%fem%bodies%of_node))
            if (.not. all(is_still(pack(of_row, of_row > 0)))) cycle
            if (abs(solution%state%q(i)) > NONE_OF_HAD*maxval(data%had%force(pack(of_row, of_row > 0)))) cycle
         end associate
         call clear_force(data, i, solution)
      end do
   end subroutine clear_what_is_left

   !> Forces at points that are round-off of those on each of their bodies are none: what closes without force has no pressure of
   !> 1e-17 of the others, by which it were said to stick or slip.
   pure subroutine clear_round_off(data, solution)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(inout) :: solution
      real(wp) :: largest(0:data%fem%bodies%n)              ! 0: what has no body
      integer(ip) :: i, j

      largest = largest_forces(data, solution)
      do i = 1, size(data%line%point, kind=ip)
         j = data%line%point(i)
         if (j > data%line%n - data%line%n_bilateral) cycle
         associate (of_row => bodies_of_row(data%rows, j, data%fem%bodies%of_node))
            if (all(of_row == 0) .or. abs(solution%state%q(i)) > ROUND_OFF*minval(largest(of_row))) cycle
         end associate
         call clear_force(data, i, solution)
      end do
   end subroutine clear_round_off

   !> (0:bodies) The largest load at a node of each body, or force of a row that sees it [F].
   pure function largest_forces(data, solution) result(largest)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(in) :: solution
      real(wp) :: largest(0:data%fem%bodies%n)
      integer(ip) :: b, i

      largest(0) = huge(1.0_wp)
      do b = 1, data%fem%bodies%n
         associate (nodes => data%fem%bodies%list(b)%nodes)
            largest(b) = largest_at(data%f, nodes)
         end associate
      end do
      do i = 1, size(data%line%point, kind=ip)
         associate (of_row => bodies_of_row(data%rows, data%line%point(i), data%fem%bodies%of_node))
            largest(of_row) = max(largest(of_row), abs(solution%state%q(i)))
         end associate
      end do
   end function largest_forces

   !> What the bodies have had, and the motions that forces as theirs make, force over E times thickness: where the forces go
   !> straight into supports and joints nothing moves, but round-off is that of those motions. Forces of rows count up to the sum
   !> of all loads.
   pure type(had_t) function had_by_forces(data, solution) result(had)
      type(scene_data_t), intent(in) :: data                !< forces, elasticity, and what bodies had before
      type(contact_solution_t), intent(in) :: solution      !< forces of the rows
      real(wp) :: stiffness(size(data%fem%sections)), force(0:data%fem%bodies%n), motion(data%fem%bodies%n), loads
      integer(ip) :: b, i

      do i = 1, size(data%fem%sections, kind=ip)
         associate (section => data%fem%sections(i))
            stiffness(i) = section%thickness*merge(section%stiffness(1, 1), section%young, section%is_orthotropic)
         end associate
      end do
      loads = sum(abs(data%f))
      if (allocated(data%thermal)) loads = loads + sum(abs(data%thermal))
      force = min(largest_forces(data, solution), loads)
      motion = 0.0_wp
      do b = 1, data%fem%bodies%n
         associate (body => data%fem%bodies%list(b))
            if (body%is_rigid) cycle
            if (allocated(data%thermal)) force(b) = max(force(b), largest_at(data%thermal, body%nodes))
            motion(b) = force(b)/least_stiffness(data%fem, body%elements, stiffness)
         end associate
      end do
      where (data%fem%bodies%list%is_rigid) motion = maxval(motion)
      had = data%had
      call widen(had, motion, 0.0_wp*motion)
   end function had_by_forces

   !> The least E times thickness [F/L] of some elements; that of tapered ones by their nodes.
   pure real(wp) function least_stiffness(fem, elements, stiffness) result(least)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: elements(:)                !< places in the mesh
      real(wp), intent(in) :: stiffness(:)                  !< of the sections; of tapered elements E alone
      integer(ip) :: i

      least = minval(stiffness(fem%section_of(elements)))
      if (.not. allocated(fem%mesh%thickness)) return
      least = huge(1.0_wp)
      do i = 1, size(elements, kind=ip)
         associate (e => elements(i), mesh => fem%mesh)
            associate (own => stiffness(fem%section_of(e)))
               if (IS_TAPERED(mesh%state(e))) then
                  least = min(least, own*minval(mesh%thickness(mesh%nodes(:mesh%shape(e), e))))
               else
                  least = min(least, own)
               end if
            end associate
         end associate
      end do
   end function least_stiffness

   !> The force of an unknown, and the stress of its point with it.
   pure subroutine clear_force(data, i, solution)
      type(scene_data_t), intent(in) :: data
      integer(ip), intent(in) :: i                           !< unknown force
      type(contact_solution_t), intent(inout) :: solution

      solution%state%q(i) = 0.0_wp
      associate (j => data%line%point(i))
         if (data%line%normal(j) == i) solution%p(j) = 0.0_wp
         if (data%line%tangential(j) == i) solution%t(j) = 0.0_wp
      end associate
   end subroutine clear_force

   !> What is worth its time where it is printed: sums by joint, stresses and their error, the largest of all, the limits of
   !> a linear theory.
   subroutine complete_results(data, results)
      type(scene_data_t), intent(inout) :: data  !< distribution, thermal and requests are used
      type(results_t), intent(inout) :: results  !< with u and contact; get stresses, errors, extremes
      real(wp) :: strain_bound

      call start_phase('recover')
      if (data%is_distributed) call data%distribution%begin_fields(data%fem, results%u, data%wants_element_errors)
      call sum_joints(data%fem%bodies%of_node, data%points, results%contact, results%joints)
      call recover_stress(data%step%requests, data%fem, results)
      call stop_phase('recover')
      call start_phase('estimate')
      if (data%is_distributed) then
         call data%distribution%end_fields(data%fem, results, strain_bound)
      else
         call estimate_error(data%fem, results, strain_bound, data%wants_element_errors)
      end if
      if (.not. (has_forces(results) .or. allocated(data%thermal))) then
         ! Without forces stresses are round-off of displacements.
         if (allocated(results%stress)) results%stress = 0.0_wp
         if (allocated(results%nodal_stress)) results%nodal_stress = 0.0_wp
         if (allocated(results%element_error)) results%element_error = 0.0_wp
         results%error_estimate = 0.0_wp
      end if
      call find_large(data%model, data%fem, strain_bound, results)
      call find_extremes(data%model%mesh, data%fem%bodies%of_node, data%points, results)
      call stop_phase('estimate')
   end subroutine complete_results

   !> Where there are several processes the others begin with the fields, while this one checks the equilibrium.
   subroutine begin_early(data, solution, u)
      type(scene_data_t), intent(inout) :: data             !< its distribution begins with the fields
      type(contact_solution_t), intent(in) :: solution      !< amplitudes a of the rigid motions
      real(wp), intent(in) :: u(:, :)                       !< without rigid motions, (2, n_nodes) [L]
      real(wp), allocatable :: total(:, :)

      if (.not. data%is_distributed) return
      total = u
      call add_rigid_motions(data%fem, solution%state%a, total)
      call data%distribution%begin_fields(data%fem, total, data%wants_element_errors)
   end subroutine begin_early

   !> Displacements, reactions, contact fields, energies and balances.
   !>
   !> Equilibrium, and all that is a product with the stiffness, is asked of the displacements without the rigid motions of the
   !> bodies: K Z = 0, and K times a motion that is large beside the strains would be round-off as large as the forces. They are
   !> added behind that. Reactions are K u - f + B'q where dofs are held. The forces of ties, equations and springs are in B'q, too;
   !> share_out_rows and clear_balance count them as what they are: between bodies, or of a body with the ground.
   subroutine recover(data, solution, u, results)
      type(scene_data_t), intent(in) :: data               !< with the loads of its time
      type(contact_solution_t), intent(inout) :: solution  !< sizes of motions and forces are measured
      real(wp), allocatable, intent(inout) :: u(:, :)      !< without rigid motions, (2, n_nodes) [L]; moved to the results
      type(results_t), intent(inout) :: results            !< with the scene; get what is no stress
      real(wp), allocatable :: contact(:, :)
      type(equilibrium_t) :: equilibrium
      type(contact_sizes_t) :: sizes
      real(wp) :: imbalance, others(3)
      integer(ip) :: first(data%fem%bodies%n + 1), b

      contact = contact_forces(data%fem, data%rows, data%line, solution)
      call move_alloc(u, results%u)
      allocate (results%reaction, mold=results%u)
      ! The forces at the contact points and their pairs, and the rigid motions of the bodies.
      sizes%force = data%line%weight*hypot(solution%p, solution%t)
      sizes%pair = data%line%pair
      sizes%rows = data%rows
      sizes%had = data%had
      first = first_motions(data%fem%bodies)
      sizes%motion = [(sum(abs(solution%state%a(first(b):first(b + 1) - 1))), b=1, data%fem%bodies%n)]
      call check_equilibrium(data%fem, results%u, data%f, contact, data%held, results%reaction, equilibrium, sizes, data%thermal)
      imbalance = check_balance(data%fem, data%f, contact, data%rows, data%had, sizes)
      results%strain_energy = elastic_energy(data%fem, results%u, equilibrium%energy)
      if (allocated(data%step%requests%cuts)) then          ! rigid motions would cost digits
         call sum_cuts(data, moment_t(results%step_time, results%time), results%u, results%reaction - contact, results%cuts)
      end if
      call add_rigid_motions(data%fem, solution%state%a, results%u)
      results%converged = solution%converged
      results%law_holds = equilibrium%holds .and. imbalance <= 1.0e-8_wp
      if (results%law_holds .and. .not. equilibrium%has_forces) then   ! bodies that move without strain
         results%reaction = 0.0_wp
         results%strain_energy = 0.0_wp
         equilibrium%residual = 0.0_wp
      end if
      associate (force => max(equilibrium%largest_force, force_round_off(data%had)/NONE_OF_HAD))
         if (force > 0.0_wp) results%equilibrium_residual = equilibrium%residual/force
      end associate
      if (.not. results%law_holds) results%verdict = 'the bodies are not in equilibrium: residual ' &
                                                     //to_text(results%equilibrium_residual, 3)//', imbalance ' &
                                                     //to_text(imbalance, 3)
      if (.not. solution%converged) results%verdict = solution%verdict
      others = 0.0_wp
      results%prescribed = data%held
      if (data%rows%n_bilateral > 0) call share_out_rows(data, solution, contact, results, others)
      call sum_forces(data%fem%mesh%x, results%u, data%f, results%reaction, contact, results%balance, results%external_work)
      call leave_out_sections(data, results%reaction, contact, results%balance)
      results%balance%is_revolved = is_revolved(data%fem%mesh)
      results%balance%rows = others
      results%balance%rigid = results%balance%rigid - others
      if (data%rows%n_bilateral > 0) call clear_balance(results%balance)
      ! with the contact forces less those of bilateral rows that are supports
      if (data%step%requests%bodies) call sum_bodies(data%fem, results%u, data%f, results%reaction, contact, results%bodies)
      call recover_contact(data%line, data%rows, data%points, solution, results%u, results%contact)
      allocate (results%iterations(0))
      if (solution%history%n > 0) results%iterations = solution%history%records(:solution%history%n)
      results%outer_iterations = solution%history%outer
      results%linear_solves = max(solution%history%n, 1_ip)
      results%contraction = solution%contraction
      call measure_sizes(data, contact, results, solution)
   end subroutine recover

   !> The largest displacement of each body, and the largest force at a node of it.
   pure subroutine measure_sizes(data, contact, results, solution)
      type(scene_data_t), intent(in) :: data
      real(wp), intent(in) :: contact(:, :)                 !< (2, n_nodes) [F]
      type(results_t), intent(in) :: results
      type(contact_solution_t), intent(inout) :: solution
      integer(ip) :: b

      solution%body_motion = [(0.0_wp, b=1, data%fem%bodies%n)]
      solution%body_force = solution%body_motion
      do b = 1, data%fem%bodies%n
         associate (nodes => data%fem%bodies%list(b)%nodes)
            solution%body_motion(b) = largest_at(results%u, nodes)
            solution%body_force(b) = max(largest_at(data%f, nodes), largest_at(contact, nodes), largest_at(results%reaction, nodes))
         end associate
      end do
   end subroutine measure_sizes

end module atrito_increment_results
