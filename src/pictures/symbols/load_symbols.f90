!> Symbols of loads: arrows at nodes, along loaded faces and over the bodies, with the resultants in the legend; discs where the
!> temperature changes.
!>
!> A load that pushes on the body has its tips there, one that pulls begins there. Arrows are as long as the loads are large, within
!> each kind.
module atrito_load_symbols
   use atrito_drawing, only: largest_length
   use atrito_face_symbols, only: put_face_loads
   use atrito_kinds, only: ip, wp
   use atrito_load_resultants, only: force_t, load_resultants
   use atrito_mesh, only: mesh_t, side_count
   use atrito_model, only: nodal_values_t, LOAD_BODY, LOAD_LINEAR
   use atrito_strings, only: to_text
   use atrito_symbols, only: symbols_t, begin_block, end_block, put_stroke, put_arrow, put_point, thinned, thinned_nodes, &
                             find_outward, end_value, load_factor, place_of_node, is_section_node, arrow_at, ARROW_LOOKS
   implicit none (type, external)
   private
   public :: put_loads, force_text

   !> Lengths in pixels.
   real(wp), parameter :: LONGEST_FORCE = 52.0_wp, BETWEEN_FORCES = 10.0_wp, RADIUS = 16.0_wp, &
                          LONGEST_BODY = 32.0_wp, BETWEEN_BODY = 64.0_wp, BETWEEN_DISCS = 26.0_wp
   real(wp), parameter :: LEAST_SHARE = 0.3_wp      !< of the longest arrow over a body
   real(wp), parameter :: ROUND_OFF = 1.0e-12_wp    !< of a resultant: a component below it is told as 0
   integer, parameter :: PIECES = 24                !< of an arc
   character(len=*), parameter :: FORCES = ' lw 2 lc rgb "#C8102E"', BODY = ' lw 1.2 lc rgb "#8A1C5B"'

