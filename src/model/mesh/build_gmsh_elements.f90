!> The elements of a mesh of Gmsh, behind all nodes of the deck, and their sets.
module atrito_build_gmsh_elements
   use atrito_build_context, only: build_context_t, note_places
   use atrito_build_gmsh, only: mesh_of_card, find_shift, refuse
   use atrito_diagnostics, only: report_note
   use atrito_element_table, only: CORNERS_OF, MOST_NODES
   use atrito_gmsh_mesh, only: gmsh_mesh_t, group_name, part_name
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_items, only: has_option, option_word
   use atrito_kinds, only: ip
   use atrito_mesh, only: add_element, find_node, reserve_mesh
   use atrito_plane_state, only: PLANE_STRAIN, PLANE_STRESS, AXISYMMETRIC
   use atrito_sets, only: grow_set
   use atrito_strings, only: to_text
   use atrito_turned_elements, only: turned_nodes, is_clockwise
   implicit none (type, external)
   private
   public :: read_mesh_elements

contains

   !> The elements of the mesh that a card names, and its element sets.
   subroutine read_mesh_elements(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      type(build_context_t), intent(inout) :: context
      integer(ip), allocatable :: first(:)             ! of each element of the file the first with its nodes; 0: not of the plane
      integer(ip), allocatable :: place(:)             ! of each element of the file in the mesh
      integer(ip) :: i, shift
      logical :: ok

      i = mesh_of_card(i_card, context)
      if (i == 0) return
      if (context%mesh_shift(i) < 0) return            ! its nodes were refused
      associate (mesh => context%deck%meshes(i))
         call find_plane_elements(mesh, first)
         call find_shift(pack(mesh%element_id, first > 0), context%model%mesh%element_map, &
                         context%elements%greatest, 'element', i_card, context, shift, ok)
         if (ok) call place_elements(mesh, [context%mesh_shift(i), shift], first, context, place, ok)
         if (.not. ok) return
         call note_state(mesh, i_card, context)
         call put_element_sets(mesh, place, context)
      end associate
   end subroutine read_mesh_elements

   !> Of each element of the file the first that has its nodes: itself, but for format 2.2, which has an element once for each of
   !> its groups. 0: it is a point or a line.
   subroutine find_plane_elements(mesh, first)
      type(gmsh_mesh_t), intent(in) :: mesh
      integer(ip), allocatable, intent(out) :: first(:)
      logical, allocatable :: is_plane(:), is_shared(:)
      type(id_map_t) :: seen                           ! entities
      integer(ip) :: p, e
      logical :: known

      allocate (is_plane(mesh%n_parts), is_shared(mesh%n_parts))
      is_shared = .false.
      do p = 1, mesh%n_parts
         is_plane(p) = mesh%parts(p)%dim == 2
         if (.not. is_plane(p) .or. mesh%parts(p)%tag < 1) cycle
         call add_id(seen, mesh%parts(p)%tag, p, known)
         is_shared(p) = known
         if (known) is_shared(find_id(seen, mesh%parts(p)%tag)) = .true.
      end do
      allocate (first(mesh%n_elements), source=0_ip)
      do e = 1, mesh%n_elements
         if (is_plane(mesh%part(e))) first(e) = e
      end do
      if (any(is_shared)) call find_twins(mesh, is_shared, first)
   end subroutine find_plane_elements

   !> Elements of the same corners, of which each list by the least of their corners has few.
   subroutine find_twins(mesh, is_shared, first)
      type(gmsh_mesh_t), intent(in) :: mesh
      logical, intent(in) :: is_shared(:)              !< of each part
      integer(ip), intent(inout) :: first(:)
      integer(ip), allocatable :: next(:)
      type(id_map_t) :: last                           ! of each node the first element in its list
      integer(ip) :: e, other, least, n
      logical :: known

      allocate (next(mesh%n_elements), source=0_ip)
      do e = 1, mesh%n_elements
         if (.not. is_shared(mesh%part(e))) cycle
         n = CORNERS_OF(mesh%shape(e))
         least = minval(mesh%nodes(:n, e))
         call add_id(last, least, e, known)
         if (.not. known) cycle
         other = find_id(last, least)
         do
            if (mesh%shape(other) == mesh%shape(e)) then
               if (has_same(mesh%nodes(:n, other), mesh%nodes(:n, e))) then
                  first(e) = other
                  exit
               end if
            end if
            if (next(other) == 0) then
               next(other) = e
               exit
            end if
            other = next(other)
         end do
      end do
   end subroutine find_twins

   pure logical function has_same(a, b)
      integer(ip), intent(in) :: a(:), b(:)
      integer(ip) :: i

      has_same = all([(any(a == b(i)), i=1, size(b))])
   end function has_same

   !> Adds the elements, those of a mesh whose card comes with it.
   subroutine place_elements(mesh, shift, first, context, place, ok)
      type(gmsh_mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: shift(2)              !< of the numbers of nodes and elements
      integer(ip), intent(in) :: first(:)              !< as of find_plane_elements
      type(build_context_t), intent(inout) :: context
      integer(ip), allocatable, intent(out) :: place(:)
      logical, intent(out) :: ok
      integer(ip) :: e, before, state

      ok = .true.
      state = state_of(mesh%card, context)
      before = context%model%mesh%n_elements
      allocate (place(mesh%n_elements), source=0_ip)
      call reserve_mesh(context%model%mesh, 0_ip, count(first > 0, kind=ip))
      do e = 1, mesh%n_elements
         if (first(e) == e) then
            call place_one(mesh, e, shift, state, context, ok)
            if (.not. ok) exit
            place(e) = context%model%mesh%n_elements
         else if (first(e) > 0) then
            place(e) = place(first(e))
         end if
      end do
      call note_places(context%elements%place, before + 1, context%model%mesh%n_elements, -mesh%card)
   end subroutine place_elements

   !> Adds an element, counter-clockwise.
   subroutine place_one(mesh, e, shift, state, context, ok)
      type(gmsh_mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: e, shift(2), state
      type(build_context_t), intent(inout) :: context
      logical, intent(out) :: ok
      integer(ip) :: nodes(MOST_NODES), k, n
      logical :: known

      n = mesh%shape(e)
      ok = .true.
      do k = 1, n
         nodes(k) = find_node(context%model%mesh, mesh%nodes(k, e) + shift(1))
         ok = ok .and. all(nodes(:k - 1) /= nodes(k))
      end do
      if (.not. ok) then
         call refuse(mesh%card, context, 'E-SHAPE', 'element '//to_text(mesh%element_id(e))//' of '//mesh%file// &
                     ' has a node twice', 'different nodes')
         return
      end if
      if (is_clockwise(context%model%mesh%x(:, nodes(:CORNERS_OF(n))))) nodes(:n) = turned_nodes(nodes(:n))
      call add_element(context%model%mesh, mesh%element_id(e) + shift(2), state, nodes(:n), known)
      ok = .not. known
      context%elements%greatest = max(context%elements%greatest, mesh%element_id(e) + shift(2))
      if (known) call refuse(mesh%card, context, 'E-TWICE', 'element '//to_text(mesh%element_id(e))//' stands twice in '// &
                             mesh%file, 'each element once')
   end subroutine place_one

   !> The plane state that ELEMENTS= names.
   integer(ip) function state_of(i_card, context) result(state)
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(in) :: context

      select case (option_word(context%deck, context%deck%cards(i_card), 'ELEMENTS'))
      case ('CPE')
         state = PLANE_STRAIN
      case ('CAX')
         state = AXISYMMETRIC
      case default
         state = PLANE_STRESS
      end select
   end function state_of

   !> Plane stress is taken where the deck does not say what else.
   subroutine note_state(mesh, i_card, context)
      type(gmsh_mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(in) :: context

      if (has_option(context%deck, context%deck%cards(i_card), 'ELEMENTS')) return
      call report_note(context%deck, context%deck%cards(i_card)%place, 'N-GMSH', 'the elements of '//mesh%file// &
                       ' are taken as plane stress', expected='ELEMENTS=CPS, CPE (plane strain) or CAX (axisymmetric)', &
                       keyword='INCLUDE')
   end subroutine note_state

   !> Element sets of the surfaces of the drawing and their physical groups.
   subroutine put_element_sets(mesh, place, context)
      type(gmsh_mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: place(:)
      type(build_context_t), intent(inout) :: context
      integer(ip), allocatable :: members(:), n(:), from(:)
      integer(ip) :: e, p, g

      allocate (n(mesh%n_parts), from(mesh%n_parts + 1), source=0_ip)
      do e = 1, mesh%n_elements
         if (place(e) > 0) n(mesh%part(e)) = n(mesh%part(e)) + 1
      end do
      from(1) = 1
      do p = 1, mesh%n_parts
         from(p + 1) = from(p) + n(p)
      end do
      allocate (members(from(mesh%n_parts + 1) - 1))
      n = from(:mesh%n_parts)
      do e = 1, mesh%n_elements
         if (place(e) == 0) cycle
         members(n(mesh%part(e))) = place(e)
         n(mesh%part(e)) = n(mesh%part(e)) + 1
      end do
      do p = 1, mesh%n_parts
         if (from(p + 1) == from(p)) cycle
         call grow_set(context%model%element_sets, part_name(mesh%parts(p)), members(from(p):from(p + 1) - 1))
         do g = 1, size(mesh%parts(p)%groups, kind=ip)
            call grow_set(context%model%element_sets, group_name(mesh, 2_ip, mesh%parts(p)%groups(g)), &
                          members(from(p):from(p + 1) - 1))
         end do
      end do
   end subroutine put_element_sets

end module atrito_build_gmsh_elements
