!> Triangles along contact sides, finer than the elements, for displacements that make up for a misfit of the sides.
!>
!> Elements near the sides are cut from their middles into triangles, sides of contact besides at every place where the other side
!> has a node. Displacements are linear on each triangle, 0 at supports and where the strip ends: beyond it nothing moves.
module atrito_strip_mesh
   use atrito_assembly, only: fem_t
   use atrito_element_table, only: CORNERS_OF
   use atrito_growth, only: make_room, resize
   use atrito_kinds, only: ip, lp, wp
   use atrito_mesh, only: face_end
   use atrito_plane_state, only: COMPONENTS, elasticity_matrix
   use atrito_sorting, only: sorted_places
   implicit none (type, external)
   private
   public :: strip_t, make_strip, strip_energy

   integer, parameter :: LAYERS = 3                 !< of elements behind a contact side
   real(wp), parameter :: CORE = 0.6_wp             !< size of a ring, as a share of its element
   integer(lp), parameter :: PLACES = 2_lp**30      !< a place along a face, 0 to 1, in steps of this

   type :: strip_t
      integer(ip) :: n = 0, n_triangles = 0
      real(wp), allocatable :: x(:, :)              !< (2, n) [L]
      logical, allocatable :: is_free(:, :)         !< (2, n)
      integer(ip), allocatable :: corner(:, :)      !< (3, n_triangles)
      integer(ip), allocatable :: element(:)        !< (n_triangles)
      real(wp), allocatable :: own(:, :, :)         !< (2, 2, n) stiffness of a corner
      integer(ip), allocatable :: first(:)          !< (n + 1) other corners of the triangles round corner i: first(i) ..
      integer(ip), allocatable :: other(:)          !< first(i + 1) - 1
      real(wp), allocatable :: coupling(:, :, :)    !< (2, 2, ..) stiffness towards them
   end type strip_t

   !> Places on faces where triangles are to have a corner, sorted.
   type :: marks_t
      integer(ip), allocatable :: number(:)         !< (m) as they were given
      integer(ip), allocatable :: element(:), face(:) !< (m)
      real(wp), allocatable :: place(:)             !< (m) along the face, 0 to 1
      integer(lp), allocatable :: key(:)            !< (m) element, face and place as one number
      integer(ip), allocatable :: first_of(:)       !< (n_elements) the first mark of an element; 0: it has none
   end type marks_t

