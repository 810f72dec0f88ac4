!> Elements along whose sides the traction is a polynomial by parts: where contact sides do not match, or their pressure has a bend.
!>
!> Such a side is cut, and the element is a polygon with corners of 180 degrees there. Between its outline and a ring, which is the
!> outline made smaller towards an inner point, it is cut into quadrilaterals, one a side, and within the ring into triangles from
!> the inner point; quadrilaterals are cut in four by their diagonals, triangles in three: of these stresses every traction in
!> equilibrium can be carried (of the quadrilaterals and triangles by themselves not). The ring gives room for a stress that is
!> large near a part of the side alone. Its corners are spread along it more evenly than those of the outline, so that no cell is
!> thin. Airy's function is known along the outline from the tractions; all numbers inside are where the energy is least. The
!> tractions that the first equilibrium was found with are the polynomials with the same moments, so that both make the same phi
!> and gradient at the ends of the side. What an element that is cut says of its energy to the sweeps over the corners
!> (atrito_star_sweeps) is the least energy over the outline, H and slope.
module atrito_cut_elements
   use atrito_airy_stress, only: go_along, side_place, volume_tractions, MOST_OUTLINE
   use atrito_assembly, only: fem_t
   use atrito_element_energy, only: element_energy_t, energy_difference, make_energy
   use atrito_element_table, only: CORNERS_OF
   use atrito_growth, only: make_room
   use atrito_kinds, only: ip, wp
   use atrito_mesh_sides, only: mesh_sides_t
   use atrito_star_sweeps, only: solve_least
   implicit none (type, external)
   private
   public :: side_cuts_t, add_piece, link_pieces, is_cut, count_cells, cut_difference

   integer(ip), parameter :: MOST_CORNERS = 400     !< of a polygon
   real(wp), parameter :: CORE = 2.0_wp/3         !< size of the ring round the inner point, as a share of the element

   !> Pieces of sides with a linear traction each, on the element that is the side's only one; those of a side follow one another.
   type :: side_cuts_t
      integer(ip) :: n = 0
      integer(ip), allocatable :: side(:)
      real(wp), allocatable :: from(:), to(:)       !< 0 to 1 along the side
      real(wp), allocatable :: traction(:, :, :)    !< (2, ends, n) [F/L]
      integer(ip), allocatable :: next(:)           !< (n) piece of the same side; 0: none
      integer(ip), allocatable :: first(:)          !< (sides) its first piece; 0: it is not cut
   end type side_cuts_t

   !> An element as a polygon, corner after corner counter-clockwise.
   type :: polygon_t
      integer(ip) :: n = 0                          !< more than MOST_CORNERS: it has too many
      integer(ip) :: degree = 0, per_side = 0       !< k; numbers of a side
      real(wp) :: corner(2, MOST_CORNERS) = 0.0_wp  !< less the element's first node [L]
      real(wp) :: at_corner(3, MOST_CORNERS) = 0.0_wp !< phi and its gradient
      real(wp) :: of_side(3, MOST_CORNERS) = 0.0_wp !< numbers of the side that begins there
      real(wp) :: ring(2, MOST_CORNERS) = 0.0_wp    !< corners of the ring, before it is made smaller [L]
      integer(ip) :: of_corner(MOST_CORNERS) = 0    !< corner of the element; 0: a cut
      integer(ip) :: at_side(MOST_CORNERS) = 0      !< first of the side's numbers among those of the element; 0: a part of one
   end type polygon_t

   !> A part of a polygon between its outline and the ring, or within the ring.
   type :: cell_t
      type(element_energy_t) :: energy
      real(wp) :: a(MOST_OUTLINE) = 0.0_wp          !< what is known of its outline
      integer(ip) :: place(MOST_OUTLINE) = 0        !< of a number of the outline among the unknown ones; 0: it is known
      real(wp) :: sign_of(MOST_OUTLINE) = 1.0_wp    !< of it there
   end type cell_t

   real(wp), parameter :: SAME_PLACE = 1.0e-9_wp    !< along a side

