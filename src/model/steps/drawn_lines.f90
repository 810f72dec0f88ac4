!> Lines that *SECTION PRINT and *PATH PRINT draw through the bodies: each data line one, which has a name in its step.
!>
!> Of a cut: where it goes through the bodies. Of a path, a line or an arc: the elements that hold its points.
module atrito_drawn_lines
   use atrito_bodies, only: bodies_t, find_bodies
   use atrito_body_names, only: name_bodies
   use atrito_build_context, only: build_context_t, place_text
   use atrito_build_parts, only: drawn_lines_t
   use atrito_crossings, only: find_cross_section, crossing_t, point_at, INSIDE
   use atrito_deck, only: card_t, count_lines, token_t, line_item, data_line_t
   use atrito_diagnostics, only: report_error, report_note, report_warning
   use atrito_element_places, only: find_nearest, find_places, place_t
   use atrito_faces, only: list_node_elements
   use atrito_items, only: option_text, get_real, has_option, option_integer, option_word, refuse_option
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t, cut_t, requests_t, path_t
   use atrito_name_list, only: add_name, find_name, name_list_t
   use atrito_references, only: find_set_option
   use atrito_sets, only: members_of
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: begin_lines_of_step, read_cut_card, place_cuts, read_path_card, place_paths

   character(len=2), parameter :: ITEMS(4) = ['x1', 'y1', 'x2', 'y2']
   integer, parameter :: DIGITS = 6                     !< of coordinates in messages

   character(len=*), parameter :: WHAT_POINTS = 'points on the path, 2 to 100000'
   integer(ip), parameter :: MOST_POINTS = 100000
   real(wp), parameter :: DEGREE = acos(-1.0_wp)/180.0_wp

