!> The displacements that bodies have under tractions of contact in place of the forces of contact.
!>
!> Forces of contact at nodes are not those of a pressure that the law allows: an isolated closed node has the force of a pressure
!> that is negative beside it. With q the forces of contact and q^ those of the tractions, the bodies move by K^-1 (q^ - q)
!> besides, which costs a solution with the factors that are there, and all else is a matter of given loads.
module atrito_exchanged_tractions
   use atrito_assembly, only: fem_t
   use atrito_balanced_contact, only: add_joints, add_segments, balanced_segments
   use atrito_bodies, only: bodies_t
   use atrito_condensed_body, only: condense_body, condensed_body_t, contact_response, expand_body
   use atrito_contact_segments, only: segment_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_displacements, only: contact_forces
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t
   use atrito_problem, only: problem_t
   use atrito_results, only: body_result_t
   use atrito_solver_choice, only: SOLVER_SPARSE
   use atrito_status, only: is_ok, status_t
   implicit none (type, external)
   private
   public :: exchange, exchange_with_factors

contains

   !> While the factors of the bodies are there. What can not be had is not allocated.
   subroutine exchange_with_factors(model, problem, solution, keeps, bodies, change)
      type(model_t), intent(in) :: model
      class(problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      logical, intent(in) :: keeps                  !< the resultants (balanced_segments)
      type(condensed_body_t), intent(inout) :: bodies(:)
      real(wp), allocatable, intent(out) :: change(:, :)
      type(segment_t), allocatable :: segments(:)
      real(wp), allocatable :: joints(:)
      character(len=:), allocatable :: why_not

      call balanced_segments(model, problem, solution, keeps, segments, joints, why_not)
      if (.not. allocated(why_not)) call exchange(problem, solution, segments, joints, change, why_not, bodies)
   end subroutine exchange_with_factors

   !> By factors that are there, or that are made now. why_not: a body cannot be factored.
   subroutine exchange(problem, solution, segments, joints, change, why_not, bodies)
      class(problem_t), intent(in) :: problem
      type(contact_solution_t), intent(in) :: solution
      type(segment_t), intent(in) :: segments(:)
      real(wp), intent(in) :: joints(:)             !< (bilateral rows) forces of ties [F]
      real(wp), allocatable, intent(out) :: change(:, :) !< (2, n_nodes) [L]
      character(len=:), allocatable, intent(inout) :: why_not
      type(condensed_body_t), intent(inout), optional :: bodies(:)
      real(wp), allocatable :: force(:, :)
      type(fem_t) :: fem
      type(condensed_body_t) :: body
      type(body_result_t) :: result
      type(status_t) :: status
      integer(ip) :: b

      allocate (change(2, size(problem%held, 2)), source=0.0_wp)
      if (size(segments) == 0) return
      force = contact_forces(problem%fem, problem%rows, problem%line, solution)
      call add_joints(problem, joints, -1.0_wp, force)
      call add_segments(segments, force)
      fem = problem%fem
      do b = 1, fem%bodies%n
         if (fem%bodies%list(b)%n_retained == 0) cycle
         if (present(bodies)) then
            call move_body(b, bodies(b))
            cycle
         end if
         fem%bodies%list(b)%n_retained = few_equations(fem%bodies, b)
         result = body_result_t(solver_kind=SOLVER_SPARSE)
         call condense_body(fem, b, SOLVER_SPARSE, body, result, status)
         if (.not. is_ok(status)) then
            why_not = 'the factor of a body'
            return
         end if
         call move_body(b, body)
      end do

   contains

      !> The forces act at the contact dofs, and at nodes of a master that no point faces: only where there are such is the load
      !> reduced.
      subroutine move_body(b, body)
         integer(ip), intent(in) :: b
         type(condensed_body_t), intent(inout) :: body
         real(wp), allocatable :: x(:, :), load(:, :)
         integer(ip) :: i, dof

         associate (list => fem%bodies%list(b))
            allocate (load(list%n, 1), source=0.0_wp)
            do i = 1, size(list%nodes, kind=ip)
               do dof = 1, 2
                  associate (k => fem%bodies%equation(dof, list%nodes(i)))
                     if (k > 0) load(k, 1) = force(dof, list%nodes(i))
                  end associate
               end do
            end do
            if (any(load(:list%n - list%n_retained, 1) /= 0.0_wp)) call body%solver%reduce(load)
            x = load(list%n - list%n_retained + 1:, :)
            call contact_response(body, x)
            call swap_load(body, load)
            call expand_body(fem, b, body, x(:, 1), change)
            call swap_load(body, load)
         end associate
      end subroutine move_body

      subroutine swap_load(body, load)
         type(condensed_body_t), intent(inout) :: body
         real(wp), allocatable, intent(inout) :: load(:, :)
         real(wp), allocatable :: own(:, :)

         call move_alloc(body%load, own)
         call move_alloc(load, body%load)
         call move_alloc(own, load)
      end subroutine swap_load

   end subroutine exchange

   !> Equations of the last few nodes of a body: as many as show its rigid motions, not more, since what is retained makes a full
   !> matrix.
   pure integer(ip) function few_equations(bodies, b) result(n)
      type(bodies_t), intent(in) :: bodies
      integer(ip), intent(in) :: b
      integer(ip), parameter :: ENOUGH = 8
      integer(ip) :: i

      n = 0
      do i = size(bodies%list(b)%nodes, kind=ip), 1, -1
         n = n + count(bodies%equation(:, bodies%list(b)%nodes(i)) > 0, kind=ip)
         if (n >= min(ENOUGH, bodies%list(b)%n_retained)) return
      end do
   end function few_equations

end module atrito_exchanged_tractions
