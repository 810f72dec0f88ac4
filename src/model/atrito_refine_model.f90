!> --refine and --elements: the mesh of a deck and its sets, refined or made of other elements. Surfaces, loads and supports are
!> read afterwards and follow them.
module atrito_refine_model
   use atrito_build_nodes, only: MOST_NODES
   use atrito_deck, only: token_t
   use atrito_diagnostics, only: report_deck_error
   use atrito_draft, only: draft_t, note_place
   use atrito_element_table, only: DEGREE_OF
   use atrito_faces, only: list_node_elements
   use atrito_kinds, only: ip, lp
   use atrito_mesh, only: mesh_t
   use atrito_model_memory, only: fits_memory
   use atrito_refinement, only: refine_mesh, count_fine_nodes, fine_nodes, fine_elements
   use atrito_sets, only: set_count
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: refine_model

contains

   !> Replaces the mesh, and the members of all sets. A mesh that would be too large is reported and left as it is. Of a nine-node
   !> element come four of four nodes, on the same nodes; of one of four nodes comes one of nine.
   subroutine refine_model(levels, shape, draft)
      integer(ip), intent(in) :: levels                !< >= 0; each quadrilateral into 4**levels
      integer(ip), intent(in) :: shape                 !< for all elements, place in SHAPES; 0: their own
      type(draft_t), intent(inout) :: draft
      type(mesh_t) :: coarse
      integer(ip) :: i, pieces

      pieces = 2**levels
      if (DEGREE_OF(max(shape, 1_ip)) == 1 .and. any(DEGREE_OF(draft%model%mesh%shape) > 1)) then
         pieces = 2*pieces
         if (any(DEGREE_OF(draft%model%mesh%shape) == 1)) then
            call report_deck_error(draft%deck, 'E-REFINE', 'elements of four and of nine nodes together cannot all get four', &
                                   expected='a mesh of one kind')
            return
         end if
      end if
      if (.not. is_possible(levels, pieces, shape, draft)) return
      coarse = draft%model%mesh
      call refine_mesh(coarse, draft%around, pieces, shape, draft%model%mesh, draft%refinement)
      draft%model%levels = levels
      do i = 1, set_count(draft%model%node_sets)
         associate (set => draft%model%node_sets%sets(i))
            set%members = fine_nodes(coarse, draft%refinement, set%members)
         end associate
      end do
      do i = 1, set_count(draft%model%element_sets)
         associate (set => draft%model%element_sets%sets(i))
            set%members = fine_elements(draft%refinement, set%members)
         end associate
      end do
      draft%deck_elements = coarse%element_map
      call keep_places(coarse, draft%model%mesh, draft)
      draft%around = list_node_elements(draft%model%mesh)
   end subroutine refine_model

   !> There are not too many nodes, and there are numbers and memory for them. The numbers of elements are chosen so that they fit.
   logical function is_possible(levels, pieces, shape, draft)
      integer(ip), intent(in) :: levels, pieces, shape
      type(draft_t), intent(in) :: draft
      type(token_t) :: nowhere
      integer(lp) :: n, greatest

      n = count_fine_nodes(draft%model%mesh, pieces, shape)
      greatest = maxval(draft%model%mesh%node_id(:draft%model%mesh%n_nodes))
      is_possible = n <= int(MOST_NODES, lp)
      if (.not. is_possible) then
         call report_deck_error(draft%deck, 'E-REFINE', '--refine '//to_text(levels)//' makes more than '//to_text(MOST_NODES)// &
                                ' nodes', expected='a smaller number: each one more makes four elements of one')
         return
      end if
      is_possible = greatest + (n - int(draft%model%mesh%n_nodes, lp)) <= int(huge(1_ip), lp)
      if (.not. is_possible) call report_deck_error(draft%deck, 'E-REFINE', '--refine '//to_text(levels)// &
                          ': the numbers of the new '//'nodes, which follow the greatest, '//to_text(greatest)//', are too large', &
                                                    expected='smaller node numbers')
      if (is_possible) is_possible = fits_memory(nowhere, draft, n, int(draft%model%mesh%n_elements, lp)*int(pieces, &
                                                                                                             lp)**2)
   end function is_possible

   !> New nodes and elements come from where the element that holds them comes from.
   subroutine keep_places(coarse, fine, draft)
      type(mesh_t), intent(in) :: coarse, fine
      type(draft_t), intent(inout) :: draft
      integer(ip) :: places(coarse%n_elements), e, k, node, children

      places = draft%elements%place(:coarse%n_elements)
      children = draft%refinement%pieces**2
      call note_place(draft%nodes%place, fine%n_nodes, 0_ip)
      draft%nodes%place(coarse%n_nodes + 1:) = 0
      do e = fine%n_elements, 1, -1
         call note_place(draft%elements%place, e, places((e - 1)/children + 1))
         do k = 1, fine%shape(e)
            node = fine%nodes(k, e)
            if (node > coarse%n_nodes) draft%nodes%place(node) = draft%elements%place(e)
         end do
      end do
   end subroutine keep_places

end module atrito_refine_model
