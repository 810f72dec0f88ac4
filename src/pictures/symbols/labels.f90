!> What `--plot-labels` writes over the bodies: numbers of nodes and elements, names of sets and surfaces.
!>
!> Numbers that would cover each other are left out, so a large mesh has few of them; more have room in a part of it (`--plot-box`).
!> Names are written below or above others that are in their way.
module atrito_labels
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_drawing, only: drawing_t
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_nodes, side_count
   use atrito_mesh_lines, only: rigid_places
   use atrito_model, only: SURFACE_SEGMENTS
   use atrito_plot_text, only: range_t, cleaned
   use atrito_plot_view, only: shown_window
   use atrito_sets, only: set_list_t, members_of, member_count, set_count
   use atrito_strings, only: string_t, append_string, same_name, to_text
   use atrito_symbols, only: symbols_t, begin_block, put_text, thinned
   implicit none (type, external)
   private
   public :: put_labels

   real(wp), parameter :: LETTER = 6.6_wp, LINE = 15.0_wp, OFF = 9.0_wp   !< of a text, and of a name from its surface [pixels]
   integer, parameter :: MOST_SHIFTS = 8            !< lines by which a name gives way
   integer, parameter :: LONGEST_NAME = 30          !< characters
   character(len=7), parameter :: INK(3) = ['#202020', '#0060B0', '#A00050']   !< of nodes, elements, names

   !> Names that are placed.
   type :: names_t
      type(string_t), allocatable :: text(:)        !< (n) as they are drawn
      real(wp), allocatable :: place(:, :)          !< (2, n) middles, as they are drawn [L]
      integer :: left_out = 0                       !< names without room
   end type names_t

