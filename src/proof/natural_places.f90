!> Places in an element by its own coordinates, and gradients there.
module atrito_natural_places
   use atrito_element_table, only: MOST_NODES, SHAPES
   use atrito_kinds, only: ip, wp
   use atrito_shape_functions, only: shape_gradients, shape_values
   implicit none (type, external)
   private
   public :: cross, is_affine, natural_place, take_gradients

   integer(ip), parameter :: MOST_STEPS = 20        !< of Newton's method
   real(wp), parameter :: ENOUGH = 1.0e-9_wp        !< its last step

contains

   !> Shape functions at a place, and their gradients.
   pure subroutine take_gradients(n, x, xi, is_heated, g, value)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: x(:, :), xi(2)
      real(wp), intent(out) :: g(:, :)              !< (2, n) [1/L]
      logical, intent(in) :: is_heated              !< shape functions are wanted
      real(wp), intent(inout) :: value(:)
      real(wp) :: dn(MOST_NODES, 2), j(2, 2)
      integer(ip) :: k

      if (is_heated) value(:n) = shape_values(n, xi)
      if (n == 4) then                              ! most there are: at once
         dn(:4, 1) = 0.25_wp*[xi(2) - 1, 1 - xi(2), 1 + xi(2), -1 - xi(2)]
         dn(:4, 2) = 0.25_wp*[xi(1) - 1, -1 - xi(1), 1 + xi(1), 1 - xi(1)]
      else
         dn(:n, :) = shape_gradients(n, xi)
      end if
      j = inverse(jacobian(x, dn(:n, :)))
      do k = 1, n
         g(:, k) = [dn(k, 1)*j(1, 1) + dn(k, 2)*j(2, 1), dn(k, 1)*j(1, 2) + dn(k, 2)*j(2, 2)]
      end do
   end subroutine take_gradients

   !> dx/dxi.
   pure function jacobian(x, dn) result(j)
      real(wp), intent(in) :: x(:, :), dn(:, :)
      real(wp) :: j(2, 2)
      integer(ip) :: k

      j = 0.0_wp
      do k = 1, size(dn, 1, kind=ip)
         j(:, 1) = j(:, 1) + x(:, k)*dn(k, 1)
         j(:, 2) = j(:, 2) + x(:, k)*dn(k, 2)
      end do
   end function jacobian

   pure function inverse(m) result(i)
      real(wp), intent(in) :: m(2, 2)
      real(wp) :: i(2, 2)
      real(wp) :: det

      det = m(1, 1)*m(2, 2) - m(1, 2)*m(2, 1)
      i(:, 1) = [m(2, 2), -m(2, 1)]/det
      i(:, 2) = [-m(1, 2), m(1, 1)]/det
   end function inverse

   !> xi of a place: of an element with straight sides by its corners, and where its centre may be elsewhere, by Newton's method
   !> from there.
   !>
   !> In a quadrilateral r = x - c_1 = c_2 xi + c_3 eta + c_4 xi eta lies along c_3 + c_4 xi from the end of c_2 xi:
   !>
   !>     (r - c_2 xi) x (c_3 + c_4 xi) = 0,  or  r x c_3 - b xi - (c_2 x c_4) xi^2 = 0,    b = c_2 x c_3 - r x c_4,
   !>
   !> b being the Jacobian at (-xi, -eta), which is positive, too.
   pure function natural_place(n, x, place) result(xi)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: x(:, :), place(2)
      real(wp) :: xi(2)
      real(wp) :: j(2, 2), r(2), step(2), c(2, 4), along(2), b, value(MOST_NODES)
      integer(ip) :: i, k

      if (SHAPES(n)%n_corners == 3) then
         j(:, 1) = x(:, 2) - x(:, 1)
         j(:, 2) = x(:, 3) - x(:, 1)
         xi = matmul(inverse(j), place - x(:, 1))
         return
      end if
      c(:, 1) = 0.25_wp*(x(:, 1) + x(:, 2) + x(:, 3) + x(:, 4))
      c(:, 2) = 0.25_wp*(x(:, 2) + x(:, 3) - x(:, 1) - x(:, 4))
      c(:, 3) = 0.25_wp*(x(:, 3) + x(:, 4) - x(:, 1) - x(:, 2))
      c(:, 4) = 0.25_wp*(x(:, 1) + x(:, 3) - x(:, 2) - x(:, 4))
      r = place - c(:, 1)
      b = cross(c(:, 2), c(:, 3)) - cross(r, c(:, 4))
      xi(1) = 2*cross(r, c(:, 3))/(b + sqrt(max(b**2 + 4*cross(r, c(:, 3))*cross(c(:, 2), c(:, 4)), 0.0_wp)))
      along = c(:, 3) + xi(1)*c(:, 4)
      xi(2) = dot_product(r - xi(1)*c(:, 2), along)/dot_product(along, along)
      if (n < 9) return
      do i = 1, MOST_STEPS
         value(:n) = shape_values(n, xi)
         r = place
         do k = 1, n
            r = r - x(:, k)*value(k)
         end do
         j = inverse(jacobian(x, shape_gradients(n, xi)))
         step = [j(1, 1)*r(1) + j(1, 2)*r(2), j(2, 1)*r(1) + j(2, 2)*r(2)]
         xi = xi + step
         if (maxval(abs(step)) <= ENOUGH) exit
      end do
   end function natural_place

   !> a1 b2 - a2 b1: positive where b lies to the left of a.
   pure real(wp) function cross(a, b)
      real(wp), intent(in) :: a(2), b(2) !< of any dimension

      cross = a(1)*b(2) - a(2)*b(1)
   end function cross

   !> A triangle or a parallelogram.
   pure logical function is_affine(x)
      real(wp), intent(in) :: x(:, :)

      is_affine = size(x, 2) == 3
      if (.not. is_affine) is_affine = maxval(abs(x(:, 1) - x(:, 2) + x(:, 3) - x(:, 4))) <= 1.0e-12_wp*maxval(abs(x))
   end function is_affine

end module atrito_natural_places
