!> Loads on the motions in which contact lets a body slide.
!>
!> A load has work on such a motion as far as the digits of the deck go: forces through the centre of a pin miss it by a unit of the last
!> digit g of the coordinates, so their moment is known to some g times the sum of their sizes, and along a straight side to g over its
!> length of that sum. Work below that is none, and is taken out of the forces; nothing could resist it, or it would be told that
!> a balanced load moves the body.
module atrito_sliding_loads
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: body_t, mode_at
   use atrito_kinds, only: ip, wp
   use atrito_points, only: contact_points_t, sliding_t
   implicit none (type, external)
   private
   public :: note_sliding, balance_loads

   real(wp), parameter :: GRAINS = 5.0_wp           !< by which the place of a force may be off
   real(wp), parameter :: EXACT = 1.0e-13_wp        !< grain over extent of a deck that is not rounded to digits

contains

   !> Finds of each body the motions in which its contacts let it slide, of decks with some digits.
   subroutine note_sliding(points, fem)
      type(contact_points_t), intent(in) :: points(:)
      type(fem_t), intent(inout) :: fem
      integer(ip) :: i, k, b(2)

      do i = 1, size(points, kind=ip)
         if (.not. points(i)%sliding%exists .or. points(i)%sliding%grain <= EXACT*points(i)%sliding%extent) cycle
         k = points(i)%first(2) - 1                 ! the first point: slave first, master last
         b = fem%bodies%of_node(points(i)%entry([1_ip, k]))
         if (b(1) > 0) call add_motion(points(i)%sliding, fem%bodies%list(b(1)))
         if (b(2) > 0 .and. b(2) /= b(1)) call add_motion(points(i)%sliding, fem%bodies%list(b(2)))
      end do
   end subroutine note_sliding

   !> Adds a motion to those of a body, once, where its supports allow it.
   pure subroutine add_motion(sliding, body)
      type(sliding_t), intent(in) :: sliding
      type(body_t), intent(inout) :: body
      real(wp) :: motion(4), way(2), rest(3)
      integer(ip) :: j

      if (body%is_rigid .or. .not. allocated(body%modes)) return
      motion = 0.0_wp
      motion(4) = GRAINS*sliding%grain/body%size
      if (sliding%is_round) then
         way = body%centre - sliding%centre
         motion(:3) = [-way(2), way(1), body%size]/body%size
      else
         motion(:2) = sliding%direction
         motion(4) = GRAINS*sliding%grain/sliding%extent
      end if
      rest = motion(:3)
      do j = 1, size(body%modes, 2, kind=ip)        ! orthogonal columns
         rest = rest - body%modes(:, j)*(dot_product(body%modes(:, j), rest)/sum(body%modes(:, j)**2))
      end do
      if (maxval(abs(rest)) > motion(4)*maxval(abs(motion(:3)))) return
      if (.not. allocated(body%slides)) allocate (body%slides(4, 0))
      do j = 1, size(body%slides, 2, kind=ip)
         if (all(abs(body%slides(:3, j) - motion(:3)) <= motion(4))) return
      end do
      body%slides = reshape([body%slides, motion], [4, size(body%slides, 2) + 1])
   end subroutine add_motion

   !> Takes the work that is none out of the loads.
   pure subroutine balance_loads(fem, f)
      type(fem_t), intent(in) :: fem
      real(wp), intent(inout) :: f(:, :)            !< (2, n_nodes) [F]
      integer(ip) :: b, j

      do b = 1, fem%bodies%n
         if (.not. allocated(fem%bodies%list(b)%slides)) cycle
         do j = 1, size(fem%bodies%list(b)%slides, 2, kind=ip)
            call balance_body(fem, fem%bodies%list(b), fem%bodies%list(b)%slides(:, j), f)
         end do
      end do
   end subroutine balance_loads

   !> A rotation is taken out by a couple: forces along the rotation about the mean of the nodes, which have no sum.
   pure subroutine balance_body(fem, body, motion, f)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      real(wp), intent(in) :: motion(4)
      real(wp), intent(inout) :: f(:, :)
      real(wp) :: along(2, size(body%nodes)), mean(2), work
      integer(ip) :: i, dof

      do i = 1, size(body%nodes, kind=ip)
         do dof = 1, 2
            along(dof, i) = mode_at(body, motion(:3), fem%mesh%x(:, body%nodes(i)), dof)
            if (fem%bodies%equation(dof, body%nodes(i)) == 0) along(dof, i) = 0.0_wp
         end do
      end do
      work = sum(f(:, body%nodes)*along)
      if (.not. abs(work) <= motion(4)*sum(norm2(f(:, body%nodes), dim=1))) return
      if (size(body%modes, 2) == size(body%modes, 1) .and. abs(motion(3)) > 0.0_wp) then
         mean = sum(along, dim=2)/size(along, 2)
         along = along - spread(mean, 2, size(along, 2))
      end if
      f(:, body%nodes) = f(:, body%nodes) - along*(work/sum(along**2))
   end subroutine balance_body

end module atrito_sliding_loads
