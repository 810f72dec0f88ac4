!> *PATH PRINT: the lines and arcs that a step asks for, and the elements that hold their points.
module atrito_build_paths
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_build_context, only: build_context_t
   use atrito_deck, only: card_t, data_line_t, token_t, line_item
   use atrito_diagnostics, only: report_error, report_note
   use atrito_element_places, only: find_nearest, find_places, place_t
   use atrito_items, only: get_real, option_integer, option_word, refuse_option
   use atrito_kinds, only: ip, wp
   use atrito_line_cards, only: elements_to_cross, name_line, note_line, read_line_options
   use atrito_model, only: path_t, requests_t
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: read_path_card, place_paths

   character(len=*), parameter :: WHAT_POINTS = 'points on the path, 2 to 100000'
   integer(ip), parameter :: MOST_POINTS = 100000
   real(wp), parameter :: DEGREE = acos(-1.0_wp)/180.0_wp

contains

   !> The paths of a card, a line each.
   subroutine read_path_card(context, card, requests)
      type(build_context_t), intent(inout) :: context      !< its model gets paths
      type(card_t), intent(in) :: card                     !< *PATH PRINT
      type(requests_t), intent(inout) :: requests          !< of the step; gets places of paths
      character(len=:), allocatable :: name
      type(token_t) :: place
      type(path_t) :: path
      integer(ip) :: i
      logical :: found, ok

      call read_line_options(context, card, name, place, path%elset, ok)
      if (.not. ok) return
      call option_integer(context%deck, card, 'POINTS', WHAT_POINTS, path%n_points, found)
      if (path%n_points < 2 .or. path%n_points > MOST_POINTS) then
         call refuse_option(context%deck, card, 'POINTS', WHAT_POINTS)
         return
      end if
      path%is_arc = option_word(context%deck, card, 'TYPE') == 'ARC'
      do i = 1, card%n_lines
         associate (line => context%deck%lines(card%first_line + i - 1))
            if (.not. line%ok) cycle
            call name_line(context, card, i, name, place, context%drawn_paths, path%name, ok)
            if (.not. ok) return
            call read_line(context, line, path, ok)
         end associate
         if (.not. ok) cycle
         call note_line(context, card, i, path%name, context%drawn_paths)
         if (.not. allocated(context%model%paths)) allocate (context%model%paths(size(context%drawn_paths%items)))
         if (.not. allocated(requests%paths)) allocate (requests%paths(0))
         context%model%paths(context%drawn_paths%n) = path
         requests%paths = [requests%paths, context%drawn_paths%n]
      end do
   end subroutine read_path_card

   !> x1, y1, x2, y2[, xc, yc], or xc, yc, r, a1, a2.
   subroutine read_line(context, line, path, ok)
      type(build_context_t), intent(in) :: context
      type(data_line_t), intent(in) :: line
      type(path_t), intent(inout) :: path
      logical, intent(out) :: ok
      character(len=*), parameter :: OF_LINE(6) = ['x1', 'y1', 'x2', 'y2', 'xc', 'yc'], OF_ARC(6) = ['xc', 'yc', 'r ', 'a1', &
                                                                                                     'a2', '  ']
      character(len=:), allocatable :: wrong, expected
      real(wp) :: x(6)
      logical :: good(6)
      integer(ip) :: k

      x = 0.0_wp
      good = .true.
      do k = 1, line%n_tokens
         call get_real(context%deck, line_item(context%deck, line, k), trim(merge(OF_ARC(k), OF_LINE(k), path%is_arc))// &
                       ', a real', x(k), good(k))
      end do
      ok = all(good)
      if (.not. ok) return
      if (path%is_arc) then
         path%centre = x(1:2)
         path%radius = x(3)
         path%angles = x(4:5)*DEGREE
         ok = x(3) > 0.0_wp .and. abs(x(5) - x(4)) > 0.0_wp .and. abs(x(5) - x(4)) <= 360.0_wp
         wrong = 'this is no arc'
         expected = 'a radius > 0 [L], and two angles that differ by at most 360 [degrees]'
      else
         path%ends = reshape(x(:4), [2, 2])
         path%centre = x(5:6)
         path%has_centre = line%n_tokens > 4
         ok = any(abs(path%ends(:, 1) - path%ends(:, 2)) > 0.0_wp)
         wrong = 'both ends of the path are the same'
         expected = 'x1, y1, x2, y2: two points [L]'
      end if
      if (.not. ok) call report_error(context%deck, line_item(context%deck, line, 3_ip), 'E-VALUE', wrong, expected=expected)
   end subroutine read_line

   !> Finds the elements that hold the points of the paths. The mesh is complete.
   subroutine place_paths(context)
      type(build_context_t), intent(inout) :: context      !< paths of its model get their elements and points
      type(bodies_t) :: bodies
      integer(ip) :: i

      if (.not. allocated(context%model%paths)) return
      context%model%paths = context%model%paths(:context%drawn_paths%n)
      call find_bodies(context%model%mesh, bodies)
      do i = 1, size(context%model%paths, kind=ip)
         call place_path(context, bodies, i)
      end do
   end subroutine place_paths

   subroutine place_path(context, bodies, i)
      type(build_context_t), intent(inout) :: context
      type(bodies_t), intent(in) :: bodies
      integer(ip), intent(in) :: i                         !< place in the model's paths
      real(wp), allocatable :: x(:, :), along(:, :), s(:)
      type(place_t), allocatable :: places(:)
      logical, allocatable :: wanted(:)
      logical :: is_held(context%model%paths(i)%n_points)
      character(len=:), allocatable :: text
      integer(ip) :: near, n_out, k
      real(wp) :: distance
      type(place_t) :: first

      associate (model => context%model, path => context%model%paths(i))
         wanted = elements_to_cross(model, path%elset)
         call lay_points(path, s, x, along)
         call find_places(model%mesh, wanted, x, places)
         ! Of several bodies at a point that in which the point before lies comes first.
         do k = 2, size(places, kind=ip) - 1
            if (places(k)%point /= places(k + 1)%point .or. places(k)%point == places(k - 1)%point) cycle
            associate (body => bodies%of_element(places(k - 1:k + 1)%element))
               if (body(1) /= body(3)) cycle
            end associate
            first = places(k + 1)
            places(k + 1) = places(k)
            places(k) = first
         end do
         is_held = .false.
         is_held(places%point) = .true.
         n_out = count(.not. is_held, kind=ip)
         text = 'outside of all bodies'
         if (path%elset > 0) text = 'outside of '//model%element_sets%sets(path%elset)%name
         if (size(places) == 0) then
            call find_nearest(model%mesh, wanted, x(:, 1), near, distance)
            call report_error(context%deck, context%drawn_paths%items(i), 'E-PATH', 'path '//path%name//' is '//text// &
                              '; its first point is '//to_text(distance, 3)//' from the nearest', &
                              expected='a line or an arc through a body')
         else if (n_out > 0) then
            call report_note(context%deck, context%drawn_paths%items(i), 'N-PATH', to_text(n_out)//' of the '// &
                             to_text(path%n_points)//' points of path '//path%name//' are '//text//': they have no rows')
         end if
         path%s = s(places%point)
         path%x = x(:, places%point)
         path%along = along(:, places%point)
         call move_alloc(places, path%place)
      end associate
   end subroutine place_path

   !> The points of a path, and its direction there.
   pure subroutine lay_points(path, s, x, along)
      type(path_t), intent(in) :: path
      real(wp), allocatable, intent(out) :: s(:)           !< arc length from the first point [L]
      real(wp), allocatable, intent(out) :: x(:, :)        !< (2, points) [L]
      real(wp), allocatable, intent(out) :: along(:, :)    !< (2, points) unit vectors
      real(wp) :: share, angle, step(2)
      integer(ip) :: k

      allocate (s(path%n_points), x(2, path%n_points), along(2, path%n_points))
      do k = 1, path%n_points
         share = real(k - 1, wp)/real(path%n_points - 1, wp)
         if (path%is_arc) then
            angle = (1.0_wp - share)*path%angles(1) + share*path%angles(2)
            s(k) = share*path%radius*abs(path%angles(2) - path%angles(1))
            x(:, k) = path%centre + path%radius*[cos(angle), sin(angle)]
            along(:, k) = sign(1.0_wp, path%angles(2) - path%angles(1))*[-sin(angle), cos(angle)]
         else
            step = path%ends(:, 2) - path%ends(:, 1)
            s(k) = share*norm2(step)
            x(:, k) = (1.0_wp - share)*path%ends(:, 1) + share*path%ends(:, 2)
            along(:, k) = step/norm2(step)
         end if
      end do
   end subroutine lay_points

end module atrito_build_paths
