!> --refine of blocks with arcs: new nodes lie on the map of the block, not on that of their coarse element, so that a side stays
!> the circle that it is.
!>
!> The places of the new nodes in the block's unit square are those of a refined mesh whose coordinates they are: there every
!> element is a rectangle, and the map of the element is exact.
module atrito_refine_arcs
   use atrito_block_map, only: map_point, has_arcs
   use atrito_build_context, only: build_context_t
   use atrito_diagnostics, only: report_error
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_refined_members, only: fine_elements
   use atrito_refinement, only: map_element
   implicit none (type, external)
   private
   public :: place_on_arcs

   !> Places of one node by two elements are two if they differ by more than this part of the coarse element.
   real(wp), parameter :: SAME_PLACE = 1.0e-5_wp

contains

   !> Moves the new nodes of all blocks with arcs.
   subroutine place_on_arcs(coarse, context)
      type(mesh_t), intent(in) :: coarse
      type(build_context_t), intent(inout) :: context
      type(mesh_t) :: square                           ! the coarse mesh in the unit square of a block
      real(wp), allocatable :: place(:, :)             ! of the new nodes there
      integer(ip), allocatable :: owner(:)             ! block that has placed a node; negative: elsewhere than its element; 0: none
      logical, allocatable :: is_done(:)               ! elements of blocks with arcs
      integer(ip), allocatable :: pieces(:)
      integer(ip) :: b, e, i, j

      if (.not. any([(has_arcs(context%blocks(b)%map), b=1, context%n_blocks)])) return
      square = coarse
      allocate (place(2, context%model%mesh%n_nodes))
      allocate (owner(context%model%mesh%n_nodes), source=0_ip)
      allocate (is_done(coarse%n_elements), source=.false.)
      do b = 1, context%n_blocks
         if (.not. has_arcs(context%blocks(b)%map)) cycle
         associate (block => context%blocks(b))
            do j = 0, ubound(block%nodes, 2, kind=ip)
               do i = 0, ubound(block%nodes, 1, kind=ip)
                  if (block%nodes(i, j) > 0) square%x(:, block%nodes(i, j)) = [block%along(i), block%across(j)]
               end do
            end do
            do e = block%first_element, block%first_element + block%n_elements - 1
               is_done(e) = .true.
               call place_element(e, b, coarse, square, context, place, owner)
            end do
         end associate
      end do
      do e = 1, coarse%n_elements                      ! an element of no block with arcs keeps the places of its nodes
         if (is_done(e)) cycle
         pieces = fine_elements(context%refinement, [e])
         look: do i = 1, size(pieces, kind=ip)
            do j = 1, context%model%mesh%shape(pieces(i))
               b = -owner(context%model%mesh%nodes(j, pieces(i)))
               if (b <= 0) cycle
               call report_other_curve(b, 0_ip, context)
               where (abs(owner) == b) owner = 0       ! reported once
               exit look
            end do
         end do look
      end do
   end subroutine place_on_arcs

   !> The new nodes of a coarse element. What another block has placed must lie where this one would place it.
   subroutine place_element(e, b, coarse, square, context, place, owner)
      integer(ip), intent(in) :: e, b
      type(mesh_t), intent(in) :: coarse, square
      type(build_context_t), intent(inout) :: context
      real(wp), intent(inout) :: place(:, :)
      integer(ip), intent(inout) :: owner(:)
      integer(ip), allocatable :: grid(:, :), pieces(:)
      real(wp) :: x(2), reach
      integer(ip) :: i, k, node

      call map_element(square, context%refinement, e, place, grid)
      reach = SAME_PLACE*norm2(coarse%x(:, coarse%nodes(3, e)) - coarse%x(:, coarse%nodes(1, e)))
      pieces = fine_elements(context%refinement, [e])
      associate (mesh => context%model%mesh)
         do i = 1, size(pieces, kind=ip)
            do k = 1, mesh%shape(pieces(i))
               node = mesh%nodes(k, pieces(i))
               if (node <= coarse%n_nodes .or. abs(owner(node)) == b) cycle
               x = map_point(context%blocks(b)%map, place(1, node), place(2, node))
               if (owner(node) == 0) then
                  owner(node) = merge(b, -b, norm2(x - mesh%x(:, node)) <= reach)
                  mesh%x(:, node) = x
               else if (norm2(x - mesh%x(:, node)) > reach) then
                  call report_other_curve(b, abs(owner(node)), context)
                  return
               end if
            end do
         end do
      end associate
   end subroutine place_element

   !> Reports a side that is an arc beside what follows another curve: nodes between those of the deck would lie in two places.
   subroutine report_other_curve(b, other, context)
      integer(ip), intent(in) :: b
      integer(ip), intent(in) :: other                 !< block; 0: elements of no block with arcs
      type(build_context_t), intent(in) :: context
      character(len=:), allocatable :: what

      what = 'elements beside it'
      if (other > 0) what = 'block '//context%blocks(other)%name//' beside it'
      call report_error(context%deck, context%deck%cards(context%blocks(b)%card)%place, 'E-BLOCK', 'a side of block '// &
                        context%blocks(b)%name//' is an arc, but the '//what//' share its nodes and follow another curve', &
                        expected='the same ARC for the sides of both blocks; --refine puts nodes between those of the deck', &
                        keyword='BLOCK')
   end subroutine report_other_curve

end module atrito_refine_arcs
