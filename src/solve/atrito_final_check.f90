!> The check at the end of every run, made afresh from the displacements and the stresses that are written: equilibrium of the
!> full bodies, balance of the forces on them, and the contact law at every point.
module atrito_final_check
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_assembly, only: fem_t
   use atrito_average, only: apply_average
   use atrito_bodies, only: body_t, mode_at
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t, row_value
   use atrito_friction_law, only: friction_stress, sticking_slip, FRICTION_NONE
   use atrito_internal_forces, only: internal_forces, internal_force_sizes
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_results, only: results_t
   use atrito_strings, only: to_text
   use atrito_threads, only: is_shared, run_count, find_run
   implicit none (type, external)
   private
   public :: check_equilibrium, check_balance, check_law, equilibrium_t

   !> The outcome for the full bodies.
   type :: equilibrium_t
      real(wp) :: residual = 0.0_wp            !< max-norm of the free rows of K u_e + B'q - f [F]
      real(wp) :: largest_force = 0.0_wp       !< largest nodal force, applied, contact or reaction [F]
      real(wp) :: energy = 0.0_wp              !< strain energy [F L]
      logical :: holds = .false.
   end type equilibrium_t

   !> What one run of nodes contributes to it.
   type :: extremes_t
      real(wp) :: residual = 0.0_wp, largest_force = 0.0_wp
      logical :: finite = .true.
   end type extremes_t

   real(wp), parameter :: FORCE_TOLERANCE = 1.0e-7_wp    !< of the largest nodal force
   real(wp), parameter :: ROUND_OFFS = 100.0_wp          !< times eps |K||u_e|
   real(wp), parameter :: BALANCE_TOLERANCE = 1.0e-8_wp  !< of the sum of the forces on a body
   real(wp), parameter :: PLACE_TOLERANCE = 1.0e-7_wp    !< of the largest displacement: gaps and slips against the field
   real(wp), parameter :: SIGN_TOLERANCE = 1.0e-9_wp     !< of the largest pressure or displacement

