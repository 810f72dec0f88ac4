!> A block on a block, and contact lines with random flexibilities, for the tests of solve.
module body_cases
   use atrito_assembly, only: fem_t
   use atrito_average, only: build_average
   use atrito_bodies, only: find_bodies, number_equations, find_rigid_modes
   use atrito_bound_qp, only: bound_qp_t
   use atrito_condensed_body, only: condensed_body_t, condense_body, set_load
   use atrito_contact_line, only: contact_line_t, number_unknowns
   use atrito_body_motions, only: add_rigid_motions
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_problem, only: build_flexibility, set_right_hand_sides
   use atrito_contact_rows, only: contact_rows_t, build_rows
   use atrito_contact_solution, only: contact_solution_t
   use atrito_controls, only: controls_t, METHOD_ANDERSON
   use atrito_displacements, only: contact_forces, elastic_displacements
   use atrito_element, only: element_stiffness
   use atrito_faces, only: face_list_t, add_face
   use atrito_friction_law, only: friction_law_t, FRICTION_NONLOCAL, KERNEL_POINTS
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: mesh_t, add_element, add_node, element_coordinates, trim_mesh
   use atrito_outer_loop, only: solve_contact_line
   use atrito_plane_state, only: elastic_t, PLANE_STRAIN
   use atrito_points, only: contact_points_t
   use atrito_reporter, only: reporter_t
   use atrito_results, only: body_result_t
   use atrito_solver_choice, only: SOLVER_SKYLINE
   use atrito_row_entries, only: build_constraint_rows
   use atrito_status, only: status_t, is_ok
   use dense_measures, only: norm_one
   use surface_pairs, only: pair_surfaces
   use random_arrays, only: random_numbers
   implicit none (type, external)
   private
   public :: scene_case_t, stacked_blocks, solve_dense, full_matrix, random_line

   !> All that the solver knows of a scene of two bodies.
   type :: scene_case_t
      type(fem_t) :: fem
      logical, allocatable :: held(:, :)
      real(wp), allocatable :: value(:, :), f(:, :)
      type(contact_points_t) :: points(1)
      type(contact_rows_t) :: rows
      type(contact_line_t) :: line
   end type scene_case_t

