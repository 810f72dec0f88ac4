!> A cross-section of bodies along a straight cut: the elements and nodes from which the force through it is summed.
!>
!> The elements count as behind or ahead of the line by the mean of their corners. What the part ahead does to the part behind goes
!> through the nodes that elements of both sides share. Elements that the line parts are behind or ahead as a whole, and so is
!> what acts on them; what of it is on the wrong side is put right by whoever sums the forces: loads on elements by the parts of
!> split elements, forces of single nodes by their share. So the result is that of the line, not of the zigzag of the elements.
module atrito_cross_section
   use atrito_crossings, only: cut_line_t, piece_t, crossing_t, height_over, point_at, is_ahead, slack_of, find_crossings, &
                               INSIDE, EDGE_BEHIND, EDGE_AHEAD
   use atrito_faces, only: face_list_t, node_elements_t, add_face
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_nodes
   implicit none (type, external)
   private
   public :: cross_section_t, find_cross_section

   type :: cross_section_t
      type(cut_line_t) :: line                      !< through the two points of the cut
      real(wp) :: middle(2) = 0.0_wp                !< of what the line has of the bodies [L]
      real(wp) :: length = 0.0_wp                   !< of that [L]
      integer(ip), allocatable :: shared(:)         !< nodes of elements behind and of elements ahead
      integer(ip), allocatable :: behind(:)         !< the elements behind round these nodes
      integer(ip), allocatable :: split(:)          !< elements that the line parts
      logical, allocatable :: is_behind(:)          !< of each of them
      integer(ip), allocatable :: node(:)           !< whose own forces have a part in what goes through ...
      real(wp), allocatable :: share(:)             !< ... and which, -1 to 1
      type(face_list_t) :: edge                     !< faces on the line where the cut runs along the edge of a body
      real(wp), allocatable :: edge_share(:)        !< of the loads on them: 1, or -1 where the body lies ahead
   end type cross_section_t

