!> What the pressures of a pair show by themselves: too few points carry a contact of sides that curve apart, or too few faces of
!> the master face it, pressures that go up and down from point to point, pairs that never close.
!>
!> All of it is judged by the points and their pressures, each pair in the increment in which it carries most.
module atrito_pressure_warnings
   use atrito_element_table, only: DEGREE_OF
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: face_nodes
   use atrito_messages, only: add_note, add_warning
   use atrito_model, only: model_t
   use atrito_points, only: contact_points_t
   use atrito_results, only: contact_result_t, history_t, pair_scene_t, results_t, view_frame, POINT_OPEN
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: warn_of_pressures, few_points_t, find_few_points, alternation_t, find_alternation

   !> A zone of pressure with too few points.
   type :: few_points_t
      integer(ip) :: n = 0                       !< closed points, 0: none; where the zone ends with the surface, as in its mirror
      integer(ip) :: point = 0                   !< the one with the largest pressure
      logical :: of_master = .false.             !< n counts distances of the master's nodes along the zone
   end type few_points_t

   !> A stretch of points whose pressures go up and down.
   type :: alternation_t
      integer(ip) :: swings = 0                  !< 0: none
      integer(ip) :: first = 0, last = 0         !< points
      real(wp) :: mean = 0.0_wp, least = 0.0_wp, greatest = 0.0_wp !< of the stretch [F/L^2]
   end type alternation_t

   !> Closed points from which on the largest pressure of Hertz is off by less than 5 %, on faces with two nodes and with three
   !> (tests/verify/pressures-told has the errors).
   integer(ip), parameter :: ENOUGH(2) = [4_ip, 6_ip]
   !> Distances of the master's nodes along the zone from which on they let a finer slave have Hertz's pressure to as much: what the
   !> master cannot follow the slave takes, on one straight face three times the pressure (tests/verify/pressures-told).
   real(wp), parameter :: ENOUGH_OPPOSITE = 3.5_wp
   !> What round-off, and the shape of faces, leave of a gap that opens, as a part of the gap that is there under load.
   real(wp), parameter :: OPENS = 0.5_wp
   !> By what part the slope of a gap that curves grows from one face to the next: a parabola with 6 points has 2/7, a wedge 0.
   real(wp), parameter :: CURVES = 0.1_wp
   real(wp), parameter :: SWING = 0.3_wp         !< of the mean pressure: less is no swing
   integer(ip), parameter :: NEAR = 3_ip         !< points between a swing and the next one: more is a field that varies
   integer(ip), parameter :: MOST_SWINGS = 5_ip  !< singular edges swing less often
   real(wp), parameter :: SLACK = 1.0e-6_wp      !< round-off in the distance of points, in parts of it
   integer(ip), parameter :: MOST_NAMES = 3_ip