contains

   !> K u_e - f + B'q of all elements, assembled again: reactions at the prescribed dofs, residual at the free ones.
   subroutine check_equilibrium(fem, u, f, contact, held, reaction, equilibrium)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)           !< u_e, without rigid motions, (2, n_nodes) [L]
      real(wp), intent(in) :: f(:, :)           !< applied forces (2, n_nodes) [F]
      real(wp), intent(in) :: contact(:, :)     !< B'q (2, n_nodes) [F]
      logical, intent(in) :: held(:, :)
      real(wp), intent(out) :: reaction(:, :)   !< (2, n_nodes) [F]; 0 at free dofs
      type(equilibrium_t), intent(out) :: equilibrium
      type(extremes_t) :: found(run_count(fem%mesh%n_nodes))
      real(wp) :: allowed
      integer(ip) :: run, first, last, node

      !$omp parallel do schedule(static) if (is_shared(fem%mesh%n_nodes))
      do node = 1, fem%mesh%n_nodes
         reaction(:, node) = 0.0_wp
      end do
      !$omp end parallel do
      call internal_forces(fem, u, reaction, equilibrium%energy)
      !$omp parallel do schedule(static) private(first, last) if (is_shared(fem%mesh%n_nodes))
      do run = 1, size(found, kind=ip)
         call find_run(run, fem%mesh%n_nodes, first, last)
         call split_forces(u(:, first:last), f(:, first:last), contact(:, first:last), held(:, first:last), &
                           reaction(:, first:last), found(run))
      end do
      !$omp end parallel do
      equilibrium%residual = maxval([found%residual, 0.0_wp])
      equilibrium%largest_force = maxval([found%largest_force, 0.0_wp])
      allowed = FORCE_TOLERANCE*equilibrium%largest_force
      ! the round-off is asked for where it matters
      if (equilibrium%residual > allowed) allowed = allowed + ROUND_OFFS*EPS_MACH*largest_size(fem, u)
      equilibrium%holds = equilibrium%residual <= allowed .and. all(found%finite)
   end subroutine check_equilibrium

   !> From the internal forces of some nodes to reactions where they are held and residuals where they are free.
   pure subroutine split_forces(u, f, contact, held, reaction, found)
      real(wp), intent(in) :: u(:, :), f(:, :), contact(:, :)
      logical, intent(in) :: held(:, :)
      real(wp), intent(inout) :: reaction(:, :) !< internal forces in [F]
      type(extremes_t), intent(out) :: found
      real(wp) :: force
      integer(ip) :: i, dof

      do i = 1, size(u, 2, kind=ip)
         do dof = 1, 2
            force = reaction(dof, i) - f(dof, i) + contact(dof, i)
            reaction(dof, i) = 0.0_wp
            if (held(dof, i)) then
               reaction(dof, i) = force
               found%largest_force = max(found%largest_force, abs(force))
            else
               found%residual = max(found%residual, abs(force))
            end if
            found%largest_force = max(found%largest_force, abs(f(dof, i)), abs(contact(dof, i)))
            ! max passes over what is not a number
            found%finite = found%finite .and. ieee_is_finite(force) .and. ieee_is_finite(u(dof, i))
         end do
      end do
   end subroutine split_forces

   !> Largest sum |K||u_e| [F].
   pure real(wp) function largest_size(fem, u)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: u(:, :)
      real(wp), allocatable :: size_of_force(:, :)

      allocate (size_of_force(2, fem%mesh%n_nodes))
      call internal_force_sizes(fem, u, size_of_force)
      largest_size = maxval(size_of_force)
   end function largest_size

   !> Z'(f - B'q) of every rigid motion, relative to the forces; the worst.
   real(wp) function check_balance(fem, f, contact) result(worst)
      type(fem_t), intent(in) :: fem
      real(wp), intent(in) :: f(:, :), contact(:, :) !< (2, n_nodes) [F]
      real(wp), allocatable :: sums(:, :)            !< work and size of the forces, of each run of nodes
      real(wp) :: total(2)
      integer(ip) :: b, j, run, n

      worst = 0.0_wp
      do b = 1, fem%bodies%n
         n = size(fem%bodies%list(b)%nodes, kind=ip)
         allocate (sums(2, run_count(n)))
         do j = 1, size(fem%bodies%list(b)%modes, 2, kind=ip)
            !$omp parallel do schedule(static) if (is_shared(n))
            do run = 1, run_count(n)
               call add_work(fem, fem%bodies%list(b), j, run, f, contact, sums(:, run))
            end do
            !$omp end parallel do
            total = sum(sums, dim=2)
            if (total(2) > 0.0_wp) worst = max(worst, abs(total(1))/total(2))
         end do
         deallocate (sums)
      end do
   end function check_balance

   !> The work of the forces on one run of a body's nodes in a rigid motion, and their size.
   pure subroutine add_work(fem, body, j, run, f, contact, sums)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      integer(ip), intent(in) :: j, run
      real(wp), intent(in) :: f(:, :), contact(:, :)
      real(wp), intent(out) :: sums(2)
      integer(ip) :: first, last, i, dof, node

      sums = 0.0_wp
      call find_run(run, size(body%nodes, kind=ip), first, last)
      do i = first, last
         node = body%nodes(i)
         do dof = 1, 2
            if (fem%bodies%equation(dof, node) == 0) cycle
            if (f(dof, node) == 0.0_wp .and. contact(dof, node) == 0.0_wp) cycle
            sums(1) = sums(1) + mode_at(body, body%modes(:, j), fem%mesh%x(:, node), dof)*(f(dof, node) - contact(dof, node))
            sums(2) = sums(2) + (abs(f(dof, node)) + abs(contact(dof, node)))
         end do
      end do
   end subroutine add_work

   !> Signs, complementarity, friction bound and direction at every point, with the final displacements. Sets results%law_holds
   !> and, where a converged solution breaks it, the verdict.
   subroutine check_law(rows, line, tolerance, results)
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: tolerance          !< that the outer loop stopped at
      type(results_t), intent(inout) :: results
      real(wp) :: p(line%n), gap(line%n), slip(line%n), t(line%n), tau(line%n)
      real(wp) :: pressure_scale, place_scale
      integer(ip) :: j
      character(len=:), allocatable :: wrong

      if (line%n == 0) return
      call gather_fields(results, p, gap, slip, t)
      if (.not. all(ieee_is_finite([p, gap, slip, t]))) then
         results%law_holds = .false.
         results%verdict = 'the solution holds what is not a number'
         return
      end if
      tau = line%law%nu*apply_average(line%average, p)
      pressure_scale = maxval(p)
      place_scale = max(maxval(abs(results%u)), maxval(abs(rows%gap)), maxval(abs(gap)))
      do j = 1, line%n
         wrong = ''
         call judge_place(rows, results, j, gap(j), slip(j), place_scale, line%tangential(j) > 0, wrong)
         call judge_normal(p(j), gap(j), line%delta(j), pressure_scale, place_scale, wrong)
         call judge_friction(line, j, t(j), tau(j), slip(j), maxval(tau), place_scale, tolerance, wrong)
         if (len(wrong) == 0) cycle
         results%law_holds = .false.
         if (.not. results%converged) return
         results%verdict = 'the contact law does not hold at x = ('//to_text(point_x(results, j, 1_ip))//', ' &
                           //to_text(point_x(results, j, 2_ip))//'): '//wrong
         return
      end do
   end subroutine check_law

   pure subroutine gather_fields(results, p, gap, slip, t)
      type(results_t), intent(in) :: results
      real(wp), intent(out) :: p(:), gap(:), slip(:), t(:)
      integer(ip) :: i, first

      first = 0
      do i = 1, size(results%contact, kind=ip)
         associate (c => results%contact(i), last => first + results%contact(i)%n)
            p(first + 1:last) = c%pressure
            gap(first + 1:last) = c%gap
            slip(first + 1:last) = c%slip
            t(first + 1:last) = -c%shear
            first = last
         end associate
      end do
   end subroutine gather_fields

   pure real(wp) function point_x(results, j, axis) result(x)
      type(results_t), intent(in) :: results
      integer(ip), intent(in) :: j, axis
      integer(ip) :: i, k

      k = j
      x = 0.0_wp
      do i = 1, size(results%contact, kind=ip)
         if (k <= results%contact(i)%n) then
            x = results%contact(i)%x(axis, k)
            return
         end if
         k = k - results%contact(i)%n
      end do
   end function point_x

   !> Gap and slip must be those of the displacement field.
   pure subroutine judge_place(rows, results, j, gap, slip, scale, has_tangential, wrong)
      type(contact_rows_t), intent(in) :: rows
      type(results_t), intent(in) :: results
      integer(ip), intent(in) :: j
      real(wp), intent(in) :: gap, slip, scale
      logical, intent(in) :: has_tangential
      character(len=:), allocatable, intent(inout) :: wrong

      if (abs(rows%gap(j) - row_value(rows, j, rows%normal(:, j), results%u) - gap) > PLACE_TOLERANCE*scale) then
         wrong = 'the gap is not that of the displacements'
      end if
      if (.not. has_tangential) return
      if (abs(row_value(rows, j, rows%tangent(:, j), results%u) - slip) > PLACE_TOLERANCE*scale) then
         wrong = 'the slip is not that of the displacements'
      end if
   end subroutine judge_place

   pure subroutine judge_normal(p, gap, delta, pressure_scale, place_scale, wrong)
      real(wp), intent(in) :: p, gap, delta, pressure_scale, place_scale
      character(len=:), allocatable, intent(inout) :: wrong

      if (len(wrong) > 0) return
      if (p < 0.0_wp) wrong = 'tension '//to_text(p)
      if (p > 0.0_wp .and. abs(gap + delta*p) > SIGN_TOLERANCE*max(place_scale, delta*pressure_scale)) then
         wrong = 'pressure '//to_text(p)//' at gap '//to_text(gap)
      end if
      if (p == 0.0_wp .and. gap < -SIGN_TOLERANCE*place_scale) wrong = 'penetration '//to_text(-gap)//' without pressure'
   end subroutine judge_normal

   pure subroutine judge_friction(line, j, t, tau, slip, tau_scale, place_scale, tolerance, wrong)
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: j
      real(wp), intent(in) :: t, tau, slip, tau_scale, place_scale, tolerance
      character(len=:), allocatable, intent(inout) :: wrong
      real(wp) :: allowed, limit

      if (len(wrong) > 0) return
      if (line%law(j)%kind == FRICTION_NONE) then
         if (t /= 0.0_wp) wrong = 'shear without friction'
         return
      end if
      allowed = 10*tolerance*tau_scale
      limit = sticking_slip(line%law(j), tau)
      if (abs(t) > tau + allowed) wrong = 'shear '//to_text(abs(t))//' beyond the friction bound '//to_text(tau)
      if (abs(slip) > limit*(1 + 10*tolerance) + SIGN_TOLERANCE*place_scale) then
         if (abs(t - sign(tau, slip)) > allowed) wrong = 'slip without full friction against it'
      else if (limit > SIGN_TOLERANCE*place_scale) then
         ! the law is steep here: compare the stress within what the slip leaves open
         if (abs(t - friction_stress(line%law(j), tau, slip)) > allowed + tau*(SIGN_TOLERANCE*place_scale/limit)) then
            wrong = 'shear off the friction law'
         end if
      end if
   end subroutine judge_friction

end module atrito_final_check
