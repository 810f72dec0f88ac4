!> *PRE-TENSION SECTION: a cut through a body whose two sides hold together but for one displacement along a normal, which is that
!> of the section's node.
!>
!> With u on the side of the surface's own elements and v on the other, for each of its nodes
!>    n . (u - v) = d,  t . (u - v) = 0,
!> d the first dof of the section's node. A force F there does the work F d: it pulls both sides towards each other. d > 0 is an
!> overlap of the undeformed sides: the body is the shorter by it.
!>
!> The node is a rigid body that moves along 1 alone, so that it is prescribed, loaded, released and inherited as such.
module atrito_build_pretension
   use atrito_bilateral_rows, only: add_row, ROW_SECTION
   use atrito_build_context, only: build_context_t, note_place, section_cut_t
   use atrito_build_rigid_bodies, only: append_rigid_body, carriers_of, find_free_node, is_reference
   use atrito_coordinates, only: get_reals
   use atrito_deck, only: card_t, token_t, line_item, keyword_name
   use atrito_diagnostics, only: report_error, report_warning
   use atrito_faces, only: add_face, face_list_t, list_node_elements
   use atrito_items, only: option_text
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_end
   use atrito_mesh_cut, only: cut_mesh, find_cut, mesh_cut_t
   use atrito_model, only: rigid_body_t, SURFACE_ELEMENTS
   use atrito_references, only: find_surface
   use atrito_strings, only: to_text
   use atrito_row_dofs, only: row_weight
   implicit none (type, external)
   private
   public :: build_pretension, add_pretension_rows

   character(len=*), parameter :: KEYWORD = 'PRE-TENSION SECTION'

