!> Solves a deck and prints the errors of displacements (L2 norm) and stresses (energy norm) against an exact solution, both over
!> that of the solution itself, integrated with 5 x 5 Gauss points an element over the mesh as it is (of a
!> triangle those of the square that is pressed together at one corner). FORMULATION=BBAR: the
!> stresses are those of the strains with the mean dilatation of the element, the same integral. Axisymmetric elements (STANDARD):
!> integrals over the full circle; the field is that of the plane along y = 0, with the stress round the circle for s33.
!>
!>    error_norms DECK LEVELS FIELD NUMBER...        FIELD and its numbers: exact_fields.f90; LEVELS of refinement
!>
!> Prints: elements, dofs, L2, energy, largest deviation of the Jacobian within an element from its mean.
program error_norms
   use, intrinsic :: iso_fortran_env, only: output_unit
   use atrito_body_cache, only: body_cache_t
   use atrito_plane_state, only: elastic_t, elasticity_matrix, PLANE_STRAIN
   use atrito_reader, only: read_deck
   use atrito_build_model, only: build_model
   use atrito_deck, only: deck_t
   use atrito_element_table, only: SHAPES, has_mean_dilatation
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: element_coordinates, is_revolved
   use atrito_messages, only: count_messages, SEVERITY_ERROR
   use atrito_model, only: model_t
   use atrito_reporter, only: reporter_t
   use atrito_results, only: results_t
   use atrito_shape_functions, only: shape_values, shape_gradients
   use atrito_solve, only: solve_static, solve_options_t
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: string_t
   use exact_fields, only: field_t, make_field, exact_solution
   implicit none (type, external)

   real(wp), parameter :: POINTS(5) = [-0.90617984593866399280_wp, -0.53846931010568309104_wp, 0.0_wp, &
                                       0.53846931010568309104_wp, 0.90617984593866399280_wp]
   real(wp), parameter :: WEIGHTS(5) = [0.23692688505618908751_wp, 0.47862867049936646804_wp, 0.56888888888888888889_wp, &
                                        0.47862867049936646804_wp, 0.23692688505618908751_wp]
   type(model_t) :: model
   type(results_t) :: results
   type(field_t) :: field
   real(wp) :: sums(4), warp
   integer(ip) :: e

   call solve_deck(argument(1), nint(number(2), ip), model, results)
   field = make_field(argument(3), [(number(e), e=4, 8)])
   sums = 0.0_wp
   warp = 0.0_wp
   do e = 1, model%mesh%n_elements
      if (is_revolved(model%mesh)) then
         call add_ring_errors(e, sums)
      else
         call add_element_errors(e, sums, warp)
      end if
   end do
   write (output_unit, '(i0,1x,i0,3(1x,es22.15))') model%mesh%n_elements, 2*model%mesh%n_nodes, &
      sqrt(sums(1)/sums(2)), sqrt(sums(3)/sums(4)), warp

