!> The command line, docs/user/running.md: what is to be done, with which options.
module atrito_command_line
   use atrito_element_table, only: kind_named
   use atrito_kinds, only: ip, wp
   use atrito_strings, only: string_t, append_string, nearest_names, to_text, deck_name, lower_case, upper_case, trimmed_strings
   use atrito_status, only: status_t
   use atrito_numbers, only: read_integer, read_real, NUMBER_OK
   use atrito_files, only: confine_files, file_exists, target_path, true_path
   use atrito_messages, only: message_t, SEVERITY_ERROR
   use atrito_number_text, only: LEAST_DIGITS, MOST_DIGITS, DEFAULT_DIGITS
   use atrito_option_table, only: OPTIONS, MOST_THREADS, MOST_LEVELS, MOST_STARTS, find_option, has_value, option_words, &
                                  place_of_word, value_text, TASKS, TASK_USAGE, TASK_RUN, TASK_CHECK, TASK_COMPARE, TASK_HELP, &
                                  TASK_SWEEP, TASK_STUDY, TASK_LIMIT, TASK_OPTIONS, TASK_VERSION, task_named, command_names, &
                                  task_form, task_text
   use atrito_plot_view, only: plot_view_t, read_box
   use atrito_show, only: is_view
   use atrito_compare, only: DEFAULT_RTOL, DEFAULT_ATOL
   implicit none (type, external)
   private
   public :: command_t, parse_command, wrong, wants_json, fetch_arguments, output_folder, confine_command
   public :: TASK_USAGE, TASK_RUN, TASK_CHECK, TASK_COMPARE, TASK_HELP, TASK_SWEEP, TASK_STUDY, TASK_LIMIT, TASK_OPTIONS, &
             TASK_VERSION

   real(wp), parameter :: MOST_SCALE = 1.0e30_wp
   real(wp), parameter :: LEAST_PERCENT = 1.0e-6_wp
   real(wp), parameter :: LEAST_TOLERANCE = 1.0e-8_wp, MOST_TOLERANCE = 0.1_wp   !< the proof is good for 1e-9

   !> What the user asks for.
   type :: command_t
      integer :: task = TASK_USAGE                  !< TASK_*
      type(string_t), allocatable :: names(:)       !< deck; the two paths to compare; the words behind `help`
      character(len=:), allocatable :: folder       !< -o; not allocated: the default
      character(len=:), allocatable :: restart      !< file of --restart; not allocated: from the beginning
      character(len=:), allocatable :: confine      !< folder of --confine; not allocated: reads what the deck names
      type(string_t), allocatable :: settings(:)    !< NAME=VALUE of --set, in their order
      character(len=7) :: solver = 'auto'           !< one of the words of --solver
      character(len=6) :: contact = 'auto'          !< one of the words of --contact
      character(len=4) :: proof = 'auto'            !< one of the words of --proof
      character(len=4) :: share = 'auto'            !< one of the words of --share
      type(string_t), allocatable :: observe(:)     !< NAME=EXPRESSION of --observe, in their order
      type(string_t), allocatable :: bound(:)       !< names of --bound
      type(string_t), allocatable :: show(:)        !< views of --show, in their order
      type(string_t), allocatable :: vary(:)        !< NAME=v1,v2,... of --vary, in their order; of a limit NAME=a:b
      real(wp) :: limit_tolerance = 1.0e-6_wp       !< of a limit
      integer(ip) :: watched(2) = 0                 !< of a limit: node and dof; 0: the largest displacement
      integer(ip) :: threads = 1                    !< cores of a run; of a sweep runs side by side
      integer(ip) :: n_on_host = 1                  !< ranks of the first one's host, itself among them: no option
      integer(ip) :: refine = 0                     !< levels: each element into 4**refine
      real(wp) :: adapt = 0.0_wp                    !< percent of the error, down to which the mesh follows it; 0: it does not
      integer(ip) :: starts = 0                     !< of a search for other solutions; 0: as the deck asks
      integer(ip) :: shape = 0                      !< nodes of all elements, set by a study; 0: as in the deck
      integer(ip) :: state = 0                      !< and their state
      character(len=5) :: element = ''              !< their name, set by a study
      integer(ip) :: levels = 0                     !< of a study
      type(string_t), allocatable :: elements(:)    !< of a study: cpe4, ...
      type(string_t), allocatable :: references(:)  !< of a study: QUANTITY or QUANTITY=VALUE
      integer(ip) :: digits = DEFAULT_DIGITS        !< of the tables
      logical :: is_csv = .false.                   !< of the tables: comma-separated values
      logical :: quiet = .false.                    !< no progress, notes and summary on the screen
      logical :: all_progress = .false.             !< a line an iteration, also at a terminal
      logical :: plot = .false.                     !< pictures by gnuplot
      type(plot_view_t) :: view                     !< what is asked of those of bodies
      logical :: report = .false.                   !< a page of HTML with everything, pictures too
      logical :: resume = .false.                   !< of a sweep: runs that were done before are left alone
      logical :: on_one_rank = .false.              !< a run of a sweep or a study, which are shared out over ranks as wholes
      logical :: json = .false.                     !< messages as JSON
      real(wp) :: rtol = DEFAULT_RTOL, atol = DEFAULT_ATOL !< of compare: relative to a column's largest; absolute
      character(len=:), allocatable :: tolerances, tables, ignore !< of compare; not allocated: not given
   end type command_t

   !> An option as it was given.
   type :: given_t
      integer :: option = 0                         !< place in OPTIONS
      character(len=:), allocatable :: value        !< behind it; not allocated: it has none
   end type given_t

