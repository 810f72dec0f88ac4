!> Symbols of loads: arrows at nodes, over the bodies and along loaded faces, where a line joins their free ends and several loads
!> on a face are drawn as their sum, with the resultants in the legend; discs where the temperature changes.
!>
!> A load that pushes on the body has its tips there, one that pulls begins there. Arrows are as long as the loads are large, within
!> each kind.
module atrito_load_symbols
   use atrito_drawing, only: largest_length
   use atrito_element_table, only: MOST_SIDES
   use atrito_face_geometry, only: outward_normal
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip, wp
   use atrito_load_resultants, only: force_t, is_section_node, load_resultants
   use atrito_mesh, only: mesh_t, side_count, face_nodes
   use atrito_model, only: nodal_values_t, LOAD_BODY, LOAD_LINEAR, is_on_volume, LOAD_TRACTION, LOAD_HYDROSTATIC
   use atrito_shape_functions, only: face_shape_values
   use atrito_strings, only: to_text
   use atrito_symbols, only: symbols_t, begin_block, put_stroke, put_arrow, put_point, thinned, thinned_nodes, &
                             find_outward, end_value, load_factor, place_of_node, arrow_at, ARROW_LOOKS, put_path, SLANT
   implicit none (type, external)
   private
   public :: put_loads, force_text

   !> Lengths in pixels.
   real(wp), parameter :: LONGEST_FORCE = 52.0_wp, BETWEEN_FORCES = 10.0_wp, RADIUS = 16.0_wp, &
                          LONGEST_BODY = 32.0_wp, BETWEEN_BODY = 64.0_wp, BETWEEN_DISCS = 26.0_wp
   real(wp), parameter :: LEAST_SHARE = 0.3_wp      !< of the longest arrow over a body
   real(wp), parameter :: ROUND_OFF = 1.0e-12_wp    !< of a resultant: a component below it is printed as 0
   integer, parameter :: PIECES = 24                !< of an arc
   character(len=*), parameter :: FORCES = ' lw 2 lc rgb "#C8102E"', BODY = ' lw 1.2 lc rgb "#8A1C5B"'

   !> Lengths in pixels of what is drawn along faces.
   real(wp), parameter :: LONGEST_ON_FACE = 40.0_wp, LEAST = 9.0_wp, SPACING = 20.0_wp, PIECE = 8.0_wp, OFF = 5.0_wp, &
                          HALF_SHEAR = 13.0_wp
   integer(ip), parameter :: MOST_PIECES = 40
   real(wp), parameter :: AXIS_OF_SHEAR = 0.2_wp    !< a load whose normal part is less than this is drawn along the face
   character(len=*), parameter :: LINE_OF_ENDS = ' lt 1 lw 1 lc rgb "#C8102E"', &
                                  ARROWS_ON_FACE = ARROW_LOOKS//' lw 1.2 lc rgb "#C8102E"'

   !> The faces with loads.
   type :: loaded_faces_t
      integer(ip) :: n = 0                          !< faces; load has this length
      integer(ip), allocatable :: load(:)           !< (n) the last load of each
      integer(ip), allocatable :: next(:)           !< (loads) the one before it on the same face; 0: none
      real(wp) :: largest = 0.0_wp                  !< traction on them [F/L^2]
   end type loaded_faces_t

   !> A place of a loaded face, and what is drawn there.
   type :: spot_t
      real(wp) :: place(2) = 0.0_wp, u(2) = 0.0_wp  !< [L]
      real(wp) :: from(2) = 0.0_wp, arrow(2) = 0.0_wp   !< [L]
      logical :: is_shear = .false.                 !< the load goes along the face
   end type spot_t

