!> The check at the end of every run, made afresh from the displacements and the stresses that are written: equilibrium of the
!> full bodies, balance of the forces on them, and the contact law at every point.
module atrito_final_check
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_assembly, only: fem_t
   use atrito_bodies, only: body_t, mode_at
   use atrito_contact_line, only: contact_line_t, last_of_pair, rest_of, slip_noise, friction_bound
   use atrito_contact_rows, only: contact_rows_t, row_value, bodies_of_row
   use atrito_contact_scales, only: contact_scales_t, had_t, measure_places, add_round_off, printed_as_none, usual_growth, &
                                    had_motion, had_force, force_round_off, NONE_OF_HAD
   use atrito_friction_law, only: friction_stress, sticking_slip, FRICTION_NONE
   use atrito_internal_forces, only: internal_forces, internal_force_sizes
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_results, only: results_t
   use atrito_strings, only: to_text
   use atrito_threads, only: is_shared, chunk_count, find_chunk
   use atrito_weak_forces, only: contact_sizes_t, forces_of_bodies, motion_round_off, weak_parts_hold
   implicit none (type, external)
   private
   public :: check_equilibrium, check_balance, check_law, equilibrium_t

   !> The outcome for the full bodies.
   type :: equilibrium_t
      real(wp) :: residual = 0.0_wp            !< max-norm of the free rows of K u_e + B'q - f [F]
      real(wp) :: largest_force = 0.0_wp       !< largest nodal force, applied, contact or reaction [F]
      real(wp) :: energy = 0.0_wp              !< strain energy [F L]
      logical :: holds = .false.               !< the residual is small, and all is finite
      logical :: has_forces = .true.           !< that are more than round-off
   end type equilibrium_t

   !> What one run of nodes contributes to it.
   type :: extremes_t
      real(wp) :: residual = 0.0_wp, largest_force = 0.0_wp !< of its nodes [F]
      logical :: finite = .true.                            !< nothing is nan or infinite
   end type extremes_t

   real(wp), parameter :: FORCE_TOLERANCE = 1.0e-7_wp    !< of the largest nodal force
   real(wp), parameter :: ROUND_OFFS = 100.0_wp          !< times eps |K||u_e|
   real(wp), parameter :: BALANCE_TOLERANCE = 1.0e-8_wp  !< of the sum of the forces on a body
   real(wp), parameter :: ROW_TOLERANCE = 1.0e-9_wp      !< of what a bilateral row asks for
   real(wp), parameter :: ROUND_OFF_BESIDE = 1.0e-14_wp  !< of the forces on a body that touches one without load

