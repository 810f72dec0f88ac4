!> What goes to the terminal: messages, the words that say how grave they are in colours where it has them, failures, lines.
module atrito_console
   use, intrinsic :: iso_c_binding, only: c_int
   use, intrinsic :: iso_fortran_env, only: error_unit
   use atrito_command_line, only: command_t
   use atrito_kinds, only: ip
   use atrito_messages, only: json_of_message, message_t, count_messages, get_message, format_message, place_of_message, &
                              severity_word, SEVERITY_ERROR, SEVERITY_NOTE, MOST_ERRORS
   use atrito_reporter, only: reporter_t, begin_line, PROGRESS_ALL, PROGRESS_PHASES
   use atrito_status, only: status_t, STATUS_USAGE, STATUS_FILE
   use atrito_strings, only: string_t, to_text
   use atrito_system, only: c_is_terminal, c_terminal_width, hide_line
   use atrito_version, only: PROGRAM_NAME
   implicit none (type, external)
   private
   public :: print_messages, print_status, print_message, print_line, print_lines, paint_message, reporter_of

   integer(c_int), parameter :: STANDARD_ERROR = 2
   character(len=*), parameter :: ESCAPE = achar(27)//'['
   !> Bold red, bold magenta and bold cyan, as compilers have them (ECMA-48).
   character(len=5), parameter :: COLOURS(SEVERITY_NOTE) = ['1;31m', '1;35m', '1;36m']

   character(len=8), parameter :: WORDS(SEVERITY_NOTE) = ['errors  ', 'warnings', 'notes   ']

