!> Stresses in equilibrium within one element, by Airy functions.
!>
!> A stress s11 = phi,22, s22 = phi,11, s12 = -phi,12 has no divergence, whatever the function phi; where phi has one gradient on
!> both sides of a line, tractions are continuous across it. Along a line with the unit tangent t, in whose direction the body lies
!> on the left, the traction is
!>
!>     T_1 = d(phi,2)/ds,     T_2 = -d(phi,1)/ds,                                        (1)
!>
!> so that tractions of degree k along the sides of an element are gradients of degree k + 1 there. Tractions in equilibrium, forces
!> and moments, make the gradient and phi come back to where they began when one goes once round the element: then, and only then,
!> there is such a phi.
!>
!> Inside it is a piecewise polynomial of degree d = k + 2 with one gradient everywhere: on a triangle cut into three from its
!> centroid (Hsieh, Clough and Tocher), on a convex quadrilateral cut by its diagonals (Fraeijs de Veubeke, Sander). Of degree 3 (k
!> = 1) it is unique; of degree 4 (k = 2) each of the pieces has one free number, a bubble, which is chosen so that the energy is
!> least.
!>
!> A polynomial of degree d on a triangle is given by its Bernstein coefficients c(a, b, c), a + b + c = d. With corners v1 and v2
!> on the element's side and the inner point as the third one, those with c = 0 are phi along the side, those with c = 1 follow from
!> its gradient,
!>
!>     c(a, b, 1) = c(a+1, b, 0) + (v3 - v1).g(b)/d,   g: Bernstein coefficients of the gradient along the side;
!>
!> the rest from the condition that the gradient is the same on both sides of each inner line: where p v0 + q v2 + r v1 + s v3 = 0
!> with p + q + r + s = 0 (v0, v2 beside the line from v1 to v3), the coefficients at the corresponding places have the same
!> relation. So all of them are sums of what is given on the outline, without a system of equations.
module atrito_airy_stress
   use atrito_kinds, only: ip, wp
   use atrito_natural_places, only: cross
   use atrito_plane_state, only: COMPONENTS
   implicit none (type, external)
   private
   public :: macro_t, make_macro, outline_of_tractions, go_along, side_place, piece_values, volume_tractions, MOST_OUTLINE, &
             MOST_UNKNOWNS, MOST_COEFFICIENTS, MOST_PIECES

   integer(ip), parameter :: MOST_PIECES = 4, MOST_DEGREE = 2
   !> Numbers of the outline of an element: phi and its gradient at each corner, 2k - 1 at each side; and with the bubbles.
   integer(ip), parameter :: MOST_OUTLINE = MOST_PIECES*(3 + 3), MOST_UNKNOWNS = MOST_OUTLINE + MOST_PIECES
   !> Bernstein coefficients of the stress on a piece.
   integer(ip), parameter :: MOST_COEFFICIENTS = 6

   !> The stress in an element as a sum over the numbers of its outline.
   !>
   !> At corner i stand phi, phi,1, phi,2; behind all corners at side i, from corner i to the next one, the k inner Bernstein
   !> coefficients of the outward derivative along it, and where k = 2 the middle one of phi; then the bubbles.
   type :: macro_t
      integer(ip) :: n = 0                          !< corners, sides and pieces
      integer(ip) :: degree = 0                     !< k, of the stress
      integer(ip) :: n_outline = 0, n_unknowns = 0
      integer(ip) :: n_coefficients = 0             !< of a piece
      real(wp) :: corner(2, MOST_PIECES) = 0.0_wp   !< [L] relative to the first one
      real(wp) :: centre(2) = 0.0_wp                !< the inner point [L]
      real(wp) :: area(MOST_PIECES) = 0.0_wp        !< [L^2]
      !> Bernstein coefficients of s11, s22, s12: (unknown, component, coefficient, piece) [1/L^2 and so on]
      real(wp), allocatable :: stress(:, :, :, :)
   end type macro_t

   !> Exponents of the Bernstein polynomials of degree 1 and 2, in the order of the coefficients.
   integer(ip), parameter, public :: EXPONENTS(3, MOST_COEFFICIENTS, MOST_DEGREE) = reshape([integer(ip) :: &
                                                                             1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, &
                                                                            2, 0, 0, 0, 2, 0, 0, 0, 2, 1, 1, 0, 0, 1, 1, 1, 0, 1], &
                                                                                            [3, MOST_COEFFICIENTS, MOST_DEGREE])
   integer(ip), parameter :: N_COEFFICIENTS(MOST_DEGREE) = [3_ip, 6_ip]

