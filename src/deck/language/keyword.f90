!> What the reader knows of a keyword: one definition drives the reader, its checks, `atrito help` and docs/user/keywords.md.
!>
!> The definitions themselves stand in atrito_mesh_keywords, atrito_scene_keywords and atrito_step_keywords, written with the
!> building procedures of this module; atrito_keyword_table collects them. Names carry marks there: `NAME+` is atrito's own,
!> `-NAME` is not built yet, `NAME!` must be given, `[name]` may be left out, `(name)` is of another solver and has no effect,
!> `name...` may be repeated.
module atrito_keyword
   use atrito_strings, only: string_t
   implicit none (type, external)
   private
   public :: keyword_t, keyword_list_t, option_spec_t, choice_t, form_t, item_t
   public :: define_keyword, take_keywords, add_option, add_form, let_lines_go_on, add_item, add_word_item, add_example
   public :: LEVEL_MODEL, LEVEL_STEP, LEVEL_BOTH, ANY_NUMBER
   public :: KIND_FLAG, KIND_NAME, KIND_WORD, KIND_OPTIONAL_WORD, KIND_REAL, KIND_INTEGER, KIND_FILE, KIND_ID, KIND_ID_OR_NAME, &
             KIND_TEXT, KIND_REAL_OR_NAME, NO_EFFECT

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
   integer, parameter :: KIND_REAL_OR_NAME = 11  !< a number, or a set

   character(len=*), parameter :: NO_EFFECT = 'has no effect' !< said of an item that is a number and is not used
   integer, parameter :: MOST_KEYWORDS = 90, MOST_PARTS = 50
   integer, parameter :: ANY_NUMBER = huge(1)    !< no upper limit of lines or items

   !> One of the words that an option or item can take.
   type :: choice_t
      character(len=:), allocatable :: name
      logical :: built = .true.
      logical :: own = .false.                   !< atrito's own, unknown to Abaqus and CalculiX
   end type choice_t

   !> One item of a data line.
   type :: item_t
      character(len=:), allocatable :: name
      integer :: kind = KIND_REAL
      logical :: required = .true.
      logical :: harmless = .false.              !< of another solver: a note, no effect
      logical :: is_unused = .false.             !< a number without effect, without a note
      character(len=:), allocatable :: default   !< '' : none
      character(len=:), allocatable :: dimension
      character(len=:), allocatable :: doc
      type(choice_t), allocatable :: choices(:)
   end type item_t

   type, extends(item_t) :: option_spec_t
      logical :: own = .false.
      logical :: built = .true.
      character(len=:), allocatable :: needs     !< option that must be there too; '' : none
   end type option_spec_t

   !> One form of data line. It applies when its option is given (or has one of these values, given or by default); lines of a
   !> form with a leading word are told by it, the others by their position.
   type :: form_t
      character(len=:), allocatable :: option    !< '' : always
      type(string_t), allocatable :: values(:)   !< size 0: any value
      logical :: absent = .false.                !< applies when the option is not given
      character(len=:), allocatable :: word      !< '' : none
      integer :: min_lines = 1, max_lines = ANY_NUMBER
      integer :: min_items = 0, max_items = 0
      logical :: harmless = .false.              !< lines of another solver: a note, not read
      logical :: goes_on = .false.               !< a line with too few items goes on in the next
      character(len=:), allocatable :: doc
      type(item_t), allocatable :: items(:)
   end type form_t

   type :: keyword_t
      character(len=:), allocatable :: name
      integer :: level = LEVEL_MODEL
      logical :: own = .false.
      character(len=:), allocatable :: parent    !< keyword to whose block it belongs; '' : none
      character(len=:), allocatable :: summary   !< one line
      character(len=:), allocatable :: doc       !< further sentences; may be ''
      type(option_spec_t), allocatable :: options(:)
      type(form_t), allocatable :: forms(:)      !< size 0: no data lines
      type(string_t), allocatable :: example(:)
   end type keyword_t

   !> Keywords that are being defined; options, forms and items belong to the last one, which has them when it is finished.
   type :: keyword_list_t
      integer :: n = 0
      type(keyword_t) :: list(MOST_KEYWORDS)
      integer, private :: n_options = 0, n_forms = 0, n_items = 0
      type(option_spec_t), private :: options(MOST_PARTS)
      type(form_t), private :: forms(MOST_PARTS)
      type(item_t), private :: items(MOST_PARTS)   !< of the last form
   end type keyword_list_t

