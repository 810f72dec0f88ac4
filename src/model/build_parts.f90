!> What a build context is made of: blocks, sections, what is known of nodes and elements by their numbers, the step that is built.
!>
!> Lines between nodes that carry a name, as meshes of Gmsh have them, and the faces of elements that lie on them.
module atrito_build_parts
   use atrito_block_map, only: block_map_t
   use atrito_deck, only: token_t
   use atrito_faces, only: face_list_t, node_elements_t, add_face, is_outer_face
   use atrito_growth, only: resize
   use atrito_id_map, only: id_map_t
   use atrito_kinds, only: ip, lp, wp
   use atrito_load_lists, only: condition_list_t
   use atrito_mesh, only: mesh_t, face_nodes, side_between, side_count, face_end, middle_node
   use atrito_name_list, only: name_list_t, add_name, find_name
   use atrito_sets, only: BLOCK_SIDES, set_list_t
   implicit none (type, external)
   private
   public :: drawn_lines_t, open_step_t, inherited_t, replaced_t, numbered_t, block_t, section_cut_t, node_finder_t, BLOCK_SIDES, &
             LOOSE_HELD, LOOSE_RELEASED, LOOSE_MOVES, curve_list_t, line_list_t, add_curve, find_curve_faces, find_node_faces, &
             nodes_of_no_face

   !> A *BLOCK between the pass that makes its nodes and the one that makes its elements.
   type :: block_t
      character(len=:), allocatable :: name            !< NAME= of the card, or that of a copy
      integer(ip) :: card = 0                          !< place in deck%cards
      integer(ip) :: state = 0                         !< place in STATES
      integer(ip) :: shape = 0                         !< place in SHAPES
      integer(ip) :: order = 1                         !< node intervals along an edge of an element
      integer(ip), allocatable :: nodes(:, :)          !< (0:order*nx, 0:order*ny), places; 0: none
      integer(ip) :: first_element = 0                 !< place; row by row from BOTTOM
      integer(ip) :: n_elements = 0                    !< quadrilaterals, or triangles, of it
      integer(ip) :: joined_to = 0                     !< a block that MERGE joins it with; 0: none
      real(wp) :: low(2) = 0.0_wp, high(2) = 0.0_wp    !< the box round its nodes [L]
      character(len=:), allocatable :: array           !< name of the copies of which it is one; not allocated: it is none
      logical :: at_side(4) = .false.                  !< it stands at this side of all copies, as in BLOCK_SIDES
      type(block_map_t) :: map                         !< of its unit square
      real(wp), allocatable :: along(:), across(:)     !< places of its nodes in the unit square, (0:order*nx), (0:order*ny)
   end type block_t

   !> A *PRE-TENSION SECTION: the nodes on the side of its surface's elements, and those on the other that stand there, too.
   type :: section_cut_t
      integer(ip) :: body = 0                          !< its node, place in the model's rigid bodies
      integer(ip), allocatable :: own(:), other(:)     !< (n) places of nodes: own(i) stands where other(i) stands
      real(wp) :: normal(2) = 0.0_wp                   !< unit vector across it
      real(wp) :: size = 0.0_wp                        !< [L] across the nodes
   end type section_cut_t

   !> What is known of the nodes or the elements by their numbers.
   type :: numbered_t
      type(id_map_t) :: invalid                        !< numbers whose definition is faulty
      integer(ip) :: greatest = 0                      !< number
      integer(ip), allocatable :: place(:)             !< of each, by its place in the mesh; > 0: token; < 0: card
   end type numbered_t

   !> Nodes of elements in the order of their x.
   type :: node_finder_t
      integer(ip), allocatable :: node(:)              !< places; not allocated: not asked for yet
      integer(lp), allocatable :: key(:)               !< of x
      real(wp), allocatable :: longest(:)              !< side of the elements round each [L]
      real(wp) :: reach = 0.0_wp                       !< half of the longest of all [L]
   end type node_finder_t

   !> The loads that a step inherits, in lists by the dof or the element on which they act.
   type :: inherited_t
      integer(ip) :: n = 0                             !< the first of the step's loads
      integer(ip), allocatable :: head(:)              !< of each dof or element the first of these; 0: none
      integer(ip), allocatable :: next(:)              !< (n)
   end type inherited_t

   !> Lines of earlier steps whose loads end, and the lines that take their place.
   type :: replaced_t
      integer(ip) :: n = 0                             !< pairs of lines in use
      integer(ip), allocatable :: lines(:, :)          !< (2, n) both lines; those up to n are in use
      integer(ip) :: by = 0                            !< the line that took the last place
      type(id_map_t) :: before                         !< the lines whose loads it has ended so far
   end type replaced_t

   !> The lines of *SECTION PRINT, or of *PATH PRINT, that were read so far.
   type :: drawn_lines_t
      character(len=4) :: what = ''                    !< cut, path
      integer(ip) :: n = 0                             !< of the model
      integer(ip) :: n_before = 0                      !< of them, those of earlier steps
      type(name_list_t) :: names                       !< of those of the step that is being built
      type(token_t), allocatable :: items(:)           !< of each of the model its first item
   end type drawn_lines_t

   !> The step that is being built.
   type :: open_step_t
      integer(ip) :: number = 1                        !< in the order of the deck, from 1
      integer(ip) :: first_card = 1, last_card = 0     !< of the deck: its cards are among these (is_of_step)
      integer(ip) :: first_token = 0                   !< of its lines: what stands before it is inherited
      integer(ip) :: line = 0                          !< of the deck, that is being read
      integer(ip) :: amplitude = 0                     !< that the card being read names
      integer(ip) :: source = 0                        !< of the line being read, place in the model's sources
      type(condition_list_t) :: supports, forces       !< at nodes, along the dofs of the deck, which may be local axes
      type(condition_list_t) :: loads                  !< on elements
      type(inherited_t) :: old_forces, old_loads       !< what earlier steps gave on each dof, element
      type(replaced_t) :: replaced                     !< what ends of earlier steps' loads
   end type open_step_t

   !> A dof of a node of no element: held at 0 so far, no longer, or moved or held later than in the first step; 0: free.
   integer(ip), parameter :: LOOSE_HELD = 1, LOOSE_RELEASED = 2, LOOSE_MOVES = 3

   !> Lines of one name, and the faces of elements that lie on them.
   type :: curve_t
      character(len=:), allocatable :: name            !< as the file has it
      integer(ip) :: card = 0                          !< that makes it, place in the deck's cards
      integer(ip) :: n = 0                             !< lines; ends may be longer
      integer(ip), allocatable :: ends(:, :)           !< (2, >= n) places of nodes
      type(face_list_t) :: faces                       !< of the deck's own mesh, on its outline
      integer(ip) :: n_inside = 0                      !< lines that have none
   end type curve_t

   !> Curves, each name once.
   type :: curve_list_t
      integer(ip) :: n = 0                             !< curves in use
      type(curve_t), allocatable :: list(:)            !< the first n are in use
      type(name_list_t) :: names                       !< in their order
   end type curve_list_t

   !> Line elements, which only name nodes and faces.
   type :: line_list_t
      type(id_map_t) :: ids                            !< numbers
      integer(ip), allocatable :: nodes(:, :)          !< (4, lines) places: the ends, then the middle or 0; last the number
      type(set_list_t) :: sets                         !< of the lines, by places in ids
   end type line_list_t

