!> Bound-constrained QPs for the tests of contact: random ones, all their states one by one, and how far a state is from a solution.
module box_cases
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE, AT_LOWER, AT_UPPER, FROZEN
   use atrito_dense, only: least_squares
   use atrito_kinds, only: ip, lp, wp, HUGE_REAL
   use random_arrays, only: random_numbers
   implicit none (type, external)
   private
   public :: random_problem, start_state, kkt_residual, enumerate_states, certificate

contains

   !> n_normal closing forces, n_shear ones with bounds on both sides, k motions; d = 0 or some part of C.
   subroutine random_problem(seed, n_normal, n_shear, k, d_size, problem, bounds)
      integer(ip), intent(in) :: seed, n_normal, n_shear, k
      real(wp), intent(in) :: d_size
      type(bound_qp_t), intent(out) :: problem
      type(box_bounds_t), intent(out) :: bounds
      integer(lp) :: state
      real(wp), allocatable :: flat(:)
      integer(ip) :: m, i

      state = 7919_lp*seed + 1
      m = n_normal + n_shear
      problem%m = m
      problem%k = k
      problem%n_normal = n_normal
      allocate (flat(m*m + 100))
      call random_numbers(state, flat)           ! the first ones of near seeds are alike
      call random_numbers(state, flat)
      problem%c = reshape(flat(:m*m), [m, m])
      problem%c = matmul(problem%c, transpose(problem%c))
      do i = 1, m
         problem%c(i, i) = problem%c(i, i) + 0.05_wp
      end do
      allocate (problem%g0(m), problem%g(m, k), problem%h(k), problem%weight(m))
      allocate (bounds%lower(m), bounds%upper(m), bounds%d(m))
      call random_numbers(state, problem%g0)
      call random_numbers(state, flat(:m*k))
      problem%g = reshape(flat(:m*k), [m, k])
      call random_numbers(state, problem%h)
      call random_numbers(state, problem%weight)
      problem%weight = 1.0_wp + 0.5_wp*problem%weight
      call random_numbers(state, bounds%d)
      bounds%d = d_size*abs(bounds%d)
      call random_numbers(state, bounds%upper)
      bounds%upper = abs(bounds%upper)
      bounds%lower = -bounds%upper
      bounds%lower(:n_normal) = 0.0_wp
      bounds%upper(:n_normal) = HUGE_REAL
   end subroutine random_problem

   !> All closed and stuck (FREE), or all open and slipping (AT_LOWER).
   pure subroutine start_state(problem, begin, state)
      type(bound_qp_t), intent(in) :: problem
      integer(ip), intent(in) :: begin
      type(box_state_t), intent(out) :: state

      allocate (state%state(problem%m), source=begin)
      allocate (state%q(problem%m), state%r(problem%m), state%a(problem%k), source=0.0_wp)
   end subroutine start_state

   !> How far q, a are from the conditions of the bound-constrained QP, whatever the states say: bounds and G'q = h over the largest
   !> force, signs of r where q is at a bound and r = 0 where it is not over the largest term of r.
   pure real(wp) function kkt_residual(problem, bounds, state) result(worst)
      type(bound_qp_t), intent(in) :: problem
      type(box_bounds_t), intent(in) :: bounds
      type(box_state_t), intent(in) :: state
      real(wp), parameter :: AT_BOUND = 1.0e-11_wp
      real(wp) :: r(problem%m), balance(problem%k), force, place, near
      integer(ip) :: i

      force = maxval([abs(state%q), abs(problem%h), 1.0e-300_wp])
      r = problem%g0 - matmul(problem%c, state%q) - bounds%d*state%q + matmul(problem%g, state%a)
      place = maxval([abs(problem%g0), abs(matmul(problem%c, state%q)), abs(matmul(problem%g, state%a)), 1.0e-300_wp])
      balance = matmul(transpose(problem%g), state%q) - problem%h
      worst = maxval([abs(balance)/force, 0.0_wp])
      do i = 1, problem%m
         if (state%state(i) == FROZEN) then
            worst = max(worst, abs(state%q(i))/force)
            cycle
         end if
         worst = max(worst, (bounds%lower(i) - state%q(i))/force)
         if (bounds%upper(i) < HUGE_REAL) worst = max(worst, (state%q(i) - bounds%upper(i))/force)
         near = AT_BOUND*force
         if (state%q(i) - bounds%lower(i) > near) worst = max(worst, -r(i)/place)
         if (bounds%upper(i) - state%q(i) > near) worst = max(worst, r(i)/place)
      end do
   end function kkt_residual

   !> Tries every combination of states; `found`: one fulfils all conditions, and state is it.
   subroutine enumerate_states(problem, bounds, state, found)
      type(bound_qp_t), intent(in) :: problem
      type(box_bounds_t), intent(in) :: bounds
      type(box_state_t), intent(out) :: state
      logical, intent(out) :: found
      integer(ip), parameter :: CHOICES(3) = [FREE, AT_LOWER, AT_UPPER]
      integer(ip) :: code, rest, i

      call start_state(problem, FREE, state)
      found = .false.
      do code = 0, 3**problem%m - 1
         rest = code
         do i = 1, problem%m
            state%state(i) = CHOICES(mod(rest, 3_ip) + 1)
            rest = rest/3
         end do
         if (any(state%state == AT_UPPER .and. bounds%upper >= HUGE_REAL)) cycle
         call solve_states(problem, bounds, state)
         found = kkt_residual(problem, bounds, state) < 1.0e-9_wp
         if (found) return
      end do
   end subroutine enumerate_states

   !> The equations of one combination by least squares: where they contradict each other the conditions will not hold.
   subroutine solve_states(problem, bounds, state)
      type(bound_qp_t), intent(in) :: problem
      type(box_bounds_t), intent(in) :: bounds
      type(box_state_t), intent(inout) :: state
      real(wp) :: a(problem%m + problem%k, problem%m + problem%k), b(problem%m + problem%k), x(problem%m + problem%k)
      integer(ip) :: i, m, rank, info

      m = problem%m
      a = 0.0_wp
      do i = 1, m
         select case (state%state(i))
         case (AT_LOWER)
            a(i, i) = 1.0_wp
            b(i) = bounds%lower(i)
         case (AT_UPPER)
            a(i, i) = 1.0_wp
            b(i) = bounds%upper(i)
         case default
            a(i, :m) = problem%c(i, :)
            a(i, i) = a(i, i) + bounds%d(i)
            a(i, m + 1:) = -problem%g(i, :)
            b(i) = problem%g0(i)
         end select
      end do
      a(m + 1:, :m) = transpose(problem%g)
      b(m + 1:) = problem%h
      call least_squares(a, b, x, 1.0e-11_wp, rank, info)
      state%q = x(:m)
      state%a = x(m + 1:)
   end subroutine solve_states

   !> What no contact force within the bounds can resist: the load's work on a motion less the most that the forces can take of
   !> it, over the size of both. Positive: there is no equilibrium, and the motion shows it (Farkas).
   pure real(wp) function certificate(problem, bounds, motion) result(excess)
      type(bound_qp_t), intent(in) :: problem
      type(box_bounds_t), intent(in) :: bounds
      real(wp), intent(in) :: motion(:)
      real(wp) :: rate(problem%m), scale
      integer(ip) :: i

      rate = matmul(problem%g, motion)
      scale = maxval([abs(problem%g*spread(motion, 1, problem%m)), 1.0e-300_wp])
      excess = dot_product(problem%h, motion)
      do i = 1, problem%m
         if (abs(rate(i)) <= 1.0e-10_wp*scale) cycle
         if (rate(i) < 0.0_wp) then
            excess = excess - bounds%lower(i)*rate(i)
         else if (bounds%upper(i) >= HUGE_REAL) then
            excess = -HUGE_REAL
            return
         else
            excess = excess - bounds%upper(i)*rate(i)
         end if
      end do
      excess = excess/max(maxval(abs(problem%h*motion)), 1.0e-300_wp)
   end function certificate

end module box_cases
