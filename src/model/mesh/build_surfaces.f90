!> *SURFACE, and the surfaces that a *BLOCK has by itself.
module atrito_build_surfaces
   use atrito_coordinates, only: centre_arc, get_point, moved
   use atrito_build_lines, only: put_curve_surfaces, take_node_surface, add_surface
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t, token_text, line_item, is_id_token, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_build_context, only: build_context_t, block_t, BLOCK_SIDES, define_name, invalidate_name, count_cards, ids_text, &
                                   MOST_IDS
   use atrito_element_table, only: MOST_SIDES
   use atrito_faces, only: is_outer_face, outer_faces, add_face, drop_repeated, face_list_t
   use atrito_items, only: option_text, option_word
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: elements_of_square, side_count
   use atrito_messages, only: has_room, SEVERITY_ERROR
   use atrito_model, only: surface_t, SURFACE_SEGMENTS
   use atrito_name_list, only: add_name, find_name, has_name
   use atrito_growth, only: number_list_t, add_number, numbers_of
   use atrito_numbers, only: read_integer
   use atrito_sets, only: numbers_among, set_t, find_set, member_count, members_of
   use atrito_references, only: find_elements, check_faces
   use atrito_refined_members, only: face_on_side, fine_elements
   use atrito_refinement, only: is_refined
   use atrito_sorting, only: each_once
   use atrito_strings, only: same_name, upper_case
   implicit none (type, external)
   private
   public :: build_surfaces

