!> From the contact forces back to the bodies: stresses, and the fields at the points.
module atrito_recovery
   use atrito_assembly, only: fem_t
   use atrito_bound_qp, only: FREE
   use atrito_contact_form, only: CONTACT_SPARSE
   use atrito_contact_line, only: contact_line_t, rest_of, slip_of_unknown
   use atrito_contact_rows, only: contact_rows_t, row_value, true_gap
   use atrito_contact_solution, only: contact_solution_t
   use atrito_average, only: apply_average
   use atrito_element_table, only: BEST_OF, POINTS_OF, MOST_NODES, POINT_COUNT
   use atrito_error_estimate, only: energies_t, measure_error, relative_error
   use atrito_friction_law, only: is_full, FRICTION_NONE
   use atrito_kinds, only: ip, wp
   use atrito_model, only: requests_t
   use atrito_plane_state, only: IS_REDUCED, COMPONENTS, STATES, STRESS_NAMES, stress_33, thermal_modulus_33, von_mises
   use atrito_point_stress, only: point_rule_t, point_geometry_t, MOST_POINTS, make_point_rules, fetch_geometry, point_stresses, &
                                  point_thermal_strains
   use atrito_points, only: contact_points_t
   use atrito_range, only: unit_of
   use atrito_results, only: results_t, contact_result_t, POINT_OPEN, POINT_STICK, POINT_SLIP
   use atrito_stress_recovery, only: stress_field_t, recover_stress_field, nodal_stresses
   use atrito_threads, only: is_shared, chunk_count, find_chunk
   use atrito_thermal_loads, only: largest_thermal_strain
   implicit none (type, external)
   private
   public :: recover_contact, recover_stress, estimate_error

