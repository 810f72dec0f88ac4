!> Elements along whose sides the traction is a polynomial by parts: where contact sides do not match, or their pressure has a bend.
!>
!> Such a side is cut, and the element is a polygon with corners of 180 degrees there. It is cut from its inner point into
!> triangles, one a side, and each of these into three: of these stresses every traction in equilibrium can be carried (of the
!> triangles by themselves not). Airy's function is known along the outline from the tractions; phi with its gradient at the inner
!> point and the numbers of the lines to the corners are where the energy is least. The tractions that all else was found with are
!> the polynomials with the same moments, so that both make the same phi and gradient at the ends of the side.
module atrito_cut_elements
   use atrito_airy_stress, only: go_along, side_place, MOST_OUTLINE
   use atrito_assembly, only: fem_t
   use atrito_element_energy, only: element_energy_t, energy_difference, make_energy, volume_tractions
   use atrito_element_table, only: CORNERS_OF
   use atrito_growth, only: make_room
   use atrito_kinds, only: ip, wp
   use atrito_mesh_sides, only: mesh_sides_t
   use atrito_star_sweeps, only: solve_least
   implicit none (type, external)
   private
   public :: side_cuts_t, add_piece, link_pieces, is_cut, cut_difference

   integer(ip), parameter :: MOST_CORNERS = 400     !< of a polygon

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
   end type polygon_t

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
      integer(ip) :: i, first

      is_cut = .false.
      do i = 1, size(sides%of_element, 1, kind=ip)
         if (sides%of_element(i, e) <= 0) cycle
         first = cuts%first(sides%of_element(i, e))
         if (first == 0) cycle
         is_cut = cuts%next(first) > 0 .or. cuts%from(first) > SAME_PLACE .or. cuts%to(first) < 1 - SAME_PLACE
         if (is_cut) return
      end do
   end function is_cut

   !> The least energy by which stresses in equilibrium differ from those of the displacements [F L].
   !>
   !> difference < 0: the element has too many cuts.
   function cut_difference(fem, sides, cuts, e, degree, x_given, outline) result(difference)
      type(fem_t), intent(in) :: fem
      type(mesh_sides_t), intent(in) :: sides
      type(side_cuts_t), intent(in) :: cuts
      integer(ip), intent(in) :: e, degree
      real(wp), intent(in) :: x_given(:)            !< as of energy_difference; its last two are forces per volume
      real(wp), intent(in) :: outline(:)            !< of the element, uncut
      real(wp) :: difference
      type(polygon_t) :: polygon
      type(element_energy_t) :: energy
      real(wp), allocatable :: matrix(:, :), inner(:)
      real(wp) :: centre(2), a(MOST_OUTLINE), g(MOST_OUTLINE), sign_of(18)
      integer(ip) :: i, m, place(18)

      difference = -1.0_wp
      polygon%degree = degree
      polygon%per_side = 2*degree - 1
      call make_polygon(fem, sides, cuts, e, x_given(size(x_given) - 1:), outline, polygon)
      if (polygon%n > MOST_CORNERS) return
      centre = sum(polygon%corner(:, :polygon%n), dim=2)/polygon%n
      m = 3 + polygon%per_side*polygon%n
      allocate (matrix(m, m), inner(m), source=0.0_wp)
      do i = 1, polygon%n
         call take_triangle(i)
         g(:energy%n) = matmul(energy%slopes(:, energy%n + 1:), x_given)
         call add_triangle(energy%n)
      end do
      call solve_least(m, matrix, inner)
      difference = 0.0_wp
      do i = 1, polygon%n
         call take_triangle(i)
         where (place(:energy%n) > 0) a(:energy%n) = sign_of(:energy%n)*inner(max(place(:energy%n), 1))
         difference = difference + energy_difference(energy, x_given, a(:energy%n))
      end do

   contains

      !> Triangle i: its energy, what is known of its outline, and where the rest stands among the inner numbers. The line from
      !> corner i runs to the inner point, so that the triangle before it has it as its second side.
      subroutine take_triangle(i)
         integer(ip), intent(in) :: i
         integer(ip) :: j, next, c

         next = 1 + mod(i, polygon%n)
         call make_energy(fem, e, degree, energy, reshape([polygon%corner(:, i), polygon%corner(:, next), centre], [2, 3]))
         place = 0
         sign_of = 1.0_wp
         a = 0.0_wp
         a(:3) = polygon%at_corner(:, i)
         a(4:6) = polygon%at_corner(:, next)
         place(7:9) = [1_ip, 2_ip, 3_ip]
         associate (per_side => polygon%per_side)
            c = side_place(3_ip, degree, 1_ip)
            a(c:c + per_side - 1) = polygon%of_side(:per_side, i)
            do j = 1, per_side
               place(side_place(3_ip, degree, 2_ip) + j - 1) = 3 + per_side*(next - 1) + j
               c = side_place(3_ip, degree, 3_ip) + j - 1
               place(c) = 3 + per_side*(i - 1) + merge(degree + 1 - j, j, j <= degree)
               if (j <= degree) sign_of(c) = -1.0_wp
            end do
         end associate
      end subroutine take_triangle

      !> Adds a triangle to the system for the inner numbers: H over them, and -(H a + g) with what is known.
      subroutine add_triangle(m)
         integer(ip), intent(in) :: m
         integer(ip) :: j, k

         do j = 1, m
            if (place(j) == 0) cycle
            inner(place(j)) = inner(place(j)) - sign_of(j)*(g(j) + dot_product(energy%slopes(:m, j), a(:m)))
            do k = 1, m
               if (place(k) == 0) cycle
               matrix(place(k), place(j)) = matrix(place(k), place(j)) + sign_of(j)*sign_of(k)*energy%slopes(k, j)
            end do
         end do
      end subroutine add_triangle

   end function cut_difference

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
      integer(ip) :: i, n_corners, piece, c
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
            c = side_place(n_corners, polygon%degree, i)
            polygon%of_side(:polygon%per_side, polygon%n) = outline(c:c + polygon%per_side - 1)
            cycle
         end if
         at = 0.0_wp
         do while (piece > 0)
            if (cuts%from(piece) > at + SAME_PLACE) call add_part(x, [at, cuts%from(piece)], NOTHING, b, now, polygon)
            call add_part(x, [max(at, cuts%from(piece)), cuts%to(piece)], cuts%traction(:, :, piece), b, now, polygon)
            at = cuts%to(piece)
            piece = cuts%next(piece)
         end do
         if (at < 1 - SAME_PLACE) call add_part(x, [at, 1.0_wp], NOTHING, b, now, polygon)
         if (polygon%n > MOST_CORNERS) return
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
      polygon%at_corner(:, polygon%n) = values
   end subroutine add_corner

end module atrito_cut_elements
