!> The forces of bilateral rows in the resultants: those of inclined supports are reactions, those of springs and equations may go
!> to the ground.
module atrito_row_forces
   use atrito_bilateral_rows, only: ROW_SUPPORT, ROW_SPRING, ROW_EQUATION
   use atrito_contact_solution, only: contact_solution_t
   use atrito_displacements, only: add_bilateral_forces
   use atrito_kinds, only: ip, wp
   use atrito_results, only: balance_t, results_t
   use atrito_rigid_bodies, only: carriers_of, has_moving_surfaces
   use atrito_scene_data, only: scene_data_t
   implicit none (type, external)
   private
   public :: share_out_rows, clear_balance, leave_out_sections

contains

   !> The forces of the bilateral rows: those of supports become reactions, those of others stay with the contact.
   subroutine share_out_rows(data, solution, contact, results, others)
      type(scene_data_t), intent(in) :: data               !< rows and line
      type(contact_solution_t), intent(in) :: solution     !< p of the rows
      real(wp), intent(inout) :: contact(:, :)             !< (2, n_nodes) with all rows; without supports on return [F]
      type(results_t), intent(inout) :: results            !< reaction, prescribed, row_force and row_x are set
      real(wp), intent(out) :: others(3)                   !< resultant of springs and equations [F], moment about the origin [F L]
      real(wp) :: q(data%rows%n), to_ground(2, data%fem%mesh%n_nodes)
      integer(ip) :: j

      associate (kind => data%model%bilateral%kind, n => data%rows%n - data%rows%n_bilateral)
         q = data%line%weight*solution%p
         results%row_force = q(n + 1:)
         results%row_x = data%fem%mesh%x(:, data%rows%node(data%rows%first(n + 1:data%rows%n)))
         to_ground = 0.0_wp
         call add_bilateral_forces(data%rows, kind == ROW_SUPPORT, q, to_ground)
         contact = contact - to_ground
         results%reaction = results%reaction - to_ground
         do j = 1, data%rows%n_bilateral                   ! reactions along both axes, whatever the direction of the support
            if (kind(j) == ROW_SUPPORT) results%prescribed(:, data%rows%node(data%rows%first(n + j))) = .true.
         end do
         to_ground = 0.0_wp
         call add_bilateral_forces(data%rows, kind == ROW_SPRING .or. kind == ROW_EQUATION, q, to_ground)
         associate (x => data%fem%mesh%x)
            others = [sum(to_ground, dim=2), sum(x(1, :)*to_ground(2, :) - x(2, :)*to_ground(1, :))]
         end associate
      end associate
   end subroutine share_out_rows

   !> A force at the node of a pre-tension section is one of two that balance each other: it is in no resultant.
   pure subroutine leave_out_sections(data, reaction, contact, balance)
      type(scene_data_t), intent(in) :: data                !< rigid bodies of its model, and loads
      real(wp), intent(in) :: reaction(:, :), contact(:, :) !< (2, n_nodes) [F]
      type(balance_t), intent(inout) :: balance             !< their applied, reactions and rigid go
      integer(ip) :: i, nodes(3)

      if (.not. has_moving_surfaces(data%model)) return
      do i = 1, size(data%model%rigid_bodies, kind=ip)
         if (.not. data%model%rigid_bodies(i)%is_section) cycle
         nodes = carriers_of(data%model, i)
         associate (f => data%f(:, nodes(1)), r => reaction(:, nodes(1)), x => data%fem%mesh%x(:, nodes(1)))
            balance%applied = balance%applied - f
            balance%reactions = balance%reactions - r
            balance%applied_moment = balance%applied_moment - (x(1)*f(2) - x(2)*f(1))
            balance%reaction_moment = balance%reaction_moment - (x(1)*r(2) - x(2)*r(1))
            balance%rigid = balance%rigid - contact(:, nodes(1))
            balance%rigid_moment = balance%rigid_moment - (x(1)*contact(2, nodes(1)) - x(2)*contact(1, nodes(1)))
         end associate
      end do
   end subroutine leave_out_sections

   !> What bodies that are tied do to each other adds up to round-off.
   pure subroutine clear_balance(balance)
      type(balance_t), intent(inout) :: balance  !< rigid and rows that are round-off become 0
      real(wp), parameter :: ROUND_OFF = 1.0e-13_wp
      real(wp) :: all_forces

      all_forces = sum(abs(balance%applied) + abs(balance%reactions) + abs(balance%rigid) + abs(balance%rows))
      where (abs(balance%rigid) <= ROUND_OFF*all_forces) balance%rigid = 0.0_wp
      where (abs(balance%rows) <= ROUND_OFF*all_forces) balance%rows = 0.0_wp
   end subroutine clear_balance

end module atrito_row_forces
