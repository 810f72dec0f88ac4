!> What the completions of all shells are made of: lists of words from the tables of tasks, options and keywords.
module atrito_completion_words
   use atrito_keyword, only: keyword_t
   use atrito_keyword_table, only: keyword_table
   use atrito_option_table, only: OPTIONS, VALUE_FOLDER, VALUE_FILE, has_value
   use atrito_strings, only: string_t, append_string, join
   use atrito_task_table, only: TASKS, command_names
   implicit none (type, external)
   private
   public :: commands_with, options_of, options_where, known_keywords, task_word
   public :: HELP_PAGES, VALUE_NONE, VALUE_OWN, VALUE_WORDS, VALUE_A_FOLDER, VALUE_A_FILE, kind_of_value

   character(len=*), parameter :: HELP_PAGES = 'all man bash'    !< what `atrito help` knows besides keywords

   !> What a shell can do for the value of an option.
   integer, parameter :: VALUE_NONE = 0             !< there is none
   integer, parameter :: VALUE_OWN = 1              !< nothing: the user alone knows it
   integer, parameter :: VALUE_WORDS = 2, VALUE_A_FOLDER = 3, VALUE_A_FILE = 4

contains

   pure integer function kind_of_value(option) result(kind)
      integer, intent(in) :: option                 !< place in OPTIONS

      kind = VALUE_OWN
      if (.not. has_value(option)) kind = VALUE_NONE
      if (OPTIONS(option)%value == VALUE_FOLDER) kind = VALUE_A_FOLDER
      if (OPTIONS(option)%value == VALUE_FILE) kind = VALUE_A_FILE
      if (len_trim(OPTIONS(option)%words) > 0) kind = VALUE_WORDS
   end function kind_of_value

   !> The commands, something between them.
   pure function commands_with(separator) result(text)
      character(len=*), intent(in) :: separator
      character(len=:), allocatable :: text

      text = join(command_names(), separator)
   end function commands_with

   !> A task as the scripts call it: its command, or `run`.
   pure function task_word(task) result(word)
      integer, intent(in) :: task
      character(len=:), allocatable :: word

      word = trim(TASKS(task)%name)
      if (len(word) == 0) word = 'run'
   end function task_word

   !> All names of the options that a task knows, blanks between them.
   pure function options_of(task) result(text)
      integer, intent(in) :: task
      character(len=:), allocatable :: text
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      do i = 1, size(OPTIONS)
         if (OPTIONS(i)%for_task(task)) call add_names(names, i)
      end do
      text = join(names, ' ')
   end function options_of

   !> The options whose values are of one of these kinds, `|` between them.
   pure function options_where(kinds) result(text)
      integer, intent(in) :: kinds(:)               !< VALUE_...
      character(len=:), allocatable :: text
      type(string_t), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      do i = 1, size(OPTIONS)
         if (any(kinds == kind_of_value(i))) call add_names(names, i)
      end do
      text = join(names, '|')
   end function options_where

   !> Appends both names of an option.
   pure subroutine add_names(names, option)
      type(string_t), allocatable, intent(inout) :: names(:)
      integer, intent(in) :: option                 !< place in OPTIONS

      call append_string(names, trim(OPTIONS(option)%name))
      if (len_trim(OPTIONS(option)%short) > 0) call append_string(names, trim(OPTIONS(option)%short))
   end subroutine add_names

   !> The keywords that a deck may have.
   subroutine known_keywords(keywords)
      type(keyword_t), allocatable, intent(out) :: keywords(:)
      type(keyword_t), allocatable :: table(:)
      integer :: i

      table = keyword_table()
      keywords = table(pack([(i, i=1, size(table))], table%built))
   end subroutine known_keywords

end module atrito_completion_words
