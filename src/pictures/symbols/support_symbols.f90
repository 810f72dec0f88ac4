!> Symbols of supports: a roller where one direction is held, a hatched triangle where both are, an arrow along what is prescribed.
!>
!> They stand outside of the bodies, thinned where nodes are close. On the axis of bodies of revolution there are none: the axis
!> is drawn.
module atrito_support_symbols
   use atrito_bilateral_rows, only: ROW_SUPPORT
   use atrito_drawing, only: largest_length
   use atrito_kinds, only: ip, wp
   use atrito_load_resultants, only: is_section_node
   use atrito_mesh, only: is_revolved
   use atrito_model, only: nodal_values_t
   use atrito_strings, only: append_string, to_text
   use atrito_symbols, only: symbols_t, begin_block, put_stroke, put_arrow, thinned_nodes, places_of, &
                             find_outward, end_value, arrow_at, ARROW_LOOKS
   implicit none (type, external)
   private
   public :: put_supports

   !> What holds a node: direction 1, direction 2, both.
   integer(ip), parameter :: HELD_1 = 1, HELD_2 = 2, HELD_BOTH = 3
   !> Outlines of the symbols [pixels]: towards the ground from the node, and across.
   real(wp), parameter :: HEIGHT = 11.0_wp, HALF_WIDTH = 6.0_wp, HALF_GROUND = 8.0_wp, GAP = 3.5_wp, HATCH = 4.0_wp
   real(wp), parameter :: TIP(2) = 0.0_wp, TRIANGLE(2, 4) = reshape([TIP, HEIGHT, -HALF_WIDTH, HEIGHT, HALF_WIDTH, TIP], [2, 4])
   real(wp), parameter :: GROUND(2, 2) = reshape([HEIGHT, -HALF_GROUND, HEIGHT, HALF_GROUND], [2, 2])
   real(wp), parameter :: SPACING = 22.0_wp, LONGEST_ARROW = 44.0_wp
   real(wp), parameter :: ROUND_OFF = 1.0e-6_wp     !< of the lengths of faces: what is less has no direction
   real(wp), parameter :: NO_SIDE = 0.1_wp          !< a unit normal with less along a direction has no side of it
   real(wp), parameter :: NEAR_AXIS = 1.0e-10_wp    !< of the largest radius
   character(len=*), parameter :: GREY = '#303030', LOOKS = 'with lines lt 1 lw 1.3 lc rgb "'//GREY//'"', &
                                  MOVED_LOOKS = ' lw 1.8 lc rgb "#7B2CBF"'

   !> Supports of one kind.
   type :: supports_t
      integer(ip), allocatable :: node(:)           !< (n) places in the mesh
      real(wp), allocatable :: place(:, :)          !< (2, n) [L]
      real(wp), allocatable :: ground(:, :)         !< (2, n) unit vectors from the body to the ground
   end type supports_t

