!> Symbols over the bodies of a picture: the file of their places, and the curves by which a script draws them.
!>
!> Places go with their displacements, as those of the bodies do, so that a script that draws bodies displaced has the symbols where
!> the bodies are. Lengths are given in pixels of a picture that is 1000 wide.
module atrito_symbols
   use atrito_drawing, only: drawing_t, put_place, pixel_of, MOVED
   use atrito_id_map, only: id_map_t, add_id, find_id
   use atrito_kinds, only: ip, wp
   use atrito_load_lists, only: amplitude_of
   use atrito_load_resultants, only: last_factor
   use atrito_mesh, only: mesh_t, face_end, middle_node, side_count
   use atrito_model, only: model_t, nodal_values_t
   use atrito_number_text, only: trimmed_real
   use atrito_plot_scripts, only: plots_t, put, begin_data
   use atrito_plot_text, only: range_t, cover, span
   use atrito_plot_view, only: shown_window
   use atrito_sorting, only: sorted_places, order_key
   use atrito_strings, only: string_t, append_string, to_text
   implicit none (type, external)
   private
   public :: symbols_t, begin_symbols, end_symbols, begin_block, put_stroke, put_path, put_arrow, put_point, put_text, widen
   public :: thinned, thinned_nodes, places_of, find_outward, end_value, load_factor, place_of_node
   public :: arrow_at
   public :: ARROW_LOOKS, SLANT

   integer, parameter :: DIGITS = 7
   !> How a script draws arrows; colour and width follow.
   character(len=*), parameter :: ARROW_LOOKS = 'with vectors filled head size screen 0.011,16,60 fixed lt 1'
   real(wp), parameter :: NEARLY = 0.999_wp         !< of a spacing is far enough: nodes of a regular mesh
   real(wp), parameter :: SHORTEST_SHARE = 0.4_wp   !< of the longest arrow, for lesser ones
   real(wp), parameter :: SLANT = 0.05_wp           !< what goes less than so much inwards does not push
   real(wp), parameter :: ASKEW = 0.618_wp          !< across a direction that hardly a side has
   integer(ip), parameter :: MOST_CELLS = 32767     !< of a grid along an axis

   !> What the symbols are of, and what is written of them so far.
   type :: symbols_t
      type(model_t), pointer :: model => null()     !< of the drawing
      integer(ip) :: step = 0                       !< whose supports and loads they are, as at its end
      real(wp), pointer :: u(:, :) => null()        !< (2, n_nodes) [L]: the symbols go with the nodes
      type(plots_t), pointer :: plots => null()     !< whose file they are written into
      character(len=:), allocatable :: data         !< its name, as a script has it
      real(wp) :: pixel = 1.0_wp                    !< length of one [L]
      real(wp) :: scale = 1.0_wp                    !< of the displacements
      type(range_t) :: window(2)                    !< what bodies and symbols cover as they are drawn [L]
      logical :: widens = .true.                    !< the window, by what is put
      integer(ip) :: n_blocks = 0                   !< written so far
      logical :: is_open = .false.                  !< the last block has something in it and may have more
      character(len=:), allocatable :: what, drawn  !< of a block that was begun and has nothing in it yet
      type(string_t), allocatable :: curves(:)      !< of the script: one a block, and entries of the legend
   end type symbols_t