contains

   !> The arguments of the program.
   subroutine fetch_arguments(arguments)
      type(string_t), allocatable, intent(out) :: arguments(:) !< in their order, of any length
      integer :: i, length

      allocate (arguments(command_argument_count()))
      do i = 1, size(arguments)
         call get_command_argument(i, length=length)
         allocate (character(len=length) :: arguments(i)%s)
         if (length > 0) call get_command_argument(i, arguments(i)%s)
      end do
   end subroutine fetch_arguments

   !> Understands the arguments. ok is false when they are wrong, and error says how.
   subroutine parse_command(arguments, command, ok, error)
      type(string_t), intent(in) :: arguments(:)    !< of fetch_arguments
      type(command_t), intent(out) :: command       !< of no use where not ok
      logical, intent(out) :: ok                    !< nothing is wrong with them
      type(message_t), intent(out) :: error         !< its text is allocated where there is one, as in all procedures below
      type(given_t), allocatable :: given(:)
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (command%settings(0), command%observe(0), command%show(0), command%vary(0), command%names(0), command%elements(0))
      allocate (command%references(0), command%bound(0))
      call sort_arguments(arguments, names, given, error)
      ok = .not. allocated(error%text)
      if (.not. ok) return
      if (any(OPTIONS(given%option)%name == '--help')) command%task = TASK_OPTIONS
      if (any(OPTIONS(given%option)%name == '--version')) command%task = TASK_VERSION
      if (command%task /= TASK_USAGE .or. size(arguments) == 0) return
      call find_task()
      do i = 1, size(given)
         if (.not. allocated(error%text)) call take_option(given(i), command, error)
      end do
      if (.not. allocated(error%text)) call check_command()
      ok = .not. allocated(error%text)

   contains

      !> What options have to do with each other and with the command.
      subroutine check_command()

         if (command%task == TASK_SWEEP .and. size(command%vary) == 0) then
            error = wrong('a sweep needs the parameter that it varies', expected=task_form(TASK_SWEEP))
         else if (command%task == TASK_STUDY .and. command%levels == 0) then
            error = wrong('a study needs the number of its levels', expected=task_form(TASK_STUDY))
         else if ((allocated(command%view%scale) .or. allocated(command%view%box) .or. command%view%labels) &
                  .and. .not. command%plot) then
            error = wrong('--plot-scale, --plot-box and --plot-labels are of pictures', expected='--plot besides')
         else if (command%task == TASK_LIMIT .and. size(command%vary) /= 1) then
            error = wrong('a limit needs the one parameter that it varies', expected=task_form(TASK_LIMIT))
         else if (command%task == TASK_CHECK .and. allocated(command%folder) .and. .not. command%plot) then
            error = wrong('-o is no option of atrito check without --plot', expected='atrito check DECK.inp --plot -o DIR')
         end if
      end subroutine check_command

      !> The first name says what is to be done; the others are its objects.
      subroutine find_task()

         if (size(names) == 0) then
            error = wrong('there is no deck', expected=task_form(TASK_RUN))
            return
         end if
         command%task = task_named(names(1)%s)
         command%names = names(merge(1, 2, command%task == TASK_RUN):)
         if (command%task == TASK_COMPARE) then
            if (size(command%names) /= 2) error = wrong('compare takes two names, not '//to_text(size(command%names, kind=ip)), &
                                                        expected=task_form(TASK_COMPARE))
         else if (command%task /= TASK_HELP) then
            call check_deck(command%names, command%task)
         end if
      end subroutine find_task

      !> One deck; a word that is no file but nearly a command is a misspelt command.
      subroutine check_deck(names, task)
         type(string_t), intent(in) :: names(:)
         integer, intent(in) :: task
         type(string_t), allocatable :: near(:)

         if (size(names) == 0) then
            error = wrong('there is no deck', expected=task_form(task))
            return
         end if
         allocate (near(0))
         if (scan(names(1)%s, './') == 0) then
            if (.not. file_exists(names(1)%s)) near = nearest_names(names(1)%s, command_names(), 2)
         end if
         if (size(near) > 0) then
            error = wrong('unknown command '//names(1)%s, nearest=near)
         else if (size(names) > 1) then
            error = wrong('one deck at a time; '//names(2)%s//' is too much', expected=task_form(task))
         else if (len_trim(names(1)%s) == 0) then
            error = wrong('the name of the deck is empty', expected=task_form(task))
         end if
      end subroutine check_deck
   end subroutine parse_command

   !> The messages are to be JSON, also one about the command line itself.
   pure logical function wants_json(arguments)
      type(string_t), intent(in) :: arguments(:)    !< of fetch_arguments
      integer :: i

      wants_json = .false.
      do i = 1, size(arguments)
         if (arguments(i)%s == '--messages=json') wants_json = .true.
         if (arguments(i)%s == 'json' .and. i > 1) wants_json = wants_json .or. arguments(max(i - 1, 1))%s == '--messages'
      end do
   end function wants_json

   !> Sorts arguments into names and options with their values; behind `--` there are names alone.
   subroutine sort_arguments(arguments, names, given, error)
      type(string_t), intent(in) :: arguments(:)
      type(string_t), allocatable, intent(out) :: names(:)
      type(given_t), allocatable, intent(out) :: given(:)
      type(message_t), intent(inout) :: error
      logical :: only_names
      integer :: i

      allocate (names(0), given(0))
      only_names = .false.
      i = 1
      do while (i <= size(arguments) .and. .not. allocated(error%text))
         associate (argument => arguments(i)%s)
            if (argument == '--' .and. .not. only_names) then
               only_names = .true.
            else if (only_names .or. len(argument) < 2 .or. index(argument, '-') /= 1) then
               call append_string(names, argument)
            else
               call read_option()
            end if
         end associate
         i = i + 1
      end do

   contains

      !> Adds the option at place i: `--name value`, `--name=value` or `--name`.
      subroutine read_option()
         type(given_t) :: one
         character(len=:), allocatable :: name
         integer :: equals

         equals = index(arguments(i)%s, '=')
         name = arguments(i)%s
         if (equals > 0) name = arguments(i)%s(:equals - 1)
         one%option = find_option(name)
         if (one%option == 0) then
            error = wrong('unknown option '//name, nearest=nearest_names(name, trimmed_strings(OPTIONS%name), 3))
         else if (.not. has_value(one%option)) then
            if (equals > 0) error = wrong(name//' takes no value')
         else if (equals > 0) then
            one%value = arguments(i)%s(equals + 1:)
         else
            i = i + 1
            if (i <= size(arguments)) then
               if (index(arguments(i)%s, '--') /= 1) one%value = arguments(i)%s
            end if
            if (.not. allocated(one%value)) error = wrong(name//' needs a value', expected=value_text(one%option))
         end if
         given = [given, one]
      end subroutine read_option
   end subroutine sort_arguments

   !> An error of the command line.
   function wrong(text, expected, nearest) result(error)
      character(len=*), intent(in) :: text               !< what is wrong
      character(len=*), intent(in), optional :: expected !< what should stand there; left out: nothing is told
      type(string_t), intent(in), optional :: nearest(:) !< names that may be meant
      type(message_t) :: error

      error%severity = SEVERITY_ERROR
      error%id = 'E-COMMAND'
      error%file = 'atrito'
      error%text = text
      if (present(expected)) error%expected = expected
      if (present(nearest)) error%nearest = nearest
   end function wrong

   !> Puts an option where it belongs.
   subroutine take_option(given, command, error)
      type(given_t), intent(in) :: given
      type(command_t), intent(inout) :: command
      type(message_t), intent(inout) :: error
      character(len=:), allocatable :: name
      integer :: i
      logical :: ok

      name = trim(OPTIONS(given%option)%name)
      if (.not. OPTIONS(given%option)%for_task(command%task)) then
         error = wrong(name//' is no option of '//task_text(command%task))
         return
      end if
      select case (name)
      case ('-o')
         command%folder = without_slash(given%value)
         ok = len(command%folder) > 0
      case ('--restart')
         command%restart = given%value
         ok = len_trim(given%value) > 0
      case ('--tolerances')
         command%tolerances = given%value
         ok = len_trim(given%value) > 0
      case ('--tables')
         command%tables = given%value
         ok = len_trim(given%value) > 0
      case ('--ignore')
         command%ignore = given%value
         ok = len_trim(given%value) > 0
      case ('--confine')
         command%confine = without_slash(given%value)
         ok = len(command%confine) > 0
      case ('--set')
         call append_string(command%settings, given%value)
         ok = index(given%value, '=') > 1
      case ('--observe')
         call append_string(command%observe, given%value)
         ok = index(given%value, '=') > 1
      case ('--bound')
         call take_names(given%value, command%bound, ok)
      case ('--show')
         call append_string(command%show, given%value)
         ok = is_view(given%value)
      case ('--vary')
         call append_string(command%vary, given%value)
         ok = index(given%value, '=') > 1
      case ('--reference')
         call append_string(command%references, given%value)
         ok = len_trim(given%value) > 0 .and. index(given%value, '=') /= 1
      case ('--watch')
         call take_watched(given%value, command%watched, ok)
      case ('--elements')
         call take_names(lower_case(given%value), command%elements, ok)
         ok = ok .and. all([(kind_named(upper_case(command%elements(i)%s)) > 0, i=1, size(command%elements))])
      case ('--solver', '--contact', '--proof', '--share', '--format', '--messages', '--progress')
         call take_word(name, given%value, command, ok)
      case ('--plot-box')
         call read_box(given%value, command%view%box, ok)
      case default
         ok = .true.
         command%plot = command%plot .or. name == '--plot' .or. name == '--report'
         command%report = command%report .or. name == '--report'
         command%view%labels = command%view%labels .or. name == '--plot-labels'
         command%quiet = command%quiet .or. name == '--quiet'
         command%resume = command%resume .or. name == '--resume'
         if (allocated(given%value)) call take_number(name, given%value, command, ok)
      end select
      if (ok) return
      error = wrong(name//' '//given%value//' is not possible', expected=value_text(given%option))
      if (name == '--solver') error = wrong('unknown solver '//given%value, expected=value_text(given%option), &
                                            nearest=nearest_names(given%value, option_words(given%option), 2))
   end subroutine take_option

   !> The options whose value is one of their words.
   subroutine take_word(name, value, command, ok)
      character(len=*), intent(in) :: name, value
      type(command_t), intent(inout) :: command
      logical, intent(out) :: ok

      ok = place_of_word(name, value) > 0
      if (.not. ok) return
      select case (name)
      case ('--solver')
         command%solver = value
      case ('--contact')
         command%contact = value
      case ('--proof')
         command%proof = value
      case ('--share')
         command%share = value
      case ('--format')
         command%is_csv = value == 'csv'
      case ('--messages')
         command%json = value == 'json'
      case ('--progress')
         command%all_progress = value == 'all'
      end select
   end subroutine take_word

   !> The options whose value is a number.
   subroutine take_number(name, value, command, ok)
      character(len=*), intent(in) :: name, value
      type(command_t), intent(inout) :: command
      logical, intent(out) :: ok

      select case (name)
      case ('--refine')
         call take_integer(value, 0, MOST_LEVELS, command%refine, ok)
      case ('--adapt')
         call take_real(value, LEAST_PERCENT, 100.0_wp, command%adapt, ok)
      case ('--unique')
         call take_integer(value, 1, MOST_STARTS, command%starts, ok)
      case ('--levels')
         call take_integer(value, 1, MOST_LEVELS, command%levels, ok)
      case ('--threads')
         call take_integer(value, 1, MOST_THREADS, command%threads, ok)
      case ('--digits')
         call take_integer(value, LEAST_DIGITS, MOST_DIGITS, command%digits, ok)
      case ('--tolerance')
         call take_real(value, LEAST_TOLERANCE, MOST_TOLERANCE, command%limit_tolerance, ok)
      case ('--plot-scale')
         command%view%scale = 0.0_wp
         call take_real(value, 0.0_wp, MOST_SCALE, command%view%scale, ok)
      case ('--rtol')
         call take_real(value, 0.0_wp, 1.0_wp, command%rtol, ok)
      case ('--atol')
         call take_real(value, 0.0_wp, huge(1.0_wp), command%atol, ok)
      end select
   end subroutine take_number

   !> NODE,DOF
   subroutine take_watched(value, watched, ok)
      character(len=*), intent(in) :: value
      integer(ip), intent(inout) :: watched(2)
      logical, intent(out) :: ok
      integer :: comma

      comma = index(value, ',')
      ok = comma > 1
      if (ok) call take_integer(value(:comma - 1), 1, huge(1_ip), watched(1), ok)
      if (ok) call take_integer(value(comma + 1:), 1, 2, watched(2), ok)
   end subroutine take_watched

   !> Names with commas between them, behind those before; each once.
   pure subroutine take_names(value, names, ok)
      character(len=*), intent(in) :: value
      type(string_t), allocatable, intent(inout) :: names(:)
      logical, intent(out) :: ok
      integer :: first, last, i

      ok = .true.
      first = 1
      do while (first <= len(value) + 1 .and. ok)
         last = first + index(value(first:)//',', ',') - 2
         call append_string(names, trim(adjustl(value(first:last))))
         associate (n => size(names))
            ok = len(names(n)%s) > 0 .and. all([(lower_case(names(i)%s) /= lower_case(names(n)%s), i=1, n - 1)])
         end associate
         first = last + 2
      end do
   end subroutine take_names

   subroutine take_integer(text, least, most, value, ok)
      character(len=*), intent(in) :: text
      integer, intent(in) :: least, most
      integer(ip), intent(inout) :: value
      logical, intent(out) :: ok
      integer(ip) :: found
      integer :: outcome

      call read_integer(text, found, outcome)
      ok = outcome == NUMBER_OK .and. found >= least .and. found <= most
      if (ok) value = found
   end subroutine take_integer

   subroutine take_real(text, least, most, value, ok)
      character(len=*), intent(in) :: text
      real(wp), intent(in) :: least, most
      real(wp), intent(inout) :: value
      logical, intent(out) :: ok
      real(wp) :: found
      integer :: outcome

      call read_real(text, found, outcome)
      ok = outcome == NUMBER_OK .and. found >= least .and. found <= most
      if (ok) value = found
   end subroutine take_real

   !> Where the tables go: -o, or output/ and the name of the deck without folder and .inp; what is no run has a folder apart, so
   !> that none finds the files of another.
   pure function output_folder(command) result(folder)
      type(command_t), intent(in) :: command        !< its folder, task and deck are read
      character(len=:), allocatable :: folder

      if (allocated(command%folder)) then
         folder = command%folder
      else
         folder = 'output/'//deck_name(command%names(1)%s)
         if (command%task > TASK_RUN) folder = folder//'-'//trim(TASKS(command%task)%name)
      end if
   end function output_folder

   !> What --confine asks for. Where -o is not given the output has its place below the present folder, wherever links may lead.
   !> status: STATUS_FILE where there is no such folder.
   subroutine confine_command(command, status)
      type(command_t), intent(in) :: command        !< confine, folder and names are read
      type(status_t), intent(out) :: status         !< STATUS_OK or STATUS_FILE
      character(len=:), allocatable :: output

      if (.not. allocated(command%confine)) return
      output = true_path('.')//'/'
      if (size(command%names) > 0) output = output//output_folder(command)
      if (allocated(command%folder)) output = target_path(command%folder)
      call confine_files(command%confine, output, status)
   end subroutine confine_command

   !> A folder without the slash at its end.
   pure function without_slash(path) result(folder)
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: folder

      folder = path
      do while (len(folder) > 1)
         if (folder(len(folder):) /= '/') exit
         folder = folder(:len(folder) - 1)
      end do
   end function without_slash

end module atrito_command_line
