!> The condensed form: one increment by the method of E. B. Pires and P. Providencia e Costa (1991).
!>
!> Elastic bodies meet at a contact line. There p >= 0 is the pressure and t the shear, and the law of friction of J. T. Oden and
!> E. B. Pires bounds |t| by nu S_rho(p), the coefficient times the pressure weighted over a length rho.
!>
!>     1. Each body is condensed onto its contact dofs: the interior is eliminated, and what is left is the flexibility F of the
!>        contact dofs and what the loads move them by (atrito_condensed_body; those of the increment before serve again,
!>        atrito_body_cache).
!>     2. The unknowns are the forces q at the points and the amplitudes a of rigid motions. The bodies sum up to
!>            r = g0 - (C + D) q + G a,   G' q = h,   C = B F B',  G = B Z                      (atrito_contact_problem)
!>     3. With the bound frozen at tau this is a quadratic problem with bounds on q, |q_t| <= w tau, q_n >= 0, which has one
!>        solution (atrito_frozen_bound, by active sets).
!>     4. The Picard loop tau <- nu S_rho(p(tau)) is the fixed point of the existence proof; an accelerator makes it faster
!>        (atrito_outer_loop, atrito_picard_loop).
!>     5. u = u_e + Z a: the contact dofs follow from q, the interior from them (atrito_displacements).
!>
!> What the state of an unknown force means (atrito_bound_qp):
!>
!>                  normal force                     tangential force
!>     FREE         closed, r = 0                    sticking, r = 0: the slip is D q
!>     AT_LOWER     open, q = 0, r = -gap            slipping against T, q = -w tau
!>     AT_UPPER     -                                slipping along T, q = w tau
!>     FROZEN       -                                no friction bound: q = 0, whatever the slip
!>
!> The files of this room in the order in which a reader of the paper meets them: condensed_body (S and F), contact_problem (C, G,
!> g0, h), frozen_bound (the QP with tau frozen), active_set and free_set (how it is solved), picard_loop and accelerator (the
!> loop), displacements (back to the bodies). goldfarb_idnani, proximal and least_forces are for where full steps do not end or
!> forces are not unique; coarse_line and dual_preconditioner make long lines fast; newton and outer_loop are other ways into the
!> loop.
!>
!> Where rows of B depend on each other forces are not unique: the proximal method finds some, and the least of them are given
!> (atrito_proximal, atrito_least_forces). Where elements that are almost equal share one stiffness, the solution is refined with
!> the stiffness of each (atrito_solution_refinement).
!>
!> Cost: the factors of the bodies, m^2 numbers of C for m contact forces, and m^3/3 operations for each linear solve of the QP.
module atrito_solve_condensed
   use atrito_base_loads, only: load_bodies
   use atrito_body_cache, only: body_cache_t, provide_bodies, reload_bodies, release_bodies, forget_loads
   use atrito_bound_qp, only: bound_qp_t, DEPENDENT_POINTS
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_form, only: CONTACT_DENSE
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_problem, only: build_flexibility, set_right_hand_sides
   use atrito_contact_solution, only: contact_solution_t, serves_as_start, asks_no_force, let_rest
   use atrito_controls, only: controls_t, METHOD_ANDERSON
   use atrito_displacements, only: contact_forces, elastic_displacements
   use atrito_free_set, only: row_round_off
   use atrito_kinds, only: ip, wp
   use atrito_outer_loop, only: solve_contact_line, continue_contact_line
   use atrito_problem, only: problem_t, free_load
   use atrito_solution_refinement, only: refine_solution
   use atrito_reporter, only: report_progress
   use atrito_results, only: body_result_t, scene_t
   use atrito_row_entries, only: build_constraint_rows
   use atrito_solve_history, only: restart_history
   use atrito_status, only: status_t, set_status, is_ok, STATUS_SINGULAR
   use atrito_strings, only: to_text
   use atrito_timers, only: start_phase, stop_phase
   implicit none (type, external)
   private
   public :: solve_condensed, expand_solution, release_condensed

