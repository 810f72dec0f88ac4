!> What a line of *DLOAD or *DSLOAD says of a load: pressure, traction along a direction, hydrostatic pressure, and the axis of
!> CENTRIF about which elements turn.
!>
!> The way from that axis, of direction a through x0, is S (x - x0): S = 1 for an axis across the plane, S = 1 - a a' for one that
!> lies in it. An oblique axis would push out of the plane.
module atrito_read_load
   use atrito_coordinates, only: get_reals
   use atrito_deck, only: data_line_t, token_t, line_item
   use atrito_diagnostics, only: report_error
   use atrito_build_context, only: build_context_t, line_token, open_line
   use atrito_faces, only: face_list_t
   use atrito_items, only: get_real
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_nodes
   use atrito_model, only: LOAD_PRESSURE, LOAD_TRACTION, LOAD_HYDROSTATIC
   use atrito_parameters, only: evaluate_function
   use atrito_shape_functions, only: face_shape_values
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_face_load, read_face_function, read_direction, read_spin, has_no_rest, magnitude_of

   character(len=*), parameter :: LEVEL = 'level x2 of zero pressure, a real [L]'
   character(len=*), parameter :: LEVEL_OF_MAGNITUDE = 'another level x2, of the magnitude, a real [L]'

   real(wp), parameter :: FLAT = 1.0e-10_wp            ! of a direction: it lies in the plane

   integer(ip), parameter :: FIRST = 4, AXIS = 7       !< items of CENTRIF: point, direction
   character(len=*), parameter :: WHAT_POINT = 'a point of the axis, x, y, z [L]', &
                                  WHAT_AXIS = 'direction of the axis, ax, ay, az, in the plane or across it, not all 0 [-]'

