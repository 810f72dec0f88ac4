!> Whether what a restart file has found can be of this deck. Checksums tell what was damaged; who writes a file on purpose gives it
!> right ones with any number in it. So each size is that of the deck, each place is within its list, each number of a node or an
!> element is one of the deck's, states are of their enumeration, times lie in their step, reals are finite (what is not defined
!> may be NaN), and text has no control characters. That is asked before anything is used.
module atrito_check_found
   use atrito_element_table, only: POINT_COUNT
   use atrito_controls, only: iteration_t
   use atrito_kinds, only: ip, wp
   use atrito_mesh, only: find_element, find_node
   use atrito_model, only: rigid_body_name, step_t
   use atrito_record_checks, only: require, is_finite, is_any_infinite, is_list, has_length, is_text, is_plain, is_same_time
   use atrito_restart_state, only: restart_state_t
   use atrito_results, only: body_motion_t, contact_result_t, extreme_t, history_t, observed_list_t, observed_t, results_t, &
                             scene_t, view_frame, EXTREME_NAMES, POINT_OPEN, POINT_SLIP
   use atrito_scene_data, only: scene_data_t
   use atrito_strings, only: string_t, to_text
   implicit none (type, external)
   private
   public :: check_found

contains

   !> wrong: what does not fit, in words; not allocated: all does.
   subroutine check_found(data, scene, observed, history, state, wrong)
      type(scene_data_t), intent(in) :: data                !< of the step in which the history stands
      type(scene_t), intent(in) :: scene                    !< as the deck has it in this step
      type(string_t), intent(in) :: observed(:)             !< names of what is observed
      type(history_t), intent(in), target :: history        !< as the file has it; all frames are shown
      type(restart_state_t), intent(in) :: state            !< as the file has it; check_place has passed it
      character(len=:), allocatable, intent(inout) :: wrong !< stays where it is allocated
      type(results_t), pointer :: frame
      integer(ip) :: i

      call require(wrong, allocated(history%frames) .and. allocated(history%rows) .and. allocated(history%iterations), 'lists')
      if (allocated(wrong)) return
      do i = 1, size(history%frames, kind=ip)
         call view_frame(history, i, frame)
         call require(wrong, is_before([frame%step, frame%increment], [state%step, state%increment]), 'frames behind the end')
         if (i > 1) call require(wrong,.not. is_before([frame%step, frame%increment], [history%frames(i - 1)%step, &
                                                                           history%frames(i - 1)%increment]), 'frames out of order')
         call check_frame(data, scene, observed, frame, frame%step == state%step, wrong)
         if (allocated(wrong)) return
      end do
      call check_frame(data, scene, observed, state%last, .true., wrong)
      call check_rows(data, history, state, wrong)
      if (.not. allocated(wrong)) call check_iterations(data, history%iterations, wrong)
      call require(wrong, is_ordered(history%iterations%step, history%iterations%increment, state), 'order of iterations')
      call check_observed_list(size(observed), history%observed, state, wrong)
   end subroutine check_found

   !> Whether one place of a history, step and increment, is another or before it.
   pure logical function is_before(one, other)
      integer(ip), intent(in) :: one(2), other(2)

      is_before = one(1) < other(1) .or. (one(1) == other(1) .and. one(2) <= other(2))
   end function is_before

   !> Whether places of a history ascend from the first to where it stands.
   pure logical function is_ordered(step, increment, state)
      integer(ip), intent(in) :: step(:), increment(:)
      type(restart_state_t), intent(in) :: state
      integer :: i

      is_ordered = all(step >= 1 .and. increment >= 1)
      if (size(step) == 0) return
      do i = 2, size(step)
         is_ordered = is_ordered .and. is_before([step(i - 1), increment(i - 1)], [step(i), increment(i)])
      end do
      is_ordered = is_ordered .and. is_before([step(size(step)), increment(size(step))], [state%step, state%increment])
   end function is_ordered

   !> One increment.
   pure subroutine check_frame(data, scene, observed, frame, is_same_step, wrong)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(in) :: scene
      type(string_t), intent(in) :: observed(:)
      type(results_t), intent(in) :: frame
      logical, intent(in) :: is_same_step            !< the supports are those of data
      character(len=:), allocatable, intent(inout) :: wrong
      character(len=:), allocatable :: own

      call check_time(data%model%steps, frame, own)
      if (.not. allocated(own)) then
         call check_fields(own)
         call check_stress(data%model%steps(frame%step), own)
         call check_scene(scene, frame%scene, is_same_step, own)
         call check_contact_list(data, frame, own)
         call check_joints(data, frame, own)
         call check_numbers(data, frame, own)
         call check_bodies(data, data%model%steps(frame%step)%requests%bodies, frame%bodies, own)
         call check_rigid(data, frame, own)
         call check_cuts(data, data%model%steps(frame%step), frame, own)
         call check_observed(observed, frame%observed, own)
      end if
      if (allocated(own)) call require(wrong, .false., own//' of step '//to_text(frame%step)//', increment ' &
                                       //to_text(frame%increment))

   contains

      !> What there is at nodes, elements and bilateral rows.
      pure subroutine check_fields(wrong)
         character(len=:), allocatable, intent(inout) :: wrong

         associate (n => data%model%mesh%n_nodes, rows => data%model%bilateral%n)
            call require(wrong, is_list(frame%u, 2_ip, n), 'u')
            call require(wrong, is_list(frame%reaction, 2_ip, n), 'reaction')
            call require(wrong, allocated(frame%prescribed), 'prescribed')
            if (.not. allocated(wrong)) call require(wrong, all(shape(frame%prescribed) == [2, int(n)]), 'prescribed')
            if (allocated(frame%row_x)) call require(wrong, is_list(frame%row_x, 2_ip, rows), 'row_x')
            if (allocated(frame%row_force)) call require(wrong, is_list(frame%row_force, rows), 'row_force')
            if (allocated(frame%nodal_stress)) call require(wrong, is_list(frame%nodal_stress, 5_ip, n), 'nodal_stress')
            if (allocated(frame%element_error)) then
               call require(wrong, is_list(frame%element_error, data%model%mesh%n_elements), 'element_error')
            end if
         end associate
      end subroutine check_fields

      !> The points of the elements that are asked for, in their order.
      pure subroutine check_stress(step, wrong)
         type(step_t), intent(in) :: step
         character(len=:), allocatable, intent(inout) :: wrong
         logical :: is_wanted
         integer(ip) :: e, k, n

         if (allocated(wrong) .or. .not. allocated(frame%stress_element)) return
         n = size(frame%stress_element, kind=ip)
         call require(wrong, has_length(frame%stress_point, n) .and. is_list(frame%stress_x, 2_ip, n) .and. &
                      is_list(frame%stress, 5_ip, n), 'stress')
         if (allocated(wrong)) return
         n = 0
         associate (mesh => data%model%mesh, requests => step%requests)
            do e = 1, mesh%n_elements
               is_wanted = .false.
               if (requests%stress) is_wanted = requests%element_s(e)
               if (requests%fields%stress) is_wanted = is_wanted .or. requests%fields%element_s(e)
               if (.not. is_wanted) cycle
               do k = 1, POINT_COUNT(mesh%shape(e), mesh%state(e))
                  n = n + 1
                  call require(wrong, n <= size(frame%stress_element), 'stress')
                  if (allocated(wrong)) return
                  call require(wrong, frame%stress_element(n) == e .and. frame%stress_point(n) == k, 'stress_element')
               end do
            end do
         end associate
         call require(wrong, n == size(frame%stress_element), 'stress')
      end subroutine check_stress

   end subroutine check_frame

   pure subroutine check_time(steps, frame, wrong)
      type(step_t), intent(in) :: steps(:)
      type(results_t), intent(in) :: frame
      character(len=:), allocatable, intent(inout) :: wrong
      real(wp) :: began

      call require(wrong, frame%step >= 1 .and. frame%step <= size(steps), 'the number')
      call require(wrong, is_finite([frame%time, frame%step_time]), 'the time')
      if (allocated(wrong)) return                   ! what is no number may not be compared
      associate (way => steps(frame%step)%increments)
         began = sum(steps(:frame%step - 1)%increments%period)
         call require(wrong, frame%increment >= 1 .and. frame%increment <= way%most, 'the number')
         call require(wrong, frame%step_time > 0.0_wp .and. frame%step_time <= way%period, 'the time')
         call require(wrong, is_same_time(frame%time, began + frame%step_time), 'the time')
         call require(wrong, frame%ends_step .eqv. frame%step_time >= way%period, 'the end')
      end associate
      call require(wrong, frame%converged .and. frame%law_holds, 'the outcome')
      call require(wrong, is_plain(frame%verdict), 'the verdict')
   end subroutine check_time

   !> Names and sizes of bodies and pairs; in the same step also what its supports make of them.
   pure subroutine check_scene(own, scene, is_same_step, wrong)
      type(scene_t), intent(in) :: own, scene        !< of the deck, of the file
      logical, intent(in) :: is_same_step
      character(len=:), allocatable, intent(inout) :: wrong
      integer :: i

      call require(wrong, has_length(scene%bodies, size(own%bodies)) .and. has_length(scene%pairs, size(own%pairs)) .and. &
                   allocated(scene%left_out), 'scene')
      if (allocated(wrong)) return
      call require(wrong, is_plain(scene%contact_form) .and. is_plain(scene%contact_reason) .and. is_plain(scene%order) .and. &
                   all([(is_plain(scene%left_out(i)%s), i=1, size(scene%left_out))]), 'scene')
      call require(wrong, min(scene%memory, scene%memory_before, scene%peak_before, scene%solving) >= 0, 'memory')
      call require(wrong, min(scene%n_dofs, scene%n_normal, scene%n_tangential, scene%n_rows, scene%n_rigid) >= 0, 'scene')
      if (is_same_step) call require(wrong, all([scene%n_dofs, scene%n_normal, scene%n_tangential, scene%n_rows, scene%n_rigid] &
                                                == [own%n_dofs, own%n_normal, own%n_tangential, own%n_rows, own%n_rigid]) .and. &
                                     (scene%outer_loop .eqv. own%outer_loop), 'scene')
      do i = 1, size(scene%bodies)
         call check_body(wrong)
      end do
      do i = 1, size(scene%pairs)
         associate (pair => scene%pairs(i), ours => own%pairs(i))
            call require(wrong, is_text(pair%slave, ours%slave) .and. is_text(pair%master, ours%master) .and. &
                         is_text(pair%interaction, ours%interaction), 'pairs')
            call require(wrong, all([pair%n_points, pair%n_left_out, pair%least_node, pair%greatest_node] &
                                    == [ours%n_points, ours%n_left_out, ours%least_node, ours%greatest_node]) .and. &
                         (pair%matching .eqv. ours%matching) .and. (pair%master_is_rigid .eqv. ours%master_is_rigid) .and. &
                         is_finite([pair%least_gap, pair%greatest_gap, pair%least_x, pair%greatest_x]), 'pairs')
         end associate
      end do

   contains

      pure subroutine check_body(wrong)
         character(len=:), allocatable, intent(inout) :: wrong

         associate (body => scene%bodies(i), ours => own%bodies(i))
            call require(wrong, is_text(body%name, ours%name) .and. body%n_nodes == ours%n_nodes .and. &
                         body%n_elements == ours%n_elements, 'bodies')
            if (is_same_step) call require(wrong, body%n_equations == ours%n_equations .and. &
                                           body%n_contact_equations == ours%n_contact_equations .and. &
                                           body%n_free_motions == ours%n_free_motions, 'bodies')
            call require(wrong, min(body%n_equations, body%n_contact_equations, body%n_free_motions) >= 0 .and. &
                         min(body%profile, body%memory, body%most_memory) >= 0 .and. &
                         min(body%half_bandwidth, body%sign_changes, body%n_fronts, body%n_different_fronts) >= 0, 'bodies')
            call require(wrong, max(body%half_bandwidth, body%sign_changes, body%n_contact_equations) <= body%n_equations .and. &
                         body%n_equations <= 2*ours%n_nodes .and. body%n_free_motions <= 3 .and. &
                         body%n_different_fronts <= body%n_fronts, 'bodies')
            call require(wrong, body%worst_dof >= 0 .and. body%worst_dof <= 2, 'worst_dof')
            call require(wrong, is_plain(body%solver) .and. is_plain(body%reason) .and. is_plain(body%order) .and. &
                         is_finite([body%digits_lost]) .and. body%solver_kind >= 0, 'bodies')
         end associate
      end subroutine check_body

   end subroutine check_scene

   pure subroutine check_contact_list(data, frame, wrong)
      type(scene_data_t), intent(in) :: data
      type(results_t), intent(in) :: frame
      character(len=:), allocatable, intent(inout) :: wrong
      integer(ip) :: i, n_joints

      call require(wrong, has_length(frame%contact, size(data%points)), 'contact')
      if (allocated(wrong)) return
      n_joints = 0
      if (allocated(frame%joints)) n_joints = size(frame%joints, kind=ip)
      do i = 1, size(frame%contact, kind=ip)
         call check_contact(frame%contact(i), data%points(i)%n, wrong)
         if (allocated(wrong)) return
         if (.not. allocated(frame%contact(i)%joint)) cycle
         associate (joint => frame%contact(i)%joint)
            call require(wrong, allocated(frame%joints) .and. all(joint >= 1 .and. joint <= n_joints), 'joint')
            if (.not. allocated(wrong)) call require(wrong, all(frame%joints(joint)%pair == i), 'joint')
         end associate
      end do
   end subroutine check_contact_list

   !> The points of a pair.
   pure subroutine check_contact(contact, n, wrong)
      type(contact_result_t), intent(in) :: contact
      integer(ip), intent(in) :: n
      character(len=:), allocatable, intent(inout) :: wrong

      call require(wrong, contact%n == n, 'contact')
      call require(wrong, is_list(contact%s, n) .and. is_list(contact%gap, n) .and. is_list(contact%pressure, n) .and. &
                   is_list(contact%weighted_pressure, n) .and. is_list(contact%shear, n) .and. is_list(contact%slip, n) .and. &
                   is_list(contact%slip_increment, n) .and. is_list(contact%weight, n), 'contact')
      call require(wrong, is_list(contact%x, 2_ip, n) .and. is_list(contact%normal, 2_ip, n) .and. is_list(contact%u, 2_ip, n), &
                   'contact')
      call require(wrong, has_length(contact%status, n), 'status')
      if (allocated(contact%joint)) call require(wrong, has_length(contact%joint, n), 'joint')
      if (allocated(contact%follows)) call require(wrong, has_length(contact%follows, n), 'follows')
      call require(wrong, is_finite([contact%s_end]), 's_end')
      if (allocated(wrong)) return
      call require(wrong, all(contact%status >= POINT_OPEN .and. contact%status <= POINT_SLIP), 'status')
      call require(wrong, all(contact%pressure >= 0.0_wp .and. contact%weight >= 0.0_wp), 'pressure')
      call require(wrong, all(contact%status == POINT_OPEN .eqv. contact%pressure <= 0.0_wp), 'status')
   end subroutine check_contact

   !> Joints of the pairs, by pair; what is not defined of them is NaN.
   pure subroutine check_joints(data, frame, wrong)
      type(scene_data_t), intent(in) :: data
      type(results_t), intent(in) :: frame
      character(len=:), allocatable, intent(inout) :: wrong
      integer(ip) :: i, before

      if (allocated(wrong) .or. .not. allocated(frame%joints)) return
      before = 1
      do i = 1, size(frame%joints, kind=ip)
         associate (joint => frame%joints(i))
            call require(wrong, joint%pair >= before .and. joint%pair <= size(data%points), 'joints')
            call require(wrong, all(joint%bodies >= 0 .and. joint%bodies <= data%fem%bodies%n), 'joints')
            call require(wrong, is_finite([joint%m, joint%opening, joint%sliding, joint%force, joint%length, joint%u]), 'joints')
            call require(wrong,.not. is_any_infinite([joint%n, joint%t, joint%place]), 'joints')
            before = joint%pair
         end associate
      end do
   end subroutine check_joints

   !> Counts, norms, extremes and balances.
   pure subroutine check_numbers(data, frame, wrong)
      type(scene_data_t), intent(in) :: data
      type(results_t), intent(in) :: frame
      character(len=:), allocatable, intent(inout) :: wrong
      integer(ip) :: i

      call require(wrong, min(frame%outer_iterations, frame%linear_solves, frame%factorisations) >= 0, 'iterations')
      call require(wrong, is_finite([frame%uniqueness%nu, frame%uniqueness%up_to_nu, frame%uniqueness%same_way_up_to_nu]) &
                   .and. min(frame%uniqueness%starts, frame%uniqueness%solutions) >= 0, 'uniqueness')
      call require(wrong, is_finite([frame%error_estimate, frame%contraction, frame%contraction_estimate, &
                                     frame%equilibrium_residual, frame%strain_energy, frame%external_work]), 'numbers')
      associate (b => frame%balance)
         call require(wrong, is_finite([b%applied, b%reactions, b%rigid, b%rows]), 'balance')
      end associate
      if (allocated(frame%iterations)) call check_iterations(data, frame%iterations, wrong)
      ! of what did not converge, which no file has
      call require(wrong,.not. allocated(frame%unsettled), 'unsettled')
      if (allocated(frame%extremes)) then
         do i = 1, size(frame%extremes, kind=ip)
            call check_extreme(data, frame%extremes(i), wrong)
         end do
      end if
      call check_extreme(data, frame%large_strain, wrong)
      call check_extreme(data, frame%large_rotation, wrong)
      call check_extreme(data, frame%large_slip, wrong)
   end subroutine check_numbers

   !> A node or an element of the deck; none where there is nothing to tell.
   pure subroutine check_extreme(data, extreme, wrong)
      type(scene_data_t), intent(in) :: data
      type(extreme_t), intent(in) :: extreme
      character(len=:), allocatable, intent(inout) :: wrong
      logical :: is_there

      is_there = extreme%id == 0 .and. extreme%quantity == ''
      if (extreme%id > 0 .and. extreme%is_node) is_there = find_node(data%model%mesh, extreme%id) > 0
      if (extreme%id > 0 .and. .not. extreme%is_node) is_there = find_element(data%model%mesh, extreme%id) > 0
      call require(wrong, is_there .and. is_finite([extreme%value, extreme%x]), 'extremes')
      call require(wrong, extreme%quantity == '' .or. (extreme%is_node .and. any(extreme%quantity == EXTREME_NAMES)), 'extremes')
   end subroutine check_extreme

   pure subroutine check_iterations(data, list, wrong)
      type(scene_data_t), intent(in) :: data
      type(iteration_t), intent(in) :: list(:)
      character(len=:), allocatable, intent(inout) :: wrong

      call require(wrong, all(list%step >= 1 .and. list%step <= size(data%model%steps) .and. list%increment >= 1), 'iterations')
      call require(wrong, all(min(list%outer, list%inner) >= 0 .and. max(list%outer, list%inner) <= size(list)), 'iterations')
      call require(wrong, all(min(list%open, list%stick, list%slip) >= 0 .and. &
                              max(list%open, list%stick, list%slip) <= data%line%n), 'iterations')
      call require(wrong, is_finite([list%change_displacement, list%change_pressure, list%change_friction, list%residual]), &
                   'iterations')
   end subroutine check_iterations

   pure subroutine check_bodies(data, is_asked, bodies, wrong)
      type(scene_data_t), intent(in) :: data
      logical, intent(in) :: is_asked
      type(body_motion_t), allocatable, intent(in) :: bodies(:)
      character(len=:), allocatable, intent(inout) :: wrong
      integer(ip) :: i

      associate (n => data%fem%bodies%n - data%fem%bodies%n_rigid)
         call require(wrong, merge(has_length(bodies, n),.not. allocated(bodies), is_asked), 'bodies')
      end associate
      if (allocated(wrong) .or. .not. allocated(bodies)) return
      do i = 1, size(bodies, kind=ip)
         associate (body => bodies(i))
            call require(wrong, is_text(body%name, data%fem%bodies%list(i)%name), 'bodies')
            call require(wrong, is_finite([body%centre, body%size, body%u, body%rotation, body%loads, body%supports, &
                                           body%contact, body%terms]), 'bodies')
         end associate
      end do
   end subroutine check_bodies

   pure subroutine check_rigid(data, frame, wrong)
      type(scene_data_t), intent(in) :: data
      type(results_t), intent(in) :: frame
      character(len=:), allocatable, intent(inout) :: wrong
      integer(ip) :: i, n

      n = 0
      if (allocated(data%model%rigid_bodies)) n = size(data%model%rigid_bodies, kind=ip)
      call require(wrong, has_length(frame%rigid, n) .or. (n == 0 .and. .not. allocated(frame%rigid)), 'rigid')
      if (allocated(wrong) .or. .not. allocated(frame%rigid)) return
      do i = 1, n
         associate (body => frame%rigid(i), ours => data%model%rigid_bodies(i))
            call require(wrong, is_text(body%name, rigid_body_name(data%model, i)) .and. (body%is_section .eqv. ours%is_section), &
                         'rigid')
            call require(wrong, body%node == data%model%mesh%node_id(ours%node), 'rigid')
            call require(wrong, is_finite([body%size, body%u, body%rotation, body%reaction, body%force, body%moment]), 'rigid')
         end associate
      end do
   end subroutine check_rigid

   pure subroutine check_cuts(data, step, frame, wrong)
      type(scene_data_t), intent(in) :: data
      type(step_t), intent(in) :: step
      type(results_t), intent(in) :: frame
      character(len=:), allocatable, intent(inout) :: wrong
      integer :: i

      call require(wrong, allocated(frame%cuts) .eqv. allocated(step%requests%cuts), 'cuts')
      if (allocated(wrong) .or. .not. allocated(frame%cuts)) return
      call require(wrong, size(frame%cuts) == size(step%requests%cuts), 'cuts')
      if (allocated(wrong)) return
      do i = 1, size(frame%cuts)
         associate (cut => frame%cuts(i))
            call require(wrong, is_text(cut%name, data%model%cuts(step%requests%cuts(i))%name), 'cuts')
            call require(wrong, is_finite([cut%middle, cut%length, cut%n, cut%v, cut%m, cut%terms]), 'cuts')
         end associate
      end do
   end subroutine check_cuts

   pure subroutine check_observed(names, list, wrong)
      type(string_t), intent(in) :: names(:)
      type(observed_t), allocatable, intent(in) :: list(:)
      character(len=:), allocatable, intent(inout) :: wrong
      integer :: i

      call require(wrong, merge(has_length(list, size(names)),.not. allocated(list), size(names) > 0), 'observed')
      if (allocated(wrong) .or. .not. allocated(list)) return
      call require(wrong, all([(list(i)%name == names(i)%s, i=1, size(names))]), 'observed')
      call require(wrong,.not. is_any_infinite(list%value), 'observed')
   end subroutine check_observed

   !> A row of every pair and increment.
   pure subroutine check_rows(data, history, state, wrong)
      type(scene_data_t), intent(in) :: data
      type(history_t), intent(in) :: history
      type(restart_state_t), intent(in) :: state
      character(len=:), allocatable, intent(inout) :: wrong
      integer :: i, n

      n = size(data%points)
      call require(wrong, is_ordered(history%rows%step, history%rows%increment, state), 'order of rows')
      call require(wrong, merge(size(history%rows) == 0, mod(size(history%rows), max(n, 1)) == 0, n == 0), 'rows')
      if (allocated(wrong)) return
      do i = 1, size(history%rows)
         associate (row => history%rows(i))
            call require(wrong, row%pair == mod(i - 1, n) + 1, 'pair of rows')
            if (allocated(wrong)) return
            call require(wrong, min(row%open, row%stick, row%slip) >= 0 .and. &
                         max(row%open, row%stick, row%slip) <= data%points(row%pair)%n, 'states of rows')
            if (allocated(wrong)) return
            call require(wrong, row%open + row%stick + row%slip == data%points(row%pair)%n, 'states of rows')
            call require(wrong,.not. is_any_infinite([row%normal, row%shear, row%moment, row%length, row%centre, &
                                                      row%max_pressure, row%dissipation, row%elastic_energy, row%unique_up_to_nu, &
                                                      row%mean_slip]), &
                         'rows')
            call require(wrong, is_finite([row%time]), 'time of rows')
            if (allocated(wrong)) return
            call require(wrong, row%time > 0.0_wp .and. row%time <= state%last%time, 'time of rows')
         end associate
      end do
   end subroutine check_rows

   pure subroutine check_observed_list(n, list, state, wrong)
      integer, intent(in) :: n
      type(observed_list_t), intent(in) :: list
      type(restart_state_t), intent(in) :: state
      character(len=:), allocatable, intent(inout) :: wrong

      call require(wrong, list%n >= 0 .and. (list%n > 0 .eqv. n > 0), 'observed')
      if (allocated(wrong) .or. list%n == 0) return
      call require(wrong, has_length(list%step, list%n) .and. has_length(list%increment, list%n) .and. &
                   is_list(list%time, list%n) .and. allocated(list%values), 'observed')
      if (allocated(wrong)) return
      call require(wrong, all(shape(list%values) == [n, int(list%n)]), 'observed')
      call require(wrong, is_ordered(list%step, list%increment, state), 'order of observed')
   end subroutine check_observed_list

end module atrito_check_found
