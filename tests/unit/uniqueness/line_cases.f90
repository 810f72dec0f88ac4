!> Small contact lines at random, and all of their solutions: every point open, sticking, or slipping either way, state by state.
module line_cases
   use atrito_average, only: identity_average
   use atrito_bound_qp, only: bound_qp_t, FREE, AT_LOWER, AT_UPPER
   use atrito_contact_line, only: contact_line_t, number_unknowns
   use atrito_dense, only: sign_of_determinant, solve_lu
   use atrito_friction_law, only: friction_law_t, FRICTION_LOCAL
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: random_line, load_folded, line_of, whole_solution_t, all_solutions, state_of, sign_of_state, &
             OPEN, STICK, ALONG, AGAINST

   integer(ip), parameter :: OPEN = 0, STICK = 1, ALONG = 2, AGAINST = 3

   !> One solution: states of the points, forces q = (normal, tangential), overlaps and slips r.
   type :: whole_solution_t
      integer(ip), allocatable :: state(:)
      real(wp), allocatable :: q(:), r(:)
   end type whole_solution_t

contains

   !> C = M M' + 0.3, g0 normal, local friction with exact stick; M and g0 from random_number.
   subroutine random_line(n, nu, problem, line)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: nu
      type(bound_qp_t), intent(out) :: problem
      type(contact_line_t), intent(out) :: line
      real(wp) :: m(2*n, 2*n), c(2*n, 2*n), g0(2*n)
      integer(ip) :: i

      call random_number(m)
      call random_number(g0)
      m = 2*m - 1
      c = matmul(m, transpose(m))
      do i = 1, 2*n
         c(i, i) = c(i, i) + 0.3_wp
      end do
      call line_of(c, 4*g0 - 2, nu, problem, line)
   end subroutine random_line

   !> Loads that have a solution in a state whose determinant is negative, so that there are others; unchanged where no state is so.
   subroutine load_folded(problem, nu)
      type(bound_qp_t), intent(inout) :: problem
      real(wp), intent(in) :: nu
      real(wp) :: a(problem%m), q(problem%m), r(problem%m)
      integer(ip) :: state(problem%n_normal), k, n

      n = problem%n_normal
      do k = 0, 4**n - 1
         state = state_of(k, n)
         if (sign_of_state(problem, nu, state) >= 0) cycle
         call random_number(a)
         q(:n) = merge(0.0_wp, 0.1_wp + a(:n), state == OPEN)
         r(:n) = merge(-0.1_wp - a(:n), 0.0_wp, state == OPEN)
         associate (p => q(:n), either => 2*a(n + 1:) - 1)
            q(n + 1:) = nu*p*merge(0.9_wp*either, merge(1.0_wp, -1.0_wp, state == ALONG), state == STICK)
            r(n + 1:) = merge(0.1_wp + a(n + 1:), -0.1_wp - a(n + 1:), state == ALONG)
            where (state == OPEN) r(n + 1:) = either
            where (state == STICK) r(n + 1:) = 0.0_wp
         end associate
         problem%g0 = matmul(problem%c, q) + r
         return
      end do
   end subroutine load_folded

   !> n points of weight 1 with the flexibility C (all normal forces first) and the displacements g0 without forces.
   subroutine line_of(c, g0, nu, problem, line)
      real(wp), intent(in) :: c(:, :), g0(:), nu
      type(bound_qp_t), intent(out) :: problem
      type(contact_line_t), intent(out) :: line
      integer(ip) :: i, n

      n = size(c, 1, kind=ip)/2
      line%n = n
      allocate (line%law(n))
      line%law = friction_law_t(FRICTION_LOCAL, nu, 0.0_wp, 0.0_wp)
      line%weight = [(1.0_wp, i=1, n)]
      line%delta = [(0.0_wp, i=1, n)]
      line%known_overlap = line%delta
      line%known_slip = line%delta
      line%average = identity_average(n)
      call number_unknowns(line, [(.true., i=1, n)], [(.true., i=1, n)])
      problem%m = 2*n
      problem%n_normal = n
      problem%c = c
      problem%g0 = g0
      problem%weight = [(1.0_wp, i=1, 2*n)]
      allocate (problem%g(2*n, 0), problem%h(0))
   end subroutine line_of

   !> The states of number k, 0 .. 4^n - 1.
   pure function state_of(k, n) result(state)
      integer(ip), intent(in) :: k, n
      integer(ip) :: state(n), rest, i

      rest = k
      do i = 1, n
         state(i) = mod(rest, 4_ip)
         rest = rest/4
      end do
   end function state_of

   !> All solutions; those of two states that are the same one count once.
   subroutine all_solutions(problem, nu, list)
      type(bound_qp_t), intent(in) :: problem
      real(wp), intent(in) :: nu
      type(whole_solution_t), allocatable, intent(out) :: list(:)
      type(whole_solution_t) :: one
      integer(ip) :: k, i
      logical :: holds

      allocate (list(0))
      do k = 0, 4**problem%n_normal - 1
         one%state = state_of(k, problem%n_normal)
         call solve_state(problem, nu, one, holds)
         do i = 1, size(list, kind=ip)
            if (holds) holds = maxval(abs(one%q - list(i)%q)) > 1.0e-8_wp*maxval(abs(one%q))
         end do
         if (holds) list = [list, one]
      end do
   end subroutine all_solutions

   !> The matrix of a state over the active forces: rows r = 0 of closed and sticking ones, with t = +-nu p of slipping ones put in.
   subroutine matrix_of_state(problem, nu, state, active, matrix)
      type(bound_qp_t), intent(in) :: problem
      real(wp), intent(in) :: nu
      integer(ip), intent(in) :: state(:)
      integer(ip), allocatable, intent(out) :: active(:)
      real(wp), allocatable, intent(out) :: matrix(:, :)
      integer(ip) :: i, j, n

      n = problem%n_normal
      active = [pack([(i, i=1, n)], state > OPEN), pack([(n + i, i=1, n)], state == STICK)]
      matrix = problem%c(active, active)
      do j = 1, count(state > OPEN, kind=ip)
         i = active(j)
         if (state(i) == ALONG) matrix(:, j) = matrix(:, j) + nu*problem%c(active, n + i)
         if (state(i) == AGAINST) matrix(:, j) = matrix(:, j) - nu*problem%c(active, n + i)
      end do
   end subroutine matrix_of_state

   !> The sign of its determinant.
   integer(ip) function sign_of_state(problem, nu, state)
      type(bound_qp_t), intent(in) :: problem
      real(wp), intent(in) :: nu
      integer(ip), intent(in) :: state(:)
      integer(ip), allocatable :: active(:)
      real(wp), allocatable :: matrix(:, :)

      call matrix_of_state(problem, nu, state, active, matrix)
      sign_of_state = sign_of_determinant(matrix)
   end function sign_of_state

   subroutine solve_state(problem, nu, one, holds)
      type(bound_qp_t), intent(in) :: problem
      real(wp), intent(in) :: nu
      type(whole_solution_t), intent(inout) :: one   !< with its states
      logical, intent(out) :: holds
      real(wp), parameter :: TOL = 1.0e-9_wp
      integer(ip), allocatable :: active(:)
      real(wp), allocatable :: matrix(:, :), forces(:)
      integer(ip) :: info, n

      n = problem%n_normal
      call matrix_of_state(problem, nu, one%state, active, matrix)
      forces = problem%g0(active)
      call solve_lu(matrix, forces, info)
      holds = info == 0
      if (.not. holds) return
      if (allocated(one%q)) deallocate (one%q)
      allocate (one%q(2*n), source=0.0_wp)
      one%q(active) = forces
      associate (p => one%q(:n), t => one%q(n + 1:))
         where (one%state == ALONG) t = nu*p
         where (one%state == AGAINST) t = -nu*p
      end associate
      one%r = problem%g0 - matmul(problem%c, one%q)
      associate (p => one%q(:n), t => one%q(n + 1:), gap => one%r(:n), slip => one%r(n + 1:), state => one%state)
         holds = all(state == OPEN .or. p >= -TOL) .and. all(state /= OPEN .or. gap <= TOL) .and. &
                 all(state /= STICK .or. abs(t) <= nu*p + TOL) .and. all(state /= ALONG .or. slip >= -TOL) .and. &
                 all(state /= AGAINST .or. slip <= TOL)
      end associate
   end subroutine solve_state

end module line_cases