contains

   !> The strip behind some faces.
   subroutine make_strip(fem, held, element, face, place, strip, vertex)
      type(fem_t), intent(in) :: fem
      logical, intent(in) :: held(:, :)             !< (2, n_nodes)
      integer(ip), intent(in) :: element(:), face(:) !< (m)
      real(wp), intent(in) :: place(:)              !< (m) along the face, 0 to 1
      type(strip_t), intent(out) :: strip
      integer(ip), intent(out) :: vertex(:)         !< (m) the corner of triangles there
      type(marks_t) :: marks
      integer(ip), allocatable :: of_node(:)        !< (n_nodes) corner of triangles; 0: none
      logical, allocatable :: is_inside(:)          !< (n_elements) of the strip
      integer(ip) :: e, i
      integer(lp) :: key(size(element))

      ! Places on faces in the order of elements, of their faces, and along these.
      key = (4_lp*element + face)*(2*PLACES) + nint(place*PLACES, lp)
      marks%number = sorted_places(key)
      marks%key = key(marks%number)
      marks%element = element(marks%number)
      marks%face = face(marks%number)
      marks%place = place(marks%number)
      allocate (marks%first_of(fem%mesh%n_elements), source=0_ip)
      do i = size(element, kind=ip), 1, -1
         marks%first_of(marks%element(i)) = i
      end do
      call choose_elements(fem, element, face, is_inside)
      allocate (of_node(fem%mesh%n_nodes), source=0_ip)
      call make_room(strip%element, 0_ip, 64_ip)
      allocate (strip%x(2, 0), strip%is_free(2, 0), strip%corner(3, 0))
      do e = 1, fem%mesh%n_elements
         if (is_inside(e)) call cut_element(fem, held, marks, e, of_node, strip, vertex)
      end do
      do e = 1, fem%mesh%n_elements                 ! where the strip ends
         if (is_inside(e)) cycle
         associate (nodes => fem%mesh%nodes(:CORNERS_OF(fem%mesh%shape(e)), e))
            strip%is_free(:, pack(of_node(nodes), of_node(nodes) > 0)) = .false.
         end associate
      end do
      call add_stiffness(fem, strip)
   end subroutine make_strip

   !> The triangles of an element: from its middle, and of one with faces of contact those between its outline and a ring within,
   !> too.
   subroutine cut_element(fem, held, marks, e, of_node, strip, vertex)
      type(fem_t), intent(in) :: fem
      logical, intent(in) :: held(:, :)             !< (2, n_nodes)
      type(marks_t), intent(in) :: marks
      integer(ip), intent(in) :: e
      integer(ip), intent(inout) :: of_node(:)      !< (n_nodes)
      type(strip_t), intent(inout) :: strip
      integer(ip), intent(inout) :: vertex(:)       !< (m) those of its marks are found
      integer(ip), allocatable :: outline(:)
      real(wp) :: middle(2)
      integer(ip) :: i, next, centre, n, first

      associate (nodes => fem%mesh%nodes(:CORNERS_OF(fem%mesh%shape(e)), e))
         middle = sum(fem%mesh%x(:, nodes), dim=2)/size(nodes)
      end associate
      call take_outline(fem, held, marks, e, of_node, strip, vertex, outline, n)
      call add_vertex(strip, middle, [.true., .true.], centre)
      first = centre
      if (marks%first_of(e) > 0) then
         do i = 1, n
            call add_vertex(strip, middle + CORE*(strip%x(1:2, outline(i)) - middle), [.true., .true.], next)
         end do
      end if
      do i = 1, n
         next = 1 + mod(i, n)
         if (marks%first_of(e) > 0) then
            call add_triangle(strip, [outline(i), outline(next), first + i], e)
            call add_triangle(strip, [outline(next), first + next, first + i], e)
            call add_triangle(strip, [first + i, first + next, centre], e)
         else
            call add_triangle(strip, [outline(i), outline(next), centre], e)
         end if
      end do
   end subroutine cut_element

   !> Corners and marks along the outline of an element, counter-clockwise.
   subroutine take_outline(fem, held, marks, e, of_node, strip, vertex, outline, n)
      type(fem_t), intent(in) :: fem
      logical, intent(in) :: held(:, :)             !< (2, n_nodes)
      type(marks_t), intent(in) :: marks
      integer(ip), intent(in) :: e
      integer(ip), intent(inout) :: of_node(:)      !< (n_nodes)
      type(strip_t), intent(inout) :: strip
      integer(ip), intent(inout) :: vertex(:)       !< (m)
      integer(ip), allocatable, intent(inout) :: outline(:)
      integer(ip), intent(out) :: n                 !< corners of it
      integer(ip) :: k, at

      n = 0
      at = marks%first_of(e)
      do k = 1, CORNERS_OF(fem%mesh%shape(e))
         associate (from => fem%mesh%nodes(k, e), to => fem%mesh%nodes(face_end(fem%mesh, e, k), e))
            call make_room(outline, n, n + 1)
            n = n + 1
            call take_node(from, outline(n))
            do while (at > 0 .and. at <= size(marks%number))
               associate (t => marks%place(at), i => marks%number(at))
                  if (marks%element(at) /= e .or. marks%face(at) /= k) exit
                  if (nint(t*PLACES, lp) >= PLACES - 1) then
                     call take_node(to, vertex(i))
                  else
                     if (nint(t*PLACES, lp) > 1 .and. .not. is_same(marks, at)) then
                        call make_room(outline, n, n + 1)
                        n = n + 1
                        call add_vertex(strip, (1 - t)*fem%mesh%x(1:2, from) + t*fem%mesh%x(1:2, to), &
                                        .not. (held(1:2, from) .and. held(1:2, to)), outline(n))
                     end if
                     vertex(i) = outline(n)
                  end if
               end associate
               at = at + 1
            end do
         end associate
      end do

   contains

      subroutine take_node(node, at)
         integer(ip), intent(in) :: node
         integer(ip), intent(out) :: at

         if (of_node(node) == 0) call add_vertex(strip, fem%mesh%x(1:2, node),.not. held(1:2, node), of_node(node))
         at = of_node(node)
      end subroutine take_node

   end subroutine take_outline

   !> Whether the mark before is in the same place, to a few digits less than those of PLACES.
   pure logical function is_same(marks, at)
      type(marks_t), intent(in) :: marks
      integer(ip), intent(in) :: at

      is_same = .false.
      if (at == 1) return
      is_same = marks%key(at) - marks%key(at - 1) <= 1 .and. marks%element(at) == marks%element(at - 1) .and. &
                marks%face(at) == marks%face(at - 1) .and. nint(marks%place(at - 1)*PLACES, lp) > 1
   end function is_same

   !> Elements that are no farther from the faces than the layers of the strip.
   subroutine choose_elements(fem, element, face, is_inside)
      type(fem_t), intent(in) :: fem
      integer(ip), intent(in) :: element(:), face(:)
      logical, allocatable, intent(out) :: is_inside(:)
      logical, allocatable :: is_reached(:)
      integer(ip) :: i, e
      integer :: layer

      allocate (is_inside(fem%mesh%n_elements), is_reached(fem%mesh%n_nodes), source=.false.)
      do i = 1, size(element, kind=ip)
         is_reached(fem%mesh%nodes([face(i), face_end(fem%mesh, element(i), face(i))], element(i))) = .true.
      end do
      do layer = 1, LAYERS
         do e = 1, fem%mesh%n_elements
            associate (nodes => fem%mesh%nodes(:CORNERS_OF(fem%mesh%shape(e)), e))
               if (.not. is_inside(e)) is_inside(e) = any(is_reached(nodes))
            end associate
         end do
         do e = 1, fem%mesh%n_elements
            if (is_inside(e)) is_reached(fem%mesh%nodes(:CORNERS_OF(fem%mesh%shape(e)), e)) = .true.
         end do
      end do
   end subroutine choose_elements

   subroutine add_vertex(strip, x, is_free, vertex)
      type(strip_t), intent(inout) :: strip
      real(wp), intent(in) :: x(2)
      logical, intent(in) :: is_free(2)
      integer(ip), intent(out) :: vertex
      logical, allocatable :: more(:, :)

      if (strip%n == size(strip%x, 2)) then
         call resize(strip%x, strip%n, 2*strip%n + 64)
         allocate (more(2, 2*strip%n + 64))
         more(:, :strip%n) = strip%is_free
         call move_alloc(more, strip%is_free)
      end if
      strip%n = strip%n + 1
      vertex = strip%n
      strip%x(:, vertex) = x
      strip%is_free(:, vertex) = is_free
   end subroutine add_vertex

   subroutine add_triangle(strip, corner, e)
      type(strip_t), intent(inout) :: strip
      integer(ip), intent(in) :: corner(3), e

      if (strip%n_triangles == size(strip%corner, 2)) call resize(strip%corner, strip%n_triangles, 2*strip%n_triangles + 64)
      call make_room(strip%element, strip%n_triangles, strip%n_triangles + 1)
      strip%n_triangles = strip%n_triangles + 1
      strip%corner(:, strip%n_triangles) = corner
      strip%element(strip%n_triangles) = e
   end subroutine add_triangle

   !> The stiffness of all triangles, as rows of their corners.
   subroutine add_stiffness(fem, strip)
      type(fem_t), intent(in) :: fem
      type(strip_t), intent(inout) :: strip
      real(wp) :: stiffness(6, 6)                   ! of a triangle; not kept, since it is most of what a strip would hold
      integer(ip) :: i, j, k, at

      call list_neighbours(strip)
      allocate (strip%own(2, 2, strip%n), strip%coupling(2, 2, size(strip%other)), source=0.0_wp)
      do i = 1, strip%n_triangles
         stiffness = triangle_stiffness(fem, strip, i)
         do j = 1, 3
            associate (mine => strip%corner(j, i))
               do k = 1, 3
                  associate (block => stiffness(2*j - 1:2*j, 2*k - 1:2*k))
                     if (k == j) then
                        strip%own(:, :, mine) = strip%own(:, :, mine) + block
                     else
                        at = strip%first(mine) - 1 + findloc(strip%other(strip%first(mine):), strip%corner(k, i), dim=1)
                        strip%coupling(:, :, at) = strip%coupling(:, :, at) + block
                     end if
                  end associate
               end do
            end associate
         end do
      end do
   end subroutine add_stiffness

   !> The other corners of the triangles round each corner, each once.
   pure subroutine list_neighbours(strip)
      type(strip_t), intent(inout) :: strip
      integer(ip) :: last(strip%n), other(6*strip%n_triangles), i, j, k, n

      allocate (strip%first(strip%n + 1), source=0_ip)
      do i = 1, strip%n_triangles
         do j = 1, 3
            strip%first(strip%corner(j, i) + 1) = strip%first(strip%corner(j, i) + 1) + 2
         end do
      end do
      strip%first(1) = 1
      do i = 1, strip%n
         strip%first(i + 1) = strip%first(i) + strip%first(i + 1)
      end do
      last = strip%first(:strip%n) - 1
      do i = 1, strip%n_triangles
         do j = 1, 3
            do k = 1, 3
               associate (mine => strip%corner(j, i), its => strip%corner(k, i))
                  if (k == j .or. any(other(strip%first(mine):last(mine)) == its)) cycle
                  last(mine) = last(mine) + 1
                  other(last(mine)) = its
               end associate
            end do
         end do
      end do
      n = 0
      do i = 1, strip%n                             ! most are corners of two triangles: what is left is closed up
         other(n + 1:n + 1 + last(i) - strip%first(i)) = other(strip%first(i):last(i))
         n = n + 1 + last(i) - strip%first(i)
         strip%first(i) = n - last(i) + strip%first(i)
      end do
      strip%first(strip%n + 1) = n + 1
      strip%other = other(:n)
   end subroutine list_neighbours

   pure function triangle_stiffness(fem, strip, i_triangle) result(k)
      type(fem_t), intent(in) :: fem
      type(strip_t), intent(in) :: strip
      integer(ip), intent(in) :: i_triangle
      real(wp) :: k(6, 6)
      real(wp) :: x(2, 3), b(COMPONENTS, 6), stress(COMPONENTS, 6), twice_area, g(2)
      integer(ip) :: i
      integer(ip), parameter :: NEXT(4) = [2, 3, 1, 2]

      do i = 1, 3
         x(:, i) = strip%x(:, strip%corner(i, i_triangle))
      end do
      twice_area = (x(1, 2) - x(1, 1))*(x(2, 3) - x(2, 1)) - (x(1, 3) - x(1, 1))*(x(2, 2) - x(2, 1))
      b = 0.0_wp
      do i = 1, 3
         g = [x(2, NEXT(i)) - x(2, NEXT(i + 1)), x(1, NEXT(i + 1)) - x(1, NEXT(i))]/twice_area
         b(:, 2*i - 1) = [g(1), 0.0_wp, g(2)]
         b(:, 2*i) = [0.0_wp, g(2), g(1)]
      end do
      associate (e => strip%element(i_triangle), section => fem%sections(fem%section_of(strip%element(i_triangle))))
         stress = matmul(elasticity_matrix(section, fem%mesh%state(e)), b)
         k = matmul(transpose(b), stress)
         k = 0.5_wp*abs(twice_area)*section%thickness*k
      end associate
   end function triangle_stiffness

   !> int eps(w) : C eps(w) of a triangle [F L].
   pure real(wp) function strip_energy(fem, strip, i, w) result(energy)
      type(fem_t), intent(in) :: fem
      type(strip_t), intent(in) :: strip
      integer(ip), intent(in) :: i
      real(wp), intent(in) :: w(:, :)               !< (2, n) [L]
      real(wp) :: v(6)
      integer(ip) :: j

      do j = 1, 3
         v(2*j - 1:2*j) = w(:, strip%corner(j, i))
      end do
      energy = 0.0_wp
      if (all(abs(v) <= 0.0_wp)) return
      energy = dot_product(v, matmul(triangle_stiffness(fem, strip, i), v))
   end function strip_energy

end module atrito_strip_mesh
