!> The lines by which bodies are drawn: edges of the mesh, each once, in runs of one kind and body; and rigid surfaces.
module atrito_mesh_lines
   use atrito_element_table, only: MOST_SIDES
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_faces, only: node_elements_t, list_node_elements
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t, face_end, side_between, side_count
   use atrito_model, only: surface_t
   implicit none (type, external)
   private
   public :: mesh_lines_t, collect_lines, rigid_places, LINE_INNER

   integer, parameter :: ARC_PIECES = 60            !< of a rigid arc
   integer(ip), parameter :: LINE_INNER = 1, LINE_OUTER = 2

   !> What is drawn: edges of the mesh, in runs of one kind and body.
   type :: mesh_lines_t
      integer(ip) :: n = 0                              !< edges in use
      integer(ip), allocatable :: element(:), face(:)   !< (n)
      integer(ip) :: n_runs = 0                         !< runs in use
      integer(ip), allocatable :: first(:)              !< (n_runs + 1) where each begins
      integer(ip), allocatable :: kind(:), body(:)      !< (n_runs)
   end type mesh_lines_t

contains

   !> Collects the edges, each once. A line between two sections counts as outline; rigid surfaces are not among them.
   subroutine collect_lines(mesh, section_of, only_outline, lines)
      type(mesh_t), intent(in) :: mesh              !< as solved
      integer(ip), intent(in) :: section_of(:)      !< (n_elements)
      logical, intent(in) :: only_outline           !< inner edges are left out
      type(mesh_lines_t), intent(out) :: lines      !< inner edges first, in each kind by bodies
      type(bodies_t) :: bodies
      integer(ip), allocatable :: kind_of(:, :)
      integer(ip) :: body, kind, i, face

      call find_bodies(mesh, bodies)
      allocate (kind_of(MOST_SIDES, mesh%n_elements))
      call find_kinds(mesh, section_of, kind_of)
      allocate (lines%element(MOST_SIDES*mesh%n_elements), lines%face(MOST_SIDES*mesh%n_elements), source=0_ip)
      allocate (lines%first(2*bodies%n + 1), lines%kind(2*bodies%n), lines%body(2*bodies%n), source=1_ip)
      do kind = merge(LINE_OUTER, LINE_INNER, only_outline), LINE_OUTER
         do body = 1, bodies%n
            associate (elements => bodies%list(body)%elements)
               do i = 1, size(elements, kind=ip)
                  do face = 1, side_count(mesh, elements(i))
                     if (kind_of(face, elements(i)) /= kind) cycle
                     lines%n = lines%n + 1
                     lines%element(lines%n) = elements(i)
                     lines%face(lines%n) = face
                  end do
               end do
            end associate
            if (lines%n + 1 == lines%first(lines%n_runs + 1)) cycle
            lines%n_runs = lines%n_runs + 1
            lines%kind(lines%n_runs) = kind
            lines%body(lines%n_runs) = body
            lines%first(lines%n_runs + 1) = lines%n + 1
         end do
      end do
   end subroutine collect_lines

   !> The kind of each face's edge; 0 of a face whose edge is drawn for the element beyond it, which has the lower number.
   subroutine find_kinds(mesh, section_of, kind_of)
      type(mesh_t), intent(in) :: mesh
      integer(ip), intent(in) :: section_of(:)      !< (n_elements)
      integer(ip), intent(out) :: kind_of(:, :)     !< (MOST_SIDES, n_elements)
      type(node_elements_t) :: around
      integer(ip) :: e, face, i, a, b, beyond

      around = list_node_elements(mesh)
      do e = 1, mesh%n_elements
         do face = 1, side_count(mesh, e)
            a = mesh%nodes(face, e)
            b = mesh%nodes(face_end(mesh, e, face), e)
            kind_of(face, e) = LINE_OUTER
            do i = around%first(a), around%first(a + 1) - 1
               beyond = around%list(i)
               if (side_between(mesh, beyond, b, a) == 0) cycle
               kind_of(face, e) = merge(LINE_INNER, LINE_OUTER, section_of(beyond) == section_of(e))
               if (beyond < e) kind_of(face, e) = 0
            end do
         end do
      end do
   end subroutine find_kinds

   !> The places of a rigid surface from its first end to its last, arcs in pieces.
   !>
   !> With p and q from the centre c to the ends of an arc, the angle from p to q is atan2(p x q, p . q), between -180 and 180
   !> degrees: the shorter way round. A share s of it leads to c + cos(s angle) p + sin(s angle) p', p' being p turned by 90
   !> degrees.
   pure function rigid_places(surface) result(places)
      type(surface_t), intent(in) :: surface        !< of segments
      real(wp), allocatable :: places(:, :)         !< (2, n) [L]
      real(wp) :: from(2), to(2), share, angle
      logical :: is_arc(size(surface%points, 2) - 1)
      integer :: i, j, n

      is_arc = .false.
      if (allocated(surface%is_arc) .and. allocated(surface%centre)) is_arc = surface%is_arc(:size(is_arc))
      allocate (places(2, size(surface%points, 2) + (ARC_PIECES - 1)*count(is_arc)))
      places(:, 1) = surface%points(:, 1)
      n = 1
      do i = 1, size(is_arc)
         do j = 1, merge(ARC_PIECES, 1, is_arc(i)) - 1
            n = n + 1
            share = real(j, wp)/real(ARC_PIECES, wp)
            associate (centre => surface%centre(:, i))
               from = surface%points(:, i) - centre
               to = surface%points(:, i + 1) - centre
               angle = share*atan2(from(1)*to(2) - from(2)*to(1), dot_product(from, to))
               places(:, n) = centre + cos(angle)*from + sin(angle)*[-from(2), from(1)]
            end associate
         end do
         n = n + 1
         places(:, n) = surface%points(:, i + 1)
      end do
   end function rigid_places

end module atrito_mesh_lines