contains

   !> Puts the labels of what is shown; their script has the fonts SMALL and MIDDLE.
   subroutine put_labels(drawing, symbols)
      type(drawing_t), intent(in) :: drawing        !< mesh, sets, surfaces and view
      type(symbols_t), intent(inout) :: symbols     !< get the labels
      real(wp), allocatable :: nodes(:, :), middles(:, :)
      type(names_t) :: names
      integer :: k
      integer(ip) :: e

      associate (mesh => drawing%model%mesh)
         allocate (nodes(4, mesh%n_nodes), middles(4, mesh%n_elements))
         nodes(:2, :) = mesh%x(:, :mesh%n_nodes)
         nodes(3:, :) = drawing%u(:, :mesh%n_nodes)
         do e = 1, mesh%n_elements
            middles(:, e) = mean_of(nodes(:, mesh%nodes(:side_count(mesh, e), e)))
         end do
         call put_numbers('nodes', INK(1), mesh%node_id(:mesh%n_nodes), nodes, 'left offset 0.3,0.5', drawing, symbols)
         call put_numbers('elements', INK(2), mesh%element_id(:mesh%n_elements), middles, 'center', drawing, symbols)
      end associate
      call place_names(drawing, symbols%pixel, drawn(drawing, nodes), drawn(drawing, middles), names)
      if (size(names%text) == 0) return
      call begin_block(symbols, 'names of sets and surfaces', ':5', 'with labels noenhanced boxed center font MIDDLE tc rgb "'// &
                       INK(3)//'"')
      do k = 1, size(names%text)
         call put_text(symbols, [0.0_wp, 0.0_wp], names%place(:, k), '"'//names%text(k)%s//'"')
      end do
      call add_entry(symbols, INK(3), 'sets and surfaces', size(names%text, kind=ip), size(names%text, kind=ip) + names%left_out)
   end subroutine put_labels

   !> Where places with displacements are drawn.
   pure function drawn(drawing, places) result(x)
      type(drawing_t), intent(in) :: drawing
      real(wp), intent(in) :: places(:, :)          !< (4, n) [L]
      real(wp) :: x(2, size(places, 2))

      x = places(:2, :) + drawing%scale*places(3:, :)
   end function drawn

   !> Numbers at places, those that are shown and have room.
   subroutine put_numbers(what, colour, numbers, places, looks, drawing, symbols)
      character(len=*), intent(in) :: what, colour, looks
      integer(ip), intent(in) :: numbers(:)
      real(wp), intent(in) :: places(:, :)          !< (4, n) with displacements [L]
      type(drawing_t), intent(in) :: drawing
      type(symbols_t), intent(inout) :: symbols
      integer(ip), allocatable :: list(:)
      real(wp) :: room(2), x(2, size(numbers))
      integer(ip) :: i, n

      x = drawn(drawing, places)
      list = pack([(i, i=1, size(numbers, kind=ip))], [(is_shown(drawing, x(:, i)), i=1, size(numbers, kind=ip))])
      n = size(list, kind=ip)
      if (n == 0) return
      room = [LETTER*(len(to_text(maxval(numbers(list)))) + 2), 1.4_wp*LINE]
      list = pack(list, thinned(x(:, list)/spread(room, 2, n), symbols%pixel))
      call begin_block(symbols, 'numbers of '//what, ':5', 'with labels '//looks//' font SMALL tc rgb "'//colour//'"')
      do i = 1, size(list, kind=ip)
         call put_text(symbols, places(3:, list(i)), places(:2, list(i)), to_text(numbers(list(i))))
      end do
      call add_entry(symbols, colour, what, size(list, kind=ip), n)
   end subroutine put_numbers

   !> The entry of the legend, which tells how many have no room.
   subroutine add_entry(symbols, colour, what, n_drawn, n)
      type(symbols_t), intent(inout) :: symbols
      character(len=*), intent(in) :: colour, what
      integer(ip), intent(in) :: n_drawn, n
      character(len=:), allocatable :: text

      text = what
      if (n_drawn < n) text = to_text(n_drawn)//' of '//to_text(n)//' '//what
      call append_string(symbols%curves, 'NaN with points pt 5 ps 0.9*dot lc rgb "'//colour//'" title "'//text//'"')
   end subroutine add_entry

   pure logical function is_shown(drawing, place)
      type(drawing_t), intent(in) :: drawing
      real(wp), intent(in) :: place(2)
      type(range_t) :: shown(2)

      shown = shown_window(drawing%view, drawing%window)
      is_shown = all(ieee_is_finite(place))
      if (is_shown) is_shown = all(place >= shown%low .and. place <= shown%high)
   end function is_shown

   !> The names of surfaces, outside of them, of element sets and of node sets in their middles; each once.
   subroutine place_names(drawing, pixel, x, middles, names)
      type(drawing_t), intent(in) :: drawing
      real(wp), intent(in) :: pixel                 !< [L]
      real(wp), intent(in) :: x(:, :), middles(:, :)   !< of nodes and elements as they are drawn [L]
      type(names_t), intent(out) :: names
      real(wp), allocatable :: points(:, :)
      integer(ip) :: i, k

      allocate (names%text(0), names%place(2, 0))
      associate (model => drawing%model)
         do i = 1, size(model%surfaces, kind=ip)
            associate (surface => model%surfaces(i))
               if (surface%kind == SURFACE_SEGMENTS) then
                  if (.not. allocated(surface%points)) cycle
                  points = rigid_places(surface)
                  k = (size(points, 2, kind=ip) + 1)/2
                  call place_name(drawing, pixel, surface%name, points(:, k + 1), points(:, k), names)
               else if (surface%faces%n > 0) then
                  k = (surface%faces%n + 1)/2
                  associate (ends => face_nodes(model%mesh, surface%faces%element(k), surface%faces%face(k)))
                     call place_name(drawing, pixel, surface%name, x(:, ends(1)), x(:, ends(2)), names)
                  end associate
               end if
            end associate
         end do
         call place_sets(model%element_sets, middles)
         call place_sets(model%node_sets, x)
      end associate

   contains

      subroutine place_sets(list, places)
         type(set_list_t), intent(in) :: list
         real(wp), intent(in) :: places(:, :)       !< of what can be a member
         integer(ip) :: k

         do k = 1, set_count(list)
            if (member_count(list%sets(k)) == 0) cycle
            points = places(:, members_of(list%sets(k)))
            call place_name(drawing, pixel, list%sets(k)%name, mean_of(points), mean_of(points), names)
         end do
      end subroutine place_sets

   end subroutine place_names

   pure function mean_of(points) result(mean)
      real(wp), intent(in) :: points(:, :)          !< (:, n)
      real(wp) :: mean(size(points, 1))

      mean = sum(points, dim=2)/size(points, 2)
   end function mean_of

   !> A name beside the middle of a line from a to b, on its right, at the first place that is free; on it where it is a point.
   subroutine place_name(drawing, pixel, name, a, b, names)
      type(drawing_t), intent(in) :: drawing
      real(wp), intent(in) :: pixel
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: a(2), b(2)            !< [L]
      type(names_t), intent(inout) :: names
      real(wp) :: place(2), normal(2), half(2), shift
      character(len=:), allocatable :: text
      integer :: i, k

      text = cleaned(name, LONGEST_NAME)
      do i = 1, len(text)
         if (text(i:i) == '"') text(i:i) = ''''     ! which would end the text in the data
      end do
      if (any([(same_name(names%text(i)%s, text), i=1, size(names%text))])) return
      half = 0.5_wp*[LETTER*len(text), LINE]
      normal = [b(2) - a(2), a(1) - b(1)]
      if (norm2(normal) > 0.0_wp) normal = normal/norm2(normal)
      place = 0.5_wp*(a + b) + pixel*normal*(OFF + [half(1), 0.0_wp])
      if (.not. is_shown(drawing, 0.5_wp*(a + b))) return
      do k = 0, MOST_SHIFTS
         shift = LINE*pixel*merge(-1, 1, mod(k, 2) == 1)*((k + 1)/2)
         if (is_free(place + [0.0_wp, shift])) exit
      end do
      if (k > MOST_SHIFTS) then
         names%left_out = names%left_out + 1
         return
      end if
      names%place = reshape([names%place, place + [0.0_wp, shift]], [2, size(names%text) + 1])
      call append_string(names%text, text)

   contains

      pure logical function is_free(middle)
         real(wp), intent(in) :: middle(2)
         real(wp) :: room(2)
         integer :: j

         is_free = .true.
         do j = 1, size(names%text)
            room = pixel*[half(1) + 0.5_wp*LETTER*len(names%text(j)%s), 0.95_wp*LINE]
            is_free = is_free .and. any(abs(middle - names%place(:, j)) >= room)
         end do
      end function is_free

   end subroutine place_name

end module atrito_labels