contains

   !> All surfaces of a model.
   subroutine build_surfaces(context)
      type(build_context_t), intent(inout) :: context  !< its model gets surfaces
      integer(ip) :: i, n_sides
      character(len=:), allocatable :: surface
      logical :: found

      n_sides = 0                                      ! each block has four of its own, and all copies of a *BLOCK four together
      do i = 1, context%n_blocks
         n_sides = n_sides + size(BLOCK_SIDES, kind=ip)
         associate (block => context%blocks(i))
            if (allocated(block%array) .and. context%block_of_card(block%card) == i) n_sides = n_sides + size(BLOCK_SIDES, kind=ip)
         end associate
      end do
      allocate (context%model%surfaces(n_sides + context%curves%n + count_cards(context%deck, 'SURFACE')))
      do i = 1, context%n_blocks
         call put_block_surfaces(context%blocks(i), context)
      end do
      call put_curve_surfaces(context)
      do i = 1, context%deck%n_cards                   ! surfaces along which bolts are cut: their faces lie inside the mesh
         if (keyword_name(context%deck%cards(i)) /= 'PRE-TENSION SECTION') cycle
         call option_text(context%deck, context%deck%cards(i), 'SURFACE', surface, found)
         if (found) call add_name(context%section_surfaces, surface)
      end do
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == 'SURFACE') call read_surface_card(context%deck%cards(i), context)
      end do
      associate (n => context%surface_names%n)
         if (n < size(context%model%surfaces)) context%model%surfaces = context%model%surfaces(:n)
      end associate
   end subroutine build_surfaces

   !> The four sides of a block, and its part of the sides of all copies; faces that another block has joined are left out.
   subroutine put_block_surfaces(block, context)
      type(block_t), intent(in) :: block
      type(build_context_t), intent(inout) :: context
      integer(ip) :: nx, ny, per, i

      nx = ubound(block%nodes, 1, kind=ip)/block%order
      ny = ubound(block%nodes, 2, kind=ip)/block%order
      per = elements_of_square(block%shape)
      if (block%first_element + per*nx*ny - 1 > context%model%mesh%n_elements) return
      call put_side(1_ip, [(i, i=0, nx - 1)])
      call put_side(2_ip, [(nx - 1 + nx*i, i=0, ny - 1)])
      call put_side(3_ip, [(nx*(ny - 1) + i, i=0, nx - 1)])
      call put_side(4_ip, [(nx*i, i=0, ny - 1)])

   contains

      subroutine put_side(side, squares)
         integer(ip), intent(in) :: side
         integer(ip), intent(in) :: squares(:)         !< counted from the first of the block
         integer(ip), allocatable :: pieces(:)
         integer(ip) :: face, k

         k = 0
         face = side
         if (per == 2 .and. side > 2) then             ! of the upper triangle: see triangles_of_square
            k = 1
            face = side - 2
         end if
         pieces = fine_elements(context%refinement, block%first_element + k + per*squares)
         call put_faces(block%name//trim(BLOCK_SIDES(side)), face, pieces)
         if (block%at_side(side)) call put_faces(block%array//trim(BLOCK_SIDES(side)), face, pieces)
      end subroutine put_side

      subroutine put_faces(name, face, pieces)
         character(len=*), intent(in) :: name          !< of the surface
         integer(ip), intent(in) :: face, pieces(:)
         integer(ip) :: k, own, s

         s = find_name(context%surface_names, name)
         if (s == 0) then
            call add_surface(context, surface_t(name=name), context%deck%cards(block%card)%place)
            s = context%surface_names%n
         end if
         do k = 1, size(pieces, kind=ip)
            own = face_on_side(context%refinement, pieces(k), face)
            if (own == 0) cycle
            if (is_outer_face(context%model%mesh, context%around, pieces(k), own)) call add_face(context%model%surfaces(s)%faces, &
                                                                                                 pieces(k), own)
         end do
      end subroutine put_faces

   end subroutine put_block_surfaces

   !> *SURFACE.
   subroutine read_surface_card(card, context)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      type(surface_t) :: surface
      integer(ip) :: i, k
      logical :: ok, good

      call define_name(context%deck, card, 'surface', context%surface_names, context%surfaces, surface%name, i)
      if (i == 0) return
      ok = card%ok
      if (.not. ok) then
         ! the reader has not checked the words of its lines
      else if (option_word(context%deck, card, 'TYPE') == 'ELEMENT') then
         do k = card%first_line, card%first_line + card%n_lines - 1
            good = context%deck%lines(k)%ok
            if (good) call read_face_line(context%deck%lines(k), context, has_name(context%section_surfaces, surface%name), &
                                          surface%faces, good)
            ok = ok .and. good
         end do
         call drop_repeated(surface%faces)
      else if (option_word(context%deck, card, 'TYPE') == 'NODE') then
         call take_node_surface(surface%name, context, surface%faces, ok)
      else
         surface%kind = SURFACE_SEGMENTS
         call read_segments(context%deck, card, surface, ok)
         do k = 1, merge(size(surface%points, 2, kind=ip), 0_ip, ok .and. card%scope > 0)   ! drawn in a part
            surface%points(:, k) = moved(context%motions(card%scope), surface%points(:, k))
            if (k > size(surface%is_arc)) cycle
            if (surface%is_arc(k)) surface%centre(:, k) = moved(context%motions(card%scope), surface%centre(:, k))
         end do
      end if
      if (.not. ok) call invalidate_name(context, surface%name)
      context%model%surfaces(i) = surface
   end subroutine read_surface_card

   !> Element or set, and the face of each element; without it all of their outer faces. Faces of a set on the outline are found
   !> without a look at each element, of which a large set has most inside.
   subroutine read_face_line(line, context, is_cut, faces, ok)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(inout) :: context
      logical, intent(in) :: is_cut                    !< a section of a bolt: faces may lie inside the mesh
      type(face_list_t), intent(inout) :: faces
      logical, intent(out) :: ok
      type(token_t) :: token
      character(len=:), allocatable :: name, word
      type(number_list_t) :: inside
      integer(ip), allocatable :: elements(:)
      integer(ip) :: face, own, i_set, i
      integer :: outcome

      token = line_item(context%deck, line, 1_ip)
      word = token_text(context%deck, line_item(context%deck, line, 2_ip))
      face = 0
      if (len(word) > 0) call read_integer(word(2:), face, outcome)   ! S1..S4, checked by the reader
      if (.not. is_id_token(context%deck, token)) then
         name = token_text(context%deck, token)
         i_set = find_set(context%model%element_sets, name)
         ok = i_set > 0 .or. find_set(context%model%node_sets, name) == 0
         if (.not. ok) then
            call report_error(context%deck, token, 'E-SET', name//' is a node set', &
                              expected='an element set; or TYPE=NODE, the faces between its nodes')
            return
         end if
         if (i_set > 0 .and. .not. is_cut) then
            call list_outline(context)
            if (face == 0 .or. (.not. is_refined(context%refinement) .and. face <= context%least_sides)) then
               call take_outline(context%model%element_sets%sets(i_set))
               return
            end if
         end if
      end if
      call find_elements(context, token, elements, ok)
      if (ok .and. face > 0) call check_faces(context, line_item(context%deck, line, 2_ip), elements, face, ok)
      if (.not. ok) return
      if (face == 0) then
         call add_faces(outer_faces(context%model%mesh, context%around, elements), 0_ip, faces)
         return
      end if
      do i = 1, size(elements, kind=ip)
         own = face_on_side(context%refinement, elements(i), face)
         if (own == 0) cycle
         ok = is_cut
         if (.not. ok) ok = is_outer_face(context%model%mesh, context%around, elements(i), own)
         if (ok) call add_face(faces, elements(i), own)
         if (.not. ok) call add_number(inside, context%model%mesh%element_id(elements(i)))
      end do
      ok = inside%n == 0
      if (.not. ok) call report_inside(context, line, numbers_of(inside), inside%n)

   contains

      !> Takes the faces of a set's elements that lie on the outline; one that is asked for and does not is an error.
      subroutine take_outline(set)
         type(set_t), intent(in) :: set
         type(number_list_t) :: inside
         integer(ip), allocatable :: elements(:)
         integer(ip) :: i, n

         n = member_count(set) + faces%n
         call add_faces(outer_faces(context%model%mesh, context%around, numbers_among(set%members, context%outer_elements)), face, &
                        faces)
         n = n - faces%n                                  ! elements whose face lies inside the mesh
         ok = face == 0 .or. n == 0
         if (ok) return
         elements = [integer(ip) ::]
         if (has_room(SEVERITY_ERROR)) elements = members_of(set)
         do i = 1, size(elements, kind=ip)                ! the first of them, as many as a message has
            if (is_outer_face(context%model%mesh, context%around, elements(i), face)) cycle
            call add_number(inside, context%model%mesh%element_id(elements(i)))
            if (inside%n == MOST_IDS) exit
         end do
         call report_inside(context, line, numbers_of(inside), merge(n, 0_ip, inside%n > 0))
      end subroutine take_outline
   end subroutine read_face_line

   !> The elements on the outline.
   subroutine list_outline(context)
      type(build_context_t), intent(inout) :: context
      type(face_list_t) :: outer
      integer(ip) :: i

      if (allocated(context%outer_elements)) return
      associate (mesh => context%model%mesh)
         allocate (context%outer_elements(0))
         if (mesh%n_elements > 0) outer = outer_faces(mesh, context%around, [(i, i=1, mesh%n_elements)])
         if (outer%n > 0) context%outer_elements = each_once(outer%element(:outer%n))
         context%least_sides = MOST_SIDES
         do i = 1, mesh%n_elements
            context%least_sides = min(context%least_sides, side_count(mesh, i))
         end do
      end associate
   end subroutine list_outline

   !> Adds those of some faces that have a number; 0: all.
   pure subroutine add_faces(some, face, faces)
      type(face_list_t), intent(in) :: some
      integer(ip), intent(in) :: face
      type(face_list_t), intent(inout) :: faces
      integer(ip) :: i

      do i = 1, some%n
         if (face == 0 .or. some%face(i) == face) call add_face(faces, some%element(i), some%face(i))
      end do
   end subroutine add_faces

   !> Reports faces that were asked for and do not lie on the outline.
   subroutine report_inside(context, line, ids, n)
      type(build_context_t), intent(in) :: context
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: ids(:)                !< of elements, the first MOST_IDS at least
      integer(ip), intent(in) :: n                     !< how many there are
      type(token_t) :: place

      place = line_item(context%deck, line, 2_ip)
      call report_error(context%deck, place, 'E-FACE', 'face '//token_text(context%deck, place)// &
                        ' lies inside the mesh, of element '//ids_text(ids, n), &
                        expected='faces on the outline of the body; without a face, all of them')
   end subroutine report_inside

   !> START, LINE and CIRCL.
   subroutine read_segments(deck, card, surface, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(surface_t), intent(inout) :: surface
      logical, intent(out) :: ok
      character(len=*), parameter :: WHAT(4) = ['x, a real [L] ', 'y, a real [L] ', 'xc, a real [L]', 'yc, a real [L]']
      character(len=:), allocatable :: word
      real(wp) :: x(4)                                 ! end of the segment, and the centre of an arc [L]
      integer(ip) :: i, n
      logical :: is_arc

      ok = .true.
      n = 0
      allocate (surface%points(2, card%n_lines), surface%centre(2, card%n_lines), source=0.0_wp)
      allocate (surface%is_arc(card%n_lines), source=.false.)
      do i = card%first_line, card%first_line + card%n_lines - 1
         associate (line => deck%lines(i))
            ok = ok .and. line%ok
            if (.not. line%ok) cycle
            word = upper_case(token_text(deck, line_item(deck, line, 1_ip)))
            is_arc = word == 'CIRCL'
            x = 0.0_wp
            call get_point(deck, line, 2_ip, WHAT(:2), x(:2), ok)
            if (is_arc) call get_point(deck, line, 4_ip, WHAT(3:), x(3:), ok)
            if (i > card%first_line .and. word == 'START') then   ! that it is there once is checked by the reader
               ok = .false.
               call report_error(deck, line_item(deck, line, 1_ip), 'E-VALUE', 'START is not the first line', &
                                 expected='START, x, y first, then LINE or CIRCL')
            end if
            if (.not. ok) cycle
            n = n + 1
            surface%points(:, n) = x(:2)
            if (n == 1) cycle
            associate (before => surface%points(:, n - 1))
               ok = norm2(x(:2) - before) > epsilon(1.0_wp)*(maxval(abs(before)) + maxval(abs(x(:2))))
               if (.not. ok) call report_error(deck, line_item(deck, line, 2_ip), 'E-VALUE', 'the segment has no length', &
                                               expected='an end that differs from the one before [L]')
               if (ok .and. is_arc) call centre_arc(deck, [line_item(deck, line, 4_ip), line_item(deck, line, 2_ip)], before, &
                                                    x(:2), x(3:), ok)
            end associate
            surface%is_arc(n - 1) = is_arc
            surface%centre(:, n - 1) = x(3:)
         end associate
      end do
      surface%points = surface%points(:, :n)
      surface%is_arc = surface%is_arc(:max(n - 1, 0))
      surface%centre = surface%centre(:, :max(n - 1, 0))
      if (.not. ok .or. n /= 1) return
      ok = .false.
      ! without START the reader has reported it
      if (.not. same_name(token_text(deck, line_item(deck, deck%lines(card%first_line), 1_ip)), 'START')) return
      call report_error(deck, card%place, 'E-MISSING', 'the surface has no segment', &
                        expected='START, x, y and LINE, x, y or CIRCL, x, y, xc, yc [L]')
   end subroutine read_segments

end module atrito_build_surfaces
