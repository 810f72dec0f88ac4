!> The elements of Gmsh's files: in blocks by entity (format 4.1), or each with its tags (2.2).
module atrito_gmsh_elements
   use atrito_element_table, only: MOST_NODES
   use atrito_gmsh_mesh, only: gmsh_mesh_t, add_part, find_part, add_element, trim_gmsh_mesh
   use atrito_gmsh_words, only: words_t, take_integer, end_line, fail, begin_line, check_count, check_number
   use atrito_kinds, only: ip
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_elements

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
            call read_element_block(words, mesh, n)
         else
            call read_old_element(words, old, mesh)
         end if
         if (.not. words%ok) return
      end do
      if (mesh%n_elements < n) call fail(words, 'there are '//to_text(mesh%n_elements)//' elements in the blocks', &
                                         to_text(n)//' of them')
   end subroutine read_elements

   !> Format 4.1: number, nodes.
   subroutine read_element_block(words, mesh, n)
      type(words_t), intent(inout) :: words
      type(gmsh_mesh_t), intent(inout) :: mesh
      integer(ip), intent(in) :: n                     !< elements in all
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
   subroutine read_old_element(words, old, mesh)
      type(words_t), intent(inout) :: words
      type(old_part_t), intent(inout) :: old
      type(gmsh_mesh_t), intent(inout) :: mesh
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

end module atrito_gmsh_elements
