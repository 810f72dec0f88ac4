!> How the program is called (docs/user/running.md), from the tables of commands, options, exit codes and keywords: what `atrito`
!> alone prints, `atrito --help`, and the manual page atrito(1). The last two have their entries, a word and its meaning, in two
!> forms: in columns for a screen, or in the language of man(7), which groff sets.
!>
!> Completion for bash, 4 or later: `atrito help bash`. The words are those of the tables of tasks, options and keywords.
module atrito_help_pages
   use atrito_completion_lines, only: take_completion_lines
   use atrito_keyword, only: keyword_t, LEVEL_MODEL, LEVEL_STEP, LEVEL_BOTH
   use atrito_keyword_table, only: keyword_table
   use atrito_manual_lines, only: take_manual_lines
   use atrito_option_table, only: OPTIONS, TASKS, TASK_RUN, task_form, called, find_option, option_group_t, group_options, &
                                 option_text, phrase_text, task_named, task_text, VALUE_FOLDER, VALUE_FILE, command_names, has_value
   use atrito_page, only: page_t, begin_page, add_blank, add_line, add_paragraph
   use atrito_strings, only: lower_case, upper_case, recoded, string_t, append_string, join
   use atrito_version, only: PROGRAM_NAME, PROGRAM_VERSION
   implicit none (type, external)
   private
   public :: compose_usage, compose_options, compose_topic, compose_man_page, compose_bash_completion, options_of, options_where, &
             VALUE_WORDS

   character(len=*), parameter :: SUMMARY = 'contact with friction between elastic bodies'
   type :: exit_code_t
      character(len=13) :: codes                    !< one or several
      character(len=110) :: meaning                 !< in a phrase
   end type exit_code_t

   type(exit_code_t), parameter :: EXIT_CODES(*) = [ &
                                   exit_code_t('0', 'solved, checked, all tables written; compare: the same'), &
                                   exit_code_t('1', 'wrong command line; compare: different'), &
                                   exit_code_t('2', 'errors in the deck, all of them listed; nothing computed'), &
                            exit_code_t('3', 'not converged, or the final check failed: the last iterate is written, and marked'), &
                                   exit_code_t('4', 'singular or indefinite system'), &
                                   exit_code_t('5', 'a file cannot be read or written'), &
                                   exit_code_t('9', 'internal error'), &
                                   exit_code_t('129, 130, 143', 'ended by SIGHUP, SIGINT, SIGTERM; nothing half-written is left')]
   character(len=*), parameter :: UNITS_TEXT(*) = [character(len=160) :: &
            'atrito knows no units: lengths L and forces F of the deck are those of the results. Take two, and all else follows:', &
                                                   '  L    F    stress F/L^2   E of steel   density F T^2/L^4 (with g in L/T^2)', &
                                                   '  mm   N    MPa            210000       7.85e-9 t/mm^3, g = 9810', &
                                                   '  m    N    Pa             2.1e11       7850 kg/m^3, g = 9.81', &
                                                   '  m    kN   kPa            2.1e8        7.85 t/m^3, g = 9.81', &
               'The thickness of a section is in L; pressures and slopes of contact are F/L^2 and F/L^3, a penalty delta is L^3/F.']
   integer, parameter :: WIDTH = 80                  !< columns of the screen
   integer, parameter :: ROFF = 0                    !< in the place of a column of the screen: the form of man(7)

   character(len=*), parameter :: HELP_PAGES = 'all man bash'    !< what `atrito help` knows besides keywords
   !> What bash can do for the value of an option: there is none; nothing, for the user alone knows it; ...
   integer, parameter :: VALUE_NONE = 0, VALUE_OWN = 1, VALUE_WORDS = 2, VALUE_A_FOLDER = 3, VALUE_A_FILE = 4

