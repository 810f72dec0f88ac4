!> The options of the command line: their names, the tasks that know them, and what their values may be.
module atrito_option_table
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: TASK_USAGE, TASK_RUN, TASK_CHECK, TASK_COMPARE, TASK_HELP, TASK_SWEEP, TASK_STUDY, TASK_LIMIT, TASK_OPTIONS, &
             TASK_VERSION
   public :: OPTIONS, SOLVERS, CONTACT_FORMS, MOST_THREADS, MOST_LEVELS
   public :: find_option, option_names, string_list, value_text, task_text

   integer, parameter :: TASK_USAGE = 0             !< nothing was asked: tell how, exit 1
   integer, parameter :: TASK_RUN = 1, TASK_CHECK = 2, TASK_COMPARE = 3, TASK_HELP = 4, TASK_SWEEP = 5, TASK_STUDY = 6, &
                         TASK_LIMIT = 7
   integer, parameter :: TASK_OPTIONS = 8           !< --help
   integer, parameter :: TASK_VERSION = 9           !< --version

   character(len=7), parameter :: SOLVERS(5) = ['auto   ', 'skyline', 'banded ', 'sparse ', 'mumps  ']
   character(len=6), parameter :: CONTACT_FORMS(3) = ['auto  ', 'dense ', 'sparse']
   integer, parameter :: MOST_THREADS = 1024
   integer, parameter :: MOST_LEVELS = 12           !< of --refine: 16 million elements of one

   !> An option, and which tasks know it.
   type :: option_t
      character(len=11) :: name
      logical :: has_value
      logical :: for_task(TASK_LIMIT)               !< run, check, compare, help, sweep, study, limit
      character(len=84) :: expected                 !< what its value may be
   end type option_t

   logical, parameter :: Y = .true., N = .false.
   type(option_t), parameter :: OPTIONS(20) = [ &
                                option_t('-o         ', Y, [Y, N, N, N, Y, Y, Y], 'a folder; it is made where it is missing'), &
                                option_t('--set      ', Y, [Y, Y, N, N, Y, Y, Y], 'NAME=VALUE, VALUE an expression of numbers'), &
                                option_t('--solver   ', Y, [Y, Y, N, N, Y, Y, Y], 'auto, skyline, banded, sparse or mumps'), &
                                option_t('--contact  ', Y, [Y, Y, N, N, Y, Y, Y], 'auto, dense or sparse'), &
                                option_t('--threads  ', Y, [Y, Y, N, N, Y, Y, Y], 'a whole number, 1 to 1024'), &
                                option_t('--digits   ', Y, [Y, N, N, N, Y, Y, Y], 'a whole number, 6 to 17'), &
                                option_t('--quiet    ', N, [Y, Y, Y, N, Y, Y, Y], ''), &
                                option_t('--rtol     ', Y, [N, N, Y, N, N, N, N], 'a number, 0 to 1'), &
                                option_t('--atol     ', Y, [N, N, Y, N, N, N, N], 'a number, not negative'), &
                                option_t('--refine   ', Y, [Y, Y, N, N, Y, Y, Y], &
                                         'a whole number, 0 to 12: each element into 4, so many times'), &
                                option_t('--plot     ', N, [Y, N, N, N, Y, Y, Y], ''), &
                                option_t('--restart  ', Y, [Y, N, N, N, N, N, N], 'a restart file of this deck, NAME.restart.h5'), &
                                option_t('--levels   ', Y, [N, N, N, N, N, Y, N], &
                                         'a whole number, 1 to 12: so many meshes, each with four elements for one'), &
                                option_t('--vary     ', Y, [N, N, N, N, Y, N, Y], &
                                         'NAME=v1,v2,..., values of a parameter of the deck, each an expression of numbers'), &
                                option_t('--tolerance', Y, [N, N, N, N, N, N, Y], &
                                         'a number, 1e-8 to 0.1: of the interval round the limit, over the limit'), &
                                option_t('--watch    ', Y, [N, N, N, N, N, N, Y], 'NODE,DOF: a node of the deck, and 1 or 2'), &
                                option_t('--elements ', Y, [N, N, N, N, N, Y, N], &
                                         'cpe4, cps4, cpe8, cps8, cpe9, cps9, several with commas between them'), &
                                option_t('--reference', Y, [N, N, N, N, N, Y, N], &
                                         'QUANTITY or QUANTITY=VALUE, a quantity of summary.tab'), &
                                option_t('--help     ', N, [Y, Y, Y, Y, Y, Y, Y], ''), &
                                option_t('--version  ', N, [Y, Y, Y, Y, Y, Y, Y], '')]

contains

   !> Place of an option in OPTIONS; 0 when there is none.
   pure integer function find_option(name) result(i)
      character(len=*), intent(in) :: name

      i = findloc(OPTIONS%name == name, .true., dim=1)
   end function find_option

   pure function option_names() result(names)
      type(string_t), allocatable :: names(:)

      names = string_list(OPTIONS%name)
   end function option_names

   pure function string_list(words) result(list)
      character(len=*), intent(in) :: words(:)
      type(string_t), allocatable :: list(:)
      integer :: i

      allocate (list(size(words)))
      do i = 1, size(words)
         list(i)%s = trim(words(i))
      end do
   end function string_list

   !> A task in the words of a message.
   pure function task_text(task) result(text)
      integer, intent(in) :: task
      character(len=:), allocatable :: text
      character(len=14), parameter :: NAMES(TASK_LIMIT) = ['a run         ', 'atrito check  ', 'atrito compare', 'atrito help   ', &
                                                           'atrito sweep  ', 'atrito study  ', 'atrito limit  ']

      text = trim(NAMES(task))
   end function task_text

   !> What the value of an option may be.
   pure function value_text(name) result(text)
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: text

      text = trim(OPTIONS(find_option(name))%expected)
   end function value_text

end module atrito_option_table
