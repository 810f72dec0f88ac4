!> Motions in which contact lets a body slide, and the loads on them.
!>
!> Where the supports leave such a motion to a body, nothing but friction resists it, so the rows of its points are turned along it
!> (atrito_sliding_motions); of bodies that are held they stay as they are, and a uniform pressure is carried over exactly.
!>
!> A load has work on such a motion as far as the digits of the deck go: forces through the centre of a pin miss it by a unit of the
!> last digit g of the coordinates, so their moment is known to some g times the sum of their sizes, and along a straight side to g
!> over its length of that sum. Work below that is none, and is taken out of the forces; nothing could resist it, or it would be
!> told that a balanced load moves the body.
module atrito_sliding_bodies
   use atrito_assembly, only: fem_t
   use atrito_bilateral_rows, only: bilateral_rows_t, begin_rows, add_row, trim_rows, ROW_SUPPORT
   use atrito_bodies, only: body_t, mode_at
   use atrito_dense, only: eigen_symmetric
   use atrito_kinds, only: ip, wp
   use atrito_motion_rows, only: DIGIT_ERRORS
   use atrito_points, only: contact_points_t, sliding_t
   use atrito_sliding_motions, only: printed_digit_error
   use atrito_turned_points, only: is_along, turn_points
   implicit none (type, external)
   private
   public :: let_slide, balance_loads, motions_left, turn_supports

   real(wp), parameter :: EXACT = 1.0e-13_wp        !< digit error over extent of a deck that is not rounded to digits

   real(wp), parameter :: NONE_HELD = 1.0e-7_wp     !< what a support sees of a motion that it leaves
   real(wp), parameter :: ON_LINE = 1.0e-14_wp      !< of the rotation that it leaves: what a support on the line sees of it
   real(wp), parameter :: ALL_BUT = 1.0e-3_wp       !< distance from a centre, of the size of a body

