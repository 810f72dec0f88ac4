!> --refine and --elements: the mesh of a deck and its sets, refined or made of other elements. Surfaces, loads and supports are
!> read afterwards and follow them.
module atrito_refine_model
   use atrito_build_trees, only: has_cuts
   use atrito_cut_mesh, only: cut_mesh
   use atrito_deck, only: token_t
   use atrito_diagnostics, only: report_deck_error
   use atrito_build_context, only: build_context_t, note_place
   use atrito_element_table, only: CORNERS_OF, DEGREE_OF
   use atrito_element_trees, only: element_trees_t
   use atrito_faces, only: list_node_elements
   use atrito_kinds, only: ip, lp
   use atrito_mesh, only: mesh_t
   use atrito_model_memory, only: fits_memory, most_nodes
   use atrito_node_fields, only: refine_node_fields
   use atrito_refined_deck, only: place_on_arcs
   use atrito_refined_members, only: fine_nodes, fine_elements
   use atrito_refinement, only: refine_mesh, count_fine_nodes
   use atrito_sets, only: set_count, members_of, replace_members
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: refine_model, cut_model

contains

   !> Replaces the mesh, and the members of all sets. A mesh that would be too large is reported and left as it is. Of a nine-node
   !> element come four of four nodes, on the same nodes; of one of four nodes comes one of nine.
   subroutine refine_model(levels, shape, context)
      integer(ip), intent(in) :: levels                !< >= 0; each element into 4**levels
      integer(ip), intent(in) :: shape                 !< for all elements, place in SHAPES; 0: their own
      type(build_context_t), intent(inout) :: context  !< mesh, sets and node fields follow; refinement is set
      type(mesh_t) :: coarse
      integer(ip) :: pieces

      pieces = 2**levels
      if (has_cuts(context%deck)) then
         call report_deck_error(context%deck, 'E-REFINE', '--elements is not built for decks with *REFINE', &
                                expected='the elements of the deck')
         return
      end if
      if (shape > 0 .and. any(CORNERS_OF(context%model%mesh%shape) /= CORNERS_OF(max(shape, 1_ip)))) then
         call report_deck_error(context%deck, 'E-REFINE', 'the deck has '// &
                                trim(merge('quadrilaterals', 'triangles     ', CORNERS_OF(shape) == 3))// &
                                ', of which --elements makes none', expected='elements with as many corners as those of the deck')
         return
      end if
      if (DEGREE_OF(max(shape, 1_ip)) == 1 .and. any(DEGREE_OF(context%model%mesh%shape) > 1)) then
         pieces = 2*pieces
         if (any(DEGREE_OF(context%model%mesh%shape) == 1)) then
            call report_deck_error(context%deck, 'E-REFINE', 'elements of four nodes and of more together cannot all get four', &
                                   expected='a mesh of one degree')
            return
         end if
      end if
      if (.not. is_possible(levels, pieces, shape, context)) return
      coarse = context%model%mesh
      call refine_mesh(coarse, context%around, pieces, shape, context%model%mesh, context%refinement)
      context%model%levels = levels
      call follow_mesh(coarse, context)
   end subroutine refine_model

   !> The same by the leaves of trees. The deck has elements with as many nodes as there are roots.
   subroutine cut_model(trees, context)
      type(element_trees_t), intent(inout) :: trees    !< as the elements are to be cut
      type(build_context_t), intent(inout) :: context  !< mesh, sets and node fields follow; refinement is set
      type(mesh_t) :: coarse

      coarse = context%model%mesh
      call cut_mesh(coarse, context%around, trees, context%model%mesh, context%refinement)
      context%model%n_cut = trees%n_roots - count(trees%first_child(:trees%n_roots) == 0, kind=ip)
      call follow_mesh(coarse, context)
   end subroutine cut_model

   !> Places on arcs, fields of nodes and the members of sets go from the deck's mesh to the one that has taken its place.
   subroutine follow_mesh(coarse, context)
      type(mesh_t), intent(in) :: coarse
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i

      call place_on_arcs(coarse, context)
      call refine_node_fields(coarse, context)
      do i = 1, set_count(context%model%node_sets)
         associate (set => context%model%node_sets%sets(i))
            call replace_members(set, fine_nodes(coarse, context%refinement, members_of(set)))
         end associate
      end do
      do i = 1, set_count(context%model%element_sets)
         associate (set => context%model%element_sets%sets(i))
            call replace_members(set, fine_elements(context%refinement, members_of(set)))
         end associate
      end do
      context%deck_elements = coarse%element_map
      call keep_places(coarse, context%model%mesh, context)
      context%model%mesh%digit_error = coarse%digit_error
      context%around = list_node_elements(context%model%mesh)
   end subroutine follow_mesh

   !> There are not too many nodes, and there are numbers and memory for them. The numbers of elements are chosen so that they fit.
   logical function is_possible(levels, pieces, shape, context)
      integer(ip), intent(in) :: levels, pieces, shape
      type(build_context_t), intent(inout) :: context
      type(token_t) :: nowhere
      integer(lp) :: n, greatest

      n = count_fine_nodes(context%model%mesh, pieces, shape)
      greatest = maxval(context%model%mesh%node_id(:context%model%mesh%n_nodes))
      is_possible = n <= most_nodes()
      if (.not. is_possible) then
         call report_deck_error(context%deck, 'E-REFINE', '--refine '//to_text(levels)//' makes more than '// &
                                to_text(most_nodes())//' nodes', expected='a smaller number: each one more makes four '// &
                                'elements of one')
         return
      end if
      is_possible = greatest + (n - int(context%model%mesh%n_nodes, lp)) <= int(huge(1_ip), lp)
      if (.not. is_possible) call report_deck_error(context%deck, 'E-REFINE', '--refine '//to_text(levels)// &
                          ': the numbers of the new '//'nodes, which follow the greatest, '//to_text(greatest)//', are too large', &
                                                    expected='smaller node numbers')
      if (is_possible) is_possible = fits_memory(nowhere, context, n, int(context%model%mesh%n_elements, lp)*int(pieces, lp)**2, &
                                                 element_nodes=merge(shape, maxval(context%model%mesh%shape), shape > 0))
   end function is_possible

   !> New nodes and elements come from where the element that holds them comes from.
   subroutine keep_places(coarse, fine, context)
      type(mesh_t), intent(in) :: coarse, fine
      type(build_context_t), intent(inout) :: context
      integer(ip) :: places(coarse%n_elements), parent(fine%n_elements), e, k, node

      places = context%elements%place(:coarse%n_elements)
      do e = 1, coarse%n_elements
         parent(fine_elements(context%refinement, [e])) = e
      end do
      call note_place(context%nodes%place, fine%n_nodes, 0_ip)
      context%nodes%place(coarse%n_nodes + 1:) = 0
      do e = fine%n_elements, 1, -1
         call note_place(context%elements%place, e, places(parent(e)))
         do k = 1, fine%shape(e)
            node = fine%nodes(k, e)
            if (node > coarse%n_nodes) context%nodes%place(node) = context%elements%place(e)
         end do
      end do
   end subroutine keep_places

end module atrito_refine_model
