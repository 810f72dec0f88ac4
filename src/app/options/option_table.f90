!> The options of the command line: their names, the tasks that know them, what their values may be, and what they are for. The
!> command line, `--help`, the manual page and the completion of shells are made from it.
module atrito_option_table
   use atrito_strings, only: string_t, append_string, join
   use atrito_task_table, only: TASK_LIMIT
   implicit none (type, external)
   private
   public :: OPTIONS, MOST_THREADS, MOST_LEVELS, VALUE_FOLDER, VALUE_FILE
   public :: find_option, has_value, option_names, option_words, place_of_word, value_text, option_text, phrase_text

   integer, parameter :: MOST_THREADS = 1024
   integer, parameter :: MOST_LEVELS = 12           !< of --refine: 16 million elements of one
   character(len=*), parameter :: VALUE_FOLDER = 'DIR', VALUE_FILE = 'FILE'    !< names of values that are paths

   !> An option, and which tasks know it.
   type :: option_t
      character(len=12) :: name
      character(len=12) :: value                    !< how its value is called, VALUE_... where it is a path; '': it has none
      logical :: for_task(TASK_LIMIT)               !< run, check, compare, help, sweep, study, limit
      character(len=120) :: phrase                  !< what it is for
      character(len=84) :: expected = ''            !< what its value may be; behind `words`, where there are any
      character(len=80) :: default = ''             !< what holds without it
      character(len=40) :: words = ''               !< the words that its value may be, blanks between them
      character(len=2) :: short = ''                !< another name
   end type option_t

   logical, parameter :: Y = .true., N = .false.
   type(option_t), parameter :: OPTIONS(*) = [ &
                                option_t('-o', VALUE_FOLDER, [Y, Y, N, N, Y, Y, Y], &
                                         'folder of the tables', &
                                         default='./output/<deck>; of sweep, study, limit and check ./output/<deck>-sweep, ...', &
                                         expected='a folder; it is made where it is missing'), &
                                option_t('--set', 'NAME=VALUE', [Y, Y, N, N, Y, Y, Y], &
                                         'value of a *PARAMETER of the deck; may be repeated', &
                                         expected='NAME=VALUE, VALUE an expression of numbers'), &
                                option_t('--observe', 'NAME=EXPR', [Y, Y, N, N, Y, Y, N], &
                                         'a number of your own, such as tip=u2(12), in the tables; may be repeated', &
                                         expected='NAME=EXPRESSION, such as tip=u2(12) or peak=max(mises, BEAM)'), &
                                option_t('--refine', 'K', [Y, Y, N, N, Y, Y, Y], &
                                         'each element into 4, K times; all else follows', &
                                         default='0', expected='a whole number, 0 to 12: each element into 4, so many times'), &
                                option_t('--solver', 'NAME', [Y, Y, N, N, Y, Y, Y], &
                                         'solver of the bodies', &
                                         default='auto', words='auto skyline banded sparse'), &
                                option_t('--contact', 'NAME', [Y, Y, N, N, Y, Y, Y], &
                                         'form of the contact system', &
                                         default='auto', words='auto dense sparse'), &
                                option_t('--share', 'NAME', [Y, N, N, N, N, N, N], &
                                         'one scene over the ranks of atrito-mpi: large ones, all, or none', &
                                         default='auto', words='auto all none'), &
                                option_t('--threads', 'N', [Y, Y, N, N, Y, Y, Y], &
                                         'cores of a run, or runs of a sweep side by side', &
                                         default='1', expected='a whole number, 1 to 1024'), &
                                option_t('--digits', 'N', [Y, N, N, N, Y, Y, Y], &
                                         'significant digits of the tables, 6 to 17', &
                                         default='10', expected='a whole number, 6 to 17'), &
                                option_t('--format', 'NAME', [Y, N, N, N, Y, Y, Y], &
                                         'tables as text, or as comma-separated values', &
                                         default='tab', words='tab csv'), &
                                option_t('--plot', '', [Y, Y, N, N, Y, Y, Y], &
                                         'pictures by gnuplot, in DIR/plots; of check: the scene before it is solved'), &
                                option_t('--plot-scale', 'S', [Y, N, N, N, N, N, Y], &
                                         'displacements are drawn S times as large', &
                                         default='chosen by their size', &
                                         expected='a number, 0 or more, by which displacements are drawn; with --plot'), &
                                option_t('--plot-box', 'X1,Y1,X2,Y2', [Y, Y, N, N, N, N, Y], &
                                         'what pictures of bodies show', default='all', &
                                         expected='x1,y1,x2,y2, two corners of what pictures show; with --plot'), &
                                option_t('--report', '', [Y, N, N, N, Y, Y, Y], &
                                         'all in one page, DIR/report.html; draws the pictures, too'), &
                                option_t('--restart', VALUE_FILE, [Y, N, N, N, N, N, N], &
                                         'go on behind the increment in a file of *RESTART, WRITE', &
                                         expected='a restart file of this deck, NAME.restart.h5'), &
                                option_t('--confine', VALUE_FOLDER, [Y, Y, N, N, Y, Y, Y], &
                                         'for decks that are not trusted: reads nothing outside DIR, writes nothing outside -o', &
                                         expected='a folder, which holds the deck and all that it includes'), &
                                option_t('--quiet', '', [Y, Y, Y, N, Y, Y, Y], &
                                         'no progress, no notes, no summary; warnings and errors'), &
                                option_t('--vary', 'NAME=VALUES', [N, N, N, N, Y, N, Y], &
                                'values of a *PARAMETER: v1,v2,... of a sweep (several --vary: all combinations), a:b of a limit', &
                                     expected='NAME=v1,v2,..., values of a parameter of the deck, each an expression of numbers'), &
                                option_t('--resume', '', [N, N, N, N, Y, N, N], &
                                         'leave the runs alone that an earlier sweep of the same deck and options has made'), &
                                option_t('--levels', 'N', [N, N, N, N, N, Y, N], &
                                         'so many meshes, each of four times the elements', &
                                         expected='a whole number, 1 to 12: so many meshes, each with four elements for one'), &
                                option_t('--elements', 'LIST', [N, N, N, N, N, Y, N], &
                                         'the elements of these meshes', &
                       default='the deck''s', words='cpe4 cps4 cpe8 cps8 cpe9 cps9', expected='several with commas between them'), &
                                option_t('--reference', 'Q=V', [N, N, N, N, N, Y, N], &
                                         'exact value of a quantity of summary.tab; Q alone: extrapolated; may be repeated', &
                                         expected='QUANTITY or QUANTITY=VALUE, a quantity of summary.tab'), &
                                option_t('--tolerance', 'T', [N, N, N, N, N, N, Y], &
                                         'width of the interval round the limit, over the limit', &
                               default='1e-6', expected='a number, 1e-8 to 0.1: of the interval round the limit, over the limit'), &
                                option_t('--watch', 'NODE,DOF', [N, N, N, N, N, N, Y], &
                                         'displacement of the curve', &
                                         default='the largest', expected='NODE,DOF: a node of the deck, and 1 or 2'), &
                                option_t('--rtol', 'R', [N, N, Y, N, N, N, N], &
                                         'differences allowed, relative to the largest of the column', &
                                         default='1e-6', expected='a number, 0 to 1'), &
                                option_t('--atol', 'A', [N, N, Y, N, N, N, N], &
                                         'differences allowed, absolute', &
                                         default='0', expected='a number, not negative'), &
                                option_t('--messages', 'NAME', [Y, Y, Y, Y, Y, Y, Y], &
                                         'messages on standard error as text, or one object of JSON a line', &
                                         default='text', words='text json'), &
                                option_t('--help', '', [Y, Y, Y, Y, Y, Y, Y], &
                                         'commands, options and exit codes', short='-h'), &
                                option_t('--version', '', [Y, Y, Y, Y, Y, Y, Y], &
                                         'version of the program and of its libraries', short='-V')]

