!> Points that share what they ask: rows of the constraints that depend on each other, so that their forces are not unique.
module atrito_shared_points
   use atrito_assembly, only: fem_t
   use atrito_bound_qp, only: bound_qp_t, DEPENDENT_POINTS
   use atrito_constraint_rows, only: constraint_rows_t
   use atrito_contact_line, only: contact_line_t
   use atrito_contact_rows, only: contact_rows_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_controls, only: controls_t
   use atrito_kinds, only: ip
   use atrito_mesh, only: mesh_t
   use atrito_messages, only: add_note
   use atrito_outer_loop, only: solve_contact_line
   use atrito_reporter, only: reporter_t, report_progress
   use atrito_row_entries, only: build_constraint_rows
   use atrito_status, only: status_t, STATUS_SINGULAR
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: has_dependent_points, solve_shared_points, note_shared_points

   integer(ip), parameter :: MOST_NAMED = 5        !< nodes in the note

contains

   !> Whether a line was not solved since rows of it depend on each other: then solve_shared_points can.
   pure logical function has_dependent_points(status)
      type(status_t), intent(in) :: status

      has_dependent_points = status%code == STATUS_SINGULAR
      if (has_dependent_points) has_dependent_points = status%text == DEPENDENT_POINTS
   end function has_dependent_points

   !> Solves a line again whose rows depend on each other. status: as of solve_contact_line.
   subroutine solve_shared_points(problem, fem, rows, line, controls, reporter, solution, status)
      type(bound_qp_t), intent(in) :: problem
      type(fem_t), intent(in) :: fem
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(controls_t), intent(in) :: controls
      type(reporter_t), intent(in) :: reporter
      type(contact_solution_t), intent(out) :: solution
      type(status_t), intent(out) :: status
      type(constraint_rows_t) :: constraints

      call report_progress(reporter, 'contact points depend on each other; the proximal method')
      call build_constraint_rows(fem, rows, line, .false., constraints)
      call solve_contact_line(problem, line, controls, reporter, solution, status, constraints)
   end subroutine solve_shared_points

   !> Names the points whose own force is not unique.
   subroutine note_shared_points(mesh, rows, line, solution)
      type(mesh_t), intent(in) :: mesh
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(in) :: solution
      logical :: is_shared(line%n)
      integer(ip), allocatable :: nodes(:)
      integer(ip) :: j

      if (.not. allocated(solution%is_shared)) return
      is_shared = .false.
      do j = 1, line%n
         if (line%normal(j) > 0) is_shared(j) = solution%is_shared(line%normal(j))
         if (line%tangential(j) > 0) is_shared(j) = is_shared(j) .or. solution%is_shared(line%tangential(j))
      end do
      nodes = mesh%node_id(rows%node(rows%first(pack([(j, j=1, line%n)], is_shared))))
      if (size(nodes) == 0) return
      call add_note('N-SHARED', shared_text(merge('points and joints', 'contact points   ', line%n_bilateral > 0), &
                                            size(nodes, kind=ip), each_once(nodes)) &
                    //'; displacements and sums of the forces are, and of the forces the least are given')
   end subroutine note_shared_points

   !> Without those that were there before: two pairs may have their point at one node.
   pure function each_once(nodes) result(once)
      integer(ip), intent(in) :: nodes(:)
      integer(ip), allocatable :: once(:)
      integer(ip) :: i

      once = nodes(:0)
      do i = 1, size(nodes, kind=ip)
         if (.not. any(once == nodes(i))) once = [once, nodes(i)]
         if (size(once) > MOST_NAMED) return
      end do
   end function each_once

   function shared_text(things, n, nodes) result(text)
      character(len=*), intent(in) :: things
      integer(ip), intent(in) :: n                   !< points
      integer(ip), intent(in) :: nodes(:)            !< the first ones and one more
      character(len=:), allocatable :: text
      integer(ip) :: i

      text = trim(things)//' share what they ask, so that the force of '//to_text(n) &
             //trim(merge(' points', ' point ', n > 1))//' is not unique: '// &
             trim(merge('nodes', 'node ', size(nodes) > 1))//' '//to_text(nodes(1))
      do i = 2, min(size(nodes, kind=ip), MOST_NAMED)
         text = text//', '//to_text(nodes(i))
      end do
      if (size(nodes) > MOST_NAMED) text = text//', ...'
   end function shared_text

end module atrito_shared_points
