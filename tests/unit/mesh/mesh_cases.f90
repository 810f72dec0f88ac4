!> Small meshes for the tests.
module mesh_cases
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, add_node, add_element, trim_mesh
   use atrito_plane_state, only: PLANE_STRAIN
   implicit none (type, external)
   private
   public :: grid, two_grids, ring

contains

   !> nx times ny unit squares from the origin; nodes and elements row by row from the bottom, ids ten times their places.
   subroutine grid(nx, ny, mesh)
      integer(ip), intent(in) :: nx, ny
      type(mesh_t), intent(out) :: mesh

      call add_grid(nx, ny, 0.0_wp, mesh)
      call trim_mesh(mesh)
   end subroutine grid

   !> Two grids, the second one above the first with a gap of 1.
   subroutine two_grids(nx, ny, mesh)
      integer(ip), intent(in) :: nx, ny
      type(mesh_t), intent(out) :: mesh

      call add_grid(nx, ny, 0.0_wp, mesh)
      call add_grid(nx, ny, real(ny + 1, wp), mesh)
      call trim_mesh(mesh)
   end subroutine two_grids

   subroutine add_grid(nx, ny, y0, mesh)
      integer(ip), intent(in) :: nx, ny
      real(wp), intent(in) :: y0
      type(mesh_t), intent(inout) :: mesh
      integer(ip) :: i, j, before, first
      logical :: known

      before = mesh%n_nodes
      do j = 0, ny
         do i = 0, nx
            call add_node(mesh, 10*(mesh%n_nodes + 1), [real(i, wp), y0 + real(j, wp)], known)
         end do
      end do
      do j = 0, ny - 1
         do i = 1, nx
            first = before + i + j*(nx + 1)
            call add_element(mesh, 10*(mesh%n_elements + 1), PLANE_STRAIN, &
                             [first, first + 1, first + nx + 2, first + nx + 1], known)
         end do
      end do
   end subroutine add_grid

   !> Eight squares round a hole: a grid of three by three without its middle.
   subroutine ring(mesh)
      type(mesh_t), intent(out) :: mesh
      type(mesh_t) :: full
      integer(ip) :: i
      logical :: known

      call grid(3_ip, 3_ip, full)
      do i = 1, full%n_nodes
         call add_node(mesh, i, full%x(:, i), known)
      end do
      do i = 1, full%n_elements
         if (i /= 5) call add_element(mesh, i, PLANE_STRAIN, full%nodes(:4, i), known)
      end do
      call trim_mesh(mesh)
   end subroutine ring

end module mesh_cases
