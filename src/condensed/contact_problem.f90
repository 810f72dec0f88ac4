!> The contact line of a scene and its bound-constrained QP: C = B F B', G = B Z, g0 and h, summed over the bodies.
module atrito_contact_problem
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_assembly, only: fem_t
   use atrito_average, only: add_identity_rows
   use atrito_bodies, only: mode_at
   use atrito_bound_qp, only: bound_qp_t
   use atrito_condensed_body, only: condensed_body_t, contact_response, add_flexibilities
   use atrito_contact_line, only: contact_line_t, number_unknowns, rest_of
   use atrito_contact_rows, only: contact_rows_t, row_value, vector_of_entry
   use atrito_contact_scales, only: usual_growth
   use atrito_bilateral_rows, only: bilateral_rows_t
   use atrito_friction_law, only: friction_law_t, FRICTION_NONE, FRICTION_LOCAL
   use atrito_model, only: model_t, interaction_t
   use atrito_points, only: contact_points_t
   use atrito_row_entries, only: first_motions, loads_on_motions
   use atrito_surface_average, only: average_rule_t, average_surfaces, count_surface_entries
   implicit none (type, external)
   private
   public :: average_entries, build_line, set_known_points, build_problem, build_flexibility, set_right_hand_sides, &
             add_displacements, motion_body

