!> Where between two values of a parameter a scene ceases to stand: which value is to be looked at next, and what is known so far.
!>
!> Two questions can be asked of a value. The balance is cheap: whether any forces that the contact can take balance the loads. A
!> solution costs a run. The balance narrows the limit from both sides. Then values from the end that stands on are solved, each
!> next to the one before: the curve, and the last value that can be balanced. Where runs find neither a solution nor a proof, the
!> last value that stands is looked for by strides; such values narrow neither bound.
!>
!> Why the balance may be bracketed. The loads that contact can take are a convex set (atrito_certificate), and most parameters
!> enter the loads linearly, so on the way from an end that can be balanced to one that cannot there is one value x* where that
!> changes. Of the values looked at, `reach` is the farthest from the standing end that can be balanced, `fall` the nearest to it
!> that falls: x* lies between. Where a parameter enters otherwise (an angle, a friction coefficient) a value between two that can
!> be balanced need not be so itself, which is why each is asked before it is solved.
!>
!> How it is narrowed. A value that falls comes with its excess, the share of the loads that a mechanism works beyond what friction
!> takes. As long as the mechanism is the same its excess is nearly a straight line over x, so the line through the two nearest
!> values that fall is zero near x*. The next value is not that zero but a third of the allowed width on either side of it, first
!> the one that should stand, then the one that should fall: two questions that come out as predicted leave an interval of two
!> thirds of the allowed width. Where two questions have not halved the interval the mechanism changes on the way, and a value
!> nearer to the standing end, or half way, is asked (choose_trial).
!>
!>     0          reach   x*    fall                beyond      distance from the end that stands
!>     |------------|-----.------|---------------------|
!>     stands     stands         falls, excess e1      falls, excess e2 > e1
!>
!> The zero of the line is at fall - e1 (beyond - fall)/(e2 - e1).
module atrito_stability_search
   use atrito_kinds, only: wp
   implicit none (type, external)
   private
   public :: search_t, tried_t, begin_search, next_step, suggest_root, record_balance, record_solution, standing_value, &
             falling_value, balanced_value, allowed_width
   public :: STEP_BALANCE, STEP_SOLVE, STEP_DONE
   public :: UNKNOWN, STANDS, FALLS, UNDECIDED
   public :: FOUND_LIMIT, FOUND_INTERVAL, BOTH_STAND, BOTH_FALL, NO_END_STANDS

   integer, parameter :: STEP_DONE = 0, STEP_BALANCE = 1, STEP_SOLVE = 2
   !> Answers. Of the balance STANDS means that there are forces; UNDECIDED: neither forces or a solution, nor a proof.
   integer, parameter :: UNKNOWN = 0, STANDS = 1, FALLS = 2, UNDECIDED = 3
   !> How a search ends: the limit is known as well as asked; only an interval; there is none between the ends.
   integer, parameter :: FOUND_LIMIT = 1, FOUND_INTERVAL = 2, BOTH_STAND = 3, BOTH_FALL = 4, NO_END_STANDS = 5

   !> A value that was looked at.
   type :: tried_t
      real(wp) :: x = 0.0_wp                        !< the value of the parameter
      integer :: balance = UNKNOWN                  !< STANDS, FALLS or UNDECIDED; UNKNOWN: not asked yet
      integer :: solution = UNKNOWN                 !< STANDS or UNDECIDED; what falls is not solved
      real(wp) :: excess = 0.0_wp                   !< of the balance, where it falls: by which share the loads are too much
   end type tried_t

   type :: search_t
      real(wp) :: ends(2) = 0.0_wp                  !< between which the limit is sought
      real(wp) :: tolerance = 0.0_wp                !< relative, of the interval in the end
      integer :: found = 0                          !< once done: FOUND_LIMIT, ...
      type(tried_t), allocatable :: tried(:)        !< in the order in which they were looked at
      real(wp), private :: widths(2) = huge(1.0_wp) !< of the interval before the last two questions of balance
      real(wp), allocatable, private :: root        !< where the balance is said to end
      real(wp), private :: stride = 0.0_wp          !< behind the last value that stands; 0: the curve is not there yet
   end type search_t

   !> Values of the curve, as shares of the way from the end that stands to the limit.
   real(wp), parameter :: SHARES(12) = [0.125_wp, 0.25_wp, 0.375_wp, 0.5_wp, 0.625_wp, 0.75_wp, 0.875_wp, 0.95_wp, 0.98_wp, &
                                        0.99_wp, 0.995_wp, 0.999_wp]
   !> A limit that is zero is found to the tolerance times this share of the larger end.
   real(wp), parameter :: LEAST_SIZE = 1.0e-3_wp
   !> The part of the interval to which the last value that stands is found where runs below the limit find nothing.
   real(wp), parameter :: UNDECIDED_SHARE = 0.03_wp
   !> What strides become without a solution, and where they lead to a value that is known.
   real(wp), parameter :: SHORTER = 0.5_wp, LITTLE_LESS = 0.9_wp
   !> A value beyond the root that the excess predicts is this share of the allowed width away from it.
   real(wp), parameter :: OVERSHOOT = 1.0_wp/3.0_wp
   !> What is looked at beside undecided values is so many times their range away.
   real(wp), parameter :: WIDER = 2.0_wp
   !> Of the interval, from the value that can be balanced, where both values about the root can be balanced.
   real(wp), parameter :: NEARER = 0.1_wp

