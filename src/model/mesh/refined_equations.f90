!> Equations that a deck gives node by node along a side: --refine and --elements make nodes between, which have none.
module atrito_refined_equations
   use atrito_build_context, only: build_context_t
   use atrito_deck, only: keyword_name
   use atrito_diagnostics, only: report_note
   use atrito_kinds, only: ip
   use atrito_refinement, only: is_refined
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: note_free_sides

   integer(ip), parameter :: PLANE_DOFS = 2

contains

   !> Tells the first such side, at the first *EQUATION.
   subroutine note_free_sides(context)
      type(build_context_t), intent(in) :: context
      logical, allocatable :: has_equation(:, :)       ! (n_nodes, dof) of first terms
      integer(ip) :: dof, edge, i, n

      if (.not. is_refined(context%refinement) .or. context%model%equations%n == 0) return
      allocate (has_equation(context%model%mesh%n_nodes, PLANE_DOFS), source=.false.)
      associate (equations => context%model%equations, fine => context%refinement)
         do i = 1, equations%n
            if (equations%dof(i) <= PLANE_DOFS) has_equation(equations%node(i), equations%dof(i)) = .true.
         end do
         do edge = 1, fine%n_edges
            if (fine%edge_element(2, edge) > 0) cycle  ! inside
            n = merge(3_ip, 2_ip, fine%edge_node(3, edge) > 0)
            do dof = 1, PLANE_DOFS
               if (.not. all(has_equation(fine%edge_node(:n, edge), dof))) cycle
               if (any(has_equation(fine%edge_first(edge):fine%edge_first(edge + 1) - 1, dof))) cycle
               call tell(context, fine%edge_node(:2, edge))
               return
            end do
         end do
      end associate
   end subroutine note_free_sides

   subroutine tell(context, ends)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: ends(2)               !< places of nodes
      integer(ip) :: i

      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == 'EQUATION') exit
      end do
      associate (id => context%model%mesh%node_id(ends))
         call report_note(context%deck, context%deck%cards(i)%place, 'N-REFINE', 'the finer mesh has nodes between those with '// &
                          'equations, as between '//to_text(id(1))//' and '//to_text(id(2))//', and they have none; where '// &
                          'equations name sets they have', keyword='EQUATION')
      end associate
   end subroutine tell

end module atrito_refined_equations
