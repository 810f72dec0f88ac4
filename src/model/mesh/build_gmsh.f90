!> *INCLUDE, TYPE=GMSH: nodes, node sets and curves of a mesh of Gmsh; its elements are made by atrito_build_gmsh_elements.
!>
!> Nodes and elements keep their numbers, unless one of them is taken: then all of the file follow the greatest by a power of ten.
!> Nodes that neither an element of the plane nor a physical point has are left out.
module atrito_build_gmsh
   use atrito_build_context, only: build_context_t, note_places, note_undetermined_mesh, ids_text
   use atrito_build_nodes, only: put_node_set
   use atrito_curves, only: add_curve
   use atrito_diagnostics, only: report_error, report_note
   use atrito_gmsh_mesh, only: gmsh_mesh_t, group_name, part_name
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip, lp
   use atrito_mesh, only: add_node, reserve_mesh
   use atrito_model_memory, only: fits_memory
   use atrito_number_list, only: number_list_t, add_number, numbers_of
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_mesh_nodes, mesh_of_card, find_shift, refuse

   !> A file between the pass over nodes and that over elements.
   type :: work_t
      integer(ip) :: card = 0
      integer(ip), allocatable :: node(:)              !< place in the mesh of each node of the file; 0: left out
      type(id_map_t) :: map                            !< from the file's numbers to the file's nodes
      integer(ip), allocatable :: first(:), list(:)    !< elements of the file by their parts
   end type work_t

