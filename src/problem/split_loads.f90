!> What of the loads on an element acts on one side of a line that parts it.
!>
!> The element counts as the polygon of the nodes on its sides, a face as the chords between its nodes: exact for straight sides.
!>
!> Each corner has a height over the line. The part ahead of it is made by going round (clipping of a polygon by a
!> half-plane): corners with a height >= 0 stay, and between two corners a, b on different sides comes the place where
!> the height is 0,
!>
!>     x = (1 - s) x_a + s x_b,     s = h_a/(h_a - h_b).
!>
!> A part of an element is cut into triangles round its first corner, whose forces are those of a linear triangle; of a
!> chord what is left is a chord. So force and moment of both parts add up to those of the whole load. Area and centre
!> of a polygon are sums over the same triangles, with the corners taken from the first one: A = sum cross(a, b)/2, A
!> (centre - x_1) = sum cross(a, b)/2 (a + b)/3.
module atrito_split_loads
   use atrito_crossings, only: cut_line_t, height_over, slack_of, outline_of, MOST_OUTLINE
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: depth_places, face_nodes
   use atrito_model, only: model_t, element_load_t, is_on_volume
   use atrito_nodal_loads, only: forces_of_load
   implicit none (type, external)
   private
   public :: resultant_t, add_force, add_part_of_load, part_of_area

   !> Forces added up.
   type :: resultant_t
      real(wp) :: about(2) = 0.0_wp                 !< the point of the moment [L]
      real(wp) :: force(2) = 0.0_wp                 !< [F]
      real(wp) :: moment = 0.0_wp                   !< counter-clockwise [F L]
      real(wp) :: terms(2) = 0.0_wp                 !< sizes of the forces and of their moments, added up [F], [F L]
   end type resultant_t

   !> A corner of what is left of an element: its place, and what the depth goes by there [L].
   type :: corner_t
      real(wp) :: x(2) = 0.0_wp, place = 0.0_wp     !< place [L], and what the depth goes by there [L]
      real(wp) :: height = 0.0_wp                   !< over the line [L]
   end type corner_t

