!> Lines between nodes that carry a name, as meshes of Gmsh have them, and the faces of elements that lie on them.
module atrito_curves
   use atrito_faces, only: face_list_t, node_elements_t, add_face, is_outer_face
   use atrito_kinds, only: ip
   use atrito_growth, only: resize
   use atrito_id_map, only: id_map_t
   use atrito_mesh, only: mesh_t, face_nodes, side_between, side_count, face_end, middle_node
   use atrito_name_list, only: name_list_t, add_name, find_name
   use atrito_sets, only: set_list_t
   implicit none (type, external)
   private
   public :: curve_t, curve_list_t, line_list_t, add_curve, find_curve_faces, find_node_faces, nodes_of_no_face

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

end module atrito_curves
