!> Random bound-constrained QPs and their conditions.
module contact_cases
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE, AT_LOWER, AT_UPPER
   use atrito_kinds, only: ip, lp, wp
   implicit none (type, external)
   private
   public :: random_problem, condition_error, random_number_of

contains

   !> The next number in (0, 1) of a small generator, the same everywhere.
   real(wp) function random_number_of(seed) result(x)
      integer(lp), intent(inout) :: seed

      seed = mod(seed*48271_lp, 2147483647_lp)
      x = real(seed, wp)/2147483647.0_wp
   end function random_number_of

   !> n normal and n tangential unknowns, C = A'A/n + a little, k rigid motions; bounds of friction; D zero or not.
   subroutine random_problem(seed, n, k, problem, bounds, state)
      integer(lp), intent(inout) :: seed
      integer(ip), intent(in) :: n, k
      type(bound_qp_t), intent(out) :: problem
      type(box_bounds_t), intent(out) :: bounds
      type(box_state_t), intent(out) :: state
      real(wp) :: a(2*n, 2*n)
      integer(ip) :: i, j, m

      m = 2*n
      problem%m = m
      problem%n_normal = n
      problem%k = k
      allocate (problem%c(m, m), problem%g(m, k), problem%g0(m), problem%h(k), problem%weight(m))
      do j = 1, m
         do i = 1, m
            a(i, j) = random_number_of(seed) - 0.5_wp
         end do
         problem%g0(j) = random_number_of(seed) - 0.4_wp
         problem%weight(j) = 1.0_wp
      end do
      problem%c = matmul(transpose(a), a)
      do i = 1, m
         problem%c(i, i) = problem%c(i, i) + 0.02_wp
      end do
      do j = 1, k
         do i = 1, m
            problem%g(i, j) = random_number_of(seed)
         end do
         problem%h(j) = random_number_of(seed)
      end do
      allocate (bounds%lower(m), bounds%upper(m), bounds%d(m), source=0.0_wp)
      bounds%upper(:n) = huge(1.0_wp)
      do i = n + 1, m
         bounds%upper(i) = 0.4_wp*random_number_of(seed)
         bounds%lower(i) = -bounds%upper(i)
         bounds%d(i) = merge(0.1_wp, 0.0_wp, random_number_of(seed) > 0.5_wp)
      end do
      allocate (state%state(m), source=FREE)
      allocate (state%q(m), state%a(k), state%r(m), source=0.0_wp)
   end subroutine random_problem

   !> The largest violation of the conditions of the bound-constrained QP, computed from q and a alone.
   pure real(wp) function condition_error(problem, bounds, state) result(error)
      type(bound_qp_t), intent(in) :: problem
      type(box_bounds_t), intent(in) :: bounds
      type(box_state_t), intent(in) :: state
      real(wp) :: r(problem%m)
      real(wp), parameter :: AT_BOUND = 1.0e-12_wp
      integer(ip) :: i

      r = problem%g0 - matmul(problem%c, state%q) - bounds%d*state%q + matmul(problem%g, state%a)
      error = maxval([abs(problem%h - matmul(transpose(problem%g), state%q)), 0.0_wp])
      do i = 1, problem%m
         error = max(error, bounds%lower(i) - state%q(i), state%q(i) - bounds%upper(i))
         if (state%q(i) <= bounds%lower(i) + AT_BOUND) then
            if (state%q(i) < bounds%upper(i) - AT_BOUND) error = max(error, r(i))
         else if (state%q(i) >= bounds%upper(i) - AT_BOUND) then
            error = max(error, -r(i))
         else
            error = max(error, abs(r(i)))
         end if
      end do
   end function condition_error

end module contact_cases
