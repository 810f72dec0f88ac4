!> A triangle cut into n x n: which pieces there are, their nodes, and where a place of its grid of nodes lies.
!>
!> The grid has the places (i, j), i, j >= 0, i + j <= m; (0, 0), (m, 0) and (0, m) are the corners. Row by row from side 1-2 a
!> piece that stands as its parent does is followed by one that is turned by 180 degrees, but for the last of the row.
module atrito_triangle_pieces
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: piece_of_triangle, piece_nodes, is_piece_on_side, triangle_point, triangles_of_square

contains

   !> The piece k, 0 .. n^2 - 1: its corner at the right angle, in pieces along the sides 1-2 and 1-3, and whether it is turned.
   pure subroutine piece_of_triangle(n, k, place, is_turned)
      integer(ip), intent(in) :: n                  !< pieces along a side
      integer(ip), intent(in) :: k                  !< 0 .. n^2 - 1
      integer(ip), intent(out) :: place(2)          !< of a turned piece (i, j) is the corner opposite to its own first one
      logical, intent(out) :: is_turned             !< by 180 degrees
      integer(ip) :: left, rows

      rows = ceiling(sqrt(real(n*n - k, wp)), ip)   ! from this one on: they have rows^2 pieces
      left = k - (n*n - rows*rows)
      place(2) = n - rows
      place(1) = left/2
      is_turned = mod(left, 2_ip) == 1
   end subroutine piece_of_triangle

   !> The nodes of a piece from its parent's grid: corners counter-clockwise, then mid-sides.
   pure subroutine piece_nodes(grid, degree, place, is_turned, nodes)
      integer(ip), intent(in) :: grid(0:, 0:)       !< (i, j) place of a node, i + j <= n * degree
      integer(ip), intent(in) :: degree             !< of the piece, 1 or 2: intervals of the grid along its side
      integer(ip), intent(in) :: place(2)           !< from piece_of_triangle
      logical, intent(in) :: is_turned              !< from piece_of_triangle
      integer(ip), intent(out) :: nodes(:)          !< (3 or 6)
      integer(ip) :: i, j, way, step

      way = merge(-1, 1, is_turned)
      i = degree*(place(1) + merge(1, 0, is_turned))
      j = degree*(place(2) + merge(1, 0, is_turned))
      step = way*degree
      nodes(:3) = [grid(i, j), grid(i + step, j), grid(i, j + step)]
      if (degree == 2) nodes(4:6) = [grid(i + way, j), grid(i + way, j + way), grid(i, j + way)]
   end subroutine piece_nodes

   !> Whether a piece has part of its parent's side as its own side of that number.
   pure logical function is_piece_on_side(n, k, side)
      integer(ip), intent(in) :: n                  !< pieces along a side
      integer(ip), intent(in) :: k                  !< 0 .. n^2 - 1
      integer(ip), intent(in) :: side               !< 1..3
      integer(ip) :: place(2)
      logical :: is_turned

      call piece_of_triangle(n, k, place, is_turned)
      select case (side)
      case (1)
         is_piece_on_side = place(2) == 0
      case (2)
         is_piece_on_side = place(1) + place(2) == n - 1
      case (3)
         is_piece_on_side = place(1) == 0
      case default
         is_piece_on_side = .false.
      end select
      is_piece_on_side = is_piece_on_side .and. .not. is_turned
   end function is_piece_on_side

   !> The point of a triangle at xi(1) along its side 1-2 and xi(2) along 1-3. Differences are formed first, so that a constant
   !> coordinate stays constant to the last bit.
   pure function triangle_point(x, xi) result(point)
      real(wp), intent(in) :: x(:, :)               !< (2, 3 or 6) [L]
      real(wp), intent(in) :: xi(2)                 !< 0..1 each, and their sum
      real(wp) :: point(2)
      real(wp) :: l(3)
      integer(ip) :: k, next

      l = [1 - xi(1) - xi(2), xi(1), xi(2)]
      point = x(:, 1) + (xi(1)*(x(:, 2) - x(:, 1)) + xi(2)*(x(:, 3) - x(:, 1)))
      if (size(x, 2) == 3) return
      do k = 1, 3                                   ! the middle of a side is off its chord by so much
         next = mod(k, 3_ip) + 1
         point = point + 4*l(k)*l(next)*((x(:, k + 3) - x(:, k)) - 0.5_wp*(x(:, next) - x(:, k)))
      end do
   end function triangle_point

   !> The nodes of the two triangles of a square of 2 x 2 or 3 x 3 nodes, cut from its first corner to its third: the lower one has
   !> the sides 1-2 and 2-3 of the square as its faces 1 and 2, the upper one 3-4 and 4-1. They begin at opposite ends of the cut,
   !> so that in a parallelogram one is the other turned by 180 degrees.
   pure function triangles_of_square(square) result(nodes)
      integer(ip), intent(in) :: square(:, :) !< (2, 2) or (3, 3): place of the node at (i, j)
      integer(ip) :: nodes(3*(size(square, 1) - 1), 2)
      integer(ip) :: n

      n = size(square, 1, kind=ip)
      nodes(:3, 1) = [square(1, 1), square(n, 1), square(n, n)]
      nodes(:3, 2) = [square(n, n), square(1, n), square(1, 1)]
      if (n == 2) return
      nodes(4:, 1) = [square(2, 1), square(3, 2), square(2, 2)]
      nodes(4:, 2) = [square(2, 3), square(1, 2), square(2, 2)]
   end function triangles_of_square

end module atrito_triangle_pieces
