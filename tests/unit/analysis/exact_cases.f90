!> A smooth plane elastic field in closed form, solved with its displacements prescribed on the outline, and the errors.
!>
!> Kolosov and Muskhelishvili with phi = exp(z), psi = 0: 2 G (u + iv) = kappa phi - z conj(phi'), s11 + s22 = 4 Re phi',
!> s22 - s11 + 2 i s12 = 2 conj(z) phi''. No body force.
module exact_cases
   use atrito_body_cache, only: body_cache_t
   use atrito_element_table, only: CORNERS_OF, DEGREE_OF, ERROR_POINTS_OF
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: add_element, add_node, element_coordinates, nodes_of_square, trim_mesh
   use atrito_model, only: model_t, FORMULATION_BBAR
   use atrito_plane_state, only: compliance_matrix, elastic_t, elasticity_matrix, PLANE_STRAIN
   use atrito_reporter, only: reporter_t
   use atrito_results, only: results_t
   use atrito_shape_functions, only: gauss_point, rule_point, shape_gradients, shape_values
   use atrito_solve, only: solve_options_t, solve_static
   use atrito_status, only: status_t
   use atrito_triangle_pieces, only: triangles_of_square
   implicit none (type, external)
   private
   public :: errors_t, solve_exact_case, make_exact_model, DOMAIN_SQUARE, DOMAIN_RING

   integer(ip), parameter :: DOMAIN_SQUARE = 1      !< unit square, its elements distorted smoothly
   integer(ip), parameter :: DOMAIN_RING = 2        !< a quarter of the ring 1/2 < r < 1
   real(wp), parameter :: YOUNG = 3.0_wp, POISSON = 0.3_wp

   !> Errors in the energy norm, relative to the energy norm of the exact field.
   type :: errors_t
      real(wp) :: raw = 0.0_wp                      !< of the elements' stresses
      real(wp) :: recovered = 0.0_wp                !< of the recovered ones
      real(wp) :: largest = 0.0_wp                  !< of the nodal stresses, over the largest of the exact ones
      real(wp) :: index = 0.0_wp                    !< estimated over true
   end type errors_t

contains

   pure function exact_displacement(x) result(u)
      real(wp), intent(in) :: x(2)
      real(wp) :: u(2)
      complex(wp) :: z, w

      z = cmplx(x(1), x(2), wp)
      w = ((3 - 4*POISSON)*exp(z) - z*conjg(exp(z)))*(1 + POISSON)/YOUNG
      u = [real(w, wp), aimag(w)]
   end function exact_displacement

   pure function exact_stress(x) result(s)
      real(wp), intent(in) :: x(2)
      real(wp) :: s(3)
      complex(wp) :: z, d

      z = cmplx(x(1), x(2), wp)
      d = 2*conjg(z)*exp(z)
      s = [2*real(exp(z), wp) - 0.5_wp*real(d, wp), 2*real(exp(z), wp) + 0.5_wp*real(d, wp), 0.5_wp*aimag(d)]
   end function exact_stress

   !> From [0,1]^2 to the domain.
   pure function place(domain, xi) result(x)
      integer(ip), intent(in) :: domain
      real(wp), intent(in) :: xi(2)
      real(wp) :: x(2)
      real(wp), parameter :: PI = acos(-1.0_wp)
      real(wp) :: r

      if (domain == DOMAIN_SQUARE) then
         x = xi + 0.08_wp*[sin(2*PI*xi(1))*sin(PI*xi(2)), sin(PI*xi(1))*sin(2*PI*xi(2))]
      else
         r = 0.5_wp + 0.5_wp*xi(1)
         x = r*[cos(0.5_wp*PI*xi(2)), sin(0.5_wp*PI*xi(2))]
      end if
   end function place

   !> Solves with n x n elements, or as many pairs of triangles, and measures. ok: the run went well.
   subroutine solve_exact_case(domain, n_nodes, n, errors, ok, formulation, beside)
      integer(ip), intent(in) :: domain, n_nodes, n
      type(errors_t), intent(out) :: errors
      logical, intent(out) :: ok
      integer(ip), intent(in), optional :: formulation !< STANDARD when left out
      integer(ip), intent(in), optional :: beside  !< nodes of every fifth square's elements, of the same degree; left out: n_nodes
      type(model_t) :: model
      type(results_t) :: results
      type(body_cache_t) :: store
      type(status_t) :: status
      type(reporter_t) :: reporter
      type(solve_options_t) :: options

      reporter%quiet = .true.
      call make_exact_model(domain, n_nodes, n, model, beside)
      if (present(formulation)) model%sections(1)%formulation = formulation
      call solve_static(model, options, reporter, results, status, store)
      ok = results%converged .and. results%law_holds
      if (ok) call measure(model, results, errors)
   end subroutine solve_exact_case

   subroutine make_exact_model(domain, n_nodes, n, model, beside)
      integer(ip), intent(in) :: domain, n_nodes, n
      type(model_t), intent(out) :: model
      integer(ip), intent(in), optional :: beside
      integer(ip) :: square(3, 3), p, i, j, k, l, m, shape
      logical :: known

      p = DEGREE_OF(n_nodes)
      m = p*n + 1
      shape = n_nodes
      do j = 0, m - 1
         do i = 0, m - 1
            call add_node(model%mesh, m*j + i + 1, place(domain, real([i, j], wp)/(m - 1)), known)
         end do
      end do
      do j = 1, n
         do i = 1, n
            do k = 0, p
               square(:p + 1, k + 1) = [(m*(p*(j - 1) + k) + p*(i - 1) + 1 + l, l=0, p)]
            end do
            if (present(beside)) shape = merge(beside, n_nodes, mod(i + 2*j, 5_ip) == 0)
            call add_square(shape, square(:p + 1, :p + 1), model)
         end do
      end do
      call trim_mesh(model%mesh)
      allocate (model%steps(1), model%materials(1), model%sections(1), model%surfaces(0), model%interactions(0), model%pairs(0))
      model%materials(1)%young = YOUNG
      model%materials(1)%poisson = POISSON
      model%sections(1)%elset = 'ALL'
      model%sections(1)%material = 1
      allocate (model%section_of(model%mesh%n_elements), source=1_ip)
      call prescribe_outline(m, model)
   end subroutine make_exact_model

   subroutine add_square(shape, square, model)
      integer(ip), intent(in) :: shape, square(:, :)
      type(model_t), intent(inout) :: model
      integer(ip) :: nodes(shape, 2), k
      logical :: known

      if (CORNERS_OF(shape) == 3) then
         nodes = triangles_of_square(square)
      else
         nodes(:, 1) = nodes_of_square(shape, square)
      end if
      do k = 1, 5 - CORNERS_OF(shape)
         call add_element(model%mesh, model%mesh%n_elements + 1, PLANE_STRAIN, nodes(:, k), known)
      end do
   end subroutine add_square

   subroutine prescribe_outline(m, model)
      integer(ip), intent(in) :: m                  !< nodes along a side
      type(model_t), intent(inout) :: model
      real(wp) :: u(2)
      integer(ip) :: i, dof

      associate (held => model%steps(1)%prescribed)
         allocate (held%node(0), held%dof(0), held%value(0))
         do i = 1, m*m
            if (min(mod(i - 1, m), (i - 1)/m) > 0 .and. max(mod(i - 1, m), (i - 1)/m) < m - 1) cycle
            u = exact_displacement(model%mesh%x(:, i))
            do dof = 1, 2
               held%node = [held%node, i]
               held%dof = [held%dof, dof]
               held%value = [held%value, u(dof)]
            end do
         end do
         held%n = size(held%node, kind=ip)
      end associate
   end subroutine prescribe_outline

   subroutine measure(model, results, errors)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      type(errors_t), intent(out) :: errors
      type(elastic_t) :: section
      real(wp) :: norms(3), exact(3), raw(3), smooth(3), strain(3), x(2), xi(2), weight, c(3, 3), d(3, 3), estimated
      real(wp), allocatable :: nodal(:, :)
      integer(ip) :: e, k, n

      section = elastic_t(YOUNG, POISSON, 1.0_wp, 0.0_wp)
      c = compliance_matrix(section, PLANE_STRAIN)
      d = elasticity_matrix(section, PLANE_STRAIN)
      norms = 0.0_wp
      do e = 1, model%mesh%n_elements
         n = model%mesh%shape(e)
         nodal = results%nodal_stress([1, 2, 4], model%mesh%nodes(:n, e))
         do k = 1, ERROR_POINTS_OF(n)
            call rule_point(n, ERROR_POINTS_OF(n), k, xi, weight)
            weight = weight*jacobian(element_coordinates(model%mesh, e), xi)
            x = matmul(element_coordinates(model%mesh, e), shape_values(n, xi))
            strain = strain_at(model, results%u, e, xi)
            if (model%sections(1)%formulation == FORMULATION_BBAR) strain(1:2) = strain(1:2) &
                                                             + 0.5_wp*(mean_dilatation(model, results%u, e) - strain(1) - strain(2))
            raw = matmul(d, strain)
            exact = exact_stress(x)
            smooth = matmul(nodal, shape_values(n, xi))
            norms(1) = norms(1) + weight*dot_product(exact, matmul(c, exact))
            norms(2) = norms(2) + weight*dot_product(raw - exact, matmul(c, raw - exact))
            norms(3) = norms(3) + weight*dot_product(smooth - exact, matmul(c, smooth - exact))
         end do
      end do
      norms = sqrt(norms)
      errors%raw = norms(2)/norms(1)
      errors%recovered = norms(3)/norms(1)
      estimated = 1.0e-2_wp*results%error_estimate
      estimated = estimated/sqrt(1 - estimated**2)*sqrt(2*results%strain_energy)
      errors%index = estimated/norms(2)
      errors%largest = largest_error(model, results)
   end subroutine measure

   pure real(wp) function largest_error(model, results)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      real(wp) :: largest
      integer(ip) :: i

      largest = 0.0_wp
      largest_error = 0.0_wp
      do i = 1, model%mesh%n_nodes
         largest = max(largest, maxval(abs(exact_stress(model%mesh%x(:, i)))))
         largest_error = max(largest_error, maxval(abs(results%nodal_stress([1, 2, 4], i) - exact_stress(model%mesh%x(:, i)))))
      end do
      largest_error = largest_error/largest
   end function largest_error

   !> e11, e22, 2 e12 of the displacements.
   pure function strain_at(model, u, e, xi) result(strain)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: u(:, :), xi(2)
      integer(ip), intent(in) :: e
      real(wp) :: strain(3), j(2, 2), h(2, 2), dn(model%mesh%shape(e), 2)

      associate (nodes => model%mesh%nodes(:model%mesh%shape(e), e))
         dn = shape_gradients(model%mesh%shape(e), xi)
         j = matmul(model%mesh%x(:, nodes), dn)
         h = matmul(matmul(u(:, nodes), dn), reshape([j(2, 2), -j(2, 1), -j(1, 2), j(1, 1)], [2, 2]))
         h = h/(j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1))
      end associate
      strain = [h(1, 1), h(2, 2), h(1, 2) + h(2, 1)]
   end function strain_at

   !> Of an element of four nodes, by its Gauss points.
   pure real(wp) function mean_dilatation(model, u, e)
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: u(:, :)
      integer(ip), intent(in) :: e
      real(wp) :: strain(3), xi(2), weight, area
      integer(ip) :: k

      mean_dilatation = 0.0_wp
      area = 0.0_wp
      do k = 1, 4
         call gauss_point(4_ip, k, xi, weight)
         weight = weight*jacobian(element_coordinates(model%mesh, e), xi)
         strain = strain_at(model, u, e, xi)
         mean_dilatation = mean_dilatation + weight*(strain(1) + strain(2))
         area = area + weight
      end do
      mean_dilatation = mean_dilatation/area
   end function mean_dilatation

   pure real(wp) function jacobian(x, xi)
      real(wp), intent(in) :: x(:, :), xi(2)
      real(wp) :: j(2, 2)

      j = matmul(x, shape_gradients(size(x, 2, kind=ip), xi))
      jacobian = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
   end function jacobian

end module exact_cases
