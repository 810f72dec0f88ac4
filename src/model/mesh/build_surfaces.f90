!> *SURFACE, and the surfaces that a *BLOCK has by itself.
module atrito_build_surfaces
   use atrito_arcs, only: centre_arc
   use atrito_build_curves, only: put_curve_surfaces, take_node_surface, add_surface, keep_once
   use atrito_coordinates, only: get_coordinate
   use atrito_deck, only: deck_t, card_t, data_line_t, token_t, token_text, line_item, is_id_token, keyword_name
   use atrito_diagnostics, only: report_error
   use atrito_build_context, only: build_context_t, block_t, BLOCK_SIDES, invalidate_name, place_text, count_cards, ids_text, &
                                   MOST_IDS
   use atrito_element_table, only: MOST_SIDES
   use atrito_faces, only: is_outer_face, outer_faces, add_face, face_list_t
   use atrito_items, only: option_text, option_word
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: elements_of_square, side_count
   use atrito_messages, only: has_room, SEVERITY_ERROR
   use atrito_model, only: surface_t, SURFACE_SEGMENTS
   use atrito_motion, only: motion_t, moved
   use atrito_name_list, only: add_name, find_name, has_name
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_numbers, only: read_integer
   use atrito_ranges, only: numbers_among
   use atrito_references, only: find_elements, check_faces
   use atrito_refined_members, only: fine_elements, is_on_side
   use atrito_refinement, only: is_refined
   use atrito_sets, only: find_set, member_count, members_of
   use atrito_sorting, only: each_once
   use atrito_strings, only: same_name
   implicit none (type, external)
   private
   public :: build_surfaces