contains

   !> Adds a piece; places that run against the side are turned.
   subroutine add_piece(side, places, traction, cuts)
      integer(ip), intent(in) :: side
      real(wp), intent(in) :: places(2)
      real(wp), intent(in) :: traction(2, 2)        !< (component, end) in the order of the places
      type(side_cuts_t), intent(inout) :: cuts
      real(wp), allocatable :: longer(:, :, :)
      integer(ip) :: n

      n = cuts%n
      call make_room(cuts%side, n, n + 1)
      call make_room(cuts%from, n, n + 1)
      call make_room(cuts%to, n, n + 1)
      if (.not. allocated(cuts%traction)) allocate (cuts%traction(2, 2, 0))
      if (n == size(cuts%traction, 3)) then
         allocate (longer(2, 2, 2*n + 64))
         longer(:, :, :n) = cuts%traction(:, :, :n)
         call move_alloc(longer, cuts%traction)
      end if
      n = n + 1
      cuts%n = n
      cuts%side(n) = side
      cuts%from(n) = minval(places)
      cuts%to(n) = maxval(places)
      cuts%traction(:, :, n) = traction
      if (places(1) > places(2)) cuts%traction(:, :, n) = traction(:, 2:1:-1)
   end subroutine add_piece

   !> Finds the pieces of each side in their order. A side that one piece covers whole is not cut.
   subroutine link_pieces(n_sides, cuts, why_not)
      integer(ip), intent(in) :: n_sides
      type(side_cuts_t), intent(inout) :: cuts
      character(len=:), allocatable, intent(inout) :: why_not !< pieces of two pairs in one place
      integer(ip) :: i, at, before

      allocate (cuts%first(n_sides), cuts%next(cuts%n), source=0_ip)
      do i = 1, cuts%n
         before = 0
         at = cuts%first(cuts%side(i))
         do while (at > 0)
            if (cuts%from(at) > cuts%from(i)) exit
            before = at
            at = cuts%next(at)
         end do
         cuts%next(i) = at
         if (before == 0) then
            cuts%first(cuts%side(i)) = i
         else
            cuts%next(before) = i
         end if
      end do
      do i = 1, cuts%n
         if (cuts%next(i) == 0) cycle
         if (cuts%to(i) > cuts%from(cuts%next(i)) + SAME_PLACE) why_not = 'a place that two pairs press upon'
      end do
   end subroutine link_pieces

   !> Whether an element has a side that is cut.
   pure logical function is_cut(cuts, sides, e)
      type(side_cuts_t), intent(in) :: cuts
      type(mesh_sides_t), intent(in) :: sides
      integer(ip), intent(in) :: e
      integer(ip) :: i

      is_cut = .false.
      do i = 1, size(sides%of_element, 1, kind=ip)
         if (sides%of_element(i, e) > 0) is_cut = is_cut .or. has_cuts(cuts, sides%of_element(i, e))
      end do
   end function is_cut

   !> Whether the traction along a side is a polynomial by parts.
   pure logical function has_cuts(cuts, side)
      type(side_cuts_t), intent(in) :: cuts
      integer(ip), intent(in) :: side

      has_cuts = .false.
      associate (first => cuts%first(side))
         if (first > 0) has_cuts = cuts%next(first) > 0 .or. cuts%from(first) > SAME_PLACE .or. cuts%to(first) < 1 - SAME_PLACE
      end associate
   end function has_cuts

   !> Cells of all elements that are cut, each of which has one such side: about as many.
   pure integer(ip) function count_cells(fem, sides, cuts) result(n)
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      type(side_cuts_t), intent(in) :: cuts
      integer(ip) :: i, piece

      n = 0
      do i = 1, sides%n
         if (.not. has_cuts(cuts, i)) cycle
         n = n + 2*(CORNERS_OF(fem%mesh%shape(sides%element(1, i))) - 1)
         piece = cuts%first(i)
         do while (piece > 0)
            n = n + 2
            piece = cuts%next(piece)
         end do
      end do
   end function count_cells

   !> The least energy by which stresses in equilibrium differ from those of the displacements [F L].
   !>
   !> difference < 0: the element has too many cuts.
   subroutine cut_difference(fem, sides, cuts, e, x_given, outline, difference, h, slope)
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      type(side_cuts_t), intent(in) :: cuts
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: x_given(:)            !< as of energy_difference; its last two are forces per volume
      real(wp), intent(in) :: outline(:)            !< (n) of the element, uncut
      real(wp), intent(out) :: difference
      !> Half of the derivatives of the difference by the outline, without the numbers of sides that are cut.
      real(wp), intent(out), optional :: h(:, :)    !< (n, n)
      real(wp), intent(out), optional :: slope(:)   !< (n)
      type(polygon_t) :: polygon
      type(cell_t), allocatable :: cells(:, :)      !< (outer and inner, sides)
      real(wp), allocatable :: matrix(:, :), inner(:), given(:, :)
      real(wp) :: centre(2)
      integer(ip) :: i, j, m, n

      difference = -1.0_wp
      n = size(outline, kind=ip)
      polygon%degree = n/(2*CORNERS_OF(fem%mesh%shape(e))) - 1
      polygon%per_side = 2*polygon%degree - 1
      call make_polygon(fem, sides, cuts, e, x_given(size(x_given) - 1:), outline, polygon)
      if (polygon%n > MOST_CORNERS) return
      associate (nodes => fem%mesh%nodes(:CORNERS_OF(fem%mesh%shape(e)), e))
         centre = sum(fem%mesh%x(:, nodes), dim=2)/size(nodes) - fem%mesh%x(:, nodes(1))
      end associate
      m = 3 + 3*polygon%n + 3*polygon%per_side*polygon%n
      allocate (matrix(m + n, m + n), inner(m + n), source=0.0_wp)
      allocate (cells(0:1, polygon%n))
      given = reshape(x_given, [size(x_given), 1])
      do i = 1, polygon%n
         do j = 0, 1
            call make_energy(fem, e, polygon%degree, cells(j, i)%energy, cell_corners(polygon, centre, j, i), given)
            call take_outline(polygon, m, j, i, cells(j, i))
            call add_cell(cells(j, i), matrix, inner)
         end do
      end do
      call solve_least(m, matrix, inner, n)
      if (present(h)) then
         do j = 1, n
            h(j:, j) = matrix(m + j:, m + j)
            h(j, j:) = matrix(m + j:, m + j)
         end do
         slope = -inner(m + 1:)
      end if
      inner(m + 1:) = 0.0_wp
      difference = 0.0_wp
      do i = 1, polygon%n
         do j = 0, 1
            associate (cell => cells(j, i), n_cell => cells(j, i)%energy%n)
               where (cell%place(:n_cell) > 0)
                  cell%a(:n_cell) = cell%a(:n_cell) + cell%sign_of(:n_cell)*inner(max(cell%place(:n_cell), 1))
               end where
               difference = difference + energy_difference(cell%energy, [1.0_wp], cell%a(:n_cell))
            end associate
         end do
      end do
   end subroutine cut_difference

   !> Corners of the cell behind side i of the outline (j = 0), a quadrilateral, or of the ring (1), a triangle.
   pure function cell_corners(polygon, centre, j, i) result(x)
      type(polygon_t), intent(in) :: polygon
      real(wp), intent(in) :: centre(2)             !< the inner point, less the element's first node [L]
      integer(ip), intent(in) :: j, i
      real(wp) :: x(2, 4 - j)
      integer(ip) :: next

      next = 1 + mod(i, polygon%n)
      if (j == 0) then
         x(:, 1) = polygon%corner(:, i)
         x(:, 2) = polygon%corner(:, next)
         x(:, 3) = centre + CORE*(polygon%ring(:, next) - centre)
         x(:, 4) = centre + CORE*(polygon%ring(:, i) - centre)
      else
         x(:, 1) = centre + CORE*(polygon%ring(:, i) - centre)
         x(:, 2) = centre + CORE*(polygon%ring(:, next) - centre)
         x(:, 3) = centre
      end if
   end function cell_corners

   !> The outline of the cell behind side i of the outline (j = 0) or of the ring (1): what is known of it, and where its numbers
   !> stand among the m inner ones; behind these come those of the element's outline.
   subroutine take_outline(polygon, m, j, i, cell)
      type(polygon_t), intent(in) :: polygon
      integer(ip), intent(in) :: m, j, i
      type(cell_t), intent(inout) :: cell           !< with its energy
      integer(ip) :: corners, next, k, c

      corners = cell%energy%macro%n
      next = 1 + mod(i, polygon%n)
      if (j == 0) then
         cell%a(:3) = polygon%at_corner(:, i)
         cell%a(4:6) = polygon%at_corner(:, next)
         if (polygon%of_corner(i) > 0) cell%place(1:3) = m + 3*polygon%of_corner(i) - [2_ip, 1_ip, 0_ip]
         if (polygon%of_corner(next) > 0) cell%place(4:6) = m + 3*polygon%of_corner(next) - [2_ip, 1_ip, 0_ip]
         do k = 1, polygon%per_side
            c = side_place(corners, polygon%degree, 1_ip) + k - 1
            cell%a(c) = polygon%of_side(k, i)
            if (polygon%at_side(i) > 0) cell%place(c) = m + polygon%at_side(i) + k - 1
         end do
      else
         cell%place(1:3) = at_ring(j, i)
         cell%place(4:6) = at_ring(j, next)
      end if
      if (corners == 4) cell%place(10:12) = at_ring(j + 1, i)
      cell%place(7:9) = at_ring(j + 1, next)
      if (j > 0) call take_line(1_ip, (1 + j)*polygon%n + i, .true.)
      call take_line(2_ip, j*polygon%n + next, .true.)
      if (corners == 4) call take_line(3_ip, 2*polygon%n + i, .false.)
      call take_line(corners, j*polygon%n + i, .false.)

   contains

      !> Places of phi and its gradient at a corner of the ring (1), or at the inner point, which stands behind them (2).
      pure function at_ring(ring, i) result(places)
         integer(ip), intent(in) :: ring, i
         integer(ip) :: places(3)

         places = [1_ip, 2_ip, 3_ip] + 3*merge(i - 1, polygon%n, ring == 1)
      end function at_ring

      !> The numbers of an inner line, of which a side of the cell goes the same way or the other one. Lines: from the
      !> outline to the ring, from there to the inner point, and along the ring.
      subroutine take_line(side, line, is_same_way)
         integer(ip), intent(in) :: side, line
         logical, intent(in) :: is_same_way
         integer(ip) :: k, c, first

         first = 3 + 3*polygon%n + polygon%per_side*(line - 1)
         do k = 1, polygon%per_side
            c = side_place(corners, polygon%degree, side) + k - 1
            if (is_same_way .or. k > polygon%degree) then
               cell%place(c) = first + k
            else
               cell%place(c) = first + polygon%degree + 1 - k
               cell%sign_of(c) = -1.0_wp
            end if
         end do
      end subroutine take_line

   end subroutine take_outline

   !> Adds a cell to the system: H, and -(H a + g) with what is known.
   pure subroutine add_cell(cell, matrix, inner)
      type(cell_t), intent(in) :: cell
      real(wp), intent(inout) :: matrix(:, :), inner(:)
      integer(ip) :: j, k

      associate (n => cell%energy%n, slopes => cell%energy%slopes, place => cell%place, sign_of => cell%sign_of)
         do j = 1, n
            if (place(j) == 0) cycle
            inner(place(j)) = inner(place(j)) - sign_of(j)*(slopes(j, n + 1) + dot_product(slopes(:n, j), cell%a(:n)))
            do k = 1, n
               if (place(k) == 0) cycle
               matrix(place(k), place(j)) = matrix(place(k), place(j)) + sign_of(j)*sign_of(k)*slopes(k, j)
            end do
         end do
      end associate
   end subroutine add_cell

   !> Corners of an element and of its cuts with phi and its gradient, and the numbers of the sides between them.
   subroutine make_polygon(fem, sides, cuts, e, b, outline, polygon)
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      type(side_cuts_t), intent(in) :: cuts
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: b(2)                  !< thickness times force per volume [F/L^2]
      real(wp), intent(in) :: outline(:)            !< of the element, uncut
      type(polygon_t), intent(inout) :: polygon     !< with its degree
      real(wp), parameter :: NOTHING(2, 2) = 0.0_wp
      integer(ip) :: i, j, n_corners, piece, c, first
      real(wp) :: now(3), at, x(2, 2)

      n_corners = CORNERS_OF(fem%mesh%shape(e))
      do i = 1, n_corners
         associate (nodes => fem%mesh%nodes(:n_corners, e))
            x(:, 1) = fem%mesh%x(:, nodes(i)) - fem%mesh%x(:, nodes(1))
            x(:, 2) = fem%mesh%x(:, nodes(1 + mod(i, n_corners))) - fem%mesh%x(:, nodes(1))
         end associate
         piece = 0
         if (sides%of_element(i, e) > 0) piece = cuts%first(sides%of_element(i, e))
         now = outline(3*i - 2:3*i)
         if (piece == 0) then
            call add_corner(x(:, 1), now, polygon)
            if (polygon%n > MOST_CORNERS) return
            polygon%of_corner(polygon%n) = i
            c = side_place(n_corners, polygon%degree, i)
            polygon%at_side(polygon%n) = c
            polygon%of_side(:polygon%per_side, polygon%n) = outline(c:c + polygon%per_side - 1)
            cycle
         end if
         at = 0.0_wp
         first = polygon%n + 1
         if (first <= MOST_CORNERS) polygon%of_corner(first) = i
         do while (piece > 0)
            if (cuts%from(piece) > at + SAME_PLACE) call add_part(x, [at, cuts%from(piece)], NOTHING, b, now, polygon)
            call add_part(x, [max(at, cuts%from(piece)), cuts%to(piece)], cuts%traction(:, :, piece), b, now, polygon)
            at = cuts%to(piece)
            piece = cuts%next(piece)
         end do
         if (at < 1 - SAME_PLACE) call add_part(x, [at, 1.0_wp], NOTHING, b, now, polygon)
         if (polygon%n > MOST_CORNERS) return
         do j = first + 1, polygon%n              ! half of the way to where all parts would be equal
            at = real(j - first, wp)/(polygon%n + 1 - first)
            polygon%ring(:, j) = 0.5_wp*(polygon%corner(:, j) + (1 - at)*x(:, 1) + at*x(:, 2))
         end do
      end do
   end subroutine make_polygon

   !> A part of a side with a linear traction.
   subroutine add_part(x, places, traction, b, now, polygon)
      real(wp), intent(in) :: x(2, 2)               !< ends of the side [L]
      real(wp), intent(in) :: places(2)             !< along it, 0 to 1
      real(wp), intent(in) :: traction(2, 2)        !< (component, end) [F/L]
      real(wp), intent(in) :: b(2)                  !< thickness times force per volume [F/L^2]
      real(wp), intent(inout) :: now(3)             !< phi and its gradient, from one end to the other
      type(polygon_t), intent(inout) :: polygon
      real(wp) :: ends(2, 2), linear(2, 0:polygon%degree)
      integer(ip) :: k

      if (places(2) - places(1) <= SAME_PLACE) return
      do k = 1, 2
         ends(:, k) = x(:, 1) + places(k)*(x(:, 2) - x(:, 1))
      end do
      call add_corner(ends(:, 1), now, polygon)
      if (polygon%n > MOST_CORNERS) return
      do k = 0, polygon%degree
         associate (share => real(k, wp)/polygon%degree)
            linear(:, k) = (1 - share)*traction(:, 1) + share*traction(:, 2)
         end associate
      end do
      linear = linear + volume_tractions(b, ends(:, 1), ends(:, 2), polygon%degree)
      call go_along(ends(:, 2) - ends(:, 1), linear, now, polygon%of_side(:polygon%per_side, polygon%n))
   end subroutine add_part

   pure subroutine add_corner(x, values, polygon)
      real(wp), intent(in) :: x(2)                  !< [L]
      real(wp), intent(in) :: values(3)             !< phi and its gradient
      type(polygon_t), intent(inout) :: polygon

      polygon%n = polygon%n + 1
      if (polygon%n > MOST_CORNERS) return
      polygon%corner(:, polygon%n) = x
      polygon%ring(:, polygon%n) = x
      polygon%at_corner(:, polygon%n) = values
   end subroutine add_corner

end module atrito_cut_elements
