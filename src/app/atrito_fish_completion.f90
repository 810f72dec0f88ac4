!> Completion for fish: `atrito help fish`.
module atrito_fish_completion
   use atrito_completion_words, only: commands_with, known_keywords, tasks_of, quoted, HELP_PAGES, VALUE_NONE, VALUE_OWN, &
                                      VALUE_WORDS, VALUE_A_FOLDER, VALUE_A_FILE, kind_of_value
   use atrito_keyword, only: keyword_t
   use atrito_option_table, only: OPTIONS
   use atrito_strings, only: string_t, append_string
   use atrito_task_table, only: TASKS, TASK_RUN, TASK_HELP
   implicit none (type, external)
   private
   public :: compose_fish_completion

   character(len=*), parameter :: FOR = 'complete -c atrito -n '

contains

   subroutine compose_fish_completion(lines)
      type(string_t), allocatable, intent(out) :: lines(:)
      integer :: i

      allocate (lines(0))
      call append_string(lines, '# Completion for fish; printed by `atrito help fish`.')
      call append_string(lines, '')
      call append_string(lines, '# The command is one of these; without a command it is run.')
      call append_string(lines, 'function __atrito_does')
      call append_string(lines, '   set -l task run')
      call append_string(lines, '   for word in (commandline -opc)[2..-1]')
      call append_string(lines, '      if contains -- $word '//commands_with(' '))
      call append_string(lines, '         set task $word')
      call append_string(lines, '         break')
      call append_string(lines, '      end')
      call append_string(lines, '   end')
      call append_string(lines, '   contains -- $task $argv')
      call append_string(lines, 'end')
      call append_string(lines, '')
      call append_string(lines, 'complete -c atrito -f')
      call add_names(lines)
      do i = 1, size(OPTIONS)
         call append_string(lines, option_line(i))
      end do
   end subroutine compose_fish_completion

   !> Commands, decks, keywords, and what is compared.
   subroutine add_names(lines)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(keyword_t), allocatable :: keywords(:)
      integer :: i

      do i = 1, size(TASKS)
         if (i /= TASK_RUN) call append_string(lines, FOR//'''__atrito_does run'' -a '//trim(TASKS(i)%name)//' -d '// &
                                               fish(trim(TASKS(i)%phrase)))
      end do
      call append_string(lines, FOR//'''__atrito_does run check sweep study limit'' -k -a '// &
                         '''(__fish_complete_suffix .inp | string match -er "(?:/|[.]inp)\z")''')
      call append_string(lines, FOR//'''__atrito_does compare'' -F')
      call append_string(lines, FOR//'''__atrito_does help'' -a '''//HELP_PAGES//'''')
      call known_keywords(keywords)
      do i = 1, size(keywords)
         call append_string(lines, FOR//'''__atrito_does help'' -a '//word_of(keywords(i)%name)//' -d '//fish(keywords(i)%summary))
      end do
   end subroutine add_names

   !> A keyword as one word of the line.
   pure function word_of(name) result(word)
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: word

      word = fish(name)
      if (index(name, ' ') > 0) word = '"'//word//'"'     ! fish takes the list apart as a command line
   end function word_of

   pure function option_line(option) result(line)
      integer, intent(in) :: option                 !< place in OPTIONS
      character(len=:), allocatable :: line
      character(len=:), allocatable :: name

      name = trim(OPTIONS(option)%name)
      line = FOR//'''__atrito_does '//tasks_of(option)//''''
      if (index(name, '--') == 1) then
         line = line//' -l '//name(3:)
      else
         line = line//' -s '//name(2:)
      end if
      if (len_trim(OPTIONS(option)%short) > 0) line = line//' -s '//OPTIONS(option)%short(2:)
      line = line//' -d '//fish(trim(OPTIONS(option)%phrase))
      select case (kind_of_value(option))
      case (VALUE_OWN)
         line = line//' -x'
      case (VALUE_WORDS)
         line = line//' -xa '//fish(trim(OPTIONS(option)%words))
      case (VALUE_A_FOLDER)
         line = line//' -xa ''(__fish_complete_directories)'''
      case (VALUE_A_FILE)
         line = line//' -rF'
      case (VALUE_NONE)
      end select
   end function option_line

   pure function fish(text) result(safe)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: safe

      safe = quoted(text, '\''')
   end function fish

end module atrito_fish_completion