contains

   !> Points, laws and averages of all pairs, and which points have unknown forces.
   pure subroutine build_line(model, fem, points, rows, value, line)
      type(model_t), intent(in) :: model
      type(fem_t), intent(in) :: fem
      type(contact_points_t), intent(in) :: points(:)
      type(contact_rows_t), intent(in) :: rows
      real(wp), intent(in) :: value(:, :)            !< (2, n_nodes) prescribed displacements [L]
      type(contact_line_t), intent(out) :: line
      logical :: normal_row(rows%n), tangential_row(rows%n)
      integer(ip) :: i, j, first

      line%n = rows%n
      line%n_bilateral = rows%n_bilateral
      allocate (line%weight(line%n), line%delta(line%n), line%law(line%n), line%pair(line%n))
      allocate (line%known_overlap(line%n), line%known_slip(line%n))
      first = 0
      do i = 1, size(points, kind=ip)
         associate (interaction => model%interactions(model%pairs(i)%interaction), last => first + points(i)%n)
            line%pair(first + 1:last) = i
            line%weight(first + 1:last) = points(i)%weight
            line%delta(first + 1:last) = interaction%delta
            line%law(first + 1:last) = law_of(interaction)
            first = last
         end associate
      end do
      call average_surfaces(points, average_rules(model), line%average)
      if (line%n_bilateral > 0) call append_bilateral(model%bilateral, size(points, kind=ip), line)
      do j = 1, line%n
         normal_row(j) = has_unknown(fem, rows, j, rows%normal(:, j)) .and. .not. rows%is_held(1, j)
         tangential_row(j) = has_unknown(fem, rows, j, rows%tangent(:, j)) .and. .not. rows%is_held(2, j)
      end do
      call set_known_points(rows, value, line)
      call number_unknowns(line, normal_row, tangential_row)
   end subroutine build_line

   !> The rows behind the points: without friction, their average their own force.
   pure subroutine append_bilateral(bilateral, n_pairs, line)
      type(bilateral_rows_t), intent(in) :: bilateral
      integer(ip), intent(in) :: n_pairs
      type(contact_line_t), intent(inout) :: line

      associate (n => line%n - line%n_bilateral)
         line%pair(n + 1:) = n_pairs + bilateral%group
         line%weight(n + 1:) = bilateral%weight
         line%delta(n + 1:) = bilateral%compliance*bilateral%weight
         call add_identity_rows(line%n_bilateral, line%average)
      end associate
   end subroutine append_bilateral

   !> The entries of the average over the points of all pairs; an estimate where there are more than `most`.
   pure integer(lp) function average_entries(model, points, most) result(entries)
      type(model_t), intent(in) :: model
      type(contact_points_t), intent(in) :: points(:)
      integer(lp), intent(in) :: most

      entries = count_surface_entries(points, average_rules(model), most)
   end function average_entries

   !> How the pressure of each pair is averaged.
   pure function average_rules(model) result(rules)
      type(model_t), intent(in) :: model
      type(average_rule_t) :: rules(size(model%pairs))
      integer(ip) :: i

      do i = 1, size(model%pairs, kind=ip)
         associate (pair => model%pairs(i), interaction => model%interactions(model%pairs(i)%interaction))
            rules(i) = average_rule_t(interaction%rho, interaction%kernel, pair%slave)
            if (pair%outline > 0) rules(i)%surface = size(model%surfaces, kind=ip) + pair%outline
         end associate
      end do
   end function average_rules

   !> The law of an interaction; without a coefficient there is none, and nothing tangential is built.
   pure type(friction_law_t) function law_of(interaction) result(law)
      type(interaction_t), intent(in) :: interaction

      if (interaction%friction == FRICTION_NONE .or. interaction%nu == 0.0_wp) return
      law%kind = interaction%friction
      law%nu = interaction%nu
      law%eps = interaction%eps
      if (interaction%friction == FRICTION_LOCAL .and. interaction%stick_slope > 0.0_wp) then
         law%compliance = 1.0_wp/interaction%stick_slope
      end if
   end function law_of

   !> True when the row of a point has an entry on a free dof. (A matrix entry could vanish by cancellation; the row tells.)
   pure logical function has_unknown(fem, rows, j, direction)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: j
      real(wp), intent(in) :: direction(2)
      integer(ip) :: k, dof
      real(wp) :: along(2)

      has_unknown = .false.
      do k = rows%first(j), rows%first(j + 1) - 1
         along = vector_of_entry(rows, j, k, direction)
         do dof = 1, 2
            has_unknown = has_unknown .or. (along(dof) /= 0.0_wp .and. fem%bodies%equation(dof, rows%node(k)) /= 0)
         end do
      end do
   end function has_unknown

   !> What the contact line knows of points whose dofs are prescribed. No slip is what round-off leaves of the displacements: those
   !> that are prescribed now, and those of before, from which a support may begin.
   pure subroutine set_known_points(rows, value, line)
      type(contact_rows_t), intent(in) :: rows
      real(wp), intent(in) :: value(:, :)            !< (2, n_nodes) prescribed displacements [L]
      type(contact_line_t), intent(inout) :: line
      integer(ip) :: j

      if (.not. allocated(line%noise)) allocate (line%noise(line%n))
      do j = 1, line%n
         line%known_overlap(j) = row_value(rows, j, rows%normal(:, j), value) - rows%gap(j)
         line%known_slip(j) = row_value(rows, j, rows%tangent(:, j), value)
         line%noise(j) = max(0.0_wp, maxval(abs(value(:, rows%node(rows%first(j):rows%first(j + 1) - 1)))))
      end do
      if (allocated(line%moved)) line%noise = max(line%noise, line%moved)
      line%noise = usual_growth(0_ip, 0.0_wp)*EPS_MACH*line%noise
   end subroutine set_known_points

   !> C, G, g0 and h.
   subroutine build_problem(fem, condensed, rows, line, value, f, problem)
      type(fem_t), intent(in) :: fem
      type(condensed_body_t), intent(in) :: condensed(:)
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: value(:, :)            !< (2, n_nodes) prescribed displacements [L]
      real(wp), intent(in) :: f(:, :)                !< (2, n_nodes) applied forces [F]
      type(bound_qp_t), intent(out) :: problem

      call build_flexibility(fem, condensed, rows, line, problem)
      call set_right_hand_sides(fem, condensed, rows, line, value, f, problem)
   end subroutine build_problem

   !> C and G: the same for all loads.
   subroutine build_flexibility(fem, condensed, rows, line, problem)
      type(fem_t), intent(in) :: fem
      type(condensed_body_t), intent(in) :: condensed(:)
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(bound_qp_t), intent(out) :: problem
      integer(ip) :: m, b

      problem%m = size(line%point, kind=ip)
      problem%n_normal = count(line%normal > 0, kind=ip)
      do b = 1, fem%bodies%n
         problem%k = problem%k + size(fem%bodies%list(b)%modes, 2, kind=ip)
      end do
      m = problem%m
      allocate (problem%c(m, m), problem%g(m, problem%k), source=0.0_wp)
      problem%weight = line%weight(line%point)
      do b = 1, fem%bodies%n
         call add_flexibility(fem, b, condensed(b), rows, line, problem)
      end do
      call add_motions(fem, rows, line, problem)
   end subroutine build_flexibility

   !> g0 and h: what prescribed displacements, loads and rest slips do.
   subroutine set_right_hand_sides(fem, condensed, rows, line, value, f, problem)
      type(fem_t), intent(in) :: fem
      type(condensed_body_t), intent(in) :: condensed(:) !< with their loads
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: value(:, :)            !< (2, n_nodes) prescribed displacements [L]
      real(wp), intent(in) :: f(:, :)                !< (2, n_nodes) applied forces [F]
      type(bound_qp_t), intent(inout) :: problem     !< with C and G
      integer(ip) :: i, b

      if (allocated(problem%g0)) deallocate (problem%g0, problem%h, problem%h_size)
      allocate (problem%g0(problem%m), problem%h(problem%k), problem%h_size(problem%k), source=0.0_wp)
      do i = 1, problem%m
         problem%g0(i) = row_value(rows, line%point(i), direction_of(problem, rows, line, i), value)
         if (i <= problem%n_normal) then
            problem%g0(i) = problem%g0(i) - rows%gap(line%point(i))
         else
            problem%g0(i) = problem%g0(i) - rest_of(line, line%point(i))
         end if
      end do
      do b = 1, fem%bodies%n
         call add_displacements(fem, b, condensed(b), rows, line, problem)
      end do
      call loads_on_motions(fem, f, problem%h, problem%h_size)
   end subroutine set_right_hand_sides

   pure function direction_of(problem, rows, line, i) result(d)
      type(bound_qp_t), intent(in) :: problem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: i
      real(wp) :: d(2)

      if (i <= problem%n_normal) then
         d = rows%normal(:, line%point(i))
      else
         d = rows%tangent(:, line%point(i))
      end if
   end function direction_of

   !> Adds B F f_c of one body to g0: what its load moves the points by.
   subroutine add_displacements(fem, i_body, condensed, rows, line, problem)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      type(condensed_body_t), intent(in) :: condensed
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(bound_qp_t), intent(inout) :: problem
      real(wp), allocatable :: moved(:, :)
      integer(ip) :: dofs(2*rows%longest), j, n
      real(wp) :: coefficients(size(dofs))

      n = fem%bodies%list(i_body)%n_retained
      if (n == 0) return
      moved = condensed%load(size(condensed%load, 1) - n + 1:, :)
      call contact_response(condensed, moved)
      do j = 1, problem%m
         call row_entries(fem, i_body, rows, line%point(j), direction_of(problem, rows, line, j), dofs, coefficients)
         problem%g0(j) = problem%g0(j) + sum(coefficients*moved(max(dofs, 1_ip), 1))
      end do
   end subroutine add_displacements

   !> Adds B F B' of one body to C.
   subroutine add_flexibility(fem, i_body, condensed, rows, line, problem)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body
      type(condensed_body_t), intent(in) :: condensed
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(bound_qp_t), intent(inout) :: problem
      real(wp), allocatable :: forces(:, :)
      integer(ip), allocatable :: first(:), order(:)
      integer(ip) :: i, j, n
      integer(ip) :: dofs(2*rows%longest)
      real(wp) :: coefficients(size(dofs))

      n = fem%bodies%list(i_body)%n_retained
      if (n == 0) return
      allocate (first(problem%m))
      do j = 1, problem%m
         call row_entries(fem, i_body, rows, line%point(j), direction_of(problem, rows, line, j), dofs, coefficients)
         first(j) = minval(dofs, mask=dofs > 0)      ! huge where there is none
      end do
      order = places_in_order(first, n)
      allocate (forces(n, size(order)), source=0.0_wp)
      do i = 1, size(order, kind=ip)
         j = order(i)
         call row_entries(fem, i_body, rows, line%point(j), direction_of(problem, rows, line, j), dofs, coefficients)
         call scatter(dofs, coefficients, forces(:, i))
      end do
      call add_flexibilities(condensed, forces, first(order), order, problem%c)
   end subroutine add_flexibility

   !> The places of the values from 1 to n, in ascending order of the values.
   pure function places_in_order(value, n) result(order)
      integer(ip), intent(in) :: value(:), n
      integer(ip), allocatable :: order(:)
      integer(ip) :: next(n + 1), i, v

      next = 0
      do i = 1, size(value, kind=ip)
         if (value(i) <= n) next(value(i) + 1) = next(value(i) + 1) + 1
      end do
      next(1) = 1
      do v = 1, n
         next(v + 1) = next(v + 1) + next(v)
      end do
      allocate (order(next(n + 1) - 1))
      do i = 1, size(value, kind=ip)
         if (value(i) > n) cycle
         order(next(value(i))) = i
         next(value(i)) = next(value(i)) + 1
      end do
   end function places_in_order

   !> The entries of a row on the contact dofs of a body; dof 0 beyond them.
   pure subroutine row_entries(fem, i_body, rows, point, direction, dofs, coefficients)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: i_body, point
      type(contact_rows_t), intent(in) :: rows
      real(wp), intent(in) :: direction(2)
      integer(ip), intent(out) :: dofs(:)
      real(wp), intent(out) :: coefficients(:)
      integer(ip) :: k, dof, n, node
      real(wp) :: along(2)

      dofs = 0
      coefficients = 0.0_wp
      n = 0
      do k = rows%first(point), rows%first(point + 1) - 1
         node = rows%node(k)
         if (fem%bodies%of_node(node) /= i_body) cycle
         along = vector_of_entry(rows, point, k, direction)
         do dof = 1, 2
            if (fem%bodies%equation(dof, node) <= 0 .or. along(dof) == 0.0_wp) cycle
            n = n + 1
            dofs(n) = fem%bodies%equation(dof, node) - (fem%bodies%list(i_body)%n - fem%bodies%list(i_body)%n_retained)
            coefficients(n) = along(dof)
         end do
      end do
   end subroutine row_entries

   pure subroutine scatter(dofs, coefficients, column)
      integer(ip), intent(in) :: dofs(:)
      real(wp), intent(in) :: coefficients(:)
      real(wp), intent(inout) :: column(:)
      integer(ip) :: k

      do k = 1, size(dofs, kind=ip)
         if (dofs(k) > 0) column(dofs(k)) = column(dofs(k)) + coefficients(k)
      end do
   end subroutine scatter

   !> The rigid motions of all bodies at the points: G = B Z.
   subroutine add_motions(fem, rows, line, problem)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(bound_qp_t), intent(inout) :: problem
      integer(ip) :: column(fem%bodies%n + 1), b, i, k

      column = first_motions(fem%bodies)
      do i = 1, problem%m
         do k = rows%first(line%point(i)), rows%first(line%point(i) + 1) - 1
            b = fem%bodies%of_node(rows%node(k))
            call add_motion_row(fem, b, rows%node(k), &
                                vector_of_entry(rows, line%point(i), k, direction_of(problem, rows, line, i)), &
                                problem%g(i, column(b):column(b + 1) - 1))
         end do
      end do
      call clear_round_off(problem%g)
   end subroutine add_motions

   !> What one entry of a row adds to the row of G: the motions of the body that has the node.
   pure subroutine add_motion_row(fem, b, node, vector, g)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: b, node
      real(wp), intent(in) :: vector(2)              !< of the entry
      real(wp), intent(inout) :: g(:)                !< (motions of the body)
      integer(ip) :: j, dof
      real(wp) :: z

      associate (body => fem%bodies%list(b))
         do j = 1, size(g, kind=ip)
            do dof = 1, 2
               if (fem%bodies%equation(dof, node) == 0) cycle
               z = mode_at(body, body%modes(:, j), fem%mesh%x(:, node), dof)
               g(j) = g(j) + vector(dof)*z
            end do
         end do
      end associate
   end subroutine add_motion_row

   !> Motions are of size one: what is below rounding of that is no motion, nor is one that no point sees but for the rounding of
   !> coordinates that supports allow it by (find_rigid_modes).
   pure subroutine clear_round_off(g)
      real(wp), intent(inout) :: g(:, :)
      real(wp), parameter :: ROUND_OFF = 1.0e-13_wp, UNSEEN = 1.0e-10_wp
      integer(ip) :: j

      where (abs(g) < ROUND_OFF) g = 0.0_wp
      do j = 1, size(g, 2, kind=ip)
         if (all(abs(g(:, j)) < UNSEEN)) g(:, j) = 0.0_wp
      end do
   end subroutine clear_round_off

   !> The body that moves most in a motion of amplitudes a, and its motion as translations and rotation.
   pure subroutine motion_body(fem, a, i_body, mode)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: a(:)
      integer(ip), intent(out) :: i_body
      real(wp), intent(out) :: mode(3)
      real(wp) :: own(3), most
      integer(ip) :: b, first, n

      i_body = 1
      mode = 0.0_wp
      most = -1.0_wp
      n = 0
      first = 1
      do b = 1, fem%bodies%n
         first = first + n
         n = size(fem%bodies%list(b)%modes, 2, kind=ip)
         own = matmul(fem%bodies%list(b)%modes, a(first:first + n - 1))
         if (norm2(own) <= most) cycle
         most = norm2(own)
         i_body = b
         mode = own
      end do
   end subroutine motion_body

end module atrito_contact_problem
