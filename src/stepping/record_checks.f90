!> Whether the state of a restart file, from which the next increment begins, can be of this deck (see atrito_check_found), and what
!> both checks ask of numbers, lists and texts.
module atrito_record_checks
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan
   use atrito_bound_qp, only: FREE, FROZEN
   use atrito_contact_form, only: CONTACT_DENSE, CONTACT_SPARSE
   use atrito_contact_line, only: last_contact_pair, pairs_of_unknowns, tangential_of
   use atrito_kinds, only: ip, wp
   use atrito_model, only: model_t, nodal_values_t
   use atrito_multipliers, only: multiplier_t
   use atrito_restart_state, only: restart_state_t, warm_start_t
   use atrito_results, only: scene_t
   use atrito_scene_data, only: scene_data_t
   use atrito_utf8, only: has_controls
   implicit none (type, external)
   private
   public :: require, is_finite, is_any_infinite, is_list, has_length, may_be, is_text, is_plain, is_same_time, &
             check_place, check_start

   !> Round-off of times, which are sums.
   real(wp), parameter :: SAME_TIME = 1.0e-12_wp

   !> An allocated array of so many finite numbers.
   interface is_list
      module procedure is_list_of_reals, is_list_of_columns
   end interface is_list

contains

   !> Keeps the first complaint.
   pure subroutine require(wrong, condition, what)
      character(len=:), allocatable, intent(inout) :: wrong !< an earlier complaint stays
      logical, intent(in) :: condition                      !< what is asked for holds
      character(len=*), intent(in) :: what                  !< name of the record, or a few words

      if (.not. (condition .or. allocated(wrong))) wrong = what
   end subroutine require

   !> Whether two times are the same but for round-off.
   pure logical function is_same_time(one, other)
      real(wp), intent(in) :: one, other !< finite

      is_same_time = abs(one - other) <= SAME_TIME*(abs(one) + abs(other))
   end function is_same_time

   !> Whether all values are numbers, none of them infinite.
   pure logical function is_finite(values)
      real(wp), intent(in) :: values(:) !< any doubles

      is_finite = all(ieee_is_finite(values))
   end function is_finite

   !> NaN is none.
   pure logical function is_any_infinite(values)
      real(wp), intent(in) :: values(:) !< any doubles

      is_any_infinite = any(.not. (ieee_is_finite(values) .or. ieee_is_nan(values)))
   end function is_any_infinite

   pure logical function is_list_of_reals(values, n) result(is_list)
      real(wp), allocatable, intent(in) :: values(:) !< as the file has it
      integer(ip), intent(in) :: n                   !< length that it must have

      is_list = has_length(values, n)
      if (is_list) is_list = is_finite(values)
   end function is_list_of_reals

   pure logical function is_list_of_columns(values, m, n) result(is_list)
      real(wp), allocatable, intent(in) :: values(:, :) !< as the file has it
      integer(ip), intent(in) :: m, n                   !< shape that it must have
      integer(ip) :: i

      is_list = allocated(values)
      if (is_list) is_list = all(shape(values) == [m, n])
      if (.not. is_list) return
      do i = 1, n
         is_list = is_list .and. is_finite(values(:, i))
      end do
   end function is_list_of_columns

   !> Whether an allocated list is there, and has so many elements.
   pure logical function has_length(list, n)
      type(*), intent(in), optional :: list(:) !< as the file has it; one that is not allocated is absent
      integer, intent(in) :: n                 !< length that it must have

      has_length = present(list)
      if (has_length) has_length = size(list) == n
   end function has_length

   !> Whether a text is there, and is the one that the deck gives, blanks at its end included.
   pure logical function is_text(text, expected)
      character(len=:), allocatable, intent(in) :: text !< as the file has it
      character(len=*), intent(in) :: expected          !< as the deck gives it

      is_text = allocated(text)
      if (is_text) is_text = len(text) == len(expected) .and. text == expected
   end function is_text

   !> A line without control characters; what is not allocated has none.
   pure logical function is_plain(text)
      character(len=:), allocatable, intent(in) :: text !< as the file has it

      is_plain = .true.
      if (allocated(text)) is_plain = .not. has_controls(text) .and. scan(text, achar(9)//achar(10)//achar(13)) == 0
   end function is_plain

   !> Whether a list is not there, or is one of so many finite numbers (is_list).
   pure logical function may_be(values, n)
      real(wp), allocatable, intent(in) :: values(:) !< as the file has it
      integer(ip), intent(in) :: n                   !< length that it must have

      may_be = .not. allocated(values)
      if (.not. may_be) may_be = is_list(values, n)
   end function may_be

   !> Where the history stands, and what its scene is made from: to be asked before that. wrong: what does not fit.
   pure subroutine check_place(model, state, wrong)
      type(model_t), intent(in) :: model                    !< steps of the deck
      type(restart_state_t), intent(in) :: state            !< as the file has it
      character(len=:), allocatable, intent(inout) :: wrong !< stays where it is allocated
      real(wp) :: began

      call require(wrong, state%step >= 1 .and. state%step <= size(model%steps), 'step')
      call require(wrong, is_finite([state%step_time, state%length, state%began, state%condition, state%digit_error, &
                                     state%last%step_time]), 'times')
      if (allocated(wrong)) return                   ! what is no number may not be compared
      associate (step => model%steps(state%step), way => model%steps(state%step)%increments)
         began = sum(model%steps(:state%step - 1)%increments%period)
         call require(wrong, state%increment >= 1 .and. state%increment <= way%most, 'increment')
         call require(wrong, state%step_time > 0.0_wp .and. state%step_time <= way%period, 'step_time')
         call require(wrong, state%ends_step .eqv. state%step_time >= way%period, 'ends_step')
         call require(wrong, is_same_time(state%began, began), 'began')
         call require(wrong, state%length > 0.0_wp, 'length')
         call require(wrong, state%condition >= 0.0_wp .and. state%digit_error >= 0.0_wp, 'condition')
         call require(wrong, state%contact_form == CONTACT_DENSE .or. state%contact_form == CONTACT_SPARSE, 'contact_form')
         call require(wrong, is_plain(state%contact_reason) .and. allocated(state%contact_reason), 'contact_reason')
         call require(wrong, is_begun(state%from, step%prescribed), 'from')
         call require(wrong, is_begun(state%from_of_motions, step%rigid_prescribed), 'from_of_motions')
      end associate
      associate (last => state%last)
         call require(wrong, last%step == state%step .and. last%increment == state%increment .and. &
                      abs(last%step_time - state%step_time) <= 0.0_wp, 'last')
      end associate
   end subroutine check_place

   !> Values at the beginning of a step of all that it prescribes; none are those of the deck.
   pure logical function is_begun(from, prescribed)
      real(wp), allocatable, intent(in) :: from(:)
      type(nodal_values_t), intent(in) :: prescribed

      is_begun = .not. allocated(from)
      if (.not. is_begun) is_begun = size(from) >= prescribed%n .and. is_finite(from)
      if (is_begun .and. allocated(from) .and. allocated(prescribed%value)) is_begun = size(from) <= size(prescribed%value)
   end function is_begun

   !> What friction remembers, and where the contact line starts from, of the scene of the step.
   pure subroutine check_start(data, scene, state, wrong)
      type(scene_data_t), intent(in) :: data                !< of the step in which the history stands
      type(scene_t), intent(in) :: scene                    !< as the deck has it in this step
      type(restart_state_t), intent(in) :: state            !< as the file has it; check_place has passed it
      character(len=:), allocatable, intent(inout) :: wrong !< stays where it is allocated

      associate (n => sum(data%points%n), pairs => size(data%points, kind=ip), bodies => data%fem%bodies%n, memory => state%memory)
         call require(wrong, is_list(memory%rest, n) .and. is_list(memory%slip, n) .and. is_list(memory%shear, n) .and. &
                      has_length(memory%slides, n), 'rest slips')
         call require(wrong, is_list(memory%dissipation, pairs) .and. is_list(memory%moved, pairs), 'dissipation')
         if (allocated(state%released)) call require(wrong, is_list(state%released, 2_ip, data%fem%mesh%n_nodes) .or. &
                                                     is_list(state%released, 2_ip, data%model%mesh%n_nodes), 'released')
         call require(wrong, allocated(state%had_motion) .eqv. allocated(state%had_force), 'had_motion')
         if (allocated(state%had_motion)) call require(wrong, is_list(state%had_motion, bodies) .and. &
                                                       is_list(state%had_force, bodies), 'had_motion')
      end associate
      if (.not. allocated(wrong)) call check_line(data, scene, state%start, wrong)
   end subroutine check_start

   !> The unknowns of the contact line; with nothing to start from there is none of it.
   pure subroutine check_line(data, scene, start, wrong)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(in) :: scene
      type(warm_start_t), intent(in) :: start
      character(len=:), allocatable, intent(inout) :: wrong

      call require(wrong, any(start%form == [0, CONTACT_DENSE, CONTACT_SPARSE]), 'form')
      if (allocated(wrong) .or. start%form == 0) return
      associate (n => data%line%n, m => size(data%line%point, kind=ip), n_normal => count(data%line%normal > 0, kind=ip))
         call require(wrong, is_list(start%state%q, m) .and. has_length(start%state%state, m), 'unknowns')
         if (allocated(wrong)) return
         call require(wrong, all(start%state%state >= FREE .and. start%state%state <= FROZEN), 'states of unknowns')
         call require(wrong, may_be(start%p, n) .and. may_be(start%tau, n) .and. may_be(start%t, n), 'stresses')
         call require(wrong, may_be(start%state%r, m) .and. may_be(start%state%shift, m) .and. may_be(start%bounds%lower, m) .and. &
                      may_be(start%bounds%upper, m) .and. may_be(start%bounds%d, m), 'bounds')
         call require(wrong, may_be(start%state%a, scene%n_rigid), 'amplitudes')
         if (allocated(start%is_shared)) call require(wrong, has_length(start%is_shared, m), 'is_shared')
         if (allocated(start%tangential_of)) then
            call require(wrong, has_length(start%tangential_of, n_normal), 'tangential_of')
            if (.not. allocated(wrong)) call require(wrong, all(start%tangential_of == tangential_of(data%line, n_normal)), &
                                                     'tangential_of')
         end if
         call require(wrong, is_finite([start%state%slack, start%residual, start%contraction]), 'residual')
      end associate
      if (.not. allocated(start%multipliers) .or. allocated(wrong)) return
      call check_multipliers(data, scene, start%multipliers, wrong)
   end subroutine check_line

   !> Those of the sparse form; what has not begun yet has no arrays.
   pure subroutine check_multipliers(data, scene, multipliers, wrong)
      type(scene_data_t), intent(in) :: data
      type(scene_t), intent(in) :: scene
      type(multiplier_t), intent(in) :: multipliers
      character(len=:), allocatable, intent(inout) :: wrong

      call require(wrong, is_finite([multipliers%r, multipliers%kappa]), 'multipliers')
      if (allocated(wrong)) return
      call require(wrong, min(multipliers%r, multipliers%kappa) >= 0.0_wp, 'multipliers')
      associate (m => size(data%line%point, kind=ip), k => scene%n_rigid)
         call require(wrong, may_be(multipliers%e, m) .and. may_be(multipliers%noise, m) .and. may_be(multipliers%q_old, m) .and. &
                      may_be(multipliers%stiffness, m) .and. may_be(multipliers%grew, m), 'multipliers')
         call require(wrong, may_be(multipliers%a_old, k) .and. may_be(multipliers%hold, k) .and. may_be(multipliers%pull, k), &
                      'multipliers')
         call require(wrong, may_be(multipliers%x, scene%n_dofs + k) .and. may_be(multipliers%went, scene%n_dofs + k) .and. &
                      may_be(multipliers%bound_grew, data%line%n), 'multipliers')
         if (allocated(multipliers%were)) call require(wrong, size(multipliers%were) == m, 'multipliers')
         if (allocated(wrong) .or. .not. allocated(multipliers%pair)) return
         call require(wrong, has_length(multipliers%pair, m), 'pair')
         if (allocated(wrong)) return
         call require(wrong, all(multipliers%pair == pairs_of_unknowns(data%line)) .and. &
                      multipliers%n_contact_pairs == last_contact_pair(data%line), 'pair')
         if (allocated(data%line%pair)) then
            call require(wrong, multipliers%n_pairs == maxval([data%line%pair, 0_ip]), 'n_pairs')
         else
            call require(wrong, multipliers%n_pairs == maxval([multipliers%pair, 0_ip]), 'n_pairs')
         end if
      end associate
   end subroutine check_multipliers

end module atrito_record_checks
