!> The error of the stresses in the energy norm, estimated by their distance from the recovered ones (O. C. Zienkiewicz and
!> J. Z. Zhu, Int. J. Numer. Methods Eng. 24, 1987).
module atrito_error_estimate
   use atrito_assembly, only: fem_t
   use atrito_element_table, only: MOST_NODES, ERROR_POINTS_OF
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_plane_state, only: compliance_matrix, COMPONENTS, depth_at
   use atrito_point_stress, only: point_rule_t, point_geometry_t, MOST_POINTS, make_point_rules, fetch_geometry, point_stresses
   use atrito_stress_recovery, only: stress_field_t
   use atrito_threads, only: is_shared, chunk_count, find_chunk
   implicit none (type, external)
   private
   public :: energies_t, measure_error, relative_error

   !> Integrals over all elements [F L].
   type :: energies_t
      real(wp) :: solution = 0.0_wp        !< ||u||^2, twice the strain energy
      real(wp) :: error = 0.0_wp           !< ||e||^2
      real(wp) :: round_off = 0.0_wp       !< ||.||^2 of the stresses that displacements rounded once make
      real(wp) :: strain = 0.0_wp          !< no strain at a point is larger than this; a bound, found by the stresses
   end type energies_t

   !> Errors below this many roundings of the displacements are none. Patch tests have 0.1 to 3, a bar of 1000:1 that loses ten
   !> digits 180.
   real(wp), parameter :: ROUNDINGS = 1.0e3_wp

