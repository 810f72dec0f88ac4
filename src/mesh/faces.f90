!> Faces of elements: which lie on the outline, and chains of them.
module atrito_faces
   use atrito_element_table, only: MOST_SIDES
   use atrito_growth, only: make_room
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_incidence, only: list_holders
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_end, middle_node, side_between, side_count
   implicit none (type, external)
   private
   public :: face_list_t, node_elements_t, chain_report_t
   public :: list_node_elements, find_across, is_outer_face, outer_faces, order_chain, face_normal, add_face, drop_repeated

   !> A list of element faces.
   type :: face_list_t
      integer(ip) :: n = 0                            !< faces in use
      integer(ip), allocatable :: element(:), face(:) !< (n) or more: place in the mesh; 1..4
   end type face_list_t

   !> The elements round each node: list(first(i) : first(i+1)-1).
   type :: node_elements_t
      integer(ip), allocatable :: first(:), list(:) !< (nodes + 1); places of elements
   end type node_elements_t

   !> What keeps a list of faces from being one chain; 0 where nothing does.
   type :: chain_report_t
      integer(ip) :: loose_face = 0      !< a face that does not continue the chain
      integer(ip) :: branch_node = 0     !< a node at which two faces begin
   end type chain_report_t

contains

   !> Lists the elements round each node, in linear time.
   function list_node_elements(mesh) result(around)
      type(mesh_t), intent(in) :: mesh !< elements and their nodes are read
      type(node_elements_t) :: around

      call list_holders(mesh%n_nodes, mesh%nodes(:, :mesh%n_elements), around%first, around%list)
   end function list_node_elements

   !> The element that shares a face, and which of its faces that is; 0: none. It joins the same corners the other way round, by the
   !> same middle: two curved faces that close a circle share both corners, but not the middle.
   pure subroutine find_across(mesh, around, element, face, other, other_face)
      type(mesh_t), intent(in) :: mesh              !< nodes of elements are read
      type(node_elements_t), intent(in) :: around   !< elements round each node of mesh
      integer(ip), intent(in) :: element, face      !< face 1..4
      integer(ip), intent(out) :: other, other_face !< place in the mesh; its face, 1..4
      integer(ip) :: k

      associate (first => mesh%nodes(face, element), last => mesh%nodes(face_end(mesh, element, face), element))
         do k = around%first(first), around%first(first + 1) - 1
            other = around%list(k)
            other_face = side_between(mesh, other, last, first, middle_node(mesh, element, face))
            if (other_face > 0) return
         end do
      end associate
      other = 0
   end subroutine find_across

   !> True when no other element shares the face.
   pure logical function is_outer_face(mesh, around, element, face)
      type(mesh_t), intent(in) :: mesh             !< nodes of elements are read
      type(node_elements_t), intent(in) :: around  !< elements round each node of mesh
      integer(ip), intent(in) :: element, face     !< face 1..4
      integer(ip) :: other, other_face

      call find_across(mesh, around, element, face, other, other_face)
      is_outer_face = other == 0
   end function is_outer_face

   !> All outer faces of some elements.
   pure function outer_faces(mesh, around, elements) result(faces_found)
      type(mesh_t), intent(in) :: mesh            !< nodes of elements are read
      type(node_elements_t), intent(in) :: around !< elements round each node of mesh
      integer(ip), intent(in) :: elements(:)      !< places in the mesh
      type(face_list_t) :: faces_found
      integer(ip) :: i, face

      do i = 1, size(elements, kind=ip)
         do face = 1, side_count(mesh, elements(i))
            if (is_outer_face(mesh, around, elements(i), face)) call add_face(faces_found, elements(i), face)
         end do
      end do
   end function outer_faces

   !> Adds a face to a list; order_chain drops those that stand there twice.
   pure subroutine add_face(list, element, face)
      type(face_list_t), intent(inout) :: list !< gets longer by one
      integer(ip), intent(in) :: element, face !< place in the mesh; 1..4

      call make_room(list%element, list%n, list%n + 1)
      call make_room(list%face, list%n, list%n + 1)
      list%n = list%n + 1
      list%element(list%n) = element
      list%face(list%n) = face
   end subroutine add_face

   !> Puts faces into the order in which one ends where the next begins, counter-clockwise round their body (an upper body's
   !> bottom from left to right); repeated faces are dropped. A closed chain begins with its first face.
   !>
   !> At most one face begins at each node of a chain, and at most one ends there; two tables hold which. The first face of an open
   !> chain is the one at whose first node none ends. From it the walk goes on to the face that begins where this one ends, until
   !> there is none, or the first comes again. What has not been met then is no part of the chain. n faces take about n steps.
   pure subroutine order_chain(mesh, list, report)
      type(mesh_t), intent(in) :: mesh            !< nodes of the faces are read
      type(face_list_t), intent(inout) :: list    !< put in order, if the faces are one chain
      type(chain_report_t), intent(out) :: report !< zeros where they are
      type(id_map_t) :: begins, ends               ! the face that begins or ends at a node: there are few of them in a large mesh
      integer(ip), allocatable :: order(:)
      integer(ip) :: i, k
      logical :: known

      call drop_repeated(list)
      do i = 1, list%n
         call add_id(begins, first_node(mesh, list, i), i, known)
         if (known) report%branch_node = first_node(mesh, list, i)
         call add_id(ends, last_node(mesh, list, i), i, known)
      end do
      if (list%n == 0 .or. report%branch_node /= 0) return
      allocate (order(list%n))
      k = 1
      do i = 1, list%n
         if (find_id(ends, first_node(mesh, list, i)) == 0) k = i
      end do
      do i = 1, list%n
         order(i) = k
         k = find_id(begins, last_node(mesh, list, k))
         if (k == 0 .or. k == order(1)) exit
      end do
      if (i < list%n) report%loose_face = first_missing(order(:i), list%n)
      if (report%loose_face /= 0) return
      list%element = list%element(order)
      list%face = list%face(order)
   end subroutine order_chain

   !> Faces that are named several times stand in the list once: a pressure would act twice on them.
   pure subroutine drop_repeated(list)
      type(face_list_t), intent(inout) :: list !< each face once, in the order in which they came
      type(id_map_t) :: seen(MOST_SIDES)
      logical, allocatable :: keep(:)
      integer(ip) :: i
      logical :: known

      if (.not. allocated(list%element)) allocate (list%element(0), list%face(0))
      allocate (keep(list%n))
      do i = 1, list%n
         call add_id(seen(list%face(i)), list%element(i), i, known)
         keep(i) = .not. known
      end do
      list%element = pack(list%element(:list%n), keep)
      list%face = pack(list%face(:list%n), keep)
      list%n = size(list%element, kind=ip)
   end subroutine drop_repeated

   pure integer(ip) function first_missing(order, n)
      integer(ip), intent(in) :: order(:), n

      do first_missing = 1, n
         if (all(order /= first_missing)) return
      end do
      first_missing = 0
   end function first_missing

   pure integer(ip) function first_node(mesh, list, i)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: list
      integer(ip), intent(in) :: i

      first_node = mesh%nodes(list%face(i), list%element(i))
   end function first_node

   pure integer(ip) function last_node(mesh, list, i)
      type(mesh_t), intent(in) :: mesh
      type(face_list_t), intent(in) :: list
      integer(ip), intent(in) :: i

      last_node = mesh%nodes(face_end(mesh, list%element(i), list%face(i)), list%element(i))
   end function last_node

   !> Outward unit normal of the straight line between a face's corners: the direction of travel turned by -90 degrees.
   pure function face_normal(mesh, element, face) result(n)
      type(mesh_t), intent(in) :: mesh         !< coordinates of the corners are read
      integer(ip), intent(in) :: element, face !< place in the mesh; 1..4
      real(wp) :: n(2), d(2)

      d = mesh%x(:, mesh%nodes(face_end(mesh, element, face), element)) - mesh%x(:, mesh%nodes(face, element))
      n = [d(2), -d(1)]/norm2(d)
   end function face_normal

end module atrito_faces
