!> The rows N_j and T_j of equation (8): relative displacements at the points from nodal displacements.
module atrito_contact_rows
   use atrito_kinds, only: ip, wp
   use atrito_points, only: contact_points_t, MOST_MASTER_NODES
   implicit none (type, external)
   private
   public :: contact_rows_t, build_rows, row_value, ROW_ENTRIES

   integer(ip), parameter :: ROW_ENTRIES = 1 + MOST_MASTER_NODES

   !> Row of point j along a direction d_j: sum_k coefficient(k,j) d_j . u(node(k,j)).
   type :: contact_rows_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: entries(:)         !< (n) nodes in the row
      integer(ip), allocatable :: node(:, :)         !< (ROW_ENTRIES, n)
      real(wp), allocatable :: coefficient(:, :)     !< (ROW_ENTRIES, n): +1 slave, minus the master's shape functions
      real(wp), allocatable :: normal(:, :)          !< (2, n) n
      real(wp), allocatable :: tangent(:, :)         !< (2, n) T, n turned by +90 degrees
      real(wp), allocatable :: gap(:)                !< (n) initial distance s_j [L]
   end type contact_rows_t

contains

   !> The rows of all pairs, one pair after the other.
   pure subroutine build_rows(points, rows)
      type(contact_points_t), intent(in) :: points(:)
      type(contact_rows_t), intent(out) :: rows
      integer(ip) :: i, j, k, m

      rows%n = sum(points%n)
      allocate (rows%entries(rows%n), rows%node(ROW_ENTRIES, rows%n), source=0_ip)
      allocate (rows%coefficient(ROW_ENTRIES, rows%n), rows%normal(2, rows%n), rows%tangent(2, rows%n), rows%gap(rows%n), &
                source=0.0_wp)
      m = 0
      do i = 1, size(points, kind=ip)
         do j = 1, points(i)%n
            m = m + 1
            rows%normal(:, m) = points(i)%normal(:, j)
            rows%tangent(:, m) = [-points(i)%normal(2, j), points(i)%normal(1, j)]
            rows%gap(m) = points(i)%gap(j)
            call add_entry(rows, m, points(i)%node(j), 1.0_wp)
            do k = 1, points(i)%n_master(j)
               call add_entry(rows, m, points(i)%master_node(k, j), -points(i)%master_shape(k, j))
            end do
         end do
      end do
   end subroutine build_rows

   pure subroutine add_entry(rows, j, node, coefficient)
      type(contact_rows_t), intent(inout) :: rows
      integer(ip), intent(in) :: j, node
      real(wp), intent(in) :: coefficient

      if (coefficient == 0.0_wp) return
      rows%entries(j) = rows%entries(j) + 1
      rows%node(rows%entries(j), j) = node
      rows%coefficient(rows%entries(j), j) = coefficient
   end subroutine add_entry

   !> The relative displacement [L] of point j along a direction.
   pure real(wp) function row_value(rows, j, direction, u) result(value)
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: j
      real(wp), intent(in) :: direction(2)
      real(wp), intent(in) :: u(:, :)                !< (2, n_nodes) [L]
      integer(ip) :: k

      value = 0.0_wp
      do k = 1, rows%entries(j)
         value = value + rows%coefficient(k, j)*dot_product(direction, u(:, rows%node(k, j)))
      end do
   end function row_value

end module atrito_contact_rows