contains

   !> The fields of every pair at its points.
   pure subroutine recover_contact(line, rows, points, solution, u, contact)
      type(contact_line_t), intent(in) :: line       !< laws, friction and averages of the points
      type(contact_rows_t), intent(in) :: rows       !< gaps and slips of the points
      type(contact_points_t), intent(in) :: points(:) !< of each pair
      type(contact_solution_t), intent(in) :: solution !< p and t of the points
      real(wp), intent(in) :: u(:, :)                !< (2, n_nodes) [L]
      type(contact_result_t), allocatable, intent(out) :: contact(:) !< one a pair, without slip_increment and joint
      real(wp) :: weighted(line%n)
      integer(ip) :: i, j, k, first

      allocate (contact(size(points)))
      weighted = apply_average(line%average, max(solution%p, 0.0_wp))
      first = 0
      do i = 1, size(points, kind=ip)
         associate (c => contact(i))
            c%n = points(i)%n
            c%s = points(i)%s
            c%x = points(i)%x
            c%normal = points(i)%normal
            c%u = u(:, points(i)%node(:points(i)%n))
            c%weight = points(i)%weight
            allocate (c%gap(c%n), c%slip(c%n), c%status(c%n), c%pressure(c%n), c%shear(c%n), c%weighted_pressure(c%n))
            do j = 1, c%n
               k = first + j
               c%pressure(j) = max(solution%p(k), 0.0_wp)
               c%weighted_pressure(j) = weighted(k)
               c%shear(j) = -solution%t(k)
               call place_of_point(line, rows, solution, u, k, c%gap(j), c%slip(j))
               c%gap(j) = true_gap(rows, k, c%gap(j))
               c%status(j) = POINT_SLIP
               if (line%law(k)%kind /= FRICTION_NONE .and. .not. is_full(solution%t(k), solution%tau(k))) c%status(j) = POINT_STICK
               if (c%pressure(j) <= 0.0_wp) c%status(j) = POINT_OPEN
            end do
            c%s_end = 0.0_wp
            if (c%n > 0) c%s_end = maxval(c%s)
            c%has_friction = any(line%law(first + 1:first + c%n)%kind /= FRICTION_NONE)
            first = first + c%n
         end associate
      end do
   end subroutine recover_contact

   !> Gap and slip of a point: of an active one from its law, of a free one from its row, or from the displacements where these tell
   !> more, and without friction, where there is no unknown.
   !>
   !>             closed, or sticking     open, or slipping
   !>     gap     -delta p                -r, the residual of its row in the QP
   !>     slip    s0 + D q, its law       s0 + D q + r, s0 being the rest slip
   !>
   !> The law gives all digits of what the displacements have only as a difference: a gap of 1e-12 between sides that have moved by
   !> 1 is lost in u, and exact as delta p. In the sparse form r is what the last step left, and where idle motions were taken out
   !> (has_settled) r has the rounding of the way: then the row is asked of the displacements.
   pure subroutine place_of_point(line, rows, solution, u, j, gap, slip)
      type(contact_line_t), intent(in) :: line
      type(contact_rows_t), intent(in) :: rows
      type(contact_solution_t), intent(in) :: solution
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: j
      real(wp), intent(out) :: gap, slip             !< [L]
      integer(ip) :: i

      i = line%normal(j)
      if (i == 0) then
         gap = -line%known_overlap(j)
      else if (solution%state%state(i) == FREE) then
         gap = -line%delta(j)*solution%p(j)
      else if (takes_displacements(solution)) then
         gap = rows%gap(j) - row_value(rows, j, rows%normal(:, j), u)
      else
         gap = -solution%state%r(i)
      end if
      i = line%tangential(j)
      if (i == 0) then
         slip = row_value(rows, j, rows%tangent(:, j), u)
      else if (takes_displacements(solution) .and. solution%state%state(i) /= FREE) then
         slip = row_value(rows, j, rows%tangent(:, j), u)
      else if (abs(solution%state%q(i)) < tiny(slip)/epsilon(slip) .and. solution%bounds%d(i) > 0.0_wp) then
         ! the force has lost its digits at the end of the range of numbers
         slip = row_value(rows, j, rows%tangent(:, j), u)
      else
         slip = rest_of(line, j) + slip_of_unknown(solution%bounds, solution%state, i)
      end if
   end subroutine place_of_point

   !> Where idle motions were made least, r has the rounding of the way; in the sparse form it is as good as the last step.
   pure logical function takes_displacements(solution)
      type(contact_solution_t), intent(in) :: solution

      takes_displacements = solution%has_settled .or. solution%form == CONTACT_SPARSE
   end function takes_displacements

   !> Stresses at the Gauss points of the requested elements.
   subroutine recover_stress(requests, fem, results)
      type(requests_t), intent(in) :: requests       !< which elements, if any
      type(fem_t), intent(in) :: fem                 !< whole scene
      type(results_t), intent(inout) :: results      !< with u; gets stress_* where stresses are asked for
      type(point_rule_t) :: rules(MOST_NODES, 2)     !< of full and of reduced integration
      logical, allocatable :: wanted(:)
      integer(ip) :: rows(chunk_count(fem%mesh%n_elements) + 1) !< filled before each chunk of elements; all
      integer(ip) :: chunk, e, first, last

      if (.not. (requests%stress .or. requests%fields%stress)) return
      allocate (wanted(fem%mesh%n_elements), source=.false.)
      if (requests%stress) wanted = requests%element_s
      if (requests%fields%stress) wanted = wanted .or. requests%fields%element_s
      call make_point_rules(POINTS_OF, rules(:, 1))
      if (any(IS_REDUCED(fem%mesh%state))) call make_point_rules(BEST_OF, rules(:, 2))
      rows(1) = 0
      do chunk = 1, size(rows, kind=ip) - 1
         call find_chunk(chunk, fem%mesh%n_elements, first, last)
         rows(chunk + 1) = rows(chunk)
         do e = first, last
            if (wanted(e)) rows(chunk + 1) = rows(chunk + 1) + POINT_COUNT(fem%mesh%shape(e), fem%mesh%state(e))
         end do
      end do
      associate (n => rows(size(rows)))
         allocate (results%stress_element(n), results%stress_point(n), results%stress_x(2, n), &
                   results%stress(size(STRESS_NAMES), n))
      end associate
      !$omp parallel do schedule(dynamic) if (is_shared(fem%mesh%n_elements))
      do chunk = 1, size(rows, kind=ip) - 1
         call add_stresses(fem, chunk, wanted, rules, rows(chunk), results)
      end do
      !$omp end parallel do
      if (allocated(fem%heating)) call add_thermal_33(fem, rules, results)
   end subroutine recover_stress

   !> The rows of one chunk of elements.
   pure subroutine add_stresses(fem, chunk, wanted, rules, filled, results)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: chunk
      logical, intent(in) :: wanted(:)
      type(point_rule_t), intent(in) :: rules(MOST_NODES, 2)
      integer(ip), intent(in) :: filled              !< rows before those of this chunk
      type(results_t), intent(inout) :: results
      type(point_geometry_t) :: geometry
      integer(ip) :: e, first, last, row

      row = filled
      call find_chunk(chunk, fem%mesh%n_elements, first, last)
      do e = first, last
         if (wanted(e)) call add_element(fem, e, rules(fem%mesh%shape(e), merge(2, 1, IS_REDUCED(fem%mesh%state(e)))), &
                                         geometry, row, results)
      end do
   end subroutine add_stresses

   !> Across a plane that may not strain the temperature has a stress of its own, -E alpha (T - T_initial).
   pure subroutine add_thermal_33(fem, rules, results)
      type(fem_t), intent(in) :: fem
      type(point_rule_t), intent(in) :: rules(MOST_NODES, 2)
      type(results_t), intent(inout) :: results
      type(point_geometry_t) :: geometry
      real(wp) :: strain(MOST_POINTS)
      integer(ip) :: row, e, k

      do row = 1, size(results%stress_element, kind=ip)
         e = results%stress_element(row)
         if (STATES(fem%mesh%state(e))%is_thin .or. STATES(fem%mesh%state(e))%has_hoop) cycle
         associate (rule => rules(fem%mesh%shape(e), merge(2, 1, IS_REDUCED(fem%mesh%state(e)))), s => results%stress(:, row))
            k = results%stress_point(row)
            if (k == 1) then
               call fetch_geometry(fem, e, rule, geometry)
               call point_thermal_strains(fem, e, rule, geometry, strain)
            end if
            s(3) = s(3) - thermal_modulus_33(fem%sections(fem%section_of(e)))*strain(k)
            s(5) = von_mises([s(1), s(2), s(4)], s(3))
         end associate
      end do
   end subroutine add_thermal_33

   !> The rows of one element.
   pure subroutine add_element(fem, e, rule, geometry, row, results)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      type(point_rule_t), intent(in) :: rule
      type(point_geometry_t), intent(inout) :: geometry
      integer(ip), intent(inout) :: row              !< the last one filled
      type(results_t), intent(inout) :: results
      real(wp) :: s(MOST_POINTS, COMPONENTS), hoop(MOST_POINTS), s33
      integer(ip) :: k

      call fetch_geometry(fem, e, rule, geometry)
      call point_stresses(fem, e, results%u, rule, geometry, s, hoop)
      do k = 1, rule%n
         row = row + 1
         if (geometry%has_hoop) then
            s33 = hoop(k)
         else
            s33 = stress_33(fem%sections(geometry%section), geometry%state, [s(k, 1), s(k, 2), s(k, 3)])
         end if
         results%stress_element(row) = e
         results%stress_point(row) = k
         results%stress_x(1, row) = fem%mesh%x(1, fem%mesh%nodes(1, e)) + geometry%place(k, 1)
         results%stress_x(2, row) = fem%mesh%x(2, fem%mesh%nodes(1, e)) + geometry%place(k, 2)
         results%stress(1, row) = s(k, 1)
         results%stress(2, row) = s(k, 2)
         results%stress(3, row) = s33
         results%stress(4, row) = s(k, 3)
         results%stress(5, row) = von_mises([s(k, 1), s(k, 2), s(k, 3)], s33)
      end do
   end subroutine add_element

   !> Continuous stresses at the nodes, and the error in the energy norm that they tell. Both want the displacements.
   subroutine estimate_error(fem, results, strain_bound, by_element)
      type(fem_t), intent(in) :: fem                 !< whole scene
      type(results_t), intent(inout) :: results      !< with u; gets nodal_stress, error_estimate, ...
      real(wp), intent(out) :: strain_bound          !< no strain is larger than this
      logical, intent(in) :: by_element              !< the error of each element is kept
      type(stress_field_t) :: field
      type(energies_t) :: energies

      call recover_stress_field(fem, results%u, field)
      call nodal_stresses(fem, field, results%nodal_stress)
      if (by_element .and. .not. allocated(results%element_error)) allocate (results%element_error(fem%mesh%n_elements))
      ! the error is relative; what is not allocated is an optional argument that is not there
      call measure_error(fem, results%u, field, energies, unit_of(results%u), results%element_error)
      results%error_estimate = relative_error(energies)
      strain_bound = energies%strain + 2*largest_thermal_strain(fem)   ! without a strain across the plane 1 + mu of it
   end subroutine estimate_error

end module atrito_recovery