contains

   !> Keeps lines under a name; a name that is there already grows.
   subroutine add_curve(curves, name, card, ends)
      type(curve_list_t), intent(inout) :: curves      !< gets the name, or longer lines under it
      character(len=*), intent(in) :: name             !< of a physical group or a set
      integer(ip), intent(in) :: card                  !< that names the lines, place in the deck's cards
      integer(ip), intent(in) :: ends(:, :)            !< (2, lines) places of nodes
      type(curve_t), allocatable :: longer(:)
      integer(ip) :: i, n

      if (find_name(curves%names, name) == 0) call add_name(curves%names, name)
      i = find_name(curves%names, name)
      if (.not. allocated(curves%list)) allocate (curves%list(8))
      if (i > size(curves%list)) then
         allocate (longer(2*i))
         longer(:curves%n) = curves%list(:curves%n)
         call move_alloc(longer, curves%list)
      end if
      associate (curve => curves%list(i))
         if (i > curves%n) then
            curves%n = i
            curve%name = name
            curve%card = card
         end if
         n = curve%n + size(ends, 2, kind=ip)
         if (.not. allocated(curve%ends)) allocate (curve%ends(2, 0))
         if (n > size(curve%ends, 2)) call resize(curve%ends, curve%n, n + curve%n)
         curve%ends(:, curve%n + 1:n) = ends
         curve%n = n
      end associate
   end subroutine add_curve

   !> The faces on the outline that lie on the lines of a curve; each once.
   subroutine find_curve_faces(mesh, around, curve)
      type(mesh_t), intent(in) :: mesh                 !< of the deck, not refined
      type(node_elements_t), intent(in) :: around      !< elements round each node
      type(curve_t), intent(inout) :: curve            !< its faces and n_inside are found from its ends
      integer(ip) :: i, k, side, place(2), n_sides

      do i = 1, curve%n
         n_sides = 0                                   ! of elements that join the ends of the line: inside a mesh there are two
         associate (from => curve%ends(1, i), to => curve%ends(2, i))
            do k = around%first(from), around%first(from + 1) - 1
               side = max(side_between(mesh, around%list(k), from, to), side_between(mesh, around%list(k), to, from))
               if (side == 0) cycle
               place = [around%list(k), side]
               n_sides = n_sides + 1
            end do
         end associate
         if (n_sides == 1) then
            call add_face(curve%faces, place(1), place(2))
         else
            curve%n_inside = curve%n_inside + 1
         end if
      end do
   end subroutine find_curve_faces

   !> The nodes of a list that belong to none of the faces.
   pure function nodes_of_no_face(mesh, nodes, faces) result(loose)
      type(mesh_t), intent(in) :: mesh                 !< where the faces are
      integer(ip), intent(in) :: nodes(:)              !< places
      type(face_list_t), intent(in) :: faces           !< of this mesh
      integer(ip), allocatable :: loose(:)             !< places
      logical, allocatable :: held(:)
      integer(ip) :: i

      allocate (held(0:mesh%n_nodes), source=.false.)
      do i = 1, faces%n
         held(face_nodes(mesh, faces%element(i), faces%face(i))) = .true.
      end do
      loose = pack(nodes,.not. held(nodes))
   end function nodes_of_no_face

   !> The faces on the outline both of whose corners are among these nodes, and the node in their middle, if there is one.
   subroutine find_node_faces(mesh, around, nodes, faces)
      type(mesh_t), intent(in) :: mesh                 !< of the deck, not refined
      type(node_elements_t), intent(in) :: around      !< elements round each node
      integer(ip), intent(in) :: nodes(:)              !< places
      type(face_list_t), intent(inout) :: faces        !< what is found is added to it
      logical, allocatable :: chosen(:)
      integer(ip) :: i, k, e, side

      allocate (chosen(0:mesh%n_nodes), source=.false.)
      chosen(0) = .true.                               ! no node in the middle
      chosen(nodes) = .true.
      do i = 1, size(nodes, kind=ip)
         do k = around%first(nodes(i)), around%first(nodes(i) + 1) - 1
            e = around%list(k)
            do side = 1, side_count(mesh, e)           ! a face is found at its first corner
               if (mesh%nodes(side, e) /= nodes(i)) cycle
               if (.not. chosen(mesh%nodes(face_end(mesh, e, side), e))) cycle
               if (.not. chosen(middle_node(mesh, e, side))) cycle
               if (is_outer_face(mesh, around, e, side)) call add_face(faces, e, side)
            end do
         end do
      end do
   end subroutine find_node_faces

end module atrito_build_parts
