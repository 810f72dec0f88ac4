!> Elements whose corners run clockwise, turned over: meshes of other programs have both.
module atrito_turned_elements
   use atrito_element_table, only: CORNERS_OF
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: turned_nodes, is_clockwise

contains

   !> The nodes of an element the other way round, from the same first corner.
   pure function turned_nodes(nodes) result(turned)
      integer(ip), intent(in) :: nodes(:)              !< as many as the shape has: corners, mid-sides, centre
      integer(ip) :: turned(size(nodes))

      associate (n => CORNERS_OF(size(nodes)))
         turned = nodes
         turned(2:n) = nodes(n:2:-1)
         if (size(nodes) > n) turned(n + 1:2*n) = nodes(2*n:n + 1:-1)
      end associate
   end function turned_nodes

   !> The polygon of the corners has a negative area.
   pure logical function is_clockwise(x)
      real(wp), intent(in) :: x(:, :)                  !< (2, corners) [L]
      real(wp) :: d(2), e(2)

      d = x(:, 3) - x(:, 1)
      e = x(:, size(x, 2)) - x(:, 2)                   ! of a triangle the third corner is the last: the same area
      is_clockwise = d(1)*e(2) - d(2)*e(1) < 0.0_wp
   end function is_clockwise

end module atrito_turned_elements
