!> Checks of the finished mesh: shapes, sections, loose nodes, materials in use.
module atrito_check_mesh
   use atrito_build_materials, only: SECTION_SPOILED
   use atrito_check_edges, only: check_edges
   use atrito_deck, only: deck_t, token_t
   use atrito_diagnostics, only: report_error, report_warning, report_note, report_deck_error
   use atrito_draft, only: draft_t, place_token, ids_text, has_errors, is_spoiled
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, PLANE_STRAIN, FACES, Q2_NODES
   use atrito_messages, only: MOST_ERRORS
   use atrito_model, only: model_t
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_shape_functions, only: shape_gradients, gauss_point, gauss_count
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: check_mesh, corner_jacobians

   integer(ip), parameter :: SHAPE_GOOD = 0, SHAPE_CLOCKWISE = 1, SHAPE_DEGENERATE = 2, SHAPE_FOLDED = 3
   !> A corner whose Jacobian is smaller than this part of the longest side squared is flat.
   real(wp), parameter :: FLAT = 1.0e-12_wp
   !> From this ratio on fully integrated Q1 elements lock in plane strain.
   real(wp), parameter :: LOCKING_RATIO = 0.49_wp

contains

   !> Reports what is wrong with the mesh of a model whose cards have all been read.
   subroutine check_mesh(deck, model, draft)
      type(deck_t), intent(in) :: deck
      type(model_t), intent(in) :: model
      type(draft_t), intent(in) :: draft

      if (model%mesh%n_elements == 0) then
         if (.not. has_errors()) call report_deck_error(deck, 'E-EMPTY', 'the deck has no elements', &
                                                        expected='*ELEMENT or *BLOCK', keyword='BLOCK')
         return
      end if
      call check_shapes(deck, model, draft)
      if (draft%refinement%pieces == 1) call check_edges(deck, model, draft)
      call check_sections(deck, model, draft)
      call check_materials(deck, model, draft)
      call note_loose_nodes(deck, model, draft)
   end subroutine check_mesh

   subroutine check_shapes(deck, model, draft)
      type(deck_t), intent(in) :: deck
      type(model_t), intent(in) :: model
      type(draft_t), intent(in) :: draft
      integer(ip) :: e, shape, corner, n

      n = 0
      do e = 1, model%mesh%n_elements
         call judge_shape(model%mesh, e, shape, corner)
         if (shape == SHAPE_GOOD) cycle
         n = n + 1
         if (n <= MOST_ERRORS) call report_shape(deck, model%mesh, e, shape, corner, place_token(deck, draft%element_place(e)))
      end do
      if (n > MOST_ERRORS) call report_deck_error(deck, 'E-SHAPE', to_text(n - int(MOST_ERRORS, ip))// &
                                                  ' further elements are clockwise or degenerate', &
                                                  expected='corners counter-clockwise', keyword='ELEMENT')
   end subroutine check_shapes

   subroutine report_shape(deck, mesh, e, shape, corner, place)
      type(deck_t), intent(in) :: deck
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e, shape, corner
      type(token_t), intent(in) :: place
      character(len=:), allocatable :: name

      name = 'element '//to_text(mesh%element_id(e))
      if (shape == SHAPE_CLOCKWISE) then
         call report_error(deck, place, 'E-SHAPE', name//' runs clockwise', expected='corners counter-clockwise, for example '// &
                           corners_text(mesh, e), keyword='ELEMENT')
      else if (shape == SHAPE_FOLDED) then
         call report_error(deck, place, 'E-SHAPE', name//' folds over: the nodes 5 to 9 lie too far from the middle', &
                           expected='mid-side nodes in the middle half of their sides, the centre node near the centre', &
                           keyword='ELEMENT')
      else
         call report_error(deck, place, 'E-SHAPE', name//' is degenerate: its angle at node '// &
                           to_text(mesh%node_id(mesh%nodes(corner, e)))//' is not between 0 and 180 degrees', &
                           expected='a convex quadrilateral, corners counter-clockwise', keyword='ELEMENT')
      end if
   end subroutine report_shape

   !> The corners the other way round.
   pure function corners_text(mesh, e) result(text)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e
      character(len=:), allocatable :: text
      integer(ip) :: k

      text = to_text(mesh%node_id(mesh%nodes(1, e)))
      do k = FACES, 2, -1
         text = text//', '//to_text(mesh%node_id(mesh%nodes(k, e)))
      end do
   end function corners_text

   pure subroutine judge_shape(mesh, e, shape, corner)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e
      integer(ip), intent(out) :: shape                !< SHAPE_*
      integer(ip), intent(out) :: corner               !< the worst one
      real(wp) :: jacobian(FACES)

      jacobian = corner_jacobians(mesh%x(:, mesh%nodes(:FACES, e)))
      corner = minloc(jacobian, dim=1, kind=ip)
      shape = SHAPE_GOOD
      if (jacobian(corner) > FLAT) then
         if (mesh%shape(e) == Q2_NODES) then
            if (folds_over(mesh%x(:, mesh%nodes(:, e)))) shape = SHAPE_FOLDED
         end if
         return
      end if
      shape = SHAPE_DEGENERATE
      if (maxval(jacobian) < -FLAT) shape = SHAPE_CLOCKWISE
   end subroutine judge_shape

   !> Cross product of the two sides at each corner over the longest side squared; 1 for a square.
   pure function corner_jacobians(x) result(jacobian)
      real(wp), intent(in) :: x(2, FACES)              !< corners [L]
      real(wp) :: jacobian(FACES)
      real(wp) :: side(2, FACES), longest
      integer(ip) :: k

      side(:, :FACES - 1) = x(:, 2:) - x(:, :FACES - 1)
      side(:, FACES) = x(:, 1) - x(:, FACES)
      longest = max(maxval(abs(side)), tiny(1.0_wp))
      side = side/longest
      do k = 1, FACES
         associate (before => side(:, modulo(k - 2, FACES) + 1), after => side(:, k))
            jacobian(k) = before(1)*after(2) - before(2)*after(1)
         end associate
      end do
   end function corner_jacobians

   !> The map of a nine-node element is not one to one: its Jacobian is negative at a node, or not positive at a Gauss point. It may
   !> be 0 at a corner: mid-side nodes at a quarter of the sides are a known way to a crack tip.
   pure logical function folds_over(x)
      real(wp), intent(in) :: x(2, Q2_NODES)           !< [L]
      real(wp) :: xi(2), weight, size
      integer(ip) :: i, j, point

      size = maxval(maxval(x, dim=2) - minval(x, dim=2))
      folds_over = .false.
      do j = -1, 1
         do i = -1, 1
            folds_over = folds_over .or. jacobian_at(x/size, real([i, j], wp)) < -FLAT
         end do
      end do
      do point = 1, gauss_count(Q2_NODES)**2
         call gauss_point(Q2_NODES, point, xi, weight)
         folds_over = folds_over .or. jacobian_at(x/size, xi) <= FLAT
      end do
   end function folds_over

   pure real(wp) function jacobian_at(x, xi) result(jacobian)
      real(wp), intent(in) :: x(2, Q2_NODES), xi(2)
      real(wp) :: j(2, 2)

      j = matmul(x, shape_gradients(Q2_NODES, xi))
      jacobian = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
   end function jacobian_at

   !> Every element has a section.
   subroutine check_sections(deck, model, draft)
      type(deck_t), intent(in) :: deck
      type(model_t), intent(in) :: model
      type(draft_t), intent(in) :: draft
      type(number_list_t) :: without
      type(token_t) :: place
      integer(ip) :: e, first

      if (draft%sections_unsure .and. has_errors()) return
      first = 0
      do e = 1, model%mesh%n_elements
         if (model%section_of(e) /= 0) cycle
         if (first == 0) first = e
         call add_number(without, model%mesh%element_id(e))
      end do
      if (first == 0) return
      place = place_token(deck, draft%element_place(first))
      call report_error(deck, place, 'E-SECTION', 'no *SOLID SECTION for element '//ids_text(numbers_of(without)), &
                        expected='one *SOLID SECTION for each element', keyword='SOLID SECTION')
   end subroutine check_sections

   !> Materials in use have their constants, which fit the elements.
   subroutine check_materials(deck, model, draft)
      type(deck_t), intent(in) :: deck
      type(model_t), intent(in) :: model
      type(draft_t), intent(in) :: draft
      logical :: strained(size(model%materials))
      integer(ip) :: e, i

      strained = .false.
      do e = 1, model%mesh%n_elements
         if (model%section_of(e) <= 0) cycle
         associate (material => model%sections(model%section_of(e))%material)
            strained(material) = strained(material) .or. model%mesh%state(e) == PLANE_STRAIN
         end associate
      end do
      do i = 1, size(model%materials, kind=ip)
         associate (material => model%materials(i))
            if (.not. draft%elastic_given(i)) then
               if (.not. (draft%elastic_spoiled(i) .and. has_errors())) then
                  call report_error(deck, draft%materials(i), 'E-MATERIAL', 'material '//material%name//' has no *ELASTIC', &
                                    expected='*ELASTIC below *MATERIAL: E [F/L^2], mu [-]', keyword='ELASTIC')
               end if
            else if (strained(i) .and. .not. draft%elastic_spoiled(i)) then
               call check_strained(deck, material%poisson, draft%poisson(i))
            end if
         end associate
      end do
   end subroutine check_materials

   !> Poisson's ratio of a material in plane strain.
   subroutine check_strained(deck, poisson, place)
      type(deck_t), intent(in) :: deck
      real(wp), intent(in) :: poisson
      type(token_t), intent(in) :: place

      if (poisson >= 0.5_wp) then
         call report_error(deck, place, 'E-VALUE', 'mu = '//to_text(poisson)//' in plane strain', &
                           expected="Poisson's ratio mu, plane strain -1 < mu < 0.5, plane stress -1 < mu <= 0.5 [-]", &
                           keyword='ELASTIC')
      else if (poisson >= LOCKING_RATIO) then
         call report_warning(deck, place, 'W-LOCKING', 'nearly incompressible: fully integrated Q1 elements are much too stiff '// &
                             'in plane strain', expected='mu < 0.49 [-]', keyword='ELASTIC')
      end if
   end subroutine check_strained

   subroutine note_loose_nodes(deck, model, draft)
      type(deck_t), intent(in) :: deck
      type(model_t), intent(in) :: model
      type(draft_t), intent(in) :: draft
      type(number_list_t) :: loose
      integer(ip) :: i, first

      first = 0
      do i = 1, model%mesh%n_nodes
         if (draft%around%first(i + 1) > draft%around%first(i)) cycle
         if (first == 0) first = i
         call add_number(loose, model%mesh%node_id(i))
      end do
      if (first == 0 .or. has_errors()) return
      call report_note(deck, place_token(deck, draft%node_place(first)), 'N-NODE', 'node '// &
                       ids_text(numbers_of(loose))//' belongs to no element and has no unknowns', keyword='NODE')
   end subroutine note_loose_nodes

end module atrito_check_mesh
