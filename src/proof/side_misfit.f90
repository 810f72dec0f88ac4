!> What contact sides lack of fitting together, as the bound of the error counts it (docs/theory/proof.md).
!>
!> For displacements u_h that may overlap, any displacements w that are 0 at supports, and tractions p^, t^ that the laws allow,
!>
!>     ||u_h - u||^2 <= ||s^ - C eps(u_h)||^2 + ||w||^2 + 2 int rho_n(g - delta p^ - w_n) + rho_t(r - c t^/tau - w_T)     (1)
!>
!> rho what the laws lack of being met (atrito_law_lack), w_n and w_T how far w moves the sides apart.
!> So the sides may be moved, by w, where that costs less than rho, and without delta they must be where they overlap. w is found
!> by descent on a strip of triangles: one after the other corners alone, both sides of a place apart, and both together.
module atrito_side_misfit
   use atrito_assembly, only: fem_t
   use atrito_contact_segments, only: segment_t
   use atrito_contact_tractions, only: SAME_DIRECTION
   use atrito_kinds, only: ip, lp, wp
   use atrito_law_lack, only: axis_of, balanced_jump, lack_of_part, traction_of_law
   use atrito_misfit_places, only: jump_at, list_places, part_count, part_ends, place_t, strip_places_t
   use atrito_sorting, only: each_once, sorted_places
   use atrito_strip_mesh, only: strip_energy, strip_t
   implicit none (type, external)
   private
   public :: add_misfit

   integer, parameter :: SWEEPS = 20, MOST_ROUNDS = 100
   integer, parameter :: EACH = 4                   !< sweep that moves corners with several places, too
   real(wp), parameter :: WORTH = 0.005_wp          !< of the bound's square: sweeps that gain less are the last ones
   real(wp), parameter :: SETTLED = 1.0e-8_wp       !< of the largest motion
   real(wp), parameter :: BEYOND = 1.5_wp           !< corners without contact move by so many times what is in balance
   real(wp), parameter :: ROUND_OFF = 1.0e-13_wp    !< of the displacements

