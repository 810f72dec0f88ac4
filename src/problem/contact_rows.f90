!> The rows N_j and T_j of equation (8): relative displacements at the points from nodal displacements.
!>
!>     N_j u = sum_k (c_jk n_j + e_k^N n_j) . u_k,     T_j u = sum_k (c_jk T_j + e_k^T n_j) . u_k,     k = first(j) ..
!>     first(j + 1) - 1,
!>
!> with the coefficients c_jk of the points (atrito_points) and T_j the normal turned by +90 degrees. e are the turns of
!> atrito_turning_rows, by which a rotation of both bodies together is no relative displacement; without them they are not there.
!> Contact asks for N_j u <= s_j, s_j the gap, and friction acts against T_j u.
!>
!> The last n_bilateral rows have a vector of their own at each entry, sum_k v_k . u_k, and no tangential row: ties,
!> equations, springs and so on (atrito_bilateral_rows), with the value that is prescribed in the place of the gap. A
!> step that resolves an overlap bit by bit (*CONTACT INTERFERENCE) allows a share of it: gap(j) = s_j + share max(0,
!> -s_j), and true_gap takes that out again.
module atrito_contact_rows
   use atrito_bilateral_rows, only: bilateral_rows_t
   use atrito_kinds, only: ip, wp
   use atrito_points, only: contact_points_t
   implicit none (type, external)
   private
   public :: contact_rows_t, build_rows, allow_overlap, true_gap, row_value, bodies_of_row, vector_of_entry, &
             direction_of_entry, turn_of_entry

   !> Row of point j along a direction d_j: the sum of coefficient(k) d_j . u(node(k)) over k from first(j) to first(j+1) - 1, and
   !> of turn(i, k) n_j . u(node(k)), i being 1 where d_j is the normal and 2 where it is the tangent (atrito_turning_rows). The
   !> last n_bilateral rows have vectors of their own in place of coefficient(k) d_j, and no direction.
   type :: contact_rows_t
      integer(ip) :: n = 0                           !< points, with bilateral rows
      integer(ip) :: longest = 0                     !< most entries of a row
      integer(ip), allocatable :: first(:)           !< (n + 1)
      integer(ip), allocatable :: node(:)            !< (entries) number in the solver's mesh
      real(wp), allocatable :: coefficient(:)        !< the slave's positive, the master's negative; 0: for `turn` alone
      real(wp), allocatable :: turn(:, :)            !< (2, entries) of n in the normal, the tangential row; not allocated: none
      real(wp), allocatable :: normal(:, :)          !< (2, n) n
      real(wp), allocatable :: tangent(:, :)         !< (2, n) T, n turned by +90 degrees
      real(wp), allocatable :: gap(:)                !< (n) initial distance s_j, and overlap that is allowed [L]
      real(wp), allocatable :: doubt(:)              !< (n) by what the normal may be off [rad]
      logical, allocatable :: is_held(:, :)          !< (2, n) supports take what the normal, the tangential row would
      integer(ip), allocatable :: holder(:)          !< (n_nodes) bilateral row of a support along no axis; 0, not allocated: none
      real(wp), allocatable :: reach(:)              !< (n) length that the point stands for [L]
      real(wp), allocatable :: allowed(:)            !< (n) that overlap [L]; not allocated: none
      integer(ip) :: n_bilateral = 0                 !< rows behind those of points
      integer(ip) :: before_vectors = 0              !< entries of the rows before
      real(wp), allocatable :: vector(:, :)          !< (2, entries of bilateral rows)
   end type contact_rows_t

