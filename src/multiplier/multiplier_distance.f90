!> How far a step of the multipliers is from a solution, pair by pair and body by body.
!>
!> In a solution q = q_o, a = a_o and tau = nu S_rho(p). So four numbers tell how far a step is from one:
!>
!>     forces   the largest |q - q_o| of each pair, less the round-off of its rows, over the largest |q| of the pair
!>     bound    the largest |nu S_rho(p) - tau| of each pair, less nu times the round-off of its pressures, over its largest bound
!>     pull     kappa H |a - a_o| of each motion over the largest load or contact force at a node of its body
!>     drive    the same over the largest of all those forces
!>
!> of all pairs and bodies the largest. Each pair is measured by its own forces and each body by the forces on it, so a weak pair
!> beside a strong one is found as exactly. What is round-off of the forces on the bodies that meet there (NO_FORCE), or of what a
!> pair bore in the increment before (NO_FORCE_AFTER), is no force to compare with: a contact pair without any other has none, and
!> what it changes by is none.
module atrito_multiplier_distance
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_bound_qp, only: box_state_t, AT_LOWER, FREE
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_system, only: contact_system_t
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_multiplier_step, only: largest_of_pairs, pull_of
   use atrito_multipliers, only: multiplier_t
   use atrito_sparse_rows, only: add_transposed, transposed_sizes
   implicit none (type, external)
   private
   public :: distance_t, measure_distance, measure_bodies, clear_round_off, NO_FORCE_AFTER

   !> Relative to the forces of the pair or body.
   type :: distance_t
      real(wp) :: forces = 0.0_wp                !< |q - q_o|
      real(wp) :: bound = 0.0_wp                 !< |nu S_rho(p) - tau|
      real(wp) :: pull = 0.0_wp                  !< kappa |a - a_o|
      real(wp) :: pull_beside = 0.0_wp           !< the same over no less than a part IDLE of the forces on bodies that it touches
      real(wp) :: drive = 0.0_wp                 !< the same over the largest force of the scene
   end type distance_t

   real(wp), parameter :: NO_FORCE = 1.0e-12_wp  !< of the forces on the bodies that meet: none
   !> Of the forces on the bodies that it touches, what a body has that is pulled by no less than their round-off.
   real(wp), parameter :: IDLE = 1.0e-6_wp
   real(wp), parameter :: BALANCED = 1.0e-9_wp   !< of the forces on a body that move it: nothing is missing
   real(wp), parameter :: NO_FORCE_AFTER = 1.0e-14_wp !< of the force in the increment before
   !> The same of a bilateral row: it may be where nothing moves, and nothing tells its noise.
   real(wp), parameter :: LITTLE = 1.0e-5_wp

