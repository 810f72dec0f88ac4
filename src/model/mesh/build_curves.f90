!> Surfaces that follow from nodes: those of the curves of a mesh, and *SURFACE, TYPE=NODE. Their faces are found in the mesh of the
!> deck, before it is refined.
module atrito_build_curves
   use atrito_build_context, only: build_context_t, keep_token, ids_text, has_errors
   use atrito_curves, only: add_curve, find_curve_faces, find_node_faces, nodes_of_no_face
   use atrito_deck, only: token_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error, report_note
   use atrito_faces, only: add_face, drop_repeated, face_list_t
   use atrito_items, only: option_text, option_word
   use atrito_kinds, only: ip
   use atrito_model, only: surface_t
   use atrito_name_list, only: name_list_t, add_name, find_name, has_name
   use atrito_number_list, only: number_list_t, add_numbers, numbers_of
   use atrito_references, only: find_nodes
   use atrito_refined_members, only: fine_elements, is_on_side
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_curves, put_curve_surfaces, take_node_surface, add_surface

contains

   !> The faces on the outline that lie on curves, or between the nodes of a *SURFACE, TYPE=NODE.
   subroutine read_curves(context)
      type(build_context_t), intent(inout) :: context
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
            if (good) call find_nodes(context, line_item(deck, deck%lines(i), 1_ip), members, good, 'SURFACE')
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
                                 expected='the nodes of faces on the outline of a body, those in their middles too', &
                                 keyword='SURFACE')
            else if (size(loose) > 0 .and. .not. has_errors()) then
               call report_note(deck, card%place, 'N-SURFACE', 'node '//ids_text(mesh%node_id(loose))//' of surface '//name// &
                                ' is on none of its faces', keyword='SURFACE')
            end if
         end associate
      end associate
   end subroutine read_node_surface

   !> The faces of a *SURFACE, TYPE=NODE.
   subroutine take_node_surface(name, context, faces, ok)
      character(len=*), intent(in) :: name
      type(build_context_t), intent(in) :: context
      type(face_list_t), intent(inout) :: faces
      logical, intent(out) :: ok
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
      type(build_context_t), intent(inout) :: context
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
                                                     ' are on no outline: its surface has the others')
         end associate
      end do
   end subroutine put_curve_surfaces

   !> The faces of the present mesh that lie on some of the deck's.
   subroutine put_fine_faces(coarse, context, faces)
      type(face_list_t), intent(in) :: coarse
      type(build_context_t), intent(in) :: context
      type(face_list_t), intent(inout) :: faces
      integer(ip), allocatable :: pieces(:)
      integer(ip) :: i, k

      do i = 1, coarse%n
         pieces = fine_elements(context%refinement, coarse%element(i:i))
         do k = 1, size(pieces, kind=ip)
            if (is_on_side(context%refinement, pieces(k), coarse%face(i))) call add_face(faces, pieces(k), coarse%face(i))
         end do
      end do
   end subroutine put_fine_faces

   !> Adds a surface, under its name, to those of the model.
   subroutine add_surface(context, surface, place)
      type(build_context_t), intent(inout) :: context
      type(surface_t), intent(in) :: surface
      type(token_t), intent(in) :: place               !< where it is defined

      call add_name(context%surface_names, surface%name)
      context%model%surfaces(context%surface_names%n) = surface
      call keep_token(context%surfaces, context%surface_names%n, place)
   end subroutine add_surface

end module atrito_build_curves