contains

   !> Solves one increment. Bodies, C and G that an increment before left in `store` and `problem` serve again; the caller gives
   !> them back (release_condensed).
   !> status: STATUS_SINGULAR of provide_bodies, with FREE_MOTION, or with rows that depend on each other. solution%converged tells
   !> whether the loop came to its end.
   !>
   !> The steps stand in the order of the header above. In a history amplitudes a count from where the bodies were in the increment
   !> before: g0 gets G a_last, and a_last is added again in the end. So a motion that nothing determines is none, and digits are
   !> those of what has changed.
   subroutine solve_condensed(problem, controls, store, scene, solution, u, status)
      class(problem_t), intent(inout) :: problem !< the increment
      type(controls_t), intent(in) :: controls !< method, tolerance, MAXIT
      type(body_cache_t), intent(inout) :: store !< the factored bodies
      type(scene_t), intent(inout) :: scene                 !< learns how the bodies were factored
      type(contact_solution_t), intent(out) :: solution !< states, forces, stresses, verdict
      real(wp), allocatable, intent(out) :: u(:, :)         !< displacements without rigid motions, (2, n_nodes) [L]
      type(status_t), intent(out) :: status                 !< STATUS_SINGULAR; not converging is told by solution%converged
      type(bound_qp_t), allocatable :: qp
      type(constraint_rows_t) :: b
      integer(ip) :: factorisations, i

      call condense_bodies(problem, store, scene%bodies, factorisations, status)
      solution%factorisations = factorisations
      if (.not. is_ok(status)) return
      scene%near_elements = any(store%bodies%is_near)
      call start_phase('iterate')
      call build_constraint_rows(problem%fem, problem%rows, problem%line, .false., b)
      call move_alloc(problem%flexibility, qp)
      if (.not. allocated(qp)) then
         allocate (qp)
         call build_flexibility(problem%fem, store%bodies, b, problem%rows, problem%line, qp)
      end if
      call set_right_hand_sides(problem%fem, store%bodies, b, problem%rows, problem%line, problem%value, problem%f, qp)
      if (has_position(problem, qp%h)) qp%g0 = qp%g0 + matmul(qp%g, problem%last%state%a)
      qp%is_coarse = controls%is_coarse
      qp%is_logged = controls%logs_solves
      call solve_line(problem, controls, qp, b, solution, status)
      call stop_phase('iterate')
      if (.not. is_ok(status)) call explain_failure(problem, qp, solution, status)
      if (allocated(solution%p)) then
         solution%round_off = [(row_round_off(qp, solution%state, i), i=1, qp%m)]
         solution%flexibility = [(qp%c(i, i), i=1, qp%m)]
      end if
      call move_alloc(qp, problem%flexibility)
      if (allocated(solution%p)) call expand_solution(problem, controls, store, scene, solution, u)
      solution%factorisations = factorisations
   end subroutine solve_condensed

   !> From a solution of the line to the bodies: displacements without rigid motions, refined where elements are near, and
   !> amplitudes that count from no load.
   subroutine expand_solution(problem, controls, store, scene, solution, u)
      class(problem_t), intent(inout) :: problem !< the increment, with C and G
      type(controls_t), intent(in) :: controls !< method, tolerance, MAXIT
      type(body_cache_t), intent(inout) :: store !< the factored bodies
      type(scene_t), intent(in) :: scene         !< whose near_elements asks for refinement
      type(contact_solution_t), intent(inout) :: solution !< with forces
      real(wp), allocatable, intent(out) :: u(:, :)         !< displacements without rigid motions, (2, n_nodes) [L]
      type(constraint_rows_t) :: b

      call expand_bodies(problem, store, solution, u)
      if (solution%converged .and. scene%near_elements) then
         call start_phase('refine')
         call build_constraint_rows(problem%fem, problem%rows, problem%line, .false., b)
         call refine_solution(problem, controls, store%bodies, b, problem%flexibility, solution, u)
         call stop_phase('refine')
      end if
      if (has_position(problem, solution%state%a)) solution%state%a = solution%state%a + problem%last%state%a
   end subroutine expand_solution

   !> Gives back the memory of C and G, and of the bodies unless they are kept for a next run: the stresses want it.
   subroutine release_condensed(problem, store)
      class(problem_t), intent(inout) :: problem !< the increment
      type(body_cache_t), intent(inout) :: store !< the factored bodies

      if (allocated(problem%flexibility)) deallocate (problem%flexibility)
      call release_bodies(store)
   end subroutine release_condensed

   !> Whether it is known where the bodies were in the increment before: amplitudes count from there, so that a motion that nothing
   !> determines is none.
   pure logical function has_position(problem, a)
      class(problem_t), intent(in) :: problem               !< the increment
      real(wp), intent(in) :: a(:)                          !< amplitudes of the rigid motions [L]

      has_position = serves_as_start(problem%last, CONTACT_DENSE)
      if (has_position) has_position = allocated(problem%last%state%a)
      if (has_position) has_position = size(problem%last%state%a) == size(a)
   end function has_position

   !> The bodies with the loads of the increment; those that C and G were made of stay as they are factored.
   !>
   !> C and G belong to the factors. While they are there the bodies are, too, and only their loads are new: as a sum of the bases
   !> of the step (atrito_base_loads) where there are some, else by a forward substitution.
   subroutine condense_bodies(problem, store, bodies, factorisations, status)
      class(problem_t), intent(inout) :: problem
      type(body_cache_t), intent(inout) :: store
      type(body_result_t), intent(inout) :: bodies(:)       !< how each was factored
      integer(ip), intent(out) :: factorisations
      type(status_t), intent(out) :: status

      factorisations = 0
      store%reporter = problem%reporter
      if (allocated(problem%flexibility) .and. allocated(store%bodies)) then
         if (.not. allocated(problem%bases)) call reload_bodies(store, problem%fem, free_load(problem))
      else
         if (allocated(problem%flexibility)) deallocate (problem%flexibility)
         if (allocated(problem%bases)) then                 ! their reduced loads are those of other factors
            if (allocated(problem%bases%reduced)) deallocate (problem%bases%reduced)
         end if
         call provide_bodies(store, problem%fem, problem%held, problem%points, free_load(problem), problem%solver_kind, bodies, &
                             status, problem%bilateral)
         factorisations = store%factorisations
      end if
      if (.not. is_ok(status) .or. .not. allocated(problem%bases)) return
      call start_phase('factor')
      call load_bodies(problem%fem, problem%bases, store%bodies)
      call forget_loads(store)
      call stop_phase('factor')
   end subroutine condense_bodies

   !> Solves the contact line: from the increment before, where that leads to a solution, else from the usual start.
   !>
   !> 1. Where no contact force is asked for, without overlap and load on rigid motions, there is nothing to solve. 2. From the
   !> increment before, by ANDERSON; a rung of the ladder begins anew, since what led nowhere began there. 3. From the usual start.
   !> Rows that depend on each other show when C + D is factored; then once more with the rows, which tells
   !>    solve_with_bound to take the proximal method.
   subroutine solve_line(problem, controls, qp, b, solution, status)
      class(problem_t), intent(in) :: problem
      type(controls_t), intent(in) :: controls
      type(bound_qp_t), intent(in) :: qp
      type(constraint_rows_t), intent(in) :: b              !< of the unknowns over displacements
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(contact_solution_t) :: nothing
      type(status_t) :: fine

      ! nothing drives a body, and nothing overlaps
      if (serves_as_start(problem%last, CONTACT_DENSE)) nothing = problem%last
      if (all(qp%h == 0.0_wp) .and. asks_no_force(problem%line, qp, qp%g0, nothing)) then
         call let_rest(problem%line, qp, qp%g0, solution)
         return
      end if
      nothing = contact_solution_t()
      if (serves_as_start(problem%last, CONTACT_DENSE) .and. controls%method == METHOD_ANDERSON .and. .not. controls%is_rung) then
         solution = problem%last
         if (has_position(problem, qp%h)) solution%state%a = 0.0_wp
         call restart_history(solution%history)
         call continue_contact_line(qp, problem%line, controls, problem%reporter, solution, status)
         if (is_ok(status) .and. solution%converged) return
         call report_progress(problem%reporter, 'not from the increment before; from the usual start')
         solution = nothing
         status = fine
      end if
      if (gives_way_nowhere(qp, problem%line)) then
         call set_status(status, STATUS_SINGULAR, DEPENDENT_POINTS)
      else
         call solve_contact_line(qp, problem%line, controls, problem%reporter, solution, status)
      end if
      if (is_ok(status)) return
      if (status%text /= DEPENDENT_POINTS) return
      call report_progress(problem%reporter, 'contact points depend on each other; the proximal method')
      call solve_contact_line(qp, problem%line, controls, problem%reporter, solution, status, b)
   end subroutine solve_line

   !> Whether a force displaces nothing but rigid surfaces, and its law does not give way: a held node faces one that moves, an
   !> equation joins two of them.
   !>
   !> C_ii = 0: the row has no flexibility, and without a compliance of its law either M has a zero on its diagonal.
   pure logical function gives_way_nowhere(qp, line) result(nowhere)
      type(bound_qp_t), intent(in) :: qp
      type(contact_line_t), intent(in) :: line
      integer(ip) :: i

      nowhere = .false.
      do i = 1, qp%m
         if (qp%c(i, i) > 0.0_wp) cycle
         nowhere = nowhere .or. i > qp%n_normal .or. .not. line%delta(line%point(i)) > 0.0_wp
      end do
   end function gives_way_nowhere

   !> Puts a failure of the contact line into words.
   subroutine explain_failure(problem, qp, solution, status)
      class(problem_t), intent(in) :: problem
      type(bound_qp_t), intent(in) :: qp
      type(contact_solution_t), intent(in) :: solution
      type(status_t), intent(inout) :: status
      integer(ip) :: node

      if (status%text /= DEPENDENT_POINTS) return
      node = problem%rows%node(problem%rows%first(problem%line%point(solution%inner%dependent)))
      call set_status(status, STATUS_SINGULAR, 'the contact point at node '//to_text(problem%fem%mesh%node_id(node)) &
                      //trim(merge(' (normal)    ', ' (tangential)', solution%inner%dependent <= qp%n_normal)) &
                      //' repeats what other points ask: two pairs share it, or the slave is finer than its own dofs')
   end subroutine explain_failure

   !> The displacements of all bodies without their rigid motions.
   subroutine expand_bodies(problem, store, solution, u)
      class(problem_t), intent(in) :: problem
      type(body_cache_t), intent(in) :: store
      type(contact_solution_t), intent(in) :: solution
      real(wp), allocatable, intent(out) :: u(:, :)
      real(wp), allocatable :: contact(:, :)
      integer(ip) :: b

      call start_phase('recover')
      contact = contact_forces(problem%fem, problem%rows, problem%line, solution)
      u = problem%value
      do b = 1, problem%fem%bodies%n
         call elastic_displacements(problem%fem, b, store%bodies(b), contact, u)
      end do
      call stop_phase('recover')
   end subroutine expand_bodies

end module atrito_solve_condensed
