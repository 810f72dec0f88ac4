!> What the program can be asked to do: the commands with their words, for the command line, `--help`, manual page and completion.
module atrito_task_table
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: TASK_USAGE, TASK_RUN, TASK_CHECK, TASK_COMPARE, TASK_HELP, TASK_SWEEP, TASK_STUDY, TASK_LIMIT, TASK_OPTIONS, &
             TASK_VERSION, TASKS
   public :: task_named, command_names, task_form, called, task_text

   integer, parameter :: TASK_USAGE = 0             !< nothing was asked: tell how, exit 1
   integer, parameter :: TASK_RUN = 1, TASK_CHECK = 2, TASK_COMPARE = 3, TASK_HELP = 4, TASK_SWEEP = 5, TASK_STUDY = 6, &
                         TASK_LIMIT = 7
   integer, parameter :: TASK_OPTIONS = 8           !< --help
   integer, parameter :: TASK_VERSION = 9           !< --version

   !> What the names behind a command are.
   integer, parameter :: TAKES_DECK = 1, TAKES_PATHS = 2, TAKES_KEYWORD = 3

   type :: task_t
      character(len=7) :: name                      !< the command; '': a run has none
      integer :: takes                              !< TAKES_...
      character(len=11) :: objects                  !< the names behind it
      character(len=51) :: options                  !< what stands behind these
      character(len=58) :: phrase                   !< what it does
   end type task_t

   type(task_t), parameter :: TASKS(TASK_LIMIT) = [ &
                              task_t('', TAKES_DECK, 'DECK.inp', '[options]', 'solve the deck and write tables'), &
                            task_t('check', TAKES_DECK, 'DECK.inp', '[options]', 'read and check all, tell what the scene needs'), &
                              task_t('compare', TAKES_PATHS, 'A B', '[--rtol R] [--atol A]', &
                                     'compare two tables, or two folders of them'), &
                              task_t('help', TAKES_KEYWORD, '[KEYWORD]', '', 'the deck language; `atrito help all`: all of it'), &
                              task_t('sweep', TAKES_DECK, 'DECK.inp', '--vary NAME=v1,v2,... [options]', &
                                     'one run a value of a parameter: --vary NAME=v1,...'), &
                              task_t('study', TAKES_DECK, 'DECK.inp', &
                                     '--levels N [--elements LIST] [--reference Q=V]', &
                                     'error against run time: --levels N'), &
                              task_t('limit', TAKES_DECK, 'DECK.inp', '--vary NAME=a:b [--tolerance T] [--watch NODE,DOF]', &
                                     'where a scene ceases to stand: --vary NAME=a:b')]

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
      integer :: task

      allocate (names(size(TASKS) - 1))
      do task = 2, size(TASKS)                      ! a run, the first, has no command
         names(task - 1)%s = trim(TASKS(task)%name)
      end do
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

      text = 'atrito '
      if (task /= TASK_RUN) text = text//trim(TASKS(task)%name)//' '
      text = text//trim(TASKS(task)%objects)
   end function called

   !> A task in the words of a message.
   pure function task_text(task) result(text)
      integer, intent(in) :: task
      character(len=:), allocatable :: text

      text = 'a run'
      if (task /= TASK_RUN) text = 'atrito '//trim(TASKS(task)%name)
   end function task_text

end module atrito_task_table
