!> A mesh as a file of Gmsh has it: nodes, elements of dimension 0 to 2 on the entities of a drawing, and physical groups of these.
module atrito_gmsh_mesh
   use atrito_element_table, only: MOST_NODES
   use atrito_growth, only: make_room, resize
   use atrito_kinds, only: ip, wp
   use atrito_name_list, only: name_list_t, add_name, find_name
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: gmsh_mesh_t, gmsh_part_t, gmsh_name_t
   public :: add_part, find_part, add_element, trim_gmsh_mesh, move_mesh, group_name, part_name, note_key, key_of, keys_t

   !> An entity of the drawing with the physical groups to which it belongs.
   type :: gmsh_part_t
      integer(ip) :: dim = 0                       !< 0: a point, 1: a curve, 2: a surface
      integer(ip) :: tag = 0                       !< number of the entity in its dimension
      integer(ip), allocatable :: groups(:)        !< tags of physical groups, > 0
   end type gmsh_part_t

   !> The name of a physical group.
   type :: gmsh_name_t
      integer(ip) :: dim = 0, tag = 0       !< of the group
      character(len=:), allocatable :: name !< without blanks
   end type gmsh_name_t

   !> Where what has a key stands that is made of numbers: meshes have as many entities and groups as a drawing has.
   type :: keys_t
      type(name_list_t) :: keys                    !< as texts
      integer(ip), allocatable :: place(:)         !< of each key; the last one that was noted
   end type keys_t

   type :: gmsh_mesh_t
      character(len=:), allocatable :: file                   !< as the user wrote it
      integer(ip) :: card = 0                                 !< of the *INCLUDE that names it, place in the deck's cards
      integer(ip) :: n_nodes = 0, n_elements = 0, n_parts = 0 !< in use; the arrays may be longer
      integer(ip), allocatable :: node_id(:)                  !< (n_nodes) numbers in the file
      real(wp), allocatable :: x(:, :)                        !< (2, n_nodes) [L]
      integer(ip), allocatable :: element_id(:)               !< (n_elements) numbers in the file
      integer(ip), allocatable :: shape(:)                    !< how many nodes each element has
      integer(ip), allocatable :: part(:)                     !< of each element, place in parts
      integer(ip), allocatable :: nodes(:, :)                 !< (MOST_NODES, n_elements) numbers
      type(gmsh_part_t), allocatable :: parts(:)              !< the first n_parts are in use
      type(gmsh_name_t), allocatable :: names(:)              !< of groups that have one
      type(keys_t) :: part_keys, name_keys                    !< by dimension, tag and, where it matters, group
   end type gmsh_mesh_t

   !> Words of Gmsh's own Abaqus files for what has no name, by dimension.
   character(len=7), parameter :: ENTITY(0:2) = ['Point  ', 'Line   ', 'Surface']