contains

   !> Puts the loads of a step, as they are at its end.
   subroutine put_loads(symbols)
      type(symbols_t), intent(inout) :: symbols
      type(force_t) :: concentrated, on_faces, in_bodies

      associate (now => symbols%model%steps(symbols%step))
         call load_resultants(symbols%model, concentrated, on_faces, in_bodies, symbols%step)
         if (now%node_loads%n + now%rigid_loads%n > 0) then
            call put_forces(force_text(concentrated), symbols)
            call put_moments(symbols)
         end if
         if (now%element_loads%n > 0) then
            call put_body_loads(force_text(in_bodies), symbols)
            call put_face_loads('loads on faces, resultant '//force_text(on_faces), symbols)
         end if
         if (allocated(now%heating)) call put_temperatures(now%heating, symbols)
      end associate
   end subroutine put_loads

   !> `(0, -12) [F]`
   pure function force_text(force) result(text)
      type(force_t), intent(in) :: force
      character(len=:), allocatable :: text
      real(wp) :: f(2)

      f = force%f
      where (abs(f) <= ROUND_OFF*maxval(abs(f))) f = 0.0_wp
      text = '('//to_text(f(1), 4)//', '//to_text(f(2), 4)//') [F]'
   end function force_text

   !> Forces at nodes, each with all that acts there.
   subroutine put_forces(resultant, symbols)
      character(len=*), intent(in) :: resultant
      type(symbols_t), intent(inout) :: symbols
      real(wp), allocatable :: force(:, :), outward(:, :)
      real(wp) :: largest, from(2), arrow(2)
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: i

      allocate (force(2, symbols%model%mesh%n_nodes), source=0.0_wp)
      call add_forces(symbols, symbols%model%steps(symbols%step)%node_loads, force)
      call add_forces(symbols, symbols%model%steps(symbols%step)%rigid_loads, force)
      largest = largest_length(force)
      if (.not. largest > 0.0_wp) return
      nodes = thinned_nodes(symbols, pack([(i, i=1, size(force, 2, kind=ip))], abs(force(1, :)) + abs(force(2, :)) > 0.0_wp), &
                            BETWEEN_FORCES)
      outward = find_outward(symbols%model%mesh)
      call begin_block(symbols, 'forces at nodes', ':5:6', ARROW_LOOKS//FORCES//' title "forces at nodes, resultant '// &
                       resultant//'"')
      do i = 1, size(nodes, kind=ip)
         call arrow_at(place_of_node(symbols, nodes(i)), force(:, nodes(i))/largest, outward(:2, nodes(i)), &
                       LONGEST_FORCE*symbols%pixel, from, arrow)
         call put_arrow(symbols, symbols%u(:, nodes(i)), from, arrow)
      end do
      call end_block(symbols)
   end subroutine put_forces

   subroutine add_forces(symbols, list, force)
      type(symbols_t), intent(in) :: symbols
      type(nodal_values_t), intent(in) :: list
      real(wp), intent(inout) :: force(:, :)        !< (2, n_nodes) [F]
      integer(ip) :: i

      do i = 1, list%n
         if (list%dof(i) > 2 .or. is_section_node(symbols%model, list%node(i))) cycle
         force(list%dof(i), list%node(i)) = force(list%dof(i), list%node(i)) + end_value(symbols, list, i)
      end do
   end subroutine add_forces

   !> Moments at reference nodes: three quarters of a circle, which the head ends.
   subroutine put_moments(symbols)
      type(symbols_t), intent(inout) :: symbols
      real(wp) :: arc(2, PIECES), angle, value
      integer(ip) :: i
      integer :: k

      associate (loads => symbols%model%steps(symbols%step)%rigid_loads)
         do i = 1, loads%n
            value = end_value(symbols, loads, i)
            if (loads%dof(i) <= 2 .or. .not. abs(value) > 0.0_wp) cycle
            do k = 1, PIECES
               angle = sign(1.0_wp, value)*1.5_wp*acos(-1.0_wp)*real(k - 1, wp)/real(PIECES - 1, wp)
               arc(:, k) = place_of_node(symbols, loads%node(i)) + RADIUS*symbols%pixel*[cos(angle), sin(angle)]
            end do
            call begin_block(symbols, 'a moment', '', 'with lines lt 1'//FORCES)
            call put_stroke(symbols, symbols%u(:, loads%node(i)), arc)
            call end_block(symbols)
            call begin_block(symbols, 'its head', ':5:6', ARROW_LOOKS//FORCES//' title "moment '//to_text(value, 4)//' [F L]"')
            call put_arrow(symbols, symbols%u(:, loads%node(i)), arc(:, PIECES - 1), 2*(arc(:, PIECES) - arc(:, PIECES - 1)))
            call end_block(symbols)
         end do
      end associate
   end subroutine put_moments

   !> Forces per volume: arrows at the middles of elements, far apart.
   subroutine put_body_loads(resultant, symbols)
      character(len=*), intent(in) :: resultant
      type(symbols_t), intent(inout) :: symbols
      real(wp), allocatable :: density(:, :), places(:, :)
      real(wp) :: largest, share(2), arrow(2)
      integer(ip), allocatable :: elements(:)
      integer(ip) :: i

      associate (mesh => symbols%model%mesh)
         call sum_densities(symbols, density)
         largest = largest_length(density)
         if (.not. largest > 0.0_wp) return
         elements = pack([(i, i=1, mesh%n_elements)], abs(density(1, :)) + abs(density(2, :)) > 0.0_wp)
         allocate (places(2, mesh%n_elements))
         do i = 1, size(elements, kind=ip)
            places(:, elements(i)) = mean_of(mesh, mesh%x, elements(i))
         end do
         elements = pack(elements, thinned(places(:, elements), BETWEEN_BODY*symbols%pixel))
         call begin_block(symbols, 'body loads', ':5:6', ARROW_LOOKS//BODY//' title "body loads, resultant '//resultant//'"')
         do i = 1, size(elements, kind=ip)
            share = density(:, elements(i))/largest
            if (norm2(share) < LEAST_SHARE) share = share*(LEAST_SHARE/norm2(share))
            arrow = LONGEST_BODY*symbols%pixel*share
            call put_arrow(symbols, mean_of(mesh, symbols%u, elements(i)), places(:, elements(i)) - 0.5_wp*arrow, arrow)
         end do
         call end_block(symbols)
      end associate
   end subroutine put_body_loads

   !> The force per volume in the middle of each element.
   subroutine sum_densities(symbols, density)
      type(symbols_t), intent(in) :: symbols
      real(wp), allocatable, intent(out) :: density(:, :)   !< (2, n_elements) [F/L^3]
      real(wp) :: x(2), value(3), factor
      integer(ip) :: i, e

      allocate (density(2, symbols%model%mesh%n_elements), source=0.0_wp)
      associate (loads => symbols%model%steps(symbols%step)%element_loads)
         do i = 1, loads%n
            e = loads%element(i)
            value = loads%value(:3, i)
            factor = load_factor(symbols, i)
            if (loads%kind(i) == LOAD_BODY) then
               density(:, e) = density(:, e) + factor*value(:2)
            else if (loads%kind(i) == LOAD_LINEAR) then
               x = mean_of(symbols%model%mesh, symbols%model%mesh%x, e)
               density(:, e) = density(:, e) + factor*[value(1)*x(1) + value(2)*x(2), value(2)*x(1) + value(3)*x(2)]
            end if
         end do
      end associate
   end subroutine sum_densities

   !> The mean over the corners of an element.
   pure function mean_of(mesh, values, element) result(mean)
      type(mesh_t), intent(in) :: mesh
      real(wp), intent(in) :: values(:, :)          !< (2, n_nodes)
      integer(ip), intent(in) :: element
      real(wp) :: mean(2)
      integer(ip) :: n

      n = side_count(mesh, element)
      mean = sum(values(:, mesh%nodes(:n, element)), dim=2)/n
   end function mean_of

   !> Discs whose area grows with the change, of one colour where it grows warmer and another where colder.
   subroutine put_temperatures(heating, symbols)
      real(wp), intent(in) :: heating(:)            !< (n_nodes)
      type(symbols_t), intent(inout) :: symbols
      character(len=*), parameter :: WORD(2) = ['warmer', 'colder'], TINT(2) = ['#70E6550D', '#704292C6']
      real(wp) :: largest
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: i, k

      largest = maxval(abs(heating))
      if (.not. largest > 0.0_wp) return
      associate (mesh => symbols%model%mesh)
         do k = 1, 2
            nodes = pack([(i, i=1, mesh%n_nodes)], (3 - 2*k)*heating(:mesh%n_nodes) > 0.0_wp)
            if (size(nodes) == 0) cycle
            call begin_block(symbols, WORD(k)//' nodes', ':(dot*$5)', 'with points pt 7 ps variable lc rgb "'//TINT(k)// &
                             '" title "'//WORD(k)//' by up to '//to_text(maxval(abs(heating(nodes))), 4)//'"')
            nodes = pack(nodes, thinned(mesh%x(:, nodes), BETWEEN_DISCS*symbols%pixel))
            do i = 1, size(nodes, kind=ip)
               call put_point(symbols, symbols%u(:, nodes(i)), mesh%x(:, nodes(i)), [1.8_wp*sqrt(abs(heating(nodes(i)))/largest)])
            end do
            call end_block(symbols)
         end do
      end associate
   end subroutine put_temperatures

end module atrito_load_symbols