contains

   !> A block of 4 x 2 elements, free but for what it stands on, on one of n_lower x 2 with a fixed base; E 100 and 300. The law
   !> is the paper's with nu = 0.4, eps = 0.001. Node loads push the top down and a little to the right.
   subroutine stacked_blocks(n_lower, scene, along)
      integer(ip), intent(in) :: n_lower
      type(scene_case_t), intent(out) :: scene
      logical, intent(in), optional :: along           !< the left side is held along x
      type(face_list_t) :: slave, master
      real(wp) :: thickness(8 + 2*n_lower), no_points(2, 0)
      integer(ip) :: i, n, b

      allocate (scene%fem%mesh)
      call add_block(scene%fem%mesh, [0.0_wp, 1.0_wp], [2.0_wp, 2.0_wp], [4_ip, 2_ip])
      call add_block(scene%fem%mesh, [-0.5_wp, 0.0_wp], [2.5_wp, 1.0_wp], [n_lower, 2_ip])
      call trim_mesh(scene%fem%mesh)
      n = scene%fem%mesh%n_nodes
      do i = 1, 4
         call add_face(slave, i, 1_ip)
      end do
      do i = n_lower, 1, -1
         call add_face(master, 8 + n_lower + i, 3_ip)
      end do
      scene%fem%sections = [elastic_t(100.0_wp, 0.3_wp, 1.0_wp, 0.0_wp), elastic_t(300.0_wp, 0.2_wp, 1.0_wp, 0.0_wp)]
      allocate (scene%fem%section_of(8 + 2*n_lower), source=2_ip)
      scene%fem%section_of(:8) = 1
      allocate (scene%held(2, n), source=.false.)
      allocate (scene%value(2, n), scene%f(2, n), source=0.0_wp)
      scene%held(:, 16:16 + n_lower) = .true.
      if (present(along)) scene%held(1, [1, 6, 11]) = along
      scene%f(1, 11:15) = 0.05_wp
      scene%f(2, 11:15) = -0.5_wp
      thickness = 1.0_wp
      call pair_surfaces(scene%fem%mesh, thickness, slave, master, no_points, scene%points(1))
      call build_rows(scene%points, scene%rows)
      call find_bodies(scene%fem%mesh, scene%fem%bodies)
      do b = 1, 2
         scene%fem%bodies%list(b)%name = merge('UPPER', 'LOWER', b == 1)
         call number_equations(scene%fem%mesh, scene%fem%bodies, b, scene%held, side_nodes(b, n_lower), .true.)
         call find_rigid_modes(scene%fem%mesh, scene%fem%bodies%list(b), scene%held)
      end do
      call lay_line(scene)
   end subroutine stacked_blocks

   !> The nodes of the touching sides: all of the upper one, all of the lower one.
   pure function side_nodes(b, n_lower) result(nodes)
      integer(ip), intent(in) :: b, n_lower
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: i

      if (b == 1) nodes = [(i, i=1, 5)]
      if (b == 2) nodes = [(15 + 2*(n_lower + 1) + i, i=1, n_lower + 1)]
   end function side_nodes

   subroutine add_block(mesh, low, high, n)
      type(mesh_t), intent(inout) :: mesh
      real(wp), intent(in) :: low(2), high(2)
      integer(ip), intent(in) :: n(2)
      integer(ip) :: i, j, first, corner
      logical :: known
      real(wp) :: place(2)

      first = mesh%n_nodes
      do j = 0, n(2)
         do i = 0, n(1)
            place = low + (high - low)*[real(i, wp)/n(1), real(j, wp)/n(2)]
            call add_node(mesh, mesh%n_nodes + 1, place, known)
         end do
      end do
      do j = 1, n(2)
         do i = 1, n(1)
            corner = first + (j - 1)*(n(1) + 1) + i
            call add_element(mesh, mesh%n_elements + 1, PLANE_STRAIN, [corner, corner + 1, corner + n(1) + 2, corner + n(1) + 1], &
                             known)
         end do
      end do
   end subroutine add_block

   subroutine lay_line(scene)
      type(scene_case_t), intent(inout) :: scene
      integer(ip) :: n

      n = scene%rows%n
      associate (line => scene%line)
         line%n = n
         line%weight = scene%points(1)%weight
         allocate (line%delta(n), line%known_overlap(n), line%known_slip(n), source=0.0_wp)
         allocate (line%law(n))
         line%law = friction_law_t(FRICTION_NONLOCAL, 0.4_wp, 0.001_wp, 0.0_wp)
         line%average = build_average(scene%points(1)%x, scene%points(1)%length, 0.8_wp, KERNEL_POINTS)
         call number_unknowns(line, spread(.true., 1, n), spread(.true., 1, n))
      end associate
   end subroutine lay_line

   !> The forces and all displacements of a scene of two bodies, by the dense form. ok: it converged.
   subroutine solve_dense(scene, solution, u, ok)
      type(scene_case_t), intent(in) :: scene
      type(contact_solution_t), intent(out) :: solution
      real(wp), allocatable, intent(out) :: u(:, :)    !< (2, n_nodes) [L]
      logical, intent(out) :: ok
      type(condensed_body_t) :: condensed(2)
      type(constraint_rows_t) :: b_rows
      type(bound_qp_t) :: problem
      type(body_result_t) :: result
      type(status_t) :: status
      real(wp), allocatable :: force(:, :)
      integer(ip) :: b

      do b = 1, 2
         call condense_body(scene%fem, b, SOLVER_SKYLINE, condensed(b), result, status)
         ok = is_ok(status)
         if (.not. ok) return
         call set_load(scene%fem, b, scene%f, condensed(b))
      end do
      call build_constraint_rows(scene%fem, scene%rows, scene%line, .false., b_rows)
      call build_flexibility(scene%fem, condensed, b_rows, scene%rows, scene%line, problem)
      call set_right_hand_sides(scene%fem, condensed, b_rows, scene%rows, scene%line, scene%value, scene%f, problem)
      call solve_contact_line(problem, scene%line, controls_t(METHOD_ANDERSON, 1.0e-12_wp, 100_ip, 1.0_wp), &
                              reporter_t(quiet=.true.), solution, status)
      ok = is_ok(status) .and. solution%converged
      if (.not. ok) return
      force = contact_forces(scene%fem, scene%rows, scene%line, solution)
      u = scene%value
      do b = 1, 2
         call elastic_displacements(scene%fem, b, condensed(b), force, u)
      end do
      call add_rigid_motions(scene%fem, solution%state%a, u)
   end subroutine solve_dense

   !> The matrix of all elements, order u1, u2 of node 1, of node 2, ...
   pure function full_matrix(fem) result(k)
      type(fem_t), intent(in) :: fem
      real(wp) :: k(2*fem%mesh%n_nodes, 2*fem%mesh%n_nodes), ke(8, 8)
      integer(ip) :: e, i, dofs(8)

      k = 0.0_wp
      do e = 1, fem%mesh%n_elements
         call element_stiffness(element_coordinates(fem%mesh, e), fem%sections(fem%section_of(e)), fem%mesh%state(e), ke)
         dofs = [(2*fem%mesh%nodes(i, e) - 1, 2*fem%mesh%nodes(i, e), i=1, 4)]
         k(dofs, dofs) = k(dofs, dofs) + ke
      end do
   end function full_matrix

   !> n points at random spacings on a line: normal and tangential flexibility A of a layer (exp of the distance), coupled by
   !> A R A with R antisymmetric and |A R| <= 0.3, which keeps C positive. k = 1: pressed by a force along a motion; k = 2: pushed
   !> sideways by less than friction bears as well.
   subroutine random_line(seed, n, nu, eps, k, problem, line)
      integer(ip), intent(in) :: seed, n, k
      real(wp), intent(in) :: nu, eps
      type(bound_qp_t), intent(out) :: problem
      type(contact_line_t), intent(out) :: line
      integer(lp) :: state
      real(wp) :: spacing(n), x(2, n), a(n, n), r(n, n), coupling(n, n), flat(n*n), limit(1), ramp(n)
      integer(ip) :: i

      state = 104729_lp*seed
      call random_numbers(state, flat)
      call random_numbers(state, spacing)
      spacing = 0.05_wp*(1 + 0.4_wp*spacing)
      x = 0.0_wp
      x(1, :) = [(sum(spacing(:i)), i=1, n)]
      do i = 1, n
         a(:, i) = exp(-abs(x(1, :) - x(1, i))/0.5_wp)
      end do
      r = reshape(flat, [n, n])
      r = r - transpose(r)
      limit = norm_one(matmul(a, r))
      coupling = matmul(a, matmul(r, a))*(0.3_wp/limit(1))
      line%n = n
      line%weight = spacing
      allocate (line%delta(n), line%known_overlap(n), line%known_slip(n), source=0.0_wp)
      allocate (line%law(n))
      line%law = friction_law_t(FRICTION_NONLOCAL, nu, eps, 0.0_wp)
      line%average = build_average(x, line%weight, 0.05_wp*(2 + mod(seed, 5_ip)), KERNEL_POINTS)
      call number_unknowns(line, spread(.true., 1, n), spread(.true., 1, n))
      problem%m = 2*n
      problem%n_normal = n
      problem%k = k
      allocate (problem%c(2*n, 2*n), problem%g0(2*n), problem%g(2*n, k), problem%h(k))
      problem%weight = [spacing, spacing]
      problem%c(:n, :n) = a
      problem%c(n + 1:, n + 1:) = a
      problem%c(:n, n + 1:) = coupling
      problem%c(n + 1:, :n) = transpose(coupling)
      ramp = (x(1, :) - x(1, n)/2)/x(1, n)
      problem%g0(:n) = 1.0_wp - 8*ramp**2
      call random_numbers(state, limit)
      problem%g0(n + 1:) = 0.4_wp*limit(1) + 0.6_wp*ramp
      problem%g = 0.0_wp
      if (k > 0) problem%g(:n, 1) = 1.0_wp
      if (k > 0) problem%h(1) = 2.0_wp
      if (k > 1) problem%g(n + 1:, 2) = 1.0_wp
      if (k > 1) problem%h(2) = 0.5_wp*nu
   end subroutine random_line

end module body_cases
