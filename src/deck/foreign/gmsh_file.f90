!> Files of Gmsh, format 4.1 and 2.2, as text: elements in blocks by entity (4.1), or each with its tags (2.2).
!>
!> A line is what the format says of it: what is missing or too much is reported where it is, and never taken from the next line.
module atrito_gmsh_file
   use atrito_element_table, only: MOST_NODES
   use atrito_gmsh_mesh, only: gmsh_mesh_t, add_part, trim_gmsh_mesh, note_key, key_of, keys_t, find_part, add_element, words_t, &
       fault_t, next_line, take_word, take_integer, take_real, end_line, fail, word_is, go_on, begin_line, read_head, check_count, &
                               check_number
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_gmsh_text

   !> z may be off the plane by this part of the greatest coordinate: the kernels of drawings round.
   real(wp), parameter :: FLAT = 1e-10_wp

   !> The file between two lines.
   type :: reading_t
      type(words_t) :: words                                 !< the text, and the place in it
      logical :: is_new = .true.                             !< format 4.1, else 2.2
      logical :: has_nodes = .false., has_elements = .false. !< these sections have been read
      type(fault_t) :: off_plane                             !< where |z| is greatest
      real(wp) :: most_z = 0.0_wp                            !< greatest |z| of a node so far [L]
   end type reading_t

   !> Gmsh's types of elements that there are in the plane, up to the second degree: their dimension and nodes; -1: none.
   integer(ip), parameter :: LAST_TYPE = 16
   integer(ip), parameter :: DIM_OF_TYPE(LAST_TYPE) = [integer(ip) :: 1, 2, 2, -1, -1, -1, -1, 1, 2, 2, -1, -1, -1, -1, 0, 2]
   integer(ip), parameter :: NODES_OF_TYPE(LAST_TYPE) = [integer(ip) :: 2, 3, 4, 0, 0, 0, 0, 3, 6, 9, 0, 0, 0, 0, 1, 8]
   !> Gmsh's types of the first and second degree that fill space.
   integer(ip), parameter :: SOLID_TYPES(10) = [integer(ip) :: 4, 5, 6, 7, 11, 12, 13, 14, 17, 18]

   !> Where the last element of format 2.2 belongs.
   type :: old_part_t
      integer(ip) :: key(3) = -1                       !< dimension, entity, group
      integer(ip) :: part = 0                          !< of this key, place in parts; 0: none yet
   end type old_part_t

