!> The energy by which a stress in equilibrium differs from the stress of displacements, within one element,
!>
!>     E(a) = int (s(a) - s_h) : C^-1 (s(a) - s_h) dV,      s(a) = sum over its numbers a of macro_t + s_b,   s_h = C eps(u),
!>
!> a quadratic function of the numbers a of its outline: E = a'H a + 2 g'a + c. s_b is a simple stress that carries the forces per
!> volume, s_b,11 = -b_1 x_1, s_b,22 = -b_2 x_2. Stresses are taken times the thickness, forces per length, so that elements of
!> several thicknesses may lie side by side.
!>
!> The bubbles of stresses of degree 2 are where E is least for the given outline: -H_bb^-1 (H_bo a_o + g_b), which leaves a
!> quadratic function of the outline alone.
module atrito_element_energy
   use atrito_airy_stress, only: macro_t, make_macro, piece_values, EXPONENTS, MOST_COEFFICIENTS, MOST_OUTLINE, MOST_PIECES, &
                                 MOST_UNKNOWNS
   use atrito_assembly, only: fem_t, form_t, take_form
   use atrito_element_table, only: DEGREE_OF, MOST_NODES, SHAPES
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: COMPONENTS, compliance_matrix, elasticity_matrix, thermal_stresses
   use atrito_shape_functions, only: shape_gradients, shape_values
   implicit none (type, external)
   private
   public :: element_energy_t, make_energy, energy_slope, energy_difference, stress_at, volume_tractions, MOST_PLACES

   integer(ip), parameter :: MOST_PLACES = 12       !< of quadrature on a piece
   integer, parameter :: MOST_STEPS = 20            !< of Newton's method

   type, extends(form_t) :: element_energy_t
      type(macro_t) :: macro
      integer(ip) :: n_places = 0
      real(wp) :: bernstein(MOST_COEFFICIENTS, MOST_PLACES) = 0.0_wp
      real(wp) :: weight(MOST_PLACES, MOST_PIECES) = 0.0_wp       !< area over thickness [L]
      real(wp) :: place(2, MOST_PLACES, MOST_PIECES) = 0.0_wp     !< less the first node [L]
      real(wp) :: value(MOST_NODES, MOST_PLACES, MOST_PIECES) = 0.0_wp       !< shape functions
      real(wp) :: field(COMPONENTS, 2*MOST_NODES, MOST_PLACES, MOST_PIECES) = 0.0_wp  !< thickness C B [F/L^2]
      real(wp) :: heat(COMPONENTS) = 0.0_wp         !< thickness times the stress of one degree [F/L]
      real(wp) :: compliance(COMPONENTS, COMPONENTS) = 0.0_wp     !< [L^2/F]
      real(wp) :: h(MOST_UNKNOWNS, MOST_UNKNOWNS) = 0.0_wp
      real(wp) :: bubble(MOST_PIECES, MOST_OUTLINE) = 0.0_wp      !< -H_bb^-1 H_bo
      real(wp) :: inverse(MOST_PIECES, MOST_PIECES) = 0.0_wp      !< H_bb^-1
      real(wp) :: outline(MOST_OUTLINE, MOST_OUTLINE) = 0.0_wp    !< H of the outline, bubbles where E is least
   end type element_energy_t

   !> Points on a triangle by barycentric coordinates, exact to degree 2 and to degree 6 (Dunavant).
   real(wp), parameter :: A = 0.501426509658179_wp, B = 0.249286745170910_wp, C = 0.873821971016996_wp, D = 0.063089014491502_wp
   real(wp), parameter :: P = 0.053145049844817_wp, Q = 0.310352451033784_wp, R = 0.636502499121399_wp
   real(wp), parameter :: FEW(3, 3) = reshape([real(wp) :: 4, 1, 1, 1, 4, 1, 1, 1, 4], [3, 3])/6
   real(wp), parameter :: MANY(3, 12) = reshape([A, B, B, B, A, B, B, B, A, C, D, D, D, C, D, D, D, C, &
                                                 P, Q, R, Q, R, P, R, P, Q, P, R, Q, R, Q, P, Q, P, R], [3, 12])
   real(wp), parameter :: WEIGHTS(12) = [0.116786275726379_wp, 0.116786275726379_wp, 0.116786275726379_wp, &
                                         0.050844906370207_wp, 0.050844906370207_wp, 0.050844906370207_wp, &
                                         0.082851075618374_wp, 0.082851075618374_wp, 0.082851075618374_wp, &
                                         0.082851075618374_wp, 0.082851075618374_wp, 0.082851075618374_wp]