contains

   !> How far a step is from the solution, where q = q_o, a = a_o, and the friction bound is that of the pressures.
   !>
   !> Bodies without load that went clear of each other have nothing that a pull could be compared with: theirs is none.
   function measure_distance(system, line, multipliers, q, tau, image) result(distance)
      class(contact_system_t), intent(in) :: system !< A, B, loads, flexibilities
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      type(multiplier_t), intent(in) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      real(wp), intent(in) :: q(:)               !< (m) [F]
      real(wp), intent(in) :: tau(:), image(:)   !< (points) [F/L^2]
      type(distance_t) :: distance
      real(wp) :: of_body(system%n_bodies), least(multipliers%n_pairs), largest(multipliers%n_pairs)
      real(wp) :: change(multipliers%n_pairs)
      integer(ip) :: n

      call measure_bodies(system, q, of_body)
      call measure_pairs(system, multipliers, of_body, least)
      largest = largest_of_pairs(multipliers, abs(q))
      change = largest_of_pairs(multipliers, abs(q - multipliers%q_old) - multipliers%noise)
      n = min(multipliers%n_contact_pairs, multipliers%n_pairs)
      where (max(largest(:n), change(:n)) <= least(:n)) change(:n) = 0.0_wp
      distance%forces = greatest_ratio(change, max(least, largest))
      distance%bound = bound_distance()
      ! bodies without load that went clear of each other have nothing that a pull could be compared with
      if (all(system%load == 0.0_wp) .and. all(abs(q) <= multipliers%noise)) return
      distance%pull = pull_distance(of_body)
      distance%drive = pull_distance(spread(maxval(of_body), 1, size(of_body)))
      call raise_to_neighbours(system, IDLE, of_body)
      distance%pull_beside = pull_distance(of_body)

   contains

      !> |nu S_rho(p) - tau| pair by pair, over the largest bound of the pair, or that of the least pressure that counts there. A
      !> bound that is no number is as far off as can be.
      real(wp) function bound_distance() result(distance)
         real(wp) :: bound(size(least)), off(size(least)), noise(size(least)), of_force
         integer(ip) :: j, k

         bound = 0.0_wp
         off = 0.0_wp
         noise = 0.0_wp
         do j = 1, line%n
            k = 1
            if (allocated(line%pair)) k = line%pair(j)
            of_force = line%law(j)%nu/line%weight(j)
            if (line%normal(j) > 0) noise(k) = max(noise(k), of_force*multipliers%noise(line%normal(j)))
            bound(k) = max(bound(k), tau(j), image(j), of_force*least(k))
            off(k) = max(off(k), abs(tau(j) - image(j)))
         end do
         distance = greatest_ratio(off - noise, bound)
         if (.not. all(ieee_is_finite(image))) distance = HUGE_REAL
      end function bound_distance

      !> The largest pull on a motion, over the forces on its body.
      !>
      !> pull_of is kappa H_j; times the way |a - a_o| of the step it is the force that held the motion.
      pure real(wp) function pull_distance(of_body) result(distance)
         real(wp), intent(in) :: of_body(:)

         associate (first => system%n - system%k + 1)
            distance = greatest_ratio(pull_of(multipliers)*abs(multipliers%x(first:) - multipliers%a_old), &
                                      of_body(system%body(first:)))
         end associate
      end function pull_distance

   end function measure_distance

   !> A pressure that is round-off is none: the point is open. It is where it is no more than the noise of its row, or where all
   !> forces of its pair are round-off of those on their bodies.
   !>
   !> Rows of contact alone: a bilateral row may have a force of any size and sign.
   subroutine clear_round_off(system, line, multipliers, state)
      class(contact_system_t), intent(in) :: system !< A, B, loads, flexibilities
      type(contact_line_t), intent(in) :: line !< which rows are normal, and which of one point
      type(multiplier_t), intent(in) :: multipliers !< x, e, q_o, a_o and the sizes of the step
      type(box_state_t), intent(inout) :: state !< states of the m unknowns, q, a, r
      real(wp) :: of_body(system%n_bodies), least(multipliers%n_pairs), largest(multipliers%n_pairs)
      logical :: none(size(state%q))
      integer(ip) :: normal(size(state%q)), i

      call measure_bodies(system, state%q, of_body)
      call measure_pairs(system, multipliers, of_body, least)
      largest = largest_of_pairs(multipliers, abs(state%q))
      none = (state%q <= multipliers%noise .or. largest(multipliers%pair) <= least(multipliers%pair)) .and. &
             state%state == FREE .and. multipliers%pair <= multipliers%n_contact_pairs
      none(count(line%normal > 0) + 1:) = .false.
      normal = [(merge(line%normal(line%point(i)), i, line%normal(line%point(i)) > 0), i=1, size(none, kind=ip))]
      call keep_what_balances(system, normal, multipliers%noise, state%q, none)
      where (none)
         state%q = 0.0_wp
         state%state = AT_LOWER
         state%r = min(state%r, 0.0_wp)
      end where
   end subroutine clear_round_off

   !> A force without which the loads on a body are out of balance is one, however small: they may be as small.
   !> But for the noise of the forces that are left on it: where these are no more than that nothing is balanced.
   subroutine keep_what_balances(system, normal, noise, q, none)
      class(contact_system_t), intent(in) :: system
      integer(ip), intent(in) :: normal(:)       !< (m) row of the pressure with which a force goes
      real(wp), intent(in) :: noise(:), q(:)     !< (m) [F]
      logical, intent(inout) :: none(:)          !< (m)
      real(wp) :: before(system%n), after(system%n), sizes(system%n), of_body(system%n_bodies)
      integer(ip) :: i

      if (.not. any(none)) return
      sizes = transposed_sizes(system%rows, q)
      of_body = 0.0_wp
      do i = system%n - system%k + 1, system%n
         of_body(system%body(i)) = max(of_body(system%body(i)), sizes(i))
      end do
      before = system%load
      call add_transposed(system%rows, -1.0_wp, q, before)
      do
         after = system%load
         call add_transposed(system%rows, -1.0_wp, merge(0.0_wp, q, none(normal)), after)
         sizes = transposed_sizes(system%rows, merge(0.0_wp, noise, none(normal) .or. abs(q) <= 0.0_wp))
         associate (is_off => abs(after) > abs(before) + BALANCED*of_body(system%body) + sizes, moves => system%n - system%k)
            if (.not. any(is_off(moves + 1:))) return
            do i = 1, system%rows%n
               associate (columns => system%rows%column(system%rows%first(i):system%rows%first(i + 1) - 1))
                  if (any(is_off(columns) .and. columns > moves)) none(normal(i)) = .false.
               end associate
            end do
         end associate
      end do
   end subroutine keep_what_balances

   !> The largest load and contact force at a displacement of each body; at least a round-off of those on bodies that it touches.
   !>
   !> A body that has no load and touches loaded ones has contact forces that balance each other; if these are round-off as well,
   !> what is round-off of its neighbours' forces is none on it.
   subroutine measure_bodies(system, q, of_body)
      class(contact_system_t), intent(in) :: system !< A, B, loads, flexibilities
      real(wp), intent(in) :: q(:)
      real(wp), intent(out) :: of_body(:)        !< (bodies) [F]
      real(wp) :: force(system%n)
      integer(ip) :: i

      force = 0.0_wp
      call add_transposed(system%rows, 1.0_wp, q, force)
      of_body = 0.0_wp
      do i = 1, system%n - system%k
         of_body(system%body(i)) = max(of_body(system%body(i)), abs(force(i)), abs(system%load(i)))
      end do
      if (any(of_body <= 0.0_wp)) call measure_rigid_bodies(system, q, of_body)
      call raise_to_neighbours(system, NO_FORCE, of_body)
   end subroutine measure_bodies

   !> At least a part of the forces on the bodies that each touches.
   subroutine raise_to_neighbours(system, part, of_body)
      class(contact_system_t), intent(in) :: system
      real(wp), intent(in) :: part
      real(wp), intent(inout) :: of_body(:)      !< (bodies) [F]
      real(wp) :: own(size(of_body))
      integer(ip) :: i, k

      own = of_body
      do i = 1, system%rows%n
         associate (bodies => system%body(system%rows%column(system%rows%first(i):system%rows%first(i + 1) - 1)))
            do k = 1, size(bodies, kind=ip)
               of_body(bodies(k)) = max(of_body(bodies(k)), part*maxval(own(bodies)))
            end do
         end associate
      end do
   end subroutine raise_to_neighbours

   !> The same of bodies without displacements: the largest load on a motion, and contact force along one.
   !>
   !> A rigid body has no forces at displacements: what acts on it is the work on its motions, of loads and of each contact force.
   pure subroutine measure_rigid_bodies(system, q, own)
      class(contact_system_t), intent(in) :: system
      real(wp), intent(in) :: q(:)
      real(wp), intent(inout) :: own(:)          !< (bodies) [F]: those that are 0 are set
      logical :: is_rigid(size(own))
      integer(ip) :: i, k

      is_rigid = own <= 0.0_wp
      do i = system%n - system%k + 1, system%n
         if (is_rigid(system%body(i))) own(system%body(i)) = max(own(system%body(i)), abs(system%load(i)))
      end do
      do i = 1, system%rows%n
         do k = system%rows%first(i), system%rows%first(i + 1) - 1
            associate (column => system%rows%column(k))
               if (column <= system%n - system%k .or. .not. is_rigid(system%body(column))) cycle
               own(system%body(column)) = max(own(system%body(column)), abs(system%rows%value(k)*q(i)))
            end associate
         end do
      end do
   end subroutine measure_rigid_bodies

   !> The force at each pair that is round-off of those on its bodies, or of what it bore in the increment before: of a pair that is
   !> unloaded nothing else may be left to compare with.
   !>
   !> Bilateral rows have LITTLE in place of NO_FORCE: a tie between two parts that hardly strain bears next to nothing, and that is
   !> not worth steps.
   subroutine measure_pairs(system, multipliers, of_body, least)
      class(contact_system_t), intent(in) :: system
      type(multiplier_t), intent(in) :: multipliers
      real(wp), intent(in) :: of_body(:)
      real(wp), intent(out) :: least(:)          !< (pairs) [F]
      integer(ip) :: i

      least = 0.0_wp
      if (allocated(multipliers%before)) least = NO_FORCE_AFTER*multipliers%before
      do i = 1, system%rows%n
         associate (bodies => system%body(system%rows%column(system%rows%first(i):system%rows%first(i + 1) - 1)), &
                    pair => multipliers%pair(i))
            least(pair) = max(least(pair), merge(LITTLE, NO_FORCE, pair > multipliers%n_contact_pairs)*maxval(of_body(bodies)))
         end associate
      end do
   end subroutine measure_pairs

   !> The largest part(i)/whole(i); where the whole is nothing there is nothing to be off by.
   pure real(wp) function greatest_ratio(part, whole) result(ratio)
      real(wp), intent(in) :: part(:), whole(:)
      integer(ip) :: i

      ratio = 0.0_wp
      do i = 1, size(part, kind=ip)
         if (whole(i) > 0.0_wp) ratio = max(ratio, part(i)/whole(i))
      end do
   end function greatest_ratio

end module atrito_multiplier_distance