contains

   !> Begins the file. Plots and drawing are used until it ends.
   subroutine begin_symbols(plots, name, what, drawing, symbols)
      type(plots_t), intent(inout), target :: plots !< get the data
      character(len=*), intent(in) :: name          !< of the file, without .dat
      character(len=*), intent(in) :: what          !< stands in it, and in its columns behind those of the places
      type(drawing_t), intent(in), target :: drawing    !< of the bodies
      type(symbols_t), intent(out) :: symbols       !< no block is open

      symbols%plots => plots
      symbols%model => drawing%model
      symbols%u => drawing%u
      symbols%pixel = pixel_of(shown_window(drawing%view, drawing%window))
      symbols%window = drawing%window
      symbols%scale = drawing%scale
      allocate (symbols%curves(0))
      symbols%data = '"'//name//'.dat"'
      call begin_data(plots, name, what)
   end subroutine begin_symbols

   !> Begins a block of symbols that are drawn alike, which ends the one before it; one into which nothing is put leaves no trace.
   !> columns: what `using` has behind the place, with its colon, or nothing.
   subroutine begin_block(symbols, what, columns, drawn, places)
      type(symbols_t), intent(inout) :: symbols     !< the next block begins with its first symbol
      character(len=*), intent(in) :: what          !< they are
      character(len=*), intent(in) :: columns       !< of gnuplot
      character(len=*), intent(in) :: drawn         !< `with ...` and the title
      character(len=*), intent(in), optional :: places  !< what `using` has for the place; default: displaced

      if (symbols%is_open) call put(symbols%plots, '')
      symbols%is_open = .false.
      symbols%what = what
      symbols%drawn = ' using '//MOVED//columns//' '//drawn
      if (present(places)) symbols%drawn = ' using '//places//columns//' '//drawn
   end subroutine begin_block

   !> A block stands in the file from the first thing in it on: gnuplot does not count one that is empty, and would take the next
   !> one for it.
   subroutine open_block(symbols)
      type(symbols_t), intent(inout) :: symbols

      if (.not. allocated(symbols%what)) return
      call put(symbols%plots, '# block '//to_text(symbols%n_blocks)//': '//symbols%what)
      call append_string(symbols%curves, symbols%data//' index '//to_text(symbols%n_blocks)//symbols%drawn)
      symbols%n_blocks = symbols%n_blocks + 1
      symbols%is_open = .true.
      deallocate (symbols%what)
   end subroutine open_block

   !> Ends the last block.
   subroutine end_symbols(symbols)
      type(symbols_t), intent(inout) :: symbols     !< their file stays open

      if (symbols%is_open) call put(symbols%plots, '')
   end subroutine end_symbols

   !> A line through some places that move together.
   subroutine put_stroke(symbols, u, places)
      type(symbols_t), intent(inout) :: symbols     !< get a stroke in the open block
      real(wp), intent(in) :: u(2)                  !< [L]
      real(wp), intent(in) :: places(:, :)          !< (2, n) [L]

      call put_path(symbols, spread(u, 2, size(places, 2)), places)
   end subroutine put_stroke

   !> A line through some places.
   subroutine put_path(symbols, u, places)
      type(symbols_t), intent(inout) :: symbols     !< get a line in the open block
      real(wp), intent(in) :: u(:, :), places(:, :) !< (2, n) [L]
      integer :: i

      call open_block(symbols)
      do i = 1, size(places, 2)
         call put_place(symbols%plots, [places(:, i), u(:, i)])
      end do
      call widen(symbols, places + symbols%scale*u)
      call put(symbols%plots, '')
   end subroutine put_path

   !> An arrow from a place of the undisplaced bodies, which moves with the displacement u.
   subroutine put_arrow(symbols, u, from, arrow)
      type(symbols_t), intent(inout) :: symbols         !< get an arrow in the open block
      real(wp), intent(in) :: u(2), from(2), arrow(2)   !< [L]

      call put_point(symbols, u, from, arrow)
      call widen(symbols, reshape(from + arrow + symbols%scale*u, [2, 1]))
   end subroutine put_arrow

   !> A point of the undisplaced bodies, which moves with the displacement u, and what stands behind it in its block: of an arrow
   !> the components [L], of a marker its size, relative to that of the block.
   subroutine put_point(symbols, u, place, columns)
      type(symbols_t), intent(inout) :: symbols     !< get a point in the open block
      real(wp), intent(in) :: u(2), place(2)        !< [L]
      real(wp), intent(in) :: columns(:)            !< numbers behind the place, one at least
      character(len=:), allocatable :: text
      integer :: i

      text = trimmed_real(columns(1), DIGITS)
      do i = 2, size(columns)
         text = text//' '//trimmed_real(columns(i), DIGITS)
      end do
      call put_text(symbols, u, place, text)
   end subroutine put_point

   !> A point with what stands behind it, and unless a line goes on to the next one the end of the line.
   subroutine put_text(symbols, u, place, text, goes_on)
      type(symbols_t), intent(inout) :: symbols     !< get a point in the open block
      real(wp), intent(in) :: u(2), place(2)        !< [L]
      character(len=*), intent(in) :: text          !< columns behind the place
      logical, intent(in), optional :: goes_on      !< the next point is joined to it; default: not

      call open_block(symbols)
      call put_place(symbols%plots, [place, u], text)
      call widen(symbols, reshape(place + symbols%scale*u, [2, 1]))
      if (present(goes_on)) then
         if (goes_on) return
      end if
      call put(symbols%plots, '')
   end subroutine put_text

   !> Makes the window hold some places, where it is to follow what is drawn.
   pure subroutine widen(symbols, places)
      type(symbols_t), intent(inout) :: symbols     !< their window, if it widens
      real(wp), intent(in) :: places(:, :)          !< (2, n) [L]
      integer :: i

      if (.not. symbols%widens) return
      do i = 1, 2
         call cover(symbols%window(i), places(i, :))
      end do
   end subroutine widen

   !> Where symbols of some nodes stand.
   pure function places_of(symbols, nodes) result(places)
      type(symbols_t), intent(in) :: symbols        !< their model is read
      integer(ip), intent(in) :: nodes(:)           !< places in the mesh
      real(wp) :: places(2, size(nodes))            !< [L]
      integer(ip) :: i

      do i = 1, size(nodes, kind=ip)
         places(:, i) = place_of_node(symbols, nodes(i))
      end do
   end function places_of

   !> Some of the nodes, none nearer to another than a spacing.
   pure function thinned_nodes(symbols, nodes, spacing) result(kept)
      type(symbols_t), intent(in) :: symbols        !< their model and pixel are read
      integer(ip), intent(in) :: nodes(:)           !< places in the mesh
      real(wp), intent(in) :: spacing               !< [pixels]
      integer(ip), allocatable :: kept(:)

      kept = pack(nodes, thinned(places_of(symbols, nodes), spacing*symbols%pixel))
   end function thinned_nodes

   !> Which of some places are kept so that none is nearer to another than the spacing. They are gone through in an order that
   !> begins a straight side at one of its ends: by their distance along a skew direction.
   !>
   !> A grid of squares with sides spacing/sqrt(2) makes this take a time that grows with the number of places alone: two places in
   !> one square are nearer than the spacing, so a square holds one place that is kept at the most, and places nearer than the
   !> spacing lie within two squares of each other, so 25 squares are looked at for each.
   pure function thinned(places, spacing) result(keep)
      real(wp), intent(in) :: places(:, :)          !< (2, n) [L]
      real(wp), intent(in) :: spacing               !< [L], > 0
      logical :: keep(size(places, 2))
      type(id_map_t) :: cells                       ! of a grid in which each holds one place at the most
      integer(ip) :: order(size(places, 2)), j, other
      real(wp) :: low(2), width
      integer(ip) :: i, k, at(2)
      logical :: known

      keep = .false.
      if (size(places, 2) == 0) return
      width = spacing/sqrt(2.0_wp)
      low = minval(places, dim=2)
      order = sorted_places(order_key(places(1, :) + ASKEW*places(2, :)))
      do k = 1, size(order, kind=ip)
         i = order(k)
         at = int(min((places(:, i) - low)/width, real(MOST_CELLS, wp)), ip)
         ! Whether no place that is kept is near.
         keep(i) = find_id(cells, cell_number(at)) == 0
         do j = 0, 24
            other = find_id(cells, cell_number(at + [mod(j, 5_ip), j/5] - 2))
            if (other > 0) keep(i) = keep(i) .and. norm2(places(:, i) - places(:, other)) >= NEARLY*spacing
         end do
         if (keep(i)) call add_id(cells, cell_number(at), i, known)
      end do
   end function thinned

   pure integer(ip) function cell_number(at) result(number)
      integer(ip), intent(in) :: at(2)              !< from -2 on

      number = (at(1) + 3) + (MOST_CELLS + 6)*(at(2) + 2)
   end function cell_number

   !> The sum of the outward normals of the faces at each node, by their lengths, and the sum of the lengths [L]. Those inside
   !> cancel, so at a node inside the first is round-off. Faces count both of whose ends are in a class.
   !>
   !> The nodes of an element go round it to the left, so a face from x1 to x2, d = x2 - x1, has the outward normal (d2, -d1), whose
   !> length is that of the face. The two elements on both sides of a face inside go through it in opposite directions.
   pure function find_outward(mesh, is_in) result(outward)
      type(mesh_t), intent(in) :: mesh              !< undisplaced
      logical, intent(in), optional :: is_in(:)     !< (n_nodes) the class; default: all nodes
      real(wp), allocatable :: outward(:, :)        !< (3, n_nodes)
      real(wp) :: d(2)
      integer(ip) :: e, face, ends(2)

      allocate (outward(3, mesh%n_nodes), source=0.0_wp)
      do e = 1, mesh%n_elements
         do face = 1, side_count(mesh, e)
            ends = [mesh%nodes(face, e), mesh%nodes(face_end(mesh, e, face), e)]
            if (present(is_in)) then
               if (.not. all(is_in(ends))) cycle
            end if
            d = mesh%x(:, ends(2)) - mesh%x(:, ends(1))
            call add_to(ends(1))
            call add_to(ends(2))
            call add_to(middle_node(mesh, e, face))
         end do
      end do

   contains

      pure subroutine add_to(node)
         integer(ip), intent(in) :: node            !< none where it is 0

         if (node > 0) outward(:, node) = outward(:, node) + [d(2), -d(1), norm2(d)]
      end subroutine add_to

   end function find_outward

   !> Where symbols of a node stand: at it. Those of a reference node far from all that is drawn stand at the middle of its surface.
   pure function place_of_node(symbols, node) result(place)
      type(symbols_t), intent(in) :: symbols        !< their model and window are read
      integer(ip), intent(in) :: node               !< place in the mesh
      real(wp) :: place(2), room
      integer(ip) :: body

      place = symbols%model%mesh%x(:, node)
      body = 0
      if (allocated(symbols%model%rigid_bodies)) body = findloc(symbols%model%rigid_bodies%node, node, dim=1, kind=ip)
      if (body == 0) return
      if (symbols%model%rigid_bodies(body)%surface == 0) return
      room = 0.5_wp*(span(symbols%window(1)) + span(symbols%window(2)))
      if (all(place >= symbols%window%low - room) .and. all(place <= symbols%window%high + room)) return
      associate (points => symbols%model%surfaces(symbols%model%rigid_bodies(body)%surface)%points)
         place = 0.5_wp*(minval(points, dim=2) + maxval(points, dim=2))
      end associate
   end function place_of_node

   !> An arrow at a place: its tip is there where it pushes on the body, else it begins there.
   pure subroutine arrow_at(place, share, outward, longest, from, arrow)
      real(wp), intent(in) :: place(2)              !< [L]
      real(wp), intent(in) :: share(2)              !< the vector, over the largest one
      real(wp), intent(in) :: outward(2)            !< normal of the body there, of any length; 0: inside
      real(wp), intent(in) :: longest               !< arrow [L]
      real(wp), intent(out) :: from(2), arrow(2)    !< [L]
      real(wp) :: length

      length = max(norm2(share), tiny(1.0_wp))
      arrow = share*(longest*max(SHORTEST_SHARE, length)/length)
      from = place
      if (dot_product(share, outward) < -SLANT*length*norm2(outward)) from = place - arrow
   end subroutine arrow_at

   !> A prescribed displacement or a force at the end of a step; where its amplitude has come to 0, what that multiplies.
   pure real(wp) function end_value(symbols, list, i) result(value)
      type(symbols_t), intent(in) :: symbols        !< their step is read
      type(nodal_values_t), intent(in) :: list      !< of that step
      integer(ip), intent(in) :: i                  !< place in the list

      value = end_factor(symbols, amplitude_of(list%amplitude, i))*list%value(i)
   end function end_value

   !> The factor by which an amplitude multiplies at the end of the step; 1 where it has come to 0, and without one.
   pure real(wp) function end_factor(symbols, amplitude) result(factor)
      type(symbols_t), intent(in) :: symbols
      integer(ip), intent(in) :: amplitude          !< place in the model; 0 where there is none

      factor = 1.0_wp
      if (amplitude > 0) factor = last_factor(symbols%model, symbols%step, amplitude)
      if (.not. abs(factor) > 0.0_wp) factor = 1.0_wp
   end function end_factor

   !> That of a load on an element.
   pure real(wp) function load_factor(symbols, load) result(factor)
      type(symbols_t), intent(in) :: symbols        !< their step is read
      integer(ip), intent(in) :: load               !< place in the step's element loads

      factor = 1.0_wp
      associate (loads => symbols%model%steps(symbols%step)%element_loads)
         if (allocated(loads%amplitude)) factor = end_factor(symbols, loads%amplitude(load))
      end associate
   end function load_factor

end module atrito_symbols
