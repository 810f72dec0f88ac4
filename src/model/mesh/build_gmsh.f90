!> *INCLUDE, TYPE=GMSH: nodes, elements, sets and curves of a mesh of Gmsh.
!>
!> Nodes and elements keep their numbers, unless one of them is taken: then all of the file follow the greatest by a power of ten.
!> Nodes that neither an element of the plane nor a physical point has are left out. The elements are made behind all nodes of the
!> deck.
module atrito_build_gmsh
   use atrito_build_context, only: build_context_t, note_places, note_undetermined_mesh, ids_text
   use atrito_build_nodes, only: put_node_set
   use atrito_build_parts, only: add_curve
   use atrito_diagnostics, only: report_error, report_note
   use atrito_element_table, only: CORNERS_OF, MOST_NODES
   use atrito_gmsh_mesh, only: gmsh_mesh_t, group_name, part_name
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_incidence, only: list_holders
   use atrito_items, only: has_option, option_word
   use atrito_kinds, only: ip, lp
   use atrito_mesh, only: add_element, add_node, find_node, reserve_mesh, turned_nodes, is_clockwise
   use atrito_model_memory, only: fits_memory
   use atrito_growth, only: number_list_t, add_number, numbers_of
   use atrito_plane_state, only: PLANE_STRAIN, PLANE_STRESS, AXISYMMETRIC
   use atrito_sets, only: grow_set
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_mesh_nodes, read_mesh_elements

