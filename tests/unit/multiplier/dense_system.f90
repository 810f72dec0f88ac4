!> A contact system of a few unknowns with a full matrix, for the tests of the multiplier method.
module dense_system
   use atrito_bound_qp, only: bound_qp_t, box_bounds_t, box_state_t, FREE
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_system, only: contact_system_t
   use atrito_dense, only: solve_cholesky
   use atrito_kinds, only: ip, lp, wp, HUGE_REAL
   use atrito_multiplier_step, only: begin_multipliers, start_closed, take_multiplier_step, accept_step
   use atrito_multipliers, only: multiplier_t
   use atrito_solve_history, only: solve_history_t, begin_outer
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   use dense_measures, only: factor_cholesky
   implicit none (type, external)
   private
   public :: dense_system_t, make_system, make_bounds, solve_case

   type, extends(contact_system_t) :: dense_system_t
      real(wp), allocatable :: a(:, :)           !< (n, n)
      real(wp), allocatable :: b(:, :)           !< (rows, n)
      real(wp), allocatable :: factored(:, :)
   contains
      procedure :: multiply => multiply_dense
      procedure :: factor => factor_dense
      procedure :: solve => solve_dense
      procedure :: memory_bytes => dense_system_bytes
   end type dense_system_t

contains

   !> A system with the last k unknowns amplitudes; flexibility as in atrito_assembled_scene.
   subroutine make_system(a, b, k, g0, load, system)
      real(wp), intent(in) :: a(:, :), b(:, :)
      integer(ip), intent(in) :: k
      real(wp), intent(in) :: g0(:), load(:)
      type(dense_system_t), intent(out) :: system
      integer(ip) :: i, j, m

      system%n = size(a, 1, kind=ip)
      system%k = k
      system%n_bodies = 1
      m = size(b, 1, kind=ip)
      system%a = a
      system%b = b
      system%g0 = g0
      system%load = load
      system%size_of_load = abs(load)
      allocate (system%body(system%n), source=1_ip)
      allocate (system%flexibility(m), source=0.0_wp)
      system%rows%n = m
      system%rows%n_columns = system%n
      system%rows%point = [(i, i=1, m)]
      allocate (system%rows%first(m + 1), source=1_ip)
      allocate (system%rows%column(0), system%rows%value(0))
      do i = 1, m
         do j = 1, system%n
            if (b(i, j) == 0.0_wp) cycle
            system%rows%column = [system%rows%column, j]
            system%rows%value = [system%rows%value, b(i, j)]
            if (j <= system%n - k) system%flexibility(i) = system%flexibility(i) + b(i, j)**2/a(j, j)
         end do
         system%rows%first(i + 1) = size(system%rows%column, kind=ip) + 1
      end do
   end subroutine make_system

   !> Forces of any size, 0 <= q, without compliance.
   subroutine make_bounds(m, bounds)
      integer(ip), intent(in) :: m
      type(box_bounds_t), intent(out) :: bounds

      allocate (bounds%lower(m), bounds%d(m), source=0.0_wp)
      allocate (bounds%upper(m), source=HUGE_REAL)
   end subroutine make_bounds

   !> Steps of the method from rest until the forces stay; all rows are normal ones of one pair.
   subroutine solve_case(system, bounds, most_steps, multipliers, state, status)
      type(dense_system_t), intent(inout) :: system
      type(box_bounds_t), intent(in) :: bounds
      integer(ip), intent(in) :: most_steps
      type(multiplier_t), intent(out) :: multipliers
      type(box_state_t), intent(out) :: state
      type(status_t), intent(out) :: status
      type(bound_qp_t) :: shape
      type(solve_history_t) :: history
      integer(ip) :: i

      shape%m = system%rows%n
      shape%n_normal = shape%m
      shape%k = system%k
      allocate (shape%weight(shape%m), source=1.0_wp)
      allocate (history%tangential_of(shape%m), source=0_ip)
      allocate (state%state(shape%m), source=FREE)
      allocate (state%q(shape%m), state%r(shape%m), state%a(shape%k), source=0.0_wp)
      call begin_multipliers(system, spread(1_ip, 1, shape%m), multipliers)
      call start_closed(system, bounds, multipliers, state, status)
      do i = 1, most_steps
         if (.not. is_ok(status)) return
         call begin_outer(history)
         call take_multiplier_step(system, shape, bounds, .false., multipliers, state, history, status)
         call accept_step(system, state, multipliers)
      end do
   end subroutine solve_case

   subroutine multiply_dense(self, x, y)
      class(dense_system_t), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: y(:)

      y = matmul(self%a, x)
   end subroutine multiply_dense

   subroutine factor_dense(self, stiffness, pull, status)
      class(dense_system_t), intent(inout) :: self
      real(wp), intent(in) :: stiffness(:), pull(:)
      type(status_t), intent(out) :: status
      integer(ip) :: i, failed

      self%factored = self%a
      do i = 1, self%rows%n
         self%factored = self%factored + stiffness(i)*spread(self%b(i, :), 2, self%n)*spread(self%b(i, :), 1, self%n)
      end do
      do i = 1, self%k
         associate (j => self%n - self%k + i)
            self%factored(j, j) = self%factored(j, j) + pull(i)
         end associate
      end do
      call factor_cholesky(self%factored, failed)
      if (failed /= 0) call set_status(status, STATUS_SINGULAR, 'a pivot is not positive')
   end subroutine factor_dense

   subroutine solve_dense(self, x)
      class(dense_system_t), intent(in) :: self
      real(wp), intent(inout) :: x(:)
      real(wp) :: y(size(x), 1)

      y(:, 1) = x
      call solve_cholesky(self%factored, y)
      x = y(:, 1)
   end subroutine solve_dense

   pure integer(lp) function dense_system_bytes(self) result(bytes)
      class(dense_system_t), intent(in) :: self

      bytes = storage_size(1.0_wp)/8*size(self%a, kind=lp)
   end function dense_system_bytes

end module dense_system
