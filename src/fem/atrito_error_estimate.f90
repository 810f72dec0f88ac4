!> The error of the stresses in the energy norm, estimated by their distance from the recovered ones (O. C. Zienkiewicz and
!> J. Z. Zhu, Int. J. Numer. Methods Eng. 24, 1987).
module atrito_error_estimate
   use atrito_assembly, only: fem_t
   use atrito_elasticity, only: compliance_matrix
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_mesh, only: Q1_NODES, Q2_NODES
   use atrito_point_stress, only: point_rule_t, element_data_t, point_values_t, MOST_POINTS, make_point_rule, fetch_element, &
                                  point_stresses
   use atrito_shape_functions, only: gauss_count
   use atrito_stress_recovery, only: stress_field_t
   implicit none (type, external)
   private
   public :: energies_t, measure_error, relative_error

   !> Integrals over all elements [F L].
   type :: energies_t
      real(wp) :: solution = 0.0_wp        !< ||u||^2, twice the strain energy
      real(wp) :: error = 0.0_wp           !< ||e||^2
      real(wp) :: round_off = 0.0_wp       !< ||.||^2 of the stresses that displacements rounded once make
   end type energies_t

   !> Errors below this many roundings of the displacements are none. Patch tests have 0.1 to 3, a bar of 1000:1 that loses ten
   !> digits 180.
   real(wp), parameter :: ROUNDINGS = 1.0e3_wp

contains

   !> Integrates (s* - s) C (s* - s) and s C s, C the compliance, by the Gauss rule of the stiffness.
   pure subroutine measure_error(fem, u, field, energies)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(stress_field_t), intent(in) :: field     !< recovered from u
      type(energies_t), intent(out) :: energies
      type(point_rule_t) :: rules(2)
      integer(ip) :: e

      call make_point_rule(Q1_NODES, gauss_count(Q1_NODES), rules(1))
      call make_point_rule(Q2_NODES, gauss_count(Q2_NODES), rules(2))
      do e = 1, fem%mesh%n_elements
         call add_element(fem, e, u, field, rules(merge(1, 2, fem%mesh%shape(e) == Q1_NODES)), energies)
      end do
   end subroutine measure_error

   pure subroutine add_element(fem, e, u, field, rule, energies)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: u(:, :)
      type(stress_field_t), intent(in) :: field
      type(point_rule_t), intent(in) :: rule
      type(energies_t), intent(inout) :: energies
      type(element_data_t) :: data
      type(point_values_t) :: at
      real(wp) :: s(3), d(MOST_POINTS, 3), c(3, 3), at_node(3), weight, largest
      integer(ip) :: i, k, j

      call fetch_element(fem, e, u, data)
      c = compliance_matrix(fem%sections(fem%section_of(e)), fem%mesh%state(e))
      call point_stresses(data, rule, at)
      d(:rule%n, :) = -at%s(:rule%n, :)
      largest = 0.0_wp
      do k = 1, data%n
         at_node = field%stress(:, field%place(k, e))
         largest = max(largest, maxval(abs(u(:, fem%mesh%nodes(k, e)))))
         do j = 1, 3
            d(:rule%n, j) = d(:rule%n, j) + rule%value(:rule%n, k)*at_node(j)
         end do
      end do
      do i = 1, rule%n
         weight = rule%weight(i)*at%jacobian(i)*fem%sections(fem%section_of(e))%thickness
         s = at%s(i, :)
         energies%solution = energies%solution + weight*density(c, s)
         energies%error = energies%error + weight*density(c, d(i, :))
         energies%round_off = energies%round_off + weight*data%d(1, 1)*at%steepness(i)*(EPS_MACH*largest)**2
      end do
   end subroutine add_element

   !> s C s [F/L^2].
   pure real(wp) function density(c, s)
      real(wp), intent(in) :: c(3, 3), s(3)

      density = c(1, 1)*(s(1)*s(1) + s(2)*s(2)) + 2*c(1, 2)*s(1)*s(2) + c(3, 3)*s(3)*s(3)
   end function density

   !> 100 ||e|| / sqrt(||u||^2 + ||e||^2) [%]; 0 where the error is not more than the round-off of the displacements, which holds
   !> for a body at rest or in rigid motion, too.
   pure real(wp) function relative_error(energies) result(percent)
      type(energies_t), intent(in) :: energies

      percent = 0.0_wp
      if (energies%error <= ROUNDINGS**2*energies%round_off) return
      percent = 100*sqrt(energies%error/(energies%solution + energies%error))
   end function relative_error

end module atrito_error_estimate
