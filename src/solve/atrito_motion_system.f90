!> The rows of the rigid motions from bodies, points and loads: what atrito_certificate judges.
module atrito_motion_system
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: body_t, mode_at
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_growth, only: grow
   use atrito_kinds, only: ip, lp, wp
   use atrito_motion_rows, only: motion_rows_t
   implicit none (type, external)
   private
   public :: build_motion_rows

   real(wp), parameter :: ROUND_OFF = 1.0e-13_wp !< motions are of size one: what is below rounding of that is no motion

contains

   !> G of all unknown forces by rows, and h = Z'f with the size of its terms.
   pure subroutine build_motion_rows(fem, rows, line, f, motions)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: f(:, :)                !< (2, n_nodes) applied forces [F]
      type(motion_rows_t), intent(out) :: motions
      integer(ip) :: first_motion(fem%bodies%n + 1), b, i, n

      first_motion(1) = 1
      do b = 1, fem%bodies%n
         first_motion(b + 1) = first_motion(b) + size(fem%bodies%list(b)%modes, 2, kind=ip)
      end do
      motions%k = first_motion(fem%bodies%n + 1) - 1
      allocate (motions%body(motions%k), motions%work(motions%k), motions%work_size(motions%k))
      do b = 1, fem%bodies%n
         motions%body(first_motion(b):first_motion(b + 1) - 1) = b
         do i = first_motion(b), first_motion(b + 1) - 1
            associate (body => fem%bodies%list(b))
               call add_up_work(fem, body, body%modes(:, i - first_motion(b) + 1), f, motions%work(i), motions%work_size(i))
            end associate
         end do
      end do
      motions%m = size(line%point, kind=ip)
      allocate (motions%first(motions%m + 1), motions%motion(6*motions%m), motions%value(6*motions%m))
      n = 0
      motions%first(1) = 1
      do i = 1, motions%m
         call add_row(fem, rows, line, first_motion, i, n, motions)
         motions%first(i + 1) = n + 1
      end do
      motions%motion = motions%motion(:n)
      motions%value = motions%value(:n)
   end subroutine build_motion_rows

   !> The entries of one unknown: its direction at the nodes of its point, moved by the motions of their bodies.
   pure subroutine add_row(fem, rows, line, first_motion, i, n, motions)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: first_motion(:)
      integer(ip), intent(in) :: i
      integer(ip), intent(inout) :: n                !< entries so far
      type(motion_rows_t), intent(inout) :: motions
      real(wp) :: direction(2)
      integer(ip) :: k, node, b, mode, first

      direction = rows%tangent(:, line%point(i))
      if (line%normal(line%point(i)) == i) direction = rows%normal(:, line%point(i))
      first = n + 1
      do k = 1, rows%entries(line%point(i))
         node = rows%node(k, line%point(i))
         b = fem%bodies%of_node(node)
         if (b == 0) cycle
         do mode = first_motion(b), first_motion(b + 1) - 1
            call add_entry(motions, first, n, mode, rows%coefficient(k, line%point(i)) &
                           *along(fem, fem%bodies%list(b), mode - first_motion(b) + 1_ip, node, direction))
         end do
      end do
      call drop_round_off(motions, first, n)
   end subroutine add_row

   !> The displacement of a node along a direction in a motion of amplitude one, over the free dofs.
   pure real(wp) function along(fem, body, mode, node, direction)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      integer(ip), intent(in) :: mode, node
      real(wp), intent(in) :: direction(2)
      integer(ip) :: dof

      along = 0.0_wp
      do dof = 1, 2
         if (fem%bodies%equation(dof, node) == 0) cycle
         along = along + direction(dof)*mode_at(body, body%modes(:, mode), fem%mesh%x(:, node), dof)
      end do
   end function along

   !> Adds to the entry of a motion in the last row.
   pure subroutine add_entry(motions, first, n, mode, value)
      type(motion_rows_t), intent(inout) :: motions
      integer(ip), intent(in) :: first, mode
      integer(ip), intent(inout) :: n
      real(wp), intent(in) :: value
      integer(ip) :: e

      do e = first, n
         if (motions%motion(e) /= mode) cycle
         motions%value(e) = motions%value(e) + value
         return
      end do
      if (n == size(motions%motion)) then
         call grow(motions%motion, 2_lp*n + 6_lp)
         call grow(motions%value, 2_lp*n + 6_lp)
      end if
      n = n + 1
      motions%motion(n) = mode
      motions%value(n) = value
   end subroutine add_entry

   pure subroutine drop_round_off(motions, first, n)
      type(motion_rows_t), intent(inout) :: motions
      integer(ip), intent(in) :: first
      integer(ip), intent(inout) :: n
      integer(ip) :: e, kept

      kept = first - 1
      do e = first, n
         if (abs(motions%value(e)) < ROUND_OFF) cycle
         kept = kept + 1
         motions%motion(kept) = motions%motion(e)
         motions%value(kept) = motions%value(e)
      end do
      n = kept
   end subroutine drop_round_off

   pure subroutine add_up_work(fem, body, mode, f, work, work_size)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      real(wp), intent(in) :: mode(3), f(:, :)
      real(wp), intent(out) :: work, work_size
      real(wp) :: term
      integer(ip) :: i, dof

      work = 0.0_wp
      work_size = 0.0_wp
      do i = 1, size(body%nodes, kind=ip)
         do dof = 1, 2
            if (fem%bodies%equation(dof, body%nodes(i)) == 0) cycle
            term = f(dof, body%nodes(i))*mode_at(body, mode, fem%mesh%x(:, body%nodes(i)), dof)
            work = work + term
            work_size = work_size + abs(term)
         end do
      end do
   end subroutine add_up_work

end module atrito_motion_system
