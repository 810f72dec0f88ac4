!> Matrices and measures for the tests of linalg.
module linalg_cases
   use atrito_dense, only: solve_cholesky, solve_lu
   use atrito_kinds, only: ip, lp, wp, EPS_MACH
   use atrito_profile, only: profile_t, begin_profile, add_to_profile, close_profile
   use atrito_solver_choice, only: new_solver
   use atrito_status, only: status_t, is_ok
   use atrito_linear_solver, only: linear_solver_t
   use dense_measures, only: factor_cholesky, norm_one
   use random_arrays, only: random_numbers
   implicit none (type, external)
   private
   public :: ORDERS, RATIO_LIMIT, kept_counts, random_matrix, random_symmetric, random_profile, fill_storage, make_storage
   public :: solve_ratio, schur_ratio, chain, grid_elements, is_permutation

   !> Orders at which every kernel is tried.
   integer(ip), parameter :: ORDERS(8) = [0, 1, 2, 3, 5, 10, 50, 200]
   !> LAPACK's bound for a residual over order, norm and epsilon.
   real(wp), parameter :: RATIO_LIMIT = 30.0_wp

contains

   !> The counts of retained equations that are tried with n equations.
   pure function kept_counts(n) result(counts)
      integer(ip), intent(in) :: n
      integer(ip) :: counts(4)

      counts = [0, min(1, n), n/3, n]
   end function kept_counts

   !> Uniform in (-1, 1), the same in every run.
   subroutine random_matrix(seed, a)
      integer(ip), intent(in) :: seed
      real(wp), intent(out) :: a(:, :)
      integer(lp) :: state
      integer(ip) :: j

      state = 1_lp + modulo(int(seed, lp)*7919_lp, 2147483646_lp)
      do j = 1, size(a, 2)
         call random_numbers(state, a(:, j))
      end do
   end subroutine random_matrix

   !> Symmetric positive definite with condition number about n.
   subroutine random_symmetric(seed, a)
      integer(ip), intent(in) :: seed
      real(wp), intent(out) :: a(:, :)
      integer(ip) :: i

      call random_matrix(seed, a)
      a = matmul(a, transpose(a))
      do i = 1, size(a, 1)
         a(i, i) = a(i, i) + 1.0_wp
      end do
   end subroutine random_symmetric

   !> A ragged profile, and a full matrix with it, positive definite by its diagonal.
   subroutine random_profile(seed, n, n_retained, scale, profile, a)
      integer(ip), intent(in) :: seed, n, n_retained
      real(wp), intent(in) :: scale
      type(profile_t), intent(out) :: profile
      real(wp), allocatable, intent(out) :: a(:, :)
      real(wp) :: heights(n, 1)
      integer(ip) :: j, height

      allocate (a(n, n))
      call random_matrix(seed, heights)
      call random_matrix(seed + 1, a)
      call begin_profile(profile, n, n_retained)
      do j = 1, n
         height = int(abs(heights(j, 1))*real(min(j, 17 + n/10), wp))
         call add_to_profile(profile, [0, j, max(j - height, 1)])
      end do
      call close_profile(profile)
      do j = 1, n
         a(:profile%first(j) - 1, j) = 0.0_wp
         a(j, :j - 1) = a(:j - 1, j)
      end do
      do j = 1, n
         a(j, j) = 1.05_wp*(sum(abs(a(j, :j - 1))) + sum(abs(a(j, j + 1:))) + 0.1_wp)
      end do
      a = scale*a
   end subroutine random_profile

   !> Puts a full matrix into a solver, entry by entry as elements of two equations.
   subroutine fill_storage(profile, a, solver)
      type(profile_t), intent(in) :: profile
      real(wp), intent(in) :: a(:, :)
      class(linear_solver_t), intent(inout) :: solver
      real(wp) :: element(3, 3)
      integer(ip) :: i, j

      do j = 1, profile%n
         do i = profile%first(j), j - 1
            element = 0.0_wp
            element(:, 2) = 1e6_wp       ! belongs to a prescribed dof
            element(1, 3) = a(i, j)
            element(3, 1) = a(i, j)
            call solver%add([i, 0, j], element)
         end do
         call solver%add([j], reshape([a(j, j)], [1, 1]))
      end do
   end subroutine fill_storage

   !> Makes a solver of a kind from a full matrix, with the full profile, and factors it.
   subroutine make_storage(kind, a, n_retained, solver, status)
      integer, intent(in) :: kind
      real(wp), intent(in) :: a(:, :)
      integer(ip), intent(in) :: n_retained
      class(linear_solver_t), allocatable, intent(out) :: solver
      type(status_t), intent(out) :: status
      type(profile_t) :: profile
      integer(ip) :: i, n

      n = size(a, 1)
      call begin_profile(profile, n, n_retained)
      call add_to_profile(profile, [(i, i=1, n)])
      call close_profile(profile)
      call new_solver(kind, solver)
      call solver%create(profile, status)
      call fill_storage(profile, a, solver)
      call solver%factor(status)
   end subroutine make_storage

   !> Solves A x = f for two loads by condensation; the residual over n, norms and epsilon.
   function solve_ratio(kind, n, n_retained, scale) result(ratio)
      integer, intent(in) :: kind
      integer(ip), intent(in) :: n, n_retained
      real(wp), intent(in) :: scale
      real(wp) :: ratio
      class(linear_solver_t), allocatable :: solver
      type(profile_t) :: profile
      type(status_t) :: status
      real(wp), allocatable :: a(:, :), f(:, :), x(:, :), schur(:, :), kept(:, :)
      integer(ip) :: failed

      call random_profile(n + n_retained, n, n_retained, scale, profile, a)
      allocate (f(n, 2), schur(n_retained, n_retained))
      call random_matrix(3*n, f)
      call new_solver(kind, solver)
      call solver%create(profile, status)
      call fill_storage(profile, a, solver)
      call solver%factor(status)
      ratio = huge(ratio)
      if (.not. is_ok(status)) return
      x = f
      call solver%reduce(x)
      call solver%get_schur(schur)
      call factor_cholesky(schur, failed)
      if (failed /= 0) return
      kept = x(n - n_retained + 1:, :)
      call solve_cholesky(schur, kept)
      x(n - n_retained + 1:, :) = kept
      call solver%expand(x)
      ratio = 0.0_wp
      if (n > 0) ratio = norm_one(f - matmul(a, x))/(real(n, wp)*norm_one(x)*norm_one(a)*EPS_MACH)
   end function solve_ratio

   !> The Schur complement against the one by LU; the difference over n, norm and epsilon.
   function schur_ratio(kind, n, n_retained, scale) result(ratio)
      integer, intent(in) :: kind
      integer(ip), intent(in) :: n, n_retained
      real(wp), intent(in) :: scale
      real(wp) :: ratio
      class(linear_solver_t), allocatable :: solver
      type(profile_t) :: profile
      type(status_t) :: status
      real(wp), allocatable :: a(:, :), interior(:, :), coupling(:, :), expected(:, :), schur(:, :)
      integer(ip) :: info, m

      call random_profile(n + n_retained, n, n_retained, scale, profile, a)
      m = n - n_retained
      allocate (schur(n_retained, n_retained))
      call new_solver(kind, solver)
      call solver%create(profile, status)
      call fill_storage(profile, a, solver)
      call solver%factor(status)
      call solver%get_schur(schur)
      interior = a(:m, :m)
      coupling = a(:m, m + 1:)
      call solve_lu(interior, coupling, info)
      expected = a(m + 1:, m + 1:) - matmul(a(m + 1:, :m), coupling)
      ratio = 0.0_wp
      if (n_retained > 0) ratio = norm_one(schur - expected)/(real(n, wp)*norm_one(a)*EPS_MACH)
      if (.not. is_ok(status)) ratio = huge(ratio)
   end function schur_ratio

   !> A chain of n nodes and n - 1 equal springs, free at both ends.
   pure function chain(n, spring) result(a)
      integer(ip), intent(in) :: n
      real(wp), intent(in) :: spring
      real(wp) :: a(n, n)
      integer(ip) :: i

      a = 0.0_wp
      do i = 1, n - 1
         a(i, i) = a(i, i) + spring
         a(i + 1, i + 1) = a(i + 1, i + 1) + spring
         a(i, i + 1) = -spring
         a(i + 1, i) = -spring
      end do
   end function chain

   !> Elements of a grid of nx by ny nodes, numbered by rows after the first `offset` ones.
   pure function grid_elements(nx, ny, offset) result(elements)
      integer(ip), intent(in) :: nx, ny, offset
      integer(ip) :: elements(4, (nx - 1)*(ny - 1))
      integer(ip) :: i, j, corner

      do j = 1, ny - 1
         do i = 1, nx - 1
            corner = offset + (j - 1)*nx + i
            elements(:, (j - 1)*(nx - 1) + i) = [corner, corner + 1, corner + nx + 1, corner + nx]
         end do
      end do
   end function grid_elements

   pure logical function is_permutation(order)
      integer(ip), intent(in) :: order(:)
      integer(ip) :: times(size(order)), i

      times = 0
      is_permutation = .false.
      if (any(order < 1) .or. any(order > size(order))) return
      do i = 1, size(order)
         times(order(i)) = times(order(i)) + 1
      end do
      is_permutation = all(times == 1)
   end function is_permutation

end module linalg_cases