contains

   !> Integrates (s* - s) C (s* - s) and s C s, C the compliance, by the Gauss rule of the stiffness, of triangles by a finer one.
   subroutine measure_error(fem, u, field, energies, unit)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(stress_field_t), intent(in) :: field     !< recovered from u
      type(energies_t), intent(out) :: energies
      real(wp), intent(in), optional :: unit        !< displacements and stresses are divided by it first: a power of two, so that
      !< squares of very large or small ones stay in the range of numbers
      type(point_rule_t) :: rules(MOST_NODES)
      type(energies_t) :: parts(chunk_count(fem%mesh%n_elements))
      real(wp) :: per_unit
      integer(ip) :: chunk

      per_unit = 1.0_wp
      if (present(unit)) per_unit = 1/unit
      call make_point_rules(ERROR_POINTS_OF, rules)
      !$omp parallel do schedule(dynamic) if (is_shared(fem%mesh%n_elements))
      do chunk = 1, size(parts, kind=ip)
         call measure_chunk(fem, u, field, per_unit, rules, chunk, parts(chunk))
      end do
      !$omp end parallel do
      energies%solution = sum(parts%solution)
      energies%error = sum(parts%error)
      energies%round_off = sum(parts%round_off)
      energies%strain = maxval([parts%strain, 0.0_wp])/per_unit
   end subroutine measure_error

   pure subroutine measure_chunk(fem, u, field, per_unit, rules, chunk, energies)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      type(stress_field_t), intent(in) :: field
      real(wp), intent(in) :: per_unit
      type(point_rule_t), intent(in) :: rules(MOST_NODES)
      integer(ip), intent(in) :: chunk
      type(energies_t), intent(out) :: energies
      type(point_geometry_t) :: geometry
      integer(ip) :: e, first, last

      call find_chunk(chunk, fem%mesh%n_elements, first, last)
      do e = first, last
         associate (rule => rules(fem%mesh%shape(e)))
            call fetch_geometry(fem, e, rule, geometry)
            call add_element(fem, e, u, field, per_unit, rule, geometry, energies)
         end associate
      end do
   end subroutine measure_chunk

   pure subroutine add_element(fem, e, u, field, per_unit, rule, geometry, energies)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: u(:, :)
      type(stress_field_t), intent(in) :: field
      real(wp), intent(in) :: per_unit
      type(point_rule_t), intent(in) :: rule
      type(point_geometry_t), intent(in) :: geometry
      type(energies_t), intent(inout) :: energies
      real(wp), dimension(MOST_POINTS, COMPONENTS) :: s, d
      real(wp) :: c(COMPONENTS, COMPONENTS), weight(MOST_POINTS), largest
      integer(ip) :: k, n

      n = rule%n
      c = compliance_matrix(fem%sections(geometry%section), geometry%state)
      call point_stresses(fem, e, u, rule, geometry, s)
      s(:n, :) = s(:n, :)*per_unit
      energies%strain = max(energies%strain, largest_strain(n, 0.5_wp/(geometry%d(3, 3) + min(geometry%d(1, 2), 0.0_wp)), s))
      d(:n, :) = -s(:n, :)
      largest = 0.0_wp
      do k = 1, geometry%shape
         largest = max(largest, abs(u(1, fem%mesh%nodes(k, e))), abs(u(2, fem%mesh%nodes(k, e))))
         associate (at_node => field%stress(:, field%place(k, e)), value => rule%value(:n, k))
            d(:n, 1) = d(:n, 1) + value*(at_node(1)*per_unit)
            d(:n, 2) = d(:n, 2) + value*(at_node(2)*per_unit)
            d(:n, 3) = d(:n, 3) + value*(at_node(3)*per_unit)
         end associate
      end do
      call find_volumes(fem, e, rule, geometry, weight)
      energies%solution = energies%solution + integral(n, c, s, weight)
      energies%error = energies%error + integral(n, c, d, weight)
      if (geometry%has_hoop) call add_hoop(fem, e, u, field, per_unit, rule, geometry, energies)
      energies%round_off = energies%round_off + (geometry%d(1, 1)*(EPS_MACH*(largest*per_unit))**2) &
                           *sum(weight(:n)*geometry%steepness(:n))
   end subroutine add_element

   !> A bound of the strains of an axisymmetric element at the points: the root of s11^2 + s22^2 + s33^2 + 2 s12^2 over the
   !> least of 2G and 2G + 3 lambda.
   pure real(wp) function largest_spatial_strain(n, d, s, hoop)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: d(COMPONENTS, COMPONENTS) !< elasticity matrix [F/L^2]
      real(wp), intent(in) :: s(MOST_POINTS, COMPONENTS), hoop(MOST_POINTS) !< [F/L^2]
      real(wp) :: square, compliance
      integer(ip) :: i

      square = 0.0_wp
      compliance = 1/(2*d(3, 3) + 3*min(d(1, 2), 0.0_wp))
      do i = 1, n
         square = max(square, sum((s(i, 1:2)*compliance)**2) + (hoop(i)*compliance)**2 + 2*(s(i, 3)*compliance)**2)
      end do
      largest_spatial_strain = sqrt(square)
   end function largest_spatial_strain

   !> A bound of the strains at the points: the root of s11^2 + s22^2 + 2 s12^2 over the least of 2G and 2(G + lambda).
   pure real(wp) function largest_strain(n, compliance, s)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: compliance           !< 1 over that least one [L^2/F]
      real(wp), intent(in) :: s(MOST_POINTS, COMPONENTS)
      real(wp) :: square
      integer(ip) :: i

      square = 0.0_wp
      do i = 1, n
         square = max(square, (s(i, 1)*compliance)**2 + (s(i, 2)*compliance)**2 + 2*(s(i, 3)*compliance)**2)
      end do
      largest_strain = sqrt(square)
   end function largest_strain

   !> The volumes that the points of an element stand for [L^3].
   pure subroutine find_volumes(fem, e, rule, geometry, volume)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      type(point_rule_t), intent(in) :: rule
      type(point_geometry_t), intent(in) :: geometry
      real(wp), intent(inout) :: volume(MOST_POINTS) !< the first rule%n are set
      real(wp) :: thickness, x1
      integer(ip) :: i

      thickness = fem%sections(geometry%section)%thickness
      x1 = fem%mesh%x(1, fem%mesh%nodes(1, e))
      do i = 1, rule%n
         volume(i) = rule%weight(i)*geometry%jacobian(i)*depth_at(geometry%state, thickness, x1 + geometry%place(i, 1))
      end do
   end subroutine find_volumes

   !> What the hoop stress adds to an element's integrals: c11 s33^2 + 2 c12 s33 (s11 + s22), besides that of the others.
   pure subroutine add_hoop(fem, e, u, field, per_unit, rule, geometry, energies)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: u(:, :)
      type(stress_field_t), intent(in) :: field
      real(wp), intent(in) :: per_unit
      type(point_rule_t), intent(in) :: rule
      type(point_geometry_t), intent(in) :: geometry
      type(energies_t), intent(inout) :: energies
      real(wp) :: s(MOST_POINTS, COMPONENTS), hoop(MOST_POINTS), c(COMPONENTS, COMPONENTS), flat, round
      real(wp) :: weight(MOST_POINTS)
      integer(ip) :: i

      call find_volumes(fem, e, rule, geometry, weight)
      c = compliance_matrix(fem%sections(geometry%section), geometry%state)
      call point_stresses(fem, e, u, rule, geometry, s, hoop)
      s(:rule%n, :) = s(:rule%n, :)*per_unit
      hoop(:rule%n) = hoop(:rule%n)*per_unit
      energies%strain = max(energies%strain, largest_spatial_strain(rule%n, geometry%d, s, hoop))
      associate (place => field%place(:geometry%shape, e))
         do i = 1, rule%n
            flat = s(i, 1) + s(i, 2)
            round = hoop(i)
            energies%solution = energies%solution + weight(i)*(c(1, 1)*round**2 + 2*c(1, 2)*round*flat)
            associate (value => rule%value(i, :geometry%shape))
               flat = sum(value*(field%stress(1, place) + field%stress(2, place)))*per_unit - flat
               round = sum(value*field%hoop(place))*per_unit - round
            end associate
            energies%error = energies%error + weight(i)*(c(1, 1)*round**2 + 2*c(1, 2)*round*flat)
         end do
      end associate
   end subroutine add_hoop

   !> Sum over the points of weight s C s [F L].
   pure real(wp) function integral(n, c, s, weight)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: c(COMPONENTS, COMPONENTS), s(MOST_POINTS, COMPONENTS), weight(MOST_POINTS)
      real(wp) :: density
      integer(ip) :: i

      integral = 0.0_wp
      do i = 1, n
         density = c(1, 1)*(s(i, 1)*s(i, 1) + s(i, 2)*s(i, 2)) + 2*c(1, 2)*s(i, 1)*s(i, 2) + c(3, 3)*s(i, 3)*s(i, 3)
         integral = integral + weight(i)*density
      end do
   end function integral

   !> 100 ||e|| / sqrt(||u||^2 + ||e||^2) [%]; 0 where the error is not more than the round-off of the displacements, which holds
   !> for a body at rest or in rigid motion, too.
   pure real(wp) function relative_error(energies) result(percent)
      type(energies_t), intent(in) :: energies

      percent = 0.0_wp
      if (energies%error <= ROUNDINGS**2*energies%round_off) return
      percent = 100*sqrt(energies%error/(energies%solution + energies%error))
   end function relative_error

end module atrito_error_estimate