contains

   !> The rows of all pairs, one pair after the other, and the bilateral ones behind them. What is asked of the points
   !> for rows alone comes along: gaps, the doubt about the normals, which rows supports hold, the length that a point
   !> stands for.
   pure subroutine build_rows(points, rows, bilateral)
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      type(contact_rows_t), intent(out) :: rows       !< of all pairs, then the bilateral ones
      type(bilateral_rows_t), intent(in), optional :: bilateral !< without it there are none
      integer(ip) :: i, j, m

      rows%n = sum(points%n)
      if (present(bilateral)) rows%n_bilateral = bilateral%n
      rows%n = rows%n + rows%n_bilateral
      allocate (rows%first(rows%n + 1), source=1_ip)
      allocate (rows%normal(2, rows%n), rows%tangent(2, rows%n), rows%gap(rows%n), rows%doubt(rows%n), rows%reach(rows%n), &
                source=0.0_wp)
      allocate (rows%is_held(2, rows%n), source=.false.)
      m = 0
      do i = 1, size(points, kind=ip)
         do j = 1, points(i)%n
            m = m + 1
            rows%normal(:, m) = points(i)%normal(:, j)
            rows%tangent(:, m) = [-points(i)%normal(2, j), points(i)%normal(1, j)]
            rows%gap(m) = points(i)%gap(j)
            if (allocated(points(i)%length)) rows%reach(m) = points(i)%length(j)
            if (allocated(points(i)%is_held)) rows%is_held(:, m) = points(i)%is_held(:, j)
            if (allocated(points(i)%doubt)) rows%doubt(m) = points(i)%doubt(j)
            rows%first(m + 1) = rows%first(m) + (points(i)%first(j + 1) - points(i)%first(j))
         end do
      end do
      rows%node = [(points(i)%entry, i=1, size(points, kind=ip))]
      rows%coefficient = [(points(i)%coefficient, i=1, size(points, kind=ip))]
      if (rows%n_bilateral > 0) call append_bilateral(bilateral, m, rows)
      rows%longest = maxval([0_ip, rows%first(2:) - rows%first(:rows%n)])
   end subroutine build_rows

   !> The bilateral rows behind m rows of points.
   pure subroutine append_bilateral(bilateral, m, rows)
      type(bilateral_rows_t), intent(in) :: bilateral
      integer(ip), intent(in) :: m                   !< rows before
      type(contact_rows_t), intent(inout) :: rows
      integer(ip) :: j

      rows%before_vectors = rows%first(m + 1) - 1
      rows%vector = bilateral%vector
      rows%node = [rows%node, bilateral%node]
      rows%coefficient = [rows%coefficient, [(1.0_wp, j=1, size(bilateral%node, kind=ip))]]
      rows%gap(m + 1:) = bilateral%value
      do j = 1, bilateral%n
         rows%first(m + j + 1) = rows%before_vectors + bilateral%first(j + 1)
      end do
   end subroutine append_bilateral

   !> Gaps of all points at a time of a step that resolves overlaps: what is allowed of an overlap is no overlap to contact.
   pure subroutine allow_overlap(points, share, rows)
      type(contact_points_t), intent(in) :: points(:) !< one a pair
      real(wp), intent(in) :: share(:)               !< (pairs) of the initial overlap, that is allowed
      type(contact_rows_t), intent(inout) :: rows    !< gap and allowed are replaced
      integer(ip) :: i, first

      if (allocated(rows%allowed)) deallocate (rows%allowed)
      if (any(share > 0.0_wp)) allocate (rows%allowed(rows%n), source=0.0_wp)
      first = 0
      do i = 1, size(points, kind=ip)
         associate (n => points(i)%n)
            rows%gap(first + 1:first + n) = points(i)%gap(:n)
            if (share(i) > 0.0_wp) rows%allowed(first + 1:first + n) = share(i)*max(0.0_wp, -points(i)%gap(:n))
            first = first + n
         end associate
      end do
      if (allocated(rows%allowed)) rows%gap(:first) = rows%gap(:first) + rows%allowed(:first)
   end subroutine allow_overlap

   !> The distance of two sides from what contact takes for it, less the overlap that a step allows at its time.
   pure real(wp) function true_gap(rows, j, gap)
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: j                  !< row
      real(wp), intent(in) :: gap                    !< [L]

      true_gap = gap
      if (allocated(rows%allowed)) true_gap = gap - rows%allowed(j)
   end function true_gap

   !> What the displacement of the node of entry k is multiplied by in row j along a direction d: b_k = c_k d + e_k n,
   !> the part of B that the node has. The forces of q_j on the nodes are b_k q_j.
   pure function vector_of_entry(rows, j, k, direction) result(vector)
      type(contact_rows_t), intent(in) :: rows      !< of all points, over nodes
      integer(ip), intent(in) :: j, k               !< row, entry
      real(wp), intent(in) :: direction(2)           !< n or T of the point
      real(wp) :: vector(2)

      vector = rows%coefficient(k)*direction_of_entry(rows, j, k, direction)
      if (allocated(rows%turn)) vector = vector + turn_of_entry(rows, j, k, direction)
   end function vector_of_entry

   !> The direction of entry k of row j, which its coefficient goes with.
   pure function direction_of_entry(rows, j, k, direction) result(vector)
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: j, k               !< row, entry
      real(wp), intent(in) :: direction(2)           !< n or T of the point
      real(wp) :: vector(2)

      if (j > rows%n - rows%n_bilateral) then
         vector = rows%vector(:, k - rows%before_vectors)
      else
         vector = direction
      end if
   end function direction_of_entry

   !> What is n's of entry k of row j besides, e_k n; 0 where no row has such entries, and in bilateral rows.
   pure function turn_of_entry(rows, j, k, direction) result(vector)
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: j, k               !< row, entry
      real(wp), intent(in) :: direction(2)           !< n or T of the point
      real(wp) :: vector(2)

      vector = 0.0_wp
      if (.not. allocated(rows%turn) .or. j > rows%n - rows%n_bilateral) return
      vector = rows%turn(which_row(rows, j, direction), k)*rows%normal(:, j)
   end function turn_of_entry

   !> 1 for the normal row of a point, 2 for its tangential one: the direction is n or T, so d . T tells.
   pure integer function which_row(rows, j, direction)
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: j                  !< row
      real(wp), intent(in) :: direction(2)           !< n or T of the point

      which_row = merge(2, 1, dot_product(direction, rows%tangent(:, j)) > 0.5_wp)
   end function which_row

   !> The relative displacement [L] of point j along a direction, sum_k c_k d . u_k + sum_k e_k n . u_k; of a bilateral
   !> row sum_k v_k . u_k.
   pure real(wp) function row_value(rows, j, direction, u) result(value)
      type(contact_rows_t), intent(in) :: rows
      integer(ip), intent(in) :: j                  !< row
      real(wp), intent(in) :: direction(2)          !< n or T of the point
      real(wp), intent(in) :: u(:, :)                !< (2, n_nodes) [L]
      integer(ip) :: k

      value = 0.0_wp
      if (j > rows%n - rows%n_bilateral) then
         do k = rows%first(j), rows%first(j + 1) - 1
            value = value + dot_product(rows%vector(:, k - rows%before_vectors), u(:, rows%node(k)))
         end do
         return
      end if
      do k = rows%first(j), rows%first(j + 1) - 1
         value = value + rows%coefficient(k)*dot_product(direction, u(:, rows%node(k)))
      end do
      if (.not. allocated(rows%turn)) return
      do k = rows%first(j), rows%first(j + 1) - 1
         value = value + rows%turn(which_row(rows, j, direction), k)*dot_product(rows%normal(:, j), u(:, rows%node(k)))
      end do
   end function row_value

   !> The body of each entry of a row; those of a point of contact are two, those of a tie or an equation may be more.
   pure function bodies_of_row(rows, j, body_of_node) result(bodies)
      type(contact_rows_t), intent(in) :: rows      !< of all points, over nodes
      integer(ip), intent(in) :: j, body_of_node(:) !< row; (n_nodes) body of each node, 0: none
      integer(ip) :: bodies(rows%first(j + 1) - rows%first(j))

      bodies = body_of_node(rows%node(rows%first(j):rows%first(j + 1) - 1))
   end function bodies_of_row

end module atrito_contact_rows
