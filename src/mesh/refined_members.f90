!> What of a refined mesh belongs to nodes, elements and faces of the coarse one: sets and surfaces follow by these rules.
module atrito_refined_members
   use atrito_faces, only: face_list_t
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_nodes
   use atrito_refinement, only: refinement_t, drops_centre, is_refined
   use atrito_triangle_pieces, only: is_piece_on_side
   implicit none (type, external)
   private
   public :: fine_nodes, add_nodes_between, fine_elements, face_on_side, edge_value, faces_of_deck

contains

   !> The places in the fine mesh of some elements of the coarse one.
   pure function fine_elements(refinement, members) result(pieces)
      type(refinement_t), intent(in) :: refinement !< pieces of each element
      integer(ip), intent(in) :: members(:)        !< places in the coarse mesh
      integer(ip), allocatable :: pieces(:)
      integer(ip) :: first(size(members)), last(size(members)), i, k, n

      if (allocated(refinement%piece_first)) then
         first = refinement%piece_first(members)
         last = refinement%piece_first(members + 1) - 1
      else
         first = (members - 1)*refinement%pieces**2 + 1
         last = members*refinement%pieces**2
      end if
      allocate (pieces(sum(last - first + 1)))
      n = 0
      do i = 1, size(members, kind=ip)
         do k = first(i), last(i)
            n = n + 1
            pieces(n) = k
         end do
      end do
   end function fine_elements

   !> The face of a fine element that is part of its parent's face of a number; 0: none is.
   pure integer(ip) function face_on_side(refinement, element, face) result(own)
      type(refinement_t), intent(in) :: refinement   !< made for this fine mesh
      integer(ip), intent(in) :: element             !< place in the fine mesh
      integer(ip), intent(in) :: face                !< of its parent, 1..4

      if (allocated(refinement%own_face)) then
         own = refinement%own_face(face, element)
      else
         own = merge(face, 0_ip, is_on_side(refinement, element, face))
      end if
   end function face_on_side

   !> The same of elements all of which are cut alike, whose pieces stand as they do.
   pure logical function is_on_side(refinement, element, face)
      type(refinement_t), intent(in) :: refinement
      integer(ip), intent(in) :: element             !< place in the fine mesh
      integer(ip), intent(in) :: face                !< 1..4
      integer(ip) :: k, place(2)

      k = modulo(element - 1, refinement%pieces**2)
      if (is_refined(refinement)) then
         if (refinement%is_triangle((element - 1)/refinement%pieces**2 + 1)) then
            is_on_side = is_piece_on_side(refinement%pieces, k, face)
            return
         end if
      end if
      place = [modulo(k, refinement%pieces), k/refinement%pieces]
      select case (face)
      case (1)
         is_on_side = place(2) == 0
      case (2)
         is_on_side = place(1) == refinement%pieces - 1
      case (3)
         is_on_side = place(2) == refinement%pieces - 1
      case default
         is_on_side = place(1) == 0
      end select
   end function is_on_side

   !> The nodes of the fine mesh that belong to a set of nodes of the coarse one: its members, what lies on an edge all of whose
   !> nodes are members, and what lies inside an element all of whose nodes are members.
   pure function fine_nodes(mesh, refinement, members) result(fine)
      type(mesh_t), intent(in) :: mesh               !< coarse
      type(refinement_t), intent(in) :: refinement   !< made from `mesh`
      integer(ip), intent(in) :: members(:)          !< places in the coarse mesh
      integer(ip), allocatable :: fine(:)
      logical, allocatable :: chosen(:)
      integer(ip) :: e, i, k, n

      n = refinement%inner_first(mesh%n_elements + 1) - 1
      allocate (chosen(0:n), source=.false.)
      chosen(0) = .true.                             ! the middle of an edge that has none
      chosen(members) = .true.
      do i = 1, refinement%n_edges
         if (.not. all(chosen(refinement%edge_node(:, i)))) cycle
         chosen(refinement%edge_first(i):refinement%edge_first(i + 1) - 1) = .true.
      end do
      do e = 1, mesh%n_elements
         if (.not. all(chosen(mesh%nodes(:mesh%shape(e), e)))) cycle
         chosen(refinement%inner_first(e):refinement%inner_first(e + 1) - 1) = .true.
      end do
      do e = 1, mesh%n_elements
         if (drops_centre(mesh, refinement, e)) chosen(mesh%nodes(mesh%shape(e), e)) = .false.
      end do
      fine = pack(members, chosen(members))
      k = size(fine, kind=ip)
      fine = [fine, [(0_ip, i=1, count(chosen(mesh%n_nodes + 1:), kind=ip))]]
      do i = mesh%n_nodes + 1, n
         if (.not. chosen(i)) cycle
         k = k + 1
         fine(k) = i
      end do
   end function fine_nodes

   !> Adds to nodes of the fine mesh what it has on an edge all of whose nodes are there, and inside an element all of whose are.
   pure subroutine add_nodes_between(fine, refinement, nodes)
      type(mesh_t), intent(in) :: fine                    !< nodes of the fine elements are read
      type(refinement_t), intent(in) :: refinement        !< made for this fine mesh
      integer(ip), allocatable, intent(inout) :: nodes(:) !< places in the fine mesh, each once; new ones behind
      logical, allocatable :: chosen(:)
      integer(ip), allocatable :: inner(:)
      integer(ip) :: e, i, n

      allocate (chosen(fine%n_nodes), source=.false.)
      chosen(nodes) = .true.
      do i = 1, refinement%n_edges
         n = merge(3_ip, 2_ip, refinement%edge_node(3, i) > 0)
         if (all(chosen(refinement%edge_node(:n, i)))) chosen(refinement%edge_first(i):refinement%edge_first(i + 1) - 1) = .true.
      end do
      do e = 1, refinement%n_elements
         if (.not. all(chosen(refinement%edge_node(:2, refinement%face_edge(1, e))))) cycle
         inner = [fine%nodes(:, fine_elements(refinement, [e]))]
         inner = pack(inner, inner > 0)
         if (all(chosen(inner) .or. inner > refinement%n_nodes)) chosen(inner) = .true.
      end do
      chosen(nodes) = .false.
      nodes = [nodes, pack([(i, i=1, fine%n_nodes)], chosen)]
   end subroutine add_nodes_between

   !> The faces of the coarse mesh that faces on the outline of the fine one are parts of, each once. Distances that a deck measures
   !> by faces are those of its own.
   pure subroutine faces_of_deck(fine, refinement, faces, own, nodes)
      type(mesh_t), intent(in) :: fine                    !< nodes of the coarse mesh keep their places there
      type(refinement_t), intent(in) :: refinement        !< made for this fine mesh, or not made
      type(face_list_t), intent(in) :: faces              !< of the fine mesh
      integer(ip), intent(out) :: own(faces%n)            !< place in nodes
      integer(ip), allocatable, intent(out) :: nodes(:, :) !< (3, ): first, last, middle (0: none); places in the mesh
      integer(ip), allocatable :: edge_at(:), known(:)
      integer(ip) :: edge, i, n

      allocate (edge_at(fine%n_nodes), known(refinement%n_edges), source=0_ip)
      do i = 1, refinement%n_edges
         if (refinement%edge_node(3, i) > 0) edge_at(refinement%edge_node(3, i)) = i
         edge_at(refinement%edge_first(i):refinement%edge_first(i + 1) - 1) = i
      end do
      allocate (nodes(3, faces%n), source=0_ip)
      n = 0
      do i = 1, faces%n
         associate (ends => face_nodes(fine, faces%element(i), faces%face(i)))
            edge = maxval(edge_at(ends))
            if (edge > 0) then
               if (known(edge) == 0) then
                  n = n + 1
                  known(edge) = n
                  nodes(:, n) = refinement%edge_node(:, edge)
               end if
               own(i) = known(edge)
            else                                          ! a whole face
               n = n + 1
               nodes(:size(ends), n) = ends
               own(i) = n
            end if
         end associate
      end do
      nodes = nodes(:, :n)
   end subroutine faces_of_deck

   !> Value between the nodes of an edge: first, last[, middle].
   pure real(wp) function edge_value(values, t) result(value)
      real(wp), intent(in) :: values(:)                !< (2 or 3)
      real(wp), intent(in) :: t                        !< 0..1

      value = values(1) + t*(values(2) - values(1))
      if (size(values) == 3) value = value + 4*t*(1 - t)*(values(3) - 0.5_wp*(values(1) + values(2)))
   end function edge_value

end module atrito_refined_members
