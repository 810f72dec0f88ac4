!> The rigid motions of bodies: where they take the nodes, which body they move, and how that reads.
!>
!> A body that its supports leave free moves by u = Z a, the columns of Z being its rigid motions (body_t%modes: translations along
!> 1 and 2, and a rotation about the centre of the body times its size, so that all three are lengths). The amplitudes a of all
!> bodies stand one body behind the other, as in bound_qp_t and box_state_t.
module atrito_body_motions
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: bodies_t, body_t, mode_at
   use atrito_kinds, only: ip, wp
   use atrito_row_entries, only: first_motions
   use atrito_strings, only: to_text
   use atrito_threads, only: is_shared
   implicit none (type, external)
   private
   public :: motions_of_bodies, find_moved_body, add_rigid_motions, motion_text, body_text, how_it_moves, is_turn

   real(wp), parameter :: FARTHEST_CENTRE = 1.0e4_wp !< of a rotation, in sizes of the body

contains

   !> Translations along 1 and 2, and rotation, of every body: (3, bodies).
   pure function motions_of_bodies(bodies, a) result(motion)
      type(bodies_t), intent(in) :: bodies           !< with their rigid modes
      real(wp), intent(in) :: a(:)                   !< (k) amplitudes
      real(wp) :: motion(3, bodies%n)
      integer(ip) :: first(bodies%n + 1), b

      first = first_motions(bodies)
      do b = 1, bodies%n
         motion(:, b) = matmul(bodies%list(b)%modes, a(first(b):first(b + 1) - 1))
      end do
   end function motions_of_bodies

   !> The body that moves most, and how.
   !>
   !> For words about a motion of several bodies: one of them is named.
   pure subroutine find_moved_body(bodies, a, b, mode)
      type(bodies_t), intent(in) :: bodies           !< with their rigid modes
      real(wp), intent(in) :: a(:)                   !< (k) amplitudes
      integer(ip), intent(out) :: b                  !< its number
      real(wp), intent(out) :: mode(3)               !< translations along 1 and 2 and rotation, as a column of body%modes
      real(wp) :: motion(3, bodies%n)

      motion = motions_of_bodies(bodies, a)
      b = maxloc(norm2(motion, dim=1), dim=1, kind=ip)
      mode = motion(:, b)
   end subroutine find_moved_body

   !> u <- u + Z a at the free dofs.
   !>
   !> Motions are told as translations of the centre and a rotation about it, so each node costs three products.
   subroutine add_rigid_motions(fem, a, u)
      type(fem_t), intent(in) :: fem !< bodies and elements
      real(wp), intent(in) :: a(:)   !< (k) amplitudes of all bodies' modes
      real(wp), intent(inout) :: u(:, :)             !< (2, n_nodes) [L]
      real(wp) :: motion(3, fem%bodies%n)
      integer(ip) :: b, i

      motion = motions_of_bodies(fem%bodies, a)
      do b = 1, fem%bodies%n
         associate (body => fem%bodies%list(b))
            if (size(body%modes, 2) == 0) cycle
            !$omp parallel do schedule(static) if (is_shared(size(body%nodes, kind=ip)))
            do i = 1, size(body%nodes, kind=ip)
               call move_node(fem, body, motion(:, b), body%nodes(i), u(:, body%nodes(i)))
            end do
            !$omp end parallel do
         end associate
      end do
   end subroutine add_rigid_motions

   pure subroutine move_node(fem, body, mode, node, u)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      real(wp), intent(in) :: mode(3)
      integer(ip), intent(in) :: node
      real(wp), intent(inout) :: u(2)
      integer(ip) :: dof

      do dof = 1, 2
         if (fem%bodies%equation(dof, node) /= 0) u(dof) = u(dof) + mode_at(body, mode, fem%mesh%x(:, node), dof)
      end do
   end subroutine move_node

   !> A rigid motion of a body in words: 'body BLOCK (node 7 and all others) is free to move along x1'.
   function motion_text(fem, i_body, mode) result(text)
      type(fem_t), intent(in) :: fem !< bodies and elements
      integer(ip), intent(in) :: i_body !< its number in fem%bodies
      real(wp), intent(in) :: mode(3)              !< translations along 1 and 2, rotation
      character(len=:), allocatable :: text

      text = body_text(fem, i_body)//' is free to '//how_it_moves(fem, i_body, mode)
   end function motion_text

   !> 'body BLOCK (node 7 and all others)'
   function body_text(fem, i_body) result(text)
      type(fem_t), intent(in) :: fem !< bodies and elements
      integer(ip), intent(in) :: i_body !< its number in fem%bodies
      character(len=:), allocatable :: text

      associate (body => fem%bodies%list(i_body))
         text = 'body '//body%name//' (node '//to_text(fem%mesh%node_id(body%nodes(1)))//' and all others)'
         if (body%is_rigid) text = 'rigid body '//body%name//' (reference node '//to_text(fem%mesh%node_id(body%nodes(1)))//')'
      end associate
   end function body_text

   !> Whether a motion turns a body: what turns about a point many sizes away moves along a line, as far as the digits tell.
   !>
   !> The centre of rotation is -translation/rotation away from the body's own. Beyond FARTHEST_CENTRE sizes round-off of the
   !> rotation decides where, and the motion is a translation for all that is seen of it.
   pure logical function is_turn(mode)
      real(wp), intent(in) :: mode(3)              !< translations along 1 and 2, rotation at the size of the body

      is_turn = FARTHEST_CENTRE*abs(mode(3)) > norm2(mode(:2))
   end function is_turn

   !> 'rotate about (1, 0)', 'move along x1'
   function how_it_moves(fem, i_body, mode) result(text)
      type(fem_t), intent(in) :: fem !< bodies and elements
      integer(ip), intent(in) :: i_body !< its number in fem%bodies
      real(wp), intent(in) :: mode(3)              !< translations along 1 and 2, rotation
      character(len=:), allocatable :: text
      real(wp), parameter :: SMALL = 1.0e-6_wp     !< the digits of the texts
      real(wp) :: size_of_mode, arm(2), centre(2)

      size_of_mode = maxval(abs(mode))
      associate (body => fem%bodies%list(i_body))
         if (is_turn(mode)) then
            arm = [-mode(2), mode(1)]*body%size/mode(3)
            centre = body%centre + arm
            where (abs(centre) < SMALL*max(body%size, abs(arm))) centre = 0.0_wp
            text = 'rotate about ('//to_text(centre(1))//', '//to_text(centre(2))//')'
         else if (abs(mode(2)) <= SMALL*size_of_mode) then
            text = 'move along x1'
         else if (abs(mode(1)) <= SMALL*size_of_mode) then
            text = 'move along x2'
         else
            text = 'move along ('//to_text(mode(1)/norm2(mode(:2)))//', '//to_text(mode(2)/norm2(mode(:2)))//')'
         end if
      end associate
   end function how_it_moves

end module atrito_body_motions
