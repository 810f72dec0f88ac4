!> The rows of the unknown contact forces by their entries: over the displacements of the bodies, and over their rigid motions.
!>
!> The displacements of a body are u = u_e + Z a, u_e those of its dofs with equations, Z its rigid motions that supports leave (two
!> translations and a rotation, of size one at the body's size), a their amplitudes. An unknown i at point j, along d_i = n_j or
!> T_j, has on the node k of its row the vector b_ik = c_jk d_i (and what atrito_turning_rows adds). Its row is
!>
!>     (B u)_i = sum_k b_ik . u_k,     B_i,dof = (b_ik)_dof at the free dofs,     G_im = sum_k b_ik . z_m(x_k) = (B Z)_im,
!>
!> z_m(x_k) being motion m of the node's body, 0 at dofs that are held. B' q are the forces of the contact on the dofs,
!> G' q their work on the motions; the loads f have the work h = Z' f, and a body is in equilibrium where G' q = h.
!> Motions are of size one, so an entry of G below ROUND_OFF is none. Rigid bodies have no equations, only motions.
module atrito_row_entries
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: bodies_t, body_t, mode_at
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t, vector_of_entry, direction_of_entry, turn_of_entry
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: build_constraint_rows, motions_of_row, modes_at_node, first_motions, direction_of, loads_on_motions, work_on_motion

   integer(ip), parameter, public :: MOST_MODES = 3_ip !< of a body
   real(wp), parameter :: ROUND_OFF = 1.0e-13_wp !< motions are of size one: what is below rounding of that is no motion

contains

   !> B by rows, its columns the displacements of one body after the other, then the rigid motions: of all bodies if they are asked
   !> for, else of those alone that have no displacements, so that B' q has all that the forces do to every body.
   !>
   !> Room is made for 2 entries a node and MOST_MODES a body that a row touches, the rows are written one behind the
   !> other, and the room that is left is given back. A row with no entry has no unknown, and is not here.
   pure subroutine build_constraint_rows(fem, rows, line, with_motions, constraints)
      type(fem_t), intent(in) :: fem                !< bodies, and the equation of each dof
      type(contact_rows_t), intent(in) :: rows      !< directions and coefficients
      type(contact_line_t), intent(in) :: line      !< which unknown is of which point
      logical, intent(in) :: with_motions           !< of all bodies; else of rigid ones alone
      type(constraint_rows_t), intent(out) :: constraints !< B, and G behind it
      integer(ip) :: before(fem%bodies%n + 1), first_motion(fem%bodies%n + 1), b, i, at, n

      before(1) = 0
      do b = 1, fem%bodies%n
         before(b + 1) = before(b) + fem%bodies%list(b)%n
      end do
      first_motion = first_motions(fem%bodies) + before(fem%bodies%n + 1)
      constraints%n = size(line%point, kind=ip)
      constraints%n_columns = first_motion(fem%bodies%n + 1) - 1
      constraints%point = line%point
      constraints%to_ground = line%point > line%n - line%n_bilateral .and. &
                              rows%first(line%point + 1) - rows%first(line%point) == 1
      n = 0
      do i = 1, constraints%n
         associate (entries => rows%first(line%point(i) + 1) - rows%first(line%point(i)))
            n = n + 2*entries + MOST_MODES*min(entries, fem%bodies%n)
         end associate
      end do
      allocate (constraints%first(constraints%n + 1), constraints%column(n), constraints%value(n))
      constraints%first(1) = 1
      do i = 1, constraints%n
         at = constraints%first(i)
         call displacements_of_row(n, constraints%column(at:), constraints%value(at:))
         at = at + n
         call motions_of_row(fem, rows, line, i, first_motion, n, constraints%column(at:), constraints%value(at:), &
                             rigid_only=.not. with_motions)
         constraints%to_ground(i) = constraints%to_ground(i) .and. n == 0
         constraints%first(i + 1) = at + n
      end do
      n = constraints%first(constraints%n + 1) - 1
      constraints%column = constraints%column(:n)
      constraints%value = constraints%value(:n)
      if (with_motions) call drop_unseen_motions(before(fem%bodies%n + 1), constraints)

   contains

      !> The entries of a row of B over the displacements: its vectors at the dofs with equations.
      pure subroutine displacements_of_row(n, column, value)
         integer(ip), intent(out) :: n              !< entries
         integer(ip), intent(inout) :: column(:)       !< of the entries
         real(wp), intent(inout) :: value(:)
         real(wp) :: direction(2), vector(2)
         integer(ip) :: k, dof, node

         direction = direction_of(rows, line, i)
         n = 0
         do k = rows%first(line%point(i)), rows%first(line%point(i) + 1) - 1
            node = rows%node(k)
            vector = vector_of_entry(rows, line%point(i), k, direction)
            do dof = 1, 2
               if (vector(dof) == 0.0_wp .or. fem%bodies%equation(dof, node) <= 0) cycle
               n = n + 1
               column(n) = before(fem%bodies%of_node(node)) + fem%bodies%equation(dof, node)
               value(n) = vector(dof)
            end do
         end do
      end subroutine displacements_of_row

   end subroutine build_constraint_rows

   !> A motion that no row sees but for the rounding of coordinates that supports allow it by (find_rigid_modes) is seen
   !> by none: its column of G is set to 0. No equation could be solved for its amplitude.
   pure subroutine drop_unseen_motions(n_displacements, constraints)
      integer(ip), intent(in) :: n_displacements    !< columns before the motions
      type(constraint_rows_t), intent(inout) :: constraints
      real(wp), parameter :: UNSEEN = 1.0e-10_wp
      real(wp) :: seen(n_displacements + 1:constraints%n_columns)
      integer(ip) :: e

      seen = 0.0_wp
      do e = 1, size(constraints%column, kind=ip)
         associate (column => constraints%column(e))
            if (column > n_displacements) seen(column) = max(seen(column), abs(constraints%value(e)))
         end associate
      end do
      do e = 1, size(constraints%column, kind=ip)
         if (constraints%column(e) <= n_displacements) cycle
         if (seen(constraints%column(e)) < UNSEEN) constraints%value(e) = 0.0_wp
      end do
   end subroutine drop_unseen_motions

   !> The entries of a row of G = B Z: G_im = sum_k (c_k d_i + turn) . z_m(x_k) over the nodes k of the row that motion
   !> m moves. Entries below ROUND_OFF are left out.
   pure subroutine motions_of_row(fem, rows, line, i, first_motion, n, motion, value, rigid_only)
      type(fem_t), intent(in) :: fem                !< bodies with their rigid modes
      type(contact_rows_t), intent(in) :: rows      !< directions and coefficients
      type(contact_line_t), intent(in) :: line      !< which unknown is of which point
      integer(ip), intent(in) :: i               !< unknown force
      integer(ip), intent(in) :: first_motion(:) !< (bodies) number of the first motion of each
      integer(ip), intent(out) :: n              !< entries
      integer(ip), intent(inout) :: motion(:)       !< of the entries
      real(wp), intent(inout) :: value(:)           !< of the entries, dimensionless
      logical, intent(in), optional :: rigid_only !< of rigid bodies alone; default .false.
      real(wp) :: direction(2), vector(2), turn(2), z(2, MOST_MODES)
      integer(ip) :: k, node, b, mode, e
      logical :: of_all

      of_all = .true.
      if (present(rigid_only)) of_all = .not. rigid_only
      direction = direction_of(rows, line, i)
      n = 0
      do k = rows%first(line%point(i)), rows%first(line%point(i) + 1) - 1
         node = rows%node(k)
         b = fem%bodies%of_node(node)
         if (b == 0) cycle
         if (.not. (of_all .or. fem%bodies%list(b)%is_rigid)) cycle
         vector = direction_of_entry(rows, line%point(i), k, direction)
         turn = turn_of_entry(rows, line%point(i), k, direction)
         z = modes_at_node(fem, b, node)
         do mode = 1, size(fem%bodies%list(b)%modes, 2, kind=ip)
            e = findloc(motion(:n), first_motion(b) + mode - 1, dim=1, kind=ip)
            if (e == 0) then
               n = n + 1
               e = n
               motion(e) = first_motion(b) + mode - 1
               value(e) = 0.0_wp
            end if
            value(e) = value(e) + rows%coefficient(k)*dot_product(vector, z(:, mode))
            if (any(abs(turn) > 0.0_wp)) value(e) = value(e) + dot_product(turn, z(:, mode))
         end do
      end do
      e = count(abs(value(:n)) >= ROUND_OFF, kind=ip)
      motion(:e) = pack(motion(:n), abs(value(:n)) >= ROUND_OFF)
      value(:e) = pack(value(:n), abs(value(:n)) >= ROUND_OFF)
      n = e
   end subroutine motions_of_row

   !> The motions of a body at one of its nodes; 0 at the dofs that are held, and in the columns of motions that it does not have.
   pure function modes_at_node(fem, b, node) result(z)
      type(fem_t), intent(in) :: fem                !< bodies with their rigid modes
      integer(ip), intent(in) :: b, node            !< body, one of its nodes
      real(wp) :: z(2, MOST_MODES)
      integer(ip) :: dof, j

      z = 0.0_wp
      associate (body => fem%bodies%list(b))
         do j = 1, size(body%modes, 2, kind=ip)
            do dof = 1, 2
               if (fem%bodies%equation(dof, node) /= 0) z(dof, j) = mode_at(body, body%modes(:, j), fem%mesh%x(:, node), dof)
            end do
         end do
      end associate
   end function modes_at_node

   !> The first rigid motion of each body when they are counted from 1 on, and one more than there are.
   pure function first_motions(bodies) result(first)
      type(bodies_t), intent(in) :: bodies !< with their rigid modes
      integer(ip) :: first(bodies%n + 1), b

      first(1) = 1
      do b = 1, bodies%n
         first(b + 1) = first(b) + size(bodies%list(b)%modes, 2, kind=ip)
      end do
   end function first_motions

   !> Unit vector along which an unknown force acts: the normal of its point, if the unknown is the normal one there, or
   !> the tangent.
   pure function direction_of(rows, line, i) result(d)
      type(contact_rows_t), intent(in) :: rows      !< directions and coefficients
      type(contact_line_t), intent(in) :: line      !< which unknown is of which point
      integer(ip), intent(in) :: i               !< unknown force
      real(wp) :: d(2)

      d = rows%tangent(:, line%point(i))
      if (line%normal(line%point(i)) == i) d = rows%normal(:, line%point(i))
   end function direction_of

   !> What forces work on the rigid motions of all bodies, h_m = sum over free dofs of z_m f, and the size of what that
   !> is the sum of, sum |z_m f|.
   !>
   !> A body whose forces balance but for round-off, |h_m| <= 1e-14 of their sizes in all of its motions, rests: it has
   !> no load. The place where a force acts is known to rounding of the coordinates alone, so what turns a body has a
   !> size though all forces act at its centre: at least LEVER times the forces, times the distance of the centre from
   !> the origin over the size of the body.
   pure subroutine loads_on_motions(fem, f, work, work_size)
      type(fem_t), intent(in) :: fem                 !< bodies with their rigid modes
      real(wp), intent(in) :: f(:, :)                !< (2, n_nodes) [F]
      real(wp), intent(out) :: work(:), work_size(:) !< (k) [F]
      real(wp), parameter :: BALANCED = 1.0e-14_wp, LEVER = 0.1_wp
      integer(ip) :: first(fem%bodies%n + 1), b, m
      real(wp) :: all_forces

      first = first_motions(fem%bodies)
      do b = 1, fem%bodies%n
         associate (body => fem%bodies%list(b))
            all_forces = 0.0_wp
            if (first(b + 1) > first(b)) all_forces = sum(hypot(f(1, body%nodes), f(2, body%nodes)))
            do m = first(b), first(b + 1) - 1
               call work_on_motion(fem, body, m - first(b) + 1_ip, f, work(m), work_size(m))
               work_size(m) = max(work_size(m), LEVER*abs(body%modes(3, m - first(b) + 1))*all_forces &
                                  *max(1.0_wp, maxval(abs(body%centre))/body%size))
            end do
            associate (own => work(first(b):first(b + 1) - 1))
               if (all(abs(own) <= BALANCED*work_size(first(b):first(b + 1) - 1))) own = 0.0_wp
            end associate
         end associate
      end do
   end subroutine loads_on_motions

   !> What forces work on a rigid motion, sum over the free dofs of f z; and the size of what that is the sum of, sum |f
   !> z|, by which cancellation is judged.
   pure subroutine work_on_motion(fem, body, mode, f, work, work_size)
      type(fem_t), intent(in) :: fem !< mesh, and which dofs are held
      type(body_t), intent(in) :: body              !< whose motion it is
      integer(ip), intent(in) :: mode               !< column of body%modes
      real(wp), intent(in) :: f(:, :)            !< (2, n_nodes) [F]
      real(wp), intent(out) :: work, work_size   !< [F]
      real(wp) :: term
      integer(ip) :: i, dof

      work = 0.0_wp
      work_size = 0.0_wp
      do i = 1, size(body%nodes, kind=ip)
         do dof = 1, 2
            if (fem%bodies%equation(dof, body%nodes(i)) == 0) cycle
            term = f(dof, body%nodes(i))*mode_at(body, body%modes(:, mode), fem%mesh%x(:, body%nodes(i)), dof)
            work = work + term
            work_size = work_size + abs(term)
         end do
      end do
   end subroutine work_on_motion

end module atrito_row_entries
