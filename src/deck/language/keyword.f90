!> What the reader knows of a keyword: one definition drives the reader, its checks, `atrito help` and docs/user/keywords.md.
!>
!> The definitions stand in mesh_keywords.txt, scene_keywords.txt and step_keywords.txt, which atrito_keyword_reader reads.
module atrito_keyword
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: keyword_t, option_spec_t, choice_t, form_t, item_t
   public :: LEVEL_MODEL, LEVEL_STEP, LEVEL_BOTH, ANY_NUMBER, LEVEL_NAMES
   public :: KIND_FLAG, KIND_NAME, KIND_WORD, KIND_OPTIONAL_WORD, KIND_REAL, KIND_INTEGER, KIND_FILE, KIND_ID, KIND_ID_OR_NAME, &
             KIND_TEXT, KIND_REAL_OR_NAME, KIND_NAMES, NO_EFFECT

   !> Where a keyword may stand, and what that is called in the definitions.
   integer, parameter :: LEVEL_MODEL = 1     !< before *STEP
   integer, parameter :: LEVEL_STEP = 2      !< between *STEP and *END STEP
   integer, parameter :: LEVEL_BOTH = 3
   character(len=5), parameter :: LEVEL_NAMES(3) = ['model', 'step ', 'both ']

   !> What the value of an option or an item of a data line is.
   integer, parameter :: KIND_FLAG = 1           !< an option without value
   integer, parameter :: KIND_NAME = 2
   integer, parameter :: KIND_WORD = 3           !< one of a list
   integer, parameter :: KIND_OPTIONAL_WORD = 4  !< one of a list, or no value at all: then the first of it
   integer, parameter :: KIND_REAL = 5
   integer, parameter :: KIND_INTEGER = 6
   integer, parameter :: KIND_FILE = 7
   integer, parameter :: KIND_ID = 8             !< number of a node or element
   integer, parameter :: KIND_ID_OR_NAME = 9     !< such a number, or a set
   integer, parameter :: KIND_TEXT = 10          !< the whole line
   integer, parameter :: KIND_REAL_OR_NAME = 11  !< a number, or a set
   character(len=9), parameter :: KIND_NAMES(11) = [character(len=9) :: 'flag', 'name', 'word', '[word]', 'real', 'integer', &
                                                                                       'file', 'id', 'id/name', 'text', 'real/name']

   character(len=*), parameter :: NO_EFFECT = 'has no effect' !< said of an item that is a number and is not used
   integer, parameter :: ANY_NUMBER = huge(1)    !< no upper limit of lines or items

   !> One of the words that an option or item can take.
   type :: choice_t
      character(len=:), allocatable :: name      !< in capitals
      logical :: built = .true.                  !< false where it is refused as not built yet
      logical :: own = .false.                   !< atrito's own, unknown to Abaqus and CalculiX
   end type choice_t

   !> One item of a data line.
   type :: item_t
      character(len=:), allocatable :: name      !< in messages and on the page of help
      integer :: kind = KIND_REAL                !< KIND_*
      logical :: required = .true.               !< false where it may be left out
      logical :: harmless = .false.              !< of another solver: a note, no effect
      logical :: is_unused = .false.             !< a number without effect, without a note
      character(len=:), allocatable :: default   !< '' : none
      character(len=:), allocatable :: dimension !< in F and L, e.g. 'F/L^2'; '': none
      character(len=:), allocatable :: doc       !< what it is, a few words
      type(choice_t), allocatable :: choices(:)  !< words that it may be; size 0: no list
   end type item_t

   type, extends(item_t) :: option_spec_t
      logical :: own = .false.                   !< atrito's own, unknown to Abaqus and CalculiX
      logical :: built = .true.                  !< false where it is refused as not built yet
      character(len=:), allocatable :: needs     !< option that must be there too; '' : none
   end type option_spec_t

   !> One form of data line. It applies when its option is given (or has one of these values, given or by default); lines of a
   !> form with a leading word are known by it, the others by their position.
   type :: form_t
      character(len=:), allocatable :: option          !< '' : always
      type(string_t), allocatable :: values(:)         !< size 0: any value; absent: other options
      logical :: absent = .false.                      !< applies when the option is not given, nor another one
      character(len=:), allocatable :: word            !< '' : none
      integer :: min_lines = 1, max_lines = ANY_NUMBER !< lines of this form that a card has
      integer :: min_items = 0, max_items = 0          !< items that a line has; ANY_NUMBER: the last ones repeat
      logical :: harmless = .false.                    !< lines of another solver: a note, not read
      logical :: goes_on = .false.                     !< a line with too few items goes on in the next
      character(len=:), allocatable :: doc             !< what the lines are for
      type(item_t), allocatable :: items(:)            !< in their order; the last one may repeat
   end type form_t

   type :: keyword_t
      character(len=:), allocatable :: name          !< in capitals, with its blanks
      integer :: level = LEVEL_MODEL                 !< LEVEL_*: where it may stand
      logical :: own = .false.                       !< atrito's own, unknown to Abaqus and CalculiX
      character(len=:), allocatable :: parent        !< keyword to whose block it belongs; '' : none
      character(len=:), allocatable :: summary       !< one line
      character(len=:), allocatable :: doc           !< further sentences; may be ''
      integer :: line = 0                            !< of its head among those of all definitions
      type(option_spec_t), allocatable :: options(:) !< these three only once they have been asked for (define_keyword)
      type(form_t), allocatable :: forms(:)          !< size 0: no data lines
      type(string_t), allocatable :: example(:)      !< lines of a deck
   end type keyword_t

end module atrito_keyword
