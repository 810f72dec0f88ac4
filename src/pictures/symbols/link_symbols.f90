!> Symbols of what holds nodes to each other or to the ground: springs, equations, pre-tension sections, reference nodes;
!> and the axis of bodies of revolution.
module atrito_link_symbols
   use atrito_bilateral_rows, only: ROW_EQUATION, ROW_SECTION
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: is_revolved
   use atrito_model, only: spring_t
   use atrito_plot_text, only: span
   use atrito_strings, only: to_text
   use atrito_symbols, only: symbols_t, begin_block, put_stroke, put_path, put_arrow, put_point, thinned, &
                             place_of_node, end_value, ARROW_LOOKS
   implicit none (type, external)
   private
   public :: put_links

   !> Lengths in pixels.
   real(wp), parameter :: FREE_SPRING = 30.0_wp, HALF_COIL = 4.0_wp, HALF_GROUND = 7.0_wp, BETWEEN = 14.0_wp, &
                          HALF_SQUARE = 6.0_wp, PULL = 34.0_wp, BEYOND = 24.0_wp
   integer, parameter :: COILS = 8                  !< corners of a spring between its straight ends
   integer(ip), parameter :: MOST_LINES = 200       !< from the first node of an equation to the others
   !> The axis is drawn where the bodies are no farther from it than this many of their diagonals.
   real(wp), parameter :: FAR_AXIS = 1.0_wp
   character(len=*), parameter :: SPRINGS = 'with lines lt 1 lw 1.3 lc rgb "#00695C"', &
                                  EQUATIONS = 'with lines lt 1 lw 1 dt 3 lc rgb "#5D4037"', &
                                  SECTIONS = 'lc rgb "#AD1457"', AXIS = 'with lines lt 1 lw 1.4 dt "-. " lc rgb "#404040"'

