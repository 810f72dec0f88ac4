!> The error of the stresses in the energy norm, estimated by their distance from the recovered ones (O. C. Zienkiewicz and
!> J. Z. Zhu, Int. J. Numer. Methods Eng. 24, 1987).
!>
!> With C the compliance, s the stresses of the displacements and s* the continuous ones (atrito_stress_recovery),
!>
!>     ||e||^2 = int (s* - s) C (s* - s) dV,      ||u||^2 = int s C s dV,      relative error = ||e|| / sqrt(||u||^2 + ||e||^2).
!>
!> s* converges faster than s, so the estimate over the true error goes to 1 as the mesh becomes finer. ||u||^2 + ||e||^2 is the
!> energy of the true solution where the error is orthogonal to the displacements of the mesh, as it is without contact.
!>
!> Where everything that is left is round-off there is no error to speak of: displacements that were rounded once make stresses of
!> about D eps |u|/h, whose norm (round_off) is what ||e|| is compared with.
module atrito_error_estimate
   use atrito_assembly, only: fem_t
   use atrito_element_table, only: MOST_NODES, ERROR_POINTS_OF
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_orthotropy, only: SPATIAL, IN_PLANE, ACROSS
   use atrito_plane_state, only: compliance_matrix, COMPONENTS
   use atrito_point_stress, only: point_rule_t, point_geometry_t, MOST_POINTS, make_point_rules, fetch_geometry, point_stresses, &
                                  point_depth
   use atrito_stress_recovery, only: stress_field_t
   use atrito_threads, only: is_shared, chunk_count, find_chunk
   implicit none (type, external)
   private
   public :: energies_t, measure_error, integrate_error, relative_error, share_errors

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
   subroutine measure_error(fem, u, field, energies, unit, element_error)
      type(fem_t), intent(in) :: fem                !< mesh and sections are read
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(stress_field_t), intent(in) :: field     !< recovered from u
      type(energies_t), intent(out) :: energies     !< sums over all elements, over unit**2
      real(wp), intent(in), optional :: unit        !< displacements and stresses are divided by it first: a power of two, so that
      !< squares of very large or small ones stay in the range of numbers
      real(wp), intent(out), optional :: element_error(:) !< (n_elements) share of the relative error, whose square is the sum of
      !< their squares [%]

      call integrate_error(fem, u, field, energies, unit, element_error)
      if (present(element_error)) element_error = share_errors(energies, element_error)
   end subroutine measure_error

   !> The integrals alone.
   subroutine integrate_error(fem, u, field, energies, unit, square)
      type(fem_t), intent(in) :: fem                !< mesh and sections are read
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(stress_field_t), intent(in) :: field     !< recovered from u
      type(energies_t), intent(out) :: energies     !< sums over all elements, over unit**2
      real(wp), intent(in), optional :: unit        !< as that of measure_error
      real(wp), intent(out), optional :: square(:)  !< (n_elements) ||e||^2 [F L]
      type(point_rule_t) :: rules(MOST_NODES)
      type(energies_t) :: parts(chunk_count(fem%mesh%n_elements))
      real(wp) :: per_unit
      integer(ip) :: chunk

      per_unit = 1.0_wp
      if (present(unit)) per_unit = 1/unit
      call make_point_rules(ERROR_POINTS_OF, rules)
      !$omp parallel do schedule(dynamic) if (is_shared(fem%mesh%n_elements))
      do chunk = 1, size(parts, kind=ip)
         call measure_chunk(fem, u, field, per_unit, rules, chunk, parts(chunk), square)
      end do
      !$omp end parallel do
      energies%solution = sum(parts%solution)
      energies%error = sum(parts%error)
      energies%round_off = sum(parts%round_off)
      energies%strain = maxval([parts%strain, 0.0_wp])/per_unit
   end subroutine integrate_error

   !> From ||e||^2 of the elements to their shares of the relative error [%].
   pure function share_errors(energies, squares) result(shares)
      type(energies_t), intent(in) :: energies      !< of all elements
      real(wp), intent(in) :: squares(:)            !< [F L]
      real(wp) :: shares(size(squares))

      shares = 0.0_wp
      if (relative_error(energies) > 0.0_wp) shares = 100*sqrt(squares/(energies%solution + energies%error))
   end function share_errors

   !> For each element, by the points of a rule:
   !>
   !>     s       D B u, less what the temperature takes
   !>     d       sum_k N_k s*_k - s, s*_k the recovered stresses of its nodes
   !>     sums    of volume s C s, of volume d C d, and of volume max(D11, D22) (eps |u|)^2 |dxi/dx|^2, the round-off
   !>
   !> In rings s33 adds its own terms (add_hoop). The sums of a chunk of elements are added up by themselves and the chunks then in
   !> their order, so the numbers do not depend on how many threads there are.
   pure subroutine measure_chunk(fem, u, field, per_unit, rules, chunk, energies, square)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      type(stress_field_t), intent(in) :: field
      real(wp), intent(in) :: per_unit
      type(point_rule_t), intent(in) :: rules(MOST_NODES)
      integer(ip), intent(in) :: chunk
      type(energies_t), intent(out) :: energies
      real(wp), intent(inout), optional :: square(:) !< ||e||^2 of the chunk's elements [F L]
      type(point_geometry_t) :: geometry
      type(energies_t) :: alone
      integer(ip) :: e, first, last

      call find_chunk(chunk, fem%mesh%n_elements, first, last)
      do e = first, last
         associate (rule => rules(fem%mesh%shape(e)))
            call fetch_geometry(fem, e, rule, geometry)
            call add_element(rule, energies)
            if (.not. present(square)) cycle
            alone = energies_t()
            call add_element(rule, alone)
            square(e) = alone%error
         end associate
      end do

   contains

      pure subroutine add_element(rule, energies)
         type(point_rule_t), intent(in) :: rule
         type(energies_t), intent(inout) :: energies
         real(wp), dimension(MOST_POINTS, COMPONENTS) :: s, d
         real(wp) :: c(COMPONENTS, COMPONENTS), weight(MOST_POINTS), largest
         integer(ip) :: k, n

         n = rule%n
         c = compliance_matrix(fem%sections(geometry%section), geometry%state)
         call point_stresses(fem, e, u, rule, geometry, s)
         s(:n, :) = s(:n, :)*per_unit
         if (geometry%is_orthotropic) then
            if (.not. geometry%has_hoop) energies%strain = max(energies%strain, largest_orthotropic_strain(n, c, s))
         else
            energies%strain = max(energies%strain, largest_strain(n, 0.5_wp/(geometry%d(3, 3) + min(geometry%d(1, 2), 0.0_wp)), s))
         end if
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
         if (geometry%is_orthotropic) then
            energies%solution = energies%solution + orthotropic_integral(n, c, s, weight)
            energies%error = energies%error + orthotropic_integral(n, c, d, weight)
         else
            energies%solution = energies%solution + integral(n, c, s, weight)
            energies%error = energies%error + integral(n, c, d, weight)
         end if
         if (geometry%has_hoop) call add_hoop(fem, e, u, field, per_unit, rule, geometry, energies)
         energies%round_off = energies%round_off + (max(geometry%d(1, 1), geometry%d(2, 2))*(EPS_MACH*(largest*per_unit))**2) &
                              *sum(weight(:n)*geometry%steepness(:n))
      end subroutine add_element

   end subroutine measure_chunk

   !> The largest root of e11^2 + e22^2 + 2 e12^2 at the points; of rings add_orthotropic_hoop has the strains.
   pure real(wp) function largest_orthotropic_strain(n, c, s)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: c(COMPONENTS, COMPONENTS), s(MOST_POINTS, COMPONENTS)
      real(wp) :: square, e(COMPONENTS)
      integer(ip) :: i

      square = 0.0_wp
      do i = 1, n
         e = matmul(c, s(i, :))
         square = max(square, e(1)**2 + e(2)**2 + 0.5_wp*e(3)**2)
      end do
      largest_orthotropic_strain = sqrt(square)
   end function largest_orthotropic_strain

   !> A bound of the strains at the points: the root of s11^2 + s22^2 + s33^2 + 2 s12^2 over the least of the moduli of elasticity;
   !> s33 of rings alone. (That root is the norm of the stress tensor, whose directions of eigenstates isotropic elasticity keeps:
   !> a deviator has 2G times its strain, a dilatation 2(G + lambda) of it in the plane and 2G + 3 lambda in space. So no strain is
   !> longer than the stress over the least of the two.)
   pure real(wp) function largest_strain(n, compliance, s, hoop)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: compliance           !< 1 over the least of 2G and 2(G + lambda), or 2G and 2G + 3 lambda [L^2/F]
      real(wp), intent(in) :: s(MOST_POINTS, COMPONENTS)
      real(wp), intent(in), optional :: hoop(MOST_POINTS) !< s33 [F/L^2]; left out: 0
      real(wp) :: square, s33
      integer(ip) :: i

      square = 0.0_wp
      s33 = 0.0_wp
      do i = 1, n
         if (present(hoop)) s33 = hoop(i)
         square = max(square, (s(i, 1)*compliance)**2 + (s(i, 2)*compliance)**2 + (s33*compliance)**2 + 2*(s(i, 3)*compliance)**2)
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
         volume(i) = rule%weight(i)*geometry%jacobian(i)*point_depth(geometry, rule, i, thickness, x1)
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
      if (.not. geometry%is_orthotropic) then
         energies%strain = max(energies%strain, largest_strain(rule%n, 1/(2*geometry%d(3, 3) + 3*min(geometry%d(1, 2), 0.0_wp)), &
                                                               s, hoop))
      end if
      associate (place => field%place(:geometry%shape, e))
         do i = 1, rule%n
            associate (value => rule%value(i, :geometry%shape))
               if (geometry%is_orthotropic) then
                  call add_orthotropic_hoop(fem%sections(geometry%section)%compliance, weight(i), &
                                            [s(i, 1:2), hoop(i), s(i, 3)], per_unit*[matmul(field%stress(1:2, place), value), &
                                                                 sum(value*field%hoop(place)), sum(value*field%stress(3, place))], &
                                            energies)
                  cycle
               end if
               flat = s(i, 1) + s(i, 2)
               round = hoop(i)
               energies%solution = energies%solution + weight(i)*(c(1, 1)*round**2 + 2*c(1, 2)*round*flat)
               flat = sum(value*(field%stress(1, place) + field%stress(2, place)))*per_unit - flat
               round = sum(value*field%hoop(place))*per_unit - round
            end associate
            energies%error = energies%error + weight(i)*(c(1, 1)*round**2 + 2*c(1, 2)*round*flat)
         end do
      end associate
   end subroutine add_hoop

   !> The same of any elasticity, at a point, with the strains of the whole: S33 s33^2 + 2 s33 (S13 s11 + S23 s22 + S34 s12).
   pure subroutine add_orthotropic_hoop(c, weight, s, smooth, energies)
      real(wp), intent(in) :: c(SPATIAL, SPATIAL)  !< compliance [L^2/F]
      real(wp), intent(in) :: weight               !< [L^3]
      real(wp), intent(in) :: s(SPATIAL)           !< s11, s22, s33, s12 ...
      real(wp), intent(in) :: smooth(SPATIAL)      !< ... and those that are continuous
      type(energies_t), intent(inout) :: energies
      real(wp) :: e(SPATIAL)

      e = matmul(c, s)
      energies%strain = max(energies%strain, sqrt(e(1)**2 + e(2)**2 + e(3)**2 + 0.5_wp*e(4)**2))
      energies%solution = energies%solution + weight*hoop_work(c, s)
      energies%error = energies%error + weight*hoop_work(c, smooth - s)
   end subroutine add_orthotropic_hoop

   !> What s33 adds to the energy of the others.
   pure real(wp) function hoop_work(c, s)
      real(wp), intent(in) :: c(SPATIAL, SPATIAL), s(SPATIAL)

      hoop_work = c(ACROSS, ACROSS)*s(ACROSS)**2 + 2*s(ACROSS)*dot_product(c(ACROSS, IN_PLANE), s(IN_PLANE))
   end function hoop_work

   !> Sum over the points of weight s C s [F L], of any C.
   pure real(wp) function orthotropic_integral(n, c, s, weight) result(integral)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: c(COMPONENTS, COMPONENTS), s(MOST_POINTS, COMPONENTS), weight(MOST_POINTS)
      integer(ip) :: i

      integral = 0.0_wp
      do i = 1, n
         integral = integral + weight(i)*dot_product(s(i, :), matmul(c, s(i, :)))
      end do
   end function orthotropic_integral

   !> Sum over the points of weight s C s [F L], of an isotropic C: c11 (s11^2 + s22^2) + 2 c12 s11 s22 + c33 s12^2 with c33 = 1/G.
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
      type(energies_t), intent(in) :: energies !< of all elements

      percent = 0.0_wp
      if (energies%error <= ROUNDINGS**2*energies%round_off) return
      percent = 100*sqrt(energies%error/(energies%solution + energies%error))
   end function relative_error

end module atrito_error_estimate
