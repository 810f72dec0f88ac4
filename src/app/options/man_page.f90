!> The manual page atrito(1), from the tables of tasks, options, exit codes and keywords.
module atrito_man_page
   use atrito_keyword, only: keyword_t, LEVEL_MODEL, LEVEL_STEP, LEVEL_BOTH
   use atrito_keyword_table, only: keyword_table
   use atrito_option_groups, only: option_group_t, group_options
   use atrito_option_table, only: option_text, phrase_text
   use atrito_strings, only: string_t, append_string, upper_case
   use atrito_task_table, only: TASKS, called
   use atrito_usage, only: EXIT_CODES, SUMMARY
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   implicit none (type, external)
   private
   public :: compose_man_page

   character(len=*), parameter :: DESCRIPTION(*) = [character(len=320) :: &
    'atrito finds displacements, stresses and contact forces of linear elastic bodies in the plane or of revolution that touch '// &
         'with friction, by finite elements. A deck of keywords goes in, in the tradition of Abaqus and CalculiX; tables and a '// &
                                                    'listing come out.', &
   'Standard output is for the summary, standard error for progress and messages. A run whose check of equilibrium and contact '// &
                                                    'law fails never ends with 0.']
   character(len=*), parameter :: KEYWORDS_NOTE = 'A deck is made of lines *KEYWORD, OPTION=value, each with its data lines. '// &
                                  'atrito help KEYWORD prints all of a keyword; + marks what is atrito''s own.'

contains

   !> The manual page in the language of man(7), line by line.
   subroutine compose_man_page(lines)
      type(string_t), allocatable, intent(out) :: lines(:)

      allocate (lines(0))
      call append_string(lines, '.\" Printed by `atrito help man`; do not edit.')
     call append_string(lines, '.TH '//upper_case(PROGRAM_NAME)//' 1 "" "'//PROGRAM_NAME//' '//PROGRAM_VERSION//'" "User Commands"')
      call append_string(lines, '.SH NAME')
      call append_string(lines, PROGRAM_NAME//' \- '//roff(SUMMARY))
      call add_tasks(lines)
      call add_options(lines)
      call add_keywords(lines)
      call add_exit_codes(lines)
      call add_rest(lines)
   end subroutine compose_man_page

   subroutine add_tasks(lines)
      type(string_t), allocatable, intent(inout) :: lines(:)
      integer :: i

      call append_string(lines, '.SH SYNOPSIS')
      do i = 1, size(TASKS)
         if (i > 1) call append_string(lines, '.br')
         call append_string(lines, '.B '//roff(called(i)))
         if (len_trim(TASKS(i)%options) > 0) call append_string(lines, roff(trim(TASKS(i)%options)))
      end do
      call append_string(lines, '.SH DESCRIPTION')
      do i = 1, size(DESCRIPTION)
         if (i > 1) call append_string(lines, '.PP')
         call append_string(lines, roff(trim(DESCRIPTION(i))))
      end do
      call append_string(lines, '.SH COMMANDS')
      do i = 1, size(TASKS)
         call add_entry(lines, called(i), trim(TASKS(i)%phrase))
      end do
      call add_entry(lines, 'atrito help man | bash', 'this page; what completes commands, options and keywords in bash')
   end subroutine add_tasks

   subroutine add_options(lines)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(option_group_t), allocatable :: groups(:)
      integer :: i, k

      call append_string(lines, '.SH OPTIONS')
     call append_string(lines, roff('Options may stand before or behind the names; --name value and --name=value are the same. '// &
                                     'Behind -- everything is a name.'))
      call group_options(groups)
      do i = 1, size(groups)
         call append_string(lines, '.SS '//roff(groups(i)%title))
         do k = 1, size(groups(i)%options)
            call add_entry(lines, option_text(groups(i)%options(k)), phrase_text(groups(i)%options(k)))
         end do
         if (len(groups(i)%others) == 0) cycle
         call append_string(lines, '.PP')
         call append_string(lines, roff(groups(i)%others))
      end do
   end subroutine add_options

   subroutine add_keywords(lines)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(keyword_t), allocatable :: table(:)

      table = keyword_table()
      call append_string(lines, '.SH KEYWORDS')
      call append_string(lines, roff(KEYWORDS_NOTE))
      call add_level(lines, table, 'of the model, before *STEP', LEVEL_MODEL)
      call add_level(lines, table, 'of a step, between *STEP and *END STEP', LEVEL_STEP)
      call add_level(lines, table, 'of both', LEVEL_BOTH)
   end subroutine add_keywords

   subroutine add_level(lines, table, title, level)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(keyword_t), intent(in) :: table(:)
      character(len=*), intent(in) :: title
      integer, intent(in) :: level                  !< LEVEL_...
      character(len=:), allocatable :: name
      integer :: i

      call append_string(lines, '.SS '//roff(title))
      do i = 1, size(table)
         if (table(i)%level /= level) cycle
         name = '*'//table(i)%name
         if (table(i)%own) name = name//' +'
         call add_entry(lines, name, table(i)%summary)
      end do
   end subroutine add_level

   subroutine add_exit_codes(lines)
      type(string_t), allocatable, intent(inout) :: lines(:)
      integer :: i

      call append_string(lines, '.SH EXIT STATUS')
      do i = 1, size(EXIT_CODES)
         call add_entry(lines, trim(EXIT_CODES(i)%codes), trim(EXIT_CODES(i)%meaning))
      end do
   end subroutine add_exit_codes

   subroutine add_rest(lines)
      type(string_t), allocatable, intent(inout) :: lines(:)

      call append_string(lines, '.SH ENVIRONMENT')
      call add_entry(lines, 'NO_COLOR', 'where it is set and not empty, messages on a terminal have no colours')
      call add_entry(lines, 'TERM', 'nor where it is not set, or dumb')
      call append_string(lines, '.SH FILES')
      call add_entry(lines, 'share/atrito/input', 'decks of examples and lessons, below the prefix of the installation')
      call add_entry(lines, 'share/doc/atrito', 'the documentation, in Markdown; begin with docs/user/first-deck.md')
      call append_string(lines, '.SH EXAMPLES')
      call add_entry(lines, 'atrito plate.inp --set nu=0 --refine 1', &
                     'plate.inp without friction, on a mesh of four times the elements; tables in ./output/plate')
      call add_entry(lines, 'atrito check plate.inp', 'all errors of the deck, or what it needs')
      call append_string(lines, '.SH SEE ALSO')
      call append_string(lines, '.BR gnuplot (1)')
   end subroutine add_rest

   !> A word and its meaning.
   subroutine add_entry(lines, word, meaning)
      type(string_t), allocatable, intent(inout) :: lines(:)
      character(len=*), intent(in) :: word, meaning

      call append_string(lines, '.TP')
      call append_string(lines, '.B '//roff(word))
      call append_string(lines, roff(meaning))
   end subroutine add_entry

   !> A text in which roff finds no requests of its own.
   pure function roff(text) result(safe)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: safe
      integer :: i

      safe = ''
      do i = 1, len(text)
         select case (text(i:i))
         case ('\')
            safe = safe//'\e'
         case ('-')
            safe = safe//'\-'
         case ('''')
            safe = safe//'\(aq'
         case ('`')
            safe = safe//'\(ga'
         case ('.')
            if (i == 1) safe = safe//'\&'
            safe = safe//'.'
         case default
            safe = safe//text(i:i)
         end select
      end do
   end function roff

end module atrito_man_page