contains

   !> Begins a search between two values of the parameter; tolerance: the width of the interval that is wanted, over the limit.
   pure subroutine begin_search(first, second, tolerance, search)
      real(wp), intent(in) :: first, second         !< different
      real(wp), intent(in) :: tolerance             !< > 0
      type(search_t), intent(out) :: search         !< nothing has been looked at

      search%ends = [first, second]
      search%tolerance = tolerance
      allocate (search%tried(0))
   end subroutine begin_search

   !> What to ask next, and of which value. STEP_DONE: nothing, search%found tells what came of it.
   !>
   !>     1. both ends: balance, then a solution of what can be balanced (look_at_ends)
   !>     2. the balance between them, until its interval is as wide as allowed (narrow_balance)
   !>     3. solutions at SHARES of the way to the last value that can be balanced, each next to the one before (follow_curve)
   !>     4. where some of these have none, the last value that stands, by strides (narrow_solutions)
   !>
   !> What is asked next follows from the values looked at, the widths of the last intervals and the stride; there is no other
   !> place in the search. So a value that turns out otherwise than expected, a FALLS among values to be solved, sends it back to 2
   !> by itself. Each question of 2 narrows the interval or ends it, 3 has a fixed list of values, and strides of 4 only get
   !> shorter.
   pure subroutine next_step(search, x, step)
      type(search_t), intent(inout) :: search !< strides and `found` may change
      real(wp), intent(out) :: x              !< the value; of no use where the step is STEP_DONE
      integer, intent(out) :: step            !< STEP_*
      type(tried_t) :: known
      integer :: standing

      call look_at_ends(search, x, step, standing)
      if (step /= STEP_DONE .or. search%found /= 0) return
      call narrow_balance(search, standing, x, step)
      if (step == STEP_DONE) call follow_curve(x, step)
      if (step == STEP_DONE) call narrow_solutions(search, standing, x, step)
      if (step == STEP_SOLVE) then   ! a value between two that can be balanced need not be one itself; where it falls, the limit
         known = known_of(search, x) ! is sought on this side of it
         if (known%balance == UNKNOWN) step = STEP_BALANCE
      end if
      if (step /= STEP_DONE) return
      search%found = FOUND_INTERVAL
      if (abs(falling_value(search) - standing_value(search)) <= allowed_width(search)) search%found = FOUND_LIMIT

   contains

      !> The curve, from the end that stands to the last value that can be balanced. Where one is undecided, the last one shows
      !> whether those between are worth a run.
      pure subroutine follow_curve(x, step)
         real(wp), intent(out) :: x
         integer, intent(out) :: step
         type(tried_t) :: one, last
         real(wp) :: start, reach
         logical :: is_open
         integer :: i

         start = search%ends(standing)
         last = known_of(search, reached_value(search, start, distance_of_fall(search, start)))
         reach = abs(last%x - start)
         is_open = .false.
         step = STEP_SOLVE
         do i = 1, size(SHARES)
            x = start + signed(search, standing, SHARES(i)*reach)
            one = known_of(search, x)
            is_open = is_open .or. one%solution == UNDECIDED
            if (is_open .and. last%solution /= STANDS) exit
            if (one%solution == UNKNOWN) return
         end do
         x = last%x
         if (last%solution /= UNKNOWN) step = STEP_DONE
      end subroutine follow_curve

   end subroutine next_step

   !> The ends come first. Two that can be balanced are both solved, to tell what they are.
   pure subroutine look_at_ends(search, x, step, standing)
      type(search_t), intent(inout) :: search
      real(wp), intent(out) :: x
      integer, intent(out) :: step, standing        !< standing: 1 or 2, the end that does
      type(tried_t) :: at(2)
      integer :: i

      step = STEP_DONE
      standing = 0
      x = search%ends(1)
      do i = 1, 2
         at(i) = known_of(search, search%ends(i))
         if (at(i)%balance /= UNKNOWN) cycle
         x = search%ends(i)
         step = STEP_BALANCE
         return
      end do
      do i = 1, 2
         if (has_fallen(at(i)) .or. at(i)%solution /= UNKNOWN) cycle
         x = search%ends(i)
         step = STEP_SOLVE
         return
      end do
      if (all(has_fallen(at))) then
         search%found = BOTH_FALL
      else if (all(at%solution == STANDS)) then
         search%found = BOTH_STAND
      else if (.not. any(has_fallen(at)) .or. any(at%solution == UNDECIDED)) then
         search%found = NO_END_STANDS
      else
         standing = findloc(has_fallen(at), .false., dim=1)
      end if
   end subroutine look_at_ends

   !> Asks the balance until the values that can and cannot be balanced are as close as allowed, or as what is undecided lets them.
   pure subroutine narrow_balance(search, standing, x, step)
      type(search_t), intent(inout) :: search
      integer, intent(in) :: standing
      real(wp), intent(out) :: x
      integer, intent(out) :: step
      type(tried_t) :: known
      real(wp) :: start, reach, fall, low, high, at, allowed, width
      integer :: i

      start = search%ends(standing)
      fall = distance_of_fall(search, start)
      reach = abs(reached_value(search, start, fall) - start)
      allowed = width_of([start + signed(search, standing, reach), start + signed(search, standing, fall)], search)
      low = fall
      high = reach
      do i = 1, size(search%tried)                  ! what is undecided between them is left out
         at = abs(search%tried(i)%x - start)
         if (search%tried(i)%balance /= UNDECIDED .or. at <= reach .or. at >= fall) cycle
         low = min(low, at)
         high = max(high, at)
      end do
      x = start
      step = STEP_DONE
      if (low >= fall) then
         if (fall - reach <= allowed) return
         call choose_trial(search, start, reach, fall, allowed, at)
      else
         if (max(low - reach, fall - high) <= 0.25_wp*allowed) return
         ! an end that is far away is left alone
         width = max(WIDER*(high - low), allowed)
         at = low - min(0.5_wp*(low - reach), width)
         if (fall - high > low - reach) at = high + min(0.5_wp*(fall - high), width)
      end if
      x = start + signed(search, standing, at)
      known = known_of(search, x)
      if (known%balance == UNKNOWN) step = STEP_BALANCE   ! else: rounding leaves no value between
   end subroutine narrow_balance

   !> Behind the last value that stands, by strides that get shorter where there is no solution: from near by a value may have one
   !> that had none from farther away.
   pure subroutine narrow_solutions(search, standing, x, step)
      type(search_t), intent(inout) :: search
      integer, intent(in) :: standing
      real(wp), intent(out) :: x
      integer, intent(out) :: step
      real(wp) :: start, stand, fall, next, at
      type(tried_t) :: known
      integer :: i

      start = search%ends(standing)
      stand = abs(standing_value(search) - start)
      fall = distance_of_fall(search, start)
      next = fall                                   ! or the first undecided value behind the last one that stands
      do i = 1, size(search%tried)
         at = abs(search%tried(i)%x - start)
         if (search%tried(i)%solution == UNDECIDED .and. at > stand) next = min(next, at)
      end do
      step = STEP_DONE
      x = start
      if (fall - stand <= allowed_width(search)) return
      if (search%stride <= 0.0_wp .and. next < fall) search%stride = 0.5_wp*(next - stand)
      search%stride = min(search%stride, 0.5_wp*(fall - stand))
      if (search%stride <= max(allowed_width(search), UNDECIDED_SHARE*(fall - stand))) return
      step = STEP_SOLVE
      do
         x = start + signed(search, standing, stand + search%stride)
         known = known_of(search, x)
         if (known%solution == UNKNOWN) return
         search%stride = LITTLE_LESS*search%stride
      end do
   end subroutine narrow_solutions

   !> The next distance from the end that stands: a little on either side of the root that the excess predicts, or half way where
   !> that has not halved the interval lately.
   pure subroutine choose_trial(search, start, reach, fall, allowed, at)
      type(search_t), intent(inout) :: search
      real(wp), intent(in) :: start, reach, fall, allowed
      real(wp), intent(out) :: at
      real(wp) :: root, aside
      logical :: slow, found

      slow = fall - reach > 0.5_wp*search%widths(1)
      search%widths = [search%widths(2), fall - reach]
      call predict_root(search, start, reach, fall, root, found)
      at = 0.5_wp*(reach + fall)
      if (.not. found) return
      aside = OVERSHOOT*allowed
      if (allocated(search%root)) aside = OVERSHOOT*width_of([search%root], search)
      if (slow) then                                ! the line is no good from so far, a nearer value makes a better one
         if (root - aside <= reach + 0.1_wp*aside) at = reach + NEARER*(fall - reach)
      else if (root - aside > reach + 0.1_wp*aside) then
         if (root - aside < fall) at = root - aside
      else if (root + aside < fall .and. root + aside > reach) then
         at = root + aside
      end if
   end subroutine choose_trial

   !> Where the balance is said to end; or, where that is not between what stands and what falls, where the line through the excess
   !> of the two nearest values that fall is zero.
   pure subroutine predict_root(search, start, reach, fall, root, found)
      type(search_t), intent(in) :: search
      real(wp), intent(in) :: start, reach, fall
      real(wp), intent(out) :: root
      logical, intent(out) :: found
      real(wp) :: at, beyond, excess(2)
      integer :: i

      if (allocated(search%root)) then
         root = abs(search%root - start)
         found = root >= reach .and. root <= fall
         if (found) return
      end if
      beyond = huge(beyond)
      excess = 0.0_wp
      do i = 1, size(search%tried)
         associate (one => search%tried(i))
            at = abs(one%x - start)
            if (one%balance /= FALLS .or. at < fall .or. at >= beyond) cycle
            if (at <= fall) then
               excess(1) = one%excess
            else
               beyond = at
               excess(2) = one%excess
            end if
         end associate
      end do
      root = fall
      found = excess(1) > 0.0_wp .and. excess(2) > excess(1)
      if (found) root = fall - excess(1)*(beyond - fall)/(excess(2) - excess(1))
   end subroutine predict_root

   !> Where the balance ends by what else is known of the scene; it is asked about, not believed.
   pure subroutine suggest_root(search, x)
      type(search_t), intent(inout) :: search !< the root is kept
      real(wp), intent(in) :: x               !< between the ends

      search%root = x
   end subroutine suggest_root

   !> What the balance of the loads at a value was found to be.
   pure subroutine record_balance(search, x, answer, excess)
      type(search_t), intent(inout) :: search       !< gets the answer
      real(wp), intent(in) :: x                     !< as next_step gave it
      integer, intent(in) :: answer                 !< STANDS, FALLS or UNDECIDED
      real(wp), intent(in) :: excess                !< > 0 where it falls
      integer :: i

      call find_or_add(search, x, i)
      search%tried(i)%balance = answer
      search%tried(i)%excess = excess
   end subroutine record_balance

   !> What a solution at a value came to.
   pure subroutine record_solution(search, x, answer)
      type(search_t), intent(inout) :: search       !< gets the answer
      real(wp), intent(in) :: x                     !< as next_step gave it
      integer, intent(in) :: answer                 !< STANDS or UNDECIDED
      integer :: i

      call find_or_add(search, x, i)
      search%tried(i)%solution = answer
      if (answer /= STANDS) search%stride = SHORTER*search%stride
   end subroutine record_solution

   !> The value nearest to the limit that has a solution.
   pure real(wp) function standing_value(search) result(x)
      type(search_t), intent(in) :: search !< begun
      real(wp) :: start, fall, at, farthest
      integer :: i

      start = start_of(search)
      fall = distance_of_fall(search, start)
      x = start
      farthest = 0.0_wp
      do i = 1, size(search%tried)
         at = abs(search%tried(i)%x - start)
         if (search%tried(i)%solution /= STANDS .or. at >= fall .or. at < farthest) cycle
         farthest = at
         x = search%tried(i)%x
      end do
   end function standing_value

   !> The value nearest to it that has none.
   pure real(wp) function falling_value(search) result(x)
      type(search_t), intent(in) :: search !< begun
      real(wp) :: start, fall
      integer :: i

      start = start_of(search)
      fall = distance_of_fall(search, start)
      x = sum(search%ends) - start
      do i = 1, size(search%tried)
         if (has_fallen(search%tried(i)) .and. abs(search%tried(i)%x - start) <= fall) x = search%tried(i)%x
      end do
   end function falling_value

   !> The value nearest to that one whose loads can be balanced, solved or not.
   pure real(wp) function balanced_value(search) result(x)
      type(search_t), intent(in) :: search !< begun
      real(wp) :: start

      start = start_of(search)
      x = reached_value(search, start, distance_of_fall(search, start))
   end function balanced_value

   !> How far apart the two may be in the end.
   pure real(wp) function allowed_width(search)
      type(search_t), intent(in) :: search !< begun

      allowed_width = width_of([standing_value(search), falling_value(search)], search)
   end function allowed_width

   pure real(wp) function width_of(interval, search) result(width)
      real(wp), intent(in) :: interval(:)
      type(search_t), intent(in) :: search

      width = search%tolerance*max(maxval(abs(interval)), LEAST_SIZE*maxval(abs(search%ends)))
   end function width_of

   !> The end from which distances are told: the one that has not fallen.
   pure real(wp) function start_of(search) result(x)
      type(search_t), intent(in) :: search

      x = search%ends(1)
      if (has_fallen(known_of(search, x))) x = search%ends(2)
   end function start_of

   pure real(wp) function signed(search, standing, distance)
      type(search_t), intent(in) :: search
      integer, intent(in) :: standing
      real(wp), intent(in) :: distance

      signed = sign(distance, search%ends(3 - standing) - search%ends(standing))
   end function signed

   !> From the end that stands to the nearest value that falls.
   pure real(wp) function distance_of_fall(search, start) result(distance)
      type(search_t), intent(in) :: search
      real(wp), intent(in) :: start
      integer :: i

      distance = abs(search%ends(2) - search%ends(1))
      do i = 1, size(search%tried)
         if (has_fallen(search%tried(i))) distance = min(distance, abs(search%tried(i)%x - start))
      end do
   end function distance_of_fall

   !> The value farthest from there that can be balanced, before one falls.
   pure real(wp) function reached_value(search, start, fall) result(x)
      type(search_t), intent(in) :: search
      real(wp), intent(in) :: start, fall
      real(wp) :: at
      integer :: i

      x = start
      do i = 1, size(search%tried)
         associate (one => search%tried(i))
            at = abs(one%x - start)
            if (at >= fall .or. at < abs(x - start)) cycle
            if (one%balance == STANDS .or. one%solution == STANDS) x = one%x
         end associate
      end do
   end function reached_value

   pure elemental logical function has_fallen(one)
      type(tried_t), intent(in) :: one

      has_fallen = one%balance == FALLS
   end function has_fallen

   pure type(tried_t) function known_of(search, x) result(known)
      type(search_t), intent(in) :: search
      real(wp), intent(in) :: x
      integer :: i

      known%x = x
      do i = 1, size(search%tried)
         if (abs(search%tried(i)%x - x) <= 0.0_wp) known = search%tried(i)
      end do
   end function known_of

   pure subroutine find_or_add(search, x, i)
      type(search_t), intent(inout) :: search
      real(wp), intent(in) :: x
      integer, intent(out) :: i

      do i = 1, size(search%tried)
         if (abs(search%tried(i)%x - x) <= 0.0_wp) return
      end do
      search%tried = [search%tried, tried_t(x)]
   end subroutine find_or_add

end module atrito_stability_search
