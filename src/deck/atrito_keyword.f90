!> What the reader knows of a keyword: one definition drives the reader, its checks, `atrito help` and docs/user/keywords.md.
!>
!> The definitions themselves stand in atrito_mesh_keywords, atrito_scene_keywords and atrito_step_keywords, written with the
!> building procedures of this module; atrito_keyword_table collects them.
module atrito_keyword
   use atrito_strings, only: string_t, append_string
   implicit none (type, external)
   private
   public :: keyword_t, option_spec_t, choice_t, form_t, item_t
   public :: define_keyword, add_option, add_form, add_item, add_word_item, add_example
   public :: LEVEL_MODEL, LEVEL_STEP, LEVEL_BOTH, ANY_NUMBER
   public :: KIND_FLAG, KIND_NAME, KIND_WORD, KIND_OPTIONAL_WORD, KIND_REAL, KIND_INTEGER, KIND_FILE, KIND_ID, KIND_ID_OR_NAME, &
             KIND_TEXT

   !> Where a keyword may stand.
   integer, parameter :: LEVEL_MODEL = 1     !< before *STEP
   integer, parameter :: LEVEL_STEP = 2      !< between *STEP and *END STEP
   integer, parameter :: LEVEL_BOTH = 3

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

   integer, parameter :: ANY_NUMBER = huge(1)    !< no upper limit of lines or items

   !> One of the words that an option or item can take.
   type :: choice_t
      character(len=:), allocatable :: name
      logical :: built = .true.
      logical :: own = .false.                   !< atrito's own, unknown to Abaqus and CalculiX
   end type choice_t

   type :: option_spec_t
      character(len=:), allocatable :: name
      integer :: kind = KIND_FLAG
      logical :: required = .false.
      logical :: own = .false.
      logical :: built = .true.
      logical :: harmless = .false.              !< of another solver: a note, no effect
      character(len=:), allocatable :: default   !< '' : none
      character(len=:), allocatable :: needs     !< option that must be there too; '' : none
      character(len=:), allocatable :: dimension
      character(len=:), allocatable :: doc
      type(choice_t), allocatable :: choices(:)
   end type option_spec_t

   !> One item of a data line.
   type :: item_t
      character(len=:), allocatable :: name
      integer :: kind = KIND_REAL
      logical :: required = .true.
      logical :: harmless = .false.              !< of another solver: a note, not read
      character(len=:), allocatable :: default   !< '' : none
      character(len=:), allocatable :: dimension
      character(len=:), allocatable :: doc
      type(choice_t), allocatable :: choices(:)
   end type item_t

   !> One form of data line. It applies when its option is given (or has one of these values, given or by default); lines of a
   !> form with a leading word are told by it, the others by their position.
   type :: form_t
      character(len=:), allocatable :: option    !< '' : always
      type(string_t), allocatable :: values(:)   !< size 0: any value
      logical :: absent = .false.                !< applies when the option is not given
      character(len=:), allocatable :: word      !< '' : none
      integer :: min_lines = 1, max_lines = ANY_NUMBER
      integer :: min_items = 0, max_items = 0
      logical :: built = .true.
      logical :: harmless = .false.              !< lines of another solver: a note, not read
      character(len=:), allocatable :: doc
      type(item_t), allocatable :: items(:)
   end type form_t

   type :: keyword_t
      character(len=:), allocatable :: name
      integer :: level = LEVEL_MODEL
      logical :: own = .false.
      logical :: built = .true.
      logical :: harmless = .false.
      character(len=:), allocatable :: parent    !< keyword to whose block it belongs; '' : none
      character(len=:), allocatable :: summary   !< one line
      character(len=:), allocatable :: doc       !< further sentences; may be ''
      type(option_spec_t), allocatable :: options(:)
      type(form_t), allocatable :: forms(:)      !< size 0: no data lines
      type(string_t), allocatable :: example(:)
   end type keyword_t

