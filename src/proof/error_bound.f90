!> A proved bound of the error in the energy norm (docs/theory/proof.md).
!>
!> With the friction bound tau of the run the contact problem has one solution u, of least energy, with the stress s. For
!> displacements u^ that keep the supports and the sides apart, and a stress s^ in equilibrium with the loads and with tractions
!> that the laws allow,
!>
!>     ||u^ - u||^2 + ||s^ - s||^2 <= eta^2 = ||s^ - C eps(u^)||^2 + 2 gap(u^; p^, t^)                                  (1)
!>
!> (Prager and Synge, for contact with friction), norms of the energy. No constant, no assumption on the mesh. The steps:
!>
!> 1. u^: the displacements of the run, a node of a slave moved back where sides overlap between points (`keep_apart`).
!> 2. p^, t^: from point to point as those of the run, linear; balanced with the loads of bodies that nothing else holds
!> (`balance`).
!> 3. One more solution with these tractions in place of the forces of contact, by which all that follows is a matter of loads.
!> 4. Tractions along all sides in equilibrium with every element (atrito_side_tractions).
!> 5. A stress in every element (atrito_airy_stress), bettered by sweeps over the corners (atrito_star_sweeps).
!> 6. The sum (1), the stresses' part point by point in all elements (atrito_element_energy), the law's exactly (law_gap).
module atrito_error_bound
   use atrito_assembly, only: cached_stiffness, fem_t, stiffness_cache_t
   use atrito_balanced_contact, only: add_segments, balance
   use atrito_cut_elements, only: add_piece, link_pieces, side_cuts_t
   use atrito_condensed_body, only: condense_body, condensed_body_t, contact_response, expand_body
   use atrito_contact_solution, only: contact_solution_t
   use atrito_contact_tractions, only: keep_apart, law_gap, list_segments, segment_forces, segment_t, traction_at
   use atrito_displacements, only: contact_forces
   use atrito_element_energy, only: stress_at
   use atrito_element_table, only: CORNERS_OF, DEGREE_OF, SHAPES
   use atrito_equilibrium_stress, only: sum_stresses
   use atrito_internal_forces, only: internal_forces
   use atrito_kinds, only: ip, wp
   use atrito_mesh_sides, only: list_sides, mesh_sides_t
   use atrito_model, only: model_t, step_t
   use atrito_problem, only: problem_t
   use atrito_proof_loads, only: proof_loads_t, take_loads
   use atrito_results, only: body_result_t, error_bound_t
   use atrito_side_tractions, only: equilibrate_sides, side_length, traction_of
   use atrito_solver_choice, only: SOLVER_SPARSE
   use atrito_status, only: is_ok, status_t
   use atrito_thermal_loads, only: add_thermal_of, elastic_energy
   implicit none (type, external)
   private
   public :: bound_error

   !> A residual of equilibrium above this share of the bound takes the certificate away.
   real(wp), parameter :: LEAST_DIGITS = 1.0e-3_wp

