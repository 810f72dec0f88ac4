!> Which points keep a run from converging: those whose state changed in the last outer iteration, or more than once in the last
!> ones; where there is none, the one whose friction bound is off most.
module atrito_unsettled_points
   use atrito_contact_line, only: contact_line_t, friction_bound
   use atrito_contact_rows, only: contact_rows_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_kinds, only: ip
   use atrito_mesh, only: mesh_t
   use atrito_points, only: contact_points_t
   use atrito_results, only: results_t, unsettled_t
   use atrito_solve_history, only: state_letters
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: report_unsettled

   integer(ip), parameter :: MOST_NAMED = 5        !< nodes in the verdict

contains

   !> Fills results%unsettled, the most restless points first, and adds to the verdict of a run that did not converge.
   subroutine report_unsettled(mesh, points, rows, line, solution, results)
      type(mesh_t), intent(in) :: mesh                 !< as solved
      type(contact_points_t), intent(in) :: points(:)  !< of each pair
      type(contact_rows_t), intent(in) :: rows         !< nodes and normals of the points
      type(contact_line_t), intent(in) :: line         !< which point each unknown is of
      type(contact_solution_t), intent(in) :: solution !< its last states are read
      type(results_t), intent(inout) :: results        !< get unsettled, and more in the verdict
      integer(ip), allocatable :: order(:)
      integer(ip) :: i, j
      character(len=:), allocatable :: text

      if (solution%converged .or. .not. allocated(solution%history%states)) return
      order = restless_points(solution%history%states(:, :solution%history%kept))
      allocate (results%unsettled(size(order)))
      do i = 1, size(order, kind=ip)
         associate (j => line%point(order(i)), point => results%unsettled(i))
            point%pair = 1
            point%point = j
            do while (point%point > points(point%pair)%n)
               point%point = point%point - points(point%pair)%n
               point%pair = point%pair + 1
            end do
            point%node = mesh%node_id(rows%node(rows%first(j)))
            point%x = points(point%pair)%x(:, point%point)
         end associate
         results%unsettled(i)%states = state_letters(solution%history%states(order(i), :solution%history%kept))
      end do
      if (.not. allocated(results%verdict)) results%verdict = 'not converged'
      if (size(order) > 0) then
         if (size(results%unsettled) == 1) then
            text = '1 point is unsettled: node '//to_text(results%unsettled(1)%node)
         else
            text = to_text(size(results%unsettled, kind=ip))//' points are unsettled: nodes '//to_text(results%unsettled(1)%node)
            do j = 2, min(size(results%unsettled, kind=ip), MOST_NAMED)
               text = text//', '//to_text(results%unsettled(j)%node)
            end do
            if (size(results%unsettled) > MOST_NAMED) text = text//', ...'
         end if
         results%verdict = results%verdict//'; '//text
      else if (line%has_friction .and. allocated(solution%p)) then
         i = maxloc(abs(friction_bound(line, solution%p) - solution%tau), dim=1, kind=ip)
         results%verdict = results%verdict//'; no point changes its state, the friction bound is off most at node ' &
                           //to_text(mesh%node_id(rows%node(rows%first(i))))
      end if
   end subroutine report_unsettled

   !> Normal unknowns that find no rest, by the number of their changes. One that has changed once and stayed has settled.
   pure function restless_points(states) result(order)
      integer(ip), intent(in) :: states(:, :)       !< (n_normal, outer iterations)
      integer(ip), allocatable :: order(:)
      integer(ip) :: changes(size(states, 1)), i, j

      do i = 1, size(states, 1, kind=ip)
         associate (own => states(i, :), n => size(states, 2))
            changes(i) = count(own(2:) /= own(:n - 1), kind=ip)
            if (changes(i) == 1 .and. own(n) == own(max(n - 1, 1))) changes(i) = 0
         end associate
      end do
      allocate (order(0))
      do j = size(states, 2, kind=ip) - 1, 1, -1
         order = [order, pack([(i, i=1, size(changes, kind=ip))], changes == j)]
      end do
   end function restless_points

end module atrito_unsettled_points
