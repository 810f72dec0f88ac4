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
!> Of the values of a stress at the points of a piece, times the roots of their weights and of C^-1 (L' of C^-1 = L L'), the rows
!> are what lies along the polynomials of s(a), orthogonal ones, and behind these what is left, which s(a) has no part of. Taken as
!> a sum of squares E loses no digits where both stresses nearly agree. The bubbles of stresses of degree 2 are where E is least:
!> all other columns are made orthogonal to theirs, and the bubbles are gone.
!>
!> Instead of x itself, any columns of it may be given (`given`) and x is what is taken of each: an element that is like no other
!> one, or a part of one, needs its own x alone, for which little work is to be done.
module atrito_element_energy
   use atrito_airy_stress, only: macro_t, make_macro, piece_values, MOST_COEFFICIENTS, MOST_PIECES, MOST_UNKNOWNS
   use atrito_assembly, only: fem_t, form_t, take_form
   use atrito_dense, only: add_product
   use atrito_element_table, only: MOST_NODES, SHAPES
   use atrito_kinds, only: ip, wp
   use atrito_natural_places, only: is_affine, natural_place, take_gradients
   use atrito_plane_state, only: COMPONENTS, compliance_matrix, elasticity_matrix, thermal_stresses
   implicit none (type, external)
   private
   public :: element_energy_t, make_energy, given_rows, energy_difference, corner_stresses, MOST_GIVEN

   integer(ip), parameter :: MOST_PLACES = 12       !< of quadrature on a piece
   integer(ip), parameter :: MOST_ROWS = COMPONENTS*MOST_COEFFICIENTS*MOST_PIECES
   !> Displacements and temperatures of the nodes, force per volume.
   integer(ip), parameter :: MOST_GIVEN = 3*MOST_NODES + 2

   type, extends(form_t) :: element_energy_t
      type(macro_t) :: macro
      real(wp) :: elasticity(COMPONENTS, COMPONENTS) = 0.0_wp !< times the thickness [F/L]
      real(wp) :: root(COMPONENTS, COMPONENTS) = 0.0_wp !< L', over the root of the thickness [(L/F)^(1/2)]
      real(wp) :: heat(COMPONENTS + 1) = 0.0_wp     !< stresses of a temperature of 1, times the thickness [F/L]
      integer(ip) :: n = 0                          !< numbers of the outline
      integer(ip) :: n_given = 0                    !< of x; 2 n_nodes displacements, n_nodes temperatures if any, 2 forces
      integer(ip) :: n_rows = 0                     !< with those of rest
      real(wp), allocatable :: rows(:, :)           !< (n + n_given, rows) R_a', and behind it R_x', but that of rest
      real(wp), allocatable :: rest(:, :)           !< (n_given, n_given) a triangle: rows of R_x where those of R_a are 0
      real(wp), allocatable :: slopes(:, :)         !< (n + n_given, n + n_given) H, and beside it G; R_x' R_x
   end type element_energy_t

   !> Of the stresses of 3, 4, 6, 8 and 9 nodes in elements with parallel sides; in others they are no polynomials.
   integer(ip), parameter :: FIELD_DEGREE(MOST_NODES) = [integer(ip) :: 0, 0, 0, 1, 0, 1, 0, 2, 3], NO_DEGREE = 9

   !> Points on a piece, and polynomials that are orthogonal over them.
   type :: rule_t
      integer(ip) :: n = 0                          !< points
      real(wp) :: place(3, MOST_PLACES) = 0.0_wp    !< barycentric coordinates
      real(wp) :: weight(MOST_PLACES) = 0.0_wp      !< their sum is 1
      real(wp) :: basis(MOST_PLACES, MOST_COEFFICIENTS) = 0.0_wp !< at the points, times the roots of the weights
      real(wp) :: triangle(MOST_COEFFICIENTS, MOST_COEFFICIENTS) = 0.0_wp !< Bernstein polynomials by them
   end type rule_t

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

   !> All that does not depend on displacements: of an element, or of a part of one.
   subroutine make_energy(fem, e, degree, energy, part, given)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      integer(ip), intent(in) :: degree             !< k, of the stresses
      type(element_energy_t), intent(inout) :: energy
      real(wp), intent(in), optional :: part(:, :)  !< (2, 3 or 4) corners of a part, less the element's first node [L]
      real(wp), intent(in), optional :: given(:, :) !< (x, n_given) columns that x is made of; without it those of x itself
      type(rule_t) :: rule
      real(wp) :: bubbles(MOST_PIECES, MOST_ROWS), origin(2)
      integer(ip) :: n_x, n_rows, i, j
      logical :: fits

      call take_form(fem, e, energy%form_t)
      associate (section => fem%sections(energy%section))
         energy%elasticity = section%thickness*elasticity_matrix(section, energy%state)
         ! L' of a positive definite matrix L L'.
         associate (matrix => compliance_matrix(section, energy%state)/section%thickness)
            energy%root = 0.0_wp
            do i = 1, COMPONENTS
               do j = 1, i - 1
                  energy%root(j, i) = (matrix(j, i) - dot_product(energy%root(:j - 1, j), energy%root(:j - 1, i)))/energy%root(j, j)
               end do
               energy%root(i, i) = sqrt(matrix(i, i) - sum(energy%root(:i - 1, i)**2))
            end do
         end associate
         energy%heat = section%thickness*section%expansion*thermal_stresses(section, energy%state)
      end associate
      origin = 0.0_wp
      if (present(part)) then
         origin = part(:, 1)
         call make_macro(part, degree, energy%macro)
      else
         call make_macro(energy%x(:, :SHAPES(energy%shape)%n_corners), degree, energy%macro)
      end if
      n_x = 2*energy%shape + 2
      if (allocated(fem%heating)) n_x = n_x + energy%shape
      energy%n_given = n_x
      if (present(given)) energy%n_given = size(given, 2, kind=ip)
      energy%n = energy%macro%n_outline
      call choose_rule(energy%form_t, degree, allocated(fem%heating), rule)
      n_rows = COMPONENTS*energy%macro%n_coefficients*energy%macro%n
      ! Room for the rows of this kind of element.
      energy%n_rows = n_rows + energy%n_given
      fits = allocated(energy%rows)
      if (fits) fits = size(energy%rows, 2) == n_rows .and. size(energy%rows, 1) == energy%n + energy%n_given
      if (.not. fits) then
         if (allocated(energy%rows)) deallocate (energy%rows, energy%rest, energy%slopes)
         associate (n => energy%n + energy%n_given)
            allocate (energy%rows(n, n_rows), energy%slopes(n, n), energy%rest(energy%n_given, energy%n_given))
         end associate
      end if
      call add_outline(rule, energy, bubbles(:energy%macro%n_unknowns - energy%n, :n_rows))
      if (present(given)) then
         call add_given(allocated(fem%heating), rule, origin, given, energy)
      else
         call add_given(allocated(fem%heating), rule, origin, unit_matrix(n_x), energy)
      end if
      call leave_bubbles(bubbles(:energy%macro%n_unknowns - energy%n, :n_rows), energy%rows)
      energy%slopes = 0.0_wp
      call add_product(energy%rows, energy%rows, energy%slopes)
      associate (of_x => energy%slopes(energy%n + 1:, energy%n + 1:))
         do n_x = 1, energy%n_given
            of_x(:, n_x) = of_x(:, n_x) + matmul(energy%rest(:, n_x), energy%rest)
         end do
      end associate
   end subroutine make_energy

   !> The points on a piece: the fewest that are exact, as far as any are.
   pure subroutine choose_rule(form, degree, is_heated, rule)
      type(form_t), intent(in) :: form
      integer(ip), intent(in) :: degree
      logical, intent(in) :: is_heated
      type(rule_t), intent(out) :: rule
      integer(ip) :: i, degree_of_field, n_coefficients

      degree_of_field = NO_DEGREE
      if (is_affine(form%x(:, :SHAPES(form%shape)%n_corners))) then
         degree_of_field = FIELD_DEGREE(form%shape)
         if (is_heated) degree_of_field = degree_of_field + 1
      end if
      if (degree == 1 .and. degree_of_field <= 1) then
         rule%n = size(FEW, 2)
         rule%place(:, :rule%n) = FEW
         rule%weight = 1.0_wp/size(FEW, 2)
      else if (degree == 1 .or. degree_of_field <= 2) then
         rule%n = size(SOME, 2)
         rule%place(:, :rule%n) = SOME
         rule%weight(:rule%n) = SOME_WEIGHTS
      else
         rule%n = size(MANY, 2)
         rule%place = MANY
         rule%weight = MANY_WEIGHTS
      end if
      n_coefficients = merge(3, MOST_COEFFICIENTS, degree == 1)
      do i = 1, rule%n
         rule%basis(i, :) = sqrt(rule%weight(i))*piece_values(degree, rule%place(:, i))
      end do
      call make_orthogonal(rule%basis(:rule%n, :n_coefficients), rule%triangle(:n_coefficients, :n_coefficients))
   end subroutine choose_rule

   !> Columns become orthogonal ones of length 1, q, of which the given ones are q triangle (Gram and Schmidt).
   pure subroutine make_orthogonal(columns, triangle)
      real(wp), intent(inout) :: columns(:, :)
      real(wp), intent(out) :: triangle(:, :)
      integer(ip) :: i, j

      triangle = 0.0_wp
      do j = 1, size(columns, 2, kind=ip)
         do i = 1, j - 1
            triangle(i, j) = dot_product(columns(:, i), columns(:, j))
            columns(:, j) = columns(:, j) - triangle(i, j)*columns(:, i)
         end do
         triangle(j, j) = norm2(columns(:, j))
         if (triangle(j, j) > 0.0_wp) columns(:, j) = columns(:, j)/triangle(j, j)
      end do
   end subroutine make_orthogonal

   !> R_a, and the same of the bubbles.
   pure subroutine add_outline(rule, energy, bubbles)
      type(rule_t), intent(in) :: rule
      type(element_energy_t), intent(inout) :: energy
      real(wp), intent(out) :: bubbles(:, :)        !< (bubbles, rows)
      real(wp) :: root(COMPONENTS, COMPONENTS), s(MOST_UNKNOWNS, COMPONENTS)
      integer(ip) :: i, j, l, q, row, n_numbers

      n_numbers = energy%macro%n_unknowns
      associate (macro => energy%macro, n => energy%macro%n_coefficients)
         do i = 1, macro%n
            root = sqrt(macro%area(i))*energy%root
            do q = 1, n
               s(:n_numbers, :) = 0.0_wp
               do l = q, n
                  do j = 1, n_numbers
                     s(j, 1) = s(j, 1) + rule%triangle(q, l)*macro%stress(j, 1, l, i)
                     s(j, 2) = s(j, 2) + rule%triangle(q, l)*macro%stress(j, 2, l, i)
                     s(j, 3) = s(j, 3) + rule%triangle(q, l)*macro%stress(j, 3, l, i)
                  end do
               end do
               row = COMPONENTS*(n*(i - 1) + q - 1)
               do j = 1, n_numbers
                  s(j, 1) = root(1, 1)*s(j, 1) + root(1, 2)*s(j, 2) + root(1, 3)*s(j, 3)
                  s(j, 2) = root(2, 2)*s(j, 2) + root(2, 3)*s(j, 3)
                  s(j, 3) = root(3, 3)*s(j, 3)
               end do
               energy%rows(:energy%n, row + 1:row + 3) = s(:energy%n, :)
               bubbles(:, row + 1:row + 3) = s(energy%n + 1:n_numbers, :)
            end do
         end do
      end associate
   end subroutine add_outline

   !> R_x of the given columns.
   pure subroutine add_given(is_heated, rule, origin, given, energy)
      logical, intent(in) :: is_heated
      type(rule_t), intent(in) :: rule
      real(wp), intent(in) :: origin(2)             !< of the macro's corners, less the element's first node [L]
      real(wp), intent(in) :: given(:, :)           !< (x, n_given)
      type(element_energy_t), intent(inout) :: energy
      real(wp) :: stress(COMPONENTS, MOST_GIVEN), values(COMPONENTS, MOST_PLACES, MOST_GIVEN), lambda(3), along(COMPONENTS)
      real(wp) :: rest(COMPONENTS*MOST_PLACES*MOST_PIECES, MOST_GIVEN), root(COMPONENTS, COMPONENTS)
      integer(ip) :: i, j, k, q, row

      associate (macro => energy%macro, n => energy%macro%n_coefficients)
         do i = 1, macro%n
            do k = 1, rule%n
               lambda = rule%place(:, k)
               call given_stresses(energy, is_heated, origin + lambda(1)*macro%corner(:, i) + &
                                   lambda(2)*macro%corner(:, 1 + mod(i, macro%n)) + lambda(3)*macro%centre, given, stress)
               root = sqrt(rule%weight(k)*macro%area(i))*energy%root
               do j = 1, energy%n_given
                  values(:, k, j) = times_root(root, stress(:, j))
               end do
            end do
            do j = 1, energy%n_given
               do q = 1, n
                  along = 0.0_wp
                  do k = 1, rule%n
                     along = along + values(:, k, j)*rule%basis(k, q)
                  end do
                  do k = 1, rule%n
                     values(:, k, j) = values(:, k, j) - along*rule%basis(k, q)
                  end do
                  row = COMPONENTS*(n*(i - 1) + q - 1)
                  energy%rows(energy%n + j, row + 1:row + 3) = along
               end do
               do k = 1, rule%n
                  row = COMPONENTS*(rule%n*(i - 1) + k - 1)
                  rest(row + 1:row + 3, j) = values(:, k, j)
               end do
            end do
         end do
         energy%rest = 0.0_wp                       ! as many polynomials as points: nothing is left
         if (rule%n > n) call make_orthogonal(rest(:COMPONENTS*rule%n*macro%n, :energy%n_given), energy%rest)
      end associate
   end subroutine add_given

   !> s_b - s_h at a place, of given columns.
   pure subroutine given_stresses(energy, is_heated, place, given, stress)
      type(element_energy_t), intent(in) :: energy
      logical, intent(in) :: is_heated
      real(wp), intent(in) :: place(2)              !< less the element's first node [L]
      real(wp), intent(in) :: given(:, :)           !< (x, n_given)
      real(wp), intent(out) :: stress(:, :)         !< (COMPONENTS, n_given)
      real(wp) :: g(2, MOST_NODES), value(MOST_NODES), e(COMPONENTS), theta
      integer(ip) :: j, k, l

      associate (n => energy%shape, c => energy%elasticity)
         call take_gradients(n, energy%x(:, :n), natural_place(n, energy%x(:, :n), place), is_heated, g, value)
         do j = 1, size(given, 2, kind=ip)
            e = 0.0_wp
            do k = 1, n
               associate (u => given(2*k - 1, j), v => given(2*k, j))
                  e = e + [g(1, k)*u, g(2, k)*v, g(2, k)*u + g(1, k)*v]
               end associate
            end do
            stress(:, j) = -(c(:, 1)*e(1) + c(:, 2)*e(2) + c(:, 3)*e(3))
            l = 2*n
            if (is_heated) then
               theta = 0.0_wp
               do k = 1, n
                  theta = theta + value(k)*given(l + k, j)
               end do
               stress(:, j) = stress(:, j) + energy%heat(:COMPONENTS)*theta
               l = l + n
            end if
            stress(:2, j) = stress(:2, j) - place*given(l + 1:l + 2, j)
         end do
      end associate
   end subroutine given_stresses

   !> Makes all columns orthogonal to those of the bubbles.
   !>
   !> A bubble is an Airy function that is 0 with its gradient all along the outline, so no other element sees its number: for any
   !> a and x it is the one for which E is least. |R_a a + R_x x + B b|^2 is least over b where B'(R_a a + R_x x + B b) = 0, and
   !> then is |P R_a a + P R_x x|^2, P = 1 - B B' being the projection on what is orthogonal to the columns of B.
   pure subroutine leave_bubbles(bubbles, rows)
      real(wp), intent(in) :: bubbles(:, :)         !< (bubbles, rows)
      real(wp), intent(inout) :: rows(:, :)         !< (columns, rows)
      real(wp) :: orthogonal(size(rows, 2), size(bubbles, 1)), triangle(size(bubbles, 1), size(bubbles, 1)), part(size(rows, 1))
      integer(ip) :: i, r

      if (size(bubbles) == 0) return
      orthogonal = transpose(bubbles)
      call make_orthogonal(orthogonal, triangle)
      do i = 1, size(bubbles, 1, kind=ip)
         part = 0.0_wp
         do r = 1, size(rows, 2, kind=ip)
            part = part + rows(:, r)*orthogonal(r, i)
         end do
         do r = 1, size(rows, 2, kind=ip)
            rows(:, r) = rows(:, r) - part*orthogonal(r, i)
         end do
      end do
   end subroutine leave_bubbles

   pure function unit_matrix(n) result(matrix)
      integer(ip), intent(in) :: n
      real(wp) :: matrix(n, n)
      integer(ip) :: i

      matrix = 0.0_wp
      do i = 1, n
         matrix(i, i) = 1.0_wp
      end do
   end function unit_matrix

   !> An upper triangle times a stress.
   pure function times_root(root, stress) result(product_of)
      real(wp), intent(in) :: root(COMPONENTS, COMPONENTS), stress(COMPONENTS)
      real(wp) :: product_of(COMPONENTS)

      product_of = [root(1, 1)*stress(1) + root(1, 2)*stress(2) + root(1, 3)*stress(3), &
                    root(2, 2)*stress(2) + root(2, 3)*stress(3), root(3, 3)*stress(3)]
   end function times_root

   !> R_x x: the rows without the outline.
   pure subroutine given_rows(energy, x, rows)
      type(element_energy_t), intent(in) :: energy
      real(wp), intent(in) :: x(:)                  !< (n_given) of each given column; without them displacements less those of
      !< the first node [L], temperatures, thickness times force per volume [F/L^2]
      real(wp), intent(out) :: rows(:)              !< (n_rows) [(F L)^(1/2)]
      integer(ip) :: j, n, r

      n = size(energy%rows, 2, kind=ip)
      rows = 0.0_wp
      do r = 1, n
         do j = 1, energy%n_given
            rows(r) = rows(r) + energy%rows(energy%n + j, r)*x(j)
         end do
      end do
      do j = 1, energy%n_given
         if (x(j) == 0.0_wp) cycle                  ! the first node, forces that are not there
         rows(n + 1:n + j) = rows(n + 1:n + j) + energy%rest(:j, j)*x(j)
      end do
   end subroutine given_rows

   !> E of an outline [F L].
   pure real(wp) function energy_difference(energy, x, outline) result(difference)
      type(element_energy_t), intent(in) :: energy
      real(wp), intent(in) :: x(:)                  !< (n_given)
      real(wp), intent(in) :: outline(:)            !< (n)
      real(wp) :: rows(energy%n_rows)
      integer(ip) :: r

      call given_rows(energy, x, rows)
      do r = 1, size(energy%rows, 2, kind=ip)
         rows(r) = rows(r) + dot_product(energy%rows(:energy%n, r), outline)
      end do
      difference = dot_product(rows, rows)
   end function energy_difference

   !> The stresses of displacements at the corners of an element, times the thickness: rows s11, s22, s12 corner by corner, columns
   !> as x without forces per volume.
   pure function corner_stresses(fem, form) result(field)
      type(fem_t), intent(in) :: fem
      type(form_t), intent(in) :: form
      real(wp) :: field(COMPONENTS*MOST_PIECES, MOST_GIVEN)
      real(wp) :: g(2, MOST_NODES), value(MOST_NODES), heat(COMPONENTS + 1), c(COMPONENTS, COMPONENTS)
      integer(ip) :: i, j, n

      n = form%shape
      field = 0.0_wp
      associate (section => fem%sections(form%section))
         heat = section%thickness*section%expansion*thermal_stresses(section, form%state)
         c = section%thickness*elasticity_matrix(section, form%state)
         do i = 1, SHAPES(n)%n_corners
            call take_gradients(n, form%x(:, :n), SHAPES(n)%place(:, i), allocated(fem%heating), g, value)
            do j = 1, n
               field(3*i - 2:3*i, 2*j - 1) = c(:, 1)*g(1, j) + c(:, 3)*g(2, j)
               field(3*i - 2:3*i, 2*j) = c(:, 2)*g(2, j) + c(:, 3)*g(1, j)
               if (allocated(fem%heating)) field(3*i - 2:3*i, 2*n + j) = -heat(:COMPONENTS)*value(j)
            end do
         end do
      end associate
   end function corner_stresses

end module atrito_element_energy