contains

   !> The cross-section along a cut, and all crossings of its line. Without one that is taken the section is empty.
   pure subroutine find_cross_section(mesh, around, of_element, ends, wanted, section, crossings)
      type(mesh_t), intent(in) :: mesh                           !< nodes and elements are read
      type(node_elements_t), intent(in) :: around                !< elements round each node of mesh
      integer(ip), intent(in) :: of_element(:)                   !< body of each element
      real(wp), intent(in) :: ends(2, 2)                         !< of the cut, two points that differ [L]
      logical, intent(in) :: wanted(:)                           !< elements: crossings without one of them do not count
      type(cross_section_t), intent(out) :: section              !< parts of the crossings that are taken
      type(crossing_t), allocatable, intent(out) :: crossings(:) !< all along the line, with what tells of each
      type(piece_t), allocatable :: pieces(:)
      real(wp), allocatable :: place(:), weight(:)  ! of each crossing
      integer(ip) :: i

      section%line%start = ends(:, 1)
      section%line%length = norm2(ends(:, 2) - ends(:, 1))
      section%line%along = (ends(:, 2) - ends(:, 1))/section%line%length
      section%line%normal = [section%line%along(2), -section%line%along(1)]
      call find_crossings(mesh, around, of_element, section%line, pieces, crossings)
      crossings%is_wanted = .false.
      do i = 1, size(pieces, kind=ip)
         associate (c => crossings(pieces(i)%crossing))
            c%is_wanted = c%is_wanted .or. wanted(pieces(i)%element)
            c%is_all_wanted = c%is_all_wanted .and. wanted(pieces(i)%element)
         end associate
      end do
      call take_crossings(crossings)
      place = 0.5_wp*(crossings%from + crossings%to)
      weight = merge(crossings%to - crossings%from, 0.0_wp, crossings%is_taken)
      section%length = sum(weight)
      if (.not. section%length > 0.0_wp) weight = merge(1.0_wp, 0.0_wp, crossings%is_taken)   ! of points the middle is their mean
      if (any(crossings%is_taken)) section%middle = point_at(section%line, sum(weight/sum(weight)*place))
      call collect_parts(section)

   contains

      !> Elements and nodes of the crossings that are taken.
      pure subroutine collect_parts(section)
         type(cross_section_t), intent(inout) :: section
         logical :: is_known(mesh%n_nodes)
         integer(ip) :: i

         allocate (section%node(0), section%share(0), section%shared(0), section%split(0), section%is_behind(0), &
                   section%edge_share(0))
         is_known = .false.
         do i = 1, size(pieces, kind=ip)
            associate (piece => pieces(i), e => pieces(i)%element)
               if (.not. crossings(piece%crossing)%is_taken) cycle
               if (piece%kind == INSIDE) then
                  call add_nodes_inside(mesh, around, e, is_known, section)
                  if (.not. piece%is_split) cycle
                  section%split = [section%split, e]
                  section%is_behind = [section%is_behind,.not. is_ahead(mesh, section%line, e)]
               else
                  call add_edge(mesh, piece, is_known, section)
               end if
            end associate
         end do
         call collect_behind(section)
      end subroutine collect_parts

      !> The elements behind the line round the shared nodes, each once.
      pure subroutine collect_behind(section)
         type(cross_section_t), intent(inout) :: section
         logical :: is_in(mesh%n_elements)
         integer(ip) :: i, k

         is_in = .false.
         allocate (section%behind(0))
         do i = 1, size(section%shared, kind=ip)
            do k = around%first(section%shared(i)), around%first(section%shared(i) + 1) - 1
               associate (e => around%list(k))
                  if (is_in(e) .or. is_ahead(mesh, section%line, e)) cycle
                  is_in(e) = .true.
                  section%behind = [section%behind, e]
               end associate
            end do
         end do
      end subroutine collect_behind
   end subroutine find_cross_section

   !> Edges count where their body is not crossed; those of bodies ahead, which lie against what is behind, where there is nothing
   !> else.
   pure subroutine take_crossings(crossings)
      type(crossing_t), intent(inout) :: crossings(:)
      integer(ip) :: i

      crossings%is_taken = crossings%is_met .and. crossings%is_wanted .and. crossings%kind == INSIDE
      do i = 1, size(crossings, kind=ip)
         associate (c => crossings(i))
            if (c%kind /= EDGE_BEHIND .or. .not. (c%is_met .and. c%is_wanted)) cycle
            c%is_taken = .not. any(crossings%is_taken .and. crossings%kind == INSIDE .and. crossings%body == c%body)
         end associate
      end do
      if (any(crossings%is_taken)) return
      crossings%is_taken = crossings%is_met .and. crossings%is_wanted .and. crossings%kind == EDGE_AHEAD
   end subroutine take_crossings

   !> The nodes of an element at the line: whether elements of both sides share them, and what part of their own forces counts.
   !>
   !> What acts on a node is behind the line or ahead of it as the node is; half of it is where the node is on the line and shared.
   !> In the sum over the elements behind it is behind where the node is of these alone.
   pure subroutine add_nodes_inside(mesh, around, e, is_known, section)
      type(mesh_t), intent(in) :: mesh
      type(node_elements_t), intent(in) :: around
      integer(ip), intent(in) :: e
      logical, intent(inout) :: is_known(:)         !< (n_nodes)
      type(cross_section_t), intent(inout) :: section
      logical :: behind, ahead
      real(wp) :: height, part, counted
      integer(ip) :: k, i

      do k = 1, mesh%shape(e)
         associate (node => mesh%nodes(k, e))
            if (is_known(node)) cycle
            is_known(node) = .true.
            associate (sides => [(is_ahead(mesh, section%line, around%list(i)), i=around%first(node), around%first(node + 1) - 1)])
               ahead = any(sides)
               behind = .not. all(sides)
            end associate
            height = height_over(section%line, mesh%x(:, node))
            counted = merge(1.0_wp, 0.0_wp,.not. ahead)
            part = merge(1.0_wp, 0.0_wp, height < 0.0_wp)
            if (abs(height) <= slack_of(mesh, e)) part = merge(0.5_wp, counted, behind .and. ahead)
            if (behind .and. ahead) section%shared = [section%shared, node]
            if (part /= counted) call add_share(node, counted - part, section)
         end associate
      end do
   end subroutine add_nodes_inside

   !> A face of the outline on the line: all that acts there comes from the other side.
   pure subroutine add_edge(mesh, piece, is_known, section)
      type(mesh_t), intent(in) :: mesh
      type(piece_t), intent(in) :: piece
      logical, intent(inout) :: is_known(:)         !< (n_nodes)
      type(cross_section_t), intent(inout) :: section
      integer(ip), allocatable :: nodes(:)
      real(wp) :: share
      integer(ip) :: k

      share = merge(1.0_wp, -1.0_wp, piece%kind == EDGE_BEHIND)
      call add_face(section%edge, piece%element, piece%face)
      section%edge_share = [section%edge_share, share]
      nodes = face_nodes(mesh, piece%element, piece%face)
      do k = 1, size(nodes, kind=ip)
         if (is_known(nodes(k))) cycle
         is_known(nodes(k)) = .true.
         call add_share(nodes(k), share, section)
      end do
   end subroutine add_edge

   pure subroutine add_share(node, share, section)
      integer(ip), intent(in) :: node
      real(wp), intent(in) :: share
      type(cross_section_t), intent(inout) :: section

      section%node = [section%node, node]
      section%share = [section%share, share]
   end subroutine add_share

end module atrito_cross_section