contains

   !> Puts the supports of a step, with the values of its end.
   subroutine put_supports(symbols)
      type(symbols_t), intent(inout) :: symbols     !< its step is read; get blocks
      logical, allocatable :: held(:, :)            ! (2, n_nodes)
      real(wp), allocatable :: moved(:, :), outward(:, :)
      type(supports_t) :: supports
      real(wp) :: largest, from(2), arrow(2)
      integer(ip) :: i

      allocate (held(2, symbols%model%mesh%n_nodes), source=.false.)
      allocate (moved(2, symbols%model%mesh%n_nodes), source=0.0_wp)
      call take_values(symbols, symbols%model%steps(symbols%step)%prescribed, held, moved)
      call take_values(symbols, symbols%model%steps(symbols%step)%rigid_prescribed, held, moved)
      if (is_revolved(symbols%model%mesh)) then
         associate (x => symbols%model%mesh%x(1, :symbols%model%mesh%n_nodes))
            held(1, :) = held(1, :) .and. x > NEAR_AXIS*maxval(x)
         end associate
      end if
      outward = find_outward(symbols%model%mesh)
      call put_fixed(held, outward, symbols)
      call put_rollers(held, outward, symbols)
      ! Arrows along prescribed displacements that are not 0.
      largest = largest_length(moved)
      if (largest > 0.0_wp) then
         call take_nodes(pack([(i, i=1, size(moved, 2, kind=ip))], abs(moved(1, :)) + abs(moved(2, :)) > 0.0_wp), symbols, supports)
         call begin_block(symbols, 'prescribed displacements', ':5:6', ARROW_LOOKS//MOVED_LOOKS// &
                          ' title "prescribed displacement, up to '//to_text(largest, 4)//' [L]"')
         do i = 1, size(supports%node, kind=ip)
            associate (node => supports%node(i))
               call arrow_at(supports%place(:, i), moved(:, node)/largest, outward(:2, node), LONGEST_ARROW*symbols%pixel, &
                             from, arrow)
               call put_arrow(symbols, symbols%u(:, node), from, arrow)
            end associate
         end do
      end if
   end subroutine put_supports

   !> What is prescribed at nodes; rotations of reference nodes are left out.
   subroutine take_values(symbols, list, held, moved)
      type(symbols_t), intent(in) :: symbols
      type(nodal_values_t), intent(in) :: list
      logical, intent(inout) :: held(:, :)
      real(wp), intent(inout) :: moved(:, :)
      real(wp) :: value
      integer(ip) :: i

      do i = 1, list%n
         if (list%dof(i) > 2) cycle
         if (is_section_node(symbols%model, list%node(i))) cycle
         value = end_value(symbols, list, i)
         held(list%dof(i), list%node(i)) = .not. abs(value) > 0.0_wp
         moved(list%dof(i), list%node(i)) = value
      end do
   end subroutine take_values

   !> Nodes with both directions held.
   subroutine put_fixed(held, outward, symbols)
      logical, intent(in) :: held(:, :)
      real(wp), intent(in) :: outward(:, :)
      type(symbols_t), intent(inout) :: symbols
      type(supports_t) :: fixed
      integer :: i, k

      call find_held(HELD_BOTH, held, outward, symbols, fixed)
      if (size(fixed%node) == 0) return
      call begin_block(symbols, 'supports in both directions', '', 'with filledcurves closed lc rgb "'//GREY//'"')
      do i = 1, size(fixed%node)
         call put_shape(symbols, fixed, i, TRIANGLE)
      end do
      call append_string(symbols%curves, 'NaN with points pt 9 ps 1.6*dot lc rgb "'//GREY//'" title "held in both directions"')
      call begin_block(symbols, 'their ground', '', LOOKS)
      do i = 1, size(fixed%node)
         call put_shape(symbols, fixed, i, GROUND)
         do k = -1, 2
            call put_shape(symbols, fixed, i, reshape([HEIGHT, k*HATCH, HEIGHT + HATCH, k*HATCH - HATCH], [2, 2]))
         end do
      end do
   end subroutine put_fixed

   !> Nodes with one direction held, inclined ones too.
   subroutine put_rollers(held, outward, symbols)
      logical, intent(in) :: held(:, :)
      real(wp), intent(in) :: outward(:, :)
      type(symbols_t), intent(inout) :: symbols
      type(supports_t) :: rollers(3)
      integer :: k, i
      integer(ip), allocatable :: rows(:), nodes(:)
      real(wp) :: along(2)
      integer(ip) :: j

      call find_held(HELD_1, held, outward, symbols, rollers(1))
      call find_held(HELD_2, held, outward, symbols, rollers(2))
      ! Supports along directions that are no axis, thinned.
      associate (all_rows => symbols%model%bilateral)
         rows = pack([(j, j=1, all_rows%n)], [(all_rows%kind(j) == ROW_SUPPORT, j=1, all_rows%n)])
         allocate (nodes(0))
         ! not the nodes of the rows: in a row others carry the motion of a reference node
         if (size(rows) > 0) nodes = symbols%model%inclined%node(:size(rows))
         call take_nodes(nodes, symbols, rollers(3))
         do j = 1, size(rollers(3)%node, kind=ip)
            along = all_rows%vector(:, all_rows%first(rows(findloc(nodes, rollers(3)%node(j), dim=1))))
            rollers(3)%ground(:, j) = along/norm2(along)
            if (dot_product(along, outward(:2, rollers(3)%node(j))) < 0.0_wp) rollers(3)%ground(:, j) = -rollers(3)%ground(:, j)
         end do
      end associate
      if (sum([(size(rollers(k)%node), k=1, 3)]) == 0) return
      call begin_block(symbols, 'supports in one direction', '', LOOKS)
      do k = 1, 3
         do i = 1, size(rollers(k)%node)
            call put_shape(symbols, rollers(k), i, TRIANGLE)
            call put_shape(symbols, rollers(k), i, GROUND + spread([GAP, 0.0_wp], 2, 2))
         end do
      end do
      call append_string(symbols%curves, 'NaN with points pt 8 ps 1.6*dot lw 1.3 lc rgb "'//GREY// &
                         '" title "held in one direction"')
   end subroutine put_rollers

   !> The nodes that are held so, thinned.
   subroutine find_held(kind, held, outward, symbols, supports)
      integer(ip), intent(in) :: kind               !< HELD_*
      logical, intent(in) :: held(:, :)
      real(wp), intent(in) :: outward(:, :)
      type(symbols_t), intent(in) :: symbols
      type(supports_t), intent(out) :: supports
      logical :: is_so(size(held, 2))
      real(wp), allocatable :: own(:, :)
      integer(ip) :: i

      is_so = merge(1, 0, held(1, :)) + merge(2, 0, held(2, :)) == kind
      call take_nodes(pack([(i, i=1, size(held, 2, kind=ip))], is_so), symbols, supports)
      if (size(supports%node) == 0) return
      own = find_outward(symbols%model%mesh, is_so)         ! at a corner that of the side that is held
      do i = 1, size(supports%node, kind=ip)
         supports%ground(:, i) = ground_of(kind, own(:, supports%node(i)), outward(:, supports%node(i)))
      end do
   end subroutine find_held

   !> Supports at some of the nodes.
   subroutine take_nodes(nodes, symbols, supports)
      integer(ip), intent(in) :: nodes(:)
      type(symbols_t), intent(in) :: symbols
      type(supports_t), intent(out) :: supports

      supports%node = thinned_nodes(symbols, nodes, SPACING)
      supports%place = places_of(symbols, supports%node)
      allocate (supports%ground(2, size(supports%node)))
   end subroutine take_nodes

   !> The side of a node on which the ground is.
   pure function ground_of(kind, own, general) result(ground)
      integer(ip), intent(in) :: kind               !< HELD_*
      real(wp), intent(in) :: own(3)                !< outward normal, as find_outward has it, of the side that is held so
      real(wp), intent(in) :: general(3)            !< and of all sides
      real(wp) :: ground(2), normal(3)
      integer(ip) :: axis

      normal = own
      if (norm2(own(:2)) <= ROUND_OFF*own(3)) normal = general
      ground = [0.0_wp, -1.0_wp]
      if (kind == HELD_1) ground = [-1.0_wp, 0.0_wp]
      if (norm2(normal(:2)) <= ROUND_OFF*normal(3)) return
      normal(:2) = normal(:2)/norm2(normal(:2))
      if (kind /= HELD_BOTH) then
         axis = merge(1_ip, 2_ip, kind == HELD_1)
         if (abs(normal(axis)) > NO_SIDE) ground(axis) = sign(1.0_wp, normal(axis))
      else if (norm2(own(:2)) > ROUND_OFF*own(3)) then
         ground = normal(:2)
      else                                          ! a single node: along an axis
         axis = merge(1_ip, 2_ip, abs(normal(1)) > (1 + NO_SIDE)*abs(normal(2)))
         ground = 0.0_wp
         ground(axis) = sign(1.0_wp, normal(axis))
      end if
   end function ground_of

   !> A line through places so many pixels towards the ground and across.
   subroutine put_shape(symbols, supports, i, shape)
      type(symbols_t), intent(inout) :: symbols
      type(supports_t), intent(in) :: supports
      integer, intent(in) :: i
      real(wp), intent(in) :: shape(:, :)           !< (2, n) [pixels]
      real(wp) :: places(2, size(shape, 2))
      integer :: k

      associate (d => supports%ground(:, i))
         do k = 1, size(shape, 2)
            places(:, k) = supports%place(:, i) + symbols%pixel*(shape(1, k)*d + shape(2, k)*[-d(2), d(1)])
         end do
      end associate
      call put_stroke(symbols, symbols%u(:, supports%node(i)), places)
   end subroutine put_shape

end module atrito_support_symbols
