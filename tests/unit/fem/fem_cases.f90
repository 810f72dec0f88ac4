!> Elements and small meshes for the tests of fem.
module fem_cases
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: find_bodies, number_equations
   use atrito_element_table, only: TABLE => SHAPES, DEGREE_OF, CORNERS_OF
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: add_element, add_node, nodes_of_square, trim_mesh
   use atrito_plane_state, only: elastic_t, PLANE_STRAIN
   use atrito_triangle_pieces, only: triangles_of_square
   implicit none (type, external)
   private
   public :: SHAPES, PLACES, node_places, distorted, linear_field, row_of_elements, dense_stiffness, grid_of_elements

   integer(ip), parameter :: SHAPES(5) = [4_ip, 9_ip, 8_ip, 3_ip, 6_ip]
   !> Places in the parent element where functions are tried.
   real(wp), parameter :: PLACES(2, 4) = reshape([0.0_wp, 0.0_wp, 0.3_wp, -0.7_wp, -1.0_wp, 0.45_wp, 0.9_wp, 1.0_wp], [2, 4])
   !> Places of the nodes: corners, mid-sides, centre; of triangles those of the table.
   real(wp), parameter :: GRID(2, 9_ip) = reshape([-1.0_wp, -1.0_wp, 1.0_wp, -1.0_wp, 1.0_wp, 1.0_wp, -1.0_wp, 1.0_wp, &
                                                   0.0_wp, -1.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, -1.0_wp, 0.0_wp, &
                                                   0.0_wp, 0.0_wp], [2, 9])

contains

   !> The parent coordinates of an element's nodes.
   pure function node_places(n_nodes) result(xi)
      integer(ip), intent(in) :: n_nodes
      real(wp) :: xi(2, n_nodes)

      xi = GRID(:, :n_nodes)
      if (CORNERS_OF(n_nodes) == 3) xi = TABLE(n_nodes)%place(:, :n_nodes)
   end function node_places

   !> A quadrilateral or triangle of no symmetry, straight-sided, its corners far from the origin by `shift`; nodes between the corners
   !> are where the bilinear map puts them.
   pure function distorted(n_nodes, shift) result(x)
      integer(ip), intent(in) :: n_nodes
      real(wp), intent(in) :: shift
      real(wp) :: x(2, n_nodes)
      real(wp), parameter :: CORNERS(2, 4) = reshape([0.0_wp, 0.0_wp, 2.0_wp, 0.3_wp, 2.5_wp, 1.9_wp, -0.2_wp, 1.4_wp], [2, 4])
      integer(ip) :: i, k

      if (CORNERS_OF(n_nodes) == 3) then
         do i = 1, n_nodes
            x(:, i) = shift + matmul(CORNERS(:, 2:3), TABLE(n_nodes)%place(:, i))
         end do
         return
      end if
      do i = 1, n_nodes
         x(:, i) = shift
         do k = 1, 4
            x(:, i) = x(:, i) + CORNERS(:, k)*0.25_wp*(1 + GRID(1, k)*GRID(1, i))*(1 + GRID(2, k)*GRID(2, i))
         end do
      end do
   end function distorted

   !> u = gradient x, (2, n).
   pure function linear_field(gradient, x) result(u)
      real(wp), intent(in) :: gradient(2, 2), x(:, :)
      real(wp) :: u(2, size(x, 2))

      u = matmul(gradient, x)
   end function linear_field

   !> Q1 elements side by side with the given widths, height 1; none is held, the nodes on the right side are the contact's.
   subroutine row_of_elements(widths, state, fem)
      real(wp), intent(in) :: widths(:)
      integer(ip), intent(in) :: state(:)              !< of each element
      type(fem_t), intent(out) :: fem
      logical, allocatable :: held(:, :)
      logical :: known
      integer(ip) :: i, n

      allocate (fem%mesh)
      n = size(widths, kind=ip)
      do i = 0, n
         call add_node(fem%mesh, 2*i + 1, [sum(widths(:i)), 0.0_wp], known)
         call add_node(fem%mesh, 2*i + 2, [sum(widths(:i)), 1.0_wp], known)
      end do
      do i = 1, n
         call add_element(fem%mesh, i, state(i), [2*i - 1, 2*i + 1, 2*i + 2, 2*i], known)
      end do
      call trim_mesh(fem%mesh)
      fem%sections = [elastic_t(200.0_wp, 0.3_wp, 0.5_wp, 0.0_wp), elastic_t(90.0_wp, 0.2_wp, 1.0_wp, 0.0_wp)]
      allocate (fem%section_of(n), source=1_ip)
      call find_bodies(fem%mesh, fem%bodies)
      allocate (held(2, fem%mesh%n_nodes), source=.false.)
      call number_equations(fem%mesh, fem%bodies, 1_ip, held, [2*n + 1, 2*n + 2], .true.)
   end subroutine row_of_elements

   !> nx x ny elements, or as many pairs of triangles, of one section on [0, nx] x [0, ny], nodes row by row; no bodies, no equations.
   subroutine grid_of_elements(n_nodes, nx, ny, fem)
      integer(ip), intent(in) :: n_nodes               !< 3, 4, 6 or 9
      integer(ip), intent(in) :: nx, ny
      type(fem_t), intent(out) :: fem
      integer(ip), parameter :: SOME(3) = [1, 2, 3]
      integer(ip) :: square(3, 3), pair(n_nodes, 2), p, i, j, k, row
      logical :: known

      allocate (fem%mesh)
      p = DEGREE_OF(n_nodes)
      row = p*nx + 1
      do j = 0, p*ny
         do i = 0, p*nx
            call add_node(fem%mesh, row*j + i + 1, [real(i, wp)/p, real(j, wp)/p], known)
         end do
      end do
      do j = 1, ny
         do i = 1, nx
            do k = 0, p
               square(:p + 1, k + 1) = row*(p*(j - 1) + k) + p*(i - 1) + SOME(:p + 1)
            end do
            if (CORNERS_OF(n_nodes) == 3) then
               pair = triangles_of_square(square(:p + 1, :p + 1))
               do k = 1, 2
                  call add_element(fem%mesh, 2*(nx*(j - 1) + i) + k - 2, PLANE_STRAIN, pair(:, k), known)
               end do
            else
               call add_element(fem%mesh, nx*(j - 1) + i, PLANE_STRAIN, nodes_of_square((p + 1)**2, square(:p + 1, :p + 1)), known)
            end if
         end do
      end do
      call trim_mesh(fem%mesh)
      fem%sections = [elastic_t(200.0_wp, 0.3_wp, 0.5_wp, 0.0_wp), elastic_t(90.0_wp, 0.2_wp, 1.0_wp, 0.0_wp)]
      allocate (fem%section_of(fem%mesh%n_elements), source=1_ip)
   end subroutine grid_of_elements

   !> The full matrix of some element stiffnesses, in the order u1, u2 of node 1, of node 2, ...
   pure subroutine dense_stiffness(nodes, k, dense)
      integer(ip), intent(in) :: nodes(:)
      real(wp), intent(in) :: k(:, :)
      real(wp), intent(inout) :: dense(:, :)
      integer(ip) :: dofs(2*size(nodes)), i

      dofs = [(2*nodes(i) - 1, 2*nodes(i), i=1, size(nodes))]
      dense(dofs, dofs) = dense(dofs, dofs) + k
   end subroutine dense_stiffness

end module fem_cases
