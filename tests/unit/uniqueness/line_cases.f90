!> Small contact lines at random, and all of their solutions: every point open or closed, sticking, or slipping either way, state by
!> state.
module line_cases
   use atrito_average, only: average_t, identity_average
   use atrito_bound_qp, only: bound_qp_t, FREE, AT_LOWER, AT_UPPER
   use atrito_contact_line, only: contact_line_t, number_unknowns
   use atrito_dense, only: sign_of_determinant, solve_lu
   use atrito_friction_law, only: friction_law_t, FRICTION_LOCAL
   use atrito_kinds, only: ip, wp
   implicit none (type, external)
   private
   public :: random_line, random_wide_line, load_folded, line_of, whole_solution_t, all_solutions, state_of, state_count, &
             sign_of_state

   !> States. An open point has friction where the pressures of others are its bound (W is not 1): then it sticks, or slips.
   integer(ip), parameter :: OPEN = 0, STICK = 1, ALONG = 2, AGAINST = 3, OPEN_ALONG = 4, OPEN_AGAINST = 5

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

   !> The same with all that a line may have: weights, an average W that is not symmetric, coefficients of their own, compliance
   !> across and along, and, from two points on, a body that falls onto them.
   subroutine random_wide_line(n, nu, problem, line)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: nu                     !< the largest coefficient
      type(bound_qp_t), intent(out) :: problem
      type(contact_line_t), intent(out) :: line
      real(wp) :: r(n), w(n, n), chance(4)
      integer(ip) :: i, k

      call random_line(n, nu, problem, line)
      call random_number(chance)
      call random_number(r)
      line%weight = 0.5_wp + r
      problem%weight = [line%weight, line%weight]
      call random_number(r)
      line%law(2:)%nu = nu*(0.3_wp + 0.7_wp*r(2:))
      call random_number(r)
      if (chance(1) < 0.5_wp) line%delta = 0.5_wp*r
      if (chance(2) < 0.3_wp) line%law%compliance = 0.2_wp*r
      if (chance(3) < 0.7_wp .and. n > 1) then
         call random_number(w)
         line%average = average_t(n, n, [(n*(i - 1) + 1, i=1, n + 1)], [((k, k=1, n), i=1, n)], &
                                  [(w(i, :)/sum(w(i, :)), i=1, n)], .false.)
      end if
      if (chance(4) < 0.4_wp .and. n > 1) then
         problem%k = 1
         call random_number(r)
         problem%g = reshape([-0.5_wp - r, 0*r], [2*n, 1])
         problem%h = [-2*sum(r)]
      end if
   end subroutine random_wide_line

   !> Loads that have a solution in a state whose determinant is negative, so that there are others; unchanged where no state is so.
   subroutine load_folded(problem, line)
      type(bound_qp_t), intent(inout) :: problem
      type(contact_line_t), intent(in) :: line
      real(wp) :: chance(problem%n_normal), either(problem%n_normal), q(problem%m), r(problem%m), bound(problem%n_normal)
      integer(ip) :: state(problem%n_normal), k, n

      n = problem%n_normal
      do k = 0, state_count(line) - 1
         state = state_of(k, line)
         if (sign_of_state(problem, line, 1.0_wp, state) >= 0) cycle
         call random_number(chance)
         call random_number(either)
         either = 2*either - 1
         q(:n) = merge(0.1_wp + chance, 0.0_wp, is_closed(state))
         r(:n) = merge(0.0_wp, -0.1_wp - chance, is_closed(state))
         bound = matmul(bound_matrix(line, 1.0_wp), q(:n))
         q(n + 1:) = bound*merge(0.9_wp*either, way_of(state), abs(way_of(state)) < 0.5_wp)
         r(n + 1:) = line%law%compliance/line%weight*q(n + 1:) + way_of(state)*(0.1_wp + chance)
         if (line%average%is_identity) where (state == OPEN) r(n + 1:) = either
         problem%g0 = matmul(flexibility(problem, line), q) + r
         if (problem%k > 0) problem%h = matmul(transpose(problem%g), q)
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

   !> Numbers of states: 4^n, and 6^n where open points have friction.
   pure integer(ip) function state_count(line)
      type(contact_line_t), intent(in) :: line

      state_count = merge(4_ip, 6_ip, line%average%is_identity)**line%n
   end function state_count

   !> The states of number k.
   pure function state_of(k, line) result(state)
      integer(ip), intent(in) :: k                   !< 0 .. state_count - 1
      type(contact_line_t), intent(in) :: line
      integer(ip) :: state(line%n), rest, base, i

      base = merge(4_ip, 6_ip, line%average%is_identity)
      rest = k
      do i = 1, line%n
         state(i) = mod(rest, base)
         rest = rest/base
      end do
   end function state_of

   pure elemental logical function is_closed(state)
      integer(ip), intent(in) :: state

      is_closed = state == STICK .or. state == ALONG .or. state == AGAINST
   end function is_closed

   !> 1 along, -1 against, 0: does not slip.
   pure elemental real(wp) function way_of(state)
      integer(ip), intent(in) :: state

      way_of = 0.0_wp
      if (state == ALONG .or. state == OPEN_ALONG) way_of = 1.0_wp
      if (state == AGAINST .or. state == OPEN_AGAINST) way_of = -1.0_wp
   end function way_of

   !> Normal forces to the bounds of friction, as forces.
   pure function bound_matrix(line, factor) result(b)
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: factor                 !< upon all coefficients
      real(wp) :: b(line%n, line%n)
      integer(ip) :: i, k

      b = 0.0_wp
      do i = 1, line%n
         do k = line%average%first(i), line%average%first(i + 1) - 1
            associate (j => line%average%column(k))
               b(i, j) = factor*line%law(i)%nu*line%weight(i)*line%average%value(k)/line%weight(j)
            end associate
         end do
      end do
   end function bound_matrix

   !> C with what the penalty gives way.
   pure function flexibility(problem, line) result(a)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      real(wp) :: a(problem%m, problem%m)
      integer(ip) :: i

      a = problem%c
      do i = 1, problem%n_normal
         a(i, i) = a(i, i) + line%delta(i)/line%weight(i)
      end do
   end function flexibility

   !> All solutions; those of two states that are the same one count once.
   subroutine all_solutions(problem, line, list)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(whole_solution_t), allocatable, intent(out) :: list(:)
      type(whole_solution_t) :: one
      integer(ip) :: k, i
      logical :: holds

      allocate (list(0))
      do k = 0, state_count(line) - 1
         one%state = state_of(k, line)
         call solve_state(problem, line, one, holds)
         do i = 1, size(list, kind=ip)
            if (holds) holds = maxval(abs(one%q - list(i)%q)) > 1.0e-8_wp*maxval(abs(one%q))
         end do
         if (holds) list = [list, one]
      end do
   end subroutine all_solutions

   !> The matrix of a state over the active forces and the motions: rows A q - G a = g0 of closed and sticking ones, with t = +-nu W
   !> p of slipping ones put in, and the balance.
   subroutine matrix_of_state(problem, line, factor, state, active, matrix)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: factor                 !< upon all coefficients
      integer(ip), intent(in) :: state(:)
      integer(ip), allocatable, intent(out) :: active(:)
      real(wp), allocatable, intent(out) :: matrix(:, :)
      real(wp) :: a(problem%m, problem%m), b(line%n, line%n)
      logical :: sticks(line%n)
      integer(ip) :: i, j, n

      n = line%n
      sticks = state == STICK .or. (state == OPEN .and. .not. line%average%is_identity)
      active = [pack([(i, i=1, n)], is_closed(state)), pack([(n + i, i=1, n)], sticks)]
      a = flexibility(problem, line)
      b = bound_matrix(line, factor)
      do i = 1, n
         if (sticks(i)) a(n + i, n + i) = a(n + i, n + i) + line%law(i)%compliance/line%weight(i)
         if (is_closed(state(i))) a(:, i) = a(:, i) + matmul(a(:, n + 1:), way_of(state)*b(:, i))
      end do
      n = size(active, kind=ip)
      allocate (matrix(n + problem%k, n + problem%k), source=0.0_wp)
      matrix(:n, :n) = a(active, active)
      do j = 1, problem%k
         matrix(:n, n + j) = -problem%g(active, j)
         matrix(n + j, :n) = problem%g(active, j)
      end do
   end subroutine matrix_of_state

   !> The sign of its determinant, over that without friction; 1 where too few points are closed to hold the bodies.
   integer(ip) function sign_of_state(problem, line, factor, state) result(sign_of)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: factor                 !< upon all coefficients
      integer(ip), intent(in) :: state(:)
      integer(ip), allocatable :: active(:)
      real(wp), allocatable :: matrix(:, :)

      sign_of = 1
      if (count(is_closed(state)) < problem%k) return
      call matrix_of_state(problem, line, factor, state, active, matrix)
      sign_of = sign_of_determinant(matrix)
   end function sign_of_state

   subroutine solve_state(problem, line, one, holds)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(whole_solution_t), intent(inout) :: one   !< with its states
      logical, intent(out) :: holds
      real(wp), parameter :: TOL = 1.0e-9_wp
      integer(ip), allocatable :: active(:)
      real(wp), allocatable :: matrix(:, :), found(:)
      real(wp) :: bound(line%n), past(line%n)
      integer(ip) :: info, n

      n = line%n
      holds = count(is_closed(one%state)) >= problem%k
      if (.not. holds) return
      call matrix_of_state(problem, line, 1.0_wp, one%state, active, matrix)
      found = [problem%g0(active), problem%h]
      call solve_lu(matrix, found, info)
      holds = info == 0
      if (.not. holds) return
      if (allocated(one%q)) deallocate (one%q)
      allocate (one%q(2*n), source=0.0_wp)
      one%q(active) = found(:size(active))
      associate (p => one%q(:n), t => one%q(n + 1:), way => way_of(one%state))
         bound = matmul(bound_matrix(line, 1.0_wp), p)
         where (abs(way) > 0.5_wp) t = way*bound
         one%r = problem%g0 - matmul(flexibility(problem, line), one%q) + matmul(problem%g, found(size(active) + 1:))
         past = way*(one%r(n + 1:) - line%law%compliance/line%weight*t)
         holds = all(merge(p >= -TOL, one%r(:n) <= TOL, is_closed(one%state))) .and. &
                 all(abs(t) <= bound + TOL) .and. all(past >= -TOL)
      end associate
   end subroutine solve_state

end module line_cases