contains

   !> All surfaces of a model.
   subroutine build_surfaces(context)
      type(build_context_t), intent(inout) :: context
      integer(ip) :: i, n
      character(len=:), allocatable :: surface
      logical :: found

      ! each block may have four sides of its own, and those of all copies are of their *BLOCK
      n = (context%n_blocks + count_cards(context%deck, 'BLOCK'))*size(BLOCK_SIDES, kind=ip)
      allocate (context%model%surfaces(n + context%curves%n + count_cards(context%deck, 'SURFACE')))
      do i = 1, context%n_blocks
         call put_block_surfaces(context%blocks(i), context)
      end do
      call put_curve_surfaces(context)
      ! Lists the surfaces along which a *PRE-TENSION SECTION cuts: their faces lie inside the mesh.
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) /= 'PRE-TENSION SECTION') cycle
         call option_text(context%deck, context%deck%cards(i), 'SURFACE', surface, found)
         if (found) call add_name(context%section_surfaces, surface)
      end do
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == 'SURFACE') call read_surface_card(context%deck%cards(i), context)
      end do
      call cut_to_size(context%surface_names%n, context%model%surfaces)
   end subroutine build_surfaces

   !> The first n surfaces, handed on without a copy: they may be many.
   pure subroutine cut_to_size(n, surfaces)
      integer(ip), intent(in) :: n
      type(surface_t), allocatable, intent(inout) :: surfaces(:)
      type(surface_t), allocatable :: cut(:)
      integer(ip) :: i

      if (n == size(surfaces)) return
      allocate (cut(n))
      do i = 1, n
         associate (from => surfaces(i), to => cut(i))
            call move_alloc(from%name, to%name)
            to%kind = from%kind
            to%is_rigid_body = from%is_rigid_body
            to%faces%n = from%faces%n
            call move_alloc(from%faces%element, to%faces%element)
            call move_alloc(from%faces%face, to%faces%face)
            call move_alloc(from%points, to%points)
            call move_alloc(from%is_arc, to%is_arc)
            call move_alloc(from%centre, to%centre)
         end associate
      end do
      call move_alloc(cut, surfaces)
   end subroutine cut_to_size

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
         integer(ip) :: k, s

         s = find_name(context%surface_names, name)
         if (s == 0) then
            call add_surface(context, surface_t(name=name), context%deck%cards(block%card)%place)
            s = context%surface_names%n
         end if
         do k = 1, size(pieces, kind=ip)
            if (.not. is_on_side(context%refinement, pieces(k), face)) cycle
            if (is_outer_face(context%model%mesh, context%around, pieces(k), face)) call add_face(context%model%surfaces(s)%faces, &
                                                                                                  pieces(k), face)
         end do
      end subroutine put_faces

   end subroutine put_block_surfaces

   !> *SURFACE.
   subroutine read_surface_card(card, context)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      type(surface_t) :: surface
      type(token_t) :: place
      integer(ip) :: i
      logical :: found, ok

      call option_text(context%deck, card, 'NAME', surface%name, found, place)
      if (.not. found) return
      i = find_name(context%surface_names, surface%name)
      if (i > 0) then
         call report_error(context%deck, place, 'E-TWICE', 'surface '//surface%name//' is defined twice, first in '// &
                           place_text(context%deck, context%surfaces(i), place), expected='a name that no other surface has', &
                           keyword='SURFACE')
         return
      end if
      ok = card%ok
      if (.not. ok) then
         ! the reader has not checked the words of its lines
      else if (option_word(context%deck, card, 'TYPE') == 'ELEMENT') then
         call read_faces(card, context, has_name(context%section_surfaces, surface%name), surface%faces, ok)
      else if (option_word(context%deck, card, 'TYPE') == 'NODE') then
         call take_node_surface(surface%name, context, surface%faces, ok)
      else
         surface%kind = SURFACE_SEGMENTS
         call read_segments(context%deck, card, surface, ok)
         if (ok .and. card%scope > 0) call move_segments(context%motions(card%scope), surface)
      end if
      if (.not. ok) call invalidate_name(context, surface%name)
      call add_surface(context, surface, place)
   end subroutine read_surface_card

   subroutine read_faces(card, context, is_cut, faces, ok)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      logical, intent(in) :: is_cut                    !< a section of a bolt: faces may lie inside the mesh
      type(face_list_t), intent(inout) :: faces
      logical, intent(out) :: ok
      integer(ip), allocatable :: elements(:)
      integer(ip) :: i
      logical :: good, is_outline

      ok = .true.
      do i = card%first_line, card%first_line + card%n_lines - 1
         good = context%deck%lines(i)%ok
         if (good) good = is_no_node_set(context, line_item(context%deck, context%deck%lines(i), 1_ip))
         is_outline = good .and. .not. is_cut
         if (is_outline) is_outline = is_outline_of_set(context, context%deck%lines(i))
         if (is_outline) then
            call take_outline(context%deck%lines(i), context, faces, good)
         else
            if (good) call find_elements(context, line_item(context%deck, context%deck%lines(i), 1_ip), elements, good, 'SURFACE')
            if (good) call take_faces(context%deck%lines(i), context, elements, is_cut, faces, good)
         end if
         ok = ok .and. good
      end do
      call keep_once(faces)
   end subroutine read_faces

   !> The faces that a line asks for are those of a set on the outline: found without a look at each element, of which a large set
   !> has most inside.
   logical function is_outline_of_set(context, line)
      type(build_context_t), intent(inout) :: context
      type(data_line_t), intent(in) :: line

      is_outline_of_set = .not. is_id_token(context%deck, line_item(context%deck, line, 1_ip))
      if (is_outline_of_set) is_outline_of_set = set_of(context, line) > 0
      if (.not. is_outline_of_set) return
      call list_outline(context)
      is_outline_of_set = face_of(context, line) == 0 .or. &
                          (.not. is_refined(context%refinement) .and. face_of(context, line) <= context%least_sides)
   end function is_outline_of_set

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

   pure integer(ip) function set_of(context, line)
      type(build_context_t), intent(in) :: context
      type(data_line_t), intent(in) :: line

      set_of = find_set(context%model%element_sets, token_text(context%deck, line_item(context%deck, line, 1_ip)))
   end function set_of

   !> The face that a line names, S1..S4, which the reader has checked; 0: none.
   pure integer(ip) function face_of(context, line) result(face)
      type(build_context_t), intent(in) :: context
      type(data_line_t), intent(in) :: line
      character(len=:), allocatable :: word
      integer :: outcome

      face = 0
      word = token_text(context%deck, line_item(context%deck, line, 2_ip))
      if (len(word) > 0) call read_integer(word(2:), face, outcome)
   end function face_of

   !> Takes the faces of a set's elements that lie on the outline; one that is asked for and does not is an error.
   subroutine take_outline(line, context, faces, ok)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      type(face_list_t), intent(inout) :: faces
      logical, intent(out) :: ok
      type(face_list_t) :: outer
      integer(ip) :: i, n, face

      face = face_of(context, line)
      n = faces%n
      associate (set => context%model%element_sets%sets(set_of(context, line)))
         outer = outer_faces(context%model%mesh, context%around, numbers_among(set%members, context%outer_elements))
         do i = 1, outer%n
            if (face == 0 .or. outer%face(i) == face) call add_face(faces, outer%element(i), outer%face(i))
         end do
         n = member_count(set) - (faces%n - n)
         ok = face == 0 .or. n == 0
         if (.not. ok .and. has_room(SEVERITY_ERROR)) then
            call report_inside(context, line, first_inside(context, members_of(set), face), n)
         else if (.not. ok) then
            call report_inside(context, line, [integer(ip) ::], n)
         end if
      end associate
   end subroutine take_outline

   !> Numbers of the first elements whose face lies inside the mesh: as many as a message tells.
   function first_inside(context, elements, face) result(ids)
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: elements(:), face
      integer(ip), allocatable :: ids(:)
      type(number_list_t) :: inside
      integer(ip) :: i

      do i = 1, size(elements, kind=ip)
         if (is_outer_face(context%model%mesh, context%around, elements(i), face)) cycle
         call add_number(inside, context%model%mesh%element_id(elements(i)))
         if (inside%n == MOST_IDS) exit
      end do
      ids = numbers_of(inside)
   end function first_inside

   subroutine report_inside(context, line, ids, n)
      type(build_context_t), intent(in) :: context
      type(data_line_t), intent(in) :: line
      integer(ip), intent(in) :: ids(:)                !< of elements, the first MOST_IDS at least
      integer(ip), intent(in) :: n                     !< how many there are
      type(token_t) :: place

      place = line_item(context%deck, line, 2_ip)
      call report_error(context%deck, place, 'E-FACE', 'face '//token_text(context%deck, place)// &
                        ' lies inside the mesh, of element '//ids_text(ids, merge(n, 0_ip, size(ids) > 0)), &
                        expected='faces on the outline of the body; without a face, all of them', keyword='SURFACE')
   end subroutine report_inside

   !> A node set makes a surface of another type.
   logical function is_no_node_set(context, token)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: token
      character(len=:), allocatable :: name

      is_no_node_set = is_id_token(context%deck, token)
      if (is_no_node_set) return
      name = token_text(context%deck, token)
      is_no_node_set = find_set(context%model%element_sets, name) > 0 .or. find_set(context%model%node_sets, name) == 0
      if (.not. is_no_node_set) call report_error(context%deck, token, 'E-SET', name//' is a node set', &
                                                  expected='an element set; or TYPE=NODE, the faces between its nodes', &
                                                  keyword='SURFACE')
   end function is_no_node_set

   !> The face of each element that a line names, or all their outer faces.
   subroutine take_faces(line, context, elements, may_be_inside, faces, ok)
      type(data_line_t), intent(in) :: line
      type(build_context_t), intent(in) :: context
      integer(ip), intent(in) :: elements(:)
      logical, intent(in) :: may_be_inside
      type(face_list_t), intent(inout) :: faces
      logical, intent(out) :: ok
      type(number_list_t) :: inside
      type(face_list_t) :: outer
      character(len=:), allocatable :: word
      integer(ip) :: i, face
      integer :: outcome

      word = token_text(context%deck, line_item(context%deck, line, 2_ip))
      if (len(word) == 0) then
         outer = outer_faces(context%model%mesh, context%around, elements)
         do i = 1, outer%n
            call add_face(faces, outer%element(i), outer%face(i))
         end do
         ok = .true.
         return
      end if
      call read_integer(word(2:), face, outcome)       ! S1..S4, checked by the reader
      call check_faces(context, line_item(context%deck, line, 2_ip), elements, face, 'SURFACE', ok)
      if (.not. ok) return
      do i = 1, size(elements, kind=ip)
         if (.not. is_on_side(context%refinement, elements(i), face)) cycle
         if (may_be_inside) then
            call add_face(faces, elements(i), face)
         else if (is_outer_face(context%model%mesh, context%around, elements(i), face)) then
            call add_face(faces, elements(i), face)
         else
            call add_number(inside, context%model%mesh%element_id(elements(i)))
         end if
      end do
      ok = inside%n == 0
      if (ok) return
      call report_inside(context, line, numbers_of(inside), inside%n)
   end subroutine take_faces

   !> START, LINE and CIRCL.
   subroutine read_segments(deck, card, surface, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      type(surface_t), intent(inout) :: surface
      logical, intent(out) :: ok
      real(wp) :: x(2), centre(2)
      integer(ip) :: i, n
      logical :: good, is_arc

      ok = .true.
      n = 0
      allocate (surface%points(2, card%n_lines), surface%centre(2, card%n_lines), source=0.0_wp)
      allocate (surface%is_arc(card%n_lines), source=.false.)
      do i = card%first_line, card%first_line + card%n_lines - 1
         call read_segment(deck, card, i, x, is_arc, centre, good)
         ok = ok .and. good
         if (.not. ok) cycle
         n = n + 1
         surface%points(:, n) = x
         if (n == 1) cycle
         surface%is_arc(n - 1) = is_arc
         ok = has_length(deck, deck%lines(i), surface%points(:, n - 1), x)
         if (ok .and. is_arc) call centre_arc(deck, [line_item(deck, deck%lines(i), 4_ip), line_item(deck, deck%lines(i), 2_ip)], &
                                              surface%points(:, n - 1), x, centre, ok, 'SURFACE')
         surface%centre(:, n - 1) = centre
      end do
      surface%points = surface%points(:, :n)
      surface%is_arc = surface%is_arc(:max(n - 1, 0))
      surface%centre = surface%centre(:, :max(n - 1, 0))
      if (.not. ok .or. n /= 1) return
      ok = .false.
      ! without START the reader has told it
      if (.not. same_name(token_text(deck, line_item(deck, deck%lines(card%first_line), 1_ip)), 'START')) return
      call report_error(deck, card%place, 'E-MISSING', 'the surface has no segment', &
                        expected='START, x, y and LINE, x, y or CIRCL, x, y, xc, yc [L]', keyword='SURFACE')
   end subroutine read_segments

   !> A line that is drawn in a part stands where the instance is.
   pure subroutine move_segments(motion, surface)
      type(motion_t), intent(in) :: motion
      type(surface_t), intent(inout) :: surface
      integer(ip) :: i

      do i = 1, size(surface%points, 2, kind=ip)
         surface%points(:, i) = moved(motion, surface%points(:, i))
      end do
      do i = 1, size(surface%centre, 2, kind=ip)
         if (surface%is_arc(i)) surface%centre(:, i) = moved(motion, surface%centre(:, i))
      end do
   end subroutine move_segments

   !> One line: where it ends, and the centre of an arc.
   subroutine read_segment(deck, card, i, x, is_arc, centre, ok)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      integer(ip), intent(in) :: i                     !< place in deck%lines
      real(wp), intent(out) :: x(2), centre(2)
      logical, intent(out) :: is_arc, ok
      logical :: good(5)

      x = 0.0_wp
      centre = 0.0_wp
      is_arc = .false.
      ok = deck%lines(i)%ok
      if (.not. ok) return
      good = .true.
      is_arc = same_name(token_text(deck, line_item(deck, deck%lines(i), 1_ip)), 'CIRCL')
      call get_coordinate(deck, line_item(deck, deck%lines(i), 2_ip), 'x, a real [L]', x(1), good(1), 'SURFACE')
      call get_coordinate(deck, line_item(deck, deck%lines(i), 3_ip), 'y, a real [L]', x(2), good(2), 'SURFACE')
      if (is_arc) then
         call get_coordinate(deck, line_item(deck, deck%lines(i), 4_ip), 'xc, a real [L]', centre(1), good(3), 'SURFACE')
         call get_coordinate(deck, line_item(deck, deck%lines(i), 5_ip), 'yc, a real [L]', centre(2), good(4), 'SURFACE')
      end if
      good(5) = follows(deck, card, i)
      ok = all(good)
   end subroutine read_segment

   !> START comes first; that it is there once is checked by the reader.
   logical function follows(deck, card, i)
      type(deck_t), intent(in) :: deck
      type(card_t), intent(in) :: card
      integer(ip), intent(in) :: i                     !< place in deck%lines

      follows = i == card%first_line .or. .not. same_name(token_text(deck, line_item(deck, deck%lines(i), 1_ip)), 'START')
      if (.not. follows) call report_error(deck, line_item(deck, deck%lines(i), 1_ip), 'E-VALUE', &
                                           'START is not the first line', expected='START, x, y first, then LINE or CIRCL', &
                                           keyword='SURFACE')
   end function follows

   logical function has_length(deck, line, a, b)
      type(deck_t), intent(in) :: deck
      type(data_line_t), intent(in) :: line
      real(wp), intent(in) :: a(2), b(2)

      has_length = norm2(b - a) > epsilon(1.0_wp)*(maxval(abs(a)) + maxval(abs(b)))
      if (.not. has_length) call report_error(deck, line_item(deck, line, 2_ip), 'E-VALUE', 'the segment has no length', &
                                              expected='an end that differs from the one before [L]', keyword='SURFACE')
   end function has_length

end module atrito_build_surfaces