contains

   !> Puts the loads of a step, as they are at its end.
   subroutine put_loads(symbols)
      type(symbols_t), intent(inout) :: symbols     !< its step is read; get blocks
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
      type(force_t), intent(in) :: force            !< f alone is read
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
            call begin_block(symbols, 'its head', ':5:6', ARROW_LOOKS//FORCES//' title "moment '//to_text(value, 4)//' [F L]"')
            call put_arrow(symbols, symbols%u(:, loads%node(i)), arc(:, PIECES - 1), 2*(arc(:, PIECES) - arc(:, PIECES - 1)))
         end do
      end associate
   end subroutine put_moments

   !> Forces per volume: arrows at the middles of elements, far apart.
   subroutine put_body_loads(resultant, symbols)
      character(len=*), intent(in) :: resultant
      type(symbols_t), intent(inout) :: symbols
      real(wp), allocatable :: density(:, :), places(:, :)
      real(wp) :: largest, share(2), arrow(2), x(2), value(3), factor
      integer(ip), allocatable :: elements(:)
      integer(ip) :: i, j, e

      associate (mesh => symbols%model%mesh)
         ! The force per volume in the middle of each element.
         allocate (density(2, symbols%model%mesh%n_elements), source=0.0_wp)
         associate (loads => symbols%model%steps(symbols%step)%element_loads)
            do j = 1, loads%n
               e = loads%element(j)
               factor = load_factor(symbols, j)
               if (loads%kind(j) == LOAD_BODY) then
                  density(:, e) = density(:, e) + factor*loads%value(:2, j)
               else if (loads%kind(j) == LOAD_LINEAR) then
                  x = mean_of(symbols%model%mesh, symbols%model%mesh%x, e)
                  value = loads%value(:3, j)
                  density(:, e) = density(:, e) + factor*[value(1)*x(1) + value(2)*x(2), value(2)*x(1) + value(3)*x(2)]
               end if
            end do
         end associate
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
      end associate
   end subroutine put_body_loads

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
         end do
      end associate
   end subroutine put_temperatures

   !> Puts the arrows of a step, as loads are at its end.
   subroutine put_face_loads(legend, symbols)
      character(len=*), intent(in) :: legend        !< of the arrows
      type(symbols_t), intent(inout) :: symbols
      type(loaded_faces_t) :: faces
      real(wp) :: traction(2)
      integer(ip) :: i, k, j, key, at
      type(id_map_t) :: known_faces
      logical :: known

      ! Each face once, with its loads one behind the other.
      associate (loads => symbols%model%steps(symbols%step)%element_loads)
         allocate (faces%load(loads%n), faces%next(loads%n), source=0_ip)
         do j = 1, loads%n
            if (is_on_volume(loads%kind(j))) cycle
            key = MOST_SIDES*(loads%element(j) - 1) + loads%face(j)
            call add_id(known_faces, key, faces%n + 1, known)
            at = find_id(known_faces, key)
            if (known) faces%next(j) = faces%load(at)
            faces%load(at) = j
            faces%n = max(faces%n, at)
         end do
      end associate
      do i = 1, faces%n
         do k = -1, 1
            traction = traction_on(symbols, faces, i, real(k, wp))
            faces%largest = max(faces%largest, hypot(traction(1), traction(2)))
         end do
      end do
      if (.not. faces%largest > 0.0_wp) return
      call put_lines_of_ends(faces, symbols)
      call put_arrows(faces, legend, symbols)
   end subroutine put_face_loads

   !> The force per area at a place of a face.
   pure function traction_on(symbols, faces, i, t) result(traction)
      type(symbols_t), intent(in) :: symbols
      type(loaded_faces_t), intent(in) :: faces
      integer(ip), intent(in) :: i
      real(wp), intent(in) :: t                     !< in [-1,1]
      real(wp) :: traction(2)                       !< [F/L^2]
      real(wp), allocatable :: x(:, :)
      real(wp) :: normal(2), depth, factor
      integer(ip) :: k

      traction = 0.0_wp
      x = symbols%model%mesh%x(:, nodes_of(symbols, faces%load(i)))
      normal = outward_normal(x, t)
      k = faces%load(i)
      associate (loads => symbols%model%steps(symbols%step)%element_loads)
         do while (k > 0)
            factor = load_factor(symbols, k)
            associate (value => loads%value(:, k))
               select case (loads%kind(k))
               case (LOAD_TRACTION)
                  traction = traction + factor*value(:2)
               case (LOAD_HYDROSTATIC)
                  depth = dot_product(x(2, :), face_shape_values(size(x, 2, kind=ip), t))
                  traction = traction - factor*value(1)*max(0.0_wp, (depth - value(2))/(value(3) - value(2)))*normal
               case default
                  traction = traction - factor*(value(1) + dot_product(value(2:), matmul(x, face_shape_values(size(x, 2, kind=ip), &
                                                                                                              t))))*normal
               end select
            end associate
            k = faces%next(k)
         end do
      end associate
   end function traction_on

   !> The nodes of the face of a load.
   pure function nodes_of(symbols, load) result(nodes)
      type(symbols_t), intent(in) :: symbols
      integer(ip), intent(in) :: load
      integer(ip), allocatable :: nodes(:)

      associate (loads => symbols%model%steps(symbols%step)%element_loads)
         nodes = face_nodes(symbols%model%mesh, loads%element(load), loads%face(load))
      end associate
   end function nodes_of

   !> Equal pieces of a face, none of which is shorter than a length.
   pure integer(ip) function pieces_of(symbols, nodes, least) result(n)
      type(symbols_t), intent(in) :: symbols
      integer(ip), intent(in) :: nodes(:)           !< of the face
      real(wp), intent(in) :: least                 !< [pixels]

      associate (x => symbols%model%mesh%x)
         n = int(min(norm2(x(:, nodes(2)) - x(:, nodes(1)))/(least*symbols%pixel), real(MOST_PIECES, wp)), ip)
      end associate
      n = max(1_ip, n)
   end function pieces_of

   !> What is drawn along a face, at the ends of its pieces.
   pure function spots_on(symbols, faces, i, least) result(spots)
      type(symbols_t), intent(in) :: symbols
      type(loaded_faces_t), intent(in) :: faces
      integer(ip), intent(in) :: i
      real(wp), intent(in) :: least                 !< length of a piece [pixels]
      type(spot_t), allocatable :: spots(:)         !< (pieces + 1)
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: k, n

      nodes = nodes_of(symbols, faces%load(i))
      n = pieces_of(symbols, nodes, least)
      allocate (spots(n + 1))
      do k = 0, n
         spots(k + 1) = spot_on(symbols, faces, i, nodes, 2*real(k, wp)/n - 1)
      end do
   end function spots_on

   !> What is drawn at a place of a face.
   pure type(spot_t) function spot_on(symbols, faces, i, nodes, t) result(spot)
      type(symbols_t), intent(in) :: symbols
      type(loaded_faces_t), intent(in) :: faces
      integer(ip), intent(in) :: i, nodes(:)        !< the face and its nodes
      real(wp), intent(in) :: t
      real(wp) :: n(size(nodes)), share(2), normal(2), length, along

      normal = outward_normal(symbols%model%mesh%x(:, nodes), t)
      n = face_shape_values(size(nodes, kind=ip), t)
      spot%place = matmul(symbols%model%mesh%x(:, nodes), n)
      spot%u = matmul(symbols%u(:, nodes), n)
      share = traction_on(symbols, faces, i, t)/faces%largest
      length = norm2(share)
      spot%from = spot%place
      spot%arrow = LONGEST_ON_FACE*symbols%pixel*share
      if (.not. length > 0.0_wp) return
      along = dot_product(share, normal)/length
      spot%is_shear = abs(along) < AXIS_OF_SHEAR
      if (spot%is_shear) then
         spot%arrow = 2*HALF_SHEAR*symbols%pixel*max(0.5_wp, length)/length*share
         spot%from = spot%place + OFF*symbols%pixel*normal - 0.5_wp*spot%arrow
      else if (along < -SLANT) then
         spot%from = spot%place - spot%arrow
      end if
   end function spot_on

   !> The lines that join the free ends, which show how a load goes along a side.
   subroutine put_lines_of_ends(faces, symbols)
      type(loaded_faces_t), intent(in) :: faces
      type(symbols_t), intent(inout) :: symbols
      real(wp) :: ends(2, MOST_PIECES + 1), moves(2, MOST_PIECES + 1)
      type(spot_t), allocatable :: spots(:)
      type(spot_t) :: middle
      integer(ip) :: i, k, n

      call begin_block(symbols, 'ends of the loads on faces', '', 'with lines'//LINE_OF_ENDS)
      do i = 1, faces%n
         middle = spot_on(symbols, faces, i, nodes_of(symbols, faces%load(i)), 0.0_wp)
         if (middle%is_shear) cycle
         spots = spots_on(symbols, faces, i, PIECE)
         n = size(spots, kind=ip)
         do k = 1, n
            ends(:, k) = spots(k)%from
            if (all(.not. abs(spots(k)%from - spots(k)%place) > 0.0_wp)) ends(:, k) = spots(k)%place + spots(k)%arrow
            moves(:, k) = spots(k)%u
         end do
         call put_path(symbols, moves(:, :n), ends(:, :n))
      end do
   end subroutine put_lines_of_ends

   !> The arrows, so far apart that they can be seen one by one.
   subroutine put_arrows(faces, legend, symbols)
      type(loaded_faces_t), intent(in) :: faces
      character(len=*), intent(in) :: legend
      type(symbols_t), intent(inout) :: symbols
      type(spot_t), allocatable :: spots(:)
      real(wp), allocatable :: places(:, :)
      integer(ip) :: i, n, first(faces%n + 1)       ! spots of each face

      first(1) = 1
      do i = 1, faces%n
         first(i + 1) = first(i) + pieces_of(symbols, nodes_of(symbols, faces%load(i)), SPACING) + 1
      end do
      n = first(faces%n + 1) - 1
      allocate (spots(n), places(2, n))
      do i = 1, faces%n
         spots(first(i):first(i + 1) - 1) = spots_on(symbols, faces, i, SPACING)
      end do
      do i = 1, n
         places(:, i) = spots(i)%place
      end do
      call begin_block(symbols, 'loads on faces', ':5:6', ARROWS_ON_FACE//' title "'//legend//'"')
      spots = pack(spots, thinned(places, SPACING*symbols%pixel))
      do i = 1, size(spots, kind=ip)
         if (norm2(spots(i)%arrow) >= LEAST*symbols%pixel) call put_arrow(symbols, spots(i)%u, spots(i)%from, spots(i)%arrow)
      end do
   end subroutine put_arrows

end module atrito_load_symbols
