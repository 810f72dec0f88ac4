!> Cutting a mesh along faces inside it: the nodes of the faces are doubled, and the elements on the side of the faces' own elements
!> get the new ones.
module atrito_mesh_cut
   use atrito_faces, only: face_list_t, find_across, node_elements_t
   use atrito_kinds, only: ip
   use atrito_mesh, only: mesh_t, add_nodes, face_end, middle_node, side_count, trim_mesh
   use atrito_sorting, only: each_once
   implicit none (type, external)
   private
   public :: mesh_cut_t, find_cut, cut_mesh

   !> Nodes that are doubled, and what of the elements changes.
   type :: mesh_cut_t
      integer(ip) :: outer_face = 0                 !< place in the list of a face that no other element shares; 0: there is none
      integer(ip) :: tip = 0                        !< node round which the faces do not part the elements; 0: there is none
      integer(ip), allocatable :: other(:), other_face(:) !< of each face the element that shares it, and which of its faces it is
      integer(ip), allocatable :: node(:)           !< that are doubled
      integer(ip), allocatable :: change(:, :)      !< (3, changes) place in node, element, which of its nodes
   end type mesh_cut_t

contains

   !> What a cut along faces changes; outer_face and tip say what keeps it from being one.
   pure subroutine find_cut(mesh, around, faces, cut)
      type(mesh_t), intent(in) :: mesh            !< is not changed yet
      type(node_elements_t), intent(in) :: around !< elements round each node of mesh
      type(face_list_t), intent(in) :: faces      !< where the mesh is cut; their elements get the new nodes
      type(mesh_cut_t), intent(out) :: cut        !< a cut where outer_face and tip are 0
      integer(ip) :: i

      allocate (cut%node(0), cut%change(3, 0), cut%other(faces%n), cut%other_face(faces%n))
      do i = 1, faces%n
         associate (e => faces%element(i), f => faces%face(i))
            call find_across(mesh, around, e, f, cut%other(i), cut%other_face(i))
            if (cut%other(i) == 0) then
               cut%outer_face = i
               return
            end if
            cut%node = [cut%node, mesh%nodes(f, e), mesh%nodes(face_end(mesh, e, f), e)]
            if (middle_node(mesh, e, f) > 0) cut%node = [cut%node, middle_node(mesh, e, f)]
         end associate
      end do
      cut%node = each_once(cut%node)
      do i = 1, size(cut%node, kind=ip)
         call part_node(i, cut)
         if (cut%tip > 0) return
      end do

   contains

      !> The elements round a node on the side of the faces' own ones: from these on over all faces that are not cut.
      pure subroutine part_node(place, cut)
         integer(ip), intent(in) :: place                 !< in cut%node
         type(mesh_cut_t), intent(inout) :: cut
         integer(ip) :: own(around%first(cut%node(place) + 1) - around%first(cut%node(place))), n, i, face, other, other_face

         associate (node => cut%node(place))
            n = 0
            do i = 1, faces%n
               if (touches(mesh, faces%element(i), faces%face(i), node)) call take(faces%element(i), own, n)
            end do
            i = 0
            do while (i < n)
               i = i + 1
               do face = 1, side_count(mesh, own(i))
                  if (.not. touches(mesh, own(i), face, node)) cycle
                  call find_across(mesh, around, own(i), face, other, other_face)
                  if (other == 0) cycle
                  if (is_listed(faces, own(i), face) .or. is_listed(faces, other, other_face)) cycle
                  call take(other, own, n)
               end do
            end do
            do i = 1, faces%n                             ! none of them lies across a face
               if (touches(mesh, faces%element(i), faces%face(i), node) .and. any(own(:n) == cut%other(i))) cut%tip = node
            end do
            if (cut%tip > 0) return
            do i = 1, n
               cut%change = reshape([cut%change, place, own(i), findloc(mesh%nodes(:, own(i)), node, dim=1, kind=ip)], &
                                    [3_ip, size(cut%change, 2, kind=ip) + 1])
            end do
         end associate
      end subroutine part_node

   end subroutine find_cut

   pure subroutine take(element, list, n)
      integer(ip), intent(in) :: element
      integer(ip), intent(inout) :: list(:), n

      if (any(list(:n) == element)) return
      n = n + 1
      list(n) = element
   end subroutine take

   pure logical function touches(mesh, element, face, node)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: element, face, node

      touches = any(node == [mesh%nodes(face, element), mesh%nodes(face_end(mesh, element, face), element), &
                             middle_node(mesh, element, face)])
   end function touches

   pure logical function is_listed(faces, element, face)
      type(face_list_t), intent(in) :: faces
      integer(ip), intent(in) :: element, face

      is_listed = any(faces%element(:faces%n) == element .and. faces%face(:faces%n) == face)
   end function is_listed

   !> Cuts. The new nodes come behind the others, in the order of cut%node, with the numbers that follow the greatest.
   subroutine cut_mesh(cut, mesh)
      type(mesh_cut_t), intent(in) :: cut !< from find_cut, without a fault
      type(mesh_t), intent(inout) :: mesh !< gets the nodes; some elements get them for their own
      integer(ip) :: k, before

      before = mesh%n_nodes
      call add_nodes(mesh, maxval(mesh%node_id(:before)) + 1, mesh%x(:, cut%node))
      do k = 1, size(cut%change, 2, kind=ip)
         mesh%nodes(cut%change(3, k), cut%change(2, k)) = before + cut%change(1, k)
      end do
      call trim_mesh(mesh)                         ! whoever asks for the largest coordinate takes all that there are
   end subroutine cut_mesh

end module atrito_mesh_cut
