!> What a careful user should know of a solution, told as warnings and notes; and which points keep a run from converging: those
!> whose state changed in the last outer iteration, or more than once in the last ones; where there is none, the one whose friction
!> bound is off most.
module atrito_solution_warnings
   use atrito_blas_info, only: is_reference_blas
   use atrito_body_motions, only: find_moved_body, motion_text
   use atrito_bound_qp, only: FREE
   use atrito_condensed_body, only: hourglass_text
   use atrito_contact_line, only: contact_line_t, last_of_pair, friction_bound
   use atrito_contact_rows, only: contact_rows_t
   use atrito_contact_solution, only: contact_solution_t
   use atrito_friction_law, only: FRICTION_NONE
   use atrito_hourglass, only: worst_hourglass
   use atrito_kinds, only: ip, wp, EPS_MACH
   use atrito_linear_limits, only: warn_of_large
   use atrito_mesh, only: mesh_t
   use atrito_messages, only: add_note, add_warning
   use atrito_model, only: model_t
   use atrito_points, only: contact_points_t
   use atrito_results, only: results_t, unsettled_t
   use atrito_scene_data, only: scene_data_t
   use atrito_solve_history, only: state_letters
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: warn, idle_text, report_unsettled

   real(wp), parameter :: MANY_DIGITS = 10.0_wp             !< lost digits worth a warning
   real(wp), parameter :: MUCH_LOST = 1.0e8_wp              !< condition of the contact line worth a warning
   real(wp), parameter :: UNKNOWN_PART = 1.0e-3_wp          !< of the largest pressure or shear of a pair, worth a warning
   real(wp), parameter :: LITTLE_SHEAR = 1.0e-4_wp          !< of that pressure: shears count as this at least
   real(wp), parameter :: LARGE_FRICTION = 3.0_wp           !< from here on other solutions have been seen
   integer(ip), parameter :: MOST_NAMED = 5                 !< nodes in a note or a verdict
   real(wp), parameter :: LARGE_HOURGLASS = 1.0_wp          !< as much strain energy as is seen is not