contains

   !> The first of the numbers of a side among those of the outline.
   pure integer(ip) function side_place(n, degree, side)
      integer(ip), intent(in) :: n                  !< corners
      integer(ip), intent(in) :: degree             !< k
      integer(ip), intent(in) :: side

      side_place = 3*n + (2*degree - 1)*(side - 1) + 1
   end function side_place

   !> The stress in a convex element with straight sides.
   pure subroutine make_macro(corner, degree, macro)
      real(wp), intent(in) :: corner(:, :)          !< (2, 3 or 4) counter-clockwise [L]
      integer(ip), intent(in) :: degree             !< k: 1, 2
      type(macro_t), intent(inout) :: macro         !< what is allocated serves again
      real(wp) :: along(MOST_UNKNOWNS, 0:MOST_DEGREE + 2, MOST_PIECES)   ! phi on the sides
      real(wp) :: next(MOST_UNKNOWNS, 0:MOST_DEGREE + 1, MOST_PIECES)    ! the layer of coefficients beside them
      real(wp) :: inner(MOST_UNKNOWNS, 0:MOST_DEGREE + 2, MOST_PIECES)   ! along the line from a corner to the inner point
      integer(ip) :: i, n
      logical :: fits
      real(wp) :: s

      n = size(corner, 2, kind=ip)
      macro%n = n
      macro%degree = degree
      macro%n_outline = n*(3 + 2*degree - 1)
      ! Of the outline, and bubbles.
      macro%n_unknowns = n*(2*degree + 2) + merge(n, 0_ip, degree == 2)
      macro%n_coefficients = N_COEFFICIENTS(degree)
      fits = allocated(macro%stress)
      if (fits) fits = size(macro%stress, 1) == macro%n_unknowns
      if (.not. fits) then
         if (allocated(macro%stress)) deallocate (macro%stress)
         allocate (macro%stress(macro%n_unknowns, COMPONENTS, macro%n_coefficients, n))
      end if
      do i = 1, n
         macro%corner(:, i) = corner(:, i) - corner(:, 1)
      end do
      ! Where the pieces meet: the centroid, or where the diagonals cross.
      associate (v => macro%corner(:, :n))
         if (size(v, 2) == 3) then
            macro%centre = sum(v, dim=2)/3
         else
            s = cross(v(:, 2) - v(:, 1), v(:, 4) - v(:, 2))/cross(v(:, 3) - v(:, 1), v(:, 4) - v(:, 2))
            macro%centre = v(:, 1) + s*(v(:, 3) - v(:, 1))
         end if
      end associate
      do i = 1, n
         macro%area(i) = 0.5_wp*cross(macro%corner(:, after(i, n)) - macro%corner(:, i), macro%centre - macro%corner(:, i))
      end do
      do i = 1, n
         call take_side(macro, i, along(:, :, i), next(:, :, i))
      end do
      call go_inside(macro, next, along, inner)
      do i = 1, n
         call differentiate(macro, i, along(:, :, i), next(:, :, i), inner)
      end do
   end subroutine make_macro

   !> Bernstein coefficients of phi along a side, and the layer beside them, over the numbers of the outline.
   pure subroutine take_side(macro, i, along, next)
      type(macro_t), intent(in) :: macro
      integer(ip), intent(in) :: i                  !< side
      real(wp), intent(out) :: along(MOST_UNKNOWNS, 0:MOST_DEGREE + 2), next(MOST_UNKNOWNS, 0:MOST_DEGREE + 1)
      real(wp) :: t(2), normal(2), length, along_t, across
      integer(ip) :: j, k, d, n, here, there, place

      k = macro%degree
      d = k + 2
      here = 3*i - 2
      there = 3*after(i, macro%n) - 2
      t = macro%corner(:, after(i, macro%n)) - macro%corner(:, i)
      length = norm2(t)
      t = t/length
      normal = [t(2), -t(1)]
      place = side_place(macro%n, k, i)
      n = macro%n_unknowns
      along(:n, :d) = 0.0_wp
      along(here, 0) = 1.0_wp
      along(here, 1) = 1.0_wp
      along(here + 1:here + 2, 1) = t*(length/d)
      along(there, d) = 1.0_wp
      along(there, d - 1) = 1.0_wp
      along(there + 1:there + 2, d - 1) = -t*(length/d)
      if (k == 2) along(place + k, 2) = 1.0_wp
      along_t = dot_product(macro%centre - macro%corner(:, i), t)/length
      across = dot_product(macro%centre - macro%corner(:, i), normal)/d
      do j = 0, k + 1                               ! with the derivative along t, and that along the normal
         next(:n, j) = along(:n, j) + along_t*(along(:n, j + 1) - along(:n, j))
         if (j == 0) then
            next(here + 1:here + 2, j) = next(here + 1:here + 2, j) + across*normal
         else if (j == k + 1) then
            next(there + 1:there + 2, j) = next(there + 1:there + 2, j) + across*normal
         else
            next(place + j - 1, j) = next(place + j - 1, j) + across
         end if
      end do
   end subroutine take_side

   !> The coefficients along the inner lines, from the corners to the inner point.
   pure subroutine go_inside(macro, next, along, inner)
      type(macro_t), intent(in) :: macro
      real(wp), intent(in) :: next(MOST_UNKNOWNS, 0:MOST_DEGREE + 1, MOST_PIECES)
      real(wp), intent(in) :: along(MOST_UNKNOWNS, 0:MOST_DEGREE + 2, MOST_PIECES)
      real(wp), intent(out) :: inner(MOST_UNKNOWNS, 0:MOST_DEGREE + 2, MOST_PIECES)
      real(wp) :: w(3, MOST_PIECES)
      integer(ip) :: i, m, d, n, before

      d = macro%degree + 2
      n = macro%n_unknowns
      do i = 1, macro%n
         inner(:n, 0, i) = along(:n, 0, i)
         inner(:n, 1, i) = next(:n, 0, i)
         w(:, i) = relation(macro%corner(:, after(i + macro%n - 2, macro%n)), macro%corner(:, after(i, macro%n)), &
                            macro%corner(:, i), macro%centre)
      end do
      do m = 1, d - 1
         do i = 1, macro%n
            before = after(i + macro%n - 2, macro%n)
            if (m == 1) then
               inner(:n, m + 1, i) = w(1, i)*next(:n, macro%degree, before) + w(2, i)*next(:n, 1, i) + w(3, i)*inner(:n, m, i)
            else if (m == d - 1) then
               inner(:n, m + 1, i) = w(1, i)*inner(:n, m, before) + &
                                     w(2, i)*inner(:n, m, after(i, macro%n)) + w(3, i)*inner(:n, m, i)
            else                                    ! bubbles
               inner(:n, m + 1, i) = w(3, i)*inner(:n, m, i)
               inner(macro%n_outline + before, m + 1, i) = w(1, i)
               inner(macro%n_outline + i, m + 1, i) = w(2, i)
            end if
         end do
      end do
   end subroutine go_inside

   !> The weights of v0, v2, v1 whose sum is v3, their own being 1.
   pure function relation(v0, v2, v1, v3) result(w)
      real(wp), intent(in) :: v0(2), v2(2), v1(2), v3(2)
      real(wp) :: w(3)

      ! barycentric coordinates of v3 in the triangle v0 v2 v1
      w = [cross(v2 - v3, v1 - v3), cross(v1 - v3, v0 - v3), cross(v0 - v3, v2 - v3)]
      w = w/sum(w)
   end function relation

   !> Second derivatives on a piece: the stress.
   !>
   !> With d11, d12, d22 the second differences of the coefficients towards corners 1 and 2 from the inner point, and g the
   !> gradients of the barycentric coordinates of these corners, the second derivatives of phi are d(d - 1) sum d_rs g_r g_s.
   pure subroutine differentiate(macro, i, along, next, inner)
      type(macro_t), intent(inout) :: macro
      integer(ip), intent(in) :: i                  !< piece
      real(wp), intent(in) :: along(MOST_UNKNOWNS, 0:MOST_DEGREE + 2), next(MOST_UNKNOWNS, 0:MOST_DEGREE + 1)
      real(wp), intent(in) :: inner(MOST_UNKNOWNS, 0:MOST_DEGREE + 2, MOST_PIECES)
      real(wp) :: c(MOST_UNKNOWNS, 0:MOST_DEGREE + 2, 0:MOST_DEGREE + 2) ! by the exponents of corner 2 and of the inner point
      real(wp) :: g(2), h(2), w(COMPONENTS, 3), d11, d12, d22
      integer(ip) :: j, k, d, m, n, p, q

      d = macro%degree + 2
      n = macro%n_unknowns
      do m = 2, d
         c(:n, d - m, m) = inner(:n, m, after(i, macro%n))
         c(:n, 0, m) = inner(:n, m, i)
      end do
      if (d == 4) then                              ! the bubble
         c(:n, 1, 2) = 0.0_wp
         c(macro%n_outline + i, 1, 2) = 1.0_wp
      end if
      c(:n, :d, 0) = along(:n, :d)
      c(:n, :d - 1, 1) = next(:n, :d - 1)
      g = macro%centre - macro%corner(:, after(i, macro%n))
      g = [-g(2), g(1)]*(0.5_wp/macro%area(i))
      h = macro%corner(:, i) - macro%centre
      h = [-h(2), h(1)]*(0.5_wp/macro%area(i))
      w(:, 1) = d*(d - 1)*[g(2)**2, g(1)**2, -g(1)*g(2)]
      w(:, 2) = d*(d - 1)*[2*g(2)*h(2), 2*g(1)*h(1), -(g(1)*h(2) + g(2)*h(1))]
      w(:, 3) = d*(d - 1)*[h(2)**2, h(1)**2, -h(1)*h(2)]
      do k = 1, macro%n_coefficients
         p = EXPONENTS(2, k, macro%degree)
         q = EXPONENTS(3, k, macro%degree)
         do j = 1, n
            d11 = c(j, p, q) - 2*c(j, p, q + 1) + c(j, p, q + 2)
            d12 = c(j, p + 1, q) - c(j, p, q + 1) - c(j, p + 1, q + 1) + c(j, p, q + 2)
            d22 = c(j, p + 2, q) - 2*c(j, p + 1, q + 1) + c(j, p, q + 2)
            macro%stress(j, 1, k, i) = w(1, 1)*d11 + w(1, 2)*d12 + w(1, 3)*d22
            macro%stress(j, 2, k, i) = w(2, 1)*d11 + w(2, 2)*d12 + w(2, 3)*d22
            macro%stress(j, 3, k, i) = w(3, 1)*d11 + w(3, 2)*d12 + w(3, 3)*d22
         end do
      end do
   end subroutine differentiate

   !> The numbers of the outline that tractions along the sides make, (1), with phi and its gradient 0 at the first corner.
   !>
   !> open: what phi, over the longest way from the first corner, and its gradient lack of being 0 again once round, a force; 0 of
   !> tractions that balance.
   pure subroutine outline_of_tractions(corner, traction, outline, open)
      real(wp), intent(in) :: corner(:, :)          !< (2, corners) counter-clockwise [L]
      real(wp), intent(in) :: traction(:, 0:, :)    !< (2, 0:k, sides) Bernstein coefficients, counter-clockwise [F/L]
      real(wp), intent(out) :: outline(:)           !< as macro_t has them
      real(wp), intent(out), optional :: open       !< [F]
      real(wp) :: at_corner(3), farthest
      integer(ip) :: i, n, k

      n = size(corner, 2, kind=ip)
      k = size(traction, 2, kind=ip) - 1
      at_corner = 0.0_wp
      farthest = 0.0_wp
      do i = 1, n
         farthest = max(farthest, norm2(corner(1:2, i)))
         outline(3*i - 2:3*i) = at_corner
         associate (place => side_place(n, k, i))
            call go_along(corner(1:2, after(i, n)) - corner(1:2, i), traction(:, :, i), at_corner, outline(place:place + 2*k - 2))
         end associate
      end do
      if (present(open)) open = max(maxval(abs(at_corner(2:))), abs(at_corner(1))/farthest)
   end subroutine outline_of_tractions

   !> phi and its gradient from one end of a side to the other, and the numbers of the side.
   pure subroutine go_along(side, traction, at_corner, numbers)
      real(wp), intent(in) :: side(2)               !< from its first end to its last [L]
      real(wp), intent(in) :: traction(:, 0:)       !< (2, 0:k) Bernstein coefficients
      real(wp), intent(inout) :: at_corner(3)       !< phi, phi,1, phi,2
      real(wp), intent(out) :: numbers(:)           !< (2k - 1)
      real(wp) :: g(2, 0:MOST_DEGREE + 1), f(0:MOST_DEGREE + 2), t(2), length
      integer(ip) :: j, k

      k = size(traction, 2, kind=ip) - 1
      length = norm2(side)
      t = side/length
      f(0) = at_corner(1)
      g(:, 0) = at_corner(2:)
      do j = 0, k
         g(1, j + 1) = g(1, j) - length/(k + 1)*traction(2, j)
         g(2, j + 1) = g(2, j) + length/(k + 1)*traction(1, j)
      end do
      do j = 0, k + 1
         f(j + 1) = f(j) + length/(k + 2)*dot_product(t, g(:, j))
      end do
      do j = 1, k
         numbers(j) = t(2)*g(1, j) - t(1)*g(2, j)
      end do
      if (k == 2) numbers(k + 1) = f(2)
      at_corner = [f(k + 2), g(:, k + 1)]
   end subroutine go_along

   !> Less what the stress of the forces per volume has along a side, the traction (-b_1 x_1 n_1, -b_2 x_2 n_2).
   pure function volume_tractions(b, from, to, degree) result(traction)
      real(wp), intent(in) :: b(2)                  !< thickness times force per volume [F/L^2]
      real(wp), intent(in) :: from(2), to(2)        !< ends, counter-clockwise, less the element's first node [L]
      integer(ip), intent(in) :: degree
      real(wp) :: traction(2, 0:degree)
      real(wp) :: n(2)
      integer(ip) :: j

      n = [to(2) - from(2), from(1) - to(1)]/norm2(to - from)
      do j = 0, degree
         traction(:, j) = b*(from + real(j, wp)/degree*(to - from))*n
      end do
   end function volume_tractions

   !> Bernstein polynomials at a point of a piece.
   pure function piece_values(degree, lambda) result(b)
      integer(ip), intent(in) :: degree
      real(wp), intent(in) :: lambda(3)             !< barycentric coordinates
      real(wp) :: b(MOST_COEFFICIENTS)

      b = 0.0_wp
      if (degree == 1) then
         b(:3) = lambda
      else
         b(:3) = lambda**2
         b(4:6) = 2*[lambda(1)*lambda(2), lambda(2)*lambda(3), lambda(3)*lambda(1)]
      end if
   end function piece_values

   pure integer(ip) function after(i, n)
      integer(ip), intent(in) :: i, n

      after = 1 + mod(i, n)
   end function after

end module atrito_airy_stress