contains

   !> The nodes of the mesh that a card names, its node sets, and the lines of its curves.
   subroutine read_mesh_nodes(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      type(build_context_t), intent(inout) :: context  !< its mesh gets nodes and sets; curves and mesh_shift
      integer(ip), allocatable :: node(:)              ! place in the mesh of each node of the file; 0: left out
      type(id_map_t) :: map                            ! from the file's numbers to the file's nodes
      integer(ip) :: i, k, shift, first
      logical :: ok, known

      i = mesh_of_card(i_card, context)
      if (i == 0) return
      associate (mesh => context%deck%meshes(i))
         call choose_nodes(mesh, context, map, node, ok)
         if (ok) ok = fits_memory(context%deck%cards(i_card)%place, context, int(mesh%n_nodes, lp), int(mesh%n_elements, lp))
         if (ok) call find_shift(mesh%node_id, context%model%mesh%node_map, context%nodes%greatest, 'node', mesh, context, &
                                 shift, ok)
         if (.not. ok) return
         context%mesh_shift(i) = shift
         first = context%model%mesh%n_nodes + 1
         call reserve_mesh(context%model%mesh, mesh%n_nodes, 0_ip)
         do k = 1, mesh%n_nodes
            if (node(k) == 0) cycle
            call add_node(context%model%mesh, mesh%node_id(k) + shift, mesh%x(:, k), known)
            node(k) = context%model%mesh%n_nodes
            context%nodes%greatest = max(context%nodes%greatest, mesh%node_id(k) + shift)
         end do
         call note_places(context%nodes%place, first, context%model%mesh%n_nodes, -i_card)
         if (any(node == 0)) call report_note(context%deck, context%deck%cards(i_card)%place, 'N-NODE', 'node '// &
                                              ids_text(pack(mesh%node_id(:mesh%n_nodes), node == 0))//' of '//mesh%file// &
                                              ' belongs to no element and is left out', &
                                              expected='a physical point, where such a node is meant')
         call put_sets(mesh, map, node, context)
      end associate
   end subroutine read_mesh_nodes

   !> Place in deck%meshes; 0: the card names none, or its mesh has been refused.
   pure integer(ip) function mesh_of_card(i_card, context) result(i)
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(in) :: context

      do i = size(context%deck%meshes, kind=ip), 1, -1
         if (context%deck%meshes(i)%card == i_card .and. context%deck%cards(i_card)%ok) return
      end do
   end function mesh_of_card

   !> Reports an error of an included mesh at its *INCLUDE. The mesh is undetermined then: what names its nodes is not reported.
   subroutine refuse(mesh, context, id, text, expected)
      type(gmsh_mesh_t), intent(in) :: mesh
      type(build_context_t), intent(inout) :: context
      character(len=*), intent(in) :: id, text, expected

      call report_error(context%deck, context%deck%cards(mesh%card)%place, id, text, expected=expected)
      call note_undetermined_mesh(context)
   end subroutine refuse

   !> Marks the nodes that elements of the plane and physical points have. The file's own numbers stand there once each.
   subroutine choose_nodes(mesh, context, map, node, ok)
      type(gmsh_mesh_t), intent(in) :: mesh
      type(build_context_t), intent(inout) :: context
      type(id_map_t), intent(out) :: map               !< from the file's numbers to the file's nodes
      integer(ip), allocatable, intent(out) :: node(:) !< 1: chosen; 0: not
      logical, intent(out) :: ok
      integer(ip) :: e, k, i
      logical :: chooses, known

      ok = .true.
      do i = 1, mesh%n_nodes
         call add_id(map, mesh%node_id(i), i, known)
         if (.not. known) cycle
         ok = .false.
         call refuse(mesh, context, 'E-TWICE', 'node '//to_text(mesh%node_id(i))//' stands twice in '//mesh%file, 'each node once')
         return
      end do
      allocate (node(mesh%n_nodes), source=0_ip)
      do e = 1, mesh%n_elements
         associate (part => mesh%parts(mesh%part(e)))
            chooses = part%dim == 2
            if (part%dim == 0) chooses = size(part%groups) > 0
         end associate
         do k = 1, mesh%shape(e)
            i = find_id(map, mesh%nodes(k, e))
            ok = i > 0
            if (.not. ok) then
               call refuse(mesh, context, 'E-NODE', 'element '//to_text(mesh%element_id(e))//' of '//mesh%file//' has node '// &
                           to_text(mesh%nodes(k, e))//', which is not there', 'nodes that stand in $Nodes')
               return
            end if
            if (chooses) node(i) = 1
         end do
      end do
      ok = any(mesh%parts(mesh%part)%dim == 2)
      if (.not. ok) call refuse(mesh, context, 'E-GMSH', mesh%file//' has no element of the plane', &
                                'triangles or quadrilaterals, of a physical surface or of a drawing without physical groups')
   end subroutine choose_nodes

   !> What is added to the numbers of a file, so that none is there already.
   subroutine find_shift(ids, taken, greatest, noun, mesh, context, shift, ok)
      integer(ip), intent(in) :: ids(:)
      type(id_map_t), intent(in) :: taken
      integer(ip), intent(in) :: greatest              !< number that is taken
      character(len=*), intent(in) :: noun             !< 'node' or 'element'
      type(gmsh_mesh_t), intent(in) :: mesh
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(out) :: shift
      logical, intent(out) :: ok
      integer(lp) :: power
      integer(ip) :: i

      shift = 0
      ok = .true.
      if (taken%n == 0) return
      do i = 1, size(ids, kind=ip)
         if (find_id(taken, ids(i)) > 0) exit
      end do
      if (i > size(ids)) return
      power = 1000_lp
      do while (power <= int(greatest, lp))
         power = 10_lp*power
      end do
      ok = power + int(maxval(ids), lp) <= int(huge(1_ip), lp)
      if (.not. ok) then
         call refuse(mesh, context, 'E-ID', 'the numbers of the '//noun//'s of '//mesh%file//' would be too large behind '// &
                     to_text(greatest), 'smaller '//noun//' numbers')
         return
      end if
      shift = int(power, ip)
      call report_note(context%deck, context%deck%cards(mesh%card)%place, 'N-NUMBERS', noun//' '//to_text(ids(i))//' of '// &
                       mesh%file//' is taken: '//to_text(shift)//' is added to all '//noun//' numbers of the file', keyword='')
   end subroutine find_shift

   !> Node sets of all entities and physical groups, and the lines of curves.
   subroutine put_sets(mesh, map, node, context)
      type(gmsh_mesh_t), intent(in) :: mesh
      type(id_map_t), intent(in) :: map                !< from the file's numbers to the file's nodes
      integer(ip), intent(in) :: node(:)               !< places of the file's nodes in the mesh
      type(build_context_t), intent(inout) :: context
      integer(ip), allocatable :: stamp(:)             ! of each node of the file the last part that took it
      integer(ip), allocatable :: first(:), list(:), members(:), ends(:, :)
      type(number_list_t) :: nodes                     ! of a part, each once
      integer(ip) :: own(MOST_NODES)                   ! the file's nodes of an element
      integer(ip) :: p, g, i, k, n_lines
      character(len=:), allocatable :: name

      call list_holders(mesh%n_parts, reshape(mesh%part, [1_ip, mesh%n_elements]), first, list)
      allocate (stamp(mesh%n_nodes), source=0_ip)
      do p = 1, mesh%n_parts
         if (first(p + 1) == first(p)) cycle
         nodes%n = 0
         n_lines = 0
         if (allocated(ends)) deallocate (ends)
         allocate (ends(2, first(p + 1) - first(p)))
         do i = first(p), first(p + 1) - 1
            do k = 1, mesh%shape(list(i))
               own(k) = find_id(map, mesh%nodes(k, list(i)))
               if (stamp(own(k)) == p .or. node(own(k)) == 0) cycle
               stamp(own(k)) = p
               call add_number(nodes, node(own(k)))
            end do
            if (mesh%parts(p)%dim /= 1) cycle
            if (any(node(own(:2)) == 0)) cycle
            n_lines = n_lines + 1
            ends(:, n_lines) = node(own(:2))
         end do
         members = numbers_of(nodes)
         do g = 0, merge(size(mesh%parts(p)%groups, kind=ip), -1_ip, nodes%n > 0)
            if (g == 0) then
               name = part_name(mesh%parts(p))
            else
               name = group_name(mesh, mesh%parts(p)%dim, mesh%parts(p)%groups(g))
            end if
            call put_node_set(context, mesh%card, name, members)
            if (mesh%parts(p)%dim == 1) call add_curve(context%curves, name, mesh%card, ends(:, :n_lines))
         end do
      end do
   end subroutine put_sets

   !> The elements of the mesh that a card names, and its element sets.
   subroutine read_mesh_elements(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      type(build_context_t), intent(inout) :: context  !< its mesh gets elements and sets
      integer(ip), allocatable :: first(:)             ! of each element of the file the first with its nodes; 0: not of the plane
      integer(ip), allocatable :: place(:)             ! of each element of the file in the mesh
      integer(ip), allocatable :: from(:), members(:), places(:)
      integer(ip) :: i, shift, p, g
      logical :: ok

      i = mesh_of_card(i_card, context)
      if (i == 0) return
      if (context%mesh_shift(i) < 0) return            ! its nodes were refused
      associate (mesh => context%deck%meshes(i))
         call find_plane_elements(mesh, first)
         call find_shift(pack(mesh%element_id, first > 0), context%model%mesh%element_map, &
                         context%elements%greatest, 'element', mesh, context, shift, ok)
         if (ok) call place_elements(mesh, [context%mesh_shift(i), shift], first, context, place, ok)
         if (.not. ok) return
         if (.not. has_option(context%deck, context%deck%cards(i_card), 'ELEMENTS')) then
            call report_note(context%deck, context%deck%cards(i_card)%place, 'N-GMSH', 'the elements of '//mesh%file// &
                             ' are taken as plane stress', expected='ELEMENTS=CPS, CPE (plane strain) or CAX (axisymmetric)')
         end if
         ! element sets of the surfaces of the drawing and their physical groups
         call list_holders(mesh%n_parts, reshape(merge(mesh%part, 0_ip, place > 0), [1_ip, mesh%n_elements]), from, members)
         do p = 1, mesh%n_parts
            if (from(p + 1) == from(p)) cycle
            places = place(members(from(p):from(p + 1) - 1))
            call grow_set(context%model%element_sets, part_name(mesh%parts(p)), places)
            do g = 1, size(mesh%parts(p)%groups, kind=ip)
               call grow_set(context%model%element_sets, group_name(mesh, 2_ip, mesh%parts(p)%groups(g)), places)
            end do
         end do
      end associate
   end subroutine read_mesh_elements

   !> Of each element of the file the first that has its nodes: itself, but for format 2.2, which has an element once for each of
   !> its groups. 0: it is a point or a line.
   subroutine find_plane_elements(mesh, first)
      type(gmsh_mesh_t), intent(in) :: mesh
      integer(ip), allocatable, intent(out) :: first(:)
      logical :: is_shared(mesh%n_parts)               ! the entity of the part is that of others, too
      type(id_map_t) :: seen                           ! entities
      type(id_map_t) :: last                           ! of each node the first element of which it is the least corner; then
      integer(ip) :: next(mesh%n_elements)             ! another one: such a list has few elements
      integer(ip) :: p, e, k, n, other
      logical :: known

      is_shared = .false.
      do p = 1, mesh%n_parts
         if (mesh%parts(p)%dim /= 2 .or. mesh%parts(p)%tag < 1) cycle
         call add_id(seen, mesh%parts(p)%tag, p, known)
         is_shared(p) = known
         if (known) is_shared(find_id(seen, mesh%parts(p)%tag)) = .true.
      end do
      first = [(merge(e, 0_ip, mesh%parts(mesh%part(e))%dim == 2), e=1, mesh%n_elements)]
      if (.not. any(is_shared)) return
      next = 0
      do e = 1, mesh%n_elements
         if (.not. is_shared(mesh%part(e))) cycle
         n = CORNERS_OF(mesh%shape(e))
         call add_id(last, minval(mesh%nodes(:n, e)), e, known)
         if (.not. known) cycle
         other = find_id(last, minval(mesh%nodes(:n, e)))
         do
            if (mesh%shape(other) == mesh%shape(e)) then
               if (all([(any(mesh%nodes(:n, other) == mesh%nodes(k, e)), k=1, n)])) first(e) = other
            end if
            if (first(e) == other .or. next(other) == 0) exit
            other = next(other)
         end do
         if (first(e) /= other) next(other) = e
      end do
   end subroutine find_plane_elements

   !> Adds the elements, counter-clockwise, in the plane state that ELEMENTS= of the card names.
   subroutine place_elements(mesh, shift, first, context, place, ok)
      type(gmsh_mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: shift(2)              !< of the numbers of nodes and elements
      integer(ip), intent(in) :: first(:)              !< as of find_plane_elements
      type(build_context_t), intent(inout) :: context
      integer(ip), allocatable, intent(out) :: place(:)
      logical, intent(out) :: ok
      integer(ip) :: e, k, before, state, nodes(MOST_NODES)
      logical :: known

      ok = .true.
      state = PLANE_STRESS
      if (option_word(context%deck, context%deck%cards(mesh%card), 'ELEMENTS') == 'CPE') state = PLANE_STRAIN
      if (option_word(context%deck, context%deck%cards(mesh%card), 'ELEMENTS') == 'CAX') state = AXISYMMETRIC
      before = context%model%mesh%n_elements
      allocate (place(mesh%n_elements), source=0_ip)
      call reserve_mesh(context%model%mesh, 0_ip, count(first > 0, kind=ip))
      do e = 1, mesh%n_elements
         if (first(e) == 0) cycle
         place(e) = place(first(e))
         if (first(e) < e) cycle
         associate (n => mesh%shape(e), id => mesh%element_id(e))
            do k = 1, n
               nodes(k) = find_node(context%model%mesh, mesh%nodes(k, e) + shift(1))
               ok = ok .and. all(nodes(:k - 1) /= nodes(k))
            end do
            if (.not. ok) then
               call refuse(mesh, context, 'E-SHAPE', 'element '//to_text(id)//' of '//mesh%file//' has a node twice', &
                           'different nodes')
               exit
            end if
            if (is_clockwise(context%model%mesh%x(:, nodes(:CORNERS_OF(n))))) nodes(:n) = turned_nodes(nodes(:n))
            call add_element(context%model%mesh, id + shift(2), state, nodes(:n), known)
            ok = .not. known
            context%elements%greatest = max(context%elements%greatest, id + shift(2))
            if (known) then
               call refuse(mesh, context, 'E-TWICE', 'element '//to_text(id)//' stands twice in '//mesh%file, 'each element once')
               exit
            end if
         end associate
         place(e) = context%model%mesh%n_elements
      end do
      call note_places(context%elements%place, before + 1, context%model%mesh%n_elements, -mesh%card)
   end subroutine place_elements

end module atrito_build_gmsh