contains

   !> The nodes of the mesh that a card names, and its node sets.
   subroutine read_mesh_nodes(i_card, context)
      integer(ip), intent(in) :: i_card                !< place in deck%cards
      type(build_context_t), intent(inout) :: context
      type(work_t) :: work
      integer(ip) :: i, shift
      logical :: ok

      i = mesh_of_card(i_card, context)
      if (i == 0) return
      work%card = i_card
      associate (mesh => context%deck%meshes(i))
         call number_nodes(mesh, work, context, ok)
         if (ok) call choose_nodes(mesh, work, context, ok)
         if (ok) ok = fits_memory(context%deck%cards(i_card)%place, context, int(mesh%n_nodes, lp), int(mesh%n_elements, lp), &
                                  'INCLUDE')
         if (ok) call find_shift(mesh%node_id, context%model%mesh%node_map, context%nodes%greatest, 'node', i_card, context, &
                                 shift, ok)
         if (.not. ok) return
         context%mesh_shift(i) = shift
         call place_nodes(mesh, work, shift, context)
         call list_by_part(mesh, work)
         call put_sets(mesh, work, context)
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
   subroutine refuse(i_card, context, id, text, expected)
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(inout) :: context
      character(len=*), intent(in) :: id, text, expected

      call report_error(context%deck, context%deck%cards(i_card)%place, id, text, expected=expected, keyword='INCLUDE')
      call note_undetermined_mesh(context)
   end subroutine refuse

   !> The file's own numbers, each once.
   subroutine number_nodes(mesh, work, context, ok)
      type(gmsh_mesh_t), intent(in) :: mesh
      type(work_t), intent(inout) :: work
      type(build_context_t), intent(inout) :: context
      logical, intent(out) :: ok
      integer(ip) :: i
      logical :: known

      ok = .true.
      do i = 1, mesh%n_nodes
         call add_id(work%map, mesh%node_id(i), i, known)
         if (.not. known) cycle
         ok = .false.
         call refuse(work%card, context, 'E-TWICE', 'node '//to_text(mesh%node_id(i))//' stands twice in '//mesh%file, &
                     'each node once')
         return
      end do
   end subroutine number_nodes

   !> Marks the nodes that elements of the plane and physical points have.
   subroutine choose_nodes(mesh, work, context, ok)
      type(gmsh_mesh_t), intent(in) :: mesh
      type(work_t), intent(inout) :: work
      type(build_context_t), intent(inout) :: context
      logical, intent(out) :: ok
      integer(ip) :: e, k, i
      logical :: chooses, has_plane

      ok = .true.
      has_plane = .false.
      allocate (work%node(mesh%n_nodes), source=0_ip)
      do e = 1, mesh%n_elements
         associate (part => mesh%parts(mesh%part(e)))
            has_plane = has_plane .or. part%dim == 2
            chooses = part%dim == 2
            if (part%dim == 0) chooses = size(part%groups) > 0
         end associate
         do k = 1, mesh%shape(e)
            i = find_id(work%map, mesh%nodes(k, e))
            ok = i > 0
            if (.not. ok) exit
            if (chooses) work%node(i) = 1
         end do
         if (.not. ok) exit
      end do
      if (.not. ok) then
         call refuse(work%card, context, 'E-NODE', 'element '//to_text(mesh%element_id(e))//' of '//mesh%file//' has node '// &
                     to_text(mesh%nodes(k, e))//', which is not there', 'nodes that stand in $Nodes')
      else if (.not. has_plane) then
         ok = .false.
         call refuse(work%card, context, 'E-GMSH', mesh%file//' has no element of the plane', &
                     'triangles or quadrilaterals, of a physical surface or of a drawing without physical groups')
      end if
   end subroutine choose_nodes

   !> Adds the chosen nodes to the mesh.
   subroutine place_nodes(mesh, work, shift, context)
      type(gmsh_mesh_t), intent(in) :: mesh
      type(work_t), intent(inout) :: work
      integer(ip), intent(in) :: shift                 !< of the numbers
      type(build_context_t), intent(inout) :: context
      type(number_list_t) :: left_out
      integer(ip) :: i, before
      logical :: known

      before = context%model%mesh%n_nodes
      call reserve_mesh(context%model%mesh, mesh%n_nodes, 0_ip)
      do i = 1, mesh%n_nodes
         if (work%node(i) == 0) then
            call add_number(left_out, mesh%node_id(i))
            cycle
         end if
         call add_node(context%model%mesh, mesh%node_id(i) + shift, mesh%x(:, i), known)
         work%node(i) = context%model%mesh%n_nodes
         context%nodes%greatest = max(context%nodes%greatest, mesh%node_id(i) + shift)
      end do
      call note_places(context%nodes%place, before + 1, context%model%mesh%n_nodes, -work%card)
      if (left_out%n > 0) then
         call report_note(context%deck, context%deck%cards(work%card)%place, 'N-NODE', 'node '//ids_text(numbers_of(left_out))// &
                          ' of '//mesh%file//' belongs to no element and is left out', &
                          expected='a physical point, where such a node is meant', keyword='INCLUDE')
      end if
   end subroutine place_nodes

   !> What is added to the numbers of a file, so that none is there already.
   subroutine find_shift(ids, taken, greatest, noun, i_card, context, shift, ok)
      integer(ip), intent(in) :: ids(:)
      type(id_map_t), intent(in) :: taken
      integer(ip), intent(in) :: greatest              !< number that is taken
      character(len=*), intent(in) :: noun
      integer(ip), intent(in) :: i_card
      type(build_context_t), intent(inout) :: context
      integer(ip), intent(out) :: shift
      logical, intent(out) :: ok
      character(len=:), allocatable :: file
      integer(lp) :: power
      integer(ip) :: i

      shift = 0
      ok = .true.
      if (taken%n == 0) return
      do i = 1, size(ids, kind=ip)
         if (find_id(taken, ids(i)) > 0) exit
      end do
      if (i > size(ids)) return
      file = context%deck%meshes(mesh_of_card(i_card, context))%file
      power = 1000_lp
      do while (power <= int(greatest, lp))
         power = 10_lp*power
      end do
      ok = power + int(maxval(ids), lp) <= int(huge(1_ip), lp)
      if (.not. ok) then
         call refuse(i_card, context, 'E-ID', 'the numbers of the '//noun//'s of '//file//' would be too large behind '// &
                     to_text(greatest), 'smaller '//noun//' numbers')
         return
      end if
      shift = int(power, ip)
      call report_note(context%deck, context%deck%cards(i_card)%place, 'N-NUMBERS', noun//' '//to_text(ids(i))//' of '// &
                       file//' is taken: '//to_text(shift)//' is added to all '//noun//' numbers of the file')
   end subroutine find_shift

   !> The elements of each part, in their order.
   pure subroutine list_by_part(mesh, work)
      type(gmsh_mesh_t), intent(in) :: mesh
      type(work_t), intent(inout) :: work
      integer(ip) :: e, p
      integer(ip), allocatable :: next(:)

      allocate (work%first(mesh%n_parts + 1), work%list(mesh%n_elements))
      work%first = 0
      do e = 1, mesh%n_elements
         work%first(mesh%part(e) + 1) = work%first(mesh%part(e) + 1) + 1
      end do
      work%first(1) = 1
      do p = 1, mesh%n_parts
         work%first(p + 1) = work%first(p + 1) + work%first(p)
      end do
      next = work%first(:mesh%n_parts)
      do e = 1, mesh%n_elements
         p = mesh%part(e)
         work%list(next(p)) = e
         next(p) = next(p) + 1
      end do
   end subroutine list_by_part

   !> Node sets of all entities and physical groups, and the lines of curves.
   subroutine put_sets(mesh, work, context)
      type(gmsh_mesh_t), intent(in) :: mesh
      type(work_t), intent(in) :: work
      type(build_context_t), intent(inout) :: context
      integer(ip), allocatable :: stamp(:), nodes(:), ends(:, :)
      integer(ip) :: p, g
      character(len=:), allocatable :: name

      allocate (stamp(mesh%n_nodes), source=0_ip)
      do p = 1, mesh%n_parts
         if (work%first(p + 1) == work%first(p)) cycle
         call take_part(mesh, work, p, stamp, nodes, ends)
         if (size(nodes) == 0) cycle
         do g = 0, size(mesh%parts(p)%groups, kind=ip)
            if (g == 0) then
               name = part_name(mesh%parts(p))
            else
               name = group_name(mesh, mesh%parts(p)%dim, mesh%parts(p)%groups(g))
            end if
            call put_node_set(context, work%card, name, nodes)
            if (mesh%parts(p)%dim == 1) call add_curve(context%curves, name, work%card, ends)
         end do
      end do
   end subroutine put_sets

   !> The nodes of a part, each once, and the ends of its lines; places in the mesh.
   subroutine take_part(mesh, work, p, stamp, nodes, ends)
      type(gmsh_mesh_t), intent(in) :: mesh
      type(work_t), intent(in) :: work
      integer(ip), intent(in) :: p
      integer(ip), intent(inout) :: stamp(:)           !< of each node of the file the last part that took it
      integer(ip), allocatable, intent(out) :: nodes(:), ends(:, :)
      integer(ip) :: i, k, e, node, n, n_lines

      associate (list => work%list(work%first(p):work%first(p + 1) - 1))
         allocate (nodes(sum(mesh%shape(list))), ends(2, size(list)))
         n = 0
         n_lines = 0
         do i = 1, size(list, kind=ip)
            e = list(i)
            do k = 1, mesh%shape(e)
               node = find_id(work%map, mesh%nodes(k, e))
               if (stamp(node) == p .or. work%node(node) == 0) cycle
               stamp(node) = p
               n = n + 1
               nodes(n) = work%node(node)
            end do
            if (mesh%parts(p)%dim /= 1) cycle
            n_lines = n_lines + 1
            ends(:, n_lines) = work%node([find_id(work%map, mesh%nodes(1, e)), find_id(work%map, mesh%nodes(2, e))])
            if (any(ends(:, n_lines) == 0)) n_lines = n_lines - 1
         end do
      end associate
      nodes = nodes(:n)
      ends = ends(:, :n_lines)
   end subroutine take_part

end module atrito_build_gmsh