contains

   function argument(i) result(text)
      integer(ip), intent(in) :: i
      character(len=:), allocatable :: text
      integer :: length

      call get_command_argument(int(i), length=length)
      allocate (character(len=length) :: text)
      call get_command_argument(int(i), text)
   end function argument

   !> A numeric argument; 0 where there is none.
   real(wp) function number(i)
      integer(ip), intent(in) :: i
      character(len=:), allocatable :: text
      integer :: failed

      number = 0.0_wp
      if (i > command_argument_count()) return
      text = argument(i)
      read (text, *, iostat=failed) number
      if (failed /= 0) error stop 'error_norms: a number is wanted'
   end function number

   subroutine solve_deck(name, levels, model, results)
      character(len=*), intent(in) :: name
      integer(ip), intent(in) :: levels
      type(model_t), intent(out) :: model
      type(results_t), intent(out) :: results
      type(deck_t) :: deck
      type(body_cache_t) :: store
      type(status_t) :: status
      type(reporter_t) :: reporter

      reporter%quiet = .true.
      call read_deck(name, [string_t ::], deck, status)
      if (is_ok(status)) call build_model(deck, model, levels)
      if (.not. is_ok(status) .or. count_messages(SEVERITY_ERROR) > 0) error stop 'error_norms: the deck is wrong'
      call solve_static(model, solve_options_t(), reporter, results, status, store)
      if (.not. (is_ok(status) .and. results%converged .and. results%law_holds)) error stop 'error_norms: not solved'
   end subroutine solve_deck

   !> Adds to sums: error and size of the displacements squared, of the stresses in the energy norm squared.
   subroutine add_element_errors(e, sums, warp)
      integer(ip), intent(in) :: e
      real(wp), intent(inout) :: sums(4), warp
      type(elastic_t) :: section
      real(wp) :: x(2, model%mesh%shape(e)), u(2, model%mesh%shape(e)), n(model%mesh%shape(e))
      real(wp) :: d(3, 3), place(2), exact_u(2), exact_s(3), s(3), jacobian, weight, jacobians(25), mean, xi(2), xi_weight
      integer(ip) :: i, j, corners
      logical :: averages

      corners = SHAPES(model%mesh%shape(e))%n_corners
      x = element_coordinates(model%mesh, e)
      u = results%u(:, model%mesh%nodes(:model%mesh%shape(e), e))
      associate (values => model%sections(model%section_of(e)), material => &
                 model%materials(model%sections(model%section_of(e))%material))
         section = elastic_t(material%young, material%poisson, values%thickness, formulation=values%formulation)
      end associate
      d = elasticity_matrix(section, model%mesh%state(e))
      averages = has_mean_dilatation(section, model%mesh%state(e), model%mesh%shape(e))
      mean = 0.0_wp
      if (averages) mean = mean_dilatation(x, u)
      do j = 1, 5
         do i = 1, 5
            call point_of(model%mesh%shape(e), i, j, xi, xi_weight)
            n = shape_values(model%mesh%shape(e), xi)
            place = matmul(x, n)
            call exact_solution(field, section, model%mesh%state(e), sum(x(:, :corners), dim=2)/corners, place, exact_u, exact_s)
            call strain_at(x, u, xi, s, jacobian)
            if (averages) s(1:2) = s(1:2) + (mean - sum(s(1:2)))/2
            s = matmul(d, s)
            weight = xi_weight*jacobian
            jacobians(5*(j - 1) + i) = jacobian
            sums(1) = sums(1) + weight*sum((matmul(u, n) - exact_u)**2)
            sums(2) = sums(2) + weight*sum(exact_u**2)
            sums(3) = sums(3) + weight*energy(d, s - exact_s)
            sums(4) = sums(4) + weight*energy(d, exact_s)
         end do
      end do
      warp = max(warp, (maxval(jacobians) - minval(jacobians))/(2*sum(jacobians)/25))
   end subroutine add_element_errors

   pure subroutine point_of(n_nodes, i, j, xi, weight)
      integer(ip), intent(in) :: n_nodes, i, j
      real(wp), intent(out) :: xi(2), weight

      xi = [POINTS(i), POINTS(j)]
      weight = WEIGHTS(i)*WEIGHTS(j)
      if (SHAPES(n_nodes)%n_corners == 4) return
      xi = 0.5_wp*(1 + xi)
      weight = weight*0.25_wp*(1 - xi(1))
      xi(2) = xi(2)*(1 - xi(1))
   end subroutine point_of

   !> The same of an axisymmetric element.
   subroutine add_ring_errors(e, sums)
      integer(ip), intent(in) :: e
      real(wp), intent(inout) :: sums(4)
      type(elastic_t) :: section
      real(wp) :: x(2, model%mesh%shape(e)), u(2, model%mesh%shape(e)), n(model%mesh%shape(e))
      real(wp) :: middle, xi(2), at_point
      real(wp) :: place(2), exact_u(2), plane(3), exact(4), s(4), strain(3), hoop, jacobian, weight, lambda, shear
      integer(ip) :: i, j

      x = element_coordinates(model%mesh, e)
      u = results%u(:, model%mesh%nodes(:model%mesh%shape(e), e))
      associate (material => model%materials(model%sections(model%section_of(e))%material))
         section = elastic_t(material%young, material%poisson)
      end associate
      associate (young => section%young, mu => section%poisson)
         shear = young/(2*(1 + mu))
         lambda = young*mu/((1 + mu)*(1 - 2*mu))
         associate (corners => SHAPES(model%mesh%shape(e))%n_corners)
            middle = sum(x(1, :corners))/corners
         end associate
         do j = 1, 5
            do i = 1, 5
               call point_of(model%mesh%shape(e), i, j, xi, at_point)
               n = shape_values(model%mesh%shape(e), xi)
               place = matmul(x, n)
               call exact_solution(field, section, PLANE_STRAIN, [middle, 0.0_wp], [place(1), 0.0_wp], exact_u, plane)
               exact = [plane(1), mu*(plane(1) + plane(2)), plane(2), 0.0_wp]
               call strain_at(x, u, xi, strain, jacobian)
               hoop = dot_product(u(1, :), n)/place(1)
               s = [2*shear*[strain(1), strain(2), hoop] + lambda*(strain(1) + strain(2) + hoop), shear*strain(3)]
               weight = at_point*jacobian*place(1)
               sums(1) = sums(1) + weight*sum((matmul(u, n) - exact_u)**2)
               sums(2) = sums(2) + weight*sum(exact_u**2)
               sums(3) = sums(3) + weight*spatial_energy(young, mu, s - exact)
               sums(4) = sums(4) + weight*spatial_energy(young, mu, exact)
            end do
         end do
      end associate
   end subroutine add_ring_errors

   !> The work of s11, s22, s33, s12 on their strains.
   pure real(wp) function spatial_energy(young, mu, s)
      real(wp), intent(in) :: young, mu, s(4)

      spatial_energy = ((1 + mu)*(sum(s(:3)**2) + 2*s(4)**2) - mu*sum(s(:3))**2)/young
   end function spatial_energy

   pure real(wp) function mean_dilatation(x, u)
      real(wp), intent(in) :: x(:, :), u(:, :)
      real(wp) :: area, strain(3), jacobian
      integer(ip) :: i, j

      mean_dilatation = 0.0_wp
      area = 0.0_wp
      do j = 1, 5
         do i = 1, 5
            call strain_at(x, u, [POINTS(i), POINTS(j)], strain, jacobian)
            mean_dilatation = mean_dilatation + WEIGHTS(i)*WEIGHTS(j)*jacobian*(strain(1) + strain(2))
            area = area + WEIGHTS(i)*WEIGHTS(j)*jacobian
         end do
      end do
      mean_dilatation = mean_dilatation/area
   end function mean_dilatation

   !> e11, e22, 2 e12.
   pure subroutine strain_at(x, u, xi, strain, jacobian)
      real(wp), intent(in) :: x(:, :), u(:, :), xi(2)
      real(wp), intent(out) :: strain(3), jacobian
      real(wp) :: dn(size(x, 2), 2), j(2, 2), gradient(2, 2)

      dn = shape_gradients(size(x, 2, kind=ip), xi)
      j = matmul(x, dn)
      jacobian = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
      gradient = matmul(matmul(u, dn), reshape([j(2, 2), -j(2, 1), -j(1, 2), j(1, 1)], [2, 2])/jacobian)
      strain = [gradient(1, 1), gradient(2, 2), gradient(1, 2) + gradient(2, 1)]
   end subroutine strain_at

   !> s D^-1 s for the elasticity matrix D of an isotropic material.
   pure real(wp) function energy(d, s)
      real(wp), intent(in) :: d(3, 3), s(3)

      energy = (d(1, 1)*(s(1)**2 + s(2)**2) - 2*d(1, 2)*s(1)*s(2))/(d(1, 1)**2 - d(1, 2)**2) + s(3)**2/d(3, 3)
   end function energy

end program error_norms
