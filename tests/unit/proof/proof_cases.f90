!> Elements, tractions and small meshes for the tests of the bound of the error.
module proof_cases
   use atrito_contact_segments, only: segment_t
   use atrito_dense, only: solve_lu
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: mesh_t
   use atrito_mesh_sides, only: mesh_sides_t
   use random_arrays, only: random_numbers
   implicit none (type, external)
   private
   public :: random_element, in_equilibrium, traction_value, moments_on, GAUSS, WEIGHT, bend_mesh, forces_of_sides, &
             random_segment

   !> Three Gauss points on [0,1].
   real(wp), parameter :: GAUSS(3) = 0.5_wp + 0.38729833462074168852_wp*[real(wp) :: -1, 0, 1]
   real(wp), parameter :: WEIGHT(3) = [real(wp) :: 5, 8, 5]/18

contains

   !> A convex element of no symmetry, its first corner in the origin.
   subroutine random_element(state, n, corner)
      integer(lp), intent(inout) :: state
      integer(ip), intent(in) :: n                  !< corners
      real(wp), intent(out) :: corner(2, n)
      real(wp), parameter :: SQUARE(2, 4) = reshape([real(wp) :: 0, 0, 2, 0, 2, 2, 0, 2], [2, 4])
      real(wp) :: r(2*n)

      call random_numbers(state, r)
      corner = SQUARE(:, :n) + 0.4_wp*reshape(r, [2_ip, n])
      corner = corner - spread(corner(:, 1), 2, n)
   end subroutine random_element

   !> Random tractions along all sides, made to balance: forces and moments.
   subroutine in_equilibrium(state, corner, traction)
      integer(lp), intent(inout) :: state
      real(wp), intent(in) :: corner(:, :)
      real(wp), intent(out) :: traction(:, 0:, :)   !< (2, 0:k, sides) Bernstein coefficients, counter-clockwise
      real(wp) :: r(size(traction)), mode(2, 0:size(traction, 2) - 1, size(traction, 3), 3), gram(3, 3), change(3), x(2)
      integer(ip) :: i, j, k, n, info

      call random_numbers(state, r)
      traction = reshape(r, shape(traction))
      n = size(corner, 2, kind=ip)
      k = size(traction, 2, kind=ip) - 1
      do i = 1, n
         do j = 0, k
            x = corner(:, i) + real(j, wp)/k*(corner(:, 1 + mod(i, n)) - corner(:, i))
            mode(:, j, i, 1) = [1.0_wp, 0.0_wp]
            mode(:, j, i, 2) = [0.0_wp, 1.0_wp]
            mode(:, j, i, 3) = [-x(2), x(1)]
         end do
      end do
      do i = 1, 3
         gram(:, i) = resultants(corner, mode(:, :, :, i))
      end do
      change = -resultants(corner, traction)
      call solve_lu(gram, change, info)
      do i = 1, 3
         traction = traction + change(i)*mode(:, :, :, i)
      end do
   end subroutine in_equilibrium

   !> Forces and the moment about the origin.
   function resultants(corner, traction) result(sums)
      real(wp), intent(in) :: corner(:, :), traction(:, 0:, :)
      real(wp) :: sums(3), t(2), x(2), side(2)
      integer(ip) :: i, q, n

      n = size(corner, 2, kind=ip)
      sums = 0.0_wp
      do i = 1, n
         side = corner(:, 1 + mod(i, n)) - corner(:, i)
         do q = 1, 3
            t = traction_value(traction(:, :, i), GAUSS(q))*WEIGHT(q)*norm2(side)
            x = corner(:, i) + GAUSS(q)*side
            sums = sums + [t, x(1)*t(2) - x(2)*t(1)]
         end do
      end do
   end function resultants

   !> A traction from its Bernstein coefficients at a place of a side, 0 to 1.
   pure function traction_value(traction, s) result(t)
      real(wp), intent(in) :: traction(:, 0:)
      real(wp), intent(in) :: s
      real(wp) :: t(2)

      if (size(traction, 2) == 2) then
         t = (1 - s)*traction(:, 0) + s*traction(:, 1)
      else
         t = (1 - s)**2*traction(:, 0) + 2*s*(1 - s)*traction(:, 1) + s**2*traction(:, 2)
      end if
   end function traction_value

   !> int T N_i ds by quadrature: both ends, and the middle of three functions.
   pure function moments_on(traction, length, n_nodes) result(b)
      real(wp), intent(in) :: traction(:, 0:)
      real(wp), intent(in) :: length
      integer(ip), intent(in) :: n_nodes            !< of the side: 2, 3
      real(wp) :: b(2, n_nodes), s, n(3)
      integer(ip) :: q

      b = 0.0_wp
      do q = 1, 3
         s = GAUSS(q)
         n = [1 - s, s, 0.0_wp]
         if (n_nodes == 3) n = [(1 - s)*(1 - 2*s), s*(2*s - 1), 4*s*(1 - s)]
         b = b + WEIGHT(q)*length*spread(traction_value(traction, s), 2, n_nodes)*spread(n(:n_nodes), 1, 2)
      end do
   end function moments_on

   !> Puts a mesh out of shape: for elements of first degree, whose sides stay straight.
   subroutine bend_mesh(mesh)
      type(mesh_t), intent(inout) :: mesh
      integer(ip) :: i

      do i = 1, mesh%n_nodes
         associate (x => mesh%x(:, i))
            x = x + 0.15_wp*[sin(2*x(1) + x(2)), cos(x(1) - 1.7_wp*x(2))]
         end associate
      end do
   end subroutine bend_mesh

   !> The forces on the nodes of all elements that tractions along their sides make.
   subroutine forces_of_sides(mesh, sides, traction, force)
      type(mesh_t), intent(in) :: mesh
      type(mesh_sides_t), intent(in) :: sides
      real(wp), intent(in) :: traction(:, 0:, :)    !< (2, 0:k, sides) on the first element
      real(wp), intent(out) :: force(:, :, :)       !< (2, nodes, elements)
      integer(ip) :: i, j, n, which, place
      real(wp) :: b(2, 3)
      integer(ip) :: nodes(3)

      force = 0.0_wp
      do i = 1, sides%n
         n = merge(3, 2, sides%middle(i) > 0)
         nodes = [sides%node(:, i), sides%middle(i)]
         b(:, :n) = moments_on(traction(:, :, i), norm2(mesh%x(:, nodes(2)) - mesh%x(:, nodes(1))), n)
         do which = 1, 2
            associate (e => sides%element(which, i))
               if (e == 0) cycle
               do j = 1, n
                  place = findloc(mesh%nodes(:mesh%shape(e), e), nodes(j), dim=1, kind=ip)
                  force(:, place, e) = force(:, place, e) + merge(1, -1, which == 1)*b(:, j)
               end do
            end associate
         end do
      end do
   end subroutine forces_of_sides

   !> A segment whose nodes 1 to 3 are the slave's and lie above, 4 to 6 the master's; the normal points down.
   subroutine random_segment(state, which, segment)
      integer(lp), intent(inout) :: state
      integer(ip), intent(in) :: which
      type(segment_t), intent(out) :: segment
      real(wp) :: r(12)

      call random_numbers(state, r)
      segment%n = 2 + mod(which, 2)
      segment%n_master = 2 + mod(which/2, 2)
      segment%node = [1_ip, 2_ip, 3_ip]
      segment%master_node = [4_ip, 5_ip, 6_ip]
      segment%master = 1
      segment%on_slave = [0.1_wp, 0.9_wp]
      segment%on_master = [0.8_wp, 0.3_wp]
      segment%length = 0.7_wp
      segment%thickness = 1.3_wp
      segment%normal = [0.0_wp, -1.0_wp]
      segment%p = abs(r(:2))
      segment%tau = abs(r(3:4))
      segment%t = r(5:6)*segment%tau
      segment%gap = 0.2_wp*r(7:8)
      segment%rest = 0.1_wp*r(9:10)
      segment%delta = merge(0.0_wp, 0.3_wp, mod(which, 3) == 0)
      if (mod(which, 4) == 1) segment%eps = 0.2_wp
      if (mod(which, 4) == 2) segment%compliance = 0.3_wp
   end subroutine random_segment

end module proof_cases
