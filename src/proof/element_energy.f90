!> The energy by which a stress in equilibrium differs from the stress of displacements, within one element,
!>
!>     E = int (s - s_h) : C^-1 (s - s_h) dV,     s = s(a) + s_b,     s_h = C (eps(u) - alpha T),
!>
!> s(a) the sum over the numbers of its outline (macro_t) and s_b a simple stress that carries the forces per volume, s_b,11 = -b_1
!> x_1, s_b,22 = -b_2 x_2. Stresses are taken times the thickness, forces per length, so that elements of several thicknesses may
!> lie side by side. By quadrature E is a sum of squares,
!>
!>     E = |R_a a + R_x x|^2,     x = (u, T, b):     slope/2 = H a + G x,    H = R_a' R_a,  G = R_a' R_x,
!>
!> the rows being the differences at the points times the roots of their weights and of C^-1 (L' of C^-1 = L L'). Taken as a sum of
!> squares it loses no digits where both stresses nearly agree. The bubbles of stresses of degree 2 are where E is least: all other
!> columns are made orthogonal to theirs, and the bubbles are gone.
module atrito_element_energy
   use atrito_airy_stress, only: macro_t, make_macro, piece_values, MOST_COEFFICIENTS, MOST_PIECES
   use atrito_assembly, only: fem_t, form_t, take_form
   use atrito_dense, only: transposed_product
   use atrito_element_table, only: DEGREE_OF, MOST_NODES, SHAPES
   use atrito_kinds, only: ip, wp
   use atrito_plane_state, only: COMPONENTS, compliance_matrix, elasticity_matrix, thermal_stresses
   use atrito_shape_functions, only: shape_gradients, shape_values
   implicit none (type, external)
   private
   public :: element_energy_t, make_energy, given_rows, energy_difference, volume_tractions, corner_stresses, MOST_GIVEN

   integer(ip), parameter :: MOST_PLACES = 12       !< of quadrature on a piece
   integer(ip), parameter :: MOST_ROWS = COMPONENTS*MOST_PLACES*MOST_PIECES
   !> Displacements and temperatures of the nodes, force per volume.
   integer(ip), parameter :: MOST_GIVEN = 3*MOST_NODES + 2
   integer(ip), parameter :: MOST_STEPS = 20            !< of Newton's method

   type, extends(form_t) :: element_energy_t
      type(macro_t) :: macro
      integer(ip) :: n = 0                          !< numbers of the outline
      integer(ip) :: n_rows = 0, n_given = 0        !< n_given: of x; 2 n_nodes displacements, n_nodes temperatures if any, 2 forces
      !> R_a, and behind it R_x: all columns have n_rows rows, one after the other.
      real(wp), allocatable :: rows(:, :)           !< (n_rows, n + n_given)
      real(wp), allocatable :: slopes(:, :)         !< (n, n + n_given) H, and behind it G
   end type element_energy_t

   !> Points on a triangle by barycentric coordinates and their weights, exact to degree 2, 4 and 6 (Dunavant).
   real(wp), parameter :: A = 0.501426509658179_wp, B = 0.249286745170910_wp, C = 0.873821971016996_wp, D = 0.063089014491502_wp
   real(wp), parameter :: P = 0.053145049844817_wp, Q = 0.310352451033784_wp, R = 0.636502499121399_wp
   real(wp), parameter :: S = 0.108103018168070_wp, T = 0.445948490915965_wp, U = 0.816847572980459_wp, V = 0.091576213509771_wp
   real(wp), parameter :: FEW(3, 3) = reshape([real(wp) :: 4, 1, 1, 1, 4, 1, 1, 1, 4], [3, 3])/6
   real(wp), parameter :: SOME(3, 6) = reshape([S, T, T, T, S, T, T, T, S, U, V, V, V, U, V, V, V, U], [3, 6])
   real(wp), parameter :: MANY(3, 12) = reshape([A, B, B, B, A, B, B, B, A, C, D, D, D, C, D, D, D, C, &
                                                 P, Q, R, Q, R, P, R, P, Q, P, R, Q, R, Q, P, Q, P, R], [3, 12])
   real(wp), parameter :: SOME_WEIGHTS(6) = [0.223381589678011_wp, 0.223381589678011_wp, 0.223381589678011_wp, &
                                             0.109951743655322_wp, 0.109951743655322_wp, 0.109951743655322_wp]
   real(wp), parameter :: MANY_WEIGHTS(12) = [0.116786275726379_wp, 0.116786275726379_wp, 0.116786275726379_wp, &
                                              0.050844906370207_wp, 0.050844906370207_wp, 0.050844906370207_wp, &
                                              0.082851075618374_wp, 0.082851075618374_wp, 0.082851075618374_wp, &
                                              0.082851075618374_wp, 0.082851075618374_wp, 0.082851075618374_wp]

