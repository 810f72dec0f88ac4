!> What the program can be asked to do: the commands, and the options with what their values may be, what they are for and which
!> commands know them. The command line, `--help`, the manual page and the completion of bash are made from these two tables.
module atrito_option_table
   use atrito_strings, only: string_t, append_string, join, trimmed_strings
   implicit none (type, external)
   private
   public :: TASK_USAGE, TASK_RUN, TASK_CHECK, TASK_COMPARE, TASK_HELP, TASK_SWEEP, TASK_STUDY, TASK_LIMIT, TASK_OPTIONS, &
             TASK_VERSION, TASKS, task_named, command_names, task_form, called, task_text
   public :: OPTIONS, MOST_THREADS, MOST_LEVELS, MOST_STARTS, VALUE_FOLDER, VALUE_FILE
   public :: find_option, has_value, option_words, place_of_word, value_text, option_text, phrase_text
   public :: option_group_t, group_options

   integer, parameter :: TASK_USAGE = 0             !< nothing was asked: tell how, exit 1
   integer, parameter :: TASK_RUN = 1, TASK_CHECK = 2, TASK_COMPARE = 3, TASK_HELP = 4, TASK_SWEEP = 5, TASK_STUDY = 6, &
                         TASK_LIMIT = 7
   integer, parameter :: TASK_OPTIONS = 8           !< --help
   integer, parameter :: TASK_VERSION = 9           !< --version

   type :: task_t
      character(len=7) :: name                      !< the command; '': a run has none
      character(len=11) :: objects                  !< the names behind it
      character(len=51) :: options                  !< what stands behind these
      character(len=58) :: phrase                   !< what it does
   end type task_t

   type(task_t), parameter :: TASKS(TASK_LIMIT) = [ &
                              task_t('', 'DECK.inp', '[options]', 'solve the deck and write tables'), &
                              task_t('check', 'DECK.inp', '[options]', 'read and check all, tell what the scene needs'), &
                              task_t('compare', 'A B', '[--rtol R] [--atol A]', 'compare two tables, or two folders of them'), &
                              task_t('help', '[WORD]', '', 'a keyword of decks, a command, an option; all: all'), &
             task_t('sweep', 'DECK.inp', '--vary NAME=v1,v2,... [options]', 'one run a value of a parameter: --vary NAME=v1,...'), &
              task_t('study', 'DECK.inp', '--levels N [--elements LIST] [--reference Q=V]', 'error against run time: --levels N'), &
                              task_t('limit', 'DECK.inp', '--vary NAME=a:b [--tolerance T] [--watch NODE,DOF]', &
                                     'where a scene ceases to stand: --vary NAME=a:b')]

   integer, parameter :: MOST_THREADS = 1024
   integer, parameter :: MOST_STARTS = 100000       !< of --unique
   integer, parameter :: MOST_LEVELS = 12           !< of --refine: 16 million elements of one
   character(len=*), parameter :: VALUE_FOLDER = 'DIR', VALUE_FILE = 'FILE'    !< names of values that are paths

   !> An option, and which tasks know it.
   type :: option_t
      character(len=13) :: name                     !< with --
      character(len=13) :: value                    !< how its value is called, VALUE_... where it is a path; '': it has none
      logical :: for_task(TASK_LIMIT)               !< run, check, compare, help, sweep, study, limit
      character(len=130) :: phrase                  !< what it is for
      character(len=84) :: expected = ''            !< what its value may be; behind `words`, where there are any
      character(len=80) :: default = ''             !< what holds without it
      character(len=40) :: words = ''               !< the words that its value may be, blanks between them
      character(len=2) :: short = ''                !< another name
   end type option_t

   logical, parameter :: Y = .true., N = .false.
   type(option_t), parameter :: OPTIONS(*) = [ &
                                option_t('-o', VALUE_FOLDER, [Y, Y, N, N, Y, Y, Y], 'folder of the tables', &
                                         default='./output/<deck>; of sweep, study, limit and check ./output/<deck>-sweep, ...', &
                                         expected='a folder; it is made where it is missing'), &
                      option_t('--set', 'NAME=VALUE', [Y, Y, N, N, Y, Y, Y], 'value of a *PARAMETER of the deck; may be repeated', &
                                         expected='NAME=VALUE, VALUE an expression of numbers'), &
                                option_t('--observe', 'NAME=EXPR', [Y, Y, N, N, Y, Y, Y], &
                                         'a number of your own, as tip=u2(1.0, 0.05), in the tables; may be repeated', &
                                         expected='NAME=EXPRESSION, such as tip=u2(1.0, 0.05) or peak=max(mises, BEAM)'), &
                       option_t('--bound', 'NAMES', [Y, N, N, N, N, N, N], 'proved bounds of observed quantities that are linear', &
                                         expected='names of observed quantities, commas between them'), &
                   option_t('--refine', 'K', [Y, Y, N, N, Y, Y, Y], 'each element into 4, K times; all else follows', default='0', &
                                         expected='a whole number, 0 to 12: each element into 4, so many times'), &
                                option_t('--adapt', 'P', [Y, N, N, N, N, Y, N], &
                                         'elements are cut where the error is, until its estimate is at most P percent', &
                                         expected='a number, 1e-6 to 100: percent of the error in the energy norm'), &
                                option_t('--solver', 'NAME', [Y, Y, N, N, Y, Y, Y], 'solver of the bodies', default='auto', &
                                         words='auto skyline banded sparse'), &
                                option_t('--contact', 'NAME', [Y, Y, N, N, Y, Y, Y], 'form of the contact system', default='auto', &
                                         words='auto dense sparse'), &
                         option_t('--proof', 'NAME', [Y, N, N, N, Y, Y, N], 'a bound of the error that is proved', default='auto', &
                                         words='auto on off'), &
            option_t('--share', 'NAME', [Y, N, N, N, N, N, N], 'one scene over the ranks of atrito-mpi: large ones, all, or none', &
                                         default='auto', words='auto all none'), &
                 option_t('--threads', 'N', [Y, Y, N, N, Y, Y, Y], 'cores of a run, or runs of a sweep side by side', default='1', &
                                         expected='a whole number, 1 to 1024'), &
                       option_t('--digits', 'N', [Y, N, N, N, Y, Y, Y], 'significant digits of the tables, 6 to 17', default='10', &
                                         expected='a whole number, 6 to 17'), &
                option_t('--format', 'NAME', [Y, N, N, N, Y, Y, Y], 'tables as text, or as comma-separated values', default='tab', &
                                         words='tab csv'), &
                             option_t('--unique', 'N', [Y, N, N, N, Y, Y, N], 'looks for other solutions, from N starts: 40, say', &
                                         expected='a whole number, 1 to 100000: starts of the search'), &
      option_t('--plot', '', [Y, Y, N, N, Y, Y, Y], 'pictures by gnuplot, in DIR/plots; of check: the scene before it is solved'), &
                                option_t('--plot-scale', 'S', [Y, N, N, N, N, N, Y], 'displacements are drawn S times as large', &
                   default='chosen by their size', expected='a number, 0 or more, by which displacements are drawn; with --plot'), &
                       option_t('--plot-box', 'X1,Y1,X2,Y2', [Y, Y, N, N, N, N, Y], 'what pictures of bodies show', default='all', &
                                         expected='x1,y1,x2,y2, two corners of what pictures show; with --plot'), &
                       option_t('--plot-labels', '', [Y, Y, N, N, N, N, N], 'numbers and names in the pictures of mesh or scene'), &
                                option_t('--show', 'VIEW', [Y, N, N, N, N, N, N], &
                                         'a look inside a small scene, on the screen and in tables; may be repeated', &
                                         expected='element=N, matrix, line, states, law or picard'), &
                     option_t('--report', '', [Y, N, N, N, Y, Y, Y], 'all in one page, DIR/report.html; draws the pictures, too'), &
               option_t('--restart', VALUE_FILE, [Y, N, N, N, N, N, N], 'go on behind the increment in a file of *RESTART, WRITE', &
                                         expected='a restart file of this deck, NAME.restart.h5'), &
                                option_t('--confine', VALUE_FOLDER, [Y, Y, N, N, Y, Y, Y], &
                                         'for decks that are not trusted: reads nothing outside DIR, writes nothing outside -o', &
                                         expected='a folder, which holds the deck and all that it includes'), &
                                option_t('--progress', 'NAME', [Y, N, N, N, Y, Y, Y], &
                                         'a line that is rewritten at a terminal, else a line a phase; or a line an iteration', &
                                         default='auto', words='auto all'), &
                         option_t('--quiet', '', [Y, Y, Y, N, Y, Y, Y], 'no progress, no notes, no summary; warnings and errors'), &
                                option_t('--vary', 'NAME=VALUES', [N, N, N, N, Y, N, Y], &
                                'values of a *PARAMETER: v1,v2,... of a sweep (several --vary: all combinations), a:b of a limit', &
                                     expected='NAME=v1,v2,..., values of a parameter of the deck, each an expression of numbers'), &
                                option_t('--resume', '', [N, N, N, N, Y, N, N], &
                                         'leave the runs alone that an earlier sweep of the same deck and options has made'), &
                               option_t('--levels', 'N', [N, N, N, N, N, Y, N], 'so many meshes, each of four times the elements', &
                                         expected='a whole number, 1 to 12: so many meshes, each with four elements for one'), &
                      option_t('--elements', 'LIST', [N, N, N, N, N, Y, N], 'the elements of these meshes', default='the deck''s', &
                                         words='cpe4 cps4 cpe8 cps8 cpe9 cps9', expected='several with commas between them'), &
                                option_t('--reference', 'Q=V', [N, N, N, N, N, Y, N], &
                                         'exact value of a quantity of summary.tab; Q alone: extrapolated; may be repeated', &
                                         expected='QUANTITY or QUANTITY=VALUE, a quantity of summary.tab'), &
      option_t('--tolerance', 'T', [N, N, N, N, N, N, Y], 'width of the interval round the limit, over the limit', default='1e-6', &
                                         expected='a number, 1e-8 to 0.1: of the interval round the limit, over the limit'), &
                        option_t('--watch', 'NODE,DOF', [N, N, N, N, N, N, Y], 'displacement of the curve', default='the largest', &
                                         expected='NODE,DOF: a node of the deck, and 1 or 2'), &
      option_t('--rtol', 'R', [N, N, Y, N, N, N, N], 'differences allowed, relative to the largest of the column', default='1e-6', &
                                         expected='a number, 0 to 1'), &
                                option_t('--atol', 'A', [N, N, Y, N, N, N, N], 'differences allowed, absolute', default='0', &
                                         expected='a number, not negative'), &
                                option_t('--tolerances', VALUE_FILE, [N, N, Y, N, N, N, N], 'tolerances by table and column', &
                                         expected='a file with a line a rule, TABLE COLUMN RTOL [ATOL], * for any'), &
                                option_t('--tables', 'LIST', [N, N, Y, N, N, N, N], 'the tables that are compared', default='all', &
                                         expected='names of tables, commas between them'), &
                                option_t('--ignore', 'LIST', [N, N, Y, N, N, N, N], 'tables, or columns of them, that are not', &
                                         expected='TABLE or TABLE.COLUMN, commas between them'), &
         option_t('--messages', 'NAME', [Y, Y, Y, Y, Y, Y, Y], 'messages on standard error as text, or one object of JSON a line', &
                                         default='text', words='text json'), &
                                option_t('--help', '', [Y, Y, Y, Y, Y, Y, Y], 'commands, options and exit codes', short='-h'), &
                        option_t('--version', '', [Y, Y, Y, Y, Y, Y, Y], 'version of the program and of its libraries', short='-V')]

   !> Options that the same commands know, as `--help` and the manual page list them.
   type :: option_group_t
      character(len=:), allocatable :: title        !< `options of a run`
      integer, allocatable :: options(:)            !< places in OPTIONS
      character(len=:), allocatable :: others       !< which of them the other commands know; '': not to be told
   end type option_group_t