contains

   !> The kind and the values of a load on faces from the third item on: P magnitude; TRVEC magnitude, t1, t2[, 0]; HP magnitude,
   !> level of zero pressure, level of the magnitude.
   subroutine read_face_load(context, label, keyword, kind, value, ok)
      type(build_context_t), intent(in) :: context     !< its open line is read
      character(len=*), intent(in) :: label            !< P, TRVEC or HP, of *DLOAD with a digit behind
      character(len=*), intent(in) :: keyword          !< of the card, for `atrito help KEYWORD`
      integer(ip), intent(out) :: kind                 !< LOAD_*
      real(wp), intent(out) :: value(3)                !< as element_load_t has it
      logical, intent(out) :: ok                       !< no error was reported
      real(wp) :: magnitude, direction(2)
      logical :: good(3)

      value = 0.0_wp
      call get_real(context%deck, line_token(context, 3_ip), magnitude_of(label), magnitude, good(1))
      good(2) = has_no_rest(context, label, keyword)
      good(3) = .true.
      select case (label(1:1))
      case ('T')
         kind = LOAD_TRACTION
         call read_direction(context, 'traction', direction, good(3))
         if (good(3)) value(:2) = magnitude*direction
      case ('H')
         kind = LOAD_HYDROSTATIC
         value(1) = magnitude
         if (good(2)) then
            call get_real(context%deck, line_token(context, 4_ip), LEVEL, value(2), good(3))
            call get_real(context%deck, line_token(context, 5_ip), LEVEL_OF_MAGNITUDE, value(3), ok)
            good(3) = good(3) .and. ok
            if (good(3) .and. .not. abs(value(2) - value(3)) > 0.0_wp) then
               good(3) = .false.
               call report_error(context%deck, line_token(context, 5_ip), 'E-VALUE', 'the pressure is zero at this level', &
                                 expected=LEVEL_OF_MAGNITUDE)
            end if
         end if
      case default
         kind = LOAD_PRESSURE
         value(1) = magnitude
      end select
      ok = all(good)
   end subroutine read_face_load

   !> The same where the magnitude is a function of the place: of P linear on each face, of TRVEC, whose direction stands behind it,
   !> uniform; as at the points of Gauss, so that the resultant of each face is that of the function up to the fourth order.
   subroutine read_face_function(context, label, faces, kind, values, ok)
      type(build_context_t), intent(in) :: context     !< its open line and mesh are read
      character(len=*), intent(in) :: label            !< P or TRVEC
      type(face_list_t), intent(in) :: faces           !< on which the load acts
      integer(ip), intent(out) :: kind                 !< LOAD_PRESSURE or LOAD_TRACTION
      real(wp), allocatable, intent(out) :: values(:, :) !< of each face, as element_load_t has it
      logical, intent(out) :: ok                       !< no error was reported
      real(wp), parameter :: GAUSS(2) = [-1.0_wp, 1.0_wp]/sqrt(3.0_wp)
      type(token_t) :: expression, last
      real(wp) :: x(2, 2*faces%n), p(2*faces%n), direction(2), along(2)
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: i, k, rest

      allocate (values(3, faces%n), source=0.0_wp)
      kind = merge(LOAD_TRACTION, LOAD_PRESSURE, label == 'TRVEC')
      rest = merge(2_ip, 0_ip, label == 'TRVEC')
      associate (line => open_line(context))
         ok = line%n_tokens > 2 + rest .and. label /= 'HP'
         if (.not. ok) then
            call report_error(context%deck, line_token(context, 2_ip), 'E-VALUE', trim(merge('HP with FUNCTION     ', &
                                                                                             'no direction of TRVEC', &
                                                                                             label == 'HP')), &
                              expected='P, function; or TRVEC, function, t1, t2')
            return
         end if
         expression = line_item(context%deck, line, 3_ip)
         last = line_item(context%deck, line, line%n_tokens - rest)
         expression%last = last%last                   ! commas belong to the expression: max(x, y)
         if (rest > 0) call read_direction(context, 'traction', direction, ok, line%n_tokens - 1)
      end associate
      if (.not. ok) return
      do i = 1, faces%n
         nodes = face_nodes(context%model%mesh, faces%element(i), faces%face(i))
         do k = 1, 2
            x(:, 2*i - 2 + k) = matmul(context%model%mesh%x(:, nodes), face_shape_values(size(nodes, kind=ip), GAUSS(k)))
         end do
      end do
      call evaluate_function(context%deck, expression, x, p, ok, 'DSLOAD')
      do i = 1, merge(faces%n, 0_ip, ok)
         associate (a => x(:, 2*i - 1), b => x(:, 2*i), mean => 0.5_wp*(p(2*i - 1) + p(2*i)))
            if (rest > 0) then
               values(:2, i) = mean*direction
            else
               along = (b - a)/dot_product(b - a, b - a)
               values(2:, i) = (p(2*i) - p(2*i - 1))*along
               values(1, i) = mean - dot_product(values(2:, i), 0.5_wp*(a + b))
            end if
         end associate
      end do
   end subroutine read_face_function

   !> How many items a load has: 1,5 is no pressure of 1.5.
   logical function has_no_rest(context, label, keyword)
      type(build_context_t), intent(in) :: context     !< its open line is read
      character(len=*), intent(in) :: label, keyword   !< of the load; of the card
      type(data_line_t) :: line
      integer(ip) :: most
      character(len=:), allocatable :: rest

      most = 3
      rest = ''
      if (label(1:1) == 'H') then
         most = 5
         rest = ', level of zero pressure, level of the magnitude [L]'
      else if (label(1:1) == 'T' .or. label(1:1) == 'G') then
         most = 6
      else if (label(1:1) == 'C') then
         most = 9
      end if
      line = open_line(context)
      has_no_rest = line%n_tokens <= most
      if (has_no_rest) return
      call report_error(context%deck, line_token(context, most + 1), 'E-ITEMS', to_text(line%n_tokens)//' items, where '// &
                        to_text(most)//' belong', expected=trim(merge('surface', 'element', keyword == 'DSLOAD'))//', '//label// &
                        ', '//magnitude_of(label)//rest)
   end function has_no_rest

   !> What the magnitude of a load with this label is, for messages.
   pure function magnitude_of(label) result(what)
      character(len=*), intent(in) :: label      !< as the deck has it, in capitals
      character(len=:), allocatable :: what

      select case (label(1:1))
      case ('P')
         what = 'pressure, positive pushes on the element, a real [F/L^2]'
      case ('T')
         what = 'traction, a real [F/L^2]'
      case ('H')
         what = 'pressure at the second level, a real [F/L^2]'
      case ('B')
         what = 'force per volume, a real [F/L^3]'
      case ('C')
         what = 'square of the angular velocity, a real >= 0 [1/T^2]'
      case default
         what = 'acceleration, a real [L/T^2]'
      end select
   end function magnitude_of

   !> The unit vector of items 4 to 6, or of those from another one on, of any length.
   subroutine read_direction(context, what, direction, ok, first)
      type(build_context_t), intent(in) :: context     !< its open line is read
      character(len=*), intent(in) :: what             !< has the direction
      real(wp), intent(out) :: direction(2)            !< unit vector [-]; 0 where not ok
      logical, intent(out) :: ok                       !< no error was reported
      integer(ip), intent(in), optional :: first       !< item of the first component; default 4
      character(len=:), allocatable :: wanted
      integer(ip) :: item
      real(wp) :: d(3)

      direction = 0.0_wp
      wanted = 'direction of '//what//', two components, not both 0 [-]'
      if (what == 'gravity') wanted = 'direction of gravity, gx, gy, not both 0 [-]'
      item = 4
      if (present(first)) item = first
      call get_reals(context%deck, open_line(context), item, wanted, d, ok, spread(0.0_wp, 1, 3))
      if (.not. ok) return
      if (abs(d(3)) <= FLAT*maxval(abs(d(:2)))) d(3) = 0.0_wp ! what a cosine of 90 degrees leaves
      ok = .not. abs(d(3)) > 0.0_wp .and. maxval(abs(d)) > 0.0_wp
      if (abs(d(3)) > 0.0_wp) then
         call report_error(context%deck, line_token(context, item + 2), 'E-VALUE', 'the scene is plane: '// &
                           trim(merge('gz                 ', 'the third component', what == 'gravity'))//' is not 0', &
                           expected=trim(merge('gz = 0', '0     ', what == 'gravity')))
      else if (.not. ok) then
         call report_error(context%deck, line_token(context, item), 'E-VALUE', what//' has no direction', expected=wanted)
      else
         d = d/maxval(abs(d))
         direction = d(:2)/norm2(d(:2))
      end if
   end subroutine read_direction

   !> The axis of items 4 to 9, and the way from it: way(1:3) are S11, S12, S22, and S x0 is -there.
   subroutine read_spin(context, square, is_ring, way, there, ok)
      type(build_context_t), intent(in) :: context     !< its open line is read
      real(wp), intent(in) :: square                   !< item 3, of the angular velocity [1/T^2]
      logical, intent(in) :: is_ring                   !< axisymmetric elements: the axis is x2
      real(wp), intent(out) :: way(3), there(2)        !< [-], [L]
      logical, intent(out) :: ok                       !< no error was reported
      real(wp) :: point(3), a(3)
      logical :: good(2)

      way = 0.0_wp
      there = 0.0_wp
      ok = square >= 0.0_wp
      if (.not. ok) call report_error(context%deck, line_token(context, 3_ip), 'E-VALUE', &
                                      'the square of an angular velocity is negative', expected=magnitude_of('CENTRIF'))
      call get_reals(context%deck, open_line(context), FIRST, WHAT_POINT, point, good(1), spread(0.0_wp, 1, 3))
      call get_reals(context%deck, open_line(context), AXIS, WHAT_AXIS, a, good(2), spread(0.0_wp, 1, 3))
      ok = ok .and. all(good)
      if (.not. ok) return
      if (maxval(abs(a)) > 0.0_wp) a = a/maxval(abs(a))
      call check_axis()
      if (.not. ok) return
      if (is_ring) then
         way(1) = 1.0_wp
      else if (abs(a(3)) > 0.0_wp) then
         way = [1.0_wp, 0.0_wp, 1.0_wp]
      else
         a = a/norm2(a)
         way = [a(2)*a(2), -a(1)*a(2), a(1)*a(1)]
      end if
      there = -[way(1)*point(1) + way(2)*point(2), way(2)*point(1) + way(3)*point(2)]

   contains

      subroutine check_axis()
         logical :: is_across

         ok = .false.
         is_across = abs(a(3)) > 0.0_wp
         if (.not. any(abs(a) > 0.0_wp)) then
            call report_error(context%deck, line_token(context, AXIS), 'E-VALUE', 'the axis of CENTRIF has no direction', &
                              expected=WHAT_AXIS)
         else if (is_ring .and. (is_across .or. abs(a(1)) > 0.0_wp .or. abs(point(1)) > 0.0_wp .or. abs(point(3)) > 0.0_wp)) then
            call report_error(context%deck, line_token(context, FIRST), 'E-VALUE', &
                              'axisymmetric elements turn about the axis y alone', &
                              expected='0, 0, 0, 0, 1, 0: a point of the axis and its direction')
         else if (is_across .and. any(abs(a(:2)) > 0.0_wp)) then
            call report_error(context%deck, line_token(context, AXIS), 'E-VALUE', &
                              'an oblique axis of CENTRIF pushes out of the plane', expected=WHAT_AXIS)
         else if (.not. is_across .and. abs(point(3)) > 0.0_wp) then
            call report_error(context%deck, line_token(context, FIRST + 2), 'E-VALUE', &
                              'an axis of CENTRIF beside the plane pushes out of it', expected='z = 0 [L]')
         else
            ok = .true.
         end if
      end subroutine check_axis
   end subroutine read_spin

end module atrito_read_load
