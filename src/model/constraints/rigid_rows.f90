!> Bilateral rows of nodes of elements that belong to rigid bodies.
module atrito_rigid_rows
   use atrito_bilateral_rows, only: add_row, ROW_RIGID
   use atrito_build_context, only: build_context_t
   use atrito_build_rigid_bodies, only: carriers_of, read_tied_nodes, rigid_body_of, CARRIERS
   use atrito_deck, only: token_t, keyword_name
   use atrito_items, only: option_text
   use atrito_kinds, only: ip, wp
   use atrito_references, only: find_nodes
   use atrito_turn_supports, only: row_weight
   implicit none (type, external)
   private
   public :: add_rigid_rows

contains

   !> The rows by which nodes of elements move as their rigid bodies do; no nodes are made any more, and all are where they stay.
   subroutine add_rigid_rows(context)
      type(build_context_t), intent(inout) :: context
      type(token_t) :: place
      character(len=:), allocatable :: name
      integer(ip), allocatable :: nodes(:), reference(:)
      real(wp) :: weight
      integer(ip) :: i
      logical :: ok

      weight = row_weight(context%model)
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) /= 'RIGID BODY') cycle
         call read_tied_nodes(context%deck%cards(i), context, name, nodes, ok)
         if (.not. allocated(name)) cycle
         call option_text(context%deck, context%deck%cards(i), 'REF NODE', name, ok, place)
         call find_nodes(context, place, reference, ok, 'RIGID BODY')
         call tie_nodes(context, rigid_body_of(context, reference(1)), nodes, weight)
      end do
   end subroutine add_rigid_rows

   !> u = sum N_i u_i along x and y, with the barycentric coordinates N_i of a node in the triangle of those that carry the motion.
   subroutine tie_nodes(context, b, nodes, weight)
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(in) :: b                     !< of the rigid bodies
      integer(ip), intent(in) :: nodes(:)
      real(wp), intent(in) :: weight                   !< of the rows [L^2]
      integer(ip) :: places(CARRIERS), i, axis, group
      real(wp) :: arm(2), part(CARRIERS + 1), vectors(2, CARRIERS + 1)

      places = carriers_of(context%model, b)
      group = context%model%bilateral%n_groups + 1
      do i = 1, size(nodes, kind=ip)
         associate (body => context%model%rigid_bodies(b), x => context%model%mesh%x)
            arm = (x(:, nodes(i)) - x(:, body%node))/body%size
         end associate
         part = [1.0_wp, -(1 - arm(1) - arm(2)), -arm(1), -arm(2)]
         do axis = 1, 2
            vectors = 0.0_wp
            vectors(axis, :) = part
            call add_row([nodes(i), places], vectors, 0.0_wp, 0.0_wp, weight, [ROW_RIGID, group, b], &
                         context%model%bilateral)
         end do
      end do
   end subroutine tie_nodes

end module atrito_rigid_rows
