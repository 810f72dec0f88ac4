!> Equations on a refined mesh. Those that a deck gives node by node along a side have none at the nodes that --refine and
!> --elements make between; of those between two sets the nodes are put into corresponding orders, since the new nodes of a set
!> stand edge by edge, and edges run either way.
module atrito_refined_equations
   use atrito_build_context, only: build_context_t
   use atrito_diagnostics, only: report_note
   use atrito_kinds, only: ip
   use atrito_refinement, only: is_refined, refinement_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: note_free_sides, order_like

   integer(ip), parameter :: PLANE_DOFS = 2

contains

   !> Reports the first such side, at the first *EQUATION.
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
               i = findloc(context%deck%cards(:context%deck%n_cards)%name, 'EQUATION', dim=1, kind=ip)
               associate (id => context%model%mesh%node_id(fine%edge_node(:2, edge)))
                  call report_note(context%deck, context%deck%cards(i)%place, 'N-REFINE', 'the finer mesh has nodes between '// &
                                   'those with equations, as between '//to_text(id(1))//' and '//to_text(id(2))//', and they '// &
                                   'have none; where equations name sets they have', keyword='EQUATION')
               end associate
               return
            end do
         end do
      end associate
   end subroutine note_free_sides

   !> Puts the nodes of `other` into the order of those of `set`: the nodes of the deck correspond as they stand, new ones between
   !> two of them to those between their partners. ok: .false. where there are none.
   pure subroutine order_like(refinement, set, other, ok)
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: set(:)
      integer(ip), intent(inout) :: other(:)           !< as many
      logical, intent(out) :: ok
      integer(ip), allocatable :: edges(:)
      integer(ip) :: partner(size(set)), ends(2), i, k, edge, before

      associate (n => count(set <= refinement%n_nodes, kind=ip))
         ok = n == count(other <= refinement%n_nodes)
         if (.not. ok) return
         edges = [(edge_of(refinement, other(i)), i=n + 1, size(other, kind=ip))]   ! nodes of an edge stand together: each once
         edges = pack(edges, edges > 0 .and. edges /= eoshift(edges, -1))
         partner(:n) = other(:n)
         edge = 0
         do i = n + 1, size(set, kind=ip)
            edge = edge_of(refinement, set(i))
            ok = edge > 0
            if (.not. ok) return
            do k = 1, 2
               ends(k) = findloc(set(:n), refinement%edge_node(k, edge), dim=1, kind=ip)
            end do
            ok = all(ends > 0)
            if (.not. ok) return
            before = set(i) - refinement%edge_first(edge)
            partner(i) = node_between(refinement, edges, other(ends), before)
            ok = partner(i) > 0
            if (.not. ok) return
         end do
      end associate
      other = partner
   end subroutine order_like

   !> The new node of an edge between two nodes, so many after the first of them; 0 where there is no such edge.
   pure integer(ip) function node_between(refinement, edges, ends, before) result(node)
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: edges(:), ends(2), before
      integer(ip) :: i

      node = 0
      do i = 1, size(edges, kind=ip)
         associate (own => refinement%edge_node(:2, edges(i)))
            if (all(own == ends)) node = refinement%edge_first(edges(i)) + before
            if (all(own == ends([2, 1]))) node = refinement%edge_first(edges(i) + 1) - 1 - before
         end associate
         if (node > 0) exit
      end do
      if (node == 0) return
      if (node < refinement%edge_first(edges(i)) .or. node >= refinement%edge_first(edges(i) + 1)) node = 0
   end function node_between

   !> The edge that a new node lies on; 0: none.
   pure integer(ip) function edge_of(refinement, node) result(edge)
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: node
      integer(ip) :: low, high, middle

      edge = 0
      if (node >= refinement%edge_first(refinement%n_edges + 1) .or. node < refinement%edge_first(1)) return
      low = 1
      high = refinement%n_edges
      do while (low < high)
         middle = (low + high + 1)/2
         if (refinement%edge_first(middle) <= node) then
            low = middle
         else
            high = middle - 1
         end if
      end do
      edge = low
   end function edge_of

end module atrito_refined_equations