contains

   !> In a step names are given anew.
   pure subroutine begin_lines_of_step(drawn)
      type(drawn_lines_t), intent(inout) :: drawn !< earlier lines stay, their names are free

      drawn%n_before = drawn%n
      drawn%names = name_list_t()
   end subroutine begin_lines_of_step

   !> NAME and ELSET of a card. ok: whether its lines may be read.
   subroutine read_line_options(context, card, name, place, elset, ok)
      type(build_context_t), intent(inout) :: context      !< its element sets are searched
      type(card_t), intent(in) :: card                     !< *SECTION PRINT or *PATH PRINT
      character(len=:), allocatable, intent(out) :: name   !< of the card, NAME=; '' without one
      type(token_t), intent(out) :: place                  !< of the name
      integer(ip), intent(out) :: elset                    !< place of the set that is crossed; 0: everything
      logical, intent(out) :: ok                           !< there is a name, and the set is known
      logical :: found

      elset = 0
      call option_text(context%deck, card, 'NAME', name, found, place)
      ok = card%ok .and. found
      if (ok) call find_set_option(context, card, 'ELSET', 'element set', context%model%element_sets, elset, ok)
   end subroutine read_line_options

   !> The name of line i: that of the card, with -i behind it where the card has several. ok: no other of the step has it; else
   !> E-TWICE.
   subroutine name_line(context, card, i, given, place, drawn, name, ok)
      type(build_context_t), intent(inout) :: context      !< its deck is read
      type(card_t), intent(in) :: card                     !< *SECTION PRINT or *PATH PRINT
      integer(ip), intent(in) :: i                         !< data line of the card, from 1
      character(len=*), intent(in) :: given                !< name of the card
      type(token_t), intent(in) :: place                   !< of that name
      type(drawn_lines_t), intent(in) :: drawn             !< names of the step's lines so far
      character(len=:), allocatable, intent(out) :: name   !< of the line
      logical, intent(out) :: ok                           !< it is free; else that is reported
      integer(ip) :: before

      name = given
      if (card%n_lines > 1) name = given//'-'//to_text(i)
      before = find_name(drawn%names, name)
      ok = before == 0
      if (ok) return
      call report_error(context%deck, place, 'E-TWICE', trim(drawn%what)//' '//name//' is defined already in this step, in '// &
                        place_text(context%deck, drawn%items(drawn%n_before + before), place), &
                        expected='another NAME=, or all lines in one card')
   end subroutine name_line

   !> Counts a line in, with its name and its first item. There is room for one of each line of the deck's cards of this kind.
   subroutine note_line(context, card, i, name, drawn)
      type(build_context_t), intent(in) :: context !< its deck is read
      type(card_t), intent(in) :: card             !< *SECTION PRINT or *PATH PRINT
      integer(ip), intent(in) :: i                 !< data line of the card, from 1
      character(len=*), intent(in) :: name         !< of the line
      type(drawn_lines_t), intent(inout) :: drawn  !< gets the line

      if (.not. allocated(drawn%items)) allocate (drawn%items(count_lines(context%deck, card%name)))
      drawn%n = drawn%n + 1
      drawn%items(drawn%n) = line_item(context%deck, context%deck%lines(card%first_line + i - 1), 1_ip)
      call add_name(drawn%names, name)
   end subroutine note_line

   !> Which elements a line may cross: those of a set, or all.
   pure function elements_to_cross(model, elset) result(wanted)
      type(model_t), intent(in) :: model                   !< its element sets are read
      integer(ip), intent(in) :: elset                     !< place of the set; 0: all
      logical :: wanted(model%mesh%n_elements)

      wanted = elset == 0
      if (elset > 0) wanted(members_of(model%element_sets%sets(elset))) = .true.
   end function elements_to_cross

   !> The cuts of a card; with SURFACE= it is that of another program, which has been noted.
   subroutine read_cut_card(context, card, requests)
      type(build_context_t), intent(inout) :: context   !< its model gets cuts
      type(card_t), intent(in) :: card                  !< *SECTION PRINT
      type(requests_t), intent(inout) :: requests       !< of the step; gets places of cuts
      character(len=:), allocatable :: name
      type(token_t) :: place
      type(cut_t) :: cut
      integer(ip) :: i
      logical :: ok

      if (has_option(context%deck, card, 'SURFACE')) return
      call read_line_options(context, card, name, place, cut%elset, ok)
      if (.not. ok) return
      do i = 1, card%n_lines
         associate (line => context%deck%lines(card%first_line + i - 1))
            if (.not. line%ok) cycle
            call name_line(context, card, i, name, place, context%drawn_cuts, cut%name, ok)
            if (.not. ok) return
            call read_cut_line(context, line, cut%ends, ok)
         end associate
         if (.not. ok) cycle
         call note_line(context, card, i, cut%name, context%drawn_cuts)
         if (.not. allocated(context%model%cuts)) allocate (context%model%cuts(size(context%drawn_cuts%items)))
         if (.not. allocated(requests%cuts)) allocate (requests%cuts(0))
         context%model%cuts(context%drawn_cuts%n) = cut
         requests%cuts = [requests%cuts, context%drawn_cuts%n]
      end do
   end subroutine read_cut_card

   !> x1, y1, x2, y2
   subroutine read_cut_line(context, line, ends, ok)
      type(build_context_t), intent(in) :: context
      type(data_line_t), intent(in) :: line
      real(wp), intent(out) :: ends(2, 2)
      logical, intent(out) :: ok
      real(wp) :: x(4)
      logical :: good(4)
      integer(ip) :: k

      do k = 1, 4
         call get_real(context%deck, line_item(context%deck, line, k), ITEMS(k)//', a real [L]', x(k), good(k))
      end do
      ok = all(good)
      if (.not. ok) return
      ends = reshape(x, [2, 2])
      if (any(ends(:, 1) /= ends(:, 2))) return
      ok = .false.
      call report_error(context%deck, line_item(context%deck, line, 3_ip), 'E-VALUE', 'both points of the cut are the same', &
                        expected='x1, y1, x2, y2: two points of a line through a body [L]')
   end subroutine read_cut_line

   !> Finds where the cuts go through the bodies. The mesh is complete.
   subroutine place_cuts(context)
      type(build_context_t), intent(inout) :: context   !< cuts of its model get their sections
      type(bodies_t) :: bodies
      integer(ip) :: i

      if (.not. allocated(context%model%cuts)) return
      context%model%cuts = context%model%cuts(:context%drawn_cuts%n)
      call find_bodies(context%model%mesh, bodies)
      call name_bodies(context%model, bodies)
      context%around = list_node_elements(context%model%mesh)   ! bolts may have cut the mesh since it was listed
      do i = 1, size(context%model%cuts, kind=ip)
         call place_cut()
      end do

   contains

      subroutine place_cut()
         type(crossing_t), allocatable :: crossings(:)
         integer(ip) :: k

         associate (model => context%model, cut => context%model%cuts(i))
            call find_cross_section(model%mesh, context%around, bodies%of_element, cut%ends, &
                                    elements_to_cross(model, cut%elset), cut%section, crossings)
            if (.not. any(crossings%is_taken)) then
               call report_miss(crossings)
            else if (.not. all(crossings%is_whole .or. .not. crossings%is_taken)) then   ! through what is left forces go, too
               k = findloc(crossings%is_taken .and. .not. crossings%is_whole, .true., dim=1, kind=ip)
               call report_error(context%deck, context%drawn_cuts%items(i), 'E-CROSSING', 'cut '//cut%name//' ends within body '// &
                                 bodies%list(crossings(k)%body)%name, expected='a line through the whole of '// &
                                 span_text(crossings(k)))
            else
               call warn_of_several(context, bodies, i, pack(crossings, crossings%is_taken))
            end if
         end associate
      end subroutine place_cut

      !> The cut meets nothing: where its line would, or where the bodies are.
      subroutine report_miss(crossings)
         type(crossing_t), intent(in) :: crossings(:)
         character(len=:), allocatable :: text, hint
         integer(ip) :: k

         associate (cut => context%model%cuts(i), mesh => context%model%mesh)
            text = 'cut '//cut%name//' meets no body'
            if (cut%elset > 0) text = 'cut '//cut%name//' meets no element of '//context%model%element_sets%sets(cut%elset)%name
            k = findloc(crossings%kind == INSIDE .and. crossings%is_wanted, .true., dim=1, kind=ip)
            if (k > 0) then
               hint = 'points farther apart: the line goes through '//span_text(crossings(k))
            else
               hint = 'a line through a body; the bodies lie between '//point_text(minval(mesh%x(:, :mesh%n_nodes), dim=2))// &
                      ' and '//point_text(maxval(mesh%x(:, :mesh%n_nodes), dim=2))
            end if
         end associate
         call report_error(context%deck, context%drawn_cuts%items(i), 'E-CROSSING', text, expected=hint)
      end subroutine report_miss

      !> `BODY from (x, y) to (x, y)`.
      function span_text(crossing) result(text)
         type(crossing_t), intent(in) :: crossing
         character(len=:), allocatable :: text

         associate (line => context%model%cuts(i)%section%line)
            text = bodies%list(crossing%body)%name//', from '//point_text(point_at(line, crossing%from))//' to '// &
                   point_text(point_at(line, crossing%to))
         end associate
      end function span_text
   end subroutine place_cuts

   pure function point_text(x) result(text)
      real(wp), intent(in) :: x(2)
      character(len=:), allocatable :: text

      text = '('//to_text(x(1), DIGITS)//', '//to_text(x(2), DIGITS)//')'
   end function point_text

   !> What may not be meant: several bodies, one body several times, more than the set, an edge.
   subroutine warn_of_several(context, bodies, i, taken)
      type(build_context_t), intent(in) :: context
      type(bodies_t), intent(in) :: bodies
      integer(ip), intent(in) :: i
      type(crossing_t), intent(in) :: taken(:)
      character(len=:), allocatable :: text

      associate (cut => context%model%cuts(i), item => context%drawn_cuts%items(i), name => bodies%list(taken(1)%body)%name)
         if (size(taken) > 1) then
            if (all(taken%body == taken(1)%body)) then
               text = 'cut '//cut%name//' goes through body '//name//' '//to_text(size(taken, kind=ip))//' times'
            else
               text = 'cut '//cut%name//' goes through bodies at '//to_text(size(taken, kind=ip))//' places, from '//name// &
                      ' to '//bodies%list(taken(size(taken))%body)%name
            end if
            call report_warning(context%deck, item, 'W-CROSSING', text//': n, v and m are those of all together', &
                                expected='a shorter line, or ELSET=, for one of them')
         end if
         if (.not. all(taken%is_all_wanted)) then
            call report_warning(context%deck, item, 'W-CROSSING', 'cut '//cut%name//' goes through elements of '// &
                                context%model%element_sets%sets(cut%elset)%name//' and of others: it counts as a whole')
         end if
         if (any(taken%kind /= INSIDE)) then
            call report_note(context%deck, item, 'N-EDGE', 'cut '//cut%name//' runs along the edge of '// &
                             bodies%list(taken(findloc(taken%kind /= INSIDE, .true., dim=1))%body)%name// &
                             ': what acts on the edge is told')
         end if
      end associate
   end subroutine warn_of_several

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
            call read_path_line(context, line, path, ok)
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
   subroutine read_path_line(context, line, path, ok)
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
   end subroutine read_path_line

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

end module atrito_drawn_lines
