!> Whether the contact can take the loads of the bodies at all: p >= 0 and |t| <= nu S_rho(p) at every point with G' q = h.
!>
!> Where such forces exist, they are given. Where none do, a motion v is given that the loads drive harder than any of them can
!> resist (the lemma of Farkas): N_k v + (1/w_k) sum_j w_j nu_j W_jk |T_j v| <= 0 at every point k with an unknown pressure, and
!> h'v above what known pressures can take by friction. Both come from one linear programme a group of bodies that touch, and both
!> are checked here from the data, whatever its solver said; what passes neither check is undecided.
!>
!> Why v is a proof. Let q be any forces that the contact can take, and v a motion; q works q'G v on it. Friction works most at
!> its bound against the slip, so with p_k = q_n,k/w_k
!>
!>     q'G v <= sum_k q_n,k N_k v + sum_j w_j nu_j (sum_k W_jk p_k) |T_j v|
!>            = sum_k q_n,k (N_k v + (1/w_k) sum_j w_j nu_j W_jk |T_j v|)
!>
!> The brackets are <= 0 and q_n >= 0: what unknown pressures and their friction work on v is <= 0, whatever they are. (Pressures
!> that are known, of a prescribed overlap, add a number that does not depend on q.) If q balanced the loads, G'q = h, then h'v
!> would be that same work, and h'v > 0 beyond the known part is a contradiction. Conversely the set of all G'q is a closed convex
!> cone, for the conditions on q are linear inequalities; h outside of it is separated from it by some v, which is such a motion.
!>
!> Numbers have round-off, so v is only believed where the excess is far more than round-off of the loads' work, and MANY_TIMES
!> what forces of the bodies' size would work where a bracket is above zero by more than ROUND_OFF of its terms (motion_excess). q
!> is believed where G'q - h is round-off of the forces on each motion and on each body (forces_balance).
module atrito_certificate
   use atrito_balance_program, only: balance_program_t, build_balance_program, forces_of_columns
   use atrito_clp, only: solve_linear_program
   use atrito_contact_line, only: contact_line_t, pressure_of, friction_bound
   use atrito_joined_sets, only: find_lowest, join_sets
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_linear_program, only: linear_solution_t, LP_BY_SIMPLEX, LP_BY_BARRIER, LP_OPTIMAL, LP_NOT_AVAILABLE
   use atrito_motion_polish, only: polish_motion
   use atrito_motion_rows, only: motion_rows_t
   use atrito_sparse_rows, only: add_transposed, multiply_rows, transposed_sizes
   implicit none (type, external)
   private
   public :: certificate_t, prove_balance, find_largest_share, motion_excess, friction_work, forces_balance
   public :: BALANCE_IMPOSSIBLE, BALANCE_POSSIBLE, BALANCE_UNDECIDED, balance_groups_t, find_groups

   integer, parameter :: BALANCE_UNDECIDED = 0, BALANCE_POSSIBLE = 1, BALANCE_IMPOSSIBLE = 2

   type :: certificate_t
      integer :: verdict = BALANCE_UNDECIDED     !< BALANCE_*
      logical :: solver_missing = .false.        !< undecided because there is no solver of linear programmes
      real(wp), allocatable :: motion(:)         !< (k) IMPOSSIBLE: v, its fastest amplitude one [L]
      real(wp) :: excess = 0.0_wp                !< IMPOSSIBLE: what the loads work on v beyond what the contact can take [F L]
      real(wp), allocatable :: q(:)              !< (m) POSSIBLE: forces that balance the loads; else those that come nearest [F]
   end type certificate_t

   real(wp), parameter :: NO_LOAD = 1.0e-13_wp    !< of what was added up: round-off
   real(wp), parameter :: ROUND_OFF = 1.0e-14_wp  !< rate over its terms
   real(wp), parameter :: IN_BALANCE = 1.0e-9_wp    !< remainder over the forces on a motion
   real(wp), parameter :: OF_BODY = 1.0e-13_wp    !< remainder over the largest force on the body
   real(wp), parameter :: CLEAR = 1.0e-9_wp       !< excess over the loads' work
   real(wp), parameter :: MANY_TIMES = 1.0e8_wp   !< larger forces than those of the bodies' size, times this, are none
   real(wp), parameter :: SOME_TIMES = 1.0e3_wp   !< the same of forces that a body hands on, of the size of those beside it
   real(wp), parameter :: NO_MOTION = 1.0e-9_wp   !< of the largest, scaled by forces
   integer(ip), parameter :: MOST_PASSES = 3_ip
   integer(ip), parameter :: MANY_MOTIONS = 500_ip !< from here on interior points are faster than simplex steps

   !> Bodies that touch each other, directly or through others: the balance of each such group is a question of its own. Bodies are
   !> given by their rigid motions; one that the supports hold has none and parts the groups. Points whose pressures are averaged
   !> together belong together, since the pressure of one raises the friction of the other.
   type :: balance_groups_t
      integer(ip) :: n = 0                       !< groups
      integer(ip), allocatable :: of_motion(:)   !< (k) 1 .. n
      integer(ip), allocatable :: of_point(:)    !< (line%n) 0: no motion, and none of what it is averaged with
   end type balance_groups_t