contains

   !> Prints the messages from number `first` on: the first errors, warnings and notes, and the count of the others; as JSON all
   !> that are kept.
   subroutine print_messages(quiet, first, json)
      logical, intent(in) :: quiet                  !< no notes
      integer(ip), intent(in) :: first              !< number of a message, from 1
      logical, intent(in) :: json                   !< one object a line
      type(message_t) :: message
      integer(ip) :: i, printed(SEVERITY_NOTE), n(SEVERITY_NOTE)
      integer :: pass

      n = 0
      do pass = 1, merge(1, 2, json)                ! the errors last, where they are looked for
         do i = first, count_messages()
            message = get_message(i)
            if (quiet .and. message%severity == SEVERITY_NOTE) cycle
            if (.not. json .and. ((message%severity == SEVERITY_ERROR) .neqv. pass == 2)) cycle
            n(message%severity) = n(message%severity) + 1
            if (json .or. n(message%severity) <= MOST_ERRORS) call print_message(message, json)
         end do
      end do
      if (json) then
         if (first == 1) call print_rest(quiet)
         return
      end if
      printed = min(n, int(MOST_ERRORS, ip))
      if (first == 1) where (n > 0) n = [(count_messages(int(i)), i=1, SEVERITY_NOTE)]   ! and those that are not kept
      do i = SEVERITY_NOTE, 1, -1
         if (n(i) > printed(i)) call print_line('... the first '//to_text(printed(i))//' of '//to_text(n(i))//' '//trim(WORDS(i)), &
                                                error_unit)
      end do
      if (n(SEVERITY_ERROR) > 0) call print_line(to_text(n(SEVERITY_ERROR))//' '// &
                                                 trim(merge('error ', 'errors', n(SEVERITY_ERROR) == 1))//' in the deck', &
                                                 error_unit)
   end subroutine print_messages

   !> One message, as text, for a terminal with colours, or as JSON.
   subroutine print_message(message, json)
      type(message_t), intent(in) :: message        !< of any severity
      logical, intent(in) :: json                   !< one object; else text
      type(string_t), allocatable :: lines(:)

      if (json) then
         call print_line(json_of_message(message), error_unit)
      else
         lines = format_message(message)
         if (c_is_terminal(STANDARD_ERROR) /= 0) lines = format_message(message, terminal_width())
         if (can_rewrite()) then
            if (len(variable('NO_COLOR')) == 0) lines(1)%s = paint_message(message, lines(1)%s)
         end if
         call print_lines(lines, error_unit)
      end if
   end subroutine print_message

   !> JSON: how many messages were counted only.
   subroutine print_rest(quiet)
      logical, intent(in) :: quiet
      type(message_t) :: message
      integer(ip) :: i, rest(SEVERITY_NOTE)

      rest = [(count_messages(int(i)), i=1, SEVERITY_NOTE)]
      do i = 1, count_messages()
         message = get_message(i)
         rest(message%severity) = rest(message%severity) - 1
      end do
      do i = 1, merge(SEVERITY_NOTE - 1, SEVERITY_NOTE, quiet)
         if (rest(i) == 0) cycle
         message = message_t(severity=int(i), id='N-MORE', text=to_text(rest(i))//' more '//trim(WORDS(i))//' are not told')
         call print_message(message, .true.)
      end do
   end subroutine print_rest

   !> Tells a failure that belongs to no place in the deck.
   subroutine print_status(status, file, json)
      type(status_t), intent(in) :: status          !< nothing is printed where its text is not allocated
      character(len=*), intent(in) :: file          !< the deck, as the user wrote it
      logical, intent(in) :: json                   !< one object; else text
      type(message_t) :: message
      character(len=*), parameter :: IDS(STATUS_FILE) = [character(len=15) :: 'E-COMMAND', 'E-DECK', 'E-NOT-CONVERGED', &
                                                                                                             'E-SINGULAR', 'E-FILE']

      if (.not. allocated(status%text)) return
      message%id = 'E-INTERNAL'
      if (status%code <= STATUS_FILE) message%id = trim(IDS(status%code))
      message%file = file
      if (status%code == STATUS_FILE .or. status%code == STATUS_USAGE) message%file = PROGRAM_NAME
      message%text = status%text
      call print_message(message, json)
   end subroutine print_status

   !> One line.
   subroutine print_line(text, unit)
      character(len=*), intent(in) :: text          !< without its end
      integer, intent(in) :: unit                   !< output_unit or error_unit
      type(string_t) :: lines(1)                    ! a constructor of strings is not given back (gfortran 12)

      lines(1)%s = text
      call print_lines(lines, unit)
   end subroutine print_line

   !> A failure to print is nobody's error.
   subroutine print_lines(lines, unit)
      type(string_t), intent(in) :: lines(:)        !< without their ends
      integer, intent(in) :: unit                   !< output_unit or error_unit
      integer :: i, ios

      call hide_line()
      do i = 1, size(lines)
         write (unit, '(a)', iostat=ios) lines(i)%s
         if (ios /= 0) return
      end do
      flush (unit, iostat=ios)                       ! a run that is interrupted later has told it
   end subroutine print_lines

   !> Columns of the terminal: as it says, as COLUMNS says, or 80.
   integer function terminal_width() result(width)
      character(len=:), allocatable :: columns
      integer :: ios

      width = int(c_terminal_width(STANDARD_ERROR))
      if (width > 0) return
      columns = variable('COLUMNS')
      read (columns, '(i9)', iostat=ios) width
      if (ios /= 0 .or. width <= 0) width = 80
   end function terminal_width

   !> Standard error is a terminal, which is not a dumb one.
   logical function can_rewrite()
      character(len=:), allocatable :: terminal

      can_rewrite = c_is_terminal(STANDARD_ERROR) /= 0
      if (.not. can_rewrite) return
      terminal = variable('TERM')
      can_rewrite = len(terminal) > 0 .and. terminal /= 'dumb'
   end function can_rewrite

   !> Who tells how the work of a command comes along.
   type(reporter_t) function reporter_of(command) result(reporter)
      type(command_t), intent(in) :: command        !< quiet, json and all_progress are read

      reporter%quiet = command%quiet .or. command%json
      reporter%form = merge(PROGRESS_ALL, PROGRESS_PHASES, command%all_progress)
      if (.not. (reporter%quiet .or. command%all_progress) .and. can_rewrite()) call begin_line(reporter)
   end function reporter_of

   !> A variable of the environment; empty where it is not set.
   function variable(name) result(value)
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: value
      integer :: length

      call get_environment_variable(name, length=length)
      allocate (character(len=length) :: value)
      if (length > 0) call get_environment_variable(name, value)
   end function variable

   !> The first line of a message, the word of its severity coloured.
   function paint_message(message, line) result(painted)
      type(message_t), intent(in) :: message        !< whose first line it is
      character(len=*), intent(in) :: line          !< as format_message gives it
      character(len=:), allocatable :: painted, word
      integer :: first

      painted = line
      word = severity_word(message%severity)
      first = len(place_of_message(message)) + 1
      if (len(line) < first + len(word)) return     ! the place is broken
      painted = line(:first - 1)//ESCAPE//COLOURS(message%severity)//word//ESCAPE//'0m'//line(first + len(word):)
   end function paint_message

end module atrito_console