contains

   !> All sections; the surfaces are there, and so are the rigid bodies, to which the sections' nodes come.
   subroutine build_pretension(context)
      type(build_context_t), intent(inout) :: context !< cuts, nodes, rigid bodies; its mesh is cut
      integer(ip) :: i

      allocate (context%cuts(0))
      do i = 1, context%deck%n_cards
         if (keyword_name(context%deck%cards(i)) == KEYWORD) call read_card(context%deck%cards(i), context)
      end do
      context%model%rigid_bodies = context%model%rigid_bodies(:context%rigid_bodies%n)
   end subroutine build_pretension

   subroutine read_card(card, context)
      type(card_t), intent(in) :: card
      type(build_context_t), intent(inout) :: context
      type(section_cut_t) :: cut
      type(token_t) :: place, node_place
      character(len=:), allocatable :: name
      integer(ip) :: surface, node, i
      character(len=*), parameter :: WHAT_NODE = 'a node of no element, of this section alone'
      real(wp) :: outward(2), along(2)
      logical :: found, ok

      call option_text(context%deck, card, 'SURFACE', name, found, place)
      if (.not. (found .and. card%ok)) return
      call find_surface(context, place, surface)
      if (surface == 0) return
      call find_free_node(card, context, 'NODE', WHAT_NODE, node, node_place)
      if (node == 0) return
      if (is_reference(context, node)) then
         call report_error(context%deck, node_place, 'E-NODE', 'node '//to_text(context%model%mesh%node_id(node))// &
                           ' is that of another section, or of a rigid surface', expected=WHAT_NODE)
         return
      end if
      if (context%model%surfaces(surface)%kind /= SURFACE_ELEMENTS .or. context%model%surfaces(surface)%faces%n == 0) then
         call refuse(context, place, 'surface '//name//' has no faces of elements')
         return
      end if
      associate (faces => context%model%surfaces(surface)%faces)
         ! The sum of the faces' outward normals by their lengths [L]: of a cut that is straight its normal by its length.
         outward = 0.0_wp
         associate (mesh => context%model%mesh)
            do i = 1, faces%n
               associate (e => faces%element(i), f => faces%face(i))
                  along = mesh%x(:, mesh%nodes(face_end(mesh, e, f), e)) - mesh%x(:, mesh%nodes(f, e))
               end associate
               outward = outward + [along(2), -along(1)]
            end do
         end associate
         call read_normal(cut%normal)
         if (ok) call cut_along(context, place, faces, cut, ok)
         if (.not. ok) return
         cut%body = context%rigid_bodies%n + 1
         call append_rigid_body(context, rigid_body_t(surface, node, cut%size, is_section=.true.))
         context%cuts = [context%cuts, cut]
      end associate

   contains

      !> The data line, or the mean normal of the faces.
      subroutine read_normal(normal)
         real(wp), intent(out) :: normal(2)
         character(len=*), parameter :: WHAT = 'component of the normal, a real'
         type(token_t) :: place
         real(wp) :: given(3)

         ok = card%n_lines > 0 .or. norm2(outward) > 0.0_wp
         normal = outward/max(norm2(outward), tiny(1.0_wp))
         if (.not. ok) call refuse(context, card%place, 'the faces have no normal in the mean')
         if (card%n_lines == 0) return
         call get_reals(context%deck, context%deck%lines(card%first_line), 1_ip, WHAT, given, ok, spread(0.0_wp, 1, 3))
         if (.not. ok) return
         place = line_item(context%deck, context%deck%lines(card%first_line), 1_ip)
         ok = norm2(given(:2)) > 0.0_wp .and. abs(given(3)) <= 0.0_wp
         if (.not. ok) then
            call report_error(context%deck, place, 'E-VALUE', 'this normal does not lie in the plane, or is 0', &
                              expected='x and y of the normal, and 0')
            return
         end if
         normal = given(:2)/maxval(abs(given(:2)))
         normal = normal/norm2(normal)
         if (dot_product(normal, outward) >= 0.0_wp) return
         call report_warning(context%deck, place, 'W-CUT', 'the normal points into the elements of the surface: a positive '// &
                             'force pushes the sides apart', expected='a normal that points away from these elements')
      end subroutine read_normal
   end subroutine read_card

   !> Cuts the mesh, and gives the new nodes what the old ones have.
   subroutine cut_along(context, place, faces, cut, ok)
      type(build_context_t), intent(inout) :: context
      type(token_t), intent(in) :: place
      type(face_list_t), intent(in) :: faces
      type(section_cut_t), intent(inout) :: cut
      logical, intent(out) :: ok
      type(mesh_cut_t) :: changes
      integer(ip) :: i, before

      call find_cut(context%model%mesh, context%around, faces, changes)
      ok = changes%outer_face == 0 .and. changes%tip == 0
      if (changes%outer_face > 0) then
         call refuse(context, place, 'face '//to_text(faces%face(changes%outer_face))//' of element ' &
                     //to_text(context%model%mesh%element_id(faces%element(changes%outer_face)))//' lies on the outline')
      else if (changes%tip > 0) then
         call refuse(context, place, 'the faces do not part the elements round node ' &
                     //to_text(context%model%mesh%node_id(changes%tip)))
      end if
      if (.not. ok) return
      do i = 1, faces%n
         call add_face(context%cut_faces, faces%element(i), faces%face(i))
         call add_face(context%cut_faces, changes%other(i), changes%other_face(i))
      end do
      cut%size = norm2(maxval(context%model%mesh%x(:, changes%node), dim=2) - minval(context%model%mesh%x(:, changes%node), dim=2))
      before = context%model%mesh%n_nodes
      cut%other = changes%node
      cut%own = [(before + i, i=1, size(changes%node, kind=ip))]
      call cut_mesh(changes, context%model%mesh)
      call note_place(context%nodes%place, context%model%mesh%n_nodes, 0_ip)
      context%nodes%place(cut%own) = context%nodes%place(cut%other)
      do i = 1, size(context%model%steps, kind=ip)
         associate (step => context%model%steps(i))
            if (allocated(step%heating)) step%heating = [step%heating, step%heating(cut%other)]
            if (allocated(step%heating_from)) step%heating_from = [step%heating_from, step%heating_from(cut%other)]
         end associate
      end do
      if (allocated(context%node_thickness)) context%node_thickness = [context%node_thickness, context%node_thickness(cut%other)]
      context%around = list_node_elements(context%model%mesh)
   end subroutine cut_along

   subroutine refuse(context, place, what)
      type(build_context_t), intent(in) :: context
      type(token_t), intent(in) :: place
      character(len=*), intent(in) :: what

      call report_error(context%deck, place, 'E-CUT', what, expected='faces inside a body, all of the elements on one '// &
                        'side, from outline to outline')
   end subroutine refuse

   !> The rows that hold the sides together; no nodes are made any more.
   subroutine add_pretension_rows(context)
      type(build_context_t), intent(inout) :: context !< its model gets bilateral rows of its cuts
      integer(ip) :: i, k, nodes(3), group
      real(wp) :: n(2), t(2), weight

      if (size(context%cuts) == 0) return
      weight = row_weight(context%model)
      do i = 1, size(context%cuts, kind=ip)
         associate (cut => context%cuts(i))
            n = cut%normal
            t = [-n(2), n(1)]
            nodes = carriers_of(context%model, cut%body)
            group = context%model%bilateral%n_groups + 1
            do k = 1, size(cut%own, kind=ip)
               call add_row([cut%own(k), cut%other(k), nodes(1)], reshape([n, -n, -1.0_wp, 0.0_wp], [2, 3]), 0.0_wp, 0.0_wp, &
                            weight, [ROW_SECTION, group, cut%body], context%model%bilateral)
               call add_row([cut%own(k), cut%other(k)], reshape([t, -t], [2, 2]), 0.0_wp, 0.0_wp, weight, &
                            [ROW_SECTION, group, cut%body], context%model%bilateral)
            end do
         end associate
      end do
   end subroutine add_pretension_rows

end module atrito_build_pretension
