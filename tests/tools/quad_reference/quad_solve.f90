!> Solves the contact problem in quadruple precision: slow, by several ways, and with a check of its own.
!>
!> A state says for each point whether it is open or closed, and whether it sticks or slips. Newton's method with changing states
!> ends in a solution to full precision when it starts near one. Where to start: from problems with a frozen friction bound, which
!> are convex (block principal pivoting with Murty's finite rule behind it, weak springs holding free bodies), in a damped Picard
!> loop; from smaller coefficients of friction; at random; and by trying all states where there are few points.
module quad_solve
   use, intrinsic :: iso_fortran_env, only: real128
   use quad_contact, only: contact_t, place_of, bound_of
   implicit none (type, external)
   private
   public :: state_t, solve_contact, refine, law_error, new_state

   integer, parameter :: qp = real128
   integer, parameter :: OPEN = 0, CLOSED = 1                     !< normal
   integer, parameter :: STICK = 0, SLIP_UP = 1, SLIP_DOWN = -1, NONE = 2  !< tangential; NONE: no bound
   real(qp), parameter :: TINY_PART = 1.0e-27_qp                  !< round-off of signs
   real(qp), parameter :: CONVERGED = 1.0e-25_qp
   integer, parameter :: MOST_POINTS_TO_TRY_ALL = 4

   type :: state_t
      integer, allocatable :: normal(:), tangential(:)
      real(qp), allocatable :: q(:), a(:)
   end type state_t

contains

   pure subroutine new_state(contact, state)
      type(contact_t), intent(in) :: contact
      type(state_t), intent(out) :: state

      allocate (state%normal(contact%n), source=CLOSED)
      allocate (state%tangential(contact%n), source=NONE)
      allocate (state%q(2*contact%n), state%a(contact%k))
      state%q = 0
      state%a = 0
   end subroutine new_state

   !> Tries one way after the other. how: which one came to a solution; '' when none did.
   subroutine solve_contact(contact, state, how)
      type(contact_t), intent(in) :: contact
      type(state_t), intent(out) :: state
      character(len=:), allocatable, intent(out) :: how
      real(qp), parameter :: RELAXATION(4) = [1.0_qp, 0.5_qp, 0.2_qp, 0.05_qp]
      integer :: i
      logical :: found

      call new_state(contact, state)
      how = ''
      if (contact%n == 0) then
         how = 'no points'
         return
      end if
      do i = 1, size(RELAXATION)
         call iterate_picard(contact, RELAXATION(i), state, found)
         how = 'Picard and Newton'
         if (found) return
      end do
      call raise_friction(contact, state, found)
      how = 'rising friction'
      if (found) return
      call start_at_random(contact, state, found)
      how = 'random starts'
      if (found) return
      if (contact%n <= MOST_POINTS_TO_TRY_ALL) call try_all(contact, state, found)
      how = 'all states'
      if (.not. found) how = ''
   end subroutine solve_contact

   subroutine iterate_picard(contact, relaxation, state, found)
      type(contact_t), intent(in) :: contact
      real(qp), intent(in) :: relaxation
      type(state_t), intent(inout) :: state
      logical, intent(out) :: found
      integer, parameter :: MOST = 60
      type(state_t) :: trial
      real(qp) :: tau(contact%n)
      integer :: i

      call new_state(contact, state)
      tau = 0
      do i = 1, MOST
         call solve_frozen(contact, tau, state)
         trial = state
         if (i > 1) call refine(contact, contact%nu, trial, found)
         if (i > 1 .and. found) then
            state = trial
            return
         end if
         tau = tau + merge(1.0_qp, relaxation, i == 1)*(bound_of(contact, state%q, contact%nu) - tau)
      end do
      found = .false.
   end subroutine iterate_picard

   !> From a twentieth of the least coefficient for which it works up to the whole, in rising steps.
   subroutine raise_friction(contact, state, found)
      type(contact_t), intent(in) :: contact
      type(state_t), intent(inout) :: state
      logical, intent(out) :: found
      type(state_t) :: trial
      real(qp) :: nu, step
      integer :: i

      call new_state(contact, state)
      call solve_frozen(contact, 0*contact%weight, state)
      nu = 0
      step = min(0.05_qp, contact%nu)
      do i = 1, 400
         trial = state
         call refine(contact, min(nu + step, contact%nu), trial, found)
         if (found) then
            nu = min(nu + step, contact%nu)
            state = trial
            step = step*1.5_qp
            if (nu >= contact%nu) return
         else
            step = step/2
         end if
      end do
      found = .false.
   end subroutine raise_friction

   subroutine start_at_random(contact, state, found)
      type(contact_t), intent(in) :: contact
      type(state_t), intent(inout) :: state
      logical, intent(out) :: found
      integer, parameter :: MOST = 400
      integer :: i, j, number

      number = 12345
      do i = 1, MOST
         call new_state(contact, state)
         call solve_frozen(contact, 0*contact%weight, state)
         do j = 1, contact%n
            number = modulo(number*4096 + 150889, 714025)
            state%tangential(j) = modulo(number, 3) - 1
            number = modulo(number*4096 + 150889, 714025)
            if (modulo(number, 4) == 0) state%normal(j) = 1 - state%normal(j)
         end do
         call refine(contact, contact%nu, state, found)
         if (found) return
      end do
   end subroutine start_at_random

   subroutine try_all(contact, state, found)
      type(contact_t), intent(in) :: contact
      type(state_t), intent(inout) :: state
      logical, intent(out) :: found
      integer :: i, j, code, own

      found = .false.
      do i = 0, 6**contact%n - 1
         call new_state(contact, state)
         code = i
         do j = 1, contact%n
            own = modulo(code, 6)
            code = code/6
            state%normal(j) = modulo(own, 2)
            state%tangential(j) = own/2 - 1
         end do
         call refine(contact, contact%nu, state, found)
         if (found) return
      end do
   end subroutine try_all

   !> The problem with a frozen bound, free bodies on weak springs.
   subroutine solve_frozen(contact, tau, state)
      type(contact_t), intent(in) :: contact
      real(qp), intent(in) :: tau(:)
      type(state_t), intent(inout) :: state
      integer, parameter :: MOST = 3000, MOST_WITHOUT_PROGRESS = 10
      integer :: step, broken, fewest, left
      logical :: singular, single

      where (tau > 0 .and. state%tangential == NONE) state%tangential = STICK
      where (.not. tau > 0) state%tangential = NONE
      fewest = huge(fewest)
      left = MOST_WITHOUT_PROGRESS
      single = .false.
      do step = 1, MOST
         call take_step(contact, contact%nu, state, singular, tau)
         if (singular) return
         broken = 0
         call change_states(contact, tau, state, broken, .false., .true.)
         if (broken == 0) return
         if (broken < fewest) then
            fewest = broken
            left = MOST_WITHOUT_PROGRESS
            single = .false.
         else
            left = left - 1
            single = left < 0
         end if
         call change_states(contact, tau, state, broken, single, .false.)
      end do
   end subroutine solve_frozen

   !> Newton's method with the friction bound differentiated, states changing after each step.
   subroutine refine(contact, nu, state, found)
      type(contact_t), intent(in) :: contact
      real(qp), intent(in) :: nu
      type(state_t), intent(inout) :: state
      logical, intent(out) :: found
      integer, parameter :: MOST = 80
      real(qp) :: last(2*contact%n), largest
      integer :: step, broken
      logical :: singular

      found = .false.
      do step = 1, MOST
         last = state%q
         call take_step(contact, nu, state, singular)
         if (singular) return
         broken = 0
         call change_states(contact, bound_of(contact, state%q, nu), state, broken, .false., .false.)
         largest = maxval(abs(state%q))
         if (broken == 0 .and. maxval(abs(state%q - last)) <= CONVERGED*largest) then
            found = law_error(contact, nu, state) <= 1.0e-20_qp
            return
         end if
      end do
   end subroutine refine

   !> Solves the equations of the present state, linearised: with tau given they are linear and free bodies hang on springs.
   subroutine take_step(contact, nu, state, singular, tau)
      type(contact_t), intent(in) :: contact
      real(qp), intent(in) :: nu
      type(state_t), intent(inout) :: state
      logical, intent(out) :: singular
      real(qp), intent(in), optional :: tau(:)
      real(qp), parameter :: SPRING = 1.0e-14_qp
      real(qp) :: matrix(2*contact%n + contact%k, 2*contact%n + contact%k), rhs(2*contact%n + contact%k)
      real(qp) :: bound(contact%n), dtau(contact%n, contact%n), overlap
      integer :: n, j, i, m

      n = contact%n
      m = 2*n
      dtau = 0
      if (present(tau)) then
         bound = tau
      else
         bound = bound_of(contact, state%q, nu)
         do j = 1, n
            where (state%q(:n) > 0) dtau(j, :) = nu*contact%average(j, :)/contact%weight
         end do
         where (bound > 0 .and. state%tangential == NONE) state%tangential = STICK
         where (.not. bound > 0) state%tangential = NONE
      end if
      matrix = 0
      rhs = 0
      do j = 1, n
         if (contact%known(j)) then
            ! a force that the prescribed overlap makes
            matrix(j, j) = 1
            overlap = max(contact%g0(j), 0.0_qp)
            if (contact%delta > 0) rhs(j) = overlap/contact%delta*contact%weight(j)
         else if (state%normal(j) == OPEN) then
            matrix(j, j) = 1
         else
            matrix(j, :m) = contact%c(j, :)
            matrix(j, j) = matrix(j, j) + contact%delta/contact%weight(j)
            matrix(j, m + 1:) = -contact%g(j, :)
            rhs(j) = contact%g0(j)
         end if
         i = n + j
         if (contact%known(i)) then
            matrix(i, i) = 1
            matrix(i, :n) = matrix(i, :n) - known_part(contact, j)*contact%weight(j)*dtau(j, :)
            rhs(i) = known_part(contact, j)*contact%weight(j)*(bound(j) - dot_product(dtau(j, :), state%q(:n)))
         else if (state%tangential(j) == NONE) then
            matrix(i, i) = 1
         else if (state%tangential(j) == STICK) then
            matrix(i, :m) = contact%c(i, :)
            matrix(i, i) = matrix(i, i) + contact%eps/(contact%weight(j)*bound(j))
            associate (slope => -contact%eps*state%q(i)/(contact%weight(j)*bound(j)**2))
               matrix(i, :n) = matrix(i, :n) + slope*dtau(j, :)
               rhs(i) = contact%g0(i) + slope*dot_product(dtau(j, :), state%q(:n))
            end associate
            matrix(i, m + 1:) = -contact%g(i, :)
         else
            matrix(i, i) = 1
            matrix(i, :n) = -state%tangential(j)*contact%weight(j)*dtau(j, :)
            rhs(i) = state%tangential(j)*contact%weight(j)*(bound(j) - dot_product(dtau(j, :), state%q(:n)))
         end if
      end do
      matrix(m + 1:, :m) = transpose(contact%g)
      rhs(m + 1:) = contact%h
      if (present(tau)) then
         do j = 1, contact%k
            matrix(m + j, m + j) = SPRING/maxval([(contact%c(i, i), i=1, m)])
         end do
      end if
      call solve_general(matrix, rhs, singular)
      if (singular) return
      state%q = rhs(:m)
      state%a = rhs(m + 1:)
   end subroutine take_step

   !> phi' at a slip that is prescribed, with its sign.
   pure real(qp) function known_part(contact, j)
      type(contact_t), intent(in) :: contact
      integer, intent(in) :: j

      associate (slip => contact%g0(contact%n + j))
         known_part = 0
         if (abs(slip) > 0) known_part = sign(1.0_qp, slip)
         if (abs(slip) < contact%eps) known_part = slip/contact%eps
      end associate
   end function known_part

   !> Changes the states that break their condition, all or only the last one; counting: none, but how many.
   subroutine change_states(contact, tau, state, broken, only_last, counting)
      type(contact_t), intent(in) :: contact
      real(qp), intent(in) :: tau(:)
      type(state_t), intent(inout) :: state
      integer, intent(inout) :: broken
      logical, intent(in) :: only_last, counting
      real(qp) :: place(2*contact%n), force, slack
      integer :: normal(contact%n), tangential(contact%n), n, j

      n = contact%n
      place = place_of(contact, state%q, state%a)
      force = TINY_PART*maxval(abs(state%q))
      slack = TINY_PART*size_of_places(contact, state)
      normal = state%normal
      tangential = state%tangential
      broken = 0
      do j = n, 1, -1
         if (.not. contact%known(n + j)) then
            select case (state%tangential(j))
            case (STICK)
               if (abs(state%q(n + j)) > contact%weight(j)*tau(j)*(1 + TINY_PART) + force*TINY_PART) then
                  tangential(j) = merge(SLIP_UP, SLIP_DOWN, state%q(n + j) > 0)
               end if
            case (SLIP_UP, SLIP_DOWN)
               if (state%tangential(j)*place(n + j) < contact%eps*(1 - TINY_PART) - slack) tangential(j) = STICK
            end select
            if (tangential(j) /= state%tangential(j)) broken = broken + 1
            if (only_last .and. broken == 1) exit
         end if
      end do
      if (.not. (only_last .and. broken == 1)) then
         do j = n, 1, -1
            if (contact%known(j)) cycle
            if (state%normal(j) == CLOSED .and. state%q(j) < -force) normal(j) = OPEN
            if (state%normal(j) == OPEN .and. place(j) > slack) normal(j) = CLOSED
            if (normal(j) /= state%normal(j)) broken = broken + 1
            if (only_last .and. broken == 1) exit
         end do
      end if
      if (counting) return
      state%normal = normal
      state%tangential = tangential
   end subroutine change_states

   pure real(qp) function size_of_places(contact, state) result(size_of)
      type(contact_t), intent(in) :: contact
      type(state_t), intent(in) :: state

      size_of = maxval(abs(contact%g0)) + maxval(abs(matmul(contact%c, state%q)))
      if (contact%k > 0) size_of = size_of + maxval(abs(matmul(contact%g, state%a)))
   end function size_of_places

   !> The worst breach of the law and of the balance, relative to the largest force, place or bound.
   function law_error(contact, nu, state) result(worst)
      type(contact_t), intent(in) :: contact
      real(qp), intent(in) :: nu
      type(state_t), intent(in) :: state
      real(qp) :: worst, place(2*contact%n), tau(contact%n), force, places, top, t, limit, balance
      integer :: j, n

      n = contact%n
      place = place_of(contact, state%q, state%a)
      tau = bound_of(contact, state%q, nu)
      force = max(maxval(abs(state%q)), tiny(force))
      places = max(size_of_places(contact, state), tiny(places))
      top = max(maxval(tau), tiny(top))
      worst = 0
      do j = 1, n
         worst = max(worst, -state%q(j)/force)
         if (.not. contact%known(j)) then
            if (state%q(j) > 0) then
               worst = max(worst, abs(place(j) - contact%delta*state%q(j)/contact%weight(j))/places)
            else
               worst = max(worst, place(j)/places)
            end if
         end if
         t = state%q(n + j)/contact%weight(j)
         worst = max(worst, (abs(t) - tau(j))/top)
         if (contact%known(n + j)) cycle
         ! the distance in the plane of slip and stress to the graph of the law
         if (tau(j) > 0) then
            limit = min(max(t/tau(j), -1.0_qp), 1.0_qp)*contact%eps
            if (abs(t) >= tau(j)*(1 - 1.0e-22_qp)) then
               worst = max(worst, (contact%eps - sign(1.0_qp, t)*place(n + j))/max(places, contact%eps))
            else
               worst = max(worst, min(abs(place(n + j) - limit)/places, abs(t - tau(j)*part_of(place(n + j), contact%eps))/top))
            end if
         end if
      end do
      if (contact%k > 0) then
         balance = maxval(abs(contact%h - matmul(transpose(contact%g), state%q)))
         worst = max(worst, balance/(maxval(abs(contact%h)) + sum(abs(state%q)) + tiny(force)))
      end if
   end function law_error

   pure real(qp) function part_of(slip, eps)
      real(qp), intent(in) :: slip, eps

      part_of = 0
      if (abs(slip) > 0) part_of = sign(1.0_qp, slip)
      if (abs(slip) < eps) part_of = slip/eps
   end function part_of

   !> Gauss's elimination with rows and columns scaled, rows exchanged, and one refinement.
   subroutine solve_general(matrix, rhs, singular)
      real(qp), intent(in) :: matrix(:, :)
      real(qp), intent(inout) :: rhs(:)
      logical, intent(out) :: singular
      real(qp) :: a(size(rhs), size(rhs)), row_scale(size(rhs)), column_scale(size(rhs)), x(size(rhs)), r(size(rhs))
      integer :: order(size(rhs)), n, i, pass

      n = size(rhs)
      singular = .false.
      column_scale = 1
      a = matrix
      do pass = 1, 3
         do i = 1, n
            row_scale(i) = maxval(abs(a(i, :)))
            if (.not. row_scale(i) > 0) singular = .true.
            if (singular) return
            a(i, :) = a(i, :)/row_scale(i)
         end do
         do i = 1, n
            if (.not. maxval(abs(a(:, i))) > 0) singular = .true.
            if (singular) return
            column_scale(i) = column_scale(i)/maxval(abs(a(:, i)))
            a(:, i) = a(:, i)/maxval(abs(a(:, i)))
         end do
      end do
      do i = 1, n
         a(i, :) = matrix(i, :)*column_scale
         row_scale(i) = 1/maxval(abs(a(i, :)))
         a(i, :) = a(i, :)*row_scale(i)
      end do
      call factor_general(a, order, singular)
      if (singular) return
      x = 0
      do pass = 1, 2
         r = (rhs - matmul(matrix, x*column_scale))*row_scale
         r = r(order)
         do i = 2, n
            r(i) = r(i) - dot_product(a(i, :i - 1), r(:i - 1))
         end do
         do i = n, 1, -1
            r(i) = (r(i) - dot_product(a(i, i + 1:), r(i + 1:)))/a(i, i)
         end do
         x = x + r
      end do
      rhs = x*column_scale
      singular = .not. all(abs(rhs) < huge(1.0_qp))
   end subroutine solve_general

   subroutine factor_general(a, order, singular)
      real(qp), intent(inout) :: a(:, :)
      integer, intent(out) :: order(:)
      logical, intent(out) :: singular
      real(qp) :: row(size(order))
      integer :: n, i, j, p, held

      n = size(order)
      order = [(i, i=1, n)]
      singular = .false.
      do j = 1, n
         p = j - 1 + maxloc(abs(a(j:, j)), dim=1)
         if (abs(a(p, j)) < 1.0e-31_qp) then
            singular = .true.
            return
         end if
         row = a(j, :)
         a(j, :) = a(p, :)
         a(p, :) = row
         held = order(j)
         order(j) = order(p)
         order(p) = held
         do i = j + 1, n
            a(i, j) = a(i, j)/a(j, j)
            if (abs(a(i, j)) > 0) a(i, j + 1:) = a(i, j + 1:) - a(i, j)*a(j, j + 1:)
         end do
      end do
   end subroutine factor_general

end module quad_solve
