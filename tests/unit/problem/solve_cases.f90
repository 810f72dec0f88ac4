!> Small contact lines for the tests: one node against a rigid surface, and a line on an elastic half plane.
module solve_cases
   use atrito_average, only: build_average, identity_average
   use atrito_bound_qp, only: bound_qp_t
   use atrito_contact_line, only: contact_line_t, number_unknowns
   use atrito_friction_law, only: friction_law_t, FRICTION_LOCAL, FRICTION_NONLOCAL, KERNEL_POINTS
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: one_node, half_plane

contains

   !> A node with stiffness K and load F in the order (t, n), pressed along +n against a rigid surface: K u + q = F, u_n <= 0.
   !> With B = 1 the flexibility is C = K^-1, here in the order (n, t), and g0 = C F. Coulomb's law with exact stick.
   subroutine one_node(k, f, nu, problem, line)
      real(wp), intent(in) :: k(2, 2), f(2), nu
      type(bound_qp_t), intent(out) :: problem
      type(contact_line_t), intent(out) :: line
      real(wp) :: c(2, 2), determinant

      determinant = k(1, 1)*k(2, 2) - k(1, 2)*k(2, 1)
      c = reshape([k(1, 1), -k(1, 2), -k(2, 1), k(2, 2)], [2, 2])/determinant
      line%n = 1
      line%weight = [1.0_wp]
      line%delta = [0.0_wp]
      line%law = [friction_law_t(FRICTION_LOCAL, nu, 0.0_wp, 0.0_wp)]
      line%average = identity_average(1_ip)
      line%known_overlap = [0.0_wp]
      line%known_slip = [0.0_wp]
      call number_unknowns(line, [.true.], [.true.])
      problem%m = 2
      problem%n_normal = 1
      problem%c = c
      problem%g0 = matmul(c, [f(2), f(1)])
      problem%weight = [1.0_wp, 1.0_wp]
      allocate (problem%g(2, 0), problem%h(0))
   end subroutine one_node

   !> n points on a body of logarithmic flexibility with coupling of normal and tangential forces, pressed by a parabola and
   !> dragged; a diagonally dominant C.
   subroutine half_plane(n, nu, eps, rho, problem, line)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: nu, eps, rho
      type(bound_qp_t), intent(out) :: problem
      type(contact_line_t), intent(out) :: line
      real(wp) :: x(2, n), h, r
      integer(ip) :: i, j

      h = 2.0_wp/real(n - 1, wp)
      x = 0.0_wp
      x(1, :) = [(-1 + (i - 1)*h, i=1, n)]
      line%n = n
      allocate (line%weight(n), line%delta(n), line%law(n), line%known_overlap(n), line%known_slip(n))
      line%weight = h
      line%delta = 1.0e-6_wp
      line%law = friction_law_t(FRICTION_NONLOCAL, nu, eps, 0.0_wp)
      line%average = build_average(x, line%weight, rho, KERNEL_POINTS)
      line%known_overlap = 0.0_wp
      line%known_slip = 0.0_wp
      call number_unknowns(line, [(.true., i=1, n)], [(.true., i=1, n)])
      problem%m = 2*n
      problem%n_normal = n
      allocate (problem%c(2*n, 2*n), problem%g0(2*n), problem%g(2*n, 0), problem%h(0))
      allocate (problem%weight(2*n))
      problem%weight = h
      do j = 1, n
         do i = 1, n
            r = abs(x(1, i) - x(1, j))
            problem%c(i, j) = 2.5_wp - log(max(r, 0.4_wp*h)/2)
            problem%c(n + i, n + j) = problem%c(i, j)
            problem%c(i, n + j) = 0.2_wp*sign(min(r/h, 1.0_wp), x(1, i) - x(1, j))
            problem%c(n + j, i) = problem%c(i, n + j)
         end do
      end do
      problem%g0(:n) = 1.0_wp - 3*x(1, :)**2
      problem%g0(n + 1:) = 0.1_wp + 0.2_wp*x(1, :)
   end subroutine half_plane

end module solve_cases