contains

   !> All pairs of a run that was solved, each in the frame where it carries most.
   subroutine warn_of_pressures(model, history)
      type(model_t), intent(in) :: model         !< points and pairs
      type(history_t), intent(in) :: history     !< all frames solved, or nothing is told
      type(few_points_t) :: few, fewest
      type(alternation_t) :: found, worst
      type(contact_result_t), allocatable :: most(:)
      logical, allocatable :: is_open(:)
      integer(ip) :: i, pair_of_few, pair_of_worst, n_few, n_alternating
      logical :: moves

      if (size(history%frames) == 0 .or. .not. allocated(model%points)) return
      if (.not. all(history%frames%converged .and. history%frames%law_holds)) return
      call go_through(history, most, is_open, moves)
      n_few = 0
      n_alternating = 0
      pair_of_few = 0
      pair_of_worst = 0
      do i = 1, size(model%points, kind=ip)
         call find_few_points(model%points(i), most(i), ENOUGH(degree_of_slave(model, i)), few, spacing_opposite(model, i, most(i)))
         if (few%n > 0) then
            n_few = n_few + 1
            if (pair_of_few == 0 .or. few%n < fewest%n) then
               fewest = few
               pair_of_few = i
            end if
         end if
         call find_alternation(most(i), found)
         if (found%swings > 0) then
            n_alternating = n_alternating + 1
            if (found%swings > worst%swings) then
               worst = found
               pair_of_worst = i
            end if
         end if
      end do
      associate (pairs => history%frames(size(history%frames))%scene%pairs)
         if (n_few > 0) call tell_few_points(model, pairs(pair_of_few), pair_of_few, fewest, n_few)
         if (n_alternating > 0) call tell_alternation(pairs(pair_of_worst), model%points(pair_of_worst), &
                                                      worst, n_alternating)
         if (moves) call note_open_pairs(pairs, is_open)
      end associate
   end subroutine warn_of_pressures

   !> Each pair where it carries most (in the last of such frames), which are open in all frames, and whether anything moves.
   subroutine go_through(history, most, is_open, moves)
      type(history_t), intent(in), target :: history         !< with frames
      type(contact_result_t), allocatable, intent(out) :: most(:)
      logical, allocatable, intent(out) :: is_open(:)
      logical, intent(out) :: moves
      type(results_t), pointer :: frame
      real(wp), allocatable :: largest(:)
      real(wp) :: force
      integer(ip) :: i, k

      moves = .false.
      do k = 1, size(history%frames, kind=ip)
         call view_frame(history, k, frame)
         if (k == 1) then
            allocate (most(size(frame%contact)))
            allocate (largest(size(most)), source=-1.0_wp)
            allocate (is_open(size(most)), source=.true.)
         end if
         moves = moves .or. any(abs(frame%u) > 0.0_wp)
         do i = 1, size(most, kind=ip)
            is_open(i) = is_open(i) .and. all(frame%contact(i)%status == POINT_OPEN)
            force = sum(frame%contact(i)%weight*frame%contact(i)%pressure)
            if (force < largest(i)) cycle
            largest(i) = force
            most(i) = frame%contact(i)
         end do
      end do
   end subroutine go_through

   pure integer(ip) function degree_of_slave(model, i) result(degree)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i                           !< the pair

      degree = DEGREE_OF(model%mesh%shape(model%surfaces(model%pairs(i)%slave)%faces%element(1)))
   end function degree_of_slave

   !> The mean distance of the master's nodes [L] on the faces that closed points face; 0 of a rigid one, and without such points.
   pure real(wp) function spacing_opposite(model, i, contact) result(spacing)
      type(model_t), intent(in) :: model
      integer(ip), intent(in) :: i                           !< the pair
      type(contact_result_t), intent(in) :: contact          !< of the pair
      logical, allocatable :: is_faced(:)
      integer(ip) :: j, k, n

      spacing = 0.0_wp
      if (model%points(i)%rigid .or. .not. any(contact%pressure > 0.0_wp)) return
      allocate (is_faced(model%mesh%n_nodes), source=.false.)
      associate (points => model%points(i), faces => model%surfaces(model%pairs(i)%master)%faces)
         do j = 1, points%n
            if (contact%pressure(j) > 0.0_wp) is_faced(points%entry(points%first(j):points%first(j + 1) - 1)) = .true.
         end do
         n = 0
         do k = 1, faces%n
            associate (nodes => face_nodes(model%mesh, faces%element(k), faces%face(k)))
               if (.not. all(is_faced(nodes(:2)))) cycle
               spacing = spacing + norm2(model%mesh%x(:, nodes(2)) - model%mesh%x(:, nodes(1)))
               n = n + size(nodes, kind=ip) - 1
            end associate
         end do
      end associate
      spacing = spacing/max(n, 1_ip)
   end function spacing_opposite

   subroutine tell_few_points(model, pair, i, few, n)
      type(model_t), intent(in) :: model
      type(pair_scene_t), intent(in) :: pair
      integer(ip), intent(in) :: i                           !< the pair
      type(few_points_t), intent(in) :: few
      integer(ip), intent(in) :: n                           !< pairs of the kind
      character(len=:), allocatable :: error, place, text
      integer(ip) :: degree

      associate (x => model%points(i)%x(:, few%point), node => model%mesh%node_id(model%points(i)%node(few%point)))
         place = 'round node '//to_text(node)//' ('//to_text(x(1), 5)//', '//to_text(x(2), 5)//')'
      end associate
      text = pair%slave//' on '//pair%master//': sides that curve apart touch '
      if (few%of_master) then
         text = text//place//' over hardly '//to_text(few%n)//trim(merge(' distance ', ' distances', few%n == 1))// &
                ' of the nodes of '//pair%master//', which cannot follow the finer slave; the largest pressure may be '// &
                trim(merge('several times too large', 'half too large         ', few%n == 1))//'. Faces of '//pair%master// &
                ' of 1/'//to_text(merge(5_ip, (4 + few%n)/few%n, few%n == 1))//' of their length help, or that side as slave'
      else
         ! the largest errors of Hertz's pressure that were seen with so many points
         degree = degree_of_slave(model, i)
         error = '10 %'
         if (few%n <= 3) error = trim(merge('half of it', '15 %      ', degree == 2))
         if (few%n == 1) error = 'more than half of it'
         text = text//'at '//to_text(few%n)//trim(merge(' point ', ' points', few%n == 1))//' only, '//place// &
                '; the largest pressure may be off by '//error//'. Faces there of 1/'// &
                to_text((ENOUGH(degree) + few%n)/few%n)//' of their length bring enough points'
      end if
      if (n > 1) text = text//'; so it is in '//to_text(n - 1)//' more pairs'
      call add_warning('W-FEW-POINTS', text)
   end subroutine tell_few_points

   subroutine tell_alternation(pair, points, found, n)
      type(pair_scene_t), intent(in) :: pair
      type(contact_points_t), intent(in) :: points
      type(alternation_t), intent(in) :: found
      integer(ip), intent(in) :: n                           !< pairs of the kind
      character(len=:), allocatable :: text

      text = pair%slave//' on '//pair%master//': the pressure goes up and down from point to point, between ' &
             //to_text(found%least, 4)//' and '//to_text(found%greatest, 4)//' [F/L^2] from s = ' &
             //to_text(points%s(found%first), 4)//' to '//to_text(points%s(found%last), 4)//' [L]; what it means is its mean, ' &
             //to_text(found%mean, 4)//'. '
      if (points%is_mortar) then
         text = text//'Exchange slave and master, or make the slave no finer than the master'
      else if (points%matching .or. points%rigid) then
         text = text//'A coarser slave, or elements that do not lock, may help'
      else
         text = text//'QUADRATURE=MORTAR, or slave and master exchanged, may help'
      end if
      if (n > 1) text = text//'; so it does in '//to_text(n - 1)//' more pairs'
      call add_warning('W-ALTERNATES', text)
   end subroutine tell_alternation

   !> Pairs without a closed point in any frame of a scene in which something moves.
   subroutine note_open_pairs(pairs, is_open)
      type(pair_scene_t), intent(in) :: pairs(:)
      logical, intent(in) :: is_open(:)
      character(len=:), allocatable :: text
      integer(ip) :: i, told

      if (.not. any(is_open)) return
      text = ''
      told = 0
      do i = 1, size(pairs, kind=ip)
         if (.not. is_open(i) .or. told == MOST_NAMES) cycle
         if (told > 0) text = text//', '
         told = told + 1
         text = text//pairs(i)%slave//' on '//pairs(i)%master
      end do
      if (count(is_open) > told) text = text//' and '//to_text(count(is_open, kind=ip) - told)//' more'
      call add_note('N-OPEN', trim(merge('a pair that never closes', 'pairs that never close  ', count(is_open) == 1))//': '//text)
   end subroutine note_open_pairs

   !> The zone of pressure with the fewest points among those that are less than enough, where the sides curve apart beside it: the
   !> gap that they had without load opens on all free sides of the zone, and ever faster. A hinge of straight sides has no such
   !> gap, that of a wedge opens evenly. Where a zone ends with the surface it is the half of one, as at a line of symmetry. Where
   !> there are enough points the master's nodes may lie too far apart. A single open point between closed ones does not end a zone.
   pure subroutine find_few_points(points, contact, enough_points, few, spacing)
      type(contact_points_t), intent(in) :: points  !< of the pair
      type(contact_result_t), intent(in) :: contact !< of the pair
      integer(ip), intent(in) :: enough_points      !< > 1
      type(few_points_t), intent(out) :: few        !< n 0: there is no such zone
      real(wp), intent(in), optional :: spacing     !< of the master's nodes [L]; 0, left out: a rigid one
      real(wp) :: length, stride
      integer(ip) :: before(points%n), behind(points%n), j, k, last, n
      logical :: ends(2), of_master

      call link_neighbours(points, contact, before, behind)
      do j = 1, points%n
         if (contact%pressure(j) <= 0.0_wp) cycle
         if (next_closed(contact, j, before) > 0) cycle
         last = j
         n = 0
         length = 0.0_wp
         k = j
         do while (k > 0)
            last = k
            n = n + 1
            length = length + points%length(k)
            k = next_closed(contact, k, behind)
         end do
         ends = [before(j) == 0, behind(last) == 0]
         if (all(ends)) cycle
         if (any(ends)) then
            n = 2*n - 1
            length = 2*length
         end if
         of_master = .false.
         if (n >= enough_points .and. present(spacing)) then
            of_master = length < ENOUGH_OPPOSITE*spacing
            if (of_master) n = max(nint(length/spacing, ip), 1_ip)
         end if
         if (.not. (n < enough_points .or. of_master) .or. (few%n > 0 .and. n >= few%n)) cycle
         stride = 0.0_wp
         if (of_master) stride = spacing
         if (.not. curves_apart(points, contact, j, before, stride)) cycle
         if (.not. curves_apart(points, contact, last, behind, stride)) cycle
         few%n = n
         few%of_master = of_master
         few%point = j
         do while (last /= j)
            if (contact%pressure(last) > contact%pressure(few%point)) few%point = last
            last = before(last)
         end do
      end do
   end subroutine find_few_points

   !> The points beside each along its surface, 0 where there is none; a closed surface goes on with its first one.
   pure subroutine link_neighbours(points, contact, before, behind)
      type(contact_points_t), intent(in) :: points
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(out) :: before(:), behind(:)       !< (points)
      integer(ip) :: j

      before = 0
      behind = 0
      do j = 2, points%n
         if (.not. contact%follows(j)) cycle
         before(j) = j - 1
         behind(j - 1) = j
      end do
      associate (n => points%n)
         if (n < 3) return
         if (before(1) > 0 .or. norm2(points%x(:, 1) - points%x(:, n)) > (1 + SLACK)*(points%length(1) + points%length(n))) return
         before(1) = n
         behind(n) = 1
      end associate
   end subroutine link_neighbours

   !> The closed point that follows one, or the one behind that; 0: neither is.
   pure integer(ip) function next_closed(contact, j, next) result(k)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: j
      integer(ip), intent(in) :: next(:)                     !< the point beyond each

      k = next(j)
      if (k == 0) return
      if (contact%pressure(k) > 0.0_wp) return
      k = next(k)
      if (k == 0) return
      if (contact%pressure(k) <= 0.0_wp) k = 0
   end function next_closed

   !> Whether the sides curve away from each other beyond the end of a zone; so they do, as far as is known, where the surface ends.
   !> Gaps are compared at three points, the next ones or such as are no nearer to each other than the stride: within a face of the
   !> master the gap is what its chord makes of it.
   pure logical function curves_apart(points, contact, edge, next, stride) result(apart)
      type(contact_points_t), intent(in) :: points
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: edge                        !< the last closed point
      integer(ip), intent(in) :: next(:)                     !< the point beyond each
      real(wp), intent(in) :: stride                         !< [L]
      real(wp) :: growth, beyond
      integer(ip) :: first, second

      apart = .true.
      if (next(edge) == 0) return
      apart = .false.
      first = beyond_stride(edge)
      second = 0
      if (first > 0) second = beyond_stride(first)
      if (second == 0) then                                  ! the surface is shorter
         first = next(edge)
         second = next(first)
         if (second == 0) return
      end if
      if (contact%pressure(second) > 0.0_wp) return
      growth = points%gap(first) - points%gap(edge)
      if (growth <= OPENS*contact%gap(first)) return
      growth = growth/norm2(points%x(:, first) - points%x(:, edge))
      beyond = (points%gap(second) - points%gap(first))/norm2(points%x(:, second) - points%x(:, first))
      apart = beyond - growth > CURVES*beyond

   contains

      !> The next point that is as far as the stride; 0: the surface ends before.
      pure integer(ip) function beyond_stride(j) result(k)
         integer(ip), intent(in) :: j

         k = next(j)
         do while (k > 0)
            if (norm2(points%x(:, k) - points%x(:, j)) >= stride) return
            k = next(k)
            if (k == j) k = 0
         end do
      end function beyond_stride
   end function curves_apart

   !> The longest stretch in which the pressure has more extremes, no more than NEAR points apart, than any edge makes.
   !>
   !> A zigzag of the pressure is followed from point to point along neighbours: `extreme` is the last high or low so far, `way`
   !> which of them is looked for.
   !>
   !>     further the same way                     the extreme moves on
   !>     back by least_swing or more              a swing: the extreme is confirmed, the other way is looked for
   !>     more than NEAR points since the last     a field that varies, no zigzag: the count begins anew
   !>     no neighbour                             the stretch ends
   !>
   !> A smooth pressure has one swing up and one down, singular edges some more. Only more than MOST_SWINGS in one stretch are
   !> told.
   pure subroutine find_alternation(contact, found)
      type(contact_result_t), intent(in) :: contact !< of a pair
      type(alternation_t), intent(out) :: found     !< swings 0: there is none
      real(wp) :: least_swing
      integer(ip) :: j, extreme, confirmed, first, swings, way

      if (.not. any(contact%pressure > 0.0_wp)) return
      least_swing = SWING*sum(contact%weight*contact%pressure)/sum(contact%weight, mask=contact%pressure > 0.0_wp)
      extreme = 1
      confirmed = 1
      first = 1
      swings = 0
      way = 0
      do j = 2, contact%n
         if (.not. contact%follows(j)) then
            call keep_longest(contact, first, confirmed, swings, found)
            extreme = j
            confirmed = j
            first = j
            swings = 0
            way = 0
            cycle
         end if
         associate (change => contact%pressure(j) - contact%pressure(extreme))
            if (way*change > 0.0_wp) then
               extreme = j                                   ! further the same way
            else if (abs(change) >= least_swing) then
               if (extreme - confirmed > NEAR) then
                  call keep_longest(contact, first, confirmed, swings, found)
                  first = extreme
                  swings = 0
               end if
               swings = swings + 1
               confirmed = extreme
               extreme = j
               way = merge(1_ip, -1_ip, change > 0.0_wp)
            end if
         end associate
      end do
      call keep_longest(contact, first, confirmed, swings, found)
   end subroutine find_alternation

   pure subroutine keep_longest(contact, first, last, swings, found)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: first, last, swings
      type(alternation_t), intent(inout) :: found

      if (swings <= max(MOST_SWINGS, found%swings)) return
      found%swings = swings
      found%first = first
      found%last = last
      associate (p => contact%pressure(first:last), w => contact%weight(first:last))
         found%least = minval(p)
         found%greatest = maxval(p)
         found%mean = sum(w*p)/sum(w)
      end associate
   end subroutine keep_longest

end module atrito_pressure_warnings
