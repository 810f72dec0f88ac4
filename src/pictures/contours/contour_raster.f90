!> What lies under each pixel of a picture of the displaced bodies: an element, and the place in it. Fields are drawn by it.
!>
!> The work goes with the pixels, not with the elements, of which there may be millions: one that covers the centre of no pixel is
!> passed over. An element is cut into so many triangles that their edges follow its curves, and places are linear in each of them.
!>
!> For a triangle with corners x1, x2, x3 in the picture and xi1, xi2, xi3 in the element, a pixel's centre x has the barycentric
!> shares s1 + s2 + s3 = 1 with x = s1 x1 + s2 x2 + s3 x3. With b = x2 - x1, c = x3 - x1, d = x - x1 Cramer's rule gives
!>    s2 = (d x c)/(b x c),  s3 = (b x d)/(b x c),  s1 = 1 - s2 - s3,
!> where p x q = p1 q2 - p2 q1. The centre lies in the triangle where no share is negative, and its place in the element is
!> s1 xi1 + s2 xi2 + s3 xi3: the inverse of the element's map, without Newton's method, up to the size of a piece. The field there
!> follows from the shape functions at that place.
module atrito_contour_raster
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_value, ieee_quiet_nan
   use atrito_element_table, only: MOST_NODES, CORNERS_OF, DEGREE_OF
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: mesh_t
   use atrito_plot_text, only: range_t, span
   use atrito_shape_functions, only: shape_values
   implicit none (type, external)
   private
   public :: raster_t, lay_raster, pixel_values

   !> The window as pixels, and what lies under each.
   type :: raster_t
      integer(ip) :: n(2) = 0                       !< pixels along x and y
      real(wp) :: low(2) = 0.0_wp                   !< lower left corner of the window [L]
      real(wp) :: pixel(2) = 0.0_wp                 !< sides of a pixel [L]
      integer(ip), allocatable :: element(:, :)     !< (n(1), n(2)) under a pixel's centre, the first row is the lowest; 0: none
      real(wp), allocatable :: place(:, :, :)       !< (2, n(1), n(2)) in the element, as shape functions have it
   end type raster_t

   real(wp), parameter :: PIECE = 8.0_wp            !< pixels along the side of a piece of an element
   integer(ip), parameter :: MOST_PIECES = 24       !< along a side
   integer(ip), parameter :: FEWEST_CURVED = 2      !< of elements with nodes in their sides
   real(wp), parameter :: ROUND_OFF = 1.0e-9_wp     !< by which a pixel's centre may lie outside a triangle

