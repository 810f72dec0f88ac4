!> --refine and --elements: the mesh of a deck and its sets, refined or made of other elements. Surfaces, loads and supports are
!> read afterwards and follow them.
!>
!> *REFINE: which elements of the deck are cut, and how often. What it says is of the mesh of the deck, whatever --refine and
!> --adapt do besides.
module atrito_refine_model
   use atrito_bilateral_rows, only: ROW_EQUATION, ROW_TIE
   use atrito_build_context, only: build_context_t, note_place
   use atrito_cut_mesh, only: cut_mesh
   use atrito_deck, only: token_t, data_line_t, deck_t, keyword_name, line_item, token_text
   use atrito_diagnostics, only: report_deck_error, report_error
   use atrito_element_table, only: CORNERS_OF, DEGREE_OF
   use atrito_element_trees, only: element_trees_t, begin_trees, cut_all, cut_leaves, list_leaves, code_of_tree, take_code
   use atrito_faces, only: list_node_elements
   use atrito_growth, only: growing_text_t, append_text
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_mesh, only: mesh_t, face_end, side_count
   use atrito_model, only: model_t
   use atrito_model_memory, only: fits_memory, most_nodes
   use atrito_node_fields, only: refine_node_fields
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_references, only: find_elements
   use atrito_refined_deck, only: place_on_arcs
   use atrito_refined_members, only: fine_nodes, fine_elements
   use atrito_refinement, only: refine_mesh, count_fine_nodes
   use atrito_sets, only: set_count, members_of, replace_members
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: refine_model, cut_model, build_trees, card_of_trees, has_cuts

   character(len=*), parameter :: KEYWORD = 'REFINE'
   integer(ip), parameter :: MOST_TIMES = 12          !< as --refine
   character(len=1), parameter :: NEW_LINE = achar(10)

   real(wp), parameter :: FEW = 100*EPS_MACH

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

   !> Whether a deck cuts elements.
   pure logical function has_cuts(deck)
      type(deck_t), intent(in) :: deck                !< as read
      integer(ip) :: i

      has_cuts = .false.
      do i = 1, deck%n_cards
         if (.not. has_cuts) has_cuts = keyword_name(deck%cards(i)) == KEYWORD
      end do
   end function has_cuts

   !> The trees of a deck, and all leaves cut so many times more. The model is that of the deck's mesh.
   subroutine build_trees(levels, context, trees)
      integer(ip), intent(in) :: levels               !< of cuts of all leaves, >= 0
      type(build_context_t), intent(inout) :: context !< its mesh and pairs are read
      type(element_trees_t), intent(out) :: trees     !< roots are the elements of the mesh
      integer(ip) :: i, k

      call begin_trees(context%model%mesh, partner_nodes(context%model), trees)
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) /= KEYWORD) cycle
         do k = context%deck%cards(i)%first_line, context%deck%cards(i)%first_line + context%deck%cards(i)%n_lines - 1
            if (context%deck%lines(k)%ok) call read_line(context%deck%lines(k), context, trees)
         end do
      end do
      call cut_leaves([integer(ip) ::], trees)        ! what has to be cut with them
      call cut_all(levels, trees)
   end subroutine build_trees

   !> Element or set, and a number of times or a word.
   subroutine read_line(line, context, trees)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(inout) :: context
      type(element_trees_t), intent(inout) :: trees
      character(len=:), allocatable :: word
      integer(ip), allocatable :: elements(:), leaves(:)
      logical, allocatable :: is_named(:)
      type(token_t) :: place
      integer(ip) :: i, times
      integer :: outcome
      logical :: ok

      call find_elements(context, line_item(context%deck, line, 1_ip), elements, ok)
      if (.not. ok) return
      place = line_item(context%deck, line, 2_ip)
      word = token_text(context%deck, place)
      if (len(word) > 0 .and. verify(word, 'CLcl') == 0) then   ! as --adapt writes them
         do i = 1, size(elements, kind=ip)
            call take_code(elements(i), word, trees)
         end do
         return
      end if
      call read_integer(word, times, outcome)
      ok = outcome == NUMBER_OK
      if (ok) ok = times >= 0 .and. times <= MOST_TIMES
      if (.not. ok) then
         call report_error(context%deck, place, 'E-VALUE', word//' does not say how elements are cut', &
                           expected='how often, 0 to '//to_text(MOST_TIMES)//', or letters C and L as --adapt writes them')
         return
      end if
      allocate (is_named(trees%n_roots), source=.false.)
      is_named(elements) = .true.
      do i = 1, times
         leaves = list_leaves(trees)
         call cut_leaves(pack(leaves, is_named(trees%root(leaves))), trees)
      end do
   end subroutine read_line

   !> The card that cuts the elements of a deck in this way.
   pure function card_of_trees(deck, trees) result(card)
      type(deck_t), intent(in) :: deck                !< names of its instances are read
      type(element_trees_t), intent(in) :: trees      !< of all elements of the deck
      character(len=:), allocatable :: card
      type(growing_text_t) :: text
      integer(ip) :: e

      call append_text(text, '*'//KEYWORD//NEW_LINE)
      do e = 1, trees%n_roots
         if (trees%first_child(e) > 0) call append_text(text, name_of(trees%root_id(e))//', '//code_of_tree(trees, e)//NEW_LINE)
      end do
      card = text%letters(:text%n)

   contains

      !> The number of an element as it stands in the deck, with the instance that it is of.
      pure function name_of(id) result(name)
         integer(ip), intent(in) :: id
         character(len=:), allocatable :: name
         integer(ip) :: k

         name = to_text(id)
         if (.not. allocated(deck%scopes)) return
         do k = 1, ubound(deck%scopes, 1, kind=ip)
            associate (scope => deck%scopes(k))
               if (id > scope%shift .and. id <= scope%shift + scope%span) name = scope%name//'.'//to_text(id - scope%shift)
            end associate
         end do
      end function name_of

   end function card_of_trees

   !> Nodes of the deck that stay opposite to each other when its elements are cut: those of both sides of a contact pair or a
   !> tie that face each other one by one, and those that an equation of two nodes joins, as on periodic sides.
   !>
   !> Of each node the least of those that it stays with, itself where there are no others.
   pure function partner_nodes(model) result(partner)
      type(model_t), intent(in) :: model               !< with the mesh of the deck
      integer(ip) :: partner(model%mesh%n_nodes)
      integer(ip) :: e, i, j, k, side

      partner = [(i, i=1, model%mesh%n_nodes)]
      do i = 1, size(model%points, kind=ip)
         associate (pair => model%points(i))
            do j = 1, pair%n
               associate (first => pair%first(j), last => pair%first(j + 1) - 1)
                  if (last /= first + 1) cycle
                  if (any(abs(abs(pair%coefficient(first:last)) - 1) > FEW)) cycle
                  call join(pair%entry(first), pair%entry(last), partner)
               end associate
            end do
         end associate
      end do
      do i = 1, model%bilateral%n
         if (all(model%bilateral%kind(i) /= [ROW_EQUATION, ROW_TIE])) cycle
         if (model%bilateral%first(i + 1) /= model%bilateral%first(i) + 2) cycle
         k = model%bilateral%first(i)
         associate (node => model%bilateral%node, v => model%bilateral%vector)
            if (maxval(abs(v(:, k) + v(:, k + 1))) < FEW*maxval(abs(v(:, k)))) call join(node(k), node(k + 1), partner)
         end associate
      end do
      partner = [(last_of(i, partner), i=1, size(partner, kind=ip))]
      do e = 1, model%mesh%n_elements                  ! both ends of a side face the same node: that is no partner
         do side = 1, side_count(model%mesh, e)
            if (partner(model%mesh%nodes(side, e)) == partner(model%mesh%nodes(face_end(model%mesh, e, side), e))) then
               partner = [(i, i=1, model%mesh%n_nodes)]
               return
            end if
         end do
      end do
   end function partner_nodes

   pure subroutine join(a, b, partner)
      integer(ip), intent(in) :: a, b
      integer(ip), intent(inout) :: partner(:)
      integer(ip) :: ends(2)

      if (max(a, b) > size(partner)) return            ! reference nodes of rigid bodies
      ends = [last_of(a, partner), last_of(b, partner)]
      partner(maxval(ends)) = minval(ends)
   end subroutine join

   pure integer(ip) function last_of(node, partner) result(last)
      integer(ip), intent(in) :: node
      integer(ip), intent(in) :: partner(:)

      last = node
      do while (partner(last) /= last)
         last = partner(last)
      end do
   end function last_of

end module atrito_refine_model