contains

   !> Puts them, and widens the window to the axis.
   subroutine put_links(symbols)
      type(symbols_t), intent(inout) :: symbols     !< its model is read; get blocks

      call put_axis(symbols)
      call put_springs(symbols)
      call put_equations(symbols)
      call put_sections(symbols)
      call put_references(symbols)
   end subroutine put_links

   !> The axis, a little longer than the bodies.
   subroutine put_axis(symbols)
      type(symbols_t), intent(inout) :: symbols
      real(wp) :: low, high

      if (.not. is_revolved(symbols%model%mesh)) return
      associate (x => symbols%window(1), y => symbols%window(2))
         if (x%low > FAR_AXIS*hypot(span(x), span(y))) return
         low = y%low - BEYOND*symbols%pixel
         high = y%high + BEYOND*symbols%pixel
      end associate
      call begin_block(symbols, 'the axis of revolution', '', AXIS//' title "axis of revolution"')
      call put_stroke(symbols, [0.0_wp, 0.0_wp], reshape([0.0_wp, low, 0.0_wp, high], [2, 2]))
   end subroutine put_axis

   subroutine put_springs(symbols)
      type(symbols_t), intent(inout) :: symbols
      integer(ip) :: i

      if (.not. allocated(symbols%model%springs)) return
      if (size(symbols%model%springs) == 0) return
      call begin_block(symbols, 'springs', '', SPRINGS//' title "springs"')
      do i = 1, size(symbols%model%springs, kind=ip)
         call put_spring(symbols%model%springs(i), symbols)
      end do
   end subroutine put_springs

   !> A zigzag between two nodes; from a node to the ground, or where both nodes coincide, along the direction of its dof.
   subroutine put_spring(spring, symbols)
      type(spring_t), intent(in) :: spring
      type(symbols_t), intent(inout) :: symbols
      real(wp) :: ends(2, 2), moves(2, 2), along(2), across(2), share, places(2, COILS + 2), us(2, COILS + 2)
      integer :: k

      associate (mesh => symbols%model%mesh, other => spring%node(2))
         along = 0.0_wp
         along(max(1_ip, spring%dof(1))) = -FREE_SPRING*symbols%pixel
         ends(:, 1) = mesh%x(:, spring%node(1))
         ends(:, 2) = ends(:, 1) + along
         moves = spread(symbols%u(:, spring%node(1)), 2, 2)
         if (other > 0) then
            moves(:, 2) = symbols%u(:, other)
            if (norm2(mesh%x(:, other) - ends(:, 1)) > symbols%pixel) ends(:, 2) = mesh%x(:, other)
         end if
      end associate
      along = ends(:, 2) - ends(:, 1)
      along = along/norm2(along)
      across = symbols%pixel*[-along(2), along(1)]
      do k = 0, COILS + 1
         share = 0.25_wp + 0.5_wp*(k - 1)/(COILS - 1)
         if (k == 0) share = 0.0_wp
         if (k > COILS) share = 1.0_wp
         places(:, k + 1) = ends(:, 1) + share*(ends(:, 2) - ends(:, 1))
         us(:, k + 1) = moves(:, 1) + share*(moves(:, 2) - moves(:, 1))
         if (k > 1 .and. k < COILS) places(:, k + 1) = places(:, k + 1) + (2*mod(k, 2) - 1)*HALF_COIL*across
      end do
      call put_path(symbols, us, places)
      if (spring%node(2) > 0) return
      call put_stroke(symbols, moves(:, 1), reshape([ends(:, 2) + HALF_GROUND*across, ends(:, 2) - HALF_GROUND*across], [2, 2]))
   end subroutine put_spring

   !> Dotted lines from the first node of an equation to the others.
   subroutine put_equations(symbols)
      type(symbols_t), intent(inout) :: symbols
      integer(ip) :: i, k, n, every, drawn

      associate (rows => symbols%model%bilateral)
         n = count([(rows%kind(i) == ROW_EQUATION, i=1, rows%n)], kind=ip)
         if (n == 0) return
         every = 1 + n/MOST_LINES
         drawn = 0
         call begin_block(symbols, 'equations', '', EQUATIONS//' title "equations ('//to_text(n)//')"')
         do i = 1, rows%n
            if (rows%kind(i) /= ROW_EQUATION) cycle
            drawn = drawn + 1
            if (mod(drawn, every) /= 0) cycle
            do k = rows%first(i) + 1, rows%first(i + 1) - 1
               associate (nodes => [rows%node(rows%first(i)), rows%node(k)])
                  if (any(nodes > symbols%model%mesh%n_nodes)) cycle
                  call put_path(symbols, symbols%u(:, nodes), symbols%model%mesh%x(:, nodes))
               end associate
            end do
         end do
      end associate
   end subroutine put_equations

   !> Markers along a pre-tension section, and arrows in its middle that pull the sides together.
   subroutine put_sections(symbols)
      type(symbols_t), intent(inout) :: symbols
      integer(ip), allocatable :: rows(:), nodes(:)
      integer(ip) :: b, i, k
      real(wp) :: middle(2), move(2), arrow(2)
      character(len=:), allocatable :: section_text

      if (.not. allocated(symbols%model%rigid_bodies)) return
      do b = 1, size(symbols%model%rigid_bodies, kind=ip)
         if (.not. symbols%model%rigid_bodies(b)%is_section) cycle
         associate (all_rows => symbols%model%bilateral)
            ! of two rows a node the first is along the normal: it has a third entry
            rows = pack([(i, i=1, all_rows%n)], [(all_rows%kind(i) == ROW_SECTION .and. all_rows%part(i) == b .and. &
                                                  all_rows%first(i + 1) - all_rows%first(i) == 3, i=1, all_rows%n)])
            nodes = all_rows%node(all_rows%first(rows))
            ! `, force 1000 [F]`
            section_text = ''
            associate (node => symbols%model%rigid_bodies(b)%node, now => symbols%model%steps(symbols%step))
               do k = 1, now%rigid_loads%n
                  if (now%rigid_loads%node(k) == node) section_text = ', force '//to_text(end_value(symbols, now%rigid_loads, k), &
                                                                                          4)//' [F]'
               end do
               do k = 1, now%rigid_prescribed%n
                  if (now%rigid_prescribed%node(k) /= node .or. now%rigid_prescribed%dof(k) /= 1) cycle
                  section_text = ', taken out '//to_text(end_value(symbols, now%rigid_prescribed, k), 4)//' [L]'
               end do
            end associate
            call begin_block(symbols, 'a pre-tension section', ':(dot*$5)', 'with points pt 13 ps variable '//SECTIONS// &
                             ' title "pre-tension section'//section_text//'"')
            nodes = pack(nodes, thinned(symbols%model%mesh%x(:, nodes), BETWEEN*symbols%pixel))
            do i = 1, size(nodes, kind=ip)
               call put_point(symbols, symbols%u(:, nodes(i)), symbols%model%mesh%x(:, nodes(i)), [1.0_wp])
            end do
            middle = sum(symbols%model%mesh%x(:, nodes), dim=2)/size(nodes)
            move = sum(symbols%u(:, nodes), dim=2)/size(nodes)
            arrow = PULL*symbols%pixel*all_rows%vector(:, all_rows%first(rows(1)))
            call begin_block(symbols, 'its force', ':5:6', ARROW_LOOKS//' lw 1.8 '//SECTIONS)
            call put_arrow(symbols, move, middle - 1.2_wp*arrow, arrow)
            call put_arrow(symbols, move, middle + 1.2_wp*arrow, -arrow)
         end associate
      end do
   end subroutine put_sections

   !> Reference nodes of rigid surfaces; a square round those whose rotation is held.
   subroutine put_references(symbols)
      type(symbols_t), intent(inout) :: symbols
      real(wp) :: place(2), h
      integer(ip) :: i

      if (.not. allocated(symbols%model%rigid_bodies)) return
      if (.not. any(.not. symbols%model%rigid_bodies%is_section)) return
      call begin_block(symbols, 'reference nodes', ':(dot*$5)', 'with points pt 7 ps variable lc rgb "#202020"'// &
                       ' title "reference nodes, in squares: no rotation"')
      do i = 1, size(symbols%model%rigid_bodies, kind=ip)
         associate (body => symbols%model%rigid_bodies(i))
            if (body%is_section) cycle
            call put_point(symbols, symbols%u(:, body%node), place_of_node(symbols, body%node), [1.0_wp])
         end associate
      end do
      h = HALF_SQUARE*symbols%pixel
      associate (held => symbols%model%steps(symbols%step)%rigid_prescribed)
         if (count(held%dof(:held%n) > 2) == 0) return
         call begin_block(symbols, 'rotations that are prescribed', '', 'with lines lt 1 lw 1.3 lc rgb "#202020"')
         do i = 1, held%n
            if (held%dof(i) <= 2) cycle
            place = place_of_node(symbols, held%node(i))
            call put_stroke(symbols, symbols%u(:, held%node(i)), reshape([place + [-h, -h], place + [h, -h], place + [h, h], &
                                                                          place + [-h, h], place + [-h, -h]], [2, 5]))
         end do
      end associate
   end subroutine put_references

end module atrito_link_symbols