contains

   !> Finds what lies under the pixels of a window: of bodies that overlap, the one whose elements come last.
   pure subroutine lay_raster(mesh, u, scale, window, n, raster)
      type(mesh_t), intent(in) :: mesh              !< as solved
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      real(wp), intent(in) :: scale                 !< of the displacements
      type(range_t), intent(in) :: window(2)        !< that is shown [L], of some length
      integer(ip), intent(in) :: n(2)               !< pixels, 1 at least
      type(raster_t), intent(out) :: raster         !< element 0: nothing lies there
      real(wp) :: x(2, MOST_NODES)
      integer(ip) :: e, k

      raster%n = n
      raster%low = window%low
      raster%pixel = [span(window(1)), span(window(2))]/n
      allocate (raster%element(n(1), n(2)), source=0_ip)
      allocate (raster%place(2, n(1), n(2)), source=0.0_wp)
      do e = 1, mesh%n_elements
         do k = 1, mesh%shape(e)
            x(:, k) = (mesh%x(:, mesh%nodes(k, e)) + scale*u(:, mesh%nodes(k, e)) - raster%low)/raster%pixel
         end do
         call lay_element(mesh%shape(e), e, x(:, :mesh%shape(e)), raster)
      end do
   end subroutine lay_raster

   !> Lays an element that may be seen.
   pure subroutine lay_element(shape, e, x, raster)
      integer(ip), intent(in) :: shape              !< place in SHAPES
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: x(:, :)               !< (2, shape) nodes, in pixels from the corner of the window
      type(raster_t), intent(inout) :: raster
      real(wp) :: low(2), high(2), room
      integer(ip) :: m

      if (.not. all(ieee_is_finite(x))) return
      low = minval(x, dim=2)
      high = maxval(x, dim=2)
      room = 0.0_wp                                 ! a curved side may bulge beyond its nodes
      if (DEGREE_OF(shape) > 1) room = 0.5_wp*maxval(high - low)
      if (any(high + room < 0.0_wp .or. low - room > raster%n)) return
      if (any(aint(high + room + 0.5_wp) <= aint(low - room + 0.5_wp) .and. low - room > 0.0_wp)) return ! between centres of pixels
      m = int(min(real(MOST_PIECES, wp), maxval(high - low)/PIECE), ip) + 1
      if (DEGREE_OF(shape) > 1) m = max(m, FEWEST_CURVED)
      if (DEGREE_OF(shape) == 1 .and. CORNERS_OF(shape) == 3) m = 1
      call lay_pieces(shape, e, x, m, raster)
   end subroutine lay_element

   !> Cuts an element into m x m pieces of two triangles each; a triangle has half of them.
   pure subroutine lay_pieces(shape, e, x, m, raster)
      integer(ip), intent(in) :: shape, e
      real(wp), intent(in) :: x(:, :)
      integer(ip), intent(in) :: m
      type(raster_t), intent(inout) :: raster
      real(wp) :: xi(2, 0:m, 0:m), at(2, 0:m, 0:m)
      integer(ip) :: i, j
      logical :: is_triangle

      is_triangle = CORNERS_OF(shape) == 3
      do j = 0, m
         do i = 0, m
            xi(:, i, j) = real([i, j], wp)/m
            if (.not. is_triangle) xi(:, i, j) = 2.0_wp*xi(:, i, j) - 1.0_wp
            at(:, i, j) = matmul(x, shape_values(shape, xi(:, i, j)))
         end do
      end do
      do j = 1, m
         do i = 1, m
            if (is_triangle .and. i + j > m + 1) cycle
            call lay_triangle(e, reshape([at(:, i - 1, j - 1), at(:, i, j - 1), at(:, i - 1, j)], [2, 3]), &
                              reshape([xi(:, i - 1, j - 1), xi(:, i, j - 1), xi(:, i - 1, j)], [2, 3]), raster)
            if (is_triangle .and. i + j > m) cycle
            call lay_triangle(e, reshape([at(:, i, j), at(:, i - 1, j), at(:, i, j - 1)], [2, 3]), &
                              reshape([xi(:, i, j), xi(:, i - 1, j), xi(:, i, j - 1)], [2, 3]), raster)
         end do
      end do
   end subroutine lay_pieces

   !> The pixels whose centres a triangle covers, its edges among it, whichever way round it goes.
   pure subroutine lay_triangle(e, x, xi, raster)
      integer(ip), intent(in) :: e
      real(wp), intent(in) :: x(2, 3)               !< corners in pixels
      real(wp), intent(in) :: xi(2, 3)              !< corners in the element
      type(raster_t), intent(inout) :: raster
      real(wp) :: area, share(3), d(2), b(2), c(2)
      integer(ip) :: i, j, first(2), last(2)

      b = x(:, 2) - x(:, 1)
      c = x(:, 3) - x(:, 1)
      area = b(1)*c(2) - b(2)*c(1)
      if (abs(area) <= tiny(area)) return
      do i = 1, 2
         first(i) = ceiling(within(minval(x(i, :)) + 0.5_wp - ROUND_OFF, raster%n(i)), ip)
         last(i) = floor(within(maxval(x(i, :)) + 0.5_wp + ROUND_OFF, raster%n(i)), ip)
      end do
      do j = first(2), last(2)
         do i = first(1), last(1)
            d = [i, j] - 0.5_wp - x(:, 1)
            share(2) = (d(1)*c(2) - d(2)*c(1))/area
            share(3) = (b(1)*d(2) - b(2)*d(1))/area
            share(1) = 1.0_wp - share(2) - share(3)
            if (any(share < -ROUND_OFF)) cycle
            raster%element(i, j) = e
            raster%place(:, i, j) = matmul(xi, share)
         end do
      end do
   end subroutine lay_triangle

   !> A place among the pixels, or just beside them: places far away are no integers.
   pure real(wp) function within(place, n)
      real(wp), intent(in) :: place
      integer(ip), intent(in) :: n

      within = max(0.5_wp, min(n + 0.5_wp, place))
   end function within

   !> A field at the pixels; NaN beside the bodies.
   pure function pixel_values(raster, mesh, values, of_elements) result(pixels)
      type(raster_t), intent(in) :: raster          !< by lay_raster
      type(mesh_t), intent(in) :: mesh              !< that the raster was laid of
      real(wp), intent(in) :: values(:)             !< of the elements, or at the nodes, between which they are interpolated
      logical, intent(in) :: of_elements            !< values are constant in each
      real(wp), allocatable :: pixels(:, :)         !< (n(1), n(2))
      integer(ip) :: i, j

      allocate (pixels(raster%n(1), raster%n(2)), source=ieee_value(1.0_wp, ieee_quiet_nan))
      do j = 1, raster%n(2)
         do i = 1, raster%n(1)
            associate (e => raster%element(i, j))
               if (e == 0) cycle
               if (of_elements) then
                  pixels(i, j) = values(e)
               else
                  pixels(i, j) = dot_product(shape_values(mesh%shape(e), raster%place(:, i, j)), &
                                             values(mesh%nodes(:mesh%shape(e), e)))
               end if
            end associate
         end do
      end do
   end function pixel_values

end module atrito_contour_raster