contains

   !> All that does not depend on displacements.
   pure subroutine make_energy(fem, e, degree, energy, part)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      integer(ip), intent(in) :: degree             !< k, of the stresses
      type(element_energy_t), intent(inout) :: energy
      real(wp), intent(in), optional :: part(:, :)  !< (2, 3) of a triangle within the element, less its first node [L]
      real(wp) :: d_matrix(COMPONENTS, COMPONENTS), place(2), xi(2), thickness
      real(wp) :: lambda(3, MOST_PLACES), share(MOST_PLACES)
      real(wp) :: origin(2)
      integer(ip) :: n, i, k, n_corners, n_sides

      call take_form(fem, e, energy%form_t)
      n_corners = SHAPES(energy%shape)%n_corners
      origin = 0.0_wp
      n_sides = n_corners
      if (present(part)) then
         origin = part(:, 1)
         n_sides = 3
         call make_macro(part, degree, energy%macro)
      else
         call make_macro(energy%x(:, :n_corners), degree, energy%macro)
      end if
      associate (section => fem%sections(energy%section))
         thickness = section%thickness
         d_matrix = elasticity_matrix(section, energy%state)*thickness
         energy%compliance = compliance_matrix(section, energy%state)
         associate (stress => thermal_stresses(section, energy%state))
            energy%heat = thickness*section%expansion*stress(:COMPONENTS)
         end associate
      end associate
      n = energy%shape
      if (DEGREE_OF(n) == 1 .and. degree == 1 .and. is_affine(energy%x(:, :n_corners))) then
         energy%n_places = 3
         lambda(:, :3) = FEW
         share(:3) = 1.0_wp/3
      else
         energy%n_places = 12
         lambda = MANY
         share = WEIGHTS
      end if
      do k = 1, energy%n_places
         energy%bernstein(:, k) = piece_values(degree, lambda(:, k))
      end do
      do i = 1, n_sides
         do k = 1, energy%n_places
            place = origin + lambda(1, k)*energy%macro%corner(:, i) + lambda(2, k)*energy%macro%corner(:, 1 + mod(i, n_sides)) &
                    + lambda(3, k)*energy%macro%centre
            energy%place(:, k, i) = place
            energy%weight(k, i) = share(k)*energy%macro%area(i)/thickness
            xi = natural_place(n, energy%x(:, :n), place)
            call take_field(n, energy%x(:, :n), xi, d_matrix, energy%field(:, :2*n, k, i), energy%value(:n, k, i))
         end do
      end do
      call sum_energy(energy)
   end subroutine make_energy

   !> H, and what is left of it without the bubbles.
   pure subroutine sum_energy(energy)
      type(element_energy_t), intent(inout) :: energy
      real(wp) :: mass(MOST_COEFFICIENTS, MOST_COEFFICIENTS), sc(COMPONENTS, MOST_COEFFICIENTS)
      integer(ip) :: i, j, k, l, n, nc

      associate (macro => energy%macro)
         n = macro%n_unknowns
         nc = macro%n_coefficients
         energy%h(:n, :n) = 0.0_wp
         mass(:nc, :nc) = mass_of(macro%degree)
         do i = 1, macro%n
            do l = 1, n
               sc(:, :nc) = matmul(energy%compliance, matmul(macro%stress(:, :nc, i, l), mass(:nc, :nc)))
               sc(:, :nc) = sc(:, :nc)*sum(energy%weight(:energy%n_places, i))
               do k = 1, l
                  energy%h(k, l) = energy%h(k, l) + sum(macro%stress(:, :nc, i, k)*sc(:, :nc))
               end do
            end do
         end do
         do l = 1, n
            energy%h(l, :l) = energy%h(:l, l)
         end do
         k = macro%n_outline
         energy%outline(:k, :k) = energy%h(:k, :k)
         if (n == k) return
         j = n - k
         energy%inverse = 0.0_wp
         do i = 1, j
            energy%inverse(i, i) = 1.0_wp
         end do
         call invert_small(energy%h(k + 1:n, k + 1:n), energy%inverse(:j, :j))
         energy%bubble(:j, :k) = -matmul(energy%inverse(:j, :j), energy%h(k + 1:n, :k))
         energy%outline(:k, :k) = energy%outline(:k, :k) + matmul(energy%h(:k, k + 1:n), energy%bubble(:j, :k))
      end associate
   end subroutine sum_energy

   !> Inverse of a small positive definite matrix, by Gauss and Jordan.
   pure subroutine invert_small(matrix, inverse)
      real(wp), intent(in) :: matrix(:, :)
      real(wp), intent(inout) :: inverse(:, :)      !< in: the unit matrix
      real(wp) :: m(size(matrix, 1), size(matrix, 1)), factor
      integer(ip) :: i, j

      m = matrix
      do i = 1, size(m, 1, kind=ip)
         factor = 1/m(i, i)
         m(i, :) = m(i, :)*factor
         inverse(i, :) = inverse(i, :)*factor
         do j = 1, size(m, 1, kind=ip)
            if (j == i) cycle
            factor = m(j, i)
            m(j, :) = m(j, :) - factor*m(i, :)
            inverse(j, :) = inverse(j, :) - factor*inverse(i, :)
         end do
      end do
   end subroutine invert_small

   !> int B_a B_b over a triangle, over its area: 2 k!^2 (a+b)!/(a! b! (2k+2)!).
   pure function mass_of(degree) result(mass)
      integer(ip), intent(in) :: degree
      real(wp) :: mass(merge(3, 6, degree == 1), merge(3, 6, degree == 1))
      real(wp), parameter :: FACTORIAL(0:6) = [real(wp) :: 1, 1, 2, 6, 24, 120, 720]
      integer(ip) :: i, j

      do i = 1, size(mass, 1, kind=ip)
         do j = 1, size(mass, 1, kind=ip)
            associate (x => EXPONENTS(:, i, degree), y => EXPONENTS(:, j, degree))
               mass(i, j) = 2*FACTORIAL(degree)**2*product(FACTORIAL(x + y))/ &
                            (product(FACTORIAL(x))*product(FACTORIAL(y))*FACTORIAL(2*degree + 2))
            end associate
         end do
      end do
   end function mass_of

   !> The stress of displacements and of forces per volume at a point of a piece, s_b - s_h [F/L].
   pure function given_stress(energy, u, heating, b, k, i) result(s)
      type(element_energy_t), intent(in) :: energy
      real(wp), intent(in) :: u(:)                  !< of its nodes, less those of the first one [L]
      real(wp), intent(in) :: heating(:)            !< of its nodes; size 0: none
      real(wp), intent(in) :: b(2)                  !< thickness times force per volume [F/L^2]
      integer(ip), intent(in) :: k, i               !< point, piece
      real(wp) :: s(COMPONENTS)

      s = -matmul(energy%field(:, :size(u), k, i), u)
      if (size(heating) > 0) s = s + energy%heat*dot_product(heating, energy%value(:size(heating), k, i))
      s(:2) = s(:2) - b*energy%place(:, k, i)
   end function given_stress

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

   !> g and c of the outline alone, the bubbles where E is least; those need their own part of g.
   pure subroutine energy_slope(energy, u, heating, b, g, g_bubble, c)
      type(element_energy_t), intent(in) :: energy
      real(wp), intent(in) :: u(:), heating(:), b(2) !< as given_stress
      real(wp), intent(out) :: g(:)                 !< (n_outline)
      real(wp), intent(out) :: g_bubble(MOST_PIECES)
      real(wp), intent(out) :: c                    !< the rest [F L]
      real(wp) :: t(COMPONENTS, MOST_COEFFICIENTS), s(COMPONENTS), given(COMPONENTS), all_g(MOST_UNKNOWNS)
      integer(ip) :: i, k, l, nc

      all_g = 0.0_wp
      c = 0.0_wp
      associate (macro => energy%macro)
         nc = macro%n_coefficients
         do i = 1, macro%n
            t = 0.0_wp
            do k = 1, energy%n_places
               given = given_stress(energy, u, heating, b, k, i)
               s = energy%weight(k, i)*matmul(energy%compliance, given)
               c = c + dot_product(given, s)
               do l = 1, nc
                  t(:, l) = t(:, l) + energy%bernstein(l, k)*s
               end do
            end do
            do l = 1, macro%n_unknowns
               all_g(l) = all_g(l) + sum(macro%stress(:, :nc, i, l)*t(:, :nc))
            end do
         end do
         k = macro%n_outline
         g = all_g(:k)
         g_bubble = 0.0_wp
         l = macro%n_unknowns - k
         if (l == 0) return
         g_bubble(:l) = all_g(k + 1:macro%n_unknowns)
         g = g + matmul(transpose(energy%bubble(:l, :k)), g_bubble(:l))
         c = c - dot_product(g_bubble(:l), matmul(energy%inverse(:l, :l), g_bubble(:l)))
      end associate
   end subroutine energy_slope

   !> E of an outline, by its stresses point by point: no digits are lost where the stresses nearly agree [F L].
   pure real(wp) function energy_difference(energy, u, heating, b, outline) result(difference)
      type(element_energy_t), intent(in) :: energy
      real(wp), intent(in) :: u(:), heating(:), b(2) !< as given_stress
      real(wp), intent(in) :: outline(:)            !< (n_outline) [F]
      real(wp) :: coefficient(COMPONENTS, MOST_COEFFICIENTS), s(COMPONENTS)
      real(wp) :: g(MOST_OUTLINE), g_bubble(MOST_PIECES), c, all_a(MOST_UNKNOWNS)
      integer(ip) :: i, k, l, n, nc

      associate (macro => energy%macro)
         n = macro%n_outline
         nc = macro%n_coefficients
         all_a(:n) = outline
         l = macro%n_unknowns - n
         if (l > 0) then
            call energy_slope(energy, u, heating, b, g(:n), g_bubble, c)
            all_a(n + 1:n + l) = matmul(energy%bubble(:l, :n), outline) - matmul(energy%inverse(:l, :l), g_bubble(:l))
         end if
         difference = 0.0_wp
         do i = 1, macro%n
            coefficient = 0.0_wp
            do k = 1, macro%n_unknowns
               coefficient(:, :nc) = coefficient(:, :nc) + all_a(k)*macro%stress(:, :nc, i, k)
            end do
            do k = 1, energy%n_places
               s = given_stress(energy, u, heating, b, k, i) + matmul(coefficient(:, :nc), energy%bernstein(:nc, k))
               difference = difference + energy%weight(k, i)*dot_product(s, matmul(energy%compliance, s))
            end do
         end do
      end associate
   end function energy_difference

   !> thickness C eps(u) at a place of an element, temperatures included [F/L].
   pure function stress_at(fem, e, u, xi) result(s)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(in) :: xi(2)
      real(wp) :: s(COMPONENTS)
      real(wp) :: field(COMPONENTS, 2*MOST_NODES), value(MOST_NODES)
      type(form_t) :: form
      integer(ip) :: k, n

      call take_form(fem, e, form)
      n = form%shape
      associate (section => fem%sections(form%section), nodes => fem%mesh%nodes(:n, e))
         call take_field(n, form%x(:, :n), xi, elasticity_matrix(section, form%state)*section%thickness, field(:, :2*n), value(:n))
         s = 0.0_wp
         do k = 2, n
            s = s + matmul(field(:, 2*k - 1:2*k), u(:, nodes(k)) - u(:, nodes(1)))
         end do
         if (.not. allocated(fem%heating)) return
         associate (heat => thermal_stresses(section, form%state))
            s = s - section%thickness*section%expansion*heat(:COMPONENTS)*dot_product(fem%heating(nodes), value(:n))
         end associate
      end associate
   end function stress_at

   !> The stresses that displacements of the nodes make at a place, and the shape functions there.
   pure subroutine take_field(n, x, xi, d_matrix, field, value)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: x(:, :), xi(2), d_matrix(COMPONENTS, COMPONENTS)
      real(wp), intent(out) :: field(:, :)          !< (COMPONENTS, 2n)
      real(wp), intent(out) :: value(:)
      real(wp) :: dn(n, 2), j(2, 2), g(n, 2), det
      integer(ip) :: k

      value = shape_values(n, xi)
      dn = shape_gradients(n, xi)
      j = matmul(x, dn)                             ! dx/dxi
      det = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
      g(:, 1) = (dn(:, 1)*j(2, 2) - dn(:, 2)*j(2, 1))/det
      g(:, 2) = (dn(:, 2)*j(1, 1) - dn(:, 1)*j(1, 2))/det
      do k = 1, n
         field(:, 2*k - 1) = d_matrix(:, 1)*g(k, 1) + d_matrix(:, 3)*g(k, 2)
         field(:, 2*k) = d_matrix(:, 2)*g(k, 2) + d_matrix(:, 3)*g(k, 1)
      end do
   end subroutine take_field

   !> xi of a place, by Newton's method from the middle.
   pure function natural_place(n, x, place) result(xi)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: x(:, :), place(2)
      real(wp) :: xi(2)
      real(wp) :: j(2, 2), r(2), step(2)
      integer :: i

      xi = merge(1.0_wp/3, 0.0_wp, SHAPES(n)%n_corners == 3)
      do i = 1, MOST_STEPS
         r = place - matmul(x, shape_values(n, xi))
         j = matmul(x, shape_gradients(n, xi))
         step = [j(2, 2)*r(1) - j(1, 2)*r(2), j(1, 1)*r(2) - j(2, 1)*r(1)]/(j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1))
         xi = xi + step
         if (maxval(abs(step)) <= 1.0e-13_wp) exit
      end do
   end function natural_place

   !> A triangle or a parallelogram.
   pure logical function is_affine(x)
      real(wp), intent(in) :: x(:, :)

      is_affine = size(x, 2) == 3
      if (.not. is_affine) is_affine = maxval(abs(x(:, 1) - x(:, 2) + x(:, 3) - x(:, 4))) <= 1.0e-12_wp*maxval(abs(x))
   end function is_affine

end module atrito_element_energy
