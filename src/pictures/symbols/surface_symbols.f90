!> Surfaces with their normals: slaves and masters of contact pairs, sides of ties, and the others.
module atrito_surface_symbols
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_end, middle_node
   use atrito_mesh_lines, only: rigid_places
   use atrito_model, only: model_t, SURFACE_SEGMENTS
   use atrito_plot_text, only: range_t, span
   use atrito_strings, only: to_text
   use atrito_symbols, only: symbols_t, begin_block, put_stroke, thinned
   implicit none (type, external)
   private
   public :: put_surfaces

   !> What a surface is; one that is several is the first of them.
   integer(ip), parameter :: MASTER = 1, SLAVE = 2, TIED = 3, OTHER = 4
   character(len=*), parameter :: NAMES(4) = [character(len=14) :: 'masters', 'slaves', 'ties', 'other surfaces']
   character(len=*), parameter :: COLOURS(4) = ['#48BFE3', '#D00070', '#7CB518', '#A08000']
   real(wp), parameter :: WIDTHS(4) = [4.5_wp, 2.0_wp, 2.5_wp, 1.5_wp]
   real(wp), parameter :: TICK = 8.0_wp, BETWEEN(4) = [16.0_wp, 16.0_wp, 16.0_wp, 40.0_wp]   !< [pixels]
   !> Of more surfaces the lines are thin and have no normals, and those of no pair and no tie are not drawn.
   integer, parameter :: MANY_SURFACES = 80
   real(wp), parameter :: THIN = 0.4_wp                      !< share of a width then
   real(wp), parameter :: RESTS(2) = 0.0_wp         !< surfaces are not displaced
   real(wp), parameter :: EVEN = 1.0e-9_wp          !< of the window: a line that rises less runs along it
   real(wp), parameter :: MOST_TICKS = 200.0_wp              !< of a piece

   !> Faces and pieces of rigid surfaces, from end to end.
   type :: strip_t
      integer(ip) :: n = 0                          !< faces and pieces
      real(wp), allocatable :: x(:, :, :)           !< (2, ends and middle, n) [L]
      real(wp), allocatable :: side(:)              !< (n) 1: the outside is on the left, -1: on the right
   end type strip_t

