!> Newton's method on the forces and the rigid motions together, friction bound and all.
!>
!> The Picard loop freezes the bound tau; this does not. Unknowns are q of closed, sticking and slipping points, and a; open points
!> have q = 0. Rows are
!>
!>     r_i = g0_i - ((C + D) q)_i + (G a)_i = 0           closed and sticking points; D = eps/(w tau(q)) for NONLOCAL
!>     q_i -+ w_j tau_j(q) = 0                            points j that slip along T or against it
!>     G' q = h                                           the balance of the bodies
!>
!> with tau_j = nu sum_k W_jk q_k/w_k, W being the average S_rho, so d tau_j/d q_k = nu W_jk/w_k (`bound_slope`). The derivative of
!> D is -D/tau d tau. The matrix is not symmetric, so it is factored by LU: 2/3 (|active| + k)^3 operations a step. Forces are
!> scaled by 1/sqrt(C_ii + D_ii), motions to unit columns, so that stiff and soft bodies count alike.
!>
!> States change after each step as in the full steps of the active set. Once they stand, the error is squared in each step. From
!> far away nothing makes it converge, and states may turn to and fro; a singular matrix ends it. So it is begun from a state that
!> the loop has come to.
module atrito_newton
   use atrito_active_set, only: change_states
   use atrito_bound_qp, only: bound_qp_t, FREE, AT_LOWER, AT_UPPER, FROZEN
   use atrito_contact_line, only: contact_line_t, pressure_of, find_shear, set_friction_bounds
   use atrito_contact_solution, only: contact_solution_t, bound_of_state, judge_condition, has_settled
   use atrito_controls, only: controls_t
   use atrito_dense, only: solve_lu
   use atrito_free_set, only: set_residual
   use atrito_friction_law, only: FRICTION_NONLOCAL
   use atrito_kinds, only: ip, wp
   use atrito_solve_history, only: record_solve, begin_outer, end_outer
   implicit none (type, external)
   private
   public :: iterate_newton, jacobian_of_state