contains

   !> What a careful user should know of a solution.
   subroutine warn(data, solution, results, idle)
      type(scene_data_t), intent(in) :: data               !< the scene as solved
      type(contact_solution_t), intent(in) :: solution     !< p, t and what was lost in its equations
      type(results_t), intent(in) :: results               !< last frame of the run
      character(len=*), intent(in) :: idle                 !< which motions nothing determines (idle_text); '': none
      integer(ip) :: b

      if (is_reference_blas()) call add_warning('W-BLAS', 'this program was linked with the reference BLAS; with OpenBLAS' &
                                                //' it is about three times as fast')
      if (len(idle) > 0) call add_warning('W-IDLE', idle//': no load does it and nothing prevents it; the least motion is given')
      do b = 1, size(results%scene%bodies, kind=ip)
         associate (body => results%scene%bodies(b))
            if (body%digits_lost > MANY_DIGITS) call add_warning('W-DIGITS', 'body '//body%name//': the pivot of node ' &
                              //to_text(body%worst_node)//' dof '//to_text(body%worst_dof)//' lost '//to_text(body%digits_lost, 3) &
                                        //' digits: a very slender or nearly incompressible body, or one that is barely held there')
         end associate
      end do
      if (solution%inner%condition > MUCH_LOST) call add_warning('W-DIGITS', 'the equations of the contact line lose ' &
                                                     //to_text(log10(solution%inner%condition), 3)//' digits of 16: a stiff slave' &
                                                                 //' with more points than its soft master has nodes, or points' &
                                                                 //' that are almost one')
      call warn_of_last_digits(data, solution, results)
      call warn_of_hourglass(data, results)
      call note_shared_points(data%fem%mesh, data%rows, data%line, solution)
      call warn_of_others(data%model, results)
      call warn_of_large(results, data%model%asks_nlgeom)
   end subroutine warn

   !> 'body BLOCK is free to move along x1', where a motion of a solution is not determined; else ''.
   function idle_text(data, solution) result(text)
      type(scene_data_t), intent(in) :: data                !< names of its bodies
      type(contact_solution_t), intent(in) :: solution      !< its undetermined motion is read
      character(len=:), allocatable :: text
      real(wp) :: mode(3)
      integer(ip) :: b

      text = ''
      if (.not. allocated(solution%inner%undetermined)) return
      call find_moved_body(data%fem%bodies, solution%inner%undetermined, b, mode)
      text = motion_text(data%fem, b, mode)
   end function idle_text

   !> Pairs whose pressures or shears hang on the last digits of coordinates. An initial distance is a difference of those, and so
   !> known to EPS_MACH of the largest, as is the slip of what turns by it; a closed, or sticking, point with a flexibility c and a
   !> compliance d takes that by a force of EPS_MACH |x|/(c + d). A distance that is none is meant as none.
   subroutine warn_of_last_digits(data, solution, results)
      type(scene_data_t), intent(in) :: data
      type(contact_solution_t), intent(in) :: solution
      type(results_t), intent(in) :: results
      character(len=*), parameter :: KINDS(2) = ['pressure', 'shear   ']
      real(wp) :: off(2), most(2), far                ! of pressures and shears
      integer(ip) :: first, last, j, k, unknown(2)

      if (.not. (allocated(solution%flexibility) .and. allocated(solution%p))) return
      if (size(solution%flexibility) /= size(data%line%point)) return
      far = maxval(abs(data%fem%mesh%x))
      first = 1
      do while (first <= data%line%n - data%line%n_bilateral)
         last = last_of_pair(data%line, first)
         off = 0.0_wp
         most = maxval(solution%p(first:last))*[1.0_wp, LITTLE_SHEAR]
         do j = first, last
            unknown = [data%line%normal(j), data%line%tangential(j)]
            if (unknown(1) == 0 .or. .not. (solution%p(j) > 0.0_wp .and. abs(data%rows%gap(j)) > 0.0_wp)) cycle
            do k = 1, merge(2, 1, unknown(2) > 0)
               associate (i => unknown(k), force => EPS_MACH*far/(solution%flexibility(unknown(k)) + solution%bounds%d(unknown(k))))
                  if (k == 2 .and. solution%state%state(i) /= FREE) cycle
                  off(k) = max(off(k), force/data%line%weight(j))
                  most(k) = max(most(k), abs(solution%state%q(i))/data%line%weight(j))
               end associate
            end do
         end do
         associate (pair => results%scene%pairs(data%line%pair(first)))
            do k = 1, 2
               if (off(k) <= UNKNOWN_PART*most(k)) cycle
               call add_warning('W-DIGITS', pair%slave//' on '//pair%master//': '//trim(KINDS(k))//'s may be off by ' &
                                //to_text(100*min(off(k)/most(k), 1.0_wp), 2)//' %: initial distances are differences of' &
                                //' coordinates, known to '//to_text(EPS_MACH*far, 2)//' [L], and a '//trim(KINDS(k))//' of ' &
                                //to_text(off(k), 2)//' [F/L^2] closes as much')
               exit
            end do
         end associate
         first = last + 1
      end do
   end subroutine warn_of_last_digits

   !> Elements of reduced integration that contact alone keeps in shape, and rows of them whose displacements are for a good part
   !> what their points do not see.
   subroutine warn_of_hourglass(data, results)
      type(scene_data_t), intent(in) :: data
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: text
      real(wp) :: ratio
      integer(ip) :: b, element

      if (.not. allocated(results%u) .or. .not. allocated(data%fem%bodies%list)) return
      do b = 1, data%fem%bodies%n
         text = hourglass_text(data%fem, b)
         if (len(text) > 0) then
            call add_warning('W-HOURGLASS', text//': here contact or joints alone do')
            cycle
         end if
         call worst_hourglass(data%fem, data%fem%bodies%list(b), results%u, ratio, element)
         if (ratio <= LARGE_HOURGLASS) cycle
     call add_warning('W-HOURGLASS', 'body '//data%fem%bodies%list(b)%name//': elements in one row take the shape that reduced '// &
                         'integration hardly feels, an hourglass, most of all element '//to_text(element)//': full integration '// &
                          'would see '//to_text(ratio, 2)//' times the strain energy in it; CPE8, CPS8 or CAX8 there, or more rows')
      end do
   end subroutine warn_of_hourglass

   !> That there are other solutions, where it is known; else whether there may be some, where no proof excludes them.
   subroutine warn_of_others(model, results)
      type(model_t), intent(in) :: model
      type(results_t), intent(in) :: results
      character(len=:), allocatable :: measured, proved
      real(wp) :: nu
      integer(ip) :: i

      associate (known => results%uniqueness)
         if (known%solutions > 1) then
            call add_warning('W-UNIQUE', 'this is not the only solution: the search found '//to_text(known%solutions - 1)//' more')
         else if (known%index < 0) then
            call add_warning('W-UNIQUE', 'this is not the only solution: its index is -1, so there is another one at least, and'// &
                             ' mostly two; --unique 40 looks for them')
         end if
         if (known%solutions > 1 .or. known%index < 0) return
         if (known%up_to_nu >= known%nu .and. known%nu > 0.0_wp) return
      end associate
      nu = 0.0_wp
      do i = 1, size(model%pairs, kind=ip)
         associate (law => model%interactions(model%pairs(i)%interaction))
            if (law%friction /= FRICTION_NONE) nu = max(nu, law%nu)
         end associate
      end do
      if (results%contraction_estimate < 1.0_wp .and. nu < LARGE_FRICTION) return
      proved = ''
      if (results%uniqueness%up_to_nu > 0.0_wp) proved = '; proved up to '//to_text(results%uniqueness%up_to_nu, 3)
      measured = ' (estimated contraction of the outer loop '//to_text(results%contraction_estimate, 3)
      if (results%contraction > 0.0_wp) measured = measured//', measured '//to_text(results%contraction, 3)
      if (results%contraction_estimate >= 1.0_wp) then
         call add_warning('W-UNIQUE', 'friction coefficient '//to_text(nu)//': there may be other solutions than the one found;' &
                          //' one alone is expected below '//to_text(nu/results%contraction_estimate, 3)//proved//measured//')')
      else
         call add_warning('W-UNIQUE', 'friction coefficient '//to_text(nu)//': there may be other solutions than the one found' &
                          //proved//measured//'; below 1 others are rare)')
      end if
   end subroutine warn_of_others

   !> Names the points whose own force is not unique.
   subroutine note_shared_points(mesh, rows, line, solution)
      type(mesh_t), intent(in) :: mesh
      type(contact_rows_t), intent(in) :: rows
      type(contact_line_t), intent(in) :: line
      type(contact_solution_t), intent(in) :: solution
      logical :: is_shared(line%n)
      integer(ip), allocatable :: nodes(:), once(:)
      character(len=:), allocatable :: text
      integer(ip) :: j

      if (.not. allocated(solution%is_shared)) return
      is_shared = .false.
      do j = 1, line%n
         if (line%normal(j) > 0) is_shared(j) = solution%is_shared(line%normal(j))
         if (line%tangential(j) > 0) is_shared(j) = is_shared(j) .or. solution%is_shared(line%tangential(j))
      end do
      nodes = mesh%node_id(rows%node(rows%first(pack([(j, j=1, line%n)], is_shared))))
      if (size(nodes) == 0) return
      once = nodes(:0)                               ! two pairs may have their point at one node
      do j = 1, size(nodes, kind=ip)
         if (size(once) <= MOST_NAMED .and. .not. any(once == nodes(j))) once = [once, nodes(j)]
      end do
      text = trim(merge('points and joints', 'contact points   ', line%n_bilateral > 0))//' share what they ask, so that the '// &
             'force of '//to_text(size(nodes, kind=ip))//trim(merge(' points', ' point ', size(nodes) > 1))//' is not unique: '// &
             trim(merge('nodes', 'node ', size(once) > 1))//' '//to_text(once(1))
      do j = 2, min(size(once, kind=ip), MOST_NAMED)
         text = text//', '//to_text(once(j))
      end do
      if (size(once) > MOST_NAMED) text = text//', ...'
      call add_note('N-SHARED', text//'; displacements and sums of the forces are, and of the forces the least are given')
   end subroutine note_shared_points

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

end module atrito_solution_warnings