contains

   !> Place of an option in OPTIONS, by either name; 0 when there is none.
   pure integer function find_option(name) result(i)
      character(len=*), intent(in) :: name

      i = findloc(OPTIONS%name == name, .true., dim=1)
      if (i == 0 .and. len_trim(name) > 0) i = findloc(OPTIONS%short == name, .true., dim=1)
   end function find_option

   !> Whether an option has a value behind it.
   pure logical function has_value(option)
      integer, intent(in) :: option                 !< place in OPTIONS

      has_value = len_trim(OPTIONS(option)%value) > 0
   end function has_value

   !> The long names of all options, for the nearest names in messages.
   pure function option_names() result(names)
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(size(OPTIONS)))
      do i = 1, size(OPTIONS)
         names(i)%s = trim(OPTIONS(i)%name)
      end do
   end function option_names

   !> The words that the value of an option may be; none where it is something else.
   pure function option_words(option) result(words)
      integer, intent(in) :: option                 !< place in OPTIONS
      type(string_t), allocatable :: words(:)
      character(len=:), allocatable :: text
      integer :: first, last

      allocate (words(0))
      text = trim(OPTIONS(option)%words)
      first = 1
      do while (first <= len(text))
         last = first + index(text(first:)//' ', ' ') - 2
         call append_string(words, text(first:last))
         first = last + 2
      end do
   end function option_words

   !> Which of the words of an option this is; 0: none.
   pure integer function place_of_word(name, word) result(place)
      character(len=*), intent(in) :: name          !< of the option
      character(len=*), intent(in) :: word
      character(len=:), allocatable :: words
      integer :: at, i

      words = ' '//trim(OPTIONS(find_option(name))%words)//' '
      at = 0
      if (index(trim(word), ' ') == 0) at = index(words, ' '//trim(word)//' ')
      place = count([(words(i:i) == ' ', i=1, at)])
   end function place_of_word

   !> What the value of an option may be.
   pure function value_text(option) result(text)
      integer, intent(in) :: option                 !< place in OPTIONS
      character(len=:), allocatable :: text

      text = words_text(option_words(option))
      if (len(text) > 0 .and. len_trim(OPTIONS(option)%expected) > 0) text = text//', '
      text = text//trim(OPTIONS(option)%expected)
   end function value_text

   !> `auto, dense or sparse`
   pure function words_text(words) result(text)
      type(string_t), intent(in) :: words(:)
      character(len=:), allocatable :: text
      integer :: n

      n = size(words)
      text = join(words(:max(n - 1, min(n, 1))), ', ')
      if (n > 1) text = text//' or '//words(n)%s
   end function words_text

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

end module atrito_option_table