contains

   !> Reads the text of a file. fault%text is not allocated when all is well.
   subroutine read_gmsh_text(text, mesh, fault)
      character(len=*), intent(in), target :: text !< the file
      type(gmsh_mesh_t), intent(inout) :: mesh     !< gets nodes, elements, entities and names
      type(fault_t), intent(out) :: fault          !< the first one; text not allocated: none
      type(reading_t) :: reading
      logical :: found

      reading%words%text => text
      call trim_gmsh_mesh(mesh, 0_ip)
      allocate (mesh%node_id(0), mesh%x(2, 0), mesh%names(0))
      call next_line(reading%words, found)
      if (found) found = word_is(reading%words, '$MeshFormat')
      if (found) then
         call read_format(reading)
      else
         call fail(reading%words, 'this is no mesh of Gmsh', 'a file that begins with $MeshFormat: gmsh -2 drawing.geo')
      end if
      do while (reading%words%ok)
         call next_line(reading%words, found)
         if (.not. found) exit
         call read_section(reading, mesh)
      end do
      if (reading%words%ok .and. .not. (reading%has_nodes .and. reading%has_elements)) then
         call fail(reading%words, 'the file has no '//trim(merge('$Elements', '$Nodes   ', reading%has_nodes)), &
                   'a mesh: gmsh -2 drawing.geo')
      end if
      if (.not. reading%words%ok) fault = reading%words%fault
      call trim_gmsh_mesh(mesh, mesh%n_elements)
   end subroutine read_gmsh_text

   subroutine read_section(reading, mesh)
      type(reading_t), intent(inout) :: reading
      type(gmsh_mesh_t), intent(inout) :: mesh
      character(len=:), allocatable :: name

      name = reading%words%text(reading%words%first:reading%words%last)
      select case (name)
      case ('$PhysicalNames')
         call read_names(reading%words, mesh)
      case ('$Entities')
         call read_entities(reading%words, mesh)
      case ('$Nodes')
         if (reading%has_nodes) call fail(reading%words, 'a second $Nodes', 'one mesh a file')
         reading%has_nodes = .true.
         call read_nodes(reading, mesh)
      case ('$Elements')
         if (reading%has_elements) call fail(reading%words, 'a second $Elements', 'one mesh a file')
         reading%has_elements = .true.
         call read_elements(reading%is_new, reading%words, mesh)
      case ('$PartitionedEntities')
         call fail(reading%words, 'a partitioned mesh', 'a mesh that is saved whole: Mesh.PartitionCount = 0')
      case default
         call skip_section(reading%words, name)
         return
      end select
      call end_section(reading%words, '$End'//name(2:))
   end subroutine read_section

   subroutine end_section(words, name)
      character(len=*), intent(in) :: name
      type(words_t), intent(inout) :: words

      if (.not. words%ok) return
      call go_on(words, name)
      if (words%ok .and. .not. word_is(words, name)) call fail(words, 'this does not end the section', name)
   end subroutine end_section

   !> Passes over what says nothing of a mesh.
   subroutine skip_section(words, name)
      character(len=*), intent(in) :: name
      type(words_t), intent(inout) :: words
      type(words_t) :: begin
      logical :: found

      if (name(1:1) /= '$') then
         call fail(words, 'a line outside of any section', '$Nodes, $Elements, $PhysicalNames or another section')
         return
      end if
      begin = words
      found = .true.
      do while (found)
         call next_line(words, found)
         if (found .and. word_is(words, '$End'//name(2:))) return
      end do
      words = begin
      call fail(words, 'the section has no end', '$End'//name(2:))
   end subroutine skip_section

   subroutine read_format(reading)
      type(reading_t), intent(inout) :: reading
      integer(ip) :: kind

      call go_on(reading%words, '4.1 0 8')
      if (.not. reading%words%ok) return
      if (word_is(reading%words, '4.1')) then
         reading%is_new = .true.
      else if (word_is(reading%words, '2.2')) then
         reading%is_new = .false.
      else
         call fail(reading%words, 'this format of Gmsh is not read', &
                   'format 4.1 or 2.2: gmsh old.msh -save -format msh41 -o new.msh')
         return
      end if
      call take_integer(reading%words, 'kind of file', kind)
      if (reading%words%ok .and. kind /= 0) then
         call fail(reading%words, 'the file is binary', '0, a text file: gmsh -2 without -bin, Mesh.Binary = 0')
      end if
      call end_section(reading%words, '$EndMeshFormat')
   end subroutine read_format

   !> dimension, tag, "name"
   subroutine read_names(words, mesh)
      type(words_t), intent(inout) :: words
      type(gmsh_mesh_t), intent(inout) :: mesh
      integer(ip) :: i, n

      call begin_line(words, 'number of physical names', n)
      call check_count(words, n, 6_ip)
      if (.not. words%ok) return
      deallocate (mesh%names)
      allocate (mesh%names(n))
      do i = 1, n
         call begin_line(words, 'dimension of the group', mesh%names(i)%dim)
         call take_integer(words, 'tag of the group', mesh%names(i)%tag)
         call take_name(words, mesh%names(i)%name)
         if (.not. words%ok) return
         if (i == 1) mesh%name_keys = keys_t()   ! a second list of names takes the place of the first
         call note_key(mesh%name_keys, key_of(mesh%names(i)%dim, mesh%names(i)%tag), i)
      end do
   end subroutine read_names

   !> A name in quotes; blanks and commas become _, as in Gmsh's own Abaqus files.
   subroutine take_name(words, name)
      type(words_t), intent(inout) :: words
      character(len=:), allocatable, intent(out) :: name
      integer(ip) :: length, i
      logical :: is_name

      name = ''
      if (.not. words%ok) return
      call take_word(words)
      length = scan(words%text(words%first:), achar(10)//achar(13)) - 1
      if (length < 0) length = len(words%text) - words%first + 1
      length = scan(words%text(words%first:words%first + length - 1), '"', back=.true.)
      words%last = words%first + length - 1
      is_name = length >= 3
      if (is_name) is_name = words%text(words%first:words%first) == '"'
      if (.not. is_name) then
         call fail(words, 'this is not a name', 'the name of the group in "quotes"')
         return
      end if
      words%position = words%last + 1
      name = words%text(words%first + 1:words%last - 1)
      do i = 1, len(name)
         if (scan(name(i:i), ' ,"') > 0 .or. iachar(name(i:i)) < iachar(' ')) name(i:i) = '_'
      end do
   end subroutine take_name

   !> Points: tag, x, y, z, groups; curves and surfaces: tag, a box of six numbers, groups, what bounds them.
   subroutine read_entities(words, mesh)
      type(words_t), intent(inout) :: words
      type(gmsh_mesh_t), intent(inout) :: mesh
      integer(ip) :: n(0:3), dim, i

      call begin_line(words, 'number of points', n(0))
      call take_integer(words, 'number of curves', n(1))
      call take_integer(words, 'number of surfaces', n(2))
      call take_integer(words, 'number of volumes', n(3))
      do dim = 0, 3
         call check_count(words, n(dim), 8_ip)
         if (.not. words%ok) return
         do i = 1, n(dim)
            call read_entity(words, dim, mesh)
            if (.not. words%ok) return
         end do
      end do
   end subroutine read_entities

   subroutine read_entity(words, dim, mesh)
      type(words_t), intent(inout) :: words
      integer(ip), intent(in) :: dim
      type(gmsh_mesh_t), intent(inout) :: mesh
      integer(ip), allocatable :: groups(:)
      integer(ip) :: tag, i, n

      call begin_line(words, 'tag of the entity', tag)
      do i = 1, merge(3, 6, dim == 0)
         call take_word(words)
      end do
      call take_integer(words, 'number of physical groups', n)
      call check_count(words, n, 2_ip)
      if (.not. words%ok) return
      allocate (groups(n))
      do i = 1, n
         call take_integer(words, 'tag of a physical group', groups(i))
      end do
      if (words%ok .and. dim < 3) call add_part(mesh, dim, tag, abs(groups))
   end subroutine read_entity

   subroutine read_nodes(reading, mesh)
      type(reading_t), intent(inout) :: reading
      type(gmsh_mesh_t), intent(inout) :: mesh
      integer(ip) :: n_blocks, n, i

      n_blocks = 0
      if (reading%is_new) then
         call begin_line(reading%words, 'number of blocks', n_blocks)
         call take_integer(reading%words, 'number of nodes', n)
      else
         call begin_line(reading%words, 'number of nodes', n)
      end if
      call check_count(reading%words, n, 6_ip)
      if (.not. reading%words%ok) return
      deallocate (mesh%node_id, mesh%x)
      allocate (mesh%node_id(n), mesh%x(2, n))
      do i = 1, n_blocks
         call read_node_block()
         if (.not. reading%words%ok) return
      end do
      if (.not. reading%is_new) call read_node_lines()
      if (.not. reading%words%ok) return
      if (mesh%n_nodes < n) call fail(reading%words, 'there are '//to_text(mesh%n_nodes)//' nodes in the blocks', &
                                      to_text(n)//' of them')
      call check_plane()

   contains

      !> Format 4.1: numbers, then coordinates.
      subroutine read_node_block()
         integer(ip) :: head(4), i, n

         call read_head(reading%words, 'number of nodes', head)
         n = mesh%n_nodes
         if (reading%words%ok .and. (head(4) < 0 .or. head(4) > size(mesh%node_id) - n)) then
            call fail(reading%words, 'more nodes in the blocks than in all', to_text(size(mesh%node_id, kind=ip))//' in all')
         end if
         if (.not. reading%words%ok) return
         do i = n + 1, n + head(4)
            call begin_line(reading%words, 'node number', mesh%node_id(i))
            call check_number(reading%words, mesh%node_id(i))
            if (.not. reading%words%ok) return
         end do
         do i = n + 1, n + head(4)
            call go_on(reading%words, 'x, y and z of a node')
            reading%words%position = reading%words%first
            call take_place(reading, mesh%x(:, i))
            if (.not. reading%words%ok) return
         end do
         mesh%n_nodes = n + head(4)
      end subroutine read_node_block

      !> Format 2.2: number, x, y, z.
      subroutine read_node_lines()
         integer(ip) :: i

         do i = 1, size(mesh%node_id, kind=ip)
            call begin_line(reading%words, 'node number', mesh%node_id(i))
            call check_number(reading%words, mesh%node_id(i))
            call take_place(reading, mesh%x(:, i))
            call end_line(reading%words, 'number, x, y, z')
            if (.not. reading%words%ok) return
         end do
         mesh%n_nodes = size(mesh%node_id, kind=ip)
      end subroutine read_node_lines

      subroutine check_plane()

         if (mesh%n_nodes == 0 .or. .not. reading%words%ok) return
         if (reading%most_z <= FLAT*maxval(abs(mesh%x))) return
         call fail(reading%words, 'the scene is plane: z is not 0', 'a mesh in the plane of x and y, z = 0 [L]')
         reading%off_plane%text = reading%words%fault%text
         reading%off_plane%expected = reading%words%fault%expected
         reading%words%fault = reading%off_plane
      end subroutine check_plane
   end subroutine read_nodes

   !> x, y, z; where z is greatest is kept.
   subroutine take_place(reading, x)
      type(reading_t), intent(inout) :: reading
      real(wp), intent(out) :: x(2)
      real(wp) :: z

      call take_real(reading%words, 'x [L]', x(1))
      call take_real(reading%words, 'y [L]', x(2))
      call take_real(reading%words, 'z [L]', z)
      if (.not. abs(z) > reading%most_z) return
      reading%most_z = abs(z)
      associate (words => reading%words)
         reading%off_plane%line = words%line
         reading%off_plane%column = words%first - words%start + 1
         reading%off_plane%first = words%first
         reading%off_plane%last = words%last
      end associate
   end subroutine take_place

   !> The section $Elements, behind its first line.
   subroutine read_elements(is_new, words, mesh)
      logical, intent(in) :: is_new                    !< format 4.1, else 2.2
      type(words_t), intent(inout) :: words            !< behind the line $Elements; then behind the last element
      type(gmsh_mesh_t), intent(inout) :: mesh         !< with its entities; gets the elements
      type(old_part_t) :: old
      integer(ip) :: n_blocks, n, i

      if (is_new) then
         call begin_line(words, 'number of blocks', n_blocks)
         call take_integer(words, 'number of elements', n)
      else
         call begin_line(words, 'number of elements', n)
         n_blocks = n                                  ! each line a block of one
      end if
      call check_count(words, n, 4_ip)
      call check_count(words, n_blocks, 4_ip)
      if (.not. words%ok) return
      call trim_gmsh_mesh(mesh, n)
      do i = 1, n_blocks
         if (is_new) then
            call read_element_block()
         else
            call read_old_element()
         end if
         if (.not. words%ok) return
      end do
      if (mesh%n_elements < n) call fail(words, 'there are '//to_text(mesh%n_elements)//' elements in the blocks', &
                                         to_text(n)//' of them')

   contains

      !> Format 4.1: number, nodes.
      subroutine read_element_block()
         integer(ip) :: head(4), i, id, part

         call begin_line(words, 'dimension of the entity', head(1))
         call take_integer(words, 'tag of the entity', head(2))
         call take_integer(words, 'type of the elements', head(3))
         call check_type(words, head(3))
         call take_integer(words, 'number of elements', head(4))
         if (words%ok .and. (head(4) < 0 .or. head(4) > n - mesh%n_elements)) then
            call fail(words, 'more elements in the blocks than in all', to_text(n)//' in all')
         end if
         call end_line(words, 'four integers')
         if (.not. words%ok) return
         part = find_part(mesh, DIM_OF_TYPE(head(3)), head(2))
         if (part == 0) then
            call add_part(mesh, DIM_OF_TYPE(head(3)), head(2), [integer(ip) ::])
            part = mesh%n_parts
         end if
         do i = 1, head(4)
            call begin_line(words, 'element number', id)
            call check_number(words, id)
            call take_nodes(words, mesh, id, part, NODES_OF_TYPE(head(3)))
            if (.not. words%ok) return
         end do
      end subroutine read_element_block

      !> Format 2.2: number, type, how many tags, physical group, entity, further tags, nodes.
      subroutine read_old_element()
         integer(ip) :: id, kind, n_tags, tags(2), i, other

         call begin_line(words, 'element number', id)
         call check_number(words, id)
         call take_integer(words, 'type of the element', kind)
         call check_type(words, kind)
         call take_integer(words, 'number of tags', n_tags)
         call check_count(words, n_tags, 2_ip)
         tags = 0
         do i = 1, n_tags
            call take_integer(words, 'a tag', other)
            if (i <= 2) tags(i) = other
            if (.not. words%ok) return
         end do
         if (.not. words%ok) return
         call find_old_part(old, mesh, [DIM_OF_TYPE(kind), tags(2), abs(tags(1))])
         call take_nodes(words, mesh, id, old%part, NODES_OF_TYPE(kind))
      end subroutine read_old_element
   end subroutine read_elements

   !> Format 2.2 knows no entities but by their elements: one of each group.
   subroutine find_old_part(old, mesh, key)
      type(old_part_t), intent(inout) :: old
      type(gmsh_mesh_t), intent(inout) :: mesh
      integer(ip), intent(in) :: key(3)                !< dimension, entity, group

      if (all(key == old%key)) return
      old%key = key
      old%part = find_part(mesh, key(1), key(2), key(3))
      if (old%part > 0) return
      call add_part(mesh, key(1), key(2), pack(key(3:3), key(3:3) > 0))
      old%part = mesh%n_parts
   end subroutine find_old_part

   subroutine take_nodes(words, mesh, id, part, n)
      type(words_t), intent(inout) :: words
      type(gmsh_mesh_t), intent(inout) :: mesh
      integer(ip), intent(in) :: id, part, n
      integer(ip) :: nodes(MOST_NODES), i

      do i = 1, n
         call take_integer(words, 'node number', nodes(i))
         call check_number(words, nodes(i))
      end do
      call end_line(words, to_text(n)//' nodes')
      if (words%ok) call add_element(mesh, id, part, nodes(:n))
   end subroutine take_nodes

   !> The type of an element is one that the plane has.
   subroutine check_type(words, kind)
      type(words_t), intent(inout) :: words
      integer(ip), intent(in) :: kind
      logical :: known

      if (.not. words%ok) return
      known = kind >= 1 .and. kind <= LAST_TYPE
      if (known) known = DIM_OF_TYPE(kind) >= 0
      if (known) return
      if (any(SOLID_TYPES == kind)) then
         call fail(words, 'elements of type '//to_text(kind)//' fill space: the scene is plane', &
                   'points, lines, triangles and quadrilaterals: gmsh -2')
      else
         call fail(words, 'elements of type '//to_text(kind)//' are not known here', &
                   'points, lines, triangles and quadrilaterals of the first or second degree: Mesh.ElementOrder = 1 or 2')
      end if
   end subroutine check_type

end module atrito_gmsh_file