contains

   !> The short form.
   subroutine compose_usage(page)
      type(page_t), intent(out) :: page             !< lines for a screen
      integer :: task

      call begin_page(page, WIDTH)
      do task = 1, size(TASKS)
         call add_line(page, merge('usage: ', '       ', task == 1)//task_form(task))
      end do
      call add_line(page, '       atrito --help | --version')
   end subroutine compose_usage

   !> The long form: every command, option and exit code.
   subroutine compose_options(page)
      type(page_t), intent(out) :: page             !< lines for a screen

      call begin_page(page, WIDTH)
      call add_line(page, PROGRAM_NAME//' '//PROGRAM_VERSION//': '//SUMMARY)
      call add_blank(page)
      call add_commands(page, 28)
      call add_line(page, 'atrito --help | --version')
      call add_options(page, 22)
      call add_blank(page)
      call add_line(page, 'exit codes')
      call add_exit_codes(page, 18)
   end subroutine compose_options

   !> `atrito help sweep`, `atrito help observe`, `atrito help units`: a command with its options, an option, or what stands here;
   !> an empty page where it is none of these.
   subroutine compose_topic(word, page)
      character(len=*), intent(in) :: word          !< command, option with or without --, or units; any case
      type(page_t), intent(out) :: page             !< lines for a screen
      character(len=:), allocatable :: name, commands
      integer :: task, i

      call begin_page(page, WIDTH)
      name = lower_case(word)
      task = task_named(name)
      if (name == 'run') task = TASK_RUN
      if (task /= TASK_RUN .or. name == 'run') then
         call add_line(page, task_form(task))
         call add_paragraph(page, trim(TASKS(task)%phrase), 4)
         do i = 1, size(OPTIONS)
            if (OPTIONS(i)%for_task(task)) call add_entry(page, option_text(i), phrase_text(i), 22)
         end do
      end if
      i = find_option('--'//name(verify(name, '-'):))
      if (i > 0) then
         commands = ''
         do task = 1, size(TASKS)
            if (OPTIONS(i)%for_task(task)) commands = commands//', '//task_text(task)
         end do
         call add_line(page, option_text(i))
         call add_paragraph(page, phrase_text(i), 4)
         if (len_trim(OPTIONS(i)%words) == 0) call add_paragraph(page, trim(OPTIONS(i)%expected), 4)
         call add_paragraph(page, 'of: '//commands(3:), 4)
      end if
      do i = 1, merge(size(UNITS_TEXT), 0, name == 'units')
         call add_paragraph(page, trim(UNITS_TEXT(i)), 0)
      end do
   end subroutine compose_topic

   !> The manual page: manual.roff, with what the tables have in its places.
   subroutine compose_man_page(page)
      type(page_t), intent(out) :: page             !< in the language of man(7)
      type(string_t), allocatable :: lines(:)
      integer :: i, task

      call begin_page(page, WIDTH)
      call take_manual_lines(lines)
      do i = 1, size(lines)
         select case (lines(i)%s)
         case ('@SYNOPSIS@')
            do task = 1, size(TASKS)
               if (task > 1) call add_line(page, '.br')
               call add_line(page, '.B '//roff_text(called(task)))
               if (len_trim(TASKS(task)%options) > 0) call add_line(page, roff_text(trim(TASKS(task)%options)))
            end do
         case ('@COMMANDS@')
            call add_commands(page, ROFF)
         case ('@OPTIONS@')
            call add_options(page, ROFF)
         case ('@KEYWORDS@')
            call add_keywords(page)
         case ('@EXIT CODES@')
            call add_exit_codes(page, ROFF)
         case default
            call add_line(page, filled(lines(i)%s, '@VERSION@', PROGRAM_VERSION))
         end select
      end do
   end subroutine compose_man_page

   !> A text with something in its place.
   pure function filled(text, place, by) result(whole)
      character(len=*), intent(in) :: text, place, by
      character(len=:), allocatable :: whole
      integer :: i

      whole = text
      i = index(text, place)
      if (i > 0) whole = text(:i - 1)//by//text(i + len(place):)
   end function filled

   subroutine add_commands(page, column)
      type(page_t), intent(inout) :: page
      integer, intent(in) :: column                 !< before the meaning, or ROFF
      integer :: i

      do i = 1, size(TASKS)
         call add_entry(page, called(i)//merge(' [options]', '          ', i == 1 .and. column /= ROFF), trim(TASKS(i)%phrase), &
                        column)
      end do
   end subroutine add_commands

   !> All options, in their groups.
   subroutine add_options(page, column)
      type(page_t), intent(inout) :: page
      integer, intent(in) :: column                 !< before the meaning, or ROFF
      type(option_group_t), allocatable :: groups(:)
      integer :: i, k

      call group_options(groups)
      do i = 1, size(groups)
         if (column == ROFF) then
            call add_line(page, '.SS '//roff_text(groups(i)%title))
         else
            call add_blank(page)
            call add_line(page, groups(i)%title)
         end if
         do k = 1, size(groups(i)%options)
            call add_entry(page, '  '//option_text(groups(i)%options(k)), phrase_text(groups(i)%options(k)), column)
         end do
         if (len(groups(i)%others) == 0) cycle
         if (column == ROFF) then
            call add_line(page, '.PP')
            call add_line(page, roff_text(groups(i)%others))
         else
            call add_paragraph(page, groups(i)%others, 2)
         end if
      end do
   end subroutine add_options

   subroutine add_keywords(page)
      type(page_t), intent(inout) :: page
      type(keyword_t), allocatable :: table(:)
      integer :: level, i
      integer, parameter :: LEVELS(3) = [LEVEL_MODEL, LEVEL_STEP, LEVEL_BOTH]
      character(len=40), parameter :: TITLES(3) = [character(len=40) :: 'of the model, before *STEP', &
                                                                                'of a step, between *STEP and *END STEP', 'of both']

      table = keyword_table()
      do level = 1, size(LEVELS)
         call add_line(page, '.SS '//roff_text(trim(TITLES(level))))
         do i = 1, size(table)
            if (table(i)%level == LEVELS(level)) call add_entry(page, trim('*'//table(i)%name//merge(' +', '  ', table(i)%own)), &
                                                                table(i)%summary, ROFF)
         end do
      end do
   end subroutine add_keywords

   subroutine add_exit_codes(page, column)
      type(page_t), intent(inout) :: page
      integer, intent(in) :: column                 !< before the meaning, or ROFF
      integer :: i

      do i = 1, size(EXIT_CODES)
         call add_entry(page, '  '//trim(EXIT_CODES(i)%codes), trim(EXIT_CODES(i)%meaning), column)
      end do
   end subroutine add_exit_codes

   !> A word, and its meaning in a column of its own; a word that leaves no room has a line to itself.
   subroutine add_entry(page, word, meaning, column)
      type(page_t), intent(inout) :: page
      character(len=*), intent(in) :: word, meaning
      integer, intent(in) :: column                 !< blanks before the meaning, or ROFF
      integer :: first

      if (column == ROFF) then
         call add_line(page, '.TP')
         call add_line(page, '.B '//roff_text(trim(adjustl(word))))
         call add_line(page, roff_text(meaning))
         return
      end if
      if (len_trim(word) >= column) call add_line(page, word)
      first = page%n + 1
      call add_paragraph(page, meaning, column)
      if (len_trim(word) < column) page%lines(first)%s(:len_trim(word)) = trim(word)
   end subroutine add_entry

   !> A text in which roff finds no requests of its own.
   pure function roff_text(text) result(safe)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: safe

      safe = recoded(text, '\-''`', [character(len=4) :: '\e', '\-', '\(aq', '\(ga'])
      if (index(text, '.') == 1) safe = '\&'//safe
   end function roff_text

   !> The script for bash: completion.bash, with what the tables have in its places.
   subroutine compose_bash_completion(page)
      type(page_t), intent(out) :: page             !< the lines of the script
      type(string_t), allocatable :: lines(:)
      type(keyword_t), allocatable :: keywords(:)
      character(len=:), allocatable :: line
      integer :: i, k

      call begin_page(page, WIDTH)
      call take_completion_lines(lines)
      keywords = keyword_table()
      do i = 1, size(lines)
         select case (lines(i)%s)
         case ('@KEYWORDS@')
            do k = 1, size(keywords)
               call add_line(page, keywords(k)%name)
            end do
         case ('@OPTIONS WITH WORDS@')
            do k = 1, size(OPTIONS)
               if (kind_of_value(k) == VALUE_WORDS) call add_line(page, '      '//trim(OPTIONS(k)%name)//') _atrito_words '''// &
                                                                  trim(OPTIONS(k)%words)//'''; return ;;')
            end do
         case ('@TASKS@')
            do k = 1, size(TASKS)
               call add_line(page, '      '//trim(merge('run    ', TASKS(k)%name, k == TASK_RUN))//':-*) _atrito_words '''// &
                             options_of(k)//''' ;;')
            end do
         case default
            line = filled(lines(i)%s, '@PAGES@', HELP_PAGES)
            line = filled(line, '@FOLDERS@', options_where([VALUE_A_FOLDER]))
            line = filled(line, '@FILES@', options_where([VALUE_A_FILE]))
            line = filled(line, '@OWN@', options_where([VALUE_OWN]))
            line = filled(line, '@VALUES@', options_where([VALUE_OWN, VALUE_WORDS, VALUE_A_FOLDER, VALUE_A_FILE]))
            line = filled(line, '@COMMANDS@', join(command_names(), '|'))
            call add_line(page, filled(line, '@WORDS@', join(command_names(), ' ')))
         end select
      end do
   end subroutine compose_bash_completion

   !> What a shell can do for the value of an option, VALUE_...
   pure integer function kind_of_value(option) result(kind)
      integer, intent(in) :: option                 !< place in OPTIONS

      kind = VALUE_OWN
      if (.not. has_value(option)) kind = VALUE_NONE
      if (OPTIONS(option)%value == VALUE_FOLDER) kind = VALUE_A_FOLDER
      if (OPTIONS(option)%value == VALUE_FILE) kind = VALUE_A_FILE
      if (len_trim(OPTIONS(option)%words) > 0) kind = VALUE_WORDS
   end function kind_of_value

   !> All names of the options that a task knows, blanks between them.
   pure function options_of(task) result(text)
      integer, intent(in) :: task                   !< TASK_*
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

end module atrito_help_pages