contains

   !> The task of a command; a word that is none is the deck of a run.
   pure integer function task_named(word) result(task)
      character(len=*), intent(in) :: word

      task = TASK_RUN
      if (len_trim(word) > 0) task = max(TASK_RUN, findloc(TASKS%name == word, .true., dim=1))
   end function task_named

   !> The words that commands begin with: check, compare, help, ...
   pure function command_names() result(names)
      type(string_t), allocatable :: names(:)

      names = trimmed_strings(TASKS(TASK_RUN + 1:)%name)
   end function command_names

   !> How it is called: `atrito check DECK.inp [options]`.
   pure function task_form(task) result(text)
      integer, intent(in) :: task
      character(len=:), allocatable :: text

      text = trim(called(task)//' '//TASKS(task)%options)
   end function task_form

   !> `atrito check DECK.inp`
   pure function called(task) result(text)
      integer, intent(in) :: task
      character(len=:), allocatable :: text

      text = trim('atrito '//TASKS(task)%name)//' '//trim(TASKS(task)%objects)
   end function called

   !> A task in the words of a message.
   pure function task_text(task) result(text)
      integer, intent(in) :: task
      character(len=:), allocatable :: text

      text = 'a run'
      if (task /= TASK_RUN) text = 'atrito '//trim(TASKS(task)%name)
   end function task_text

   !> Place of an option in OPTIONS, by either name; 0 when there is none.
   pure integer function find_option(name) result(i)
      character(len=*), intent(in) :: name          !< with its dashes

      i = findloc(OPTIONS%name == name, .true., dim=1)
      if (i == 0 .and. len_trim(name) > 0) i = findloc(OPTIONS%short == name, .true., dim=1)
   end function find_option

   !> Whether an option has a value behind it.
   pure logical function has_value(option)
      integer, intent(in) :: option                 !< place in OPTIONS

      has_value = len_trim(OPTIONS(option)%value) > 0
   end function has_value

   !> The words that the value of an option may be; none where it is something else.
   pure function option_words(option) result(words)
      integer, intent(in) :: option                 !< place in OPTIONS
      type(string_t), allocatable :: words(:)
      character(len=:), allocatable :: rest
      integer :: blank

      allocate (words(0))
      rest = trim(OPTIONS(option)%words)
      do while (len(rest) > 0)
         blank = index(rest//' ', ' ')
         call append_string(words, rest(:blank - 1))
         rest = rest(min(blank + 1, len(rest) + 1):)
      end do
   end function option_words

   !> Which of the words of an option this is; 0: none.
   pure integer function place_of_word(name, word) result(place)
      character(len=*), intent(in) :: name          !< of the option
      character(len=*), intent(in) :: word          !< as the user wrote it
      type(string_t), allocatable :: words(:)
      integer :: i

      words = option_words(find_option(name))
      place = 0
      do i = 1, size(words)
         if (words(i)%s == word) place = i
      end do
   end function place_of_word

   !> What the value of an option may be: `auto, dense or sparse`, `a number, 0 to 1`.
   pure function value_text(option) result(text)
      integer, intent(in) :: option                 !< place in OPTIONS
      character(len=:), allocatable :: text
      type(string_t), allocatable :: words(:)
      integer :: n

      words = option_words(option)
      n = size(words)
      text = join(words(:n - 1), ', ')
      if (n > 0) text = text//' or '//words(n)%s
      if (n > 0 .and. len_trim(OPTIONS(option)%expected) > 0) text = text//', '
      text = text//trim(OPTIONS(option)%expected)
   end function value_text

   !> An option as one types it: `-V, --version`, `--solver NAME`.
   pure function option_text(option) result(text)
      integer, intent(in) :: option                 !< place in OPTIONS
      character(len=:), allocatable :: text

      text = trim(OPTIONS(option)%name)
      if (len_trim(OPTIONS(option)%short) > 0) text = trim(OPTIONS(option)%short)//', '//text
      text = trim(text//' '//OPTIONS(option)%value)
   end function option_text

   !> What an option is for, its words and its default.
   pure function phrase_text(option) result(text)
      integer, intent(in) :: option                 !< place in OPTIONS
      character(len=:), allocatable :: text

      text = trim(OPTIONS(option)%phrase)
      if (len_trim(OPTIONS(option)%words) > 0) text = text//': '//value_text(option)
      if (len_trim(OPTIONS(option)%default) > 0) text = text//'; default '//trim(OPTIONS(option)%default)
   end function phrase_text

   !> First the options of a run, then those that a run does not know, last those of every command.
   subroutine group_options(groups)
      type(option_group_t), allocatable, intent(out) :: groups(:) !< each option is in one
      integer, allocatable :: of_run(:), of_all(:), rest(:)
      logical, allocatable :: is_alike(:)
      logical :: is_general(size(OPTIONS)), is_of_run(size(OPTIONS)), known(size(TASKS))
      integer :: i

      is_general = [(all(OPTIONS(i)%for_task), i=1, size(OPTIONS))]
      is_of_run = [(OPTIONS(i)%for_task(TASK_RUN), i=1, size(OPTIONS))]
      of_all = pack([(i, i=1, size(OPTIONS))], is_general)
      of_run = pack([(i, i=1, size(OPTIONS))], is_of_run .and. .not. is_general)
      rest = pack([(i, i=1, size(OPTIONS))],.not. is_of_run)
      groups = [option_group_t('options of a run', of_run, '')]
      groups(1)%others = others_text(of_run)        ! in the constructor gfortran 12 fails
      do while (size(rest) > 0)
         is_alike = [(all(OPTIONS(rest(i))%for_task .eqv. OPTIONS(rest(1))%for_task), i=1, size(rest))]
         known = OPTIONS(rest(1))%for_task
         groups = [groups, option_group_t('options of '//join(trimmed_strings(pack(TASKS%name, known)), ' and '), &
                                          pack(rest, is_alike), '')]
         rest = pack(rest,.not. is_alike)
      end do
      groups = [groups, option_group_t('options of every command', of_all, '')]
   end subroutine group_options

   !> `Of these check knows --set, --refine; sweep, limit all but --restart.`
   pure function others_text(members) result(text)
      integer, intent(in) :: members(:)             !< the options of a run
      character(len=:), allocatable :: text
      character(len=:), allocatable :: known, before
      integer :: task

      text = ''
      before = ''
      do task = 1, size(TASKS)
         if (task == TASK_RUN .or. task == TASK_HELP) cycle
         known = knows_text(task, members)
         if (known == before) then
            text = text//', '//trim(TASKS(task)%name)
         else if (len(text) == 0) then
            text = 'Of these '//trim(TASKS(task)%name)//' knows'
         else
            text = text//' '//before//'; '//trim(TASKS(task)%name)
         end if
         before = known
      end do
      text = text//' '//before//'.'
   end function others_text

   !> What a command knows, or what it does not know, whatever is shorter.
   pure function knows_text(task, members) result(text)
      integer, intent(in) :: task
      integer, intent(in) :: members(:)
      character(len=:), allocatable :: text
      logical :: known(size(members))
      integer :: i

      known = [(OPTIONS(members(i))%for_task(task), i=1, size(members))]
      if (all(known)) then
         text = 'all'
      else if (2*count(known) > size(members)) then
         text = 'all but '//join(trimmed_strings(OPTIONS(pack(members,.not. known))%name), ', ')
      else
         text = join(trimmed_strings(OPTIONS(pack(members, known))%name), ', ')
      end if
   end function knows_text

end module atrito_option_table