contains

   !> Begins the definition of a keyword.
   subroutine define_keyword(keywords, name, level, summary, doc, parent)
      type(keyword_list_t), intent(inout) :: keywords
      character(len=*), intent(in) :: name, summary
      integer, intent(in) :: level
      character(len=*), intent(in), optional :: doc, parent

      call finish_keyword(keywords)
      keywords%n = keywords%n + 1
      associate (keyword => keywords%list(keywords%n))
         call set_bare(keyword%name, name)
         keyword%own = has_mark(name, '+')
         keyword%level = level
         keyword%summary = summary
         call set_text(keyword%doc, doc)
         call set_text(keyword%parent, parent)
         allocate (keyword%example(0))
      end associate
   end subroutine define_keyword

   !> Hands over all keywords when the last one is defined.
   subroutine take_keywords(keywords, table)
      type(keyword_list_t), intent(inout) :: keywords
      type(keyword_t), allocatable, intent(out) :: table(:)
      integer :: i

      call finish_keyword(keywords)
      allocate (table(keywords%n))
      do i = 1, keywords%n
         call move_keyword(keywords%list(i), table(i))
      end do
   end subroutine take_keywords

   !> Gives the last keyword its options and forms. What is defined is moved, not copied: a table has thousands of texts.
   subroutine finish_keyword(keywords)
      type(keyword_list_t), intent(inout) :: keywords
      integer :: i

      if (keywords%n == 0) return
      call finish_form(keywords)
      associate (keyword => keywords%list(keywords%n))
         allocate (keyword%options(keywords%n_options), keyword%forms(keywords%n_forms))
         do i = 1, keywords%n_options
            call move_option(keywords%options(i), keyword%options(i))
         end do
         do i = 1, keywords%n_forms
            call move_form(keywords%forms(i), keyword%forms(i))
         end do
      end associate
      keywords%n_options = 0
      keywords%n_forms = 0
   end subroutine finish_keyword

   subroutine finish_form(keywords)
      type(keyword_list_t), intent(inout) :: keywords
      integer :: i

      if (keywords%n_forms > 0) then
         associate (form => keywords%forms(keywords%n_forms))
            allocate (form%items(keywords%n_items))
            do i = 1, keywords%n_items
               call move_item(keywords%items(i), form%items(i))
            end do
         end associate
      end if
      keywords%n_items = 0
   end subroutine finish_form

   !> Adds an option. choices: words separated by blanks, with their marks; `_` stands for a blank within one.
   subroutine add_option(keywords, name, kind, doc, default, choices, needs, dimension)
      type(keyword_list_t), intent(inout) :: keywords
      character(len=*), intent(in) :: name, doc
      integer, intent(in) :: kind
      character(len=*), intent(in), optional :: default, choices, needs, dimension

      keywords%n_options = keywords%n_options + 1
      associate (option => keywords%options(keywords%n_options))
         call describe(option%item_t, name, kind, doc, default, dimension, choices)
         option%required = has_mark(name, '!')
         option%own = has_mark(name, '+')
         option%built = .not. has_mark(name, '-')
         call set_text(option%needs, needs)
      end associate
   end subroutine add_option

   !> What options and items have in common.
   subroutine describe(item, name, kind, doc, default, dimension, choices)
      type(item_t), intent(inout) :: item
      character(len=*), intent(in) :: name, doc
      integer, intent(in) :: kind
      character(len=*), intent(in), optional :: default, dimension, choices

      call set_bare(item%name, name)
      item%kind = kind
      item%harmless = has_mark(name, '(')
      item%is_unused = doc == NO_EFFECT
      item%doc = doc
      call set_text(item%default, default)
      call set_text(item%dimension, dimension)
      call set_choices(item%choices, choices)
      item%required = .not. (present(default) .or. has_mark(name, '[') .or. has_mark(name, '('))
   end subroutine describe

   !> Begins a form of data line. when: '' always, 'OPTION' with it, '-OPTION' without it, 'OPTION=A|B' with these values.
   subroutine add_form(keywords, doc, min_lines, max_lines, when, word, harmless)
      type(keyword_list_t), intent(inout) :: keywords
      character(len=*), intent(in) :: doc
      integer, intent(in) :: min_lines, max_lines
      character(len=*), intent(in), optional :: when, word
      logical, intent(in), optional :: harmless

      call finish_form(keywords)
      keywords%n_forms = keywords%n_forms + 1
      associate (form => keywords%forms(keywords%n_forms))
         form%doc = doc
         form%min_lines = min_lines
         form%max_lines = max_lines
         call set_text(form%word, word)
         form%harmless = .false.
         form%goes_on = .false.
         if (present(harmless)) form%harmless = harmless
         call set_condition(form, when)
         form%min_items = merge(1, 0, len(form%word) > 0)
         form%max_items = form%min_items
      end associate
   end subroutine add_form

   !> Lines of the form begun last that have too few items go on in the next line. For forms that apply alone.
   subroutine let_lines_go_on(keywords)
      type(keyword_list_t), intent(inout) :: keywords

      keywords%forms(keywords%n_forms)%goes_on = .true.
   end subroutine let_lines_go_on

   subroutine set_condition(form, when)
      type(form_t), intent(inout) :: form
      character(len=*), intent(in), optional :: when
      integer :: equals

      if (.not. present(when)) then
         form%absent = .false.
         form%option = ''
         allocate (form%values(0))
         return
      end if
      form%absent = has_mark(when, '-')
      equals = index(when//'=', '=')
      call set_bare(form%option, when(:equals - 1))
      call split_text(when(equals + 1:), '|', form%values)
   end subroutine set_condition

   !> Adds an item to the form begun last.
   subroutine add_item(keywords, name, kind, doc, dimension, default)
      type(keyword_list_t), intent(inout) :: keywords
      character(len=*), intent(in) :: name, doc
      integer, intent(in) :: kind
      character(len=*), intent(in), optional :: dimension, default

      keywords%n_items = keywords%n_items + 1
      call describe(keywords%items(keywords%n_items), name, kind, doc, default, dimension)
      call count_item(keywords, has_mark(name, '.'))
   end subroutine add_item

   !> Adds an item that is one of a list of words, written as in add_option.
   subroutine add_word_item(keywords, name, choices, doc)
      type(keyword_list_t), intent(inout) :: keywords
      character(len=*), intent(in) :: name, choices, doc

      keywords%n_items = keywords%n_items + 1
      call describe(keywords%items(keywords%n_items), name, KIND_WORD, doc, choices=choices)
      call count_item(keywords, has_mark(name, '.'))
   end subroutine add_word_item

   subroutine count_item(keywords, repeats)
      type(keyword_list_t), intent(inout) :: keywords
      logical, intent(in) :: repeats

      associate (form => keywords%forms(keywords%n_forms), item => keywords%items(keywords%n_items))
         form%max_items = form%max_items + 1
         if (item%required) form%min_items = form%max_items
         if (repeats) form%max_items = ANY_NUMBER
      end associate
   end subroutine count_item

   !> Adds the lines of an example, separated by '|'.
   subroutine add_example(keywords, lines)
      type(keyword_list_t), intent(inout) :: keywords
      character(len=*), intent(in) :: lines

      call split_text(lines, '|', keywords%list(keywords%n)%example)
   end subroutine add_example

   subroutine set_choices(choices, list)
      type(choice_t), allocatable, intent(out) :: choices(:)
      character(len=*), intent(in), optional :: list
      type(string_t), allocatable :: words(:)
      integer :: i

      if (.not. present(list)) then
         allocate (choices(0))
         return
      end if
      call split_text(list, ' ', words)
      allocate (choices(size(words)))
      do i = 1, size(words)
         call set_bare(choices(i)%name, with_blanks(words(i)%s))
         choices(i)%built = .not. has_mark(words(i)%s, '-')
         choices(i)%own = has_mark(words(i)%s, '+')
      end do
   end subroutine set_choices

   pure function with_blanks(word) result(text)
      character(len=*), intent(in) :: word
      character(len=len(word)) :: text
      integer :: i

      text = word
      do i = 1, len(word)
         if (word(i:i) == '_') text(i:i) = ' '
      end do
   end function with_blanks

   !> The pieces of a text between marks; none of an empty text.
   pure subroutine split_text(text, mark, pieces)
      character(len=*), intent(in) :: text
      character(len=1), intent(in) :: mark
      type(string_t), allocatable, intent(out) :: pieces(:)
      integer :: first, length, i, n

      n = count([(text(i:i) == mark, i=1, len(text))])
      if (len(text) > 0) then
         if (text(len(text):) /= mark) n = n + 1
      end if
      allocate (pieces(n))
      first = 1
      do i = 1, n
         length = index(text(first:), mark) - 1
         if (length < 0) length = len(text) - first + 1
         pieces(i)%s = text(first:first + length - 1)
         first = first + length + 1
      end do
   end subroutine split_text

   !> A name of the tables begins or ends with this mark.
   pure logical function has_mark(name, mark)
      character(len=*), intent(in) :: name
      character(len=1), intent(in) :: mark

      has_mark = len(name) > 0
      if (has_mark) has_mark = name(1:1) == mark .or. name(len(name):) == mark
   end function has_mark

   !> The name without its marks. Texts are set in their places: a table has thousands, and is made at every start.
   pure subroutine set_bare(bare, name)
      character(len=:), allocatable, intent(inout) :: bare
      character(len=*), intent(in) :: name
      character(len=*), parameter :: MARKS = '-+!.()[]'

      bare = name(max(verify(name, MARKS), 1):verify(name, MARKS, back=.true.))
   end subroutine set_bare

   pure subroutine set_text(place, text)
      character(len=:), allocatable, intent(inout) :: place
      character(len=*), intent(in), optional :: text

      if (present(text)) then
         place = text
      else
         place = ''
      end if
   end subroutine set_text

   subroutine move_keyword(from, to)
      type(keyword_t), intent(inout) :: from, to

      to%level = from%level
      to%own = from%own
      call move_alloc(from%name, to%name)
      call move_alloc(from%parent, to%parent)
      call move_alloc(from%summary, to%summary)
      call move_alloc(from%doc, to%doc)
      call move_alloc(from%options, to%options)
      call move_alloc(from%forms, to%forms)
      call move_alloc(from%example, to%example)
   end subroutine move_keyword

   subroutine move_option(from, to)
      type(option_spec_t), intent(inout) :: from, to

      call move_item(from%item_t, to%item_t)
      to%own = from%own
      to%built = from%built
      call move_alloc(from%needs, to%needs)
   end subroutine move_option

   subroutine move_item(from, to)
      type(item_t), intent(inout) :: from, to

      to%kind = from%kind
      to%required = from%required
      to%harmless = from%harmless
      to%is_unused = from%is_unused
      call move_alloc(from%name, to%name)
      call move_alloc(from%default, to%default)
      call move_alloc(from%dimension, to%dimension)
      call move_alloc(from%doc, to%doc)
      call move_alloc(from%choices, to%choices)
   end subroutine move_item

   subroutine move_form(from, to)
      type(form_t), intent(inout) :: from, to

      to%absent = from%absent
      to%min_lines = from%min_lines
      to%max_lines = from%max_lines
      to%min_items = from%min_items
      to%max_items = from%max_items
      to%harmless = from%harmless
      to%goes_on = from%goes_on
      call move_alloc(from%option, to%option)
      call move_alloc(from%values, to%values)
      call move_alloc(from%word, to%word)
      call move_alloc(from%doc, to%doc)
      call move_alloc(from%items, to%items)
   end subroutine move_form

end module atrito_keyword