contains

   !> Keeps an entity.
   subroutine add_part(mesh, dim, tag, groups)
      type(gmsh_mesh_t), intent(inout) :: mesh       !< gets an entity more
      integer(ip), intent(in) :: dim, tag, groups(:) !< as of gmsh_part_t
      type(gmsh_part_t), allocatable :: longer(:)

      if (.not. allocated(mesh%parts)) allocate (mesh%parts(16))
      if (mesh%n_parts == size(mesh%parts)) then
         allocate (longer(2*mesh%n_parts))
         longer(:mesh%n_parts) = mesh%parts
         call move_alloc(longer, mesh%parts)
      end if
      mesh%n_parts = mesh%n_parts + 1
      associate (part => mesh%parts(mesh%n_parts))
         part%dim = dim
         part%tag = tag
         allocate (part%groups, source=groups)     ! of length 0 as well: a constructor leaves it unallocated then
      end associate
      call note_key(mesh%part_keys, key_of(dim, tag), mesh%n_parts)
      call note_key(mesh%part_keys, key_of(dim, tag, sum(groups(:min(1, size(groups))))), mesh%n_parts)
   end subroutine add_part

   !> The place of an entity that was kept, with its first group where one is given; 0: none. Of several it is the last.
   pure integer(ip) function find_part(mesh, dim, tag, group) result(i)
      type(gmsh_mesh_t), intent(in) :: mesh        !< its entities are searched
      integer(ip), intent(in) :: dim, tag          !< as of gmsh_part_t
      integer(ip), intent(in), optional :: group   !< of none: 0

      i = place_of(mesh%part_keys, key_of(dim, tag, group))
   end function find_part

   !> By what a part or a name is found: its dimension and number, and its physical group.
   pure function key_of(dim, tag, group) result(key)
      integer(ip), intent(in) :: dim, tag        !< as of gmsh_part_t
      integer(ip), intent(in), optional :: group !< left out: a key without it
      character(len=:), allocatable :: key

      key = to_text(dim)//' '//to_text(tag)
      if (present(group)) key = key//' '//to_text(group)
   end function key_of

   !> Notes where in a list the thing with a key is; a later one takes the place of an earlier one.
   pure subroutine note_key(list, key, place)
      type(keys_t), intent(inout) :: list !< gets the key, or another place for it
      character(len=*), intent(in) :: key !< of key_of
      integer(ip), intent(in) :: place    !< where it is, > 0

      if (find_name(list%keys, key) == 0) call add_name(list%keys, key)
      call make_room(list%place, list%keys%n - 1, list%keys%n)
      list%place(find_name(list%keys, key)) = place
   end subroutine note_key

   pure integer(ip) function place_of(list, key) result(place)
      type(keys_t), intent(in) :: list
      character(len=*), intent(in) :: key

      place = find_name(list%keys, key)
      if (place > 0) place = list%place(place)
   end function place_of

   !> Keeps an element.
   subroutine add_element(mesh, id, part, nodes)
      type(gmsh_mesh_t), intent(inout) :: mesh      !< gets an element more; it has been trimmed before
      integer(ip), intent(in) :: id, part, nodes(:) !< number; place of its entity; numbers of its nodes
      integer(ip) :: e

      e = mesh%n_elements + 1
      if (e > size(mesh%element_id)) call resize_elements(mesh, 2*e)
      mesh%n_elements = e
      mesh%element_id(e) = id
      mesh%shape(e) = size(nodes, kind=ip)
      mesh%part(e) = part
      mesh%nodes(:size(nodes), e) = nodes
   end subroutine add_element

   subroutine resize_elements(mesh, length)
      type(gmsh_mesh_t), intent(inout) :: mesh
      integer(ip), intent(in) :: length

      call resize(mesh%element_id, mesh%n_elements, length)
      call resize(mesh%shape, mesh%n_elements, length)
      call resize(mesh%part, mesh%n_elements, length)
      call resize(mesh%nodes, mesh%n_elements, length)
   end subroutine resize_elements

   !> Makes room for so many elements: at the beginning, and at the end what is there.
   subroutine trim_gmsh_mesh(mesh, n_elements)
      type(gmsh_mesh_t), intent(inout) :: mesh !< lists of elements get this length
      integer(ip), intent(in) :: n_elements    !< >= those that there are

      if (.not. allocated(mesh%element_id)) allocate (mesh%element_id(0), mesh%shape(0), mesh%part(0), mesh%nodes(MOST_NODES, 0))
      call resize_elements(mesh, n_elements)
   end subroutine trim_gmsh_mesh

   !> Hands a mesh on without a copy.
   subroutine move_mesh(from, to)
      type(gmsh_mesh_t), intent(inout) :: from, to !< gives all; gets all

      call move_alloc(from%file, to%file)
      call move_alloc(from%node_id, to%node_id)
      call move_alloc(from%x, to%x)
      call move_alloc(from%element_id, to%element_id)
      call move_alloc(from%shape, to%shape)
      call move_alloc(from%part, to%part)
      call move_alloc(from%nodes, to%nodes)
      call move_alloc(from%parts, to%parts)
      call move_alloc(from%names, to%names)
      to%part_keys = from%part_keys
      to%name_keys = from%name_keys
      to%card = from%card
      to%n_nodes = from%n_nodes
      to%n_elements = from%n_elements
      to%n_parts = from%n_parts
   end subroutine move_mesh

   !> The name of a physical group as Gmsh's own Abaqus files have it: without blanks, and one for those that have none.
   pure function group_name(mesh, dim, tag) result(name)
      type(gmsh_mesh_t), intent(in) :: mesh !< its names are read
      integer(ip), intent(in) :: dim, tag   !< of the physical group
      character(len=:), allocatable :: name
      integer(ip) :: i

      i = place_of(mesh%name_keys, key_of(dim, tag))
      if (size(mesh%names) == 0) i = 0                 ! the second list was empty
      name = 'Physical'//trim(ENTITY(dim))//to_text(tag)
      if (i > 0) name = mesh%names(i)%name
   end function group_name

   !> The name of an entity.
   pure function part_name(part) result(name)
      type(gmsh_part_t), intent(in) :: part !< dimension and number are read
      character(len=:), allocatable :: name

      name = trim(ENTITY(part%dim))//to_text(part%tag)
   end function part_name

end module atrito_gmsh_mesh
