!> What a study is going to do: its quantities and its runs.
module atrito_study_plan
   use atrito_command_line, only: command_t
   use atrito_kinds, only: ip, wp
   use atrito_numbers, only: read_real, NUMBER_OK
   use atrito_observations, only: observation_name
   use atrito_series, only: find_observed
   use atrito_status, only: status_t, set_status, is_ok, STATUS_USAGE
   use atrito_strings, only: string_t, append_string, join, nearest_names
   use atrito_study_errors, only: study_t
   use atrito_summary, only: quantity_names
   implicit none (type, external)
   private
   public :: plan_study, DECK_ELEMENTS

   character(len=*), parameter :: DECK_ELEMENTS = 'deck'   !< instead of a kind of element: as in the deck
   character(len=*), parameter :: ADAPTED = 'adapt'  !< the same, cut where the error is

contains

   !> status: STATUS_USAGE of a reference that means nothing.
   subroutine plan_study(asked, command, study, status)
      type(command_t), intent(in) :: asked          !< as the user gave it
      type(command_t), intent(out) :: command       !< of all runs
      type(study_t), intent(out) :: study           !< with quantities and rows
      type(status_t), intent(out) :: status         !< STATUS_OK or STATUS_USAGE
      integer(ip) :: k

      command = asked
      ! one solver on all levels: another one from some level on would put a step into the times
      if (command%solver == 'auto') command%solver = 'sparse'
      call choose_quantities(command, study, status)
      if (.not. is_ok(status)) return
      study%elements = command%elements
      if (size(study%elements) == 0) call append_string(study%elements, DECK_ELEMENTS)
      if (command%adapt > 0.0_wp) call append_string(study%elements, ADAPTED)
      allocate (study%rows(size(study%elements)*command%levels))
      do k = 1, size(study%rows, kind=ip)            ! every element at every level
         study%rows(k)%level = mod(k - 1, command%levels)
         study%rows(k)%element = study%elements((k - 1)/command%levels + 1)%s
         study%rows(k)%is_adapted = study%rows(k)%element == ADAPTED
      end do
   end subroutine plan_study

   !> --reference QUANTITY[=VALUE]; without any the energy and the resultants of the first pair. What is observed is studied in any
   !> case.
   subroutine choose_quantities(command, study, status)
      type(command_t), intent(in) :: command
      type(study_t), intent(inout) :: study
      type(status_t), intent(out) :: status
      type(string_t), allocatable :: list(:), observed(:)
      integer :: i, equals, outcome

      call find_observed(command, observed)
      call list_references(list)
      allocate (study%quantities(size(list)))
      do i = 1, size(list)
         associate (quantity => study%quantities(i))
            equals = index(list(i)%s, '=')
            quantity%name = observation_name(list(i)%s)
            call check_name(quantity%name)
            if (.not. is_ok(status)) return
            if (equals == 0) cycle
            quantity%is_given = .true.
            quantity%source = 'given'
            call read_real(list(i)%s(equals + 1:), quantity%reference, outcome)
            if (outcome == NUMBER_OK) cycle
            call set_status(status, STATUS_USAGE, '--reference '//list(i)%s//': QUANTITY=VALUE with a number is expected')
            return
         end associate
      end do

   contains

      !> The references, then what is observed and not among them; without any reference the energy and the resultants last.
      subroutine list_references(list)
         type(string_t), allocatable, intent(out) :: list(:)
         integer :: i, k

         list = command%references
         do i = 1, size(observed)
            do k = 1, size(command%references)
               if (observation_name(command%references(k)%s) == observed(i)%s) exit
            end do
            if (k > size(command%references)) call append_string(list, observed(i)%s)
         end do
         if (size(command%references) > 0) return
         call append_string(list, 'strain_energy')
         call append_string(list, 'normal_resultant')
      end subroutine list_references

      subroutine check_name(name)
         character(len=*), intent(in) :: name
         type(string_t), allocatable :: names(:), near(:)
         character(len=:), allocatable :: text
         integer :: i

         names = quantity_names()
         do i = 1, size(observed)
            call append_string(names, observed(i)%s)
         end do
         do i = 1, size(names)
            if (names(i)%s == name) return
         end do
         text = '--reference '//name//': summary.tab has no such quantity'
         near = nearest_names(name, names, 3)
         if (size(near) > 0) text = text//'; nearest: '//join(near, ', ')
         call set_status(status, STATUS_USAGE, text)
      end subroutine check_name
   end subroutine choose_quantities

end module atrito_study_plan