contains

   !> Of each pair that slides along itself in a motion that the supports leave to one of its bodies: turns its rows along that, and
   !> notes the motion of the bodies of decks with some digits, whose loads are balanced along it. Sides that are exact as they
   !> stand, as along an axis, leave nothing in doubt.
   subroutine let_slide(rubs, points, fem, bilateral)
      logical, intent(in) :: rubs(:)                !< (pairs) with friction
      type(contact_points_t), intent(inout) :: points(:) !< one a pair
      type(fem_t), intent(inout) :: fem                  !< slides of its bodies are set
      type(bilateral_rows_t), intent(in) :: bilateral    !< rows that hold a body along their directions
      real(wp) :: motion(4)
      integer(ip) :: i, k, b(2)
      logical :: is_free, is_exact

      do i = 1, size(points, kind=ip)
         if (.not. points(i)%sliding%exists) cycle
         if (rubs(i) .and. .not. points(i)%sliding%is_round) then
            if (.not. is_in_slot(fem, bilateral, points, i)) cycle
         end if
         b = bodies_of(fem, points(i))
         is_free = .false.
         is_exact = is_along(points(i)%sliding, fem%mesh, points(i))
         do k = 1, merge(1_ip, 2_ip, b(1) == b(2))
            if (b(k) == 0) cycle
            call turn_about(points(i)%sliding, fem%bodies%list(b(k)))
            motion = motion_of_body(points(i)%sliding, fem%bodies%list(b(k)))
            if (.not. is_left_free(motions_left(fem, bilateral, b(k)), motion)) cycle
            is_free = .true.
            ! along an axis rows are exact, and friction holds what the digits drive
            associate (sliding => points(i)%sliding)
               if (.not. sliding%is_round .and. (rubs(i) .or. any(abs(sliding%direction) <= 0.0_wp))) cycle
               if (sliding%digit_error <= EXACT*sliding%extent) cycle
            end associate
            call add_motion(motion, fem%bodies%list(b(k)))
         end do
         ! the sides of a slot are turned in any case: even the rounding of coordinates with all digits makes a wedge of them
         if (is_free .and. (rubs(i) .or. .not. is_exact)) call turn_points(points(i)%sliding, fem%mesh, points(i))
      end do
   end subroutine let_slide

   !> Whether a body of a pair with straight sides is pressed from the other side as well, and what presses it on both sides is held
   !> by supports: rounding of coordinates would make that slot a wedge, whose forces no load bounds.
   logical function is_in_slot(fem, bilateral, points, i)
      type(fem_t), intent(in) :: fem
      type(bilateral_rows_t), intent(in) :: bilateral !< rows that hold a body along their directions
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      integer(ip), intent(in) :: i                    !< pair
      real(wp), parameter :: OPPOSITE = -0.5_wp
      integer(ip) :: b(2), other(2), k, own, m

      is_in_slot = .false.
      b = bodies_of(fem, points(i))
      do own = 1, 2
         if (b(own) == 0) cycle
         if (.not. is_held(b(3 - own), points(i)%normal(:, 1))) cycle
         do k = 1, size(points, kind=ip)
            if (.not. points(k)%sliding%exists .or. points(k)%sliding%is_round) cycle
            other = bodies_of(fem, points(k))
            m = findloc(other, b(own), dim=1, kind=ip) ! the normal is out of the slave, which is the first of both
            if (m == 0) cycle
            if (dot_product(points(i)%normal(:, 1), points(k)%normal(:, 1))*merge(1, -1, own == m) >= OPPOSITE) cycle
            is_in_slot = is_held(other(3 - m), points(k)%normal(:, 1))
            if (is_in_slot) return
         end do
      end do

   contains

      !> Whether supports hold a body in a direction; 0: a rigid surface.
      logical function is_held(b, n)
         integer(ip), intent(in) :: b                 !< body
         real(wp), intent(in) :: n(2)                 !< unit vector

         is_held = b == 0
         if (.not. is_held) is_held = .not. is_left_free(motions_left(fem, bilateral, b), [n, 0.0_wp, ALL_BUT])
      end function is_held

   end function is_in_slot

   !> The bodies of a pair: those of the first point's first node, which is the slave's, and of its last one, which is the master's
   !> or, of a rigid surface that moves, one that carries its motion; 0: a rigid surface that stays, of which a row has no node.
   pure function bodies_of(fem, points) result(b)
      type(fem_t), intent(in) :: fem
      type(contact_points_t), intent(in) :: points    !< of the pair
      integer(ip) :: b(2)

      b = fem%bodies%of_node(points%entry([1_ip, points%first(2) - 1]))
      if (points%rigid .and. b(1) == b(2)) b(2) = 0
   end function bodies_of

   !> A free body whose middle is all but the centre of the motion is turned about that one: its rotation then moves no row at all,
   !> where the distance between both would leave it the little of a translation, which no equation can be solved for. A rigid
   !> surface turns about its reference node.
   pure subroutine turn_about(sliding, body)
      type(sliding_t), intent(in) :: sliding        !< of a pair
      type(body_t), intent(inout) :: body           !< one of the pair's

      if (.not. sliding%is_round .or. body%is_rigid .or. size(body%modes, 2) < 3) return
      if (maxval(abs(sliding%centre - body%centre)) <= ALL_BUT*body%size) body%centre = sliding%centre
   end subroutine turn_about

   !> The motion as one of the modes of a body, and what work along it is none, over the sum of the forces: a rotation
   !> about c is the body's rotation about its centre o, perp(x - o)/L, and the translation perp(o - c)/L.
   pure function motion_of_body(sliding, body) result(motion)
      type(sliding_t), intent(in) :: sliding        !< of a pair
      type(body_t), intent(in) :: body
      real(wp) :: motion(4), way(2)

      motion(:3) = [sliding%direction, 0.0_wp]
      motion(4) = DIGIT_ERRORS*sliding%digit_error/sliding%extent
      if (.not. sliding%is_round) return
      way = body%centre - sliding%centre
      motion(:3) = [-way(2), way(1), body%size]/body%size
      motion(4) = DIGIT_ERRORS*sliding%digit_error/body%size
   end function motion_of_body

   !> Whether the supports of a body allow a motion, to the digits: what is left of it when its parts along the motions
   !> that they leave are taken out one by one is no more than is in doubt.
   pure logical function is_left_free(modes, motion)
      real(wp), intent(in) :: modes(:, :)           !< (3, motions) that supports leave
      real(wp), intent(in) :: motion(4)             !< from motion_of_body
      real(wp) :: rest(3)
      integer(ip) :: j

      rest = motion(:3)
      do j = 1, size(modes, 2, kind=ip)
         rest = rest - modes(:, j)*(dot_product(modes(:, j), rest)/sum(modes(:, j)**2))
      end do
      is_left_free = maxval(abs(rest)) <= max(motion(4), EXACT)*maxval(abs(motion(:3)))
   end function is_left_free

   !> Adds a motion to those of a body along which its loads are to be balanced, once.
   pure subroutine add_motion(motion, body)
      real(wp), intent(in) :: motion(4)             !< from motion_of_body
      type(body_t), intent(inout) :: body           !< one of the pair's
      integer(ip) :: j

      if (.not. allocated(body%slides)) allocate (body%slides(4, 0))
      do j = 1, size(body%slides, 2, kind=ip)
         if (all(abs(body%slides(:3, j) - motion(:3)) <= motion(4))) return
      end do
      body%slides = reshape([body%slides, motion], [4, size(body%slides, 2) + 1])
   end subroutine add_motion

   !> Takes the work that is none out of the loads.
   pure subroutine balance_loads(fem, f)
      type(fem_t), intent(in) :: fem                !< with slides of its bodies
      real(wp), intent(inout) :: f(:, :)            !< (2, n_nodes) [F]
      integer(ip) :: b, j

      do b = 1, fem%bodies%n
         if (.not. allocated(fem%bodies%list(b)%slides)) cycle
         do j = 1, size(fem%bodies%list(b)%slides, 2, kind=ip)
            call balance_body(fem, fem%bodies%list(b), fem%bodies%list(b)%slides(:, j), f)
         end do
      end do
   end subroutine balance_loads

   !> Takes the work W = sum f . z of the forces on a motion z out of them, where it is none: |W| <= doubt sum |f|. The
   !> least change of the forces does it, f <- f - z W/sum z^2. A rotation of a body with all three motions is taken out
   !> by a couple: forces along the rotation about the mean of the nodes, which have no sum, so that no translation gets
   !> a load by it.
   pure subroutine balance_body(fem, body, motion, f)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      real(wp), intent(in) :: motion(4)             !< from motion_of_body
      real(wp), intent(inout) :: f(:, :)            !< (2, n_nodes) [F]
      real(wp) :: along(2, size(body%nodes)), mean(2), work
      integer(ip) :: i, dof

      do i = 1, size(body%nodes, kind=ip)
         do dof = 1, 2
            along(dof, i) = mode_at(body, motion(:3), fem%mesh%x(:, body%nodes(i)), dof)
            if (fem%bodies%equation(dof, body%nodes(i)) == 0) along(dof, i) = 0.0_wp
         end do
      end do
      work = sum(f(:, body%nodes)*along)
      if (.not. abs(work) <= motion(4)*sum(hypot(f(1, body%nodes), f(2, body%nodes)))) return
      if (size(body%modes, 2) == size(body%modes, 1) .and. abs(motion(3)) > 0.0_wp) then
         mean = sum(along, dim=2)/size(along, 2)
         along = along - spread(mean, 2, size(along, 2))
      end if
      f(:, body%nodes) = f(:, body%nodes) - along*(work/sum(along**2))
   end subroutine balance_body

   !> Rigid motions that all supports leave to a body: a body knows those of its own dofs alone, and supports along
   !> directions of their own (*TRANSFORM) are bilateral rows. So what is asked of motions has one answer however a
   !> scene is turned.
   !>
   !> Z are the motions that the body's own dofs leave, each scaled to size one. A support with the row v_k at the nodes k
   !> sees of a motion
   !>
   !>     r = Z' sum_k v_k(x_k),     and all of them     A = sum r r',
   !>
   !> so the motions that no support sees are Z times the eigenvectors of A with the eigenvalue 0 (below 1e-14 a row,
   !> round-off of the squares).
   !>
   !> The columns are motions as those of body_t: two translations and a rotation.
   function motions_left(fem, bilateral, b) result(left)
      type(fem_t), intent(in) :: fem !< bodies with their rigid modes
      type(bilateral_rows_t), intent(in) :: bilateral !< rows that hold a body along their directions
      integer(ip), intent(in) :: b                  !< body
      real(wp), allocatable :: left(:, :)           !< (3, motions)
      real(wp), allocatable :: seen(:, :)
      integer(ip), allocatable :: rows(:)

      call see_motions(fem, bilateral, b, left, rows, seen, NONE_HELD)
   end function motions_left

   !> The motions that the supports of a body leave, if a support holds none of which it sees no more than `least`; and what
   !> each of its rows sees of them. Squares of less than 1e-7 drown in the rounding of those of other motions, so what is as little
   !> is asked once more of these motions alone.
   subroutine see_motions(fem, bilateral, b, left, rows, seen, least)
      type(fem_t), intent(in) :: fem
      type(bilateral_rows_t), intent(in) :: bilateral
      integer(ip), intent(in) :: b                  !< body
      real(wp), allocatable, intent(out) :: left(:, :) !< (3, motions) orthogonal where there are such rows
      integer(ip), allocatable, intent(out) :: rows(:) !< supports of the body along directions of their own
      real(wp), allocatable, intent(out) :: seen(:, :) !< (motions, rows)
      real(wp), intent(in) :: least                 !< of motions of size one, the root of the mean of the squares
      real(wp), allocatable :: a(:, :), values(:)
      integer(ip) :: i, j, k, dof, mode, n
      integer :: info, pass

      associate (body => fem%bodies%list(b))
         left = body%modes
         n = size(left, 2, kind=ip)
         do mode = 1, n
            left(:, mode) = left(:, mode)/norm2(left(:, mode))
         end do
         rows = pack([(i, i=1, bilateral%n)], [(bilateral%kind(i) == ROW_SUPPORT .and. &
                                                fem%bodies%of_node(bilateral%node(bilateral%first(i))) == b, i=1, bilateral%n)])
         allocate (seen(n, size(rows)), source=0.0_wp)
         if (size(seen) == 0) return
         do j = 1, size(rows, kind=ip)
            do k = bilateral%first(rows(j)), bilateral%first(rows(j) + 1) - 1
               do dof = 1, 2
                  if (fem%bodies%equation(dof, bilateral%node(k)) == 0) cycle
                  seen(:, j) = seen(:, j) + bilateral%vector(dof, k) &
                               *[(mode_at(body, left(:, mode), fem%mesh%x(:, bilateral%node(k)), dof), mode=1, n)]
               end do
            end do
         end do
         do pass = 1, merge(1, 2, least >= NONE_HELD)
            if (n == 0) return
            a = matmul(seen, transpose(seen))
            values = spread(0.0_wp, 1, n)
            call eigen_symmetric(a, values, info)
            if (info /= 0) return
            n = count(values <= size(rows)*merge(max(least, NONE_HELD), least, pass == 1)**2, kind=ip)
            left = matmul(left, a(:, :n))
            seen = matmul(transpose(a(:, :n)), seen)
         end do
      end associate
   end subroutine see_motions

   !> The rows of supports that hold a rotation by the last digits of their nodes alone, turned so that the body may turn.
   !>
   !> Supports along d at nodes of a line along d leave the body the rotation about any place of the line. Of nodes that
   !> are off the line by s_j, less than their last digits tell, row j sees w s_j of the rotation w, and would hold it by
   !> large forces. The rotation is that of the line from its node a to its node b,
   !>
   !>     w = perp(x_b - x_a) . (u_b - u_a)/|x_b - x_a|^2,
   !>
   !> so w s_j is taken out of the row. Supports along a side that rubs stay as they are: they give the slip of its points, and the
   !> body turns about no place of that side.
   subroutine turn_supports(rubs, points, fem, bilateral, turned)
      logical, intent(in) :: rubs(:)                  !< (pairs) with friction
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      type(fem_t), intent(in) :: fem !< bodies with their rigid modes
      type(bilateral_rows_t), intent(in) :: bilateral !< supports along their own directions
      type(bilateral_rows_t), intent(out) :: turned !< all rows
      real(wp) :: off(bilateral%n), across(2, bilateral%n), digit_error
      integer(ip) :: ends(2, bilateral%n), i
      logical :: have(0:fem%bodies%n)

      turned = bilateral
      if (bilateral%n == 0) return
      if (.not. any(bilateral%kind(:bilateral%n) == ROW_SUPPORT)) return
      off = 0.0_wp
      have = have_known_slip(rubs, points, fem, bilateral)
      digit_error = max(printed_digit_error(fem%mesh%x), fem%mesh%digit_error)
      do i = 1, fem%bodies%n
         if (fem%bodies%list(i)%is_rigid .or. have(i)) cycle
         call find_line(fem, bilateral, i, digit_error, off, across, ends)
      end do
      if (all(off == 0.0_wp)) return
      call begin_rows(turned)
      do i = 1, bilateral%n
         associate (node => bilateral%node(bilateral%first(i):bilateral%first(i + 1) - 1), &
                    vector => bilateral%vector(:, bilateral%first(i):bilateral%first(i + 1) - 1), &
                    identity => [bilateral%kind(i), bilateral%group(i), bilateral%part(i)])
            if (off(i) == 0.0_wp) then
               call add_row(node, vector, bilateral%value(i), bilateral%compliance(i), bilateral%weight(i), identity, turned)
            else
               call add_row([node, ends(:, i)], reshape([vector, off(i)*across(:, i), -off(i)*across(:, i)], &
                                                        [2, size(node) + 2]), bilateral%value(i), bilateral%compliance(i), &
                            bilateral%weight(i), identity, turned)
            end if
         end associate
      end do
      call trim_rows(turned)
   end subroutine turn_supports

   !> Of each body, whether a support along a direction of its own holds a node of a point that rubs along that.
   pure function have_known_slip(rubs, points, fem, bilateral) result(have)
      logical, intent(in) :: rubs(:)                  !< (pairs) with friction
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      type(fem_t), intent(in) :: fem
      type(bilateral_rows_t), intent(in) :: bilateral
      logical :: have(0:fem%bodies%n)
      integer(ip) :: row_of(fem%mesh%n_nodes), i, j, k

      have = .false.
      row_of = 0
      do i = 1, bilateral%n
         if (bilateral%kind(i) == ROW_SUPPORT) row_of(bilateral%node(bilateral%first(i))) = i
      end do
      do i = 1, size(points, kind=ip)
         if (.not. rubs(i)) cycle
         do j = 1, points(i)%n
            do k = points(i)%first(j), points(i)%first(j + 1) - 1
               associate (row => row_of(points(i)%entry(k)), body => fem%bodies%of_node(points(i)%entry(k)))
                  if (row == 0) cycle
                  associate (v => bilateral%vector(:, bilateral%first(row)))
                     have(body) = have(body) .or. abs(dot_product(v, points(i)%normal(:, j))) <= ALL_BUT*norm2(v)
                  end associate
               end associate
            end do
         end do
      end do
   end function have_known_slip

   !> How far the supports of a body are off a line along which they leave a rotation; nothing where there is none.
   subroutine find_line(fem, bilateral, b, digit_error, off, across, ends)
      type(fem_t), intent(in) :: fem
      type(bilateral_rows_t), intent(in) :: bilateral
      integer(ip), intent(in) :: b                  !< body
      real(wp), intent(in) :: digit_error           !< of the mesh [L]
      real(wp), intent(inout) :: off(:)             !< (rows) what a row sees of a rotation of one [L]
      real(wp), intent(inout) :: across(:, :)       !< (2, rows) perp(x_b - x_a)/|x_b - x_a|^2 [1/L]
      integer(ip), intent(inout) :: ends(:, :)      !< (2, rows) a and b
      real(wp), allocatable :: left(:, :), seen(:, :)
      integer(ip), allocatable :: rows(:)
      real(wp) :: d(2), doubt, turn
      integer(ip) :: i, k, own_ends(2)

      associate (body => fem%bodies%list(b), x => fem%mesh%x)
         doubt = DIGIT_ERRORS*max(digit_error, printed_digit_error(x(:, body%nodes)))/body%size
         call see_motions(fem, bilateral, b, left, rows, seen, doubt)
         if (size(rows) < 2 .or. size(left) == 0) return
         ! the combination that turns most
         turn = norm2(left(3, :))
         if (.not. turn > ALL_BUT .or. maxval(abs(matmul(left(3, :), seen))) <= ON_LINE*turn) return
         associate (node => bilateral%node(bilateral%first(rows)))
            own_ends = node(1)
            do k = 1, 2
               i = maxloc([(norm2(x(:, node(i)) - x(:, own_ends(2))), i=1, size(node, kind=ip))], dim=1, kind=ip)
               own_ends = [own_ends(2), node(i)]
            end do
         end associate
         d = x(:, own_ends(2)) - x(:, own_ends(1))
         if (.not. norm2(d) > ALL_BUT*body%size) return
         off(rows) = matmul(left(3, :), seen)*(body%size/turn**2)
         across(:, rows) = spread([-d(2), d(1)]/sum(d**2), 2, size(rows))
         ends(:, rows) = spread(own_ends, 2, size(rows))
      end associate
   end subroutine find_line

end module atrito_sliding_bodies