contains

   !> Puts all surfaces, undisplaced, in the window of the bodies.
   subroutine put_surfaces(model, symbols)
      type(model_t), intent(in) :: model            !< surfaces, pairs and ties
      type(symbols_t), intent(inout) :: symbols     !< get blocks; the window stays
      integer(ip) :: kind_of(size(model%surfaces)), kind
      type(strip_t) :: strip
      logical :: is_crowded

      kind_of = OTHER
      if (allocated(model%ties)) then
         kind_of(model%ties%slave) = TIED
         kind_of(model%ties%master) = TIED
      end if
      kind_of(model%pairs%slave) = SLAVE
      kind_of(model%pairs%master) = MASTER
      is_crowded = size(model%surfaces) > MANY_SURFACES
      symbols%widens = .false.                      ! a rigid floor may be as long as it likes
      do kind = MASTER, OTHER
         if (kind == OTHER .and. is_crowded) cycle
         call collect(model, kind_of == kind, strip)
         if (strip%n > 0) call put_strip(kind, is_crowded, strip, symbols)
      end do
      symbols%widens = .true.
   end subroutine put_surfaces

   !> The faces and segments of some surfaces.
   subroutine collect(model, wanted, strip)
      type(model_t), intent(in) :: model
      logical, intent(in) :: wanted(:)              !< (surfaces)
      type(strip_t), intent(out) :: strip
      real(wp), allocatable :: places(:, :)
      integer(ip) :: i, k, middle
      integer :: pass

      do pass = 1, 2                                ! they are counted, then taken
         strip%n = 0
         do i = 1, size(wanted, kind=ip)
            if (.not. wanted(i)) cycle
            associate (surface => model%surfaces(i), mesh => model%mesh)
               if (surface%kind == SURFACE_SEGMENTS) then
                  if (.not. allocated(surface%points)) cycle
                  places = rigid_places(surface)
                  do k = 1, size(places, 2, kind=ip) - 1
                     call add_piece(strip, pass == 2, 1.0_wp, places(:, k), places(:, k + 1))
                  end do
               else
                  do k = 1, surface%faces%n
                     associate (e => surface%faces%element(k), face => surface%faces%face(k))
                        call add_piece(strip, pass == 2, -1.0_wp, mesh%x(:, mesh%nodes(face, e)), &
                                       mesh%x(:, mesh%nodes(face_end(mesh, e, face), e)))
                        middle = middle_node(mesh, e, face)
                     end associate
                     if (pass == 2 .and. middle > 0) strip%x(:, 2, strip%n) = mesh%x(:, middle)
                  end do
               end if
            end associate
         end do
         if (pass == 1) allocate (strip%x(2, 3, strip%n), strip%side(strip%n))
      end do
   end subroutine collect

   !> A straight piece with its ends and its middle.
   pure subroutine add_piece(strip, is_taken, side, a, b)
      type(strip_t), intent(inout) :: strip
      logical, intent(in) :: is_taken               !< .false.: it is counted alone
      real(wp), intent(in) :: side, a(2), b(2)      !< ends [L]

      strip%n = strip%n + 1
      if (.not. is_taken) return
      strip%side(strip%n) = side
      strip%x(:, :, strip%n) = reshape([a, 0.5_wp*(a + b), b], [2, 3])
   end subroutine add_piece

   !> A block with the lines, and one with the normals. Rigid surfaces of pairs are drawn as such, and of other surfaces of elements
   !> there are the normals alone.
   subroutine put_strip(kind, is_crowded, strip, symbols)
      integer(ip), intent(in) :: kind
      logical, intent(in) :: is_crowded             !< there are many surfaces
      type(strip_t), intent(in) :: strip
      type(symbols_t), intent(inout) :: symbols
      real(wp), allocatable :: ticks(:, :)
      character(len=:), allocatable :: drawn, title
      logical :: is_line(strip%n)
      integer(ip) :: i

      drawn = 'with lines lt 1 lc rgb "'//COLOURS(kind)//'" lw '
      title = ' title "'//trim(NAMES(kind))//trim(merge('              ', ', with normals', is_crowded))//'"'
      is_line = (strip%side(:strip%n) < 0.0_wp) .eqv. kind /= OTHER
      if (any(is_line)) then
         call begin_block(symbols, trim(NAMES(kind)), '', drawn//to_text(WIDTHS(kind)*merge(THIN, 1.0_wp, is_crowded), 3)//title)
         do i = 1, strip%n
            if (is_line(i)) call put_stroke(symbols, RESTS, strip%x(:, :, i))
         end do
         title = ''
      end if
      if (is_crowded) return
      call list_ticks(strip, BETWEEN(kind)*symbols%pixel, symbols%window, ticks)
      if (size(ticks, 2) == 0) return
      call begin_block(symbols, 'normals', '', drawn//'1.2'//title)
      do i = 1, size(ticks, 2, kind=ip)
         call put_stroke(symbols, RESTS, reshape([ticks(:2, i), ticks(:2, i) + TICK*symbols%pixel*ticks(3:, i)], [2, 2]))
      end do
   end subroutine put_strip

   !> Normals along the pieces, where the bodies are, and so far apart that they can be seen one by one.
   subroutine list_ticks(strip, spacing, window, ticks)
      type(strip_t), intent(in) :: strip
      real(wp), intent(in) :: spacing               !< [L]
      type(range_t), intent(in) :: window(2)        !< where the bodies are [L]
      real(wp), allocatable, intent(out) :: ticks(:, :)   !< (4, n) place and unit normal
      real(wp), allocatable :: share(:, :)          ! of a piece that lies in the window, from and to
      real(wp) :: length, d(2)
      integer(ip), allocatable :: n(:)              ! normals of a piece
      integer(ip) :: i, k, total

      allocate (share(2, strip%n), n(strip%n))
      n = 0
      do i = 1, strip%n
         share(:, i) = share_in(strip%x(:, 1, i), strip%x(:, 3, i), window)
         length = (share(2, i) - share(1, i))*norm2(strip%x(:, 3, i) - strip%x(:, 1, i))
         if (share(2, i) >= share(1, i)) n(i) = max(1_ip, int(min(MOST_TICKS, length/spacing), ip))
      end do
      allocate (ticks(4, sum(n)))
      total = 0
      do i = 1, strip%n
         ! A piece is the parabola through its ends x1, x3 and its middle x2,
         !    x(t) = (1 - t)(1 - 2t) x1 + 4t(1 - t) x2 + t(2t - 1) x3,    0 <= t <= 1,
         ! and its normal is its derivative turned by 90 degrees, to the side on which the outside is.
         do k = 1, n(i)
            total = total + 1
            associate (x => strip%x(:, :, i), t => share(1, i) + (share(2, i) - share(1, i))*(k - 0.5_wp)/n(i))
               d = (4*t - 3)*x(:, 1) + (4 - 8*t)*x(:, 2) + (4*t - 1)*x(:, 3)
               ticks(:2, total) = (1 - t)*(1 - 2*t)*x(:, 1) + 4*t*(1 - t)*x(:, 2) + t*(2*t - 1)*x(:, 3)
               ticks(3:, total) = strip%side(i)*[-d(2), d(1)]/max(norm2(d), tiny(1.0_wp))
            end associate
         end do
      end do
      ticks = ticks(:, pack([(i, i=1, total)], thinned(ticks(:2, :), spacing)))
   end subroutine list_ticks

   !> From which share of a straight line on to which it lies in a window; the second is less than the first where nowhere.
   !>
   !> Clipping by Liang and Barsky: a + t (b - a) crosses the two sides of the window across axis k at t = (side - a_k)/(b_k - a_k).
   !> The line is inside between the lesser and the greater of these; what is left after both axes is the answer. A line along an
   !> axis crosses no side across the other one: it lies between them all along, or nowhere.
   pure function share_in(a, b, window) result(share)
      real(wp), intent(in) :: a(2), b(2)            !< its ends [L]
      type(range_t), intent(in) :: window(2)        !< [L]
      real(wp) :: share(2), cuts(2)
      integer :: k

      share = [0.0_wp, 1.0_wp]
      do k = 1, 2
         if (abs(b(k) - a(k)) > EVEN*span(window(k))) then
            cuts = ([window(k)%low, window(k)%high] - a(k))/(b(k) - a(k))
            share = [max(share(1), minval(cuts)), min(share(2), maxval(cuts))]
         else if (a(k) < window(k)%low - EVEN*span(window(k)) .or. a(k) > window(k)%high + EVEN*span(window(k))) then
            share = [1.0_wp, 0.0_wp]
         end if
      end do
   end function share_in

end module atrito_surface_symbols
