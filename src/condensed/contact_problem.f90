!> The contact line of a scene and its bound-constrained QP: C = B F B', G = B Z, g0 and h, summed over the bodies.
!>
!> B is the gap operator: its row of an unknown force has what the displacements of the nodes at its point make of the overlap (a
!> normal force) or of the slip (a tangential one). B' q are the nodal forces of q, so with condensed bodies
!> (atrito_condensed_body)
!>
!>     B u = B u_prescribed + B F (f_c - B' q) + B Z a,    r = B u - gap (or rest slip) - D q = g0 - (C + D) q + G a,
!>     g0 = B u_prescribed - gap + B F f_c,    G' q = Z' B' q = Z' f = h    (the forces on each body balance).
!>
!> C and G are the same for all loads: a history makes them once. C is a full matrix of m^2 numbers, since every point of a body
!> moves with every other; F B' costs n^2 operations for each row that a body has.
module atrito_contact_problem
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_assembly, only: fem_t
   use atrito_average, only: add_identity_rows
   use atrito_bound_qp, only: bound_qp_t
   use atrito_condensed_body, only: condensed_body_t, contact_response, add_flexibilities
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_line, only: contact_line_t, share_t, number_unknowns, rest_noise, rest_of
   use atrito_contact_rows, only: contact_rows_t, row_value, vector_of_entry
   use atrito_contact_scales, only: usual_growth
   use atrito_bilateral_rows, only: bilateral_rows_t
   use atrito_friction_law, only: friction_law_t, FRICTION_NONE, FRICTION_LOCAL
   use atrito_model, only: model_t, interaction_t
   use atrito_points, only: contact_points_t
   use atrito_row_entries, only: direction_of, first_motions, loads_on_motions, modes_at_node
   use atrito_surface_average, only: average_rule_t, average_surfaces, count_surface_entries
   implicit none (type, external)
   private
   public :: average_entries, build_line, set_known_points, build_flexibility, set_right_hand_sides, &
             add_displacements

contains

   !> Points, laws and averages of all pairs, and which points have unknown forces.
   !>
   !> A row of which all displacements are prescribed has no unknown force (has_unknown): its overlap and slip are known numbers,
   !> and hard contact asks for them to be admissible. Rows that a support takes the force of (rows%is_held) have none either.
   pure subroutine build_line(model, fem, points, rows, value, line)
      type(model_t), intent(in) :: model !< pairs, interactions and their laws
      type(fem_t), intent(in) :: fem !< bodies and elements
      type(contact_points_t), intent(in) :: points(:) !< one a pair, in the order of rows
      type(contact_rows_t), intent(in) :: rows !< of all points, over nodes
      real(wp), intent(in) :: value(:, :)            !< (2, n_nodes) prescribed displacements [L]
      type(contact_line_t), intent(out) :: line      !< without loads: the overlap of known points is set
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
      ! S_rho as a matrix of the points: W
      call average_surfaces(points, average_rules(model), line%average)
      if (line%n_bilateral > 0) call append_bilateral(model%bilateral, size(points, kind=ip), line)
      do j = 1, line%n
         normal_row(j) = has_unknown(fem, rows, j, rows%normal(:, j)) .and. .not. rows%is_held(1, j)
         tangential_row(j) = has_unknown(fem, rows, j, rows%tangent(:, j)) .and. .not. rows%is_held(2, j)
      end do
      call list_shares(rows, line)
      call set_known_points(rows, value, line)
      call number_unknowns(line, normal_row, tangential_row)
   end subroutine build_line

   !> The part of the friction of points with a known slip that supports along directions of their own take.
   !>
   !> Such a support v . u = value at a node takes forces q v from its loads. The vector b of the node in the tangential row is
   !> along v, so a friction force t w puts b t w = v (b . v/|v|^2) t w there, and the support has so much less.
   pure subroutine list_shares(rows, line)
      type(contact_rows_t), intent(in) :: rows       !< with the supports of nodes
      type(contact_line_t), intent(inout) :: line    !< gets the shares
      type(share_t) :: shares(merge(size(rows%node), 0, any(rows%is_held(2, :))))
      integer(ip) :: j, k, n, row

      n = 0
      do j = 1, merge(rows%n - rows%n_bilateral, 0_ip, allocated(rows%holder))
         if (.not. rows%is_held(2, j)) cycle
         do k = rows%first(j), rows%first(j + 1) - 1
            row = rows%holder(rows%node(k))
            if (row == 0) cycle
            row = rows%n - rows%n_bilateral + row
            n = n + 1
            associate (v => vector_at_node(rows, row, rows%node(k)))
               shares(n) = share_t(j, row, dot_product(vector_of_entry(rows, j, k, rows%tangent(:, j)), v)/sum(v**2))
            end associate
         end do
      end do
      line%shares = shares(:n)
   end subroutine list_shares

   !> What a bilateral row multiplies the displacement of one of its nodes by.
   pure function vector_at_node(rows, row, node) result(vector)
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: row, node
      real(wp) :: vector(2)
      integer(ip) :: k

      vector = 0.0_wp
      do k = rows%first(row), rows%first(row + 1) - 1
         if (rows%node(k) == node) vector = rows%vector(:, k - rows%before_vectors)
      end do
   end function vector_at_node

   !> The rows behind the points: without friction, their average their own force.
   !>
   !> A tie, an equation, a support or a spring is a row with a normal force of either sign; delta/weight is its compliance [L/F],
   !> so that the law of contact p = (overlap)/delta serves it.
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
   !>
   !> LOCAL: t = min(k |u_T|, nu p) sign(u_T), the compliance 1/k of the stick, 0 for exact stick. NONLOCAL, of Oden and Pires: eps
   !> is the elastic slip at the full bound, so the compliance is eps/tau and follows the bound.
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
   !>
   !> N u and T u of a point are rows of B. Where both nodes are held the force at the point goes into the supports.
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
   !>
   !> known_overlap: u_n - gap of the prescribed displacements. known_slip: their u_T, and that of nodes which supports along
   !> directions of their own hold: the share of what such a row asks for less what its other nodes do. noise: round-off of it,
   !> which is no slip.
   pure subroutine set_known_points(rows, value, line)
      type(contact_rows_t), intent(in) :: rows !< of all points, over nodes
      real(wp), intent(in) :: value(:, :)            !< (2, n_nodes) prescribed displacements [L]
      type(contact_line_t), intent(inout) :: line    !< known_overlap, known_slip and noise are replaced
      real(wp) :: asked
      integer(ip) :: i, j

      if (.not. allocated(line%noise)) allocate (line%noise(line%n))
      do j = 1, line%n
         line%known_overlap(j) = row_value(rows, j, rows%normal(:, j), value) - rows%gap(j)
         line%known_slip(j) = row_value(rows, j, rows%tangent(:, j), value)
         line%noise(j) = max(0.0_wp, maxval(abs(value(:, rows%node(rows%first(j):rows%first(j + 1) - 1)))))
      end do
      if (allocated(line%shares)) then
         do i = 1, size(line%shares, kind=ip)
            associate (share => line%shares(i))
               asked = share%part*(rows%gap(share%row) - row_value(rows, share%row, rows%normal(:, share%row), value))
               line%known_slip(share%point) = line%known_slip(share%point) + asked
               line%noise(share%point) = max(line%noise(share%point), abs(asked))
            end associate
         end do
      end if
      if (allocated(line%moved)) line%noise = max(line%noise, line%moved)
      line%noise = usual_growth(0_ip, 0.0_wp)*EPS_MACH*line%noise
   end subroutine set_known_points

   !> C and G: the same for all loads.
   !>
   !> B has few entries a row: those of the slave node and of the master's face. Body by body C takes the rows' parts on the contact
   !> dofs, B_b F_b B_b', so C_ij is the displacement of point i along its row by a unit force at point j, summed over the bodies
   !> that both touch.
   subroutine build_flexibility(fem, condensed, b, rows, line, problem)
      type(fem_t), intent(in) :: fem !< bodies and elements
      type(condensed_body_t), intent(in) :: condensed(:) !< (bodies) factored
      type(constraint_rows_t), intent(in) :: b       !< of the unknowns over displacements (build_constraint_rows)
      type(contact_rows_t), intent(in) :: rows !< of all points, over nodes
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      type(bound_qp_t), intent(out) :: problem !< C, G and weights; g0 and h are not set
      integer(ip) :: motions(fem%bodies%n + 1), before, i

      motions = first_motions(fem%bodies)
      problem%m = size(line%point, kind=ip)
      problem%n_normal = count(line%normal > 0, kind=ip)
      problem%k = motions(fem%bodies%n + 1) - 1
      allocate (problem%c(problem%m, problem%m), problem%g(problem%m, problem%k), source=0.0_wp)
      problem%weight = line%weight(line%point)
      before = 0
      do i = 1, fem%bodies%n
         associate (body => fem%bodies%list(i))
            before = before + body%n
            call add_flexibility(condensed(i), b, before - body%n_retained, body%n_retained, problem%c)
         end associate
      end do
      call add_motions(motions, problem%g)

   contains

      !> The rigid motions of all bodies at the points: G = B Z. Motions are of size one: what is below rounding of that is no
      !> motion, nor is one that no point sees but for the rounding of coordinates that supports allow it by (find_rigid_modes).
      !>
      !> G_ij is what motion j makes of the overlap or slip of row i. Z is zero at dofs that are held.
      subroutine add_motions(first, g)
         integer(ip), intent(in) :: first(:)            !< (bodies + 1) motion of each, the last one behind all
         real(wp), intent(inout) :: g(:, :)             !< (m, k) zero
         real(wp), parameter :: ROUND_OFF = 1.0e-13_wp, UNSEEN = 1.0e-10_wp
         real(wp) :: z(2, 3), vector(2)
         integer(ip) :: b, i, j, k

         do i = 1, size(g, 1, kind=ip)
            do k = rows%first(line%point(i)), rows%first(line%point(i) + 1) - 1
               b = fem%bodies%of_node(rows%node(k))
               if (first(b + 1) == first(b)) cycle
               z = modes_at_node(fem, b, rows%node(k))
               vector = vector_of_entry(rows, line%point(i), k, direction_of(rows, line, i))
               do j = first(b), first(b + 1) - 1
                  g(i, j) = g(i, j) + vector(1)*z(1, j - first(b) + 1)
                  g(i, j) = g(i, j) + vector(2)*z(2, j - first(b) + 1)
               end do
            end do
         end do
         where (abs(g) < ROUND_OFF) g = 0.0_wp
         do j = 1, size(g, 2, kind=ip)
            if (all(abs(g(:, j)) < UNSEEN)) g(:, j) = 0.0_wp
         end do
      end subroutine add_motions

   end subroutine build_flexibility

   !> g0 and h: what prescribed displacements, loads and rest slips do.
   !>
   !> g0 of a normal row is the overlap without contact forces, less the gap: positive where bodies would penetrate. g0 of a
   !> tangential row is the slip without contact forces, less the rest slip of a law with memory.
   subroutine set_right_hand_sides(fem, condensed, b, rows, line, value, f, problem)
      type(fem_t), intent(in) :: fem !< bodies and elements
      type(condensed_body_t), intent(in) :: condensed(:) !< with their loads
      type(constraint_rows_t), intent(in) :: b       !< of the unknowns over displacements
      type(contact_rows_t), intent(in) :: rows !< of all points, over nodes
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      real(wp), intent(in) :: value(:, :)            !< (2, n_nodes) prescribed displacements [L]
      real(wp), intent(in) :: f(:, :)                !< (2, n_nodes) applied forces [F]
      type(bound_qp_t), intent(inout) :: problem     !< with C and G
      integer(ip) :: i

      if (allocated(problem%g0)) deallocate (problem%g0, problem%h, problem%h_size)
      allocate (problem%g0(problem%m), problem%h(problem%k), problem%h_size(problem%k), source=0.0_wp)
      do i = 1, problem%m
         problem%g0(i) = row_value(rows, line%point(i), direction_of(rows, line, i), value)
         if (i <= problem%n_normal) then
            problem%g0(i) = problem%g0(i) - rows%gap(line%point(i))
         else
            problem%g0(i) = problem%g0(i) - rest_of(line, line%point(i))
         end if
      end do
      if (allocated(problem%slip_noise)) deallocate (problem%slip_noise)
      if (allocated(line%rest)) problem%slip_noise = [(0.0_wp, i=1, problem%n_normal), &
                                                      (rest_noise(line, line%point(i)), i=problem%n_normal + 1, problem%m)]
      call add_displacements(fem, condensed, b, problem%g0)
      call loads_on_motions(fem, f, problem%h, problem%h_size)
   end subroutine set_right_hand_sides

   !> Adds B F f_c of all bodies to g0: what their loads move the points by.
   !>
   !> The reduced load f_c stands behind the half-solved interior in the body's load vector. A refinement adds what its residuals do
   !> in the same way.
   subroutine add_displacements(fem, condensed, b, g0)
      type(fem_t), intent(in) :: fem
      type(condensed_body_t), intent(in) :: condensed(:) !< with their loads
      type(constraint_rows_t), intent(in) :: b       !< of the unknowns over displacements
      real(wp), intent(inout) :: g0(:)               !< (m) [L]
      real(wp), allocatable :: moved(:, :)
      integer(ip) :: before, i, j, k
      real(wp) :: change

      before = 0
      do i = 1, fem%bodies%n
         associate (n => fem%bodies%list(i)%n_retained)
            before = before + fem%bodies%list(i)%n
            if (n == 0) cycle
            moved = condensed(i)%load(size(condensed(i)%load, 1) - n + 1:, :)
            call contact_response(condensed(i), moved)
            do j = 1, b%n
               change = 0.0_wp
               do k = b%first(j), b%first(j + 1) - 1
                  associate (dof => b%column(k) - (before - n))
                     if (dof > 0 .and. dof <= n) change = change + b%value(k)*moved(dof, 1)
                  end associate
               end do
               g0(j) = g0(j) + change
            end do
         end associate
      end do
   end subroutine add_displacements

   !> Adds B F B' of one body to C. Rows are taken in the order of their first contact dof: the columns of F B' above it are zero.
   !>
   !> C += (L^-1 B')' (L^-1 B'), L being the Cholesky factor of F^-1: a column of B' that begins with k zeros has k zeros in L^-1
   !> B', which are left out. So a long line, whose rows follow the dofs, costs a third of n^2 operations a row.
   subroutine add_flexibility(condensed, b, before, n, c)
      type(condensed_body_t), intent(in) :: condensed
      type(constraint_rows_t), intent(in) :: b
      integer(ip), intent(in) :: before, n           !< the contact dofs of the body are the columns before + 1 .. before + n of B
      real(wp), intent(inout), contiguous :: c(:, :)
      real(wp), allocatable :: forces(:, :)
      integer(ip), allocatable :: order(:), starts(:)
      integer(ip) :: first(b%n), j, k, place(b%n)

      if (n == 0) return
      do j = 1, b%n
         first(j) = n + 1                            ! where there is none
         do k = b%first(j), b%first(j + 1) - 1
            if (b%column(k) > before) first(j) = min(first(j), b%column(k) - before)
         end do
      end do
      ! rows of this body alone, in the order of their first dof
      call list_holders(n, reshape(merge(first, 0_ip, first <= n), [1_ip, b%n]), starts, order)
      place = 0
      place(order) = [(j, j=1, size(order, kind=ip))]
      allocate (forces(n, size(order)), source=0.0_wp)
      do j = 1, b%n
         do k = b%first(j), b%first(j + 1) - 1
            associate (dof => b%column(k) - before)
               if (dof > 0 .and. dof <= n) forces(dof, place(j)) = forces(dof, place(j)) + b%value(k)
            end associate
         end do
      end do
      call add_flexibilities(condensed, forces, first(order), order, c)
   end subroutine add_flexibility

end module atrito_contact_problem