contains

   !> Adds a force at a place to a resultant and its moment, and the sizes of its terms, by which round-off is judged.
   pure subroutine add_force(sum, x, f)
      type(resultant_t), intent(inout) :: sum       !< of what came before
      real(wp), intent(in) :: x(2)                  !< where it acts [L]
      real(wp), intent(in) :: f(2)                  !< [F]
      real(wp) :: arm(2)

      arm = x - sum%about
      sum%force = sum%force + f
      sum%moment = sum%moment + (arm(1)*f(2) - arm(2)*f(1))
      sum%terms = sum%terms + [norm2(f), norm2(arm)*norm2(f)]
   end subroutine add_force

   !> Adds what of a load acts ahead of the line, or behind it: of a force per volume on the triangles of the element's
   !> part, of one on a face on the chords that are left of it.
   pure subroutine add_part_of_load(model, loads, i, line, ahead, factor, sum)
      type(model_t), intent(in) :: model            !< mesh, thickness, materials
      type(element_load_t), intent(in) :: loads     !< all loads on elements
      integer(ip), intent(in) :: i                  !< the load
      type(cut_line_t), intent(in) :: line          !< that parts the element
      logical, intent(in) :: ahead                  !< the part ahead of the line; else that behind it
      real(wp), intent(in) :: factor                !< of the forces
      type(resultant_t), intent(inout) :: sum       !< of what came before
      type(corner_t), allocatable :: corners(:)
      integer(ip) :: nodes(MOST_OUTLINE), k, n
      integer(ip), allocatable :: face(:)

      if (is_on_volume(loads%kind(i))) then
         call outline_of(model%mesh, loads%element(i), nodes, n)
         corners = part_beside(corners_at(model, loads%element(i), line, nodes(:n)), ahead, closed=.true.)
         do k = 2, size(corners, kind=ip) - 1       ! triangles round the first corner
            call add_load_on(corners([1_ip, k, k + 1_ip]), sum)
         end do
      else
         face = face_nodes(model%mesh, loads%element(i), loads%face(i))
         if (size(face) == 3) face = face([1, 3, 2])
         do k = 1, size(face, kind=ip) - 1
            corners = part_beside(corners_at(model, loads%element(i), line, face(k:k + 1)), ahead, closed=.false.)
            if (size(corners) == 2) call add_load_on(corners, sum)
         end do
      end if

   contains

      !> Adds the load on a triangle or on a straight piece of a face: its nodal forces at the corners, which have the
      !> resultant and the moment of the load, exactly.
      pure subroutine add_load_on(corners, sum)
         type(corner_t), intent(in) :: corners(:)
         type(resultant_t), intent(inout) :: sum       !< of what came before
         real(wp) :: x(2, size(corners)), fe(2, size(corners))
         integer(ip) :: k

         do k = 1, size(corners, kind=ip)
            x(:, k) = corners(k)%x
         end do
         call forces_of_load(model, loads, i, x, corners%place, fe)
         do k = 1, size(corners, kind=ip)
            call add_force(sum, x(:, k), factor*fe(:, k))
         end do
      end subroutine add_load_on

   end subroutine add_part_of_load

   !> The share of an element's area that lies ahead of the line, or behind it, and its centre: on the full circle the
   !> hoop stresses of an element that is parted are shared out by it.
   pure subroutine part_of_area(model, element, line, ahead, share, centre)
      type(model_t), intent(in) :: model            !< mesh
      integer(ip), intent(in) :: element            !< that the line parts
      type(cut_line_t), intent(in) :: line          !< that parts the element
      logical, intent(in) :: ahead                  !< the part ahead of the line; else that behind it
      real(wp), intent(out) :: share                !< 0 to 1
      real(wp), intent(out) :: centre(2)            !< [L]
      type(corner_t), allocatable :: whole(:), part(:)
      integer(ip) :: nodes(MOST_OUTLINE), n
      real(wp) :: area, other(2)

      call outline_of(model%mesh, element, nodes, n)
      whole = corners_at(model, element, line, nodes(:n))
      part = part_beside(whole, ahead, closed=.true.)
      call measure_polygon(whole, area, other)
      call measure_polygon(part, share, centre)
      share = share/area
   end subroutine part_of_area

   !> Area and centre of a polygon.
   pure subroutine measure_polygon(corners, area, centre)
      type(corner_t), intent(in) :: corners(:)      !< >= 3
      real(wp), intent(out) :: area                 !< [L^2]
      real(wp), intent(out) :: centre(2)            !< [L]
      real(wp) :: a(2), b(2), piece
      integer(ip) :: k

      area = 0.0_wp
      centre = 0.0_wp
      do k = 2, size(corners, kind=ip) - 1
         a = corners(k)%x - corners(1)%x
         b = corners(k + 1)%x - corners(1)%x
         piece = 0.5_wp*(a(1)*b(2) - a(2)*b(1))
         area = area + piece
         centre = centre + piece*(a + b)/3
      end do
      centre = corners(1)%x + centre/area
   end subroutine measure_polygon

   !> Nodes of an element as corners; one that is as near to the line as round-off lies on it.
   pure function corners_at(model, element, line, nodes) result(corners)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: element            !< that the line parts
      type(cut_line_t), intent(in) :: line          !< that parts the element
      integer(ip), intent(in) :: nodes(:)           !< of the outline or of a chord
      type(corner_t) :: corners(size(nodes))
      integer(ip) :: k

      corners%place = depth_places(model%mesh, model%mesh%state(element), nodes)
      do k = 1, size(nodes, kind=ip)
         corners(k)%x = model%mesh%x(:, nodes(k))
         corners(k)%height = height_over(line, corners(k)%x)
         if (abs(corners(k)%height) <= slack_of(model%mesh, element)) corners(k)%height = 0.0_wp
      end do
   end function corners_at

   !> What of a polygon, or of an open line of corners, lies on one side of the line.
   pure function part_beside(corners, ahead, closed) result(part)
      type(corner_t), intent(in) :: corners(:)
      logical, intent(in) :: ahead, closed          !< part ahead; a polygon, else an open line
      type(corner_t), allocatable :: part(:)
      type(corner_t) :: found(2*size(corners))
      real(wp) :: side
      integer(ip) :: k, next, n

      side = merge(1.0_wp, -1.0_wp, ahead)
      n = 0
      do k = 1, size(corners, kind=ip)
         if (side*corners(k)%height >= 0.0_wp) then
            n = n + 1
            found(n) = corners(k)
         end if
         if (k == size(corners) .and. .not. closed) exit
         next = mod(k, size(corners, kind=ip)) + 1
         if (.not. (min(corners(k)%height, corners(next)%height) < 0.0_wp .and. &
                    max(corners(k)%height, corners(next)%height) > 0.0_wp)) cycle
         n = n + 1
         found(n) = between(corners(k), corners(next))
      end do
      part = found(:n)
   end function part_beside

   !> Where the line goes through between two corners.
   pure type(corner_t) function between(a, b) result(corner)
      type(corner_t), intent(in) :: a, b            !< on different sides of the line
      real(wp) :: share

      share = a%height/(a%height - b%height)
      corner%x = (1 - share)*a%x + share*b%x
      corner%place = (1 - share)*a%place + share*b%place
   end function between

end module atrito_split_loads