contains

   !> The bound of a converged solution; bound%why_not tells what is missing.
   subroutine bound_error(model, acting, problem, solution, u, reaction, bound, by_element)
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: acting            !< with the loads of the time
      class(problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(in) :: reaction(:, :)        !< (2, n_nodes) [F]
      type(error_bound_t), intent(out) :: bound
      real(wp), allocatable, intent(inout), optional :: by_element(:) !< (n_elements) eta^2 of each [F L]
      type(proof_loads_t) :: loads
      type(mesh_sides_t) :: sides
      type(side_cuts_t) :: cuts
      type(segment_t), allocatable :: segments(:)
      real(wp), allocatable :: kept(:, :), balanced(:, :), force_of_u(:, :), traction(:, :, :), share(:), force(:, :, :)
      logical, allocatable :: known(:, :)
      character(len=:), allocatable :: why_not
      real(wp) :: normal, tangential, energy, residual
      integer(ip) :: n_segments, i, degree

      call check_hypotheses(problem, why_not)
      if (.not. allocated(why_not)) call list_segments(model, problem, solution, segments, n_segments, why_not)
      if (allocated(why_not)) then
         bound%why_not = why_not
         return
      end if
      segments = segments(:n_segments)
      degree = maxval(DEGREE_OF(problem%fem%mesh%shape(:problem%fem%mesh%n_elements)))
      call list_sides(problem%fem%mesh, sides)
      call take_loads(model, acting, problem%fem, sides, degree, problem%held, reaction, loads, why_not)
      kept = u
      if (.not. allocated(why_not)) call keep_apart(segments, problem%held, kept, why_not)
      if (.not. allocated(why_not)) call balance(problem, segments, why_not)
      if (.not. allocated(why_not)) call solve_again(problem, solution, segments, u, balanced, why_not)
      if (.not. allocated(why_not)) call take_contact(problem%fem, sides, segments, degree, loads, cuts, why_not)
      if (allocated(why_not)) then
         bound%why_not = why_not
         return
      end if
      known = loads%known
      traction = loads%traction
      call element_forces(problem%fem, balanced, loads%at_nodes, force)
      call estimate_tractions(problem%fem, sides, balanced, known, traction)
      call equilibrate_sides(problem%fem%mesh, sides, force, known, traction, residual)
      allocate (share(problem%fem%mesh%n_elements))
      call sum_stresses(problem%fem, sides, known, traction, loads%volume, kept, degree, cuts, share)
      bound%normal = 0.0_wp
      bound%tangential = 0.0_wp
      do i = 1, n_segments
         call law_gap(segments(i), kept, normal, tangential)
         bound%normal = bound%normal + normal
         bound%tangential = bound%tangential + tangential
         associate (e => segments(i)%slave(1))
            share(e) = share(e) + merge(0.5_wp, 1.0_wp, segments(i)%master(1) > 0)*(normal + tangential)
         end associate
         if (segments(i)%master(1) > 0) share(segments(i)%master(1)) = share(segments(i)%master(1)) + 0.5_wp*(normal + tangential)
      end do
      bound%exists = .true.
      bound%residual = residual
      associate (eta2 => sum(share))
         bound%norm = sqrt(max(eta2, 0.0_wp))
         if (eta2 > 0.0_wp) then
            bound%normal = bound%normal/eta2
            bound%tangential = bound%tangential/eta2
            bound%bulk = 1.0_wp - bound%normal - bound%tangential
         end if
         energy = 0.0_wp
         force_of_u = kept
         call internal_forces(problem%fem, kept, force_of_u, energy)
         energy = elastic_energy(problem%fem, kept, energy)
         if (energy > 0.0_wp) bound%percent = 100*sqrt(max(eta2, 0.0_wp)/(2*energy))
         bound%is_certified = residual <= max(LEAST_DIGITS*bound%percent/100, 1.0e-12_wp)
         if (.not. bound%is_certified) bound%why_not = 'round-off of the equilibrium'
      end associate
      if (present(by_element)) call move_alloc(share, by_element)
   end subroutine bound_error

   !> What nothing can be proved for, whatever the loads are.
   subroutine check_hypotheses(problem, why_not)
      class(problem_t), intent(in) :: problem
      character(len=:), allocatable, intent(inout) :: why_not

      associate (fem => problem%fem)
         if (any(fem%sections%thickness <= 0.0_wp)) why_not = 'no thickness'
         if (problem%rows%n_bilateral > 0) why_not = 'ties, equations, springs or inclined supports'
         if (fem%bodies%n_rigid > 0) why_not = 'rigid bodies'
      end associate
   end subroutine check_hypotheses

   !> The displacements of bodies under these tractions in place of the forces of contact: those of the run, and what the difference
   !> of both makes.
   subroutine solve_again(problem, solution, segments, u, balanced, why_not)
      class(problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      type(segment_t), intent(in) :: segments(:)
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), allocatable, intent(out) :: balanced(:, :)
      character(len=:), allocatable, intent(inout) :: why_not
      real(wp), allocatable :: force(:, :), change(:, :), x(:, :)
      type(condensed_body_t) :: body
      type(body_result_t) :: result
      type(status_t) :: status
      integer(ip) :: b, i, dof, k

      balanced = u
      if (size(segments) == 0) return
      force = contact_forces(problem%fem, problem%rows, problem%line, solution)
      call add_segments(segments, force)
      allocate (change, mold=u)
      do b = 1, problem%fem%bodies%n
         associate (list => problem%fem%bodies%list(b))
            if (list%n_retained == 0) cycle
            result = body_result_t(solver_kind=SOLVER_SPARSE)
            call condense_body(problem%fem, b, SOLVER_SPARSE, body, result, status)
            if (.not. is_ok(status)) then
               why_not = 'the factor of a body'
               return
            end if
            allocate (x(list%n_retained, 1), source=0.0_wp)
            do i = 1, size(list%nodes, kind=ip)
               do dof = 1, 2
                  k = problem%fem%bodies%equation(dof, list%nodes(i)) - (list%n - list%n_retained)
                  if (k > 0) x(k, 1) = force(dof, list%nodes(i))
               end do
            end do
            call contact_response(body, x)
            allocate (body%load(list%n, 1), source=0.0_wp)
            change(:, list%nodes) = 0.0_wp
            call expand_body(problem%fem, b, body, x(:, 1), change)
            balanced(:, list%nodes) = balanced(:, list%nodes) + change(:, list%nodes)
            deallocate (x)
         end associate
      end do
   end subroutine solve_again

   !> Puts the tractions of contact among the known ones: polynomials with the same moments on sides that are cut.
   subroutine take_contact(fem, sides, segments, degree, loads, cuts, why_not)
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      type(segment_t), intent(in) :: segments(:)
      integer(ip), intent(in) :: degree
      type(proof_loads_t), intent(inout) :: loads
      type(side_cuts_t), intent(out) :: cuts
      character(len=:), allocatable, intent(inout) :: why_not
      real(wp) :: on_slave(2, 3), on_master(2, 3), ends(2, 2)
      real(wp), allocatable :: applied(:, :, :)
      integer(ip) :: i

      applied = loads%traction
      do i = 1, size(segments, kind=ip)
         call segment_forces(segments(i), on_slave, on_master)
         ends(:, 1) = traction_at(segments(i), 0.0_wp)
         ends(:, 2) = traction_at(segments(i), 1.0_wp)
         call put(segments(i)%slave, segments(i)%on_slave, 1.0_wp, on_slave)
         if (segments(i)%master(1) == 0) cycle
         associate (share => segments(i)%length/(abs(segments(i)%on_master(2) - segments(i)%on_master(1))* &
                    side_length(fem%mesh, sides, sides%of_element(segments(i)%master(2), segments(i)%master(1)))))
            call put(segments(i)%master, segments(i)%on_master, -share, on_master)
         end associate
      end do
      call link_pieces(sides%n, cuts)

   contains

      subroutine put(face, places, factor, moments)
         integer(ip), intent(in) :: face(2)
         real(wp), intent(in) :: places(2), factor, moments(2, 3)
         integer(ip) :: side

         side = sides%of_element(face(2), face(1))
         if (.not. all(loads%known(:, side))) why_not = 'contact along a support'
         if (any(applied(:, :, side) /= 0.0_wp)) why_not = 'a load along a contact side'
         call add_piece(side, places, factor*ends, cuts)
         loads%traction(:, :, side) = loads%traction(:, :, side) + &
                                      traction_of(moments(:, :degree + 1), side_length(fem%mesh, sides, side), degree)
      end subroutine put

   end subroutine take_contact

   !> R_E of all elements: the forces of their stresses less those of their loads.
   subroutine element_forces(fem, u, body_force, force)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(in) :: body_force(:, :, :)   !< (2, nodes, n_elements) [F]
      real(wp), allocatable, intent(out) :: force(:, :, :)
      type(stiffness_cache_t) :: cache
      real(wp), allocatable :: thermal(:, :)
      integer(ip) :: e, n, k

      allocate (force, source=-body_force)
      if (allocated(fem%heating)) allocate (thermal(2, fem%mesh%n_nodes), source=0.0_wp)
      do e = 1, fem%mesh%n_elements
         call cached_stiffness(fem, e, cache)
         n = cache%shape
         associate (nodes => fem%mesh%nodes(:n, e))
            do k = 2, n
               associate (of_node => matmul(cache%k(:2*n, 2*k - 1:2*k), u(:, nodes(k)) - u(:, nodes(1))))
                  force(:, :n, e) = force(:, :n, e) + reshape(of_node, [2_ip, n])
               end associate
            end do
            if (.not. allocated(thermal)) cycle
            call add_thermal_of(fem, [e], thermal)
            force(:, :n, e) = force(:, :n, e) - thermal(:, nodes)
            thermal(:, nodes) = 0.0_wp
         end associate
      end do
   end subroutine element_forces

   !> Where tractions are not known, those of the stresses of displacements: the mean of both elements.
   subroutine estimate_tractions(fem, sides, u, known, traction)
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      real(wp), intent(in) :: u(:, :)
      logical, intent(in) :: known(:, :)
      real(wp), intent(inout) :: traction(:, 0:, :)
      real(wp) :: s(3), n(2), t(2), at_end(2, 2)
      integer(ip) :: i, j, k, e, face
      integer :: ends

      do i = 1, sides%n
         if (all(known(:, i))) cycle
         t = fem%mesh%x(:, sides%node(2, i)) - fem%mesh%x(:, sides%node(1, i))
         n = [t(2), -t(1)]/norm2(t)
         at_end = 0.0_wp
         k = 0
         do j = 1, 2
            e = sides%element(j, i)
            if (e == 0) cycle
            k = k + 1
            do ends = 1, 2
               face = findloc(fem%mesh%nodes(:CORNERS_OF(fem%mesh%shape(e)), e), sides%node(ends, i), dim=1, kind=ip)
               s = stress_at(fem, e, u, SHAPES(fem%mesh%shape(e))%place(:, face))
               at_end(:, ends) = at_end(:, ends) + [s(1)*n(1) + s(3)*n(2), s(3)*n(1) + s(2)*n(2)]
            end do
         end do
         at_end = at_end/k
         do j = 0, size(traction, 2, kind=ip) - 1
            associate (share => real(j, wp)/(size(traction, 2) - 1))
               where (.not. known(:, i)) traction(:, j, i) = (1 - share)*at_end(:, 1) + share*at_end(:, 2)
            end associate
         end do
      end do
   end subroutine estimate_tractions

end module atrito_error_bound
