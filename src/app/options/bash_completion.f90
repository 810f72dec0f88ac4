!> Completion for bash, 4 or later: `atrito help bash`.
module atrito_bash_completion
   use atrito_completion_words, only: commands_with, options_of, options_where, known_keywords, task_word, HELP_PAGES, &
                                      VALUE_OWN, VALUE_WORDS, VALUE_A_FOLDER, VALUE_A_FILE, kind_of_value
   use atrito_keyword, only: keyword_t
   use atrito_option_table, only: OPTIONS
   use atrito_strings, only: string_t, append_string
   use atrito_task_table, only: TASKS
   implicit none (type, external)
   private
   public :: compose_bash_completion

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

   subroutine compose_bash_completion(lines)
      type(string_t), allocatable, intent(out) :: lines(:)
      type(keyword_t), allocatable :: keywords(:)
      integer :: i

      allocate (lines(0))
      call add_lines(lines, HEAD)
      call known_keywords(keywords)
      do i = 1, size(keywords)
         call append_string(lines, keywords(i)%name)
      end do
      call add_lines(lines, MIDDLE)
      call add_values(lines)
      call add_search(lines)
      call add_choice(lines)
   end subroutine compose_bash_completion

   subroutine add_lines(lines, texts)
      type(string_t), allocatable, intent(inout) :: lines(:)
      character(len=*), intent(in) :: texts(:)
      integer :: i

      do i = 1, size(texts)
         call append_string(lines, trim(texts(i)))
      end do
   end subroutine add_lines

   !> What stands behind an option that has a value.
   subroutine add_values(lines)
      type(string_t), allocatable, intent(inout) :: lines(:)
      integer :: i

      do i = 1, size(OPTIONS)
         if (kind_of_value(i) == VALUE_WORDS) call append_string(lines, '      '//trim(OPTIONS(i)%name)//') _atrito_words '''// &
                                                                 trim(OPTIONS(i)%words)//'''; return ;;')
      end do
      call append_string(lines, '      '//options_where([VALUE_A_FOLDER])//') compopt -o filenames 2>/dev/null')
      call append_string(lines, '         mapfile -t COMPREPLY < <(compgen -d -- "$cur"); return ;;')
      call append_string(lines, '      '//options_where([VALUE_A_FILE])//') _atrito_files ''*''; return ;;')
      call append_string(lines, '      '//options_where([VALUE_OWN])//') return ;;')
      call append_string(lines, '   esac')
   end subroutine add_values

   !> Which command was given, and where: i is the word behind it.
   subroutine add_search(lines)
      type(string_t), allocatable, intent(inout) :: lines(:)

      call append_string(lines, '   for ((i = 1; i < COMP_CWORD && ${#task} == 0; i++)); do')
      call append_string(lines, '      case ${COMP_WORDS[i]} in')
      call append_string(lines, '         '//options_where([VALUE_OWN, VALUE_WORDS, VALUE_A_FOLDER, VALUE_A_FILE])//')')
      call append_string(lines, '            if [ "${COMP_WORDS[i + 1]}" = = ]; then ((i++)); fi')
      call append_string(lines, '            ((i++)) ;;')
      call append_string(lines, '         -*) ;;')
      call append_string(lines, '         '//commands_with('|')//') task=${COMP_WORDS[i]} ;;')
      call append_string(lines, '         *) task=run ;;')
      call append_string(lines, '      esac')
      call append_string(lines, '   done')
   end subroutine add_search

   !> What is to be had in this place.
   subroutine add_choice(lines)
      type(string_t), allocatable, intent(inout) :: lines(:)
      integer :: task

      call append_string(lines, '   case ${task:-run}:$cur in')
      do task = 1, size(TASKS)
         call append_string(lines, '      '//task_word(task)//':-*) _atrito_words '''//options_of(task)//''' ;;')
      end do
      call append_string(lines, '      help:*) _atrito_keywords "$i" ;;')
      call append_string(lines, '      compare:*) _atrito_files ''*'' ;;')
      call append_string(lines, '      *)')
      call append_string(lines, '         _atrito_files ''*.inp''')
      call append_string(lines, '         [ -n "$task" ] || mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -W '''// &
                         commands_with(' ')//''' -- "$cur") ;;')
      call append_string(lines, '   esac')
      call append_string(lines, '}')
      call append_string(lines, 'complete -F _atrito atrito')
   end subroutine add_choice

end module atrito_bash_completion