contains

   !> Adds the terms of (1) behind the first one to the elements' shares.
   subroutine add_misfit(fem, held, segments, u, behind, share, of_law, why_not)
      type(fem_t), intent(in) :: fem
      logical, intent(in) :: held(:, :)             !< (2, n_nodes)
      type(segment_t), intent(in) :: segments(:)
      real(wp), intent(in) :: u(:, :)               !< (2, n_nodes) [L]
      type(strip_places_t), intent(inout) :: behind !< that of sides which are cut so, or nothing yet
      real(wp), intent(inout) :: share(:)           !< (n_elements) [F L]
      real(wp), intent(out) :: of_law(3)            !< in sum: ||w||^2, 2 int rho_n, 2 int rho_t [F L]
      character(len=:), allocatable, intent(inout) :: why_not !< supports that do not let the sides move apart
      type(place_t), allocatable :: places(:)
      real(wp), allocatable :: w(:, :)
      real(wp), allocatable :: of_elements(:)
      real(wp) :: none, before, bulk, gain
      integer(ip) :: round
      logical :: overlaps, is_settled

      of_law = 0.0_wp
      if (size(segments) == 0) return
      none = ROUND_OFF*maxval(abs(u))
      bulk = sum(share)
      call list_places(fem, held, segments, u, behind, places)
      allocate (w(2, behind%strip%n), source=0.0_wp)
      allocate (of_elements(size(share)))
      call sum_terms(overlaps)
      gain = sum(of_law)                            ! it cannot be more
      is_settled = .false.
      do round = 1, MOST_ROUNDS
         if (is_settled .or. .not. (overlaps .or. gain > WORTH*(bulk + sum(of_law)))) exit
         before = sum(of_law)
         call descend(segments, behind%strip, places, none, w, is_settled)
         call sum_terms(overlaps)
         gain = min(abs(before - sum(of_law)), sum(of_law))
      end do
      if (overlaps) why_not = 'a support keeps contact sides from moving apart'
      share = share + of_elements

   contains

      !> All terms, and as shares of the elements, those of the laws half on either side.
      subroutine sum_terms(overlaps)
         logical, intent(out) :: overlaps
         integer(ip) :: i, j, k, n
         real(wp) :: lack(2), jump(2, 2), energy
         logical :: of_part

         of_law = 0.0_wp
         of_elements = 0.0_wp
         associate (strip => behind%strip)
            do i = 1, strip%n_triangles
               energy = strip_energy(fem, strip, i, w)
               of_elements(strip%element(i)) = of_elements(strip%element(i)) + energy
               of_law(1) = of_law(1) + energy
            end do
         end associate
         overlaps = .false.
         n = 0
         do i = 1, size(segments, kind=ip)
            do k = 1, part_count(segments(i))
               n = n + 1
               do j = 1, 2
                  jump(:, j) = jump_at(segments(i), places(behind%at(j, n)), w)
               end do
               call lack_of_part(segments(i), u, part_ends(segments(i), k), jump, none, lack, of_part)
               overlaps = overlaps .or. of_part
               of_law(2:) = of_law(2:) + lack
               associate (slave => segments(i)%slave(1), master => segments(i)%master(1))
                  of_elements(slave) = of_elements(slave) + merge(0.5_wp, 1.0_wp, master > 0)*sum(lack)
                  if (master > 0) of_elements(master) = of_elements(master) + 0.5_wp*sum(lack)
               end associate
            end do
         end do
      end subroutine sum_terms

   end subroutine add_misfit

   !> Less of ||w||^2/2 + the laws of the places, by a few sweeps over all corners, there and back.
   subroutine descend(segments, strip, places, none, w, is_settled)
      type(segment_t), intent(in) :: segments(:)
      type(strip_t), intent(in) :: strip
      type(place_t), intent(in) :: places(:)
      real(wp), intent(in) :: none                  !< no motion to speak of [L]
      real(wp), intent(inout) :: w(:, :)            !< (2, n) [L]
      logical, intent(out) :: is_settled            !< nothing moves any more
      integer(ip), allocatable :: count_of(:)       ! places of a corner
      integer(ip), allocatable :: crowd(:), first(:) ! places with a corner that has others, too, those that are connected together
      integer(ip) :: i, j, sweep
      real(wp) :: change

      allocate (count_of(0:strip%n), source=0_ip)
      do i = 1, size(places, kind=ip)
         count_of(places(i)%vertex) = count_of(places(i)%vertex) + 1
      end do
      count_of(0) = 0
      call list_crowds(places, count_of, crowd, first)
      do sweep = 1, SWEEPS
         change = 0.0_wp
         do i = 1, size(places, kind=ip)
            call part_place(segments(places(i)%segment), strip, places(i), count_of, w, change)
         end do
         do i = 1, size(places, kind=ip)
            if (places(i)%vertex(2) > 0 .and. all(count_of(places(i)%vertex) == 1)) then
               call move_both(strip, places(i)%vertex, w, change)
            end if
         end do
         do i = 1, merge(size(first, kind=ip) - 1, 0_ip, mod(sweep, EACH) == 1)
            associate (together => places(crowd(first(i):first(i + 1) - 1)))
               do j = 1, size(together, kind=ip)
                  associate (vertex => together(j)%vertex)
                     call move_crowd(segments, strip, together, j, vertex(:1), w, change)
                     if (vertex(2) == 0) cycle
                     call move_crowd(segments, strip, together, j, vertex(2:), w, change)
                     call move_crowd(segments, strip, together, j, vertex, w, change)
                     call move_crowd(segments, strip, together, j, neighbours_of(together, vertex), w, change)
                  end associate
               end do
            end associate
         end do
         do i = 1, strip%n
            if (count_of(i) == 0) call move_vertex(strip, i, w, change)
         end do
         do i = strip%n, 1, -1
            if (count_of(i) == 0) call move_vertex(strip, i, w, change)
         end do
         is_settled = change <= max(SETTLED*sqrt(maxval(w(1, :)**2 + w(2, :)**2)), none)
         if (is_settled) exit
      end do
   end subroutine descend

   !> The force on a corner from what moves round it, its own motion included [F].
   pure function force_on(strip, i, w) result(force)
      type(strip_t), intent(in) :: strip
      integer(ip), intent(in) :: i
      real(wp), intent(in) :: w(:, :)
      real(wp) :: force(2)
      integer(ip) :: k

      force = -matmul(strip%own(:, :, i), w(:, i))
      do k = strip%first(i), strip%first(i + 1) - 1
         associate (c => strip%coupling(:, :, k), v => w(:, strip%other(k)))
            force = force - c(:, 1)*v(1) - c(:, 2)*v(2)
         end associate
      end do
   end function force_on

   !> A corner without contact to where it is in equilibrium.
   pure subroutine move_vertex(strip, i, w, change)
      type(strip_t), intent(in) :: strip
      integer(ip), intent(in) :: i
      real(wp), intent(inout) :: w(:, :), change
      real(wp) :: motion(2)

      if (.not. any(strip%is_free(:, i))) return
      motion = BEYOND*balanced_motion(strip%own(:, :, i), force_on(strip, i, w), strip%is_free(:, i))
      w(:, i) = w(:, i) + motion
      change = max(change, norm2(motion))
   end subroutine move_vertex

   pure function balanced_motion(k, force, is_free) result(motion)
      real(wp), intent(in) :: k(2, 2), force(2)
      logical, intent(in) :: is_free(2)
      real(wp) :: motion(2)

      motion = 0.0_wp
      if (all(is_free)) then
         motion = [k(2, 2)*force(1) - k(1, 2)*force(2), k(1, 1)*force(2) - k(2, 1)*force(1)]/(k(1, 1)*k(2, 2) - k(1, 2)*k(2, 1))
      else if (is_free(1)) then
         motion(1) = force(1)/k(1, 1)
      else if (is_free(2)) then
         motion(2) = force(2)/k(2, 2)
      end if
   end function balanced_motion

   !> Both corners of a place together, which no law sees.
   subroutine move_both(strip, vertex, w, change)
      type(strip_t), intent(in) :: strip
      integer(ip), intent(in) :: vertex(2)
      real(wp), intent(inout) :: w(:, :), change
      real(wp) :: motion(2)
      logical :: is_free(2)
      integer(ip) :: j

      is_free = strip%is_free(:, vertex(1)) .and. strip%is_free(:, vertex(2))
      if (.not. any(is_free)) return
      motion = balanced_motion(strip%own(:, :, vertex(1)) + strip%own(:, :, vertex(2)), &
                               force_on(strip, vertex(1), w) + force_on(strip, vertex(2), w), is_free)
      do j = 1, 2
         w(:, vertex(j)) = w(:, vertex(j)) + motion
      end do
      change = max(change, norm2(motion))
   end subroutine move_both

   !> Places with a corner that has more than one, those that corners connect one after the other.
   subroutine list_crowds(places, count_of, crowd, first)
      type(place_t), intent(in) :: places(:)
      integer(ip), intent(in) :: count_of(0:)       !< places of a corner
      integer(ip), allocatable, intent(out) :: crowd(:)
      integer(ip), allocatable, intent(out) :: first(:) !< (crowds + 1)
      integer(ip) :: group(0:ubound(count_of, 1)), i, low
      logical :: is_settled

      crowd = pack([(i, i=1, size(places, kind=ip))], [(any(count_of(places(i)%vertex) > 1), i=1, size(places, kind=ip))])
      group = [(i, i=0, ubound(group, 1, kind=ip))]
      do
         is_settled = .true.
         do i = 1, size(crowd, kind=ip)
            associate (vertex => pack(places(crowd(i))%vertex, places(crowd(i))%vertex > 0))
               low = minval(group(vertex))
               if (all(group(vertex) == low)) cycle
               is_settled = .false.
               group(vertex) = low
            end associate
         end do
         if (is_settled) exit
      end do
      crowd = crowd(sorted_places([(int(group(places(crowd(i))%vertex(1)), lp), i=1, size(crowd, kind=ip))]))
      first = [integer(ip) ::]
      do i = 1, size(crowd, kind=ip)
         low = 0
         if (i > 1) low = group(places(crowd(i - 1))%vertex(1))
         if (group(places(crowd(i))%vertex(1)) /= low) first = [first, i]
      end do
      first = [first, size(crowd, kind=ip) + 1_ip]
   end subroutine list_crowds

   !> Corners of all places that two corners have, each once.
   pure function neighbours_of(places, vertex) result(corners)
      type(place_t), intent(in) :: places(:)
      integer(ip), intent(in) :: vertex(2)
      integer(ip), allocatable :: corners(:)
      integer(ip) :: i

      corners = vertex
      do i = 1, size(places, kind=ip)
         if (any(places(i)%vertex(1) == vertex .or. places(i)%vertex(2) == vertex)) corners = [corners, places(i)%vertex]
      end do
      corners = each_once(pack(corners, corners > 0))
   end function neighbours_of

   !> Corners together that have several places: along the normal and along T of one of these to where all laws and the triangles
   !> are in balance, by bisection.
   subroutine move_crowd(segments, strip, places, i, vertex, w, change)
      type(segment_t), intent(in) :: segments(:)
      type(strip_t), intent(in) :: strip
      type(place_t), intent(in) :: places(:)        !< those of the corners are among them
      integer(ip), intent(in) :: i                  !< place that says where the normal is
      integer(ip), intent(in) :: vertex(:)
      real(wp), intent(inout) :: w(:, :), change
      integer, parameter :: MOST_STEPS = 50
      real(wp) :: direction(2), k, force, low, high, x
      integer(ip) :: j, d, l
      integer :: step

      do d = 1, 2
         direction = axis_of(segments(places(i)%segment), d)
         k = 0.0_wp
         force = 0.0_wp
         do j = 1, size(vertex, kind=ip)
            if (.not. all(strip%is_free(:, vertex(j)) .or. abs(direction) <= SAME_DIRECTION)) exit
            force = force + dot_product(direction, force_on(strip, vertex(j), w))
            k = k + dot_product(direction, matmul(strip%own(:, :, vertex(j)), direction))
            do l = strip%first(vertex(j)), strip%first(vertex(j) + 1) - 1
               if (.not. any(strip%other(l) == vertex)) cycle
               k = k + dot_product(direction, matmul(strip%coupling(:, :, l), direction))
            end do
         end do
         if (j <= size(vertex)) cycle
         low = 0.0_wp
         high = 0.0_wp
         x = maxval(abs(places%law(1)%y), mask=places%weight > 0.0_wp) + farthest() + abs(force)/k
         if (pull_at(0.0_wp) > 0.0_wp) high = x
         if (pull_at(0.0_wp) < 0.0_wp) low = -x
         do step = 1, MOST_STEPS
            x = 0.5_wp*(low + high)
            if (.not. (x > low .and. x < high)) exit
            if (pull_at(x) > 0.0_wp) low = x
            if (.not. pull_at(x) > 0.0_wp) high = x
         end do
         x = merge(high, low, abs(pull_at(high)) <= abs(pull_at(low)))
         do j = 1, size(vertex, kind=ip)
            where (strip%is_free(:, vertex(j))) w(:, vertex(j)) = w(:, vertex(j)) + x*direction
         end do
         change = max(change, abs(x))
      end do

   contains

      !> No place has a larger jump.
      real(wp) function farthest()
         integer(ip) :: j, e

         farthest = 0.0_wp
         do j = 1, size(places, kind=ip)
            do e = 1, 2
               if (places(j)%vertex(e) > 0) farthest = max(farthest, 2*maxval(abs(w(:, places(j)%vertex(e)))))
            end do
         end do
      end function farthest

      !> What would move the corners further, of the triangles and of all laws. Overlaps without delta: more than anything else.
      real(wp) function pull_at(x)
         real(wp), intent(in) :: x
         integer(ip) :: j, e
         real(wp) :: along, jump(2)

         pull_at = force - k*x
         do j = 1, size(places, kind=ip)
            if (any(places(j)%vertex(1) == vertex) .eqv. any(places(j)%vertex(2) == vertex)) cycle
            if (.not. places(j)%weight > 0.0_wp) cycle
            jump = jump_at(segments(places(j)%segment), places(j), w)
            do e = 1, 2
               along = dot_product(direction, axis_of(segments(places(j)%segment), e))
               if (any(places(j)%vertex(2) == vertex)) along = -along
               pull_at = pull_at + along*places(j)%weight*traction_of_law(places(j)%law(e), jump(e) + along*x)
            end do
         end do
      end function pull_at

   end subroutine move_crowd

   !> Both corners of a place apart or together, along the normal and along T: to where the laws and the triangles are in balance.
   subroutine part_place(segment, strip, place, count_of, w, change)
      type(segment_t), intent(in) :: segment
      type(strip_t), intent(in) :: strip
      type(place_t), intent(in) :: place
      integer(ip), intent(in) :: count_of(0:)
      real(wp), intent(inout) :: w(:, :), change
      real(wp) :: direction(2), k(2), force(2), of_side(2), jump(2), x
      integer(ip) :: d, j
      logical :: moves(2)

      if (.not. place%weight > 0.0_wp) return
      do d = 1, 2
         direction = axis_of(segment, d)
         k = 0.0_wp
         force = 0.0_wp
         do j = 1, 2
            associate (i => place%vertex(j))
               moves(j) = i > 0 .and. count_of(i) == 1
               if (.not. moves(j)) cycle
               moves(j) = all(strip%is_free(:, i) .or. abs(direction) <= SAME_DIRECTION)
               k(j) = dot_product(direction, matmul(strip%own(:, :, i), direction))
               force(j) = (3 - 2*j)*dot_product(direction, force_on(strip, i, w))
            end associate
         end do
         if (.not. any(moves)) cycle
         of_side = merge(1.0_wp, 0.0_wp, moves)
         if (all(moves)) of_side = [k(2), k(1)]/sum(k)
         jump = jump_at(segment, place, w)
         x = balanced_jump(place%law(d), place%weight, sum(of_side**2*k), sum(of_side*force), jump(d))
         do j = 1, 2
            if (.not. moves(j)) cycle
            associate (i => place%vertex(j))
               where (strip%is_free(:, i)) w(:, i) = w(:, i) + (3 - 2*j)*of_side(j)*x*direction
            end associate
         end do
         change = max(change, abs(x))
      end do
   end subroutine part_place

end module atrito_side_misfit
