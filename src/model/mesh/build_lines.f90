!> Lines that carry names, and surfaces that follow from nodes.
!>
!> Line elements (T3D2, T3D3), as Gmsh writes the curves of a drawing into an Abaqus file, have no stiffness here: the nodes of an
!> element set of lines are a node set, and the faces that lie on them a surface, of the same name. So it is with the curves of a
!> mesh of Gmsh. *SURFACE, TYPE=NODE has the faces between its nodes. All these faces are found in the mesh of the deck, before it
!> is refined.
module atrito_build_lines
   use atrito_build_context, only: build_context_t, spoil_number, invalidate_name, keep_token, ids_text, has_errors
   use atrito_build_nodes, only: put_node_set
   use atrito_build_parts, only: add_curve, find_curve_faces, find_node_faces, nodes_of_no_face
   use atrito_deck, only: token_t, token_text, line_item, is_id_token, is_empty_token, keyword_name
   use atrito_diagnostics, only: report_error, report_note
   use atrito_faces, only: add_face, drop_repeated, face_list_t
   use atrito_growth, only: resize, number_list_t, add_number, add_numbers, numbers_of
   use atrito_id_map, only: add_id, find_id
   use atrito_items, only: has_option, option_text, option_word, makes_elements
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: signed_area, turned_nodes
   use atrito_model, only: surface_t
   use atrito_name_list, only: name_list_t, add_name, find_name, has_name
   use atrito_numbers, only: read_integer, NUMBER_OK
   use atrito_references, only: get_id, find_one_node, find_nodes
   use atrito_refined_members, only: face_on_side, fine_elements
   use atrito_sets, only: find_set, grow_set, members_of
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_lines, is_line_item, turn_elements, read_curves, put_curve_surfaces, take_node_surface, add_surface

