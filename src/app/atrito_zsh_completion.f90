!> Completion for zsh: `atrito help zsh`.
module atrito_zsh_completion
   use atrito_completion_words, only: commands_with, known_keywords, tasks_of, quoted, HELP_PAGES, VALUE_OWN, VALUE_WORDS, &
                                      VALUE_A_FOLDER, VALUE_A_FILE, kind_of_value
   use atrito_keyword, only: keyword_t
   use atrito_option_table, only: OPTIONS
   use atrito_strings, only: string_t, append_string
   use atrito_task_table, only: TASKS, TASK_RUN
   implicit none (type, external)
   private
   public :: compose_zsh_completion

   character(len=96), parameter :: TAIL(*) = [character(len=96) :: &
                                              '   case $task in', &
                                              '      run) specs+=(''*:deck:_atrito_first'') ;;', &
                                              '      help) specs+=(''*:keyword:_atrito_keywords'') ;;', &
                                              '      compare) specs+=(''*:tables:_files'') ;;', &
                                              '      *) specs+=(''*:deck:_files -g "*.inp"'') ;;', &
                                              '   esac', &
                                              '   _arguments "$specs[@]"', &
                                              '}', &
                                              '', &
                                             'if [ "$funcstack[1]" = _atrito ]; then _atrito "$@"; else compdef _atrito atrito; fi']

contains

   subroutine compose_zsh_completion(lines)
      type(string_t), allocatable, intent(out) :: lines(:)
      integer :: i

      allocate (lines(0))
      call append_string(lines, '#compdef atrito')
      call append_string(lines, '# Completion for zsh; printed by `atrito help zsh`.')
      call append_string(lines, '')
      call add_first(lines)
      call add_keywords(lines)
      call append_string(lines, '_atrito() {')
      call append_string(lines, '   local task=run word')
      call append_string(lines, '   local -a specs')
      call append_string(lines, '   for word in ${words[2,CURRENT-1]}; do')
      call append_string(lines, '      case $word in '//commands_with('|')//') task=$word; break ;; esac')
      call append_string(lines, '   done')
      do i = 1, size(OPTIONS)
         call append_string(lines, '   [[ " '//tasks_of(i)//' " == *" $task "* ]] && specs+=('//option_spec(i)//')')
      end do
      do i = 1, size(TAIL)
         call append_string(lines, trim(TAIL(i)))
      end do
   end subroutine compose_zsh_completion

   !> The first name: a command, or the deck of a run.
   subroutine add_first(lines)
      type(string_t), allocatable, intent(inout) :: lines(:)
      integer :: i

      call append_string(lines, '_atrito_first() {')
      call append_string(lines, '   local -a commands=(')
      do i = 1, size(TASKS)
         if (i /= TASK_RUN) call append_string(lines, '      '//zsh(trim(TASKS(i)%name)//':'//trim(TASKS(i)%phrase)))
      end do
      call append_string(lines, '   )')
      call append_string(lines, '   _files -g "*.inp"')
      call append_string(lines, '   _describe command commands')
      call append_string(lines, '}')
      call append_string(lines, '')
   end subroutine add_first

   subroutine add_keywords(lines)
      type(string_t), allocatable, intent(inout) :: lines(:)
      type(keyword_t), allocatable :: keywords(:)
      integer :: i

      call known_keywords(keywords)
      call append_string(lines, '_atrito_keywords() {')
      call append_string(lines, '   local -a pages=('//HELP_PAGES//') keywords=(')
      do i = 1, size(keywords)
         call append_string(lines, '      '//zsh(keywords(i)%name//':'//keywords(i)%summary))
      end do
      call append_string(lines, '   )')
      call append_string(lines, '   _describe keyword keywords -M ''m:{a-z}={A-Z}''')
      call append_string(lines, '   _describe page pages')
      call append_string(lines, '}')
      call append_string(lines, '')
   end subroutine add_keywords

   !> `'*--solver=[solver of the bodies]:NAME:(auto skyline)'`
   pure function option_spec(option) result(spec)
      integer, intent(in) :: option                 !< place in OPTIONS
      character(len=:), allocatable :: spec
      character(len=:), allocatable :: name, rest

      name = trim(OPTIONS(option)%name)
      rest = '['//escaped(trim(OPTIONS(option)%phrase))//']'
      select case (kind_of_value(option))
      case (VALUE_OWN)
         rest = rest//value_part(option, ' ')
      case (VALUE_WORDS)
         rest = rest//value_part(option, '('//trim(OPTIONS(option)%words)//')')
      case (VALUE_A_FOLDER)
         rest = rest//value_part(option, '_files -/')
      case (VALUE_A_FILE)
         rest = rest//value_part(option, '_files')
      end select
      if (kind_of_value(option) >= VALUE_OWN .and. index(name, '--') == 1) name = name//'='
      spec = zsh('*'//name//rest)
      if (len_trim(OPTIONS(option)%short) > 0) spec = spec//' '//zsh('*'//trim(OPTIONS(option)%short)//rest)
   end function option_spec

   pure function value_part(option, action) result(text)
      integer, intent(in) :: option
      character(len=*), intent(in) :: action
      character(len=:), allocatable :: text

      text = ':'//escaped(trim(OPTIONS(option)%value))//':'//action
   end function value_part

   !> Characters that _arguments would take for its own.
   pure function escaped(text) result(safe)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: safe
      integer :: i

      safe = ''
      do i = 1, len(text)
         if (scan(text(i:i), '[]:\') > 0) safe = safe//'\'
         safe = safe//text(i:i)
      end do
   end function escaped

   pure function zsh(text) result(safe)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: safe

      safe = quoted(text, '''\''''')
   end function zsh

end module atrito_zsh_completion
