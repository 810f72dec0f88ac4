!> Completion for bash, 4 or later: `atrito help bash`. The words are those of the tables of tasks, options and keywords.
module atrito_bash_completion
   use atrito_keyword, only: keyword_t
   use atrito_keyword_table, only: keyword_table
   use atrito_option_table, only: OPTIONS, VALUE_FOLDER, VALUE_FILE, TASK_RUN, TASKS, command_names, has_value
   use atrito_page, only: page_t, add_line, begin_page
   use atrito_strings, only: string_t, append_string, join
   implicit none (type, external)
   private
   public :: compose_bash_completion, options_of, options_where, VALUE_WORDS

   character(len=*), parameter :: HELP_PAGES = 'all man bash'    !< what `atrito help` knows besides keywords
   !> What bash can do for the value of an option: there is none; nothing, for the user alone knows it; ...
   integer, parameter :: VALUE_NONE = 0, VALUE_OWN = 1, VALUE_WORDS = 2, VALUE_A_FOLDER = 3, VALUE_A_FILE = 4

   character(len=88), parameter :: HEAD(*) = [character(len=88) :: &
                                              '# Completion for bash; printed by `atrito help bash`.', &
                                              '# shellcheck shell=bash', &
                                              '', &
                                              '# Files whose names fit a pattern, and folders.', &
                                              '_atrito_files() {', &
                                              '   compopt -o filenames 2>/dev/null', &
                                              '   mapfile -t COMPREPLY < <({', &
                                              '      compgen -f -X "!$1" -- "$cur"', &
                                              '      compgen -d -- "$cur"', &
                                              '   } | sort -u)', &
                                              '}', &
                                              '', &
                                              '# Those of some words that go on as it was begun.', &
                                              '_atrito_words() {', &
                                              '   mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")', &
                                              '}', &
                                              '', &
                                              '# The next word of the keywords that go on as they were begun at word $1.', &
                                              '_atrito_keywords() {', &
                                              '   local typed='''' keyword words='''' i', &
                                              '   for ((i = $1; i < COMP_CWORD; i++)); do typed+="${COMP_WORDS[i]^^} "; done', &
                                              '   while read -r keyword; do', &
                                              '      if [[ $keyword == "$typed${cur^^}"* ]]; then', &
                                              '         keyword=${keyword#"$typed"}', &
                                              '         words+=" ${keyword%% *}"', &
                                              '      fi', &
                                              '   done <<''EOF''']

   character(len=88), parameter :: MIDDLE(*) = [character(len=88) :: &
                                                'EOF', &
                                                '   mapfile -t COMPREPLY < <(compgen -W "$words" | sort -u', &
                                                '      [ "$1" -lt "$COMP_CWORD" ] || compgen -W '''//HELP_PAGES//''' -- "$cur")', &
                                                '}', &
                                                '', &
                                                '_atrito() {', &
                                          '   local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} task='''' i', &
                                                '   COMPREPLY=()', &
                                                '   if [ "$cur" = = ]; then cur=''''; fi', &
                                                '   if [ "$prev" = = ]; then prev=${COMP_WORDS[COMP_CWORD - 2]}; fi', &
                                                '   case $prev in']

contains

   !> The script for bash.
   subroutine compose_bash_completion(page)
      type(page_t), intent(out) :: page             !< the lines of the script
      type(keyword_t), allocatable :: keywords(:)
      integer :: i, k

      call begin_page(page, len(HEAD))
      do i = 1, size(HEAD)
         call add_line(page, HEAD(i))
      end do
      keywords = keyword_table()
      do i = 1, size(keywords)
         call add_line(page, keywords(i)%name)
      end do
      do i = 1, size(MIDDLE)
         call add_line(page, MIDDLE(i))
      end do
      ! What stands behind an option that has a value.
      do k = 1, size(OPTIONS)
         if (kind_of_value(k) == VALUE_WORDS) call add_line(page, '      '//trim(OPTIONS(k)%name)//') _atrito_words '''// &
                                                            trim(OPTIONS(k)%words)//'''; return ;;')
      end do
      call add_line(page, '      '//options_where([VALUE_A_FOLDER])//') compopt -o filenames 2>/dev/null')
      call add_line(page, '         mapfile -t COMPREPLY < <(compgen -d -- "$cur"); return ;;')
      call add_line(page, '      '//options_where([VALUE_A_FILE])//') _atrito_files ''*''; return ;;')
      call add_line(page, '      '//options_where([VALUE_OWN])//') return ;;')
      call add_line(page, '   esac')
      ! Which command was given, and where: i is the word behind it.
      call add_line(page, '   for ((i = 1; i < COMP_CWORD && ${#task} == 0; i++)); do')
      call add_line(page, '      case ${COMP_WORDS[i]} in')
      call add_line(page, '         '//options_where([VALUE_OWN, VALUE_WORDS, VALUE_A_FOLDER, VALUE_A_FILE])//')')
      call add_line(page, '            if [ "${COMP_WORDS[i + 1]}" = = ]; then ((i++)); fi')
      call add_line(page, '            ((i++)) ;;')
      call add_line(page, '         -*) ;;')
      call add_line(page, '         '//join(command_names(), '|')//') task=${COMP_WORDS[i]} ;;')
      call add_line(page, '         *) task=run ;;')
      call add_line(page, '      esac')
      call add_line(page, '   done')
      call add_choice(page)
   end subroutine compose_bash_completion

   !> What is to be had in this place.
   subroutine add_choice(page)
      type(page_t), intent(inout) :: page
      integer :: task

      call add_line(page, '   case ${task:-run}:$cur in')
      do task = 1, size(TASKS)
         call add_line(page, '      '//trim(merge('run    ', TASKS(task)%name, task == TASK_RUN))//':-*) _atrito_words '''// &
                       options_of(task)//''' ;;')
      end do
      call add_line(page, '      help:*) _atrito_keywords "$i" ;;')
      call add_line(page, '      compare:*) _atrito_files ''*'' ;;')
      call add_line(page, '      *)')
      call add_line(page, '         _atrito_files ''*.inp''')
      call add_line(page, '         [ -n "$task" ] || mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -W '''// &
                    join(command_names(), ' ')//''' -- "$cur") ;;')
      call add_line(page, '   esac')
      call add_line(page, '}')
      call add_line(page, 'complete -F _atrito atrito')
   end subroutine add_choice

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

end module atrito_bash_completion