contains

   !> All lines of the deck, behind its nodes, and the sets that name them.
   subroutine read_lines(context)
      type(build_context_t), intent(inout) :: context  !< lines, curves and node sets are made
      character(len=:), allocatable :: name
      type(token_t) :: place
      integer(ip) :: i
      logical :: found

      do i = 1, context%deck%n_cards
         if (makes_elements(context%deck, context%deck%cards(i), 'T3D')) call read_line_card(i, context)
      end do
      if (context%lines%ids%n == 0) return
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == 'ELSET') call read_line_set(i, context)
      end do
      do i = 1, context%deck%n_cards                   ! lines with a section would be trusses
         if (keyword_name(context%deck%cards(i)) /= 'SOLID SECTION') cycle
         call option_text(context%deck, context%deck%cards(i), 'ELSET', name, found, place)
         if (.not. found .or. find_set(context%lines%sets, name) == 0) cycle
         call report_error(context%deck, place, 'E-OUTSIDE', 'the elements of set '//name//' would be trusses, which atrito '// &
                           'has not', expected='elements of the plane; a spring along a line is *SPRING')
         call invalidate_name(context, name)
      end do
   end subroutine read_lines

   !> Lines of number, first end[, middle], last end.
   subroutine read_line_card(i_card, context)
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(inout) :: context
      type(number_list_t) :: members
      type(token_t) :: token
      character(len=:), allocatable :: name
      integer(ip) :: id, nodes(3), i, k
      logical :: found, ok, good, whole

      whole = .true.
      associate (deck => context%deck, card => context%deck%cards(i_card), lines => context%lines)
         if (lines%ids%n == 0) call report_note(deck, card%place, 'N-LINES', 'line elements have no stiffness here: each of '// &
                                                'their sets is a node set and a surface')
         do i = card%first_line, card%first_line + card%n_lines - 1
            ok = card%ok .and. deck%lines(i)%ok
            if (ok) then
               nodes = 0
               token = line_item(deck, deck%lines(i), 1_ip)
               call get_id(deck, token, 'element number', id, ok)
               do k = 1, deck%lines(i)%n_tokens - 1
                  call find_one_node(context, line_item(deck, deck%lines(i), k + 1), nodes(k), good)
                  ok = ok .and. good
               end do
            end if
            if (ok) then
               call add_id(lines%ids, id, lines%ids%n + 1, found)
               ok = .not. found
               if (found) call report_error(deck, token, 'E-TWICE', 'element '//to_text(id)//' is given twice', &
                                            expected='an element number that is free')
            end if
            whole = whole .and. ok
            if (.not. ok) then
               call spoil_number(deck, deck%lines(i), context%elements)
               cycle
            end if
            associate (n => lines%ids%n)
               if (.not. allocated(lines%nodes)) allocate (lines%nodes(4, 16))
               if (n > size(lines%nodes, 2)) call resize(lines%nodes, n - 1, 2*n)
               lines%nodes(:, n) = [nodes(1), merge(nodes(2), nodes(3), nodes(3) == 0), merge(nodes(2), 0_ip, nodes(3) > 0), id]
               call add_number(members, n)
            end associate
         end do
         call option_text(deck, card, 'ELSET', name, found)
      end associate
      if (.not. found) return
      if (.not. whole) call invalidate_name(context, name)
      if (len(name) > 0) call put_line_set(name, numbers_of(members), i_card, context)
   end subroutine read_line_card

   !> A set of lines is a node set and a curve.
   subroutine put_line_set(name, lines, i_card, context)
      character(len=*), intent(in) :: name
      integer(ip), intent(in) :: lines(:)              !< places
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(inout) :: context
      type(number_list_t) :: nodes
      integer(ip) :: i

      call grow_set(context%lines%sets, name, lines)
      do i = 1, size(lines, kind=ip)
         call add_numbers(nodes, context%lines%nodes(:2, lines(i)))
         if (context%lines%nodes(3, lines(i)) > 0) call add_number(nodes, context%lines%nodes(3, lines(i)))
      end do
      call put_node_set(context, i_card, name, numbers_of(nodes))
      if (.not. allocated(context%lines%nodes)) return    ! all of them are faulty
      call add_curve(context%curves, name, i_card, context%lines%nodes(:2, lines))
   end subroutine put_line_set

   !> The lines among the members of an *ELSET; what is none of them is read with the elements.
   subroutine read_line_set(i_card, context)
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(inout) :: context
      type(number_list_t) :: members
      character(len=:), allocatable :: name
      integer(ip) :: i, k, range(3), number
      integer :: outcome
      logical :: found

      associate (card => context%deck%cards(i_card), deck => context%deck)
         call option_text(deck, card, 'ELSET', name, found)
         if (.not. found) return
         do i = card%first_line, card%first_line + card%n_lines - 1
            if (.not. deck%lines(i)%ok) cycle
            if (.not. has_option(deck, card, 'GENERATE')) then
               do k = 1, deck%lines(i)%n_tokens
                  call add_numbers(members, lines_of_item(context, line_item(deck, deck%lines(i), k)))
               end do
               cycle
            end if
            range = [0_ip, -1_ip, 1_ip]                ! first, last, increment
            do k = 1, min(3_ip, deck%lines(i)%n_tokens)
               if (is_empty_token(line_item(deck, deck%lines(i), k))) cycle
               call read_integer(token_text(deck, line_item(deck, deck%lines(i), k)), number, outcome)
               if (outcome == NUMBER_OK) range(k) = number
            end do
            do k = 1, context%lines%ids%n
               number = context%lines%nodes(4, k)
               if (number < range(1) .or. number > range(2) .or. range(3) < 1) cycle
               if (modulo(number - range(1), range(3)) == 0) call add_number(members, k)
            end do
         end do
      end associate
      if (members%n > 0) call put_line_set(name, numbers_of(members), i_card, context)
   end subroutine read_line_set

   !> The lines that an item of an *ELSET names: by its number, or by a set of them.
   function lines_of_item(context, token) result(lines)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: token
      integer(ip), allocatable :: lines(:)
      integer(ip) :: id, i
      integer :: outcome

      allocate (lines(0))
      if (is_empty_token(token)) return
      if (is_id_token(context%deck, token)) then
         call read_integer(token_text(context%deck, token), id, outcome)
         if (outcome /= NUMBER_OK) return
         i = find_id(context%lines%ids, id)
         if (i > 0) lines = [i]
      else
         i = find_set(context%lines%sets, token_text(context%deck, token))
         if (i > 0) lines = members_of(context%lines%sets%sets(i))
      end if
   end function lines_of_item

   !> An item of an *ELSET names lines, and no elements.
   logical function is_line_item(context, token)
      type(build_context_t), intent(in) :: context     !< its lines and element sets are searched
      type(token_t), intent(in) :: token               !< the item

      is_line_item = context%lines%ids%n > 0
      if (is_line_item) is_line_item = size(lines_of_item(context, token)) > 0
      if (is_line_item .and. .not. is_id_token(context%deck, token)) then
         is_line_item = find_set(context%model%element_sets, token_text(context%deck, token)) == 0
      end if
   end function is_line_item

   !> Beside lines of Gmsh elements may run clockwise, as the surfaces of a drawing do: they are turned, and it is reported.
   subroutine turn_elements(context)
      type(build_context_t), intent(inout) :: context  !< clockwise elements of its mesh are turned
      integer(ip) :: e, turned

      if (context%lines%ids%n == 0) return
      turned = 0
      associate (mesh => context%model%mesh)
         do e = 1, mesh%n_elements
            if (signed_area(mesh, e) >= 0.0_wp) cycle
            mesh%nodes(:mesh%shape(e), e) = turned_nodes(mesh%nodes(:mesh%shape(e), e))
            turned = turned + 1
         end do
      end associate
      if (turned == 0) return
      do e = 1, context%deck%n_cards
         if (makes_elements(context%deck, context%deck%cards(e), 'T3D')) exit
      end do
      call report_note(context%deck, context%deck%cards(e)%place, 'N-TURNED', to_text(turned)//' elements ran clockwise and '// &
                       'are turned, and so are their faces S1, S2, ...')
   end subroutine turn_elements

   !> The faces on the outline that lie on curves, or between the nodes of a *SURFACE, TYPE=NODE.
   subroutine read_curves(context)
      type(build_context_t), intent(inout) :: context  !< curves get their faces; node_surfaces is made
      integer(ip) :: i

      do i = 1, context%curves%n
         call find_curve_faces(context%model%mesh, context%around, context%curves%list(i))
      end do
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) /= 'SURFACE') cycle
         if (context%deck%cards(i)%ok .and. option_word(context%deck, context%deck%cards(i), 'TYPE') == 'NODE') then
            call read_node_surface(i, context)
         end if
      end do
   end subroutine read_curves

   !> *SURFACE, TYPE=NODE. There are faces, and each node is on one of them.
   subroutine read_node_surface(i_card, context)
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(inout) :: context
      type(number_list_t) :: list
      integer(ip), allocatable :: members(:), none(:, :), loose(:)
      character(len=:), allocatable :: name
      integer(ip) :: i
      logical :: found, good, ok

      allocate (none(2, 0))
      ok = .true.
      associate (deck => context%deck, card => context%deck%cards(i_card), mesh => context%model%mesh)
         call option_text(deck, card, 'NAME', name, found)
         if (.not. found) return
         do i = card%first_line, card%first_line + card%n_lines - 1
            good = deck%lines(i)%ok
            if (good) call find_nodes(context, line_item(deck, deck%lines(i), 1_ip), members, good)
            if (good) call add_numbers(list, members)
            ok = ok .and. good
         end do
         if (.not. ok .or. find_name(context%node_surfaces%names, name) > 0) return   ! read_surface_card reports a second one
         call add_curve(context%node_surfaces, name, i_card, none)
         associate (surface => context%node_surfaces%list(context%node_surfaces%n), nodes => numbers_of(list))
            call find_node_faces(mesh, context%around, nodes, surface%faces)
            call drop_repeated(surface%faces)
            loose = nodes_of_no_face(mesh, nodes, surface%faces)
            if (surface%faces%n == 0) then
               call report_error(deck, card%place, 'E-FACE', 'no outer face has all its nodes in surface '//name, &
                                 expected='the nodes of faces on the outline of a body, those in their middles too')
            else if (size(loose) > 0 .and. .not. has_errors()) then
               call report_note(deck, card%place, 'N-SURFACE', 'node '//ids_text(mesh%node_id(loose))//' of surface '//name// &
                                ' is on none of its faces')
            end if
         end associate
      end associate
   end subroutine read_node_surface

   !> The faces of a *SURFACE, TYPE=NODE.
   subroutine take_node_surface(name, context, faces, ok)
      character(len=*), intent(in) :: name             !< of the *SURFACE, TYPE=NODE
      type(build_context_t), intent(in) :: context     !< node_surfaces and refinement are read
      type(face_list_t), intent(inout) :: faces        !< faces of the mesh as it is solved are added
      logical, intent(out) :: ok                       !< it has some; else nothing was added
      integer(ip) :: i

      i = find_name(context%node_surfaces%names, name)
      ok = i > 0
      if (.not. ok) return
      call put_fine_faces(context%node_surfaces%list(i)%faces, context, faces)
      ok = faces%n > 0
   end subroutine take_node_surface

   !> Makes surfaces of the curves of a Gmsh mesh that neither a *SURFACE nor a *BLOCK of the deck defines already. A curve inside
   !> the mesh has none.
   subroutine put_curve_surfaces(context)
      type(build_context_t), intent(inout) :: context  !< its model gets surfaces
      type(name_list_t) :: of_deck                     ! names of the deck's own surfaces
      type(surface_t) :: surface
      integer(ip) :: i
      character(len=:), allocatable :: name
      logical :: found

      do i = 1, merge(context%deck%n_cards, 0_ip, context%curves%n > 0)
         if (keyword_name(context%deck%cards(i)) /= 'SURFACE') cycle
         call option_text(context%deck, context%deck%cards(i), 'NAME', name, found)
         if (found) call add_name(of_deck, name)
      end do
      do i = 1, context%curves%n
         associate (curve => context%curves%list(i), place => context%deck%cards(context%curves%list(i)%card)%place)
            if (curve%faces%n == 0 .or. has_name(context%surface_names, curve%name) .or. has_name(of_deck, curve%name)) cycle
            surface%name = curve%name
            surface%faces = face_list_t()
            call put_fine_faces(curve%faces, context, surface%faces)
            call drop_repeated(surface%faces)
            call add_surface(context, surface, place)
            if (curve%n_inside > 0) call report_note(context%deck, place, 'N-SURFACE', to_text(curve%n_inside)//' of '// &
                                                     to_text(curve%n)//' lines of '//curve%name// &
                                                     ' are on no outline: its surface has the others', keyword='')
         end associate
      end do
   end subroutine put_curve_surfaces

   !> The faces of the present mesh that lie on some of the deck's.
   subroutine put_fine_faces(coarse, context, faces)
      type(face_list_t), intent(in) :: coarse
      type(build_context_t), intent(in) :: context
      type(face_list_t), intent(inout) :: faces
      integer(ip), allocatable :: pieces(:)
      integer(ip) :: i, k, own

      do i = 1, coarse%n
         pieces = fine_elements(context%refinement, coarse%element(i:i))
         do k = 1, size(pieces, kind=ip)
            own = face_on_side(context%refinement, pieces(k), coarse%face(i))
            if (own > 0) call add_face(faces, pieces(k), own)
         end do
      end do
   end subroutine put_fine_faces

   !> Adds a surface, under its name, to those of the model.
   subroutine add_surface(context, surface, place)
      type(build_context_t), intent(inout) :: context  !< surfaces and surface_names of it grow
      type(surface_t), intent(in) :: surface           !< with its name
      type(token_t), intent(in) :: place               !< where it is defined

      call add_name(context%surface_names, surface%name)
      context%model%surfaces(context%surface_names%n) = surface
      call keep_token(context%surfaces, context%surface_names%n, place)
   end subroutine add_surface

end module atrito_build_lines