contains

   !> K u_e - f + B'q of all elements, assembled again: reactions at the prescribed dofs, residual at the free ones.
   !>
   !> The sum goes over the elements, each with its own stiffness, not over the factored or condensed matrices: what went wrong in
   !> these, in the numbering or in the points shows here. A residual passes when it is below FORCE_TOLERANCE of the largest nodal
   !> force; where it is not, it may still be round-off of large displacements of a stiff body, ROUND_OFFS eps sum |K||u_e|, or of
   !> a body that moves without strain, which is computed only then, since it costs as much as the check. Parts of a scene whose
   !> forces are small beside the largest are asked by a measure of their own (weak_parts_hold): a light body must not hide behind
   !> a heavy one.
   subroutine check_equilibrium(fem, u, f, contact, held, reaction, equilibrium, sizes, thermal)
      type(fem_t), intent(in) :: fem            !< whole scene
      real(wp), intent(in) :: u(:, :)           !< u_e, without rigid motions, (2, n_nodes) [L]
      real(wp), intent(in) :: f(:, :)           !< applied forces (2, n_nodes) [F]
      real(wp), intent(in) :: contact(:, :)     !< B'q (2, n_nodes) [F]
      logical, intent(in) :: held(:, :)         !< (2, n_nodes) dofs with a prescribed displacement
      real(wp), intent(out) :: reaction(:, :)   !< (2, n_nodes) [F]; 0 at free dofs
      type(equilibrium_t), intent(out) :: equilibrium !< energy, residual, and whether it is small
      type(contact_sizes_t), intent(in), optional :: sizes !< without it weak parts are not asked apart
      real(wp), intent(in), optional :: thermal(:, :) !< forces of the temperatures (2, n_nodes) [F]
      type(extremes_t) :: found(chunk_count(fem%mesh%n_nodes))
      real(wp) :: allowed, round_off
      integer(ip) :: run, first, last, node

      !$omp parallel do schedule(static) if (is_shared(fem%mesh%n_nodes))
      do node = 1, fem%mesh%n_nodes
         reaction(:, node) = 0.0_wp
      end do
      !$omp end parallel do
      call internal_forces(fem, u, reaction, equilibrium%energy)
      if (present(thermal)) reaction = reaction - thermal
      !$omp parallel do schedule(static) private(first, last) if (is_shared(fem%mesh%n_nodes))
      do run = 1, size(found, kind=ip)
         call find_chunk(run, fem%mesh%n_nodes, first, last)
         call split_forces(u(:, first:last), f(:, first:last), contact(:, first:last), held(:, first:last), &
                           reaction(:, first:last), found(run))
      end do
      !$omp end parallel do
      equilibrium%residual = maxval([found%residual, 0.0_wp])
      equilibrium%largest_force = maxval([found%largest_force, 0.0_wp])
      if (present(thermal)) equilibrium%largest_force = max(equilibrium%largest_force, maxval(abs(thermal)))
      allowed = FORCE_TOLERANCE*equilibrium%largest_force
      if (present(sizes)) allowed = allowed + force_round_off(sizes%had)
      ! the round-off is asked for where it matters
      if (equilibrium%residual > allowed) then
         round_off = ROUND_OFFS*EPS_MACH*largest_size(fem, u)
         if (present(sizes)) round_off = round_off + largest_size(fem, motion_round_off(fem, sizes%motion))
         allowed = allowed + round_off
         equilibrium%has_forces = equilibrium%largest_force > round_off .or. any(abs(f) > 0.0_wp)
      end if
      equilibrium%holds = equilibrium%residual <= allowed .and. all(found%finite)
      if (equilibrium%holds .and. present(sizes)) then
         if (present(thermal)) then
            equilibrium%holds = weak_parts_hold(fem, u, f + thermal, contact, held, reaction, sizes)
         else
            equilibrium%holds = weak_parts_hold(fem, u, f, contact, held, reaction, sizes)
         end if
      end if
      !$omp parallel do schedule(static) if (is_shared(fem%mesh%n_nodes))
      do node = 1, fem%mesh%n_nodes
         where (.not. held(:, node)) reaction(:, node) = 0.0_wp
      end do
      !$omp end parallel do
   end subroutine check_equilibrium

   !> From the internal forces of some nodes to reactions where they are held and residuals where they are free.
   pure subroutine split_forces(u, f, contact, held, reaction, found)
      real(wp), intent(in) :: u(:, :), f(:, :), contact(:, :)
      logical, intent(in) :: held(:, :)
      real(wp), intent(inout) :: reaction(:, :) !< internal forces in [F]; at free dofs the residual out
      type(extremes_t), intent(out) :: found
      real(wp) :: force
      integer(ip) :: i, dof

      do i = 1, size(u, 2, kind=ip)
         do dof = 1, 2
            force = reaction(dof, i) - f(dof, i) + contact(dof, i)
            reaction(dof, i) = force
            if (held(dof, i)) then
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

   !> Z'(f - B'q) of every rigid motion, relative to the forces on the body; the worst. A body without load rests: what is round-off
   !> of the forces on those that touch it, directly or by others without load, counts as none.
   !>
   !>     |Z_j'(f - B'q)| / sum over the nodes of (|f| + |B'q|)      the largest of all motions j of all bodies
   !>
   !> Z_j is the motion at the free dofs. What cancels in the sum is thereby measured by what it is the sum of. Bodies without a
   !> load of their own have forces of the others' round-off alone, which is why it is spread to them first.
   real(wp) function check_balance(fem, f, contact, rows, had, sizes) result(worst)
      type(fem_t), intent(in) :: fem                 !< its bodies, and their rigid motions
      real(wp), intent(in) :: f(:, :), contact(:, :) !< (2, n_nodes) [F]
      type(contact_rows_t), intent(in), optional :: rows !< what touches; without it nothing does
      type(had_t), intent(in), optional :: had  !< of the increments before
      type(contact_sizes_t), intent(in), optional :: sizes !< of rows that may leave nothing of each other
      real(wp) :: work(3, fem%bodies%n), size_of_work(fem%bodies%n), around(fem%bodies%n)
      logical :: is_loaded(fem%bodies%n)
      integer(ip) :: b, j

      worst = 0.0_wp
      do b = 1, fem%bodies%n
         call add_up_body(fem, fem%bodies%list(b), f, contact, work(:, b), size_of_work(b))
      end do
      if (present(sizes)) size_of_work = max(size_of_work, forces_of_bodies(fem, sizes))
      around = size_of_work
      do b = 1, fem%bodies%n
         is_loaded(b) = any(abs(f(:, fem%bodies%list(b)%nodes)) > 0.0_wp)
      end do
      if (present(rows)) call spread_to_touching(fem, rows, is_loaded, around)
      do b = 1, fem%bodies%n
         do j = 1, size(fem%bodies%list(b)%modes, 2, kind=ip)
            if (abs(work(j, b)) <= merge(0.0_wp, ROUND_OFF_BESIDE*around(b), is_loaded(b))) cycle
            if (present(had)) then
               if (abs(work(j, b)) <= NONE_OF_HAD*had_force(had, b)) cycle
            end if
            worst = max(worst, abs(work(j, b))/size_of_work(b))
         end do
      end do
   end function check_balance

   !> The work of all forces on a body in each of its motions, and the sum of their sizes.
   subroutine add_up_body(fem, body, f, contact, work, size_of_work)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      real(wp), intent(in) :: f(:, :), contact(:, :)
      real(wp), intent(out) :: work(:), size_of_work
      real(wp) :: sums(2, chunk_count(size(body%nodes, kind=ip))), total(2)
      integer(ip) :: j, run

      work = 0.0_wp
      size_of_work = 0.0_wp
      if (size(body%modes, 2) == 0) size_of_work = sum(abs(f(:, body%nodes))) + sum(abs(contact(:, body%nodes)))
      do j = 1, size(body%modes, 2, kind=ip)
         !$omp parallel do schedule(static) if (is_shared(size(body%nodes, kind=ip)))
         do run = 1, size(sums, 2, kind=ip)
            call add_work(fem, body, j, run, f, contact, sums(:, run))
         end do
         !$omp end parallel do
         total = sum(sums, dim=2)
         work(j) = total(1)
         size_of_work = total(2)
      end do
   end subroutine add_up_body

   !> The largest value of all bodies that touch, directly or by others without load, for each without load.
   !>
   !> A round goes over all rows and hands the larger value on; values only grow, and are among those there were at first, so it
   !> ends after as many rounds as there are bodies in a chain, at the most.
   subroutine spread_to_touching(fem, rows, is_loaded, values)
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      logical, intent(in) :: is_loaded(:)            !< (bodies)
      real(wp), intent(inout) :: values(:)           !< (bodies)
      real(wp) :: largest
      integer(ip) :: round, j, k
      logical :: changed

      do round = 1, size(values, kind=ip)
         changed = .false.
         do j = 1, rows%n
            associate (bodies => bodies_of_row(rows, j, fem%bodies%of_node))
               largest = maxval(values(bodies))
               do k = 1, size(bodies, kind=ip)
                  if (is_loaded(bodies(k)) .or. values(bodies(k)) >= largest) cycle
                  changed = .true.
                  values(bodies(k)) = largest
               end do
            end associate
         end do
         if (.not. changed) return
      end do
   end subroutine spread_to_touching

   !> The work of the forces on one run of a body's nodes in a rigid motion, and their size.
   pure subroutine add_work(fem, body, j, run, f, contact, sums)
      type(fem_t), intent(in) :: fem
      type(body_t), intent(in) :: body
      integer(ip), intent(in) :: j, run
      real(wp), intent(in) :: f(:, :), contact(:, :)
      real(wp), intent(out) :: sums(2)
      integer(ip) :: first, last, i, dof, node

      sums = 0.0_wp
      call find_chunk(run, size(body%nodes, kind=ip), first, last)
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
   !>
   !> With p, t, gap g and slip u_T as the results have them, tau = nu S_rho(p) of these p, and s the slip beyond the rest slip:
   !>
   !>     places      g and u_T are those of the displacements
   !>     normal      p >= 0;  g + delta p = 0 where p > 0;  g >= 0 where p = 0                    judge_normal
   !>     friction    |t| <= tau;  t = tau sign(s) where |s| is beyond what sticking lets;
   !>                 else t is what the law gives for s                                           judge_friction
   !>     bilateral   row . u = value + compliance q                                               check_bilateral_rows
   !>
   !> each within what round-off leaves open (atrito_contact_scales). States and residuals of the solver are not looked at, only
   !> fields, displacements and laws. So a point that was closed by mistake, or slips the wrong way, shows here.
   subroutine check_law(rows, line, tolerance, results, of_node, growth, had, condition, round_off)
      type(contact_rows_t), intent(in) :: rows   !< gaps and slips of the points
      type(contact_line_t), intent(in) :: line   !< laws, deltas and weights of the points
      real(wp), intent(in) :: tolerance          !< that the outer loop stopped at
      type(results_t), intent(inout) :: results  !< with the fields of its pairs; law_holds, verdict
      integer(ip), intent(in), optional :: of_node(:) !< (n_nodes) body of each; without it there is one
      real(wp), intent(in), optional :: growth(:) !< (bodies) of round-off in the displacements; without it that of small bodies
      type(had_t), intent(in), optional :: had   !< of the increments before
      real(wp), intent(in), optional :: condition !< of the equations of the contact line
      real(wp), intent(in), optional :: round_off(:) !< (unknowns) of gaps and slips, where the solver knows it [L]
      real(wp), allocatable :: uncertain(:)
      real(wp) :: p(line%n), gap(line%n), slip(line%n), t(line%n), tau(line%n), far, place, off
      type(contact_scales_t) :: scales
      integer(ip) :: j, k, last
      logical :: rows_hold
      character(len=:), allocatable :: wrong

      if (line%n == 0) return
      p = 0.0_wp                                 ! of the rows behind the points
      gap = 0.0_wp
      slip = 0.0_wp
      t = 0.0_wp
      call gather_fields(results, p, gap, slip, t)
      if (allocated(rows%allowed)) gap = gap + rows%allowed
      if (.not. all(ieee_is_finite([p, gap, slip, t]))) then
         results%law_holds = .false.
         results%verdict = 'the solution holds what is not a number'
         return
      end if
      tau = friction_bound(line, p)
      call find_uncertain_displacements(results%u, of_node, growth, had, uncertain)
      call check_bilateral_rows(rows, line, uncertain, condition, round_off, results, rows_hold)
      if (.not. rows_hold) return
      last = 0
      do j = 1, line%n - line%n_bilateral
         if (j > last) then
            last = last_of_pair(line, j)
            far = maxval([(max(abs(point_x(results, k, 1_ip)), abs(point_x(results, k, 2_ip))), k=j, last)])
            call measure_places(rows, results%u, uncertain, j, last, maxval(line%delta(j:last)*p(j:last)), far, scales)
            if (present(round_off)) call add_round_off(line, round_off, j, last, scales)
            scales%friction = maxval(tau(j:last))
         end if
         wrong = ''
         ! Gap and slip must be those of the displacement field.
         off = abs(rows%gap(j) - row_value(rows, j, rows%normal(:, j), results%u) - gap(j))
         if (off > scales%gap) wrong = 'the gap is not that of the displacements, off by '//to_text(off, 3)//', ' &
                                       //to_text(scales%gap, 3)//' allowed'
         if (line%tangential(j) > 0) then
            off = abs(row_value(rows, j, rows%tangent(:, j), results%u) - slip(j))
            if (off > scales%slip) wrong = 'the slip is not that of the displacements, off by '//to_text(off, 3)//', ' &
                                           //to_text(scales%slip, 3)//' allowed'
         end if
         ! To what the overlap of a point whose support takes its force is known [L].
         place = 0.0_wp
         if (allocated(rows%is_held)) then
            if (rows%is_held(1, j)) place = rows%doubt(j)*rows%reach(j)
         end if
         call judge_normal(p(j), gap(j), line%delta(j), scales%gap + place, wrong)
         call judge_friction(line, j, t(j), tau(j), slip(j) - rest_of(line, j), scales, tolerance, wrong)
         if (len(wrong) == 0) cycle
         results%law_holds = .false.
         if (.not. results%converged) return
         results%verdict = 'the contact law does not hold at x = ('//to_text(point_x(results, j, 1_ip))//', ' &
                           //to_text(point_x(results, j, 2_ip))//'): '//wrong
         return
      end do
   end subroutine check_law

   !> Every bilateral row with the final displacements: vector . u = value + compliance q, within what round-off leaves open.
   subroutine check_bilateral_rows(rows, line, uncertain, condition, round_off, results, holds)
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      real(wp), intent(in) :: uncertain(:)       !< (n_nodes) [L]
      real(wp), intent(in), optional :: condition !< of the equations of the rows: digits that their forces have lost (W-DIGITS)
      real(wp), intent(in), optional :: round_off(:) !< (unknowns) of the rows, where the solver knows it [L]
      type(results_t), intent(inout) :: results
      logical, intent(out) :: holds
      real(wp) :: moved, asked, allowed, q, lost
      integer(ip) :: i, j, k

      holds = .true.
      lost = 0.0_wp
      if (present(condition)) lost = min(EPS_MACH*condition, ROW_TOLERANCE)
      do i = 1, rows%n_bilateral
         j = rows%n - rows%n_bilateral + i
         q = results%row_force(i)
         asked = rows%gap(j) + line%delta(j)/line%weight(j)*q
         moved = row_value(rows, j, [0.0_wp, 0.0_wp], results%u)
         allowed = ROW_TOLERANCE*(abs(rows%gap(j)) + abs(asked))
         if (present(round_off) .and. line%normal(j) > 0) allowed = allowed + round_off(line%normal(j))
         do k = rows%first(j), rows%first(j + 1) - 1
            associate (vector => rows%vector(:, k - rows%before_vectors), node => rows%node(k))
               allowed = allowed + sum(abs(vector))*uncertain(node) + lost*sum(abs(vector*results%u(:, node)))
            end associate
         end do
         holds = abs(moved - asked) <= allowed .and. ieee_is_finite(q)
         if (holds) cycle
         results%law_holds = .false.
         if (.not. results%converged) return
         results%verdict = 'a tie, equation, support or spring at x = ('//to_text(results%row_x(1, i))//', ' &
                           //to_text(results%row_x(2, i))//') does not hold: off by '//to_text(moved - asked, 3)//', ' &
                           //to_text(allowed, 3)//' allowed'
         return
      end do
   end subroutine check_bilateral_rows

   !> What round-off may do to the displacements of the body of each node [L].
   pure subroutine find_uncertain_displacements(u, of_node, growth, had, uncertain)
      real(wp), intent(in) :: u(:, :)            !< (2, n_nodes) [L]
      integer(ip), intent(in), optional :: of_node(:)
      real(wp), intent(in), optional :: growth(:)
      type(had_t), intent(in), optional :: had
      real(wp), allocatable, intent(out) :: uncertain(:)
      real(wp), allocatable :: largest(:)
      real(wp) :: of_all
      integer(ip) :: i

      allocate (uncertain(size(u, 2)), source=usual_growth(0_ip, 0.0_wp)*EPS_MACH*maxval(abs(u)))
      if (.not. present(of_node)) return
      allocate (largest(0:maxval(of_node)), source=0.0_wp)
      do i = 1, size(u, 2, kind=ip)
         largest(of_node(i)) = max(largest(of_node(i)), maxval(abs(u(:, i))))
      end do
      of_all = maxval(largest)
      if (present(had)) largest(1:) = max(largest(1:), [(had_motion(had, i), i=1, ubound(largest, 1))])
      if (present(growth)) then
         largest(1:) = largest(1:)*growth*EPS_MACH + printed_as_none(largest(1:), of_all)
      else
         largest = usual_growth(0_ip, 0.0_wp)*EPS_MACH*largest + printed_as_none(largest, of_all)
      end if
      uncertain = largest(of_node)
   end subroutine find_uncertain_displacements

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

   !> Signorini with a penalty: p >= 0, and gap + delta p = 0 where p > 0, gap >= 0 where p = 0.
   pure subroutine judge_normal(p, gap, delta, place, wrong)
      real(wp), intent(in) :: p, gap, delta
      real(wp), intent(in) :: place              !< what is none [L]
      character(len=:), allocatable, intent(inout) :: wrong

      if (len(wrong) > 0) return
      if (p < 0.0_wp) wrong = 'tension '//to_text(p)
      if (p > 0.0_wp .and. abs(gap + delta*p) > place) wrong = 'pressure '//to_text(p)//' at gap '//to_text(gap)
      if (p == 0.0_wp .and. gap < -place) wrong = 'penetration '//to_text(-gap)//' without pressure'
   end subroutine judge_normal

   !> A point keeps its friction law: |t| is not beyond the bound tau; a point that slips by more than sticking lets it has t = tau
   !> against the slip; below that t is what the law gives for the slip. What counts as none of a stress is a part of the largest
   !> friction of the scene, of a slip the scale of slips. Where the law is steep, tau over `limit`, a slip that is uncertain by
   !> `none` leaves its stress uncertain by tau none/limit.
   pure subroutine judge_friction(line, j, t, tau, slip, scales, tolerance, wrong)
      type(contact_line_t), intent(in) :: line
      integer(ip), intent(in) :: j
      real(wp), intent(in) :: t, tau, slip, tolerance !< slip: beyond the rest slip
      type(contact_scales_t), intent(in) :: scales
      character(len=:), allocatable, intent(inout) :: wrong
      real(wp) :: allowed, limit, none

      if (len(wrong) > 0) return
      if (line%law(j)%kind == FRICTION_NONE) then
         if (t /= 0.0_wp) wrong = 'shear without friction'
         return
      end if
      allowed = 10*tolerance*scales%friction
      limit = sticking_slip(line%law(j), tau)
      none = scales%slip
      if (line%tangential(j) == 0) none = max(none, slip_noise(line, j))
      if (abs(t) > tau + allowed) wrong = 'shear '//to_text(abs(t))//' beyond the friction bound '//to_text(tau)
      if (abs(slip) > limit*(1 + 10*tolerance) + none) then
         if (abs(t - sign(tau, slip)) > allowed) wrong = 'slip without full friction against it'
      else if (limit > none) then
         ! the law is steep here: compare the stress within what the slip leaves open
         if (abs(t - friction_stress(line%law(j), tau, slip)) > allowed + tau*(none/limit)) then
            wrong = 'shear off the friction law'
         end if
      end if
   end subroutine judge_friction

end module atrito_final_check