contains

   !> All that does not depend on displacements: of an element, or of a triangle within one.
   subroutine make_energy(fem, e, degree, energy, part)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      integer(ip), intent(in) :: degree             !< k, of the stresses
      type(element_energy_t), intent(inout) :: energy
      real(wp), intent(in), optional :: part(:, :)  !< (2, 3) of a triangle within the element, less its first node [L]
      real(wp) :: bubbles(MOST_ROWS, MOST_PIECES), heat(COMPONENTS + 1), elasticity(COMPONENTS, COMPONENTS)
      real(wp) :: root(COMPONENTS, COMPONENTS), origin(2), place(2), values(MOST_COEFFICIENTS), thickness
      integer(ip) :: n_nodes, i, k, row, n_bubbles, rule

      call take_form(fem, e, energy%form_t)
      n_nodes = energy%shape
      if (present(part)) then
         origin = part(:, 1)
         call make_macro(part, degree, energy%macro)
      else
         origin = 0.0_wp
         call make_macro(energy%x(:, :SHAPES(n_nodes)%n_corners), degree, energy%macro)
      end if
      associate (section => fem%sections(energy%section), macro => energy%macro)
         thickness = section%thickness
         elasticity = thickness*elasticity_matrix(section, energy%state)
         root = root_of(compliance_matrix(section, energy%state)/thickness)
         heat = thickness*section%expansion*thermal_stresses(section, energy%state)
         energy%n = macro%n_outline
         n_bubbles = macro%n_unknowns - macro%n_outline
         energy%n_given = 2*n_nodes + 2
         if (allocated(fem%heating)) energy%n_given = energy%n_given + n_nodes
         rule = size(MANY, 2)
         if (DEGREE_OF(n_nodes) == 1 .and. degree == 1) then
            rule = merge(size(FEW, 2), size(SOME, 2), is_affine(energy%x(:, :SHAPES(n_nodes)%n_corners)) .and. &
                         .not. (n_nodes == 4 .and. allocated(fem%heating)))     ! temperatures are bilinear
         end if
         call make_rows(macro%n*rule*COMPONENTS, energy)
         row = 0
         do i = 1, macro%n
            do k = 1, rule
               if (rule == size(FEW, 2)) call add_place(FEW(:, k), 1.0_wp/size(FEW, 2))
               if (rule == size(SOME, 2)) call add_place(SOME(:, k), SOME_WEIGHTS(k))
               if (rule == size(MANY, 2)) call add_place(MANY(:, k), MANY_WEIGHTS(k))
            end do
         end do
      end associate
      energy%n_rows = row
      if (n_bubbles > 0) call leave_bubbles(bubbles(:row, :n_bubbles), energy%rows)
      call transposed_product(energy%rows(:, :energy%n), energy%rows, energy%slopes)

   contains

      !> The rows of a point of piece i.
      subroutine add_place(lambda, share)
         real(wp), intent(in) :: lambda(3), share
         real(wp) :: field(COMPONENTS, 2*MOST_NODES), value(MOST_NODES), of_row(COMPONENTS, COMPONENTS), stress(COMPONENTS)
         integer(ip) :: j, l

         associate (macro => energy%macro)
            place = origin + lambda(1)*macro%corner(:, i) + lambda(2)*macro%corner(:, 1 + mod(i, macro%n)) + lambda(3)*macro%centre
            values = piece_values(degree, lambda)
            of_row = root*sqrt(share*macro%area(i))
            associate (x => energy%x(:, :n_nodes))
               call take_field(n_nodes, x, natural_place(n_nodes, x, place), elasticity, field, value)
            end associate
            do j = 1, macro%n_unknowns
               stress = 0.0_wp
               do l = 1, macro%n_coefficients
                  stress = stress + macro%stress(:, l, i, j)*values(l)
               end do
               if (j <= energy%n) then
                  energy%rows(row + 1:row + 3, j) = times_root(of_row, stress)
               else
                  bubbles(row + 1:row + 3, j - energy%n) = times_root(of_row, stress)
               end if
            end do
         end associate
         do j = 1, 2*n_nodes
            energy%rows(row + 1:row + 3, energy%n + j) = -times_root(of_row, field(:, j))
         end do
         l = energy%n + 2*n_nodes
         if (allocated(fem%heating)) then
            do j = 1, n_nodes
               energy%rows(row + 1:row + 3, l + j) = times_root(of_row, heat(:COMPONENTS))*value(j)
            end do
            l = l + n_nodes
         end if
         energy%rows(row + 1:row + 3, l + 1) = -of_row(:, 1)*place(1)
         energy%rows(row + 1:row + 3, l + 2) = -of_row(:, 2)*place(2)
         row = row + COMPONENTS
      end subroutine add_place

   end subroutine make_energy

   !> Room for the rows of this kind of element.
   pure subroutine make_rows(n_rows, energy)
      integer(ip), intent(in) :: n_rows
      type(element_energy_t), intent(inout) :: energy
      logical :: fits

      fits = allocated(energy%rows)
      if (fits) fits = size(energy%rows, 1) == n_rows .and. size(energy%rows, 2) == energy%n + energy%n_given
      if (fits) return
      if (allocated(energy%rows)) deallocate (energy%rows, energy%slopes)
      allocate (energy%rows(n_rows, energy%n + energy%n_given), energy%slopes(energy%n, energy%n + energy%n_given))
   end subroutine make_rows

   !> Makes all columns orthogonal to those of the bubbles (Gram and Schmidt, twice).
   !>
   !> A bubble is an Airy function that is 0 with its gradient all along the outline, so no other element sees its number: for any
   !> a and x it is the one for which E is least. |R_a a + R_x x + B b|^2 is least over b where B'(R_a a + R_x x + B b) = 0, and
   !> then is |P R_a a + P R_x x|^2, P being the projection on what is orthogonal to the columns of B. One pass of Gram and Schmidt
   !> leaves a part of eps times the quotient of the lengths, the second one takes that, too.
   pure subroutine leave_bubbles(bubbles, rows)
      real(wp), intent(inout) :: bubbles(:, :)
      real(wp), intent(inout) :: rows(:, :)
      integer(ip) :: i, j, pass

      do i = 1, size(bubbles, 2, kind=ip)
         associate (bubble => bubbles(:, i))
            do pass = 1, 2
               do j = 1, i - 1
                  bubble = bubble - dot_product(bubbles(:, j), bubble)*bubbles(:, j)
               end do
            end do
            bubble = bubble/norm2(bubble)
            do pass = 1, 2
               do j = 1, size(rows, 2, kind=ip)
                  rows(:, j) = rows(:, j) - dot_product(bubble, rows(:, j))*bubble
               end do
            end do
         end associate
      end do
   end subroutine leave_bubbles

   !> An upper triangle times a stress.
   pure function times_root(root, stress) result(product_of)
      real(wp), intent(in) :: root(COMPONENTS, COMPONENTS), stress(COMPONENTS)
      real(wp) :: product_of(COMPONENTS)

      product_of = [root(1, 1)*stress(1) + root(1, 2)*stress(2) + root(1, 3)*stress(3), &
                    root(2, 2)*stress(2) + root(2, 3)*stress(3), root(3, 3)*stress(3)]
   end function times_root

   !> L' of a positive definite matrix L L'.
   pure function root_of(matrix) result(root)
      real(wp), intent(in) :: matrix(COMPONENTS, COMPONENTS)
      real(wp) :: root(COMPONENTS, COMPONENTS)
      integer(ip) :: i, j

      root = 0.0_wp
      do i = 1, COMPONENTS
         do j = 1, i - 1
            root(j, i) = (matrix(j, i) - dot_product(root(:j - 1, j), root(:j - 1, i)))/root(j, j)
         end do
         root(i, i) = sqrt(matrix(i, i) - sum(root(:i - 1, i)**2))
      end do
   end function root_of

   !> R_x x: the rows without the outline.
   pure subroutine given_rows(energy, x, rows)
      type(element_energy_t), intent(in) :: energy
      real(wp), intent(in) :: x(:)                  !< (n_given) displacements less those of the first node [L], temperatures,
      !< thickness times force per volume [F/L^2]
      real(wp), intent(out) :: rows(:)              !< (n_rows) [(F L)^(1/2)]
      integer(ip) :: j

      rows = 0.0_wp
      do j = 1, energy%n_given
         rows = rows + energy%rows(:, energy%n + j)*x(j)
      end do
   end subroutine given_rows

   !> E of an outline [F L].
   pure real(wp) function energy_difference(energy, x, outline) result(difference)
      type(element_energy_t), intent(in) :: energy
      real(wp), intent(in) :: x(:)                  !< (n_given)
      real(wp), intent(in) :: outline(:)            !< (n)
      real(wp) :: rows(energy%n_rows)
      integer(ip) :: j

      call given_rows(energy, x, rows)
      do j = 1, energy%n
         rows = rows + energy%rows(:, j)*outline(j)
      end do
      difference = dot_product(rows, rows)
   end function energy_difference

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

   !> The stresses of displacements at the corners of an element, times the thickness: rows s11, s22, s12 corner by corner, columns
   !> as x without forces per volume.
   pure function corner_stresses(fem, form) result(field)
      type(fem_t), intent(in) :: fem
      type(form_t), intent(in) :: form
      real(wp) :: field(COMPONENTS*MOST_PIECES, MOST_GIVEN)
      real(wp) :: of_u(COMPONENTS, 2*MOST_NODES), value(MOST_NODES), heat(COMPONENTS + 1)
      integer(ip) :: i, j, n

      n = form%shape
      field = 0.0_wp
      associate (section => fem%sections(form%section))
         heat = section%thickness*section%expansion*thermal_stresses(section, form%state)
         do i = 1, SHAPES(n)%n_corners
            call take_field(n, form%x(:, :n), SHAPES(n)%place(:, i), &
                            section%thickness*elasticity_matrix(section, form%state), of_u, value)
            field(3*i - 2:3*i, :2*n) = of_u(:, :2*n)
            do j = 1, n
               field(3*i - 2:3*i, 2*n + j) = -heat(:COMPONENTS)*value(j)
            end do
         end do
      end associate
   end function corner_stresses

   !> The stresses that displacements of the nodes make at a place, and the shape functions there.
   pure subroutine take_field(n, x, xi, elasticity, field, value)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: x(:, :), xi(2), elasticity(COMPONENTS, COMPONENTS)
      real(wp), intent(out) :: field(:, :)          !< (COMPONENTS, 2n)
      real(wp), intent(out) :: value(:)
      real(wp) :: dn(n, 2), j(2, 2), g(2)
      integer(ip) :: k

      value(:n) = shape_values(n, xi)
      dn = shape_gradients(n, xi)
      j = inverse(jacobian(x, dn))
      do k = 1, n
         g = [dn(k, 1)*j(1, 1) + dn(k, 2)*j(2, 1), dn(k, 1)*j(1, 2) + dn(k, 2)*j(2, 2)]
         field(:, 2*k - 1) = elasticity(:, 1)*g(1) + elasticity(:, 3)*g(2)
         field(:, 2*k) = elasticity(:, 2)*g(2) + elasticity(:, 3)*g(1)
      end do
   end subroutine take_field

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

      i = reshape([m(2, 2), -m(2, 1), -m(1, 2), m(1, 1)], [2, 2])/(m(1, 1)*m(2, 2) - m(1, 2)*m(2, 1))
   end function inverse

   !> xi of a place, by Newton's method from the middle.
   pure function natural_place(n, x, place) result(xi)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: x(:, :), place(2)
      real(wp) :: xi(2)
      real(wp) :: j(2, 2), r(2), step(2), value(n)
      integer(ip) :: i, k

      xi = merge(1.0_wp/3, 0.0_wp, SHAPES(n)%n_corners == 3)
      do i = 1, MOST_STEPS
         value = shape_values(n, xi)
         r = place
         do k = 1, n
            r = r - x(:, k)*value(k)
         end do
         j = inverse(jacobian(x, shape_gradients(n, xi)))
         step = [j(1, 1)*r(1) + j(1, 2)*r(2), j(2, 1)*r(1) + j(2, 2)*r(2)]
         xi = xi + step
         if (maxval(abs(step)) <= 1.0e-9_wp) exit  ! what is left is its square
      end do
   end function natural_place

   !> A triangle or a parallelogram.
   pure logical function is_affine(x)
      real(wp), intent(in) :: x(:, :)

      is_affine = size(x, 2) == 3
      if (.not. is_affine) is_affine = maxval(abs(x(:, 1) - x(:, 2) + x(:, 3) - x(:, 4))) <= 1.0e-12_wp*maxval(abs(x))
   end function is_affine

end module atrito_element_energy
