!> From the contact forces to the displacements of the bodies.
!>
!> The forces q at the points are nodal forces B' q on both bodies. Without its rigid motion a condensed body moves by u_e = F (f_c
!> - B' q) at its contact dofs, F being the flexibility of atrito_condensed_body; the interior follows from these.
module atrito_displacements
   use atrito_assembly, only: fem_t
   use atrito_condensed_body, only: condensed_body_t, contact_response, expand_body
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: contact_forces, add_bilateral_forces, elastic_displacements

contains

   !> B'q as nodal forces (2, n_nodes) [F]: what the contact and the bilateral rows take from the loads, prescribed dofs too.
   !>
   !> At point j the force w (p N + t T) goes to the slave node with the coefficient 1 and to the nodes of the master's face with
   !> those of its shape functions, negative. Pairs whose moments are balanced have rows%turn besides: multiples of N.
   pure function contact_forces(fem, rows, line, solution) result(force)
      type(fem_t), intent(in) :: fem !< bodies and elements
      type(contact_rows_t), intent(in) :: rows !< of all points, over nodes
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      type(contact_solution_t), intent(in) :: solution !< forces and stresses at the points
      real(wp) :: force(2, fem%mesh%n_nodes)
      real(wp) :: at_point(2)
      integer(ip) :: j, k

      force = 0.0_wp
      do j = 1, rows%n - rows%n_bilateral
         at_point = line%weight(j)*(max(solution%p(j), 0.0_wp)*rows%normal(:, j) + solution%t(j)*rows%tangent(:, j))
         do k = rows%first(j), rows%first(j + 1) - 1
            force(:, rows%node(k)) = force(:, rows%node(k)) + rows%coefficient(k)*at_point
         end do
         if (.not. allocated(rows%turn)) cycle
         at_point = line%weight(j)*[max(solution%p(j), 0.0_wp), solution%t(j)]
         do k = rows%first(j), rows%first(j + 1) - 1
            force(:, rows%node(k)) = force(:, rows%node(k)) + dot_product(rows%turn(:, k), at_point)*rows%normal(:, j)
         end do
      end do
      call add_bilateral_forces(rows, [(.true., j=1, rows%n_bilateral)], line%weight*solution%p, force)
   end function contact_forces

   !> Adds what some bilateral rows take from the loads.
   !>
   !> Ties, equations, supports along directions of their own and springs: B' q with the vectors of their rows.
   pure subroutine add_bilateral_forces(rows, wanted, q, force)
      type(contact_rows_t), intent(in) :: rows !< of all points, over nodes
      logical, intent(in) :: wanted(:)               !< (bilateral rows)
      real(wp), intent(in) :: q(:)                   !< (n) of all rows [F]
      real(wp), intent(inout) :: force(:, :)         !< (2, n_nodes) [F]
      integer(ip) :: j, k

      associate (before => rows%n - rows%n_bilateral)
         do j = 1, rows%n_bilateral
            if (.not. wanted(j)) cycle
            do k = rows%first(before + j), rows%first(before + j + 1) - 1
               force(:, rows%node(k)) = force(:, rows%node(k)) + q(before + j)*rows%vector(:, k - rows%before_vectors)
            end do
         end do
      end associate
   end subroutine add_bilateral_forces

   !> The displacements of one body without its rigid motion: u_e = u0 - F B'q at the contact dofs, the interior from them.
   !>
   !> x = f_c - B'q at the contact dofs, F x by the factor, then the interior. A rigid body has no displacements but its motions.
   subroutine elastic_displacements(fem, i_body, condensed, force, u)
      type(fem_t), intent(in) :: fem !< bodies and elements
      integer(ip), intent(in) :: i_body !< its number in fem%bodies
      type(condensed_body_t), intent(in) :: condensed !< factored, with its reduced load
      real(wp), intent(in) :: force(:, :)            !< B'q, (2, n_nodes) [F]
      real(wp), intent(inout) :: u(:, :)             !< (2, n_nodes) [L]: the free dofs of this body are set
      real(wp), allocatable :: x(:, :)
      integer(ip) :: i, dof, k, first

      if (fem%bodies%list(i_body)%is_rigid) return
      associate (body => fem%bodies%list(i_body))
         first = body%n - body%n_retained
         x = condensed%load(first + 1:, :)
         do i = 1, size(body%nodes, kind=ip)
            do dof = 1, 2
               k = fem%bodies%equation(dof, body%nodes(i)) - first
               if (k > 0) x(k, 1) = x(k, 1) - force(dof, body%nodes(i))
            end do
         end do
         call contact_response(condensed, x)
         call expand_body(fem, i_body, condensed, x(:, 1), u)
      end associate
   end subroutine elastic_displacements

end module atrito_displacements