contains

   !> Iterates from the present state until nothing changes, or max_iterations. solution%converged says how it ended; a singular
   !> Jacobian ends it.
   !>
   !>     1. tau and D of the present forces, the active rows
   !>     2. the Jacobian and the residual, one LU
   !>     3. q, a; then tau, D, r of the new forces
   !>     4. states change where r, q and tau ask for it (change_states of the active set)
   !>
   !> Converged: no state has changed, and the forces by no more than the tolerance or round-off (has_settled). Slipping forces are
   !> then put at their bounds to the last digit.
   subroutine iterate_newton(problem, line, controls, solution)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      type(controls_t), intent(in) :: controls !< method, tolerance, MAXIT
      type(contact_solution_t), intent(inout) :: solution !< with a state to start from
      real(wp), allocatable :: jacobian(:, :), rhs(:), scale(:)
      integer(ip), allocatable :: active(:)
      integer(ip) :: iteration, info, changes
      real(wp) :: change, last_change, largest_force

      call judge_condition(solution)
      solution%converged = .false.
      last_change = -1.0_wp
      do iteration = 1, controls%max_iterations
         call begin_outer(solution%history)
         ! the bound and the compliances of the present forces: no part of the iteration before is kept
         solution%tau = bound_of_state(line, solution)
         call update_compliances(problem, line, solution)
         active = active_unknowns(problem, solution)
         call build_system(problem, line, solution, active, jacobian, rhs)
         call solve_lu(jacobian, rhs, info)
         if (info /= 0) then
            solution%verdict = 'NEWTON met a singular matrix'
            return
         end if
         ! changes and forces in the scaled unknowns, q sqrt(C + D): [F L]^1/2, alike for stiff and soft rows
         change = maxval(abs([rhs(:size(active)), 0.0_wp]))
         scale = force_scale(problem, solution, active)
         associate (n => size(active), q => solution%state%q, a => solution%state%a)
            q(active) = q(active) + rhs(:n)*scale
            a = a + rhs(n + 1:)*scale_of_motions(problem, active, scale)
            largest_force = maxval(abs([q(active)/scale, 0.0_wp]))
         end associate
         solution%tau = bound_of_state(line, solution)
         call update_compliances(problem, line, solution)
         call set_residual(problem, solution%bounds%d, solution%state)
         call record_solve(solution%history, problem, solution%bounds, solution%state)
         call change_states(problem, solution%bounds, solution%state, changes)
         where (solution%state%state(:problem%n_normal) == AT_LOWER) solution%state%q(:problem%n_normal) = 0.0_wp
         if (largest_force > 0.0_wp) change = change/largest_force
         call end_outer(solution%history, change)
         solution%converged = changes == 0 .and. has_settled(controls%tolerance, solution%inner%condition, last_change, change)
         solution%residual = change
         last_change = change
         if (solution%converged) exit
      end do
      if (.not. solution%converged) solution%verdict = 'NEWTON did not converge'
      call put_slipping_at_bounds(problem, line, solution)
      solution%p = pressure_of(line, solution%state%q)
      call find_shear(line, solution%state%q, solution%tau, solution%p, solution%t)
   end subroutine iterate_newton

   !> The unknowns that have a row: open points have none, slipping ones have.
   pure function active_unknowns(problem, solution) result(active)
      type(bound_qp_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      integer(ip), allocatable :: active(:)
      integer(ip) :: i

      associate (state => solution%state%state, slips => [(i > problem%n_normal, i=1, problem%m)])
         active = pack([(i, i=1, problem%m)], state == FREE .or. (slips .and. (state == AT_LOWER .or. state == AT_UPPER)))
      end associate
   end function active_unknowns

   !> The matrix of a step from a state, scaled: where no state changes, what the equations are there. Without friction its
   !> determinant is positive.
   pure subroutine jacobian_of_state(problem, line, solution, jacobian, slips)
      type(bound_qp_t), intent(in) :: problem !< the QP: C, G, g0, h
      type(contact_line_t), intent(in) :: line !< points, laws, average S_rho
      type(contact_solution_t), intent(in) :: solution !< with states, forces and tau
      real(wp), allocatable, intent(out) :: jacobian(:, :) !< of the active unknowns, then of the motions; scaled
      logical, allocatable, intent(out) :: slips(:) !< which of the first rows are of slipping forces
      real(wp), allocatable :: rhs(:)
      integer(ip), allocatable :: active(:)

      active = active_unknowns(problem, solution)
      call build_system(problem, line, solution, active, jacobian, rhs)
      slips = solution%state%state(active) /= FREE
   end subroutine jacobian_of_state

   !> d tau_j / d q of the active unknowns: nu W_jk / w_k of the pressures.
   !>
   !> Pressures of open points are zero and stay so: they are no active unknowns, and have no part.
   pure function bound_slope(problem, line, active, j) result(slope)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: active(:), j
      real(wp) :: slope(size(active))
      real(wp) :: of_all(problem%m)
      integer(ip) :: k, i

      of_all = 0.0_wp
      do k = line%average%first(j), line%average%first(j + 1) - 1
         i = line%normal(line%average%column(k))
         if (i > 0) of_all(i) = line%law(j)%nu*line%average%value(k)/problem%weight(i)
      end do
      slope = of_all(active)
   end function bound_slope

   !> Points without a bound have no force either.
   !>
   !> tau = 0: the state becomes FROZEN (set_friction_bounds), and what force the step has left there goes.
   pure subroutine update_compliances(problem, line, solution)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(inout) :: solution

      call set_friction_bounds(line, problem, solution%tau, solution%bounds, solution%state)
      where (solution%state%state == FROZEN) solution%state%q = 0.0_wp
   end subroutine update_compliances

   !> The linear system for the changes, scaled: forces by 1/sqrt(C_ii + D_ii), motions to unit columns.
   !>
   !> Rows: the active unknowns in their order, then the motions. The right hand side is r of the sticking and closed ones, what
   !> slipping ones are off their bound by, and what the forces leave of the balance.
   pure subroutine build_system(problem, line, solution, active, jacobian, rhs)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(in) :: solution
      integer(ip), intent(in) :: active(:)
      real(wp), allocatable, intent(out) :: jacobian(:, :), rhs(:)
      real(wp) :: scale(size(active)), motion_scale(problem%k), r(problem%m)
      integer(ip) :: n, row, column, i

      n = size(active, kind=ip)
      allocate (jacobian(n + problem%k, n + problem%k), rhs(n + problem%k), source=0.0_wp)
      ! a unit diagonal of C + D, and columns of the motions whose largest entry is one
      scale = force_scale(problem, solution, active)
      motion_scale = scale_of_motions(problem, active, scale)
      r = problem%g0 - matmul(problem%c, solution%state%q) - solution%bounds%d*solution%state%q &
          + matmul(problem%g, solution%state%a)
      do row = 1, n
         i = active(row)
         ! closed or sticking: r = 0; slipping: q at its bound
         if (solution%state%state(i) == FREE) then
            call stick_row(jacobian(row, :n))
            jacobian(row, :n) = jacobian(row, :n)*scale*scale(row)
            jacobian(row, n + 1:) = -problem%g(i, :)*scale(row)*motion_scale
            rhs(row) = r(i)*scale(row)
         else
            call slip_row(jacobian(row, :n), rhs(row))
            jacobian(row, :n) = jacobian(row, :n)*scale/scale(row)
            rhs(row) = rhs(row)/scale(row)
         end if
      end do
      do column = 1, n
         jacobian(n + 1:, column) = problem%g(active(column), :)*scale(column)*motion_scale
      end do
      ! the balance of the bodies, scaled like the motions so that the matrix is nearly antisymmetric there
      rhs(n + 1:) = (problem%h - matmul(transpose(problem%g), solution%state%q))*motion_scale

   contains

      !> -dr/dq of a closed or sticking point: C + D, and for the law of Oden and Pires -q D'(tau) dtau/dq.
      !>
      !> Minus, since the system is solved for the change that makes r vanish: (C + D) dq - G da = r. For NONLOCAL D = eps/(w tau),
      !> so dD/dq = -D/tau dtau/dq.
      pure subroutine stick_row(jacobian)
         real(wp), intent(inout) :: jacobian(:)
         integer(ip) :: i, j

         i = active(row)
         j = line%point(i)
         jacobian = problem%c(i, active)
         jacobian(row) = jacobian(row) + solution%bounds%d(i)
         if (i <= problem%n_normal .or. line%law(j)%kind /= FRICTION_NONLOCAL) return
         jacobian = jacobian - solution%state%q(i)*solution%bounds%d(i)/solution%tau(j)*bound_slope(problem, line, active, j)
      end subroutine stick_row

      !> q - sign w tau(q) = 0 of a slipping point.
      !>
      !> dq_t -+ w dtau = +-w tau - q_t: the only rows in which pressures move the friction.
      pure subroutine slip_row(jacobian, rhs)
         real(wp), intent(inout) :: jacobian(:)
         real(wp), intent(out) :: rhs
         real(wp) :: direction
         integer(ip) :: i, j

         i = active(row)
         j = line%point(i)
         direction = merge(1.0_wp, -1.0_wp, solution%state%state(i) == AT_UPPER)
         jacobian = -direction*line%weight(j)*bound_slope(problem, line, active, j)
         jacobian(row) = jacobian(row) + 1.0_wp
         rhs = direction*line%weight(j)*solution%tau(j) - solution%state%q(i)
      end subroutine slip_row

   end subroutine build_system

   pure function force_scale(problem, solution, active) result(scale)
      type(bound_qp_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      integer(ip), intent(in) :: active(:)
      real(wp) :: scale(size(active))
      integer(ip) :: i

      scale = [(1.0_wp/sqrt(problem%c(active(i), active(i)) + solution%bounds%d(active(i))), i=1, size(active, kind=ip))]
   end function force_scale

   pure function scale_of_motions(problem, active, scale) result(motion_scale)
      type(bound_qp_t), intent(in) :: problem
      integer(ip), intent(in) :: active(:)
      real(wp), intent(in) :: scale(:)
      real(wp) :: motion_scale(problem%k)
      integer(ip) :: j

      do j = 1, problem%k
         motion_scale(j) = maxval([abs(problem%g(active, j))*scale, 0.0_wp])
         if (motion_scale(j) > 0.0_wp) motion_scale(j) = 1.0_wp/motion_scale(j)
      end do
   end function scale_of_motions

   !> A slipping force is its bound to the last digit.
   pure subroutine put_slipping_at_bounds(problem, line, solution)
      type(bound_qp_t), intent(in) :: problem
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(inout) :: solution
      integer(ip) :: i

      do i = problem%n_normal + 1, problem%m
         associate (j => line%point(i), state => solution%state)
            if (state%state(i) == AT_UPPER) state%q(i) = solution%tau(j)*line%weight(j)
            if (state%state(i) == AT_LOWER) state%q(i) = -solution%tau(j)*line%weight(j)
         end associate
      end do
   end subroutine put_slipping_at_bounds

end module atrito_newton