contains

   !> Begins the definition of a keyword.
   subroutine define_keyword(keyword, name, level, summary, doc, parent, own, built, harmless)
      type(keyword_t), intent(out) :: keyword
      character(len=*), intent(in) :: name, summary
      integer, intent(in) :: level
      character(len=*), intent(in), optional :: doc, parent
      logical, intent(in), optional :: own, built, harmless

      keyword%name = name
      keyword%level = level
      keyword%summary = summary
      keyword%doc = text_or(doc)
      keyword%parent = text_or(parent)
      if (present(own)) keyword%own = own
      if (present(built)) keyword%built = built
      if (present(harmless)) keyword%harmless = harmless
      allocate (keyword%options(0), keyword%forms(0), keyword%example(0))
   end subroutine define_keyword

   !> Adds an option. choices: words separated by blanks, `-` before one that is not built, `+` behind one of atrito's own.
   subroutine add_option(keyword, name, kind, doc, required, default, choices, needs, dimension, own, built, harmless)
      type(keyword_t), intent(inout) :: keyword
      character(len=*), intent(in) :: name, doc
      integer, intent(in) :: kind
      logical, intent(in), optional :: required, own, built, harmless
      character(len=*), intent(in), optional :: default, choices, needs, dimension
      type(option_spec_t) :: option

      option%name = name
      option%kind = kind
      option%doc = doc
      option%default = text_or(default)
      option%needs = text_or(needs)
      option%dimension = text_or(dimension)
      if (present(required)) option%required = required
      if (present(own)) option%own = own
      if (present(built)) option%built = built
      if (present(harmless)) option%harmless = harmless
      option%choices = choices_of(text_or(choices))
      keyword%options = [keyword%options, option]
   end subroutine add_option

   !> Begins a form of data line. when: '' always, 'OPTION' with it, '-OPTION' without it, 'OPTION=A|B' with these values.
   subroutine add_form(keyword, doc, min_lines, max_lines, when, word, built, harmless)
      type(keyword_t), intent(inout) :: keyword
      character(len=*), intent(in) :: doc
      integer, intent(in) :: min_lines, max_lines
      character(len=*), intent(in), optional :: when, word
      logical, intent(in), optional :: built, harmless
      type(form_t) :: form

      form%doc = doc
      form%min_lines = min_lines
      form%max_lines = max_lines
      form%word = text_or(word)
      if (present(built)) form%built = built
      if (present(harmless)) form%harmless = harmless
      call set_condition(form, text_or(when))
      allocate (form%items(0))
      if (len(form%word) > 0) then
         form%min_items = 1
         form%max_items = 1
      end if
      keyword%forms = [keyword%forms, form]
   end subroutine add_form

   subroutine set_condition(form, when)
      type(form_t), intent(inout) :: form
      character(len=*), intent(in) :: when
      integer :: equals, first, bar

      allocate (form%values(0))
      form%absent = index(when, '-') == 1
      first = merge(2, 1, form%absent)
      equals = index(when, '=')
      if (equals == 0) then
         form%option = when(first:)
         return
      end if
      form%option = when(:equals - 1)
      first = equals + 1
      do while (first <= len(when))
         bar = index(when(first:)//'|', '|')
         call append_string(form%values, when(first:first + bar - 2))
         first = first + bar
      end do
   end subroutine set_condition

   !> Adds an item to the form begun last; with `repeats` it may stand any number of times.
   subroutine add_item(keyword, name, kind, doc, dimension, default, required, repeats, harmless)
      type(keyword_t), intent(inout) :: keyword
      character(len=*), intent(in) :: name, doc
      integer, intent(in) :: kind
      character(len=*), intent(in), optional :: dimension, default
      logical, intent(in), optional :: required, repeats, harmless
      type(item_t) :: item

      item%name = name
      item%kind = kind
      if (present(harmless)) item%harmless = harmless
      item%doc = doc
      item%dimension = text_or(dimension)
      item%default = text_or(default)
      item%required = .not. present(default)
      if (present(required)) item%required = required
      allocate (item%choices(0))
      call append_item(keyword, item, repeats)
   end subroutine add_item

   !> Adds an item that is one of a list of words, written as in add_option.
   subroutine add_word_item(keyword, name, choices, doc, required, repeats)
      type(keyword_t), intent(inout) :: keyword
      character(len=*), intent(in) :: name, choices, doc
      logical, intent(in), optional :: required, repeats
      type(item_t) :: item

      item%name = name
      item%kind = KIND_WORD
      item%doc = doc
      item%dimension = ''
      item%default = ''
      if (present(required)) item%required = required
      item%choices = choices_of(choices)
      call append_item(keyword, item, repeats)
   end subroutine add_word_item

   subroutine append_item(keyword, item, repeats)
      type(keyword_t), intent(inout) :: keyword
      type(item_t), intent(in) :: item
      logical, intent(in), optional :: repeats
      integer :: f

      f = size(keyword%forms)
      keyword%forms(f)%items = [keyword%forms(f)%items, item]
      keyword%forms(f)%max_items = keyword%forms(f)%max_items + 1
      if (item%required) keyword%forms(f)%min_items = keyword%forms(f)%max_items
      if (.not. present(repeats)) return
      if (repeats) keyword%forms(f)%max_items = ANY_NUMBER
   end subroutine append_item

   !> Adds the lines of an example, separated by '|'.
   subroutine add_example(keyword, lines)
      type(keyword_t), intent(inout) :: keyword
      character(len=*), intent(in) :: lines
      integer :: first, bar

      first = 1
      do while (first <= len(lines))
         bar = index(lines(first:)//'|', '|')
         call append_string(keyword%example, lines(first:first + bar - 2))
         first = first + bar
      end do
   end subroutine add_example

   pure function choices_of(list) result(choices)
      character(len=*), intent(in) :: list
      type(choice_t), allocatable :: choices(:)
      integer :: first, blank, i, n

      n = 0
      if (len(list) > 0) n = 1 + count([(list(i:i) == ' ', i=1, len(list))])
      allocate (choices(n))
      first = 1
      do i = 1, n
         blank = index(list(first:)//' ', ' ')
         call read_choice(list(first:first + blank - 2), choices(i))
         first = first + blank
      end do
   end function choices_of

   !> A subroutine: what a function result holds in an array constructor is never given back (gfortran 12).
   pure subroutine read_choice(word, choice)
      character(len=*), intent(in) :: word
      type(choice_t), intent(out) :: choice
      integer :: first, last

      choice%built = word(1:1) /= '-'
      choice%own = word(len(word):) == '+'
      first = merge(1, 2, choice%built)
      last = len(word) - merge(1, 0, choice%own)
      choice%name = word(first:last)
   end subroutine read_choice

   pure function text_or(text) result(given)
      character(len=*), intent(in), optional :: text
      character(len=:), allocatable :: given

      given = ''
      if (present(text)) given = text
   end function text_or

end module atrito_keyword
