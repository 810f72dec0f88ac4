!> Puts a solution of the condensed form right where elements that are near have one stiffness (atrito_assembly).
!>
!> The bodies were factored with K~ in place of K. With the forces q and the displacements u that were found with it,
!>
!>     r = f - B' q - K u                 by the stiffnesses of the elements themselves,
!>     g0 <- g0 + B K~^-1 r               the contact line is solved again, from its solution: q + dq,
!>     u <- u + K~^-1 (r - B' dq),
!>
!> which leaves K~^-1 (K~ - K) times the error. Where a body floats K~^-1 is the inverse of atrito_condensed_body; r is in balance.
module atrito_solution_refinement
   use atrito_bound_qp, only: bound_qp_t
   use atrito_condensed_body, only: condensed_body_t, set_load
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_problem, only: add_displacements
   use atrito_contact_solution, only: contact_solution_t
   use atrito_controls, only: controls_t
   use atrito_displacements, only: contact_forces, elastic_displacements
   use atrito_internal_forces, only: internal_forces
   use atrito_kinds, only: ip, wp, HUGE_REAL
   use atrito_outer_loop, only: continue_contact_line
   use atrito_problem, only: problem_t
   use atrito_reporter, only: report_progress
   use atrito_status, only: status_t, is_ok
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: refine_solution

   !> The reduced load of a body, put aside.
   type :: load_t
      real(wp), allocatable :: reduced(:, :) !< (n, 1) as condensed_body_t%load
   end type load_t

   !> What is refined, and how far off it is: (2, n_nodes).
   type :: state_t
      real(wp), allocatable :: u(:, :)                    !< displacements without rigid motions [L]
      real(wp), allocatable :: contact(:, :)              !< B'q of the solution [F]
      real(wp), allocatable :: residual(:, :)             !< f - B'q - K u [F]
   end type state_t

   integer(ip), parameter :: MOST_STEPS = 4_ip
   !> A residual of this share of the largest force is round-off.
   real(wp), parameter :: ENOUGH = 1.0e-13_wp
   !> With more than this share before the first step, slenderness makes too much of the digits.
   real(wp), parameter :: TOO_MUCH = 1.0e-4_wp
   !> A step that leaves more than this of a residual has come to round-off.
   real(wp), parameter :: FALLS = 0.1_wp

contains

   !> Refines as often as it takes. Where that does not lead to a solution, the one that was there is none either:
   !> solution%converged is false.
   !>
   !> The residual is one pass over the elements with their own stiffnesses. Each step leaves K~^-1 (K~ - K) of the error, some 1e-6
   !> to 1e-9 where near elements are near, so one or two steps do. A body that is so slender that the last digits of its nodes
   !> matter makes more than TOO_MUCH of them: then K~ is no approximation of K.
   subroutine refine_solution(problem, controls, bodies, rows, qp, solution, u)
      class(problem_t), intent(in) :: problem !< the increment
      type(controls_t), intent(in) :: controls !< method, tolerance, MAXIT
      type(condensed_body_t), intent(inout) :: bodies(:)  !< as they were, on return
      type(constraint_rows_t), intent(in) :: rows       !< of the unknowns over displacements
      type(bound_qp_t), intent(inout) :: qp             !< C and G; its g0 becomes what the residuals move the points by
      type(contact_solution_t), intent(inout) :: solution !< converged
      real(wp), intent(inout) :: u(:, :)                  !< without rigid motions, (2, n_nodes) [L]
      type(load_t) :: loads(size(bodies))
      type(status_t) :: status
      type(state_t) :: now
      real(wp) :: share, last_share
      logical :: is_right
      integer(ip) :: step, b

      do b = 1, size(bodies, kind=ip)
         call move_alloc(bodies(b)%load, loads(b)%reduced)
      end do
      now%u = u
      now%contact = contact_forces(problem%fem, problem%rows, problem%line, solution)
      last_share = HUGE_REAL
      do step = 1, MOST_STEPS
         ! r = f - B'q - K u, and its share of the largest force
         call find_residual(problem, now, share)
         is_right = share <= TOO_MUCH
         if (.not. is_right .or. share <= ENOUGH .or. share > FALLS*last_share) exit
         call report_progress(problem%reporter, 'refine  residual '//to_text(share, 3)//' by the last digits of the nodes')
         call correct(status)
         is_right = is_ok(status) .and. solution%converged
         if (.not. is_right .or. share**2 <= ENOUGH) exit ! the next one will be no more than round-off
         last_share = share
      end do
      u = now%u
      if (.not. is_right) then
         solution%converged = .false.
         solution%verdict = 'refinement does not converge'
      end if
      do b = 1, size(bodies, kind=ip)
         call move_alloc(loads(b)%reduced, bodies(b)%load)
      end do

   contains

      !> One step.
      !>
      !> The loads of the bodies become the residuals, g0 gets what they move the points by, the line is solved again from its
      !> solution, and the displacements change by F (r - B' dq).
      subroutine correct(status)
         type(status_t), intent(out) :: status
         real(wp), allocatable :: change(:, :), moved(:, :)
         integer(ip) :: b

         do b = 1, size(bodies, kind=ip)
            if (problem%fem%bodies%list(b)%is_rigid) cycle
            call set_load(problem%fem, b, now%residual, bodies(b))
         end do
         call add_displacements(problem%fem, bodies, rows, qp%g0)
         call continue_contact_line(qp, problem%line, controls, problem%reporter, solution, status)
         if (.not. is_ok(status)) return
         change = -now%contact
         now%contact = contact_forces(problem%fem, problem%rows, problem%line, solution)
         change = change + now%contact
         allocate (moved, mold=now%u)
         moved = 0.0_wp
         do b = 1, size(bodies, kind=ip)
            call elastic_displacements(problem%fem, b, bodies(b), change, moved)
         end do
         now%u = now%u + moved
      end subroutine correct

   end subroutine refine_solution

   !> f - B'q - K u at the free dofs, 0 at the others; and its largest entry over the largest force.
   !>
   !> By the stiffness of each element, at the price of a pass over the mesh; reactions count as forces, not as residuals.
   subroutine find_residual(problem, now, share)
      class(problem_t), intent(in) :: problem
      type(state_t), intent(inout) :: now
      real(wp), intent(out) :: share
      real(wp) :: energy, largest
      integer(ip) :: node, dof

      if (.not. allocated(now%residual)) allocate (now%residual, mold=now%u)
      now%residual = 0.0_wp
      energy = 0.0_wp
      call internal_forces(problem%fem, now%u, now%residual, energy)
      share = 0.0_wp
      largest = 0.0_wp
      if (allocated(problem%thermal)) then
         now%residual = now%residual - problem%thermal
         largest = maxval(abs(problem%thermal))
      end if
      do node = 1, size(now%u, 2, kind=ip)
         do dof = 1, 2
            associate (r => now%residual(dof, node), contact => now%contact(dof, node))
               r = problem%f(dof, node) - contact - r
               largest = max(largest, abs(problem%f(dof, node)), abs(contact))
               if (problem%held(dof, node)) then
                  largest = max(largest, abs(r))
                  r = 0.0_wp
               else
                  share = max(share, abs(r))
               end if
            end associate
         end do
      end do
      share = share/max(largest, tiny(largest))
   end subroutine find_residual

end module atrito_solution_refinement