contains

   !> Judges all groups. IMPOSSIBLE: one of them has a motion that proves it, that of the greatest excess over its loads is given.
   !>
   !>     1. groups of bodies that touch: a force or a motion of one group has no part in another one (find_groups)
   !>     2. of each group one linear programme, whose solution tries to be forces in balance, and whose duals to be a motion that
   !>        proves that there are none (judge_group)
   !>     3. POSSIBLE where all groups have forces; IMPOSSIBLE where one has a motion; else UNDECIDED
   !>
   !> By duality of linear programmes one of the two answers exists always. Near the limit both may drown in round-off: then none
   !> is given.
   subroutine prove_balance(rows, line, certificate, counts)
      type(motion_rows_t), intent(in) :: rows         !< G, and the work of the loads on each motion
      type(contact_line_t), intent(in) :: line        !< points, weights, laws and averages are read
      type(certificate_t), intent(out) :: certificate !< the verdict, with the forces or the motion that prove it
      logical, intent(in), optional :: counts(:)      !< (line%n) points that may bear forces; left out: all
      type(certificate_t) :: own
      type(balance_groups_t) :: groups
      real(wp) :: worst, part
      integer(ip) :: g

      call find_groups(rows, line, groups)
      if (present(counts)) groups%of_point = merge(groups%of_point, 0_ip, counts)
      allocate (certificate%motion(rows%n_columns), certificate%q(rows%n), source=0.0_wp)
      certificate%verdict = BALANCE_POSSIBLE
      worst = 0.0_wp
      do g = 1, groups%n
         ! a group whose loads are the round-off of what cancelled in them rests, without any force
         if (all(abs(rows%work) <= NO_LOAD*rows%work_size .or. groups%of_motion /= g)) cycle
         call judge_group(rows, line, groups%of_motion == g, groups%of_point == g, own)
         certificate%solver_missing = certificate%solver_missing .or. own%solver_missing
         if (allocated(own%q)) certificate%q = certificate%q + own%q
         select case (own%verdict)
         case (BALANCE_IMPOSSIBLE)
            part = own%excess/dot_product(abs(own%motion), rows%work_size)
            if (part > worst) then
               worst = part
               certificate%motion = own%motion
               certificate%excess = own%excess
            end if
            certificate%verdict = BALANCE_IMPOSSIBLE
         case (BALANCE_UNDECIDED)
            if (certificate%verdict == BALANCE_POSSIBLE) certificate%verdict = BALANCE_UNDECIDED
         end select
      end do
   end subroutine prove_balance

   !> Sizes of forces differ from body to body by any factor. The first pass measures all by the largest load of the group, the next
   !> ones each motion by the forces that the pass before found on it.
   !>
   !>     pass 1     S_i = the largest load of the group, for all motions
   !>     pass 2     S_i = sum of the sizes of loads and contact forces on motion i, with the forces of pass 1
   !>     pass 3     the same with the forces of pass 2
   !>
   !> The programme makes sum |remainder_i|/S_i least and knows its tolerance beside 1. With one S for all, a light body among
   !> heavy ones has remainders that are nothing to it. So passes go on while neither forces nor motion are good enough for the
   !> checks. Behind a proof a simpler motion is asked for, which is easier to tell (least_largest).
   subroutine judge_group(rows, line, member, touched, certificate)
      type(motion_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      logical, intent(in) :: member(:)           !< (k)
      logical, intent(in) :: touched(:)          !< (line%n)
      type(certificate_t), intent(out) :: certificate
      real(wp) :: scale(rows%n_columns), body_force(rows%n_columns)
      logical :: solved
      integer(ip) :: pass

      scale = 0.0_wp
      where (member) scale = maxval(rows%work_size, mask=member)
      do pass = 1, MOST_PASSES
         call try_scale()
         if (certificate%verdict /= BALANCE_UNDECIDED .or. .not. solved) exit
         call measure_forces(rows, certificate%q, member, body_force, scale)
      end do
      if (certificate%verdict /= BALANCE_IMPOSSIBLE) return
      call measure_forces(rows, certificate%q, member, body_force, scale)
      call simplify_motion()
      certificate%excess = certificate%excess/maxval(abs(certificate%motion))
      certificate%motion = certificate%motion/maxval(abs(certificate%motion))

   contains

      !> One linear programme, and what its two answers are worth.
      subroutine try_scale()
         real(wp) :: v(rows%n_columns), q(rows%n), body_force(rows%n_columns)
         integer :: outcome

         call solve_balance(rows, line, member, touched, scale, .false., q, v, outcome)
         certificate%solver_missing = outcome == LP_NOT_AVAILABLE
         solved = outcome == LP_OPTIMAL
         if (.not. solved) return
         certificate%q = q
         if (forces_balance(rows, line, q, member)) then
            certificate%verdict = BALANCE_POSSIBLE
            return
         end if
         call measure_forces(rows, q, member, body_force)
         call accept_motion(rows, line, body_force, scale, v, certificate)
      end subroutine try_scale

      !> A simpler motion of the same bodies, and of those that it needs, where one proves it as well.
      subroutine simplify_motion()
         real(wp) :: v(rows%n_columns), q(rows%n), body_force(rows%n_columns)
         integer :: outcome

         call solve_balance(rows, line, abs(certificate%motion) > 0.0_wp, touched, scale, .true., q, v, outcome)
         if (outcome /= LP_OPTIMAL) return
         call measure_forces(rows, certificate%q, scale > 0.0_wp, body_force)
         call accept_motion(rows, line, body_force, scale, v, certificate)
      end subroutine simplify_motion

   end subroutine judge_group

   !> Takes a motion that proves it, without its smallest parts where it does so without them.
   subroutine accept_motion(rows, line, body_force, scale, v, certificate)
      type(motion_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: body_force(:), scale(:)
      real(wp), intent(in) :: v(:)
      type(certificate_t), intent(inout) :: certificate
      real(wp) :: clean(rows%n_columns), excess
      logical :: proven

      clean = v
      where (abs(v)*scale <= NO_MOTION*maxval(abs(v)*scale)) clean = 0.0_wp
      call motion_excess(rows, line, body_force, clean, excess, proven)
      if (.not. proven) then
         clean = v
         call motion_excess(rows, line, body_force, clean, excess, proven)
      end if
      if (.not. proven .and. excess > 0.0_wp) then
         call polish_motion(rows, line, scale, clean)
         call motion_excess(rows, line, body_force, clean, excess, proven)
      end if
      if (.not. proven) return
      certificate%verdict = BALANCE_IMPOSSIBLE
      certificate%motion = clean
      certificate%excess = excess
   end subroutine accept_motion

   !> How far loads can go from those of `rows` towards others: the largest share s of the way with G'q = h + s (h' - h) for some
   !> forces that the contact can take. One linear programme, that of the balance with s as one more column and without remainders.
   !>
   !>     maximise s     with   G' q - s (h' - h) = h,   0 <= s <= 1,   q such that the contact can take it
   !>
   !> If shares s1 < s2 can be balanced, by q1 and q2, all between can, by the forces between, as the conditions on q are linear.
   !> So the largest share is where the balance ends on the way from h to h', and one programme tells what otherwise takes a
   !> search.
   subroutine find_largest_share(rows, line, other, share, found)
      type(motion_rows_t), intent(in) :: rows    !< G and h
      type(contact_line_t), intent(in) :: line   !< points, weights, laws and averages are read
      type(motion_rows_t), intent(in) :: other   !< h'
      real(wp), intent(out) :: share             !< 0 to 1
      logical, intent(out) :: found              !< the programme has been solved
      type(balance_program_t) :: balance
      type(linear_solution_t) :: solution
      real(wp) :: scale(rows%n_columns)
      integer(ip) :: i

      share = 0.0_wp
      scale = max(maxval(rows%work_size), maxval(other%work_size))
      call build_balance_program(rows, line, [(.true., i=1, line%n)], [(i, i=1, rows%n_columns)], scale, .false., balance)
      associate (program => balance%program)
         program%upper(balance%n_forces + 1:) = 0.0_wp
         program%row = [program%row, (i, i=1, rows%n_columns)]
         program%entry = [program%entry, (rows%work - other%work)/scale]
         program%first = [program%first, size(program%entry, kind=ip) + 1]
         program%lower = [program%lower, 0.0_wp]
         program%upper = [program%upper, 1.0_wp]
         program%objective = [spread(0.0_wp, 1, program%n_columns), -1.0_wp]
         program%n_columns = program%n_columns + 1
      end associate
      call solve_linear_program(balance%program, merge(LP_BY_BARRIER, LP_BY_SIMPLEX, rows%n_columns > MANY_MOTIONS), solution)
      found = solution%status == LP_OPTIMAL
      if (found) share = solution%x(balance%program%n_columns)
   end subroutine find_largest_share

   !> The linear programme of the balance of some bodies: forces, and the motion of its duals. Measured on walls of 100 to 1,000
   !> blocks: simplex steps are slow for the sum (most for loads far beyond the limit), interior points for the largest.
   subroutine solve_balance(rows, line, member, touched, scale, least_largest, q, v, outcome)
      type(motion_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      logical, intent(in) :: member(:)           !< (k) motions of the bodies
      logical, intent(in) :: touched(:)          !< (line%n) points that they touch at
      real(wp), intent(in) :: scale(:)
      logical, intent(in) :: least_largest
      real(wp), intent(out) :: q(:), v(:)
      integer, intent(out) :: outcome            !< LP_*
      type(balance_program_t) :: balance
      type(linear_solution_t) :: solution
      integer(ip) :: row_of_motion(rows%n_columns), i, n

      row_of_motion = 0
      n = 0
      do i = 1, rows%n_columns
         if (.not. member(i)) cycle
         n = n + 1
         row_of_motion(i) = n
      end do
      call build_balance_program(rows, line, touched, row_of_motion, scale, least_largest, balance)
      call solve_linear_program(balance%program, merge(LP_BY_BARRIER, LP_BY_SIMPLEX, n > MANY_MOTIONS .and. .not. least_largest), &
                                solution)
      if (solution%status /= LP_OPTIMAL .and. n > MANY_MOTIONS) call solve_linear_program(balance%program, LP_BY_SIMPLEX, solution)
      outcome = solution%status
      q = 0.0_wp
      v = 0.0_wp
      if (outcome /= LP_OPTIMAL) return
      call forces_of_columns(balance, solution%x, q)
      v(balance%motion) = solution%dual(:balance%n_motions)/balance%size   ! of any length that suits
   end subroutine solve_balance

   !> The sizes of the forces on each motion of a group, and on its body [F].
   pure subroutine measure_forces(rows, q, member, body_force, scale)
      type(motion_rows_t), intent(in) :: rows
      real(wp), intent(in) :: q(:)
      logical, intent(in) :: member(:)
      real(wp), intent(out) :: body_force(:)
      real(wp), intent(inout), optional :: scale(:) !< of bodies without a force but round-off: the least load of the group
      real(wp) :: sizes(rows%n_columns), least, largest
      integer(ip) :: first, last

      sizes = rows%work_size + transposed_sizes(rows, q)
      least = 0.0_wp
      if (any(member .and. rows%work_size > 0.0_wp)) least = minval(rows%work_size, mask=member .and. rows%work_size > 0.0_wp)
      largest = maxval(sizes, mask=member)
      first = 1
      do while (first <= rows%n_columns)
         last = first
         do while (last < rows%n_columns)
            if (rows%body(last + 1) /= rows%body(first)) exit
            last = last + 1
         end do
         body_force(first:last) = maxval(sizes(first:last))
         if (all(rows%work_size(first:last) <= 0.0_wp) .and. body_force(first) <= OF_BODY*largest) body_force(first:last) = least
         first = last + 1
      end do
      if (.not. present(scale)) return
      where (member) scale = merge(body_force, sizes, sizes <= OF_BODY*body_force)
   end subroutine measure_forces

   !> How much more the loads work on a motion than any admissible forces can take. proven: by far more than round-off, and than all
   !> forces could take that are MANY_TIMES as large as those on the bodies, at the points where round-off lets v resist them.
   !>
   !>     excess   = h'v - (what known pressures take by friction)
   !>     resisted = N_k v + (1/w_k) sum_j w_j nu_j W_jk |T_j v|  at each point, above zero by round-off alone if v is a proof
   !>     taken    = sum of resisted times the size of the forces on the bodies there, the lesser of two
   !>     handed_on = the same with the larger of the two: a light body hands on the weight of a heavy one to what carries it
   !>
   !> proven where excess > CLEAR of the work of all loads, > MANY_TIMES taken, and > SOME_TIMES handed_on. A bilateral row may pull
   !> and push, so |N_k v| counts. What a row sees of a motion is known to the digits of the deck (rows%doubt): a resistance within
   !> them is one of no MANY_TIMES, but counts in handed_on. What round-off of the rates takes is no proof either.
   subroutine motion_excess(rows, line, body_force, v, excess, proven)
      type(motion_rows_t), intent(in) :: rows    !< G, and the work of the loads on each motion
      type(contact_line_t), intent(in) :: line   !< points, weights, laws and averages are read
      real(wp), intent(in) :: body_force(:)      !< (k) size of the forces on the body of each motion [F]
      real(wp), intent(in) :: v(:)               !< (k) [L]
      real(wp), intent(out) :: excess            !< [F L]
      logical, intent(out) :: proven             !< no forces can balance the loads
      real(wp) :: rate(rows%n), terms(rows%n), by_friction(line%n), known_work, work_size, taken, handed_on, resisted, rounding
      real(wp) :: unsure(rows%n), rubbed(line%n)    ! by digits: rates, and of friction
      integer(ip) :: i, j

      call multiply_rows(rows, v, rate, terms)
      call friction_work(line, rate, by_friction, known_work)
      excess = dot_product(rows%work, v) - known_work
      work_size = dot_product(rows%work_size, abs(v)) + known_work
      ! What the digits of the deck may make each row see of a motion.
      unsure = 0.0_wp
      if (allocated(rows%doubt)) then
         do j = 1, rows%n
            unsure(j) = rows%doubt(j)*sum(abs(v(rows%column(rows%first(j):rows%first(j + 1) - 1))))
         end do
      end if
      call friction_work(line, unsure, rubbed)
      taken = 0.0_wp
      handed_on = 0.0_wp
      rounding = 0.0_wp
      do i = 1, rows%n
         if (line%normal(line%point(i)) /= i) cycle
         resisted = rate(i) + by_friction(line%point(i))
         if (line%point(i) > line%n - line%n_bilateral) resisted = abs(rate(i))
         if (resisted <= ROUND_OFF*(terms(i) + by_friction(line%point(i)))) then
            if (terms(i) > 0.0_wp) rounding = rounding + EPS_MACH*terms(i) &
                                              *maxval(body_force(rows%column(rows%first(i):rows%first(i + 1) - 1)))
            cycle
         end if
         if (rows%first(i + 1) > rows%first(i)) then
            associate (forces => body_force(rows%column(rows%first(i):rows%first(i + 1) - 1)))
               if (resisted > unsure(i) + rubbed(line%point(i))) taken = taken + resisted*minval(forces)
               handed_on = handed_on + resisted*maxval(forces)
            end associate
         else
            taken = taken + resisted*maxval(body_force)      ! its pressure only raises the friction of others
         end if
      end do
      proven = excess > CLEAR*work_size .and. excess > MANY_TIMES*taken .and. excess > SOME_TIMES*handed_on + rounding
   end subroutine motion_excess

   !> What a unit of each pressure force takes by friction, at its own point and where it is averaged; and what known ones take.
   pure subroutine friction_work(line, rate, by_friction, known_work)
      type(contact_line_t), intent(in) :: line   !< points, weights, laws and averages are read
      real(wp), intent(in) :: rate(:)            !< (m) G v [L]
      real(wp), intent(out) :: by_friction(:)    !< (n) [L]
      real(wp), intent(out), optional :: known_work !< [F L]
      real(wp) :: p(line%n), nothing(size(rate)), known
      integer(ip) :: j, e

      nothing = 0.0_wp
      p = pressure_of(line, nothing)
      by_friction = 0.0_wp
      known = 0.0_wp
      do j = 1, line%n
         if (line%tangential(j) == 0) cycle
         do e = line%average%first(j), line%average%first(j + 1) - 1
            associate (k => line%average%column(e), &
                       rubbed => line%weight(j)*line%law(j)%nu*line%average%value(e)*abs(rate(line%tangential(j))))
               by_friction(k) = by_friction(k) + rubbed/line%weight(k)
               known = known + rubbed*p(k)
            end associate
         end do
      end do
      if (present(known_work)) known_work = known
   end subroutine friction_work

   !> Whether forces are admissible and leave nothing on the motions of some bodies, but for round-off of what is added up.
   !>
   !>     p >= 0,     |q_t| <= w tau(p),     |(h - G'q)_i| <= IN_BALANCE (sizes on motion i) + OF_BODY (largest on its body)
   !>
   !> with the averages and laws of the line itself. Whatever the solver of linear programmes said, only forces that pass count.
   function forces_balance(rows, line, q, member) result(balanced)
      type(motion_rows_t), intent(in) :: rows    !< G, and the work of the loads on each motion
      type(contact_line_t), intent(in) :: line   !< points, weights, laws and averages are read
      real(wp), intent(in) :: q(:)               !< (m) [F]
      logical, intent(in) :: member(:)           !< (k)
      logical :: balanced
      real(wp) :: p(line%n), tau(line%n), remainder(rows%n_columns), sizes(rows%n_columns), body_force(rows%n_columns)
      integer(ip) :: j

      p = pressure_of(line, q)
      balanced = all(p(:line%n - line%n_bilateral) >= 0.0_wp)
      tau = friction_bound(line, p)
      do j = 1, line%n
         if (line%tangential(j) == 0) cycle
         balanced = balanced .and. abs(q(line%tangential(j))) <= tau(j)*line%weight(j)*(1.0_wp + IN_BALANCE)
      end do
      remainder = 0.0_wp
      call add_transposed(rows, 1.0_wp, q, remainder)
      remainder = abs(rows%work - remainder)
      sizes = rows%work_size + transposed_sizes(rows, q)
      call measure_forces(rows, q, member, body_force)
      balanced = balanced .and. all(remainder <= IN_BALANCE*sizes + OF_BODY*body_force .or. .not. member)
   end function forces_balance

   !> Groups in the order of their first motions.
   !>
   !> Motions and points are the members of sets that are joined: the motions of a body; each point with the motions that its rows
   !> see; points one of whose pressure is in the friction bound of the other. What is joined in the end is a group. A body that
   !> supports hold has no motion, so it joins nothing: a wall on its foundation is one group, two walls on one foundation are two.
   pure subroutine find_groups(rows, line, groups)
      type(motion_rows_t), intent(in) :: rows       !< G, and the body of each motion
      type(contact_line_t), intent(in) :: line      !< laws and averages of its points are read
      type(balance_groups_t), intent(out) :: groups !< (k) and (line%n), numbered from 1
      integer(ip) :: parent(rows%n_columns + line%n), number(rows%n_columns + line%n), i, j, e

      parent = [(i, i=1, rows%n_columns + line%n)]
      do i = 2, rows%n_columns
         if (rows%body(i) == rows%body(i - 1)) call join_sets(parent, i, i - 1)
      end do
      do i = 1, rows%n
         do e = rows%first(i), rows%first(i + 1) - 1
            call join_sets(parent, rows%n_columns + line%point(i), rows%column(e))
         end do
      end do
      do j = 1, line%n
         if (line%tangential(j) == 0 .or. line%law(j)%nu <= 0) cycle
         do e = line%average%first(j), line%average%first(j + 1) - 1
            if (line%average%value(e) > 0) call join_sets(parent, rows%n_columns + line%average%column(e), rows%n_columns + j)
         end do
      end do
      allocate (groups%of_motion(rows%n_columns), groups%of_point(line%n))
      number = 0
      do i = 1, rows%n_columns + line%n
         e = i
         call find_lowest(parent, e)
         if (i <= rows%n_columns .and. number(e) == 0) then
            groups%n = groups%n + 1
            number(e) = groups%n
         end if
         if (i <= rows%n_columns) groups%of_motion(i) = number(e)
         if (i > rows%n_columns) groups%of_point(i - rows%n_columns) = number(e)
      end do
   end subroutine find_groups

end module atrito_certificate
